/* What a contact carries from step to step: taking it out, putting it back, and going back by a step. */
#include "contactimpl.h"

PetscErrorCode SamContactStepBack(SamContact c, const SamBalance *given, const SamBalance *found,
                                  PetscBool same_pressure)
{
  SamStep step;

  PetscFunctionBegin;
  if (!c->steps) PetscFunctionReturn(PETSC_SUCCESS);
  c->normal_given = *given;
  c->normal_found = *found;
  for (PetscInt k = 0; k < 6; k++) c->values[0][k] = c->values[1][k];
  PetscCall(VecCopy(c->previous[0], c->fields.pressure));
  PetscCall(VecCopy(c->previous[1], c->fields.shear));
  PetscCall(PetscMemzero(&step, sizeof(step)));
  step.normal          = *found;
  step.tangential.kind = SAM_BALANCE_TANGENTIAL; /* its displacements are only in the slip, which is known */
  PetscCall(SamContactCheckStep(c, same_pressure, NULL, &step.normal, &step.tangential, &step));
  PetscCall(VecDestroy(&c->fields.slip));
  c->fields.slip = c->slip_before;
  c->slip_before = NULL;
  PetscCall(VecDestroy(&c->previous[0]));
  PetscCall(VecDestroy(&c->previous[1]));
  c->steps = 1; /* nothing to extrapolate from */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetState(SamContact c, SamContactState *s)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  s->steps             = c->steps;
  s->given             = c->normal_given;
  s->found             = c->normal_found;
  s->pressure          = c->fields.pressure;
  s->shear             = c->fields.shear;
  s->slip              = c->fields.slip;
  s->displacement_z    = c->fields.displacement_z;
  s->previous_pressure = c->previous[0];
  s->previous_shear    = c->previous[1];
  PetscCall(PetscMemcpy(s->values, c->values, sizeof(s->values)));
  PetscCall(PetscMemcpy(s->rigid, c->rigid, sizeof(s->rigid)));
  PetscCall(SamElasticityGetPartPlace(c->elasticity, s->window_first, s->window_n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A copy in a vector of the contact's own, which is made where it is needed. */
static PetscErrorCode Take(Vec from, Vec *to)
{
  PetscFunctionBegin;
  if (!from)
    PetscCall(VecDestroy(to));
  else {
    if (!*to) PetscCall(VecDuplicate(from, to));
    PetscCall(VecCopy(from, *to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetState(SamContact c, const SamContactState *s)
{
  PetscFunctionBegin;
  PetscCheck(s->steps > 0 && s->pressure && s->shear && s->slip && s->displacement_z &&
               (s->steps == 1 || (s->previous_pressure && s->previous_shear)),
             c->grid->comm, PETSC_ERR_ARG_INCOMP, "The state is not that of a contact after a step");
  c->steps        = s->steps;
  c->normal_given = s->given;
  c->normal_found = s->found;
  PetscCall(PetscMemcpy(c->values, s->values, sizeof(c->values)));
  PetscCall(PetscMemcpy(c->rigid, s->rigid, sizeof(c->rigid)));
  PetscCall(SamContactDestroyDerived(c, PETSC_FALSE));
  PetscCall(VecDestroy(&c->slip_before));
  PetscCall(Take(s->pressure, &c->fields.pressure));
  PetscCall(Take(s->shear, &c->fields.shear));
  PetscCall(Take(s->slip, &c->fields.slip));
  PetscCall(Take(s->displacement_z, &c->fields.displacement_z));
  PetscCall(Take(s->previous_pressure, &c->previous[0]));
  PetscCall(Take(s->previous_shear, &c->previous[1]));
  PetscCall(SamElasticitySetPart(c->elasticity, s->window_first, s->window_n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetGrid(SamContact c, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = c->grid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetCoupling(SamContact c, PetscBool *full)
{
  PetscFunctionBegin;
  *full = c->coupling ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
