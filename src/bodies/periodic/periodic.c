/*
  Two periodic half-spaces; the grid is one period. Every field is a sum of waves exp(i k.x), and the operator acts on
  each wave separately. The transforms of the influence of a unit force (bodyimpl.h) over the infinite surface are its
  symbols:
    u_z from p:  2 pi A/|k|                                 A = pair->normal
    u_t from q:  (2 pi (A + B)/|k|)(I - nu kk'/|k|^2)       B = pair->shear_xx, nu = B/(A + B)
    u_t from p:  -2 pi i coupling k/|k|^2
    u_z from q:  +2 pi i coupling k'/|k|^2
  by the transforms of 1/r, 2 pi/|k|, of x_a x_b/r^3, (2 pi/|k|)(delta_ab - k_a k_b/|k|^2), and of x/r^2,
  -2 pi i k/|k|^2.

  The mean, k = 0: a uniform traction would displace the surface without bound, so displacements are measured from the
  mean planes, and the symbols are 0. On grids of an even number of cells the wave of two cells' length is its own
  mirror image; there a symbol that is odd in its wave number, which would be the mean of both, is 0.

  Material that creeps while it streams, by the length l towards -x in the time of a term, is displaced by the term as
  by a traction c that follows p, c - l dc/dx = p. So 1/(1 - i k_x l) times what it adds to A is added, exactly.

  Source of the normal symbol: Westergaard 1939, J. Appl. Mech. 6, A49-A53; Stanley and Kato 1997, J. Tribol. 119,
  481-485.
*/
#include "../layered/layeredwaves.h"
#include <math.h>

typedef struct {
  double     normal, tangential; /* the self-influence of a cell, m/Pa */
  SamLayered layers;             /* its symbols replace 2 pi A and so on; NULL: none */
  SamStream *stream;             /* NULL: no material that creeps streams */
} Periodic;

#define Real    double
#define Root(x) sqrt(x)
#define Name(x) x##Double
#include "symbols.h"
#undef Real
#undef Root
#undef Name
#define Real    float
#define Root(x) sqrtf(x)
#define Name(x) x##Single
#include "symbols.h"
#include <petsam/private/fourier.h>
#include <petsam/private/body.h>

/* Returns 1 if the wave number of index k is its own mirror image (the Nyquist wave), else 0. */
static inline double IsOwnMirror(PetscInt k, PetscInt n)
{
  return 2 * k == n ? 1 : 0;
}

/* ---- coupling ---- */

/* Returns a symbol of layered bodies. */
static double SymbolAt(const SamSymbol *s, SamWaveSymbol symbol, double k2)
{
  const double argument = k2 * s->unit;
  double       value;

  SamSplineRow(s->table, symbol, 1, &argument, &value);
  return value;
}

/* Computes gain k/|k|^2 at entry m of column b: odd in k, so 0 for waves that are their own mirror images, and for the
   mean. */
static void CouplingAt(const SamSymbol *s, const SamFourierBlock *block, PetscInt b, PetscInt m, double g[2])
{
  const double kx = s->step[0] * (double)(block->first + b),
               ky = s->step[1] * (double)(2 * m <= block->hy ? m : m - block->hy), k2 = kx * kx + ky * ky;
  double gain = s->gain;

  if (s->table) gain *= SymbolAt(s, SAM_WAVE_ZR, k2);
  g[0] = k2 > 0 ? gain * kx / k2 * (1 - IsOwnMirror(block->first + b, block->hx)) : 0;
  g[1] = k2 > 0 ? gain * ky / k2 * (1 - IsOwnMirror(m, block->hy)) : 0;
}

