/* What petsam-stress is asked for: its options, before any file is opened. */
#ifndef PETSAM_APP_STRESS_REQUEST_H
#define PETSAM_APP_STRESS_REQUEST_H

#include <petsam/fatigue.h>
#include <petsam/results.h>
#include <petsam/stressfile.h>

typedef struct {
  char           input[PETSC_MAX_PATH_LEN], output[PETSC_MAX_PATH_LEN];
  PetscInt       body;
  PetscInt       depths;
  PetscReal     *depth; /* m, in the order given */
  PetscBool      section;
  SamSectionAxis axis;
  PetscReal      place; /* of the section: y along x, x along y, m */
  PetscBool      all_steps, last_step;
  PetscInt       first, last, stride; /* load steps from 1, where neither is set */
  PetscBool      wants[SAM_QUANTITIES];

  SamFatigueConstants constants; /* but for the body's */
} SamStressRequest;

/* SamStressRequestRead - reads all options. Collective. Errors: SAM_ERR_USER. */
PETSC_INTERN PetscErrorCode SamStressRequestRead(const SamOptions *from, SamStressRequest *request);
/* SamStressRequestConstants - the constants of fatigue, with those of the body. Not collective. */
PETSC_INTERN SamFatigueConstants SamStressRequestConstants(const SamStressRequest *request, PetscReal young,
                                                           PetscReal poisson);
PETSC_INTERN PetscErrorCode      SamStressRequestFree(SamStressRequest *request);
/*
  SamStressRequestSteps - the saved steps that are asked for, as numbers of saved steps from 0 on; the caller frees
  them with PetscFree(). Collective. Errors: SAM_ERR_USER for steps that are not there or have not been saved.
*/
PETSC_INTERN PetscErrorCode SamStressRequestSteps(const SamStressRequest *request, SamResults results, PetscInt *count,
                                                  PetscInt **saved);

#endif
