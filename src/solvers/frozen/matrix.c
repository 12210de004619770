/* The linear system of frozen sets of cells: its fields, products with its matrix, and an approximate inverse. */
#include <petsam/private/frozen.h>
#include <petsam/private/elasticity.h>
#include <math.h>

/* ---- fields ---- */

static PetscInt Components(const SamFrozen *f)
{
  return f->part == SAM_FROZEN_BOTH ? 3 : f->part == SAM_FROZEN_TANGENTIAL ? 2 : 1;
}

PetscInt SamFrozenSize(const SamFrozen *f)
{
  return Components(f) * f->count;
}

/* Return the indices of the pressure and of the shear in a vector; -1 if the system has none. */
static PetscInt PressureAt(const SamFrozen *f)
{
  return f->part == SAM_FROZEN_TANGENTIAL ? -1 : 0;
}
static PetscInt ShearAt(const SamFrozen *f)
{
  return f->part == SAM_FROZEN_NORMAL ? -1 : f->part == SAM_FROZEN_BOTH ? f->count : 0;
}

/* Returns g, the share of shear in the unknown along e. */
static double Share(const SamFrozen *f, PetscInt m)
{
  return sqrt(fabs(f->rate[m]));
}

/* Computes Q y, or with `all` P y; zero in cells without friction. */
static void Project(const SamFrozen *f, PetscBool all, double y[])
{
  double *x = y, *z = y + f->count;

  for (PetscInt m = 0; m < f->count; m++) {
    const double part = (x[m] * f->e[0][m] + z[m] * f->e[1][m]) * (all ? 1 : 1 - Share(f, m));

    x[m] = f->free[m] * (x[m] - part * f->e[0][m]);
    z[m] = f->free[m] * (z[m] - part * f->e[1][m]);
  }
}

/* Returns the part along e of a packed shear. Unknowns have one by rounding, even if no bound depends on the slip. */
static double Along(const SamFrozen *f, const double x[], PetscInt m)
{
  return x[m] * f->e[0][m] + x[m + f->count] * f->e[1][m];
}

/* Returns s c, the influence of a cell on itself with the sign of the rate; 0: the bound does not follow the slip. */
static double Signed(const SamFrozen *f, PetscInt m)
{
  return f->rate[m] != 0 ? copysign(f->self[1], f->rate[m]) : 0;
}

/* Sets a packed pressure to 0 on cells that yield. */
static void Bear(const SamFrozen *f, double p[])
{
  for (PetscInt m = 0; m < f->count; m++) p[m] *= f->bears[m];
}

/* Gets one of the six phi, which has one normal component or two tangential ones. */
static void RigidMotion(const SamFrozen *f, PetscInt k, double values[])
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

void SamFrozenMotion(const SamFrozen *f, PetscInt k, SamFrozenPart part, double values[])
{
  const PetscInt normal = part == SAM_FROZEN_TANGENTIAL ? 0 : f->count;
  const PetscInt all    = normal + (part == SAM_FROZEN_NORMAL ? 0 : 2 * f->count);

  if (k >= SAM_COMPONENTS) {
    (void)PetscArraycpy(values, f->motion[k - SAM_COMPONENTS] + (normal ? 0 : f->count), all);
    return;
  }
  (void)PetscArrayzero(values, all);
  if (k < 3 && normal) RigidMotion(f, k, values);
  if (k >= 3 && all > normal) RigidMotion(f, k, values + normal);
}

void SamFrozenProject(const SamFrozen *f, double values[])
{
  if (PressureAt(f) >= 0) Bear(f, values + PressureAt(f));
  if (ShearAt(f) >= 0) Project(f, PETSC_FALSE, values + ShearAt(f));
}

void SamFrozenColumn(const SamFrozen *f, PetscInt k, double column[])
{
  SamFrozenMotion(f, k, f->part, column);
  SamFrozenProject(f, column);
}

