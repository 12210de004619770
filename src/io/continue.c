/*
  Results that continue where a run was stopped.

  A run may have been killed in the middle of a step. The steps that it has reported can be read (steps.c), but HDF5's
  indices may be in an inconsistent state, and nothing should be appended to those; it may also hold more steps than
  the checkpoint. So the wanted steps are copied to a new file beside it, which takes its name when it is complete.
*/
#include "ioimpl.h"
#include <string.h>

#define STEP_BYTES 4096 /* more than the numbers of a step and its part of HDF5's indices take */

/* What the file must hold. */
typedef struct {
  SamGrid                  grid;
  const SamOutputSettings *set;
  const SamParameters     *parameters;
  SamOutputPoint           point;
} Wanted;

/* ---- examination, by one rank ---- */

#define REFUSED "-%s %s: cannot continue: " /* option, file */

/* A file must begin where the results of the checkpoint's run do. */
static PetscErrorCode CheckBranch(SamFile f, const Wanted *wanted)
{
  double first = 0;

  PetscFunctionBegin;
  if (SamFileHasAttribute(f, SAM_OUTPUT_BRANCH))
    SamFileReadAttribute(f, f->id, SAM_OUTPUT_BRANCH, H5T_NATIVE_DOUBLE, 1, &first);
  PetscCheck(f->failed || first == (double)wanted->point.first, f->comm, SAM_ERR_USER,
             REFUSED "its first step is number %.0f, and that of the checkpoint's results is %ld: remove it, or give "
                     "another name, to begin a file with the steps after the checkpoint",
             f->option, f->filename, first + 1, (long)wanted->point.first + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The number of steps in a dataset. */
static hsize_t Length(SamOutput o, hid_t dataset)
{
  hsize_t size[SAM_SHAPE_RANK];

  (void)SamFileGetSize(o->f, dataset, 0, size);
  return size[0];
}

/* Rows of a series that all of its columns have; 0 where there is none. */
static hsize_t CountRows(SamOutput o, SamSeries kind)
{
  hsize_t rows = o->columns[kind][0] >= 0 ? HSIZE_UNDEF : 0;

  for (PetscInt c = 0; c < SAM_STATE_DECLARED; c++)
    if (o->columns[kind][c] >= 0) rows = PetscMin(rows, Length(o, o->columns[kind][c]));
  return rows;
}

uint64_t SamOutputAddTime(uint64_t times, PetscReal time)
{
  return SamHashMix(times + SamHashBits(time));
}

/* Compares the times with those of the stopped run, and counts the fields that belong to the wanted steps. */
static PetscErrorCode CompareTimes(SamOutput o, const Wanted *wanted, hsize_t *keep)
{
  const hsize_t steps = (hsize_t)wanted->point.steps;
  hsize_t       saved = Length(o, o->time);
  uint64_t      times = 0;
  double       *stored, last = 0;

  PetscFunctionBegin;
  for (PetscInt f = 0; f < SamOutputCount(o); f++)
    if (o->fields[f] >= 0) saved = PetscMin(saved, Length(o, o->fields[f]));
  PetscCall(PetscCalloc1(PetscMax(steps, saved), &stored));
  SamOutputReadSeries(o, o->columns[SAM_SERIES_HISTORY][0], H5T_NATIVE_DOUBLE, 0, steps, stored);
  for (hsize_t k = 0; k < steps; k++) times = SamOutputAddTime(times, stored[k]);
  if (steps) last = stored[steps - 1];
  SamOutputReadSeries(o, o->time, H5T_NATIVE_DOUBLE, 0, saved, stored);
  for (*keep = 0; *keep < saved && steps && stored[*keep] <= last; (*keep)++) continue;
  PetscCall(PetscFree(stored));
  PetscCheck(times == wanted->point.times || o->f->failed, o->f->comm, SAM_ERR_USER,
             REFUSED "its times differ from those of the load history (-history, -steps)", o->f->option,
             o->f->filename);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether all fields of the steps that are kept lie within the file. */
static void CheckFields(SamOutput o, hsize_t keep)
{
  for (PetscInt f = 0; f < SamOutputCount(o) && !o->f->failed; f++) {
    hsize_t extent[3];

    if (o->fields[f] < 0) continue;
    (void)SamFileGetSize(o->f, o->fields[f], 3, extent);
    if (SamOutputResult(o, f)->kind != SAM_FIELD_POINTS &&
        (extent[1] != (hsize_t)o->grid->ny || extent[2] != (hsize_t)o->grid->nx))
      (void)SamFileNote(o->f, -1);
    extent[0] = keep;
    if (!SamFileIsWhole(o->f, o->fields[f], extent, PETSC_TRUE)) (void)SamFileNote(o->f, -1);
  }
}

/* A field of the file that the contact does not offer; empty: none. Its values would end here. */
static void FindMissing(SamOutput o, char name[], size_t size)
{
  H5G_info_t info;

  if (H5Gget_info(o->f->id, &info) < 0) info.nlinks = 0;
  for (hsize_t k = 0; k < info.nlinks; k++) {
    hid_t     object, space;
    PetscBool field;

    (void)H5Lget_name_by_idx(o->f->id, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, size, H5P_DEFAULT);
    object = H5Oopen(o->f->id, name, H5P_DEFAULT);
    space  = object >= 0 && H5Iget_type(object) == H5I_DATASET ? H5Dget_space(object) : -1;
    field  = space >= 0 && H5Sget_simple_extent_ndims(space) == 3;
    if (space >= 0) (void)H5Sclose(space);
    if (object >= 0) (void)H5Oclose(object);
    if (field && SamStateFindResult(o->state[SAM_SERIES_HISTORY], name) < 0) return;
  }
  name[0] = '\0';
}

/* Examines a file whose datasets are open. */
static PetscErrorCode Check(SamOutput o, const Wanted *wanted, hsize_t *keep)
{
  const hsize_t steps = CountRows(o, SAM_SERIES_HISTORY), cycles = CountRows(o, SAM_SERIES_CYCLES);
  const SamFile f = o->f;
  char          text[192], missing[64];

  PetscFunctionBegin;
  if (f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!SamParametersDiffer(f, wanted->parameters, text, sizeof(text)), f->comm, SAM_ERR_USER, REFUSED "%s",
             f->option, f->filename, text);
  PetscCall(CheckBranch(f, wanted));
  FindMissing(o, missing, sizeof(missing));
  PetscCheck(!missing[0], f->comm, SAM_ERR_USER,
             REFUSED "it has the field %s, which neither the checkpoint nor this run has", f->option, f->filename,
             missing);
  if (f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(steps >= (hsize_t)wanted->point.steps && cycles >= (hsize_t)wanted->point.cycles, f->comm, SAM_ERR_FILE,
             REFUSED "it holds %ld of the %ld steps before the checkpoint", f->option, f->filename,
             (long)PetscMin(steps, (hsize_t)wanted->point.steps), (long)wanted->point.steps);
  PetscCall(CompareTimes(o, wanted, keep));
  CheckFields(o, *keep);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Answers how many steps with fields are among the wanted ones. */
static PetscErrorCode Look(SamFile f, const void *question, void *answer)
{
  const Wanted  *wanted = (const Wanted *)question;
  SamOutput      o;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamOutputAllocate(wanted->grid, f, wanted->set, &o));
  ierr = SamOutputOpenLayout(o);
  if (!ierr) ierr = Check(o, wanted, (hsize_t *)answer);
  PetscCall(SamOutputFree(&o));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- copying ---- */

/* Gives SamOutputAppend() the fields of another file. */
typedef struct {
  SamOutput output;
  hsize_t   index; /* of the saved step */
  double   *cells; /* room for this rank's values, doubles or bytes */
} FileFields;

static PetscErrorCode GetFileValues(SamOutput to, PetscInt f, void *context, const void **values)
{
  const FileFields *from = (const FileFields *)context;
  const hid_t       type = SamOutputResult(to, f)->kind == SAM_FIELD_STATE ? H5T_NATIVE_SCHAR : H5T_NATIVE_DOUBLE;

  PetscFunctionBegin;
  if (SamOutputResult(to, f)->kind == SAM_FIELD_POINTS) {
    PetscCall(SamOutputReadPoints(from->output, from->output->fields[f], from->index, &to->points));
    *values = &to->points;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SamFileReadFrame(from->output->f, from->output->fields[f], type, from->index, from->cells);
  *values = from->cells;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The times of the first steps with fields; the caller frees them. */
static PetscErrorCode ReadTimes(SamOutput o, hsize_t count, double **times)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(count, times));
  PetscCall(SamFileBegin(o->f));
  SamOutputReadSeries(o, o->time, H5T_NATIVE_DOUBLE, 0, count, *times);
  PetscCall(SamFileEnd(o->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the first steps with fields one by one, as a run would write them. */
static PetscErrorCode CopyFields(SamOutput from, hsize_t keep, SamOutput to)
{
  FileFields     fields = {.output = from};
  double        *times;
  PetscErrorCode ierr = 0;

  PetscFunctionBegin;
  PetscCall(ReadTimes(from, keep, &times));
  PetscCall(PetscMalloc1(PetscMax(from->grid->cells, 1), &fields.cells));
  for (; fields.index < keep && !ierr; fields.index++)
    ierr = SamOutputAppend(to, NULL, (PetscReal)times[fields.index], GetFileValues, &fields);
  PetscCall(PetscFree(fields.cells));
  PetscCall(PetscFree(times));
  PetscCall(ierr);
  PetscCall(SamFileBegin(from->f)); /* raises what failed when a field was read */
  PetscCall(SamFileEnd(from->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies what is wanted to a new file, which is complete then. */
static PetscErrorCode CopyAll(SamOutput from, const Wanted *wanted, hsize_t keep, SamOutput to)
{
  const hsize_t steps = (hsize_t)wanted->point.steps, cycles = (hsize_t)wanted->point.cycles;

  PetscFunctionBegin;
  PetscCall(SamOutputSetParameters(to, wanted->parameters));
  PetscCall(SamOutputCopyOrigin(from, to));
  PetscCall(SamFileReserve(to->f, (off_t)keep * SamOutputFieldBytes(to) + (off_t)(steps + cycles) * STEP_BYTES));
  to->copying = PETSC_TRUE;
  PetscCall(SamOutputCopySeries(to, SAM_SERIES_HISTORY, from, steps));
  PetscCall(SamOutputCopySeries(to, SAM_SERIES_CYCLES, from, cycles));
  PetscCall(CopyFields(from, keep, to));
  PetscCall(SamOutputEndCopy(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the copy, which is still open, the name of the results. */
static PetscErrorCode TakeName(SamOutput o, const char filename[])
{
  PetscFunctionBegin;
  PetscCall(SamFileReplace(o->grid, "output", o->f->filename, filename, NULL));
  PetscCall(PetscFree(o->f->filename));
  PetscCall(PetscStrallocpy(filename, &o->f->filename));
  o->hold.use = SAM_FILE_RESULTS;
  o->replaced = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the wanted steps to a new file, which replaces the old one. */
static PetscErrorCode Rewrite(SamOutput from, const Wanted *wanted, hsize_t keep, SamOutput *to)
{
  SamOutputSettings set = *wanted->set;
  char             *temporary;
  PetscErrorCode    ierr;

  PetscFunctionBegin;
  set.single = from->set.single;
  set.count  = 0;
  for (PetscInt f = 0; f < SamOutputCount(from); f++)
    if (from->wants[f])
      PetscCall(PetscStrncpy(set.names[set.count++], SamOutputResult(from, f)->name, SAM_OUTPUT_NAME));
  PetscCall(SamOutputNameTemporary(from->f->filename, &temporary));
  ierr = SamOutputCreateAs(from->grid, temporary, SAM_FILE_TEMPORARY, &set, to);
  if (!ierr) ierr = CopyAll(from, wanted, keep, *to);
  if (!ierr) ierr = TakeName(*to, from->f->filename);
  if (ierr) (void)SamOutputDestroy(to);
  PetscCall(PetscFree(temporary));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Opens the old file and writes it again. */
static PetscErrorCode OpenAndRewrite(const char filename[], const Wanted *wanted, SamOutput *to)
{
  hsize_t        keep;
  SamFile        file;
  SamOutput      from;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamFileExamine(wanted->grid->comm, "output", filename, Look, wanted, &keep, sizeof(keep)));
  PetscCall(SamFileOpen(wanted->grid, SAM_EVENT_OUTPUT, "output", filename, SAM_FILE_READ, &file));
  PetscCall(SamOutputAllocate(wanted->grid, file, wanted->set, &from));
  PetscCall(SamFileBegin(file));
  PetscCall(SamOutputOpenLayout(from));
  ierr = SamFileEnd(file);
  if (!ierr) ierr = Rewrite(from, wanted, keep, to);
  PetscCall(SamOutputDestroy(&from));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputContinue(SamGrid grid, const char filename[], const SamOutputSettings *set,
                                 const SamParameters *parameters, const SamOutputPoint *point, SamOutput *output)
{
  const Wanted   wanted = {grid, set, parameters, *point};
  SamHold        old;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *output = NULL;
  PetscCall(SamInitialize());
  PetscCall(SamHoldTake(grid, "output", filename, SAM_FILE_OLD_RESULTS, &old));
  ierr = OpenAndRewrite(filename, &wanted, output);
  SamHoldRelease(filename, &old);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
