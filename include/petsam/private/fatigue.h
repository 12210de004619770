/* Fatigue parameters of the stress at a point over a closed cycle. */
#ifndef PETSAM_FATIGUE_H
#define PETSAM_FATIGUE_H

#include <petsam/private/stress.h>

typedef struct {
  PetscReal young, poisson; /* constants of the body, Pa, 1 */
  PetscReal crossland_alpha, dang_van_alpha, findley_k, fatemi_socie_k;
  PetscReal yield; /* yield stress of Fatemi and Socie, Pa */
} SamFatigueConstants;

/*
  SamFatigueCycle - the states of a closed cycle at a point; their order matters for Ruiz's parameters only. Component c
  of the stress in state k is stress[c * states + k] (Pa); that of the slip since the previous state is slip[c * states
  + k] (m); the last state is followed by the first. `scratch` has room for SAM_FATIGUE_SCRATCH * states numbers.
*/
#define SAM_FATIGUE_SCRATCH 11
typedef struct {
  const SamFatigueConstants *constants;
  PetscInt                   states;
  const double              *stress, *slip; /* slip is NULL below the surface */
  double                    *scratch;
} SamFatigueCycle;
/*
  SamFatigueParameter - returns a parameter of a cycle. n is the normal of a plane, s_n the stress on it, e_n the strain
  along it, tau_a the radius of the minimum circumscribed circle of the shear stress path in it; S the stress deviator,
  R the radius of the minimum circumscribed sphere of its path in the norm sqrt(S:S), P_H the hydrostatic stress.
    SamFatigueCrossland    R/sqrt(2) + alpha max P_H, Pa (Crossland 1956)
    SamFatigueDangVan      max of tau + alpha P_H, tau the largest shear of S minus the centre of the sphere, Pa
    SamFatigueFindley      largest over n of tau_a + k max s_n, Pa (Findley 1959)
    SamFatigueSWT          largest over n of max s_n times half the range of e_n, Pa; 0 where s_n is never tensile
    SamFatigueFatemiSocie  largest over n of tau_a/G (1 + k max s_n/yield), 1 (Fatemi and Socie 1988)
    SamFatigueRuiz         D1, J/m2: a quarter of the closed integral of |q . ds|, q the shear on the surface, which for
                           a reciprocating cycle is the shear times the slip amplitude; NaN below the surface
  Planes are searched in steps of 10 degrees, then around the best plane, to the last digits. `more` becomes the
  normal of the critical plane, with z >= 0; it is NaN if no plane is under tension (SWT). For Ruiz's parameter `more`
  becomes D2 (Pa J/m2): D1 times the maximum tension in the direction of the maximum change of slip. Not collective.
  Sources: Smith, Watson and Topper 1970, J. Mater. 5, 767; Fatemi and Socie 1988, Fatigue Fract. Eng. Mater. Struct.
  11, 149; Papadopoulos 1997, Int. J. Fatigue 19, 219 (measures of the shear stress path); Ruiz, Boddington and Chen
  1984, Exp. Mech. 24, 208.
*/
typedef double      SamFatigueParameter(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueCrossland(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueDangVan(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueFindley(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueSWT(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueFatemiSocie(const SamFatigueCycle *cycle, double more[]);
PETSC_INTERN double SamFatigueRuiz(const SamFatigueCycle *cycle, double more[]);

/*
  SamFatigueSlopes - returns a parameter that is the largest over planes (Findley, SWT, Fatemi and Socie), and computes
  its derivatives by the stresses: slope[c * states + k] (its unit over Pa), that by a shear stress counting both of its
  places. To first order the plane, the states of the extremes and those on the circle stay. They are 0 where no plane
  is under tension (SWT). `slope` may be the array of the stresses. Not collective.
*/
PETSC_INTERN double SamFatigueSlopes(SamFatigueParameter *parameter, const SamFatigueCycle *cycle, double slope[]);

/*
  SamSmallestBall - returns the radius of the smallest ball around n > 0 points (points[i * dimension + d]) of a
  dimension of at most 5, and computes its centre. Not collective. Source: Gaertner 1999, Fast and robust smallest
  enclosing balls (ESA).
*/
#define SAM_BALL_DIMENSION 5
PETSC_INTERN double SamSmallestBall(PetscInt dimension, PetscInt n, const double points[], double center[]);

#endif
