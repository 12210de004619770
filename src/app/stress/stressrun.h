/* A run of petsam-stress. */
#ifndef PETSAM_APP_STRESS_RUN_H
#define PETSAM_APP_STRESS_RUN_H

#include <petsam/results.h>
#include <petsam/stressfile.h>

/* The files and steps that are asked for, before any file is opened. */
typedef struct {
  char      input[PETSC_MAX_PATH_LEN], output[PETSC_MAX_PATH_LEN];
  PetscBool all_steps, last_step;
  PetscInt  first, last, stride; /* load steps from 1, where neither is set */
  PetscBool of_cycle;            /* instead: the steps of a cycle of a life */
  PetscReal cycle;
} SamStressRequest;

/* SamStressRequestRead - reads these options. Collective. Errors: SAM_ERR_USER. */
PETSC_INTERN PetscErrorCode SamStressRequestRead(const SamOptions *from, SamStressRequest *request);
/*
  SamStressRequestSteps - the saved steps that are asked for, as numbers of saved steps from 0 on; the caller frees
  them with PetscFree(). Collective. Errors: SAM_ERR_USER for steps that are not there or have not been saved.
*/
PETSC_INTERN PetscErrorCode SamStressRequestSteps(const SamStressRequest *request, SamResults results, PetscInt *count,
                                                  PetscInt **saved);

typedef struct {
  SamStressRequest request;
  SamResults       results;
  SamStressFile    file;
  SamGrid          grid;       /* of the results */
  SamElasticity    elasticity; /* the bodies, as the results have recorded them */
  SamEvaluation    evaluation;
  PetscInt         steps, *saved;
  PetscReal       *times;
  double (*bulk)[SAM_BULK_AND_CASES]; /* bulk stress of the body (Pa) and factors on load cases in each step */
  PetscBool      quiet, writing;
  PetscLogDouble start, told; /* when the computation began, and the last line was printed, s */

  char               source[PETSC_MAX_PATH_LEN + 16]; /* of the bodies, for messages */
  SamFourierSettings transforms;
} SamStressRun;

/*
  SamCycleCheckClosed - warns if the step before the first one has been saved and has not the tractions of the last: the
  steps are not a closed cycle then, or it has not become steady; of steps that hold more than one cycle, or what leads
  to it; and of those of several cycles of a life (closed.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamCycleCheckClosed(SamStressRun *run);
/* SamStressRunHalfWidth - sets and prints the half width of the contact if depths need it (width.c). Collective. */
PETSC_INTERN PetscErrorCode SamStressRunHalfWidth(SamStressRun *run);
/* SamLargestWrite, SamLargestPrint - the largest values of each step, and of the fatigue parameters. Collective. */
PETSC_INTERN PetscErrorCode SamLargestWrite(SamStressRun *run);
PETSC_INTERN PetscErrorCode SamLargestPrint(SamStressRun *run);

#endif
