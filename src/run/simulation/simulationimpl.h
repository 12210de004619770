/* Declarations shared by the files of a simulation. */
#ifndef PETSAM_SIMULATIONIMPL_H
#define PETSAM_SIMULATIONIMPL_H

#include <petsam.h>
#include <petsam/private/output.h>
#include <petsam/private/simulation.h>
#include <petsam/private/motionimpl.h>
#include "plan.h"

/* The position of a simulation in its load history. */
typedef struct {
  PetscInt  steps;                       /* number of steps solved so far, of computed cycles in a life */
  PetscInt  rows;                        /* number of computed cycles that were written */
  PetscInt  part;                        /* number of the part of the results, from 1; 0: none yet */
  uint64_t  identity;                    /* identity of that part's file */
  SamStatus worst;                       /* worst status of the steps */
  char      results[PETSC_MAX_PATH_LEN]; /* the file, with the given name; empty: none */
  PetscBool restarted;                   /* true if the run continues from a checkpoint */
} SamSimulationPoint;

/* Checkpoints are written every so many steps, when a signal requests one, and before a time limit. */
#define SAM_RECENT 5
typedef struct {
  /* what the user set */
  char      filename[PETSC_MAX_PATH_LEN], restart[PETSC_MAX_PATH_LEN]; /* empty: none */
  PetscBool overwrite;    /* a new run may replace the checkpoint of an earlier one */
  PetscInt  every;        /* load steps, 0: never */
  char      duration[64]; /* of the run, in the given form; empty: unlimited */
  double    limit;        /* the same in seconds, 0: none */
  /* status */
  SamCheckpoint files;              /* NULL: none */
  double        start, step_start;  /* MPI_Wtime() at the start of the run, and of this step */
  double        recent[SAM_RECENT]; /* seconds of the last steps */
  double        writing;            /* seconds that the slowest checkpoint took */
  PetscInt      done, last;         /* number of steps in this run; step of the last checkpoint */
  PetscInt      seen;               /* number of steps when a checkpoint was last considered */
} SamCheckpoints;

typedef struct _n_SamErrors *SamErrors;

/* The gradients that a run writes */
#define SAM_GRADIENT_NAMES 512
typedef struct {
  char      names[SAM_GRADIENT_NAMES]; /* of the numbers, separated by commas; empty: none */
  PetscInt  steps[2];                  /* first and last step, from 1; 0: the usual ones */
  char      of[SAM_GRADIENT_NAMES];    /* of the parameters, likewise; empty: the usual ones */
  PetscReal rtol, memory;              /* bytes for recorded steps; 0: any */
} SamGradientPlan;

#define SAM_WARNINGS 16 /* most warnings in the results */

struct _n_SamSimulation {
  MPI_Comm               comm;
  SamSimulationMonitor   monitor; /* NULL: none */
  void                  *context;
  volatile sig_atomic_t *signals; /* NULL: none */
  SamSetup               setup;
  SamConditions          conditions; /* of the problem; borrowed */
  SamLifeOptions         plan;
  SamLife                life; /* NULL: none */
  SamHistory             history;
  SamOutput              output;
  SamOutputSettings      output_settings;
  SamCheckpoints         checkpoints;
  SamParameters          parameters;
  SamSimulationNeeds     needs;
  SamSimulationStart     start;
  SamSimulationPoint     point;     /* position in the load history; steps before a restart count, too */
  PetscReal              step_rtol; /* estimated relative error allowed for a step's dissipated energy; 0: any */
  PetscBool              prepared;
  PetscBool              running; /* runs the history or the life; otherwise steps are given one by one */
  PetscBool              has_gap; /* the gap differs from that of the options */
  PetscBool              stopped; /* ended early, with a checkpoint */
  PetscInt               output_every;
  PetscBool              output_rows; /* true: results count the rows of the load history */
  PetscBool              has_output;
  PetscBool              told;      /* in a life: the failed step is in the file */
  PetscBool              warned;    /* a warning has been printed in this life */
  PetscBool              flows;     /* a warning of plastic strain that has not shaken down has been given */
  PetscBool              stripes;   /* a warning of steps that slide too far has been given */
  PetscBool              fast;      /* a warning of wear so fast that the unit is questioned has been given */
  PetscBool              worn[2];   /* it has been reported that the first material of a body is worn through */
  PetscReal              last_time; /* time of the last written step, s; -infinity: none */
  PetscBool              writing;   /* a collective write is under way */
  char                   filename[PETSC_MAX_PATH_LEN];
  char                  *written; /* name of the part of the results that is being written; NULL: none */
  PetscBool              untold;  /* -errors none: large errors are not told */
  SamAdvice              advice;
  SamAdvice              single, tried; /* advice on steps given one by one: committed; with the tried one */
  PetscInt               earlier;       /* 1: the state before these steps already has a step */
  PetscBool              advised;       /* advice on the tried step has been computed */
  SamErrors              errors;        /* NULL: they are not computed */
  SamGradient            gradient;      /* which records the committed steps; NULL: none does */
  SamGradientPlan        gradients;
  PetscInt               warnings; /* number of the warnings so far that the results will have */
  char                   warning[SAM_WARNINGS][SAM_WARNING_TEXT];
};

