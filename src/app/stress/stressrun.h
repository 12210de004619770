/* A run of petsam-stress. */
#ifndef PETSAM_APP_STRESS_RUN_H
#define PETSAM_APP_STRESS_RUN_H

#include <petsam/private/arguments.h>
#include "request.h"
#include <petsam/control.h>

/* A largest value so far, and the number of its point, counted along x, y and z. */
typedef struct {
  double value, point;
} SamLargest;

/* The same at the contact's edge, with its place, m. */
typedef struct {
  double value, x, y;
} SamEdgeLargest;

typedef struct {
  SamStressRequest request;
  SamResults       results;
  SamStressFile    file;
  SamGrid          grid; /* of the results */
  PetscReal        young, poisson;
  PetscInt         index; /* of the section's line of cells */
  PetscInt         steps, *saved;
  PetscReal       *times;
  double (*bulk)[SAM_BULK_COMPONENTS];      /* bulk stress of the body in each step, Pa */
  SamLargest     *mises, *principal;        /* of each step */
  SamEdgeLargest *edge_xx, *edge_principal; /* likewise */
  PetscBool      *edge_left;                /* of each step: it has an edge of contact, which is not found */
  SamLargest      fatigue[SAM_QUANTITIES];  /* of the cycle */
  PetscBool       quiet, writing;
  PetscLogDouble  start, told; /* when the computation began, and the last line was printed, s */

  SamFourierSettings transforms;
} SamStressRun;

/* SamStressRunSetUp - reads all options and the results' parameters; writes nothing. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunSetUp(SamStressRun *run, const SamArguments *arguments);
/* SamStressRunCompute - computes and writes everything. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunCompute(SamStressRun *run);
/* SamStressRunTearDown - destroys all objects, also after an error. Collective. */
PETSC_INTERN PetscErrorCode SamStressRunTearDown(SamStressRun *run);

/* ---- its parts ---- */

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
PETSC_INTERN PetscErrorCode SamMapsCompute(SamStressRun *run);
/* SamLinesCompute - everything on a section, some steps at a time (lines.c). Collective. */
PETSC_INTERN PetscErrorCode SamLinesCompute(SamStressRun *run);
/* SamMapsMemory, SamLinesMemory - the memory of this rank, bytes. Not collective. */
PETSC_INTERN double SamMapsMemory(const SamStressRun *run);
PETSC_INTERN double SamLinesMemory(const SamStressRun *run);

/* SamTractionsRead - pressure and both shears of a saved step, this rank's rows, into three arrays. Collective. */
PETSC_INTERN PetscErrorCode SamTractionsRead(SamStressRun *run, PetscInt saved, double *const to[SAM_STRESS_TRACTIONS]);
/* SamStressAddBulk - adds the bulk stress of a step to the stresses of n points. Not collective. */
PETSC_INTERN void SamStressAddBulk(const SamStressRun *run, PetscInt step, PetscInt n, double stress[]);
/* SamQuantitiesWrite - computes what is wanted of a step's stresses and writes it (quantities.c). Collective. */
PETSC_INTERN PetscErrorCode SamQuantitiesWrite(SamStressRun *run, PetscInt step, const SamPoints *points,
                                               const double stress[]);
/*
  SamEdgeStressCompute - keeps the largest stresses at the contact's edge of a step, whose map at depth 0, without bulk
  stress, is in `field`. SamEdgeStressWrite - writes those of all steps, where there are maps of the surface
  (edgestress.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamEdgeStressCompute(SamStressRun *run, PetscInt step, Vec field);
PETSC_INTERN PetscErrorCode SamEdgeStressWrite(SamStressRun *run);
/* SamLargestKeep - keeps a value if it is the largest so far. Not collective. */
PETSC_INTERN void SamLargestKeep(SamLargest *largest, double value, double point);

/*
  SamCycleWanted - whether a fatigue parameter is asked for: then the stresses of all steps are needed at a time.
  SamCycleWrite - computes the fatigue parameters from the stresses of all steps and writes them (cycle.c). `done` is
  the part of all points that came before, `share` that of these. Collective.
*/
PETSC_INTERN PetscBool      SamCycleWanted(const SamStressRun *run);
PETSC_INTERN PetscErrorCode SamCycleWrite(SamStressRun *run, const SamPoints *points, double done, double share);
/*
  SamCycleCheckClosed - warns if the step before the first one has been saved and has not the tractions of the last: the
  steps are not a closed cycle then, or it has not become steady; of steps that hold more than one cycle, or what leads
  to it; and of those of several cycles of a life. Collective.
*/
PETSC_INTERN PetscErrorCode SamCycleCheckClosed(SamStressRun *run);

/*
  SamStressRunTell - prints a line on how far the run is, if the last one is some time ago: the part that is done of the
  work at hand. `whole`: how much of all is done, from which the time left follows; 0: not known. Not collective: rank 0
  prints what it knows.
*/
PETSC_INTERN PetscErrorCode SamStressRunTell(SamStressRun *run, const char work[], double part, double whole);

#endif
