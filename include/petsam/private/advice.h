/*
  Warnings about solutions that are correct for their grid but may not be what the user meant: the grid is too coarse or
  too small, or the contact is too large for half-spaces. Each message names options that mend it.
*/
#ifndef PETSAM_ADVICE_H
#define PETSAM_ADVICE_H

#include <petsam/private/errors.h>
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

/* SamExtent - the size of a contact. */
typedef struct {
  PetscInt  zones;  /* number of zones of contact, connected by the sides of cells, as contact_spots; 0: no contact */
  PetscReal across; /* width of the narrow zones in cells: SamGridMeasureZones() with part = 0.1 */
  PetscReal half_across; /* the same of the zones that hold half of the contact's cells */
  PetscBool whole;       /* the widest zone spans the grid */
  PetscReal half[2];     /* half widths of the bounding rectangle of the contact, m */
  PetscReal change;      /* relative change of the peak pressure on cells half as wide: SamAdviceMeasurePeak() */
  PetscInt  finer; /* factor by which the cells must be narrower to resolve the peak; 0: not even 16384 in a row do */
} SamExtent;
#define SAM_LARGEST_ROW 16384 /* most cells in a row of a grid that is advised */

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

/*
  SamRing - the slip of dissimilar bodies in a ring at the edge of contact while N grows, of these steps (slipring.c).
*/
typedef struct {
  PetscInt steps;
  double   energy, error; /* J: dissipated, and its error by the cells, estimated after the last step */
  double   width, moves;  /* sums of the ring's width and of the motion of the edge in a step, in cells, each times the
                              energy of the step */
  double   unsure;        /* error of the area of stick, relative to the area of contact, after the last step */
  double   stick, worst;  /* the same relative to the area of stick, and its largest value at the end of such growth */
} SamRing;

/*
  SamSlip - the dissipated energy of the steps so far, and how well the cells resolve it (slipzones.c). A branch is the
  loading between two load reversals; lengths are in cells.
*/
typedef struct {
  PetscInt  steps;
  PetscBool rolls;         /* true: the contact rolls, and the other members are not computed */
  PetscBool unsure;        /* true: some steps are too long for their energy to be known; it counts as 0 */
  double    energy, error; /* energy by the sum over cells, and its estimated error, J */
  double    closed;        /* energy by the closed form, J; NaN: there is none */
  double    lag;           /* sum of the steps' errors of the energy by their length, J */
  double    work;          /* largest tangential work T disp of a step, J */
  double    branch, worst; /* energy of the current branch, and the largest error of any branch, J */
  PetscReal narrow[2];     /* width of the slip zone and length of the edge in the branch with that error */
  PetscReal width, length; /* width of the slip zone and length of the edge after the last step */
  double    sticks;        /* fraction of the cells in contact that stick after the last step */
  double    stuck;         /* change of the shear over mu p at the edge since all cells stick; 0: some slip */
  double    tangential[2]; /* T after the last step, N */
  double    toward[2];     /* change of T in the last step, N */
  double    zone, high;    /* energy (J) of the unresolved slip zone and shear (Pa) at its end, by stuck.c */
  double    missing;       /* energy of the unresolved slip zones of earlier branches, J */
  PetscReal widest;        /* largest width of a slip zone in any step */
  double    slipped;       /* maximum slip after the last step, m */
  double    turned;        /* maximum slip at the last reversal, m; 0: there was none */
  PetscReal across;        /* width of the stick zone after the last step */
  PetscBool pushed;       /* true: the last step prescribes no tangential displacement; in rolling: not all creepages */
  PetscBool together;     /* true: N and T have grown in proportion from zero */
  double    part[2];      /* T over N in that case */
  double    tilt;         /* largest displacement of the contact's edge by tilting, relative to the approach */
  PetscBool joined;       /* true: the normal load has begun to grow */
  double    coupling;     /* coupling over friction if N of dissimilar bodies grows in one step; else 0 */
  double    before_touch; /* extra work of slip if the cells of dissimilar bodies had touched before each step, J */
  PetscInt  growing;      /* number of steps in which cells come into contact, */
  double    grown;        /* and fraction of the cells in contact that stick after the last one */
  double    normal;       /* N times the approach after the last step, J */
  double    share;        /* largest T over mu N before the first reversal */
  double    first;        /* energy of the first branch once it has ended, J; 0: not yet */
  SamRing   ring;         /* the slip of dissimilar bodies while N grows */
} SamSlip;

/* SamRollingError - the largest error of a computed load or creepage in steady rolling (steadyerrors.c). */
typedef struct {
  double      error;       /* relative */
  PetscInt    step;        /* from 0 */
  const char *name;        /* borrowed */
  double      value, fine; /* computed value, and its extrapolation to fine grids */
  PetscReal   width;       /* cells: of the slip zone in the last step */
} SamRollingError;

/* SamYielding - what the steps so far did to bodies that yield (yielding.c). */
typedef struct {
  double work, step; /* plastic work of all steps, and of that step which did most of it, J */
  double pressure;   /* maximum pressure of any step, Pa */
  double shear;      /* maximum shear of any step, also at the edge of stick between cells, Pa */
  double dent;       /* residual_z_max of the last step, m */
  double before;     /* that before the first step: of a restart, or of a copied contact */
} SamYielding;

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
  SamYielding       yielding;          /* plastic work of the steps so far */
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
  SamAdviceRenew - makes the next SamAdviceStep() at the largest load examine the worn contact again. Not collective.
  SamAdviceBeginCycle - forgets the slip of earlier steps before a computed cycle of a wear simulation, so that only
  this cycle's energy counts. Not collective.
  SamAdviceEnd - estimates, after the last step, the errors of the dissipated energy by slip zones of few cells and by
  N that grows in few steps on dissimilar bodies, in steady rolling of loads and creepages, of maximum slip, shear and
  slip velocity and the area of stick, of plastic strain, and of volumes, depths and peaks where wear ends at a stick
  zone. `found`: the energy, NULL if there is none; may be NULL. Collective.
  SamAdviceTell - warns, in a line per cause, of all numbers with large errors, and proposes what mends them. Not
  collective.
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
PETSC_INTERN PetscErrorCode SamAdviceEdge(const SamAdvice *advice, SamStep *step);
/*
  SamAdviceMeasurePeak - computes `change` and `finer` of the extent: solves the contact around the peak again on finer
  cells, while all other pressure stays (finerpeak.c). The shape is that of the gap's type; other heights are
  interpolated. If the cells next to the peak have nearly its pressure, the pressure is at its limit, or a body yields,
  nothing is solved, and change = 0 and finer = 1. Collective.
*/
PETSC_INTERN PetscErrorCode SamAdviceMeasurePeak(const SamSetup *setup, SamExtent *extent);

#endif
