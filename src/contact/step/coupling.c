/*
  The coupling of the normal and the tangential problem of dissimilar bodies: pressure displaces the surfaces
  tangentially, and shear displaces them normally.

  Algorithm; unknown is the lift d, the normal displacement by the shear, and where contact grows the motion m of the
  surfaces until cells touch (touching.c). A pass:
    1. The normal problem with the separation h + d gives p.
    2. The tangential problem with the bound mu p (bound.c) and the displacement by p gives q.
    3. The lift by q should be d, and the motion that follows from p and q should be m. If they are, d within the error
       of the normal problem with this lift, the step is solved: the same p and q then solve both problems.
    4. Else Anderson's method makes the next d and m of this and the last passes (fixedpoint.c).
  With much friction m need not settle: which cells stick at the edge changes with it, and that changes m. Then the m
  that the shear changed least with stays, and passes go on for d alone. That is rare (2 of 360 random problems); the
  shear may then be wrong by more than that change, up to its own size in cells at the edge.
  Plain passes (Panagiotopoulos 1975, Ing.-Arch. 44, 421) would shrink the error by friction times Dundurs' beta a pass,
  and diverge beyond 1: where cells slip, q = mu p e turns the coupling into a rotation of the pressure's waves, with
  imaginary eigenvalues, for which Anderson's method is made.

  Near the solution, where passes are slow, the next one starts from the solution of both problems as one system, whose
  sets of cells are those of the last pass (together.c).

  Each pass is solved only a little more accurately than the last error requires. If the error does not shrink, the
  shear is solved more accurately: a nearly uniform shear on periodic bodies may cause a displacement far smaller than
  that of its error, and the error is relative to the displacement. The pressure starts from that of the last pass and
  its product. So does the shear near the solution; farther away nested grids find the slip zones of the new pressure
  faster.

  Gross slip is decided by the coupled problem: where the bound cannot carry the loads, the shear is that of sliding,
  and the passes continue. If they end there, the whole contact slides, and the limit is that of the last pressure.
*/
#include "stepimpl.h"
#include <petsam/private/check.h>
#include <petsam/private/solver.h>
#include <petsam/private/tangential.h>
#include <math.h>

/* Error to which the first pass is solved, without and with a guess of p and q */
#define FIRST 1e-2
#define GUESS 1e-3
/* A pass that leaves a larger part of the error searches all cells for contact again. */
#define LOOK 0.9
/* Error below which a pass starts from the last shear and is solved completely */
#define NEAR  1e-2
#define EXACT 1e-5
/* After so many consecutive passes that did not find the shear in a brief solve, the solve is complete. */
#define PATIENCE 2
/* Passes without progress before the tangential tolerance is tightened, first and later, and the factor on it. */
#define WAITS      8
#define WAITS_NEXT 4
#define SHARPER    0.01
/* The motion until cells touch does not settle if for so many passes the shear does not change less than CALMER times
   the least change so far. */
#define RESTLESS 12
#define CALMER   0.5
/* Parts of the last error, and of the tolerances, to which the problems of a pass are solved. */
#define NORMAL_PART      0.1
#define NORMAL_FINAL     0.3
#define NORMAL_ENOUGH    0.7 /* the check's scale, the whole displacement, may be smaller than the one by p */
#define TANGENTIAL_FINAL 0.5
/* Part of the last change of the shear to which the shear is solved where the motion until cells touch changes with
   it: that may change the shear far more than the lift does. Once it changes less than SETTLED, the lift decides. */
#define FOLLOWS 0.02
#define SETTLED 1e-4
/* Error below which both problems are solved as one system (together.c), if after so many passes they have left a
   larger part of the error than SLOW on average: else passes are cheaper, as a product of the system leaves 0.4. */
#define CLOSE        1e-2
#define LEAST_PASSES 5
#define SLOW         0.35
/* Relative residual of the system, and in units of the error, whose square the error of frozen sets is like */
#define TOGETHER 0.02
#define SQUARE   30
/* Part of the error to which a system must bring it; the next one is for less than that, or where it did not, as the
   sets of cells still change, for less than LATER of it. */
#define PAYS  0.5
#define LATER 0.1
/* Error of pressure and shear below which the slip's direction is found, in units of the tolerance of the shear and of
   the part of the shear that the step changes, as the error is relative to all of it. It is SAM_ROUGH at least, and
   where the motion until cells touch follows from the same shear, which need not settle. */
#define DIRECTION 2000

