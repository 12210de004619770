/*
  The end of the report: times by part, worst residuals, files written, and time and memory used.

  Times are those of petsam's log events, each from the rank where it is largest.
*/
#include "program.h"
#include "report.h"
#include <petsam/private/contact.h>
#include <petsam/private/edges.h>
#include <petsam/private/normal.h>
#include <petsam/private/solver.h>
#include <petsam/private/state.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#define FOUND 0.5 /* share of reconstructed edges above which nothing is printed */

/* A row of the table: the sum of the times of one or more events. */
typedef struct {
  const char *name;
  SamEvent    events[3];
  PetscInt    count;
} Part;

/* These parts do not overlap; together with set-up and the rest they make up the whole run. */
static const Part parts[] = {{"normal problem", {SAM_EVENT_NORMAL_SOLVE}, 1},
                             {"tangential problem", {SAM_EVENT_TANGENTIAL_SOLVE}, 1},
                             {"plastic strain", {SAM_EVENT_PLASTIC}, 1},
                             {"edges", {SAM_EVENT_EDGES}, 1},
                             {"check", {SAM_EVENT_CHECK}, 1},
                             {"results", {SAM_EVENT_OUTPUT}, 1},
                             {"tangent stiffness", {SAM_EVENT_STIFFNESS}, 1},
                             {"checkpoints", {SAM_EVENT_CHECKPOINT}, 1}};

/* These are contained in the parts above. */
static const Part inner[] = {
  {"influence coefficients", {SAM_EVENT_SETUP_INFLUENCE}, 1},
  {"operator applications", {SAM_EVENT_APPLY_NORMAL, SAM_EVENT_APPLY_TANGENTIAL, SAM_EVENT_APPLY_COUPLING}, 3},
  {"preconditioner", {SAM_EVENT_PRECONDITION_NORMAL, SAM_EVENT_PRECONDITION_TANGENTIAL}, 2},
  {"Fourier transforms", {SAM_EVENT_FFT_ROWS, SAM_EVENT_FFT_COLUMNS, SAM_EVENT_FFT_TRANSPOSE}, 3}};

enum { PARTS = sizeof(parts) / sizeof(parts[0]), INNER = sizeof(inner) / sizeof(inner[0]) };

