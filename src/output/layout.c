/*
  The datasets of the results file: names, units, dimensions, attributes.

  Dimension scales are those of the HDF5 dimension scale specification, which netCDF-4 and xarray take for coordinates;
  the attributes follow the CF conventions.
*/
#include "hdf5impl.h"
#include <hdf5_hl.h>

#define CHUNK_STEPS 256 /* of what has one number a step */

const SamOutputField SamOutputFields[SAM_OUTPUT_FIELDS] = {
  {{"pressure", "Pa", "contact pressure"},                                      offsetof(SamFields, pressure),       0},
  {{"shear_x", "Pa", "shear traction along x"},                                 offsetof(SamFields, shear),          0},
  {{"shear_y", "Pa", "shear traction along y"},                                 offsetof(SamFields, shear),          1},
  {{"slip_x", "m", "relative tangential displacement along x since the start"}, offsetof(SamFields, slip),           0},
  {{"slip_y", "m", "relative tangential displacement along y since the start"}, offsetof(SamFields, slip),           1},
  {{"gap", "m", "gap between the deformed surfaces"},                           offsetof(SamFields, gap),            0},
  {{"displacement_x", "m", "relative elastic displacement along x"},            offsetof(SamFields, displacement_t), 0},
  {{"displacement_y", "m", "relative elastic displacement along y"},            offsetof(SamFields, displacement_t), 1},
  {{"displacement_z", "m", "relative elastic displacement along z"},            offsetof(SamFields, displacement_z), 0}
};

/* The order of the components is that of SamLoadNames and SamRigidNames. */
const SamOutputColumn SamOutputColumns[SAM_OUTPUT_COLUMNS] = {
  {{"time", "s", "time of the load step"},                                                 SAM_COLUMN_REAL,   offsetof(SamStep, time)                    },
  {{"load_n", "N", "normal force"},                                                        SAM_COLUMN_REAL,   offsetof(SamStep, normal.load[0])          },
  {{"load_tx", "N", "tangential force along x"},                                           SAM_COLUMN_REAL,   offsetof(SamStep, tangential.load[0])      },
  {{"load_ty", "N", "tangential force along y"},                                           SAM_COLUMN_REAL,   offsetof(SamStep, tangential.load[1])      },
  {{"load_mx", "N m", "moment about x"},                                                   SAM_COLUMN_REAL,   offsetof(SamStep, normal.load[1])          },
  {{"load_my", "N m", "moment about y"},                                                   SAM_COLUMN_REAL,   offsetof(SamStep, normal.load[2])          },
  {{"load_mz", "N m", "moment about z"},                                                   SAM_COLUMN_REAL,   offsetof(SamStep, tangential.load[2])      },
  {{"disp_z", "m", "rigid displacement along z (approach)"},                               SAM_COLUMN_REAL,   offsetof(SamStep, normal.rigid[0])         },
  {{"disp_x", "m", "rigid displacement along x"},                                          SAM_COLUMN_REAL,   offsetof(SamStep, tangential.rigid[0])     },
  {{"disp_y", "m", "rigid displacement along y"},                                          SAM_COLUMN_REAL,   offsetof(SamStep, tangential.rigid[1])     },
  {{"rot_x", "rad", "rotation about x"},                                                   SAM_COLUMN_REAL,   offsetof(SamStep, normal.rigid[1])         },
  {{"rot_y", "rad", "rotation about y"},                                                   SAM_COLUMN_REAL,   offsetof(SamStep, normal.rigid[2])         },
  {{"rot_z", "rad", "rotation about z"},                                                   SAM_COLUMN_REAL,   offsetof(SamStep, tangential.rigid[2])     },
  {{"contact_area", "m2", "area in contact"},                                              SAM_COLUMN_REAL,   offsetof(SamStep, contact_area)            },
  {{"stick_area", "m2", "area in stick"},                                                  SAM_COLUMN_REAL,   offsetof(SamStep, stick_area)              },
  {{"normal_residual", "1", "relative error of the normal problem, by the check"},         SAM_COLUMN_REAL,   offsetof(SamStep, check.normal)            },
  {{"tangential_residual", "1", "relative error of the tangential problem, by the check"}, SAM_COLUMN_REAL,   offsetof(SamStep, check.tangential)        },
  {{"equilibrium_residual", "1", "relative error of the loads, by the check"},             SAM_COLUMN_REAL,   offsetof(SamStep, check.equilibrium)       },
  {{"normal_iterations", "1", "iterations of the normal solver"},                          SAM_COLUMN_INT,    offsetof(SamStep, normal_iterations)       },
  {{"tangential_iterations", "1", "iterations of the tangential solver"},                  SAM_COLUMN_INT,    offsetof(SamStep, tangential_iterations)   },
  {{"normal_applies", "1", "applications of the normal influence operator"},               SAM_COLUMN_INT,    offsetof(SamStep, normal_applies)          },
  {{"tangential_applies", "1", "applications of the tangential influence operator"},       SAM_COLUMN_INT,    offsetof(SamStep, tangential_applies)      },
  {{"normal_preconditions", "1", "applications of the normal preconditioner"},             SAM_COLUMN_INT,    offsetof(SamStep, normal_preconditions)    },
  {{"tangential_preconditions", "1", "applications of the tangential preconditioner"},     SAM_COLUMN_INT,    offsetof(SamStep, tangential_preconditions)},
  {{"coupling_iterations", "1", "passes of the normal-tangential coupling"},               SAM_COLUMN_INT,    offsetof(SamStep, coupling_iterations)     },
  {{"status", "1", "outcome of the load step"},                                            SAM_COLUMN_STATUS, offsetof(SamStep, status)                  },
  {{"dissipated_energy", "J", "frictional work of the load step"},                         SAM_COLUMN_REAL,   offsetof(SamStep, dissipated_energy)       }
};

