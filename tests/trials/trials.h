/* Trials: one extension of each kind, a file each, which only the registry names. */
#include <petsam.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/stresspart.h>

PetscErrorCode                         CreateMisfit(SamLaw law);
PetscErrorCode                         CreateTension(SamLaw law);
PetscErrorCode                         CreateWetness(SamLaw law);
PetscErrorCode                         CreateSquare(SamLaw law);
PetscErrorCode                         CreateCushion(SamLaw law);
PetscErrorCode                         CreateCreeping(SamElasticity elasticity);
PetscErrorCode                         CreateViscous(SamElasticity elasticity);
PetscErrorCode                         CreateConducting(SamElasticity elasticity);
PetscErrorCode                         CreateWave(SamGap gap);
PetscErrorCode                         CreateThreshold(SamLaw law);
PetscErrorCode                         CreateSteep(SamLaw law);
PETSC_INTERN const struct _n_SamMotion Guided;
PETSC_INTERN const SamStressPartType   ThresholdStress;
