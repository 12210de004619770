/*
  Fatigue parameters of a cycle of stresses at one point.

  Planes: the maximum over planes is searched on a hemisphere of normals, 10 degrees apart; then from the best of them,
  from other normals that are nearly as good and point elsewhere, and from the plane of maximum tension, by steps in
  angle that are halved down to a sixth of a degree; then by Newton's method. As the largest of smooth functions of the
  angles (of pairs of states for SWT, of weights of states for the radius of a circle) a parameter has no kink at its
  maximum.

  The circle about the path of the shear stress in a plane is computed only if the larger circle about the path's
  rectangle would make the plane the best so far.
*/
#include <petsam/private/fatigue.h>
#include <petsam/private/stressimpl.h>

enum { XX = SAM_STRESS_XX, YY = SAM_STRESS_YY, ZZ = SAM_STRESS_ZZ };
enum { XY = SAM_STRESS_XY, XZ = SAM_STRESS_XZ, YZ = SAM_STRESS_YZ, COMPONENTS = SAM_STRESS_COMPONENTS };

/* Degrees between the first normals; number of starts; largest and smallest step around the best; angle between
   starts */
enum { COARSE = 10, STARTS = 5 };
#define FIRST_STEP 5.0
#define LAST_STEP  0.15
#define ELSEWHERE  20.0
/* Least ratio of a start's value to the best value at which this start is tried */
#define NEARLY 0.9

/* Angle between the planes of a paraboloid; least curvature, relative to the largest; number of steps to its top */
#define NEARBY 1e-4
#define FLAT   1e-6
enum { STEPS = 3 };

/* Least relative increase of the parameter by a step of the search */
#define CLIMB 1e-6

#define DEGREE (PETSC_PI / 180)

/* The parameters that are the maximum over planes */
typedef enum { FINDLEY, SWT, FATEMI_SOCIE } Kind;

/* A cycle, with the strains of its states for SWT, and memory for a path: (states, 2) */
typedef struct {
  Kind                       kind;
  const SamFatigueConstants *constants;
  PetscInt                   states;
  const double              *stress, *strain;
  double                    *path;
} Cycle;

/* ---- on a plane ---- */

/* Computes n.s.m of all states; the two vectors may be the same. */
SAM_VECTORIZED static void Project(PetscInt states, const double *s, const double n[3], const double m[3],
                                   PetscInt stride, double *to)
{
  const double a = n[0] * m[0], b = n[1] * m[1], c = n[2] * m[2], d = n[0] * m[1] + n[1] * m[0],
               e = n[0] * m[2] + n[2] * m[0], f = n[1] * m[2] + n[2] * m[1];

  for (PetscInt k = 0; k < states; k++)
    to[k * stride] = a * s[XX * states + k] + b * s[YY * states + k] + c * s[ZZ * states + k] + d * s[XY * states + k] +
                     e * s[XZ * states + k] + f * s[YZ * states + k];
}

static void FindEnds(PetscInt n, const double x[], PetscInt stride, double *least, double *most)
{
  *least = *most = x[0];
  for (PetscInt k = 1; k < n; k++) {
    *least = fmin(*least, x[k * stride]);
    *most  = fmax(*most, x[k * stride]);
  }
}

static double ShearModulus(const Cycle *c)
{
  return (double)c->constants->young / (2 * (1 + (double)c->constants->poisson));
}

/* Returns the factor of the shear amplitude of a plane with that normal stress. */
static double Factor(const Cycle *c, double normal)
{
  const SamFatigueConstants *k = c->constants;

  if (c->kind == FINDLEY) return 1;
  return (1 + (double)k->fatemi_socie_k * normal / (double)k->yield) / ShearModulus(c);
}

/* Returns the derivative of the parameter of a plane of that shear amplitude by its normal stress. */
static double ByNormal(const Cycle *c, double amplitude)
{
  const SamFatigueConstants *k = c->constants;

  if (c->kind == FINDLEY) return (double)k->findley_k;
  return amplitude / ShearModulus(c) * (double)k->fatemi_socie_k / (double)k->yield;
}

/* Returns the parameter of a plane whose shear stress has that amplitude. */
static double Combine(const Cycle *c, double amplitude, double normal)
{
  const double more = c->kind == FINDLEY ? (double)c->constants->findley_k * normal : 0;

  return Factor(c, normal) * amplitude + more;
}

