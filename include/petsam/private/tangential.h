/* Functions of tangential, besides petsam/tangential.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_TANGENTIAL_H
#define PETSAM_PRIVATE_TANGENTIAL_H

#include <petsam/tangential.h>

/*
  SamTangentialGetLimit - returns, after gross slip, the factor on the given loads at which sliding begins; infinite if
  it was not computed. Not collective.
*/
PETSC_INTERN PetscReal SamTangentialGetLimit(SamTangential tangential);

#endif