static const SamOutputLabel x_label        = {"x", "m", "x of the cell centres"};
static const SamOutputLabel y_label        = {"y", "m", "y of the cell centres"};
static const SamOutputLabel time_label     = {"time", "s", "time of the saved fields"};
static const SamOutputLabel state_label    = {"state", "1", "state of the cell"};
static const char           state_words[]  = "open stick slip"; /* SamState */
static const char           status_words[] = "converged not_converged no_equilibrium edge_contact";

/* A shape: dimensions at first, their largest, and chunks. */
typedef struct {
  int     rank;
  hsize_t size[3], largest[3], chunk[3];
} Shape;

static const Shape series = {1, {0}, {H5S_UNLIMITED}, {CHUNK_STEPS}};

void SamOutputWriteAttribute(SamOutput o, hid_t object, const char name[], hid_t stored, hid_t type, PetscInt count, const void *values)
{
  const hsize_t size  = (hsize_t)count;
  const hid_t   space = SamOutputNote(o, count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL));
  hid_t         attribute;

  if (SamOutputNote(o, H5Aexists(object, name)) > 0) (void)SamOutputNote(o, H5Adelete(object, name));
  attribute = SamOutputNote(o, H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT));
  (void)SamOutputNote(o, H5Awrite(attribute, type, values));
  (void)SamOutputNote(o, H5Aclose(attribute));
  (void)SamOutputNote(o, H5Sclose(space));
}

/* Texts are stored with variable length, which h5py gives back as str. */
void SamOutputWriteTextAttribute(SamOutput o, hid_t object, const char name[], const char text[])
{
  const hid_t type = SamOutputNote(o, H5Tcopy(H5T_C_S1));

  (void)SamOutputNote(o, H5Tset_size(type, H5T_VARIABLE));
  (void)SamOutputNote(o, H5Tset_cset(type, H5T_CSET_UTF8));
  SamOutputWriteAttribute(o, object, name, type, type, 1, &text);
  (void)SamOutputNote(o, H5Tclose(type));
}

