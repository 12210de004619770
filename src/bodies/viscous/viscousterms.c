/*
  The terms of the creep of both bodies: what they add to the constants of the pair, and the products that displace by
  them (viscous.c).
*/
#include "viscous.h"
#include <math.h>
#include <stdio.h>

enum { A, B, D };      /* the constants of a pair */
#define ROUNDING 1e-12 /* of the constants of a term, relative */

PetscBool SamViscousHasBulk(SamElasticity e, PetscInt body)
{
  return ((const SamViscous *)e->data)->bulk[body] && (double)e->pair->body[body]->material[0].poisson < 0.5
           ? PETSC_TRUE
           : PETSC_FALSE;
}

const char *SamViscousFieldName(PetscInt way, PetscInt j)
{
  static char names[2][SAM_VISCOUS_TERMS][32];

  (void)snprintf(names[way][j], sizeof(names[way][j]), "viscous_%s_%d", way ? "shear" : "pressure", (int)j + 1);
  return names[way][j];
}

/* Adds the terms of a creep function, whose value under a sudden load adds these constants to those of the pair, and
   whose modulus has `scale` of the parts of G that relax; terms of one time and one speed are one term. */
static void AddCreep(SamViscous *v, PetscInt body, double scale, const double value[SAM_PAIR_CONSTANTS])
{
  PetscReal moduli[SAM_CREEP_TERMS];
  SamCreep  creep;

  for (PetscInt k = 0; k < v->relaxes[body]; k++) moduli[k] = scale * v->moduli[body][k];
  SamCreepFromRelaxation(v->relaxes[body], moduli, v->times[body], &creep);
  for (PetscInt k = 0; k < creep.count; k++) {
    PetscInt j = 0;

    while (j < v->terms && ((double)v->term[j].time != creep.time[k] || v->term[j].speed != v->speed[body])) j++;
    v->term[j].time  = creep.time[k];
    v->term[j].speed = v->speed[body];
    for (int n = 0; n < SAM_PAIR_CONSTANTS; n++) v->term[j].value[n] += creep.part[k] * value[n];
    v->terms = PetscMax(v->terms, j + 1);
  }
}

/* Adds the terms of a body that relaxes: its constants A and B are (a + b)/2 and (a - b)/2, and D is b. */
static PetscErrorCode AddTerms(SamElasticity e, PetscInt b)
{
  const SamMaterial rigid = {INFINITY, 0, 0};
  const SamBody    *body  = e->pair->body;
  double            value[SAM_PAIR_CONSTANTS], half;
  SamBody           base;
  SamPair           pair;

  PetscFunctionBegin;
  if (!((const SamViscous *)e->data)->relaxes[b]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamBodyCreate(1, &rigid, &base));
  PetscCall(SamPairCreate(b ? base : body[0], b ? body[1] : base, &pair));
  SamPairGetValues(pair, value);
  PetscCall(SamPairDestroy(&pair));
  PetscCall(SamBodyDestroy(&base));
  if (!SamViscousHasBulk(e, b)) {
    AddCreep((SamViscous *)e->data, b, 1, value);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  half = (value[A] + value[B]) / 2;
  AddCreep((SamViscous *)e->data, b, 1, (double[]){half, half, 0});
  half = (value[A] - value[B]) / 2;
  AddCreep((SamViscous *)e->data, b, (1 - 2 * (double)body[b]->material[0].poisson) / 3,
           (double[]){half, -half, value[D]});
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if the constants of the bodies keep their ratios; bodies that do not creep alike are coupled. */
static void Compare(SamElasticity e)
{
  SamViscous *v = (SamViscous *)e->data;
  double      sudden[SAM_PAIR_CONSTANTS];

  SamPairGetValues(e->pair, sudden);
  for (PetscInt j = 0; j < v->terms; j++) {
    const double *value = v->term[j].value;

    if (fabs(value[B] * sudden[A] - value[A] * sudden[B]) > ROUNDING * value[A] * sudden[A]) v->mixes = PETSC_TRUE;
    if (fabs(value[D]) > ROUNDING * value[A] && !e->traits.coupled) v->pushes = PETSC_TRUE;
  }
  if (v->pushes) e->traits.coupled = PETSC_TRUE;
}

PetscErrorCode SamViscousSetTerms(SamElasticity e)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) PetscCall(AddTerms(e, b));
  Compare(e);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamViscousGetConstants(SamElasticity e, double value[SAM_PAIR_CONSTANTS])
{
  const SamViscous *v = ((const SamViscous *)e->data)->finest;

  SamPairGetValues(e->pair, value);
  for (PetscInt j = 0; j < v->terms; j++)
    for (int k = 0; k < SAM_PAIR_CONSTANTS; k++) value[k] += v->term[j].value[k] * v->term[j].step.now;
}

void SamViscousFindFactors(SamElasticity e, const double value[SAM_PAIR_CONSTANTS], double factor[SAM_VISCOUS_PRODUCTS])
{
  const SamViscous *v                          = (const SamViscous *)e->data;
  double            sudden[SAM_PAIR_CONSTANTS] = {0}, other[SAM_PAIR_CONSTANTS] = {0}, part = 0;

  for (int k = 0; k < SAM_VISCOUS_PRODUCTS; k++) factor[k] = k == SAM_VISCOUS_OTHER_SHEAR ? 0 : 1;
  if (v->finest->streams) return; /* the products of the inner bodies contain the creep */
  SamPairGetValues(e->pair, sudden);
  if (v->other) SamPairGetValues(v->other->pair, other);
  if (v->finest->mixes)
    part = (sudden[A] * value[B] - sudden[B] * value[A]) / (sudden[A] * other[B] - sudden[B] * other[A]);
  factor[SAM_VISCOUS_NORMAL]      = value[A] / sudden[A];
  factor[SAM_VISCOUS_SHEAR]       = (value[A] - part * other[A]) / sudden[A];
  factor[SAM_VISCOUS_OTHER_SHEAR] = part;
  factor[SAM_VISCOUS_PUSH]        = e->traits.coupled ? value[D] / (v->finest->pushes ? other : sudden)[D] : 0;
  factor[SAM_VISCOUS_LIFT]        = factor[SAM_VISCOUS_PUSH];
}
