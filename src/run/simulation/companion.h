/* Runs of the same history, or of the same life, on other cells and with other steps, beside a simulation. */
#ifndef PETSAM_COMPANION_H
#define PETSAM_COMPANION_H

#include "simulationimpl.h"

/* SamCompanion - a run without results and checkpoints, which follows a simulation. The owner reads all members. */
typedef struct {
  SamSimulation run;                     /* NULL: there is no such companion */
  SamState      state;                   /* of its contact; borrowed */
  double        sums[SAM_STATE_NUMBERS]; /* numbers of its steps, joined */
  PetscInt      steps;                   /* number of steps that it has solved */
  SamLife       life;                    /* its life, once that has been run; NULL: none */
  char          fault[SAM_MESSAGE];      /* why it ended early; empty: it did not */
} SamCompanion;

/*
  SamCompanionCreate - creates a companion whose cells are halved in each direction so many times, with this number of
  steps per row; all else is as in the simulation, whose setup it references.
  SamCompanionFollow - solves its steps up to the end of step k of the simulation's history; `there`: its state is that
  of this moment. A step without a solution ends it.
  SamCompanionLive - runs its life for so many cycles.
  SamCompanionDestroy - frees it. All are collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamCompanionCreate(SamSimulation simulation, PetscInt halvings, PetscInt increments,
                                               SamCompanion *companion);
PETSC_INTERN PetscErrorCode SamCompanionFollow(SamCompanion *companion, SamSimulation simulation, PetscInt k,
                                               PetscBool *there);
PETSC_INTERN PetscErrorCode SamCompanionLive(SamCompanion *companion, PetscReal cycles);
PETSC_INTERN PetscErrorCode SamCompanionDestroy(SamCompanion *companion);

#endif
