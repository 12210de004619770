/*
 * The base of the solvers: registry and options, with a method of each kind from outside of the library. Only installed
 * headers are used.
 */
#include "fields.h"
#include "methods/methods.h"

#include <petsam/private/elasticity.h>
#include <petsam/private/help.h>
#include <petsam/private/normalimpl.h>
#include <petsam/private/tangentialimpl.h>
#include <petsam/private/solver.h>

static const double mu = 0.3;

/* ---- a method for the normal problem: projected gradient steps of a fixed length ---- */

typedef struct {
  PetscReal relaxation; /* length of the step, in units of the inverse of an upper bound of the eigenvalues */
} Toy;

static PetscInt destroyed; /* how many have been */

static PetscErrorCode ToyOptions(SamSolver s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamOptionsReal(from, "toy_relaxation", "length of the steps", NULL, SAM_RANGE_POSITIVE,
                           &((Toy *)s->data)->relaxation, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ToyDestroy(SamSolver s)
{
  PetscFunctionBegin;
  destroyed++;
  PetscCall(PetscFree(s->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An upper bound of the eigenvalues of S and C: a uniform traction on all cells moves each less than this. */
static double Largest(const SamLevel *level, double self)
{
  return 4 * self * sqrt((double)level->grid->nx * (double)level->grid->ny);
}

/* The largest complementarity error of p, with the motion that the last projection has found. */
static PetscErrorCode NormalError(const SamLevel *level, const double p[], const double g[], double *error)
{
  const SamFrame *f     = &level->frame;
  double          worst = 0;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < level->grid->rows; j++) {
    const SamRow row = SamFrameRow(f, j, 0, level->grid->nx);

    for (int i = 0; i < row.count; i++) {
      const double v =
        g[row.first + i] - SamFrameNormal(level->rigid, row.xi0 + (double)i * row.dxi, row.eta); /* the gap */

      worst = PetscMax(worst, p[row.first + i] > 0 ? fabs(v) : -v);
    }
  }
  PetscCall(SamMax(level->grid->comm, 1, &worst));
  *error = worst;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The approach alone is fitted: the mean of g over the contact. */
static PetscErrorCode FitApproach(SamLevel *level, const double p[], const double g[])
{
  double sums[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < level->grid->cells; k++)
    if (p[k] > 0) {
      sums[0] += 1;
      sums[1] += g[k];
    }
  PetscCall(SamSum(level->grid->comm, 2, sums));
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = c == 0 && sums[0] > 0 ? sums[1] / sums[0] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamNormalSolve_Toy(SamSolver s, SamLevel *level)
{
  PetscReal self, most;
  double    step;
  PetscBool found = PETSC_TRUE;
  Vec       u;
  double   *p, *g;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &self, NULL));
  step = ((Toy *)s->data)->relaxation / Largest(level, self);
  PetscCall(SamGridCreateVec(level->grid, 1, &u));
  for (s->reason = SAM_SOLVER_ITERATING; !s->reason;) {
    PetscCall(SamLevelApply(s, level, level->traction, u));
    PetscCall(VecNorm(u, NORM_INFINITY, &most));
    PetscCall(VecAXPY(u, 1, level->given[SAM_NORMAL_SEPARATION]));
    PetscCall(VecGetArray(level->traction, &p));
    PetscCall(VecGetArray(u, &g));
    PetscCall(FitApproach(level, p, g));
    PetscCall(NormalError(level, p, g, &s->error));
    s->error /= most;
    if (s->error > level->rtol) {
      for (PetscInt k = 0; k < level->grid->cells; k++) p[k] -= step * (g[k] - level->rigid[0]);
      PetscCall(SamFrameProjectNormal(&level->frame, NULL, p, &found));
    }
    PetscCall(VecRestoreArray(u, &g));
    PetscCall(VecRestoreArray(level->traction, &p));
    PetscCall(SamLevelIterated(s, level, s->error));
    if (!found)
      s->reason = SAM_SOLVER_DIVERGED_NO_EQUILIBRIUM;
    else if (s->error <= level->rtol)
      s->reason = SAM_SOLVER_CONVERGED_RTOL;
    else if (SamLevelAtMaxIterations(s, level))
      s->reason = SAM_SOLVER_DIVERGED_ITS;
  }
  PetscCall(VecDestroy(&u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamNormalCreate_Toy(SamSolver s)
{
  Toy *toy;

  PetscFunctionBegin;
  PetscCall(PetscNew(&toy));
  toy->relaxation       = 1;
  s->data               = toy;
  s->ops.solve          = SamNormalSolve_Toy;
  s->ops.setfromoptions = ToyOptions;
  s->ops.destroy        = ToyDestroy;
  s->default_levels     = 1;
  s->default_max_it     = 2000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a method for the tangential problem: the same on discs ---- */

static PetscErrorCode SamTangentialSolve_Toy(SamSolver s, SamLevel *level)
{
  PetscBool    found = PETSC_TRUE;
  SamStickSlip w;

  PetscFunctionBegin;
  PetscCall(SamStickSlipCreate(s, level, SAM_RUN_GAP, &w));
  PetscCall(SamStickSlipStart(&w));
  for (s->reason = SAM_SOLVER_ITERATING; !s->reason;) {
    for (PetscInt k = 0; k < 2 * w.cells; k++) w.q[k] -= w.s[k] / Largest(level, w.self);
    PetscCall(SamFrameProjectTangential(&level->frame, &w.runs, w.bound, NULL, PETSC_TRUE, w.q, NULL, &found));
    PetscCall(SamStickSlipComputeSlip(&w));
    PetscCall(SamStickSlipMeasure(&w));
    PetscCall(SamLevelIterated(s, level, w.error));
    if (!found)
      s->reason = SAM_SOLVER_DIVERGED_STAGNATED;
    else if (w.error <= level->rtol)
      s->reason = SAM_SOLVER_CONVERGED_RTOL;
    else if (SamLevelAtMaxIterations(s, level))
      s->reason = SAM_SOLVER_DIVERGED_ITS;
  }
  s->error = w.error;
  for (PetscInt c = 0; c < 3; c++) level->rigid[c] = w.motion[c];
  PetscCall(SamStickSlipDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamTangentialCreate_Toy(SamSolver s)
{
  PetscFunctionBegin;
  s->ops.solve      = SamTangentialSolve_Toy;
  s->default_levels = 1;
  s->default_max_it = 4000;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- tests ---- */

static void Option(const char *name, const char *value)
{
  sam_call(PetscOptionsSetValue(NULL, name, value));
}

static void ClearOptions(void)
{
  sam_call(PetscOptionsClear(NULL));
}

static SamBalance Loaded(SamBalanceKind kind, double force)
{
  const SamBalance b = {.kind = kind, .force = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .load = {force, 0, 0}};

  return b;
}

static void test_normal_method_from_outside_is_selected_by_its_option(void **state)
{
  Sphere          s       = NewSphere(32, 1.5, 0.3);
  SamBalance      balance = Loaded(SAM_BALANCE_NORMAL, s.N), other = balance;
  Vec             p = NewField(s.grid, 1), q = NewField(s.grid, 1);
  SamNormal       normal;
  SamSolverType   type;
  SamSolverReason reason;
  PetscInt        its, applies;

  (void)state;
  sam_call(SamNormalRegister("toy", SamNormalCreate_Toy));
  Option("-mine_normal_type", "toy");
  Option("-mine_normal_toy_relaxation", "1.5");
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p));
  sam_call(SamSolverSetOptionsPrefix(SamNormalAsSolver(normal), "mine_"));
  sam_call(SamSolverSetFromOptions(SamNormalAsSolver(normal)));
  type = SamSolverGetType(SamNormalAsSolver(normal));
  sam_assert(!strcmp(type, "toy"));
  sam_assert(((Toy *)SamNormalAsSolver(normal)->data)->relaxation == 1.5);
  sam_call(SamNormalSolve(normal, s.h, &other, PETSC_FALSE, q));
  reason = SamSolverGetReason(SamNormalAsSolver(normal));
  sam_call(SamSolverGetStatistics(SamNormalAsSolver(normal), NULL, &its, &applies, NULL));
  sam_assert(reason == SAM_SOLVER_CONVERGED_RTOL);
  sam_assert(its > 10 && applies == its);              /* a gradient method, and not the default */
  sam_assert_close(Difference(q, p, NORM_2), 0, 1e-5); /* rtol times the condition, about n, twice */
  sam_assert_close(other.rigid[0], balance.rigid[0], 1e-6 * balance.rigid[0]);
  destroyed = 0;
  sam_call(SamSolverSetType(SamNormalAsSolver(normal), SAM_NORMAL_POLONSKYKEER)); /* the toy's data go with it */
  sam_assert(destroyed == 1 && !SamNormalAsSolver(normal)->data);
  sam_call(SamNormalDestroy(&normal));
  sam_assert(!normal);
  ClearOptions();
  sam_destroy(&p, &q);
  DestroySphere(&s);
}

static void test_tangential_method_from_outside_is_selected_by_its_option(void **state)
{
  Sphere     s      = NewSphere(32, 1.5, 0.3);
  SamBalance normal = Loaded(SAM_BALANCE_NORMAL, s.N), balance = Loaded(SAM_BALANCE_TANGENTIAL, 0.5 * mu * s.N),
             other      = balance;
  Vec             bound = NewField(s.grid, 1), q = NewField(s.grid, 2), r = NewField(s.grid, 2);
  SamNormal       n;
  SamTangential   t;
  SamSolverReason reason;
  PetscInt        its, preconditions;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &n));
  sam_call(SamNormalSolve(n, s.h, &normal, PETSC_FALSE, bound));
  sam_call(SamNormalDestroy(&n));
  sam_call(VecScale(bound, mu));
  sam_call(SamTangentialRegister("toy", SamTangentialCreate_Toy));
  Option("-tangential_type", "toy");
  sam_call(SamTangentialCreate(s.elasticity, &t));
  sam_call(SamTangentialSolve(t, bound, NULL, &balance, PETSC_FALSE, q));
  sam_call(SamSolverSetFromOptions(SamTangentialAsSolver(t)));
  sam_call(SamTangentialSolve(t, bound, NULL, &other, PETSC_FALSE, r));
  reason = SamSolverGetReason(SamTangentialAsSolver(t));
  sam_call(SamSolverGetStatistics(SamTangentialAsSolver(t), NULL, &its, NULL, &preconditions));
  sam_assert(reason == SAM_SOLVER_CONVERGED_RTOL);
  sam_assert(its > 10 && preconditions == 0);
  sam_assert_close(Difference(r, q, NORM_2), 0, 1e-3); /* rtol 1e-6 times the condition, about n, twice, and a rate */
  sam_assert_close(other.rigid[0], balance.rigid[0], 1e-3 * balance.rigid[0]);
  sam_call(SamTangentialDestroy(&t));
  ClearOptions();
  sam_destroy(&bound, &q, &r);
  DestroySphere(&s);
}

static void AssertFails(PetscErrorCode code, PetscErrorCode expected, const char *says, const char *and_says)
{
  sam_assert(code == expected);
  sam_assert(strstr(CaughtMessage(), says) && strstr(CaughtMessage(), and_says));
  CaughtMessage()[0] = '\0';
}

/* The list of types is that of the registry; an option is blamed only where options are read. */
static void test_unknown_type_names_those_registered(void **state)
{
  Sphere        s = NewSphere(16, 1.5, 0.3);
  SamNormal     normal;
  SamSolverType type;

  (void)state;
  sam_call(SamNormalRegister("zzz", SamNormalCreate_Toy));
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamSolverSetOptionsPrefix(SamNormalAsSolver(normal), "my_"));
  Option("-my_normal_type", "foo");
  BeginCatching();
  AssertFails(SamSolverSetFromOptions(SamNormalAsSolver(normal)), SAM_ERR_USER, "-my_normal_type foo",
              "polonskykeer, toy or zzz");
  AssertFails(SamSolverSetType(SamNormalAsSolver(normal), "foo"), SAM_ERR_USER, "foo is not a type of normal solver",
              "activeset, polonskykeer");
  EndCatching();
  type = SamSolverGetType(SamNormalAsSolver(normal));
  sam_assert(!strcmp(type, SAM_NORMAL_ACTIVESET)); /* as it was */
  ClearOptions();
  sam_call(SamNormalDestroy(&normal));
  DestroySphere(&s);
}

static void test_options_go_through_the_setters(void **state)
{
  Sphere    s = NewSphere(16, 1.5, 0.3);
  SamNormal normal;
  PetscReal rtol;
  PetscInt  max_it;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamSolverGetTolerances(SamNormalAsSolver(normal), &rtol, &max_it));
  sam_assert(rtol == 1e-8 && max_it == 1000);
  Option("-normal_rtol", "1e-5");
  Option("-normal_max_it", "7");
  Option("-normal_levels", "2");
  sam_call(SamSolverSetFromOptions(SamNormalAsSolver(normal)));
  sam_call(SamSolverGetTolerances(SamNormalAsSolver(normal), &rtol, &max_it));
  sam_assert(rtol == 1e-5 && max_it == 7 && SamSolverLevels(SamNormalAsSolver(normal)) == 2);
  BeginCatching();
  AssertFails(SamSolverSetTolerances(SamNormalAsSolver(normal), 0, PETSC_DEFAULT), PETSC_ERR_ARG_OUTOFRANGE, "rtol 0",
              "> 0");
  AssertFails(SamSolverSetTolerances(SamNormalAsSolver(normal), PETSC_DEFAULT, -1), PETSC_ERR_ARG_OUTOFRANGE,
              "max_it -1", ">= 0");
  AssertFails(SamSolverSetLevels(SamNormalAsSolver(normal), -1), PETSC_ERR_ARG_OUTOFRANGE, "levels -1", ">= 0");
  EndCatching();
  ClearOptions();
  sam_call(SamNormalDestroy(&normal));
  DestroySphere(&s);
}

/* What the compiler must not convert into each other without a word. */
#define IS_SOLVER(handle) _Generic((handle), SamSolver : 1, default : 0)
_Static_assert(!IS_SOLVER((SamNormal)NULL) && !IS_SOLVER((SamTangential)NULL), "the types of solvers are the same");
_Static_assert(_Generic((SamNormal)NULL, SamTangential : 0, default : 1), "the types of solvers are the same");

static void test_balance_of_the_other_kind_is_refused(void **state)
{
  Sphere        s      = NewSphere(16, 1.5, 0.3);
  SamBalance    normal = Loaded(SAM_BALANCE_NORMAL, s.N), tangential = Loaded(SAM_BALANCE_TANGENTIAL, s.N);
  Vec           p = NewField(s.grid, 1), q = NewField(s.grid, 2);
  SamNormal     n;
  SamTangential t;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &n));
  sam_call(SamTangentialCreate(s.elasticity, &t));
  BeginCatching();
  AssertFails(SamNormalSolve(n, s.h, &tangential, PETSC_FALSE, p), PETSC_ERR_ARG_WRONG, "normal", "balance");
  AssertFails(SamTangentialSolve(t, s.h, NULL, &normal, PETSC_FALSE, q), PETSC_ERR_ARG_WRONG, "tangential", "balance");
  EndCatching();
  sam_call(SamNormalDestroy(&n));
  sam_call(SamTangentialDestroy(&t));
  sam_destroy(&p, &q);
  DestroySphere(&s);
}

static void test_not_converging_is_an_error_where_that_is_asked_for(void **state)
{
  Sphere     s       = NewSphere(33, 1.5, 0.3);
  SamBalance balance = Loaded(SAM_BALANCE_NORMAL, s.N), other = balance;
  Vec        p = NewField(s.grid, 1);
  SamNormal  normal;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamSolverSetTolerances(SamNormalAsSolver(normal), PETSC_DEFAULT, 1));
  sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p));
  sam_call(SamSolverSetErrorIfNotConverged(SamNormalAsSolver(normal), PETSC_TRUE));
  BeginCatching();
  AssertFails(SamNormalSolve(normal, s.h, &other, PETSC_FALSE, p), PETSC_ERR_NOT_CONVERGED, "normal", "DIVERGED_ITS");
  EndCatching();
  sam_assert(SamSolverGetReason(SamNormalAsSolver(normal)) == SAM_SOLVER_DIVERGED_ITS);
  sam_call(SamNormalDestroy(&normal));
  sam_call(VecDestroy(&p));
  DestroySphere(&s);
}

