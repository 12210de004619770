/* Functions of control, besides petsam/control.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_CONTROL_H
#define PETSAM_PRIVATE_CONTROL_H

#include <petsam/control.h>

/* SamWay - the way in which a component is given. */
typedef enum { SAM_BY_LOAD, SAM_BY_RIGID, SAM_BY_CREEP, SAM_WAYS } SamWay;

/* SamComponentNameOf - returns the name of a component given in that way, NULL if it cannot be. Not collective. */
PETSC_INTERN const char *SamComponentNameOf(PetscInt component, SamWay way);

/*
  SamUnitOn - returns a unit as it is on a grid.

  Not collective.

  In:     grid - the grid
          unit - the unit on a grid of many rows, "N m" for instance

  Errors: none; it returns no error code.

  On a grid of one row, loads, areas, volumes and energies are per metre.
*/
PETSC_EXTERN const char *SamUnitOn(SamGrid grid, const char unit[]);

/*
  SamConditionsCreate - creates an empty list. SamConditionsReference, SamConditionsDestroy - add and drop a reference;
  the last one dropped frees the list and its conditions.
  SamConditionsCount, SamConditionsGet - return the number of conditions, and the k-th one.
  SamConditionsFind - returns the condition of that name, NULL if there is none.
  SamConditionsPull - returns true if N may be negative, as SamConditionsAllowPull() has set, once for the list.
  Conditions are borrowed. Not collective, but to be called on all ranks.
*/
PETSC_INTERN PetscErrorCode      SamConditionsCreate(SamConditions *conditions);
PETSC_INTERN PetscErrorCode      SamConditionsReference(SamConditions conditions);
PETSC_INTERN PetscErrorCode      SamConditionsDestroy(SamConditions *conditions);
PETSC_INTERN PetscBool           SamConditionsPull(SamConditions conditions);
PETSC_INTERN void                SamConditionsAllowPull(SamConditions conditions);
PETSC_INTERN PetscInt            SamConditionsCount(SamConditions conditions);
PETSC_INTERN const SamCondition *SamConditionsGet(SamConditions conditions, PetscInt k);
PETSC_INTERN const SamCondition *SamConditionsFind(SamConditions conditions, const char name[]);

/* SamControlSetCondition - sets the value of a condition. Not collective. */
PETSC_INTERN void SamControlSetCondition(SamControl *control, const SamCondition *condition, PetscReal value);

/*
  SamControlWay - returns the way in which a component is given.

  Not collective.

  In:     control   - the control
          component - the component, of SamComponent

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamWay SamControlWay(const SamControl *control, PetscInt component);

/* SamControlSetWay - sets the way in which a component is given. Not collective. */
PETSC_INTERN void SamControlSetWay(SamControl *control, PetscInt component, SamWay way);

/*
  The parts of a control are its prescribed values in one row: the loads, displacements or creepages of the six
  components, then the conditions of a list. SamControlCount - returns the number of parts. SamControlPart - returns the
  k-th part. SamControlSetPart - sets it. SamControlPartName - returns its name as an option (without dash) or column,
  for the way in which it is given. Not collective.
*/
PETSC_INTERN PetscInt    SamControlCount(SamConditions conditions);
PETSC_INTERN PetscReal   SamControlPart(const SamControl *control, SamConditions conditions, PetscInt k);
PETSC_INTERN void        SamControlSetPart(SamControl *control, SamConditions conditions, PetscInt k, PetscReal value);
PETSC_INTERN const char *SamControlPartName(const SamControl *control, SamConditions conditions, PetscInt k);

/*
  SamControlName - returns the k-th of all names that parts may have: those of loads, displacements, creepages and
  conditions; NULL if there are no more. SamControlFind - returns the index of the part of that name, -1 if there is
  none, and the way in which it gives a component. Not collective.
*/
PETSC_INTERN const char *SamControlName(SamConditions conditions, PetscInt k);
PETSC_INTERN PetscInt    SamControlFind(SamConditions conditions, const char name[], SamWay *way);

/*
  SamControlReadCondition - reads a condition from its option, if it may be an option; `set`: true if it was given.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamControlReadCondition(const SamOptions *from, const SamCondition *condition,
                                                    SamControl *control, PetscBool *set);

#endif
