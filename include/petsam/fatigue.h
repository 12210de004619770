/* Fatigue parameters of the stress at a point over a closed cycle. */
#ifndef PETSAM_FATIGUE_H
#define PETSAM_FATIGUE_H

#include <petsam/stress.h>

/*
  SamFatigueParameter - what is computed of the states of one closed cycle, whose order counts for Ruiz's only. n is the
  normal of a plane, s_n the stress on it, e_n the strain along it, tau_a the radius of the minimum circumscribed circle
  of the shear stress path in it; S the deviator, R the radius of the minimum circumscribed sphere of its path in the
  norm sqrt(S:S), P_H the hydrostatic stress.
*/
typedef enum {
  SAM_FATIGUE_CROSSLAND, /* R/sqrt(2) + alpha max P_H, Pa (Crossland 1956) */
  SAM_FATIGUE_DANG_VAN,  /* max of tau + alpha P_H, tau the largest shear of S less the sphere's centre, Pa */
  SAM_FATIGUE_FINDLEY,   /* largest over n of tau_a + k max s_n, Pa (Findley 1959) */
  SAM_FATIGUE_SWT,       /* largest over n of max s_n times half the range of e_n, Pa; 0 where s_n is never tensile */
  SAM_FATIGUE_FATEMI_SOCIE, /* largest over n of tau_a/G (1 + k max s_n/yield), 1 (Fatemi and Socie 1988) */
  SAM_FATIGUE_PARAMETERS
} SamFatigueParameter;

typedef struct {
  PetscReal young, poisson; /* of the body, Pa, 1 */
  PetscReal crossland_alpha, dang_van_alpha, findley_k, fatemi_socie_k;
  PetscReal yield; /* Pa; for Fatemi and Socie */
} SamFatigueConstants;

/*
  SamFatigueCompute - a parameter of the states of a cycle at one point: stress[c * states + k] is component c (Pa) in
  state k. Planes are searched by 10 degrees, then around the best of them down to a sixth of a degree. The normal of
  the best one, its z not negative, goes to `normal`, which may be NULL; it is NaN for a parameter without planes, and
  where no plane is under tension (SWT). Not collective.
  Sources: Smith, Watson and Topper 1970, J. Mater. 5, 767; Fatemi and Socie 1988, Fatigue Fract. Eng. Mater. Struct.
  11, 149; Papadopoulos 1997, Int. J. Fatigue 19, 219 (measures of the shear's path).
*/
PETSC_INTERN PetscErrorCode SamFatigueCompute(SamFatigueParameter parameter, const SamFatigueConstants *constants,
                                              PetscInt states, const double stress[], double *value, double normal[3]);

/*
  SamFatigueRuiz - Ruiz's parameters on the surface. D1 = a quarter of the closed integral of |q . ds| (J/m2), which for
  a reciprocating cycle is the shear times the slip amplitude; D2 (Pa J/m2) = D1 times the maximum tension in the
  direction of the maximum change of slip. shear[c * states + k], slip[c * states + k]: their components along x and y
  (Pa, m) in state k; the last state is followed by the first. Not collective. Source: Ruiz, Boddington and Chen 1984,
  Exp. Mech. 24, 208.
*/
PETSC_INTERN void SamFatigueRuiz(PetscInt states, const double stress[], const double shear[], const double slip[],
                                 double *d1, double *d2);

/*
  SamSmallestBall - the smallest ball about n > 0 points of that dimension, at most 5 (points[i * dimension + d]): its
  radius, and its centre. Not collective. Source: Gaertner 1999, Fast and robust smallest enclosing balls (ESA).
*/
#define SAM_BALL_DIMENSION 5
PETSC_INTERN double SamSmallestBall(PetscInt dimension, PetscInt n, const double points[], double center[]);

#endif
