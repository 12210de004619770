/* A wear simulation (life): cycles are computed and written one at a time, then some cycles are jumped over. */
#include "run.h"
#include <petsam/private/state.h>
#include <petsam/private/wear.h>
#include <petsam/private/contact.h>

/* Error of a fixed jump above which a warning is given */
#define LARGE 0.1
/* Number of cycles that wear as much as a single step may, below which the unit of the coefficient is questioned */
#define FAST 0.1
/* Change of the plastic strain in a cycle that is told, over the tolerance of jumps, after this number of cycles */
#define FLOWS   0.1
#define SETTLES 20

/* ---- callbacks of the life ---- */

/* Computes the time of a step in the life: all cycles take as long as the first one. */
static PetscErrorCode TimeOf(SamSimulation s, PetscReal cycles, PetscReal *time)
{
  const PetscInt   start = SamLifeOptionsGetStart(&s->plan, s->history);
  const SamControl last  = SamHistoryGetStep(s->history, s->needs.steps - 1);

  PetscFunctionBegin;
  *time += cycles * (last.time - (start ? SamHistoryGetStep(s->history, start - 1).time : 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the cycle, and the time in the life, in the numbers of the tried step. */
static PetscErrorCode Place(SamSimulation s, PetscReal cycles, PetscReal time)
{
  SamState state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  if (!SamStateHasTried(state)) PetscCall(SamStateBegin(state)); /* a jump has failed, not a step */
  *SamStateNumbers(state, SamStateFindNumber(state, "cycle"), SAM_TRIED) = (double)cycles;
  *SamStateNumbers(state, SamStateFindNumber(state, "time"), SAM_TRIED)  = (double)time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a step of a computed cycle. */
static PetscErrorCode WriteStep(void *context, PetscInt step, PetscReal cycles, const SamStep *result)
{
  const SamSimulation s      = (SamSimulation)context;
  SamStep             told   = *result;
  const PetscBool     failed = told.status == SAM_STATUS_NOT_CONVERGED;
  PetscBool           due;
  const PetscInt      start = SamLifeOptionsGetStart(&s->plan, s->history);

  PetscFunctionBegin;
  due =
    (PetscBool)(SamLifeOptionsIsOutput(&s->plan, cycles) && SamSimulationSaves(s, step + 1, s->needs.steps - start));
  if (!step) s->last_time = PETSC_NINFINITY; /* the fields of the step before belong to no step in the file */
  PetscCall(TimeOf(s, cycles, &told.control.time));
  PetscCall(Place(s, cycles, told.control.time));
  PetscCall(SamSimulationRecordTangent(s, &told));
  s->point.steps++;
  PetscCall(SamSimulationNotify(
    s, &(SamSimulationEvent){.kind = SAM_NOTIFY_CYCLE_STEP, .step = s->point.steps - 1, .result = &told}));
  PetscCall(SamSimulationWriteStep(s, &told, due || failed));
  if (!step) SamAdviceBeginCycle(&s->advice);
  if (!step && SamLifeOptionsIsOutput(&s->plan, cycles)) SamAdviceRenew(&s->advice);
  PetscCall(SamSimulationExamine(s, start + step, PETSC_FALSE, &told));
  s->told = SamStepIsSolved(&told) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the life ---- */

static PetscErrorCode TellMessage(SamSimulation s, const char where[], const SamStep *step)
{
  PetscFunctionBegin;
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_MESSAGE, .text = where, .result = step}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the steps up to the history's first row, where the cycle starts; they do not wear and are not written. */
static PetscErrorCode Start(SamSimulation s, PetscBool *ended)
{
  const PetscInt start = SamLifeOptionsGetStart(&s->plan, s->history);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < start && !*ended; k++) {
    SamControl control;
    SamStep    step;

    control = SamHistoryGetStep(s->history, k);
    PetscCall(SamSimulationTryStep(s, &control, &step));
    *ended = SamStepIsSolved(&step) ? PETSC_FALSE : PETSC_TRUE;
    if (*ended) {
      PetscCall(TellMessage(s, "before the first cycle", &step));
      s->point.worst = step.status;
    } else {
      PetscCall(SamSimulationCommitStep(s, &step));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks a step that failed before its cycle was written in the history, as one of the cycle after the last written
   one. */
static PetscErrorCode WriteFailure(SamSimulation s, const SamLifeReport *r)
{
  SamStep  step = r->step;
  SamState state;

  PetscFunctionBegin;
  PetscCall(TimeOf(s, r->cycles + 1, &step.control.time));
  PetscCall(Place(s, r->cycles, step.control.time));
  PetscCall(SamContactGetState(s->setup.contact, &state));
  *SamStateNumbers(state, SamStateFindNumber(state, "status"), SAM_TRIED) = step.status;
  s->point.steps++;
  PetscCall(SamSimulationWriteStep(s, &step, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationPlaceLast(SamSimulation s)
{
  const SamSolution *last;
  SamStep            step = {.status = SAM_STATUS_CONVERGED};
  SamState           state;

  PetscFunctionBegin;
  if (s->last_time > PETSC_NINFINITY || SamContactGetSteps(s->setup.contact) == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetSolution(s->setup.contact, &last));
  step.control.time = last->control.time;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(SamStateBegin(state));
  PetscCall(PetscArraycpy(SamStateNumbers(state, 0, SAM_TRIED), SamStateNumbers(state, 0, SAM_COMMITTED),
                          SamStateCountValues(state)));
  PetscCall(Place(s, 0, step.control.time));
  s->point.steps++;
  PetscCall(SamSimulationWriteStep(s, &step, PETSC_FALSE));
  PetscCall(SamContactReject(s->setup.contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reports where a step failed, or reached the edge, and ends the life there. */
static PetscErrorCode EndLife(SamSimulation s, const SamLifeReport *r, const char where[])
{
  SamStep said = r->step;
  char    text[96];

  PetscFunctionBegin;
  if (s->fast && said.status == SAM_STATUS_EDGE_CONTACT) {
    const size_t used = strlen(said.message);

    said.setting[0] = '\0'; /* no grid would contain such a scar */
    (void)snprintf(said.message + used, sizeof(said.message) - used,
                   "; the worn depth is %.3g m: check the unit of "
                   "the coefficient of wear",
                   (double)PetscMax(r->depth[0], r->depth[1]));
  } else {
    PetscCall(SamSimulationAdviseEdge(s, &said.control, &said));
  }
  (void)snprintf(text, sizeof(text), "%s %.10g cycles, step %" PetscInt_FMT " of the cycle", where, (double)r->cycles,
                 r->at + 1);
  PetscCall(TellMessage(s, text, &said));
  s->point.worst = r->step.status;
  if (!s->told) PetscCall(SamSimulationWriteLastFields(s));
  if (!s->told && !SamStepIsSolved(&r->step)) PetscCall(WriteFailure(s, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns once of a large error of a jump whose length the user has fixed. */
static PetscErrorCode WarnOfJump(SamSimulation s, const SamLifeReport *r)
{
  SamStep said = {.status = SAM_STATUS_CONVERGED, .setting = "wear_jump"};

  PetscFunctionBegin;
  if (!s->plan.life.fixed || s->warned) PetscFunctionReturn(PETSC_SUCCESS);
  if (r->error > LARGE && r->error > r->stripes)
    (void)snprintf(said.message, sizeof(said.message), "after %.10g cycles: the error of the last jump is %.2g",
                   (double)r->cycles, (double)r->error);
  s->warned = said.message[0] ? PETSC_TRUE : s->warned;
  PetscCall(TellMessage(s, "", &said));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns once of an impossibly large wear depth in a cycle. */
static PetscErrorCode WarnOfUnit(SamSimulation s, const SamLifeReport *r)
{
  char text[256];

  PetscFunctionBegin;
  if (s->fast || r->limit >= FAST) PetscFunctionReturn(PETSC_SUCCESS);
  s->fast = PETSC_TRUE;
  (void)snprintf(text, sizeof(text),
                 "a cycle wears %.2g times the limit of a step, 1.16 (p/E*) h, h the cell width: check the unit of the "
                 "coefficient, 1/Pa or m3/J (1 mm3/(N m) is 1e-9 1/Pa)",
                 1 / (double)r->limit);
  PetscCall(SamSimulationWarn(s, text, ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns once of steps that slide far over the contact, or leave a tip of pressure. */
static PetscErrorCode WarnOfStride(SamSimulation s, const SamLifeReport *r)
{
  char advice[192], text[256];

  PetscFunctionBegin;
  PetscCall(SamWearAdviseStride(r->stride, advice, sizeof(advice)));
  if (!advice[0]) PetscCall(SamWearAdviseTip(r->tip, advice, sizeof(advice)));
  if (s->stripes || !advice[0]) PetscFunctionReturn(PETSC_SUCCESS);
  s->stripes = PETSC_TRUE;
  (void)snprintf(text, sizeof(text), "after %.10g cycles: %s", (double)r->cycles, advice);
  PetscCall(SamSimulationWarn(s, text, "steps"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Warns once of jumps that are short because a body goes on yielding. */
static PetscErrorCode WarnOfFlow(SamSimulation s, const SamLifeReport *r)
{
  const SamLifeSettings *set = &s->plan.life;
  char                   text[256];

  PetscFunctionBegin;
  if (s->flows || r->computed < SETTLES || !(r->flow > FLOWS * set->rtol)) PetscFunctionReturn(PETSC_SUCCESS);
  s->flows = PETSC_TRUE;
  (void)snprintf(text, sizeof(text),
                 "after %.10g cycles: plastic strain changes by %.2g %% of its maximum in a cycle: it has not shaken "
                 "down, and jumps %s",
                 (double)r->cycles, 100 * (double)r->flow,
                 set->fixed ? "omit what it changes in the cycles between"
                            : "are short, so that it changes by less than -wear_rtol");
  PetscCall(SamSimulationWarn(s, text, ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reports once for each body that its first material is worn through; `ended`: the life ends there on request. */
static PetscErrorCode WarnOfWorn(SamSimulation s, const SamLifeReport *r, PetscBool *ended)
{
  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) {
    char worn[160], text[224];

    PetscCall(SamLifeDescribeWorn(s->life, r, b, worn, sizeof(worn)));
    if (!worn[0]) continue;
    *ended = *ended || s->plan.stop_worn;
    if (s->worn[b]) continue;
    s->worn[b] = PETSC_TRUE;
    (void)snprintf(text, sizeof(text), "after %.10g cycles: %s", (double)r->cycles, worn);
    PetscCall(SamSimulationWarn(s, text, ""));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes a cycle and writes it; `ended`: it failed, or was the last one. */
static PetscErrorCode ComputeCycle(SamSimulation s, PetscBool *ended)
{
  SamLifeReport r;

  PetscFunctionBegin;
  PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_CYCLE_BEGINS}));
  PetscCall(SamLifeCompute(s->life, &r));
  *ended = r.cycles >= s->plan.cycles || r.step.status != SAM_STATUS_CONVERGED;
  if (r.step.status != SAM_STATUS_CONVERGED) PetscCall(EndLife(s, &r, "after"));
  if (!SamStepIsSolved(&r.step)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!s->warned && r.step.status == SAM_STATUS_CONVERGED) PetscCall(TellMessage(s, "", &r.step));
  s->warned = r.step.message[0] ? PETSC_TRUE : s->warned;
  PetscCall(WarnOfJump(s, &r));
  PetscCall(WarnOfUnit(s, &r));
  PetscCall(WarnOfStride(s, &r));
  PetscCall(WarnOfFlow(s, &r));
  PetscCall(WarnOfWorn(s, &r, ended));
  s->writing = PETSC_TRUE;
  PetscCall(SamLifeRecord(s->life, &r));
  if (s->output) PetscCall(SamOutputWriteCycle(s->output));
  s->writing = PETSC_FALSE;
  s->point.rows++;
  PetscCall(SamSimulationNotify(
    s, &(SamSimulationEvent){.kind = SAM_NOTIFY_CYCLE, .cycle = SamLifeGetSeries(s->life), .cycles = s->plan.cycles}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Jump(SamSimulation s, PetscBool *ended)
{
  SamLifeReport r;

  PetscFunctionBegin;
  PetscCall(SamLifeJump(s->life, SamLifeOptionsNextStop(&s->plan, SamLifeGetState(s->life).cycles), &r));
  *ended = SamStepIsSolved(&r.step) ? PETSC_FALSE : PETSC_TRUE;
  if (*ended) PetscCall(EndLife(s, &r, "in the cycles after"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationLive(SamSimulation s)
{
  PetscBool ended = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamSimulationBeginCycles(s));
  if (!s->point.restarted) PetscCall(Start(s, &ended));
  while (!ended && !s->stopped) {
    PetscCall(ComputeCycle(s, &ended));
    if (!ended) PetscCall(Jump(s, &ended));
    if (!ended) PetscCall(SamSimulationCheckpoint(s));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCreateLife(SamSimulation s)
{
  SamLifeCycle       cycle = {.control = SamSimulationCycleControl,
                              .solved  = WriteStep,
                              .commits = SamSimulationRecordCycleStep,
                              .jumps   = SamSimulationRecordJump,
                              .context = s};
  SamOutputSettings *set   = &s->output_settings;

  PetscFunctionBegin;
  if (s->plan.cycles == 0) PetscFunctionReturn(PETSC_SUCCESS);
  cycle.steps = s->needs.steps - SamLifeOptionsGetStart(&s->plan, s->history);
  PetscCall(SamLifeCreate(s->setup.contact, &cycle, &s->plan.life, &s->life));
  set->cycles      = SamLifeGetSeries(s->life);
  set->cycles_name = "wear";
  PetscFunctionReturn(PETSC_SUCCESS);
}
