/* The inside of SamEvaluation. */
#ifndef PETSAM_EVALUATIONIMPL_H
#define PETSAM_EVALUATIONIMPL_H

#include <petsam/private/evaluation.h>
#include <petsam/private/fatigue.h>
#include <petsam/private/fourier.h>
#include <petsam/private/problemimpl.h>
#include <petsam/private/stressimpl.h>

/* ---- quantities (quantities.c) ---- */

/* A constant of a fatigue parameter, and its option. */
typedef struct {
  const char *name, *help, *unit;
  SamRange    range;
  size_t      place; /* offset in SamFatigueConstants */
} SamQuantityConstant;

/*
  SamQuantity - a row of the table of all quantities, of a step or of the cycle; each has one function:
    name       in -quantities, or -fatigue
    part       its datasets, one for each component
    of_step    computes `arrays` arrays from the stresses s at points; NULL: the stress itself. A row with the same
               function as the one before takes these arrays over.
    last       makes the component, in the place of the first array, from them; NULL: the arrays are the components
    of_cycle   instead: a parameter of the cycle; `more`: the other components
    of_part    instead: the number of a part's type, from 1, whose quantity it is (SamQuantitiesAddParts())
    elastic    true: it contains strains, by the constants of elastic bodies
    shown      its name where the largest value is printed
    with       the option that its constants need
*/
enum { SAM_QUANTITY_PARTS = SAM_STRESS_COMPONENTS, SAM_QUANTITIES = 24 /* most quantities */ };
typedef struct {
  const char *name;
  struct {
    const char *name, *unit, *text;
  } part[SAM_QUANTITY_PARTS];
  int arrays;
  void (*of_step)(SamEvaluation e, const SamPoints *points, const double *const s[], double *const values[]);
  void (*last)(PetscInt n, double *const values[]);
  SamFatigueParameter *of_cycle;
  PetscInt             of_part;
  PetscBool            elastic;
  const char          *shown, *with;
  SamQuantityConstant  constant[2];
} SamQuantity;
PETSC_INTERN SamQuantity SamQuantityTable[]; /* ends with a name of NULL */
/* SamQuantitiesAddParts - appends those of the registered parts. Not collective. */
PETSC_INTERN void SamQuantitiesAddParts(void);
/* SamQuantityWanted - true if that function or parameter of the cycle is wanted. Not collective. */
PETSC_INTERN PetscBool SamQuantityWanted(SamEvaluation e, SamFatigueParameter *of_cycle);
/* SamQuantityNames - writes the names of the quantities of a step, or of the cycle, with commas. Not collective. */
PETSC_INTERN void SamQuantityNames(PetscBool of_cycle, char text[], size_t size);
/* SamQuantitiesList - fills the layout's list of datasets with the requested ones. Not collective. */
PETSC_INTERN void SamQuantitiesList(SamEvaluation e);
/* SamQuantitiesWrite - computes the requested quantities of a step's stresses and passes them on. Collective. */
PETSC_INTERN PetscErrorCode SamQuantitiesWrite(SamEvaluation e, PetscInt step, const SamPoints *points,
                                               const double stress[]);
/* SamEvaluationHandOver - passes component k of a quantity at points to the receiver. Collective. */
PETSC_INTERN PetscErrorCode SamEvaluationHandOver(SamEvaluation e, PetscInt quantity, PetscInt k, PetscInt step,
                                                  const SamPoints *points, const double values[]);

/* ---- the evaluation ---- */

typedef enum { SAM_AVERAGE_NONE, SAM_AVERAGE_POINT, SAM_AVERAGE_LINE, SAM_AVERAGE_AREA } SamFatigueAverage;

/* The numbers of largest values of a step; those of materials begin at SAM_LARGEST_OWN */
enum { SAM_LARGEST_MISES, SAM_LARGEST_PRINCIPAL, SAM_LARGEST_EDGE_XX, SAM_LARGEST_EDGE_PRINCIPAL, SAM_LARGEST_OWN };
/* Each material has its von Mises stress, and tension and shear at its bottom; the last material has only the first */
enum { SAM_OWN_MISES, SAM_OWN_PRINCIPAL, SAM_OWN_TENSION, SAM_OWN_SHEAR, SAM_OWN };

