/*
  Stresses in a body under the tractions of load steps, quantities derived from them, and fatigue parameters of a cycle.
*/
#ifndef PETSAM_EVALUATION_H
#define PETSAM_EVALUATION_H

#include <petsam/private/stresspart.h>

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
  SamEvaluationReadTransforms - reads the settings of its transforms from the options; else they are those of the
  bodies. Collective.
  SamEvaluationSetUp - sets the source and the parts of the stresses, checks the settings together, and creates the
  kernels; it must be called once. Collective. Errors: SAM_ERR_USER for a body that is rigid or whose stresses are not
  available, a depth above zero but below a millionth of a cell, a section outside of the grid, a cycle of one step,
  passing points (-passing) with more than one step or below a section along y, and Ruiz's parameters below the
  surface or of passing points.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationReadTransforms(const SamOptions *from, SamEvaluation evaluation);
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
