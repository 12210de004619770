/*
  Deferred correction of pressure and shear for the edges of contact and stick.

  Algorithm of a step with friction:
    1. The plain normal and tangential problems, from the plain solution of the step before.
    2. The pressure is corrected (deferred.c), and the tangential problem solved again with it.
    3. As often again as that of the pressure: from p and q follows what the shear does within cells (edges/shear.c),
       and the slack mu p - |q| of cells that the stick zone's edge cuts and whose centre slips, the rim. The
       displacement by it, beyond that of the means, is added to the tangential displacement; the bound of cells on the
       rim is less by their slack; the tangential problem is solved again, from the last shear.
  What the shear does within cells has a history, as the shear has, and is kept from step to step. Where the edge of
  stick is not smooth or not resolved, as in a slip zone of a cell or two after a reversal, it is left as it is in that
  step; where nothing has been corrected before, or where the contact grows over a shear that sticks, the plain solution
  stays.

  The plain solution goes along because the errors of p and q, of the same operator, cancel in it: its energies are
  right to the second order of the cell however thin the slip zone is, where the work of a corrected shear on the slip
  at the centres of cells is not. So they are those of the step. And it stays, p and q, where the pressure is not
  corrected: to correct only one of them would be worse than none.
*/
#include "stepimpl.h"

#define FAR 0.2 /* most change of the shear by a correction, of the bound, in the 2-norm */

typedef struct {
  SamSolve       *s;
  SamShearProfile profile;
  SamProfile      pressure; /* NULL: it has none */
  SamShearBefore  before;   /* its shear is NULL without one */
  Vec             slips;
} Deferred;

/* ---- the plain solution ---- */

const SamSolution *SamContactPlainBefore(SamContact c)
{
  if (!c->steps) return NULL;
  return c->committed.solution.sheared.has ? &c->committed.plain : &c->committed.solution;
}

const SamSolution *SamContactBefore(SamContact c)
{
  return c->steps && c->tried.solution.sheared.has ? &c->committed.solution : SamContactPlainBefore(c);
}

