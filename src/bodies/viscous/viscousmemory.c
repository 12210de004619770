/*
  The memory of viscoelastic bodies: the tractions of the last step, and for each term those that follow them
  (viscous.c); how they move by that before any traction of a step, and the energy that they dissipate.

  The energy is dissipated by the dashpots of the terms, w = p - c being the traction on one. With w_0 before the step
  and D = p_new - p_old, w = w_0 exp(-t/theta) + D (1 - exp(-t/theta)) theta/dt, so that for tractions linear in time

      sum 1/theta_j int w.C_j w dt = sum (x m (1 + e)/2 w_0.C_j w_0 + x m^2 w_0.C_j D + f D.C_j D),

  m = (1 - e)/x, f = (1 - 2 m + m (1 + e)/2)/x = x/3 - x^2/4 + ..., which no time makes large. C_j is a sum of products
  with factors. The coupling of shear to u_z is the transposed of that of pressure to u_t: it counts twice.

  Tractions that change at the beginning of the step instead, and then stay, dissipate W_0 (w_0 + D).C (w_0 + D), W_0
  being the first of these weights. The true energy lies between both: nearer to this one where the step is long
  beside the times and the tractions relax in it, so that D is about r w_0, -1 <= r < 0, and near the first one where
  they grow. So the error is estimated as x/(1 + x) times the difference, with D = r w_0, and with GROWS times it for
  others.
*/
#include "viscous.h"
#include <petsam/private/base.h>
#include <petsam/private/control.h>
#include <petsam/private/state.h>
#include <math.h>
#include <stdio.h>

#define GROWS 0.1  /* found on balls, in 1 to 16 steps, under loads and approaches that are held, grow, or return */
#define SHORT 1e-2 /* duration over the time below which a weight is a series */

enum { NORMAL, TANGENTIAL, WAYS };
static const struct {
  PetscInt in, out;
} ends[SAM_VISCOUS_PRODUCTS]         = {[SAM_VISCOUS_NORMAL]      = {NORMAL, NORMAL},
                                        [SAM_VISCOUS_SHEAR]       = {TANGENTIAL, TANGENTIAL},
                                        [SAM_VISCOUS_OTHER_SHEAR] = {TANGENTIAL, TANGENTIAL},
                                        [SAM_VISCOUS_PUSH]        = {NORMAL, TANGENTIAL},
                                        [SAM_VISCOUS_LIFT]        = {TANGENTIAL, NORMAL}};
static const char *const last[WAYS]  = {"viscous_last_pressure", "viscous_last_shear"};
static const char *const moved[WAYS] = {"viscous_z", "viscous"};

static Vec Committed(SamState state, const char name[])
{
  return SamStateGetField(state, SamStateFindField(state, name), SAM_COMMITTED);
}

