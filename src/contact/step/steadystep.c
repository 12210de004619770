/*
  The numbers of steady rolling: frictional work per rolled distance, and the extrapolation to finer grids.

  The work is that of the loads on the creepages, xi Tx + eta Ty + phi Mz. Summed over cells, as -q.s, it lacks the
  numerical damping of the upwind difference, (D q).C (D q)/2, which is first order in the cell's size.

  The errors of loads and creepages are of first order, too. So the pressure and the shear of the same step are also
  solved on the next coarser grid, from the means of the fine ones, at a quarter of the cost. With h and H the sizes of
  the cells, F(h) + (F(h) - F(H)) h/(H - h) is as accurate as a much finer grid. The mean of the fine bound cannot serve
  as the coarse bound: it reaches half a cell farther on average.

  In plane strain the error depends on where the edges of contact and stick lie between the cells of the only row, and
  has no order: for Carter's cylinders on 32 to 1024 cells, extrapolation changes creepage errors of 0.02 to 1.9 % into
  0.1 to 3.5 %, and increases 21 of 32 errors. So no loads and creepages are extrapolated there.

  The rolling resistance of bodies that relax follows from the pressure, and has errors of second order, also in plane
  strain: it is extrapolated as F(h) + (F(h) - F(2h))/3. The coarse pressure has the found load N, as the means of the
  separation are shifted, but the moments or rotations that are prescribed: the found moment is the resistance itself.
  Hunter's cylinders on 96 cells have errors of 4e-5 to 2e-3, and 2e-7 to 1e-4 when extrapolated. Where an odd number of
  cells is halved, the means are not values at the centres of coarse cells, which is an error of first order: nothing is
  extrapolated there. Neither are the loads and creepages of such bodies, for want of an estimate of their error.
*/
#include "stepimpl.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/normal.h>
#include <petsam/private/problem.h>
#include <petsam/private/solver.h>

/* The numbers, side by side in the state: energies, then load and creepage by component */
#define RESISTANCE      "rolling_resistance"
#define FINE_RESISTANCE RESISTANCE "_extrapolated"
enum { ENERGY, LOADS, CREEPS = LOADS + 3, NUMBERS = CREEPS + 3 };

