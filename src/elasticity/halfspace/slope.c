/*
  Integrals of 1/r over a cell whose pressure is linear, and zero in the mean.

  Method: Gauss' quadrature over parts of the cell that are nearly square, and no longer than a fifth of the distance
  where that is more. If the nearest singularity lies t half sides from a part, n points in each direction are wrong by
  the order of (t + sqrt(t^2 + 1))^-2n at most. The kernel is singular at the point, which is the centre of a cell, so
  that t is at least 1: 16 points give 1e-12, 8 from t = 3 on 2e-13, 4 from t = 9 on 1e-10, and 2 from t = 60 on 5e-9.
  Over the point's own cell the integral vanishes, as the integrand is odd.

  Reference: Davis, P.J., Rabinowitz, P. (1984). Methods of Numerical Integration, section 4.6. Academic Press.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/halfspace.h>
#include <petscdt.h>
#include <math.h>

/* Cells of a row that take the same rule, so that they are worked off together. */
#define BLOCK 64

PetscErrorCode SamSlopeRulesCreate(SamSlopeRules *rules)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_SLOPE_RULES; k++)
    PetscCall(PetscDTGaussQuadrature(2 << k, -0.5, 0.5, rules->x[k], rules->w[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rule for a part whose longer side is `side`, its centre at that distance from the point. */
static int RuleFor(double distance, double side)
{
  const double t = 2 * distance / side - 1;

  return t >= 60 ? 0 : t >= 9 ? 1 : t >= 3 ? 2 : 3;
}

/* values[i] += weight times the kernel at a point that lies (x + i dx, y) from a place. */
SAM_VECTORIZED static void AddPlace(const SamSlopeKernel *restrict kernel, double weight, double x, double y,
                                    PetscInt n, double *restrict values)
{
  const double factor = weight * kernel->factor, dx = kernel->dx;

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) {
    const double at = x + (double)i * dx;

    values[i] += sqrt(1 / (at * at + y * y)) * factor;
  }
}

/* Adds the integrals over n cells of a row from (x, y) on, by parts and the rule k. */
static void AddCells(const SamSlopeKernel *kernel, int k, const int parts[2], double x, double y, PetscInt n,
                     double values[])
{
  const SamSlopeRules *rules   = kernel->rules;
  const int            axis    = kernel->axis;
  const double         cell[2] = {kernel->dx, kernel->dy}, side[2] = {cell[0] / parts[0], cell[1] / parts[1]};

  for (int part = 0; part < parts[0] * parts[1]; part++)
    for (int b = 0; b < 2 << k; b++)
      for (int a = 0; a < 2 << k; a++) {
        const double at[2] = {(part % parts[0] + 0.5 + rules->x[k][a]) * side[0] - 0.5 * cell[0],
                              (part / parts[0] + 0.5 + rules->x[k][b]) * side[1] - 0.5 * cell[1]};

        AddPlace(kernel, side[0] * side[1] * rules->w[k][a] * rules->w[k][b] * at[axis] / cell[axis], x - at[0],
                 y - at[1], n, values);
      }
}

void SamSlopeRow(const SamSlopeKernel *kernel, ptrdiff_t j, ptrdiff_t n, double values[])
{
  const double dx = kernel->dx, dy = kernel->dy, y = (double)j * dy;

  for (ptrdiff_t i = 0; i < n; i += BLOCK) {
    const ptrdiff_t first = i == 0 && j == 0 ? 1 : i, end = PetscMin(i + BLOCK, n);
    const double    distance = hypot((double)first * dx, y), most = PetscMax(PetscMin(dx, dy), 0.2 * distance);
    const int       parts[2] = {(int)ceil(dx / most - 1e-9), (int)ceil(dy / most - 1e-9)};
    const int       rule     = RuleFor(PetscMax(distance - 0.5 * PetscMax(dx, dy), 0.5 * PetscMin(dx, dy)) +
                                         0.5 * PetscMax(dx / parts[0], dy / parts[1]),
                                       PetscMax(dx / parts[0], dy / parts[1]));

    for (ptrdiff_t k = i; k < end; k++) values[k] = 0;
    AddCells(kernel, rule, parts, (double)first * dx, y, (PetscInt)(end - first), values + first);
  }
}
