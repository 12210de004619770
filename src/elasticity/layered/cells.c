/*
  Integrals of the radial functions over cells, by Gauss' quadrature; and the tables of a pair.

  The functions are smooth on the scale of R, R^2 = r^2 + depth^2, where they behave like those of such an image. With
  R in units of the longer side:
    R < 8     parts of the cell, halved or quartered until half their diagonal is below R/3.5, 8 x 8 points each
    R < 45    the whole cell, 5 x 5 points as far as 13, then 4 x 4
    beyond    3 rows of points across the cell, 2 from 640 on; along x the mean over a cell is that of the values at the
              centres of seven cells, by central differences: (d/2)/asinh(d/2) = 1 + d^2/24 - 17 d^4/5760 + ...
  For an image, whose integral is known, this is 1e-13 of each value.
*/
#include <petsam/private/layered.h>
#include <petscdt.h>

#define CHUNK   512 /* lags that are worked off together */
#define STENCIL 3   /* cells to each side */
#define DEEPEST 60  /* divisions of a cell; a depth of 1e-18 cells */
#define POINTS  8

typedef struct {
  PetscReal x[POINTS], w[POINTS]; /* on (-1/2, 1/2) */
} Rule;

/* Gauss' rules of 0 to POINTS points, filled by SamLayeredCreate(). */
static Rule rules[POINTS + 1];

/* The values of a kernel at (x[i], y), i < n <= CHUNK + 2 STENCIL, times the weight, added. */
static void AddPoints(SamLayered l, SamIntegral kind, double weight, PetscInt n, const double x[], double y,
                      double values[])
{
  static const SamRadial function[] = {SAM_RADIAL_N, SAM_RADIAL_A, SAM_RADIAL_A,
                                       SAM_RADIAL_B, SAM_RADIAL_C, SAM_RADIAL_C};
  const double           sign       = kind == SAM_INTEGRAL_XX ? weight : -weight;
  double                 s[CHUNK + 2 * STENCIL], f[CHUNK + 2 * STENCIL];

  for (PetscInt i = 0; i < n; i++) s[i] = x[i] * x[i] + y * y;
  SamSplineRow(&l->radial, function[kind], n, s, f);
  for (PetscInt i = 0; i < n; i++)
    values[i] += weight * f[i] *
                 (kind < SAM_INTEGRAL_XY    ? 1
                  : kind == SAM_INTEGRAL_XY ? 2 * x[i] * y
                  : kind == SAM_INTEGRAL_X  ? x[i]
                                            : y);
  if (kind != SAM_INTEGRAL_XX && kind != SAM_INTEGRAL_YY) return;
  SamSplineRow(&l->radial, SAM_RADIAL_B, n, s, f);
  for (PetscInt i = 0; i < n; i++) values[i] += sign * f[i] * (x[i] * x[i] - y * y);
}

/* The integral over a rectangle of these sides about (x, y), by n x n points. */
static double Integrate(SamLayered l, SamIntegral kind, int n, const double centre[2], const double side[2])
{
  const Rule *rule = &rules[n];
  double      x[POINTS], values[POINTS] = {0}, sum = 0;

  for (int i = 0; i < n; i++) x[i] = centre[0] + side[0] * rule->x[i];
  for (int j = 0; j < n; j++) AddPoints(l, kind, rule->w[j], n, x, centre[1] + side[1] * rule->x[j], values);
  for (int i = 0; i < n; i++) sum += rule->w[i] * values[i];
  return sum * side[0] * side[1];
}

double SamLayeredRectangle(SamLayered l, SamIntegral kind, int level, const double centre[2], const double side[2])
{
  const double R2       = centre[0] * centre[0] + centre[1] * centre[1] + l->depth * l->depth;
  const int    parts[2] = {side[1] > 2 * side[0] ? 1 : 2, side[0] > 2 * side[1] ? 1 : 2};
  double       sum      = 0;

  if (level == DEEPEST || 3.5 * 3.5 / 4 * (side[0] * side[0] + side[1] * side[1]) < R2)
    return Integrate(l, kind, POINTS, centre, side);
  for (int k = 0; k < parts[0] * parts[1]; k++) {
    const double part[2] = {side[0] / parts[0], side[1] / parts[1]};
    const double at[2]   = {centre[0] + (k % parts[0] - 0.5 * (parts[0] - 1)) * part[0],
                            centre[1] + (k / parts[0] - 0.5 * (parts[1] - 1)) * part[1]};

    sum += SamLayeredRectangle(l, kind, level + 1, at, part);
  }
  return sum;
}

/* The first lag of a row whose R, in units of the longer side, is that at least; at most n. */
static PetscInt FirstBeyond(SamLayered l, double R, const double side[2], PetscInt j, PetscInt n)
{
  const double far = R * PetscMax(side[0], side[1]), y = (double)j * side[1],
               x2 = far * far - y * y - l->depth * l->depth;

  return x2 <= 0 ? 0 : (PetscInt)PetscMin(ceil(sqrt(x2) / side[0]), (double)n);
}

