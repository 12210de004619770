/* The registry of the trials. */
#include "trials.h"

PetscErrorCode SamPluginRegister(void);

PetscErrorCode SamPluginRegister(void)
{
  PetscCall(SamLawRegister("misfit", CreateMisfit));
  PetscCall(SamLawRegister("constant_tension", CreateTension));
  PetscCall(SamLawRegister("wetness", CreateWetness));
  PetscCall(SamLawRegister("square", CreateSquare));
  PetscCall(SamLawRegister("cushion", CreateCushion));
  PetscCall(SamLawRegister("threshold", CreateThreshold));
  PetscCall(SamLawRegister("steep", CreateSteep));
  PetscCall(SamStressPartRegister(&ThresholdStress));
  PetscCall(SamElasticityRegister("creeping", CreateCreeping));
  PetscCall(SamElasticityRegister("viscous", CreateViscous));
  PetscCall(SamElasticityRegister("conducting", CreateConducting));
  PetscCall(SamGapRegister("wave", CreateWave));
  return SamMotionRegister(&Guided);
}
