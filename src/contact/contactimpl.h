/* The inside of SamContact. */
#ifndef PETSAM_CONTACTIMPL_H
#define PETSAM_CONTACTIMPL_H

#include "../base/baseimpl.h"
#include <petsam/contact.h>

/*
  SamExtrapolate - replaces pressure and shear of a step by a prediction of the next one, alpha times as far on as it is from
  the step before, whose tractions are given in the next two arguments and replaced by the step's own. `found` is false, and
  the step's tractions stay, where the prediction is that contact is lost. Collective.
*/
PETSC_INTERN PetscErrorCode SamExtrapolate(SamGrid grid, PetscReal friction, PetscReal alpha, Vec pressure, Vec shear, Vec pressure_before, Vec shear_before, PetscBool *found);

/* SamFollowBound - scales a shear that belonged to one pressure to another: what slips goes on slipping. */
PETSC_INTERN PetscErrorCode SamFollowBound(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear);

#endif
