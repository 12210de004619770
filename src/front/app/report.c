/* The report: the banner, a line for each load step, and messages. */
#include "report.h"
#include <petsam/private/motionimpl.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/contact.h>
#include <petsam/private/body.h>
#include <fftw3-mpi.h>
#include <hdf5.h>
#include <string.h>

/*
  Starts PETSc's log, from which the times by part are taken, unless there is a nested log (-log_view in XML or flame
  graph format), which does not have the times in that form.
*/
static PetscErrorCode StartLog(SamReport r)
{
  char      text[PETSC_MAX_PATH_LEN] = "";
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-log_view", text, sizeof(text), &set));
#if defined(PETSC_USE_LOG)
  r->logging = (strstr(text, "ascii_xml") || strstr(text, "ascii_flamegraph")) ? PETSC_FALSE : PETSC_TRUE;
  if (r->logging && !set) PetscCall(PetscLogDefaultBegin());
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SamOptionRow rows[] = {{"profile", "print times by part, iterations and the largest residuals of the run",
                                     SAM_OPTION_BOOL, .member = offsetof(struct _n_SamReport, profile)},
                                    {"quiet", "print nothing on stdout; warnings and errors go to stderr",
                                     SAM_OPTION_BOOL, .member = offsetof(struct _n_SamReport, quiet)},
                                    {"progress", "line within long steps: auto (on a terminal), always or never",
                                     SAM_OPTION_ENUM, offsetof(struct _n_SamReport, progress.mode),
                                     .words = "auto,always,never"}};

PetscErrorCode SamReportCreateFromOptions(const SamOptions *from, SamReport *report)
{
  SamReport r;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&r));
  *report  = r;
  r->comm  = from->comm;
  r->start = r->first = r->begin = MPI_Wtime();
  PetscCallMPI(MPI_Comm_rank(from->comm, &r->rank));
  PetscCall(SamOptionsRead(from, "What the run prints", SAM_OPTION_ROWS(rows), r, NULL));
  SamProgressStart(r);
  if (r->profile && !r->quiet) PetscCall(StartLog(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReportDestroy(SamReport *report)
{
  PetscFunctionBegin;
  if (!*report) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < (*report)->files; k++) {
    PetscCall(PetscFree((*report)->name[k]));
    PetscCall(PetscFree((*report)->content[k]));
  }
  PetscCall(PetscFree((*report)->held));
  PetscCall(PetscFree(*report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- banner ---- */

/* Writes the libraries with their versions: "PETSc 3.18.5, FFTW 3.3.10, HDF5 1.10.8, Open MPI v4.1.4". */
static PetscErrorCode DescribeLibraries(char text[], size_t size)
{
  char        mpi[MPI_MAX_LIBRARY_VERSION_STRING], fftw[64];
  const char *number = strchr(fftw_version, '-');
  PetscInt    petsc[3];
  unsigned    hdf5[3];
  int         length;

  PetscFunctionBegin;
  PetscCall(PetscGetVersionNumber(&petsc[0], &petsc[1], &petsc[2], NULL));
  PetscCheck(H5get_libversion(&hdf5[0], &hdf5[1], &hdf5[2]) >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "H5get_libversion() failed");
  PetscCallMPI(MPI_Get_library_version(mpi, &length));
  mpi[strcspn(mpi, ",\n")] = '\0'; /* the rest describes the build */
  snprintf(fftw, sizeof(fftw), "%s", number ? number + 1 : fftw_version);
  fftw[strcspn(fftw, "-")] = '\0';
  snprintf(text, size, "PETSc %d.%d.%d, FFTW %s, HDF5 %u.%u.%u, %s", (int)petsc[0], (int)petsc[1], (int)petsc[2], fftw,
           hdf5[0], hdf5[1], hdf5[2], mpi);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the checkpoint from which the run continues. */
static PetscErrorCode PrintRestart(SamReport r, const SamSimulationStart *s)
{
  PetscFunctionBegin;
  if (!s->restart) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(r->comm, "  %-10s  after %s, from %s\n", "restart", s->after, s->restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints what bodies take from the table of materials. */
static PetscErrorCode PrintNamed(SamReport r, SamPair pair)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    const char *named = SamBodyNamed(SamPairBody(pair, b));

    if (named[0]) PetscCall(PetscPrintf(r->comm, "  body %-5d  %s\n", (int)b + 1, named));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReportBanner(SamReport r, const SamSetup *setup, const double bytes[2],
                               const SamSimulationStart *start)
{
  const SamGrid grid = setup->grid;
  PetscMPIInt   ranks;
  double        nodes, fullest, most = bytes[0];
  char          libraries[512], memory[32];

  PetscFunctionBegin;
  r->steps = start->steps;
  SamReportChooseColumns(r, start->loads);
  if (!start->companions) r->offer = start->share;
  if (r->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(r->comm, &ranks));
  PetscCall(SamCountNodes(r->comm, &nodes, &fullest));
  PetscCall(SamMax(r->comm, 1, &most));
  PetscCall(DescribeLibraries(libraries, sizeof(libraries)));
  PetscCall(PetscPrintf(r->comm, "petsam %s: partial-slip contact by the semi-analytical method\n", PETSAM_VERSION));
  PetscCall(PetscPrintf(r->comm, "  %-10s  %s\n", "libraries", libraries));
  PetscCall(PetscPrintf(r->comm, "  %-10s  %d on %d node%s\n", "ranks", ranks, (int)nodes, nodes > 1 ? "s" : ""));
  PetscCall(PetscPrintf(r->comm, "  %-10s  %" PetscInt_FMT " x %" PetscInt_FMT " cells of %.6g m x %.6g m\n", "grid",
                        grid->nx, grid->ny, (double)grid->dx, (double)grid->dy));
  if (r->accuracy)
    PetscCall(PetscPrintf(r->comm, "  %-10s  %.3g %%: %ld trial%s in %.2g s chose%s\n", "accuracy",
                          100 * (double)r->accuracy->error, (long)r->accuracy->trials,
                          r->accuracy->trials == 1 ? "" : "s", r->accuracy->seconds,
                          r->accuracy->chosen[0] ? r->accuracy->chosen : " nothing, as all is given"));
  if (SamGridIsRow(grid))
    PetscCall(PetscPrintf(r->comm, "  %-10s  strain: loads, areas, energies and volumes per metre of length%s\n",
                          "plane", ranks > 1 ? "; one rank works, the others wait" : ""));
  PetscCall(PrintNamed(r, setup->pair));
  SamDescribeBytes(most, memory, sizeof(memory));
  PetscCall(PetscPrintf(r->comm, "  %-10s  about %s per rank\n", "memory", memory));
  PetscCall(PetscPrintf(r->comm, "  %-10s  %" PetscInt_FMT "%s, results %s%s%s\n", "steps", start->steps,
                        start->cyclic ? " to the end of the first cycle" : "",
                        start->results ? "in " : "not kept (no -output)", start->results ? start->results : "",
                        start->replaced ? ", replacing those there" : ""));
  if (start->results) PetscCall(PetscPrintf(r->comm, "  %-10s  %s\n", "file size", start->size));
  if (start->companions)
    PetscCall(PetscPrintf(r->comm, "  %-10s  by runs %s, which add about %.0f %% of the time\n", "errors",
                          start->companions, 100 * start->share));
  if (start->gradients && !start->companions)
    PetscCall(PetscPrintf(r->comm, "  %-10s  of the derivatives unknown; -errors companion finds them\n", "errors"));
  if (start->seconds > 0)
    PetscCall(PetscPrintf(r->comm, "  %-10s  roughly %.2g s a step, %.2g s in all%s; nothing is solved (-dry_run)\n",
                          "time", start->seconds, start->seconds * (double)start->steps,
                          start->cyclic ? " to there" : ""));
  PetscCall(SamReportScaling(r, grid->ny, ranks, (const double[2]){most, bytes[1]}, start));
  if (start->when[0]) PetscCall(PetscPrintf(r->comm, "  %-10s  %s\n", "checkpoint", start->when));
  PetscCall(PrintRestart(r, start));
  PetscCall(PetscPrintf(r->comm, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps ---- */

/* Ends the set-up, once; the parts of the run that have begun in it, as plastic strain and files, are no part of it. */
static PetscErrorCode EndSetUp(SamReport r)
{
  PetscFunctionBegin;
  if (r->first > r->start) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamReportGetPartTime(r, &r->parts_before));
  r->first = MPI_Wtime();
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BeginStep(SamReport r, PetscInt number, SamContact contact)
{
  PetscFunctionBegin;
  r->number = number;
  r->begin  = MPI_Wtime();
  PetscCall(EndSetUp(r));
  PetscCall(SamProgressWatch(r, contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the mean time (s) of the last lines; there have been `lines`, and the latest took `seconds`. */
static double MeanTime(SamReport r, PetscInt lines, double seconds)
{
  const PetscInt known = PetscMin(lines, SAM_REPORT_RECENT);
  double         sum   = 0;

  r->recent[(lines - 1) % SAM_REPORT_RECENT] = seconds;
  for (PetscInt k = 0; k < known; k++) sum += r->recent[k];
  return sum / (double)known;
}

/* Keeps the largest residuals, also those of the parts of a divided step. */
static PetscErrorCode KeepWorst(SamReport r, SamContact contact)
{
  static const char *const names[3] = {"normal_residual", "tangential_residual", "equilibrium_residual"};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++) {
    PetscReal residual, worst;

    PetscCall(SamContactGetNumber(contact, names[k], &residual));
    worst = SamLarger(r->worst[k].residual, residual);
    if (worst > r->worst[k].residual || r->done == 1) r->worst[k].step = r->number + 1;
    r->worst[k].residual = worst;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode KeepEnergy(SamReport r, SamContact contact, const SamStep *step)
{
  PetscReal energy, error;
  PetscBool touches;
  SamState  state;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(contact, "energy_error", &error));
  PetscCall(SamContactGetState(contact, &state));
  r->energy_unit = SamStateUnitOf(state, "dissipated_energy");
  touches = SamStateReadNumbers(state, SamStateFindNumber(state, SAM_TOUCHING))[0] > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (isnan(error)) r->energy[1] = -INFINITY; /* rolling: there is no estimate for all steps */
  if (isnan(error)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetNumber(contact, "dissipated_energy", &energy));
  r->energy[0] += energy;
  /* A first step of similar bodies that applies N, then the rest, causes no error. */
  if (r->number || touches || step->control.together) r->energy[1] += error;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode KeepEdges(SamReport r, SamContact contact)
{
  PetscReal area, accepted;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(contact, "contact_area", &area));
  PetscCall(SamContactGetNumber(contact, "edge_accepted", &accepted));
  if (!SamContactGetSettings(contact).edges || !(area > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!r->edges.step || accepted < r->edges.residual) r->edges = (SamReportWorst){accepted, r->number + 1};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints a step's message to stderr, from rank 0; adds the deciding option unless the message names it. */
static void PrintMessage(SamReport r, const char where[], const SamStep *step)
{
  const PetscBool edge = !step->status && step->check.edge > 0; /* and the option allows it */
  char            text[sizeof(step->message) + 64];

  if (edge && r->edge_told) return;
  if (edge) r->edge_told = PETSC_TRUE;
  if (r->rank || !step->message[0]) return;
  fflush(stdout);
  SamNameSetting(step->message, step->setting, text, sizeof(text));
  SamPrintMessage("petsam", "%s%s%s%s", step->status ? "" : "warning: ", where, where[0] ? ": " : "", text);
}

static void Warn(SamReport r, const char text[], const char option[])
{
  SamStep said = {.status = SAM_STATUS_CONVERGED};

  (void)snprintf(said.message, sizeof(said.message), "%s", text);
  (void)snprintf(said.setting, sizeof(said.setting), "%s", option);
  PrintMessage(r, "", &said);
}

static PetscErrorCode CountStep(SamReport r, SamContact contact, PetscInt number, const SamStep *step)
{
  PetscFunctionBegin;
  r->number = number;
  r->done++;
  if (step->status != SAM_STATUS_NO_EQUILIBRIUM) {
    PetscCall(KeepWorst(r, contact));
    PetscCall(KeepEdges(r, contact));
    PetscCall(KeepEnergy(r, contact, step));
    SamReportKeepSummaries(r, contact);
  }
  /* No energy is reported for a run that failed, or that ended at the edge of the grid. */
  if (step->status != SAM_STATUS_CONVERGED) r->energy[1] = -INFINITY;
  if (step->status != SAM_STATUS_CONVERGED) r->offer = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EndStep(SamReport r, SamContact contact, const SamStep *step)
{
  const double seconds   = MPI_Wtime() - r->begin;
  char         where[32] = "";
  PetscViewer  viewer;

  PetscFunctionBegin;
  if (r->steps > 1) PetscCall(PetscSNPrintf(where, sizeof(where), "step %" PetscInt_FMT, r->number + 1));
  SamProgressErase(r);
  PetscCall(CountStep(r, contact, r->number, step));
  if (!r->quiet) {
    PetscCall(PetscViewerASCIIGetStdout(r->comm, &viewer));
    PetscCall(
      SamReportStepLine(r, step, contact, seconds, MeanTime(r, r->done, seconds) * (double)(r->steps - r->number - 1)));
    if (r->steps == 1) PetscCall(SamStepView(step, contact, r->profile, viewer));
  }
  PrintMessage(r, where, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- cycles of a life ---- */

static PetscErrorCode BeginCycle(SamReport r, SamContact contact)
{
  PetscFunctionBegin;
  r->living = PETSC_TRUE;
  PetscCall(EndSetUp(r));
  if (!r->cycles) r->begin = MPI_Wtime(); /* later cycles begin with the jump before them */
  PetscCall(SamProgressWatch(r, contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Estimates the number of jumps over `left` cycles if they continue to grow as the last one did from `before`. */
static double JumpsLeft(double jump, double before, double left)
{
  const double growth = before > 0 ? PetscMin(1.5, PetscMax(1.0, jump / before)) : 1.5;

  if (jump <= 0) return 0;
  return growth < 1.001 ? left / jump : log(1 + left / jump * (growth - 1) / growth) / log(growth);
}

enum { CYCLE_SECONDS = 11, CYCLE_LEFT, CYCLE_COLUMNS };
static const SamReportColumn columns[CYCLE_COLUMNS] = {{"cycles", NULL, "cycle", 10, 9, 0},
                                                       {"jump", NULL, "jump", 9, 6, 0},
                                                       {"error", NULL, "error", 8, 0, 0},
                                                       {"vol.1", NULL, "volume1", 10, 3, 0},
                                                       {"vol.2", NULL, "volume2", 10, 3, 0},
                                                       {"depth1", NULL, "depth_max1", 10, 3, 0},
                                                       {"depth2", NULL, "depth_max2", 10, 3, 0},
                                                       {"energy", "en", "dissipated_energy", 10, 3, 0},
                                                       {"area", "width", "contact_area", 9, 3, 0},
                                                       {"p max", NULL, "pressure_max", 9, 3, 0},
                                                       {"computed", NULL, "computed", 9, 9, 0},
                                                       {"s", NULL, "", 7, 0, 0},
                                                       {"left", NULL, "", 9, 0, 0}};

/* Ends a cycle; `cycle`: the numbers of the computed cycle; `cycles`: the number of all cycles so far. */
static PetscErrorCode EndCycle(SamReport r, SamContact contact, SamState cycle, PetscReal cycles)
{
  const SamGrid grid = SamContactGetGrid(contact);
  const double  done = SamReportNumber(cycle, "cycle"), jump = SamReportNumber(cycle, "jump"), now = MPI_Wtime(),
               seconds = now - r->begin;
  SamReportCell cells[CYCLE_COLUMNS];

  PetscFunctionBegin;
  SamProgressErase(r);
  r->cycles++;
  r->begin = now;
  if (r->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < CYCLE_COLUMNS && r->cycles == 1; k++) SamReportHeading(grid, cycle, &columns[k], cells[k]);
  if (r->cycles == 1) PetscCall(SamReportLine(r, CYCLE_COLUMNS, columns, cells));
  for (int k = 0; k < CYCLE_SECONDS; k++)
    SamReportValue(&columns[k], SamReportNumber(cycle, columns[k].number), cells[k]);
  SamReportSeconds(seconds, cells[CYCLE_SECONDS]);
  SamReportDuration(MeanTime(r, r->cycles, seconds) * JumpsLeft(jump, (double)r->jump, (double)cycles - done),
                    cells[CYCLE_LEFT], sizeof(cells[CYCLE_LEFT]));
  if (jump <= 0 && done < cycles) (void)snprintf(cells[CYCLE_LEFT], sizeof(cells[CYCLE_LEFT]), "unknown");
  r->jump = jump;
  PetscCall(SamReportLine(r, CYCLE_COLUMNS, columns, cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all events ---- */

static PetscErrorCode AddFile(SamReport r, const char name[], const char content[])
{
  PetscFunctionBegin;
  PetscCheck(r->files < SAM_REPORT_FILES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d files",
             SAM_REPORT_FILES);
  PetscCall(PetscStrallocpy(name, &r->name[r->files]));
  PetscCall(PetscStrallocpy(content, &r->content[r->files]));
  r->files++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints a message. */
static PetscErrorCode Say(SamReport r, const SamSimulationEvent *news)
{
  PetscFunctionBegin;
  SamProgressErase(r);
  PetscCall(SamReportPrintHeld(r));
  if (news->kind == SAM_NOTIFY_MESSAGE)
    PrintMessage(r, news->text, news->result);
  else if (news->kind == SAM_NOTIFY_ADVICE)
    Warn(r, news->text, news->setting);
  else if (!r->rank)
    SamPrintMessage("petsam", "%s", news->text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the numbers with their errors, and the cost of these. */
static PetscErrorCode PrintErrors(SamReport r, const SamErrorTable *t)
{
  const double total             = MPI_Wtime() - r->start;
  PetscBool    shown[SAM_CAUSES] = {PETSC_TRUE, PETSC_TRUE};

  PetscFunctionBegin;
  if (r->quiet || !t->count) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < t->count; k++)
    for (int c = 0; c < SAM_CAUSES; c++)
      if (t->row[k].of[c] > 0) shown[c] = PETSC_TRUE;
  PetscCall(PetscPrintf(r->comm,
                        "\n  errors of the last numbers, by runs %s (%.0f %% of the time)\n    %-22s %14s %10s",
                        t->runs, 100 * t->seconds / total, "", "", "error"));
  for (int c = 0; c < SAM_CAUSES; c++)
    if (shown[c]) PetscCall(PetscPrintf(r->comm, "  by %-6s", SamCauseNames[c]));
  for (PetscInt k = 0; k < t->count; k++) {
    const SamErrorRow *row = &t->row[k];
    char               name[SAM_ERROR_NAME + 24], part[1 + SAM_CAUSES][SAM_ERROR_TEXT];

    (void)snprintf(name, sizeof(name), "%s/%s", row->name, row->unit);
    (void)SamErrorWrite(row->error, part[0], sizeof(part[0]));
    for (int c = 0; c < SAM_CAUSES; c++) (void)SamErrorWrite(row->of[c], part[1 + c], sizeof(part[1 + c]));
    if (row->of[SAM_CAUSE_STEPS] == 0 && isnan(row->run[SAM_RUN_OTHER]))
      (void)snprintf(part[2], sizeof(part[2]), "none");
    PetscCall(PetscPrintf(r->comm, "\n    %-22s %14.6g", name, row->value));
    for (int c = 0; c < 1 + SAM_CAUSES; c++)
      if (!c || shown[c - 1]) PetscCall(PetscPrintf(r->comm, " %10s", part[c]));
  }
  PetscCall(PetscPrintf(r->comm, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamReportSetAccuracy(SamReport r, const SamAccuracy *accuracy)
{
  r->accuracy = accuracy->error > 0 ? accuracy : NULL;
}

/* Compares the largest error with that asked for, and warns if it is larger. */
static PetscErrorCode CompareErrors(SamReport r, const SamErrorTable *t)
{
  const SamErrorRow *worst = r->accuracy ? SamAccuracyWorst(r->accuracy, t) : NULL;
  char      error[SAM_ERROR_TEXT], wanted[SAM_ERROR_TEXT + 32] = "", limit[160] = "", missed[480] = "", text[768];
  PetscBool reached;

  PetscFunctionBegin;
  if (!worst) PetscFunctionReturn(PETSC_SUCCESS);
  reached = worst->error <= r->accuracy->error ? PETSC_TRUE : PETSC_FALSE;
  if (!reached)
    (void)snprintf(wanted, sizeof(wanted), "-accuracy %.3g %% is not reached: ", 100 * (double)r->accuracy->error);
  if (!reached) {
    const char *const cure[SAM_CAUSES] = {strstr(r->accuracy->chosen, "-grid_n")
                                            ? "a smaller -accuracy chooses finer cells"
                                            : "the cells are given: leave -grid_n out, or give more",
                                          strstr(r->accuracy->chosen, "-steps")
                                            ? "a smaller -accuracy chooses more steps"
                                            : "the steps are given, as by -steps or in a single row",
                                          "the layers are given", "the compliance is given"};

    (void)snprintf(limit, sizeof(limit), "; %s", r->accuracy->limit[0] ? r->accuracy->limit : cure[worst->cause]);
    SamAccuracyWriteMissed(r->accuracy, t, worst, missed, sizeof(missed));
  }
  (void)snprintf(text, sizeof(text), "%sthe maximum error is %s, of %s, by the %s%s%s", wanted,
                 SamErrorWrite(worst->error, error, sizeof(error)), worst->name, SamCauseNames[worst->cause], limit,
                 missed);
  if (!reached)
    PetscCall(Say(r, &(SamSimulationEvent){.kind = SAM_NOTIFY_ADVICE, .text = text, .setting = ""}));
  else if (!r->quiet)
    PetscCall(PetscPrintf(r->comm, "    %s\n", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReportNews(SamReport r, SamContact contact, const SamSimulationEvent *news)
{
  PetscFunctionBegin;
  r->holds = news->waits;
  switch (news->kind) {
  case SAM_NOTIFY_BEGIN:
    break;
  case SAM_NOTIFY_STEP_BEGINS:
    PetscCall(BeginStep(r, news->step, contact));
    break;
  case SAM_NOTIFY_DIVIDED:
    r->divided++;
    break;
  case SAM_NOTIFY_STEP:
    PetscCall(EndStep(r, contact, news->result));
    break;
  case SAM_NOTIFY_CYCLE_BEGINS:
    PetscCall(BeginCycle(r, contact));
    break;
  case SAM_NOTIFY_CYCLE_STEP:
    PetscCall(CountStep(r, contact, news->step, news->result));
    break;
  case SAM_NOTIFY_CYCLE:
    PetscCall(EndCycle(r, contact, news->cycle, news->cycles));
    break;
  case SAM_NOTIFY_EXTENT:
    r->extent      = *news->extent;
    r->extent_step = news->step + 1;
    break;
  case SAM_NOTIFY_SLIP:
    r->slip = *news->slip;
    break;
  case SAM_NOTIFY_ERRORS:
    PetscCall(PrintErrors(r, news->errors));
    PetscCall(CompareErrors(r, news->errors));
    break;
  case SAM_NOTIFY_GRADIENT:
    if (!r->quiet) PetscCall(PetscPrintf(r->comm, "%s  gradient    %s\n", r->gradients++ ? "" : "\n", news->text));
    break;
  case SAM_NOTIFY_FILE:
    PetscCall(AddFile(r, news->text, news->setting));
    break;
  case SAM_NOTIFY_MESSAGE:
  case SAM_NOTIFY_ADVICE:
  case SAM_NOTIFY_STOPPED:
    PetscCall(Say(r, news));
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
