/* A table of numbers with named columns, read from text. */
#include "historyimpl.h"
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/* The error that rank 0 found, which all ranks raise; code 0: none. */
typedef struct {
  PetscErrorCode code;
  char           message[1024];
} Verdict;

static PetscErrorCode Judge(Verdict *verdict, PetscErrorCode code, const char format[], ...)
{
  va_list arguments;

  PetscFunctionBegin;
  verdict->code = code;
  va_start(arguments, format);
  vsnprintf(verdict->message, sizeof(verdict->message), format, arguments);
  va_end(arguments);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Removes a comment, and white space at both ends. */
static char *Trim(char *text)
{
  char *end;

  text[strcspn(text, "#\r\n")] = '\0';
  while (isspace((unsigned char)*text)) text++;
  end = text + strlen(text);
  while (end > text && isspace((unsigned char)end[-1])) *--end = '\0';
  return text;
}

/* The next field of a line, its separating comma overwritten; NULL after the last. */
static char *NextField(char **rest)
{
  char *field = *rest, *comma;

  if (!field) return NULL;
  comma = strchr(field, ',');
  if (comma) *comma = '\0';
  *rest = comma ? comma + 1 : NULL;
  return Trim(field);
}

static PetscErrorCode ReadHeader(const char file[], PetscInt line, char *text, SamTable *t, Verdict *verdict)
{
  char *rest = text, *field;

  PetscFunctionBegin;
  t->header_line = line;
  while (!verdict->code && (field = NextField(&rest))) {
    if (!*field)
      PetscCall(Judge(verdict, SAM_ERR_USER, "%s, line %d: a column has no name", file, (int)line));
    else if (SamTableFind(t, field) >= 0)
      PetscCall(Judge(verdict, SAM_ERR_USER, "%s, line %d: two columns are named %s", file, (int)line, field));
    else if (t->columns == SAM_TABLE_COLUMNS)
      PetscCall(Judge(verdict, SAM_ERR_USER, "%s, line %d: more than %d columns", file, (int)line, SAM_TABLE_COLUMNS));
    else {
      strncpy(t->name[t->columns], field, SAM_TABLE_NAME - 1); /* a longer name will be refused as unknown */
      t->columns++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadRow(const char file[], PetscInt line, char *text, const SamTable *t, double row[],
                              Verdict *verdict)
{
  PetscInt fields = 0;
  char    *rest   = text, *field;

  PetscFunctionBegin;
  while (!verdict->code && (field = NextField(&rest))) {
    char  *end;
    double value = strtod(field, &end);

    if (fields < t->columns && (end == field || *end || !isfinite(value)))
      PetscCall(Judge(verdict, SAM_ERR_USER, "%s, line %d: column %s: \"%s\" is not a finite number", file, (int)line,
                      t->name[fields], field));
    if (fields < t->columns) row[fields] = value;
    fields++;
  }
  if (!verdict->code && fields != t->columns)
    PetscCall(Judge(verdict, SAM_ERR_USER, "%s, line %d: %d fields, expected %d as in line %d", file, (int)line,
                    (int)fields, (int)t->columns, (int)t->header_line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for one more row. */
static PetscErrorCode Grow(SamTable *t, PetscInt *room)
{
  PetscFunctionBegin;
  if (t->rows < *room) PetscFunctionReturn(PETSC_SUCCESS);
  *room = PetscMax(64, 2 * *room);
  PetscCall(PetscRealloc(sizeof(double) * (size_t)(*room * t->columns), &t->value));
  PetscCall(PetscRealloc(sizeof(PetscInt) * (size_t)*room, &t->line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFile(const char option[], const char file[], SamTable *t, Verdict *verdict)
{
  struct stat status;
  FILE       *stream;
  char       *buffer = NULL;
  size_t      size   = 0;
  ssize_t     length;
  PetscInt    line = 0, room = 0;

  PetscFunctionBegin;
  errno  = 0; /* a pipe, or a device, could keep the run waiting */
  stream = stat(file, &status) || !S_ISREG(status.st_mode) ? NULL : fopen(file, "r");
  if (!stream) {
    PetscCall(Judge(verdict, SAM_ERR_FILE, "-%s %s: cannot be read: %s", option, file,
                    errno ? strerror(errno) : "it is not a file"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  errno = 0;
  while (!verdict->code && (length = getline(&buffer, &size, stream)) >= 0) {
    char *text;

    line++;
    if (strlen(buffer) != (size_t)length) {
      PetscCall(Judge(verdict, SAM_ERR_USER, "%s, line %d: contains a zero byte: expected text", file, (int)line));
      break;
    }
    text = Trim(buffer);
    if (!*text) continue;
    if (!t->columns) {
      PetscCall(ReadHeader(file, line, text, t, verdict));
      continue;
    }
    PetscCall(Grow(t, &room));
    PetscCall(ReadRow(file, line, text, t, t->value + t->rows * t->columns, verdict));
    t->line[t->rows++] = line;
  }
  if (!verdict->code && ferror(stream))
    PetscCall(Judge(verdict, SAM_ERR_FILE, "-%s %s: cannot be read: %s", option, file, strerror(errno)));
  if (!verdict->code && !t->rows) PetscCall(Judge(verdict, SAM_ERR_USER, "-%s %s: has no row", option, file));
  free(buffer);
  fclose(stream);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamTableRead(MPI_Comm comm, const char option[], const char file[], SamTable *t)
{
  PetscMPIInt rank;
  Verdict     verdict;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&verdict, sizeof(verdict)));
  PetscCall(PetscMemzero(t, sizeof(*t)));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(ReadFile(option, file, t, &verdict));
  PetscCallMPI(MPI_Bcast(&verdict, sizeof(verdict), MPI_BYTE, 0, comm));
  if (verdict.code) {
    PetscCall(SamTableDestroy(t));
    SETERRQ(comm, verdict.code, "%s", verdict.message);
  }
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
