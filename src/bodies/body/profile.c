/*
  Represents a body whose constants vary with the depth by layers, each with the constants at its middle, so that the
  error of the symbols is of second order in the thickness.

  Parts of the profile, from one row of the file to the next, get one layer where the constants do not vary; the other
  parts share the rest, in proportion to how much Young's modulus changes in them.
*/
#include <petsam/private/bodyimpl.h>

enum { DEPTH, YOUNG, POISSON };

static PetscErrorCode CheckConstants(const SamOptions *from, const SamDepthTable *d)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < d->table.rows; k++) {
    const double young = SamDepthTableGet(d, k, YOUNG), poisson = SamDepthTableGet(d, k, POISSON);

    PetscCheck(young > 0, from->comm, SAM_ERR_USER, "%s, line %d: young %.6g: expected a number > 0", d->file,
               (int)d->table.line[k], young);
    PetscCheck(poisson > -1 && poisson <= 0.5, from->comm, SAM_ERR_USER,
               "%s, line %d: poisson %.6g: expected a number above -1 and at most 0.5", d->file, (int)d->table.line[k],
               poisson);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the change of the constants from row k to the next; 0: one layer suffices. */
static double ChangeOf(const SamDepthTable *d, PetscInt k)
{
  return fabs(log(SamDepthTableGet(d, k + 1, YOUNG) / SamDepthTableGet(d, k, YOUNG))) +
         fabs(SamDepthTableGet(d, k + 1, POISSON) - SamDepthTableGet(d, k, POISSON));
}

static PetscBool IsPart(const SamDepthTable *d, PetscInt k)
{
  return SamDepthTableGet(d, k + 1, DEPTH) > SamDepthTableGet(d, k, DEPTH) ? PETSC_TRUE : PETSC_FALSE;
}

static void AddLayers(const SamDepthTable *d, PetscInt k, PetscInt count, SamMaterial layers[])
{
  const double from      = SamDepthTableGet(d, k, DEPTH),
               thickness = (SamDepthTableGet(d, k + 1, DEPTH) - from) / (double)count;

  for (PetscInt n = 0; n < count; n++) {
    const double at = ((double)n + 0.5) / (double)count;

    layers[n].thickness = thickness;
    layers[n].young     = (1 - at) * SamDepthTableGet(d, k, YOUNG) + at * SamDepthTableGet(d, k + 1, YOUNG);
    layers[n].poisson   = (1 - at) * SamDepthTableGet(d, k, POISSON) + at * SamDepthTableGet(d, k + 1, POISSON);
  }
}

PetscErrorCode SamBodyReadProfile(const SamOptions *from, const char option[], SamMaterial layers[], PetscInt *count,
                                  PetscBool *set)
{
  SamDepthTable d      = {.names = {"depth", "young", "poisson"}, .what = "layers"};
  PetscInt      parts  = 0;
  double        change = 0, done = 0;

  PetscFunctionBegin;
  PetscCall(
    SamDepthTableRead(from, option, "text file of depth, young, poisson: constants that vary with depth", &d, set));
  if (!*set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckConstants(from, &d));
  for (PetscInt k = 0; k + 1 < d.table.rows; k++) {
    parts += IsPart(&d, k) ? 1 : 0;
    change += IsPart(&d, k) ? ChangeOf(&d, k) : 0;
  }
  PetscCheck(parts <= (SAM_MATERIALS - 1), from->comm, SAM_ERR_USER, "%s: has %d rows: expected at most %d", d.file,
             (int)d.table.rows, SAM_MATERIALS - 1);
  for (PetscInt k = 0, shared = 0; k + 1 < d.table.rows; k++) {
    PetscInt share;

    if (!IsPart(&d, k)) continue;
    done += ChangeOf(&d, k);
    share = change > 0 ? (PetscInt)floor((double)((SAM_MATERIALS - 1) - parts) * (done / change) + 1e-9) : 0;
    AddLayers(&d, k, 1 + share - shared, layers + *count);
    *count += 1 + share - shared;
    shared = share;
  }
  PetscCall(SamTableDestroy(&d.table));
  PetscFunctionReturn(PETSC_SUCCESS);
}
