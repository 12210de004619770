/*
  Stresses on the surface at the edge of contact.

  The largest tension of a sliding contact lies there, with an infinite slope on both sides: values at the centres of
  cells converge to it like the square root of the cell's width. At a point on the reconstructed edge:
    1. Within BLOCK cells in each direction the pressure is the root of the quadratic function from which the edge was
       reconstructed, and in each cell the shear has its ratio to the pressure. In polar coordinates about the point the
       kernels of a point force, of degree -2, and the root of the distance leave an integrand that is smooth in the
       root of the radius.
    2. The contribution of cells outside of this block is smooth there. At the centres of the nine cells about the point
       it is the stress of the map minus the part of the block's cells, computed with the map's own kernels; it is
       interpolated to the point.
  The kernels are those of Boussinesq and Cerruti on the surface (Johnson 1985, Contact Mechanics, sections 3.2, 3.6).
  In plane strain they are of degree -1, and there are two directions: the integrals along them are the same.
*/
#include <petsam/private/rows.h>
#include <petsam/private/edges.h>
#include <petsam/private/halfspace.h>
#include <petscdt.h>
#include <math.h>

#define BLOCK  5   /* half width of the block in cells */
#define RAYS   720 /* directions of the polar coordinates */
#define POINTS 12  /* points along each direction */

enum { XX, YY, XY, PLANE = 3 };
enum { LAGS = BLOCK + 2, NODES = 9 };

/* The map about this rank's rows, and the data that all points share */
typedef struct {
  SamGrid   grid;
  double    poisson, kernel[SAM_STRESS_TRACTIONS][PLANE][LAGS][LAGS]; /* kernels at the lags */
  PetscReal x[POINTS], w[POINTS];                                     /* Gauss rule on (0, 1) */
  SamHalo   seen;
} Map;

static PetscErrorCode CreateMap(SamGrid grid, PetscReal poisson, Vec field, Map *m)
{
  const SamHalfSpaceSource source = {{(double)grid->area[0], (double)grid->area[1]}, 0, (double)poisson};

  PetscFunctionBegin;
  *m = (Map){.grid = grid, .poisson = (double)poisson};
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++)
    for (PetscInt j = 0; j < LAGS; j++) {
      double *const to[] = {m->kernel[t][XX][j], m->kernel[t][YY][j], m->kernel[t][XY][j]};

      SamHalfSpaceStressRow(&source, (SamStressGroup)(SAM_STRESS_PLANE_P + t), j, LAGS, to);
    }
  PetscCall(PetscDTGaussQuadrature(POINTS, 0, 1, m->x, m->w));
  PetscCall(SamHaloBegin(grid, field, SAM_STRESS_COMPONENTS, BLOCK + 1, PETSC_FALSE, &m->seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Returns a traction in a cell as it acts on the body, which is minus the stress zz, xz or yz on the surface; 0 outside.
*/
static double TractionAt(const Map *m, PetscInt t, PetscInt i, PetscInt j)
{
  static const SamStressComponent components[] = {SAM_STRESS_ZZ, SAM_STRESS_XZ, SAM_STRESS_YZ};

  return -SamHaloAt(&m->seen, components[t], i, j);
}

/* Returns the kernel at a lag of any sign. */
static double KernelAt(const Map *m, PetscInt t, PetscInt c, PetscInt i, PetscInt j)
{
  const PetscBool *odd  = SamStressOdd[SAM_STRESS_PLANE_P + t][c];
  const double     sign = (i < 0 && odd[0] ? -1 : 1) * (j < 0 && odd[1] ? -1 : 1);

  return sign * m->kernel[t][c][PetscAbsInt(j)][PetscAbsInt(i)];
}

/* Computes the stress by the cells outside the block about cell (i, j), at the centre of cell (i + a, j + b). */
static void OutsideOf(const Map *m, PetscInt i, PetscInt j, PetscInt a, PetscInt b, double stress[PLANE])
{
  static const SamStressComponent components[] = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY};
  const ptrdiff_t                 k            = (ptrdiff_t)(j + b - m->seen.rows.first) * m->grid->nx + i + a;

  for (int c = 0; c < PLANE; c++) stress[c] = m->seen.at[components[c]][k];
  for (PetscInt y = -BLOCK; y <= BLOCK; y++)
    for (PetscInt x = -BLOCK; x <= BLOCK; x++)
      for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) {
        const double traction = TractionAt(m, t, i + x, j + y);

        for (int c = 0; c < PLANE && traction != 0; c++) stress[c] -= KernelAt(m, t, c, a - x, b - y) * traction;
      }
}

