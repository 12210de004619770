/*
  Reading options, with errors that name the mistake.

  PETSc's own functions accept trailing text in some places, and report a wrong value with a stack trace that does not
  say which option was meant. Here the whole text must be a value, and the error names the option, the text and what was
  expected.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/help.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_SIZE  PETSC_MAX_PATH_LEN
#define MOST_WHOLE (1LL << 53) /* doubles hold whole numbers exactly up to this */

PetscErrorCode SamSetPrefix(char to[SAM_PREFIX], const char prefix[])
{
  PetscFunctionBegin;
  PetscCheck(!prefix || strlen(prefix) < SAM_PREFIX, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
             "Prefix %s: expected at most %d characters", prefix, SAM_PREFIX - 1);
  PetscCall(PetscStrncpy(to, prefix ? prefix : "", SAM_PREFIX));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *SamOptionsPrefix(const SamOptions *from)
{
  return from->prefix ? from->prefix : "";
}

/* A line of the help for an option with this default. */
static PetscErrorCode Describe(const SamOptions *from, const char name[], const char help[], const char argument[],
                               const char value[])
{
  const SamOptionHelp option = {name, argument, help, value, ""};

  PetscFunctionBegin;
  PetscCall(SamOptionsDescribe(from, &option));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The most characters of a wrong value that a message quotes. */
#define QUOTED 60

/* A wrong value as a message quotes it. */
static const char *Quote(char text[])
{
  if (strlen(text) > QUOTED) (void)strcpy(text + QUOTED, "...");
  return text;
}

/* Gets the text of an option; an option without a value is an error. */
static PetscErrorCode GetText(const SamOptions *from, const char name[], const char expected[], char text[],
                              size_t size, PetscBool *set)
{
  char option[128];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", name));
  text[0] = '\0';
  PetscCall(PetscOptionsGetString(NULL, from->prefix, option, text, size, set));
  PetscCheck(!*set || text[0], from->comm, SAM_ERR_USER, "-%s%s has no value: expected %s", SamOptionsPrefix(from),
             name, expected);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *SamRangeDescribe(SamRange range)
{
  switch (range) {
  case SAM_RANGE_NONNEGATIVE:
    return "a number >= 0";
  case SAM_RANGE_POSITIVE:
    return "a number > 0";
  case SAM_RANGE_POSITIVE_INF:
    return "a number > 0 or inf";
  case SAM_RANGE_NOT_ZERO:
    return "a number other than 0, or inf";
  case SAM_RANGE_PART:
    return "a number > 0 and < 1";
  default:
    return "a finite number";
  }
}

PetscBool SamRangeHas(SamRange range, double value)
{
  if (isnan(value)) return PETSC_FALSE;
  if (isinf(value)) return range == SAM_RANGE_NOT_ZERO || (range == SAM_RANGE_POSITIVE_INF && value > 0);
  if (range == SAM_RANGE_NONNEGATIVE) return value >= 0;
  if (range == SAM_RANGE_ANY || range == SAM_RANGE_NOT_ZERO) return range == SAM_RANGE_ANY || value != 0;
  return value > 0 && (range != SAM_RANGE_PART || value < 1);
}

/* What is read: one number, or two, real ones in a range, or whole ones from `least` on. */
typedef struct {
  PetscBool pair, whole;
  SamRange  range;
  PetscInt  least;
} Kind;

/* Reads one number at *text and moves past it and a comma behind it; whether it is one of the kind. */
static PetscBool ReadNumber(const Kind *kind, const char **text, double *value)
{
  long long number = 0;
  char     *end;

  errno = 0;
  if (kind->whole)
    *value = (double)(number = strtoll(*text, &end, 10));
  else
    *value = strtod(*text, &end);
  if (end == *text || (errno == ERANGE && (kind->whole || isinf(*value))) || (*end && *end != ',')) return PETSC_FALSE;
  *text = *end ? end + 1 : end;
  if (*end && !end[1]) return PETSC_FALSE;
  return kind->whole ? number >= kind->least && number <= PETSC_MAX_INT && number <= MOST_WHOLE
                     : SamRangeHas(kind->range, *value);
}

/*
  Refuses two lengths that are likely to be one number with a decimal comma: 2,6e-3 has no point and no exponent before
  the comma, and an exponent after it.
*/
static PetscErrorCode RefuseDecimalComma(const SamOptions *from, const char name[], const char text[],
                                         const double v[2])
{
  char point[TEXT_SIZE], numbers[64]; /* PetscSNPrintf() would write 2 as "2." */

  PetscFunctionBegin;
  if (!SamIsDecimalComma(text) || !strpbrk(text, "eE") || strchr(text, '.')) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(point, text, sizeof(point)));
  *strchr(point, ',') = '.';
  (void)snprintf(numbers, sizeof(numbers), "%g m by %g m", v[0], v[1]);
  SETERRQ(from->comm, SAM_ERR_USER,
          "-%s%s %s: the comma separates two lengths, %s: expected %s, with a decimal point, or two lengths that both "
          "have one",
          SamOptionsPrefix(from), name, text, numbers, point);
}

/* Describes an option of one or two numbers, and reads it; one number stands for both. */
static PetscErrorCode ReadNumbers(const SamOptions *from, const char name[], const char help[], const Kind *kind,
                                  double value[], PetscBool *set)
{
  const char *const argument[2][2] = {{"<number>", "<number>[,<number>]"}, {"<integer>", "<integer>[,<integer>]"}};
  const int         digits         = kind->whole ? 17 : 6;
  char              shown[64], expected[96], text[TEXT_SIZE];
  const char       *rest = text;
  double            v[2] = {0, 0};
  PetscInt          n    = 0;
  PetscBool         good = PETSC_TRUE, found;

  PetscFunctionBegin;
  (void)snprintf(shown, sizeof(shown), kind->pair ? "%.*g,%.*g" : "%.*g", digits, value[0], digits, value[kind->pair]);
  if (isnan(value[0])) shown[0] = '\0'; /* no default */
  PetscCall(Describe(from, name, help, argument[kind->whole][kind->pair], shown));
  if (kind->whole)
    (void)snprintf(expected, sizeof(expected), "an integer >= %lld", (long long)kind->least);
  else
    (void)snprintf(expected, sizeof(expected), "%s", SamRangeDescribe(kind->range));
  if (kind->pair) PetscCall(PetscStrlcat(expected, ", or two separated by a comma", sizeof(expected)));
  PetscCall(GetText(from, name, expected, text, sizeof(text), &found));
  if (set) *set = found;
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  while (good && *rest && n < 1 + (PetscInt)kind->pair) good = ReadNumber(kind, &rest, &v[n++]);
  if (!good || n == 0 || *rest) {
    const char *why = SamExplainNumber(text);

    SETERRQ(from->comm, SAM_ERR_USER, "-%s%s %s: expected %s%s", SamOptionsPrefix(from), name, Quote(text), expected,
            why);
  }
  if (n == 2 && kind->range == SAM_RANGE_POSITIVE) PetscCall(RefuseDecimalComma(from, name, text, v));
  value[0] = v[0];
  if (kind->pair) value[1] = v[n - 1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsReal(const SamOptions *from, const char name[], const char help[], SamRange range,
                              PetscReal *value, PetscBool *set)
{
  return ReadNumbers(from, name, help, &(Kind){.range = range}, value, set);
}

PetscErrorCode SamOptionsRealPair(const SamOptions *from, const char name[], const char help[], SamRange range,
                                  PetscReal value[2], PetscBool *set)
{
  return ReadNumbers(from, name, help, &(Kind){.pair = PETSC_TRUE, .range = range}, value, set);
}

PetscErrorCode SamOptionsReals(const SamOptions *from, const char name[], const char help[], SamRange range,
                               PetscInt most, PetscReal values[], PetscInt *count)
{
  const Kind  kind = {.range = range};
  char        expected[96], text[TEXT_SIZE];
  const char *rest = text;
  double      number;
  PetscBool   good = PETSC_TRUE, found;

  PetscFunctionBegin;
  *count = 0;
  PetscCall(Describe(from, name, help, "<number>[,...]", ""));
  (void)snprintf(expected, sizeof(expected), "%s, or at most %d separated by commas", SamRangeDescribe(range),
                 (int)most);
  PetscCall(GetText(from, name, expected, text, sizeof(text), &found));
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  while (good && *rest && *count < most) {
    good               = ReadNumber(&kind, &rest, &number);
    values[(*count)++] = number;
  }
  PetscCheck(good && !*rest, from->comm, SAM_ERR_USER, "-%s%s %s: expected %s", SamOptionsPrefix(from), name,
             Quote(text), expected);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsInt(const SamOptions *from, const char name[], const char help[], PetscInt least,
                             PetscInt *value, PetscBool *set)
{
  double number = (double)*value;

  PetscFunctionBegin;
  PetscCall(ReadNumbers(from, name, help, &(Kind){.whole = PETSC_TRUE, .least = least}, &number, set));
  *value = (PetscInt)number;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsIntPair(const SamOptions *from, const char name[], const char help[], PetscInt least,
                                 PetscInt value[2], PetscBool *set)
{
  const Kind kind      = {.pair = PETSC_TRUE, .whole = PETSC_TRUE, .least = least};
  double     number[2] = {(double)value[0], (double)value[1]};

  PetscFunctionBegin;
  PetscCall(ReadNumbers(from, name, help, &kind, number, set));
  for (int k = 0; k < 2; k++) value[k] = (PetscInt)number[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsBool(const SamOptions *from, const char name[], const char help[], PetscBool *value,
                              PetscBool *set)
{
  static const char *const yes[] = {"1", "true", "yes", "on", NULL}, *const no[] = {"0", "false", "no", "off", NULL};
  const SamOptionHelp option = {name, "[<bool>]", help, *value ? "true" : "false", "true,false"};
  char                dashed[128], text[TEXT_SIZE] = "";
  PetscBool           found, good;

  PetscFunctionBegin;
  PetscCall(SamOptionsDescribe(from, &option));
  PetscCall(PetscSNPrintf(dashed, sizeof(dashed), "-%s", name));
  PetscCall(PetscOptionsGetString(NULL, from->prefix, dashed, text, sizeof(text), &found));
  if (set) *set = found;
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  good = !text[0]; /* the bare option means yes */
  if (good) *value = PETSC_TRUE;
  for (PetscInt w = 0; yes[w] && !good; w++) {
    *value = !strcmp(text, yes[w]);
    good   = *value || !strcmp(text, no[w]);
  }
  PetscCheck(good, from->comm, SAM_ERR_USER, "-%s%s %s: expected true or false", SamOptionsPrefix(from), name,
             Quote(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is expected of a text, for messages. */
static void DescribeText(const SamOptionHelp *option, char text[], size_t size)
{
  if (option->words[0])
    (void)snprintf(text, size, "%s of %s", strchr(option->argument, ',') ? "some" : "one", option->words);
  else
    (void)snprintf(text, size, "%s", strstr(option->argument, "file") ? "the name of a file" : "a string");
}

/* Reads a text of fewer than `size` characters, which is described by `option`. */
static PetscErrorCode ReadText(const SamOptions *from, const SamOptionHelp *option, char value[], size_t size,
                               PetscBool *set)
{
  char      text[TEXT_SIZE], expected[640];
  PetscBool found;

  PetscFunctionBegin;
  DescribeText(option, expected, sizeof(expected));
  PetscCall(SamOptionsDescribe(from, option));
  PetscCall(GetText(from, option->name, expected, text, sizeof(text), &found));
  if (set) *set = found;
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(strlen(text) < size, from->comm, SAM_ERR_USER, "-%s%s: expected at most %d characters",
             SamOptionsPrefix(from), option->name, (int)size - 1);
  PetscCall(PetscStrncpy(value, text, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsString(const SamOptions *from, const char name[], const char help[], char value[], size_t size,
                                PetscBool *set)
{
  return ReadText(from, &(SamOptionHelp){name, "<string>", help, value, ""}, value, size, set);
}

PetscErrorCode SamOptionsFile(const SamOptions *from, const char name[], const char help[], char value[], size_t size,
                              PetscBool *set)
{
  return ReadText(from, &(SamOptionHelp){name, "<file>", help, value, ""}, value, size, set);
}

PetscErrorCode SamOptionsWord(const SamOptions *from, const char name[], const char help[], const char words[],
                              char value[], size_t size, PetscBool *set)
{
  return ReadText(from, &(SamOptionHelp){name, "<keyword>", help, value, words}, value, size, set);
}

PetscErrorCode SamOptionsWords(const SamOptions *from, const char name[], const char help[], const char words[],
                               char value[], size_t size, PetscBool *set)
{
  return ReadText(from, &(SamOptionHelp){name, "<keyword>[,...]", help, value, words}, value, size, set);
}

PetscErrorCode SamOptionsEnum(const SamOptions *from, const char name[], const char help[], const char *const words[],
                              PetscInt *value, PetscBool *set)
{
  char                text[TEXT_SIZE], list[TEXT_SIZE], commas[TEXT_SIZE];
  const SamOptionHelp option = {name, "<keyword>", help, words[*value], commas};
  PetscInt            chosen = -1, count = 0;
  PetscBool           found;

  PetscFunctionBegin;
  while (words[count]) count++;
  SamJoin(count, words, ", ", " or ", list, sizeof(list));
  SamJoin(count, words, ",", ",", commas, sizeof(commas));
  PetscCall(SamOptionsDescribe(from, &option));
  PetscCall(GetText(from, name, list, text, sizeof(text), &found));
  if (set) *set = found;
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt w = 0; w < count; w++)
    if (!strcmp(text, words[w])) chosen = w;
  PetscCheck(chosen >= 0, from->comm, SAM_ERR_USER, "-%s%s %s: expected %s", SamOptionsPrefix(from), name, Quote(text),
             list);
  *value = chosen;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsHasViewer(const SamOptions *from, const char name[], const char help[], PetscBool *set)
{
  char option[128], text[TEXT_SIZE] = "";

  PetscFunctionBegin;
  PetscCall(Describe(from, name, help, "[<viewer>]", ""));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", name));
  PetscCall(PetscOptionsGetString(NULL, from->prefix, option, text, sizeof(text), set));
  PetscCheck(!*set || !text[0] || !strncmp(text, "ascii", 5) || text[0] == ':', from->comm, SAM_ERR_USER,
             "-%s%s %s: expected nothing, ascii or ascii:file", SamOptionsPrefix(from), name, Quote(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
