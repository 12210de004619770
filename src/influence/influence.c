/*
 * Integrals of 1/r, x^2/r^3, x y/r^3 and x/r^2 over a rectangular cell.
 *
 * Problem. Love's closed forms are sums of an antiderivative over the four corners. At a distance
 * of d cells they cancel to 1/d^2 of their terms or less (x^2/r^3 beside the y axis: 1/d^3), so in
 * double precision 4 to 8 digits are left at the far end of a grid of 16384 cells a side. Wanted is
 * nearly full precision, relative to each value, at every lag.
 *
 * Algorithm.
 *   1. Mirror the cell into the first quadrant; a cell that an axis halves becomes twice its half.
 *      There no kernel changes sign, so that no sum of its values can cancel.
 *   2. The cell at the origin is Love's closed form, whose terms are positive there.
 *   3. Any other cell is integrated by a product of two Gauss-Legendre rules, each with just
 *      enough points for the bound below.
 *   4. A side that the longest rule cannot integrate (a cell near the origin or a slender one) is
 *      split in two, and each half is treated by 3 and 4.
 *   5. A row is worked off in blocks of lags that share the rules of their nearest cell.
 *
 * Bound. Along x at a given y the kernels are analytic but for x = +-i y, at the distance
 * D = sqrt(cx^2 + y^2) from the middle cx of a side of half length a. So they are analytic in every
 * ellipse about that side whose half axes add up to less than rho a, with
 *   rho = s + sqrt(s^2 - 1), s = D/a,
 * and the error of m points falls like rho^(-2m) (Trefethen 2008). Its factor follows far away,
 * where rho = 2D/a, from the error term f^(2m) (2a)^(2m+1) (m!)^4 / ((2m+1) (2m)!^3) and, for the
 * worst kernel, |d^n r^-3 / dx^n| <= (n+1)(n+2)/2 n! / r^(n+3):
 *   error / value <= pi (m+1/2) (m+1) rho^(-2m) < 3.2 (m+1)^2 rho^(-2m).
 * A numerator x^p is as large as D^p on the ellipse but at most x1^p on a side that ends at x1, so
 * the error relative to the value is larger by max(1, D/x1)^p. This is what asks for more points
 * beside the axes, where x^2/r^3 is small. The bound falls with the lag, which step 5 needs.
 * Two points a side suffice from about 2000 cells on, away from the axes.
 *
 * Lengths are measured in a power of two near the longer side: all six integrals scale as a length,
 * no power of r leaves the range of a double, and the scaling itself does not round.
 *
 * References:
 *   Love, A.E.H. (1929). The stress produced in a semi-infinite solid by pressure on part of the
 *     boundary. Phil. Trans. R. Soc. A 228, 377-420.
 *   Johnson, K.L. (1985). Contact Mechanics, chapter 3. Cambridge University Press.
 *   Liu, S., Wang, Q., Liu, G. (2000). A versatile method of discrete convolution and FFT (DC-FFT)
 *     for contact analyses. Wear 243, 101-111.
 *   Trefethen, L.N. (2008). Is Gauss quadrature better than Clenshaw-Curtis? SIAM Rev. 50, 67-87.
 */
#include "../base/baseimpl.h"
#include <petsam/influence.h>

#include <math.h>

/* Points of the longest rule, and lags that share rules: short enough to stay in the first cache. */
enum { MAX_POINTS = 12, BLOCK = 64 };

/* What the bound may come to, relative to a value: of the order of what the summation rounds off. */
static const double tolerance = 5e-15;

typedef struct {
  int    points;
  double node[MAX_POINTS], weight[MAX_POINTS]; /* on [-1, 1] */
} Rule;

/* Gauss-Legendre; far cells use the short rules, and between the long ones gaps cost little. */
static const Rule rules[] = {
    {2,
     {-0.57735026918962576451, 0.57735026918962576451},
     {1.0000000000000000000, 1.0000000000000000000}},
    {3,
     {-0.77459666924148337704, 0., 0.77459666924148337704},
     {0.55555555555555555556, 0.88888888888888888889, 0.55555555555555555556}},
    {4,
     {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522},
     {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737}},
    {5,
     {-0.90617984593866399280, -0.53846931010568309104, 0., 0.53846931010568309104,
      0.90617984593866399280},
     {0.23692688505618908751, 0.47862867049936646804, 0.56888888888888888889, 0.47862867049936646804,
      0.23692688505618908751}},
    {6,
     {-0.93246951420315202781, -0.66120938646626451366, -0.23861918608319690863, 0.23861918608319690863,
      0.66120938646626451366, 0.93246951420315202781},
     {0.17132449237917034504, 0.36076157304813860757, 0.46791393457269104739, 0.46791393457269104739,
      0.36076157304813860757, 0.17132449237917034504}},
    {8,
     {-0.96028985649753623168, -0.79666647741362673959, -0.52553240991632898582, -0.18343464249564980494,
      0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168},
     {0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734, 0.36268378337836198297,
      0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915}},
    {12,
     {-0.98156063424671925069, -0.90411725637047485668, -0.76990267419430468704, -0.58731795428661744730,
      -0.36783149899818019375, -0.12523340851146891547, 0.12523340851146891547, 0.36783149899818019375,
      0.58731795428661744730, 0.76990267419430468704, 0.90411725637047485668, 0.98156063424671925069},
     {0.047175336386511827195, 0.10693932599531843096, 0.16007832854334622633, 0.20316742672306592175,
      0.23349253653835480876, 0.24914704581340278500, 0.24914704581340278500, 0.23349253653835480876,
      0.20316742672306592175, 0.16007832854334622633, 0.10693932599531843096, 0.047175336386511827195}},
};
enum { NUM_RULES = sizeof(rules) / sizeof(rules[0]) };

