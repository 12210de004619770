/* What an HDF5 dataset of lengths says about itself: their unit, whether they are heights, the size of the surface. */
#include <petsam/private/lengths.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name;
  double      metres;
} units[] = {{"m", 1},
             {"meter", 1},
             {"metre", 1},
             {"cm", 1e-2},
             {"centimeter", 1e-2},
             {"centimetre", 1e-2},
             {"mm", 1e-3},
             {"millimeter", 1e-3},
             {"millimetre", 1e-3},
             {"um", 1e-6},
             {"\u00b5m", 1e-6},
             {"\u03bcm", 1e-6},
             {"micrometer", 1e-6},
             {"micrometre", 1e-6},
             {"micron", 1e-6},
             {"nm", 1e-9},
             {"nanometer", 1e-9},
             {"nanometre", 1e-9},
             {"pm", 1e-12},
             {"picometer", 1e-12},
             {"picometre", 1e-12},
             {"angstrom", 1e-10},
             {"\u00c5", 1e-10},
             {"in", 0.0254},
             {"inch", 0.0254}};

/* Heights are positive out of their body, so both bodies' reduce the separation. */
static const struct {
  const char *name;
  double      sign;
} quantities[] = {{"separation", 1}, {"height1", -1}, {"height2", -1}};

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* The metres of a unit, 0 for one that is not known; full words may be plural. */
static double Metres(const char unit[])
{
  size_t length = strlen(unit);

  if (length > 4 && unit[length - 1] == 's') length--;
  for (size_t k = 0; k < COUNT(units); k++)
    if (strlen(units[k].name) == length && !strncmp(unit, units[k].name, length)) return units[k].metres;
  return 0;
}

/* Copies a text without the spaces that pad it; what does not fit is cut. */
static void CopyTrimmed(const char from[], size_t most, char text[], size_t size)
{
  size_t length = strnlen(from, most);

  while (length && from[length - 1] == ' ') length--;
  if (length > size - 1) length = size - 1;
  memcpy(text, from, length);
  text[length] = '\0';
}

/* Reads an attribute that is one text, of fixed or variable length. Returns whether there is an attribute. */
static PetscBool ReadText(hid_t object, const char name[], char text[], size_t size)
{
  const hid_t attribute = H5Aexists(object, name) > 0 ? H5Aopen(object, name, H5P_DEFAULT) : -1;
  const hid_t type      = attribute >= 0 ? H5Aget_type(attribute) : -1,
              space     = attribute >= 0 ? H5Aget_space(attribute) : -1;
  const size_t bytes    = type >= 0 ? H5Tget_size(type) : 0;
  const int    variable = type >= 0 && H5Tis_variable_str(type) > 0;
  char        *value    = NULL;

  (void)snprintf(text, size, "not a text");
  if (bytes && space >= 0 && H5Tget_class(type) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1) {
    if (variable) {
      if (H5Aread(attribute, type, &value) >= 0 && value) CopyTrimmed(value, size, text, size);
      if (value) (void)H5free_memory(value);
    } else if ((value = (char *)calloc(bytes, 1)) != NULL) {
      if (H5Aread(attribute, type, value) >= 0) CopyTrimmed(value, bytes, text, size);
      free(value);
    }
  }
  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  if (attribute >= 0) (void)H5Aclose(attribute);
  return attribute >= 0;
}

static void ReadUnits(hid_t dataset, SamLengths *lengths)
{
  double metres;

  if (!ReadText(dataset, "units", lengths->text, sizeof(lengths->text))) return;
  metres = Metres(lengths->text);
  if (metres > 0)
    lengths->factor *= metres;
  else
    lengths->problem = SAM_LENGTHS_BAD_UNITS;
}

static void ReadQuantity(hid_t dataset, SamLengths *lengths)
{
  if (!ReadText(dataset, "quantity", lengths->text, sizeof(lengths->text))) return;
  lengths->problem = SAM_LENGTHS_BAD_QUANTITY;
  for (size_t k = 0; k < COUNT(quantities); k++)
    if (!strcmp(lengths->text, quantities[k].name)) {
      lengths->factor *= quantities[k].sign;
      lengths->problem = SAM_LENGTHS_GOOD;
    }
}

