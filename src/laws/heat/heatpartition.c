/*
  Partition of the heat of a contact between two bodies.

  Problem: (K1 + K2 + r) q2 = T1_bulk - T2_bulk + K1 Q in cells in contact, q2 = 0 elsewhere (heat.h). The operator is
  positive, as Re 1/kappa > 0 below, but not symmetric if a body moves.

  Algorithm: generalised conjugate residuals (heatsteps.c). The preconditioner is the inverse of the symbol of K1 + K2 +
  r, cut off outside of contact: a wave of flux with the wave numbers kx, ky has the temperature
      1/(conductivity kappa),   kappa^2 = k^2 + i kx speed/D,   Re kappa > 0,
  times itself; for the mean k is half the smallest wave number. It acts on the padded grid, as the trail of a fast body
  is long: on the periodic one up to twice as many products are needed. At the end the
  true residual is computed; above the tolerance, the steps go on from it, as long as that halves it.

  Reference: Bos and Moes 1995, J. Tribol. 117, 171.
*/
#include "heatimpl.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <math.h>

#define GOAL 0.7 /* part of the tolerance at which the steps end, as the true residual is a little larger */

/* The symbol of the preconditioner. Wave numbers are times the grid's length, of which symbols are multiples. */
typedef struct {
  double step[2], mean; /* smallest wave number along x, y; k of the mean */
  double drift[2];      /* of each body: speed/D */
  double factor[2];     /* of each body: 1/(conductivity * conductivity of the pair) */
  double resistance;
  double gain; /* of the transforms */
} Symbol;

typedef struct {
  const SamHeatPair *pair;
  SamGrid            grid;
  const double      *contact;
  double             scale; /* of temperature over flux, which makes residuals dimensionless, K m2/W */
  Symbol             symbol;
  float             *work; /* a field */
} Split;

/* ---- the preconditioner ---- */

static void SetSymbol(Split *s)
{
  const SamGrid grid = s->grid;
  Symbol       *y    = &s->symbol;
  PetscInt      h[2];

  (void)SamFourierGetPeriods(s->pair->body[0]->fourier, &h[0], &h[1]);
  y->step[0] = PETSC_PI / (double)h[0] * grid->length / grid->dx;
  y->step[1] = SamGridIsRow(grid) ? y->step[0] : PETSC_PI / (double)h[1] * grid->length / grid->dy;
  y->mean    = 0.5 * PetscMin(y->step[0], y->step[1]);
  y->gain    = 1 / (2 * (double)h[0] * (SamGridIsRow(grid) ? 1 : 2 * (double)h[1]));
  for (PetscInt b = 0; b < 2; b++) {
    const SamHeatBody *body = &s->pair->body[b]->body;

    y->drift[b]  = body->speed / body->conductivity * body->capacity * grid->length;
    y->factor[b] = grid->length / body->conductivity / s->scale;
  }
  y->resistance = s->pair->resistance / s->scale;
}

/* Divides n waves with the wave numbers kx and from ky on, in steps of `step`, by the symbol. `turn`: 0 for the wave of
   two cells' length along x, which has no phase. */
SAM_VECTORIZED static void Divide(const Symbol *s, PetscInt n, double kx, double ky, double step, double turn,
                                  float (*restrict z)[2])
{
  const float x = (float)kx, least = (float)(s->mean * s->mean), r = (float)s->resistance, gain = (float)s->gain;
  const float drift[2]  = {(float)(turn * kx * s->drift[0]), (float)(turn * kx * s->drift[1])};
  const float factor[2] = {(float)s->factor[0], (float)s->factor[1]}, first = (float)ky, by = (float)step;

#pragma omp simd
  for (PetscInt m = 0; m < n; m++) {
    const float y = first + by * (float)m, some = x * x + y * y, k2 = some > least ? some : least;
    const float a0 = sqrtf(0.5f * (k2 + sqrtf(k2 * k2 + drift[0] * drift[0]))), b0 = 0.5f * drift[0] / a0;
    const float a1 = sqrtf(0.5f * (k2 + sqrtf(k2 * k2 + drift[1] * drift[1]))), b1 = 0.5f * drift[1] / a1;
    const float c0 = factor[0] / (a0 * a0 + b0 * b0), c1 = factor[1] / (a1 * a1 + b1 * b1);
    const float re = c0 * a0 + c1 * a1 + r, im = -c0 * b0 - c1 * b1, g = gain / (re * re + im * im);
    const float z0 = z[m][0], z1 = z[m][1];

    z[m][0] = g * (re * z0 + im * z1);
    z[m][1] = g * (re * z1 - im * z0);
  }
}

