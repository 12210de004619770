/* What the terms and slopes of a shear displace, and what it is at the cells' centres. */
#include "shearimpl.h"
#include <math.h>

/* ---- displacement ---- */

/* Adds a root's part beyond the linear one, times its vector, to the parts of q_x and q_y; false: it has none. */
static PetscBool AddTerm(const SamNear *near, SamNearSub sub, const double term[SAM_TERM],
                         double part[2][SAM_ROOTS_CELLS])
{
  const SamRoots *roots = &near->roots[sub];
  double          root[SAM_ROOTS_CELLS], slopes[2], mean;

  if (term[SAM_TERM_VECTOR] == 0 && term[SAM_TERM_VECTOR + 1] == 0) return PETSC_FALSE;
  mean = SamRootsMean(roots, term + SAM_TERM_FUNCTION, root, NULL);
  if (!(mean > 0)) return PETSC_FALSE;
  SamRootsTakeLinearPart(roots, mean, root, slopes);
  for (int c = 0; c < 2; c++)
    for (int k = 0; k < roots->cells; k++) part[c][k] += term[SAM_TERM_VECTOR + c] * root[k];
  return PETSC_TRUE;
}

/* Adds what a cell's sub-cells displace. */
static void AddCell(SamShearProfile s, const double terms[SAM_SHEAR_TERMS], PetscInt i, PetscInt j, double *u[2])
{
  const SamNear    *near                     = &s->near;
  double            part[2][SAM_ROOTS_CELLS] = {{0}};
  const SamNearPart x = {i, j, part[0]}, y = {i, j, part[1]};
  SamNearSub        sub = SAM_NEAR_COARSE;
  PetscBool         any = PETSC_FALSE;

  for (int t = 0; t < SAM_TERM_KINDS; t++)
    if (terms[t * SAM_TERM] != 0 || terms[t * SAM_TERM + 1] != 0)
      sub = PetscMin(sub, SamShearSubOf(terms + t * SAM_TERM + SAM_TERM_FUNCTION));
  for (int t = 0; t < SAM_TERM_KINDS; t++)
    if (AddTerm(near, sub, terms + t * SAM_TERM, part)) any = PETSC_TRUE;
  if (!any) return;
  SamNearAdd(near, sub, SAM_ELASTICITY_XX, s->grid, &x, u[0]);
  SamNearAdd(near, sub, SAM_ELASTICITY_XY, s->grid, &y, u[0]);
  SamNearAdd(near, sub, SAM_ELASTICITY_XY, s->grid, &x, u[1]);
  SamNearAdd(near, sub, SAM_ELASTICITY_YY, s->grid, &y, u[1]);
}

