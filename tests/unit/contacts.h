/*
  Contacts, controls and steps for the tests of src/contact, src/run/io and src/front/app. All functions are
  collective.
*/
#ifndef PETSAM_CONTACTS_H
#define PETSAM_CONTACTS_H

#include "fields.h"

#include <petsam/private/contact.h>
#include <petsam/private/problemimpl.h>
#include <petsam/wear.h>
#include <petsam/private/control.h>
#include <petsam/private/law.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>

/* The coefficient of friction where a test does not say otherwise. */
#define MU 0.3

/* A sphere of radius 0.1 m on a grid about it, and its contact; loads in units of N, mu N and mu N a. */
typedef struct {
  Sphere     s;
  SamProblem problem;
  SamContact contact;
  double     friction;
} Case;

static inline SamPair Steel(void)
{
  return NewPair(210e9, 0.3, 210e9, 0.3);
}

static inline SamPair Dissimilar(void)
{
  return NewPair(210e9, 0.3, 70e9, 0.2);
}

/* The contact of a sphere; DestroyCase() destroys the sphere, too. */
static inline Case NewCaseOn(Sphere s, double friction, const char *prefix, const char *options)
{
  Case c = {.s = s, .friction = friction};

  SetOptions(options);
  sam_call(SamProblemCreate(c.s.elasticity, &c.problem));
  sam_call(SamProblemSetGap(c.problem, c.s.h));
  sam_call(SamProblemSetFriction(c.problem, friction));
  sam_call(SamProblemSetLawsFromOptions(c.problem, &(SamOptions){c.s.grid->comm, prefix}));
  sam_call(SamContactCreate(c.problem, &c.contact));
  sam_call(SamContactSetOptionsPrefix(c.contact, prefix));
  sam_call(SamContactSetFromOptions(c.contact));
  SetOptions("");
  return c;
}

/* n * n cells, half_width in units of a. */
static inline Case NewCase(SamPair pair, PetscInt n, double half_width, double friction, const char *options)
{
  return NewCaseOn(NewSphereOf(pair, n, half_width), friction, NULL, options);
}

/* The same of bodies that repeat in x and y; their gap is that of a sphere times `flatter`. */
static inline Case NewPeriodic(SamPair pair, PetscInt n, double half_width, double flatter, double friction,
                               const char *options)
{
  Sphere s = NewSphereOf(pair, n, half_width);

  sam_call(SamElasticitySetType(s.elasticity, SAM_ELASTICITY_PERIODIC));
  sam_call(VecScale(s.h, flatter));
  return NewCaseOn(s, friction, NULL, options);
}

static inline void DestroyCase(Case *c)
{
  sam_call(SamContactDestroy(&c->contact));
  sam_call(SamProblemDestroy(&c->problem));
  DestroySphere(&c->s);
}

/* From now on each step of the contact wears when it is committed. */
static inline void AddWear(const Case *c, SamLawType type, const PetscReal coefficient[2])
{
  SamLaw law;

  sam_call(SamProblemAddLawOfType(c->problem, type, &law));
  sam_call(SamLawSetWear(law, coefficient));
}

/* All six components under force control: N, Tx, Ty, Mz in the units of Case. */
static inline SamControl Loads(const Case *c, double N, double x, double y, double z)
{
  const double T = c->friction > 0 ? c->friction * c->s.N : c->s.N;
  SamControl   control;

  sam_call(SamControlInitialize(&control));
  control.value[SAM_COMPONENT_N]  = N * c->s.N;
  control.value[SAM_COMPONENT_TX] = x * T;
  control.value[SAM_COMPONENT_TY] = y * T;
  control.value[SAM_COMPONENT_MZ] = z * T * c->s.a;
  return control;
}

/* Prescribes a component or a condition by its name. */
static inline void Prescribe(SamProblem problem, SamControl *control, const char name[], PetscReal value)
{
  SamConditions conditions;

  conditions = SamProblemGetConditions(problem);
  sam_call(SamControlSet(control, conditions, name, value));
}

/* The value of a condition. */
static inline PetscReal Prescribed(SamProblem problem, const SamControl *control, const char name[])
{
  SamConditions conditions;

  conditions = SamProblemGetConditions(problem);
  return SamControlGet(control, SamConditionsFind(conditions, name));
}

/* A step that prescribes nothing but this factor on the friction. */
static inline SamControl Scaled(SamProblem problem, double scale)
{
  SamControl control;

  sam_call(SamControlInitialize(&control));
  Prescribe(problem, &control, SAM_FRICTION_SCALE, scale);
  return control;
}

/* The largest shear under a pressure, by laws that remember nothing. */
static inline void ComputeBound(SamProblem problem, double scale, Vec pressure, Vec bound)
{
  const SamControl control = Scaled(problem, scale);

  sam_call(SamProblemComputeBound(problem, &(SamBoundAt){.control = &control, .pressure = pressure},
                                  &(SamBound){.value = bound}));
}

