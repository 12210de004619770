/*
  Two half-spaces. Tractions are constant on each cell, kernels are the closed forms for a rectangle (cellintegrals.c),
  and products are convolutions without periodic images (fourier/kernel.c). Source: Liu, Wang and Liu 2000, Wear 243,
  101-111. On layered bodies the closed forms are those of the materials at the surfaces, to which the rest is added
  (layered/cells.c). Where material that creeps streams through the contact, kernels have no parity in x (streaming.c).
  The preconditioner is the inverse of their symbols (inverse.c).

  In plane strain the grid is one row and the kernels are those of line loads, integrated over a cell (PlaneIntegral):
  -2 A ln(|x|/D) for u_z from p and u_x from q_x, -2 (A + B) ln(|x|/D) for u_y from q_y, pi coupling sgn(x) for u_x from
  p. They are the integrals of the kernels below over all y, except that displacements are relative to a point at the
  distance D. Waves have the same symbols. Source: Johnson 1985, Contact Mechanics, sections 2.2 and 2.3.
*/
#include "../layered/layeredwaves.h"
#include "inverse.h"
#include "streaming.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/fourier.h>
#include <petsam/private/halfspace.h>
#include <petsam/private/body.h>
#include <math.h>

/* Kernels: row and column of the 3 x 3 operator, whose lower triangle follows by symmetry. */
typedef enum { ZZ, XX, YY, XY, XZ, YZ, KERNELS } Kind;

/* The parts of a kernel of material that streams: of the parity in x of one without creep, and of the other one */
enum { USUAL, OTHER, PARTS };

