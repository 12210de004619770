/*
  Stresses of a body that yields below its surface: the stresses by plastic strain, which are means over the layers, are
  added to the stresses by tractions. They are interpolated linearly between the middles of layers, as smooth strain has
  an error of second order in the thickness anyway. At the surface zz, xz and yz are zero; the others are extrapolated
  from the first two layers.
*/
#include "evaluationimpl.h"
#include <petsam/private/grid.h>
#include <math.h>

PetscErrorCode SamPlasticSetUp(SamEvaluation e)
{
  const PetscReal depth = e->depths ? e->depth[e->depths - 1] : 0;

  PetscFunctionBegin;
  if (!e->source.yields[e->body - 1]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(e->source.residual, e->comm, SAM_ERR_USER,
             "%s: body %" PetscInt_FMT " yields, and the stresses by its plastic strain are not there: petsam "
             "-output_fields usual,plastic saves them",
             e->source.name, e->body);
  PetscCheck(!e->passing, e->comm, SAM_ERR_USER,
             "-passing: body %" PetscInt_FMT " yields, so the points of a row are not alike: omit it", e->body);
  PetscCheck(depth <= e->source.yield_depth * (1 + 1e-9), e->comm, SAM_ERR_USER,
             "-depths: %.6g m is below the %.6g m of -yield_depth, where the stresses by plastic strain are not "
             "known: give depths down to it, or petsam a larger -yield_depth",
             (double)depth, (double)e->source.yield_depth);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the weight of the mean over layer l in component c at a depth. */
static double Weight(SamEvaluation e, PetscReal depth, PetscInt l, PetscInt c)
{
  const double *const middle = e->source.middle;
  const PetscInt      last   = e->source.layers - 1;
  PetscInt            below  = 1; /* the second of the two layers with a weight */
  double              part;

  if (depth < middle[0] && (c == SAM_STRESS_ZZ || c == SAM_STRESS_XZ || c == SAM_STRESS_YZ))
    return l ? 0 : (double)depth / middle[0];
  while (below < last && depth > middle[below]) below++;
  part = ((double)depth - middle[below - 1]) / (middle[below] - middle[below - 1]);
  return l == below ? part : l == below - 1 ? 1 - part : 0;
}

/* Reads the mean of a component over a layer at the points of one depth; for a section all ranks get the whole line. */
static PetscErrorCode ReadPlane(SamEvaluation e, PetscInt step, PetscInt c, PetscInt l, PetscInt plane, double at[])
{
  const SamGrid g = e->grid;
  double       *rows;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->cells, &rows));
  PetscCall((*e->source.residual)(e->source.context, step, e->body, c, l, rows));
  if (!e->section) PetscCall(PetscArraycpy(at, rows, plane));
  if (e->section) {
    PetscCall(PetscArrayzero(at, plane));
    for (PetscInt k = 0; k < g->cells; k++) {
      const PetscInt i = k % g->nx, j = g->row_start + k / g->nx;

      if (e->index == (e->axis == SAM_SECTION_X ? j : i)) at[e->axis == SAM_SECTION_X ? i : j] = rows[k];
    }
    PetscCall(SamSum(g->comm, plane, at));
  }
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressAddPlastic(SamEvaluation e, PetscInt step, const SamPoints *p, double stress[])
{
  double *at;

  PetscFunctionBegin;
  if (!e->source.yields[e->body - 1]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(p->plane, &at));
  for (PetscInt l = 0; l < e->source.layers; l++)
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) {
      if (!e->section && Weight(e, e->depth[p->depth], l, c) == 0) continue;
      PetscCall(ReadPlane(e, step, c, l, p->plane, at));
      for (PetscInt depth = 0; depth < p->depths; depth++) {
        const double  weight = Weight(e, e->depth[p->depth + depth], l, c);
        double *const s      = stress + c * (ptrdiff_t)p->count + depth * (ptrdiff_t)p->plane;

        for (PetscInt i = 0; i < p->plane && weight != 0; i++) s[i] += weight * at[i];
      }
    }
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}
