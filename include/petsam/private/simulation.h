/* A simulation: a contact, its load program or life, the results and checkpoints of it, from options. */
#ifndef PETSAM_SIMULATION_H
#define PETSAM_SIMULATION_H

#include <petsam/advice.h>
#include <petsam/history.h>
#include <petsam/life.h>
#include <signal.h>

/*
  SamSimulation - solves the load steps of a history, or with -wear_cycles the cycles of a life; writes results and
  checkpoints where options ask for them; goes on from a checkpoint. It prints nothing: a monitor is told what happens.
  Order of calls: Create, SetMonitor, SetFromOptions, SetUp, Run, Destroy.
*/
typedef struct _n_SamSimulation *SamSimulation;

/* SamEventKind - what a monitor is told of. */
typedef enum {
  SAM_NOTIFY_BEGIN,       /* the first step is next: `start` */
  SAM_NOTIFY_STEP_BEGINS, /* `step` */
  SAM_NOTIFY_STEP,        /* `step` was solved, or failed, and is in the results: `result` */
  SAM_NOTIFY_CYCLE_BEGINS,
  SAM_NOTIFY_CYCLE_STEP, /* a step of a computed cycle, `step` of all these: `result` */
  SAM_NOTIFY_CYCLE,      /* `cycle` was computed, and is in the results; of `cycles` in all */
  SAM_NOTIFY_MESSAGE,    /* the message of `result` about what `text` names */
  SAM_NOTIFY_ADVICE,     /* `text`, and the option that mends it, `setting` (without dash; empty: none) */
  SAM_NOTIFY_EXTENT,     /* `extent` of the contact in `step` */
  SAM_NOTIFY_SLIP,       /* `slip` of all steps */
  SAM_NOTIFY_GRID_CHECK, /* `check` of the last step */
  SAM_NOTIFY_FILE,       /* the file `text` was written, and holds `setting` */
  SAM_NOTIFY_STOPPED     /* before the end, with a checkpoint: `text` says where and why */
} SamEventKind;

/* SamSimulationStart - from where, and into which files. */
typedef struct {
  PetscInt    steps;                          /* of the load history, or of one cycle with those that lead to it */
  PetscBool   cyclic;                         /* a wear simulation over cycles */
  PetscBool   loads[SAM_COMPONENTS];          /* those that are not 0 in all steps: given so, or found */
  const char *results;                        /* file; NULL: none */
  PetscBool   replaced;                       /* an older file of that name */
  char        size[128];                      /* of the results, in words */
  double      seconds;                        /* that a step takes, roughly; 0: not known */
  char        when[PETSC_MAX_PATH_LEN + 256]; /* checkpoints are written, in words; empty: never */
  const char *restart;                        /* the checkpoint from which it goes on; NULL: none */
  char        after[64];                      /* in words: where that is */
  PetscBool   branch, gap; /* the results begin there, and not with the load program; with another gap */
  char        followed[PETSC_MAX_PATH_LEN]; /* file of the results before a branch; empty: none */
} SamSimulationStart;

/*
  SamGridCheckRow - a number of the last step (sums: of all steps) on this grid and on half the cells, the
  order that its error is taken for, and what follows.
  SamGridCheck - all of them; `n`: the cells of the coarser grid.
*/
typedef struct {
  const char *name, *unit;
  PetscInt    order;
  double      value, coarse, error, extrapolated;
} SamGridCheckRow;
typedef struct {
  PetscInt        n[2], count;
  SamGridCheckRow row[24];
} SamGridCheck;

/* SamSimulationEvent - with what belongs to the kind of news; all is borrowed. */
typedef struct {
  SamEventKind              kind;
  PetscInt                  step; /* from 0 */
  const SamStep            *result;
  const SamLifeReport      *cycle;
  PetscReal                 cycles;
  const SamSimulationStart *start;
  const SamExtent          *extent;
  const SamSlip            *slip;
  const SamGridCheck       *check;
  const char               *text, *setting;
} SamSimulationEvent;

/* SamSimulationMonitor - is told what happens, on all ranks. Collective. An error ends the simulation. */
typedef PetscErrorCode (*SamSimulationMonitor)(void *context, SamContact contact, const SamSimulationEvent *news);

/* SamSimulationCreate - makes a simulation without a contact. SamSimulationDestroy - frees it. Collective. */
PETSC_EXTERN PetscErrorCode SamSimulationCreate(MPI_Comm comm, SamSimulation *simulation);
PETSC_EXTERN PetscErrorCode SamSimulationDestroy(SamSimulation *simulation);
/*
  SamSimulationSetMonitor - whom to tell; NULL: nobody.
  SamSimulationSetSignals - numbers that others, as a handler of signals, may set to 1 on any rank at any time: the
  first asks for a checkpoint after the step, the second for one and the end; they become 0 again. Borrowed.
  Neither is collective.
*/
PETSC_EXTERN PetscErrorCode SamSimulationSetMonitor(SamSimulation simulation, SamSimulationMonitor monitor,
                                                    void *context);
