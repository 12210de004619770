/* The types of this plugin; a type of its own in each file. */
#include <petsam.h>

PetscErrorCode CreateFading(SamLaw law);
PetscErrorCode CreateSwelling(SamLaw law);
PetscErrorCode CreateCoated(SamElasticity elasticity);
PetscErrorCode CreateCone(SamGap gap);
PetscErrorCode CreateSpectral(SamSolver solver);
PetscErrorCode RegisterShearNorm(void);
