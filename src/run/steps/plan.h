/* Wear options of a run: the laws, and the cycles of a life. */
#ifndef PETSAM_PLAN_H
#define PETSAM_PLAN_H

#include <petsam/private/life.h>
#include <petsam/private/setup.h>
#include <petsam/private/history.h>

#define SAM_PLAN_OUTPUTS 256 /* maximum number of cycles whose fields are saved */

typedef struct {
  PetscReal       cycles; /* number of cycles of a life; 0: the history runs once, and every step wears */
  PetscBool       bands; /* in steady rolling each row of the history is a passage, and all rows together are a cycle */
  SamLifeSettings life;
  PetscBool       has_rtol;  /* the tolerance of the life is given */
  PetscBool       stop_worn; /* the life ends where the first material of a body is worn through */
  PetscInt        outputs;
  PetscReal       output[SAM_PLAN_OUTPUTS]; /* cycles whose fields are written, increasing; the last ones always are */
  PetscInt        points;                   /* of the table of friction; 0: none */
  PetscReal      *at, *friction;            /* its cycles, increasing, and the coefficients there */
} SamLifeOptions;

/*
  SamLifeOptionsSetFromOptions - reads the -wear_ options of a life, and the table of friction; `given`: true if
  SamLifeOptionsSetCycles() has set the cycles; otherwise this function calls it. Collective. Errors: SAM_ERR_USER
  naming the option, or file and line; SAM_ERR_FILE for a table that cannot be read.
  SamLifeOptionsSetCycles - sets the number of cycles; 0: no life, each step wears. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamLifeOptionsSetFromOptions(SamLifeOptions *plan, PetscBool given, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamLifeOptionsSetCycles(SamLifeOptions *plan, PetscReal cycles, SamProblem problem,
                                                    const SamOptions *from);
PETSC_INTERN PetscErrorCode SamLifeOptionsDestroy(SamLifeOptions *plan);
/*
  SamLifeOptionsGetStart - returns the step of the history with which the cycle begins. Not collective.
  SamLifeOptionsCheckCycle - rejects a history that is not a closed cycle: its last row must equal its first one, except
  for whole periods by which periodic bodies slide. In steady rolling it rejects steps between rows.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscInt       SamLifeOptionsGetStart(const SamLifeOptions *plan, SamHistory history);
PETSC_INTERN PetscErrorCode SamLifeOptionsCheckCycle(const SamLifeOptions *plan, SamHistory history, SamProblem problem,
                                                     const SamOptions *from);
/* SamLifeOptionsNextStop - returns the next number of cycles, after so many, up to which cycles may be jumped over. Not
   collective. */
PETSC_INTERN PetscReal SamLifeOptionsNextStop(const SamLifeOptions *plan, PetscReal cycles);
/* SamLifeOptionsCountOutputs - returns the number of cycles whose fields are requested. Not collective. */
PETSC_INTERN PetscInt SamLifeOptionsCountOutputs(const SamLifeOptions *plan);
/* SamLifeOptionsIsOutput - returns true if the fields after this number of cycles are requested. Not collective. */
PETSC_INTERN PetscBool SamLifeOptionsIsOutput(const SamLifeOptions *plan, PetscReal cycles);
/* SamLifeOptionsFriction - returns the ratio of the friction after `cycles` to that at the start. Not collective. */
PETSC_INTERN PetscReal SamLifeOptionsFriction(const SamLifeOptions *plan, PetscReal cycles);

#endif