static hid_t CreateDataset(SamOutput o, hid_t where, const SamOutputLabel *label, hid_t type, const Shape *shape, PetscInt compress)
{
  const hid_t space = SamOutputNote(o, H5Screate_simple(shape->rank, shape->size, shape->largest)), creation = SamOutputNote(o, H5Pcreate(H5P_DATASET_CREATE));
  hid_t       dataset;

  if (shape->chunk[0]) (void)SamOutputNote(o, H5Pset_chunk(creation, shape->rank, shape->chunk));
  /* all is written that is there: filling new chunks would only write them twice */
  (void)SamOutputNote(o, H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER));
  if (compress > 0) {
    (void)SamOutputNote(o, H5Pset_shuffle(creation));
    (void)SamOutputNote(o, H5Pset_deflate(creation, (unsigned)compress));
  }
  dataset = SamOutputNote(o, H5Dcreate2(where, label->name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  SamOutputWriteTextAttribute(o, dataset, "units", label->units);
  SamOutputWriteTextAttribute(o, dataset, "long_name", label->long_name);
  (void)SamOutputNote(o, H5Pclose(creation));
  (void)SamOutputNote(o, H5Sclose(space));
  return dataset;
}

/* A coordinate, which CF's attributes tell by its axis and its standard name. */
static hid_t CreateScale(SamOutput o, hid_t where, const SamOutputLabel *label, const char axis[], const char standard_name[], const Shape *shape)
{
  const hid_t scale = CreateDataset(o, where, label, H5T_IEEE_F64LE, shape, 0);

  SamOutputWriteTextAttribute(o, scale, "axis", axis);
  SamOutputWriteTextAttribute(o, scale, "standard_name", standard_name);
  (void)SamOutputNote(o, H5DSset_scale(scale, label->name));
  return scale;
}

/* The coordinates of the cell centres, which rank 0 writes. */
static PetscErrorCode CreateAxis(SamOutput o, const SamOutputLabel *label, PetscInt direction, hid_t *scale)
{
  const PetscInt n     = direction ? o->grid->ny : o->grid->nx;
  const Shape    shape = {1, {(hsize_t)n}, {(hsize_t)n}, {0}};
  double        *values;
  hid_t          space;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &values));
  for (PetscInt k = 0; k < n; k++) values[k] = direction ? SamGridY(o->grid, k) : SamGridX(o->grid, k);
  *scale = CreateScale(o, o->file, label, direction ? "Y" : "X", direction ? "projection_y_coordinate" : "projection_x_coordinate", &shape);
  space  = SamOutputNote(o, H5Dget_space(*scale));
  if (o->rank) (void)SamOutputNote(o, H5Sselect_none(space));
  (void)SamOutputNote(o, H5Dwrite(*scale, H5T_NATIVE_DOUBLE, space, space, o->transfer, values));
  (void)SamOutputNote(o, H5Sclose(space));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The size of the fewest equal chunks of n that are no larger than most; the last may reach a little beyond n. */
static hsize_t ChunkSize(hsize_t n, hsize_t most)
{
  const hsize_t chunks = (n + most - 1) / most;

  return (n + chunks - 1) / chunks;
}

/* Chunks are one step deep. */
static Shape FieldShape(SamOutput o)
{
  const hsize_t ny = (hsize_t)o->grid->ny, nx = (hsize_t)o->grid->nx;

  return (Shape){3, {0, ny, nx}, {H5S_UNLIMITED, ny, nx}, {1, ChunkSize(ny, (hsize_t)o->set.chunk[1]), ChunkSize(nx, (hsize_t)o->set.chunk[0])}};
}

off_t SamOutputFieldBytes(SamOutput o)
{
  const Shape shape = FieldShape(o);
  hsize_t     cells = 1; /* of whole chunks */

  for (int d = 1; d < 3; d++) cells *= (shape.size[d] + shape.chunk[d] - 1) / shape.chunk[d] * shape.chunk[d];
  return (off_t)(cells * (SAM_OUTPUT_FIELDS * sizeof(double) + 1));
}

