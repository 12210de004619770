/* Bulk stress: a uniform stress of a body, parallel to its surface, which it stretches. */
#ifndef PETSAM_BULK_H
#define PETSAM_BULK_H

#include <petsam/control.h>

/* The components of a bulk stress, in the order used everywhere. */
typedef enum { SAM_BULK_XX, SAM_BULK_YY, SAM_BULK_XY, SAM_BULK_COMPONENTS } SamBulkComponent;

/*
  A bulk stress stretches the surface of its body about x = y = 0 by Hooke's law, without stress normal to the surface;
  tension is positive.
  SamBulkAddConditions - adds bulk1_stress_xx to bulk2_stress_xy to a list.
  SamBulkCondition - that of a component of body 0 or 1.
  SamBulkGet - the bulk stress of body 0 or 1 in a step, Pa.
  Not collective.
*/
PETSC_INTERN PetscErrorCode      SamBulkAddConditions(SamConditions conditions);
PETSC_INTERN const SamCondition *SamBulkCondition(SamConditions conditions, PetscInt body, PetscInt component);
PETSC_INTERN void                SamBulkGet(SamConditions conditions, const SamControl *control, PetscInt body,
                                            PetscReal stress[SAM_BULK_COMPONENTS]);

#endif
