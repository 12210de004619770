/* Lists of parameters by name. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/parameters.h>
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
  SamValidPointer(p, 1);
  SamValidPointer(name, 2);
  SamValidPointer(values, 5);
  PetscCheck(count > 0 && count <= SAM_PARAMETER_VALUES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Parameter %s: count = %" PetscInt_FMT ": expected 1 to %d values", name, count, SAM_PARAMETER_VALUES);
  PetscCall(Add(p, name, fixed, &added));
  added->count = count;
  for (PetscInt k = 0; k < count; k++) added->value[k] = values[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamParametersAddText(SamParameters *p, const char name[], PetscBool fixed, const char text[])
{
  SamParameter *added = NULL;

  PetscFunctionBegin;
  SamValidPointer(p, 1);
  SamValidPointer(name, 2);
  SamValidPointer(text, 4);
  PetscCall(Add(p, name, fixed, &added));
  PetscCall(PetscStrncpy(added->text, text, sizeof(added->text)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamParametersAddChecksum(SamParameters *p, const char name[], uint64_t checksum)
{
  char text[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(text, sizeof(text), "of checksum %08lx%08lx", (unsigned long)(checksum >> 32),
                          (unsigned long)(checksum & 0xffffffff)));
  PetscCall(SamParametersAddText(p, name, PETSC_TRUE, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamParametersAddOptions(SamParameters *p, PetscInt count, const SamOptionRow rows[],
                                       const void *settings)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < count; k++) {
    const PetscReal *value = (const PetscReal *)(const void *)((const char *)settings + rows[k].member);

    if (!rows[k].recorded) continue;
    PetscCheck(rows[k].kind == SAM_OPTION_REAL, PETSC_COMM_SELF, PETSC_ERR_SUP,
               "Option %s: only real numbers are recorded", rows[k].name);
    PetscCall(SamParametersAddReals(p, rows[k].name, PETSC_TRUE, PetscMax(rows[k].size, 1), value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamParameter *SamParametersFind(const SamParameters *p, const char name[])
{
  for (PetscInt k = 0; k < p->count; k++)
    if (!strcmp(p->list[k].name, name)) return &p->list[k];
  return NULL;
}
