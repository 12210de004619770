/* Steps of a contact: they are tried, then committed or rejected. */
#include "contactimpl.h"
#include <math.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/solverimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/check.h>
#include <petsam/private/normal.h>
#include <petsam/private/problem.h>
#include <petsam/private/solver.h>

/*
  The check includes rounding, which the solvers' recurrences omit. So its limits are the solvers' tolerances times a
  margin. If the displacement nearly vanishes, as in full contact when all waves are worn off, rounding of the gap may
  be as large as the tolerance. The check adds rounding of its own to that of the solver, so its limit is the sum.
  Equilibrium and cone have separate limits, since solvers fulfil them to rounding. A bound that depends on the slip is
  as accurate as the slip.
*/
#define CHECK_MARGIN      1.05
#define CHECK_EQUILIBRIUM 1e-10
#define CHECK_CONE        1e-12

/* ---- a step ---- */

/* Replaces the message if only cells beyond the border of a body's surface came into contact. */
static PetscErrorCode DescribeBeyond(SamContact c, SamStep *step)
{
  const PetscInt cells[2] = {c->grid->nx, c->grid->ny};
  PetscReal      way[2][2];
  PetscInt       first[2], n[2], body = 0;
  char           place[64];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++)
    if (SamProblemGetOffset(c->problem, c->state, SAM_TRIED, k, way[k]) &&
        (k == 0 || hypot(way[1][0], way[1][1]) >= hypot(way[0][0], way[0][1])))
      body = k + 1;
  if (body == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridGetSupport(c->grid, c->generation[SAM_TRIED].pressure, PETSC_FALSE, first, n));
  for (PetscInt k = 0; k < c->grid->axes; k++)
    if (first[k] == 0 || first[k] + n[k] == cells[k]) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(step->message, sizeof(step->message),
                 "the contact %s over the border of the surface that body %d has on the grid (%s), %s = %.6g, %.6g m: "
                 "the grid must hold contact and %s",
                 SamContactRolls(c) ? "rolled" : "slid", (int)body,
                 SamCheckDescribeEdge(&step->check, place, sizeof(place)),
                 SamContactRolls(c) ? "offset along x, y" : "slide_x, slide_y", (double)way[body - 1][0],
                 (double)way[body - 1][1], SamContactRolls(c) ? "path" : "stroke");
  (void)snprintf(step->setting, sizeof(step->setting), "%s", SamContactRolls(c) ? "" : "slide");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces the message by one about the rolled distance if only material from outside of the grid came into contact. */
