/*
  The tension by which surfaces attract each other, together with the pressure: t = T(g), where the tension t (Pa) of a
  gap g that t itself makes smaller.

  A given t is a load on the bodies and a displacement of their surfaces, under which the normal problem has one
  solution, with the gap g(t). Passes t <- T(g(t)) begin with the tension of the step before. Under a given approach
  more tension nowhere makes the gap wider, and a narrower gap has no less tension; so passes from a state with too
  little tension rise to the least tension above it that is a solution, and those from one with too much fall to the
  largest below. That is where a slow motion arrives, also where it jumps: of several states the one that the history
  leads to. Each pass also lowers the energy, as that of the tension is concave in the gap. Where the tension of a
  cell also depends on cells beside it, as the part of a cell in which a constant tension ends, all this holds up to a
  cell: on rough surfaces, whose spots are of few cells, the state may depend on the length of the steps.

  Passes multiply the error by the slope of T times the displacement of the zone in which the tension falls by a unit
  tension. Where they converge already, Anderson's method accelerates them (ground/grid/mixing.c); elsewhere it would
  leave the way to that state.

  Under given loads the pull may be more than any tension holds: then contact would have to pull, and there is no
  solution.

  Sources: Maugis 1992, J. Colloid Interface Sci. 150, 243-269; Medina, Dini 2014, Int. J. Solids Struct. 51, 2620-2632.
*/
#include "stepimpl.h"
#include <petsam/private/balance.h>
#include <petsam/private/check.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/mixing.h>
#include <petsam/private/problem.h>
#include <petsam/private/solver.h>
#include <petsam/private/state.h>
#include <math.h>

#define PASSES 1000 /* of most problems, */
#define SPREAD 8    /* and for each cell along the grid, over which an edge of contact may move */
#define PART   0.5  /* of the tolerance: largest error of the last pass, */
#define FINE   0.2  /* and of the pressure of each pass, which otherwise does not follow */
#define ROUGH  1e-4 /* largest tolerance, also in passes of coupled bodies: the gap must tell the tension */
#define NEAR   1e-2 /* error below which passes are accelerated, */
#define CALM   3    /* once it has fallen so many times in a row */

typedef struct {
  SamSolve *w;
  SamMixing mixing;
  Vec       h, gap, found, change; /* the gap is free once it has told the tension */
  PetscInt  most;                  /* passes */
  PetscReal error;                 /* of the tension of the last pass */
  PetscInt  falls;                 /* how many times in a row the error has fallen */
} Passes;

/* Computes the tension of the gap and the error of the last one: how far the change moves the surfaces, relative to all
   their displacement, and its load relative to that of contact. */
