/* Options and printout of a solver. */
#include <petsam/private/solverimpl.h>
#include <petsam/private/solver.h>
#include <string.h>

static PetscErrorCode SetTypeFromOptions(SamSolver s, const SamOptions *from)
{
  char      type[sizeof(s->type)], types[256];
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(type, s->type, sizeof(type)));
  PetscCall(SamTypesList(s->kind->types, types, sizeof(types)));
  PetscCall(SamTypesOption(s->kind->types, from, "type", types, type, sizeof(type), &set));
  if (set) PetscCall(SamSolverSetType(s, type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MonitorError(SamSolver s, PetscInt it, PetscReal error, void *context)
{
  PetscFunctionBegin;
  (void)context;
  PetscCall(PetscPrintf(s->comm, "%5" PetscInt_FMT " %s %s error %.6e\n", it, s->kind->name, s->type, (double)error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the options of the other types for the help, which lists the options of all types. */
static PetscErrorCode DescribeOthers(SamSolver s, const SamOptions *from)
{
  char         type[sizeof(s->type)];
  const char **types;
  int          count;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(type, s->type, sizeof(type)));
  PetscCall(SamTypesGet(s->kind->types, &types, &count));
  for (int k = 0; k < count; k++) {
    if (!strcmp(types[k], type)) continue;
    PetscCall(SamSolverSetType(s, types[k]));
    if (s->ops.setfromoptions) PetscCall(s->ops.setfromoptions(s, from));
  }
  PetscCall(SamSolverSetType(s, type));
  PetscCall(PetscFree(types));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest tolerance: at it, areas of Cattaneo's contact are wrong by 2 %, its energy by 3 %; at 0.9 both are twice as
   large, or 0. */
#define LOOSEST 0.01

/* Values that options set, except the type */
typedef struct {
  PetscReal rtol;
  PetscInt  max_it, levels;
  PetscBool monitor, error;
} Settings;

PetscErrorCode SamSolverSetFromOptions(SamSolver s)
{
  SamOptions   from;
  Settings     set;
  SamOptionRow rows[] = {
    {"rtol", NULL, SAM_OPTION_REAL, offsetof(Settings, rtol), .range = SAM_RANGE_PART, .loosest = LOOSEST,
     .beyond = "areas and the dissipated energy are wrong by per cents"},
    {"max_it", "maximum iterations on the finest grid; 0: default of the type", SAM_OPTION_INT,
     .member = offsetof(Settings, max_it)},
    {"levels", "number of nested grids; 0: default of the type", SAM_OPTION_INT, .member = offsetof(Settings, levels)},
    {"monitor", "print the error after each iteration", SAM_OPTION_BOOL, .member = offsetof(Settings, monitor)},
    {"error_if_not_converged", "raise an error without convergence", SAM_OPTION_BOOL,
     .member = offsetof(Settings, error)},
    {"converged_reason", "print the reason for stopping", SAM_OPTION_VIEWER, .member = 0},
    {"view", "print the solver's settings", SAM_OPTION_VIEWER, .member = 0}};
  char title[64];

  PetscFunctionBegin;
  SamValidHandle(s, SamSolver, 1);
  from         = (SamOptions){s->comm, s->prefix};
  set          = (Settings){s->rtol, s->max_it, s->levels, s->monitor_error, s->error_if_not_converged};
  rows[0].text = s->kind->error_help;
  PetscCall(PetscSNPrintf(title, sizeof(title), "Solver of the %s problem", s->kind->name));
  PetscCall(SamOptionsHeading(&from, title));
  PetscCall(SetTypeFromOptions(s, &from));
  PetscCall(SamOptionsRead(&from, NULL, SAM_OPTION_ROWS(rows), &set, NULL));
  PetscCall(SamSolverSetTolerances(s, set.rtol, set.max_it));
  PetscCall(SamSolverSetLevels(s, set.levels));
  PetscCall(SamSolverSetErrorIfNotConverged(s, set.error));
  if (set.monitor && !s->monitor_error) PetscCall(SamSolverMonitorSet(s, MonitorError, NULL));
  s->monitor_error = set.monitor;
  if (SamPrintHelp()) PetscCall(DescribeOthers(s, &from));
  if (s->ops.setfromoptions) PetscCall(s->ops.setfromoptions(s, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View(SamSolver s, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "Solver of the %s problem: type %s\n", s->kind->name, s->type));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  rtol %.6g, max_it %" PetscInt_FMT ", nested grids ", (double)s->rtol,
                                   SamSolverMaxIterations(s)));
  if (SamSolverLevels(s) == PETSC_MAX_INT)
    PetscCall(PetscViewerASCIIPrintf(viewer, "as many as the grid allows\n"));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT "\n", SamSolverLevels(s)));
  if (s->ops.view) PetscCall(s->ops.view(s, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverViewFromOptions(SamSolver s)
{
  PetscViewer       viewer;
  PetscViewerFormat format;
  PetscBool         set;

  PetscFunctionBegin;
  PetscCall(SamGetViewer(s->comm, s->prefix, "-view", &viewer, &format, &set));
  if (set) PetscCall(View(s, viewer));
  if (set) PetscCall(PetscViewerDestroy(&viewer));
  PetscCall(SamGetViewer(s->comm, s->prefix, "-converged_reason", &viewer, &format, &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscViewerASCIIPrintf(viewer, "The %s solve %s due to %s iterations %" PetscInt_FMT "\n", s->kind->name,
                                   s->reason > 0 ? "converged" : "did not converge", SamSolverReasonName(s->reason),
                                   s->iterations));
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
