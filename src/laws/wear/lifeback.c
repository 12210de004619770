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
#include "wearimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/lifeback.h>
#include <petsam/private/problem.h>
#include <math.h>

/* A part of a jump: see SamLifePart; `after`: number of steps recorded before it */
enum { SLIP, MEAN, PRESSURE, FROM, TO, FIELDS };
typedef struct {
  SamLifePartKind kind;
  PetscReal       cycles;
  PetscInt        after;
  PetscBool       force[3];
  Vec             field[FIELDS]; /* on the contact's grid */
} Jump;

/*
  The jumps' part of a pass back: cotangents of the wear load after the last event, and within a jump of that at
  its start and of that after it as a whole; of the cycle whose wear is repeated its wear load, its mean pressure, its
  shift, its slip (of cells that touch never in it), and its mean normal loads and displacements.
*/
struct _n_SamLifeBack {
  SamGrid  grid; /* of the contact; borrowed, like the law of wear */
  SamLaw   law;
  PetscInt cycle; /* rows of the history's cycle */
  PetscInt jumps; /* number of parts of jumps */
  Jump    *jump;
  /* in a pass */
  SamBackStep *at;     /* the present step */
  double      *arrays; /* all of the following ones */
  double      *by_worn, *by_start, *by_whole, *by_wear, *by_mean, *by_shift, *by_slip, *touches;
  double       by_load[3], by_rigid[3];
  PetscInt     left; /* parts of jumps that have not been passed yet */
};

/* ---- recording ---- */

