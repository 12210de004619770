/*
  Declares the fields and numbers that a contact remembers and results offer: the solution of a step and its control.
  All others are declared by the laws of the problem.
*/
#include "contactimpl.h"
#include <petsam/private/bodyimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/problem.h>
#include <math.h>

#define CONTROL      (1 + 2 * SAM_COMPONENTS)        /* numbers of a control besides its conditions */
#define DISPLACEMENT "relative elastic displacement" /* normal, and tangential */

/* ---- declarations ---- */

static PetscErrorCode DeclareFields(SamContact c)
{
  static const SamStateField tractions[3]     = {{"pressure", "Pa", "contact pressure, mean over the cell", 1, 3,
                                                  PETSC_TRUE, PETSC_FALSE, SAM_RESULT_USUAL, SAM_STAYS, 0, PETSC_FALSE},
                                                 {"bound", "Pa", NULL, 1, 3, PETSC_TRUE, PETSC_FALSE, SAM_RESULT_NONE,
                                                  SAM_STAYS, 0, PETSC_FALSE},
                                                 {"shear", "Pa", "shear traction, mean over the cell", 2, 3, PETSC_TRUE,
                                                  PETSC_FALSE, SAM_RESULT_USUAL, SAM_STAYS, 0, PETSC_FALSE}};
  static const SamStateField displacements[2] = {{"displacement_z", "m", DISPLACEMENT, 1, 2, PETSC_TRUE, PETSC_FALSE,
                                                  SAM_RESULT_OFFERED, SAM_STAYS, 0, PETSC_FALSE},
                                                 {"displacement", "m", DISPLACEMENT, 2, 2, PETSC_TRUE, PETSC_FALSE,
                                                  SAM_RESULT_OFFERED, SAM_MOVES_CONTINUED, 0, PETSC_FALSE}};

  static const SamStateField tension = {.name = "tension",
                                        .unit = "Pa",
                                        .text = "tension by which the surfaces attract each other, mean over the cell",
                                        .components  = 1,
                                        .generations = 2,
                                        .kept        = PETSC_TRUE,
                                        .result      = SAM_RESULT_USUAL,
                                        .motion      = SAM_STAYS,
                                        .separates   = PETSC_TRUE};
  static const SamStateField aside   = {"aside",         "m",       NULL, 2,          2, PETSC_TRUE, PETSC_FALSE,
                                        SAM_RESULT_NONE, SAM_STAYS, 0,    PETSC_FALSE};

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    SamStateField field = tractions[k];

    if (k == 0 && c->attracts) field.result = SAM_RESULT_NONE; /* results have the pressure less the tension */
    PetscCall(SamStateDeclareField(c->state, &field, &c->tractions[k]));
  }
  if (c->attracts) PetscCall(SamStateDeclareField(c->state, &tension, &c->tension));
  PetscCall(SamStateDeclareField(c->state, &aside, &c->aside));
  for (int k = 0; k < 2; k++) {
    SamStateField field = displacements[k];

    if (SamMotionFindName(c->motion, field.name)) field.result = SAM_RESULT_NONE;
    PetscCall(SamStateDeclareField(c->state, &field, &c->displacements[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Declares a number; `first`: receives its place, for the first number of a row. */
static PetscErrorCode Declare(SamContact c, const char name[], const char unit[], const char text[], SamNumberKind kind,
                              PetscInt count, PetscBool kept, PetscBool result, PetscInt *first)
{
  const SamStateNumber number = {name, unit, text, kind, count, kept, result, SAM_JOIN_LAST, 0};
  PetscInt             id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareNumber(c->state, &number, &id));
  if (first) *first = id;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Declares the loads and displacements, and the other conditions, which are offered as columns if they vary. */
static PetscErrorCode DeclareControl(SamContact c)
{
  PetscFunctionBegin;
  PetscCall(Declare(c, "time", "s", "time of the load step", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, &c->time));
  for (PetscInt n = 0; n < 2 * SAM_COMPONENTS; n++) {
    const PetscInt          k     = n % SAM_COMPONENTS;
    const SamComponentName *name  = &SamComponentNames[k];
    const SamMotionName     rigid = SamMotionRigidName(c->motion, k);
    const PetscBool         load  = n < SAM_COMPONENTS;
    const SamStateNumber    one   = {.name   = load ? name->load : rigid.name,
                                     .unit   = load ? name->load_unit : rigid.unit,
                                     .text   = load ? name->load_text : rigid.text,
                                     .count  = 1,
                                     .kept   = PETSC_TRUE,
                                     .result = PETSC_TRUE,
                                     .order  = 2};
    PetscInt                id;

    PetscCall(SamStateDeclareNumber(c->state, &one, &id));
    if (n == 0) c->solution = id;
  }
  for (PetscInt n = 0; n < SamConditionsCount(c->conditions); n++) {
    const SamCondition  *one    = SamConditionsGet(c->conditions, n);
    const SamStateNumber number = {
      .name = one->name, .unit = one->unit, .text = one->text, .count = 1, .kept = PETSC_TRUE};

    PetscCall(SamStateDeclareOptional(c->state, &number, (double)one->usual, &c->condition[n]));
  }
  for (PetscInt k = 0; k < 3; k++) {
    const SamComponentName *name = &SamComponentNames[SamComponentsOf[SAM_BALANCE_TANGENTIAL][k]];

    PetscCall(Declare(c, name->creep, name->creep_unit, name->creep_text, SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_FALSE,
                      k ? NULL : &c->creeps));
  }
  PetscCall(
    Declare(c, "control", "1", "what was prescribed", SAM_NUMBER_REAL, CONTROL, PETSC_TRUE, PETSC_FALSE, &c->control));
  PetscCall(Declare(c, "approach_apart", "m", "approach that bodies without contact and load are computed with",
                    SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_FALSE, &c->apart));
  if (c->attracts)
    PetscCall(Declare(c, "pull_max", SamComponentNames[SAM_COMPONENT_N].load_unit,
                      "largest pull that the surfaces have borne", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE,
                      &c->pull));
  PetscCall(Declare(c, "window", "1", "part of the grid that was solved on", SAM_NUMBER_INT, 4, PETSC_TRUE, PETSC_FALSE,
                    &c->window));
  PetscCall(
    Declare(c, "slip", "1", "direction of slip", SAM_NUMBER_REAL, SAM_SLIP_NUMBERS, PETSC_TRUE, PETSC_FALSE, &c->slip));
  PetscCall(Declare(c, "steps", "1", "committed load steps", SAM_NUMBER_INT, 1, PETSC_TRUE, PETSC_FALSE, &c->steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DeclareOutcome(SamContact c)
{
  static const char *const residuals[][2] = {{"normal_residual", "relative error of the normal problem, by the check"},
                                             {"tangential_residual",
                                              "relative error of the tangential problem, by the check"},
                                             {"equilibrium_residual", "relative error of the loads, by the check"}};
  static const char *const counts[SAM_COUNTS][2] = {
    {"normal_iterations", "iterations of the normal solver"},
    {"normal_applies", "applications of the normal influence operator"},
    {"normal_preconditions", "applications of the normal preconditioner"},
    {"tangential_iterations", "iterations of the tangential solver"},
    {"tangential_applies", "applications of the tangential influence operator"},
    {"tangential_preconditions", "applications of the tangential preconditioner"},
    {"coupling_iterations", "iterations of the normal-tangential coupling"}};

  SamStateNumber number = {NULL, "1", NULL, SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_GREATEST, 0};
  PetscInt       id;

  PetscFunctionBegin;
  for (int k = 0; k < 3; k++) {
    number.name = residuals[k][0];
    number.text = residuals[k][1];
    PetscCall(SamStateDeclareNumber(c->state, &number, k ? &id : &c->residuals));
  }
  number.kind = SAM_NUMBER_INT;
  number.join = SAM_JOIN_SUM;
  for (int k = 0; k < SAM_COUNTS; k++) {
    number.name = counts[k][0];
    number.text = counts[k][1];
    PetscCall(SamStateDeclareNumber(c->state, &number, k ? &id : &c->counts));
  }
  PetscCall(
    Declare(c, "status", "1", "outcome of the load step", SAM_NUMBER_STATUS, 1, PETSC_FALSE, PETSC_TRUE, &c->status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- fields that are computed ---- */

enum {
  PRESSURE,
  SLIP_X,
  SLIP_Y,
  GAP,
  STATE,
  PRESSURE_CENTER,
  SHEAR_CENTER_X,
  SHEAR_CENTER_Y,
  ASIDE_X,
  ASIDE_Y,
  POWER,
  PASSAGE
};

static PetscErrorCode GetComponent(SamGrid grid, Vec from, PetscInt component, Vec to)
{
  const double *values;
  double       *array;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(from, &values));
  PetscCall(VecGetArrayWrite(to, &array));
  PetscCall(PetscArraycpy(array, values + component * grid->cells, grid->cells));
  PetscCall(VecRestoreArrayWrite(to, &array));
  PetscCall(VecRestoreArrayRead(from, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Compute(void *owner, SamState state, PetscInt which, Vec field)
{
  const SamContact   c = (SamContact)owner;
  const SamSolution *s;
  double            *slips;
  Vec                h;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(c, &s));
  switch (which) {
  case PRESSURE:
    PetscCall(VecWAXPY(field, -1, s->tension, s->pressure));
    break;
  case SLIP_X:
  case SLIP_Y:
    PetscCall(VecGetArrayWrite(field, &slips));
    PetscCall(SamSolutionComputeSlip(c->problem, s, which - SLIP_X, slips));
    PetscCall(VecRestoreArrayWrite(field, &slips));
    break;
  case ASIDE_X:
  case ASIDE_Y:
    PetscCall(VecSet(field, 0));
    if (s->aside) PetscCall(GetComponent(c->grid, s->aside, which - ASIDE_X, field));
    break;
  case GAP:
    PetscCall(SamSolutionCreateSeparation(c->problem, state, SAM_TRIED, &h));
    PetscCall(SamSolutionComputeGap(c->problem, s, s->displacement_z, h, field));
    PetscCall(SamSolutionDestroySeparation(c->problem, &h));
    break;
  case STATE:
    PetscCall(SamSolutionComputeStates(s, field));
    break;
  case POWER:
  case PASSAGE:
    PetscCall(SamSolutionComputeRolling(c->problem, s, which == PASSAGE, field));
    break;
  case PRESSURE_CENTER:
    PetscCall(SamSolutionComputePressureCenter(c->problem, s, field));
    if (s->tension) PetscCall(VecAXPY(field, -1, s->tension));
    break;
  default:
    PetscCall(SamSolutionComputeShearCenter(c->problem, s, which - SHEAR_CENTER_X, field));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactFindEdge(SamContact c, SamEdgeOf which, const SamEdge **edge)
{
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(c, &s));
  PetscCall(SamSolutionFindEdge(c->problem, s, which, edge));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Offer(SamContact c)
{
  const SamStateResult pressure = {
    "pressure", "Pa", "contact pressure less tension, mean over the cell", SAM_FIELD_REAL, SAM_RESULT_USUAL, Compute, c,
    PRESSURE,   -1};
  const SamStateResult results[] = {
    {"slip_x", "m", "relative tangential displacement along x since the start", SAM_FIELD_REAL, SAM_RESULT_USUAL,
     Compute, c, SLIP_X, -1},
    {"slip_y", "m", "relative tangential displacement along y since the start", SAM_FIELD_REAL, SAM_RESULT_USUAL,
     Compute, c, SLIP_Y, -1},
    {"gap", "m", "gap between the deformed surfaces", SAM_FIELD_REAL, SAM_RESULT_OFFERED, Compute, c, GAP, -1},
    {"state", "1", "state of the cell", SAM_FIELD_STATE, SAM_RESULT_USUAL, Compute, c, STATE, -1},
    {"pressure_center", "Pa", "contact pressure at the centre of the cell", SAM_FIELD_REAL, SAM_RESULT_OFFERED, Compute,
     c, PRESSURE_CENTER, -1},
    {"shear_center_x", "Pa", "shear traction along x at the centre of the cell", SAM_FIELD_REAL, SAM_RESULT_OFFERED,
     Compute, c, SHEAR_CENTER_X, -1},
    {"shear_center_y", "Pa", "shear traction along y at the centre of the cell", SAM_FIELD_REAL, SAM_RESULT_OFFERED,
     Compute, c, SHEAR_CENTER_Y, -1},
    {"slip_aside_x", "m", "part of the step's slip that the shear at its end does not oppose, along x", SAM_FIELD_REAL,
     SAM_RESULT_OFFERED, Compute, c, ASIDE_X, -1},
    {"slip_aside_y", "m", "part of the step's slip that the shear at its end does not oppose, along y", SAM_FIELD_REAL,
     SAM_RESULT_OFFERED, Compute, c, ASIDE_Y, -1},
    {"contact_edge", "m", "points of the contact edge, x and y", SAM_FIELD_POINTS, SAM_RESULT_OFFERED, NULL, c,
     SAM_EDGE_CONTACT, -1},
    {"stick_edge", "m", "points of the stick-slip boundary, x and y", SAM_FIELD_POINTS, SAM_RESULT_OFFERED, NULL, c,
     SAM_EDGE_STICK, -1},
    {"power_density", "Pa", "frictional power per area, over the rolling speed", SAM_FIELD_REAL, SAM_RESULT_OFFERED,
     Compute, c, POWER, -1},
    {"wear_passage", "Pa m", "pressure times slip of a point that passes, the same along x", SAM_FIELD_REAL,
     SAM_RESULT_OFFERED, Compute, c, PASSAGE, -1}};
  const size_t count =
    sizeof(results) / sizeof(results[0]) - (c->motion->streams ? 0 : 2); /* the last two: rolling only */

  PetscFunctionBegin;
  if (c->attracts) PetscCall(SamStateOffer(c->state, &pressure));
  for (size_t k = 0; k < count; k++) {
    const SamMotionName *name  = SamMotionFindName(c->motion, results[k].name);
    SamStateResult       offer = results[k];

    if (name) {
      offer.name = name->name;
      offer.unit = name->unit;
      offer.text = name->text;
    }
    PetscCall(SamStateOffer(c->state, &offer));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns a number that grows whenever conditions, laws or settings change that the declarations depend on. */
static PetscObjectState Declarations(SamContact c)
{
  PetscObjectState sum = SamConditionsCount(c->conditions);
  const SamLaw    *laws;
  PetscInt         count;

  (void)SamProblemGetLaws(c->problem, &count, &laws);
  for (PetscInt k = 0; k < count; k++) sum += 1 + laws[k]->revision;
  return sum;
}

PetscErrorCode SamContactDeclare(SamContact c)
{
  const PetscObjectState now = Declarations(c);

  PetscFunctionBegin;
  if (c->declared == now) PetscFunctionReturn(PETSC_SUCCESS);
  c->declared = now;
  c->attracts = SamProblemAttracts(c->problem);
  PetscCall(DeclareFields(c));
  PetscCall(Offer(c));
  PetscCall(DeclareControl(c));
  PetscCall(SamSolutionDeclareNumbers(c->state, c->motion));
  if (c->motion->streams) PetscCall(SamStepDeclareRolling(c->state, &c->rolling));
  if (c->traits.skewed) PetscCall(SamStepDeclareResistance(c->elasticity, c->state));
  PetscCall(DeclareOutcome(c));
  if (c->set.spots) PetscCall(SamSolutionDeclareSpots(c->state));
  PetscCall(SamProblemDeclare(c->problem, c->state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- generations ---- */

const SamSolution *SamContactBefore(SamContact c)
{
  return *SamStateNumbers(c->state, c->steps, SAM_COMMITTED) > 0 ? &c->generation[SAM_COMMITTED] : NULL;
}

PetscInt SamContactGetSteps(SamContact c)
{
  return (PetscInt)*SamStateNumbers(c->state, c->steps, SAM_COMMITTED);
}

/*
  Moves the committed solution for the next step after the grid has moved: fields that belong to the material move
  through the grid. The rigid motion, and the strain of the surfaces, are taken about the origin, which has moved along.
*/
static PetscErrorCode Move(SamContact c, const PetscReal roll[2])
{
  SamSolution *const s     = &c->generation[SAM_COMMITTED];
  PetscReal *const   rigid = s->rigid;
  SamStrain          e;

  PetscFunctionBegin;
  PetscCall(SamStateMove(c->state, roll, c->traits.periodic));
  PetscCall(SamContactRefresh(c));
  PetscCall(SamProblemDisplace(c->problem, NULL, &s->control, NULL, NULL, &e, NULL));
  rigid[SAM_COMPONENT_TX] -= rigid[SAM_COMPONENT_MZ] * roll[1] + e.xx * roll[0] + e.xy * roll[1];
  rigid[SAM_COMPONENT_TY] += rigid[SAM_COMPONENT_MZ] * roll[0] - e.xy * roll[0] - e.yy * roll[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Begins the tension of a step as that of the step before. */
static PetscErrorCode BeginTension(SamContact c, SamSolution *s)
{
  const Vec last = SamStateGetField(c->state, c->tension, SAM_COMMITTED);

  PetscFunctionBegin;
  PetscCall(SamStateSetField(c->state, c->tension, &s->tension));
  PetscCall(last ? VecCopy(last, s->tension) : VecZeroEntries(s->tension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactBegin(SamContact c, const SamControl *control)
{
  SamSolution       *s      = &c->generation[SAM_TRIED];
  const SamSolution *before = SamContactBefore(c);

  PetscFunctionBegin;
  PetscCall(SamContactDeclare(c));
  PetscCall(SamStateBegin(c->state));
  c->tried  = (SamTried){.last = before, .before = c->motion->continues ? before : NULL};
  *s        = (SamSolution){.control = *control};
  s->rolled = SamProblemGetRolled(c->problem, control, s->roll);
  if (s->rolled != 0 && before) PetscCall(Move(c, s->roll));
  PetscCall(SamContactFindRule(c, s));
  PetscCall(SamStateSetField(c->state, c->tractions[0], &s->pressure));
  if (c->attracts) PetscCall(BeginTension(c, s));
  PetscCall(SamStateSetField(c->state, c->tractions[1], &s->bound));
  PetscCall(SamStateSetField(c->state, c->tractions[2], &s->shear));
  PetscCall(SamProblemBegin(c->problem, c->state, control, before ? control->time - before->control.time : 0));
  PetscCall(SamProblemGetRevision(c->problem, &c->revision[SAM_TRIED]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores a control in numbers of the state: the six components in one row, each condition by its name. */
static void StoreControl(SamContact c, const SamControl *control, double n[])
{
  n[c->control] = control->time;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    n[c->control + 1 + k]                  = SamControlWay(control, k);
    n[c->control + 1 + SAM_COMPONENTS + k] = control->value[k];
  }
  for (PetscInt k = 0; k < SamConditionsCount(c->conditions); k++)
    n[c->condition[k]] = SamControlGet(control, SamConditionsGet(c->conditions, k));
}

static void ViewControl(SamContact c, const double n[], SamControl *control)
{
  *control = (SamControl){.time = n[c->control]};
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    SamControlSetWay(control, k, (SamWay)n[c->control + 1 + k]);
    control->value[k] = n[c->control + 1 + SAM_COMPONENTS + k];
  }
  for (PetscInt k = 0; k < SamConditionsCount(c->conditions) && n[c->steps] > 0; k++)
    SamControlSetCondition(control, SamConditionsGet(c->conditions, k), n[c->condition[k]]);
}

PetscErrorCode SamContactStore(SamContact c, const SamStep *step)
{
  double *const            n     = SamStateNumbers(c->state, 0, SAM_TRIED);
  const SamSolution *const tried = &c->generation[SAM_TRIED];

  PetscFunctionBegin;
  n[c->time]                  = step->control.time;
  n[c->slip + SAM_SLIP_ASIDE] = tried->aside != NULL;
  PetscCall(PetscArraycpy(n + c->solution, step->load, SAM_COMPONENTS));
  PetscCall(PetscArraycpy(n + c->solution + SAM_COMPONENTS, step->rigid, SAM_COMPONENTS));
  n[c->apart] = tried->rigid[SAM_COMPONENT_N];
  if (c->attracts) {
    const double before = SamStateNumbers(c->state, 0, SAM_COMMITTED)[c->pull];

    n[c->pull] = PetscMax(before > 0 ? before : 0, -(double)step->load[SAM_COMPONENT_N]);
  }
  for (PetscInt k = 0; k < 3 && tried->rolled != 0; k++) {
    const PetscInt     m      = SamComponentsOf[SAM_BALANCE_TANGENTIAL][k];
    const SamSolution *before = SamContactBefore(c);

    n[c->creeps + k] = step->control.creep[m] ? step->control.value[m]
                                              : (step->rigid[m] - (before ? before->rigid[m] : 0)) / tried->rolled;
  }
  StoreControl(c, &tried->control, n);
  n[c->residuals]     = step->check.normal;
  n[c->residuals + 1] = step->check.tangential;
  n[c->residuals + 2] = step->check.equilibrium;
  n[c->status]        = step->status;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactRefresh(SamContact c)
{
  PetscFunctionBegin;
  PetscCall(SamContactDeclare(c));
  for (SamGeneration g = SAM_COMMITTED; g <= SAM_BEFORE; g++) {
    SamSolution *s = &c->generation[g];
    double      *n = SamStateNumbers(c->state, 0, g);

    ViewControl(c, n, &s->control);
    s->rolled = SamProblemGetRolled(c->problem, &s->control, s->roll);
    for (PetscInt k = 0; k < SAM_COMPONENTS; k++) { /* nothing has moved before the first step */
      s->load[k]  = n[c->steps] > 0 ? n[c->solution + k] : 0;
      s->rigid[k] = n[c->steps] > 0 ? n[c->solution + SAM_COMPONENTS + k] : 0;
    }
    if (isnan(s->rigid[SAM_COMPONENT_N])) s->rigid[SAM_COMPONENT_N] = n[c->apart];
    PetscCall(SamStateRestoreField(c->state, c->tractions[0], g, &s->pressure));
    PetscCall(SamStateRestoreField(c->state, c->tractions[1], g, &s->bound));
    PetscCall(SamStateRestoreField(c->state, c->tractions[2], g, &s->shear));
    s->tension = g == SAM_BEFORE || !c->attracts ? NULL : SamStateGetField(c->state, c->tension, g);
    PetscCall(SamSolutionTake(c->problem, s));
    s->displacement_z = g == SAM_BEFORE ? NULL : SamStateGetField(c->state, c->displacements[0], g);
    s->displacement_t = g == SAM_BEFORE ? NULL : SamStateGetField(c->state, c->displacements[1], g);
    s->aside = g == SAM_COMMITTED && n[c->slip + SAM_SLIP_ASIDE] ? SamStateGetField(c->state, c->aside, g) : NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactRewind(SamContact c, const PetscReal by[2])
{
  static const SamComponent along[2] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY};

  PetscFunctionBegin;
  for (SamGeneration g = SAM_COMMITTED; g <= SAM_BEFORE; g++) {
    double *const n = SamStateNumbers(c->state, 0, g);

    for (int k = 0; k < 2; k++) {
      n[c->solution + SAM_COMPONENTS + along[k]] -= by[k];
      if (c->generation[g].control.force[along[k]]) continue;
      n[c->control + 1 + SAM_COMPONENTS + along[k]] -= by[k];
    }
    SamFramesRewind(c->state, g, by);
  }
  PetscCall(SamContactRefresh(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetSolution(SamContact c, const SamSolution **solution)
{
  SamSolution *s;

  PetscFunctionBegin;
  SamValidHandle(c, SamContact, 1);
  SamValidPointer(solution, 2);
  s = &c->generation[SAM_COMMITTED];
  if (!c->has_tried && !s->displacement_t) {
    PetscCall(SamStateRestoreField(c->state, c->displacements[0], SAM_COMMITTED, &s->displacement_z));
    PetscCall(SamStateRestoreField(c->state, c->displacements[1], SAM_COMMITTED, &s->displacement_t));
  }
  *solution = c->has_tried ? &c->generation[SAM_TRIED] : s;
  PetscFunctionReturn(PETSC_SUCCESS);
}