/* Sets the tried values of a field to 0, and returns them. */
static PetscErrorCode Clear(SamState state, const char name[], Vec *to)
{
  PetscFunctionBegin;
  PetscCall(SamStateSetField(state, SamStateFindField(state, name), to));
  PetscCall(VecZeroEntries(*to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousMemoryDeclare(SamElasticity e, SamState state)
{
  const SamViscous *v      = (const SamViscous *)e->data;
  SamStateField     one    = {.unit = "Pa", .generations = 2, .kept = PETSC_TRUE, .motion = SAM_MOVES};
  SamStateNumber    energy = {
       SAM_VISCOUS_ENERGY, "J", "energy dissipated in the bodies", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE,
       SAM_JOIN_SUM,       2};
  PetscInt id;

  PetscFunctionBegin;
  energy.unit = SamUnitOn(e->grid, energy.unit);
  for (PetscInt way = 0; way < WAYS; way++) {
    one.components = way + 1;
    for (PetscInt j = -1; j < v->terms; j++) {
      one.name = j < 0 ? last[way] : SamViscousFieldName(way, j);
      one.text = j < 0 ? "traction of the last step" : "traction that a term of the creep follows";
      PetscCall(SamStateDeclareField(state, &one, &id));
    }
  }
  one.unit   = "m";
  one.text   = "displacement by what the bodies remember";
  one.result = SAM_RESULT_OFFERED;
  for (PetscInt way = 0; way < WAYS; way++) {
    one.name       = moved[way];
    one.components = way + 1;
    PetscCall(SamStateDeclareField(state, &one, &id));
  }
  PetscCall(SamStateDeclareNumber(state, &energy, &id));
  energy.name   = SAM_VISCOUS_ERROR;
  energy.text   = NULL;
  energy.result = PETSC_FALSE;
  PetscCall(SamStateDeclareNumber(state, &energy, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the beginning of a step ---- */

/* Returns the factor of a product in what a term displaces. */
static double FactorOf(SamElasticity e, PetscInt j, SamViscousProductKind kind)
{
  double factor[SAM_VISCOUS_PRODUCTS];

  SamViscousFindFactors(e, ((const SamViscous *)e->data)->term[j].value, factor);
  return factor[kind];
}

/* True if any term displaces by a product. */
static PetscBool HasKind(SamElasticity e, SamViscousProductKind kind)
{
  for (PetscInt j = 0; j < ((const SamViscous *)e->data)->terms; j++)
    if (FactorOf(e, j, kind) != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Adds the displacement by a product of the terms, each as it would be without traction in the step. */
static PetscErrorCode AddKind(SamElasticity e, SamState state, SamViscousProductKind kind, const Vec u[WAYS])
{
  const SamViscous *v        = (const SamViscous *)e->data;
  const PetscInt    way      = ends[kind].in;
  const Vec         traction = Committed(state, last[way]);
  Vec               sum, more;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(e->grid, way + 1, &sum));
  for (PetscInt j = 0; j < v->terms; j++) {
    const SamViscousTerm *t      = &v->term[j];
    const double          factor = FactorOf(e, j, kind);
    const Vec             memory = Committed(state, SamViscousFieldName(way, j));

    if (memory) PetscCall(VecAXPY(sum, factor * t->step.kept, memory));
    if (traction) PetscCall(VecAXPY(sum, factor * t->step.before, traction));
  }
  PetscCall(VecDuplicate(u[ends[kind].out], &more));
  PetscCall(SamViscousProduct(e, kind, sum, more));
  PetscCall(VecAXPY(u[ends[kind].out], 1, more));
  PetscCall(VecDestroy(&more));
  PetscCall(VecDestroy(&sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousMemoryBegin(SamElasticity e, SamState state, const SamControl *control, PetscReal duration)
{
  SamViscous *v = (SamViscous *)e->data;
  Vec         u[WAYS];

  PetscFunctionBegin;
  (void)control;
  v->duration = duration;
  for (PetscInt j = 0; j < v->terms; j++) SamStreamWeights((double)(duration / v->term[j].time), &v->term[j].step);
  for (PetscInt way = 0; way < WAYS; way++) PetscCall(Clear(state, moved[way], &u[way]));
  PetscCall(SamElasticitySetUp(e));
  for (int kind = 0; kind < SAM_VISCOUS_PRODUCTS; kind++) PetscCall(AddKind(e, state, (SamViscousProductKind)kind, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousMemoryDisplace(SamElasticity e, SamConditions conditions, SamState state,
                                        const SamControl *control, Vec u_z, Vec u_t, PetscBool *adds)
{
  const Vec to[WAYS] = {u_z, u_t};

  PetscFunctionBegin;
  (void)e;
  (void)conditions;
  (void)control;
  for (PetscInt way = 0; way < WAYS && state; way++) {
    const Vec u = SamStateReadField(state, SamStateFindField(state, moved[way]));

    if (adds && u) *adds = PETSC_TRUE;
    if (to[way] && u) PetscCall(VecAXPY(to[way], 1, u));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- its end ---- */

/* Adds the sum of the products of two fields of the same number of components. */
static PetscErrorCode AddDot(SamGrid g, PetscInt components, Vec a, Vec b, double *sum)
{
  const double *x, *y;
  double        one;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(a, &x));
  PetscCall(VecGetArrayRead(b, &y));
  PetscCall(SamGridDot(g, components, x, y, &one));
  PetscCall(VecRestoreArrayRead(b, &y));
  PetscCall(VecRestoreArrayRead(a, &x));
  *sum += one;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the weights of w_0.C w_0, w_0.C D and D.C D in the energy of a term; x: the duration over the time. */
static void GetWeights(double x, double weights[3])
{
  const double e = exp(-x), m = -expm1(-x) / x;

  weights[0] = x * m * (1 + e) / 2;
  weights[1] = x * m * m;
  weights[2] = x < SHORT ? x * (1 / 3.0 - x * (1 / 4.0 - x * (7 / 60.0 - x / 24))) : (1 - 2 * m + m * (1 + e) / 2) / x;
}

/* Returns the error of that energy, from w_0.C w_0, w_0.C D and D.C D. */
static double ErrorOf(double x, const double weights[3], const double dots[3])
{
  const double relaxes = dots[0] > 0 ? PetscMin(dots[1] / dots[0], 0) : 0, part = PetscMax(relaxes, -1);
  const double first  = relaxes < 0 ? part * dots[0] : GROWS * dots[1],
               second = relaxes < 0 ? part * part * dots[0] : GROWS * dots[2];

  return ((2 * weights[0] - weights[1]) * first + (weights[0] - weights[2]) * second) * x / (1 + x);
}

/* Sets `to`, which it creates, to a - b, of which each may be absent. */
static PetscErrorCode CreateDifference(SamGrid g, PetscInt way, Vec a, Vec b, Vec *to)
{
  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, way + 1, to));
  if (a) PetscCall(VecCopy(a, *to));
  if (b) PetscCall(VecAXPY(*to, -1, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds w_0.C w_0 and w_0.C D of a term and a product to dots[0] and dots[1]; jump: D; product: C D. */
static PetscErrorCode AddDots(SamElasticity e, SamState state, PetscInt j, SamViscousProductKind kind,
                              const Vec jump[WAYS], Vec product, double dots[2])
{
  Vec w[WAYS], u;

  PetscFunctionBegin;
  for (PetscInt way = 0; way < WAYS; way++)
    PetscCall(CreateDifference(e->grid, way, Committed(state, last[way]), Committed(state, SamViscousFieldName(way, j)),
                               &w[way]));
  PetscCall(VecDuplicate(product, &u));
  PetscCall(SamViscousProduct(e, kind, w[ends[kind].in], u));
  PetscCall(AddDot(e->grid, ends[kind].out + 1, w[ends[kind].out], u, &dots[0]));
  PetscCall(AddDot(e->grid, ends[kind].out + 1, jump[ends[kind].out], u, &dots[1]));
  PetscCall(AddDot(e->grid, ends[kind].out + 1, w[ends[kind].out], product, &dots[1]));
  dots[1] /= 2; /* twice the same number, unless it is that of the coupling, which counts twice */
  PetscCall(VecDestroy(&u));
  for (PetscInt way = 0; way < WAYS; way++) PetscCall(VecDestroy(&w[way]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the energy that the terms dissipate in the step by a product, and its error. */
static PetscErrorCode AddEnergy(SamElasticity e, SamState state, SamViscousProductKind kind, const Vec traction[WAYS],
                                double *energy, double *error)
{
  const SamViscous *v       = (const SamViscous *)e->data;
  const PetscInt    out     = ends[kind].out;
  double            between = 0;
  Vec               jump[WAYS], product;

  PetscFunctionBegin;
  for (PetscInt way = 0; way < WAYS; way++)
    PetscCall(CreateDifference(e->grid, way, traction[way], Committed(state, last[way]), &jump[way]));
  PetscCall(VecDuplicate(jump[out], &product));
  PetscCall(SamViscousProduct(e, kind, jump[ends[kind].in], product));
  PetscCall(AddDot(e->grid, out + 1, jump[out], product, &between));
  for (PetscInt j = 0; j < v->terms; j++) {
    const double factor = FactorOf(e, j, kind) * (kind == SAM_VISCOUS_PUSH ? 2 : 1);
    const double x = (double)(v->duration / v->term[j].time), area = (double)(e->grid->dx * e->grid->dy);
    double       dots[3] = {0, 0, between}, weights[3];

    if (factor == 0) continue;
    PetscCall(AddDots(e, state, j, kind, jump, product, dots));
    GetWeights(x, weights);
    for (int k = 0; k < 3; k++) *energy += area * factor * weights[k] * dots[k];
    *error += area * factor * ErrorOf(x, weights, dots);
  }
  PetscCall(VecDestroy(&product));
  for (PetscInt way = 0; way < WAYS; way++) PetscCall(VecDestroy(&jump[way]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindEnergy(SamElasticity e, SamState state, const Vec traction[WAYS])
{
  const SamViscous *v      = (const SamViscous *)e->data;
  double *const     energy = SamStateNumbers(state, SamStateFindNumber(state, SAM_VISCOUS_ENERGY), SAM_TRIED);
  double *const     error  = SamStateNumbers(state, SamStateFindNumber(state, SAM_VISCOUS_ERROR), SAM_TRIED);

  PetscFunctionBegin;
  *energy = *error = 0;
  for (int kind = 0; kind < SAM_VISCOUS_LIFT && v->duration > 0; kind++)
    if (HasKind(e, (SamViscousProductKind)kind))
      PetscCall(AddEnergy(e, state, (SamViscousProductKind)kind, traction, energy, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousMemoryAdvance(SamElasticity e, SamState state, Vec pressure, Vec shear)
{
  const SamViscous *v              = (const SamViscous *)e->data;
  const Vec         traction[WAYS] = {pressure, shear};
  Vec               to;

  PetscFunctionBegin;
  PetscCall(FindEnergy(e, state, traction));
  for (PetscInt way = 0; way < WAYS; way++) {
    const Vec before = Committed(state, last[way]);

    for (PetscInt j = 0; j < v->terms; j++) {
      const Vec memory = Committed(state, SamViscousFieldName(way, j));

      PetscCall(Clear(state, SamViscousFieldName(way, j), &to));
      if (memory) PetscCall(VecAXPY(to, v->term[j].step.kept, memory));
      if (before) PetscCall(VecAXPY(to, v->term[j].step.before, before));
      PetscCall(VecAXPY(to, v->term[j].step.now, traction[way]));
    }
    PetscCall(Clear(state, last[way], &to));
    PetscCall(VecCopy(traction[way], to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
