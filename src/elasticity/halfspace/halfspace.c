/*
  Two half-spaces: tractions constant on each cell, kernels from the closed forms over a rectangle (influence.c),
  products by convolution without wrapping round (fourier/kernel.c). Source: Liu, Wang and Liu 2000, Wear 243, 101-111.
*/
#include "../waves.h"
#include <petsam/private/halfspace.h>
#include <math.h>

/* Kernels: row and column of the 3 x 3 operator; the lower triangle follows by symmetry. */
typedef enum { ZZ, XX, YY, XY, XZ, YZ, KERNELS } Kind;

typedef struct {
  SamKernel kernel[KERNELS]; /* NULL until needed */
  SamKernel slope[2];        /* of pressures linear in x and in y; likewise */
} HalfSpace;

/* A kernel is a sum of at most two integrals over the cell. */
typedef struct {
  double      dx, dy;
  SamIntegral integral[2];
  double      factor[2];
} Coefficients;

static Coefficients GetCoefficients(SamElasticity e, Kind kind)
{
  const SamPair *pair = &e->pair;
  Coefficients   c    = {.dx = e->grid->dx, .dy = e->grid->dy};

  switch (kind) {
  case ZZ:
    c.integral[0] = SAM_INTEGRAL_R;
    c.factor[0]   = pair->normal;
    break;
  case XX:
  case YY:
    c.integral[0] = SAM_INTEGRAL_R;
    c.factor[0]   = pair->shear;
    c.integral[1] = kind == XX ? SAM_INTEGRAL_XX : SAM_INTEGRAL_YY;
    c.factor[1]   = pair->shear_xx;
    break;
  case XY:
    c.integral[0] = SAM_INTEGRAL_XY;
    c.factor[0]   = pair->shear_xx;
    break;
  default:
    c.integral[0] = kind == XZ ? SAM_INTEGRAL_X : SAM_INTEGRAL_Y;
    c.factor[0]   = pair->coupling;
  }
  return c;
}

static void CoefficientRow(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  enum { CHUNK = 2048 };
  const Coefficients *c = (const Coefficients *)context;
  double              more[CHUNK];

  SamIntegralRow(c->integral[0], c->dx, c->dy, j, 0, n, values[0]);
  for (PetscInt i = 0; i < n; i++) values[0][i] *= c->factor[0];
  if (c->factor[1] == 0) return;
  for (PetscInt start = 0; start < n; start += CHUNK) {
    const PetscInt count = PetscMin(CHUNK, n - start);

    SamIntegralRow(c->integral[1], c->dx, c->dy, j, start, count, more);
    for (PetscInt i = 0; i < count; i++) values[0][start + i] += c->factor[1] * more[i];
  }
}

