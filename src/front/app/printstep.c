/* Prints a load step: in full, and as a line of a table. */
#include "report.h"
#include <petsam/private/motionimpl.h>
#include <petsam/private/contact.h>
#include <petsam/private/state.h>

#define ROUNDING 1e-11 /* part of the size of a number's kind below which the number is rounding, and printed as 0 */
#define REST     1e-9  /* the same for loads and displacements, where solvers' tolerances leave more in place of 0 */
#define SLIGHTLY 1e-6  /* the same for energies below 0 */
#define WIDTH    120   /* of a line of the table */

static SamState StateOf(SamContact contact)
{
  SamState state;

  return SamContactGetState(contact, &state) ? NULL : state;
}

static double Get(SamContact contact, const char name[])
{
  return SamReportNumber(StateOf(contact), name);
}

/* ---- rounding ---- */

/* Sizes of forces and moments, and of translations and rotations; moments and rotations by their effect at the
   contact's border */
typedef struct {
  double load[2], rigid[2];
} Sizes;

static Sizes GetSizes(const SamStep *s, SamContact contact)
{
  const double area = Get(contact, "contact_area"), reach = area > 0 ? sqrt(area / PETSC_PI) : 0;
  Sizes        sizes = {{0, 0}, {0, 0}};

  for (int c = 0; c < SAM_COMPONENTS; c++) {
    const int k = c >= SAM_COMPONENT_MX;

    sizes.load[k]  = PetscMax(sizes.load[k], fabs((double)s->load[c]));
    sizes.rigid[k] = PetscMax(sizes.rigid[k], fabs((double)s->rigid[c]));
  }
  sizes.load[1] = PetscMax(sizes.load[1], sizes.load[0] * reach);
  if (reach > 0) sizes.rigid[1] = PetscMax(sizes.rigid[1], sizes.rigid[0] / reach);
  return sizes;
}

static double Clean(double value, double least)
{
  return fabs(value) <= least ? 0 : value;
}

/*
  Returns an energy as it is printed: one slightly below 0 is that of the rounding of slips, under a bound that may be
  far above all tractions.
*/
static double CleanEnergy(double value, double size)
{
  return Clean(value, (value < 0 ? SLIGHTLY : ROUNDING) * size);
}

/* Returns a load or displacement as it is printed: rounding becomes 0, unless one of the two is given. */
static double Rounded(const SamStep *s, PetscInt c, const PetscReal values[], const double size[2])
{
  return Clean((double)values[c], s->control.value[c] != 0 ? 0 : REST * size[c >= SAM_COMPONENT_MX]);
}

/* ---- in full ---- */

