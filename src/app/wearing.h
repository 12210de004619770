/* What a run is asked to wear: laws, and the cycles of a life. */
#ifndef PETSAM_APP_WEARING_H
#define PETSAM_APP_WEARING_H

#include <petsam/life.h>
#include <petsam/setup.h>
#include "history.h"

#define SAM_WEARING_OUTPUTS 256 /* most cycles whose fields are asked for */

typedef struct {
  SamWearLaws     laws;
  PetscReal       cycles; /* of a life; 0: the history runs once, and every step wears */
  SamLifeSettings life;
  PetscInt        outputs;
  PetscReal       output[SAM_WEARING_OUTPUTS]; /* cycles whose fields are written, increasing */
  PetscInt        points;                      /* of the table of friction; 0: none */
  PetscReal      *at, *friction;               /* its cycles, increasing, and the coefficients there */
} SamWearing;

/*
  SamWearingSetFromOptions - reads the -wear_ options, and the table of friction. Collective. Errors: SAM_ERR_USER
  naming the option, or file and line; SAM_ERR_FILE for a table that cannot be read.
*/
PETSC_INTERN PetscErrorCode SamWearingSetFromOptions(SamWearing *wearing, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamWearingDestroy(SamWearing *wearing);
/*
  SamWearingCheckCycle - refuses a history that is no closed cycle: its last row must be its first one again.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamWearingCheckCycle(const SamWearing *wearing, SamHistory history, const SamOptions *from);
/* SamWearingNextStop - after so many cycles, up to where they may be jumped over. Not collective. */
PETSC_INTERN PetscReal SamWearingNextStop(const SamWearing *wearing, PetscReal cycles);
/* SamWearingCountOutputs - the number of cycles whose fields are asked for. Not collective. */
PETSC_INTERN PetscInt SamWearingCountOutputs(const SamWearing *wearing);
/* SamWearingIsOutput - whether the fields of the cycle after so many are asked for. Not collective. */
PETSC_INTERN PetscBool SamWearingIsOutput(const SamWearing *wearing, PetscReal cycles);
/* SamWearingFriction - the friction after so many cycles over that at the start. Not collective. */
PETSC_INTERN PetscReal SamWearingFriction(const SamWearing *wearing, PetscReal cycles);

#endif
