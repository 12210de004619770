/*
  The parts of the stresses in a body besides those by tractions: their types, and what all parts share.

  Parts by whole planes compute the planes of all depths of a section, in all steps, before the stresses, because ranks
  share these depths then; of maps a plane is computed when it is needed.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/grid.h>
#include <petsam/private/stresspart.h>

/* ---- the types ---- */

static const SamStressPartType *types[SAM_STRESS_PART_TYPES];
static PetscInt                 count;

PetscErrorCode SamStressPartRegister(const SamStressPartType *type)
{
  PetscInt k = 0;

  PetscFunctionBegin;
  while (k < count && strcmp(types[k]->name, type->name)) k++;
  PetscCheck(k < SAM_STRESS_PART_TYPES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "More than %d types of parts of stress: %s", SAM_STRESS_PART_TYPES, type->name);
  types[k] = type;
  count    = PetscMax(count, k + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamStressPartType *SamStressPartGetType(PetscInt k)
{
  return k < count ? types[k] : NULL;
}

const char *SamStressField(PetscInt k)
{
  static const char *const own[SAM_STRESS_TRACTIONS + SAM_STRESS_SLIP_FIELDS] = {"pressure", "shear_x", "shear_y",
                                                                                 "slip_x", "slip_y"};

  if (k >= SAM_STRESS_FIELDS) return NULL;
  if (k < SAM_STRESS_TRACTIONS + SAM_STRESS_SLIP_FIELDS) return own[k];
  k -= SAM_STRESS_TRACTIONS + SAM_STRESS_SLIP_FIELDS;
  for (PetscInt t = 0; t < count; t++)
    for (PetscInt f = 0; f < SAM_STRESS_PART_FIELDS && types[t]->fields[f]; f++)
      if (k-- == 0) return types[t]->fields[f];
  return NULL;
}

PetscInt SamStressFieldFind(const char name[])
{
  for (PetscInt k = 0; SamStressField(k); k++)
    if (!strcmp(SamStressField(k), name)) return k;
  return SAM_STRESS_FIELDS;
}

/* ---- the parts of an evaluation ---- */

struct _n_SamStressParts {
  PetscInt                n;
  const SamStressSource  *source;
  const SamStressPlaces  *places;
  struct _n_SamStressPart part[SAM_STRESS_PART_TYPES];
};

PetscErrorCode SamStressPartsCreate(const SamStressSource *source, const SamStressPlaces *places,
                                    SamConditions conditions, const SamControl control[], const PetscBool wanted[],
                                    SamStressParts *parts)
{
  SamStressParts all;

  PetscFunctionBegin;
  PetscCall(PetscNew(&all));
  *parts      = all;
  all->source = source;
  all->places = places;
  for (PetscInt k = 0; k < count; k++) {
    SamStressPart part = &all->part[all->n++];

    part->type       = types[k];
    part->source     = source;
    part->places     = places;
    part->body       = SamPairBody(SamElasticityGetPair(source->bodies), places->body - 1);
    part->conditions = conditions;
    part->control    = control;
    part->wanted     = wanted[k];
    PetscCall((*types[k]->create)(part));
    if (part->ops.plane) PetscCall(SamGridCreateVec(places->grid, SAM_STRESS_COMPONENTS, &part->plane.field));
    if (part->ops.value) PetscCall(SamGridCreateVec(places->grid, 1, &part->value.field));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressPartsDestroy(SamStressParts *parts)
{
  SamStressParts all = *parts;

  PetscFunctionBegin;
  *parts = NULL;
  for (PetscInt k = 0; all && k < all->n; k++) {
    SamStressPart part = &all->part[k];

    if (part->ops.destroy) PetscCall((*part->ops.destroy)(part));
    PetscCall(PetscFree(part->data));
    PetscCall(VecDestroy(&part->plane.field));
    PetscCall(VecDestroy(&part->value.field));
    SamFree(part->plane.line);
    SamFree(part->value.line);
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- planes ---- */

PetscErrorCode SamPlacesTakeLine(const SamStressPlaces *places, const double rows[], PetscInt n, double line[])
{
  const SamGrid g = places->grid;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(line, n));
  for (PetscInt k = 0; k < g->cells; k++) {
    const PetscInt i = k % g->nx, j = g->row_start + k / g->nx;

    if (places->index == (places->axis == SAM_SECTION_X ? j : i)) line[places->axis == SAM_SECTION_X ? i : j] = rows[k];
  }
  PetscCall(SamSum(g->comm, n, line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the planes of a step at a depth: its stresses, or (one component) the values of its quantity. */
static PetscErrorCode ComputePlane(SamStressPart part, PetscInt components, PetscInt step, PetscInt depth)
{
  PetscFunctionBegin;
  if (components == 1)
    PetscCall((*part->ops.value)(part, step, depth, part->value.field));
  else {
    PetscCall(VecSet(part->plane.field, 0));
    PetscCall((*part->ops.plane)(part, step, depth, part->plane.field));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the values of a section's lines in a step, at all depths. */
static ptrdiff_t LinesOf(const SamStressPlaces *places, PetscInt components)
{
  return components * (ptrdiff_t)places->depths * places->length;
}

/* Computes all lines of a section. */
static PetscErrorCode PrepareLines(SamStressPart part, PetscInt components, const char work[], Vec field, double **line)
{
  const SamStressPlaces *const places = part->places;
  const PetscInt               steps  = part->source->steps;
  const double                *from;

  PetscFunctionBegin;
  PetscCall(SamAllocate(sizeof(double) * (size_t)(steps * LinesOf(places, components) + 1), line));
  for (PetscInt depth = 0; depth < places->depths; depth++)
    for (PetscInt step = 0; step < steps; step++) {
      double *const to = *line + step * LinesOf(places, components) + depth * components * (ptrdiff_t)places->length;

      PetscCall(ComputePlane(part, components, step, depth));
      PetscCall(VecGetArrayRead(field, &from));
      for (PetscInt c = 0; c < components; c++)
        PetscCall(SamPlacesTakeLine(places, from + c * (ptrdiff_t)places->grid->cells, places->length,
                                    to + c * (ptrdiff_t)places->length));
      PetscCall(VecRestoreArrayRead(field, &from));
      if (part->source->tell)
        PetscCall((*part->source->tell)(part->source->context, work, (double)(depth + 1) / places->depths, 0));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressPartsPrepare(SamStressParts parts)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < parts->n && parts->places->section; k++) {
    SamStressPart part = &parts->part[k];

    if (part->ops.value)
      PetscCall(PrepareLines(part, 1, part->type->quantity.name, part->value.field, &part->value.line));
    if (part->ops.plane)
      PetscCall(PrepareLines(part, SAM_STRESS_COMPONENTS, part->type->name, part->plane.field, &part->plane.line));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the planes of a step to the values of points. */
static PetscErrorCode AddPlanes(SamStressPart part, PetscInt components, Vec field, const double lines[], PetscInt step,
                                const SamPoints *p, double values[])
{
  const SamStressPlaces *const places = part->places;
  const PetscInt               length = places->length;
  const double                *from;

  PetscFunctionBegin;
  if (!places->section) {
    PetscCall(ComputePlane(part, components, step, p->depth));
    PetscCall(VecGetArrayRead(field, &from));
    for (ptrdiff_t k = 0; k < components * (ptrdiff_t)p->count; k++) values[k] += from[k];
    PetscCall(VecRestoreArrayRead(field, &from));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  from = lines + step * LinesOf(places, components) + p->depth * components * (ptrdiff_t)length;
  for (PetscInt depth = 0; depth < p->depths; depth++)
    for (PetscInt c = 0; c < components; c++, from += length)
      for (PetscInt k = 0; k < length; k++)
        values[c * (ptrdiff_t)p->count + depth * (ptrdiff_t)p->plane + k] += from[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all parts ---- */

void SamStressPartsUniform(SamStressParts parts, PetscInt step, PetscReal depth, double stress[SAM_STRESS_COMPONENTS])
{
  PetscBool initial = PETSC_FALSE;
  double    before[2];

  for (int c = 0; c < SAM_STRESS_COMPONENTS; c++) stress[c] = 0;
  for (PetscInt k = 0; k < parts->n; k++) initial = initial || parts->part[k].initial;
  if (!initial) {
    SamBodyInitialStress(SamPairBody(SamElasticityGetPair(parts->source->bodies), parts->places->body - 1),
                         (double)depth, before);
    stress[SAM_STRESS_XX] = before[0];
    stress[SAM_STRESS_YY] = before[1];
  }
  for (PetscInt k = 0; k < parts->n; k++)
    if (parts->part[k].ops.uniform) (*parts->part[k].ops.uniform)(&parts->part[k], step, depth, stress);
}

PetscBool SamStressPartsVary(SamStressParts parts)
{
  for (PetscInt k = 0; k < parts->n; k++)
    if (parts->part[k].ops.add || parts->part[k].ops.plane) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void AddUniform(SamStressParts parts, PetscInt step, const SamPoints *p, double stress[])
{
  double uniform[SAM_STRESS_COMPONENTS];

  for (PetscInt depth = 0; depth < p->depths; depth++) {
    SamStressPartsUniform(parts, step, parts->places->depth[p->depth + depth], uniform);
    for (PetscInt k = 0; k < SAM_STRESS_COMPONENTS; k++) {
      double *const s = stress + k * (ptrdiff_t)p->count + depth * (ptrdiff_t)p->plane;

      for (PetscInt i = 0; i < p->plane && uniform[k] != 0; i++) s[i] += uniform[k];
    }
  }
}

PetscErrorCode SamStressPartsAdd(SamStressParts parts, PetscInt step, const SamPoints *p, double stress[])
{
  PetscFunctionBegin;
  AddUniform(parts, step, p, stress);
  for (PetscInt k = 0; k < parts->n; k++) {
    SamStressPart part = &parts->part[k];

    if (part->ops.add) PetscCall((*part->ops.add)(part, step, p, stress));
    if (part->ops.plane)
      PetscCall(AddPlanes(part, SAM_STRESS_COMPONENTS, part->plane.field, part->plane.line, step, p, stress));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressPartsGetValues(SamStressParts parts, PetscInt k, PetscInt step, const SamPoints *p,
                                       double values[])
{
  SamStressPart part = &parts->part[k];

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(values, p->count));
  PetscCall(AddPlanes(part, 1, part->value.field, part->value.line, step, p, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

double SamStressPartsBytes(SamStressParts parts)
{
  const SamStressPlaces *const places = parts->places;
  const double                 cells = 8 * (double)places->grid->cells, steps = (double)parts->source->steps;
  double                       sum = 0;

  for (PetscInt k = 0; k < parts->n; k++) {
    SamStressPart  part       = &parts->part[k];
    const PetscInt components = (part->ops.plane ? SAM_STRESS_COMPONENTS : 0) + (part->ops.value ? 1 : 0);

    sum += components * cells + (places->section ? 8 * steps * (double)LinesOf(places, components) : 0);
    if (part->ops.bytes) sum += (*part->ops.bytes)(part);
  }
  return sum;
}
