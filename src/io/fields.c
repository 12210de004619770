/*
  The contents of the results: a table of the fields of a saved step, and a table of the numbers of every step.

  To add a field, add a line, and a function where the contact does not store it; to add a number, add a line.
  Of the numbers there are two series: one of all steps, and one of the computed cycles of a life.
*/
#include "ioimpl.h"
#include <math.h>
#include <string.h>

/* ---- fields ---- */

static PetscErrorCode ComputeSlip(SamContact contact, SamWear wear, PetscInt component, Vec field)
{
  PetscFunctionBegin;
  (void)wear;
  PetscCall(SamContactComputeSlip(contact, component, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeGap(SamContact contact, SamWear wear, PetscInt component, Vec field)
{
  PetscFunctionBegin;
  (void)wear;
  (void)component;
  PetscCall(SamContactComputeGap(contact, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeState(SamContact contact, SamWear wear, PetscInt component, Vec field)
{
  PetscFunctionBegin;
  (void)wear;
  (void)component;
  PetscCall(SamContactComputeState(contact, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputePressureCenter(SamContact contact, SamWear wear, PetscInt component, Vec field)
{
  PetscFunctionBegin;
  (void)wear;
  (void)component;
  PetscCall(SamContactComputePressureCenter(contact, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeShearCenter(SamContact contact, SamWear wear, PetscInt component, Vec field)
{
  PetscFunctionBegin;
  (void)wear;
  PetscCall(SamContactComputeShearCenter(contact, component, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeSum(SamContact contact, SamWear wear, PetscInt which, Vec field)
{
  PetscFunctionBegin;
  (void)wear;
  PetscCall(SamContactComputeSum(contact, (SamContactSum)which, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputeDepth(SamContact contact, SamWear wear, PetscInt body, Vec field)
{
  PetscFunctionBegin;
  (void)contact;
  PetscCall(SamWearGetDepth(wear, body, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ComputePlasticDepth(SamContact contact, SamWear wear, PetscInt component, Vec field)
{
  PetscFunctionBegin;
  (void)wear;
  (void)component;
  PetscCall(SamContactComputePlasticDepth(contact, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define STORED(name, units, text, usual, member, component) \
  { \
    {name, units, text}, SAM_FIELD_REAL, NULL, offsetof(SamSolution, member), component, SAM_OUTPUT_OPTIONS, usual \
  }
#define COMPUTED(name, units, text, usual, kind, function, component) \
  { \
    {name, units, text}, kind, function, 0, component, SAM_OUTPUT_OPTIONS, usual \
  }
#define DEPTH(name, text, function, body, option) \
  { \
    {name, "m", text}, SAM_FIELD_REAL, function, 0, body, option, PETSC_TRUE \
  }
#define POINTS(name, text, edge) \
  { \
    {name, "m", text}, SAM_FIELD_POINTS, NULL, 0, edge, SAM_OUTPUT_OPTIONS, NO \
  }
#define YES PETSC_TRUE
#define NO  PETSC_FALSE

const SamOutputField SamOutputFields[] = {
  STORED("pressure", "Pa", "contact pressure, mean over the cell", YES, pressure, 0),
  STORED("shear_x", "Pa", "shear traction along x, mean over the cell", YES, shear, 0),
  STORED("shear_y", "Pa", "shear traction along y, mean over the cell", YES, shear, 1),
  COMPUTED("slip_x", "m", "relative tangential displacement along x since the start", YES, SAM_FIELD_REAL, ComputeSlip,
           0),
  COMPUTED("slip_y", "m", "relative tangential displacement along y since the start", YES, SAM_FIELD_REAL, ComputeSlip,
           1),
  COMPUTED("gap", "m", "gap between the deformed surfaces", NO, SAM_FIELD_REAL, ComputeGap, 0),
  STORED("displacement_x", "m", "relative elastic displacement along x", NO, displacement_t, 0),
  STORED("displacement_y", "m", "relative elastic displacement along y", NO, displacement_t, 1),
  STORED("displacement_z", "m", "relative elastic displacement along z", NO, displacement_z, 0),
  COMPUTED("state", "1", "state of the cell", YES, SAM_FIELD_STATE, ComputeState, 0),
  COMPUTED("pressure_center", "Pa", "contact pressure at the centre of the cell", NO, SAM_FIELD_REAL,
           ComputePressureCenter, 0),
  COMPUTED("shear_center_x", "Pa", "shear traction along x at the centre of the cell", NO, SAM_FIELD_REAL,
           ComputeShearCenter, 0),
  COMPUTED("shear_center_y", "Pa", "shear traction along y at the centre of the cell", NO, SAM_FIELD_REAL,
           ComputeShearCenter, 1),
  COMPUTED("slip_path", "m", "path of the slip: sum of |ds| over all steps", NO, SAM_FIELD_REAL, ComputeSum,
           SAM_CONTACT_SLIP_PATH),
  COMPUTED("friction_energy", "J/m2", "frictional work: sum of -q.ds over all steps", NO, SAM_FIELD_REAL, ComputeSum,
           SAM_CONTACT_FRICTION_ENERGY),
  POINTS("contact_edge", "points of the edge of contact, x and y", SAM_CONTACT_EDGE_CONTACT),
  POINTS("stick_edge", "points of the edge of the stick zone, x and y", SAM_CONTACT_EDGE_STICK),
  DEPTH("wear_depth1", "depth removed of body 1", ComputeDepth, 0, SAM_OUTPUT_WEAR),
  DEPTH("wear_depth2", "depth removed of body 2", ComputeDepth, 1, SAM_OUTPUT_WEAR),
  DEPTH("plastic_depth", "depth by which both surfaces have yielded", ComputePlasticDepth, 0, SAM_OUTPUT_PLASTIC)};
const PetscInt SamOutputFieldCount = sizeof(SamOutputFields) / sizeof(SamOutputFields[0]);

/* ---- numbers ---- */

#define REAL(name, units, text, member) \
  { \
    {name, units, text}, SAM_COLUMN_REAL, offsetof(SamStep, member), SAM_OUTPUT_OPTIONS \
  }
#define INT(name, text, member) \
  { \
    {name, "1", text}, SAM_COLUMN_INT, offsetof(SamStep, member), SAM_OUTPUT_OPTIONS \
  }
#define STATUS(name, text, member) \
  { \
    {name, "1", text}, SAM_COLUMN_STATUS, offsetof(SamStep, member), SAM_OUTPUT_OPTIONS \
  }
#define OPTIONAL(option, name, units, text, member) \
  { \
    {name, units, text}, SAM_COLUMN_REAL, offsetof(SamStep, member), option \
  }
#define COUNT(option, name, text, member) \
  { \
    {name, "1", text}, SAM_COLUMN_INT, offsetof(SamStep, member), option \
  }
#define MATRIX(name, text, member) \
  { \
    {name, "N/m, N/rad, N, N m/rad", text}, SAM_COLUMN_MATRIX, offsetof(SamStep, member), SAM_OUTPUT_STIFFNESS \
  }
#define BULK(body, component, name) \
  OPTIONAL(SAM_OUTPUT_BULK_STRESS, name, "Pa", "bulk stress of the body, tension positive", \
           control.bulk_stress[body][component])

static const SamOutputColumn history[] = {
  REAL("time", "s", "time of the load step", control.time),
  REAL("load_n", "N", "normal force", load[SAM_COMPONENT_N]),
  REAL("load_tx", "N", "tangential force along x", load[SAM_COMPONENT_TX]),
  REAL("load_ty", "N", "tangential force along y", load[SAM_COMPONENT_TY]),
  REAL("load_mx", "N m", "moment about x", load[SAM_COMPONENT_MX]),
  REAL("load_my", "N m", "moment about y", load[SAM_COMPONENT_MY]),
  REAL("load_mz", "N m", "moment about z", load[SAM_COMPONENT_MZ]),
  REAL("disp_z", "m", "rigid displacement along z (approach)", rigid[SAM_COMPONENT_N]),
  REAL("disp_x", "m", "rigid displacement along x", rigid[SAM_COMPONENT_TX]),
  REAL("disp_y", "m", "rigid displacement along y", rigid[SAM_COMPONENT_TY]),
  REAL("rot_x", "rad", "rotation about x", rigid[SAM_COMPONENT_MX]),
  REAL("rot_y", "rad", "rotation about y", rigid[SAM_COMPONENT_MY]),
  REAL("rot_z", "rad", "rotation about z", rigid[SAM_COMPONENT_MZ]),
  OPTIONAL(SAM_OUTPUT_FRICTION_SCALE, "friction_scale", "1", "factor on the coefficient of friction",
           control.friction_scale),
  BULK(0, SAM_BULK_XX, "bulk1_stress_xx"),
  BULK(0, SAM_BULK_YY, "bulk1_stress_yy"),
  BULK(0, SAM_BULK_XY, "bulk1_stress_xy"),
  BULK(1, SAM_BULK_XX, "bulk2_stress_xx"),
  BULK(1, SAM_BULK_YY, "bulk2_stress_yy"),
  BULK(1, SAM_BULK_XY, "bulk2_stress_xy"),
  REAL("contact_area", "m2", "area in contact", contact_area),
  REAL("stick_area", "m2", "area in stick", stick_area),
  REAL("contact_fraction", "1", "area in contact over that of the grid", contact_fraction),
  INT("contact_cells", "cells in contact", contact_cells),
  INT("stick_cells", "cells in stick", stick_cells),
  REAL("pressure_max", "Pa", "largest pressure", pressure_max),
  REAL("shear_max", "Pa", "largest shear", shear_max),
  REAL("slip_max", "m", "largest slip since the start of a cell in contact", slip_max),
  OPTIONAL(SAM_OUTPUT_SPOTS, "contact_spots", "1", "zones of contact, connected by the sides of cells", spots),
  OPTIONAL(SAM_OUTPUT_SPOTS, "gap_mean", "m", "mean gap of all cells", gap_mean),
  REAL("edge_accepted", "1", "share of the edges of contact and stick that are reconstructed", edge_accepted),
  REAL("normal_residual", "1", "relative error of the normal problem, by the check", check.normal),
  REAL("tangential_residual", "1", "relative error of the tangential problem, by the check", check.tangential),
  REAL("equilibrium_residual", "1", "relative error of the loads, by the check", check.equilibrium),
  INT("edge_passes", "solutions again for the edge of contact, 0 for none", edge_passes),
  INT("stick_passes", "solutions again for the edge of stick, 0 for none", stick_passes),
  INT("normal_iterations", "iterations of the normal solver", normal_iterations),
  INT("tangential_iterations", "iterations of the tangential solver", tangential_iterations),
  INT("normal_applies", "applications of the normal influence operator", normal_applies),
  INT("tangential_applies", "applications of the tangential influence operator", tangential_applies),
  INT("normal_preconditions", "applications of the normal preconditioner", normal_preconditions),
  INT("tangential_preconditions", "applications of the tangential preconditioner", tangential_preconditions),
  INT("coupling_iterations", "passes of the normal-tangential coupling", coupling_iterations),
  STATUS("status", "outcome of the load step", status),
  OPTIONAL(SAM_OUTPUT_LIFE, "cycle", "1", "cycles before this one", cycle),
  OPTIONAL(SAM_OUTPUT_WEAR, "wear_volume1", "m3", "volume removed of body 1", wear_volume[0]),
  OPTIONAL(SAM_OUTPUT_WEAR, "wear_volume2", "m3", "volume removed of body 2", wear_volume[1]),
  COUNT(SAM_OUTPUT_PLASTIC, "plastic_cells", "cells at the limit of the pressure", plastic_cells),
  OPTIONAL(SAM_OUTPUT_PLASTIC, "plastic_area", "m2", "area at the limit of the pressure", plastic_area),
  OPTIONAL(SAM_OUTPUT_PLASTIC, "plastic_depth_max", "m", "largest depth by which the surfaces have yielded",
           plastic_depth_max),
  OPTIONAL(SAM_OUTPUT_PLASTIC, "plastic_energy", "J", "work of the pressure on what yields in the load step",
           plastic_energy),
  REAL("dissipated_energy", "J", "frictional work of the load step", dissipated_energy),
  REAL("stored_energy", "J", "elastic energy of both bodies", stored_energy),
  MATRIX("stiffness", "d(loads)/d(rigid displacements) if the motion of the step goes on", stiffness[0]),
  MATRIX("stiffness_reversal", "d(loads)/d(rigid displacements) at the reversal of the motion", stiffness[1])};

#define CYCLE(name, units, text, kind, member) \
  { \
    {name, units, text}, kind, offsetof(SamLifeReport, member), SAM_OUTPUT_LIFE \
  }
static const SamOutputColumn wear[] = {
  CYCLE("cycle", "1", "cycles before this one", SAM_COLUMN_REAL, cycles),
  CYCLE("jump", "1", "cycles jumped over before this one", SAM_COLUMN_REAL, jump),
  CYCLE("error", "1", "estimated error of the jump, relative", SAM_COLUMN_REAL, error),
  CYCLE("volume1", "m3", "volume removed of body 1", SAM_COLUMN_REAL, volume[0]),
  CYCLE("volume2", "m3", "volume removed of body 2", SAM_COLUMN_REAL, volume[1]),
  CYCLE("depth_max1", "m", "largest depth removed of body 1", SAM_COLUMN_REAL, depth[0]),
  CYCLE("depth_max2", "m", "largest depth removed of body 2", SAM_COLUMN_REAL, depth[1]),
  CYCLE("dissipated_energy", "J", "frictional work of the cycle", SAM_COLUMN_REAL, dissipated_energy),
  CYCLE("contact_area", "m2", "area in contact at the end of the cycle", SAM_COLUMN_REAL, contact_area),
  CYCLE("pressure_max", "Pa", "largest pressure at the end of the cycle", SAM_COLUMN_REAL, pressure),
  CYCLE("computed", "1", "cycles computed so far", SAM_COLUMN_INT, computed)};

/* ---- by name ---- */

static PetscInt Find(const char name[])
{
  PetscInt f = 0;

  while (f < SamOutputFieldCount && strcmp(SamOutputFields[f].label.name, name)) f++;
  return f;
}

PetscErrorCode SamOutputSettingsSetFields(SamOutputSettings *set, PetscInt count, const char *const names[],
                                          const char **unknown)
{
  PetscFunctionBegin;
  *unknown   = NULL;
  set->named = count > 0;
  for (PetscInt f = 0; f < SamOutputFieldCount; f++)
    set->fields[f] = count < 0 ? SamOutputFields[f].usual : PETSC_FALSE;
  for (PetscInt k = 0; k < count; k++) {
    const PetscInt  f   = Find(names[k]);
    const PetscBool all = strcmp(names[k], "all") ? PETSC_FALSE : PETSC_TRUE;

    if (all) set->named = PETSC_FALSE;
    for (PetscInt g = 0; g < SamOutputFieldCount && all; g++) set->fields[g] = PETSC_TRUE;
    if (f < SamOutputFieldCount)
      set->fields[f] = PETSC_TRUE;
    else if (!all && !(strcmp(names[k], "none") == 0 && count == 1))
      *unknown = names[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSettingsCheck(const SamOutputSettings *set, const SamOptions *from)
{
  PetscFunctionBegin;
  for (PetscInt f = 0; f < SamOutputFieldCount && set->named; f++)
    PetscCheck(!set->fields[f] || SamOutputWants(set, SamOutputFields[f].option), from->comm, SAM_ERR_USER,
               "-%soutput_fields: there is no %s, as nothing %s", SamOptionsPrefix(from), SamOutputFields[f].label.name,
               SamOutputFields[f].option == SAM_OUTPUT_PLASTIC ? "yields without -pressure_limit" : "wears");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamOutputSettingsHas(const SamOutputSettings *set, const char name[])
{
  const PetscInt f = Find(name);

  return f < SamOutputFieldCount ? SamOutputWantsField(set, f) : PETSC_FALSE;
}

PetscErrorCode SamOutputSettingsPrepare(SamOutputSettings *set, SamContact contact)
{
  PetscFunctionBegin;
  set->contact = contact;
  for (PetscInt f = 0; f < SamOutputFieldCount; f++)
    if (set->fields[f] && SamOutputFields[f].compute == ComputeSum)
      PetscCall(SamContactKeepSum(contact, (SamContactSum)SamOutputFields[f].component));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputFindMissing(SamOutput o, const char **name)
{
  PetscFunctionBegin;
  *name = NULL;
  for (PetscInt f = 0; f < SamOutputFieldCount && o->set.contact; f++) {
    Vec sum;

    if (!o->set.fields[f] || SamOutputFields[f].compute != ComputeSum) continue;
    PetscCall(SamContactGetSum(o->set.contact, (SamContactSum)SamOutputFields[f].component, &sum));
    if (!sum) *name = SamOutputFields[f].label.name;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputGetFieldNames(char names[], size_t size)
{
  PetscFunctionBegin;
  names[0] = '\0';
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    if (f) PetscCall(PetscStrlcat(names, f + 1 < SamOutputFieldCount ? ", " : " or ", size));
    PetscCall(PetscStrlcat(names, SamOutputFields[f].label.name, size));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputFindField(const SamOutputField *field, SamContact contact, SamWear worn, Vec work, Vec *holder,
                                  PetscInt *component)
{
  const SamSolution *solution;

  PetscFunctionBegin;
  *holder    = work;
  *component = 0;
  if (field->compute) {
    PetscCall(field->compute(contact, worn, field->component, work));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactGetSolution(contact, &solution));
  *holder    = *(const Vec *)((const char *)solution + field->offset);
  *component = field->component;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a field that is a sum over the steps is kept. */
static PetscErrorCode CheckSum(SamContact contact, PetscInt f, PetscBool *found)
{
  Vec sum;

  PetscFunctionBegin;
  if (!*found || SamOutputFields[f].compute != ComputeSum) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetSum(contact, (SamContactSum)SamOutputFields[f].component, &sum));
  *found = sum ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFieldGet(SamContact contact, SamWear worn, const char name[], Vec field, PetscBool *found)
{
  const double *from;
  double       *to;
  Vec           holder;
  PetscInt      f = Find(name), component, cells;
  PetscReal     limit;
  SamProblem    problem;

  PetscFunctionBegin;
  PetscCall(SamContactGetProblem(contact, &problem));
  PetscCall(SamProblemGetPressureLimit(problem, &limit));
  *found = f < SamOutputFieldCount && SamOutputFields[f].kind != SAM_FIELD_POINTS &&
           (worn || SamOutputFields[f].option != SAM_OUTPUT_WEAR) &&
           (isfinite(limit) || SamOutputFields[f].option != SAM_OUTPUT_PLASTIC);
  PetscCall(CheckSum(contact, f, found));
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOutputFindField(&SamOutputFields[f], contact, worn, field, &holder, &component));
  if (holder == field) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetLocalSize(field, &cells));
  PetscCall(VecGetArrayRead(holder, &from));
  PetscCall(VecGetArrayWrite(field, &to));
  PetscCall(PetscArraycpy(to, from + component * cells, cells));
  PetscCall(VecRestoreArrayWrite(field, &to));
  PetscCall(VecRestoreArrayRead(holder, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamStepGetNumber(const SamStep *step, const char name[], PetscReal *value)
{
  for (size_t c = 0; c < sizeof(history) / sizeof(history[0]); c++) {
    const char *const place = (const char *)step + history[c].offset;

    if (strcmp(history[c].label.name, name) || history[c].kind == SAM_COLUMN_MATRIX) continue;
    *value = history[c].kind == SAM_COLUMN_REAL  ? *(const PetscReal *)place
             : history[c].kind == SAM_COLUMN_INT ? (PetscReal) * (const PetscInt *)place
                                                 : (PetscReal) * (const SamStatus *)place;
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

const SamOutputSeries SamOutputAllSeries[SAM_SERIES] = {{"history", history, sizeof(history) / sizeof(history[0])},
                                                        {"wear", wear, sizeof(wear) / sizeof(wear[0])}};
