/*
  Estimates the error of a grid in lives whose scar ends at a stick zone.

  Where cells stick, nothing wears, and beside them the depth grows from cycle to cycle. So a step of the depth forms at
  the edge of the stick zone, at which the pressure has a peak, in the limit like 1/sqrt(d) at the distance d from it
  (Ciavarella and Hills 1999, Popov 2014). A cell sticks or slips as a whole, so that the step lies at a side of a cell,
  up to half a cell from where it belongs, and deepens there. Volume and energy follow the width of the scar by a high
  power: in the limit the volume grows like width^2.5, and the energy of a late cycle, which falls towards zero, faster
  still.

  At hand are, as means over the faces between the last cell that is not worn and the first that is:

    x, the pressure of the last cell relative to that of the cell before it: below 1 without a step, 2.4 in the limit;
    j, the depth in the first cells as a part of the sum of all depths;
    w, the width of the scar in cells.

  The errors are about

    volume: (x - 1) j + 1.1 s/w,   energy of a cycle: 1.5 (x - 1) j + 5 s/w,   s = min(1, (x - 1)^2),

  and in a narrow scar that of its slip zone without a step (slipzones.c) besides. That of the maximum depth, which may
  lie between two cells, is that of the step and 1.4/(w^2 + 4), as of the crest of a wave.

  The first term is that of a young step, a part of the first cells, the second that of a late one. The factors were
  found on 46 random lives of cylinders and pads with 80 to 320 cells against four times finer ones. Of 24 energies that
  were wrong by more than 5 % 20 were between a half and four times the estimate, and volumes wrong by more than 5 %
  never more than twice it. An energy that has fallen to a thousandth is wrong by more, and is told as unknown. Along
  round edges in three dimensions the errors cancel in part.

  A pressure that falls like d^-u from the edge has means over cells in the ratio x = 1/(2^(1 - u) - 1), and on cells
  half as wide a peak 2^u = 2 x/(1 + x) times as high. A young step is resolved soon, so that the peak grows less on
  still finer cells: the power 2 min(1, x - 1) of this is taken for cells a quarter as wide.

  Sources: M. Ciavarella, D. A. Hills, Eur. J. Mech. A/Solids 18 (1999) 491; V. L. Popov, Sci. Rep. 4 (2014) 3749.
*/
#include "adviceimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/law.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/pressed.h>
#include <math.h>

#define WORN    1e-3 /* depth, relative to the maximum, up to which a cell counts as not worn */
#define YOUNG   1.5  /* error of the energy relative to that of the volume, of a young step, */
#define LATE    5    /* and factors of the errors of a late one, of the energy */
#define VOLUME  1.1  /* and of the volume */
#define CREST   1.4  /* error of the maximum depth between two cells, relative to 1/(w^2 + 4) */
#define CANCELS 9    /* largest number of cells along an edge whose errors count as independent */
#define ALLOWED 0.05 /* error of a number that is not told */
#define SLOW    1.5  /* ratio of the cells of a sufficient grid to those that an error in proportion to h would need */

/* Sums over the faces of the edge, and over all cells that are worn; the last one is a maximum */
enum { FACES, FIRST, LAST, BEFORE, CELLS, DEPTH, SUMS };
typedef struct {
  double sum[SUMS];
  double peak; /* Pa: largest pressure of a last cell */
} Edge;

