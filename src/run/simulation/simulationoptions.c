/* Reads the options of a simulation (contact, load history or life, files), and rejects incompatible ones. */
#include "run.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/arguments.h>
#include <petsam/private/base.h>
#include <string.h>
#include <strings.h>

#define FLUSH        2.0 /* seconds that steps without fields may wait to be written, and their lines with them */
#define FLUSH_FIELDS 0.1 /* the same of steps with fields */

/* Reads the settings of the cycles; a table of friction sets the problem's coefficient at the start. */
static PetscErrorCode ReadPlan(SamSimulation s, PetscBool given, const SamOptions *from)
{
  SamLifeOptions *const w = &s->plan;

  PetscFunctionBegin;
  PetscCall(SamLifeOptionsSetFromOptions(w, given, from));
  if (w->points) PetscCall(SamSetupSetStart(&s->setup, w->friction[0]));
  PetscCall(SamSetupFindNeeds(&s->setup, &s->needs.friction, &s->needs.laws));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MEMBER(name) offsetof(struct _n_SamSimulation, name)
static const SamOptionRow results[] =
  {{"output", "HDF5 file of the results", SAM_OPTION_OUTPUT, MEMBER(filename), .size = PETSC_MAX_PATH_LEN},
   {"output_every", "write the fields of every m-th step, and of the last", SAM_OPTION_INT, MEMBER(output_every),
    .needs = SAM_OUTPUT_NEEDED, .least = 1},
   {"output_at", "what -output_every counts: all steps, or those at rows of the history", SAM_OPTION_BOOL,
    MEMBER(output_rows), .needs = SAM_OUTPUT_NEEDED, .words = "steps,history"},
   {"stiffness", "tangent stiffness of every step, for continued loading and reversal", SAM_OPTION_BOOL,
    MEMBER(needs.stiffness), .needs = SAM_OUTPUT_NEEDED}},
                          flush = {"output_flush",
                                   "longest write delay () of steps without fields, 0: none",
                                   SAM_OPTION_REAL,
                                   MEMBER(output_settings.flush),
                                   .range = SAM_RANGE_NONNEGATIVE,
                                   .unit  = "s",
                                   .needs = SAM_OUTPUT_NEEDED};

static PetscErrorCode ReadResults(SamSimulation s, const SamOptions *from)
{
  PetscBool   given[sizeof(results) / sizeof(results[0])];
  const char *ending;

  PetscFunctionBegin;
  s->output_every = 1;
  PetscCall(SamOptionsRead(from, "Results and resources", SAM_OPTION_ROWS(results), s, given));
  s->has_output = given[0];
  ending        = strrchr(s->filename, '.');
  PetscCheck(!ending || strcasecmp(ending, ".csv"), from->comm, SAM_ERR_USER,
             "-output %s: the results are an HDF5 file: name it .h5", s->filename);
  PetscCall(SamOutputSettingsSetFromOptions(&s->output_settings, from));
  s->output_settings.flush = FLUSH;
  PetscCall(SamOptionsRead(from, NULL, 1, &flush, s, NULL));
  s->output_settings.flush_fields = PetscMin(s->output_settings.flush, FLUSH_FIELDS);
  PetscCall(SamOutputSettingsAddLaws(&s->output_settings, s->setup.problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFiles(SamSimulation s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamSimulationReadCheckpoints(s, from));
  PetscCall(ReadResults(s, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes over a load history, and `cycles` repetitions of it (0: it runs once). */
static PetscErrorCode SetProgram(SamSimulation s, SamHistory history, PetscReal cycles, const SamOptions *from)
{
  PetscFunctionBegin;
  if (s->history != history) PetscCall(SamHistoryDestroy(&s->history));
  s->history     = history;
  s->advice      = (SamAdvice){.setup = &s->setup, .receive = SamSimulationWarn, .context = s, .most.open = s->has_gap};
  s->needs.life  = cycles > 0;
  s->needs.steps = SamHistoryGetCount(history);
  if (SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(s->step_rtol == 0 || s->needs.friction, from->comm, SAM_ERR_USER,
             "-step_rtol without -friction: no energy is dissipated: give -friction, or remove it");
  PetscCheck(s->step_rtol == 0 || !s->needs.life, from->comm, SAM_ERR_USER,
             "-step_rtol with -wear_cycles: all computed cycles must have the same load steps: use -steps");
  PetscCall(SamLifeOptionsSetCycles(&s->plan, cycles, s->setup.problem, from));
  PetscCall(SamLifeOptionsCheckCycle(&s->plan, history, s->setup.problem, from));
  PetscCall(SamSimulationCheckProgram(s, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationSetFromOptions(SamSimulation s, const SamOptions *from, const SamArguments *arguments)
{
  PetscFunctionBegin;
  PetscCall(SamSetupReadOptions(&s->setup, from));
  PetscCall(SamHistoryCreateFromOptions(from, arguments, s->setup.conditions, &s->history));
  PetscCall(SamSimulationReadPieces(s, from));
  PetscCall(ReadPlan(s, PETSC_FALSE, from));
  PetscCall(SetProgram(s, s->history, s->plan.cycles, from));
  PetscCall(ReadFiles(s, from));
  PetscCall(SamErrorsReadOptions(s, from));
  PetscCall(SamSimulationReadGradients(s, from));
  if (!SamPrintHelp()) PetscCall(SamSimulationEstimateShares(s, &s->needs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses the choice of a grid for a contact whose steps are given one by one. */
static PetscErrorCode RefuseChoice(const SamOptions *from)
{
  PetscBool has[2];

  PetscFunctionBegin;
  PetscCall(SamOptionsHas(from, "accuracy", &has[0]));
  PetscCall(SamOptionsHas(from, "grid auto", &has[1]));
  PetscCheck(!has[0] && !has[1], from->comm, SAM_ERR_USER,
             "-%s%s: a grid is chosen for all loads of a run, and here steps are given one by one: give -grid_n and "
             "-grid_size",
             SamOptionsPrefix(from), has[0] ? "accuracy" : "grid auto");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationSetContactFromOptions(SamSimulation s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(RefuseChoice(from));
  PetscCall(SamSetupReadOptions(&s->setup, from));
  PetscCall(SamSimulationReadPieces(s, from));
  PetscCall(ReadPlan(s, PETSC_TRUE, from));
  PetscCall(ReadFiles(s, from));
  PetscCall(SamErrorsReadOptions(s, from));
  PetscCall(SamSimulationReadGradientMemory(s, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationSetProgram(SamSimulation s, SamHistory *history, PetscReal cycles)
{
  const SamOptions from = {s->comm, NULL};
  SamHistory       h    = *history;

  PetscFunctionBegin;
  *history = NULL;
  PetscCall(SamOutputDestroy(&s->output)); /* output of a run that ended with an error */
  PetscCall(SamLifeDestroy(&s->life));
  s->point   = (SamSimulationPoint){.steps = 0};
  s->start   = (SamSimulationStart){.steps = 0};
  s->worn[0] = s->worn[1] = PETSC_FALSE;
  s->prepared = s->stopped = s->warned = s->told = s->fast = PETSC_FALSE;
  PetscCall(SetProgram(s, h, cycles, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}
