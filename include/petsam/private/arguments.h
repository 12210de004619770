/* The words of the command line, and all that PETSc reads besides, looked through before PETSc acts on them. */
#ifndef PETSAM_ARGUMENTS_H
#define PETSAM_ARGUMENTS_H

#include <petsam/base.h>

#define SAM_ARGUMENTS_FILES 64 /* most options files */

/* An option that is given. */
typedef struct {
  char *name, *place; /* without dash; in a file "file, line n: ", else "" */
  char *value;        /* "": none */
  int   source;       /* the same of all in one file, or in one text of words */
} SamArgument;

typedef struct _n_SamArguments {
  PetscBool      help, version;
  char           topic[64];    /* words after -help, "": none */
  PetscErrorCode code;         /* of the first mistake, 0: none */
  char           message[512]; /* that says what it is */
  char          *files[SAM_ARGUMENTS_FILES];
  int            count; /* of the options files, which must not be overwritten; known to rank 0 */
  SamArgument   *given; /* known to rank 0, */
  int            givens, sources;
  char           warning[512]; /* as is what may not be meant; "": nothing */
} SamArguments;

/*
  SamArgumentsExamine - takes -help, with the words after it, and -version from the command line, and looks through the
  rest, the options files and PETSC_OPTIONS, for mistakes at which PETSc would end the program with a trace, or wait for
  ever, and for options that load code or start programs. After a mistake nothing is left for PETSc to read.
  To be called between MPI_Init() and PetscInitialize(). Collective over MPI_COMM_WORLD.
*/
PETSC_EXTERN void SamArgumentsExamine(int *argc, char ***argv, SamArguments *arguments);
/* SamArgumentsSeparate - makes all white space in a text outside of quotes what PETSc separates options by: spaces. */
PETSC_INTERN void SamArgumentsSeparate(char text[]);
/*
  SamArgumentsExamineText - looks through options in one text, and the options files that they name, likewise; -help
  and -version are mistakes. Rank 0 looks and tells the others. Collective over `comm`.
*/
PETSC_INTERN void SamArgumentsExamineText(MPI_Comm comm, const char text[], SamArguments *arguments);
/*
  SamArgumentsFindPlace - the file and line of an option's value, with a colon; "" for one that stands on the command
  line or in PETSC_OPTIONS, and on other ranks than 0. `name` ends at a space, colon or comma. Not collective.
*/
PETSC_EXTERN const char *SamArgumentsFindPlace(const SamArguments *arguments, const char name[]);
PETSC_EXTERN void        SamArgumentsFree(SamArguments *arguments);
/*
  SamArgumentsRefuseUnknown - refuses options that the set-up has not read: they are misspelled, or have no effect.
  `arguments`: of a program, whose options for the end of PETSc are not among them; they tell an option's file and
  line. NULL: none.
  Collective. Errors: SAM_ERR_USER, raised on `comm`.
*/
PETSC_EXTERN PetscErrorCode SamArgumentsRefuseUnknown(MPI_Comm comm, const SamArguments *arguments);

#endif
