/* Examination of the command line, the options files and PETSC_OPTIONS, before PETSc acts on them. */
#ifndef PETSAM_ARGUMENTS_H
#define PETSAM_ARGUMENTS_H

#include <petsam/base.h>

#define SAM_ARGUMENTS_FILES 64 /* maximum number of options files */

/* Where an option is given; options files are numbered from 1. */
enum { SAM_SOURCE_LINE = 0, SAM_SOURCE_ENVIRONMENT = -1, SAM_SOURCE_TEXT = -2 };

/* SamArgument - a given option. */
typedef struct {
  char *name, *value, *place; /* without dash; "": none; in a file "file, line n: ", else "" */
  int   source;
} SamArgument;

typedef struct _n_SamArguments {
  PetscBool      help, version;
  char           topic[64];    /* words after -help; "": none */
  PetscErrorCode code;         /* error code of the first mistake; 0: none */
  char           message[512]; /* message of that mistake */
  char          *files[SAM_ARGUMENTS_FILES];
  int            count; /* number of options files, which must not be overwritten; only on rank 0 */
  SamArgument   *given; /* options, only on rank 0 */
  int            givens;
} SamArguments;

/*
  SamArgumentsExamine - removes -help, with the words after it, and -version from the command line, and examines the
  rest, the options files and PETSC_OPTIONS for words that PETSc would ignore, options that are given twice in one of
  these, files at which it would wait for ever or crash, and options that load code or start programs. After a mistake
  nothing is left for PETSc to read. It must be called between MPI_Init() and PetscInitialize(). Collective over
  MPI_COMM_WORLD.
*/
PETSC_EXTERN void SamArgumentsExamine(int *argc, char ***argv, SamArguments *arguments);
/*
  SamArgumentsSeparate - replaces all white space in a text, outside of quotes, by spaces, which PETSc needs between
  options.
*/
PETSC_INTERN void SamArgumentsSeparate(char text[]);
/*
  SamArgumentsExamineText - examines the options in one text, and the options files that they name, in the same way;
  -help and -version are mistakes. Rank 0 examines them and sends the outcome to the others. Collective over `comm`.
*/
PETSC_INTERN void SamArgumentsExamineText(MPI_Comm comm, const char text[], SamArguments *arguments);
/*
  SamArgumentsFindPlace - returns the file and line of an option's value, with a colon; "" for an option on the command
  line or in PETSC_OPTIONS, and on ranks other than 0. `name` ends at a space, or at a colon
  or comma that belongs to no given name. Not collective.
*/
PETSC_EXTERN const char *SamArgumentsFindPlace(const SamArguments *arguments, const char name[]);
PETSC_EXTERN void        SamArgumentsFree(SamArguments *arguments);
/*
  SamArgumentsRefuseUnknown - rejects options that the set-up has not read: they are misspelled, or have no effect.
  `arguments`: the arguments of a program, which give the file and line of an option; options that PETSc reads when it
  ends are then allowed. NULL: none. Collective. Errors: SAM_ERR_USER, raised on `comm`.
*/
PETSC_EXTERN PetscErrorCode SamArgumentsRefuseUnknown(MPI_Comm comm, const SamArguments *arguments);

#endif
