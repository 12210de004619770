/* The types of elasticity of the library, and what may be added to bodies. */
#include "viscous/viscous.h"

PetscErrorCode SamElasticityRegisterAll(void)
{
  static const struct {
    SamElasticityType           name;
    SamElasticityCreateFunction create;
  } types[] = {{SAM_ELASTICITY_HALFSPACE, SamElasticityCreate_HalfSpace},
               {SAM_ELASTICITY_PERIODIC, SamElasticityCreate_Periodic},
               {SAM_ELASTICITY_PLANE, SamElasticityCreate_Plane},
               {SAM_ELASTICITY_PLANE_PERIODIC, SamElasticityCreate_PlanePeriodic}};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(types) / sizeof(types[0]); k++)
    if (!SamElasticityIsRegistered(types[k].name)) /* else one of the user's, which replaces it */
      PetscCall(SamElasticityRegister(types[k].name, types[k].create));
  PetscCall(SamElasticityRegisterAddition(&SamElasticityCompliances));
  PetscCall(SamElasticityRegisterAddition(&SamElasticityViscous));
  PetscFunctionReturn(PETSC_SUCCESS);
}