/* Filters the columns of a block: the waves of a single row run along x, one in each column. */
static void Filter(const SamFourierBlock *block, const void *context)
{
  const Symbol  *s    = (const Symbol *)context;
  const PetscInt last = block->phases * block->hx, rest = block->hy / 2;

  for (PetscInt f = 0; f < block->phases; f++)
    for (PetscInt b = 0; b < block->columns; b++) {
      const PetscInt i = block->first + b, up = block->hy - rest;
      const double   kx = s->step[0] * (double)i, first = s->step[1] * (double)f, step = s->step[1] * block->phases,
                   turn = 2 * i == (block->stride == 1 ? 2 : 1) * last ? 0 : 1;
      float(*column)[2] = block->single[0] + (f * block->width + b) * (ptrdiff_t)block->stride;

      Divide(s, up, kx, first, step, turn, column);
      Divide(s, rest, kx, first - step * (double)rest, step, turn, column + up);
    }
}

/* Computes z = M r in cells in contact. */
static PetscErrorCode Precondition(void *context, const double r[], double size, double z[])
{
  const Split           *s      = (const Split *)context;
  const SamFourierFilter filter = {SAM_FOURIER_PADDED, 1, 1, Filter, &s->symbol};
  const float           *in     = s->work;
  float                 *out    = s->work;

  PetscFunctionBegin;
  for (PetscInt m = 0; m < s->grid->cells; m++) s->work[m] = (float)(r[m] / size);
  PetscCall(SamFourierApplySingle(s->pair->body[0]->fourier, &filter, &in, &out));
  for (PetscInt m = 0; m < s->grid->cells; m++) z[m] = s->contact[m] > 0 ? (double)s->work[m] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

/* Computes u = (K1 + K2 + r) q / scale in cells in contact, 0 elsewhere. */
static PetscErrorCode Multiply(void *context, const double q[], double u[])
{
  const Split       *s    = (const Split *)context;
  const SamHeatPair *pair = s->pair;
  SamKernel          kernels[4];
  PetscInt           n = 0;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++)
    for (PetscInt k = 0; k < pair->body[b]->kernels; k++) kernels[n++] = pair->body[b]->kernel[k];
  PetscCall(SamConvolveSum(pair->body[0]->fourier, n, kernels, q, u));
  for (PetscInt m = 0; m < s->grid->cells; m++)
    u[m] = s->contact[m] > 0 ? (u[m] + pair->resistance * q[m]) / s->scale : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the solve ---- */

/* Computes the true residual r = b - A x and its norm. */
static PetscErrorCode FindResidual(SamHeatSystem *system, const double b[], const double x[], double r[], double *norm)
{
  PetscFunctionBegin;
  PetscCall(Multiply(system->context, x, r));
  system->products++;
  for (PetscInt m = 0; m < system->grid->cells; m++) r[m] = b[m] - r[m];
  PetscCall(SamHeatNorm(system->grid, r, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves from x = 0 on. On entry r is the right side; it is scratch afterwards. */
static PetscErrorCode Solve(Split *s, double x[], double r[], SamHeatReport *report)
{
  const PetscInt n      = s->grid->cells;
  const double   rtol   = (double)s->pair->rtol;
  SamHeatSystem  system = {
     .grid = s->grid, .context = s, .multiply = Multiply, .precondition = Precondition, .most = s->pair->most};
  double *b, norm, left, last = PETSC_INFINITY;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &b));
  PetscCall(PetscArraycpy(b, r, n));
  PetscCall(PetscArrayzero(x, n));
  PetscCall(SamHeatNorm(s->grid, b, &norm));
  left = norm;
  while (left > rtol * norm && left <= 0.5 * last && system.products < system.most) {
    last = left;
    PetscCall(SamHeatReduce(&system, GOAL * rtol * norm, x, r, &left));
    PetscCall(FindResidual(&system, b, x, r, &left));
  }
  report->products = system.products;
  report->residual = norm == 0 ? 0 : left / norm;
  if (report->residual <= rtol)
    report->reason = SAM_HEAT_CONVERGED;
  else
    report->reason = system.products >= system.most ? SAM_HEAT_LIMIT : SAM_HEAT_STAGNATES;
  PetscCall(PetscFree(b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the right side ---- */

static PetscErrorCode CheckPair(const SamHeatPair *pair, Vec contact, Vec heat, Vec heat_2)
{
  const SamGrid grid = pair->body[0]->grid;

  PetscFunctionBegin;
  PetscCheck(grid == pair->body[1]->grid, grid->comm, PETSC_ERR_ARG_WRONG,
             "Operators of heat on different grids: expected one grid");
  PetscCheck(pair->body[0]->depth == 0 && pair->body[1]->depth == 0, grid->comm, PETSC_ERR_ARG_WRONG,
             "Operators of heat at the depths %.6g, %.6g m: expected 0", (double)pair->body[0]->depth,
             (double)pair->body[1]->depth);
  PetscCheck(pair->resistance >= 0 && isfinite(pair->resistance), grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Resistance %.6g m2 K/W: expected a number from 0 on", (double)pair->resistance);
  PetscCheck(pair->rtol > 0 && pair->most > 0, grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Tolerance %.6g, %" PetscInt_FMT " operator applications: expected numbers above 0", (double)pair->rtol,
             pair->most);
  PetscCall(SamGridCheckVec(grid, 1, contact, "Contact"));
  PetscCall(SamGridCheckVec(grid, 1, heat, "Heat"));
  PetscCall(SamGridCheckVec(grid, 1, heat_2, "Heat into body 2"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses heat outside of contact. */
static PetscErrorCode CheckHeat(SamGrid grid, const double contact[], const double heat[])
{
  double outside = 0;

  PetscFunctionBegin;
  for (PetscInt m = 0; m < grid->cells; m++)
    if (!(contact[m] > 0) && heat[m] != 0) outside = 1;
  PetscCall(SamMax(grid->comm, 1, &outside));
  PetscCheck(outside == 0, grid->comm, PETSC_ERR_ARG_WRONG, "Heat outside of contact: expected 0 there");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if half of the heat goes into each body. */
static PetscBool IsEqual(const SamHeatPair *pair, const PetscReal bulk[2])
{
  const SamHeatBody *one = &pair->body[0]->body, *other = &pair->body[1]->body;

  if (one->conductivity != other->conductivity || one->capacity != other->capacity) return PETSC_FALSE;
  return one->speed == other->speed && bulk[0] == bulk[1] && pair->resistance == 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* Computes the right side T1_bulk - T2_bulk + K1 Q over the scale, in cells in contact. */
static PetscErrorCode RightSide(const Split *s, const double heat[], double difference, double b[])
{
  const SamConductor one = s->pair->body[0];

  PetscFunctionBegin;
  PetscCall(SamConvolveSum(one->fourier, one->kernels, one->kernel, heat, b));
  for (PetscInt m = 0; m < s->grid->cells; m++) b[m] = s->contact[m] > 0 ? (difference + b[m]) / s->scale : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveArrays(const SamHeatPair *pair, const double contact[], const double heat[],
                                  const PetscReal bulk[2], double heat_2[], SamHeatReport *report)
{
  const SamGrid grid = pair->body[0]->grid;
  Split         s    = {.pair = pair, .grid = grid, .contact = contact};
  double       *b;

  PetscFunctionBegin;
  s.scale = grid->length * (1 / pair->body[0]->body.conductivity + 1 / pair->body[1]->body.conductivity);
  SetSymbol(&s);
  PetscCall(PetscMalloc2(grid->cells, &b, grid->cells, &s.work));
  PetscCall(RightSide(&s, heat, bulk[0] - bulk[1], b));
  PetscCall(Solve(&s, heat_2, b, report));
  PetscCall(PetscFree2(b, s.work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatSplit(const SamHeatPair *pair, Vec contact, Vec heat, const PetscReal bulk[2], Vec heat_2,
                            SamHeatReport *report)
{
  const double *in, *from;
  double       *to;

  PetscFunctionBegin;
  PetscCall(CheckPair(pair, contact, heat, heat_2));
  *report = (SamHeatReport){.reason = SAM_HEAT_CONVERGED};
  PetscCall(VecGetArrayRead(contact, &in));
  PetscCall(VecGetArrayRead(heat, &from));
  PetscCall(CheckHeat(pair->body[0]->grid, in, from));
  PetscCall(VecGetArrayWrite(heat_2, &to));
  if (IsEqual(pair, bulk))
    for (PetscInt m = 0; m < pair->body[0]->grid->cells; m++) to[m] = 0.5 * from[m];
  else
    PetscCall(SolveArrays(pair, in, from, bulk, to, report));
  PetscCall(VecRestoreArrayWrite(heat_2, &to));
  PetscCall(VecRestoreArrayRead(heat, &from));
  PetscCall(VecRestoreArrayRead(contact, &in));
  PetscFunctionReturn(PETSC_SUCCESS);
}
