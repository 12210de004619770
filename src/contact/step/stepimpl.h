/* The inside of a step: the shared data of its two problems and of their iterations. */
#ifndef PETSAM_STEPIMPL_H
#define PETSAM_STEPIMPL_H

#include "../contactimpl.h"
#include <petsam/private/normalimpl.h>
#include <petsam/private/tangentialimpl.h>

/* A step under way. */
typedef struct {
  SamContact         contact;    /* whose step it is */
  SamGrid            grid;       /* on which it is solved: that of the contact, or a coarser one, like the next two */
  SamElasticity      elasticity; /* of the bodies */
  SamNormal          solver;     /* of the normal problem */
  const SamSolution *before;     /* the solution before the step; NULL: none, or its slip is not continued */
  SamSolution       *s;          /* the tried solution */
  SamStep           *step;
  SamCachedStep      kept;                    /* the same step one cycle before; NULL: none, or already used */
  PetscBool          has_pressure, has_shear; /* the tried solution holds a pressure; a shear to start from */
  PetscBool          holds;                   /* the field `aside` stays as it is */
  PetscBool          monitor;                 /* passes are printed */
  SamBalance         normal, tangential;      /* as prescribed; contact also bears the loads of the tension */
  double             rigid[3];                /* guess of the tangential rigid displacements */
  double            *counts;                  /* iteration counts of the solvers, in the state */
  Vec                separation;              /* of the bodies in their state after the step before */
  Vec                slip;          /* the length of the slip of this step, by the last shear; NULL: none yet */
  SamProduct         shear_product; /* C q of the tried solution; only if coupled or solved twice */
  Vec                pulled;        /* normal displacement by the tension, as a pressure; NULL: there is none */
  /* only if coupled, with an offset or with tension */
  Vec h;      /* separation plus lift plus offset, less what is pulled */
  Vec pushed; /* tangential displacement by pressure and offset, set by SamSolveShear() */
  /* only if coupled */
  Vec        lift;                              /* normal displacement by the shear that the pressure is solved with */
  Vec        touching;                          /* motion until cells touch, a part of `aside`; NULL: it is not found */
  double     stuck;                             /* part of the contact that sticks before the step (touching.c) */
  double     deviation;                         /* of the Gaussian of edgemean.h, 0 before the first mean */
  SamProduct pressure_product;                  /* S p of the tried solution */
  Vec        previous_pressure, previous_shear; /* of the previous pass */
} SamSolve;

/* ---- the two problems (problems.c) ---- */

/*
  SamSolveNormal - solves the normal problem of the step, from the pressure of the tried solution if it holds one.
  SamSolveBegun - solves it, and scales the shear that the tried solution holds with its pressure. Collective.
  SamSolveTangential - solves the tangential problem under the bound of the tried solution, from its shear if it holds
  one to start from. Collective.
  SamSolveZeroShear - sets the shear to zero, because the pressure is wrong. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveNormal(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveBegun(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveTangential(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveZeroShear(SamSolve *solve);
/*
  SamSolveGetSeparation - computes the separation (m) for the normal problem: the sum of the bodies' separation, of the
  offsets and, for coupled bodies, of the lift, which w->h must hold, less the displacement by the tension. Collective.
  SamSolveCount - adds the counts of a solver's last solve to three numbers of the step (pressure.c). Not collective.
  SamSolvePressure - solves the normal problem with this separation (m) and the tension so far (pressure.c). Collective.
  SamSolvePressureOnce - solves it once, with the operator of the solvers; SamSolveSkewed - in passes, with that of the
  bodies, which is not symmetric (skewed.c). Collective.
  SamSolveAttraction - solves it and finds the tension of its gap, until both belong together; changes h (attract.c). Of
  a solve that only measures an error, it adds that of the tension. Collective.
  SamSolveBearTension - sets the loads of contact by those given and the tension. Collective.
  SamSolveIsApart - true if contact would have to pull, so that there is no solution; SamSolveFailApart - says so in the
  step. Not collective.
  SamSolveTiltCure - returns what to give where a pull acts on bodies that may tilt; else an empty text. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolveGetSeparation(SamSolve *solve, Vec *h);
static inline const char   *SamSolveTiltCure(const SamSolve *solve)
{
  const PetscBool tilts = solve->normal.force[1] || solve->normal.force[2] ? PETSC_TRUE : PETSC_FALSE;

  return tilts ? "rot_x = rot_y = 0, as bodies that may tilt roll away under a pull, or " : "";
}
PETSC_INTERN PetscErrorCode SamSolveCount(SamSolver solver, double counts[3]);
PETSC_INTERN PetscErrorCode SamSolvePressureOnce(SamSolve *solve, Vec h);
PETSC_INTERN PetscErrorCode SamSolveSkewed(SamSolve *solve, Vec h);
PETSC_INTERN PetscErrorCode SamSolvePressure(SamSolve *solve, Vec h);
PETSC_INTERN PetscErrorCode SamSolveAttraction(SamSolve *solve, Vec h);
PETSC_INTERN PetscErrorCode SamSolveBearTension(SamSolve *solve);
PETSC_INTERN PetscBool      SamSolveIsApart(const SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveFailApart(SamSolve *solve);
/* SamSolveCreateOffset - creates w - S of the tangential problem: all displacements but those by the shear, minus the
   slip so far; NULL: zero. Collective. */