/* Reads the attribute size. Returns whether there is one. */
static PetscBool ReadSize(hid_t dataset, SamLengths *lengths)
{
  const hid_t attribute = H5Aexists(dataset, "size") > 0 ? H5Aopen(dataset, "size", H5P_DEFAULT) : -1;
  const hid_t space     = attribute >= 0 ? H5Aget_space(attribute) : -1;
  double      size[2]   = {0, 0};

  if (attribute < 0) return PETSC_FALSE;
  if (space >= 0 && H5Sget_simple_extent_npoints(space) == 2 && H5Aread(attribute, H5T_NATIVE_DOUBLE, size) >= 0 &&
      size[0] > 0 && size[1] > 0 && isfinite(size[0] + size[1]))
    memcpy(lengths->size, size, sizeof(size));
  else
    lengths->problem = SAM_LENGTHS_BAD_SIZE;
  if (space >= 0) (void)H5Sclose(space);
  (void)H5Aclose(attribute);
  return PETSC_TRUE;
}

/* Width of n cells whose centres a dataset holds, in its unit; NaN for another dataset. */
static double ReadWidth(hid_t axis, hsize_t n)
{
  const hid_t space   = H5Dget_space(axis);
  double     *centres = NULL, width = NAN;

  if (space >= 0 && H5Sget_simple_extent_ndims(space) == 1 && H5Sget_simple_extent_npoints(space) == (hssize_t)n)
    centres = (double *)malloc(n * sizeof(*centres));
  if (centres && H5Dread(axis, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, centres) >= 0)
    width = (centres[n - 1] - centres[0]) * (double)n / ((double)n - 1);
  free(centres);
  if (space >= 0) (void)H5Sclose(space);
  return width;
}

/* Reads the width from the axis `letter` beside the dataset, if it is there, fits, and has units. */
static void ReadAxis(hid_t file, const char dataset[], char letter, hsize_t n, SamLengths *lengths, double *size)
{
  const char *slash = strrchr(dataset, '/');
  char        path[PETSC_MAX_PATH_LEN];
  double      metres = 0, width = NAN;
  hid_t       axis;

  (void)snprintf(path, sizeof(path), "%.*s%c", slash ? (int)(slash - dataset) + 1 : 0, dataset, letter);
  axis = H5Lexists(file, path, H5P_DEFAULT) > 0 ? H5Dopen2(file, path, H5P_DEFAULT) : -1;
  if (axis < 0) return;
  if (ReadText(axis, "units", lengths->text, sizeof(lengths->text))) {
    metres = Metres(lengths->text);
    width  = ReadWidth(axis, n) * metres;
  }
  (void)H5Dclose(axis);
  if (isnan(width)) return; /* it has no units, or is something else */
  (void)snprintf(lengths->name, sizeof(lengths->name), "%c", letter);
  if (metres == 0)
    lengths->problem = SAM_LENGTHS_BAD_UNITS;
  else if (width < 0)
    lengths->problem = SAM_LENGTHS_FALLING_AXIS;
  else
    *size = width;
}

void SamLengthsRead(hid_t file, hid_t dataset, const char name[], const hsize_t shape[2], SamLengths *lengths)
{
  *lengths = (SamLengths){.problem = SAM_LENGTHS_GOOD, .factor = 1};
  if (H5Aexists(dataset, "scale_factor") > 0 || H5Aexists(dataset, "add_offset") > 0)
    lengths->problem = SAM_LENGTHS_PACKED;
  if (!lengths->problem) ReadUnits(dataset, lengths);
  if (!lengths->problem) ReadQuantity(dataset, lengths);
  if (lengths->problem || ReadSize(dataset, lengths)) return;
  ReadAxis(file, name, 'x', shape[1], lengths, &lengths->size[0]);
  if (!lengths->problem) ReadAxis(file, name, 'y', shape[0], lengths, &lengths->size[1]);
}
