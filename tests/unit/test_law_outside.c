/*
 * A law that the library does not know: what it declares is in results, checkpoints and restarts, with the same bits on
 * any number of ranks, though nobody else lists it.
 */
#include "results.h"

#include <petsam/private/checkpoint.h>
#include <petsam/private/lawimpl.h>

enum { N = 37, LOADS = 4, STOP = 2 };

/* ---- the law ---- */

/*
  Friction fades with the slip so far, and the surfaces swell where they have slipped. Remembers the slip, `faded`; the
  sum of the shear, `drift`, of two components and with its values one step back; and two numbers.
*/
typedef struct {
  PetscReal length; /* of slip by which half of the friction is lost, m */
} Fading;

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  PetscFunctionBegin;
  PetscCall(SamOptionsReal(from, "fade_length", "slip by which half of the friction is lost", "m", SAM_RANGE_POSITIVE,
                           &((Fading *)law->data)->length, asked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "fade_length", PETSC_TRUE, 1, &((const Fading *)law->data)->length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateField fields[] = {
    {"faded", "m", "slip so far", 1, 2, PETSC_TRUE, PETSC_FALSE, SAM_RESULT_USUAL, SAM_MOVES, 0, PETSC_FALSE},
    {"drift", "Pa", "sum of the shear", 2, 3, PETSC_TRUE, PETSC_FALSE, SAM_RESULT_OFFERED, SAM_STAYS, 0, PETSC_FALSE}};
  static const SamStateNumber numbers[] = {
    {"faded_most", "m", "largest slip so far", SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"faded_steps", "1", "steps so far", SAM_NUMBER_INT, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0}};
  PetscInt id;

  PetscFunctionBegin;
  (void)law;
  for (int k = 0; k < 2; k++) PetscCall(SamStateDeclareField(state, &fields[k], &id));
  for (int k = 0; k < 2; k++) PetscCall(SamStateDeclareNumber(state, &numbers[k], &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The committed values of a field; NULL: none yet. */
static Vec Committed(SamState state, const char *name)
{
  return state ? SamStateGetField(state, SamStateFindField(state, name), SAM_COMMITTED) : NULL;
}

static PetscErrorCode Bound(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  const Vec     targets[2] = {bound->value, bound->by_pressure}, faded = Committed(at->state, "faded");
  const double *slip;
  double       *to;

  PetscFunctionBegin;
  if (!faded) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(faded, &slip));
  for (int n = 0; n < 2; n++) {
    if (!targets[n]) continue;
    PetscCall(VecGetArray(targets[n], &to));
    for (PetscInt k = 0; k < law->grid->cells; k++) to[k] /= 1 + slip[k] / ((const Fading *)law->data)->length;
    PetscCall(VecRestoreArray(targets[n], &to));
  }
  PetscCall(VecRestoreArrayRead(faded, &slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Separation(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds)
{
  const Vec faded = Committed(state, "faded");

  PetscFunctionBegin;
  (void)law;
  (void)generation;
  if (faded) *adds = PETSC_TRUE;
  if (faded && h) PetscCall(VecAXPY(h, -0.125, faded));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const PetscInt faded_id = SamStateFindField(step->state, "faded"), drift_id = SamStateFindField(step->state, "drift"),
                 most_id  = SamStateFindNumber(step->state, "faded_most"),
                 steps_id = SamStateFindNumber(step->state, "faded_steps");
  Vec       faded, drift;
  PetscReal most;

  PetscFunctionBegin;
  (void)law;
  PetscCall(SamStateSetField(step->state, faded_id, &faded));
  PetscCall(VecCopy(step->field[SAM_USE_PATH], faded));
  if (Committed(step->state, "faded")) PetscCall(VecAXPY(faded, 1, Committed(step->state, "faded")));
  PetscCall(SamStateSetField(step->state, drift_id, &drift));
  PetscCall(VecCopy(step->shear, drift));
  if (Committed(step->state, "drift")) PetscCall(VecAXPY(drift, 1, Committed(step->state, "drift")));
  PetscCall(VecMax(faded, NULL, &most));
  *SamStateNumbers(step->state, most_id, SAM_TRIED)  = (double)most;
  *SamStateNumbers(step->state, steps_id, SAM_TRIED) = *SamStateNumbers(step->state, steps_id, SAM_COMMITTED) + 1;
  step->moves                                        = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamLaw law)
{
  Fading *fading;

  PetscFunctionBegin;
  PetscCall(PetscNew(&fading));
  law->data               = fading;
  law->uses[SAM_USE_PATH] = PETSC_TRUE;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.addparameters  = AddParameters;
  law->ops.declare        = Declare;
  law->ops.bound          = Bound;
  law->ops.separation     = Separation;
  law->ops.advance        = Advance;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- runs ---- */

/* A sphere with the laws of the options. */
static Case NewBody(MPI_Comm comm, const char *options)
{
  const SamOptions from = {comm, NULL};
  Case             c    = NewCaseOn(NewSphereOn(comm, Dissimilar(), N, 2, 0, 0), MU, NULL, "");

  SetOptions(options);
  sam_call(SamProblemSetLawsFromOptions(c.problem, &from));
  SetOptions("");
  return c;
}

static Case NewFading(MPI_Comm comm)
{
  return NewBody(comm, "-friction 0.3 -fade_length 1e-6");
}

/* Step k: the shear goes to and fro. */
static void SolveStep(const Case *c, int k)
{
  const SamControl control = Loads(c, 1 + 0.1 * k, k % 2 ? -0.4 : 0.5, 0.1 * k, 0);
  SamControl       timed   = control;

  timed.time = 1 + k;
  (void)Solve(c, &timed);
  sam_assert(NumberOf(c, "status") == SAM_STATUS_CONVERGED);
}

static SamParameters ParametersOf(const Case *c)
{
  SamParameters p = {.count = 0};
  const SamLaw *laws;
  PetscInt      count;

  sam_call(SamProblemGetLaws(c->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++) sam_call(SamLawAddParameters(laws[k], &p));
  return p;
}

static SamOutputSettings SettingsFor(const Case *c)
{
  return SettingsOf(c->contact, "-output_fields pressure,shear_x,gap,faded,drift_x,drift_y");
}

/* Steps from one to another, each with its fields. */
static void WriteRun(const Case *c, SamOutput output, int first, int end)
{
  for (int k = first; k < end; k++) {
    SolveStep(c, k);
    sam_call(SamOutputWriteStep(output, PETSC_TRUE));
  }
  sam_call(SamOutputDestroy(&output));
}

static SamOutput CreateOutput(const Case *c, const char *name)
{
  const SamOutputSettings set        = SettingsFor(c);
  const SamParameters     parameters = ParametersOf(c);
  SamOutput               output;

  sam_call(SamOutputCreate(c->s.grid, name, &set, &output));
  sam_call(SamOutputSetParameters(output, &parameters));
  return output;
}

static const char checkpoint_name[] = "test_law_outside_checkpoint.h5", whole_name[] = "test_law_outside.h5";

/* The first steps of a run, and a checkpoint. */
static void StopRun(void)
{
  Case                c          = NewFading(PETSC_COMM_WORLD);
  const SamParameters parameters = ParametersOf(&c);
  SamCheckpoint       files;

  WriteRun(&c, CreateOutput(&c, filename), 0, STOP);
  sam_call(SamCheckpointCreate(c.s.grid, checkpoint_name, &files));
  sam_call(SamCheckpointWrite(files, c.contact, &(SamCheckpointRest){.parameters = &parameters}));
  sam_call(SamCheckpointDestroy(&files));
  DestroyCase(&c);
}

static PetscErrorCode Restart(const Case *c)
{
  const SamParameters parameters = ParametersOf(c);
  PetscErrorCode      ierr;

  BeginCatching();
  ierr = SamCheckpointRead(checkpoint_name, c->contact, PETSC_TRUE, &(SamCheckpointRest){.parameters = &parameters});
  EndCatching();
  return ierr;
}

/* The rest of the run, in a contact and results of its own. */
static void GoOn(void)
{
  Case                    c          = NewFading(PETSC_COMM_WORLD);
  const SamOutputSettings set        = SettingsFor(&c);
  const SamParameters     parameters = ParametersOf(&c);
  SamOutput               output;

  sam_assert(!Restart(&c));
  sam_assert(NumberOf(&c, "faded_steps") == STOP && NumberOf(&c, "faded_most") > 0);
  sam_call(SamOutputCreate(c.s.grid, filename, &set, &output));
  sam_call(SamOutputSetParameters(output, &parameters));
  WriteRun(&c, output, STOP, LOADS);
  DestroyCase(&c);
}

/* ---- comparisons ---- */

static const char *const shown[] = {"pressure", "shear_x", "gap", "faded", "drift_x", "drift_y"};
enum { SHOWN = sizeof(shown) / sizeof(shown[0]) };

/* All numbers of a dataset, to be freed; `count` of them. */
static double *Read(hid_t file, const char *name, hsize_t *count)
{
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(dataset);
  double     *values;

  *count = (hsize_t)H5Sget_simple_extent_npoints(space);
  values = (double *)calloc(*count + 1, sizeof(*values));
  (void)H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Sclose(space);
  H5Dclose(dataset);
  return values;
}

/* Whether the other file holds the steps after the stop. */
static int SameInFiles(hid_t one, hid_t other, const char *name)
{
  hsize_t       counts[2];
  double       *a = Read(one, name, &counts[0]), *b = Read(other, name, &counts[1]);
  const hsize_t skipped = counts[0] / LOADS * STOP;
  const int     same = counts[1] && counts[0] == skipped + counts[1] && !memcmp(a + skipped, b, counts[1] * sizeof(*a));

  if (!same) print_error("%s differs\n", name);
  free(a);
  free(b);
  return same;
}

/* All fields and columns of two results files, on rank 0. */
static int SameResults(const char *one_name, const char *other_name)
{
  hid_t      one, other, group;
  H5G_info_t info = {.nlinks = 0};
  int        same = 1;

  if (Rank()) return 1;
  one   = H5Fopen(one_name, H5F_ACC_RDONLY, H5P_DEFAULT);
  other = H5Fopen(other_name, H5F_ACC_RDONLY, H5P_DEFAULT);
  group = H5Gopen2(one, "history", H5P_DEFAULT);
  for (int k = 0; k < SHOWN; k++) same = SameInFiles(one, other, shown[k]) && same;
  (void)H5Gget_info(group, &info);
  same = same && info.nlinks > 20 && H5Lexists(group, "faded_most", H5P_DEFAULT) > 0 &&
         H5Lexists(group, "faded_steps", H5P_DEFAULT) > 0;
  for (hsize_t k = 0; k < info.nlinks; k++) {
    char name[80] = "history/";

    (void)H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name + 8, sizeof(name) - 8, H5P_DEFAULT);
    same = SameInFiles(one, other, name) && same;
  }
  H5Gclose(group);
  H5Fclose(other);
  H5Fclose(one);
  return same;
}

/* Whether rank 0 finds these values in a file, in step k. */
static int HasLayer(const char *name, int k, const double *values)
{
  hsize_t count;
  hid_t   file;
  double *all;
  int     same;

  if (Rank()) return 1;
  file = H5Fopen(whole_name, H5F_ACC_RDONLY, H5P_DEFAULT);
  all  = Read(file, name, &count);
  same = count == (hsize_t)LOADS * N * N && !memcmp(all + N * N * k, values, N * N * sizeof(*all));
  free(all);
  H5Fclose(file);
  return same;
}

/* The results hold what a contact on each rank alone finds. */
static void AssertAsAlone(void)
{
  Case c = NewFading(PETSC_COMM_SELF);

  for (int k = 0; k < LOADS; k++) {
    SolveStep(&c, k);
    for (int f = 0; f < SHOWN; f++) {
      Vec     field  = NewFieldOf(&c, shown[f]);
      double *values = Whole(c.s.grid, 1, field);

      sam_assert(HasLayer(shown[f], k, values));
      free(values);
      sam_call(VecDestroy(&field));
    }
  }
  DestroyCase(&c);
}

/* ---- tests ---- */

static void test_law_changes_the_solution(void **state)
{
  Case   with = NewFading(PETSC_COMM_WORLD), without = NewBody(PETSC_COMM_WORLD, "-friction 0.3");
  SamLaw law;

  (void)state;
  law = SamProblemGetLaw(with.problem, "fading");
  sam_assert(law);
  law = SamProblemGetLaw(without.problem, "fading");
  sam_assert(!law);
  for (int k = 0; k < 2; k++) {
    SolveStep(&with, k);
    SolveStep(&without, k);
    sam_assert(SameBits(SolutionOf(&with)->shear, SolutionOf(&without)->shear) == (k == 0));
    sam_assert(SameBits(SolutionOf(&with)->pressure, SolutionOf(&without)->pressure) == (k == 0));
  }
  DestroyCase(&with);
  DestroyCase(&without);
}

static void test_what_a_law_declares_is_in_results_and_checkpoints(void **state)
{
  Case c    = NewFading(PETSC_COMM_WORLD);
  int  good = 1;

  (void)state;
  WriteRun(&c, CreateOutput(&c, whole_name), 0, LOADS);
  DestroyCase(&c);
  if (!Rank()) {
    const hid_t file = H5Fopen(whole_name, H5F_ACC_RDONLY, H5P_DEFAULT), faded = H5Dopen2(file, "faded", H5P_DEFAULT);

    good = HasText(faded, "units", "m") && HasText(faded, "long_name", "slip so far") && HasScales(file, faded) &&
           HasReal(file, "fade_length", 1e-6) &&
           HasColumn(file, "faded_steps", "1", (const double[]){1, 2, 3, 4}, LOADS, 1);
    H5Dclose(faded);
    H5Fclose(file);
  }
  sam_assert(good);
  AssertAsAlone();
  StopRun();
  GoOn();
  sam_assert(SameResults(whole_name, filename));
  RemoveFile(whole_name);
  RemoveFile(filename);
  RemoveFile(checkpoint_name);
}

static void test_checkpoint_of_other_laws_is_refused(void **state)
{
  Case slower = NewBody(PETSC_COMM_WORLD, "-friction 0.3 -fade_length 2e-6"),
       none   = NewBody(PETSC_COMM_WORLD, "-friction 0.3");

  (void)state;
  StopRun();
  sam_assert(Restart(&slower) == SAM_ERR_USER && strstr(CaughtMessage(), "-fade_length is 1e-06 there, not 2e-06"));
  sam_assert(Restart(&none) == SAM_ERR_USER && strstr(CaughtMessage(), "-fade_length is given there, and not here"));
  DestroyCase(&slower);
  DestroyCase(&none);
  RemoveFile(filename);
  RemoveFile(checkpoint_name);
}

static int Register(void **state)
{
  (void)state;
  return SamLawRegister("fading", Create) ? 1 : 0;
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_law_changes_the_solution),
    cmocka_unit_test(test_what_a_law_declares_is_in_results_and_checkpoints),
    cmocka_unit_test(test_checkpoint_of_other_laws_is_refused),
  };

  return SamTestMainWith(argc, argv, Register, tests, sizeof(tests) / sizeof(tests[0]));
}