/* The remedy for a list of constants of a wrong length */
#define SAM_ONE_EACH "give one number, or one for each layer and the substrate"

struct _n_SamEvaluation {
  MPI_Comm comm;
  /* what the user requests */
  PetscInt            body;
  char               *depths_text; /* text of -depths */
  PetscBool           section;
  SamSectionAxis      axis;
  PetscReal           place; /* place of the section: y along x, x along y, m */
  PetscBool           wants[SAM_QUANTITIES];
  PetscBool           cycle;   /* a parameter of the cycle is wanted: the stresses of all steps are needed at once */
  PetscBool           passing; /* points travel: a cycle's states are the stresses of a row of cells, and far away */
  SamFatigueConstants constants[SAM_MATERIALS]; /* without the constants of the body */
  PetscInt materials; /* number of materials with their own constants, from the top; 1: constants[0] holds for all */
  SamFatigueAverage         average;
  PetscReal                 length; /* length of the average, m */
  SamFourierSettings        transforms;
  const SamFourierSettings *settings; /* of the transforms; NULL: those of the bodies */
  /* bodies and steps */
  SamGrid         grid;
  SamStress       stress;
  SamStressSource source;
  SamProblem      problem; /* of the bodies, with their laws */
  SamControl     *control; /* conditions of each step */
  PetscReal *slide; /* (steps + 1, 2), from step -1 on: m, of body 2's own points; NULL: points are those of the grid */
  /* places */
  PetscInt        depths;
  PetscReal      *depth;
  int            *side;   /* side of an interface at that depth: -1 above, 1 below, 0: no side given, or no interface */
  PetscReal      *weight; /* weight of each depth in the average */
  PetscInt        index;  /* index of the section's line of cells */
  SamStressPlaces places;
  SamStressParts  parts; /* of the stresses, besides those by tractions */
  SamStressLayout layout;
  double         *coordinate[SAM_STRESS_AXES];
  /* results */
  SamEvaluationWrite write;
  void              *write_context;
  PetscInt           kinds;     /* number of largest values per step */
  SamLargest        *largest;   /* (kinds, steps), then those of the cycle for each quantity */
  PetscInt           edge_lost; /* number of steps whose edge was not found */
};

/* SamMapsCompute - computes everything on whole planes, one depth after another (maps.c). Collective. */
PETSC_INTERN PetscErrorCode SamMapsCompute(SamEvaluation e);
/* SamLinesCompute - computes everything on a section, some steps at a time (lines.c). Collective. */
PETSC_INTERN PetscErrorCode SamLinesCompute(SamEvaluation e);
/* SamMapsMemory, SamLinesMemory - return the memory of this rank, bytes. Not collective. */
PETSC_INTERN double SamMapsMemory(SamEvaluation e);
PETSC_INTERN double SamLinesMemory(SamEvaluation e);
/*
  SamEvaluationReadTractions - reads pressure and both shears of a step, this rank's rows; `own`: at the body's own
  points (SamPointsMove()).
  Collective.
*/
PETSC_INTERN PetscErrorCode SamEvaluationReadTractions(SamEvaluation e, PetscInt step, PetscBool own,
                                                       double *const to[SAM_STRESS_TRACTIONS]);
/*
  The body's own points where surfaces slide (points.c).
  SamPointsSetUp - reads the slides of the surfaces, if the body's points do not stay with the grid. Collective.
  SamPointsSlide - returns the displacement of the body's points against the cells in a step, m; NULL: none. Not
  collective.
  SamPointsMove - moves a field from the cells in a step to the body's points. Collective.
  SamPointsCheck - checks that all points under a pressure are on the grid. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode   SamPointsSetUp(SamEvaluation e);
PETSC_INTERN const PetscReal *SamPointsSlide(SamEvaluation e, PetscInt step);
PETSC_INTERN PetscErrorCode   SamPointsMove(SamEvaluation e, PetscInt step, double field[]);
PETSC_INTERN PetscErrorCode   SamPointsCheck(SamEvaluation e, PetscInt step, const double pressure[]);
/* SamEvaluationTell - calls the monitor. Not collective. */
PETSC_INTERN PetscErrorCode SamEvaluationTell(SamEvaluation e, const char work[], double part, double whole);

