/* A contact and its parts, created from options: code shared by the programs and embedded contacts. */
#include <petsam/private/elasticity.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/setup.h>
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/gap.h>
#include <petsam/private/law.h>
#include <petsam/private/parameters.h>
#include <petsam/private/problem.h>
#include <math.h>
#include <string.h>

/* Creates the elasticity and the laws on the grid. */
static PetscErrorCode CreateProblem(SamSetup *s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamElasticityCreate(s->grid, s->pair, &s->elasticity));
  PetscCall(SamElasticitySetOptionsPrefix(s->elasticity, from->prefix));
  PetscCall(SamElasticitySetFromOptions(s->elasticity));
  PetscCall(SamElasticityAddFromOptions(&s->elasticity, from));
  PetscCall(SamMotionSetFromOptions(from, &s->elasticity));
  PetscCall(SamProblemCreate(s->elasticity, &s->problem));
  PetscCall(SamProblemSetLawsFromOptions(s->problem, from));
  s->conditions = SamProblemGetConditions(s->problem);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupReadOptions(SamSetup *s, const SamOptions *from)
{
  PetscInt  n[2];
  PetscReal width[2], center[2];
  PetscBool plane;

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(SamOptionsPlugins(from));
  PetscCall(SamGapCreate(from->comm, &s->gap));
  PetscCall(SamGapSetOptionsPrefix(s->gap, from->prefix));
  PetscCall(SamGapGetFileGrid(s->gap, n, width, center));
  PetscCall(SamElasticityPlaneFromOptions(from, &plane));
  PetscCall(SamGridCreateFromOptions(from, plane, n, width, center, &s->grid));
  PetscCall(SamPairCreateFromOptions(from, &s->pair));
  PetscCall(SamPairCheckInitialStress(s->pair, from, 2 * s->grid->length));
  PetscCall(CreateProblem(s, from));
  PetscCall(SamGapSetFromOptions(s->gap));
  if (plane && !SamPrintHelp()) PetscCall(SamGapCheckPlane(s->gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the contact, which reads its options. */
static PetscErrorCode CreateContact(SamSetup *s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamContactCreate(s->problem, &s->contact));
  PetscCall(SamContactSetOptionsPrefix(s->contact, from->prefix));
  PetscCall(SamContactSetFromOptions(s->contact));
  if (!SamPrintHelp()) PetscCall(SamContactSetUp(s->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupCreateContact(SamSetup *s, const SamOptions *from)
{
  PetscFunctionBegin;
  if (!SamPrintHelp()) PetscCall(SamGapFill(s->gap, s->grid, SamProblemGetGap(s->problem)));
  PetscCall(SamProblemSetQuadratic(s->problem, SamGapIsQuadratic(s->gap)));
  PetscCall(CreateContact(s, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupSetGap(const SamSetup *s, Vec gap)
{
  PetscFunctionBegin;
  PetscCall(SamProblemSetGap(s->problem, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupSetFriction(const SamSetup *s, Vec friction)
{
  PetscFunctionBegin;
  PetscCall(SamProblemSetFrictionField(s->problem, friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupSetStart(const SamSetup *s, PetscReal friction)
{
  PetscFunctionBegin;
  PetscCall(SamProblemSetFriction(s->problem, friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupFindNeeds(const SamSetup *s, PetscBool *friction, PetscInt *laws)
{
  PetscFunctionBegin;
  PetscCall(SamProblemHasFriction(s->problem, friction));
  *laws = SamProblemGetBytes(s->problem);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Averages a field over the cells of a grid that SamGridCoarsen() has made of that of the field, once or repeatedly. */
static PetscErrorCode Average(SamGrid from, Vec fine, SamGrid to, Vec coarse)
{
  SamTransfer transfer;
  Vec         between = NULL;

  PetscFunctionBegin;
  if (to->fine != from) {
    PetscCall(SamGridCreateVec(to->fine, 1, &between));
    PetscCall(Average(from, fine, to->fine, between));
  }
  PetscCall(SamTransferCreate(to->fine, to, &transfer));
  PetscCall(SamTransferRestrict(transfer, between ? between : fine, coarse));
  PetscCall(SamTransferDestroy(&transfer));
  PetscCall(VecDestroy(&between));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupAverage(const SamSetup *s, Vec fine, const SamSetup *coarse, Vec means)
{
  PetscFunctionBegin;
  PetscCall(Average(s->grid, fine, coarse->grid, means));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Halves the cells of a grid so many times, at least once. */
static PetscErrorCode Halve(SamGrid grid, PetscInt times, SamGrid *coarse)
{
  SamGrid half;

  PetscFunctionBegin;
  PetscCall(SamGridCoarsen(grid, coarse));
  if (times < 2) PetscFunctionReturn(PETSC_SUCCESS);
  half = *coarse;
  PetscCall(Halve(half, times - 1, coarse));
  PetscCall(SamGridDestroy(&half)); /* the coarser one refers to it */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupCreateCoarse(const SamSetup *s, PetscInt halvings, const SamOptions *from, SamSetup *coarse)
{
  Vec gap;

  PetscFunctionBegin;
  PetscCall(SamPairReference(s->pair));
  *coarse = (SamSetup){.pair = s->pair};
  PetscCall(Halve(s->grid, halvings, &coarse->grid));
  PetscCall(CreateProblem(coarse, from));
  gap = SamProblemGetGap(coarse->problem);
  if (SamGapHasFile(s->gap)) {
    PetscCall(Average(s->grid, SamProblemGetGap(s->problem), coarse->grid, gap));
  } else {
    PetscCall(SamGapFill(s->gap, coarse->grid, gap));
  }
  PetscCall(SamProblemSetQuadratic(coarse->problem, SamGapIsQuadratic(s->gap)));
  PetscCall(CreateContact(coarse, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupDestroy(SamSetup *s)
{
  PetscFunctionBegin;
  PetscCall(SamContactDestroy(&s->contact));
  PetscCall(SamProblemDestroy(&s->problem));
  PetscCall(SamElasticityDestroy(&s->elasticity));
  PetscCall(SamPairDestroy(&s->pair));
  PetscCall(SamGapDestroy(&s->gap));
  PetscCall(SamGridDestroy(&s->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- parameters ---- */

static PetscErrorCode AddGrid(SamParameters *p, SamGrid grid)
{
  const PetscReal n[2] = {(PetscReal)grid->nx, (PetscReal)grid->ny};

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "grid_n", PETSC_TRUE, 2, n));
  PetscCall(SamParametersAddReals(p, "grid_size", PETSC_TRUE, 2, grid->width));
  PetscCall(SamParametersAddReals(p, "grid_center", PETSC_TRUE, 2, grid->center));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the gap to the parameters; heights from a file as a checksum, since the file may change under the same name. */
static PetscErrorCode AddGap(const SamSetup *s, SamParameters *p)
{
  static const char *const files[] = {"gap_file", "gap_rough_file"};

  SamGapType         type;
  PetscInt           count;
  const char *const *names;
  const PetscReal   *values;
  uint64_t           checksum;

  PetscFunctionBegin;
  PetscCall(SamGapGetParameters(s->gap, &type, &count, &names, &values));
  PetscCall(SamParametersAddText(p, "gap_type", PETSC_TRUE, type));
  for (PetscInt k = 0; k < count; k++) PetscCall(SamParametersAddReals(p, names[k], PETSC_TRUE, 1, &values[k]));
  for (PetscInt k = 0; k < 2; k++) {
    if (SamGapIsFromFile(s->gap, k ? PETSC_TRUE : PETSC_FALSE)) {
      PetscCall(SamGridChecksum(s->grid, SamProblemGetGap(s->problem), &checksum));
      PetscCall(SamParametersAddChecksum(p, files[k], checksum));
    } else {
      PetscCall(SamParametersAddText(p, files[k], PETSC_TRUE, "none"));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupAddParameters(const SamSetup *s, SamParameters *p)
{
  const SamLaw *laws;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(AddGrid(p, s->grid));
  PetscCall(SamElasticityAddParameters(s->elasticity, p));
  PetscCall(SamProblemGetLaws(s->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++) PetscCall(SamLawAddParameters(laws[k], p));
  PetscCall(AddGap(s, p));
  PetscCall(
    SamParametersAddText(p, "coupling", PETSC_TRUE, SamContactGetSettings(s->contact).coupling ? "full" : "none"));
  PetscCall(SamParametersAddText(p, "rolling", PETSC_TRUE, SamMotionOf(s->elasticity)->word));
  PetscFunctionReturn(PETSC_SUCCESS);
}
