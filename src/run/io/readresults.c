/*
  Reads the results of a run.

  Rank 0 examines parameters, shapes and the places of the data, so that a damaged file ends in a message, on all ranks
  alike. Then all ranks open the file and read their rows. The parts of a restarted run are read as one run: from each
  part the steps before the next part begins.
*/
#include "ioimpl.h"
#include <petsam/private/results.h>
#include <petsam/private/stresspart.h>
#include <string.h>

static const char *const numbers[SAM_RESULTS_NUMBERS] = {"cycle",   "status",   "contact_area", "slide_x",
                                                         "slide_y", "rolled_x", "rolled_y"};
/* A group with stresses in layers below the cells */
typedef struct {
  char name[SAM_LAYER_NAME];
  int  count[2], initial, saved; /* layers of both bodies; true if it has the stress before any load, and was saved */
} Group;

/* Description of the run in its results file */
typedef struct {
  double        n[2], width[2], center[2];
  char          options[4096]; /* empty if too long */
  SamParameters parameters;
  hsize_t       steps, saved;
  double        tractions;                 /* error of the largest tractions, relative; NaN: unknown */
  double        first;                     /* number of load steps before those of the file */
  char          identity[32], follows[32]; /* identity of the file, and of the part before; empty: none */
  int           groups;                    /* number of groups with stresses in layers */
  Group         group[SAM_LAYER_GROUPS];
  PetscBool     has[SAM_STRESS_FIELDS], number[SAM_RESULTS_NUMBERS];
  PetscBool     column[SAM_PARAMETERS]; /* true if a parameter is also a column of the history */
} Facts;

/* One file of the run */
typedef struct {
  Facts    facts;
  PetscInt steps; /* number from the run's start to the beginning of the next part */
  SamFile  file;
} Part;

/* Place of the fields of a saved step */
typedef struct {
  const Part *part;
  hsize_t     index;
  double      time;
  PetscInt    step; /* number of the step, from 1 */
} Saved;

#define PARTS       4096 /* maximum number of parts */
#define MOST_LAYERS 1e6  /* more layers are no number of layers */
struct _n_SamResults {
  SamGrid  grid;
  PetscInt count, saves;
  Part    *part[PARTS];
  Saved   *saved;

  SamStateLayers layers[SAM_LAYER_GROUPS];
};

/* ---- examination, by one rank ---- */

static const SamFileKind kind = {"results file", "petsam"};

/*
  Reads the root attributes that may be parameters: a few numbers, or a short text. A constant of a body in another form
  gets the count -1, so that it does not count as missing.
*/
static void GetParameters(SamFile f, SamParameters *all)
{
  for (hsize_t k = 0; all->count < SAM_PARAMETERS; k++) {
    SamParameter *const p = &all->list[all->count];
    const ssize_t       size =
      H5Aget_name_by_idx(f->id, ".", H5_INDEX_NAME, H5_ITER_INC, k, p->name, sizeof(p->name), H5P_DEFAULT);
    hssize_t count;
    H5T_class_t class;

    if (size < 0) break;
    if (size >= (ssize_t)sizeof(p->name)) continue;
    class = SamAttributeClass(f->id, p->name, &count);
    (void)SamFileExpect(f, &kind, "", class == H5T_STRING,
                        &(SamExpected){p->name, SAM_TEXT, {sizeof(p->text)}, .values = p->text});
    if (class == H5T_FLOAT && count > 0 && count <= SAM_PARAMETER_VALUES) {
      SamFileReadAttribute(f, f->id, p->name, H5T_NATIVE_DOUBLE, count, p->value);
      p->count = (PetscInt)count;
    }
    if (!p->count && !p->text[0] && !strncmp(p->name, "body", 4)) p->count = -1;
    if (p->count || p->text[0]) all->count++;
  }
}

