/* Parts of messages: the prefix of options, and lists of names. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/base.h>

const char *SamOptionsPrefix(const SamOptions *from)
{
  return from->prefix ? from->prefix : "";
}

void SamJoin(PetscInt count, const char *const names[], const char between[], const char last[], char text[],
             size_t size)
{
  size_t used = 0;

  text[0] = '\0';
  for (PetscInt k = 0; k < count && used < size; k++)
    used += (size_t)snprintf(text + used, size - used, "%s%s", !k ? "" : k + 1 < count ? between : last, names[k]);
}
