/* Errors of numbers in closed form, by their causes. */
#include <petsam/private/errors.h>
#include <string.h>

/* Returns the place of the error of a number, of that many letters, by a cause; the count: there is none. */
static PetscInt Find(const SamDoubts *d, const char name[], size_t letters, SamCause cause)
{
  PetscInt k = 0;

  while (k < d->count &&
         !(d->of[k].cause == cause && strlen(d->of[k].name) == letters && !strncmp(d->of[k].name, name, letters)))
    k++;
  return k;
}

static void Note(SamDoubts *d, SamCause cause, double error, PetscBool known, const char names[])
{
  for (const char *name = names; *name; name += strspn(name, " ")) {
    const size_t   letters = strcspn(name, " ");
    const PetscInt k       = Find(d, name, letters, cause);

    if ((error > 0 || known) && k < SAM_DOUBTS) {
      if (k == d->count) {
        d->count++;
        d->of[k].cause = cause;
        d->of[k].error = 0;
        d->of[k].known = PETSC_FALSE;
        (void)snprintf(d->of[k].name, sizeof(d->of[k].name), "%.*s", (int)letters, name);
      }
      if (known)
        d->of[k].error = PetscMin(error, 1);
      else if (!d->of[k].known)
        d->of[k].error = PetscMax(d->of[k].error, PetscMin(error, 1));
      if (known) d->of[k].known = PETSC_TRUE;
    }
    name += letters;
  }
}

void SamDoubtsAdd(SamDoubts *d, SamCause cause, double error, const char names[])
{
  Note(d, cause, error, PETSC_FALSE, names);
}

void SamDoubtsSet(SamDoubts *d, SamCause cause, double error, const char names[])
{
  Note(d, cause, error, PETSC_TRUE, names);
}

double SamDoubtsOf(const SamDoubts *d, const char name[], SamCause cause, PetscBool *known)
{
  const PetscInt k = Find(d, name, strlen(name), cause);

  *known = k < d->count ? d->of[k].known : PETSC_FALSE;
  return k < d->count ? d->of[k].error : 0;
}
