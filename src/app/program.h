/* What the programs share: start and end, errors and exit codes. */
#ifndef PETSAM_APP_PROGRAM_H
#define PETSAM_APP_PROGRAM_H

#include <petsam/private/arguments.h>

#define SAM_TOPIC_GROUPS 4 /* most groups of a topic */

/* A topic of the help; scripts/maintain/help.awk makes an array of them from src/app/<program>.help. */
typedef struct {
  const char *name;
  const char *group[SAM_TOPIC_GROUPS]; /* titles of the groups of options that belong to it; NULL: no more */
  const char *text;                    /* lines that begin with two spaces are kept as they are in the man page */
} SamTopic;

/*
  A program, its help, and its functions, which are called with its context; all but the last three may raise errors.
*/
typedef struct {
  const char     *name;
  const SamTopic *topics;          /* of -help, first what it prints before the options; a name of NULL ends them */
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
