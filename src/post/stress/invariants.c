/* Von Mises stress, principal stresses and strains of a stress. */
#include <petsam/private/stressimpl.h>

enum { XX = SAM_STRESS_XX, YY = SAM_STRESS_YY, ZZ = SAM_STRESS_ZZ };
enum { XY = SAM_STRESS_XY, XZ = SAM_STRESS_XZ, YZ = SAM_STRESS_YZ };

SAM_VECTORIZED void SamStressMises(PetscInt n, const double *const s[], double mises[])
{
  const double *restrict xx = s[XX], *restrict yy = s[YY], *restrict zz = s[ZZ], *restrict xy = s[XY],
                         *restrict xz = s[XZ], *restrict yz = s[YZ];
  double *restrict to = mises;

  for (PetscInt i = 0; i < n; i++) {
    const double a = xx[i] - yy[i], b = yy[i] - zz[i], c = zz[i] - xx[i];

    to[i] = sqrt(0.5 * (a * a + b * b + c * c) + 3 * (xy[i] * xy[i] + xz[i] * xz[i] + yz[i] * yz[i]));
  }
}

/* ---- principal stresses ---- */

#define SWEEPS 12

/* A rotation in the plane of two axes that makes their shear vanish (Jacobi); the third axis is `o`. */
static void Rotate(double a[3][3], int p, int q, int o)
{
  double theta, t, c, s, up, uq;

  if (a[p][q] == 0) return;
  theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  t     = (theta >= 0 ? 1 : -1) / (fabs(theta) + hypot(theta, 1));
  c     = 1 / sqrt(t * t + 1);
  s     = t * c;
  a[p][p] -= t * a[p][q];
  a[q][q] += t * a[p][q];
  a[p][q] = a[q][p] = 0;
  up                = c * a[o][p] - s * a[o][q];
  uq                = s * a[o][p] + c * a[o][q];
  a[o][p] = a[p][o] = up;
  a[o][q] = a[q][o] = uq;
}

void SamPrincipalOf(const double s[SAM_STRESS_COMPONENTS], double p[3])
{
  double a[3][3] = {{s[XX], s[XY], s[XZ]}, {s[XY], s[YY], s[YZ]}, {s[XZ], s[YZ], s[ZZ]}};

  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    const double off = fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]),
                 all = fabs(a[0][0]) + fabs(a[1][1]) + fabs(a[2][2]) + off;

    if (!(off > 1e-16 * all)) break;
    Rotate(a, 0, 1, 2);
    Rotate(a, 0, 2, 1);
    Rotate(a, 1, 2, 0);
  }
  p[0] = fmax(a[0][0], fmax(a[1][1], a[2][2]));
  p[2] = fmin(a[0][0], fmin(a[1][1], a[2][2]));
  p[1] = fmax(fmin(a[0][0], a[1][1]), fmin(fmax(a[0][0], a[1][1]), a[2][2]));
}

void SamPrincipalDirection(const double s[SAM_STRESS_COMPONENTS], double principal, double n[3])
{
  const double a[3][3] = {
    {s[XX] - principal, s[XY], s[XZ]}, {s[XY], s[YY] - principal, s[YZ]}, {s[XZ], s[YZ], s[ZZ] - principal}};
  double most = 0;

  n[0] = n[1] = 0;
  n[2]        = 1;
  /* Normal to two rows of s - principal: the longest of their cross products. */
  for (int k = 0; k < 3; k++) {
    const double *u = a[k], *v = a[(k + 1) % 3];
    const double  w[3]   = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double  length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);

    for (int d = 0; d < 3 && length > most; d++) n[d] = w[d] / length;
    most = fmax(most, length);
  }
}

void SamStressPrincipal(PetscInt n, const double *const s[], double *const p[3])
{
  for (PetscInt i = 0; i < n; i++) {
    double at[SAM_STRESS_COMPONENTS], principal[3];

    for (int c = 0; c < SAM_STRESS_COMPONENTS; c++) at[c] = s[c][i];
    SamPrincipalOf(at, principal);
    for (int k = 0; k < 3; k++) p[k][i] = principal[k];
  }
}

/* ---- strains ---- */

void SamStressStrain(PetscInt n, PetscReal young, PetscReal poisson, const double *const s[], double *const e[])
{
  const double c = young < PETSC_INFINITY ? 1 / (double)young : 0, nu = (double)poisson;

  for (PetscInt i = 0; i < n; i++) {
    const double trace = s[XX][i] + s[YY][i] + s[ZZ][i];

    for (int k = 0; k < SAM_STRESS_COMPONENTS; k++)
      e[k][i] = c * ((1 + nu) * s[k][i] - (k == XX || k == YY || k == ZZ ? nu * trace : 0));
  }
}