typedef struct {
  SamSolve *s;
  Vec       unknown; /* the lift and, where it is to be found, the motion until cells touch */
  PetscReal error;   /* of the normal problem with the lift by the shear of the last pass */
  PetscReal rtol[2]; /* of the normal and the tangential problem, as the user wants them */
  PetscBool looks;   /* contact may exist outside of the cells searched so far */
  PetscBool slides;  /* the bound of this pass cannot carry the loads */
  PetscInt  stuck;   /* number of passes in a row whose shear was not found within a few iterations */
  PetscReal least;   /* least error so far */
  PetscInt  waits;   /* passes since the least error */
  PetscReal sharper; /* factor on the tolerance of the shear */
  PetscReal first;   /* the error of the first pass */
  PetscBool joined;  /* both problems have been solved as one system */
  PetscReal close;   /* the error below which they are the next time; 0: they cannot be */
  PetscBool rough;   /* the slip's direction is not known yet */
  PetscBool turns;   /* its guess is that of the step one cycle before */
  Vec       calm;    /* the motion until cells touch with which the shear changed least; NULL: none yet */
  PetscReal calmest; /* that relative change, and the one at which the passes were last counted from 0 */
  PetscReal mark;
  PetscReal changed;  /* relative change of the shear in the last pass */
  PetscInt  restless; /* number of passes since then */
  PetscInt  earlier;  /* number of passes before that motion was made to stay */
} Passes;

