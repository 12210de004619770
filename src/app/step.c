/* Prints a load step: in full, and as a line of a table. */
#include "report.h"

static PetscErrorCode ViewComponent(const SamStep *s, SamComponent c, const char title[], PetscViewer viewer)
{
  const SamComponentName *name = &SamComponentNames[c];

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %-7s %14.7g %-3s  %-6s %14.7g %-3s  (%s given)\n", title,
                                   name->load, (double)s->load[c], name->load_unit, name->rigid, (double)s->rigid[c],
                                   name->rigid_unit, s->control.force[c] ? "load" : "displacement"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A number of the contact's last step; NaN where there is none of that name. */
static double Get(SamContact contact, const char name[])
{
  SamState state;
  PetscInt id;

  if (SamContactGetState(contact, &state)) return NAN;
  id = SamStateFindNumber(state, name);
  return id < 0 ? NAN : *SamStateReadNumbers(state, id);
}

static PetscErrorCode ViewSolution(const SamStep *s, SamContact c, PetscViewer viewer)
{
  const double passes = Get(c, "coupling_iterations");

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  contact %.6g m2, stick %.6g m2, dissipated %.6g J\n", "areas",
                                   Get(c, "contact_area"), Get(c, "stick_area"), Get(c, "dissipated_energy")));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  pressure %.6g Pa, shear %.6g Pa, slip %.6g m\n", "largest",
                                   Get(c, "pressure_max"), Get(c, "shear_max"), Get(c, "slip_max")));
  if (!isnan(Get(c, "contact_spots")))
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %.0f, contact on %.4g %% of the grid, mean gap %.6g m\n",
                                     "spots", Get(c, "contact_spots"), 100 * Get(c, "contact_fraction"),
                                     Get(c, "gap_mean")));
  PetscCall(SamContactViewLaws(c, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  normal %.0f (%.0f products), tangential %.0f (%.0f products)",
                                   "iterations", Get(c, "normal_iterations"), Get(c, "normal_applies"),
                                   Get(c, "tangential_iterations"), Get(c, "tangential_applies")));
  if (passes > 1) PetscCall(PetscViewerASCIIPrintf(viewer, ", coupling %.0f", passes));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n  %-10s  normal %.2e, tangential %.2e, equilibrium %.2e, cone %.2e\n",
                                   "check", (double)s->check.normal, (double)s->check.tangential,
                                   (double)s->check.equilibrium, (double)s->check.cone));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepView(const SamStep *s, SamContact contact, PetscViewer viewer)
{
  static const SamComponent order[] = {SAM_COMPONENT_N,  SAM_COMPONENT_MX, SAM_COMPONENT_MY,
                                       SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_MZ};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    PetscCall(ViewComponent(s, order[k], k == 0 ? "normal" : k == 3 ? "tangential" : "", viewer));
  if (s->status != SAM_STATUS_NO_EQUILIBRIUM) PetscCall(ViewSolution(s, contact, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamReportDuration(double seconds, char text[], size_t size)
{
  const long total = (long)(seconds + 0.5);

  snprintf(text, size, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
}

PetscErrorCode SamStepViewHeading(PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "%6s %10s %10s %10s %10s %10s %10s %10s %10s %9s %9s %9s %9s %4s %4s %7s %7s %8s %9s\n", "step", "time/s",
    "N/N", "Tx/N", "Ty/N", "Mx/Nm", "My/Nm", "Mz/Nm", "contact/m2", "stick/m2", "p max/Pa", "q max/Pa", "slip/m",
    "it n", "it t", "res n", "res t", "s", "left"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepViewLine(const SamStep *s, SamContact c, PetscInt number, double seconds, double left,
                               PetscViewer viewer)
{
  const PetscReal *l = s->load;
  char             duration[32];

  PetscFunctionBegin;
  SamReportDuration(left, duration, sizeof(duration));
  PetscCall(PetscViewerASCIIPrintf(
    viewer,
    "%6" PetscInt_FMT
    " %10.4g %10.4g %10.4g %10.4g %10.4g %10.4g %10.4g %10.4g %9.3g %9.3g %9.3g %9.3g %4.0f %4.0f %7.1e %7.1e %8.2f "
    "%9s\n",
    number, (double)s->control.time, (double)l[SAM_COMPONENT_N], (double)l[SAM_COMPONENT_TX],
    (double)l[SAM_COMPONENT_TY], (double)l[SAM_COMPONENT_MX], (double)l[SAM_COMPONENT_MY], (double)l[SAM_COMPONENT_MZ],
    Get(c, "contact_area"), Get(c, "stick_area"), Get(c, "pressure_max"), Get(c, "shear_max"), Get(c, "slip_max"),
    Get(c, "normal_iterations"), Get(c, "tangential_iterations"), (double)s->check.normal, (double)s->check.tangential,
    seconds, duration));
  PetscFunctionReturn(PETSC_SUCCESS);
}
