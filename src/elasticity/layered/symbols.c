/*
  The symbols of a half-space with bonded layers, for one wave along x.

  With u_x = U sin kx, u_z = W cos kx, s_xz = T sin kx, s_zz = S cos kx, solutions in a layer of shear modulus mu that
  decay downwards from its top are (U, W) = D F(kz) a, (T, S) = A F(kz) a, displacements being multiplied by k, with
    D = [1 0; 1 kappa],  A = -2 mu [1, 1 - 2 nu; 1, 2 (1 - nu)],  F(x) = exp(-x) [1 x; 0 1],  kappa = 3 - 4 nu.
  Those that decay upwards from its bottom are the mirror images: D' = diag(1, -1) D, A' = diag(-1, 1) A. Nothing grows.

  Algorithm, for the compliance C in (U, W) = C (T, S) from the substrate up, where C = D A^-1, or 0 if it is rigid:
    R = -(D' - C A')^-1 (D - C A),  P = F(kh) R F(kh),  C = C0 + (D' - C0 A') P (A + A' P)^-1,  C0 = D A^-1,
  the second term being the difference from a half-space of the layer's material. Across the wave, with s = 1/mu in the
  substrate: rho = (s - 1/mu)/(s + 1/mu), g = rho exp(-2kh), s = 1/mu + 2 g/(mu (1 - g)).
*/
#include <petsam/private/layered.h>

typedef struct {
  double m[2][2];
} Matrix;

static Matrix Times(Matrix a, Matrix b)
{
  Matrix c;

  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j];
  return c;
}

/* a + factor b */
static Matrix Plus(Matrix a, double factor, Matrix b)
{
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) a.m[i][j] += factor * b.m[i][j];
  return a;
}

static Matrix Inverse(Matrix a)
{
  const double det = a.m[0][0] * a.m[1][1] - a.m[0][1] * a.m[1][0];

  return (Matrix){{{a.m[1][1] / det, -a.m[0][1] / det}, {-a.m[1][0] / det, a.m[0][0] / det}}};
}

/* A material's matrices; of the mirror images, too. */
typedef struct {
  double mu;
  Matrix D, A, mirror_D, mirror_A, half_space;
} Material;

static Material MaterialOf(double young, double poisson)
{
  const double mu = young / (2 * (1 + poisson));
  Material     m  = {.mu = mu,
                     .D  = {{{1, 0}, {1, 3 - 4 * poisson}}},
                     .A  = {{{-2 * mu, -2 * mu * (1 - 2 * poisson)}, {-2 * mu, -4 * mu * (1 - poisson)}}}};

  for (int j = 0; j < 2; j++) {
    m.mirror_D.m[0][j] = m.D.m[0][j];
    m.mirror_D.m[1][j] = -m.D.m[1][j];
    m.mirror_A.m[0][j] = -m.A.m[0][j];
    m.mirror_A.m[1][j] = m.A.m[1][j];
  }
  m.half_space = Times(m.D, Inverse(m.A));
  return m;
}

/* The compliance of the body from some depth down, and what of it is not a half-space's of the material there. */
typedef struct {
  Matrix compliance, difference;
  double across, difference_across;
} Surface;

static void AddLayer(Surface *s, const Material *m, double kh)
{
  const Matrix F = {{{exp(-kh), kh * exp(-kh)}, {0, exp(-kh)}}};
  const Matrix R = Times(Inverse(Plus(m->mirror_D, -1, Times(s->compliance, m->mirror_A))),
                         Plus(m->D, -1, Times(s->compliance, m->A)));
  const Matrix P = Plus((Matrix){{{0}}}, -1, Times(F, Times(R, F)));
  const double g = (s->across - 1 / m->mu) / (s->across + 1 / m->mu) * exp(-2 * kh);

  s->difference        = Times(Times(Plus(m->mirror_D, -1, Times(m->half_space, m->mirror_A)), P),
                               Inverse(Plus(m->A, 1, Times(m->mirror_A, P))));
  s->compliance        = Plus(m->half_space, 1, s->difference);
  s->difference_across = 2 * g / (m->mu * (1 - g));
  s->across            = 1 / m->mu + s->difference_across;
}

static Surface SurfaceOf(const SamPair *pair, PetscInt b, double k)
{
  const SamLayers *layers = &pair->layers[b];
  Surface          s      = {.across = 0};

  if (!isinf(pair->young[b])) {
    const Material m = MaterialOf(pair->young[b], pair->poisson[b]);

    s.compliance = m.half_space;
    s.across     = 1 / m.mu;
  }
  for (PetscInt n = layers->count - 1; n >= 0; n--) {
    const Material m = MaterialOf(layers->young[n], layers->poisson[n]);

    AddLayer(&s, &m, k * layers->thickness[n]);
  }
  return s;
}

void SamLayeredSymbols(const SamPair *pair, PetscInt body, double k, double total[SAM_LAYERED_SYMBOLS],
                       double difference[SAM_LAYERED_SYMBOLS])
{
  for (int c = 0; c < SAM_LAYERED_SYMBOLS; c++) total[c] = difference[c] = 0;
  for (PetscInt b = 0; b < 2; b++) {
    const double  sign = !body && b == 0 ? -1 : 1; /* of the coupling */
    const Surface s    = SurfaceOf(pair, b, k);

    if (body && b != body - 1) continue;
    for (int part = 0; part < 2; part++) {
      const Matrix *m  = part ? &s.difference : &s.compliance;
      double       *to = part ? difference : total;

      to[SAM_LAYERED_ZZ] -= m->m[1][1];
      to[SAM_LAYERED_ZR] -= sign * m->m[1][0];
      to[SAM_LAYERED_RR] -= m->m[0][0];
      to[SAM_LAYERED_TT] += part ? s.difference_across : s.across;
    }
  }
}
