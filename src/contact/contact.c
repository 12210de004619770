/*
  One load step.

  Similar materials: the normal problem does not know the shear, so one pass solves the step. Dissimilar materials:
  pressure moves the surfaces tangentially and shear moves them normally; the two problems are solved in turn, each with
  the displacement that the other's traction causes, until neither traction changes (Panagiotopoulos 1975, Ing.-Arch.
  44, 421).
*/
#include "contactimpl.h"
#include <math.h>

/* The check may see what the solvers' recursions do not: rounding. Its limits are the tolerances with this on top. */
#define CHECK_MARGIN      1.05
#define CHECK_EQUILIBRIUM 1e-10
#define CHECK_CONE        1e-12

/*
  A step is predicted when its change is across the last one's by at most this part, and at most so many times as far.
*/
#define PREDICT_ACROSS   0.3
#define PREDICT_FARTHEST 3.0

static const char *const coupling_words[] = {"none", "full", NULL};

PetscErrorCode SamContactCreate(SamElasticity elasticity, Vec separation, PetscReal friction, SamContact *contact)
{
  SamContact c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  PetscCall(SamElasticityReference(elasticity));
  c->elasticity      = elasticity;
  c->friction        = friction;
  c->coupling        = 1;
  c->warm            = PETSC_TRUE;
  c->coupling_rtol   = 1e-6;
  c->coupling_max_it = 100;
  PetscCall(SamElasticityGetGrid(elasticity, &c->grid));
  PetscCheck(friction >= 0 && isfinite(friction), c->grid->comm, SAM_ERR_USER, "-friction %g: expected a number >= 0",
             (double)friction);
  PetscCall(SamNormalCreate(elasticity, &c->normal));
  PetscCall(SamTangentialCreate(elasticity, &c->tangential));
  PetscCall(PetscObjectReference((PetscObject)separation));
  c->separation = separation;
  PetscCall(SamGridCreateVec(c->grid, 1, &c->fields.pressure));
  PetscCall(SamGridCreateVec(c->grid, 2, &c->fields.shear));
  *contact = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The fields that follow from the tractions exist from the end of a step to the beginning of the next: while the solvers
  work, their memory is the solvers'.
*/
PetscErrorCode SamContactCheckStep(SamContact c, PetscBool same_pressure, Vec slip_before,
                                   const SamBalance *given_normal, const SamBalance *given_tangential, SamStep *step)
{
  PetscFunctionBegin;
  if (c->last_step) {
    PetscCall(SamElasticityRelease(c->elasticity, PETSC_FALSE));
    SamReturnMemory();
  }
  if (!c->fields.displacement_z) PetscCall(SamGridCreateVec(c->grid, 1, &c->fields.displacement_z));
  PetscCall(SamGridCreateVec(c->grid, 2, &c->fields.displacement_t));
  PetscCall(SamCheckDisplacements(c->elasticity, c->coupling ? PETSC_TRUE : PETSC_FALSE, same_pressure, c->last_step,
                                  &c->fields));
  PetscCall(SamGridCreateVec(c->grid, 1, &c->fields.gap));
  PetscCall(SamGridCreateVec(c->grid, 2, &c->fields.slip));
  PetscCall(SamCheckFields(c->elasticity, c->friction, c->separation, slip_before, given_normal, given_tangential, step,
                           &c->fields, &step->check));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactDestroyDerived(SamContact c, PetscBool same_pressure)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&c->fields.slip));
  PetscCall(VecDestroy(&c->fields.gap));
  if (!same_pressure) PetscCall(VecDestroy(&c->fields.displacement_z));
  PetscCall(VecDestroy(&c->fields.displacement_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactDestroy(SamContact *contact)
{
  SamContact c = *contact;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolverDestroy(&c->normal));
  PetscCall(SamSolverDestroy(&c->tangential));
  PetscCall(VecDestroy(&c->separation));
  PetscCall(VecDestroy(&c->slip_before));
  PetscCall(VecDestroy(&c->h));
  PetscCall(VecDestroy(&c->last[0]));
  PetscCall(VecDestroy(&c->last[1]));
  PetscCall(VecDestroy(&c->previous[0]));
  PetscCall(VecDestroy(&c->previous[1]));
  PetscCall(VecDestroy(&c->fields.pressure));
  PetscCall(VecDestroy(&c->fields.shear));
  PetscCall(SamContactDestroyDerived(c, PETSC_FALSE));
  PetscCall(SamElasticityDestroy(&c->elasticity));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetFromOptions(SamContact c)
{
  const SamOptions from = {c->grid->comm, NULL};
  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(&from, "Contact"));
  PetscCall(SamOptionsEnum(&from, "coupling", "normal-tangential coupling of dissimilar materials: full or none",
                           coupling_words, &c->coupling, NULL));
  PetscCall(SamOptionsReal(&from, "coupling_rtol", "relative change of p and q between passes", SAM_RANGE_POSITIVE,
                           &c->coupling_rtol, NULL));
  PetscCall(SamOptionsInt(&from, "coupling_max_it", "most passes", 1, &c->coupling_max_it, NULL));
  PetscCall(SamOptionsBool(&from, "coupling_monitor", "print the change after each pass", &c->coupling_monitor, NULL));
  PetscCall(SamOptionsBool(&from, "warm_start", "start each step from the one before, on the finest grid only",
                           &c->warm, NULL));
  PetscCall(
    SamOptionsBool(&from, "allow_edge_contact", "contact at the grid's edge is a warning", &c->allow_edge, NULL));
  PetscCall(SamOptionsBool(&from, "contact_check", "print the check of each step", &c->print_check, NULL));
  PetscCall(SamSolverSetFromOptions(c->normal));
  PetscCall(SamSolverSetFromOptions(c->tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetNormal(SamContact c, SamNormal *normal)
{
  PetscFunctionBegin;
  *normal = c->normal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetTangential(SamContact c, SamTangential *tangential)
{
  PetscFunctionBegin;
  *tangential = c->tangential;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetLast(SamContact c, PetscBool last)
{
  PetscFunctionBegin;
  c->last_step = last;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetFields(SamContact c, SamFields *fields)
{
  PetscFunctionBegin;
  *fields = c->fields;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds up the counts of the solvers over the passes. */
static PetscErrorCode Count(SamContact c, PetscBool tangential, SamStep *step)
{
  PetscInt its, applies, preconditions;

  PetscFunctionBegin;
  if (tangential) {
    PetscCall(SamSolverGetStatistics(c->tangential, NULL, &its, &applies, &preconditions));
    step->tangential_iterations += its;
    step->tangential_applies += applies;
    step->tangential_preconditions += preconditions;
  } else {
    PetscCall(SamSolverGetStatistics(c->normal, NULL, &its, &applies, &preconditions));
    step->normal_iterations += its;
    step->normal_applies += applies;
    step->normal_preconditions += preconditions;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first failure stays: what comes after it follows from it. */
static PetscErrorCode Fail(SamStep *step, SamStatus status, const char message[])
{
  PetscFunctionBegin;
  if (step->status != SAM_STATUS_CONVERGED) PetscFunctionReturn(PETSC_SUCCESS);
  step->status = status;
  PetscCall(PetscStrncpy(step->message, message, sizeof(step->message)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether two balances prescribe the same. */
static PetscBool SameControl(const SamBalance *a, const SamBalance *b)
{
  for (PetscInt k = 0; k < 3; k++) {
    if (a->force[k] != b->force[k]) return PETSC_FALSE;
    if ((a->force[k] ? a->load[k] : a->rigid[k]) != (b->force[k] ? b->load[k] : b->rigid[k])) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/*
  How far the change to the next step goes on along the one before: the factor alpha, when what is controlled changes
  in nearly the same proportions (component by component, in units of the largest value so far), else 0.
*/
static double Continuation(SamContact c, const double next[6])
{
  double along = 0, old = 0, change = 0, alpha;

  for (PetscInt k = 0; k < 6; k++) {
    const double scale = PetscMax(fabs(next[k]), PetscMax(fabs(c->values[0][k]), fabs(c->values[1][k])));
    const double a     = scale > 0 ? (c->values[0][k] - c->values[1][k]) / scale : 0,
                 b     = scale > 0 ? (next[k] - c->values[0][k]) / scale : 0;

    along += a * b;
    old += a * a;
    change += b * b;
  }
  if (old == 0 || along <= 0) return 0;
  alpha = along / old;
  /* what is left of the change across the old one, relative */
  return (change - alpha * along <= PREDICT_ACROSS * PREDICT_ACROSS * change && alpha <= PREDICT_FARTHEST) ? alpha : 0;
}

/*
  A start for the step: where the loads go on as before, the tractions are extrapolated, and the finest grid alone
  finishes the work in a few iterations. Where they turn, nested grids find the new slip zones faster.
*/
static PetscErrorCode Predict(SamContact c, const SamBalance *normal, const SamBalance *tangential,
                              PetscBool *predicted)
{
  double next[6], alpha = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++) {
    next[k]     = normal->force[k] ? normal->load[k] : normal->rigid[k];
    next[k + 3] = tangential->force[k] ? tangential->load[k] : tangential->rigid[k];
  }
  if (c->steps > 1 && c->warm) alpha = Continuation(c, next);
  *predicted = alpha > 0 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = 0; k < 3; k++) c->start[k] = c->rigid[0][k] + alpha * (c->rigid[0][k] - c->rigid[1][k]);
  if (*predicted)
    PetscCall(SamExtrapolate(c->grid, c->friction, alpha, c->fields.pressure, c->fields.shear, c->previous[0],
                             c->previous[1], predicted));
  else if (c->steps) {
    if (!c->previous[0]) PetscCall(SamGridCreateVec(c->grid, 1, &c->previous[0]));
    if (!c->previous[1]) PetscCall(SamGridCreateVec(c->grid, 2, &c->previous[1]));
    PetscCall(VecCopy(c->fields.pressure, c->previous[0]));
    PetscCall(VecCopy(c->fields.shear, c->previous[1]));
  }
  for (PetscInt k = 0; k < 6; k++) {
    c->values[1][k] = c->values[0][k];
    c->values[0][k] = next[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveNormal(SamContact c, const SamBalance *given, PetscBool guess, PetscBool same_pressure,
                                  SamStep *step)
{
  SamSolverReason reason;
  Vec             h = c->separation, predicted = NULL;
  char            message[sizeof(step->message)];
  PetscBool       possible;

  PetscFunctionBegin;
  if (c->coupled && guess) {
    PetscCall(SamElasticityApplyTangentialToNormal(c->elasticity, c->fields.shear, c->h));
    PetscCall(VecAXPY(c->h, 1, c->separation));
    h = c->h;
  }
  step->normal = *given;
  if (same_pressure) { /* nothing has changed for it */
    step->normal = c->normal_found;
    if (guess) PetscCall(VecCopy(c->previous[0], c->fields.pressure));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (guess) {
    PetscCall(SamGridCreateVec(c->grid, 1, &predicted));
    PetscCall(VecCopy(c->fields.pressure, predicted));
  }
  PetscCall(SamNormalSolve(c->normal, h, &step->normal, guess, c->fields.pressure));
  if (c->last_step && !c->coupled) PetscCall(SamElasticityRelease(c->elasticity, PETSC_FALSE));
  if (guess) PetscCall(SamFollowBound(c->grid, predicted, c->fields.pressure, c->fields.shear));
  PetscCall(VecDestroy(&predicted));
  c->normal_given = *given;
  c->normal_found = step->normal;
  PetscCall(Count(c, PETSC_FALSE, step));
  PetscCall(SamSolverGetReason(c->normal, &reason));
  if (reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM) {
    PetscCall(SamBalanceLever(c->grid, given, message, sizeof(message), &possible));
    if (possible)
      PetscCall(PetscStrncpy(message, "no pressure on this grid balances the normal loads", sizeof(message)));
    PetscCall(Fail(step, SAM_STATUS_NO_EQUILIBRIUM, message));
  } else if (reason < 0) {
    PetscCall(
      PetscSNPrintf(message, sizeof(message), "the normal problem did not converge: %s", SamSolverReasonName(reason)));
    PetscCall(Fail(step, SAM_STATUS_NOT_CONVERGED, message));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says which loads slide, and their limit. */
static PetscErrorCode DescribeSliding(SamContact c, const SamBalance *given, char message[], size_t size)
{
  PetscReal factor;
  PetscInt  loaded = 0;

  PetscFunctionBegin;
  PetscCall(SamTangentialGetLimit(c->tangential, &factor));
  PetscCall(PetscStrncpy(message, "gross slip: ", size));
  for (PetscInt k = 0; k < 3; k++) {
    char text[96];

    if (!given->force[k] || given->load[k] == 0) continue;
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s%s = %.8g %s (limit %.8g)", loaded++ ? ", " : "",
                            SamLoadNames[SAM_BALANCE_TANGENTIAL][k], (double)given->load[k], k == 2 ? "N m" : "N",
                            (double)(factor * given->load[k])));
    PetscCall(PetscStrlcat(message, text, size));
  }
  PetscCall(PetscStrlcat(
    message, c->friction == 0 ? " cannot be balanced without friction" : " cannot be balanced by |q| <= mu p", size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w - S of the tangential problem: u_t from p less the slip so far; NULL for zero. */
static PetscErrorCode CreateOffset(SamContact c, Vec *offset)
{
  PetscFunctionBegin;
  *offset = NULL;
  if (!c->coupled && !c->slip_before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(c->grid, 2, offset));
  if (c->coupled) PetscCall(SamElasticityApplyNormalToTangential(c->elasticity, c->fields.pressure, *offset));
  if (c->slip_before) PetscCall(VecAXPY(*offset, -1, c->slip_before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveTangential(SamContact c, const SamBalance *given, PetscBool guess, SamStep *step)
{
  SamSolverReason reason;
  Vec             offset, bound;
  char            message[sizeof(step->message)];

  PetscFunctionBegin;
  PetscCall(CreateOffset(c, &offset));
  step->tangential = *given;
  for (PetscInt k = 0; k < 3; k++)
    if (given->force[k]) step->tangential.rigid[k] = c->start[k];
  PetscCall(SamGridCreateVec(c->grid, 1, &bound));
  PetscCall(VecAXPY(bound, c->friction, c->fields.pressure));
  PetscCall(SamTangentialSolve(c->tangential, bound, offset, &step->tangential, guess, c->fields.shear));
  PetscCall(VecDestroy(&bound));
  PetscCall(VecDestroy(&offset));
  for (PetscInt k = 0; k < 3; k++) c->start[k] = step->tangential.rigid[k]; /* of the next pass */
  PetscCall(Count(c, PETSC_TRUE, step));
  PetscCall(SamSolverGetReason(c->tangential, &reason));
  if (reason == SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM) {
    PetscCall(DescribeSliding(c, given, message, sizeof(message)));
    PetscCall(Fail(step, SAM_STATUS_NO_EQUILIBRIUM, message));
  } else if (reason < 0) {
    PetscCall(PetscSNPrintf(message, sizeof(message), "the tangential problem did not converge: %s",
                            SamSolverReasonName(reason)));
    PetscCall(Fail(step, SAM_STATUS_NOT_CONVERGED, message));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Relative change of a traction since the pass before, which it then replaces. */
static PetscErrorCode Change(SamGrid grid, Vec now, Vec last, PetscReal *change)
{
  PetscReal norm;

  PetscFunctionBegin;
  PetscCall(VecAYPX(last, -1, now));
  PetscCall(SamGridNorm(grid, last, NORM_2, change));
  PetscCall(SamGridNorm(grid, now, NORM_2, &norm));
  *change = *change > 0 ? *change / norm : 0;
  PetscCall(VecCopy(now, last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Both problems, in turn when they are coupled. */
static PetscErrorCode SolvePasses(SamContact c, const SamBalance *normal, const SamBalance *tangential,
                                  PetscBool predicted, PetscBool same_pressure, SamStep *step)
{
  PetscReal change[2] = {PETSC_INFINITY, PETSC_INFINITY};

  PetscFunctionBegin;
  for (PetscInt pass = 1;; pass++) {
    const PetscBool guess = (pass > 1 || predicted) ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(SolveNormal(c, normal, guess, same_pressure, step));
    if (step->status == SAM_STATUS_CONVERGED) PetscCall(SolveTangential(c, tangential, guess, step));
    step->coupling_iterations = pass;
    if (!c->coupled || c->friction == 0 || step->status != SAM_STATUS_CONVERGED) break;
    PetscCall(Change(c->grid, c->fields.pressure, c->last[0], &change[0]));
    PetscCall(Change(c->grid, c->fields.shear, c->last[1], &change[1]));
    if (c->coupling_monitor)
      PetscCall(PetscPrintf(c->grid->comm, "%5" PetscInt_FMT " coupling change of p %.6e q %.6e\n", pass,
                            (double)change[0], (double)change[1]));
    if (pass > 1 && PetscMax(change[0], change[1]) <= c->coupling_rtol) break;
    if (pass >= c->coupling_max_it) {
      PetscCall(Fail(step, SAM_STATUS_NOT_CONVERGED,
                     "the coupling of normal and tangential problem did not converge within -coupling_max_it passes"));
      break;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Areas of contact and stick, and the work of friction in this step, -sum q.(s - s_before) dA. */
static PetscErrorCode ComputeScalars(SamContact c, SamStep *step)
{
  const PetscInt cells = c->grid->cells, nx = c->grid->nx;
  const double   area      = c->grid->dx * c->grid->dy;
  SamTotal       totals[3] = {{0, 0}};
  double         sums[3];
  const double  *p, *q, *s, *before = NULL;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(c->fields.pressure, &p));
  PetscCall(VecGetArrayRead(c->fields.shear, &q));
  PetscCall(VecGetArrayRead(c->fields.slip, &s));
  if (c->slip_before) PetscCall(VecGetArrayRead(c->slip_before, &before));
  for (PetscInt first = 0; first < cells; first += nx) {
    double row[3] = {0, 0, 0};

    for (PetscInt k = first; k < first + nx; k++) {
      const PetscInt l     = k + cells;
      const SamState state = SamStateOf(p[k], q[k], q[l], c->friction);

      if (state == SAM_STATE_OPEN) continue;
      row[0] += 1;
      row[1] += state == SAM_STATE_STICK ? 1 : 0;
      row[2] -= q[k] * (s[k] - (before ? before[k] : 0)) + q[l] * (s[l] - (before ? before[l] : 0));
    }
    SamAddAll(3, totals, row);
  }
  if (c->slip_before) PetscCall(VecRestoreArrayRead(c->slip_before, &before));
  PetscCall(VecRestoreArrayRead(c->fields.slip, &s));
  PetscCall(VecRestoreArrayRead(c->fields.shear, &q));
  PetscCall(VecRestoreArrayRead(c->fields.pressure, &p));
  PetscCall(SamSumTotals(c->grid->comm, 3, totals, sums));
  step->contact_area      = sums[0] * area;
  step->stick_area        = sums[1] * area;
  step->dissipated_energy = sums[2] * area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns what the check found into the step's status. */
static PetscErrorCode Judge(SamContact c, SamStep *step)
{
  const SamCheck *check = &step->check;
  PetscReal       normal_rtol, tangential_rtol;
  char            message[sizeof(step->message)];

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(c->normal, &normal_rtol, NULL));
  PetscCall(SamSolverGetTolerances(c->tangential, &tangential_rtol, NULL));
  if (c->coupled) normal_rtol += c->coupling_rtol; /* the last shear is one pass younger than the pressure */
  if (c->print_check)
    PetscCall(PetscPrintf(c->grid->comm,
                          "      check: normal %.3e tangential %.3e equilibrium %.3e cone %.3e edge pressure %.3e\n",
                          (double)check->normal, (double)check->tangential, (double)check->equilibrium,
                          (double)check->cone, (double)check->edge));
  if (!(check->normal <= CHECK_MARGIN * normal_rtol && check->tangential <= CHECK_MARGIN * tangential_rtol &&
        check->equilibrium <= CHECK_EQUILIBRIUM && check->cone <= CHECK_CONE)) {
    PetscCall(PetscSNPrintf(
      message, sizeof(message), "the check disagrees: normal residual %g, tangential %g, equilibrium %g, cone %g",
      (double)check->normal, (double)check->tangential, (double)check->equilibrium, (double)check->cone));
    PetscCall(Fail(step, SAM_STATUS_NOT_CONVERGED, message));
  }
  if (check->edge > 0) {
    PetscCall(PetscSNPrintf(message, sizeof(message),
                            "the contact reached the edge of the grid (pressure there up to %.2g of the largest): the "
                            "answer depends on -grid_size",
                            (double)check->edge));
    if (!c->allow_edge)
      PetscCall(Fail(step, SAM_STATUS_EDGE_CONTACT, message));
    else if (!step->message[0])
      PetscCall(PetscStrncpy(step->message, message, sizeof(step->message)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSolve(SamContact c, SamStep *step)
{
  const SamBalance normal = step->normal, tangential = step->tangential;
  const SamBalance given = c->normal_given, found = c->normal_found;
  const PetscReal  time = step->time;
  PetscBool        predicted, same_pressure;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(step, sizeof(*step)));
  step->time       = time;
  step->normal     = normal;
  step->tangential = tangential;
  PetscCall(SamElasticityIsCoupled(c->elasticity, &c->coupled));
  if (!c->coupling) c->coupled = PETSC_FALSE;
  if (c->coupled && !c->h) {
    PetscCall(SamGridCreateVec(c->grid, 1, &c->h));
    PetscCall(SamGridCreateVec(c->grid, 1, &c->last[0]));
    PetscCall(SamGridCreateVec(c->grid, 2, &c->last[1]));
  }
  /* the slip at the end of the last step becomes the reference of this one */
  if (c->fields.slip) {
    PetscCall(VecDestroy(&c->slip_before));
    c->slip_before = c->fields.slip;
    c->fields.slip = NULL;
  }
  same_pressure = (!c->coupled && c->steps && SameControl(&normal, &c->normal_given)) ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SamContactDestroyDerived(c, same_pressure));
  PetscCall(Predict(c, &normal, &tangential, &predicted));
  PetscCall(SolvePasses(c, &normal, &tangential, predicted, same_pressure, step));
  if (step->status == SAM_STATUS_NO_EQUILIBRIUM) { /* there is no solution to check */
    PetscCall(SamContactStepBack(c, &given, &found, same_pressure));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactCheckStep(c, same_pressure, c->slip_before, &normal, &tangential, step));
  PetscCall(ComputeScalars(c, step));
  PetscCall(Judge(c, step));
  for (PetscInt k = 0; k < 3; k++) {
    c->rigid[1][k] = c->rigid[0][k];
    c->rigid[0][k] = step->tangential.rigid[k];
  }
  c->steps++;
  PetscFunctionReturn(PETSC_SUCCESS);
}
