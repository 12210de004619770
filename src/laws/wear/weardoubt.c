/*
  Doubts of worn surfaces: the error of a grid in lives whose scar ends at a stick zone, and of passages.

  Where cells stick, nothing wears, and beside them the depth grows from cycle to cycle. So a step of the depth forms at
  the edge of the stick zone, at which the pressure has a peak, in the limit like 1/sqrt(d) at the distance d from it
  (Ciavarella and Hills 1999, Popov 2014). A cell sticks or slips as a whole, so that the step lies at a side of a cell,
  up to half a cell from where it belongs, and deepens there. Volume and energy follow the width of the scar by a high
  power: in the limit the volume grows like width^2.5, and the energy of a late cycle, which falls towards zero, faster
  still.

  At hand are, as means over the faces between the last cell that is not worn and the first that is:

    x, the pressure of the last cell relative to that of the cell before it: below 1 without a step, 2.4 in the limit;
    j, the depth in the first cells as a part of the sum of all depths;
    w, the width of the scar in cells;
    f, the part of the pressure that the step has taken from the first cells: 1 - o/sqrt((w - 1/2)/(w + 1/2)), o being
       their pressure relative to that of the last cells, and the root the same without a step.

  The errors are about

    volume: (x - 1) j + 1.1 f^1.5/w,   energy of a cycle: 1.5 (x - 1) j + 5 min(1, (x - 1)^2)/w,

  and in a narrow scar that of its slip zone without a step (slipzones.c) besides. That of the maximum depth, which may
  lie between two cells, is that of the step and 1.4/(w^2 + 4), as of the crest of a wave. Of many cells along a round
  edge one lies near the crest.

  The first term is that of a young step, a part of the first cells, the second that of a late one. The factors were
  found on 46 random lives of cylinders and pads with 80 to 320 cells against four times finer ones. Of 24 energies that
  were wrong by more than 5 % 20 were between a half and four times the estimate, and volumes wrong by more than 5 %
  never more than twice it. An energy that has fallen to a thousandth is wrong by more, and is told as unknown. Along
  round edges in three dimensions the errors cancel in part.

  The peak grows on cells a quarter as wide. Young, it lies in the first cells. A pressure that falls like d^-u from the
  edge has means over cells in the ratio x = 1/(2^(1 - u) - 1), and on cells half as wide a peak 2^u = 2 x/(1 + x) times
  as high; still finer cells change it little. Late, it lies in the last cells, beside first ones without pressure, as
  at the edge of a punch: it is twice as high. Between them the step is sharp in part, and the peak 1 + f^1.5 times as
  high. The power is that which fits best; x alone misses the step of a narrow scar, whose pressure falls without it.

  The shear at the edge is the bound mu p of the last reversal less a part that the way back takes, which is smooth. So
  it grows by as much as the bound in the first cells, more than the pressure in proportion, or with the last cells by
  1 + f^1.5. Of 84 random lives 24 had a maximum pressure or shear that was wrong by more than 5 % and that no change of
  the peak (finerpeak.c) tells: all are told but a shear that was wrong by 5.0 %.

  The volume worn by passages is too large by about the part 0.065 w^-1.3. On spheres with w of 0.4 to 5 cells, of whose
  contact 17 or 28 % slipped, compared with 144 cells, the error was 22 % at w = 0.42, 13 % at 0.56, 9 % at 0.68, 8 % at
  0.85, 5.6 % at 0.9 and 1.1, 3.6 % at 1.4, 2.5 % at 1.7 and 1.8.

  Sources: M. Ciavarella, D. A. Hills, Eur. J. Mech. A/Solids 18 (1999) 491; V. L. Popov, Sci. Rep. 4 (2014) 3749.
*/
#include "wearimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/examination.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/pressed.h>
#include <math.h>

#define WORN    1e-3  /* depth, relative to the maximum, up to which a cell counts as not worn */
#define YOUNG   1.5   /* error of the energy relative to that of the volume, of a young step, */
#define LATE    5     /* and factors of the errors of a late one, of the energy */
#define VOLUME  1.1   /* and of the volume */
#define SHARP   1.5   /* power of the part of a step that is sharp */
#define CREST   1.4   /* error of the maximum depth between two cells, relative to 1/(w^2 + 4) */
#define CANCELS 9     /* largest number of cells along an edge whose errors count as independent */
#define PEAKED  2     /* how many times narrower cells are advised for largest values */
#define PASSED  0.065 /* error of the volume worn by passages, at a slip zone of one cell, relative to it, */
#define FALLS   1.3   /* and the power of its width by which it falls */
#define ADVISED 0.04  /* error of it on an advised grid */
#define SLOW    1.5   /* ratio of the cells of a sufficient grid to those that an error in proportion to h would need */