/* A solve depends on its input alone: not on what the solver did before. */
static void test_solve_is_a_function_of_its_input(void **state)
{
  Sphere     s   = NewSphere(48, 1.5, 0.3);
  SamBalance one = Loaded(SAM_BALANCE_NORMAL, s.N), half = Loaded(SAM_BALANCE_NORMAL, 0.5 * s.N), again = one;
  Vec        p = NewField(s.grid, 1), q = NewField(s.grid, 1);
  SamNormal  normal;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  sam_call(SamNormalSolve(normal, s.h, &one, PETSC_FALSE, p));
  sam_call(SamNormalSolve(normal, s.h, &half, PETSC_FALSE, q));
  sam_call(SamElasticitySetPart(s.elasticity, (const PetscInt[2]){0, 0}, (const PetscInt[2]){0, 0}));
  sam_call(SamNormalSolve(normal, s.h, &again, PETSC_FALSE, q));
  sam_assert(Difference(q, p, NORM_INFINITY) == 0);
  sam_assert(again.rigid[0] == one.rigid[0]);
  sam_call(SamNormalDestroy(&normal));
  sam_destroy(&p, &q);
  DestroySphere(&s);
}

static PetscErrorCode CountToyOptions(void *count, MPI_Comm comm, const char title[], const SamOptionHelp *option)
{
  (void)comm;
  (void)title;
  if (option && !strcmp(option->name, "normal_toy_relaxation")) ++*(int *)count;
  return 0;
}

