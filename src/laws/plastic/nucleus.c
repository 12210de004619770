/*
  The stress in a half-space by an eigenstrain at a point. It consists of derivatives, by the places of the force and of
  the point, of the displacements by a force within the half-space; the derivatives are carried through the formulas.

  Source: R. D. Mindlin, Force at a point in the interior of a semi-infinite solid, Physics 7 (1936) 195-202.
*/
#include "images.h"

/* A number with its derivatives by the point (a), by the source (b), and by both */
typedef struct {
  double v, a[3], b[3], ab[3][3];
} Jet;

static Jet Multiply(Jet x, Jet y)
{
  Jet z = {.v = x.v * y.v};

  for (PetscInt k = 0; k < 3; k++) {
    z.a[k] = x.a[k] * y.v + x.v * y.a[k];
    z.b[k] = x.b[k] * y.v + x.v * y.b[k];
    for (PetscInt l = 0; l < 3; l++)
      z.ab[k][l] = x.ab[k][l] * y.v + x.v * y.ab[k][l] + x.a[k] * y.b[l] + x.b[l] * y.a[k];
  }
  return z;
}

/* Returns x + f y. */
static Jet AddTimes(Jet x, double f, Jet y)
{
  x.v += f * y.v;
  for (PetscInt k = 0; k < 3; k++) {
    x.a[k] += f * y.a[k];
    x.b[k] += f * y.b[k];
    for (PetscInt l = 0; l < 3; l++) x.ab[k][l] += f * y.ab[k][l];
  }
  return x;
}

static Jet Power(Jet x, double n)
{
  const double first = n * pow(x.v, n - 1), second = (n - 1) * first / x.v;
  Jet          z = {.v = first * x.v / n};

  for (PetscInt k = 0; k < 3; k++) {
    z.a[k] = first * x.a[k];
    z.b[k] = first * x.b[k];
    for (PetscInt l = 0; l < 3; l++) z.ab[k][l] = first * x.ab[k][l] + second * x.a[k] * x.b[l];
  }
  return z;
}

/* Computes 16 pi mu (1 - nu) times the displacement along i at the point by a unit force along j at the source. */
static void Displace(const double between[2], double depth, double source, double nu, Jet g[3][3])
{
  const double third = 3 - 4 * nu, last = 4 * (1 - nu) * (1 - 2 * nu);
  const Jet    x[2] = {{between[0], {1, 0, 0}, {-1, 0, 0}, {{0}}}, {between[1], {0, 1, 0}, {0, -1, 0}, {{0}}}};
  const Jet    z = {depth, {0, 0, 1}, {0}, {{0}}}, c = {source, {0}, {0, 0, 1}, {{0}}}, none = {0};
  const Jet    less = AddTimes(z, -1, c), more = AddTimes(z, 1, c), cz = Multiply(c, z);
  const Jet    flat   = AddTimes(Multiply(x[0], x[0]), 1, Multiply(x[1], x[1]));
  const Jet    square = AddTimes(flat, 1, Multiply(more, more)), inverse = Power(square, -0.5);
  const Jet    near  = Power(AddTimes(flat, 1, Multiply(less, less)), -0.5);
  const Jet    near3 = Multiply(near, Multiply(near, near)), far3 = Multiply(inverse, Multiply(inverse, inverse)),
            far5 = Multiply(far3, Multiply(inverse, inverse));
  const Jet sum = Power(AddTimes(Power(square, 0.5), 1, more), -1), cone = Multiply(inverse, sum);
  const Jet across = Multiply(less, AddTimes(near3, third, far3)), deep = Multiply(cz, Multiply(more, far5));
  Jet       own = AddTimes(AddTimes(none, third, near), 1, inverse), pair = AddTimes(near3, third, far3), zz;

  own  = AddTimes(AddTimes(own, 2, Multiply(cz, far3)), last, sum);
  pair = AddTimes(AddTimes(pair, -6, Multiply(cz, far5)), -last, Multiply(cone, sum));
  zz   = AddTimes(AddTimes(none, third, near), 8 * (1 - nu) * (1 - nu) - third, inverse);
  zz   = AddTimes(AddTimes(zz, 1, Multiply(less, Multiply(less, near3))), third, Multiply(more, Multiply(more, far3)));
  g[2][2] = AddTimes(AddTimes(zz, -2, Multiply(cz, far3)), 6, Multiply(deep, more));
  for (PetscInt i = 0; i < 2; i++) {
    g[i][2] = Multiply(x[i], AddTimes(AddTimes(across, -last, cone), 6, deep));
    g[2][i] = Multiply(x[i], AddTimes(AddTimes(across, last, cone), -6, deep));
    for (PetscInt j = 0; j < 2; j++) g[i][j] = AddTimes(i == j ? own : none, 1, Multiply(x[i], Multiply(x[j], pair)));
  }
}

/*
  Largest Poisson's ratio for which the formulas are used: they divide by (1 - 2 nu), and rounding errors are divided by
  its square. For incompressible bodies the stress by the images at this ratio has a relative error of about 1e-5.
*/
#define MOST_POISSON (0.5 - 5e-6)

void SamNucleus(const double between[2], double depth, double source, double shear, double poisson,
                double stress[PARTS * PARTS])
{
  const double          nu              = PetscMin(poisson, MOST_POISSON);
  static const PetscInt index[PARTS][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  const double          lame            = 2 * nu / (1 - 2 * nu); /* relative to the shear modulus */
  Jet                   g[3][3];

  Displace(between, depth, source, nu, g);
  for (PetscInt b = 0; b < PARTS; b++) {
    double u[3][3], trace = 0;

    for (PetscInt i = 0; i < 3; i++)
      for (PetscInt k = 0; k < 3; k++) {
        const PetscInt m = index[b][0], n = index[b][1];

        u[i][k] = m == n ? 2 * g[i][m].ab[k][n] : 2 * (g[i][m].ab[k][n] + g[i][n].ab[k][m]);
        for (PetscInt j = 0; j < 3 && m == n; j++) u[i][k] += lame * g[i][j].ab[k][j];
      }
    for (PetscInt i = 0; i < 3; i++) trace += u[i][i];
    for (PetscInt a = 0; a < PARTS; a++) {
      const PetscInt i = index[a][0], k = index[a][1];

      stress[a * PARTS + b] = shear / (16 * PETSC_PI * (1 - nu)) * (u[i][k] + u[k][i] + (i == k ? lame * trace : 0));
    }
  }
}
