/*
  The program petsam: a simulation in the frame of program.c, and the report of it.

  Exit codes: 0 converged and checked; 2 bad usage; 3 a file cannot be used; 10 not converged; 11 no equilibrium; 12
  contact at the grid's edge; 75 stopped with a checkpoint; others are PETSc's. Nothing is written before all input has
  been read and checked.
*/
#include "program.h"
#include "help/petsam.h" /* from petsam.help */
#include "runimpl.h"
#include <petsam/private/baseimpl.h>
#include <string.h>

enum { EXIT_STOPPED = 75 };

/* ---- signals ---- */

static volatile sig_atomic_t signaled[2] = {0, 0}; /* to write a checkpoint; to write one and stop */

static void NoteSignal(int number)
{
  signaled[number == SIGUSR1] = 1;
}

static void CatchSignals(void)
{
  struct sigaction action;

  memset(&action, 0, sizeof(action));
  action.sa_handler = NoteSignal;
  action.sa_flags   = SA_RESTART;
  (void)sigemptyset(&action.sa_mask);
  (void)sigaction(SIGUSR1, &action, NULL);
  (void)sigaction(SIGUSR2, &action, NULL);
}

/* ---- the run ---- */

static PetscErrorCode SetUp(void *context, const SamArguments *arguments)
{
  SamRun *const    run  = (SamRun *)context;
  const SamOptions from = {PETSC_COMM_WORLD, NULL};

  PetscFunctionBegin;
  CatchSignals();
  PetscCall(SamSimulationCreate(from.comm, &run->simulation));
  PetscCall(SamSimulationSetSignals(run->simulation, signaled));
  PetscCall(SamSimulationSetFromOptions(run->simulation, &from, arguments));
  PetscCall(SamReportCreateFromOptions(&from, &run->report));
  PetscCall(SamRunCheckFiles(run, from.comm, arguments));
  PetscCall(SamRunRefuseTooLarge(run->simulation, &from));
  PetscCall(SamSimulationSetUp(run->simulation, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Passes the news of the simulation on to the report. */
static PetscErrorCode Tell(void *context, SamContact contact, const SamSimulationNews *news)
{
  const SamRun *run = (const SamRun *)context;

  PetscFunctionBegin;
  if (news->kind == SAM_NEWS_BEGIN) {
    const SamSetup *setup;
    double          bytes;

    PetscCall(SamSimulationGetSetup(run->simulation, &setup));
    PetscCall(SamRunMemory(run->simulation, &bytes));
    PetscCall(SamReportBanner(run->report, setup->grid, bytes, news->start));
  } else {
    PetscCall(SamReportNews(run->report, contact, news));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve(void *context)
{
  SamRun *const run = (SamRun *)context;

  PetscFunctionBegin;
  PetscCall(SamSimulationSetMonitor(run->simulation, Tell, run));
  PetscCall(SamSimulationRun(run->simulation));
  PetscCall(SamReportClosing(run->report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TearDown(void *context)
{
  SamRun *const run = (SamRun *)context;

  PetscFunctionBegin;
  PetscCall(SamSimulationDestroy(&run->simulation));
  PetscCall(SamReportDestroy(&run->report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int GetStatus(const void *context)
{
  const SamRun *run     = (const SamRun *)context;
  SamStatus     worst   = SAM_STATUS_CONVERGED;
  PetscBool     stopped = PETSC_FALSE;

  /* -version makes no simulation */
  if (run->simulation) (void)SamSimulationGetStatus(run->simulation, &worst, &stopped);
  return stopped ? EXIT_STOPPED : (int)worst;
}

static PetscBool IsWriting(const void *context)
{
  const SamSimulation simulation = ((const SamRun *)context)->simulation;

  return simulation && SamSimulationIsWriting(simulation);
}

static void Abandon(void *context)
{
  const SamSimulation simulation = ((const SamRun *)context)->simulation;

  if (simulation) SamSimulationAbandon(simulation);
}

int main(int argc, char **argv)
{
  static SamRun    run;
  const SamProgram petsam = {.name     = "petsam",
                             .topics   = topics,
                             .prepare  = SamHistoryClaimOption,
                             .setup    = SetUp,
                             .run      = Solve,
                             .teardown = TearDown,
                             .status   = GetStatus,
                             .writing  = IsWriting,
                             .abandon  = Abandon,
                             .context  = &run};

  return SamProgramMain(&petsam, argc, argv);
}
