/* Fretting wear: surfaces that lose material where they slip. */
#ifndef PETSAM_WEAR_H
#define PETSAM_WEAR_H

#include <petsam/law.h>

/*
  The laws `archard` (removed depth = k p |ds|, k in 1/Pa) and `energy` (removed depth = alpha |q . ds|, alpha in m3/J)
  of a problem. Each body's depth is its coefficient times the same field, the wear load: the sum of p |ds| (Pa m) or of
  |q . ds| (J/m2) in cells that slip. The gap of a step is that of the bodies before the step; its depths are those at
  its end. Both bodies lose material at the place on the grid where the surfaces slip, which is accurate while the
  stroke is small compared with the scar.
*/

/*
  SamLawSetWear - sets the wear coefficients of both bodies, for the types archard and energy.

  Not collective, the same on all ranks.

  In:     law         - the law
          coefficient - coefficients of body 1 and 2 (1/Pa, or m3/J for the type energy), >= 0

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a coefficient that is negative or not finite; PETSC_ERR_ARG_WRONG for a law of
  another type.

  See also: SamLawCreate(), SamProblemAddLaw().
*/
PETSC_EXTERN PetscErrorCode SamLawSetWear(SamLaw law, const PetscReal coefficient[2]);

#endif
