/*
  Records the given options with their files and lines, before PETSc reads them at its start. It rejects only mistakes
  that PETSc would ignore without an error, or after which PETSc would not return; PETSc itself, or the set-up, rejects
  all others.

  Rank 0 examines the words and sends its findings to the others. A word is an option, which may be followed by its
  value.
*/
#include <petsam/private/arguments.h>
#include <petsam/private/baseimpl.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define DEEPEST 8 /* depth of options files that name options files */

/* ---- words ---- */

/* True if PETSc takes a word for an option's name, and not for a number such as -inf. */
static PetscBool IsOption(const char text[])
{
  PetscBool is;

  return !PetscOptionsValidKey(text, &is) && is;
}

/* Notes a mistake if it is the first one. */
static void Complain(SamArguments *a, PetscErrorCode code, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(3, 4);
static void Complain(SamArguments *a, PetscErrorCode code, const char format[], ...)
{
  va_list values;

  if (a->code) return;
  a->code = code;
  va_start(values, format);
  (void)vsnprintf(a->message, sizeof(a->message), format, values);
  va_end(values);
}

/*
  Options of PETSc, separated by spaces, with which a program loads code, starts others, waits for ever, prints PETSc's
  help, or ends early without an error that names the option. A star stands for any ending.
*/
static const char refused[] =
  "-python* -dll_* -start_in_debugger -on_error_attach_debugger -on_error_emacs -stop_for_debugger -saws* "
  "-mpi_linear_solver_server -prefix_push -prefix_pop -fp_trap -help -h -version -options_file_yaml "
  "-options_string_yaml";

static PetscBool IsNamed(const char word[], const char names[])
{
  for (const char *name = names; *name; name += strspn(name, " ")) {
    const size_t length = strcspn(name, " "), part = name[length - 1] == '*' ? length - 1 : length;

    if (!strncasecmp(word, name, part) && (part < length || !word[part])) return PETSC_TRUE;
    name += length;
  }
  return PETSC_FALSE;
}

/* Splits a text, which is changed, into words separated by white space; like PETSc, keeps words in double quotes
   together. */
static int Split(char text[], char *words[], int most)
{
  int count = 0;

  while (count < most) {
    const char *stop = " \t\r\n";

    text += strspn(text, stop);
    if (!*text) break;
    if (*text == '"') {
      stop = "\"";
      text++;
    }
    words[count++] = text;
    text += strcspn(text, stop);
    if (*text) *text++ = '\0';
  }
  return count;
}

/*
  Rejects an option that its source gives a second time, in any case of letters: PETSc would take the last value without
  a word. Each of several options files counts. A program may append to its own text, where the last value counts.
*/
static void CheckTwice(SamArguments *a, const char where[], const SamArgument *one)
{
  for (int k = 0; k < a->givens && one->source != SAM_SOURCE_TEXT; k++) {
    const SamArgument *other = &a->given[k];
    const char        *line  = strrchr(other->place, ','); /* of the same file */

    if (other->source != one->source || strcasecmp(other->name, one->name) || !strcasecmp(one->name, "options_file"))
      continue;
    Complain(a, SAM_ERR_USER, "%s-%.48s%s%.48s: given twice, as -%.48s%s%.48s%s%.*s too: remove one of them", where,
             one->name, one->value[0] ? " " : "", one->value, other->name, other->value[0] ? " " : "", other->value,
             line ? " in" : "", line ? (int)strcspn(line + 1, ":") : 0, line ? line + 1 : "");
  }
}

/* Keeps an option, its value, which may be NULL, and its place. */
static void Keep(SamArguments *a, int source, const char where[], const char option[], const char value[])
{
  SamArgument *more = (SamArgument *)realloc(a->given, (size_t)(a->givens + 1) * sizeof(*more));
  SamArgument  one  = {strdup(option + 1), strdup(value ? value : ""), strdup(source > 0 ? where : ""), source};

  if (!more) return;
  a->given = more;
  CheckTwice(a, where, &one);
  more[a->givens++] = one;
}

static void ExamineFile(SamArguments *a, const char where[], const char file[], int depth);

/*
  Examines an option and its value: the next word, or NULL; `where` is its place with a colon, or "". PETSc would ignore
  a word where an option is expected.
*/
static void ExamineOption(SamArguments *a, int source, const char where[], const char option[], const char value[],
                          int depth)
{
  if (!IsOption(option))
    Complain(a, SAM_ERR_USER, "%s%.160s: expected an option: it begins with a dash", where, option);
  Keep(a, source, where, option, value);
  if (IsNamed(option, refused))
    Complain(a, SAM_ERR_USER, "%s%s: petsam does not support it here: remove it", where, option);
  if (!IsNamed(option, "-options_file")) return;
  if (!value || !value[0])
    Complain(a, SAM_ERR_USER, "%s-options_file has no value: expected the name of a file", where);
  else
    ExamineFile(a, "-options_file ", value, depth + 1);
}

static void ExamineWords(SamArguments *a, int source, const char where[], int count, char **words)
{
  for (int k = 0; k < count; k++) {
    const char *option = words[k], *value = k + 1 < count && !IsOption(words[k + 1]) ? words[k + 1] : NULL;

    ExamineOption(a, source, where, option, value, 0);
    if (value) k++;
  }
}

/* ---- files ---- */

/* Examines a line of the options file of this number: an option and its value, or a comment. */
static void ExamineLine(SamArguments *a, int source, const char where[], char line[], int depth)
{
  char *words[3];
  int   count = Split(line, words, 3);

  for (int k = count; k-- > 0;)
    if (words[k][0] == '#') count = k; /* the rest is a comment */
  if (!count || strchr("!%", words[0][0])) return;
  ExamineOption(a, source, where, words[0], count > 1 ? words[1] : NULL, depth);
}

static void ExamineLines(SamArguments *a, const char where[], const char name[], FILE *file, int depth)
{
  const int source = a->count;
  char     *line   = NULL;
  size_t    size   = 0;
  ssize_t   length;

  for (long number = 1; !a->code && (length = getline(&line, &size, file)) >= 0; number++) {
    char place[600];

    (void)snprintf(place, sizeof(place), "%s%s, line %ld: ", where, name, number);
    if (memchr(line, '\0', (size_t)length))
      Complain(a, SAM_ERR_USER, "%sa byte of value 0: an options file is plain text: save it as UTF-8", place);
    ExamineLine(a, source, place, line, depth);
  }
  free(line);
}

static void ExamineFile(SamArguments *a, const char where[], const char name[], int depth)
{
  struct stat status;
  FILE       *file;

  if (a->code) return;
  if (depth > DEEPEST || a->count == SAM_ARGUMENTS_FILES) {
    Complain(a, SAM_ERR_USER, "%s%s: options files include each other in a loop", where, name);
  } else if (stat(name, &status) || !S_ISREG(status.st_mode) || !(file = fopen(name, "r"))) {
    Complain(a, SAM_ERR_FILE, "%s%s: cannot be read: %s", where, name,
             stat(name, &status) || S_ISREG(status.st_mode) ? strerror(errno) : "it is not a file");
  } else {
    a->files[a->count++] = strdup(name);
    ExamineLines(a, where, name, file, depth);
    (void)fclose(file);
  }
}

void SamArgumentsSeparate(char text[])
{
  PetscBool quoted = PETSC_FALSE;

  for (; *text; text++) {
    if (*text == '"') quoted = !quoted;
    if (!quoted && strchr("\t\r\n\v\f", *text)) *text = ' ';
  }
}

/* Separates the words of PETSC_OPTIONS by single spaces. */
static void SeparateEnvironment(void)
{
  char *text = getenv("PETSC_OPTIONS") ? strdup(getenv("PETSC_OPTIONS")) : NULL;

  if (!text) return;
  SamArgumentsSeparate(text);
  (void)setenv("PETSC_OPTIONS", text, 1);
  free(text);
}

/* Examines the words of a text; NULL: no text. */
static void ExamineText(SamArguments *a, int source, const char where[], const char text[])
{
  const size_t most  = text ? strlen(text) / 2 + 1 : 0;
  char        *copy  = text ? strdup(text) : NULL;
  char       **words = most ? (char **)malloc(most * sizeof(*words)) : NULL;

  if (copy && words) ExamineWords(a, source, where, Split(copy, words, (int)most), words);
  free(words);
  free(copy);
}

/* ---- all arguments ---- */

/*
  Takes the words from the first one up to the next option as the topic of the help; returns their number. An option
  that is the only word left is a topic, too, without its dash: -help -grid_n.
*/
static int TakeTopic(int argc, char **argv, char topic[], size_t size)
{
  int count = 0;

  if (argc == 1 && IsOption(argv[0]) && !IsNamed(argv[0] + strspn(argv[0], "-") - 1, "-version -help -h")) {
    (void)snprintf(topic, size, "%s", argv[0] + strspn(argv[0], "-"));
    return 1;
  }
  while (count < argc && !IsOption(argv[count])) {
    const size_t length = strlen(topic);

    (void)snprintf(topic + length, size - length, "%s%s", length ? " " : "", argv[count++]);
  }
  return count;
}

/* Removes -help, --help, -h, --version and -version, for which PETSc would print its own text and continue. */
static void TakeHelpAndVersion(int *argc, char **argv, SamArguments *a)
{
  int kept = 1;

  for (int i = 1; i < *argc; i++) {
    if (!strcmp(argv[i], "-help") || !strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
      a->help = PETSC_TRUE;
      i += TakeTopic(*argc - i - 1, argv + i + 1, a->topic, sizeof(a->topic));
    } else if (!strcmp(argv[i], "--version") || !strcmp(argv[i], "-version"))
      a->version = PETSC_TRUE;
    else
      argv[kept++] = argv[i];
  }
  *argc      = kept;
  argv[kept] = NULL;
}

/* Sends rank 0's findings to the other ranks. */
static void TellAll(MPI_Comm comm, SamArguments *a)
{
  (void)MPI_Bcast(&a->code, (int)sizeof(a->code), MPI_BYTE, 0, comm);
  (void)MPI_Bcast(a->message, (int)sizeof(a->message), MPI_CHAR, 0, comm);
}

void SamArgumentsExamineText(MPI_Comm comm, const char text[], SamArguments *a)
{
  int rank;

  memset(a, 0, sizeof(*a));
  (void)MPI_Comm_rank(comm, &rank);
  if (rank == 0) ExamineText(a, SAM_SOURCE_TEXT, "", text);
  TellAll(comm, a);
}

void SamArgumentsExamine(int *argc, char ***argv, SamArguments *a)
{
  static char *none[] = {"petsam", NULL};
  int          rank;

  memset(a, 0, sizeof(*a));
  TakeHelpAndVersion(argc, *argv, a);
  SeparateEnvironment();
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) {
    ExamineWords(a, SAM_SOURCE_LINE, "", *argc - 1, *argv + 1);
    ExamineText(a, SAM_SOURCE_ENVIRONMENT, "PETSC_OPTIONS: ", getenv("PETSC_OPTIONS"));
  }
  TellAll(MPI_COMM_WORLD, a);
  if (!a->code) return;
  (void)unsetenv("PETSC_OPTIONS");
  (void)unsetenv("PETSC_OPTIONS_YAML");
  *argc = 1;
  *argv = none;
}

