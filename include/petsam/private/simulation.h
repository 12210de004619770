/* A simulation from options: a contact, its load history or wear cycles, its results and checkpoints. */
#ifndef PETSAM_SIMULATION_H
#define PETSAM_SIMULATION_H

#include <petsam/private/advice.h>
#include <petsam/private/checkpoint.h>
#include <petsam/private/gradient.h>
#include <petsam/private/errors.h>
#include <petsam/private/history.h>
#include <petsam/private/life.h>
#include <signal.h>

/*
  SamSimulation - a run that solves the load steps of a history, or with -wear_cycles the cycles of a wear simulation,
  writes results and checkpoints as options request, and may continue from a checkpoint. It prints nothing, but notifies
  a monitor of each event. Order of calls: Create, SetMonitor, SetFromOptions, SetUp, Run, Destroy.
*/
typedef struct _n_SamSimulation *SamSimulation;

/* SamEventKind - the kinds of events that a monitor is notified of, with the valid members of the event. */
typedef enum {
  SAM_NOTIFY_BEGIN,       /* before the first step: `start` */
  SAM_NOTIFY_STEP_BEGINS, /* `step` */
  SAM_NOTIFY_DIVIDED,     /* `step` is divided, as contact is lost or made under shear */
  SAM_NOTIFY_STEP,        /* `step` has been solved, or has failed, and is in the results: `result` */
  SAM_NOTIFY_CYCLE_BEGINS,
  SAM_NOTIFY_CYCLE_STEP, /* a step of a computed cycle, counted by `step` over all computed cycles: `result` */
  SAM_NOTIFY_CYCLE,      /* `cycle` has been computed, and is in the results; `cycles`: their total number */
  SAM_NOTIFY_MESSAGE,    /* the message of `result`; `text` names its subject */
  SAM_NOTIFY_ADVICE,     /* advice: `text`, and the option that mends it, `setting` (without dash; empty: none) */
  SAM_NOTIFY_EXTENT,     /* size of the contact in `step`: `extent` */
  SAM_NOTIFY_SLIP,       /* dissipated energy of all steps: `slip` */
  SAM_NOTIFY_ERRORS,     /* estimated errors of the last numbers: `errors` */
  SAM_NOTIFY_GRADIENT,   /* a number and its derivatives: `text` */
  SAM_NOTIFY_FILE,       /* the file `text` has been written, and contains `setting` */
  SAM_NOTIFY_STOPPED     /* stopped before the end, with a checkpoint: `text` says where and why */
} SamEventKind;

/* SamScalingTime - the predicted time of a step on some ranks, and the part that messages take, s. */
#define SAM_SCALINGS 11 /* 1, 2, 4 ... 1024 ranks */
typedef struct {
  int    ranks, nodes;
  double seconds, messages;
} SamScalingTime;

/* SamSimulationStart - the facts known before the first step: steps, files and restart. */
typedef struct {
  PetscInt    steps;                 /* number of steps of the load history, or of one cycle and its approach */
  PetscBool   cyclic;                /* true: a wear simulation over cycles */
  PetscBool   loads[SAM_COMPONENTS]; /* true for loads that are not prescribed as 0 in all steps */
  const char *results;               /* results file; NULL: none */
  PetscBool   replaced;              /* true: it replaces an older file of that name */
  char        size[128];             /* size of the results, in words */
  const char *companions;            /* the companion runs, in words; NULL: none */
  PetscBool   gradients;             /* true: derivatives are computed */
  double      share;                 /* time that they add, or would, relative to that of the run; 0: there are none */
  double      seconds;               /* rough time of a step, s; 0: not known */
  int         cores;                 /* of a node, for which times on other ranks are predicted; 0: they are not */

  SamScalingTime scaling[SAM_SCALINGS];
  char           when[PETSC_MAX_PATH_LEN + 256]; /* times at which checkpoints are written, in words; empty: never */
  const char    *restart;                        /* checkpoint from which the run continues; NULL: none */
  char           after[64];                      /* position of that checkpoint, in words */
} SamSimulationStart;

/* SamSimulationEvent - an event, with the members that its kind names; all are borrowed. */
typedef struct {
  SamEventKind              kind;
  PetscInt                  step; /* from 0 */
  const SamStep            *result;
  SamState                  cycle; /* its numbers */
  PetscReal                 cycles;
  const SamSimulationStart *start;
  const SamExtent          *extent;
  const SamSlip            *slip;
  const SamErrorTable      *errors;
  const char               *text, *setting;
  PetscBool                 waits; /* the step will be written to the results together with a later one */
} SamSimulationEvent;

