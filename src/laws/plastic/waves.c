/*
  The stress by an eigenstrain in a half-space that is periodic along the surface, wave by wave.

  A sheet of eigenstrain at a depth c acts at a depth z by exp(-k |z - c|) and k |z - c| exp(-k |z - c|), times
      X = e_mm + 2is e_mz - e_zz,  Y = 2 e_mm + 2is e_mz + 2 nu e_tt,  T = e_mt + is e_tz,  s = sign(z - c),
  m being the direction of the wave vector and t that across it. So two sweeps through the layers, one down (s = 1) and
  one up (s = -1), carry the integrals x0 = int k exp X dc, x1 = int k r exp X dc, y0 and t0 to each layer, at a cost
  that is linear in the number of layers. The integrals of the upward sweep at the surface determine the reflection from
  the free surface, and its displacement. The mean is taken over the source and over the target layer, which makes the
  operator symmetric.

  Source: the waves are combinations of those of Papkovich and Neuber; for the eigenstrains T. Mura, Micromechanics of
  Defects in Solids (1987), sections 15 and 20.
*/
#include "waves.h"
#include <petsam/private/baseimpl.h>

/* Components of a wave along its own directions */
enum { MM, TT, ZZ, MT, MZ, TZ };

/* The numbers of a layer for each wave of a column, and the state of a sweep */
enum { K, COS, SIN, LOSS, Q, M0, M1, A0, A1, E0, E1, REALS };
enum { X0, X1, Y0, T0, STATES };

typedef double complex Wave;

typedef struct {
  const SamWaveBody *body;
  PetscInt           n; /* number of waves */
  double            *v[REALS];
  Wave              *state[STATES], *e, *s; /* e and s: (layers, PARTS, n) */
} Column;

static PetscErrorCode CreateColumn(const SamWaveBody *body, PetscInt n, Column *w)
{
  const PetscInt all = body->layers * PARTS * n;

  PetscFunctionBegin;
  *w = (Column){.body = body, .n = n};
  PetscCall(PetscMalloc1(REALS * n, &w->v[0]));
  PetscCall(PetscMalloc1(STATES * n, &w->state[0]));
  PetscCall(PetscMalloc2(all, &w->e, all, &w->s));
  for (PetscInt k = 1; k < REALS; k++) w->v[k] = w->v[0] + k * n;
  for (PetscInt k = 1; k < STATES; k++) w->state[k] = w->state[0] + k * n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyColumn(Column *w)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(w->v[0]));
  PetscCall(PetscFree(w->state[0]));
  PetscCall(PetscFree2(w->e, w->s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns i * sign * z. A complex number has the layout of its two parts; some compilers lack CMPLX(). */
static inline Wave Turn(double sign, Wave z)
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
    const double k = hypot(kx, ky[m]);

    w->v[K][m]   = k;
    w->v[COS][m] = k > 0 ? kx / k : 1;
    w->v[SIN][m] = k > 0 ? ky[m] / k : 0;
  }
}

/* For smaller q = k h the means are computed by series of so many terms, as their digits would cancel. */
#define SMALL 0.3
#define TERMS 15

/* Computes the means over a layer of thickness h of exp(-r) and r exp(-r), and the means by its own source. */
static void SetLayer(Column *w, double h)
{
  for (PetscInt m = 0; m < w->n; m++) {
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
    w->v[Q][m]    = q;
    w->v[LOSS][m] = loss;
    w->v[M0][m]   = m0;
    w->v[M1][m]   = m1;
    w->v[A0][m]   = a0;
    w->v[A1][m]   = a1;
  }
}

/*
  UseLayer() sets the means over layer l, unless it is as thick as the last one. SetDecay() then multiplies them by the
  decay of the waves from the surface to the layer's top (m).
*/
static void UseLayer(Column *w, PetscInt l, double *last)
{
  if (w->body->thickness[l] != *last) SetLayer(w, *last = w->body->thickness[l]);
}
static void SetDecay(Column *w, double top)
{
  for (PetscInt m = 0; m < w->n; m++) {
    const double kb = w->v[K][m] * top, decay = exp(-kb);

    w->v[E0][m] = decay * w->v[M0][m];
    w->v[E1][m] = decay * (kb * w->v[M0][m] + w->v[M1][m]);
  }
}

/* ---- rotation to the wave's directions and back ---- */

static void TakeStrain(Column *w, const Wave *const from[PARTS], Wave to[])
{
  const PetscInt n = w->n;

  for (PetscInt m = 0; m < n; m++) {
    const double c = w->v[COS][m], s = w->v[SIN][m];
    const Wave   xx = from[SAM_STRESS_XX][m], yy = from[SAM_STRESS_YY][m], xy = from[SAM_STRESS_XY][m],
               xz = from[SAM_STRESS_XZ][m], yz = from[SAM_STRESS_YZ][m];

    to[MM * n + m] = c * c * xx + s * s * yy + 2 * c * s * xy;
    to[TT * n + m] = s * s * xx + c * c * yy - 2 * c * s * xy;
    to[ZZ * n + m] = from[SAM_STRESS_ZZ][m];
    to[MT * n + m] = c * s * (yy - xx) + (c * c - s * s) * xy;
    to[MZ * n + m] = c * xz + s * yz;
    to[TZ * n + m] = c * yz - s * xz;
  }
}