/* Whether a cell has a term: most have none. */
static PetscBool HasTerms(const SamSeen *terms, ptrdiff_t k)
{
  for (int t = 0; t < SAM_TERM_KINDS; t++)
    if (terms->at[t * SAM_TERM][k] != 0 || terms->at[t * SAM_TERM + 1][k] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode AddNear(SamShearProfile s, Vec terms, Vec u_t)
{
  SamSeen seen;
  double *u;

  PetscFunctionBegin;
  PetscCall(SamNearSetUp(&s->near, SAM_ELASTICITY_XX));
  PetscCall(SamNearSetUp(&s->near, SAM_ELASTICITY_XY));
  PetscCall(SamNearSetUp(&s->near, SAM_ELASTICITY_YY));
  PetscCall(SamSee(s->grid, terms, SAM_SHEAR_TERMS, SAM_NEAR, &seen));
  PetscCall(VecGetArray(u_t, &u));
  for (PetscInt j = 0; j < seen.rows.count; j++)
    for (PetscInt i = 0; i < s->grid->nx; i++) {
      const ptrdiff_t k = (ptrdiff_t)j * s->grid->nx + i;
      double          cell[SAM_SHEAR_TERMS];

      if (!HasTerms(&seen, k)) continue;
      for (int c = 0; c < SAM_SHEAR_TERMS; c++) cell[c] = seen.at[c][k];
      AddCell(s, cell, i, seen.rows.first + j, (double *[]){u, u + s->grid->cells});
    }
  PetscCall(VecRestoreArray(u_t, &u));
  PetscCall(SamForget(&seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamShearProfileComputeDisplacement(SamShearProfile s, const SamShearWithin *within, Vec u_t)
{
  const PetscInt n = 2 * s->grid->cells;
  const double  *all;
  double        *part;
  Vec            slopes, u;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, 2, &slopes));
  PetscCall(SamGridCreateVec(s->grid, 2, &u));
  PetscCall(VecSet(u_t, 0));
  for (int axis = 0; axis < 2; axis++) {
    PetscCall(VecGetArrayRead(within->slopes, &all));
    PetscCall(VecGetArrayWrite(slopes, &part));
    PetscCall(PetscArraycpy(part, all + axis * n, n));
    PetscCall(VecRestoreArrayWrite(slopes, &part));
    PetscCall(VecRestoreArrayRead(within->slopes, &all));
    PetscCall(SamElasticityApplyTangentialSlopes(s->elasticity, axis, slopes, u));
    PetscCall(VecAXPY(u_t, 1, u));
  }
  PetscCall(AddNear(s, within->terms, u_t));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&slopes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- centres ---- */

/*
  What a component of the shear is at a cell's centre, by its mean and the cell's terms: what they differ by from their
  means; where the cell slips, so that it is mu p, they are all of it. `any`: the cell has some.
*/
static double CenterOf(const SamRoots *roots, const double *terms, PetscInt n, PetscInt component, PetscBool slips,
                       double mean, PetscBool *any)
{
  double    center[SAM_TERM_KINDS] = {0}, less[SAM_TERM_KINDS] = {0}, part[SAM_ROOTS_CELLS];
  PetscBool has[SAM_TERM_KINDS];

  for (int t = 0; t < SAM_TERM_KINDS; t++) {
    const double *term   = terms + (ptrdiff_t)(t * SAM_TERM) * n;
    const double  vector = term[(ptrdiff_t)component * n];
    double        fit[SAM_FIT_TERMS];

    has[t] = term[0] != 0 || term[n] != 0;
    if (!has[t]) continue;
    for (int c = 0; c < SAM_FIT_TERMS; c++) fit[c] = term[(ptrdiff_t)(SAM_TERM_FUNCTION + c) * n];
    center[t] = vector * sqrt(PetscMax(fit[0], 0));
    less[t]   = vector * SamRootsMean(roots, fit, part, NULL);
  }
  *any = has[SAM_TERM_PRESSURE] || has[SAM_TERM_SLACK] || has[SAM_TERM_LEFT];
  if (slips && has[SAM_TERM_PRESSURE] && !has[SAM_TERM_SLACK] && !has[SAM_TERM_LEFT]) return center[SAM_TERM_PRESSURE];
  for (int t = 0; t < SAM_TERM_KINDS; t++) mean += center[t] - less[t];
  return mean;
}

PetscErrorCode SamShearProfileComputeCenter(SamShearProfile s, const SamShearWithin *within, PetscInt component,
                                            Vec center)
{
  const SamGrid  grid = s->grid;
  const PetscInt nx   = grid->nx;
  SamRoots       roots;
  SamSeen        q;
  const double  *terms, *slips;
  double        *value;

  PetscFunctionBegin;
  SamRootsInitialize(SAM_ROOTS_SUB, &roots);
  PetscCall(SamSee(grid, s->fields.shear, 2, 1, &q));
  PetscCall(VecGetArrayRead(within->terms, &terms));
  PetscCall(VecGetArrayRead(s->fields.slips, &slips));
  PetscCall(VecGetArrayWrite(center, &value));
  for (PetscInt n = 0; n < grid->cells; n++) {
    const PetscInt  i = n % nx, j = grid->row_start + n / nx - q.rows.first;
    const ptrdiff_t k = (ptrdiff_t)j * nx + i;
    const double   *x = q.at[component];
    PetscBool       any;

    value[n] = CenterOf(&roots, terms + n, grid->cells, component, slips[n] > 0, x[k], &any);
    if (any || x[k] == 0) continue;
    if (i > 0 && i + 1 < nx) value[n] -= (x[k + 1] - 2 * x[k] + x[k - 1]) / 24;
    if (j > 0 && j + 1 < q.rows.count) value[n] -= (x[k + nx] - 2 * x[k] + x[k - nx]) / 24;
  }
  PetscCall(VecRestoreArrayWrite(center, &value));
  PetscCall(VecRestoreArrayRead(s->fields.slips, &slips));
  PetscCall(VecRestoreArrayRead(within->terms, &terms));
  PetscCall(SamForget(&q));
  PetscFunctionReturn(PETSC_SUCCESS);
}
