/* Functions shared by the programs: start and end, errors and exit codes, help, names of files, memory. */
#ifndef PETSAM_APP_PROGRAM_H
#define PETSAM_APP_PROGRAM_H

#include <petsam/private/arguments.h>

#define SAM_TOPIC_GROUPS 4 /* maximum number of groups of a topic */

/* A topic of the help; scripts/maintain/help.awk makes an array of them from src/front/app/<program>.help. */
typedef struct {
  const char *name;
  const char *group[SAM_TOPIC_GROUPS]; /* titles of its groups of options; NULL: no more */
  const char *text;                    /* lines that begin with two spaces are not reflowed in the man page */
} SamTopic;

/*
  A program, its help, and its functions, which are called with its context; all but the last three may raise errors.
*/
typedef struct {
  const char     *name;
  const SamTopic *topics;          /* topics of -help, first the text before the options; a name of NULL ends them */
  PetscErrorCode (*prepare)(void); /* called before PETSc starts; NULL: none */
  PetscErrorCode (*setup)(void *context, const SamArguments *arguments); /* reads all options; writes nothing */
  PetscErrorCode (*run)(void *context);
  PetscErrorCode (*teardown)(void *context); /* also after an error */
  int (*status)(const void *context);        /* exit code without an error */
  PetscBool (*writing)(const void *context); /* true if a collective write is under way, which cannot be ended */
  void (*abandon)(void *context);            /* called before the program is aborted */
  void *context;
} SamProgram;

/*
  SamProgramMain - runs a program from its main(); returns the exit code: that of the program, 2 for SAM_ERR_USER, 3 for
  SAM_ERR_FILE, 10 for PETSC_ERR_NOT_CONVERGED, or PETSc's own.
*/
PETSC_INTERN int SamProgramMain(const SamProgram *program, int argc, char **argv);
/*
  SamProgramHelp - prints the help of a program: all of it, or on the topic that its arguments name, which may also be
  the beginning of one, an option, or `json`. Options are read, but nothing else is done.
  Collective. Errors: SAM_ERR_USER for an unknown topic, with the list of all.
*/
PETSC_INTERN PetscErrorCode SamProgramHelp(const SamProgram *program, const SamArguments *arguments);

/* SamMemoryRead - returns the bytes in a row of a file of /proc; 0: unknown. Not collective. */
PETSC_INTERN double SamMemoryRead(const char file[], const char row[]);
#define SAM_MEMORY_PROGRAM 50e6 /* bytes of a program and its libraries, on each rank */
/*
  SamMemoryRefuse - rejects a run that needs more memory than a node has, before the system would kill it; `bytes`:
  memory needed by this rank. The option and its value are named in the message. Option -memory_check false skips this.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMemoryRefuse(MPI_Comm comm, double bytes, const char option[], const char value[],
                                            const SamOptions *from);

#endif
