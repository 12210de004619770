/* What -help lists: the options that are read while it is printed, with all that is known of each. */
#ifndef PETSAM_HELP_H
#define PETSAM_HELP_H

#include <petsam/base.h>

typedef struct {
  const char *name;     /* with its prefix, without dash */
  const char *argument; /* kind of value: <number>[,<number>], [<bool>], ... */
  const char *text;     /* description */
  const char *value;    /* default; "": none, or required */
  const char *words;    /* those that may be given, with commas between them; "": no fixed words */
} SamOptionHelp;

/* What is done with the title of a group (`option` is NULL) and with an option (`title` is NULL). */
typedef PetscErrorCode (*SamHelpFunction)(void *context, MPI_Comm comm, const char title[],
                                          const SamOptionHelp *option);

/*
  SamHelpSetFunction - gives titles and options to a function, which must copy what it keeps, instead of printing them.
  NULL: they are printed. Not collective.
*/
PETSC_EXTERN void SamHelpSetFunction(SamHelpFunction function, void *context);
/* SamHelpPrint - prints a title or an option, from rank 0; `context` is not used. */
PETSC_EXTERN PetscErrorCode SamHelpPrint(void *context, MPI_Comm comm, const char title[], const SamOptionHelp *option);
/*
  SamOptionsDescribe - lists an option in the help while that is printed, and notes that there is one of this name. For
  those that read options by other means than SamOptionsReal() and so on.
*/
PETSC_EXTERN PetscErrorCode SamOptionsDescribe(const SamOptions *from, const SamOptionHelp *option);

#endif
