/* The errors of the numbers of a run, by companion runs. */
#ifndef PETSAM_RUNERRORS_H
#define PETSAM_RUNERRORS_H

#include "../steps/simulationimpl.h"

/*
  The errors of all numbers (errors.c). Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
    ReadOptions  reads -errors
    Create       creates the companion runs, and declares the numbers NAME_error, if they are requested
    Prepare      lets them take over the history, or the life
    Share        returns the time that companion runs take, relative to that of the run: by cells and steps; 0: there
                 can be none, or errors are not wanted
    Describe     returns the companion runs in words, NULL without; borrowed
    Read         reads a checkpoint (SamCheckpointRead()) with the companions' states, if it has these
    Record       after the try of step k of the history: lets the companions follow, and sets the errors of its numbers
    Add          after the last step, with these loads: runs the companions of a life, and adds the errors of the last
                 numbers; after SamAdviceEnd()
    RecordGradient  begins or ends the record of the companions' steps for gradients, as the simulation does
    AddGradient  after SamErrorsAdd(): sets the errors of the shares of a gradient, which the simulation has computed,
                 by those of the companions, and adds them to those of the numbers
    End          stores and reports the errors, and warns of large ones
*/
PETSC_INTERN PetscErrorCode SamErrorsReadOptions(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamErrorsCreate(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamErrorsPrepare(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamErrorsRead(SamSimulation simulation, const char filename[], PetscBool sums,
                                          const SamParameters *parameters, PetscInt n, const SamNote notes[]);
PETSC_INTERN PetscErrorCode SamErrorsRecord(SamSimulation simulation, PetscInt k, const SamStep *step);
PETSC_INTERN PetscErrorCode SamErrorsAdd(SamSimulation simulation, const SamControl *last);
PETSC_INTERN PetscErrorCode SamErrorsRecordGradient(SamSimulation simulation, PetscBool on);
PETSC_INTERN PetscErrorCode SamErrorsAddGradient(SamSimulation simulation, const SamGradientGoal *goal, PetscInt count,
                                                 SamGradientShare shares[]);
PETSC_INTERN PetscErrorCode SamErrorsEnd(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamErrorsDestroy(SamErrors *errors);
PETSC_INTERN double         SamErrorsShare(SamSimulation simulation);
PETSC_INTERN const char    *SamErrorsDescribe(SamErrors errors);
/*
  The same for steps that are given one by one (errorssingle.c); without companion runs they do nothing. Collective.
    Try       after the try of a step: lets the companions try it, and sets the errors of its numbers
    Commit    before its commit: commits the companions, too
    Advise    adds the large errors of the tried step to the advice on it
    Lose      their states are no longer those of the same steps, for this reason: errors are unknown from here on
    Reset     the bodies have never touched, and errors are known again
    Copy      takes over the states of the companions of another simulation on the same grid
    SetField  lets `set` give the companions' problems the means of a field over their cells
*/
PETSC_INTERN PetscErrorCode SamErrorsTry(SamSimulation simulation, const SamStep *step);
PETSC_INTERN PetscErrorCode SamErrorsCommit(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamErrorsAdvise(SamSimulation simulation, const SamStep *step, SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamErrorsLose(SamSimulation simulation, const char why[]);
PETSC_INTERN PetscErrorCode SamErrorsReset(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamErrorsCopy(SamSimulation simulation, SamSimulation from);
PETSC_INTERN PetscErrorCode SamErrorsSetField(SamSimulation simulation, PetscErrorCode (*set)(const SamSetup *, Vec),
                                              Vec           field);
/*
  SamErrorsLoad - does the same for steps that are given one by one; without the companions' states their errors are
  unknown from here on (errorskept.c). Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamErrorsLoad(SamSimulation simulation, const char filename[],
                                          const SamParameters *parameters);

#endif
