/* Functions of wear, besides petsam/wear.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_WEAR_H
#define PETSAM_PRIVATE_WEAR_H

#include <petsam/state.h>
#include <petsam/wear.h>

/* The field, if a law declares it, by which wear is multiplied in each cell: the factor on the coefficients in a step,
   set in the advance of the laws before wear. SamWearGetFactor - gets that of the tried step; NULL: none. Not
   collective. */
#define SAM_WEAR_FACTOR "wear_factor"
PETSC_INTERN Vec SamWearGetFactor(SamState state);

/*
  SamWearAdviseStride - writes a warning about a step that slides too far; `stride`: its slide divided by the length of
  the contact. SamWearAdviseTip - about the excess of the maximum pressure over its mean along the slide of a step. Else
  an empty text. Not collective.
*/
PETSC_INTERN PetscErrorCode SamWearAdviseTip(PetscReal tip, char text[], size_t size);
PETSC_INTERN PetscErrorCode SamWearAdviseStride(PetscReal stride, char text[], size_t size);

#endif
