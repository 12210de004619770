/* The name of a file with the patch that is read of it: NAME, NAME:PATCH, NAME:PATCH:local, NAME:PATCH:local:LOWER. */
#include <petsam/private/compliance.h>
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Reads a whole number above 0, or 0, of which `end` is the end. */
static PetscInt Number(const char text[], const char **end)
{
  char      *last;
  const long value = isdigit((unsigned char)text[0]) ? strtol(text, &last, 10) : -1;

  *end = value >= 0 ? last : text;
  return value >= 0 && value < 1000000 ? (PetscInt)value : -1;
}

size_t SamComplianceFileName(const char text[], PetscInt *patch, PetscBool *local, PetscInt *lower)
{
  static const char word[] = ":local";

  for (const char *colon = strchr(text, ':'); colon; colon = strchr(colon + 1, ':')) {
    const char *end;

    *lower = 0;
    *patch = Number(colon + 1, &end);
    *local = !strncmp(end, word, sizeof(word) - 1) ? PETSC_TRUE : PETSC_FALSE;
    if (*local) end += sizeof(word) - 1;
    if (*local && *end == ':') *lower = Number(end + 1, &end);
    if (*patch >= 0 && *lower >= 0 && !*end) return (size_t)(colon - text);
  }
  *patch = *lower = 0;
  *local          = PETSC_FALSE;
  return strlen(text);
}
