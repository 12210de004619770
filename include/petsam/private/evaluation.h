/* Stresses in a body under the tractions of load steps, quantities of them, and fatigue parameters of a cycle. */
#ifndef PETSAM_EVALUATION_H
#define PETSAM_EVALUATION_H

#include <petsam/control.h>
#include <petsam/elasticity.h>

/*
  SamEvaluation - the stresses in one body under the tractions of load steps: at depths below all cells (maps) or below
  a line of them (a section); the quantities that are wanted of them (src/post/stress/quantities.c); and fatigue
  parameters over the steps, taken as one closed cycle. Maps are evaluated depth by depth, and each step is read once
  per depth: the steps of a SamStressSource need not be in memory together. Fatigue parameters keep 48 bytes per cell
  and step. Where surfaces slide, results of body 2 are at its own points, those that lie under the cells at slide 0.
  Results are the same to the last bit on any number of ranks. Order of calls: Create, SetUp, Compute, GetLargest,
  Destroy.
*/
typedef struct _n_SamEvaluation *SamEvaluation;

/*
  SamEvaluationCreateFromOptions - reads the options of petsam-stress that say what is wanted: -body, -depths, -section,
  -quantities, -fatigue and its constants, -passing, -fatigue_length. Collective. Errors: SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationCreateFromOptions(const SamOptions *from, SamEvaluation *evaluation);
PETSC_EXTERN PetscErrorCode SamEvaluationDestroy(SamEvaluation *evaluation);

/* The fields of a step that an evaluation reads: tractions (Pa), and for Ruiz's parameters the slip (m). */
typedef enum {
  SAM_STEP_PRESSURE,
  SAM_STEP_SHEAR_X,
  SAM_STEP_SHEAR_Y,
  SAM_STEP_SLIP_X,
  SAM_STEP_SLIP_Y,
  SAM_STEP_FIELDS
} SamStepField;
/*
  Numbers of a step: of the load step, 0 where steps have none; time (s); contact area (m2); the cycle of a life; where
  surfaces slide past each other, how far body 1 has slid over body 2, and the contact has
  rolled over body 1 (m).
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
  SamStressSource - the bodies, which are referenced, and the load steps, which are read when they are needed, by
  collective functions: this rank's rows of a field; a number; the values of conditions of the bodies.
  Step -1 is the one before the first, if there is one. `warn` receives a text on the steps as a cycle.
  `tell` is called now and then during SamEvaluationCompute() with the work under way, the done part of it, and the done
  part of all work (0: unknown); NULL: nobody asks.
*/
typedef struct {
  SamElasticity             bodies;
  const SamFourierSettings *settings; /* of the transforms, borrowed; NULL: those of the bodies */
  const char               *name;     /* of the origin of the bodies, for messages; borrowed */
  PetscInt                  steps;
  PetscBool                 before;
  PetscBool                 slides;      /* the surfaces slide past each other, so that points of body 2 move */
  PetscBool                 yields[2];   /* whether body 1, body 2 yields below its surface, */
  PetscInt                  layers;      /* in so many layers, */
  const double             *middle;      /* the depths of whose middles are these, m, borrowed, */
  PetscReal                 yield_depth; /* down to this depth, m */
  PetscBool                 slips;       /* steps follow each other, and have slips, not velocities of slip */
  PetscErrorCode (*read)(void *context, PetscInt step, SamStepField field, double values[]);
  PetscErrorCode (*number)(void *context, PetscInt step, SamStepNumber number, double *value);
  PetscErrorCode (*conditions)(void *context, PetscInt step, SamConditions conditions, SamControl *control);
  /* the stress by the plastic strain of a body (1 or 2), a component of its mean over a layer, from the surface down:
     this rank's rows, Pa; NULL: it is not known */
  PetscErrorCode (*residual)(void *context, PetscInt step, PetscInt body, PetscInt component, PetscInt layer,
                             double values[]);
  PetscErrorCode (*warn)(void *context, const char text[]);
  PetscErrorCode (*tell)(void *context, const char work[], double part, double whole);
  void *context;
} SamStressSource;
/*
  SamEvaluationSetUp - takes a source, once, checks the settings together, and creates the stresses' kernels.
  Collective. Errors: SAM_ERR_USER for a body that is rigid or whose stresses are not available, a depth above zero but
  below a millionth of a cell, a section outside of the grid, a cycle of one step, passing points of more than one or
  below a section along y, Ruiz's parameters away from the surface or of passing points.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationSetUp(SamEvaluation evaluation, const SamStressSource *source);

/* A result: numbers of shape (time, z, y, x), or (z, y, x) of all steps together. */
typedef struct {
  const char *name, *unit, *text;
  PetscBool   of_cycle;
} SamStressDataset;
enum { SAM_TIME, SAM_Z, SAM_Y, SAM_X, SAM_STRESS_AXES };
#define SAM_STRESS_DATASETS 64 /* most results */
/* SamStressLayout - the shape of the results, after SamEvaluationSetUp(). The arrays are borrowed. */
typedef struct {
  PetscInt         body;
  PetscBool        section, cycle; /* below one line of cells; there are parameters of a cycle */
  PetscBool        own;            /* points are body 2's own, which lie under the cells before the surfaces slide */
  PetscInt         n[SAM_STRESS_AXES];          /* of all ranks */
  const double    *coordinate[SAM_STRESS_AXES]; /* s, m */
  PetscInt         row, rows;                   /* along y: this rank's part of maps, else all of it */
  PetscInt         datasets;
  SamStressDataset dataset[SAM_STRESS_DATASETS];
  double           memory;    /* bytes that SamEvaluationCompute() needs on this rank */
  double           half;      /* m: half width of the contact, in which -depths are given; 0: in m */
  PetscInt         half_step; /* of that step */
} SamStressLayout;
PETSC_EXTERN const SamStressLayout *SamEvaluationGetLayout(SamEvaluation evaluation);
/*
  SamEvaluationAddParameters - appends the body, its elasticity, and the constants of the parameters that are wanted,
  after SamEvaluationSetUp(). Not collective.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationAddParameters(SamEvaluation evaluation, SamParameters *parameters);
/*
  SamEvaluationCompute - evaluates all steps and hands over each result as it is found: this rank's block of a dataset
  of the layout, which begins at `start` and has `count` numbers along each axis; those of a cycle begin at time 0. A
  map's blocks are its rows at one depth, a section's are some depths. The callback is called alike on all ranks, with
  arrays that are the evaluation's. Collective. Errors: SAM_ERR_USER for body 2 where its points under the contact are
  not on the grid.
*/
typedef PetscErrorCode (*SamEvaluationWrite)(void *context, PetscInt dataset, const PetscInt start[SAM_STRESS_AXES],
                                             const PetscInt count[SAM_STRESS_AXES], const double values[]);
