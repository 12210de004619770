/* The group /gradient of a results file: a number of the run, and its derivatives by all parameters. */
#include "ioimpl.h"
#include <petsam/private/contact.h>
#include <math.h>

static PetscErrorCode WriteNumber(SamOutput o, hid_t group, SamGradient g, const char name[])
{
  PetscReal value;

  PetscFunctionBegin;
  PetscCall(SamGradientGetNumber(g, name, 0, &value));
  SamFileWriteAttribute(o->f, group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the derivatives by a field, (ny, nx). */
static PetscErrorCode WriteField(SamOutput o, hid_t group, SamGradient g, const char name[], const char unit[])
{
  const SamGrid  grid  = o->grid;
  const SamLabel label = {name, unit, "derivative by the value in each cell"};
  const SamShape shape = {2, {(hsize_t)grid->ny, (hsize_t)grid->nx}, {(hsize_t)grid->ny, (hsize_t)grid->nx}, {0}, NULL};
  const SamBlock block = {2, {(hsize_t)grid->row_start, 0}, {(hsize_t)grid->rows, (hsize_t)grid->nx}};
  const hid_t    data  = SamFileCreateDataset(o->f, group, &label, H5T_IEEE_F64LE, &shape, 0);
  const double  *values;
  Vec            field;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &field));
  PetscCall(SamGradientGetField(g, name, field));
  PetscCall(VecGetArrayRead(field, &values));
  SamFileWriteBlock(o->f, data, H5T_NATIVE_DOUBLE, &block, values);
  PetscCall(VecRestoreArrayRead(field, &values));
  PetscCall(VecDestroy(&field));
  (void)SamFileNote(o->f, H5Dclose(data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the derivatives by the values of a column of the history, unless none of them is given. */
static PetscErrorCode WriteColumn(SamOutput o, hid_t group, SamGradient g, const char name[], const char unit[])
{
  const PetscInt steps = SamGradientGetSteps(g);
  const SamLabel label = {name, unit, "derivative by the value in each step; NaN: it is not given"};
  const SamShape shape = {1, {(hsize_t)steps}, {(hsize_t)steps}, {0}, NULL};
  const SamBlock block = {1, {0}, {o->f->rank ? 0 : (hsize_t)steps}};
  PetscReal     *values, given = 0;
  hid_t          data;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(steps, &values));
  for (PetscInt k = 0; k < steps; k++) {
    PetscCall(SamGradientGetNumber(g, name, k, &values[k]));
    given += isnan(values[k]) ? 0 : 1;
  }
  if (given > 0) {
    data = SamFileCreateDataset(o->f, group, &label, H5T_IEEE_F64LE, &shape, 0);
    SamFileWriteBlock(o->f, data, H5T_NATIVE_DOUBLE, &block, values);
    (void)SamFileNote(o->f, H5Dclose(data));
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the wanted derivatives by fields and columns. */
static PetscErrorCode WriteFields(SamOutput o, hid_t group, SamGradient g)
{
  const char *const of = SamGradientUnit(g), *name, *column;
  char              unit[64];

  PetscFunctionBegin;
  (void)snprintf(unit, sizeof(unit), "%s/m", of);
  if (SamGradientHas(g, "gap")) PetscCall(WriteField(o, group, g, "gap", unit));
  if (SamGradientHas(g, "friction")) PetscCall(WriteField(o, group, g, "friction", of));
  for (PetscInt k = 0; (name = SamGradientOfSteps(k, &column)); k++) {
    column = SamUnitOn(o->grid, column);
    (void)snprintf(unit, sizeof(unit), strpbrk(column, " /") ? "%s/(%s)" : "%s/%s", of, column);
    if (SamGradientHas(g, name)) PetscCall(WriteColumn(o, group, g, name, unit));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCreateGradients(SamOutput o)
{
  hid_t all;

  PetscFunctionBegin;
  if (!o->set.gradients) PetscFunctionReturn(PETSC_SUCCESS);
  all = SamFileNote(o->f, H5Gcreate2(o->f->id, "gradient", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (int k = 0; k < o->set.gradients; k++)
    (void)SamFileNote(o->f, H5Gclose(H5Gcreate2(all, o->set.gradient[k], H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)));
  (void)SamFileNote(o->f, H5Gclose(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the known errors, relative to the shares, as attributes. */
static void WriteErrors(SamOutput o, hid_t group, PetscInt count, const SamGradientShare shares[])
{
  for (PetscInt k = 0; k < count; k++) {
    const double error = fabs(shares[k].error / shares[k].share);
    char         name[64];

    if (!isfinite(error)) continue;
    (void)snprintf(name, sizeof(name), "%s_error", shares[k].name);
    SamFileWriteAttribute(o->f, group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &error);
  }
}

PetscErrorCode SamOutputAppendGradient(SamOutput o, SamGradient g, const char name[], PetscInt count,
                                       const SamGradientShare shares[])
{
  static const char *const numbers[] = {"value", "residual", "borders"};
  const char              *one;
  char                     path[256];
  hid_t                    group;

  PetscFunctionBegin;
  (void)snprintf(path, sizeof(path), "/gradient/%s", name);
  group = SamFileNote(o->f, H5Gopen2(o->f->id, path, H5P_DEFAULT));
  SamFileWriteTextAttribute(o->f, group, "units", SamGradientUnit(g));
  for (size_t k = 0; k < sizeof(numbers) / sizeof(numbers[0]); k++) PetscCall(WriteNumber(o, group, g, numbers[k]));
  for (PetscInt k = 0; (one = SamGradientNumber(g, k)); k++)
    if (SamGradientHas(g, one)) PetscCall(WriteNumber(o, group, g, one));
  WriteErrors(o, group, count, shares);
  PetscCall(WriteFields(o, group, g));
  (void)SamFileNote(o->f, H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}
