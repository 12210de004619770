/*
  Stresses in a body with layers, by unit tractions on the cells of its surface.

  Problem. In each wave the stresses at a depth are known (symbols.c). In space, at the distance r and angle t from a
  unit force, they are combinations of transforms G_n[s] = (1/2 pi) int_0^inf s(k) J_n(kr) k dk of ten functions. The
  index p or q is the traction, (T, S) are the stresses xz, zz of a wave along x, and M is the stress xy across it:
    f0 = G_0[S_p]                f4 = G_1[S_q]                     f8 = G_1[(S_xx - S_yy)_q/4 + M/2]
    f1 = G_1[T_p]                f5 = G_0[T_q + T_y]/2             f9 = G_3[(S_xx - S_yy)_q/4 - M/2]
    f2 = G_0[(S_xx + S_yy)_p]/2  f6 = G_2[T_q - T_y]/2
    f3 = G_2[(S_xx - S_yy)_p]/2  f7 = G_1[(S_xx + S_yy)_q]/2
  By p: xx, yy = f2 -+ f3 cos 2t, zz = f0, xy = -f3 sin 2t, xz = f1 cos t, yz = f1 sin t. By q_x: xx = -(f7 + f8) cos t
  + f9 cos 3t, yy = (f8 - f7) cos t - f9 cos 3t, zz = -f4 cos t, xy = -f8 sin t + f9 sin 3t, xz = f5 - f6 cos 2t, yz =
  -f6 sin 2t. By q_y the same with x and y exchanged.

  Algorithm. For each depth, a table of the ten functions (radial.c) is computed and integrated over the cells
  (cells.c). In the first layer the functions are the differences from a half-space of its material, whose closed forms
  (kernels/stresscell.c) are added; they decay like exp(-k (2 h - z)). Below the first layer the functions decay like
  exp(-kz).

  In plane strain the ten become even functions (cosines) xx = s2 + s3, yy = s2 - s3, zz = s0 by p, xz = s5 + s6 by q_x
  and yz = s5 - s6 by q_y; and odd ones (sines) xz = s1 by p, zz = -s4, xx = -(s7 + s8 + s9), yy = -(s7 - s8 - s9) by
  q_x, and xy = -(s8 - s9) by q_y.

  Values at the centres of cells, as in stresscell.c: for a shear q that varies along x in cells of side h, s_xx gets
  -(h/pi) dq/dx sum_m ((-1)^m/m) s(2 pi m/h) over m = 1, 2, ..., s(k) the symbol of s_xx by q; likewise yy, zz and,
  along the other axis, xy, each with its own; and xz by p with -T_p. Thirty terms of such an alternating series, with
  the weights of Cohen, Rodriguez Villegas and Zagier (2000, Exp. Math. 9, 3), give all its digits.

  Source: O'Sullivan and King 1988, J. Tribol. 110, 235.
*/
#include "layered.h"
#include <petsam/private/stressimpl.h>
#include <petsam/private/body.h>

#define ALTERNATING 30   /* number of terms of a series */
#define LONG_WAVE   1e-5 /* k times the depth of all layers on a rigid base, below which rounding matters */
#define THICK       8    /* number of cells in the first layer from which edges are those of a half-space */

typedef struct {
  SamBody   body;
  PetscInt  material;    /* material at the depth in use */
  double    z;           /* below the material's top, m */
  double    depth, base; /* depth in use, -1: none; depth at which the last material begins */
  double    decay;       /* functions fall like exp(-decay k), m */
  SamSpline table;
} Layered;

/* ---- the functions ---- */

static void StressesAt(const Layered *l, double k, double s[SAM_WAVE_STRESSES])
{
  const double least = isinf(SamBodySubstrate(l->body)->young) ? LONG_WAVE / l->base : 0;

  SamBodyStresses(l->body, l->material, l->z, PetscMax(k, least), s);
}

static void FunctionsAt(const void *context, double k, double g[])
{
  StressesAt((const Layered *)context, k, g);
  for (int f = 0; f < SAM_WAVE_STRESSES; f++) g[f] *= k;
}

