/*
  The resistance of bodies that relax in a steady state of rolling or sliding: the force of the pressure along x.

  It follows from the pressure, and has errors of second order, also in plane strain: it is extrapolated as F(h) + (F(h)
  - F(2h))/3. The coarse pressure has the found load N, as the means of the separation are shifted, but the moments or
  rotations that are prescribed: the found moment is the resistance itself. Hunter's cylinders on 96 cells have errors
  of 4e-5 to 2e-3, and 2e-7 to 1e-4 when extrapolated. Where an odd number of cells is halved, the means are not values
  at the centres of coarse cells, which is an error of first order: nothing is extrapolated there. Neither is it of
  periodic bodies, whose slopes and products have no error by the cells, but means of their heights have, nor under a
  tension, which coarse grids do not have.
*/
#include "stepimpl.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/normal.h>
#include <petsam/private/solver.h>

#define RESISTANCE      "rolling_resistance"
#define FINE_RESISTANCE RESISTANCE "_extrapolated"

PetscErrorCode SamStepDeclareResistance(SamElasticity bodies, SamState state)
{
  SamStateNumber number = {RESISTANCE,
                           SamUnitOn(SamElasticityGetGrid(bodies), "N"),
                           "force of the pressure along x, against material that moves towards -x",
                           SAM_NUMBER_REAL,
                           1,
                           PETSC_FALSE,
                           PETSC_TRUE,
                           SAM_JOIN_LAST,
                           2};
  PetscInt       id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareNumber(state, &number, &id));
  number.name  = FINE_RESISTANCE;
  number.text  = "force of the pressure along x, extrapolated to fine grids";
  number.order = 0;
  PetscCall(SamStateDeclareNumber(state, &number, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the slopes of a row of heights along x, m a cell: the means of those to both sides. */
static void SlopesOfRow(PetscInt n, const double h[], double slope[])
{
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt low = PetscMax(i - 1, 0), high = PetscMin(i + 1, n - 1);

    slope[i] = (h[high] - h[low]) / (double)(high - low);
  }
}

/* Computes the slopes of the separation along x, m a cell, in cells that bear the pressure: those of the displacement
   with the opposite sign, which has no jump, of bodies `of` that differentiate it. */
static PetscErrorCode FindExactSlopes(SamSolve *w, SamElasticity of, Vec pressure, Vec slopes)
{
  const double *u;
  double       *slope;
  Vec           moved;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(w->grid, 1, &moved));
  PetscCall(SamElasticityApplyNormal(w->elasticity, pressure, moved));
  PetscCall(VecGetArrayRead(moved, &u));
  PetscCall(VecGetArray(slopes, &slope));
  PetscCall((*of->ops.slope)(of, &u, &slope));
  PetscCall(VecRestoreArray(slopes, &slope));
  PetscCall(VecRestoreArrayRead(moved, &u));
  PetscCall(VecScale(slopes, -w->grid->dx));
  PetscCall(VecDestroy(&moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the slopes of the separation of the undeformed bodies along x, m a cell, in cells that bear the pressure. */
static PetscErrorCode FindSlopes(SamSolve *w, Vec pressure, Vec slopes)
{
  const SamGrid grid = w->grid;
  SamElasticity of   = w->elasticity;
  const double *h;
  double       *slope;

  PetscFunctionBegin;
  SamElasticityWith(of, slope);
  if (of->ops.slope) {
    PetscCall(FindExactSlopes(w, of, pressure, slopes));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecGetArrayRead(w->separation, &h));
  PetscCall(VecGetArray(slopes, &slope));
  for (PetscInt j = 0; j < grid->rows; j++)
    SlopesOfRow(grid->nx, h + (ptrdiff_t)j * grid->nx, slope + (ptrdiff_t)j * grid->nx);
  PetscCall(VecRestoreArray(slopes, &slope));
  PetscCall(VecRestoreArrayRead(w->separation, &h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the force of the pressure on the slopes of the separation of bodies that are tilted as they are, which is
   the moment of the pressure relative to the radius if that is a parabola and nothing tilts. */
static PetscErrorCode FindForce(SamSolve *w, double *force)
{
  const SamGrid grid  = w->grid;
  SamTotal      total = {0};
  SamRigid      motion;
  const double *p, *slope;
  Vec           slopes, pressure;

  PetscFunctionBegin;
  PetscCall(SamRigidSet(&motion, w->contact->problem, w->s));
  PetscCall(SamSolutionCreateTotal(w->contact->problem, w->s, &pressure));
  PetscCall(SamGridCreateVec(grid, 1, &slopes));
  PetscCall(FindSlopes(w, pressure, slopes));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(slopes, &slope));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t row  = (ptrdiff_t)j * grid->nx;
    const double    tilt = SamRigidOfGap(&motion, j).b * (double)(grid->dx / grid->length); /* in a cell */
    double          sum  = 0;

    for (PetscInt i = 0; i < grid->nx; i++) sum += p[row + i] * (slope[row + i] - tilt);
    SamAdd(&total, sum);
  }
  PetscCall(VecRestoreArrayRead(slopes, &slope));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(VecDestroy(&slopes));
  PetscCall(SamSolutionDestroyTotal(w->s, &pressure));
  PetscCall(SamSumTotals(grid->comm, 1, &total, force));
  *force *= (double)grid->dy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the normal problem of the step on the next coarser grid, from the mean of the fine pressure; computes the
   resistance there, NAN without a solution. */
static PetscErrorCode FindCoarse(SamSolve *w, SamElasticity bodies, SamTransfer transfer, double *force)
{
  const SamGrid grid     = SamElasticityGetGrid(bodies);
  SamSolution   solution = *w->s;
  SamStep       step     = *w->step;
  double        counts[SAM_COUNTS];
  SamSolve      coarse = {.contact      = w->contact,
                          .grid         = grid,
                          .elasticity   = bodies,
                          .s            = &solution,
                          .step         = &step,
                          .has_pressure = PETSC_TRUE,
                          .normal       = w->normal,
                          .counts       = counts};
  Vec           h, fine = w->separation;

  PetscFunctionBegin;
  coarse.normal.force[0] = PETSC_TRUE;
  coarse.normal.load[0]  = w->s->load[SAM_COMPONENT_N];
  PetscCall(PetscArrayzero(counts, SAM_COUNTS));
  PetscCall(SamSolveCreateCoarseNormal(w, bodies, &coarse.solver));
  PetscCall(SamGridCreateVec(grid, 1, &h));
  PetscCall(SamGridCreateVec(grid, 1, &coarse.separation));
  PetscCall(SamGridCreateVec(grid, 1, &solution.pressure));
  if (SamContactIsCoupled(w->contact)) PetscCall(VecCopy(w->lift, w->h));
  PetscCall(SamSolveGetSeparation(w, &fine));
  PetscCall(SamTransferRestrict(transfer, fine, h));
  PetscCall(SamTransferRestrict(transfer, w->separation, coarse.separation));
  PetscCall(SamTransferRestrict(transfer, w->s->pressure, solution.pressure));
  PetscCall(SamSolveSkewed(&coarse, h));
  *force = NAN;
  if (SamSolverGetReason(SamNormalAsSolver(coarse.solver)) > 0 && step.status == SAM_STATUS_CONVERGED)
    PetscCall(FindForce(&coarse, force));
  PetscCall(SamNormalDestroy(&coarse.solver));
  PetscCall(VecDestroy(&h));
  PetscCall(VecDestroy(&coarse.separation));
  PetscCall(VecDestroy(&solution.pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the next coarser grid joins two cells along each axis of the grid. */
static PetscBool IsEven(SamGrid grid)
{
  return grid->nx % 2 == 0 && (SamGridIsRow(grid) || grid->ny % 2 == 0) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamSolveResistance(SamSolve *w)
{
  const SamState state  = w->contact->state;
  double *const  number = SamStateNumbers(state, SamStateFindNumber(state, RESISTANCE), SAM_TRIED);
  double *const  fine   = SamStateNumbers(state, SamStateFindNumber(state, FINE_RESISTANCE), SAM_TRIED);
  SamElasticity  bodies = NULL;
  SamTransfer    transfer;
  double         coarse;

  PetscFunctionBegin;
  PetscCall(FindForce(w, number));
  *fine = NAN;
  if (w->contact->set.extrapolate && !w->contact->traits.periodic && !w->s->tension && IsEven(w->grid))
    PetscCall(SamElasticityGetCoarse(w->elasticity, &bodies, &transfer));
  if (!bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindCoarse(w, bodies, transfer, &coarse));
  *fine = *number + (*number - coarse) / 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}
