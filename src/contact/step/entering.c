/* The motion of the surfaces before cells come into contact: see direction.c, Beginning. */
#include <petsam/private/entering.h>
#include <petsam/private/balance.h>
#include <petsam/private/body.h>
#include <petsam/private/bodyimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/pressed.h>
#include <petsam/private/problem.h>
#include <math.h>

/* Growth of N, relative to it, below which it is rounding: the ratio of the changes of T and N says nothing there */
#define LEAST_GROWTH 1e-9

/* Returns a load before the step: zero before the first one. */
static PetscReal LoadBefore(const SamSolution *before, PetscInt component)
{
  return before ? before->load[component] : 0;
}

PetscBool SamApproachGrows(const SamSolution *before, const SamSolution *now)
{
  const PetscReal normal  = before ? SamSolutionGetNormal(before) : 0;
  const PetscBool touched = normal > 0 || now->control.together ? PETSC_TRUE : PETSC_FALSE;

  return touched && SamRuleEnters(now->rule) && SamSolutionGetNormal(now) > (1 + LEAST_GROWTH) * normal;
}

/* Returns kappa along x or y. */
static double RatioOfCompliances(SamElasticity e, int c)
{
  const SamPair pair = SamElasticityGetPair(e);

  return (double)((pair->shear + (SamElasticityGetTraits(e).plane ? c : (PetscReal)0.5) * pair->shear_xx) /
                  pair->normal);
}

static PetscErrorCode AddMotion(SamProblem problem, SamState state, const SamSolution *before, const SamSolution *now,
                                double normal, SamApproach *a)
{
  const SamElasticity elasticity = SamProblemGetElasticity(problem);
  SamStrain           e;

  PetscFunctionBegin;
  PetscCall(SamProblemDisplace(problem, state, &now->control, NULL, NULL, &a->strain, NULL));
  PetscCall(SamProblemDisplace(problem, state, &before->control, NULL, NULL, &e, NULL));
  a->strain    = (SamStrain){a->strain.xx - e.xx, a->strain.yy - e.yy, a->strain.xy - e.xy};
  a->center[0] = (double)(before->load[SAM_COMPONENT_MY] / before->load[SAM_COMPONENT_N]);
  a->center[1] = -(double)(before->load[SAM_COMPONENT_MX] / before->load[SAM_COMPONENT_N]);
  a->tilt[0]   = (double)(now->rigid[SAM_COMPONENT_MY] - before->rigid[SAM_COMPONENT_MY]);
  a->tilt[1]   = -(double)(now->rigid[SAM_COMPONENT_MX] - before->rigid[SAM_COMPONENT_MX]);
  a->uniform   = (double)(now->rigid[SAM_COMPONENT_N] - before->rigid[SAM_COMPONENT_N]) + a->tilt[0] * a->center[0] +
               a->tilt[1] * a->center[1];
  if (SamElasticityGetTraits(elasticity).plane)
    a->uniform = 4 * normal / (PETSC_PI * (double)SamElasticityGetModulus(elasticity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamApproachFind(SamProblem problem, SamState state, const SamSolution *before, const SamSolution *now,
                               const PetscReal tangential[2], SamApproach *a)
{
  const PetscReal load   = LoadBefore(before, SAM_COMPONENT_N);
  const double    normal = (double)(now->load[SAM_COMPONENT_N] - load);

  PetscFunctionBegin;
  *a = (SamApproach){.uniform = 1};
  for (PetscInt c = 0; c < 2; c++) {
    const PetscInt k = SamComponentsOf[SAM_BALANCE_TANGENTIAL][c];

    a->ratio[c] = (double)(tangential[c] - LoadBefore(before, k)) / normal;
    a->kappa[c] = RatioOfCompliances(SamProblemGetElasticity(problem), (int)c);
  }
  if (load > 0) PetscCall(AddMotion(problem, state, before, now, normal, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamApproachShear(const SamApproach *a, double x, double y, double tau[2])
{
  const double    at_x = x - a->center[0], at_y = y - a->center[1];
  const double    tilt = a->tilt[0] * at_x + a->tilt[1] * at_y, normal = a->uniform + 2 * PetscMax(0, tilt);
  const SamStrain e        = a->strain;
  const double    moved[2] = {e.xx * at_x + e.xy * at_y, e.xy * at_x + e.yy * at_y};

  for (int c = 0; c < 2; c++)
    tau[c] = a->uniform > 0 ? (a->ratio[c] * a->uniform - 2 * moved[c] / a->kappa[c]) / normal : 0;
}

/* Computes the gap before the step in cells that were open; it is 0 in others. */
static PetscErrorCode FindGaps(SamProblem problem, const SamSolution *before, Vec separation, Vec gap)
{
  const double *p;
  double       *g;

  PetscFunctionBegin;
  PetscCall(SamSolutionComputeGap(problem, before, before->displacement_z, separation, gap));
  PetscCall(VecGetArrayRead(before->pressure, &p));
  PetscCall(VecGetArray(gap, &g));
  for (PetscInt k = 0; k < SamProblemGetGrid(problem)->cells; k++) g[k] = SamIsPressed(p[k]) ? 0 : g[k];
  PetscCall(VecRestoreArray(gap, &g));
  PetscCall(VecRestoreArrayRead(before->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the distance of the undeformed bodies instead, in a step from no contact; it is 0 where they touch first. */
static PetscErrorCode FindDistances(SamProblem problem, const SamSolution *now, Vec separation, Vec distance)
{
  const SamGrid grid  = SamProblemGetGrid(problem);
  double        least = -INFINITY; /* the negative of the least distance */
  const double *p;
  double       *g;

  PetscFunctionBegin;
  PetscCall(SamSolutionComputeGap(problem, now, NULL, separation, distance));
  PetscCall(VecGetArrayRead(now->pressure, &p));
  PetscCall(VecGetArray(distance, &g));
  for (PetscInt k = 0; k < grid->cells; k++)
    if (SamIsPressed(p[k])) least = PetscMax(least, -g[k]);
  PetscCall(SamMax(grid->comm, 1, &least));
  for (PetscInt k = 0; k < grid->cells; k++) g[k] += least;
  PetscCall(VecRestoreArray(distance, &g));
  PetscCall(VecRestoreArrayRead(now->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamApproachGaps(SamProblem problem, const SamSolution *before, const SamSolution *now, Vec separation,
                               Vec gap)
{
  PetscFunctionBegin;
  PetscCall(LoadBefore(before, SAM_COMPONENT_N) > 0 ? FindGaps(problem, before, separation, gap)
                                                    : FindDistances(problem, now, separation, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}
