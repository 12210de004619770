/*
  The check of a pressure found in a window: do the bodies touch outside of it?

  In nearly all cases one product in single precision decides this, as the gap outside is far larger than its rounding.
  Otherwise a product in double precision decides, and gives the size of the larger window.
*/
#include <petsam/private/normalimpl.h>

/* Larger gaps, relative to the maximum displacement, exceed rounding in single precision. */
#define CLEARANCE 1e-5

/* The maximum displacement, and the maximum -gap, which the cell nearest to touching has */
typedef struct {
  double displacement, overlap;
} Nearest;

/* Raises both maxima by some cells of a row, whose displacement is v = scale u, and whose gap is h + v - motion. */
SAM_VECTORIZED static void NearestCells(SamRow row, const float *restrict u, const double *restrict h, double scale,
                                        const double motion[3], Nearest *nearest)
{
  const double a = motion[0] - motion[1] * row.eta, b = motion[2];
  double       displacement = nearest->displacement, most = nearest->overlap;

#pragma omp simd reduction(max : displacement, most)
  for (int i = 0; i < row.count; i++) {
    const double v = scale * (double)u[i], overlap = a + b * (row.xi0 + (double)i * row.dxi) - h[i] - v;

    displacement = v > displacement ? v : displacement;
    most         = overlap > most ? overlap : most;
  }
  nearest->displacement = displacement;
  nearest->overlap      = most;
}

SAM_VECTORIZED static void ToSingle(PetscInt n, const double *restrict p, double factor, float *restrict u)
{
#pragma omp simd
  for (PetscInt i = 0; i < n; i++) u[i] = (float)(factor * p[i]);
}

/* Searches one row in three parts: left of the window, within its columns, and right of it. */
static void NearestInRow(const SamFrame *f, PetscInt j, SamWindow window, const float u[], const double h[],
                         double scale, Nearest *nearest)
{
  const SamGrid grid   = f->grid;
  Nearest       within = {0, 0}; /* inside of the window only the displacement counts */
  PetscInt      first[2], size[2];

  (void)SamWindowGetPlace(window, first, size);
  for (PetscInt part = 0; part < 3; part++) {
    const PetscInt  begin[3] = {0, first[0], first[0] + size[0]}, end[3] = {first[0], first[0] + size[0], grid->nx};
    const SamRow    row    = SamFrameRow(f, j, begin[part], end[part]);
    const PetscBool inside = part == 1 && grid->row_start + j >= first[1] && grid->row_start + j < first[1] + size[1];

    NearestCells(row, u + row.first, h + row.first, scale, f->fixed, inside ? &within : nearest);
  }
  nearest->displacement = PetscMax(nearest->displacement, within.displacement);
}

/* Finds out, in single precision, if all cells outside the window are far from touching. */
static PetscErrorCode IsClear(SamSolver s, SamLevel *level, const SamFrame *frame, SamWindow window, PetscBool *clear)
{
  const SamGrid grid = level->grid;
  const Vec     gap  = level->given[SAM_NORMAL_SEPARATION];
  PetscReal     self, most;
  Nearest       nearest = {0, -PETSC_MAX_REAL};
  const double *p, *h;
  float        *u;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &self, NULL));
  PetscCall(VecMax(level->traction, NULL, &most));
  PetscCall(SamAllocate(sizeof(*u) * (size_t)grid->cells, &u));
  PetscCall(VecGetArrayRead(level->traction, &p));
  ToSingle(grid->cells, p, 1 / most, u);
  PetscCall(VecRestoreArrayRead(level->traction, &p));
  PetscCall(SamLevelApplySingle(s, level, 1 / self, u, u));
  PetscCall(VecGetArrayRead(gap, &h));
  for (PetscInt j = 0; j < grid->rows; j++) NearestInRow(frame, j, window, u, h, self * most, &nearest);
  PetscCall(VecRestoreArrayRead(gap, &h));
  SamFree(u);
  PetscCall(SamMax(grid->comm, 2, (double *)&nearest));
  *clear = nearest.overlap < -CLEARANCE * nearest.displacement;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the smallest rectangle that holds the contact and all cells that penetrate outside of the window. */
static PetscErrorCode FindTouching(SamSolver s, SamLevel *level, const SamFrame *frame, SamWindow window,
                                   PetscInt first[2], PetscInt size[2])
{
  const SamGrid grid = level->grid;
  const Vec     gap  = level->given[SAM_NORMAL_SEPARATION];
  PetscReal     most;
  const double *p, *h;
  double       *u;
  Vec           touching;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &touching));
  PetscCall(SamLevelApply(s, level, level->traction, touching));
  PetscCall(VecNorm(touching, NORM_INFINITY, &most));
  PetscCall(VecGetArray(touching, &u));
  PetscCall(VecGetArrayRead(level->traction, &p));
  PetscCall(VecGetArrayRead(gap, &h));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt  cell[2] = {i, grid->row_start + j}, one[2] = {1, 1};
      const ptrdiff_t k = (ptrdiff_t)j * grid->nx + i;
      const double    g =
        u[k] + h[k] - SamFrameNormal(frame->fixed, frame->xi0 + (double)i * frame->dxi, SamFrameEta(frame, j));

      u[k] = p[k] > 0 || (g < -level->rtol * most && !SamWindowCovers(window, cell, one));
    }
  PetscCall(VecRestoreArrayRead(gap, &h));
  PetscCall(VecRestoreArrayRead(level->traction, &p));
  PetscCall(VecRestoreArray(touching, &u));
  PetscCall(SamGridGetSupport(grid, touching, PETSC_FALSE, first, size));
  PetscCall(VecDestroy(&touching));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamNormalCheckOutside(SamSolver s, SamLevel *level, SamWindow window, PetscInt first[2],
                                     PetscInt size[2], PetscBool *apart)
{
  SamBalance moved = *level->balance;
  SamFrame   frame;

  PetscFunctionBegin;
  SamLevelGetRigid(level, &moved); /* the window's frame differs from that of the whole grid */
  PetscCall(SamFrameSetGiven(&frame, level->grid, &moved));
  PetscCall(IsClear(s, level, &frame, window, apart));
  if (*apart) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindTouching(s, level, &frame, window, first, size));
  *apart = SamWindowCovers(window, first, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}
