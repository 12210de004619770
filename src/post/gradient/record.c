/* The recorded steps of a gradient: packed when a step is tried, unpacked on the way back. */
#include "gradientimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/pressed.h>
#include <petsam/private/problemimpl.h>
#include <petsam/private/solutionimpl.h>
#include <math.h>
#include <petsc/private/petscimpl.h> /* PetscObjectStateGet() */

PetscErrorCode SamRecordDestroy(SamRecord *r)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(r->cell, r->value, r->slope));
  PetscCall(PetscFree2(r->entered, r->distance));
  r->count = r->entering = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRecordAllocate(SamRecord *r)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc3(r->count, &r->cell, SAM_RECORD_BY_BACK * r->count, &r->value,
                         (SAM_RECORD_VALUES - SAM_RECORD_BY_BACK) * r->count, &r->slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- recording ---- */

/* Notes the cells of a new record among those of all steps. */
static PetscErrorCode Touch(SamGradient g, const SamRecord *r)
{
  double *touched;

  PetscFunctionBegin;
  if (!g->touched) PetscCall(SamGridCreateVec(SamContactGetGrid(g->contact), 1, &g->touched));
  PetscCall(VecGetArray(g->touched, &touched));
  for (PetscInt m = 0; m < r->count; m++) touched[r->cell[m]] = 1;
  PetscCall(VecRestoreArray(g->touched, &touched));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the coefficient of friction in all cells, as the derivative of the bound by the pressure. */
static PetscErrorCode ComputeFriction(SamGradient g, const SamSolution *s, Vec friction)
{
  SamBoundAt     at    = {.control = &s->control, .pressure = s->pressure, .rolled = s->rolled};
  const SamBound bound = {.by_pressure = friction};

  PetscFunctionBegin;
  PetscCall(SamContactGetState(g->contact, &at.state));
  PetscCall(SamProblemComputeBound(SamContactGetProblem(g->contact), &at, &bound));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define PROPORTIONAL 1e-9 /* relative to the largest bound: rounding */

/* Refuses friction that is no coefficient times the pressure. */
static PetscErrorCode CheckProportional(SamGrid grid, const SamSolution *s, Vec friction)
{
  PetscReal change, most;
  Vec       rest;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(friction, &rest));
  PetscCall(VecPointwiseMult(rest, friction, s->pressure));
  PetscCall(VecAXPY(rest, -1, s->bound));
  PetscCall(VecNorm(rest, NORM_INFINITY, &change));
  PetscCall(VecNorm(s->bound, NORM_INFINITY, &most));
  PetscCall(VecDestroy(&rest));
  PetscCheck(change <= PROPORTIONAL * most, grid->comm, SAM_ERR_USER,
             "the gradient: the bound of the shear is not a coefficient of friction times the pressure: its derivative "
             "is not computed");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the friction and the gap of the first step, and refuses others in later steps. */
static PetscErrorCode KeepFields(SamGradient g, const SamSolution *s)
{
  const SamGrid    grid = SamContactGetGrid(g->contact);
  PetscObjectState gap;
  Vec              friction;
  PetscReal        change;

  PetscFunctionBegin;
  PetscCall(PetscObjectStateGet((PetscObject)SamProblemGetGap(SamContactGetProblem(g->contact)), &gap));
  PetscCall(SamGridCreateVec(grid, 1, &friction));
  PetscCall(ComputeFriction(g, s, friction));
  PetscCall(CheckProportional(grid, s, friction));
  if (!g->friction) {
    g->friction = friction;
    g->gap      = gap;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  change = gap != g->gap ? 1 : 0;
  PetscCall(SamMax(grid->comm, 1, &change));
  if (change > 0) PetscCall(VecDestroy(&friction));
  PetscCheck(change == 0, grid->comm, SAM_ERR_USER,
             "the gradient: the gap has been given anew between steps: expected the same in all of them");
  PetscCall(VecAXPY(friction, -1, g->friction));
  PetscCall(VecNorm(friction, NORM_INFINITY, &change));
  PetscCall(VecDestroy(&friction));
  PetscCheck(change == 0, grid->comm, SAM_ERR_USER,
             "the gradient: the friction changes from step to step: expected the same in all of them");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells that are recorded besides those in contact after the step or before it, as those that wear in a jump may lie
   there: from the first column and row to before the last ones */
typedef struct {
  PetscInt first[2], last[2];
} Box;

#define BESIDE 8 /* of a contact with so many cells along an axis one more is recorded on each side, and two more */

/* Finds the surroundings of the contact; without `wide` there are none. */
static PetscErrorCode FindBox(SamGrid grid, const SamSolution *s, PetscBool wide, Box *box)
{
  PetscInt first[2], n[2];

  PetscFunctionBegin;
  *box = (Box){{0, 0}, {0, 0}};
  if (!wide) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridGetSupport(grid, s->pressure, PETSC_FALSE, first, n));
  for (int k = 0; k < 2 && n[k] > 0; k++) {
    box->first[k] = first[k] - n[k] / BESIDE - 2;
    box->last[k]  = first[k] + n[k] + n[k] / BESIDE + 2;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if a cell is recorded. */
static PetscBool Takes(const SamIncrement *s, const Box *box, ptrdiff_t k)
{
  const PetscInt i = (PetscInt)(k % s->grid->nx), j = s->grid->row_start + (PetscInt)(k / s->grid->nx);

  if (i >= box->first[0] && i < box->last[0] && j >= box->first[1] && j < box->last[1]) return PETSC_TRUE;
  return SamIsPressed(s->at_now.p[k]) || (s->solutions[0] && SamIsPressed(s->at_before.p[k]));
}

/* Packs the row of the increment that was computed last, from place m on; returns the next place. */
static PetscInt PackRow(const SamIncrement *s, const Box *box, PetscInt j, PetscInt m, SamRecord *r)
{
  const ptrdiff_t  first = (ptrdiff_t)j * s->grid->nx, n = r->count;
  const SamValues *v = &s->at_now;

  for (PetscInt i = 0; i < s->grid->nx; i++) {
    const ptrdiff_t k = first + i, l = k + s->grid->cells;
    double          share[2], slopes[2];
    SamCellMotion   motion;

    if (!Takes(s, box, k)) continue;
    motion = SamIncrementGetCellMotion(s, k, share);
    SamIncrementGetShareSlopes(s, motion, k, slopes);
    r->cell[m]                               = (PetscInt)k;
    r->value[m + SAM_RECORD_PRESSURE * n]    = v->p[k];
    r->value[m + SAM_RECORD_SHEAR * n]       = v->q[k];
    r->value[m + (SAM_RECORD_SHEAR + 1) * n] = v->q[l];
    r->value[m + SAM_RECORD_SLIP * n]        = s->row[0][i];
    r->value[m + (SAM_RECORD_SLIP + 1) * n]  = s->row[1][i];
    r->value[m + SAM_RECORD_SHARE * n]       = motion == SAM_CELL_MOTION_NONE ? -1 : share[0];
    for (int c = 0; c < 2; c++) r->slope[m + c * n] = (float)slopes[c];
    m++;
  }
  return m;
}

static PetscErrorCode Pack(SamIncrement *s, const Box *box, SamRecord *r)
{
  PetscInt m = 0;

  PetscFunctionBegin;
  PetscCall(SamIncrementMeasure(s));
  PetscCall(SamIncrementFindEnds(s, r->end, r->by_end));
  r->count = 0;
  for (PetscInt k = 0; k < s->grid->cells; k++) r->count += Takes(s, box, k);
  PetscCall(SamRecordAllocate(r));
  for (PetscInt j = 0; j < s->grid->rows; j++) {
    SamIncrementComputeRow(s, j);
    m = PackRow(s, box, j, m, r);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ALIKE 1e-9 /* gaps that differ by less, relative to the largest, are equal */

/*
  Keeps the gaps of the cells that come into contact; in a step from no contact those of the cells where the bodies
  touch first, of which there may be several, become -1.
*/
static PetscErrorCode KeepGaps(SamGrid grid, const double p[], const double gap[], SamRecord *r)
{
  double   most = 0;
  PetscInt m    = 0;

  PetscFunctionBegin;
  r->entering = 0;
  for (PetscInt k = 0; k < grid->cells; k++)
    if (SamIsPressed(p[k])) most = PetscMax(most, gap[k]);
  PetscCall(SamMax(grid->comm, 1, &most));
  for (PetscInt k = 0; k < grid->cells; k++) r->entering += SamIsPressed(p[k]) && (r->fresh || gap[k] > 0);
  PetscCall(PetscMalloc2(r->entering, &r->entered, r->entering, &r->distance));
  for (PetscInt k = 0; k < grid->cells; k++) {
    if (!SamIsPressed(p[k]) || !(r->fresh || gap[k] > 0)) continue;
    r->entered[m]    = k;
    r->distance[m++] = r->fresh && gap[k] <= ALIKE * most ? -1 : gap[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Records how the bodies have moved until cells have touched, if contact grows. */
static PetscErrorCode RecordEntering(SamGradient g, const SamSolution *now, SamRecord *r)
{
  const SamProblem   problem = SamContactGetProblem(g->contact);
  const SamGrid      grid    = SamContactGetGrid(g->contact);
  const SamSolution *before  = SamContactBefore(g->contact);
  const PetscReal    loads[] = {now->load[SAM_COMPONENT_TX], now->load[SAM_COMPONENT_TY]};
  const double      *p, *gap;
  SamState           state;
  Vec                separation, field;

  PetscFunctionBegin;
  r->fresh = !before || !(before->load[SAM_COMPONENT_N] > 0) ? PETSC_TRUE : PETSC_FALSE;
  /* without tangential loads the first step is in proportion to the next one for these loads only: N comes first */
  r->grows = SamApproachGrows(before, now) && !(r->fresh && loads[0] == 0 && loads[1] == 0) ? PETSC_TRUE : PETSC_FALSE;
  if (!r->grows) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetState(g->contact, &state));
  PetscCall(SamApproachFind(problem, state, before, now, loads, &r->approach));
  PetscCall(SamSolutionCreateSeparation(problem, state, SAM_COMMITTED, &separation));
  PetscCall(SamGridCreateVec(grid, 1, &field));
  PetscCall(SamApproachGaps(problem, before, now, separation, field));
  PetscCall(VecGetArrayRead(now->pressure, &p));
  PetscCall(VecGetArrayRead(field, &gap));
  PetscCall(KeepGaps(grid, p, gap, r));
  PetscCall(VecRestoreArrayRead(field, &gap));
  PetscCall(VecRestoreArrayRead(now->pressure, &p));
  PetscCall(VecDestroy(&field));
  PetscCall(SamSolutionDestroySeparation(problem, &separation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the bodies have worn between the step before and that of the place: in each step, or by jumps. */
static PetscBool HasWorn(SamGradient g, PetscInt place)
{
  return g->life ? SamLifeBackJumped(g->life, place) : SamProblemWears(SamContactGetProblem(g->contact));
}

/*
  Finds out if the step has the pressure and the normal loads of the step before. Wear that is too little for the
  solver to change the pressure still has a derivative: such a step is another one.
*/
static PetscErrorCode FindSame(SamGradient g, const SamSolution *now, PetscInt place, SamRecord *r)
{
  const SamSolution *before = SamContactBefore(g->contact);
  const SamGrid      grid   = SamContactGetGrid(g->contact);
  const double      *p, *q;
  double             differs = 0;

  PetscFunctionBegin;
  r->same = PETSC_FALSE;
  if (!before || HasWorn(g, place) || !SamControlIsSame(&before->control, &now->control, SAM_BALANCE_NORMAL))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(now->pressure, &p));
  PetscCall(VecGetArrayRead(before->pressure, &q));
  for (PetscInt k = 0; k < grid->cells; k++)
    if (p[k] != q[k]) differs = 1;
  PetscCall(VecRestoreArrayRead(before->pressure, &q));
  PetscCall(VecRestoreArrayRead(now->pressure, &p));
  PetscCall(SamMax(grid->comm, 1, &differs));
  r->same = differs == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the prescribed values and the displacements of the step. */
static void CopyControl(SamGradient g, const SamSolution *s, SamRecord *r)
{
  const SamConditions conditions = SamProblemGetConditions(SamContactGetProblem(g->contact));
  SamState            state;

  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    r->force[c] = s->control.force[c];
    r->load[c]  = s->load[c];
    r->rigid[c] = s->rigid[c];
  }
  for (PetscInt k = 0; k < SAM_GRADIENT_BULKS; k++)
    r->bulk[k] = SamControlGet(&s->control, SamConditionsFind(conditions, SamBulkName(k)));
  (void)SamContactGetState(g->contact, &state);
  r->volume = SamProblemWornVolume(state);
}

/* Checks that the tried step follows the recorded ones, and its rule of slip. */
static PetscErrorCode CheckPlace(SamGradient g, PetscInt place, PetscInt row, const SamSolution *s)
{
  const MPI_Comm comm = SamContactGetGrid(g->contact)->comm;

  PetscFunctionBegin;
  PetscCheck(SamContactHasStep(g->contact, SAM_TRIED), comm, PETSC_ERR_ORDER,
             "the gradient: no step is tried: record each step before it is committed");
  PetscCheck(place <= g->count, comm, PETSC_ERR_ORDER,
             "the gradient: the contact has steps that were not recorded: begin before its first step");
  PetscCheck(row >= 0 || g->cycle == 0 || place < g->rows - g->cycle, comm, PETSC_ERR_ORDER,
             "the gradient: a wear simulation has been recorded: further steps begin after a reset");
  PetscCheck(!SamRuleTouches(s->rule), comm, SAM_ERR_USER,
             "the gradient: the contact of dissimilar bodies grows, and slip that begins when cells touch has no "
             "derivative: give -slip_direction end");
  PetscCheck(s->rolled == 0, comm, SAM_ERR_USER, "the gradient of steps that roll is not computed");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientRecord(SamGradient g, PetscInt row, SamLifePlace where)
{
  const SamSolution *now;
  SamIncrement       increment;
  SamRecord          r = {.place = where};
  PetscInt           place;
  Box                box;

  PetscFunctionBegin;
  place = SamContactGetSteps(g->contact);
  PetscCall(SamContactGetSolution(g->contact, &now));
  PetscCall(CheckPlace(g, place, row, now));
  PetscCall(KeepFields(g, now));
  PetscCall(SamIncrementCreate(SamContactGetProblem(g->contact), SamContactBefore(g->contact), now, &increment));
  PetscCall(FindBox(SamContactGetGrid(g->contact), now, g->cycle > 0 ? PETSC_TRUE : PETSC_FALSE, &box));
  PetscCall(Pack(&increment, &box, &r));
  PetscCall(SamIncrementDestroy(&increment));
  CopyControl(g, now, &r);
  PetscCall(RecordEntering(g, now, &r));
  PetscCall(FindSame(g, now, place, &r));
  r.turns = SamRuleTurns(now->rule);
  r.row   = row < 0 ? place : row;
  while (g->count > place) PetscCall(SamRecordDestroy(&g->record[--g->count]));
  if (g->count == g->room) {
    g->room = 2 * g->room + 16;
    PetscCall(PetscRealloc(sizeof(*g->record) * (size_t)g->room, &g->record));
  }
  PetscCall(Touch(g, &r));
  PetscCall(SamStoreKeep(g, &r));
  g->record[g->count++] = r;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- on the way back ---- */

PetscErrorCode SamBackTake(const void *back, Vec whole, double array[])
{
  const SamBack *b = (const SamBack *)back;
  const double  *values;
  Vec            part;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(b->grid, 1, &part));
  PetscCall(b->window ? SamWindowTake(b->window, whole, part) : VecCopy(whole, part));
  PetscCall(VecGetArrayRead(part, &values));
  PetscCall(PetscArraycpy(array, values, b->grid->cells));
  PetscCall(VecRestoreArrayRead(part, &values));
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt64 SamBackPlace(const SamBack *b, PetscInt64 cell)
{
  const PetscInt64 nx       = SamContactGetGrid(b->g->contact)->nx;
  PetscInt         first[2] = {0, 0}, n[2];

  if (cell < 0) return -1;
  if (b->window) (void)SamWindowGetPlace(b->window, first, n);
  return (cell / nx - first[1]) * b->grid->nx + cell % nx - first[0];
}

PetscErrorCode SamRecordUnpack(const SamBack *b, SamRecord *r, SamFrameOfStep *frame)
{
  const ptrdiff_t cells = SamContactGetGrid(b->g->contact)->cells;
  double         *to;

  PetscFunctionBegin;
  if (frame->value) PetscCall(VecRestoreArrayRead(frame->field, &frame->value));
  if (r) PetscCall(SamStoreTake(b->g, r));
  PetscCall(VecZeroEntries(b->whole));
  PetscCall(VecGetArray(b->whole, &to));
  for (ptrdiff_t m = 0; r && m < r->count; m++) {
    for (PetscInt c = 0; c < SAM_RECORD_BY_BACK; c++) to[c * cells + r->cell[m]] = r->value[m + c * r->count];
    for (PetscInt c = SAM_RECORD_BY_BACK; c < SAM_RECORD_VALUES; c++)
      to[c * cells + r->cell[m]] = (double)r->slope[m + (c - SAM_RECORD_BY_BACK) * r->count];
  }
  PetscCall(VecRestoreArray(b->whole, &to));
  if (r) PetscCall(SamStoreLeave(r));
  PetscCall(b->window ? SamWindowTake(b->window, b->whole, frame->field) : VecCopy(b->whole, frame->field));
  PetscCall(VecGetArrayRead(frame->field, &frame->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