void SamArgumentsFree(SamArguments *a)
{
  for (int k = 0; k < a->count; k++) free(a->files[k]);
  for (int k = 0; k < a->givens; k++) {
    free(a->given[k].name);
    free(a->given[k].value);
    free(a->given[k].place);
  }
  free(a->given);
  a->given = NULL;
  a->count = a->givens = 0;
}

/* Returns the place of the option whose name has these characters; NULL: it is not given. */
static const char *PlaceOf(const SamArguments *a, const char name[], size_t length)
{
  const char *place = NULL;

  for (int k = 0; a && k < a->givens; k++)
    if (!strncasecmp(a->given[k].name, name, length) && !a->given[k].name[length] && !(place && !place[0]))
      place = a->given[k].place;
  return place;
}

const char *SamArgumentsFindPlace(const SamArguments *a, const char name[])
{
  size_t      length = strcspn(name, " ");
  const char *place  = PlaceOf(a, name, length);

  /* a colon or comma may end the name in a message, or belong to a name that is mistyped */
  while (!place && length && strchr(":,", name[length - 1])) place = PlaceOf(a, name, --length);
  if (!place) place = PlaceOf(a, name, strcspn(name, " :,"));
  return place ? place : "";
}

PetscErrorCode SamArgumentsRefuseUnknown(MPI_Comm comm, const SamArguments *arguments)
{
  /* Options that PETSc itself reads only in PetscFinalize(). */
  static const char late[] = "-malloc_dump -malloc_view -malloc_test -malloc_debug -log_view -log_view_memory "
                             "-options_left -options_view -objects_dump -memory_view -get_total_flops "
                             "-petsc_finalize_time";
  int               lates;
  char            **list;
  PetscInt          count;
  char            **names, **values;
  char              first[128] = "", name[64] = "";
  const char       *nearest, *with, *place;

  PetscFunctionBegin;
  PetscCall(PetscStrToArray(late, ' ', &lates, &list));
  for (int k = 0; arguments && k < lates; k++) {
    PetscBool ignored;

    PetscCall(PetscOptionsHasName(NULL, NULL, list[k], &ignored));
  }
  PetscCall(PetscStrToArrayDestroy(lates, list));
  PetscCall(PetscOptionsLeftGet(NULL, &count, &names, &values));
  if (count) {
    PetscCall(
      PetscSNPrintf(first, sizeof(first), "-%s%s%s", names[0], values[0] ? " " : "", values[0] ? values[0] : ""));
    PetscCall(PetscStrncpy(name, names[0], sizeof(name)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &count, &names, &values));
  if (!first[0]) PetscFunctionReturn(PETSC_SUCCESS);
  nearest = SamOptionsNearest(name);
  place   = SamArgumentsFindPlace(arguments, name);
  PetscCheck(!SamOptionsIsKnown(name, &with), comm, SAM_ERR_USER, "%s%s: has no effect %s%s: remove it", place, first,
             with ? "without " : "with the other options given", with ? with : "");
  PetscCheck(!nearest, comm, SAM_ERR_USER, "%s%s: unknown option: is -%s%s meant?", place, first, nearest,
             SamOptionsForm(name));
  SETERRQ(comm, SAM_ERR_USER, "%s%s: unknown option, or one that has no effect with the others given", place, first);
}