/* Lags first ... end - 1 of a row, by this many rows of points across a cell. */
static void AddFar(SamLayered l, SamIntegral kind, int across, const double side[2], PetscInt j, PetscInt first,
                   PetscInt end, double values[])
{
  static const double weights[] = {1 - 2.0 / 24 - 17 * 6.0 / 5760 - 367 * 20.0 / 967680,
                                   1.0 / 24 + 17 * 4.0 / 5760 + 367 * 15.0 / 967680, -17.0 / 5760 - 367 * 6.0 / 967680,
                                   367.0 / 967680};
  const Rule         *rule      = &rules[across];
  double              x[CHUNK + 2 * STENCIL], f[CHUNK + 2 * STENCIL];

  for (PetscInt start = first; start < end; start += CHUNK) {
    const PetscInt n = PetscMin(CHUNK, end - start);

    for (PetscInt i = 0; i < n + 2 * STENCIL; i++) {
      x[i] = (double)(start + i - STENCIL) * side[0];
      f[i] = 0;
    }
    for (int b = 0; b < across; b++)
      AddPoints(l, kind, side[0] * side[1] * rule->w[b], n + 2 * STENCIL, x, ((double)j + rule->x[b]) * side[1], f);
    for (PetscInt i = 0; i < n; i++) {
      values[start + i] += weights[0] * f[i + STENCIL];
      for (int k = 1; k <= STENCIL; k++) values[start + i] += weights[k] * (f[i + STENCIL - k] + f[i + STENCIL + k]);
    }
  }
}

void SamLayeredAddRow(SamLayered l, SamIntegral kind, double dx, double dy, PetscInt j, PetscInt n, double values[])
{
  const double   side[2] = {dx, dy};
  const PetscInt parts = FirstBeyond(l, 8, side, j, n), fifth = FirstBeyond(l, 13, side, j, n),
                 fourth = FirstBeyond(l, 45, side, j, n), third = FirstBeyond(l, 640, side, j, n);

  for (PetscInt i = 0; i < fourth; i++) {
    const double centre[2] = {(double)i * dx, (double)j * dy};

    values[i] +=
      i < parts ? SamLayeredRectangle(l, kind, 0, centre, side) : Integrate(l, kind, i < fifth ? 5 : 4, centre, side);
  }
  AddFar(l, kind, 3, side, j, fourth, third, values);
  AddFar(l, kind, 2, side, j, third, n, values);
}

void SamLayeredAddSlopeRow(SamLayered l, int axis, double dx, double dy, PetscInt j, PetscInt n, double values[])
{
  const Rule *rule = &rules[3];
  double      x[CHUNK];

  for (PetscInt start = 0; start < n; start += CHUNK)
    for (int k = 0; k < 9; k++) {
      const int      a = k % 3, b = k / 3;
      const PetscInt count = PetscMin(CHUNK, n - start);

      for (PetscInt i = 0; i < count; i++) x[i] = ((double)(start + i) - rule->x[a]) * dx;
      AddPoints(l, SAM_INTEGRAL_R, dx * dy * rule->w[a] * rule->w[b] * rule->x[axis ? b : a], count, x,
                ((double)j - rule->x[b]) * dy, values + start);
    }
}

/* ---- the tables ---- */

PetscErrorCode SamLayeredCreate(const SamPair *pair, SamLayered *layered)
{
  PetscFunctionBegin;
  for (PetscInt n = 2; n <= POINTS; n++) PetscCall(PetscDTGaussQuadrature(n, -0.5, 0.5, rules[n].x, rules[n].w));
  PetscCall(PetscNew(layered));
  (*layered)->references = 1;
  (*layered)->pair       = *pair;
  (*layered)->depth      = PETSC_INFINITY;
  for (PetscInt b = 0; b < 2; b++)
    if (pair->layers[b].count)
      (*layered)->depth = PetscMin((*layered)->depth, 2 * (double)pair->layers[b].thickness[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLayeredReference(SamLayered from, SamLayered *to)
{
  PetscFunctionBegin;
  if (from) from->references++;
  PetscCall(SamLayeredDestroy(to));
  *to = from;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLayeredDestroy(SamLayered *layered)
{
  SamLayered l = *layered;

  PetscFunctionBegin;
  *layered = NULL;
  if (!l || --l->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSplineDestroy(&l->symbols));
  PetscCall(SamSplineDestroy(&l->radial));
  PetscCall(PetscFree(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void SymbolsAt(const void *context, double k2, double values[])
{
  double difference[SAM_LAYERED_SYMBOLS];

  SamLayeredSymbols(&((SamLayered)context)->pair, 0, sqrt(k2), values, difference);
}

PetscErrorCode SamLayeredPrepare(SamLayered l, double r, const double k[2])
{
  const double room = 4; /* for coarser grids, whose lags and waves may be a little longer */

  PetscFunctionBegin;
  if (r > 0 && !(r * r <= l->radial.most)) {
    PetscCall(SamSplineDestroy(&l->radial));
    PetscCall(SamRadialCreate(&l->pair, l->depth, room * r, &l->radial));
  }
  if (k[1] > 0 && (!l->symbols.intervals || k[0] * k[0] < l->symbols.least || k[1] * k[1] > l->symbols.most)) {
    const double ends[2] = {l->symbols.intervals ? PetscMin(sqrt(l->symbols.least), k[0]) : k[0],
                            PetscMax(sqrt(l->symbols.most), k[1])};

    PetscCall(SamSplineDestroy(&l->symbols));
    PetscCall(SamSplineCreate(&l->symbols, SAM_LAYERED_SYMBOLS, ends[0] * ends[0] / (room * room),
                              room * room * ends[1] * ends[1], SymbolsAt, l));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
