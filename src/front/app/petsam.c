/*
  The program petsam: runs a simulation in the frame of program.c, and reports it.

  Exit codes: 0 converged and checked; 2 bad usage; 3 a file cannot be used; 10 not converged; 11 no equilibrium; 12
  contact at the grid's edge; 75 stopped with a checkpoint; others are PETSc's. Nothing is written before all input has
  been read and checked.
*/
#include "program.h"
#include "help/petsam.h" /* from petsam.help */
#include "report.h"
#include <petsam/private/checkpoint.h>
#include <petsam/private/output.h>
#include <petsam/private/file.h>
#include <petsam/private/contact.h>
#include <time.h>

enum { EXIT_STOPPED = 75 };

typedef struct {
  SamSimulation simulation;
  SamReport     report;
  PetscBool     dry; /* only checks and forecasts */
} SamRun;

/* ---- signals ---- */

static volatile sig_atomic_t signaled[2] = {0, 0}; /* requests: to write a checkpoint; to write one and stop */

/* Notes a signal. A second TERM, some seconds later, ends the program at once, for a step that takes too long. */
static void NoteSignal(int number)
{
  static volatile time_t first = 0;

  signaled[number != SIGUSR2] = 1;
  if (number != SIGTERM) return;
  if (first && time(NULL) > first + 1) {
    (void)signal(SIGTERM, SIG_DFL);
    (void)raise(SIGTERM);
  } else if (!first) {
    first = time(NULL);
  }
}

/* Catches the signals. Without -checkpoint TERM ends the program as usual. */
static void CatchSignals(PetscBool checkpoint)
{
  struct sigaction action;

  memset(&action, 0, sizeof(action));
  action.sa_handler = NoteSignal;
  action.sa_flags   = SA_RESTART;
  (void)sigemptyset(&action.sa_mask);
  (void)sigaction(SIGUSR1, &action, NULL);
  (void)sigaction(SIGUSR2, &action, NULL);
  if (checkpoint) (void)sigaction(SIGTERM, &action, NULL);
}

/* Warns of a quiet run without a file, which leaves nothing but its exit code. */
static void WarnOfQuiet(const SamRun *run, const SamSimulationFiles *f)
{
  if (run->report->quiet && !run->report->rank && !run->dry && !f->output && !f->checkpoint)
    SamPrintMessage("petsam", "warning: -quiet is given without -output: the run leaves no result: give -output");
}

/* ---- memory ---- */

/*
  Bytes per cell at the peak, with shared memory counted once, without the program and its libraries; measured at 1024
  cells per side, for contact on half of the grid and on all of it. From 2048 cells on up to 15 bytes fewer are needed:
    one step        without friction 72 and 82, with friction 165 and 214, coupled 650 and 700
    several steps   without friction 255 and 270, with friction 335 and 358, coupled 780 and 830
  Several steps need a second state, to which a rejected step returns.
*/
static const double bytes_per_cell[2][2][2] = {{{85, 150}, {190, 730}},
                                               {{265, 365}, {350, 870}}}; /* [several steps][friction][coupled] */

/* Memory of the slip in a step (step/direction.c), bytes per cell; measured at 512 cells a side: 57, coupled 4 */
#define TURN_BYTES 70
/* Memory of an upwind operator, directions and products, bytes per cell; at 1024 cells a side, 59 % in contact: 250 */
#define ROLLING_BYTES 280

/* Largest memory of a kept step of a load cycle, bytes per cell */
#define KEPT_BYTES 32

/*
  Memory of a wear simulation, bytes per cell. Sliding surfaces add the wear load of each body, and a part for each
  step, which is larger for dissimilar bodies.
*/
#define LIFE_BYTES                         (16 * 8)
#define SLIDING_LIFE_BYTES(steps, coupled) (4 * 8 + ((coupled) ? 20 : 12) * (double)(steps))

/*
  Memory of the tangent stiffness, bytes per cell: mainly solutions and search directions on the cells in contact.
  Measured at 512 cells a side, for contact on 50 and 79 % of the grid: without friction 228 and 330, with friction 294
  and 408, coupled 528 and 729; extrapolated to contact on all of the grid.
*/
static const double stiffness_bytes[2][2] = {{400, 400}, {490, 880}}; /* [friction][coupled] */

