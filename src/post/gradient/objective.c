/* Numbers of a load history that have a gradient: what a step adds to them, and their derivatives. */
#include "gradientimpl.h"
#include <math.h>

#define NORM 8 /* power of the norm of the pressure */

static SamObjective list[SAM_OBJECTIVES];
static PetscInt     listed  = 0;
static PetscBool    has_own = PETSC_FALSE; /* the objectives below are in the list */

/* ---- friction ---- */

/* Returns the weights of the pressures before and after the step in what a cell slips against. */
static void GetShares(const SamObjectiveStep *at, PetscInt k, double *before, double *after)
{
  const double share = at->share[k];

  /* outside of the recorded cells the share is 0, and so are pressure and slip */
  *before = share > 0 ? share : 0;
  *after  = share < 0 ? 0 : 1 - *before;
}

void SamBackRubbed(const SamObjectiveStep *at, double rubbed[])
{
  for (PetscInt k = 0; k < at->grid->cells; k++) {
    double before, after;

    GetShares(at, k, &before, &after);
    rubbed[k] =
      (before * at->pressure_before[k] + after * at->pressure[k]) * hypot(at->slip[k], at->slip[k + at->grid->cells]);
  }
}

/* Adds the derivatives by the part of its slip with which a cell turns round; `turning`: that of the number by it. */
static void AddTurning(SamObjectiveStep *at, PetscInt k, double turning, double length)
{
  const PetscInt l  = k + at->grid->cells;
  const double   b0 = at->friction[k] * at->pressure_before[k], x = at->slip[k] / length, y = at->slip[l] / length;
  const double   qx = at->shear_before[k] / b0, qy = at->shear_before[l] / b0, back = qx * x + qy * y;

  at->by_slip[k] += turning * (qx - back * x) / length;
  at->by_slip[l] += turning * (qy - back * y) / length;
  at->by_shear_before[k] += turning * x / b0;
  at->by_shear_before[l] += turning * y / b0;
  at->by_pressure_before[k] -= turning * back / at->pressure_before[k];
  at->by_friction[k] -= turning * back / at->friction[k];
}

/* Adds the derivatives by the two slips that determine how far all cells slide alike. */
static void AddEnds(SamObjectiveStep *at, double by_alike)
{
  const SamGrid g = at->grid;

  for (int n = 0; n < 2; n++) {
    const PetscInt64 k = at->end[n] - (PetscInt64)g->row_start * g->nx;
    double           length;

    if (at->end[n] < 0 || k < 0 || k >= g->cells) continue;
    length = hypot(at->slip[k], at->slip[k + g->cells]);
    at->by_slip[k] += by_alike * at->by_end[n] * at->slip[k] / length;
    at->by_slip[k + g->cells] += by_alike * at->by_end[n] * at->slip[k + g->cells] / length;
  }
}

PetscErrorCode SamBackAddRubbed(SamObjectiveStep *at, const double factor[])
{
  const SamGrid g     = at->grid;
  SamTotal      total = {0};
  double        by_alike;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) {
      const double length = hypot(at->slip[k], at->slip[k + g->cells]);
      double       before, after, against, shift;

      GetShares(at, k, &before, &after);
      against = before * at->pressure_before[k] + after * at->pressure[k];
      at->by_pressure[k] += factor[k] * after * length;
      at->by_pressure_before[k] += factor[k] * before * length;
      if (!(length > 0) || at->share[k] < 0) continue;
      at->by_slip[k] += factor[k] * against * at->slip[k] / length;
      at->by_slip[k + g->cells] += factor[k] * against * at->slip[k + g->cells] / length;
      shift = factor[k] * (at->pressure_before[k] - at->pressure[k]) * length;
      row += shift * at->by_alike[k];
      if (at->by_back[k] != 0) AddTurning(at, k, shift * at->by_back[k], length);
    }
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(g->comm, 1, &total, &by_alike));
  AddEnds(at, by_alike);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the numbers ---- */

static PetscBool IsOf(const SamObjectiveStep *at)
{
  return at->step >= at->first && at->step <= at->last ? PETSC_TRUE : PETSC_FALSE;
}

