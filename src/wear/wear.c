/* The wear of two bodies: laws, depths, and the gap that follows. */
#include "wearimpl.h"

PetscErrorCode SamWearCreate(SamContact contact, SamWearLaw law, const PetscReal coefficient[2], SamWear *wear)
{
  SamWear w;
  SamGrid grid;
  Vec     gap;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(SamContactGetGrid(contact, &grid));
  for (int body = 0; body < 2; body++)
    PetscCheck(coefficient[body] >= 0 && isfinite(coefficient[body]), grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "wear coefficient %g of body %d: expected a finite number >= 0", (double)coefficient[body], body + 1);
  PetscCall(PetscNew(&w));
  PetscCall(SamContactGetProblem(contact, &w->problem));
  PetscCall(SamProblemReference(w->problem));
  PetscCall(PetscArraycpy(w->coefficient, coefficient, 2));
  w->grid    = grid;
  w->contact = contact;
  w->law     = law;
  PetscCall(SamGridCreateVec(w->grid, 1, &w->unworn));
  PetscCall(SamGridCreateVec(w->grid, 1, &w->load));
  PetscCall(SamGridCreateVec(w->grid, 1, &w->cycle));
  PetscCall(SamGridCreateVec(w->grid, 1, &w->path));
  PetscCall(SamGridCreateVec(w->grid, 1, &w->step));
  PetscCall(SamGridCreateVec(w->grid, 1, &w->slip));
  PetscCall(SamProblemGetGap(w->problem, &gap));
  PetscCall(VecCopy(gap, w->unworn));
  *wear = w;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearDestroy(SamWear *wear)
{
  SamWear w = *wear;

  PetscFunctionBegin;
  *wear = NULL;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&w->unworn));
  PetscCall(VecDestroy(&w->load));
  PetscCall(VecDestroy(&w->cycle));
  PetscCall(VecDestroy(&w->path));
  PetscCall(VecDestroy(&w->step));
  PetscCall(VecDestroy(&w->slip));
  PetscCall(SamProblemDestroy(&w->problem));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearCountStep(SamWear w)
{
  PetscFunctionBegin;
  PetscCall(SamContactComputeFriction(w->contact, w->slip, w->law == SAM_WEAR_ARCHARD ? w->step : NULL,
                                      w->law == SAM_WEAR_ENERGY ? w->step : NULL));
  PetscCall(VecAbs(w->step));
  PetscCall(VecAXPY(w->cycle, 1, w->step));
  PetscCall(VecAXPY(w->path, 1, w->slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearSetGap(SamWear w, Vec load)
{
  Vec gap;

  PetscFunctionBegin;
  PetscCall(SamProblemGetGap(w->problem, &gap));
  PetscCall(VecWAXPY(gap, w->coefficient[0] + w->coefficient[1], load, w->unworn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearApply(SamWear w, PetscReal times)
{
  PetscFunctionBegin;
  PetscCall(VecAXPY(w->load, times, w->cycle));
  PetscCall(VecSet(w->cycle, 0));
  PetscCall(VecSet(w->path, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearMoveGap(SamWear w)
{
  PetscFunctionBegin;
  PetscCall(SamWearSetGap(w, w->load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetLoad(SamWear w, Vec load)
{
  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(w->grid, 1, load, "The wear load"));
  PetscCall(VecCopy(w->load, load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearSetLoad(SamWear w, Vec load)
{
  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(w->grid, 1, load, "The wear load"));
  PetscCall(VecCopy(load, w->load));
  PetscCall(SamWearMoveGap(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetDepth(SamWear w, PetscInt body, Vec depth)
{
  PetscFunctionBegin;
  PetscCheck(body == 0 || body == 1, w->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Body %" PetscInt_FMT ": expected 0 or 1",
             body);
  PetscCall(SamGridCheckVec(w->grid, 1, depth, "The depth"));
  PetscCall(VecCopy(w->load, depth));
  PetscCall(VecScale(depth, w->coefficient[body]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWearGetVolumes(SamWear w, PetscReal volume[2], PetscReal depth[2])
{
  PetscReal sum, most;

  PetscFunctionBegin;
  PetscCall(SamGridNorm(w->grid, w->load, NORM_1, &sum)); /* it is never negative */
  PetscCall(VecMax(w->load, NULL, &most));
  for (int body = 0; body < 2; body++) {
    volume[body] = w->coefficient[body] * sum * w->grid->dx * w->grid->dy;
    depth[body]  = w->coefficient[body] * most;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
