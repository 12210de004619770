/*
  Stresses in a body under the tractions of load steps, quantities derived from them, and fatigue parameters of a cycle.
*/
#ifndef PETSAM_EVALUATION_H
#define PETSAM_EVALUATION_H

#include <petsam/control.h>
#include <petsam/elasticity.h>
#include <petsam/private/fourier.h>
#include <petsam/private/heat.h>
#include <petsam/private/state.h>

/*
  SamEvaluation - the stresses in one body under the tractions of load steps: at depths below all cells (maps) or below
  a line of cells (a section); the selected quantities derived from them (src/post/stress/quantities.c); and fatigue
  parameters over the steps, taken as one closed cycle. Maps are evaluated depth by depth, and each step is read once
  per depth: the steps of a SamStressSource need not be in memory together. Fatigue parameters keep 48 bytes per cell
  and step. If the surfaces slide, results of body 2 are at its own material points, which lie under the cells at slide
  0. Results are the same to the last bit on any number of ranks. Order of calls: Create, SetUp, Compute, GetLargest,
  Destroy.
*/
typedef struct _n_SamEvaluation *SamEvaluation;

/*
  SamEvaluationCreateFromOptions - creates an evaluation from the options of petsam-stress that select its results:
  -body, -depths, -section, -quantities, -fatigue and its constants, -passing, -fatigue_length. Collective. Errors:
  SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationCreateFromOptions(const SamOptions *from, SamEvaluation *evaluation);
PETSC_EXTERN PetscErrorCode SamEvaluationDestroy(SamEvaluation *evaluation);

/*
  SamStepField - the fields of a step that an evaluation reads: tractions (Pa), for Ruiz's parameters the slip (m), and
  for the temperature the frictional heat into the body (W/m2).
*/
typedef enum {
  SAM_STEP_PRESSURE,
  SAM_STEP_SHEAR_X,
  SAM_STEP_SHEAR_Y,
  SAM_STEP_SLIP_X,
  SAM_STEP_SLIP_Y,
  SAM_STEP_HEAT,
  SAM_STEP_FIELDS
} SamStepField;
/*
  SamStepNumber - the numbers of a step that an evaluation reads: the number of the load step, 0 if steps have none;
  time (s); contact area (m2); the cycle of a wear simulation; and, if the surfaces slide past each other, the distances
  (m) that body 1 has slid over body 2, and that the contact has rolled over body 1.
*/
typedef enum {
  SAM_STEP_NUMBER,
  SAM_STEP_TIME,
  SAM_STEP_AREA,
  SAM_STEP_CYCLE,
  SAM_STEP_SLIDE_X,
  SAM_STEP_SLIDE_Y,
  SAM_STEP_ROLLED_X,
  SAM_STEP_ROLLED_Y
} SamStepNumber;
/*
  SamStressSource - the bodies, which are referenced, and the load steps. Collective functions read the steps when they
  are needed: this rank's rows of a field; a number; the values of conditions of the bodies. Step -1 is the step before
  the first, if there is one. `warn` receives warnings about the steps as a cycle. `tell` is called from time to time
  during SamEvaluationCompute() with the name of the work under way, the fraction of it that is done, and the fraction
  of all work that is done (0: unknown); NULL: not called.
*/
typedef struct {
  SamElasticity             bodies;
  const SamFourierSettings *settings; /* settings of the transforms, borrowed; NULL: those of the bodies */
  const char               *name;     /* name of the origin of the bodies, for messages; borrowed */
  PetscInt                  steps;
  PetscBool                 before;
  PetscBool                 slides; /* true: the surfaces slide past each other, so that points of body 2 move */
  PetscBool                 slips;  /* true: steps follow each other, and have slips, not slip velocities */
  const SamHeatBody        *heat; /* constants of the body whose temperature is wanted, borrowed; NULL: no heat known */
  double                    bulk; /* its temperature far from the contact, K */
  double                    expansion; /* its coefficient of thermal expansion, 1/K; 0: none */
  PetscInt                  groups;    /* number of groups of layers with stresses besides those by tractions */
  const SamStateLayers     *group[SAM_LAYER_GROUPS]; /* borrowed; z is NULL if their stresses are not available */
  PetscErrorCode (*read)(void *context, PetscInt step, SamStepField field, double values[]);
  PetscErrorCode (*number)(void *context, PetscInt step, SamStepNumber number, double *value);
  PetscErrorCode (*conditions)(void *context, PetscInt step, SamConditions conditions, SamControl *control);
  /* reads a component of the stresses of a group in a layer, counted along z: this rank's rows, Pa */
  PetscErrorCode (*layer)(void *context, PetscInt step, PetscInt group, PetscInt component, PetscInt layer,
                          double values[]);
  PetscErrorCode (*warn)(void *context, const char text[]);
  PetscErrorCode (*tell)(void *context, const char work[], double part, double whole);
  void *context;
} SamStressSource;
/*
  SamEvaluationSetUp - sets the source, checks the settings together, and creates the kernels of the stresses; it must
  be called once. Collective. Errors: SAM_ERR_USER for a body that is rigid or whose stresses are not available, a depth
  above zero but below a millionth of a cell, a section outside of the grid, a cycle of one step, passing points
  (-passing) with more than one step or below a section along y, and Ruiz's parameters below the surface or of passing
  points.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationSetUp(SamEvaluation evaluation, const SamStressSource *source);

/* SamStressDataset - a result: numbers of shape (time, z, y, x), or (z, y, x) for all steps together. */
typedef struct {
  const char *name, *unit, *text;
  PetscBool   of_cycle;
} SamStressDataset;
enum { SAM_TIME, SAM_Z, SAM_Y, SAM_X, SAM_STRESS_AXES };
#define SAM_STRESS_DATASETS 64 /* most results */
/* SamStressLayout - the shape of the results, after SamEvaluationSetUp(); the body from its creation on. The arrays are
   borrowed. */
