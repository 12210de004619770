/*
  The return to von Mises' yield surface at the end of a step.

  With xi(x) = 2 mu (d - e) - sum X/(1 + g x) the increment x of the accumulated plastic strain solves
      sqrt(3/2) |xi(x)| = yield stress(p + x) + 3 mu x + sum C x/(1 + g x),
  by Newton's method from 0; the plastic strain grows by sqrt(3/2) x xi/|xi|. The unsymmetric part of the tangent, which
  exists if g > 0, is omitted, because the tangent is the matrix of conjugate gradients.

  Source: J. L. Chaboche, Constitutive equations for cyclic plasticity and cyclic viscoplasticity, Int. J. Plast. 5
  (1989) 247-302; J. C. Simo and T. J. R. Hughes, Computational Inelasticity (1998), chapter 3.
*/
#include "mises.h"

#define STEPS  50
#define ENOUGH 1e-14 /* relative to the yield stress */

double SamMisesYield(const SamMises *m, double p, double *slope)
{
  const double *const k = m->hardening.constant;
  double              value, unused;

  if (!slope) slope = &unused;
  switch (m->hardening.type) {
  case SAM_HARDENING_VOCE:
    value  = k[0] * exp(-k[1] * p);
    *slope = k[1] * value;
    return m->yield + k[0] - value;
  case SAM_HARDENING_SWIFT:
    value  = m->yield * pow(1 + p / k[0], k[1]);
    *slope = k[1] * value / (k[0] + p);
    return value;
  case SAM_HARDENING_LINEAR:
    *slope = k[0];
    return m->yield + k[0] * p;
  default:
    *slope = 0;
    return m->yield;
  }
}

/* Returns the integral of the yield stress from p = 0 on (Pa). */
static double Integral(const SamMises *m, double p)
{
  const double *const k = m->hardening.constant;

  switch (m->hardening.type) {
  case SAM_HARDENING_VOCE:
    return (m->yield + k[0]) * p + (k[1] > 0 ? k[0] * expm1(-k[1] * p) / k[1] : -k[0] * p);
  case SAM_HARDENING_SWIFT:
    return m->yield * k[0] / (k[1] + 1) * expm1((k[1] + 1) * log1p(p / k[0]));
  case SAM_HARDENING_LINEAR:
    return (m->yield + k[0] * p / 2) * p;
  default:
    return m->yield * p;
  }
}

double SamMisesWork(const SamMises *m, const SamMisesAt *from, const SamMisesAt *to, double *change)
{
  double work = Integral(m, to->p) - Integral(m, from->p), back = 0;

  for (PetscInt b = 0; b < m->backstresses; b++)
    for (PetscInt c = 0; c < PARTS; c++) {
      const double e = (c > SAM_STRESS_ZZ ? 2 : 1) * (to->e[c] - from->e[c]);

      work += (from->back[b][c] + to->back[b][c]) / 2 * e;
      back += (to->back[b][c] - from->back[b][c]) * e;
    }
  *change = fabs(back);
  return work;
}

double SamMisesExcess(const SamMises *m, const SamMisesAt *at, const double stress[PARTS])
{
  double xi[PARTS];

  memcpy(xi, stress, sizeof(xi));
  SamTensorDeviator(xi);
  for (PetscInt b = 0; b < m->backstresses; b++)
    for (PetscInt c = 0; c < PARTS; c++) xi[c] -= at->back[b][c];
  return sqrt(1.5 * SamTensorDot(xi, xi)) - SamMisesYield(m, at->p, NULL);
}

/*
  Returns the distance of an increment x from the yield surface (Pa), and its derivative by -x. Sets xi to its value at
  x, as a unit tensor; `size`: its length.
*/
static double Residual(const SamMises *m, const double d[PARTS], const SamMisesAt *at, double x, double xi[PARTS],
                       double *size, double *slope)
{
  double turn[PARTS] = {0}, left, more;

  for (PetscInt c = 0; c < PARTS; c++) xi[c] = 2 * m->shear * (d[c] - at->e[c]);
  left   = -SamMisesYield(m, at->p + x, &more) - 3 * m->shear * x;
  *slope = 3 * m->shear + more;
  for (PetscInt b = 0; b < m->backstresses; b++) {
    const double g = m->back[b][1], part = 1 / (1 + g * x);

    left -= m->back[b][0] * x * part;
    *slope += m->back[b][0] * part * part;
    for (PetscInt c = 0; c < PARTS; c++) {
      xi[c] -= at->back[b][c] * part;
      turn[c] += g * at->back[b][c] * part * part;
    }
  }
  *size = sqrt(SamTensorDot(xi, xi));
  for (PetscInt c = 0; c<PARTS && * size> 0; c++) xi[c] /= *size;
  *slope -= sqrt(1.5) * SamTensorDot(xi, turn);
  return left + sqrt(1.5) * *size;
}

PetscBool SamMisesReturn(const SamMises *m, const double d[PARTS], SamMisesAt *at, SamMisesTangent *t)
{
  double size, slope, x = 0, left = Residual(m, d, at, x, t->n, &size, &slope);

  if (!(left > 0)) return PETSC_FALSE;
  for (PetscInt k = 0; k < STEPS && fabs(left) > ENOUGH * m->yield; k++) {
    x    = PetscMax(0, x + left / slope);
    left = Residual(m, d, at, x, t->n, &size, &slope);
  }
  t->along  = 3 * m->shear / slope;
  t->across = sqrt(6) * m->shear * x / size;
  for (PetscInt c = 0; c < PARTS; c++) {
    const double e = sqrt(1.5) * x * t->n[c];

    at->e[c] += e;
    for (PetscInt b = 0; b < m->backstresses; b++)
      at->back[b][c] = (at->back[b][c] + 2.0 / 3 * m->back[b][0] * e) / (1 + m->back[b][1] * x);
  }
  at->p += x;
  return PETSC_TRUE;
}
