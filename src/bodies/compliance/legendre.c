/* The polynomials over the patch of a compliance: Legendre polynomials, each with the norm 1. */
#include <petsam/private/compliance.h>
#include <math.h>
#include <petscdt.h>

void SamComplianceMeans(SamCompliance c, PetscInt axis, double from, double to, double means[])
{
  enum { POINTS = SAM_COMPLIANCE_DEGREE / 2 + 1 };
  PetscReal x[POINTS], w[POINTS];

  (void)PetscDTGaussQuadrature(POINTS, -1, 1, x, w);
  for (PetscInt a = 0; a <= c->degree; a++) means[a] = 0;
  for (PetscInt k = 0; k < POINTS; k++) {
    const double at = 0.5 * (from + to) + 0.5 * (to - from) * x[k];
    const double s  = PetscMin(PetscMax((at - c->center[axis]) / c->half[axis], -1), 1);
    double       p = 1, before = 0;

    for (PetscInt a = 0; a <= c->degree; a++) {
      const double next = ((2 * a + 1) * s * p - a * before) / (a + 1);

      means[a] += 0.5 * w[k] * sqrt((a + 0.5) / c->half[axis]) * p;
      before = p;
      p      = next;
    }
  }
}
