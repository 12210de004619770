/* All laws of a problem together, for solver, check and results. */
#ifndef PETSAM_PROBLEMIMPL_H
#define PETSAM_PROBLEMIMPL_H

#include <petsam/private/lawimpl.h>
#include <petsam/problem.h>

/* SamProblemDeclare - the laws declare what they remember, unless the state has it already. Collective. */
PETSC_INTERN PetscErrorCode SamProblemDeclare(SamProblem problem, SamState state);
/*
  SamProblemCheckControl - lets the laws refuse values of their conditions, and set those that follow from others:
  `wrong` is the first refused one, and `why` says what is wrong with its value; empty: nothing.
  SamProblemBegin - the laws make the tried state that their offsets in a step follow from (lawimpl.h). Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemCheckControl(SamProblem problem, SamControl *control, const SamCondition **wrong,
                                                   char why[], size_t size);
PETSC_INTERN PetscErrorCode SamProblemBegin(SamProblem problem, SamState state, const SamControl *control,
                                            PetscReal duration);
/*
  What displaces the surfaces in a step besides the tractions, body 2 relative to body 1.
  SamProblemHasOffset - whether a law has such displacements as fields. Not collective.
  SamProblemAddOffset - adds them to u_z (m, one component) and u_t (m, two components), where they are not NULL. `adds`
  (NULL: not wanted): whether they are not zero. Collective.
  SamProblemGetStrain - the strain of the surfaces, whose displacements are no part of u_t. Not collective.
  SamProblemAddStress - adds the stresses in body 0 or 1 at a depth (m), where they are uniform along the surface: Pa,
  by SamStressComponent. Not collective.
*/
PETSC_INTERN PetscBool      SamProblemHasOffset(SamProblem problem);
PETSC_INTERN PetscErrorCode SamProblemAddOffset(SamProblem problem, SamState state, const SamControl *control, Vec u_z,
                                                Vec u_t, PetscBool *adds);
PETSC_INTERN PetscErrorCode SamProblemGetStrain(SamProblem problem, const SamControl *control, SamStrain *strain);
PETSC_INTERN PetscErrorCode SamProblemAddStress(SamProblem problem, const SamControl *control, PetscInt body,
                                                PetscReal depth, double stress[]);
/*
  SamProblemAddSeparation - adds to a separation (m, one component) what the laws have put between the bodies, for the
  next step or in the last solution of a state (lawimpl.h; NULL: nothing). h NULL: only `adds`, whether there is any,
  which may be NULL. Collective.
*/
PETSC_INTERN PetscErrorCode SamProblemAddSeparation(SamProblem problem, SamState state, SamGeneration generation, Vec h,
                                                    PetscBool *adds);
/*
  SamProblemGetOffset - the offset (m) of body 0 or 1, as SamFramesGetOffset(), if laws add what they keep at its
  points; FALSE and 0: the separation does not depend on it. Not collective.
*/
PETSC_INTERN PetscBool SamProblemGetOffset(SamProblem problem, SamState state, SamGeneration generation, PetscInt body,
                                           PetscReal offset[2]);
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
