/*
  The tangent stiffness: a linear system for each rigid motion, and the loads of its solutions.

  Besides the six rigid motions there may be motions by conditions, such as the load cases of bodies. Their displacement
  v is that of body 2 relative to body 1, opposite to a rigid motion, and the load that belongs to it is sum t.v dA; so
  the motion that is solved is -v, and its row of the stiffness changes its sign.

  A system with a symmetric matrix A gives its part of the stiffness as b_i.x_j + x_i.r_j, b being the columns, x the
  solutions and r their residuals. This part is symmetric, and its error is of second order in the error of x. Without
  coupling the matrices of pressure and shear are symmetric. The unsymmetric part, by slipping cells whose shear follows
  the pressure, needs no separate system: it is the work of the shear b_p e dp on the slip of the motion, which the
  solutions for the shear give.
*/
#include "stiffnessimpl.h"
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/contact.h>
#include <petsam/private/stiffness.h>
#include <math.h>

enum { HALF = 3 }; /* normal or tangential motions */

/* The solutions of some systems, and the data of the stiffness, as arrays of packed fields */
typedef struct {
  SamFrozen f;
  PetscInt  count;   /* number of systems */
  PetscInt  motions; /* number of all motions */
  double   *b[SAM_STIFFNESS_MOST], *x[SAM_STIFFNESS_MOST];
  double   *slip[HALF]; /* of the tangential motions, without coupling; NULL: not wanted */
  double    k[SAM_STIFFNESS_MOST][SAM_STIFFNESS_MOST]; /* stiffness in the basis phi of the frames, normal first */
  PetscReal error;
} Systems;

