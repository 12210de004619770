/* A contact and all that it is made of, from options. */
#ifndef PETSAM_SETUP_H
#define PETSAM_SETUP_H

#include <petsam/contact.h>
#include <petsam/gap.h>
#include <petsam/output.h>
#include <petsam/wear.h>

/* SamSetup - what a program makes of its options before the first step. To be zero at first; owns its objects. */
typedef struct {
  SamGrid       grid;
  SamPair       pair;
  SamElasticity elasticity;
  SamProblem    problem;
  SamGap        gap;
  SamContact    contact;
  PetscBool     from_file[2]; /* the gap, and a roughness, come from files */
} SamSetup;

/*
  SamSetupReadOptions - reads the options of grid, bodies, elasticity, friction and gap, and makes all objects but the
  contact. The gap is not filled yet, as that may need much memory. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamSetupReadOptions(SamSetup *setup, const SamOptions *from);
/*
  SamSetupCreateContact - fills the gap, unless the help is being printed, and makes the contact, which reads its
  options. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamSetupCreateContact(SamSetup *setup, const SamOptions *from);
/*
  SamSetupAddParameters - appends what defines the contact, by the names of its options; fields by their checksums.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamSetupAddParameters(const SamSetup *setup, SamParameters *parameters);
/* SamParametersAddChecksum - appends a checksum, of what comes from a file for instance. Not collective. */
PETSC_EXTERN PetscErrorCode SamParametersAddChecksum(SamParameters *parameters, const char name[], uint64_t checksum);
/* SamSetupDestroy - frees all objects. Collective. */
PETSC_EXTERN PetscErrorCode SamSetupDestroy(SamSetup *setup);

/* SamWearLaws - the law of wear of a contact, as options give it. */
typedef struct {
  PetscBool  on; /* a coefficient is not 0 */
  SamWearLaw law;
  PetscReal  coefficient[2];
} SamWearLaws;
/* SamWearLawsSetFromOptions - -wear_coefficient1, 2 or -wear_energy1, 2. Collective. Errors: SAM_ERR_USER. */
PETSC_EXTERN PetscErrorCode SamWearLawsSetFromOptions(SamWearLaws *laws, const SamOptions *from);
/* SamWearLawsAddParameters - `kind`: what wears, none without wear. Not collective. */
PETSC_EXTERN PetscErrorCode SamWearLawsAddParameters(const SamWearLaws *laws, const char kind[],
                                                     SamParameters *parameters);

#endif
