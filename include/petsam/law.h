/* Laws between two surfaces: friction, yielding, wear, and the fields that they accumulate. */
#ifndef PETSAM_LAW_H
#define PETSAM_LAW_H

#include <petsam/control.h>
#include <petsam/elasticity.h>
#include <petsam/parameters.h>
#include <petsam/state.h>

/*
  SamLaw - one law between the surfaces of a problem, which has a list of laws (problem.h). A law may bound the shear,
  limit the pressure, add to the separation of the bodies, and store fields and numbers in the state of a contact, from
  which checkpoints and results take them. private/lawimpl.h describes how to write a law.
*/
typedef struct _n_SamLaw *SamLaw;
typedef const char       *SamLawType;
#define SAM_LAW_COULOMB           "coulomb"           /* shear up to a coefficient times the pressure */
#define SAM_LAW_BULK_STRESS       "bulk_stress"       /* a uniform stress stretches a body (law/bulk.c) */
#define SAM_LAW_BODIES            "bodies"            /* stored fields of bodies, and their load cases (law/bodies.c) */
#define SAM_LAW_SLIP_DEPENDENT    "slip_dependent"    /* friction changes with accumulated slip (changingfriction.c) */
#define SAM_LAW_PRESSURE_FRICTION "pressure_friction" /* friction changes with the pressure */
#define SAM_LAW_FALLING_FRICTION  "falling_friction"  /* friction changes with the slip velocity in rolling */
#define SAM_LAW_SLIDE             "slide"             /* the surfaces move past each other (law/slide.c) */
#define SAM_LAW_ARCHARD           "archard"           /* wear in proportion to pressure and slip (wear.h) */
#define SAM_LAW_ENERGY            "energy"            /* wear in proportion to the frictional work (wear.h) */
#define SAM_LAW_HARDNESS          "hardness"          /* pressure up to a limit, at which the surfaces yield */
#define SAM_LAW_PLASTIC           "plastic"           /* bodies that yield below the surface (plastic/plastic.c) */
#define SAM_LAW_ACCUMULATED_SLIP  "slip_path"         /* accumulates the slip */
#define SAM_LAW_FRICTION_ENERGY   "friction_energy"   /* accumulates the frictional work */
/* The condition of coulomb, a factor on the coefficient of friction. */
#define SAM_FRICTION_SCALE "friction_scale"

/*
  SamLawCreate - creates a law of that type, with the type's defaults; it references the elasticity. Collective. Errors:
  PETSC_ERR_ARG_UNKNOWN_TYPE for a type that is not registered.
  SamLawReference, SamLawDestroy - add and drop a reference; the last one dropped frees the law. Collective.
*/
PETSC_EXTERN PetscErrorCode SamLawCreate(SamElasticity elasticity, SamLawType type, SamLaw *law);
PETSC_INTERN PetscErrorCode SamLawReference(SamLaw law);
PETSC_EXTERN PetscErrorCode SamLawDestroy(SamLaw *law);
/*
  SamLawRegister - adds a type; `create` sets the methods and defaults of a law, see private/lawimpl.h. Laws act in the
  order in which their types were registered. A type replaces an earlier type of that name. Not collective, but to be
  called on all ranks. Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_LAWS types.
  SamLawGetTypes - gets the registered types, in that order; borrowed. Not collective.
  SamLawIsRegistered - returns true if a type of that name is registered. Not collective.
*/
#define SAM_LAWS 32
PETSC_EXTERN PetscErrorCode SamLawRegister(const char name[], PetscErrorCode (*create)(SamLaw));
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
  SamLawSetHardness - sets, for the type hardness, the largest pressure (Pa), at which the surfaces yield; infinite:
  none. Not collective, the same on all ranks. Errors: PETSC_ERR_ARG_OUTOFRANGE unless it is > 0.
*/
/*
  SamLawGetFriction - gets, for the type coulomb, the coefficient of friction; 0 if it is a field. Not collective.
  Errors: PETSC_ERR_ARG_WRONG for a law without such a coefficient.
*/
PETSC_EXTERN PetscErrorCode SamLawGetFriction(SamLaw law, PetscReal *friction);
PETSC_EXTERN PetscErrorCode SamLawSetHardness(SamLaw law, PetscReal hardness);
/*
  SamLawSetSurface - sets, for the type slide, the part of the separation (m, one component) that moves with body 0 or
  1. Its values are at the points of the body that lie under the cells before any motion; copied. Collective. Errors:
  PETSC_ERR_ARG_WRONG for a law of another type.
*/
PETSC_EXTERN PetscErrorCode SamLawSetSurface(SamLaw law, PetscInt body, Vec surface);
#endif
