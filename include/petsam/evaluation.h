/* Stresses in a body under the tractions of load steps, quantities of them, and fatigue parameters of a cycle. */
#ifndef PETSAM_EVALUATION_H
#define PETSAM_EVALUATION_H

#include <petsam/control.h>
#include <petsam/elasticity.h>
#include <petsam/fatigue.h>

/* The quantities that are evaluated, each of one or more components, by their names in a stress file. */
typedef enum {
  SAM_QUANTITY_STRESS,    /* stress_xx ... stress_yz, Pa */
  SAM_QUANTITY_MISES,     /* mises, Pa */
  SAM_QUANTITY_PRINCIPAL, /* principal_1 >= principal_2 >= principal_3, Pa */
  SAM_QUANTITY_SHEAR_MAX, /* shear_max, Pa: half the difference of principal_1 and principal_3 */
  SAM_QUANTITY_STRAIN,    /* strain_xx ... strain_yz, tensor shear strains */
  /* of all steps together, in the order of SamFatigueParameter: */
  SAM_QUANTITY_CROSSLAND,    /* crossland, Pa */
  SAM_QUANTITY_DANG_VAN,     /* dang_van, Pa */
  SAM_QUANTITY_FINDLEY,      /* findley, Pa; findley_normal_x, _y, _z of the critical plane, as the next two have */
  SAM_QUANTITY_SWT,          /* swt, Pa */
  SAM_QUANTITY_FATEMI_SOCIE, /* fatemi_socie */
  SAM_QUANTITY_RUIZ,         /* ruiz_1, J/m2; ruiz_2, Pa J/m2; on the surface, else NaN */
  SAM_QUANTITIES
} SamQuantity;
/* SamQuantityComponents - number of the components of a quantity. Not collective. */
PETSC_INTERN PetscInt SamQuantityComponents(SamQuantity quantity);

/*
  SamFatigueAverage - of which stress fatigue parameters are computed, by the theory of critical distances: at a point
  half a length below the surface, as a mean over the line from the surface to two lengths below it, or over the half
  disc of that radius below the surface, in the plane of x and z (below a line of cells along y: of y and z). Source:
  Taylor 2007, The Theory of Critical Distances, chapter 3.
*/
typedef enum { SAM_AVERAGE_NONE, SAM_AVERAGE_POINT, SAM_AVERAGE_LINE, SAM_AVERAGE_AREA } SamFatigueAverage;

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
  SamEvaluation - the stresses in one body under the tractions of load steps: at depths below all cells (maps) or below
  a line of them (a section); the quantities that are wanted of them; and fatigue parameters over the steps, taken as
  one closed cycle. Maps are evaluated depth by depth, and each step is read once per depth: the steps of a
  SamEvaluationSource need not be in memory together. Fatigue parameters keep 48 bytes per cell and step.
  Results are the same to the last bit on any number of ranks.
*/
typedef struct _n_SamEvaluation *SamEvaluation;

