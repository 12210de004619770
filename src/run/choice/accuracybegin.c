/*
  -accuracy: the first grid. It has few cells; its width is that of a contact in closed form, or, without one, that at
  whose border the separation of the bodies is what Hertz's contact of this load has at its edge.
*/
#include "accuracyimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/gap.h>
#include <petsam/private/grid.h>
#include <math.h>

#define FEW      64    /* cells along the shorter side of the first grid, */
#define FEW_ROW  256   /* and of a row in plane strain */
#define MOST     4096  /* most cells along a side that are chosen, */
#define MOST_ROW 65536 /* and of a row in plane strain */
#define FLAT     4.0   /* most times by which a cell is longer than wide */
#define PROBE    16    /* cells per side on which the separation is looked at */

/* Returns the largest normal load, or approach, of the history. */
static PetscReal Largest(SamSimulation s, PetscBool *force)
{
  PetscReal most = 0;

  *force = PETSC_TRUE;
  for (PetscInt k = 0; k < s->needs.steps; k = SamHistoryNextEnd(s->history, k)) {
    SamControl control;

    if (!SamHistoryIsLast(s->history, k)) continue;
    control = SamHistoryGetStep(s->history, k);
    *force  = control.force[SAM_COMPONENT_N];
    most    = PetscMax(most, control.value[SAM_COMPONENT_N]);
  }
  return most;
}

/* Gets how much wider the separation is at the border of a square, or row, of this half width than at its least. */
static PetscErrorCode Separation(const SamSetup *s, PetscReal half, double *wider)
{
  const PetscInt  axes = s->grid->axes, n[2] = {PROBE, axes > 1 ? PROBE : 1};
  const PetscReal width[2] = {2 * half, axes > 1 ? 2 * half : 1};
  double least[2] = {-INFINITY, -INFINITY}; /* minus the least separation: of all cells, of those at the border */
  const double *heights;
  SamGrid       grid;
  Vec           h;

  PetscFunctionBegin;
  PetscCall(SamGridCreate(s->grid->comm, n, width, s->grid->center, &grid));
  PetscCall(SamGridCreateVec(grid, 1, &h));
  PetscCall(SamGapFill(s->gap, grid, h));
  PetscCall(VecGetArrayRead(h, &heights));
  for (PetscInt c = 0; c < grid->cells; c++) {
    const PetscInt  i = c % n[0], j = grid->row_start + c / n[0];
    const PetscBool border = i == 0 || i == n[0] - 1 || (axes > 1 && (j == 0 || j == n[1] - 1));

    least[0] = PetscMax(least[0], -heights[c]);
    if (border) least[1] = PetscMax(least[1], -heights[c]);
  }
  PetscCall(VecRestoreArrayRead(h, &heights));
  PetscCall(SamMax(grid->comm, 2, least));
  *wider = least[0] - least[1];
  PetscCall(VecDestroy(&h));
  PetscCall(SamGridDestroy(&grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the half width at whose border the separation is that of Hertz's contact at its edge; 0: none is. */
static PetscErrorCode Search(const SamSetup *s, PetscBool force, PetscReal value, PetscReal *half)
{
  const double modulus = (double)SamPairModulus(s->pair);

  PetscFunctionBegin;
  for (double a = 1e-9; a < 1e3; a *= 1.2) {
    double         wider = 0, load;
    PetscErrorCode code;
    char           message[SAM_MESSAGE] = "";

    PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
    code = Separation(s, a, &wider);
    PetscCall(PetscPopErrorHandler());
    load  = !force ? 2 * wider : s->grid->axes > 1 ? 8. / 3 * modulus * a * wider : 0.5 * PETSC_PI * modulus * wider;
    *half = (PetscReal)a;
    if (code || load >= (double)value) PetscFunctionReturn(PETSC_SUCCESS); /* an error: wider than the bodies */
  }
  *half = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the width of the first grid. */
static PetscErrorCode ChooseWidth(SamSimulation s, SamChoice *c)
{
  const SamSetup *setup = &s->setup;
  PetscBool       force, known;
  const PetscReal value = Largest(s, &force);
  PetscReal       half[2];

  PetscFunctionBegin;
  PetscCall(SamAdviceEstimateContact(setup, force, value, half, &known));
  for (PetscInt k = 0; k < setup->grid->axes; k++)
    if (!isfinite(half[k]) || !(half[k] > 0)) known = PETSC_FALSE;
  if (!known) {
    PetscCall(Search(setup, force, value, &half[0]));
    half[1] = half[0];
  }
  PetscCheck(half[0] > 0 && value > 0, s->comm, SAM_ERR_USER,
             "-accuracy: the loads and the shape do not give the width of the contact: give -grid_size");
  for (PetscInt k = 0; k < 2; k++)
    c->width[k] = (PetscReal)SamAdviceRoundUp(2 * SAM_TRIAL_ROOM * (double)half[k % setup->grid->axes]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses cells of about the same number along both sides, unless one is much longer. */
static void ChooseCells(const SamTask *task, double few, SamChoice *c)
{
  const double shorter = (double)PetscMin(c->width[0], c->width[task->axes - 1]);

  for (PetscInt k = 0; k < 2; k++) {
    const double n = few * PetscMax(1, (double)c->width[k] / shorter / FLAT);

    c->n[k] = k < task->axes ? (PetscInt)PetscMin(SamGridRoundUp(n), (double)task->most) : 1;
  }
}

PetscErrorCode SamTaskBegin(SamSimulation s, SamTask *task, SamChoice *c)
{
  const SamGrid grid = s->setup.grid;
  PetscInt      rows_of_history;

  PetscFunctionBegin;
  task->axes      = grid->axes;
  task->few       = SamGridIsRow(grid) ? FEW_ROW : FEW;
  task->most      = SamGridIsRow(grid) ? MOST_ROW : MOST;
  rows_of_history = 1 + (s->needs.steps - SamHistoryGetStart(s->history)) / SamHistoryGetIncrements(s->history);
  if (rows_of_history < 2 || s->step_rtol > 0 || s->plan.bands) task->steps = PETSC_FALSE;
  for (PetscInt k = 0; k < 2; k++) {
    c->n[k]      = k ? grid->ny : grid->nx;
    c->width[k]  = grid->width[k];
    c->center[k] = grid->center[k];
  }
  c->steps = SamHistoryGetIncrements(s->history);
  if (task->size) PetscCall(ChooseWidth(s, c));
  if (task->number) ChooseCells(task, (double)task->few, c);
  PetscFunctionReturn(PETSC_SUCCESS);
}
