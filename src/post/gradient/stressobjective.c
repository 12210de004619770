/*
  Smooth maxima at a depth, as numbers of a history that have a gradient: (sum s+^r)^(1/r) over the cells, s+ being the
  positive part of a component of the stress or von Mises' stress of the last step, with the bulk stress; or Smith,
  Watson and Topper's parameter of a cycle of steps.

  The stresses of cells are convolutions of the tractions, with kernels that are even or odd in the place: those of p
  are even for xx, yy, zz and xy and odd for xz and yz, those of the shear the other way round. So the transposed map
  consists of the same kernels, with the sign of the odd ones turned: the derivative by a traction is the sum over the
  components of what this traction would cause if it were the derivative by the component.

  SWT = max s_n (max e_n - min e_n)/2 of the plane with the largest one, with s_n = n'sn, e_n = ((1 + nu) s_n - nu tr
  s)/E. To first order the plane and the states of the extremes stay.
*/
#include "gradientimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/fatigue.h>
#include <petsam/private/stress.h>
#include <math.h>

#define POWER     40  /* of the norm: 512 equal values raise it by a sixth */
#define MAP_BYTES 305 /* of the map of the stress: its fields and its kernels, per cell */

enum { MISES = SAM_STRESS_COMPONENTS, SWT };
static const char *const quantities[] = {"stress_xx", "stress_yy", "stress_zz", "stress_xy",
                                         "stress_xz", "stress_yz", "mises",     "swt"};
enum { QUANTITIES = sizeof(quantities) / sizeof(quantities[0]) };

/* The quantity, the depth and the body that a name selects */
typedef struct {
  int      quantity;
  double   depth; /* m */
  PetscInt body;  /* 1 or 2 */
} Wanted;

