/* The results file of a run: created, gone on with, or begun as a branch; and how large it will be. */
#include "runimpl.h"
#include <string.h>
#include <unistd.h>

/* ---- opening ---- */

static PetscErrorCode Create(SamRun *run)
{
  char *all;

  PetscFunctionBegin;
  PetscCall(SamOutputCreate(run->setup.grid, run->filename, &run->output_settings, &run->output));
  PetscCall(PetscOptionsGetAll(NULL, &all));
  PetscCall(SamOutputSetText(run->output, "options", all));
  PetscCall(PetscFree(all));
  PetscCall(SamOutputSetParameters(run->output, &run->parameters));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Opens the results of the stopped run, up to its checkpoint. */
static PetscErrorCode Continue(SamRun *run)
{
  const SamRunPoint   *p     = &run->point;
  const SamOutputPoint point = {
    .first = p->first, .steps = p->steps - p->first, .cycles = p->rows - p->first_row, .times = p->times};
  SamControl last;

  PetscFunctionBegin;
  if (!run->life) {
    PetscCall(SamHistoryGetStep(run->history, p->steps - 1, &last));
    run->last_time = last.time;
  }
  PetscCall(
    SamOutputContinue(run->setup.grid, run->filename, &run->output_settings, &run->parameters, &point, &run->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A file of the steps after the checkpoint. It says what they follow. */
static PetscErrorCode Branch(SamRun *run, const char checkpoint[])
{
  SamRunPoint    *p    = &run->point;
  const PetscReal step = (PetscReal)p->steps;
  SamLifeState    life;

  PetscFunctionBegin;
  p->first     = p->steps;
  p->first_row = p->rows;
  p->times     = 0;
  PetscCall(Create(run));
  PetscCall(SamOutputSetReals(run->output, SAM_OUTPUT_BRANCH, 1, &step));
  PetscCall(SamOutputSetText(run->output, "branch_checkpoint", checkpoint));
  PetscCall(SamOutputSetText(run->output, "branch_results", p->results[0] ? p->results : "none"));
  PetscCall(SamOutputSetText(run->output, "branch_gap", run->restart_gap ? "of this run" : "as before"));
  PetscCall(SamReportSetBranch(run->report, p->results, run->restart_gap));
  if (!run->life) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamLifeGetState(run->life, &life));
  PetscCall(SamOutputSetReals(run->output, "branch_cycles", 1, &life.cycles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether there is a file of that name, by rank 0. */
static PetscErrorCode Exists(SamGrid grid, const char filename[], PetscBool *exists)
{
  PetscMPIInt rank, there = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (!rank) there = access(filename, F_OK) == 0;
  PetscCallMPI(MPI_Bcast(&there, 1, MPI_INT, 0, grid->comm));
  *exists = there ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunOpenResults(SamRun *run, const char checkpoint[])
{
  PetscBool exists;

  PetscFunctionBegin;
  if (checkpoint) {
    PetscCall(Exists(run->setup.grid, run->filename, &exists));
    PetscCheck(
      !exists || !run->restart_gap, PETSC_COMM_WORLD, SAM_ERR_USER,
      "-output %s: is there, and results with another gap (-restart_gap) need a file of their own: give another "
      "name",
      run->filename);
    if (!exists && strcmp(run->filename, run->point.results))
      PetscCall(Branch(run, checkpoint));
    else /* where the stopped run's own file is missing, that is an error */
      PetscCall(Continue(run));
  } else {
    PetscCall(Create(run));
  }
  PetscCall(PetscStrncpy(run->point.results, run->filename, sizeof(run->point.results)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- size ---- */

/* Steps first + 1 ... last whose fields are saved. */
static PetscInt CountSaved(const SamRun *run, PetscInt first, PetscInt last)
{
  return last / run->output_every - first / run->output_every + (last > first && last % run->output_every ? 1 : 0);
}

/* A size that a person reads. */
static void PrintBytes(double bytes, char text[], size_t size)
{
  const int    power   = bytes < 1e6 ? 1 : bytes < 1e9 ? 2 : bytes < 1e12 ? 3 : 4;
  const double units[] = {1, 1e3, 1e6, 1e9, 1e12};

  (void)snprintf(text, size, "%.3g %cB", bytes / units[power], " kMGT"[power]);
}

/* The size of the whole file, and what is still to come of it. In a life the cycles that will be computed count not. */
static PetscErrorCode Estimate(const SamRun *run, double *whole, double *rest)
{
  const SamRunPoint *p    = &run->point;
  const PetscInt     last = run->needs.steps;
  PetscInt           start, cycles;

  PetscFunctionBegin;
  if (run->life) {
    PetscCall(SamHistoryGetIncrements(run->history, &start));
    cycles = SamWearingCountOutputs(&run->wearing);
    PetscCall(SamOutputForecast(run->output, (double)cycles * (double)(last - start),
                                (double)cycles * (double)CountSaved(run, 0, last - start), whole));
    *rest = *whole;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamOutputForecast(run->output, (double)(last - p->first), (double)CountSaved(run, p->first, last), whole));
  PetscCall(SamOutputForecast(run->output, (double)(last - p->steps), (double)CountSaved(run, p->steps, last), rest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunForecast(SamRun *run, char text[], size_t size)
{
  double      whole, rest, space;
  char        words[3][32];
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCall(Estimate(run, &whole, &rest));
  PetscCall(SamOutputGetSpace(run->output, &space));
  PrintBytes(whole, words[0], sizeof(words[0]));
  PrintBytes(rest, words[1], sizeof(words[1]));
  PrintBytes(space, words[2], sizeof(words[2]));
  (void)snprintf(text, size, "%s %s, %s free there",
                 run->life                           ? "at least"
                 : run->output_settings.compress > 0 ? "at most"
                                                     : "about",
                 words[0], words[2]);
  if (rest <= space) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(run->setup.grid->comm, &rank));
  if (!rank)
    fprintf(stderr,
            "petsam: warning: -output %s: needs %s %s, and %s are free there: a larger -output_every, fewer "
            "-output_fields, or -output_single make it smaller\n",
            run->filename, run->output_settings.compress > 0 ? "up to" : "about", words[1], words[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