/* SamEvaluationCreate - of body 2, on its surface, without steps yet. SamEvaluationDestroy. Both are collective. */
PETSC_EXTERN PetscErrorCode SamEvaluationCreate(MPI_Comm comm, SamEvaluation *evaluation);
PETSC_EXTERN PetscErrorCode SamEvaluationDestroy(SamEvaluation *evaluation);
/*
  The settings, which are those of SamEvaluationSetFromOptions(). None is collective. Errors: SAM_ERR_USER.
    SetBody             1 or 2 (default); z points into it. -body
    SetDepths           n depths (m), >= 0 and increasing; default: 0. One at an interface of layers becomes two, the
                        second, larger by rounding, below it. -depths
    SetSection          only the cells nearest to the plane y = place (SAM_SECTION_X: along x) or x = place, m. -section
    SetQuantities       those that are wanted; default: stress and mises. -quantities, and -fatigue for parameters
    SetPassing          fatigue parameters of points that pass along x, of one step: the stresses of each row of cells,
                        and none but the bulk stress far from the contact, are the cycle of all its points. -passing
    SetFatigueConstants without those of the body, n = 1: the same everywhere, else of each layer and then of the
                        substrate, if that is not rigid. -fatigue_crossland_alpha, ...
    SetFatigueLength    averages the stresses of fatigue parameters below each cell of the surface over a length (m),
                        in place of the depths and of other quantities. -fatigue_length, -fatigue_average
*/
PETSC_EXTERN PetscErrorCode SamEvaluationSetBody(SamEvaluation evaluation, PetscInt body);
PETSC_EXTERN PetscErrorCode SamEvaluationGetBody(SamEvaluation evaluation, PetscInt *body);
PETSC_EXTERN PetscErrorCode SamEvaluationSetDepths(SamEvaluation evaluation, PetscInt n, const PetscReal depths[]);
PETSC_EXTERN PetscErrorCode SamEvaluationSetSection(SamEvaluation evaluation, SamSectionAxis axis, PetscReal place);
PETSC_EXTERN PetscErrorCode SamEvaluationSetPassing(SamEvaluation evaluation, PetscBool passing);
PETSC_EXTERN PetscErrorCode SamEvaluationSetQuantities(SamEvaluation evaluation, const PetscBool wants[SAM_QUANTITIES]);
PETSC_EXTERN PetscErrorCode SamEvaluationSetFatigueConstants(SamEvaluation evaluation, PetscInt n,
                                                             const SamFatigueConstants constants[]);
PETSC_EXTERN PetscErrorCode SamEvaluationSetFatigueLength(SamEvaluation evaluation, PetscReal length,
                                                          SamFatigueAverage average);
/* SamEvaluationSetFromOptions - reads these options. Collective. Errors: SAM_ERR_USER. */
PETSC_EXTERN PetscErrorCode SamEvaluationSetFromOptions(SamEvaluation evaluation, const SamOptions *from);
/*
  SamEvaluationNeedsHalfWidth - whether -depths has depths in half widths of the contact, which
  SamEvaluationSetHalfWidth() sets (m). Neither is collective. Errors: SAM_ERR_USER for depths that do not increase.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationNeedsHalfWidth(SamEvaluation evaluation, PetscBool *needs);
PETSC_EXTERN PetscErrorCode SamEvaluationSetHalfWidth(SamEvaluation evaluation, PetscReal half);
/*
  SamEvaluationSetElasticity - the bodies, referenced; `settings` of the transforms, NULL: those of the elasticity.
  `source` names the origin of the bodies in messages. Settings and source are not copied. Collective.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationSetElasticity(SamEvaluation evaluation, SamElasticity elasticity,
                                                       const SamFourierSettings *settings, const char source[]);

/*
  SamEvaluationSource - the load steps, read when they are needed. `read`: copies this rank's rows of a field;
  collective. `bulk`: the bulk stress of the body in each step (Pa), and the factors on load cases. The array is the
  caller's.
*/
typedef struct {
  PetscInt steps;
  const double (*bulk)[SAM_BULK_AND_CASES];
  PetscErrorCode (*read)(void *context, PetscInt step, SamStepField field, double values[]);
  void *context;
} SamEvaluationSource;
PETSC_EXTERN PetscErrorCode SamEvaluationSetSource(SamEvaluation evaluation, const SamEvaluationSource *source);

/*
  SamEvaluationSetUp - checks the settings together, and creates the stresses' kernels. SamEvaluationCompute() calls
  it. Collective. Errors: SAM_ERR_USER for a body that is rigid or whose stresses are not available, a depth above zero
  but below a millionth of a cell, a section outside of the grid, a cycle of one step, passing points of more than
  one or below a section along y, Ruiz's parameters away from the surface or of passing points; PETSC_ERR_ORDER without
  elasticity.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationSetUp(SamEvaluation evaluation);
/*
  SamEvaluationSetMonitor - called now and then during SamEvaluationCompute() with the work under way, the done part of
  it, and the done part of all work (0: unknown). Not collective.
*/
typedef PetscErrorCode (*SamEvaluationMonitor)(void *context, const char work[], double part, double whole);
PETSC_EXTERN PetscErrorCode SamEvaluationSetMonitor(SamEvaluation evaluation, SamEvaluationMonitor monitor,
                                                    void *context);
