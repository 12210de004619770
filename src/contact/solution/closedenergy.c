/*
  The dissipated energy of a step in closed form, where there is one.

  For alike bodies with quadratic gaps, constant N, and T along one line, it is the closed form of Cattaneo, Mindlin and
  Deresiewicz: with t = T/(mu N), its change over 2 mu N after a reversal, and c = disp/T without slip,

      E = 1.8 c (mu N)^2 (1 - (1 - t)^(5/3) - 5/6 t (1 + (1 - t)^(2/3))),      disp = 1.5 c mu N (1 - (1 - t)^(2/3)),

  Both are doubled after a reversal. The second equation gives c from the solution's displacement, which is accurate to
  1e-3 where the energy is wrong by half. In plane strain the displacement has no limit, and the approach of two
  cylinders gives the energy per length: E = (mu N)^2/(pi E*) (x ln(x) + (1 - x^2)/2), x = 1 - t. Both forms hold while
  all steps since the first one meet these conditions. Where t is small they are differences of numbers that are nearly
  the same, and are replaced by their series, mu N disp t^2/18 (1 + t/2) and (mu N)^2/(6 pi E*) t^3 (1 + t/2).

  Source: R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327.
*/
#include <petsam/private/bodyimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/body.h>
#include <petsam/private/law.h>
#include <petsam/private/problem.h>
#include <math.h>

#define ALIKE 1e-6 /* smaller couplings of bodies, or changes of a load relative to the largest load, count as none */

#define SMALL 1e-3 /* t below which the series is used, within about t^2 */

/* Numbers that the state keeps of the load path so far, in a plane of T */
typedef struct {
  double stage;                        /* one of the stages below */
  double friction;                     /* coefficient */
  double line[2], bound, moment[2];    /* direction of T; mu N (N); M_x and M_y (N m) */
  double reversed, start, last, limit; /* 1: after a reversal; T (N) at the branch's start, now, and at its end */
  double start_moved[2], moved[2];     /* m: displacement along x and y at the start of the branch, and now */
  double before, energy;               /* J: energy of the earlier branches, and of this one */
} Path;
enum { BEGINS, KNOWN, LOST };
#define VALUES ((PetscInt)(sizeof(Path) / sizeof(double)))

static const SamStateNumber declared = {"closed_form", "1",           NULL, SAM_NUMBER_REAL, VALUES, PETSC_TRUE,
                                        PETSC_FALSE,   SAM_JOIN_LAST, 0};