static void test_help_lists_the_options_of_methods_that_are_not_chosen(void **state)
{
  Sphere        s     = NewSphere(32, 1.5, 0.3);
  int           count = 0;
  SamNormal     normal;
  SamSolverType type;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  SamHelpSetFunction(CountToyOptions, &count);
  Option("-help", NULL);
  sam_call(SamSolverSetFromOptions(SamNormalAsSolver(normal)));
  sam_assert(count == 2); /* of `toy` and of `zzz`, which have been registered by now */
  type = SamSolverGetType(SamNormalAsSolver(normal));
  sam_assert(!strcmp(type, SAM_NORMAL_ACTIVESET));
  SamHelpSetFunction(NULL, NULL);
  ClearOptions();
  sam_call(SamNormalDestroy(&normal));
  DestroySphere(&s);
}

static void test_a_coarse_grid_costs_no_more_than_it_can_save(void **state)
{
  Sphere    s   = NewSphere(16, 1.5, 0.3);
  SamGrid   row = NewGridOn(PETSC_COMM_WORLD, 16, 1, 1e-3, 1, 0, 0);
  SamNormal normal;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  for (PetscInt depth = 1; depth < 4; depth++)
    for (int plane = 0; plane < 2; plane++) {
      const PetscInt most  = plane ? 10 << depth : 10 << (2 * depth); /* as dear as 10 iterations on the finest grid */
      SamLevel       level = {.grid = plane ? row : s.grid, .depth = depth, .iterations = most - 1};

      sam_assert(!SamLevelAtMaxIterations(SamNormalAsSolver(normal), &level));
      level.iterations++;
      sam_assert(SamLevelAtMaxIterations(SamNormalAsSolver(normal), &level));
    }
  sam_call(SamNormalDestroy(&normal));
  sam_call(SamGridDestroy(&row));
  DestroySphere(&s);
}

