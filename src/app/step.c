/* Prints a load step: in full, and as a line of a table. */
#include "reportimpl.h"

static PetscErrorCode ViewComponent(const SamStep *s, SamComponent c, const char title[], PetscViewer viewer)
{
  const SamComponentName *name = &SamComponentNames[c];

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %-7s %14.7g %-3s  %-6s %14.7g %-3s  (%s given)\n", title,
                                   name->load, (double)s->load[c], name->load_unit, name->rigid, (double)s->rigid[c],
                                   name->rigid_unit, s->control.force[c] ? "load" : "displacement"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepView(const SamStep *s, PetscViewer viewer)
{
  static const SamComponent order[] = {SAM_COMPONENT_N,  SAM_COMPONENT_MX, SAM_COMPONENT_MY,
                                       SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_MZ};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    PetscCall(ViewComponent(s, order[k], k == 0 ? "normal" : k == 3 ? "tangential" : "", viewer));
  if (s->status != SAM_STATUS_NO_EQUILIBRIUM) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  contact %.6g m2, stick %.6g m2, dissipated %.6g J\n", "areas",
                                     (double)s->contact_area, (double)s->stick_area, (double)s->dissipated_energy));
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  pressure %.6g Pa, shear %.6g Pa, slip %.6g m\n", "largest",
                                     (double)s->pressure_max, (double)s->shear_max, (double)s->slip_max));
    if (!isnan(s->spots))
      PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %.0f, contact on %.4g %% of the grid, mean gap %.6g m\n",
                                       "spots", (double)s->spots, 100 * (double)s->contact_fraction,
                                       (double)s->gap_mean));
    if (s->plastic_depth_max > 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %.6g m2 at the limit, depth up to %.6g m, work %.6g J\n",
                                       "plastic", (double)s->plastic_area, (double)s->plastic_depth_max,
                                       (double)s->plastic_energy));
    PetscCall(PetscViewerASCIIPrintf(viewer,
                                     "  %-10s  normal %" PetscInt_FMT " (%" PetscInt_FMT
                                     " products), tangential %" PetscInt_FMT " (%" PetscInt_FMT " products)",
                                     "iterations", s->normal_iterations, s->normal_applies, s->tangential_iterations,
                                     s->tangential_applies));
    if (s->coupling_iterations > 1)
      PetscCall(PetscViewerASCIIPrintf(viewer, ", coupling %" PetscInt_FMT, s->coupling_iterations));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n  %-10s  normal %.2e, tangential %.2e, equilibrium %.2e, cone %.2e\n",
                                     "check", (double)s->check.normal, (double)s->check.tangential,
                                     (double)s->check.equilibrium, (double)s->check.cone));
  }
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

PetscErrorCode SamStepViewLine(const SamStep *s, PetscInt number, double seconds, double left, PetscViewer viewer)
{
  const PetscReal *l = s->load;
  char             duration[32];

  PetscFunctionBegin;
  SamReportDuration(left, duration, sizeof(duration));
  PetscCall(PetscViewerASCIIPrintf(
    viewer,
    "%6" PetscInt_FMT " %10.4g %10.4g %10.4g %10.4g %10.4g %10.4g %10.4g %10.4g %9.3g %9.3g %9.3g %9.3g %4" PetscInt_FMT
    " %4" PetscInt_FMT " %7.1e %7.1e %8.2f %9s\n",
    number, (double)s->control.time, (double)l[SAM_COMPONENT_N], (double)l[SAM_COMPONENT_TX],
    (double)l[SAM_COMPONENT_TY], (double)l[SAM_COMPONENT_MX], (double)l[SAM_COMPONENT_MY], (double)l[SAM_COMPONENT_MZ],
    (double)s->contact_area, (double)s->stick_area, (double)s->pressure_max, (double)s->shear_max, (double)s->slip_max,
    s->normal_iterations, s->tangential_iterations, (double)s->check.normal, (double)s->check.tangential, seconds,
    duration));
  PetscFunctionReturn(PETSC_SUCCESS);
}
