/*
  The memory of viscoelastic bodies: the tractions of the last step, and for each term those that follow them
  (viscous.c); how they move by that before any traction of a step, and the energy that they dissipate.

  The energy is dissipated by the dashpots of the terms, w = p - c being the traction on one. With w_0 before the step
  and D = p_new - p_old, w = w_0 exp(-t/theta) + D (1 - exp(-t/theta)) theta/dt, so that for tractions linear in time

      sum a_j/theta_j int w.C w dt = sum a_j (x m (1 + e)/2 w_0.C w_0 + x m^2 w_0.C D + f D.C D),

  m = (1 - e)/x, f = (1 - 2 m + m (1 + e)/2)/x = x/3 - x^2/4 + ..., which no time makes large.
*/
#include "viscous.h"
#include <petsam/private/base.h>
#include <petsam/private/control.h>
#include <petsam/private/state.h>
#include <math.h>
#include <stdio.h>

#define ENERGY "viscous_energy"
#define SHORT  1e-2 /* duration over the time below which a weight is a series */

enum { NORMAL, TANGENTIAL, WAYS };
static const char *const last[WAYS]  = {"viscous_last_pressure", "viscous_last_shear"};
static const char *const moved[WAYS] = {"viscous_z", "viscous"};

/* Returns the name of a term's field. */
static const char *NameOf(PetscInt way, PetscInt j)
{
  static char names[WAYS][SAM_VISCOUS_TERMS][32];

  (void)snprintf(names[way][j], sizeof(names[way][j]), "viscous_%s_%d", way ? "shear" : "pressure", (int)j + 1);
  return names[way][j];
}

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
       ENERGY, "J", "energy dissipated in the bodies", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_SUM, 2};
  PetscInt id;

  PetscFunctionBegin;
  energy.unit = SamUnitOn(e->grid, energy.unit);
  for (PetscInt way = 0; way < WAYS; way++) {
    one.components = way + 1;
    for (PetscInt j = -1; j < v->terms; j++) {
      one.name = j < 0 ? last[way] : NameOf(way, j);
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the beginning of a step ---- */

/* Finds the weights of a term in a step of this duration, s. */
static void SetWeights(SamViscousTerm *term, PetscReal duration)
{
  const double x = (double)(duration / term->time), e = exp(-x), mean = x > 0 ? -expm1(-x) / x : 1;

  term->kept   = e;
  term->before = mean - e;
  term->now    = 1 - mean;
}

/* Adds the displacement of a body (-1: both) by the terms, each as it would be without traction in the step. */
static PetscErrorCode AddBody(SamElasticity e, SamState state, PetscInt body, const Vec u[WAYS])
{
  const SamViscous *v = (const SamViscous *)e->data;
  Vec               sum[WAYS];

  PetscFunctionBegin;
  for (PetscInt way = 0; way < WAYS; way++) {
    const Vec traction = Committed(state, last[way]);

    PetscCall(SamGridCreateVec(e->grid, way + 1, &sum[way]));
    for (PetscInt j = 0; j < v->terms; j++) {
      const SamViscousTerm *t      = &v->term[j];
      const double          part   = body < 0 ? PetscMax(t->part[0], t->part[1]) : t->part[body];
      const Vec             memory = Committed(state, NameOf(way, j));

      if (memory) PetscCall(VecAXPY(sum[way], part * (double)t->kept, memory));
      if (traction) PetscCall(VecAXPY(sum[way], part * (double)t->before, traction));
    }
  }
  PetscCall(SamViscousApply(e, body, 1, sum[NORMAL], sum[TANGENTIAL], u[NORMAL], u[TANGENTIAL]));
  for (PetscInt way = 0; way < WAYS; way++) PetscCall(VecDestroy(&sum[way]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousMemoryBegin(SamElasticity e, SamState state, const SamControl *control, PetscReal duration)
{
  SamViscous *v = (SamViscous *)e->data;
  Vec         u[WAYS];

  PetscFunctionBegin;
  (void)control;
  v->duration = duration;
  for (PetscInt j = 0; j < v->terms; j++) SetWeights(&v->term[j], duration);
  for (PetscInt way = 0; way < WAYS; way++) PetscCall(Clear(state, moved[way], &u[way]));
  PetscCall(SamElasticitySetUp(e));
  if (v->alike) {
    PetscCall(AddBody(e, state, -1, u));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt b = 0; b < 2; b++)
    if (v->relaxes[b]) PetscCall(AddBody(e, state, b, u));
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

/* Adds the energy that a term of a body (-1: of both) dissipates in the step. */
static PetscErrorCode AddTerm(SamElasticity e, SamState state, PetscInt j, PetscInt body, const Vec traction[WAYS],
                              double *energy)
{
  const SamViscous     *v       = (const SamViscous *)e->data;
  const SamViscousTerm *t       = &v->term[j];
  const double          part    = body < 0 ? PetscMax(t->part[0], t->part[1]) : t->part[body];
  double                dots[3] = {0}, weights[3];
  Vec                   w[2][WAYS], u[2][WAYS]; /* w_0 and D, and their displacements */

  PetscFunctionBegin;
  if (part == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt way = 0; way < WAYS; way++) {
    const Vec before = Committed(state, last[way]), memory = Committed(state, NameOf(way, j));

    for (int k = 0; k < 2; k++) {
      PetscCall(SamGridCreateVec(e->grid, way + 1, &w[k][way]));
      PetscCall(SamGridCreateVec(e->grid, way + 1, &u[k][way]));
    }
    PetscCall(VecCopy(traction[way], w[1][way]));
    if (before) PetscCall(VecAXPY(w[1][way], -1, before));
    if (before) PetscCall(VecCopy(before, w[0][way]));
    if (memory) PetscCall(VecAXPY(w[0][way], -1, memory));
  }
  for (int k = 0; k < 2; k++)
    PetscCall(SamViscousApply(e, body, 1, w[k][NORMAL], w[k][TANGENTIAL], u[k][NORMAL], u[k][TANGENTIAL]));
  for (PetscInt way = 0; way < WAYS; way++) {
    PetscCall(AddDot(e->grid, way + 1, w[0][way], u[0][way], &dots[0]));
    PetscCall(AddDot(e->grid, way + 1, w[1][way], u[0][way], &dots[1]));
    PetscCall(AddDot(e->grid, way + 1, w[1][way], u[1][way], &dots[2]));
    for (int k = 0; k < 2; k++) {
      PetscCall(VecDestroy(&w[k][way]));
      PetscCall(VecDestroy(&u[k][way]));
    }
  }
  GetWeights((double)(v->duration / t->time), weights);
  for (int k = 0; k < 3; k++) *energy += (double)(e->grid->dx * e->grid->dy) * part * weights[k] * dots[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindEnergy(SamElasticity e, SamState state, const Vec traction[WAYS], double *energy)
{
  const SamViscous *v = (const SamViscous *)e->data;

  PetscFunctionBegin;
  *energy = 0;
  for (PetscInt j = 0; j < v->terms && v->duration > 0; j++) {
    if (v->alike) PetscCall(AddTerm(e, state, j, -1, traction, energy));
    for (PetscInt b = 0; b < 2 && !v->alike; b++) PetscCall(AddTerm(e, state, j, b, traction, energy));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousMemoryAdvance(SamElasticity e, SamState state, Vec pressure, Vec shear)
{
  const SamViscous *v              = (const SamViscous *)e->data;
  const Vec         traction[WAYS] = {pressure, shear};
  Vec               to;

  PetscFunctionBegin;
  PetscCall(FindEnergy(e, state, traction, SamStateNumbers(state, SamStateFindNumber(state, ENERGY), SAM_TRIED)));
  for (PetscInt way = 0; way < WAYS; way++) {
    const Vec before = Committed(state, last[way]);

    for (PetscInt j = 0; j < v->terms; j++) {
      const Vec memory = Committed(state, NameOf(way, j));

      PetscCall(Clear(state, NameOf(way, j), &to));
      if (memory) PetscCall(VecAXPY(to, (double)v->term[j].kept, memory));
      if (before) PetscCall(VecAXPY(to, (double)v->term[j].before, before));
      PetscCall(VecAXPY(to, (double)v->term[j].now, traction[way]));
    }
    PetscCall(Clear(state, last[way], &to));
    PetscCall(VecCopy(traction[way], to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