/* Computes u_t = -i g p. */
static void FilterNormalToTangential(const SamFourierBlock *block, const void *context)
{
  for (PetscInt b = 0; b < block->columns; b++)
    for (PetscInt m = 0; m < block->hy; m++) {
      const ptrdiff_t k    = (ptrdiff_t)b * block->stride + m;
      const double    p[2] = {block->data[0][k][0], block->data[0][k][1]};
      double          g[2];

      CouplingAt((const SamSymbol *)context, block, b, m, g);
      for (PetscInt c = 0; c < 2; c++) {
        block->data[c][k][0] = g[c] * p[1];
        block->data[c][k][1] = -g[c] * p[0];
      }
    }
}

/* Computes u_z = i g.q. */
static void FilterTangentialToNormal(const SamFourierBlock *block, const void *context)
{
  for (PetscInt b = 0; b < block->columns; b++)
    for (PetscInt m = 0; m < block->hy; m++) {
      const ptrdiff_t k = (ptrdiff_t)b * block->stride + m;
      double          g[2], re, im;

      CouplingAt((const SamSymbol *)context, block, b, m, g);
      re = g[0] * block->data[0][k][0] + g[1] * block->data[1][k][0];
      im = g[0] * block->data[0][k][1] + g[1] * block->data[1][k][1];

      block->data[0][k][0] = -im;
      block->data[0][k][1] = re;
    }
}

/* ---- material that streams, and slopes ---- */

/* The normal symbol of material that streams, or without a stream that of the slope along x */
typedef struct {
  const SamSymbol *symbol;
  const SamStream *stream; /* NULL: the slope */
  double           length; /* unit of the wave numbers, m */
} AlongX;

/* Returns the factor of column b of a block: of the creep, or of the slope. */
static void FactorOf(const AlongX *a, const SamFourierBlock *block, PetscInt b, double factor[2])
{
  const double     k = a->symbol->step[0] * (double)(block->first + b);
  const SamStream *s = a->stream;

  factor[0] = s ? 1 : 0;
  factor[1] = s ? 0 : k;
  for (PetscInt j = 0; s && j < s->terms; j++) {
    const double x = k * s->length[j] / a->length, part = s->value[j][0] / s->sudden[0] / (1 + x * x);

    factor[0] += part;
    factor[1] += part * x;
  }
}

static void FilterAlongX(const SamFourierBlock *block, const void *context)
{
  const AlongX    *a = (const AlongX *)context;
  const SamSymbol *s = a->symbol;

  for (PetscInt b = 0; b < block->columns; b++) {
    const double kx                   = s->step[0] * (double)(block->first + b);
    double(*const restrict column)[2] = block->data[0] + (ptrdiff_t)b * block->stride;
    double factor[2];

    FactorOf(a, block, b, factor);
    for (PetscInt m = 0; m < block->hy; m++) {
      const double ky = s->step[1] * (double)(2 * m <= block->hy ? m : m - block->hy), k2 = kx * kx + ky * ky,
                   gain = a->stream ? (k2 > 0 ? s->gain / sqrt(k2) : 0) : s->gain, re = column[m][0], im = column[m][1];

      column[m][0] = gain * (factor[0] * re - factor[1] * im);
      column[m][1] = gain * (factor[0] * im + factor[1] * re);
    }
  }
}

/* ---- inverses ---- */

/* Multiplies by gain |k| times the inverse of (1 + film |k|) I - nu kk'/|k|^2, with its cross term times `cross`. */
SAM_VECTORIZED static void DivideTangential(const SamSymbol *s, SamWaves at)
{
  const float gain = (float)s->gain, nu = (float)s->nu, least = (float)(s->mean * s->mean), step = (float)s->step[1];
  const float kx = (float)at.kx, cross = (float)at.cross, film = (float)s->film;
  float(*restrict x)[2] = (float(*)[2])at.x, (*restrict y)[2] = (float(*)[2])at.y;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const float ky = step * (float)(m - at.origin), k2 = kx * kx + ky * ky, some = k2 > least ? k2 : least;
    const float k = sqrtf(some), own = 1 + film * k;
    const float a = own - nu * kx * kx / some, b = -cross * nu * kx * ky / some, d = own - nu * ky * ky / some;
    const float g  = gain * k / (a * d - b * b);
    const float x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = g * (d * x0 - b * y0);
    x[m][1] = g * (d * x1 - b * y1);
    y[m][0] = g * (a * y0 - b * x0);
    y[m][1] = g * (a * y1 - b * x1);
  }
}

