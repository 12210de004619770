/* The options of a program as they are listed. */
#ifndef PETSAM_APP_HELPIMPL_H
#define PETSAM_APP_HELPIMPL_H

#include "help.h"
#include <petsam/private/help.h>

enum { SAM_HELP_NAME, SAM_HELP_ARGUMENT, SAM_HELP_TEXT, SAM_HELP_VALUE, SAM_HELP_WORDS, SAM_HELP_TEXTS };

typedef struct {
  char    *text[SAM_HELP_TEXTS]; /* as in SamOptionHelp */
  PetscInt group;
} SamListedOption;

typedef struct {
  PetscInt         groups, options, room_groups, room_options;
  char           **group; /* titles */
  SamListedOption *option;
} SamHelpList;

/* SamHelpFindTopic - the topic to which a group belongs; NULL: none. */
PETSC_INTERN const SamTopic *SamHelpFindTopic(const SamProgram *program, const char group[]);
/* SamHelpPrintJson - prints program, topics, groups and options as JSON. Collective. Errors: PETSC_ERR_MEM. */
PETSC_INTERN PetscErrorCode SamHelpPrintJson(const SamProgram *program, const SamHelpList *list);

#endif
