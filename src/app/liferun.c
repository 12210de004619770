/* The life of a joint in a run: a cycle at a time is computed and written, then some are jumped over. */
#include "runimpl.h"

/* An error of a fixed jump that is told. */
#define LARGE 0.1

/* ---- what the life asks for ---- */

/* Step `step` of the cycle; the steps before, up to the history's first row, lead to its start. */
static PetscErrorCode Control(void *context, PetscInt step, PetscReal cycles, SamControl *control)
{
  const SamRun *run = (const SamRun *)context;
  PetscInt      start;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetStart(run->history, &start));
  PetscCall(SamHistoryGetStep(run->history, start + step, control));
  control->friction_scale *= SamWearingFriction(&run->wearing, cycles);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The time of a step in the life: all cycles take as long as the first one. */
static PetscErrorCode TimeOf(const SamRun *run, PetscReal cycles, PetscReal *time)
{
  SamControl first, last;
  PetscInt   start;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetStart(run->history, &start));
  PetscCall(SamHistoryGetStep(run->history, start - 1, &first));
  PetscCall(SamHistoryGetStep(run->history, run->needs.steps - 1, &last));
  *time += cycles * (last.time - first.time);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a step of a computed cycle. */
static PetscErrorCode WriteStep(void *context, PetscInt step, PetscReal cycles, const SamStep *result)
{
  SamRun *const   run    = (SamRun *)context;
  SamStep         told   = *result;
  const PetscBool failed = told.status == SAM_STATUS_NOT_CONVERGED;
  PetscInt        start;
  PetscReal       depth[2];
  PetscBool       due;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetStart(run->history, &start));
  due = SamWearingIsOutput(&run->wearing, cycles) &&
        ((step + 1) % run->output_every == 0 || step + 1 == run->needs.steps - start);
  if (!step) run->last_time = PETSC_NINFINITY; /* the fields of the step before are not those of a step in the file */
  told.cycle = cycles;
  PetscCall(TimeOf(run, cycles, &told.control.time));
  PetscCall(SamWearGetVolumes(run->wear, told.wear_volume, depth));
  PetscCall(SamRunComputeStiffness(run, &told));
  run->point.steps++;
  run->point.times = SamOutputAddTime(run->point.times, told.control.time);
  PetscCall(SamReportCountStep(run->report, run->point.steps, &told));
  PetscCall(SamRunWriteStep(run, &told, due || failed));
  PetscCall(SamRunExamine(run, start + step, &told));
  run->told = SamStepIsSolved(&told) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the life ---- */

