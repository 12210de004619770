/* What a load step prescribes, and its names. */
#include <petsam/private/baseimpl.h>
#include <petsam/control.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

const SamComponentName SamComponentNames[SAM_COMPONENTS] = {
  {"load_n", "N", "normal force", "disp_z", "m", "rigid-body displacement along z (approach)", NULL, NULL, NULL, 1},
  {"load_tx", "N", "tangential force along x", "disp_x", "m", "rigid-body displacement along x", "creep_x", "1",
   "creepage along x", 1},
  {"load_ty", "N", "tangential force along y", "disp_y", "m", "rigid-body displacement along y", "creep_y", "1",
   "creepage along y", 1},
  {"load_mx", "N m", "moment about x", "rot_x", "rad", "rotation about x", NULL, NULL, NULL, 2},
  {"load_my", "N m", "moment about y", "rot_y", "rad", "rotation about y", NULL, NULL, NULL, 1},
  {"load_mz", "N m", "moment about z", "rot_z", "rad", "rotation about z", "creep_spin", "1/m", "spin", 2}};

#define BULK(body, k, component) \
  { \
    "bulk" #body "_stress_" #component, "Pa", "bulk stress " #component " of body " #body ", tension positive", \
      offsetof(SamControl, bulk_stress[body - 1][k]), 0, SAM_RANGE_ANY, PETSC_TRUE, PETSC_FALSE, 1 \
  }
#define ROLL(name, k, axis) \
  { \
    name, "m", "rolled distance of the load step along " axis, offsetof(SamControl, roll[k]), 0, SAM_RANGE_ANY, \
      PETSC_FALSE, PETSC_TRUE, 2 \
  }
/* Names of load cases, which files give; until then none that could be given. */
static char     case_names[SAM_CASES][sizeof("body1_case_") + SAM_CASE_NAME];
static PetscInt cases_used = 0;

#define CASE(k) \
  { \
    case_names[k], "1", "factor on a load case of a body", offsetof(SamControl, cases[k]), 0, SAM_RANGE_ANY, \
      PETSC_TRUE, PETSC_FALSE, 3 + (k) \
  }
#define CASES(k) CASE(k), CASE((k) + 1), CASE((k) + 2), CASE((k) + 3)
const SamCondition SamConditions[SAM_CONDITIONS] = {{"friction_scale", "1", "factor on the coefficient of friction",
                                                     offsetof(SamControl, friction_scale), 1, SAM_RANGE_NONNEGATIVE,
                                                     PETSC_FALSE, PETSC_FALSE, 0},
                                                    BULK(1, SAM_BULK_XX, xx),
                                                    BULK(1, SAM_BULK_YY, yy),
                                                    BULK(1, SAM_BULK_XY, xy),
                                                    BULK(2, SAM_BULK_XX, xx),
                                                    BULK(2, SAM_BULK_YY, yy),
                                                    BULK(2, SAM_BULK_XY, xy),
                                                    ROLL("roll", 0, "x"),
                                                    ROLL("roll_y", 1, "y"),
                                                    CASES(0),
                                                    CASES(4),
                                                    CASES(8),
                                                    CASES(12)};