/*
  SamSimulationNotify - calls the monitor. SamSimulationWarn - a SamAdviceFunction that calls it; `simulation`: a
  SamSimulation. Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationNotify(SamSimulation simulation, const SamSimulationEvent *news);
PETSC_INTERN PetscErrorCode SamSimulationWarn(void *simulation, const char text[], const char setting[]);
/*
  SamSimulationOpenResults - opens the results. After a restart they are the next part of the existing results; a new
  name begins a file with the steps from there on. Collective. Errors: SAM_ERR_FILE, SAM_ERR_USER.
  SamSimulationSaves - returns true if the fields of a step, from 1 to last, are saved. Not collective.
  SamSimulationForecast - writes the expected size of the results as text; warns if the disk has less space.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationOpenResults(SamSimulation simulation);
PETSC_INTERN PetscBool      SamSimulationSaves(SamSimulation simulation, PetscInt step, PetscInt last);
PETSC_INTERN PetscErrorCode SamSimulationForecast(SamSimulation simulation, char text[], size_t size);
/*
  SamSimulationReadGradients - reads the options of gradients, SamSimulationReadGradientMemory - those of a contact that
  records steps at the call of another program. SamSimulationBeginGradients - begins to record the steps,
  if there are any. SamSimulationEndGradients - computes them after the last step, writes and tells them (gradients.c).
  SamSimulationBeginCycles - begins the record of a wear simulation, if steps are recorded and it is one. Collective.
  Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamSimulationBeginCycles(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationReadGradientMemory(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationReadGradients(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationBeginGradients(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationEndGradients(SamSimulation simulation);
/* SamSimulationCreateLife - creates the life, if cycles are requested, once there is a contact. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationCreateLife(SamSimulation simulation);
/*
  SamSimulationLive - runs the cycles of a life, and writes their results and checkpoints. Collective.
  SamSimulationCycleControl - gets the control of a step of the cycle: a function of SamLifeCycle whose context is the
  simulation (step.c). Not collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationLive(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationCycleControl(void *simulation, PetscInt step, PetscReal cycles,
                                                      SamControl *control);
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
/*
  Load steps in pieces (pieces.c). Collective. Errors: SAM_ERR_USER.
    ReadPieces     reads -step_rtol
    DeclarePieces  declares their numbers in the state
    Try            tries step k of the history, in pieces if requested, and commits all but the last
*/
PETSC_INTERN PetscErrorCode SamSimulationReadPieces(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationDeclarePieces(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationTry(SamSimulation simulation, PetscInt k, SamStep *step);
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
/*
  SamSimulationAdviseEdge - adds to the message of a step at the grid's edge a grid that is large enough for all steps
  of the run, or, if steps are given one by one, for this step (step.c).
  SamSimulationExamine - gives the advice after step k (advice.h). Collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationAdviseEdge(SamSimulation simulation, const SamControl *control, SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationExamine(SamSimulation simulation, PetscInt k, PetscBool of_laws,
                                                 const SamStep *step);
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
    End          after the last step, with these loads: runs the companions of a life, stores and reports the errors of
                 the last numbers, and warns of large ones; after SamAdviceEnd()
*/
PETSC_INTERN PetscErrorCode SamErrorsReadOptions(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamErrorsCreate(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamErrorsPrepare(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamErrorsRead(SamSimulation simulation, const char filename[], PetscBool sums,
                                          const SamParameters *parameters, PetscInt n, const SamNote notes[]);
PETSC_INTERN PetscErrorCode SamErrorsRecord(SamSimulation simulation, PetscInt k, const SamStep *step);
PETSC_INTERN PetscErrorCode SamErrorsEnd(SamSimulation simulation, const SamControl *last);
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
PETSC_INTERN PetscErrorCode SamErrorsSetField(SamSimulation simulation, PetscErrorCode (*set)(SamProblem, Vec),
                                              Vec           field);
/* SamSimulationCollectParameters - collects the parameters for results and checkpoints. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationCollectParameters(SamSimulation simulation);

/*
  SamSimulationEstimateShares - estimates from the largest normal load, by a closed-form solution, the share of this
  rank's cells that will be in contact, and that of the grid's cells that the operator's part will have, 0: no part.
  Not collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationEstimateShares(SamSimulation simulation, SamSimulationNeeds *needs);

#endif
