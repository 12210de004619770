/*
  The plastic strain of material that moves under the cells between two steps.

  Wear removes the surface, so that material comes up: the strain at a depth z below the worn surface is that at z plus
  the depth removed since the step before. Over the depth the strain of a layer is taken as linear, with the harmonic
  mean of the slopes to both neighbours, or none at a maximum (van Leer's limiter), and the mean of this profile over
  the moved layer is the new value. Below the last layer there is no strain.

  The limiter is not linear: so that the strain does not change the volume, its zz is minus the sum of xx and yy. The
  same holds for backstresses.

  Along the surface the grid moves over both bodies if they roll, which the state does, and over body 2 if it slides;
  steps of whole cells are without error, others interpolate.

  Source: B. van Leer, J. Comput. Phys. 32 (1979) 101-136.
*/
#include "plasticnewton.h"
#include <petsam/private/elasticity.h>

/* Moved layers of one cell: where the top of each lies among the old ones */
typedef struct {
  PetscInt layer; /* the old layer; their number: below all */
  double   into;  /* depth below its top, m */
} Place;

/* Finds the places of the tops of all layers, and of the last one's bottom, after a shift. */
static void FindPlaces(const SamPlastic *p, double shift, Place at[])
{
  PetscInt l   = 0;
  double   top = 0, start = 0;

  for (PetscInt m = 0; m <= p->layers; m++) {
    while (l < p->layers && start + shift >= top + (double)p->thickness[l]) top += (double)p->thickness[l++];
    at[m] = (Place){l, l < p->layers ? start + shift - top : 0};
    if (m < p->layers) start += (double)p->thickness[m];
  }
}

/* Returns the slope of a profile of layer means in layer l. */
static double SlopeIn(const SamPlastic *p, const double f[], PetscInt l)
{
  const PetscInt up = PetscMax(l - 1, 0), down = PetscMin(l + 1, p->layers - 1);
  const double   above = l > up ? 2 * (f[l] - f[up]) / (double)(p->thickness[l] + p->thickness[up]) : INFINITY;
  const double   below = l < down ? 2 * (f[down] - f[l]) / (double)(p->thickness[l] + p->thickness[down]) : 0;

  if (isinf(above)) return below; /* of the surface, which is removed, no value is needed */
  if (above * below <= 0) return 0;
  return 2 * above * below / (above + below);
}

/* Returns the integral of a profile from the top of layer l down to a depth in it. */
static double Integrate(const SamPlastic *p, const double f[], const double slope[], PetscInt l, double into)
{
  return into * (f[l] + slope[l] * (into - (double)p->thickness[l]) / 2);
}

/* Replaces a profile by its means over the moved layers. */
static void Shift(const SamPlastic *p, const Place at[], double slope[], double f[])
{
  const PetscInt n = p->layers;

  for (PetscInt l = 0; l < n; l++) slope[l] = SlopeIn(p, f, l);
  for (PetscInt m = 0; m < n; m++) { /* layer m takes from layers at[m].layer >= m on, which are not changed yet */
    double sum = at[m].layer < n ? -Integrate(p, f, slope, at[m].layer, at[m].into) : 0;

    for (PetscInt l = at[m].layer; l < at[m + 1].layer; l++) sum += f[l] * (double)p->thickness[l];
    if (at[m + 1].layer < n) sum += Integrate(p, f, slope, at[m + 1].layer, at[m + 1].into);
    f[m] = sum / (double)p->thickness[m];
  }
}

/* True if value c of a layer is the component zz of a tensor. */
static PetscBool IsAcross(PetscInt c)
{
  if (c == PARTS) return PETSC_FALSE; /* the accumulated strain */
  return (c < PARTS ? c : (c - PARTS - 1) % PARTS) == SAM_STRESS_ZZ ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamPlasticRaise(const SamPlastic *p, PetscInt body, const double removed[], double strain[])
{
  const PetscInt  cells = p->grid->cells, n = p->layers;
  double *const   of   = strain + (ptrdiff_t)body * n * p->size * cells;
  const ptrdiff_t next = (ptrdiff_t)p->size * cells; /* from a layer to the next */
  const PetscInt  xx = SAM_STRESS_XX - SAM_STRESS_ZZ, yy = SAM_STRESS_YY - SAM_STRESS_ZZ;
  double         *f, *slope;
  Place          *at;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(n, &f, n, &slope, n + 1, &at));
  for (PetscInt k = 0; k < cells; k++) {
    if (!(removed[k] > 0)) continue;
    FindPlaces(p, removed[k], at);
    for (PetscInt c = 0; c < p->size; c++) { /* xx and yy of a tensor come before its zz */
      double *const value = of + c * cells + k;

      for (PetscInt l = 0; l < n && IsAcross(c); l++)
        value[l * next] = -(value[l * next + xx * cells] + value[l * next + yy * cells]);
      if (IsAcross(c)) continue;
      for (PetscInt l = 0; l < n; l++) f[l] = value[l * next];
      Shift(p, at, slope, f);
      for (PetscInt l = 0; l < n; l++) value[l * next] = f[l];
    }
  }
  PetscCall(PetscFree3(f, slope, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticSlide(const SamPlastic *p, const PetscReal slide[2], Vec strain)
{
  const SamGrid   grid   = p->grid;
  const PetscInt  values = p->layers * p->size, count = values * grid->cells;
  const ptrdiff_t first  = (ptrdiff_t)p->body[p->bodies - 1].first * p->size * grid->cells;
  const SamBorder border = SamElasticityGetTraits(p->elasticity).periodic ? SAM_BORDER_WRAPS : SAM_BORDER_ZERO;
  double         *all, *part;
  Vec             before, after;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, values, &before));
  PetscCall(SamGridCreateVec(grid, values, &after));
  PetscCall(VecGetArray(strain, &all));
  PetscCall(VecGetArray(before, &part));
  PetscCall(PetscArraycpy(part, all + first, count));
  PetscCall(VecRestoreArray(before, &part));
  PetscCall(SamGridMove(grid, values, slide, border, before, after));
  PetscCall(VecGetArray(after, &part));
  PetscCall(PetscArraycpy(all + first, part, count));
  PetscCall(VecRestoreArray(after, &part));
  PetscCall(VecRestoreArray(strain, &all));
  PetscCall(VecDestroy(&after));
  PetscCall(VecDestroy(&before));
  PetscFunctionReturn(PETSC_SUCCESS);
}
