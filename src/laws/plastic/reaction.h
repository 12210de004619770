/* The change of a contact's tractions by a displacement of its surfaces. */
#ifndef PETSAM_PLASTIC_REACTION_H
#define PETSAM_PLASTIC_REACTION_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/lawimpl.h>

/* The components of a displacement and of a traction between the surfaces */
enum { ALONG_Z, ALONG_X, ALONG_Y, DIRECTIONS };

/*
  SamReaction - a contact, borrowed, whose sets of cells are frozen: in contact the gap stays closed, in stick the
  surfaces do not move relative to each other, and in slip the shear follows the pressure and keeps its direction.
  SamReactionFreeze - takes these sets, and the ratios of shear to pressure, from the contact's tractions.
  SamReactionApply - replaces a displacement u of the surfaces (m), DIRECTIONS fields of this rank's cells one after the
  other, by the change of the tractions that it causes (Pa). All are collective.
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
