/* The solution of a load step. */
#ifndef PETSAM_SOLUTION_H
#define PETSAM_SOLUTION_H

#include <petsam/problem.h>
#include <petsam/tangential.h>

/*
  SamSlipRule - the shear that the slip of a step is opposite to, and the place where slip begins in cells that come
  into contact; the method stands in src/contact/step/direction.c.
*/
typedef enum {
  SAM_RULE_END,         /* the shear at the end of the step; slip counts from the place before the step */
  SAM_RULE_END_LINE,    /* the same, while all loads lie on a line: the shear does not turn */
  SAM_RULE_LINE,        /* the shear at the end; slip begins where cells touch, by the ratio of the loads */
  SAM_RULE_TOUCHING,    /* the same; slip of dissimilar bodies counts from the time at which cells touch */
  SAM_RULE_MID,         /* the shear at mid step; slip begins where cells touch, by the ratio of the loads */
  SAM_RULE_MID_TOUCHING /* the same; slip of dissimilar bodies counts from the time at which cells touch */
} SamSlipRule;

/*
  SamSolution - the solution of a load step: tractions, rigid displacements and relative elastic displacements u. A
  field has one component, or two: on each rank all of x, then all of y. With the separation h of the bodies, by their
  shape and by the laws between them, the gap is g = u_z + h - rigid and the slip is s = u_t + stretch - rigid. Where
  the surfaces attract each other, bodies are loaded by the pressure of contact less the tension, and `load` contains
  what contact bears because of the tension: the given loads are those of both.
*/
typedef struct {
  SamControl  control;               /* prescribed values */
  PetscReal   rolled;                /* m: length of the path that the bodies roll in the step */
  PetscReal   roll[2];               /* m: that path along x and y */
  SamSlipRule rule;                  /* of the step; undefined in a committed solution */
  PetscReal   load[SAM_COMPONENTS];  /* N, N m: given or found, which contact bears */
  PetscReal   rigid[SAM_COMPONENTS]; /* m, rad: given or found */
  Vec         pressure;              /* Pa: that of contact, >= 0 */
  Vec         tension;               /* Pa, >= 0: by which the surfaces attract each other; NULL: they do not */
  Vec         bound;                 /* largest shear, Pa */
  Vec         shear;                 /* Pa, two components: acts on body 2 */
  Vec         displacement_z;        /* m: relative elastic displacement u_z */
  Vec         displacement_t;        /* m, two components: relative elastic displacement u_t */
  /*
    Part of the slip of the step that the shear at its end does not oppose (m, two components; NULL: zero): in cells
    that were in contact before, by the rotation of the shear; in others, the motion of the surfaces over each other
    until they touched.
  */
  Vec aside;
} SamSolution;

#endif
