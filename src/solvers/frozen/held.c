/*
  The loads of a contact whose sets of cells are frozen, held as they are.

  The displacements that belong to the held loads are unknowns besides the tractions, but they need no directions of
  their own: residuals count without the part that a rigid displacement makes, and directions are those whose tractions
  carry no load. What a direction carries is taken off by a pressure that is linear in the place, and by a shear with
  the weights h of the approximate inverse (frozen.c); the pressure goes first, since slipping cells change their shear
  with it.
*/
#include <petsam/private/frozen.h>
#include <math.h>

PetscErrorCode SamFrozenHold(SamFrozen *f, const SamBalance *normal, const SamBalance *tangential)
{
  PetscFunctionBegin;
  f->holds = PETSC_TRUE;
  PetscCall(SamFrameSet(&f->normal, f->grid, normal));
  PetscCall(SamFrameSet(&f->tangential, f->grid, tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the phi of one kind at a packed cell of row j: three of one or two components. */
static void GetPhi(const SamFrame *f, double xi, double eta, double phi[2][3])
{
  const double normal[3] = {1, -eta, xi}, x[3] = {1, 0, -eta}, y[3] = {0, 1, xi};

  for (PetscInt i = 0; i < 3; i++) {
    phi[0][i] = f->kind == SAM_BALANCE_NORMAL ? normal[i] : x[i];
    phi[1][i] = f->kind == SAM_BALANCE_NORMAL ? 0 : y[i];
  }
}

/* Returns h, the weight of the part of a shear that the cell is free to take, or 1 for a pressure. */
static double Weight(const SamFrozen *f, const SamFrame *frame, PetscInt m, PetscBool weighted)
{
  if (frame->kind == SAM_BALANCE_NORMAL) return f->bears[m];
  return weighted ? f->free[m] * f->self[1] / (f->self[1] + f->stiff[m]) : f->free[m];
}

/* Takes from the phi of a cell what lies along e. */
static void ProjectPhi(const SamFrozen *f, const SamFrame *frame, PetscInt m, double phi[2][3])
{
  if (frame->kind == SAM_BALANCE_NORMAL) return;
  for (PetscInt i = 0; i < 3; i++) {
    const double part = phi[0][i] * f->e[0][m] + phi[1][i] * f->e[1][m];

    for (PetscInt c = 0; c < 2; c++) phi[c][i] -= part * f->e[c][m];
  }
}

/*
  Finds the rigid displacement a whose part of a packed field has the products with the phi that `of` has, and takes it
  off the field. `weighted`: by the weights of a direction.
*/
static PetscErrorCode TakeOff(const SamFrozen *f, const SamFrame *frame, PetscBool weighted, const double of[],
                              double from[])
{
  const PetscInt components           = frame->kind == SAM_BALANCE_NORMAL ? 1 : 2;
  SamTotal       totals[SAM_GRAM + 3] = {{0}};
  double         sums[SAM_GRAM + 3], a[3], phi[2][3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    double row[SAM_GRAM + 3] = {0};

    for (PetscInt m = f->start[j]; m < f->start[j + 1]; m++) {
      const double w = Weight(f, frame, m, weighted);
      PetscInt     k = 0;

      GetPhi(frame, frame->xi0 + (double)(f->cell[m] - j * f->grid->nx) * frame->dxi, SamFrameEta(frame, j), phi);
      for (PetscInt c = 0; c < components; c++)
        for (PetscInt i = 0; i < 3; i++) row[SAM_GRAM + i] += phi[c][i] * of[m + c * f->count];
      ProjectPhi(f, frame, m, phi);
      for (PetscInt i = 0; i < 3; i++)
        for (PetscInt l = i; l < 3; l++, k++) row[k] += w * (phi[0][i] * phi[0][l] + phi[1][i] * phi[1][l]);
    }
    SamAddAll(SAM_GRAM + 3, totals, row);
  }
  PetscCall(SamSumTotals(f->grid->comm, SAM_GRAM + 3, totals, sums));
  SamFrameSolve(frame, sums, sums + SAM_GRAM, a);
  for (PetscInt j = 0; j < f->grid->rows; j++)
    for (PetscInt m = f->start[j]; m < f->start[j + 1]; m++) {
      const double w = Weight(f, frame, m, weighted);

      GetPhi(frame, frame->xi0 + (double)(f->cell[m] - j * f->grid->nx) * frame->dxi, SamFrameEta(frame, j), phi);
      ProjectPhi(f, frame, m, phi);
      for (PetscInt c = 0; c < components; c++) from[m + c * f->count] -= w * SamFrameDot(a, phi[c]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenTakeMotion(const SamFrozen *f, double r[])
{
  PetscFunctionBegin;
  PetscCall(SamFrozenTakeColumns(f, r));
  if (!f->holds) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TakeOff(f, &f->normal, PETSC_FALSE, r, r));
  PetscCall(TakeOff(f, &f->tangential, PETSC_FALSE, r + f->count, r + f->count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenTakeLoad(const SamFrozen *f, double z[])
{
  double *q;

  PetscFunctionBegin;
  PetscCall(SamFrozenTakeRows(f, z));
  if (!f->holds) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * f->count, &q));
  PetscCall(TakeOff(f, &f->normal, PETSC_FALSE, z, z));
  SamFrozenShear(f, z, z + f->count, q);
  PetscCall(TakeOff(f, &f->tangential, PETSC_TRUE, q, z + f->count));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}
