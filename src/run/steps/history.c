/* The load history: created from options and a file, it returns its steps. */
#include <petsam/private/history.h>
#include <petsam/elasticity.h>
#include <petsam/private/table.h>
#include <petsam/private/arguments.h>
#include <petsam/private/help.h>
#include <petsam/private/balance.h>
#include <petsam/private/base.h>
#include <petsam/private/control.h>
#include <float.h>
#include <math.h>

/* Times that differ by a smaller part of their size are rejected: they may be the same number. */
#define TIME_ROUNDING (4 * DBL_EPSILON)

struct _n_SamHistory {
  SamControl constant; /* kind of control of each component, and values of those without a column */
  SamControl before;   /* control from which the first row's change begins */
  PetscInt   rows, increments;
  PetscInt   start;                    /* steps up to the first row */
  PetscBool  apart;                    /* true: in these steps the tangential loads follow the others */
  PetscBool  together;                 /* true: in these steps all loads grow in proportion */
  SamTable   table;                    /* empty without a file */
  PetscInt   time;                     /* column of the time; -1: none */
  PetscInt   parts;                    /* parts of the control: the components, and the conditions at that time */
  PetscInt  *column;                   /* column of each part; -1: constant */
  char       file[PETSC_MAX_PATH_LEN]; /* name of the table */

  SamConditions conditions;
};

PetscErrorCode SamHistoryClaimOption(void)
{
  PetscErrorCode code = PetscOptionsCreateDefault(); /* without PetscCall(), as PETSc is not initialized yet */

  return code ? code : PetscOptionsSetAlias(NULL, "-history", "-load_history");
}

/* Input of the reading functions: options, arguments and the file's name */
typedef struct {
  const SamOptions   *from;
  const SamArguments *arguments;
  const char         *file;
} Reader;

/*
  Rejects a value for this run if there is also a column. A value that is only in an options file is ignored with a
  warning, since several runs may share such files.
*/
static PetscErrorCode Override(const Reader *r, const char name[], const char column[], PetscBool *set)
{
  const char *prefix = SamOptionsPrefix(r->from);
  char        option[96];
  int         shared; /* true if only in an options file, which several runs may share */
  PetscMPIInt rank;

  PetscFunctionBegin;
  if (!*set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(option, sizeof(option), "%s%s", prefix, name));
  shared = SamArgumentsFindPlace(r->arguments, option)[0] != '\0';
  PetscCallMPI(MPI_Bcast(&shared, 1, MPI_INT, 0, r->from->comm));
  PetscCheck(shared, r->from->comm, SAM_ERR_USER, "-%s: %s has the column %s: give one of them", option, r->file,
             column);
  *set = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_rank(r->from->comm, &rank));
  if (rank == 0)
    SamPrintMessage("petsam", "warning: -%s of the options file is not used: %s has the column %s", option, r->file,
                    column);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the column of a component: of its load, displacement or creepage, which then is prescribed. */
