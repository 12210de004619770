/* The motions of bodies over each other, for those who add some. */
#ifndef PETSAM_MOTIONIMPL_H
#define PETSAM_MOTIONIMPL_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/state.h>

/*
  SamMotion - how the bodies move over each other in a load step. The user chooses it by -rolling. A new one is a file
  with such a table and a line in motion.c, and where its displacements are not those of bodies at rest, a type of
  elasticity that adds to another one.

  Tangential displacements, slips, and works are always those of a step. Where material streams through the contact, a
  step is one of 1 m of rolled distance: a rigid-body displacement of it is a creepage, and a slip relative to that
  distance is a velocity relative to that of rolling. The motion's `names` say so.
*/
typedef struct {
  const char *usual;              /* the name of a number or a field for steps in time */
  const char *name, *unit, *text; /* what the motion has instead; name NULL: nothing */
} SamMotionName;

/* Subjects that have no meaning in some motions. */
typedef enum { SAM_MOTION_HISTORY, SAM_MOTION_STIFFNESS, SAM_MOTION_SUBJECTS } SamMotionSubject;

struct _n_SamMotion {
  const char          *word;      /* of -rolling */
  PetscBool            continues; /* a step continues displacements and slip of the one before */
  PetscBool            streams;   /* new material enters all the time: steps are those of 1 m of rolled distance */
  SamWay               way;       /* whose name and unit tangential rigid-body displacements have */
  const SamMotionName *names;     /* the last one has no usual name; NULL: all names are the usual ones */
  const char          *work, *work_unit;                 /* the number of the frictional work of a step */
  const char          *slip_unit, *slip_heading;         /* of the slip in the report; heading NULL: the usual one */
  const char          *remedy;                           /* of friction that does not converge with the slip */
  const char          *meaningless[SAM_MOTION_SUBJECTS]; /* why a subject has no meaning; NULL: it has one */
  /* refuses bodies that do not move so, and makes the operator of those that do; NULL: it is theirs. Collective. */
  PetscErrorCode (*wrap)(SamElasticity bodies, const SamOptions *from, SamElasticity *moving);
  /* refuses what has no meaning in a step; `rolled`: its rolled distance, m; `where` as below. Not collective. */
  PetscErrorCode (*check)(SamElasticity bodies, SamConditions conditions, const SamControl *control, PetscReal rolled,
                          const char where[]);
};

/* SamMotionOf - the motion of bodies. Not collective. */
PETSC_INTERN SamMotion SamMotionOf(SamElasticity elasticity);
/*
  SamMotionSetFromOptions - gives bodies the motion that -rolling names: the elasticity becomes another one where the
  motion has an operator of its own. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMotionSetFromOptions(const SamOptions *from, SamElasticity *elasticity);
/* SamMotionSet - the same for a motion. Collective. */
PETSC_INTERN PetscErrorCode SamMotionSet(SamMotion motion, const SamOptions *from, SamElasticity *elasticity);
/*
  SamMotionRefuse - refuses an option (prefix "-") or a law of this subject, if it has no meaning in the motion. Not
  collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMotionRefuse(SamMotion motion, SamMotionSubject subject, MPI_Comm comm,
                                            const char prefix[], const char name[]);
/*
  SamMotionCheck - refuses what has no meaning in a step, or beyond the grid's width. `where`: "file, line 3: " or "",
  for the message. Not collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamMotionCheck(SamElasticity elasticity, SamConditions conditions,
                                           const SamControl *control, const char where[]);
/*
  SamMotionAddConditions - adds the rolled distances of a step to a list (roll.c). Not collective.
  SamMotionRolled - the length of the rolled path, m, by which creepages are multiplied: whatever the direction of
  rolling, a positive creepage makes a positive load. `distance`: along x and y, NULL: not wanted. Not collective.
*/
PETSC_INTERN PetscErrorCode SamMotionAddConditions(SamConditions conditions);
PETSC_INTERN PetscReal      SamMotionRolled(SamConditions conditions, const SamControl *control, PetscReal distance[2]);
/* SamMotionFindName - what the motion has instead of a number or field of this name; NULL: itself. Not collective. */
PETSC_EXTERN const SamMotionName *SamMotionFindName(SamMotion motion, const char usual[]);
/*
  SamMotionDeclareNumber - declares a number under the motion's name for it. One of a step by itself does not add up,
  and has no order of its error. Not collective.
*/
PETSC_INTERN PetscErrorCode SamMotionDeclareNumber(SamMotion motion, SamState state, const SamStateNumber *number,
                                                   PetscInt *id);
/* SamMotionRigidName - name, unit and text of the rigid-body displacement of a component. Not collective. */
PETSC_EXTERN SamMotionName SamMotionRigidName(SamMotion motion, SamComponent component);

/* The motions. */
PETSC_INTERN const struct _n_SamMotion SamMotionInTime, SamMotionSteady;

#endif
