/*
  Integrals of 1/r, x^2/r^3, x y/r^3 and x/r^2 over a rectangular cell.

  Problem. Love's closed forms are sums of an antiderivative over the four corners. At a distance of d cells they cancel
  to 1/d^2 of their terms or less (x^2/r^3 beside the y axis: 1/d^3), so in double precision 4 to 8 digits remain at the
  far end of a grid of 16384 cells per side. The aim is nearly full precision, relative to each value, at every lag, and
  at low cost.

  Algorithm.
    1. A cell with half sides a and b, its centre at (x, y), is integrated by Taylor's series about the centre, whose
       odd derivatives cancel:
         4 a b sum_mn a^2m b^2n / ((2m+1)! (2n+1)!) d_x^2m d_y^2n f.
       The terms of one order k = m + n are f's odd powers of x and y, a power of r, and q^k times
       a polynomial in w, where q = 1/r^2 and w = x^2 q. The polynomials depend on the cell's sides
       alone; their coefficients follow from the derivatives of x^i y^j r^-p by a recurrence. For each cell in a row one
       division, one root and two nested Horner schemes remain.
    2. x^2/r^3 is small beside the y axis because its term of order 0 is w and that of order 1 is
       q a^2/3 there: nothing cancels. So y^2/r^3 and y/r^2 use w = y^2 q, with x and y exchanged.
    3. A row is processed in blocks of lags, which use the order of their nearest cell; if that is too near, each cell
       of the block uses its own order.
    4. A cell for which no order suffices is halved across its longer side as long as it is slender,
       and then quartered. All kernels are homogeneous of degree -1: the integral over a quarter is half of the integral
       over a whole cell at twice the distance, so that the same coefficients are used for quarters, their quarters, and
       so on.
    5. For the cell at the origin Love's closed form is used, whose terms are positive there.

  Bound. Let R be the distance of the centre, d the half diagonal, s = R/d. At a distance t from the
  centre the terms of degree l of r^-p are a Gegenbauer polynomial times (t/R)^l R^-p, at most
  C_l^(p/2)(1) (t/R)^l R^-p (Szego 1975). The mean of t^l over a cell is at most d^l/(l+1): for a
  given d it is convex in a^2, thus largest for a cell without width. A numerator (x+u)^i adds
  products of x^(i-h) u^h, |u| <= a, and terms of degree l-h. The value itself is at least x^i (for
  i = 2: x^2 + a^2/3) times (R+d)^-p. So for x^i y^j r^-p the sum of the orders from k on, relative to the value,
  is at most
    6 (2k+1)^(p-2) (1 + a s/max(x, a))^i (1 + b s/max(y, b))^j s^-2k,  k >= 2, s >= 5,
  where 6 is 3 (for i = 2 at x = 0), (1 + 1/s)^3 and the geometric series. The bound falls with the lag, as step 3
  requires. From a distance of 2800 square cells on, 1/r needs order 1, which is three coefficients.

  Lengths are measured in a power of two near the longer side: all six integrals scale as a length,
  no power of r leaves the range of a double, and the scaling itself does not round.

  References:
    Love, A.E.H. (1929). The stress produced in a semi-infinite solid by pressure on part of the
      boundary. Phil. Trans. R. Soc. A 228, 377-420.
    Johnson, K.L. (1985). Contact Mechanics, chapter 3. Cambridge University Press.
    Liu, S., Wang, Q., Liu, G. (2000). A versatile method of discrete convolution and FFT (DC-FFT)
      for contact analyses. Wear 243, 101-111.
    Szego, G. (1975). Orthogonal Polynomials, section 4.7. American Mathematical Society.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/halfspace.h>

#include <math.h>

/*
  Highest order of an expansion, lags that share an order (short enough to stay in the first cache), and
  shapes between a slender cell and a nearly square part of it.
*/
enum { MAX_ORDER = 10, BLOCK = 64, MAX_SHAPES = 16 };

/* Largest truncation bound relative to the value; it is of the order of the rounding of the sum. */
static const double tolerance = 5e-15;

/* A kernel is u^odd_u v^odd_v u^(2 square) r^-(root + 2 square), where u is x and v is y, or exchanged. */
typedef struct {
  int exchanged, odd_u, odd_v, square, root;
} Kernel;

static const Kernel kernels[] = {
  [SAM_INTEGRAL_R] = {0, 0, 0, 0, 1},  [SAM_INTEGRAL_XX] = {0, 0, 0, 1, 1}, [SAM_INTEGRAL_YY] = {1, 0, 0, 1, 1},
  [SAM_INTEGRAL_XY] = {0, 1, 1, 0, 3}, [SAM_INTEGRAL_X] = {0, 1, 0, 0, 2},  [SAM_INTEGRAL_Y] = {1, 1, 0, 0, 2},
};

/*
  The expansion for one shape of cells: the term of order k is u^odd_u v^odd_v r^-root q^k times the polynomial
  in w = u^2 q whose coefficients are polynomial[k], of degree k + square.
*/
typedef struct {
  Kernel kernel;
  double a, b;    /* half sides along x and y */
  double scale;   /* factor of the integrals */
  int    slender; /* the next expansion is for its halves across the longer side */
  int    order;   /* highest order with known polynomials */
  double polynomial[MAX_ORDER + 1][MAX_ORDER + 2];
} Expansion;

