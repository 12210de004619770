/*
  Stresses by a uniform traction on a rectangle of the surface.

  Problem. The stresses by a point force (Boussinesq, Cerruti), integrated over the rectangle, are sums of an
  antiderivative over its four corners. At a distance of n sides they cancel to 1/n^2 of their terms.

  Algorithm. With h the longer side and R the distance of the point from the centre:
    R < 8 h     the antiderivative at the corners;
    beyond      Gauss-Legendre quadrature of the point force with 5 x 5 points up to 13 h, 4 x 4 up to 45 h, 3 x 3 up to
                640 h, 2 x 2 beyond.
  The error is below 1e-12 of the largest kernel at that point. Lengths are measured in a power of two near h, so that
  nothing leaves the range of a double.

  Values at the centres of cells. A smooth shear that is replaced by its cells' means has jumps at their edges, whose
  stresses vary like logarithms from cell to cell near the surface: s_xx at the centre of a cell is wrong by
  -(2 ln 2/pi) hx dq_x/dx at z = 0, by less below it, and by nothing from z = h on. A series of waves of the cells'
  length gives the correction: with t = exp(-2 pi z/h), L = ln(1 + t) and M = (2 pi z/h) t/(1 + t), h the side in the
  direction of the derivative,
    s_xx += ((2 L - M) hx dq_x/dx + 2 nu L hy dq_y/dy)/pi      s_xy += L (hy dq_x/dy + hx dq_y/dx)/pi
    s_yy += (2 nu L hx dq_x/dx + (2 L - M) hy dq_y/dy)/pi      s_xz += M hx dp/dx/pi,  s_yz += M hy dp/dy/pi
    s_zz += M (hx dq_x/dx + hy dq_y/dy)/pi.
  With differences over two cells as derivatives, this changes only the kernels at the cell's neighbours.

  In plane strain, the stresses by a strip |x| < a are the closed forms of Johnson, section 2.5, by the angle subtended
  by the strip. Differences of fractions are multiplied out, so that nothing cancels far away.

  References: Love 1929, Phil. Trans. R. Soc. A 228, 377; Johnson 1985, Contact Mechanics, ch. 3; Kalker 1990,
  Three-dimensional Elastic Bodies in Rolling Contact, ch. 4 and app. C.
*/
#include <petsam/private/halfspace.h>
#include <math.h>

/* Points of the quadrature along a side, from the farthest distances, in longer sides, to the nearest; then none */
enum { GROUPS = SAM_STRESS_NORMAL_Z }; /* all groups of a half-space */
enum { RULES = 4, FEWEST = 2, POINTS = 5, CHUNK = 256 };
static const double nearest[RULES] = {640, 45, 13, 8};

/* Abscissae and weights, which sum up to 1, of 2 to 5 points on [-1, 1]. */
static const double gauss[RULES][POINTS][2] = {
  {{-0.57735026918962576, 0.5}, {0.57735026918962576, 0.5}},
  {{-0.77459666924148338, 5. / 18}, {0, 4. / 9}, {0.77459666924148338, 5. / 18}},
  {{-0.86113631159405258, 0.17392742256872693},
   {-0.33998104358485626, 0.32607257743127307},
   {0.33998104358485626, 0.32607257743127307},
   {0.86113631159405258, 0.17392742256872693}},
  {{-0.90617984593866399, 0.11846344252809454},
   {-0.53846931010568309, 0.23931433524968324},
   {0, 0.28444444444444444},
   {0.53846931010568309, 0.23931433524968324},
   {0.90617984593866399, 0.11846344252809454}},
};

/* ---- near: the corners ---- */

/* Computes 2 pi times the antiderivatives of a group at a corner. */
static void Corner(SamStressGroup group, double nu, double X, double Y, double z, double f[SAM_STRESS_GROUP])
{
  const double r = sqrt(X * X + Y * Y + z * z), xz = X * X + z * z, yz = Y * Y + z * z, t = r + z,
               angle = atan2(X * Y, z * r);

  switch (group) {
  case SAM_STRESS_PLANE_P:
    f[0] = -2 * nu * angle - (1 - 2 * nu) * atan2(X * Y, xz + z * r) + z * X * Y / (r * xz);
    f[1] = -2 * nu * angle - (1 - 2 * nu) * atan2(X * Y, yz + z * r) + z * X * Y / (r * yz);
    f[2] = -(1 - 2 * nu) * log(t) - z / r;
    break;
  case SAM_STRESS_PLANE_X:
    f[0] = 2 * asinh(Y / sqrt(xz)) + 2 * nu * Y / t + z * Y / (r * t) - z * z * Y / (r * xz);
    f[1] = 2 * nu * asinh(Y / sqrt(xz)) - 2 * nu * Y / t - z * Y / (r * t);
    f[2] = asinh(X / sqrt(yz)) - 2 * nu * X / t - z * X / (r * t);
    break;
  case SAM_STRESS_PLANE_Y:
    f[0] = 2 * nu * asinh(X / sqrt(yz)) - 2 * nu * X / t - z * X / (r * t);
    f[1] = 2 * asinh(X / sqrt(yz)) + 2 * nu * X / t + z * X / (r * t) - z * z * X / (r * yz);
    f[2] = asinh(Y / sqrt(xz)) - 2 * nu * Y / t - z * Y / (r * t);
    break;
  case SAM_STRESS_NORMAL_P:
    f[0] = -angle - z * X * Y / r * (1 / xz + 1 / yz);
    f[1] = z * z * Y / (r * xz);
    f[2] = z * z * X / (r * yz);
    break;
  default:
    f[0] = -angle + z * X * Y / (r * xz);
    f[1] = -z / r;
    f[2] = -angle + z * X * Y / (r * yz);
  }
}

