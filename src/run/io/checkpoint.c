/*
  The state of a contact in a file: the fields and numbers that its parts have declared as kept, the parameters that
  define the contact, and a program's notes.

  The fields are datasets (components, ny, nx), all else are attributes of the root group; the file is sealed (seal.c).
  Names of values from one step before begin with `before_`. Kept steps of a load cycle are in separate datasets
  (kept.c). Other contacts that belong to it are groups with the same contents.
*/
#include "ioimpl.h"
#include <petsam/private/checkpoint.h>
#include <petsam/private/grid.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/contact.h>
#include <petsam/private/law.h>
#include <petsam/private/problem.h>
#include <string.h>
#include <unistd.h>

#define OPTION "checkpoint"

struct _n_SamCheckpoint {
  SamGrid     grid;
  char       *filename, *before, *temporary;
  SamFileLock hold; /* lock of the temporary file */
};

/* Computes the checksum of the gap that a contact's problem has now. */
static PetscErrorCode GapChecksum(SamContact contact, uint64_t *checksum)
{

  PetscFunctionBegin;
  PetscCall(SamGridChecksum(SamContactGetGrid(contact), SamProblemGetGap(SamContactGetProblem(contact)), checksum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- contents of a file: each function writes its part if the file is being written, and else reads it ---- */

/* Writes the name in the file of values that are committed or one step back. */
static void NameOf(const char committed[], const char name[], PetscInt generation, char text[96])
{
  (void)snprintf(text, 96, "%s%s", generation == SAM_BEFORE ? "before_" : committed, name);
}

/* Writes or reads a field as a dataset (components, ny, nx). */
static PetscErrorCode MoveField(SamFile f, const char name[], PetscInt components, Vec field)
{
  const SamLabel label   = {.name = name};
  const SamShape shape   = {.rank    = 3,
                            .size    = {(hsize_t)components, (hsize_t)f->grid->ny, (hsize_t)f->grid->nx},
                            .largest = {(hsize_t)components, (hsize_t)f->grid->ny, (hsize_t)f->grid->nx}};
  const hid_t    dataset = f->writing ? SamFileCreateDataset(f, f->id, &label, H5T_IEEE_F64LE, &shape, 0)
                                      : SamFileNote(f, H5Dopen2(f->id, name, H5P_DEFAULT));
  PetscScalar   *values;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &values));
  for (PetscInt c = 0; c < components; c++)
    if (f->writing)
      SamFileWriteFrame(f, dataset, H5T_NATIVE_DOUBLE, (hsize_t)c, values + c * f->grid->cells);
    else
      SamFileReadFrame(f, dataset, H5T_NATIVE_DOUBLE, (hsize_t)c, values + c * f->grid->cells);
  PetscCall(VecRestoreArray(field, &values));
  if (dataset >= 0) (void)SamFileNote(f, H5Dclose(dataset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes or reads the kept fields of a state. */
static PetscErrorCode MoveFields(SamFile f, SamState state)
{
  char name[96];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SamStateCountFields(state); k++) {
    const SamStateField *field = SamStateFieldOf(state, k);

    for (PetscInt g = SAM_COMMITTED; g < field->generations && field->kept; g++) {
      Vec values = SamStateGetField(state, k, (SamGeneration)g);

      NameOf("", field->name, g, name);
      if (f->writing ? !values : SamFileNote(f, H5Lexists(f->id, name, H5P_DEFAULT)) <= 0) continue;
      PetscCall(SamStateRestoreField(state, k, (SamGeneration)g, &values));
      PetscCall(MoveField(f, name, SamStateFieldSize(field), values));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a message that names a memory of the contact that the file lacks: it cannot begin after the first step. */
static void NameLacking(const char name[], char message[], size_t size)
{
  (void)snprintf(message, size, "it lacks %s, which has not been remembered since the start: omit it, or begin anew",
                 name);
}

/* Writes or reads the kept numbers of a state; optional numbers are in the file only if they differ from the usual
   value. */
static void MoveNumbers(SamFile f, SamState state, char message[], size_t size)
{
  for (PetscInt k = 0; k < SamStateCountNumbers(state); k++) {
    PetscInt              id;
    const SamStateNumber *number = SamStateNumberOf(state, k, &id);
    const PetscBool       usual  = SamStateIsUsual(state, k);
    char                  name[96];

    for (PetscInt g = SAM_COMMITTED; g < SAM_GENERATIONS && number->kept; g++) {
      double *const values = SamStateNumbers(state, id, (SamGeneration)g);

      NameOf("committed_", number->name, g, name);
      if (f->writing && !usual)
        SamFileWriteAttribute(f, f->id, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, number->count, values);
      else if (!f->writing && SamFileHasAttribute(f, name))
        SamFileReadAttribute(f, f->id, name, H5T_NATIVE_DOUBLE, number->count, values);
      else if (!usual)
        NameLacking(number->name, message, size);
    }
  }
}

static PetscErrorCode MoveNotes(SamFile f, PetscInt n, const SamNote notes[])
{
  PetscFunctionBegin;
  for (const SamNote *note = notes; note < notes + n; note++) {
    const PetscInt count = PetscAbsInt(note->count);

    if (f->writing) {
      SamFileWriteAttribute(f, f->id, note->name, H5T_STD_U64LE, H5T_NATIVE_UINT64, count, note->values);
      continue;
    }
    PetscCall(PetscArrayzero(note->values, count));
    if (note->count > 0 || SamFileHasAttribute(f, note->name))
      SamFileReadAttribute(f, f->id, note->name, H5T_NATIVE_UINT64, count, note->values);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The gap for which a state was solved, as notes: its checksum, and 1 if it was still the problem's gap. */
#define GAP(values) \
  {"gap_checksum", 1, &(values)[0]}, \
  { \
    "gap_is_current", 1, &(values)[1] \
  }

/* ---- groups ---- */

/* The root of a file while the file stands for a group with a contact on another grid */
typedef struct {
  hid_t   id;
  SamGrid grid;
} Place;

static Place Enter(SamFile f, hid_t group, SamContact contact)
{
  const Place root = {f->id, f->grid};

  f->id   = SamFileNote(f, group);
  f->grid = SamContactGetGrid(contact);
  return root;
}

static void Leave(SamFile f, Place root)
{
  if (f->id >= 0) (void)SamFileNote(f, H5Gclose(f->id));
  f->id   = root.id;
  f->grid = root.grid;
}

/* ---- writing ---- */

/* Lists the names of the fields that a state keeps, separated by commas. */
static void ListFields(SamState state, char list[], size_t size)
{
  list[0] = '\0';
  for (PetscInt k = 0; k < SamStateCountFields(state); k++) {
    const size_t used = strlen(list);

    if (SamStateFieldOf(state, k)->kept)
      (void)snprintf(list + used, size - used, "%s%s", used ? "," : "", SamStateFieldOf(state, k)->name);
  }
}

/* Lists the conditions that differ from their usual values, in the same way. */
static void ListConditions(SamState state, char list[], size_t size)
{
  list[0] = '\0';
  for (PetscInt k = 0; k < SamStateCountNumbers(state); k++) {
    const SamStateNumber *number = SamStateNumberOf(state, k, NULL);
    const size_t          used   = strlen(list);

    if (SamStateIsOptional(state, k) && !SamStateIsUsual(state, k))
      (void)snprintf(list + used, size - used, "%s%s", used ? "," : "", number->name);
  }
}

static off_t CountBytes(SamGrid grid, SamState state)
{
  off_t values = 0;

  for (PetscInt k = 0; k < SamStateCountFields(state); k++)
    for (PetscInt g = SAM_COMMITTED; g < SamStateFieldOf(state, k)->generations; g++)
      if (SamStateFieldOf(state, k)->kept && SamStateGetField(state, k, (SamGeneration)g))
        values += SamStateFieldSize(SamStateFieldOf(state, k));
  return values * (off_t)sizeof(double) * grid->nx * grid->ny;
}

/* Writes the state of a contact. */
static PetscErrorCode WriteState(SamFile f, SamContact contact)
{
  SamState       state;
  PetscBool      is;
  char           list[8192];
  uint64_t       gap[2];
  const SamNote  notes[] = {GAP(gap)};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(contact, &state));
  PetscCall(SamContactIsGapCurrent(contact, &is));
  PetscCall(GapChecksum(contact, &gap[0]));
  gap[1] = is;
  PetscCall(MoveNotes(f, 2, notes));
  MoveNumbers(f, state, NULL, 0);
  ListFields(state, list, sizeof(list));
  SamFileWriteTextAttribute(f, f->id, "fields", list);
  ListConditions(state, list, sizeof(list));
  if (list[0]) SamFileWriteTextAttribute(f, f->id, "conditions", list);
  SamStateSwapTried(state); /* a tried step is not saved */
  ierr = MoveFields(f, state);
  SamStateSwapTried(state);
  PetscCall(ierr);
  PetscCall(SamKeptWrite(f, SamContactGetCache(contact)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a part into its group. */
static PetscErrorCode WritePart(SamFile f, const SamCheckpointPart *part)
{
  const Place    root = Enter(f, H5Gcreate2(f->id, part->name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), part->contact);
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ierr = MoveNotes(f, part->n, part->notes);
  if (!ierr) ierr = WriteState(f, part->contact);
  Leave(f, root);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the bytes of the fields of a contact, and of its kept steps. */
static PetscErrorCode AddBytes(SamContact contact, off_t *bytes)
{
  SamState state;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(contact, &state));
  *bytes += CountBytes(SamContactGetGrid(contact), state) + SamKeptBytes(SamContactGetCache(contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteAll(SamFile f, SamContact contact, const SamCheckpointRest *rest)
{
  off_t bytes = 0;

  PetscFunctionBegin;
  PetscCall(AddBytes(contact, &bytes));
  for (PetscInt k = 0; k < rest->parts; k++) PetscCall(AddBytes(rest->part[k].contact, &bytes));
  PetscCall(SamFileReserve(f, bytes));
  PetscCall(SamFileBegin(f));
  SamFileWriteTextAttribute(f, f->id, "petsam_version", PETSAM_VERSION);
  SamParametersWrite(f, rest->parameters);
  PetscCall(MoveNotes(f, rest->n, rest->notes));
  PetscCall(WriteState(f, contact));
  for (PetscInt k = 0; k < rest->parts; k++) PetscCall(WritePart(f, &rest->part[k]));
  (void)SamFileNote(f, H5Fflush(f->id, H5F_SCOPE_GLOBAL));
  PetscCall(SamFileEnd(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes and seals the file, which does not have its final name yet. */
static PetscErrorCode WriteFile(SamCheckpoint cp, SamContact contact, const SamCheckpointRest *rest)
{
  SamFile        f;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamFileOpen(cp->grid, SAM_EVENT_CHECKPOINT, OPTION, cp->temporary, SAM_FILE_CREATE_SEALED, NULL, &f));
  ierr = WriteAll(f, contact, rest);
  if (ierr) (void)SamFileDestroy(&f, PETSC_TRUE);
  PetscCall(ierr);
  PetscCall(SamFileDestroy(&f, PETSC_TRUE));
  PetscCall(SamSealWrite(cp->grid, OPTION, cp->temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that no other program has created files of these names in the meantime. */
static PetscErrorCode CheckNames(SamCheckpoint cp)
{
  PetscFunctionBegin;
  PetscCall(SamFileLockCheck(cp->grid, OPTION, cp->temporary, &cp->hold));
  PetscCall(SamFileCheckName(cp->grid, OPTION, cp->filename, SAM_FILE_CHECKPOINT));
  PetscCall(SamFileCheckName(cp->grid, OPTION, cp->before, SAM_FILE_CHECKPOINT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointWrite(SamCheckpoint cp, SamContact contact, const SamCheckpointRest *rest)
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(CheckNames(cp));
  ierr = WriteFile(cp, contact, rest);
  if (ierr && cp->hold.file >= 0) (void)!ftruncate(cp->hold.file, 0); /* releases the disk space */
  PetscCall(ierr);
  PetscCall(SamFileReplace(cp->grid, OPTION, cp->temporary, cp->filename, cp->before));
  PetscCall(SamFileLockTakeNext(cp->grid, OPTION, cp->temporary, &cp->hold));
  SamFileLockNoteSize(&cp->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Locks the temporary file. A run that has just renamed its own file still holds the checkpoint itself. */
static PetscErrorCode TakeNames(SamCheckpoint cp)
{
  PetscFunctionBegin;
  PetscCall(SamFileLockTake(cp->grid, OPTION, cp->temporary, SAM_FILE_TEMPORARY, &cp->hold));
  SamFileLockNoteSize(&cp->hold);
  PetscCall(CheckNames(cp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointCreate(SamGrid grid, const char filename[], SamCheckpoint *checkpoint)
{
  SamCheckpoint  cp;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(PetscNew(&cp));
  PetscCall(SamGridReference(grid));
  cp->grid      = grid;
  cp->hold.file = -1;
  PetscCall(PetscStrallocpy(filename, &cp->filename));
  PetscCall(SamCheckpointNames(filename, &cp->before, &cp->temporary));
  ierr = TakeNames(cp);
  if (ierr) (void)SamCheckpointDestroy(&cp);
  *checkpoint = cp;
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointDestroy(SamCheckpoint *checkpoint)
{
  SamCheckpoint cp = *checkpoint;

  PetscFunctionBegin;
  *checkpoint = NULL;
  if (!cp) PetscFunctionReturn(PETSC_SUCCESS);
  SamFileLockRelease(cp->temporary, &cp->hold);
  PetscCall(SamGridDestroy(&cp->grid));
  PetscCall(PetscFree(cp->filename));
  PetscCall(PetscFree(cp->before));
  PetscCall(PetscFree(cp->temporary));
  PetscCall(PetscFree(cp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointNames(const char filename[], char **before, char **temporary)
{
  PetscFunctionBegin;
  PetscCall(SamFileNameBeside(filename, ".1", before));
  PetscCall(SamFileNameTemporary(filename, temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading ---- */

/* The state of a contact, as it is in the file */
typedef struct {
  SamState     state; /* NULL: the file has none */
  SamStepCache cache;
  uint64_t     gap[2];
} Stored;

/* Contents of a checkpoint besides the notes; the caller destroys them, also after an error */
typedef struct {
  Stored contact, part[SAM_CHECKPOINT_PARTS];
} Content;

static PetscErrorCode DestroyContent(Content *c)
{
  PetscFunctionBegin;
  for (PetscInt k = -1; k < SAM_CHECKPOINT_PARTS; k++) {
    Stored *one = k < 0 ? &c->contact : &c->part[k];

    PetscCall(SamStateDestroy(&one->state));
    SamStepCacheDestroy(&one->cache);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if a law of this name only accumulates its field; if so, declares the field in `state` (NULL: does not). */
static PetscErrorCode DeclareSum(SamContact contact, const char name[], SamState state, PetscBool *is)
{
  SamLaw law;

  PetscFunctionBegin;
  *is = PETSC_FALSE;
  if (!SamLawIsRegistered(name)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamLawCreate(SamProblemGetElasticity(SamContactGetProblem(contact)), name, &law));
  *is = law->accumulates;
  if (*is && state) PetscCall(law->ops.declare(law, state));
  PetscCall(SamLawDestroy(&law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Creates a state with the declarations of the contact's state and, if `sums`, those of sums that only the file has. The
  message names any other field that only one of them has.
*/
static PetscErrorCode CreateState(SamContact contact, const char list[], PetscBool sums, SamState *state,
                                  char message[], size_t size)
{
  SamState  own;
  PetscBool listed, is;
  char    **names;
  int       count;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(contact, &own));
  PetscCall(SamStateCreateLike(own, state));
  PetscCall(PetscStrToArray(list, ',', &count, &names));
  for (int k = 0; k < count; k++) {
    if (SamStateFindField(own, names[k]) >= 0) continue;
    PetscCall(DeclareSum(contact, names[k], sums ? *state : NULL, &is));
    if (!is)
      (void)snprintf(message, size,
                     "it has the field %s, which no law of this run remembers: give the options of its run", names[k]);
  }
  PetscCall(PetscStrToArrayDestroy(count, names));
  for (PetscInt k = 0; k < SamStateCountFields(own); k++) {
    const SamStateField *field = SamStateFieldOf(own, k);

    PetscCall(PetscStrInList(field->name, list, ',', &listed));
    if (field->kept && !listed && !field->optional) NameLacking(field->name, message, size);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the contact has all conditions of the file; the message names a missing one. */
static PetscErrorCode CheckConditions(SamState state, const char list[], char message[], size_t size)
{
  char **names;
  int    count;

  PetscFunctionBegin;
  PetscCall(PetscStrToArray(list, ',', &count, &names));
  for (int k = 0; k < count; k++)
    if (SamStateFindNumber(state, names[k]) < 0)
      (void)snprintf(message, size, "it has the condition %s, which this run lacks: give the options of its run",
                     names[k]);
  PetscCall(PetscStrToArrayDestroy(count, names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadState(SamFile f, SamContact contact, PetscBool sums, Stored *c, char message[], size_t size)
{
  const SamNote notes[] = {GAP(c->gap)};
  char         *list    = NULL;

  PetscFunctionBegin;
  PetscCall(MoveNotes(f, 2, notes));
  SamFileReadTextAttribute(f, f->id, "fields", &list);
  PetscCall(CreateState(contact, list, sums, &c->state, message, size));
  PetscCall(PetscFree(list));
  if (SamFileHasAttribute(f, "conditions")) {
    SamFileReadTextAttribute(f, f->id, "conditions", &list);
    PetscCall(CheckConditions(c->state, list, message, size));
    PetscCall(PetscFree(list));
  }
  MoveNumbers(f, c->state, message, size);
  PetscCall(MoveFields(f, c->state));
  PetscCall(SamStepCacheCreateLike(SamContactGetCache(contact), &c->cache));
  PetscCall(SamKeptRead(f, c->cache));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a part from its group, if the file has that. */
static PetscErrorCode ReadPart(SamFile f, SamCheckpointPart *part, Stored *c, char message[], size_t size)
{
  Place          root;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  part->there = SamFileNote(f, H5Lexists(f->id, part->name, H5P_DEFAULT)) > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!part->there) PetscFunctionReturn(PETSC_SUCCESS);
  root = Enter(f, H5Gopen2(f->id, part->name, H5P_DEFAULT), part->contact);
  ierr = MoveNotes(f, part->n, part->notes);
  if (!ierr) ierr = ReadState(f, part->contact, PETSC_FALSE, c, message, size);
  Leave(f, root);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadAll(SamFile f, SamContact contact, const SamCheckpointRest *rest, PetscBool sums, Content *c)
{
  char  message[256] = "";
  char *version      = NULL;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(f));
  SamFileReadTextAttribute(f, f->id, "petsam_version", &version);
  if (strcmp(version, PETSAM_VERSION))
    (void)snprintf(message, sizeof(message), "it was written by petsam %s, this is %s", version, PETSAM_VERSION);
  else if (rest->parameters->in_process && SamFileHasAttribute(f, "load_program"))
    (void)snprintf(message, sizeof(message), "it is the checkpoint of a program's run: continue that with -restart");
  else if (!rest->parameters->in_process && SamFileHasAttribute(f, "given_gap"))
    (void)snprintf(message, sizeof(message), "a contact in process has saved it: load it in such a contact");
  else if (!SamParametersDiffer(f, rest->parameters, message, sizeof(message)) && !f->failed) {
    PetscCall(MoveNotes(f, rest->n, rest->notes));
    PetscCall(ReadState(f, contact, sums, &c->contact, message, sizeof(message)));
    for (PetscInt k = 0; k < rest->parts && !message[0]; k++)
      PetscCall(ReadPart(f, &rest->part[k], &c->part[k], message, sizeof(message)));
  }
  PetscCall(PetscFree(version));
  PetscCall(SamFileEnd(f));
  PetscCheck(!message[0], f->grid->comm, SAM_ERR_USER, "-restart %s: cannot continue from it: %s", f->filename,
             message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFile(SamContact contact, const char filename[], const SamCheckpointRest *rest, PetscBool sums,
                               Content *c)
{
  SamFile        f;
  PetscErrorCode ierr;
  const SamGrid  grid = SamContactGetGrid(contact);

  PetscFunctionBegin;
  PetscCall(PetscMemzero(c, sizeof(*c)));
  PetscCall(SamSealCheck(grid, "restart", filename));
  PetscCall(SamFileOpen(grid, SAM_EVENT_CHECKPOINT, "restart", filename, SAM_FILE_READ, NULL, &f));
  ierr = ReadAll(f, contact, rest, sums, c);
  if (ierr) (void)SamFileDestroy(&f, PETSC_TRUE);
  PetscCall(ierr);
  PetscCall(SamFileDestroy(&f, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds advice on a checkpoint that cannot be read: names the previous one, if that can be read. */
static PetscErrorCode Advise(SamContact contact, const char filename[], const SamCheckpointRest *rest, char advice[],
                             size_t size)
{
  Content c;
  char    ignored[SAM_MESSAGE], *before, *temporary;

  PetscFunctionBegin;
  PetscCall(SamCheckpointNames(filename, &before, &temporary));
  PetscCall(PetscPushErrorHandler(SamKeepMessage, ignored));
  if (!ReadFile(contact, before, rest, PETSC_TRUE, &c))
    (void)snprintf(advice, size, "; the checkpoint before it can be read: -restart %s", before);
  PetscCall(PetscPopErrorHandler());
  PetscCall(DestroyContent(&c));
  PetscCall(PetscFree(before));
  PetscCall(PetscFree(temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the contact accumulate the sums that were read in addition to its own fields. */
static PetscErrorCode AddSums(SamContact contact, SamState state)
{
  SamState own;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(contact, &own));
  for (PetscInt k = SamStateCountFields(own); k < SamStateCountFields(state); k++)
    PetscCall(SamProblemAddSum(SamContactGetProblem(contact), SamStateFieldOf(state, k)->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives a contact the state that was read. */
static PetscErrorCode Set(SamContact contact, const Stored *c)
{
  uint64_t gap;

  PetscFunctionBegin;
  PetscCall(GapChecksum(contact, &gap));
  PetscCall(SamContactSetState(contact, c->state, c->gap[1] && gap == c->gap[0]));
  PetscCall(SamStepCacheCopy(c->cache, SamContactGetCache(contact)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointRead(const char filename[], SamContact contact, PetscBool sums,
                                 const SamCheckpointRest *rest)
{
  Content        c;
  char           message[SAM_MESSAGE] = "", advice[2 * PETSC_MAX_PATH_LEN] = "";
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
  ierr = ReadFile(contact, filename, rest, sums, &c);
  PetscCall(PetscPopErrorHandler());
  if (!ierr) {
    PetscCall(AddSums(contact, c.contact.state));
    PetscCall(Set(contact, &c.contact));
    for (PetscInt k = 0; k < rest->parts; k++)
      if (rest->part[k].there) PetscCall(Set(rest->part[k].contact, &c.part[k]));
  }
  PetscCall(DestroyContent(&c));
  if (ierr == SAM_ERR_FILE) PetscCall(Advise(contact, filename, rest, advice, sizeof(advice)));
  PetscCheck(!ierr, SamContactGetGrid(contact)->comm, ierr, "%s%s", message, advice);
  PetscFunctionReturn(PETSC_SUCCESS);
}
