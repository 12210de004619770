/* The largest stresses at the contact's edge, on the surface, of each step of the maps. */
#include "evaluationimpl.h"
#include <petsam/private/edges.h>

/* Least share of the edge that must be reconstructed, as the maximum may lie on the rest */
#define FOUND 0.95

enum { XX, YY, XY, PLANE = 3 };

/* Computes the square of the pressure, which on the surface is minus the stress zz. */
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

PetscErrorCode SamLargestAtEdge(SamEvaluation e, PetscInt step, Vec field)
{
  const SamGrid          g                          = e->grid;
  const PetscReal *const slide                      = SamPointsSlide(e, step);
  double                 far[SAM_STRESS_COMPONENTS] = {0}; /* stress without tractions */
  SamEdge                edge;
  Vec                    square;
  double                *stress;

  PetscFunctionBegin;
  if (SamStressPartsVary(e->parts)) PetscFunctionReturn(PETSC_SUCCESS); /* their stresses are not known there */
  SamStressPartsUniform(e->parts, step, e->depth[0], far);
  PetscCall(SamGridCreateVec(g, 1, &square));
  PetscCall(FillSquare(g, field, square));
  PetscCall(SamEdgeReconstruct(g, SamElasticityGetTraits(e->source.bodies).periodic, square, &edge));
  e->edge_lost += edge.faces > 0 && edge.good < FOUND * edge.faces;
  PetscCall(PetscMalloc1(PLANE * edge.count, &stress));
  PetscCall(SamStressAtEdge(e->stress, field, &edge, stress));
  for (PetscInt n = 0; n < edge.count && edge.good >= FOUND * edge.faces; n++) {
    const double *s                          = stress + (ptrdiff_t)PLANE * n;
    const double  all[SAM_STRESS_COMPONENTS] = {[SAM_STRESS_XX] = s[XX] + far[SAM_STRESS_XX],
                                                [SAM_STRESS_YY] = s[YY] + far[SAM_STRESS_YY],
                                                [SAM_STRESS_XY] = s[XY] + far[SAM_STRESS_XY]};
    const double place[3] = {(double)(edge.x[n] + (slide ? slide[0] : 0)), (double)(edge.y[n] + (slide ? slide[1] : 0)),
                             0};
    double       principal[3];

    if (isnan(s[XX])) continue;
    SamPrincipalOf(all, principal);
    SamLargestKeep(e, SAM_LARGEST_EDGE_XX, step, all[SAM_STRESS_XX], place);
    SamLargestKeep(e, SAM_LARGEST_EDGE_PRINCIPAL, step, principal[0], place);
  }
  PetscCall(PetscFree(stress));
  PetscCall(SamEdgeDestroy(&edge));
  PetscCall(VecDestroy(&square));
  PetscFunctionReturn(PETSC_SUCCESS);
}
