/*
  A contact whose sets of cells are frozen: its linear response to tractions, and an approximate inverse of that.

  Unknown are the change of the pressure p on all cells in contact, and that of the shear along y: both components where
  a cell sticks, the one along its circle where it slips. There the shear also follows the pressure, by mu e p. With P,
  which takes off what lies along e, and L = |ds|/(mu p),
      S p + B'(y + mu e p) = n,      P(C (y + mu e p) + B p) + L y = P t.
  The pressure of cells that yield stays, p = 0, so the first holds on the others only. Without coupling, B = 0, the
  first is a system of its own. Approximate inverses are the spectral ones of S and C; that of C with the weights of the
  tangential solver's Newton step (newton.c), in which a cell that slips counts with h = c/(c + L), c being its
  influence on itself.
*/
#include "stiffnessimpl.h"
#include <math.h>

/*
  Slip in a step that is less than this part of what the largest bound moves a cell by is the solver's error, and the
  cell sticks. Likewise an overlap that is less than this part of what the largest pressure moves a cell by is none.
*/
#define STILL 1e-5

/* ---- creation ---- */

/* A contact's fields, or the part of them in a window; the last three only for continued motion, else NULL. */
typedef struct {
  Vec pressure, bound, shear, slope, path, overlap;
} Fields;

