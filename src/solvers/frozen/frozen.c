/*
  A contact whose sets of cells are frozen: its linear response to tractions, and the approximate inverse of this.

  Unknown are the change of the pressure p on all cells in contact, and a shear x: the change of the shear itself where
  a cell sticks. Where it slips, by r, with the bound b(p, r) and e = q/|q|, the slip ds changes by d(ds) = C dq + B dp
  - t, its length by dr = -e.d(ds), and dq = db e + b de has the parts
      across e   y = -(b/r) P d(ds), P taking off what lies along e,
      along e    db = b_p dp + b_s dr.
  x is y + w e, and g w = b_s dr with g^2 = c |b_s|, c being the influence of a cell on itself, so that with s, the sign
  of b_s (1 for 0), Q = P + g e e' and L = r/b
      dq = Q x + b_p e dp,     S dp + B' dq = n,     Q (C dq + B dp) + L P x + s c e e' x = Q t.
  So the matrix of a tangential problem without coupling, B = 0, is symmetric; it is definite unless friction falls with
  the slip, b_s < 0. Where the bound does not follow the slip of the step, g = 0 and x has no part along e.
  The pressure of cells that yield stays, dp = 0, so the normal equation holds on the others only. Without coupling it
  is a system of its own. Approximate inverses are the spectral ones of S and C; that of C with the weights of the
  tangential solver's Newton step (newton.c), in which a cell that slips counts with h = c/(c + L) across e, and the
  inverse of s c along e. With coupling S + B' b_p e takes the place of S, b_p e being its mean over the contact. Where
  all slips along e, that symbol is the one of S times 1 + i r cos, r = mu beta, with values from 1 - i r to 1 + i r.
  After this inverse the edges of the contact leave real eigenvalues from 1/(1 + r^2) to 1, so that a product reduces
  the error by as much as two do without, where nothing sticks and S is inverted exactly.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/frozen.h>
#include <petsam/private/pressed.h>
#include <petsam/tangential.h>
#include <math.h>

/* ---- creation ---- */

/* Packs the cells in contact. */
static PetscErrorCode FindCells(SamFrozen *f, const double p[])
{
  const SamGrid grid = f->grid;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(grid->rows + 1, &f->start));
  f->count = 0;
  for (PetscInt k = 0; k < grid->cells; k++) f->count += SamIsPressed(p[k]);
  PetscCall(PetscMalloc1(f->count, &f->cell));
  f->count = 0;
  for (PetscInt j = 0; j < grid->rows; j++) {
    f->start[j] = f->count;
    for (PetscInt k = j * grid->nx; k < (j + 1) * grid->nx; k++)
      if (SamIsPressed(p[k])) f->cell[f->count++] = k;
  }
  f->start[grid->rows] = f->count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes all cells stick and bear pressure. */
static void SetReversal(SamFrozen *f, const double bound[])
{
  for (PetscInt m = 0; m < f->count; m++) {
    f->free[m] = bound[f->cell[m]] > 0 ? 1 : 0;
    f->e[0][m] = f->e[1][m] = f->follow[m] = f->rate[m] = f->stiff[m] = 0;
    f->bears[m]                                                       = 1;
  }
}

/* Finds the cells that slip by more than `still` (m), and their stiffness in slip. */
static void SetSlip(SamFrozen *f, double still, double stiffest, const double *const v[SAM_FROZEN_FIELDS])
{
  const double *const q = v[SAM_FROZEN_SHEAR], *const r = v[SAM_FROZEN_SHEAR] + f->grid->cells;

  for (PetscInt m = 0; m < f->count; m++) {
    const PetscInt k = f->cell[m];
    const double   b = v[SAM_FROZEN_BOUND][k], size = hypot(q[k], r[k]), path = v[SAM_FROZEN_PATH][k];

    if (!(path > still && size > 0 && b > 0) ||
        SamCellStateOf(v[SAM_FROZEN_PRESSURE][k], q[k], r[k], b) != SAM_CELL_SLIP)
      continue;
    f->e[0][m]   = q[k] / size;
    f->e[1][m]   = r[k] / size;
    f->follow[m] = v[SAM_FROZEN_SLOPE][k];
    f->stiff[m]  = PetscMin(path / b, stiffest * f->self[1]);
    if (v[SAM_FROZEN_RATE]) f->rate[m] = f->self[1] * v[SAM_FROZEN_RATE][k];
  }
}

/* Finds the cells that yield in the step by an overlap of more than `still` (m), and so keep their pressure. */
static void SetYielding(SamFrozen *f, double still, const double overlap[])
{
  for (PetscInt m = 0; m < f->count; m++)
    if (overlap[f->cell[m]] > still) f->bears[m] = 0;
}

