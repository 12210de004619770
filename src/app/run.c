/* The run: reads all options, makes the objects, solves the load steps, writes results and checkpoints. */
#include "runimpl.h"

#define FLUSH 2.0 /* s that steps without fields wait to be written */

/* ---- set-up ---- */

/* Refuses bulk stress of a rigid body, and of periodic ones. */
static PetscErrorCode CheckBulkStress(const SamRun *run, const SamControl *control, PetscBool periodic,
                                      const SamOptions *from)
{
  const char *prefix = SamOptionsPrefix(from);

  PetscFunctionBegin;
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) {
      const double stress = (double)control->bulk_stress[body][k], young = (double)run->setup.pair.young[body];

      PetscCheck(fabs(stress) <= young, from->comm, SAM_ERR_USER,
                 "-%s%s, or its column in -history: %g is more than Young's modulus, %g", prefix,
                 SamBulkNames[body][k].name, stress, young);

      PetscCheck(stress == 0 || !isinf(run->setup.pair.young[body]), from->comm, SAM_ERR_USER,
                 "-%s%s, or its column in -history: %g: -%sbody%" PetscInt_FMT
                 "_young is inf: a rigid body does not stretch",
                 prefix, SamBulkNames[body][k].name, stress, prefix, body + 1);
      PetscCheck(stress == 0 || !periodic, from->comm, SAM_ERR_USER,
                 "-%s%s, or its column in -history: %g: has no meaning with -%selasticity periodic: stretched bodies "
                 "are not periodic",
                 prefix, SamBulkNames[body][k].name, stress, prefix);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses moments, rotations and bulk stress where the bodies have none, by the name that the user gave. */
static PetscErrorCode CheckComponents(SamRun *run, const SamOptions *from)
{
  SamElasticityTraits traits;
  SamElasticityType   type;
  PetscInt            count;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetTraits(run->setup.elasticity, &traits));
  PetscCall(SamElasticityGetType(run->setup.elasticity, &type));
  PetscCall(SamHistoryGetCount(run->history, &count));
  for (PetscInt k = 0; k < count; k++) {
    SamControl control;

    PetscCall(SamHistoryGetStep(run->history, k, &control));
    PetscCall(CheckBulkStress(run, &control, !traits.rotations, from));
    for (PetscInt c = SAM_COMPONENT_MX; c < SAM_COMPONENTS && !traits.rotations; c++)
      PetscCheck(control.value[c] == 0, from->comm, SAM_ERR_USER,
                 "-%s%s %g: has no meaning with -%selasticity %s: moments and rotations are not periodic",
                 SamOptionsPrefix(from), control.force[c] ? SamComponentNames[c].load : SamComponentNames[c].rigid,
                 (double)control.value[c], SamOptionsPrefix(from), type);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads what wears; a table of friction gives the problem its coefficient at the start. */
static PetscErrorCode ReadWear(SamRun *run, const SamOptions *from)
{
  SamWearing *const w = &run->wearing;
  PetscBool         help;
  PetscReal         limit;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamWearingSetFromOptions(w, from));
  if (!help) PetscCall(SamWearingCheckCycle(w, run->history, from));
  if (w->points) PetscCall(SamProblemSetFriction(run->setup.problem, w->friction[0]));
  PetscCall(SamProblemHasFriction(run->setup.problem, &run->needs.friction));
  PetscCheck(!w->laws.on || run->needs.friction || help, from->comm, SAM_ERR_USER,
             "-wear_coefficient or -wear_energy is given without -friction: surfaces wear where friction acts");
  run->needs.wear = w->laws.on;
  run->needs.life = w->cycles > 0;
  PetscCall(SamProblemGetPressureLimit(run->setup.problem, &limit));
  PetscCheck(isinf(limit) || !run->needs.life || help, from->comm, SAM_ERR_USER,
             "-wear_cycles with -pressure_limit: cycles are jumped over by their wear, and do not know how much the "
             "surfaces yield in those between: repeat the rows in -history instead, or leave one of the two away");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadOptions(SamRun *run, const SamArguments *arguments, const SamOptions *from)
{
  static const char *const sums[] = {"slip_path", "friction_energy"};
  SamElasticityTraits      traits;
  PetscBool                help;
  PetscReal                limit;
  char                     edges[16] = "";

  PetscFunctionBegin;
  PetscCall(SamSetupReadOptions(&run->setup, from));
  PetscCall(SamElasticityGetTraits(run->setup.elasticity, &traits));
  run->needs.coupled = traits.coupled;
  PetscCall(PetscOptionsGetString(NULL, from->prefix, "-edges", edges, sizeof(edges), NULL)); /* the contact's, later */
  run->needs.deferred = strcmp(edges, "deferred") ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(SamHistoryCreateFromOptions(from, arguments, &run->history));
  PetscCall(SamHistoryGetCount(run->history, &run->needs.steps));
  run->point.history = run->history;
  PetscCall(ReadWear(run, from));
  PetscCall(CheckComponents(run, from));
  PetscCall(SamReportCreateFromOptions(from, &run->report));
  PetscCall(SamCheckpointsCreateFromOptions(from, &run->checkpoints));
  run->restart_gap = SamCheckpointsChangeGap(run->checkpoints);
  PetscCall(SamOptionsHeading(from, "Results and resources"));
  PetscCall(
    SamOptionsFile(from, "output", "HDF5 file of the results", run->filename, sizeof(run->filename), &run->has_output));
  run->output_every = 1;
  PetscCall(SamOptionsInt(from, "output_every", "write the fields of every m-th step, and of the last", 1,
                          &run->output_every, NULL));
  PetscCall(SamOptionsBool(from, "stiffness", "tangent stiffness of every step, for steps that go on and reverse",
                           &run->needs.stiffness, NULL));
  PetscCall(SamOutputSettingsSetFromOptions(&run->output_settings, from));
  run->output_settings.flush = FLUSH;
  PetscCall(SamOptionsReal(from, "output_flush", "s that steps without fields may wait to be written, 0: none",
                           SAM_RANGE_NONNEGATIVE, &run->output_settings.flush, NULL));
  run->output_settings.with[SAM_OUTPUT_STIFFNESS] = run->needs.stiffness;
  for (size_t k = 0; k < 2; k++) run->needs.sums += SamOutputSettingsHas(&run->output_settings, sums[k]);
  PetscCall(SamProblemGetPressureLimit(run->setup.problem, &limit));
  run->needs.plastic                            = isfinite(limit) != 0;
  run->output_settings.with[SAM_OUTPUT_PLASTIC] = run->needs.plastic;
  PetscCall(SamPrintHelp(&help));
  PetscCheck(!run->needs.stiffness || run->has_output || help, from->comm, SAM_ERR_USER,
             "-stiffness is given without -output, the file that it goes to");
  PetscCall(SamHistoryHas(run->history, &run->output_settings.with[SAM_OUTPUT_FRICTION_SCALE],
                          &run->output_settings.with[SAM_OUTPUT_BULK_STRESS]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunSetUp(SamRun *run, const SamArguments *arguments)
{
  const SamOptions from = {PETSC_COMM_WORLD, NULL};
  PetscBool        help;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  PetscCall(ReadOptions(run, arguments, &from));
  PetscCall(SamRunCheckFiles(run, from.comm, arguments));
  PetscCall(SamRunRefuseTooLarge(run->setup.grid, &run->needs, &from));
  PetscCall(SamSetupCreateContact(&run->setup, &from));
  if (!help) PetscCall(SamOutputSettingsPrepare(&run->output_settings, run->setup.contact));
  PetscCall(SamContactGetSpots(run->setup.contact, &run->output_settings.with[SAM_OUTPUT_SPOTS]));
  if (!help) PetscCall(SamRunCreateWear(run));
  if (!help) PetscCall(SamOutputSettingsCheck(&run->output_settings, &from));
  if (!help) PetscCall(SamRunCollectParameters(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunTearDown(SamRun *run)
{
  PetscFunctionBegin;
  PetscCall(SamOutputDestroy(&run->output));
  PetscCall(SamCheckpointsDestroy(&run->checkpoints));
  PetscCall(SamReportDestroy(&run->report));
  PetscCall(SamLifeDestroy(&run->life));
  PetscCall(SamWearDestroy(&run->wear));
  PetscCall(SamWearingDestroy(&run->wearing));
  PetscCall(SamHistoryDestroy(&run->history));
  PetscCall(SamSetupDestroy(&run->setup));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- results ---- */

/* Restores the state of a stopped run, if there is one, opens the results, and prints the banner. */
static PetscErrorCode Begin(SamRun *run)
{
  const char *checkpoint, *restart;
  char        results[PETSC_MAX_PATH_LEN + 32], size[64] = "";
  PetscBool   replaced = PETSC_FALSE;

  PetscFunctionBegin;
  run->last_time = PETSC_NINFINITY;
  PetscCall(SamCheckpointsGetNames(run->checkpoints, &checkpoint, &restart));
  if (restart) PetscCall(SamCheckpointsRestart(run->checkpoints, run->setup.contact, &run->parameters, &run->point));
  if (restart) PetscCall(SamReportSetRestart(run->report, restart, &run->point));
  PetscCall(SamCheckpointsBegin(run->checkpoints, run->setup.grid));
  if (run->has_output) PetscCall(SamRunOpenResults(run, restart));
  run->point.output = run->output;
  if (run->output) PetscCall(SamOutputHasReplaced(run->output, &replaced));
  if (run->output) PetscCall(SamRunForecast(run, size, sizeof(size)));
  PetscCall(PetscSNPrintf(results, sizeof(results), "%s%s", run->filename, replaced ? ", replacing those there" : ""));
  SamCheckpointsDescribe(run->checkpoints, run->checkpoint_text, sizeof(run->checkpoint_text));
  if (checkpoint) PetscCall(SamReportSetCheckpoints(run->report, run->checkpoint_text));
  PetscCall(SamReportBanner(run->report, run->setup.grid, SamRunMemory(run->setup.grid, &run->needs), run->needs.steps,
                            run->has_output ? results : NULL, size));
  PetscCall(SamRunPrepareAdvice(run, run->life ? 0 : PetscMin(run->point.steps, run->needs.steps - 1)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunWriteLastFields(SamRun *run)
{
  PetscReal saved;

  PetscFunctionBegin;
  if (!run->output) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOutputGetSaved(run->output, NULL, NULL, &saved));
  if (run->last_time <= saved) PetscFunctionReturn(PETSC_SUCCESS);
  run->writing = PETSC_TRUE;
  PetscCall(SamOutputWriteFields(run->output, run->last_time, run->setup.contact));
  run->writing = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunWriteStep(SamRun *run, const SamStep *step, PetscBool due)
{
  const PetscBool none = step->status == SAM_STATUS_NO_EQUILIBRIUM;

  PetscFunctionBegin;
  if (!run->output) PetscFunctionReturn(PETSC_SUCCESS);
  if (none) PetscCall(SamRunWriteLastFields(run));
  run->writing = PETSC_TRUE;
  PetscCall(SamOutputWriteStep(run->output, step, due && !none ? run->setup.contact : NULL));
  run->writing   = PETSC_FALSE;
  run->last_time = step->control.time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Closes the results before the closing table, which prints their size. */
static PetscErrorCode FinishResults(SamRun *run)
{
  char        content[96];
  const char *xdmf;
  PetscInt    steps, saved;

  PetscFunctionBegin;
  if (!run->output) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOutputGetSaved(run->output, &steps, &saved, NULL));
  PetscCall(PetscSNPrintf(content, sizeof(content), "%" PetscInt_FMT " step%s, fields of %" PetscInt_FMT, steps,
                          steps == 1 ? "" : "s", saved));
  PetscCall(SamReportAddFile(run->report, run->filename, content));
  PetscCall(SamOutputGetXdmf(run->output, &xdmf));
  if (xdmf) PetscCall(SamReportAddFile(run->report, xdmf, "the same for ParaView and VisIt"));
  run->writing = PETSC_TRUE;
  PetscCall(SamOutputDestroy(&run->output));
  run->writing = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReportCheckpoint(SamRun *run)
{
  const char *checkpoint, *restart;
  char        content[96];
  PetscInt    last;

  PetscFunctionBegin;
  PetscCall(SamCheckpointsGetNames(run->checkpoints, &checkpoint, &restart));
  PetscCall(SamCheckpointsGetLast(run->checkpoints, &last));
  PetscCall(PetscSNPrintf(content, sizeof(content), "checkpoint after step %" PetscInt_FMT, last));
  if (last) PetscCall(SamReportAddFile(run->report, checkpoint, content));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps ---- */

/* What the tried step wears; the gap follows only when the step has been written. */
static PetscErrorCode WearStep(SamRun *run, SamStep *step)
{
  PetscReal depth[2];

  PetscFunctionBegin;
  if (!run->wear) PetscFunctionReturn(PETSC_SUCCESS);
  if (SamStepIsSolved(step)) {
    PetscCall(SamWearCountStep(run->wear));
    PetscCall(SamWearApply(run->wear, 1));
  }
  PetscCall(SamWearGetVolumes(run->wear, step->wear_volume, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunComputeStiffness(SamRun *run, SamStep *step)
{
  PetscFunctionBegin;
  if (!run->needs.stiffness || !SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < SAM_STIFFNESS_DIRECTIONS; k++) {
    SamStiffness s;

    PetscCall(SamStiffnessCompute(run->setup.contact, (SamStiffnessDirection)k, &s));
    PetscCall(PetscMemcpy(step->stiffness[k], s.k, sizeof(s.k)));
    if (!s.converged && !step->message[0])
      PetscCall(PetscSNPrintf(step->message, sizeof(step->message),
                              "the tangent stiffness did not converge: relative residual %.2g", (double)s.error));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Solves one load step; `ended`: it failed, so that no further step can be solved, or the contact is at the edge of the
  grid, so that none should.
*/
static PetscErrorCode SolveStep(SamRun *run, PetscBool *ended)
{
  const PetscInt k = run->point.steps, last = run->needs.steps - 1;
  SamControl     control;
  SamStep        step;
  PetscBool      due;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetStep(run->history, k, &control));
  PetscCall(SamReportBeginStep(run->report, k, run->setup.contact));
  PetscCall(SamContactTry(run->setup.contact, &control, &step));
  PetscCall(SamRunComputeStiffness(run, &step));
  PetscCall(WearStep(run, &step));
  PetscCall(SamRunAdviseEdge(run, &step));
  *ended = step.status == SAM_STATUS_CONVERGED ? PETSC_FALSE : PETSC_TRUE;
  due    = (k + 1) % run->output_every == 0 || k == last || *ended;
  PetscCall(SamRunWriteStep(run, &step, due));
  PetscCall(SamReportEndStep(run->report, &step)); /* after writing: a reported step is in the file */
  PetscCall(SamRunExamine(run, k, &step));
  if (run->wear && SamStepIsSolved(&step)) PetscCall(SamRunExamineWear(run, k));
  if (!*ended) PetscCall(SamContactCommit(run->setup.contact));
  if (!*ended && run->wear) PetscCall(SamWearMoveGap(run->wear));
  if (*ended || !run->point.worst) run->point.worst = step.status;
  run->point.steps++;
  run->point.times = SamOutputAddTime(run->point.times, control.time);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunCheckpoint(SamRun *run)
{
  PetscFunctionBegin;
  run->writing = PETSC_TRUE;
  PetscCall(
    SamCheckpointsAfterStep(run->checkpoints, run->setup.contact, &run->parameters, &run->point, &run->stopped));
  run->writing = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the remaining steps; ends early when a step fails, or with a checkpoint. */
static PetscErrorCode SolveSteps(SamRun *run)
{
  PetscBool ended = PETSC_FALSE;

  PetscFunctionBegin;
  while (run->point.steps < run->needs.steps && !ended && !run->stopped) {
    PetscCall(SolveStep(run, &ended));
    if (!ended) PetscCall(SamRunCheckpoint(run));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunSolve(SamRun *run)
{
  PetscFunctionBegin;
  PetscCall(Begin(run));
  if (run->life)
    PetscCall(SamRunLive(run));
  else
    PetscCall(SolveSteps(run));
  PetscCall(FinishResults(run));
  PetscCall(ReportCheckpoint(run));
  PetscCall(SamReportClosing(run->report));
  PetscFunctionReturn(PETSC_SUCCESS);
}
