/*
  Displacement of the surface of a half-space by the heat that flows into one cell: thermal expansion.

  Problem: u_out, the displacement out of the body, and u_x, u_y at the centre of a cell by unit flux on another, in a
  body whose material moves along x, free of tractions and in a steady state.

  Method: a wave exp(i k.x) of the temperature that decays with depth as exp(-kappa z) moves the surface by
      u_out = 2 (1 + nu) alpha T/(kappa + k),   u_t = -i u_out k/|k|,
  and heat of the age tau, with s = sqrt(4 D tau), is the wave erfc(k s/2) of displacement at the place to which its
  material has moved, by P s^2/2, P = speed/(2 D). In space, with X = x + P s^2/2, r^2 = X^2 + y^2, w = r^2/(2 s^2):
      u_out = c int_0^inf exp(-w) (I0(w) - I1(w))/(2 pi s^2) s ds,             c = (1 + nu) alpha/conductivity,
      u_t   = c int_0^inf (X, y)/(2 pi r^3) [erf(r/s) - 2 r/(s sqrt(pi)) exp(-r^2/s^2)] s ds.
  Both integrands are integrated over the cell: u_out by the angles at its corners, of 1 - exp(-w) I0(w) along rays, u_t
  along the cell's sides, as it is the gradient of -erf(r/s)/(2 pi r). Ages at which heat is much wider than the cell,
  and cells that lie at a distance, where that heat is also wide, need points only; to values at centres a 24th of the
  second differences is added, the mean over the cell but for terms of fourth order. The integral over the age is one of
  Gauss points on panels, whose borders are where the arguments of the functions have certain values, and doublings.
  A body that stands has closed forms, -ln(r/R)/(2 pi) and (x, y)/(2 pi r) over the cell; u_out has no datum then, and R
  is half of the grid's diagonal.

  Sources: Barber 1984, J. Appl. Mech. 51, 636; Liu and Wang 2001, J. Tribol. 123, 17; Carslaw and Jaeger 1959, ch. X.
*/
#include "expansion.h"
#include "heatimpl.h"
#include <petsam/private/baseimpl.h>
#include <petscdt.h>
#include <math.h>

#define LEAST_P 1e-100 /* 1/m; slower bodies stand */
#define NEAR    6      /* lags up to which cells are integrated over */
#define WIDE    6      /* of the wake: the width of its heat, in cells, from which points serve */
#define SPREAD  16     /* width of the heat over the cell's longer half side from which 3 x 3 points serve */
#define FAR     2048   /* distance of the heat over its width at the last border; what follows is 2e-8 of the rest */

enum { POINTS = 6, BORDERS = 1024, TERMS = 11, PANELS = 32, TAIL = 14 };

/* A cell as a source, lengths in m; x counts against the motion of the material. */
typedef struct {
  double half[2], p, radius;
} Source;

/* Gauss points on [0, 1], those of three points on [-1, 1], and Bessel functions as Chebyshev series */
typedef struct {
  double x[POINTS], w[POINTS], x3[3], w3[3];
  double zero[PANELS][TERMS], both[PANELS][TERMS]; /* exp(-w) I0(w), and exp(-w) (I0 - I1), w = 0 ... PANELS */
} Rule;

/* ---- functions ---- */

/* Computes exp(-w) times I0(w) and times I0(w) - I1(w), by the trapezoidal rule, which is exact but for rounding. */
static void Bessel(double w, double *zero, double *both)
{
  enum { N = 64 };

  *zero = *both = 0;
  for (int k = 0; k <= N; k++) {
    const double angle = PETSC_PI * k / N, s = sin(0.5 * angle), value = (k % N ? 1. : 0.5) / N * exp(-2 * w * s * s);

    *zero += value;
    *both += 2 * s * s * value;
  }
}

/* Finds the Chebyshev series of both functions on each panel. */
static void FillSeries(Rule *rule)
{
  for (int panel = 0; panel < PANELS; panel++)
    for (int node = 0; node < TERMS; node++) {
      const double angle = PETSC_PI * (node + 0.5) / TERMS;
      double       zero, both;

      Bessel(panel + 0.5 + 0.5 * cos(angle), &zero, &both);
      for (int k = 0; k < TERMS; k++) {
        const double weight = (k ? 2. : 1.) / TERMS * cos(k * angle);

        rule->zero[panel][k] = (node ? rule->zero[panel][k] : 0) + weight * zero;
        rule->both[panel][k] = (node ? rule->both[panel][k] : 0) + weight * both;
      }
    }
}

static double Series(const double c[TERMS], double t)
{
  double last = 0, sum = 0;

  for (int k = TERMS - 1; k > 0; k--) {
    const double next = 2 * t * sum - last + c[k];

    last = sum;
    sum  = next;
  }
  return t * sum - last + c[0];
}

