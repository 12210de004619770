/* Creating a contact and all its objects from options. */
#ifndef PETSAM_SETUP_H
#define PETSAM_SETUP_H

#include <petsam/contact.h>
#include <petsam/gap.h>

/*
  SamSetup - the objects that a program creates from its options before the first step. All members must be zero at
  first; the setup owns the objects.
*/
typedef struct {
  SamGrid       grid;
  SamPair       pair;
  SamElasticity elasticity;
  SamProblem    problem;
  SamConditions conditions; /* of the problem; borrowed */
  SamGap        gap;
  SamContact    contact;
} SamSetup;

/*
  SamSetupReadOptions - loads plugins, reads the options of grid, bodies, elasticity, friction and gap, and creates all
  objects except the contact. It does not fill the gap, which may need much memory. Collective. Errors: SAM_ERR_USER,
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamSetupReadOptions(SamSetup *setup, const SamOptions *from);
/*
  SamSetupCreateContact - fills the gap, unless the help is being printed, and creates the contact, which reads its
  options. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamSetupCreateContact(SamSetup *setup, const SamOptions *from);
/*
  SamSetupCreateCoarse - creates a setup of the same bodies whose cells are halved in each direction, rounded up, so
  many times (at least once), and a contact with the same options. Fields from files become means over the cells.
  Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamSetupCreateCoarse(const SamSetup *setup, PetscInt halvings, const SamOptions *from,
                                                 SamSetup *coarse);
/*
  SamSetupSetGap, SamSetupSetFriction - set the gap (m), or a coefficient of friction for each cell. SamSetupSetStart -
  sets one coefficient for all cells, that of the start. SamSetupFindNeeds - finds out if the surfaces bear shear
  anywhere, and the memory of the laws per cell (bytes). Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE.
*/
PETSC_INTERN PetscErrorCode SamSetupSetGap(const SamSetup *setup, Vec gap);
PETSC_INTERN PetscErrorCode SamSetupSetFriction(const SamSetup *setup, Vec friction);
PETSC_INTERN PetscErrorCode SamSetupSetStart(const SamSetup *setup, PetscReal friction);
PETSC_INTERN PetscErrorCode SamSetupFindNeeds(const SamSetup *setup, PetscBool *friction, PetscInt *laws);
/* SamSetupAverage - gets the means of a field of a setup over the cells of a coarse one made of it. Collective. */
PETSC_INTERN PetscErrorCode SamSetupAverage(const SamSetup *setup, Vec field, const SamSetup *coarse, Vec means);
/*
  SamSetupAddParameters - appends the parameters that define the contact, under the names of its options, and the
  checksums of fields. Collective.
*/
PETSC_INTERN PetscErrorCode SamSetupAddParameters(const SamSetup *setup, SamParameters *parameters);
/* SamSetupDestroy - frees all objects. Collective. */
PETSC_INTERN PetscErrorCode SamSetupDestroy(SamSetup *setup);

#endif
