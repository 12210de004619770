/* Errors of numbers by their causes: the largest of each is kept, and told in one line per cause. */
#include <petsam/private/doubts.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#define SEVERAL 8 /* most numbers, */
#define REASONS 3 /* and most reasons that a line names */

const char *const SamCauseNames[SAM_CAUSES] = {"cells", "steps", "layers", "mesh"};

const char *SamErrorWrite(double error, char text[], size_t size)
{
  if (!(error < 0.995))
    (void)snprintf(text, size, "unknown");
  else
    (void)snprintf(text, size, error < 0.1 ? "%.2g %%" : "%.0f %%", 100 * error);
  return text;
}

/* Returns the place of the error of a number, of that many letters, by a cause; the count: there is none. */
static PetscInt Find(const SamDoubts *d, const char name[], size_t letters, SamCause cause)
{
  PetscInt k = 0;

  while (k < d->count &&
         !(d->of[k].cause == cause && strlen(d->of[k].name) == letters && !strncmp(d->of[k].name, name, letters)))
    k++;
  return k;
}

/* Keeps the larger one of two errors of a number, and what mends both. */
static void Keep(SamDoubt *kept, const SamDoubt *more)
{
  const PetscBool none =
    more->error > SAM_DOUBT_LARGE && kept->error > SAM_DOUBT_LARGE && !(more->factor > 0 && kept->factor > 0);

  if (more->known || (!kept->known && more->error > kept->error)) {
    kept->error = more->error;
    if (more->why[0]) (void)snprintf(kept->why, sizeof(kept->why), "%s", more->why);
  }
  kept->known = kept->known || more->known ? PETSC_TRUE : PETSC_FALSE;
  if (PetscMin(kept->factor, more->factor) < 0)
    kept->factor = SAM_DOUBT_WORSE;
  else
    kept->factor = none ? 0 : PetscMax(kept->factor, more->factor);
}

/* Adds an error of several numbers. */
static void Note(SamDoubts *d, const SamDoubt *more, const char names[])
{
  for (const char *name = names; *name; name += strspn(name, " ")) {
    const size_t   letters = strcspn(name, " ");
    const PetscInt k       = Find(d, name, letters, more->cause);

    if (k == d->count && k < SAM_DOUBTS) {
      d->of[k] = *more;
      (void)snprintf(d->of[k].name, sizeof(d->of[k].name), "%.*s", (int)letters, name);
      d->count++;
    } else if (k < d->count) {
      Keep(&d->of[k], more);
    }
    name += letters;
  }
}

/* Notes an error with its reason; at most 1 counts. */
static void NoteWith(SamDoubts *d, SamDoubt more, const char names[], const char why[], va_list values)
{
  more.error = PetscMin(more.error, 1);
  (void)vsnprintf(more.why, sizeof(more.why), why, values);
  Note(d, &more, names);
}

void SamDoubtsAdd(SamDoubts *d, SamCause cause, double error, double factor, const char names[], const char why[], ...)
{
  va_list values;

  va_start(values, why);
  if (error > 0) NoteWith(d, (SamDoubt){.cause = cause, .error = error, .factor = factor}, names, why, values);
  va_end(values);
}

void SamDoubtsSet(SamDoubts *d, SamCause cause, double error, double factor, const char names[], const char why[], ...)
{
  va_list values;

  va_start(values, why);
  NoteWith(d, (SamDoubt){.cause = cause, .error = error, .factor = factor, .known = PETSC_TRUE}, names, why, values);
  va_end(values);
}

void SamDoubtsJoin(SamDoubts *d, const SamDoubts *more, SamCause cause)
{
  for (PetscInt k = 0; k < more->count; k++)
    if (more->of[k].cause == cause) Note(d, &more->of[k], more->of[k].name);
}

double SamDoubtsOf(const SamDoubts *d, const char name[], SamCause cause, PetscBool *known)
{
  const PetscInt k = Find(d, name, strlen(name), cause);

  *known = k < d->count ? d->of[k].known : PETSC_FALSE;
  return k < d->count ? d->of[k].error : 0;
}

/* ---- a line ---- */

/* Lists the large errors by a cause, the largest first; returns their number. */
static PetscInt List(const SamDoubts *d, SamCause cause, PetscInt list[SAM_DOUBTS])
{
  PetscInt count = 0;

  for (PetscInt k = 0; k < d->count; k++) {
    PetscInt at = count;

    if (d->of[k].cause != cause || !(d->of[k].error > SAM_DOUBT_LARGE)) continue;
    for (; at > 0 && d->of[list[at - 1]].error < d->of[k].error; at--) list[at] = list[at - 1];
    list[at] = k;
    count++;
  }
  return count;
}

/* Appends a piece to a text: after `before` if it has pieces already, else after `first`. */
static void Append(char text[], size_t size, PetscInt pieces, const char first[], const char before[],
                   const char piece[])
{
  const size_t used = strlen(text);

  (void)snprintf(text + used, size - used, "%s%s", pieces ? before : first, piece);
}

/* True if a reason is that of an earlier listed error, or a part of another one's. */
static PetscBool IsSaid(const SamDoubts *d, PetscInt count, const PetscInt list[], PetscInt k)
{
  const char *why = d->of[list[k]].why;

  for (PetscInt n = 0; n < count; n++) {
    const char *other = d->of[list[n]].why;

    if (n != k && strstr(other, why) && (n < k || strlen(other) > strlen(why))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Appends the reasons of the listed errors, each once. */
static void AppendReasons(const SamDoubts *d, PetscInt count, const PetscInt list[], char text[], size_t size)
{
  PetscInt told = 0;

  for (PetscInt k = 0; k < count && told < REASONS; k++) {
    const char *why = d->of[list[k]].why;

    if (why[0] && !IsSaid(d, count, list, k)) Append(text, size, told++, " (", "; ", why);
  }
  if (told) Append(text, size, told, "", ")", "");
}

void SamDoubtsWrite(const SamDoubts *d, SamCause cause, double *factor, char text[], size_t size)
{
  PetscInt       list[SAM_DOUBTS];
  const PetscInt count = List(d, cause, list);
  char           one[64], error[SAM_ERROR_TEXT];
  PetscBool      worse = PETSC_FALSE;

  *factor = 0;
  text[0] = '\0';
  for (PetscInt k = 0; k < count; k++) {
    const SamDoubt *doubt = &d->of[list[k]];

    *factor = PetscMax(*factor, doubt->factor);
    worse   = worse || doubt->factor < 0 ? PETSC_TRUE : PETSC_FALSE;
    if (k >= SEVERAL) continue;
    (void)snprintf(one, sizeof(one), "%s %s", doubt->name, SamErrorWrite(doubt->error, error, sizeof(error)));
    Append(text, size, k, "", ", ", one);
  }
  if (worse) *factor = 0;
  if (count > SEVERAL) {
    (void)snprintf(one, sizeof(one), "%d more", (int)(count - SEVERAL));
    Append(text, size, count, "", " and ", one);
  }
  AppendReasons(d, count, list, text, size);
}
