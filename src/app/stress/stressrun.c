/* The run of petsam-stress: from tractions in a results file to stresses in a file of their own. */
#include "stressrun.h"
#include "../files.h"
#include "../memory.h"
#include <petsam/private/baseimpl.h>
#include <petsctime.h>

/* A line of progress follows the one before after so many seconds, or such a part of the time spent. */
#define TELL_SECONDS 1.0
#define TELL_PART    0.05
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
  const PetscBool row   = run->request.axis == SAM_SECTION_X;
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

/* Times and bulk stresses of the steps. */
static PetscErrorCode ReadSteps(SamStressRun *run)
{
  PetscFunctionBegin;
  PetscCall(SamStressRequestSteps(&run->request, run->results, &run->steps, &run->saved));
  PetscCall(PetscMalloc1(run->steps, &run->times));
  PetscCall(PetscMalloc3(run->steps, &run->mises, run->steps, &run->principal, run->steps, &run->bulk));
  PetscCall(PetscMalloc2(run->steps, &run->edge_xx, run->steps, &run->edge_principal));
  PetscCall(PetscCalloc1(run->steps, &run->edge_left));
  for (PetscInt k = 0; k < run->steps; k++) {
    PetscInt step;

    PetscCall(SamResultsGetSaved(run->results, run->saved[k], &step, &run->times[k]));
    PetscCall(SamResultsReadBulkStress(run->results, step, run->request.body - 1, run->bulk[k]));
    run->mises[k] = run->principal[k] = (SamLargest){-INFINITY, 0};
    run->edge_xx[k] = run->edge_principal[k] = (SamEdgeLargest){-INFINITY, 0, 0};
  }
  for (PetscInt q = 0; q < SAM_QUANTITIES; q++) run->fatigue[q] = (SamLargest){-INFINITY, 0};
  PetscCheck(run->steps > 1 || !SamCycleWanted(run), run->grid->comm, SAM_ERR_USER,
             "-steps: -fatigue needs the steps of a cycle, two at least: -steps all, or first:last");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double Memory(const SamStressRun *run)
{
  return run->request.section ? SamLinesMemory(run) : SamMapsMemory(run);
}

/* The output, its XDMF file and its temporary file must not replace a file that is read. */
static PetscErrorCode CheckFiles(const SamStressRequest *r, const SamArguments *arguments)
{
  SamFiles       files = {.count = 0};
  char          *xdmf, *temporary;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(SamOutputNames(r->output, &xdmf, &temporary));
  PetscCall(SamFilesAdd(&files, SAM_FILE_READ_ONLY, "-input", r->input, PETSC_FALSE));
  PetscCall(SamFilesAdd(&files, SAM_FILE_WRITTEN, "-output", r->output, PETSC_FALSE));
  PetscCall(SamFilesAdd(&files, SAM_FILE_WRITTEN, "-output", xdmf, PETSC_TRUE));
  PetscCall(SamFilesAdd(&files, SAM_FILE_WRITTEN, "-output", temporary, PETSC_TRUE));
  PetscCall(PetscFree(xdmf));
  PetscCall(PetscFree(temporary));
  ierr = SamFilesCheck(&files, PETSC_COMM_WORLD, arguments);
  PetscCall(SamFilesFree(&files));
  PetscCall(ierr);
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
  if (help) PetscCall(SamMemoryRefuse(PETSC_COMM_WORLD, 0, "", "", &from)); /* for its option */
  if (help) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckFiles(&run->request, arguments));
  PetscCall(SamResultsOpen(PETSC_COMM_WORLD, "input", run->request.input, &run->results));
  PetscCall(SamResultsGetGrid(run->results, &run->grid));
  PetscCall(CheckBodies(run));
  PetscCall(ReadSteps(run));
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
  PetscCall(PetscFree3(run->mises, run->principal, run->bulk));
  PetscCall(PetscFree2(run->edge_xx, run->edge_principal));
  PetscCall(PetscFree(run->edge_left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- progress ---- */

PetscErrorCode SamStressRunTell(SamStressRun *run, const char work[], double part, double whole)
{
  PetscLogDouble now, spent;

  PetscFunctionBegin;
  PetscCall(PetscTime(&now));
  spent = now - run->start;
  if (run->quiet || now - run->told < PetscMax(TELL_SECONDS, TELL_PART * spent)) PetscFunctionReturn(PETSC_SUCCESS);
  run->told = now;
  PetscCall(PetscPrintf(run->grid->comm, "  %-24s%5.1f %%  %.1f s", work, 100 * part, spent));
  if (whole > 0) PetscCall(PetscPrintf(run->grid->comm, ", %.1f s left", spent * (1 - whole) / whole));
  PetscCall(PetscPrintf(run->grid->comm, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the file ---- */

/* The constants of the fatigue parameters that are asked for. */
static PetscErrorCode AddConstants(const SamStressRun *run, SamParameters *p)
{
  const SamFatigueConstants *c     = &run->request.constants;
  const PetscBool           *wants = run->request.wants;

  PetscFunctionBegin;
  if (wants[SAM_QUANTITY_CROSSLAND])
    PetscCall(SamParametersAddReals(p, "fatigue_crossland_alpha", PETSC_TRUE, 1, &c->crossland_alpha));
  if (wants[SAM_QUANTITY_DANG_VAN])
    PetscCall(SamParametersAddReals(p, "fatigue_dang_van_alpha", PETSC_TRUE, 1, &c->dang_van_alpha));
  if (wants[SAM_QUANTITY_FINDLEY])
    PetscCall(SamParametersAddReals(p, "fatigue_findley_k", PETSC_TRUE, 1, &c->findley_k));
  if (!wants[SAM_QUANTITY_FATEMI_SOCIE]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamParametersAddReals(p, "fatigue_fatemi_socie_k", PETSC_TRUE, 1, &c->fatemi_socie_k));
  PetscCall(SamParametersAddReals(p, "fatigue_yield", PETSC_TRUE, 1, &c->yield));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
  const char     *of_run;
  char           *options;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(layout.wants, run->request.wants, SAM_QUANTITIES));
  PetscCall(SamParametersAddReals(&parameters, "body", PETSC_TRUE, 1, &body));
  PetscCall(SamParametersAddReals(&parameters, "young", PETSC_TRUE, 1, &run->young));
  PetscCall(SamParametersAddReals(&parameters, "poisson", PETSC_TRUE, 1, &run->poisson));
  PetscCall(AddConstants(run, &parameters));
  PetscCall(SamStressFileCreate(run->grid, run->request.output, &layout, &parameters, &run->file));
  PetscCall(SamStressFileSetText(run->file, "input", run->request.input));
  PetscCall(PetscOptionsGetAll(NULL, &options));
  PetscCall(SamStressFileSetText(run->file, "options", options));
  PetscCall(PetscFree(options));
  PetscCall(SamResultsGetOptions(run->results, &of_run));
  PetscCall(SamStressFileSetText(run->file, "input_options", of_run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The numbers of the load steps, as petsam counts them. */
static PetscErrorCode WriteStepNumbers(SamStressRun *run)
{
  double *numbers;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(run->steps, &numbers));
  for (PetscInt k = 0; k < run->steps; k++) {
    PetscInt step;

    PetscCall(SamResultsGetSaved(run->results, run->saved[k], &step, NULL));
    numbers[k] = (double)step;
  }
  PetscCall(SamStressFileSetHistory(run->file, "step", "1", "number of the load step, from 1", numbers));
  PetscCall(PetscFree(numbers));
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

/* The coordinates of a point, m. */
static void GetPlace(const SamStressRun *run, double point, double place[3])
{
  const SamGrid   g       = run->grid;
  const PetscBool section = run->request.section, row = section && run->request.axis == SAM_SECTION_X,
                  column = section && run->request.axis == SAM_SECTION_Y;
  const double nx = column ? 1 : (double)g->nx, ny = row ? 1 : (double)g->ny;
  const double plane = floor(point / (nx * ny)), j = floor((point - plane * nx * ny) / nx);
  const double i = point - (plane * ny + j) * nx;

  place[0] = (double)SamGridX(g, column ? run->index : (PetscInt)i);
  place[1] = (double)SamGridY(g, row ? run->index : (PetscInt)j);
  place[2] = (double)run->request.depth[(PetscInt)plane];
}

/* Writes the largest values of each step and their places: name_max, name_max_x, name_max_y, name_max_z. */
static PetscErrorCode WriteLargest(SamStressRun *run, const char name[], const char words[], SamLargest largest[])
{
  static const char *const endings[] = {"max", "max_x", "max_y", "max_z"};
  double                  *values[4];

  PetscFunctionBegin;
  for (int k = 0; k < 4; k++) PetscCall(PetscMalloc1(run->steps, &values[k]));
  for (PetscInt s = 0; s < run->steps; s++) {
    double place[3];

    PetscCall(Agree(run->grid->comm, &largest[s]));
    GetPlace(run, largest[s].point, place);
    values[0][s] = largest[s].value;
    for (int k = 0; k < 3; k++) values[k + 1][s] = place[k];
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

/* The same of the fatigue parameters. */
static PetscErrorCode WriteLargestOfCycle(SamStressRun *run)
{
  double place[3];

  PetscFunctionBegin;
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) {
    if (!run->request.wants[q]) continue;
    PetscCall(Agree(run->grid->comm, &run->fatigue[q]));
    GetPlace(run, run->fatigue[q].point, place);
    PetscCall(SamStressFileSetLargest(run->file, (SamQuantity)q, run->fatigue[q].value, place));
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
  static const char *const        names[] = {"Crossland", "Dang Van", "Findley", "SWT", "Fatemi-Socie", "Ruiz 1"},
                           *const units[] = {" Pa", " Pa", " Pa", " Pa", "", " J/m2"};
  PetscInt                        step    = 0, load;
  double                          at[3];

  PetscFunctionBegin;
  for (PetscInt s = 1; s < run->steps; s++)
    if (run->mises[s].value > run->mises[step].value) step = s;
  PetscCall(SamResultsGetSaved(run->results, run->saved[step], &load, NULL));
  GetPlace(run, run->mises[step].point, at);
  if (!run->quiet)
    PetscCall(PetscPrintf(run->grid->comm,
                          "  largest     von Mises stress %.6g Pa at (%.4g, %.4g, %.4g) m in step %" PetscInt_FMT "\n",
                          run->mises[step].value, at[0], at[1], at[2], load));
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) {
    if (!run->request.wants[q] || run->quiet) continue;
    GetPlace(run, run->fatigue[q].point, at);
    PetscCall(PetscPrintf(run->grid->comm, "              %s %.6g%s at (%.4g, %.4g, %.4g) m\n",
                          names[q - SAM_QUANTITY_CROSSLAND], run->fatigue[q].value, units[q - SAM_QUANTITY_CROSSLAND],
                          at[0], at[1], at[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRunCompute(SamStressRun *run)
{
  PetscLogDouble end;

  PetscFunctionBegin;
  PetscCall(PrintBanner(run));
  PetscCall(PetscTime(&run->start));
  run->told    = run->start;
  run->writing = PETSC_TRUE;
  PetscCall(CreateFile(run));
  if (SamCycleWanted(run)) PetscCall(SamCycleCheckClosed(run));
  PetscCall(run->request.section ? SamLinesCompute(run) : SamMapsCompute(run));
  PetscCall(WriteStepNumbers(run));
  PetscCall(WriteLargest(run, "mises", "largest von Mises stress", run->mises));
  PetscCall(WriteLargest(run, "principal_1", "largest principal stress", run->principal));
  PetscCall(SamEdgeStressWrite(run));
  PetscCall(WriteLargestOfCycle(run));
  PetscCall(SamStressFileFinish(run->file));
  run->writing = PETSC_FALSE;
  PetscCall(PetscTime(&end));
  PetscCall(PrintLargest(run));
  if (!run->quiet)
    PetscCall(
      PetscPrintf(run->grid->comm, "  time        %.2f s\n  written     %s\n", end - run->start, run->request.output));
  PetscFunctionReturn(PETSC_SUCCESS);
}