static void PutStress(const Column *w, const Wave from[], Wave *const to[PARTS])
{
  const PetscInt n = w->n;

  for (PetscInt m = 0; m < n; m++) {
    const double c = w->v[COS][m], s = w->v[SIN][m];
    const Wave   mm = from[MM * n + m], tt = from[TT * n + m], mt = from[MT * n + m], mz = from[MZ * n + m],
               tz = from[TZ * n + m];

    to[SAM_STRESS_XX][m] = c * c * mm + s * s * tt - 2 * c * s * mt;
    to[SAM_STRESS_YY][m] = s * s * mm + c * c * tt + 2 * c * s * mt;
    to[SAM_STRESS_ZZ][m] = from[ZZ * n + m];
    to[SAM_STRESS_XY][m] = c * s * (mm - tt) + (c * c - s * s) * mt;
    to[SAM_STRESS_XZ][m] = c * mz - s * tz;
    to[SAM_STRESS_YZ][m] = s * mz + c * tz;
  }
}

/* ---- sweeps ---- */

/* Adds the stress of the waves x, y, t that arrive from the side s. */
static inline void Add(const SamWaveBody *body, double s, Wave x, Wave y, Wave t, PetscInt n, Wave to[])
{
  const double f = body->shear / (2 * (1 - body->poisson)), g = 2 * (1 - body->poisson);

  to[MM * n] += f * (x + y);
  to[TT * n] += 2 * body->poisson * f * x;
  to[ZZ * n] += f * (x - y);
  to[MT * n] += g * f * t;
  to[MZ * n] += Turn(s * f, y);
  to[TZ * n] += Turn(s * g * f, t);
}

/* Processes one layer of a sweep: its stress (NULL: not wanted), and the waves that leave it. */
static void Pass(Column *w, double s, const Wave e[], Wave stress[])
{
  const PetscInt n  = w->n;
  const double   nu = w->body->poisson;

  for (PetscInt m = 0; m < n; m++) {
    const double m0 = w->v[M0][m], m1 = w->v[M1][m], a0 = w->v[A0][m], a1 = w->v[A1][m], q = w->v[Q][m],
                 loss = w->v[LOSS][m];
    const Wave shear = Turn(2 * s, e[MZ * n + m]), X = e[MM * n + m] + shear - e[ZZ * n + m],
               Y = 2 * e[MM * n + m] + shear + 2 * nu * e[TT * n + m], T = e[MT * n + m] + Turn(s, e[TZ * n + m]);
    const Wave x0 = w->state[X0][m], x1 = w->state[X1][m], y0 = w->state[Y0][m], t0 = w->state[T0][m];

    if (stress)
      Add(w->body, s, m0 * x0 + a0 * X, m0 * y0 + a0 * Y - (m0 * x1 + m1 * x0 + a1 * X), m0 * t0 + a0 * T, n,
          stress + m);
    w->state[X1][m] = loss * (x1 + q * x0) + q * m1 * X;
    w->state[X0][m] = loss * x0 + q * m0 * X;
    w->state[Y0][m] = loss * y0 + q * m0 * Y;
    w->state[T0][m] = loss * t0 + q * m0 * T;
  }
}

/* Adds the stress of the sheet itself. */
static void AddOwn(const Column *w, const Wave e[], Wave s[])
{
  const PetscInt n  = w->n;
  const double   mu = w->body->shear, lateral = w->body->poisson / (1 - w->body->poisson);

  for (PetscInt m = 0; m < n; m++) {
    const Wave both = lateral * (e[MM * n + m] + e[TT * n + m]);

    s[MM * n + m] -= 2 * mu * (e[MM * n + m] + both);
    s[TT * n + m] -= 2 * mu * (e[TT * n + m] + both);
    s[MT * n + m] -= 2 * mu * e[MT * n + m];
  }
}

/* Adds the stress in a layer by the reflection, from the free surface, of the waves of the upward sweep. */
static void AddFreeSurface(const Column *w, Wave s[])
{
  const PetscInt n  = w->n;
  const double   nu = w->body->poisson, f = w->body->shear / (2 * (1 - nu));

  for (PetscInt m = 0; m < n; m++) {
    const double e0 = w->v[E0][m], e1 = w->v[E1][m];
    const Wave   x0 = w->state[X0][m], x1 = w->state[X1][m], y0 = w->state[Y0][m], relief = f * (x0 - y0 + x1);

    Add(w->body, 1, e0 * x0, e0 * (y0 - x1) - e1 * x0, e0 * w->state[T0][m], n, s + m);
    s[ZZ * n + m] -= 2 * (e0 + e1) * relief;
    s[MM * n + m] -= 2 * (e0 - e1) * relief;
    s[TT * n + m] -= 4 * nu * e0 * relief;
    s[MZ * n + m] += Turn(2 * e1, relief);
  }
}