static void Corners(const SamHalfSpaceSource *s, SamStressGroup group, double x, double y, double f[SAM_STRESS_GROUP])
{
  const double a = s->side[0] / 2, b = s->side[1] / 2;

  for (int k = 0; k < SAM_STRESS_GROUP; k++) f[k] = 0;
  for (int c = 0; c < 4; c++) {
    const double sign = c == 0 || c == 3 ? 1 : -1;
    double       at[SAM_STRESS_GROUP];

    Corner(group, s->poisson, x + (c & 1 ? -a : a), y + (c & 2 ? -b : b), s->depth, at);
    for (int k = 0; k < SAM_STRESS_GROUP; k++) f[k] += sign * at[k] / (2 * PETSC_PI);
  }
}

/* ---- far: point forces ---- */

/*
  Adds the stresses by point forces, times 2 pi w, at n points (x0 + k dx, y, z). s = 1/r and t = 1/(r + z).
*/
#define DEFINE_POINTS(Name, f0, f1, f2) \
  SAM_VECTORIZED static void Name(int n, double x0, double dx, double y, double z, double nu, double w, \
                                  double *restrict to0, double *restrict to1, double *restrict to2) \
  { \
    const double m = 1 - 2 * nu; \
\
    for (int k = 0; k < n; k++) { \
      const double x = x0 + (double)k * dx, r2 = x * x + y * y + z * z, s2 = 1 / r2, s = sqrt(s2), r = r2 * s, \
                   t = 1 / (r + z), s3 = s * s2, s5 = -3 * s3 * s2, t2 = m * s3 * t * t, t3 = t2 * t; \
\
      (void)(t3 + s5); \
      to0[k] += w * (f0); \
      to1[k] += w * (f1); \
      to2[k] += w * (f2); \
    } \
  }

DEFINE_POINTS(AddPlaneP, x *x *(z *s5 + (2 * r + z) * t2) + m * (z * s3 - s * t),
              y *y *(z *s5 + (2 * r + z) * t2) + m * (z * s3 - s * t), x *y *(z *s5 + (2 * r + z) * t2))
DEFINE_POINTS(AddPlaneX, x *(x *x *(s5 + (3 * r + z) * t3) + m * (s3 - 3 * s * t * t)),
              x *(y *y *(s5 + (3 * r + z) * t3) + m * (s3 - s * t * t)),
              y *(x *x *(s5 + (3 * r + z) * t3) - m * s * t * t))
DEFINE_POINTS(AddPlaneY, y *(x *x *(s5 + (3 * r + z) * t3) + m * (s3 - s * t * t)),
              y *(y *y *(s5 + (3 * r + z) * t3) + m * (s3 - 3 * s * t * t)),
              x *(y *y *(s5 + (3 * r + z) * t3) - m * s * t * t))
DEFINE_POINTS(AddNormalP, z *z *z *s5, x *z *z *s5, y *z *z *s5)
DEFINE_POINTS(AddNormalT, x *x *z *s5, x *y *z *s5, y *y *z *s5)

typedef void (*AddPoints)(int n, double x0, double dx, double y, double z, double nu, double w, double *to0,
                          double *to1, double *to2);
static const AddPoints add[GROUPS] = {
  [SAM_STRESS_PLANE_P] = AddPlaneP,   [SAM_STRESS_PLANE_X] = AddPlaneX,   [SAM_STRESS_PLANE_Y] = AddPlaneY,
  [SAM_STRESS_NORMAL_P] = AddNormalP, [SAM_STRESS_NORMAL_T] = AddNormalT,
};

