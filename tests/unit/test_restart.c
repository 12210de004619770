/*
 * A run's checkpoints: when they are written, how far the run is in its load program, and which programs it may go on
 * with.
 */
#include "contacts.h"

#include "../../src/run/simulation/run.h"
#include <signal.h>
#include <unistd.h>

static const char file[] = "test_restart.h5";

static void Remove(void)
{
  static const char *const names[] = {"test_restart.h5", "test_restart.h5.1", "test_restart.csv"};

  for (int k = 0; k < 3; k++) RemoveFile(names[k]);
}

static SamHistory NewHistory(const char *options)
{
  SamHistory h;

  SetOptions(options);
  sam_call(SamHistoryCreateFromOptions(&(SamOptions){PETSC_COMM_WORLD, NULL}, NULL, Conditions(), &h));
  SetOptions("");
  return h;
}

/* A load program of four steps, of which the last may be another. */
static SamHistory NewProgram(const char *header, const char *second, const char *last)
{
  if (Rank() == 0) {
    FILE *stream = fopen("test_restart.csv", "w");

    if (!stream) MPI_Abort(PETSC_COMM_WORLD, 1);
    (void)fprintf(stream, "%s\n1,400,0,1\n%s\n3,400,20,1\n%s\n", header, second, last);
    (void)fclose(stream);
  }
  (void)MPI_Barrier(PETSC_COMM_WORLD);
  return NewHistory("-load_history test_restart.csv");
}

static SamHistory NewUsualProgram(void)
{
  return NewProgram("time,load_n,load_tx,friction_scale", "2,400,10,0.9", "4,400,30,1");
}

static Case NewBody(void)
{
  return NewCase(Steel(), 37, 2.5, MU, "");
}

/* A simulation of a load history, which it takes over, with the options of checkpoints; it borrows the contact. */
static SamSimulation NewSimulation(const Case *c, SamHistory history, const char *options)
{
  SamSimulation s;

  sam_call(SamSimulationCreate(PETSC_COMM_WORLD, &s));
  s->setup.grid       = c->s.grid;
  s->setup.contact    = c->contact;
  s->history          = history;
  s->setup.conditions = Conditions();
  s->needs.steps      = SamHistoryGetCount(history);
  SetOptions(options);
  sam_call(SamSimulationReadCheckpoints(s, &(SamOptions){PETSC_COMM_WORLD, NULL}));
  SetOptions("");
  return s;
}

static SamSimulation Begun(SamSimulation s)
{
  sam_call(SamSimulationBeginCheckpoints(s));
  return s;
}

static void DestroySimulation(SamSimulation s)
{
  s->setup = (SamSetup){.grid = NULL};
  sam_call(SamSimulationDestroy(&s));
}

/* Solves the next step, then writes a checkpoint if one is due; returns whether the run is to stop. */
static PetscBool TakeStep(SamSimulation s, const Case *c)
{
  SamControl control;
  SamStep    step;

  control = SamHistoryGetStep(s->history, s->point.steps);
  step    = Solve(c, &control);
  sam_assert(step.status == SAM_STATUS_CONVERGED);
  s->point.steps++;
  s->stopped = PETSC_FALSE;
  sam_call(SamSimulationCheckpoint(s));
  return s->stopped;
}

static void test_checkpoints_come_after_every_so_many_steps(void **state)
{
  static const PetscInt expected[4] = {0, 2, 2, 4};
  static const char     options[]   = "-checkpoint test_restart.h5 -checkpoint_every 2";
  Case                  c           = NewBody();
  SamSimulation         s           = Begun(NewSimulation(&c, NewUsualProgram(), options));

  (void)state;
  for (int step = 0; step < 4; step++) {
    sam_assert(!TakeStep(s, &c));
    sam_assert(s->checkpoints.last == expected[step]);
  }
  DestroySimulation(s);
  DestroyCase(&c);
  Remove();
}

/* The first signal asks for a checkpoint, the second also to stop, on any rank; nobody stops after the last step. */
static void test_signals_ask_for_checkpoints(void **state)
{
  Case          c = NewBody();
  SamSimulation s = Begun(NewSimulation(&c, NewUsualProgram(), "-checkpoint test_restart.h5"));
  int           ranks;

  volatile sig_atomic_t signals[2] = {0, 0}; /* as set by a handler */

  (void)state;
  sam_call(SamSimulationSetSignals(s, signals));
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  sam_assert(!TakeStep(s, &c) && s->checkpoints.last == 0);
  if (Rank() == ranks - 1) signals[0] = 1;
  sam_assert(!TakeStep(s, &c) && s->checkpoints.last == 2);
  if (Rank() == ranks - 1) signals[1] = 1;
  sam_assert(TakeStep(s, &c) && s->checkpoints.last == 3);
  if (Rank() == 0) signals[1] = 1;
  sam_assert(!TakeStep(s, &c) && s->checkpoints.last == 4);
  sam_assert(!signals[0] && !signals[1]); /* both have been answered */
  DestroySimulation(s);
  DestroyCase(&c);
  Remove();
}