/* The numerators' powers of x and y, by SamIntegral; an odd power makes an odd integral. */
static const int powers[][2] = {{0, 0}, {2, 0}, {0, 2}, {1, 1}, {1, 0}, {0, 1}};

/* One direction of a rectangle: its side is [middle - half, middle + half], and never below 0. */
typedef struct {
  double middle, half;
} Side;

/* Equal rectangles along x: the k-th one is shifted by (first + direction k) step. */
typedef struct {
  double    first, direction, step;
  ptrdiff_t n;
} Run;

/* The part of cell `lag` (>= 0) on the positive side: its half for the cell that the axis halves. */
static Side CellSide(double h, ptrdiff_t lag)
{
  Side side = {(double)lag * h, h / 2};

  if (lag == 0) side.middle = side.half = h / 4;
  return side;
}

/*
 * The shortest rule along `side` whose bound (top of this file) is within the tolerance, where the
 * rectangle's other direction is at least `beside` from the axis; NULL if there is none.
 */
static const Rule *SelectRule(Side side, double beside, int power)
{
  double distance = sqrt(side.middle * side.middle + beside * beside);
  double s        = fmax(distance / side.half, 1);
  double rho      = s + sqrt((s - 1) * (s + 1));
  double growth   = fmax(distance / (side.middle + side.half), 1);
  double bound    = 3.2 * (power == 0 ? 1 : power == 1 ? growth : growth * growth);
  int    m        = 0;

  for (int k = 0; k < NUM_RULES; k++) {
    for (; m < rules[k].points; m++) bound /= rho * rho;
    if (bound * (m + 1) * (m + 1) <= tolerance) return &rules[k];
  }
  return NULL;
}

/* Adds `weight` times the kernel at (x, y), and at the points shifted from it along the run. */
SAM_VECTORIZED static void AddPoint(SamIntegral kind, const Run *run, double x, double y, double weight, double *restrict values)
{
  const double    yy = y * y, first = run->first, direction = run->direction, step = run->step;
  const ptrdiff_t n = run->n;

#define SUM(term) \
  for (ptrdiff_t k = 0; k < n; k++) { \
    const double xk = (first + direction * (double)k) * step + x, rr = xk * xk + yy; \
\
    values[k] += weight * (term); \
  } \
  break

  switch (kind) {
  case SAM_INTEGRAL_R: SUM(1 / sqrt(rr));
  case SAM_INTEGRAL_XX: SUM(xk * xk / (rr * sqrt(rr)));
  case SAM_INTEGRAL_YY: SUM(yy / (rr * sqrt(rr)));
  case SAM_INTEGRAL_XY: SUM(y * xk / (rr * sqrt(rr)));
  case SAM_INTEGRAL_X: SUM(xk / rr);
  case SAM_INTEGRAL_Y: SUM(y / rr);
  }
#undef SUM
}

/* Adds the integrals over the rectangles of a run, by the rules given. */
static void AddProduct(SamIntegral kind, const Run *run, Side sx, Side sy, const Rule *rx, const Rule *ry,
                       double *values)
{
  for (int b = 0; b < ry->points; b++) {
    const double y = sy.middle + sy.half * ry->node[b];

    for (int a = 0; a < rx->points; a++) {
      const double weight = sx.half * sy.half * rx->weight[a] * ry->weight[b];

      AddPoint(kind, run, sx.middle + sx.half * rx->node[a], y, weight, values);
    }
  }
}

