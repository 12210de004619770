/* The inside of a contact in another program. */
#ifndef PETSAM_EMBEDIMPL_H
#define PETSAM_EMBEDIMPL_H

#include <petsam/embed.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/advice.h>
#include <petsam/private/checkpoint.h>
#include <petsam/private/simulation.h>
#include <petsam/stiffness.h>

enum { SAM_EMBED_USAGE = 2, SAM_EMBED_FILE = 3 };
#define SAM_EMBED_BETWEEN " \t\r\n\v\f" /* blanks, which names must not contain */

/* The recorded steps, and the results of petsam_stress() and petsam_fatigue() (embedstress.c) */
typedef struct _n_SamEmbedStress *SamEmbedStress;

struct petsam_contact {
  petsam_contact *next; /* in the list of all contacts that have not been destroyed */
  MPI_Comm        comm;
  PetscOptions    options; /* the contact's own database */
  SamSimulation   simulation;
  const SamSetup *setup;      /* its own */
  SamConditions   conditions; /* of the problem */
  SamControl      control;    /* loads and conditions given by options */
  PetscInt        increments; /* increments per row of a history */
  SamStep         last;       /* last tried step; after its rejection no step and no failure */
  Vec             work;
  PetscBool       has_gap; /* a gap has been given, */
  uint64_t        gap;     /* with this checksum */
  int             depth;   /* calls under way: 2 for one from a monitor */
  char            message[SAM_MESSAGE];
  char          **warning;  /* lines on the last tried step, or run */
  int             warnings; /* number of warnings */
  PetscBool       advised;  /* all warnings have been collected */

  SamEmbedStress stress; /* NULL: nothing yet */
};

/* SamEmbedWarn - adds a warning; `setting`: the option that helps, or empty. Not collective. */
PETSC_INTERN PetscErrorCode SamEmbedWarn(petsam_contact *c, const char text[], const char setting[]);
/*
  SamEmbedStart - starts MPI and PETSc unless they have been started. Returns 0, or 2 with a message. Not collective.
*/
PETSC_INTERN int SamEmbedStart(char message[], size_t size);

/* SamEmbedAdd, SamEmbedAddText - add an argument to a checksum of a call's arguments; NULL: it was not given. */
static inline uint64_t SamEmbedAdd(uint64_t sum, const void *bytes, size_t size)
{
  return SamHashMix(bytes ? SamHashBytes(sum + 1, (const unsigned char *)bytes, size) : sum);
}

static inline uint64_t SamEmbedAddText(uint64_t sum, const char text[])
{
  return SamEmbedAdd(sum, text, text ? strlen(text) + 1 : 0);
}

/*
  SamEmbedExists - returns true if a pointer is a contact that has not been destroyed; it may be any pointer.
  SamEmbedEnter - begins a call of a function: options are those of the contact, errors become messages. Returns false,
  with a message, if not all pointers were `given` to the function, c is no contact that exists, or MPI or PETSc has
  been finalized.
  SamEmbedEnterTogether - the same for a function in which ranks wait for each other. It also returns false, with a
  message, if not all ranks call it with the same `arguments`, a checksum. Collective.
  SamEmbedLeave - ends the call; returns the exit code for an error.
  SamEmbedRefuse - sets the message, and returns 2; for mistakes that need no PETSc to be found, the same on all ranks.
  The others are not collective.
*/
PETSC_INTERN PetscBool SamEmbedExists(const petsam_contact *c);
PETSC_INTERN PetscBool SamEmbedEnter(petsam_contact *c, const char function[], PetscBool given);
PETSC_INTERN PetscBool SamEmbedEnterTogether(petsam_contact *c, const char function[], PetscBool given,
                                             uint64_t arguments);
PETSC_INTERN int       SamEmbedLeave(petsam_contact *c, PetscErrorCode code);
PETSC_INTERN int       SamEmbedRefuse(petsam_contact *c, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
/* SamEmbedCopyField - copies this rank's rows of a field of the results. Collective. */
PETSC_INTERN PetscErrorCode SamEmbedCopyField(petsam_contact *c, const char name[], double values[]);
/*
  SamEmbedForget - discards the tried step, before the contact changes. Collective. Errors: PETSC_ERR_ORDER in a
  monitor.
*/
PETSC_INTERN PetscErrorCode SamEmbedForget(petsam_contact *c);
/* SamEmbedInsertOptions - puts rank 0's options into a database. Collective. Errors: faults of their text. */
PETSC_INTERN PetscErrorCode SamEmbedInsertOptions(petsam_contact *c, PetscOptions database, const char options[]);
/*
  SamEmbedRecord - records the tried step, else the committed one, if steps are recorded. SamEmbedForgetSteps - discards
  the recorded steps. SamEmbedRecordAnew - does the same after the state has been replaced. SamEmbedDestroyStress -
  frees all data of embedstress.c. Collective.
*/
PETSC_INTERN PetscErrorCode SamEmbedRecord(petsam_contact *c, const SamStep *step);
PETSC_INTERN void           SamEmbedForgetSteps(petsam_contact *c);
PETSC_INTERN PetscErrorCode SamEmbedRecordAnew(petsam_contact *c);
PETSC_INTERN PetscErrorCode SamEmbedDestroyStress(petsam_contact *c);

#endif