/* ---- methods ---- */

typedef void (*Product)(const SamSymbol *symbol, SamWaves waves);

static SamLayered LayersOf(SamElasticity e)
{
  return ((const Periodic *)e->data)->layers;
}

/* Describes the symbol factor * amplitude * (a function of k of degree -1). */
static SamSymbol SymbolOf(SamElasticity e, double factor, double amplitude, Product multiply)
{
  const SamGrid grid = e->grid;
  const SamPair pair = e->pair;
  SamSymbol     s    = {.nu = pair->shear_xx / (pair->shear + pair->shear_xx), .multiply = multiply};

  for (PetscInt c = 0; c < 2; c++) /* without waves along y, the step along x is used */
    s.step[c] = 2 * PETSC_PI / grid->width[PetscMin(c, grid->axes - 1)] * grid->length;
  s.mean = 0.5 * PetscMin(s.step[0], s.step[1]);
  s.gain = factor * amplitude * grid->length / ((double)grid->nx * (double)grid->ny);
  if (LayersOf(e)) PetscCallAbort(grid->comm, SamLayeredSymbolSet(LayersOf(e), grid->length, grid->nx, grid->ny, &s));
  return s;
}

/* Describes the inverse of that symbol. */
static SamSymbol InverseOf(SamElasticity e, double factor, double amplitude, Product multiply)
{
  SamSymbol s = SymbolOf(e, factor, amplitude, multiply);

  s.film    = SamPairFilm(e->pair) / (amplitude * e->grid->length);
  s.inverse = PETSC_TRUE;
  s.gain    = factor / (amplitude * e->grid->length * (double)e->grid->nx * (double)e->grid->ny);
  return s;
}

static double NormalAmplitude(SamElasticity e)
{
  return LayersOf(e) ? 1 : 2 * PETSC_PI * e->pair->normal;
}

static PetscErrorCode ApplyAlongX(SamElasticity e, const SamStream *stream, const SamSymbol *s,
                                  const double *const in[], double *const out[])
{
  const AlongX           a      = {s, stream, (double)e->grid->length};
  const SamFourierFilter filter = {SAM_FOURIER_PERIODIC, 1, 1, FilterAlongX, &a};

  return SamFourierApply(e->fourier, &filter, in, out);
}

static PetscErrorCode Slope(SamElasticity e, const double *const h[], double *const slope[])
{
  SamSymbol s = SymbolOf(e, 1, 1, NULL);

  s.gain /= (double)(e->grid->length * e->grid->length); /* that of the symbol has the unit of 1/|k| */
  return ApplyAlongX(e, NULL, &s, h, slope);
}

static double TangentialAmplitude(SamElasticity e)
{
  return LayersOf(e) ? 1 : 2 * PETSC_PI * (e->pair->shear + e->pair->shear_xx);
}

static double CouplingAmplitude(SamElasticity e)
{
  return LayersOf(e) ? 1 : 2 * PETSC_PI * e->pair->coupling;
}

static PetscErrorCode ApplyNormal(SamElasticity e, const double *const p[], double *const u_z[])
{
  const SamStream *stream = ((const Periodic *)e->data)->stream;
  const SamSymbol s = SymbolOf(e, 1, NormalAmplitude(e), LayersOf(e) ? SamLayeredMultiplyNormal : MultiplyNormalDouble);

  if (stream) return ApplyAlongX(e, stream, &s, p, u_z);
  return SamSymbolApply(e, &s, 1, p, u_z);
}