/* The influence of a cell on itself, m/Pa. */
static double SelfInfluence(SamElasticity e, Kind kind)
{
  const Coefficients c = GetCoefficients(e, kind);
  double             v = c.factor[0] * SamIntegralCell(c.integral[0], c.dx, c.dy, 0, 0);

  if (c.factor[1] != 0) v += c.factor[1] * SamIntegralCell(c.integral[1], c.dx, c.dy, 0, 0);
  return v;
}

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  PetscFunctionBegin;
  *normal     = SelfInfluence(e, ZZ);
  *tangential = PetscMax(SelfInfluence(e, XX), SelfInfluence(e, YY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetKernel(SamElasticity e, Kind kind, SamKernel *kernel)
{
  HalfSpace *data = (HalfSpace *)e->data;

  PetscFunctionBegin;
  if (!data->kernel[kind]) {
    const Coefficients c        = GetCoefficients(e, kind);
    const PetscBool    odd[][2] = {{kind == XY || kind == XZ, kind == XY || kind == YZ}};

    PetscCall(SamKernelsCreate(e->fourier, 1, odd, CoefficientRow, &c, &data->kernel[kind]));
  }
  *kernel = data->kernel[kind];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

/* The kernels of u_z from p, and of u_t from q. */
static PetscErrorCode GetMatrix(SamElasticity e, PetscInt components, SamKernelMatrix *matrix)
{
  PetscFunctionBegin;
  *matrix = (SamKernelMatrix){.n_in = components, .n_out = components, .scale = {{1, 1}, {1, 1}}};
  PetscCall(GetKernel(e, components == 1 ? ZZ : XX, &matrix->kernel[0][0]));
  if (components == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GetKernel(e, XY, &matrix->kernel[0][1]));
  PetscCall(GetKernel(e, YY, &matrix->kernel[1][1]));
  matrix->kernel[1][0] = matrix->kernel[0][1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Apply(SamElasticity e, PetscInt components, const double *const in[], double *const out[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  PetscCall(GetMatrix(e, components, &matrix));
  PetscCall(SamConvolve(e->fourier, &matrix, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplySingle(SamElasticity e, PetscInt components, double factor, const float *const in[],
                                  float *const out[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  PetscCall(GetMatrix(e, components, &matrix));
  PetscCall(SamConvolveSingle(e->fourier, &matrix, factor, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyNormal(SamElasticity e, const double *const p[], double *const u_z[])
{
  return Apply(e, 1, p, u_z);
}

static PetscErrorCode ApplyTangential(SamElasticity e, const double *const q[], double *const u_t[])
{
  return Apply(e, 2, q, u_t);
}

static PetscErrorCode ApplyNormalSingle(SamElasticity e, double factor, const float *const p[], float *const u_z[])
{
  return ApplySingle(e, 1, factor, p, u_z);
}

static PetscErrorCode ApplyTangentialSingle(SamElasticity e, double factor, const float *const q[], float *const u_t[])
{
  return ApplySingle(e, 2, factor, q, u_t);
}

static PetscErrorCode ApplyNormalToTangential(SamElasticity e, const double *const p[], double *const u_t[])
{
  SamKernelMatrix matrix = {.n_in = 1, .n_out = 2, .scale = {{1}, {1}}};

  PetscFunctionBegin;
  PetscCall(GetKernel(e, XZ, &matrix.kernel[0][0]));
  PetscCall(GetKernel(e, YZ, &matrix.kernel[1][0]));
  PetscCall(SamConvolve(e->fourier, &matrix, p, u_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyTangentialToNormal(SamElasticity e, const double *const q[], double *const u_z[])
{
  SamKernelMatrix matrix = {.n_in = 2, .n_out = 1, .scale = {{-1, -1}}};

  PetscFunctionBegin;
  PetscCall(GetKernel(e, XZ, &matrix.kernel[0][0]));
  PetscCall(GetKernel(e, YZ, &matrix.kernel[0][1]));
  PetscCall(SamConvolve(e->fourier, &matrix, q, u_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the spectral preconditioner ---- */

/*
  On an infinite surface a wave of pressure exp(i k.x) gives the displacement 2 pi A/|k| times itself, A = pair.normal,
  so that |k| is the inverse up to a factor. For shear the symbol is (2 pi (A + B)/|k|)(I - nu kk'/|k|^2), B =
  pair.shear_xx, nu = B/(A + B), with the inverse (|k|/(2 pi (A + B)))(I + nu/(1 - nu) kk'/|k|^2). Here they act on the
  grid made periodic, which costs a quarter of a padded transform and needs as few iterations. The symbol is computed
  anew each time. Single precision will do for an approximation. `local`: A or A + B.
*/
static PetscErrorCode Precondition(SamElasticity e, PetscInt n, double factor, double local, SamSymbol s,
                                   const float *const in[], float *const out[])
{
  PetscInt hx, hy;

  PetscFunctionBegin;
  PetscCall(SamFourierGetPeriods(e->fourier, &hx, &hy));
  s.step[0] = 2 * PETSC_PI / (double)hx * e->grid->length / e->grid->dx;
  s.step[1] = 2 * PETSC_PI / (double)hy * e->grid->length / e->grid->dy;
  s.gain    = factor / (2 * PETSC_PI * local * (double)hx * (double)hy * e->grid->length);
  s.mean    = 0.5 * PetscMin(s.step[0], s.step[1]);
  PetscCall(SamSymbolApplySingle(e, &s, n, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Times gain |k| (I + nu kk'/|k|^2). */
SAM_VECTORIZED static void DivideTangential(const SamSymbol *s, SamWaves at)
{
  const float gain = (float)s->gain, mean = (float)s->mean, extra = (float)s->nu, least = mean * mean,
              step = (float)s->step[1], kx = (float)at.kx, sign = (float)at.cross;
  float(*restrict x)[2] = (float(*)[2])at.x, (*restrict y)[2] = (float(*)[2])at.y;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky, some = k2 > least ? k2 : least,
                g    = gain * sqrtf(some);
    const float part = g * extra / some, cross = sign * part * kx * ky, gx = g + part * kx * kx,
                gy = g + part * ky * ky;
    const float x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = gx * x0 + cross * y0;
    x[m][1] = gx * x1 + cross * y1;
    y[m][0] = gy * y0 + cross * x0;
    y[m][1] = gy * y1 + cross * x1;
  }
}

static PetscErrorCode PreconditionNormal(SamElasticity e, double factor, const float *const r[], float *const p[])
{
  return Precondition(e, 1, factor, e->pair.normal, (SamSymbol){.multiply = SamSymbolDivideNormal}, r, p);
}

static PetscErrorCode PreconditionTangential(SamElasticity e, double factor, const float *const r[], float *const q[])
{
  const SamSymbol s = {.nu = e->pair.shear_xx / e->pair.shear, .multiply = DivideTangential};

  return Precondition(e, 2, factor, e->pair.shear + e->pair.shear_xx, s, r, q);
}

/* ---- within cells ---- */

static void SlopeRow(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  SamSlopeRow((const SamSlopeKernel *)context, j, n, values[0]);
}

/* The kernel for pressures that are linear along an axis. */
static PetscErrorCode GetSlopeKernel(SamElasticity e, int axis, SamKernel *kernel)
{
  HalfSpace *data = (HalfSpace *)e->data;

  PetscFunctionBegin;
  if (!data->slope[axis]) {
    const PetscBool odd[][2] = {{axis == 0, axis == 1}};
    SamSlopeRules   rules;
    SamSlopeKernel  c = {.rules = &rules, .axis = axis, .dx = e->grid->dx, .dy = e->grid->dy, .factor = e->pair.normal};

    PetscCall(SamSlopeRulesCreate(&rules));
    PetscCall(SamKernelsCreate(e->fourier, 1, odd, SlopeRow, &c, &data->slope[axis]));
  }
  *kernel = data->slope[axis];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyNormalSlopes(SamElasticity e, const double *const slopes[], double *const u_z[])
{
  SamKernelMatrix matrix = {.n_in = 2, .n_out = 1, .scale = {{1, 1}}};

  PetscFunctionBegin;
  for (int axis = 0; axis < 2; axis++) PetscCall(GetSlopeKernel(e, axis, &matrix.kernel[0][axis]));
  PetscCall(SamConvolve(e->fourier, &matrix, slopes, u_z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetNear(SamElasticity e, PetscInt reach, PetscInt sub, double table[])
{
  const double   dx = e->grid->dx / (double)sub, dy = e->grid->dy / (double)sub;
  const PetscInt lags = 2 * reach + 1, cells = sub * sub;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < lags * lags * cells; n++) {
    const PetscInt lag = n / cells, cell = n % cells;
    const PetscInt i = (lag % lags - reach) * sub + sub / 2 - cell % sub,
                   j = (lag / lags - reach) * sub + sub / 2 - cell / sub;

    table[n] = e->pair.normal * SamIntegralCell(SAM_INTEGRAL_R, dx, dy, i, j);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the type ---- */

static PetscErrorCode CreateStress(SamElasticity e, PetscInt body, const SamFourierSettings *settings,
                                   SamStress *stress)
{
  PetscFunctionBegin;
  PetscCall(
    SamHalfSpaceCreateStress(e->grid, settings, body, e->pair.young[body - 1], e->pair.poisson[body - 1], stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(SamFourierCreate(e->grid, SAM_FOURIER_FAST, &e->fft, &e->fourier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamElasticity e)
{
  HalfSpace *data = (HalfSpace *)e->data;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < KERNELS; k++) PetscCall(SamKernelDestroy(&data->kernel[k]));
  for (PetscInt axis = 0; axis < 2; axis++) PetscCall(SamKernelDestroy(&data->slope[axis]));
  PetscCall(PetscFree(e->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate_HalfSpace(SamElasticity e)
{
  HalfSpace *data;

  PetscFunctionBegin;
  PetscCall(PetscNew(&data));
  e->data   = data;
  e->traits = (SamElasticityTraits){.coupled   = SamElasticityPairIsCoupled(&e->pair),
                                    .stretch   = PETSC_TRUE,
                                    .rotations = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                                    .mean      = PETSC_TRUE,
                                    .parts     = PETSC_TRUE,
                                    .within    = PETSC_TRUE};
  e->ops    = (SamElasticityOps){.setup                   = SetUp,
                                 .destroy                 = Destroy,
                                 .applynormal             = ApplyNormal,
                                 .applytangential         = ApplyTangential,
                                 .applynormalsingle       = ApplyNormalSingle,
                                 .applytangentialsingle   = ApplyTangentialSingle,
                                 .preconditionnormal      = PreconditionNormal,
                                 .preconditiontangential  = PreconditionTangential,
                                 .getselfinfluence        = GetSelfInfluence,
                                 .createstress            = CreateStress,
                                 .applynormaltotangential = ApplyNormalToTangential,
                                 .applytangentialtonormal = ApplyTangentialToNormal,
                                 .applynormalslopes       = ApplyNormalSlopes,
                                 .getnear                 = GetNear};
  PetscFunctionReturn(PETSC_SUCCESS);
}
