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
#define SAM_EMBED_BETWEEN " \t\r\n\v\f" /* blanks, which no name contains */

/* The steps that are recorded, and the results of petsam_stress() and petsam_fatigue() (stress.c). */
typedef struct _n_SamEmbedStress *SamEmbedStress;

struct petsam_contact {
  petsam_contact *next; /* in the list of all contacts that have not been destroyed */
  MPI_Comm        comm;
  PetscOptions    options; /* its own database */
  SamSimulation   simulation;
  const SamSetup *setup;      /* its own */
  SamConditions   conditions; /* of its problem */
  SamControl      control;    /* those that options gave */
  PetscInt        increments; /* of each row of a history */
  SamStep         last;       /* that was tried; after its rejection none, and no failure */
  Vec             work;
  PetscBool       has_gap; /* a gap has been given, */
  uint64_t        gap;     /* of this checksum */
  int             depth;   /* calls under way: 2 for one from a monitor */
  char            message[SAM_MESSAGE];
  char          **warning;  /* lines on the last tried step, or run, */
  int             warnings; /* so many */
  PetscBool       advised;  /* all of them */

  SamEmbedStress stress; /* NULL: nothing yet */
};

/* SamEmbedWarn - adds a warning; `setting`: the option that mends it, or empty. Not collective. */
PETSC_INTERN PetscErrorCode SamEmbedWarn(petsam_contact *c, const char text[], const char setting[]);
/*
  SamEmbedStart - starts MPI and PETSc if nobody has. Returns 0, or 2 with a message. Not collective.
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
  SamEmbedEnter - begins a call of a function: options are those of the contact, errors become messages. False, with a
  message: not all pointers were `given` to the function, c is no contact that exists, or MPI or PETSc has been
  finalized.
  SamEmbedEnterTogether - the same for a function in which ranks wait for each other: false, with a message, if they do
  not all call it, or not with the same `arguments`, a checksum. Collective.
  SamEmbedLeave - ends it; returns the exit code for an error.
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
  SamEmbedForget - forgets the tried step, before anything changes. Collective. Errors: PETSC_ERR_ORDER in a monitor.
*/
PETSC_INTERN PetscErrorCode SamEmbedForget(petsam_contact *c);
/* SamEmbedInsertOptions - puts rank 0's options into a database. Collective. Errors: faults of their text. */
PETSC_INTERN PetscErrorCode SamEmbedInsertOptions(petsam_contact *c, PetscOptions database, const char options[]);
/*
  SamEmbedRecord - keeps the tried step, else the committed one, if steps are recorded. SamEmbedForgetSteps - forgets
  those that are. SamEmbedRecordAnew - the same on a state that has been replaced. SamEmbedDestroyStress - with all of
  stress.c. Collective.
*/
PETSC_INTERN PetscErrorCode SamEmbedRecord(petsam_contact *c, const SamStep *step);
PETSC_INTERN void           SamEmbedForgetSteps(petsam_contact *c);
PETSC_INTERN PetscErrorCode SamEmbedRecordAnew(petsam_contact *c);
PETSC_INTERN PetscErrorCode SamEmbedDestroyStress(petsam_contact *c);

#endif