PetscErrorCode SamStepDeclareRolling(SamElasticity bodies, SamState state, PetscInt *first)
{
  char           name[64], text[96];
  SamStateNumber number = {"rolling_energy",
                           "J/m",
                           "frictional work per rolled distance, of loads and creepages",
                           SAM_NUMBER_REAL,
                           1,
                           PETSC_FALSE,
                           PETSC_TRUE,
                           SAM_JOIN_LAST,
                           2};
  PetscInt       id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareNumber(state, &number, first));
  for (PetscInt n = LOADS; n < NUMBERS; n++) {
    const SamComponentName *of   = &SamComponentNames[SamComponentsOf[SAM_BALANCE_TANGENTIAL][(n - LOADS) % 3]];
    const PetscBool         load = n < CREEPS;

    (void)snprintf(name, sizeof(name), "%s_extrapolated", load ? of->load : of->creep);
    (void)snprintf(text, sizeof(text), "%s, extrapolated to fine grids", load ? of->load_text : of->creep_text);
    number.name  = name;
    number.order = 0;
    number.unit  = load ? of->load_unit : of->creep_unit;
    number.text  = text;
    PetscCall(SamStateDeclareNumber(state, &number, &id));
  }
  number = (SamStateNumber){RESISTANCE,
                            SamUnitOn(SamElasticityGetGrid(bodies), "N"),
                            "force of the pressure against the rolling",
                            SAM_NUMBER_REAL,
                            1,
                            PETSC_FALSE,
                            PETSC_TRUE,
                            SAM_JOIN_LAST,
                            2};
  if (!SamElasticityGetTraits(bodies).skewed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStateDeclareNumber(state, &number, &id));
  number.name  = FINE_RESISTANCE;
  number.text  = "force of the pressure against the rolling, extrapolated to fine grids";
  number.order = 0;
  PetscCall(SamStateDeclareNumber(state, &number, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the next coarser grid ---- */

/* Fields of the coarse grid: separation, pressure, bound; means of the fine pressure and bound; two components each of
   shear and offset */
enum { SEPARATION, PRESSURE, BOUND, MEAN_PRESSURE, MEAN_BOUND, SHEAR, OFFSET, FIELDS };
typedef struct {
  SamElasticity elasticity;
  SamTransfer   transfer;
  SamGrid       grid;
  Vec           field[FIELDS];
  SamBalance    normal, tangential;
} Coarse;

static PetscErrorCode CreateCoarse(SamSolve *w, Coarse *k)
{
  PetscFunctionBegin;
  k->grid = SamElasticityGetGrid(k->elasticity);
  for (PetscInt n = 0; n < FIELDS; n++) PetscCall(SamGridCreateVec(k->grid, n < SHEAR ? 1 : 2, &k->field[n]));
  if (w->task->coupled) PetscCall(VecWAXPY(w->h, 1, w->lift, w->separation));
  PetscCall(SamTransferRestrict(k->transfer, w->task->coupled ? w->h : w->separation, k->field[SEPARATION]));
  PetscCall(SamTransferRestrict(k->transfer, w->s->pressure, k->field[MEAN_PRESSURE]));
  PetscCall(SamTransferRestrict(k->transfer, w->s->bound, k->field[MEAN_BOUND]));
  PetscCall(SamTransferRestrict(k->transfer, w->s->shear, k->field[SHEAR]));
  k->normal           = w->normal;
  k->tangential       = w->tangential;
  k->tangential.ahead = SamElasticitySpinAhead(k->elasticity);
  for (PetscInt n = 0; n < 3; n++) { /* the found loads define the same contact; the creepages are the start */
    const PetscInt c = SamComponentsOf[SAM_BALANCE_NORMAL][n];

    if (k->tangential.force[n]) k->tangential.rigid[n] = w->rigid[n];
    k->normal.force[n] = PETSC_TRUE;
    k->normal.load[n]  = w->s->load[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TakeTolerance(SamSolver from, SamSolver to)
{
  PetscReal rtol;

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(from, &rtol, NULL));
  PetscCall(SamSolverSetTolerances(to, rtol, PETSC_DEFAULT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates a solver of the normal problem of coarse bodies, with the settings of the step's own. */
static PetscErrorCode CreateNormal(SamSolve *w, SamElasticity bodies, SamNormal *normal)
{
  SamElasticity symmetric;
  PetscReal     limit;

  PetscFunctionBegin;
  PetscCall(SamProblemGetPressureLimit(w->task->problem, &limit));
  PetscCall(SamElasticityGetSymmetric(bodies, &symmetric));
  PetscCall(SamNormalCreate(symmetric, normal));
  PetscCall(TakeTolerance(SamNormalAsSolver(w->task->normal), SamNormalAsSolver(*normal)));
  PetscCall(SamNormalSetPressureLimit(*normal, limit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the bound: friction is averaged where the fine grid has contact; elsewhere it is the coefficient of the
   whole contact. */
static PetscErrorCode ComputeBound(Coarse *k)
{
  double   *f[SHEAR];
  PetscReal sums[2];

  PetscFunctionBegin;
  for (PetscInt n = 0; n < 2; n++) PetscCall(SamGridNorm(k->grid, k->field[MEAN_PRESSURE + n], NORM_1, &sums[n]));
  for (PetscInt n = 0; n < SHEAR; n++) PetscCall(VecGetArray(k->field[n], &f[n]));
  for (PetscInt i = 0; i < k->grid->cells; i++)
    f[BOUND][i] =
      f[PRESSURE][i] * (f[MEAN_PRESSURE][i] > 0 ? f[MEAN_BOUND][i] / f[MEAN_PRESSURE][i] : (double)(sums[1] / sums[0]));
  for (PetscInt n = 0; n < SHEAR; n++) PetscCall(VecRestoreArray(k->field[n], &f[n]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the pressure under the same normal loads, then the shear. */
static PetscErrorCode SolveCoarse(SamSolve *w, Coarse *k, SamSolverReason *reason)
{
  Vec *const    f = k->field;
  SamNormal     normal;
  SamTangential tangential;

  PetscFunctionBegin;
  PetscCall(CreateNormal(w, k->elasticity, &normal));
  PetscCall(VecCopy(f[MEAN_PRESSURE], f[PRESSURE]));
  PetscCall(SamNormalSolve(normal, f[SEPARATION], &k->normal, PETSC_TRUE, f[PRESSURE]));
  *reason = SamSolverGetReason(SamNormalAsSolver(normal));
  PetscCall(SamNormalDestroy(&normal));
  if (*reason < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ComputeBound(k));
  if (w->task->coupled) PetscCall(SamElasticityApplyNormalToTangential(k->elasticity, f[PRESSURE], f[OFFSET]));
  PetscCall(SamTangentialCreate(k->elasticity, &tangential));
  PetscCall(TakeTolerance(SamTangentialAsSolver(w->task->tangential), SamTangentialAsSolver(tangential)));
  PetscCall(SamTangentialSolve(tangential, f[BOUND], w->task->coupled ? f[OFFSET] : NULL, &k->tangential, PETSC_TRUE,
                               f[SHEAR]));
  *reason = SamSolverGetReason(SamTangentialAsSolver(tangential));
  PetscCall(SamTangentialDestroy(&tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- rolling resistance ---- */

/* Computes the force of the pressure on the slopes of the separation of bodies that are tilted as they are, which is
   the moment of the pressure relative to the radius if that is a parabola and nothing tilts: the mean of the slopes to
   both sides of a cell. */
static PetscErrorCode FindResistance(SamSolve *w, double *force)
{
  const SamGrid grid  = w->task->grid;
  SamTotal      total = {0};
  SamRigid      motion;
  const double *p, *h;

  PetscFunctionBegin;
  PetscCall(SamRigidSet(&motion, w->task->problem, w->s));
  PetscCall(VecGetArrayRead(w->s->pressure, &p));
  PetscCall(VecGetArrayRead(w->separation, &h));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const double *row = h + (ptrdiff_t)j * grid->nx, *of = p + (ptrdiff_t)j * grid->nx;
    const double  tilt = SamRigidOfGap(&motion, j).b * (double)(grid->dx / grid->length); /* in a cell */
    double        sum  = 0;

    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt low = PetscMax(i - 1, 0), high = PetscMin(i + 1, grid->nx - 1);

      if (of[i] > 0) sum += of[i] * ((row[high] - row[low]) / (double)(high - low) - tilt);
    }
    SamAdd(&total, sum);
  }
  PetscCall(VecRestoreArrayRead(w->separation, &h));
  PetscCall(VecRestoreArrayRead(w->s->pressure, &p));
  PetscCall(SamSumTotals(grid->comm, 1, &total, force));
  *force *= (double)grid->dy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the normal problem of the step on the next coarser grid, from the mean of the fine pressure; computes the
   resistance there, NAN without a solution. */
static PetscErrorCode FindCoarse(SamSolve *w, SamElasticity bodies, SamTransfer transfer, double *force)
{
  const SamGrid      grid     = SamElasticityGetGrid(bodies);
  SamStepTask        task     = *w->task;
  SamContactSettings quiet    = *task.set;
  SamSolution        solution = *w->s;
  SamStep            step     = *w->step;
  double             counts[SAM_COUNTS];
  SamSolve           coarse = {.task = &task, .s = &solution, .step = &step, .normal = w->normal, .counts = counts};
  Vec                h, fine = w->separation;

  PetscFunctionBegin;
  quiet.coupling_monitor = PETSC_FALSE;
  task.set               = &quiet;
  task.elasticity        = bodies;
  task.grid              = grid;
  task.coupled           = PETSC_FALSE; /* the lift is a part of the separation */
  coarse.normal.force[0] = PETSC_TRUE;
  coarse.normal.load[0]  = w->s->load[SAM_COMPONENT_N];
  PetscCall(PetscArrayzero(counts, SAM_COUNTS));
  PetscCall(CreateNormal(w, bodies, &task.normal));
  PetscCall(SamGridCreateVec(grid, 1, &h));
  PetscCall(SamGridCreateVec(grid, 1, &coarse.separation));
  PetscCall(SamGridCreateVec(grid, 1, &solution.pressure));
  if (w->task->coupled) PetscCall(VecCopy(w->lift, w->h));
  PetscCall(SamSolveGetSeparation(w, &fine));
  PetscCall(SamTransferRestrict(transfer, fine, h));
  PetscCall(SamTransferRestrict(transfer, w->separation, coarse.separation));
  PetscCall(SamTransferRestrict(transfer, w->s->pressure, solution.pressure));
  PetscCall(SamSolveSkewed(&coarse, h, PETSC_TRUE));
  *force = NAN;
  if (SamSolverGetReason(SamNormalAsSolver(task.normal)) > 0 && step.status == SAM_STATUS_CONVERGED)
    PetscCall(FindResistance(&coarse, force));
  PetscCall(SamNormalDestroy(&task.normal));
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

/* Computes the rolling resistance of bodies that relax, and its extrapolation, in the state. */
static PetscErrorCode StoreResistance(SamSolve *w)
{
  const SamState state  = w->task->state;
  double *const  number = SamStateNumbers(state, SamStateFindNumber(state, RESISTANCE), SAM_TRIED);
  double *const  fine   = SamStateNumbers(state, SamStateFindNumber(state, FINE_RESISTANCE), SAM_TRIED);
  SamElasticity  bodies = NULL;
  SamTransfer    transfer;
  double         coarse;

  PetscFunctionBegin;
  PetscCall(FindResistance(w, number));
  *fine = NAN;
  if (w->task->set->extrapolate && IsEven(w->task->grid))
    PetscCall(SamElasticityGetCoarse(w->task->elasticity, &bodies, &transfer));
  if (!bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindCoarse(w, bodies, transfer, &coarse));
  *fine = *number + (*number - coarse) / 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveRolling(SamSolve *w)
{
  double *const   numbers = SamStateNumbers(w->task->state, w->task->rolling, SAM_TRIED);
  Coarse          k       = {.elasticity = NULL};
  SamSolverReason reason  = SAM_SOLVER_ITERATING;

  PetscFunctionBegin;
  numbers[ENERGY] = 0;
  for (PetscInt n = 0; n < 3; n++) {
    const PetscInt t = SamComponentsOf[SAM_BALANCE_TANGENTIAL][n];

    numbers[ENERGY] += (double)(w->s->load[t] * w->s->rigid[t]);
    numbers[LOADS + n] = numbers[CREEPS + n] = NAN;
  }
  if (w->step->status != SAM_STATUS_CONVERGED || w->s->load[SAM_COMPONENT_N] <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (w->task->traits.skewed) PetscCall(StoreResistance(w));
  if (w->task->traits.plane || w->task->traits.skewed || !w->task->set->extrapolate) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityGetCoarse(w->task->elasticity, &k.elasticity, &k.transfer));
  if (!k.elasticity) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CreateCoarse(w, &k));
  PetscCall(SolveCoarse(w, &k, &reason));
  for (PetscInt n = 0; reason > 0 && n < 3; n++) {
    const PetscInt  t     = SamComponentsOf[SAM_BALANCE_TANGENTIAL][n];
    const double    ratio = (double)(w->task->grid->dx / (k.grid->dx - w->task->grid->dx));
    const PetscBool found = w->tangential.force[n];
    const double    fine  = (double)(found ? w->s->rigid : w->s->load)[t],
                 coarse   = (double)(found ? k.tangential.rigid : k.tangential.load)[n];

    numbers[(found ? CREEPS : LOADS) + n] = fine + ratio * (fine - coarse);
  }
  for (PetscInt n = 0; n < FIELDS; n++) PetscCall(VecDestroy(&k.field[n]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