/* Solves the steps up to the history's first row, where the cycle starts. They do not wear and are not written. */
static PetscErrorCode Start(SamRun *run, PetscBool *ended)
{
  PetscInt start;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetStart(run->history, &start));
  for (PetscInt k = 0; k < start && !*ended; k++) {
    SamControl control;
    SamStep    step;

    PetscCall(SamHistoryGetStep(run->history, k, &control));
    PetscCall(SamContactTry(run->setup.contact, &control, &step));
    *ended = SamStepIsSolved(&step) ? PETSC_FALSE : PETSC_TRUE;
    if (*ended) {
      PetscCall(SamReportMessage(run->report, "before the first cycle", &step));
      run->point.worst = step.status;
    } else {
      PetscCall(SamContactCommit(run->setup.contact));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks in the history a step that failed before its cycle was written, as one of the cycle after the last written. */
static PetscErrorCode WriteFailure(SamRun *run, const SamLifeReport *r)
{
  SamStep step = r->step;

  PetscFunctionBegin;
  step.cycle = r->cycles;
  PetscCall(TimeOf(run, r->cycles + 1, &step.control.time));
  PetscCall(PetscArraycpy(step.wear_volume, r->volume, 2));
  run->point.steps++;
  PetscCall(SamRunWriteStep(run, &step, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says where a step failed, or reached the edge, and ends the life there. */
static PetscErrorCode EndLife(SamRun *run, const SamLifeReport *r, const char where[])
{
  SamStep said = r->step;
  char    text[96];

  PetscFunctionBegin;
  PetscCall(SamRunAdviseEdge(run, &said));
  (void)snprintf(text, sizeof(text), "%s %.10g cycles, step %" PetscInt_FMT " of the cycle", where, (double)r->cycles,
                 r->at + 1);
  PetscCall(SamReportMessage(run->report, text, &said));
  run->point.worst = r->step.status;
  if (!run->told) PetscCall(SamRunWriteLastFields(run));
  if (!run->told && !SamStepIsSolved(&r->step)) PetscCall(WriteFailure(run, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A jump that is beyond all bounds because the user has fixed it, once. */
static PetscErrorCode WarnOfJump(SamRun *run, const SamLifeReport *r)
{
  const SamLifeSettings *set  = &run->wearing.life;
  SamStep                said = {.status = SAM_STATUS_CONVERGED, .setting = "wear_jump"};

  PetscFunctionBegin;
  if (!set->fixed || run->warned) PetscFunctionReturn(PETSC_SUCCESS);
  if (set->type == SAM_LIFE_EXPLICIT && r->jump > r->limit)
    (void)snprintf(said.message, sizeof(said.message),
                   "after %.10g cycles: explicit jumps over more than %.4g cycles are not stable: pressure and depth "
                   "are wrong",
                   (double)r->cycles, (double)r->limit);
  else if (r->error > LARGE)
    (void)snprintf(said.message, sizeof(said.message), "after %.10g cycles: the error of the last jump is %.2g",
                   (double)r->cycles, (double)r->error);
  run->warned = said.message[0] ? PETSC_TRUE : run->warned;
  PetscCall(SamReportMessage(run->report, "", &said));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes a cycle and writes it; `ended`: it failed, or was the last one. */
static PetscErrorCode ComputeCycle(SamRun *run, PetscBool *ended)
{
  SamLifeReport r;

  PetscFunctionBegin;
  PetscCall(SamReportBeginCycle(run->report, run->setup.contact));
  PetscCall(SamLifeCompute(run->life, &r));
  *ended = r.cycles >= run->wearing.cycles || r.step.status != SAM_STATUS_CONVERGED;
  if (r.step.status != SAM_STATUS_CONVERGED) PetscCall(EndLife(run, &r, "after"));
  if (!SamStepIsSolved(&r.step)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!run->warned && r.step.status == SAM_STATUS_CONVERGED) PetscCall(SamReportMessage(run->report, "", &r.step));
  run->warned = r.step.message[0] ? PETSC_TRUE : run->warned;
  PetscCall(WarnOfJump(run, &r));
  run->writing = PETSC_TRUE;
  if (run->output) PetscCall(SamOutputWriteCycle(run->output, &r));
  run->writing = PETSC_FALSE;
  run->point.rows++;
  PetscCall(SamReportEndCycle(run->report, &r, run->wearing.cycles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Jump(SamRun *run, PetscBool *ended)
{
  SamLifeState  state;
  SamLifeReport r;

  PetscFunctionBegin;
  PetscCall(SamLifeGetState(run->life, &state));
  PetscCall(SamLifeJump(run->life, SamWearingNextStop(&run->wearing, state.cycles), &r));
  *ended = SamStepIsSolved(&r.step) ? PETSC_FALSE : PETSC_TRUE;
  if (*ended) PetscCall(EndLife(run, &r, "in the cycles after"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunLive(SamRun *run)
{
  PetscBool ended = PETSC_FALSE;

  PetscFunctionBegin;
  if (!run->point.restarted) PetscCall(Start(run, &ended));
  while (!ended && !run->stopped) {
    PetscCall(ComputeCycle(run, &ended));
    if (!ended) PetscCall(Jump(run, &ended));
    if (!ended) PetscCall(SamRunCheckpoint(run));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunCreateWear(SamRun *run)
{
  SamLifeCycle cycle = {.control = Control, .solved = WriteStep, .context = run};
  PetscInt     start;

  PetscFunctionBegin;
  if (!run->wearing.laws.on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamWearCreate(run->setup.contact, run->wearing.laws.law, run->wearing.laws.coefficient, &run->wear));
  run->output_settings.wear                  = run->wear;
  run->output_settings.with[SAM_OUTPUT_WEAR] = PETSC_TRUE;
  run->point.wear                            = run->wear;
  if (run->wearing.cycles == 0) PetscFunctionReturn(PETSC_SUCCESS);
  run->output_settings.with[SAM_OUTPUT_LIFE] = PETSC_TRUE;
  if (run->wearing.points) run->output_settings.with[SAM_OUTPUT_FRICTION_SCALE] = PETSC_TRUE;
  PetscCall(SamHistoryGetStart(run->history, &start));
  cycle.steps = run->needs.steps - start;
  PetscCall(SamLifeCreate(run->wear, &cycle, &run->wearing.life, &run->life));
  run->point.life   = run->life;
  run->point.cycles = run->wearing.cycles;
  PetscFunctionReturn(PETSC_SUCCESS);
}
