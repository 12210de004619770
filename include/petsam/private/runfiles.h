/* The names of all files of a run, so that it replaces none that it reads or has written. */
#ifndef PETSAM_PRIVATE_RUNFILES_H
#define PETSAM_PRIVATE_RUNFILES_H

#include <petsam/private/arguments.h>

/* SamFiles - the names of all files of a program, so that it replaces none that it reads or has written. */
#define SAM_FILES 96
typedef struct {
  const char *option; /* with dash */
  char       *name;
  PetscBool   written, derived; /* derived: from the value of the option */
} SamNamedFile;
typedef struct {
  PetscInt     count;
  SamNamedFile list[SAM_FILES];
} SamFiles;
/*
  SamFilesAdd - adds a file that is only read, or is written; `name` is copied, `option` is not. Not collective.
  SamFilesAddWritten - adds a file that is written, and two names that are derived from it, which it frees. Not
  collective. SamFilesAddOutput - adds a file of -output, and that in which it is written at first. Not collective.
  SamFilesCheck - adds files of options, those that the rows of options declare to be read or written, and those that
  PETSc writes for its viewers; call it once all options have been read. `arguments`: those of the command line (NULL:
  there are none). Refuses a file that would replace another one,
  and viewers that cannot be opened; frees the names. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFilesAdd(SamFiles *files, const char option[], const char name[], PetscBool written);
PETSC_INTERN PetscErrorCode SamFilesAddWritten(SamFiles *files, const char option[], const char name[], char *derived,
                                               char *other);
PETSC_EXTERN PetscErrorCode SamFilesAddOutput(SamFiles *files, const char name[]);
/* SamFilesFind - finds out whether there is a file of that name. Collective. */
PETSC_INTERN PetscErrorCode SamFilesFind(MPI_Comm comm, const char name[], PetscBool *there);
PETSC_EXTERN PetscErrorCode SamFilesCheck(SamFiles *files, MPI_Comm comm, const SamArguments *arguments);

#endif