/* Examines the fields; the least number of steps in them is that of the saved ones. */
static PetscErrorCode ExamineFields(SamFile f, Facts *facts)
{
  const hsize_t nx = (hsize_t)facts->n[0], ny = (hsize_t)facts->n[1];

  PetscFunctionBegin;
  for (int whole = 0; whole < 2; whole++)
    for (int k = 0; SamStressField(k); k++) {
      SamExpected row = {
        SamStressField(k), 3, {whole ? facts->saved : 0, ny, nx}, .grows = 1, .optional = k >= SAM_STRESS_TRACTIONS};

      PetscCall(SamFileExpect(f, &kind, "/", 1, &row));
      facts->has[k] = row.found;
      if (row.found) facts->saved = PetscMin(facts->saved, row.size[0]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Examines the stresses of a group, unless the first of their components is missing. */
static PetscErrorCode ExamineGroup(SamFile f, const Facts *facts, Group *g)
{
  const hsize_t nx = (hsize_t)facts->n[0], ny = (hsize_t)facts->n[1], layers = (hsize_t)(g->count[0] + g->count[1]);
  SamExpected   z = {"z", 1, {layers}, .optional = 0};
  char          group[SAM_LAYER_NAME + 2];

  PetscFunctionBegin;
  (void)snprintf(group, sizeof(group), "/%s/", g->name);
  for (int c = 0; c < SAM_STRESS_COMPONENTS; c++) {
    SamExpected row = {SamLayerStresses[c], 4, {facts->saved, layers, ny, nx}, .grows = 1, .optional = !c};

    PetscCall(SamFileExpect(f, &kind, group, 1, &row));
    if (!c) g->saved = row.found;
    if (!g->saved) break;
  }
  if (g->saved) PetscCall(SamFileExpect(f, &kind, group, 1, &z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns true if a body yields, by the parameters of the run. */
static PetscBool Yields(const SamParameters *parameters, int body)
{
  const SamParameter *yield = SamParametersFind(parameters, body ? "body2_yield" : "body1_yield");

  return yield && yield->count == 1 && isfinite(yield->value[0]) && SamParametersFind(parameters, "yield_layers")
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/*
  Examines the groups with stresses in layers, which the file names. A body that yields has some: their lack would not
  be noticed in the stresses.
*/
static PetscErrorCode ExamineGroups(SamFile f, Facts *facts)
{
  char        names[256], *rest = names;
  int         has[2] = {0, 0};
  SamExpected list   = {SAM_OUTPUT_STRESSES, SAM_TEXT, {sizeof(names)}, .values = names};

  PetscFunctionBegin;
  PetscCall(SamFileExpect(f, &kind, "", 1, &list));
  for (char *name = strtok_r(names, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
    Group *const g = &facts->group[facts->groups];
    double       about[3];
    char         layers[SAM_EXPECT_NAME];
    SamExpected  row = {layers, SAM_ATTRIBUTE, {3}, .values = about, .most = MOST_LAYERS};

    SamFileCheck(f, facts->groups < SAM_LAYER_GROUPS && strlen(name) < sizeof(g->name),
                 "cannot be read: " SAM_OUTPUT_STRESSES " is damaged");
    for (int k = 0; k < facts->groups; k++)
      SamFileCheck(f, strcmp(facts->group[k].name, name), "cannot be read: " SAM_OUTPUT_STRESSES " names %s twice",
                   name);
    (void)snprintf(g->name, sizeof(g->name), "%s", name);
    (void)snprintf(layers, sizeof(layers), "%s" SAM_OUTPUT_LAYERS, name);
    PetscCall(SamFileExpect(f, &kind, "", 1, &row));
    SamFileCheck(f, about[2] <= 1, "cannot be read: %s is damaged: its last number is %.6g, expected 0 or 1", layers,
                 about[2]);
    for (int b = 0; b < 2; b++) {
      g->count[b] = (int)about[b];
      has[b]      = has[b] || g->count[b];
    }
    g->initial = about[2] != 0;
    PetscCall(ExamineGroup(f, facts, g));
    facts->groups++;
  }
  for (int b = 0; b < 2; b++)
    SamFileCheck(f, has[b] || !Yields(&facts->parameters, b),
                 "cannot be read: body %d yields, but the attribute " SAM_OUTPUT_STRESSES
                 " names no stresses in its layers: it is damaged, or of an earlier petsam: run petsam again",
                 b + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if an optional column of the history exists. */
static PetscErrorCode ExamineColumn(SamFile f, const Facts *facts, const char column[], PetscBool *has)
{
  SamExpected row = {column, 1, {0}, .grows = 1, .optional = 1};

  PetscFunctionBegin;
  PetscCall(SamFileExpect(f, &kind, "/history/", 1, &row));
  *has = row.found;
  SamFileCheck(f, !row.found || row.size[0] >= facts->steps,
               "cannot be read: /history/%s has %llu values, not the %llu of /history/time", column,
               (unsigned long long)row.size[0], (unsigned long long)facts->steps);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Look(SamFile f, const void *question, void *answer)
{
  Facts *facts = (Facts *)answer;

  SamExpected attributes[] = {
    {"grid_n", SAM_ATTRIBUTE, {2}, .values = facts->n, .range = SAM_RANGE_POSITIVE, .most = 1e9},
    {"grid_size", SAM_ATTRIBUTE, {2}, .values = facts->width, .range = SAM_RANGE_POSITIVE},
    {"grid_center", SAM_ATTRIBUTE, {2}, .values = facts->center},
    {SAM_OUTPUT_TRACTIONS, SAM_ATTRIBUTE, {1}, .values = &facts->tractions, .free = 1, .optional = 1},
    {SAM_OUTPUT_BRANCH, SAM_ATTRIBUTE, {1}, .values = &facts->first, .most = 1e9, .optional = 1},
    {"options", SAM_TEXT, {sizeof(facts->options)}, .values = facts->options},
    {SAM_OUTPUT_IDENTITY, SAM_TEXT, {sizeof(facts->identity)}, .values = facts->identity},
    {SAM_OUTPUT_FOLLOWS, SAM_TEXT, {sizeof(facts->follows)}, .values = facts->follows}};
  SamExpected times[] = {{"/history/time", 1, {0}, .grows = 1}, {"/time", 1, {0}, .grows = 1}};

  PetscFunctionBegin;
  (void)question;
  facts->tractions = NAN;
  PetscCall(SamFileExpect(f, &kind, "", SAM_OPTION_ROWS(attributes)));
  SamFileCheck(f, facts->n[0] >= 2, "cannot be read: grid_n is %.6g along x: expected 2 or more", facts->n[0]);
  GetParameters(f, &facts->parameters);
  PetscCall(SamFileExpect(f, &kind, "", SAM_OPTION_ROWS(times)));
  facts->steps = times[0].size[0];
  facts->saved = times[1].size[0];
  PetscCall(ExamineFields(f, facts));
  PetscCall(ExamineGroups(f, facts));
  for (int n = 0; n < SAM_RESULTS_NUMBERS; n++) PetscCall(ExamineColumn(f, facts, numbers[n], &facts->number[n]));
  for (PetscInt k = 0; k < facts->parameters.count; k++) { /* load cases are parameters and columns */
    const char *name = facts->parameters.list[k].name;

    PetscCall(ExamineColumn(f, facts, name, &facts->column[k]));
    SamFileCheck(f, facts->column[k] || strstr(name, "_case_") != name + 5, "cannot be read: it has no column %s",
                 name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- opening ---- */

/* Reads a block of a dataset of a part. */
static PetscErrorCode ReadBlock(const Part *part, const char name[], const SamBlock *block, double values[])
{
  hid_t dataset;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(part->file));
  dataset = SamFileNote(part->file, H5Dopen2(part->file->id, name, H5P_DEFAULT));
  SamFileReadBlock(part->file, dataset, H5T_NATIVE_DOUBLE, block, values);
  (void)SamFileNote(part->file, H5Dclose(dataset));
  PetscCall(SamFileEnd(part->file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the saved steps of a part; the part before may already have saved the first of them. */
static PetscErrorCode ReadTimes(SamResults r, Part *part)
{
  const Facts  *facts = &part->facts;
  const hsize_t steps = facts->steps, saved = facts->saved;
  double       *times, *saves;
  hsize_t       row = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(steps + 1, &times));
  PetscCall(PetscCalloc1(saved + 1, &saves));
  PetscCall(PetscRealloc(sizeof(Saved) * ((size_t)r->saves + saved + 1), &r->saved));
  PetscCall(ReadBlock(part, "/history/time", &(SamBlock){1, {0}, {steps}}, times));
  PetscCall(ReadBlock(part, "/time", &(SamBlock){1, {0}, {saved}}, saves));
  for (hsize_t k = 0; k < saved; k++) {
    const PetscBool before = r->count > 1 && k == 0 && steps && saves[0] < times[0]; /* the last step before the part */
    PetscInt        step;

    while (row < steps && times[row] < saves[k]) row++;
    step = (PetscInt)facts->first + (before ? 0 : (PetscInt)row + 1);
    if (!before && !(row < steps && times[row] == saves[k]))
      break; /* a killed run may leave fields without their row */
    if (step <= part->steps && (!r->saves || step > r->saved[r->saves - 1].step))
      r->saved[r->saves++] = (Saved){part, k, saves[k], step};
  }
  PetscCall(PetscFree(times));
  PetscCall(PetscFree(saves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns true if two parts have the same groups with stresses in layers, saved or not. */
static PetscBool HaveSameGroups(const Facts *a, const Facts *b)
{
  for (int g = 0; g < SAM_LAYER_GROUPS; g++) {
    const Group *const one = &a->group[g], *const other = &b->group[g];

    if (strcmp(one->name, other->name) || one->initial != other->initial || one->count[0] != other->count[0] ||
        one->count[1] != other->count[1])
      return PETSC_FALSE;
  }
  return a->groups == b->groups ? PETSC_TRUE : PETSC_FALSE;
}

/* Examines the part with this number, from 1, and takes it if it exists and follows the part before. */
static PetscErrorCode FindPart(SamResults r, MPI_Comm comm, const char option[], const char name[], PetscBool *found)
{
  Part *const before = r->count ? r->part[r->count - 1] : NULL;
  Part       *part;
  double      bytes = 0;

  PetscFunctionBegin;
  if (before) PetscCall(SamFileGetBytes(comm, name, &bytes));
  *found = bytes < 0 ? PETSC_FALSE : PETSC_TRUE;
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&part));
  r->part[r->count++] = part; /* SamResultsDestroy() frees it */
  PetscCall(SamFileExamine(comm, option, name, NULL, Look, NULL, &part->facts, sizeof(part->facts)));
  part->steps = (PetscInt)part->facts.first + (PetscInt)part->facts.steps;
  if (!before) PetscFunctionReturn(PETSC_SUCCESS);
  *found = before->facts.identity[0] && !strcmp(part->facts.follows, before->facts.identity) ? PETSC_TRUE : PETSC_FALSE;
  if (!*found) {
    r->count--;
    PetscCall(PetscFree(part));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCheck(part->facts.n[0] == before->facts.n[0] && part->facts.n[1] == before->facts.n[1] &&
               part->facts.first >= before->facts.first && (PetscInt)part->facts.first <= before->steps,
             comm, SAM_ERR_FILE,
             "-%s %s: cannot be read: it does not fit the part before it, whose steps are %ld to %ld", option, name,
             (long)before->facts.first + 1, (long)before->steps);
  PetscCheck(HaveSameGroups(&part->facts, &before->facts), comm, SAM_ERR_FILE,
             "-%s %s: cannot be read: its stresses in layers are not those of the part before it", option, name);
  before->steps = (PetscInt)part->facts.first;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindParts(SamResults r, MPI_Comm comm, const char option[], const char filename[])
{
  PetscBool found = PETSC_TRUE;

  PetscFunctionBegin;
  while (found && r->count < PARTS) {
    char          *name;
    PetscErrorCode ierr;

    PetscCall(SamOutputNamePart(filename, r->count + 1, &name));
    ierr = FindPart(r, comm, option, name, &found);
    PetscCall(PetscFree(name));
    PetscCall(ierr);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sets the groups of stresses in layers, which all parts of a run have. The depths of those that all parts have saved
  are read; they must rise.
*/
static PetscErrorCode ReadLayers(SamResults r)
{
  const Part *const part = r->part[0];

  PetscFunctionBegin;
  for (int g = 0; g < part->facts.groups; g++) {
    const Group *const    of    = &part->facts.group[g];
    SamStateLayers *const to    = &r->layers[g];
    const PetscInt        count = of->count[0] + of->count[1];
    PetscBool             saved = PETSC_TRUE;
    char                  name[SAM_EXPECT_NAME];

    *to = (SamStateLayers){
      of->name, {of->count[0], of->count[1]}, NULL, PETSC_TRUE, of->initial ? PETSC_TRUE : PETSC_FALSE};
    for (PetscInt k = 0; k < r->count; k++) saved = saved && r->part[k]->facts.group[g].saved;
    if (!saved) continue;
    PetscCall(PetscMalloc1(count, &to->z));
    (void)snprintf(name, sizeof(name), "/%s/z", of->name);
    PetscCall(ReadBlock(part, name, &(SamBlock){1, {0}, {(hsize_t)count}}, to->z));
    for (PetscInt l = 0; l < count; l++)
      SamFileCheck(part->file,
                   isfinite(to->z[l]) && (l == 0 || to->z[l] > to->z[l - 1]) && (to->z[l] < 0) == (l < to->count[0]),
                   "cannot be read: the z of its layers does not rise");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsOpen(MPI_Comm comm, const char option[], const char filename[], SamResults *results)
{
  PetscInt   n[2];
  PetscReal  width[2], center[2];
  SamResults r;

  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(PetscNew(&r));
  *results = r;
  PetscCall(FindParts(r, comm, option, filename));
  for (int k = 0; k < 2; k++) {
    n[k]      = (PetscInt)r->part[0]->facts.n[k];
    width[k]  = (PetscReal)r->part[0]->facts.width[k];
    center[k] = (PetscReal)r->part[0]->facts.center[k];
  }
  PetscCall(SamGridCreate(comm, n, width, center, &r->grid));
  for (PetscInt k = 0; k < r->count; k++) {
    char          *name;
    PetscErrorCode ierr;

    PetscCall(SamOutputNamePart(filename, k + 1, &name));
    ierr = SamFileOpen(r->grid, SAM_EVENT_OUTPUT, option, name, SAM_FILE_READ, NULL, &r->part[k]->file);
    PetscCall(PetscFree(name));
    PetscCall(ierr);
    PetscCall(ReadTimes(r, r->part[k]));
  }
  PetscCall(ReadLayers(r));
  PetscCheck(r->saves > 0, comm, SAM_ERR_FILE, "-%s %s: cannot be read: no step has been saved in it", option,
             filename);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsDestroy(SamResults *results)
{
  SamResults r = *results;

  PetscFunctionBegin;
  *results = NULL;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < r->count; k++) {
    PetscCall(SamFileDestroy(&r->part[k]->file, PETSC_TRUE));
    PetscCall(PetscFree(r->part[k]));
  }
  for (PetscInt g = 0; g < SAM_LAYER_GROUPS; g++) PetscCall(PetscFree(r->layers[g].z));
  PetscCall(PetscFree(r->saved));
  PetscCall(SamGridDestroy(&r->grid));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- contents ---- */

SamGrid SamResultsGetGrid(SamResults r)
{
  return r->grid;
}

const SamParameters *SamResultsGetParameters(SamResults r)
{
  return &r->part[0]->facts.parameters;
}

const char *SamResultsGetOptions(SamResults r)
{
  return r->part[0]->facts.options;
}

double SamResultsGetTractionError(SamResults r)
{
  return r->part[r->count - 1]->facts.tractions;
}

PetscErrorCode SamResultsGetSteps(SamResults r, PetscInt *steps, PetscInt *saved)
{
  PetscFunctionBegin;
  if (steps) *steps = r->part[r->count - 1]->steps;
  if (saved) *saved = r->saves;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsGetSaved(SamResults r, PetscInt k, PetscInt *step, PetscReal *time)
{
  PetscFunctionBegin;
  PetscCheck(k >= 0 && k < r->saves, r->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Saved step %" PetscInt_FMT " of %" PetscInt_FMT, k, r->saves);
  if (step) *step = r->saved[k].step;
  if (time) *time = (PetscReal)r->saved[k].time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a block of finite numbers of a step. */
static PetscErrorCode ReadFinite(const Part *part, const char name[], const SamBlock *block, PetscInt step,
                                 double values[])
{
  PetscReal wrong = 0;
  hsize_t   n     = 1;

  PetscFunctionBegin;
  PetscCall(ReadBlock(part, name, block, values));
  for (int d = 0; d < block->rank; d++) n *= block->count[d];
  for (hsize_t k = 0; k < n && wrong == 0; k++) wrong = isfinite(values[k]) ? 0 : 1;
  PetscCall(SamMax(part->file->comm, 1, &wrong));
  SamFileCheck(part->file, wrong == 0, "%s of step %" PetscInt_FMT " has values that are no finite numbers", name,
               step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsRead(SamResults r, PetscInt k, const char field[], double values[])
{
  const Saved *const at    = &r->saved[k];
  const PetscInt     n     = SamStressFieldFind(field);
  const SamBlock     block = {
        3, {at->index, (hsize_t)r->grid->row_start, 0}, {1, (hsize_t)r->grid->rows, (hsize_t)r->grid->nx}};
  char name[SAM_EXPECT_NAME];

  PetscFunctionBegin;
  (void)snprintf(name, sizeof(name), "/%s", field);
  SamFileCheck(at->part->file, n < SAM_STRESS_FIELDS && at->part->facts.has[n], "has no dataset %s", name);
  PetscCall(ReadFinite(at->part, name, &block, at->step, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamResultsHas(SamResults r, PetscInt k, const char field[])
{
  const PetscInt n = SamStressFieldFind(field);

  return n < SAM_STRESS_FIELDS && r->saved[k].part->facts.has[n] ? PETSC_TRUE : PETSC_FALSE;
}

const SamStateLayers *SamResultsGetLayers(SamResults r, PetscInt g)
{
  return g < r->part[0]->facts.groups ? &r->layers[g] : NULL;
}

PetscErrorCode SamResultsReadLayer(SamResults r, PetscInt k, PetscInt g, PetscInt component, PetscInt layer,
                                   double values[])
{
  const Saved *const at    = &r->saved[k];
  const SamBlock     block = {4,
                              {at->index, (hsize_t)layer, (hsize_t)r->grid->row_start, 0},
                              {1, 1, (hsize_t)r->grid->rows, (hsize_t)r->grid->nx}};
  char               name[SAM_EXPECT_NAME];

  PetscFunctionBegin;
  (void)snprintf(name, sizeof(name), "/%s/%s", at->part->facts.group[g].name, SamLayerStresses[component]);
  PetscCall(ReadFinite(at->part, name, &block, at->step, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the part that contains a step, from 1. */
static const Part *PartOf(SamResults r, PetscInt step)
{
  PetscInt k = 0;

  while (k + 1 < r->count && step > r->part[k]->steps) k++;
  return r->part[k];
}

/* Reads a value of a column of the history at a step, from 1. */
static PetscErrorCode ReadNumber(const Part *part, const char column[], PetscInt step, double *value)
{
  const SamBlock block = {1, {(hsize_t)(step - (PetscInt)part->facts.first) - 1}, {1}};
  char           name[SAM_EXPECT_NAME];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "/history/%s", column));
  PetscCall(ReadFinite(part, name, &block, step, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsReadConditions(SamResults r, PetscInt step, SamConditions conditions, SamControl *control)
{
  const Part *const          part = PartOf(r, step);
  const SamParameters *const p    = &part->facts.parameters;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SamConditionsCount(conditions); k++) {
    const SamCondition *one   = SamConditionsGet(conditions, k);
    const SamParameter *given = SamParametersFind(p, one->name);
    double              value = (double)one->usual;

    if (given && part->facts.column[given - p->list]) PetscCall(ReadNumber(part, one->name, step, &value));
    SamControlSetCondition(control, one, value);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsReadNumber(SamResults r, PetscInt step, SamResultsNumber number, double *value)
{
  const Part *const part = PartOf(r, step);

  PetscFunctionBegin;
  *value = 0;
  if (part->facts.number[number]) PetscCall(ReadNumber(part, numbers[number], step, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
