/*
  Generalised conjugate residuals, for the systems of a contact whose sets of cells are frozen.

  Algorithm: a direction p is the preconditioned residual M r, from which the part is subtracted that is needed to make
  its product A p orthogonal to the earlier products; the step along p minimises the residual. So x is that of GMRES
  with preconditioning from the right, M may be inexact, as it is in single precision, and no small system is solved.
  The method restarts after RESTART directions, and gives up if these have not halved the residual. Sums are the same on
  any number of ranks. Sums of PETSc's KSP are not: the dot products and norms of a Vec can be replaced through private
  headers only, and its sums of vectors come from BLAS, whose last bit depends on the beginning of a rank's part.

  Reference: Eisenstat, Elman and Schultz 1983, SIAM J. Numer. Anal. 20, 345.
*/
#include <petsam/private/frozen.h>
#include <math.h>

#define RESTART 30
#define MOST    300 /* maximum number of products for one column */
#define GOAL    0.7 /* part of the tolerance at which the steps end, as the true residual is a little larger */

static PetscErrorCode Norm(const SamFrozen *f, double x[], double *norm)
{
  PetscFunctionBegin;
  PetscCall(SamFrozenDots(f, 1, &x, x, norm));
  *norm = sqrt(*norm);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A direction in single precision, at half the memory, its product, a unit vector, and where loads are held its
   displacements on the grid, without those by the coupling */
typedef struct {
  float  *p, *u;
  double *v;
} Direction;

/* Gets the displacements of the last product. */
static PetscErrorCode GetDisplacements(const SamFrozen *f, float u[])
{
  const PetscInt cells = f->grid->cells;
  const double  *all, *coupling;

  PetscFunctionBegin;
  for (int c = 0; c < 2; c++) {
    const Vec from = c ? f->u_t : f->u_z, less = c ? f->w_t : f->w_z;

    PetscCall(VecGetArrayRead(from, &all));
    PetscCall(VecGetArrayRead(less, &coupling));
    for (PetscInt k = 0; k < (c + 1) * cells; k++) u[k + c * cells] = (float)(all[k] - coupling[k]);
    PetscCall(VecRestoreArrayRead(less, &coupling));
    PetscCall(VecRestoreArrayRead(from, &all));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the tractions of the grid to those of x, and their displacements to `moved`. `work`: scratch. */
static PetscErrorCode SetFields(SamFrozen *f, const double x[], const double moved[], double work[])
{
  const PetscInt cells = f->grid->cells;
  double        *to;

  PetscFunctionBegin;
  PetscCall(SamFrozenSetTractions(f, x, work));
  for (int c = 0; c < 2; c++) {
    const Vec field = c ? f->u_t : f->u_z;

    PetscCall(VecGetArrayWrite(field, &to));
    PetscCall(PetscArraycpy(to, moved + c * cells, (c + 1) * cells));
    PetscCall(VecRestoreArrayWrite(field, &to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the true residual b - A x, and its norm without what is taken off residuals. `work`: scratch. */
static PetscErrorCode FindResidual(SamFrozen *f, const double b[], const double x[], double residual[], double work[],
                                   double *norm)
{
  PetscFunctionBegin;
  PetscCall(SamFrozenApply(f, x, residual));
  for (PetscInt m = 0; m < SamFrozenSize(f); m++) residual[m] = b[m] - residual[m];
  PetscCall(PetscArraycpy(work, residual, SamFrozenSize(f)));
  PetscCall(SamFrozenTakeMotion(f, work));
  PetscCall(Norm(f, work, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes direction k from the residual r; its product is orthogonal to the earlier ones. `z`: scratch. */
static PetscErrorCode NewDirection(SamFrozen *f, PetscInt k, const double r[], Direction d[], double z[], double *norm)
{
  const PetscInt n = SamFrozenSize(f);
  double        *v[RESTART], dots[RESTART];

  PetscFunctionBegin;
  for (PetscInt i = 0; i <= k; i++) v[i] = d[i].v;
  PetscCall(SamFrozenPrecondition(f, r, z));
  PetscCall(SamFrozenTakeLoad(f, z));
  f->single = f->transposed; /* the residual is computed anew at the end */
  PetscCall(SamFrozenApply(f, z, v[k]));
  f->single = f->loose;
  PetscCall(SamFrozenTakeMotion(f, v[k]));
  if (d[k].u) PetscCall(GetDisplacements(f, d[k].u));
  for (PetscInt twice = 0; twice < (f->loose ? 1 : 2); twice++) { /* repeated against rounding */
    PetscCall(SamFrozenDots(f, k, v, v[k], dots));
    for (PetscInt i = 0; i < k; i++)
      for (PetscInt m = 0; m < n; m++) {
        v[k][m] -= dots[i] * v[i][m];
        z[m] -= dots[i] * (double)d[i].p[m];
      }
    for (PetscInt i = 0; d[k].u && i < k; i++)
      for (PetscInt m = 0; m < 3 * f->grid->cells; m++) d[k].u[m] -= (float)dots[i] * d[i].u[m];
  }
  PetscCall(Norm(f, v[k], norm));
  for (PetscInt m = 0; *norm > 0 && m < n; m++) {
    v[k][m] /= *norm;
    d[k].p[m] = (float)(z[m] / *norm);
  }
  for (PetscInt m = 0; d[k].u && *norm > 0 && m < 3 * f->grid->cells; m++) d[k].u[m] /= (float)*norm;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamKrylovSolve(SamFrozen *f, const double b[], double x[], double residual[], PetscReal *error)
{
  const PetscInt n          = SamFrozenSize(f);
  Direction      d[RESTART] = {{NULL, NULL, NULL}};
  const PetscInt cells      = f->holds ? 3 * f->grid->cells : 0;
  double        *z, *moved, norm, left, last = PETSC_INFINITY, size, step;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &z));
  PetscCall(PetscCalloc1(cells, &moved));
  PetscCall(PetscArrayzero(x, n));
  PetscCall(PetscArraycpy(residual, b, n));
  PetscCall(SamFrozenTakeMotion(f, residual));
  PetscCall(Norm(f, residual, &left));
  norm = f->reference > 0 ? f->reference : left;
  for (PetscInt it = 0; it < MOST && left > GOAL * f->rtol * norm; it++) {
    const PetscInt k = it % RESTART;

    if (k == 0 && left > 0.5 * last) break;
    if (k == 0) last = left;
    if (!d[k].p) PetscCall(PetscMalloc2(n, &d[k].p, n, &d[k].v));
    if (f->holds && !d[k].u) PetscCall(PetscMalloc1(cells + 1, &d[k].u));
    PetscCall(NewDirection(f, k, residual, d, z, &size));
    if (!(size > 0)) break;
    PetscCall(SamFrozenDots(f, 1, &d[k].v, residual, &step));
    for (PetscInt m = 0; m < n; m++) {
      x[m] += step * (double)d[k].p[m];
      residual[m] -= step * d[k].v[m];
    }
    for (PetscInt m = 0; m < cells; m++) moved[m] += step * (double)d[k].u[m];
    PetscCall(Norm(f, residual, &left));
  }
  PetscCall(f->holds ? SetFields(f, x, moved, z) : FindResidual(f, b, x, residual, z, &left));
  *error = norm > 0 ? left / norm : 0;
  for (PetscInt k = 0; k < RESTART; k++) {
    PetscCall(PetscFree2(d[k].p, d[k].v));
    PetscCall(PetscFree(d[k].u));
  }
  PetscCall(PetscFree(moved));
  PetscCall(PetscFree(z));
  PetscFunctionReturn(PETSC_SUCCESS);
}
