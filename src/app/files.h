/* Names of files. */
#ifndef PETSAM_APP_FILES_H
#define PETSAM_APP_FILES_H

#include <petsam/private/arguments.h>

/*
  SamFiles - the names of all files of a program, so that none that it writes replaces one that it reads, or another
  that it writes.
*/
typedef enum { SAM_FILE_READ_ONLY, SAM_FILE_WRITTEN } SamFileRole;
typedef struct {
  SamFileRole role;
  const char *option; /* with dash */
  char       *name;
  PetscBool   derived; /* from the value of the option */
} SamNamedFile;
#define SAM_FILES 96
typedef struct {
  PetscInt     count;
  SamNamedFile list[SAM_FILES];
} SamFiles;

/*
  SamFilesAdd - adds a file, whose name is copied; `option` is not. Not collective.
  SamFilesCheck - adds files of options and those that PETSc writes for its viewers; refuses a file that would replace
  another one, and viewers that cannot be opened. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFilesAdd(SamFiles *files, SamFileRole role, const char option[], const char name[],
                                        PetscBool derived);
PETSC_INTERN PetscErrorCode SamFilesCheck(SamFiles *files, MPI_Comm comm, const SamArguments *arguments);
PETSC_INTERN PetscErrorCode SamFilesFree(SamFiles *files);

#endif
