/*
  Complex transforms of one length in one precision, out of place. The file is included with these definitions:
    Real     double or float
    FFT(x)   fftw_x or fftwf_x
    LINE     the type SamLine...

  Long lines are transformed in four interleaved parts, each of a length at which FFTW's estimated plans are good; one
  pass, by the formulas of Cooley and Tukey for a radix of 4, combines the parts. So the input is stored in parts: its
  entry j is at LinePlace(j). Frequencies are in order.
*/
#include "fourierimpl.h"
#include <string.h>

typedef Real Complex[2];

/* Lines of at least this length are faster in four parts: up to 2.5 times at 8192 */
#define LONG_LINE 2560

static inline PetscErrorCode AllocateComplex(size_t count, Complex **pointer)
{
  PetscFunctionBegin;
  PetscCall(SamAllocate(sizeof(Complex) * count, pointer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Plans forward transforms, which keep their input, and if required backward ones, of arrays aligned like `in` and
  `out`.
*/
static inline PetscErrorCode LineCreate(ptrdiff_t n, unsigned effort, PetscBool backward, Complex *in, Complex *out,
                                        LINE *l)
{
  const PetscBool parts = effort == FFTW_ESTIMATE && n >= LONG_LINE && n % 4 == 0;
  const int       part  = (int)(parts ? n / 4 : n);

  PetscFunctionBegin;
  *l = (LINE){.n = n, .part = part, .shift = parts ? 2 : 0};
  if (parts) PetscCall(AllocateComplex((size_t)(3 * part), &l->root));
  for (ptrdiff_t q = 0; parts && q < 3; q++)
    for (ptrdiff_t k = 0; k < part; k++) {
      const ptrdiff_t turn = (q + 1) * k, acute = PetscMin(turn, n - turn);
      double          root[2];

      SamRootOfUnity(2 * acute, n, root);
      l->root[q * part + k][0] = (Real)root[0];
      l->root[q * part + k][1] = (Real)(acute < turn ? root[1] : -root[1]);
    }
  l->up = FFT(plan_many_dft)(1, &part, (int)(n / part), (FFT(complex) *)in, NULL, 1, part, (FFT(complex) *)out, NULL, 1,
                             part, FFTW_FORWARD, effort);
  PetscCall(SamFourierCheckPlan(l->up));
  if (!backward) PetscFunctionReturn(PETSC_SUCCESS);
  l->down = FFT(plan_many_dft)(1, &part, (int)(n / part), (FFT(complex) *)in, NULL, 1, part, (FFT(complex) *)out, NULL,
                               1, part, FFTW_BACKWARD, effort | FFTW_DESTROY_INPUT);
  PetscCall(SamFourierCheckPlan(l->down));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline void LineDestroy(LINE *l)
{
  if (l->up) FFT(destroy_plan)(l->up);
  if (l->down) FFT(destroy_plan)(l->down);
  SamFree(l->root);
  *l = (LINE){0};
}

static inline ptrdiff_t LineParts(const LINE *l)
{
  return (ptrdiff_t)1 << l->shift;
}

static inline ptrdiff_t LinePlace(const LINE *l, ptrdiff_t j)
{
  return (j & (LineParts(l) - 1)) * l->part + (j >> l->shift);
}

/* Returns the number of the first n entries that are in part q. */
static inline ptrdiff_t LineCount(const LINE *l, ptrdiff_t n, ptrdiff_t q)
{
  return (n - q + LineParts(l) - 1) >> l->shift;
}

/* Sets all but the first n entries to zero. */
static inline void LineClear(const LINE *l, ptrdiff_t n, Complex *x)
{
  for (ptrdiff_t q = 0; q < LineParts(l); q++) {
    const ptrdiff_t count = LineCount(l, n, q);

    (void)memset(x + q * l->part + count, 0, sizeof(Complex) * (size_t)(l->part - count));
  }
}

/* Copies the first n entries from an array in order, and back. */
static inline void LinePut(const LINE *l, ptrdiff_t n, const Complex *restrict from, Complex *restrict x)
{
  if (!l->shift) (void)memcpy(x, from, sizeof(Complex) * (size_t)n);
  for (ptrdiff_t q = 0; l->shift && q < 4; q++)
    for (ptrdiff_t k = 0; k < LineCount(l, n, q); k++)
      (void)memcpy(x[q * l->part + k], from[4 * k + q], sizeof(Complex));
}
static inline void LineTake(const LINE *l, ptrdiff_t n, const Complex *restrict x, Complex *restrict to)
{
  if (!l->shift) (void)memcpy(to, x, sizeof(Complex) * (size_t)n);
  for (ptrdiff_t q = 0; l->shift && q < 4; q++)
    for (ptrdiff_t k = 0; k < LineCount(l, n, q); k++) (void)memcpy(to[4 * k + q], x[q * l->part + k], sizeof(Complex));
}

/*
  Computes the transform of the line from those of its parts. All arrays are separate arguments, so that the compiler
  can assume that they do not overlap.
*/
SAM_VECTORIZED static inline void LineJoin(ptrdiff_t n, const Complex *restrict u, const Complex *restrict v,
                                           const Complex *restrict w, Complex *restrict a, Complex *restrict b,
                                           Complex *restrict c, Complex *restrict d)
{
  for (ptrdiff_t k = 0; k < n; k++) {
    const Real bx = b[k][0] * u[k][0] - b[k][1] * u[k][1], by = b[k][1] * u[k][0] + b[k][0] * u[k][1];
    const Real cx = c[k][0] * v[k][0] - c[k][1] * v[k][1], cy = c[k][1] * v[k][0] + c[k][0] * v[k][1];
    const Real dx = d[k][0] * w[k][0] - d[k][1] * w[k][1], dy = d[k][1] * w[k][0] + d[k][0] * w[k][1];
    const Real sx = a[k][0] + cx, sy = a[k][1] + cy, gx = a[k][0] - cx, gy = a[k][1] - cy;
    const Real tx = bx + dx, ty = by + dy, hx = by - dy, hy = dx - bx; /* h = -i (b - d) */

    a[k][0] = sx + tx;
    a[k][1] = sy + ty;
    b[k][0] = gx + hx;
    b[k][1] = gy + hy;
    c[k][0] = sx - tx;
    c[k][1] = sy - ty;
    d[k][0] = gx - hx;
    d[k][1] = gy - hy;
  }
}

/* Inverts LineJoin(): computes the transforms of the parts from that of the line. */
SAM_VECTORIZED static inline void LineSplit(ptrdiff_t n, const Complex *restrict u, const Complex *restrict v,
                                            const Complex *restrict w, Complex *restrict a, Complex *restrict b,
                                            Complex *restrict c, Complex *restrict d)
{
  for (ptrdiff_t k = 0; k < n; k++) {
    const Real sx = a[k][0] + c[k][0], sy = a[k][1] + c[k][1], gx = a[k][0] - c[k][0], gy = a[k][1] - c[k][1];
    const Real tx = b[k][0] + d[k][0], ty = b[k][1] + d[k][1], hx = d[k][1] - b[k][1],
               hy = b[k][0] - d[k][0]; /* h = i (b - d) */
    const Real bx = gx + hx, by = gy + hy, cx = sx - tx, cy = sy - ty, dx = gx - hx, dy = gy - hy;

    a[k][0] = sx + tx;
    a[k][1] = sy + ty;
    b[k][0] = bx * u[k][0] + by * u[k][1];
    b[k][1] = by * u[k][0] - bx * u[k][1];
    c[k][0] = cx * v[k][0] + cy * v[k][1];
    c[k][1] = cy * v[k][0] - cx * v[k][1];
    d[k][0] = dx * w[k][0] + dy * w[k][1];
    d[k][1] = dy * w[k][0] - dx * w[k][1];
  }
}

static inline void LineForward(const LINE *l, Complex *from, Complex *to)
{
  const ptrdiff_t m = l->part;

  FFT(execute_dft)(l->up, (FFT(complex) *)from, (FFT(complex) *)to);
  if (l->shift)
    LineJoin(m, (const Complex *)l->root, (const Complex *)l->root + m, (const Complex *)l->root + 2 * m, to, to + m,
             to + 2 * m, to + 3 * m);
}

/* Transforms backward, unnormalised (times n); `from` is overwritten. */
static inline void LineBackward(const LINE *l, Complex *from, Complex *to)
{
  const ptrdiff_t m = l->part;

  if (l->shift)
    LineSplit(m, (const Complex *)l->root, (const Complex *)l->root + m, (const Complex *)l->root + 2 * m, from,
              from + m, from + 2 * m, from + 3 * m);
  FFT(execute_dft)(l->down, (FFT(complex) *)from, (FFT(complex) *)to);
}

/* Computes i exp(i pi k/n), k <= n, for lines of 2 n real numbers that are transformed as n complex ones. */
static inline PetscErrorCode CreateTurns(ptrdiff_t n, Complex **turn)
{
  PetscFunctionBegin;
  PetscCall(AllocateComplex((size_t)(n + 1), turn));
  for (ptrdiff_t k = 0; k <= n; k++) {
    double root[2];

    SamRootOfUnity(k, n, root);
    (*turn)[k][0] = (Real)-root[1];
    (*turn)[k][1] = (Real)root[0];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reverses an array: to[k] = from[n - k], k <= n. */
SAM_VECTORIZED static inline void Mirror(ptrdiff_t n, const Complex *restrict from, Complex *restrict to)
{
  for (ptrdiff_t k = 0; k <= n; k++) (void)memcpy(to[k], from[n - k], sizeof(Complex));
}