PetscErrorCode SamLifeBackCreate(SamContact contact, PetscInt cycle, const SamLifeSettings *set, SamLifeBack *life)
{
  const SamProblem problem = SamContactGetProblem(contact);
  const MPI_Comm   comm    = SamContactGetGrid(contact)->comm;
  SamLifeBack      l;

  PetscFunctionBegin;
  PetscCheck(set->fixed, comm, SAM_ERR_USER,
             "the gradient of a wear simulation: the lengths of its jumps depend on the parameters: give -wear_jump");
  PetscCheck(!set->magnified, comm, SAM_ERR_USER,
             "the gradient of a wear simulation whose surfaces slide is not computed");
  PetscCall(PetscNew(&l));
  l->grid  = SamContactGetGrid(contact);
  l->cycle = cycle;
  PetscCall(SamWearFind(problem, &l->law));
  *life = l;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBackDestroy(SamLifeBack *life)
{
  PetscFunctionBegin;
  if (!*life) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt n = 0; n < (*life)->jumps; n++)
    for (int k = 0; k < FIELDS; k++) PetscCall(VecDestroy(&(*life)->jump[n].field[k]));
  PetscCall(PetscFree((*life)->jump));
  PetscCall(PetscFree(*life));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBackRecord(SamLifeBack life, const SamLifePart *part, PetscInt after)
{
  const Vec from[FIELDS] = {part->slip, part->mean, part->pressure, part->from, part->to};
  Jump      jump         = {.kind = part->kind, .cycles = part->cycles, .after = after};

  PetscFunctionBegin;
  for (int k = 0; k < FIELDS; k++) {
    PetscCall(SamGridCreateVec(life->grid, 1, &jump.field[k]));
    PetscCall(VecCopy(from[k], jump.field[k]));
  }
  for (int c = 0; c < 3; c++) jump.force[c] = part->balance->force[c];
  PetscCall(PetscRealloc(sizeof(*life->jump) * (size_t)(life->jumps + 1), &life->jump));
  life->jump[life->jumps++] = jump;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamLifeBackJumped(SamLifeBack life, PetscInt steps)
{
  return life->jumps > 0 && life->jump[life->jumps - 1].after == steps ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamLifeBackTouch(SamLifeBack life, Vec touched)
{
  const double *p;
  double       *to;

  PetscFunctionBegin;
  PetscCall(VecGetArray(touched, &to));
  for (PetscInt n = 0; n < life->jumps; n++) {
    PetscCall(VecGetArrayRead(life->jump[n].field[PRESSURE], &p));
    for (PetscInt k = 0; k < life->grid->cells; k++) to[k] = p[k] > 0 ? 1 : to[k];
    PetscCall(VecRestoreArrayRead(life->jump[n].field[PRESSURE], &p));
  }
  PetscCall(VecRestoreArray(touched, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBackBegin(SamLifeBack l, SamBackStep *at)
{
  double **const one[] = {&l->by_worn, &l->by_start, &l->by_whole, &l->by_wear,
                          &l->by_mean, &l->by_shift, &l->by_slip,  &l->touches};
  enum { COUNT = sizeof(one) / sizeof(one[0]) };
  const PetscInt cells = (PetscInt)PetscMax(at->grid->cells, 1);

  PetscFunctionBegin;
  l->at   = at;
  l->left = l->jumps;
  PetscCall(PetscArrayzero(l->by_load, 3));
  PetscCall(PetscArrayzero(l->by_rigid, 3));
  PetscCall(PetscCalloc1(COUNT * cells, &l->arrays));
  for (int k = 0; k < COUNT; k++) *one[k] = l->arrays + k * cells;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBackEnd(SamLifeBack life)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(life->arrays));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- one part ---- */

/* Fields of a part on the part of the grid that has all contacts */
typedef struct {
  double *field[FIELDS], *scratch;
} Fields;

static PetscErrorCode Take(SamLifeBack life, const Jump *jump, Fields *f)
{
  const PetscInt cells = (PetscInt)PetscMax(life->at->grid->cells, 1);

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(FIELDS * cells, &f->scratch));
  for (int k = 0; k < FIELDS; k++) {
    f->field[k] = f->scratch + k * cells;
    PetscCall((*life->at->take)(life->at->context, jump->field[k], f->field[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the sum of products over the cells to the derivative by the coefficient of wear. */
static PetscErrorCode AddWear(SamLifeBack life, double factor, const double a[], const double b[])
{
  double sum;

  PetscFunctionBegin;
  PetscCall(SamGridDot(life->at->grid, 1, a, b, &sum));
  *life->at->by_number += factor * sum;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the mean displacements that are given. */
static PetscErrorCode AddRigid(SamLifeBack life, const double l[], const PetscBool force[3])
{
  double sums[3];

  PetscFunctionBegin;
  PetscCall(SamBackSumMoments(life->at->grid, l, sums));
  life->by_rigid[0] += force[0] ? 0 : sums[0];
  life->by_rigid[1] -= force[1] ? 0 : sums[2];
  life->by_rigid[2] += force[2] ? 0 : sums[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Goes back over a part: by the cotangent `bar` of the wear load after it, replaces this by that of the load before it,
  and adds to those of e and the shift.
*/
static PetscErrorCode GoBack(SamLifeBack life, const Jump *jump, double bar[])
{
  const PetscInt cells = life->at->grid->cells;
  const double   m = jump->cycles, coefficient = (double)SamWearNumber(life->law);
  double        *l, *diagonal, *right, forces[3];
  Fields         f;

  PetscFunctionBegin;
  PetscCall(Take(life, jump, &f));
  PetscCall(PetscMalloc3(cells, &l, cells, &diagonal, cells, &right));
  for (PetscInt k = 0; k < cells; k++) {
    right[k]    = m * f.field[SLIP][k] * bar[k];
    diagonal[k] = m * coefficient * f.field[SLIP][k];
  }
  PetscCall((*life->at->normal)(life->at->context, f.field[PRESSURE], diagonal, right, jump->force, l, forces));
  for (PetscInt k = 0; k < cells; k++) {
    bar[k] -= coefficient * l[k];
    life->at->by_gap[k] -= l[k];
    life->by_shift[k] -= l[k];
    life->by_slip[k] += m * f.field[PRESSURE][k] * bar[k];
  }
  PetscCall(AddWear(life, -1, l, f.field[TO]));
  PetscCall(AddRigid(life, l, jump->force));
  for (int c = 0; c < 3; c++) life->by_load[c] += forces[c];
  PetscCall(PetscFree3(l, diagonal, right));
  PetscCall(PetscFree(f.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the cotangents of e those of the wear load and the mean pressure, or of the slip of cells that never touch. */
static PetscErrorCode Divide(SamLifeBack life, const Jump *jump)
{
  Fields f;

  PetscFunctionBegin;
  PetscCall(Take(life, jump, &f));
  for (PetscInt k = 0; k < life->at->grid->cells; k++) {
    const double p = f.field[MEAN][k], by = life->by_slip[k];

    life->touches[k] = p > 0;
    life->by_mean[k] = p > 0 ? -by * f.field[SLIP][k] / p : 0;
    life->by_wear[k] = p > 0 ? by / p : 0;
    life->by_slip[k] = p > 0 ? 0 : by;
  }
  PetscCall(PetscFree(f.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Clear(SamLifeBack life)
{
  const PetscInt cells = life->at->grid->cells;

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
static PetscErrorCode Extrapolate(SamLifeBack life, const Fields *whole, const Fields *halves, double bar[])
{
  const SamGrid       g     = life->at->grid;
  const double *const start = whole->field[FROM], *const once = whole->field[TO], *const twice = halves->field[TO];
  const double *const loads[] = {start, once, twice};
  double             *x, *grown, *by_x, volume[3], sums[3], growth, share = 1, by_share, by_growth = 0;

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
static PetscErrorCode TakeWorn(SamLifeBack life, const double load[])
{
  const double coefficient = (double)SamWearNumber(life->law);

  PetscFunctionBegin;
  PetscCall(AddWear(life, 1, life->at->by_worn, load));
  for (PetscInt k = 0; k < life->at->grid->cells; k++) life->by_worn[k] += coefficient * life->at->by_worn[k];
  PetscCall(PetscArrayzero(life->at->by_worn, life->at->grid->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes back over the end of a jump: its second half. */
static PetscErrorCode GoBackEnd(SamLifeBack life, PetscInt k)
{
  const Jump *jump = &life->jump[k];
  Vec         extrapolated;
  double     *load;
  Fields      whole, halves;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(life->at->grid->cells, &load));
  PetscCall(VecDuplicate(jump->field[TO], &extrapolated));
  PetscCall(VecCopy(jump->field[TO], extrapolated));
  PetscCall(SamLifeExtrapolate(life->grid, jump[-2].field[FROM], jump[-2].field[TO], extrapolated));
  PetscCall((*life->at->take)(life->at->context, extrapolated, load));
  PetscCall(TakeWorn(life, load));
  PetscCall(Take(life, jump - 2, &whole));
  PetscCall(Take(life, jump, &halves));
  PetscCall(Extrapolate(life, &whole, &halves, life->by_worn));
  PetscCall(Clear(life));
  PetscCall(GoBack(life, jump, life->by_worn));
  PetscCall(Divide(life, jump));
  PetscCall(VecDestroy(&extrapolated));
  PetscCall(PetscFree(load));
  PetscCall(PetscFree(whole.scratch));
  PetscCall(PetscFree(halves.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Goes back over the middle of a jump: its first half, and the whole of it. */
static PetscErrorCode GoBackMiddle(SamLifeBack life, PetscInt k)
{
  const Jump    *jump  = &life->jump[k];
  const PetscInt cells = life->at->grid->cells;
  Fields         half;

  PetscFunctionBegin;
  PetscCall(Take(life, jump, &half));
  PetscCall(TakeWorn(life, half.field[TO]));
  PetscCall(Clear(life));
  PetscCall(GoBack(life, jump, life->by_worn));
  PetscCall(GoBack(life, jump - 1, life->by_whole));
  for (PetscInt c = 0; c < cells; c++) life->by_worn[c] += life->by_start[c] + life->by_whole[c];
  PetscCall(Divide(life, jump));
  PetscCall(PetscFree(half.scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBackPass(SamLifeBack life, PetscInt steps)
{
  PetscFunctionBegin;
  while (life->left > 0 && life->jump[life->left - 1].after == steps) {
    const PetscInt k = life->left - 1;

    PetscCall(life->jump[k].kind == SAM_LIFE_SECOND_HALF ? GoBackEnd(life, k) : GoBackMiddle(life, k));
    life->left -= life->jump[k].kind == SAM_LIFE_SECOND_HALF ? 1 : 2;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the steps of a computed cycle ---- */

/* Adds the derivatives by what the present step wears. */
static PetscErrorCode AddWorn(SamLifeBack life)
{
  SamBackStep *const at     = life->at;
  const PetscInt     cells  = at->grid->cells;
  const PetscBool    energy = ((const SamWear *)life->law->data)->by_energy;
  double            *factor;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(cells, &factor));
  for (PetscInt k = 0; k < cells; k++) {
    const double mu     = energy ? at->friction[k] : 1;
    const double length = hypot(at->slip[k], at->slip[k + cells]);

    factor[k] = life->by_wear[k] * mu;
    if (energy) at->by_friction[k] += life->by_wear[k] * at->rubbed[k] + life->by_slip[k] * length;
    for (PetscInt c = 0; c < 2 && length > 0; c++)
      at->by_slip[k + c * cells] += life->by_slip[k] * mu * at->slip[k + c * cells] / length;
  }
  PetscCall(SamBackAddRubbed(at, factor));
  PetscCall(PetscFree(factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the derivatives by the gaps of open cells and by the mean pressure, and by the lift of dissimilar bodies. */
static PetscErrorCode AddMeans(SamLifeBack life, double part)
{
  SamBackStep *const at    = life->at;
  const PetscInt     cells = at->grid->cells;
  double            *open, *lifted;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(cells, &open, cells, &lifted));
  for (PetscInt k = 0; k < cells; k++) {
    at->by_pressure[k] += part * life->by_mean[k];
    open[k]   = life->touches[k] && !(at->pressure[k] > 0) ? -part * life->by_shift[k] : 0;
    lifted[k] = open[k] + part * life->by_shift[k];
    at->by_gap[k] += open[k];
    at->by_worn[k] += open[k];
    at->by_open[k] += open[k];
  }
  PetscCall((*at->open)(at->context, open, lifted));
  PetscCall(PetscFree2(open, lifted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeBackAddCycle(SamLifeBack life, SamLifePlace place)
{
  static const PetscInt normal[] = {SAM_COMPONENT_N, SAM_COMPONENT_MX, SAM_COMPONENT_MY};
  const double          part     = 1 / (double)life->cycle;

  PetscFunctionBegin;
  if (place == SAM_LIFE_CLOSING || life->left == life->jumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AddWorn(life));
  PetscCall(AddMeans(life, part));
  for (int c = 0; c < 3; c++) {
    life->at->by_load[normal[c]] += part * life->by_load[c];
    life->at->by_rigid[normal[c]] += part * life->by_rigid[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