/* The functions of plane strain, in a separate order */
enum { P_XX, P_YY, P_ZZ, X_XZ, Y_YZ, EVEN, P_XZ = EVEN, X_XX, X_YY, X_ZZ, Y_XY };

static void LineFunctionsAt(const void *context, double k, double g[])
{
  double s[SAM_WAVE_STRESSES];

  StressesAt((const Layered *)context, k, s);
  g[P_XX] = s[2] + s[3];
  g[P_YY] = s[2] - s[3];
  g[P_ZZ] = s[0];
  g[X_XZ] = s[5] + s[6];
  g[Y_YZ] = s[5] - s[6];
  g[P_XZ] = s[1];
  g[X_XX] = -s[7] - s[8] - s[9];
  g[X_YY] = -s[7] + s[8] + s[9];
  g[X_ZZ] = -s[4];
  g[Y_XY] = -s[8] + s[9];
}

static PetscErrorCode UseDepth(SamStress stress, PetscReal depth)
{
  static const int orders[]      = {0, 1, 0, 2, 1, 0, 2, 1, 1, 3};
  static const int line_orders[] = {0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
  const SamGrid    grid          = stress->grid;
  Layered         *l             = (Layered *)stress->data;
  SamRadialSource  of            = {.functions = SAM_WAVE_STRESSES,
                                    .line      = SamGridIsRow(grid),
                                    .orders    = SamGridIsRow(grid) ? line_orders : orders,
                                    .values    = SamGridIsRow(grid) ? LineFunctionsAt : FunctionsAt,
                                    .context   = l};

  PetscFunctionBegin;
  if ((double)depth == l->depth) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSplineDestroy(&l->table));
  l->depth    = (double)depth;
  l->material = SamBodyNumberAt(l->body, depth);
  l->z        = l->depth - (double)SamBodyTop(l->body, l->material);
  l->decay    = l->material ? l->depth : 2 * (double)l->body->material[0].thickness - l->z;
  PetscCheck(!isinf(l->body->material[l->material].young), grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Depth %.6g m: it is in the rigid base", l->depth);
  of.depth   = l->decay;
  of.longest = PetscMax(l->base, l->depth);
  if (of.line) {
    of.thickness[0] = of.depth;
    LineFunctionsAt(l, SAM_LONG_WAVE / of.longest, of.image[0]);
  }
  /* Beyond the farthest lags, for means of cells along a row. */
  PetscCall(
    SamRadialCreate(&of, 1.1 * hypot((double)grid->width[0], (double)grid->width[1]) + 8 * of.depth, &l->table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- rows of lags ---- */

/* The kernels of a group, by terms */
static const struct {
  int           count;
  SamRadialTerm terms[8];
} groups[SAM_STRESS_GROUPS] = {
  [SAM_STRESS_PLANE_P] = {5,
                          {{2, 0, SAM_ANGULAR_1, 1},
                           {2, 1, SAM_ANGULAR_1, 1},
                           {3, 0, SAM_ANGULAR_XX, -1},
                           {3, 1, SAM_ANGULAR_XX, 1},
                           {3, 2, SAM_ANGULAR_XY, -1}}},
  [SAM_STRESS_PLANE_X] = {8,
                          {{7, 0, SAM_ANGULAR_X, -1},
                           {7, 1, SAM_ANGULAR_X, -1},
                           {8, 0, SAM_ANGULAR_X, -1},
                           {8, 1, SAM_ANGULAR_X, 1},
                           {8, 2, SAM_ANGULAR_Y, -1},
                           {9, 0, SAM_ANGULAR_XXX, 1},
                           {9, 1, SAM_ANGULAR_XXX, -1},
                           {9, 2, SAM_ANGULAR_YYY, 1}}},
  /* cos 3t and sin 3t become -sin 3t and -cos 3t if x and y are exchanged. */
  [SAM_STRESS_PLANE_Y]  = {8,
                           {{7, 0, SAM_ANGULAR_Y, -1},
                            {7, 1, SAM_ANGULAR_Y, -1},
                            {8, 1, SAM_ANGULAR_Y, -1},
                            {8, 0, SAM_ANGULAR_Y, 1},
                            {8, 2, SAM_ANGULAR_X, -1},
                            {9, 1, SAM_ANGULAR_YYY, -1},
                            {9, 0, SAM_ANGULAR_YYY, 1},
                            {9, 2, SAM_ANGULAR_XXX, -1}}},
  [SAM_STRESS_NORMAL_P] = {3, {{0, 0, SAM_ANGULAR_1, 1}, {1, 1, SAM_ANGULAR_X, 1}, {1, 2, SAM_ANGULAR_Y, 1}}},
  [SAM_STRESS_NORMAL_T] = {5,
                           {{5, 0, SAM_ANGULAR_1, 1},
                            {5, 2, SAM_ANGULAR_1, 1},
                            {6, 0, SAM_ANGULAR_XX, -1},
                            {6, 1, SAM_ANGULAR_XY, -1},
                            {6, 2, SAM_ANGULAR_XX, 1}}},
  [SAM_STRESS_NORMAL_Z] = {2, {{4, 0, SAM_ANGULAR_X, -1}, {4, 1, SAM_ANGULAR_Y, -1}}},
};

static const struct {
  int           count;
  SamRadialTerm terms[2];
} line_groups[SAM_STRESS_GROUPS] = {
  [SAM_STRESS_PLANE_P]  = {2, {{P_XX, 0, SAM_ANGULAR_1, 1}, {P_YY, 1, SAM_ANGULAR_1, 1}}},
  [SAM_STRESS_PLANE_X]  = {2, {{X_XX, 0, SAM_ANGULAR_X, 1}, {X_YY, 1, SAM_ANGULAR_X, 1}}},
  [SAM_STRESS_PLANE_Y]  = {1, {{Y_XY, 2, SAM_ANGULAR_X, 1}}},
  [SAM_STRESS_NORMAL_P] = {2, {{P_ZZ, 0, SAM_ANGULAR_1, 1}, {P_XZ, 1, SAM_ANGULAR_X, 1}}},
  [SAM_STRESS_NORMAL_T] = {2, {{X_XZ, 0, SAM_ANGULAR_1, 1}, {Y_YZ, 2, SAM_ANGULAR_1, 1}}},
  [SAM_STRESS_NORMAL_Z] = {1, {{X_ZZ, 0, SAM_ANGULAR_X, 1}}},
};

/* Symbols of xx, yy, zz and xy by shear along the wave (xy: across it), and of xz by pressure with the opposite sign */
typedef struct {
  double xx, yy, zz, xy, xz;
} Jumps;

/* Computes their alternating sums over 2 pi, for cells of this side: half for the difference of the neighbours, over
   pi. */
static Jumps JumpsOf(const Layered *l, double side)
{
  const double power = pow(3 + sqrt(8), ALTERNATING), d = 0.5 * (power + 1 / power);
  double       b = -1, c = -d, sums[SAM_WAVE_STRESSES] = {0}, s[SAM_WAVE_STRESSES];

  for (int m = 0; m < ALTERNATING; m++) {
    c = b - c;
    StressesAt(l, 2 * PETSC_PI * (m + 1) / side, s);
    for (int f = 0; f < SAM_WAVE_STRESSES; f++) sums[f] -= c / d * s[f] / (m + 1) / (2 * PETSC_PI);
    b *= (double)(m + ALTERNATING) * (m - ALTERNATING) / ((m + 0.5) * (m + 1));
  }
  return (Jumps){.xx = sums[7] + sums[8] + sums[9],
                 .yy = sums[7] - sums[8] - sums[9],
                 .zz = sums[4],
                 .xy = sums[8] - sums[9],
                 .xz = -sums[1]};
}

/* Adds the corrections of the values at cells' centres, at the lags (1, 0) and (0, 1). */
static void Correct(const Layered *l, const double side[2], SamStressGroup group, PetscInt j, PetscInt n,
                    double *const values[SAM_STRESS_GROUP])
{
  const PetscInt at = 1 - j;
  Jumps          jumps;

  if (j > 1 || at >= n) return;
  jumps = JumpsOf(l, side[j]);
  if (j == 0 && group == SAM_STRESS_PLANE_X) values[0][at] += jumps.xx;
  if (j == 0 && group == SAM_STRESS_PLANE_X) values[1][at] += jumps.yy;
  if (j == 1 && group == SAM_STRESS_PLANE_X) values[2][at] += jumps.xy;
  if (j == 1 && group == SAM_STRESS_PLANE_Y) values[0][at] += jumps.yy;
  if (j == 1 && group == SAM_STRESS_PLANE_Y) values[1][at] += jumps.xx;
  if (j == 0 && group == SAM_STRESS_PLANE_Y) values[2][at] += jumps.xy;
  if (group == SAM_STRESS_NORMAL_P) values[1 + j][at] += jumps.xz;
  if (group == SAM_STRESS_NORMAL_Z) values[j][at] += jumps.zz;
}

static void Row(SamStress stress, const double side[2], double depth, SamStressGroup group, PetscInt j, PetscInt n,
                double *const values[SAM_STRESS_GROUP])
{
  const Layered           *l      = (const Layered *)stress->data;
  const PetscBool          line   = isinf(side[1]) ? PETSC_TRUE : PETSC_FALSE;
  const SamHalfSpaceSource source = {{side[0], side[1]}, depth, (double)stress->poisson};
  const SamRadialKernels   of     = {.table   = &l->table,
                                     .depth   = l->decay,
                                     .kernels = SAM_STRESS_GROUP,
                                     .count   = line ? line_groups[group].count : groups[group].count,
                                     .terms   = line ? line_groups[group].terms : groups[group].terms};

  for (int k = 0; k < SAM_STRESS_GROUP; k++) PetscCallVoid(PetscArrayzero(values[k], n));
  if (line && j > 0) return; /* there is only one row */
  if (!l->material && group != SAM_STRESS_NORMAL_Z) SamHalfSpaceStressRow(&source, group, j, n, values);
  if (!l->material && group == SAM_STRESS_NORMAL_Z) {
    /* stresses xz and yz by p */
    double *const rows[] = {values[2], values[0], values[1]};

    SamHalfSpaceStressRow(&source, SAM_STRESS_NORMAL_P, j, n, rows);
    PetscCallVoid(PetscArrayzero(values[2], n));
  }
  if (line)
    SamRadialAddLine(&of, side[0], n, values);
  else
    SamRadialAddRow(&of, side, j, n, values);
  Correct(l, side, group, j, n, values);
}

/* ---- the type ---- */

static PetscErrorCode Destroy(SamStress stress)
{
  PetscFunctionBegin;
  PetscCall(SamSplineDestroy(&((Layered *)stress->data)->table));
  PetscCall(SamBodyDestroy(&((Layered *)stress->data)->body));
  PetscCall(PetscFree(stress->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLayeredCreateStress(SamGrid grid, const SamFourierSettings *settings, PetscInt number, SamBody body,
                                      SamStress *stress)
{
  Layered *l;
  int      thick;

  PetscFunctionBegin;
  PetscCall(SamRadialSetUp());
  PetscCall(SamStressCreate(grid, settings, number, stress));
  PetscCall(PetscNew(&l));
  PetscCall(SamBodyReference(body));
  *l                 = (Layered){.body = body, .depth = -1, .base = (double)SamBodyAt(body, INFINITY).top};
  thick              = body->material[0].thickness >= THICK * grid->side[1];
  (*stress)->data    = l;
  (*stress)->poisson = body->material[0].poisson;
  (*stress)->groups  = SAM_STRESS_GROUPS;
  (*stress)->ops     = (SamStressOps){
        .row = Row, .usedepth = UseDepth, .atedge = thick ? SamHalfSpaceStressAtEdge : NULL, .destroy = Destroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
