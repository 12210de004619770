/* The list of -help: the options that are read while it is printed, with their descriptions. */
#ifndef PETSAM_HELP_H
#define PETSAM_HELP_H

#include <petsam/base.h>

typedef struct {
  const char *name;     /* name with prefix, without dash */
  const char *argument; /* kind of value: <number>[,<number>], [<bool>], ... */
  const char *text;     /* description */
  const char *value;    /* default; "": none, or required */
  const char *words;    /* allowed words, separated by commas; "": no fixed words */
  const char *unit;     /* unit of SI; NULL: none */
} SamOptionHelp;

/*
  SamHelpFunction - a function that is called with the title of a group (`option` is NULL) and with each option (`title`
  is NULL).
*/
typedef PetscErrorCode (*SamHelpFunction)(void *context, MPI_Comm comm, const char title[],
                                          const SamOptionHelp *option);

/*
  SamHelpSetFunction - passes titles and options to a function instead of printing them; the function must copy what it
  keeps. The texts have their units. NULL: they are printed. Not collective.
*/
PETSC_EXTERN void SamHelpSetFunction(SamHelpFunction function, void *context);
/* SamHelpPrint - prints a title or an option, from rank 0; `context` is not used. */
PETSC_EXTERN PetscErrorCode SamHelpPrint(void *context, MPI_Comm comm, const char title[], const SamOptionHelp *option);
/*
  SamOptionsDescribe - lists an option in the help while that is printed, and notes that an option of this name exists.
  It is for code that reads options by other means than SamOptionsReal() and so on.
*/
PETSC_EXTERN PetscErrorCode SamOptionsDescribe(const SamOptions *from, const SamOptionHelp *option);

#endif
