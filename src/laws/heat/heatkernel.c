/*
  Steady temperature of a half-space by the flux on one cell.

  Problem: T at the centre of a cell, or below it, by unit flux on another, in a body whose material moves along x. The
  rest of the surface is insulated.

  Method: heat that entered at one time is, at the age tau, a Gaussian of the width s = sqrt(4 D tau), D being the
  diffusivity, and has moved by tau times the speed, which is P s^2/2 with P = speed/(2 D). The sum over all ages is
      T = 1/(conductivity sqrt(pi)) int_0^inf X(x + P s^2/2, s) Y(y, s) exp(-z^2/s^2) ds,
      X(x, s) = [erf((x + a)/s) - erf((x - a)/s)]/2, a half of the cell's side, Y alike; the material moves to -x.
  The integral is computed by Gauss points on panels. Their borders are where the arguments of the functions erf have
  certain values, multiples of the depth, and doublings of a length that is short against the cell. For slow bodies the
  ages after the last border follow in closed form, as X Y is then that of a point source:
      int_S^inf (4 a b/pi) exp(-P x - P^2 s^2/4)/s^2 ds.
  Borders and points depend on the lag along x alone, so X is tabulated for all rows of lags. With 10 points a panel the
  error is below 1e-13 of the temperature of a cell by its own flux, for P times side from 0 to 1e5.

  Without speed, at the surface, T is the integral of 1/(2 pi conductivity r) in closed form. In plane strain Y = 1; the
  difference of the closed forms at the edges, by Bessel functions, loses its digits for slow bodies, so the integral
  serves there, too.

  Sources: Jaeger 1942, J. Proc. R. Soc. N.S.W. 76, 203; Carslaw and Jaeger 1959, Conduction of Heat in Solids, ch. X.
*/
#include "heatimpl.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/halfspace.h>
#include <petscdt.h>
#include <math.h>

enum { POINTS = 10, BORDERS = 768, NODES = POINTS * BORDERS };

#define REACH   6.5       /* erf(6.5) = 1 in double precision */
#define LEAST_P 1e-100    /* 1/m; slower bodies stand */
#define LONG    0x1p16    /* the last border, for slow bodies, over the longest distance */
#define NOTHING 1e-22     /* smaller X do not count */
#define SHORT   (1. / 64) /* the first border over the shorter half side */

/* A cell as a source: lengths are in m. */
typedef struct {
  double    half[2]; /* half sides; half[1] is infinite for a strip */
  double    p;       /* P >= 0, 1/m */
  double    toward;  /* 1: the material moves to -x, -1: to +x; x then counts in the opposite direction */
  double    depth;
  double    conductivity;
  double    span; /* longest distance along y */
  PetscBool strip;
} Source;

/* The integrand of a lag along x: sum over n nodes of weight * Y(y, 1/inverse), plus the tail. */
typedef struct {
  PetscInt n;
  double  *inverse, *weight; /* in the order of growing s: 1/s (1/m), and the weight (K m2/W) */
  double   tail;             /* K m2/W */
} Ages;

typedef struct {
  double x[POINTS], w[POINTS];
} Rule;

