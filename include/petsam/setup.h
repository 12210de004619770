/* A contact and all that it is made of, from options. */
#ifndef PETSAM_SETUP_H
#define PETSAM_SETUP_H

#include <petsam/contact.h>
#include <petsam/gap.h>

/* SamSetup - what a program makes of its options before the first step. To be zero at first; owns its objects. */
typedef struct {
  SamGrid       grid;
  SamPair       pair;
  SamElasticity elasticity;
  SamProblem    problem;
  SamGap        gap;
  SamContact    contact;
} SamSetup;

/*
  SamSetupReadOptions - loads plugins, reads the options of grid, bodies, elasticity, friction and gap, and makes
  all objects but the contact. The gap is not filled yet, as that may need much memory. Collective. Errors:
  SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamSetupReadOptions(SamSetup *setup, const SamOptions *from);
/*
  SamSetupCreateContact - fills the gap, unless the help is being printed, and makes the contact, which reads its
  options. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamSetupCreateContact(SamSetup *setup, const SamOptions *from);
/*
  SamSetupCreateCoarse - the same bodies on half the cells in each direction, rounded up, with a contact of the same
  options. Heights from files become means over the cells. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamSetupCreateCoarse(const SamSetup *setup, const SamOptions *from, SamSetup *coarse);
/*
  SamSetupAddParameters - appends what defines the contact, by the names of its options; fields by their checksums.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSetupAddParameters(const SamSetup *setup, SamParameters *parameters);
/* SamSetupDestroy - frees all objects. Collective. */
PETSC_INTERN PetscErrorCode SamSetupDestroy(SamSetup *setup);

#endif
