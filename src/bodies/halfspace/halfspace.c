/*
  Two half-spaces. Tractions are constant on each cell, kernels are the closed forms for a rectangle (cellintegrals.c),
  and products are convolutions without periodic images (fourier/kernel.c). Source: Liu, Wang and Liu 2000, Wear 243,
  101-111. On layered bodies the closed forms are those of the materials at the surfaces, to which the rest is added
  (layered/cells.c); the preconditioner is the inverse of their symbols.

  In plane strain the grid is one row and the kernels are those of line loads, integrated over a cell (PlaneIntegral):
  -2 A ln(|x|/D) for u_z from p and u_x from q_x, -2 (A + B) ln(|x|/D) for u_y from q_y, pi coupling sgn(x) for u_x from
  p. They are the integrals of the kernels below over all y, except that displacements are relative to a point at the
  distance D. Waves have the same symbols. Source: Johnson 1985, Contact Mechanics, sections 2.2 and 2.3.
*/
#include "../layered/layeredwaves.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/fourier.h>
#include <petsam/private/halfspace.h>
#include <petsam/private/body.h>
#include <math.h>

/* Kernels: row and column of the 3 x 3 operator, whose lower triangle follows by symmetry. */
typedef enum { ZZ, XX, YY, XY, XZ, YZ, KERNELS } Kind;

typedef struct {
  SamKernel  kernel[KERNELS]; /* NULL until needed */
  SamLayered layers;          /* NULL: none */
  PetscReal  datum;           /* D in plane strain, m; 0: in three dimensions */
} HalfSpace;

/* A kernel is a sum of at most two integrals over the cell. */
typedef struct {
  double      dx, dy;
  SamIntegral integral[2];
  double      factor[2];
  Kind        kind;
  SamLayered  layers;
  double      datum;
} Coefficients;

static Coefficients GetCoefficients(SamElasticity e, Kind kind)
{
  static const SamIntegral integrals[][2] = {{SAM_INTEGRAL_R},
                                             {SAM_INTEGRAL_R, SAM_INTEGRAL_XX},
                                             {SAM_INTEGRAL_R, SAM_INTEGRAL_YY},
                                             {SAM_INTEGRAL_XY},
                                             {SAM_INTEGRAL_X},
                                             {SAM_INTEGRAL_Y}};
  const SamPair            p              = e->pair;
  const double             factors[][2]   = {{p->normal},   {p->shear, p->shear_xx}, {p->shear, p->shear_xx},
                                             {p->shear_xx}, {p->coupling},           {p->coupling}};

  return (Coefficients){.dx       = e->grid->dx,
                        .dy       = e->grid->dy,
                        .integral = {integrals[kind][0], integrals[kind][1]},
                        .factor   = {factors[kind][0], factors[kind][1]},
                        .kind     = kind,
                        .layers   = ((const HalfSpace *)e->data)->layers,
                        .datum    = (double)((const HalfSpace *)e->data)->datum};
}

/*
  Returns the integral of ln(|x|/D) over the cell at the lag i >= 0, m; at lags where the closed form L(i + 1/2) - L(i -
  1/2) cancels, by powers of the inverse lag.
*/
static double PlaneIntegral(double dx, double datum, PetscInt i)
{
  const double square = 4 * (double)i * (double)i;
  double       sum = 0, power = 1;

  if (!i) return dx * (log(dx / (2 * datum)) - 1);
  for (int k = 2; power > 1e-18; k += 2) {
    power /= square;
    sum += power / ((k + 1) * k);
  }
  return dx * (log((double)i * dx / datum) - sum);
}

static void PlaneRow(const Coefficients *c, PetscInt j, PetscInt n, double values[])
{
  static const SamWaveSymbol symbols[] = {
    [ZZ] = SAM_WAVE_ZZ, [XX] = SAM_WAVE_RR, [YY] = SAM_WAVE_TT, [XZ] = SAM_WAVE_ZR};
  const double more = c->kind == YY ? c->factor[1] : 0;

  for (PetscInt i = 0; i < n; i++) {
    values[i] =
      c->kind == XZ ? PETSC_PI * c->factor[0] * c->dx : -2 * (c->factor[0] + more) * PlaneIntegral(c->dx, c->datum, i);
    if (j) values[i] = 0;
  }
  if (c->layers && !j) SamLayeredAddLine(c->layers, symbols[c->kind], c->dx, c->datum, n, values);
}