/* No step is begun that would not end in time. */
static void test_limit_of_time_stops_with_a_checkpoint(void **state)
{
  Case          c = NewBody();
  SamSimulation s = Begun(NewSimulation(&c, NewUsualProgram(), "-checkpoint test_restart.h5 -max_walltime 1e-6"));

  (void)state;
  sam_assert(TakeStep(s, &c) && s->checkpoints.last == 1);
  DestroySimulation(s);
  s = Begun(NewSimulation(&c, NewUsualProgram(), "-checkpoint test_restart.h5 -max_walltime 10:00 -overwrite"));
  sam_assert(!TakeStep(s, &c) && s->checkpoints.last == 0);
  DestroySimulation(s);
  DestroyCase(&c);
  Remove();
}

/* A checkpoint of the second step of the usual program. */
static void WriteCheckpoint(void)
{
  Case          c = NewBody();
  SamSimulation s =
    Begun(NewSimulation(&c, NewUsualProgram(), "-checkpoint test_restart.h5 -checkpoint_every 2 -overwrite"));

  s->point.worst = SAM_STATUS_EDGE_CONTACT;
  for (int step = 0; step < 2; step++) (void)TakeStep(s, &c);
  DestroySimulation(s);
  DestroyCase(&c);
}

/*
  Goes on from the checkpoint with this program, and destroys it. `says` NULL: this works; else it is refused, in a
  message with this text.
*/
static void AssertRestart(SamHistory history, const char *says)
{
  Case           c = NewBody();
  SamSimulation  s = NewSimulation(&c, history, "-restart test_restart.h5");
  PetscErrorCode ierr;

  BeginCatching();
  ierr = SamSimulationRestart(s);
  EndCatching();
  if (says) {
    if (!strstr(CaughtMessage(), says)) print_error("%s\n", CaughtMessage());
    sam_assert(ierr == SAM_ERR_USER && strstr(CaughtMessage(), says) && strstr(CaughtMessage(), file));
  } else
    sam_assert(ierr == 0 && s->point.steps == 2 && s->point.worst == SAM_STATUS_EDGE_CONTACT);
  DestroySimulation(s);
  DestroyCase(&c);
}

/* A run from the start does not replace the checkpoint of an earlier one, unless it is told to; a restart does. */
static void test_checkpoint_of_an_earlier_run_is_kept(void **state)
{
  Case          c = NewBody();
  SamSimulation s;

  (void)state;
  WriteCheckpoint();
  s = NewSimulation(&c, NewUsualProgram(), "-checkpoint test_restart.h5");
  sam_says(SamSimulationBeginCheckpoints(s), SAM_ERR_USER, "-restart test_restart.h5");
  sam_assert(strstr(CaughtMessage(), "-overwrite"));
  DestroySimulation(s);
  DestroySimulation(Begun(NewSimulation(&c, NewUsualProgram(), "-checkpoint test_restart.h5 -overwrite")));
  s = NewSimulation(&c, NewUsualProgram(), "-checkpoint test_restart.h5 -restart test_restart.h5");
  DestroySimulation(Begun(s));
  DestroyCase(&c);
  Remove();
}

/* After the checkpoint the program may differ, also in the number of steps. */
static void test_run_goes_on_with_the_program_that_it_had(void **state)
{
  (void)state;
  WriteCheckpoint();
  AssertRestart(NewUsualProgram(), NULL);
  AssertRestart(NewProgram("time,load_n,load_tx,friction_scale", "2,400,10,0.9", "7,100,-30,2\n8,1,2,3"), NULL);
  Remove();
}

static void test_other_programs_up_to_the_checkpoint_are_named(void **state)
{
  static const char usual[] = "time,load_n,load_tx,friction_scale", last[] = "4,400,30,1";

  (void)state;
  WriteCheckpoint();
  AssertRestart(NewProgram(usual, "2.5,400,10,0.9", last), "times up to step 2");
  AssertRestart(NewProgram(usual, "2,400.5,10,0.9", last), "-load_n");
  AssertRestart(NewProgram(usual, "2,400,11,0.9", last), "-load_tx");
  AssertRestart(NewProgram(usual, "2,400,10,0.8", last), "friction_scale");
  AssertRestart(NewProgram("time,load_n,disp_x,friction_scale", "2,400,10,0.9", last), "-disp_x");
  AssertRestart(NewHistory("-load_n 400"), "there are 1 load steps, and 2 were solved");
  Remove();
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_checkpoints_come_after_every_so_many_steps),
    cmocka_unit_test(test_signals_ask_for_checkpoints),
    cmocka_unit_test(test_limit_of_time_stops_with_a_checkpoint),
    cmocka_unit_test(test_checkpoint_of_an_earlier_run_is_kept),
    cmocka_unit_test(test_run_goes_on_with_the_program_that_it_had),
    cmocka_unit_test(test_other_programs_up_to_the_checkpoint_are_named),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}