static PetscErrorCode ApplyTangential(SamElasticity e, const double *const q[], double *const u_t[])
{
  const SamSymbol s =
    SymbolOf(e, 1, TangentialAmplitude(e), LayersOf(e) ? SamLayeredMultiplyTangential : MultiplyTangentialDouble);

  return SamSymbolApply(e, &s, 2, q, u_t);
}

static PetscErrorCode ApplyNormalToTangential(SamElasticity e, const double *const p[], double *const u_t[])
{
  const SamSymbol        s      = SymbolOf(e, 1, CouplingAmplitude(e), NULL);
  const SamFourierFilter filter = {SAM_FOURIER_PERIODIC, 1, 2, FilterNormalToTangential, &s};

  return SamFourierApply(e->fourier, &filter, p, u_t);
}

static PetscErrorCode ApplyTangentialToNormal(SamElasticity e, const double *const q[], double *const u_z[])
{
  const SamSymbol        s      = SymbolOf(e, 1, CouplingAmplitude(e), NULL);
  const SamFourierFilter filter = {SAM_FOURIER_PERIODIC, 2, 1, FilterTangentialToNormal, &s};

  return SamFourierApply(e->fourier, &filter, q, u_z);
}

static PetscErrorCode ApplyNormalSingle(SamElasticity e, double factor, const float *const p[], float *const u_z[])
{
  const SamSymbol s =
    SymbolOf(e, factor, NormalAmplitude(e), LayersOf(e) ? SamLayeredMultiplyNormalSingle : MultiplyNormalSingle);

  return SamSymbolApplySingle(e, &s, 1, p, u_z);
}

static PetscErrorCode ApplyTangentialSingle(SamElasticity e, double factor, const float *const q[], float *const u_t[])
{
  const SamSymbol s = SymbolOf(e, factor, TangentialAmplitude(e),
                               LayersOf(e) ? SamLayeredMultiplyTangentialSingle : MultiplyTangentialSingle);

  return SamSymbolApplySingle(e, &s, 2, q, u_t);
}

static PetscErrorCode PreconditionNormal(SamElasticity e, double factor, const float *const r[], float *const p[])
{
  const SamSymbol s =
    InverseOf(e, factor, NormalAmplitude(e), LayersOf(e) ? SamLayeredMultiplyNormalSingle : SamSymbolDivideNormal);

  return SamSymbolApplySingle(e, &s, 1, r, p);
}

/* As for half-spaces, whose symbols these are (halfspace.c). */
static PetscErrorCode PreconditionSliding(SamElasticity e, double factor, const double slope[2], const float *const r[],
                                          float *const p[])
{
  SamSymbol s =
    InverseOf(e, factor, NormalAmplitude(e), LayersOf(e) ? SamLayeredMultiplyNormalSingle : SamSymbolDivideNormal);

  for (int c = 0; c < 2; c++) s.turn[c] = (double)e->pair->dundurs * slope[c];
  return SamSymbolApplySingle(e, &s, 1, r, p);
}

static PetscErrorCode PreconditionTangential(SamElasticity e, double factor, const float *const r[], float *const q[])
{
  const SamSymbol s =
    InverseOf(e, factor, TangentialAmplitude(e), LayersOf(e) ? SamLayeredMultiplyTangentialSingle : DivideTangential);

  return SamSymbolApplySingle(e, &s, 2, r, q);
}

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  const Periodic *data = (const Periodic *)e->data;

  PetscFunctionBegin;
  *normal     = data->normal;
  *tangential = data->tangential;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the type ---- */

/* Returns the multiplicity: waves with wave numbers of both signs count twice. */
static inline double Multiplicity(PetscInt k, PetscInt n)
{
  return k == 0 || 2 * k == n ? 1 : 2;
}