/* Prints the iterations of the solvers. */
static PetscErrorCode ViewIterations(SamContact c, PetscViewer viewer)
{
  const double passes = Get(c, "coupling_iterations");

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  %-10s  normal %.0f (%.0f applications), tangential %.0f (%.0f applications)",
                                   "iterations", Get(c, "normal_iterations"), Get(c, "normal_applies"),
                                   Get(c, "tangential_iterations"), Get(c, "tangential_applies")));
  if (passes > 1) PetscCall(PetscViewerASCIIPrintf(viewer, ", coupling %.0f", passes));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepViewHalves(SamContact c, const char after[], PetscViewer viewer)
{
  static const char *const of[2] = {"contact", "stick"};
  const PetscInt           axes  = SamContactGetGrid(c)->axes;

  PetscFunctionBegin;
  if (!(Get(c, "contact_area") > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  ", "half width"));
  for (int k = 0; k < 2; k++) {
    char x[32], y[32];

    (void)snprintf(x, sizeof(x), "%s_half_x", of[k]);
    (void)snprintf(y, sizeof(y), "%s_half_y", of[k]);
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s %.6g m", k ? "; " : "", of[k], Get(c, x)));
    if (axes > 1) PetscCall(PetscViewerASCIIPrintf(viewer, " along x, %.6g m along y", Get(c, y)));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n", after));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewSolution(const SamStep *s, SamContact c, const Sizes *sizes, PetscViewer viewer)
{
  const SamMotion motion = SamContactGetMotion(c);
  const double    move = ROUNDING * sizes->rigid[0], work = sizes->load[0] * sizes->rigid[0];
  const double    slip  = Clean(Get(c, SamContactNameOf(c, "slip_max")), move); /* NaN without friction */
  const SamState  state = StateOf(c);

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  contact %.6g %s, stick %.6g %s, dissipated %.6g %s\n", "areas",
                                   Get(c, "contact_area"), SamStateUnitOf(state, "contact_area"), Get(c, "stick_area"),
                                   SamStateUnitOf(state, "stick_area"), CleanEnergy(Get(c, motion->work), work),
                                   SamStateUnitOf(state, motion->work)));
  PetscCall(SamStepViewHalves(c, "", viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  pressure %.6g Pa, shear %.6g Pa", "maximum",
                                   Get(c, "pressure_max"), Get(c, "shear_max")));
  if (!isnan(slip)) PetscCall(PetscViewerASCIIPrintf(viewer, ", slip %.6g%s", slip, motion->slip_unit));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  if (!isnan(Get(c, "contact_spots")))
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %.0f, contact on %.4g %% of the grid, mean gap %.6g m\n",
                                     "spots", Get(c, "contact_spots"), 100 * Get(c, "contact_fraction"),
                                     Get(c, "gap_mean")));
  PetscCall(SamContactPrintLaws(c, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  normal %.2e, tangential %.2e, equilibrium %.2e, cone %.2e\n",
                                   "check", (double)s->check.normal, (double)s->check.tangential,
                                   (double)s->check.equilibrium, (double)s->check.cone));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStepView(const SamStep *s, SamContact contact, PetscBool profile, PetscViewer viewer)
{
  static const SamComponent order[]         = {SAM_COMPONENT_N,  SAM_COMPONENT_MX, SAM_COMPONENT_MY,
                                               SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_MZ};
  static const char *const  given[SAM_WAYS] = {"load", "displacement", "creepage"};
  const Sizes               sizes           = GetSizes(s, contact);
  const SamGrid             grid            = SamContactGetGrid(contact);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    const PetscInt          c     = order[k];
    const SamComponentName *name  = &SamComponentNames[c];
    const SamMotionName     rigid = SamContactRigidName(contact, c);
    const PetscBool         creep = rigid.name == name->creep, load = s->control.force[c];
    char                    fine[96] = "";

    if (name->axes > grid->axes) continue;
    if (creep) {
      double value;

      (void)snprintf(fine, sizeof(fine), "%s_extrapolated", load ? name->creep : name->load);
      value   = Clean(Get(contact, fine), 1e3 * REST * (load ? sizes.rigid : sizes.load)[c >= SAM_COMPONENT_MX]);
      fine[0] = '\0';
      if (!isnan(value)) /* a contact of few cells has none */
        (void)snprintf(fine, sizeof(fine), "; fine grid: %s %.7g", load ? name->creep : name->load, value);
    }
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %-7s %14.7g %-*s  %-6s %14.7g %-3s  (%s given%s)\n",
                                     k == 0   ? "normal"
                                     : k == 3 ? "tangential"
                                              : "",
                                     name->load, Rounded(s, c, s->load, sizes.load),
                                     (int)strlen(SamUnitOn(grid, "N m")), SamUnitOn(grid, name->load_unit), rigid.name,
                                     Rounded(s, c, s->rigid, sizes.rigid), strcmp(rigid.unit, "1") ? rigid.unit : "",
                                     given[SamControlWay(&s->control, c)], fine));
  }
  if (s->status == SAM_STATUS_NO_EQUILIBRIUM) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ViewSolution(s, contact, &sizes, viewer));
  if (profile) PetscCall(ViewIterations(contact, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- as a line ---- */

void SamReportDuration(double seconds, char text[], size_t size)
{
  const long total = (long)(seconds + 0.5);

  snprintf(text, size, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
}

enum { STEP, TIME, LOADS, CONTACT = LOADS + SAM_COMPONENTS, SLIP = CONTACT + 4, RESIDUAL = CONTACT + 7, SECONDS, LEFT };
static const SamReportColumn columns[SAM_REPORT_COLUMNS] = {{"step", NULL, "", 5, 9, 0},
                                                            {"time/s", NULL, "", 10, 4, 0},
                                                            {"N", NULL, "load_n", 11, 4, 0},
                                                            {"Tx", NULL, "load_tx", 11, 4, 0},
                                                            {"Ty", NULL, "load_ty", 11, 4, 0},
                                                            {"Mx", NULL, "load_mx", 11, 4, 0},
                                                            {"My", NULL, "load_my", 11, 4, 0},
                                                            {"Mz", NULL, "load_mz", 11, 4, 0},
                                                            {"contact", NULL, "contact_area", 11, 4, 0},
                                                            {"stick", NULL, "stick_area", 10, 3, 5},
                                                            {"p max", NULL, "pressure_max", 9, 3, 6},
                                                            {"q max", NULL, "shear_max", 9, 3, 3},
                                                            {"slip", NULL, "slip_max", 9, 3, 4},
                                                            {"it n", NULL, "normal_iterations", 5, 4, 2},
                                                            {"it t", NULL, "tangential_iterations", 5, 4, 1},
                                                            {"residual", NULL, "", 9, 0, 0},
                                                            {"s", NULL, "", 7, 0, 0},
                                                            {"left", NULL, "", 9, 0, 0}};

void SamReportChooseColumns(SamReport r, const PetscBool loads[SAM_COMPONENTS])
{
  int width = 0;

  for (int k = 0; k < SAM_REPORT_COLUMNS; k++) {
    r->shown[k] = k <= LOADS + SAM_COMPONENT_TX || k >= CONTACT || loads[k - LOADS];
    width += r->shown[k] ? columns[k].width : 0;
  }
  for (int order = 1; width > WIDTH; order++)
    for (int k = 0; k < SAM_REPORT_COLUMNS; k++) {
      if (columns[k].order != order) continue;
      r->shown[k] = PETSC_FALSE;
      width -= columns[k].width;
    }
}

/* Returns the number in column k of a step's line. */
static double ValueOf(SamReport r, const SamStep *s, SamContact contact, int k)
{
  const Sizes sizes = GetSizes(s, contact);

  if (k == STEP) return (double)r->number + 1;
  if (k == TIME) return (double)s->control.time;
  if (k < CONTACT) return Rounded(s, k - LOADS, s->load, sizes.load);
  if (k == RESIDUAL) return (double)SamLarger(s->check.normal, s->check.tangential);
  return Clean(Get(contact, SamContactNameOf(contact, columns[k].number)), k == SLIP ? ROUNDING * sizes.rigid[0] : 0);
}

PetscErrorCode SamReportStepLine(SamReport r, const SamStep *s, SamContact contact, double seconds, double left)
{
  const char   *slip                      = SamContactGetMotion(contact)->slip_heading;
  SamReportCell cells[SAM_REPORT_COLUMNS] = {""};

  PetscFunctionBegin;
  for (int k = 0; k < SAM_REPORT_COLUMNS && r->done == 1; k++)
    if (r->shown[k]) SamReportHeading(SamContactGetGrid(contact), StateOf(contact), &columns[k], cells[k]);
  if (r->done == 1 && r->shown[SLIP] && slip) (void)snprintf(cells[SLIP], sizeof(cells[SLIP]), "%s", slip);
  if (r->done == 1) PetscCall(SamReportLine(r, SAM_REPORT_COLUMNS, columns, cells));
  for (int k = 0; k < SECONDS; k++)
    if (r->shown[k]) SamReportValue(&columns[k], ValueOf(r, s, contact, k), cells[k]);
  SamReportSeconds(seconds, cells[SECONDS]);
  SamReportDuration(left, cells[LEFT], sizeof(cells[LEFT]));
  PetscCall(SamReportLine(r, SAM_REPORT_COLUMNS, columns, cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}
