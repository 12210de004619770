/*
  The jumps of a wear simulation on the way back (laws/wear/cyclejump.c, wearcycle.c).

  A part of a jump over m cycles makes of the wear loads w
      w' = w + m e P,   S P + h + K w + shift + m K e P = n d where P > 0,   P of the mean loads,
  e = r/P0 being the wear load of the cycle before it over its mean pressure, and -shift its mean gap. With the
  cotangent H' of w', l solves the same normal problem, (S + m K e) l - n nu = m e H', n.l = 0. Then the cotangents are
  H = H' - K l of w, -l of the gap and the shift, m P (H' - K l) of e, nu of the mean loads, and -l.w' of K. Those of e
  and shift are of the steps of the cycle: e of the pressure and the slip in each of them, or where the surfaces never
  touch of the slip; the shift of the gap where cells are open.

  A jump has a whole, a first half, the steps of its middle cycle, and a second half, whose extrapolation is the result.
  The lengths of jumps are fixed.
*/
#include "gradientimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/problem.h>
#include <math.h>

/* ---- recording ---- */

PetscErrorCode SamJumpDestroy(SamJump *jump)
{
  PetscFunctionBegin;
  for (int k = 0; k < SAM_JUMP_FIELDS; k++) PetscCall(VecDestroy(&jump->field[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientRecordJump(SamGradient g, const SamLifePart *part)
{
  const Vec from[SAM_JUMP_FIELDS] = {part->slip, part->mean, part->pressure, part->from, part->to};
  SamJump   jump                  = {.kind = part->kind, .cycles = part->cycles, .after = g->count};

  PetscFunctionBegin;
  for (int k = 0; k < SAM_JUMP_FIELDS; k++) {
    PetscCall(SamGridCreateVec(SamContactGetGrid(g->contact), 1, &jump.field[k]));
    PetscCall(VecCopy(from[k], jump.field[k]));
  }
  for (int c = 0; c < 3; c++) jump.force[c] = part->balance->force[c];
  PetscCall(PetscRealloc(sizeof(*g->jump) * (size_t)(g->jumps + 1), &g->jump));
  g->jump[g->jumps++] = jump;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- one part ---- */

/* Fields of a part on the part of the grid that has all contacts */
typedef struct {
  double *field[SAM_JUMP_FIELDS], *scratch;
} Fields;

static PetscErrorCode Take(const SamBack *b, const SamJump *jump, Fields *f)
{
  const PetscInt cells = (PetscInt)PetscMax(b->grid->cells, 1);

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(SAM_JUMP_FIELDS * cells, &f->scratch));
  for (int k = 0; k < SAM_JUMP_FIELDS; k++) {
    f->field[k] = f->scratch + k * cells;
    PetscCall(SamBackTake(b, jump->field[k], f->field[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the sum of products over the cells to the derivative by the coefficient of wear. */
static PetscErrorCode AddWear(SamBack *b, double factor, const double a[], const double c[])
{
  const SamGrid  g     = b->grid;
  const PetscInt law   = b->g->rate[0] != 0 ? 0 : 1;
  SamTotal       total = {0};
  double         sum;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) row += a[k] * c[k];
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(g->comm, 1, &total, &sum));
  b->g->found.wear[law] += factor * sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the mean displacements that are given. */
static PetscErrorCode AddRigid(SamBack *b, const double l[], const PetscBool force[3])
{
  double sums[3];

  PetscFunctionBegin;
  PetscCall(SamBackSumMoments(b, l, sums));
  b->life.by_rigid[0] += force[0] ? 0 : sums[0];
  b->life.by_rigid[1] -= force[1] ? 0 : sums[2];
  b->life.by_rigid[2] += force[2] ? 0 : sums[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Goes back over a part: by the cotangent `bar` of the wear load after it, replaces this by that of the load before it,
  and adds to those of e and the shift.
*/
static PetscErrorCode GoBack(SamBack *b, const SamJump *jump, double bar[])
{
  SamLifeBack *const life  = &b->life;
  const PetscInt     cells = b->grid->cells;
  const double       m = jump->cycles, coefficient = (double)(b->g->rate[0] + b->g->rate[1]);
  double            *l, *diagonal, *right, forces[3];
  Fields             f;

  PetscFunctionBegin;
  PetscCall(Take(b, jump, &f));
  PetscCall(PetscMalloc3(cells, &l, cells, &diagonal, cells, &right));
  for (PetscInt k = 0; k < cells; k++) {
    right[k]    = m * f.field[SAM_JUMP_SLIP][k] * bar[k];
    diagonal[k] = m * coefficient * f.field[SAM_JUMP_SLIP][k];
  }
  PetscCall(SamBackSolveNormal(b, f.field[SAM_JUMP_PRESSURE], diagonal, right, jump->force, l, forces));
  for (PetscInt k = 0; k < cells; k++) {
    bar[k] -= coefficient * l[k];
    b->by_gap[k] -= l[k];
    life->by_shift[k] -= l[k];
    life->by_slip[k] += m * f.field[SAM_JUMP_PRESSURE][k] * bar[k];
  }
  PetscCall(AddWear(b, -1, l, f.field[SAM_JUMP_TO]));
  PetscCall(AddRigid(b, l, jump->force));
  for (int c = 0; c < 3; c++) life->by_load[c] += forces[c];
  PetscCall(PetscFree3(l, diagonal, right));
  PetscCall(PetscFree(f.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the cotangents of e those of the wear load and the mean pressure, or of the slip of cells that never touch. */
static PetscErrorCode Divide(SamBack *b, const SamJump *jump)
{
  SamLifeBack *const life = &b->life;
  Fields             f;

  PetscFunctionBegin;
  PetscCall(Take(b, jump, &f));
  for (PetscInt k = 0; k < b->grid->cells; k++) {
    const double p = f.field[SAM_JUMP_MEAN][k], by = life->by_slip[k];

    life->touches[k] = p > 0;
    life->by_mean[k] = p > 0 ? -by * f.field[SAM_JUMP_SLIP][k] / p : 0;
    life->by_wear[k] = p > 0 ? by / p : 0;
    life->by_slip[k] = p > 0 ? 0 : by;
  }
  PetscCall(PetscFree(f.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Clear(SamBack *b)
{
  SamLifeBack *const life  = &b->life;
  const PetscInt     cells = b->grid->cells;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(life->by_slip, cells));
  PetscCall(PetscArrayzero(life->by_shift, cells));
  PetscCall(PetscArrayzero(life->by_load, 3));
  PetscCall(PetscArrayzero(life->by_rigid, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the extrapolation ---- */

/* Adds up three fields over all cells. */
static PetscErrorCode SumThree(SamGrid g, const double *const a[3], double sums[3])
{
  SamTotal totals[3] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    double row[3] = {0};

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++)
      for (int n = 0; n < 3; n++) row[n] += a[n][k];
    SamAddAll(3, totals, row);
  }
  PetscCall(SamSumTotals(g->comm, 3, totals, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Takes the cotangent `bar` of the extrapolated load to those of the load before the jump, and after it as a whole and
  in halves, which become `bar`. The extrapolation is x = max(2 halves - whole, start), whose growth is multiplied by a
  share so that the volume is the extrapolated one; or the halves.
*/
static PetscErrorCode Extrapolate(SamBack *b, const Fields *whole, const Fields *halves, double bar[])
{
  const SamGrid       g     = b->grid;
  SamLifeBack *const  life  = &b->life;
  const double *const start = whole->field[SAM_JUMP_FROM], *const once = whole->field[SAM_JUMP_TO],
                      *const twice   = halves->field[SAM_JUMP_TO];
  const double *const        loads[] = {start, once, twice};
  double                    *x, *grown, *by_x, volume[3], sums[3], growth, share = 1, by_share, by_growth = 0;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(life->by_start, g->cells));
  PetscCall(PetscArrayzero(life->by_whole, g->cells));
  PetscCall(SumThree(g, loads, volume));
  growth = 2 * volume[2] - volume[1] - volume[0];
  if (growth < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(g->cells, &x, g->cells, &grown, g->cells, &by_x));
  for (PetscInt k = 0; k < g->cells; k++) {
    x[k]     = PetscMax(2 * twice[k] - once[k], start[k]) - start[k];
    grown[k] = bar[k] * x[k];
  }
  PetscCall(SumThree(g, (const double *const[]){x, grown, x}, sums));
  if (sums[0] > 0) {
    share     = growth / sums[0];
    by_share  = sums[1];
    by_growth = by_share / sums[0];
  }
  for (PetscInt k = 0; k < g->cells; k++) {
    const PetscBool grows = x[k] > 0 ? PETSC_TRUE : PETSC_FALSE;

    by_x[k]           = grows ? share * (bar[k] - by_growth) : 0;
    life->by_start[k] = bar[k] - by_x[k] - by_growth;
    life->by_whole[k] = -by_x[k] - by_growth;
    bar[k]            = 2 * by_x[k] + 2 * by_growth;
  }
  PetscCall(PetscFree3(x, grown, by_x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- events ---- */

/* Takes over the cotangent of the worn depth since the last event, whose wear load was `load`, as one of that load. */
static PetscErrorCode TakeWorn(SamBack *b, const double load[])
{
  const double coefficient = (double)(b->g->rate[0] + b->g->rate[1]);

  PetscFunctionBegin;
  PetscCall(AddWear(b, 1, b->worn, load));
  for (PetscInt k = 0; k < b->grid->cells; k++) b->life.by_worn[k] += coefficient * b->worn[k];
  PetscCall(PetscArrayzero(b->worn, b->grid->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBackGetLoad(const SamBack *b, double load[])
{
  const SamJump *last = &b->g->jump[b->g->jumps - 1];
  Vec            halves;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(last->field[SAM_JUMP_TO], &halves));
  PetscCall(VecCopy(last->field[SAM_JUMP_TO], halves));
  PetscCall(SamLifeExtrapolate(SamContactGetGrid(b->g->contact), last[-2].field[SAM_JUMP_FROM],
                               last[-2].field[SAM_JUMP_TO], halves));
  PetscCall(SamBackTake(b, halves, load));
  PetscCall(VecDestroy(&halves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes back over the end of a jump: its second half. */
static PetscErrorCode GoBackEnd(SamBack *b, PetscInt k)
{
  const SamJump *jump = &b->g->jump[k];
  Vec            extrapolated;
  double        *load;
  Fields         whole, halves;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(b->grid->cells, &load));
  PetscCall(VecDuplicate(jump->field[SAM_JUMP_TO], &extrapolated));
  PetscCall(VecCopy(jump->field[SAM_JUMP_TO], extrapolated));
  PetscCall(SamLifeExtrapolate(SamContactGetGrid(b->g->contact), jump[-2].field[SAM_JUMP_FROM],
                               jump[-2].field[SAM_JUMP_TO], extrapolated));
  PetscCall(SamBackTake(b, extrapolated, load));
  PetscCall(TakeWorn(b, load));
  PetscCall(Take(b, jump - 2, &whole));
  PetscCall(Take(b, jump, &halves));
  PetscCall(Extrapolate(b, &whole, &halves, b->life.by_worn));
  PetscCall(Clear(b));
  PetscCall(GoBack(b, jump, b->life.by_worn));
  PetscCall(Divide(b, jump));
  PetscCall(VecDestroy(&extrapolated));
  PetscCall(PetscFree(load));
  PetscCall(PetscFree(whole.scratch));
  PetscCall(PetscFree(halves.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes back over the middle of a jump: its first half, and the whole of it. */
static PetscErrorCode GoBackMiddle(SamBack *b, PetscInt k)
{
  const SamJump *jump  = &b->g->jump[k];
  SamLifeBack   *life  = &b->life;
  const PetscInt cells = b->grid->cells;
  Fields         half;

  PetscFunctionBegin;
  PetscCall(Take(b, jump, &half));
  PetscCall(TakeWorn(b, half.field[SAM_JUMP_TO]));
  PetscCall(Clear(b));
  PetscCall(GoBack(b, jump, life->by_worn));
  PetscCall(GoBack(b, jump - 1, life->by_whole));
  for (PetscInt c = 0; c < cells; c++) life->by_worn[c] += life->by_start[c] + life->by_whole[c];
  PetscCall(Divide(b, jump));
  PetscCall(PetscFree(half.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBackPassJumps(SamBack *b, PetscInt steps)
{
  const SamGradient g = b->g;

  PetscFunctionBegin;
  while (b->life.left > 0 && g->jump[b->life.left - 1].after == steps) {
    const PetscInt k = b->life.left - 1;

    PetscCall(g->jump[k].kind == SAM_LIFE_SECOND_HALF ? GoBackEnd(b, k) : GoBackMiddle(b, k));
    b->life.left -= g->jump[k].kind == SAM_LIFE_SECOND_HALF ? 1 : 2;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the steps of a computed cycle ---- */

/* Adds the derivatives by what the present step wears. */
static PetscErrorCode AddWorn(SamBack *b)
{
  SamObjectiveStep *const  at     = &b->at;
  const SamLifeBack *const life   = &b->life;
  const PetscInt           cells  = b->grid->cells;
  const PetscBool          energy = b->g->rate[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
  double                  *rubbed, *factor;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(cells, &rubbed, cells, &factor));
  SamBackRubbed(at, rubbed);
  for (PetscInt k = 0; k < cells; k++) {
    const double mu     = energy ? b->friction[k] : 1;
    const double length = hypot(at->slip[k], at->slip[k + cells]);

    factor[k] = life->by_wear[k] * mu;
    if (energy) b->by_friction[k] += life->by_wear[k] * rubbed[k] + life->by_slip[k] * length;
    for (PetscInt c = 0; c < 2 && length > 0; c++)
      at->by_slip[k + c * cells] += life->by_slip[k] * mu * at->slip[k + c * cells] / length;
  }
  PetscCall(SamBackAddRubbed(at, factor));
  PetscCall(PetscFree2(rubbed, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the gaps of open cells and by the mean pressure, and by the lift of dissimilar bodies. */
static PetscErrorCode AddMeans(SamBack *b, double part)
{
  SamObjectiveStep *const  at    = &b->at;
  const SamLifeBack *const life  = &b->life;
  const PetscInt           cells = b->grid->cells;
  double                  *open, *lifted;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(cells, &open, cells, &lifted));
  for (PetscInt k = 0; k < cells; k++) {
    at->by_pressure[k] += part * life->by_mean[k];
    open[k]   = life->touches[k] && !(at->pressure[k] > 0) ? -part * life->by_shift[k] : 0;
    lifted[k] = open[k] + part * life->by_shift[k];
    b->by_gap[k] += open[k];
    b->worn[k] += open[k];
    b->ahead[k] += open[k];
  }
  PetscCall(SamBackAddOpen(b, open, lifted));
  PetscCall(PetscFree2(open, lifted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBackAddCycle(SamBack *b, PetscInt step)
{
  static const PetscInt normal[] = {SAM_COMPONENT_N, SAM_COMPONENT_MX, SAM_COMPONENT_MY};
  const SamRecord      *r        = &b->g->record[step];
  const double          part     = 1 / (double)b->g->cycle;

  PetscFunctionBegin;
  if (r->place == SAM_LIFE_CLOSING || b->life.left == b->g->jumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AddWorn(b));
  PetscCall(AddMeans(b, part));
  for (int c = 0; c < 3; c++) {
    b->by_load[normal[c]] += part * b->life.by_load[c];
    b->at.by_rigid[normal[c]] += part * b->life.by_rigid[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
