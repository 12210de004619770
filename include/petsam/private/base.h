/* Functions of base, besides petsam/base.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_BASE_H
#define PETSAM_PRIVATE_BASE_H

#include <petsam/base.h>

/* SamOptionsPrefix - returns the prefix, or an empty text if there is none. Not collective. */
PETSC_INTERN const char *SamOptionsPrefix(const SamOptions *from);

/*
  SamOptionsReals - reads a list of up to `size` numbers in the range, and their count; 0: the option is absent. It is
  collective and fails as SamOptionsRead().
  SamOptionsHas - sets `has` to true if an option (its name without dash and prefix) is given; a value may follow the
  name after a space, and the option must then have that value. Not collective.
  SamOptionsNeed - rejects an option that is given without another one that it needs; the format is that of a row's
  `needs`.
  SamOptionsExclude - rejects an option `other`, in the format of SamOptionsHas(), beside the given one that it does not
  work with; `reason`: why, or what to do.
*/
PETSC_EXTERN PetscErrorCode SamOptionsReals(const SamOptions *from, const SamOptionRow *row, PetscReal values[],
                                            PetscInt *count);
PETSC_INTERN PetscErrorCode SamOptionsHas(const SamOptions *from, const char option[], PetscBool *has);
PETSC_INTERN PetscErrorCode SamOptionsNeed(const SamOptions *from, PetscBool given, const char name[],
                                           const char needs[]);
PETSC_INTERN PetscErrorCode SamOptionsExclude(const SamOptions *from, const char given[], const char other[],
                                              const char reason[]);

#endif