static PetscErrorCode PackCells(SamFrozen *f, double stiffest, double still, const Vec from[SAM_FROZEN_FIELDS])
{
  const double *v[SAM_FROZEN_FIELDS] = {NULL};
  PetscReal     most[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_FROZEN_FIELDS; k++)
    if (from[k]) PetscCall(VecGetArrayRead(from[k], &v[k]));
  PetscCall(FindCells(f, v[SAM_FROZEN_PRESSURE]));
  PetscCall(PetscMalloc7(f->count, &f->e[0], f->count, &f->e[1], f->count, &f->follow, f->count, &f->rate, f->count,
                         &f->stiff, f->count, &f->free, f->count, &f->bears));
  SetReversal(f, v[SAM_FROZEN_BOUND]);
  if (from[SAM_FROZEN_PATH]) {
    PetscCall(VecMax(from[SAM_FROZEN_PRESSURE], NULL, &most[0]));
    PetscCall(VecMax(from[SAM_FROZEN_BOUND], NULL, &most[1]));
    SetSlip(f, still * f->self[1] * (double)most[1], stiffest, v);
    SetYielding(f, still * f->self[0] * (double)most[0], v[SAM_FROZEN_OVERLAP]);
  }
  for (PetscInt k = 0; k < SAM_FROZEN_FIELDS; k++)
    if (from[k]) PetscCall(VecRestoreArrayRead(from[k], &v[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the mean of the shear that a unit of pressure takes with it. */
static PetscErrorCode FindSlope(SamFrozen *f)
{
  SamTotal totals[3] = {{0}};
  double   sums[3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < f->grid->rows; j++) {
    double row[3] = {0};

    for (PetscInt m = f->start[j]; m < f->start[j + 1]; m++) {
      for (PetscInt c = 0; c < 2; c++) row[c] += f->follow[m] * f->e[c][m];
      row[2]++;
    }
    SamAddAll(3, totals, row);
  }
  PetscCall(SamSumTotals(f->grid->comm, 3, totals, sums));
  for (PetscInt c = 0; c < 2; c++) f->slope[c] = sums[2] > 0 ? sums[c] / sums[2] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the fields for products; they are zero outside of the contact. */
static PetscErrorCode CreateWork(SamFrozen *f)
{
  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(f->grid, 1, &f->p));
  PetscCall(SamGridCreateVec(f->grid, 2, &f->q));
  PetscCall(SamGridCreateVec(f->grid, 1, &f->u_z));
  PetscCall(SamGridCreateVec(f->grid, 2, &f->u_t));
  if (f->coupled) PetscCall(SamGridCreateVec(f->grid, 1, &f->w_z));
  if (f->coupled) PetscCall(SamGridCreateVec(f->grid, 2, &f->w_t));
  PetscCall(SamAllocateZeros(sizeof(*f->r) * 2 * (size_t)f->grid->cells, &f->r));
  PetscCall(SamAllocateZeros(sizeof(*f->z) * 2 * (size_t)f->grid->cells, &f->z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenCreate(SamElasticity e, const Vec fields[SAM_FROZEN_FIELDS], PetscBool coupled, double stiffest,
                               double still, SamFrozen *f)
{
  PetscFunctionBegin;
  *f = (SamFrozen){.part       = SAM_FROZEN_BOTH,
                   .rtol       = SAM_FROZEN_RTOL,
                   .elasticity = e,
                   .grid       = SamElasticityGetGrid(e),
                   .coupled    = coupled};
  PetscCall(SamElasticityGetSelfInfluence(e, &f->self[0], &f->self[1]));
  PetscCall(SamFrameSet(&f->normal, f->grid, &(SamBalance){.kind = SAM_BALANCE_NORMAL}));
  PetscCall(SamFrameSet(&f->tangential, f->grid, &(SamBalance){.kind = SAM_BALANCE_TANGENTIAL}));
  PetscCall(PackCells(f, stiffest, still, fields));
  PetscCall(FindSlope(f));
  PetscCall(CreateWork(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenDestroy(SamFrozen *f)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(f->start));
  PetscCall(PetscFree(f->cell));
  PetscCall(PetscFree(f->soft));
  PetscCall(PetscFree(f->sine));
  PetscCall(PetscFree7(f->e[0], f->e[1], f->follow, f->rate, f->stiff, f->free, f->bears));
  PetscCall(VecDestroy(&f->p));
  PetscCall(VecDestroy(&f->q));
  PetscCall(VecDestroy(&f->u_z));
  PetscCall(VecDestroy(&f->u_t));
  PetscCall(VecDestroy(&f->w_z));
  PetscCall(VecDestroy(&f->w_t));
  SamFree(f->r);
  SamFree(f->z);
  for (PetscInt k = 0; k < f->more; k++) PetscCall(PetscFree(f->motion[k]));
  PetscCall(PetscFree(f->motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}
