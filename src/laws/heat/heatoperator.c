/*
  The operator from a flux on the surface of a half-space to its temperature.

  The flux is constant on each cell, kernels are those of a cell (heatkernel.c), and products are convolutions
  without periodic images (fourier/kernel.c). A kernel is even along y. Along x it is even for a body that stands only;
  else it is the sum of its even and its odd part, which share the transforms of the field.

  Source: Liu, Wang and Liu 2000, Wear 243, 101-111.
*/
#include "heatimpl.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>

/* What the rows of lags are computed from; n: numbers of lags that products use. */
typedef struct {
  SamHeatTable table;
  PetscInt     n[2];
  double      *odd; /* scratch for the odd part of a body that stands */
} Lags;

static void FillRow(PetscInt j, PetscInt count, double *const values[], const void *context)
{
  const Lags *lags = (const Lags *)context;
  double     *odd  = lags->odd ? lags->odd : values[1];

  for (PetscInt i = 0; i < count; i++) values[0][i] = 0;
  for (PetscInt i = lags->n[0]; i < count && !lags->odd; i++) odd[i] = 0;
  if (j < lags->n[1])
    SamHeatTableRow(lags->table, j, values[0], odd);
  else
    for (PetscInt i = 0; i < lags->n[0]; i++) odd[i] = 0;
}

/* Tabulates and transforms the kernels. */
static PetscErrorCode CreateKernels(SamConductor c)
{
  static const PetscBool odd[2][2] = {{PETSC_FALSE, PETSC_FALSE}, {PETSC_TRUE, PETSC_FALSE}};
  Lags                   lags      = {.n = {c->grid->nx, c->grid->ny}};

  PetscFunctionBegin;
  PetscCall(SamHeatTableCreate(&c->body, c->grid->area, c->depth, lags.n, &lags.table));
  if (c->kernels == 1) PetscCall(PetscMalloc1(lags.n[0], &lags.odd));
  PetscCall(SamKernelsCreate(c->fourier, c->kernels, odd, FillRow, &lags, c->kernel));
  PetscCall(PetscFree(lags.odd));
  PetscCall(SamHeatTableDestroy(&lags.table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConductorCreate(SamGrid grid, const SamFourierSettings *settings, const SamHeatBody *body,
                                  PetscReal depth, SamConductor *conductor)
{
  SamConductor c;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  *c = (struct _n_SamConductor){.grid = grid, .body = *body, .depth = depth, .kernels = body->speed != 0 ? 2 : 1};
  PetscCall(SamGridReference(grid));
  *conductor = c;
  PetscCall(SamFourierCreate(grid, SAM_FOURIER_FAST, settings, &c->fourier));
  PetscCall(CreateKernels(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConductorApply(SamConductor c, Vec flux, Vec temperature)
{
  const double *from;
  double       *to;

  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(c->grid, 1, flux, "Flux"));
  PetscCall(SamGridCheckVec(c->grid, 1, temperature, "Temperature"));
  if (flux == temperature) {
    PetscCall(VecGetArray(temperature, &to));
    PetscCall(SamConvolveSum(c->fourier, c->kernels, c->kernel, to, to));
  } else {
    PetscCall(VecGetArrayRead(flux, &from));
    PetscCall(VecGetArrayWrite(temperature, &to));
    PetscCall(SamConvolveSum(c->fourier, c->kernels, c->kernel, from, to));
    PetscCall(VecRestoreArrayRead(flux, &from));
  }
  PetscCall(VecRestoreArray(temperature, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConductorDestroy(SamConductor *conductor)
{
  SamConductor c = *conductor;

  PetscFunctionBegin;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < 2; k++) PetscCall(SamKernelDestroy(&c->kernel[k]));
  PetscCall(SamFourierDestroy(&c->fourier));
  PetscCall(SamGridDestroy(&c->grid));
  PetscCall(PetscFree(*conductor));
  PetscFunctionReturn(PETSC_SUCCESS);
}
