/* The registry of the trials. */
#include "trials.h"

PetscErrorCode SamPluginRegister(void);

PetscErrorCode SamPluginRegister(void)
{
  PetscCall(SamLawRegister("misfit", CreateMisfit));
  PetscCall(SamLawRegister("adhesion", CreateAdhesion));
  PetscCall(SamLawRegister("wetness", CreateWetness));
  PetscCall(SamLawRegister("square", CreateSquare));
  PetscCall(SamElasticityRegister("creeping", CreateCreeping));
  PetscCall(SamGapRegister("wave", CreateWave));
  return SamMotionRegister(&Guided);
}
