/*
  Means of the stress over a length, from which fatigue parameters are computed. Unlike the largest value at a point,
  they do not depend on the grid, and they account for the size effect (critical distances).

  Below each cell of the surface, L being the length:
    point  the stress at the depth L/2
    line   (1/2L) times its integral from 0 to 2L
    area   (2/pi L^2) times its integral over the half disc of radius L in the plane of the line of cells and z

  The depths are Gauss points in t, z = Z t^2, as stresses vary most near the surface. At each depth a half disc uses
  the mean over its chord, by cells and parts of cells; beyond the grid the stress is zero.
*/
#include "evaluationimpl.h"
#include <petsam/private/body.h>
#include <petscdt.h>

#define DEPTHS   16
#define SHORTEST 1e-3 /* length of a mean, in cells */

/* Checks that the mean is over one material. */
static PetscErrorCode CheckMaterial(SamEvaluation e)
{
  const PetscReal deepest = e->depth[e->depths - 1], bottom = SamBodyAt(SamEvaluationBody(e), 0).bottom;

  PetscFunctionBegin;
  PetscCheck(
    deepest < bottom, e->comm, SAM_ERR_USER,
    "-fatigue_length: the mean reaches %.4g m deep, through the first material of %.4g m: choose a shorter one",
    (double)deepest, (double)bottom);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAverageSetUp(SamEvaluation e)
{
  const PetscInt  n     = e->average == SAM_AVERAGE_POINT ? 1 : DEPTHS;
  const PetscReal reach = e->average == SAM_AVERAGE_LINE ? 2 * e->length : e->length;
  PetscReal       t[DEPTHS], w[DEPTHS], z[DEPTHS], sum = 0;

  PetscFunctionBegin;
  PetscCall(PetscFree(e->weight));
  if (e->average == SAM_AVERAGE_NONE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(e->length >= SHORTEST * e->grid->side[0] && e->length <= 2 * e->grid->length, e->comm, SAM_ERR_USER,
             "-fatigue_length %.6g: expected a length from %.3g m, a thousandth of a cell, to the grid's width, %.3g m",
             (double)e->length, (double)(SHORTEST * e->grid->side[0]), 2 * (double)e->grid->length);
  PetscCheck(e->cycle, e->comm, SAM_ERR_USER, "-fatigue_length is given without -fatigue");
  PetscCheck(!SamQuantityWanted(e, SamFatigueRuiz), e->comm, SAM_ERR_USER,
             "-fatigue ruiz: is of the surface, and not of a mean over -fatigue_length: omit one of them");
  PetscCall(PetscDTGaussQuadrature(n, 0, 1, t, w));
  PetscCall(PetscMalloc1(n, &e->weight));
  for (PetscInt k = 0; k < n; k++) {
    z[k]         = n == 1 ? e->length / 2 : reach * t[k] * t[k];
    e->weight[k] = w[k] * t[k];
    if (e->average == SAM_AVERAGE_AREA) e->weight[k] *= PetscSqrtReal(1 - PetscSqr(z[k] / reach));
    sum += e->weight[k];
  }
  for (PetscInt k = 0; k < n; k++) e->weight[k] /= sum;
  PetscCall(SamDepthsTake(e, "-fatigue_length", n, z, NULL));
  PetscCall(CheckMaterial(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the integral of a line up to x cells from its beginning; sums[i]: integral over its first i cells. */
static double IntegralTo(const double sums[], PetscInt length, double x)
{
  const double   inside = PetscMin(PetscMax(x, 0), (double)length);
  const PetscInt i      = (PetscInt)PetscMin(floor(inside), (double)(length - 1));

  return sums[i] + (inside - (double)i) * (sums[i + 1] - sums[i]);
}

PetscErrorCode SamAverageAdd(SamEvaluation e, PetscInt k, PetscInt length, ptrdiff_t n, const double from[],
                             double to[])
{
  const PetscReal side = e->section && e->axis == SAM_SECTION_Y ? e->grid->dy : e->grid->dx;
  const double    half = PetscMax(PetscSqrtReal(PetscMax(0, PetscSqr(e->length) - PetscSqr(e->depth[k]))) / side, 0.5);
  double         *sums;

  PetscFunctionBegin;
  if (e->average != SAM_AVERAGE_AREA) {
    for (ptrdiff_t i = 0; i < n; i++) to[i] += e->weight[k] * from[i];
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(length + 1, &sums));
  for (ptrdiff_t first = 0; first < n; first += length) {
    sums[0] = 0;
    for (PetscInt i = 0; i < length; i++) sums[i + 1] = sums[i] + from[first + i];
    for (PetscInt i = 0; i < length; i++) {
      const double low = PetscMax(i + 0.5 - half, 0), high = PetscMin(i + 0.5 + half, (double)length);

      to[first + i] += e->weight[k] * (IntegralTo(sums, length, high) - IntegralTo(sums, length, low)) / (high - low);
    }
  }
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}