static PetscErrorCode FindColumn(SamHistory h, MPI_Comm comm, const char file[], PetscInt c)
{
  PetscFunctionBegin;
  h->column[c] = -1;
  SamControlSetWay(&h->constant, c, SAM_BY_LOAD);
  for (SamWay way = SAM_BY_LOAD; way < SAM_WAYS; way++) {
    const char    *name   = SamComponentNameOf(c, way);
    const PetscInt column = name ? SamTableFind(&h->table, name) : -1;

    if (column < 0) continue;
    PetscCheck(h->column[c] < 0, comm, SAM_ERR_USER,
               "%s, line %" PetscInt_FMT ": the columns %s and %s are conjugate: give one of them", file,
               h->table.header_line, SamControlPartName(&h->constant, h->conditions, c), name);
    h->column[c] = column;
    SamControlSetWay(&h->constant, c, way);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Reads one component: its load, displacement or creepage, from an option or a column; only one of these may be given.
  `left`: true if none is given.
*/
static PetscErrorCode ReadComponent(SamHistory h, const Reader *r, PetscInt c, PetscBool *left)
{
  const SamOptions *const from            = r->from;
  const SamComponentName *name            = &SamComponentNames[c];
  const char             *prefix          = SamOptionsPrefix(from);
  PetscReal               value[SAM_WAYS] = {c ? 0 : NAN, NAN, NAN}; /* without a value the load is 0, except N */
  PetscBool               has[SAM_WAYS] = {PETSC_FALSE}, given = PETSC_FALSE;
  char                    text[96], unit[16];
  PetscBool               plane, repeated;

  PetscFunctionBegin;
  PetscCall(SamOptionsHas(from, "elasticity " SAM_ELASTICITY_PLANE, &plane));
  PetscCall(SamOptionsHas(from, "elasticity " SAM_ELASTICITY_PLANE_PERIODIC, &repeated));
  PetscCall(PetscSNPrintf(text, sizeof(text), "%s (), or instead %s", name->load_text, name->rigid));
  PetscCall(PetscSNPrintf(unit, sizeof(unit), "%s%s", name->load_unit, plane || repeated ? "/m" : ""));
  PetscCall(SamOptionsReal(from, name->load, text, unit,
                           c || SamConditionsPull(h->conditions) ? SAM_RANGE_ANY : SAM_RANGE_NONNEGATIVE,
                           &value[SAM_BY_LOAD], &has[SAM_BY_LOAD]));
  PetscCall(SamOptionsReal(from, name->rigid, name->rigid_text, name->rigid_unit, SAM_RANGE_ANY, &value[SAM_BY_RIGID],
                           &has[SAM_BY_RIGID]));
  if (name->creep) {
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s () of rolling", name->creep_text));
    PetscCall(SamOptionsReal(from, name->creep, text, name->creep_unit, SAM_RANGE_ANY, &value[SAM_BY_CREEP],
                             &has[SAM_BY_CREEP]));
  }
  PetscCall(FindColumn(h, from->comm, r->file, c));
  h->constant.value[c] = 0;
  for (SamWay way = SAM_BY_LOAD; way < SAM_WAYS; way++) {
    const char *own = SamComponentNameOf(c, way), *other = SamControlPartName(&h->constant, h->conditions, c);

    if (h->column[c] >= 0) PetscCall(Override(r, own, other, &has[way]));
    if (!has[way]) continue;
    PetscCheck(!given, from->comm, SAM_ERR_USER,
               "-%s%s and -%s%s are conjugate, one follows from the other: give one of them", prefix, other, prefix,
               own);
    given                = PETSC_TRUE;
    h->constant.value[c] = value[way];
    SamControlSetWay(&h->constant, c, way);
  }
  *left = given || h->column[c] >= 0 ? PETSC_FALSE : PETSC_TRUE;
  if (c != SAM_COMPONENT_N) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
    SamOptionsRequire(from, !*left || SamPrintHelp(), "load_n or -disp_z", "the normal force (N) or the approach (m)"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes that spin causes a lateral force: a user who gives no value along y may expect zero creepage there. */
static PetscErrorCode NoteSpin(SamHistory h, const SamOptions *from, const PetscBool left[])
{
  const PetscInt   spin   = SAM_COMPONENT_MZ;
  const char      *prefix = SamOptionsPrefix(from);
  PetscMPIInt      rank;
  static PetscBool told = PETSC_FALSE; /* by an earlier trial of the same run */

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(from->comm, &rank));
  if (rank == 0 && !told && left[SAM_COMPONENT_TY] && h->constant.creep[spin] &&
      (h->column[spin] >= 0 || h->constant.value[spin] != 0)) {
    SamPrintMessage("petsam",
                    "note: creep_spin is given without creep_y: creep_y is found, for load_ty = 0: give -%screep_y 0 "
                    "for spin alone, or -%sload_ty 0 for this",
                    prefix, prefix);
    told = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a condition, from an option or a column. */
static PetscErrorCode ReadCondition(SamHistory h, const Reader *r, PetscInt k)
{
  const SamCondition *condition = SamConditionsGet(h->conditions, k - SAM_COMPONENTS);
  PetscBool           set       = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamControlReadCondition(r->from, condition, &h->constant, &set));
  h->column[k] = SamTableFind(&h->table, condition->name);
  if (h->column[k] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Override(r, condition->name, condition->name, &set));
  SamControlSetCondition(&h->constant, condition, condition->usual);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if part k of the control may not be negative. */
static PetscBool IsNonnegative(SamHistory h, PetscInt k)
{
  if (k >= SAM_COMPONENTS) return SamConditionsGet(h->conditions, k - SAM_COMPONENTS)->range == SAM_RANGE_NONNEGATIVE;
  return k == SAM_COMPONENT_N && h->constant.force[k] && !SamConditionsPull(h->conditions);
}

/* Checks that times increase, and that nonnegative values are not negative. */
static PetscErrorCode CheckRows(SamHistory h, MPI_Comm comm, const char file[])
{
  const SamTable *t = &h->table;

  PetscFunctionBegin;
  for (PetscInt r = 0; r < t->rows; r++) {
    const double *row = t->value + r * t->columns, *before = row - t->columns;

    PetscCheck(r == 0 || row[h->time] > before[h->time], comm, SAM_ERR_USER,
               "%s, line %" PetscInt_FMT ": time %.6g: expected more than %.6g, that of the row before", file,
               t->line[r], row[h->time], before[h->time]);
    for (PetscInt k = 0; k < h->parts; k++)
      PetscCheck(h->column[k] < 0 || !IsNonnegative(h, k) || row[h->column[k]] >= 0, comm, SAM_ERR_USER,
                 "%s, line %" PetscInt_FMT ": %s %.6g: expected a number >= 0", file, t->line[r], t->name[h->column[k]],
                 row[h->column[k]]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the file's name. The option's internal name is -load_history (SamHistoryClaimOption()); help and messages say
   -history. */
static PetscErrorCode ReadFileName(const SamOptions *from, char file[], size_t size, PetscBool *set)
{
  const SamOptionHelp option = {"history", "<file>", "text file of load states, one per row: see -help history",
                                "",        "",       NULL};

  PetscFunctionBegin;
  PetscCall(SamOptionsDescribe(from, &option));
  SamOptionsKnow(from, "load_history", NULL);
  PetscCall(SamOptionsNoteFile(from, SAM_OPTION_FILE, "load_history", "history"));
  PetscCall(PetscOptionsGetString(NULL, from->prefix, "-load_history", file, size, set));
  PetscCheck(!*set || file[0], from->comm, SAM_ERR_USER, "-history has no value: expected the name of a file");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryReadIncrements(const SamOptions *from, PetscInt *increments)
{
  static const SamOptionRow row = {"steps", "load steps per row of the history", SAM_OPTION_INT, .least = 1};

  PetscFunctionBegin;
  *increments = 1;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, increments, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryDestroy(SamHistory *history)
{
  PetscFunctionBegin;
  if (!*history) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamTableDestroy(&(*history)->table));
  PetscCall(PetscFree((*history)->column));
  PetscCall(SamConditionsDestroy(&(*history)->conditions));
  PetscCall(PetscFree(*history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamHistoryGetCount(SamHistory h)
{
  return h->start + (h->rows - 1) * h->increments;
}

PetscInt SamHistoryGetIncrements(SamHistory h)
{
  return h->increments;
}

PetscInt SamHistoryGetStart(SamHistory h)
{
  return h->start;
}

PetscBool SamHistoryIsLast(SamHistory h, PetscInt k)
{
  return (PetscBool)(k < h->start ? k == h->start - 1 : (k - h->start + 1) % h->increments == 0);
}

PetscInt SamHistoryNextEnd(SamHistory h, PetscInt k)
{
  const PetscInt before = k < h->start ? 0 : h->start + (k - h->start) / h->increments * h->increments,
                 last   = before + (k < h->start ? h->start : h->increments) - 1;

  return k < last ? last : k + 1;
}

PetscBool SamHistoryGives(SamHistory h, const SamCondition *condition)
{
  for (PetscInt k = SAM_COMPONENTS; k < h->parts; k++) {
    const SamCondition *one = SamConditionsGet(h->conditions, k - SAM_COMPONENTS);

    if (strcmp(one->group, condition->group)) continue;
    if (h->column[k] >= 0 || SamControlGet(&h->constant, one) != one->usual) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Returns row r of a column. In the functions below, row -1 is the start, before the first row. */
static double Entry(SamHistory h, PetscInt column, PetscInt r)
{
  return h->table.value[r * h->table.columns + column];
}

static double TimeOfRow(SamHistory h, PetscInt r)
{
  if (!h->table.rows) return (double)(r + 1);
  if (r >= 0) return Entry(h, h->time, r);
  if (Entry(h, h->time, 0) > (double)h->before.time) return (double)h->before.time;
  return Entry(h, h->time, 0) - (h->table.rows > 1 ? Entry(h, h->time, 1) - Entry(h, h->time, 0) : 1);
}

/*
  Checks that each row's change can be divided into its steps: it must be finite, and the times of the steps must
  differ.
*/
static PetscErrorCode CheckChanges(SamHistory h, MPI_Comm comm, const char file[])
{
  const SamTable *t = &h->table;

  PetscFunctionBegin;
  for (PetscInt r = h->start < h->increments ? 1 : 0; r < t->rows; r++) {
    const double now = TimeOfRow(h, r), before = TimeOfRow(h, r - 1), each = (now - before) / (double)h->increments;

    for (PetscInt c = 0; c < t->columns; c++)
      PetscCheck(isfinite(Entry(h, c, r) - (c == h->time ? before
                                            : r > 0      ? Entry(h, c, r - 1)
                                                         : 0)),
                 comm, SAM_ERR_USER,
                 "%s, line %" PetscInt_FMT ": %s %.6g: its change since the row before is too large", file, t->line[r],
                 t->name[c], Entry(h, c, r));
    PetscCheck(each >= TIME_ROUNDING * PetscMax(fabs(now), fabs(before)) && each > 0, comm, SAM_ERR_USER,
               "%s, line %" PetscInt_FMT ": time %.17g: too near to %.17g, that of the row before, for -steps "
               "%" PetscInt_FMT ": its steps would have the same time",
               file, t->line[r], now, before, h->increments);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns part k of the control (SamControlPart()) in row r: from its column, or constant. */
static double ValueOfRow(SamHistory h, PetscInt k, PetscInt r)
{
  const SamCondition *condition = k < SAM_COMPONENTS ? NULL : SamConditionsGet(h->conditions, k - SAM_COMPONENTS);

  if (r < 0 && condition && condition->change) return 0;
  if (r < 0 && (!condition || condition->option)) return (double)SamControlPart(&h->before, h->conditions, k);
  return h->column[k] >= 0 ? Entry(h, h->column[k], PetscMax(r, 0))
                           : (double)SamControlPart(&h->constant, h->conditions, k);
}

/* True if the first row prescribes the same values as the start. */
static PetscBool IsAtRest(SamHistory h)
{
  for (PetscInt k = 0; k < h->parts; k++)
    if (ValueOfRow(h, k, 0) != ValueOfRow(h, k, -1)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The allowed names of columns, NULL at the end */
#define NAMES (1 + SAM_WAYS * SAM_COMPONENTS + SAM_CONDITIONS + 1)
static void ListNames(SamHistory h, const char *names[NAMES])
{
  PetscInt n = 0;

  names[0] = "time";
  while ((names[n + 1] = SamControlName(h->conditions, n))) n++;
}

static void TakeTable(SamHistory h)
{
  h->rows = h->table.rows;
  h->time = SamTableFind(&h->table, "time");
}

static PetscErrorCode Create(SamConditions conditions, SamHistory *history)
{
  SamHistory h;

  PetscFunctionBegin;
  PetscCall(PetscNew(&h));
  *history      = h;
  h->rows       = 1;
  h->increments = 1;
  h->time       = -1;
  PetscCall(SamConditionsReference(conditions));
  h->conditions = conditions;
  h->parts      = SamControlCount(conditions);
  PetscCall(PetscMalloc1(h->parts, &h->column));
  PetscCall(SamControlInitialize(&h->constant));
  PetscCall(SamControlInitialize(&h->before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the number of steps up to the first row: if that is the start itself, one. */
static PetscInt StartOf(SamHistory h, PetscInt increments)
{
  return h->table.rows && IsAtRest(h) ? 1 : increments;
}

/* Sets the number of load steps per row, and checks the table. */
static PetscErrorCode SetIncrements(SamHistory h, PetscInt increments, MPI_Comm comm, const char file[])
{
  PetscFunctionBegin;
  h->increments = increments;
  h->start      = StartOf(h, increments);
  PetscCall(CheckRows(h, comm, file));
  PetscCall(CheckChanges(h, comm, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryCreate(MPI_Comm comm, SamConditions conditions, const SamControl *constant,
                                const SamControl *before, const char columns[], PetscInt rows, const double values[],
                                PetscInt increments, SamHistory *history)
{
  static const char what[] = "history";

  const char *names[NAMES];
  SamHistory  h;

  PetscFunctionBegin;
  PetscCall(Create(conditions, history));
  h           = *history;
  h->constant = *constant;
  PetscCall(PetscStrncpy(h->file, what, sizeof(h->file)));
  ListNames(h, names);
  PetscCall(SamTableCreate(comm, what, columns, rows, values, names, &h->table));
  TakeTable(h);
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) PetscCall(FindColumn(h, comm, what, c));
  PetscCheck(increments > 0 && increments <= PETSC_MAX_INT / rows, comm, SAM_ERR_USER,
             "%s: %" PetscInt_FMT " increments of %" PetscInt_FMT " rows: expected a number > 0 that can be counted",
             what, increments, rows);
  PetscCheck(h->column[SAM_COMPONENT_N] >= 0, comm, SAM_ERR_USER, "%s: expected the column load_n or disp_z", what);
  for (PetscInt k = SAM_COMPONENTS; k < h->parts; k++)
    h->column[k] = SamTableFind(&h->table, SamControlPartName(constant, conditions, k));
  if (before) h->before = *before;
  for (PetscInt c = 0; c < SAM_COMPONENTS && before; c++) /* there are no values between a load and a displacement */
    if (SamControlWay(before, c) != SamControlWay(&h->constant, c)) h->before.value[c] = ValueOfRow(h, c, 0);
  PetscCall(SetIncrements(h, increments, comm, what));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryCreateFromOptions(const SamOptions *from, const SamArguments *arguments,
                                           SamConditions conditions, SamHistory *history)
{
  SamHistory  h;
  Reader      reader     = {.from = from, .arguments = arguments};
  PetscInt    increments = 1;
  const char *names[NAMES];
  PetscBool   has_file, left[SAM_COMPONENTS];

  PetscFunctionBegin;
  PetscCall(Create(conditions, history));
  h           = *history;
  reader.file = h->file;
  PetscCall(SamOptionsHeading(from, "Loads and displacements"));
  PetscCall(ReadFileName(from, h->file, sizeof(h->file), &has_file));
  PetscCall(SamHistoryReadIncrements(from, &increments));
  ListNames(h, names);
  if (has_file) PetscCall(SamTableRead(from->comm, "history", h->file, names, &h->table));
  if (has_file) TakeTable(h);
  PetscCheck(increments <= PETSC_MAX_INT / h->rows, from->comm, SAM_ERR_USER,
             "-%ssteps %" PetscInt_FMT ": times %" PetscInt_FMT
             " rows is more steps than can be counted (%" PetscInt_FMT ")",
             SamOptionsPrefix(from), increments, h->rows, PETSC_MAX_INT);
  for (PetscInt k = 0; SamControlName(NULL, k); k++) /* so that no option is taken for another, misspelled one */
    SamOptionsKnow(from, SamControlName(NULL, k), NULL);
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) PetscCall(ReadComponent(h, &reader, c, &left[c]));
  PetscCall(NoteSpin(h, from, left));
  for (PetscInt k = SAM_COMPONENTS; k < h->parts; k++) PetscCall(ReadCondition(h, &reader, k));
  PetscCall(SetIncrements(h, increments, from->comm, h->file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt RowOf(SamHistory h, PetscInt k)
{
  return k < h->start ? 0 : 1 + (k - h->start) / h->increments;
}

PetscErrorCode SamHistoryGetPlace(SamHistory h, PetscInt k, char text[], size_t size)
{
  PetscFunctionBegin;
  text[0] = '\0';
  if (h->table.rows)
    PetscCall(PetscSNPrintf(text, size, "%s, line %" PetscInt_FMT ": ", h->file, h->table.line[RowOf(h, k)]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamControl SamHistoryGetStep(SamHistory h, PetscInt k)
{
  return SamHistoryGetPart(h, k, 1);
}

/* ---- other steps ---- */

PetscErrorCode SamHistoryDivide(SamHistory h, PetscInt increments, SamHistory *other)
{
  SamHistory       o;
  const SamControl first = SamHistoryGetStep(h, 0);

  PetscFunctionBegin;
  PetscCall(PetscNew(&o));
  *o = *h;
  PetscCall(SamTableCopy(&h->table, &o->table));
  PetscCall(PetscMalloc1(h->parts, &o->column));
  PetscCall(PetscArraycpy(o->column, h->column, h->parts));
  PetscCall(SamConditionsReference(h->conditions));
  o->increments = increments;
  o->together   = first.together;
  o->apart      = increments > 1 && !IsAtRest(h) && !first.together && first.value[SAM_COMPONENT_N] > 0 &&
             h->before.value[SAM_COMPONENT_N] == 0;
  o->start = StartOf(h, o->apart ? 2 * increments : increments);
  *other   = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamHistoryFindStep(SamHistory h, SamHistory other, PetscInt k)
{
  const PetscInt r = RowOf(h, k), n = r ? h->increments : h->start, m = r ? other->increments : other->start,
                 done = r ? (k - h->start) % h->increments + 1 : k + 1,
                 at   = r ? other->start + (r - 1) * other->increments : 0;

  if (done == n) return at + m - 1;
  return done * m % n || (!r && other->apart) ? -1 : at + done * m / n - 1;
}

/* Changes of two rows are in proportion if they differ by less, relative to the larger change. */
#define IN_PROPORTION 1e-9

/* True if all prescribed values change in the row after r in proportion to their changes in r. */
static PetscBool ContinuesAfter(SamHistory h, PetscInt r)
{
  const double now  = ValueOfRow(h, SAM_COMPONENT_N, r) - ValueOfRow(h, SAM_COMPONENT_N, r - 1);
  const double next = r + 1 < h->rows ? ValueOfRow(h, SAM_COMPONENT_N, r + 1) - ValueOfRow(h, SAM_COMPONENT_N, r) : 0;

  if (!(now * next > 0)) return PETSC_FALSE;
  for (PetscInt p = 0; p < h->parts; p++) {
    const double one   = next * (ValueOfRow(h, p, r) - ValueOfRow(h, p, r - 1)),
                 other = now * (ValueOfRow(h, p, r + 1) - ValueOfRow(h, p, r));

    if (fabs(one - other) > IN_PROPORTION * PetscMax(fabs(one), fabs(other))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Returns the part of the change of part p of the control, if the tangential loads follow the others. */
static double WayApart(PetscInt p, double way)
{
  for (PetscInt c = 0; c < 3; c++)
    if (p == SamComponentsOf[SAM_BALANCE_TANGENTIAL][c]) return PetscMax(0, 2 * way - 1);
  return PetscMin(1, 2 * way);
}

SamControl SamHistoryGetPart(SamHistory h, PetscInt k, PetscReal part)
{
  const PetscInt  r = RowOf(h, k), steps = r ? h->increments : h->start;
  const double    i = (double)(r ? (k - h->start) % h->increments : k) + (double)part, way = i / (double)steps;
  const PetscBool apart   = r == 0 && h->apart;
  SamControl      control = h->constant;

/* linear between the rows; on a row its own value, without rounding */
#define BETWEEN(way, before, after) ((way) == 1 ? (after) : (before) + (way) * ((after) - (before)))
  control.time = BETWEEN(way, TimeOfRow(h, r - 1), TimeOfRow(h, r));
  for (PetscInt p = 0; p < h->parts; p++)
    SamControlSetPart(&control, h->conditions, p,
                      p >= SAM_COMPONENTS && SamConditionsGet(h->conditions, p - SAM_COMPONENTS)->change
                        ? ValueOfRow(h, p, r) / (double)steps
                        : BETWEEN(apart ? WayApart(p, way) : way, ValueOfRow(h, p, r - 1), ValueOfRow(h, p, r)));
#undef BETWEEN
  control.sudden = r == 0 ? PETSC_TRUE : PETSC_FALSE;
  control.together =
    (r == 0 && h->together) || (r ? (k - h->start) % h->increments : k) + 1 < steps || ContinuesAfter(h, r);
  return control;
}
