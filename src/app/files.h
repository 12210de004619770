/* Names of files. */
#ifndef PETSAM_APP_FILES_H
#define PETSAM_APP_FILES_H

#include <petsam/base.h>

/*
  SamIsSameFile - whether two names are those of the same file; files that do not exist yet are compared by folder and
  name. Not collective.
*/
PETSC_INTERN PetscBool SamIsSameFile(const char a[], const char b[]);

#endif