/* Computes the displacement of the surface from the upward sweep; for the mean, from the strains. */
static void GetDisplacement(const Column *w, Wave *const u[3])
{
  const PetscInt n       = w->n;
  const double   lateral = w->body->poisson / (1 - w->body->poisson);

  for (PetscInt m = 0; m < n; m++) {
    const double k = w->v[K][m], c = w->v[COS][m], s = w->v[SIN][m];
    const Wave   rest = w->state[Y0][m] - w->state[X1][m];
    Wave along = Turn(-1 / k, rest), across = Turn(-2 / k, w->state[T0][m]), down = (w->state[X0][m] - rest) / k;

    if (k == 0) along = across = down = 0;
    for (PetscInt l = 0; k == 0 && l < w->body->layers; l++) {
      const Wave  *e = w->e + l * PARTS * n + m;
      const double h = w->body->thickness[l];

      down -= h * (e[ZZ * n] + lateral * (e[MM * n] + e[TT * n]));
      along -= 2 * h * e[MZ * n];
      across -= 2 * h * e[TZ * n];
    }
    u[0][m] = c * along - s * across;
    u[1][m] = s * along + c * across;
    u[2][m] = down;
  }
}

/* ---- a column ---- */

static void ApplyColumn(Column *w, Wave *const planes[], PetscBool stress, Wave *const u[3])
{
  const PetscInt layers = w->body->layers, step = PARTS * w->n;
  double         last = -1, top = 0;

  for (PetscInt l = 0; l < layers; l++) TakeStrain(w, (const Wave *const *)planes + l * PARTS, w->e + l * step);
  if (stress) {
    memset(w->s, 0, sizeof(*w->s) * (size_t)(layers * step));
    memset(w->state[0], 0, sizeof(Wave) * (size_t)(STATES * w->n));
    for (PetscInt l = 0; l < layers; l++) {
      UseLayer(w, l, &last);
      AddOwn(w, w->e + l * step, w->s + l * step);
      Pass(w, 1, w->e + l * step, w->s + l * step);
    }
  }
  memset(w->state[0], 0, sizeof(Wave) * (size_t)(STATES * w->n));
  for (PetscInt l = layers - 1; l >= 0; l--) {
    UseLayer(w, l, &last);
    Pass(w, -1, w->e + l * step, stress ? w->s + l * step : NULL);
  }
  if (u) GetDisplacement(w, u);
  for (PetscInt l = 0; stress && l < layers; l++) {
    UseLayer(w, l, &last);
    SetDecay(w, top);
    AddFreeSurface(w, w->s + l * step);
    PutStress(w, w->s + l * step, planes + l * PARTS);
    top += w->body->thickness[l];
  }
}

PetscErrorCode SamWavesApply(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                             double complex *const planes[], PetscBool stress, double complex *const u[3])
{
  Column w;

  PetscFunctionBegin;
  PetscCall(CreateColumn(body, n, &w));
  SetWaves(&w, kx, ky);
  ApplyColumn(&w, planes, stress, u);
  PetscCall(DestroyColumn(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Adds the stress in a layer by tractions p, and q along and across the wave. A mean pressure causes no lateral strain.
*/
static void AddTractions(const Column *w, const Wave *const traction[3], Wave s[])
{
  const PetscInt n  = w->n;
  const double   nu = w->body->poisson;

  for (PetscInt m = 0; m < n; m++) {
    const double e0 = w->v[E0][m], e1 = w->v[E1][m], c = w->v[COS][m], r = w->v[SIN][m];
    const Wave   p = traction[0][m], along = c * traction[1][m] + r * traction[2][m],
               across    = c * traction[2][m] - r * traction[1][m];
    const PetscBool mean = w->v[K][m] == 0;

    s[ZZ * n + m] = Turn(e1, along) - (e0 + e1) * p;
    s[MM * n + m] = mean ? -nu / (1 - nu) * p : Turn(2 * e0 - e1, along) - (e0 - e1) * p;
    s[TT * n + m] = mean ? -nu / (1 - nu) * p : Turn(2 * nu * e0, along) - 2 * nu * e0 * p;
    s[MZ * n + m] = Turn(e1, p) - (e0 - e1) * along;
    s[MT * n + m] = mean ? 0 : Turn(e0, across);
    s[TZ * n + m] = -e0 * across;
  }
}

PetscErrorCode SamWavesLoad(const SamWaveBody *body, PetscInt n, double kx, const double ky[],
                            const double complex *const traction[3], double complex *const planes[])
{
  double last = -1, top = 0;
  Column w;

  PetscFunctionBegin;
  PetscCall(CreateColumn(body, n, &w));
  SetWaves(&w, kx, ky);
  for (PetscInt l = 0; l < body->layers; l++) {
    UseLayer(&w, l, &last);
    SetDecay(&w, top);
    AddTractions(&w, traction, w.s);
    PutStress(&w, w.s, planes + l * PARTS);
    top += body->thickness[l];
  }
  PetscCall(DestroyColumn(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}
