/* The edges of contact and stick of a solution, and tractions at the centres of cells. */
#include <petsam/private/solutionimpl.h>
#include <petsam/private/grid.h>
#include <petsam/private/problem.h>
#include <petsc/private/petscimpl.h> /* PetscObjectStateGet() */
#include <string.h>

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

/* ---- the edges that are kept ---- */

/* The edges of a solution and what they were found from; they are kept with its shear */
enum { FROM = 3 };
typedef struct {
  PetscObjectId    field[FROM];
  PetscObjectState state[FROM];
  SamEdge          edge[2];
  PetscBool        known[2];
} Kept;

static PetscErrorCode Forget(Kept *kept)
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) PetscCall(SamEdgeDestroy(&kept->edge[k]));
  *kept = (Kept){.known = {PETSC_FALSE}};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeKept(void *pointer)
{
  Kept *const kept = (Kept *)pointer;

  PetscFunctionBegin;
  PetscCall(Forget(kept));
  PetscCall(PetscFree(pointer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the edges kept with a solution's shear, without those of fields that have changed since. */
static PetscErrorCode GetKept(const SamSolution *s, Kept **kept)
{
  const Vec fields[FROM] = {s->pressure, s->bound, s->shear};
  Kept      now          = {.known = {PETSC_FALSE}};

  PetscFunctionBegin;
  for (int k = 0; k < FROM; k++) {
    PetscCall(PetscObjectGetId((PetscObject)fields[k], &now.field[k]));
    PetscCall(PetscObjectStateGet((PetscObject)fields[k], &now.state[k]));
  }
  PetscCall(SamVecGetOwned(s->shear, "sam_edges", (void **)kept));
  if (!*kept) {
    PetscCall(PetscNew(kept));
    PetscCall(SamVecOwn(s->shear, "sam_edges", *kept, FreeKept));
  }
  if (memcmp((*kept)->field, now.field, sizeof(now.field)) || memcmp((*kept)->state, now.state, sizeof(now.state))) {
    PetscCall(Forget(*kept));
    **kept = now;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionFindEdge(SamProblem problem, const SamSolution *s, SamEdgeOf which, const SamEdge **edge)
{
  const SamGrid   grid     = SamProblemGetGrid(problem);
  const PetscBool periodic = SamElasticityGetTraits(SamProblemGetElasticity(problem)).periodic;
  Kept           *kept;
  double          unknown;
  Vec             w;

  PetscFunctionBegin;
  PetscCall(GetKept(s, &kept));
  unknown = kept->known[which] ? 0 : 1;
  PetscCall(SamMax(grid->comm, 1, &unknown)); /* states of fields may differ between ranks */
  *edge = &kept->edge[which];
  if (unknown == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamEdgeDestroy(&kept->edge[which]));
  PetscCall(SamGridCreateVec(grid, 1, &w));
  PetscCall(FillSquares(s, which, w));
  PetscCall(SamEdgeReconstruct(grid, periodic, w, &kept->edge[which]));
  kept->known[which] = PETSC_TRUE;
  PetscCall(VecDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionCountHalf(SamProblem problem, const SamSolution *s, SamEdgeOf which, double half[2])
{
  const SamGrid   grid     = SamProblemGetGrid(problem);
  const PetscBool periodic = SamElasticityGetTraits(SamProblemGetElasticity(problem)).periodic;
  PetscInt        first[2], n[2];
  Vec             w;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &w));
  PetscCall(FillSquares(s, which, w));
  PetscCall(SamGridGetSupport(grid, w, periodic, first, n));
  for (int k = 0; k < 2; k++) half[k] = 0.5 * (double)n[k] * (double)(k ? grid->dy : grid->dx);
  PetscCall(VecDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- at the centres of cells ---- */

/* Computes the square root of the edge function, which vanishes at the edge, at the cells' centres. */
static PetscErrorCode ComputeRoots(SamProblem problem, const SamSolution *s, SamEdgeOf which, Vec root)
{
  const SamEdge *edge;
  double        *value;
  PetscInt       cells;

  PetscFunctionBegin;
  PetscCall(SamSolutionFindEdge(problem, s, which, &edge));
  PetscCall(FillSquares(s, which, root));
  PetscCall(SamEdgeCorrect(edge, root));
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
