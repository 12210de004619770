/*
  The operator from a flux into a half-space to the displacement of its surface by thermal expansion.

  The flux is constant on each cell, kernels are those of a cell (expansionkernel.c), and products are convolutions
  without periodic images (fourier/kernel.c). A kernel is even or odd along y. Along x that of a body that stands has
  one part, that of one that moves an even and an odd one, which share the transforms of the flux.

  Source: Liu and Wang 2001, J. Tribol. 123, 17-26.
*/
#include "expansion.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>

enum { OUT, ALONG_X, ALONG_Y, NUMBERS };

struct _n_SamExpander {
  SamGrid    grid;
  SamFourier fourier;
  PetscInt   parts; /* 2: the kernels along x are even and odd */
  SamKernel  kernel[NUMBERS][2];
};

/* The rows of lags that this rank has computed so far; n: numbers of lags that products use. */
typedef struct {
  SamExpansionTable table;
  PetscInt          n[2];
  double          **kept;    /* the even, then the odd parts of the three numbers in row j; NULL: not yet */
  PetscInt          part[3]; /* of a number that is wanted: 0 even, 1 odd along x */
} Lags;

static void FillRow(PetscInt j, PetscInt count, double *const values[], const void *context)
{
  const Lags *l = (const Lags *)context;
  double     *even[NUMBERS], *odd[NUMBERS];

  if (j < l->n[1] && !l->kept[j]) {
    if (PetscMalloc1(2 * NUMBERS * l->n[0], &l->kept[j])) return;
    for (int k = 0; k < NUMBERS; k++) {
      even[k] = l->kept[j] + k * l->n[0];
      odd[k]  = even[k] + NUMBERS * l->n[0];
    }
    SamExpansionTableRow(l->table, j, even, odd);
  }
  for (int k = 0; k < NUMBERS; k++)
    for (PetscInt i = 0; i < count; i++)
      values[k][i] = j < l->n[1] && i < l->n[0] ? l->kept[j][(NUMBERS * l->part[k] + k) * l->n[0] + i] : 0;
}

/* Tabulates and transforms the kernels: those of a body that stands have one part, as is u_out even, and u_x odd. */
static PetscErrorCode CreateKernels(SamExpander e, const SamHeatBody *body)
{
  Lags lags = {.n = {e->grid->nx, e->grid->ny}};

  PetscFunctionBegin;
  PetscCall(SamExpansionTableCreate(body, e->grid->area, lags.n, &lags.table));
  PetscCall(PetscCalloc1(lags.n[1], &lags.kept));
  for (int part = 0; part < e->parts; part++) {
    PetscBool odd[NUMBERS][2];
    SamKernel kernels[NUMBERS];

    for (int k = 0; k < NUMBERS; k++) {
      lags.part[k] = e->parts == 2 ? part : k == ALONG_X ? 1 : 0;
      odd[k][0]    = lags.part[k] ? PETSC_TRUE : PETSC_FALSE;
      odd[k][1]    = k == ALONG_Y ? PETSC_TRUE : PETSC_FALSE;
    }
    PetscCall(SamKernelsCreate(e->fourier, NUMBERS, odd, FillRow, &lags, kernels));
    for (int k = 0; k < NUMBERS; k++) e->kernel[k][part] = kernels[k];
  }
  for (PetscInt j = 0; j < lags.n[1]; j++) PetscCall(PetscFree(lags.kept[j]));
  PetscCall(PetscFree(lags.kept));
  PetscCall(SamExpansionTableDestroy(&lags.table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamExpanderCreate(SamGrid grid, const SamFourierSettings *settings, const SamHeatBody *body,
                                 SamExpander *expander)
{
  SamExpander e;

  PetscFunctionBegin;
  PetscCall(PetscNew(&e));
  e->grid  = grid;
  e->parts = body->speed != 0 ? 2 : 1;
  PetscCall(SamGridReference(grid));
  PetscCall(SamFourierCreate(grid, SAM_FOURIER_FAST, settings, &e->fourier));
  PetscCall(CreateKernels(e, body));
  *expander = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamExpanderAdd(SamExpander e, Vec flux, PetscReal out, PetscReal along, Vec u_out, Vec u_t)
{
  const PetscInt cells = e->grid->cells;
  const double  *q;
  double        *u[2], *one;

  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(e->grid, 1, flux, "Flux"));
  PetscCall(SamGridCheckVec(e->grid, 1, u_out, "Displacement out of the body"));
  PetscCall(SamGridCheckVec(e->grid, 2, u_t, "Displacement along the surface"));
  PetscCall(PetscMalloc1(cells, &one));
  PetscCall(VecGetArrayRead(flux, &q));
  PetscCall(VecGetArray(u_out, &u[0]));
  PetscCall(VecGetArray(u_t, &u[1]));
  for (int k = 0; k < NUMBERS; k++) {
    double *const to = k == OUT ? u[0] : u[1] + (k - ALONG_X) * cells;

    PetscCall(SamConvolveSum(e->fourier, e->parts, e->kernel[k], q, one));
    for (PetscInt m = 0; m < cells; m++) to[m] += (double)(k == OUT ? out : along) * one[m];
  }
  PetscCall(VecRestoreArray(u_t, &u[1]));
  PetscCall(VecRestoreArray(u_out, &u[0]));
  PetscCall(VecRestoreArrayRead(flux, &q));
  PetscCall(PetscFree(one));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamExpanderDestroy(SamExpander *expander)
{
  SamExpander e = *expander;

  PetscFunctionBegin;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < NUMBERS; k++)
    for (int part = 0; part < 2; part++) PetscCall(SamKernelDestroy(&e->kernel[k][part]));
  PetscCall(SamFourierDestroy(&e->fourier));
  PetscCall(SamGridDestroy(&e->grid));
  PetscCall(PetscFree(*expander));
  PetscFunctionReturn(PETSC_SUCCESS);
}