/* Adds the part of the cells outside of the block: interpolated by parabolas in x and y, places in cells. */
static void AddOutside(const Map *m, PetscInt i, PetscInt j, const double at[2], double stress[PLANE])
{
  for (PetscInt b = -1; b <= 1; b++)
    for (PetscInt a = -1; a <= 1; a++) {
      const PetscInt side[2] = {a, b};
      double         weight  = 1, part[PLANE];

      for (int d = 0; d < 2; d++) weight *= side[d] == 0 ? 1 - at[d] * at[d] : 0.5 * at[d] * (at[d] + (double)side[d]);
      if (weight == 0) continue;
      OutsideOf(m, i, j, a, b, part);
      for (int c = 0; c < PLANE; c++) stress[c] += weight * part[c];
    }
}

/*
  Computes the stresses at a point by unit tractions at another point in the direction -e from it, |e| = 1, times the
  squared distance.
*/
static void PointKernels(double nu, const double e[2], double k[SAM_STRESS_TRACTIONS][PLANE])
{
  const double x = e[0], y = e[1], xx = x * x, yy = y * y;

  k[SAM_STRESS_P][XX]  = (1 - 2 * nu) * (xx - yy) / (2 * PETSC_PI);
  k[SAM_STRESS_P][YY]  = -k[SAM_STRESS_P][XX];
  k[SAM_STRESS_P][XY]  = (1 - 2 * nu) * 2 * x * y / (2 * PETSC_PI);
  k[SAM_STRESS_QX][XX] = -x * (1 + nu - 3 * nu * yy) / PETSC_PI;
  k[SAM_STRESS_QX][YY] = -3 * nu * x * yy / PETSC_PI;
  k[SAM_STRESS_QX][XY] = -y * (1 - 2 * nu + 6 * nu * xx) / (2 * PETSC_PI);
  k[SAM_STRESS_QY][XX] = -3 * nu * y * xx / PETSC_PI;
  k[SAM_STRESS_QY][YY] = -y * (1 + nu - 3 * nu * xx) / PETSC_PI;
  k[SAM_STRESS_QY][XY] = -x * (1 - 2 * nu + 6 * nu * yy) / (2 * PETSC_PI);
}

/* Computes the stresses by unit tractions on a line along y in the same way, times the distance. */
static void LineKernels(double nu, const double e[2], double k[SAM_STRESS_TRACTIONS][PLANE])
{
  for (int t = 0; t < SAM_STRESS_TRACTIONS; t++)
    for (int c = 0; c < PLANE; c++) k[t][c] = 0;
  k[SAM_STRESS_QX][XX] = -2 * e[0] / PETSC_PI;
  k[SAM_STRESS_QX][YY] = nu * k[SAM_STRESS_QX][XX];
  k[SAM_STRESS_QY][XY] = -e[0] / PETSC_PI;
}

/* A ray from the point, in cells: its direction, its end at the block's border, and the function b r + c r^2 along
   it */
typedef struct {
  double direction[2], end, b, c;
} Ray;

static Ray MakeRay(const PetscReal fit[6], const double at[2], double angle)
{
  const double x = cos(angle), y = sin(angle), reach = BLOCK + 0.5;
  Ray          ray = {.direction = {x, y}, .end = INFINITY};

  for (int d = 0; d < 2; d++)
    if (ray.direction[d] != 0)
      ray.end = PetscMin(ray.end, (reach - at[d] * copysign(1, ray.direction[d])) / fabs(ray.direction[d]));
  ray.b = (fit[1] + 2 * fit[3] * at[0] + fit[4] * at[1]) * x + (fit[2] + 2 * fit[5] * at[1] + fit[4] * at[0]) * y;
  ray.c = fit[3] * x * x + fit[4] * x * y + fit[5] * y * y;
  return ray;
}

