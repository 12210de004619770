/* Tolerances, options, monitors and counts of a solver. */
#include <petsam/private/solverimpl.h>

PetscErrorCode SamSolverMonitorSet(SamSolver *s, SamSolverMonitor monitor, void *context)
{
  PetscFunctionBegin;
  PetscCheck(s->monitors < SAM_MONITORS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "At most %d monitors",
             SAM_MONITORS);
  s->monitor[s->monitors]           = monitor;
  s->monitor_context[s->monitors++] = context;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MonitorError(void *owner, PetscInt it, PetscReal error, void *context)
{
  const SamSolver *s = (const SamSolver *)context;

  PetscFunctionBegin;
  (void)owner;
  PetscCall(PetscPrintf(s->comm, "%5" PetscInt_FMT " %s %s error %.6e\n", it, s->kind, s->type, (double)error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverSetFromOptions(SamSolver *s, const char types[], char type[], size_t size, PetscBool *set_type)
{
  char             prefix[96], title[48];
  PetscBool        monitor = s->monitor_error, ignored;
  const SamOptions from    = {s->comm, prefix};

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s%s_", s->prefix, s->kind));
  PetscCall(PetscSNPrintf(title, sizeof(title), "Solver of the %s problem", s->kind));
  PetscCall(SamOptionsHeading(&from, title));
  PetscCall(PetscStrncpy(type, s->type, size));
  PetscCall(SamOptionsString(&from, "type", types, type, size, set_type));
  PetscCall(SamOptionsReal(&from, "rtol", s->error_help, SAM_RANGE_POSITIVE, &s->rtol, NULL));
  PetscCall(
    SamOptionsInt(&from, "max_it", "iterations on the finest grid, 0: the type's default", 0, &s->max_it, NULL));
  PetscCall(SamOptionsInt(&from, "levels", "nested grids, 0: the type's default", 0, &s->levels, NULL));
  PetscCall(SamOptionsBool(&from, "monitor", "print the error after each iteration", &monitor, NULL));
  PetscCall(SamOptionsBool(&from, "error_if_not_converged", "stop with an error", &s->error_if_not_converged, NULL));
  PetscCall(SamOptionsHasViewer(&from, "converged_reason", "print why the solver stopped", &ignored));
  PetscCall(SamOptionsHasViewer(&from, "view", "print the solver's settings", &ignored));
  if (monitor && !s->monitor_error) PetscCall(SamSolverMonitorSet(s, MonitorError, s));
  s->monitor_error = monitor;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamSolverMaxIterations(const SamSolver *s)
{
  return s->max_it ? s->max_it : s->default_max_it;
}

PetscInt SamSolverLevels(const SamSolver *s)
{
  return s->levels ? s->levels : s->default_levels;
}

PetscErrorCode SamSolverView(const SamSolver *s, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "Solver of the %s problem: type %s\n", s->kind, s->type));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  rtol %g, max_it %" PetscInt_FMT ", nested grids ", (double)s->rtol,
                                   SamSolverMaxIterations(s)));
  if (SamSolverLevels(s) == PETSC_MAX_INT)
    PetscCall(PetscViewerASCIIPrintf(viewer, "as many as the grid allows\n"));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT "\n", SamSolverLevels(s)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolverViewFromOptions(const SamSolver *s, PetscBool converged, const char reason[])
{
  PetscViewer       viewer;
  PetscViewerFormat format;
  PetscBool         set;
  char              prefix[96];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s%s_", s->prefix, s->kind));
  PetscCall(SamGetViewer(s->comm, prefix, "-view", &viewer, &format, &set));
  if (set) {
    PetscCall(SamSolverView(s, viewer));
    PetscCall(PetscViewerDestroy(&viewer));
  }
  PetscCall(SamGetViewer(s->comm, prefix, "-converged_reason", &viewer, &format, &set));
  if (set) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "The %s solve %s due to %s iterations %" PetscInt_FMT "\n", s->kind,
                                     converged ? "converged" : "did not converge", reason, s->iterations));
    PetscCall(PetscViewerDestroy(&viewer));
  }
  PetscCheck(converged || !s->error_if_not_converged, s->comm, PETSC_ERR_NOT_CONVERGED,
             "The %s solve did not converge due to %s", s->kind, reason);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamSolverStart(SamSolver *s)
{
  s->iterations = s->applies = s->preconditions = 0;
  s->error                                      = 0;
}

PetscErrorCode SamSolverCallMonitors(SamSolver *s, PetscReal error)
{
  PetscFunctionBegin;
  for (PetscInt m = 0; m < s->monitors; m++)
    PetscCall(s->monitor[m](s->owner, s->iterations, error, s->monitor_context[m]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