/*
  SamEvaluationCompute - evaluates all steps and hands over each result as it is found: this rank's values of a
  component of a quantity, of a map those of its rows at one depth (`depth`, `depths` being 1), of a section those of
  `depths` depths from `depth` on, (depths, cells along). `step` is 0 for a parameter of all steps together. The
  callback is called alike on all ranks, with arrays that are the evaluation's. Collective.
*/
typedef PetscErrorCode (*SamEvaluationWrite)(void *context, SamQuantity quantity, PetscInt component, PetscInt step,
                                             PetscInt depth, PetscInt depths, const double values[]);
PETSC_EXTERN PetscErrorCode SamEvaluationCompute(SamEvaluation evaluation, SamEvaluationWrite write, void *context);

/* The shape of an evaluation's results. The arrays are borrowed. */
typedef struct {
  PetscInt         steps, depths;
  const PetscReal *times, *depth; /* s, m */
  PetscBool        section;       /* only one line of cells: */
  SamSectionAxis   axis;
  PetscInt         index;
  PetscBool        wants[SAM_QUANTITIES];
} SamStressLayout;
/*
  After SamEvaluationSetUp(); none is collective:
    SamEvaluationGetLayout     without the times, which an evaluation does not have; the depths are borrowed
    SamEvaluationGetMemory     bytes that SamEvaluationCompute() needs on this rank
    SamEvaluationHasCycle      whether a fatigue parameter is wanted
    SamEvaluationAddParameters appends the body, its elasticity, and the constants of the parameters that are wanted
*/
PETSC_EXTERN PetscErrorCode SamEvaluationGetLayout(SamEvaluation evaluation, SamStressLayout *layout);
PETSC_EXTERN PetscErrorCode SamEvaluationGetMemory(SamEvaluation evaluation, double *bytes);
PETSC_EXTERN PetscErrorCode SamEvaluationHasCycle(SamEvaluation evaluation, PetscBool *has);
PETSC_EXTERN PetscErrorCode SamEvaluationAddParameters(SamEvaluation evaluation, SamParameters *parameters);

/* The largest value of a result, and its x, y and z (m); of equal ones the first in the order z, y, x. */
typedef struct {
  double value, place[3];
} SamLargest;
/*
  SamEvaluationGetLargest - after SamEvaluationCompute(): of SAM_QUANTITY_MISES or the first of SAM_QUANTITY_PRINCIPAL
  in a step, whether they are wanted or not, or of a fatigue parameter that is wanted.
  SamEvaluationGetEdgeLargest - where a map of the surface has been evaluated: the largest stress xx and the largest
  principal stress of a step at the edge of contact (SamStressAtEdge()). NaN without one; `lost`: there is one, but too
  little of it is smooth and resolved. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationGetLargest(SamEvaluation evaluation, SamQuantity quantity, PetscInt step,
                                                    SamLargest *largest);
PETSC_EXTERN PetscErrorCode SamEvaluationGetEdgeLargest(SamEvaluation evaluation, PetscInt step, SamLargest largest[2],
                                                        PetscBool *lost);
/*
  SamEvaluationGetLayers - the number of layers of the body, after SamEvaluationSetUp().
  SamEvaluationGetLayerLargest - of a layer (from 0; their number: the substrate) in a step, after
  SamEvaluationCompute(): the largest von Mises stress; and the largest tension zz and shear sqrt(xz^2 + yz^2) at its
  bottom. NaN where no depth is there. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamEvaluationGetLayers(SamEvaluation evaluation, PetscInt *layers);
PETSC_EXTERN PetscErrorCode SamEvaluationGetLayerLargest(SamEvaluation evaluation, PetscInt layer, PetscInt step,
                                                         SamLargest largest[3]);

#endif
