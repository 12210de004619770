/* A simulation, and its steps. */
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
  char             names[SAM_GRADIENT_NAMES]; /* of the numbers, separated by commas; empty: none */
  PetscInt         steps[2];                  /* first and last step, from 1; 0: the usual ones */
  char             of[SAM_GRADIENT_NAMES];    /* of the parameters, likewise; empty: the usual ones */
  PetscReal        rtol, memory;              /* bytes for recorded steps; 0: any */
  int              count;                     /* of the numbers */
  char           **name;                      /* of each */
  SamGradientGoal *goal;                      /* each, as it has been found */
} SamGradientPlan;

#define SAM_WARNINGS 16 /* most warnings in the results */

struct _n_SamSimulation {
  MPI_Comm               comm;
  SamSimulationMonitor   monitor; /* NULL: none */
  void                  *context;
  volatile sig_atomic_t *signals; /* NULL: none */
  SamSetup               setup;
  SamLifeOptions         plan;
  SamLife                life; /* NULL: none */
  SamHistory             history;
  SamOutput              output;
  SamOutputSettings      output_settings;
  SamCheckpoints         checkpoints;
  SamParameters          parameters;
  SamSimulationNeeds     needs;
  SamSimulationStart     start;
  SamSimulationPoint     point;       /* position in the load history; steps before a restart count, too */
  PetscReal              step_rtol;   /* estimated relative error allowed for a step's dissipated energy; 0: any */
  PetscBool              step_divide; /* steps in which N changes under shear are divided */
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
  Load steps in pieces (pieces.c). Collective. Errors: SAM_ERR_USER.
    ReadPieces     reads -step_rtol and -step_divide
    DeclarePieces  declares their numbers in the state
    Try            tries step k of the history, in pieces if requested, and commits all but the last
*/
PETSC_INTERN PetscErrorCode SamSimulationReadPieces(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationDeclarePieces(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationTry(SamSimulation simulation, PetscInt k, SamStep *step);
/*
  SamSimulationCycleControl - gets the control of a step of the cycle: a function of SamLifeCycle whose context is the
  simulation. Not collective (step.c).
  SamSimulationAdviseEdge - adds to the message of a step at the grid's edge a grid that is large enough for all steps
  of the run, or, if steps are given one by one, for this step. Collective (step.c).
*/
PETSC_INTERN PetscErrorCode SamSimulationCycleControl(void *simulation, PetscInt step, PetscReal cycles,
                                                      SamControl *control);
PETSC_INTERN PetscErrorCode SamSimulationAdviseEdge(SamSimulation simulation, const SamControl *control, SamStep *step);
/*
  The record of what steps are asked for beside their solution, tangents and gradients (recording.c).
    DeclareTangent   declares the numbers of the tangent stiffness, if it is asked for
    RecordTangent    computes it in the tried step, if it is asked for
    CountSteps       returns the number of steps that numbers may be of: those of a history, or of its cycle in a wear
                     simulation. Not collective.
    CreateGradient   begins the record of all steps to come, with this shape of the gap, which is borrowed, and so many
                     bytes (SamGradientSetMemory())
    EndRecord        ends it, and frees it
    ForgetRecord     leaves out the steps so far, which no others continue. Not collective.
    RecordStep       records the tried step, before it is committed, if steps are recorded
    BeginCycles      begins that of a wear simulation, if steps are recorded and it is one
    RecordCycleStep  records a step of a cycle, RecordJump a part of a jump, if steps are recorded: functions of
                     SamLifeCycle whose context is the simulation
  Functions that are not marked are collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamSimulationDeclareTangent(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationRecordTangent(SamSimulation simulation, SamStep *step);
PETSC_INTERN PetscInt       SamSimulationCountSteps(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationCreateGradient(SamSimulation simulation, SamGap shape, PetscReal memory);
PETSC_INTERN PetscErrorCode SamSimulationEndRecord(SamSimulation simulation);
PETSC_INTERN void           SamSimulationForgetRecord(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationRecordStep(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationBeginCycles(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationRecordCycleStep(void *simulation, PetscInt step, SamLifePlace place);
PETSC_INTERN PetscErrorCode SamSimulationRecordJump(void *simulation, const SamLifePart *part);

#endif
