/*
  What a user should know of a solution that is right for its grid, but may not be what was meant: a grid that is too
  coarse or too small, a contact too large for half-spaces. Each message says what would be better, by options.
*/
#ifndef PETSAM_ADVICE_H
#define PETSAM_ADVICE_H

#include <petsam/setup.h>

/* SamExtent - the size of a contact. */
typedef struct {
  PetscInt  zones;   /* connected by the sides of cells, as contact_spots; 0: the bodies do not touch */
  PetscReal across;  /* cells, of the narrow zones: SamGridMeasureZones(), a tenth of the cells left out */
  PetscBool whole;   /* the widest zone spans the grid */
  PetscReal half[2]; /* m: half widths of the rectangle that holds all of it */
  PetscReal change;  /* of the peak pressure on cells half as wide, relative: SamAdviceMeasurePeak() */
  PetscInt  finer;   /* cells so many times narrower resolve the peak; 0: none of up to 16384 in a row */
} SamExtent;
#define SAM_LARGEST_ROW 16384 /* cells in a row of a grid that is advised */

/* SamLoadRange - the largest loads of several steps. To be zero at first. */
typedef struct {
  PetscInt    steps;       /* that have been added */
  PetscBool   force;       /* the normal force is given; false: the approach */
  PetscReal   normal;      /* the largest of it, N or m */
  PetscReal   lever[2];    /* m: the farthest that moments bring the centre of pressure from the origin along x and y */
  PetscReal   slide;       /* m: the farthest that displacements move the surfaces along them */
  PetscReal   rotation;    /* rad: the largest that is prescribed */
  PetscReal   creep, spin; /* the largest creepage along x or y, and spin (1/m), that are prescribed */
  PetscReal   stress;      /* Pa: the largest prescribed stress, */
  const char *stress_name; /* and of which group of conditions it is; borrowed */
  PetscReal   friction;    /* the largest factor on the coefficient of friction */
  PetscBool   open; /* the contact may be larger than a closed solution for these loads has it: rotations, wear */
} SamLoadRange;

/*
  SamSlip - the dissipated energy of the steps so far, and how far the cells resolve it (slip.c). Branches lie between
  load reversals; lengths in cells.
*/
typedef struct {
  PetscInt  steps;
  PetscBool rolls;         /* nothing is known */
  PetscBool unsure;        /* of some steps the energy is not known for their length, and counts as 0 */
  double    energy, error; /* J: the sum over cells, and its error, estimated */
  double    closed;        /* J: by the closed form; NaN: there is none */
  double    work;          /* J: T disp, the most of a step */
  double    branch, worst; /* J: energy of the branch; the largest error of one, */
  PetscReal narrow[2];     /* and width of the slip zone and length of the edge there */
  PetscReal width, length; /* the same after the last step */
  double    sticks;        /* part of the cells in contact, after the last step */
  double    stuck;         /* of the shear's change over mu p at the edge, since all cells stick; 0: some slip */
  double    tangential[2]; /* N: T after the last step, */
  double    toward[2];     /* N: and its change in it */
  double    zone, high;    /* J, Pa: energy of the zone of that branch, and shear at its end, by stuck.c */
  double    missing;       /* J: energy of such zones of branches before */
  PetscReal widest;        /* cells: of all zones with slip */
  double    slipped;       /* m: the maximum slip after the last step, */
  double    turned;        /* m: and at the reversal before; 0: there was none */
  PetscReal across;        /* cells: of the stick zone after the last step */
  PetscBool pushed;        /* the last step has no tangential displacement given */
  PetscBool together;      /* N and T have grown in proportion from nothing, */
  double    part[2];       /* with this T over N */
  PetscBool joined;        /* the normal load has begun to grow, */
  double    coupling;      /* and does in one step of dissimilar bodies: their coupling over friction; 0: it does not */
  double    before_touch;  /* J: what slip would work more if cells had touched before steps of dissimilar bodies */
  PetscInt  growing;       /* steps in which they touch */
  double    share;         /* T over mu N at most before the first reversal */
  double    first;         /* J: energy until then, with a reversal thereafter; 0: none so far */
} SamSlip;

/* SamRollingError - the largest error of a load or creepage that was found in steady rolling (steadyerrors.c). */
typedef struct {
  double      error;       /* relative */
  PetscInt    step;        /* from 0 */
  const char *name;        /* borrowed */
  double      value, fine; /* as found, and extrapolated to fine grids */
  PetscReal   width;       /* cells: of the slip zone in the last step */
} SamRollingError;

