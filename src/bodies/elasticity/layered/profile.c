/*
  A body whose constants vary with the depth, as layers: each of the constants at its middle, so that the error of the
  symbols is of second order in their thickness.

  Parts of the profile, from one row of the file to the next, get one layer where the constants do not vary; the other
  parts share the rest, in proportion to how much Young's modulus changes in them.
*/
#include <petsam/private/layered.h>
#include <petsam/private/table.h>

enum { DEPTH, YOUNG, POISSON, COLUMNS };

static double ValueOf(const SamTable *t, const PetscInt column[COLUMNS], PetscInt row, int c)
{
  return t->value[row * t->columns + column[c]];
}

/* Faults of the rows, with file and line. */
static PetscErrorCode CheckRows(const SamOptions *from, const SamTable *t, const PetscInt column[COLUMNS],
                                const char file[])
{
  PetscFunctionBegin;
  PetscCheck(ValueOf(t, column, 0, DEPTH) == 0, from->comm, SAM_ERR_USER,
             "%s, line %d: depth %.6g: expected 0 in the first row, the surface", file, (int)t->line[0],
             ValueOf(t, column, 0, DEPTH));
  for (PetscInt k = 0; k < t->rows; k++) {
    const double depth = ValueOf(t, column, k, DEPTH), young = ValueOf(t, column, k, YOUNG),
                 poisson = ValueOf(t, column, k, POISSON);

    PetscCheck(!k || depth >= ValueOf(t, column, k - 1, DEPTH), from->comm, SAM_ERR_USER,
               "%s, line %d: depth %.6g is less than in the row before: order the rows by depth", file, (int)t->line[k],
               depth);
    PetscCheck(young > 0, from->comm, SAM_ERR_USER, "%s, line %d: young %.6g: expected a number > 0", file,
               (int)t->line[k], young);
    PetscCheck(poisson > -1 && poisson <= 0.5, from->comm, SAM_ERR_USER,
               "%s, line %d: poisson %.6g: expected a number above -1 and at most 0.5", file, (int)t->line[k], poisson);
  }
  PetscCheck(t->rows > 1 && ValueOf(t, column, t->rows - 1, DEPTH) > 0, from->comm, SAM_ERR_USER,
             "%s: the last depth is 0: expected rows down to where the constants are those of the body", file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns how much the constants change from row k to the next; 0: one layer suffices. */
static double ChangeOf(const SamTable *t, const PetscInt column[COLUMNS], PetscInt k)
{
  return fabs(log(ValueOf(t, column, k + 1, YOUNG) / ValueOf(t, column, k, YOUNG))) +
         fabs(ValueOf(t, column, k + 1, POISSON) - ValueOf(t, column, k, POISSON));
}

static PetscBool IsPart(const SamTable *t, const PetscInt column[COLUMNS], PetscInt k)
{
  return ValueOf(t, column, k + 1, DEPTH) > ValueOf(t, column, k, DEPTH) ? PETSC_TRUE : PETSC_FALSE;
}

static void AddLayers(const SamTable *t, const PetscInt column[COLUMNS], PetscInt k, PetscInt count,
                      SamMaterial layers[])
{
  const double from      = ValueOf(t, column, k, DEPTH),
               thickness = (ValueOf(t, column, k + 1, DEPTH) - from) / (double)count;

  for (PetscInt n = 0; n < count; n++) {
    const double at = ((double)n + 0.5) / (double)count;

    layers[n].thickness = thickness;
    layers[n].young     = (1 - at) * ValueOf(t, column, k, YOUNG) + at * ValueOf(t, column, k + 1, YOUNG);
    layers[n].poisson   = (1 - at) * ValueOf(t, column, k, POISSON) + at * ValueOf(t, column, k + 1, POISSON);
  }
}

PetscErrorCode SamBodyReadProfile(const SamOptions *from, const char option[], SamMaterial layers[], PetscInt *count,
                                  PetscBool *set)
{
  static const char *const names[COLUMNS + 1]       = {"depth", "young", "poisson", NULL};
  char                     file[PETSC_MAX_PATH_LEN] = "", name[96];
  const SamOptionRow       row = {option, "text file of depth, young, poisson: constants that vary with depth",
                                  SAM_OPTION_FILE, .size = sizeof(file)};
  SamTable                 t;
  PetscInt                 column[COLUMNS], parts = 0;
  double                   change = 0, done = 0;

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, file, set));
  if (!*set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s%s", SamOptionsPrefix(from), option));
  PetscCall(SamTableRead(from->comm, name, file, names, &t));
  for (int c = 0; c < COLUMNS; c++) {
    column[c] = SamTableFind(&t, names[c]);
    PetscCheck(column[c] >= 0, from->comm, SAM_ERR_USER, "%s, line %d: no column named %s: each layer needs one", file,
               (int)t.header_line, names[c]);
  }
  PetscCall(CheckRows(from, &t, column, file));
  for (PetscInt k = 0; k + 1 < t.rows; k++) {
    parts += IsPart(&t, column, k) ? 1 : 0;
    change += IsPart(&t, column, k) ? ChangeOf(&t, column, k) : 0;
  }
  PetscCheck(parts <= (SAM_MATERIALS - 1), from->comm, SAM_ERR_USER, "%s: has %d rows: expected at most %d", file,
             (int)t.rows, SAM_MATERIALS - 1);
  for (PetscInt k = 0, shared = 0; k + 1 < t.rows; k++) {
    PetscInt share;

    if (!IsPart(&t, column, k)) continue;
    done += ChangeOf(&t, column, k);
    share = change > 0 ? (PetscInt)floor((double)((SAM_MATERIALS - 1) - parts) * (done / change) + 1e-9) : 0;
    AddLayers(&t, column, k, 1 + share - shared, layers + *count);
    *count += 1 + share - shared;
    shared = share;
  }
  PetscCall(SamTableDestroy(&t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
