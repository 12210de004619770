/*
  Results in an HDF5 file, written by all ranks together.

  Datasets stay open and grow along time (steps.c); each rank writes its rows of the cells.
*/
#include "ioimpl.h"
#include <petsam/private/motionimpl.h>
#include <petsam/private/base.h>
#include <petsam/private/law.h>
#include <petsam/private/problem.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* ---- options ---- */

/* Keywords for the help, which is printed before there is a contact. */
#define WORDS \
  "all,none,pressure,shear_x,shear_y,displacement_z,displacement_x,displacement_y,slip_x,slip_y,gap,state," \
  "slip_aside_x,slip_aside_y,pressure_center,shear_center_x,shear_center_y,contact_edge,stick_" \
  "edge," SAM_LAW_ACCUMULATED_SLIP "," SAM_LAW_FRICTION_ENERGY ",plastic,usual"

/* Reads -output_fields: names separated by commas and blanks. */
static PetscErrorCode ReadFieldNames(SamOutputSettings *set, const SamOptions *from)
{
  static const SamOptionRow row        = {"output_fields", "fields to be saved by their names, all, usual, or none",
                                          SAM_OPTION_WORDS, .size = 1024, .words = WORDS};
  char                      text[1024] = "", **list;
  PetscBool                 given;
  int                       count;

  PetscFunctionBegin;
  set->count = -1;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, text, &given));
  if (!given) PetscFunctionReturn(PETSC_SUCCESS);
  for (char *c = text; *c; c++) *c = *c == ' ' ? ',' : *c;
  PetscCall(PetscStrToArray(text, ',', &count, &list));
  set->count = PetscMin(count, SAM_STATE_MOST);
  for (PetscInt k = 0; k < set->count; k++) (void)snprintf(set->names[k], sizeof(set->names[k]), "%s", list[k]);
  if (set->count == 1 && !strcmp(set->names[0], "none")) set->count = 0;
  PetscCall(PetscStrToArrayDestroy(count, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MEMBER(name) offsetof(SamOutputSettings, name)
static const SamOptionRow rows[] = {{"output_compress", "level of compression of the fields, 0 (none) to 9",
                                     SAM_OPTION_INT, MEMBER(compress), .needs = SAM_OUTPUT_NEEDED, .most = 9},
                                    {"output_chunk", "most cells of a chunk of the file in x[,y]", SAM_OPTION_INT,
                                     MEMBER(chunk), .needs = SAM_OUTPUT_NEEDED, .least = 1, .size = 2},
                                    {"output_single", "fields in single precision: files of half the size",
                                     SAM_OPTION_BOOL, MEMBER(single), .needs = SAM_OUTPUT_NEEDED}};

PetscErrorCode SamOutputSettingsSetFromOptions(SamOutputSettings *set, const SamOptions *from)
{
  PetscFunctionBegin;
  *set = (SamOutputSettings){.compress = 0, .chunk = {1024, 256}};
  PetscCall(ReadFieldNames(set, from));
  PetscCall(SamOptionsRead(from, NULL, SAM_OPTION_ROWS(rows), set, NULL));
  PetscCheck(set->compress == 0 || H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0, from->comm, SAM_ERR_USER,
             "-%soutput_compress %" PetscInt_FMT ": this HDF5 was built without zlib", SamOptionsPrefix(from),
             set->compress);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if a keyword of -output_fields is a field's name, or the name of its group. */
static PetscBool Means(const char word[], const char name[])
{
  const size_t group = strcspn(name, "/");

  return !strcmp(word, name) || (name[group] && strlen(word) == group && !strncmp(word, name, group));
}

static PetscBool Names(const SamOutputSettings *set, const char name[])
{
  for (PetscInt k = 0; k < set->count; k++)
    if (Means(set->names[k], name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* True if a keyword of -output_fields selects any field. */
static PetscBool Knows(SamState state, const char word[])
{
  if (!strcmp(word, "all") || !strcmp(word, "usual")) return PETSC_TRUE;
  for (PetscInt f = 0; f < SamStateCountResults(state); f++)
    if (Means(word, SamStateResultOf(state, f)->name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SamOutputSettingsAddLaws(SamOutputSettings *set, SamProblem problem)
{
  const SamLawType *types;
  PetscInt          count;

  PetscFunctionBegin;
  set->sums = PETSC_TRUE;
  PetscCall(SamLawGetTypes(&count, &types));
  for (PetscInt k = 0; k < count; k++)
    if (Names(set, types[k]) || (Names(set, "all") && SamMotionOf(SamProblemGetElasticity(problem))->continues))
      PetscCall(SamProblemAddSum(problem, types[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the available names, also of sums (`sum`), which are computed only if named, separated by commas. */
static void ListFields(SamState state, PetscBool sum, char names[], size_t size)
{
  static const char *const sums[] = {SAM_LAW_ACCUMULATED_SLIP, SAM_LAW_FRICTION_ENERGY};

  const PetscInt        count   = SamStateCountResults(state);
  const SamStateLayers *grouped = NULL;
  size_t                used    = 0;

  names[0] = '\0';
  for (PetscInt f = 0; f < count + (sum ? 2 : 0) && used < size; f++) {
    const char *name = f < count ? SamStateResultOf(state, f)->name : sums[f - count];

    if (f < count && SamStateResultOf(state, f)->kind == SAM_FIELD_LAYERS) {
      if (grouped != SamStateLayersOf(state, name))
        used += (size_t)snprintf(names + used, size - used, ", %.*s", (int)strcspn(name, "/"), name);
      grouped = SamStateLayersOf(state, name);
    } else if (f < count || SamStateFindResult(state, name) < 0)
      used += (size_t)snprintf(names + used, size - used, "%s%s", f ? ", " : "", name);
  }
}

PetscErrorCode SamOutputSettingsPrepare(SamOutputSettings *set, SamContact contact, const SamOptions *from)
{
  SamState state;
  char     names[1024];

  PetscFunctionBegin;
  set->contact = contact;
  PetscCall(SamContactGetState(contact, &state));
  ListFields(state, set->sums, names, sizeof(names));
  for (PetscInt k = 0; k < set->count; k++)
    PetscCheck(Knows(state, set->names[k]), from->comm, SAM_ERR_USER,
               "-%soutput_fields: unknown field %s; one or more of %s, separated by commas, or all, usual, or none",
               SamOptionsPrefix(from), set->names[k], names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the file ---- */

/* Chooses the results of the state that are saved. */
static void Choose(SamOutput o)
{
  const PetscBool all = Names(&o->set, "all"), usual = o->set.count < 0 || Names(&o->set, "usual");

  for (PetscInt f = 0; f < SamOutputCount(o); f++) {
    const SamStateResult *r = SamOutputResult(o, f);

    o->wants[f] = all || (usual && r->use == SAM_RESULT_USUAL) || Names(&o->set, r->name);
  }
}

PetscErrorCode SamOutputAllocate(SamGrid grid, SamFile file, const SamOutputSettings *set, SamOutput *output)
{
  SamOutput o;

  PetscFunctionBegin;
  PetscCall(PetscNew(&o));
  PetscCall(SamGridReference(grid));
  o->grid                       = grid;
  o->f                          = file;
  o->set                        = *set;
  o->series[SAM_SERIES_HISTORY] = "history";
  o->series[SAM_SERIES_CYCLES]  = set->cycles_name;
  o->state[SAM_SERIES_CYCLES]   = set->cycles;
  PetscCall(SamContactGetState(set->contact, &o->state[SAM_SERIES_HISTORY]));
  for (PetscInt k = 0; k < SAM_SERIES; k++)
    if (o->state[k]) o->values[k] = SamStateCountValues(o->state[k]);
  Choose(o);
  o->time = o->point = o->vtk_steps = o->closed = -1;
  o->hold.file                                  = -1;
  o->saved_time                                 = PETSC_NINFINITY;
  o->flushed = o->called = MPI_Wtime();
  for (PetscInt f = 0; f < SAM_STATE_MOST; f++) o->fields[f] = -1;
  for (PetscInt k = 0; k < SAM_SERIES; k++)
    for (PetscInt c = 0; c < SAM_STATE_DECLARED; c++) o->columns[k][c] = -1;
  PetscCall(SamOutputCreateFrames(o));
  *output = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputFree(SamOutput *output)
{
  SamOutput o = *output;

  PetscFunctionBegin;
  *output = NULL;
  PetscCall(SamGridDestroy(&o->grid));
  PetscCall(VecDestroy(&o->work));
  PetscCall(SamOutputDestroyFrames(o));
  PetscCall(PetscFree(o->waiting));
  PetscCall(PetscFree(o->name));
  PetscCall(PetscFree(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the file as closed, as the last change: a file without the mark was left by a run that did not reach its
   end. */
static void MarkClosed(SamOutput o)
{
  const int8_t closed = 1;

  if (o->closed >= 0) (void)SamFileNote(o->f, H5Awrite(o->closed, H5T_NATIVE_INT8, &closed));
}

/* Closes the file, unless a write has failed, and frees the object. */
static PetscErrorCode Close(SamOutput *output)
{
  SamOutput      o = *output;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *output      = NULL;
  o->f->failed = PETSC_FALSE; /* earlier failures have been raised */
  PetscCall(SamFileBegin(o->f));
  if (!o->broken) {
    MarkClosed(o);
    SamFileClose(o->f);
  }
  ierr = SamFileEnd(o->f);
  SamFileLockRelease(o->f->filename, &o->hold);
  PetscCall(SamFileDestroy(&o->f, PETSC_FALSE));
  PetscCall(SamOutputFree(&o));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates a number that no other file has. */
static PetscErrorCode MakeIdentity(SamOutput o)
{
  struct timespec now;

  PetscFunctionBegin;
  (void)clock_gettime(CLOCK_REALTIME, &now);
  o->identity = SamHashMix((uint64_t)now.tv_sec + SamHashMix((uint64_t)now.tv_nsec + SamHashMix((uint64_t)getpid())));
  PetscCallMPI(MPI_Bcast(&o->identity, 1, MPI_UINT64_T, 0, o->grid->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the file under a temporary name. */
static PetscErrorCode CreateFile(SamOutput o, const char filename[])
{
  const SamFileGrowth growth = SamOutputGrowth(o);
  char               *temporary;
  double              bytes;
  PetscErrorCode      ierr;

  PetscFunctionBegin;
  PetscCall(PetscStrallocpy(filename, &o->name));
  PetscCall(MakeIdentity(o));
  PetscCall(SamFileCheckName(o->grid, "output", filename, SAM_FILE_RESULTS));
  PetscCall(SamFileGetBytes(o->grid->comm, filename, &bytes));
  o->replaced = bytes > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(SamFileNameTemporary(filename, &temporary));
  ierr = SamFileLockTake(o->grid, "output", temporary, SAM_FILE_TEMPORARY, &o->hold);
  if (!ierr) ierr = SamFileOpen(o->grid, SAM_EVENT_OUTPUT, "output", temporary, SAM_FILE_CREATE, &growth, &o->f);
  if (ierr) SamFileLockRelease(temporary, &o->hold);
  PetscCall(PetscFree(temporary));
  PetscCall(ierr);
  PetscCall(SamFileBegin(o->f));
  PetscCall(SamOutputCreateLayout(o));
  PetscCall(SamFileEnd(o->f));
  SamFileLockNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], const SamOutputSettings *set, SamOutput *output)
{
  SamOutput      o;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *output = NULL;
  PetscCall(SamBaseInitialize());
  PetscCall(SamOutputAllocate(grid, NULL, set, &o));
  ierr = CreateFile(o, filename);
  if (!ierr)
    *output = o;
  else if (o->f)
    (void)Close(&o);
  else
    PetscCall(SamOutputFree(&o));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputPlan(SamGrid grid, const SamOutputSettings *set, SamOutput *output)
{
  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(SamOutputAllocate(grid, NULL, set, output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputDestroy(SamOutput *output)
{
  PetscErrorCode changed = 0, ierr = 0;
  SamOutput      o = *output;

  PetscFunctionBegin;
  if (o && o->f && !o->broken) {
    changed = o->waits || o->frames.count ? SamOutputFlush(o) : SamOutputPublish(o);
    if (!changed) changed = SamFileLockCheck(o->grid, "output", o->f->filename, &o->hold);
  }
  if (o && o->f) ierr = Close(output);
  if (*output) PetscCall(SamOutputFree(output));
  PetscCall(changed);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamOutputHasReplaced(SamOutput o)
{
  return o->replaced;
}

/* ---- parts ---- */

PetscErrorCode SamOutputNamePart(const char filename[], PetscInt part, char **name)
{
  const char  *slash = strrchr(filename, '/'), *first = slash ? slash + 1 : filename, *dot = strrchr(first, '.');
  const size_t stem = dot && dot != first ? (size_t)(dot - filename) : strlen(filename), size = strlen(filename) + 24;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(size, name));
  if (part == 1)
    (void)snprintf(*name, size, "%s", filename);
  else
    (void)snprintf(*name, size, "%.*s.part%ld%s", (int)stem, filename, (long)part, filename + stem);
  PetscFunctionReturn(PETSC_SUCCESS);
}

uint64_t SamOutputGetIdentity(SamOutput o)
{
  return o->identity;
}

PetscErrorCode SamOutputFollow(SamOutput o, uint64_t identity, PetscInt steps, PetscInt cycles)
{
  const PetscReal numbers[2] = {(PetscReal)steps, (PetscReal)cycles};
  char            text[32];

  PetscFunctionBegin;
  (void)snprintf(text, sizeof(text), SAM_IDENTITY, identity);
  PetscCall(SamOutputSetReals(o, SAM_OUTPUT_BRANCH, 1, &numbers[0]));
  PetscCall(SamOutputSetReals(o, SAM_OUTPUT_CYCLES, 1, &numbers[1]));
  if (identity) PetscCall(SamOutputSetText(o, SAM_OUTPUT_FOLLOWS, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCheckPart(SamGrid grid, const char filename[], uint64_t identity)
{
  char      text[32];
  PetscBool is;

  PetscFunctionBegin;
  (void)snprintf(text, sizeof(text), SAM_IDENTITY, identity);
  PetscCall(SamFileCheckName(grid, "output", filename, SAM_FILE_OLD_RESULTS));
  PetscCall(SamFileContains(grid, filename, text, &is));
  PetscCheck(
    is, grid->comm, SAM_ERR_USER,
    "-output %s: cannot be followed: the checkpoint belongs to other results; remove it, or give another name, "
    "to begin a file with the steps after the checkpoint",
    filename);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- attributes ---- */

/* Stops writing to the file, after its attributes have been written. */
static PetscErrorCode End(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(SamFileEnd(o->f));
  SamFileLockNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetReals(SamOutput o, const char name[], PetscInt count, const PetscReal values[])
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamFileWriteAttribute(o->f, o->f->id, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, values);
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetParameters(SamOutput o, const SamParameters *parameters)
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamParametersWrite(o->f, parameters);
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetText(SamOutput o, const char name[], const char text[])
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamFileWriteTextAttribute(o->f, o->f->id, name, text);
  PetscCall(End(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}
