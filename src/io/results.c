/*
  Results of a run, read again.

  Rank 0 examines parameters, shapes, and where the data lie, so that a damaged file ends in a message, on all ranks
  alike. Then all ranks open it and read their rows.
*/
#include "ioimpl.h"
#include <petsam/results.h>
#include <string.h>

static const char *const numbers[SAM_RESULTS_NUMBERS] = {"cycle", "status", "contact_area"};
static const char *const fields[SAM_RESULTS_FIELDS]   = {"/pressure", "/shear_x", "/shear_y", "/slip_x", "/slip_y"};

/* What the file says of its run. */
typedef struct {
  double        n[2], width[2], center[2];
  char          options[4096]; /* empty if they are longer */
  SamParameters parameters;
  hsize_t       steps, saved;
  double        first; /* load steps before those of the file */
  int           has[SAM_RESULTS_FIELDS], number[SAM_RESULTS_NUMBERS];
  int           column[SAM_PARAMETERS]; /* whether a parameter is a column of the history, too */
} Facts;

struct _n_SamResults {
  Facts     facts;
  SamGrid   grid;
  SamFile   file;
  hid_t     field[SAM_RESULTS_FIELDS];
  double   *saved_time;
  PetscInt *saved_step;
};

/* ---- examination, by one rank ---- */

/* Refuses the file unless something is so; the text says what is not. */
#define CHECK(f, is, ...) \
  do { \
    char fault[256]; \
    (void)snprintf(fault, sizeof(fault), __VA_ARGS__); \
    PetscCheck(is, (f)->comm, SAM_ERR_FILE, SAM_CANNOT_READ, (f)->option, (f)->filename, fault); \
  } while (0)

