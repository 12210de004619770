/* The laws that come with the library, and their parts of the stresses in a body, in the order in which they act. */
#include <petsam/private/lawimpl.h>
#include <petsam/private/law.h>
#include "adhesion/adhesion.h"

PetscErrorCode SamLawRegisterAll(void)
{
  PetscFunctionBegin;
  if (SamLawIsRegistered(SAM_LAW_COULOMB)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamLawRegister(SAM_LAW_COULOMB, SamLawCreate_Coulomb));
  PetscCall(SamLawRegister(SAM_LAW_BULK_STRESS, SamLawCreate_BulkStress));
  PetscCall(SamStressPartRegister(&SamStressPart_Bulk));
  PetscCall(SamLawRegister(SAM_LAW_BODIES, SamLawCreate_Bodies));
  PetscCall(SamLawRegister(SAM_LAW_SLIP_DEPENDENT, SamLawCreate_Friction));
  PetscCall(SamLawRegister(SAM_LAW_PRESSURE_FRICTION, SamLawCreate_Friction));
  PetscCall(SamLawRegister(SAM_LAW_FALLING_FRICTION, SamLawCreate_Friction));
  PetscCall(SamLawRegister(SAM_LAW_HEAT, SamLawCreate_Heat)); /* its bound changes that of all friction above */
  PetscCall(SamStressPartRegister(&SamStressPart_Layers));    /* of laws with layers, as plastic */
  PetscCall(SamStressPartRegister(&SamStressPart_Heat));
  PetscCall(SamLawRegister(SAM_LAW_SLIDE, SamLawCreate_Slide)); /* before the laws with fields of body 2 */
  PetscCall(SamLawRegister(SAM_LAW_ARCHARD, SamLawCreate_Archard));
  PetscCall(SamLawRegister(SAM_LAW_ENERGY, SamLawCreate_Energy));
  PetscCall(SamLawRegister(SAM_LAW_HARDNESS, SamLawCreate_Hardness));
  PetscCall(SamLawRegister(SAM_LAW_PLASTIC, SamLawCreate_Plastic));
  PetscCall(SamLawRegister(SAM_LAW_ADHESION, SamLawCreate_Adhesion));
  PetscCall(SamLawRegister(SAM_LAW_ACCUMULATED_SLIP, SamLawCreate_AccumulatedSlip));
  PetscCall(SamLawRegister(SAM_LAW_FRICTION_ENERGY, SamLawCreate_FrictionEnergy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