/* Estimates the memory of the kept steps on all ranks, bytes; a life keeps two cycles. The contact is created later. */
static PetscErrorCode EstimateKept(const SamSetup *setup, const SamSimulationNeeds *needs, double *bytes)
{
  const double steps = needs->life ? 2 * (double)needs->steps : (double)needs->steps;
  char         kept[32];
  PetscBool    given;

  PetscFunctionBegin;
  *bytes = 0;
  if (needs->steps < 2 || SamElasticityGetTraits(setup->elasticity).upwind) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsGetString(NULL, NULL, "-cycle_memory", kept, sizeof(kept), &given));
  *bytes = PetscMin(given ? atof(kept) : (double)SamContactCycleMemory(setup->grid),
                    KEPT_BYTES * steps * (double)setup->grid->nx * (double)setup->grid->ny);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Estimates the memory that this rank will need, bytes. */
static PetscErrorCode EstimateMemory(SamSimulation simulation, double *bytes)
{
  PetscMPIInt              ranks;
  double                   cell, kept;
  const SamSetup          *setup = SamSimulationGetSetup(simulation);
  const SamSimulationNeeds needs = SamSimulationGetNeeds(simulation);

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(setup->grid->comm, &ranks));
  PetscCall(EstimateKept(setup, &needs, &kept));
  cell = bytes_per_cell[needs.steps > 1][needs.friction][needs.coupled] + (double)needs.laws +
         (needs.friction && needs.steps > 1 ? TURN_BYTES : 0) +
         (SamElasticityGetTraits(setup->elasticity).upwind ? ROLLING_BYTES : 0) + (needs.life ? LIFE_BYTES : 0) +
         (needs.stiffness ? stiffness_bytes[needs.friction][needs.coupled] : 0);
  if (needs.life && SamProblemGetLaw(setup->problem, SAM_LAW_SLIDE))
    cell += SLIDING_LIFE_BYTES(needs.steps, needs.coupled);
  *bytes = SAM_MEMORY_PROGRAM + cell * (double)setup->grid->cells;
  if (needs.grid_check) *bytes += 0.25 * cell * (double)setup->grid->cells;
  *bytes += kept / ranks;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects a run for which a node does not have enough memory. */
static PetscErrorCode RefuseTooLarge(SamSimulation simulation, const SamOptions *from)
{
  double          bytes;
  char            cells[64];
  const SamSetup *setup = SamSimulationGetSetup(simulation);

  PetscFunctionBegin;
  PetscCall(EstimateMemory(simulation, &bytes));
  PetscCall(PetscSNPrintf(cells, sizeof(cells), "%" PetscInt_FMT ",%" PetscInt_FMT, setup->grid->nx, setup->grid->ny));
  PetscCall(SamOptionsHeading(from, "Memory"));
  PetscCall(SamMemoryRefuse(from->comm, bytes, "-grid_n", cells, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the run ---- */

static PetscErrorCode SetUp(void *context, const SamArguments *arguments)
{
  static const SamOptionRow dry  = {"dry_run", "check everything, print memory, disk and time, and solve nothing",
                                    SAM_OPTION_BOOL, .member = 0};
  SamRun *const             run  = (SamRun *)context;
  const SamOptions          from = {PETSC_COMM_WORLD, NULL};
  SamSimulationFiles        files;

  PetscFunctionBegin;
  CatchSignals(PETSC_FALSE);
  PetscCall(SamSimulationCreate(from.comm, &run->simulation));
  PetscCall(SamSimulationSetSignals(run->simulation, signaled));
  PetscCall(SamSimulationSetFromOptions(run->simulation, &from, arguments));
  PetscCall(SamReportCreateFromOptions(&from, &run->report));
  PetscCall(SamOptionsRead(&from, NULL, 1, &dry, &run->dry, NULL));
  PetscCall(SamSimulationGetFiles(run->simulation, &files));
  if (files.checkpoint) CatchSignals(PETSC_TRUE);
  WarnOfQuiet(run, &files);
  PetscCall(RefuseTooLarge(run->simulation, &from));
  PetscCall(SamSimulationSetUp(run->simulation, &from));
  PetscCall(SamSimulationCheckFiles(run->simulation, arguments)); /* all options have been read */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Passes the events of the simulation to the report. */
static PetscErrorCode Tell(void *context, SamContact contact, const SamSimulationEvent *news)
{
  const SamRun *run = (const SamRun *)context;

  PetscFunctionBegin;
  if (news->kind == SAM_NOTIFY_BEGIN) {
    double bytes;

    PetscCall(EstimateMemory(run->simulation, &bytes));
    PetscCall(SamReportBanner(run->report, SamSimulationGetSetup(run->simulation)->grid, bytes, news->start));
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
  PetscCall((run->dry ? SamSimulationRehearse : SamSimulationRun)(run->simulation));
  if (!run->dry) PetscCall(SamReportClosing(run->report));
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

  /* -version creates no simulation */
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
