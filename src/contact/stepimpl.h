/* The inside of a step: what its solution and the coupling of its two problems share. */
#ifndef PETSAM_STEPIMPL_H
#define PETSAM_STEPIMPL_H

#include "contactimpl.h"
#include <petsam/private/normalimpl.h>
#include <petsam/private/tangentialimpl.h>

/* A step under way. */
typedef struct {
  SamContact         c;
  SamSolution       *s;      /* the tried solution */
  const SamSolution *before; /* whose slip it goes on from; NULL in the first step */
  SamStep           *step;
  PetscBool          coupled, same_pressure;
  SamBalance         normal, tangential; /* as prescribed */
  double             rigid[3];           /* guess of the tangential rigid displacements */
  Vec                h;                  /* separation plus lift and plastic depth; NULL where it is the gap */
  /* coupled only */
  Vec        lift;                              /* normal displacement by the shear that the pressure is solved with */
  SamProduct pressure_product, shear_product;   /* S p and C q of the tried solution */
  Vec        previous_pressure, previous_shear; /* of the previous pass */
} SamSolve;

/*
  SamSolveNormal - the normal problem of the step. `has_pressure`: the tried solution holds a guess; `has_shear`: of the
  shear too, which then follows the pressure. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveNormal(SamSolve *solve, PetscBool has_pressure, PetscBool has_shear);
/* SamSolveCountNormal - adds the counts of the normal solver's last solve to those of the step. Not collective. */
PETSC_INTERN PetscErrorCode SamSolveCountNormal(SamSolve *solve);
/* SamSolveDeferred - corrects the solution of the normal problem for the edge of contact (deferred.c). Collective. */
PETSC_INTERN PetscErrorCode SamSolveDeferred(SamSolve *solve);
/*
  SamSolveCorrected - both problems of similar bodies with friction, corrected for their edges (deferredshear.c).
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveCorrected(SamSolve *solve, const SamStepStart *start);

/* The least share of an edge that must be smooth and resolved for its correction, and what is said where less is. */
#define SAM_SMOOTH_EDGE 0.95
PETSC_INTERN PetscErrorCode SamEdgeTooRough(PetscReal share, char why[], size_t size);
/*
  SamSolveLeaveEdge - the step says that the edge `of` "contact" or "stick" is not corrected, and why; `plain`: and that
  nothing is for it.
*/
PETSC_INTERN PetscErrorCode SamSolveLeaveEdge(SamSolve *solve, const char of[], PetscBool plain, const char why[]);

/*
  What has changed since the step before, `before` being its plain solution (changes.c). Collective.
  SamSolveIsHeld - nothing has, so that its corrected solution is that of this step.
  SamSolveFindTurn - the load has turned back: most cells that slipped do not go on in the same direction.
  SamSolveFindGrowth - the edge of contact has moved out over a shear that sticks: the shear keeps that edge, within the
    stick zone, where no profile knows of it.
*/
PETSC_INTERN PetscErrorCode SamSolveIsHeld(SamSolve *solve, PetscBool *held);
PETSC_INTERN PetscErrorCode SamSolveFindTurn(SamSolve *solve, const SamSolution *before, PetscBool *turned);
PETSC_INTERN PetscErrorCode SamSolveFindGrowth(SamSolve *solve, const SamSolution *before, PetscBool *grows);

/* SamSolveStoreNormal - copies the loads and displacements of the normal problem of a solution. Not collective. */
PETSC_INTERN void SamSolveStoreNormal(SamSolve *solve, const SamSolution *from);
/* SamSolveShearOnce - the bound, and the tangential problem with it, unless the normal one has failed. Collective. */
PETSC_INTERN PetscErrorCode SamSolveShearOnce(SamSolve *solve, PetscBool has_shear);
/* SamSolveTangential - the tangential problem; `has_shear` as above. Collective. */
PETSC_INTERN PetscErrorCode SamSolveTangential(SamSolve *solve, PetscBool has_shear);
/* SamSolveJudge... - puts down in the step whether that failed. Collective. */
PETSC_INTERN PetscErrorCode SamSolveJudgeNormal(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveJudgeTangential(SamSolve *solve);
/* SamSolveSkipTangential - no shear, as the pressure is not right. Collective. */
PETSC_INTERN PetscErrorCode SamSolveSkipTangential(SamSolve *solve);

/* SamSolveCoupled - both problems of dissimilar bodies with friction (coupling.c). Collective. */
PETSC_INTERN PetscErrorCode SamSolveCoupled(SamSolve *solve, const SamStepStart *start);

/*
  SamMixing - Anderson's acceleration of a fixed-point iteration on fields: from the last arguments and results it makes
  the next argument (mixing.c).
*/
#define SAM_MIXING_DEPTH 6
typedef struct {
  SamGrid  grid;
  PetscInt count, newest;
  Vec      result[SAM_MIXING_DEPTH], change[SAM_MIXING_DEPTH]; /* change: result - argument, where it counts */
  double   products[SAM_MIXING_DEPTH][SAM_MIXING_DEPTH];       /* of the changes */
} SamMixing;
PETSC_INTERN PetscErrorCode SamMixingCreate(SamGrid grid, SamMixing *mixing);
PETSC_INTERN PetscErrorCode SamMixingDestroy(SamMixing *mixing);
/*
  SamMixingNext - takes an argument and its result, fields of one component, and replaces the argument by the next one.
  Their difference counts where `weight` is positive. Collective.
*/
PETSC_INTERN PetscErrorCode SamMixingNext(SamMixing *mixing, Vec weight, Vec result, Vec argument);

#endif
