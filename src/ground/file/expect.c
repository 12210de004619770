/* What a reader expects of a file: one function examines the attributes and datasets that it has declared as rows. */
#include "fileimpl.h"
#include <stdarg.h>

PetscErrorCode SamFileRefuse(SamFile f, const char format[], ...)
{
  char    fault[SAM_MESSAGE];
  va_list values;

  PetscFunctionBegin;
  va_start(values, format);
  (void)vsnprintf(fault, sizeof(fault), format, values);
  va_end(values);
  SETERRQ(f->comm, SAM_ERR_FILE, "-%s %s: %s", f->option, f->filename, fault);
}

/* Checks that all numbers of a row lie in its range. */
static PetscErrorCode CheckNumbers(SamFile f, const char name[], const SamExpected *row, hsize_t count)
{
  const double *values = (const double *)row->values;
  const int     least  = row->range == SAM_RANGE_POSITIVE;
  char          whole[64];

  PetscFunctionBegin;
  (void)snprintf(whole, sizeof(whole), "a whole number from %d to %.0f", least, row->most);
  for (hsize_t k = 0; k < count && !row->free; k++)
    SamFileCheck(f,
                 row->most > 0 ? values[k] >= least && values[k] <= row->most && values[k] == floor(values[k])
                               : SamRangeHas(row->range, values[k]),
                 "number %lld of %s is %.6g: expected %s: make the file anew", (long long)k, name, values[k],
                 row->most > 0 ? whole : SamRangeDescribe(row->range));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ExamineAttribute(SamFile f, const SamFileKind *kind, const SamExpected *row)
{
  hssize_t count;
  const H5T_class_t class = SamAttributeClass(f->id, row->name, &count);

  PetscFunctionBegin;
  SamFileCheck(f, row->found, "cannot be read: it lacks the attribute %s of a %s of %s", row->name, kind->name,
               kind->writer);
  SamFileCheck(f, (class == H5T_FLOAT || class == H5T_INTEGER) && count == (hssize_t)row->size[0],
               "cannot be read: its attribute %s is not what %s writes", row->name, kind->writer);
  SamFileReadAttribute(f, f->id, row->name, H5T_NATIVE_DOUBLE, count, row->values);
  if (!f->failed) PetscCall(CheckNumbers(f, row->name, row, row->size[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the shape of a dataset as (8, 64, 64). */
static void PrintShape(int rank, const hsize_t size[], int grows, char text[], size_t most)
{
  size_t used = (size_t)snprintf(text, most, "(");

  for (int d = 0; d < rank && used < most; d++) {
    const PetscBool longer = d == 0 && grows, any = size[d] == SAM_ANY || (longer && !size[d]);

    used += (size_t)snprintf(text + used, most - used,
                             any      ? "%sany"
                             : longer ? "%s%llu or more"
                                      : "%s%llu",
                             d ? ", " : "", (unsigned long long)size[d]);
  }
  if (used < most) (void)snprintf(text + used, most - used, ")");
}

/* Checks the shape of a dataset, and replaces the sizes of the row by those found. */
static PetscErrorCode CheckShape(SamFile f, const char name[], SamExpected *row, hid_t space)
{
  const int rank                  = H5Sget_simple_extent_ndims(space);
  hsize_t   found[SAM_SHAPE_RANK] = {0};
  PetscBool fits = rank <= SAM_SHAPE_RANK && H5Sget_simple_extent_dims(space, found, NULL) == row->rank;
  char      has[160], expected[160];

  PetscFunctionBegin;
  (void)H5Sclose(space);
  for (int d = 0; d < row->rank && fits; d++) {
    if (d == 0 && row->grows)
      fits = found[d] >= row->size[d];
    else if (row->size[d] == SAM_ANY)
      fits = found[d] > 0 && found[d] <= row->longest;
    else
      fits = found[d] == row->size[d];
  }
  PrintShape(PetscMin(rank, SAM_SHAPE_RANK), found, 0, has, sizeof(has));
  PrintShape(row->rank, row->size, row->grows, expected, sizeof(expected));
  SamFileCheck(f, fits, "%s has a shape that does not fit the others: %s, expected %s: make the file anew", name, has,
               expected);
  for (int d = 0; d < row->rank; d++) row->size[d] = found[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ExamineDataset(SamFile f, const SamFileKind *kind, const char name[], SamExpected *row)
{
  const hid_t dataset = H5Dopen2(f->id, name, H5P_DEFAULT), type = dataset >= 0 ? H5Dget_type(dataset) : -1;
  const H5T_class_t class = type >= 0 ? H5Tget_class(type) : H5T_NO_CLASS;
  const hsize_t rows      = row->grows ? row->size[0] : 0;
  hsize_t       count     = 1, extent[SAM_SHAPE_RANK];

  PetscFunctionBegin;
  SamFileCheck(f, dataset >= 0, "has no dataset %s: make the file by %s", name, kind->writer);
  SamFileCheck(f, class == H5T_FLOAT || class == H5T_INTEGER, "%s is not what %s writes: make the file anew", name,
               kind->writer);
  PetscCall(CheckShape(f, name, row, H5Dget_space(dataset)));
  for (int d = 0; d < row->rank; d++) count *= extent[d] = d == 0 && row->grows ? rows : row->size[d];
  SamFileCheck(f,
               count == 0 || (SamFileIsWhole(f, dataset, extent, PETSC_TRUE) &&
                              (!row->values ||
                               H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, row->values) >= 0)),
               "the numbers of %s cannot be read: the file is damaged", name);
  if (row->values) PetscCall(CheckNumbers(f, name, row, count));
  (void)H5Tclose(type);
  (void)H5Dclose(dataset);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFileExpect(SamFile f, const SamFileKind *kind, const char group[], PetscInt count, SamExpected rows[])
{
  PetscFunctionBegin;
  for (SamExpected *row = rows; row < rows + count; row++) {
    char name[SAM_EXPECT_NAME];

    (void)snprintf(name, sizeof(name), "%s%s", group, row->name);
    row->found = (row->rank < 0 ? H5Aexists(f->id, row->name) : H5Lexists(f->id, name, H5P_DEFAULT)) > 0;
    if (row->rank == SAM_TEXT) {
      char *const text = (char *)row->values;

      if (!SamTextRead(f->id, row->name, text, row->size[0]) || strlen(text) + 1 == row->size[0]) text[0] = '\0';
    } else if (row->found || !row->optional)
      PetscCall(row->rank < 0 ? ExamineAttribute(f, kind, row) : ExamineDataset(f, kind, name, row));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
