/* Advice on what is prescribed: loads, motions, stresses and friction that are not small, or have another unit. */
#include "adviceimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/control.h>
#include <petsam/private/law.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <petsam/private/grid.h>
#include <math.h>

/* Ratio of a stress to Young's modulus below which it has no effect; grid width (m) that suggests wrong units */
#define SLIGHT 1e-8
#define WIDEST 100.0
/* A coefficient of friction from the first of these on is likely to be in percent; from the second on it means
   stick. */
#define PERCENT  5
#define STICKING 100

#define STROKE 0.02 /* ratio of displacement to half width of a worn contact, above which surfaces should slide */

void SamAdviceAddLoads(SamAdvice *a, PetscInt step, const SamControl *control)
{
  SamLoadRange *const most = &a->most;
  const PetscReal    *v = control->value, normal = v[SAM_COMPONENT_N];
  const PetscBool    *force      = control->force;
  const PetscBool    *creep      = control->creep;
  const PetscReal     x          = force[SAM_COMPONENT_TX] || creep[SAM_COMPONENT_TX] ? 0 : v[SAM_COMPONENT_TX];
  const PetscReal     y          = force[SAM_COMPONENT_TY] || creep[SAM_COMPONENT_TY] ? 0 : v[SAM_COMPONENT_TY];
  const SamConditions conditions = SamProblemGetConditions(a->setup->problem);

  for (PetscInt k = 0; k < SamConditionsCount(conditions); k++) {
    const SamCondition *one    = SamConditionsGet(conditions, k);
    const double        stress = strcmp(one->unit, "Pa") ? 0 : fabs((double)SamControlGet(control, one));

    if (stress > most->stress) most->stress_name = one->group;
    most->stress = PetscMax(most->stress, stress);
    for (PetscInt b = 0; b < 2; b++)
      if (!strncmp(one->name, b ? "bulk2_" : "bulk1_", 6)) most->bulk[b] = PetscMax(most->bulk[b], stress);
    if (!strcmp(one->name, SAM_FRICTION_SCALE)) most->friction = PetscMax(most->friction, SamControlGet(control, one));
  }
  most->force = force[SAM_COMPONENT_N];
  most->slide = PetscMax(most->slide, hypot(x, y));
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
    if (!force[c] && !creep[c] && v[c] != 0) most->moved[c] = PETSC_TRUE;
  for (PetscInt c = SAM_COMPONENT_MX; c < SAM_COMPONENTS; c++)
    if (!force[c] && !creep[c]) most->rotation = PetscMax(most->rotation, fabs(v[c]));
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    PetscReal *const own = c == SAM_COMPONENT_MZ ? &most->spin : &most->creep;

    if (creep[c]) *own = PetscMax(*own, fabs(v[c]));
  }
  if (!most->steps || normal > most->normal) a->largest = step;
  if (!most->steps++ || normal > most->normal) most->normal = normal;
  for (PetscInt k = 0; k < 2; k++) {
    const SamComponent c = k ? SAM_COMPONENT_MX : SAM_COMPONENT_MY; /* My tips along x */

    if (v[c] == 0) continue;
    if (force[c] && most->force && normal > 0)
      most->lever[k] = PetscMax(most->lever[k], fabs(v[c]) / normal);
    else
      most->open = PETSC_TRUE;
  }
}

/* True if the surface of body 2 varies from place to place, so that its position matters. */
static PetscBool HasPlace(SamAdvice *a)
{
  PetscBool     has = PETSC_FALSE;
  const SamLaw *laws;
  PetscInt      count = 0;

  if (!a->error) a->error = SamProblemGetLaws(a->setup->problem, &count, &laws);
  for (PetscInt k = 0; !a->error && k < count; k++) has = has || laws[k]->of_body[1];
  return has;
}

/* Advises on displacements, rotations and creepages that are not small, as the theory assumes. */
void SamAdviceMotion(SamAdvice *a)
{
  const SamExtent    *extent = &a->extent;
  const SamLoadRange *most   = &a->most;
  const double        width  = 2 * (double)PetscMax(extent->half[0], extent->half[1]);
  const SamProblem    p      = a->setup->problem;

  if (most->rotation > SAM_ADVICE_STEEPEST)
    SamAdviceSay(a, "",
                 "a rotation of %g is prescribed: rotations must be small, up to about %g rad (a degree is 0.0175)",
                 (double)most->rotation, SAM_ADVICE_STEEPEST);
  if (most->creep > SAM_ADVICE_STEEPEST)
    SamAdviceSay(
      a, "", "a creepage of %g is prescribed: it is the slip over the rolled distance, up to about %g (1 %% is 0.01)",
      (double)most->creep, SAM_ADVICE_STEEPEST);
  if (0.5 * (double)most->spin * width > SAM_ADVICE_STEEPEST)
    SamAdviceSay(
      a, "",
      "creep_spin %g 1/m is prescribed: its slip at the contact's edge is %.2g of the rolled distance, the limit is "
      "about %g: check the unit, 1/m",
      (double)most->spin, 0.5 * (double)most->spin * width, SAM_ADVICE_STEEPEST);
  if (extent->zones && (double)most->slide > width && (!SamProblemWears(p) || HasPlace(a)) && !SamProblemSlides(p))
    SamAdviceSay(
      a, "",
      "the prescribed tangential displacement, %g m, exceeds the width of the contact, %.3g m: without -slide surfaces "
      "are not moved past each other, so it must be small: give -slide, or check the unit, m",
      (double)most->slide, width);
}

