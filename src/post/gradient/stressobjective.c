/*
  Smooth maxima at a depth, as numbers of a history that have a gradient: (sum s+^r)^(1/r) over the cells, s+ being the
  positive part of a component of the stress or von Mises' stress of the last step, with the bulk stress; or a parameter
  of planes of a cycle of steps: Findley 1959, J. Eng. Ind. 81, 301; Smith, Watson and Topper 1970, J. Mater. 5, 767;
  Fatemi and Socie 1988, Fatigue Fract. Eng. Mater. Struct. 11, 149.

  The stresses of cells are convolutions of the tractions, with kernels that are even or odd in the place: those of p
  are even for xx, yy, zz and xy and odd for xz and yz, those of the shear the other way round. So the transposed map
  consists of the same kernels, with the sign of the odd ones turned: the derivative by a traction is the sum over the
  components of what this traction would cause if it were the derivative by the component.

  These are the largest over the planes of tau_a + k max s_n, max s_n (max e_n - min e_n)/2 and tau_a/G (1 + k max
  s_n/yield), with s_n = n'sn, e_n = ((1 + nu) s_n - nu tr s)/E and tau_a the radius of the smallest circle about the
  path of the shear on the plane. To first order the plane, the states of the extremes and those on the circle stay:
  d tau_a = sum w_i u_i.d tau_i, with u_i the directions to these from the centre and w_i of sum 1 with sum w_i u_i = 0.
*/
#include "gradientimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/fatigue.h>
#include <petsam/private/stress.h>
#include <math.h>

#define POWER     40    /* of the norm: 512 equal values raise it by a sixth */
#define LEAST     1e-18 /* derivative of the norm by a cell's parameter that counts, of those whose sum is about 1 */
#define STEP      1e-4  /* of Poisson's ratio, for differences of a parameter of a cycle */
#define MAP_BYTES 305   /* of the map of the stress: its fields and its kernels, per cell */

enum { MISES = SAM_STRESS_COMPONENTS };

/* The quantities; of those of a cycle the parameter, and the constants that a name gives, as in an example */
static const struct {
  const char          *name;
  SamFatigueParameter *of_cycle;
  const char          *unit, *constants;
} quantities[] = {{"stress_xx", NULL, "Pa", ""},
                  {"stress_yy", NULL, "Pa", ""},
                  {"stress_zz", NULL, "Pa", ""},
                  {"stress_xy", NULL, "Pa", ""},
                  {"stress_xz", NULL, "Pa", ""},
                  {"stress_yz", NULL, "Pa", ""},
                  {"mises", NULL, "Pa", ""},
                  {"swt", SamFatigueSWT, "Pa", ""},
                  {"findley", SamFatigueFindley, "Pa", "@k=0.3"},
                  {"fatemi_socie", SamFatigueFatemiSocie, "1", "@k=1@yield=900MPa"}};
enum { QUANTITIES = sizeof(quantities) / sizeof(quantities[0]) };

/* The quantity, the depth, the body and the constants that a name selects */
typedef struct {
  int      quantity;
  double   depth, k, yield; /* m, 1, Pa; NaN: not given */
  PetscInt body;            /* 1 or 2; 0: not given */
} Wanted;

/* Reads a number that is not given yet. */
static PetscBool ReadOnce(const char unit[], const char text[], double *value)
{
  const char *end;
  PetscBool   has_unit;

  return isnan(*value) && SamReadReal(unit, text, &end, value, &has_unit) && !*end && isfinite(*value) ? PETSC_TRUE
                                                                                                       : PETSC_FALSE;
}

/* Reads what follows one @ of a name: first the depth, then the body or a constant; false: it is none of these. */
static PetscBool ReadPart(const char part[], Wanted *w)
{
  if (isnan(w->depth)) return ReadOnce("m", part, &w->depth);
  if (!strncmp(part, "k=", 2)) return ReadOnce(NULL, part + 2, &w->k);
  if (!strncmp(part, "yield=", 6)) return ReadOnce("Pa", part + 6, &w->yield);
  if (w->body || (strcmp(part, "1") && strcmp(part, "2"))) return PETSC_FALSE;
  w->body = *part - '0';
  return PETSC_TRUE;
}

