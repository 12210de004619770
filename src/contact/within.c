/*
  What the variation of the pressure within cells adds to the elastic energy of a corrected solution.

  The energy is a sum over cells of half the mean pressure times the displacement at the centre. The integral over a
  cell of p u, p having the mean p0 and the slopes m, u the gradient g and second differences d over a cell, is
    p0 u + (m_x g_x + m_y g_y)/12 + p0 (d_xx + d_yy)/24
  but for the fourth order of the cell. In the plain solution the error of the pressure makes up for these terms, of a
  corrected one they are what is missing.
*/
#include "contactimpl.h"
#include <petsam/private/rows.h>

/* These terms of a cell, over its area, but for p0 u; none at the border of the grid. */
static double TermsOf(const SamRows *rows, const double u[], PetscInt i, PetscInt j, double mean, const double slope[2])
{
  const PetscInt nx = rows->grid->nx;
  const double  *v  = u + (ptrdiff_t)j * nx + i;

  if (i < 1 || i + 1 >= nx || j < 1 || j + 1 >= rows->count) return 0;
  return (slope[0] * (v[1] - v[-1]) + slope[1] * (v[nx] - v[-nx])) / 24 +
         mean * (v[1] + v[-1] + v[nx] + v[-nx] - 4 * v[0]) / 24;
}

/* The sum of the terms of all cells, for a pressure with these slopes and a displacement. */
static PetscErrorCode SumTerms(SamGrid grid, Vec pressure, Vec slopes, Vec u_z, double *sum)
{
  SamTotal      total = {0};
  SamSeen       u;
  const double *p, *m;

  PetscFunctionBegin;
  PetscCall(SamSee(grid, u_z, 1, 1, &u));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(slopes, &m));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row = 0;

    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt k = j * grid->nx + i;

      if (p[k] > 0)
        row +=
          TermsOf(&u.rows, u.at[0], i, grid->row_start + j - u.rows.first, p[k], (double[]){m[k], m[k + grid->cells]});
    }
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArrayRead(slopes, &m));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(SamForget(&u));
  PetscCall(SamSumTotals(grid->comm, 1, &total, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamContactAddEnergyWithin(SamContact c, SamStep *step)
{
  const SamSolution *s = &c->tried.solution;
  SamProfile         profile;
  PetscBool          found;
  double             sum;
  Vec                slopes;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(c->grid, 2, &slopes));
  PetscCall(SamContactGetProfile(c, &profile));
  PetscCall(SamProfileMatch(profile, s->pressure, s->rim, &found));
  PetscCall(SamProfileComputeSlopes(profile, slopes));
  PetscCall(SumTerms(c->grid, s->pressure, slopes, s->displacement_z, &sum));
  step->stored_energy += 0.5 * sum * c->grid->dx * c->grid->dy;
  PetscCall(VecDestroy(&slopes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
