/* Functions of stiffness, besides petsam/stiffness.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_STIFFNESS_H
#define PETSAM_PRIVATE_STIFFNESS_H

#include <petsam/stiffness.h>

/*
  SamStiffnessDeclare - adds the stiffness of both directions to the numbers of a contact's steps: `stiffness`,
  `stiffness_reversal`.
  SamStiffnessRecord - computes them for the tried step, unless it has no solution; a failure becomes the step's
  message. Both are collective.
*/
PETSC_INTERN PetscErrorCode SamStiffnessDeclare(SamContact contact);
PETSC_INTERN PetscErrorCode SamStiffnessRecord(SamContact contact, SamStep *step);

/*
  SamStiffnessDescribe - writes the message of a stiffness that did not converge; else an empty text. Not collective.
*/
PETSC_INTERN void SamStiffnessDescribe(const SamStiffness *stiffness, char text[], size_t size);

#endif
