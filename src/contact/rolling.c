/*
  The numbers of steady rolling: frictional work per rolled distance, and what finer grids would give.

  The work is that of the loads on the creepages, xi Tx + eta Ty + phi Mz. Summed over cells, as -q.s, it lacks the
  numerical damping of the upwind difference, (D q).C (D q)/2, which is first order in the cell's size.

  So are loads and creepages. The same step is solved on the next coarser grid, pressure and shear, at a quarter of the
  cost; with h and H the sizes of the cells, F(h) + (F(h) - F(H)) h/(H - h) is as good as a much finer grid. A coarse
  bound that is the mean of the fine one would not do: it reaches half a cell farther on the average.
*/
#include "stepimpl.h"

/* The numbers, side by side in the state: energies, then by component load and creepage. */
enum { ENERGY, LOADS, CREEPS = LOADS + 3, NUMBERS = CREEPS + 3 };

PetscErrorCode SamContactDeclareRolling(SamContact c)
{
  char           name[64], text[96];
  SamStateNumber number = {"rolling_energy", "J/m", "frictional work per rolled distance, of loads and creepages",
                           SAM_NUMBER_REAL,  1,     PETSC_FALSE,
                           PETSC_TRUE};
  PetscInt       id;

  PetscFunctionBegin;
  if (!c->traits.steady) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamStateDeclareNumber(c->state, &number, &c->rolling));
  for (PetscInt n = LOADS; n < NUMBERS; n++) {
    const SamComponentName *of   = &SamComponentNames[SamComponentsOf[SAM_BALANCE_TANGENTIAL][(n - LOADS) % 3]];
    const PetscBool         load = n < CREEPS;

    (void)snprintf(name, sizeof(name), "%s_extrapolated", load ? of->load : of->creep);
    (void)snprintf(text, sizeof(text), "%s, extrapolated to fine grids", load ? of->load_text : of->creep_text);
    number.name = name;
    number.unit = load ? of->load_unit : of->creep_unit;
    number.text = text;
    PetscCall(SamStateDeclareNumber(c->state, &number, &id));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the next coarser grid ---- */

typedef struct {
  SamElasticity elasticity;
  SamTransfer   transfer;
  SamGrid       grid;
  Vec           separation, pressure, bound, mean[2], shear, offset;
  SamBalance    normal, tangential;
} Coarse;

static PetscErrorCode CreateCoarse(SamSolve *w, Coarse *k)
{
  Vec h = w->separation;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetGrid(k->elasticity, &k->grid));
  for (PetscInt n = 0; n < 2; n++) PetscCall(SamGridCreateVec(k->grid, 1, &k->mean[n]));
  PetscCall(SamGridCreateVec(k->grid, 1, &k->separation));
  PetscCall(SamGridCreateVec(k->grid, 1, &k->pressure));
  PetscCall(SamGridCreateVec(k->grid, 1, &k->bound));
  PetscCall(SamGridCreateVec(k->grid, 2, &k->shear));
  if (w->coupled) {
    PetscCall(SamGridCreateVec(k->grid, 2, &k->offset));
    PetscCall(VecWAXPY(w->h, 1, w->lift, w->separation));
    h = w->h;
  }
  PetscCall(SamTransferRestrict(k->transfer, h, k->separation));
  PetscCall(SamTransferRestrict(k->transfer, w->s->pressure, k->mean[0]));
  PetscCall(SamTransferRestrict(k->transfer, w->s->bound, k->mean[1]));
  k->normal     = SamControlGetBalance(&w->s->control, SAM_BALANCE_NORMAL);
  k->tangential = SamControlGetBalance(&w->s->control, SAM_BALANCE_TANGENTIAL);
  for (PetscInt n = 0; n < 3; n++) { /* the loads that were found: the same contact */
    k->normal.force[n] = w->c->traits.rotations[0] || n == 0 ? PETSC_TRUE : PETSC_FALSE;
    k->normal.load[n]  = w->s->load[SamComponentsOf[SAM_BALANCE_NORMAL][n]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyCoarse(Coarse *k)
{
  PetscFunctionBegin;
  for (PetscInt n = 0; n < 2; n++) PetscCall(VecDestroy(&k->mean[n]));
  PetscCall(VecDestroy(&k->separation));
  PetscCall(VecDestroy(&k->pressure));
  PetscCall(VecDestroy(&k->bound));
  PetscCall(VecDestroy(&k->shear));
  PetscCall(VecDestroy(&k->offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pressure under the same normal loads. */
static PetscErrorCode SolvePressure(SamSolve *w, Coarse *k, SamSolverReason *reason)
{
  SamNormal normal;
  PetscReal rtol, limit;

  PetscFunctionBegin;
  PetscCall(SamSolverGetTolerances(SamNormalAsSolver(w->c->normal), &rtol, NULL));
  PetscCall(SamProblemGetPressureLimit(w->c->problem, &limit));
  PetscCall(SamNormalCreate(k->elasticity, &normal));
  PetscCall(SamSolverSetTolerances(SamNormalAsSolver(normal), rtol, PETSC_DEFAULT));
  PetscCall(SamNormalSetPressureLimit(normal, limit));
  PetscCall(SamNormalSolve(normal, k->separation, &k->normal, PETSC_FALSE, k->pressure));
  PetscCall(SamSolverGetReason(SamNormalAsSolver(normal), reason));
  PetscCall(SamNormalDestroy(&normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The coefficient of friction is the mean one where the fine grid has contact, elsewhere that of all of it. */
static PetscErrorCode ComputeBound(Coarse *k)
{
  const double *p, *mean_p, *mean_b;
  double       *b;
  PetscReal     sums[2];

  PetscFunctionBegin;
  for (PetscInt n = 0; n < 2; n++) PetscCall(SamGridNorm(k->grid, k->mean[n], NORM_1, &sums[n]));
  PetscCall(VecGetArrayRead(k->pressure, &p));
  PetscCall(VecGetArrayRead(k->mean[0], &mean_p));
  PetscCall(VecGetArrayRead(k->mean[1], &mean_b));
  PetscCall(VecGetArrayWrite(k->bound, &b));
  for (PetscInt i = 0; i < k->grid->cells; i++)
    b[i] = p[i] * (mean_p[i] > 0 ? mean_b[i] / mean_p[i] : (double)(sums[1] / sums[0]));
  PetscCall(VecRestoreArrayWrite(k->bound, &b));
  PetscCall(VecRestoreArrayRead(k->mean[1], &mean_b));
  PetscCall(VecRestoreArrayRead(k->mean[0], &mean_p));
  PetscCall(VecRestoreArrayRead(k->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveShear(SamSolve *w, Coarse *k, SamSolverReason *reason)
{
  SamTangential tangential;
  PetscReal     rtol;

  PetscFunctionBegin;
  PetscCall(ComputeBound(k));
  if (k->offset) PetscCall(SamElasticityApplyNormalToTangential(k->elasticity, k->pressure, k->offset));
  PetscCall(SamSolverGetTolerances(SamTangentialAsSolver(w->c->tangential), &rtol, NULL));
  PetscCall(SamTangentialCreate(k->elasticity, &tangential));
  PetscCall(SamSolverSetTolerances(SamTangentialAsSolver(tangential), rtol, PETSC_DEFAULT));
  PetscCall(SamTangentialSolve(tangential, k->bound, k->offset, &k->tangential, PETSC_FALSE, k->shear));
  PetscCall(SamSolverGetReason(SamTangentialAsSolver(tangential), reason));
  PetscCall(SamTangentialDestroy(&tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolveRolling(SamSolve *w)
{
  double *const   numbers = SamStateNumbers(w->c->state, w->c->rolling, SAM_TRIED);
  Coarse          k       = {.elasticity = NULL};
  SamSolverReason reason;

  PetscFunctionBegin;
  numbers[ENERGY] = 0;
  for (PetscInt n = 0; n < 3; n++) {
    const PetscInt t = SamComponentsOf[SAM_BALANCE_TANGENTIAL][n];

    numbers[ENERGY] += (double)(w->s->load[t] * w->s->rigid[t]);
    numbers[LOADS + n] = numbers[CREEPS + n] = NAN;
  }
  if (w->step->status != SAM_STATUS_CONVERGED || w->s->load[SAM_COMPONENT_N] <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityGetCoarse(w->c->elasticity, &k.elasticity, &k.transfer));
  if (!k.elasticity) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CreateCoarse(w, &k));
  PetscCall(SolvePressure(w, &k, &reason));
  if (reason > 0) PetscCall(SolveShear(w, &k, &reason));
  for (PetscInt n = 0; reason > 0 && n < 3; n++) {
    const PetscInt  t     = SamComponentsOf[SAM_BALANCE_TANGENTIAL][n];
    const double    ratio = (double)(w->c->grid->dx / (k.grid->dx - w->c->grid->dx));
    const PetscBool found = w->tangential.force[n];
    const double    fine  = (double)(found ? w->s->rigid : w->s->load)[t],
                 coarse   = (double)(found ? k.tangential.rigid : k.tangential.load)[n];

    numbers[(found ? CREEPS : LOADS) + n] = fine + ratio * (fine - coarse);
  }
  PetscCall(DestroyCoarse(&k));
  PetscFunctionReturn(PETSC_SUCCESS);
}