/*
  SamAdviceFunction - receives advice: a text of one line, and the option (without dash) that mends it, where the text
  does not name it itself; else empty.
*/
typedef PetscErrorCode (*SamAdviceFunction)(void *context, const char text[], const char setting[]);

/* SamAdvice - looks at the steps of a contact. Its maker sets the first members; the others are zero at first. */
typedef struct {
  const SamSetup   *setup;
  SamAdviceFunction receive;
  void             *context;
  PetscInt          steps; /* of the run */
  SamLoadRange      most;
  PetscInt          largest;           /* step of the largest normal load or approach, from 0 */
  PetscBool         doubtful;          /* the heights are of another unit, or tilted: nothing is said of the contact */
  PetscBool         examined;          /* whether the size of the contact was looked at */
  PetscBool         stepped;           /* heights from a file have a step in contact, of which the user knows */
  char              after[48];         /* "after 1e6 cycles: ", when it is looked at again; empty: the first time */
  PetscInt          finer;             /* cells so many times narrower have been advised; 0: none */
  PetscBool         advised[SAM_LAWS]; /* laws that have warned of a step */
  const SamStep    *step;              /* that is looked at, */
  SamExtent         extent;            /* with the contact there */
  SamRollingError   rolling;           /* of the steps so far */
  SamSlip           slip;              /* of the steps so far; of the last computed cycle */
  PetscReal      half[2], across; /* half widths (m) and cells across: of a closed solution if it is of this contact, */
  PetscBool      closed;          /* which is then true */
  PetscErrorCode error;           /* the first of who receives it */
} SamAdvice;
/*
  SamAdviceAddLoads - adds the loads of step k to the largest ones. Not collective.
  SamAdviceBegin - before the first step: heights and options that are unlikely to be meant. Collective.
  SamAdviceStep - after step k, with a solution: if it has the largest load, once, motions that are not small, bodies
  that do not touch, a contact of fewer than 20 cells across (14 if a closed solution describes it), a peak pressure
  that cells half as wide change by more than 5 % (10 % after wear), a contact that is wider than a tenth of a radius of
  curvature, or a pressure above 0.2 E*; `found`: the contact, NULL if it has not been looked at now. With `of_laws`
  what the laws have to say, each once. Collective.
  SamAdviceRenew - the next SamAdviceStep() of such a load looks again at how the contact, which has been worn, is
  resolved. `after`: when that is, for the message. Not collective.
  SamAdviceBeginCycle - before a computed cycle of a life: its energy alone counts. Not collective.
  SamAdviceEnd - after the last step: a dissipated energy that the slip zones, narrow beside the cells, make wrong by
  more than 5 %, or one step of N on dissimilar bodies by more than 2 %; in steady rolling a load or a creepage that
  finer cells change by more than 2 %; a maximum slip, shear or slip velocity, and an area of stick, of zones that are
  few cells wide. `found`: the energy, NULL if there is none. Collective.
  SamAdviceEdge - appends to the message of a step that came to the grid's edge a grid on which these loads do not. Not
  collective.
*/
PETSC_INTERN void           SamAdviceAddLoads(SamAdvice *advice, PetscInt k, const SamControl *control);
PETSC_INTERN PetscErrorCode SamAdviceBegin(SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceStep(SamAdvice *advice, PetscInt k, PetscBool of_laws, const SamStep *step,
                                          const SamExtent **found);
PETSC_INTERN void           SamAdviceBeginCycle(SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceEnd(SamAdvice *advice, const SamSlip **found);
PETSC_INTERN void           SamAdviceRenew(SamAdvice *advice, const char after[]);
PETSC_INTERN PetscErrorCode SamAdviceEdge(const SamAdvice *advice, SamStep *step);
/*
  SamAdviceMeasurePeak - `change` and `finer` of the extent: solves the contact about the peak again on finer cells,
  where all other pressure stays (resolution.c). The shape is that of the gap's type, other heights are interpolated.
  Where the cells next to the peak have nearly its pressure, the pressure is at its limit, or a body yields, nothing is
  solved, change = 0 and finer = 1. Collective.
*/
PETSC_INTERN PetscErrorCode SamAdviceMeasurePeak(const SamSetup *setup, SamExtent *extent);

#endif
