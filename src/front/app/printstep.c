/* Prints a load step: in full, and as a line of a table. */
#include "report.h"
#include <petsam/private/motionimpl.h>

#define ROUNDING 1e-11 /* a part of the size of a number's kind that is rounding, and is printed as 0 */
#define REST     1e-9  /* the same of loads and displacements: solvers' tolerances leave more where symmetry has 0 */
#define WIDTH    120   /* of a line of the table */

/* Returns a number of the contact's last step; NaN where there is none of that name. */
static double Get(SamContact contact, const char name[])
{
  SamState state;
  PetscInt id;

  if (SamContactGetState(contact, &state)) return NAN;
  id = SamStateFindNumber(state, name);
  return id < 0 ? NAN : *SamStateReadNumbers(state, id);
}

/* Returns the name of a number in the contact's motion. */
static const char *NameOf(SamContact contact, const char usual[])
{
  const SamMotionName *name = SamMotionFindName(SamContactGetMotion(contact), usual);

  return name ? name->name : usual;
}

/* ---- what is zero to rounding ---- */

/* Sizes of forces and moments, translations and rotations; of the latter as they act at the border of the contact. */
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

/* Returns a load or displacement as it is printed: with its rounding if one of the two is given, and not as 0. */
static double Rounded(const SamStep *s, PetscInt c, const PetscReal values[], const double size[2])
{
  return Clean((double)values[c], s->control.value[c] != 0 ? 0 : REST * size[c >= SAM_COMPONENT_MX]);
}

/* ---- in full ---- */

