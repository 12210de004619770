/* The files and steps requested from petsam-stress, before any file is opened */
#ifndef PETSAM_APP_REQUEST_H
#define PETSAM_APP_REQUEST_H

#include <petsam/private/results.h>

typedef struct {
  char      input[PETSC_MAX_PATH_LEN], output[PETSC_MAX_PATH_LEN];
  char      steps[128];
  PetscBool all_steps, last_step;
  PetscInt  first, last, stride; /* load steps from 1, if neither is set */
  PetscBool of_cycle;            /* instead: the steps of one cycle of a life */
  PetscReal cycle;
} SamStressRequest;

/* SamStressRequestRead - reads these options. Collective. Errors: SAM_ERR_USER. */
PETSC_INTERN PetscErrorCode SamStressRequestRead(const SamOptions *from, SamStressRequest *request);
/*
  SamStressRequestSteps - returns the requested saved steps, as numbers of saved steps from 0 on; the caller frees them
  with PetscFree(). Collective. Errors: SAM_ERR_USER for steps that are not there or have not been saved.
*/
PETSC_INTERN PetscErrorCode SamStressRequestSteps(const SamStressRequest *request, SamResults results, PetscInt *count,
                                                  PetscInt **saved);

#endif