/* ---- depths (depths.c) ---- */

/* SamEvaluationBody - returns the body whose stresses are wanted; borrowed. Not collective. */
PETSC_INTERN SamBody SamEvaluationBody(SamEvaluation e);
/*
  SamDepthsAreRelative - returns true if a depth of the text is a multiple of the half width, such as 0.5a. Not
  collective.
  SamDepthsRead - reads the depths of -depths; relative ones are multiplied by this half width of the contact (m).
  SamDepthsSetUp - finds the half width if it is needed, and the sides of interfaces, and checks the depths.
  SamDepthsTake - takes over depths, called `said` in messages, and the sides of interfaces (NULL: both).
  Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscBool      SamDepthsAreRelative(const char depths[]);
PETSC_INTERN PetscErrorCode SamDepthsRead(SamEvaluation e, PetscReal half);
PETSC_INTERN PetscErrorCode SamDepthsSetUp(SamEvaluation e);
PETSC_INTERN PetscErrorCode SamDepthsTake(SamEvaluation e, const char said[], PetscInt n, const PetscReal depths[],
                                          const int sides[]);
/* SamDivide - divides a text at a character, in place; returns the number of parts, and at most `most` parts. Not
   collective. */
PETSC_INTERN int SamDivide(char text[], char at, char *parts[], int most);
/* SamReadLength - reads a length in m, or with a unit behind it; true if it is a finite number. Not collective. */
PETSC_INTERN PetscBool SamReadLength(const char text[], double *value);

/* ---- largest values (largest.c) ---- */

/* SamLargestClear - clears all largest values. SamLargestAgree - finds those of all ranks. Collective. */
PETSC_INTERN PetscErrorCode SamLargestClear(SamEvaluation e);
PETSC_INTERN PetscErrorCode SamLargestAgree(SamEvaluation e);
/* SamLargestOfStep - updates the largest values by the stresses s, and their von Mises stresses, at points. Not
   collective. */
PETSC_INTERN void SamLargestOfStep(SamEvaluation e, PetscInt step, const SamPoints *points,
                                   const double *const s[SAM_STRESS_COMPONENTS], const double mises[]);
/* SamLargestOfCycle - updates the largest value by a quantity at the i-th point. Not collective. */
PETSC_INTERN void SamLargestOfCycle(SamEvaluation e, PetscInt quantity, const SamPoints *points, PetscInt i,
                                    double value);
/*
  SamLargestAtEdge - finds the largest stresses at the contact's edge of a step; `field`: the map at depth 0 at the
  grid's points, without uniform stress (edge.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamLargestAtEdge(SamEvaluation e, PetscInt step, Vec field);
/* SamLargestKeep - stores a value and its place if it is the largest of its kind so far. Not collective. */
PETSC_INTERN void SamLargestKeep(SamEvaluation e, PetscInt kind, PetscInt step, double value, const double place[3]);

/* ---- cycles ---- */

/*
  SamCycleWrite - computes the fatigue parameters from the stresses of all steps and passes them on (fatiguecycle.c).
  `done` is the part of all points before these, `share` the part of these points. Collective.
  SamCycleCheckClosed - warns if the steps belong to several cycles of a life, or contain more than one cycle or a
  lead-in; or if the tractions before the first step (zero before step 1) differ from those of the last step. In the
  last case the cycle is not closed, or does not yet repeat itself (closed.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamCycleWrite(SamEvaluation e, const SamPoints *points, double done, double share);
PETSC_INTERN PetscErrorCode SamCycleCheckClosed(SamEvaluation e);
/*
  SamAverageSetUp - sets the depths of the average, and their weights (average.c). Errors: SAM_ERR_USER.
  SamAverageAdd - adds the contribution of depth k: `from` and `to` are n values, lines of `length` points. Neither is
  collective.
*/
PETSC_INTERN PetscErrorCode SamAverageSetUp(SamEvaluation e);
PETSC_INTERN PetscErrorCode SamAverageAdd(SamEvaluation e, PetscInt k, PetscInt length, ptrdiff_t n,
                                          const double from[], double to[]);

#endif
