/*
  -accuracy: the way from one trial to the next.

  A trial tells where contact is, and, by its errors, how many times narrower the cells must be: with the difference d
  to half the cells, and D between these and a quarter, the order is p = log2(D/d), from 1 to that of the number. Errors
  by the steps are of first order. If the cells must be more than twice as narrow, or the steps more than twice as many,
  a finer trial follows; where a trial costs little, until the errors on the chosen grid itself are small enough.

  A number whose error two finer trials hardly lower asks for no more of them; nor does one whose error stays unknown,
  nor, once the order shown by the trials tells so, one that would take much longer than all trials so far. Cells lower
  a number's error to the part that is not theirs, as of given steps: much less of their own is of no use.
*/
#include "accuracyimpl.h"
#include <petsam/private/grid.h>
#include <math.h>
#include <string.h>

#define MOST_STEPS 1024  /* most steps per row that are chosen */
#define NEAR       2.0   /* the errors of a trial are believed for cells this many times narrower */
#define CHEAP      1e6   /* cells times steps of a trial up to which it is repeated on the chosen grid */
#define AT_ONCE    4.0   /* most times by which cells become narrower from one trial to the next */
#define STALLS     2     /* finer trials with the same error of a number, after which it asks for no finer ones: */
#define FINER      1.5   /* cells so many times narrower, */
#define SLOW       0.5   /* and errors that fall more slowly than with this power of the width; */
#define AGAIN      1.6   /* after the first, cells become narrower so many times */
#define UNKNOWN    0.995 /* error from which on nothing is known (SamErrorWrite()) */
#define AFFORDED   60.0  /* s: a run of more is not for a number whose error is unknown or falls slowly, */
#define DEAR       20.0  /* nor for another one if it takes so many times longer than all trials so far */
#define BEYOND     5.0 /* other errors so many times larger than asked do not become as small on finer cells, either */
#define SAME       0.2 /* part of the grid's width by which it is wider, or elsewhere, without another trial */
#define PAYS       0.5 /* part of the cells that a narrower grid has at most if it pays for another trial */

/* Returns the error of a number by the steps: that to twice as many is half of it, that to half as many the whole. */
static double ErrorBySteps(const SamErrorRow *row, PetscInt steps)
{
  return (steps == 1 ? 2 : 1) * row->of[SAM_CAUSE_STEPS];
}

/*
  Returns how many times narrower cells make the error of a number, as it is told, as small as this. It is told as the
  larger one of two differences, which is that of an order of at least 1 (estimates.c).
*/
static double Narrower(const SamErrorRow *row, double wanted)
{
  const double near  = fabs(row->value - row->run[SAM_RUN_HALF]),
               far   = fabs(row->run[SAM_RUN_HALF] - row->run[SAM_RUN_QUARTER]);
  const double error = row->of[SAM_CAUSE_CELLS];
  double       order = 1;

  if (!(error < UNKNOWN)) return AT_ONCE; /* nothing is known, or a companion has ended early */
  if (error == row->cells && near > 0)    /* no closed form */
    order = PetscMax(1, PetscMin((double)row->order, log2(far / near)));
  return pow(error / wanted, 1 / order);
}

/* Follows the error of a number by a cause: counts the finer trials since the one with the best error for its fineness;
   errors wander from grid to grid. One that is nearly as small as asked is always within reach. */
static const SamWatch *Follow(SamTask *task, const SamErrorRow *row, SamCause cause, double fineness)
{
  const double error = row->of[cause] < UNKNOWN ? row->of[cause] : 1;
  SamWatch    *w     = task->watch;

  while (w < task->watch + task->watched && !(w->cause == cause && !strcmp(w->name, row->name))) w++;
  if (w == task->watch + task->watched) {
    task->watched++; /* the table has fewer rows than there is room */
    *w = (SamWatch){.cause = cause};
    (void)snprintf(w->name, sizeof(w->name), "%s", row->name);
  } else if (!(fineness > FINER * w->finest)) {
    return w;
  } else {
    w->order = PetscMax(SLOW, log(w->error / error) / log(fineness / w->fineness));
    if (error > NEAR * (double)task->asked->error && error > w->error * pow(fineness / w->fineness, -SLOW)) {
      w->finest = fineness;
      w->stalls++;
      return w;
    }
  }
  w->fineness = w->finest = fineness;
  w->error                = error;
  w->stalls               = 0;
  return w;
}

