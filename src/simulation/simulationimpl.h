/* What the files of a simulation share. */
#ifndef PETSAM_SIMULATIONIMPL_H
#define PETSAM_SIMULATIONIMPL_H

#include <petsam.h>
#include <petsam/private/baseimpl.h>
#include "checkpoints.h"
#include "plan.h"

struct _n_SamSimulation {
  MPI_Comm               comm;
  SamSimulationMonitor   monitor; /* NULL: none */
  void                  *context;
  volatile sig_atomic_t *signals; /* NULL: none */
  SamSetup               setup;
  SamPlan                plan;
  SamLife                life; /* NULL: none */
  SamHistory             history;
  SamOutput              output;
  SamOutputSettings      output_settings;
  SamCheckpoints         checkpoints;
  SamParameters          parameters;
  SamSimulationNeeds     needs;
  SamSimulationStart     start;
  SamSimulationPoint     point; /* position in the load program; steps before a restart count too */
  PetscBool              prepared;
  PetscBool              stopped; /* before its end, with a checkpoint */
  PetscInt               output_every;
  PetscBool              has_output;
  PetscBool              restart_gap; /* goes on with another gap than the stopped simulation's */
  PetscBool              told;        /* in a life: the step that failed is in the file */
  PetscBool              warned;      /* a warning has been printed in this life */
  PetscReal              last_time;   /* of the last step that was written, s; -infinity: none */
  PetscBool              writing;     /* a collective write is under way */
  char                   filename[PETSC_MAX_PATH_LEN];
  SamLoadsMost           most;              /* the largest loads of the steps from here on */
  PetscInt               largest;           /* step of the largest normal load or approach among them, from 0 */
  PetscBool              examined;          /* whether the size of the contact was looked at */
  PetscBool              advised[SAM_LAWS]; /* laws that have warned of a step */
};

/*
  SamSimulationTell - tells the monitor. SamSimulationWarn - a SamAdviceFunction that does so; `simulation`: a
  SamSimulation. Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationTell(SamSimulation simulation, const SamSimulationNews *news);
PETSC_INTERN PetscErrorCode SamSimulationWarn(void *simulation, const char text[], const char setting[]);
/*
  SamSimulationOpenResults - opens the results. After a restart (`checkpoint` NULL: none) it goes on with a file that is
  there; a new name begins a file with the steps from there on. Collective. Errors: SAM_ERR_FILE, SAM_ERR_USER.
  SamSimulationForecast - how large the results will be, in words; warns where the disk has not that much space.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationOpenResults(SamSimulation simulation, const char checkpoint[]);
PETSC_INTERN PetscErrorCode SamSimulationForecast(SamSimulation simulation, char text[], size_t size);
/* SamSimulationCreateLife - makes the life, if cycles are asked for, once there is a contact. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationCreateLife(SamSimulation simulation);
/* SamSimulationLive - the cycles of a life, with their results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationLive(SamSimulation simulation);
/*
  SamSimulationWriteLastFields - makes sure that the fields of the step that was solved last are in the file, at the
  time of the last step that was written; for when the next one has no solution. Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationWriteLastFields(SamSimulation simulation);
/* SamSimulationWriteStep - writes a step's numbers and, when they are due, its fields. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationWriteStep(SamSimulation simulation, const SamStep *step, PetscBool due);
/* SamSimulationCheckpoint - after a step or jump: writes a checkpoint if one is due; may stop. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationCheckpoint(SamSimulation simulation);
/*
  What a user should know besides (advice.c). PrepareAdvice - before the first step: finds the largest loads of the
  steps from `first` on, and warns of options that are unlikely to be meant. AdviseEdge - appends to the message of a
  step at the grid's edge a grid that is large enough. Examine - after step k: if it has the largest load, warns of too
  few cells, of a contact too large for half-spaces, of none, and of motions that are not small, once. ExamineLaws -
  after step k, which has a solution: what the laws have to say, each once. Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationPrepareAdvice(SamSimulation simulation, PetscInt first);
PETSC_INTERN PetscErrorCode SamSimulationAdviseEdge(SamSimulation simulation, SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationExamine(SamSimulation simulation, PetscInt k, const SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationExamineLaws(SamSimulation simulation, PetscInt k);
/* SamSimulationCollectParameters - fills `parameters`, for results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationCollectParameters(SamSimulation simulation);

#endif
