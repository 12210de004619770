/*
  The group /errors of a results file: the numbers of the last step, or of the last cycle, with their errors; and
  /warnings.
*/
#include "ioimpl.h"
#include <math.h>
#include <string.h>

/* Writes a column of numbers; rank 0 has them. */
static void WriteNumbers(SamOutput o, hid_t group, const SamLabel *label, PetscInt count, const double values[])
{
  const SamShape shape = {1, {(hsize_t)count}, {(hsize_t)count}, {0}, NULL};
  const SamBlock block = {1, {0}, {o->f->rank ? 0 : (hsize_t)count}};
  const hid_t    data  = SamFileCreateDataset(o->f, group, label, H5T_IEEE_F64LE, &shape, 0);

  SamFileWriteBlock(o->f, data, H5T_NATIVE_DOUBLE, &block, values);
  (void)SamFileNote(o->f, H5Dclose(data));
}

/* Writes a column of texts of so many bytes; rank 0 has them. */
static void WriteTexts(SamOutput o, hid_t group, const SamLabel *label, PetscInt count, size_t bytes,
                       const char texts[])
{
  const SamShape shape = {1, {(hsize_t)count}, {(hsize_t)count}, {0}, NULL};
  const SamBlock block = {1, {0}, {o->f->rank ? 0 : (hsize_t)count}};
  const hid_t    type  = SamFileNote(o->f, H5Tcopy(H5T_C_S1));
  hid_t          data;

  (void)SamFileNote(o->f, H5Tset_size(type, bytes));
  data = SamFileCreateDataset(o->f, group, label, type, &shape, 0);
  SamFileWriteBlock(o->f, data, type, &block, texts);
  (void)SamFileNote(o->f, H5Dclose(data));
  (void)H5Tclose(type);
}

PetscErrorCode SamOutputAppendWarnings(SamOutput o, PetscInt count, const char texts[][SAM_WARNING_TEXT])
{
  static const SamLabel label = {"warnings", NULL, "warnings of the run"};

  PetscFunctionBegin;
  WriteTexts(o, o->f->id, &label, count, SAM_WARNING_TEXT, texts[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputAppendErrors(SamOutput o, const SamErrorTable *t)
{
  static const SamLabel texts[]   = {{"name", NULL, "name of the number"},
                                     {"unit", NULL, "unit of the number"},
                                     {"cause", NULL, "cause of the larger part of the error"}},
                        numbers[] = {
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
  enum { TEXTS = sizeof(texts) / sizeof(texts[0]), NUMBERS = sizeof(numbers) / sizeof(numbers[0]) };
  char   column[TEXTS][SAM_ERROR_ROWS][SAM_ERROR_NAME];
  double values[NUMBERS][SAM_ERROR_ROWS];
  double tractions = NAN; /* the larger error of both largest tractions */
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
  for (PetscInt k = 0; k < t->count; k++)
    if (!strcmp(t->row[k].name, "pressure_max") || !strcmp(t->row[k].name, "shear_max"))
      tractions = isnan(tractions) ? t->row[k].error : PetscMax(tractions, t->row[k].error);
  SamFileWriteAttribute(o->f, o->f->id, SAM_OUTPUT_TRACTIONS, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, &tractions);
  group = SamFileNote(o->f, H5Gcreate2(o->f->id, "errors", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (int c = 0; c < TEXTS; c++) WriteTexts(o, group, &texts[c], t->count, SAM_ERROR_NAME, column[c][0]);
  for (int c = 0; c < NUMBERS; c++) WriteNumbers(o, group, &numbers[c], t->count, values[c]);
  (void)SamFileNote(o->f, H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}
