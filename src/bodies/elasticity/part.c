/*
  The operator on a part of the grid: if tractions act only within a rectangle, and only the displacements there are
  needed, the transforms need no more than its size. Two parts are kept, because a contact tries a step, which may move
  the part, and may return.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/elasticityimpl.h>

/* A part is used if it has at most this share of the grid's cells, and replaced if it is this much too large. */
#define WORTH 0.8
#define SLACK 1.5

/* Returns the part in use; NULL: none. */
static const SamElasticityPart *InUse(SamElasticity e)
{
  return e->in_part ? &e->parts[e->newest] : NULL;
}

PetscErrorCode SamElasticityGetPartPlace(SamElasticity e, PetscInt first[2], PetscInt n[2])
{
  PetscFunctionBegin;
  first[0] = first[1] = n[0] = n[1] = 0;
  if (InUse(e)) PetscCall(SamWindowGetPlace(InUse(e)->window, first, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyPart(SamElasticityPart *part)
{
  PetscFunctionBegin;
  PetscCall(SamWindowDestroy(&part->window));
  PetscCall(SamElasticityDestroy(&part->elasticity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityDestroyParts(SamElasticity e)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) PetscCall(DestroyPart(&e->parts[k]));
  e->in_part = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if a part consists of exactly these cells. */
static PetscErrorCode IsAt(const SamElasticityPart *part, const PetscInt first[2], const PetscInt n[2], PetscBool *is)
{
  PetscInt there[2], size[2];

  PetscFunctionBegin;
  *is = PETSC_FALSE;
  if (!part->window) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamWindowGetPlace(part->window, there, size));
  *is = n[0] == size[0] && n[1] == size[1] && first[0] == there[0] && first[1] == there[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticitySetPart(SamElasticity e, const PetscInt first[2], const PetscInt n[2])
{
  SamElasticityPart *older = &e->parts[1 - e->newest];
  SamGrid            grid;
  PetscBool          is;

  PetscFunctionBegin;
  e->in_part = PETSC_FALSE;
  if (!n[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(e->traits.parts, e->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Elasticity of type %s has no parts", e->type);
  PetscCall(IsAt(&e->parts[e->newest], first, n, &is));
  if (!is) {
    e->newest = 1 - e->newest;
    PetscCall(IsAt(older, first, n, &is));
  }
  if (!is) {
    PetscCall(DestroyPart(older));
    PetscCall(SamWindowCreate(e->grid, first, n, &older->window));
    grid = SamWindowGetGrid(older->window);
    PetscCall(SamElasticityCreateLike(e, grid, first, &older->elasticity));
  }
  e->in_part = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the part in use contains these cells, and is not much larger than they are. */
static PetscBool Suits(SamElasticity e, const PetscInt first[2], const PetscInt n[2])
{
  const SamElasticityPart *part = InUse(e);

  if (!part || !SamWindowCovers(part->window, first, n)) return PETSC_FALSE;
  return SLACK * (double)n[0] * (double)n[1] >= (double)part->elasticity->grid->nx * (double)part->elasticity->grid->ny;
}

/* Returns the cells beside n cells in contact, on either side of them, for contacts that grow. */
static PetscInt Margin(PetscInt n)
{
  return 3 + n / 50;
}

/* True if a part of so many cells saves more than it takes. */
static PetscBool IsWorth(SamElasticity e, const PetscInt size[2])
{
  const double all = (double)e->grid->nx * (double)e->grid->ny;

  return (PetscBool)(e->traits.parts && (double)size[0] * (double)size[1] <= WORTH * all);
}

PetscReal SamElasticityGetPartShare(SamElasticity e, const PetscInt n[2])
{
  const PetscInt size[2] = {PetscMin(n[0] + 2 * Margin(n[0]), e->grid->nx),
                            PetscMin(n[1] + 2 * Margin(n[1]), e->grid->ny)};

  return IsWorth(e, size) ? (PetscReal)size[0] * (PetscReal)size[1] / ((PetscReal)e->grid->nx * (PetscReal)e->grid->ny)
                          : 0;
}

PetscErrorCode SamElasticityChoosePart(SamElasticity e, const PetscInt first[2], const PetscInt n[2], PetscBool keep,
                                       SamWindow *window, SamElasticity *part)
{
  const PetscInt all[2] = {e->grid->nx, e->grid->ny};
  PetscInt       from[2], size[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) {
    const PetscInt margin = Margin(n[k]), last = PetscMin(first[k] + n[k] + margin, all[k]);

    from[k] = PetscMax(first[k] - margin, 0);
    size[k] = PetscMax(last - from[k], PetscMin(2, all[k]));
    from[k] = PetscMin(from[k], all[k] - size[k]);
  }
  if (!IsWorth(e, size)) size[0] = size[1] = 0;
  if (!keep || !Suits(e, first, n)) PetscCall(SamElasticitySetPart(e, from, size));
  *window = InUse(e) ? InUse(e)->window : NULL;
  *part   = InUse(e) ? InUse(e)->elasticity : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
