/*
  Estimates the errors of dissimilar bodies while their contact grows: of the dissipated energy by the cells, and of the
  area of stick by the steps.

  The pressure of such bodies moves their surfaces over each other at the edge of contact. Where most of the contact
  sticks, this slip is in a ring that moves outward with the edge, and cells pass it: they touch, slip, and stick. In a
  ring of few cells the bound, which grows like a root behind the edge, and the place of sticking are those of whole
  cells.

  Energy. Its error by the cells is the part

      0.5/w^1.4,   w = (contact area - stick area)/(length of the edge that slips),

  of the energy of a step, w in cells. T widens the ring on one side and takes it away on the other: the ring is where
  cells at the edge slip. Measured on cylinders of steel on polymer and on aluminium, mu 0.2 to 1, with T of 0 to
  0.7 mu N in proportion to N, 41 to 641 cells against 1281 in the same 80 steps, and on spheres of 32 to 96 cells. A
  ring of less than a cell leaves the energy unknown.

  Length of steps. A step in which the edge moves by more than a third of the ring's width loses part of what the ring
  passes: on 321 cells with a ring of 12 cells the energy lacked 28 to 11 % where the edge moved by 14 to 2 cells.

  Stick. A step cannot tell where within it cells stop to slip: in the first one the area of stick has an error of about
  0.11 of the area of contact, and in the n-th of equal steps of N, or where N grows by its n-th part, of 0.11/n; less
  if less of the contact slips. Measured on cylinders and spheres in 2 to 10 steps, mu 0.1 to 0.6, against 80.
*/
#include "adviceimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/pressed.h>
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <math.h>

#define WRONG   0.5 /* error of the energy by the cells, relative to it and to w to the power of */
#define FALLS   -1.4
#define WIDE    6.0       /* cells across the ring on an advised grid */
#define UNKNOWN 0.25      /* the same above which the energy is unknown */
#define SIDE    0.25      /* least part of the edge that slips; fewer cells are stray */
#define PASSES  (1.0 / 3) /* motion of the edge in a step, relative to the ring's width, up to which it is short */
#define STICKS  0.11      /* error of the area of stick in one step, relative to the area of contact */

/* Sums over cells: those at the edge of contact, those of them that slip; those in contact, and the pressure (Pa),
   before the step and after it */
enum { EDGE, SLIPS, CONTACT, PRESSURE = CONTACT + 2, SUMS = PRESSURE + 2 };

