/* Whether the chosen steps are one closed cycle, as a fatigue parameter takes them. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>

/* The part of the largest traction by which the ends of a cycle may differ. */
#define CLOSED 0.01
/* That by which they differ at most when a cycle comes again that is not yet steady. */
#define AGAIN 0.05

/* The tractions of the last step, of 3 components, and room for those of another one. */
typedef struct {
  double *last, *other;
} Ends;

/* The tractions of a saved step, of 3 components. */
static PetscErrorCode ReadTractions(SamStressRun *run, PetscInt saved, double to[])
{
  PetscFunctionBegin;
  for (int f = SAM_RESULTS_PRESSURE; f <= SAM_RESULTS_SHEAR_Y; f++)
    PetscCall(SamResultsRead(run->results, saved, (SamResultsField)f, to + f * (ptrdiff_t)run->grid->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest difference and size, of the pressure and of the shear, of a saved step and the last one. */
static PetscErrorCode CompareWithLast(SamStressRun *run, PetscInt saved, const Ends *ends, PetscReal most[4])
{
  const PetscInt      cells = run->grid->cells;
  const double *const a = ends->last, *const b = ends->other;

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) most[k] = 0;
  PetscCall(ReadTractions(run, saved, ends->other));
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
    PetscCall(SamResultsReadNumber(run->results, step, SAM_RESULTS_CYCLE, &cycle[k]));
  }
  *life = cycle[0] > 0 || cycle[1] > 0;
  if (cycle[0] == cycle[1]) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(text, sizeof(text),
                 "of several cycles of a wear simulation, from %g to %g, treated as one: select the steps of one cycle",
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
      "%ld, before the first, by up to %.0f %% of the maximum",
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
    "more than one cycle: step %ld already has the last step's tractions; for one cycle use -steps %ld:%ld%s",
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
  PetscCall(ReadTractions(run, run->saved[run->steps - 1], ends.last));
  PetscCall(CheckEnds(run, &ends));
  PetscCall(CheckOnce(run, &ends));
  PetscCall(PetscFree2(ends.last, ends.other));
  PetscFunctionReturn(PETSC_SUCCESS);
}
