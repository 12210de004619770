/*
  Deferred correction of the pressure for the edge of contact.

  The solvers take the pressure as constant in each cell. Where it vanishes like the root of the distance from the edge,
  that displaces the surfaces wrongly by the first order of the cell, in a layer of two cells. So, when the plain
  problem S p + h = d is solved:
    1. From p follows what the pressure does within the cells along the edge, and which cells it cuts (edges/profile.c).
    2. The displacement c by that, beyond that of the means, is added to the gap. Cells that it cuts and whose centre
       lies outside, the rim, bear the given means r; their gaps are open, or they bear more.
    3. S (p + r) + h + c = d is solved again for p, from the last one, under the loads less those of r.
  Two passes leave a twentieth to a fiftieth of the error. The rest comes from the size of the sub-cells.

  It is a correction for edges that are smooth and resolved. Others are known by the layer that they lack, and the plain
  solution stays. It is one of the pressure: a shear that is solved with the plain operator and bounded by the corrected
  pressure is less exact than with the plain one, whose errors cancel. So with friction the shear is corrected as well
  (deferredshear.c).
*/
#include "stepimpl.h"
#include <petsam/edges.h>
#include <math.h>

/* The plain solution, and what is needed to correct it. */
typedef struct {
  SamSolve  *s;
  SamProfile profile;
  Vec        h;       /* the corrected separation */
  Vec        plain;   /* pressure */
  SamBalance balance; /* of it */
} Deferred;

PetscErrorCode SamSolveLeaveEdge(SamSolve *s, const char of[], PetscBool plain, const char why[])
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(s->step->message, sizeof(s->step->message), "the edge of %s is not corrected%s: %s", of,
                          plain ? ", so the step stays as it is without" : "", why));
  PetscCall(PetscStrncpy(s->step->setting, "edges", sizeof(s->step->setting)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeTooRough(PetscReal share, char why[], size_t size)
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(
    why, size, "%.3g %% of it is smooth and resolved, %.0f %% would be needed; another grid helps, best a finer one",
    100 * (double)share, 100 * SAM_SMOOTH_EDGE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamSolve *s, Deferred *d)
{
  const SamGrid grid = s->c->grid;

  PetscFunctionBegin;
  *d = (Deferred){.s = s};
  PetscCall(SamContactGetProfile(s->c, &d->profile));
  PetscCall(SamGridCreateVec(grid, 1, &d->h));
  PetscCall(SamGridCreateVec(grid, 1, &d->plain));
  PetscCall(SamSolutionCreateCorrection(grid, s->s));
  PetscCall(SamVecCopyNonzero(s->s->pressure, d->plain));
  d->balance = s->normal;
  for (PetscInt k = 0; k < 3; k++) {
    d->balance.load[k]  = s->s->load[SamComponentsOf[SAM_BALANCE_NORMAL][k]];
    d->balance.rigid[k] = s->s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][k]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Deferred *d)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&d->h));
  PetscCall(VecDestroy(&d->plain));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The plain solution stays, with a message that says why. */
static PetscErrorCode GiveUp(Deferred *d, const char why[])
{
  SamSolve *s = d->s;

  PetscFunctionBegin;
  s->s->passes = 0;
  PetscCall(SamVecCopyNonzero(d->plain, s->s->pressure));
  SamBalanceStore(&d->balance, s->s->load, s->s->rigid);
  PetscCall(SamSolveLeaveEdge(s, "contact", PETSC_FALSE, why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The separation of step 2, and where the pressure starts: that of the last pass in the zone. */
static PetscErrorCode Prepare(Deferred *d)
{
  SamSolve     *s = d->s;
  const double *in;
  double       *p;
  Vec           gap, zone, rim;

  PetscFunctionBegin;
  PetscCall(SamProfileGetZone(d->profile, &zone, &rim));
  PetscCall(VecCopy(rim, s->s->rim));
  PetscCall(SamProfileComputeDisplacement(d->profile, s->s->correction));
  PetscCall(SamElasticityApplyNormal(s->c->elasticity, rim, d->h));
  PetscCall(VecAXPY(d->h, 1, s->s->correction));
  PetscCall(SamProblemGetGap(s->c->problem, &gap));
  PetscCall(VecAXPY(d->h, 1, gap));
  PetscCall(VecGetArrayRead(zone, &in));
  PetscCall(VecGetArray(s->s->pressure, &p));
  for (PetscInt k = 0; k < s->c->grid->cells; k++) p[k] = in[k] > 0 ? p[k] : 0;
  PetscCall(VecRestoreArray(s->s->pressure, &p));
  PetscCall(VecRestoreArrayRead(zone, &in));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 3. */
static PetscErrorCode SolveAgain(Deferred *d)
{
  SamSolve  *s       = d->s;
  SamBalance balance = s->normal;
  PetscReal  borne[3];

  PetscFunctionBegin;
  PetscCall(SamBalanceGetLoads(s->c->grid, SAM_BALANCE_NORMAL, s->s->rim, borne));
  for (PetscInt k = 0; k < 3; k++) {
    balance.load[k] -= balance.force[k] ? borne[k] : 0;
    if (balance.force[k]) balance.rigid[k] = s->s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][k]];
  }
  PetscCall(SamNormalSolve(s->c->normal, d->h, &balance, PETSC_TRUE, s->s->pressure));
  PetscCall(VecAXPY(s->s->pressure, 1, s->s->rim));
  for (PetscInt k = 0; k < 3; k++) balance.load[k] = balance.force[k] ? s->normal.load[k] : balance.load[k] + borne[k];
  SamBalanceStore(&balance, s->s->load, s->s->rigid);
  PetscCall(SamSolveCountNormal(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One pass; `why` is empty while all is well. */
static PetscErrorCode Pass(Deferred *d, PetscInt pass, char why[], size_t size)
{
  SamSolve       *s     = d->s;
  PetscBool       found = PETSC_TRUE;
  SamSolverReason reason;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  if (pass > 1) PetscCall(SamProfileMatch(d->profile, s->s->pressure, s->s->rim, &found));
  if (found) PetscCall(SamProfileMove(d->profile, &found));
  if (found) PetscCall(Prepare(d));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  if (!found) {
    PetscCall(PetscStrncpy(why, "there are too few cells along it", size));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolveAgain(d));
  PetscCall(SamSolverGetReason(s->c->normal, &reason));
  if (reason < 0)
    PetscCall(PetscSNPrintf(why, size, "the corrected problem did not converge (%s)", SamSolverReasonName(reason)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveDeferred(SamSolve *s)
{
  const SamContact c       = s->c;
  char             why[96] = "";
  PetscBool        found;
  SamEdge          edge = {.faces = 0};
  Deferred         d;

  PetscFunctionBegin;
  PetscCall(Create(s, &d));
  if (!c->traits.within)
    PetscCall(PetscStrncpy(why, "that is known for -elasticity halfspace only", sizeof(why)));
  else
    PetscCall(SamProfileStart(d.profile, s->s->pressure, &edge, &found));
  if (edge.smooth < SAM_SMOOTH_EDGE * edge.faces)
    PetscCall(SamEdgeTooRough((PetscReal)(edge.smooth / edge.faces), why, sizeof(why)));
  for (PetscInt pass = 1; pass <= c->edge_passes && !why[0] && edge.faces > 0; pass++) {
    PetscCall(Pass(&d, pass, why, sizeof(why)));
    s->s->passes = pass;
  }
  if (why[0]) PetscCall(GiveUp(&d, why));
  s->step->edge_passes = s->s->passes;
  PetscCall(Destroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}
