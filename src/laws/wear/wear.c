/*
  The laws of wear: their memory, the separation that follows from it, and their advance in a step.

  If the surfaces slide past each other, each body has a wear load at its own points. A step wears by the mean of the
  pressures before and after it. The wear of body 2 by each pressure is written at the points where its surface was
  read under that pressure, by the transpose of reading.
*/
#include "wearimpl.h"
#include <petsam/private/motionimpl.h>
#include <petsam/private/solverimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/problem.h>
#include <petsam/private/wear.h>

#define WEARS  "wears"       /* 1 if the step added to the wear load, 0 in cycles */
#define STRIDE "wear_stride" /* slide of the step relative to the length of the contact along it */

PetscBool SamLawIsWear(SamLaw law)
{
  return !strcmp(law->type, SAM_LAW_ARCHARD) || !strcmp(law->type, SAM_LAW_ENERGY);
}

PetscErrorCode SamWearFind(SamProblem problem, SamLaw *law)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  *law = NULL;
  PetscCall(SamProblemGetLaws(problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    if (SamLawIsWear(laws[k])) *law = laws[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawSetWear(SamLaw law, const PetscReal coefficient[2])
{
  SamWear *w;

  PetscFunctionBegin;
  SamValidHandle(law, SamLaw, 1);
  SamValidPointer(coefficient, 2);
  PetscCheck(SamLawIsWear(law), law->grid->comm, PETSC_ERR_ARG_WRONG, "The law %s has no coefficients of wear",
             law->type);
  for (int body = 0; body < 2; body++)
    PetscCheck(coefficient[body] >= 0 && isfinite(coefficient[body]), law->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "wear coefficient %.6g of body %d: expected a finite number >= 0", (double)coefficient[body], body + 1);
  w = (SamWear *)law->data;
  PetscCall(PetscArraycpy(w->coefficient, coefficient, 2));
  for (int body = 0; body < 2; body++) law->of_body[body] = coefficient[body] > 0;
  law->revision++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- options ---- */

#define ROW(name, text, body, ...) \
  { \
    name #body, text " of body " #body, SAM_OPTION_REAL, offsetof(SamWear, coefficient[body - 1]), \
      .range = SAM_RANGE_NONNEGATIVE, .recorded = PETSC_TRUE, __VA_ARGS__ \
  }
#define ARCHARD(body) \
  ROW("wear_coefficient", "Archard's wear, depth = k p |ds|: k ()", body, .unit = "1/Pa", \
      .excludes = "wear_energy1,wear_energy2")
#define ENERGY(body) ROW("wear_energy", "wear by energy, depth = alpha |q.ds|: alpha ()", body, .unit = "m3/J")
static const SamOptionRow rows[2][2]      = {{ARCHARD(1), ARCHARD(2)}, {ENERGY(1), ENERGY(2)}};
static const char *const  coefficients[2] = {"wear_coefficient", "wear_energy"}; /* of both bodies together */

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  const SamWear *w = (const SamWear *)law->data;

  PetscFunctionBegin;
  (void)from;
  *asked = w->coefficient[0] + w->coefficient[1] > 0;
  for (int body = 0; body < 2; body++) law->of_body[body] = w->coefficient[body] > 0;
  law->option = law->rows[w->coefficient[0] > 0 ? 0 : 1].name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  PetscFunctionBegin;
  PetscCall(SamParametersAddText(p, "wear", PETSC_TRUE, ((const SamWear *)law->data)->jumps ? "cycles" : "steps"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- memory ---- */

/* Returns the field of a body's wear load: the same one for both, unless they slide. */
static PetscInt LoadFieldOf(SamState state, PetscInt body)
{
  const PetscInt id = body ? SamStateFindField(state, SAM_WEAR_LOAD2) : -1;

  return id >= 0 ? id : SamStateFindField(state, SAM_WEAR_LOAD);
}

/* Computes the depth. Interpolation leaves depths slightly below 0; these stay in the state to conserve the volume. */
static PetscErrorCode ComputeDepth(void *owner, SamState state, PetscInt body, Vec depth)
{
  const SamLaw law  = (SamLaw)owner;
  const Vec    load = SamStateReadField(state, LoadFieldOf(state, body));
  double      *to;

  PetscFunctionBegin;
  if (load)
    PetscCall(VecCopy(load, depth));
  else
    PetscCall(VecSet(depth, 0));
  PetscCall(VecScale(depth, ((const SamWear *)law->data)->coefficient[body]));
  PetscCall(VecGetArray(depth, &to));
  for (PetscInt k = 0; k < law->grid->cells; k++) to[k] = PetscMax(to[k], 0);
  PetscCall(VecRestoreArray(depth, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateField
    load    = {.name        = SAM_WEAR_LOAD,
               .components  = 1,
               .generations = 3,
               .kept        = PETSC_TRUE,
               .motion      = SAM_MOVES,
               .separates   = PETSC_TRUE},
    load1   = {.name = SAM_WEAR_LOAD, .components = 1, .generations = 3, .kept = PETSC_TRUE, .separates = PETSC_TRUE},
    load2   = {.name = SAM_WEAR_LOAD2, .components = 1, .generations = 3, .kept = PETSC_TRUE, .separates = PETSC_TRUE},
    cycle   = {.name = SAM_WEAR_CYCLE, .components = 1, .generations = 2},
    path    = {.name = SAM_WEAR_PATH, .components = 1, .generations = 2},
    stripes = {.name = SAM_WEAR_STRIPES, .components = 1, .generations = 2, .kept = PETSC_TRUE, .optional = PETSC_TRUE};
  static const SamStateNumber number[] = {
    {"wear_volume1", "m3", "volume removed of body 1", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 2},
    {"wear_volume2", "m3", "volume removed of body 2", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 2},
    {"wear_excess", "1", "wear of the step relative to the stability limit", SAM_NUMBER_REAL, 1, PETSC_FALSE,
     PETSC_FALSE, SAM_JOIN_GREATEST, 0},
    {WEARS, "1", "whether the step added to the wear load", SAM_NUMBER_INT, 1, PETSC_TRUE, PETSC_FALSE, SAM_JOIN_LAST,
     0},
    {STRIDE, "1", "slide of the step relative to the length of the contact", SAM_NUMBER_REAL, 1, PETSC_FALSE,
     PETSC_FALSE, SAM_JOIN_GREATEST, 0}};
  SamStateResult depth[2] = {
    {"wear_depth1", "m", "depth removed of body 1", SAM_FIELD_REAL, SAM_RESULT_USUAL, ComputeDepth, law, 0, -1},
    {"wear_depth2", "m", "depth removed of body 2", SAM_FIELD_REAL, SAM_RESULT_USUAL, ComputeDepth, law, 1, -1}};
  PetscReal       slide[2];
  const PetscBool own = SamFramesGetSlide(state, SAM_TRIED, slide), slides = law->of_body[1] && own;
  PetscInt        id;

  PetscFunctionBegin;
  if (own) depth[0].text = "depth removed of body 1, at its own points: those that lay under the cells at rolled 0";
  if (slides)
    depth[1].text = "depth removed of body 2, at its own points: those that lay under the cells at rolled and slide 0";
  PetscCall(SamStateDeclareField(state, own ? &load1 : &load, &id)); /* at own points it is never moved */
  if (slides) PetscCall(SamStateDeclareField(state, &load2, &id));
  if (slides) PetscCall(SamStateDeclareField(state, &stripes, &id));
  PetscCall(SamStateDeclareField(state, &cycle, &id));
  PetscCall(SamStateDeclareField(state, &path, &id));
  for (int k = 0; k < 5; k++) PetscCall(SamMotionDeclareNumber(SamMotionOf(law->elasticity), state, &number[k], &id));
  for (int k = 0; k < 2; k++) PetscCall(SamStateOffer(state, &depth[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Returns the wear load that opens the gap. The wear of a step opens it from the next step on: a tried solution has the
  committed load, and a committed solution the load before its step, if that wore.
*/
static Vec LoadOf(SamState state, SamGeneration generation, PetscInt body)
{
  const PetscInt id = LoadFieldOf(state, body);

  if (id < 0) return NULL;
  if (generation == SAM_TRIED && !SamStateGetField(state, id, SAM_TRIED) &&
      *SamStateReadNumbers(state, SamStateFindNumber(state, WEARS)) > 0)
    return SamStateGetField(state, id, SAM_BEFORE);
  return SamStateGetField(state, id, SAM_COMMITTED);
}

/* Adds k times a wear load, read at the places of the body's points, to a separation. */
static PetscErrorCode AddDepth(SamLaw law, SamState state, PetscInt body, double k, Vec load, Vec h)
{
  PetscReal     offset[2];
  Vec           seen = load;
  const double *worn;
  double       *to;

  PetscFunctionBegin;
  if (SamFramesGetOffset(state, SAM_TRIED, body, offset)) {
    PetscCall(SamGridCreateVec(law->grid, 1, &seen));
    PetscCall(SamFramesRead(law->elasticity, offset, load, seen));
  }
  PetscCall(VecGetArrayRead(seen, &worn));
  PetscCall(VecGetArray(h, &to));
  for (PetscInt i = 0; i < law->grid->cells; i++) to[i] = k * worn[i] + to[i];
  PetscCall(VecRestoreArray(h, &to));
  PetscCall(VecRestoreArrayRead(seen, &worn));
  if (seen != load) PetscCall(VecDestroy(&seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Separation(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds)
{
  const SamWear *w    = (const SamWear *)law->data;
  const Vec      load = LoadOf(state, generation, 0), load2 = LoadOf(state, generation, 1);

  PetscFunctionBegin;
  if (!load) PetscFunctionReturn(PETSC_SUCCESS);
  *adds = PETSC_TRUE;
  if (!h) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AddDepth(law, state, 0, w->coefficient[0] + (load2 == load ? w->coefficient[1] : 0), load, h));
  if (load2 != load) PetscCall(AddDepth(law, state, 1, w->coefficient[1], load2, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetVolumes(SamLaw law, Vec load, Vec load2, PetscReal volume[2], PetscReal depth[2])
{
  const SamWear  *w      = (const SamWear *)law->data;
  const PetscReal length = SamMotionOf(law->elasticity)->streams ? law->grid->width[0] : 1;
  PetscReal       most = 0, sums[3] = {0};

  PetscFunctionBegin;
  for (int body = 0; body < 2; body++) {
    const Vec one = body ? load2 : load;

    if (one) PetscCall(SamBalanceGetLoads(law->grid, SAM_BALANCE_NORMAL, one, sums));
    if (one) PetscCall(VecMax(one, NULL, &most));
    volume[body] = w->coefficient[body] * sums[0] / length;
    depth[body]  = w->coefficient[body] * most;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

Vec SamWearGetFactor(SamState state)
{
  const PetscInt id = SamStateFindField(state, SAM_WEAR_FACTOR);

  return id < 0 ? NULL : SamStateGetField(state, id, SAM_TRIED);
}

/* ---- a step ---- */

/*
  Computes the part of a step's wear load that is due to the pressure, or the bound of the shear, before the step: half
  of this times the length of the slip. The rest is due to the pressure after it.
*/
static PetscErrorCode FirstPart(SamLaw law, SamLawStep *step, Vec path, Vec load, Vec first)
{
  const char *const name = ((const SamWear *)law->data)->by_energy ? "bound" : "pressure";
  const Vec         from = SamStateGetField(step->state, SamStateFindField(step->state, name), SAM_COMMITTED);
  const double     *before, *way, *worn;
  double           *to;

  PetscFunctionBegin;
  PetscCall(VecSet(first, 0));
  if (!from) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(from, &before));
  PetscCall(VecGetArrayRead(path, &way));
  PetscCall(VecGetArrayRead(load, &worn));
  PetscCall(VecGetArray(first, &to));
  for (PetscInt k = 0; k < law->grid->cells; k++) to[k] = PetscMin(worn[k], 0.5 * before[k] * way[k]);
  PetscCall(VecRestoreArray(first, &to));
  PetscCall(VecRestoreArrayRead(load, &worn));
  PetscCall(VecRestoreArrayRead(path, &way));
  PetscCall(VecRestoreArrayRead(from, &before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multiplies by the factor of the step, if there is one. */
static PetscErrorCode ScaleByFactor(SamState state, Vec load)
{
  const Vec factor = SamWearGetFactor(state);

  PetscFunctionBegin;
  if (factor) PetscCall(VecPointwiseMult(load, load, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a step's wear load to body 1's points, and to the points of body 2 under it before and after the step. */
static PetscErrorCode WearOwn(SamLaw law, SamLawStep *step, Vec path, Vec load)
{
  PetscReal offset[2];
  Vec       part, written;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(law->grid, 1, &part));
  PetscCall(SamGridCreateVec(law->grid, 1, &written));
  if (law->of_body[1]) {
    PetscCall(FirstPart(law, step, path, load, part));
    PetscCall(ScaleByFactor(step->state, part));
  }
  PetscCall(ScaleByFactor(step->state, load));
  (void)SamFramesGetOffset(step->state, SAM_TRIED, 0, offset);
  PetscCall(SamFramesWrite(law->elasticity, offset, load, written));
  PetscCall(SamLawAddToSum(step->state, SAM_WEAR_LOAD, written));
  if (law->of_body[1]) {
    (void)SamFramesGetOffset(step->state, SAM_COMMITTED, 1, offset);
    PetscCall(SamFramesWrite(law->elasticity, offset, part, written));
    PetscCall(SamLawAddToSum(step->state, SAM_WEAR_LOAD2, written));
    PetscCall(VecAYPX(part, -1, load));
    (void)SamFramesGetOffset(step->state, SAM_TRIED, 1, offset);
    PetscCall(SamFramesWrite(law->elasticity, offset, part, written));
    PetscCall(VecAXPY(SamStateReadField(step->state, LoadFieldOf(step->state, 1)), 1, written));
  }
  PetscCall(VecDestroy(&written));
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the wear of the step; in steady rolling, the life adds that of a passage instead. */
static PetscErrorCode AddLoad(SamLaw law, SamLawStep *step)
{
  const SamWear *w = (const SamWear *)law->data;
  PetscReal      slide[2];
  Vec            path = step->field[SAM_USE_PATH], load;

  PetscFunctionBegin;
  if (SamMotionOf(law->elasticity)->streams) {
    PetscCheck(w->jumps, law->grid->comm, SAM_ERR_USER,
               "-%s: in steady rolling wear is that of passages, not of single steps: give -wear_cycles", law->option);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamGridCreateVec(step->grid, 1, &load));
  PetscCall(VecCopy(step->field[w->by_energy ? SAM_USE_WORK : SAM_USE_PRESSED], load));
  PetscCall(VecAbs(load));
  if (!w->jumps && SamFramesGetSlide(step->state, SAM_TRIED, slide))
    PetscCall(WearOwn(law, step, path, load));
  else {
    PetscCall(ScaleByFactor(step->state, load));
    PetscCall(SamLawAddToSum(step->state, w->jumps ? SAM_WEAR_CYCLE : SAM_WEAR_LOAD, load));
  }
  if (w->jumps) PetscCall(SamLawAddToSum(step->state, SAM_WEAR_PATH, path));
  PetscCall(VecDestroy(&load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the slide of the step relative to the contact, if body 2 wears at its own points; else 0. */
static PetscErrorCode FindStride(SamLaw law, SamLawStep *step, double *stride)
{
  PetscReal from[2], to[2], found = 0;

  PetscFunctionBegin;
  if (law->of_body[1] && SamFramesGetSlide(step->state, SAM_TRIED, to)) {
    (void)SamFramesGetSlide(step->state, SAM_COMMITTED, from);
    PetscCall(SamWearGetStride(step->elasticity, step->pressure, from, to, &found));
  }
  *stride = found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const SamWear *w = (const SamWear *)law->data;
  PetscReal      depth[2];
  double        *numbers;

  PetscFunctionBegin;
  PetscCall(AddLoad(law, step));
  numbers = SamStateNumbers(step->state, SamStateFindNumber(step->state, "wear_volume1"), SAM_TRIED);
  PetscCall(SamWearGetVolumes(law, SamStateReadField(step->state, LoadFieldOf(step->state, 0)),
                              SamStateReadField(step->state, LoadFieldOf(step->state, 1)), numbers, depth));
  numbers[3] = w->jumps ? 0 : 1;
  PetscCall(FindStride(law, step, &numbers[4]));
  if (w->jumps) PetscFunctionReturn(PETSC_SUCCESS);
  step->moves = PETSC_TRUE;
  PetscCall(SamWearGetExcess(law, step, &numbers[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advise(SamLaw law, SamState state, char text[], size_t size)
{
  const double excess = *SamStateReadNumbers(state, SamStateFindNumber(state, "wear_excess"));
  const double stride = *SamStateReadNumbers(state, SamStateFindNumber(state, STRIDE));

  PetscFunctionBegin;
  text[0] = '\0';
  PetscCall(SamWearAdviseStride(stride, text, size));
  if (((const SamWear *)law->data)->jumps || !(excess > 1)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
    PetscSNPrintf(text, size,
                  "wear is %.2g times the limit of a step, 1.16 (p/E*) h, h the cell width; the pressure becomes "
                  "uneven from cell to cell, and wrong: use that many times more steps, or check the unit of the "
                  "coefficient, 1/Pa or m3/J",
                  excess));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamLaw law, PetscBool by_energy)
{
  SamWear *w;

  PetscFunctionBegin;
  PetscCall(PetscNew(&w));
  w->by_energy            = by_energy;
  law->data               = w;
  law->option             = rows[by_energy][0].name;
  law->heading            = by_energy ? NULL : "Wear";
  law->rows               = rows[by_energy];
  law->row_count          = 2;
  law->needs_friction     = PETSC_TRUE;
  law->any_motion         = PETSC_TRUE;
  law->by_passages        = PETSC_TRUE;
  law->bytes              = 56;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.addparameters  = AddParameters;
  law->uses[SAM_USE_PATH] = law->uses[by_energy ? SAM_USE_WORK : SAM_USE_PRESSED] = PETSC_TRUE;
  law->uses[SAM_USE_SLOPE]                                                        = by_energy;
  law->ops.declare                                                                = Declare;
  law->ops.separation                                                             = Separation;
  law->ops.advance                                                                = Advance;
  law->ops.advise                                                                 = Advise;
  law->ops.doubt                                                                  = SamWearDoubt;
  law->ops.number                                                                 = SamWearNumber;
  law->ops.back                                                                   = SamWearBack;
  law->number                                                                     = coefficients[by_energy];
  law->wears                                                                      = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Archard(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(Create(law, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Energy(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(Create(law, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}
