/* The topics of the help of each program. */
#ifndef PETSAM_APP_TOPICS_H
#define PETSAM_APP_TOPICS_H

#include <petscsys.h>

#define SAM_TOPIC_GROUPS 3 /* most groups of a topic */

/* The title of the group of options that all programs have. */
#define SAM_TOPIC_EVERY_PROGRAM "Of every program and of PETSc"

typedef struct {
  const char *name;
  const char *group[SAM_TOPIC_GROUPS]; /* titles of the groups of options that belong to it; NULL: no more */
  const char *text;                    /* lines that begin with two spaces are kept as they are in the man page */
} SamTopic;

/* Arrays that end with a name of NULL. */
PETSC_INTERN const SamTopic SamPetsamTopics[], SamStressTopics[];

#endif
