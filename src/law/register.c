/* The laws that come with the library, in the order in which they act. */
#include <petsam/private/lawimpl.h>

PetscErrorCode SamLawRegisterAll(void)
{
  PetscFunctionBegin;
  PetscCall(SamLawRegister(SAM_LAW_COULOMB, SamLawCreate_Coulomb));
  PetscCall(SamLawRegister(SAM_LAW_PATH_FRICTION, SamLawCreate_Friction));
  PetscCall(SamLawRegister(SAM_LAW_PRESSURE_FRICTION, SamLawCreate_Friction));
  PetscCall(SamLawRegister(SAM_LAW_FALLING_FRICTION, SamLawCreate_Friction));
  PetscCall(SamLawRegister(SAM_LAW_ARCHARD, SamLawCreate_Archard));
  PetscCall(SamLawRegister(SAM_LAW_ENERGY, SamLawCreate_Energy));
  PetscCall(SamLawRegister(SAM_LAW_HARDNESS, SamLawCreate_Hardness));
  PetscCall(SamLawRegister(SAM_LAW_SLIP_PATH, SamLawCreate_SlipPath));
  PetscCall(SamLawRegister(SAM_LAW_FRICTION_ENERGY, SamLawCreate_FrictionEnergy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
