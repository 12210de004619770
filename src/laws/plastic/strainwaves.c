/*
  The stress by an eigenstrain in a half-space that is periodic along the surface, wave by wave.

  A sheet of eigenstrain at a depth c acts at a depth z by exp(-k |z - c|) and k |z - c| exp(-k |z - c|), times
      X = e_mm + 2is e_mz - e_zz,  Y = 2 e_mm + 2is e_mz + 2 nu e_tt,  T = e_mt + is e_tz,  s = sign(z - c),
  m being the direction of the wave vector and t that across it. So two sweeps through the layers, one down (s = 1) and
  one up (s = -1), carry the integrals x0 = int k exp X dc, x1 = int k r exp X dc, y0 and t0 to each layer, at a cost
  that is linear in the number of layers. The integrals of the upward sweep at the surface determine the reflection from
  the free surface, and its displacement. What is bonded to the surface answers this displacement by tractions, whose
  stress is added. The mean is taken over the source and over the target layer, which makes the operator symmetric.

  Source: the waves are combinations of those of Papkovich and Neuber; for the eigenstrains T. Mura, Micromechanics of
  Defects in Solids (1987), sections 15 and 20.
*/
#include "strainwaves.h"
#include <petsam/private/baseimpl.h>

/*
  Amplitudes are stored as their real and imaginary parts in turn, and each number of a wave twice. The components MZ
  and TZ are multiplied by i in strains, and by -i in stresses: all other factors are then real, and the loops below
  treat both parts alike.
*/

/* Components of a wave along its own directions */
enum { MM, TT, ZZ, MT, MZ, TZ };

/* The numbers of a wave, those of a wave in a layer, and the state of a sweep */
enum { K, COS, SIN, E0, E1, REALS };
enum { LOSS, Q, M0, M1, A0, A1, OF_LAYER };
enum { X0, X1, Y0, T0, STATES };

typedef double complex Wave;

typedef struct {
  const SamWaveBody *body;
  PetscInt           n; /* number of parts: twice the number of waves */
  double            *v[REALS];
  double           **layer, *numbers; /* numbers of each layer, (OF_LAYER, n); layers of equal thickness share them */
  double            *state[STATES], *e, *s; /* e and s: (layers, PARTS, n) */
} Column;