PETSC_EXTERN PetscErrorCode SamSimulationSetSignals(SamSimulation simulation, volatile sig_atomic_t signals[2]);
/*
  SamSimulationSetFromOptions - reads all options and the tables that they name; writes nothing. `arguments`: see
  SamHistoryCreateFromOptions().
  SamSimulationSetUp - makes the contact and what else takes memory. While the help is printed, reads its options only.
  SamSimulationRun - goes on from the checkpoint, if there is one; solves all steps, or cycles; writes what is to be
  written. Ends early where a step has no solution, did not converge, or is at the edge of the grid.
  SamSimulationRehearse - instead: what comes before the first step, without writing: reads the checkpoint, forecasts
  size and time, and tells of the beginning.
  Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamSimulationRehearse(SamSimulation simulation);
PETSC_EXTERN PetscErrorCode SamSimulationSetFromOptions(SamSimulation simulation, const SamOptions *from,
                                                        const struct _n_SamArguments *arguments);
PETSC_EXTERN PetscErrorCode SamSimulationSetUp(SamSimulation simulation, const SamOptions *from);
PETSC_EXTERN PetscErrorCode SamSimulationRun(SamSimulation simulation);

/*
  For programs that give the load program themselves:
    SetContactFromOptions  instead of SetFromOptions: reads all options but those of loads and the number of cycles
    SetProgram             takes over a history, which runs once (`cycles` 0), or is one cycle of a life;
                           SamSimulationRun() then goes on from the committed state; may be called again
    SetGap                 the bodies' separation becomes another one than that of the options
  Stop - from a monitor: ends after this step. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamSimulationSetContactFromOptions(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationSetProgram(SamSimulation simulation, SamHistory *history, PetscReal cycles);
PETSC_INTERN PetscErrorCode SamSimulationSetGap(SamSimulation simulation, Vec gap);
PETSC_INTERN PetscErrorCode SamSimulationStop(SamSimulation simulation);

/*
  SamSimulationTryStep - tries a step; conditions that are not as usual become numbers of each step, and at the edge of
  the grid the message has a larger one. After an error there is no tried step. Errors: those of SamContactTry().
  SamSimulationCommitStep - commits it. `warning`: of a law about it; NULL: not wanted. Errors: PETSC_ERR_ORDER
  without a tried solution, PETSC_ERR_NOT_CONVERGED. SamContactReject() forgets it. Collective.
  SamSimulationAdviseStep - passes on the advice on the tried step, as after a history of the committed steps and this
  one. Collective.
  SamSimulationForgetAdvice - the steps from now on go on from another state. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationAdviseStep(SamSimulation simulation, const SamStep *step,
                                                    SamAdviceFunction receive, void *context);
PETSC_INTERN void           SamSimulationForgetAdvice(SamSimulation simulation);
PETSC_INTERN PetscErrorCode SamSimulationTryStep(SamSimulation simulation, const SamControl *control, SamStep *step);
PETSC_INTERN PetscErrorCode SamSimulationCommitStep(SamSimulation simulation, const SamStep *step, char warning[],
                                                    size_t size);

/* SamSimulationNeeds - what its memory depends on besides the grid. */
typedef struct {
  PetscBool friction, coupled, life, stiffness, grid_check;
  PetscInt  steps;
  PetscInt  laws; /* bytes a cell that the laws take */
} SamSimulationNeeds;
/* SamSimulationFiles - the files that it reads or writes by its own options; NULL: none. */
typedef struct {
  const char *output, *checkpoint, *restart;
} SamSimulationFiles;
/*
  After SamSimulationSetFromOptions(). Not collective.
    GetSetup   the contact and all that it is made of; borrowed
    GetSeries  the numbers of the computed cycle; borrowed; NULL: it is no life
    GetStatus  the worst status of the steps so far, and whether it stopped before its end, with a checkpoint
    IsWriting  whether a collective write is under way
*/
PETSC_EXTERN const SamSetup    *SamSimulationGetSetup(SamSimulation simulation);
PETSC_EXTERN SamSimulationNeeds SamSimulationGetNeeds(SamSimulation simulation);
PETSC_EXTERN PetscErrorCode     SamSimulationGetFiles(SamSimulation simulation, SamSimulationFiles *files);
PETSC_INTERN SamState           SamSimulationGetSeries(SamSimulation simulation);
PETSC_EXTERN PetscErrorCode     SamSimulationGetStatus(SamSimulation simulation, SamStatus *worst, PetscBool *stopped);
PETSC_EXTERN PetscBool          SamSimulationIsWriting(SamSimulation simulation);
/* SamSimulationAbandon - before the process ends without the others: leaves no temporary file. Not collective. */
PETSC_EXTERN void SamSimulationAbandon(SamSimulation simulation);

#endif
