/* What a run says about its steps. */
#include "../base/baseimpl.h"
#include <petsam/summary.h>

static PetscErrorCode ViewBalance(const SamBalance *balance, const char title[], PetscViewer viewer)
{
  static const char *const load_units[2][3]  = {{"N", "N m", "N m"}, {"N", "N", "N m"}};
  static const char *const rigid_units[2][3] = {{"m", "rad", "rad"}, {"m", "m", "rad"}};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 3; k++) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %-7s %14.7g %-3s  %-6s %14.7g %-3s  (%s given)\n", k ? "" : title, SamLoadNames[balance->kind][k], (double)balance->load[k], load_units[balance->kind][k], SamRigidNames[balance->kind][k],
                                     (double)balance->rigid[k], rigid_units[balance->kind][k], balance->force[k] ? "load" : "displacement"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepView(const SamStep *s, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(ViewBalance(&s->normal, "normal", viewer));
  PetscCall(ViewBalance(&s->tangential, "tangential", viewer));
  if (s->status != SAM_STATUS_NO_EQUILIBRIUM) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  contact %.6g m2, stick %.6g m2, dissipated %.6g J\n", "areas", (double)s->contact_area, (double)s->stick_area, (double)s->dissipated_energy));
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  normal %" PetscInt_FMT " (%" PetscInt_FMT " products), tangential %" PetscInt_FMT " (%" PetscInt_FMT " products)", "iterations", s->normal_iterations, s->normal_applies, s->tangential_iterations, s->tangential_applies));
    if (s->coupling_iterations > 1) PetscCall(PetscViewerASCIIPrintf(viewer, ", coupling %" PetscInt_FMT, s->coupling_iterations));
    PetscCall(PetscViewerASCIIPrintf(viewer, "\n  %-10s  normal %.2e, tangential %.2e, equilibrium %.2e, cone %.2e\n", "check", (double)s->check.normal, (double)s->check.tangential, (double)s->check.equilibrium, (double)s->check.cone));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepViewHeading(PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "%5s %11s %11s %11s %11s %11s %11s %10s %10s %5s %5s %8s %8s\n", "step", "time", "load_n", "load_tx", "load_ty", "load_mz", "disp_x", "contact/m2", "stick/m2", "its n", "its t", "check n", "check t"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepViewLine(const SamStep *s, PetscInt number, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "%5" PetscInt_FMT " %11.4g %11.4g %11.4g %11.4g %11.4g %11.4g %10.4g %10.4g %5" PetscInt_FMT " %5" PetscInt_FMT " %8.1e %8.1e\n", number, (double)s->time, (double)s->normal.load[0], (double)s->tangential.load[0], (double)s->tangential.load[1],
                                   (double)s->tangential.load[2], (double)s->tangential.rigid[0], (double)s->contact_area, (double)s->stick_area, s->normal_iterations, s->tangential_iterations, (double)s->check.normal, (double)s->check.tangential));
  PetscFunctionReturn(PETSC_SUCCESS);
}
