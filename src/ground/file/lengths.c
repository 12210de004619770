/* Reads the attributes of an HDF5 dataset of lengths: their unit, their quantity, and the size of the surface. */
#include "fileimpl.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define UNITS "m, cm, mm, um, nm, pm, angstrom, in"

/* The names of each unit, separated by blanks */
static const struct {
  const char *names;
  double      metres;
} units[] = {{" m meter metre ", 1},
             {" km kilometer kilometre ", 1e3},
             {" cm centimeter centimetre ", 1e-2},
             {" mm millimeter millimetre ", 1e-3},
             {" um \u00b5m \u03bcm micrometer micrometre micron ", 1e-6},
             {" nm nanometer nanometre ", 1e-9},
             {" pm picometer picometre ", 1e-12},
             {" angstrom \u00c5 ", 1e-10},
             {" in inch ", 0.0254},
             {" mil ", 2.54e-5}};

/* Heights are positive outward, so heights of both bodies reduce the separation. */
static const struct {
  const char *name;
  double      sign;
} quantities[] = {{"separation", 1}, {"height1", -1}, {"height2", -1}};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Returns the metres of a unit, 0 for an unknown unit; full words may be plural. */
static double Metres(const char unit[])
{
  size_t length = strlen(unit);
  char   word[64];

  if (length > 4 && unit[length - 1] == 's') length--;
  (void)snprintf(word, sizeof(word), " %.*s ", (int)length, unit);
  for (size_t k = 0; k < COUNT(units) && length && !strchr(unit, ' '); k++)
    if (strstr(units[k].names, word)) return units[k].metres;
  return 0;
}

/* Reads the unit in a dataset's attribute, in metres; 0 if there is no such attribute. */
static PetscErrorCode ReadUnits(SamFile f, hid_t dataset, const char name[], double *metres)
{
  char text[48];

  PetscFunctionBegin;
  *metres = 0;
  if (!SamTextRead(dataset, "units", text, sizeof(text))) PetscFunctionReturn(PETSC_SUCCESS);
  *metres = Metres(text);
  SamFileCheck(f, *metres > 0, "%s: its attribute units is \"%s\": known are " UNITS, name, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadQuantity(SamFile f, hid_t dataset, const char name[], double *sign)
{
  char text[48];

  PetscFunctionBegin;
  *sign = 1;
  if (!SamTextRead(dataset, "quantity", text, sizeof(text))) PetscFunctionReturn(PETSC_SUCCESS);
  for (size_t k = 0; k < COUNT(quantities); k++) {
    *sign = quantities[k].sign;
    if (!strcmp(text, quantities[k].name)) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(
    SamFileRefuse(f,
                  "%s: its attribute quantity is \"%s\": known are separation, height1, height2 (heights of body 1 or "
                  "2, positive out of the body)",
                  name, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the attribute size, if there is one. */
static PetscErrorCode ReadSize(SamFile f, hid_t dataset, const char name[], PetscBool *has, double size[2])
{
  hssize_t count;

  PetscFunctionBegin;
  *has = H5Aexists(dataset, "size") > 0;
  if (!*has) PetscFunctionReturn(PETSC_SUCCESS);
  (void)SamAttributeClass(dataset, "size", &count);
  if (count == 2) SamFileReadAttribute(f, dataset, "size", H5T_NATIVE_DOUBLE, 2, size);
  SamFileCheck(f, count == 2 && !f->failed && size[0] > 0 && size[1] > 0 && isfinite(size[0] + size[1]),
               "%s: its attribute size is not two positive numbers: x, y in m", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the width and the centre, in the dataset's unit, of n cells whose centres it contains; NaN for other
   datasets. */
static double ReadWidth(hid_t axis, hsize_t n, double *center)
{
  const hid_t space   = H5Dget_space(axis);
  double     *centres = NULL, width = NAN;

  if (space >= 0 && H5Sget_simple_extent_ndims(space) == 1 && H5Sget_simple_extent_npoints(space) == (hssize_t)n)
    centres = (double *)malloc(n * sizeof(*centres));
  if (centres && H5Dread(axis, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, centres) >= 0) {
    width   = (centres[n - 1] - centres[0]) * (double)n / ((double)n - 1);
    *center = 0.5 * (centres[0] + centres[n - 1]);
  }
  free(centres);
  if (space >= 0) (void)H5Sclose(space);
  return width;
}

void SamLengthsNameAxis(const char dataset[], char letter, char path[PETSC_MAX_PATH_LEN])
{
  const char *slash = strrchr(dataset, '/');

  (void)snprintf(path, PETSC_MAX_PATH_LEN, "%.*s%c", slash ? (int)(slash - dataset) + 1 : 0, dataset, letter);
}

/* Reads width and centre from the dataset `letter` of an axis beside the dataset, if it exists, fits, and has units. */
static PetscErrorCode ReadAxis(SamFile f, const char dataset[], char letter, hsize_t n, double *size, double *center)
{
  const char name[2] = {letter, '\0'};
  char       path[PETSC_MAX_PATH_LEN];
  double     metres = 0, width = NAN, middle = 0;
  hid_t      axis;

  PetscFunctionBegin;
  SamLengthsNameAxis(dataset, letter, path);
  axis = H5Lexists(f->id, path, H5P_DEFAULT) > 0 ? H5Dopen2(f->id, path, H5P_DEFAULT) : -1;
  if (axis < 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (H5Aexists(axis, "units") > 0) width = ReadWidth(axis, n, &middle);
  if (!isnan(width)) PetscCall(ReadUnits(f, axis, name, &metres)); /* otherwise the dataset is not an axis */
  (void)H5Dclose(axis);
  SamFileCheck(f, !(width < 0),
               "%s falls along the file, so the surface would be mirrored: reverse it and the values of %s", name,
               dataset);
  if (isnan(width)) PetscFunctionReturn(PETSC_SUCCESS);
  *size   = width * metres;
  *center = middle * metres;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLengthsRead(SamFile f, hid_t dataset, const char name[], const hsize_t shape[2], SamLengths *lengths)
{
  double    metres, sign;
  PetscBool has;

  PetscFunctionBegin;
  *lengths = (SamLengths){.factor = 1};
  SamFileCheck(f, H5Aexists(dataset, "scale_factor") <= 0 && H5Aexists(dataset, "add_offset") <= 0,
               "%s: its attributes scale_factor or add_offset say that it is packed: expected the numbers "
               "themselves, and no such attributes",
               name);
  PetscCall(ReadUnits(f, dataset, name, &metres));
  PetscCall(ReadQuantity(f, dataset, name, &sign));
  lengths->factor = sign * (metres > 0 ? metres : 1);
  PetscCall(ReadSize(f, dataset, name, &has, lengths->size));
  if (has) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReadAxis(f, name, 'x', shape[1], &lengths->size[0], &lengths->center[0]));
  PetscCall(ReadAxis(f, name, 'y', shape[0], &lengths->size[1], &lengths->center[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