/* True if a cell is in contact and not worn. */
static PetscBool IsKept(const SamHalo *p, const SamHalo *w, double least, PetscInt i, PetscInt j)
{
  return SamIsPressed(SamHaloAt(p, 0, i, j)) && !(SamHaloAt(w, 0, i, j) > least) ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds the faces between a cell that is kept and worn ones. */
static void AddFaces(const SamHalo *p, const SamHalo *w, double least, PetscInt i, PetscInt j, Edge *edge)
{
  for (int k = 0; k < 4; k++) {
    const PetscInt di = k < 2 ? 2 * k - 1 : 0, dj = k < 2 ? 0 : 2 * k - 5;
    const double   first = SamHaloAt(w, 0, i + di, j + dj);

    if (!(first > least) || !IsKept(p, w, least, i - di, j - dj)) continue;
    edge->sum[FACES]++;
    edge->sum[FIRST] += first;
    edge->sum[LAST] += SamHaloAt(p, 0, i, j);
    edge->sum[BEFORE] += SamHaloAt(p, 0, i - di, j - dj);
    edge->peak = PetscMax(edge->peak, SamHaloAt(p, 0, i, j));
  }
}

/* Returns the depth of the scar of both bodies in a new field, and its maximum. */
static PetscErrorCode GetDepth(const SamSetup *s, Vec *depth, PetscReal *most)
{
  Vec other;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(s->grid, 1, depth));
  PetscCall(VecDuplicate(*depth, &other));
  PetscCall(SamContactGetField(s->contact, "wear_depth1", *depth));
  PetscCall(SamContactGetField(s->contact, "wear_depth2", other));
  PetscCall(VecAXPY(*depth, 1, other));
  PetscCall(VecMax(*depth, NULL, most));
  PetscCall(VecDestroy(&other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MeasureEdge(const SamSetup *s, Edge *edge)
{
  const SamSolution *now;
  const SamGrid      g = s->grid;
  SamHalo            p, w;
  Vec                depth;
  PetscReal          most;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(s->contact, &now));
  PetscCall(GetDepth(s, &depth, &most));
  PetscCall(SamHaloBegin(g, now->pressure, 1, 1, PETSC_FALSE, &p));
  PetscCall(SamHaloBegin(g, depth, 1, 1, PETSC_FALSE, &w));
  for (PetscInt j = g->row_start; j < g->row_start + g->rows && most > 0; j++)
    for (PetscInt i = 0; i < g->nx; i++) {
      const double worn = SamHaloAt(&w, 0, i, j);

      edge->sum[DEPTH] += worn;
      edge->sum[CELLS] += worn > WORN * most ? 1 : 0;
      if (IsKept(&p, &w, WORN * most, i, j)) AddFaces(&p, &w, WORN * most, i, j, edge);
    }
  PetscCall(SamHaloEnd(&w));
  PetscCall(SamHaloEnd(&p));
  PetscCall(VecDestroy(&depth));
  PetscCall(SamSum(g->comm, SUMS, edge->sum));
  PetscCall(SamMax(g->comm, 1, &edge->peak));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Errors of the numbers that are told, relative to them */
typedef struct {
  double width; /* of the scar, in cells */
  double energy, volume, depth, peak;
} Errors;

static Errors Estimate(const SamAdvice *a, const Edge *edge, double most)
{
  const double *sum = edge->sum, ratio = sum[LAST] / sum[BEFORE], step = PetscMax(ratio - 1, 0);
  const double  along = sqrt(PetscMin(PetscMax((double)a->slip.length, 1), CANCELS)), width = sum[CELLS] / sum[FACES];
  const double  young = step * sum[FIRST] / sum[DEPTH] / along, late = PetscMin(1, step * step) / (width * along);
  Errors        e = {.width = width};

  e.volume = young + VOLUME * late + SamAdviceZoneError((PetscReal)width, a->slip.length);
  e.depth  = e.volume + CREST / (width * width + 4);
  if (a->cycles && a->slip.energy > 0 && !SamAdviceIsSpent(a)) e.energy = YOUNG * young + LATE * late;
  /* A change of the maximum elsewhere has been told. */
  if (fabs((double)a->extent.change) <= SAM_ADVICE_WORN_PEAK)
    e.peak = edge->peak * pow(2 * ratio / (1 + ratio), 2 * PetscMin(1, step)) / most - 1;
  return e;
}

/* Appends a number that may be wrong to a list. */
static void Append(const char name[], double error, char list[], size_t size)
{
  const size_t used = strlen(list);

  if (error > ALLOWED)
    (void)snprintf(list + used, size - used, "%s%.0f %% in the %s", used ? ", " : " errors are about ",
                   100 * PetscMin(error, 1), name);
}

static void Tell(SamAdvice *a, const Errors *e)
{
  const double    worst = PetscMax(e->energy, e->volume), crest = 1.05 * sqrt(CREST / ALLOWED - 4) / e->width;
  const PetscBool peaked = e->peak > ALLOWED ? PETSC_TRUE : PETSC_FALSE;
  const double    factor = PetscMax(PetscMax(worst * SLOW / ALLOWED, e->depth > ALLOWED ? crest : 0), peaked ? 2 : 0);
  char            list[200] = "", peak[100] = "", better[SAM_ADVICE_GRIDS];

  Append("energy of the last cycle", e->energy, list, sizeof(list));
  Append("worn volumes", e->volume, list, sizeof(list));
  Append("maximum depths", e->depth, list, sizeof(list));
  if (peaked)
    (void)snprintf(peak, sizeof(peak), "%s the maximum pressure is about %.0f %% higher on finer cells",
                   list[0] ? ";" : "", 100 * e->peak);
  if (!list[0] && !peaked) return;
  SamAdviceGrids(a, PetscMax(factor, (double)a->finer), better);
  SamAdviceSay(a, better[0] ? "" : "grid_n",
               "%sthe scar is %.2g cells wide and ends at the edge of a stick zone:%s%s%s", a->after, e->width, list,
               peak, better);
}

PetscErrorCode SamAdviceWornStick(SamAdvice *a)
{
  const SamSetup  *s    = a->setup;
  const SamProblem p    = s->problem;
  Edge             edge = {.peak = 0};
  Errors           errors;
  PetscReal        most;

  PetscFunctionBegin;
  if (!(SamProblemGetLaw(p, SAM_LAW_ARCHARD) || SamProblemGetLaw(p, SAM_LAW_ENERGY)))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (!a->slip.steps || a->slip.rolls || SamProblemGetLaw(p, SAM_LAW_SLIDE)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MeasureEdge(s, &edge));
  PetscCall(SamContactGetNumber(s->contact, "pressure_max", &most));
  if (!(edge.sum[FACES] > 0 && edge.sum[BEFORE] > 0 && most > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  errors = Estimate(a, &edge, (double)most);
  Tell(a, &errors);
  PetscFunctionReturn(PETSC_SUCCESS);
}
