/* The class SamContact: its settings, and steps that are tried, then committed or rejected. */
#include "contactimpl.h"
#include <math.h>

/*
  The check also sees rounding, which the solvers' recurrences do not show. So its limits are the solvers' tolerances
  times a margin; equilibrium and cone, which solvers meet to rounding, have limits of their own.
*/
#define CHECK_MARGIN      1.05
#define CHECK_EQUILIBRIUM 1e-10
#define CHECK_CONE        1e-12

/* ---- creation ---- */

PetscErrorCode SamContactCreate(SamProblem problem, SamContact *contact)
{
  SamContact c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  PetscCall(SamProblemReference(problem));
  c->problem         = problem;
  c->coupling        = PETSC_TRUE;
  c->warm            = PETSC_TRUE;
  c->coupling_rtol   = 1e-6;
  c->coupling_max_it = 100;
  c->edges           = SAM_CONTACT_EDGES_RECONSTRUCT;
  c->edge_passes     = 2;
  PetscCall(SamProblemGetElasticity(problem, &c->elasticity));
  PetscCall(SamProblemGetGrid(problem, &c->grid));
  PetscCall(SamElasticityGetTraits(c->elasticity, &c->traits));
  PetscCall(SamNormalCreate(c->elasticity, &c->normal));
  PetscCall(SamTangentialCreate(c->elasticity, &c->tangential));
  PetscCall(SamSolutionCreate(c->grid, &c->committed.solution));
  PetscCall(SamSolutionCreate(c->grid, &c->tried.solution));
  PetscCall(SamSolutionCreate(c->grid, &c->before));
  c->committed.gap_revision = -1;
  *contact                  = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactDestroy(SamContact *contact)
{
  SamContact c = *contact;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolverDestroy(&c->normal));
  PetscCall(SamSolverDestroy(&c->tangential));
  PetscCall(SamProfileDestroy(&c->profile));
  PetscCall(SamShearProfileDestroy(&c->shear_profile));
  PetscCall(SamSolutionDestroy(&c->committed.solution));
  PetscCall(SamSolutionDestroy(&c->committed.plain));
  PetscCall(SamSolutionDestroy(&c->tried.plain));
  PetscCall(SamSolutionDestroy(&c->tried.solution));
  PetscCall(SamSolutionDestroy(&c->before));
  for (PetscInt k = 0; k < SAM_CONTACT_SUMS; k++) PetscCall(VecDestroy(&c->sums[k]));
  PetscCall(SamProblemDestroy(&c->problem));
  PetscCall(PetscFree(*contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- settings ---- */

PetscErrorCode SamContactSetOptionsPrefix(SamContact c, const char prefix[])
{
  PetscFunctionBegin;
  PetscCall(SamSetPrefix(c->prefix, prefix));
  PetscCall(SamSolverSetOptionsPrefix(c->normal, prefix));
  PetscCall(SamSolverSetOptionsPrefix(c->tangential, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetCoupling(SamContact c, PetscBool full, PetscReal rtol, PetscInt max_it)
{
  PetscFunctionBegin;
  PetscCheck(rtol == PETSC_DEFAULT || rtol > 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coupling tolerance rtol = %g: expected a number > 0", (double)rtol);
  PetscCheck(max_it == PETSC_DEFAULT || max_it > 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "coupling passes max_it = %" PetscInt_FMT ": expected at least 1", max_it);
  c->coupling = full;
  if (rtol != PETSC_DEFAULT) c->coupling_rtol = rtol;
  if (max_it != PETSC_DEFAULT) c->coupling_max_it = max_it;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetCoupling(SamContact c, PetscBool *full)
{
  PetscFunctionBegin;
  *full = c->coupling;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetWarmStart(SamContact c, PetscBool warm)
{
  PetscFunctionBegin;
  c->warm = warm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactAllowEdge(SamContact c, PetscBool allow)
{
  PetscFunctionBegin;
  c->allow_edge = allow;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetSpots(SamContact c, PetscBool count)
{
  PetscFunctionBegin;
  c->spots = count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetSpots(SamContact c, PetscBool *count)
{
  PetscFunctionBegin;
  *count = c->spots;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetEdges(SamContact c, SamContactEdges edges, PetscInt passes)
{
  PetscFunctionBegin;
  PetscCheck(passes == PETSC_DEFAULT || passes > 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "passes for the edge = %" PetscInt_FMT ": expected at least 1", passes);
  c->edges = edges;
  if (passes != PETSC_DEFAULT) c->edge_passes = passes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetEdges(SamContact c, SamContactEdges *edges)
{
  PetscFunctionBegin;
  *edges = c->edges;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For programs that do not write results, which keep the sums that are among their fields. */
static PetscErrorCode ReadSums(SamContact c, const SamOptions *from)
{
  static const struct {
    const char *option, *text;
  } sums[SAM_CONTACT_SUMS] = {{"sum_slip_path", "sum the path of the slip over all steps (field slip_path)"},
                              {"sum_friction_energy",
                               "sum the frictional work over all steps (field friction_energy)"}};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_CONTACT_SUMS; k++) {
    PetscBool keep = PETSC_FALSE;

    PetscCall(SamOptionsBool(from, sums[k].option, sums[k].text, &keep, NULL));
    if (keep) PetscCall(SamContactKeepSum(c, (SamContactSum)k));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetFromOptions(SamContact c)
{
  static const char *const coupling_words[] = {"none", "full", NULL}, *const edge_words[] = {"none", "reconstruct",
                                                                                             "deferred", NULL};
  const SamOptions from     = {c->grid->comm, c->prefix};
  PetscInt         coupling = c->coupling ? 1 : 0, max_it = c->coupling_max_it;
  PetscReal        rtol  = c->coupling_rtol;
  PetscInt         edges = (PetscInt)c->edges, passes = c->edge_passes;
  PetscBool        warm = c->warm, edge = c->allow_edge, spots = c->spots;

  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(&from, "Contact"));
  PetscCall(SamOptionsEnum(&from, "coupling", "normal-tangential coupling of dissimilar materials: full or none",
                           coupling_words, &coupling, NULL));
  PetscCall(SamOptionsReal(&from, "coupling_rtol", "relative change of p and q between passes", SAM_RANGE_POSITIVE,
                           &rtol, NULL));
  PetscCall(SamOptionsInt(&from, "coupling_max_it", "most passes of the coupling", 1, &max_it, NULL));
  PetscCall(SamOptionsBool(&from, "coupling_monitor", "print the change after each pass", &c->coupling_monitor, NULL));
  PetscCall(
    SamOptionsBool(&from, "warm_start", "start each step from the one before, on the finest grid only", &warm, NULL));
  PetscCall(SamOptionsBool(&from, "allow_edge_contact", "contact at the grid's edge is a warning", &edge, NULL));
  PetscCall(SamOptionsEnum(&from, "edges", "reconstruct, none: count cells, deferred: solve again for them", edge_words,
                           &edges, NULL));
  PetscCall(SamOptionsInt(&from, "edges_passes", "solutions again with -edges deferred", 1, &passes, NULL));
  PetscCall(
    SamOptionsBool(&from, "contact_spots", "number of spots of contact and mean gap of each step", &spots, NULL));
  PetscCall(SamOptionsBool(&from, "contact_check", "print the check of each step", &c->print_check, NULL));
  PetscCall(SamContactSetCoupling(c, coupling ? PETSC_TRUE : PETSC_FALSE, rtol, max_it));
  PetscCall(SamContactSetWarmStart(c, warm));
  PetscCall(SamContactAllowEdge(c, edge));
  PetscCall(SamContactSetSpots(c, spots));
  PetscCall(SamContactSetEdges(c, (SamContactEdges)edges, passes));
  PetscCall(ReadSums(c, &from));
  PetscCall(SamSolverSetFromOptions(c->normal));
  PetscCall(SamSolverSetFromOptions(c->tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetProblem(SamContact c, SamProblem *problem)
{
  PetscFunctionBegin;
  *problem = c->problem;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetGrid(SamContact c, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = c->grid;
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

/* ---- a step ---- */

static PetscErrorCode Judge(SamContact c, SamStep *step)
{
  const SamCheck *check  = &step->check;
  SamCheckLimits  limits = {.equilibrium = CHECK_EQUILIBRIUM, .cone = CHECK_CONE, .edge = c->allow_edge};

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(c->normal, &limits.normal, NULL));
  PetscCall(SamSolverGetTolerances(c->tangential, &limits.tangential, NULL));
  limits.normal *= CHECK_MARGIN;
  limits.tangential *= CHECK_MARGIN;
  if (c->print_check)
    PetscCall(PetscPrintf(c->grid->comm,
                          "      check: normal %.3e tangential %.3e equilibrium %.3e cone %.3e edge pressure %.3e\n",
                          (double)check->normal, (double)check->tangential, (double)check->equilibrium,
                          (double)check->cone, (double)check->edge));
  PetscCall(SamStepJudge(step, &limits));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bulk stress must be finite, and 0 in a rigid body, and in periodic bodies, whose surfaces would no longer be so. */
static PetscErrorCode CheckBulkStress(SamContact c, const SamControl *control)
{
  const SamPair *pair;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetPair(c->elasticity, &pair));
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) {
      const char  *name   = SamBulkNames[body][k].name;
      const double stress = (double)control->bulk_stress[body][k];

      PetscCheck(stress == 0 || !isinf(pair->young[body]), c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "%s = %g: expected 0: a rigid body does not stretch", name, stress);
      PetscCheck(fabs(stress) <= pair->young[body], c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "%s = %g: expected at most Young's modulus, %g", name, stress, (double)pair->young[body]);
      PetscCheck(stress == 0 || c->traits.rotations, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
                 "%s = %g: expected 0: stretched bodies are not periodic", name, stress);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a control that makes no sense. Rotations that the elasticity does not have are held at 0. */
static PetscErrorCode CheckControl(SamContact c, SamControl *control)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    const char *name = control->force[k] ? SamComponentNames[k].load : SamComponentNames[k].rigid;

    PetscCheck(isfinite(control->value[k]), c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "%s is not a finite number", name);
    if (k < SAM_COMPONENT_MX || c->traits.rotations) continue;
    PetscCheck(control->value[k] == 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "%s = %g: expected 0: moments and rotations have no meaning for periodic bodies", name,
               (double)control->value[k]);
    control->force[k] = PETSC_FALSE;
  }
  PetscCheck(!control->force[SAM_COMPONENT_N] || control->value[SAM_COMPONENT_N] >= 0, c->grid->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "load_n = %g: expected a number >= 0", (double)control->value[SAM_COMPONENT_N]);
  PetscCheck(control->friction_scale >= 0 && isfinite(control->friction_scale), c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "friction_scale = %g: expected a number >= 0", (double)control->friction_scale);
  PetscCall(CheckBulkStress(c, control));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the elasticity use the committed state's part of the grid again: a rejected try must leave no trace. */
static PetscErrorCode RestoreWindow(SamContact c)
{
  PetscFunctionBegin;
  PetscCall(SamElasticitySetPart(c->elasticity, c->committed.window_first, c->committed.window_n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Whether the next step has the committed pressure: same normal control, same gap, corrected for the edge in the same
  way, and no shear that acts on it. That the surfaces yielded under it does not matter (plastic.c).
*/
static PetscErrorCode IsSamePressure(SamContact c, const SamControl *control, PetscBool *same)
{
  PetscBool current;

  PetscFunctionBegin;
  PetscCall(SamContactIsGapCurrent(c, &current));
  *same = !SamContactIsCoupled(c) && c->steps && current &&
          c->committed.solution.passes == (c->edges == SAM_CONTACT_EDGES_DEFERRED ? c->edge_passes : 0) &&
          SamControlIsSame(&c->committed.solution.control, control, SAM_BALANCE_NORMAL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks the tried solution and fills in the numbers of the step. */
static PetscErrorCode Conclude(SamContact c, PetscBool same_pressure, SamStep *step)
{
  SamSolution       *s      = &c->tried.solution;
  const SamSolution *before = SamContactBefore(c);
  const PetscBool    known  = same_pressure && s->passes == c->committed.solution.passes;

  PetscFunctionBegin;
  /* that of the nested grids, before new fields are made: lowers the peak from 99 to 90 MB at 512 x 512 cells */
  if (!c->steps) SamReturnMemory();
  PetscCall(SamSolutionCreateDisplacements(c->grid, s));
  if (known) PetscCall(SamVecCopyNonzero(c->committed.solution.displacement_z, s->displacement_z));
  PetscCall(SamCheckSolution(c->problem, c->coupling, known, before, s, &step->check));
  PetscCall(SamContactYield(c, same_pressure, step));
  PetscCall(PetscArraycpy(step->load, s->load, SAM_COMPONENTS));
  PetscCall(PetscArraycpy(step->rigid, s->rigid, SAM_COMPONENTS));
  PetscCall(SamContactComputeScalars(c, step));
  PetscCall(Judge(c, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Without a solution only the prescribed loads and displacements are known. */
static void SetUnknown(SamStep *step)
{
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    step->load[k]  = step->control.force[k] ? step->control.value[k] : NAN;
    step->rigid[k] = step->control.force[k] ? NAN : step->control.value[k];
  }
  step->contact_area = step->stick_area = step->dissipated_energy = step->stored_energy = step->edge_accepted = NAN;
  step->pressure_max = step->shear_max = step->slip_max = step->contact_fraction = NAN;
  step->plastic_area = step->plastic_depth_max = step->plastic_energy = NAN;
  step->check = (SamCheck){.normal = NAN, .tangential = NAN, .equilibrium = NAN, .cone = NAN, .edge = NAN};
}

PetscErrorCode SamContactTry(SamContact c, const SamControl *control, SamStep *step)
{
  SamControl   given = *control;
  SamStepStart start;
  PetscBool    same_pressure = PETSC_FALSE, friction;
  PetscReal    limit;

  PetscFunctionBegin;
  PetscCall(SamContactReject(c));
  PetscCall(CheckControl(c, &given));
  PetscCall(SamProblemHasFriction(c->problem, &friction));
  PetscCheck(!friction || !SamContactIsCoupled(c) || c->edges != SAM_CONTACT_EDGES_DEFERRED, c->grid->comm,
             PETSC_ERR_SUP, "Pressure and shear that act on each other are not corrected for their edges");
  PetscCall(SamProblemGetPressureLimit(c->problem, &limit));
  PetscCheck(isinf(limit) || c->edges != SAM_CONTACT_EDGES_DEFERRED, c->grid->comm, PETSC_ERR_SUP,
             "The pressure is corrected for its edge without a limit only: yielded surfaces are not those it is for");
  PetscCall(SamNormalSetPressureLimit(c->normal, limit));
  PetscCall(PetscMemzero(step, sizeof(*step)));
  for (PetscInt k = 0; k < 2 * SAM_COMPONENTS * SAM_COMPONENTS; k++) (&step->stiffness[0][0][0])[k] = NAN;
  step->spots = step->gap_mean = NAN;
  step->control                = given;
  c->tried.solution.control    = given;
  PetscCall(SamProblemGetGapRevision(c->problem, &c->tried.gap_revision));
  PetscCall(IsSamePressure(c, &given, &same_pressure));
  PetscCall(SamContactPredict(c, &given, &start));
  PetscCall(SamContactSolveStep(c, &start, same_pressure, step));
  if (step->status == SAM_STATUS_NO_EQUILIBRIUM) { /* there is no solution to check */
    SetUnknown(step);
    PetscCall(RestoreWindow(c));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  c->has_tried = PETSC_TRUE;
  PetscCall(SamElasticityGetPartPlace(c->elasticity, c->tried.window_first, c->tried.window_n));
  PetscCall(Conclude(c, same_pressure, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactCommit(SamContact c)
{
  SamSolution recycled = c->before, plain;

  PetscFunctionBegin;
  PetscCheck(c->has_tried, c->grid->comm, PETSC_ERR_ORDER, "There is no tried step to commit");
  PetscCall(SamContactAddSums(c));
  c->before                = c->committed.solution;
  c->before.displacement_z = c->before.displacement_t = NULL;
  recycled.displacement_z                             = c->committed.solution.displacement_z;
  recycled.displacement_t                             = c->committed.solution.displacement_t;
  c->before.correction = c->before.rim = c->before.plastic = NULL;
  c->before.passes                                         = 0;
  recycled.correction                                      = c->committed.solution.correction;
  recycled.rim                                             = c->committed.solution.rim;
  recycled.sheared                                         = c->committed.solution.sheared;
  plain                                                    = c->committed.plain;
  c->before.sheared                                        = (SamShearCorrection){.has = PETSC_FALSE};
  recycled.plastic                                         = c->committed.solution.plastic;
  c->committed                                             = c->tried;
  c->tried.solution                                        = recycled;
  c->tried.plain                                           = plain;
  c->has_tried                                             = PETSC_FALSE;
  c->steps++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactReject(SamContact c)
{
  PetscFunctionBegin;
  c->has_tried = PETSC_FALSE;
  PetscCall(RestoreWindow(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
