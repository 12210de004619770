/* All laws of a problem together, for solver, check and results. */
#ifndef PETSAM_PROBLEMIMPL_H
#define PETSAM_PROBLEMIMPL_H

#include <petsam/private/lawimpl.h>
#include <petsam/problem.h>

/*
  SamProblemAddCases - adds the relative displacements (m) by load cases of the bodies in a step to a field: normal
  ones, one component, or tangential ones, two. Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemAddCases(SamProblem problem, const SamControl *control, PetscBool tangential,
                                               Vec field);
/* SamProblemDeclare - the laws declare what they remember, unless the state has it already. Collective. */
PETSC_INTERN PetscErrorCode SamProblemDeclare(SamProblem problem, SamState state);
/*
  SamProblemAddSeparation - adds to a separation (m, one component) what the laws have put between the bodies, for the
  next step or in the last solution of a state (lawimpl.h; NULL: nothing). h NULL: only `adds`, whether there is any,
  which may be NULL. Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemAddSeparation(SamProblem problem, SamState state, SamGeneration generation, Vec h,
                                                    PetscBool *adds);
/*
  SamProblemComputeBound - the largest shear that each cell bears, and its derivatives, by all laws. The pressure may be
  the same vector as the bound's value. Collective.
  SamProblemFollowsSlip - whether the bound depends on the slip of the step. Not collective.
*/
PETSC_INTERN PetscErrorCode SamProblemComputeBound(SamProblem problem, const SamBoundAt *at, const SamBound *bound);
PETSC_INTERN PetscBool      SamProblemFollowsSlip(SamProblem problem);
/*
  SamProblemAddOverlap - adds by how much the bodies overlap in the tried step where they bear no more (m). Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemAddOverlap(SamProblem problem, SamState state, Vec overlap);
/* SamProblemAdvance - all laws advance their tried state. Collective. */
PETSC_INTERN PetscErrorCode SamProblemAdvance(SamProblem problem, SamLawStep *step);

#endif