typedef struct {
  PetscInt         body;
  PetscBool        section, cycle; /* true: below one line of cells; true: there are parameters of a cycle */
  PetscBool        own; /* true: points are material points of body 2, under the cells before the surfaces slide */
  PetscInt         n[SAM_STRESS_AXES];          /* sizes over all ranks */
  const double    *coordinate[SAM_STRESS_AXES]; /* s, m */
  PetscInt         row, rows; /* first row and number of rows along y: this rank's part of a map, else all */
  PetscInt         datasets;
  SamStressDataset dataset[SAM_STRESS_DATASETS];
  double           memory;    /* bytes that SamEvaluationCompute() needs on this rank */
  double           half;      /* half width of the contact (m) that is the unit of -depths; 0: -depths are in m */
  PetscInt         half_step; /* step of that half width */
} SamStressLayout;
PETSC_EXTERN const SamStressLayout *SamEvaluationGetLayout(SamEvaluation evaluation);
/*
  SamEvaluationAddParameters - appends the body, its elasticity, and the constants of the selected fatigue parameters to
  the parameters; to be called after SamEvaluationSetUp(). Not collective.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationAddParameters(SamEvaluation evaluation, SamParameters *parameters);
/*
  SamEvaluationCompute - evaluates all steps and passes each result to the callback as soon as it is computed: this
  rank's block of a dataset of the layout, which begins at `start` and has `count` numbers along each axis; blocks of a
  cycle begin at time 0. A block of a map is this rank's rows at one depth, a block of a section is some depths. The
  callback is called equally often on all ranks; the arrays belong to the evaluation. Collective. Errors: SAM_ERR_USER
  for body 2 if its points under the contact are not on the grid.
*/
typedef PetscErrorCode (*SamEvaluationWrite)(void *context, PetscInt dataset, const PetscInt start[SAM_STRESS_AXES],
                                             const PetscInt count[SAM_STRESS_AXES], const double values[]);
PETSC_EXTERN PetscErrorCode SamEvaluationCompute(SamEvaluation evaluation, SamEvaluationWrite write, void *context);

