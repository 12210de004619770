/*
  Reading options, with errors that name the mistake.

  An option is a row of a table. Help, reading, the checks of what it needs and excludes, and its record among the
  parameters follow from the row.

  PETSc's own functions accept trailing text in some places, and report a wrong value with a stack trace that does not
  name the option. Here the whole text must be a value, and the error names the option, the text and the expected
  values.
*/
#include <petsam/private/baseimpl.h>
#include <petsam/private/help.h>
#include <petsam/private/base.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TEXT_SIZE  PETSC_MAX_PATH_LEN
#define MOST_WHOLE (1LL << 53) /* largest value up to which doubles represent all integers */

PetscErrorCode SamSetPrefix(char to[SAM_PREFIX], const char prefix[])
{
  PetscFunctionBegin;
  PetscCheck(!prefix || strlen(prefix) < SAM_PREFIX, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ,
             "Prefix %s: expected at most %d characters", prefix, SAM_PREFIX - 1);
  PetscCall(PetscStrncpy(to, prefix ? prefix : "", SAM_PREFIX));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Maximum number of characters of a wrong value that a message quotes */
#define QUOTED 60

/* Returns a wrong value as it is quoted in a message. */
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

/* ---- numbers ---- */

/* Returns the largest number of values of a row's option. */
static PetscInt CountOf(const SamOptionRow *row)
{
  return PetscMax(row->size, 1);
}

/* Reads an integer at *text and moves to the end of the field; returns true if the row allows the integer. */
static PetscBool ReadInteger(const SamOptionRow *row, const char **text, double *value)
{
  char           *end;
  const long long number = (errno = 0, strtoll(*text, &end, 10));
  const PetscBool good   = end != *text && !errno && (!*end || *end == ',') ? PETSC_TRUE : PETSC_FALSE;

  *value = (double)number;
  *text  = end;
  return good && number >= row->least && number <= (row->most ? row->most : PETSC_MAX_INT) && number <= MOST_WHOLE;
}

/*
  Reads one number at *text and moves past it and past a comma after it; returns true if it is of the row's kind.
  `unit`: true if a unit follows.
*/
static PetscBool ReadNumber(const SamOptionRow *row, const char **text, double *value, PetscBool *unit)
{
  const char *end  = *text;
  PetscBool   good = PETSC_TRUE;

  *unit = PETSC_FALSE;
  if (row->kind == SAM_OPTION_INT)
    good = ReadInteger(row, &end, value);
  else
    good = SamReadReal(row->unit, *text, &end, value, unit) && SamRangeHas(row->range, *value);
  *text = *end ? end + 1 : end;
  return good && (!*end || end[1]);
}

/*
  Rejects two lengths that are likely to be one number with a decimal comma, such as 2,6e-3: no point and no exponent
  before the comma, and an exponent after it.
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

/* Writes why a text is no integer that an option may have; leaves another reason if it is no whole number. */
static void ExplainInteger(const SamOptionRow *row, const char text[], char why[], size_t size)
{
  char           *end;
  const double    number = strtod(text, &end);
  const long long most   = row->most ? row->most : PETSC_MAX_INT;

  if (end == text || *end || number != floor(number) || !isfinite(number)) return;
  if (number > (double)most)
    (void)snprintf(why, size, "; the largest is %lld", most);
  else if (text[strspn(text, "0123456789")])
    (void)snprintf(why, size, "; in digits: %.0f", number);
}

/* Reads numbers, some of which may be missing; `expected` describes them. Returns their count; 0: the option is
   absent. */
static PetscErrorCode ReadNumbers(const SamOptions *from, const SamOptionRow *row, const char expected[], double v[],
                                  PetscInt *n)
{
  char        text[TEXT_SIZE];
  const char *rest = text;
  PetscBool   good = PETSC_TRUE, found, unit[2] = {PETSC_FALSE}; /* unit: after the first number, and after this one */
  char        why[192];

  PetscFunctionBegin;
  *n = 0;
  PetscCall(GetText(from, row->name, expected, text, sizeof(text), &found));
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  while (good && *rest && *n < CountOf(row)) {
    good = ReadNumber(row, &rest, &v[*n], &unit[*n > 0]) && (!*n || unit[0] == unit[1]);
    ++*n;
  }
  if (!good || *n == 0 || *rest) {
    SamExplainNumber(text, row->unit, why, sizeof(why));
    if (row->kind == SAM_OPTION_INT) ExplainInteger(row, text, why, sizeof(why));
    SETERRQ(from->comm, SAM_ERR_USER, "-%s%s %s: expected %s%s", SamOptionsPrefix(from), row->name, Quote(text),
            expected, !why[0] && row->words ? row->words : why);
  }
  if (*n == 2 && row->range == SAM_RANGE_POSITIVE) PetscCall(RefuseDecimalComma(from, row->name, text, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads one or two numbers; a single number is used for both. */
static PetscErrorCode ReadNumberRow(const SamOptions *from, const SamOptionRow *row, void *member, PetscBool *given)
{
  static const char *const argument[2][2] = {{"<number>", "<number>[,<number>]"},
                                             {"<integer>", "<integer>[,<integer>]"}};
  const PetscBool          whole          = row->kind == SAM_OPTION_INT ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt           count          = CountOf(row);
  const int                digits         = whole ? 17 : 6;
  PetscReal *const         reals          = (PetscReal *)member;
  PetscInt *const          wholes         = (PetscInt *)member;
  char                     shown[64]      = "", expected[96];
  double                   v[2];
  PetscInt                 n;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) v[k] = whole ? (double)wholes[k % count] : (double)reals[k % count];
  if (!isnan(v[0])) /* if there is a default */
    (void)snprintf(shown, sizeof(shown), count > 1 ? "%.*g,%.*g" : "%.*g", digits, v[0], digits, v[1]);
  PetscCall(
    SamOptionsDescribe(from, &(SamOptionHelp){row->name, argument[whole][count - 1], row->text, shown, "", row->unit}));
  if (whole && row->most)
    (void)snprintf(expected, sizeof(expected), "an integer from %lld to %lld", (long long)row->least,
                   (long long)row->most);
  else if (whole)
    (void)snprintf(expected, sizeof(expected), "an integer >= %lld", (long long)row->least);
  else
    (void)snprintf(expected, sizeof(expected), "%s", SamRangeDescribe(row->range));
  if (count > 1) PetscCall(PetscStrlcat(expected, ", or two separated by a comma", sizeof(expected)));
  PetscCall(ReadNumbers(from, row, expected, v, &n));
  *given = n > 0 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = 0; k < count && n > 0; k++) {
    if (whole)
      wholes[k] = (PetscInt)v[k % n];
    else
      reals[k] = (PetscReal)v[k % n];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsReals(const SamOptions *from, const SamOptionRow *row, PetscReal values[], PetscInt *count)
{
  char expected[96];

  PetscFunctionBegin;
  PetscCall(SamOptionsDescribe(from, &(SamOptionHelp){row->name, "<number>[,...]", row->text, "", "", row->unit}));
  (void)snprintf(expected, sizeof(expected), "%s, or at most %d separated by commas", SamRangeDescribe(row->range),
                 (int)row->size);
  PetscCall(ReadNumbers(from, row, expected, values, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- words and texts ---- */

/* Returns the place of a text in a list separated by commas; -1: not in the list. */
static int FindWord(const char list[], const char text[])
{
  const size_t length = strlen(text);
  int          w      = 0;

  for (const char *word = list; *word; w++) {
    const size_t n = strcspn(word, ",");

    if (n == length && !strncmp(word, text, n)) return w;
    word += n + (word[n] ? 1 : 0);
  }
  return -1;
}

/* Copies the word at this place. */
static void CopyWord(const char list[], int place, char text[], size_t size)
{
  for (; place > 0 && *list; place--) {
    list += strcspn(list, ",");
    list += *list ? 1 : 0;
  }
  (void)snprintf(text, size, "%.*s", (int)strcspn(list, ","), list);
}

/* Writes "a,b,c" as "a, b or c". */
static void ListWords(const char words[], char text[], size_t size)
{
  const char *last = strrchr(words, ',');
  size_t      used = 0;

  for (; *words && used + 5 < size; words++) {
    const char *between = *words != ',' ? NULL : words == last ? " or " : ", ";

    used += (size_t)snprintf(text + used, size - used, between ? "%s" : "%.1s", between ? between : words);
  }
  text[used] = '\0';
}

/* Reads a logical value; the bare option means yes. */
static PetscErrorCode ReadBool(const SamOptions *from, const SamOptionRow *row, PetscBool *value, PetscBool *given)
{
  char      dashed[128], text[TEXT_SIZE] = "";
  PetscBool yes;

  PetscFunctionBegin;
  PetscCall(SamOptionsDescribe(from, &(SamOptionHelp){row->name, "[<bool>]", row->text, *value ? "true" : "false",
                                                      "true,false", NULL}));
  PetscCall(PetscSNPrintf(dashed, sizeof(dashed), "-%s", row->name));
  PetscCall(PetscOptionsGetString(NULL, from->prefix, dashed, text, sizeof(text), given));
  if (!*given) PetscFunctionReturn(PETSC_SUCCESS);
  yes = !text[0] || FindWord("1,true,yes,on", text) >= 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCheck(yes || FindWord("0,false,no,off", text) >= 0, from->comm, SAM_ERR_USER, "-%s%s %s: expected true or false",
             SamOptionsPrefix(from), row->name, Quote(text));
  *value = yes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads one word of the row's list; the value is its place, or, for a logical value, true if it is not the first. */
static PetscErrorCode ReadChoice(const SamOptions *from, const SamOptionRow *row, void *member, PetscBool *given)
{
  char text[TEXT_SIZE], list[TEXT_SIZE];
  int  place = row->kind == SAM_OPTION_BOOL ? (int)*(PetscBool *)member : *(int *)member;

  PetscFunctionBegin;
  ListWords(row->words, list, sizeof(list));
  CopyWord(row->words, place, text, sizeof(text));
  PetscCall(SamOptionsDescribe(from, &(SamOptionHelp){row->name, "<keyword>", row->text, text, row->words, NULL}));
  PetscCall(GetText(from, row->name, list, text, sizeof(text), given));
  if (!*given) PetscFunctionReturn(PETSC_SUCCESS);
  place = FindWord(row->words, text);
  PetscCheck(place >= 0, from->comm, SAM_ERR_USER, "-%s%s %s: expected %s", SamOptionsPrefix(from), row->name,
             Quote(text), list);
  if (row->kind == SAM_OPTION_BOOL)
    *(PetscBool *)member = place > 0 ? PETSC_TRUE : PETSC_FALSE;
  else
    *(int *)member = place;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- files ---- */

#define MOST_FILES 64

static SamOptionFile named[MOST_FILES];
static PetscInt      nameds = 0;

static PetscBool IsFile(SamOptionKind kind)
{
  return kind == SAM_OPTION_FILE || kind == SAM_OPTION_FILES || kind == SAM_OPTION_OUTPUT ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamOptionsNoteFile(const SamOptions *from, SamOptionKind kind, const char name[], const char shown[])
{
  SamOptionFile one = {.kind = kind};

  PetscFunctionBegin;
  if (!IsFile(kind) && kind != SAM_OPTION_VIEWER) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(one.name, sizeof(one.name), "-%s%s", SamOptionsPrefix(from), name));
  PetscCall(PetscSNPrintf(one.shown, sizeof(one.shown), "-%s%s", SamOptionsPrefix(from), shown));
  for (PetscInt k = 0; k < nameds; k++)
    if (!strcmp(named[k].name, one.name)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(nameds < MOST_FILES, from->comm, PETSC_ERR_ARG_OUTOFRANGE, "More than %d options name files", MOST_FILES);
  named[nameds++] = one;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamOptionFile *SamOptionsFile(PetscInt k)
{
  return k < nameds ? &named[k] : NULL;
}

/* Reads a text, the name of a file, or one or more words, which are checked. */
static PetscErrorCode ReadText(const SamOptions *from, const SamOptionRow *row, char value[], PetscBool *given)
{
  static const char *const arguments[] = {
    [SAM_OPTION_STRING] = "<string>", [SAM_OPTION_FILE] = "<file>",    [SAM_OPTION_FILES] = "<file>",
    [SAM_OPTION_OUTPUT] = "<file>",   [SAM_OPTION_WORD] = "<keyword>", [SAM_OPTION_WORDS] = "<keyword>[,...]"};
  const char *words = row->words ? row->words : "";
  char        text[TEXT_SIZE], expected[640];

  PetscFunctionBegin;
  if (row->kind == SAM_OPTION_WORD)
    ListWords(words, expected, sizeof(expected));
  else if (row->kind == SAM_OPTION_WORDS)
    (void)snprintf(expected, sizeof(expected), "some of %s", words);
  else
    (void)snprintf(expected, sizeof(expected), IsFile(row->kind) ? "the name of a file" : "a string");
  PetscCall(SamOptionsNoteFile(from, row->kind, row->name, row->name));
  PetscCall(SamOptionsDescribe(from, &(SamOptionHelp){row->name, arguments[row->kind], row->text, value, words, NULL}));
  PetscCall(GetText(from, row->name, expected, text, sizeof(text), given));
  if (!*given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(row->kind != SAM_OPTION_WORD || FindWord(words, text) >= 0, from->comm, SAM_ERR_USER,
             "-%s%s %s: expected %s", SamOptionsPrefix(from), row->name, Quote(text), expected);
  PetscCheck(strlen(text) < (size_t)row->size, from->comm, SAM_ERR_USER, "-%s%s: expected at most %d characters",
             SamOptionsPrefix(from), row->name, (int)row->size - 1);
  PetscCall(PetscStrncpy(value, text, (size_t)row->size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if a viewer is requested; the code that uses it creates it. */
static PetscErrorCode ReadViewer(const SamOptions *from, const SamOptionRow *row, PetscBool *given)
{
  char option[128], text[TEXT_SIZE] = "";

  PetscFunctionBegin;
  PetscCall(SamOptionsNoteFile(from, row->kind, row->name, row->name));
  PetscCall(SamOptionsDescribe(from, &(SamOptionHelp){row->name, "[<viewer>]", row->text, "", "", NULL}));
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", row->name));
  PetscCall(PetscOptionsGetString(NULL, from->prefix, option, text, sizeof(text), given));
  PetscCheck(!*given || !text[0] || !strncmp(text, "ascii", 5) || text[0] == ':', from->comm, SAM_ERR_USER,
             "-%s%s %s: expected nothing, ascii or ascii:file", SamOptionsPrefix(from), row->name, Quote(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- tables ---- */

static PetscErrorCode ReadRow(const SamOptions *from, const SamOptionRow *row, void *member, PetscBool *given)
{
  PetscFunctionBegin;
  switch (row->kind) {
  case SAM_OPTION_REAL:
  case SAM_OPTION_INT:
    PetscCall(ReadNumberRow(from, row, member, given));
    break;
  case SAM_OPTION_BOOL:
  case SAM_OPTION_ENUM:
    PetscCall(row->words ? ReadChoice(from, row, member, given) : ReadBool(from, row, (PetscBool *)member, given));
    break;
  case SAM_OPTION_VIEWER:
    PetscCall(ReadViewer(from, row, given));
    break;
  default:
    PetscCall(ReadText(from, row, (char *)member, given));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsHas(const SamOptions *from, const char option[], PetscBool *has)
{
  char name[64] = "", value[64] = "", text[TEXT_SIZE] = "", dashed[80];

  PetscFunctionBegin;
  (void)sscanf(option, "%63[^ ,:] %63[^ ,:]", name, value);
  PetscCall(PetscSNPrintf(dashed, sizeof(dashed), "-%s", name));
  PetscCall(PetscOptionsGetString(NULL, from->prefix, dashed, text, sizeof(text), has));
  if (value[0] && strcmp(text, value)) *has = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the member already contains a valid value, which is the default. */
static PetscBool HasDefault(const SamOptionRow *row, const void *member)
{
  if (row->kind == SAM_OPTION_REAL) return SamRangeHas(row->range, (double)*(const PetscReal *)member);
  if (row->kind == SAM_OPTION_INT) return *(const PetscInt *)member >= row->least ? PETSC_TRUE : PETSC_FALSE;
  return *(const char *)member ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamOptionsExclude(const SamOptions *from, const char given[], const char other[], const char reason[])
{
  const char *prefix = SamOptionsPrefix(from);
  PetscBool   both;

  PetscFunctionBegin;
  PetscCall(SamOptionsHas(from, other, &both));
  PetscCheck(!both, from->comm, SAM_ERR_USER, "-%s%s does not work with -%s%s: %s", prefix, given, prefix, other,
             reason);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsNeed(const SamOptions *from, PetscBool given, const char name[], const char needs[])
{
  static const char between[] = " or -";
  const char       *prefix    = SamOptionsPrefix(from);
  const char       *next      = needs, *end;
  PetscBool         has       = PETSC_FALSE;
  char              one[128];

  PetscFunctionBegin;
  if (!given) PetscFunctionReturn(PETSC_SUCCESS);
  while (next && !has) {
    end = strstr(next, between);
    (void)snprintf(one, sizeof(one), "%.*s", (int)(end ? (size_t)(end - next) : strlen(next)), next);
    PetscCall(SamOptionsHas(from, one, &has));
    next = end ? end + strlen(between) : NULL;
  }
  PetscCheck(has, from->comm, SAM_ERR_USER, "-%s%s is given without -%s%s", prefix, name, prefix, needs);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the options that a row needs are given, that those it excludes are not, and that its own value is
   given. */
static PetscErrorCode CheckRow(const SamOptions *from, const SamOptionRow *row, const void *member, PetscBool given)
{
  PetscBool has = PETSC_TRUE;
  char      other[128];

  PetscFunctionBegin;
  if (row->kind == SAM_OPTION_BOOL && !row->words) given = given && *(const PetscBool *)member;
  if (row->needs) PetscCall(SamOptionsNeed(from, given, row->name, row->needs));
  if (row->needs && row->missing) PetscCall(SamOptionsHas(from, row->needs, &has));
  for (const char *next = row->excludes; next && given && *next; next += strcspn(next, ","), next += *next == ',') {
    (void)snprintf(other, sizeof(other), "%.*s", (int)strcspn(next, ","), next);
    PetscCall(SamOptionsExclude(from, row->name, other, "give one of them"));
  }
  PetscCheck(!(row->loosest > 0 && *(const PetscReal *)member > row->loosest), from->comm, SAM_ERR_USER,
             "-%s%s %.6g: the limit is %.6g, beyond which %s: give less", SamOptionsPrefix(from), row->name,
             (double)*(const PetscReal *)member, (double)row->loosest, row->beyond);
  if (row->missing && has)
    PetscCall(SamOptionsRequire(from, given || HasDefault(row, member), row->name, row->missing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsRead(const SamOptions *from, const char heading[], PetscInt count, const SamOptionRow rows[],
                              void *settings, PetscBool given[])
{
  PetscFunctionBegin;
  SamValidPointer(from, 1);
  if (count > 0) {
    SamValidPointer(rows, 4);
    SamValidPointer(settings, 5);
  }
  if (heading) PetscCall(SamOptionsHeading(from, heading));
  for (PetscInt k = 0; k < count; k++) {
    void     *member = (char *)settings + rows[k].member;
    PetscBool found;

    PetscCall(ReadRow(from, &rows[k], member, &found));
    if (!SamPrintHelp()) PetscCall(CheckRow(from, &rows[k], member, found));
    if (given) given[k] = found;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsReal(const SamOptions *from, const char name[], const char help[], const char unit[],
                              SamRange range, PetscReal *value, PetscBool *set)
{
  const SamOptionRow row = {name, help, SAM_OPTION_REAL, .range = range, .unit = unit};

  PetscFunctionBegin;
  SamValidPointer(from, 1);
  SamValidPointer(name, 2);
  SamValidPointer(help, 3);
  SamValidPointer(value, 6);
  PetscCall(SamOptionsRead(from, NULL, 1, &row, value, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}
