/* Nested grids and windows of all solvers, and the counted work of a method on a level. */
#include <petsam/private/elasticity.h>
#include <petsam/private/solverimpl.h>
#include <math.h>

#define NESTED 32 /* fewest cells in a direction of a grid on which the solution on half the cells is a start */

/* Creates a field on the level's grid for each field that `like` has. */
static PetscErrorCode CreateFields(SamSolver s, const SamLevel *like, SamLevel *level)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_GIVEN; k++)
    if (like->given[k]) PetscCall(SamGridCreateVec(level->grid, s->kind->given_components[k], &level->given[k]));
  PetscCall(SamGridCreateVec(level->grid, s->kind->components, &level->traction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFields(SamLevel *level)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_GIVEN; k++) PetscCall(VecDestroy(&level->given[k]));
  PetscCall(VecDestroy(&level->traction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLevelSolveNested(SamSolver s, SamLevel *level, PetscInt depth, PetscBool guess)
{
  SamLevel            coarse = {.balance = level->balance, .rtol = PetscMax(s->rtol, s->kind->coarse_rtol)};
  SamLevelWork       *work   = &s->work[PetscMin(level->depth, SAM_NESTED - 1)];
  const PetscLogEvent event  = SamEvents[PetscMin(SAM_EVENT_GRIDS + level->depth, SAM_EVENT_LAST_GRID)];
  SamStart            start  = guess ? SAM_START_GUESS : SAM_START_NONE;
  double              began;
  SamTransfer         transfer;

  PetscFunctionBegin;
  if (depth > 1 && !guess && level->grid->fewest >= NESTED)
    PetscCall(SamElasticityGetCoarse(level->elasticity, &coarse.elasticity, &transfer));
  if (coarse.elasticity) {
    coarse.grid  = SamElasticityGetGrid(coarse.elasticity);
    coarse.depth = level->depth + 1;
    PetscCall(CreateFields(s, level, &coarse));
    for (PetscInt k = 0; k < SAM_GIVEN; k++)
      if (level->given[k]) PetscCall(SamTransferRestrict(transfer, level->given[k], coarse.given[k]));
    PetscCall(SamLevelSolveNested(s, &coarse, depth - 1, PETSC_FALSE));
    PetscCall(s->kind->prolong(transfer, &coarse, level));
    for (PetscInt k = 0; k < 3; k++) level->rigid[k] = coarse.rigid[k];
    PetscCall(DestroyFields(&coarse));
    start = SAM_START_COARSE;
  }
  began      = MPI_Wtime();
  work->n[0] = level->grid->nx;
  work->n[1] = level->grid->ny;
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(s->kind->solvelevel(s, level, start));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  work->seconds += MPI_Wtime() - began;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamLevelHasProduct(const SamLevel *level)
{
  const SamProduct *p = level->product;

  return p && p->first[0] == 0 && p->first[1] == 0 && p->n[0] == level->grid->nx && p->n[1] == level->grid->ny;
}

void SamLevelKeepProduct(SamLevel *level, double rounding)
{
  level->product->first[0] = level->product->first[1] = 0;
  level->product->n[0]                                = level->grid->nx;
  level->product->n[1]                                = level->grid->ny;
  level->product->rounding                            = rounding;
}

void SamLevelForgetProduct(SamLevel *level)
{
  if (level->product) level->product->n[0] = level->product->n[1] = 0;
}

static PetscErrorCode CountNonzeros(SamGrid grid, PetscInt components, Vec field, double *count)
{
  const PetscInt n = components * grid->cells;
  const double  *f;

  PetscFunctionBegin;
  *count = 0;
  PetscCall(VecGetArrayRead(field, &f));
  for (PetscInt k = 0; k < n; k++) *count += f[k] != 0;
  PetscCall(VecRestoreArrayRead(field, &f));
  PetscCall(SamSum(grid->comm, 1, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Copies the product of a level to a window of it. It is valid there if it covers all of the window, and if all its
  traction lies within the window.
*/
static PetscErrorCode TakeProduct(SamWindow window, const SamLevel *from, SamLevel *level, PetscInt components,
                                  SamProduct *part)
{
  const SamProduct *whole = from->product;
  PetscInt          first[2], n[2];
  PetscBool         known = whole->n[0] > 0;
  double            all, inside;

  PetscFunctionBegin;
  PetscCall(SamWindowGetPlace(window, first, n));
  for (PetscInt k = 0; k < 2; k++)
    if (first[k] < whole->first[k] || first[k] + n[k] > whole->first[k] + whole->n[k]) known = PETSC_FALSE;
  PetscCall(SamGridCreateVec(level->grid, components, &part->field));
  level->product = part;
  if (!known) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CountNonzeros(from->grid, components, from->traction, &all));
  PetscCall(CountNonzeros(level->grid, components, level->traction, &inside));
  if (inside < all) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamWindowTake(window, whole->field, part->field));
  SamLevelKeepProduct(level, whole->rounding);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PutProduct(SamWindow window, SamProduct *part, SamProduct *whole)
{
  PetscFunctionBegin;
  PetscCall(SamWindowGetPlace(window, whole->first, whole->n));
  whole->rounding = part->rounding;
  if (part->n[0])
    PetscCall(SamWindowPut(window, part->field, whole->field));
  else
    whole->n[0] = whole->n[1] = 0;
  PetscCall(VecDestroy(&part->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLevelSolveInWindow(SamSolver s, SamLevel *whole, SamWindow window, SamElasticity part,
                                     PetscBool guess, SamLevelSolver solve)
{
  SamLevel   level   = {.elasticity = part,
                        .balance    = whole->balance,
                        .rtol       = whole->rtol,
                        .depth      = whole->depth,
                        .iterations = whole->iterations};
  SamProduct product = {.rounding = 0};

  PetscFunctionBegin;
  level.grid = SamWindowGetGrid(window);
  PetscCall(CreateFields(s, whole, &level));
  for (PetscInt k = 0; k < SAM_GIVEN; k++)
    if (whole->given[k]) PetscCall(SamWindowTake(window, whole->given[k], level.given[k]));
  if (guess) PetscCall(SamWindowTake(window, whole->traction, level.traction));
  if (whole->product) PetscCall(TakeProduct(window, whole, &level, s->kind->components, &product));
  PetscCall(solve(s, &level, guess));
  if (whole->product) PetscCall(PutProduct(window, &product, whole->product));
  PetscCall(SamWindowPut(window, level.traction, whole->traction));
  whole->iterations = level.iterations;
  whole->frame      = level.frame;
  for (PetscInt k = 0; k < 3; k++) whole->rigid[k] = level.rigid[k];
  PetscCall(DestroyFields(&level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamLevelGetRigid(const SamLevel *level, SamBalance *balance)
{
  double a[3];

  for (PetscInt k = 0; k < 3; k++) a[k] = level->rigid[k] - level->frame.fixed[k];
  SamFrameGetRigid(&level->frame, a, balance);
}

/* Returns the field added to the operator's diagonal; NULL: none. */
static Vec DiagonalOf(SamSolver s, const SamLevel *level)
{
  return s->kind->diagonal >= 0 ? level->given[s->kind->diagonal] : NULL;
}

/*
  Computes the additional local displacement, times `factor`, as a new array for SamFree(). A cell yields by its own
  traction; where material streams, a line yields by the integral along x, which is symmetric if d is constant in x.
*/
#define YIELD(Name, Real) \
  static PetscErrorCode Name(const SamLevel *level, Vec diagonal, double factor, const Real t[], Real **yield) \
  { \
    const SamGrid   grid    = level->grid; \
    const PetscBool streams = SamElasticityGetTraits(level->elasticity).upwind; \
    const double   *d; \
\
    PetscFunctionBegin; \
    PetscCall(SamAllocate(sizeof(**yield) * (size_t)grid->cells, yield)); \
    PetscCall(VecGetArrayRead(diagonal, &d)); \
    for (PetscInt first = 0; first < grid->cells; first += grid->nx) { \
      double line = 0; \
\
      for (PetscInt k = first; streams && k < first + grid->nx; k++) line += (double)t[k] * (double)grid->dx; \
      for (PetscInt k = first; k < first + grid->nx; k++) \
        (*yield)[k] = streams ? (Real)(factor * d[k] * line) : (Real)(factor * d[k]) * t[k]; \
    } \
    PetscCall(VecRestoreArrayRead(diagonal, &d)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
YIELD(CreateYield, double)
YIELD(CreateYieldSingle, float)

/* Counts a product. */
static void CountProduct(SamSolver s, const SamLevel *level)
{
  s->applies += level->depth == 0 ? 1 : 0;
  s->work[PetscMin(level->depth, SAM_NESTED - 1)].applies++;
}

PetscErrorCode SamLevelApply(SamSolver s, SamLevel *level, Vec traction, Vec u)
{
  const Vec     diagonal = DiagonalOf(s, level);
  const double *t;
  double       *to, *yield;

  PetscFunctionBegin;
  CountProduct(s, level);
  PetscCall(s->kind->apply(level->elasticity, traction, u));
  if (!diagonal) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(traction, &t));
  PetscCall(CreateYield(level, diagonal, 1, t, &yield));
  PetscCall(VecRestoreArrayRead(traction, &t));
  PetscCall(VecGetArray(u, &to));
  for (PetscInt k = 0; k < level->grid->cells; k++) to[k] += yield[k];
  PetscCall(VecRestoreArray(u, &to));
  SamFree(yield);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLevelApplySingle(SamSolver s, SamLevel *level, double factor, const float traction[], float u[])
{
  const Vec      diagonal = DiagonalOf(s, level);
  const PetscInt cells    = level->grid->cells;
  float         *more     = NULL; /* as input and output may be the same */

  PetscFunctionBegin;
  CountProduct(s, level);
  if (diagonal) PetscCall(CreateYieldSingle(level, diagonal, factor, traction, &more));
  PetscCall(s->kind->applysingle(level->elasticity, factor, traction, u));
  for (PetscInt k = 0; k < cells && more; k++) u[k] += more[k];
  SamFree(more);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The approximate inverse M of the operator without a diagonal d becomes W M W with W = 1/sqrt(1 + d/self), self being a
  cell's influence on itself: accurate for short waves, whose displacement is that of single cells. If d is up to 130
  times self, 54 products suffice instead of 185; if it is up to 11 times self, 27 instead of 45.
*/
static PetscErrorCode PreconditionYielding(SamSolver s, SamLevel *level, Vec diagonal, double factor, const float r[],
                                           float z[])
{
  const PetscInt cells = level->grid->cells;
  const double  *d;
  PetscReal      self;
  float         *w, *scaled;

  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(level->elasticity, &self, NULL));
  PetscCall(SamAllocate(sizeof(*w) * (size_t)cells, &w));
  PetscCall(SamAllocate(sizeof(*scaled) * (size_t)cells, &scaled));
  PetscCall(VecGetArrayRead(diagonal, &d));
  for (PetscInt k = 0; k < cells; k++) {
    w[k]      = (float)(1 / sqrt(1 + d[k] / (double)self));
    scaled[k] = w[k] * r[k];
  }
  PetscCall(VecRestoreArrayRead(diagonal, &d));
  PetscCall(s->kind->preconditionsingle(level->elasticity, factor, scaled, z));
  for (PetscInt k = 0; k < cells; k++) z[k] *= w[k];
  SamFree(scaled);
  SamFree(w);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLevelPreconditionSingle(SamSolver s, SamLevel *level, double factor, const float r[], float z[])
{
  const Vec diagonal = DiagonalOf(s, level);

  PetscFunctionBegin;
  s->preconditions += level->depth == 0 ? 1 : 0;
  if (diagonal && !SamElasticityGetTraits(level->elasticity).upwind) /* no gain for lines, of which there are few */
    PetscCall(PreconditionYielding(s, level, diagonal, factor, r, z));
  else
    PetscCall(s->kind->preconditionsingle(level->elasticity, factor, r, z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLevelIterated(SamSolver s, SamLevel *level, PetscReal error)
{
  PetscFunctionBegin;
  level->iterations++;
  s->work[PetscMin(level->depth, SAM_NESTED - 1)].iterations++;
  if (level->depth > 0) PetscFunctionReturn(PETSC_SUCCESS);
  s->iterations++;
  for (PetscInt m = 0; m < s->monitors; m++) PetscCall(s->monitor[m](s, s->iterations, error, s->monitor_context[m]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
