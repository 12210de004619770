/*
  Kernels of half-spaces of which one relaxes while its material streams through the contact, towards -x.

  A term of the creep displaces by a traction c that follows the traction p as material moves by the length l in its
  time: c - l dc/dx = p. With p linear between the centres of cells, x = dx/l, e = exp(-x), this is

      c_i = e c_(i+1) + alpha p_(i+1) + beta p_i,     alpha = (1 - e)/x - e,     beta = 1 - (1 - e)/x,

  as in steps of time in which the material moves by a cell. c does not end behind the contact, so the kernel contains
  it: a cell's displacements at the lag i are, if K are those without creep,

      beta K(i) + (alpha + e beta) S(i+1),     S(i) = K(i) + e K(i+1) + e^2 K(i+2) + ...

  S follows from high lags down. Its first one is summed over blocks of lags, each as long as its distance, in which K
  is interpolated at a few lags; the weights contain the powers of e. Material that moves towards +x has the mirror
  image of such a kernel. The sum of all is neither even nor odd in x: it is split into both.
*/
#include "streaming.h"
#include <petsam/private/base.h>
#include <math.h>
#include <string.h>

#define NODES    16      /* lags at which K is interpolated in a block: relative error 1e-12 */
#define SAMPLES  4096    /* most lags at which the sum over a block is taken: relative error 1/(24 SAMPLES^2) */
#define NEAREST  64      /* least distance of the first block, in cells */
#define BLOCKS   40      /* most of them, so that no lag is above 1e14 */
#define VANISHED (-40.0) /* logarithm of a power of e that is negligible */

void SamStreamWeights(double x, SamStreamStep *step)
{
  const double e = exp(-x), mean = x > 0 ? -expm1(-x) / x : 1;

  step->kept   = e;
  step->before = mean - e;
  step->now    = 1 - mean;
}

/* ---- the sum over high lags ---- */

/* Lags, and the weights of K at them */
typedef struct {
  PetscInt  count;
  ptrdiff_t lag[BLOCKS * NODES];
  double    weight[BLOCKS * NODES];
} Rest;

/* Adds a block of `size` lags from `first` on: weights are sums of e^s times the polynomials of Lagrange. */
static void AddBlock(double x, ptrdiff_t start, ptrdiff_t first, ptrdiff_t size, Rest *rest)
{
  const double stride = PetscMax(1.0, ceil((double)size / SAMPLES));
  double       node[NODES], scale[NODES], sum[NODES] = {0};

  for (int q = 0; q < NODES; q++) node[q] = rint(0.5 * (double)(size - 1) * (1 - cos(PETSC_PI * (q + 0.5) / NODES)));
  for (int q = 0; q < NODES; q++) {
    scale[q] = 1;
    for (int r = 0; r < NODES; r++)
      if (r != q) scale[q] *= (double)(size - 1) / (node[q] - node[r]);
  }
  for (double s = 0.5 * (stride - 1); s < (double)size; s += stride) {
    const double power = stride * exp(-x * ((double)(first - start) + s));

    for (int q = 0; q < NODES; q++) {
      double value = power * scale[q];

      for (int r = 0; r < NODES; r++)
        if (r != q) value *= (s - node[r]) / (double)(size - 1);
      sum[q] += value;
    }
  }
  for (int q = 0; q < NODES; q++) {
    rest->lag[rest->count]      = first + (ptrdiff_t)node[q];
    rest->weight[rest->count++] = sum[q];
  }
}

/* Finds the weights of S(start). */
static void FindRest(double x, ptrdiff_t start, Rest *rest)
{
  ptrdiff_t first = start;

  rest->count = 0;
  for (int block = 0; block < BLOCKS && -x * (double)(first - start) > VANISHED; block++) {
    AddBlock(x, start, first, first, rest);
    first *= 2;
  }
}

/* ---- rows ---- */

struct _n_SamStreamRows {
  const SamStream *stream;
  PetscInt         start;                  /* lags below are summed one by one */
  SamStreamStep    step[SAM_STREAM_TERMS]; /* of a cell */
  Rest             rest[SAM_STREAM_TERMS];
  double          *row, *total; /* kernel by unit constants, and the sum, at lags - start ... start */
};

PetscErrorCode SamStreamRowsCreate(const SamStream *stream, double dx, PetscInt lags, SamStreamRows *rows)
{
  SamStreamRows r;

  PetscFunctionBegin;
  PetscCall(PetscNew(&r));
  r->stream = stream;
  r->start  = lags + NEAREST;
  for (PetscInt k = 0; k < stream->terms; k++) {
    SamStreamWeights(dx / fabs(stream->length[k]), &r->step[k]);
    FindRest(dx / fabs(stream->length[k]), r->start, &r->rest[k]);
  }
  PetscCall(PetscMalloc2(2 * r->start + 1, &r->row, 2 * r->start + 1, &r->total));
  *rows = r;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStreamRowsDestroy(SamStreamRows *rows)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2((*rows)->row, (*rows)->total));
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the displacements by a term, whose kernel is in r->row: even, sign 1, or odd, sign -1. */
static void AddTerm(SamStreamRows r, PetscInt k, double sign, double sum)
{
  const SamStreamStep s    = r->step[k];
  const PetscBool     back = r->stream->length[k] < 0 ? PETSC_TRUE : PETSC_FALSE;
  const double        more = s.before + s.kept * s.now;

  for (PetscInt i = 2 * r->start - 1; i >= 0; i--) { /* `sum` is S at the lag above */
    r->total[back ? 2 * r->start - i : i] += (back ? sign : 1) * (s.now * r->row[i] + more * sum);
    sum = r->row[i] + s.kept * sum;
  }
}

void SamStreamRow(SamStreamRows r, const SamStreamKernel *kernel, PetscInt j, PetscInt n, double *const values[2])
{
  const PetscInt start  = r->start;
  double *const  middle = r->row + start;
  const double   sign   = kernel->odd ? -1 : 1;

  memset(r->total, 0, sizeof(*r->total) * (size_t)(2 * start + 1));
  for (PetscInt k = -1; k < r->stream->terms; k++) {
    const double *constants = k < 0 ? r->stream->sudden : r->stream->value[k];
    double        sum       = 0;

    kernel->row(kernel->context, constants, j, start, middle);
    if (kernel->odd) middle[0] = 0;
    for (PetscInt i = 1; i < start; i++) middle[-i] = sign * middle[i];
    if (k < 0) {
      memcpy(r->total + 1, r->row + 1, sizeof(*r->total) * (size_t)(2 * start - 1));
      continue;
    }
    for (PetscInt q = 0; q < r->rest[k].count; q++)
      sum += r->rest[k].weight[q] * kernel->cell(kernel->context, constants, r->rest[k].lag[q], j);
    middle[-start] = 0;
    AddTerm(r, k, sign, sum);
  }
  for (PetscInt i = 0; i < n; i++) {
    const double ahead = r->total[start + i], behind = r->total[start - i];

    values[0][i] = 0.5 * (ahead + sign * behind);
    values[1][i] = 0.5 * (ahead - sign * behind);
  }
}
