/* The motions of bodies over each other, for authors of new motions. */
#ifndef PETSAM_MOTIONIMPL_H
#define PETSAM_MOTIONIMPL_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/state.h>
#include <petsam/private/control.h>

/* SAM_NEEDS_ROLLING - options that -rolling_speed needs, in the format of SamOptionsNeed(). */
#define SAM_NEEDS_ROLLING "rolling steady or -friction_law falling"

/*
  SamMotion - the way in which the bodies move over each other in a load step, selected by -rolling. A new motion is a
  file with such a table, which SamMotionRegister() adds; if its displacements are not those of bodies at rest, it also
  needs a type of elasticity that adds to another one.

  Tangential displacements, slips, and works are always those of a step. If material streams through the contact, a step
  is 1 m of rolled distance: its rigid-body displacement is a creepage, and its slip per distance is a slip velocity
  relative to the rolling speed. The `names` of the motion express this.
*/
typedef struct {
  const char *usual;              /* name of a number or a field for steps in time */
  const char *name, *unit, *text; /* replacement in this motion; name NULL: none */
} SamMotionName;

/* SamMotionSubject - subjects that have no meaning in some motions. */
typedef enum { SAM_MOTION_HISTORY, SAM_MOTION_STIFFNESS, SAM_MOTION_SUBJECTS } SamMotionSubject;

struct _n_SamMotion {
  const char          *word;             /* value of -rolling */
  PetscBool            continues;        /* true: a step continues displacements and slip of the previous step */
  PetscBool            streams;          /* true: new material enters all the time; a step is 1 m of rolled distance */
  SamWay               way;              /* way that gives names and units of tangential rigid-body displacements */
  const SamMotionName *names;            /* ends with an entry without usual name; NULL: all names are the usual ones */
  const char          *work, *work_unit; /* name and unit of the frictional work of a step */
  const char          *slip_unit, *slip_heading; /* unit and heading of the slip in the report; heading NULL: usual */
  const char          *remedy;                   /* remedy if friction does not converge with the slip */
  const char          *meaningless[SAM_MOTION_SUBJECTS]; /* reason why a subject has no meaning; NULL: it has one */
  /* rejects bodies that cannot move so, and creates the operator; NULL: it is that of the bodies. Collective. */
  PetscErrorCode (*wrap)(SamElasticity bodies, const SamOptions *from, SamElasticity *moving);
  /* rejects controls without meaning in a step; `rolled`: its rolled distance, m; `where` as below. Not collective. */
  PetscErrorCode (*check)(SamElasticity bodies, SamConditions conditions, const SamControl *control, PetscReal rolled,
                          const char where[]);
};

#define SAM_MOTIONS 8 /* most motions */
/*
  SamMotionRegister - adds a motion, or replaces an earlier one of its word. Not collective, but to be called on all
  ranks. Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_MOTIONS.
*/
PETSC_EXTERN PetscErrorCode SamMotionRegister(SamMotion motion);
/* SamMotionOf - returns the motion of bodies. Not collective. */
PETSC_INTERN SamMotion SamMotionOf(SamElasticity elasticity);
/*
  SamMotionSetFromOptions - gives bodies the motion that -rolling names; the elasticity is replaced if the motion has
  its own operator. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMotionSetFromOptions(const SamOptions *from, SamElasticity *elasticity);
/* SamMotionSet - gives bodies a motion. Collective. */
PETSC_INTERN PetscErrorCode SamMotionSet(SamMotion motion, const SamOptions *from, SamElasticity *elasticity);
/*
  SamMotionRefuse - rejects an option (prefix "-") or a law of this subject, if it has no meaning in the motion. Not
  collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMotionRefuse(SamMotion motion, SamMotionSubject subject, MPI_Comm comm,
                                            const char prefix[], const char name[]);
/*
  SamMotionCheck - rejects a control that has no meaning in a step of this motion, or exceeds the width of the grid.
  `where`: "file, line 3: " or "", for the message. Not collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMotionCheck(SamElasticity elasticity, SamConditions conditions,
                                           const SamControl *control, const char where[]);
/*
  SamMotionAddConditions - adds the rolled distances of a step to a list (roll.c). Not collective.
  SamMotionRolled - returns the length of the rolled path, m, by which creepages are multiplied: a positive creepage
  gives a positive load for any direction of rolling. `distance`: the distances along x and y; NULL: not wanted. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamMotionAddConditions(SamConditions conditions);
PETSC_INTERN PetscReal      SamMotionRolled(SamConditions conditions, const SamControl *control, PetscReal distance[2]);
/*
  SamMotionFindName - returns the replacement that the motion has for a number or field of this name; NULL if it keeps
  the name. Not collective.
*/
PETSC_EXTERN const SamMotionName *SamMotionFindName(SamMotion motion, const char usual[]);
/*
  SamMotionDeclareNumber - declares a number under the motion's name for it. A renamed number is not summed over the
  parts of a step, and its error has no order. Not collective.
*/
PETSC_INTERN PetscErrorCode SamMotionDeclareNumber(SamMotion motion, SamState state, const SamStateNumber *number,
                                                   PetscInt *id);
/* SamMotionRigidName - returns name, unit and text of the rigid-body displacement of a component. Not collective. */
PETSC_EXTERN SamMotionName SamMotionRigidName(SamMotion motion, SamComponent component);

/* The motions. */
PETSC_INTERN const struct _n_SamMotion SamMotionInTime, SamMotionSteady;

#endif