/*
  SamSimulationMonitor - a function that is called at each event, on all ranks. Collective. An error ends the
  simulation.
*/
typedef PetscErrorCode (*SamSimulationMonitor)(void *context, SamContact contact, const SamSimulationEvent *news);

/* SamSimulationCreate - creates a simulation without a contact. SamSimulationDestroy - frees it. Collective. */
PETSC_EXTERN PetscErrorCode SamSimulationCreate(MPI_Comm comm, SamSimulation *simulation);
PETSC_EXTERN PetscErrorCode SamSimulationDestroy(SamSimulation *simulation);
/*
  SamSimulationSetMonitor - sets the function that is called at each event; NULL: none.
  SamSimulationSetSignals - sets two flags that, for instance, a signal handler may set to 1 on any rank at any time:
  the first requests a checkpoint after the current step, the second a checkpoint and the end of the run. The simulation
  resets them to 0. Borrowed.
  Neither is collective.
*/
PETSC_EXTERN PetscErrorCode SamSimulationSetMonitor(SamSimulation simulation, SamSimulationMonitor monitor,
                                                    void *context);
PETSC_EXTERN PetscErrorCode SamSimulationSetSignals(SamSimulation simulation, volatile sig_atomic_t signals[2]);
/*
  SamSimulationSetFromOptions - reads all options and the tables that they name; it writes nothing. `arguments`: see
  SamHistoryCreateFromOptions().
  SamSimulationSetUp - creates the contact and all other objects that take memory. While the help is printed, it only
  reads their options.
  SamSimulationRun - continues from the checkpoint, if there is one, solves all steps or cycles, and writes the results
  and checkpoints. It ends early if a step has no solution, does not converge, or reaches the edge of the grid.
  SamSimulationRehearse - does, instead of SamSimulationRun(), only the work before the first step, without writing: it
  reads the checkpoint, forecasts size and time, and notifies the monitor as before the first step.
  Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamSimulationRehearse(SamSimulation simulation);
PETSC_EXTERN PetscErrorCode SamSimulationSetFromOptions(SamSimulation simulation, const SamOptions *from,
                                                        const struct _n_SamArguments *arguments);
PETSC_EXTERN PetscErrorCode SamSimulationSetUp(SamSimulation simulation, const SamOptions *from);
PETSC_EXTERN PetscErrorCode SamSimulationRun(SamSimulation simulation);

/*
  Functions for programs that prescribe the loads themselves:
    SetContactFromOptions  instead of SetFromOptions: reads all options except those of loads and the number of cycles
    SetProgram             takes over a history, which runs once (`cycles` 0), or is one cycle of a wear simulation;
                           SamSimulationRun() then continues from the committed state; may be called again
    SetGap                 replaces the separation of the bodies that the options gave
    SetFriction            replaces the coefficient of friction by one for each cell
    Reset                  the bodies have never touched
    TakeOver               takes over the committed state of another simulation on the same grid, with that of its
                           companion runs
    Save, Load             writes the committed state to a checkpoint, with those of companion runs and a program's n
                           notes; takes over that of a file, which a program like this one has saved
  SamSimulationStop - ends the run after this step; to be called by a monitor. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamSimulationSetContactFromOptions(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationSetProgram(SamSimulation simulation, SamHistory *history, PetscReal cycles);
PETSC_INTERN PetscErrorCode SamSimulationSetGap(SamSimulation simulation, Vec gap);
PETSC_INTERN PetscErrorCode SamSimulationSetFriction(SamSimulation simulation, Vec friction);
PETSC_INTERN PetscErrorCode SamSimulationReset(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationTakeOver(SamSimulation simulation, SamSimulation from);
PETSC_INTERN PetscErrorCode SamSimulationSave(SamSimulation simulation, SamCheckpoint checkpoint,
                                              const SamParameters *parameters, PetscInt n, const SamNote notes[]);
PETSC_INTERN PetscErrorCode SamSimulationLoad(SamSimulation simulation, const char filename[],
                                              const SamParameters *parameters);
PETSC_INTERN PetscErrorCode SamSimulationStop(SamSimulation simulation);

/*
  SamSimulationTryStep - tries a step. Conditions with other than their usual values become numbers of each step; if the
  contact reaches the edge of the grid, the message proposes a larger grid. After an error there is no tried step.
  Errors: those of SamContactTry().
  SamSimulationCommitStep - commits the tried step; SamContactReject() discards it. Errors: PETSC_ERR_ORDER without a
  tried solution, PETSC_ERR_NOT_CONVERGED. SamSimulationNeedTried - raises these errors only. Collective.

  The same for steps that are given one by one, with advice and errors of the numbers (single.c):
  SamSimulationTrySingle - tries a step, also by companion runs.
  SamSimulationCommitSingle - commits it; `warning`: the warning of a law about the step.
  SamSimulationAdviseSingle - gives `receive` the advice on the tried step, as after a history of the committed steps
  and this one. Collective.
  SamSimulationForgetAdvice - forgets the earlier steps in the advice, since the next ones continue from another state.
  Not collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationTryStep(SamSimulation simulation, const SamControl *control, SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationCommitStep(SamSimulation simulation, const SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationNeedTried(SamSimulation simulation, const SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationTrySingle(SamSimulation simulation, const SamControl *control, SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationCommitSingle(SamSimulation simulation, const SamStep *step, char warning[],
                                                      size_t size);
PETSC_INTERN PetscErrorCode SamSimulationAdviseSingle(SamSimulation simulation, const SamStep *step,
                                                      SamAdviceFunction receive, void *context);
PETSC_INTERN void           SamSimulationForgetAdvice(SamSimulation simulation);

/*
  SamSimulationRecordGradient - begins to record the steps that are committed from now on, or ends it; both forget the
  recorded ones. Errors: SAM_ERR_USER for what has no derivative, PETSC_ERR_ORDER if the contact has steps. Collective.
  SamSimulationGetGradient - returns what has recorded the steps, borrowed; NULL: nothing does. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationRecordGradient(SamSimulation simulation, PetscBool on);
PETSC_INTERN SamGradient    SamSimulationGetGradient(SamSimulation simulation);

/* Steps in which cells of dissimilar bodies make contact, which takes memory: none, the first only, or a later one. */
typedef enum { SAM_TOUCHES_NEVER, SAM_TOUCHES_FIRST, SAM_TOUCHES_LATER } SamTouches;
/* SamSimulationNeeds - the properties of a simulation, besides the grid, that determine its memory. */
typedef struct {
  PetscBool  friction, coupled, slides, life, stiffness, companion, gradient;
  PetscInt   gradient_bytes[3]; /* of its numbers, see SamObjective */
  PetscReal  gradient_memory;   /* of its recorded steps on all ranks, bytes; 0: any */
  PetscReal  gradient_jumps;    /* number of jumps of a wear simulation that are recorded for them */
  PetscInt   steps;
  PetscInt   laws;          /* memory of the laws per cell, bytes */
  PetscReal  contact, part; /* SamSimulationEstimateShares(): of this rank's cells, and of the grid's */
  SamTouches touches;
} SamSimulationNeeds;
/* SamSimulationFiles - the files that it reads or writes by its own options; NULL: none. */
typedef struct {
  const char *output, *checkpoint, *restart;
} SamSimulationFiles;
/*
  The following functions may be called after SamSimulationSetFromOptions(). Not collective.
    GetSetup   returns the contact and all its objects; borrowed
    GetSeries  returns the numbers of the computed cycle; borrowed; NULL: no wear simulation
    GetStatus  gets the worst status of the steps so far, and true if the run stopped early, with a checkpoint
    CheckFiles refuses names by which the run would replace a file that it reads, or one file of its own by another;
               called when all options have been read, and no file is open yet; `arguments`: of the command line, or
               NULL. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE
    IsWriting  returns true while a collective write is under way
*/
PETSC_EXTERN const SamSetup    *SamSimulationGetSetup(SamSimulation simulation);
PETSC_EXTERN SamSimulationNeeds SamSimulationGetNeeds(SamSimulation simulation);
PETSC_EXTERN PetscErrorCode     SamSimulationGetFiles(SamSimulation simulation, SamSimulationFiles *files);
PETSC_EXTERN PetscErrorCode SamSimulationCheckFiles(SamSimulation simulation, const struct _n_SamArguments *arguments);
PETSC_INTERN SamState       SamSimulationGetSeries(SamSimulation simulation);
PETSC_EXTERN PetscErrorCode SamSimulationGetStatus(SamSimulation simulation, SamStatus *worst, PetscBool *stopped);
PETSC_EXTERN PetscBool      SamSimulationIsWriting(SamSimulation simulation);
/* SamSimulationAbandon - removes temporary files before this process ends without the others. Not collective. */
PETSC_EXTERN void SamSimulationAbandon(SamSimulation simulation);

#endif
