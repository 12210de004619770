/* The adjoint system of a step: see gradient.c. */
#include "gradientimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/frozen.h>
#include <petsam/private/problem.h>
#include <petsam/solution.h>
#include <math.h>

#define STIFFEST \
  1e12              /* the resistance of a cell to a turn of the slip is not limited: it would change the derivatives */
#define NEAR   10   /* times the tolerance, or the slip that counts: within that a cell is on the border of its set */
#define SINGLE 1e-6 /* tolerance from which on products in single precision suffice */

/* The components in the order of their motions: normal ones first, then those along the surface. */
static const SamComponent components[SAM_COMPONENTS] = {SAM_COMPONENT_N,  SAM_COMPONENT_MX, SAM_COMPONENT_MY,
                                                        SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_MZ};

/* A system: the unknowns -gamma, packed, and lambda, and what belongs to them */
typedef struct {
  SamBack  *b;
  SamFrozen f;
  PetscInt  count;                 /* given loads of the step that have a border */
  PetscInt  given[SAM_COMPONENTS]; /* their places in `components` */
  double   *x;                     /* three components: -gamma, lambda */
  double   *right;                 /* right-hand side before its projection, likewise */
} System;

/* ---- motions ---- */

/* Computes the unit motion of the n-th component in the grid's units of length, packed: three components. */
static void Motion(const SamFrozen *f, PetscInt n, double values[])
{
  const SamGrid g = f->grid;

  (void)PetscArrayzero(values, 3 * f->count);
  for (PetscInt j = 0; j < g->rows; j++) {
    const double y = (double)(SamGridY(g, g->row_start + j) / g->length);

    for (PetscInt m = f->start[j]; m < f->start[j + 1]; m++) {
      const double x = (double)(SamGridX(g, f->cell[m] - j * g->nx) / g->length);

      if (components[n] == SAM_COMPONENT_N) values[m] = 1;
      if (components[n] == SAM_COMPONENT_MX) values[m] = -y;
      if (components[n] == SAM_COMPONENT_MY) values[m] = x;
      if (components[n] == SAM_COMPONENT_TX) values[m + f->count] = 1;
      if (components[n] == SAM_COMPONENT_TY) values[m + 2 * f->count] = 1;
      if (components[n] == SAM_COMPONENT_MZ) {
        values[m + f->count]     = -y;
        values[m + 2 * f->count] = x;
      }
    }
  }
}

/* Returns the length of a unit of the n-th component's motion, m or m/rad. */
static double Unit(const SamFrozen *f, PetscInt n)
{
  return components[n] >= SAM_COMPONENT_MX ? (double)f->grid->length : 1;
}

/* True if the bodies have the n-th component. */
static PetscBool Has(const SamBack *b, PetscInt n)
{
  const SamElasticityTraits traits = SamElasticityGetTraits(b->elasticity);

  return components[n] < SAM_COMPONENT_MX || traits.rotations[components[n] - SAM_COMPONENT_MX] ? PETSC_TRUE
                                                                                                : PETSC_FALSE;
}

/* ---- one part of the system ---- */

/* The place of a part's values among three packed components, and whether it has a component's motion. */
static PetscInt PlaceOf(const SamFrozen *f)
{
  return f->part == SAM_FROZEN_TANGENTIAL ? f->count : 0;
}

static PetscBool Takes(SamFrozenPart part, PetscInt n)
{
  return part == SAM_FROZEN_BOTH || (part == SAM_FROZEN_NORMAL) == (n < 3) ? PETSC_TRUE : PETSC_FALSE;
}

