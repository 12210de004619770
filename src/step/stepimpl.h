/* The inside of a step: what its solution and the coupling of its two problems share. */
#ifndef PETSAM_STEPIMPL_H
#define PETSAM_STEPIMPL_H

#include "../contact/contactimpl.h"
#include <petsam/private/normalimpl.h>
#include <petsam/private/tangentialimpl.h>

/* A step under way. */
typedef struct {
  SamContact         c;
  SamSolution       *s;      /* the tried solution */
  const SamSolution *before; /* whose slip it continues; NULL in the first step */
  SamStep           *step;
  PetscBool          coupled, same_pressure;
  SamKept            kept;               /* the same step one cycle before; NULL: none */
  PetscBool          known_pressure;     /* the pressure is that of the kept step */
  SamBalance         normal, tangential; /* as prescribed */
  double             rigid[3];           /* guess of the tangential rigid displacements */
  double            *counts;             /* of the solvers, in the state */
  Vec                separation;         /* of the bodies as they were after the step before */
  Vec                slip;               /* the length of the slip of this step, by the last shear; NULL: none yet */
  SamProduct         shear_product;      /* C q of the tried solution; coupled, or at mid step only */
  Vec                turn;               /* at mid step: t of direction.c, m, two components; NULL: zero */
  /* coupled only */
  Vec        h;                /* separation plus lift */
  Vec        lift;             /* normal displacement by the shear that the pressure is solved with */
  Vec        pushed;           /* tangential displacement by pressure and load cases, set by SamSolveShear() */
  SamProduct pressure_product; /* S p of the tried solution */
  Vec        previous_pressure, previous_shear; /* of the previous pass */
} SamSolve;

/*
  SamSolveNormal - the normal problem of the step. `has_pressure`: the tried solution holds a guess; `has_shear`: of the
  shear too, which then follows the pressure. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveNormal(SamSolve *solve, PetscBool has_pressure, PetscBool has_shear);
/*
  SamSolveBound - a bound of the shear, from the pressure and the last slip.
  SamSolveShear - the tangential problem under the bound of the tried solution. A bound that follows the slip changes
  with it; `rtol` is what both are solved to then (bound.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveBound(SamSolve *solve, Vec bound);
PETSC_INTERN PetscErrorCode SamSolveShear(SamSolve *solve, PetscBool has_shear, PetscReal rtol, SamEffort effort);
/* SamSolveTangential - the tangential problem; `has_shear` as above. Collective. */
PETSC_INTERN PetscErrorCode SamSolveTangential(SamSolve *solve, PetscBool has_shear);
/*
  SamSolveDirection - the same with the direction of slip that the step has, to the tolerance `rtol` (direction.c).
  SamSolveDisplace - gives the tried solution its tangential displacement by shear and pressure. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveDirection(SamSolve *solve, PetscBool has_shear, PetscReal rtol, SamEffort effort);
PETSC_INTERN PetscErrorCode SamSolveDisplace(SamSolve *solve);
/* SamSolveGuessDirection - takes t from a kept step and its product, and lessens the offset by it. Collective. */
PETSC_INTERN PetscErrorCode SamSolveGuessDirection(SamSolve *solve, SamKept kept, Vec shear, const SamProduct *product,
                                                   Vec offset);
/* SamSolveJudge - records in the step whether the last solve of a problem failed. Collective. */
PETSC_INTERN PetscErrorCode SamSolveJudge(SamSolve *solve, SamBalanceKind kind);
/* SamSolveRolling - the numbers of steady rolling, of the solved step (rolling.c). Collective. */
PETSC_INTERN PetscErrorCode SamSolveRolling(SamSolve *solve);
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
  PetscInt components, depth, count, newest;
  Vec      result[SAM_MIXING_DEPTH], change[SAM_MIXING_DEPTH]; /* change: result - argument, where it counts */
  double   products[SAM_MIXING_DEPTH][SAM_MIXING_DEPTH];       /* of the changes */
} SamMixing;
PETSC_INTERN PetscErrorCode SamMixingCreate(SamGrid grid, PetscInt components, SamMixing *mixing);
PETSC_INTERN PetscErrorCode SamMixingDestroy(SamMixing *mixing);
/*
  SamMixingNext - takes an argument and its result, fields of one component, and replaces the argument by the next one.
  Their difference counts where `weight` is positive. Collective.
*/
PETSC_INTERN PetscErrorCode SamMixingNext(SamMixing *mixing, Vec weight, Vec result, Vec argument);

#endif
