/* Grids, fields and bodies for the tests of grid, transforms, elasticity and solvers. All functions are collective. */
#ifndef PETSAM_FIELDS_H
#define PETSAM_FIELDS_H

#include "samtest.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include <petsam/private/bodyimpl.h>
#include <petsam/problem.h>
#include <petsam/private/control.h>

/* A number in [-1, 1) that depends on its arguments alone: fields made of it are the same on any number of ranks. */
static inline double Random(PetscInt seed, PetscInt component, PetscInt i, PetscInt j)
{
  uint64_t z = (uint64_t)(seed + 1) * 0x9e3779b97f4a7c15u + (uint64_t)(component + 1) * 0xd1b54a32d192ed03u +
               (uint64_t)(i + 1) * 0x8cb92ba72f3d8dd7u + (uint64_t)(j + 1) * 0xabc98388fb8fac03u;

  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return (double)(z >> 11) / 4503599627370496.0 - 1;
}

static inline SamGrid NewGridOn(MPI_Comm comm, PetscInt nx, PetscInt ny, double width, double height, double x,
                                double y)
{
  const PetscInt  n[2]      = {nx, ny};
  const PetscReal size[2]   = {width, height};
  const PetscReal center[2] = {x, y};
  SamGrid         grid;

  sam_call(SamGridCreate(comm, n, size, center, &grid));
  return grid;
}

static inline SamGrid NewGrid(PetscInt nx, PetscInt ny, double width, double height)
{
  return NewGridOn(PETSC_COMM_WORLD, nx, ny, width, height, 0, 0);
}

static inline Vec NewField(SamGrid grid, PetscInt components)
{
  Vec v;

  sam_call(SamGridCreateVec(grid, components, &v));
  sam_call(VecSet(v, 0));
  return v;
}

static inline Vec NewRandom(SamGrid grid, PetscInt components, PetscInt seed)
{
  Vec     v = NewField(grid, components);
  double *a;

  sam_call(VecGetArray(v, &a));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt j = 0; j < grid->rows; j++)
      for (PetscInt i = 0; i < grid->nx; i++)
        a[c * grid->cells + j * grid->nx + i] = Random(seed, c, i, grid->row_start + j);
  sam_call(VecRestoreArray(v, &a));
  return v;
}

/* A field from a function of the place. */
static inline Vec NewFrom(SamGrid grid, double (*value)(double x, double y, const void *context), const void *context)
{
  Vec     v = NewField(grid, 1);
  double *a;

  sam_call(VecGetArray(v, &a));
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt i = 0; i < grid->nx; i++)
      a[j * grid->nx + i] = value(SamGridX(grid, i), SamGridY(grid, grid->row_start + j), context);
  sam_call(VecRestoreArray(v, &a));
  return v;
}

static inline Vec Copy(Vec v)
{
  Vec w;

  sam_call(VecDuplicate(v, &w));
  sam_call(VecCopy(v, w));
  return w;
}

/* The whole field on every rank, (components, ny, nx); the caller frees it. */
static inline double *Whole(SamGrid grid, PetscInt components, Vec v)
{
  const PetscInt all = grid->nx * grid->ny;
  double        *w   = (double *)calloc((size_t)(components * all), sizeof(*w));
  const double  *a;
  PetscMPIInt    ranks;

  sam_assert(w != NULL);
  sam_call(VecGetArrayRead(v, &a));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt k = 0; k < grid->cells; k++) w[c * all + grid->row_start * grid->nx + k] = a[c * grid->cells + k];
  sam_call(VecRestoreArrayRead(v, &a));
  (void)MPI_Comm_size(grid->comm, &ranks);
  if (ranks > 1) (void)MPI_Allreduce(MPI_IN_PLACE, w, (int)(components * all), MPI_DOUBLE, MPI_SUM, grid->comm);
  return w;
}

static inline void SetWhole(SamGrid grid, PetscInt components, const double whole[], Vec v)
{
  const PetscInt all = grid->nx * grid->ny;
  double        *a;

  sam_call(VecGetArray(v, &a));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt k = 0; k < grid->cells; k++) a[c * grid->cells + k] = whole[c * all + grid->row_start * grid->nx + k];
  sam_call(VecRestoreArray(v, &a));
}

/* Adds to the entry of one cell. */
static inline void AddAt(SamGrid grid, PetscInt component, PetscInt i, PetscInt j, double value, Vec v)
{
  double *a;

  sam_call(VecGetArray(v, &a));
  if (j >= grid->row_start && j < grid->row_start + grid->rows)
    a[component * grid->cells + (j - grid->row_start) * grid->nx + i] += value;
  sam_call(VecRestoreArray(v, &a));
}

/* A value at a cell's centre, on all ranks. */
static inline double At(SamGrid grid, Vec field, PetscInt component, PetscInt i, PetscInt j)
{
  const double *s;
  double        value = 0;

  sam_call(VecGetArrayRead(field, &s));
  if (j >= grid->row_start && j < grid->row_start + grid->rows)
    value = s[component * grid->cells + (j - grid->row_start) * grid->nx + i];
  sam_call(VecRestoreArrayRead(field, &s));
  sam_call(SamSum(grid->comm, 1, &value));
  return value;
}