/* Sums over the faces of the edge: depth and pressure of first cells, pressures; and over all cells that are worn */
enum { FACES, FIRST, BEYOND, LAST, BEFORE, CELLS, DEPTH, SUMS };
/* Largest values at the edge, Pa: pressure of a last and of a first cell, bound of a first cell, shear of any */
enum { LAST_PEAK, FIRST_PEAK, FIRST_BOUND, SHEAR, PEAKS };
typedef struct {
  double sum[SUMS];
  double most[PEAKS];
} Edge;

/* Fields at the edge: pressure, bound, shear, depth */
typedef struct {
  SamHalo p, b, q, w;
} Seen;

static double ShearAt(const Seen *s, PetscInt i, PetscInt j)
{
  return hypot(SamHaloAt(&s->q, 0, i, j), SamHaloAt(&s->q, 1, i, j));
}

/* True if a cell is in contact and not worn. */
static PetscBool IsKept(const Seen *s, double least, PetscInt i, PetscInt j)
{
  return SamIsPressed(SamHaloAt(&s->p, 0, i, j)) && !(SamHaloAt(&s->w, 0, i, j) > least) ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds the faces between a cell that is kept and worn ones. */
static void AddFaces(const Seen *s, double least, PetscInt i, PetscInt j, Edge *edge)
{
  for (int k = 0; k < 4; k++) {
    const PetscInt di = k < 2 ? 2 * k - 1 : 0, dj = k < 2 ? 0 : 2 * k - 5;
    const double   first = SamHaloAt(&s->w, 0, i + di, j + dj), last = SamHaloAt(&s->p, 0, i, j),
                 beyond = SamHaloAt(&s->p, 0, i + di, j + dj);

    if (!(first > least) || !IsKept(s, least, i - di, j - dj)) continue;
    edge->sum[FACES]++;
    edge->sum[FIRST] += first;
    edge->sum[BEYOND] += beyond;
    edge->sum[LAST] += last;
    edge->sum[BEFORE] += SamHaloAt(&s->p, 0, i - di, j - dj);
    edge->most[LAST_PEAK]   = PetscMax(edge->most[LAST_PEAK], last);
    edge->most[FIRST_PEAK]  = PetscMax(edge->most[FIRST_PEAK], beyond);
    edge->most[FIRST_BOUND] = PetscMax(edge->most[FIRST_BOUND], SamHaloAt(&s->b, 0, i + di, j + dj));
    edge->most[SHEAR]       = PetscMax(edge->most[SHEAR], PetscMax(ShearAt(s, i, j), ShearAt(s, i + di, j + dj)));
  }
}

/* Returns the depth of the scar of both bodies in a new field, and its maximum. */
static PetscErrorCode GetDepth(SamGrid grid, SamContact contact, Vec *depth, PetscReal *most)
{
  Vec other;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, depth));
  PetscCall(VecDuplicate(*depth, &other));
  PetscCall(SamContactGetField(contact, "wear_depth1", *depth));
  PetscCall(SamContactGetField(contact, "wear_depth2", other));
  PetscCall(VecAXPY(*depth, 1, other));
  PetscCall(VecMax(*depth, NULL, most));
  PetscCall(VecDestroy(&other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MeasureEdge(const SamExamination *x, Edge *edge)
{
  const SamSolution *now;
  const SamGrid      g = x->grid;
  Seen               seen;
  Vec                depth;
  PetscReal          most;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(x->contact, &now));
  PetscCall(GetDepth(g, x->contact, &depth, &most));
  PetscCall(SamHaloBegin(g, now->pressure, 1, 1, PETSC_FALSE, &seen.p));
  PetscCall(SamHaloBegin(g, now->bound, 1, 1, PETSC_FALSE, &seen.b));
  PetscCall(SamHaloBegin(g, now->shear, 2, 1, PETSC_FALSE, &seen.q));
  PetscCall(SamHaloBegin(g, depth, 1, 1, PETSC_FALSE, &seen.w));
  for (PetscInt j = g->row_start; j < g->row_start + g->rows && most > 0; j++)
    for (PetscInt i = 0; i < g->nx; i++) {
      const double worn = SamHaloAt(&seen.w, 0, i, j);

      edge->sum[DEPTH] += worn;
      edge->sum[CELLS] += worn > WORN * most ? 1 : 0;
      if (IsKept(&seen, WORN * most, i, j)) AddFaces(&seen, WORN * most, i, j, edge);
    }
  PetscCall(SamHaloEnd(&seen.w));
  PetscCall(SamHaloEnd(&seen.q));
  PetscCall(SamHaloEnd(&seen.b));
  PetscCall(SamHaloEnd(&seen.p));
  PetscCall(VecDestroy(&depth));
  PetscCall(SamSum(g->comm, SUMS, edge->sum));
  PetscCall(SamMax(g->comm, PEAKS, edge->most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Errors of the numbers that are told, relative to them */
typedef struct {
  double width; /* of the scar, in cells */
  double energy, volume, depth, pressure, shear;
} Errors;

/* Returns the sharp part of the step: 0 without a step, 1 if the first cells have no pressure. */
static double SharpOf(const double sum[SUMS], double width)
{
  const double cells = PetscMax(width, 1), even = sqrt((cells - 0.5) / (cells + 0.5));

  return pow(PetscMax(1 - sum[BEYOND] / (sum[LAST] * even), 0), SHARP);
}

/* Estimates the errors of the largest pressure and shear of all cells, `most`. */
static void EstimatePeaks(const Edge *edge, double sharp, const double most[2], Errors *e)
{
  const double  ratio = edge->sum[LAST] / edge->sum[BEFORE], young = PetscMax(2 * ratio / (1 + ratio), 1);
  const double *peak = edge->most;

  e->pressure = PetscMax((1 + sharp) * peak[LAST_PEAK], young * peak[FIRST_PEAK]) / most[0] - 1;
  if (most[1] > 0)
    e->shear = (peak[SHEAR] + PetscMax(sharp * peak[SHEAR], (young - 1) * peak[FIRST_BOUND])) / most[1] - 1;
}

static Errors Estimate(const SamExamination *x, const Edge *edge, const double most[2])
{
  const double *sum = edge->sum, step = PetscMax(sum[LAST] / sum[BEFORE] - 1, 0);
  const double  along = sqrt(PetscMin(PetscMax((double)x->slip->length, 1), CANCELS)), width = sum[CELLS] / sum[FACES];
  const double  young = step * sum[FIRST] / sum[DEPTH] / along, sharp = SharpOf(sum, width);
  Errors        e = {.width = width};

  e.volume = young + VOLUME * sharp / (width * along) + SamZoneError(width, (double)x->slip->length);
  e.depth  = e.volume + CREST / (width * width + 4) / (along * along);
  if (x->cycles && x->slip->energy > 0 && !x->spent)
    e.energy = YOUNG * young + LATE * PetscMin(1, step * step) / (width * along);
  /* A change of the maximum elsewhere has been told. */
  if (fabs((double)x->extent->change) <= SAM_WORN_PEAK) EstimatePeaks(edge, sharp, most, &e);
  return e;
}

static void Tell(SamExamination *x, const Errors *e)
{
  const double crest = 1.05 * sqrt(CREST / SAM_DOUBT_LARGE - 4) / e->width;
  const struct {
    double      error, factor;
    const char *names;
  } of[] = {{e->energy, SLOW * e->energy / SAM_DOUBT_LARGE, "dissipated_energy"},
            {e->volume, SLOW * e->volume / SAM_DOUBT_LARGE, "volume1 volume2"},
            {e->depth, crest, "depth_max1 depth_max2"},
            {e->pressure, PEAKED, "pressure_max"},
            {e->shear, PEAKED, "shear_max"}};

  for (size_t k = 0; k < sizeof(of) / sizeof(of[0]); k++)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, of[k].error, of[k].factor, of[k].names,
                 "the scar is %.2g cells wide and ends at the edge of a stick zone", e->width);
}

/* Doubts scars that end at a stick zone. */
static PetscErrorCode Stick(SamExamination *x)
{
  Edge      edge = {.sum = {0}};
  Errors    errors;
  PetscReal most[2];

  PetscFunctionBegin;
  PetscCall(MeasureEdge(x, &edge));
  PetscCall(SamContactGetNumber(x->contact, "pressure_max", &most[0]));
  PetscCall(SamContactGetNumber(x->contact, "shear_max", &most[1]));
  if (!(edge.sum[FACES] > 0 && edge.sum[BEFORE] > 0 && most[0] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  errors = Estimate(x, &edge, (const double[]){(double)most[0], (double)most[1]});
  Tell(x, &errors);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Doubts the volume that passages wear by Archard's law; that by the energy follows from loads and creepages. */
static void Passages(SamExamination *x)
{
  const double error = PASSED * pow(x->passed, -FALLS);

  if (x->passed > 0)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, error, pow(error / ADVISED, 1 / FALLS), "volume1 volume2",
                 "the slip zone is %.2g cells wide", x->passed);
}

PetscErrorCode SamWearDoubt(SamLaw law, SamExamination *x)
{
  PetscFunctionBegin;
  if (SamMotionOf(x->elasticity)->continues) {
    if (x->slip->steps && !x->slip->rolls && !SamProblemSlides(SamContactGetProblem(x->contact))) PetscCall(Stick(x));
  } else if (x->grid->axes == 2 && !((const SamWear *)law->data)->by_energy) {
    Passages(x);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
