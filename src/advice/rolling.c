/*
  How far a grid resolves steady rolling: loads and creepages that are found are of first order in the cells' size, and
  each step is solved on half the cells, too (step/rolling.c). Their extrapolation less the number is about its error.
*/
#include "adviceimpl.h"
#include <math.h>

#define ALLOWED 0.02 /* error, relative to the number */
#define GOOD    0.015
#define SMALL   0.1 /* part of a moment over the radius of contact that counts for a force, and so on */
#define LEAST   1.25

/* The errors of T_x, T_y, M_z, or of the creepages that are theirs, relative to both forces and to the moment. */
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

PetscErrorCode SamAdviceAddRolling(SamAdvice *a, PetscInt k, const SamStep *step)
{
  PetscReal area;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(a->setup->contact, "contact_area", &area));
  for (int load = 0; load < 2 && area > 0 && a->setup->grid->axes == 2; load++)
    PetscCall(Compare(a, k, step, load ? PETSC_TRUE : PETSC_FALSE, sqrt((double)area / PETSC_PI)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamAdviceRolling(SamAdvice *a)
{
  const SamRollingError *r = &a->rolling;
  char                   better[SAM_ADVICE_GRIDS], where[48] = "";

  if (r->error <= ALLOWED) return;
  if (a->steps > 1) (void)snprintf(where, sizeof(where), "step %" PetscInt_FMT ": ", r->step + 1);
  SamAdviceGrids(a, PetscMax(r->error / GOOD, LEAST), better);
  SamAdviceSay(a, better[0] ? "" : "grid_n",
               "%s%s = %.4g may be wrong by %.1f %%: %s_extrapolated = %.4g has the error of a finer grid%s", where,
               r->name, r->value, 100 * r->error, r->name, r->fine, better);
}
