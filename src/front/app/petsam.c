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
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <time.h>

enum { EXIT_STOPPED = 75 };

typedef struct {
  SamSimulation simulation;
  SamReport     report;
  SamAccuracy   accuracy;
  PetscBool     dry; /* only checks and forecasts */
} SamRun;

/* ---- signals ---- */

static volatile sig_atomic_t signaled[2] = {0, 0}; /* requests: to write a checkpoint; to write one and stop */

static volatile sig_atomic_t terminated = 0; /* TERM has come */

/* Notes a signal. A second TERM, some seconds later, ends the program at once, for a step that takes too long. */
static void NoteSignal(int number)
{
  static volatile time_t first = 0;

  signaled[number != SIGUSR2] = 1;
  if (number != SIGTERM) return;
  terminated = 1;
  if (first && time(NULL) > first + 1) {
    (void)signal(SIGTERM, SIG_DFL);
    (void)raise(SIGTERM);
  } else if (!first) {
    first = time(NULL);
  }
}

/* Catches the signals from the beginning: one that comes before the options are read counts, too. */
static void CatchSignals(void)
{
  struct sigaction action;

  memset(&action, 0, sizeof(action));
  action.sa_handler = NoteSignal;
  action.sa_flags   = SA_RESTART;
  (void)sigemptyset(&action.sa_mask);
  (void)sigaction(SIGUSR1, &action, NULL);
  (void)sigaction(SIGUSR2, &action, NULL);
  (void)sigaction(SIGTERM, &action, NULL);
}

#if defined(__ELF__)
/* Before the constructors of the libraries, which take most of the time until main(), 0.1 s. */
__attribute__((section(".preinit_array"), used)) static void (*const at_start)(void) = CatchSignals;
#endif

