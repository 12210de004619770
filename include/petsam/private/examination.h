/* The examination of a run's steps: what the doubts of the laws can ask. */
#ifndef PETSAM_EXAMINATION_H
#define PETSAM_EXAMINATION_H

#include <petsam/contact.h>
#include <petsam/private/doubts.h>
#include <petsam/private/grid.h>

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
/*
  Allowed relative change of the peak pressure on cells half as wide, after wear. It is larger than without, since a
  surface worn on finer cells is smoother than heights interpolated between wide ones: in 7 random lives the change on
  four times finer cells was a fourteenth to three quarters of the prediction by interpolated heights.
*/
#define SAM_WORN_PEAK 0.1

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
  double    unbalanced;    /* sum of those by the work of the loads alone, J */
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
  PetscBool twists;       /* true: M_z began with N */
  double    areas[2];     /* of the contact after the first step, and after the last one, m2 */
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

#define SAM_ZONE_WRONG 0.3 /* error of the energy of a slip zone, relative to 1/(w^2 sqrt(m)) */
/*
  SamZoneError - returns the error of the energy of a slip zone of this width with an edge of this length, both in
  cells, relative to it (src/post/advice/slipzones.c). Not collective.
*/
static inline double SamZoneError(double width, double length)
{
  return SAM_ZONE_WRONG / (width * width * sqrt(length));
}

/*
  SamExamination - what a law is asked about: the contact after a step, and what has been found of all steps so far. Of
  closed loops in a wear simulation only the last computed cycle counts (`cycles`).
*/
enum { SAM_EXAMINATION_KEPT = 8 }; /* numbers that a law keeps */
typedef struct _n_SamExamination SamExamination;
struct _n_SamExamination {
  SamContact       contact;
  SamState         state; /* of the contact */
  SamGrid          grid;
  SamElasticity    elasticity;
  const SamExtent *extent; /* size of the contact at the largest load */
  const SamSlip   *slip;   /* slip of all steps */
  double           passed; /* cells: width of the slip zone in the last step of steady rolling; 0: none */
  PetscBool        cycles; /* true: these are steps of computed cycles */
  PetscBool        spent;  /* true: the last cycle dissipates next to nothing of what the first one did */
  double          *kept;   /* SAM_EXAMINATION_KEPT numbers that the law keeps from step to step; 0 at first */
  SamDoubts       *doubts; /* receives errors of numbers */
  /* passes on a text of one line, and the option (without dash) that mends it; empty if the text names it */
  PetscErrorCode (*tell)(void *context, const char text[], const char setting[]);
  void *context;
};

/* A reason: in which spots, how many cells, plural */
#define SAM_ACROSS "the contact is %s%.3g cell%s across"
#define SAM_MARGIN 1.1 /* ratio of the width of a sufficient grid to that of the contact */
/*
  SamExaminationSay - passes on a text, with a format of printf(); `setting` as that of `tell`. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamExaminationSay(SamExamination *x, const char setting[], const char format[], ...)
  PETSC_ATTRIBUTE_FORMAT(3, 4);

#endif