PetscErrorCode SamSolutionDeclareClosed(SamState state)
{
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareOptional(state, &declared, BEGINS, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the bodies and laws have a closed form. */
static PetscErrorCode Has(SamProblem p, PetscReal *friction, PetscBool *has)
{
  const SamElasticity       e      = SamProblemGetElasticity(p);
  const SamElasticityTraits traits = SamElasticityGetTraits(e);
  const SamPair             pair   = SamElasticityGetPair(e);
  const SamGrid             grid   = SamProblemGetGrid(p);
  const SamLaw              law    = SamProblemGetLaw(p, SAM_LAW_COULOMB);
  const SamLaw             *laws;
  PetscInt                  count;
  PetscBool                 usual = SamMotionOf(e)->continues;

  PetscFunctionBegin;
  PetscCall(SamLawGetFriction(law, friction));
  PetscCall(SamProblemGetLaws(p, &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    usual = usual && !laws[k]->remembers && (laws[k] == law || laws[k]->always || laws[k]->accumulates);
  *has = usual && *friction > 0 && !traits.periodic && !traits.patch && SamPairIsUniform(pair) &&
         SamPairFilm(pair) == 0 &&
         SamPairCoupling(pair, PETSC_PI / (double)grid->length, PETSC_PI / (double)grid->side[1]) < ALIKE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the motion of a step consists of loads only, or of displacements along x and y only. */
static PetscBool IsPlain(SamProblem p, const SamSolution *s)
{
  const SamConditions conditions = SamProblemGetConditions(p);
  const SamControl   *control    = &s->control;
  PetscBool           plain      = s->rolled == 0;

  for (PetscInt k = 0; k < SamConditionsCount(conditions); k++) {
    const SamCondition *one = SamConditionsGet(conditions, k);

    plain = plain && SamControlGet(control, one) == one->usual;
  }
  if (control->value[SAM_COMPONENT_MX] != 0 || control->value[SAM_COMPONENT_MY] != 0)
    plain =
      plain && control->force[SAM_COMPONENT_MX] && control->force[SAM_COMPONENT_MY] && control->force[SAM_COMPONENT_N];
  return plain;
}

/* Returns the energy of a branch whose T changed by t and whose displacement changed by `moved`; `reversed`: after a
   reversal. */
static double ClosedOf(SamProblem p, double bound, double t, double moved, PetscBool reversed)
{
  const double x = 1 - t;

  if (SamGridIsRow(SamProblemGetGrid(p)))
    return (reversed ? 2 : 1) * bound * bound /
           (PETSC_PI * (double)SamElasticityGetModulus(SamProblemGetElasticity(p))) *
           (t < SMALL ? t * t * t / 6 * (1 + t / 2) : x * log(x) + 0.5 * (1 - x * x));
  if (t < SMALL) return bound * moved * t * t / 18 * (1 + t / 2);
  return 1.2 * bound * moved / (1 - pow(x, 2. / 3)) * (1 - pow(x, 5. / 3) - 5 * t / 6 * (1 + pow(x, 2. / 3)));
}

/* Begins a branch at a reversal of T: Masing's rule holds until T returns to the point of the last reversal. */
static void Reverse(Path *path)
{
  path->before += path->energy;
  path->limit    = path->reversed > 0 ? path->start : -path->last;
  path->start    = path->last;
  path->reversed = 1;
  for (int k = 0; k < 2; k++) path->start_moved[k] = path->moved[k];
}

/*
  Continues the closed form over a step with constant N and with T on a line through the contact's centre, which lies
  beside the origin by the moments over N: T twists a contact whose centre is beside its line.
*/
static void Follow(SamProblem p, Path *path, const SamSolution *s)
{
  const PetscInt  c[2] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY}, m[2] = {SAM_COMPONENT_MX, SAM_COMPONENT_MY};
  const double    bound = path->friction * (double)s->load[SAM_COMPONENT_N], slight = ALIKE * bound;
  const double    length  = (double)SamProblemGetGrid(p)->length;
  const double    load[2] = {(double)s->load[c[0]], (double)s->load[c[1]]}, size = hypot(load[0], load[1]);
  const PetscBool first  = path->line[0] == 0 && path->line[1] == 0,
                  begins = first && path->bound == 0 ? PETSC_TRUE : PETSC_FALSE;
  double along, across, turned = 0, way = 0, twist = fabs((double)s->load[SAM_COMPONENT_MZ]), t;

  /* N that changes while T leaves zero is not constant, but for the step that begins the contact with N, then T. */
  if (first && (path->bound == 0 || size <= slight)) path->bound = bound;
  for (int k = 0; k < 2 && first; k++) {
    path->moment[k] = (double)s->load[m[k]];
    if (size > slight) path->line[k] = load[k] / size;
    if (size <= slight) path->start_moved[k] = (double)s->rigid[c[k]];
  }
  along  = load[0] * path->line[0] + load[1] * path->line[1];
  across = load[0] * path->line[1] - load[1] * path->line[0];
  if ((along - path->last) * (path->last - path->start) < 0) Reverse(path);
  for (int k = 0; k < 2; k++) {
    path->moved[k] = (double)s->rigid[c[k]];
    way += (path->moved[k] - path->start_moved[k]) * path->line[k];
    turned = PetscMax(turned, fabs((double)s->load[m[k]] - path->moment[k]));
    if (bound > 0) twist += fabs(path->friction * (double)s->load[m[k]] / bound * load[k]);
  }
  path->last = along;
  t          = fabs(along - path->start) / ((path->reversed > 0 ? 2 : 1) * bound);
  if ((begins && size > slight && s->control.together) || fabs(bound - path->bound) > slight || fabs(across) > slight ||
      !(t < 1) || PetscMax(twist, turned) > slight * length ||
      (path->reversed > 0 && fabs(along - path->start) > fabs(path->limit - path->start) + slight))
    path->stage = LOST;
  else
    path->energy = t > 0 ? ClosedOf(p, bound, t, fabs(way), path->reversed > 0 ? PETSC_TRUE : PETSC_FALSE) : 0;
}

PetscErrorCode SamSolutionFollowClosed(SamProblem p, SamState state, const SamSolution *before, const SamSolution *s,
                                       PetscReal stick_cells, PetscReal *energy)
{
  const PetscInt id = SamStateFindNumber(state, declared.name);
  Path           path, last;
  PetscBool      has, quadratic;
  PetscReal      friction;

  PetscFunctionBegin;
  *energy = NAN;
  memcpy(&last, SamStateNumbers(state, id, SAM_COMMITTED), sizeof(last));
  path = last;
  if (path.stage == BEGINS) {
    PetscCall(Has(p, &friction, &has));
    path.friction = (double)friction;
    path.stage    = has && !before ? KNOWN : LOST;
  }
  if (path.stage == KNOWN) {
    PetscCall(SamProblemIsQuadratic(p, &quadratic));
    PetscCall(Has(p, &friction, &has));
    if (!quadratic || !has || friction != path.friction || stick_cells == 0 || !IsPlain(p, s)) path.stage = LOST;
  }
  if (path.stage == KNOWN) Follow(p, &path, s);
  if (path.stage == KNOWN) *energy = (path.before - last.before) + (path.energy - last.energy);
  memcpy(SamStateNumbers(state, id, SAM_TRIED), &path, sizeof(path));
  PetscFunctionReturn(PETSC_SUCCESS);
}