/* Sets the border of a part: the given loads that it has. */
static PetscErrorCode SetBorder(System *s, SamFrozenPart part)
{
  SamFrozen *f = &s->f;
  double    *row[SAM_COMPONENTS], *column[SAM_COMPONENTS], *motion;
  PetscInt   count = 0;
  PetscBool  regular;

  PetscFunctionBegin;
  f->part = part;
  PetscCall(PetscMalloc1(3 * f->count, &motion));
  for (PetscInt i = 0; i < s->count; i++) {
    if (!Takes(part, s->given[i])) continue;
    PetscCall(PetscMalloc1(SamFrozenSize(f), &row[count]));
    PetscCall(PetscMalloc1(SamFrozenSize(f), &column[count]));
    for (int c = 0; c < 2; c++) {
      Motion(f, s->given[i], motion);
      if (c && part == SAM_FROZEN_BOTH) SamFrozenFollow(f, motion);
      if (!c) SamFrozenProjectRow(f, motion + f->count);
      SamFrozenProject(f, motion + PlaceOf(f));
      PetscCall(PetscArraycpy(c ? column[count] : row[count], motion + PlaceOf(f), SamFrozenSize(f)));
    }
    count++;
  }
  PetscCall(PetscFree(motion));
  PetscCall(SamFrozenSetBorder(f, count, row, column, &regular));
  PetscCheck(regular, f->grid->comm, SAM_ERR_USER,
             "the gradient: loads are given in step %" PetscInt_FMT
             " (the first is 1) that the contact cannot change: it "
             "slides as a whole, or has fewer cells than loads: give displacements, or finer cells",
             s->b->at.step + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes what the rows of the given loads are: t.V - c_d or -c_d, in units of the grid's length. */
static PetscErrorCode FindGiven(System *s, double given[])
{
  const SamBack *b        = s->b;
  const SamGrid  g        = b->grid;
  SamTotal       moved[3] = {{0}};
  double         sums[3];

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    const double y      = (double)SamGridY(g, g->row_start + j);
    double       row[3] = {0, 0, 0};

    for (PetscInt i = 0; i < g->nx; i++) {
      const PetscInt k = j * g->nx + i;

      row[0] += b->later[k];
      row[1] += b->later[k + g->cells];
      row[2] += (double)SamGridX(g, i) * b->later[k + g->cells] - y * b->later[k];
    }
    SamAddAll(3, moved, row);
  }
  PetscCall(SamSumTotals(g->comm, 3, moved, sums));
  for (PetscInt i = 0; i < s->count; i++) {
    const PetscInt n = s->given[i];

    given[i] = ((n < 3 ? 0 : sums[n - 3]) - b->at.by_rigid[components[n]]) / Unit(&s->f, n);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves a part; its unknowns go to x, its multipliers to the forces. */
static PetscErrorCode SolvePart(System *s, SamFrozenPart part, const double given[])
{
  SamFrozen   *f = &s->f;
  double      *right, some[SAM_COMPONENTS], multipliers[SAM_COMPONENTS];
  PetscInt     count = 0;
  PetscReal    error;
  const double area = s->b->at.area;

  PetscFunctionBegin;
  PetscCall(SetBorder(s, part));
  PetscCall(PetscMalloc1(SamFrozenSize(f), &right));
  PetscCall(PetscArraycpy(right, s->right + PlaceOf(f), SamFrozenSize(f)));
  SamFrozenProject(f, right);
  for (PetscInt i = 0; i < s->count; i++)
    if (Takes(part, s->given[i])) some[count++] = given[i];
  PetscCall(SamFrozenSolveBordered(f, right, some, s->x + PlaceOf(f), multipliers, &error));
  count = 0;
  for (PetscInt i = 0; i < s->count; i++)
    if (Takes(part, s->given[i]))
      s->b->forces[components[s->given[i]]] = multipliers[count++] / Unit(f, s->given[i]) / area;
  s->b->g->found.residual = PetscMax(s->b->g->found.residual, error);
  PetscCall(SamFrozenClearBorder(f));
  PetscCall(PetscFree(right));
  PetscCheck(error <= PetscMax(s->b->rtol, 1e-3), f->grid->comm, PETSC_ERR_NOT_CONVERGED,
             "the gradient: the adjoint of step %" PetscInt_FMT
             " (the first is 1) does not converge: relative residual %.2g",
             s->b->at.step + 1, (double)error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the system ---- */

/* Creates a field of the part from an array of its cells. */
static PetscErrorCode FieldOf(SamGrid g, PetscInt count, const double values[], Vec *field)
{
  double *to;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, count, field));
  PetscCall(VecGetArrayWrite(*field, &to));
  PetscCall(PetscArraycpy(to, values, count * g->cells));
  PetscCall(VecRestoreArrayWrite(*field, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Freezes the sets of cells of the step. */
static PetscErrorCode Freeze(System *s)
{
  const SamBack     *b  = s->b;
  const SamBackStep *at = &b->at;
  const SamGrid      g  = b->grid;
  double            *bound, *path;
  Vec                fields[SAM_FROZEN_FIELDS] = {NULL};

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(g->cells, &bound, g->cells, &path));
  for (PetscInt k = 0; k < g->cells; k++) {
    bound[k] = b->friction[k] * at->pressure[k];
    path[k]  = hypot(at->slip[k], at->slip[k + g->cells]);
  }
  PetscCall(FieldOf(g, 1, at->pressure, &fields[SAM_FROZEN_PRESSURE]));
  PetscCall(FieldOf(g, 1, bound, &fields[SAM_FROZEN_BOUND]));
  PetscCall(FieldOf(g, 2, at->shear, &fields[SAM_FROZEN_SHEAR]));
  PetscCall(FieldOf(g, 1, b->friction, &fields[SAM_FROZEN_SLOPE]));
  PetscCall(FieldOf(g, 1, path, &fields[SAM_FROZEN_PATH]));
  PetscCall(SamGridCreateVec(g, 1, &fields[SAM_FROZEN_OVERLAP]));
  PetscCall(SamFrozenCreate(b->elasticity, fields, b->coupled, STIFFEST, (double)b->g->still, &s->f));
  for (int k = 0; k < SAM_FROZEN_FIELDS; k++) PetscCall(VecDestroy(&fields[k]));
  PetscCall(PetscFree2(bound, path));
  s->f.transposed = PETSC_TRUE;
  s->f.rtol       = b->rtol;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the direction of slip at mid step ---- */

/* A cell whose slip is opposite to m = r + w r0, r0 = q0/b0 being the shear before the step and r = e that after it;
   n_m is the normal of m */
typedef struct {
  double r0[2], b0, sine, factor, by[2]; /* factor of the resistance to a turn; k0, derivatives of the turn by r0 */
} Turned;

/* True if the slip of the packed cell m follows the shear at mid step. */
static PetscBool Turns(const System *s, PetscInt m)
{
  const SamBack   *b    = s->b;
  const SamFrozen *f    = &s->f;
  const PetscBool  slip = f->e[0][m] != 0 || f->e[1][m] != 0 ? PETSC_TRUE : PETSC_FALSE;

  return slip && b->g->record[b->at.step].turns && b->at.pressure_before[f->cell[m]] > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static Turned TurnedOf(const System *s, PetscInt m)
{
  const SamBackStep *at = &s->b->at;
  const PetscInt     k = s->f.cell[m], l = k + s->b->grid->cells;
  const double       x = s->f.e[0][m], y = s->f.e[1][m];
  Turned             t = {.b0 = s->b->friction[k] * at->pressure_before[k]};
  double             weight, mx, my, size, across, part;

  t.r0[0]  = at->shear_before[k] / t.b0;
  t.r0[1]  = at->shear_before[l] / t.b0;
  weight   = PetscMax(0.5 * (t.r0[0] * (t.r0[0] + x) + t.r0[1] * (t.r0[1] + y)), 0);
  mx       = x + weight * t.r0[0];
  my       = y + weight * t.r0[1];
  size     = hypot(mx, my);
  t.sine   = (mx * y - my * x) / size;
  across   = x * t.r0[1] - y * t.r0[0];            /* n_e.r0 */
  part     = (mx * t.r0[1] - my * t.r0[0]) / size; /* n_m.r0 */
  t.factor = ((mx * x + my * y) / size + (weight > 0 ? 0.5 * across * part : 0)) / size;
  if (weight == 0) return t;
  t.by[0] = (-weight * my / size + part * (t.r0[0] + 0.5 * x)) / size;
  t.by[1] = (weight * mx / size + part * (t.r0[1] + 0.5 * y)) / size;
  return t;
}

static PetscErrorCode TurnAll(System *s)
{
  PetscFunctionBegin;
  for (PetscInt m = 0; m < s->f.count; m++)
    if (Turns(s, m)) {
      const Turned t = TurnedOf(s, m);

      PetscCall(SamFrozenTurn(&s->f, m, t.sine, t.factor));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the shear and the bound before the step. */
static void LeaveTurned(System *s)
{
  SamBackStep   *at    = &s->b->at;
  const PetscInt cells = s->b->grid->cells, n = s->f.count;

  for (PetscInt m = 0; m < n; m++) {
    const PetscInt k = s->f.cell[m];
    double         part, by_bound;
    Turned         t;

    if (!Turns(s, m)) continue;
    t        = TurnedOf(s, m);
    part     = (s->f.e[0][m] * s->x[m + 2 * n] - s->f.e[1][m] * s->x[m + n]) * hypot(at->slip[k], at->slip[k + cells]);
    by_bound = part * (t.by[0] * t.r0[0] + t.by[1] * t.r0[1]) / t.b0;
    for (PetscInt c = 0; c < 2; c++) at->by_shear_before[k + c * cells] -= part * t.by[c] / t.b0;
    at->by_pressure_before[k] += s->b->friction[k] * by_bound;
    at->by_friction[k] += at->pressure_before[k] * by_bound;
  }
}

/* ---- the cotangents ---- */

/* Counts the cells that are about to change their set. */
static PetscErrorCode CountBorders(System *s)
{
  const SamBack     *b       = s->b;
  const SamBackStep *at      = &b->at;
  const SamFrozen   *f       = &s->f;
  const double       near_to = NEAR * (double)b->g->still;
  double             most[2] = {0, 0}, count = 0;

  PetscFunctionBegin;
  for (PetscInt m = 0; m < f->count; m++) {
    const PetscInt k = f->cell[m];

    most[0] = PetscMax(most[0], at->pressure[k]);
    most[1] = PetscMax(most[1], b->friction[k] * at->pressure[k]);
  }
  PetscCall(SamMax(b->grid->comm, 2, most));
  for (PetscInt m = 0; m < f->count; m++) {
    const PetscInt  k = f->cell[m], l = k + b->grid->cells;
    const double    bound = b->friction[k] * at->pressure[k], slips = fabs(f->e[0][m]) + fabs(f->e[1][m]);
    const PetscBool weak = at->pressure[k] < near_to * most[0],
                    near = slips == 0 && bound > 0 && hypot(at->shear[k], at->shear[l]) > (1 - near_to) * bound,
                    still =
                      slips > 0 && hypot(at->slip[k], at->slip[l]) < NEAR * (double)b->g->still * f->self[1] * most[1];

    if (weak || near || still) count++;
  }
  PetscCall(SamSum(b->grid->comm, 1, &count));
  b->g->found.borders += (PetscInt)count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacements by V: three components. */
static PetscErrorCode Displace(const SamBack *b, double moved[])
{
  const SamGrid g = b->grid;
  const double *from;
  Vec           later, u[2];

  PetscFunctionBegin;
  PetscCall(FieldOf(g, 2, b->later, &later));
  for (int c = 0; c < 2; c++) PetscCall(SamGridCreateVec(g, c + 1, &u[c]));
  PetscCall(SamElasticityApplyTangential(b->elasticity, later, u[1]));
  if (b->coupled) PetscCall(SamElasticityApplyTangentialToNormal(b->elasticity, later, u[0]));
  for (int c = 0; c < 2; c++) {
    PetscCall(VecGetArrayRead(u[c], &from));
    PetscCall(PetscArraycpy(moved + c * g->cells, from, (c + 1) * g->cells));
    PetscCall(VecRestoreArrayRead(u[c], &from));
    PetscCall(VecDestroy(&u[c]));
  }
  PetscCall(VecDestroy(&later));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the same in single precision, for similar bodies and tolerances far above it. */
static PetscErrorCode DisplaceSingle(const SamBack *b, double self, double moved[])
{
  const SamGrid g    = b->grid;
  double        most = 0;
  float        *from, *to;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(moved, g->cells));
  for (PetscInt k = 0; k < 2 * g->cells; k++) most = PetscMax(most, fabs(b->later[k]));
  PetscCall(SamMax(g->comm, 1, &most));
  if (most == 0) {
    PetscCall(PetscArrayzero(moved, 3 * g->cells));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc2(2 * g->cells, &from, 2 * g->cells, &to));
  for (PetscInt k = 0; k < 2 * g->cells; k++) from[k] = (float)(b->later[k] / most);
  PetscCall(SamElasticityApplyTangentialSingle(b->elasticity, 1 / self, from, to));
  for (PetscInt k = 0; k < 2 * g->cells; k++) moved[k + g->cells] = self * most * (double)to[k];
  PetscCall(PetscFree2(from, to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacements by V, and the right-hand side c + those. */
static PetscErrorCode FindRight(System *s, double moved[])
{
  const SamBack     *b  = s->b;
  const SamBackStep *at = &b->at;
  const SamGrid      g  = b->grid;
  const SamFrozen   *f  = &s->f;

  PetscFunctionBegin;
  if (b->coupled || b->rtol < SINGLE)
    PetscCall(Displace(b, moved));
  else
    PetscCall(DisplaceSingle(b, f->self[1], moved));
  for (PetscInt m = 0; m < f->count; m++) {
    const PetscInt k = f->cell[m];

    s->right[m] = at->by_pressure[k] + moved[k];
    for (PetscInt c = 0; c < 2; c++)
      s->right[m + (c + 1) * f->count] = at->by_shear[k + c * g->cells] + moved[k + (c + 1) * g->cells];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes r = c_q + C tau + X gamma - t nu dA on the cells in contact, from the right-hand side, the displacements by
  the unknowns, which the last product has left, and the forces: packed, two components.
*/
static PetscErrorCode FindRest(System *s, double r[])
{
  SamFrozen *f = &s->f;
  double    *motion;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * f->count, &motion));
  PetscCall(SamFrozenPack(f, f->u_t, r));
  for (PetscInt m = 0; m < 2 * f->count; m++) r[m] = s->right[m + f->count] - r[m];
  for (PetscInt i = 0; i < s->count; i++) {
    const PetscInt n     = s->given[i];
    const double   force = s->b->forces[components[n]] * s->b->at.area * Unit(f, n);

    if (n < 3) continue;
    Motion(f, n, motion);
    for (PetscInt m = 0; m < 2 * f->count; m++) r[m] -= force * motion[m + f->count];
  }
  PetscCall(PetscFree(motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps in which contact grows ---- */

/* Computes lambda on the part of the grid, from the unknowns. */
static PetscErrorCode SpreadLambda(const System *s, double lambda[])
{
  const SamFrozen *f     = &s->f;
  const PetscInt   cells = s->b->grid->cells;
  double          *packed;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * f->count, &packed));
  PetscCall(PetscArrayzero(lambda, 2 * cells));
  SamFrozenShear(f, NULL, s->x + f->count, packed);
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++) lambda[f->cell[m] + c * cells] = packed[m + c * f->count];
  PetscCall(PetscFree(packed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the loads of the step that are found, of the given kind, to the right-hand side. */
static void AddFound(System *s, SamFrozenPart part, const double by_load[])
{
  const SamBack   *b = s->b;
  const SamRecord *r = &b->g->record[b->at.step];
  double          *motion;

  if (PetscMalloc1(3 * s->f.count, &motion)) return;
  for (PetscInt n = 0; n < SAM_COMPONENTS; n++) {
    const double factor = b->at.area * by_load[components[n]];

    if (r->force[components[n]] || !Takes(part, n) || factor == 0) continue;
    Motion(&s->f, n, motion);
    for (PetscInt m = 0; m < 3 * s->f.count; m++) s->right[m] += factor * motion[m] * Unit(&s->f, n);
  }
  (void)PetscFree(motion);
}

/* Solves for the shear under derivatives by the tangential loads that are found, and finds those that follow from the
   motion of cells before they touch. `right`: the right-hand side without them; `lambda`: scratch. */
static PetscErrorCode SolveWithLoads(System *s, const double given[], const double right[], const double by_load[],
                                     double lambda[])
{
  SamBack *b = s->b;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(s->right, right, 3 * s->f.count));
  AddFound(s, SAM_FROZEN_TANGENTIAL, by_load);
  PetscCall(SolvePart(s, SAM_FROZEN_TANGENTIAL, given));
  PetscCall(SpreadLambda(s, lambda));
  PetscCall(SamBackEnter(b, b->at.step, lambda));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves for one or two unknowns, by columns. */
static void SolveTwo(PetscInt n, const double columns[2][2], const double b[2], double x[2])
{
  const double *c = columns[0], *d = columns[1], determinant = n < 2 ? c[0] : c[0] * d[1] - c[1] * d[0];

  x[0] = (n < 2 ? b[0] : b[0] * d[1] - b[1] * d[0]) / determinant;
  if (n == 2) x[1] = (c[0] * b[1] - c[1] * b[0]) / determinant;
}

/*
  Solves for the shear and the motion of cells before they touch. That depends on the tangential loads of the step;
  those that are found depend on the shear, whose adjoint depends on their derivatives: linearly, so that as many
  solutions more as there are such loads give these derivatives.
*/
static PetscErrorCode SolveEntering(System *s, const double given[])
{
  static const PetscInt along[] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY};

  SamBack         *b     = s->b;
  const SamRecord *r     = &b->g->record[b->at.step];
  const PetscInt   size  = 3 * s->f.count;
  const double    *after = b->entered.load[1];
  double          *lambda, *right, load[SAM_COMPONENTS] = {0}, start[2], columns[2][2], found[2], most = 0, error = 0;
  PetscInt         c[2], n = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(2 * b->grid->cells, &lambda, size, &right));
  PetscCall(PetscArraycpy(right, s->right, size));
  for (PetscInt m = s->f.count; m < size; m++) most = PetscMax(most, fabs(right[m]) / b->at.area);
  PetscCall(SamMax(b->grid->comm, 1, &most));
  PetscCall(SolveWithLoads(s, given, right, load, lambda));
  for (int k = 0; k < 2; k++) /* where all cells stick it is rounding */
    if (!r->force[along[k]] && fabs(after[along[k]]) > b->rtol * most) c[n++] = along[k];
  for (PetscInt k = 0; k < n; k++) start[k] = after[c[k]];
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(PetscArrayzero(load, SAM_COMPONENTS));
    load[c[k]] = start[k];
    PetscCall(SolveWithLoads(s, given, right, load, lambda));
    for (PetscInt l = 0; l < n; l++) columns[k][l] = (l == k ? 1 : 0) - (after[c[l]] - start[l]) / start[k];
  }
  if (n > 0) {
    SolveTwo(n, columns, start, found);
    for (PetscInt k = 0; k < n; k++) load[c[k]] = found[k];
    PetscCall(SolveWithLoads(s, given, right, load, lambda));
    for (PetscInt k = 0; k < n; k++)
      error = PetscMax(error, fabs(after[c[k]] - load[c[k]]) / PetscMax(most, fabs(load[c[k]])));
    b->g->found.residual = PetscMax(b->g->found.residual, (PetscReal)error);
  }
  PetscCall(PetscArraycpy(s->right, right, size));
  AddFound(s, SAM_FROZEN_TANGENTIAL, load);
  PetscCall(PetscFree2(lambda, right));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lets the normal problem have the derivatives by the loads and displacements of the step. */
static PetscErrorCode Enter(System *s, double given[])
{
  SamBack *b = s->b;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) b->at.by_rigid[c] += b->entered.rigid[1][c];
  AddFound(s, SAM_FROZEN_NORMAL, b->entered.load[1]);
  PetscCall(FindGiven(s, given));
  SamBackAddEntered(b);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps of one pressure ---- */

/* True if the derivative by the n-th component, by its load if that is given, is wanted by step. */
static PetscBool IsWanted(const System *s, PetscInt n)
{
  const SamRecord        *r    = &s->b->g->record[s->b->at.step];
  const SamComponentName *name = &SamComponentNames[components[n]];

  return Has(s->b, n) && SamGradientHas(s->b->g, r->force[components[n]] ? name->load : name->rigid);
}

/* Solves for the n-th component: for a unit of its load, or with its unit motion as the right-hand side. */
static PetscErrorCode SolveUnit(System *s, PetscInt n)
{
  SamBack        *b                     = s->b;
  SamShared      *shared                = &b->shared;
  double          given[SAM_COMPONENTS] = {0}, kept[SAM_COMPONENTS];
  double *const   own[]                 = {s->right, s->x};
  const PetscBool force                 = b->g->record[b->at.step].force[components[n]];

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(kept, b->forces, SAM_COMPONENTS));
  PetscCall(PetscMalloc1(3 * s->f.count, &s->right));
  PetscCall(PetscCalloc1(3 * s->f.count, &s->x));
  Motion(&s->f, n, s->right);
  if (force) PetscCall(PetscArrayzero(s->right, s->f.count));
  for (PetscInt i = 0; i < s->count; i++) given[i] = s->given[i] == n ? 1 : 0;
  PetscCall(SolvePart(s, SAM_FROZEN_NORMAL, given));
  for (PetscInt i = 0; i < s->count && s->given[i] < 3; i++)
    shared->by_given[shared->count][i] = b->forces[components[s->given[i]]] * Unit(&s->f, s->given[i]) * b->at.area;
  shared->place[shared->count]      = n;
  shared->found[shared->count]      = 0;
  shared->by_right[shared->count++] = s->x;
  PetscCall(PetscFree(s->right));
  s->right = own[0];
  s->x     = own[1];
  PetscCall(PetscArraycpy(b->forces, kept, SAM_COMPONENTS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the step leaves its normal problem to the step before, which has the same: if that saves solutions. */
static PetscBool Shares(const System *s)
{
  const SamBack *b      = s->b;
  PetscInt       wanted = 0, k = b->at.step;

  if (!b->shares || !b->g->record[k].same) return PETSC_FALSE;
  for (PetscInt n = 0; n < 3; n++) wanted += IsWanted(s, n);
  while (k > 0 && b->g->record[k].same) k--;
  return b->shared.on || b->at.step - k > wanted ? PETSC_TRUE : PETSC_FALSE;
}

/* The place of a derivative by a component of the present step */
static double *ByComponent(SamBack *b, PetscInt component)
{
  return b->g->record[b->at.step].force[component] ? &b->forces[component] : &b->at.by_rigid[component];
}

/* Leaves the normal problem of a step to the step before, and finds what is wanted of it by step. */
static PetscErrorCode LeaveNormal(System *s, const double given[])
{
  SamBack   *b      = s->b;
  SamShared *shared = &b->shared;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < 3 && !shared->on; n++)
    if (IsWanted(s, n)) PetscCall(SolveUnit(s, n));
  shared->on = PETSC_TRUE;
  s->f.part  = SAM_FROZEN_NORMAL;
  for (PetscInt k = 0; k < shared->count; k++) {
    const PetscInt c    = components[shared->place[k]];
    const double   unit = Unit(&s->f, shared->place[k]);
    double         found;

    PetscCall(SamFrozenDots(&s->f, 1, &shared->by_right[k], s->right, &found));
    for (PetscInt i = 0; i < s->count && s->given[i] < 3; i++) found += shared->by_given[k][i] * given[i];
    found *= b->g->record[b->at.step].force[c] ? 1 / (unit * b->at.area) : unit;
    *ByComponent(b, c) += found - shared->found[k]; /* the right-hand side has what later steps have left */
    shared->found[k] = found;
  }
  for (PetscInt m = 0; m < s->f.count; m++) b->at.by_pressure_before[s->f.cell[m]] += s->right[m];
  for (PetscInt i = 0; i < s->count && s->given[i] < 3; i++)
    b->by_rigid_before[components[s->given[i]]] += b->at.by_rigid[components[s->given[i]]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes what later steps have found by step off what the first of them has found for all. */
static PetscErrorCode EndShared(SamBack *b)
{
  SamShared *shared = &b->shared;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < shared->count; k++) {
    *ByComponent(b, components[shared->place[k]]) -= shared->found[k];
    PetscCall(PetscFree(shared->by_right[k]));
  }
  shared->on    = PETSC_FALSE;
  shared->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the system, or for similar bodies that of the shear, then that of the pressure. `r`: as above. */
static PetscErrorCode Solve(System *s, PetscBool rubs, double given[], double r[])
{
  SamFrozen      *f     = &s->f;
  const PetscInt  n     = f->count;
  const PetscBool grows = s->b->g->record[s->b->at.step].grows;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(s->x, 3 * n));
  PetscCall(PetscArrayzero(r, 2 * n));
  if (s->b->coupled && rubs) {
    SamFrozenFollow(f, s->right);
    PetscCall(SolvePart(s, SAM_FROZEN_BOTH, given));
    PetscCall(FindRest(s, r));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (rubs) {
    PetscCall(grows ? SolveEntering(s, given) : SolvePart(s, SAM_FROZEN_TANGENTIAL, given));
    PetscCall(FindRest(s, r));
  }
  if (grows && rubs) PetscCall(Enter(s, given));
  for (PetscInt m = 0; m < n; m++) /* mu beta */
    s->right[m] += f->follow[m] * (f->e[0][m] * r[m] + f->e[1][m] * r[m + n]);
  if (Shares(s)) {
    PetscCall(LeaveNormal(s, given));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolvePart(s, SAM_FROZEN_NORMAL, given));
  PetscCall(EndShared(s->b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that nothing depends on the displacements of a step without contact, where its loads are given. */
static PetscErrorCode CheckLost(const System *s, const double given[])
{
  double most = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->count; i++) most = PetscMax(most, fabs(given[i]));
  PetscCheck(most == 0, s->b->grid->comm, SAM_ERR_USER,
             "the gradient: the number depends on the displacements in step %" PetscInt_FMT
             " (the first is 1), in which "
             "there is no contact, and loads are given: give displacements",
             s->b->at.step + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the cotangents of the step, and what it leaves for the step before. */
static PetscErrorCode SetCotangents(System *s, const double r[])
{
  SamBack         *b = s->b;
  const SamGrid    g = b->grid;
  const SamFrozen *f = &s->f;
  const PetscInt   n = f->count;
  double          *lambda;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * g->cells, &lambda));
  PetscCall(SpreadLambda(s, lambda));
  PetscCall(PetscArrayzero(b->gamma, g->cells));
  PetscCall(PetscArrayzero(b->beta, g->cells));
  for (PetscInt m = 0; m < n; m++) {
    const PetscInt k = f->cell[m];

    b->gamma[k] = -s->x[m];
    b->beta[k]  = f->e[0][m] * r[m] + f->e[1][m] * r[m + n];
  }
  for (PetscInt k = 0; k < 2 * g->cells; k++) {
    b->tau[k]   = b->later[k] - lambda[k];
    b->later[k] = lambda[k] - b->at.by_slip[k];
  }
  PetscCall(PetscFree(lambda));
  LeaveTurned(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBackSolveNormal(void *back, const double pressure[], const double soft[], const double right[],
                                  const PetscBool force[3], double l[], double forces[3])
{
  SamBack *const b        = (SamBack *)back;
  System         s        = {.b = b};
  const double   given[3] = {0, 0, 0};
  double         kept[SAM_COMPONENTS], touches;
  Vec            fields[SAM_FROZEN_FIELDS] = {NULL};

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(l, b->grid->cells));
  PetscCall(PetscArrayzero(forces, 3));
  PetscCall(FieldOf(b->grid, 1, pressure, &fields[SAM_FROZEN_PRESSURE]));
  PetscCall(SamGridCreateVec(b->grid, 1, &fields[SAM_FROZEN_BOUND]));
  PetscCall(SamFrozenCreate(b->elasticity, fields, PETSC_FALSE, STIFFEST, (double)b->g->still, &s.f));
  s.f.transposed = PETSC_TRUE;
  s.f.rtol       = b->rtol;
  PetscCall(PetscCalloc2(3 * s.f.count, &s.x, 3 * s.f.count, &s.right));
  PetscCall(PetscMalloc1(s.f.count, &s.f.soft));
  for (PetscInt m = 0; m < s.f.count; m++) {
    s.f.soft[m] = soft[s.f.cell[m]];
    s.right[m]  = right[s.f.cell[m]];
  }
  for (PetscInt n = 0; n < 3; n++)
    if (force[n] && Has(b, n)) s.given[s.count++] = n;
  touches = s.f.count;
  PetscCall(SamMax(b->grid->comm, 1, &touches));
  PetscCall(PetscArraycpy(kept, b->forces, SAM_COMPONENTS));
  if (touches > 0) PetscCall(SolvePart(&s, SAM_FROZEN_NORMAL, given));
  for (PetscInt n = 0; n < s.count && touches > 0; n++) forces[s.given[n]] = b->forces[components[s.given[n]]];
  PetscCall(PetscArraycpy(b->forces, kept, SAM_COMPONENTS));
  for (PetscInt m = 0; m < s.f.count; m++) l[s.f.cell[m]] = s.x[m];
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&fields[k]));
  PetscCall(PetscFree2(s.x, s.right));
  PetscCall(SamFrozenDestroy(&s.f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBackSolve(SamBack *b, PetscInt step)
{
  const SamRecord *record = &b->g->record[step];
  const SamGrid    g      = b->grid;
  System           s      = {.b = b};
  double           given[SAM_COMPONENTS], rubs = 0, touches, *moved, *r, *right, *x;
  PetscErrorCode   ierr;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2 * g->cells; k++) b->later[k] += b->at.by_slip[k];
  PetscCall(PetscArrayzero(b->forces, SAM_COMPONENTS));
  PetscCall(Freeze(&s));
  PetscCall(TurnAll(&s));
  PetscCall(CountBorders(&s));
  for (PetscInt m = 0; m < s.f.count; m++) rubs = PetscMax(rubs, s.f.free[m]);
  touches = s.f.count;
  PetscCall(SamMax(g->comm, 1, &rubs));
  PetscCall(SamMax(g->comm, 1, &touches));
  for (PetscInt n = 0; n < SAM_COMPONENTS; n++) /* without friction there is no shear that loads could change */
    if (record->force[components[n]] && Has(b, n) && (n < 3 || rubs > 0 || touches == 0)) s.given[s.count++] = n;
  PetscCall(PetscMalloc4(3 * s.f.count, &x, 3 * s.f.count, &right, 2 * s.f.count, &r, 3 * g->cells, &moved));
  s.x     = x;
  s.right = right;
  PetscCall(FindRight(&s, moved));
  PetscCall(FindGiven(&s, given));
  ierr = touches > 0 ? Solve(&s, rubs > 0 ? PETSC_TRUE : PETSC_FALSE, given, r) : CheckLost(&s, given);
  if (!ierr) PetscCall(SetCotangents(&s, r));
  PetscCall(PetscFree4(x, right, r, moved));
  PetscCall(SamFrozenClearBorder(&s.f));
  PetscCall(SamFrozenDestroy(&s.f));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
