/*
  The group /errors of a results file: the numbers of the last step, or of the last cycle, with their errors; and
  /warnings.

  They are created with the file, without rows: HDF5 writes the parts of a group's index in place and one by one, so a
  run that is killed while it adds a name to the root group would leave other names, and their data, that are not found.
*/
#include "ioimpl.h"
#include <math.h>
#include <string.h>

/* The columns of /errors */
enum { TEXTS = 3, NUMBERS = 10 };
static const SamLabel texts[TEXTS]     = {{"name", "1", "name of the number"},
                                          {"unit", "1", "unit of the number"},
                                          {"cause", "1", "cause of the larger part of the error"}},
                      numbers[NUMBERS] = {
                        {"value", NULL, "the number; of what each step adds to, the sum over the steps of this run"},
                        {"error", "1", "estimated error relative to the number"},
                        {"by_cells", "1", "the part of it by the cells"},
                        {"by_steps", "1", "the part of it by the steps"},
                        {"by_layers", "1", "the part of it by the layers of bodies that yield"},
                        {"by_mesh", "1", "the part of it by the finite elements of bodies' compliances"},
                        {"factor", "1", "factor of narrower cells, or more steps, for an error of 4 %"},
                        {"half", NULL, "the number on half the cells in each direction"},
                        {"quarter", NULL, "the number on a quarter of the cells in each direction"},
                        {"other", NULL,
                         "the number with other steps, on half or a quarter of the cells in each direction"}};

static hid_t TextType(SamOutput o, size_t bytes)
{
  const hid_t type = SamFileNote(o->f, H5Tcopy(H5T_C_S1));

  (void)SamFileNote(o->f, H5Tset_size(type, bytes));
  return type;
}

/* Creates a column without rows: texts of so many bytes, or numbers (0). */
static void CreateColumn(SamOutput o, hid_t group, const SamLabel *label, size_t bytes)
{
  static const SamShape shape = {1, {0}, {H5S_UNLIMITED}, {16}, NULL};
  const hid_t           type  = bytes ? TextType(o, bytes) : H5T_IEEE_F64LE;

  (void)SamFileNote(o->f, H5Dclose(SamFileCreateDataset(o->f, group, label, type, &shape, 0)));
  if (bytes) (void)H5Tclose(type);
}

/* Writes all rows of a column; rank 0 has them. */
static void WriteColumn(SamOutput o, hid_t group, const SamLabel *label, size_t bytes, PetscInt count,
                        const void *values)
{
  const hsize_t  rows  = (hsize_t)count;
  const SamBlock block = {1, {0}, {o->f->rank ? 0 : rows}};
  const hid_t    data  = SamFileNote(o->f, H5Dopen2(group, label->name, H5P_DEFAULT)),
              type     = bytes ? TextType(o, bytes) : H5T_NATIVE_DOUBLE;

  (void)SamFileNote(o->f, H5Dset_extent(data, &rows));
  SamFileWriteBlock(o->f, data, type, &block, values);
  (void)SamFileNote(o->f, H5Dclose(data));
  if (bytes) (void)H5Tclose(type);
}

static const SamLabel warnings = {"warnings", "1", "warnings of the run"};

void SamOutputCreateTables(SamOutput o)
{
  const double unknown = NAN;
  hid_t        group;

  CreateColumn(o, o->f->id, &warnings, SAM_WARNING_TEXT);
  if (!o->set.errors) return;
  SamFileWriteAttribute(o->f, o->f->id, SAM_OUTPUT_TRACTIONS, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &unknown);
  group = SamFileNote(o->f, H5Gcreate2(o->f->id, "errors", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (int c = 0; c < TEXTS; c++) CreateColumn(o, group, &texts[c], SAM_ERROR_NAME);
  for (int c = 0; c < NUMBERS; c++) CreateColumn(o, group, &numbers[c], 0);
  (void)SamFileNote(o->f, H5Gclose(group));
}

PetscErrorCode SamOutputAppendWarnings(SamOutput o, PetscInt count, const char rows[][SAM_WARNING_TEXT])
{
  PetscFunctionBegin;
  WriteColumn(o, o->f->id, &warnings, SAM_WARNING_TEXT, count, rows[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the larger error of both largest tractions in place. */
static void WriteTractionError(SamOutput o, const SamErrorTable *t)
{
  const hid_t attribute = SamFileNote(o->f, H5Aopen(o->f->id, SAM_OUTPUT_TRACTIONS, H5P_DEFAULT));
  double      error     = NAN;

  for (PetscInt k = 0; k < t->count; k++)
    if (!strcmp(t->row[k].name, "pressure_max") || !strcmp(t->row[k].name, "shear_max"))
      error = isnan(error) ? t->row[k].error : PetscMax(error, t->row[k].error);
  (void)SamFileNote(o->f, H5Awrite(attribute, H5T_NATIVE_DOUBLE, &error));
  (void)SamFileNote(o->f, H5Aclose(attribute));
}

PetscErrorCode SamOutputAppendErrors(SamOutput o, const SamErrorTable *t)
{
  char   column[TEXTS][SAM_ERROR_TABLE][SAM_ERROR_NAME];
  double values[NUMBERS][SAM_ERROR_TABLE];
  hid_t  group;

  PetscFunctionBegin;
  memset(column, 0, sizeof(column));
  for (PetscInt k = 0; k < t->count; k++) {
    const SamErrorRow *row     = &t->row[k];
    const char *const  words[] = {row->name, row->unit, SamCauseNames[row->cause]};
    const double       all[]   = {row->value,
                                  row->error,
                                  row->of[SAM_CAUSE_CELLS],
                                  row->of[SAM_CAUSE_STEPS],
                                  row->of[SAM_CAUSE_LAYERS],
                                  row->of[SAM_CAUSE_MESH],
                                  row->factor,
                                  row->run[SAM_RUN_HALF],
                                  row->run[SAM_RUN_QUARTER],
                                  row->run[SAM_RUN_OTHER]};

    for (int c = 0; c < TEXTS; c++) (void)snprintf(column[c][k], SAM_ERROR_NAME, "%s", words[c]);
    for (int c = 0; c < NUMBERS; c++) values[c][k] = all[c];
  }
  WriteTractionError(o, t);
  group = SamFileNote(o->f, H5Gopen2(o->f->id, "errors", H5P_DEFAULT));
  for (int c = 0; c < TEXTS; c++) WriteColumn(o, group, &texts[c], SAM_ERROR_NAME, t->count, column[c][0]);
  for (int c = 0; c < NUMBERS; c++) WriteColumn(o, group, &numbers[c], 0, t->count, values[c]);
  (void)SamFileNote(o->f, H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}
