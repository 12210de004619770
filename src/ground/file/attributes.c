/* The parameters of a run, as attributes of its files; a field is represented by a checksum. */
#include <petsam/private/file.h>
#include <math.h>
#include <string.h>

/* The attribute that lists the names of all fixed parameters of a file, separated by commas */
#define NAMES "fixed_parameters"

void SamParametersWrite(SamFile f, const SamParameters *parameters)
{
  char names[SAM_PARAMETERS * 33] = "";

  for (PetscInt k = 0; k < parameters->count; k++) {
    const SamParameter *const p = &parameters->list[k];

    if (p->count)
      SamFileWriteAttribute(f, f->id, p->name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, p->count, p->value);
    else
      SamFileWriteTextAttribute(f, f->id, p->name, p->text);
    if (p->fixed)
      (void)snprintf(names + strlen(names), sizeof(names) - strlen(names), "%s%s", names[0] ? "," : "", p->name);
  }
  SamFileWriteTextAttribute(f, f->id, NAMES, names);
}

/* Reads the value of a parameter from the file. */
static void Read(SamFile f, const SamParameter *like, SamParameter *read)
{
  hssize_t count;

  *read = *like;
  (void)SamAttributeClass(f->id, like->name, &count);
  if (like->count) {
    read->count = (PetscInt)PetscMin(PetscMax(count, 1), SAM_PARAMETER_VALUES);
    SamFileReadAttribute(f, f->id, like->name, H5T_NATIVE_DOUBLE, read->count, read->value);
  } else
    (void)SamTextRead(f->id, like->name, read->text, sizeof(read->text));
}

static void Print(const SamParameter *p, char text[], size_t size)
{
  size_t at = 0;

  (void)snprintf(text, size, "%s", p->text);
  for (PetscInt k = 0; k < p->count && at < size; k++)
    at += (size_t)snprintf(text + at, size - at, "%s%.15g", k ? "," : "", (double)p->value[k]);
}

static PetscBool Same(const SamParameter *a, const SamParameter *b)
{
  if (a->count != b->count) return PETSC_FALSE;
  for (PetscInt k = 0; k < a->count; k++)
    if (!(a->value[k] == b->value[k])) return PETSC_FALSE;
  return strcmp(a->text, b->text) ? PETSC_FALSE : PETSC_TRUE;
}

/* True if the file's value of a parameter was given by the user: inf and 0 also mean that none was given. */
static PetscBool IsGivenThere(SamFile f, const char name[])
{
  SamParameter like = {.count = 0}, there;
  hssize_t     count;

  (void)snprintf(like.name, sizeof(like.name), "%s", name);
  like.count = SamAttributeClass(f->id, name, &count) == H5T_FLOAT;
  Read(f, &like, &there);
  return !there.count || (isfinite(there.value[0]) && there.value[0] != 0);
}

/* True if the file has a fixed parameter that this run does not have; returns the name of the first one with a
   value. */
static PetscErrorCode FindOther(SamFile f, const SamParameters *parameters, char message[], size_t size,
                                PetscBool *found)
{
  char     *names = NULL, **list;
  PetscBool given = PETSC_FALSE;
  int       count;

  PetscFunctionBegin;
  *found = PETSC_FALSE;
  if (!SamFileHasAttribute(f, NAMES)) PetscFunctionReturn(PETSC_SUCCESS);
  SamFileReadTextAttribute(f, f->id, NAMES, &names);
  PetscCall(PetscStrToArray(names ? names : "", ',', &count, &list));
  for (int k = 0; k < count && !given; k++) {
    if (SamParametersFind(parameters, list[k])) continue;
    given = IsGivenThere(f, list[k]);
    if (given || !*found) (void)snprintf(message, size, "-%s is given there, and not here", list[k]);
    *found = PETSC_TRUE;
  }
  PetscCall(PetscStrToArrayDestroy(count, list));
  PetscCall(PetscFree(names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamParametersDiffer(SamFile f, const SamParameters *parameters, char message[], size_t size)
{
  PetscBool other = PETSC_FALSE;

  for (PetscInt k = 0; k < parameters->count; k++) {
    const SamParameter *const now = &parameters->list[k];
    SamParameter              there;
    char                      text[2][sizeof(now->text)];

    if (!now->fixed) continue;
    if (SamFileNote(f, H5Aexists(f->id, now->name)) <= 0) {
      (void)snprintf(message, size, "-%s is not given there", now->name);
      return PETSC_TRUE;
    }
    Read(f, now, &there);
    if (f->failed || Same(now, &there)) continue;
    Print(&there, text[0], sizeof(text[0]));
    Print(now, text[1], sizeof(text[1]));
    if (!strcmp(now->name, "wear")) /* it is not an option */
      (void)snprintf(message, size, "the bodies wear by %s there, not by %s (-wear_cycles)", text[0], text[1]);
    else
      (void)snprintf(message, size, "-%s is %s there, not %s", now->name, text[0], text[1]);
    return PETSC_TRUE;
  }
  if (FindOther(f, parameters, message, size, &other)) (void)SamFileNote(f, -1);
  return other;
}
