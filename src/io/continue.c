/*
  Results that go on where a run was stopped.

  A run may have been killed in the middle of a step. The steps that it has reported can be read (output.c), but HDF5's
  indices may be in an inconsistent state, and nothing should be appended to those. So unless the file was closed
  properly, and has not been damaged since (structure.c), the wanted steps are copied to a new file beside it, which
  replaces it when it is complete.
*/
#include "ioimpl.h"
#include <string.h>

#define STEP_BYTES 4096 /* more than the numbers of a step and its part of HDF5's indices take */

/* What the file must hold. */
typedef struct {
  const SamParameters *parameters;
  SamOutputPoint       point;
} Wanted;

/* What was found in the file. */
typedef struct {
  hsize_t        rows[SAM_SERIES]; /* complete steps, and computed cycles */
  hsize_t        saved;            /* complete steps with fields */
  hsize_t        keep;             /* steps with fields among the wanted ones */
  PetscBool      whole;            /* with what is wanted and no more */
  char           problem[256];
  PetscErrorCode code; /* of the problem */
} Found;

/* Notes the first problem. */
static void Complain(Found *found, PetscErrorCode code, const char text[])
{
  if (!found->code) (void)snprintf(found->problem, sizeof(found->problem), "%s", text);
  if (!found->code) found->code = code;
}

/* A step is complete when all columns have it, and its fields when all of them have it. */
static void CountSteps(SamOutput o, Found *found)
{
  found->saved = SamOutputLength(o, o->time);
  for (PetscInt k = 0; k < SAM_SERIES; k++) {
    found->rows[k] = o->columns[k][0] >= 0 ? HSIZE_UNDEF : 0;
    for (PetscInt c = 0; c < SamOutputAllSeries[k].count; c++)
      if (o->columns[k][c] >= 0) found->rows[k] = PetscMin(found->rows[k], SamOutputLength(o, o->columns[k][c]));
  }
  for (PetscInt f = 0; f < SamOutputFieldCount; f++)
    if (o->fields[f] >= 0) found->saved = PetscMin(found->saved, SamOutputLength(o, o->fields[f]));
}

uint64_t SamOutputAddTime(uint64_t times, PetscReal time)
{
  return SamHashMix(times + SamHashBits(time));
}

/* Compares the times with those of the stopped run, and counts the fields that belong to the wanted steps. */
static PetscErrorCode CompareTimes(SamOutput o, const Wanted *wanted, Found *found)
{
  const hsize_t steps = (hsize_t)wanted->point.steps;
  uint64_t      times = 0;
  double       *stored, last = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(PetscMax(steps, found->saved), &stored));
  SamOutputReadSeries(o, o->columns[SAM_SERIES_HISTORY][0], H5T_NATIVE_DOUBLE, 0, steps, stored);
  for (hsize_t k = 0; k < steps; k++) times = SamOutputAddTime(times, stored[k]);
  if (times != wanted->point.times)
    Complain(found, SAM_ERR_USER, "its times differ from those of the load program (-history, -steps)");
  if (steps) last = stored[steps - 1];
  SamOutputReadSeries(o, o->time, H5T_NATIVE_DOUBLE, 0, found->saved, stored);
  for (found->keep = 0; found->keep < found->saved && steps && stored[found->keep] <= last; found->keep++)
    o->saved_time = stored[found->keep];
  PetscCall(PetscFree(stored));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the history has the columns of an option. */