/*
  SamLargest - a largest value, and its x, y and z (m); of equal values the first in the order z, y, x. NaN: no value.
*/
typedef struct {
  double value, place[3];
} SamLargest;
/*
  SamLargestSeries - the largest values of a quantity, one per step: the von Mises and the first principal stress,
  whether they are selected or not; with a map of the surface, the stress xx and the first principal stress at the
  contact edge (SamStressAtEdge()); in a body of several materials, in each that contains a depth, the von Mises stress,
  and the tension zz and the shear sqrt(xz^2 + yz^2) at its bottom; and the largest value of each selected fatigue
  parameter over the cycle.
*/
typedef struct {
  char              name[48], text[96]; /* name of its dataset (name_max in each step), and description */
  char              shown[64];          /* name as it is printed; "": not printed */
  const char       *unit;
  PetscBool         of_cycle;
  PetscInt          material; /* material of which it is the largest value, from 1; 0: all */
  PetscInt          places;   /* number of coordinates of the place; z is 0 at the edge, and omitted */
  PetscInt          missing;  /* number of steps in which too little of the edge is smooth and resolved */
  PetscInt          count;    /* number of steps; 1 for a cycle */
  const SamLargest *step;     /* borrowed */
} SamLargestSeries;
/*
  SamEvaluationGetLargest - gets the k-th series after SamEvaluationCompute(); returns false if there are no more. Not
  collective.
*/
PETSC_EXTERN PetscBool SamEvaluationGetLargest(SamEvaluation evaluation, PetscInt k, SamLargestSeries *series);

/* ---- files ---- */

/*
  SamStressFile - an HDF5 file with the results of an evaluation, their coordinates, and the largest values of each step
  in /history. Every dataset has the attributes `units` and `long_name` and its dimension scales, so that h5py and
  xarray open it.
*/
typedef struct _n_SamStressFile *SamStressFile;
/*
  SamStressFileCreate - creates the file with all datasets under a temporary name. SamStressFileFinish() gives it its
  name, in place of an older file of petsam. Collective. Errors: SAM_ERR_FILE, also when there is no space for it.
  SamStressFileWrite - writes a block of results; it is a SamEvaluationWrite whose context is the file. Collective.
  Errors: SAM_ERR_FILE.
  SamStressFileWriteLargest - writes largest values: those of steps in /history, as name_max and its place name_max_x,
  ...; those of a cycle as attributes of its dataset. Collective. Errors: SAM_ERR_FILE.
  SamStressFileSetText - stores a text as an attribute of the root group. Collective. Errors: SAM_ERR_FILE.
  SamStressFileSetHistory - writes a number for each step in /history, with its unit. Collective. Errors: SAM_ERR_FILE.
  SamStressFileFinish - completes the file and gives it its name. Collective. Errors: SAM_ERR_FILE.
  SamStressFileAbandon - removes a file that has not been finished; to be called before the program is aborted. Not
  collective.
  SamStressFileDestroy - frees the object, and removes a file that has not been finished. Collective.
*/
PETSC_EXTERN PetscErrorCode SamStressFileCreate(SamGrid grid, const char filename[], const SamStressLayout *layout,
                                                const SamParameters *parameters, SamStressFile *file);
PETSC_EXTERN PetscErrorCode SamStressFileWrite(void *file, PetscInt dataset, const PetscInt start[SAM_STRESS_AXES],
                                               const PetscInt count[SAM_STRESS_AXES], const double values[]);
PETSC_EXTERN PetscErrorCode SamStressFileWriteLargest(SamStressFile file, const SamLargestSeries *series);
PETSC_EXTERN PetscErrorCode SamStressFileSetText(SamStressFile file, const char name[], const char text[]);
PETSC_EXTERN PetscErrorCode SamStressFileSetHistory(SamStressFile file, const char name[], const char units[],
                                                    const char long_name[], const double values[]);
PETSC_EXTERN PetscErrorCode SamStressFileFinish(SamStressFile file);
PETSC_EXTERN void           SamStressFileAbandon(SamStressFile file);
PETSC_EXTERN PetscErrorCode SamStressFileDestroy(SamStressFile *file);

#endif