/* Lets TERM end the program as usual in a run without -checkpoint, also one that has come already. */
static PetscErrorCode ReleaseTerm(void)
{
  PetscBool checkpoint;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-checkpoint", &checkpoint));
  if (checkpoint) PetscFunctionReturn(PETSC_SUCCESS);
  (void)signal(SIGTERM, SIG_DFL);
  if (terminated) (void)raise(SIGTERM);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns of a quiet run without a file, which leaves nothing but its exit code. */
static void WarnOfQuiet(const SamRun *run, const SamSimulationFiles *f)
{
  if (run->report->quiet && !run->report->rank && !run->dry && !f->output && !f->checkpoint)
    SamPrintMessage("petsam", "warning: -quiet is given without -output: the run leaves no result: give -output");
}

/* ---- memory ---- */

/*
  Bytes at the peak, with shared memory counted once, without the program and its libraries: per cell of this rank, per
  cell of the operator's part of the grid, and per cell in contact, where fields are touched and sets are kept.
*/
typedef struct {
  double cell, part, contact;
} Bytes;

/*
  Measured at 512 cells per side for contact on 3, 35 and 77 % of the grid. Several steps need a second state, to which
  a rejected step returns, and with friction the solution for the direction of slip. In plane strain the coarser grids
  and their transforms take as much as the grid itself; measured at 200000 cells for contact on 13 and 44 % of them.
*/
static const Bytes step_bytes[2][2][2][2] = {
  {{{{64, 6, 26}, {131, 52, 22}}, {{130, 23, 108}, {235, 150, 243}}},
   {{{131, 34, 112}, {200, 80, 110}}, {{198, 113, 189}, {385, 150, 243}}}},
  {{{{313, 0, 209}, {380, 0, 300}}, {{401, 0, 460}, {421, 0, 773}}},
   {{{400, 0, 0}, {450, 0, 300}}, {{473, 0, 603}, {571, 0, 773}}}}}; /* [plane][several steps][friction][coupled] */

/* The motion until cells of dissimilar bodies touch: three fields instead of one in each of the passes that are kept */
#define TOUCHING_BYTES 340

/* HDF5's code and buffers, if there are results or checkpoints, and its copies of a checkpoint's fields, per cell */
#define FILE_BYTES       6e6
#define CHECKPOINT_BYTES 55

/* An upwind operator: directions and their products in the contact */
#define ROLLING_BYTES 280

/* Largest memory of a kept step of a load cycle, bytes per cell in contact */
#define KEPT_BYTES 24

/* Surfaces that slide: passes of dissimilar bodies, or fields of a life. Other steps take no more than without it. */
#define SLIDING_BYTES 56

/*
  Memory of a wear simulation, bytes per cell. Sliding surfaces add the wear load of each body, and a part for each
  step, which is larger for dissimilar bodies.
*/
#define LIFE_BYTES                         (16 * 8)
#define SLIDING_LIFE_BYTES(steps, coupled) (4 * 8 + ((coupled) ? 20 : 12) * (double)(steps))

/*
  Memory of the tangent stiffness beyond that of the step, bytes per cell in contact: solutions and search directions.
  It follows a step, whose solvers' memory is free then.
*/
static const double stiffness_bytes[2][2][2] = {{{450, 450}, {570, 600}},
                                                {{450, 450}, {360, 360}}}; /* [several steps][friction][coupled] */

/*
  Memory of gradients: of recorded steps, bytes per cell in contact, and of the pass back, per cell and per cell in
  contact beyond that of the steps.
*/
#define RECORDED_BYTES 60
/* A wear simulation records the cells beside the contact, too, parts of so many times as many; per jump the steps of so
   many cycles, with those that close the loop, and so many before; and fields of each jump, and of the pass back. */
#define LIFE_BESIDE    1.9
#define LIFE_CYCLES    3.2
#define LIFE_FIRST     6.0
#define JUMP_BYTES     120
#define LIVING_BYTES   72
#define GRADIENT_BYTES 64
static const double gradient_bytes[2][2] = {{730, 700}, {910, 1450}}; /* [friction][coupled] */

/* Estimates the memory of the steps that this rank keeps, bytes; a life keeps two cycles. The contact comes later. */
static PetscErrorCode EstimateKept(const SamSetup *setup, const SamSimulationNeeds *needs, int ranks, double *bytes)
{
  const double steps = needs->life ? 2 * (double)needs->steps : (double)needs->steps;
  char         kept[32];
  PetscBool    given;

  PetscFunctionBegin;
  *bytes = 0;
  if (needs->steps < 2 || SamElasticityGetTraits(setup->elasticity).upwind) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsGetString(NULL, NULL, "-cycle_memory", kept, sizeof(kept), &given));
  *bytes = PetscMin((given ? atof(kept) : (double)SamContactCycleMemory(setup->grid)) / ranks,
                    KEPT_BYTES * steps * (double)(needs->contact * setup->grid->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the mean memory per cell of this rank, bytes, without kept steps. */
static double BytesPerCell(const SamSetup *setup, const SamSimulationNeeds *needs)
{
  const int   several = needs->steps > 1, friction = needs->friction, coupled = needs->coupled;
  const Bytes first = step_bytes[SamGridIsRow(setup->grid)][0][friction][coupled];
  const Bytes b     = step_bytes[SamGridIsRow(setup->grid)][several][friction][coupled];
  double      cell = b.cell, contact = b.contact;

  if (needs->touches == SAM_TOUCHES_FIRST) cell = PetscMax(cell, first.cell + TOUCHING_BYTES);
  if (needs->touches == SAM_TOUCHES_LATER) cell += TOUCHING_BYTES;
  cell += (double)needs->laws;
  if (SamElasticityGetTraits(setup->elasticity).upwind) contact += ROLLING_BYTES;
  if (needs->life) cell += LIFE_BYTES;
  if (needs->stiffness) contact += stiffness_bytes[several][friction][coupled];
  if (needs->slides && (needs->life || coupled)) cell += SLIDING_BYTES;
  if (needs->slides && needs->life) cell += SLIDING_LIFE_BYTES(needs->steps, needs->coupled);
  return cell + b.part * (double)needs->part + contact * (double)needs->contact;
}

/* Returns the memory of gradients on this rank, bytes. */
static double BytesOfGradients(const SamSetup *setup, const SamSimulationNeeds *needs, int ranks)
{
  const double    contact = (double)needs->contact, jumps = (double)needs->gradient_jumps;
  const double    cycles = needs->life ? LIFE_BESIDE * (LIFE_FIRST + LIFE_CYCLES * jumps) : 1;
  const double    steps = cycles * (double)needs->steps, life = needs->life ? LIVING_BYTES + JUMP_BYTES * jumps : 0;
  const double    systems = gradient_bytes[needs->friction][needs->coupled] * contact;
  const PetscInt *bytes   = needs->gradient_bytes;

  double recorded = RECORDED_BYTES * steps * contact * (double)setup->grid->cells;

  if (!needs->gradient) return 0;
  if (needs->gradient_memory > 0) recorded = PetscMin(recorded, (double)needs->gradient_memory / ranks);
  return recorded + (GRADIENT_BYTES + life + (double)bytes[0] +
                     PetscMax(systems, (double)bytes[1] + (double)bytes[2] * (double)needs->steps)) *
                      (double)setup->grid->cells;
}

/* Estimates the memory that this rank will need, and of it what does not depend on the grid, bytes. */
static PetscErrorCode EstimateMemory(SamSimulation simulation, double bytes[2])
{
  PetscMPIInt              ranks;
  double                   kept;
  const SamSetup          *setup = SamSimulationGetSetup(simulation);
  const SamSimulationNeeds needs = SamSimulationGetNeeds(simulation);
  SamSimulationFiles       files;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(setup->grid->comm, &ranks));
  PetscCall(SamSimulationGetFiles(simulation, &files));
  PetscCall(EstimateKept(setup, &needs, ranks, &kept));
  bytes[0] = BytesPerCell(setup, &needs) * (double)setup->grid->cells * (needs.companion ? 1.6 : 1);
  if (files.checkpoint) bytes[0] += CHECKPOINT_BYTES * (double)setup->grid->cells;
  bytes[1] = SAM_MEMORY_PROGRAM + (files.checkpoint || files.output ? FILE_BYTES : 0);
  bytes[0] += bytes[1] + kept + BytesOfGradients(setup, &needs, ranks);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects a run for which a node does not have enough memory. */
static PetscErrorCode RefuseTooLarge(SamSimulation simulation, const SamOptions *from)
{
  double          bytes[2];
  char            cells[64];
  const SamSetup *setup = SamSimulationGetSetup(simulation);

  PetscFunctionBegin;
  PetscCall(EstimateMemory(simulation, bytes));
  PetscCall(PetscSNPrintf(cells, sizeof(cells), "%" PetscInt_FMT ",%" PetscInt_FMT, setup->grid->nx, setup->grid->ny));
  PetscCall(SamOptionsHeading(from, "Memory"));
  PetscCall(SamMemoryRefuse(from->comm, bytes[0], "-grid_n", cells, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the run ---- */

/* Prints a line about a trial for -accuracy. */
static PetscErrorCode TellTrial(const char text[])
{
  PetscBool quiet = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-quiet", &quiet, NULL));
  if (!quiet) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(void *context, const SamArguments *arguments)
{
  static const char *const  later[] = {"-profile", "-quiet", "-progress", "-dry_run", "-memory_check", NULL};
  static const SamOptionRow dry     = {"dry_run", "check everything, print memory, disk and time, and solve nothing",
                                       SAM_OPTION_BOOL, .member = 0};
  SamRun *const             run     = (SamRun *)context;
  const SamOptions          from    = {PETSC_COMM_WORLD, NULL};
  SamSimulationFiles        files;

  PetscFunctionBegin;
  PetscCall(ReleaseTerm());
  run->accuracy.tell  = TellTrial;
  run->accuracy.later = later;
  PetscCall(SamAccuracyChoose(&from, arguments, &run->accuracy));
  PetscCall(SamSimulationCreate(from.comm, &run->simulation));
  PetscCall(SamSimulationSetSignals(run->simulation, signaled));
  PetscCall(SamSimulationSetFromOptions(run->simulation, &from, arguments));
  PetscCall(SamReportCreateFromOptions(&from, &run->report));
  SamReportSetAccuracy(run->report, &run->accuracy);
  PetscCall(SamOptionsRead(&from, NULL, 1, &dry, &run->dry, NULL));
  PetscCall(SamSimulationGetFiles(run->simulation, &files));
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
    double bytes[2];

    PetscCall(EstimateMemory(run->simulation, bytes));
    PetscCall(SamReportBanner(run->report, SamSimulationGetSetup(run->simulation), bytes, news->start));
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
  if (!run->dry) PetscCall(SamReportClosing(run->report, SamSimulationGetSetup(run->simulation)->contact));
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

  CatchSignals();
  return SamProgramMain(&petsam, argc, argv);
}
