/*
  Results of a run, read again.

  Rank 0 examines the file in a child process, with the serial driver: parameters, shapes, and where the data lie. So a
  damaged file ends in a message, on all ranks alike. Then all ranks open it and read their rows.
*/
#include "ioimpl.h"
#include <petsam/results.h>
#include <stdarg.h>
#include <string.h>

static const char *const fields[SAM_RESULTS_FIELDS] = {"/pressure", "/shear_x", "/shear_y", "/slip_x", "/slip_y"};

/* What the file says of its run. */
typedef struct {
  double  n[2], width[2], center[2], young[2], poisson[2];
  char    elasticity[64], options[4096]; /* options: empty if they are longer */
  hsize_t steps, saved;
  double  first; /* load steps before those of the file */
  int     has[SAM_RESULTS_FIELDS], bulk[2][SAM_BULK_COMPONENTS], cycle;
  char    problem[SAM_MESSAGE]; /* empty: none */
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

static void Complain(Facts *f, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
static void Complain(Facts *f, const char format[], ...)
{
  va_list values;

  if (f->problem[0]) return;
  va_start(values, format);
  (void)vsnprintf(f->problem, sizeof(f->problem), format, values);
  va_end(values);
}

/* A root attribute of one or two numbers. */
static void GetNumbers(Facts *f, hid_t file, const char name[], hssize_t count, double values[])
{
  const hid_t attribute = H5Aexists(file, name) > 0 ? H5Aopen(file, name, H5P_DEFAULT) : -1;
  const hid_t space     = attribute >= 0 ? H5Aget_space(attribute) : -1;

  if (space < 0 || H5Sget_simple_extent_npoints(space) != count || H5Aread(attribute, H5T_NATIVE_DOUBLE, values) < 0)
    Complain(f, "it lacks the attribute %s of a results file of petsam", name);
  if (space >= 0) (void)H5Sclose(space);
  if (attribute >= 0) (void)H5Aclose(attribute);
}

/* A root attribute that is a text shorter than `size`; empty if it is not there. */
static void GetText(hid_t file, const char name[], size_t size, char text[])
{
  const hid_t attribute = H5Aexists(file, name) > 0 ? H5Aopen(file, name, H5P_DEFAULT) : -1;
  const hid_t type      = attribute >= 0 ? H5Aget_type(attribute) : -1;
  char       *value     = NULL;
  const int   variable  = type >= 0 && H5Tis_variable_str(type) > 0;

  memset(text, 0, size);
  if (type >= 0 && H5Tget_class(type) == H5T_STRING && !variable && H5Tget_size(type) < size)
    (void)H5Aread(attribute, type, text);
  else if (variable && H5Aread(attribute, type, &value) >= 0 && value)
    (void)snprintf(text, size, "%s", strlen(value) < size ? value : "");
  if (value) (void)H5free_memory(value);
  if (type >= 0) (void)H5Tclose(type);
  if (attribute >= 0) (void)H5Aclose(attribute);
}

/* The shape of a dataset of numbers; false, with a complaint, if it is not there or not of that rank. */
static PetscBool GetShape(Facts *f, hid_t file, const char name[], int rank, hsize_t shape[])
{
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT), space = dataset >= 0 ? H5Dget_space(dataset) : -1,
              type = dataset >= 0 ? H5Dget_type(dataset) : -1;
  PetscBool good   = PETSC_FALSE;

  if (space < 0 || type < 0)
    Complain(f, "it has no dataset %s", name);
  else if (H5Tget_class(type) != H5T_FLOAT || H5Sget_simple_extent_ndims(space) != rank ||
           H5Sget_simple_extent_dims(space, shape, NULL) != rank)
    Complain(f, "%s is not what petsam writes", name);
  else
    good = PETSC_TRUE;
  if (type >= 0) (void)H5Tclose(type);
  if (space >= 0) (void)H5Sclose(space);
  if (dataset >= 0) (void)H5Dclose(dataset);
  return good;
}

static void ExamineFields(Facts *f, hid_t file)
{
  hsize_t steps[1] = {0}, saved[1] = {0}, shape[3] = {0, 0, 0};

  if (!GetShape(f, file, "/history/time", 1, steps) || !GetShape(f, file, "/time", 1, saved)) return;
  f->steps = steps[0];
  f->saved = saved[0];
  for (int k = 0; k < SAM_RESULTS_FIELDS; k++) {
    f->has[k] = k < SAM_RESULTS_SLIP_X || H5Lexists(file, fields[k], H5P_DEFAULT) > 0;
    if (!f->has[k]) continue;
    if (!GetShape(f, file, fields[k], 3, shape)) return;
    f->saved = PetscMin(f->saved, shape[0]);
    if ((double)shape[1] != f->n[1] || (double)shape[2] != f->n[0])
      Complain(f, "%s has %llu x %llu cells, not the %g x %g of -grid_n", fields[k], (unsigned long long)shape[2],
               (unsigned long long)shape[1], f->n[0], f->n[1]);
  }
  shape[0] = f->saved;
  for (int k = 0; k < SAM_RESULTS_FIELDS && !f->problem[0]; k++) {
    if (!f->has[k]) continue;
    const hid_t dataset = H5Dopen2(file, fields[k], H5P_DEFAULT);

    if (!SamChunksAreWhole(file, dataset, 3, shape, PETSC_TRUE))
      Complain(f, "it is damaged: %s is not in it as a whole", fields[k]);
    if (dataset >= 0) (void)H5Dclose(dataset);
  }
}

/* An optional column of the history, as far as it is there. */
static int ExamineColumn(Facts *f, hid_t file, const char column[])
{
  hsize_t shape[1] = {0};
  char    name[64];

  (void)snprintf(name, sizeof(name), "/history/%s", column);
  if (H5Lexists(file, name, H5P_DEFAULT) <= 0) return 0;
  if (GetShape(f, file, name, 1, shape) && shape[0] < f->steps)
    Complain(f, "%s has %llu values", name, (unsigned long long)shape[0]);
  return 1;
}

static void ExamineColumns(Facts *f, hid_t file)
{
  for (int body = 0; body < 2; body++)
    for (int k = 0; k < SAM_BULK_COMPONENTS; k++) f->bulk[body][k] = ExamineColumn(f, file, SamBulkNames[body][k].name);
  f->cycle = ExamineColumn(f, file, "cycle");
}

static PetscBool IsPlausible(const Facts *f)
{
  for (int k = 0; k < 2; k++) {
    if (!(f->n[k] >= 2 && f->n[k] <= 1e9 && f->n[k] == floor(f->n[k]) && f->width[k] > 0 && isfinite(f->width[k])))
      return PETSC_FALSE;
    if (!(f->first >= 0 && f->first <= 1e9 && f->first == floor(f->first))) return PETSC_FALSE;
    if (!isfinite(f->center[k]) || !(f->young[k] > 0) || !(f->poisson[k] > -1 && f->poisson[k] <= 0.5))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

typedef struct {
  const char *filename;
  Facts       facts;
} Case;

static void ExamineInChild(void *data)
{
  Case  *c = (Case *)data;
  Facts *f = &c->facts;
  hid_t  file;

  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  file = H5Fopen(c->filename, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) {
    Complain(f, "it is damaged");
    return;
  }
  GetNumbers(f, file, "grid_n", 2, f->n);
  GetNumbers(f, file, "grid_size", 2, f->width);
  GetNumbers(f, file, "grid_center", 2, f->center);
  GetNumbers(f, file, "body1_young", 1, &f->young[0]);
  GetNumbers(f, file, "body2_young", 1, &f->young[1]);
  GetNumbers(f, file, "body1_poisson", 1, &f->poisson[0]);
  GetNumbers(f, file, "body2_poisson", 1, &f->poisson[1]);
  GetText(file, "elasticity", sizeof(f->elasticity), f->elasticity);
  GetText(file, "options", sizeof(f->options), f->options);
  if (H5Aexists(file, SAM_OUTPUT_BRANCH) > 0) GetNumbers(f, file, SAM_OUTPUT_BRANCH, 1, &f->first);
  if (!f->elasticity[0]) Complain(f, "it lacks the attribute elasticity of a results file of petsam");
  if (!f->problem[0] && !IsPlausible(f)) Complain(f, "its parameters are not those of a run of petsam");
  if (!f->problem[0]) ExamineFields(f, file);
  if (!f->problem[0]) ExamineColumns(f, file);
  if (!f->problem[0] && f->saved == 0) Complain(f, "no step has been saved in it");
  (void)H5Fclose(file);
}

static PetscErrorCode Examine(MPI_Comm comm, const char option[], const char filename[], Facts *facts)
{
  Case        c = {.filename = filename};
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0 && !SamCallInChild(ExamineInChild, &c, sizeof(c))) {
    c.facts.problem[0] = '\0';
    Complain(&c.facts, "it is damaged");
  }
  *facts = c.facts;
  PetscCallMPI(MPI_Bcast(facts, (PetscMPIInt)sizeof(*facts), MPI_BYTE, 0, comm));
  PetscCheck(!facts->problem[0], comm, SAM_ERR_FILE, "-%s %s: cannot be read: %s", option, filename, facts->problem);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- opening ---- */

static void ReadSeries(SamFile file, const char name[], hsize_t first, hsize_t count, double values[])
{
  const hid_t dataset = SamFileNote(file, H5Dopen2(file->id, name, H5P_DEFAULT)),
              space   = SamFileNote(file, H5Dget_space(dataset)),
              memory  = SamFileNote(file, H5Screate_simple(1, &count, NULL));

  (void)SamFileNote(file, H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, NULL, &count, NULL));
  (void)SamFileNote(file, H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, file->transfer, values));
  (void)SamFileNote(file, H5Sclose(memory));
  (void)SamFileNote(file, H5Sclose(space));
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
  PetscCall(SamFileExamine(comm, option, filename, PETSC_FALSE));
  PetscCall(PetscNew(&r));
  *results = r;
  for (int k = 0; k < SAM_RESULTS_FIELDS; k++) r->field[k] = -1;
  PetscCall(Examine(comm, option, filename, &r->facts));
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
  if (r->file) {
    PetscCall(SamFileBegin(r->file));
    for (int k = 0; k < SAM_RESULTS_FIELDS; k++)
      if (r->field[k] >= 0) (void)SamFileNote(r->file, H5Dclose(r->field[k]));
    PetscCall(SamFileEnd(r->file));
    PetscCall(SamFileDestroy(&r->file, PETSC_TRUE));
  }
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

PetscErrorCode SamResultsGetPair(SamResults r, SamPair *pair)
{
  const PetscReal young[2]   = {(PetscReal)r->facts.young[0], (PetscReal)r->facts.young[1]};
  const PetscReal poisson[2] = {(PetscReal)r->facts.poisson[0], (PetscReal)r->facts.poisson[1]};

  PetscFunctionBegin;
  PetscCall(SamPairSet(pair, young, poisson));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsGetElasticity(SamResults r, const char **type)
{
  PetscFunctionBegin;
  *type = r->facts.elasticity;
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
  SamFileReadLayer(r->file, r->field[field], H5T_NATIVE_DOUBLE, (hsize_t)k, values);
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

PetscErrorCode SamResultsReadBulkStress(SamResults r, PetscInt step, PetscInt body, double stress[SAM_BULK_COMPONENTS])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) {
    stress[k] = 0;
    if (r->facts.bulk[body][k]) PetscCall(ReadNumber(r, SamBulkNames[body][k].name, step, &stress[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsReadCycle(SamResults r, PetscInt step, double *cycle)
{
  PetscFunctionBegin;
  *cycle = 0;
  if (r->facts.cycle) PetscCall(ReadNumber(r, "cycle", step, cycle));
  PetscFunctionReturn(PETSC_SUCCESS);
}