/* Replaces the polynomial f of order k by that of the second derivative of its term by u, times `factor`. */
static void DeriveU(const Kernel *kernel, int k, double factor, double f[])
{
  double below = 0; /* contribution of the power before */

  f[k + kernel->square + 1] = 0;
  for (int i = 0; i <= k + kernel->square + 1; i++) {
    const double s = kernel->root + 2 * (k + i), p = 2 * i + kernel->odd_u;
    const double from = f[i], above = i <= k + kernel->square ? f[i + 1] : 0;

    f[i]  = factor * (below - s * (2 * p + 1) * from + (p + 2) * (p + 1) * above);
    below = s * (s + 2) * from;
  }
}

/* Does the same for the second derivative by v, where v^2 = r^2 - u^2. */
static void DeriveV(const Kernel *kernel, int k, double factor, double f[])
{
  double below = 0;

  f[k + kernel->square + 1] = 0;
  for (int i = 0; i <= k + kernel->square + 1; i++) {
    const double s = kernel->root + 2 * (k + i), from = f[i];

    f[i]  = factor * (s * (s + 1 - 2 * kernel->odd_v) * from - below);
    below = s * (s + 2) * from;
  }
}

/* Computes the polynomials up to an order; they do not depend on the highest order. */
static void Expand(Expansion *e, int order)
{
  const Kernel *kernel = &e->kernel;
  const double  u = kernel->exchanged ? e->b : e->a, v = kernel->exchanged ? e->a : e->b;
  double        derived[MAX_ORDER + 3] = {0}; /* derivatives by v alone */

  derived[kernel->square] = 4 * u * v * e->scale;
  for (int k = 0; k <= order; k++)
    for (int i = 0; i <= k + kernel->square; i++) e->polynomial[k][i] = 0;
  for (int n = 0; n <= order; n++) {
    double term[MAX_ORDER + 3];

    for (int i = 0; i <= n + kernel->square; i++) term[i] = derived[i];
    for (int k = n; k <= order; k++) {
      const int m = k - n;

      for (int i = 0; i <= k + kernel->square; i++) e->polynomial[k][i] += term[i];
      DeriveU(kernel, k, u * u / ((2 * m + 2) * (2 * m + 3)), term);
    }
    DeriveV(kernel, n, v * v / ((2 * n + 2) * (2 * n + 3)), derived);
  }
  e->order = order;
}

/*
  Returns the least order whose bound (top of this file) is within the tolerance for the cell at (x, y), both >= 0; a
  value above MAX_ORDER if there is none.
*/
static int SelectOrder(const Expansion *e, double x, double y)
{
  const Kernel *kernel = &e->kernel;
  const double  ss = (x * x + y * y) / (e->a * e->a + e->b * e->b), s = sqrt(ss);
  const double  beside_x = 1 + s * e->a / fmax(x, e->a), beside_y = 1 + s * e->b / fmax(y, e->b);
  const double  u = kernel->exchanged ? beside_y : beside_x, v = kernel->exchanged ? beside_x : beside_y;
  const int     power = kernel->root + 2 * kernel->square;
  double        bound = 6 * (kernel->odd_u ? u : 1) * (kernel->odd_v ? v : 1) * (kernel->square ? u * u : 1), decrease;

  if (s < 5) return MAX_ORDER + 1;
  decrease = 1 / ss;
  bound *= decrease;
  for (int k = 2; k <= MAX_ORDER + 1; k++) {
    bound *= decrease;
    if (bound * (power == 3 ? 2 * k + 1 : 1) <= tolerance * (power == 1 ? 2 * k + 1 : 1)) return k - 1;
  }
  return MAX_ORDER + 1;
}

/*
  Evaluates the integrals over the cells at ((first + 2 k) a, y), k < n <= BLOCK, by the expansion of that order. The
  index is an int: without AVX-512DQ no vector of longer ones becomes one of doubles.
*/
SAM_VECTORIZED static void Evaluate(const Expansion *e, int order, double first, double y, int n,
                                    double *restrict values)
{
  const int square = e->kernel.square;
  double    x[BLOCK], q[BLOCK], w[BLOCK], term[BLOCK];

  for (int k = 0; k < n; k++) {
    x[k]      = (first + 2 * (double)k) * e->a;
    q[k]      = 1 / (x[k] * x[k] + y * y);
    w[k]      = (e->kernel.exchanged ? y * y : x[k] * x[k]) * q[k];
    values[k] = 0;
  }
  for (int l = order; l >= 0; l--) {
    const double *c = e->polynomial[l];

    for (int k = 0; k < n; k++) term[k] = c[l + square];
    for (int i = l + square - 1; i >= 0; i--)
      for (int k = 0; k < n; k++) term[k] = term[k] * w[k] + c[i];
    for (int k = 0; k < n; k++) values[k] = values[k] * q[k] + term[k];
  }
  switch (e->kernel.root) {
  case 1:
    for (int k = 0; k < n; k++) values[k] *= sqrt(q[k]);
    break;
  case 2:
    for (int k = 0; k < n; k++) values[k] *= (e->kernel.exchanged ? y : x[k]) * q[k];
    break;
  default:
    for (int k = 0; k < n; k++) values[k] *= x[k] * y * q[k] * sqrt(q[k]);
  }
}