PETSC_EXTERN PetscErrorCode SamEvaluationCompute(SamEvaluation evaluation, SamEvaluationWrite write, void *context);

/* A largest value, and its x, y and z (m); of equal ones the first in the order z, y, x. NaN: there is none. */
typedef struct {
  double value, place[3];
} SamLargest;
/*
  SamLargestSeries - the largest values of each step: of the von Mises and the first principal stress, whether they are
  wanted or not; where there is a map of the surface, of the stress xx and the first principal stress at the edge of
  contact (SamStressAtEdge()); in each of several materials in which a depth is, of the von Mises stress, and of the
  tension zz and the shear sqrt(xz^2 + yz^2) at its bottom. And the largest value of each fatigue parameter that is
  wanted.
*/
typedef struct {
  char              name[48], text[96]; /* of its dataset: name_max in each step; what it is */
  char              shown[64];          /* the same as it is printed; "": it is not */
  const char       *unit;
  PetscBool         of_cycle;
  PetscInt          material; /* of which it is the largest value, from 1; 0: of all */
  PetscInt          places;   /* coordinates of the place: z is 0 at the edge, and not told */
  PetscInt          missing;  /* steps with an edge of which too little is smooth and resolved */
  PetscInt          count;    /* steps; 1 of a cycle */
  const SamLargest *step;     /* borrowed */
} SamLargestSeries;
/* SamEvaluationGetLargest - the k-th of them after SamEvaluationCompute(); false: there are no more. Not collective. */
PETSC_EXTERN PetscBool SamEvaluationGetLargest(SamEvaluation evaluation, PetscInt k, SamLargestSeries *series);

/* ---- files ---- */

/*
  SamStressFile - an HDF5 file with the results of an evaluation, their coordinates, and the largest values of each step
  in /history. Every dataset has the attributes `units` and `long_name` and its dimension scales, so that h5py and
  xarray open it.
*/
typedef struct _n_SamStressFile *SamStressFile;
/*
  SamStressFileCreate - creates the file with all datasets; replaces an older file of petsam. It takes the name only
  when SamStressFileFinish() has completed it. Collective. Errors: SAM_ERR_FILE, also when there is no space for it.
  SamStressFileWrite - a SamEvaluationWrite with the file as its context. Collective. Errors: SAM_ERR_FILE.
  SamStressFileWriteLargest - largest values: of steps in /history, as name_max and its place name_max_x, ...; of a
  cycle as attributes of its dataset. Collective. Errors: SAM_ERR_FILE.
  SamStressFileSetText - an attribute of the root group. Collective. Errors: SAM_ERR_FILE.
  SamStressFileSetHistory - a number for each step in /history, with its unit. Collective. Errors: SAM_ERR_FILE.
  SamStressFileFinish - completes the file and gives it its name. Collective. Errors: SAM_ERR_FILE.
  SamStressFileAbandon - removes a file that has not been finished, before the program is aborted. Not collective.
  SamStressFileDestroy - removes a file that has not been finished. Collective.
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