/*
  Computes the integrals of the tractions over the radius along a ray; `like`: ratios to p used in cells without
  pressure.
*/
static void AlongRay(const Map *m, const Ray *ray, PetscInt i, PetscInt j, const double at[2], const double like[],
                     double sums[SAM_STRESS_TRACTIONS])
{
  const double turn  = ray->c != 0 ? -ray->b / ray->c : -1; /* place where the function changes its sign */
  const double begin = ray->b > 0 ? 0 : turn, end = ray->b > 0 && turn > 0 ? PetscMin(turn, ray->end) : ray->end;
  const double low = sqrt(PetscMax(begin, 0)), length = sqrt(end) - low;

  for (int t = 0; t < SAM_STRESS_TRACTIONS; t++) sums[t] = 0;
  if ((ray->b <= 0 && !(turn > 0)) || !(length > 0)) return;
  for (int n = 0; n < POINTS; n++) {
    const double   s = low + length * m->x[n], r = s * s;
    const double   value = 2 * length * m->w[n] * sqrt(PetscMax(ray->b + ray->c * r, 0));
    const PetscInt x     = i + (PetscInt)floor(at[0] + r * ray->direction[0] + 0.5),
                   y     = j + (PetscInt)floor(at[1] + r * ray->direction[1] + 0.5);
    const double p       = TractionAt(m, SAM_STRESS_P, x, y);

    for (int t = 0; t < SAM_STRESS_TRACTIONS; t++)
      sums[t] += value * (t == SAM_STRESS_P ? 1 : p > 0 ? TractionAt(m, t, x, y) / p : like[t]);
  }
}

/* Adds the part of the block. */
static void AddInside(const Map *m, PetscInt i, PetscInt j, const double at[2], const PetscReal fit[6],
                      double stress[PLANE])
{
  const double dx = (double)m->grid->dx, dy = (double)m->grid->dy;
  const int    line                       = SamGridIsRow(m->grid);
  double       like[SAM_STRESS_TRACTIONS] = {0}, most = 0;

  for (PetscInt b = -1; b <= 1; b++)
    for (PetscInt a = -1; a <= 1; a++) {
      const double p = TractionAt(m, SAM_STRESS_P, i + a, j + b);

      if (!(p > most)) continue;
      most = p;
      for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) like[t] = TractionAt(m, t, i + a, j + b) / p;
    }
  for (int n = 0; n < (line ? 2 : RAYS); n++) {
    const Ray    ray    = MakeRay(fit, at, line ? n * PETSC_PI : 2 * PETSC_PI * (n + 0.5) / RAYS);
    const double way[2] = {dx * ray.direction[0], dy * ray.direction[1]}, size = hypot(way[0], way[1]);
    const double e[2] = {-way[0] / size, -way[1] / size},
                 area = line ? 1 : 2 * PETSC_PI / RAYS * dx * dy / (size * size);
    double k[SAM_STRESS_TRACTIONS][PLANE], sums[SAM_STRESS_TRACTIONS];

    AlongRay(m, &ray, i, j, at, like, sums);
    (line ? LineKernels : PointKernels)(m->poisson, e, k);
    for (int t = 0; t < SAM_STRESS_TRACTIONS; t++)
      for (int c = 0; c < PLANE; c++) stress[c] += area * k[t][c] * sums[t];
  }
}

PetscErrorCode SamHalfSpaceStressAtEdge(SamStress body, Vec field, const SamEdge *edge, double stress[])
{
  const SamGrid grid = body->grid;
  Map           m;

  PetscFunctionBegin;
  PetscCall(CreateMap(grid, body->poisson, field, &m));
  for (PetscInt n = 0; n < edge->count; n++) {
    const PetscInt  i = edge->cell[n] % grid->nx, j = grid->row_start + edge->cell[n] / grid->nx;
    const double    at[2] = {(double)((edge->x[n] - SamGridX(grid, i)) / grid->dx),
                             (double)((edge->y[n] - SamGridY(grid, j)) / grid->dy)};
    double         *to    = stress + (ptrdiff_t)PLANE * n;
    const PetscBool complete =
      i > BLOCK && i + BLOCK + 1 < grid->nx && (SamGridIsRow(grid) || (j > BLOCK && j + BLOCK + 1 < grid->ny));

    if (!complete) continue;
    for (int c = 0; c < PLANE; c++) to[c] = 0;
    AddOutside(&m, i, j, at, to);
    AddInside(&m, i, j, at, edge->fit[n], to);
  }
  PetscCall(SamHaloEnd(&m.seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}