static PetscErrorCode CreateColumn(const SamWaveBody *body, PetscInt waves, Column *w)
{
  const PetscInt n = 2 * waves, all = body->layers * PARTS * n;

  PetscFunctionBegin;
  *w = (Column){.body = body, .n = n};
  PetscCall(PetscMalloc1((REALS + STATES) * n, &w->v[0]));
  PetscCall(PetscMalloc4(all, &w->e, all, &w->s, body->layers, &w->layer, body->layers * OF_LAYER * n, &w->numbers));
  for (PetscInt k = 1; k < REALS; k++) w->v[k] = w->v[0] + k * n;
  for (PetscInt k = 0; k < STATES; k++) w->state[k] = w->v[0] + (REALS + k) * n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyColumn(Column *w)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(w->v[0]));
  PetscCall(PetscFree4(w->e, w->s, w->layer, w->numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multiplies n parts by i (sign 1) or -i (-1). */
static void Turn(PetscInt n, double sign, double x[])
{
  for (PetscInt m = 0; m < n; m += 2) {
    const double re = x[m];

    x[m]     = -sign * x[m + 1];
    x[m + 1] = sign * re;
  }
}

/* Returns i * sign * z. A complex number has the layout of its two parts; some compilers lack CMPLX(). */
static inline Wave Turned(double sign, Wave z)
{
  const union {
    double part[2];
    Wave   z;
  } turned = {{-sign * cimag(z), sign * creal(z)}};

  return turned.z;
}

/* ---- numbers ---- */

/* Sets the waves. A wave without direction is treated as a wave along x: uniform strains along the surface act, too. */
static void SetWaves(Column *w, double kx, const double ky[])
{
  for (PetscInt m = 0; m < w->n; m++) {
    const double k = hypot(kx, ky[m / 2]);

    w->v[K][m]   = k;
    w->v[COS][m] = k > 0 ? kx / k : 1;
    w->v[SIN][m] = k > 0 ? ky[m / 2] / k : 0;
  }
}

/* For smaller q = k h the means are computed by series of so many terms, as their digits would cancel. */
#define SMALL 0.3
#define TERMS 15

/* Computes the means over a layer of thickness h of exp(-r) and r exp(-r), and the means by its own source. */
static void SetLayer(const Column *w, double h, double number[])
{
  const PetscInt n = w->n;

  for (PetscInt m = 0; m < n; m += 2) {
    const double q = w->v[K][m] * h, loss = exp(-q);
    double       m0 = (1 - loss) / q, m1 = (1 - (1 + q) * loss) / q, a0 = 1 - m0, a1 = 1 - m0 - m1, term = 1;

    if (q < SMALL) {
      m1 = a0 = a1 = 0;
      for (PetscInt j = 1; j < TERMS; j++) {
        term *= -q / (j + 1);
        m1 -= j * term;
        a0 -= term;
        a1 += (j - 1) * term;
      }
      m0 = 1 - a0;
    }
    for (PetscInt part = m; part < m + 2; part++) {
      number[Q * n + part]    = q;
      number[LOSS * n + part] = loss;
      number[M0 * n + part]   = m0;
      number[M1 * n + part]   = m1;
      number[A0 * n + part]   = a0;
      number[A1 * n + part]   = a1;
    }
  }
}

/* Computes the numbers of all layers. */
static void SetLayers(Column *w)
{
  const PetscReal *h = w->body->thickness;

  for (PetscInt l = 0; l < w->body->layers; l++) {
    w->layer[l] = w->numbers + l * OF_LAYER * w->n;
    if (l > 0 && h[l] == h[l - 1])
      w->layer[l] = w->layer[l - 1];
    else
      SetLayer(w, (double)h[l], w->layer[l]);
  }
}

/* Multiplies the means over layer l by the decay of the waves from the surface to the layer's top (m). */
static void SetDecay(Column *w, PetscInt l, double top)
{
  const double *m0 = w->layer[l] + M0 * w->n, *m1 = w->layer[l] + M1 * w->n;

  for (PetscInt m = 0; m < w->n; m += 2) {
    const double kb = w->v[K][m] * top, decay = exp(-kb);

    w->v[E0][m] = w->v[E0][m + 1] = decay * m0[m];
    w->v[E1][m] = w->v[E1][m + 1] = decay * (kb * m0[m] + m1[m]);
  }
}

/* ---- rotation to the wave's directions and back ---- */

SAM_VECTORIZED static void Rotate(PetscInt            n, const double *restrict cosine, const double *restrict sine,
                                  const double *const from[PARTS], double *restrict to)
{
  const double *restrict xx = from[SAM_STRESS_XX], *restrict yy = from[SAM_STRESS_YY],
                         *restrict zz = from[SAM_STRESS_ZZ], *restrict xy = from[SAM_STRESS_XY],
                         *restrict xz = from[SAM_STRESS_XZ], *restrict yz = from[SAM_STRESS_YZ];

  for (PetscInt m = 0; m < n; m++) {
    const double c = cosine[m], s = sine[m];

    to[MM * n + m] = c * c * xx[m] + s * s * yy[m] + 2 * c * s * xy[m];
    to[TT * n + m] = s * s * xx[m] + c * c * yy[m] - 2 * c * s * xy[m];
    to[ZZ * n + m] = zz[m];
    to[MT * n + m] = c * s * (yy[m] - xx[m]) + (c * c - s * s) * xy[m];
    to[MZ * n + m] = c * xz[m] + s * yz[m];
    to[TZ * n + m] = c * yz[m] - s * xz[m];
  }
}

SAM_VECTORIZED static void RotateBack(PetscInt n, const double *restrict cosine, const double *restrict sine,
                                      const double *restrict from, double *const to[PARTS])
{
  double *restrict xx = to[SAM_STRESS_XX], *restrict yy = to[SAM_STRESS_YY], *restrict zz = to[SAM_STRESS_ZZ],
                   *restrict xy = to[SAM_STRESS_XY], *restrict xz = to[SAM_STRESS_XZ], *restrict yz = to[SAM_STRESS_YZ];

  for (PetscInt m = 0; m < n; m++) {
    const double c = cosine[m], s = sine[m], mm = from[MM * n + m], tt = from[TT * n + m], mt = from[MT * n + m],
                 mz = from[MZ * n + m], tz = from[TZ * n + m];

    xx[m] = c * c * mm + s * s * tt - 2 * c * s * mt;
    yy[m] = s * s * mm + c * c * tt + 2 * c * s * mt;
    zz[m] = from[ZZ * n + m];
    xy[m] = c * s * (mm - tt) + (c * c - s * s) * mt;
    xz[m] = c * mz - s * tz;
    yz[m] = s * mz + c * tz;
  }
}

static void TakeStrain(Column *w, Wave *const from[PARTS], double to[])
{
  const double *parts[PARTS];

  for (PetscInt c = 0; c < PARTS; c++) parts[c] = (const double *)from[c];
  Rotate(w->n, w->v[COS], w->v[SIN], parts, to);
  Turn(w->n, 1, to + MZ * w->n);
  Turn(w->n, 1, to + TZ * w->n);
}

static void PutStress(const Column *w, const double from[], Wave *const to[PARTS])
{
  double *parts[PARTS];

  for (PetscInt c = 0; c < PARTS; c++) parts[c] = (double *)to[c];
  RotateBack(w->n, w->v[COS], w->v[SIN], from, parts);
  Turn(w->n, 1, parts[SAM_STRESS_XZ]);
  Turn(w->n, 1, parts[SAM_STRESS_YZ]);
}

/* ---- sweeps ---- */

/* Processes one layer of a sweep in the direction s: the waves that leave it, and the stress that they cause. */
SAM_VECTORIZED static void Pass(PetscInt n, double s, double shear, double nu, const double *restrict number,
                                const double *restrict e, double *const state[STATES], double *restrict stress)
{
  const double f = shear / (2 * (1 - nu)), g = 2 * (1 - nu);
  double *restrict sx0 = state[X0], *restrict sx1 = state[X1], *restrict sy0 = state[Y0], *restrict st0 = state[T0];

  for (PetscInt m = 0; m < n; m++) {
    const double loss = number[LOSS * n + m], q = number[Q * n + m], m0 = number[M0 * n + m], m1 = number[M1 * n + m],
                 a0 = number[A0 * n + m], a1 = number[A1 * n + m], along = 2 * s * e[MZ * n + m],
                 X = e[MM * n + m] + along - e[ZZ * n + m], Y = 2 * e[MM * n + m] + along + 2 * nu * e[TT * n + m],
                 T = e[MT * n + m] + s * e[TZ * n + m], x0 = sx0[m], x1 = sx1[m], y0 = sy0[m], t0 = st0[m];
    const double x = m0 * x0 + a0 * X, y = m0 * y0 + a0 * Y - (m0 * x1 + m1 * x0 + a1 * X), t = m0 * t0 + a0 * T;

    stress[MM * n + m] += f * (x + y);
    stress[TT * n + m] += 2 * nu * f * x;
    stress[ZZ * n + m] += f * (x - y);
    stress[MT * n + m] += g * f * t;
    stress[MZ * n + m] += s * f * y;
    stress[TZ * n + m] += s * g * f * t;
    sx1[m] = loss * (x1 + q * x0) + q * m1 * X;
    sx0[m] = loss * x0 + q * m0 * X;
    sy0[m] = loss * y0 + q * m0 * Y;
    st0[m] = loss * t0 + q * m0 * T;
  }
}

/* Sets the stress to that of the sheet itself. */
SAM_VECTORIZED static void SetOwn(PetscInt n, double shear, double nu, const double *restrict e, double *restrict s)
{
  const double lateral = nu / (1 - nu);

  for (PetscInt m = 0; m < n; m++) {
    const double both = lateral * (e[MM * n + m] + e[TT * n + m]);

    s[MM * n + m] = -2 * shear * (e[MM * n + m] + both);
    s[TT * n + m] = -2 * shear * (e[TT * n + m] + both);
    s[MT * n + m] = -2 * shear * e[MT * n + m];
    s[ZZ * n + m] = s[MZ * n + m] = s[TZ * n + m] = 0;
  }
}

/* Adds the stress in a layer by the reflection, from the free surface, of the waves of the upward sweep. */
SAM_VECTORIZED static void AddFreeSurface(PetscInt n, double shear, double nu, const double *restrict e0,
                                          const double *restrict e1, double *const state[STATES], double *restrict s)
{
  const double f = shear / (2 * (1 - nu)), g = 2 * (1 - nu);
  const double *restrict x0 = state[X0], *restrict x1 = state[X1], *restrict y0 = state[Y0], *restrict t0 = state[T0];

  for (PetscInt m = 0; m < n; m++) {
    const double relief = f * (x0[m] - y0[m] + x1[m]), x = e0[m] * x0[m], y = e0[m] * (y0[m] - x1[m]) - e1[m] * x0[m],
                 t = e0[m] * t0[m];

    s[MM * n + m] += f * (x + y) - 2 * (e0[m] - e1[m]) * relief;
    s[TT * n + m] += 2 * nu * f * x - 4 * nu * e0[m] * relief;
    s[ZZ * n + m] += f * (x - y) - 2 * (e0[m] + e1[m]) * relief;
    s[MT * n + m] += g * f * t;
    s[MZ * n + m] += f * y + 2 * e1[m] * relief;
    s[TZ * n + m] += g * f * t;
  }
}

/* Returns wave m of an array of parts. */
static inline Wave WaveAt(const double parts[], PetscInt m)
{
  return ((const Wave *)parts)[m];
}

/* Displacement of the surface in a wave, or traction on it, along the wave, across it and down */
typedef struct {
  Wave along, across, down;
} Vector;

/* Computes the displacement of the free surface from the upward sweep; for the mean, from the strains. */
static Vector DisplacementOf(const Column *w, PetscInt m)
{
  const PetscInt n       = w->n;
  const double   lateral = w->body->poisson / (1 - w->body->poisson), k = w->v[K][2 * m];
  const Wave     rest = WaveAt(w->state[Y0], m) - WaveAt(w->state[X1], m);
  Vector         u    = {0, 0, 0};

  if (k > 0)
    u = (Vector){Turned(-1 / k, rest), Turned(-2 / k, WaveAt(w->state[T0], m)), (WaveAt(w->state[X0], m) - rest) / k};
  for (PetscInt l = 0; k == 0 && l < w->body->layers; l++) {
    const double *e = w->e + l * PARTS * n;
    const double  h = w->body->thickness[l];

    u.down -= h * (WaveAt(e + ZZ * n, m) + lateral * (WaveAt(e + MM * n, m) + WaveAt(e + TT * n, m)));
    u.along += Turned(2 * h, WaveAt(e + MZ * n, m));
    u.across += Turned(2 * h, WaveAt(e + TZ * n, m));
  }
  return u;
}

static void GetDisplacement(const Column *w, Wave *const to[3])
{
  for (PetscInt m = 0; m < w->n / 2; m++) {
    const double c = w->v[COS][2 * m], s = w->v[SIN][2 * m];
    const Vector u = DisplacementOf(w, m);

    to[0][m] = c * u.along - s * u.across;
    to[1][m] = s * u.along + c * u.across;
    to[2][m] = u.down;
  }
}

/*
  Adds the stress in a layer by a traction on the surface. A mean pressure causes no lateral strain.
*/
static void AddTraction(const Column *w, PetscInt m, Vector q, double to[])
{
  const PetscInt  n  = w->n / 2;
  const double    nu = w->body->poisson, e0 = w->v[E0][2 * m], e1 = w->v[E1][2 * m];
  const PetscBool mean = w->v[K][2 * m] == 0;
  const Wave      p    = q.down;
  Wave *const     s    = (Wave *)to + m;

  s[ZZ * n] += Turned(e1, q.along) - (e0 + e1) * p;
  s[MM * n] += mean ? -nu / (1 - nu) * p : Turned(2 * e0 - e1, q.along) - (e0 - e1) * p;
  s[TT * n] += mean ? -nu / (1 - nu) * p : Turned(2 * nu * e0, q.along) - 2 * nu * e0 * p;
  s[MZ * n] += e1 * p + Turned(e0 - e1, q.along);
  s[MT * n] += mean ? 0 : Turned(e0, q.across);
  s[TZ * n] += Turned(e0, q.across);
}

/* Computes the tractions by what is bonded to the surface. */
static void GetHold(const Column *w, const SamWaveHold *hold, Vector q[])
{
  for (PetscInt m = 0; m < w->n / 2; m++) {
    const Vector u = DisplacementOf(w, m);

    q[m].down   = Turned(hold->pq[m], u.along) - hold->pp[m] * u.down;
    q[m].along  = -hold->qq[m] * u.along - Turned(hold->pq[m], u.down);
    q[m].across = -hold->tt[m] * u.across;
  }
}

/* ---- a column ---- */

static PetscErrorCode ApplyColumn(Column *w, Wave *const planes[], PetscBool stress, Wave *const u[3],
                                  const SamWaveHold *hold)
{
  const PetscInt layers = w->body->layers, step = PARTS * w->n;
  const double   mu = w->body->shear, nu = w->body->poisson;
  double         top = 0;
  Vector        *q;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(w->n / 2, &q));
  SetLayers(w);
  for (PetscInt l = 0; l < layers; l++) {
    TakeStrain(w, planes + l * PARTS, w->e + l * step);
    SetOwn(w->n, mu, nu, w->e + l * step, w->s + l * step);
  }
  memset(w->state[0], 0, sizeof(double) * (size_t)(STATES * w->n));
  for (PetscInt l = 0; stress && l < layers; l++)
    Pass(w->n, 1, mu, nu, w->layer[l], w->e + l * step, w->state, w->s + l * step);
  memset(w->state[0], 0, sizeof(double) * (size_t)(STATES * w->n));
  for (PetscInt l = layers - 1; l >= 0; l--)
    Pass(w->n, -1, mu, nu, w->layer[l], w->e + l * step, w->state, w->s + l * step);
  if (u) GetDisplacement(w, u);
  if (hold) GetHold(w, hold, q);
  for (PetscInt l = 0; stress && l < layers; l++) {
    SetDecay(w, l, top);
    for (PetscInt m = 0; hold && m < w->n / 2; m++) AddTraction(w, m, q[m], w->s + l * step);
    AddFreeSurface(w->n, mu, nu, w->v[E0], w->v[E1], w->state, w->s + l * step);
    PutStress(w, w->s + l * step, planes + l * PARTS);
    top += w->body->thickness[l];
  }
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWavesApply(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                             double complex *const planes[], PetscBool stress, double complex *const u[3],
                             const SamWaveHold *hold)
{
  Column w;

  PetscFunctionBegin;
  PetscCall(CreateColumn(body, n, &w));
  SetWaves(&w, kx, ky);
  PetscCall(ApplyColumn(&w, planes, stress, u, hold));
  PetscCall(DestroyColumn(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamWavesLoad(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                            const double complex *const traction[3], double complex *const planes[])
{
  double top = 0;
  Column w;

  PetscFunctionBegin;
  PetscCall(CreateColumn(body, n, &w));
  SetWaves(&w, kx, ky);
  SetLayers(&w);
  for (PetscInt l = 0; l < body->layers; l++) {
    SetDecay(&w, l, top);
    PetscCall(PetscArrayzero(w.s, PARTS * w.n));
    for (PetscInt m = 0; m < n; m++) {
      const double c = w.v[COS][2 * m], s = w.v[SIN][2 * m];
      const Wave   x = traction[1][m], y = traction[2][m];

      AddTraction(&w, m, (Vector){c * x + s * y, c * y - s * x, traction[0][m]}, w.s);
    }
    PutStress(&w, w.s, planes + l * PARTS);
    top += body->thickness[l];
  }
  PetscCall(DestroyColumn(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}