PetscErrorCode SamControlAddCase(PetscInt body, const char name[], PetscInt *place, PetscBool *room)
{
  char own[sizeof(case_names[0])];

  PetscFunctionBegin;
  (void)snprintf(own, sizeof(own), "body%d_case_%s", (int)body + 1, name);
  for (*place = 0; *place < cases_used && strcmp(case_names[*place], own); (*place)++) continue;
  *room = *place < SAM_CASES ? PETSC_TRUE : PETSC_FALSE;
  if (!*room || *place < cases_used) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(case_names[cases_used++], own, sizeof(own)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamConditionIsUsed(PetscInt k)
{
  return k < SAM_CONDITION_CASE + cases_used ? PETSC_TRUE : PETSC_FALSE;
}

const char *SamUnitOn(SamGrid grid, const char unit[])
{
  static const char *const units[][2] = {{"N", "N/m"},
                                         {"N m", "N m/m"},
                                         {"J", "J/m"},
                                         {"J/m", "J/m2"},
                                         {"m2", "m2/m"},
                                         {"m3", "m3/m"},
                                         {"N/m, N/rad, N, N m/rad", "N/m2, N/(m rad), N/m, N/rad"}};

  for (size_t k = 0; SamGridIsRow(grid) && k < sizeof(units) / sizeof(units[0]); k++)
    if (!strcmp(unit, units[k][0])) return units[k][1];
  return unit;
}

const char *SamComponentNameOf(PetscInt k, SamWay way)
{
  const SamComponentName *name = &SamComponentNames[k];

  return way == SAM_BY_LOAD ? name->load : way == SAM_BY_RIGID ? name->rigid : name->creep;
}

SamWay SamControlWay(const SamControl *control, PetscInt k)
{
  return control->force[k] ? SAM_BY_LOAD : control->creep[k] ? SAM_BY_CREEP : SAM_BY_RIGID;
}

void SamControlSetWay(SamControl *control, PetscInt k, SamWay way)
{
  control->force[k] = way == SAM_BY_LOAD;
  control->creep[k] = way == SAM_BY_CREEP;
}

PetscReal SamControlRolled(const SamControl *control)
{
  const PetscReal *roll = control->roll;

  return roll[1] == 0 ? roll[0] : roll[0] == 0 ? roll[1] : hypot(roll[0], roll[1]);
}

PetscErrorCode SamControlInitialize(SamControl *control)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(control, sizeof(*control)));
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) control->force[k] = PETSC_TRUE;
  for (PetscInt k = 0; k < SAM_CONDITIONS; k++) *SamControlPlace(control, SAM_COMPONENTS + k) = SamConditions[k].usual;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static size_t OffsetOf(PetscInt k)
{
  return k < SAM_COMPONENTS ? offsetof(SamControl, value) + (size_t)k * sizeof(PetscReal)
                            : SamConditions[k - SAM_COMPONENTS].place;
}

PetscReal *SamControlPlace(SamControl *control, PetscInt k)
{
  return (PetscReal *)((char *)control + OffsetOf(k));
}

PetscReal SamControlPart(const SamControl *control, PetscInt k)
{
  return *(const PetscReal *)((const char *)control + OffsetOf(k));
}

const char *SamControlPartName(const SamControl *control, PetscInt k)
{
  if (k >= SAM_COMPONENTS) return SamConditions[k - SAM_COMPONENTS].name;
  return SamComponentNameOf(k, SamControlWay(control, k));
}

void SamControlPack(const SamControl *control, double n[])
{
  *n++ = control->time;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) *n++ = SamControlWay(control, k);
  for (PetscInt k = 0; k < SAM_CONTROL_PARTS; k++) *n++ = SamControlPart(control, k);
}

void SamControlUnpack(const double n[], SamControl *control)
{
  control->time = *n++;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) SamControlSetWay(control, k, (SamWay)*n++);
  for (PetscInt k = 0; k < SAM_CONTROL_PARTS; k++) *SamControlPlace(control, k) = *n++;
}

PetscErrorCode SamControlSet(SamControl *control, const char name[], PetscReal value)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    for (SamWay way = SAM_BY_LOAD; way < SAM_WAYS; way++) {
      const char *own = SamComponentNameOf(k, way);

      if (!own || strcmp(name, own)) continue;
      SamControlSetWay(control, k, way);
      control->value[k] = value;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_UNKNOWN_TYPE, "%s is not the name of a load, displacement or creepage", name);
}

PetscErrorCode SamControlReadCondition(const SamOptions *from, PetscInt k, SamControl *control, PetscBool *set)
{
  const SamCondition *condition = &SamConditions[k];
  char                text[96];

  PetscFunctionBegin;
  *set = PETSC_FALSE;
  if (!condition->option || !SamConditionIsUsed(k)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(text, sizeof(text), "%s (%s)", condition->text, condition->unit));
  PetscCall(
    SamOptionsReal(from, condition->name, text, condition->range, SamControlPlace(control, SAM_COMPONENTS + k), set));
  PetscFunctionReturn(PETSC_SUCCESS);
}
