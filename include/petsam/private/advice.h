/*
  Warnings about solutions that are correct for their grid but may not be what the user meant: the grid is too coarse or
  too small, or the contact is too large for half-spaces. Each message names options that mend it.
*/
#ifndef PETSAM_ADVICE_H
#define PETSAM_ADVICE_H

#include <petsam/private/errors.h>
#include <petsam/private/examination.h>
#include <petsam/private/setup.h>

/*
  SamAdviceEstimateContact - computes the half widths (m) of the contact under this force (N) or approach (m), by a
  closed-form solution; infinite along the axis of a cylinder. Layers are neglected. `known`: false without a solution.
  Not collective.
*/
PETSC_INTERN PetscErrorCode SamAdviceEstimateContact(const SamSetup *setup, PetscBool force, PetscReal value,
                                                     PetscReal half[2], PetscBool *known);

/* SamAdviceRoundUp - rounds up to two digits. Not collective. */
PETSC_INTERN double SamAdviceRoundUp(double x);

/* SamLoadRange - the largest loads of several steps. All members must be zero at first. */
typedef struct {
  PetscInt  steps;    /* number of steps that have been added */
  PetscBool force;    /* the normal force is given; false: the approach */
  PetscReal normal;   /* largest normal load (N) or approach (m) */
  PetscReal lever[2]; /* largest distance of the centre of pressure from the origin by the moments, along x and y, m */
  PetscReal slide;    /* largest prescribed tangential displacement, m */
  PetscBool moved[SAM_COMPONENTS]; /* components with a prescribed displacement or rotation that is not 0 */
  PetscReal rotation;              /* largest prescribed rotation, rad */
  PetscReal creep, spin;           /* largest prescribed creepage along x or y, and spin (1/m) */
  PetscReal stress;                /* largest prescribed stress, Pa */
  PetscReal bulk[2];               /* largest bulk stress of each body, Pa */
  const char *stress_name;         /* group of conditions that it belongs to; borrowed */
  PetscReal   friction;            /* largest factor on the coefficient of friction */
  PetscBool   open;                /* rotations or moments may make the contact larger than the closed-form solution */
} SamLoadRange;

/* SamRollingError - the largest error of a computed load or creepage in steady rolling (steadyerrors.c). */
typedef struct {
  double      error;       /* relative */
  PetscInt    step;        /* from 0 */
  const char *name;        /* borrowed */
  double      value, fine; /* computed value, and its extrapolation to fine grids */
} SamRollingError;

/*
  SamAdviceFunction - receives advice: a text of one line, and the option (without dash) that mends it; empty if the
  text names the option itself.
*/
typedef PetscErrorCode (*SamAdviceFunction)(void *context, const char text[], const char setting[]);