static PetscErrorCode GetTime(SamReport r, const Part *part, double *seconds)
{
  PetscFunctionBegin;
  *seconds = 0;
  for (PetscInt e = 0; e < part->count && r->logging; e++) {
#if defined(PETSC_USE_LOG)
    PetscEventPerfInfo info;

    PetscCall(PetscLogEventGetPerfInfo(0, SamEvents[part->events[e]], &info));
    *seconds += info.time;
#endif
  }
  PetscCall(SamMax(r->comm, 1, seconds));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReportGetPartTime(SamReport r, double *seconds)
{
  double one;

  PetscFunctionBegin;
  *seconds = 0;
  for (PetscInt p = 0; p < PARTS; p++) {
    PetscCall(GetTime(r, &parts[p], &one));
    *seconds += one;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintRow(SamReport r, const char indent[], const char name[], double seconds, double total)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(r->comm, "    %s%-*s %10.2f s %5.1f %%\n", indent, 26 - (int)strlen(indent), name, seconds,
                        total > 0 ? 100 * seconds / total : 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if only some runs have this part. */
static PetscBool IsAskedFor(const Part *part)
{
  return part->events[0] == SAM_EVENT_STIFFNESS || part->events[0] == SAM_EVENT_PLASTIC ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode PrintTimes(SamReport r)
{
  double total = MPI_Wtime() - r->start, setup = r->first - r->start - r->parts_before, rest, seconds;

  PetscFunctionBegin;
  PetscCall(SamMax(r->comm, 1, &total));
  PetscCall(SamMax(r->comm, 1, &setup));
  rest = total - setup;
  PetscCall(PetscPrintf(r->comm, "\n  time by part\n"));
  PetscCall(PrintRow(r, "", "set-up", setup, total));
  for (PetscInt p = 0; p < PARTS; p++) {
    PetscCall(GetTime(r, &parts[p], &seconds));
    if (seconds > 0 || !IsAskedFor(&parts[p])) PetscCall(PrintRow(r, "", parts[p].name, seconds, total));
    rest -= seconds;
  }
  PetscCall(PrintRow(r, "", "other", PetscMax(rest, 0), total));
  PetscCall(PrintRow(r, "", "total", total, total));
  PetscCall(PetscPrintf(r->comm, "    within these:\n"));
  for (PetscInt p = 0; p < INNER; p++) {
    PetscCall(GetTime(r, &inner[p], &seconds));
    PetscCall(PrintRow(r, "  ", inner[p].name, seconds, total));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the operator applications of both problems on each of the nested grids, and the time of their solves there. */
static PetscErrorCode PrintGrids(SamReport r, SamContact contact)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(r->comm, "    on nested grids, operator applications and time:\n"));
  for (PetscInt depth = 0; depth < SAM_NESTED; depth++) {
    const SamLevelWork *work[2] = {SamContactGetWork(contact, SAM_BALANCE_NORMAL, depth),
                                   SamContactGetWork(contact, SAM_BALANCE_TANGENTIAL, depth)},
                       *any     = work[work[0]->n[0] ? 0 : 1];
    double seconds[2]           = {work[0]->seconds, work[1]->seconds};
    char   size[32];

    if (!any->n[0]) continue;
    PetscCall(SamMax(r->comm, 2, seconds));
    (void)snprintf(size, sizeof(size), "%ld x %ld", (long)any->n[0], (long)any->n[1]);
    PetscCall(PetscPrintf(r->comm, "      %-16s normal %6ld %8.2f s, tangential %6ld %8.2f s\n", size,
                          (long)work[0]->applies, seconds[0], (long)work[1]->applies, seconds[1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the number of cells across the contact. */
static PetscErrorCode PrintExtent(SamReport r)
{
  const SamExtent *e        = &r->extent;
  char             size[48] = "none", spots[48] = "";

  PetscFunctionBegin;
  if (!r->extent_step) PetscFunctionReturn(PETSC_SUCCESS);
  if (e->zones)
    (void)snprintf(size, sizeof(size), e->whole ? "spans the grid" : "%.1f cells across", (double)e->across);
  if (e->zones > 1)
    (void)snprintf(spots, sizeof(spots), "%ld spots, the %s ", (long)e->zones, e->whole ? "largest" : "narrow ones");
  PetscCall(PetscPrintf(r->comm, "  %-10s  %s%s", "contact", spots, size));
  if (r->steps > 1) PetscCall(PetscPrintf(r->comm, " (step %" PetscInt_FMT ", at the largest load)", r->extent_step));
  PetscCall(PetscPrintf(r->comm, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the share of the edges that was not found. */
static PetscErrorCode PrintEdges(SamReport r)
{
  char where[48] = "", part[128];

  PetscFunctionBegin;
  if (!r->edges.step || r->edges.residual >= FOUND) PetscFunctionReturn(PETSC_SUCCESS);
  if (r->steps > 1)
    PetscCall(PetscSNPrintf(where, sizeof(where), " in step %" PetscInt_FMT " (the worst)", r->edges.step));
  if (r->edges.residual >= 0.005)
    PetscCall(PetscSNPrintf(part, sizeof(part), "reconstructed on %.0f %% of their length%s; elsewhere",
                            100 * (double)r->edges.residual, where));
  else
    PetscCall(PetscSNPrintf(part, sizeof(part), "not reconstructed%s:", where));
  PetscCall(PetscPrintf(r->comm,
                        "  %-10s  %s areas are counted in whole cells, minus %.2f of a cell per side of a cell that is "
                        "on an edge\n",
                        "edges", part, SAM_EDGE_FACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the error of the dissipated energy has an estimate: there are several steps, and friction. */
static PetscBool HasEnergy(SamReport r)
{
  return r->steps > 1 && r->energy[0] > 0 && r->energy[1] >= 0;
}

#define NEGLIGIBLE 1e-6 /* error relative to the energy that is not told exactly */
static PetscErrorCode PrintEnergy(SamReport r)
{
  const double cells    = r->slip.steps && !r->living ? r->slip.ring.error / (double)r->energy[0] : 0;
  const double steps    = (double)(r->energy[1] / r->energy[0]);
  char         more[48] = "";

  PetscFunctionBegin;
  if (cells > 0) (void)snprintf(more, sizeof(more), ", by the cells about %.2g %%", 100 * cells);
  if (HasEnergy(r))
    PetscCall(PetscPrintf(r->comm, "  %-10s  %.4g %s dissipated, error by the length of the load steps %s %.2g %%%s\n",
                          "energy", (double)r->energy[0], r->energy_unit, steps < NEGLIGIBLE ? "below" : "about",
                          100 * PetscMax(steps, NEGLIGIBLE), more));
  if (r->divided)
    PetscCall(PetscPrintf(r->comm,
                          "  %-10s  %" PetscInt_FMT " of %" PetscInt_FMT
                          " solved in parts, as N changes under shear (-step_divide no turns this off)\n",
                          "steps", r->divided, r->steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the dissipated energy beside its closed form. */
static PetscErrorCode PrintSlip(SamReport r)
{
  const char *const unit      = r->energy_unit;
  char              zones[48] = "";

  PetscFunctionBegin;
  if (!r->slip.steps || isnan(r->slip.closed)) PetscFunctionReturn(PETSC_SUCCESS);
  if (r->slip.narrow[0] < INFINITY)
    (void)snprintf(zones, sizeof(zones), "; slip zones %.2g cells wide", (double)r->slip.narrow[0]);
  PetscCall(PetscPrintf(r->comm, "  %-10s  %.4g %s dissipated, %.4g %s in closed form%s\n", "slip",
                        PetscMax(r->slip.energy, 0), unit, r->slip.closed, unit, zones));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamReportKeepSummaries(SamReport r, SamContact contact)
{
  SamReportSummary one;

  for (PetscInt k = 0; k < SAM_LAWS; k++) {
    SamReportSummary *kept = &r->summary[k];

    one.name = SamContactSummarize(contact, k, r->number + 1, &one.weight, one.text, sizeof(one.text));
    if (!one.name) break;
    if (one.text[0] && (!kept->text[0] || one.weight > kept->weight)) *kept = one;
  }
}

/* Prints the laws' lines about one of several steps; a single step has been printed. */
static PetscErrorCode PrintSummaries(SamReport r)
{
  PetscFunctionBegin;
  for (int k = 0; k < SAM_LAWS && r->steps > 1; k++)
    if (r->summary[k].text[0]) PetscCall(PetscPrintf(r->comm, "  %-10s  %s\n", r->summary[k].name, r->summary[k].text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintFiles(SamReport r)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < r->files; k++) {
    struct stat status = {.st_size = 0};
    char        size[32];

    if (!r->rank) (void)stat(r->name[k], &status);
    SamDescribeBytes((double)status.st_size, size, sizeof(size));
    PetscCall(PetscPrintf(r->comm, "  %-10s  %s: %s, %s\n", k ? "" : "written", r->name[k], r->content[k], size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Returns the peak memory of this process so far, bytes. getrusage() may include the memory of the launcher, before this
  program was loaded.
*/
static double LargestMemory(void)
{
  const double  bytes = SamMemoryRead("/proc/self/status", "VmHWM:");
  struct rusage used;

  if (bytes > 0) return bytes;
  getrusage(RUSAGE_SELF, &used);
  return 1024 * (double)used.ru_maxrss;
}

/* Prints time and memory, each the largest of all ranks. */
static PetscErrorCode PrintResources(SamReport r)
{
  struct rusage used;
  double        numbers[3];
  char          memory[32];

  PetscFunctionBegin;
  getrusage(RUSAGE_SELF, &used);
  numbers[0] = MPI_Wtime() - r->start;
  numbers[1] = (double)used.ru_utime.tv_sec + 1e-6 * (double)used.ru_utime.tv_usec + (double)used.ru_stime.tv_sec +
               1e-6 * (double)used.ru_stime.tv_usec;
  numbers[2] = LargestMemory();
  PetscCall(SamMax(r->comm, 3, numbers));
  SamDescribeBytes(numbers[2], memory, sizeof(memory));
  PetscCall(PetscPrintf(r->comm, "  %-10s  %.3f s, CPU %.2f s and memory %s of the largest rank\n", "used", numbers[0],
                        numbers[1], memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReportClosing(SamReport r, SamContact contact)
{
  static const char *const names[] = {"normal", "tangential", "equilibrium"};
  PetscViewer              viewer;

  PetscFunctionBegin;
  if (r->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  if (r->logging) {
    PetscCall(PrintTimes(r));
    PetscCall(PrintGrids(r, contact));
  } else
    PetscCall(PetscPrintf(r->comm, "\n"));
  for (PetscInt k = 0; k < 3 && r->worst[0].step && (r->profile || r->steps > 1);
       k++) { /* only steps with a solution */
    PetscCall(PetscPrintf(r->comm, k ? ", %s %.2e" : "  worst       %s %.2e", names[k], (double)r->worst[k].residual));
    if (r->steps > 1 && r->worst[k].step)
      PetscCall(PetscPrintf(r->comm, " (step %" PetscInt_FMT ")", r->worst[k].step));
    if (k == 2) PetscCall(PetscPrintf(r->comm, "\n"));
  }
  PetscCall(PrintExtent(r));
  PetscCall(PetscViewerASCIIGetStdout(r->comm, &viewer));
  if (r->steps > 1 && r->done) PetscCall(SamStepViewHalves(contact, " (last step)", viewer)); /* the only one has it */
  PetscCall(PrintEdges(r));
  PetscCall(PrintEnergy(r));
  PetscCall(PrintSlip(r));
  PetscCall(PrintSummaries(r));
  if (r->offer > 0)
    PetscCall(PetscPrintf(r->comm,
                          "  %-10s  of all numbers by -errors companion, which adds about %.0f %% of the time\n",
                          "errors", 100 * r->offer));
  PetscCall(PrintFiles(r));
  PetscCall(PrintResources(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
