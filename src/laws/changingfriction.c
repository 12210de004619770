/*
  Friction that changes: with the accumulated slip, with the pressure, or with the velocity of slip in rolling. The
  bound b = mu p of Coulomb's law, which acts first, becomes F b + (1 - F) low p in each cell.

  slip_path  F = exp(-L/length), low = final; L is the slip under pressure of all committed steps: the friction of a
  step follows from the steps before it, with an error of first order in its slip.
  pressure   F = (p/reference)^exponent, low = 0; b is not more than a limit.
  falling    F = 2^(-speed/half speed), low = kinetic, if a step rolls; the speed is the rolling speed times slip over
  rolled distance. With a memory F = t F_before + (1 - t) F_now, t = memory/(memory + slip), the slip being at least the
  memory's speed times the step's time. The bound depends on the slip of the step, and there may be more than one
  solution. In steady rolling a cell is a step of the material: the slip is that over dx, and F_before that of the cell
  ahead; it is 1 at the leading edge.
  Source of falling friction: Vollebregt and Schuttelaars 2012, J. Sound Vib. 331, 2141-2155.
*/
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/pressed.h>
#include <petsam/private/base.h>
#include <math.h>

typedef enum { PATH, PRESSURE, FALLING, KINDS } Kind;
enum { FINAL, LENGTH };
enum { EXPONENT, REFERENCE, LIMIT };
enum { KINETIC, HALF, SPEED, MEMORY, SLOWEST, OPTIONS };

typedef struct {
  Kind                kind;
  PetscReal           value[OPTIONS];
  const SamCondition *scale; /* condition of the law coulomb */
  PetscReal cell; /* rolled distance of a cell, m, where what is remembered stands in the cell ahead; 0: in the state */
} Friction;

#define REAL(place, name, word, text, values, ...) \
  { \
    "friction_" name, word ": " text, SAM_OPTION_REAL, offsetof(Friction, value[place]), \
      .range = values, .needs = "friction_law " word, .missing = "required by -friction_law " word, \
      .recorded = PETSC_TRUE, __VA_ARGS__ \
  }
/* A kind: its type of law, its keyword of -friction_law, usual values (NAN: required), and its memory, or NULL */
static const struct {
  const char   *type, *word;
  SamOptionRow  row[OPTIONS];
  PetscReal     usual[OPTIONS];
  SamStateField memory;
} kinds[KINDS] = {
  {SAM_LAW_SLIP_DEPENDENT,
   "slip_path",
   {REAL(FINAL, "path_final", "slip_path", "coefficient after long slip", SAM_RANGE_NONNEGATIVE, .unit = NULL),
    REAL(LENGTH, "path_length", "slip_path", "slip () after which 1/e of the change is left", SAM_RANGE_POSITIVE,
         .unit = "m")},
   {NAN, NAN},
   {"friction_path", "m", "slip under pressure, over all steps", 1, 2, PETSC_TRUE, PETSC_FALSE, SAM_RESULT_OFFERED,
    SAM_MOVES, 0, PETSC_FALSE}},
  {SAM_LAW_PRESSURE_FRICTION,
   "pressure",
   {REAL(EXPONENT, "pressure_exponent", "pressure", "exponent of p over the reference, > -1", SAM_RANGE_ANY,
         .unit = NULL),
    REAL(REFERENCE, "pressure_reference", "pressure", "where the coefficient is -friction", SAM_RANGE_POSITIVE,
         .unit = "Pa"),
    REAL(LIMIT, "shear_limit", "pressure", "maximum shear", SAM_RANGE_POSITIVE_INF, .unit = "Pa")},
   {0, 1, INFINITY},
   {.name = NULL}},
  {SAM_LAW_FALLING_FRICTION,
   "falling",
   {REAL(KINETIC, "falling_kinetic", "falling", "coefficient at high speed", SAM_RANGE_NONNEGATIVE, .unit = NULL),
    REAL(HALF, "falling_half_speed", "falling", "slip velocity () of half the change", SAM_RANGE_POSITIVE,
         .unit = "m/s"),
    {"rolling_speed", "speed of rolling, for falling friction, heat or bodies that relax", SAM_OPTION_REAL,
     offsetof(Friction, value[SPEED]), .range = SAM_RANGE_POSITIVE, .unit = "m/s",
     .needs   = "friction_law falling or -heat steady or -body1_relax_moduli or -body2_relax_moduli",
     .missing = "required by -friction_law falling", .recorded = PETSC_TRUE},
    REAL(MEMORY, "falling_memory", "falling", "slip () of the memory, 0: none", SAM_RANGE_NONNEGATIVE, .unit = "m"),
    REAL(SLOWEST, "falling_memory_speed", "falling", "least slip velocity for the memory", SAM_RANGE_NONNEGATIVE,
         .unit = "m/s")},
   {NAN, NAN, NAN, 0, 0},
   {"friction_fallen", "1", "part of the change of friction that is reached", 1, 2, PETSC_TRUE, PETSC_FALSE,
    SAM_RESULT_OFFERED, SAM_MOVES, 0, PETSC_FALSE}}};

