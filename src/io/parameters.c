/* The parameters of a run, as attributes of its files. */
#include "ioimpl.h"
#include <string.h>

static PetscErrorCode Add(SamParameters *p, const char name[], PetscBool fixed, SamParameter **added)
{
  PetscFunctionBegin;
  PetscCheck(p->count < SAM_PARAMETERS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Parameter %s: there are %d parameters already, which is the most", name, SAM_PARAMETERS);
  *added = &p->list[p->count++];
  PetscCall(PetscMemzero(*added, sizeof(**added)));
  PetscCall(PetscStrncpy((*added)->name, name, sizeof((*added)->name)));
  (*added)->fixed = fixed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamParametersAddReals(SamParameters *p, const char name[], PetscBool fixed, PetscInt count,
                                     const PetscReal values[])
{
  SamParameter *added = NULL;

  PetscFunctionBegin;
  PetscCheck(count == 1 || count == 2, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Parameter %s: count = %" PetscInt_FMT ": expected 1 or 2 values", name, count);
  PetscCall(Add(p, name, fixed, &added));
  added->count = count;
  for (PetscInt k = 0; k < count; k++) added->value[k] = values[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamParametersAddText(SamParameters *p, const char name[], PetscBool fixed, const char text[])
{
  SamParameter *added = NULL;

  PetscFunctionBegin;
  PetscCall(Add(p, name, fixed, &added));
  PetscCall(PetscStrncpy(added->text, text, sizeof(added->text)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamParametersWrite(SamFile f, const SamParameters *parameters)
{
  for (PetscInt k = 0; k < parameters->count; k++) {
    const SamParameter *const p = &parameters->list[k];

    if (p->count)
      SamFileWriteAttribute(f, f->id, p->name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, p->count, p->value);
    else
      SamFileWriteTextAttribute(f, f->id, p->name, p->text);
  }
}

/* Reads the file's value of a parameter. */
static PetscErrorCode Read(SamFile f, const SamParameter *like, SamParameter *read)
{
  char *text = NULL;

  PetscFunctionBegin;
  *read = *like;
  if (like->count)
    SamFileReadAttribute(f, f->id, like->name, H5T_NATIVE_DOUBLE, like->count, read->value);
  else {
    SamFileReadTextAttribute(f, f->id, like->name, &text);
    PetscCall(PetscStrncpy(read->text, text ? text : "", sizeof(read->text)));
    PetscCall(PetscFree(text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Print(const SamParameter *p, char text[], size_t size)
{
  if (p->count == 0)
    (void)snprintf(text, size, "%s", p->text);
  else if (p->count == 1)
    (void)snprintf(text, size, "%.15g", (double)p->value[0]);
  else
    (void)snprintf(text, size, "%.15g,%.15g", (double)p->value[0], (double)p->value[1]);
}

static PetscBool Same(const SamParameter *a, const SamParameter *b)
{
  for (PetscInt k = 0; k < a->count; k++)
    if (!(a->value[k] == b->value[k])) return PETSC_FALSE;
  return strcmp(a->text, b->text) ? PETSC_FALSE : PETSC_TRUE;
}

PetscBool SamParametersDiffer(SamFile f, const SamParameters *parameters, char message[], size_t size)
{
  for (PetscInt k = 0; k < parameters->count; k++) {
    const SamParameter *const now = &parameters->list[k];
    SamParameter              there;
    char                      text[2][64];

    if (!now->fixed) continue;
    if (SamFileNote(f, H5Aexists(f->id, now->name)) <= 0) {
      (void)snprintf(message, size, "-%s is not given there", now->name);
      return PETSC_TRUE;
    }
    if (Read(f, now, &there)) (void)SamFileNote(f, -1);
    if (f->failed || Same(now, &there)) continue;
    Print(&there, text[0], sizeof(text[0]));
    Print(now, text[1], sizeof(text[1]));
    (void)snprintf(message, size, "-%s is %s there, not %s", now->name, text[0], text[1]);
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode SamOutputCopyOrigin(SamOutput from, SamOutput to)
{
  static const char *const texts[]   = {"options", "branch_checkpoint", "branch_results", "branch_gap", NULL};
  static const char *const numbers[] = {SAM_OUTPUT_BRANCH, "branch_cycles", NULL};

  PetscFunctionBegin;
  for (PetscInt k = 0; texts[k]; k++) {
    char *text = NULL;

    PetscCall(SamFileBegin(from->f));
    if (SamFileNote(from->f, H5Aexists(from->f->id, texts[k])) > 0)
      SamFileReadTextAttribute(from->f, from->f->id, texts[k], &text);
    PetscCall(SamFileEnd(from->f));
    if (text) PetscCall(SamOutputSetText(to, texts[k], text));
    PetscCall(PetscFree(text));
  }
  for (PetscInt k = 0; numbers[k]; k++) {
    double    number;
    PetscBool has = PETSC_FALSE;

    PetscCall(SamFileBegin(from->f));
    has = SamFileNote(from->f, H5Aexists(from->f->id, numbers[k])) > 0;
    if (has) SamFileReadAttribute(from->f, from->f->id, numbers[k], H5T_NATIVE_DOUBLE, 1, &number);
    PetscCall(SamFileEnd(from->f));
    if (has) PetscCall(SamOutputSetReals(to, numbers[k], 1, &number));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
