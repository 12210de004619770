/*
  The operator on a part of the grid: where tractions act only within a rectangle and only their displacements there
  count, the transforms need no more than its size.
*/
#include <petsam/private/elasticityimpl.h>

/* A part is made where it has at most this share of the grid's cells, and replaced when it is this much too large. */
#define WORTH 0.8
#define SLACK 1.5

PetscErrorCode SamElasticitySetPart(SamElasticity C, const PetscInt first[2], const PetscInt n[2])
{
  SamGrid  grid;
  PetscInt old_first[2], old_n[2];

  PetscFunctionBegin;
  PetscCall(SamElasticityGetPartPlace(C, old_first, old_n));
  if (n[0] == old_n[0] && n[1] == old_n[1] && (!n[0] || (first[0] == old_first[0] && first[1] == old_first[1])))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamWindowDestroy(&C->window));
  PetscCall(SamElasticityDestroy(&C->part));
  if (!n[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamWindowCreate(C->grid, first, n, &C->window));
  PetscCall(SamWindowGetGrid(C->window, &grid));
  PetscCall(SamElasticityCreate(grid, &C->pair, &C->part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the part there is will do. */
static PetscBool Suits(SamElasticity C, const PetscInt first[2], const PetscInt n[2])
{
  if (!C->window || !SamWindowCovers(C->window, first, n)) return PETSC_FALSE;
  return SLACK * (double)n[0] * (double)n[1] >= (double)C->part->grid->nx * (double)C->part->grid->ny ? PETSC_TRUE
                                                                                                      : PETSC_FALSE;
}

PetscErrorCode SamElasticityChoosePart(SamElasticity C, const PetscInt first[2], const PetscInt n[2], PetscBool keep,
                                       SamWindow *window, SamElasticity *part)
{
  const PetscInt all[2] = {C->grid->nx, C->grid->ny};
  PetscInt       from[2], size[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) { /* a few cells more, for contacts that grow */
    const PetscInt margin = 3 + n[k] / 50, last = PetscMin(first[k] + n[k] + margin, all[k]);

    from[k] = PetscMax(first[k] - margin, 0);
    size[k] = PetscMax(last - from[k], 2);
    from[k] = PetscMin(from[k], all[k] - size[k]);
  }
  if ((double)size[0] * (double)size[1] > WORTH * (double)all[0] * (double)all[1]) size[0] = size[1] = 0;
  if (!keep || !Suits(C, first, n)) PetscCall(SamElasticitySetPart(C, from, size));
  *window = C->window;
  *part   = C->part;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetPartPlace(SamElasticity C, PetscInt first[2], PetscInt n[2])
{
  PetscFunctionBegin;
  first[0] = first[1] = n[0] = n[1] = 0;
  if (C->window) PetscCall(SamWindowGetPlace(C->window, first, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