/*
  Adds the part of the stiffness from symmetric systems, for motion j and the motions before it; r is its residual.
*/
static PetscErrorCode AddSymmetric(Systems *s, PetscInt first, PetscInt j, const double r[])
{
  double some[SAM_STIFFNESS_MOST], more[SAM_STIFFNESS_MOST];

  PetscFunctionBegin;
  PetscCall(SamFrozenDots(&s->f, j + 1, s->b, s->x[j], some));
  PetscCall(SamFrozenDots(&s->f, j + 1, s->x, r, more));
  for (PetscInt i = 0; i <= j; i++) s->k[first + i][first + j] = s->k[first + j][first + i] = some[i] + more[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the loads of a motion's solution if the matrix is not symmetric. */
static PetscErrorCode AddLoads(Systems *s, PetscInt j)
{
  const PetscInt m = s->f.count;
  double        *motion[SAM_STIFFNESS_MOST], *traction, loads[SAM_STIFFNESS_MOST];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * m, &traction));
  PetscCall(PetscArraycpy(traction, s->x[j], m));
  SamFrozenShear(&s->f, s->x[j], s->x[j] + m, traction + m);
  for (PetscInt i = 0; i < s->motions; i++) {
    PetscCall(PetscMalloc1(3 * m, &motion[i]));
    SamFrozenMotion(&s->f, i, SAM_FROZEN_BOTH, motion[i]);
  }
  PetscCall(SamFrozenDots(&s->f, s->motions, motion, traction, loads));
  for (PetscInt i = 0; i < s->motions; i++) {
    s->k[i][j] = loads[i];
    PetscCall(PetscFree(motion[i]));
  }
  PetscCall(PetscFree(traction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves `count` systems of a part, for the motions from `first` on, and adds their results. */
static PetscErrorCode Solve(Systems *s, SamFrozenPart part, PetscInt first, PetscInt count, PetscBool symmetric)
{
  double *r;

  PetscFunctionBegin;
  s->f.part = part;
  s->count  = count;
  PetscCall(PetscMalloc1(SamFrozenSize(&s->f), &r));
  for (PetscInt i = 0; i < count; i++) {
    const PetscInt n = SamFrozenSize(&s->f);
    PetscReal      error;

    PetscCall(PetscMalloc2(n, &s->b[i], n, &s->x[i]));
    SamFrozenColumn(&s->f, first + i, s->b[i]);
    PetscCall(SamKrylovSolve(&s->f, s->b[i], s->x[i], r, &error));
    s->error = SamLarger(s->error, error);
    if (symmetric)
      PetscCall(AddSymmetric(s, first, i, r));
    else
      PetscCall(AddLoads(s, i));
    if (part != SAM_FROZEN_TANGENTIAL) continue;
    PetscCall(PetscMalloc1(n, &s->slip[i]));
    PetscCall(SamFrozenTakeSlip(&s->f, first + i, s->slip[i]));
  }
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Free(Systems *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->count; i++) PetscCall(PetscFree2(s->b[i], s->x[i]));
  for (PetscInt i = 0; i < HALF; i++) PetscCall(PetscFree(s->slip[i]));
  s->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stiffness without coupling: the pressure, then the shear, and the change of the shear with the
   pressure. */
static PetscErrorCode ComputeUncoupled(Systems *s)
{
  double *follow[HALF];

  PetscFunctionBegin;
  PetscCall(Solve(s, SAM_FROZEN_NORMAL, 0, HALF, PETSC_TRUE));
  for (PetscInt j = 0; j < HALF; j++) {
    PetscCall(PetscMalloc1(2 * s->f.count, &follow[j]));
    SamFrozenShear(&s->f, s->x[j], NULL, follow[j]);
  }
  PetscCall(Free(s));
  PetscCall(Solve(s, SAM_FROZEN_TANGENTIAL, HALF, HALF, PETSC_TRUE));
  for (PetscInt j = 0; j < HALF; j++) {
    double dots[HALF];

    PetscCall(SamFrozenDots(&s->f, HALF, s->slip, follow[j], dots));
    for (PetscInt i = 0; i < HALF; i++) s->k[HALF + i][j] = -dots[i];
    PetscCall(PetscFree(follow[j]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the combination of the grid's phi for each rigid motion: to[k][c] of phi k and component c; others stay. */
static void SetMotions(SamGrid grid, PetscInt motions, double to[][SAM_STIFFNESS_MOST])
{
  for (PetscInt k = SAM_COMPONENTS; k < motions; k++) to[k][k] = 1;
  for (PetscInt kind = 0; kind < 2; kind++)
    for (PetscInt c = 0; c < HALF; c++) {
      double row[HALF];

      SamFrameGetComponent(grid, (SamBalanceKind)kind, c, row);
      for (PetscInt k = 0; k < HALF; k++) to[HALF * kind + k][SamComponentsOf[kind][c]] = row[k];
    }
}

/* Computes the stiffness of the six components; NaN for rotations that the bodies do not have. */
static void Transform(const Systems *s, const PetscBool rotations[3], SamStiffness *stiffness)
{
  double       to[SAM_STIFFNESS_MOST][SAM_STIFFNESS_MOST] = {{0}};
  const double area                                       = s->f.grid->dx * s->f.grid->dy;
  PetscBool    has[SAM_STIFFNESS_MOST];

  for (PetscInt k = 0; k < s->motions; k++)
    has[k] = k < SAM_COMPONENT_MX || k >= SAM_COMPONENTS || rotations[k - SAM_COMPONENT_MX] ? PETSC_TRUE : PETSC_FALSE;
  SetMotions(s->f.grid, s->motions, to);
  for (PetscInt i = 0; i < s->motions; i++)
    for (PetscInt j = 0; j < s->motions; j++) {
      double sum = 0;

      for (PetscInt k = 0; k < s->motions; k++)
        for (PetscInt l = 0; l < s->motions; l++) sum += to[k][i] * s->k[k][l] * to[l][j];
      if (i >= SAM_COMPONENTS) sum = -sum;
      stiffness->k[i][j] = stiffness->converged && has[i] && has[j] ? sum * area : NAN;
    }
}

/* Refuses laws whose offset follows the tractions in an unknown way. */
static PetscErrorCode CheckLaws(SamContact contact)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(SamProblemGetLaws(SamContactGetProblem(contact), &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    PetscCheck(((!laws[k]->ops.follow && !laws[k]->ops.attract) || laws[k]->ops.tangent) && !laws[k]->nonlocal,
               SamContactGetGrid(contact)->comm, SAM_ERR_USER, "-stiffness: not supported with -%s",
               SamLawOption(laws[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckConditions(SamContact contact, PetscInt count, const SamCondition *const conditions[])
{
  const MPI_Comm comm = SamContactGetGrid(contact)->comm;

  PetscFunctionBegin;
  PetscCheck(count <= SAM_STIFFNESS_MOST - SAM_COMPONENTS, comm, SAM_ERR_USER,
             "the stiffness over %" PetscInt_FMT " load cases: expected at most %d", count,
             SAM_STIFFNESS_MOST - SAM_COMPONENTS);
  for (PetscInt k = 0; k < count; k++)
    PetscCheck(conditions[k]->conjugate, comm, SAM_ERR_USER,
               "%s: has no load that belongs to it, and so no stiffness: name load cases of bodies",
               conditions[k]->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Afterwards the elasticity may use another part of the grid: each try chooses its own part. */
PetscErrorCode SamStiffnessCompute(SamContact contact, SamStiffnessDirection direction, PetscInt count,
                                   const SamCondition *const conditions[], SamStiffness *stiffness)
{
  Systems     s        = {.error = 0, .motions = SAM_COMPONENTS + count};
  SamResponse response = {.window = NULL};

  PetscFunctionBegin;
  SamValidHandle(contact, SamContact, 1);
  SamValidPointer(stiffness, 5);
  PetscCall(CheckConditions(contact, count, conditions));
  PetscCall(SamMotionRefuse(SamContactGetMotion(contact), SAM_MOTION_STIFFNESS, PETSC_COMM_SELF, "-", "stiffness"));
  PetscCall(CheckLaws(contact));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_STIFFNESS], 0, 0, 0, 0));
  PetscCall(SamStiffnessFreeze(contact, direction, count, conditions, &response, &s.f));
  if (s.f.coupled)
    PetscCall(Solve(&s, SAM_FROZEN_BOTH, 0, s.motions, direction == SAM_STIFFNESS_REVERSAL && !s.f.respond));
  else
    PetscCall(ComputeUncoupled(&s));
  PetscCall(Free(&s));
  *stiffness = (SamStiffness){.converged     = s.error <= SAM_FROZEN_RTOL ? PETSC_TRUE : PETSC_FALSE,
                              .error         = s.error,
                              .columns       = s.motions,
                              .applies       = s.f.applies,
                              .preconditions = s.f.preconditions};
  Transform(&s, SamElasticityGetTraits(SamProblemGetElasticity(SamContactGetProblem(contact))).rotations, stiffness);
  PetscCall(SamStiffnessThaw(&response, &s.f));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_STIFFNESS], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- numbers of a step ---- */

static const SamStateNumber numbers[SAM_STIFFNESS_DIRECTIONS] = {
  {"stiffness", "N/m, N/rad, N, N m/rad", "d(loads)/d(rigid-body displacements) for continued loading",
   SAM_NUMBER_MATRIX, SAM_COMPONENTS *SAM_COMPONENTS, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0},
  {"stiffness_reversal", "N/m, N/rad, N, N m/rad", "d(loads)/d(rigid-body displacements) at a load reversal",
   SAM_NUMBER_MATRIX, SAM_COMPONENTS *SAM_COMPONENTS, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0}};

PetscErrorCode SamStiffnessDeclare(SamContact contact)
{
  SamState state;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamMotionRefuse(SamContactGetMotion(contact), SAM_MOTION_STIFFNESS, PETSC_COMM_SELF, "-", "stiffness"));
  PetscCall(CheckLaws(contact));
  PetscCall(SamContactGetState(contact, &state));
  for (int k = 0; k < SAM_STIFFNESS_DIRECTIONS; k++) PetscCall(SamStateDeclareNumber(state, &numbers[k], &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamStiffnessDescribe(const SamStiffness *s, char text[], size_t size)
{
  text[0] = '\0';
  if (!s->converged)
    (void)snprintf(text, size, "the tangent stiffness did not converge: relative residual %.2g", (double)s->error);
}

PetscErrorCode SamStiffnessRecord(SamContact contact, SamStep *step)
{
  SamState state;

  PetscFunctionBegin;
  if (!SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetState(contact, &state));
  for (int k = 0; k < SAM_STIFFNESS_DIRECTIONS; k++) {
    SamStiffness s;
    double      *to;

    PetscCall(SamStiffnessCompute(contact, (SamStiffnessDirection)k, 0, NULL, &s));
    to = SamStateNumbers(state, SamStateFindNumber(state, numbers[k].name), SAM_TRIED);
    for (PetscInt i = 0; i < SAM_COMPONENTS; i++)
      PetscCall(PetscArraycpy(to + SAM_COMPONENTS * i, s.k[i], SAM_COMPONENTS));
    if (!s.converged && !step->message[0]) SamStiffnessDescribe(&s, step->message, sizeof(step->message));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