/* Copies the unknown to the lift and, where it is found, to the motion until cells touch, a part of `aside`. */
static PetscErrorCode Unpack(Passes *p)
{
  SamSolve      *s     = p->s;
  const PetscInt cells = s->grid->cells;
  const double  *x;
  double        *to;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(p->unknown, &x));
  PetscCall(VecGetArrayWrite(s->lift, &to));
  PetscCall(PetscArraycpy(to, x, cells));
  PetscCall(VecRestoreArrayWrite(s->lift, &to));
  if (SamSolveFindsTouching(s)) {
    if (s->s->aside) PetscCall(VecAXPY(s->s->aside, -1, s->touching));
    PetscCall(VecGetArrayWrite(s->touching, &to));
    PetscCall(PetscArraycpy(to, x + cells, 2 * cells));
    PetscCall(VecRestoreArrayWrite(s->touching, &to));
    if (s->s->aside) PetscCall(VecAXPY(s->s->aside, 1, s->touching));
  }
  PetscCall(VecRestoreArrayRead(p->unknown, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the lift and, unless it is NULL, the motion until cells touch as an unknown. */
static PetscErrorCode Pack(SamGrid grid, Vec lift, Vec motion, Vec unknown)
{
  const double *from;
  double       *x;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(unknown, &x));
  PetscCall(VecGetArrayRead(lift, &from));
  PetscCall(PetscArraycpy(x, from, grid->cells));
  PetscCall(VecRestoreArrayRead(lift, &from));
  if (motion) {
    PetscCall(VecGetArrayRead(motion, &from));
    PetscCall(PetscArraycpy(x + grid->cells, from, 2 * grid->cells));
    PetscCall(VecRestoreArrayRead(motion, &from));
  }
  PetscCall(VecRestoreArrayWrite(unknown, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the unknown by the solution of this pass. */
static PetscErrorCode FindUnknown(SamSolve *s, Vec result)
{
  Vec motion = NULL;

  PetscFunctionBegin;
  PetscCall(SamElasticityApplyTangentialToNormal(s->elasticity, s->s->shear, s->h));
  if (SamSolveFindsTouching(s)) {
    PetscCall(SamGridCreateVec(s->grid, 2, &motion));
    PetscCall(SamSolveFindTouching(s, motion));
  }
  PetscCall(Pack(s->grid, s->h, motion, result));
  PetscCall(VecDestroy(&motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps 1 and 2. The first pass starts from the guesses, later passes from the last pass. */
static PetscErrorCode Solve(Passes *p, PetscInt pass)
{
  SamSolve       *s     = p->s;
  const PetscBool brief = p->error > EXACT && p->stuck < PATIENCE;
  const PetscReal error = PetscMin(p->error, FIRST);
  /* the motion until cells touch need not settle, and follows from the shear of the first passes, too */
  const PetscReal part  = p->rough && s->touching ? PetscMin(error, SAM_ROUGH * p->rtol[1]) : error;
  const PetscReal moves = SamSolveFindsTouching(s) && !p->rough && p->changed > SETTLED ? FOLLOWS * p->changed : 0;
  const PetscReal rtol =
    p->sharper * PetscMax(TANGENTIAL_FINAL * PetscMin(p->rtol[0], p->rtol[1]), PetscMax(part, PetscMin(moves, FIRST)));
  const SamEffort effort = brief ? SAM_EFFORT_FEW_ITERATIONS : SAM_EFFORT_FULL;
  SamSolverReason reason;
  PetscReal       left;

  PetscFunctionBegin;
  SamSolverSetEffort(SamNormalAsSolver(s->solver), PetscMax(NORMAL_FINAL * p->rtol[0], NORMAL_PART * error),
                     p->looks ? SAM_EFFORT_FULL : SAM_EFFORT_CHECK_SUPPORT);
  /* Newton's method may get stuck on the shear of a pressure that is not smooth yet, and would waste iterations */
  SamSolverSetEffort(SamTangentialAsSolver(s->contact->tangential), rtol, effort);
  PetscCall(Unpack(p));
  PetscCall(VecCopy(s->lift, s->h));
  PetscCall((pass == 1 ? SamSolveBegun : SamSolveNormal)(s));
  PetscCall(SamSolveJudge(s, SAM_BALANCE_NORMAL));
  PetscCall(SamSolveBound(s, s->s->bound));
  p->slides = PETSC_FALSE;
  if (s->step->status != SAM_STATUS_CONVERGED) {
    PetscCall(SamSolveZeroShear(s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /* far from the solution nested grids find the slip zones of the new pressure faster than the last ones would */
  if (pass > 1) s->has_shear = p->error <= NEAR && !p->stuck ? PETSC_TRUE : PETSC_FALSE;
  if (pass == 1) PetscCall(SamSolveSetAside(s, p->turns ? SAM_ASIDE_KEPT : SAM_ASIDE_PREDICTED));
  PetscCall(SamSolveShear(s, rtol, effort));
  reason    = SamSolverGetReason(SamTangentialAsSolver(s->contact->tangential));
  p->stuck  = brief && reason == SAM_SOLVER_DIVERGED_ITS ? p->stuck + 1 : 0;
  p->slides = reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM && SamTangentialGetLimit(s->contact->tangential) > 0;
  PetscCall(SamSolverGetStatistics(SamTangentialAsSolver(s->contact->tangential), &left, NULL, NULL, NULL));
  /* rounding may exceed the tolerance of a pass; then the user's tolerance decides */
  if (!p->slides && !p->stuck && !(reason == SAM_SOLVER_DIVERGED_STAGNATED && left <= p->rtol[1]))
    PetscCall(SamSolveJudge(s, SAM_BALANCE_TANGENTIAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 3. `solved`: the pressure solves the normal problem with this lift, and the shear is accurate enough. */
static PetscErrorCode Measure(Passes *p, Vec result, PetscBool *solved)
{
  SamSolve       *s      = p->s;
  const PetscReal before = p->error;
  SamSolverReason reason;
  PetscReal       error;

  PetscFunctionBegin;
  PetscCall(FindUnknown(s, result));
  SamSolverSetEffort(SamNormalAsSolver(s->solver), NORMAL_ENOUGH * p->rtol[0], SAM_EFFORT_RESIDUAL_ONLY);
  PetscCall(SamSolveNormal(s));
  reason = SamSolverGetReason(SamNormalAsSolver(s->solver));
  if (reason < 0 && reason != SAM_SOLVER_DIVERGED_ITS) PetscCall(SamSolveJudge(s, SAM_BALANCE_NORMAL));
  PetscCall(SamSolverGetStatistics(SamNormalAsSolver(s->solver), &p->error, NULL, NULL, NULL));
  PetscCall(SamSolverGetStatistics(SamTangentialAsSolver(s->contact->tangential), &error, NULL, NULL, NULL));
  p->looks = p->error > LOOK * before;
  p->waits = p->error < LOOK * p->least ? 0 : p->waits + 1;
  p->least = PetscMin(p->least, p->error);
  if (p->waits == (p->sharper < 1 ? WAITS_NEXT : WAITS)) {
    p->waits = 0;
    p->sharper *= SHARPER;
  }
  *solved = reason > 0 && (p->slides || error <= p->rtol[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the relative change of a traction since the previous pass; copies `now` to `previous`. */
static PetscErrorCode ComputeChange(SamGrid grid, Vec now, Vec previous, PetscReal *change)
{
  PetscReal size;

  PetscFunctionBegin;
  PetscCall(VecAYPX(previous, -1, now));
  PetscCall(SamGridNorm(grid, previous, NORM_2, change));
  PetscCall(SamGridNorm(grid, now, NORM_2, &size));
  *change = *change > 0 ? *change / size : 0;
  PetscCall(VecCopy(now, previous));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the motion until cells touch with which the shear changed least. A pass whose shear was accurate enough before
   it was solved says nothing about the motion. */
static PetscErrorCode KeepCalm(Passes *p, PetscReal change)
{
  PetscFunctionBegin;
  if (change <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  p->restless++;
  if (change < CALMER * p->mark) {
    p->restless = 0;
    p->mark     = change;
  }
  if (change >= p->calmest) PetscFunctionReturn(PETSC_SUCCESS);
  p->calmest = change;
  if (!p->calm) PetscCall(SamGridCreateVec(p->s->grid, 2, &p->calm));
  PetscCall(VecCopy(p->s->touching, p->calm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if the passes end because neither p nor q changes any more. */
static PetscErrorCode Compare(Passes *p, PetscInt pass, PetscBool *solved)
{
  SamSolve                 *s   = p->s;
  const SamContactSettings *set = &s->contact->set;
  PetscReal                 change[2];

  PetscFunctionBegin;
  PetscCall(ComputeChange(s->grid, s->s->pressure, s->previous_pressure, &change[0]));
  PetscCall(ComputeChange(s->grid, s->s->shear, s->previous_shear, &change[1]));
  if (set->coupling_monitor)
    PetscCall(PetscPrintf(s->grid->comm, "%5" PetscInt_FMT " coupling error %.6e change of p %.6e q %.6e%s\n", pass,
                          (double)p->error, (double)change[0], (double)change[1], p->slides ? " slides" : ""));
  p->changed = pass > 1 ? change[1] : 0;
  *solved    = *solved && (pass == 1 || PetscMax(change[0], change[1]) <= set->coupling_rtol);
  if (SamSolveFindsTouching(s) && pass > 1) PetscCall(KeepCalm(p, change[1]));
  if (*solved && p->slides) PetscCall(SamSolveJudge(s, SAM_BALANCE_TANGENTIAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the slip's direction by the shear so far, if it is not known yet. */
static PetscErrorCode FindDirection(Passes *p)
{
  PetscFunctionBegin;
  if (p->rough) PetscCall(SamSolveSetAside(p->s, SAM_ASIDE_SOLVED));
  p->rough = PETSC_FALSE;
  p->least = INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if the errors are small enough for the slip's direction to be found by the shear so far. */
static PetscErrorCode IsClose(const Passes *p, PetscBool *is)
{
  const SamSolution *const before  = p->s->before;
  PetscReal                allowed = SAM_ROUGH, change = 1, size = 1, error;
  Vec                      shear;

  PetscFunctionBegin;
  PetscCall(SamSolverGetStatistics(SamTangentialAsSolver(p->s->contact->tangential), &error, NULL, NULL, NULL));
  error = PetscMax(error, p->error);
  if (!p->s->touching && error <= DIRECTION * p->rtol[1]) {
    if (before) {
      PetscCall(VecDuplicate(before->shear, &shear));
      PetscCall(VecWAXPY(shear, -1, before->shear, p->s->s->shear));
      PetscCall(SamGridNorm(p->s->grid, shear, NORM_2, &change));
      PetscCall(SamGridNorm(p->s->grid, p->s->s->shear, NORM_2, &size));
      PetscCall(VecDestroy(&shear));
    }
    if (size > 0) allowed = PetscMax(allowed, DIRECTION * PetscMin(change / size, 1));
  }
  *is = error <= allowed * p->rtol[1] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the sets of cells may be those of the solution, and the passes so far have been slow. */
static PetscBool IsSlow(const Passes *p, PetscInt pass)
{
  if (p->rough || p->slides || p->stuck || p->error >= p->close) return PETSC_FALSE;
  return p->joined || (pass > LEAST_PASSES && p->error > p->first * pow(SLOW, (double)(pass - 1)));
}

/* Lets passes go on after a solve that has failed. */
static void GoOn(SamStep *step)
{
  step->status     = SAM_STATUS_CONVERGED;
  step->message[0] = step->setting[0] = '\0';
}

/* Makes the tractions those of the last pass again. */
static PetscErrorCode TakeBack(Passes *p, Vec result)
{
  SamSolve *const s = p->s;
  PetscBool       solved;

  PetscFunctionBegin;
  GoOn(s->step);
  PetscCall(VecCopy(s->previous_pressure, s->s->pressure));
  PetscCall(VecCopy(s->previous_shear, s->s->shear));
  s->pressure_product.n[0] = s->shear_product.n[0] = 0;
  PetscCall(Measure(p, result, &solved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes a step for both problems as one system. Unless it reduces the error, the tractions stay those of the pass. */
static PetscErrorCode Join(Passes *p, Vec result, SamPassEnd *end)
{
  SamSolve *const s      = p->s;
  const PetscReal before = p->error, rtol = PetscMin(TOGETHER, SQUARE * before);
  PetscBool       made, solved, better;

  PetscFunctionBegin;
  PetscCall(SamSolveTogether(s, PetscMax(rtol, NORMAL_FINAL * p->rtol[0] / before), &made));
  p->joined = PETSC_TRUE;
  p->close  = LATER * before;
  if (!made) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Measure(p, result, &solved));
  better = s->step->status == SAM_STATUS_CONVERGED && p->error < before ? PETSC_TRUE : PETSC_FALSE;
  if (better && p->error <= PAYS * before) p->close = PAYS * before;
  if (!better) PetscCall(TakeBack(p, result));
  PetscCall(VecCopy(s->s->pressure, s->previous_pressure));
  PetscCall(VecCopy(s->s->shear, s->previous_shear));
  *end = SAM_PASS_RESTARTS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pass(void *context, PetscInt pass, Vec result, SamPassEnd *end)
{
  Passes *const  p      = (Passes *)context;
  SamStep *const step   = p->s->step;
  PetscBool      solved = PETSC_FALSE, close = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(Solve(p, pass));
  p->s->counts[SAM_COUNT_COUPLING] = (double)(p->earlier + pass);
  if (step->status == SAM_STATUS_CONVERGED) PetscCall(Measure(p, result, &solved));
  *end = SAM_PASS_FAILED;
  if (step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Compare(p, pass, &solved));
  *end = solved ? SAM_PASS_SOLVED : SAM_PASS_GOES_ON;
  if (p->rough && !p->slides && !p->stuck) PetscCall(IsClose(p, &close));
  if (close) {
    PetscCall(FindDirection(p));
    *end = SAM_PASS_RESTARTS;
  }
  if (pass == 1) p->first = p->error;
  if (*end == SAM_PASS_GOES_ON && IsSlow(p, pass)) PetscCall(Join(p, result, end));
  if (*end == SAM_PASS_GOES_ON && SamSolveFindsTouching(p->s) && p->restless >= RESTLESS) *end = SAM_PASS_FAILED;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Fail(Passes *p)
{
  SamStep *const step = p->s->step;
  char           message[sizeof(step->message)];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(message, sizeof(message),
                          "the coupling of normal and tangential problem did not converge within %" PetscInt_FMT
                          " iterations, normal residual %.2g, tolerance %.2g",
                          p->s->contact->set.coupling_max_it, (double)p->error, (double)p->rtol[0]));
  PetscCall(SamStepFail(step, SAM_STATUS_NOT_CONVERGED, message));
  PetscCall(PetscStrncpy(step->setting, "coupling_max_it", sizeof(step->setting)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the pressure and the shear of the same step one cycle before the guess, if it has been repeated: until then the
   steps before are better guesses. `found`: true if its contact is at the same place. */
static PetscErrorCode TakeKept(SamSolve *s, PetscBool *found)
{
  const SamCachedStep kept    = s->kept;
  SamProduct          product = {.rounding = 0}; /* it is not used: the displacement is also by the pressure */
  Vec                 shear, pressure;

  PetscFunctionBegin;
  *found  = PETSC_FALSE;
  s->kept = NULL;
  if (!SamCachedStepIsRepeated(kept)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(s->grid, 2, &product.field));
  PetscCall(SamGridCreateVec(s->grid, 2, &shear));
  PetscCall(SamGridCreateVec(s->grid, 1, &pressure));
  PetscCall(VecCopy(s->s->pressure, pressure));
  PetscCall(SamCachedStepGetPressure(kept, s->grid, s->s, found));
  if (*found) {
    PetscCall(SamSolveBound(s, s->s->bound));
    PetscCall(SamCachedStepGetShear(kept, s->elasticity, s->before, s->s->bound, shear, &product, found));
  }
  PetscCall(*found ? VecCopy(shear, s->s->shear) : VecCopy(pressure, s->s->pressure));
  PetscCall(VecDestroy(&pressure));
  PetscCall(VecDestroy(&shear));
  PetscCall(VecDestroy(&product.field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the first lift by the guess of the shear, and finds the error of a guess that is the step one cycle before. */
static PetscErrorCode Start(Passes *p)
{
  SamSolve *const s      = p->s;
  const SamSolver normal = SamNormalAsSolver(s->solver);
  PetscBool       kept;

  PetscFunctionBegin;
  PetscCall(TakeKept(s, &kept));
  s->has_pressure = s->has_pressure || kept;
  s->has_shear    = s->has_shear || kept;
  p->turns        = kept && SamCachedStepHasTurn(s->contact->tried.start.kept);
  p->error        = s->has_shear ? GUESS : FIRST;
  if (s->has_shear) PetscCall(SamElasticityApplyTangentialToNormal(s->elasticity, s->s->shear, s->lift));
  if (!kept) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(s->lift, s->h));
  SamSolverSetEffort(normal, NORMAL_ENOUGH * p->rtol[0], SAM_EFFORT_RESIDUAL_ONLY);
  PetscCall(SamSolveNormal(s));
  PetscCall(SamSolverGetStatistics(normal, &p->error, NULL, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the motion until cells touch with which the shear changed least the one that stays, for passes from the last
   tractions on. */
static PetscErrorCode HoldCalm(Passes *p)
{
  SamSolve *const s = p->s;

  PetscFunctionBegin;
  if (s->monitor)
    PetscCall(
      PetscPrintf(s->grid->comm, "      the motion until cells touch stays, change of q %.6e\n", (double)p->calmest));
  PetscCall(FindDirection(p));
  PetscCall(VecAXPY(s->s->aside, -1, s->touching));
  PetscCall(VecCopy(p->calm, s->touching));
  PetscCall(VecAXPY(s->s->aside, 1, s->touching));
  GoOn(s->step);
  SamSolveStartFromLast(s);
  s->holds   = PETSC_TRUE;
  p->sharper = 1;
  p->stuck = p->waits = 0;
  p->looks            = PETSC_TRUE;
  p->earlier          = (PetscInt)s->counts[SAM_COUNT_COUPLING];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes passes until they end; `more`: a motion until cells touch that does not settle shall stay. */
static PetscErrorCode Iterate(Passes *p, PetscBool *more)
{
  SamSolve *const     s         = p->s;
  const PetscBool     touching  = SamSolveFindsTouching(s);
  const SamFixedPoint iteration = {
    .components = touching ? 3 : 1, .most = s->contact->set.coupling_max_it, .pass = Pass};
  SamPassEnd end;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, iteration.components, &p->unknown));
  PetscCall(Pack(s->grid, s->lift, touching ? s->touching : NULL, p->unknown));
  PetscCall(SamSolveFixedPoint(s, &iteration, p, p->unknown, &end));
  PetscCall(VecDestroy(&p->unknown));
  *more = p->calm && !s->holds && end != SAM_PASS_SOLVED && s->step->status != SAM_STATUS_NO_EQUILIBRIUM;
  if (end == SAM_PASS_GOES_ON && !*more) PetscCall(Fail(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveCoupled(SamSolve *s)
{
  const SamSolver normal = SamNormalAsSolver(s->solver), tangential = SamTangentialAsSolver(s->contact->tangential);
  Passes          p = {.s       = s,
                       .looks   = PETSC_TRUE,
                       .least   = INFINITY,
                       .calmest = INFINITY,
                       .mark    = INFINITY,
                       .sharper = 1,
                       .rough   = SamSolveIsTwice(s)};
  PetscBool       more, together;

  PetscFunctionBegin;
  PetscCall(SamSolveCanJoin(s, &together));
  p.close = together ? CLOSE : 0;
  PetscCall(SamSolverGetTolerances(normal, &p.rtol[0], NULL));
  PetscCall(SamSolverGetTolerances(tangential, &p.rtol[1], NULL));
  PetscCall(Start(&p));
  PetscCall(Iterate(&p, &more));
  if (more) {
    PetscCall(HoldCalm(&p));
    PetscCall(Iterate(&p, &more));
    s->holds = PETSC_FALSE;
  }
  PetscCall(VecDestroy(&p.calm));
  SamSolverSetEffort(normal, 0, SAM_EFFORT_FULL);
  SamSolverSetEffort(tangential, 0, SAM_EFFORT_FULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}