/*
  Computes sums over the waves of one ky of 1/|k|, kx^2/|k|^3 and ky^2/|k|^3; for layered bodies, of the symbols of u_z
  from p, u_x from q_x, and u_y from q_y.
*/
static void SumWaves(SamElasticity e, const SamSymbol *s, PetscInt m, double sums[3])
{
  const double ky = s->step[1] * (double)m, weight = Multiplicity(m, e->grid->ny);

  sums[0] = sums[1] = sums[2] = 0;
  for (PetscInt l = m ? 0 : 1; l <= e->grid->nx / 2; l++) {
    const double kx = s->step[0] * (double)l, k2 = kx * kx + ky * ky,
                 part = weight * Multiplicity(l, e->grid->nx) / sqrt(k2);

    if (s->table) {
      const double along = SymbolAt(s, SAM_WAVE_RR, k2), across = SymbolAt(s, SAM_WAVE_TT, k2);

      sums[0] += part * SymbolAt(s, SAM_WAVE_ZZ, k2);
      sums[1] += part * (along * kx * kx + across * ky * ky) / k2;
      sums[2] += part * (along * ky * ky + across * kx * kx) / k2;
    } else {
      sums[0] += part;
      sums[1] += part * kx * kx / k2;
      sums[2] += part * ky * ky / k2;
    }
  }
}

/*
  A unit traction on one cell alone has all waves at the same amplitude, so that a cell's influence on itself is the
  mean of the symbol over all waves.
*/
static PetscErrorCode ComputeSelfInfluence(SamElasticity e, Periodic *data)
{
  const SamSymbol s         = SymbolOf(e, 1, 1, NULL);
  SamTotal        totals[3] = {{0}};
  double          sums[3];
  PetscMPIInt     rank, ranks;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(e->grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(e->grid->comm, &ranks));
  for (PetscInt m = rank; m <= e->grid->ny / 2; m += ranks) {
    SumWaves(e, &s, m, sums);
    SamAddAll(3, totals, sums);
  }
  PetscCall(SamSumTotals(e->grid->comm, 3, totals, sums));
  data->normal     = NormalAmplitude(e) * s.gain * sums[0];
  data->tangential = TangentialAmplitude(e) * s.gain * (sums[0] - s.nu * PetscMin(sums[1], sums[2]));
  if (data->layers) data->tangential = s.gain * PetscMax(sums[1], sums[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(SamFourierCreate(e->grid, SAM_FOURIER_EXACT, &e->fft, &e->fourier));
  PetscCall(ComputeSelfInfluence(e, (Periodic *)e->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetStream(SamElasticity e, const SamStream *stream)
{
  return SamElasticityKeepStream(e, stream, &((Periodic *)e->data)->stream);
}

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  const Periodic *from = (const Periodic *)parent->data;

  PetscFunctionBegin;
  if (from->stream) PetscCall(SetStream(child, from->stream));
  PetscCall(SamLayeredReference(from->layers, &((Periodic *)child->data)->layers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamElasticity e)
{
  Periodic *data = (Periodic *)e->data;

  PetscFunctionBegin;
  PetscCall(PetscFree(data->stream));
  PetscCall(SamLayeredDestroy(&data->layers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate_PlanePeriodic(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(SamElasticityCreate_Periodic(e));
  e->traits.plane = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate_Periodic(SamElasticity e)
{
  Periodic *data;

  PetscFunctionBegin;
  PetscCall(PetscNew(&data));
  if (!SamPairIsUniform(e->pair)) PetscCall(SamLayeredCreate(e->pair, &data->layers));
  e->data   = data;
  e->traits = (SamElasticityTraits){.coupled = SamPairIsCoupled(e->pair), .periodic = PETSC_TRUE, .layers = PETSC_TRUE};
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
                                 .getselfinfluence        = GetSelfInfluence,
                                 .applynormaltotangential = ApplyNormalToTangential,
                                 .applytangentialtonormal = ApplyTangentialToNormal,
                                 .setstream               = SetStream,
                                 .slope                   = Slope};
  PetscFunctionReturn(PETSC_SUCCESS);
}
