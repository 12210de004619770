/* A run of petsam-stress. */
#ifndef PETSAM_APP_STRESS_RUN_H
#define PETSAM_APP_STRESS_RUN_H

#include <petsam/private/arguments.h>
#include "request.h"
#include <petsam/stressfile.h>

typedef struct {
  SamStressRequest request;
  SamResults       results;
  SamStressFile    file;
  SamGrid          grid;       /* of the results */
  SamElasticity    elasticity; /* the bodies, as the results have recorded them */
  SamEvaluation    evaluation;
  PetscInt         steps, *saved;
  PetscReal       *times;
  double (*bulk)[SAM_BULK_COMPONENTS]; /* bulk stress of the body in each step, Pa */
  PetscBool      quiet, writing;
  PetscLogDouble start, told; /* when the computation began, and the last line was printed, s */

  char               source[PETSC_MAX_PATH_LEN + 16]; /* of the bodies, for messages */
  SamFourierSettings transforms;
} SamStressRun;

/* SamStressRunSetUp - reads all options and the results' parameters; writes nothing. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunSetUp(SamStressRun *run, const SamArguments *arguments);
/* SamStressRunCompute - computes and writes everything. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunCompute(SamStressRun *run);
/* SamStressRunTearDown - destroys all objects, also after an error. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunTearDown(SamStressRun *run);

/*
  SamCycleCheckClosed - warns if the step before the first one has been saved and has not the tractions of the last: the
  steps are not a closed cycle then, or it has not become steady; of steps that hold more than one cycle, or what leads
  to it; and of those of several cycles of a life (closed.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamCycleCheckClosed(SamStressRun *run);

#endif
