/* The numbers of computed cycles, by name. */
#include "lifeimpl.h"
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/contact.h>

enum { CYCLE, JUMP, ERROR, VOLUME, DEPTH = VOLUME + 2, ENERGY = DEPTH + 2, AREA, PRESSURE, COMPUTED, NUMBERS };
#define NUMBER(name, unit, text, kind, order) \
  { \
    name, unit, text, kind, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, order \
  }
static const SamStateNumber declared[NUMBERS] = {
  NUMBER("cycle", "1", "cycles before this one", SAM_NUMBER_REAL, 0),
  NUMBER("jump", "1", "cycles skipped before this one", SAM_NUMBER_REAL, 0),
  NUMBER("error", "1", "estimated relative error of the cycle jump, or of long slide steps", SAM_NUMBER_REAL, 0),
  NUMBER("volume1", "m3", "volume removed of body 1", SAM_NUMBER_REAL, 2),
  NUMBER("volume2", "m3", "volume removed of body 2", SAM_NUMBER_REAL, 2),
  NUMBER("depth_max1", "m", "maximum depth removed of body 1", SAM_NUMBER_REAL, 1),
  NUMBER("depth_max2", "m", "maximum depth removed of body 2", SAM_NUMBER_REAL, 1),
  NUMBER("dissipated_energy", "J", "frictional work of the cycle", SAM_NUMBER_REAL, 2),
  NUMBER("contact_area", "m2", "area in contact at the end of the cycle", SAM_NUMBER_REAL, 1),
  NUMBER("pressure_max", "Pa", "maximum pressure at the end of the cycle", SAM_NUMBER_REAL, 1),
  NUMBER("computed", "1", "cycles computed so far", SAM_NUMBER_INT, 0)};

PetscErrorCode SamLifeDeclare(SamLife l)
{
  const SamMotion motion = SamContactGetMotion(l->contact);
  PetscInt        id;

  PetscFunctionBegin;
  PetscCall(SamStateCreate(l->grid, &l->series));
  for (int k = 0; k < NUMBERS; k++) {
    SamStateNumber number = declared[k];

    if (k == ENERGY) number.unit = motion->work_unit;
    if (k == ENERGY)
      PetscCall(SamStateDeclareNumber(l->series, &number, &id));
    else
      PetscCall(SamMotionDeclareNumber(motion, l->series, &number, &id));
  }
  PetscCall(SamStateDeclareNumber(l->memory, &declared[CYCLE], &id)); /* number of each step */
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamState SamLifeGetSeries(SamLife l)
{
  return l->series;
}

PetscErrorCode SamLifeRecord(SamLife l, const SamLifeReport *r)
{
  double *n = SamStateNumbers(l->series, 0, SAM_COMMITTED);

  PetscFunctionBegin;
  n[CYCLE] = r->cycles;
  n[JUMP]  = r->jump;
  n[ERROR] = r->error;
  for (int body = 0; body < 2; body++) {
    n[VOLUME + body] = r->volume[body];
    n[DEPTH + body]  = r->depth[body];
  }
  n[ENERGY]   = r->dissipated_energy;
  n[AREA]     = r->contact_area;
  n[PRESSURE] = r->pressure;
  n[COMPUTED] = (double)r->computed;
  PetscFunctionReturn(PETSC_SUCCESS);
}
