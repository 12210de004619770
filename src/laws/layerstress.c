/*
  Stresses in layers: a part of the stresses in a body (private/stresspart.h), which laws add to those by tractions, for
  instance by plastic strain. They are means over the layers, and are interpolated linearly between the middles of
  layers, as smooth strain has an error of second order in the thickness anyway. At the surface zz, xz and yz are zero;
  the others are extrapolated from the first two layers. If the body has layers of other materials on its substrate,
  these stresses are those of the substrate only, and all of them are extrapolated to its top.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/body.h>
#include <petsam/private/grid.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/stresspart.h>
#include <math.h>

typedef struct {
  PetscInt              groups;
  const SamStateLayers *group[SAM_LAYER_GROUPS]; /* borrowed */
} Layers;

static const SamStateLayers *GroupOf(SamStressPart part, PetscInt g)
{
  return ((const Layers *)part->data)->group[g];
}

/* Returns the number of layers with stresses that a group has in the body. */
static PetscInt CountLayers(SamStressPart part, PetscInt g)
{
  return GroupOf(part, g)->stresses ? GroupOf(part, g)->count[part->places->body - 1] : 0;
}

/* Returns the place along z of a layer, counted from the surface of the body down. */
static PetscInt PlaceOf(SamStressPart part, PetscInt g, PetscInt layer)
{
  const PetscInt above = GroupOf(part, g)->count[0];

  return part->places->body == 1 ? above - 1 - layer : above + layer;
}

static double MiddleOf(SamStressPart part, PetscInt g, PetscInt layer)
{
  return fabs((double)GroupOf(part, g)->z[PlaceOf(part, g, layer)]);
}

/* Returns the depth at which the substrate, and with it the layers of all groups, begin. */
static double TopOf(SamStressPart part)
{
  return (double)SamBodyAt(part->body, INFINITY).top;
}

/* Returns the depth of the bottom of the last layer. */
static double BottomOf(SamStressPart part, PetscInt g)
{
  double bottom = TopOf(part);

  for (PetscInt l = 0; l < CountLayers(part, g); l++) bottom += 2 * (MiddleOf(part, g, l) - bottom);
  return bottom;
}