static void test_work_is_counted_on_each_nested_grid(void **state)
{
  Sphere    s = NewSphere(64, 1.5, 0.3);
  Vec       p = NewField(s.grid, 1);
  PetscInt  applies;
  SamNormal normal;

  (void)state;
  sam_call(SamNormalCreate(s.elasticity, &normal));
  for (PetscInt solve = 1; solve < 3; solve++) {
    SamBalance balance = Loaded(SAM_BALANCE_NORMAL, s.N);

    sam_call(SamNormalSolve(normal, s.h, &balance, PETSC_FALSE, p));
    sam_call(SamSolverGetStatistics(SamNormalAsSolver(normal), NULL, NULL, &applies, NULL));
    for (PetscInt depth = 0; depth < 4; depth++) {
      const SamLevelWork *work = SamSolverGetWork(SamNormalAsSolver(normal), depth);

      sam_assert(work->n[0] == (depth < 3 ? 64 >> depth : 0) && work->n[1] == work->n[0]);
      sam_assert((work->iterations > 0) == (depth < 3) && (work->applies > 0) == (depth < 3));
      sam_assert(depth > 0 || work->applies == solve * applies);
    }
  }
  sam_call(SamNormalDestroy(&normal));
  sam_destroy(&p);
  DestroySphere(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_normal_method_from_outside_is_selected_by_its_option),
    cmocka_unit_test(test_tangential_method_from_outside_is_selected_by_its_option),
    cmocka_unit_test(test_unknown_type_names_those_registered),
    cmocka_unit_test(test_options_go_through_the_setters),
    cmocka_unit_test(test_balance_of_the_other_kind_is_refused),
    cmocka_unit_test(test_not_converging_is_an_error_where_that_is_asked_for),
    cmocka_unit_test(test_solve_is_a_function_of_its_input),
    cmocka_unit_test(test_help_lists_the_options_of_methods_that_are_not_chosen),
    cmocka_unit_test(test_a_coarse_grid_costs_no_more_than_it_can_save),
    cmocka_unit_test(test_work_is_counted_on_each_nested_grid),
  };

  return SamTestMainWith(argc, argv, RegisterMethods, tests, sizeof(tests) / sizeof(tests[0]));
}