/* Whether the coefficient of friction is this number everywhere. */
static inline int HasCoefficient(SamProblem problem, double expected)
{
  SamGrid   grid;
  SamLaw    law;
  PetscReal number, least, most;
  Vec       one;

  law = SamProblemGetLaw(problem, SAM_LAW_COULOMB);
  sam_call(SamLawGetFriction(law, &number));
  grid = SamProblemGetGrid(problem);
  one  = NewField(grid, 1);
  sam_call(VecSet(one, 1));
  ComputeBound(problem, 1, one, one);
  sam_call(VecMin(one, NULL, &least));
  sam_call(VecMax(one, NULL, &most));
  sam_call(VecDestroy(&one));
  return number == expected && least == expected && most == expected;
}

/* Prescribes a component by its displacement. */
static inline void Displace(SamControl *control, SamComponent component, double value)
{
  control->force[component] = PETSC_FALSE;
  control->value[component] = value;
}

/* Rotations are given, of none; surfaces that repeat do not turn. */
static inline void HoldRotations(SamControl *control)
{
  for (PetscInt k = SAM_COMPONENT_MX; k < SAM_COMPONENTS; k++) Displace(control, (SamComponent)k, 0);
}

/* Limits the iterations of the solvers; 0: their defaults. */
static inline void SetMostIterations(const Case *c, PetscInt normal, PetscInt tangential)
{
  SamNormal     n;
  SamTangential t;

  n = SamContactGetNormal(c->contact);
  t = SamContactGetTangential(c->contact);
  sam_call(SamSolverSetTolerances(SamNormalAsSolver(n), PETSC_DEFAULT, normal));
  sam_call(SamSolverSetTolerances(SamTangentialAsSolver(t), PETSC_DEFAULT, tangential));
}

/* A number of /history, of the tried step if there is one, else of the committed one. */
static inline double NumberOf(const Case *c, const char *name)
{
  PetscReal value;

  sam_call(SamContactGetNumber(c->contact, name, &value));
  return value;
}

static inline SamStep Try(const Case *c, const SamControl *control)
{
  SamStep step;

  sam_call(SamContactTry(c->contact, control, &step));
  if (getenv("SAM_SHOW"))
    print_message("# status %d passes %g its %g %g check %g %g %g %g %g %s\n", (int)step.status,
                  NumberOf(c, "coupling_iterations"), NumberOf(c, "normal_iterations"),
                  NumberOf(c, "tangential_iterations"), (double)step.check.normal, (double)step.check.tangential,
                  (double)step.check.equilibrium, (double)step.check.cone, (double)step.check.edge, step.message);
  return step;
}

/* Tries a step and commits it, if there is a solution. */
static inline SamStep Solve(const Case *c, const SamControl *control)
{
  const SamStep step = Try(c, control);

  if (step.status != SAM_STATUS_NO_EQUILIBRIUM) sam_call(SamContactCommit(c->contact));
  return step;
}

static inline const SamSolution *SolutionOf(const Case *c)
{
  const SamSolution *solution;

  sam_call(SamContactGetSolution(c->contact, &solution));
  return solution;
}

/* A field of the results, by its name there. */
static inline Vec NewFieldOf(const Case *c, const char *name)
{
  Vec field = NewField(c->s.grid, 1);

  sam_call(SamContactGetField(c->contact, name, field));
  return field;
}

static inline Vec NewSlip(const Case *c)
{
  const PetscInt cells     = c->s.grid->cells;
  Vec            component = NewField(c->s.grid, 1), slip = NewField(c->s.grid, 2);
  const double  *from;
  double        *to;

  sam_call(VecGetArray(slip, &to));
  for (PetscInt k = 0; k < 2; k++) {
    sam_call(SamContactGetField(c->contact, k ? "slip_y" : "slip_x", component));
    sam_call(VecGetArrayRead(component, &from));
    memcpy(to + k * cells, from, sizeof(*to) * (size_t)cells);
    sam_call(VecRestoreArrayRead(component, &from));
  }
  sam_call(VecRestoreArray(slip, &to));
  sam_call(VecDestroy(&component));
  return slip;
}

static inline Vec NewGap(const Case *c)
{
  return NewFieldOf(c, "gap");
}

static inline Vec NewPath(const Case *c)
{
  return NewFieldOf(c, "slip_path");
}

static inline Vec NewState(const Case *c)
{
  return NewFieldOf(c, "state");
}

/* A step of similar bodies at the solvers' default tolerances. */
static inline void AssertGood(const SamStep *step)
{
  sam_assert(step->status == SAM_STATUS_CONVERGED);
  sam_assert(step->message[0] == '\0');
  sam_assert(step->check.normal < 2e-8); /* the tolerances of the solvers, and rounding */
  sam_assert(step->check.tangential < 2e-6);
  sam_assert(step->check.equilibrium < 1e-11);
  sam_assert(step->check.cone < 1e-13);
  sam_assert(step->check.edge == 0);
}

static inline int SameBits(Vec a, Vec b)
{
  PetscBool same;

  sam_call(VecEqual(a, b, &same));
  return same;
}

static inline int SameBitsOf(const Case *one, const Case *other, Vec (*field)(const Case *c))
{
  Vec       a = field(one), b = field(other);
  const int same = SameBits(a, b);

  sam_destroy(&a, &b);
  return same;
}

