/* The influence operator: kernels from the closed forms over a rectangle, products by convolution. */
#include <petsam/private/elasticityimpl.h>
#include <petsam/influence.h>

/* Grids with fewer cells than this in a direction are solved directly, without a coarser one. */
#define COARSEST 32

PetscErrorCode SamElasticityCreate(SamGrid grid, const SamPair *pair, SamElasticity *elasticity)
{
  SamElasticity C;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&C));
  C->references = 1;
  C->pair       = *pair;
  PetscCall(SamGridReference(grid));
  C->grid = grid;
  PetscCall(SamFourierCreate(grid, &C->fourier));
  *elasticity = C;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityReference(SamElasticity C)
{
  PetscFunctionBegin;
  C->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityDestroy(SamElasticity *elasticity)
{
  SamElasticity C = *elasticity;

  PetscFunctionBegin;
  *elasticity = NULL;
  if (!C || --C->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < SAM_KERNELS; k++) PetscCall(SamKernelDestroy(&C->kernel[k]));
  PetscCall(SamFourierDestroy(&C->fourier));
  PetscCall(SamTransferDestroy(&C->transfer));
  PetscCall(SamElasticityDestroy(&C->coarse));
  PetscCall(SamWindowDestroy(&C->window));
  PetscCall(SamElasticityDestroy(&C->part));
  PetscCall(SamGridDestroy(&C->grid));
  PetscCall(PetscFree(C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityRelease(SamElasticity C, PetscBool own)
{
  PetscFunctionBegin;
  if (C->coarse) PetscCall(SamElasticityRelease(C->coarse, PETSC_TRUE));
  if (C->part) PetscCall(SamElasticityRelease(C->part, PETSC_TRUE));
  PetscCall(SamFourierTrim(C->fourier));
  for (PetscInt k = 0; own && k < SAM_KERNELS; k++) PetscCall(SamKernelDestroy(&C->kernel[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetGrid(SamElasticity C, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = C->grid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetPair(SamElasticity C, const SamPair **pair)
{
  PetscFunctionBegin;
  *pair = &C->pair;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetCoarse(SamElasticity C, SamElasticity *coarse, SamTransfer *transfer)
{
  PetscFunctionBegin;
  if (!C->coarse && PetscMin(C->grid->nx, C->grid->ny) >= COARSEST) {
    SamGrid grid;

    PetscCall(SamGridCoarsen(C->grid, &grid));
    PetscCall(SamElasticityCreate(grid, &C->pair, &C->coarse));
    PetscCall(SamTransferCreate(C->grid, grid, &C->transfer));
    PetscCall(SamGridDestroy(&grid));
  }
  *coarse   = C->coarse;
  *transfer = C->transfer;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A kernel is a sum of at most two integrals over the cell. */
typedef struct {
  double      dx, dy;
  SamIntegral integral[2];
  double      factor[2];
} Coefficients;

static Coefficients GetCoefficients(SamElasticity C, SamKernelKind kind)
{
  const SamPair *pair = &C->pair;
  Coefficients   c    = {.dx = C->grid->dx, .dy = C->grid->dy};

  switch (kind) {
  case SAM_ZZ:
    c.integral[0] = SAM_INTEGRAL_R;
    c.factor[0]   = pair->normal;
    break;
  case SAM_XX:
  case SAM_YY:
    c.integral[0] = SAM_INTEGRAL_R;
    c.factor[0]   = pair->shear;
    c.integral[1] = kind == SAM_XX ? SAM_INTEGRAL_XX : SAM_INTEGRAL_YY;
    c.factor[1]   = pair->shear_xx;
    break;
  case SAM_XY:
    c.integral[0] = SAM_INTEGRAL_XY;
    c.factor[0]   = pair->shear_xx;
    break;
  default:
    c.integral[0] = kind == SAM_XZ ? SAM_INTEGRAL_X : SAM_INTEGRAL_Y;
    c.factor[0]   = pair->coupling;
  }
  return c;
}

static void CoefficientRow(PetscInt j, PetscInt n, double values[], const void *context)
{
  enum { CHUNK = 2048 };
  const Coefficients *c = (const Coefficients *)context;
  double              more[CHUNK];

  SamIntegralRow(c->integral[0], c->dx, c->dy, j, 0, n, values);
  for (PetscInt i = 0; i < n; i++) values[i] *= c->factor[0];
  if (c->factor[1] == 0) return;
  for (PetscInt start = 0; start < n; start += CHUNK) {
    const PetscInt count = PetscMin(CHUNK, n - start);

    SamIntegralRow(c->integral[1], c->dx, c->dy, j, start, count, more);
    for (PetscInt i = 0; i < count; i++) values[start + i] += c->factor[1] * more[i];
  }
}

double SamInfluenceCoefficient(SamElasticity C, SamKernelKind kind, PetscInt i, PetscInt j)
{
  const Coefficients c = GetCoefficients(C, kind);
  double             v = c.factor[0] * SamIntegralCell(c.integral[0], c.dx, c.dy, i, j);

  if (c.factor[1] != 0) v += c.factor[1] * SamIntegralCell(c.integral[1], c.dx, c.dy, i, j);
  return v;
}

PetscErrorCode SamElasticityGetKernel(SamElasticity C, SamKernelKind kind, SamKernel *kernel)
{
  PetscFunctionBegin;
  if (!C->kernel[kind]) {
    const Coefficients c     = GetCoefficients(C, kind);
    const PetscBool    odd_x = (kind == SAM_XY || kind == SAM_XZ) ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool    odd_y = (kind == SAM_XY || kind == SAM_YZ) ? PETSC_TRUE : PETSC_FALSE;

    PetscCall(SamKernelCreate(C->fourier, odd_x, odd_y, CoefficientRow, &c, &C->kernel[kind]));
  }
  *kernel = C->kernel[kind];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityGetSelfInfluence(SamElasticity C, PetscReal *normal, PetscReal *tangential)
{
  PetscFunctionBegin;
  if (normal) *normal = SamInfluenceCoefficient(C, SAM_ZZ, 0, 0);
  if (tangential)
    *tangential = PetscMax(SamInfluenceCoefficient(C, SAM_XX, 0, 0), SamInfluenceCoefficient(C, SAM_YY, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityIsCoupled(SamElasticity C, PetscBool *coupled)
{
  PetscFunctionBegin;
  /* bodies of equal constants cancel exactly; others may leave rounding */
  *coupled = PetscAbsReal(C->pair.dundurs) > 1e-14 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* out = matrix * in for fields of n_in and n_out components. */
static PetscErrorCode Product(SamElasticity C, const SamKernelMatrix *matrix, Vec in, Vec out)
{
  const double *x;
  double       *y;
  const double *from[SAM_FOURIER_FIELDS];
  double       *to[SAM_FOURIER_FIELDS];

  PetscFunctionBegin;
  if (in == out) {
    PetscCall(VecGetArray(out, &y));
    x = y;
  } else {
    PetscCall(VecGetArrayRead(in, &x));
    PetscCall(VecGetArrayWrite(out, &y));
  }
  for (PetscInt k = 0; k < matrix->n_in; k++) from[k] = x + k * C->grid->cells;
  for (PetscInt k = 0; k < matrix->n_out; k++) to[k] = y + k * C->grid->cells;
  PetscCall(SamConvolve(C->fourier, matrix, from, to));
  if (in == out) {
    PetscCall(VecRestoreArray(out, &y));
  } else {
    PetscCall(VecRestoreArrayWrite(out, &y));
    PetscCall(VecRestoreArrayRead(in, &x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NormalMatrix(SamElasticity C, SamKernelMatrix *matrix)
{
  PetscFunctionBegin;
  *matrix = (SamKernelMatrix){.n_in = 1, .n_out = 1, .scale = {{1}}};
  PetscCall(SamElasticityGetKernel(C, SAM_ZZ, &matrix->kernel[0][0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TangentialMatrix(SamElasticity C, SamKernelMatrix *matrix)
{
  PetscFunctionBegin;
  *matrix = (SamKernelMatrix){.n_in = 2, .n_out = 2, .scale = {{1, 1}, {1, 1}}};
  PetscCall(SamElasticityGetKernel(C, SAM_XX, &matrix->kernel[0][0]));
  PetscCall(SamElasticityGetKernel(C, SAM_XY, &matrix->kernel[0][1]));
  PetscCall(SamElasticityGetKernel(C, SAM_YY, &matrix->kernel[1][1]));
  matrix->kernel[1][0] = matrix->kernel[0][1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyNormal(SamElasticity C, Vec p, Vec u_z)
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  PetscCall(NormalMatrix(C, &matrix));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_APPLY_NORMAL], 0, 0, 0, 0));
  PetscCall(Product(C, &matrix, p, u_z));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_APPLY_NORMAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyNormalSingle(SamElasticity C, double factor, const float p[], float u_z[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  PetscCall(NormalMatrix(C, &matrix));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_APPLY_NORMAL], 0, 0, 0, 0));
  PetscCall(SamConvolveSingle(C->fourier, &matrix, factor, &p, &u_z));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_APPLY_NORMAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyTangential(SamElasticity C, Vec q, Vec u_t)
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  PetscCall(TangentialMatrix(C, &matrix));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_APPLY_TANGENTIAL], 0, 0, 0, 0));
  PetscCall(Product(C, &matrix, q, u_t));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_APPLY_TANGENTIAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyTangentialSingle(SamElasticity C, double factor, const float q[], float u_t[])
{
  const float *const in[2]  = {q, q + C->grid->cells};
  float *const       out[2] = {u_t, u_t + C->grid->cells};
  SamKernelMatrix    matrix;

  PetscFunctionBegin;
  PetscCall(TangentialMatrix(C, &matrix));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_APPLY_TANGENTIAL], 0, 0, 0, 0));
  PetscCall(SamConvolveSingle(C->fourier, &matrix, factor, in, out));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_APPLY_TANGENTIAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyNormalToTangential(SamElasticity C, Vec p, Vec u_t)
{
  SamKernelMatrix matrix = {.n_in = 1, .n_out = 2, .scale = {{1}, {1}}};

  PetscFunctionBegin;
  PetscCall(SamElasticityGetKernel(C, SAM_XZ, &matrix.kernel[0][0]));
  PetscCall(SamElasticityGetKernel(C, SAM_YZ, &matrix.kernel[1][0]));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_APPLY_COUPLING], 0, 0, 0, 0));
  PetscCall(Product(C, &matrix, p, u_t));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_APPLY_COUPLING], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityApplyTangentialToNormal(SamElasticity C, Vec q, Vec u_z)
{
  SamKernelMatrix matrix = {.n_in = 2, .n_out = 1, .scale = {{-1, -1}}};

  PetscFunctionBegin;
  PetscCall(SamElasticityGetKernel(C, SAM_XZ, &matrix.kernel[0][0]));
  PetscCall(SamElasticityGetKernel(C, SAM_YZ, &matrix.kernel[0][1]));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_APPLY_COUPLING], 0, 0, 0, 0));
  PetscCall(Product(C, &matrix, q, u_z));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_APPLY_COUPLING], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