/* Returns exp(-w) (I0(w) - I1(w)), or with `zero` exp(-w) I0(w). */
static double BesselOf(const Rule *rule, double w, PetscBool zero)
{
  double term = 1, sum = 0, other = 1;

  if (w < PANELS) {
    const int panel = (int)w;

    return Series(zero ? rule->zero[panel] : rule->both[panel], 2 * (w - panel) - 1);
  }
  /* asymptotic series of both functions: the terms have the factors (n^2 - (2 k - 1)^2)/(8 k w), n = 0 and 2 */
  for (int k = 1; k <= TAIL; k++) {
    const double odd = 2 * k - 1;

    if (zero) sum += term;
    if (!zero && k > 1) sum += term - other;
    term *= odd * odd / (8 * k * w);
    other *= -(4 - odd * odd) / (8 * k * w);
  }
  return sum / sqrt(2 * PETSC_PI * w);
}

/* Returns erf(t) - 2 t exp(-t^2)/sqrt(pi), without cancellation. */
static double Enclosed(double t)
{
  double term = 4 / (3 * sqrt(PETSC_PI)) * t * t * t, sum = term;

  if (t > 0.5) return erf(t) - 2 / sqrt(PETSC_PI) * t * exp(-t * t);
  for (int n = 1; n < 10; n++) {
    term *= -t * t * (2 * n + 1) / (n * (2 * n + 3.));
    sum += term;
  }
  return sum;
}

/* ---- the displacement by heat of one age ---- */

/* Adds the displacements u_out, u_x, u_y at (x, y) by unit heat at the origin, times `factor`. */
static void AddPoint(const Rule *rule, double x, double y, double s, double factor, double u[3])
{
  const double r = hypot(x, y), t = r / s,
               radial = r > 0 ? Enclosed(t) / (2 * PETSC_PI * r * r * r) : 0; /* over (x, y) */

  u[0] += factor * BesselOf(rule, 0.5 * t * t, PETSC_FALSE) / (2 * PETSC_PI * s * s);
  u[1] += factor * x * radial;
  u[2] += factor * y * radial;
}

/* Returns the integral of 1 - exp(-w) I0(w) over the angle of the triangle with the sides a, b > 0 at a right angle. */
static double Triangle(const Rule *rule, double a, double b, double s)
{
  const double length = asinh(b / a);
  const int    panels = 1 + (int)length;
  double       sum    = 0;

  for (int panel = 0; panel < panels; panel++)
    for (int k = 0; k < POINTS; k++) {
      const double ray = cosh((panel + rule->x[k]) * length / panels), t = a * ray / s;

      sum += rule->w[k] * length / panels * (1 - BesselOf(rule, 0.5 * t * t, PETSC_TRUE)) / ray;
    }
  return sum;
}

/* Returns the integral of the heat's u_out over the rectangle between the origin and (a, b); odd in both. */
static double Corner(const Rule *rule, double a, double b, double s)
{
  const double x = fabs(a), y = fabs(b), sign = (a < 0) != (b < 0) ? -1 : 1;

  if (!(x > 0) || !(y > 0)) return 0;
  return sign * (Triangle(rule, x, y, s) + Triangle(rule, y, x, s)) / (2 * PETSC_PI);
}

/* Returns the integral of erf(r/s)/(2 pi r) along a line at the distance d, from the place `from` to `to` on it. */
static double Side(const Rule *rule, double d, double from, double to, double s)
{
  const double scale = hypot(d, s), first = asinh(from / scale), length = asinh(to / scale) - first;
  const int    panels = 1 + (int)length;
  double       sum    = 0;

  for (int panel = 0; panel < panels; panel++)
    for (int k = 0; k < POINTS; k++) {
      const double t = first + (panel + rule->x[k]) * length / panels, r = hypot(d, scale * sinh(t));
      const double value = r > 1e-8 * s ? erf(r / s) / r : 2 / (sqrt(PETSC_PI) * s);

      sum += rule->w[k] * length / panels * scale * cosh(t) * value;
    }
  return sum / (2 * PETSC_PI);
}

/* Adds the displacements by heat on the cell, whose centre is at the distance (x, y). */
static void AddCell(const Rule *rule, const Source *h, double x, double y, double s, double factor, double u[3])
{
  const double a = h->half[0], b = h->half[1];

  if (s > SPREAD * PetscMax(a, b)) {
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        AddPoint(rule, x - a * rule->x3[i], y - b * rule->x3[j], s, factor * a * b * rule->w3[i] * rule->w3[j], u);
    return;
  }
  u[0] += factor * (Corner(rule, x + a, y + b, s) - Corner(rule, x - a, y + b, s) - Corner(rule, x + a, y - b, s) +
                    Corner(rule, x - a, y - b, s));
  u[1] += factor * (Side(rule, x - a, y - b, y + b, s) - Side(rule, x + a, y - b, y + b, s));
  u[2] += factor * (Side(rule, y - b, x - a, x + a, s) - Side(rule, y + b, x - a, x + a, s));
}

