/* The jumps of a wear simulation on the way back, from a number that has a gradient to what it depends on. */
#ifndef PETSAM_PRIVATE_LIFEBACK_H
#define PETSAM_PRIVATE_LIFEBACK_H

#include <petsam/private/backstep.h>
#include <petsam/private/life.h>

/*
  SamLifeBack - the recorded parts of the jumps of a contact's wear simulation, and their part of a pass back. The
  lengths of jumps are fixed.

  SamLifeBackCreate - creates it, without any jump, for a history whose cycle has so many rows. The contact is borrowed.
  Errors: SAM_ERR_USER for jumps of other lengths, and surfaces that slide.
  SamLifeBackRecord - records a part of a jump, after so many steps. SamLifeBackJumped - returns true if one is recorded
  there; not collective. SamLifeBackTouch - sets a field of the contact's grid to 1 in cells that jumps press.

  In a pass, between SamLifeBackBegin() and SamLifeBackEnd(): SamLifeBackPass() goes back over the parts of jumps after
  so many steps, SamLifeBackAddCycle() adds what the wear of the cycle of the present step is repeated by. The step is
  that of SamLifeBackBegin(); `by_number` is that of the law of wear.

  Collective.
*/
typedef struct _n_SamLifeBack *SamLifeBack;
PETSC_INTERN PetscErrorCode    SamLifeBackCreate(SamContact contact, PetscInt cycle, const SamLifeSettings *settings,
                                                 SamLifeBack *life);
PETSC_INTERN PetscErrorCode    SamLifeBackDestroy(SamLifeBack *life);
PETSC_INTERN PetscErrorCode    SamLifeBackRecord(SamLifeBack life, const SamLifePart *part, PetscInt steps);
PETSC_INTERN PetscBool         SamLifeBackJumped(SamLifeBack life, PetscInt steps);
PETSC_INTERN PetscErrorCode    SamLifeBackTouch(SamLifeBack life, Vec touched);
PETSC_INTERN PetscErrorCode    SamLifeBackBegin(SamLifeBack life, SamBackStep *step);
PETSC_INTERN PetscErrorCode    SamLifeBackPass(SamLifeBack life, PetscInt steps);
PETSC_INTERN PetscErrorCode    SamLifeBackAddCycle(SamLifeBack life, SamLifePlace place);
PETSC_INTERN PetscErrorCode    SamLifeBackEnd(SamLifeBack life);

#endif
