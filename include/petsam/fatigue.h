/* Fatigue parameters of the stress at a point over a closed cycle. */
#ifndef PETSAM_FATIGUE_H
#define PETSAM_FATIGUE_H

#include <petsam/stress.h>

typedef struct {
  PetscReal young, poisson; /* of the body, Pa, 1 */
  PetscReal crossland_alpha, dang_van_alpha, findley_k, fatemi_socie_k;
  PetscReal yield; /* Pa; for Fatemi and Socie */
} SamFatigueConstants;

/*
  SamFatigueCycle - the states of a closed cycle at a point, whose order counts for Ruiz's parameters only: component c
  of state k is stress[c * states + k] (Pa), and of the slip (m) since the state before slip[c * states + k]; the last
  state is followed by the first. There is room for SAM_FATIGUE_SCRATCH * states numbers in `scratch`.
*/
#define SAM_FATIGUE_SCRATCH 11
typedef struct {
  const SamFatigueConstants *constants;
  PetscInt                   states;
  const double              *stress, *slip; /* NULL: there is no slip below the surface */
  double                    *scratch;
} SamFatigueCycle;
/*
  SamFatigueParameter - returns a parameter of a cycle. n is the normal of a plane, s_n the stress on it, e_n the strain
  along it, tau_a the radius of the minimum circumscribed circle of the shear stress path in it; S the deviator, R the
  radius of the minimum circumscribed sphere of its path in the norm sqrt(S:S), P_H the hydrostatic stress.
    SamFatigueCrossland    R/sqrt(2) + alpha max P_H, Pa (Crossland 1956)
    SamFatigueDangVan      max of tau + alpha P_H, tau the largest shear of S less the sphere's centre, Pa
    SamFatigueFindley      largest over n of tau_a + k max s_n, Pa (Findley 1959)
    SamFatigueSWT          largest over n of max s_n times half the range of e_n, Pa; 0 where s_n is never tensile
    SamFatigueFatemiSocie  largest over n of tau_a/G (1 + k max s_n/yield), 1 (Fatemi and Socie 1988)
    SamFatigueRuiz         D1, J/m2: a quarter of the closed integral of |q . ds|, q the shear on the surface, which for
                           a reciprocating cycle is the shear times the slip amplitude; NaN below the surface
  Planes are searched by 10 degrees, then around the best of them down to a sixth of a degree. The normal of the best
  one, its z not negative, goes to `more`; it is NaN where no plane is under tension (SWT). Of Ruiz's, D2 (Pa J/m2)
  does: D1 times the maximum tension in the direction of the maximum change of slip. Not collective.
  Sources: Smith, Watson and Topper 1970, J. Mater. 5, 767; Fatemi and Socie 1988, Fatigue Fract. Eng. Mater. Struct.
  11, 149; Papadopoulos 1997, Int. J. Fatigue 19, 219 (measures of the shear's path); Ruiz, Boddington and Chen 1984,
  Exp. Mech. 24, 208.
*/
typedef double      SamFatigueParameter(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueCrossland(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueDangVan(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueFindley(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueSWT(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueFatemiSocie(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueRuiz(const SamFatigueCycle *cycle, double more[]);

/*
  SamSmallestBall - the smallest ball about n > 0 points of that dimension, at most 5 (points[i * dimension + d]): its
  radius, and its centre. Not collective. Source: Gaertner 1999, Fast and robust smallest enclosing balls (ESA).
*/
#define SAM_BALL_DIMENSION 5
PETSC_INTERN double SamSmallestBall(PetscInt dimension, PetscInt n, const double points[], double center[]);

#endif