static PetscErrorCode TakeField(SamWindow window, SamGrid grid, PetscInt components, Vec whole, Vec *field)
{
  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, components, field));
  if (window)
    PetscCall(SamWindowTake(window, whole, *field));
  else
    PetscCall(VecCopy(whole, *field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the pressure off cells that bear no more than their least pressure: their centres are not in contact. */
static PetscErrorCode LeaveLeast(SamWindow window, SamGrid grid, Vec whole, Vec pressure)
{
  Vec           least;
  const double *r;
  double       *p;

  PetscFunctionBegin;
  PetscCall(TakeField(window, grid, 1, whole, &least));
  PetscCall(VecGetArrayRead(least, &r));
  PetscCall(VecGetArray(pressure, &p));
  for (PetscInt k = 0; k < grid->cells; k++)
    if (p[k] <= r[k]) p[k] = 0;
  PetscCall(VecRestoreArray(pressure, &p));
  PetscCall(VecRestoreArrayRead(least, &r));
  PetscCall(VecDestroy(&least));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the law of friction and yielding say of a motion that continues that of the tried step. */
static PetscErrorCode CreateMotion(SamContact contact, const SamSolution *s, SamWindow window, SamGrid grid, Fields *f)
{
  SamBoundAt at = {NULL, s->control.friction_scale, s->pressure, NULL};
  SamProblem problem;
  SamGrid    whole;
  Vec        field;

  PetscFunctionBegin;
  PetscCall(SamContactGetProblem(contact, &problem));
  PetscCall(SamContactGetState(contact, &at.state));
  PetscCall(SamContactGetGrid(contact, &whole));
  PetscCall(SamGridCreateVec(whole, 1, &at.slip));
  PetscCall(SamGridCreateVec(whole, 1, &field));
  PetscCall(SamContactComputeFriction(contact, at.slip, NULL, NULL));
  PetscCall(TakeField(window, grid, 1, at.slip, &f->path));
  PetscCall(SamProblemComputeBound(problem, &at, &(SamBound){.by_pressure = field}));
  PetscCall(TakeField(window, grid, 1, field, &f->slope));
  PetscCall(VecSet(field, 0));
  PetscCall(SamProblemAddOverlap(problem, at.state, field));
  PetscCall(TakeField(window, grid, 1, field, &f->overlap));
  PetscCall(VecDestroy(&field));
  PetscCall(VecDestroy(&at.slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateFields(SamContact contact, SamStiffnessDirection direction, SamWindow window, SamGrid grid,
                                   Fields *f)
{
  const SamSolution *s;
  SamProblem         problem;
  SamState           state;
  Vec                least;

  PetscFunctionBegin;
  *f = (Fields){.path = NULL};
  PetscCall(SamContactGetSolution(contact, &s));
  PetscCall(TakeField(window, grid, 1, s->pressure, &f->pressure));
  PetscCall(TakeField(window, grid, 1, s->bound, &f->bound));
  PetscCall(TakeField(window, grid, 2, s->shear, &f->shear));
  PetscCall(SamContactGetProblem(contact, &problem));
  PetscCall(SamContactGetState(contact, &state));
  PetscCall(SamProblemGetLeast(problem, state, &least));
  if (least) PetscCall(LeaveLeast(window, grid, least, f->pressure));
  if (direction == SAM_STIFFNESS_FORWARD) PetscCall(CreateMotion(contact, s, window, grid, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFields(Fields *f)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&f->pressure));
  PetscCall(VecDestroy(&f->bound));
  PetscCall(VecDestroy(&f->shear));
  PetscCall(VecDestroy(&f->slope));
  PetscCall(VecDestroy(&f->path));
  PetscCall(VecDestroy(&f->overlap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Packs the cells in contact. */
static PetscErrorCode FindCells(SamFrozen *f, const double p[])
{
  const SamGrid grid = f->grid;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(grid->rows + 1, &f->start));
  f->count = 0;
  for (PetscInt k = 0; k < grid->cells; k++) f->count += p[k] > 0;
  PetscCall(PetscMalloc1(f->count, &f->cell));
  f->count = 0;
  for (PetscInt j = 0; j < grid->rows; j++) {
    f->start[j] = f->count;
    for (PetscInt k = j * grid->nx; k < (j + 1) * grid->nx; k++)
      if (p[k] > 0) f->cell[f->count++] = k;
  }
  f->start[grid->rows] = f->count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All cells stick and bear. */
static void SetReversal(SamFrozen *f, const double bound[])
{
  for (PetscInt m = 0; m < f->count; m++) {
    f->free[m] = bound[f->cell[m]] > 0 ? 1 : 0;
    f->e[0][m] = f->e[1][m] = f->follow[m] = f->stiff[m] = 0;
    f->bears[m]                                          = 1;
  }
}

/* Which cells slip, and how stiff they are then; a slip is more than `still` (m). */
static void SetSlip(SamFrozen *f, double still, const double p[], const double bound[], const double slope[],
                    const double q[], const double path[])
{
  const ptrdiff_t cells = f->grid->cells;

  for (PetscInt m = 0; m < f->count; m++) {
    const PetscInt k = f->cell[m];
    const double   b = bound[k], size = hypot(q[k], q[k + cells]);

    if (!(path[k] > still && size > 0 && b > 0) || SamCellStateOf(p[k], q[k], q[k + cells], b) != SAM_CELL_SLIP)
      continue;
    f->e[0][m]   = q[k] / size;
    f->e[1][m]   = q[k + cells] / size;
    f->follow[m] = slope[k];
    f->stiff[m]  = path[k] / b;
  }
}

/* Which cells yield in the step, and keep their pressure; an overlap is more than `still` (m). */
static void SetYielding(SamFrozen *f, double still, const double overlap[])
{
  for (PetscInt m = 0; m < f->count; m++)
    if (overlap[f->cell[m]] > still) f->bears[m] = 0;
}

static PetscErrorCode PackCells(SamFrozen *f, const Fields *from)
{
  const double *p, *b, *mu, *q, *path, *overlap;
  PetscReal     most[2];

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(from->pressure, &p));
  PetscCall(VecGetArrayRead(from->bound, &b));
  PetscCall(FindCells(f, p));
  PetscCall(PetscMalloc6(f->count, &f->e[0], f->count, &f->e[1], f->count, &f->follow, f->count, &f->stiff, f->count,
                         &f->free, f->count, &f->bears));
  SetReversal(f, b);
  if (from->path) {
    PetscCall(VecMax(from->pressure, NULL, &most[0]));
    PetscCall(VecMax(from->bound, NULL, &most[1]));
    PetscCall(VecGetArrayRead(from->shear, &q));
    PetscCall(VecGetArrayRead(from->slope, &mu));
    PetscCall(VecGetArrayRead(from->path, &path));
    PetscCall(VecGetArrayRead(from->overlap, &overlap));
    SetSlip(f, STILL * f->self[1] * (double)most[1], p, b, mu, q, path);
    SetYielding(f, STILL * f->self[0] * (double)most[0], overlap);
    PetscCall(VecRestoreArrayRead(from->overlap, &overlap));
    PetscCall(VecRestoreArrayRead(from->path, &path));
    PetscCall(VecRestoreArrayRead(from->slope, &mu));
    PetscCall(VecRestoreArrayRead(from->shear, &q));
  }
  PetscCall(VecRestoreArrayRead(from->bound, &b));
  PetscCall(VecRestoreArrayRead(from->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fields that products are made with; zero outside of the contact. */
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

/* Without a tried step there must be a committed one, at which the motion reverses. */
static PetscErrorCode CheckStep(SamContact contact, SamStiffnessDirection direction)
{
  PetscBool tried, committed;
  SamGrid   grid;

  PetscFunctionBegin;
  PetscCall(SamContactGetGrid(contact, &grid));
  PetscCall(SamContactHasStep(contact, &tried, &committed));
  PetscCheck(tried || committed, grid->comm, PETSC_ERR_ORDER,
             "there is no tried step, and no committed one, whose stiffness could be computed");
  PetscCheck(tried || direction == SAM_STIFFNESS_REVERSAL, grid->comm, PETSC_ERR_ORDER,
             "the forward stiffness needs the slip of the step, which is not kept after its commit: compute it before, "
             "or that of the reversal");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenCreate(SamContact contact, SamStiffnessDirection direction, SamFrozen *f)
{
  SamElasticityTraits traits;
  const SamSolution  *s;
  SamProblem          problem;
  SamGrid             whole;
  SamWindow           window;
  SamElasticity       part;
  PetscInt            first[2], n[2];
  PetscBool           full, friction;
  Fields              fields;

  PetscFunctionBegin;
  PetscCall(CheckStep(contact, direction));
  *f = (SamFrozen){.part = SAM_FROZEN_BOTH};
  PetscCall(SamContactGetProblem(contact, &problem));
  PetscCall(SamContactGetGrid(contact, &whole));
  PetscCall(SamProblemGetElasticity(problem, &f->elasticity));
  PetscCall(SamElasticityGetTraits(f->elasticity, &traits));
  PetscCall(SamContactGetCoupling(contact, &full));
  PetscCall(SamProblemHasFriction(problem, &friction));
  f->coupled = traits.coupled && full && friction;
  f->grid    = whole;
  PetscCall(SamContactGetSolution(contact, &s));
  PetscCall(SamGridGetSupport(whole, s->pressure, first, n));
  PetscCall(SamElasticityChoosePart(f->elasticity, first, n, PETSC_TRUE, &window, &part));
  if (window) {
    f->elasticity = part;
    PetscCall(SamWindowGetGrid(window, &f->grid));
  }
  PetscCall(SamElasticityGetSelfInfluence(f->elasticity, &f->self[0], &f->self[1]));
  PetscCall(SamFrameSet(&f->normal, f->grid, &(SamBalance){.kind = SAM_BALANCE_NORMAL}));
  PetscCall(SamFrameSet(&f->tangential, f->grid, &(SamBalance){.kind = SAM_BALANCE_TANGENTIAL}));
  PetscCall(CreateFields(contact, direction, window, f->grid, &fields));
  PetscCall(PackCells(f, &fields));
  PetscCall(DestroyFields(&fields));
  PetscCall(CreateWork(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenDestroy(SamFrozen *f)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(f->start));
  PetscCall(PetscFree(f->cell));
  PetscCall(PetscFree6(f->e[0], f->e[1], f->follow, f->stiff, f->free, f->bears));
  PetscCall(VecDestroy(&f->p));
  PetscCall(VecDestroy(&f->q));
  PetscCall(VecDestroy(&f->u_z));
  PetscCall(VecDestroy(&f->u_t));
  PetscCall(VecDestroy(&f->w_z));
  PetscCall(VecDestroy(&f->w_t));
  SamFree(f->r);
  SamFree(f->z);
  PetscFunctionReturn(PETSC_SUCCESS);
}
