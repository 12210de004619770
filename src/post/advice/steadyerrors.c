/*
  Estimates the error of a grid in steady rolling. The computed loads and creepages have errors of first order in the
  cells' size, and each step is also solved on half the cells (step/steadystep.c). The extrapolation minus the number is
  about its error.

  The errors of two other numbers of the last step depend on the width of zones in cells. The maximum slip velocity is
  accurate to 6 % if w, the area of slip over the length of the contact's edge, is more than 0.65 cells: on 77 spheres
  with several loads and creepages, compared with 384 cells, the largest errors were 2 % above w = 0.7, 7 % from 0.6 to
  0.7, 11 % from 0.5 to 0.6, 21 % from 0.4 to 0.5 and 39 % below. The area of stick is too small by up to 0.9 over the
  cells across it.
*/
#include "adviceimpl.h"
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <math.h>

#define GOOD  0.015 /* error on an advised grid, relative to the number */
#define SMALL 0.05  /* part of a moment over the radius of contact that counts as a force, and so on */
#define CLEAR 0.65  /* cells: w of a slip zone whose maximum velocity is accurate */
#define WIDE  0.8   /* w on a grid that is advised for the velocity */
#define STUCK 18    /* cells across a stick zone whose area has an error below 5 % */

/*
  Computes the errors of T_x, T_y, M_z, or of the corresponding creepages, relative to both forces and to the moment.
*/
static PetscErrorCode Compare(SamAdvice *a, PetscInt k, const SamStep *step, PetscBool load, double radius)
{
  const PetscInt c[3]   = {SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_MZ};
  const double   length = load ? radius : 1 / radius;
  double         value[3], both;

  PetscFunctionBegin;
  for (int n = 0; n < 3; n++) value[n] = (double)(load ? step->load : step->rigid)[c[n]];
  both = hypot(value[0], value[1]);
  for (int n = 0; n < 3; n++) {
    const char *const name = load ? SamComponentNames[c[n]].load : SamComponentNames[c[n]].creep;
    const double      size =
      n < 2 ? PetscMax(both, SMALL * fabs(value[2]) / length) : PetscMax(fabs(value[n]), SMALL * both * length);
    char      text[64];
    PetscReal fine;

    if (step->control.force[c[n]] == load) continue;
    (void)snprintf(text, sizeof(text), "%s_extrapolated", name);
    PetscCall(SamContactGetNumber(a->setup->contact, text, &fine));
    if (!(fabs((double)fine - value[n]) > a->rolling.error * size)) continue;
    a->rolling = (SamRollingError){
      .error = fabs((double)fine - value[n]) / size, .step = k, .name = name, .value = value[n], .fine = (double)fine};
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if some cells must stick: loads are given, and no creepage along the surface, under which all may slip. Without
   any shear there is no friction, and nothing sticks. */
static PetscBool MustStick(const SamControl *control, double shear)
{
  PetscBool loads = control->force[SAM_COMPONENT_MZ];

  if (!(shear > 0)) return PETSC_FALSE;
  for (SamComponent c = SAM_COMPONENT_TX; c <= SAM_COMPONENT_TY; c++) {
    if (!control->force[c] && control->value[c] != 0) return PETSC_FALSE;
    if (control->force[c]) loads = PETSC_TRUE;
  }
  return loads;
}

PetscErrorCode SamAdviceAddRolling(SamAdvice *a, PetscInt k, const SamStep *step)
{
  const SamGrid grid = a->setup->grid;
  const double  cell = (double)(grid->dx * grid->dy);
  PetscReal     area, stick, shear;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(a->setup->contact, "contact_area", &area));
  PetscCall(SamContactGetNumber(a->setup->contact, "stick_area", &stick));
  PetscCall(SamContactGetNumber(a->setup->contact, "shear_max", &shear));
  for (int load = 0; load < 2 && area > 0 && a->setup->grid->axes == 2; load++)
    PetscCall(Compare(a, k, step, load ? PETSC_TRUE : PETSC_FALSE, sqrt((double)area / PETSC_PI)));
  a->slip.pushed = MustStick(&step->control, (double)shear);
  a->passed      = area > 0 ? (double)((area - stick) / (2 * sqrt(PETSC_PI * area * cell))) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Loads(SamAdvice *a)
{
  const SamRollingError *r         = &a->rolling;
  char                   where[48] = "";

  if (!(r->error > 0)) return;
  if (a->steps > 1) (void)snprintf(where, sizeof(where), "in step %" PetscInt_FMT " ", r->step + 1);
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, r->error, r->error / GOOD, r->name, "%s%s = %.4g, %s_extrapolated = %.4g",
               where, r->name, r->value, r->name, r->fine);
}

void SamAdviceRolling(SamAdvice *a)
{
  if (SamMotionOf(a->setup->elasticity)->continues || a->setup->grid->axes < 2) return;
  Loads(a);
  if (a->slip.across < INFINITY && a->passed < CLEAR) /* not all cells stick */
    SamAdvicePeaks(a, a->passed, WIDE / a->passed, "slip_velocity_max");
  SamAdviceStick(a, STUCK);
}
