/* Functions of law, besides petsam/law.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_LAW_H
#define PETSAM_PRIVATE_LAW_H

#include <petsam/law.h>

/* SamLawReference - adds a reference. Not collective. */
PETSC_INTERN PetscErrorCode SamLawReference(SamLaw law);

/*
  SamLawGetTypes - gets the registered types, in the order of their registration; borrowed. Not collective.
  SamLawIsRegistered - returns true if a type of that name is registered. Not collective.
*/
PETSC_INTERN PetscErrorCode SamLawGetTypes(PetscInt *count, const SamLawType **types);
PETSC_INTERN PetscBool      SamLawIsRegistered(const char name[]);

/*
  SamLawSetFromOptions - reads the options of the law; `asked`: true if they select it. Collective. Errors:
  SAM_ERR_USER, SAM_ERR_FILE.
  SamLawAddConditions - adds the conditions of the law to the list of a problem, to which it then belongs. Not
  collective. Errors: PETSC_ERR_ARG_WRONG for a law of another problem.
  SamLawAddParameters - appends the parameters that define the law, under the names of its options. Collective.
*/
PETSC_INTERN PetscErrorCode SamLawSetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked);
PETSC_INTERN PetscErrorCode SamLawAddConditions(SamLaw law, SamConditions conditions);
PETSC_INTERN PetscErrorCode SamLawAddParameters(SamLaw law, SamParameters *parameters);

/*
  SamLawGetFriction - gets, for the type coulomb, the coefficient of friction.

  Not collective.

  In:     law      - the law
  Out:    friction - the coefficient (1); 0 if it is a field

  Errors: PETSC_ERR_ARG_WRONG for a law without such a coefficient.
*/
PETSC_EXTERN PetscErrorCode SamLawGetFriction(SamLaw law, PetscReal *friction);

/* SamBulkName - returns the name of the k-th bulk stress: xx, yy and xy of body 1, then of body 2. Not collective. */
enum { SAM_BULKS = 6 };
PETSC_INTERN const char *SamBulkName(PetscInt k);

#endif