/* The mean coefficient of the solution that was found; there may be several solutions */
static const SamStateNumber branch = {"friction_mean",
                                      "1",
                                      "mean coefficient of friction (solution branch continued from rest; others may "
                                      "exist)",
                                      SAM_NUMBER_REAL,
                                      1,
                                      PETSC_FALSE,
                                      PETSC_TRUE,
                                      SAM_JOIN_LAST,
                                      0};

/* ---- options ---- */

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  const Friction *f = (const Friction *)law->data;
  PetscBool       given;

  PetscFunctionBegin;
  if (f->kind != PRESSURE || !*asked) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOptionsHas(from, "friction_pressure_reference", &given));
  PetscCall(SamOptionsRequire(from, given || f->value[EXPONENT] == 0 || SamPrintHelp(), "friction_pressure_reference",
                              "required by -friction_pressure_exponent"));
  PetscCheck(f->value[EXPONENT] > -1, from->comm, SAM_ERR_USER,
             "-%sfriction_pressure_exponent %.6g: expected a number > -1", SamOptionsPrefix(from),
             (double)f->value[EXPONENT]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddConditions(SamLaw law, SamConditions conditions)
{
  PetscFunctionBegin;
  ((Friction *)law->data)->scale = SamConditionsFind(conditions, SAM_FRICTION_SCALE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- memory and results ---- */

static PetscErrorCode ComputeCoefficient(void *owner, SamState state, PetscInt component, Vec coefficient)
{
  const Vec p = SamStateReadField(state, SamStateFindField(state, "pressure")),
            b = SamStateReadField(state, SamStateFindField(state, "bound"));

  PetscFunctionBegin;
  (void)owner;
  (void)component;
  PetscCall(VecSet(coefficient, 0));
  if (p && b) PetscCall(VecPointwiseDivide(coefficient, b, p)); /* 0 if p is 0 */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  const Friction      *f           = (const Friction *)law->data;
  const SamStateField *memory      = &kinds[f->kind].memory;
  const SamStateResult coefficient = {"friction_coefficient",
                                      "1",
                                      "coefficient of friction",
                                      SAM_FIELD_REAL,
                                      SAM_RESULT_OFFERED,
                                      ComputeCoefficient,
                                      law,
                                      0,
                                      -1};
  PetscInt             id;

  PetscFunctionBegin;
  if (memory->name && f->cell == 0) PetscCall(SamStateDeclareField(state, memory, &id));
  if (f->cell > 0 && law->follows_slip) PetscCall(SamStateDeclareNumber(state, &branch, &id));
  PetscCall(SamStateOffer(state, &coefficient));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the bound ---- */

/* Returns the factor F for the memory and the slip of the step, and its derivative by this slip. */
static double FactorOf(const Friction *f, double p, double memory, double slip, double rolled, double *by_slip)
{
  const PetscReal *v = f->value;
  double           now, t, rate;

  *by_slip = 0;
  if (f->kind == PATH) return exp(-memory / v[LENGTH]);
  if (f->kind == PRESSURE) return pow(p / v[REFERENCE], v[EXPONENT]);
  if (rolled == 0) return 1 - memory;
  rate     = M_LN2 * v[SPEED] / (rolled * v[HALF]);
  now      = exp(-rate * slip);
  t        = v[MEMORY] > 0 ? v[MEMORY] / (v[MEMORY] + PetscMax(slip, v[SLOWEST] * rolled / v[SPEED])) : 0;
  *by_slip = -(1 - t) * rate * now;
  if (v[MEMORY] > 0 && slip > v[SLOWEST] * rolled / v[SPEED]) *by_slip -= t * t / v[MEMORY] * (1 - memory - now);
  return t * (1 - memory) + (1 - t) * now;
}

static void BoundCell(const Friction *f, const SamBoundAt *at, double scale, double p, double memory, double slip,
                      double *value, double *by_pressure, double *by_slip)
{
  const double low   = scale * (f->kind == PATH ? f->value[FINAL] : f->kind == FALLING ? f->value[KINETIC] : 0);
  const double steep = f->kind == PRESSURE ? 1 + f->value[EXPONENT] : 1;
  double       change;
  const double factor = FactorOf(f, p, memory, slip, at->rolled, &change);
  const double bound  = factor * (value ? *value : *by_pressure * p) + (1 - factor) * low * p;
  const double most   = f->kind == PRESSURE ? f->value[LIMIT] : INFINITY;

  if (by_slip) *by_slip = factor * *by_slip + change * (*value - low * p);
  if (by_pressure) *by_pressure = bound > most ? 0 : steep * factor * *by_pressure + (1 - factor) * low;
  if (value) *value = PetscMin(bound, most);
}

static PetscErrorCode Bound(SamLaw law, const SamBoundAt *given, const SamBound *bound)
{
  const Friction *f     = (const Friction *)law->data;
  const PetscInt  cells = law->grid->cells;
  const char     *name  = f->cell > 0 ? NULL : kinds[f->kind].memory.name;
  const double    scale = SamControlGet(given->control, f->scale);
  const double    step  = f->cell > 0 ? (double)f->cell : 1; /* slip of a step per unit of the given slip */
  SamBoundAt of = *given, *const at = &of;
  const Vec in[]        = {at->pressure, at->slip,
                    name && at->state ? SamStateGetField(at->state, SamStateFindField(at->state, name), SAM_COMMITTED)
                                             : NULL},
            out[]       = {bound->value, bound->by_pressure, bound->by_slip};
  const double *from[3] = {NULL};
  double       *to[3] = {NULL}, memory = 0, change;

  PetscFunctionBegin;
  if (f->cell > 0) at->rolled = f->cell;
  for (int k = 0; k < 3; k++) {
    if (in[k]) PetscCall(VecGetArrayRead(in[k], &from[k]));
    if (out[k]) PetscCall(VecGetArray(out[k], &to[k]));
  }
  for (PetscInt n = 0; n < cells; n++) {
    const PetscInt k = cells - 1 - n; /* from the leading edge on */
    const double   p = from[0][k], slip = in[1] ? step * from[1][k] : 0;

    if (f->cell == 0 || n % law->grid->nx == 0) memory = in[2] ? from[2][k] : 0;
    if (p > 0)
      BoundCell(f, at, scale, p, memory, slip, out[0] ? &to[0][k] : NULL, out[1] ? &to[1][k] : NULL,
                out[2] ? &to[2][k] : NULL);
    if (f->cell > 0) memory = p > 0 ? 1 - FactorOf(f, p, memory, slip, at->rolled, &change) : 0;
  }
  for (int k = 0; k < 3; k++) {
    if (out[k]) PetscCall(VecRestoreArray(out[k], &to[k]));
    if (in[k]) PetscCall(VecRestoreArrayRead(in[k], &from[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the slip under pressure to the memory; for falling friction, replaces the memory by the new factor. */
static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const Friction *f      = (const Friction *)law->data;
  const PetscInt  id     = kinds[f->kind].memory.name ? SamStateFindField(step->state, kinds[f->kind].memory.name) : -1;
  const double    rolled = (double)step->rolled;
  const double   *p, *slip, *old = NULL;
  double *new, change;
  PetscReal sums[2];
  Vec       before, after, path;

  PetscFunctionBegin;
  if (f->cell > 0 && law->follows_slip) {
    PetscCall(SamGridNorm(law->grid, SamStateReadField(step->state, SamStateFindField(step->state, "bound")), NORM_1,
                          &sums[0]));
    PetscCall(SamGridNorm(law->grid, step->pressure, NORM_1, &sums[1]));
    *SamStateNumbers(step->state, SamStateFindNumber(step->state, branch.name), SAM_TRIED) =
      sums[1] > 0 ? (double)(sums[0] / sums[1]) : NAN;
  }
  if (id < 0 || (f->kind == FALLING && rolled == 0)) PetscFunctionReturn(PETSC_SUCCESS);
  before = SamStateGetField(step->state, id, SAM_COMMITTED);
  path   = step->field[SAM_USE_PATH];
  PetscCall(SamStateSetField(step->state, id, &after));
  PetscCall(VecGetArrayRead(step->pressure, &p));
  PetscCall(VecGetArrayRead(path, &slip));
  if (before) PetscCall(VecGetArrayRead(before, &old));
  PetscCall(VecGetArrayWrite(after, &new));
  for (PetscInt k = 0; k < law->grid->cells; k++) {
    const double was = old ? old[k] : 0;

    new[k] = f->kind == PATH      ? was + (SamIsPressed(p[k]) ? slip[k] : 0)
             : SamIsPressed(p[k]) ? 1 - FactorOf(f, p[k], was, slip[k], rolled, &change)
                                  : 0;
  }
  PetscCall(VecRestoreArrayWrite(after, &new));
  if (before) PetscCall(VecRestoreArrayRead(before, &old));
  PetscCall(VecRestoreArrayRead(path, &slip));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the types ---- */

PetscErrorCode SamLawCreate_Friction(SamLaw law)
{
  Friction *f;
  Kind      kind = PATH;

  PetscFunctionBegin;
  while (strcmp(law->type, kinds[kind].type)) kind++;
  PetscCall(PetscNew(&f));
  f->kind = kind;
  f->cell = SamMotionOf(law->elasticity)->streams ? law->grid->dx : 0;
  PetscCall(PetscArraycpy(f->value, kinds[kind].usual, OPTIONS));
  law->data   = f;
  law->option = "friction_law";
  law->word   = kinds[kind].word;
  law->rows   = kinds[kind].row;
  while (law->row_count < OPTIONS && law->rows[law->row_count].name) law->row_count++;
  law->bytes              = kinds[kind].memory.name ? 16 : 0;
  law->needs_friction     = PETSC_TRUE;
  law->follows_slip       = kind == FALLING;
  law->any_motion         = kind != PATH;
  law->forbids_jumps      = kinds[kind].memory.name && f->cell == 0; /* a steady state has no memory */
  law->ops.setfromoptions = SetFromOptions;
  law->ops.conditions     = AddConditions;
  law->uses[SAM_USE_PATH] = PETSC_TRUE;
  law->ops.declare        = Declare;
  law->ops.bound          = Bound;
  law->ops.advance        = Advance;
  PetscFunctionReturn(PETSC_SUCCESS);
}