/* The integral over one rectangle that does not touch the origin, split until the rules fit. */
static double RectangleIntegral(SamIntegral kind, Side sx, Side sy)
{
  const Run    single   = {0, 0, 0, 1};
  const Rule  *rx       = SelectRule(sx, sy.middle - sy.half, powers[kind][0]);
  const Rule  *ry       = SelectRule(sy, sx.middle - sx.half, powers[kind][1]);
  Side        *split    = !rx && (ry || sx.half >= sy.half) ? &sx : &sy;
  const double middle   = split->middle;
  double       integral = 0;

  if (rx && ry) {
    AddProduct(kind, &single, sx, sy, rx, ry, &integral);
    return integral;
  }
  split->half /= 2;
  split->middle = middle - split->half;
  integral      = RectangleIntegral(kind, sx, sy);
  split->middle = middle + split->half;
  return integral + RectangleIntegral(kind, sx, sy);
}

/* The upper half of the cell at the origin: two quarters, each Love's closed form at its corner. */
static double OriginIntegral(SamIntegral kind, double hx, double hy)
{
  switch (kind) {
  case SAM_INTEGRAL_R: return hx * asinh(hy / hx) + hy * asinh(hx / hy);
  case SAM_INTEGRAL_XX: return hy * asinh(hx / hy);
  case SAM_INTEGRAL_YY: return hx * asinh(hy / hx);
  default: return 0; /* the odd kernels */
  }
}

/* The integral over the cell (0, row) for a kernel even in x; over its upper half if row is 0. */
static double AxisIntegral(SamIntegral kind, double hx, double hy, ptrdiff_t row)
{
  if (row == 0) return OriginIntegral(kind, hx, hy);
  return 2 * RectangleIntegral(kind, CellSide(hx, 0), CellSide(hy, row));
}

/*
 * The integrals over n cells (lag + direction k, row), all in the block of `lag` >= 1; over their
 * upper halves if row is 0. The rules depend on the block alone, not on where the n cells begin or
 * end in it, so that a cell has one value however it is asked for.
 */
static void BlockIntegrals(SamIntegral kind, double hx, double hy, ptrdiff_t row, ptrdiff_t lag, int direction,
                           ptrdiff_t n, double *values)
{
  const Run       run   = {(double)lag, direction, hx, n};
  const ptrdiff_t start = lag - lag % BLOCK;
  const Side      sx = CellSide(hx, start > 0 ? start : 1), unshifted = {0, sx.half};
  const Side      sy = CellSide(hy, row);
  const Rule     *rx = SelectRule(sx, sy.middle - sy.half, powers[kind][0]);
  const Rule     *ry = SelectRule(sy, sx.middle - sx.half, powers[kind][1]);

  if (rx && ry) {
    for (ptrdiff_t k = 0; k < n; k++) values[k] = 0;
    AddProduct(kind, &run, unshifted, sy, rx, ry, values);
  } else {
    for (ptrdiff_t k = 0; k < n; k++) {
      values[k] = RectangleIntegral(kind, CellSide(hx, lag + direction * k), sy);
    }
  }
}

/* How many of the n lags from i != 0 on lie in its block and on its side of the origin. */
static ptrdiff_t BlockLength(ptrdiff_t i, ptrdiff_t n)
{
  const ptrdiff_t length = i > 0 ? BLOCK - i % BLOCK : -i % BLOCK + (-i >= BLOCK);

  return length < n ? length : n;
}

void SamIntegralRow(SamIntegral kind, double dx, double dy, ptrdiff_t j, ptrdiff_t i0, ptrdiff_t n,
                    double *values)
{
  const int       unit  = ilogb(fmax(dx, dy));
  const double    hx    = scalbn(dx, -unit), hy = scalbn(dy, -unit);
  const ptrdiff_t row   = j < 0 ? -j : j;
  const int       odd_x = powers[kind][0] % 2, odd_y = powers[kind][1] % 2;
  const double    scale = scalbn(row == 0 ? 2 : odd_y && j < 0 ? -1 : 1, unit);

  for (ptrdiff_t k = 0, length; k < n; k += length) {
    const ptrdiff_t i      = i0 + k;
    double         *block  = values + k;
    const double    factor = odd_x && i < 0 ? -scale : scale;

    length = i == 0 ? 1 : BlockLength(i, n - k);
    if ((odd_x && i == 0) || (odd_y && row == 0)) {
      for (ptrdiff_t l = 0; l < length; l++) block[l] = 0;
    } else if (i == 0) {
      block[0] = AxisIntegral(kind, hx, hy, row) * factor;
    } else {
      BlockIntegrals(kind, hx, hy, row, i < 0 ? -i : i, i < 0 ? -1 : 1, length, block);
      for (ptrdiff_t l = 0; l < length; l++) block[l] *= factor;
    }
  }
}

double SamIntegralCell(SamIntegral kind, double dx, double dy, ptrdiff_t i, ptrdiff_t j)
{
  double value;

  SamIntegralRow(kind, dx, dy, j, i, 1, &value);
  return value;
}