PetscErrorCode SamFrozenTurn(SamFrozen *f, PetscInt k, double sine, double factor)
{
  PetscFunctionBegin;
  if (!f->sine) PetscCall(PetscCalloc1(f->count, &f->sine));
  f->sine[k] = sine;
  f->stiff[k] *= factor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamFrozenProjectRow(const SamFrozen *f, double values[])
{
  double *x = values, *y = values + f->count;

  for (PetscInt m = 0; f->sine && m < f->count; m++) { /* the products with n_m, for what lies across e */
    const double sine = f->sine[m], cosine = sqrt(1 - sine * sine), e0 = f->e[0][m], e1 = f->e[1][m];
    const double part = cosine * (e0 * y[m] - e1 * x[m]) + sine * (e0 * x[m] + e1 * y[m]);

    if (sine == 0) continue;
    x[m] = -e1 * part;
    y[m] = e0 * part;
  }
  Project(f, PETSC_FALSE, values);
}

/* Turns the tractions across e, which are packed, into their own directions. */
static void Turn(const SamFrozen *f, double q[])
{
  double *x = q, *y = q + f->count;

  for (PetscInt m = 0; f->sine && m < f->count; m++) {
    const double sine = f->sine[m], cosine = sqrt(1 - sine * sine), e0 = f->e[0][m], e1 = f->e[1][m];
    const double part = e0 * y[m] - e1 * x[m];

    if (sine == 0) continue;
    x[m] = part * (sine * e0 - cosine * e1);
    y[m] = part * (sine * e1 + cosine * e0);
  }
}

void SamFrozenShear(const SamFrozen *f, const double p[], const double x[], double q[])
{
  for (PetscInt m = 0; m < f->count; m++) {
    const double along = x ? (Share(f, m) - 1) * Along(f, x, m) : 0;

    for (PetscInt c = 0; c < 2; c++)
      q[m + c * f->count] =
        (x ? x[m + c * f->count] : 0) + along * f->e[c][m] + (p ? f->follow[m] * f->e[c][m] * p[m] : 0);
  }
  Turn(f, q);
}

PetscErrorCode SamFrozenTakeSlip(const SamFrozen *f, PetscInt k, double slip[])
{
  const double *u;

  PetscFunctionBegin;
  SamFrozenMotion(f, k, SAM_FROZEN_TANGENTIAL, slip);
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
  SamTotal *totals;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n, &totals));
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt j = 0; j < f->grid->rows; j++) {
      double row = 0;

      for (PetscInt c = 0; c < Components(f); c++)
        for (PetscInt m = f->start[j] + c * f->count; m < f->start[j + 1] + c * f->count; m++)
          row += fields[k][m] * field[m];
      SamAdd(&totals[k], row);
    }
  PetscCall(SamSumTotals(f->grid->comm, n, totals, dots));
  PetscCall(PetscFree(totals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- fields of the grid ---- */

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

PetscErrorCode SamFrozenPack(const SamFrozen *f, Vec field, double values[])
{
  PetscInt size;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(field, &size));
  PetscCall(Pack(f, size > f->grid->cells ? 2 : 1, field, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenAddMotion(SamFrozen *f, Vec u_z, Vec u_t)
{
  double *motion;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * f->count, &motion));
  PetscCall(Pack(f, 1, u_z, motion));
  PetscCall(Pack(f, 2, u_t, motion + f->count));
  PetscCall(PetscRealloc(sizeof(*f->motion) * (size_t)(f->more + 1), &f->motion));
  f->motion[f->more++] = motion;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the matrix ---- */

/* Computes u_z and u_t of the tractions p and q, as far as the system has them. */
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
  if (f->respond) PetscCall((*f->respond)(f->context, f->p, f->q, f->u_z, f->u_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenSetTractions(SamFrozen *f, const double x[], double work[])
{
  const PetscInt p = PressureAt(f), y = ShearAt(f);

  PetscFunctionBegin;
  if (p >= 0) PetscCall(Unpack(f, 1, x + p, f->p));
  if (y < 0) PetscFunctionReturn(PETSC_SUCCESS);
  SamFrozenShear(f, p >= 0 && !f->transposed ? x + p : NULL, x + y, work);
  PetscCall(Unpack(f, 2, work, f->q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamFrozenFollow(const SamFrozen *f, double values[])
{
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++) values[m] += f->follow[m] * f->e[c][m] * values[m + (c + 1) * f->count];
}

/* Computes the displacements by the tractions of x in the cells, of a system with one kind of them, in single
   precision. */
static PetscErrorCode DisplaceSingle(SamFrozen *f, const double x[], double u[])
{
  const PetscBool normal = f->part == SAM_FROZEN_NORMAL ? PETSC_TRUE : PETSC_FALSE;
  const double    self   = f->self[normal ? 0 : 1]; /* makes the numbers of the order of residuals */
  const ptrdiff_t cells  = f->grid->cells;

  PetscFunctionBegin;
  f->applies++;
  if (!normal) SamFrozenShear(f, NULL, x, u);
  for (PetscInt c = 0; c < Components(f); c++)
    for (PetscInt m = 0; m < f->count; m++)
      f->r[f->cell[m] + c * cells] = (float)(self * (normal ? x : u)[m + c * f->count]);
  PetscCall((normal ? SamElasticityApplyNormalSingle : SamElasticityApplyTangentialSingle)(f->elasticity, 1 / self,
                                                                                           f->r, f->z));
  for (PetscInt c = 0; c < Components(f); c++)
    for (PetscInt m = 0; m < f->count; m++) u[m + c * f->count] = (double)f->z[f->cell[m] + c * cells];
  PetscCall(Unpack(f, Components(f), u, normal ? f->u_z : f->u_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DisplaceDouble(SamFrozen *f, const double x[], double u[])
{
  PetscFunctionBegin;
  PetscCall(SamFrozenSetTractions(f, x, u));
  PetscCall(ComputeDisplacements(f));
  if (PressureAt(f) >= 0) PetscCall(Pack(f, 1, f->u_z, u + PressureAt(f)));
  if (ShearAt(f) >= 0) PetscCall(Pack(f, 2, f->u_t, u + ShearAt(f)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFrozenApply(SamFrozen *f, const double x[], double Ax[])
{
  const PetscInt p = PressureAt(f), y = ShearAt(f);

  PetscFunctionBegin;
  PetscCall((f->single && f->part != SAM_FROZEN_BOTH ? DisplaceSingle : DisplaceDouble)(f, x, Ax));
  if (p >= 0 && y >= 0 && f->transposed) SamFrozenFollow(f, Ax);
  if (p >= 0) Bear(f, Ax + p);
  for (PetscInt m = 0; p >= 0 && f->soft && m < f->count; m++) Ax[p + m] += f->soft[m] * x[p + m];
  if (y < 0) PetscFunctionReturn(PETSC_SUCCESS);
  Project(f, PETSC_FALSE, Ax + y);
  for (PetscInt m = 0; m < f->count; m++) {
    const double own = (Signed(f, m) - f->stiff[m]) * Along(f, x + y, m);

    for (PetscInt c = 0; c < 2; c++)
      Ax[y + m + c * f->count] += f->stiff[m] * x[y + m + c * f->count] + own * f->e[c][m];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- its approximate inverse ---- */

/* Returns the weight of a cell's pressure in the approximate inverse: 1, less where the surface is soft. */
static double Hard(const SamFrozen *f, PetscInt m)
{
  return f->soft ? f->self[0] / (f->self[0] + f->soft[m]) : 1;
}

static PetscErrorCode PreconditionNormal(SamFrozen *f, const double r[], double z[])
{
  const PetscBool slides   = f->coupled && f->part == SAM_FROZEN_BOTH ? PETSC_TRUE : PETSC_FALSE;
  const double    sign     = !slides ? 0 : f->transposed ? -1 : 1; /* the transposed symbol is the conjugate one */
  const double    slope[2] = {sign * f->slope[0], sign * f->slope[1]};

  PetscFunctionBegin;
  for (PetscInt m = 0; m < f->count; m++) f->r[f->cell[m]] = (float)(sqrt(Hard(f, m)) * r[m]);
  PetscCall(SamElasticityPreconditionSlidingSingle(f->elasticity, f->self[0], slope, f->r, f->z));
  for (PetscInt m = 0; m < f->count; m++) {
    const double h = Hard(f, m);

    z[m] = (sqrt(h) * (double)f->z[f->cell[m]] + 0.5 * (1 - h) * h * r[m]) / f->self[0];
  }
  Bear(f, z);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PreconditionTangential(SamFrozen *f, const double r[], double z[])
{
  const double    self  = f->self[1];
  const ptrdiff_t cells = f->grid->cells;

  PetscFunctionBegin;
  for (PetscInt m = 0; m < f->count; m++) {
    const double along = Along(f, r, m), stiff = PetscMax(f->stiff[m], 0);

    for (PetscInt c = 0; c < 2; c++) {
      z[m + c * f->count]          = r[m + c * f->count] - along * f->e[c][m];
      f->r[f->cell[m] + c * cells] = (float)(sqrt(self / (self + stiff)) * z[m + c * f->count]);
    }
  }
  PetscCall(SamElasticityPreconditionTangentialSingle(f->elasticity, self, f->r, f->z));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++) {
      const double h = self / (self + PetscMax(f->stiff[m], 0));

      z[m + c * f->count] =
        (sqrt(h) * (double)f->z[f->cell[m] + c * cells] + 0.5 * (1 - h) * h * z[m + c * f->count]) / self;
    }
  Project(f, PETSC_TRUE, z);
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt m = 0; m < f->count; m++)
      if (f->rate[m] != 0) z[m + c * f->count] += Along(f, r, m) / Signed(f, m) * f->e[c][m];
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
