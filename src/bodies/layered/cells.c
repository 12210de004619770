/*
  Integrals of the radial functions over cells by Gauss quadrature, and the tables of a pair.

  The functions are smooth on the scale of R, R^2 = r^2 + depth^2, like those of an image at that depth. With R in units
  of the longer side:
    R < 8     parts of the cell, halved or quartered until half their diagonal is below R/3.5, 8 x 8 points each
    R < 45    the whole cell, 5 x 5 points as far as 13, then 4 x 4
    beyond    3 rows of points across the cell, 2 from 640 on; along x the mean over a cell is that of the values at the
              centres of seven cells, by central differences: (d/2)/asinh(d/2) = 1 + d^2/24 - 17 d^4/5760 + ...
  For an image, whose integral is known, the relative error is 1e-13.
*/
#include "layered.h"
#include <petsam/private/body.h>
#include <petscdt.h>

#define CHUNK   512 /* number of lags processed together */
#define STENCIL 3   /* cells to each side */
#define DEEPEST 60  /* largest number of divisions of a cell, for a depth of 1e-18 cells */
#define POINTS  8

typedef struct {
  PetscReal x[POINTS], w[POINTS]; /* on (-1/2, 1/2) */
} Rule;

/* Gauss rules of 0 to POINTS points, filled by SamRadialSetUp() */
static Rule rules[POINTS + 1];

/* Adds the values of kernels at (x[i], y), i < n <= CHUNK + 2 STENCIL, times the weight. */
static void AddPoints(const SamRadialKernels *of, double weight, PetscInt n, const double x[], double y,
                      double *const values[])
{
  /* Coefficients of x^0 to x^3 of the polynomials. */
  const double polynomials[][4] = {[SAM_ANGULAR_1]   = {1},
                                   [SAM_ANGULAR_X]   = {0, 1},
                                   [SAM_ANGULAR_Y]   = {y},
                                   [SAM_ANGULAR_XX]  = {-y * y, 0, 1},
                                   [SAM_ANGULAR_XY]  = {0, 2 * y},
                                   [SAM_ANGULAR_XXX] = {0, -3 * y * y, 0, 1},
                                   [SAM_ANGULAR_YYY] = {-y * y * y, 0, 3 * y}};
  double       s[CHUNK + 2 * STENCIL], f[CHUNK + 2 * STENCIL];

  for (PetscInt i = 0; i < n; i++) s[i] = x[i] * x[i] + y * y;
  for (int t = 0; t < of->count; t++) {
    const SamRadialTerm term = of->terms[t];
    const double       *c = polynomials[term.angular], w = weight * term.factor;
    double             *to = values[term.kernel];

    if (!t || term.function != of->terms[t - 1].function) SamSplineRow(of->table, term.function, n, s, f);
    for (PetscInt i = 0; i < n; i++) to[i] += w * f[i] * (((c[3] * x[i] + c[2]) * x[i] + c[1]) * x[i] + c[0]);
  }
}

/* Adds the integrals over a rectangle of these sides about (x, y), by n x n points. */
static void Integrate(const SamRadialKernels *of, int n, const double centre[2], const double side[2], double sums[])
{
  const Rule *rule = &rules[n];
  double      x[POINTS], values[SAM_RADIAL_KERNELS][POINTS] = {{0}};

  for (int i = 0; i < n; i++) x[i] = centre[0] + side[0] * rule->x[i];
  for (int j = 0; j < n; j++)
    AddPoints(of, rule->w[j], n, x, centre[1] + side[1] * rule->x[j], (double *[]){values[0], values[1], values[2]});
  for (int k = 0; k < of->kernels; k++)
    for (int i = 0; i < n; i++) sums[k] += rule->w[i] * values[k][i] * side[0] * side[1];
}

