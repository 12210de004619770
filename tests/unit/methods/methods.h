/*
  Solver methods from outside of the library, as cross-checks of its own: slow but simple. They use nothing but the
  installed headers, and are examples of how to add a method.
*/
#ifndef PETSAM_METHODS_H
#define PETSAM_METHODS_H

#include <petsam/normal.h>
#include <petsam/tangential.h>

#define SAM_NORMAL_POLONSKYKEER "polonskykeer" /* the classical projected CG, on one grid */
#define SAM_TANGENTIAL_GRADIENT "projected"    /* accelerated projected gradient */

PetscErrorCode SamNormalCreate_PolonskyKeer(SamSolver solver);
PetscErrorCode SamTangentialCreate_Gradient(SamSolver solver);

/* Registers both, as the set-up of a group of tests. */
static inline int RegisterMethods(void **state)
{
  (void)state;
  return SamNormalRegister(SAM_NORMAL_POLONSKYKEER, SamNormalCreate_PolonskyKeer) ||
         SamTangentialRegister(SAM_TANGENTIAL_GRADIENT, SamTangentialCreate_Gradient);
}

#endif