static PetscErrorCode ViewSolution(const SamStep *s, SamContact c, const Sizes *sizes, PetscViewer viewer)
{
  const SamMotion motion = SamContactGetMotion(c);
  const double  passes = Get(c, "coupling_iterations"), move = ROUNDING * sizes->rigid[0], work = sizes->load[0] * move;
  const SamGrid grid = SamContactGetGrid(c);

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  contact %.6g %s, stick %.6g %s, dissipated %.6g %s\n", "areas",
                                   Get(c, "contact_area"), SamUnitOn(grid, "m2"), Get(c, "stick_area"),
                                   SamUnitOn(grid, "m2"), Clean(Get(c, motion->work), work),
                                   SamUnitOn(grid, motion->work_unit)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  pressure %.6g Pa, shear %.6g Pa, slip %.6g%s\n", "maximum",
                                   Get(c, "pressure_max"), Get(c, "shear_max"),
                                   Clean(Get(c, NameOf(c, "slip_max")), move), motion->slip_unit));
  if (!isnan(Get(c, "contact_spots")))
    PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %.0f, contact on %.4g %% of the grid, mean gap %.6g m\n",
                                     "spots", Get(c, "contact_spots"), 100 * Get(c, "contact_fraction"),
                                     Get(c, "gap_mean")));
  PetscCall(SamContactPrintLaws(c, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  %-10s  normal %.0f (%.0f applications), tangential %.0f (%.0f applications)",
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
  static const SamComponent order[]         = {SAM_COMPONENT_N,  SAM_COMPONENT_MX, SAM_COMPONENT_MY,
                                               SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_MZ};
  static const char *const  given[SAM_WAYS] = {"load", "displacement", "creepage"};
  const Sizes               sizes           = GetSizes(s, contact);
  const SamGrid             grid            = SamContactGetGrid(contact);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    const PetscInt          c     = order[k];
    const SamComponentName *name  = &SamComponentNames[c];
    const SamMotionName     rigid = SamMotionRigidName(SamContactGetMotion(contact), c);
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
  if (s->status != SAM_STATUS_NO_EQUILIBRIUM) PetscCall(ViewSolution(s, contact, &sizes, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- as a line ---- */

void SamReportDuration(double seconds, char text[], size_t size)
{
  const long total = (long)(seconds + 0.5);

  snprintf(text, size, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
}

/* A column: its heading, the number in it, its width with a space before, its digits, and when it is omitted. */
typedef struct {
  const char *heading, *number;
  int         width, digits, order; /* order in which columns are omitted where a line would be too long; 0: never */
} Column;
enum { STEP, TIME, LOADS, CONTACT = LOADS + SAM_COMPONENTS, SLIP = CONTACT + 4, RESIDUAL = CONTACT + 7, SECONDS, LEFT };
/* The headings of loads and areas per metre of length. */
static const char *const per_metre[] = {"N/(N/m)", "Tx/(N/m)", "Ty/(N/m)", "", "My/N", "", "contact/m", "stick/m"};
static const Column      columns[SAM_REPORT_COLUMNS] = {{"step", "", 5, 0, 0},
                                                        {"time/s", "", 10, 4, 0},
                                                        {"N/N", "", 11, 4, 0},
                                                        {"Tx/N", "", 11, 4, 0},
                                                        {"Ty/N", "", 11, 4, 0},
                                                        {"Mx/Nm", "", 11, 4, 0},
                                                        {"My/Nm", "", 11, 4, 0},
                                                        {"Mz/Nm", "", 11, 4, 0},
                                                        {"contact/m2", "contact_area", 11, 4, 0},
                                                        {"stick/m2", "stick_area", 10, 3, 5},
                                                        {"p max/Pa", "pressure_max", 9, 3, 6},
                                                        {"q max/Pa", "shear_max", 9, 3, 3},
                                                        {"slip/m", "slip_max", 9, 3, 4},
                                                        {"it n", "normal_iterations", 5, 4, 2},
                                                        {"it t", "tangential_iterations", 5, 4, 1},
                                                        {"residual", "", 9, 2, 0},
                                                        {"s", "", 7, 2, 0},
                                                        {"left", "", 9, 0, 0}};

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

/* Writes the text of column k of a step's line. */
static void WriteColumn(SamReport r, const SamStep *s, SamContact contact, int k, double seconds, double left,
                        char text[], size_t size)
{
  const Sizes  sizes  = GetSizes(s, contact);
  const char  *name   = NameOf(contact, columns[k].number);
  const double number = name[0] ? Get(contact, name) : 0;

  if (k == STEP)
    (void)snprintf(text, size, "%ld", (long)r->number + 1);
  else if (k == RESIDUAL)
    (void)snprintf(text, size, "%.1e", (double)SamLarger(s->check.normal, s->check.tangential));
  else if (k == SECONDS)
    (void)snprintf(text, size, "%.*f", seconds < 1000 ? 2 : 0, seconds);
  else if (k == LEFT)
    SamReportDuration(left, text, size);
  else
    (void)snprintf(text, size, "%.*g", columns[k].digits,
                   k == TIME     ? (double)s->control.time
                   : k < CONTACT ? Rounded(s, k - LOADS, s->load, sizes.load)
                   : k == SLIP   ? Clean(number, ROUNDING * sizes.rigid[0])
                                 : number);
}

PetscErrorCode SamReportStepLine(SamReport r, const SamStep *s, SamContact contact, double seconds, double left)
{
  PetscFunctionBegin;
  for (PetscBool heading = r->done == 1;; heading = PETSC_FALSE) {
    char   line[512];
    size_t used = 0;

    for (int k = 0; k < SAM_REPORT_COLUMNS; k++) {
      char text[32];

      if (!r->shown[k]) continue;
      WriteColumn(r, s, contact, k, seconds, left, text, sizeof(text));
      used += (size_t)snprintf(line + used, sizeof(line) - used, "%*s", columns[k].width,
                               !heading                                  ? text
                               : r->row && k >= LOADS && k < CONTACT + 2 ? per_metre[k - LOADS]
                               : k == SLIP && SamContactGetMotion(contact)->slip_heading
                                 ? SamContactGetMotion(contact)->slip_heading
                                 : columns[k].heading);
    }
    PetscCall(PetscPrintf(r->comm, "%s\n", line));
    if (!heading) PetscFunctionReturn(PETSC_SUCCESS);
  }
}
