/* The inside of SamWear, for what jumps over cycles. */
#ifndef PETSAM_WEARIMPL_H
#define PETSAM_WEARIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/wear.h>

struct _n_SamWear {
  SamContact contact; /* borrowed */
  SamProblem problem;
  SamGrid    grid; /* borrowed */
  SamWearLaw law;
  PetscReal  coefficient[2]; /* of the bodies: 1/Pa, or m3/J */
  Vec        unworn;         /* gap without wear, m */
  Vec        load;           /* wear load that has been applied, Pa m or J/m2 */
  Vec        cycle;          /* wear load of the cycle so far */
  Vec        path;           /* length of the slip in the cycle so far, m, outside of the contact too */
  Vec        step, slip;     /* wear load and length of slip of the step that was counted last */
  PetscReal  least;          /* smallest eigenvalue of the normal influence, m/Pa; 0: not known yet */
};

/* SamWearSetGap - makes the problem's gap that of the unworn bodies and a wear load. Collective. */
PETSC_INTERN PetscErrorCode SamWearSetGap(SamWear wear, Vec load);
/*
  SamWearGetLimit - how many times a wear load of `most` per pressure (m) may be removed at once with explicit wear
  (limit.c); infinite without wear. Collective.
*/
PETSC_INTERN PetscErrorCode SamWearGetLimit(SamWear wear, PetscReal most, PetscReal *times);
/* SamWearGetUnit - the wear load of a unit of path per pressure: 1, or the coefficient of friction. Collective. */
PETSC_INTERN PetscErrorCode SamWearGetUnit(SamWear wear, PetscReal friction_scale, Vec unit);

#endif
