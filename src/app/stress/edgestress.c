/* The largest stresses at the contact's edge, on the surface, of each step of the maps. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/stressimpl.h>

/* The least share of the edge that must be found: the largest value may lie where it is not. */
#define FOUND 0.95

enum { XX, YY, XY, PLANE = 3 };

/* The square of the pressure, which on the surface is minus the stress zz. */
static PetscErrorCode FillSquare(SamGrid g, Vec field, Vec square)
{
  const double *stress;
  double       *w;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(field, &stress));
  PetscCall(VecGetArrayWrite(square, &w));
  for (PetscInt k = 0; k < g->cells; k++) {
    const double p = -stress[SAM_STRESS_ZZ * (ptrdiff_t)g->cells + k];

    w[k] = p > 0 ? p * p : 0;
  }
  PetscCall(VecRestoreArrayWrite(square, &w));
  PetscCall(VecRestoreArrayRead(field, &stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Keep(SamEdgeLargest *largest, double value, PetscReal x, PetscReal y)
{
  if (value > largest->value) *largest = (SamEdgeLargest){value, (double)x, (double)y};
}

PetscErrorCode SamEdgeStressCompute(SamStressRun *run, PetscInt step, Vec field)
{
  const SamGrid g    = run->grid;
  const double *bulk = run->bulk[step];
  SamEdge       edge;
  Vec           square;
  double       *stress;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, 1, &square));
  PetscCall(FillSquare(g, field, square));
  PetscCall(SamEdgeReconstruct(g, square, NULL, &edge));
  run->edge_left[step] = edge.faces > 0 && edge.good < FOUND * edge.faces;
  PetscCall(PetscMalloc1(PLANE * edge.count, &stress));
  PetscCall(SamStressAtEdge(g, run->poisson, field, &edge, stress));
  for (PetscInt n = 0; n < edge.count && edge.good >= FOUND * edge.faces; n++) {
    const double *s                          = stress + (ptrdiff_t)PLANE * n;
    const double  all[SAM_STRESS_COMPONENTS] = {[SAM_STRESS_XX] = s[XX] + bulk[SAM_BULK_XX],
                                                [SAM_STRESS_YY] = s[YY] + bulk[SAM_BULK_YY],
                                                [SAM_STRESS_XY] = s[XY] + bulk[SAM_BULK_XY]};
    double        principal[3];

    if (isnan(s[XX])) continue;
    SamPrincipalOf(all, principal);
    Keep(&run->edge_xx[step], all[SAM_STRESS_XX], edge.x[n], edge.y[n]);
    Keep(&run->edge_principal[step], principal[0], edge.x[n], edge.y[n]);
  }
  PetscCall(PetscFree(stress));
  PetscCall(SamEdgeDestroy(&edge));
  PetscCall(VecDestroy(&square));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest of all ranks; of equal ones that with the least x, then y. NaN without one. */
static PetscErrorCode Agree(MPI_Comm comm, SamEdgeLargest *largest)
{
  double value = largest->value, x, y;

  PetscFunctionBegin;
  PetscCall(SamMax(comm, 1, &value));
  x = largest->value == value ? -largest->x : -INFINITY;
  PetscCall(SamMax(comm, 1, &x));
  y = largest->value == value && -largest->x == x ? -largest->y : -INFINITY;
  PetscCall(SamMax(comm, 1, &y));
  *largest = value > -INFINITY ? (SamEdgeLargest){value, -x, -y} : (SamEdgeLargest){NAN, NAN, NAN};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Write(SamStressRun *run, const char name[], const char words[], SamEdgeLargest largest[])
{
  static const char *const endings[] = {"max", "max_x", "max_y"};
  double                  *values;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < run->steps; s++) PetscCall(Agree(run->grid->comm, &largest[s]));
  PetscCall(PetscMalloc1(run->steps, &values));
  for (int k = 0; k < 3; k++) {
    char dataset[64], text[128];

    for (PetscInt s = 0; s < run->steps; s++)
      values[s] = k == 0 ? largest[s].value : k == 1 ? largest[s].x : largest[s].y;
    PetscCall(PetscSNPrintf(dataset, sizeof(dataset), "%s_%s", name, endings[k]));
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s%s at the edge of contact, on the surface",
                            k == 0   ? ""
                            : k == 1 ? "x of the "
                                     : "y of the ",
                            words));
    PetscCall(SamStressFileSetHistory(run->file, dataset, k ? "m" : "Pa", text, values));
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step that is in contact, whose edge is not found. */
static PetscErrorCode WarnOfMissing(SamStressRun *run)
{
  PetscInt    missing = 0;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(run->grid->comm, &rank));
  for (PetscInt s = 0; s < run->steps; s++) missing += run->edge_left[s] ? 1 : 0;
  if (!missing || rank) PetscFunctionReturn(PETSC_SUCCESS);
  fprintf(
    stderr,
    "petsam-stress: warning: the edge of contact is not found in %ld of %ld steps, and /history/edge_stress_xx_max "
    "is NaN there: less than %.0f %% of it is smooth and resolved, or petsam has corrected it (-edges deferred): "
    "expected results of -edges reconstruct on a finer grid\n",
    (long)missing, (long)run->steps, 100 * FOUND);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEdgeStressWrite(SamStressRun *run)
{
  PetscBool surface = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < run->request.depths; k++)
    if (run->request.depth[k] == 0) surface = PETSC_TRUE;
  if (run->request.section || !surface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Write(run, "edge_stress_xx", "largest stress xx", run->edge_xx));
  PetscCall(Write(run, "edge_principal_1", "largest principal stress", run->edge_principal));
  PetscCall(WarnOfMissing(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}
