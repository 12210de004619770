/*
  The symbols of a half-space with bonded layers, for one wave along x.

  With u_x = U sin kx, u_z = W cos kx, s_xz = T sin kx, s_zz = S cos kx, solutions in a layer of shear modulus mu that
  decay downwards from its top are (U, W) = D F(kz) a, (T, S) = A F(kz) a, displacements being multiplied by k, with
    D = [1 0; 1 kappa],  A = -2 mu [1, 1 - 2 nu; 1, 2 (1 - nu)],  F(x) = exp(-x) [1 x; 0 1],  kappa = 3 - 4 nu.
  Solutions that decay upwards from its bottom are mirror images: D' = diag(1, -1) D, A' = diag(-1, 1) A. No solution
  grows.

  Algorithm, for the compliance C in (U, W) = C (T, S) from the substrate up, where C = D A^-1, or 0 if it is rigid:
    R = -(D' - C A')^-1 (D - C A),  P = F(kh) R F(kh),  C = C0 + (D' - C0 A') P (A + A' P)^-1,  C0 = D A^-1,
  the second term being the difference from a half-space of the layer's material. Across the wave, with s = 1/mu in the
  substrate: rho = (s - 1/mu)/(s + 1/mu), g = rho exp(-2kh), s = 1/mu + 2 g/(mu (1 - g)).

  Stresses, from the surface down with (T, S) at each layer's top: a = (A + A' P)^-1 (T, S), b = R F(kh) a, so that
  (T, S) = A F(kz) a + A' F(k(h - z)) b and likewise (U, W) at a depth z in the layer; in the substrate a = A^-1 (T, S),
  b = 0. In the top layer, a = A^-1 (T, S) - A^-1 A' P a; the first term is that of a half-space, and the second term,
  together with b, is the difference from it. Across the wave, V = v exp(-kz) + g exp(kz) v, v = -T/(mu (1 - g)). In the
  plane, S_xx = (2 mu U + nu S)/(1 - nu), S_yy = nu (S_xx + S), S_xy = -mu V sin kx.
*/
#include <petsam/private/body.h>
#include <petsam/private/bodyimpl.h>

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

/* Returns a + factor b. */
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

/* The matrices of a material, also of the mirror images */
typedef struct {
  double mu;
  Matrix D, A, mirror_D, mirror_A, half_space;
} Material;

