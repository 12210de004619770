/* The load program: options and a file in, steps out. */
#include "historyimpl.h"

#define COMPONENTS 6

struct _n_SamHistory {
  SamBalance constant[2]; /* controls, and the values of the components without a column */
  PetscInt   rows, increments;
  SamTable   table;              /* empty without a file */
  PetscInt   column[COMPONENTS]; /* of each component, -1: constant */
};

static SamBalance *BalanceOf(SamBalance balances[2], PetscInt component, PetscInt *k)
{
  *k = component % 3;
  return &balances[component / 3];
}

/* One component: its load or its displacement, by option or by column. */
static PetscErrorCode ReadComponent(SamHistory h, const char file[], PetscInt component)
{
  static const char *const units[2][3] = {{"N", "N m", "N m"}, {"N", "N", "N m"}};
  const SamOptions         from        = {PETSC_COMM_WORLD, NULL};
  PetscInt                 k;
  SamBalance              *balance = BalanceOf(h->constant, component, &k);
  const char              *load = SamLoadNames[balance->kind][k], *rigid = SamRigidNames[balance->kind][k];
  const PetscBool          is_n        = component == 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt           load_column = SamTableFind(&h->table, load), rigid_column = SamTableFind(&h->table, rigid);
  PetscBool                has_load, has_rigid, help;
  char                     text[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(text, sizeof(text), "load (%s), or instead %s", units[balance->kind][k], rigid));
  PetscCall(
    SamOptionsReal(&from, load, text, is_n ? SAM_RANGE_NONNEGATIVE : SAM_RANGE_ANY, &balance->load[k], &has_load));
  PetscCall(SamOptionsReal(
    &from, rigid, !strncmp(rigid, "rot", 3) ? "the conjugate rotation (rad)" : "the conjugate displacement (m)",
    SAM_RANGE_ANY, &balance->rigid[k], &has_rigid));
  PetscCheck(!has_load || !has_rigid, PETSC_COMM_WORLD, SAM_ERR_USER, "-%s and -%s are conjugate: give one of them",
             load, rigid);
  PetscCheck(load_column < 0 || rigid_column < 0, PETSC_COMM_WORLD, SAM_ERR_USER,
             "%s, line %" PetscInt_FMT ": the columns %s and %s are conjugate: give one of them", file,
             h->table.header_line, load, rigid);
  for (PetscInt c = 0; c < 2; c++) {
    const PetscBool given  = c ? has_rigid : has_load;
    const PetscBool column = (load_column >= 0 || rigid_column >= 0) ? PETSC_TRUE : PETSC_FALSE;

    PetscCheck(!given || !column, PETSC_COMM_WORLD, SAM_ERR_USER, "-%s: %s has the column %s; give one of them",
               c ? rigid : load, file, load_column >= 0 ? load : rigid);
  }
  PetscCall(SamPrintHelp(&help));
  PetscCheck(!is_n || has_load || has_rigid || load_column >= 0 || rigid_column >= 0 || help, PETSC_COMM_WORLD,
             SAM_ERR_USER, "-load_n or -disp_z is missing: the normal force (N) or the approach (m)");
  balance->force[k]    = (has_rigid || rigid_column >= 0) ? PETSC_FALSE : PETSC_TRUE;
  h->column[component] = load_column >= 0 ? load_column : rigid_column;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a row must hold besides numbers: times that increase, no negative normal force. */
static PetscErrorCode CheckRows(SamHistory h, const char file[])
{
  const SamTable *t    = &h->table;
  const PetscInt  time = SamTableFind(t, "time"), load_n = SamTableFind(t, "load_n");

  PetscFunctionBegin;
  PetscCheck(time >= 0, PETSC_COMM_WORLD, SAM_ERR_USER, "%s, line %" PetscInt_FMT ": no column named time", file,
             t->header_line);
  for (PetscInt c = 0; c < t->columns; c++) {
    PetscBool known = c == time ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt component = 0; component < COMPONENTS; component++)
      known = (known || h->column[component] == c) ? PETSC_TRUE : PETSC_FALSE;
    PetscCheck(known, PETSC_COMM_WORLD, SAM_ERR_USER,
               "%s, line %" PetscInt_FMT
               ": unknown column %s; expected time or the name of a load or displacement, load_n ... rot_z",
               file, t->header_line, t->name[c]);
  }
  for (PetscInt r = 0; r < t->rows; r++) {
    const double *row = t->value + r * t->columns;

    PetscCheck(r == 0 || row[time] > row[time - t->columns], PETSC_COMM_WORLD, SAM_ERR_USER,
               "%s, line %" PetscInt_FMT ": time %g does not come after %g", file, t->line[r], row[time],
               row[time - t->columns]);
    PetscCheck(load_n < 0 || row[load_n] >= 0, PETSC_COMM_WORLD, SAM_ERR_USER,
               "%s, line %" PetscInt_FMT ": load_n %g, expected a number >= 0", file, t->line[r], row[load_n]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryClaimOption(void)
{
  PetscErrorCode code;

  /* before PetscInitialize(): no error handling yet. Setting a value makes the database, in which the alias is kept. */
  code = PetscOptionsSetValue(NULL, "-petsam_program", NULL);
  if (!code) code = PetscOptionsSetAlias(NULL, "-history", "-petsam_history");
  if (!code) code = PetscOptionsClearValue(NULL, "-petsam_program");
  return code;
}

/* The file's name: -history as claimed from PETSc. */
static PetscErrorCode ReadFileName(char file[], size_t size, PetscBool *has_file)
{
  const SamOptions from = {PETSC_COMM_WORLD, NULL};
  PetscBool        help;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  if (help) {
    PetscCall(
      SamOptionsString(&from, "history", "text file with a load step a row (README, Histories)", file, size, has_file));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscOptionsGetString(NULL, NULL, "-petsam_history", file, size, has_file));
  PetscCheck(!*has_file || file[0], PETSC_COMM_WORLD, SAM_ERR_USER, "-history has no value: expected a file's name");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryCreateFromOptions(MPI_Comm comm, SamHistory *history)
{
  const SamOptions from = {comm, NULL};
  SamHistory       h;
  char             file[PETSC_MAX_PATH_LEN] = "";
  PetscBool        has_file;

  PetscFunctionBegin;
  PetscCall(PetscNew(&h));
  *history            = h;
  h->constant[1].kind = SAM_BALANCE_TANGENTIAL;
  h->rows             = 1;
  h->increments       = 1;
  PetscCall(SamOptionsHeading(&from, "Loads and displacements"));
  PetscCall(ReadFileName(file, sizeof(file), &has_file));
  PetscCall(
    SamOptionsInt(&from, "steps", "increments into which each step's change is divided", 1, &h->increments, NULL));
  if (has_file) {
    PetscCall(SamTableRead(comm, file, &h->table));
    h->rows = h->table.rows;
  }
  PetscCheck(h->increments <= PETSC_MAX_INT / h->rows, comm, SAM_ERR_USER,
             "-steps %" PetscInt_FMT ": times %" PetscInt_FMT " rows is more steps than can be counted", h->increments,
             h->rows);
  for (PetscInt component = 0; component < COMPONENTS; component++) PetscCall(ReadComponent(h, file, component));
  if (has_file) PetscCall(CheckRows(h, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryDestroy(SamHistory *history)
{
  PetscFunctionBegin;
  if (!*history) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamTableDestroy(&(*history)->table));
  PetscCall(PetscFree(*history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryGetCount(SamHistory h, PetscInt *steps)
{
  PetscFunctionBegin;
  *steps = h->rows * h->increments;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHistoryGetIncrements(SamHistory h, PetscInt *increments)
{
  PetscFunctionBegin;
  *increments = h->increments;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Value of a component, or the time (component -1), in row r; row -1 is the start. */
static double RowValue(SamHistory h, PetscInt component, PetscInt r)
{
  const SamTable *t = &h->table;
  const PetscInt  c = component < 0 ? SamTableFind(t, "time") : h->column[component];

  if (component < 0 && !t->rows) return (double)(r + 1);
  if (component < 0 && r < 0)
    return t->value[c] > 0 ? 0 : t->value[c] - (t->rows > 1 ? t->value[c + t->columns] - t->value[c] : 1);
  if (r < 0) return 0;
  if (c >= 0) return t->value[r * t->columns + c];
  {
    PetscInt          k;
    const SamBalance *balance = BalanceOf(h->constant, component, &k);

    return balance->force[k] ? balance->load[k] : balance->rigid[k];
  }
}

PetscErrorCode SamHistoryGetStep(SamHistory h, PetscInt step_number, SamStep *step)
{
  const PetscInt r = step_number / h->increments, i = step_number % h->increments + 1;
  const double   t = (double)i / (double)h->increments;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(step, sizeof(*step)));
  step->normal.kind     = SAM_BALANCE_NORMAL;
  step->tangential.kind = SAM_BALANCE_TANGENTIAL;
  for (PetscInt component = -1; component < COMPONENTS; component++) {
    /* the row's own value without rounding at its end */
    const double before = RowValue(h, component, r - 1), after = RowValue(h, component, r),
                 value = i == h->increments ? after : before + t * (after - before);
    PetscInt    k;
    SamBalance *balance, *control;

    if (component < 0) {
      step->time = value;
      continue;
    }
    control           = BalanceOf(h->constant, component, &k);
    balance           = component < 3 ? &step->normal : &step->tangential;
    balance->force[k] = control->force[k];
    if (control->force[k])
      balance->load[k] = value;
    else
      balance->rigid[k] = value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
