/*
  Stresses in layers: those that laws add to the stresses by tractions, for instance by plastic strain. They are means
  over the layers, and are interpolated linearly between the middles of layers, as smooth strain has an error of second
  order in the thickness anyway. At the surface zz, xz and yz are zero; the others are extrapolated from the first two
  layers. If the body has layers of other materials on its substrate, these stresses are those of the substrate only,
  and all of them are extrapolated to its top.
*/
#include "evaluationimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/grid.h>
#include <math.h>

/* Returns the number of layers with stresses that a group has in the body. */
static PetscInt CountLayers(SamEvaluation e, PetscInt g)
{
  const SamStateLayers *const group = e->source.group[g];

  return group->stresses ? group->count[e->body - 1] : 0;
}

/* Returns the place along z of a layer, counted from the surface of the body down. */
static PetscInt PlaceOf(SamEvaluation e, PetscInt g, PetscInt layer)
{
  const PetscInt above = e->source.group[g]->count[0];

  return e->body == 1 ? above - 1 - layer : above + layer;
}

static double MiddleOf(SamEvaluation e, PetscInt g, PetscInt layer)
{
  return fabs((double)e->source.group[g]->z[PlaceOf(e, g, layer)]);
}

/* Returns the depth at which the substrate, and with it the layers of all groups, begin. */
static double TopOf(SamEvaluation e)
{
  return (double)SamBodySubstrateTop(SamEvaluationBody(e));
}

/* Returns the depth of the bottom of the last layer. */
static double BottomOf(SamEvaluation e, PetscInt g)
{
  double bottom = TopOf(e);

  for (PetscInt l = 0; l < CountLayers(e, g); l++) bottom += 2 * (MiddleOf(e, g, l) - bottom);
  return bottom;
}

PetscErrorCode SamLayersSetUp(SamEvaluation e)
{
  const double depth = e->depths ? (double)e->depth[e->depths - 1] : 0;

  PetscFunctionBegin;
  for (PetscInt g = 0; g < e->source.groups; g++) {
    const SamStateLayers *const group = e->source.group[g];

    if (!CountLayers(e, g)) continue;
    PetscCheck(group->z, e->comm, SAM_ERR_USER,
               "%s: body %" PetscInt_FMT " has stresses besides those by tractions, and they are not there: petsam "
               "-output_fields usual,%s saves them",
               e->source.name, e->body, group->group);
    PetscCheck(CountLayers(e, g) > 1, e->comm, SAM_ERR_USER,
               "%s: %s has one layer, between which and others nothing can be interpolated", e->source.name,
               group->group);
    PetscCheck(!e->passing, e->comm, SAM_ERR_USER,
               "-passing: the stresses of %s in body %" PetscInt_FMT " differ along a row: omit it", group->group,
               e->body);
    PetscCheck(!e->source.slides || e->body == 1, e->comm, SAM_ERR_USER,
               "-body 2: its points slide through the layers of %s: not supported", group->group);
    PetscCheck(!e->depths || ((double)e->depth[0] >= TopOf(e) * (1 - 1e-9) && (TopOf(e) == 0 || e->side[0] >= 0)),
               e->comm, SAM_ERR_USER,
               "-depths: %.6g m is above the substrate of body %" PetscInt_FMT
               ", which begins at %.6g m: the stress of "
               "%s is not known there: give depths from %.6g+ on",
               e->depths ? (double)e->depth[0] : 0.0, e->body, TopOf(e), group->group, TopOf(e));
    PetscCheck(depth <= BottomOf(e, g) * (1 + 1e-9), e->comm, SAM_ERR_USER,
               "-depths: %.6g m is below the layers of %s, which end at %.6g m, where their stresses are not known: "
               "give depths down to it, or petsam deeper layers (petsam -help %s)",
               depth, group->group, BottomOf(e, g), group->group);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamLayersExist(SamEvaluation e)
{
  for (PetscInt g = 0; g < e->source.groups; g++)
    if (CountLayers(e, g)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool SamLayersHaveInitial(SamEvaluation e)
{
  for (PetscInt g = 0; g < e->source.groups; g++)
    if (CountLayers(e, g) && e->source.group[g]->initial) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Returns the weight of the mean over layer l in component c at a depth. */
static double Weight(SamEvaluation e, PetscInt g, PetscReal depth, PetscInt l, PetscInt c)
{
  const PetscInt last  = CountLayers(e, g) - 1;
  PetscInt       below = 1; /* the second of the two layers with a weight */
  double         part;

  if (TopOf(e) == 0 && (double)depth < MiddleOf(e, g, 0) &&
      (c == SAM_STRESS_ZZ || c == SAM_STRESS_XZ || c == SAM_STRESS_YZ))
    return l ? 0 : (double)depth / MiddleOf(e, g, 0);
  while (below < last && (double)depth > MiddleOf(e, g, below)) below++;
  part = ((double)depth - MiddleOf(e, g, below - 1)) / (MiddleOf(e, g, below) - MiddleOf(e, g, below - 1));
  return l == below ? part : l == below - 1 ? 1 - part : 0;
}

/*
  Reads the mean of a component over a layer at the points of one depth; for a section all ranks get the whole line. The
  z of the results points into body 2, so that the shears of body 1 change their sign.
*/
static PetscErrorCode ReadPlane(SamEvaluation e, PetscInt step, PetscInt group, PetscInt c, PetscInt l, PetscInt plane,
                                double at[])
{
  const SamGrid   g     = e->grid;
  const PetscBool turns = e->body == 1 && (c == SAM_STRESS_XZ || c == SAM_STRESS_YZ);
  double         *rows;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->cells, &rows));
  PetscCall((*e->source.layer)(e->source.context, step, group, c, PlaceOf(e, group, l), rows));
  for (PetscInt k = 0; k < g->cells && turns; k++) rows[k] = -rows[k];
  PetscCall(e->section ? SamPointsTakeLine(e, rows, plane, at) : PetscArraycpy(at, rows, plane));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddGroup(SamEvaluation e, PetscInt step, PetscInt g, const SamPoints *p, double stress[])
{
  double *at;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(p->plane, &at));
  for (PetscInt l = 0; l < CountLayers(e, g); l++)
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) {
      if (!e->section && Weight(e, g, e->depth[p->depth], l, c) == 0) continue;
      PetscCall(ReadPlane(e, step, g, c, l, p->plane, at));
      for (PetscInt depth = 0; depth < p->depths; depth++) {
        const double  weight = Weight(e, g, e->depth[p->depth + depth], l, c);
        double *const s      = stress + c * (ptrdiff_t)p->count + depth * (ptrdiff_t)p->plane;

        for (PetscInt i = 0; i < p->plane && weight != 0; i++) s[i] += weight * at[i];
      }
    }
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressAddLayers(SamEvaluation e, PetscInt step, const SamPoints *p, double stress[])
{
  PetscFunctionBegin;
  for (PetscInt g = 0; g < e->source.groups; g++)
    if (CountLayers(e, g)) PetscCall(AddGroup(e, step, g, p, stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}
