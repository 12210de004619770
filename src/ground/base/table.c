/* A table of numbers with named columns, read from text. */
#include <petsam/private/table.h>
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/* A file that is being read; errors are raised on `comm`. */
typedef struct {
  MPI_Comm           comm;
  const char        *option, *file;
  const char *const *names; /* names of the allowed columns */
  SamTable          *t;
  char               separator; /* comma, semicolon, or a space for any white space */
  PetscInt           line, room;
} Reader;

/* Removes a comment, and white space at both ends. */
static char *Trim(char *text)
{
  char *end;

  text[strcspn(text, "#")] = '\0';
  while (isspace((unsigned char)*text)) text++;
  end = text + strlen(text);
  while (end > text && isspace((unsigned char)end[-1])) *--end = '\0';
  return text;
}

/* Returns a field without the quotes that spreadsheets write around it. */
static char *Unquote(char *field)
{
  const size_t length = strlen(field);

  if (length < 2 || field[0] != '"' || field[length - 1] != '"') return field;
  field[length - 1] = '\0';
  return Trim(field + 1);
}

/* Returns the next field of a line, and overwrites its separator; NULL after the last field. */
static char *NextField(char **rest, char separator)
{
  char *field = *rest, *end;

  if (!field) return NULL;
  end   = separator == ' ' ? field + strcspn(field, " \t\v\f") : strchr(field, separator);
  *rest = end && *end ? end + 1 : NULL;
  if (end) *end = '\0';
  while (separator == ' ' && *rest && isspace((unsigned char)**rest)) ++*rest;
  return Unquote(Trim(field));
}

/* ---- names of columns ---- */

/* Returns the known name that a field means, ignoring its dash, quotes, capitals and unit; NULL: none. */
static const char *FindMeant(const Reader *r, const char field[])
{
  char   plain[SAM_TABLE_NAME] = "";
  size_t count                 = 0;

  while (*field && strchr("-\"' ", *field)) field++;
  for (size_t k = 0; field[k] && !strchr(" \"'[(/", field[k]) && k + 1 < sizeof(plain); k++)
    plain[k] = (char)tolower((unsigned char)field[k]);
  while (r->names[count]) count++;
  return SamNearestName(plain, count, r->names);
}

