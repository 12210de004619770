/* Laws: the order in which they act, one from outside that changes the bound and remembers, and what is refused. */
#include "contacts.h"
#include <petsam/private/state.h>

/* ---- two laws that change the bound ---- */

static PetscErrorCode Halve(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  PetscFunctionBegin;
  (void)law;
  (void)at;
  if (bound->value) PetscCall(VecScale(bound->value, 0.5));
  if (bound->by_pressure) PetscCall(VecScale(bound->by_pressure, 0.5));
  if (bound->by_slip) PetscCall(VecScale(bound->by_slip, 0.5));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateHalving(SamLaw law)
{
  PetscFunctionBegin;
  law->ops.bound = Halve;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Add(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  PetscFunctionBegin;
  (void)law;
  (void)at;
  if (bound->value) PetscCall(VecShift(bound->value, 8));
  if (bound->by_slip) PetscCall(VecShift(bound->by_slip, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateAdding(SamLaw law)
{
  PetscFunctionBegin;
  law->ops.bound = Add;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a law that weakens where the surfaces have slipped ---- */

static int created, destroyed;

/* The part of the bound that is left where they have slipped. */
static double LeftOf(SamLaw law)
{
  return *(double *)law->data;
}

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  PetscReal left = LeftOf(law);

  PetscFunctionBegin;
  PetscCall(SamOptionsReal(from, "weaken", "part of the bound that is left", NULL, SAM_RANGE_POSITIVE, &left, asked));
  *(double *)law->data = left;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateField  path  = {.name        = "weak_path",
                                       .unit        = "m",
                                       .text        = "slip in cells that slip",
                                       .components  = 1,
                                       .generations = 2,
                                       .kept        = PETSC_TRUE,
                                       .result      = SAM_RESULT_USUAL};
  static const SamStateNumber cells = {
    "weak_cells", "1", "cells that have slipped", SAM_NUMBER_INT, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0};
  PetscInt id;

  PetscFunctionBegin;
  (void)law;
  PetscCall(SamStateDeclareField(state, &path, &id));
  PetscCall(SamStateDeclareNumber(state, &cells, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Weaken(SamLaw law, Vec path, Vec field)
{
  const double *s;
  double       *b;

  PetscFunctionBegin;
  if (!field || !path) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(path, &s));
  PetscCall(VecGetArray(field, &b));
  for (PetscInt k = 0; k < law->grid->cells; k++) b[k] *= s[k] > 0 ? LeftOf(law) : 1;
  PetscCall(VecRestoreArray(field, &b));
  PetscCall(VecRestoreArrayRead(path, &s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WeakBound(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  const PetscInt id   = at->state ? SamStateFindField(at->state, "weak_path") : -1;
  const Vec      path = id < 0 ? NULL : SamStateGetField(at->state, id, SAM_COMMITTED);

  PetscFunctionBegin;
  PetscCall(Weaken(law, path, bound->value));
  PetscCall(Weaken(law, path, bound->by_pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds |ds| where the surfaces slip. */
static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const PetscInt id   = SamStateFindField(step->state, "weak_path");
  const Vec      from = SamStateGetField(step->state, id, SAM_COMMITTED);
  double         weak = 0, *to;
  const double  *s, *pressed;
  const Vec      path = step->field[SAM_USE_PATH], slipped = step->field[SAM_USE_PRESSED];
  Vec            next;

  PetscFunctionBegin;
  PetscCall(SamStateSetField(step->state, id, &next));
  if (from)
    PetscCall(VecCopy(from, next));
  else
    PetscCall(VecSet(next, 0));
  PetscCall(VecGetArrayRead(path, &s));
  PetscCall(VecGetArrayRead(slipped, &pressed));
  PetscCall(VecGetArray(next, &to));
  for (PetscInt k = 0; k < law->grid->cells; k++) {
    to[k] += pressed[k] > 0 ? s[k] : 0;
    weak += to[k] > 0;
  }
  PetscCall(VecRestoreArray(next, &to));
  PetscCall(VecRestoreArrayRead(slipped, &pressed));
  PetscCall(VecRestoreArrayRead(path, &s));
  PetscCall(SamSum(law->grid->comm, 1, &weak));
  *SamStateNumbers(step->state, SamStateFindNumber(step->state, "weak_cells"), SAM_TRIED) = weak;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamLaw law)
{
  PetscFunctionBegin;
  (void)law;
  destroyed++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateWeakening(SamLaw law)
{
  double *left;

  PetscFunctionBegin;
  created++;
  PetscCall(PetscNew(&left));
  *left                   = 0.5;
  law->data               = left;
  law->uses[SAM_USE_PATH] = law->uses[SAM_USE_PRESSED] = PETSC_TRUE;
  law->ops.setfromoptions                              = SetFromOptions;
  law->ops.declare                                     = Declare;
  law->ops.bound                                       = WeakBound;
  law->ops.advance                                     = Advance;
  law->ops.destroy                                     = Destroy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int Register(void **state)
{
  (void)state;
  sam_call(SamLawRegister("halving", CreateHalving));
  sam_call(SamLawRegister("adding", CreateAdding));
  sam_call(SamLawRegister("weakening", CreateWeakening));
  return 0;
}

/* ---- order ---- */

static int IsEverywhere(Vec field, double value)
{
  PetscReal least, most;

  sam_call(VecMin(field, NULL, &least));
  sam_call(VecMax(field, NULL, &most));
  return least == value && most == value;
}

/* In the order in which their types were registered, whatever the order in which they were added. */
static void test_bounds_of_several_laws_are_in_order(void **state)
{
  static const char *const order[] = {SAM_LAW_COULOMB, SAM_LAW_BULK_STRESS, SAM_LAW_HARDNESS, "halving", "adding"};
  Case                     c       = NewCase(Steel(), 13, 2, 0.25, "");
  Vec p = NewField(c.s.grid, 1), b = NewField(c.s.grid, 1), by_p = NewField(c.s.grid, 1), by_s = NewField(c.s.grid, 1);
  const SamLaw *laws;
  PetscInt      count;
  SamControl    twice = Scaled(c.problem, 2);

  (void)state;
  sam_call(SamProblemAddLawOfType(c.problem, "adding", NULL));
  sam_call(SamProblemAddLawOfType(c.problem, "halving", NULL));
  sam_call(SamProblemAddLawOfType(c.problem, SAM_LAW_HARDNESS, NULL));
  sam_call(SamProblemGetLaws(c.problem, &count, &laws));
  sam_assert(count == 5);
  for (PetscInt k = 0; k < count; k++) sam_assert(!strcmp(laws[k]->type, order[k]));
  sam_call(VecSet(p, 64));
  sam_call(SamProblemComputeBound(c.problem, &(SamBoundAt){.control = &twice, .pressure = p},
                                  &(SamBound){.value = b, .by_pressure = by_p, .by_slip = by_s}));
  sam_assert(IsEverywhere(b, 0.5 * 2 * 0.25 * 64 + 8) && IsEverywhere(by_p, 0.5 * 2 * 0.25) && IsEverywhere(by_s, 3));
  sam_call(SamProblemComputeBound(c.problem, &(SamBoundAt){.control = &twice, .pressure = p}, &(SamBound){.value = p}));
  sam_assert(SameBits(p, b)); /* in place */
  sam_destroy(&p, &b, &by_p, &by_s);
  DestroyCase(&c);
}

/* The solution under a halved bound is that of half the friction, to the last bit. */
static void test_solution_is_that_of_the_bound_of_all_laws(void **state)
{
  Case             one = NewCase(Steel(), 40, 1.5, MU, ""), other = NewCase(Steel(), 40, 1.5, 0.5 * MU, "");
  const SamControl control = Loads(&other, 1, 0.6, 0.1, 0);
  SamStep          a, b;

  (void)state;
  sam_call(SamProblemAddLawOfType(one.problem, "halving", NULL));
  a = Solve(&one, &control);
  b = Solve(&other, &control);
  AssertGood(&a);
  AssertSameSteps(&one, &a, &other, &b);
  AssertSameFields(&one, &other);
  DestroyCase(&one);
  DestroyCase(&other);
}

/* ---- memory ---- */

static Vec NewWeakPath(const Case *c)
{
  return NewFieldOf(c, "weak_path");
}

/* Cells whose bound is a part of mu p, and those of them that have not slipped before. */
static void CountWeak(const Case *c, Vec path, double part, double counts[2])
{
  const double *p, *b, *s;

  counts[0] = counts[1] = 0;
  sam_call(VecGetArrayRead(SolutionOf(c)->pressure, &p));
  sam_call(VecGetArrayRead(SolutionOf(c)->bound, &b));
  sam_call(VecGetArrayRead(path, &s));
  for (PetscInt k = 0; k < c->s.grid->cells; k++)
    if (p[k] > 0 && fabs(b[k] - part * MU * p[k]) <= 1e-14 * b[k]) {
      counts[0] += 1;
      counts[1] += s[k] > 0 ? 0 : 1;
    }
  sam_call(VecRestoreArrayRead(path, &s));
  sam_call(VecRestoreArrayRead(SolutionOf(c)->bound, &b));
  sam_call(VecRestoreArrayRead(SolutionOf(c)->pressure, &p));
  (void)MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
}

/* It is a result by its name, the next step knows it, and a rejected try leaves none of it. */
static void test_law_from_outside_remembers(void **state)
{
  Case             c     = NewCase(Steel(), 40, 1.5, MU, "-weaken 0.25");
  const SamControl first = Loads(&c, 1, 0.3, 0, 0), second = Loads(&c, 1, 0.45, 0, 0);
  double           counts[2], weak;
  SamState         memory;
  SamStep          step;
  PetscInt         id;
  Vec              path, tried, vector;

  (void)state;
  path = NewWeakPath(&c);
  sam_assert(Norm(path, NORM_INFINITY) == 0); /* nothing so far */
  sam_call(SamContactGetState(c.contact, &memory));
  id   = SamStateFindField(memory, "weak_path");
  step = Try(&c, &first);
  AssertGood(&step);
  CountWeak(&c, path, 0.25, counts);
  sam_assert(counts[0] == 0); /* the bound is that of the committed state */
  vector = SamStateGetField(memory, id, SAM_TRIED);
  weak   = NumberOf(&c, "weak_cells");
  sam_assert(vector && weak > 50 && weak < NumberOf(&c, "contact_cells"));
  sam_call(SamContactCommit(c.contact));
  sam_assert(SamStateGetField(memory, id, SAM_COMMITTED) == vector); /* rotated, not copied */
  sam_call(VecDestroy(&path));
  path = NewWeakPath(&c);
  sam_assert(SameBits(path, vector) && NumberOf(&c, "weak_cells") == weak);
  step = Try(&c, &second);
  AssertGood(&step); /* the check knows the weakened bound, too */
  CountWeak(&c, path, 0.25, counts);
  sam_assert(counts[0] == weak && counts[1] == 0);
  tried = NewWeakPath(&c);
  sam_assert(Sum(tried) > Sum(path) && NumberOf(&c, "weak_cells") > weak);
  sam_call(SamContactReject(c.contact));
  sam_call(VecDestroy(&tried));
  tried = NewWeakPath(&c);
  sam_assert(SameBits(tried, path) && NumberOf(&c, "weak_cells") == weak);
  sam_destroy(&tried, &path);
  DestroyCase(&c);
}

static void test_memory_of_a_law_from_outside_goes_with_the_state(void **state)
{
  static const double T[] = {0.3, 0.45, -0.3, 0.4};
  Case one = NewCase(Steel(), 40, 1.5, MU, "-weaken 0.5"), other = NewCase(Steel(), 40, 1.5, MU, "-weaken 0.5"),
       plain = NewCase(Steel(), 40, 1.5, MU, "");
  SamState held;

  (void)state;
  for (int k = 0; k < 4; k++) {
    const SamControl control = Loads(&one, 1, T[k], 0.1, 0);
    const SamStep    a       = Solve(&one, &control);

    AssertGood(&a);
    if (k == 1) {
      sam_call(SamContactGetState(one.contact, &held));
      sam_call(SamContactSetState(other.contact, held, PETSC_TRUE));
      sam_fails(SamContactSetState(plain.contact, held, PETSC_TRUE), PETSC_ERR_ARG_INCOMP);
    }
    if (k > 1) {
      const SamStep b = Solve(&other, &control);

      AssertSameSteps(&one, &a, &other, &b);
      AssertSameFields(&one, &other);
    }
    if (k > 0) sam_assert(SameBitsOf(&one, &other, NewWeakPath));
  }
  DestroyCase(&one);
  DestroyCase(&other);
  DestroyCase(&plain);
}

/* ---- what is refused, and who frees it ---- */

static void test_second_law_of_a_type_is_refused(void **state)
{
  Case     c = NewCase(Steel(), 13, 2, MU, "");
  SamLaw   law, same, second;
  PetscInt count;

  (void)state;
  created = destroyed = 0;
  sam_call(SamLawCreate(c.s.elasticity, "weakening", &law));
  sam_call(SamProblemAddLaw(c.problem, law));
  sam_fails(SamProblemAddLaw(c.problem, law), PETSC_ERR_ARG_WRONG);
  sam_call(SamLawCreate(c.s.elasticity, "weakening", &second));
  sam_fails(SamProblemAddLaw(c.problem, second), PETSC_ERR_ARG_WRONG);
  sam_call(SamLawDestroy(&second));
  sam_assert(!second && created == 2 && destroyed == 1);
  sam_call(SamProblemAddLawOfType(c.problem, "weakening", &same));
  second = SamProblemGetLaw(c.problem, "weakening");
  sam_assert(same == law && second == law && created == 2);
  sam_call(SamLawDestroy(&law)); /* the problem holds it */
  sam_call(SamProblemGetLaws(c.problem, &count, &(const SamLaw *){NULL}));
  sam_assert(destroyed == 1 && count == 3);
  law = SamProblemGetLaw(c.problem, SAM_LAW_ARCHARD);
  sam_assert(!law);
  sam_fails(SamLawCreate(c.s.elasticity, "rust", &law), PETSC_ERR_ARG_UNKNOWN_TYPE);
  DestroyCase(&c);
  sam_assert(destroyed == 2);
}

/* A type that replaces another one keeps its place. */
static void test_type_of_the_same_name_replaces_it(void **state)
{
  const SamLawType *types;
  PetscInt          before, after;
  SamLaw            law;
  Sphere            s = NewSphereOf(Steel(), 13, 2);

  (void)state;
  sam_call(SamLawGetTypes(&before, &types));
  sam_assert(SamLawIsRegistered("weakening") && !SamLawIsRegistered("rust"));
  sam_call(SamLawRegister("halving", CreateAdding));
  sam_call(SamLawGetTypes(&after, &types));
  sam_assert(before == after && !strcmp(types[0], SAM_LAW_COULOMB) && !strcmp(types[after - 3], "halving"));
  sam_call(SamLawCreate(s.elasticity, "halving", &law));
  sam_assert(law->ops.bound == Add);
  sam_call(SamLawDestroy(&law));
  sam_call(SamLawRegister("halving", CreateHalving));
  DestroySphere(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_bounds_of_several_laws_are_in_order),
    cmocka_unit_test(test_solution_is_that_of_the_bound_of_all_laws),
    cmocka_unit_test(test_law_from_outside_remembers),
    cmocka_unit_test(test_memory_of_a_law_from_outside_goes_with_the_state),
    cmocka_unit_test(test_second_law_of_a_type_is_refused),
    cmocka_unit_test(test_type_of_the_same_name_replaces_it),
  };

  return SamTestMainWith(argc, argv, Register, tests, sizeof(tests) / sizeof(tests[0]));
}