/* ---- all ages ---- */

/* Finds the borders of the panels for n edges at the distances x, and n at the distances y; returns their number. */
static PetscInt FindBorders(const Source *h, PetscInt n, const double x[], const double y[], double least, double end,
                            double borders[BORDERS])
{
  static const double values[] = {0, 0.5, 1.3, 3, 6.5};
  PetscInt            count    = 0;

  borders[count++] = 0;
  for (PetscInt k = 0; k < n; k++)
    for (size_t v = 0; v < sizeof(values) / sizeof(*values); v++)
      for (int sign = -1; sign <= 1; sign += 2) {
        SamHeatAddRoots(h->p, x[k], sign * values[v], end, &count, borders);
        SamHeatAddRoots(0, y[k], sign * values[v], end, &count, borders);
      }
  for (PetscInt k = 0; k < n; k++)
    for (double m = 13; m < FAR && m * m < 4 * h->p * fabs(x[k]); m *= 2)
      for (int sign = -1; sign <= 1; sign += 2) SamHeatAddRoots(h->p, x[k], sign * m, end, &count, borders);
  for (double s = least; s < end && count < BORDERS - 1; s *= 2) borders[count++] = s;
  borders[count++] = end;
  SamHeatSort(count, borders);
  return count;
}

/* Computes the displacements over c at the distance (x, y), by heat on the cell, or with `cell` false by unit heat in
   a point. */
static void Integrate(const Rule *rule, const Source *h, double x, double y, PetscBool cell, double u[3])
{
  const double a = cell ? h->half[0] : 0, b = cell ? h->half[1] : 0, xs[] = {x - a, x + a}, ys[] = {y - b, y + b};
  const double least = PetscMin(cell ? PetscMin(a, b) / 8 : hypot(x, y) / 4, /* and until the heat has moved that far */
                                0.25 * sqrt(2 * (cell ? a : hypot(x, y)) / h->p)),
               end   = (FAR + sqrt((double)FAR * FAR + 2 * h->p * (fabs(x) + a))) / h->p;
  double         borders[BORDERS];
  const PetscInt n = FindBorders(h, cell ? 2 : 1, xs, ys, least, end, borders);

  u[0] = u[1] = u[2] = 0;
  for (PetscInt p = 0; p < n - 1; p++) {
    const double width = borders[p + 1] - borders[p];

    for (int k = 0; k < POINTS && width > 0; k++) {
      const double s = borders[p] + width * rule->x[k], factor = width * rule->w[k] * s, at = x + 0.5 * h->p * s * s;

      if (cell)
        AddCell(rule, h, at, y, s, factor, u);
      else
        AddPoint(rule, at, y, s, factor, u);
    }
  }
}

/* ---- a body that stands ---- */

/* Returns the integral of ln r over the rectangle between the origin and (a, b); odd in both. */
static double LogCorner(double a, double b, double radius)
{
  const double r = hypot(a, b);

  if (a == 0 || b == 0) return 0;
  return a * b * (log(r / radius) - 1.5) + 0.5 * (a * a * atan(b / a) + b * b * atan(a / b));
}

/* Returns the integral of x/r over the rectangle between the origin and (a, b), whose derivative by a and b it is. */
static double SlopeCorner(double a, double b)
{
  const double x = fabs(a);

  return 0.5 * (b * hypot(a, b) + (x > 0 ? x * x * asinh(b / x) : 0));
}

static void Closed(const Source *h, double x, double y, double u[3])
{
  u[0] = u[1] = u[2] = 0;
  for (int i = -1; i <= 1; i += 2)
    for (int j = -1; j <= 1; j += 2) {
      const double a = x + i * h->half[0], b = y + j * h->half[1], sign = i * j / (2 * PETSC_PI);

      u[0] -= sign * LogCorner(a, b, h->radius);
      u[1] += sign * SlopeCorner(a, b);
      u[2] += sign * SlopeCorner(b, a);
    }
}

/* ---- rows of lags ---- */

struct _n_SamExpansionTable {
  Source   source;
  Rule     rule;
  double   toward;    /* 1: the material moves to -x, -1: to +x */
  PetscInt n;         /* lags -n ... n of points */
  PetscInt row[3];    /* of the points in the memory; -1: none */
  double  *points[3]; /* 3 (2 n + 1) displacements by heat in points */
};

