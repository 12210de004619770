/* Lists of registered types, for the help and for messages. */
#include <petsam/private/baseimpl.h>
#include <stdlib.h>
#include <string.h>

static int CompareNames(const void *a, const void *b)
{
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

PetscErrorCode SamTypesGet(PetscFunctionList list, const char ***types, int *count)
{
  PetscFunctionBegin;
  PetscCall(PetscFunctionListGet(list, types, count));
  while (*count > 0 && !(*types)[*count - 1]) --*count; /* PETSc counts the NULL at the end */
  qsort(*types, (size_t)*count, sizeof(**types), CompareNames);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Joins the names, with this text between them. */
static PetscErrorCode Join(PetscFunctionList list, const char between[], const char last[], char text[], size_t size)
{
  const char **types;
  int          count;

  PetscFunctionBegin;
  PetscCall(SamTypesGet(list, &types, &count));
  SamJoin(count, types, between, last, text, size);
  PetscCall(PetscFree(types));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTypesList(PetscFunctionList list, char text[], size_t size)
{
  PetscFunctionBegin;
  PetscCall(Join(list, ", ", " or ", text, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTypesOption(PetscFunctionList list, const SamOptions *from, const char name[], const char help[],
                              char type[], size_t size, PetscBool *set)
{
  char               words[512];
  const SamOptionRow row = {name, help, SAM_OPTION_WORD, .size = (PetscInt)size, .words = words};

  PetscFunctionBegin;
  PetscCall(Join(list, ",", ",", words, sizeof(words)));
  PetscCall(SamOptionsRead(from, NULL, 1, &row, type, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}