/* Adds the sum over cells of a factor times what rubs, and its derivatives; with friction or without. */
static PetscErrorCode AddWork(SamObjectiveStep *at, PetscBool friction)
{
  const SamGrid g = at->grid;
  double       *rubbed, *factor;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(g->cells, &rubbed, g->cells, &factor));
  SamBackRubbed(at, rubbed);
  for (PetscInt j = 0; j < g->rows; j++) {
    double row = 0;

    for (PetscInt k = j * g->nx; k < (j + 1) * g->nx; k++) {
      factor[k] = at->area * (friction ? at->friction[k] : at->rate[0] + at->rate[1] * at->friction[k]);
      row += factor[k] * rubbed[k];
      if (friction) at->by_friction[k] += at->area * rubbed[k];
    }
    SamAdd(&at->value, row);
  }
  if (friction) PetscCall(SamBackAddRubbed(at, factor));
  PetscCall(PetscFree2(rubbed, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frictional work of the steps. */
static PetscErrorCode AddEnergy(SamObjectiveStep *at)
{
  PetscFunctionBegin;
  if (IsOf(at)) PetscCall(AddWork(at, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckVolume(SamElasticity elasticity, const PetscReal rate[], const char name[])
{
  PetscFunctionBegin;
  PetscCheck(rate[0] != 0 || rate[1] != 0, SamElasticityGetGrid(elasticity)->comm, SAM_ERR_USER,
             "the gradient of %s: the contact has no coefficient of wear: give -wear_coefficient1 or another", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the volume that a wear simulation has worn. */
static void AddWornVolume(SamObjectiveStep *at)
{
  const double factor = at->area * (double)(at->rate[0] + at->rate[1]);

  for (PetscInt j = 0; j < at->grid->rows; j++) {
    double row = 0;

    for (PetscInt k = j * at->grid->nx; k < (j + 1) * at->grid->nx; k++) row += factor * at->load[k];
    SamAdd(&at->value, row);
  }
}

/* Volume that both bodies have lost after the last of the steps; its derivatives come from the depth (gradient.c). */
static PetscErrorCode AddVolume(SamObjectiveStep *at)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; at->step == at->last && k < at->grid->cells; k++) at->by_worn[k] += at->area;
  if (at->load && at->step == at->last) AddWornVolume(at);
  if (!at->load && at->step <= at->last) PetscCall(AddWork(at, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (sum p^r dA)^(1/r) of the last of the steps. */
static PetscErrorCode AddNorm(SamObjectiveStep *at)
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

PetscErrorCode SamBackSumMoments(const SamBack *b, const double values[], double sums[3])
{
  const SamGrid g        = b->grid;
  SamTotal      total[3] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    const double y      = (double)SamGridY(g, g->row_start + j);
    double       row[3] = {0};

    for (PetscInt i = 0; i < g->nx; i++) {
      const double one = values[j * g->nx + i];

      row[0] += one;
      row[1] += (double)SamGridX(g, i) * one;
      row[2] += y * one;
    }
    SamAddAll(3, total, row);
  }
  PetscCall(SamSumTotals(g->comm, 3, total, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
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
static PetscErrorCode AddLoad(SamObjectiveStep *at)
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
static PetscErrorCode AddRigid(SamObjectiveStep *at)
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
    {.name = "energy", .unit = "J", .all = PETSC_TRUE, .add = AddEnergy},
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

PetscErrorCode SamObjectiveFind(MPI_Comm comm, const char name[], const SamObjective **objective)
{
  const size_t length     = strcspn(name, "@");
  char         names[512] = "";
  size_t       used       = 0;

  PetscFunctionBegin;
  if (!has_own) PetscCall(RegisterAll());
  *objective = NULL;
  for (PetscInt k = 0; k < listed; k++) {
    const PetscBool is =
      strlen(list[k].name) == length && !strncmp(list[k].name, name, length) && (list[k].suffix || !name[length]);

    if (is) *objective = &list[k];
    used += (size_t)snprintf(names + used, sizeof(names) - used, "%s%s%s", k ? ", " : "", list[k].name,
                             list[k].suffix ? "@DEPTH" : "");
    used = PetscMin(used, sizeof(names) - 1);
  }
  PetscCheck(*objective, comm, SAM_ERR_USER, "the gradient of %s%s: expected %s", name, WhyNot(name), names);
  PetscFunctionReturn(PETSC_SUCCESS);
}
