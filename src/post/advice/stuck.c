/*
  Slip zones narrower than a cell, in contacts in which all cells stick.

  If everything sticks, the shear grows without bound at the contact's edge, where the pressure vanishes: in the last
  cell, of width h, q = K/sqrt(d) and mu p = A sqrt(d) at the distance d from the edge. So there is a slip zone whenever
  a tangential load changes. The means over the cell give

    s = mean q/mean mu p = 3 K/(A h),

  and the zone of Cattaneo is as wide as w = 2 K/A = 2/3 s h. Its energy per length of the edge is pi A^2 w^3/(12 E*),
  which with A = 1.5 mean mu p/sqrt(h) is pi/18 (mean mu p)^2 h^2 s^3/E*; the shear at its end is A sqrt(w). After a
  load reversal the same holds for the change of q and twice the bound. If loads move the contact's edge, the part of
  the shear's change that is within mu times the change of the pressure causes no slip (Ciavarella 1998).

  Sources: C. Cattaneo, Rend. Accad. Naz. Lincei 27 (1938) 342, 434, 474; M. Ciavarella, Int. J. Solids Struct. 35
  (1998) 2349-2378.
*/
#include "adviceimpl.h"
#include <petsam/private/bodyimpl.h>
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/pressed.h>
#include <petsam/private/body.h>
#include <math.h>

/* Energy of the zone per length of the edge, relative to b^2 h^2 s^3/E*, b = mean mu p, */
#define WORK (PETSC_PI / 18)
/* and the shear at its end, relative to b sqrt(s): 1.5 sqrt(2/3) */
#define HIGHEST 1.22

/* Sums over the contact's last cells: b^2 h^2 times the length of the edge, and the same times s^3 of the step */
enum { EDGE, CUBES, SUMS };

/* Fields now and before the step */
typedef struct {
  SamHalo       p;
  const double *b, *q, *p0, *b0, *q0;
} Seen;

/* Returns the sum of a cell's widths across its faces without contact beyond; beyond the grid's border is contact. */
static double FindOpen(const Seen *s, SamGrid grid, PetscInt i, PetscInt j)
{
  double open = 0;

  for (PetscInt side = -1; side <= 1; side += 2) {
    if (i + side >= 0 && i + side < grid->nx && !SamIsPressed(SamHaloAt(&s->p, 0, i + side, j)))
      open += (double)grid->dx;
    if (j + side >= 0 && j + side < grid->ny && !SamIsPressed(SamHaloAt(&s->p, 0, i, j + side)))
      open += (double)grid->dy;
  }
  return open;
}

static void AddCells(const Seen *s, SamGrid grid, double sums[SUMS], double *bound)
{
  const PetscInt cells = grid->cells;

  for (PetscInt k = 0; k < cells; k++) {
    const double b    = s->b[k],
                 open = s->p.own[k] > 0 ? FindOpen(s, grid, k % grid->nx, grid->row_start + k / grid->nx) : 0;
    const double edge = b * b * (double)(grid->dx * grid->dy) * open;
    double       part;

    if (!(edge > 0)) continue;
    *bound = PetscMax(*bound, b);
    sums[EDGE] += edge;
    if (!SamIsPressed(s->p0[k])) continue; /* contact is made in this cell */
    part = hypot(s->q[k] - s->q0[k], s->q[k + cells] - s->q0[k + cells]) - fabs(b - s->b0[k]);
    sums[CUBES] += part > 0 ? edge * pow(part / b, 3) : 0;
  }
}

/* Reads a field of the step before. */
static PetscErrorCode ReadBefore(SamState state, const char name[], Vec *field, const double **values)
{
  PetscFunctionBegin;
  *field = SamStateGetField(state, SamStateFindField(state, name), SAM_COMMITTED);
  PetscCall(VecGetArrayRead(*field, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdviceMeasureStuck(const SamSetup *s, double *share, SamStuck *stuck)
{
  const SamSolution *now;
  SamState           state;
  Seen               seen;
  Vec                before[3];
  double             sums[SUMS] = {0}, bound = 0;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(s->contact, &now));
  PetscCall(SamContactGetState(s->contact, &state));
  PetscCall(ReadBefore(state, "pressure", &before[0], &seen.p0));
  PetscCall(ReadBefore(state, "bound", &before[1], &seen.b0));
  PetscCall(ReadBefore(state, "shear", &before[2], &seen.q0));
  PetscCall(VecGetArrayRead(now->bound, &seen.b));
  PetscCall(VecGetArrayRead(now->shear, &seen.q));
  PetscCall(SamHaloBegin(s->grid, now->pressure, 1, 1, PETSC_FALSE, &seen.p));
  AddCells(&seen, s->grid, sums, &bound);
  PetscCall(SamHaloEnd(&seen.p));
  PetscCall(VecRestoreArrayRead(now->shear, &seen.q));
  PetscCall(VecRestoreArrayRead(now->bound, &seen.b));
  PetscCall(VecRestoreArrayRead(before[2], &seen.q0));
  PetscCall(VecRestoreArrayRead(before[1], &seen.b0));
  PetscCall(VecRestoreArrayRead(before[0], &seen.p0));
  PetscCall(SamSum(s->grid->comm, SUMS, sums));
  PetscCall(SamMax(s->grid->comm, 1, &bound));
  *share       = sums[EDGE] > 0 ? cbrt(sums[CUBES] / sums[EDGE]) : 0;
  stuck->work  = WORK * sums[EDGE] / (double)SamPairModulus(s->pair);
  stuck->shear = HIGHEST * bound;
  PetscFunctionReturn(PETSC_SUCCESS);
}
