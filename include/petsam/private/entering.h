/* The motion of the surfaces before cells come into contact in a step: see src/contact/step/direction.c, Beginning. */
#ifndef PETSAM_PRIVATE_ENTERING_H
#define PETSAM_PRIVATE_ENTERING_H

#include <petsam/private/solutionimpl.h>

/*
  SamApproach - the bodies' motion in a step in which contact grows: the approach about the previous centre of pressure
  (m), the tilt, the strain of the surfaces, the ratios of the changes of the tangential loads to that of N, and kappa,
  those of the tangential to the normal compliance. From no contact everything grows by N: the approach is 1.
*/
typedef struct {
  double    center[2], uniform, tilt[2], ratio[2], kappa[2];
  SamStrain strain;
} SamApproach;

/*
  SamApproachGrows - returns true if contact grows with N and the other loads, and the shear determines the motion where
  contact is made; `before`: the solution before the step, NULL: none. Not collective.
  SamApproachFind - finds the motion; `tangential`: T_x and T_y of the step (N). Collective.
  SamApproachShear - computes tau, the ratio of the changes of shear and pressure of a sticking punch, at the contact
  edge at (x, y), m. Not collective.
  SamApproachGaps - computes the gap before the step in cells that were open, 0 in others (m); in a step from no
  contact the distance of the undeformed bodies, 0 where it is least in the contact. `separation`: of the bodies in
  their state before the step. Collective.
*/
PETSC_INTERN PetscBool      SamApproachGrows(const SamSolution *before, const SamSolution *now);
PETSC_INTERN PetscErrorCode SamApproachFind(SamProblem problem, SamState state, const SamSolution *before,
                                            const SamSolution *now, const PetscReal tangential[2], SamApproach *a);
PETSC_INTERN void           SamApproachShear(const SamApproach *a, double x, double y, double tau[2]);
PETSC_INTERN PetscErrorCode SamApproachGaps(SamProblem problem, const SamSolution *before, const SamSolution *now,
                                            Vec separation, Vec gap);

/*
  SamEntering - a step in which contact grows, on the way back: its cells on a part of the grid. `motion`: cotangents of
  the motion of cells before they touch, two components, 1/m times the unit of the number.
  SamEntered - cotangents of what that depends on: of the gap and the friction of each cell, of the loads and
  displacements before the step and after it, of the growth of the strain xx, yy, xy, of kappa, and of the composite
  modulus in plane strain, times minus that.
  SamEnteringGoBack - computes them; the arrays exist. Collective.
*/
enum { SAM_ENTERED_BEFORE, SAM_ENTERED_NOW };
typedef struct {
  const SamApproach *approach;
  PetscBool          fresh, plane; /* from no contact; in plane strain */
  double             constant;     /* approach by N in plane strain, m2/N */
  PetscReal          normal[2];    /* N before the step and after it */
  SamGrid            grid;
  const double
    *gaps; /* of cells that come into contact, before the step, m; -1: the bodies touch first there; else 0 */
  const double *friction, *motion;
} SamEntering;
typedef struct {
  double *by_gap, *by_friction;
  double  load[2][SAM_COMPONENTS], rigid[2][SAM_COMPONENTS], strain[3], kappa[2], uniform, by_modulus;
} SamEntered;
PETSC_INTERN PetscErrorCode SamEnteringGoBack(const SamEntering *in, SamEntered *found);

#endif
