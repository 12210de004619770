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
  0.1 to 3.5 %, and increases 21 of 32 errors. So no loads and creepages are extrapolated there. Neither are those of
  bodies that relax, for want of an estimate of their error.
*/
#include "stepimpl.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/normal.h>
#include <petsam/private/problem.h>
#include <petsam/private/solver.h>

/* The numbers, side by side in the state: energy, then load and creepage by component */
enum { ENERGY, LOADS, CREEPS = LOADS + 3, NUMBERS = CREEPS + 3 };

PetscErrorCode SamStepDeclareRolling(SamState state, PetscInt *first)
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
  if (SamContactIsCoupled(w->contact)) PetscCall(VecWAXPY(w->h, 1, w->lift, w->separation));
  PetscCall(
    SamTransferRestrict(k->transfer, SamContactIsCoupled(w->contact) ? w->h : w->separation, k->field[SEPARATION]));
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

PetscErrorCode SamSolveCreateCoarseNormal(SamSolve *w, SamElasticity bodies, SamNormal *normal)
{
  SamElasticity symmetric;
  PetscReal     limit;

  PetscFunctionBegin;
  PetscCall(SamProblemGetPressureLimit(w->contact->problem, &limit));
  PetscCall(SamElasticityGetSymmetric(bodies, &symmetric));
  PetscCall(SamNormalCreate(symmetric, normal));
  PetscCall(TakeTolerance(SamNormalAsSolver(w->solver), SamNormalAsSolver(*normal)));
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
  PetscCall(SamSolveCreateCoarseNormal(w, k->elasticity, &normal));
  PetscCall(VecCopy(f[MEAN_PRESSURE], f[PRESSURE]));
  PetscCall(SamNormalSolve(normal, f[SEPARATION], &k->normal, PETSC_TRUE, f[PRESSURE]));
  *reason = SamSolverGetReason(SamNormalAsSolver(normal));
  PetscCall(SamNormalDestroy(&normal));
  if (*reason < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ComputeBound(k));
  if (SamContactIsCoupled(w->contact))
    PetscCall(SamElasticityApplyNormalToTangential(k->elasticity, f[PRESSURE], f[OFFSET]));
  PetscCall(SamTangentialCreate(k->elasticity, &tangential));
  PetscCall(TakeTolerance(SamTangentialAsSolver(w->contact->tangential), SamTangentialAsSolver(tangential)));
  PetscCall(SamTangentialSolve(tangential, f[BOUND], SamContactIsCoupled(w->contact) ? f[OFFSET] : NULL, &k->tangential,
                               PETSC_TRUE, f[SHEAR]));
  *reason = SamSolverGetReason(SamTangentialAsSolver(tangential));
  PetscCall(SamTangentialDestroy(&tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveRolling(SamSolve *w)
{
  double *const   numbers = SamStateNumbers(w->contact->state, w->contact->rolling, SAM_TRIED);
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
  if (w->contact->traits.plane || w->contact->traits.skewed || !w->contact->set.extrapolate)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityGetCoarse(w->elasticity, &k.elasticity, &k.transfer));
  if (!k.elasticity) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CreateCoarse(w, &k));
  PetscCall(SolveCoarse(w, &k, &reason));
  for (PetscInt n = 0; reason > 0 && n < 3; n++) {
    const PetscInt  t     = SamComponentsOf[SAM_BALANCE_TANGENTIAL][n];
    const double    ratio = (double)(w->grid->dx / (k.grid->dx - w->grid->dx));
    const PetscBool found = w->tangential.force[n];
    const double    fine  = (double)(found ? w->s->rigid : w->s->load)[t],
                 coarse   = (double)(found ? k.tangential.rigid : k.tangential.load)[n];

    numbers[(found ? CREEPS : LOADS) + n] = fine + ratio * (fine - coarse);
  }
  for (PetscInt n = 0; n < FIELDS; n++) PetscCall(VecDestroy(&k.field[n]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
