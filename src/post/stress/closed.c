/* Checks that the steps are one closed cycle, as a fatigue parameter takes them. */
#include "evaluationimpl.h"

/* Largest difference between the ends of a closed cycle, relative to the largest traction */
#define CLOSED 0.01
/* Largest difference between the ends of a cycle that does not yet repeat itself, likewise */
#define AGAIN 0.05

/* The tractions of the last step, of 3 components, and memory for those of another step */
typedef struct {
  double *last, *other;
} Ends;

static PetscErrorCode NumberOf(SamEvaluation e, PetscInt step, SamStepNumber which, double *number)
{
  return (*e->source.number)(e->source.context, step, which, number);
}

/*
  Finds the largest difference and the largest size, of the pressure and of the shear, for a step and the last step;
  tractions before the first step are zero.
*/
static PetscErrorCode CompareWithLast(SamEvaluation e, PetscInt step, const Ends *ends, PetscReal most[4])
{
  const PetscInt      cells = e->grid->cells;
  const double *const a = ends->last, *const b = ends->other;

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) most[k] = 0;
  PetscCall(PetscArrayzero(ends->other, 3 * cells));
  if (step >= 0 || e->source.before)
    PetscCall(SamEvaluationReadTractions(e, step, PETSC_TRUE,
                                         (double *[]){ends->other, ends->other + cells, ends->other + 2 * cells}));
  for (PetscInt k = 0; k < 3 * cells; k++) {
    PetscReal *const m = most + (k < cells ? 0 : 2);

    m[0] = PetscMax(m[0], fabs(a[k] - b[k]));
    m[1] = PetscMax(m[1], PetscMax(fabs(a[k]), fabs(b[k])));
  }
  PetscCall(SamMax(e->grid->comm, 4, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In a life, checks that the steps are of one computed cycle; other cycles have other surfaces. */
static PetscErrorCode CheckLife(SamEvaluation e, PetscBool *life)
{
  double cycle[2];
  char   text[192];

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(NumberOf(e, k ? e->source.steps - 1 : 0, SAM_STEP_CYCLE, &cycle[k]));
  *life = cycle[0] > 0 || cycle[1] > 0;
  if (cycle[0] == cycle[1]) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(text, sizeof(text),
                 "of several cycles of a wear simulation, from %g to %g, treated as one: select the steps of one cycle",
                 cycle[0], cycle[1]);
  PetscCall((*e->source.warn)(e->source.context, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the cycle closes: the step before the first one, or zero load before step 1, must have the last
   tractions. */
static PetscErrorCode CheckEnds(SamEvaluation e, const Ends *ends)
{
  PetscReal most[4];
  double    step[2];
  int       f;
  char      text[256], names[2][64] = {"the last recorded step", "that before the first"};

  PetscFunctionBegin;
  PetscCall(NumberOf(e, e->source.steps - 1, SAM_STEP_NUMBER, &step[0]));
  PetscCall(NumberOf(e, e->source.before ? -1 : 0, SAM_STEP_NUMBER, &step[1]));
  if (!e->source.before && step[1] != 1) PetscFunctionReturn(PETSC_SUCCESS);
  if (step[0] > 0) {
    (void)snprintf(names[0], sizeof(names[0]), "step %.0f, the last one,", step[0]);
    if (e->source.before)
      (void)snprintf(names[1], sizeof(names[1]), "that of step %.0f, before the first,", step[1]);
    else
      (void)snprintf(names[1], sizeof(names[1]), "none before step 1");
  }
  PetscCall(CompareWithLast(e, -1, ends, most));
  f = most[2] * most[1] > most[0] * most[3]; /* the larger ratio of both */
  if (most[2 * f] <= CLOSED * most[2 * f + 1]) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(text, sizeof(text),
                 "not a closed cycle, or not a steady one: the %s of %s differs from %s by up to %.0f %% of the "
                 "maximum",
                 f ? "shear" : "pressure", names[0], names[1], 100 * (double)(most[2 * f] / most[2 * f + 1]));
  PetscCall((*e->source.warn)(e->source.context, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns that the cycle already ends with chosen step k. */
static PetscErrorCode WarnOfMore(SamEvaluation e, PetscInt k)
{
  double step[3];
  char   text[256], every[24] = "";

  PetscFunctionBegin;
  PetscCall(NumberOf(e, k, SAM_STEP_NUMBER, &step[0]));
  PetscCall(NumberOf(e, k + 1, SAM_STEP_NUMBER, &step[1]));
  PetscCall(NumberOf(e, e->source.steps - 1, SAM_STEP_NUMBER, &step[2]));
  if (step[1] - step[0] > 1) (void)snprintf(every, sizeof(every), ":%.0f", step[1] - step[0]);
  (void)snprintf(
    text, sizeof(text),
    "more than one cycle: step %.0f already has the last step's tractions; for one cycle use -steps %.0f:%.0f%s",
    step[0], step[1], step[2], every);
  PetscCall((*e->source.warn)(e->source.context, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds out if the steps contain more than one cycle, or a lead-in before it: then a step equals the last one, with
  different steps between the two and before them. So steps near the cycle's start and steps of held loads are ignored.
*/
static PetscErrorCode CheckOnce(SamEvaluation e, const Ends *ends, PetscBool *more)
{
  const PetscInt last      = e->source.steps - 1;
  PetscReal      least     = AGAIN;
  PetscInt       nearest   = -1;
  PetscBool      has_begun = PETSC_FALSE; /* a different step has been found */

  PetscFunctionBegin;
  for (PetscInt k = last - 1; k >= 0; k--) {
    PetscReal most[4], difference = 0;

    PetscCall(CompareWithLast(e, k, ends, most));
    for (int f = 0; f < 4; f += 2)
      if (most[f] > 0) difference = PetscMax(difference, most[f] / most[f + 1]);
    if (difference > AGAIN) {
      has_begun = PETSC_TRUE;
      if (nearest < 0) continue;
      PetscCall(WarnOfMore(e, nearest));
      *more = PETSC_TRUE;
      break;
    }
    if (!has_begun || difference > least) continue;
    least   = difference;
    nearest = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCycleCheckClosed(SamEvaluation e)
{
  const PetscInt cells = e->grid->cells;
  PetscBool      life = PETSC_FALSE, more = PETSC_FALSE;
  double         number;
  Ends           ends;

  PetscFunctionBegin;
  PetscCall(CheckLife(e, &life));
  if (life) PetscFunctionReturn(PETSC_SUCCESS); /* petsam has closed the loop */
  PetscCall(PetscMalloc2(3 * cells, &ends.last, 3 * cells, &ends.other));
  PetscCall(SamEvaluationReadTractions(e, e->source.steps - 1, PETSC_TRUE,
                                       (double *[]){ends.last, ends.last + cells, ends.last + 2 * cells}));
  PetscCall(NumberOf(e, 0, SAM_STEP_NUMBER, &number));
  if (number > 0) PetscCall(CheckOnce(e, &ends, &more)); /* steps chosen by number */
  if (!more) PetscCall(CheckEnds(e, &ends));
  PetscCall(PetscFree2(ends.last, ends.other));
  PetscFunctionReturn(PETSC_SUCCESS);
}
