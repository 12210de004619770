/*
  The power of a step's slip beside that of the bodies' speeds.

  Where nothing rolls, the points of a surface move as its body does. Surfaces then slide past each other by the
  difference of the speeds, with the power of the bound of the shear times this difference.
*/
#include "heatlaw.h"
#include <petsam/private/balance.h>
#include <petsam/private/motionimpl.h>
#include <math.h>

#define RTOL 1e-8 /* of the partition */
#define MOST 200  /* operator applications in it */
#define SAME 0.1  /* part by which the powers may differ: less slips as shear builds up */

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

/* Creates the operators at their first use. */
PetscErrorCode SamHeatLawPrepare(SamLaw law)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;

  PetscFunctionBegin;
  for (int b = 0; b < 2 && !h->pair.body[b]; b++) {
    const SamHeatBody body = {h->conductivity[b], h->capacity[b], h->speed[b]};

    PetscCall(SamConductorCreate(law->grid, NULL, &body, 0, &h->pair.body[b]));
  }
  h->pair.resistance = h->resistance;
  h->pair.rtol       = RTOL;
  h->pair.most       = MOST;
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamLawUse SamHeatLawUses(SamLaw law)
{
  if (SamMotionOf(law->elasticity)->streams) return SAM_USE_POWER;
  return SamHeatLawExpands((const SamHeatLaw *)law->data) ? SAM_USE_PATH : SAM_USE_WORK;
}

PetscErrorCode SamHeatLawFill(SamLaw law, Vec pressure, Vec of_step, Vec bound, Vec heat)
{
  const SamHeatLaw *h   = (const SamHeatLaw *)law->data;
  const SamLawUse   use = SamHeatLawUses(law);
  const double      per = use == SAM_USE_POWER ? (double)h->rolling : h->duration > 0 ? 1 / (double)h->duration : 0;
  const double     *p, *work, *b;
  double           *q;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(of_step, &work));
  PetscCall(VecGetArrayRead(bound, &b));
  PetscCall(VecGetArrayWrite(heat, &q));
  for (PetscInt k = 0; k < law->grid->cells; k++)
    q[k] = p[k] > 0 ? per * PetscMax(work[k], 0) * (use == SAM_USE_PATH ? b[k] : 1) : 0;
  PetscCall(VecRestoreArrayWrite(heat, &q));
  PetscCall(VecRestoreArrayRead(bound, &b));
  PetscCall(VecRestoreArrayRead(of_step, &work));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