/* Checks the request for a group with layers in the body. */
static PetscErrorCode CheckGroup(SamStressPart part, PetscInt g)
{
  const SamStressPlaces *const places = part->places;
  const SamStateLayers *const  group  = GroupOf(part, g);
  const MPI_Comm               comm   = places->grid->comm;
  const double                 depth  = places->depths ? (double)places->depth[places->depths - 1] : 0;

  PetscFunctionBegin;
  PetscCheck(group->z, comm, SAM_ERR_USER,
             "%s: body %" PetscInt_FMT " has stresses besides those by tractions, and they are not there: petsam "
             "-output_fields usual,%s saves them",
             part->source->name, places->body, group->group);
  PetscCheck(CountLayers(part, g) > 1, comm, SAM_ERR_USER,
             "%s: %s has one layer, between which and others nothing can be interpolated", part->source->name,
             group->group);
  PetscCheck(!places->passing, comm, SAM_ERR_USER,
             "-passing: the stresses of %s in body %" PetscInt_FMT " differ along a row: omit it", group->group,
             places->body);
  PetscCheck(!part->source->slides || places->body == 1, comm, SAM_ERR_USER,
             "-body 2: its points slide through the layers of %s: not supported", group->group);
  PetscCheck(!places->depths ||
               ((double)places->depth[0] >= TopOf(part) * (1 - 1e-9) && (TopOf(part) == 0 || places->side[0] >= 0)),
             comm, SAM_ERR_USER,
             "-depths: %.6g m is above the substrate of body %" PetscInt_FMT ", which begins at %.6g m: the stress of "
             "%s is not known there: give depths from %.6g+ on",
             places->depths ? (double)places->depth[0] : 0.0, places->body, TopOf(part), group->group, TopOf(part));
  PetscCheck(depth <= BottomOf(part, g) * (1 + 1e-9), comm, SAM_ERR_USER,
             "-depths: %.6g m is below the layers of %s, which end at %.6g m, where their stresses are not known: "
             "give depths down to it, or petsam deeper layers (petsam -help %s)",
             depth, group->group, BottomOf(part, g), group->group);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the weight of the mean over layer l in component c at a depth. */
static double Weight(SamStressPart part, PetscInt g, PetscReal depth, PetscInt l, PetscInt c)
{
  const PetscInt last  = CountLayers(part, g) - 1;
  PetscInt       below = 1; /* the second of the two layers with a weight */
  double         share;

  if (TopOf(part) == 0 && (double)depth < MiddleOf(part, g, 0) &&
      (c == SAM_STRESS_ZZ || c == SAM_STRESS_XZ || c == SAM_STRESS_YZ))
    return l ? 0 : (double)depth / MiddleOf(part, g, 0);
  while (below < last && (double)depth > MiddleOf(part, g, below)) below++;
  share = ((double)depth - MiddleOf(part, g, below - 1)) / (MiddleOf(part, g, below) - MiddleOf(part, g, below - 1));
  return l == below ? share : l == below - 1 ? 1 - share : 0;
}

/*
  Reads the mean of a component over a layer at the points of one depth; for a section all ranks get the whole line. The
  z of the results points into body 2, so that the shears of body 1 change their sign.
*/
static PetscErrorCode ReadPlane(SamStressPart part, PetscInt step, PetscInt group, PetscInt c, PetscInt l,
                                PetscInt plane, double at[])
{
  const SamGrid   g     = part->places->grid;
  const PetscBool turns = part->places->body == 1 && (c == SAM_STRESS_XZ || c == SAM_STRESS_YZ);
  double         *rows;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->cells, &rows));
  PetscCall((*part->source->layer)(part->source->context, step, group, c, PlaceOf(part, group, l), rows));
  for (PetscInt k = 0; k < g->cells && turns; k++) rows[k] = -rows[k];
  PetscCall(part->places->section ? SamPlacesTakeLine(part->places, rows, plane, at) : PetscArraycpy(at, rows, plane));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddGroup(SamStressPart part, PetscInt step, PetscInt g, const SamPoints *p, double stress[])
{
  double *at;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(p->plane, &at));
  for (PetscInt l = 0; l < CountLayers(part, g); l++)
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) {
      if (!part->places->section && Weight(part, g, part->places->depth[p->depth], l, c) == 0) continue;
      PetscCall(ReadPlane(part, step, g, c, l, p->plane, at));
      for (PetscInt depth = 0; depth < p->depths; depth++) {
        const double  weight = Weight(part, g, part->places->depth[p->depth + depth], l, c);
        double *const s      = stress + c * (ptrdiff_t)p->count + depth * (ptrdiff_t)p->plane;

        for (PetscInt i = 0; i < p->plane && weight != 0; i++) s[i] += weight * at[i];
      }
    }
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Add(SamStressPart part, PetscInt step, const SamPoints *p, double stress[])
{
  PetscFunctionBegin;
  for (PetscInt g = 0; g < ((const Layers *)part->data)->groups; g++)
    if (CountLayers(part, g)) PetscCall(AddGroup(part, step, g, p, stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamStressPart part)
{
  const SamStateLayers *group;
  Layers               *layers;

  PetscFunctionBegin;
  PetscCall(PetscNew(&layers));
  part->data = layers;
  while (part->source->layers && (group = (*part->source->layers)(part->source->context, layers->groups)))
    layers->group[layers->groups++] = group;
  for (PetscInt g = 0; g < layers->groups; g++)
    if (CountLayers(part, g)) {
      PetscCall(CheckGroup(part, g));
      part->initial = part->initial || layers->group[g]->initial;
      part->ops.add = Add;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamStressPartType SamStressPart_Layers = {.name = "layers", .create = Create};