/* Adds the integrals over a rectangle, which is divided if it is near; `level` of the division: 0 at first. */
static void AddRectangle(const SamRadialKernels *of, int level, const double centre[2], const double side[2],
                         double sums[])
{
  const double R2       = centre[0] * centre[0] + centre[1] * centre[1] + of->depth * of->depth;
  const int    parts[2] = {side[1] > 2 * side[0] ? 1 : 2, side[0] > 2 * side[1] ? 1 : 2};

  if (level == DEEPEST || 3.5 * 3.5 / 4 * (side[0] * side[0] + side[1] * side[1]) < R2) {
    Integrate(of, POINTS, centre, side, sums);
    return;
  }
  for (int k = 0; k < parts[0] * parts[1]; k++) {
    const double part[2] = {side[0] / parts[0], side[1] / parts[1]};
    const double at[2]   = {centre[0] + (k % parts[0] - 0.5 * (parts[0] - 1)) * part[0],
                            centre[1] + (k / parts[0] - 0.5 * (parts[1] - 1)) * part[1]};

    AddRectangle(of, level + 1, at, part, sums);
  }
}

/* Returns the first lag of a row with at least this R, in units of the longer side; at most n. */
static PetscInt FirstBeyond(double depth, double R, const double side[2], PetscInt j, PetscInt n)
{
  const double far = R * PetscMax(side[0], side[1]), y = (double)j * side[1], x2 = far * far - y * y - depth * depth;

  return x2 <= 0 ? 0 : (PetscInt)PetscMin(ceil(sqrt(x2) / side[0]), (double)n);
}

/* Adds the integrals at lags first ... end - 1 of a row, by this many rows of points across a cell. */
static void AddFar(const SamRadialKernels *of, int across, const double side[2], PetscInt j, PetscInt first,
                   PetscInt end, double *const values[])
{
  static const double weights[] = {1 - 2.0 / 24 - 17 * 6.0 / 5760 - 367 * 20.0 / 967680,
                                   1.0 / 24 + 17 * 4.0 / 5760 + 367 * 15.0 / 967680, -17.0 / 5760 - 367 * 6.0 / 967680,
                                   367.0 / 967680};
  const Rule         *rule      = &rules[across];
  double              x[CHUNK + 2 * STENCIL], sums[SAM_RADIAL_KERNELS][CHUNK + 2 * STENCIL];

  for (PetscInt start = first; start < end; start += CHUNK) {
    const PetscInt n = PetscMin(CHUNK, end - start);

    for (PetscInt i = 0; i < n + 2 * STENCIL; i++) {
      x[i] = (double)(start + i - STENCIL) * side[0];
      for (int k = 0; k < of->kernels; k++) sums[k][i] = 0;
    }
    for (int b = 0; b < across; b++)
      AddPoints(of, side[0] * side[1] * rule->w[b], n + 2 * STENCIL, x, ((double)j + rule->x[b]) * side[1],
                (double *[]){sums[0], sums[1], sums[2]});
    for (int k = 0; k < of->kernels; k++)
      for (PetscInt i = 0; i < n; i++) {
        const double *const f = &sums[k][i + STENCIL];

        values[k][start + i] += weights[0] * f[0];
        for (int m = 1; m <= STENCIL; m++) values[k][start + i] += weights[m] * (f[-m] + f[m]);
      }
  }
}

void SamRadialAddRow(const SamRadialKernels *of, const double side[2], PetscInt j, PetscInt n, double *const values[])
{
  const PetscInt parts = FirstBeyond(of->depth, 8, side, j, n), fifth = FirstBeyond(of->depth, 13, side, j, n),
                 fourth = FirstBeyond(of->depth, 45, side, j, n), third = FirstBeyond(of->depth, 640, side, j, n);

  for (PetscInt i = 0; i < fourth; i++) {
    const double centre[2]                = {(double)i * side[0], (double)j * side[1]};
    double       sums[SAM_RADIAL_KERNELS] = {0};

    if (i < parts)
      AddRectangle(of, 0, centre, side, sums);
    else
      Integrate(of, i < fifth ? 5 : 4, centre, side, sums);
    for (int k = 0; k < of->kernels; k++) values[k][i] += sums[k];
  }
  AddFar(of, 3, side, j, fourth, third, values);
  AddFar(of, 2, side, j, third, n, values);
}

