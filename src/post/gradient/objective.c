/* Numbers of a load history that have a gradient: what a step adds to them, and their derivatives. */
#include "gradientimpl.h"
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>

#define NORM 8 /* power of the norm of the pressure */

static SamObjective list[SAM_OBJECTIVES];
static PetscInt     listed  = 0;
static PetscBool    has_own = PETSC_FALSE; /* the objectives below are in the list */

/* ---- the numbers ---- */

static PetscBool IsOf(const SamBackStep *at)
{
  return at->step >= at->first && at->step <= at->last ? PETSC_TRUE : PETSC_FALSE;
}

/* Frictional work of the steps. */
static PetscErrorCode AddEnergy(SamBackStep *at)
{
  const SamGrid g = at->grid;
  double       *factor;

  PetscFunctionBegin;
  if (!IsOf(at)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(g->cells, &factor));
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) {
      factor[k] = at->area * at->friction[k];
      row += factor[k] * at->rubbed[k];
      at->by_friction[k] += at->area * at->rubbed[k];
    }
    SamAdd(&at->value, row);
  }
  PetscCall(SamBackAddRubbed(at, factor));
  PetscCall(PetscFree(factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckVolume(SamProblem problem, const char name[])
{
  PetscFunctionBegin;
  PetscCheck(SamProblemWears(problem), SamProblemGetGrid(problem)->comm, SAM_ERR_USER,
             "the gradient of %s: the contact has no coefficient of wear: give -wear_coefficient1 or another", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Volume that both bodies have lost after the last of the steps. */
static PetscErrorCode AddVolume(SamBackStep *at)
{
  PetscFunctionBegin;
  if (at->step != at->last) PetscFunctionReturn(PETSC_SUCCESS);
  at->number = (double)at->volume;
  for (PetscInt k = 0; k < at->grid->cells; k++) at->by_worn[k] += at->area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (sum p^r dA)^(1/r) of the last of the steps. */
static PetscErrorCode AddNorm(SamBackStep *at)
{
  const SamGrid g     = at->grid;
  SamTotal      total = {0};
  double        most  = 0, sum, size;

  PetscFunctionBegin;
  if (at->step != at->last) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < g->cells; k++) most = PetscMax(most, at->pressure[k]);
  PetscCall(SamMax(g->comm, 1, &most));
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) row += pow(at->pressure[k] / most, NORM);
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(g->comm, 1, &total, &sum));
  PetscCheck(most > 0, g->comm, SAM_ERR_USER, "the gradient of pressure_norm: there is no contact in that step");
  size       = pow(sum * at->area, 1.0 / NORM);
  at->number = most * size;
  for (PetscInt k = 0; k < g->cells; k++) at->by_pressure[k] += pow(at->pressure[k] / at->number, NORM - 1) * at->area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the derivatives of a load by pressure and shear at a place, per area. */
static void SetUnit(PetscInt component, double x, double y, double unit[3])
{
  (void)PetscArrayzero(unit, 3);
  if (component == SAM_COMPONENT_N) unit[0] = 1;
  if (component == SAM_COMPONENT_MX) unit[0] = -y;
  if (component == SAM_COMPONENT_MY) unit[0] = x;
  if (component == SAM_COMPONENT_TX) unit[1] = 1;
  if (component == SAM_COMPONENT_TY) unit[2] = 1;
  if (component == SAM_COMPONENT_MZ) {
    unit[1] = -y;
    unit[2] = x;
  }
}

void SamBackAddLoad(SamGrid g, PetscInt component, double factor, double by_pressure[], double by_shear[])
{
  for (PetscInt j = 0; j < g->rows; j++)
    for (PetscInt i = 0; i < g->nx; i++) {
      const PetscInt k = j * g->nx + i;
      double         unit[3];

      SetUnit(component, (double)SamGridX(g, i), (double)SamGridY(g, g->row_start + j), unit);
      by_pressure[k] += factor * unit[0];
      by_shear[k] += factor * unit[1];
      by_shear[k + g->cells] += factor * unit[2];
    }
}

/* A load that is found, summed over the steps. */
static PetscErrorCode AddLoad(SamBackStep *at)
{
  const SamGrid g = at->grid;

  PetscFunctionBegin;
  for (PetscInt j = 0; IsOf(at) && j < g->rows; j++) {
    double row = 0;

    for (PetscInt i = 0; i < g->nx; i++) {
      const PetscInt k = j * g->nx + i;
      double         unit[3];

      SetUnit(at->component, (double)SamGridX(g, i), (double)SamGridY(g, g->row_start + j), unit);
      row += at->area * (unit[0] * at->pressure[k] + unit[1] * at->shear[k] + unit[2] * at->shear[k + g->cells]);
    }
    SamAdd(&at->value, row);
  }
  if (IsOf(at)) SamBackAddLoad(g, at->component, at->area, at->by_pressure, at->by_shear);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A displacement that is found, summed over the steps. */
static PetscErrorCode AddRigid(SamBackStep *at)
{
  PetscFunctionBegin;
  if (!IsOf(at)) PetscFunctionReturn(PETSC_SUCCESS);
  at->by_rigid[at->component] += 1;
  if (at->grid->row_start == 0 && at->grid->rows > 0) SamAdd(&at->value, (double)at->rigid[at->component]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the list ---- */

static PetscErrorCode RegisterAll(void);

PetscErrorCode SamObjectiveRegister(const SamObjective *objective)
{
  PetscInt k = 0;

  PetscFunctionBegin;
  SamValidPointer(objective, 1);
  if (!has_own) PetscCall(RegisterAll());
  while (k < listed && strcmp(list[k].name, objective->name)) k++;
  PetscCheck(k < SAM_OBJECTIVES, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "objective %s: expected at most %d",
             objective->name, SAM_OBJECTIVES);
  list[k] = *objective;
  listed  = PetscMax(listed, k + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RegisterAll(void)
{
  const SamObjective own[] = {
    {.name = "energy", .unit = "J", .number = "dissipated_energy", .all = PETSC_TRUE, .add = AddEnergy},
    {.name = "wear_volume", .unit = "m3", .add = AddVolume, .check = CheckVolume},
    {.name = "pressure_norm", .unit = "Pa m^(1/4)", .unit_of_row = "Pa m^(1/8)", .add = AddNorm}};
  SamObjective one;

  PetscFunctionBegin;
  has_own = PETSC_TRUE;
  for (size_t k = 0; k < sizeof(own) / sizeof(own[0]); k++) PetscCall(SamObjectiveRegister(&own[k]));
  PetscCall(SamObjectiveRegisterStresses());
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    one = (SamObjective){.name = SamComponentNames[c].load, .unit = SamComponentNames[c].load_unit, .add = AddLoad};
    PetscCall(SamObjectiveRegister(&one));
    one = (SamObjective){.name = SamComponentNames[c].rigid, .unit = SamComponentNames[c].rigid_unit, .add = AddRigid};
    PetscCall(SamObjectiveRegister(&one));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes why a number of steps has no derivative, if it is one of those that users may expect to have one. */
static const char *WhyNot(const char name[])
{
  const size_t length = strlen(name);

  if (length > 4 && !strcmp(name + length - 4, "area")) return ": it is a count of cells, piecewise constant";
  if (length > 4 && !strcmp(name + length - 4, "_max")) return ": a maximum over cells has kinks; take pressure_norm";
  if (!strncmp(name, "stiffness", 9))
    return ": that of frozen sets of cells is piecewise constant; take the difference of a displacement in two "
           "steps";
  return "";
}

PetscErrorCode SamGradientFind(MPI_Comm comm, const char name[], SamGradientGoal *goal)
{
  const size_t length     = strcspn(name, "@");
  char         names[512] = "";
  size_t       used       = 0;

  PetscFunctionBegin;
  if (!has_own) PetscCall(RegisterAll());
  *goal = (SamGradientGoal){.name = name, .component = -1};
  for (PetscInt k = 0; k < listed; k++) {
    const PetscBool is =
      strlen(list[k].name) == length && !strncmp(list[k].name, name, length) && (list[k].suffix || !name[length]);

    if (is) goal->objective = &list[k];
    used += (size_t)snprintf(names + used, sizeof(names) - used, "%s%s%s", k ? ", " : "", list[k].name,
                             list[k].suffix ? "@DEPTH" : "");
    used = PetscMin(used, sizeof(names) - 1);
  }
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    const PetscBool load = strcmp(name, SamComponentNames[c].load) ? PETSC_FALSE : PETSC_TRUE;

    if (!load && strcmp(name, SamComponentNames[c].rigid)) continue;
    goal->component = c;
    goal->load      = load;
  }
  PetscCheck(goal->objective, comm, SAM_ERR_USER, "the gradient of %s%s: expected %s", name, WhyNot(name), names);
  PetscFunctionReturn(PETSC_SUCCESS);
}