/* Returns the part of a number's error that no choice lowers. */
static double RestOf(const SamTask *task, const SamErrorRow *row)
{
  return row->of[SAM_CAUSE_LAYERS] + row->of[SAM_CAUSE_MESH] + (task->steps ? 0 : row->of[SAM_CAUSE_STEPS]);
}

/* Returns how small the error of a number by the cells must be. The rest of it falls on finer cells, too, but
   not from BEYOND times as much as asked; on few cells it is often too large. */
static double LeftFor(const SamTask *task, const SamChoice *c, const SamErrorRow *row, double by_steps)
{
  const double asked = (double)task->asked->error, left = asked - PetscMin(by_steps, 0.5 * asked);
  const double n = (double)PetscMin(c->n[0], c->n[task->axes - 1]);

  return n < NEAR * (double)task->few || RestOf(task, row) < BEYOND * asked ? left : PetscMax(left, RestOf(task, row));
}

/* Returns how many times narrower than this cells become in the next trial. */
static double NextOf(double factor)
{
  return PetscMin(factor > NEAR ? factor / NEAR : factor, AT_ONCE);
}

/* True if a number asks for too long runs, for cells that are so many times narrower; writes why. */
static PetscBool IsDear(const SamTask *task, const SamChoice *c, const SamErrorRow *row, const SamWatch *w, double more,
                        double left, char why[], size_t size)
{
  const PetscBool blind = w->stalls > 0 || !(row->of[SAM_CAUSE_CELLS] < UNKNOWN) ? PETSC_TRUE : PETSC_FALSE;
  const double    next  = w->stalls > 0 ? PetscMin(more, AGAIN) : NextOf(more);
  const double    n     = (double)PetscMax(c->n[0], c->n[task->axes - 1]);
  const double    all   = w->order > 0 ? pow(row->of[SAM_CAUSE_CELLS] / left, 1 / w->order) : more,
               factor   = blind ? next : PetscMin(all, (double)task->most / n),
               seconds  = task->seconds * pow(factor, task->axes);

  if (!task->number || !(w->order > 0 && more > 1 && seconds > AFFORDED)) return PETSC_FALSE;
  if (blind)
    (void)snprintf(why, size, "finer cells hardly lower it");
  else if (all * n > (double)task->most)
    (void)snprintf(why, size, "%s would need more than -grid_n %" PetscInt_FMT, row->name, task->most);
  else
    (void)snprintf(why, size, "%s would need about -grid_n %.0f, and %.2g min", row->name, all * n, seconds / 60);
  return blind || all * n > (double)task->most || seconds > DEAR * task->spent ? PETSC_TRUE : PETSC_FALSE;
}

/* Gets how many times narrower the cells must be, and how many times more steps there must be, for all numbers whose
   errors these lower; `why`: the reason if there are others with too large an error, or empty. */
static void Demand(SamTask *task, const SamChoice *c, const SamTrial *t, double factor[2], char why[], size_t size)
{
  const double asked       = (double)task->asked->error,
               fineness[2] = {(double)c->n[0] / (double)c->width[0], (double)c->steps};

  factor[0] = factor[1] = 0;
  why[0]                = '\0';
  for (PetscInt k = 0; k < t->table.count; k++) {
    const SamErrorRow *row     = &t->table.row[k];
    const double       part    = task->steps ? ErrorBySteps(row, c->steps) : 0;
    const double       left    = LeftFor(task, c, row, part);
    const double       more[2] = {Narrower(row, left), !(part < UNKNOWN) ? AT_ONCE : part / (0.5 * asked)};

    if (!SamTaskConcerns(task->asked, row->name)) continue;
    for (int n = 0; n < 2; n++) {
      const SamWatch *w = Follow(task, row, n ? SAM_CAUSE_STEPS : SAM_CAUSE_CELLS, fineness[n]);
      char            dear[SAM_ACCURACY_LIMIT];

      if (w->stalls >= STALLS && more[n] > 1)
        (void)snprintf(why, size, "finer cells do not lower it");
      else if (n == 0 && IsDear(task, c, row, w, more[0], left, dear, sizeof(dear)))
        (void)snprintf(why, size, "%s", dear);
      else if (n == 0 || more[n] > 1)
        factor[n] = PetscMax(factor[n], w->stalls > 0 ? PetscMin(more[n], AGAIN) : more[n]);
    }
  }
}

/* ---- from one trial to the next ---- */