/* True if the cell in column i of the grid's row j has a side without contact beyond. */
static PetscBool IsEdge(SamGrid grid, const SamHalo *p, PetscInt i, PetscInt j)
{
  for (PetscInt side = -1; side <= 1; side += 2) {
    if (!SamIsPressed(SamHaloAt(p, 0, i + side, j))) return PETSC_TRUE;
    if (!SamGridIsRow(grid) && !SamIsPressed(SamHaloAt(p, 0, i, j + side))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode SumCells(const SamSetup *s, double sums[SUMS])
{
  const SamGrid      grid = s->grid;
  const SamSolution *now;
  SamState           state;
  const double      *p0, *q, *b;
  Vec                before;
  SamHalo            p;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(s->contact, &now));
  PetscCall(SamContactGetState(s->contact, &state));
  before = SamStateGetField(state, SamStateFindField(state, "pressure"), SAM_COMMITTED);
  PetscCall(SamHaloBegin(grid, now->pressure, 1, 1, SamElasticityGetTraits(s->elasticity).periodic, &p));
  PetscCall(VecGetArrayRead(before, &p0));
  PetscCall(VecGetArrayRead(now->shear, &q));
  PetscCall(VecGetArrayRead(now->bound, &b));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const PetscInt i = k % grid->nx, j = grid->row_start + k / grid->nx;
    const double   pressure[2] = {p0[k], SamHaloAt(&p, 0, i, j)};

    for (int n = 0; n < 2; n++) {
      sums[CONTACT + n] += SamIsPressed(pressure[n]) ? 1 : 0;
      sums[PRESSURE + n] += pressure[n];
    }
    if (!SamIsPressed(pressure[1]) || !IsEdge(grid, &p, i, j)) continue;
    sums[EDGE] += 1;
    sums[SLIPS] += SamCellStateOf(pressure[1], q[k], q[k + grid->cells], b[k]) == SAM_CELL_STICK ? 0 : 1;
  }
  PetscCall(VecRestoreArrayRead(now->bound, &b));
  PetscCall(VecRestoreArrayRead(now->shear, &q));
  PetscCall(VecRestoreArrayRead(before, &p0));
  PetscCall(SamHaloEnd(&p));
  PetscCall(SamSum(grid->comm, SUMS, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the error of the area of stick after a step in which N grew from the part `before` of it. */
static void SetStick(SamRing *ring, double before, double sticks)
{
  ring->unsure = PetscMax(ring->unsure * before, STICKS * (1 - before));
  ring->stick  = sticks > 0 ? PetscMin(ring->unsure, 1 - sticks) / sticks : 0;
}

/* Ends the growth of N. */
static void EndGrowth(SamRing *ring)
{
  ring->worst  = PetscMax(ring->worst, ring->stick);
  ring->unsure = ring->stick = 0;
}

PetscErrorCode SamAdviceAddRing(SamAdvice *a, const SamRingStep *now)
{
  SamRing *const ring       = &a->slip.ring;
  double         sums[SUMS] = {0}, width;

  PetscFunctionBegin;
  if (now->touches) PetscCall(SumCells(a->setup, sums));
  if (!(sums[PRESSURE + 1] > sums[PRESSURE])) EndGrowth(ring);
  if (!(sums[PRESSURE + 1] > sums[PRESSURE])) PetscFunctionReturn(PETSC_SUCCESS);
  ring->steps++;
  SetStick(ring, sums[PRESSURE] / sums[PRESSURE + 1], now->sticks);
  if (!(now->energy > 0 && now->edge > 0 && now->width < INFINITY)) PetscFunctionReturn(PETSC_SUCCESS);
  /* cells that touch last may stick while those behind them slip: then nothing is known of the side */
  width = now->width / (sums[SLIPS] > 0 ? PetscMax(sums[SLIPS] / sums[EDGE], SIDE) : 1);
  ring->energy += now->energy;
  ring->width += now->energy * width;
  ring->moves += now->energy * PetscMax(sums[CONTACT + 1] - sums[CONTACT], 0) / now->edge;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mean width of the ring in cells, weighted by the energy */
static double WidthOf(const SamRing *ring)
{
  return PetscMax(ring->width / ring->energy, SAM_ADVICE_NARROW);
}

/* Returns the part of the ring's width that the contact's edge passes in a step. */
static double MovesOf(const SamRing *ring)
{
  return ring->moves / PetscMax(ring->width, SAM_ADVICE_NARROW * ring->energy);
}

static void Cells(SamAdvice *a)
{
  const SamRing *ring  = &a->slip.ring;
  const double   error = ring->error / ring->energy;

  /* The width that long steps find is not that of the ring: more steps tell it first. */
  SamDoubtsAdd(&a->doubts, MovesOf(ring) > PASSES ? SAM_CAUSE_STEPS : SAM_CAUSE_CELLS, error < UNKNOWN ? error : 1,
               MovesOf(ring) > PASSES ? MovesOf(ring) / PASSES : WIDE / WidthOf(ring), "dissipated_energy",
               "dissimilar bodies slip at the edge of the growing contact, in a ring of %.2g cells", WidthOf(ring));
}

static void Steps(SamAdvice *a)
{
  const SamRing *ring  = &a->slip.ring;
  const double   moves = MovesOf(ring);

  if (moves <= PASSES) return;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, SAM_DOUBT_LARGE * moves / PASSES, moves / PASSES, "dissipated_energy",
               "dissimilar bodies slip in a ring at the edge, which passes by %.2g of its width in a step", moves);
}

static void Stick(SamAdvice *a)
{
  const SamRing *ring = &a->slip.ring;

  SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, ring->worst, ring->worst / (SAM_DOUBT_LARGE / 2), "stick_area",
               "N of dissimilar bodies grows in %" PetscInt_FMT " step%s", ring->steps, ring->steps > 1 ? "s" : "");
}

void SamAdviceRing(SamAdvice *a, double least)
{
  SamRing *const ring = &a->slip.ring;

  EndGrowth(ring);
  Stick(a);
  ring->error = ring->energy > 0 ? PetscMin(WRONG * pow(WidthOf(ring), FALLS), 1) * ring->energy : 0;
  if (!(ring->energy > least)) return;
  Cells(a);
  Steps(a);
}
