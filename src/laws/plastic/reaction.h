/* How the tractions of a contact follow a displacement of its surfaces. */
#ifndef PETSAM_PLASTIC_REACTION_H
#define PETSAM_PLASTIC_REACTION_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/lawimpl.h>

/* The components of a displacement and of a traction between the surfaces. */
enum { ALONG_Z, ALONG_X, ALONG_Y, DIRECTIONS };

/*
  SamReaction - a contact, borrowed, whose sets of cells are frozen: where it touches the gap stays closed, where it
  sticks the surfaces stay together, and where it slips the shear follows the pressure, keeping its direction.
  SamReactionFreeze - takes these sets, and the part of the pressure that the shear is, from the contact's tractions.
  SamReactionApply - u: a displacement of the surfaces (m), DIRECTIONS fields of this rank's cells one after the other,
  which becomes the change of the tractions by it (Pa). All are collective.
  SamReactionSlips - true if any cell slips: then the reaction is not symmetric. Not collective.
*/
typedef struct _n_SamReaction *SamReaction;
PETSC_INTERN PetscErrorCode    SamReactionCreate(SamElasticity elasticity, const SamLawContact *contact,
                                                 SamReaction *reaction);
PETSC_INTERN PetscErrorCode    SamReactionDestroy(SamReaction *reaction);
PETSC_INTERN PetscErrorCode    SamReactionFreeze(SamReaction reaction);
PETSC_INTERN PetscErrorCode    SamReactionApply(SamReaction reaction, double u[]);
PETSC_INTERN PetscBool         SamReactionSlips(SamReaction reaction);

#endif
