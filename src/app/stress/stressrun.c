/* The run of petsam-stress: from tractions in a results file to stresses in a file of their own. */
#include "stressrun.h"
#include "../files.h"
#include "../memory.h"
#include <petsam/private/baseimpl.h>
#include <petsctime.h>

/* Bytes a cell for maps: kernels 120, stresses 48, spectra 48, a quantity that is written, and what MPI-IO copies. */
#define MAP_BYTES 240.0
/* Bytes a cell that the spectra of a section's steps may take on a rank, but at least so many in all. */
#define SECTION_BYTES 100.0
#define SECTION_LEAST 512e6
/* The least depth, in cells: above it the kernels would be those of the surface but for rounding. */
#define LEAST_DEPTH 1e-6

/* ---- set-up ---- */

static PetscErrorCode CheckDepths(const SamStressRun *run)
{
  const SamGrid g = run->grid;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < run->request.depths; k++) {
    const PetscReal z = run->request.depth[k], least = LEAST_DEPTH * PetscMin(g->dx, g->dy);

    PetscCheck(z == 0 || z >= least, g->comm, SAM_ERR_USER,
               "-depths: %g m is less than a millionth of a cell (%g m): the surface is 0", (double)z,
               (double)PetscMin(g->dx, g->dy));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The line of cells nearest to the section. */
static PetscErrorCode FindLine(SamStressRun *run)
{
  const SamGrid   g     = run->grid;
  const PetscBool row   = run->request.axis == SAM_SECTION_X ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt  n     = row ? g->ny : g->nx;
  const PetscReal first = row ? SamGridY(g, 0) : SamGridX(g, 0), step = row ? g->dy : g->dx;
  const PetscReal at = (run->request.place - first) / step;

  PetscFunctionBegin;
  if (!run->request.section) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(at >= -0.5 - 1e-9 && at <= (PetscReal)n - 0.5 + 1e-9, g->comm, SAM_ERR_USER,
             "-section %s=%g: outside of the grid, which reaches from %g to %g m", row ? "y" : "x",
             (double)run->request.place, (double)(first - 0.5 * step), (double)(first + ((PetscReal)n - 0.5) * step));
  run->index = (PetscInt)PetscMin(PetscMax(PetscFloorReal(at + 0.5), 0), (PetscReal)n - 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckBodies(SamStressRun *run)
{
  const char *type;
  SamPair     pair;

  PetscFunctionBegin;
  PetscCall(SamResultsGetElasticity(run->results, &type));
  PetscCheck(!strcmp(type, "halfspace"), run->grid->comm, SAM_ERR_USER,
             "-input %s: bodies of type %s: stresses are known of half-spaces only", run->request.input, type);
  PetscCall(SamResultsGetPair(run->results, &pair));
  run->young   = pair.young[run->request.body - 1];
  run->poisson = pair.poisson[run->request.body - 1];
  PetscCheck(run->young < PETSC_INFINITY, run->grid->comm, SAM_ERR_USER,
             "-body %" PetscInt_FMT ": it is rigid, its stresses are not determined", run->request.body);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadTimes(SamStressRun *run)
{
  PetscFunctionBegin;
  PetscCall(SamStressRequestSteps(&run->request, run->results, &run->steps, &run->saved));
  PetscCall(PetscMalloc1(run->steps, &run->times));
  PetscCall(PetscMalloc2(run->steps, &run->mises, run->steps, &run->principal));
  for (PetscInt k = 0; k < run->steps; k++) {
    PetscCall(SamResultsGetSaved(run->results, run->saved[k], NULL, &run->times[k]));
    run->mises[k] = run->principal[k] = (SamLargest){-INFINITY, 0};
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The steps of a section whose spectra are kept at a time. */
static PetscInt Batch(const SamStressRun *run)
{
  const double cells = (double)run->grid->nx * (double)run->grid->ny,
               room  = PetscMax(SECTION_LEAST, SECTION_BYTES * cells);

  return (PetscInt)PetscMax(1, PetscMin((double)run->steps, room / (50 * cells)));
}

static double Memory(const SamStressRun *run)
{
  const double cells = (double)run->grid->nx * (double)run->grid->ny;

  if (!run->request.section) return SAM_MEMORY_PROGRAM + MAP_BYTES * (double)run->grid->cells;
  return SAM_MEMORY_PROGRAM + 24 * (double)run->grid->cells + 8 * cells + 50 * cells * (double)Batch(run);
}

/* Refuses an output that would replace a file that is read; so would the XDMF file beside it. */
static PetscErrorCode CheckNames(const SamStressRequest *r, const SamArguments *arguments)
{
  char       *names[3] = {NULL, NULL, NULL}, clash[PETSC_MAX_PATH_LEN] = "";
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCall(PetscStrallocpy(r->output, &names[0]));
  PetscCall(SamOutputNames(r->output, &names[1], &names[2]));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (int k = 0; k < 3 && rank == 0; k++) {
    if (SamIsSameFile(names[k], r->input)) PetscCall(PetscStrncpy(clash, r->input, sizeof(clash)));
    for (int f = 0; f < arguments->count; f++)
      if (SamIsSameFile(names[k], arguments->files[f]))
        PetscCall(PetscStrncpy(clash, arguments->files[f], sizeof(clash)));
  }
  PetscCallMPI(MPI_Bcast(clash, (PetscMPIInt)sizeof(clash), MPI_CHAR, 0, PETSC_COMM_WORLD));
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(names[k]));
  PetscCheck(!clash[0], PETSC_COMM_WORLD, SAM_ERR_USER, "-output %s: would replace %s, which is read", r->output,
             clash);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRunSetUp(SamStressRun *run, const SamArguments *arguments)
{
  const SamOptions from = {PETSC_COMM_WORLD, NULL};
  PetscBool        help;

  PetscFunctionBegin;
  PetscCall(SamStressRequestRead(&from, &run->request));
  PetscCall(SamOptionsHeading(&from, "Resources"));
  PetscCall(SamFourierSettingsFromOptions(&run->transforms, &from));
  PetscCall(SamOptionsBool(&from, "quiet", "print warnings and errors only", &run->quiet, NULL));
  PetscCall(SamPrintHelp(&help));
  if (help) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckNames(&run->request, arguments));
  PetscCall(SamResultsOpen(PETSC_COMM_WORLD, "input", run->request.input, &run->results));
  PetscCall(SamResultsGetGrid(run->results, &run->grid));
  PetscCall(CheckBodies(run));
  PetscCall(ReadTimes(run));
  PetscCall(CheckDepths(run));
  PetscCall(FindLine(run));
  PetscCall(SamMemoryRefuse(run->grid->comm, Memory(run), "-input", run->request.input, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRunTearDown(SamStressRun *run)
{
  PetscFunctionBegin;
  PetscCall(SamStressFileDestroy(&run->file));
  PetscCall(SamResultsDestroy(&run->results));
  PetscCall(SamStressRequestFree(&run->request));
  PetscCall(PetscFree(run->saved));
  PetscCall(PetscFree(run->times));
  PetscCall(PetscFree2(run->mises, run->principal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- quantities ---- */

/* Some points of a step, whose stresses are s[component][point]; `first`: the number of the first one. */
typedef struct {
  PetscInt      step, count;
  double        first;
  const double *s[SAM_STRESS_COMPONENTS];
} Points;

static void Keep(SamLargest *largest, double value, double point)
{
  if (value > largest->value || (value == largest->value && point < largest->point))
    *largest = (SamLargest){value, point};
}

/*
  Largest von Mises and principal stress. The latter is at most the mean stress and two thirds of the former: few points
  need more than that.
*/
static void FindLargest(SamStressRun *run, const Points *p, const double mises[])
{
  for (PetscInt i = 0; i < p->count; i++) {
    const double mean = (p->s[SAM_STRESS_XX][i] + p->s[SAM_STRESS_YY][i] + p->s[SAM_STRESS_ZZ][i]) / 3;
    double       value[3];
    double      *to[3] = {&value[0], &value[1], &value[2]};

    Keep(&run->mises[p->step], mises[i], p->first + (double)i);
    if (mean + mises[i] * (2. / 3) * (1 + 1e-12) < run->principal[p->step].value) continue;
    SamStressPrincipal(
      1, (const double *[]){&p->s[0][i], &p->s[1][i], &p->s[2][i], &p->s[3][i], &p->s[4][i], &p->s[5][i]}, to);
    Keep(&run->principal[p->step], value[0], p->first + (double)i);
  }
}

/* Writes a component of a quantity: at one depth of all, or at this rank's depths of a section. */
typedef PetscErrorCode (*Writer)(SamStressRun *run, const Points *p, SamQuantity quantity, PetscInt component,
                                 const double values[], const void *context);

/* Computes what is wanted of some points and writes it. */
static PetscErrorCode WriteQuantities(SamStressRun *run, const Points *p, Writer write, const void *context)
{
  const PetscBool *wants    = run->request.wants;
  const PetscBool principal = wants[SAM_QUANTITY_PRINCIPAL] || wants[SAM_QUANTITY_SHEAR_MAX] ? PETSC_TRUE : PETSC_FALSE;
  double         *more[SAM_STRESS_COMPONENTS];
  const PetscInt  arrays = wants[SAM_QUANTITY_STRAIN] ? SAM_STRESS_COMPONENTS : principal ? 3 : 1;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < arrays; k++) PetscCall(SamAllocate(sizeof(double) * (size_t)p->count, &more[k]));
  SamStressMises(p->count, p->s, more[0]);
  FindLargest(run, p, more[0]);
  if (wants[SAM_QUANTITY_MISES]) PetscCall(write(run, p, SAM_QUANTITY_MISES, 0, more[0], context));
  for (PetscInt c = 0; wants[SAM_QUANTITY_STRESS] && c < SAM_STRESS_COMPONENTS; c++)
    PetscCall(write(run, p, SAM_QUANTITY_STRESS, c, p->s[c], context));
  if (principal) {
    SamStressPrincipal(p->count, p->s, more);
    for (PetscInt c = 0; wants[SAM_QUANTITY_PRINCIPAL] && c < 3; c++)
      PetscCall(write(run, p, SAM_QUANTITY_PRINCIPAL, c, more[c], context));
    for (PetscInt i = 0; i < p->count; i++) more[0][i] = 0.5 * (more[0][i] - more[2][i]);
    if (wants[SAM_QUANTITY_SHEAR_MAX]) PetscCall(write(run, p, SAM_QUANTITY_SHEAR_MAX, 0, more[0], context));
  }
  if (wants[SAM_QUANTITY_STRAIN]) {
    SamStressStrain(p->count, run->young, run->poisson, p->s, more);
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++)
      PetscCall(write(run, p, SAM_QUANTITY_STRAIN, c, more[c], context));
  }
  for (PetscInt k = 0; k < arrays; k++) SamFree(more[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- maps ---- */

static PetscErrorCode WriteMap(SamStressRun *run, const Points *p, SamQuantity quantity, PetscInt component,
                               const double values[], const void *context)
{
  PetscFunctionBegin;
  PetscCall(SamStressFileWriteMap(run->file, quantity, component, p->step, *(const PetscInt *)context, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeMap(SamStressRun *run, SamStress stress, PetscInt depth, PetscInt step, Vec field)
{
  const PetscInt cells = run->grid->cells;
  Points         p     = {.step = step, .count = cells};
  double        *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(field, &a));
  PetscCall(SamResultsRead(run->results, run->saved[step], SAM_RESULTS_PRESSURE, a + SAM_STRESS_ZZ * cells));
  PetscCall(SamResultsRead(run->results, run->saved[step], SAM_RESULTS_SHEAR_X, a + SAM_STRESS_XZ * cells));
  PetscCall(SamResultsRead(run->results, run->saved[step], SAM_RESULTS_SHEAR_Y, a + SAM_STRESS_YZ * cells));
  PetscCall(VecRestoreArray(field, &a));
  PetscCall(SamStressApply(stress, field));
  PetscCall(VecGetArrayRead(field, (const PetscScalar **)&a));
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) p.s[c] = a + c * cells;
  p.first = ((double)depth * (double)run->grid->ny + (double)run->grid->row_start) * (double)run->grid->nx;
  PetscCall(WriteQuantities(run, &p, WriteMap, &depth));
  PetscCall(VecRestoreArrayRead(field, (const PetscScalar **)&a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeMaps(SamStressRun *run)
{
  PetscLogDouble start, now;
  SamStress      stress;
  Vec            field;

  PetscFunctionBegin;
  PetscCall(SamStressCreate(run->grid, &run->transforms, run->request.body, run->poisson, &stress));
  PetscCall(SamGridCreateVec(run->grid, SAM_STRESS_COMPONENTS, &field));
  for (PetscInt k = 0; k < run->request.depths; k++) {
    PetscCall(PetscTime(&start));
    PetscCall(SamStressSetDepth(stress, run->request.depth[k]));
    for (PetscInt step = 0; step < run->steps; step++) PetscCall(ComputeMap(run, stress, k, step, field));
    PetscCall(PetscTime(&now));
    if (!run->quiet)
      PetscCall(PetscPrintf(run->grid->comm, "  depth %" PetscInt_FMT " of %" PetscInt_FMT ", %g m: %.2f s\n", k + 1,
                            run->request.depths, (double)run->request.depth[k], now - start));
  }
  PetscCall(VecDestroy(&field));
  PetscCall(SamStressDestroy(&stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- sections ---- */

static PetscErrorCode WriteSection(SamStressRun *run, const Points *p, SamQuantity quantity, PetscInt component,
                                   const double values[], const void *context)
{
  const PetscInt *own = (const PetscInt *)context; /* first depth, number of depths */

  PetscFunctionBegin;
  PetscCall(SamStressFileWriteSection(run->file, quantity, component, p->step, own[0], own[1], values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddStep(SamStressRun *run, SamSection section, PetscInt step, Vec tractions)
{
  static const SamResultsField fields[] = {SAM_RESULTS_PRESSURE, SAM_RESULTS_SHEAR_X, SAM_RESULTS_SHEAR_Y};
  double                      *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(tractions, &a));
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++)
    PetscCall(SamResultsRead(run->results, run->saved[step], fields[t], a + t * run->grid->cells));
  PetscCall(VecRestoreArray(tractions, &a));
  PetscCall(SamSectionAddStep(section, tractions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stresses of steps first ... first + count - 1. */
static PetscErrorCode ComputeSteps(SamStressRun *run, SamSection section, PetscInt first, PetscInt count, Vec tractions)
{
  PetscInt own[2], length;
  double  *stress;

  PetscFunctionBegin;
  PetscCall(SamSectionGetDepths(section, &own[0], &own[1], &length));
  PetscCall(SamAllocate(sizeof(double) * (size_t)(count * SAM_STRESS_COMPONENTS) * (size_t)(own[1] * length), &stress));
  for (PetscInt k = 0; k < count; k++) PetscCall(AddStep(run, section, first + k, tractions));
  PetscCall(SamSectionCompute(section, stress));
  for (PetscInt k = 0; k < count; k++) {
    Points p = {.step = first + k, .count = own[1] * length, .first = (double)own[0] * (double)length};

    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++)
      p.s[c] = stress + (k * SAM_STRESS_COMPONENTS + c) * (ptrdiff_t)p.count;
    PetscCall(WriteQuantities(run, &p, WriteSection, own));
  }
  SamFree(stress);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeSection(SamStressRun *run)
{
  const PetscInt batch = Batch(run);
  PetscLogDouble start, now;
  SamSection     section;
  Vec            tractions;

  PetscFunctionBegin;
  PetscCall(SamSectionCreate(run->grid, run->request.body, run->poisson, run->request.axis, run->index,
                             run->request.depths, run->request.depth, &section));
  PetscCall(SamGridCreateVec(run->grid, SAM_STRESS_TRACTIONS, &tractions));
  for (PetscInt first = 0; first < run->steps; first += batch) {
    const PetscInt count = PetscMin(batch, run->steps - first);

    PetscCall(PetscTime(&start));
    PetscCall(ComputeSteps(run, section, first, count, tractions));
    PetscCall(PetscTime(&now));
    if (!run->quiet)
      PetscCall(PetscPrintf(run->grid->comm, "  step %" PetscInt_FMT " of %" PetscInt_FMT ": %.2f s\n", first + count,
                            run->steps, now - start));
  }
  PetscCall(VecDestroy(&tractions));
  PetscCall(SamSectionDestroy(&section));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the file ---- */

static PetscErrorCode CreateFile(SamStressRun *run)
{
  SamStressLayout layout     = {.steps   = run->steps,
                                .depths  = run->request.depths,
                                .times   = run->times,
                                .depth   = run->request.depth,
                                .section = run->request.section,
                                .axis    = run->request.axis,
                                .index   = run->index};
  SamParameters   parameters = {.count = 0};
  const PetscReal body       = (PetscReal)run->request.body;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(layout.wants, run->request.wants, SAM_QUANTITIES));
  PetscCall(SamParametersAddReals(&parameters, "body", PETSC_TRUE, 1, &body));
  PetscCall(SamParametersAddReals(&parameters, "young", PETSC_TRUE, 1, &run->young));
  PetscCall(SamParametersAddReals(&parameters, "poisson", PETSC_TRUE, 1, &run->poisson));
  PetscCall(SamStressFileCreate(run->grid, run->request.output, &layout, &parameters, &run->file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest of all ranks, of equal ones that with the lowest number. */
static PetscErrorCode Agree(MPI_Comm comm, SamLargest *largest)
{
  PetscReal most = largest->value, place;

  PetscFunctionBegin;
  PetscCall(SamMax(comm, 1, &most));
  place = largest->value == most ? -largest->point : -PETSC_INFINITY;
  PetscCall(SamMax(comm, 1, &place));
  *largest = (SamLargest){most, -place};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the largest values of each step and their places: name_max, name_max_x, name_max_y, name_max_z. */
static PetscErrorCode WriteLargest(SamStressRun *run, const char name[], const char words[], SamLargest largest[])
{
  const SamGrid   g           = run->grid;
  const PetscBool row         = run->request.section && run->request.axis == SAM_SECTION_X ? PETSC_TRUE : PETSC_FALSE,
                  column      = run->request.section && run->request.axis == SAM_SECTION_Y ? PETSC_TRUE : PETSC_FALSE;
  const double             nx = column ? 1 : (double)g->nx, ny = row ? 1 : (double)g->ny;
  static const char *const endings[] = {"max", "max_x", "max_y", "max_z"};
  double                  *values[4];

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) PetscCall(PetscMalloc1(run->steps, &values[k]));
  for (PetscInt s = 0; s < run->steps; s++) {
    double plane, i, j;

    PetscCall(Agree(g->comm, &largest[s]));
    plane        = floor(largest[s].point / (nx * ny));
    j            = floor((largest[s].point - plane * nx * ny) / nx);
    i            = largest[s].point - (plane * ny + j) * nx;
    values[0][s] = largest[s].value;
    values[1][s] = (double)SamGridX(g, column ? run->index : (PetscInt)i);
    values[2][s] = (double)SamGridY(g, row ? run->index : (PetscInt)j);
    values[3][s] = (double)run->request.depth[(PetscInt)plane];
  }
  for (int k = 0; k < 4; k++) {
    char dataset[64], text[128];

    PetscCall(PetscSNPrintf(dataset, sizeof(dataset), "%s_%s", name, endings[k]));
    if (k)
      PetscCall(PetscSNPrintf(text, sizeof(text), "%c of the %s", "xyz"[k - 1], words));
    else
      PetscCall(PetscStrncpy(text, words, sizeof(text)));
    PetscCall(SamStressFileSetHistory(run->file, dataset, k ? "m" : "Pa", text, values[k]));
    PetscCall(PetscFree(values[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintBanner(SamStressRun *run)
{
  const SamGrid g = run->grid;
  PetscMPIInt   ranks;

  PetscFunctionBegin;
  if (run->quiet) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(g->comm, &ranks));
  PetscCall(PetscPrintf(g->comm,
                        "petsam-stress " PETSAM_VERSION ": stresses in body %" PetscInt_FMT "\n"
                        "  results     %s, %" PetscInt_FMT " x %" PetscInt_FMT " cells\n"
                        "  steps       %" PetscInt_FMT ", depths %" PetscInt_FMT ", %s\n"
                        "  ranks       %d, memory about %.3g MB a rank\n\n",
                        run->request.body, run->request.input, g->nx, g->ny, run->steps, run->request.depths,
                        run->request.section ? "on a section" : "maps", ranks, 1e-6 * Memory(run)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintLargest(SamStressRun *run)
{
  const SamLargest *best = &run->mises[0];
  PetscInt          step = 0, load;

  PetscFunctionBegin;
  for (PetscInt s = 1; s < run->steps; s++)
    if (run->mises[s].value > best->value) best = &run->mises[step = s];
  PetscCall(SamResultsGetSaved(run->results, run->saved[step], &load, NULL));
  if (!run->quiet)
    PetscCall(PetscPrintf(run->grid->comm,
                          "\n  largest von Mises stress %.6g Pa, in step %" PetscInt_FMT "\n  written     %s\n",
                          best->value, load, run->request.output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRunCompute(SamStressRun *run)
{
  PetscFunctionBegin;
  PetscCall(PrintBanner(run));
  run->writing = PETSC_TRUE;
  PetscCall(CreateFile(run));
  if (run->request.section)
    PetscCall(ComputeSection(run));
  else
    PetscCall(ComputeMaps(run));
  PetscCall(WriteLargest(run, "mises", "largest von Mises stress", run->mises));
  PetscCall(WriteLargest(run, "principal_1", "largest principal stress", run->principal));
  PetscCall(SamStressFileFinish(run->file));
  run->writing = PETSC_FALSE;
  PetscCall(PrintLargest(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}
