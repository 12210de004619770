/* The edges of contact and stick of a solution, and tractions at the centres of cells. */
#include <petsam/private/solutionimpl.h>
#include <petsam/private/problem.h>

/*
  Fills in an edge function of this rank's cells, linear in the distance from the edge: p^2 for the contact,
  (p - |q|/mu)^2 for the stick zone.
*/
static PetscErrorCode FillSquares(const SamSolution *s, SamEdgeOf which, Vec w)
{
  const PetscBool stick = which == SAM_EDGE_STICK;
  SamValues       v;
  double         *square;

  PetscFunctionBegin;
  PetscCall(SamValuesGet(s, &v));
  PetscCall(VecGetArrayWrite(w, &square));
  for (PetscInt k = 0; k < v.cells; k++) {
    const double p = v.p[k], b = v.b[k], qx = v.q[k], qy = v.q[k + v.cells];
    const double slack = stick && b > 0 ? p * (1 - sqrt(qx * qx + qy * qy) / b) : p;

    square[k] = p > 0 && (!stick || SamCellStateOf(p, qx, qy, b) == SAM_CELL_STICK) ? slack * slack : 0;
  }
  PetscCall(VecRestoreArrayWrite(w, &square));
  PetscCall(SamValuesRestore(s, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionFindEdge(SamProblem problem, const SamSolution *s, SamEdgeOf which, Vec point, SamEdge *edge)
{
  const SamGrid   grid     = SamProblemGetGrid(problem);
  const PetscBool periodic = SamElasticityGetTraits(SamProblemGetElasticity(problem)).periodic;
  Vec             w;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &w));
  PetscCall(FillSquares(s, which, w));
  PetscCall(SamEdgeReconstruct(grid, periodic, w, point, edge));
  PetscCall(VecDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- at the centres of cells ---- */

/* Computes the square root of the edge function, which vanishes at the edge, at the cells' centres. */
static PetscErrorCode ComputeRoots(SamProblem problem, const SamSolution *s, SamEdgeOf which, Vec root)
{
  SamEdge  edge;
  double  *value;
  PetscInt cells;

  PetscFunctionBegin;
  PetscCall(SamSolutionFindEdge(problem, s, which, root, &edge));
  PetscCall(SamEdgeDestroy(&edge));
  PetscCall(VecGetLocalSize(root, &cells));
  PetscCall(VecGetArray(root, &value));
  for (PetscInt k = 0; k < cells; k++) value[k] = value[k] > 0 ? sqrt(value[k]) : 0;
  PetscCall(VecRestoreArray(root, &value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionComputePressureCenter(SamProblem problem, const SamSolution *s, Vec pressure)
{
  PetscFunctionBegin;
  PetscCall(ComputeRoots(problem, s, SAM_EDGE_CONTACT, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The shear keeps its direction; its size is mu times (pressure minus slack), both at the centre. */
PetscErrorCode SamSolutionComputeShearCenter(SamProblem problem, const SamSolution *s, PetscInt component, Vec shear)
{
  const double *at;
  double       *value;
  SamValues     v;
  Vec           pressure;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(shear, &pressure));
  PetscCall(ComputeRoots(problem, s, SAM_EDGE_CONTACT, pressure));
  PetscCall(ComputeRoots(problem, s, SAM_EDGE_STICK, shear));
  PetscCall(SamValuesGet(s, &v));
  PetscCall(VecGetArrayRead(pressure, &at));
  PetscCall(VecGetArray(shear, &value));
  for (PetscInt k = 0; k < v.cells; k++) {
    const double size = hypot(v.q[k], v.q[k + v.cells]);

    value[k] = size > 0 ? PetscMax(at[k] - value[k], 0) * v.b[k] / v.p[k] * v.q[k + component * v.cells] / size : 0;
  }
  PetscCall(VecRestoreArray(shear, &value));
  PetscCall(VecRestoreArrayRead(pressure, &at));
  PetscCall(SamValuesRestore(s, &v));
  PetscCall(VecDestroy(&pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
