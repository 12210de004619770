/*
  The solution of one load step: what all laws add to the separation and their limits, the normal problem and its
  corrections, the bound of the shear, the tangential problem. Then contact.c has the solution checked, and lets the
  laws advance their tried state.

  Similar materials: the pressure does not depend on the shear, so the normal and then the tangential problem solve the
  step. Dissimilar materials: see coupling.c.
*/
#include "stepimpl.h"
#include <math.h>

static PetscErrorCode Begin(SamContact c, const SamStepStart *start, PetscBool same_pressure, SamStep *step,
                            SamSolve *w)
{
  PetscFunctionBegin;
  *w = (SamSolve){
    .c = c, .s = &c->generation[SAM_TRIED], .step = step, .same_pressure = same_pressure, .kept = start->kept};
  w->coupled    = SamContactIsCoupled(c);
  w->before     = SamContactSlipBefore(c);
  w->counts     = SamStateNumbers(c->state, c->counts, SAM_TRIED);
  w->normal     = SamControlGetBalance(&w->s->control, SAM_BALANCE_NORMAL);
  w->tangential = SamControlGetBalance(&w->s->control, SAM_BALANCE_TANGENTIAL);
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt n = SamComponentsOf[SAM_BALANCE_TANGENTIAL][k];

    if (w->s->control.creep[n] && !c->traits.steady)
      w->tangential.rigid[k] =
        (w->before ? w->before->rigid[n] : 0) + SamControlRolled(&w->s->control) * w->s->control.value[n];
  }
  PetscCall(PetscArraycpy(w->rigid, start->rigid, 3));
  PetscCall(SamSolutionCreateSeparation(c->problem, c->state, SAM_COMMITTED, &w->separation));
  if (w->coupled || w->s->mid_step) PetscCall(SamGridCreateVec(c->grid, 2, &w->shear_product.field));
  if (!w->coupled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(c->grid, 1, &w->h));
  PetscCall(SamGridCreateVec(c->grid, 1, &w->lift));
  PetscCall(SamGridCreateVec(c->grid, 2, &w->pushed));
  PetscCall(SamGridCreateVec(c->grid, 1, &w->pressure_product.field));
  PetscCall(SamGridCreateVec(c->grid, 1, &w->previous_pressure));
  PetscCall(SamGridCreateVec(c->grid, 2, &w->previous_shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode End(SamSolve *w)
{
  PetscFunctionBegin;
  PetscCall(SamSolutionDestroySeparation(w->c->problem, &w->separation));
  PetscCall(VecDestroy(&w->turn));
  PetscCall(VecDestroy(&w->slip));
  PetscCall(VecDestroy(&w->pushed));
  PetscCall(VecDestroy(&w->lift));
  PetscCall(VecDestroy(&w->h));
  PetscCall(VecDestroy(&w->pressure_product.field));
  PetscCall(VecDestroy(&w->shear_product.field));
  PetscCall(VecDestroy(&w->previous_pressure));
  PetscCall(VecDestroy(&w->previous_shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the counts of a solver's last solve to three numbers of the step. */
static PetscErrorCode Count(SamSolver solver, double counts[3])
{
  PetscInt last[3];

  PetscFunctionBegin;
  PetscCall(SamSolverGetStatistics(solver, NULL, &last[0], &last[1], &last[2]));
  for (int k = 0; k < 3; k++) counts[k] += (double)last[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the normal problem ---- */

/* The message for loads that no pressure balances, or for an approach that is too large, with the limit. */
static PetscErrorCode DescribeImpossible(SamSolve *w, char message[], size_t size)
{
  const SamGrid grid = w->c->grid;
  PetscBool     possible;
  PetscReal     sum, limit;
  Vec           h;

  PetscFunctionBegin;
  PetscCall(SamProblemGetPressureLimit(w->c->problem, &limit));
  PetscCall(SamBalanceLever(grid, &w->normal, message, size, &possible));
  if (possible) PetscCall(SamBalanceCapacity(grid, &w->normal, limit, message, size, &possible));
  if (!possible) PetscFunctionReturn(PETSC_SUCCESS);
  if (w->normal.force[0] || w->c->traits.mean) {
    PetscCall(PetscStrncpy(message, "no pressure on this grid balances the normal loads", size));
    if (isfinite(limit)) PetscCall(PetscStrlcat(message, " within pressure_limit", size));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamProblemGetGap(w->c->problem, &h));
  PetscCall(VecSum(h, &sum));
  PetscCall(
    PetscSNPrintf(message, size,
                  "disp_z = %.8g m brings the mean planes together (limit %.8g, their mean separation): in full "
                  "contact disp_z does not fix the pressure: give load_n",
                  (double)w->normal.rigid[0], (double)sum / ((double)grid->nx * (double)grid->ny)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the pressure of the committed state, where nothing that it depends on has changed. */
static PetscErrorCode TakePressure(SamSolve *w)
{
  const SamSolution *from = SamContactBefore(w->c);

  PetscFunctionBegin;
  PetscCall(SamVecCopyNonzero(from->pressure, w->s->pressure));
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt n = SamComponentsOf[SAM_BALANCE_NORMAL][k];

    w->s->load[n]  = from->load[n];
    w->s->rigid[n] = from->rigid[n];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The separation for the normal problem: that of the bodies, plus the lift, which w->h holds, of coupled ones. */
static PetscErrorCode GetSeparation(SamSolve *w, Vec *h)
{
  PetscFunctionBegin;
  if (w->coupled) PetscCall(VecAXPY(w->h, 1, w->separation));
  if (w->coupled) PetscCall(SamElasticityAddCases(w->c->elasticity, &w->s->control, PETSC_FALSE, w->h));
  *h = w->coupled ? w->h : w->separation;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveNormal(SamSolve *w, PetscBool has_pressure, PetscBool has_shear)
{
  SamBalance balance   = w->normal;
  Vec        predicted = NULL, h = NULL;

  PetscFunctionBegin;
  if (w->same_pressure) {
    PetscCall(TakePressure(w));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (SamKeptHasPressure(w->kept, &w->s->control, w->c->revision[SAM_TRIED])) {
    PetscCall(SamKeptGetPressure(w->kept, w->c->grid, w->s));
    w->known_pressure = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(GetSeparation(w, &h));
  if (has_shear) {
    PetscCall(SamGridCreateVec(w->c->grid, 1, &predicted));
    PetscCall(SamVecCopyNonzero(w->s->pressure, predicted));
  }
  for (PetscInt k = 0; k < 3; k++)
    if (balance.force[k]) balance.rigid[k] = w->s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][k]]; /* of the last pass */
  PetscCall(SamNormalSolveKeeping(w->c->normal, h, &balance, has_pressure, w->s->pressure,
                                  w->coupled ? &w->pressure_product : NULL));
  if (has_shear) PetscCall(SamFollowPressure(w->c->grid, predicted, w->s->pressure, w->s->shear));
  PetscCall(VecDestroy(&predicted));
  SamBalanceStore(&balance, w->s->load, w->s->rigid);
  PetscCall(Count(SamNormalAsSolver(w->c->normal), w->counts + SAM_COUNT_NORMAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the tangential problem ---- */

/*
  The message for gross slip: the tangential loads, and the limit of each in the same proportions. Under a bound that
  follows the slip that is no limit: smaller steps slip otherwise, and may reach more.
*/
static PetscErrorCode DescribeSliding(SamSolve *w, char message[], size_t size)
{
  const PetscBool follows = SamProblemFollowsSlip(w->c->problem);
  PetscReal       factor;
  PetscInt        loaded = 0;
  PetscBool       friction;
  char            instead[64] = "; for gross slip give ";

  PetscFunctionBegin;
  PetscCall(SamTangentialGetLimit(w->c->tangential, &factor));
  PetscCall(PetscStrncpy(message, "gross slip: ", size));
  for (PetscInt k = 0; k < 3; k++) {
    const SamComponentName *name = &SamComponentNames[SamComponentsOf[SAM_BALANCE_TANGENTIAL][k]];
    const double            load = (double)w->tangential.load[k];
    char                    text[96];

    if (!w->tangential.force[k] || load == 0) continue;
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s%s = %.8g %s (%s%.8g%s)", loaded++ ? ", " : "", name->load, load,
                            SamUnitOn(w->c->grid, name->load_unit), follows ? "" : "limit ",
                            (double)factor * load + 0.0, /* and not -0 */
                            follows ? " at the slip of the last iteration" : ""));
    PetscCall(PetscStrlcat(message, text, size));
    if (loaded > 1) PetscCall(PetscStrlcat(instead, ", ", sizeof(instead)));
    PetscCall(PetscStrlcat(instead, w->c->traits.steady || w->c->rolls ? name->creep : name->rigid, sizeof(instead)));
  }
  PetscCall(SamProblemHasFriction(w->c->problem, &friction));
  PetscCall(PetscStrlcat(
    message, friction ? " cannot be balanced by |q| <= mu p" : " cannot be balanced without friction", size));
  PetscCall(PetscStrlcat(message, follows && !w->c->traits.steady ? ": use smaller load steps" : instead, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Residuals up to this, where a solver stagnates, are rounding: less tolerance than that cannot be had. */
#define ROUNDING 1e-9

/* The message for a solver that has not converged; what is rounding names the tolerance that can be had. */
static PetscErrorCode DescribeFailure(SamSolve *w, const char name[], SamSolver solver, SamSolverReason reason)
{
  PetscReal left, rtol;
  char      message[sizeof(w->step->message)], more[128] = "";

  PetscFunctionBegin;
  PetscCall(SamSolverGetStatistics(solver, &left, NULL, NULL, NULL));
  PetscCall(SamSolverGetTolerances(solver, &rtol, NULL));
  if (reason == SAM_SOLVER_DIVERGED_STAGNATED && left > 0 && left <= ROUNDING) {
    (void)snprintf(more, sizeof(more), ": rounding leaves no less: use a tolerance of %.1g",
                   pow(10, ceil(log10(2 * (double)left)))); /* the residual omits some rounding */
    PetscCall(PetscSNPrintf(w->step->setting, sizeof(w->step->setting), "%s_rtol", name));
  }
  PetscCall(PetscSNPrintf(message, sizeof(message),
                          "the %s problem did not converge: %s, residual %.2g, tolerance %.2g%s", name,
                          SamSolverReasonName(reason), (double)left, (double)rtol, more));
  PetscCall(SamStepFail(w->step, SAM_STATUS_NOT_CONVERGED, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveJudge(SamSolve *w, SamBalanceKind kind)
{
  const PetscBool normal = kind == SAM_BALANCE_NORMAL;
  const SamSolver solver = normal ? SamNormalAsSolver(w->c->normal) : SamTangentialAsSolver(w->c->tangential);
  SamSolverReason reason;
  char            message[sizeof(w->step->message)];

  PetscFunctionBegin;
  PetscCall(SamSolverGetReason(solver, &reason));
  if (reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM) {
    PetscCall((normal ? DescribeImpossible : DescribeSliding)(w, message, sizeof(message)));
    PetscCall(SamStepFail(w->step, SAM_STATUS_NO_EQUILIBRIUM, message));
  } else if (reason < 0) {
    PetscCall(DescribeFailure(w, normal ? "normal" : "tangential", solver, reason));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the stretch of the surfaces by bulk stress to a field of tangential displacements. */
static PetscErrorCode AddStretch(SamGrid grid, const SamStretch *e, Vec field)
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

/* w - S of the tangential problem: what moves the surfaces besides the shear, less the slip so far; NULL for zero. */
static PetscErrorCode CreateOffset(SamSolve *w, Vec *offset)
{
  const SamContact c = w->c;
  const SamPair   *pair;
  SamStretch       e;
  PetscBool        stretched;
  double          *slip;

  PetscFunctionBegin;
  *offset = NULL;
  PetscCall(SamElasticityGetPair(c->elasticity, &pair));
  e         = SamStretchOf(pair, &w->s->control);
  stretched = e.xx != 0 || e.yy != 0 || e.xy != 0;
  if (!w->coupled && !w->before && !stretched) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(c->grid, 2, offset));
  if (w->before) {
    PetscCall(VecGetArray(*offset, &slip));
    for (PetscInt k = 0; k < 2; k++)
      PetscCall(SamSolutionComputeSlip(c->problem, w->before, k, slip + k * c->grid->cells));
    PetscCall(VecRestoreArray(*offset, &slip));
    PetscCall(VecScale(*offset, -1));
  }
  if (w->coupled) PetscCall(VecAXPY(*offset, 1, w->pushed));
  if (stretched) PetscCall(AddStretch(c->grid, &e, *offset));
  if (w->turn) PetscCall(VecAXPY(*offset, -1, w->turn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  From the same step one cycle before: the shear under the bound, if that start is near. `solved`: it was, and the
  tangential problem is.
*/
static PetscErrorCode SolveFromKept(SamSolve *w, SamKept kept, Vec offset, SamBalance *balance, PetscBool *solved)
{
  const SamContact c       = w->c;
  SamProduct       product = {.rounding = 0};
  SamSolverReason  reason;
  Vec              shear;

  PetscFunctionBegin;
  *solved = PETSC_FALSE;
  PetscCall(SamGridCreateVec(c->grid, 2, &product.field));
  PetscCall(SamGridCreateVec(c->grid, 2, &shear));
  PetscCall(SamKeptGetShear(kept, c->elasticity, w->before, w->s->bound, shear, &product, solved));
  if (*solved) {
    if (w->s->mid_step) PetscCall(SamSolveGuessDirection(w, kept, shear, &product, offset));
    SamSolverSetEffort(SamTangentialAsSolver(c->tangential), 0, SAM_EFFORT_NEAR);
    PetscCall(SamTangentialSolveKeeping(c->tangential, w->s->bound, offset, balance, PETSC_TRUE, shear, &product));
    SamSolverSetEffort(SamTangentialAsSolver(c->tangential), 0, SAM_EFFORT_FULL);
    PetscCall(SamSolverGetReason(SamTangentialAsSolver(c->tangential), &reason));
    *solved = reason > 0 ? PETSC_TRUE : PETSC_FALSE;
    if (!*solved) PetscCall(Count(SamTangentialAsSolver(c->tangential), w->counts + SAM_COUNT_TANGENTIAL));
  }
  if (*solved) PetscCall(SamVecCopyNonzero(shear, w->s->shear));
  if (*solved && w->s->mid_step) {
    PetscCall(VecDestroy(&w->shear_product.field));
    w->shear_product = product;
    product.field    = NULL;
  }
  PetscCall(VecDestroy(&shear));
  PetscCall(VecDestroy(&product.field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveTangential(SamSolve *w, PetscBool has_shear)
{
  SamBalance balance = w->tangential, given;
  PetscBool  solved  = PETSC_FALSE;
  Vec        offset;

  PetscFunctionBegin;
  PetscCall(CreateOffset(w, &offset));
  for (PetscInt k = 0; k < 3; k++)
    if (balance.force[k]) balance.rigid[k] = w->rigid[k];
  given = balance;
  if (w->kept) PetscCall(SolveFromKept(w, w->kept, offset, &balance, &solved));
  w->kept = NULL; /* later passes start from the last one */
  if (!solved) {
    balance = given;
    PetscCall(SamTangentialSolveKeeping(w->c->tangential, w->s->bound, offset, &balance, has_shear, w->s->shear,
                                        w->shear_product.field ? &w->shear_product : NULL));
  }
  PetscCall(VecDestroy(&offset));
  for (PetscInt k = 0; k < 3; k++) w->rigid[k] = balance.rigid[k]; /* of the next pass */
  SamBalanceStore(&balance, w->s->load, w->s->rigid);
  PetscCall(Count(SamTangentialAsSolver(w->c->tangential), w->counts + SAM_COUNT_TANGENTIAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pressure is not right, so that no shear is sought: there is none, and displacements that are not given stay. */
PetscErrorCode SamSolveSkipTangential(SamSolve *w)
{
  SamBalance balance = w->tangential;

  PetscFunctionBegin;
  PetscCall(SamVecZero(w->s->shear));
  for (PetscInt k = 0; k < 3; k++)
    if (balance.force[k]) balance.rigid[k] = w->rigid[k];
  SamBalanceStore(&balance, w->s->load, w->s->rigid);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- both ---- */

/* The bound, and the tangential problem with it, unless the normal one has failed. */
static PetscErrorCode SolveShear(SamSolve *w, PetscBool has_shear)
{
  PetscReal rtol;

  PetscFunctionBegin;
  PetscCall(SamSolveBound(w, w->s->bound));
  w->counts[SAM_COUNT_COUPLING] = 1;
  if (w->step->status != SAM_STATUS_CONVERGED) {
    PetscCall(SamSolveSkipTangential(w));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamSolverGetTolerances(SamTangentialAsSolver(w->c->tangential), &rtol, NULL));
  PetscCall(SamSolveShear(w, has_shear, rtol, SAM_EFFORT_FULL));
  PetscCall(SamSolveJudge(w, SAM_BALANCE_TANGENTIAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveOnce(SamSolve *w, const SamStepStart *start)
{
  PetscFunctionBegin;
  if (w->coupled) PetscCall(VecSet(w->h, 0));
  PetscCall(SamSolveNormal(w, start->pressure, start->shear));
  if (!w->same_pressure && !w->known_pressure) PetscCall(SamSolveJudge(w, SAM_BALANCE_NORMAL));
  PetscCall(SolveShear(w, start->shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSolveStep(SamContact c, const SamStepStart *start, PetscBool same_pressure, SamStep *step)
{
  SamSolve  w;
  PetscBool friction;

  PetscFunctionBegin;
  PetscCall(Begin(c, start, same_pressure, step, &w));
  PetscCall(SamProblemHasFriction(c->problem, &friction));
  if (w.coupled && friction)
    PetscCall(SamSolveCoupled(&w, start));
  else
    PetscCall(SolveOnce(&w, start));
  if (c->traits.steady) PetscCall(SamSolveRolling(&w));
  PetscCall(End(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}