/*
  Returns the size that the parameter would have if all stress acted on one plane, as a scale for differences.
*/
static double Scale(const Cycle *c)
{
  double least, most, range = 0, size = 0;

  for (PetscInt k = 0; k < COMPONENTS; k++) {
    FindEnds(c->states, c->stress + k * c->states, 1, &least, &most);
    range = fmax(range, most - least);
    size  = fmax(size, fmax(fabs(least), fabs(most)));
  }
  return Combine(c, 0.5 * range, size);
}

/* Computes a plane's normal and two directions in it. */
static void SetFrame(double theta, double phi, double n[3], double u[3], double v[3])
{
  const double s = sin(theta), c = cos(theta), sp = sin(phi), cp = cos(phi);

  n[0] = s * cp;
  n[1] = s * sp;
  n[2] = c;
  u[0] = c * cp;
  u[1] = c * sp;
  u[2] = -s;
  v[0] = -sp;
  v[1] = cp;
  v[2] = 0;
}

/* Returns the parameter of a plane; a result below `best` may be any smaller value. */
static double OnPlane(const Cycle *c, double theta, double phi, double best)
{
  double n[3], u[3], v[3], least, most, normal, ends[2][2], center[2];

  SetFrame(theta, phi, n, u, v);
  Project(c->states, c->stress, n, n, 1, c->path);
  FindEnds(c->states, c->path, 1, &least, &normal);
  if (c->kind == SWT) {
    if (normal <= 0) return 0;
    Project(c->states, c->strain, n, n, 1, c->path);
    FindEnds(c->states, c->path, 1, &least, &most);
    return normal * 0.5 * (most - least);
  }
  Project(c->states, c->stress, n, u, 2, c->path);
  Project(c->states, c->stress, n, v, 2, c->path + 1);
  for (int d = 0; d < 2; d++) FindEnds(c->states, c->path + d, 2, &ends[d][0], &ends[d][1]);
  /* The amplitude is between half the longer side of the path's rectangle and half its diagonal. */
  most = Factor(c, normal) < 0 ? fmax(ends[0][1] - ends[0][0], ends[1][1] - ends[1][0])
                               : hypot(ends[0][1] - ends[0][0], ends[1][1] - ends[1][0]);
  most = Combine(c, 0.5 * most, normal);
  if (most <= best) return most;
  return Combine(c, SamSmallestBall(2, c->states, c->path, center), normal);
}

/* ---- the best plane ---- */

typedef struct {
  double theta, phi, value;
} Plane;

