/* Fatigue parameters of the chosen steps, taken as one closed cycle, from the stresses of all of them. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>

#define BLOCK 256 /* points between two looks at the clock */

/* The states at one point, and what is made of them. */
typedef struct {
  const SamStressRun *run;
  const SamPoints    *points;
  PetscInt            surface;               /* points on the surface, the first ones */
  const double       *slip;                  /* of these: (states, 2, surface) */
  double             *stress, *shear, *path; /* of a point: [component][state] */
} Cycle;

PetscBool SamCycleWanted(const SamStressRun *run)
{
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++)
    if (run->request.wants[q]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* ---- slip on the surface ---- */

/* A field's values in the section's line of cells, on all ranks. */
static PetscErrorCode GatherLine(const SamStressRun *run, const double field[], PetscInt length, double line[])
{
  const SamGrid g = run->grid;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(line, length));
  for (PetscInt k = 0; k < length; k++) {
    const PetscBool row = run->request.axis == SAM_SECTION_X;
    const PetscInt  j = (row ? run->index : k) - g->row_start, i = row ? k : run->index;

    if (j >= 0 && j < g->rows) line[k] = field[j * g->nx + i];
  }
  /* of each value all terms but one are zero */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, line, (PetscMPIInt)length, MPI_DOUBLE, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slip of all states on the surface, in the order of Cycle.slip; `length`: cells of a map's rows or of the line. */
static PetscErrorCode ReadSlip(const SamStressRun *run, PetscInt length, double slip[])
{
  static const SamResultsField fields[] = {SAM_RESULTS_SLIP_X, SAM_RESULTS_SLIP_Y};
  double                      *field;

  PetscFunctionBegin;
  PetscCall(SamAllocate(sizeof(double) * (size_t)run->grid->cells, &field));
  for (PetscInt s = 0; s < run->steps; s++)
    for (PetscInt c = 0; c < 2; c++) {
      double *const to = slip + (2 * s + c) * (ptrdiff_t)length;

      PetscCall(SamResultsRead(run->results, run->saved[s], fields[c], run->request.section ? field : to));
      if (run->request.section) PetscCall(GatherLine(run, field, length, to));
    }
  SamFree(field);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- points ---- */

static void GatherStress(const Cycle *c, PetscInt point)
{
  const PetscInt states = c->run->steps, n = c->points->count;

  for (PetscInt s = 0; s < states; s++)
    for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++)
      c->stress[k * states + s] = c->points->stress[(s * SAM_STRESS_COMPONENTS + k) * (ptrdiff_t)n + point];
}

#define MOST 4 /* components of a quantity: the value, and the normal of its plane */

/* Ruiz's parameters exist on the surface only. There the stress is the shear but for the sign, which does not count. */
static void ComputeRuiz(const Cycle *c, PetscInt point, double value[2])
{
  const PetscInt states = c->run->steps;

  value[0] = value[1] = NAN;
  if (point >= c->surface) return;
  for (PetscInt s = 0; s < states; s++)
    for (PetscInt k = 0; k < 2; k++) {
      c->shear[k * states + s] = c->stress[(k ? SAM_STRESS_YZ : SAM_STRESS_XZ) * states + s];
      c->path[k * states + s]  = c->slip[(2 * s + k) * (ptrdiff_t)c->surface + point];
    }
  SamFatigueRuiz(states, c->stress, c->shear, c->path, &value[0], &value[1]);
}

/* Computes a quantity's components at all points, into value[component * count + point]. */
static PetscErrorCode ComputeAll(SamStressRun *run, const Cycle *c, SamQuantity quantity, double values[], double done,
                                 double share)
{
  const PetscInt            n = c->points->count, components = SamQuantityComponents(quantity);
  const SamFatigueConstants constants = SamStressRequestConstants(&run->request, run->young, run->poisson);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; i++) {
    double value[MOST] = {0, 0, 0, 0};

    GatherStress(c, i);
    if (quantity == SAM_QUANTITY_RUIZ)
      ComputeRuiz(c, i, value);
    else
      PetscCall(SamFatigueCompute((SamFatigueParameter)(quantity - SAM_QUANTITY_CROSSLAND), &constants, run->steps,
                                  c->stress, &value[0], &value[1]));
    for (PetscInt k = 0; k < components; k++) values[k * (ptrdiff_t)n + i] = value[k];
    if (!isnan(value[0])) SamLargestKeep(&run->fatigue[quantity], value[0], c->points->first + (double)i);
    if (i % BLOCK == BLOCK - 1)
      PetscCall(SamStressRunTell(run, "fatigue parameters", done + share * (double)(i + 1) / (double)n, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamStressRun *run, const SamPoints *p, Cycle *c)
{
  const PetscInt length = !run->request.section                ? p->count
                          : run->request.axis == SAM_SECTION_X ? run->grid->nx
                                                               : run->grid->ny;
  const PetscInt states = run->steps;
  double        *slip   = NULL;

  PetscFunctionBegin;
  /* the surface is the first depth, where Ruiz's parameters are asked for */
  *c = (Cycle){.run = run, .points = p, .surface = p->depth == 0 && p->depths > 0 ? length : 0};
  if (run->request.wants[SAM_QUANTITY_RUIZ] && (run->request.section || p->depth == 0)) { /* collective */
    PetscCall(SamAllocate(sizeof(double) * (size_t)(2 * states) * (size_t)length, &slip));
    PetscCall(ReadSlip(run, length, slip));
  }
  c->slip = slip;
  PetscCall(PetscMalloc3(SAM_STRESS_COMPONENTS * states, &c->stress, 2 * states, &c->shear, 2 * states, &c->path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Cycle *c)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(c->stress, c->shear, c->path));
  SamFree((void *)c->slip);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCycleWrite(SamStressRun *run, const SamPoints *p, double done, double share)
{
  PetscInt wanted = 0, k = 0;
  double  *values;
  Cycle    c;

  PetscFunctionBegin;
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) wanted += run->request.wants[q];
  PetscCall(Create(run, p, &c));
  PetscCall(SamAllocate(sizeof(double) * MOST * (size_t)p->count, &values));
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) {
    if (!run->request.wants[q]) continue;
    PetscCall(
      ComputeAll(run, &c, (SamQuantity)q, values, done + share * (double)k / (double)wanted, share / (double)wanted));
    for (PetscInt part = 0; part < SamQuantityComponents((SamQuantity)q); part++)
      PetscCall(SamStressFileWrite(run->file, (SamQuantity)q, part, 0, p->depth, p->depths,
                                   values + part * (ptrdiff_t)p->count));
    k++;
  }
  SamFree(values);
  PetscCall(Destroy(&c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- whether it is closed ---- */

/* The part of the largest traction by which the ends of a cycle may differ. */
#define CLOSED 0.01
/* That by which they differ at most when a cycle comes again that is not yet steady. */
#define AGAIN 0.05

/* The tractions of the last step, of 3 components, and room for those of another one. */
typedef struct {
  double *last, *other;
} Ends;

/* The largest difference and size, of the pressure and of the shear, of a saved step and the last one. */
static PetscErrorCode CompareWithLast(SamStressRun *run, PetscInt saved, const Ends *ends, PetscReal most[4])
{
  const PetscInt      cells = run->grid->cells;
  const double *const a = ends->last, *const b = ends->other;

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) most[k] = 0;
  PetscCall(SamTractionsRead(run, saved, (double *[]){ends->other, ends->other + cells, ends->other + 2 * cells}));
  for (PetscInt k = 0; k < 3 * cells; k++) {
    PetscReal *const m = most + (k < cells ? 0 : 2);

    m[0] = PetscMax(m[0], fabs(a[k] - b[k]));
    m[1] = PetscMax(m[1], PetscMax(fabs(a[k]), fabs(b[k])));
  }
  PetscCall(SamMax(run->grid->comm, 4, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Warn(const SamStressRun *run, const char text[])
{
  PetscMPIInt rank;

  (void)MPI_Comm_rank(run->grid->comm, &rank);
  if (!rank) fprintf(stderr, "petsam-stress: warning: -steps: %s\n", text);
}

/* In a life: whether the steps are of one computed cycle; the others are of other surfaces. */
static PetscErrorCode CheckLife(SamStressRun *run, PetscBool *life)
{
  double   cycle[2] = {0, 0};
  PetscInt step;
  char     text[192];

  PetscFunctionBegin;
  *life = PETSC_FALSE;
  for (int k = 0; k < 2; k++) {
    PetscCall(SamResultsGetSaved(run->results, run->saved[k ? run->steps - 1 : 0], &step, NULL));
    PetscCall(SamResultsReadCycle(run->results, step, &cycle[k]));
  }
  *life = cycle[0] > 0 || cycle[1] > 0;
  if (cycle[0] == cycle[1]) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(text, sizeof(text),
                 "of several cycles of a life, from %g to %g, which are taken as one: expected the steps of one",
                 cycle[0], cycle[1]);
  Warn(run, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the cycle closes: by the step before the first. */
static PetscErrorCode CheckEnds(SamStressRun *run, const Ends *ends)
{
  const PetscInt before = run->saved[0] - (run->saved[1] - run->saved[0]), last = run->saved[run->steps - 1];
  PetscReal      most[4];
  PetscInt       step[2];
  char           text[256];

  PetscFunctionBegin;
  if (before < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamResultsGetSaved(run->results, before, &step[0], NULL));
  PetscCall(SamResultsGetSaved(run->results, last, &step[1], NULL));
  PetscCall(CompareWithLast(run, before, ends, most));
  for (int f = 0; f < 2; f++) {
    if (most[2 * f] <= CLOSED * most[2 * f + 1]) continue;
    (void)snprintf(
      text, sizeof(text),
      "not a closed cycle, or not a steady one: the %s of step %ld, the last one, differs from that of step "
      "%ld, before the first, by up to %.0f %% of the largest",
      f ? "shear" : "pressure", (long)step[1], (long)step[0], 100 * (double)(most[2 * f] / most[2 * f + 1]));
    Warn(run, text);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says that the cycle ends with chosen step k already. */
static PetscErrorCode WarnOfMore(SamStressRun *run, PetscInt k)
{
  const PetscInt stride = run->saved[k + 1] - run->saved[k];
  PetscInt       step[3];
  char           text[256], every[24] = "";

  PetscFunctionBegin;
  PetscCall(SamResultsGetSaved(run->results, run->saved[k], &step[0], NULL));
  PetscCall(SamResultsGetSaved(run->results, run->saved[k + 1], &step[1], NULL));
  PetscCall(SamResultsGetSaved(run->results, run->saved[run->steps - 1], &step[2], NULL));
  if (stride > 1) (void)snprintf(every, sizeof(every), ":%ld", (long)stride);
  (void)snprintf(
    text, sizeof(text),
    "more than one cycle, taken as one: tractions of step %ld are those of the last one already; one cycle is "
    "-steps %ld:%ld%s",
    (long)step[0], (long)step[1], (long)step[2], every);
  Warn(run, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Whether the cycle comes more than once, or after what leads to it: a step is as the last, with others between and
  before. So neither steps near the cycle's start count nor those at which the loads are held.
*/
static PetscErrorCode CheckOnce(SamStressRun *run, const Ends *ends)
{
  const PetscInt last      = run->steps - 1;
  PetscReal      least     = AGAIN;
  PetscInt       nearest   = -1;
  PetscBool      has_begun = PETSC_FALSE; /* a step that differs has been seen */

  PetscFunctionBegin;
  for (PetscInt k = last - 1; k >= 0; k--) {
    PetscReal most[4], difference = 0;

    PetscCall(CompareWithLast(run, run->saved[k], ends, most));
    for (int f = 0; f < 4; f += 2)
      if (most[f] > 0) difference = PetscMax(difference, most[f] / most[f + 1]);
    if (difference > AGAIN) {
      has_begun = PETSC_TRUE;
      if (nearest < 0) continue;
      PetscCall(WarnOfMore(run, nearest));
      break;
    }
    if (!has_begun || difference > least) continue;
    least   = difference;
    nearest = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCycleCheckClosed(SamStressRun *run)
{
  const PetscInt cells = run->grid->cells;
  PetscBool      life;
  Ends           ends;

  PetscFunctionBegin;
  PetscCall(CheckLife(run, &life));
  if (life) PetscFunctionReturn(PETSC_SUCCESS); /* petsam has closed the loop */
  PetscCall(PetscMalloc2(3 * cells, &ends.last, 3 * cells, &ends.other));
  PetscCall(SamTractionsRead(run, run->saved[run->steps - 1],
                             (double *[]){ends.last, ends.last + cells, ends.last + 2 * cells}));
  PetscCall(CheckEnds(run, &ends));
  PetscCall(CheckOnce(run, &ends));
  PetscCall(PetscFree2(ends.last, ends.other));
  PetscFunctionReturn(PETSC_SUCCESS);
}