static PetscErrorCode GetRule(Rule *rule)
{
  PetscReal x[POINTS], w[POINTS];

  PetscFunctionBegin;
  PetscCall(PetscDTGaussQuadrature(POINTS, 0, 1, x, w));
  for (PetscInt k = 0; k < POINTS; k++) {
    rule->x[k] = (double)x[k];
    rule->w[k] = (double)w[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetSource(const SamHeatBody *body, const PetscReal side[2], PetscReal depth, PetscInt rows,
                                Source *source)
{
  const double p = fabs(body->speed) / 2 / body->conductivity * body->capacity;

  PetscFunctionBegin;
  PetscCheck(body->conductivity > 0 && isfinite(body->conductivity), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Conductivity %.6g W/(m K): expected a number above 0", (double)body->conductivity);
  PetscCheck(body->capacity > 0 && isfinite(body->capacity), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Heat capacity %.6g J/(m3 K): expected a number above 0", (double)body->capacity);
  PetscCheck(isfinite(p), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "Speed %.6g m/s: expected a finite number",
             (double)body->speed);
  PetscCheck(side[0] > 0 && isfinite(side[0]) && side[1] > 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Sides %.6g, %.6g m of a cell: expected numbers above 0", (double)side[0], (double)side[1]);
  PetscCheck(depth >= 0 && isfinite(depth), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Depth %.6g m: expected a number from 0 on", (double)depth);
  *source = (Source){.half         = {0.5 * side[0], 0.5 * side[1]},
                     .p            = p < LEAST_P ? 0 : p,
                     .toward       = body->speed > 0 ? -1 : 1,
                     .depth        = depth,
                     .conductivity = body->conductivity,
                     .strip        = isinf(side[1]) ? PETSC_TRUE : PETSC_FALSE};
  if (!source->strip) source->span = ((double)rows + 0.5) * side[1];
  PetscCheck(!source->strip || source->p > 0, PETSC_COMM_SELF, PETSC_ERR_SUP,
             "In plane strain a body that stands has no steady temperature: expected a speed");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the integral has a closed form. */
static PetscBool IsClosed(const Source *h)
{
  return h->p > 0 || h->depth > 0 ? PETSC_FALSE : PETSC_TRUE;
}

/* ---- the ages of heat for one lag along x ---- */

/* Returns [erf(high) - erf(low)]/2 without cancellation where both are near 1. */
static double Between(double low, double high)
{
  if (low > 0.5) return 0.5 * (erfc(low) - erfc(high));
  if (high < -0.5) return 0.5 * (erfc(-high) - erfc(-low));
  return 0.5 * (erf(high) - erf(low));
}

void SamHeatAddRoots(double p, double edge, double m, double end, PetscInt *n, double borders[])
{
  const double square = m * m - 2 * p * edge, q = square < 0 ? 0 : m + copysign(sqrt(square), m);
  const double roots[] = {p > 0 ? q / p : 0, 2 * edge / q};

  if (q == 0) return;
  for (int k = 0; k < 2; k++)
    if (roots[k] > 0 && roots[k] < end) borders[(*n)++] = roots[k];
}

/* Returns the s after which no heat is near a lag; 0 if there is none at any time. Sets the tail of what follows. */
static double LastBorder(const Source *h, double x, double *tail)
{
  const double far  = LONG * (fabs(x) + h->half[0] + h->depth + h->span),
               left = REACH * REACH - 2 * h->p * (x - h->half[0]);
  const double last = left < 0 ? 0 : (REACH + sqrt(left)) / h->p, u = 0.5 * h->p * far;

  *tail = 0;
  if (h->strip || last < far) return last;
  *tail = 4 * h->half[0] * h->half[1] / PETSC_PI * exp(-h->p * x) *
          (exp(-u * u) / far - 0.5 * h->p * sqrt(PETSC_PI) * erfc(u)) / (h->conductivity * sqrt(PETSC_PI));
  return far;
}

static int Ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;

  return (x > y) - (x < y);
}

void SamHeatSort(PetscInt n, double borders[])
{
  qsort(borders, (size_t)n, sizeof(*borders), Ascending);
}

/* Finds the borders of the panels in their order; returns their number. */
static PetscInt FindBorders(const Source *h, double x, double end, double borders[BORDERS])
{
  static const double values[] = {0, 0.4, -0.4, 1.2, -1.2, 3, -3, REACH, -REACH}, parts[] = {6.5, 4, 2.5, 1.5, 1};
  PetscInt            n = 0;

  borders[n++] = h->depth / REACH < end ? h->depth / REACH : end; /* exp(-z^2/s^2) is 0 before */
  for (int side = -1; side <= 1; side += 2)
    for (size_t k = 0; k < sizeof(values) / sizeof(*values); k++)
      SamHeatAddRoots(h->p, x + side * h->half[0], values[k], end, &n, borders);
  for (size_t k = 1; k < sizeof(parts) / sizeof(*parts); k++)
    if (h->depth > 0 && h->depth / parts[k] < end) borders[n++] = h->depth / parts[k];
  for (double s = SHORT * PetscMin(h->half[0], h->half[1]); s < end && n < BORDERS - 1; s *= 2) borders[n++] = s;
  borders[n++] = end;
  SamHeatSort(n, borders);
  return n;
}

/* Fills the nodes of the lag i, of which there may be NODES. */
static void FindAges(const Source *h, const Rule *rule, PetscInt i, Ages *ages)
{
  const double x = h->toward * 2 * h->half[0] * (double)i, end = LastBorder(h, x, &ages->tail);
  double       borders[BORDERS];
  PetscInt     n;

  ages->n = 0;
  if (!(end > 0)) return;
  n = FindBorders(h, x, end, borders);
  for (PetscInt b = 0; b < n - 1; b++) {
    const double width = borders[b + 1] - borders[b];

    for (PetscInt k = 0; k < POINTS && borders[b] >= h->depth / REACH; k++) {
      const double s = borders[b] + width * rule->x[k], at = x + 0.5 * h->p * s * s, z = h->depth / s;
      const double value = Between((at - h->half[0]) / s, (at + h->half[0]) / s) * exp(-z * z);

      if (!(value > NOTHING)) continue;
      ages->inverse[ages->n]  = 1 / s;
      ages->weight[ages->n++] = width * rule->w[k] * value / (h->conductivity * sqrt(PETSC_PI));
    }
  }
}

/* Returns the first of the n nodes from `first` on whose heat reaches the row j >= 0. */
static PetscInt FirstNode(const Source *h, const Ages *ages, PetscInt j, PetscInt first)
{
  const double near = (double)j * 2 * h->half[1] - h->half[1];

  while (!h->strip && first < ages->n && near * ages->inverse[first] > REACH) first++;
  return first;
}

/* Returns the integral for the row j of lags; `lower`: erf at the near edge of the cell, from the node `first` on. */
static double Integral(const Source *h, const Ages *ages, PetscInt j, PetscInt first, double lower[])
{
  const double far = ((double)j + 0.5) * 2 * h->half[1];
  double       sum = ages->tail;

  for (PetscInt k = first; k < ages->n; k++) {
    const double upper = h->strip ? 1 : erf(far * ages->inverse[k]);

    sum += ages->weight[k] * 0.5 * (upper - lower[k]);
    lower[k] = upper;
  }
  return sum;
}

/* Sets erf at the near edges of the cells of a row. */
static void SetLower(const Source *h, const Ages *ages, PetscInt j, PetscInt first, double lower[])
{
  const double near = ((double)j - 0.5) * 2 * h->half[1];

  for (PetscInt k = first; k < ages->n; k++) lower[k] = h->strip ? -1 : erf(near * ages->inverse[k]);
}

static void ClosedRow(const Source *h, PetscInt j, PetscInt i0, PetscInt n, double values[])
{
  SamIntegralRow(SAM_INTEGRAL_R, 2 * h->half[0], 2 * h->half[1], j, i0, n, values);
  for (PetscInt k = 0; k < n; k++) values[k] /= 2 * PETSC_PI * h->conductivity;
}

PetscErrorCode SamHeatRow(const SamHeatBody *body, const PetscReal side[2], PetscReal depth, PetscInt j, PetscInt i0,
                          PetscInt n, double values[])
{
  const PetscInt row = PetscAbs(j);
  double        *lower;
  Source         source;
  Ages           ages;
  Rule           rule;

  PetscFunctionBegin;
  PetscCall(GetSource(body, side, depth, row, &source));
  if (IsClosed(&source)) {
    ClosedRow(&source, row, i0, n, values);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(GetRule(&rule));
  PetscCall(PetscMalloc3(NODES, &ages.inverse, NODES, &ages.weight, NODES, &lower));
  for (PetscInt k = 0; k < n; k++) {
    PetscInt first;

    FindAges(&source, &rule, i0 + k, &ages);
    first = FirstNode(&source, &ages, row, 0);
    SetLower(&source, &ages, row, first, lower);
    values[k] = source.strip && row ? 0 : Integral(&source, &ages, row, first, lower);
  }
  PetscCall(PetscFree3(ages.inverse, ages.weight, lower));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- rows of lags ---- */

/* The ages of a lag, the first node that counts, and erf at the near edge of the next row's cell at each node */
typedef struct {
  Ages     ages;
  PetscInt first;
  double  *lower;
} Lag;

struct _n_SamHeatTable {
  Source   source;
  PetscInt n;    /* lags 0 ... n - 1 */
  PetscInt next; /* row that follows the last one computed */
  PetscInt lags; /* n, or 2 n for bodies that move: those of i in [0], [1], ..., then those of -i */
  Lag     *lag;  /* NULL: closed form */
};

/* Stores the ages of the lag i. */
static PetscErrorCode StoreLag(const Source *source, const Rule *rule, PetscInt i, const Ages *scratch, Lag *lag)
{
  Ages ages = *scratch;

  PetscFunctionBegin;
  FindAges(source, rule, i, &ages);
  *lag = (Lag){.ages = ages};
  PetscCall(PetscMalloc3(ages.n + 1, &lag->ages.inverse, ages.n + 1, &lag->ages.weight, ages.n + 1, &lag->lower));
  PetscCall(PetscArraycpy(lag->ages.inverse, ages.inverse, ages.n));
  PetscCall(PetscArraycpy(lag->ages.weight, ages.weight, ages.n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatTableCreate(const SamHeatBody *body, const PetscReal side[2], PetscReal depth,
                                  const PetscInt n[2], SamHeatTable *table)
{
  SamHeatTable t;
  Source       source;
  Ages         scratch;
  Rule         rule;

  PetscFunctionBegin;
  PetscCall(GetSource(body, side, depth, n[1], &source));
  PetscCall(PetscNew(&t));
  t->source = source;
  t->n      = n[0];
  t->next   = -1;
  *table    = t;
  if (IsClosed(&source)) PetscFunctionReturn(PETSC_SUCCESS);
  t->lags = source.p > 0 ? 2 * n[0] : n[0];
  PetscCall(GetRule(&rule));
  PetscCall(PetscCalloc1(t->lags, &t->lag));
  PetscCall(PetscMalloc2(NODES, &scratch.inverse, NODES, &scratch.weight));
  for (PetscInt k = 0; k < t->lags; k++)
    PetscCall(StoreLag(&source, &rule, k < n[0] ? k : n[0] - k, &scratch, &t->lag[k]));
  PetscCall(PetscFree2(scratch.inverse, scratch.weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatTableDestroy(SamHeatTable *table)
{
  PetscFunctionBegin;
  if (!*table) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < (*table)->lags; k++)
    PetscCall(PetscFree3((*table)->lag[k].ages.inverse, (*table)->lag[k].ages.weight, (*table)->lag[k].lower));
  PetscCall(PetscFree((*table)->lag));
  PetscCall(PetscFree(*table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the temperature in the row j by one lag's ages; `follows`: the last row computed was j - 1. */
static double RowOf(const Source *h, Lag *lag, PetscInt j, PetscBool follows)
{
  lag->first = FirstNode(h, &lag->ages, j, follows ? lag->first : 0);
  if (!follows) SetLower(h, &lag->ages, j, lag->first, lag->lower);
  return Integral(h, &lag->ages, j, lag->first, lag->lower);
}

void SamHeatTableRow(SamHeatTable t, PetscInt j, double even[], double odd[])
{
  const PetscBool follows = j == t->next ? PETSC_TRUE : PETSC_FALSE;

  for (PetscInt i = 0; i < t->n; i++) even[i] = odd[i] = 0;
  if (t->source.strip && j) return;
  t->next = j + 1;
  if (!t->lag) ClosedRow(&t->source, j, 0, t->n, even);
  for (PetscInt i = 0; t->lag && i < t->n; i++) {
    const double ahead  = RowOf(&t->source, &t->lag[i], j, follows),
                 behind = t->lags > t->n ? RowOf(&t->source, &t->lag[t->n + i], j, follows) : ahead;

    even[i] = 0.5 * (ahead + behind);
    odd[i]  = 0.5 * (ahead - behind);
  }
}