PETSC_INTERN PetscErrorCode SamSolveCreateOffset(SamSolve *solve, Vec *offset);
/* SamSolveDisplace - gives the tried solution its tangential displacement by shear and pressure. Collective. */
PETSC_INTERN PetscErrorCode SamSolveDisplace(SamSolve *solve);
/* SamSolveJudge - records in the step whether the last solve of a problem failed. Collective. */
PETSC_INTERN PetscErrorCode SamSolveJudge(SamSolve *solve, SamBalanceKind kind);

/*
  SamSolveTogether - makes a step of Newton's method for both problems of a pass of coupled bodies, whose sets of cells
  are frozen, to the relative tolerance `rtol` (together.c). w->h must be the separation with the lift by the tried
  shear. `made`: tractions and products have changed. Collective.
  SamSolveCanJoin - returns false in `can` where that is not possible: if the bound follows the slip, pressures are
  limited, or besides the lift a motion has to be found, bodies roll or material streams. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolveCanJoin(SamSolve *solve, PetscBool *can);
PETSC_INTERN PetscErrorCode SamSolveTogether(SamSolve *solve, PetscReal rtol, PetscBool *made);

/* ---- fixed-point iterations (fixedpoint.c) ---- */

/*
  SamFixedPoint - the iteration x <- g(x) on a field with Anderson's acceleration. `pass` computes the result g(x) of
  pass 1, 2 ... and returns its outcome, the same on all ranks; the driver computes the next argument from the result.
*/
typedef enum {
  SAM_PASS_GOES_ON,  /* the next argument is computed from this and earlier results */
  SAM_PASS_REPEATS,  /* the next argument is the same */
  SAM_PASS_RESTARTS, /* the next argument is the last result; earlier results are discarded */
  SAM_PASS_SOLVED,   /* the argument is the solution */
  SAM_PASS_FAILED    /* there is no result */
} SamPassEnd;
typedef struct {
  PetscInt  components;  /* of the fields */
  PetscInt  most;        /* maximum number of passes */
  PetscBool nonnegative; /* the argument is nonnegative */
  PetscErrorCode (*pass)(void *context, PetscInt pass, Vec result, SamPassEnd *end);
} SamFixedPoint;
/*
  SamSolveFixedPoint - iterates from `argument` on; differences count where the tried pressure is positive. `end`:
  outcome of the last pass; SAM_PASS_GOES_ON: the maximum number of passes was reached. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveFixedPoint(SamSolve *solve, const SamFixedPoint *iteration, void *context,
                                               Vec argument, SamPassEnd *end);
/*
  SamSolveGetChange - computes the difference of a pass's result from its argument, relative to the scale of the check:
  the 2-norm relative to that of the shear, and in `largest` (NULL: not wanted) the largest difference. `unit`: the
  value in units of the fields that corresponds to a shear of 1 Pa. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolveGetChange(SamSolve *solve, Vec argument, Vec result, PetscReal unit,
                                              PetscReal *change, PetscReal *largest);

/*
  SamSolveSetAside - sets the field `aside` for the pressure and bound of the tried solution (direction.c): predicted
  from the step before, as it was in the kept step, or by the shear of the tried solution, whose tolerance may be
  SAM_ROUGH times that of the shear. Collective.
  SamSolveSetsAside - true if it sets anything in such a step. SamSolveTurns - true if slip follows the shear at mid
  step. SamSolveFindsTouching - true if the motion until cells
  touch is to be found. Not collective.
  SamSolveBeginTouching - creates the field `touching` of a step in which it is to be found. Collective.
  SamSolveFindTouching - computes the motion (m, two components) of the surfaces of dissimilar bodies in the step until
  cells touch, by the tried solution; it is 0 in other cells, but for open ones beside the contact, which may touch in
  the next pass (touching.c). Collective. SamSolveEndTouching - takes it from `aside` in
  open cells. Not collective.
  SamSolveAddEntering - adds the part of it that the loads alone cause, given or `found` (direction.c); `open`: in cells
  that are open after the step, too, as if they touched. Collective.
  SamSolveFindGaps - computes the gap (m) before the step in cells that were open, 0 in others; in a step from no
  contact the distance of the undeformed bodies, 0 where it is least. Collective.
  SamSolveStartFromLast - lets the next solution of both problems start from the tractions of the last one.
  SamSolveIsTwice - true if the tangential problem has to be solved twice for the tried pressure. Not collective.
  SamSolveBound - computes a bound of the shear, from the pressure and the last slip. Collective.
  SamSolveShear - solves the tangential problem under the bound of the tried solution. If the bound depends on the slip,
  both are solved, to the tolerance `rtol` (bound.c). Collective.
  SamSolveCoupled - solves both problems of dissimilar bodies with friction (coupling.c). Collective.
  SamSolveRolling - computes the numbers of the solved motion, in which material streams (steadystep.c). Collective.
  SamSolveResistance - computes the resistance of bodies with the trait skewed (resistance.c). Collective.
  SamSolveCreateCoarseNormal - creates a solver of the normal problem of coarse bodies, with the settings of the step's
  own (steadystep.c). Collective.
*/
#define SAM_ROUGH 100
typedef enum { SAM_ASIDE_PREDICTED, SAM_ASIDE_KEPT, SAM_ASIDE_SOLVED } SamAsideFrom;
PETSC_INTERN PetscErrorCode SamSolveSetAside(SamSolve *solve, SamAsideFrom from);
PETSC_INTERN PetscBool      SamSolveSetsAside(SamSolve *solve);
static inline PetscBool     SamSolveTurns(SamSolve *solve)
{
  return SamRuleTurns(solve->s->rule);
}
PETSC_INTERN PetscErrorCode SamSolveBeginTouching(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveFindTouching(SamSolve *solve, Vec motion);
PETSC_INTERN PetscErrorCode SamSolveEndTouching(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveAddEntering(SamSolve *solve, PetscBool found, PetscBool open, Vec motion);
PETSC_INTERN PetscErrorCode SamSolveFindGaps(SamSolve *solve, Vec gap);
static inline PetscBool     SamSolveFindsTouching(SamSolve *solve)
{
  return solve->touching && !solve->holds ? PETSC_TRUE : PETSC_FALSE;
}
static inline void SamSolveStartFromLast(SamSolve *solve)
{
  solve->has_pressure = solve->has_shear = PETSC_TRUE;
  solve->shear_product.n[0]              = 0; /* at first the shear is scaled with the pressure */
}
PETSC_INTERN PetscBool      SamSolveIsTwice(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveBound(SamSolve *solve, Vec bound);
PETSC_INTERN PetscErrorCode SamSolveShear(SamSolve *solve, PetscReal rtol, SamEffort effort);
PETSC_INTERN PetscErrorCode SamSolveCoupled(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveRolling(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveResistance(SamSolve *solve);
PETSC_INTERN PetscErrorCode SamSolveCreateCoarseNormal(SamSolve *solve, SamElasticity bodies, SamNormal *normal);

#endif
