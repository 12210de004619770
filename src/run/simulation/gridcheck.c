/*
  Estimates the errors of a grid by solving the whole history again on half the cells in each direction; the whole
  history is needed because its end depends on the path.

  If the error of a number is of order m, its values on cells of width h and r h differ by (r^m - 1) times the error on
  the finer cells. Loads, displacements and energies are of order 2. Areas and peaks are treated as order 1, which is
  right at edges and if cells are counted; elsewhere they converge faster, and the error is overestimated.
*/
#include "simulationimpl.h"
#include <petsam/private/state.h>
#include <math.h>

#define LEAST 4 /* fewest cells per row whose half still makes a grid */

/* Run of the history, or of the life, on half the cells along each axis */
typedef struct {
  SamSetup setup;
  double   sums[SAM_STATE_NUMBERS]; /* numbers joined over all steps */
  SamLife  life;                    /* NULL: none */
  SamStep  step;                    /* the last one */
} Coarse;

PetscErrorCode SamSimulationReadGridCheck(SamSimulation s, const SamOptions *from)
{
  static const SamOptionRow row = {
    "grid_check", "all steps on half the cells too; errors of the last numbers", SAM_OPTION_BOOL,
    .excludes = "restart,friction_file,body1_surface_file,body2_surface_file,step_rtol,rolling"};

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &s->needs.grid_check, NULL));
  PetscCheck(!s->needs.grid_check || s->setup.grid->fewest >= LEAST, from->comm, SAM_ERR_USER,
             "-grid_check needs at least %d cells in x and in y (-grid_n)", LEAST);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the history, or as many cycles of the life, on the coarser contact. */
static PetscErrorCode SolveAll(SamSimulation s, Coarse *c)
{
  const SamContact contact = c->setup.contact;
  SamState         state;

  PetscFunctionBegin;
  if (s->life) {
    PetscCall(SamSimulationLiveCoarse(s, contact, SamLifeGetState(s->life).cycles, &c->life, &c->step));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactGetState(contact, &state));
  for (PetscInt k = 0; k < s->needs.steps; k++) {
    SamControl control = SamHistoryGetStep(s->history, k);

    PetscCall(SamContactTry(contact, &control, &c->step));
    if (c->step.status != SAM_STATUS_CONVERGED) break;
    SamStateJoinNumbers(state, c->sums, PETSC_FALSE);
    PetscCall(SamContactCommit(contact));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a row if there is space; `ratio`: of the widths of the cells. */
static void Add(SamGrid grid, SamGridCheck *check, double ratio, const char name[], const char unit[], PetscInt order,
                double value, double coarse)
{
  const double error = (value - coarse) / (pow(ratio, (double)order) - 1);

  for (PetscInt k = 0; k < check->count; k++)
    if (!strcmp(check->row[k].name, name)) return; /* the number of a cycle precedes that of its last step */
  if (check->count == (PetscInt)(sizeof(check->row) / sizeof(check->row[0]))) return;
  check->row[check->count++] = (SamGridCheckRow){.name         = name,
                                                 .unit         = SamUnitOn(grid, unit),
                                                 .order        = order,
                                                 .value        = value,
                                                 .coarse       = coarse,
                                                 .error        = fabs(error),
                                                 .extrapolated = value + error};
}

/* Compares those numbers above 0 of two states whose error has an order; `sums`: joined values; NULL: sums are
   omitted. */
static PetscErrorCode CompareNumbers(SamSimulation s, SamState state, SamState other, const double sums[], double ratio,
                                     SamGridCheck *check)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SamStateCountNumbers(state); k++) {
    PetscInt              id;
    const SamStateNumber *n    = SamStateNumberOf(state, k, &id);
    const PetscInt        same = n->order ? SamStateFindNumber(other, n->name) : -1;
    const PetscBool       sum  = n->join == SAM_JOIN_SUM ? PETSC_TRUE : PETSC_FALSE;
    const double          fine = sum ? s->sums[id] : *SamStateReadNumbers(state, id);

    if (same >= 0 && fine > 0 && (!sum || sums))
      Add(s->setup.grid, check, ratio, n->name, n->unit, n->order, fine,
          sum ? sums[same] : *SamStateReadNumbers(other, same));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Compares the last steps on both grids: numbers, and the computed loads and displacements. */
static PetscErrorCode Compare(SamSimulation s, const Coarse *coarse, SamGridCheck *check)
{
  const SamStep *step  = &coarse->step;
  const SamGrid  grid  = s->setup.grid;
  const double   cells = (double)grid->nx * (double)grid->ny / ((double)check->n[0] * (double)check->n[1]),
               ratio   = SamGridIsRow(grid) ? cells : sqrt(cells);
  const SamSolution *fine;
  SamState           state, other;

  PetscFunctionBegin;
  if (s->life) {
    state = SamLifeGetSeries(s->life);
    PetscCall(CompareNumbers(s, state, SamLifeGetSeries(coarse->life), NULL, ratio, check));
  }
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(SamContactGetState(coarse->setup.contact, &other));
  PetscCall(CompareNumbers(s, state, other, s->life ? NULL : coarse->sums, ratio, check));
  PetscCall(SamContactGetSolution(s->setup.contact, &fine));
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    const SamComponentName *component = &SamComponentNames[c];

    if (step->control.value[c] == 0) continue;
    if (step->control.force[c])
      Add(grid, check, ratio, component->rigid, component->rigid_unit, 2, (double)fine->rigid[c],
          (double)step->rigid[c]);
    else
      Add(grid, check, ratio, component->load, component->load_unit, 2, (double)fine->load[c], (double)step->load[c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCheckGrid(SamSimulation s)
{
  const SamOptions from   = {s->comm, NULL};
  Coarse           coarse = {.life = NULL};
  SamGridCheck     check  = {.count = 0};
  char             text[SAM_MESSAGE + 64];

  PetscFunctionBegin;
  PetscCall(SamSetupCreateCoarse(&s->setup, &from, &coarse.setup));
  check.n[0] = coarse.setup.grid->nx;
  check.n[1] = coarse.setup.grid->ny;
  PetscCall(SolveAll(s, &coarse));
  if (coarse.step.status == SAM_STATUS_CONVERGED) {
    PetscCall(Compare(s, &coarse, &check));
    PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_GRID_CHECK, .check = &check}));
  } else {
    (void)snprintf(text, sizeof(text), "no errors are estimated: on half the cells %s", coarse.step.message);
    PetscCall(SamSimulationWarn(s, text, "grid_check"));
  }
  PetscCall(SamLifeDestroy(&coarse.life));
  PetscCall(SamSetupDestroy(&coarse.setup));
  PetscFunctionReturn(PETSC_SUCCESS);
}
