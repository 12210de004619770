/* Doubts of the energy that bodies dissipate: steps that are long beside the times in which they relax. */
#include "viscous.h"
#include <petsam/private/examination.h>
#include <petsam/private/state.h>
#include <math.h>

enum { ENERGY, ERROR }; /* sums over the steps, kept from step to step */

PetscErrorCode SamViscousExamine(SamElasticity e, SamExamination *x)
{
  PetscFunctionBegin;
  (void)e;
  x->kept[ENERGY] += *SamStateReadNumbers(x->state, SamStateFindNumber(x->state, SAM_VISCOUS_ENERGY));
  x->kept[ERROR] += fabs(*SamStateReadNumbers(x->state, SamStateFindNumber(x->state, SAM_VISCOUS_ERROR)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousDoubt(SamElasticity e, SamExamination *x)
{
  const double error = x->kept[ENERGY] > 0 ? x->kept[ERROR] / x->kept[ENERGY] : 0;

  PetscFunctionBegin;
  (void)e;
  SamDoubtsAdd(x->doubts, SAM_CAUSE_STEPS, error, sqrt(PetscMax(1, error / SAM_DOUBT_LARGE)), SAM_VISCOUS_ENERGY,
               "steps are long beside the times in which bodies relax");
  PetscFunctionReturn(PETSC_SUCCESS);
}
