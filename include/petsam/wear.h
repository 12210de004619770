/* Fretting wear: surfaces that lose material where they slip. */
#ifndef PETSAM_WEAR_H
#define PETSAM_WEAR_H

#include <petsam/contact.h>

/* The local laws of wear. */
typedef enum {
  SAM_WEAR_ARCHARD, /* removed depth = k p |ds|, k in 1/Pa */
  SAM_WEAR_ENERGY   /* removed depth = alpha |q . ds|, alpha in m3/J */
} SamWearLaw;

/*
  SamWear - the wear of the two bodies of a contact. It remembers the gap that the contact's problem has when it is
  created, that of the unworn bodies; from then on it sets the problem's gap, which grows by the depths of both bodies.
  Both are removed at the place on the grid where the surfaces slip: right while the stroke is small against the scar.

  Each body's depth is its coefficient times the same field, the wear load: the sum of p |ds| (Pa m) or of |q . ds|
  (J/m2) in cells that slip. A step wears in three calls:
    SamContactTry()      solves it
    SamWearCountStep()   adds its wear load to that of the cycle, while it is tried
    SamContactCommit()
  Then SamWearApply() removes what the cycle's wear load amounts to, some times over, and begins a new cycle, and
  SamWearMoveGap() makes the gap follow. Before that, results of the step can be written: its gap is that on which it
  was solved, its depths are those at its end.
*/
typedef struct _n_SamWear *SamWear;

/*
  SamWearCreate - no wear so far; references the contact's problem. Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a
  coefficient (of body 1 and 2) that is negative or not finite.
*/
PETSC_EXTERN PetscErrorCode SamWearCreate(SamContact contact, SamWearLaw law, const PetscReal coefficient[2],
                                          SamWear *wear);
/* SamWearDestroy - the problem keeps its gap. Collective. */
PETSC_EXTERN PetscErrorCode SamWearDestroy(SamWear *wear);
/* SamWearCountStep - see above. Collective. Errors: PETSC_ERR_ORDER without a tried step. */
PETSC_EXTERN PetscErrorCode SamWearCountStep(SamWear wear);
/*
  SamWearGetExcess - what the tried step that was counted last wears, over the most that a step may wear: above 1 the
  pressure of the steps to come is uneven from cell to cell, and wrong. That limit is a depth of 1.16 (p/E*) h of
  half-spaces, h being the width of square cells. Collective. Errors: PETSC_ERR_ORDER without a tried step.
*/
PETSC_EXTERN PetscErrorCode SamWearGetExcess(SamWear wear, PetscReal *excess);
/* SamWearApply - removes material by `times` the wear load of the cycle, which is 0 then. Collective. */
PETSC_EXTERN PetscErrorCode SamWearApply(SamWear wear, PetscReal times);
/* SamWearMoveGap - makes the problem's gap that of the unworn bodies and what has been removed. Collective. */
PETSC_EXTERN PetscErrorCode SamWearMoveGap(SamWear wear);
/*
  SamWearGetLoad, SamWearSetLoad - the wear load that has been removed so far: the state of the wear. A copy, into and
  from a vector of one component; the gap follows what is set. Collective.
*/
PETSC_EXTERN PetscErrorCode SamWearGetLoad(SamWear wear, Vec load);
PETSC_EXTERN PetscErrorCode SamWearSetLoad(SamWear wear, Vec load);
/*
  SamWearGetDepth - the depth (m) removed of body 0 or 1, into a vector of one component.
  SamWearGetVolumes - the volumes (m3) removed of both bodies, and the largest depths (m). Both are collective.
*/
PETSC_EXTERN PetscErrorCode SamWearGetDepth(SamWear wear, PetscInt body, Vec depth);
PETSC_EXTERN PetscErrorCode SamWearGetVolumes(SamWear wear, PetscReal volume[2], PetscReal depth[2]);

#endif
