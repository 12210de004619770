/* Numbers of a load history that have a gradient, for authors of new ones. */
#ifndef PETSAM_OBJECTIVE_H
#define PETSAM_OBJECTIVE_H

#include <petsam/private/backstep.h>
#include <petsam/problem.h>

/*
  SamObjective - a number with a gradient. `add` adds a step's part of the number and of its derivatives; it is called
  for all steps from the last to the first. `check` checks a name with what follows an @, if `suffix` allows that, for
  this problem; NULL: all are right. `end`: frees the data; NULL: there are none. `bytes`: the
  memory that it takes per cell of the whole grid: during the pass; in one step only; and besides that for each step of
  the history. Collective.
*/
typedef struct {
  const char *name, *unit, *unit_of_row; /* on one row of cells; NULL: as SamUnitOn() has it */
  const char *number;                    /* its name among the numbers of a step; NULL: the same */
  PetscBool   all;                       /* true: of all steps unless others are given; false: of the last one */
  PetscErrorCode (*add)(SamBackStep *at);
  PetscErrorCode (*check)(SamProblem problem, const char name[]);
  PetscBool suffix;
  PetscErrorCode (*end)(void *data);
  PetscInt bytes[3];
} SamObjective;

/*
  SamObjectiveRegister - adds an objective, or replaces an earlier one of its name.

  Not collective, but to be called on all ranks.

  In:     objective - the objective; its members are copied, its texts must stay

  Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_OBJECTIVES.

  See also: SamGradientCompute().
*/
#define SAM_OBJECTIVES 32
PETSC_EXTERN PetscErrorCode SamObjectiveRegister(const SamObjective *objective);

#endif