/* All fields of two contacts, to the last bit. */
static inline void AssertSameFields(const Case *one, const Case *other)
{
  const SamSolution *a = SolutionOf(one), *b = SolutionOf(other);

  sam_assert(SameBits(a->pressure, b->pressure));
  sam_assert(SameBits(a->bound, b->bound));
  sam_assert(SameBits(a->shear, b->shear));
  sam_assert(SameBits(a->displacement_z, b->displacement_z));
  sam_assert(SameBits(a->displacement_t, b->displacement_t));
  sam_assert(SameBitsOf(one, other, NewSlip));
  sam_assert(SameBitsOf(one, other, NewGap));
  sam_assert(SameBitsOf(one, other, NewState));
}

static inline int SameNumbers(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  return !memcmp(a, b, sizeof(*a) * (size_t)n); /* NaN included */
}

/* Outcome, loads, displacements and check of two steps, to the last bit. */
static inline void AssertSameOutcomes(const SamStep *a, const SamStep *b)
{
  sam_assert(a->status == b->status && !strcmp(a->message, b->message));
  sam_assert(SameNumbers(SAM_COMPONENTS, a->load, b->load) && SameNumbers(SAM_COMPONENTS, a->rigid, b->rigid));
  sam_assert(SameNumbers(sizeof(SamCheck) / sizeof(PetscReal), &a->check.normal, &b->check.normal));
}

/*
  The same of the steps of two contacts, and all numbers of /history: of the tried steps if there are any, else of the
  committed ones.
*/
static inline void AssertSameSteps(const Case *one, const SamStep *a, const Case *other, const SamStep *b)
{
  SamState states[2];

  AssertSameOutcomes(a, b);
  sam_call(SamContactGetState(one->contact, &states[0]));
  sam_call(SamContactGetState(other->contact, &states[1]));
  for (PetscInt k = 0; k < SamStateCountNumbers(states[0]); k++) {
    PetscInt              id;
    const SamStateNumber *number = SamStateNumberOf(states[0], k, &id);
    const PetscInt        same   = SamStateFindNumber(states[1], number->name);

    if (!number->result) continue;
    sam_assert(same >= 0);
    if (!SameNumbers(number->count, SamStateReadNumbers(states[0], id), SamStateReadNumbers(states[1], same)))
      print_error("%s differs\n", number->name);
    sam_assert(SameNumbers(number->count, SamStateReadNumbers(states[0], id), SamStateReadNumbers(states[1], same)));
  }
}

/* The index in a field of the cell at column i and row j; -1 on the other ranks. */
static inline PetscInt CellAt(SamGrid grid, PetscInt i, PetscInt j)
{
  return j >= grid->row_start && j < grid->row_start + grid->rows ? (j - grid->row_start) * grid->nx + i : -1;
}

/* A sphere whose centre lies beside that of the grid by parts of a cell, pressed and pushed there: solved. */
static inline Case NewBeside(SamPair pair, PetscInt n, double half_width, double x, double y, double T,
                             const char *options)
{
  const double h     = 2 * half_width * 1e-3 / (double)n;
  Sphere       s     = NewSphereOn(PETSC_COMM_WORLD, pair, n, half_width, 0, 0);
  const double at[3] = {s.R, x * h, y * h};
  SamControl   control;
  SamStep      step;
  Case         c;

  sam_call(VecDestroy(&s.h));
  s.h                             = NewFrom(s.grid, ParaboloidAt, at);
  c                               = NewCaseOn(s, T > 0 ? MU : 0, NULL, options);
  control                         = Loads(&c, 1, T, 0, 0);
  control.value[SAM_COMPONENT_MX] = -at[2] * c.s.N;
  control.value[SAM_COMPONENT_MY] = at[1] * c.s.N;
  control.value[SAM_COMPONENT_MZ] = -at[2] * control.value[SAM_COMPONENT_TX];
  step                            = Solve(&c, &control);
  AssertGood(&step);
  return c;
}

/* The relative L2 errors against Hertz's pressure, raw and at the reconstructed points. */
static inline void HertzErrors(const Case *c, Vec point, double x, double y, double errors[2])
{
  const SamGrid grid    = c->s.grid;
  double        sums[3] = {0, 0, 0};
  const double *p, *w;

  sam_call(VecGetArrayRead(SolutionOf(c)->pressure, &p));
  sam_call(VecGetArrayRead(point, &w));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const double r =
      hypot(SamGridX(grid, k % grid->nx) - x * grid->dx, SamGridY(grid, grid->row_start + k / grid->nx) - y * grid->dy);
    const double exact = Hertz(&c->s, r);

    sums[0] += (p[k] - exact) * (p[k] - exact);
    sums[1] += (sqrt(fmax(w[k], 0)) - exact) * (sqrt(fmax(w[k], 0)) - exact);
    sums[2] += exact * exact;
  }
  sam_call(VecRestoreArrayRead(point, &w));
  sam_call(VecRestoreArrayRead(SolutionOf(c)->pressure, &p));
  (void)MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  for (int k = 0; k < 2; k++) errors[k] = sqrt(sums[k] / sums[2]);
}

#endif