/* True if this name and the next one begin with the same word and a body's number, as "body1_case_a". */
static PetscBool IsInRun(const char name[], const char next[])
{
  const size_t length = strcspn(name, "12_");

  return next && isdigit((unsigned char)name[length]) && !strncmp(name, next, length) &&
             isdigit((unsigned char)next[length])
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Lists all names; of a run of names of the bodies only the first and the last one. */
static void ListNames(const Reader *r, char list[], size_t size)
{
  size_t    used   = 0;
  PetscBool before = PETSC_FALSE;

  list[0] = '\0';
  for (size_t k = 0; r->names[k] && used < size; k++) {
    const PetscBool next = IsInRun(r->names[k], r->names[k + 1]);

    if (!(before && next))
      used += (size_t)snprintf(list + used, size - used, "%s%s", k == 0 ? "" : before ? " ... " : ", ", r->names[k]);
    before = next;
  }
}

/* Rejects a name that is not the name of a column; a unit in the name is a likely reason. */
static PetscErrorCode RefuseName(Reader *r, const char field[])
{
  const char *meant = FindMeant(r, field);
  char        list[400], suggested[2 * SAM_TABLE_NAME] = "", *end;

  PetscFunctionBegin;
  (void)strtod(field, &end);
  PetscCheck(end == field || *end, r->comm, SAM_ERR_USER,
             "%s, line %d: %s is no name of a column: the first line must name the columns, for example %s,%s", r->file,
             (int)r->line, field, r->names[0], r->names[1]);
  ListNames(r, list, sizeof(list));
  if (meant) (void)snprintf(suggested, sizeof(suggested), " is %s meant?", meant);
  SETERRQ(r->comm, SAM_ERR_USER, "%s, line %d: unknown column %.64s;%s%s expected %s", r->file, (int)r->line, field,
          strpbrk(field, "[(/") ? " names have no unit, as all values are in SI units:" : "", suggested, list);
}

static PetscBool IsName(const Reader *r, const char field[])
{
  for (size_t k = 0; r->names[k]; k++)
    if (!strcmp(r->names[k], field)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Reads the names of the columns. Their separator also separates the numbers. */
static PetscErrorCode ReadHeader(Reader *r, char *text)
{
  SamTable *const t    = r->t;
  const int       line = (int)r->line;
  char           *rest = text, *field;

  PetscFunctionBegin;
  t->header_line = r->line;
  r->separator   = strchr(text, ';') ? ';' : strchr(text, ',') ? ',' : ' ';
  while ((field = NextField(&rest, r->separator))) {
    PetscCheck(*field, r->comm, SAM_ERR_USER, "%s, line %d: a column has no name: is there a separator too many?",
               r->file, line);
    PetscCheck(SamTableFind(t, field) < 0, r->comm, SAM_ERR_USER,
               "%s, line %d: two columns are named %s: remove one of them", r->file, line, field);
    if (!IsName(r, field)) PetscCall(RefuseName(r, field));
    PetscCall(PetscStrncpy(t->name[t->columns++], field, SAM_TABLE_NAME));
  }
  PetscCheck(SamTableFind(t, r->names[0]) >= 0, r->comm, SAM_ERR_USER,
             "%s, line %d: no column named %s: each row needs one", r->file, line, r->names[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- rows ---- */

static PetscErrorCode ReadRow(Reader *r, char *text)
{
  SamTable *const t      = r->t;
  PetscInt        fields = 0;
  char           *rest   = text, *field;

  PetscFunctionBegin;
  if (t->rows == r->room) {
    r->room = PetscMax(64, 2 * r->room);
    PetscCall(PetscRealloc(sizeof(double) * (size_t)(r->room * t->columns), &t->value));
    PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)r->room, &t->line));
  }
  for (; (field = NextField(&rest, r->separator)); fields++) {
    char        why[192];
    const char *end;
    double      value;
    PetscBool   unit, is = SamReadReal(NULL, field, &end, &value, &unit);

    if (fields >= t->columns) continue;
    SamExplainNumber(field, NULL, why, sizeof(why));
    PetscCheck(is && !*end && isfinite(value), r->comm, SAM_ERR_USER,
               "%s, line %d: column %s: \"%s\" is not a finite number%s", r->file, (int)r->line, t->name[fields], field,
               strchr(field, ';') ? "; separate columns as in the line of their names" : why);
    t->value[t->rows * t->columns + fields] = value;
  }
  PetscCheck(fields == t->columns, r->comm, SAM_ERR_USER, "%s, line %d: %d fields, expected %d as in line %d%s",
             r->file, (int)r->line, (int)fields, (int)t->columns, (int)t->header_line,
             fields > t->columns && r->separator == ',' ? "; a comma separates columns, numbers have a decimal point"
                                                        : "");
  t->line[t->rows++] = r->line;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- files ---- */

/* Reads a line without its end. The first line may begin with the mark that some editors write before UTF-8. */
static PetscErrorCode ReadLine(Reader *r, char *line)
{
  static const char mark[] = "\xef\xbb\xbf";

  char *text;

  PetscFunctionBegin;
  r->line++;
  if (r->line == 1 && !strncmp(line, mark, strlen(mark))) line += strlen(mark);
  text = Trim(line);
  if (*text && r->t->columns)
    PetscCall(ReadRow(r, text));
  else if (*text)
    PetscCall(ReadHeader(r, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckText(const Reader *r, const char text[], size_t length)
{
  PetscFunctionBegin;
  PetscCheck(!memchr(text, '\0', length), r->comm, SAM_ERR_USER,
             "%s, line %d: contains a zero byte: expected text in UTF-8, as spreadsheets export it as CSV", r->file,
             (int)r->line + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads lines that end with LF, CR LF or, from old Macintosh programs, CR. `buffer` is for getline(). */
static PetscErrorCode ReadLines(Reader *r, FILE *stream, char **buffer)
{
  size_t  size = 0, n;
  ssize_t length;
  char    begin[4096];

  PetscFunctionBegin;
  errno = 0;
  n     = fread(begin, 1, sizeof(begin), stream);
  if (!memchr(begin, '\n', n))
    PetscCall(CheckText(r, begin, n)); /* a file that is no text may have no end of its first line */
  rewind(stream);
  while ((length = getline(buffer, &size, stream)) >= 0) {
    PetscCall(CheckText(r, *buffer, (size_t)length));
    if (length && (*buffer)[length - 1] == '\n') (*buffer)[--length] = '\0';
    if (length && (*buffer)[length - 1] == '\r') (*buffer)[--length] = '\0';
    for (char *text = *buffer, *end; text; text = end) {
      end = strchr(text, '\r');
      if (end) *end++ = '\0';
      PetscCall(ReadLine(r, text));
    }
  }
  PetscCheck(!ferror(stream), r->comm, SAM_ERR_FILE, SAM_CANNOT_READ, r->option, r->file, strerror(errno));
  PetscCheck(r->t->rows, r->comm, SAM_ERR_USER,
             "-%s %s: has no row: expected a line with the names of the columns, for example %s,%s, and below it a "
             "line of numbers for each row",
             r->option, r->file, r->names[0], r->names[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFile(Reader *r)
{
  char          *buffer = NULL;
  struct stat    status;
  FILE          *stream;
  PetscErrorCode code;

  PetscFunctionBegin;
  errno  = 0; /* opening a pipe or a device could block the run */
  stream = stat(r->file, &status) || !S_ISREG(status.st_mode) ? NULL : fopen(r->file, "r");
  PetscCheck(stream, r->comm, SAM_ERR_FILE, SAM_CANNOT_READ, r->option, r->file,
             errno ? strerror(errno) : "it is not a file");
  code = ReadLines(r, stream, &buffer);
  free(buffer);
  (void)fclose(stream);
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTableRead(MPI_Comm comm, const char option[], const char file[], const char *const names[],
                            SamTable *t)
{
  PetscMPIInt    rank;
  PetscErrorCode code                 = 0;
  char           message[SAM_MESSAGE] = "";
  Reader         r = {.comm = PETSC_COMM_SELF, .option = option, .file = file, .names = names, .t = t};

  PetscFunctionBegin;
  PetscCall(PetscMemzero(t, sizeof(*t)));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) { /* the error is raised on all ranks */
    PetscCall(PetscPushErrorHandler(SamKeepMessage, message));
    code = ReadFile(&r);
    PetscCall(PetscPopErrorHandler());
  }
  PetscCallMPI(MPI_Bcast(&code, sizeof(code), MPI_BYTE, 0, comm));
  PetscCallMPI(MPI_Bcast(message, sizeof(message), MPI_BYTE, 0, comm));
  if (code) PetscCall(SamTableDestroy(t));
  PetscCheck(!code, comm, code, "%s", message);
  PetscCallMPI(MPI_Bcast(&t->columns, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&t->rows, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&t->header_line, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(t->name, sizeof(t->name), MPI_BYTE, 0, comm));
  if (rank) {
    PetscCall(PetscMalloc(sizeof(double) * (size_t)(t->rows * t->columns), &t->value));
    PetscCall(PetscMalloc(sizeof(PetscInt) * (size_t)t->rows, &t->line));
  }
  PetscCallMPI(MPI_Bcast(t->value, (PetscMPIInt)(t->rows * t->columns), MPI_DOUBLE, 0, comm));
  PetscCallMPI(MPI_Bcast(t->line, (PetscMPIInt)t->rows, MPIU_INT, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTableCreate(MPI_Comm comm, const char what[], const char header[], PetscInt rows,
                              const double values[], const char *const names[], SamTable *t)
{
  Reader r = {.comm = comm, .option = what, .file = what, .names = names, .t = t};
  char   text[1024];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(t, sizeof(*t)));
  PetscCheck(strlen(header) < sizeof(text), comm, SAM_ERR_USER, "%s: expected at most %d characters of names", what,
             (int)sizeof(text) - 1);
  PetscCall(PetscStrncpy(text, header, sizeof(text)));
  PetscCall(ReadHeader(&r, Trim(text)));
  PetscCheck(rows > 0, comm, SAM_ERR_USER, "%s: has no row: expected one for each step", what);
  for (PetscInt k = 0; k < rows * t->columns; k++)
    PetscCheck(isfinite(values[k]), comm, SAM_ERR_USER, "%s, line %d: column %s: %.6g is not a finite number", what,
               (int)(k / t->columns) + 1, t->name[k % t->columns], values[k]);
  t->rows = rows;
  PetscCall(PetscMalloc(sizeof(double) * (size_t)(rows * t->columns), &t->value));
  PetscCall(PetscMalloc(sizeof(PetscInt) * (size_t)rows, &t->line));
  PetscCall(PetscArraycpy(t->value, values, rows * t->columns));
  for (PetscInt k = 0; k < rows; k++) t->line[k] = k + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTableCopy(const SamTable *table, SamTable *copy)
{
  PetscFunctionBegin;
  *copy = *table;
  if (!table->rows) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(table->rows * table->columns, &copy->value));
  PetscCall(PetscArraycpy(copy->value, table->value, table->rows * table->columns));
  PetscCall(PetscMalloc1(table->rows, &copy->line));
  PetscCall(PetscArraycpy(copy->line, table->line, table->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTableDestroy(SamTable *t)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(t->value));
  PetscCall(PetscFree(t->line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamTableFind(const SamTable *t, const char name[])
{
  for (PetscInt c = 0; c < t->columns; c++)
    if (!strncmp(t->name[c], name, SAM_TABLE_NAME)) return c;
  return -1;
}
