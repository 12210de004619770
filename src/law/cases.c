/* Load cases of bodies with a compliance of their own: their factors in a step displace the surfaces. */
#include <petsam/private/compliance.h>
#include <petsam/private/lawimpl.h>

static PetscErrorCode AddConditions(SamLaw law, SamConditions conditions)
{
  return SamElasticityAddConditions(law->elasticity, conditions);
}

static PetscErrorCode AddOffset(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t,
                                PetscBool *adds)
{
  PetscFunctionBegin;
  (void)state;
  if (u_z) PetscCall(SamElasticityAddCases(law->elasticity, law->conditions, control, PETSC_FALSE, u_z));
  if (u_t) PetscCall(SamElasticityAddCases(law->elasticity, law->conditions, control, PETSC_TRUE, u_t));
  for (PetscInt k = 0; k < SamConditionsCount(law->conditions) && adds; k++) {
    const SamCondition *one = SamConditionsGet(law->conditions, k);

    if (one->couples && SamControlGet(control, one) != 0) *adds = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_LoadCases(SamLaw law)
{
  PetscFunctionBegin;
  law->always         = SamElasticityHasCases(law->elasticity);
  law->any_motion     = PETSC_TRUE;
  law->ops.conditions = AddConditions;
  law->ops.offset     = AddOffset;
  PetscFunctionReturn(PETSC_SUCCESS);
}
