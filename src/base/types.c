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

PetscErrorCode SamTypesList(PetscFunctionList list, char text[], size_t size)
{
  const char **types;
  int          count;

  PetscFunctionBegin;
  PetscCall(SamTypesGet(list, &types, &count));
  text[0] = '\0';
  for (int t = 0; t < count; t++) {
    if (t) PetscCall(PetscStrlcat(text, t + 1 < count ? ", " : " or ", size));
    PetscCall(PetscStrlcat(text, types[t], size));
  }
  PetscCall(PetscFree(types));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTypesOption(PetscFunctionList list, const SamOptions *from, const char name[], const char help[],
                              char type[], size_t size, PetscBool *set)
{
  const char **types;
  int          count;
  char         words[512] = "";

  PetscFunctionBegin;
  PetscCall(SamTypesGet(list, &types, &count));
  for (int t = 0; t < count; t++) {
    if (t) PetscCall(PetscStrlcat(words, ",", sizeof(words)));
    PetscCall(PetscStrlcat(words, types[t], sizeof(words)));
  }
  PetscCall(PetscFree(types));
  PetscCall(SamOptionsWord(from, name, help, words, type, size, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTypesCheckOption(PetscFunctionList list, const SamOptions *from, const char option[],
                                   const char type[])
{
  void (*create)(void);
  char types[512];

  PetscFunctionBegin;
  PetscCall(PetscFunctionListFind(list, type, &create));
  PetscCall(SamTypesList(list, types, sizeof(types)));
  PetscCheck(create, from->comm, SAM_ERR_USER, "-%s%s %s: expected %s", SamOptionsPrefix(from), option, type, types);
  PetscFunctionReturn(PETSC_SUCCESS);
}
