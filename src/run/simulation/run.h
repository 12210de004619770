/* The parts of a run: its results, gradients, lives and checkpoints. */
#ifndef PETSAM_RUN_H
#define PETSAM_RUN_H

#include "../errors/runerrors.h"
#include "../forecast/forecast.h"

/*
  SamSimulationOpenResults - opens the results. After a restart they are the next part of the existing results; a new
  name begins a file with the steps from there on. Collective. Errors: SAM_ERR_FILE, SAM_ERR_USER.
  SamSimulationExpectSteps - counts the steps that the file is expected to have; cycles of a life that are still to be
  computed are not counted. To be called before. Not collective.
  SamSimulationSaves - returns true if the fields of a step, from 1 to last, are saved. Not collective.
  SamSimulationForecast - writes the expected size of the results as text; warns if the disk has less space.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationOpenResults(SamSimulation simulation);
PETSC_INTERN void           SamSimulationExpectSteps(SamSimulation simulation);
PETSC_INTERN PetscBool      SamSimulationSaves(SamSimulation simulation, PetscInt step, PetscInt last);
PETSC_INTERN PetscErrorCode SamSimulationForecast(SamSimulation simulation, char text[], size_t size);
/*
  SamSimulationReadGradients - reads the options of gradients, SamSimulationReadGradientMemory - those of a contact that
  records steps at the call of another program. SamSimulationBeginGradients - begins to record the steps,
  if there are any. SamSimulationEndGradients - computes them after the last step, writes and tells them (gradients.c).
  SamSimulationForgetGradients - frees the names and what has been found by them. Not collective.
  Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamSimulationReadGradientMemory(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationReadGradients(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationForgetGradients(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationBeginGradients(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationEndGradients(SamSimulation simulation);
/*
  SamSimulationCreateLife - creates the life, if cycles are requested, once there is a contact.
  SamSimulationLive - runs the cycles of a life, and writes their results and checkpoints (live.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationCreateLife(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationLive(SamSimulation simulation);
/*
  SamSimulationPlaceLast - if a life has ended in cycles before the first written one, makes its last step a step of the
  file. Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationPlaceLast(SamSimulation simulation);
/*
  SamSimulationWriteLastFields - makes sure that the fields of the last solved step are in the file, at the time of the
  last written step; called if the next step has no solution. Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationWriteLastFields(SamSimulation simulation);
/* SamSimulationWriteStep - writes a step's numbers and, if they are due, its fields. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationWriteStep(SamSimulation simulation, const SamStep *step, PetscBool due);
/*
  Checkpoints (stopresume.c). Collective, but for DescribeCheckpoints. Errors: SAM_ERR_USER, SAM_ERR_FILE.
    ReadCheckpoints      reads the options; -max_walltime counts from here
    DescribeCheckpoints  describes when they are written; empty without -checkpoint
    BeginCheckpoints     before the first step, whose time starts here. Fails early if the file cannot be written; a
                         checkpoint of an earlier run is only replaced after a restart, or with -overwrite
    Restart              gives contact, life and `point` the state in the file of -restart; up to there the load history
                         must be that of the stopped run
    Checkpoint           after a step or jump: writes a checkpoint if one is due; stops at a signal, or when the next
                         step, assumed to be as slow as the slowest of the last ones, and a checkpoint after it would
                         not end in time, but not after the last step
    DescribePlace        writes the number of steps, or cycles, so far, and the total number if `total`
*/
PETSC_INTERN PetscErrorCode SamSimulationReadCheckpoints(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN void           SamSimulationDescribeCheckpoints(SamSimulation simulation, char text[], size_t size);
PETSC_INTERN PetscErrorCode SamSimulationBeginCheckpoints(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationRestart(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationCheckpoint(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationDescribePlace(SamSimulation simulation, PetscBool total, char text[],
                                                       size_t size);
/* SamSimulationExamine - gives the advice after step k (advice.h). Collective. */
PETSC_INTERN PetscErrorCode SamSimulationExamine(SamSimulation simulation, PetscInt k, PetscBool of_laws,
                                                 const SamStep *step);
/* SamSimulationCollectParameters - collects the parameters for results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationCollectParameters(SamSimulation simulation);

#endif