typedef struct {
  SamKernel  kernel[KERNELS][PARTS]; /* NULL until needed */
  SamLayered layers;                 /* NULL: none */
  SamStream *stream;                 /* NULL: no material that creeps streams */
  PetscReal  datum;                  /* D in plane strain, m; 0: in three dimensions */
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

/* Returns the coefficients for a pair of these constants. */
static Coefficients GetCoefficientsOf(SamElasticity e, Kind kind, const double constants[SAM_PAIR_CONSTANTS])
{
  static const SamIntegral integrals[][2] = {{SAM_INTEGRAL_R},
                                             {SAM_INTEGRAL_R, SAM_INTEGRAL_XX},
                                             {SAM_INTEGRAL_R, SAM_INTEGRAL_YY},
                                             {SAM_INTEGRAL_XY},
                                             {SAM_INTEGRAL_X},
                                             {SAM_INTEGRAL_Y}};
  const double             a = constants[0], b = constants[1], d = constants[2];
  const double             factors[][2] = {{a}, {a, b}, {a, b}, {b}, {d}, {d}};

  return (Coefficients){.dx       = e->grid->dx,
                        .dy       = e->grid->dy,
                        .integral = {integrals[kind][0], integrals[kind][1]},
                        .factor   = {factors[kind][0], factors[kind][1]},
                        .kind     = kind,
                        .layers   = ((const HalfSpace *)e->data)->layers,
                        .datum    = (double)((const HalfSpace *)e->data)->datum};
}

static Coefficients GetCoefficients(SamElasticity e, Kind kind)
{
  double constants[SAM_PAIR_CONSTANTS];

  SamPairGetValues(e->pair, constants);
  return GetCoefficientsOf(e, kind, constants);
}

/*
  Returns the integral of ln(|x|/D) over the cell at the lag i >= 0, m; at lags where the closed form L(i + 1/2) - L(i -
  1/2) cancels, by powers of the inverse lag.
*/
static double PlaneIntegral(double dx, double datum, ptrdiff_t i)
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

/* Returns the kernel of half-spaces of one material in plane strain at a lag. */
static double PlaneCell(const Coefficients *c, ptrdiff_t i)
{
  if (c->kind == XZ) return PETSC_PI * c->factor[0] * c->dx;
  return -2 * (c->factor[0] + (c->kind == YY ? c->factor[1] : 0)) * PlaneIntegral(c->dx, c->datum, i);
}

static void PlaneRow(const Coefficients *c, PetscInt j, PetscInt n, double values[])
{
  static const SamWaveSymbol symbols[] = {
    [ZZ] = SAM_WAVE_ZZ, [XX] = SAM_WAVE_RR, [YY] = SAM_WAVE_TT, [XZ] = SAM_WAVE_ZR};

  for (PetscInt i = 0; i < n; i++) values[i] = j ? 0 : PlaneCell(c, i);
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

/* Returns a kernel of half-spaces of one material at a lag. */
static double Cell(const Coefficients *c, ptrdiff_t i, PetscInt j)
{
  double v;

  if (c->datum > 0) return j ? 0 : PlaneCell(c, i);
  v = c->factor[0] * SamIntegralCell(c->integral[0], c->dx, c->dy, i, j);
  if (c->factor[1] != 0) v += c->factor[1] * SamIntegralCell(c->integral[1], c->dx, c->dy, i, j);
  return v;
}

/* Returns the influence of a cell on itself, m/Pa. */
static double SelfInfluence(SamElasticity e, Kind kind)
{
  const Coefficients c = GetCoefficients(e, kind);
  double             v = Cell(&c, 0, 0);

  if (c.layers && c.datum > 0) PlaneRow(&c, 0, 1, &v);
  if (c.layers && c.datum == 0) SamLayeredAddRow(c.layers, (SamIntegral)kind, c.dx, c.dy, 0, 1, &v);
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

/* ---- kernels ---- */

/* A kernel of material that streams */
typedef struct {
  SamElasticity elasticity;
  Kind          kind;
  PetscBool     odd;
  SamStreamRows rows;
} Streaming;

static void StreamingRow(const void *context, const double constants[], PetscInt j, PetscInt n, double values[])
{
  const Streaming   *s = (const Streaming *)context;
  const Coefficients c = GetCoefficientsOf(s->elasticity, s->kind, constants);

  CoefficientRow(j, n, &values, &c);
}

static double StreamingCell(const void *context, const double constants[], ptrdiff_t i, PetscInt j)
{
  const Streaming   *s = (const Streaming *)context;
  const Coefficients c = GetCoefficientsOf(s->elasticity, s->kind, constants);

  return Cell(&c, i, j);
}

static void StreamRow(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  const Streaming      *s      = (const Streaming *)context;
  const SamStreamKernel kernel = {s->odd, StreamingRow, StreamingCell, context};

  SamStreamRow(s->rows, &kernel, j, n, values);
}

static PetscErrorCode GetKernel(SamElasticity e, Kind kind, int part, SamKernel *kernel)
{
  const HalfSpace *data     = (const HalfSpace *)e->data;
  SamKernel       *kept     = ((HalfSpace *)e->data)->kernel[kind];
  const PetscBool  odd_x    = kind == XY || kind == XZ ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool  odd_y    = kind == XY || kind == YZ ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool  odd[][2] = {{odd_x, odd_y}, {odd_x ? PETSC_FALSE : PETSC_TRUE, odd_y}};

  PetscFunctionBegin;
  if (!kept[part] && data->stream) {
    Streaming s = {e, kind, odd_x, NULL};
    PetscInt  hx, hy;

    PetscCall(SamFourierGetPeriods(e->fourier, &hx, &hy));
    PetscCall(SamStreamRowsCreate(data->stream, (double)e->grid->dx, hx + 1, &s.rows));
    PetscCall(SamKernelsCreate(e->fourier, PARTS, odd, StreamRow, &s, kept));
    PetscCall(SamStreamRowsDestroy(&s.rows));
  } else if (!kept[part]) {
    const Coefficients c = GetCoefficients(e, kind);

    PetscCall(PrepareLayers(e));
    PetscCall(SamKernelsCreate(e->fourier, 1, odd, CoefficientRow, &c, kept));
  }
  *kernel = kept[part];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

/* Fills the matrix of `scale` times a part of these kernels, row by row. */
static PetscErrorCode GetMatrix(SamElasticity e, PetscInt n_out, PetscInt n_in, double scale, const Kind kinds[],
                                int part, SamKernelMatrix *matrix)
{
  PetscFunctionBegin;
  *matrix = (SamKernelMatrix){.n_in = n_in, .n_out = n_out};
  for (PetscInt o = 0; o < n_out; o++)
    for (PetscInt i = 0; i < n_in; i++) {
      matrix->scale[o][i] = scale;
      PetscCall(GetKernel(e, kinds[o * n_in + i], part, &matrix->kernel[o][i]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Applies a part of the kernels; in plane strain output c depends on input c only, and is 0 without it. */
static PetscErrorCode ApplyPart(SamElasticity e, PetscInt n_out, PetscInt n_in, double scale, const Kind kinds[],
                                int part, const double *const in[], double *const out[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  if (!e->traits.plane) {
    PetscCall(GetMatrix(e, n_out, n_in, scale, kinds, part, &matrix));
    PetscCall(SamConvolve(e->fourier, &matrix, in, out));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt c = 0; c < n_out; c++) {
    if (c < n_in) PetscCall(GetMatrix(e, 1, 1, scale, &kinds[c * n_in + c], part, &matrix));
    if (c < n_in) PetscCall(SamConvolve(e->fourier, &matrix, &in[c], &out[c]));
    if (c >= n_in) PetscCall(PetscArrayzero(out[c], e->grid->cells));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Apply(SamElasticity e, PetscInt n_out, PetscInt n_in, double scale, const Kind kinds[],
                            const double *const in[], double *const out[])
{
  const PetscInt n = e->grid->cells;
  double        *other[2];

  PetscFunctionBegin;
  if (!((const HalfSpace *)e->data)->stream)
    PetscFunctionReturn(ApplyPart(e, n_out, n_in, scale, kinds, USUAL, in, out));
  PetscCall(PetscMalloc2(n, &other[0], n, &other[1]));
  PetscCall(
    ApplyPart(e, n_out, n_in, scale, kinds, OTHER, in, other)); /* before `out`, which may be `in`, is written */
  PetscCall(ApplyPart(e, n_out, n_in, scale, kinds, USUAL, in, out));
  for (PetscInt c = 0; c < n_out; c++)
    for (PetscInt k = 0; k < n; k++) out[c][k] += other[c][k];
  PetscCall(PetscFree2(other[0], other[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Applies the kernels of material that streams, which have no parity, to fields in single precision. */
static PetscErrorCode ApplyStreamSingle(SamElasticity e, PetscInt n, const Kind kinds[], double factor,
                                        const float *const in[], float *const out[])
{
  const PetscInt cells = e->grid->cells;
  double        *u[2];

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(cells, &u[0], cells, &u[1]));
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt k = 0; k < cells; k++) u[c][k] = (double)in[c][k];
  PetscCall(Apply(e, n, n, 1, kinds, (const double *const *)u, u));
  for (PetscInt c = 0; c < n; c++)
    for (PetscInt k = 0; k < cells; k++) out[c][k] = (float)(factor * u[c][k]);
  PetscCall(PetscFree2(u[0], u[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplySingle(SamElasticity e, PetscInt n, const Kind kinds[], double factor,
                                  const float *const in[], float *const out[])
{
  SamKernelMatrix matrix;

  PetscFunctionBegin;
  if (((const HalfSpace *)e->data)->stream) PetscFunctionReturn(ApplyStreamSingle(e, n, kinds, factor, in, out));
  for (PetscInt c = 0; c < n && e->traits.plane; c++) {
    PetscCall(GetMatrix(e, 1, 1, 1, &kinds[c * n + c], USUAL, &matrix));
    PetscCall(SamConvolveSingle(e->fourier, &matrix, factor, &in[c], &out[c]));
  }
  if (e->traits.plane) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GetMatrix(e, n, n, 1, kinds, USUAL, &matrix));
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

/* ---- the type ---- */

static PetscErrorCode SetStream(SamElasticity e, const SamStream *stream)
{
  return SamElasticityKeepStream(e, stream, &((HalfSpace *)e->data)->stream);
}

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  const HalfSpace *from = (const HalfSpace *)parent->data;

  PetscFunctionBegin;
  ((HalfSpace *)child->data)->datum = from->datum;
  if (from->stream) PetscCall(SetStream(child, from->stream));
  PetscCall(SamLayeredReference(from->layers, &((HalfSpace *)child->data)->layers));
  PetscFunctionReturn(PETSC_SUCCESS);
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
  for (PetscInt k = 0; k < KERNELS * PARTS; k++) PetscCall(SamKernelDestroy(&data->kernel[k / PARTS][k % PARTS]));
  PetscCall(PetscFree(data->stream));
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
                                 .preconditionnormal      = SamHalfSpacePreconditionNormal,
                                 .preconditionsliding     = SamHalfSpacePreconditionSliding,
                                 .preconditiontangential  = SamHalfSpacePreconditionTangential,
                                 .preconditionslip        = data->layers ? NULL : SamHalfSpacePreconditionSlip,
                                 .getselfinfluence        = GetSelfInfluence,
                                 .createstress            = CreateStress,
                                 .applynormaltotangential = ApplyNormalToTangential,
                                 .applytangentialtonormal = ApplyTangentialToNormal,
                                 .setstream               = SetStream};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal *SamHalfSpaceDatum(SamElasticity e)
{
  return &((HalfSpace *)e->data)->datum;
}

SamLayered SamHalfSpaceLayers(SamElasticity e)
{
  return ((const HalfSpace *)e->data)->layers;
}