/* Returns true if the numbers are in their ranges, and the constants those of the quantity. */
static PetscBool IsRight(const Wanted *w)
{
  const char *const constants = quantities[w->quantity].constants;

  return w->depth >= 0 && !isnan(w->k) == !!strstr(constants, "k=") && !(w->k < 0) &&
             !isnan(w->yield) == !!strstr(constants, "yield=") && !(w->yield <= 0)
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Reads a name like stress_xx@20um, mises@0.1mm@1 or findley@50um@k=0.3: depth, body (2), and constants. */
static PetscErrorCode Read(MPI_Comm comm, const char name[], Wanted *w)
{
  const int   length = (int)strcspn(name, "@");
  PetscBool   good   = PETSC_TRUE;
  const char *also;

  PetscFunctionBegin;
  *w = (Wanted){.depth = NAN, .k = NAN, .yield = NAN};
  for (int k = 0; k < QUANTITIES; k++)
    if ((int)strlen(quantities[k].name) == length && !strncmp(quantities[k].name, name, (size_t)length))
      w->quantity = k;
  for (const char *at = name + length; *at && good;) {
    const size_t size     = strcspn(at + 1, "@");
    char         part[64] = "";

    (void)snprintf(part, sizeof(part), "%.*s", (int)size, at + 1);
    good = size < sizeof(part) ? ReadPart(part, w) : PETSC_FALSE;
    at += 1 + size;
  }
  also = quantities[w->quantity].constants;
  PetscCheck(good && IsRight(w), comm, SAM_ERR_USER,
             "the gradient of %s: expected a depth, %sa body unless it is body 2: %.*s@50um%s, %.*s@50um@1%s", name,
             also[0] ? "constants, and " : "and ", length, name, also, length, name, also);
  if (!w->body) w->body = 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the stress ---- */

/* The map of the stress on the whole grid, and if derivatives by the moduli are wanted that of bodies whose Poisson's
   ratio is larger by `change` */
typedef struct {
  SamGrid   grid;
  SamStress stress, other;
  double    change;
  Vec       tractions, by; /* those of the step, and the derivatives by them: three components */
  Vec       field, work;   /* of six components */
} Map;

/* Creates the map of bodies with another Poisson's ratio. */
static PetscErrorCode CreateOther(const SamBackStep *at, const Wanted *w, Map *m)
{
  SamPair       others;
  SamElasticity elasticity;

  PetscFunctionBegin;
  PetscCall(SamPairCreateChanged(SamElasticityGetPair(at->elasticity), w->body - 1, &others, &m->change));
  PetscCall(SamElasticityCreateOfPair(at->elasticity, others, &elasticity));
  PetscCall(SamElasticityCreateStress(elasticity, w->body, NULL, &m->other));
  PetscCall(SamStressSetDepth(m->other, (PetscReal)w->depth));
  PetscCall(SamElasticityDestroy(&elasticity));
  PetscCall(SamPairDestroy(&others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(const SamBackStep *at, const Wanted *w, Map *m)
{
  PetscFunctionBegin;
  m->grid = SamElasticityGetGrid(at->elasticity);
  PetscCall(SamElasticityCreateStress(at->elasticity, w->body, NULL, &m->stress));
  PetscCall(SamStressSetDepth(m->stress, (PetscReal)w->depth));
  m->other = NULL;
  if (at->moduli) PetscCall(CreateOther(at, w, m));
  PetscCall(SamGridCreateVec(m->grid, SAM_STRESS_TRACTIONS, &m->tractions));
  PetscCall(SamGridCreateVec(m->grid, SAM_STRESS_TRACTIONS, &m->by));
  PetscCall(SamGridCreateVec(m->grid, SAM_STRESS_COMPONENTS, &m->field));
  PetscCall(SamGridCreateVec(m->grid, SAM_STRESS_COMPONENTS, &m->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Map *m)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&m->tractions));
  PetscCall(VecDestroy(&m->by));
  PetscCall(VecDestroy(&m->field));
  PetscCall(VecDestroy(&m->work));
  PetscCall(SamStressDestroy(&m->stress));
  PetscCall(SamStressDestroy(&m->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SamStressComponent in_plane[3] = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY};

/* Computes the stresses by the tractions of the map, in six components. */
static PetscErrorCode Apply(const Map *m, SamStress stress, Vec field)
{
  const PetscInt cells = m->grid->cells;
  const double  *t;
  double        *s;

  PetscFunctionBegin;
  PetscCall(VecZeroEntries(field));
  PetscCall(VecGetArrayRead(m->tractions, &t));
  PetscCall(VecGetArray(field, &s));
  PetscCall(PetscArraycpy(s + SAM_STRESS_ZZ * cells, t, cells));
  PetscCall(PetscArraycpy(s + SAM_STRESS_XZ * cells, t + cells, 2 * cells));
  PetscCall(VecRestoreArray(field, &s));
  PetscCall(VecRestoreArrayRead(m->tractions, &t));
  PetscCall(SamStressApply(stress, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stresses of a step, with the bulk and the initial stress, in six components. */
static PetscErrorCode Evaluate(const SamBackStep *at, const Wanted *w, PetscInt step, Map *m)
{
  const PetscInt   cells = m->grid->cells;
  const PetscReal *bulk;
  double          *s, uniform[3] = {0}; /* in_plane */

  PetscFunctionBegin;
  PetscCall((*at->read)(at->context, step, m->tractions, &bulk));
  PetscCall(Apply(m, m->stress, m->field));
  SamBodyInitialStress(SamPairBody(SamElasticityGetPair(at->elasticity), w->body - 1), w->depth, uniform);
  for (int k = 0; k < 3; k++) uniform[k] += (double)bulk[3 * (w->body - 1) + k];
  PetscCall(VecGetArray(m->field, &s));
  for (int k = 0; k < 3; k++)
    for (PetscInt c = 0; c < cells; c++) s[in_plane[k] * cells + c] += uniform[k];
  PetscCall(VecRestoreArray(m->field, &s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the quantity in a cell, and its derivatives by the six components. */
static double Quantity(const double s[], PetscInt cells, PetscInt k, int quantity, double by[SAM_STRESS_COMPONENTS])
{
  const double xx = s[k], yy = s[k + cells], zz = s[k + 2 * cells], xy = s[k + 3 * cells], xz = s[k + 4 * cells],
               yz = s[k + 5 * cells];
  double value;

  for (int c = 0; c < SAM_STRESS_COMPONENTS; c++) by[c] = c == quantity;
  if (quantity < MISES) return PetscMax(s[k + quantity * cells], 0);
  value = sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) +
               3 * (xy * xy + xz * xz + yz * yz));
  if (value == 0) return 0;
  by[SAM_STRESS_XX] = (2 * xx - yy - zz) / (2 * value);
  by[SAM_STRESS_YY] = (2 * yy - zz - xx) / (2 * value);
  by[SAM_STRESS_ZZ] = (2 * zz - xx - yy) / (2 * value);
  by[SAM_STRESS_XY] = 3 * xy / value;
  by[SAM_STRESS_XZ] = 3 * xz / value;
  by[SAM_STRESS_YZ] = 3 * yz / value;
  return value;
}

/* Computes the norm of values of the cells, and replaces them by its derivatives by them. */
static PetscErrorCode FindNorm(SamBackStep *at, SamGrid g, double value[])
{
  SamTotal total = {0};
  double   most  = 0, sum;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < g->cells; k++) most = PetscMax(most, value[k]);
  PetscCall(SamMax(g->comm, 1, &most));
  PetscCheck(most > 0, g->comm, SAM_ERR_USER,
             "the gradient of %s: it is nowhere above 0: take another depth, or steps with tension", at->name);
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) row += pow(value[k] / most, POWER);
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(g->comm, 1, &total, &sum));
  at->number = most * pow(sum, 1.0 / POWER);
  for (PetscInt k = 0; k < g->cells; k++) value[k] = pow(value[k] / at->number, POWER - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- its derivatives ---- */

static PetscBool IsEven(SamStressTraction traction, int component)
{
  return (traction == SAM_STRESS_P) == (component < SAM_STRESS_XZ) ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds the derivative by a traction through one component, whose derivatives are `by`. */
static PetscErrorCode AddTransposed(Map *m, SamStressTraction traction, int component, const double by[])
{
  static const SamStressComponent place[SAM_STRESS_TRACTIONS] = {SAM_STRESS_ZZ, SAM_STRESS_XZ, SAM_STRESS_YZ};

  const PetscInt cells = m->grid->cells;
  const double   sign  = IsEven(traction, component) ? 1 : -1;
  double        *s, *to;

  PetscFunctionBegin;
  PetscCall(VecZeroEntries(m->work));
  PetscCall(VecGetArray(m->work, &s));
  PetscCall(PetscArraycpy(s + place[traction] * cells, by, cells));
  PetscCall(VecRestoreArray(m->work, &s));
  PetscCall(SamStressApply(m->stress, m->work));
  PetscCall(VecGetArray(m->work, &s));
  PetscCall(VecGetArray(m->by, &to));
  for (PetscInt k = 0; k < cells; k++) to[k + traction * cells] += sign * s[component * cells + k];
  PetscCall(VecRestoreArray(m->by, &to));
  PetscCall(VecRestoreArray(m->work, &s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the bulk stress of the step. */
static PetscErrorCode AddBulk(SamBackStep *at, SamGrid g, const Wanted *w, const double by[])
{
  SamTotal total[3] = {{0}};
  double   sums[3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    double row[3] = {0, 0, 0};

    for (int c = 0; c < 3; c++)
      for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) row[c] += by[in_plane[c] * g->cells + k];
    SamAddAll(3, total, row);
  }
  PetscCall(SamSumTotals(g->comm, 3, total, sums));
  for (int c = 0; c < 3; c++) at->by_bulk[3 * (w->body - 1) + c] += sums[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Adds the derivative by Poisson's ratio: the stresses by tractions are linear in it, and so is that along a row of
  cells in plane strain by a bulk stress. `by`: those by the stresses.
*/
static PetscErrorCode AddPoisson(SamBackStep *at, const Wanted *w, Map *m, const double by[])
{
  const PetscInt   cells = m->grid->cells, nx = m->grid->nx;
  const PetscBool  plane = SamElasticityGetTraits(at->elasticity).plane;
  const PetscReal *bulk;
  const double    *s, *t;
  SamTotal         total = {0};
  double           sum;
  Vec              own;

  PetscFunctionBegin;
  PetscCall((*at->read)(at->context, at->step, m->tractions, &bulk));
  PetscCall(SamGridCreateVec(m->grid, SAM_STRESS_COMPONENTS, &own));
  PetscCall(Apply(m, m->stress, own));
  PetscCall(Apply(m, m->other, m->work));
  PetscCall(VecGetArrayRead(own, &s));
  PetscCall(VecGetArrayRead(m->work, &t));
  for (PetscInt j = 0; j < m->grid->rows; j++) {
    double row = 0;

    for (int c = 0; c < SAM_STRESS_COMPONENTS; c++)
      for (PetscInt k = j * nx + c * cells, end = k + nx; k < end; k++) row += by[k] * (t[k] - s[k]) / m->change;
    for (PetscInt k = j * nx; plane && k < (j + 1) * nx; k++)
      row += by[k + SAM_STRESS_YY * cells] * (double)bulk[3 * (w->body - 1)];
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArrayRead(m->work, &t));
  PetscCall(VecRestoreArrayRead(own, &s));
  PetscCall(VecDestroy(&own));
  PetscCall(SamSumTotals(m->grid->comm, 1, &total, &sum));
  at->by_moduli[2 * (w->body - 1) + 1] += sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the tractions and the bulk stress of the step, by those by the stresses, which are `by`. */
static PetscErrorCode AddStresses(SamBackStep *at, const Wanted *w, Map *m, const double by[])
{
  const PetscInt cells = at->grid->cells;
  const double  *found;
  Vec            part;

  PetscFunctionBegin;
  PetscCall(VecZeroEntries(m->by));
  for (int c = 0; c < SAM_STRESS_COMPONENTS; c++)
    for (int t = 0; t < SAM_STRESS_TRACTIONS && (w->quantity >= MISES || w->quantity == c); t++)
      PetscCall(AddTransposed(m, (SamStressTraction)t, c, by + c * m->grid->cells));
  PetscCall(AddBulk(at, m->grid, w, by));
  if (at->moduli) PetscCall(AddPoisson(at, w, m, by));
  PetscCall(SamGridCreateVec(at->grid, SAM_STRESS_TRACTIONS, &part));
  PetscCall(at->window ? SamWindowTake(at->window, m->by, part) : VecCopy(m->by, part));
  PetscCall(VecGetArrayRead(part, &found));
  for (PetscInt k = 0; k < cells; k++) at->by_pressure[k] += found[k];
  for (PetscInt k = 0; k < 2 * cells; k++) at->by_shear[k] += found[k + cells];
  PetscCall(VecRestoreArrayRead(part, &found));
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a component, or von Mises' stress ---- */

static PetscErrorCode AddOfStep(SamBackStep *at, const Wanted *w, Map *m)
{
  const PetscInt cells = m->grid->cells;
  double        *s, *value, by[SAM_STRESS_COMPONENTS];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(cells, &value));
  PetscCall(Evaluate(at, w, at->step, m));
  PetscCall(VecGetArray(m->field, &s));
  for (PetscInt k = 0; k < cells; k++) value[k] = Quantity(s, cells, k, w->quantity, by);
  PetscCall(FindNorm(at, m->grid, value));
  for (PetscInt k = 0; k < cells; k++) {
    (void)Quantity(s, cells, k, w->quantity, by);
    for (int c = 0; c < SAM_STRESS_COMPONENTS; c++) s[k + c * cells] = value[k] * by[c];
  }
  PetscCall(AddStresses(at, w, m, s));
  PetscCall(VecRestoreArray(m->field, &s));
  PetscCall(PetscFree(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a parameter of a cycle ---- */

/* What a pass keeps: the map, and the derivatives of the norm by the stresses of all steps, of the cells that count */
typedef struct {
  Map      map;
  PetscInt count, *cell;
  double  *by; /* of each of these cells, of each component, in each step */
} Cycle;

static SamFatigueConstants ConstantsOf(const SamBackStep *at, const Wanted *w)
{
  SamPairConstants constants;

  (void)SamPairGetConstants(SamElasticityGetPair(at->elasticity), &constants);
  return (SamFatigueConstants){.young          = (PetscReal)constants.modulus[2 * (w->body - 1)],
                               .poisson        = (PetscReal)constants.modulus[2 * (w->body - 1) + 1],
                               .findley_k      = (PetscReal)w->k,
                               .fatemi_socie_k = (PetscReal)w->k,
                               .yield          = (PetscReal)w->yield};
}

/*
  Computes the derivatives of a parameter by the moduli for the stresses as they are: it is proportional to 1/E, or does
  not depend on E, and the one by Poisson's ratio is that on the plane, which stays to first order.
*/
static void SlopesOfConstants(const SamFatigueCycle *cycle, SamFatigueParameter *parameter, double by[2])
{
  SamFatigueConstants changed = *cycle->constants;
  SamFatigueCycle     other   = *cycle;
  double              normal[3], both[2];

  other.constants = &changed;
  for (int k = 0; k < 2; k++) {
    changed.poisson = cycle->constants->poisson + (PetscReal)((k ? 1 : -1) * STEP);
    both[k]         = (*parameter)(&other, normal);
  }
  by[0] = parameter == SamFatigueFindley ? 0 : -0.5 * (both[0] + both[1]) / (double)cycle->constants->young;
  by[1] = (both[1] - both[0]) / (2 * STEP);
}

/* Gathers the stresses of all steps of the cycle. */
static PetscErrorCode Gather(const SamBackStep *at, const Wanted *w, Cycle *c, double all[])
{
  const PetscInt cells = c->map.grid->cells, states = at->last - at->first + 1;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < states; k++) {
    const double *s;

    PetscCall(Evaluate(at, w, at->first + k, &c->map));
    PetscCall(VecGetArrayRead(c->map.field, &s));
    for (PetscInt m = 0; m < cells; m++)
      for (int n = 0; n < SAM_STRESS_COMPONENTS; n++)
        all[((ptrdiff_t)m * SAM_STRESS_COMPONENTS + n) * states + k] = s[m + n * cells];
    PetscCall(VecRestoreArrayRead(c->map.field, &s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the cells whose derivative by the parameter is not negligible, and multiplies by it. */
static PetscErrorCode KeepCells(const double value[], PetscInt cells, size_t size, Cycle *c)
{
  PetscFunctionBegin;
  for (PetscInt m = 0; m < cells; m++) c->count += value[m] > LEAST;
  PetscCall(PetscMalloc1(c->count, &c->cell));
  c->count = 0;
  for (PetscInt m = 0; m < cells; m++) {
    double *const to = c->by + (size_t)c->count * size;

    if (!(value[m] > LEAST)) continue;
    for (size_t k = 0; k < size; k++) to[k] = value[m] * c->by[(size_t)m * size + k];
    c->cell[c->count++] = m;
  }
  PetscCall(PetscRealloc(PetscMax((size_t)c->count, 1) * size * sizeof(double), &c->by));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives of the norm by the moduli for stresses as they are; `weight`: those by the cells' parameters. */
static PetscErrorCode AddConstants(SamBackStep *at, const Wanted *w, Cycle *c, const SamFatigueConstants *constants,
                                   const double weight[])
{
  const PetscInt states = at->last - at->first + 1, nx = c->map.grid->nx;
  const size_t   size     = SAM_STRESS_COMPONENTS * (size_t)states;
  SamTotal       total[2] = {{0}};
  double        *all, *scratch, sums[2];

  PetscFunctionBegin;
  PetscCall(PetscMalloc2((size_t)c->map.grid->cells * size, &all, SAM_FATIGUE_SCRATCH * states, &scratch));
  PetscCall(Gather(at, w, c, all));
  for (PetscInt j = 0, m = 0; j < c->map.grid->rows; j++) {
    double row[2] = {0};

    for (; m < c->count && c->cell[m] < (j + 1) * nx; m++) {
      const SamFatigueCycle cycle = {constants, states, all + (size_t)c->cell[m] * size, NULL, scratch};
      double                by[2];

      SlopesOfConstants(&cycle, quantities[w->quantity].of_cycle, by);
      for (int n = 0; n < 2; n++) row[n] += weight[c->cell[m]] * by[n];
    }
    SamAddAll(2, total, row);
  }
  PetscCall(SamSumTotals(c->map.grid->comm, 2, total, sums));
  for (int n = 0; n < 2; n++) at->by_moduli[2 * (w->body - 1) + n] += sums[n];
  PetscCall(PetscFree2(all, scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the parameters of all cells and their norm, and its derivatives by the stresses. */
static PetscErrorCode FindSlopes(SamBackStep *at, const Wanted *w, Cycle *c)
{
  const PetscInt            cells = c->map.grid->cells, states = at->last - at->first + 1;
  const SamFatigueConstants constants = ConstantsOf(at, w);
  double                   *value, *scratch;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)cells * SAM_STRESS_COMPONENTS * (size_t)states, &c->by));
  PetscCall(Gather(at, w, c, c->by));
  PetscCall(PetscMalloc2(cells, &value, SAM_FATIGUE_SCRATCH * states, &scratch));
  for (PetscInt m = 0; m < cells; m++) {
    double *const         by    = c->by + (ptrdiff_t)m * SAM_STRESS_COMPONENTS * states;
    const SamFatigueCycle cycle = {&constants, states, by, NULL, scratch};

    value[m] = fmax(SamFatigueSlopes(quantities[w->quantity].of_cycle, &cycle, by), 0);
  }
  PetscCall(FindNorm(at, c->map.grid, value));
  PetscCall(KeepCells(value, cells, (size_t)(SAM_STRESS_COMPONENTS * states), c));
  if (at->moduli) PetscCall(AddConstants(at, w, c, &constants, value));
  PetscCall(PetscFree2(value, scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the stresses of one step. */
static PetscErrorCode AddOfCycle(SamBackStep *at, const Wanted *w, Cycle *c)
{
  const PetscInt cells = c->map.grid->cells, states = at->last - at->first + 1;
  double        *by;

  PetscFunctionBegin;
  PetscCall(VecZeroEntries(c->map.field));
  PetscCall(VecGetArray(c->map.field, &by));
  for (PetscInt m = 0; m < c->count; m++)
    for (int d = 0; d < SAM_STRESS_COMPONENTS; d++)
      by[c->cell[m] + d * cells] = c->by[((ptrdiff_t)m * SAM_STRESS_COMPONENTS + d) * states + at->step - at->first];
  PetscCall(AddStresses(at, w, &c->map, by));
  PetscCall(VecRestoreArray(c->map.field, &by));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EndCycle(void *data)
{
  Cycle *c = (Cycle *)data;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Destroy(&c->map));
  PetscCall(PetscFree(c->cell));
  PetscCall(PetscFree(c->by));
  PetscCall(PetscFree(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the objectives ---- */

static PetscErrorCode Check(SamProblem problem, const char name[])
{
  const SamElasticity       elasticity = SamProblemGetElasticity(problem);
  const SamElasticityTraits traits     = SamElasticityGetTraits(elasticity);
  const SamPair             pair       = SamElasticityGetPair(elasticity);
  const MPI_Comm            comm       = SamElasticityGetGrid(elasticity)->comm;
  const char               *why        = NULL;
  Wanted                    w;

  PetscFunctionBegin;
  PetscCall(Read(comm, name, &w));
  if (!traits.stress || traits.periodic) why = "periodic bodies";
  if (traits.patch) why = "finite bodies";
  if (!SamPairIsUniform(pair)) why = "bodies with layers";
  if (SamBodyIsRigid(SamPairBody(pair, w.body - 1))) why = "a rigid body";
  PetscCheck(!why, comm, SAM_ERR_USER, "the gradient of %s: that of the stresses in %s is not computed%s", name, why,
             traits.periodic || traits.patch ? ": take pressure_norm" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddStress(SamBackStep *at)
{
  Wanted w;
  Map    m;

  PetscFunctionBegin;
  if (at->step != at->last) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Read(at->grid->comm, at->name, &w));
  PetscCall(Create(at, &w, &m));
  PetscCall(AddOfStep(at, &w, &m));
  PetscCall(Destroy(&m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameter(SamBackStep *at)
{
  Wanted w;
  Cycle *c;

  PetscFunctionBegin;
  if (at->step < at->first || at->step > at->last) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Read(at->grid->comm, at->name, &w));
  if (!at->data) {
    PetscCall(PetscNew(&c));
    at->data = c;
    PetscCall(Create(at, &w, &c->map));
    PetscCall(FindSlopes(at, &w, c));
  }
  PetscCall(AddOfCycle(at, &w, (Cycle *)at->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamObjectiveRegisterStresses(void)
{
  PetscFunctionBegin;
  for (int k = 0; k < QUANTITIES; k++) {
    static const SamObjective step = {
      .add = AddStress, .check = Check, .suffix = PETSC_TRUE, .bytes = {0, MAP_BYTES, 0}};
    static const SamObjective cycle = {.all    = PETSC_TRUE,
                                       .add    = AddParameter,
                                       .check  = Check,
                                       .suffix = PETSC_TRUE,
                                       .end    = EndCycle,
                                       .bytes  = {MAP_BYTES, 0, SAM_STRESS_COMPONENTS * sizeof(double)}};
    SamObjective              one   = quantities[k].of_cycle ? cycle : step;

    one.name = quantities[k].name;
    one.unit = quantities[k].unit;
    PetscCall(SamObjectiveRegister(&one));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