PetscErrorCode SamExpansionTableCreate(const SamHeatBody *body, const PetscReal side[2], const PetscInt n[2],
                                       SamExpansionTable *table)
{
  const double      p = fabs(body->speed) / 2 / body->conductivity * body->capacity;
  PetscReal         x[POINTS], w[POINTS];
  SamExpansionTable t;

  PetscFunctionBegin;
  PetscCall(PetscNew(&t));
  t->source = (Source){
    {0.5 * side[0], 0.5 * side[1]}, p < LEAST_P ? 0 : p, 0.5 * hypot((double)n[0] * side[0], (double)n[1] * side[1])};
  t->toward = body->speed > 0 ? -1 : 1;
  t->n      = n[0];
  PetscCall(PetscDTGaussQuadrature(POINTS, 0, 1, x, w));
  for (int k = 0; k < POINTS; k++) {
    t->rule.x[k] = (double)x[k];
    t->rule.w[k] = (double)w[k];
  }
  PetscCall(PetscDTGaussQuadrature(3, -1, 1, x, w));
  for (int k = 0; k < 3; k++) {
    t->rule.x3[k] = (double)x[k];
    t->rule.w3[k] = (double)w[k];
  }
  FillSeries(&t->rule);
  for (int k = 0; k < 3; k++) {
    t->row[k] = -1;
    if (t->source.p > 0) PetscCall(PetscMalloc1(3 * (2 * n[0] + 1), &t->points[k]));
  }
  *table = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamExpansionTableDestroy(SamExpansionTable *table)
{
  PetscFunctionBegin;
  if (!*table) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) PetscCall(PetscFree((*table)->points[k]));
  PetscCall(PetscFree(*table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the displacements by heat in points in the row j >= 0, from the memory or computed. */
static const double *PointsOf(SamExpansionTable t, PetscInt j)
{
  const Source *h    = &t->source;
  const int     slot = (int)(j % 3);

  if (t->row[slot] == j) return t->points[slot];
  for (PetscInt i = -t->n; i <= t->n; i++) {
    double *u = t->points[slot] + 3 * (i + t->n);

    u[0] = u[1] = u[2] = 0;
    if (i || j) Integrate(&t->rule, h, 2 * h->half[0] * (double)i, 2 * h->half[1] * (double)j, PETSC_FALSE, u);
  }
  t->row[slot] = j;
  return t->points[slot];
}

/* True if the cell at a lag is integrated over: it is near, or behind the source, where the heat is narrow. */
static PetscBool IsNear(const Source *h, PetscInt i, PetscInt j)
{
  const double wide = WIDE * 2 * PetscMax(h->half[0], h->half[1]);

  if (j > NEAR || i > NEAR) return PETSC_FALSE;
  return i >= -NEAR || -4 * (double)i * h->half[0] / h->p < wide * wide ? PETSC_TRUE : PETSC_FALSE;
}

/* Computes the displacements over c at a lag of a body that moves. */
static void AtLag(SamExpansionTable t, PetscInt i, PetscInt j, const double *const rows[3], double u[3])
{
  const Source  *h    = &t->source;
  const double   area = 4 * h->half[0] * h->half[1];
  const PetscInt at   = 3 * (i + t->n);

  if (IsNear(h, i, j)) {
    Integrate(&t->rule, h, 2 * h->half[0] * (double)i, 2 * h->half[1] * (double)j, PETSC_TRUE, u);
    return;
  }
  for (int k = 0; k < 3; k++) {
    const double mine  = rows[1][at + k];
    const double below = j ? rows[0][at + k] : (k == 2 ? -1 : 1) * rows[2][at + k];

    u[k] = area * (mine + (rows[1][at + 3 + k] + rows[1][at - 3 + k] + below + rows[2][at + k] - 4 * mine) / 24);
  }
}

void SamExpansionTableRow(SamExpansionTable t, PetscInt j, double *const even[3], double *const odd[3])
{
  const double *rows[3] = {NULL};

  for (int k = 0; k < 3 && t->source.p > 0; k++)
    if (j + k > 0) rows[k] = PointsOf(t, j + k - 1);
  for (PetscInt i = 0; i < t->n; i++) {
    double ahead[3], behind[3];

    if (t->source.p > 0) {
      AtLag(t, i, j, rows, ahead);
      AtLag(t, -i, j, rows, behind);
    } else {
      Closed(&t->source, 2 * t->source.half[0] * (double)i, 2 * t->source.half[1] * (double)j, ahead);
      behind[0] = ahead[0];
      behind[1] = -ahead[1];
      behind[2] = ahead[2];
    }
    for (int k = 0; k < 3; k++) {
      const double mean = 0.5 * (ahead[k] + behind[k]), half = 0.5 * (ahead[k] - behind[k]);

      /* where the material moves to +x, x and u_x have the other sign */
      even[k][i] = k == 1 ? t->toward * mean : mean;
      odd[k][i]  = k == 1 ? half : t->toward * half;
    }
  }
}
