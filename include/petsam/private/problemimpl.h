/* All laws of a problem together, for solver, check and results. */
#ifndef PETSAM_PROBLEMIMPL_H
#define PETSAM_PROBLEMIMPL_H

#include <petsam/private/lawimpl.h>
#include <petsam/problem.h>

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
  What laws correct of a solution; each does nothing where no law does. Collective.
  SamProblemCorrect - lets the laws correct a pressure that solves the normal problem.
  SamProblemAddDisplacement - adds to u_z (m) what the pressure does beyond the influence of its means over cells.
  SamProblemGetLeast - the least pressure of each cell (Pa, one component), which it bears without touching at its
  centre; borrowed, NULL: none.
  SamProblemFindEdge - the contact edge, if a law has it.
  SamProblemAddEnergy - adds to the elastic energy (J).
*/
PETSC_INTERN PetscErrorCode SamProblemCorrect(SamProblem problem, SamCorrection *correction);
PETSC_INTERN PetscErrorCode SamProblemAddDisplacement(SamProblem problem, SamState state, Vec u_z);
PETSC_INTERN PetscErrorCode SamProblemGetLeast(SamProblem problem, SamState state, Vec *least);
PETSC_INTERN PetscErrorCode SamProblemFindEdge(SamProblem problem, SamState state, Vec pressure, Vec point,
                                               SamEdge *edge, PetscBool *found);
PETSC_INTERN PetscErrorCode SamProblemAddEnergy(SamProblem problem, SamState state, Vec pressure, Vec u_z,
                                                PetscReal *energy);
/*
  SamProblemAddOverlap - adds by how much the bodies overlap in the tried step where they bear no more (m). Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemAddOverlap(SamProblem problem, SamState state, Vec overlap);
/* SamProblemAdvance - all laws advance their tried state. Collective. */
PETSC_INTERN PetscErrorCode SamProblemAdvance(SamProblem problem, SamLawStep *step);

#endif
