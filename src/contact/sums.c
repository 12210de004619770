/* Sums over all steps, cell by cell: the path of the slip, the work of friction. Kept only where they are asked for. */
#include "contactimpl.h"

PetscErrorCode SamContactKeepSum(SamContact c, SamContactSum which)
{
  PetscFunctionBegin;
  if (!c->sums[which]) PetscCall(SamGridCreateVec(c->grid, 1, &c->sums[which]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactGetSum(SamContact c, SamContactSum which, Vec *sum)
{
  PetscFunctionBegin;
  *sum = c->sums[which];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the tried step to the sums, NULL for one that is not wanted. */
static PetscErrorCode Add(SamContact c, const Vec sums[SAM_CONTACT_SUMS])
{
  PetscFunctionBegin;
  PetscCall(SamContactAddFriction(c, PETSC_TRUE, sums[SAM_CONTACT_SLIP_PATH], NULL, sums[SAM_CONTACT_FRICTION_ENERGY]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactAddSums(SamContact c)
{
  PetscFunctionBegin;
  if (c->sums[SAM_CONTACT_SLIP_PATH] || c->sums[SAM_CONTACT_FRICTION_ENERGY]) PetscCall(Add(c, c->sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactComputeSum(SamContact c, SamContactSum which, Vec sum)
{
  Vec sums[SAM_CONTACT_SUMS] = {NULL};

  PetscFunctionBegin;
  PetscCheck(c->sums[which], c->grid->comm, PETSC_ERR_ORDER, "This sum over the steps is not kept");
  PetscCall(SamGridCheckVec(c->grid, 1, sum, "The sum"));
  PetscCall(VecCopy(c->sums[which], sum));
  sums[which] = sum;
  if (c->has_tried) PetscCall(Add(c, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactSetSums(SamContact c, const Vec sums[SAM_CONTACT_SUMS])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_CONTACT_SUMS; k++) {
    if (sums[k]) {
      PetscCall(SamGridCheckVec(c->grid, 1, sums[k], "The state's sum over the steps"));
      PetscCall(SamContactKeepSum(c, (SamContactSum)k));
      PetscCall(VecCopy(sums[k], c->sums[k]));
    } else if (c->sums[k]) {
      PetscCall(VecSet(c->sums[k], 0));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