static inline double Dot(Vec a, Vec b)
{
  PetscReal dot;

  sam_call(VecDot(a, b, &dot));
  return dot;
}

static inline double Norm(Vec v, NormType type)
{
  PetscReal norm;

  sam_call(VecNorm(v, type, &norm));
  return norm;
}

static inline double Sum(Vec v)
{
  PetscReal sum;

  sam_call(VecSum(v, &sum));
  return sum;
}

/* |a - b|/|b|. */
static inline double Difference(Vec a, Vec b, NormType type)
{
  Vec    d = Copy(a);
  double norm;

  sam_call(VecAXPY(d, -1, b));
  norm = Norm(d, type) / Norm(b, type);
  sam_call(VecDestroy(&d));
  return norm;
}

/* The pair of two bodies of these materials, which lives as long as the test. */
static inline SamPair NewPairOf(PetscInt count1, const SamMaterial first[], PetscInt count2, const SamMaterial second[])
{
  SamBody body[2];
  SamPair pair;

  sam_call(SamBodyCreate(count1, first, &body[0]));
  sam_call(SamBodyCreate(count2, second, &body[1]));
  sam_call(SamPairCreate(body[0], body[1], &pair));
  for (int b = 0; b < 2; b++) sam_call(SamBodyDestroy(&body[b]));
  return pair;
}

static inline SamPair NewPair(double young1, double poisson1, double young2, double poisson2)
{
  const SamMaterial material[2] = {{.young = young1, .poisson = poisson1}, {.young = young2, .poisson = poisson2}};

  return NewPairOf(1, &material[0], 1, &material[1]);
}

/* A sphere of radius R pressed on a plane by N: Hertz's contact of radius a = 1 mm, on a square grid about it. */
typedef struct {
  SamPair       pair;
  SamGrid       grid;
  SamElasticity elasticity;
  Vec           h; /* separation, m */
  double        R, N, a, p0;
} Sphere;

static inline double Paraboloid(double x, double y, const void *radius)
{
  return (x * x + y * y) / (2 * *(const double *)radius);
}

/* A paraboloid about a place: radius, x, y. */
static inline double ParaboloidAt(double x, double y, const void *context)
{
  const double *at = (const double *)context;

  return Paraboloid(x - at[1], y - at[2], at);
}

/* n * n cells, half_width in units of a, about (x, y). */
static inline Sphere NewSphereOn(MPI_Comm comm, SamPair pair, PetscInt n, double half_width, double x, double y)
{
  Sphere       s     = {.pair = pair, .R = 0.1, .a = 1e-3};
  const double at[3] = {s.R, x, y};

  s.N    = 4 * pair->modulus * s.a * s.a * s.a / (3 * s.R);
  s.p0   = 1.5 * s.N / (PETSC_PI * s.a * s.a);
  s.grid = NewGridOn(comm, n, n, 2 * half_width * s.a, 2 * half_width * s.a, x, y);
  s.h    = NewFrom(s.grid, ParaboloidAt, at);
  sam_call(SamElasticityCreate(s.grid, pair, &s.elasticity));
  return s;
}

static inline Sphere NewSphereOf(SamPair pair, PetscInt n, double half_width)
{
  return NewSphereOn(PETSC_COMM_WORLD, pair, n, half_width, 0, 0);
}

static inline Sphere NewSphere(PetscInt n, double half_width, double poisson)
{
  return NewSphereOf(NewPair(210e9, poisson, 210e9, poisson), n, half_width);
}

static inline void DestroySphere(Sphere *s)
{
  sam_call(VecDestroy(&s->h));
  sam_call(SamElasticityDestroy(&s->elasticity));
  sam_call(SamGridDestroy(&s->grid));
}

/* Hertz's pressure at radius r. */
static inline double Hertz(const Sphere *s, double r)
{
  return r < s->a ? s->p0 * sqrt(1 - r * r / (s->a * s->a)) : 0;
}

/* The conditions of half-spaces with friction, each at the place that it has in all such problems. */
static inline SamConditions Conditions(void)
{
  static SamConditions conditions;

  const PetscInt  n[2]     = {2, 2};
  const PetscReal width[2] = {1, 1}, center[2] = {0, 0};
  const SamPair   pair = NewPair(1, 0, 1, 0);
  SamGrid         grid;
  SamElasticity   elasticity;
  SamProblem      problem;

  if (conditions) return conditions;
  sam_call(SamGridCreate(PETSC_COMM_SELF, n, width, center, &grid));
  sam_call(SamElasticityCreate(grid, pair, &elasticity));
  sam_call(SamProblemCreate(elasticity, &problem));
  conditions = SamProblemGetConditions(problem);
  sam_call(SamConditionsReference(conditions));
  sam_call(SamProblemDestroy(&problem));
  sam_call(SamElasticityDestroy(&elasticity));
  sam_call(SamGridDestroy(&grid));
  return conditions;
}

#endif
