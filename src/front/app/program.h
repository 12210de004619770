/* Functions shared by the programs: start and end, errors and exit codes, help, names of files, memory. */
#ifndef PETSAM_APP_PROGRAM_H
#define PETSAM_APP_PROGRAM_H

#include <petsam/private/arguments.h>

#define SAM_TOPIC_GROUPS 4 /* most groups of a topic */

/* A topic of the help; scripts/maintain/help.awk makes an array of them from src/front/app/<program>.help. */
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
/*
  SamProgramHelp - prints the help of a program: all of it, or on the topic that its arguments name, which may also be
  the beginning of one, an option, or `json`. Options are read, but nothing else is done.
  Collective. Errors: SAM_ERR_USER for an unknown topic, with the list of all.
*/
PETSC_INTERN PetscErrorCode SamProgramHelp(const SamProgram *program, const SamArguments *arguments);

/* SamMemoryRead - the bytes that a row of a file of /proc names; 0: not known. Not collective. */
PETSC_INTERN double SamMemoryRead(const char file[], const char row[]);
#define SAM_MEMORY_PROGRAM 50e6 /* bytes of a program and its libraries, on each rank */
/*
  SamMemoryRefuse - refuses a run that needs more memory than a node has, before the system would kill it; `bytes`: the
  need of this rank. The option and its value are named in the message. Option -memory_check false skips this.
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMemoryRefuse(MPI_Comm comm, double bytes, const char option[], const char value[],
                                            const SamOptions *from);

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
  SamFilesAddWritten - adds a file that is written, and up to two names that are derived from it (NULL: none), which it
  frees. Not collective.
  SamFilesCheck - adds files of options, those that the rows of options declare to be read or written, and those that
  PETSc writes for its viewers; call it once all options have been read. Refuses a file that would replace another one,
  and viewers that cannot be opened; frees the names. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFilesAdd(SamFiles *files, const char option[], const char name[], PetscBool written);
PETSC_INTERN PetscErrorCode SamFilesAddWritten(SamFiles *files, const char option[], const char name[], char *derived,
                                               char *other);
PETSC_INTERN PetscErrorCode SamFilesCheck(SamFiles *files, MPI_Comm comm, const SamArguments *arguments);

#endif
