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
  Vec        step, slip;     /* scratch: wear load and length of slip of a step */
};

/* SamWearSetGap - makes the problem's gap that of the unworn bodies and a wear load. Collective. */
PETSC_INTERN PetscErrorCode SamWearSetGap(SamWear wear, Vec load);

#endif
