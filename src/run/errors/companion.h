/* Runs of the same history, or of the same life, on other cells and with other steps, beside a simulation. */
#ifndef PETSAM_COMPANION_H
#define PETSAM_COMPANION_H

#include "runerrors.h"

/* SamCompanion - a run without results and checkpoints, which follows a simulation. The owner reads all members. */
typedef struct {
  SamSimulation run;                     /* NULL: there is no such companion */
  SamState      state;                   /* of its contact; borrowed */
  double        sums[SAM_STATE_NUMBERS]; /* numbers of its steps, joined; given one by one: of the tried step's parts */
  PetscInt      steps;                   /* number of steps that it has solved */
  SamLife       life;                    /* its life, once that has been run; NULL: none */
  char          fault[SAM_MESSAGE];      /* why it ended early; empty: it did not */
  PetscBool     lost;                    /* its committed state is not that of the simulation: it stays ended */
  SamState      kept;                    /* the committed state before the parts of the tried step; NULL: none yet */
  PetscBool     moved, current;          /* true: parts have been committed; the gap was the present one before */
} SamCompanion;

/*
  SamCompanionCreate - creates a companion whose cells are halved in each direction so many times; all else is as in the
  simulation, whose setup it references.
  SamCompanionPrepare - takes over the simulation's history or life, with this number of steps per row.
  SamCompanionFollow - solves its steps up to the end of step k of the simulation's history; `there`: its state is that
  of this moment. A step without a solution ends it.
  SamCompanionLive - runs its life for so many cycles.
  SamCompanionDestroy - frees it.

  For steps that are given one by one:
  SamCompanionTry - tries a step from the committed state, in so many parts; a step without a solution ends it until the
  next try.
  SamCompanionCommit, SamCompanionReject - commit or discard that; a companion that has ended stays so by a commit.
  SamCompanionLose - ends it for good, as its committed state is no longer that of the simulation, for this reason.
  All are collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamCompanionCreate(SamSimulation simulation, PetscInt halvings, SamCompanion *companion);
PETSC_INTERN PetscErrorCode SamCompanionPrepare(SamCompanion *companion, SamSimulation simulation, PetscInt increments);
PETSC_INTERN PetscErrorCode SamCompanionFollow(SamCompanion *companion, SamSimulation simulation, PetscInt k,
                                               PetscBool *there);
PETSC_INTERN PetscErrorCode SamCompanionLive(SamCompanion *companion, PetscReal cycles);
PETSC_INTERN PetscErrorCode SamCompanionTry(SamCompanion *companion, PetscInt parts, const SamControl *control);
PETSC_INTERN PetscErrorCode SamCompanionCommit(SamCompanion *companion);
PETSC_INTERN PetscErrorCode SamCompanionReject(SamCompanion *companion);
PETSC_INTERN PetscErrorCode SamCompanionLose(SamCompanion *companion, const char why[]);
PETSC_INTERN PetscErrorCode SamCompanionDestroy(SamCompanion *companion);

#endif