/*
  SamAdvice - the examination of a contact's steps. Its owner sets the first members; the others must be zero at first.
*/
typedef struct {
  const SamSetup   *setup;
  SamAdviceFunction receive;
  void             *context;
  PetscInt          steps; /* number of steps of the run */
  SamLoadRange      most;
  PetscInt          largest;    /* step of the largest normal load or approach, from 0 */
  PetscBool         doubtful;   /* true: no surface has such heights; the contact is not examined */
  PetscBool         examined;   /* true: the size of the contact has been examined */
  PetscBool         large;      /* true: the user was warned before that the contact will be too large */
  PetscBool         stroke;     /* true: the user was warned of moves without -slide */
  PetscBool         stepped;    /* true: heights from a file have a step in contact, and the user was warned of it */
  PetscBool         worn;       /* true: the examination is repeated on the worn surfaces */
  PetscInt          increments; /* steps per row of the history, by -steps; 0: steps are given one by one */
  PetscReal         step_rtol;  /* that by which steps are divided; 0: they are not */
  PetscBool         advised[SAM_LAWS]; /* true for laws that have warned of a step */
  const SamStep    *step;              /* step under examination */
  SamExtent         extent;            /* size of its contact */
  SamRollingError   rolling;           /* largest error so far */
  PetscReal         begun;             /* J: energy of the first computed cycle, once the next one begins */
  PetscBool         cycles;            /* true: computed cycles of a wear simulation, not all steps, are examined */
  SamSlip           slip;              /* energy of the steps so far, or of the last computed cycle */
  double            passed;            /* cells: width of the slip zone in the last step of steady rolling */
  double            kept[SAM_LAWS][SAM_EXAMINATION_KEPT]; /* what laws keep for their doubts */
  PetscReal         half[2], across;   /* half widths (m) and cells across; by the closed-form solution if `closed` */
  SamDoubts         guesses;           /* errors that companion runs know better, */
  PetscBool         knows[SAM_CAUSES]; /* and true for causes for which there are such runs */
  SamDoubts         doubts;            /* errors of the numbers, which SamAdviceTell() tells */
  PetscBool         closed;            /* true: a closed-form solution describes this contact */
  PetscErrorCode    error;             /* first error that `receive` returned */
} SamAdvice;
/*
  SamAdviceAddLoads - raises the largest loads (`most`) to those of step k. Not collective.
  SamAdviceRefuse - fails if the bodies yield, and the contact will be far too large for half-spaces under these loads.
  Collective. Errors: SAM_ERR_USER.
  SamAdviceBegin - warns, before the first step, of heights and options that are unlikely to be intended. Collective.
  SamAdviceStep - examines step k, which must have a solution. Once, at the largest load, it warns of motions that are
  not small, displacements that need a datum, bodies that do not touch,
  a contact of fewer than 20 cells across (14 if a closed-form solution describes
  it), a peak pressure that cells half as wide change by more than 5 % (10 % after wear), a contact that is wider than a
  tenth of a radius of curvature, and a pressure above 0.2 E*. `found`: the size of the contact, NULL if it was not
  examined in this step. Errors of numbers count for SamAdviceTell(). With `of_laws` it also passes on the warning of
  each law, once. Collective.
  SamAdviceRenew - makes the next SamAdviceStep() at the largest load examine the contact again, if laws wear it. Not
  collective.
  SamAdviceBeginCycle - forgets the slip of earlier steps before a computed cycle of a wear simulation, so that only
  this cycle's energy counts. Not collective.
  SamAdviceEnd - estimates, after the last step, the errors of the dissipated energy by slip zones of few cells and by
  N that grows in few steps on dissimilar bodies, in steady rolling of loads and creepages, of maximum slip, shear and
  slip velocity and the area of stick, of plastic strain, and of volumes, depths and peaks where wear ends at a stick
  zone. `found`: the energy, NULL if there is none; may be NULL. Collective.
  SamAdviceTell - warns, in a line per cause, of all numbers with large errors, and proposes what mends them. Not
  collective.
  SamAdviceFindFew - finds whether the contact under these loads is a single spot of so few cells across that nothing
  but the given loads is known of it: `few` is their number, 0: they are enough; `more`: how many times as many resolve
  it.
  Collective (width.c).
  SamAdviceEdge - appends to the message of a step whose contact reached the grid's edge a grid that is large enough for
  these loads. Not collective.
*/
PETSC_INTERN void           SamAdviceAddLoads(SamAdvice *advice, PetscInt k, const SamControl *control);
PETSC_INTERN PetscErrorCode SamAdviceRefuse(const SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceBegin(SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceStep(SamAdvice *advice, PetscInt k, PetscBool of_laws, const SamStep *step,
                                          const SamExtent **found);
PETSC_INTERN void           SamAdviceBeginCycle(SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceEnd(SamAdvice *advice, const SamSlip **found);
PETSC_INTERN PetscErrorCode SamAdviceTell(SamAdvice *advice);
PETSC_INTERN void           SamAdviceRenew(SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceFindFew(const SamSetup *setup, const SamControl *control, PetscReal *few,
                                             double *more);
PETSC_INTERN PetscErrorCode SamAdviceEdge(const SamAdvice *advice, SamStep *step);
/*
  SamAdviceMeasurePeak - computes `change` and `finer` of the extent: solves the contact around the peak again on finer
  cells, while all other pressure stays (finerpeak.c). The shape is that of the gap's type; other heights are
  interpolated. If the cells next to the peak have nearly its pressure, the pressure is at its limit, or a body yields,
  nothing is solved, and change = 0 and finer = 1. Collective.
*/
PETSC_INTERN PetscErrorCode SamAdviceMeasurePeak(const SamSetup *setup, SamExtent *extent);

#endif
