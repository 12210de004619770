/* All laws of a problem together, for solver, check and results. */
#ifndef PETSAM_PROBLEMIMPL_H
#define PETSAM_PROBLEMIMPL_H

#include <petsam/private/lawimpl.h>
#include <petsam/problem.h>

/* SamProblemDeclare - lets the laws declare their fields and numbers, unless the state has them already. Collective. */
PETSC_INTERN PetscErrorCode SamProblemDeclare(SamProblem problem, SamState state);
/*
  SamProblemCheckControl - lets the laws reject prescribed values, and set conditions that depend on others: `wrong`
  is the part of the control (control.h) that is rejected first, and `why` the fault of its value; empty: none. Not
  collective.
  SamProblemBegin - lets the laws set the tried state on which their offsets in a step depend (lawimpl.h). Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemCheckControl(SamProblem problem, SamControl *control, PetscInt *wrong, char why[],
                                                   size_t size);
PETSC_INTERN PetscErrorCode SamProblemBegin(SamProblem problem, SamState state, const SamControl *control,
                                            PetscReal duration);
/*
  SamProblemAttracts - returns true if the surfaces attract each other. Not collective.
  SamProblemAttract - computes the tension (Pa) by which they do at this gap (m), by all laws; both have one component.
  Collective.
*/
PETSC_INTERN PetscBool      SamProblemAttracts(SamProblem problem);
PETSC_INTERN PetscErrorCode SamProblemAttract(SamProblem problem, Vec gap, Vec tension);
/*
  Questions about the laws of a problem. None is collective.
  SamProblemSlides - returns true if the surfaces move past each other.
  SamProblemRemembers - returns true if bodies move by what they remember of earlier steps, besides their elasticity.
  SamProblemWears - returns true if material is removed. SamProblemWornVolume - returns the volume (m3) that the last
  solution has removed of both bodies, 0 if none is removed.
  SamProblemYields - returns true if a body may yield. SamProblemBodyYields - the same of body 0 or 1.
*/
PETSC_EXTERN PetscBool SamProblemSlides(SamProblem problem);
PETSC_INTERN PetscBool SamProblemRemembers(SamProblem problem);
PETSC_INTERN PetscBool SamProblemWears(SamProblem problem);
PETSC_INTERN PetscReal SamProblemWornVolume(SamState state);
PETSC_INTERN PetscBool SamProblemYields(SamProblem problem);
PETSC_INTERN PetscBool SamProblemBodyYields(SamProblem problem, PetscInt body);
/*
  SamProblemGetFlow - gets the smallest stress (Pa) at which a body flows after a strain; infinite if none does.
  SamProblemHasYielded - finds out if a body has yielded in the step of a state. Not collective.
*/
PETSC_INTERN PetscErrorCode SamProblemGetFlow(SamProblem problem, PetscReal strain, PetscReal *stress);
PETSC_INTERN PetscBool      SamProblemHasYielded(SamProblem problem, SamState state);
/*
  SamProblemDisplaces - returns true if a law may displace the surfaces by fields. Not collective.
  SamProblemDisplace - adds the displacements of the surfaces in a step by other causes than tractions, body 2 relative
  to body 1, to u_z (m, one component) and u_t (m, two components). `strain`: their linear part, which u_t does not
  contain. `adds`: true if a field is not zero. What is NULL is not wanted. Collective.
*/
PETSC_INTERN PetscBool      SamProblemDisplaces(SamProblem problem);
PETSC_INTERN PetscErrorCode SamProblemDisplace(SamProblem problem, SamState state, const SamControl *control, Vec u_z,
                                               Vec u_t, SamStrain *strain, PetscBool *adds);
/*
  SamProblemAddSeparation - adds the parts of the laws to the separation h (m, one component), for the next step or
  those in the last solution of a state (lawimpl.h; NULL: none). `adds`: true if there are any; may be NULL. h NULL:
  only sets `adds`. Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemAddSeparation(SamProblem problem, SamState state, SamGeneration generation, Vec h,
                                                    PetscBool *adds);
/*
  SamProblemGetOffset - gets the offset (m) of body 0 or 1, as SamFramesGetOffset() does, if laws add a field at its own
  points to the separation. Else the offset is 0, it returns false, and the separation does not depend on it. Not
  collective.
*/
PETSC_INTERN PetscBool SamProblemGetOffset(SamProblem problem, SamState state, SamGeneration generation, PetscInt body,
                                           PetscReal offset[2]);
/*
  SamProblemComputeBound - computes the largest shear that each cell bears, and its derivatives, by all laws. The
  pressure may be the same vector as the bound's value. Collective.
  SamProblemFollowsSlip - returns true if the bound depends on the slip of the step. Not collective.
*/
PETSC_INTERN PetscErrorCode SamProblemComputeBound(SamProblem problem, const SamBoundAt *at, const SamBound *bound);
PETSC_INTERN PetscBool      SamProblemFollowsSlip(SamProblem problem);
/* SamProblemAdvance - lets all laws advance their tried state. Collective. */
PETSC_INTERN PetscErrorCode SamProblemAdvance(SamProblem problem, SamLawStep *step);

#endif
