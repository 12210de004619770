/*
  The state of a contact in a file: SamContactState, the parameters that define the contact, and a program's notes.

  The fields are datasets (components, ny, nx), all else attributes of the root group; all is sealed (seal.c).
*/
#include "ioimpl.h"
#include <petsam/checkpoint.h>
#include <string.h>
#include <unistd.h>

#define OPTION "checkpoint"

/* The fields and their names in the file, and which states have them. */
/* SECOND: from the second step on; YIELDING, SUM: if it is kept */
typedef enum { ALWAYS, CORRECTED, SHEARED, PLAIN, YIELDING, SECOND, SUM } Condition;
static const struct {
  const char *name;
  PetscInt    components;
  size_t      offset; /* of the Vec in SamContactState */
  Condition   when;
} kept[] = {{"pressure", 1, offsetof(SamContactState, now.pressure), ALWAYS},
            {"bound", 1, offsetof(SamContactState, now.bound), ALWAYS},
            {"shear", 2, offsetof(SamContactState, now.shear), ALWAYS},
            {"displacement_z", 1, offsetof(SamContactState, now.displacement_z), ALWAYS},
            {"displacement_t", 2, offsetof(SamContactState, now.displacement_t), ALWAYS},
            {"correction", 1, offsetof(SamContactState, now.correction), CORRECTED},
            {"rim", 1, offsetof(SamContactState, now.rim), CORRECTED},
            {"sheared_displacement", 2, offsetof(SamContactState, now.sheared.displacement), SHEARED},
            {"sheared_rim", 1, offsetof(SamContactState, now.sheared.rim), SHEARED},
            {"sheared_slopes", SAM_SHEAR_SLOPES, offsetof(SamContactState, now.sheared.within.slopes), SHEARED},
            {"sheared_terms", SAM_SHEAR_TERMS, offsetof(SamContactState, now.sheared.within.terms), SHEARED},
            {"sheared_reference", SAM_SHEAR_REFERENCE, offsetof(SamContactState, now.sheared.within.reference),
             SHEARED},
            {"plain_reference", 2, offsetof(SamContactState, now.sheared.plain_reference), SHEARED},
            {"plain_pressure", 1, offsetof(SamContactState, plain.pressure), PLAIN},
            {"plain_bound", 1, offsetof(SamContactState, plain.bound), PLAIN},
            {"plain_shear", 2, offsetof(SamContactState, plain.shear), PLAIN},
            {"plain_displacement_t", 2, offsetof(SamContactState, plain.displacement_t), PLAIN},
            {"plastic_depth", 1, offsetof(SamContactState, now.plastic), YIELDING},
            {"before_pressure", 1, offsetof(SamContactState, before.pressure), SECOND},
            {"before_bound", 1, offsetof(SamContactState, before.bound), SECOND},
            {"before_shear", 2, offsetof(SamContactState, before.shear), SECOND},
            {"slip_path", 1, offsetof(SamContactState, sums[SAM_CONTACT_SLIP_PATH]), SUM},
            {"friction_energy", 1, offsetof(SamContactState, sums[SAM_CONTACT_FRICTION_ENERGY]), SUM}};
enum { KEPT = sizeof(kept) / sizeof(kept[0]) };

static Vec *FieldOf(SamContactState *state, PetscInt k)
{
  return (Vec *)((char *)state + kept[k].offset);
}

static PetscBool IsKept(SamContactState *state, PetscInt k)
{
  if (kept[k].when == SUM) return *FieldOf(state, k) ? PETSC_TRUE : PETSC_FALSE;
  if (kept[k].when == CORRECTED) return state->now.passes > 0;
  if (kept[k].when == PLAIN) return state->now.sheared.has;
  if (kept[k].when == SHEARED) return state->now.sheared.has || state->now.sheared.within.refers;
  if (kept[k].when == YIELDING) return state->now.plastic ? PETSC_TRUE : PETSC_FALSE;
  return kept[k].when == ALWAYS || state->steps > 1;
}

struct _n_SamCheckpoint {
  SamGrid grid;
  char   *filename, *before, *temporary;
  SamHold hold; /* of the temporary file */
};

/* ---- fields ---- */