/* Chooses the width of the grid by the contact that was found. */
static void Fit(const SamTask *task, const SamTrial *t, SamChoice *c)
{
  for (PetscInt k = 0; k < task->axes; k++) {
    const PetscReal cell = c->width[k] / (PetscReal)c->n[k], middle = 0.5 * (t->low[k] + t->high[k]),
                    size = t->high[k] - t->low[k];

    if (task->center && PetscAbsReal(middle - c->center[k]) > 0.1 * size) {
      c->center[k] = middle;
      c->width[k]  = (PetscReal)SamAdviceRoundUp((double)(SAM_TRIAL_ROOM * size + 2 * cell));
    } else {
      const PetscReal reach = PetscMax(t->high[k] - c->center[k], c->center[k] - t->low[k]);

      c->width[k] = (PetscReal)SamAdviceRoundUp((double)(2 * SAM_TRIAL_ROOM * reach + 2 * cell));
    }
  }
}

/* Makes the cells so many times narrower than they were on the grid of a trial. */
static void Refine(const SamTask *task, const SamChoice *was, double factor, SamChoice *c)
{
  for (PetscInt k = 0; k < task->axes; k++) {
    const double n = factor * (double)was->n[k] * (double)(c->width[k] / was->width[k]);

    c->n[k] = (PetscInt)PetscMin(SamGridRoundUp(ceil(n)), (double)task->most);
  }
}

/* Multiplies the steps per row. */
static void Divide(const SamTask *task, double factor, SamChoice *c)
{
  if (task->steps && factor > 1)
    c->steps = (PetscInt)PetscMin(ceil((double)c->steps * factor * (1 - 1e-9)), MOST_STEPS);
}

/* True if the contact that was found needs another place or width of the grid, or so much less of it that a run and
   another trial take no longer than a run on the present one. */
static PetscBool Moves(const SamTask *task, const SamChoice *was, const SamChoice *c)
{
  double part = 1;

  for (PetscInt k = 0; k < task->axes; k++) {
    if (c->width[k] > (1 + SAME) * was->width[k] || PetscAbsReal(c->center[k] - was->center[k]) > SAME * was->width[k])
      return PETSC_TRUE;
    part *= (double)(c->width[k] / was->width[k]);
  }
  return part < PAYS ? PETSC_TRUE : PETSC_FALSE;
}

void SamTaskChange(SamTask *task, const SamTrial *t, SamChoice *c, PetscBool *last, char limit[])
{
  const SamChoice was = *c;
  PetscBool       cheap, near;
  double          factor[2];

  *last    = PETSC_FALSE;
  limit[0] = '\0';
  if (t->status == SAM_STATUS_EDGE_CONTACT && !t->failed && task->size) {
    for (PetscInt k = 0; k < task->axes; k++) c->width[k] *= 1.6;
    return;
  }
  if (t->failed && task->number && was.n[0] < 8 * task->few) { /* as of cells that cannot follow the loads */
    Refine(task, &was, 2, c);
    return;
  }
  *last = t->failed || t->status != SAM_STATUS_CONVERGED || !t->touched ? PETSC_TRUE : PETSC_FALSE;
  if (*last) return; /* the run tells why */
  if (task->size) Fit(task, t, c);
  Demand(task, &was, t, factor, limit, SAM_ACCURACY_LIMIT);
  if (limit[0] && factor[0] <= 1 && factor[1] <= 1) {
    *c    = was;
    *last = PETSC_TRUE;
    return;
  }
  cheap = (double)was.n[0] * (double)was.n[1] * (double)t->steps <= CHEAP ? PETSC_TRUE : PETSC_FALSE;
  near  = factor[0] <= NEAR && factor[1] <= NEAR ? PETSC_TRUE : PETSC_FALSE;
  if (cheap && factor[0] <= 1 && factor[1] <= 1 && !Moves(task, &was, c)) { /* it has been tried itself */
    *c    = was;
    *last = PETSC_TRUE;
    return;
  }
  *last = near && !cheap ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2; k++) factor[k] = near ? factor[k] : NextOf(factor[k]);
  factor[0] = PetscMax(factor[0], 1); /* numbers may wander from grid to grid: none is coarser than what was tried */
  if (task->number) Refine(task, &was, factor[0], c);
  Divide(task, factor[1], c);
  if (c->n[0] == was.n[0] && c->n[1] == was.n[1] && c->steps == was.steps && !Moves(task, &was, c)) {
    *last = PETSC_TRUE;
    (void)snprintf(limit, SAM_ACCURACY_LIMIT, "-accuracy can choose no finer grid and no more steps");
  }
}