/*
  Advises on a displacement in plane strain, which has no limit far away from a line load: by how much the bodies
  approach at a given load depends on where that is measured.
*/
void SamAdviceDatum(SamAdvice *a)
{
  const double    datum = (double)SamElasticityGetTraits(a->setup->elasticity).datum;
  const PetscBool slide = SamProblemSlides(a->setup->problem);

  if (!(datum > 0)) return;
  for (PetscInt c = SAM_COMPONENT_N; c <= SAM_COMPONENT_TY; c++) {
    const SamComponentName *name = &SamComponentNames[c];

    if (!a->most.moved[c] || (slide && c != SAM_COMPONENT_N)) continue;
    SamAdviceSay(a, "",
                 "%s is prescribed in plane strain, where it is relative to points at the distance of -plane_datum, by "
                 "default %.3g m, which follows from the grid: %s depends on it: give %s, or the distance as "
                 "-plane_datum",
                 name->rigid, datum, name->load, name->load);
  }
}

/*
  Advises on the error of the worn depth of surfaces that are not moved past each other, as measured on worn cylinders.
*/
void SamAdviceStroke(SamAdvice *a)
{
  const double ratio = (double)(a->most.slide / PetscMax(a->extent.half[0], a->extent.half[1]));

  if (a->stroke || !HasPlace(a) || !(ratio > STROKE) || SamProblemSlides(a->setup->problem)) return;
  a->stroke = PETSC_TRUE;
  SamAdviceSay(a, "",
               "the surfaces move by %.3g m, %.2g times the half width of the contact, and body 2 wears, but "
               "without -slide they are not moved past each other: the depth is wrong by about %.2g %%: give -slide",
               (double)a->most.slide, ratio, 100 * PetscMin(9 * ratio * ratio, 0.66 * ratio));
}

/* Compares the largest prescribed stress with the moduli of both bodies; `why` is empty if the unit may be right. */
static void ExplainLargest(const SamAdvice *a, char why[], size_t size)
{
  double young[2], stress = (double)a->most.stress;

  for (PetscInt b = 0; b < 2; b++) young[b] = (double)SamBodyAt(SamPairBody(a->setup->pair, b), INFINITY).young;
  SamExplainStress(stress, PetscMin(young[0], young[1]), SLIGHT, INFINITY, why, size);
  if (!why[0] && isinf(young[0])) young[0] = young[1];
  if (!why[0] && isinf(young[1])) young[1] = young[0];
  if (!why[0]) SamExplainStress(stress, PetscMax(young[0], young[1]), 0, SAM_ADVICE_HARDEST, why, size);
}

/* Advises on a prescribed stress or a grid that suggests another unit. */
void SamAdviceUnits(SamAdvice *a)
{
  const SamSetup     *s     = a->setup;
  const SamLoadRange *most  = &a->most;
  const double        width = (double)PetscMax(s->grid->width[0], s->grid->width[1]);
  char                why[160];

  ExplainLargest(a, why, sizeof(why));
  if (why[0]) SamAdviceSay(a, "", "the largest %s, %g Pa, %s", most->stress_name, (double)most->stress, why);
  if (width > WIDEST) SamAdviceSay(a, "grid_size", "the grid is %g m wide: check the unit, m", width);
}

/* Advises on a coefficient of friction, or a factor on it, in percent. */
void SamAdviceFriction(SamAdvice *a)
{
  PetscReal    friction;
  const double scale = (double)a->most.friction;

  a->error = SamLawGetFriction(SamProblemGetLaw(a->setup->problem, SAM_LAW_COULOMB), &friction);
  if (!a->error && friction < PERCENT && scale >= PERCENT && scale * (double)friction >= 1)
    SamAdviceSay(a, "",
                 SAM_FRICTION_SCALE " of %g makes the coefficient of friction %g: give a ratio, %g for %g percent",
                 scale, scale * (double)friction, scale / 100, scale);
  if (a->error || friction < PERCENT || friction > STICKING) return;
  SamAdviceSay(a, "friction", "the coefficient of friction is %g: give a ratio, %g for %g percent", (double)friction,
               (double)friction / 100, (double)friction);
}
