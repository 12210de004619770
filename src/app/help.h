/* What -help prints: all options, one topic, or the whole for other programs to read. */
#ifndef PETSAM_APP_HELP_H
#define PETSAM_APP_HELP_H

#include "program.h"

/*
  SamProgramHelp - prints the help of a program: all of it, or on the topic that its arguments name, which may also be
  the beginning of one, an option without its dash, or `json`. Options are read, but nothing else is done.
  Collective. Errors: SAM_ERR_USER for a topic that there is not, with the list of those that there are.
*/
PETSC_INTERN PetscErrorCode SamProgramHelp(const SamProgram *program, const SamArguments *arguments);

#endif
