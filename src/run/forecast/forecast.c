/* Estimates, before a step is solved, how much of the grid the contact will take, for the memory, and the time. */
#include "forecast.h"
#include "scaling.h"
#include <math.h>
#include <unistd.h>
#include <petsam/private/advice.h>
#include <petsam/private/balance.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/problemimpl.h>

/* Share of the cells that count as in contact where no closed-form solution is known, as for rough surfaces */
#define UNKNOWN 0.3

/* Finds the half widths under the largest load and the largest approach; `known`: false if one has no solution. */
static PetscErrorCode FindHalf(SamSimulation s, PetscReal half[2], PetscBool *known)
{
  PetscReal most[2] = {0, 0}; /* approach, load */

  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->needs.steps; k = SamHistoryNextEnd(s->history, k)) {
    const SamControl control = SamHistoryGetStep(s->history, k);
    const PetscBool  force   = control.force[SAM_COMPONENT_N];

    most[force] = PetscMax(most[force], control.value[SAM_COMPONENT_N]);
  }
  half[0] = half[1] = 0;
  *known            = PETSC_TRUE;
  for (int force = 0; force < 2 && *known; force++) {
    PetscReal other[2];

    if (most[force] == 0) continue;
    PetscCall(SamAdviceEstimateContact(&s->setup, (PetscBool)force, most[force], other, known));
    for (int k = 0; k < 2; k++) half[k] = PetscMax(half[k], other[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the share of this rank's cells within the ellipse of these half widths. */
static PetscReal ShareOf(SamGrid g, const PetscReal half[2])
{
  PetscReal sum = 0;

  if (SamGridIsRow(g)) return PetscMin(1, 2 * half[0] / g->width[0]);
  for (PetscInt j = g->row_start; j < g->row_start + g->rows; j++) {
    const PetscReal y = g->center[1] + ((PetscReal)j + 0.5) * g->dy - 0.5 * g->width[1], part = y / half[1];

    if (fabs(part) < 1) sum += PetscMin(1, 2 * half[0] * sqrt(1 - part * part) / g->width[0]);
  }
  return g->rows ? sum / (PetscReal)g->rows : 0;
}

/* True if nothing moves the bodies along each other, or all loads grow together. */
static PetscBool BeginsByTouching(const SamControl *control)
{
  PetscBool only = PETSC_TRUE;

  for (PetscInt k = 0; k < 3; k++)
    only = only && control->value[SamComponentsOf[SAM_BALANCE_TANGENTIAL][k]] == 0 ? PETSC_TRUE : PETSC_FALSE;
  return control->together || only ? PETSC_TRUE : PETSC_FALSE;
}

/* Returns in which steps the solution of dissimilar bodies includes the motion until cells touch. */
static SamTouches FindTouches(SamSimulation s)
{
  SamTouches touches = SAM_TOUCHES_NEVER;
  SamControl before;

  if (!s->needs.friction || !s->needs.coupled || SamElasticityGetTraits(s->setup.elasticity).upwind) return touches;
  for (PetscInt k = 0; k < s->needs.steps && touches < SAM_TOUCHES_LATER; k = SamHistoryNextEnd(s->history, k)) {
    const SamControl control = SamHistoryGetStep(s->history, k);

    if (k == 0 && BeginsByTouching(&control)) touches = SAM_TOUCHES_FIRST;
    if (k > 0 && control.value[SAM_COMPONENT_N] > before.value[SAM_COMPONENT_N]) touches = SAM_TOUCHES_LATER;
    before = control;
  }
  return touches;
}

PetscErrorCode SamSimulationEstimateShares(SamSimulation s, SamSimulationNeeds *needs)
{
  const SamGrid   g      = s->setup.grid;
  const PetscReal d[2]   = {g->dx, g->dy};
  const PetscInt  all[2] = {g->nx, g->ny};
  PetscInt        n[2]   = {1, 1};
  PetscReal       half[2];
  PetscBool       known, end = PETSC_FALSE;
  char            direction[8] = "";

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-slip_direction", direction, sizeof(direction), NULL));
  PetscCall(PetscStrcmp(direction, "end", &end));
  needs->coupled = SamElasticityGetTraits(s->setup.elasticity).coupled;
  needs->slides  = SamProblemSlides(s->setup.problem);
  needs->touches = end ? SAM_TOUCHES_NEVER : FindTouches(s);
  needs->contact = UNKNOWN;
  needs->part    = 0;
  PetscCall(FindHalf(s, half, &known));
  if (!known) PetscFunctionReturn(PETSC_SUCCESS);
  needs->contact = ShareOf(g, half);
  for (PetscInt k = 0; k < g->axes; k++) n[k] = 2 * half[k] < g->width[k] ? (PetscInt)ceil(2 * half[k] / d[k]) : all[k];
  needs->part = SamElasticityGetPartShare(s->setup.elasticity, n);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Estimates a step's time (s) roughly from the time of operator applications with contact on half of the grid, which are
  half of the step's time. Most steps with friction need 15 of them for the shear, steps without friction 12 for the
  pressure.
*/
static PetscErrorCode TimeStep(SamSimulation s, double *seconds)
{
  const int products[2] = {12, 15};
  Vec       field;

  PetscFunctionBegin;
  *seconds = 0;
  for (PetscInt c = 0; c <= (PetscInt)s->needs.friction; c++) {
    PetscErrorCode (*const apply)(SamElasticity, Vec, Vec) =
      c ? SamElasticityApplyTangential : SamElasticityApplyNormal;
    double began = 0;

    PetscCall(SamGridCreateVec(s->setup.grid, c + 1, &field));
    for (int k = 0; k < 3; k++) { /* the first application creates the data that all need */
      PetscCall(VecSet(field, 1));
      if (k == 1) began = MPI_Wtime();
      PetscCall((*apply)(s->setup.elasticity, field, field));
    }
    *seconds += products[c] * (MPI_Wtime() - began) / 2;
    PetscCall(VecDestroy(&field));
  }
  PetscCall(SamMax(s->comm, 1, seconds));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the most ranks of a node: of this run if it is on several nodes, or the cores of this machine. */
static PetscErrorCode FindCores(MPI_Comm comm, int ranks, int *cores)
{
  double nodes, most;

  PetscFunctionBegin;
  PetscCall(SamCountNodes(comm, &nodes, &most));
  if (most == ranks) {
    most = PetscMax(most, (double)sysconf(_SC_NPROCESSORS_ONLN));
    PetscCall(SamMax(comm, 1, &most));
  }
  *cores = (int)most;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationGuessTime(SamSimulation s, SamSimulationStart *start)
{
  const SamGrid      g       = s->setup.grid;
  SamScaling         scaling = {.n        = {g->nx, g->ny},
                                .periodic = SamElasticityGetTraits(s->setup.elasticity).periodic,
                                .friction = s->needs.friction};
  const SamOptions   from    = {s->comm, NULL};
  SamFourierSettings fft     = {.send = PETSC_FALSE};
  PetscMPIInt        ranks;

  PetscFunctionBegin;
  PetscCall(TimeStep(s, &start->seconds));
  if (SamGridIsRow(g)) PetscFunctionReturn(PETSC_SUCCESS); /* one rank works */
  PetscCall(SamFourierSettingsFromOptions(&fft, &from));
  PetscCallMPI(MPI_Comm_size(s->comm, &ranks));
  scaling.ranks   = ranks;
  scaling.send    = fft.send;
  scaling.seconds = start->seconds;
  PetscCall(FindCores(s->comm, ranks, &scaling.cores));
  start->cores = scaling.cores;
  for (int k = 0; k < SAM_SCALINGS; k++) start->scaling[k] = SamScalingPredict(&scaling, 1 << k, scaling.cores);
  PetscFunctionReturn(PETSC_SUCCESS);
}
