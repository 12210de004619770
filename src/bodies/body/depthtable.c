/* Constants of a body over the depth, from a text file: rows from the surface down; two rows at one depth are a
   jump. */
#include <petsam/private/bodyimpl.h>
#include <petsam/private/base.h>

static PetscErrorCode CheckRows(const SamOptions *from, const SamDepthTable *d)
{
  const SamTable *t    = &d->table;
  const PetscInt  last = t->rows - 1;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < t->rows; k++) {
    const double depth = SamDepthTableGet(d, k, 0);

    PetscCheck(k || depth == 0, from->comm, SAM_ERR_USER,
               "%s, line %d: depth %.6g: expected 0 in the first row: depth 0 is the surface", d->file, (int)t->line[0],
               depth);
    PetscCheck(!k || depth >= SamDepthTableGet(d, k - 1, 0), from->comm, SAM_ERR_USER,
               "%s, line %d: depth %.6g is less than in the row before: order the rows by depth", d->file,
               (int)t->line[k], depth);
  }
  PetscCheck(last > 0 && SamDepthTableGet(d, last, 0) > 0, from->comm, SAM_ERR_USER,
             "%s: the last depth is 0: expected rows down to where the %s end", d->file, d->what);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDepthTableRead(const SamOptions *from, const char option[], const char help[], SamDepthTable *d,
                                 PetscBool *set)
{
  const SamOptionRow row = {option, help, SAM_OPTION_FILE, .size = sizeof(d->file)};
  char               name[96];

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, d->file, set));
  if (SamPrintHelp()) *set = PETSC_FALSE;
  if (!*set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s%s", SamOptionsPrefix(from), option));
  PetscCall(SamTableRead(from->comm, name, d->file, d->names, &d->table));
  for (int c = 0; c < SAM_DEPTH_COLUMNS; c++) {
    d->column[c] = SamTableFind(&d->table, d->names[c]);
    PetscCheck(d->column[c] >= 0, from->comm, SAM_ERR_USER, "%s, line %d: no column named %s", d->file,
               (int)d->table.header_line, d->names[c]);
  }
  PetscCall(CheckRows(from, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}
