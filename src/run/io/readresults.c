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
  int           has[SAM_STRESS_FIELDS], number[SAM_RESULTS_NUMBERS];
  int           column[SAM_PARAMETERS]; /* true if a parameter is also a column of the history */
} Facts;

/* One file of the run */
typedef struct {
  Facts    facts;
  PetscInt steps; /* number from the run's start to the beginning of the next part */
  SamFile  file;
  hid_t    field[SAM_STRESS_FIELDS], stress[SAM_LAYER_GROUPS][SAM_STRESS_COMPONENTS];
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

/* Rejects the file unless a condition holds; the text describes the fault. */
#define CHECK(f, is, ...) \
  do { \
    char fault[256]; \
    (void)snprintf(fault, sizeof(fault), __VA_ARGS__); \
    PetscCheck(is, (f)->comm, SAM_ERR_FILE, SAM_CANNOT_READ, (f)->option, (f)->filename, fault); \
  } while (0)

/* Returns the number of values of a root attribute that has numbers. */
static hssize_t CountNumbers(SamFile f, const char name[])
{
  const hid_t attribute = H5Aopen(f->id, name, H5P_DEFAULT), type = attribute >= 0 ? H5Aget_type(attribute) : -1,
              space       = attribute >= 0 ? H5Aget_space(attribute) : -1;
  const H5T_class_t class = type >= 0 ? H5Tget_class(type) : H5T_NO_CLASS;
  const hssize_t count    = class == H5T_FLOAT || class == H5T_INTEGER ? H5Sget_simple_extent_npoints(space) : 0;

  if (space >= 0) (void)H5Sclose(space);
  if (type >= 0) (void)H5Tclose(type);
  if (attribute >= 0) (void)H5Aclose(attribute);
  return count;
}

/* Reads a root attribute of so many numbers. */
static PetscErrorCode GetNumbers(SamFile f, const char name[], PetscInt count, double values[])
{
  PetscFunctionBegin;
  CHECK(f, SamFileHasAttribute(f, name), "it lacks the attribute %s of a results file of petsam", name);
  CHECK(f, CountNumbers(f, name) == count, "its attribute %s is not what petsam writes", name);
  SamFileReadAttribute(f, f->id, name, H5T_NATIVE_DOUBLE, count, values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a root attribute that is a text shorter than `size`; empty if it is missing. */
static void GetText(SamFile f, const char name[], size_t size, char text[])
{
  if (!SamTextRead(f->id, name, text, size) || strlen(text) + 1 == size) text[0] = '\0';
}

/*
  Reads the root attributes that may be parameters: a few numbers, or a short text. A constant of a body in another form
  gets the count -1, so that it does not count as missing.
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

static PetscErrorCode CheckWhole(SamFile f, const char name[], hid_t dataset, const hsize_t shape[])
{
  PetscFunctionBegin;
  CHECK(f, SamFileIsWhole(f, dataset, shape, PETSC_TRUE), "it is damaged: %s is not in it as a whole", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef char Name[80];

static void NameField(int k, Name name)
{
  (void)snprintf(name, sizeof(Name), "/%s", SamStressField(k));
}

static PetscErrorCode ExamineFields(SamFile f, Facts *facts)
{
  hsize_t shape[3];
  hid_t   dataset[SAM_STRESS_FIELDS], times;

  PetscFunctionBegin;
  PetscCall(Open(f, "/history/time", 1, &facts->steps, &times));
  PetscCall(Open(f, "/time", 1, &facts->saved, &times));
  for (int k = 0; SamStressField(k); k++) {
    Name name;

    NameField(k, name);
    facts->has[k] = k < SAM_STRESS_TRACTIONS || H5Lexists(f->id, name, H5P_DEFAULT) > 0;
    if (!facts->has[k]) continue;
    PetscCall(Open(f, name, 3, shape, &dataset[k]));
    facts->saved = PetscMin(facts->saved, shape[0]);
    CHECK(f, (double)shape[1] == facts->n[1] && (double)shape[2] == facts->n[0],
          "%s has %llu x %llu cells, not the %.6g x %.6g of -grid_n", name, (unsigned long long)shape[2],
          (unsigned long long)shape[1], facts->n[0], facts->n[1]);
  }
  shape[0] = facts->saved;
  for (int k = 0; SamStressField(k); k++) {
    Name name;

    NameField(k, name);
    if (facts->has[k]) PetscCall(CheckWhole(f, name, dataset[k], shape));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the name of a stress in a group of layers. */
static void NameStress(const Group *g, int component, Name name)
{
  (void)snprintf(name, sizeof(Name), "/%s/%s", g->name, SamLayerStresses[component]);
}

/* Examines the stresses of a group, unless the first of their components is missing. */
static PetscErrorCode ExamineGroup(SamFile f, Facts *facts, Group *g)
{
  const double layers = (double)g->count[0] + (double)g->count[1];
  hsize_t      shape[4];
  hid_t        dataset;
  Name         name;

  PetscFunctionBegin;
  NameStress(g, 0, name);
  g->saved = H5Lexists(f->id, g->name, H5P_DEFAULT) > 0 && H5Lexists(f->id, name, H5P_DEFAULT) > 0;
  if (!g->saved) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(name, sizeof(name), "/%s/z", g->name);
  PetscCall(Open(f, name, 1, shape, &dataset));
  CHECK(f, (double)shape[0] == layers, "%s has %llu depths, not those of %.0f layers", name,
        (unsigned long long)shape[0], layers);
  PetscCall(CheckWhole(f, name, dataset, shape));
  for (int c = 0; c < SAM_STRESS_COMPONENTS; c++) {
    NameStress(g, c, name);
    PetscCall(Open(f, name, 4, shape, &dataset));
    CHECK(f,
          shape[0] >= facts->saved && (double)shape[1] == layers && (double)shape[2] == facts->n[1] &&
            (double)shape[3] == facts->n[0],
          "%s has another shape than the run", name);
    shape[0] = facts->saved;
    PetscCall(CheckWhole(f, name, dataset, shape));
  }
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
  char names[256], *rest = names;
  int  has[2] = {0, 0};

  PetscFunctionBegin;
  GetText(f, SAM_OUTPUT_STRESSES, sizeof(names), names);
  for (char *name = strtok_r(names, ",", &rest); name; name = strtok_r(NULL, ",", &rest)) {
    Group *const g        = &facts->group[facts->groups];
    double       about[3] = {0};
    Name         layers;

    CHECK(f, facts->groups < SAM_LAYER_GROUPS && strlen(name) < sizeof(g->name), SAM_OUTPUT_STRESSES " is damaged");
    for (int k = 0; k < facts->groups; k++)
      CHECK(f, strcmp(facts->group[k].name, name), SAM_OUTPUT_STRESSES " names %s twice", name);
    (void)snprintf(g->name, sizeof(g->name), "%s", name);
    (void)snprintf(layers, sizeof(layers), "%s" SAM_OUTPUT_LAYERS, name);
    PetscCall(GetNumbers(f, layers, 3, about));
    for (int b = 0; b < 2; b++) {
      CHECK(f, about[b] >= 0 && about[b] <= MOST_LAYERS && about[b] == floor(about[b]), "%s is damaged", layers);
      g->count[b] = (int)about[b];
      has[b]      = has[b] || g->count[b];
    }
    CHECK(f, about[2] == 0 || about[2] == 1, "%s is damaged", layers);
    g->initial = about[2] != 0;
    PetscCall(ExamineGroup(f, facts, g));
    facts->groups++;
  }
  for (int b = 0; b < 2; b++)
    CHECK(f, has[b] || !Yields(&facts->parameters, b),
          "body %d yields, but the attribute " SAM_OUTPUT_STRESSES
          " names no stresses in its layers: it is damaged, or "
          "of an earlier petsam: run petsam again",
          b + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if an optional column of the history exists. */
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
  facts->tractions = NAN;
  if (SamFileHasAttribute(f, SAM_OUTPUT_TRACTIONS))
    PetscCall(GetNumbers(f, SAM_OUTPUT_TRACTIONS, 1, &facts->tractions));
  if (SamFileHasAttribute(f, SAM_OUTPUT_BRANCH)) PetscCall(GetNumbers(f, SAM_OUTPUT_BRANCH, 1, &facts->first));
  GetText(f, SAM_OUTPUT_IDENTITY, sizeof(facts->identity), facts->identity);
  GetText(f, SAM_OUTPUT_FOLLOWS, sizeof(facts->follows), facts->follows);
  CHECK(f, IsPlausible(facts), "its parameters are not those of a run of petsam");
  PetscCall(ExamineFields(f, facts));
  PetscCall(ExamineGroups(f, facts));
  for (int n = 0; n < SAM_RESULTS_NUMBERS; n++) PetscCall(ExamineColumn(f, facts, numbers[n], &facts->number[n]));
  for (PetscInt k = 0; k < facts->parameters.count; k++) { /* load cases are parameters and columns */
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

/* Opens a part and adds its saved steps; the part before may already have saved the first of them. */
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
  PetscCall(SamFileBegin(part->file));
  ReadSeries(part->file, "/history/time", 0, steps, times);
  ReadSeries(part->file, "/time", 0, saved, saves);
  for (int k = 0; SamStressField(k); k++)
    if (facts->has[k])
      part->field[k] = SamFileNote(part->file, H5Dopen2(part->file->id, SamStressField(k), H5P_DEFAULT));
  for (int g = 0; g < facts->groups; g++)
    for (int c = 0; c < SAM_STRESS_COMPONENTS && facts->group[g].saved; c++) {
      Name name;

      NameStress(&facts->group[g], c, name);
      part->stress[g][c] = SamFileNote(part->file, H5Dopen2(part->file->id, name, H5P_DEFAULT));
    }
  PetscCall(SamFileEnd(part->file));
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
    Name                  name;

    *to = (SamStateLayers){
      of->name, {of->count[0], of->count[1]}, NULL, PETSC_TRUE, of->initial ? PETSC_TRUE : PETSC_FALSE};
    for (PetscInt k = 0; k < r->count; k++) saved = saved && r->part[k]->facts.group[g].saved;
    if (!saved) continue;
    PetscCall(PetscMalloc1(count, &to->z));
    (void)snprintf(name, sizeof(name), "/%s/z", of->name);
    PetscCall(SamFileBegin(part->file));
    ReadSeries(part->file, name, 0, (hsize_t)count, to->z);
    PetscCall(SamFileEnd(part->file));
    for (PetscInt l = 0; l < count; l++)
      PetscCheck(isfinite(to->z[l]) && (l == 0 || to->z[l] > to->z[l - 1]) && (to->z[l] < 0) == (l < to->count[0]),
                 part->file->comm, SAM_ERR_FILE, SAM_CANNOT_READ, part->file->option, part->file->filename,
                 "the z of its layers does not rise");
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
    ierr = SamFileOpen(r->grid, SAM_EVENT_OUTPUT, option, name, SAM_FILE_READ, &r->part[k]->file);
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

/* Raises an error if a value on any rank is not finite. */
static PetscErrorCode CheckFinite(const Part *part, PetscInt n, const double values[], const char name[], PetscInt step)
{
  PetscReal wrong = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n && wrong == 0; k++) wrong = isfinite(values[k]) ? 0 : 1;
  PetscCall(SamMax(part->file->comm, 1, &wrong));
  PetscCheck(wrong == 0, part->file->comm, SAM_ERR_FILE,
             "-%s %s: %s of step %" PetscInt_FMT " has values that are no finite numbers", part->file->option,
             part->file->filename, name, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResultsRead(SamResults r, PetscInt k, const char field[], double values[])
{
  const Part *const part = r->saved[k].part;
  const PetscInt    n    = SamStressFieldFind(field);
  Name              name;

  PetscFunctionBegin;
  (void)snprintf(name, sizeof(name), "/%s", field);
  PetscCheck(n < SAM_STRESS_FIELDS && part->facts.has[n], r->grid->comm, SAM_ERR_FILE, "-%s %s: has no dataset %s",
             part->file->option, part->file->filename, name);
  PetscCall(SamFileBegin(part->file));
  SamFileReadFrame(part->file, part->field[n], H5T_NATIVE_DOUBLE, r->saved[k].index, values);
  PetscCall(SamFileEnd(part->file));
  PetscCall(CheckFinite(part, r->grid->cells, values, name, r->saved[k].step));
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
  const Part *const part  = r->saved[k].part;
  const SamBlock    block = {4,
                             {r->saved[k].index, (hsize_t)layer, (hsize_t)r->grid->row_start, 0},
                             {1, 1, (hsize_t)r->grid->rows, (hsize_t)r->grid->nx}};
  Name              name;

  PetscFunctionBegin;
  PetscCall(SamFileBegin(part->file));
  SamFileReadBlock(part->file, part->stress[g][component], H5T_NATIVE_DOUBLE, &block, values);
  PetscCall(SamFileEnd(part->file));
  NameStress(&part->facts.group[g], (int)component, name);
  PetscCall(CheckFinite(part, r->grid->cells, values, name, r->saved[k].step));
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
  char name[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "/history/%s", column));
  PetscCall(SamFileBegin(part->file));
  ReadSeries(part->file, name, (hsize_t)(step - (PetscInt)part->facts.first) - 1, 1, value);
  PetscCall(SamFileEnd(part->file));
  PetscCall(CheckFinite(part, 1, value, name, step));
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
