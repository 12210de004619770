/* What the programs share: start and end, errors and exit codes. */
#ifndef PETSAM_APP_PROGRAM_H
#define PETSAM_APP_PROGRAM_H

#include <petsam/private/arguments.h>
#include "topics.h"

/*
  A program, its help, and its functions, which are called with its context; all but the last three may raise errors.
*/
typedef struct {
  const char     *name, *usage;    /* usage: what -help prints before the options */
  const SamTopic *topics;          /* of -help; every group of options belongs to one */
  PetscErrorCode (*prepare)(void); /* before PETSc starts; NULL: nothing */
  PetscErrorCode (*setup)(void *context, const SamArguments *arguments); /* reads all options; writes nothing */
  PetscErrorCode (*run)(void *context);
  PetscErrorCode (*teardown)(void *context); /* also after an error */
  int (*status)(const void *context);        /* exit code without an error */
  PetscBool (*writing)(const void *context); /* a collective write is under way, and cannot be ended */
  void (*abandon)(void *context);            /* before the program is aborted */
  void *context;
} SamProgram;

/*
  SamProgramMain - runs a program from its main(); returns the exit code: that of the program, 2 for SAM_ERR_USER, 3 for
  SAM_ERR_FILE, 10 for PETSC_ERR_NOT_CONVERGED, or PETSc's own.
*/
PETSC_INTERN int SamProgramMain(const SamProgram *program, int argc, char **argv);

#endif