static PetscBool Has(SamOutput o, PetscInt option)
{
  const SamOutputSeries *s = &SamOutputAllSeries[SAM_SERIES_HISTORY];

  for (PetscInt c = 0; c < s->count; c++)
    if ((PetscInt)s->columns[c].option == option && o->columns[SAM_SERIES_HISTORY][c] < 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Whether the history has all columns that are asked for. */
static PetscBool HasAllWanted(SamOutput o)
{
  for (PetscInt option = 0; option < SAM_OUTPUT_OPTIONS; option++)
    if (o->set.with[option] && !Has(o, option)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* A file must begin where the results of the checkpoint's run do. */
static void CompareBranches(SamOutput o, const Wanted *wanted, Found *found)
{
  double first = 0;
  char   text[192];

  if (SamFileNote(o->f, H5Aexists(o->f->id, SAM_OUTPUT_BRANCH)) > 0)
    SamFileReadAttribute(o->f, o->f->id, SAM_OUTPUT_BRANCH, H5T_NATIVE_DOUBLE, 1, &first);
  if (o->f->failed || first == (double)wanted->point.first) return;
  (void)snprintf(text, sizeof(text),
                 "its first step is number %.0f, and that of the checkpoint's results is %ld: remove it, or give "
                 "another name, to begin a file with the steps after the checkpoint",
                 first + 1, (long)wanted->point.first + 1);
  Complain(found, SAM_ERR_USER, text);
}

/* Examines a file that is open. */
static PetscErrorCode Look(SamOutput o, const Wanted *wanted, Found *found)
{
  hsize_t     steps, cycles;
  char        text[192];
  const char *missing;

  PetscFunctionBegin;
  SamOutputOpenLayout(o);
  if (o->f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  if (SamParametersDiffer(o->f, wanted->parameters, text, sizeof(text))) Complain(found, SAM_ERR_USER, text);
  CompareBranches(o, wanted, found);
  PetscCall(SamOutputFindMissing(o, &missing));
  if (missing)
    (void)snprintf(text, sizeof(text), "it has %s, a sum over all steps, and the checkpoint has not", missing);
  if (missing) Complain(found, SAM_ERR_USER, text);
  CountSteps(o, found);
  if (o->f->failed || found->code) PetscFunctionReturn(PETSC_SUCCESS);
  steps  = found->rows[SAM_SERIES_HISTORY];
  cycles = found->rows[SAM_SERIES_WEAR];
  if (steps < (hsize_t)wanted->point.steps || cycles < (hsize_t)wanted->point.cycles) {
    (void)snprintf(text, sizeof(text), "it holds %ld of the %ld steps before the checkpoint",
                   (long)PetscMin(steps, (hsize_t)wanted->point.steps), (long)wanted->point.steps);
    Complain(found, SAM_ERR_FILE, text);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CompareTimes(o, wanted, found));
  found->whole = steps == (hsize_t)wanted->point.steps && cycles == (hsize_t)wanted->point.cycles &&
                 found->saved == found->keep && HasAllWanted(o);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Opens and examines the file. After an error nothing is open. */
static PetscErrorCode Open(SamGrid grid, const char filename[], SamFileMode mode, const SamOutputSettings *set,
                           const Wanted *wanted, SamOutput *output, Found *found)
{
  SamFile        file;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(found, sizeof(*found)));
  PetscCall(SamFileOpen(grid, SAM_EVENT_OUTPUT, "output", filename, mode, &file));
  PetscCall(SamOutputAllocate(file, set, output));
  PetscCall(SamFileBegin(file));
  PetscCall(Look(*output, wanted, found));
  ierr = SamFileEnd(file);
  if (ierr || found->code) {
    (*output)->unchanged = PETSC_TRUE;
    (void)SamOutputDestroy(output);
  }
  PetscCall(ierr);
  PetscCheck(!found->code, grid->comm, found->code, "-output %s: cannot go on: %s", filename, found->problem);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- before the ranks open the file ---- */

/* Whether all chunks of the steps that are kept lie within the file. */
static void CheckChunks(SamOutput o, hsize_t keep)
{
  for (PetscInt f = 0; f < SamOutputFieldCount && !o->f->failed; f++) {
    hsize_t extent[] = {keep, (hsize_t)o->f->grid->ny, (hsize_t)o->f->grid->nx};

    if (o->fields[f] >= 0 && SamOutputFields[f].kind == SAM_FIELD_POINTS) SamOutputGetPointsExtent(o, f, &extent[1]);
    if (o->fields[f] >= 0 && !SamChunksAreWhole(o->f->id, o->fields[f], 3, extent, PETSC_TRUE))
      (void)SamFileNote(o->f, -1);
  }
}

typedef struct {
  SamGrid                  grid; /* of one rank */
  const char              *filename;
  const SamOutputSettings *set;
  const Wanted            *wanted;
  PetscBool                sealed; /* closed properly, and its structure is as it was then */
  PetscErrorCode           code;
  char                     message[SAM_MESSAGE];
} Case;

static PetscErrorCode LookAtAll(const Case *c)
{
  SamOutput o;
  Found     found;

  PetscFunctionBegin;
  PetscCall(Open(c->grid, c->filename, SAM_FILE_READ_ALONE, c->set, c->wanted, &o, &found));
  PetscCall(SamFileBegin(o->f));
  if (!c->sealed) CheckChunks(o, found.keep);
  PetscCall(SamFileEnd(o->f));
  PetscCall(SamOutputDestroy(&o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void LookInChild(void *data)
{
  Case *c = (Case *)data;

  (void)PetscPushErrorHandler(SamKeepMessage, c->message);
  c->sealed = SamStructureIsSealed(c->filename);
  c->code   = LookAtAll(c);
}

/*
  Rank 0 looks at all that will be read but the fields themselves, in a child process. `sealed`: the file may be
  appended to. Collective.
*/
static PetscErrorCode LookBefore(SamGrid grid, const char filename[], const SamOutputSettings *set,
                                 const Wanted *wanted, PetscBool *sealed)
{
  const PetscInt  n[2]     = {grid->nx, grid->ny};
  const PetscReal width[2] = {grid->nx * grid->dx, grid->ny * grid->dy}, center[2] = {0, 0};
  Case            c = {.filename = filename, .set = set, .wanted = wanted};
  PetscMPIInt     rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (rank == 0) {
    PetscCall(SamGridCreate(PETSC_COMM_SELF, n, width, center, &c.grid));
    if (!SamCallInChild(LookInChild, &c, sizeof(c))) {
      c.code = SAM_ERR_FILE;
      (void)snprintf(c.message, sizeof(c.message), "-output %s: cannot be read: it is damaged", filename);
    }
    PetscCall(SamGridDestroy(&c.grid));
  }
  PetscCallMPI(MPI_Bcast(&c.code, (PetscMPIInt)sizeof(c.code), MPI_BYTE, 0, grid->comm));
  PetscCallMPI(MPI_Bcast(c.message, (PetscMPIInt)sizeof(c.message), MPI_CHAR, 0, grid->comm));
  PetscCallMPI(MPI_Bcast(&c.sealed, (PetscMPIInt)sizeof(c.sealed), MPI_BYTE, 0, grid->comm));
  PetscCheck(!c.code, grid->comm, c.code, "%s", c.message);
  *sealed = c.sealed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- copying ---- */

/* Reads a row of a series into a SamStep or SamLifeReport; an optional column that is not there leaves its default. */
static void ReadRow(SamOutput o, SamOutputSeriesKind kind, hsize_t k, void *row)
{
  const SamOutputSeries *s = &SamOutputAllSeries[kind];

  for (PetscInt c = 0; c < s->count; c++) {
    char *const place = (char *)row + s->columns[c].offset;
    const hid_t from  = o->columns[kind][c];
    double      real  = 0;
    int64_t     whole = 0;

    if (from < 0 && s->columns[c].kind == SAM_COLUMN_MATRIX)
      for (PetscInt n = 0; n < SAM_COMPONENTS * SAM_COMPONENTS; n++) ((PetscReal *)place)[n] = NAN;
    if (from < 0) continue;
    switch (s->columns[c].kind) {
    case SAM_COLUMN_REAL:
      SamOutputReadSeries(o, from, H5T_NATIVE_DOUBLE, k, 1, &real);
      *(PetscReal *)place = (PetscReal)real;
      break;
    case SAM_COLUMN_INT:
      SamOutputReadSeries(o, from, H5T_NATIVE_INT64, k, 1, &whole);
      *(PetscInt *)place = (PetscInt)whole;
      break;
    case SAM_COLUMN_STATUS:
      SamOutputReadSeries(o, from, H5T_NATIVE_INT64, k, 1, &whole);
      *(SamStatus *)place = (SamStatus)whole;
      break;
    case SAM_COLUMN_MATRIX:
      SamOutputReadSeries(o, from, H5T_NATIVE_DOUBLE, k, 1, place);
      break;
    }
  }
}

/* Gives SamOutputAppend() the fields of another file. */
typedef struct {
  SamOutput output;
  hsize_t   index; /* of the saved step */
  double   *cells; /* room for this rank's values, doubles or bytes */
} FileFields;

static PetscErrorCode GetFileValues(SamOutput to, PetscInt f, void *context, const void **values)
{
  const FileFields *from = (const FileFields *)context;
  const hid_t       type = SamOutputFields[f].kind == SAM_FIELD_STATE ? H5T_NATIVE_SCHAR : H5T_NATIVE_DOUBLE;

  PetscFunctionBegin;
  if (SamOutputFields[f].kind == SAM_FIELD_POINTS) {
    PetscCall(SamOutputReadPoints(from->output, from->output->fields[f], from->index, &to->points));
    *values = &to->points;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SamFileReadLayer(from->output->f, from->output->fields[f], type, from->index, from->cells);
  *values = from->cells;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the steps one by one, as a run would write them. */
static PetscErrorCode CopySteps(SamOutput from, hsize_t steps, hsize_t keep, SamOutput to, double cells[])
{
  FileFields fields = {.output = from, .cells = cells};

  PetscFunctionBegin;
  for (hsize_t k = 0; k < steps; k++) {
    SamStep   step;
    double    time = 0;
    PetscBool has;

    PetscCall(PetscMemzero(&step, sizeof(step)));
    PetscCall(SamControlInitialize(&step.control));
    PetscCall(SamFileBegin(from->f));
    ReadRow(from, SAM_SERIES_HISTORY, k, &step);
    if (fields.index < keep) SamOutputReadSeries(from, from->time, H5T_NATIVE_DOUBLE, fields.index, 1, &time);
    PetscCall(SamFileEnd(from->f));
    has = fields.index < keep && time == (double)step.control.time;
    PetscCall(SamOutputAppend(to, &step, step.control.time, has ? GetFileValues : NULL, &fields));
    fields.index += has ? 1 : 0;
  }
  PetscCall(SamFileBegin(from->f)); /* raises what failed when a field was read */
  PetscCall(SamFileEnd(from->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyCycles(SamOutput from, hsize_t cycles, SamOutput to)
{
  PetscFunctionBegin;
  for (hsize_t k = 0; k < cycles; k++) {
    SamLifeReport cycle;

    PetscCall(PetscMemzero(&cycle, sizeof(cycle)));
    PetscCall(SamFileBegin(from->f));
    ReadRow(from, SAM_SERIES_WEAR, k, &cycle);
    PetscCall(SamFileEnd(from->f));
    PetscCall(SamOutputAppendCycle(to, &cycle));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CopyAll(SamOutput from, const Wanted *wanted, hsize_t keep, SamOutput to)
{
  double        *cells;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamOutputSetParameters(to, wanted->parameters));
  PetscCall(SamOutputCopyOrigin(from, to));
  PetscCall(SamFileReserve(to->f, (off_t)keep * SamOutputFieldBytes(to->f->grid, &to->set) +
                                    (off_t)(wanted->point.steps + wanted->point.cycles) * STEP_BYTES));
  to->copying = PETSC_TRUE;
  PetscCall(PetscMalloc1(PetscMax(from->f->grid->cells, 1), &cells));
  ierr = CopySteps(from, (hsize_t)wanted->point.steps, keep, to, cells);
  if (!ierr) ierr = CopyCycles(from, (hsize_t)wanted->point.cycles, to);
  PetscCall(PetscFree(cells));
  if (!ierr) ierr = SamOutputFlush(to);
  PetscCall(ierr);
  PetscCall(SamFileBegin(to->f));
  (void)SamFileNote(to->f, H5Fflush(to->f->id, H5F_SCOPE_GLOBAL));
  PetscCall(SamFileEnd(to->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the wanted steps to a new file. */
static PetscErrorCode WriteCopy(SamOutput from, const SamOutputSettings *set, const Wanted *wanted, hsize_t keep,
                                const char temporary[])
{
  SamOutputSettings plain = *set;
  SamOutput         to;
  PetscErrorCode    ierr;

  PetscFunctionBegin;
  plain.xdmf   = PETSC_FALSE;
  plain.single = from->set.single;
  PetscCall(PetscArraycpy(plain.fields, from->set.fields, SAM_OUTPUT_MOST));
  for (PetscInt k = 0; k < SAM_OUTPUT_OPTIONS; k++) plain.with[k] = set->with[k] || Has(from, k);
  PetscCall(SamOutputCreateAs(from->f->grid, temporary, SAM_FILE_TEMPORARY, &plain, &to));
  ierr = CopyAll(from, wanted, keep, to);
  if (ierr) (void)SamOutputDestroy(&to);
  PetscCall(ierr);
  to->hold.use = SAM_FILE_RESULTS; /* it is complete, and gets its name now */
  PetscCall(SamOutputDestroy(&to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the wanted steps to a new file, which replaces the old one. */
static PetscErrorCode Rewrite(SamOutput from, const SamOutputSettings *set, const Wanted *wanted, hsize_t keep)
{
  char          *xdmf, *temporary;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamOutputNames(from->f->filename, &xdmf, &temporary));
  ierr = WriteCopy(from, set, wanted, keep, temporary);
  if (!ierr) ierr = SamFileReplace(from->f->grid, "output", temporary, from->f->filename, NULL);
  PetscCall(PetscFree(xdmf));
  PetscCall(PetscFree(temporary));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- going on ---- */

/* Writes the XDMF file again: it may be missing, or describe steps that are no longer there. */
static PetscErrorCode RewriteXdmf(SamOutput o)
{
  double *times;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(o->saved, &times));
  PetscCall(SamFileBegin(o->f));
  SamOutputReadSeries(o, o->time, H5T_NATIVE_DOUBLE, 0, o->saved, times);
  PetscCall(SamFileEnd(o->f));
  PetscCall(SamXdmfCreate(o->f->grid, o->f->filename, &o->set, &o->xdmf));
  for (hsize_t k = 0; k < o->saved; k++) PetscCall(SamXdmfAddStep(o->xdmf, (PetscInt)k, (PetscReal)times[k]));
  PetscCall(PetscFree(times));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the file as not closed, in case the run is killed. */
static PetscErrorCode MarkOpen(SamOutput o)
{
  const int8_t closed = 0;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  (void)SamFileNote(o->f, H5Awrite(o->closed, H5T_NATIVE_INT8, &closed));
  (void)SamFileNote(o->f, H5Fflush(o->f->id, H5F_SCOPE_GLOBAL));
  SamOutputMark(o);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Opens the file, or first writes it again; `hold` is of the file that is there at the end. */
static PetscErrorCode OpenOrRewrite(SamGrid grid, const char filename[], const SamOutputSettings *set,
                                    const Wanted *wanted, SamHold *hold, SamOutput *output)
{
  Found          found;
  PetscBool      sealed;
  PetscErrorCode ierr = 0;

  PetscFunctionBegin;
  PetscCall(SamHoldTake(grid, "output", filename, SAM_FILE_OLD_RESULTS, hold));
  PetscCall(LookBefore(grid, filename, set, wanted, &sealed));
  PetscCall(Open(grid, filename, SAM_FILE_READ, set, wanted, output, &found));
  if (!found.whole || !sealed) ierr = Rewrite(*output, set, wanted, found.keep);
  PetscCall(SamOutputDestroy(output));
  PetscCall(ierr);
  if (!found.whole || !sealed) PetscCall(SamHoldTakeNext(grid, "output", filename, hold));
  PetscCall(Open(grid, filename, SAM_FILE_APPEND, set, wanted, output, &found));
  PetscCheck(found.whole, grid->comm, SAM_ERR_FILE, "-output %s: cannot go on: it is being changed by another program",
             filename);
  PetscCall(PetscArraycpy((*output)->rows, found.rows, SAM_SERIES));
  (*output)->saved = found.saved;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputContinue(SamGrid grid, const char filename[], const SamOutputSettings *set,
                                 const SamParameters *parameters, const SamOutputPoint *point, SamOutput *output)
{
  const Wanted   wanted = {parameters, *point};
  SamHold        hold   = {.file = -1};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *output = NULL;
  PetscCall(SamInitialize());
  ierr = OpenOrRewrite(grid, filename, set, &wanted, &hold, output);
  if (ierr) SamHoldRelease(filename, &hold);
  PetscCall(ierr);
  (*output)->hold = hold;
  PetscCall(MarkOpen(*output));
  if (set->xdmf) PetscCall(RewriteXdmf(*output));
  PetscFunctionReturn(PETSC_SUCCESS);
}