static PetscErrorCode CreateFields(SamOutput o)
{
  const Shape    shape    = FieldShape(o);
  const int8_t   states[] = {SAM_STATE_OPEN, SAM_STATE_STICK, SAM_STATE_SLIP};
  hid_t          scales[3]; /* of [time, y, x] */

  PetscFunctionBegin;
  PetscCall(CreateAxis(o, &x_label, 0, &scales[2]));
  PetscCall(CreateAxis(o, &y_label, 1, &scales[1]));
  scales[0] = o->time = CreateScale(o, o->file, &time_label, "T", "time", &series);
  for (PetscInt f = 0; f < SAM_OUTPUT_FIELDS; f++) o->fields[f] = CreateDataset(o, o->file, &SamOutputFields[f].label, H5T_IEEE_F64LE, &shape, o->set.compress);
  o->state = CreateDataset(o, o->file, &state_label, H5T_STD_I8LE, &shape, o->set.compress);
  SamOutputWriteAttribute(o, o->state, "flag_values", H5T_STD_I8LE, H5T_NATIVE_INT8, 3, states);
  SamOutputWriteTextAttribute(o, o->state, "flag_meanings", state_words);
  for (unsigned d = 0; d < 3; d++) {
    for (PetscInt f = 0; f < SAM_OUTPUT_FIELDS; f++) (void)SamOutputNote(o, H5DSattach_scale(o->fields[f], scales[d], d));
    (void)SamOutputNote(o, H5DSattach_scale(o->state, scales[d], d));
  }
  (void)SamOutputNote(o, H5Dclose(scales[1]));
  (void)SamOutputNote(o, H5Dclose(scales[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first column, the time, is the dimension scale of the others. */
static void CreateHistory(SamOutput o)
{
  const int64_t statuses[] = {SAM_STATUS_CONVERGED, SAM_STATUS_NOT_CONVERGED, SAM_STATUS_NO_EQUILIBRIUM, SAM_STATUS_EDGE_CONTACT};
  const hid_t   group      = SamOutputNote(o, H5Gcreate2(o->file, "history", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));

  o->columns[0] = CreateScale(o, group, &SamOutputColumns[0].label, "T", "time", &series);
  for (PetscInt c = 1; c < SAM_OUTPUT_COLUMNS; c++) {
    const SamOutputColumn *column = &SamOutputColumns[c];

    o->columns[c] = CreateDataset(o, group, &column->label, column->kind == SAM_COLUMN_REAL ? H5T_IEEE_F64LE : H5T_STD_I64LE, &series, 0);
    (void)SamOutputNote(o, H5DSattach_scale(o->columns[c], o->columns[0], 0));
    if (column->kind == SAM_COLUMN_STATUS) {
      SamOutputWriteAttribute(o, o->columns[c], "flag_values", H5T_STD_I64LE, H5T_NATIVE_INT64, 4, statuses);
      SamOutputWriteTextAttribute(o, o->columns[c], "flag_meanings", status_words);
    }
  }
  (void)SamOutputNote(o, H5Gclose(group));
}

PetscErrorCode SamOutputCreateLayout(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(CreateFields(o));
  CreateHistory(o);
  SamOutputCreateVTK(o);
  SamOutputWriteTextAttribute(o, o->file, "Conventions", "CF-1.8");
  SamOutputWriteTextAttribute(o, o->file, "title", "Partial-slip contact of elastic bodies");
  SamOutputWriteTextAttribute(o, o->file, "source", "petsam " PETSAM_VERSION ", semi-analytical method");
  SamOutputWriteTextAttribute(o, o->file, "petsam_version", PETSAM_VERSION);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Close(SamOutput o, hid_t *dataset)
{
  if (*dataset >= 0) (void)SamOutputNote(o, H5Dclose(*dataset));
  *dataset = -1;
}

void SamOutputCloseLayout(SamOutput o)
{
  if (o->vtk_steps >= 0) (void)SamOutputNote(o, H5Aclose(o->vtk_steps));
  o->vtk_steps = -1;
  Close(o, &o->time);
  Close(o, &o->state);
  for (PetscInt f = 0; f < SAM_OUTPUT_FIELDS; f++) Close(o, &o->fields[f]);
  for (PetscInt c = 0; c < SAM_OUTPUT_COLUMNS; c++) Close(o, &o->columns[c]);
}