/* Integrates over the n cells from (x0, y) on by one rule. */
static void Quadrature(const SamHalfSpaceSource *s, SamStressGroup group, int rule, double x0, double y, int n,
                       double *const to[SAM_STRESS_GROUP])
{
  const double area   = s->side[0] * s->side[1] / (2 * PETSC_PI);
  const int    points = FEWEST + rule;

  for (int k = 0; k < SAM_STRESS_GROUP; k++)
    for (int i = 0; i < n; i++) to[k][i] = 0;
  for (int j = 0; j < points; j++)
    for (int i = 0; i < points; i++)
      add[group](n, x0 + 0.5 * s->side[0] * gauss[rule][i][0], s->side[0], y + 0.5 * s->side[1] * gauss[rule][j][0],
                 s->depth, s->poisson, area * gauss[rule][i][1] * gauss[rule][j][1], to[0], to[1], to[2]);
}

/* ---- both ---- */

/* Chooses the quadrature rule for a cell whose centre is at the distance x, y; RULES: the corners are used. */
static int ChooseRule(const SamHalfSpaceSource *s, double x, double y)
{
  const double h = PetscMax(s->side[0], s->side[1]), R2 = x * x + y * y + s->depth * s->depth;
  int          rule = 0;

  while (rule < RULES && R2 < nearest[rule] * nearest[rule] * h * h) rule++;
  return rule;
}

/* Integrates over the n cells from (x0, y) on, in pieces of one rule. */
static void Cells(const SamHalfSpaceSource *s, SamStressGroup group, double x0, double y, int n,
                  double *const to[SAM_STRESS_GROUP])
{
  for (int k = 0, count; k < n; k += count) {
    const int rule                   = ChooseRule(s, x0 + (double)k * s->side[0], y);
    double   *part[SAM_STRESS_GROUP] = {to[0] + k, to[1] + k, to[2] + k};

    for (count = 1; k + count < n && count < CHUNK; count++)
      if (ChooseRule(s, x0 + (double)(k + count) * s->side[0], y) != rule) break;
    if (rule < RULES)
      Quadrature(s, group, rule, x0 + (double)k * s->side[0], y, count, part);
    else
      for (int i = 0; i < count; i++) {
        double f[SAM_STRESS_GROUP];

        Corners(s, group, x0 + (double)(k + i) * s->side[0], y, f);
        for (int m = 0; m < SAM_STRESS_GROUP; m++) part[m][i] = f[m];
      }
  }
}

/* ---- plane strain ---- */

/* Computes the stresses at (x, z) by the strip |x| < a under unit tractions. */
static void Strip(SamStressGroup group, double nu, double a, double x, double z, double f[SAM_STRESS_GROUP])
{
  const double r1 = (x - a) * (x - a) + z * z, r2 = (x + a) * (x + a) + z * z, product = r1 * r2;
  const double angle = 2 * atan2(2 * a * z, x * x - a * a + z * z),
               sine = 4 * a * z * (x * x - a * a - z * z) / product, cosine = -8 * a * x * z * z / product,
               ratio = -2 * atanh(2 * a * x / (x * x + a * a + z * z));
  /* By p: xx, zz, xz. By q_x: xx, zz (equal to xz by p) and xz (equal to xx by p). By q_y: xy and yz. */
  const double p[3] = {-(angle + sine) / (2 * PETSC_PI), -(angle - sine) / (2 * PETSC_PI), cosine / (2 * PETSC_PI)},
               q    = (2 * ratio - cosine) / (2 * PETSC_PI);

  f[0] = f[1] = f[2] = 0;
  if (group == SAM_STRESS_PLANE_P) f[0] = p[0];
  if (group == SAM_STRESS_PLANE_P) f[1] = nu * (p[0] + p[1]);
  if (group == SAM_STRESS_PLANE_X) f[0] = q;
  if (group == SAM_STRESS_PLANE_X) f[1] = nu * (q + p[2]);
  if (group == SAM_STRESS_PLANE_Y) f[2] = ratio / (2 * PETSC_PI);
  if (group == SAM_STRESS_NORMAL_P) f[0] = p[1];
  if (group == SAM_STRESS_NORMAL_P) f[1] = p[2];
  if (group == SAM_STRESS_NORMAL_T) f[0] = p[0];
  if (group == SAM_STRESS_NORMAL_T) f[2] = -angle / (2 * PETSC_PI);
}

/* Scales all lengths by a power of two near the longer side: the stresses depend on ratios of lengths only. */
static double ScaleSource(SamHalfSpaceSource *s)
{
  const double scale = scalbn(1, -ilogb(PetscMax(s->side[0], s->side[1])));

  s->side[0] *= scale;
  s->side[1] *= scale;
  s->depth *= scale;
  return scale;
}

