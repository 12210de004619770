/*
  The printed tables of steps and of cycles: columns with a heading, which contains the unit of the number's
  declaration.
*/
#include "report.h"
#include <petsam/private/state.h>
#include <petsam/private/control.h>

double SamReportNumber(SamState state, const char name[])
{
  const PetscInt id = SamStateFindNumber(state, name);

  return id < 0 ? NAN : *SamStateReadNumbers(state, id);
}

/* Returns the unit of a load or of a number of the state, on the grid; "": none. */
static const char *UnitOf(SamGrid grid, SamState state, const char number[])
{
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++)
    if (!strcmp(number, SamComponentNames[c].load)) return SamUnitOn(grid, SamComponentNames[c].load_unit);
  return SamStateUnitOf(state, number);
}

void SamReportHeading(SamGrid grid, SamState state, const SamReportColumn *column, SamReportCell cell)
{
  static const char *const shorter[][2] = {{"1", ""}, {"N m", "Nm"}, {"N m/m", "N"}, {"m2/m", "m"}, {"m3/m", "m2"}};
  const char              *unit = UnitOf(grid, state, column->number), *label = column->label;
  char                     behind[16];

  for (size_t k = 0; k < sizeof(shorter) / sizeof(shorter[0]); k++)
    if (!strcmp(unit, shorter[k][0])) unit = shorter[k][1];
  (void)snprintf(behind, sizeof(behind), strchr(unit, '/') ? "/(%s)" : unit[0] ? "/%s" : "%s", unit);
  if (column->other && (SamGridIsRow(grid) || strlen(label) + strlen(behind) >= (size_t)column->width))
    label = column->other;
  (void)snprintf(cell, sizeof(SamReportCell), "%s%s", label, behind);
}

void SamReportValue(const SamReportColumn *column, double value, SamReportCell cell)
{
  (void)snprintf(cell, sizeof(SamReportCell), column->digits ? "%.*g" : "%.*e", column->digits ? column->digits : 1,
                 value);
  for (int digits = PetscMin(column->digits, 9); digits > 1 && strlen(cell) >= (size_t)column->width; digits--)
    (void)snprintf(cell, sizeof(SamReportCell), "%.*g", digits - 1, value);
  if (isnan(value)) (void)snprintf(cell, sizeof(SamReportCell), "-");
}

void SamReportSeconds(double seconds, SamReportCell cell)
{
  (void)snprintf(cell, sizeof(SamReportCell), "%.*f", seconds < 1000 ? 2 : 0, seconds);
}

/* Adds a line to those that wait to be printed. */
static PetscErrorCode Hold(SamReport r, const char line[])
{
  const size_t size = strlen(line) + 1;

  PetscFunctionBegin;
  if (r->held_length + size > r->held_size) {
    r->held_size = 2 * (r->held_length + size);
    PetscCall(PetscRealloc(r->held_size, &r->held));
  }
  PetscCall(PetscArraycpy(r->held + r->held_length, line, size));
  r->held_length += size - 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReportPrintHeld(SamReport r)
{
  PetscFunctionBegin;
  if (r->held_length) PetscCall(PetscPrintf(r->comm, "%s", r->held));
  r->held_length = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamReportLine(SamReport r, PetscInt count, const SamReportColumn columns[], SamReportCell cells[])
{
  char   line[512];
  size_t used = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k++)
    if (cells[k][0]) used += (size_t)snprintf(line + used, sizeof(line) - used, "%*s", columns[k].width, cells[k]);
  PetscCall(PetscStrlcat(line, "\n", sizeof(line)));
  PetscCall(Hold(r, line));
  if (!r->holds) PetscCall(SamReportPrintHeld(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}
