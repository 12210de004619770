/* The inside of a step: the shared data of its two problems and of their iterations. */
#ifndef PETSAM_STEPIMPL_H
#define PETSAM_STEPIMPL_H

#include "step.h"
#include <petsam/private/normalimpl.h>
#include <petsam/private/tangentialimpl.h>

/* A step under way. */
typedef struct {
  const SamStepTask *task;
  SamSolution       *s; /* the tried solution */
  SamStep           *step;
  SamCachedStep      kept;                    /* the same step one cycle before; NULL: none, or it has been used */
  PetscBool          has_pressure, has_shear; /* the tried solution holds a guess */
  PetscBool          known_pressure;          /* the pressure is that of the kept step */
  SamBalance         normal, tangential;      /* as prescribed */
  double             rigid[3];                /* guess of the tangential rigid displacements */
  double            *counts;                  /* iteration counts of the solvers, in the state */
  Vec                separation;              /* of the bodies as they were after the step before */
  Vec                slip;          /* the length of the slip of this step, by the last shear; NULL: none yet */
  SamProduct         shear_product; /* C q of the tried solution; coupled, or solved twice only */
  /* coupled, or with an offset, only */
  Vec h;      /* separation plus lift plus offset */
  Vec pushed; /* tangential displacement by pressure and offset, set by SamSolveShear() */
  /* coupled only */
  Vec        lift;                              /* normal displacement by the shear that the pressure is solved with */
  SamProduct pressure_product;                  /* S p of the tried solution */
  Vec        previous_pressure, previous_shear; /* of the previous pass */
} SamSolve;

/* ---- the two problems (problems.c) ---- */

/*
  SamSolveNormal - the normal problem of the step. `has_pressure`: the tried solution holds a guess; `has_shear`: of the
  shear too, which then follows the pressure. Collective.
  SamSolveTangential - the tangential problem under the bound of the tried solution; `has_shear` likewise. Collective.
  SamSolveZeroShear - no shear, as the pressure is not right. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveNormal(SamSolve *solve, PetscBool has_pressure, PetscBool has_shear);
PETSC_INTERN PetscErrorCode SamSolveTangential(SamSolve *solve, PetscBool has_shear);
PETSC_INTERN PetscErrorCode SamSolveZeroShear(SamSolve *solve);
/* SamSolveDisplace - gives the tried solution its tangential displacement by shear and pressure. Collective. */
PETSC_INTERN PetscErrorCode SamSolveDisplace(SamSolve *solve);
/* SamSolveJudge - records in the step whether the last solve of a problem failed. Collective. */
PETSC_INTERN PetscErrorCode SamSolveJudge(SamSolve *solve, SamBalanceKind kind);

/* ---- fixed-point iterations (fixedpoint.c) ---- */

/*
  SamFixedPoint - the iteration x <- g(x) on a field with Anderson's acceleration. `pass` computes the result g(x) of
  pass 1, 2 ... and says how it ended; the driver makes the next argument of it. All ranks end a pass alike.
*/
typedef enum {
  SAM_PASS_GOES_ON,  /* the next argument is made of this and the last results */
  SAM_PASS_REPEATS,  /* the next argument is the same */
  SAM_PASS_RESTARTS, /* the next argument is the last result, and the ones before count no longer */
  SAM_PASS_SOLVED,   /* the argument is the solution */
  SAM_PASS_FAILED    /* there is no result */
} SamPassEnd;
typedef struct {
  PetscInt  components;  /* of the fields */
  PetscInt  most;        /* passes */
  PetscBool nonnegative; /* the argument is */
  PetscErrorCode (*pass)(void *context, PetscInt pass, Vec result, SamPassEnd *end);
} SamFixedPoint;
/*
  SamSolveFixedPoint - iterates from `argument` on; differences count where the tried pressure is positive. `end`: how
  the last pass ended; SAM_PASS_GOES_ON: there have been too many. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveFixedPoint(SamSolve *solve, const SamFixedPoint *iteration, void *context,
                                               Vec argument, SamPassEnd *end);
/*
  SamSolveGetChange - the difference of a pass's result from its argument, relative to what the check compares it with:
  the 2-norm over that of the shear, and `largest` (NULL: not wanted), the largest one. `unit`: what a shear of 1 Pa is
  in units of the fields. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveGetChange(SamSolve *solve, Vec argument, Vec result, PetscReal unit,
                                              PetscReal *change, PetscReal *largest);

/*
  SamSolveSetAside - sets `aside` of the tried solution, to whose pressure and bound it belongs: by its shear, if the
  step has been `solved`, to a tolerance SAM_ROUGH times that of the shear (direction.c). Collective.
  SamSolveIsTwice - true if the tried pressure makes that necessary. Not collective.
  SamSolveBound - a bound of the shear, from the pressure and the last slip. Collective.
  SamSolveShear - the tangential problem under the bound of the tried solution. A bound that follows the slip changes
  with it; `rtol` is what both are solved to then (bound.c). Collective.
  SamSolveCoupled - both problems of dissimilar bodies with friction (coupling.c). Collective.
  SamSolveRolling - the numbers of a motion in which material streams, of the solved one (steadystep.c). Collective.
*/
#define SAM_ROUGH 100
PETSC_INTERN PetscErrorCode SamSolveSetAside(SamSolve *solve, PetscBool solved);
PETSC_INTERN PetscBool      SamSolveIsTwice(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveBound(SamSolve *solve, Vec bound);
PETSC_INTERN PetscErrorCode SamSolveShear(SamSolve *solve, PetscBool has_shear, PetscReal rtol, SamEffort effort);
PETSC_INTERN PetscErrorCode SamSolveCoupled(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveRolling(SamSolve *solve);

#endif