static PetscErrorCode WriteField(SamFile f, const char name[], PetscInt components, Vec field)
{
  const hsize_t size[3] = {(hsize_t)components, (hsize_t)f->grid->ny, (hsize_t)f->grid->nx};
  const hid_t   space   = SamFileNote(f, H5Screate_simple(3, size, NULL)),
              creation  = SamFileNote(f, H5Pcreate(H5P_DATASET_CREATE));
  const PetscScalar *values;
  hid_t              dataset;

  PetscFunctionBegin;
  (void)SamFileNote(f, H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER));
  dataset = SamFileNote(f, H5Dcreate2(f->id, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  PetscCall(VecGetArrayRead(field, &values));
  for (PetscInt c = 0; c < components; c++)
    SamFileWriteLayer(f, dataset, H5T_NATIVE_DOUBLE, (hsize_t)c, values + c * f->grid->cells);
  PetscCall(VecRestoreArrayRead(field, &values));
  (void)SamFileNote(f, H5Dclose(dataset));
  (void)SamFileNote(f, H5Pclose(creation));
  (void)SamFileNote(f, H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadField(SamFile f, const char name[], PetscInt components, Vec *field)
{
  const hid_t  dataset = SamFileNote(f, H5Dopen2(f->id, name, H5P_DEFAULT));
  PetscScalar *values;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(f->grid, components, field));
  PetscCall(VecGetArray(*field, &values));
  for (PetscInt c = 0; c < components; c++)
    SamFileReadLayer(f, dataset, H5T_NATIVE_DOUBLE, (hsize_t)c, values + c * f->grid->cells);
  PetscCall(VecRestoreArray(*field, &values));
  if (dataset >= 0) (void)SamFileNote(f, H5Dclose(dataset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFields(SamContactState *state)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < KEPT; k++) PetscCall(VecDestroy(FieldOf(state, k)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The checksum of the gap that a contact's problem has now. */
static PetscErrorCode GapChecksum(SamContact contact, uint64_t *checksum)
{
  SamProblem problem;
  SamGrid    grid;
  Vec        gap;

  PetscFunctionBegin;
  PetscCall(SamContactGetGrid(contact, &grid));
  PetscCall(SamContactGetProblem(contact, &problem));
  PetscCall(SamProblemGetGap(problem, &gap));
  PetscCall(SamCheckpointChecksum(grid, gap, checksum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- writing ---- */

/* What is stored besides the state. */
typedef struct {
  const SamParameters *parameters;
  PetscInt             n;
  const SamNote       *notes;
  SamWear              wear; /* NULL: none */
} Rest;

static PetscErrorCode WriteWear(SamFile f, SamWear wear)
{
  Vec load;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(f->grid, 1, &load));
  PetscCall(SamWearGetLoad(wear, load));
  PetscCall(WriteField(f, "wear_load", 1, load));
  PetscCall(VecDestroy(&load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteAll(SamFile f, SamContactState *state, uint64_t gap, const Rest *rest)
{
  off_t bytes = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < KEPT; k++)
    if (IsKept(state, k)) bytes += (off_t)sizeof(double) * kept[k].components * f->grid->nx * f->grid->ny;
  if (rest->wear) bytes += (off_t)sizeof(double) * f->grid->nx * f->grid->ny;
  PetscCall(SamFileReserve(f, bytes));
  PetscCall(SamFileBegin(f));
  SamFileWriteTextAttribute(f, f->id, "petsam_version", PETSAM_VERSION);
  SamParametersWrite(f, rest->parameters);
  SamFileWriteAttribute(f, f->id, "gap_checksum", H5T_STD_U64LE, H5T_NATIVE_UINT64, 1, &gap);
  for (PetscInt k = 0; k < rest->n; k++)
    SamFileWriteAttribute(f, f->id, rest->notes[k].name, H5T_STD_U64LE, H5T_NATIVE_UINT64,
                          PetscAbsInt(rest->notes[k].count), rest->notes[k].values);
  SamFileWriteState(f, state);
  for (PetscInt k = 0; k < KEPT; k++)
    if (IsKept(state, k)) PetscCall(WriteField(f, kept[k].name, kept[k].components, *FieldOf(state, k)));
  if (rest->wear) PetscCall(WriteWear(f, rest->wear));
  (void)SamFileNote(f, H5Fflush(f->id, H5F_SCOPE_GLOBAL));
  PetscCall(SamFileEnd(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes and seals the file, which has no name of its own yet. */
static PetscErrorCode WriteFile(SamCheckpoint cp, SamContactState *state, uint64_t gap, const Rest *rest)
{
  SamFile        f;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamFileOpen(cp->grid, SAM_EVENT_CHECKPOINT, OPTION, cp->temporary, SAM_FILE_CREATE_SEALED, &f));
  ierr = WriteAll(f, state, gap, rest);
  if (ierr) (void)SamFileDestroy(&f, PETSC_TRUE);
  PetscCall(ierr);
  PetscCall(SamFileDestroy(&f, PETSC_TRUE));
  PetscCall(SamSealWrite(cp->grid, OPTION, cp->temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses names at which other programs have put files meanwhile. */
static PetscErrorCode CheckNames(SamCheckpoint cp)
{
  PetscFunctionBegin;
  PetscCall(SamHoldCheck(cp->grid, OPTION, cp->temporary, &cp->hold));
  PetscCall(SamFileCheckName(cp->grid, OPTION, cp->filename, SAM_FILE_CHECKPOINT));
  PetscCall(SamFileCheckName(cp->grid, OPTION, cp->before, SAM_FILE_CHECKPOINT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointWrite(SamCheckpoint cp, SamContact contact, SamWear wear, const SamParameters *parameters,
                                  PetscInt n, const SamNote notes[])
{
  const Rest      rest = {parameters, n, notes, wear};
  SamContactState state;
  uint64_t        gap;
  PetscErrorCode  ierr;

  PetscFunctionBegin;
  PetscCall(CheckNames(cp));
  PetscCall(SamContactGetState(contact, &state));
  PetscCall(GapChecksum(contact, &gap));
  ierr = WriteFile(cp, &state, gap, &rest);
  if (ierr && cp->hold.file >= 0) (void)!ftruncate(cp->hold.file, 0); /* gives back the space */
  PetscCall(ierr);
  PetscCall(SamFileReplace(cp->grid, OPTION, cp->temporary, cp->filename, cp->before));
  PetscCall(SamHoldTakeNext(cp->grid, OPTION, cp->temporary, &cp->hold));
  SamHoldNoteSize(&cp->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes hold of the temporary file. A run that has just renamed its own still holds the checkpoint itself. */
static PetscErrorCode TakeNames(SamCheckpoint cp)
{
  PetscFunctionBegin;
  PetscCall(SamHoldTake(cp->grid, OPTION, cp->temporary, SAM_FILE_TEMPORARY, &cp->hold));
  SamHoldNoteSize(&cp->hold);
  PetscCall(CheckNames(cp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointCreate(SamGrid grid, const char filename[], SamCheckpoint *checkpoint)
{
  SamCheckpoint  cp;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
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
  SamHoldRelease(cp->temporary, &cp->hold);
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
  PetscCall(SamFileNameBeside(filename, ".tmp", temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading ---- */

/* Whether the file is of this version and has the same fixed parameters; if not, the message says what differs. */
static PetscErrorCode IsUsable(SamFile f, const SamParameters *parameters, char message[], size_t size, PetscBool *good)
{
  char *version = NULL;

  PetscFunctionBegin;
  *good = PETSC_FALSE;
  SamFileReadTextAttribute(f, f->id, "petsam_version", &version);
  if (strcmp(version, PETSAM_VERSION))
    (void)snprintf(message, size, "it was written by petsam %s, this is %s", version, PETSAM_VERSION);
  else
    *good = PETSC_TRUE;
  PetscCall(PetscFree(version));
  if (*good) *good = SamParametersDiffer(f, parameters, message, size) ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFields(SamFile f, SamContactState *state)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < KEPT; k++) {
    const PetscBool has = kept[k].when == SUM || kept[k].when == YIELDING
                            ? SamFileNote(f, H5Lexists(f->id, kept[k].name, H5P_DEFAULT)) > 0
                            : IsKept(state, k);

    if (has) PetscCall(ReadField(f, kept[k].name, kept[k].components, FieldOf(state, k)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is read besides the notes. The caller destroys the vectors of the state, and the load. */
typedef struct {
  SamContactState state;
  Vec             load; /* of wear; NULL: none */
  uint64_t        gap;  /* checksum */
} Content;

static PetscErrorCode DestroyContent(Content *c)
{
  PetscFunctionBegin;
  PetscCall(DestroyFields(&c->state));
  PetscCall(VecDestroy(&c->load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadNote(SamFile f, const SamNote *note)
{
  const PetscInt count = PetscAbsInt(note->count);

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(note->values, count));
  if (note->count > 0 || SamFileNote(f, H5Aexists(f->id, note->name)) > 0)
    SamFileReadAttribute(f, f->id, note->name, H5T_NATIVE_UINT64, count, note->values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadAll(SamFile f, const Rest *rest, Content *c)
{
  char      message[256] = "";
  PetscBool good         = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(f));
  PetscCall(IsUsable(f, rest->parameters, message, sizeof(message), &good));
  if (!f->failed && good) {
    SamFileReadAttribute(f, f->id, "gap_checksum", H5T_NATIVE_UINT64, 1, &c->gap);
    for (PetscInt k = 0; k < rest->n; k++) PetscCall(ReadNote(f, &rest->notes[k]));
    SamFileReadState(f, &c->state);
    PetscCall(ReadFields(f, &c->state));
    if (rest->wear) PetscCall(ReadField(f, "wear_load", 1, &c->load));
  }
  PetscCall(SamFileEnd(f));
  PetscCheck(good, f->grid->comm, SAM_ERR_USER, "-restart %s: cannot go on from it: %s", f->filename, message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The caller destroys the content, also after an error. */
static PetscErrorCode ReadFile(SamGrid grid, const char filename[], const Rest *rest, Content *c)
{
  SamFile        f;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(c, sizeof(*c)));
  PetscCall(SamSealCheck(grid, "restart", filename));
  PetscCall(SamFileOpen(grid, SAM_EVENT_CHECKPOINT, "restart", filename, SAM_FILE_READ, &f));
  ierr = ReadAll(f, rest, c);
  if (ierr) (void)SamFileDestroy(&f, PETSC_TRUE);
  PetscCall(ierr);
  PetscCall(SamFileDestroy(&f, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Advice for a checkpoint that cannot be read: names the one before it, if that can be read. */
static PetscErrorCode Advise(SamGrid grid, const char filename[], const Rest *rest, char advice[], size_t size)
{
  Content c;
  char    ignored[SAM_MESSAGE], *before, *temporary;

  PetscFunctionBegin;
  PetscCall(SamCheckpointNames(filename, &before, &temporary));
  PetscCall(PetscPushErrorHandler(SamKeepMessage, ignored));
  if (!ReadFile(grid, before, rest, &c))
    (void)snprintf(advice, size, "; the checkpoint before it can be read: -restart %s", before);
  PetscCall(PetscPopErrorHandler());
  PetscCall(DestroyContent(&c));
  PetscCall(PetscFree(before));
  PetscCall(PetscFree(temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A sum over all steps cannot begin in the middle. */
static PetscErrorCode CheckSums(const char filename[], SamContact contact, SamContactState *s)
{
  SamGrid grid;

  PetscFunctionBegin;
  PetscCall(SamContactGetGrid(contact, &grid));
  for (PetscInt k = 0; k < KEPT; k++) {
    Vec own;

    if (kept[k].when != SUM) continue;
    PetscCall(SamContactGetSum(contact, (SamContactSum)(FieldOf(s, k) - s->sums), &own));
    PetscCheck(!own || *FieldOf(s, k), grid->comm, SAM_ERR_USER,
               "-restart %s: cannot go on from it: %s is a sum over all steps, and has not been kept since the start: "
               "leave it out, or begin anew",
               filename, kept[k].name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives contact and wear what was read: first the wear, which decides the gap. */
static PetscErrorCode SetStates(SamContact contact, SamWear wear, Content *c)
{
  uint64_t gap;

  PetscFunctionBegin;
  if (wear) PetscCall(SamWearSetLoad(wear, c->load));
  PetscCall(GapChecksum(contact, &gap));
  if (gap != c->gap) c->state.gap_is_current = PETSC_FALSE;
  PetscCall(SamContactSetState(contact, &c->state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCheckpointRead(const char filename[], SamContact contact, SamWear wear,
                                 const SamParameters *parameters, PetscInt n, const SamNote notes[])
{
  const Rest     rest = {parameters, n, notes, wear};
  Content        c;
  SamGrid        grid;
  char           message[SAM_MESSAGE] = "", advice[2 * PETSC_MAX_PATH_LEN] = "";
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(SamContactGetGrid(contact, &grid));
  PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
  ierr = ReadFile(grid, filename, &rest, &c);
  PetscCall(PetscPopErrorHandler());
  if (!ierr) PetscCall(CheckSums(filename, contact, &c.state));
  if (!ierr) PetscCall(SetStates(contact, wear, &c));
  PetscCall(DestroyContent(&c));
  if (ierr == SAM_ERR_FILE) PetscCall(Advise(grid, filename, &rest, advice, sizeof(advice)));
  PetscCheck(!ierr, grid->comm, ierr, "%s%s", message, advice);
  PetscFunctionReturn(PETSC_SUCCESS);
}
