/*
  Pressure and shear of dissimilar bodies in one: a step of Newton's method for both problems of a pass (coupling.c).

  Near the solution the cells in contact, those that stick and those that slip no longer change from pass to pass. With
  these sets frozen both problems are one linear system, solvers/frozen: the pressure's change takes the shear of cells
  that slip with it, q = mu p e, and the shear's change lifts the surfaces. A pass reduces the error by the same factor
  as a product with this system, but takes several products. The right-hand side are the gap of cells in contact, and
  the slip of cells that stick and across the shear of cells that slip. The displacements of loads that are given are
  fitted (solvers/frozen/held.c).

  The next pass starts from the tractions found, and corrects them where the sets have changed. Cells whose pressure
  would be negative get none.
*/
#include "stepimpl.h"
#include <petsam/private/balance.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/frozen.h>
#include <petsam/private/pressed.h>
#include <petsam/private/problem.h>
#include <math.h>

/* A larger relative residual of the system is not worth a pass. */
#define USEFUL 0.5

typedef struct {
  SamSolve *s;
  SamWindow window; /* NULL: the whole grid */
  SamGrid   grid;   /* of the window */
  PetscInt  first[2], n[2];
  SamFrozen f;
} Together;

static PetscErrorCode Take(Together *t, PetscInt components, Vec whole, Vec *field)
{
  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(t->grid, components, field));
  if (t->window)
    PetscCall(SamWindowTake(t->window, whole, *field));
  else
    PetscCall(VecCopy(whole, *field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a field of the window to one of the whole grid, which has zeros or no meaning elsewhere. */
static PetscErrorCode Add(Together *t, PetscInt components, Vec change, Vec whole)
{
  Vec part;

  PetscFunctionBegin;
  PetscCall(Take(t, components, whole, &part));
  PetscCall(VecAXPY(part, 1, change));
  if (t->window)
    PetscCall(SamWindowPut(t->window, part, whole));
  else
    PetscCall(VecCopy(part, whole));
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if a product is known in the whole window. */
static PetscBool Knows(const Together *t, const SamProduct *product)
{
  for (PetscInt k = 0; k < 2; k++)
    if (t->first[k] < product->first[k] || t->first[k] + t->n[k] > product->first[k] + product->n[k])
      return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Adds a product, known in the window only. */
static PetscErrorCode AddProduct(Together *t, PetscInt components, Vec change, SamProduct *product)
{
  PetscFunctionBegin;
  PetscCall(Add(t, components, change, product->field));
  for (PetscInt k = 0; k < 2; k++) {
    product->first[k] = t->first[k];
    product->n[k]     = t->n[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Subtracts the rigid displacements `rigid` of the force-controlled components, too, from a gap or a slip. */
static PetscErrorCode SubtractRigid(SamGrid grid, const SamBalance *balance, Vec field)
{
  SamFrame f;
  double  *u;

  PetscFunctionBegin;
  PetscCall(SamFrameSetGiven(&f, grid, balance));
  PetscCall(VecGetArray(field, &u));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++) {
      const ptrdiff_t k  = (ptrdiff_t)j * grid->nx + i;
      const double    xi = f.xi0 + (double)i * f.dxi, eta = SamFrameEta(&f, j);

      if (balance->kind == SAM_BALANCE_NORMAL) {
        u[k] -= SamFrameNormal(f.fixed, xi, eta);
      } else {
        u[k] -= SamFrameX(f.fixed, eta);
        u[k + grid->cells] -= SamFrameY(f.fixed, xi);
      }
    }
  PetscCall(VecRestoreArray(field, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the gap and the slip of the step by the tractions of the last pass, on the whole grid. */
static PetscErrorCode CreateErrors(SamSolve *s, Vec *gap, Vec *slip)
{
  SamBalance normal = s->normal, tangential = s->tangential;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, 1, gap));
  PetscCall(VecWAXPY(*gap, 1, s->h, s->pressure_product.field));
  for (PetscInt k = 0; k < 3; k++) {
    normal.rigid[k]     = s->s->rigid[SamComponentsOf[SAM_BALANCE_NORMAL][k]];
    tangential.rigid[k] = s->s->rigid[SamComponentsOf[SAM_BALANCE_TANGENTIAL][k]];
  }
  PetscCall(SubtractRigid(s->grid, &normal, *gap));
  PetscCall(SamSolveCreateOffset(s, slip));
  PetscCall(VecAXPY(*slip, 1, s->shear_product.field));
  PetscCall(SubtractRigid(s->grid, &tangential, *slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeLengths(SamGrid grid, Vec slip, Vec lengths)
{
  const double *s;
  double       *to;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(slip, &s));
  PetscCall(VecGetArrayWrite(lengths, &to));
  for (PetscInt k = 0; k < grid->cells; k++) to[k] = hypot(s[k], s[k + grid->cells]);
  PetscCall(VecRestoreArrayWrite(lengths, &to));
  PetscCall(VecRestoreArrayRead(slip, &s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Freezes the sets of cells of the last pass in the window. */
static PetscErrorCode Freeze(Together *t, SamElasticity part, Vec slip)
{
  SamSolve *const s                         = t->s;
  Vec             fields[SAM_FROZEN_FIELDS] = {NULL}, whole;
  SamBoundAt      at                        = {s->contact->state, &s->s->control, s->s->pressure, NULL, s->s->rolled};

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, 1, &whole));
  PetscCall(ComputeLengths(s->grid, slip, whole));
  PetscCall(Take(t, 1, whole, &fields[SAM_FROZEN_PATH]));
  PetscCall(VecSet(whole, 0));
  PetscCall(Take(t, 1, whole, &fields[SAM_FROZEN_OVERLAP]));
  PetscCall(SamProblemComputeBound(s->contact->problem, &at, &(SamBound){.by_pressure = whole}));
  PetscCall(Take(t, 1, whole, &fields[SAM_FROZEN_SLOPE]));
  PetscCall(Take(t, 1, s->s->pressure, &fields[SAM_FROZEN_PRESSURE]));
  PetscCall(Take(t, 1, s->s->bound, &fields[SAM_FROZEN_BOUND]));
  PetscCall(Take(t, 2, s->s->shear, &fields[SAM_FROZEN_SHEAR]));
  PetscCall(SamFrozenCreate(part, fields, PETSC_TRUE, INFINITY, SAM_FROZEN_STILL, &t->f));
  PetscCall(SamFrozenHold(&t->f, &s->normal, &s->tangential));
  for (int k = 0; k < SAM_FROZEN_FIELDS; k++) PetscCall(VecDestroy(&fields[k]));
  PetscCall(VecDestroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the system; the changes of the tractions and their products are then fields of t->f. */
static PetscErrorCode SolveFrozen(Together *t, Vec gap, Vec slip, PetscReal rtol, PetscReal *error)
{
  SamFrozen *const f = &t->f;
  double          *b, *x, *r;
  Vec              part;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(SamFrozenSize(f), &b, SamFrozenSize(f), &x, SamFrozenSize(f), &r));
  PetscCall(Take(t, 1, gap, &part));
  PetscCall(SamFrozenPack(f, part, b));
  PetscCall(VecDestroy(&part));
  PetscCall(Take(t, 2, slip, &part));
  PetscCall(SamFrozenPack(f, part, b + f->count));
  PetscCall(VecDestroy(&part));
  for (PetscInt m = 0; m < SamFrozenSize(f); m++) b[m] = -b[m];
  SamFrozenProject(f, b);
  f->rtol = rtol;
  PetscCall(SamKrylovSolve(f, b, x, r, error));
  PetscCall(PetscFree3(b, x, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cuts off negative pressures; their product is unknown then. */
static PetscErrorCode CutOff(SamSolve *s)
{
  double *p, negative = 0;

  PetscFunctionBegin;
  PetscCall(VecGetArray(s->s->pressure, &p));
  for (PetscInt k = 0; k < s->grid->cells; k++)
    if (p[k] < 0) {
      negative = 1;
      p[k]     = 0;
    }
  PetscCall(VecRestoreArray(s->s->pressure, &p));
  PetscCall(SamSum(s->grid->comm, 1, &negative));
  if (negative > 0) s->pressure_product.n[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the rounding of the displacements, which are of single precision, to that of the products: of the largest gap,
   m, and of the norm of the shear, Pa. */
static PetscErrorCode AddRounding(Together *t)
{
  const SamFrozen *f = &t->f;
  PetscReal        size[2];

  PetscFunctionBegin;
  PetscCall(VecNorm(f->u_z, NORM_INFINITY, &size[0]));
  PetscCall(SamGridNorm(t->grid, f->u_t, NORM_2, &size[1]));
  t->s->pressure_product.rounding += SAM_SINGLE_ROUNDING * (double)size[0];
  t->s->shear_product.rounding += SAM_SINGLE_ROUNDING * (double)size[1] / f->self[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Change(Together *t)
{
  SamSolve *const  s = t->s;
  SamFrozen *const f = &t->f;

  PetscFunctionBegin;
  PetscCall(AddRounding(t));
  PetscCall(Add(t, 1, f->p, s->s->pressure));
  PetscCall(Add(t, 2, f->q, s->s->shear));
  PetscCall(AddProduct(t, 1, f->u_z, &s->pressure_product));
  PetscCall(AddProduct(t, 2, f->u_t, &s->shear_product));
  PetscCall(CutOff(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveCanJoin(SamSolve *s, PetscBool *can)
{
  const SamMotion motion = s->contact->motion;
  PetscReal       limit;

  PetscFunctionBegin;
  PetscCall(SamProblemGetPressureLimit(s->contact->problem, &limit));
  *can = isinf(limit) && motion->continues && s->s->rolled == 0 && !s->touching ? PETSC_TRUE : PETSC_FALSE;
  if (SamProblemFollowsSlip(s->contact->problem)) *can = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveTogether(SamSolve *s, PetscReal rtol, PetscBool *made)
{
  const SamElasticity e = s->elasticity;
  Together            t = {.s = s, .grid = s->grid, .n = {s->grid->nx, s->grid->ny}};
  SamElasticity       part;
  Vec                 gap, slip;
  PetscReal           error;

  PetscFunctionBegin;
  *made = PETSC_FALSE;
  PetscCall(SamGridGetSupport(t.grid, s->s->pressure, PETSC_FALSE, t.first, t.n));
  PetscCall(SamElasticityChoosePart(e, t.first, t.n, PETSC_TRUE, &t.window, &part));
  t.first[0] = t.first[1] = 0;
  t.n[0]                  = s->grid->nx;
  t.n[1]                  = s->grid->ny;
  if (t.window) t.grid = SamWindowGetGrid(t.window);
  if (t.window) PetscCall(SamWindowGetPlace(t.window, t.first, t.n));
  if (!Knows(&t, &s->pressure_product) || !Knows(&t, &s->shear_product)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CreateErrors(s, &gap, &slip));
  PetscCall(Freeze(&t, t.window ? part : e, slip));
  PetscCall(SolveFrozen(&t, gap, slip, rtol, &error));
  *made = error < USEFUL ? PETSC_TRUE : PETSC_FALSE;
  if (*made) PetscCall(Change(&t));
  s->counts[SAM_COUNT_NORMAL + 1] += (double)t.f.applies;
  s->counts[SAM_COUNT_TANGENTIAL + 1] += (double)t.f.applies;
  s->counts[SAM_COUNT_NORMAL + 2] += (double)t.f.preconditions;
  s->counts[SAM_COUNT_TANGENTIAL + 2] += (double)t.f.preconditions;
  PetscCall(SamFrozenDestroy(&t.f));
  PetscCall(VecDestroy(&gap));
  PetscCall(VecDestroy(&slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}