/* Reads a name like stress_xx@20um or mises@0.1mm@1: depth, and body (2). */
static PetscErrorCode Read(MPI_Comm comm, const char name[], Wanted *w)
{
  const char *at = strchr(name, '@'), *next = at ? strchr(at + 1, '@') : NULL, *end;
  char        depth[64] = "";
  PetscBool   unit, good;

  PetscFunctionBegin;
  *w = (Wanted){.body = 2};
  for (int k = 0; k < QUANTITIES; k++)
    if (strlen(quantities[k]) == strcspn(name, "@") && !strncmp(quantities[k], name, strcspn(name, "@")))
      w->quantity = k;
  if (at) (void)snprintf(depth, sizeof(depth), "%.*s", (int)(next ? next - at - 1 : (ptrdiff_t)strlen(at + 1)), at + 1);
  good = at && (next ? next : at + strlen(at)) - at < (ptrdiff_t)sizeof(depth) &&
             SamReadReal("m", depth, &end, &w->depth, &unit) && w->depth >= 0 && isfinite(w->depth)
           ? PETSC_TRUE
           : PETSC_FALSE;
  if (next) w->body = !strcmp(next, "@1") ? 1 : !strcmp(next, "@2") ? 2 : 0;
  PetscCheck(good && w->body, comm, SAM_ERR_USER,
             "the gradient of %s: expected a depth, and a body unless it is body 2: %.*s@50um, %.*s@50um@1", name,
             (int)strcspn(name, "@"), name, (int)strcspn(name, "@"), name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the stress ---- */

/* The map of the stress on the whole grid */
typedef struct {
  SamGrid   grid;
  SamStress stress;
  Vec       tractions, by; /* those of the step, and the derivatives by them: three components */
  Vec       field, work;   /* of six components */
} Map;

static PetscErrorCode Create(const SamObjectiveStep *at, const Wanted *w, Map *m)
{
  PetscFunctionBegin;
  m->grid = SamElasticityGetGrid(at->elasticity);
  PetscCall(SamElasticityCreateStress(at->elasticity, w->body, NULL, &m->stress));
  PetscCall(SamStressSetDepth(m->stress, (PetscReal)w->depth));
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const SamStressComponent in_plane[3] = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY};

/* Computes the stresses of a step, with the bulk and the initial stress, in six components. */
static PetscErrorCode Evaluate(const SamObjectiveStep *at, const Wanted *w, PetscInt step, Map *m)
{
  const PetscInt   cells = m->grid->cells;
  const PetscReal *bulk;
  const double    *t;
  double          *s, uniform[3] = {0}; /* in_plane */

  PetscFunctionBegin;
  PetscCall((*at->read)(at->context, step, m->tractions, &bulk));
  PetscCall(VecZeroEntries(m->field));
  PetscCall(VecGetArrayRead(m->tractions, &t));
  PetscCall(VecGetArray(m->field, &s));
  PetscCall(PetscArraycpy(s + SAM_STRESS_ZZ * cells, t, cells));
  PetscCall(PetscArraycpy(s + SAM_STRESS_XZ * cells, t + cells, 2 * cells));
  PetscCall(VecRestoreArray(m->field, &s));
  PetscCall(VecRestoreArrayRead(m->tractions, &t));
  PetscCall(SamStressApply(m->stress, m->field));
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
static PetscErrorCode FindNorm(SamObjectiveStep *at, SamGrid g, double value[])
{
  SamTotal total = {0};
  double   most  = 0, sum;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < g->cells; k++) most = PetscMax(most, value[k]);
  PetscCall(SamMax(g->comm, 1, &most));
  PetscCheck(most > 0, g->comm, SAM_ERR_USER, "the gradient of %s: it is nowhere above 0", at->name);
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
static PetscErrorCode AddBulk(SamObjectiveStep *at, SamGrid g, const Wanted *w, const double by[])
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

/* Adds the derivatives by the tractions and the bulk stress of the step, by those by the stresses, which are `by`. */
static PetscErrorCode AddStresses(SamObjectiveStep *at, const Wanted *w, Map *m, const double by[])
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

static PetscErrorCode AddOfStep(SamObjectiveStep *at, const Wanted *w, Map *m)
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

/* ---- Smith, Watson and Topper ---- */

/* The plane of a cell, the steps of its extremes; derivatives of the norm by max s_n and by max e_n - min e_n */
typedef struct {
  double   normal[3], by_stress, by_strain;
  PetscInt most, high, low;
} Plane;

/* The map and the planes of a cycle, which a pass keeps */
typedef struct {
  Map    map;
  Plane *plane; /* of each cell */
} Cycle;

/* Returns the stress normal to a plane in a state, and the trace. */
static double Normal(const double s[], PetscInt states, PetscInt k, const double n[3], double *trace)
{
  *trace = s[k] + s[states + k] + s[2 * states + k];
  return n[0] * n[0] * s[k] + n[1] * n[1] * s[states + k] + n[2] * n[2] * s[2 * states + k] +
         2 * (n[0] * n[1] * s[3 * states + k] + n[0] * n[2] * s[4 * states + k] + n[1] * n[2] * s[5 * states + k]);
}

/* Finds the plane of a cell and its extremes; returns the parameter. */
static double FindPlane(const SamFatigueCycle *cycle, PetscInt first, Plane *p)
{
  const double nu = (double)cycle->constants->poisson, young = (double)cycle->constants->young;
  const double value = SamFatigueSWT(cycle, p->normal);
  double       most = -INFINITY, high = -INFINITY, low = INFINITY;

  for (PetscInt k = 0; value > 0 && k < cycle->states; k++) {
    double       trace;
    const double s = Normal(cycle->stress, cycle->states, k, p->normal, &trace),
                 e = ((1 + nu) * s - nu * trace) / young;

    if (s > most) p->most = first + k;
    if (e > high) p->high = first + k;
    if (e < low) p->low = first + k;
    most = PetscMax(most, s);
    high = PetscMax(high, e);
    low  = PetscMin(low, e);
  }
  p->by_stress = value > 0 ? 0.5 * (high - low) : 0;
  p->by_strain = value > 0 ? 0.5 * most : 0;
  return PetscMax(value, 0);
}

/* Finds the planes of all cells, from the stresses of all steps of the cycle, and the norm of the parameter. */
static PetscErrorCode FindPlanes(SamObjectiveStep *at, const Wanted *w, Cycle *c)
{
  const PetscInt      cells = c->map.grid->cells, states = at->last - at->first + 1;
  SamPairConstants    constants;
  SamFatigueConstants of_body = {.young = 0};
  double             *all, *value, *scratch;

  PetscFunctionBegin;
  (void)SamPairGetConstants(SamElasticityGetPair(at->elasticity), &constants);
  of_body.young   = (PetscReal)constants.modulus[2 * (w->body - 1)];
  of_body.poisson = (PetscReal)constants.modulus[2 * (w->body - 1) + 1];
  PetscCall(
    PetscMalloc3(SAM_STRESS_COMPONENTS * states * cells, &all, cells, &value, SAM_FATIGUE_SCRATCH * states, &scratch));
  for (PetscInt k = 0; k < states; k++) {
    const double *s;

    PetscCall(Evaluate(at, w, at->first + k, &c->map));
    PetscCall(VecGetArrayRead(c->map.field, &s));
    for (PetscInt m = 0; m < cells; m++)
      for (int n = 0; n < SAM_STRESS_COMPONENTS; n++)
        all[(m * SAM_STRESS_COMPONENTS + n) * states + k] = s[m + n * cells];
    PetscCall(VecRestoreArrayRead(c->map.field, &s));
  }
  for (PetscInt m = 0; m < cells; m++) {
    const SamFatigueCycle cycle = {&of_body, states, all + m * SAM_STRESS_COMPONENTS * states, NULL, scratch};

    value[m] = FindPlane(&cycle, at->first, &c->plane[m]);
  }
  PetscCall(FindNorm(at, c->map.grid, value));
  for (PetscInt m = 0; m < cells; m++) {
    c->plane[m].by_stress *= value[m];
    c->plane[m].by_strain *= value[m] / (double)of_body.young;
  }
  PetscCall(PetscFree3(all, value, scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the stresses of one step. */
static PetscErrorCode AddOfCycle(SamObjectiveStep *at, const Wanted *w, Cycle *c)
{
  const PetscInt   cells = c->map.grid->cells;
  SamPairConstants constants;
  double          *by, nu;

  PetscFunctionBegin;
  (void)SamPairGetConstants(SamElasticityGetPair(at->elasticity), &constants);
  nu = constants.modulus[2 * (w->body - 1) + 1];
  PetscCall(PetscCalloc1(SAM_STRESS_COMPONENTS * cells, &by));
  for (PetscInt m = 0; m < cells; m++) {
    const Plane  *p      = &c->plane[m];
    const double *n      = p->normal;
    const double  strain = p->by_strain * ((p->high == at->step ? 1 : 0) - (p->low == at->step ? 1 : 0));
    const double  normal = (p->most == at->step ? p->by_stress : 0) + (1 + nu) * strain;

    if (normal == 0 && strain == 0) continue;
    for (int d = 0; d < 3; d++) by[m + d * cells] = normal * n[d] * n[d] - nu * strain;
    by[m + SAM_STRESS_XY * cells] = 2 * normal * n[0] * n[1];
    by[m + SAM_STRESS_XZ * cells] = 2 * normal * n[0] * n[2];
    by[m + SAM_STRESS_YZ * cells] = 2 * normal * n[1] * n[2];
  }
  PetscCall(AddStresses(at, w, &c->map, by));
  PetscCall(PetscFree(by));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode EndCycle(void *data)
{
  Cycle *c = (Cycle *)data;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Destroy(&c->map));
  PetscCall(PetscFree(c->plane));
  PetscCall(PetscFree(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the objectives ---- */

static PetscErrorCode Check(SamElasticity elasticity, const PetscReal rate[], const char name[])
{
  const SamElasticityTraits traits = SamElasticityGetTraits(elasticity);
  const SamPair             pair   = SamElasticityGetPair(elasticity);
  const MPI_Comm            comm   = SamElasticityGetGrid(elasticity)->comm;
  const char               *why    = NULL;
  Wanted                    w;

  PetscFunctionBegin;
  (void)rate;
  PetscCall(Read(comm, name, &w));
  if (!traits.stress || traits.periodic) why = "periodic bodies";
  if (traits.patch) why = "finite bodies";
  if (!SamPairIsUniform(pair)) why = "bodies with layers";
  if (SamBodyIsRigid(SamPairBody(pair, w.body - 1))) why = "a rigid body";
  PetscCheck(!why, comm, SAM_ERR_USER, "the gradient of %s: that of the stresses in %s is not computed%s", name, why,
             traits.periodic || traits.patch ? ": take pressure_norm" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddStress(SamObjectiveStep *at)
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

static PetscErrorCode AddSWT(SamObjectiveStep *at)
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
    PetscCall(PetscCalloc1(c->map.grid->cells, &c->plane));
    PetscCall(FindPlanes(at, &w, c));
  }
  PetscCall(AddOfCycle(at, &w, (Cycle *)at->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamObjectiveRegisterStresses(void)
{
  PetscFunctionBegin;
  for (int k = 0; k < QUANTITIES; k++) {
    static const SamObjective step  = {.unit   = "Pa",
                                       .add    = AddStress,
                                       .check  = Check,
                                       .suffix = PETSC_TRUE,
                                       .fixed  = PETSC_TRUE,
                                       .bytes  = {0, MAP_BYTES, 0}};
    static const SamObjective cycle = {.unit   = "Pa",
                                       .all    = PETSC_TRUE,
                                       .add    = AddSWT,
                                       .check  = Check,
                                       .suffix = PETSC_TRUE,
                                       .fixed  = PETSC_TRUE,
                                       .end    = EndCycle,
                                       .bytes = {MAP_BYTES + sizeof(Plane), 0, SAM_STRESS_COMPONENTS * sizeof(double)}};
    SamObjective              one   = k == SWT ? cycle : step;

    one.name = quantities[k];

    PetscCall(SamObjectiveRegister(&one));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
