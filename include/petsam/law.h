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
#define SAM_LAW_COULOMB           "coulomb"        /* shear up to a coefficient times the pressure */
#define SAM_LAW_BULK_STRESS       "bulk_stress"    /* a uniform stress stretches a body (laws/bulk.c) */
#define SAM_LAW_BODIES            "bodies"         /* stored fields of bodies, and their load cases (laws/bodies.c) */
#define SAM_LAW_SLIP_DEPENDENT    "slip_dependent" /* friction changes with accumulated slip (changingfriction.c) */
#define SAM_LAW_PRESSURE_FRICTION "pressure_friction" /* friction changes with the pressure */
#define SAM_LAW_FALLING_FRICTION  "falling_friction"  /* friction changes with the slip velocity in rolling */
#define SAM_LAW_HEAT              "heat"              /* temperatures by frictional heat (laws/heat/heatlaw.c) */
#define SAM_LAW_SLIDE             "slide"             /* the surfaces move past each other (laws/slide.c) */
#define SAM_LAW_ARCHARD           "archard"           /* wear in proportion to pressure and slip (wear.h) */
#define SAM_LAW_ENERGY            "energy"            /* wear in proportion to the frictional work (wear.h) */
#define SAM_LAW_HARDNESS          "hardness"          /* pressure up to a limit, at which the surfaces yield */
#define SAM_LAW_PLASTIC           "plastic"           /* bodies that yield below the surface (plastic/plastic.c) */
#define SAM_LAW_ACCUMULATED_SLIP  "slip_path"         /* accumulates the slip */
#define SAM_LAW_FRICTION_ENERGY   "friction_energy"   /* accumulates the frictional work */
/* The condition of coulomb, a factor on the coefficient of friction. */
#define SAM_FRICTION_SCALE "friction_scale"

/*
  SamLawCreate - creates a law with the defaults of its type.

  Collective.

  In:     elasticity - the elasticity of the bodies; referenced
          type       - name of a registered type
  Out:    law        - the law

  Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for a type that is not registered.

  See also: SamProblemAddLaw(), SamProblemAddLawOfType(), SamLawDestroy().
*/
PETSC_EXTERN PetscErrorCode SamLawCreate(SamElasticity elasticity, SamLawType type, SamLaw *law);

/*
  SamLawDestroy - drops a reference of the law, the last one frees it; sets the handle to NULL.

  Collective.

  In,out: law - the law; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamLawDestroy(SamLaw *law);

#define SAM_LAWS 32 /* most types of laws */

/*
  SamLawRegister - adds a type of law, or replaces an earlier type of that name.

  Not collective, but to be called on all ranks.

  In:     name   - name of the type
          create - function that sets the methods and defaults of a law, see private/lawimpl.h

  Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_LAWS types.

  Laws act in the order in which their types were registered.

  See also: SamLawCreate(), SamOptionsPlugins().
*/
PETSC_EXTERN PetscErrorCode SamLawRegister(const char name[], PetscErrorCode (*create)(SamLaw));

/*
  SamLawSetHardness - sets, for the type hardness, the maximum pressure, at which the surfaces yield.

  Not collective, the same on all ranks.

  In:     law      - the law
          hardness - maximum pressure (Pa); infinite: none

  Errors: PETSC_ERR_ARG_WRONG for a law of another type; PETSC_ERR_ARG_OUTOFRANGE unless the hardness is > 0.

  See also: SamLawCreate(), SamProblemAddLaw().
*/
PETSC_EXTERN PetscErrorCode SamLawSetHardness(SamLaw law, PetscReal hardness);

/*
  SamLawSetSurface - sets, for the type slide, the part of the separation that moves with a body.

  Collective.

  In:     law     - the law
          body    - index of the body: 0 or 1
          surface - part of the separation (m), one component; copied

  Errors: PETSC_ERR_ARG_WRONG for a law of another type; PETSC_ERR_ARG_OUTOFRANGE for another body;
  PETSC_ERR_ARG_SIZ for a vector of another size.

  The values are at the points of the body that lie under the cells before any motion.

  See also: SamLawCreate(), SamGridCreateVec().
*/
PETSC_EXTERN PetscErrorCode SamLawSetSurface(SamLaw law, PetscInt body, Vec surface);

#endif
