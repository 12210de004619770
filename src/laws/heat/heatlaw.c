/*
  Frictional heat: the steady temperatures of both surfaces by the frictional power of a step, and friction that depends
  on the temperature.

  In steady rolling the power is the rolling speed times -q.s, s being the centred slip in 1 m of rolled distance
  (frictionwork.c): its sum is the power of the loads on the creepages. In other steps it is the work of the step over
  its time. The temperatures are those of a state that lasts (-heat steady): the bodies are half-spaces whose material
  moves along x relative to the contact, in rolling both at the rolling speed towards -x.
  Source: Bos and Moes 1995, J. Tribol. 117, 171-177; Ertz and Knothe 2002, Wear 253, 498-508.
*/
#include "heatlaw.h"
#include <petsam/private/balance.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/parameters.h>
#include <petsam/private/state.h>
#include <petsam/private/wear.h>
#include <math.h>

#define MOST_RESISTANCE  1000   /* m2 K/W */
#define MOST_TEMPERATURE 100000 /* K */

enum { NONE, STEADY };

#define NEEDED "heat steady"
#define ROW(name, member_, text_, ...) \
  { \
    name, text_, SAM_OPTION_REAL, offsetof(SamHeatLaw, member_), .needs = NEEDED, .recorded = PETSC_TRUE, __VA_ARGS__ \
  }
#define BODY(k) \
  ROW("body" #k "_conductivity", conductivity[k - 1], "thermal conductivity () of body " #k, .unit = "W/(m K)", \
      .range = SAM_RANGE_POSITIVE), \
    ROW("body" #k "_heat_capacity", capacity[k - 1], "density times specific heat () of body " #k, .unit = "J/(m3 K)", \
        .range = SAM_RANGE_POSITIVE), \
    ROW("body" #k "_bulk_temperature", bulk[k - 1], "temperature () of body " #k " far from the contact", .unit = "K", \
        .range = SAM_RANGE_ANY), \
    ROW("body" #k "_expansion", expansion[k - 1], "thermal expansion () of body " #k ": heat displaces its surface", \
        .unit = "1/K", .range = SAM_RANGE_ANY), \
  { \
    "body" #k "_speed", "speed () of body " #k "'s material along x, for heat or bodies that relax", SAM_OPTION_REAL, \
      offsetof(SamHeatLaw, speed[k - 1]), .unit = "m/s", .range = SAM_RANGE_ANY, .excludes = "rolling", \
                                          .needs    = NEEDED " or -body1_relax_moduli or -body2_relax_moduli", \
                                          .recorded = PETSC_TRUE \
  }
static const SamOptionRow rows[] = {
  {"heat", "temperatures by frictional heat: of a steady state, or none", SAM_OPTION_ENUM, offsetof(SamHeatLaw, kind),
   .words = "none,steady", .recorded = PETSC_FALSE},
  BODY(1),
  BODY(2),
  ROW("heat_resistance", resistance, "resistance () of the contact to heat on its way to body 2", .unit = "m2 K/W",
      .range = SAM_RANGE_NONNEGATIVE)};

/* ---- options ---- */