/* Loads, displacements, pressure, bound and shear. */
static PetscErrorCode CopyTractions(const SamSolution *from, SamSolution *to)
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(to->load, from->load, SAM_COMPONENTS));
  PetscCall(PetscArraycpy(to->rigid, from->rigid, SAM_COMPONENTS));
  PetscCall(SamVecCopyNonzero(from->pressure, to->pressure));
  PetscCall(SamVecCopyNonzero(from->bound, to->bound));
  PetscCall(SamVecCopyNonzero(from->shear, to->shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode KeepPlain(SamSolve *s)
{
  SamSolution *plain = &s->c->tried.plain;

  PetscFunctionBegin;
  if (!plain->pressure) PetscCall(SamSolutionCreate(s->c->grid, plain));
  plain->control = s->s->control;
  PetscCall(CopyTractions(s->s, plain));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A shear and its slopes (NULL: none) as a reference. */
static PetscErrorCode SetReference(Vec shear, Vec slopes, Vec reference)
{
  const double *from;
  double       *to;
  PetscInt      n, m;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(shear, &n));
  PetscCall(VecGetLocalSize(reference, &m));
  PetscCall(VecGetArrayWrite(reference, &to));
  PetscCall(VecGetArrayRead(shear, &from));
  PetscCall(PetscArraycpy(to, from, n));
  PetscCall(VecRestoreArrayRead(shear, &from));
  if (slopes) PetscCall(VecGetArrayRead(slopes, &from));
  for (PetscInt k = n; k < m; k++) to[k] = slopes ? from[k - n] : 0;
  if (slopes) PetscCall(VecRestoreArrayRead(slopes, &from));
  PetscCall(VecRestoreArrayWrite(reference, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The references of the step: those of the step before, or that step itself where the load has turned back. `s` has its
  plain solution.
*/
static PetscErrorCode FindReferences(SamSolve *s, PetscBool *turned)
{
  const SamContact          c      = s->c;
  const SamSolution        *plain  = SamContactPlainBefore(c);
  const SamShearCorrection *before = &c->committed.solution.sheared;
  SamShearCorrection       *now    = &s->s->sheared;

  PetscFunctionBegin;
  PetscCall(SamShearCorrectionCreate(c->grid, now));
  *turned = PETSC_FALSE;
  if (!plain) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolveFindTurn(s, plain, turned));
  now->within.refers = *turned || before->within.refers;
  if (*turned) {
    PetscCall(VecCopy(plain->shear, now->plain_reference));
    PetscCall(
      SetReference(c->committed.solution.shear, before->has ? before->within.slopes : NULL, now->within.reference));
  } else if (before->within.refers) {
    PetscCall(SamVecCopyNonzero(before->plain_reference, now->plain_reference));
    PetscCall(SamVecCopyNonzero(before->within.reference, now->within.reference));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* It stays. What comes after it goes on from a shear without any variation within cells. */
static PetscErrorCode TakePlain(SamSolve *s)
{
  SamShearCorrection *now = &s->s->sheared;

  PetscFunctionBegin;
  PetscCall(CopyTractions(&s->c->tried.plain, s->s));
  PetscCall(SamVecZero(now->within.slopes));
  PetscCall(SamVecZero(now->within.terms));
  PetscCall(SetReference(now->plain_reference, NULL, now->within.reference));
  now->has             = PETSC_FALSE;
  s->s->passes         = 0;
  s->step->edge_passes = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the correction ---- */

static PetscErrorCode Create(SamSolve *s, Deferred *d)
{
  const SamContact c = s->c;
  PetscBool        found;

  PetscFunctionBegin;
  *d = (Deferred){.s = s};
  PetscCall(SamContactGetShearProfile(c, &d->profile));
  PetscCall(SamContactGetProfile(c, &d->pressure));
  PetscCall(SamProfileMatch(d->pressure, s->s->pressure, s->s->rim, &found));
  if (!found) d->pressure = NULL;
  if (c->steps && c->committed.solution.sheared.has)
    PetscCall(VecCopy(c->committed.solution.sheared.displacement, s->s->sheared.displacement));
  PetscCall(SamGridCreateVec(c->grid, 1, &d->slips));
  s->s->sheared.has = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The share of the stick zone's edge that is smooth by the slack of that kind, whose profile is started; 1: no edge. */
static PetscErrorCode Start(Deferred *d, SamSlack kind, PetscReal *share, PetscBool *smooth)
{
  SamProfile profile;
  SamEdge    edge;
  PetscBool  found;
  Vec        slack;

  PetscFunctionBegin;
  PetscCall(SamShearProfileFindSlack(d->profile, kind, d->s->s->sheared.within.reference, &slack, &profile));
  PetscCall(SamProfileStart(profile, slack, &edge, &found));
  *share  = edge.faces > 0 ? edge.smooth / edge.faces : 1;
  *smooth = edge.faces > 0 && found && *share >= SAM_SMOOTH_EDGE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Which slack the stick zone's edge is found by: the one by which it is smooth. `share`: of the edge that is, 1 without
  an edge.
*/
static PetscErrorCode ChooseSlack(Deferred *d, PetscReal *share)
{
  SamShearCorrection *now = &d->s->s->sheared;
  PetscReal           other;
  PetscBool           smooth;

  PetscFunctionBegin;
  now->slack = SAM_SLACK_OF_LIMIT;
  PetscCall(Start(d, now->slack, share, &smooth));
  if (smooth) PetscFunctionReturn(PETSC_SUCCESS);
  if (now->within.refers) {
    now->slack = SAM_SLACK_OF_CHANGE;
    PetscCall(Start(d, now->slack, &other, &smooth));
    *share = PetscMax(*share, other);
    if (smooth) PetscFunctionReturn(PETSC_SUCCESS);
  }
  now->slack = SAM_SLACK_NONE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Whether the slack of the rim is a part of the bound: where that is not near to the edge of contact, more than half of
  it is no cell that an edge cuts.
*/
static PetscErrorCode IsSmall(Deferred *d, Vec rim, PetscBool *small)
{
  const double *r, *b;
  double        over = 0;
  PetscReal     most;

  PetscFunctionBegin;
  PetscCall(VecMax(d->s->s->bound, NULL, &most));
  PetscCall(VecGetArrayRead(rim, &r));
  PetscCall(VecGetArrayRead(d->s->s->bound, &b));
  for (PetscInt k = 0; k < d->s->c->grid->cells; k++)
    if (r[k] > 0.5 * b[k] && b[k] > 0.5 * most) over = 1;
  PetscCall(VecRestoreArrayRead(d->s->s->bound, &b));
  PetscCall(VecRestoreArrayRead(rim, &r));
  PetscCall(SamMax(d->s->c->grid->comm, 1, &over));
  *small = over == 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edge of stick is not smooth: it stays as it is where the step before is corrected, else nothing is corrected. */
static PetscErrorCode LeaveStickEdge(Deferred *d, PetscReal share, char why[], size_t size)
{
  const SamContact c = d->s->c;

  PetscFunctionBegin;
  d->s->s->sheared.slack = SAM_SLACK_NONE;
  PetscCall(SamEdgeTooRough(share, why, size));
  if (!c->steps || !c->committed.solution.sheared.has) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolveLeaveEdge(d->s, "stick", PETSC_FALSE, why));
  why[0] = '\0';
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slack's profile and its rim, if there is an edge of stick; `why`: there is none that can be corrected. */
static PetscErrorCode FindStickEdge(Deferred *d, PetscInt pass, char why[], size_t size)
{
  SamShearCorrection *now   = &d->s->s->sheared;
  PetscReal           share = 1;
  PetscBool           found = PETSC_TRUE;
  Vec                 slack, zone, rim;
  SamProfile          profile;

  PetscFunctionBegin;
  if (pass == 1) {
    PetscCall(ChooseSlack(d, &share));
    if (share < SAM_SMOOTH_EDGE && now->slack == SAM_SLACK_NONE) PetscCall(LeaveStickEdge(d, share, why, size));
  } else if (now->slack != SAM_SLACK_NONE) {
    PetscCall(SamShearProfileFindSlack(d->profile, now->slack, now->within.reference, &slack, &profile));
    PetscCall(SamProfileMatch(profile, slack, now->rim, &found));
  }
  PetscCall(SamVecZero(now->rim));
  if (now->slack == SAM_SLACK_NONE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamShearProfileGetProfile(d->profile, &profile));
  if (found) PetscCall(SamProfileMove(profile, &found));
  PetscCall(SamProfileGetZone(profile, &zone, &rim));
  if (found) PetscCall(IsSmall(d, rim, &found));
  if (found) {
    PetscCall(VecPointwiseMin(now->rim, rim, d->s->s->bound));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(LeaveStickEdge(d, 0, why, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the tangential problem again; `why`: that has failed. */
static PetscErrorCode Again(Deferred *d, char why[], size_t size)
{
  SamSolverReason reason;

  PetscFunctionBegin;
  PetscCall(SamSolveTangential(d->s, PETSC_TRUE));
  PetscCall(SamSolverGetReason(d->s->c->tangential, &reason));
  if (reason < 0)
    PetscCall(PetscSNPrintf(why, size, "the corrected problem did not converge (%s)", SamSolverReasonName(reason)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the shear does within cells, and its displacement. */
static PetscErrorCode FindDisplacement(Deferred *d)
{
  SamShearCorrection         *now    = &d->s->s->sheared;
  const SamShearBefore *const before = d->before.shear ? &d->before : NULL;

  PetscFunctionBegin;
  PetscCall(SamShearProfileFind(d->profile, d->pressure, now->slack, before, &now->within));
  PetscCall(SamShearProfileComputeDisplacement(d->profile, &now->within, now->displacement));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One pass; `why` is empty while all is well. */
static PetscErrorCode Pass(Deferred *d, PetscInt pass, char why[], size_t size)
{
  SamSolve            *s      = d->s;
  SamShearCorrection  *now    = &s->s->sheared;
  const SamShearFields fields = {s->s->pressure, s->s->bound, s->s->shear, d->slips, now->rim};

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  PetscCall(SamSolutionFindSlips(s->s, d->slips));
  PetscCall(SamShearProfileSet(d->profile, &fields));
  PetscCall(FindStickEdge(d, pass, why, size));
  if (!why[0]) PetscCall(FindDisplacement(d));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  if (why[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Again(d, why, size));
  now->passes = now->slack != SAM_SLACK_NONE ? pass : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A correction changes a layer of cells along the edges. More is no correction, and `why` says so. */
static PetscErrorCode Compare(SamSolve *s, char why[], size_t size)
{
  PetscReal difference, bound;
  Vec       change;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(s->s->shear, &change));
  PetscCall(VecWAXPY(change, -1, s->c->tried.plain.shear, s->s->shear));
  PetscCall(SamGridNorm(s->c->grid, change, NORM_2, &difference));
  PetscCall(SamGridNorm(s->c->grid, s->s->bound, NORM_2, &bound));
  PetscCall(VecDestroy(&change));
  if (difference > FAR * bound)
    PetscCall(PetscStrncpy(why, "the correction led too far from the plain solution", size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 3; `turned`: the load has, since the step before. */
static PetscErrorCode CorrectShear(SamSolve *s, PetscBool turned)
{
  const SamContact c       = s->c;
  SamSolution     *before  = &c->committed.solution;
  char             why[96] = "";
  Deferred         d;
  PetscReal        shear;

  PetscFunctionBegin;
  PetscCall(Create(s, &d));
  if (c->steps) {
    if (!before->sheared.within.slopes) PetscCall(SamShearCorrectionCreate(c->grid, &before->sheared));
    d.before = (SamShearBefore){before->shear, &before->sheared.within, turned};
  }
  PetscCall(VecNorm(s->s->shear, NORM_INFINITY, &shear));
  if (shear != 0) PetscCall(Again(&d, why, sizeof(why)));
  for (PetscInt pass = 1; pass <= c->edge_passes && !why[0] && shear != 0; pass++)
    PetscCall(Pass(&d, pass, why, sizeof(why)));
  PetscCall(VecDestroy(&d.slips));
  if (!why[0]) PetscCall(Compare(s, why, sizeof(why)));
  if (!why[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TakePlain(s));
  PetscCall(SamSolveLeaveEdge(s, "stick", PETSC_TRUE, why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TakeBefore(SamSolve *s)
{
  const SamContact   c         = s->c;
  const SamSolution *committed = &c->committed.solution;

  PetscFunctionBegin;
  PetscCall(KeepPlain(s)); /* makes its fields */
  PetscCall(CopyTractions(committed, s->s));
  PetscCall(CopyTractions(&c->committed.plain, &c->tried.plain));
  PetscCall(SamSolutionCopyCorrection(c->grid, committed, s->s));
  PetscCall(SamShearCorrectionCopy(c->grid, &committed->sheared, &s->s->sheared));
  s->step->edge_passes         = committed->passes;
  s->step->stick_passes        = committed->sheared.passes;
  s->step->coupling_iterations = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveCorrected(SamSolve *s, const SamStepStart *start)
{
  const SamContact   c         = s->c;
  const SamSolution *committed = &c->committed.solution;
  PetscBool          turned = PETSC_FALSE, grows = PETSC_FALSE, held;

  PetscFunctionBegin;
  s->before = SamContactPlainBefore(c);
  PetscCall(SamSolveIsHeld(s, &held));
  if (held) {
    PetscCall(TakeBefore(s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamSolveNormal(s, start->pressure, start->shear));
  if (s->same_pressure) {
    PetscCall(SamVecCopyNonzero(s->before->pressure, s->s->pressure));
    SamSolveStoreNormal(s, s->before);
    s->s->passes = 0; /* so far */
  } else {
    PetscCall(SamSolveJudgeNormal(s));
  }
  PetscCall(SamSolveShearOnce(s, start->shear));
  if (s->step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KeepPlain(s));
  PetscCall(FindReferences(s, &turned));
  if (c->steps && !s->same_pressure) PetscCall(SamSolveFindGrowth(s, SamContactPlainBefore(c), &grows));
  if (grows) {
    PetscCall(TakePlain(s));
    PetscCall(SamSolveLeaveEdge(s, "stick", PETSC_TRUE, "the contact grows over the edge of a shear that sticks"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (s->same_pressure) {
    PetscCall(SamVecCopyNonzero(committed->pressure, s->s->pressure));
    SamSolveStoreNormal(s, committed);
    s->s->passes = s->step->edge_passes = committed->passes;
  } else {
    PetscCall(SamSolveDeferred(s));
  }
  if (!s->s->passes) {
    PetscCall(TakePlain(s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamProblemComputeBound(c->problem, s->s->control.friction_scale, s->s->pressure, s->s->bound));
  PetscCall(SamFollowPressure(c->grid, c->tried.plain.pressure, s->s->pressure, s->s->shear));
  s->before = c->steps ? committed : NULL;
  PetscCall(CorrectShear(s, turned));
  s->step->stick_passes = s->s->sheared.has ? s->s->sheared.passes : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