static Material MaterialOf(const SamMaterial *of)
{
  const double poisson = (double)of->poisson, mu = (double)of->young / (2 * (1 + poisson));
  Material     m = {.mu = mu,
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

/* The compliance of the body below some depth, and its difference from a half-space of the material there */
typedef struct {
  Matrix compliance, difference;
  double across, difference_across;
} Surface;

/* Reflection of waves in a layer by the materials below it: F(kh), R, P, rho and g (top of this file) */
typedef struct {
  Matrix F, R, P;
  double rho, g;
} Reflection;

static Matrix Decay(double x)
{
  return (Matrix){{{exp(-x), x * exp(-x)}, {0, exp(-x)}}};
}

/* `below` NULL: a free surface. */
static Reflection ReflectionOf(const Surface *below, const Material *m, double kh)
{
  Reflection r = {.F = Decay(kh), .rho = 1};

  if (below) {
    r.R   = Times(Inverse(Plus(Times(below->compliance, m->mirror_A), -1, m->mirror_D)),
                  Plus(m->D, -1, Times(below->compliance, m->A)));
    r.rho = (below->across - 1 / m->mu) / (below->across + 1 / m->mu);
  } else
    r.R = Plus((Matrix){{{0}}}, -1, Times(Inverse(m->mirror_A), m->A));
  r.P = Times(r.F, Times(r.R, r.F));
  r.g = r.rho * exp(-2 * kh);
  return r;
}

static void AddLayer(Surface *s, const Surface *below, const Material *m, double kh)
{
  const Reflection r = ReflectionOf(below, m, kh);

  s->difference        = Times(Times(Plus(m->mirror_D, -1, Times(m->half_space, m->mirror_A)), r.P),
                               Inverse(Plus(m->A, 1, Times(m->mirror_A, r.P))));
  s->compliance        = Plus(m->half_space, 1, s->difference);
  s->difference_across = 2 * r.g / (m->mu * (1 - r.g));
  s->across            = 1 / m->mu + s->difference_across;
}

static Surface SubstrateOf(SamBody body)
{
  Surface s = {.across = 0};

  if (!isinf(SamBodySubstrate(body)->young)) {
    const Material m = MaterialOf(SamBodySubstrate(body));

    s.compliance = m.half_space;
    s.across     = 1 / m.mu;
  }
  return s;
}

/* Computes the surface of a body; `below`: the same at the bottom of the n-th material, at n + 1; NULL: not wanted. */
static Surface SurfaceOf(SamBody body, double k, Surface below[])
{
  Surface s = SubstrateOf(body);

  for (PetscInt n = body->count - 1; n > 0; n--) {
    const Material m = MaterialOf(&body->material[n - 1]);

    if (below) below[n] = s;
    AddLayer(&s, &s, &m, k * body->material[n - 1].thickness);
  }
  return s;
}

/* Adds the symbols of a compliance in the plane of the wave and across it. */
static void AddSymbols(const Matrix *m, double across, double sign, double to[SAM_WAVE_SYMBOLS])
{
  to[SAM_WAVE_ZZ] -= m->m[1][1];
  to[SAM_WAVE_ZR] -= sign * m->m[1][0];
  to[SAM_WAVE_RR] -= m->m[0][0];
  to[SAM_WAVE_TT] += across;
}

void SamBodySymbols(SamBody body, double sign, double k, double total[SAM_WAVE_SYMBOLS],
                    double difference[SAM_WAVE_SYMBOLS])
{
  const Surface s = SurfaceOf(body, k, NULL);

  AddSymbols(&s.compliance, s.across, sign, total);
  AddSymbols(&s.difference, s.difference_across, sign, difference);
}

/* The inverse of the compliance of a pair of which the layers, upside down, are body 1, and the substrate is body 2. */
void SamBodyInterfaceStiffness(SamBody body, double k, double s[4])
{
  const Material base                = MaterialOf(SamBodySubstrate(body));
  Surface        film                = {.across = 0};
  double         c[SAM_WAVE_SYMBOLS] = {0}, det;

  for (PetscInt n = 0; n < body->count - 1; n++) { /* from the free surface to the substrate */
    const Material m = MaterialOf(&body->material[n]);

    AddLayer(&film, n ? &film : NULL, &m, k * body->material[n].thickness);
  }
  AddSymbols(&film.compliance, film.across, -1, c);
  AddSymbols(&base.half_space, 1 / base.mu, 1, c);
  det  = c[SAM_WAVE_ZZ] * c[SAM_WAVE_RR] - c[SAM_WAVE_ZR] * c[SAM_WAVE_ZR];
  s[0] = s[1] = s[2] = s[3] = 0;
  if (!(det > 0) || !(c[SAM_WAVE_TT] > 0) || isinf(det)) return;
  s[0] = k * c[SAM_WAVE_RR] / det;
  s[1] = k * c[SAM_WAVE_ZR] / det;
  s[2] = k * c[SAM_WAVE_ZZ] / det;
  s[3] = k / c[SAM_WAVE_TT];
}

void SamPairSymbols(SamPair pair, double k, double total[SAM_WAVE_SYMBOLS], double difference[SAM_WAVE_SYMBOLS])
{
  for (int c = 0; c < SAM_WAVE_SYMBOLS; c++) total[c] = difference[c] = 0;
  for (int b = 0; b < 2; b++) SamBodySymbols(pair->body[b], b ? 1 : -1, k, total, difference);
}

/* ---- stresses ---- */

/* A wave at the top of a layer: (T, S) for p = 1 and for q = 1, and T across for q = 1 */
typedef struct {
  Matrix stress;
  double across;
} Wave;

/* Computes the ten functions from (U, W), (T, S) by p and q, and from V, T across, in a material. */
static void CombineStresses(double mu, double nu, Matrix moved, Matrix stress, double v, double across,
                            double s[SAM_WAVE_STRESSES])
{
  double xx[2], yy[2];

  for (int t = 0; t < 2; t++) {
    xx[t] = (2 * mu * moved.m[0][t] + nu * stress.m[1][t]) / (1 - nu);
    yy[t] = nu * (xx[t] + stress.m[1][t]);
  }
  s[0] = stress.m[1][0];
  s[1] = stress.m[0][0];
  s[2] = 0.5 * (xx[0] + yy[0]);
  s[3] = 0.5 * (xx[0] - yy[0]);
  s[4] = stress.m[1][1];
  s[5] = 0.5 * (stress.m[0][1] + across);
  s[6] = 0.5 * (stress.m[0][1] - across);
  s[7] = 0.5 * (xx[1] + yy[1]);
  s[8] = 0.25 * (xx[1] - yy[1]) + 0.5 * mu * v;
  s[9] = 0.25 * (xx[1] - yy[1]) - 0.5 * mu * v;
}

/* Computes the stress functions in the substrate, at the depth z below its top. */
static void Below(const SamMaterial *of, Wave top, double kz, double s[SAM_WAVE_STRESSES])
{
  const Material m = MaterialOf(of);
  const Matrix   a = Times(Decay(kz), Times(Inverse(m.A), top.stress));
  const double   v = -top.across / m.mu * exp(-kz);

  CombineStresses(m.mu, of->poisson, Times(m.D, a), Times(m.A, a), v, -m.mu * v, s);
}

void SamBodyStresses(SamBody body, PetscInt material, double z, double k, double s[SAM_WAVE_STRESSES])
{
  Surface below[SAM_MATERIALS]; /* of a material, at its number + 1 */
  Wave    top = {{{{0, -1}, {-1, 0}}}, -1};

  (void)SurfaceOf(body, k, below);
  for (PetscInt n = 0; n + 1 < body->count; n++) {
    const Material   m  = MaterialOf(&body->material[n]);
    const double     kh = k * body->material[n].thickness;
    const Reflection r  = ReflectionOf(&below[n + 1], &m, kh);
    const Matrix a = Times(Inverse(Plus(m.A, 1, Times(m.mirror_A, r.P))), top.stress), b_ = Times(r.R, Times(r.F, a));
    const double v = -top.across / (m.mu * (1 - r.g));

    if (n == material) {
      const PetscBool first = (PetscBool)(n == 0);
      const Matrix    down  = Times(Decay(k * z),
                                first ? Plus((Matrix){{{0}}}, -1, Times(Inverse(m.A), Times(m.mirror_A, Times(r.P, a))))
                                          : a),
                   up       = Times(Decay(kh - k * z), b_);
      const double v_down = (first ? r.g : 1) * v * exp(-k * z), v_up = r.rho * v * exp(k * z - 2 * kh);

      CombineStresses(m.mu, body->material[n].poisson, Plus(Times(m.D, down), 1, Times(m.mirror_D, up)),
                      Plus(Times(m.A, down), 1, Times(m.mirror_A, up)), v_down + v_up, m.mu * (v_up - v_down), s);
      return;
    }
    top.stress = Plus(Times(m.A, Times(r.F, a)), 1, Times(m.mirror_A, b_));
    top.across = m.mu * v * exp(-kh) * (r.rho - 1);
  }
  Below(SamBodySubstrate(body), top, k * z, s);
}