/* A root attribute of one or two numbers. */
static PetscErrorCode GetNumbers(SamFile f, const char name[], PetscInt count, double values[])
{
  PetscFunctionBegin;
  CHECK(f, SamFileHasAttribute(f, name), "it lacks the attribute %s of a results file of petsam", name);
  SamFileReadAttribute(f, f->id, name, H5T_NATIVE_DOUBLE, count, values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A root attribute that is a text shorter than `size`; empty if it is not there. */
static void GetText(SamFile f, const char name[], size_t size, char text[])
{
  if (!SamTextRead(f->id, name, text, size) || strlen(text) + 1 == size) text[0] = '\0';
}

/*
  The root attributes that parameters are stored as: numbers, not too many, and short texts. A constant of a body that
  is none of these has the count -1, so that it is not taken for missing.
*/
static void GetParameters(SamFile f, SamParameters *all)
{

  for (hsize_t k = 0; all->count < SAM_PARAMETERS; k++) {
    SamParameter *const p         = &all->list[all->count];
    const hid_t         attribute = H5Aopen_by_idx(f->id, ".", H5_INDEX_NAME, H5_ITER_INC, k, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = attribute >= 0 ? H5Aget_type(attribute) : -1, space = type >= 0 ? H5Aget_space(attribute) : -1;
    const hssize_t count = space >= 0 ? H5Sget_simple_extent_npoints(space) : 0;

    if (attribute < 0) break;
    if (H5Aget_name(attribute, sizeof(p->name), p->name) < (ssize_t)sizeof(p->name)) {
      if (H5Tget_class(type) == H5T_STRING) GetText(f, p->name, sizeof(p->text), p->text);
      if (H5Tget_class(type) == H5T_FLOAT && count > 0 && count <= SAM_PARAMETER_VALUES &&
          H5Aread(attribute, H5T_NATIVE_DOUBLE, p->value) >= 0)
        p->count = (PetscInt)count;
      if (!p->count && !p->text[0] && !strncmp(p->name, "body", 4)) p->count = -1;
      if (p->count || p->text[0]) all->count++;
    }
    if (space >= 0) (void)H5Sclose(space);
    if (type >= 0) (void)H5Tclose(type);
    (void)H5Aclose(attribute);
  }
}

/* Opens a dataset of numbers with that number of dimensions, and gets its shape. */
static PetscErrorCode Open(SamFile f, const char name[], int rank, hsize_t shape[], hid_t *dataset)
{
  H5T_class_t type;

  PetscFunctionBegin;
  *dataset = H5Dopen2(f->id, name, H5P_DEFAULT);
  CHECK(f, *dataset >= 0, "it has no dataset %s", name);
  type = H5Tget_class(H5Dget_type(*dataset));
  CHECK(f, (type == H5T_FLOAT || type == H5T_INTEGER) && H5Sget_simple_extent_ndims(H5Dget_space(*dataset)) == rank,
        "%s is not what petsam writes", name);
  (void)SamFileGetSize(f, *dataset, rank, shape);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ExamineFields(SamFile f, Facts *facts)
{
  hsize_t shape[3];
  hid_t   dataset[SAM_RESULTS_FIELDS], times;

  PetscFunctionBegin;
  PetscCall(Open(f, "/history/time", 1, &facts->steps, &times));
  PetscCall(Open(f, "/time", 1, &facts->saved, &times));
  for (int k = 0; k < SAM_RESULTS_FIELDS; k++) {
    facts->has[k] = k < SAM_RESULTS_SLIP_X || H5Lexists(f->id, fields[k], H5P_DEFAULT) > 0;
    if (!facts->has[k]) continue;
    PetscCall(Open(f, fields[k], 3, shape, &dataset[k]));
    facts->saved = PetscMin(facts->saved, shape[0]);
    CHECK(f, (double)shape[1] == facts->n[1] && (double)shape[2] == facts->n[0],
          "%s has %llu x %llu cells, not the %.6g x %.6g of -grid_n", fields[k], (unsigned long long)shape[2],
          (unsigned long long)shape[1], facts->n[0], facts->n[1]);
  }
  shape[0] = facts->saved;
  for (int k = 0; k < SAM_RESULTS_FIELDS; k++)
    CHECK(f, !facts->has[k] || SamFileIsWhole(f, dataset[k], shape, PETSC_TRUE),
          "it is damaged: %s is not in it as a whole", fields[k]);
  CHECK(f, facts->saved > 0, "no step has been saved in it");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An optional column of the history: whether it is there. */
static PetscErrorCode ExamineColumn(SamFile f, const Facts *facts, const char column[], int *has)
{
  hsize_t shape[1];
  hid_t   dataset;
  char    name[64];

  PetscFunctionBegin;
  (void)snprintf(name, sizeof(name), "/history/%s", column);
  *has = H5Lexists(f->id, name, H5P_DEFAULT) > 0;
  if (!*has) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Open(f, name, 1, shape, &dataset));
  CHECK(f, shape[0] >= facts->steps, "%s has %llu values", name, (unsigned long long)shape[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsPlausible(const Facts *f)
{
  for (int k = 0; k < 2; k++) {
    if (!(f->n[k] >= 2 - k && f->n[k] <= 1e9 && f->n[k] == floor(f->n[k]) && f->width[k] > 0 && isfinite(f->width[k])))
      return PETSC_FALSE;
    if (!(f->first >= 0 && f->first <= 1e9 && f->first == floor(f->first))) return PETSC_FALSE;
    if (!isfinite(f->center[k])) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscErrorCode Look(SamFile f, const void *question, void *answer)
{
  Facts *facts = (Facts *)answer;

  PetscFunctionBegin;
  (void)question;
  PetscCall(GetNumbers(f, "grid_n", 2, facts->n));
  PetscCall(GetNumbers(f, "grid_size", 2, facts->width));
  PetscCall(GetNumbers(f, "grid_center", 2, facts->center));
  GetParameters(f, &facts->parameters);
  GetText(f, "options", sizeof(facts->options), facts->options);
  if (SamFileHasAttribute(f, SAM_OUTPUT_BRANCH)) PetscCall(GetNumbers(f, SAM_OUTPUT_BRANCH, 1, &facts->first));
  CHECK(f, IsPlausible(facts), "its parameters are not those of a run of petsam");
  PetscCall(ExamineFields(f, facts));
  for (int n = 0; n < SAM_RESULTS_NUMBERS; n++) PetscCall(ExamineColumn(f, facts, numbers[n], &facts->number[n]));
  for (PetscInt k = 0; k < facts->parameters.count; k++) { /* load cases are parameters, and columns */
    const char *name = facts->parameters.list[k].name;

    PetscCall(ExamineColumn(f, facts, name, &facts->column[k]));
    CHECK(f, facts->column[k] || strstr(name, "_case_") != name + 5, "it has no column %s", name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- opening ---- */

static void ReadSeries(SamFile file, const char name[], hsize_t first, hsize_t count, double values[])
{
  const hid_t    dataset = SamFileNote(file, H5Dopen2(file->id, name, H5P_DEFAULT));
  const SamBlock block   = {1, {first}, {count}};

  SamFileReadBlock(file, dataset, H5T_NATIVE_DOUBLE, &block, values);
  (void)SamFileNote(file, H5Dclose(dataset));
}

/* Times, and the load steps that the saved ones are. */
static PetscErrorCode ReadTimes(SamResults r)
{
  const hsize_t steps = r->facts.steps, saved = r->facts.saved;
  double       *times;
  hsize_t       step = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(steps + 1, &times));
  PetscCall(PetscCalloc1(saved, &r->saved_time));
  PetscCall(PetscCalloc1(saved, &r->saved_step));
  PetscCall(SamFileBegin(r->file));
  ReadSeries(r->file, "/history/time", 0, steps, times);
  ReadSeries(r->file, "/time", 0, saved, r->saved_time);
  for (int k = 0; k < SAM_RESULTS_FIELDS; k++)
    if (r->facts.has[k]) r->field[k] = SamFileNote(r->file, H5Dopen2(r->file->id, fields[k], H5P_DEFAULT));
  PetscCall(SamFileEnd(r->file));
  for (hsize_t k = 0; k < saved; k++) {
    while (step < steps && times[step] < r->saved_time[k]) step++;
    r->saved_step[k] = (PetscInt)r->facts.first + (PetscInt)step + 1;
    if (step < steps && times[step] == r->saved_time[k]) continue;
    r->facts.saved = k; /* a run that was killed may leave fields without their row */
    break;
  }
  PetscCall(PetscFree(times));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsOpen(MPI_Comm comm, const char option[], const char filename[], SamResults *results)
{
  PetscInt   n[2];
  PetscReal  width[2], center[2];
  SamResults r;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(PetscNew(&r));
  *results = r;
  PetscCall(SamFileExamine(comm, option, filename, Look, NULL, &r->facts, sizeof(r->facts)));
  for (int k = 0; k < 2; k++) {
    n[k]      = (PetscInt)r->facts.n[k];
    width[k]  = (PetscReal)r->facts.width[k];
    center[k] = (PetscReal)r->facts.center[k];
  }
  PetscCall(SamGridCreate(comm, n, width, center, &r->grid));
  PetscCall(SamFileOpen(r->grid, SAM_EVENT_OUTPUT, option, filename, SAM_FILE_READ, &r->file));
  PetscCall(ReadTimes(r));
  PetscCheck(r->facts.saved > 0, comm, SAM_ERR_FILE, "-%s %s: cannot be read: no step has been saved in it", option,
             filename);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsDestroy(SamResults *results)
{
  SamResults r = *results;

  PetscFunctionBegin;
  *results = NULL;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFileDestroy(&r->file, PETSC_TRUE));
  PetscCall(PetscFree(r->saved_time));
  PetscCall(PetscFree(r->saved_step));
  PetscCall(SamGridDestroy(&r->grid));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what is in it ---- */

PetscErrorCode SamResultsGetGrid(SamResults r, SamGrid *grid)
{
  PetscFunctionBegin;
  *grid = r->grid;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsGetParameters(SamResults r, const SamParameters **parameters)
{
  PetscFunctionBegin;
  *parameters = &r->facts.parameters;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsGetOptions(SamResults r, const char **options)
{
  PetscFunctionBegin;
  *options = r->facts.options;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsGetSteps(SamResults r, PetscInt *steps, PetscInt *saved)
{
  PetscFunctionBegin;
  if (steps) *steps = (PetscInt)r->facts.first + (PetscInt)r->facts.steps;
  if (saved) *saved = (PetscInt)r->facts.saved;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsGetSaved(SamResults r, PetscInt k, PetscInt *step, PetscReal *time)
{
  PetscFunctionBegin;
  PetscCheck(k >= 0 && k < (PetscInt)r->facts.saved, r->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Saved step %" PetscInt_FMT " of %" PetscInt_FMT, k, (PetscInt)r->facts.saved);
  if (step) *step = r->saved_step[k];
  if (time) *time = (PetscReal)r->saved_time[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Raises an error if a value on any rank is no finite number. */
static PetscErrorCode CheckFinite(SamResults r, PetscInt n, const double values[], const char name[], PetscInt step)
{
  PetscReal wrong = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n && wrong == 0; k++) wrong = isfinite(values[k]) ? 0 : 1;
  PetscCall(SamMax(r->grid->comm, 1, &wrong));
  PetscCheck(wrong == 0, r->grid->comm, SAM_ERR_FILE,
             "-%s %s: %s of step %" PetscInt_FMT " has values that are no finite numbers", r->file->option,
             r->file->filename, name, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsRead(SamResults r, PetscInt k, SamResultsField field, double values[])
{
  PetscFunctionBegin;
  PetscCheck(r->facts.has[field], r->grid->comm, SAM_ERR_FILE, "-%s %s: has no dataset %s", r->file->option,
             r->file->filename, fields[field]);
  PetscCall(SamFileBegin(r->file));
  SamFileReadFrame(r->file, r->field[field], H5T_NATIVE_DOUBLE, (hsize_t)k, values);
  PetscCall(SamFileEnd(r->file));
  PetscCall(CheckFinite(r, r->grid->cells, values, fields[field], r->saved_step[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A value of a column of the history, at a step from 1. */
static PetscErrorCode ReadNumber(SamResults r, const char column[], PetscInt step, double *value)
{
  char name[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "/history/%s", column));
  PetscCall(SamFileBegin(r->file));
  ReadSeries(r->file, name, (hsize_t)(step - (PetscInt)r->facts.first) - 1, 1, value);
  PetscCall(SamFileEnd(r->file));
  PetscCall(CheckFinite(r, 1, value, name, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsReadConditions(SamResults r, PetscInt step, SamConditions conditions, SamControl *control)
{
  const SamParameters *p = &r->facts.parameters;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SamConditionsCount(conditions); k++) {
    const SamCondition *one   = SamConditionsGet(conditions, k);
    const SamParameter *given = SamParametersFind(p, one->name);
    double              value = (double)one->usual;

    if (given && r->facts.column[given - p->list]) PetscCall(ReadNumber(r, one->name, step, &value));
    SamControlSetCondition(control, one, value);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsReadNumber(SamResults r, PetscInt step, SamResultsNumber number, double *value)
{
  PetscFunctionBegin;
  *value = 0;
  if (r->facts.number[number]) PetscCall(ReadNumber(r, numbers[number], step, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