/* Takes the constants of a body from its named material where they are not given, and requires them. */
static PetscErrorCode TakeMaterial(SamLaw law, const SamOptions *from, PetscInt b)
{
  SamHeatLaw *const h    = (SamHeatLaw *)law->data;
  const SamBody     body = SamPairBody(SamElasticityGetPair(law->elasticity), b);
  char              conductivity[32], capacity[32];

  PetscFunctionBegin;
  (void)snprintf(conductivity, sizeof(conductivity), "body%d_conductivity", (int)b + 1);
  (void)snprintf(capacity, sizeof(capacity), "body%d_heat_capacity", (int)b + 1);
  if (isnan(h->conductivity[b])) h->conductivity[b] = (PetscReal)SamBodyConstant(body, "conductivity");
  if (isnan(h->capacity[b]))
    h->capacity[b] = (PetscReal)(SamBodyConstant(body, "density") * SamBodyConstant(body, "specific_heat"));
  PetscCall(SamOptionsRequire(from, isfinite(h->conductivity[b]), conductivity,
                              "required by -heat steady: the thermal conductivity, W/(m K)"));
  PetscCall(SamOptionsRequire(from, isfinite(h->capacity[b]), capacity,
                              "required by -heat steady: density times specific heat, J/(m3 K)"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a change by temperature: three numbers, or none; `what` names what they do. */
static PetscErrorCode ReadChange(const SamOptions *from, const SamOptionRow *row, const char what[],
                                 PetscReal change[SAM_HEAT_CHANGES], PetscInt *n)
{
  PetscFunctionBegin;
  PetscCall(SamOptionsReals(from, row, change, n));
  if (!*n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOptionsNeed(from, PETSC_TRUE, row->name, NEEDED));
  PetscCheck(*n == SAM_HEAT_CHANGES && change[SAM_HEAT_OVER] > 0, from->comm, SAM_ERR_USER,
             "-%s%s: expected three numbers, %s from the temperature T0 to T0 + dT, dT > 0", SamOptionsPrefix(from),
             row->name, what);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads how friction depends on temperature. */
static PetscErrorCode ReadFriction(SamHeatLaw *h, const SamOptions *from)
{
  static const SamOptionRow row      = {"friction_temperature",
                                        "T0,dT,dmu: friction changes linearly by dmu from T0 to T0 + dT (K)",
                                        SAM_OPTION_REAL, .size = SAM_HEAT_CHANGES, .range = SAM_RANGE_ANY};
  PetscReal                 friction = 0;
  PetscBool                 given;

  PetscFunctionBegin;
  PetscCall(ReadChange(from, &row, "T0,dT,dmu: friction changes by dmu", h->change, &h->changes));
  if (!h->changes || h->change[SAM_HEAT_CHANGE] == 0) {
    h->changes = 0;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscOptionsGetReal(NULL, from->prefix, "-friction", &friction, &given));
  PetscCheck(!given || friction + h->change[SAM_HEAT_CHANGE] >= 0, from->comm, SAM_ERR_USER,
             "-%s%s: the coefficient of friction, %.6g, falls below 0: expected a change of at least %.6g",
             SamOptionsPrefix(from), row.name, (double)friction, (double)-friction);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads how wear depends on temperature. */
static PetscErrorCode ReadWear(SamHeatLaw *h, const SamOptions *from)
{
  static const char *const  coefficients[] = {"wear_coefficient1", "wear_coefficient2", "wear_energy1", "wear_energy2"};
  static const SamOptionRow row   = {"wear_temperature", "T0,dT,f: coefficients of wear change linearly to f times (K)",
                                     SAM_OPTION_REAL, .size = SAM_HEAT_CHANGES, .range = SAM_RANGE_ANY};
  PetscBool                 wears = PETSC_FALSE, given;

  PetscFunctionBegin;
  PetscCall(ReadChange(from, &row, "T0,dT,f: coefficients of wear go to f times", h->wear, &h->wears));
  if (!h->wears) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 4; k++) {
    PetscCall(SamOptionsHas(from, coefficients[k], &given));
    wears = wears || given;
  }
  PetscCheck(wears, from->comm, SAM_ERR_USER,
             "-%s%s is given without a coefficient of wear: give -wear_coefficient1, or another one, or omit it",
             SamOptionsPrefix(from), row.name);
  PetscCheck(h->wear[SAM_HEAT_CHANGE] >= 0, from->comm, SAM_ERR_USER,
             "-%s%s: a factor of %.6g on the coefficients of wear: expected a number from 0 on", SamOptionsPrefix(from),
             row.name, (double)h->wear[SAM_HEAT_CHANGE]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses bodies whose temperatures are not those of half-spaces, or never become steady. */
static PetscErrorCode CheckBodies(SamLaw law, const SamHeatLaw *h, const SamOptions *from)
{
  const SamElasticityTraits traits = SamElasticityGetTraits(law->elasticity);
  const char *const         prefix = SamOptionsPrefix(from);

  PetscFunctionBegin;
  PetscCheck(!traits.periodic, from->comm, SAM_ERR_USER,
             "-%sheat steady with periodic bodies: they have no steady state: use -elasticity halfspace or plane",
             prefix);
  PetscCheck(!traits.patch, from->comm, SAM_ERR_USER,
             "-%sheat steady with -%sbody1_compliance or -%sbody2_compliance: the temperature is that of half-spaces: "
             "omit one of them",
             prefix, prefix, prefix);
  PetscCheck(SamPairIsUniform(SamElasticityGetPair(law->elasticity)), from->comm, SAM_ERR_USER,
             "-%sheat steady with layers: the temperature is that of bodies of one material: omit one of them", prefix);
  PetscCheck(h->resistance <= MOST_RESISTANCE, from->comm, SAM_ERR_USER,
             "-%sheat_resistance %.6g: expected at most %d m2 K/W, through which hardly any heat flows", prefix,
             (double)h->resistance, MOST_RESISTANCE);
  for (int b = 0; b < 2; b++)
    PetscCheck(fabs((double)h->bulk[b]) <= MOST_TEMPERATURE, from->comm, SAM_ERR_USER,
               "-%sbody%d_bulk_temperature %.6g: expected a temperature within +-%d K", prefix, b + 1,
               (double)h->bulk[b], MOST_TEMPERATURE);
  for (int b = 0; b < 2; b++)
    PetscCheck(!traits.plane || h->speed[b] != 0, from->comm, SAM_ERR_USER,
               "-%sheat steady in plane strain: body %d stands, and has no steady state: give -%sbody%d_speed", prefix,
               b + 1, prefix, b + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  SamHeatLaw *const         h       = (SamHeatLaw *)law->data;
  static const SamOptionRow rolling = {"rolling_speed",
                                       "speed of rolling",
                                       SAM_OPTION_REAL,
                                       offsetof(SamHeatLaw, rolling),
                                       .range   = SAM_RANGE_POSITIVE,
                                       .unit    = "m/s",
                                       .missing = "required by -heat steady with -rolling steady"};

  PetscBool given;

  PetscFunctionBegin;
  PetscCall(ReadFriction(h, from));
  PetscCall(ReadWear(h, from));
  *asked = h->kind == STEADY ? PETSC_TRUE : PETSC_FALSE;
  if (!*asked || SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOptionsHas(from, "rolling_speed", &given));
  PetscCall(SamOptionsNeed(from, given, "rolling_speed", SAM_NEEDS_ROLLING));
  if (SamMotionOf(law->elasticity)->streams) {
    PetscCall(SamOptionsRead(from, NULL, 1, &rolling, h, NULL));
    for (int b = 0; b < 2; b++) h->speed[b] = -h->rolling;
  }
  for (int b = 0; b < 2; b++) PetscCall(TakeMaterial(law, from, b));
  PetscCall(CheckBodies(law, h, from));
  law->ops.back = SamLawNoBack;
  PetscCall(SamHeatLawExpand(law, from));
  law->follows_slip = h->changes ? PETSC_TRUE : PETSC_FALSE;
  if (h->wears) law->named = "wear_temperature";
  if (h->changes) law->named = "friction_temperature";
  law->nonlocal = law->follows_slip;
  if (law->named) law->ops.back = NULL; /* the step depends on the temperature */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  const SamHeatLaw *h = (const SamHeatLaw *)law->data;

  PetscFunctionBegin;
  PetscCall(SamParametersAddText(p, "heat", PETSC_TRUE, "steady"));
  if (h->changes) PetscCall(SamParametersAddReals(p, "friction_temperature", PETSC_TRUE, SAM_HEAT_CHANGES, h->change));
  if (h->wears) PetscCall(SamParametersAddReals(p, "wear_temperature", PETSC_TRUE, SAM_HEAT_CHANGES, h->wear));
  if (h->rolling > 0) PetscCall(SamParametersAddReals(p, "rolling_speed", PETSC_TRUE, 1, &h->rolling));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- memory and results ---- */

static const char *const surfaces[2] = {SAM_TEMPERATURE_1, "temperature_2"}, *const fluxes[2] = {"heat_1", "heat_2"};

enum { MAXIMUM, POWER, SHARE, NUMBERS };

static PetscErrorCode Declare(SamLaw law, SamState state)
{
#define FIELD(name_, unit_, text_, kept_) \
  { \
    .name = name_, .unit = unit_, .text = text_, .components = 1, .generations = 2, .kept = kept_, \
    .result = SAM_RESULT_USUAL, .motion = SAM_STAYS \
  }
  static const SamStateField  factor   = {.name        = SAM_WEAR_FACTOR,
                                          .unit        = "1",
                                          .text        = "coefficients of wear over those without heat",
                                          .components  = 1,
                                          .generations = 2,
                                          .result      = SAM_RESULT_USUAL,
                                          .motion      = SAM_STAYS};
  static const SamStateField  fields[] = {FIELD("temperature_1", "K", "temperature of body 1's surface", PETSC_TRUE),
                                          FIELD("temperature_2", "K", "temperature of body 2's surface", PETSC_FALSE),
                                          FIELD("heat_1", "W/m2", "frictional heat into body 1", PETSC_FALSE),
                                          FIELD("heat_2", "W/m2", "frictional heat into body 2", PETSC_FALSE)};
  static const SamStateNumber numbers[NUMBERS] = {
    {"temperature_max", "K", "maximum temperature in contact", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE,
     SAM_JOIN_LAST, 1},
    {"heat_power", "W", "frictional power", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 1},
    {"heat_share_2", "1", "part of the frictional power that flows into body 2", SAM_NUMBER_REAL, 1, PETSC_FALSE,
     PETSC_TRUE, SAM_JOIN_LAST, 1}};
  PetscInt id;

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(fields) / sizeof(fields[0]); k++)
    PetscCall(SamStateDeclareField(state, &fields[k], &id));
  if (((const SamHeatLaw *)law->data)->wears) PetscCall(SamStateDeclareField(state, &factor, &id));
  for (PetscInt k = 0; k < NUMBERS; k++) {
    SamStateNumber one = numbers[k];

    if (!SamMotionOf(law->elasticity)->streams)
      one.order = 0; /* the power is that of a step: others have another one */
    PetscCall(SamStateDeclareNumber(state, &one, &id));
  }
  PetscCall(SamHeatLawDeclareExpansion(law, state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

static PetscErrorCode Begin(SamLaw law, SamState state, const SamControl *control, PetscReal duration)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;
  PetscBool         first;

  PetscFunctionBegin;
  first = SamStateGetField(state, SamStateFindField(state, surfaces[0]), SAM_COMMITTED) ? PETSC_FALSE : PETSC_TRUE;
  PetscCheck(first || duration > 0 || SamMotionOf(law->elasticity)->streams, law->grid->comm, SAM_ERR_USER,
             "-heat steady: a step at the time %.6g s, which is not later than the step before: the power is the work "
             "of a step over its time: give times that rise",
             (double)control->time);
  h->duration  = first ? PetscMax(control->time, 0) : duration; /* the first step begins at time 0 */
  h->failed[0] = '\0';
  h->clipped   = PETSC_FALSE;
  h->solving   = PETSC_TRUE;
  PetscCall(VecDestroy(&h->start));
  PetscCall(SamHeatLawBeginExpansion(law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out whether the step has frictional work, but no duration. */
static PetscErrorCode FindTimeless(SamLaw law, const SamLawStep *step)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;
  PetscReal         most;

  PetscFunctionBegin;
  h->timeless = PETSC_FALSE;
  if (SamMotionOf(law->elasticity)->streams || h->duration > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecMax(step->field[SamHeatLawUses(law)], NULL, &most));
  h->timeless = most > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the maximum temperature of both surfaces in contact; NAN without contact. */
static PetscErrorCode FindMaximum(const SamLawStep *step, const Vec surface[2], double *most)
{
  const double *p, *t;

  PetscFunctionBegin;
  *most = -INFINITY;
  PetscCall(VecGetArrayRead(step->pressure, &p));
  for (int b = 0; b < 2; b++) {
    PetscCall(VecGetArrayRead(surface[b], &t));
    for (PetscInt k = 0; k < step->grid->cells; k++)
      if (p[k] > 0) *most = PetscMax(*most, t[k]);
    PetscCall(VecRestoreArrayRead(surface[b], &t));
  }
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(SamMax(step->grid->comm, 1, most));
  if (isinf(*most)) *most = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the factor on the coefficients of wear by the temperature of body 1, which in contact is that of both. */
static PetscErrorCode SetWearFactor(SamLaw law, SamState state, Vec temperature)
{
  const SamHeatLaw     *h      = (const SamHeatLaw *)law->data;
  const SamHeatFriction change = {h->wear[SAM_HEAT_FROM], h->wear[SAM_HEAT_OVER], h->wear[SAM_HEAT_CHANGE] - 1};
  const double         *t;
  double               *f, ignored;
  Vec                   factor;

  PetscFunctionBegin;
  if (!h->wears) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStateSetField(state, SamStateFindField(state, SAM_WEAR_FACTOR), &factor));
  PetscCall(VecGetArrayRead(temperature, &t));
  PetscCall(VecGetArrayWrite(factor, &f));
  for (PetscInt k = 0; k < law->grid->cells; k++) f[k] = 1 + SamHeatFrictionAt(&change, t[k], &ignored);
  PetscCall(VecRestoreArrayWrite(factor, &f));
  PetscCall(VecRestoreArrayRead(temperature, &t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;
  double   *numbers   = SamStateNumbers(step->state, SamStateFindNumber(step->state, "temperature_max"), SAM_TRIED);
  Vec       surface[2], heat, into_body[2];
  PetscReal power[3], into[3];
  char      failed[192];

  PetscFunctionBegin;
  PetscCall(SamHeatLawPrepare(law));
  for (int b = 0; b < 2; b++)
    PetscCall(SamStateSetField(step->state, SamStateFindField(step->state, surfaces[b]), &surface[b]));
  for (int b = 0; b < 2; b++)
    PetscCall(SamStateSetField(step->state, SamStateFindField(step->state, fluxes[b]), &into_body[b]));
  PetscCall(SamGridCreateVec(step->grid, 1, &heat));
  PetscCall(SamHeatLawFill(law, step->pressure, step->field[SamHeatLawUses(law)], step->bound, heat));
  PetscCall(
    SamHeatTemperatures(&h->pair, step->pressure, heat, h->bulk, into_body[1], surface, failed, sizeof(failed)));
  PetscCall(VecWAXPY(into_body[0], -1, into_body[1], heat));
  PetscCall(SetWearFactor(law, step->state, surface[0]));
  if (h->failed[0] || failed[0])
    (void)snprintf(step->failed, sizeof(step->failed), "%s", h->failed[0] ? h->failed : failed);
  PetscCall(SamBalanceGetLoads(step->grid, SAM_BALANCE_NORMAL, heat, power)); /* sums over the area, W */
  PetscCall(FindTimeless(law, step));
  PetscCall(SamHeatLawKeepPowers(law, step, power[0]));
  PetscCall(SamBalanceGetLoads(step->grid, SAM_BALANCE_NORMAL, into_body[1], into));
  PetscCall(FindMaximum(step, surface, &numbers[MAXIMUM]));
  numbers[POWER] = (double)power[0];
  numbers[SHARE] = power[0] > 0 ? (double)(into[0] / power[0]) : NAN;
  PetscCall(SamHeatLawKeepExpansion(law, step, into_body));
  h->solving = PETSC_FALSE;
  PetscCall(VecDestroy(&heat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View(SamLaw law, SamState state, PetscViewer viewer)
{
  const double *numbers = SamStateReadNumbers(state, SamStateFindNumber(state, "temperature_max"));
  const char   *unit    = SamStateUnitOf(state, "heat_power");

  PetscFunctionBegin;
  (void)law;
  if (isnan(numbers[MAXIMUM]))
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  none, as there is no contact\n", "heat"));
  else if (numbers[POWER] > 0 && !(numbers[SHARE] >= 0 && numbers[SHARE] <= 1)) /* by different bulk temperatures */
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "  %-10s  %.6g %s of friction; %.6g %s flow into body 2, at most %.6g K in contact\n", "heat",
      numbers[POWER], unit, numbers[SHARE] * numbers[POWER], unit, numbers[MAXIMUM]));
  else if (numbers[POWER] > 0)
    PetscCall(
      PetscViewerASCIIPrintf(viewer, "  %-10s  %.6g %s, of which %.6g %s flow into body 2, at most %.6g K in contact\n",
                             "heat", numbers[POWER], unit, numbers[SHARE] * numbers[POWER], unit, numbers[MAXIMUM]));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  no frictional power, at most %.6g K in contact\n", "heat",
                                     numbers[MAXIMUM]));
  PetscCall(SamHeatLawViewExpansion(law, state, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Summarizes the hottest step. */
static void Summarize(SamLaw law, SamState state, PetscInt step, PetscReal *weight, char text[], size_t size)
{
  const double *numbers     = SamStateReadNumbers(state, SamStateFindNumber(state, "temperature_max"));
  char          divided[64] = "";

  (void)law;
  if (isnan(numbers[MAXIMUM])) return;
  *weight = numbers[MAXIMUM];
  if (numbers[SHARE] >= 0 && numbers[SHARE] <= 1) /* else the bodies heat or cool each other */
    (void)snprintf(divided, sizeof(divided), " (%.1f %% into body 1, %.1f %% into body 2)", 100 * (1 - numbers[SHARE]),
                   100 * numbers[SHARE]);
  (void)snprintf(text, size, "at most %.4g K in contact, in step %" PetscInt_FMT ", by %.4g %s of friction%s",
                 numbers[MAXIMUM], step, numbers[POWER], SamStateUnitOf(state, "heat_power"), divided);
}

static PetscErrorCode Advise(SamLaw law, SamState state, char text[], size_t size)
{
  const SamHeatLaw *h       = (const SamHeatLaw *)law->data;
  double            clipped = h->clipped ? 1 : 0;

  PetscFunctionBegin;
  text[0] = '\0';
  PetscCall(SamMax(law->grid->comm, 1, &clipped));
  if (clipped > 0)
    (void)snprintf(text, size,
                   "-friction_temperature makes the coefficient of friction negative, where it is taken for 0: check "
                   "dmu, %g",
                   (double)h->change[SAM_HEAT_CHANGE]);
  else if (h->timeless)
    (void)snprintf(text, size,
                   "the first step has no duration, so that its frictional work makes no heat: give the first row of "
                   "the history a time above 0");
  else
    SamHeatLawAdviseSpeeds(h, SamStateUnitOf(state, "heat_power"), text, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamLaw law)
{
  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) PetscCall(SamConductorDestroy(&((SamHeatLaw *)law->data)->pair.body[b]));
  PetscCall(VecDestroy(&((SamHeatLaw *)law->data)->start));
  PetscCall(SamHeatLawDestroyExpansion(law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Heat(SamLaw law)
{
  SamHeatLaw *h;

  PetscFunctionBegin;
  PetscCall(PetscNew(&h));
  for (int b = 0; b < 2; b++) h->conductivity[b] = h->capacity[b] = NAN;
  h->rolling                     = NAN;
  law->data                      = h;
  law->option                    = "heat";
  law->heading                   = "Frictional heat";
  law->rows                      = rows;
  law->row_count                 = sizeof(rows) / sizeof(rows[0]);
  law->bytes                     = 112;
  law->needs_friction            = PETSC_TRUE;
  law->any_motion                = PETSC_TRUE;
  law->forbids_jumps             = PETSC_TRUE;
  law->ops.setfromoptions        = SetFromOptions;
  law->ops.addparameters         = AddParameters;
  law->ops.declare               = Declare;
  law->ops.begin                 = Begin;
  law->ops.bound                 = SamHeatLawBound;
  law->ops.advance               = Advance;
  law->ops.view                  = View;
  law->ops.summarize             = Summarize;
  law->ops.advise                = Advise;
  law->ops.destroy               = Destroy;
  law->uses[SamHeatLawUses(law)] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