/* Adds the integrals of kernels over an interval, halved until it is short compared with the distance of the images. */
static void AddInterval(const SamRadialKernels *of, double x, double length, double sums[])
{
  const double half = length / 2;
  double       at[POINTS], values[SAM_RADIAL_KERNELS][POINTS] = {{0}};

  if (length > 0.7 * hypot(x, of->depth / 2)) {
    AddInterval(of, x - half / 2, half, sums);
    AddInterval(of, x + half / 2, half, sums);
    return;
  }
  for (int i = 0; i < POINTS; i++) at[i] = x + length * rules[POINTS].x[i];
  AddPoints(of, length, POINTS, at, 0, (double *[]){values[0], values[1], values[2]});
  for (int k = 0; k < of->kernels; k++)
    for (int i = 0; i < POINTS; i++) sums[k] += rules[POINTS].w[i] * values[k][i];
}

void SamRadialAddLine(const SamRadialKernels *of, double side, PetscInt n, double *const values[])
{
  for (PetscInt i = 0; i < n; i++) {
    double sums[SAM_RADIAL_KERNELS] = {0};

    AddInterval(of, (double)i * side, side, sums);
    for (int k = 0; k < of->kernels; k++) values[k][i] += sums[k];
  }
}

/* ---- the surface ---- */

/* Returns the kernel of displacements that has this integral for half-spaces. */
static SamRadialKernels SurfaceKernel(SamLayered l, SamIntegral kind)
{
  static const SamRadialTerm terms[][2] = {
    [SAM_INTEGRAL_R]  = {{SAM_RADIAL_N, 0, SAM_ANGULAR_1, 1}},
    [SAM_INTEGRAL_XX] = {{SAM_RADIAL_A, 0, SAM_ANGULAR_1, 1}, {SAM_RADIAL_B, 0, SAM_ANGULAR_XX, 1}},
    [SAM_INTEGRAL_YY] = {{SAM_RADIAL_A, 0, SAM_ANGULAR_1, 1}, {SAM_RADIAL_B, 0, SAM_ANGULAR_XX, -1}},
    [SAM_INTEGRAL_XY] = {{SAM_RADIAL_B, 0, SAM_ANGULAR_XY, 1}},
    [SAM_INTEGRAL_X]  = {{SAM_RADIAL_C, 0, SAM_ANGULAR_X, 1}},
    [SAM_INTEGRAL_Y]  = {{SAM_RADIAL_C, 0, SAM_ANGULAR_Y, 1}},
  };
  const int count = kind == SAM_INTEGRAL_XX || kind == SAM_INTEGRAL_YY ? 2 : 1;

  return (SamRadialKernels){.table = &l->radial, .depth = l->depth, .kernels = 1, .count = count, .terms = terms[kind]};
}

void SamLayeredAddRow(SamLayered l, SamIntegral kind, double dx, double dy, PetscInt j, PetscInt n, double values[])
{
  const SamRadialKernels of = SurfaceKernel(l, kind);

  SamRadialAddRow(&of, (const double[]){dx, dy}, j, n, &values);
}

/* ---- the tables ---- */