static PetscErrorCode Find(Passes *p)
{
  SamSolve *const w = p->w;
  PetscReal       contact, pulled, moved, error;

  PetscFunctionBegin;
  PetscCall(SamElasticityApplyNormal(w->elasticity, w->s->pressure, p->change));
  PetscCall(SamSolutionComputeGap(w->contact->problem, w->s, p->change, p->h, p->gap));
  PetscCall(SamProblemAttract(w->contact->problem, p->gap, p->found));
  PetscCall(VecNorm(p->change, NORM_INFINITY, &contact));
  PetscCall(VecNorm(w->pulled, NORM_INFINITY, &pulled));
  PetscCall(VecWAXPY(p->gap, -1, w->s->tension, p->found));
  PetscCall(SamElasticityApplyNormal(w->elasticity, p->gap, p->change));
  PetscCall(VecNorm(p->change, NORM_INFINITY, &moved));
  PetscCall(SamSolutionTensionError(w->contact->problem, w->s, p->gap, &error));
  if (moved > 0) error = PetscMax(error, moved / PetscMax(PetscMax(contact, pulled), moved));
  p->falls = error < p->error ? p->falls + 1 : 0;
  p->error = error;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Accelerates the next tension, which then is no longer that of the gap. */
static PetscErrorCode Accelerate(Passes *p)
{
  SamSolve *const w = p->w;
  double         *t;

  PetscFunctionBegin;
  PetscCall(VecWAXPY(p->gap, 1, w->s->tension, p->found));
  PetscCall(SamMixingNext(p->mixing, p->gap, p->found, w->s->tension));
  PetscCall(VecGetArray(w->s->tension, &t));
  for (PetscInt k = 0; k < w->grid->cells; k++) t[k] = PetscMax(t[k], 0);
  PetscCall(VecRestoreArray(w->s->tension, &t));
  PetscCall(VecCopy(w->pulled, p->change));
  PetscCall(SamElasticityApplyNormal(w->elasticity, w->s->tension, w->pulled));
  PetscCall(VecAYPX(p->change, -1, w->pulled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the next tension, with its displacement and its loads. */
static PetscErrorCode Proceed(Passes *p)
{
  SamSolve *const w = p->w;

  PetscFunctionBegin;
  if (p->error < NEAR && p->falls >= CALM) {
    PetscCall(Accelerate(p));
  } else {
    PetscCall(VecCopy(p->found, w->s->tension));
    PetscCall(VecAXPY(w->pulled, 1, p->change));
    SamMixingRestart(p->mixing);
  }
  PetscCall(VecAXPY(p->h, -1, p->change));
  PetscCall(SamSolveBearTension(w));
  w->pressure_product.n[0] = 0; /* the next solve starts from another pressure, of these loads */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveBearTension(SamSolve *w)
{
  PetscReal loads[3] = {0, 0, 0};

  PetscFunctionBegin;
  if (w->s->tension) PetscCall(SamBalanceGetLoads(w->grid, SAM_BALANCE_NORMAL, w->s->tension, loads));
  for (PetscInt k = 0; k < 3; k++)
    if (w->normal.force[k]) w->normal.load[k] = w->s->control.value[SamComponentsOf[SAM_BALANCE_NORMAL][k]] + loads[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamSolveIsApart(const SamSolve *w)
{
  return w->s->tension && w->normal.force[0] && w->normal.load[0] < 0 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamSolveFailApart(SamSolve *w)
{
  const SamComponentName *name = &SamComponentNames[SAM_COMPONENT_N];
  const char *const       unit = SamUnitOn(w->grid, name->load_unit);
  const double            load = (double)w->s->control.value[SAM_COMPONENT_N];
  const PetscInt          id   = SamStateFindNumber(w->contact->state, "pull_max");
  const double            most = *SamStateNumbers(w->contact->state, id, SAM_COMMITTED);
  char                    message[sizeof(w->step->message)], borne[96] = "";
  PetscReal               tension = 0;

  PetscFunctionBegin;
  if (w->contact->tried.last && w->contact->tried.last->tension)
    PetscCall(VecNorm(w->contact->tried.last->tension, NORM_INFINITY, &tension));
  if (most > 0)
    (void)snprintf(borne, sizeof(borne), " (largest pull that they have borne so far: %.6g %s)", most, unit);
  if (tension > 0)
    (void)snprintf(message, sizeof(message),
                   "%s = %.8g %s pulls the surfaces apart: their tension does not hold it%s: give %s%s, which follows "
                   "them past their largest pull",
                   name->load, load, unit, borne, SamSolveTiltCure(w), name->rigid);
  else
    (void)snprintf(message, sizeof(message),
                   "%s = %.8g %s pulls surfaces that do not attract each other yet: let them touch first, by a row of "
                   "%s = 0 or by %s",
                   name->load, load, unit, name->load, name->rigid);
  PetscCall(SamStepFail(w->step, SAM_STATUS_NO_EQUILIBRIUM, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FailPasses(Passes *p)
{
  char message[sizeof(p->w->step->message)];

  PetscFunctionBegin;
  (void)snprintf(message, sizeof(message),
                 "the tension did not converge with the gap in %d passes, last change %.2g: use %sfiner cells, or "
                 "smaller load steps",
                 (int)p->most, (double)p->error, SamSolveTiltCure(p->w));
  PetscCall(SamStepFail(p->w->step, SAM_STATUS_NOT_CONVERGED, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves for the pressure, to a part of the tolerance as far as rounding allows. `solved`: true if it is solved. */
static PetscErrorCode Solve(Passes *p, PetscReal rtol, PetscBool *solved)
{
  const SamSolver normal = SamNormalAsSolver(p->w->solver);

  PetscFunctionBegin;
  SamSolverSetEffort(normal, FINE * rtol, SAM_EFFORT_FULL);
  PetscCall(SamSolvePressure(p->w, p->h));
  if (normal->reason == SAM_SOLVER_DIVERGED_STAGNATED && normal->error <= rtol)
    normal->reason = SAM_SOLVER_CONVERGED_RTOL;
  *solved = normal->reason > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Iterate(Passes *p)
{
  SamSolve *const w      = p->w;
  const SamSolver normal = SamNormalAsSolver(w->solver);
  PetscReal       rtol;
  PetscBool       solved = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(normal, &rtol, NULL));
  rtol = PetscMax(rtol, PetscMin(normal->enough, ROUGH));
  PetscCall(Solve(p, rtol, &solved));
  for (PetscInt pass = 1; solved && pass <= p->most; pass++) {
    PetscCall(Find(p));
    if (w->monitor)
      PetscCall(PetscPrintf(w->grid->comm, "%5" PetscInt_FMT " tension change %.6e\n", pass, (double)p->error));
    if (p->error <= PART * rtol) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(Proceed(p));
    if (SamSolveIsApart(w)) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(Solve(p, rtol, &solved));
  }
  if (solved) PetscCall(FailPasses(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the error of the tension to that of a solve that has only measured the pressure's error. */
static PetscErrorCode Measure(Passes *p)
{
  const SamSolver normal = SamNormalAsSolver(p->w->solver);

  PetscFunctionBegin;
  PetscCall(SamSolvePressure(p->w, p->h));
  PetscCall(Find(p));
  normal->error = PetscMax(normal->error, p->error);
  if (normal->reason > 0 && p->error > normal->enough) normal->reason = SAM_SOLVER_DIVERGED_ITS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveAttraction(SamSolve *w, Vec h)
{
  Passes        p         = {.w = w, .h = h, .error = INFINITY};
  Vec *const    created[] = {&p.gap, &p.found, &p.change};
  const SamGrid grid      = w->grid;

  PetscFunctionBegin;
  p.most = PetscMax(PASSES, SPREAD * PetscMax(grid->nx, grid->ny));
  for (int k = 0; k < 3; k++) PetscCall(SamGridCreateVec(grid, 1, created[k]));
  PetscCall(SamMixingCreate(grid, 1, &p.mixing));
  PetscCall(SamNormalAsSolver(w->solver)->effort == SAM_EFFORT_RESIDUAL_ONLY ? Measure(&p) : Iterate(&p));
  PetscCall(SamMixingDestroy(&p.mixing));
  for (int k = 0; k < 3; k++) PetscCall(VecDestroy(created[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
