/*
  The power of a step's slip beside that of the bodies' speeds.

  Where nothing rolls, the points of a surface move as its body does. Surfaces then slide past each other by the
  difference of the speeds, with the power of the bound of the shear times this difference.
*/
#include "heatlaw.h"
#include <petsam/private/balance.h>
#include <petsam/private/motionimpl.h>
#include <math.h>

#define SAME 0.1 /* part by which the powers may differ: less slips as shear builds up */

PetscErrorCode SamHeatLawKeepPowers(SamLaw law, const SamLawStep *step, PetscReal power)
{
  SamHeatLaw *const h    = (SamHeatLaw *)law->data;
  const PetscReal   past = PetscAbsReal(h->speed[1] - h->speed[0]);
  PetscReal         bound[3];

  PetscFunctionBegin;
  h->power[0] = h->power[1] = 0;
  if (SamMotionOf(law->elasticity)->streams || step->rolled != 0 || !(h->duration > 0) || past == 0)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamBalanceGetLoads(step->grid, SAM_BALANCE_NORMAL, step->bound, bound));
  h->power[0] = (double)power;
  h->power[1] = (double)(past * bound[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamHeatLawAdviseSpeeds(const SamHeatLaw *h, const char unit[], char text[], size_t size)
{
  if (!(fabs(h->power[0] - h->power[1]) > SAME * h->power[1])) return;
  (void)snprintf(
    text, size,
    "-body1_speed and -body2_speed differ by %.3g m/s, with which friction makes %.3g %s, but the slip of "
    "the step, which heats, makes %.3g %s (the limit is a difference of %g %%): give a disp_x that changes "
    "by as much over the time of the step, or equal speeds",
    fabs((double)(h->speed[1] - h->speed[0])), h->power[1], unit, h->power[0], unit, 100 * SAME);
}