/* Climbs from a plane by steps in both angles, which are halved when none increases the parameter. */
static void Climb(const Cycle *c, Plane *at)
{
  for (double step = FIRST_STEP * DEGREE; step >= LAST_STEP * DEGREE;) {
    const double turn = step / fmax(sin(at->theta), 0.1);
    Plane        best = *at;

    for (int k = 0; k < 8; k++) {
      static const int way[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
      Plane            next      = {at->theta + way[k][0] * step, at->phi + way[k][1] * turn, 0};

      next.value = OnPlane(c, next.theta, next.phi, best.value);
      if (next.value > best.value) best = next;
    }
    if (best.value > at->value + CLIMB * fabs(at->value))
      *at = best;
    else
      step *= 0.5;
  }
}

/* Returns the plane whose normal is turned by two small angles. */
static Plane Turned(const Cycle *c, const Plane *from, double a, double b)
{
  double n[3], u[3], v[3];
  Plane  to = {0, 0, 0};

  SetFrame(from->theta, from->phi, n, u, v);
  for (int d = 0; d < 3; d++) n[d] += a * u[d] + b * v[d];
  to.theta = atan2(hypot(n[0], n[1]), n[2]);
  to.phi   = atan2(n[1], n[0]);
  to.value = OnPlane(c, to.theta, to.phi, -INFINITY);
  return to;
}

/*
  Finds the angles to the top of the paraboloid through the parameter nearby, along those of its axes along which it has
  one: on a circle of equal planes it has none along the circle.
*/
static void FindTop(const Cycle *c, const Plane *at, double step[2])
{
  const double h = NEARBY, ends[3][2] = {{Turned(c, at, h, 0).value, Turned(c, at, -h, 0).value},
                                         {Turned(c, at, 0, h).value, Turned(c, at, 0, -h).value},
                                         {Turned(c, at, h, h).value, Turned(c, at, -h, -h).value}};
  double       slope[2], curve[3], mixed, angle;

  for (int k = 0; k < 3; k++) curve[k] = (ends[k][0] + ends[k][1] - 2 * at->value) / (h * h);
  for (int k = 0; k < 2; k++) slope[k] = (ends[k][0] - ends[k][1]) / (2 * h);
  mixed   = 0.5 * (curve[2] - curve[0] - curve[1]);
  angle   = 0.5 * atan2(2 * mixed, curve[0] - curve[1]);
  step[0] = step[1] = 0;
  for (int k = 0; k < 2; k++, angle += PETSC_PI / 2) {
    const double x = cos(angle), y = sin(angle), down = -(x * x * curve[0] + 2 * x * y * mixed + y * y * curve[1]);
    const double way = (x * slope[0] + y * slope[1]) / down;

    if (!(down > FLAT * (fabs(curve[0]) + fabs(curve[1])) && fabs(way) < FIRST_STEP * DEGREE)) continue;
    step[0] += way * x;
    step[1] += way * y;
  }
}

/* Moves to the top of a paraboloid while that is better; most of the digits come with the second step. */
static void StepToTop(const Cycle *c, Plane *at)
{
  for (int k = 0; k < STEPS; k++) {
    double step[2];
    Plane  top;

    FindTop(c, at, step);
    top = Turned(c, at, step[0], step[1]);
    if (!(top.value > at->value)) return;
    *at = top;
  }
}

/* Gets the normal of a plane, or its opposite, so that its z is not negative. */
static void GetNormal(const Plane *plane, double normal[3])
{
  double u[3], v[3];

  SetFrame(plane->theta, plane->phi, normal, u, v);
  for (int d = 0; d < 3 && cos(plane->theta) < 0; d++) normal[d] = -normal[d];
}

static PetscBool IsElsewhere(const Plane *a, const Plane *b)
{
  double n[2][3], u[3], v[3];

  SetFrame(a->theta, a->phi, n[0], u, v);
  SetFrame(b->theta, b->phi, n[1], u, v);
  return fabs(n[0][0] * n[1][0] + n[0][1] * n[1][1] + n[0][2] * n[1][2]) < cos(ELSEWHERE * DEGREE);
}

/* Adds a plane to the best starts if it is among them; starts differ in direction. */
static void Offer(Plane starts[STARTS], PetscInt *count, Plane plane)
{
  PetscInt place = *count;

  for (PetscInt k = 0; k < *count; k++)
    if (!IsElsewhere(&starts[k], &plane)) {
      if (starts[k].value >= plane.value) return;
      place = k;
      break;
    }
  if (place == STARTS) {
    place = 0;
    for (PetscInt k = 1; k < STARTS; k++)
      if (starts[k].value < starts[place].value) place = k;
    if (starts[place].value >= plane.value) return;
  } else if (place == *count)
    (*count)++;
  starts[place] = plane;
}

/*
  Returns the plane across the direction of the largest principal stress of all states: there it is under tension if any
  is.
*/
static Plane TensilePlane(const Cycle *c)
{
  double   p[3], s[COMPONENTS], n[3], most = -INFINITY;
  PetscInt state = 0;

  for (PetscInt k = 0; k < c->states; k++) {
    for (PetscInt d = 0; d < COMPONENTS; d++) s[d] = c->stress[d * c->states + k];
    SamPrincipalOf(s, p);
    if (p[0] > most) state = k;
    most = fmax(most, p[0]);
  }
  for (PetscInt d = 0; d < COMPONENTS; d++) s[d] = c->stress[d * c->states + state];
  SamPrincipalDirection(s, most, n);
  return (Plane){acos(PetscMin(PetscMax(n[2], -1), 1)), atan2(n[1], n[0]), 0};
}

/*
  Finds the planes to climb from: the best ones of a search by 10 degrees, and one under tension; returns the best
  value.
*/
static double FindStarts(const Cycle *c, double margin, Plane starts[STARTS], PetscInt *count)
{
  Plane  plane = TensilePlane(c);
  double best;

  plane.value = best = OnPlane(c, plane.theta, plane.phi, -INFINITY);
  Offer(starts, count, plane);
  for (int t = 0; t <= 90; t += COARSE) {
    const int turns = t == 0 ? 1 : (int)ceil(360 / COARSE * sin(t * DEGREE)), last = t == 90 ? turns / 2 : turns;

    for (int k = 0; k < last || k == 0; k++) {
      plane       = (Plane){t * DEGREE, 2 * PETSC_PI * k / turns, 0};
      plane.value = OnPlane(c, plane.theta, plane.phi, best - margin);
      if (plane.value < best - margin) continue;
      best = fmax(best, plane.value);
      Offer(starts, count, plane);
    }
  }
  return best;
}

static void ComputeStrains(const SamFatigueCycle *c, double strain[])
{
  const double *s[COMPONENTS];
  double       *e[COMPONENTS];

  for (PetscInt k = 0; k < COMPONENTS; k++) {
    s[k] = c->stress + k * c->states;
    e[k] = strain + k * c->states;
  }
  SamStressStrain(c->states, c->constants->young, c->constants->poisson, s, e);
}

/* Sets up the cycle of a parameter of planes. */
static Cycle CycleOf(Kind kind, const SamFatigueCycle *of)
{
  if (kind == SWT) ComputeStrains(of, of->scratch + 2 * of->states);
  return (Cycle){kind, of->constants, of->states, of->stress, of->scratch + 2 * of->states, of->scratch};
}

/* Finds the best plane; false: SWT is 0 on all planes. */
static PetscBool FindBest(const Cycle *c, Plane *plane)
{
  const PetscBool swt    = c->kind == SWT ? PETSC_TRUE : PETSC_FALSE; /* SWT is never negative */
  const double    margin = swt ? INFINITY : (1 - NEARLY) * Scale(c);
  Plane           starts[STARTS];
  PetscInt        count = 0, winner = 0;
  const double    best = FindStarts(c, margin, starts, &count);

  if (swt && best <= 0) return PETSC_FALSE;
  for (PetscInt k = 0; k < count; k++) {
    if (starts[k].value < (swt ? NEARLY * best : best - margin)) continue;
    Climb(c, &starts[k]);
    if (starts[k].value >= starts[winner].value) winner = k;
  }
  *plane = starts[winner];
  StepToTop(c, plane);
  return PETSC_TRUE;
}

/* Returns the parameter of the best plane, and its normal. */
static double LargestOverPlanes(Kind kind, const SamFatigueCycle *of, double normal[3])
{
  const Cycle c     = CycleOf(kind, of);
  Plane       plane = {0, 0, 0};

  for (int d = 0; d < 3; d++) normal[d] = NAN;
  if (FindBest(&c, &plane)) GetNormal(&plane, normal);
  return plane.value;
}

double SamFatigueFindley(const SamFatigueCycle *c, double more[])
{
  return LargestOverPlanes(FINDLEY, c, more);
}

double SamFatigueSWT(const SamFatigueCycle *c, double more[])
{
  return LargestOverPlanes(SWT, c, more);
}

double SamFatigueFatemiSocie(const SamFatigueCycle *c, double more[])
{
  return LargestOverPlanes(FATEMI_SOCIE, c, more);
}

/* ---- derivatives by the stresses ---- */

/* Part of the radius by which a state on the circle may be inside of it; and by which two may not be opposite */
#define ON_CIRCLE 1e-10
#define OPPOSITE  1e-12

/* States on the circle, whose weights add up to 1; the forces of these sizes along their radii are in balance. */
typedef struct {
  PetscInt state[3];
  double   weight[3];
} Support;

static double Cross(const double a[2], const double b[2])
{
  return a[0] * b[1] - a[1] * b[0];
}

/* Replaces the states in the plane by their radii over that of the circle; returns that radius. */
static double FindRadii(PetscInt states, double path[])
{
  double       center[SAM_BALL_DIMENSION];
  const double radius = SamSmallestBall(2, states, path, center);

  for (PetscInt k = 0; k < 2 * states; k++) path[k] = radius > 0 ? (path[k] - center[k % 2]) / radius : 0;
  return radius;
}

static PetscBool IsOnCircle(const double u[2])
{
  return hypot(u[0], u[1]) > 1 - ON_CIRCLE ? PETSC_TRUE : PETSC_FALSE;
}

/* Takes three states on the circle if their least weight is larger than that of those before; returns the least. */
static double OfferThree(const double path[], PetscInt i, PetscInt j, PetscInt k, double least, Support *support)
{
  const double *const a = path + 2 * i, *const b = path + 2 * j, *const c = path + 2 * k;
  const double w[3] = {Cross(b, c), Cross(c, a), Cross(a, b)}, sum = w[0] + w[1] + w[2];
  const double lowest = sum != 0 ? fmin(fmin(w[0] / sum, w[1] / sum), w[2] / sum) : -INFINITY;

  if (lowest <= least) return least;
  *support = (Support){{i, j, k}, {w[0] / sum, w[1] / sum, w[2] / sum}};
  return lowest;
}

/* Finds the states that determine the circle: two that are opposite, or three. */
static Support FindSupport(PetscInt states, const double path[])
{
  Support support = {{0, 0, 0}, {0, 0, 0}};
  double  least   = -INFINITY;

  for (PetscInt i = 0; i < states; i++)
    for (PetscInt j = 0; j < i && IsOnCircle(path + 2 * i); j++)
      if (path[2 * i] * path[2 * j] + path[2 * i + 1] * path[2 * j + 1] < OPPOSITE - 1)
        return (Support){{i, j, i}, {0.5, 0.5, 0}};
  for (PetscInt i = 0; i < states && least < 0; i++)
    for (PetscInt j = 0; j < i && least < 0 && IsOnCircle(path + 2 * i); j++)
      for (PetscInt k = 0; k < j && least < 0 && IsOnCircle(path + 2 * j); k++)
        if (IsOnCircle(path + 2 * k)) least = OfferThree(path, i, j, k, least, &support);
  return support;
}

/* Adds the derivatives of n.s.v in a state. */
static void AddProjected(PetscInt states, PetscInt k, const double n[3], const double v[3], double factor,
                         double slope[])
{
  for (int d = 0; d < 3; d++) slope[(XX + d) * states + k] += factor * n[d] * v[d];
  slope[XY * states + k] += factor * (n[0] * v[1] + n[1] * v[0]);
  slope[XZ * states + k] += factor * (n[0] * v[2] + n[2] * v[0]);
  slope[YZ * states + k] += factor * (n[1] * v[2] + n[2] * v[1]);
}

/* Returns the state of the largest value, or by a sign of -1 the smallest one. */
static PetscInt StateOf(PetscInt states, const double x[], double sign)
{
  PetscInt most = 0;

  for (PetscInt k = 1; k < states; k++)
    if (sign * x[k] > sign * x[most]) most = k;
  return most;
}

/* Sets the derivatives of SWT, the product of the largest stress and half the range of the strain. */
static void SetSlopesOfSWT(const Cycle *c, const double n[3], double slope[])
{
  const double young = (double)c->constants->young, nu = (double)c->constants->poisson;
  PetscInt     most, end[2];
  double       tension, range;

  Project(c->states, c->stress, n, n, 1, c->path);
  most    = StateOf(c->states, c->path, 1);
  tension = c->path[most];
  Project(c->states, c->strain, n, n, 1, c->path);
  for (int k = 0; k < 2; k++) end[k] = StateOf(c->states, c->path, k ? -1 : 1);
  range = c->path[end[0]] - c->path[end[1]];
  (void)PetscArrayzero(slope, COMPONENTS * c->states);
  AddProjected(c->states, most, n, n, 0.5 * range, slope);
  for (int k = 0; k < 2; k++) {
    const double by_strain = (k ? -0.5 : 0.5) * tension / young;

    AddProjected(c->states, end[k], n, n, (1 + nu) * by_strain, slope);
    for (int d = 0; d < 3; d++) slope[(XX + d) * c->states + end[k]] -= nu * by_strain;
  }
}

/* Sets the derivatives of a parameter of the radius of the circle and the largest stress. */
static void SetSlopesOfShear(const Cycle *c, const Plane *plane, double slope[])
{
  double   n[3], u[3], v[3], normal, radius;
  Support  support;
  PetscInt most;

  SetFrame(plane->theta, plane->phi, n, u, v);
  Project(c->states, c->stress, n, n, 1, c->path);
  most   = StateOf(c->states, c->path, 1);
  normal = c->path[most];
  Project(c->states, c->stress, n, u, 2, c->path);
  Project(c->states, c->stress, n, v, 2, c->path + 1);
  radius  = FindRadii(c->states, c->path);
  support = FindSupport(c->states, c->path);
  (void)PetscArrayzero(slope, COMPONENTS * c->states);
  AddProjected(c->states, most, n, n, ByNormal(c, radius), slope);
  for (int k = 0; k < 3; k++) {
    const PetscInt state  = support.state[k];
    const double   factor = support.weight[k] * Factor(c, normal);

    AddProjected(c->states, state, n, u, factor * c->path[2 * state], slope);
    AddProjected(c->states, state, n, v, factor * c->path[2 * state + 1], slope);
  }
}

double SamFatigueSlopes(SamFatigueParameter *parameter, const SamFatigueCycle *of, double slope[])
{
  const Kind  kind  = parameter == SamFatigueFindley ? FINDLEY : parameter == SamFatigueSWT ? SWT : FATEMI_SOCIE;
  const Cycle c     = CycleOf(kind, of);
  Plane       plane = {0, 0, 0};
  double      n[3];

  if (!FindBest(&c, &plane)) {
    (void)PetscArrayzero(slope, COMPONENTS * c.states);
    return 0;
  }
  GetNormal(&plane, n);
  if (kind == SWT)
    SetSlopesOfSWT(&c, n, slope);
  else
    SetSlopesOfShear(&c, &plane, slope);
  return plane.value;
}

/* ---- parameters without planes ---- */

/* Computes the deviators' five coordinates in which sqrt(S:S) is the length, and the largest mean stress. */
static double Deviators(PetscInt states, const double s[], double points[])
{
  double most = -INFINITY;

  for (PetscInt k = 0; k < states; k++) {
    const double xx = s[XX * states + k], yy = s[YY * states + k], zz = s[ZZ * states + k];
    double      *p = points + k * SAM_BALL_DIMENSION;

    p[0] = (xx - yy) / sqrt(2);
    p[1] = (2 * zz - xx - yy) / sqrt(6);
    p[2] = sqrt(2) * s[XY * states + k];
    p[3] = sqrt(2) * s[XZ * states + k];
    p[4] = sqrt(2) * s[YZ * states + k];
    most = fmax(most, (xx + yy + zz) / 3);
  }
  return most;
}

/* Returns the largest shear stress of a deviator given by these coordinates. */
static double LargestShear(const double p[])
{
  double s[COMPONENTS], principal[3];

  s[ZZ] = p[1] * 2 / sqrt(6);
  s[XX] = p[0] / sqrt(2) - 0.5 * s[ZZ];
  s[YY] = -p[0] / sqrt(2) - 0.5 * s[ZZ];
  s[XY] = p[2] / sqrt(2);
  s[XZ] = p[3] / sqrt(2);
  s[YZ] = p[4] / sqrt(2);
  SamPrincipalOf(s, principal);
  return 0.5 * (principal[0] - principal[2]);
}

double SamFatigueCrossland(const SamFatigueCycle *c, double more[])
{
  double       center[SAM_BALL_DIMENSION];
  const double mean = Deviators(c->states, c->stress, c->scratch);

  (void)more;
  return SamSmallestBall(SAM_BALL_DIMENSION, c->states, c->scratch, center) / sqrt(2) +
         (double)c->constants->crossland_alpha * mean;
}

double SamFatigueDangVan(const SamFatigueCycle *c, double more[])
{
  const PetscInt n = c->states;
  const double  *s = c->stress;
  double         center[SAM_BALL_DIMENSION], best = -INFINITY;

  (void)more;
  (void)Deviators(n, s, c->scratch);
  (void)SamSmallestBall(SAM_BALL_DIMENSION, n, c->scratch, center);
  for (PetscInt k = 0; k < n; k++) {
    double p[SAM_BALL_DIMENSION];

    for (PetscInt d = 0; d < SAM_BALL_DIMENSION; d++) p[d] = c->scratch[k * SAM_BALL_DIMENSION + d] - center[d];
    best = fmax(best, LargestShear(p) +
                        (double)c->constants->dang_van_alpha * (s[XX * n + k] + s[YY * n + k] + s[ZZ * n + k]) / 3);
  }
  return best;
}

/* ---- parameters of the surface ---- */

/* On the surface the stresses xz and yz are the shear; the sign does not matter. */
double SamFatigueRuiz(const SamFatigueCycle *c, double more[])
{
  const PetscInt      n = c->states;
  const double *const s = c->stress, *const slip = c->slip;
  double work = 0, longest = 0, way[3] = {0, 0, 0}, tension = 0;

  more[0] = NAN;
  if (!slip) return NAN;
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt next = (k + 1) % n;
    const double   x = slip[next], y = slip[n + next], length = hypot(x, y);

    work += fabs(s[XZ * n + next] * x + s[YZ * n + next] * y); /* a cell slips under the shear at the end of the step */
    if (length <= longest) continue;
    longest = length;
    way[0]  = x / length;
    way[1]  = y / length;
  }
  Project(n, s, way, way, 1, c->scratch);
  for (PetscInt k = 0; k < n; k++) tension = fmax(tension, c->scratch[k]);
  more[0] = tension * work / 4;
  return work / 4;
}
