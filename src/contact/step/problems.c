/* The two problems of a step, each solved once, and the messages if one has no solution. */
#include "stepimpl.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/balance.h>
#include <petsam/private/check.h>
#include <petsam/private/problem.h>
#include <petsam/private/solver.h>
#include <petsam/private/pressed.h>
#include <petsam/private/tangential.h>
#include <math.h>

/* ---- the normal problem ---- */

/* Writes the message for loads that no pressure balances, or for an approach that is too large, with the limit. */
static PetscErrorCode DescribeImpossible(SamSolve *w, char message[], size_t size)
{
  const SamGrid grid = w->grid;
  PetscBool     possible;
  PetscReal     sum, limit;

  PetscFunctionBegin;
  if (w->s->tension && SamSolveTiltCure(w)[0]) {
    PetscCall(PetscSNPrintf(message, size, "no contact balances the tension and the given loads: give %ssmaller pulls",
                            SamSolveTiltCure(w)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamProblemGetPressureLimit(w->contact->problem, &limit));
  PetscCall(SamBalanceLever(grid, &w->normal, message, size, &possible));
  if (possible) PetscCall(SamBalanceCapacity(grid, &w->normal, limit, message, size, &possible));
  if (!possible) PetscFunctionReturn(PETSC_SUCCESS);
  if (w->normal.force[0] || w->contact->traits.mean) {
    PetscCall(PetscStrncpy(message, "no pressure on this grid balances the normal loads", size));
    if (isfinite(limit)) PetscCall(PetscStrlcat(message, " within pressure_limit", size));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecSum(SamProblemGetGap(w->contact->problem), &sum));
  PetscCall(
    PetscSNPrintf(message, size,
                  "disp_z = %.8g m brings the mean planes together (limit %.8g, their mean separation): in full "
                  "contact disp_z does not fix the pressure: give load_n",
                  (double)w->normal.rigid[0], (double)sum / ((double)grid->nx * (double)grid->ny)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the pressure of the committed state if nothing that it depends on has changed. */
static PetscErrorCode TakePressure(SamSolve *w)
{
  const SamSolution *from = w->contact->tried.last;

  PetscFunctionBegin;
  PetscCall(SamVecCopyNonzero(from->pressure, w->s->pressure));
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt n = SamComponentsOf[SAM_BALANCE_NORMAL][k];

    w->s->load[n]  = from->load[n];
    w->s->rigid[n] = from->rigid[n];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveGetSeparation(SamSolve *w, Vec *h)
{
  PetscFunctionBegin;
  if (SamContactIsCoupled(w->contact)) PetscCall(VecAXPY(w->h, 1, w->separation));
  if (w->h && !SamContactIsCoupled(w->contact)) PetscCall(VecCopy(w->separation, w->h));
  if (w->h)
    PetscCall(SamProblemDisplace(w->contact->problem, w->contact->state, &w->s->control, w->h, NULL, NULL, NULL));
  if (w->pulled) PetscCall(VecAXPY(w->h, -1, w->pulled));
  *h = w->h ? w->h : w->separation;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Scales a shear, cell by cell, by the change of the pressure from `pressure_before`, so that slipping cells slip on.
*/
static PetscErrorCode FollowPressure(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear)
{
  const PetscInt cells = grid->cells;
  const double  *p0, *p;
  double        *q;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure_before, &p0));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArray(shear, &q));
  for (PetscInt k = 0; k < cells; k++) {
    const double scale = SamIsPressed(p0[k]) ? p[k] / p0[k] : 0;

    q[k] *= scale;
    q[k + cells] *= scale;
  }
  PetscCall(VecRestoreArray(shear, &q));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(VecRestoreArrayRead(pressure_before, &p0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the pressure of this step is known from the same step one cycle before. */
static PetscBool IsKnown(const SamSolve *w)
{
  SamControl before = w->s->control;

  if (!SamCachedStepHasPressure(w->kept, &w->contact->tried.of)) return PETSC_FALSE;
  SamCachedStepGetControl(w->kept, &before);
  return SamControlIsSame(&before, &w->s->control, SAM_BALANCE_NORMAL);
}

/* Solves the normal problem with this separation, and with the tension of its gap. */
static PetscErrorCode SolvePressure(SamSolve *w, Vec h)
{
  PetscFunctionBegin;
  if (!SamSolveIsApart(w)) PetscCall(w->pulled ? SamSolveAttraction(w, h) : SamSolvePressure(w, h));
  if (SamSolveIsApart(w)) PetscCall(SamSolveFailApart(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveNormal(SamSolve *w)
{
  SamTried *const tried = &w->contact->tried;
  Vec             h     = NULL;

  PetscFunctionBegin;
  if (tried->same_pressure) {
    PetscCall(TakePressure(w));
    tried->known_pressure = PETSC_TRUE;
  } else if (IsKnown(w)) {
    PetscCall(SamCachedStepGetPressure(w->kept, w->grid, w->s, &tried->known_pressure));
  } else {
    tried->known_pressure = PETSC_FALSE;
    PetscCall(SamSolveGetSeparation(w, &h));
    PetscCall(SolvePressure(w, h));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveBegun(SamSolve *w)
{
  Vec predicted;

  PetscFunctionBegin;
  if (!w->has_shear) {
    PetscCall(SamSolveNormal(w));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamGridCreateVec(w->grid, 1, &predicted));
  PetscCall(SamVecCopyNonzero(w->s->pressure, predicted));
  PetscCall(SamSolveNormal(w));
  if (!w->contact->tried.known_pressure) PetscCall(FollowPressure(w->grid, predicted, w->s->pressure, w->s->shear));
  PetscCall(VecDestroy(&predicted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the tangential problem ---- */

/*
  Writes the message for gross slip: the tangential loads, and the limit of each in the same proportions. If the bound
  depends on the slip, no limit is given: smaller steps slip differently, and may reach larger loads.
*/
static PetscErrorCode DescribeSliding(SamSolve *w, char message[], size_t size)
{
  const PetscBool          follows = SamProblemFollowsSlip(w->contact->problem);
  const SamSolution *const last    = w->contact->tried.last;
  PetscInt                 loaded  = 0;
  PetscBool                friction;
  char                     instead[64] = "; for gross slip give ";
  const char              *cure;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(message, "gross slip: ", size));
  for (PetscInt k = 0; k < 3; k++) {
    const SamComponent      component = SamComponentsOf[SAM_BALANCE_TANGENTIAL][k];
    const SamComponentName *name      = &SamComponentNames[component];
    const double            load      = (double)w->tangential.load[k];
    char                    text[96];

    if (!w->tangential.force[k] || load == 0) continue;
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s%s = %.8g %s (%s%.8g%s)", loaded++ ? ", " : "", name->load, load,
                            SamUnitOn(w->grid, name->load_unit), follows ? "" : "limit ",
                            (double)SamTangentialGetLimit(w->contact->tangential) * load + 0.0, /* avoids -0 */
                            follows ? " at the slip of the last iteration" : ""));
    PetscCall(PetscStrlcat(message, text, size));
    if (loaded > 1) PetscCall(PetscStrlcat(instead, ", ", sizeof(instead)));
    PetscCall(PetscStrlcat(instead,
                           w->s->rolled != 0 ? name->creep : SamMotionRigidName(w->contact->motion, component).name,
                           sizeof(instead)));
  }
  PetscCall(SamProblemHasFriction(w->contact->problem, &friction));
  if (friction && w->s->load[SAM_COMPONENT_N] == 0) {
    PetscCall(PetscStrlcat(message, " cannot be balanced: the normal force is 0, so friction bears nothing", size));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (w->s->control.together && w->tangential.load[2] != 0 && (!last || last->load[SAM_COMPONENT_N] == 0))
    PetscCall(PetscStrncpy(instead, " while N is small: give a first row of N alone", sizeof(instead)));
  cure = follows && w->contact->motion->continues ? ": use smaller load steps" : instead;
  PetscCall(PetscStrlcat(message, " cannot be balanced ", size));
  PetscCall(PetscStrlcat(message, friction ? "by |q| <= mu p" : "without friction: give a -friction above 0", size));
  if (friction) PetscCall(PetscStrlcat(message, cure, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Smaller residuals at which a solver stagnates are rounding: a smaller tolerance cannot be reached. */
#define ROUNDING 1e-9

/*
  Returns the cure for a tangential problem of finite bodies whose displacements are given. Shear of cells that enter or
  leave slip moves such bodies as wholes by far more than it deforms them, and all other cells with it; where loads are
  given, the projection on them takes these motions out.
*/
static const char *CureOfMotion(SamSolve *w)
{
  const SamBalance *t = &w->tangential;

  return w->contact->traits.patch && !(t->force[0] && t->force[1] && t->force[2])
           ? ": finite bodies that move as wholes are solved by load_tx, load_ty and load_mz, or by petsam-joint"
           : "";
}

/* Writes the message for a solver that has not converged; if rounding is the cause, it names the reachable
   tolerance. */
static PetscErrorCode DescribeFailure(SamSolve *w, SamBalanceKind kind, SamSolver solver, SamSolverReason reason)
{
  const char *const name = kind == SAM_BALANCE_NORMAL ? "normal" : "tangential";
  PetscReal         left, rtol;
  char              message[sizeof(w->step->message)], more[128] = "";

  PetscFunctionBegin;
  PetscCall(SamSolverGetStatistics(solver, &left, NULL, NULL, NULL));
  PetscCall(SamSolverGetTolerances(solver, &rtol, NULL));
  if (reason == SAM_SOLVER_DIVERGED_STAGNATED && left > 0 && left <= ROUNDING) {
    (void)snprintf(more, sizeof(more), ": rounding leaves no less: use a tolerance of %.1g",
                   pow(10, ceil(log10(2 * (double)left)))); /* as the residual omits some rounding */
    PetscCall(PetscSNPrintf(w->step->setting, sizeof(w->step->setting), "%s_rtol", name));
  } else if (kind == SAM_BALANCE_TANGENTIAL)
    PetscCall(PetscStrncpy(more, CureOfMotion(w), sizeof(more)));
  PetscCall(PetscSNPrintf(message, sizeof(message),
                          "the %s problem did not converge: %s, residual %.2g, tolerance %.2g%s", name,
                          SamSolverReasonName(reason), (double)left, (double)rtol, more));
  PetscCall(SamStepFail(w->step, SAM_STATUS_NOT_CONVERGED, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveJudge(SamSolve *w, SamBalanceKind kind)
{
  const PetscBool       normal = kind == SAM_BALANCE_NORMAL;
  const SamSolver       solver = normal ? SamNormalAsSolver(w->solver) : SamTangentialAsSolver(w->contact->tangential);
  const SamSolverReason reason = SamSolverGetReason(solver);
  char                  message[sizeof(w->step->message)];

  PetscFunctionBegin;
  if (reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM) {
    PetscCall((normal ? DescribeImpossible : DescribeSliding)(w, message, sizeof(message)));
    PetscCall(SamStepFail(w->step, SAM_STATUS_NO_EQUILIBRIUM, message));
  } else if (reason < 0) {
    PetscCall(DescribeFailure(w, kind, solver, reason));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a strain of the surfaces to a field of tangential displacements. */
static PetscErrorCode AddStrain(SamGrid grid, const SamStrain *e, Vec field)
{
  double *u;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &u));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscReal y = SamGridY(grid, grid->row_start + j);

    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscReal x = SamGridX(grid, i);
      const ptrdiff_t k = (ptrdiff_t)j * grid->nx + i;

      u[k] += e->xx * x + e->xy * y;
      u[k + grid->cells] += e->xy * x + e->yy * y;
    }
  }
  PetscCall(VecRestoreArray(field, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveCreateOffset(SamSolve *w, Vec *offset)
{
  SamStrain e;
  PetscBool strained;
  double   *slip;

  PetscFunctionBegin;
  *offset = NULL;
  PetscCall(SamProblemDisplace(w->contact->problem, w->contact->state, &w->s->control, NULL, NULL, &e, NULL));
  strained = e.xx != 0 || e.yy != 0 || e.xy != 0;
  if (!w->pushed && !w->before && !strained && !w->s->aside) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(w->grid, 2, offset));
  if (w->before) {
    PetscCall(VecGetArray(*offset, &slip));
    for (PetscInt k = 0; k < 2; k++)
      PetscCall(SamSolutionComputeSlip(w->contact->problem, w->before, k, slip + k * w->grid->cells));
    PetscCall(VecRestoreArray(*offset, &slip));
    PetscCall(VecScale(*offset, -1));
  }
  if (w->pushed) PetscCall(VecAXPY(*offset, 1, w->pushed));
  if (strained) PetscCall(AddStrain(w->grid, &e, *offset));
  if (w->s->aside) PetscCall(VecAXPY(*offset, -1, w->s->aside));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepSetDisplacements(SamContact c)
{
  SamSolution *const tried = &c->generation[SAM_TRIED];

  PetscFunctionBegin;
  PetscCall(SamStateSetField(c->state, c->displacements[0], &tried->displacement_z));
  PetscCall(SamStateSetField(c->state, c->displacements[1], &tried->displacement_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveDisplace(SamSolve *w)
{
  const PetscBool known = w->shear_product.n[0] > 0 ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamStepSetDisplacements(w->contact));
  if (known)
    PetscCall(VecCopy(w->shear_product.field, w->s->displacement_t));
  else
    PetscCall(SamElasticityApplyTangential(w->elasticity, w->s->shear, w->s->displacement_t));
  if (w->pushed) PetscCall(VecAXPY(w->s->displacement_t, 1, w->pushed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves from the shear of the same step one cycle before, put under the bound, if that start is near enough. `solved`:
  true if it was, and the tangential problem is solved.
*/
static PetscErrorCode SolveFromKept(SamSolve *w, SamCachedStep kept, Vec offset, SamBalance *balance, PetscBool *solved)
{
  const SamSolver solver  = SamTangentialAsSolver(w->contact->tangential);
  const SamEffort effort  = solver->effort;
  const PetscReal enough  = solver->enough;
  SamProduct      product = {.rounding = 0};
  Vec             shear;

  PetscFunctionBegin;
  *solved = PETSC_FALSE;
  PetscCall(SamGridCreateVec(w->grid, 2, &product.field));
  PetscCall(SamGridCreateVec(w->grid, 2, &shear));
  PetscCall(SamCachedStepGetShear(kept, w->elasticity, w->before, w->s->bound, shear, &product, solved));
  if (*solved) {
    SamSolverSetEffort(solver, enough, SAM_EFFORT_WARM);
    PetscCall(
      SamTangentialSolveKeeping(w->contact->tangential, w->s->bound, offset, balance, PETSC_TRUE, shear, &product));
    SamSolverSetEffort(solver, enough, effort);
    *solved = SamSolverGetReason(solver) > 0 ? PETSC_TRUE : PETSC_FALSE;
    if (!*solved) PetscCall(SamSolveCount(solver, w->counts + SAM_COUNT_TANGENTIAL));
  }
  if (*solved) PetscCall(SamVecCopyNonzero(shear, w->s->shear));
  if (*solved && w->shear_product.field) {
    PetscCall(VecDestroy(&w->shear_product.field));
    w->shear_product = product;
    product.field    = NULL;
  }
  PetscCall(VecDestroy(&shear));
  PetscCall(VecDestroy(&product.field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveTangential(SamSolve *w)
{
  SamBalance balance = w->tangential, given;
  PetscBool  solved  = PETSC_FALSE;
  Vec        offset;

  PetscFunctionBegin;
  PetscCall(SamSolveCreateOffset(w, &offset));
  for (PetscInt k = 0; k < 3; k++)
    if (balance.force[k]) balance.rigid[k] = w->rigid[k];
  given = balance;
  if (w->kept) PetscCall(SolveFromKept(w, w->kept, offset, &balance, &solved));
  w->kept = NULL; /* later passes start from the last pass */
  if (!solved) {
    balance = given;
    PetscCall(SamTangentialSolveKeeping(w->contact->tangential, w->s->bound, offset, &balance, w->has_shear,
                                        w->s->shear, w->shear_product.field ? &w->shear_product : NULL));
  }
  PetscCall(VecDestroy(&offset));
  w->has_shear = PETSC_TRUE;
  for (PetscInt k = 0; k < 3; k++) w->rigid[k] = balance.rigid[k]; /* of the next pass */
  SamBalanceStore(&balance, w->s->load, w->s->rigid);
  PetscCall(SamSolveCount(SamTangentialAsSolver(w->contact->tangential), w->counts + SAM_COUNT_TANGENTIAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the shear to zero, since the pressure is wrong; displacements that are not given stay as they are. */
PetscErrorCode SamSolveZeroShear(SamSolve *w)
{
  SamBalance balance = w->tangential;

  PetscFunctionBegin;
  PetscCall(SamVecZero(w->s->shear));
  for (PetscInt k = 0; k < 3; k++)
    if (balance.force[k]) balance.rigid[k] = w->rigid[k];
  SamBalanceStore(&balance, w->s->load, w->s->rigid);
  PetscFunctionReturn(PETSC_SUCCESS);
}