PetscErrorCode SamRadialSetUp(void)
{
  PetscFunctionBegin;
  for (PetscInt n = 2; n <= POINTS; n++) PetscCall(PetscDTGaussQuadrature(n, -0.5, 0.5, rules[n].x, rules[n].w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLayeredCreate(SamPair pair, SamLayered *layered)
{
  PetscFunctionBegin;
  PetscCall(SamRadialSetUp());
  PetscCall(PetscNew(layered));
  (*layered)->references = 1;
  (*layered)->depth      = PETSC_INFINITY;
  for (int b = 0; b < 2; b++)
    (*layered)->depth = PetscMin((*layered)->depth, 2 * (double)pair->body[b]->material[0].thickness);
  PetscCall(SamPairReference(pair));
  (*layered)->pair = pair;
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
  PetscCall(SamSplineDestroy(&l->line));
  PetscCall(SamPairDestroy(&l->pair));
  PetscCall(PetscFree(l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the functions of k whose transforms are N, A, B and C from differences of symbols. */
static void Combine(const double symbols[], double g[])
{
  g[SAM_RADIAL_N] = symbols[SAM_WAVE_ZZ];
  g[SAM_RADIAL_A] = 0.5 * (symbols[SAM_WAVE_RR] + symbols[SAM_WAVE_TT]);
  g[SAM_RADIAL_B] = 0.5 * (symbols[SAM_WAVE_TT] - symbols[SAM_WAVE_RR]);
  g[SAM_RADIAL_C] = symbols[SAM_WAVE_ZR];
}

static void DifferencesAt(const void *context, double k, double values[])
{
  double total[SAM_WAVE_SYMBOLS], difference[SAM_WAVE_SYMBOLS];

  SamPairSymbols(((SamLayered)context)->pair, k, total, difference);
  Combine(difference, values);
}

/* Describes a source of these differences, whose images are those of the symbols. */
static SamRadialSource SourceOf(SamLayered l)
{
  SamRadialSource of = {.functions = SAM_WAVE_SYMBOLS, .depth = l->depth, .context = l};

  for (PetscInt b = 0; b < 2; b++) {
    const SamBody body                    = l->pair->body[b];
    double        total[SAM_WAVE_SYMBOLS] = {0};

    of.thickness[b] = (double)SamBodyAt(body, INFINITY).top;
    of.longest      = PetscMax(of.longest, of.thickness[b]);
    SamBodySymbols(body, b ? 1 : -1, SAM_LONG_WAVE / PetscMax(of.thickness[b], l->depth), total, of.image[b]);
  }
  return of;
}

static PetscErrorCode CreateRadial(SamLayered l, double r)
{
  static const int orders[] = {[SAM_RADIAL_N] = 0, [SAM_RADIAL_A] = 0, [SAM_RADIAL_B] = 2, [SAM_RADIAL_C] = 1};
  SamRadialSource  of       = SourceOf(l);

  PetscFunctionBegin;
  of.orders = orders;
  of.values = DifferencesAt;
  for (PetscInt b = 0; b < 2; b++) {
    double limit[SAM_WAVE_SYMBOLS];

    PetscCall(PetscArraycpy(limit, of.image[b], SAM_WAVE_SYMBOLS));
    Combine(limit, of.image[b]);
  }
  PetscCall(SamRadialCreate(&of, r, &l->radial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- lines along y, in plane strain ---- */

/*
  The influence of a line load is the transform of c/k along the line. The images' parts are known, -(c(0)/pi)
  ln(rho/D), relative to a distance D, and (c(0)/pi) atan(x/Z) for zr. The rest of c is of the order k; for waves much
  longer than all layers it is set proportional to k, before rounding matters.
*/
#define PROPORTIONAL 1e-7 /* k times the longest length, below which the rest is proportional */

typedef struct {
  SamLayered      l;
  SamRadialSource of; /* source with the images */
} Rest;

static void RestsAt(const void *context, double k, double values[])
{
  const Rest *rest = (const Rest *)context;
  double      total[SAM_WAVE_SYMBOLS];

  k = PetscMax(k, PROPORTIONAL / rest->of.longest);
  SamPairSymbols(rest->l->pair, k, total, values);
  for (int s = 0; s < SAM_WAVE_SYMBOLS; s++) {
    for (int b = 0; b < 2; b++) values[s] -= rest->of.image[b][s] * exp(-k * rest->of.thickness[b]);
    values[s] /= k;
  }
}

PetscErrorCode SamLayeredPrepareLine(SamLayered l, double r)
{
  static const int orders[] = {[SAM_WAVE_ZZ] = 0, [SAM_WAVE_ZR] = 1, [SAM_WAVE_RR] = 0, [SAM_WAVE_TT] = 0};
  const Rest       rest     = {l, SourceOf(l)};
  /* The images fall like exp(-k Z); Z is at least half the depth. */
  SamRadialSource of = {.functions = SAM_WAVE_SYMBOLS,
                        .line      = PETSC_TRUE,
                        .orders    = orders,
                        .depth     = l->depth / 2,
                        .longest   = rest.of.longest,
                        .thickness = {l->depth / 2},
                        .values    = RestsAt,
                        .context   = &rest};

  PetscFunctionBegin;
  if (r * r <= l->line.most) PetscFunctionReturn(PETSC_SUCCESS);
  RestsAt(&rest, 0, of.image[0]);
  PetscCall(SamSplineDestroy(&l->line));
  PetscCall(SamRadialCreate(&of, 2 * r, &l->line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the integrals of -ln(rho/D) and, odd, of atan(x/Z) over a cell about x. */
static double ImageOver(double x, double dx, double Z, double datum, PetscBool odd)
{
  double sum = 0;

  if (hypot(x, Z) > 2 * dx) { /* terms of the closed form cancel there */
    for (int k = 0; k < POINTS; k++) {
      const double s = x + dx * rules[POINTS].x[k];

      sum += dx * rules[POINTS].w[k] * (odd ? atan(s / Z) : -log(hypot(s, Z) / datum));
    }
    return sum;
  }
  for (int end = -1; end <= 1; end += 2) {
    const double s = x + end * dx / 2, rho = hypot(s, Z), angle = atan(s / Z);

    sum += end * (odd ? s * angle - Z * log(rho / Z) : s - s * log(rho / datum) - Z * angle);
  }
  return sum;
}

void SamLayeredAddLine(SamLayered l, SamWaveSymbol symbol, double dx, double datum, PetscInt n, double values[])
{
  const PetscBool        odd    = symbol == SAM_WAVE_ZR;
  const SamRadialSource  images = SourceOf(l);
  const SamRadialTerm    term   = {symbol, 0, odd ? SAM_ANGULAR_X : SAM_ANGULAR_1, 1};
  const SamRadialKernels of     = {.table = &l->line, .depth = l->depth / 2, .kernels = 1, .count = 1, .terms = &term};

  SamRadialAddLine(&of, dx, n, &values);
  for (int b = 0; b < 2; b++)
    for (PetscInt i = 0; i < n && images.image[b][symbol] != 0; i++)
      values[i] += images.image[b][symbol] / PETSC_PI * ImageOver((double)i * dx, dx, images.thickness[b], datum, odd);
}

static void SymbolsAt(const void *context, double k2, double values[])
{
  double difference[SAM_WAVE_SYMBOLS];

  SamPairSymbols(((SamLayered)context)->pair, sqrt(k2), values, difference);
}

PetscErrorCode SamLayeredPrepare(SamLayered l, double r, const double k[2])
{
  const double room = 4; /* for coarser grids, whose lags and waves may be slightly longer */

  PetscFunctionBegin;
  if (r > 0 && !(r * r <= l->radial.most)) {
    PetscCall(SamSplineDestroy(&l->radial));
    PetscCall(CreateRadial(l, room * r));
  }
  if (k[1] > 0 && (!l->symbols.intervals || k[0] * k[0] < l->symbols.least || k[1] * k[1] > l->symbols.most)) {
    const double ends[2] = {l->symbols.intervals ? PetscMin(sqrt(l->symbols.least), k[0]) : k[0],
                            PetscMax(sqrt(l->symbols.most), k[1])};

    PetscCall(SamSplineDestroy(&l->symbols));
    PetscCall(SamSplineCreate(&l->symbols, SAM_WAVE_SYMBOLS, ends[0] * ends[0] / (room * room),
                              room * room * ends[1] * ends[1], SymbolsAt, l));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