static PetscErrorCode DescribeEntering(SamContact c, SamStep *step)
{
  const PetscInt   cells[2] = {c->grid->nx, c->grid->ny};
  const PetscReal  size[2]  = {c->grid->dx, c->grid->dy};
  const PetscReal *roll     = c->generation[SAM_TRIED].roll;
  PetscInt         first[2], n[2];
  char             place[64];

  PetscFunctionBegin;
  PetscCall(SamGridGetSupport(c->grid, c->generation[SAM_TRIED].pressure, PETSC_FALSE, first, n));
  for (PetscInt k = 0; k < 2; k++)
    if (first[k] == 0 || first[k] + n[k] == cells[k]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; k++) { /* interpolation between cells needs one more */
    const PetscReal most = size[k] * (PetscReal)((roll[k] > 0 ? cells[k] - first[k] - n[k] : first[k]) - 1);

    if (fabs(roll[k]) <= most) continue;
    (void)snprintf(step->message, sizeof(step->message),
                   "the contact reached material from outside of the grid, whose displacement is unknown (%s): %s = "
                   "%.8g: at most %.8g m in a step: use more steps or a wider grid",
                   SamCheckDescribeEdge(&step->check, place, sizeof(place)), k ? "roll_y" : "roll", (double)roll[k],
                   (double)most);
    (void)snprintf(step->setting, sizeof(step->setting), "steps");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Judge(SamContact c, SamStep *step)
{
  const SamCheck *check  = &step->check;
  SamCheckLimits  limits = {.equilibrium = CHECK_EQUILIBRIUM, .cone = CHECK_CONE, .edge = c->set.allow_edge};
  char            place[64];

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(SamNormalAsSolver(c->normal), &limits.normal, NULL));
  PetscCall(SamSolverGetTolerances(SamTangentialAsSolver(c->tangential), &limits.tangential, NULL));
  limits.normal = CHECK_MARGIN * PetscMax(limits.normal, check->rounding) + check->rounding;
  limits.tangential *= CHECK_MARGIN;
  if (SamProblemFollowsSlip(c->problem)) limits.cone = limits.tangential;
  if (c->set.print_check)
    PetscCall(PetscPrintf(c->grid->comm,
                          "      check: normal %.3e tangential %.3e equilibrium %.3e cone %.3e edge pressure %.3e\n",
                          (double)check->normal, (double)check->tangential, (double)check->equilibrium,
                          (double)check->cone, (double)check->edge));
  PetscCall(SamStepJudge(step, &limits));
  if (SamContactRolls(c) && check->edge > 0 && SamStepIsSolved(step)) PetscCall(DescribeEntering(c, step));
  if (check->edge > 0 && SamStepIsSolved(step)) PetscCall(DescribeBeyond(c, step));
  if (c->traits.patch && check->edge > 0 && SamStepIsSolved(step)) {
    (void)snprintf(step->message, sizeof(step->message),
                   "the contact reached the border of the patch of a body's compliance, or of the grid (%s): use a "
                   "larger grid, up to the patch, then a larger patch",
                   SamCheckDescribeEdge(check, place, sizeof(place)));
    step->setting[0] = '\0';
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetUp(SamContact c)
{
  const SamLaw *laws;
  PetscInt      count;
  PetscReal     limit;
  PetscBool     friction;

  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  PetscCall(SamProblemHasFriction(c->problem, &friction));
  PetscCall(SamProblemGetPressureLimit(c->problem, &limit));
  PetscCall(SamProblemGetLaws(c->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    if (!laws[k]->any_motion)
      PetscCall(SamMotionRefuse(c->motion, SAM_MOTION_HISTORY, c->grid->comm,
                                laws[k]->named || laws[k]->option ? "-" : "", SamLawOption(laws[k])));
  PetscCheck(SamTangentialAsSolver(c->tangential)->upwind == c->traits.upwind, c->grid->comm, SAM_ERR_USER,
             "-tangential_type: does not solve this problem: use %s",
             c->traits.upwind ? SAM_TANGENTIAL_ROLLING : SAM_TANGENTIAL_NEWTON);
  for (PetscInt k = 0; k < count; k++)
    for (PetscInt j = 0; laws[k]->ops.follow && j < count; j++)
      PetscCheck((!laws[j]->ops.separation || !laws[j]->ops.limit) && (!laws[j]->ops.follow || j == k), c->grid->comm,
                 SAM_ERR_USER, "-%s: not supported with -%s", SamLawOption(laws[k]), SamLawOption(laws[j]));
  PetscCheck(
    !friction || !c->traits.slides, c->grid->comm, SAM_ERR_USER,
    "-friction: not supported with bodies that relax and slide at -body1_speed or -body2_speed: omit it; it adds "
    "the coefficient times load_n to their resistance");
  PetscCheck(isinf(limit) || SamNormalLimitsPressure(c->normal), c->grid->comm, SAM_ERR_USER,
             "-pressure_limit: not supported by this -normal_type: use %s", SAM_NORMAL_ACTIVESET);
  PetscCall(SamNormalSetPressureLimit(c->normal, limit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the elasticity use the committed state's part of the grid again: a rejected try must leave no trace. */
static PetscErrorCode RestoreWindow(SamContact c)
{
  const double  *window   = SamStateNumbers(c->state, c->window, SAM_COMMITTED);
  const PetscInt first[2] = {(PetscInt)window[0], (PetscInt)window[1]},
                 n[2]     = {(PetscInt)window[2], (PetscInt)window[3]};

  PetscFunctionBegin;
  PetscCall(SamElasticitySetPart(c->elasticity, first, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes the part of the grid on which the tried step was solved. */
static PetscErrorCode NoteWindow(SamContact c)
{
  double  *window = SamStateNumbers(c->state, c->window, SAM_TRIED);
  PetscInt first[2], n[2];

  PetscFunctionBegin;
  PetscCall(SamElasticityGetPartPlace(c->elasticity, first, n));
  for (int k = 0; k < 2; k++) {
    window[k]     = (double)first[k];
    window[k + 2] = (double)n[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactIsGapCurrent(SamContact c, PetscBool *current)
{
  PetscObjectState revision;
  double           changed;

  PetscFunctionBegin;
  PetscCall(SamProblemGetRevision(c->problem, &revision));
  changed = c->revision[SAM_COMMITTED] == revision ? 0 : 1;
  PetscCall(SamMax(c->grid->comm, 1, &changed)); /* each rank counts the changes of its own part */
  *current = changed == 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Finds out whether the tried step has the committed pressure: same normal control, same separation, and no shear that
  acts on it. Yielding of the surfaces under this pressure does not matter (laws/hardness.c).
*/
static PetscErrorCode ComparePressure(SamContact c)
{
  SamTried *const    tried = &c->tried;
  const SamSolution *now   = &c->generation[SAM_TRIED];
  PetscBool          moves;
  PetscReal          slide[2], last[2];

  PetscFunctionBegin;
  (void)SamProblemGetOffset(c->problem, c->state, SAM_TRIED, 1, slide);
  (void)SamProblemGetOffset(c->problem, c->state, SAM_COMMITTED, 1, last);
  PetscCall(SamContactIsGapCurrent(c, &tried->same_gap));
  PetscCall(SamProblemAddSeparation(c->problem, c->state, SAM_COMMITTED, NULL, &moves));
  tried->same_pressure = !SamContactIsCoupled(c) && tried->last && tried->same_gap && !(SamContactRolls(c) && moves) &&
                         slide[0] == last[0] && slide[1] == last[1] &&
                         SamControlIsSame(&tried->last->control, &now->control, SAM_BALANCE_NORMAL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Restores the committed solution to its place before the grid moved for a tried step. */
static PetscErrorCode MoveBack(SamContact c)
{
  PetscFunctionBegin;
  if (SamContactRolls(c)) PetscCall(SamContactRefresh(c));
  c->generation[SAM_TRIED].rolled = 0;
  PetscCall(RestoreWindow(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- laws ---- */

PetscErrorCode SamContactComputeFriction(SamContact c, Vec path, Vec pressed, Vec work)
{
  PetscFunctionBegin;
  PetscCheck(c->has_tried, c->grid->comm, PETSC_ERR_ORDER, "There is no tried step");
  PetscCall(SamSolutionComputeFriction(c->problem, c->tried.before, &c->generation[SAM_TRIED], path, pressed, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the gap of the tried solution between the surfaces as they were before the step. */
static PetscErrorCode ComputeGap(SamContact c, Vec gap)
{
  Vec h;

  PetscFunctionBegin;
  PetscCall(SamSolutionCreateSeparation(c->problem, c->state, SAM_COMMITTED, &h));
  PetscCall(
    SamSolutionComputeGap(c->problem, &c->generation[SAM_TRIED], c->generation[SAM_TRIED].displacement_z, h, gap));
  PetscCall(SamSolutionDestroySeparation(c->problem, &h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the fields of the step that laws use. */
static PetscErrorCode CreateFields(SamContact c, SamLawStep *step)
{
  SamBoundAt    at = {c->state, step->control, step->pressure, NULL, step->rolled};
  const SamLaw *laws;
  PetscInt      count;
  PetscBool     uses[SAM_USES] = {PETSC_FALSE};
  Vec *const    f              = step->field;

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(c->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    for (int use = 0; use < SAM_USES; use++) uses[use] = uses[use] || laws[k]->uses[use];
  if (uses[SAM_USE_SLOPE] && SamProblemFollowsSlip(c->problem)) uses[SAM_USE_PATH] = PETSC_TRUE;
  for (int use = 0; use < SAM_USES; use++)
    if (uses[use]) PetscCall(SamGridCreateVec(c->grid, 1, &f[use]));
  if (f[SAM_USE_PATH] || f[SAM_USE_PRESSED] || f[SAM_USE_WORK])
    PetscCall(SamContactComputeFriction(c, f[SAM_USE_PATH], f[SAM_USE_PRESSED], f[SAM_USE_WORK]));
  if (f[SAM_USE_POWER])
    PetscCall(SamSolutionComputeRolling(c->problem, &c->generation[SAM_TRIED], PETSC_FALSE, f[SAM_USE_POWER]));
  if (f[SAM_USE_GAP]) PetscCall(ComputeGap(c, f[SAM_USE_GAP]));
  if (SamProblemFollowsSlip(c->problem)) at.slip = f[SAM_USE_PATH];
  if (f[SAM_USE_SLOPE])
    PetscCall(SamProblemComputeBound(c->problem, &at, &(SamBound){.by_pressure = f[SAM_USE_SLOPE]}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Advances the tried state of all laws. */
static PetscErrorCode Advance(SamContact c, char failed[], size_t size)
{
  const SamSolution *s = &c->generation[SAM_TRIED], *last = c->tried.last;
  SamLawStep         step = {.grid           = c->grid,
                             .state          = c->state,
                             .elasticity     = c->elasticity,
                             .control        = &s->control,
                             .rolled         = s->rolled,
                             .pressure       = s->pressure,
                             .shear          = s->shear,
                             .tension        = s->tension,
                             .last           = {last ? last->pressure : NULL, last ? last->shear : NULL},
                             .bound          = s->bound,
                             .rigid          = s->rigid,
                             .known_pressure = c->tried.known_pressure};

  PetscFunctionBegin;
  PetscCall(SamSolutionCreateTotal(c->problem, s, &step.total));
  PetscCall(CreateFields(c, &step));
  PetscCall(SamProblemAdvance(c->problem, &step));
  (void)snprintf(failed, size, "%s", step.failed);
  if (step.moves) c->revision[SAM_TRIED] = -1;
  for (int use = 0; use < SAM_USES; use++) PetscCall(VecDestroy(&step.field[use]));
  PetscCall(SamSolutionDestroyTotal(s, &step.total));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

/* Sets the approach to unknown if the given normal load is 0 and the bodies do not touch. */
static PetscErrorCode ForgetApproach(SamContact c, SamStep *step)
{
  PetscReal cells;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(c, "contact_cells", &cells));
  if (SamControlWay(&step->control, SAM_COMPONENT_N) == SAM_BY_LOAD && cells == 0) step->rigid[SAM_COMPONENT_N] = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks the tried solution and computes the numbers of the step. */
static PetscErrorCode Conclude(SamContact c, SamStep *step)
{
  SamSolution       *s    = &c->generation[SAM_TRIED];
  const SamSolution *last = c->tried.last, *before = c->tried.before;
  char               failed[sizeof(((SamLawStep *)0)->failed)];

  PetscFunctionBegin;
  /* Returns the memory of the nested grids before new fields are created: the peak falls from 99 to 90 MB at 512 x 512
     cells. */
  if (!last) SamMallocTrim();
  PetscCall(SamStepSetDisplacements(c));
  if (c->tried.same_pressure) PetscCall(SamVecCopyNonzero(last->displacement_z, s->displacement_z));
  PetscCall(SamCheckSolution(c->problem, c->state, c->set.coupling, c->tried.same_pressure, before, s, &step->check));
  PetscCall(Advance(c, failed, sizeof(failed)));
  PetscCall(SamSolutionGiven(c->problem, s, step->load));
  PetscCall(PetscArraycpy(step->rigid, s->rigid, SAM_COMPONENTS));
  PetscCall(SamSolutionComputeNumbers(c->problem, c->state, before, s, c->tried.same_pressure, c->set.edges));
  if (c->set.spots) PetscCall(SamSolutionComputeSpots(c->problem, c->state, s));
  PetscCall(Judge(c, step));
  PetscCall(ForgetApproach(c, step));
  if (failed[0] && SamStepIsSolved(step)) PetscCall(SamStepFail(step, SAM_STATUS_NOT_CONVERGED, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the loads and displacements of a step without solution: NaN, except the prescribed ones. */
static void SetUnknown(SamStep *step)
{
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    step->load[k]  = step->control.force[k] ? step->control.value[k] : NAN;
    step->rigid[k] = SamControlWay(&step->control, k) == SAM_BY_RIGID ? step->control.value[k] : NAN;
  }
  step->check = (SamCheck){.normal = NAN, .tangential = NAN, .equilibrium = NAN, .cone = NAN, .edge = NAN};
}

/* Describes the inputs of the tried step's pressure. The revision does not contain the place of body 2. */
static PetscErrorCode GetStepOf(SamContact c, SamStepOf *of)
{
  PetscReal slide[2];

  PetscFunctionBegin;
  *of        = (SamStepOf){.same_gap = c->tried.same_gap, .coupled = SamContactIsCoupled(c)};
  of->moves  = c->revision[SAM_TRIED] < 0 || SamProblemGetOffset(c->problem, c->state, SAM_TRIED, 1, slide);
  of->yields = SamStateSeparates(c->state);
  PetscCall(SamSolverGetTolerances(SamNormalAsSolver(c->normal), &of->rtol, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactTry(SamContact c, const SamControl *control, SamStep *step)
{
  SamControl    rounded;
  SamCachedStep kept;

  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  SamValidPointer(control, 2);
  SamValidPointer(step, 3);
  PetscCall(SamContactReject(c));
  PetscCall(SamContactSetUp(c));
  *step = (SamStep){.control = *control};
  PetscCall(SamContactPrescribe(c, &step->control, &rounded, &kept));
  PetscCall(SamContactBegin(c, &rounded));
  PetscCall(ComparePressure(c));
  PetscCall(GetStepOf(c, &c->tried.of));
  PetscCall(SamContactPredict(c));
  if (SamContactRecalls(c)) c->tried.start.kept = kept;
  PetscCall(SamStepSolve(c, step));
  if (step->status == SAM_STATUS_NO_EQUILIBRIUM) { /* without equilibrium there is no solution to check */
    SetUnknown(step);
    PetscCall(SamContactStore(c, step));
    PetscCall(SamStateForgetFields(c->state));
    PetscCall(MoveBack(c));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  c->has_tried = PETSC_TRUE;
  PetscCall(NoteWindow(c));
  PetscCall(Conclude(c, step));
  PetscCall(SamContactStore(c, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the tried step for the same step one cycle later. */
static PetscErrorCode Keep(SamContact c)
{
  const SamSolution *now  = &c->generation[SAM_TRIED];
  Vec                turn = NULL;
  SamStepOf          of;

  PetscFunctionBegin;
  PetscCall(GetStepOf(c, &of));
  if (SamRuleTurns(now->rule) && SamStepCacheKeeps(c->cache)) {
    PetscCall(SamGridCreateVec(c->grid, 2, &turn));
    PetscCall(SamStepFindTurn(c, turn));
  }
  PetscCall(SamStepCacheKeep(c->cache, c->tried.last, now, turn, &of));
  PetscCall(VecDestroy(&turn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactCommit(SamContact c)
{
  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  PetscCheck(c->has_tried, c->grid->comm, PETSC_ERR_ORDER, "There is no tried step to commit");
  *SamStateNumbers(c->state, c->steps, SAM_TRIED) += 1;
  if (SamContactRecalls(c))
    PetscCall(Keep(c));
  else /* after a rejected rolling step, material between the bodies may have moved, and kept pressures may be wrong */
    SamStepCacheForget(c->cache);
  PetscCall(SamStateCommit(c->state));
  c->revision[SAM_COMMITTED] = c->revision[SAM_TRIED];
  c->has_tried               = PETSC_FALSE;
  PetscCall(SamContactRefresh(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactReject(SamContact c)
{
  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  c->has_tried = PETSC_FALSE;
  PetscCall(SamStateReject(c->state));
  PetscCall(MoveBack(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamContactHasStep(SamContact c, SamGeneration generation)
{
  return generation == SAM_TRIED ? c->has_tried : SamContactBefore(c) != NULL;
}
