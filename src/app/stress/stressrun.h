/* A run of petsam-stress. */
#ifndef PETSAM_APP_STRESS_RUN_H
#define PETSAM_APP_STRESS_RUN_H

#include "../arguments.h"
#include "request.h"

/* A largest value so far, and the number of its point, counted along x, y and z. */
typedef struct {
  double value, point;
} SamLargest;

typedef struct {
  SamStressRequest request;
  SamResults       results;
  SamStressFile    file;
  SamGrid          grid; /* of the results */
  PetscReal        young, poisson;
  PetscInt         index; /* of the section's line of cells */
  PetscInt         steps, *saved;
  PetscReal       *times;
  SamLargest      *mises, *principal; /* of each step */
  PetscBool        quiet, writing;

  SamFourierSettings transforms;
} SamStressRun;

/* SamStressRunSetUp - reads all options and the results' parameters; writes nothing. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunSetUp(SamStressRun *run, const SamArguments *arguments);
/* SamStressRunCompute - computes and writes everything. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunCompute(SamStressRun *run);
/* SamStressRunTearDown - destroys all objects, also after an error. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunTearDown(SamStressRun *run);

#endif
