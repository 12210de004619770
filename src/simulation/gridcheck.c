/*
  The errors of a grid: the whole history again on half the cells in each direction, as its end depends on the path.

  Between cells of width h and r h a number whose error is of order m differs by (r^m - 1) times the error on the finer
  ones. Loads, displacements and energies are of order 2; areas and peaks are taken for order 1, which they are at edges
  and where cells are counted: elsewhere they converge faster, and the error is estimated too large.
*/
#include "simulationimpl.h"
#include <math.h>

#define DISSIPATED "dissipated_energy"
#define LEAST      4 /* cells in a row, of which half are a grid */

/* A number by its name, and the order of its error. */
typedef struct {
  const char *name, *unit;
  PetscInt    order;
} Number;

static const Number numbers[] = {{"contact_area", "m2", 1}, {"stick_area", "m2", 1}, {"pressure_max", "Pa", 1},
                                 {"shear_max", "Pa", 1},    {"slip_max", "m", 1},    {"stored_energy", "J", 2},
                                 {DISSIPATED, "J", 2}};

PetscErrorCode SamSimulationReadGridCheck(SamSimulation s, const SamOptions *from)
{
  static const char *const without[] = {"-restart", "-friction_file", "-wear_cycles", "-step_rtol", "-rolling"};

  PetscBool set, help;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamOptionsBool(from, "grid_check", "all steps on half the cells too; errors of the last numbers",
                           &s->needs.grid_check, NULL));
  PetscCheck(!s->needs.grid_check ||
               (s->setup.grid->nx >= LEAST && (s->setup.grid->axes == 1 || s->setup.grid->ny >= LEAST)),
             from->comm, SAM_ERR_USER, "-grid_check needs at least %d cells in x and in y (-grid_n)", LEAST);
  for (size_t k = 0; s->needs.grid_check && !help && k < sizeof(without) / sizeof(without[0]); k++) {
    PetscCall(PetscOptionsHasName(NULL, NULL, without[k], &set));
    PetscCheck(!set, from->comm, SAM_ERR_USER, "-grid_check does not work with %s: remove one of them", without[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves the history on a coarser contact; the sum of the frictional work, and the status of the last step. */
static PetscErrorCode SolveAll(SamSimulation s, SamContact contact, double *dissipated, SamStep *step)
{
  PetscReal work;

  PetscFunctionBegin;
  *dissipated = 0;
  for (PetscInt k = 0; k < s->needs.steps; k++) {
    SamControl control;

    PetscCall(SamHistoryGetStep(s->history, k, &control));
    PetscCall(SamContactTry(contact, &control, step));
    if (step->status != SAM_STATUS_CONVERGED) break;
    PetscCall(SamContactCommit(contact));
    PetscCall(SamContactGetNumber(contact, DISSIPATED, &work));
    *dissipated += (double)work;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `ratio`: of the widths of the cells. */
static void Add(SamGrid grid, SamGridCheck *check, double ratio, Number number, double value, double coarse)
{
  const double error = (value - coarse) / (pow(ratio, (double)number.order) - 1);

  check->row[check->count++] = (SamGridCheckRow){.name         = number.name,
                                                 .unit         = SamUnitOn(grid, number.unit),
                                                 .order        = number.order,
                                                 .value        = value,
                                                 .coarse       = coarse,
                                                 .error        = fabs(error),
                                                 .extrapolated = value + error};
}

/* Compares the last steps on both grids: numbers above 0, and of loads and displacements those that are found. */
static PetscErrorCode Compare(SamSimulation s, SamContact coarse, double dissipated, const SamStep *step,
                              SamGridCheck *check)
{
  const SamGrid grid  = s->setup.grid;
  const double  cells = (double)grid->nx * (double)grid->ny / ((double)check->n[0] * (double)check->n[1]),
               ratio  = grid->axes == 1 ? cells : sqrt(cells);
  const SamSolution *fine;

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(numbers) / sizeof(numbers[0]); k++) {
    const PetscBool sum = (PetscBool)!strcmp(numbers[k].name, DISSIPATED);
    PetscReal       value[2];

    PetscCall(SamContactGetNumber(s->setup.contact, numbers[k].name, &value[0]));
    PetscCall(SamContactGetNumber(coarse, numbers[k].name, &value[1]));
    if (sum) value[0] = s->dissipated, value[1] = dissipated;
    if (value[0] > 0) Add(grid, check, ratio, numbers[k], (double)value[0], (double)value[1]);
  }
  PetscCall(SamContactGetSolution(s->setup.contact, &fine));
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    const SamComponentName *name = &SamComponentNames[c];

    if (step->control.value[c] == 0) continue;
    if (step->control.force[c])
      Add(grid, check, ratio, (Number){name->rigid, name->rigid_unit, 2}, (double)fine->rigid[c],
          (double)step->rigid[c]);
    else
      Add(grid, check, ratio, (Number){name->load, name->load_unit, 2}, (double)fine->load[c], (double)step->load[c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationCheckGrid(SamSimulation s)
{
  const SamOptions from = {s->comm, NULL};
  SamSetup         coarse;
  SamGridCheck     check = {.count = 0};
  SamStep          step;
  double           dissipated;
  char             text[SAM_MESSAGE + 64];

  PetscFunctionBegin;
  PetscCall(SamSetupCreateCoarse(&s->setup, &from, &coarse));
  check.n[0] = coarse.grid->nx;
  check.n[1] = coarse.grid->ny;
  PetscCall(SolveAll(s, coarse.contact, &dissipated, &step));
  if (step.status == SAM_STATUS_CONVERGED) {
    PetscCall(Compare(s, coarse.contact, dissipated, &step, &check));
    PetscCall(SamSimulationTell(s, &(SamSimulationNews){.kind = SAM_NEWS_GRID_CHECK, .check = &check}));
  } else {
    (void)snprintf(text, sizeof(text), "no errors are estimated: on half the cells %s", step.message);
    PetscCall(SamSimulationWarn(s, text, "grid_check"));
  }
  PetscCall(SamSetupDestroy(&coarse));
  PetscFunctionReturn(PETSC_SUCCESS);
}