static void CoefficientRow(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  enum { CHUNK = 2048 };
  const Coefficients *c = (const Coefficients *)context;
  double              more[CHUNK];

  if (c->datum > 0) {
    PlaneRow(c, j, n, values[0]);
    return;
  }
  SamIntegralRow(c->integral[0], c->dx, c->dy, j, 0, n, values[0]);
  for (PetscInt i = 0; i < n; i++) values[0][i] *= c->factor[0];
  for (PetscInt start = 0; start < n && c->factor[1] != 0; start += CHUNK) {
    const PetscInt count = PetscMin(CHUNK, n - start);

    SamIntegralRow(c->integral[1], c->dx, c->dy, j, start, count, more);
    for (PetscInt i = 0; i < count; i++) values[0][start + i] += c->factor[1] * more[i];
  }
  if (c->layers) SamLayeredAddRow(c->layers, (SamIntegral)c->kind, c->dx, c->dy, j, n, values[0]);
}

/* Creates the table for the layers' part of the kernels, for all lags. */
static PetscErrorCode PrepareLayers(SamElasticity e)
{
  const SamGrid grid = e->grid;
  SamLayered    l    = ((const HalfSpace *)e->data)->layers;

  PetscFunctionBegin;
  if (l && e->traits.plane) PetscFunctionReturn(SamLayeredPrepareLine(l, 2 * grid->width[0]));
  if (l) PetscCall(SamLayeredPrepare(l, 2 * hypot(grid->width[0], grid->width[1]), (const double[2]){0, 0}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the influence of a cell on itself, m/Pa. */
static double SelfInfluence(SamElasticity e, Kind kind)
{
  const Coefficients c = GetCoefficients(e, kind);
  double             v;

  if (c.datum > 0) {
    PlaneRow(&c, 0, 1, &v);
    return v;
  }
  v = c.factor[0] * SamIntegralCell(c.integral[0], c.dx, c.dy, 0, 0);

  if (c.factor[1] != 0) v += c.factor[1] * SamIntegralCell(c.integral[1], c.dx, c.dy, 0, 0);
  if (c.layers) SamLayeredAddRow(c.layers, (SamIntegral)kind, c.dx, c.dy, 0, 1, &v);
  return v;
}

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  PetscFunctionBegin;
  PetscCall(PrepareLayers(e));
  *normal     = SelfInfluence(e, ZZ);
  *tangential = PetscMax(SelfInfluence(e, XX), SelfInfluence(e, YY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetKernel(SamElasticity e, Kind kind, SamKernel *kernel)
{
  SamKernel *kept = &((HalfSpace *)e->data)->kernel[kind];

  PetscFunctionBegin;
  if (!*kept) {
    const Coefficients c        = GetCoefficients(e, kind);
    const PetscBool    odd[][2] = {{kind == XY || kind == XZ, kind == XY || kind == YZ}};

    PetscCall(PrepareLayers(e));
    PetscCall(SamKernelsCreate(e->fourier, 1, odd, CoefficientRow, &c, kept));
  }
  *kernel = *kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

/* Fills the matrix of `scale` times these kernels, row by row. */
static PetscErrorCode GetMatrix(SamElasticity e, PetscInt n_out, PetscInt n_in, double scale, const Kind kinds[],
                                SamKernelMatrix *matrix)
{
  PetscFunctionBegin;
  *matrix = (SamKernelMatrix){.n_in = n_in, .n_out = n_out};
  for (PetscInt o = 0; o < n_out; o++)
    for (PetscInt i = 0; i < n_in; i++) {
      matrix->scale[o][i] = scale;
      PetscCall(GetKernel(e, kinds[o * n_in + i], &matrix->kernel[o][i]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Applies the kernels in plane strain: output c depends on input c only, and is 0 without it. */
static PetscErrorCode ApplyPlane(SamElasticity e, PetscInt n_out, PetscInt n_in, double scale, const Kind kinds[],
                                 const double *const in[], double *const out[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < n_out; c++) {
    if (c < n_in) PetscCall(GetMatrix(e, 1, 1, scale, &kinds[c * n_in + c], &matrix));
    if (c < n_in) PetscCall(SamConvolve(e->fourier, &matrix, &in[c], &out[c]));
    if (c >= n_in) PetscCall(PetscArrayzero(out[c], e->grid->cells));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Apply(SamElasticity e, PetscInt n_out, PetscInt n_in, double scale, const Kind kinds[],
                            const double *const in[], double *const out[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  if (e->traits.plane) PetscFunctionReturn(ApplyPlane(e, n_out, n_in, scale, kinds, in, out));
  PetscCall(GetMatrix(e, n_out, n_in, scale, kinds, &matrix));
  PetscCall(SamConvolve(e->fourier, &matrix, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplySingle(SamElasticity e, PetscInt n, const Kind kinds[], double factor,
                                  const float *const in[], float *const out[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < n && e->traits.plane; c++) {
    PetscCall(GetMatrix(e, 1, 1, 1, &kinds[c * n + c], &matrix));
    PetscCall(SamConvolveSingle(e->fourier, &matrix, factor, &in[c], &out[c]));
  }
  if (e->traits.plane) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GetMatrix(e, n, n, 1, kinds, &matrix));
  PetscCall(SamConvolveSingle(e->fourier, &matrix, factor, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const Kind normal[] = {ZZ}, tangential[] = {XX, XY, XY, YY}, coupling[] = {XZ, YZ};

static PetscErrorCode ApplyNormal(SamElasticity e, const double *const p[], double *const u_z[])
{
  return Apply(e, 1, 1, 1, normal, p, u_z);
}

static PetscErrorCode ApplyTangential(SamElasticity e, const double *const q[], double *const u_t[])
{
  return Apply(e, 2, 2, 1, tangential, q, u_t);
}

static PetscErrorCode ApplyNormalToTangential(SamElasticity e, const double *const p[], double *const u_t[])
{
  return Apply(e, 2, 1, 1, coupling, p, u_t);
}

static PetscErrorCode ApplyTangentialToNormal(SamElasticity e, const double *const q[], double *const u_z[])
{
  return Apply(e, 1, 2, -1, coupling, q, u_z);
}

static PetscErrorCode ApplyNormalSingle(SamElasticity e, double factor, const float *const p[], float *const u_z[])
{
  return ApplySingle(e, 1, normal, factor, p, u_z);
}

static PetscErrorCode ApplyTangentialSingle(SamElasticity e, double factor, const float *const q[], float *const u_t[])
{
  return ApplySingle(e, 2, tangential, factor, q, u_t);
}

/* ---- the spectral preconditioner ---- */

/*
  On an infinite surface a wave of pressure exp(i k.x) gives the displacement 2 pi A/|k| times itself, A = pair->normal,
  so that |k| is the inverse up to a factor. For shear the symbol is (2 pi (A + B)/|k|)(I - nu kk'/|k|^2), B =
  pair->shear_xx, nu = B/(A + B), with the inverse (|k|/(2 pi (A + B)))(I + nu/(1 - nu) kk'/|k|^2). Here they act on the
  periodic grid, which costs a quarter of a padded transform and needs as few iterations. The symbol is recomputed each
  time. Single precision suffices for an approximation. `local`: A or A + B. Layered bodies take their symbols from
  tables, which contain all of the gain but the factor of the transforms.
*/
static PetscErrorCode Precondition(SamElasticity e, PetscInt n, double factor, double local, SamSymbol s,
                                   const float *const in[], float *const out[])
{
  const SamLayered layers = ((const HalfSpace *)e->data)->layers;
  PetscInt         hx, hy;

  PetscFunctionBegin;
  PetscCall(SamFourierGetPeriods(e->fourier, &hx, &hy));
  s.step[0] = 2 * PETSC_PI / (double)hx * e->grid->length / e->grid->dx;
  s.step[1] = e->traits.plane ? s.step[0] : 2 * PETSC_PI / (double)hy * e->grid->length / e->grid->dy;
  s.gain    = factor / (2 * PETSC_PI * local * (double)hx * (double)hy * e->grid->length);
  s.mean    = 0.5 * PetscMin(s.step[0], s.step[1]);
  s.film    = SamPairFilm(e->pair) / (2 * PETSC_PI * local * e->grid->length);
  if (layers) {
    PetscCall(SamLayeredSymbolSet(layers, e->grid->length, hx, hy, &s));
    s.gain     = factor / ((double)hx * (double)hy * e->grid->length);
    s.film     = SamPairFilm(e->pair) / e->grid->length;
    s.inverse  = PETSC_TRUE;
    s.multiply = n == 1 ? SamLayeredMultiplyNormalSingle : SamLayeredMultiplyTangentialSingle;
  }
  PetscCall(SamSymbolApplySingle(e, &s, n, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multiplies by B = gain |k| (I + nu kk'/|k|^2), or, with a film, by the inverse of (inverse of B, plus film). */
SAM_VECTORIZED static void DivideTangential(const SamSymbol *s, SamWaves at)
{
  const float gain = (float)s->gain, mean = (float)s->mean, extra = (float)s->nu, least = mean * mean,
              step = (float)s->step[1], kx = (float)at.kx, sign = (float)at.cross, film = (float)s->film;
  float(*restrict x)[2] = (float(*)[2])at.x, (*restrict y)[2] = (float(*)[2])at.y;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky, some = k2 > least ? k2 : least,
                k = sqrtf(some), g = gain * k / (1 + film * k);
    const float part = g * extra / some / (1 + film * k * (1 + extra)), cross = sign * part * kx * ky,
                gx = g + part * kx * kx, gy = g + part * ky * ky;
    const float x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = gx * x0 + cross * y0;
    x[m][1] = gx * x1 + cross * y1;
    y[m][0] = gy * y0 + cross * x0;
    y[m][1] = gy * y1 + cross * x1;
  }
}

/*
  In slip of rolling bodies, steadyoperator.c needs the inverse of h A + 1 - h with A = C (1 - S), where S is the shift
  by a cell along x. With M = 1/C it is the inverse of 1 - h S, which steadyoperator.c applies along each row, times
      M (1 - h S)/(h (1 - S) + (1 - h) M),
  where h = SAM_SLIP_WEIGHT everywhere. M alone would be right for the shortest waves only.
*/
SAM_VECTORIZED static void DivideSlip(const SamSymbol *s, SamWaves at)
{
  const float h = (float)SAM_SLIP_WEIGHT, c = h * (float)cos(s->lag * at.kx), i = h * (float)sin(s->lag * at.kx),
              unit = (1 - h) * (float)s->slip, mean = (float)s->mean, least = mean * mean, step = (float)s->step[1],
              kx = (float)at.kx, film = (float)s->film;
  float(*restrict x)[2] = (float(*)[2])at.x, (*restrict y)[2] = (float(*)[2])at.y;

  DivideTangential(s, at);
#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky, k = sqrtf(k2 > least ? k2 : least),
                below = h - c + unit * k / (1 + film * k), scale = 1 / (below * below + i * i),
                re = scale * ((1 - c) * below + i * i), im = scale * i * (1 - c - below);
    const float x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = re * x0 - im * x1;
    x[m][1] = im * x0 + re * x1;
    y[m][0] = re * y0 - im * y1;
    y[m][1] = im * y0 + re * y1;
  }
}

static PetscErrorCode PreconditionNormal(SamElasticity e, double factor, const float *const r[], float *const p[])
{
  return Precondition(e, 1, factor, e->pair->normal, (SamSymbol){.multiply = SamSymbolDivideNormal}, r, p);
}

/* A wave of pressure that takes the shear m with it lifts the surface by 1 + i beta m.k/|k| times as much. */
static PetscErrorCode PreconditionSliding(SamElasticity e, double factor, const double slope[2], const float *const r[],
                                          float *const p[])
{
  const double    beta = (double)e->pair->dundurs;
  const SamSymbol s    = {.turn = {beta * slope[0], beta * slope[1]}, .multiply = SamSymbolDivideNormal};

  return Precondition(e, 1, factor, e->pair->normal, s, r, p);
}

static PetscErrorCode PreconditionTangential(SamElasticity e, double factor, const float *const r[], float *const q[])
{
  const SamSymbol s = {.nu = e->pair->shear_xx / e->pair->shear, .multiply = DivideTangential};

  return Precondition(e, 2, factor, e->pair->shear + e->pair->shear_xx, s, r, q);
}

static PetscErrorCode PreconditionSlip(SamElasticity e, double factor, const float *const r[], float *const q[])
{
  const double    local = e->pair->shear + e->pair->shear_xx;
  const SamSymbol s     = {.nu       = e->pair->shear_xx / e->pair->shear,
                           .lag      = e->grid->dx / e->grid->length,
                           .slip     = factor / (2 * PETSC_PI * local * e->grid->length),
                           .multiply = DivideSlip};

  return Precondition(e, 2, factor, local, s, r, q);
}

/* ---- the type ---- */

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  ((HalfSpace *)child->data)->datum = ((const HalfSpace *)parent->data)->datum;
  return SamLayeredReference(((const HalfSpace *)parent->data)->layers, &((HalfSpace *)child->data)->layers);
}

static PetscErrorCode CreateStress(SamElasticity e, PetscInt body, const SamFourierSettings *settings,
                                   SamStress *stress)
{
  const SamBody of = e->pair->body[body - 1];

  if (of->count > 1) return SamLayeredCreateStress(e->grid, settings, body, of, stress);
  return SamHalfSpaceCreateStress(e->grid, settings, body, of->material[0].poisson, stress);
}

static PetscErrorCode SetUp(SamElasticity e)
{
  return SamFourierCreate(e->grid, SAM_FOURIER_FAST, &e->fft, &e->fourier);
}

static PetscErrorCode Destroy(SamElasticity e)
{
  HalfSpace *data = (HalfSpace *)e->data;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < KERNELS; k++) PetscCall(SamKernelDestroy(&data->kernel[k]));
  PetscCall(SamLayeredDestroy(&data->layers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate_HalfSpace(SamElasticity e)
{
  HalfSpace *data;

  PetscFunctionBegin;
  PetscCall(PetscNew(&data));
  if (!SamPairIsUniform(e->pair)) PetscCall(SamLayeredCreate(e->pair, &data->layers));
  e->data   = data;
  e->traits = (SamElasticityTraits){.coupled   = SamPairIsCoupled(e->pair),
                                    .stretch   = PETSC_TRUE,
                                    .rotations = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE},
                                    .mean      = PETSC_TRUE,
                                    .parts     = PETSC_TRUE,
                                    .layers    = PETSC_TRUE};
  e->ops    = (SamElasticityOps){.inherit                 = Inherit,
                                 .setup                   = SetUp,
                                 .destroy                 = Destroy,
                                 .applynormal             = ApplyNormal,
                                 .applytangential         = ApplyTangential,
                                 .applynormalsingle       = ApplyNormalSingle,
                                 .applytangentialsingle   = ApplyTangentialSingle,
                                 .preconditionnormal      = PreconditionNormal,
                                 .preconditionsliding     = PreconditionSliding,
                                 .preconditiontangential  = PreconditionTangential,
                                 .preconditionslip        = data->layers ? NULL : PreconditionSlip,
                                 .getselfinfluence        = GetSelfInfluence,
                                 .createstress            = CreateStress,
                                 .applynormaltotangential = ApplyNormalToTangential,
                                 .applytangentialtonormal = ApplyTangentialToNormal};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal *SamHalfSpaceDatum(SamElasticity e)
{
  return &((HalfSpace *)e->data)->datum;
}