/* Sets up a cell's expansion and those of its halves, without polynomials. */
static void MakeShapes(SamIntegral kind, double a, double b, double scale, Expansion shapes[])
{
  int slender = 1;

  for (int k = 0; slender; k++) {
    slender           = k + 1 < MAX_SHAPES && (a > 2 * b || b > 2 * a);
    shapes[k].kernel  = kernels[kind];
    shapes[k].a       = a;
    shapes[k].b       = b;
    shapes[k].scale   = scale;
    shapes[k].slender = slender;
    shapes[k].order   = -1;
    if (a > b)
      a /= 2;
    else
      b /= 2;
  }
}

/* Returns the integral over a rectangle about (i a, j b), away from the origin; divided until an order suffices. */
static double Rectangle(Expansion *e, double i, double j)
{
  const int order = SelectOrder(e, fabs(i) * e->a, fabs(j) * e->b);
  double    integral, below, above;

  if (order <= MAX_ORDER) {
    if (order > e->order) Expand(e, order);
    Evaluate(e, order, i, j * e->b, 1, &integral);
    return integral;
  }
  if (e->slender && e->a > e->b) return Rectangle(e + 1, 2 * i - 1, j) + Rectangle(e + 1, 2 * i + 1, j);
  if (e->slender) return Rectangle(e + 1, i, 2 * j - 1) + Rectangle(e + 1, i, 2 * j + 1);
  below = Rectangle(e, 2 * i - 1, 2 * j - 1) + Rectangle(e, 2 * i + 1, 2 * j - 1);
  above = Rectangle(e, 2 * i - 1, 2 * j + 1) + Rectangle(e, 2 * i + 1, 2 * j + 1);
  return (below + above) / 2;
}

/* Integrates over the cell at the origin: four quarters, each by Love's closed form at its corner. */
static double OriginIntegral(SamIntegral kind, double hx, double hy)
{
  switch (kind) {
  case SAM_INTEGRAL_R:
    return 2 * (hx * asinh(hy / hx) + hy * asinh(hx / hy));
  case SAM_INTEGRAL_XX:
    return 2 * hy * asinh(hx / hy);
  case SAM_INTEGRAL_YY:
    return 2 * hx * asinh(hy / hx);
  default:
    return 0; /* the odd kernels */
  }
}

/* Returns the number of the n lags from i on that lie in its block; blocks of negative lags mirror those of positive
   ones. */
static ptrdiff_t BlockLength(ptrdiff_t i, ptrdiff_t n)
{
  const ptrdiff_t length = i >= 0 ? BLOCK - i % BLOCK : -i % BLOCK + 1;

  return length < n ? length : n;
}

/*
  Computes the integrals over n cells (i + k, j), all in one block. The order depends on the block alone, not on where
  the n cells begin or end in it, so that a cell has one value in whatever range it is computed.
*/
static void BlockIntegrals(Expansion *e, ptrdiff_t j, ptrdiff_t i, ptrdiff_t n, double *values)
{
  const ptrdiff_t lag = i < 0 ? -i : i, nearest = lag - lag % BLOCK;
  const double    row   = 2 * (double)j;
  const int       order = SelectOrder(e, 2 * (double)nearest * e->a, fabs(row) * e->b);

  if (order <= MAX_ORDER) {
    if (order > e->order) Expand(e, order);
    Evaluate(e, order, 2 * (double)i, row * e->b, (int)n, values);
    return;
  }
  for (ptrdiff_t k = 0; k < n; k++) {
    if (i + k != 0 || j != 0) values[k] = Rectangle(e, 2 * (double)(i + k), row);
  }
}

void SamIntegralRow(SamIntegral kind, double dx, double dy, ptrdiff_t j, ptrdiff_t i0, ptrdiff_t n, double *values)
{
  const int    unit = ilogb(fmax(dx, dy));
  const double hx = scalbn(dx, -unit), hy = scalbn(dy, -unit);
  const double scale = scalbn(1, unit);
  Expansion    shapes[MAX_SHAPES];

  MakeShapes(kind, hx / 2, hy / 2, scale, shapes);
  for (ptrdiff_t k = 0, length; k < n; k += length) {
    length = BlockLength(i0 + k, n - k);
    BlockIntegrals(shapes, j, i0 + k, length, values + k);
  }
  if (j == 0 && i0 <= 0 && -i0 < n) values[-i0] = OriginIntegral(kind, hx, hy) * scale;
}

double SamIntegralCell(SamIntegral kind, double dx, double dy, ptrdiff_t i, ptrdiff_t j)
{
  double value;

  SamIntegralRow(kind, dx, dy, j, i, 1, &value);
  return value;
}
