/* The same step one cycle before, as the start of a step (recall.c). */
#ifndef PETSAM_RECALL_H
#define PETSAM_RECALL_H

#include <petsam/private/solutionimpl.h>
#include <petsam/private/solverimpl.h>

/* SamRecall - the last steps of a contact, by what they prescribe. SamKept - what is kept of a step; borrowed. */
typedef struct _n_SamRecall *SamRecall;
typedef struct _n_SamKept   *SamKept;

/*
  SamRecallCreate, SamRecallDestroy - nothing is kept until there is memory for it. The grid and the conditions are
  borrowed.
*/
PETSC_INTERN PetscErrorCode SamRecallCreate(SamGrid grid, SamConditions conditions, SamRecall *recall);
PETSC_INTERN void           SamRecallDestroy(SamRecall *recall);
/* SamRecallSetMemory - the bytes on all ranks that kept steps may take; 0: none are kept. Not collective. */
PETSC_INTERN PetscErrorCode SamRecallSetMemory(SamRecall recall, PetscReal bytes);
/* SamRecallForget - forgets all steps. Not collective. */
PETSC_INTERN void SamRecallForget(SamRecall recall);
/*
  SamRecallFind - the last step that prescribed the same as the next one, or its reverse, after the same or its reverse;
  NULL: none, or nothing is kept of it. Not collective.
  SamRecallKeep - takes note of a step that is committed, and keeps it if the last search found its like. `before`: the
  committed solution so far, NULL in the first step; `revision`: of the problem. Collective.
*/
PETSC_INTERN void           SamRecallFind(SamRecall recall, const SamControl *next, SamKept *kept);
PETSC_INTERN PetscErrorCode SamRecallKeep(SamRecall recall, const SamSolution *before, const SamSolution *now,
                                          PetscObjectState revision);
/*
  SamKeptHasPressure - whether it has the pressure for this control and a gap of this revision. Not collective.
  SamKeptGetPressure - that pressure (Pa), with its normal loads and rigid displacements. Not collective.
  SamKeptGetShear - a start of the shear (Pa), zero outside of the bound, and its product with the operator (m), for a
  step after the solution `now`. `found`: the contact is where it was. Collective.
  SamKeptGetMotion - the tangential rigid displacements, among all six, that belong to this shear. Not collective.
*/
PETSC_INTERN PetscBool      SamKeptHasPressure(SamKept kept, const SamControl *control, PetscObjectState revision);
PETSC_INTERN PetscErrorCode SamKeptGetPressure(SamKept kept, SamGrid grid, SamSolution *solution);
PETSC_INTERN PetscErrorCode SamKeptGetShear(SamKept kept, SamElasticity elasticity, const SamSolution *now, Vec bound,
                                            Vec shear, SamProduct *product, PetscBool *found);
PETSC_INTERN void           SamKeptGetMotion(SamKept kept, const SamSolution *now, PetscReal rigid[]);

#endif
