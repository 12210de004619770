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

/* A contact's fields, or the part of them in a window. */
typedef struct {
  Vec pressure, bound, shear, path, overlap;
} Fields;

static PetscErrorCode TakeField(SamWindow window, SamGrid grid, PetscInt components, Vec *field)
{
  Vec whole = *field;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, components, field));
  if (window)
    PetscCall(SamWindowTake(window, whole, *field));
  else
    PetscCall(VecCopy(whole, *field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the pressure off cells on the rim of a corrected edge, whose centres are not in contact. */
static PetscErrorCode LeaveRim(SamWindow window, SamGrid grid, Vec whole, Vec pressure)
{
  Vec           rim = whole;
  const double *r;
  double       *p;

  PetscFunctionBegin;
  PetscCall(TakeField(window, grid, 1, &rim));
  PetscCall(VecGetArrayRead(rim, &r));
  PetscCall(VecGetArray(pressure, &p));
  for (PetscInt k = 0; k < grid->cells; k++)
    if (p[k] <= r[k]) p[k] = 0;
  PetscCall(VecRestoreArray(pressure, &p));
  PetscCall(VecRestoreArrayRead(rim, &r));
  PetscCall(VecDestroy(&rim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateFields(SamContact contact, SamWindow window, SamGrid grid, Fields *f)
{
  const SamSolution *s;
  Vec                path, overlap;
  SamGrid            whole;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(contact, &s));
  PetscCall(SamContactGetGrid(contact, &whole));
  PetscCall(SamGridCreateVec(whole, 1, &path));
  PetscCall(SamContactComputeFriction(contact, path, NULL, NULL));
  PetscCall(SamGridCreateVec(whole, 1, &overlap));
  PetscCall(SamContactComputeOverlap(contact, overlap));
  *f = (Fields){s->pressure, s->bound, s->shear, path, overlap};
  PetscCall(TakeField(window, grid, 1, &f->pressure));
  PetscCall(TakeField(window, grid, 1, &f->bound));
  PetscCall(TakeField(window, grid, 2, &f->shear));
  if (s->passes) PetscCall(LeaveRim(window, grid, s->rim, f->pressure));
  PetscCall(TakeField(window, grid, 1, &f->path));
  PetscCall(TakeField(window, grid, 1, &f->overlap));
  PetscCall(VecDestroy(&path));
  PetscCall(VecDestroy(&overlap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFields(Fields *f)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&f->pressure));
  PetscCall(VecDestroy(&f->bound));
  PetscCall(VecDestroy(&f->shear));
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

/* Whether each cell sticks or slips, and how stiff it is then; a slip is more than `still` (m). */
static void SetCells(SamFrozen *f, double still, const double p[], const double bound[], const double q[],
                     const double path[])
{
  const ptrdiff_t cells = f->grid->cells;

  for (PetscInt m = 0; m < f->count; m++) {
    const PetscInt  k = f->cell[m];
    const double    b = bound[k], size = hypot(q[k], q[k + cells]);
    const PetscBool slips = path[k] > still && size > 0 && SamStateOf(p[k], q[k], q[k + cells], b) == SAM_STATE_SLIP;

    f->free[m]   = b > 0 ? 1 : 0;
    f->e[0][m]   = slips && b > 0 ? q[k] / size : 0;
    f->e[1][m]   = slips && b > 0 ? q[k + cells] / size : 0;
    f->follow[m] = slips && b > 0 ? b / p[k] : 0;
    f->stiff[m]  = slips && b > 0 ? path[k] / b : 0;
  }
}

/* Which cells do not yield in the step; an overlap is more than `still` (m). */
static void SetYielding(SamFrozen *f, double still, const double overlap[])
{
  for (PetscInt m = 0; m < f->count; m++) f->bears[m] = overlap[f->cell[m]] > still ? 0 : 1;
}

static PetscErrorCode PackCells(SamFrozen *f, SamStiffnessDirection direction, const Fields *from)
{
  const PetscBool forward = direction == SAM_STIFFNESS_FORWARD;
  const double   *p, *b, *q, *path, *overlap;
  PetscReal       most[2];

  PetscFunctionBegin;
  PetscCall(VecMax(from->pressure, NULL, &most[0]));
  PetscCall(VecMax(from->bound, NULL, &most[1]));
  PetscCall(VecGetArrayRead(from->pressure, &p));
  PetscCall(VecGetArrayRead(from->bound, &b));
  PetscCall(VecGetArrayRead(from->shear, &q));
  PetscCall(VecGetArrayRead(from->path, &path));
  PetscCall(VecGetArrayRead(from->overlap, &overlap));
  PetscCall(FindCells(f, p));
  PetscCall(PetscMalloc6(f->count, &f->e[0], f->count, &f->e[1], f->count, &f->follow, f->count, &f->stiff, f->count,
                         &f->free, f->count, &f->bears));
  SetCells(f, forward ? STILL * f->self[1] * (double)most[1] : INFINITY, p, b, q, path);
  SetYielding(f, forward ? STILL * f->self[0] * (double)most[0] : INFINITY, overlap);
  PetscCall(VecRestoreArrayRead(from->overlap, &overlap));
  PetscCall(VecRestoreArrayRead(from->path, &path));
  PetscCall(VecRestoreArrayRead(from->shear, &q));
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

/* The frames of the grid, for their coordinates. */
static PetscErrorCode SetFrames(SamFrozen *f)
{
  const SamBalance normal = {.kind = SAM_BALANCE_NORMAL}, tangential = {.kind = SAM_BALANCE_TANGENTIAL};

  PetscFunctionBegin;
  PetscCall(SamFrameSetGiven(&f->normal, f->grid, &normal));
  PetscCall(SamFrameSetGiven(&f->tangential, f->grid, &tangential));
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
  PetscCall(SetFrames(f));
  PetscCall(CreateFields(contact, window, f->grid, &fields));
  PetscCall(PackCells(f, direction, &fields));
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

/* ---- fields ---- */

static PetscInt Components(const SamFrozen *f)
{
  return f->part == SAM_FROZEN_BOTH ? 3 : f->part == SAM_FROZEN_TANGENTIAL ? 2 : 1;
}

PetscInt SamFrozenSize(const SamFrozen *f)
{
  return Components(f) * f->count;
}

/* The pressure of a field, and its shear; NULL where the system has none. */
static PetscInt PressureAt(const SamFrozen *f)
{
  return f->part == SAM_FROZEN_TANGENTIAL ? -1 : 0;
}
static PetscInt ShearAt(const SamFrozen *f)
{
  return f->part == SAM_FROZEN_NORMAL ? -1 : f->part == SAM_FROZEN_BOTH ? f->count : 0;
}

/* Takes off the parts of a packed shear along e, and all of it where there is no friction. */
static void Project(const SamFrozen *f, double y[])
{
  double *x = y, *z = y + f->count;

  for (PetscInt m = 0; m < f->count; m++) {
    const double part = x[m] * f->e[0][m] + z[m] * f->e[1][m];

    x[m] = f->free[m] * (x[m] - part * f->e[0][m]);
    z[m] = f->free[m] * (z[m] - part * f->e[1][m]);
  }
}

/* Takes off a packed pressure what lies on cells that yield. */
static void Bear(const SamFrozen *f, double p[])
{
  for (PetscInt m = 0; m < f->count; m++) p[m] *= f->bears[m];
}

void SamFrozenMotion(const SamFrozen *f, PetscInt k, double values[])
{
  const SamGrid   grid  = f->grid;
  const SamFrame *frame = k < 3 ? &f->normal : &f->tangential;
  double          a[3]  = {0, 0, 0};

  a[k % 3] = 1;
  for (PetscInt j = 0; j < grid->rows; j++) {
    const double eta = SamFrameEta(frame, j);

    for (PetscInt m = f->start[j]; m < f->start[j + 1]; m++) {
      const double xi = frame->xi0 + (double)(f->cell[m] - j * grid->nx) * frame->dxi;

      if (k < 3) {
        values[m] = SamFrameNormal(a, xi, eta);
      } else {
        values[m]            = SamFrameX(a, eta);
        values[m + f->count] = SamFrameY(a, xi);
      }
    }
  }
}

void SamFrozenColumn(const SamFrozen *f, PetscInt k, double column[])
{
  const PetscInt at = k < 3 ? PressureAt(f) : ShearAt(f);

  for (PetscInt m = 0; m < SamFrozenSize(f); m++) column[m] = 0;
  if (at < 0) return;
  SamFrozenMotion(f, k, column + at);
  if (k >= 3)
    Project(f, column + at);
  else
    Bear(f, column + at);
}

void SamFrozenFollow(const SamFrozen *f, const double p[], double q[])
{
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++) q[m + c * f->count] += f->follow[m] * f->e[c][m] * p[m];
}

PetscErrorCode SamFrozenTakeSlip(const SamFrozen *f, PetscInt k, double slip[])
{
  const double *u;

  PetscFunctionBegin;
  SamFrozenMotion(f, k, slip);
  PetscCall(VecGetArrayRead(f->u_t, &u));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++)
      slip[m + c * f->count] = u[f->cell[m] + c * f->grid->cells] - slip[m + c * f->count];
  PetscCall(VecRestoreArrayRead(f->u_t, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenDots(const SamFrozen *f, PetscInt n, double *const fields[], const double field[],
                             double dots[])
{
  PetscFunctionBegin;
  for (PetscInt from = 0; from < n; from += SAM_TOTALS) {
    const PetscInt some               = PetscMin(n - from, SAM_TOTALS);
    SamTotal       totals[SAM_TOTALS] = {{0}};

    for (PetscInt k = 0; k < some; k++)
      for (PetscInt j = 0; j < f->grid->rows; j++) {
        double row = 0;

        for (PetscInt c = 0; c < Components(f); c++)
          for (PetscInt m = f->start[j] + c * f->count; m < f->start[j + 1] + c * f->count; m++)
            row += fields[from + k][m] * field[m];
        SamAdd(&totals[k], row);
      }
    PetscCall(SamSumTotals(f->grid->comm, some, totals, dots + from));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the matrix ---- */

/* Writes packed components to a field, which is zero elsewhere. */
static PetscErrorCode Unpack(const SamFrozen *f, PetscInt components, const double values[], Vec field)
{
  double *to;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &to));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt m = 0; m < f->count; m++) to[f->cell[m] + c * f->grid->cells] = values[m + c * f->count];
  PetscCall(VecRestoreArray(field, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pack(const SamFrozen *f, PetscInt components, Vec field, double values[])
{
  const double *from;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(field, &from));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt m = 0; m < f->count; m++) values[m + c * f->count] = from[f->cell[m] + c * f->grid->cells];
  PetscCall(VecRestoreArrayRead(field, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u_z and u_t of the tractions p and q, as far as the system has them. */
static PetscErrorCode ComputeDisplacements(SamFrozen *f)
{
  PetscFunctionBegin;
  f->applies++;
  if (f->part != SAM_FROZEN_TANGENTIAL) PetscCall(SamElasticityApplyNormal(f->elasticity, f->p, f->u_z));
  if (f->part != SAM_FROZEN_NORMAL) PetscCall(SamElasticityApplyTangential(f->elasticity, f->q, f->u_t));
  if (f->part != SAM_FROZEN_BOTH) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityApplyTangentialToNormal(f->elasticity, f->q, f->w_z));
  PetscCall(VecAXPY(f->u_z, 1, f->w_z));
  PetscCall(SamElasticityApplyNormalToTangential(f->elasticity, f->p, f->w_t));
  PetscCall(VecAXPY(f->u_t, 1, f->w_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenApply(SamFrozen *f, const double x[], double Ax[])
{
  const PetscInt p = PressureAt(f), y = ShearAt(f);

  PetscFunctionBegin;
  if (p >= 0) PetscCall(Unpack(f, 1, x + p, f->p));
  if (p >= 0 && y >= 0) { /* Ax is room for the whole shear */
    PetscCall(PetscArraycpy(Ax, x + y, 2 * f->count));
    SamFrozenFollow(f, x + p, Ax);
    PetscCall(Unpack(f, 2, Ax, f->q));
  } else if (y >= 0) {
    PetscCall(Unpack(f, 2, x + y, f->q));
  }
  PetscCall(ComputeDisplacements(f));
  if (p >= 0) PetscCall(Pack(f, 1, f->u_z, Ax + p));
  if (p >= 0) Bear(f, Ax + p);
  if (y < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Pack(f, 2, f->u_t, Ax + y));
  Project(f, Ax + y);
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++) Ax[y + m + c * f->count] += f->stiff[m] * x[y + m + c * f->count];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- its approximate inverse ---- */

static PetscErrorCode PreconditionNormal(SamFrozen *f, const double r[], double z[])
{
  PetscFunctionBegin;
  for (PetscInt m = 0; m < f->count; m++) f->r[f->cell[m]] = (float)r[m];
  PetscCall(SamElasticityPreconditionNormalSingle(f->elasticity, f->self[0], f->r, f->z));
  for (PetscInt m = 0; m < f->count; m++) z[m] = (double)f->z[f->cell[m]] / f->self[0];
  Bear(f, z);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PreconditionTangential(SamFrozen *f, const double r[], double z[])
{
  const double    self  = f->self[1];
  const ptrdiff_t cells = f->grid->cells;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++)
      f->r[f->cell[m] + c * cells] = (float)(sqrt(self / (self + f->stiff[m])) * r[m + c * f->count]);
  PetscCall(SamElasticityPreconditionTangentialSingle(f->elasticity, self, f->r, f->z));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++) {
      const double h = self / (self + f->stiff[m]);

      z[m + c * f->count] =
        (sqrt(h) * (double)f->z[f->cell[m] + c * cells] + 0.5 * (1 - h) * h * r[m + c * f->count]) / self;
    }
  Project(f, z);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenPrecondition(SamFrozen *f, const double r[], double z[])
{
  const PetscInt p = PressureAt(f), y = ShearAt(f);

  PetscFunctionBegin;
  f->preconditions++;
  if (p >= 0) PetscCall(PreconditionNormal(f, r + p, z + p));
  if (p >= 0 && y >= 0) /* they share the array of residuals, which is zero outside of the contact */
    PetscCall(PetscArrayzero(f->r + f->grid->cells, f->grid->cells));
  if (y >= 0) PetscCall(PreconditionTangential(f, r + y, z + y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
