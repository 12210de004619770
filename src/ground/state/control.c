/* Control of a load step, and the names of its components. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/control.h>
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

/* ---- components ---- */

const char *SamUnitOn(SamGrid grid, const char unit[])
{
  static const char *const units[][2] = {{"N", "N/m"},   {"N m", "N m/m"},
                                         {"J", "J/m"},   {"J/m", "J/m2"},
                                         {"W", "W/m"},   {"m2", "m2/m"},
                                         {"m3", "m3/m"}, {"N/m, N/rad, N, N m/rad", "N/m2, N/(m rad), N/m, N/rad"}};

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

/* ---- lists of conditions ---- */

struct _n_SamConditions {
  SamClassId    class_id;
  PetscInt      references, count;
  SamCondition *condition[SAM_CONDITIONS]; /* pointers, so that conditions keep their addresses */
  PetscBool     pull;                      /* N may be negative */
};

PetscErrorCode SamConditionsCreate(SamConditions *conditions)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(conditions));
  (*conditions)->class_id   = SamConditions_CLASSID;
  (*conditions)->references = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConditionsReference(SamConditions list)
{
  PetscFunctionBegin;
  list->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConditionsDestroy(SamConditions *conditions)
{
  SamConditions list = *conditions;

  PetscFunctionBegin;
  *conditions = NULL;
  if (!list || --list->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < list->count; k++) {
    SamCondition *const c = list->condition[k];

    PetscCall(PetscFree(c->name));
    PetscCall(PetscFree(c->unit));
    PetscCall(PetscFree(c->text));
    PetscCall(PetscFree(c->group));
    PetscCall(PetscFree(list->condition[k]));
  }
  list->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamConditionsAdd(SamConditions list, const SamCondition *condition, const SamCondition **own)
{
  const SamCondition *found;
  SamCondition       *c;

  PetscFunctionBegin;
  SamValidHandle(list, SamConditions, 1);
  SamValidPointer(condition, 2);
  found = SamConditionsFind(list, condition->name);
  if (!found) {
    PetscCheck(list->count < SAM_CONDITIONS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "The condition %s is one too many: a step has at most %d", condition->name, SAM_CONDITIONS);
    PetscCall(PetscNew(&c));
    *c = *condition;
    PetscCall(PetscStrallocpy(condition->name, (char **)&c->name));
    PetscCall(PetscStrallocpy(condition->unit, (char **)&c->unit));
    PetscCall(PetscStrallocpy(condition->text, (char **)&c->text));
    PetscCall(PetscStrallocpy(condition->group ? condition->group : condition->name, (char **)&c->group));
    c->place                       = list->count;
    list->condition[list->count++] = c;
    found                          = c;
  }
  if (own) *own = found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamConditionsPull(SamConditions list)
{
  return list->pull;
}

void SamConditionsAllowPull(SamConditions list)
{
  list->pull = PETSC_TRUE;
}

PetscInt SamConditionsCount(SamConditions list)
{
  return list->count;
}

const SamCondition *SamConditionsGet(SamConditions list, PetscInt k)
{
  return list->condition[k];
}

const SamCondition *SamConditionsFind(SamConditions list, const char name[])
{
  for (PetscInt k = 0; k < list->count; k++)
    if (!strcmp(list->condition[k]->name, name)) return list->condition[k];
  return NULL;
}

/* ---- controls ---- */

PetscErrorCode SamControlInitialize(SamControl *control)
{
  PetscFunctionBegin;
  SamValidPointer(control, 1);
  PetscCall(PetscMemzero(control, sizeof(*control)));
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) control->force[k] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamControlGet(const SamControl *control, const SamCondition *condition)
{
  return control && control->given[condition->place] ? control->condition[condition->place] : condition->usual;
}

void SamControlSetCondition(SamControl *control, const SamCondition *condition, PetscReal value)
{
  control->condition[condition->place] = value;
  control->given[condition->place]     = 1;
}

PetscInt SamControlCount(SamConditions conditions)
{
  return SAM_COMPONENTS + SamConditionsCount(conditions);
}

PetscReal SamControlPart(const SamControl *control, SamConditions conditions, PetscInt k)
{
  return k < SAM_COMPONENTS ? control->value[k]
                            : SamControlGet(control, SamConditionsGet(conditions, k - SAM_COMPONENTS));
}

void SamControlSetPart(SamControl *control, SamConditions conditions, PetscInt k, PetscReal value)
{
  if (k < SAM_COMPONENTS)
    control->value[k] = value;
  else
    SamControlSetCondition(control, SamConditionsGet(conditions, k - SAM_COMPONENTS), value);
}

const char *SamControlPartName(const SamControl *control, SamConditions conditions, PetscInt k)
{
  return k < SAM_COMPONENTS ? SamComponentNameOf(k, SamControlWay(control, k))
                            : SamConditionsGet(conditions, k - SAM_COMPONENTS)->name;
}

const char *SamControlName(SamConditions conditions, PetscInt k)
{
  for (SamWay way = SAM_BY_LOAD; way < SAM_WAYS; way++)
    for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
      if (SamComponentNameOf(c, way) && k-- == 0) return SamComponentNameOf(c, way);
  return conditions && k < conditions->count ? conditions->condition[k]->name : NULL;
}

PetscInt SamControlFind(SamConditions conditions, const char name[], SamWay *way)
{
  const SamCondition *condition = conditions ? SamConditionsFind(conditions, name) : NULL;

  for (*way = SAM_BY_LOAD; *way < SAM_WAYS; (*way)++)
    for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
      if (SamComponentNameOf(c, *way) && !strcmp(name, SamComponentNameOf(c, *way))) return c;
  return condition ? SAM_COMPONENTS + condition->place : -1;
}

PetscErrorCode SamControlSet(SamControl *control, SamConditions conditions, const char name[], PetscReal value)
{
  const char *names[SAM_WAYS * SAM_COMPONENTS + SAM_CONDITIONS + 1], *nearest;
  size_t      count = 0;
  SamWay      way;
  PetscInt    part;

  PetscFunctionBegin;
  SamValidPointer(control, 1);
  if (conditions) SamValidHandle(conditions, SamConditions, 2);
  SamValidPointer(name, 3);
  part = SamControlFind(conditions, name, &way);
  if (part < 0) {
    while ((names[count] = SamControlName(conditions, (PetscInt)count))) count++;
    nearest = SamNearestName(name, count, names);
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_UNKNOWN_TYPE,
            "%s is not the name of a load, displacement, creepage or condition%s%s%s", name, nearest ? ": is " : "",
            nearest ? nearest : "", nearest ? " meant?" : "");
  }
  if (part < SAM_COMPONENTS) SamControlSetWay(control, part, way);
  SamControlSetPart(control, conditions, part, value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamControlReadCondition(const SamOptions *from, const SamCondition *condition, SamControl *control,
                                       PetscBool *set)
{
  PetscReal value = SamControlGet(control, condition);

  PetscFunctionBegin;
  *set = PETSC_FALSE;
  if (!condition->option) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOptionsReal(from, condition->name, condition->text, condition->unit, condition->range, &value, set));
  if (*set) SamControlSetCondition(control, condition, value);
  PetscFunctionReturn(PETSC_SUCCESS);
}
