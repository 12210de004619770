/*
  The program petsam-stress: a run (stress/stressrun.c) in the frame of program.c.

  Exit codes: 0 done; 2 bad usage; 3 a file cannot be used; others are PETSc's.
*/
#include "program.h"
#include "help/petsam-stress.h" /* from petsam-stress.help */
#include "stress/stressrun.h"
#include <petsam/private/baseimpl.h>
#include <signal.h>

static PetscErrorCode SetUp(void *context, const SamArguments *arguments)
{
  PetscFunctionBegin;
  PetscCall(SamStressRunSetUp((SamStressRun *)context, arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static SamStressRun run;

/* A signal that ends the program leaves no temporary file: it may be large. */
static void EndOnSignal(int number)
{
  SamStressFileAbandon(run.file);
  (void)signal(number, SIG_DFL);
  (void)raise(number);
}

static void CatchSignals(void)
{
  static const int numbers[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2};

  for (size_t k = 0; k < sizeof(numbers) / sizeof(numbers[0]); k++)
    if (signal(numbers[k], EndOnSignal) == SIG_IGN) (void)signal(numbers[k], SIG_IGN);
}

static PetscErrorCode Compute(void *context)
{
  PetscFunctionBegin;
  CatchSignals();
  PetscCall(SamStressRunCompute((SamStressRun *)context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TearDown(void *context)
{
  PetscFunctionBegin;
  PetscCall(SamStressRunTearDown((SamStressRun *)context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int GetStatus(const void *context)
{
  (void)context;
  return 0;
}

static PetscBool IsWriting(const void *context)
{
  return ((const SamStressRun *)context)->writing;
}

/* Leaves no temporary file. */
static void Abandon(void *context)
{
  SamStressFileAbandon(((SamStressRun *)context)->file);
}

int main(int argc, char **argv)
{
  const SamProgram program = {.name     = "petsam-stress",
                              .topics   = topics,
                              .setup    = SetUp,
                              .run      = Compute,
                              .teardown = TearDown,
                              .status   = GetStatus,
                              .writing  = IsWriting,
                              .abandon  = Abandon,
                              .context  = &run};

  return SamProgramMain(&program, argc, argv);
}
