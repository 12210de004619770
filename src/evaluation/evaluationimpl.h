/* The inside of SamEvaluation. */
#ifndef PETSAM_EVALUATIONIMPL_H
#define PETSAM_EVALUATIONIMPL_H

#include <petsam/evaluation.h>
#include <petsam/private/quantities.h>
#include <petsam/private/stressimpl.h>

/* A largest value so far, and the number of its point, counted along x, y and z. */
typedef struct {
  double value, point;
} SamLargestPoint;

/* The largest values of a step. */
typedef struct {
  SamLargestPoint mises, principal;
  SamLargestPoint layer[SAM_LAYERS + 1];    /* von Mises stress in each layer, and in the substrate */
  SamLargestPoint interface[SAM_LAYERS][2]; /* tension zz and shear at the bottom of each layer */
  SamLargest      edge[2];                  /* at the contact's edge: stress xx, principal stress */
  PetscBool       edge_lost;                /* there is an edge, which is not found */
} SamStepLargest;

struct _n_SamEvaluation {
  MPI_Comm comm;
  /* settings */
  PetscInt            body, depths;
  PetscReal          *depth;
  char               *depths_text; /* of -depths */
  int                *side;        /* of an interface at that depth: -1 above, 1 below, 0 not said, or none is there */
  PetscBool           section;
  SamSectionAxis      axis;
  PetscReal           place; /* of the section: y along x, x along y, m */
  PetscBool           wants[SAM_QUANTITIES];
  PetscBool           passing; /* the states of a cycle are the stresses of a row of cells, and those far from it */
  SamFatigueConstants constants[SAM_LAYERS + 1]; /* but for the body's */
  PetscInt            materials; /* that have constants of their own, layers first; 1: all have the first ones */
  SamFatigueAverage   average;
  PetscReal           length, *weight; /* of the average, m; the part of each depth in it */
  const char         *dash;            /* before the names of settings in messages, where options gave them */
  /* bodies */
  SamElasticity             elasticity;
  const SamFourierSettings *settings;
  const char               *of; /* whose bodies they are */
  SamGrid                   grid;
  SamStress                 stress;
  PetscInt                  index;  /* of the section's line of cells */
  SamEvaluationSource       source; /* of the steps */
  /* results */
  SamEvaluationWrite   write;
  void                *write_context;
  SamEvaluationMonitor monitor;
  void                *monitor_context;
  SamStepLargest      *largest;                 /* of each step */
  SamLargestPoint      fatigue[SAM_QUANTITIES]; /* of the cycle */
};

/*
  SamPoints - the points of which a rank has the stresses: of a map its rows at one depth, of a section its depths. The
  stress of step s is stress + s * SAM_STRESS_COMPONENTS * count, component after component.
*/
typedef struct {
  PetscInt count;         /* points */
  PetscInt depth, depths; /* first depth, number of depths */
  double   first;         /* number of the first point */
  double  *stress;        /* Pa */
} SamPoints;

/* SamMapsCompute - everything on whole planes, one depth after another (maps.c). Collective. */
PETSC_INTERN PetscErrorCode SamMapsCompute(SamEvaluation e);
/* SamLinesCompute - everything on a section, some steps at a time (lines.c). Collective. */
PETSC_INTERN PetscErrorCode SamLinesCompute(SamEvaluation e);
/* SamMapsMemory, SamLinesMemory - the memory of this rank, bytes. Not collective. */
PETSC_INTERN double SamMapsMemory(SamEvaluation e);
PETSC_INTERN double SamLinesMemory(SamEvaluation e);

/* SamEvaluationReadTractions - pressure and both shears of a step, this rank's rows. Collective. */
PETSC_INTERN PetscErrorCode SamEvaluationReadTractions(SamEvaluation e, PetscInt step,
                                                       double *const to[SAM_STRESS_TRACTIONS]);
/*
  SamBulkStressAt - the bulk stress of a step and the residual stress at a depth: of bulk stress a layer has the strains
  of the substrate. SamStressAddBulk - adds them to the stresses of points. Neither is collective.
*/
PETSC_INTERN void SamBulkStressAt(SamEvaluation e, PetscInt step, PetscInt depth, double bulk[SAM_BULK_COMPONENTS]);
PETSC_INTERN void SamStressAddBulk(SamEvaluation e, PetscInt step, const SamPoints *points, double stress[]);
/* SamLayerAt - the layers of the body, and the number of that which has this depth, count: the substrate. */
PETSC_INTERN const SamLayers *SamLayerAt(SamEvaluation e, PetscInt depth, PetscInt *layer);
/* SamQuantitiesWrite - computes what is wanted of a step's stresses and hands it over (quantities.c). Collective. */
PETSC_INTERN PetscErrorCode SamQuantitiesWrite(SamEvaluation e, PetscInt step, const SamPoints *points,
                                               const double stress[]);
/*
  SamEdgeStressCompute - keeps the largest stresses at the contact's edge of a step, whose map at depth 0, without bulk
  stress, is in `field` (edge.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamEdgeStressCompute(SamEvaluation e, PetscInt step, Vec field);
/* SamLargestKeep - keeps a value if it is the largest so far. Not collective. */
PETSC_INTERN void SamLargestKeep(SamLargestPoint *largest, double value, double point);
/* SamLargestAgree - the largest value of all ranks; of equal ones the one whose n numbers come first. Collective. */
PETSC_INTERN PetscErrorCode SamLargestAgree(MPI_Comm comm, double *value, int n, double place[]);

/*
  SamCycleWanted - whether a fatigue parameter is asked for: then the stresses of all steps are needed at a time.
  SamCycleWrite - computes the fatigue parameters from the stresses of all steps and hands them over (cycle.c). `done`
  is the part of all points that came before, `share` that of these. Collective.
*/
PETSC_INTERN PetscBool      SamCycleWanted(SamEvaluation e);
PETSC_INTERN PetscErrorCode SamCycleWrite(SamEvaluation e, const SamPoints *points, double done, double share);

/*
  SamAverageSetUp - the depths of the average, and their parts (average.c). Errors: SAM_ERR_USER.
  SamAverageAdd - adds the part of depth k in it: `from` and `to` are n values, lines of `length` points. Neither is
  collective.
*/
PETSC_INTERN PetscErrorCode SamAverageSetUp(SamEvaluation e);
PETSC_INTERN PetscErrorCode SamAverageAdd(SamEvaluation e, PetscInt k, PetscInt length, ptrdiff_t n,
                                          const double from[], double to[]);

/* SamEvaluationTell - calls the monitor. Not collective. */
PETSC_INTERN PetscErrorCode SamEvaluationTell(SamEvaluation e, const char work[], double part, double whole);
/*
  SamEvaluationTakeDepths - takes over depths, which `said` names in messages, and the sides of interfaces there, NULL:
  both. Not collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamEvaluationTakeDepths(SamEvaluation e, const char said[], PetscInt n,
                                                    const PetscReal depths[], const int sides[]);

#endif