void SamHalfSpaceStressCell(const PetscReal side[2], PetscReal poisson, const PetscReal point[3],
                            PetscReal stress[SAM_STRESS_COMPONENTS][SAM_STRESS_TRACTIONS])
{
  SamHalfSpaceSource s     = {{(double)side[0], (double)side[1]}, (double)point[2], (double)poisson};
  const double       scale = ScaleSource(&s);
  double             f[GROUPS][SAM_STRESS_GROUP];

  for (int g = 0; g < GROUPS; g++) {
    double *to[SAM_STRESS_GROUP] = {&f[g][0], &f[g][1], &f[g][2]};

    Cells(&s, (SamStressGroup)g, scale * (double)point[0], scale * (double)point[1], 1, to);
  }
  for (int c = 0; c < SAM_STRESS_COMPONENTS; c++)
    for (int t = 0; t < SAM_STRESS_TRACTIONS; t++)
      stress[c][t] = (PetscReal)f[SamStressKernels[c][t].group][SamStressKernels[c][t].member];
}

/* ---- rows of lags ---- */

/* Computes L and M of the correction (top of this file), over 2 pi: half for the difference of the neighbours, over
   pi. */
static void Jumps(double depth, double side, double *L, double *M)
{
  const double u = 2 * PETSC_PI * depth / side, t = exp(-u);

  *L = log1p(t) / (2 * PETSC_PI);
  *M = u * t / (1 + t) / (2 * PETSC_PI);
}

/* Adds the correction of values at centres at the lags (1, 0) and (0, 1). */
static void Correct(const SamHalfSpaceSource *s, SamStressGroup group, PetscInt j, PetscInt n,
                    double *const values[SAM_STRESS_GROUP])
{
  double Lx, Mx, Ly, My;

  Jumps(s->depth, s->side[0], &Lx, &Mx);
  Jumps(s->depth, s->side[1], &Ly, &My);
  if (j == 0 && n > 1) {
    if (group == SAM_STRESS_PLANE_X) values[0][1] -= 2 * Lx - Mx;
    if (group == SAM_STRESS_PLANE_X) values[1][1] -= 2 * s->poisson * Lx;
    if (group == SAM_STRESS_PLANE_Y) values[2][1] -= Lx;
    if (group == SAM_STRESS_NORMAL_P) values[1][1] -= Mx;
  } else if (j == 1 && n > 0) {
    if (group == SAM_STRESS_PLANE_X) values[2][0] -= Ly;
    if (group == SAM_STRESS_PLANE_Y) values[0][0] -= 2 * s->poisson * Ly;
    if (group == SAM_STRESS_PLANE_Y) values[1][0] -= 2 * Ly - My;
    if (group == SAM_STRESS_NORMAL_P) values[2][0] -= My;
  }
}

void SamHalfSpaceStressRow(const SamHalfSpaceSource *source, SamStressGroup group, PetscInt j, PetscInt n,
                           double *const values[SAM_STRESS_GROUP])
{
  SamHalfSpaceSource s = *source;

  for (PetscInt i = 0; i < n && isinf(s.side[1]); i++) {
    double f[SAM_STRESS_GROUP] = {0, 0, 0};

    if (j == 0) Strip(group, s.poisson, s.side[0] / 2, (double)i * s.side[0], s.depth, f);
    for (int k = 0; k < SAM_STRESS_GROUP; k++) values[k][i] = f[k];
  }
  if (isinf(s.side[1]) && j == 0) Correct(&s, group, 0, n, values);
  if (isinf(s.side[1])) return;
  (void)ScaleSource(&s);
  Cells(&s, group, 0, (double)j * s.side[1], (int)n, values);
  Correct(&s, group, j, n, values);
}

/* ---- the stresses of a body ---- */

static void Row(SamStress stress, const double side[2], double depth, SamStressGroup group, PetscInt j, PetscInt n,
                double *const values[SAM_STRESS_GROUP])
{
  const SamHalfSpaceSource source = {{side[0], side[1]}, depth, (double)stress->poisson};

  SamHalfSpaceStressRow(&source, group, j, n, values);
}

PetscErrorCode SamHalfSpaceCreateStress(SamGrid grid, const SamFourierSettings *settings, PetscInt body,
                                        PetscReal poisson, SamStress *stress)
{
  PetscFunctionBegin;
  PetscCheck(poisson > -1 && poisson <= 0.5, grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Poisson's ratio %.6g: expected a number above -1, up to 0.5", (double)poisson);
  PetscCall(SamStressCreate(grid, settings, body, stress));
  (*stress)->poisson = poisson;
  (*stress)->ops     = (SamStressOps){.row = Row, .atedge = SamHalfSpaceStressAtEdge};
  PetscFunctionReturn(PETSC_SUCCESS);
}
