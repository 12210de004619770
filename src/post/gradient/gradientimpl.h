/* The inside of gradients: recorded steps, and one step on the way back. */
#ifndef PETSAM_GRADIENTIMPL_H
#define PETSAM_GRADIENTIMPL_H

#include <petsam/private/gradient.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/entering.h>
#include <petsam/private/gap.h>
#include <petsam/private/grid.h>
#include <petsam/private/law.h>
#include <petsam/private/life.h>
#include <stdio.h>
#include <petsam/private/objective.h>

enum { SAM_GRADIENT_BULKS = SAM_BULKS, SAM_GRADIENT_MODULI = 4, SAM_GRADIENT_WEARS = 2, SAM_GRADIENT_OF = 512 };

/* Values of a recorded cell: fields of the step, and the slopes of the share by which the pressure before the step
   counts (SamIncrementGetShareSlopes()). */
enum {
  SAM_RECORD_PRESSURE, /* Pa */
  SAM_RECORD_SHEAR,    /* Pa, two components */
  SAM_RECORD_SLIP = 3, /* m, of the step, two components */
  SAM_RECORD_SHARE =
    5, /* share of the pressure before the step in what the slip works against; -1: no friction works */
  SAM_RECORD_BY_BACK,
  SAM_RECORD_BY_ALIKE,
  SAM_RECORD_VALUES
};

/* A recorded step: the cells that are in contact in it or were in the step before, packed. */
typedef struct {
  PetscInt     row;    /* of the history: in a wear simulation several steps are of the same row */
  SamLifePlace place;  /* in a wear simulation */
  PetscBool    stored; /* the arrays of the cells are in the file, from `at` on, and here for a while only (store.c) */
  off_t        at;
  PetscInt     count;
  PetscInt    *cell;      /* indices in this rank's part of the contact's grid */
  double      *value;     /* of SAM_RECORD_BY_BACK fields, one after the other */
  float       *slope;     /* of the last two */
  PetscInt64   end[2];    /* cells whose slips determine how far all slide alike, on the whole grid; -1: none */
  double       by_end[2]; /* its derivatives by the lengths of these slips, 1/m */
  PetscBool    same;      /* true: pressure and normal loads are those of the step before */
  PetscBool    turns;     /* true: slip follows the shear at mid step in cells that were in contact before */
  PetscBool    force[SAM_COMPONENTS];
  PetscReal    load[SAM_COMPONENTS], rigid[SAM_COMPONENTS], bulk[SAM_GRADIENT_BULKS];
  /* if contact grows, and slip begins where cells touch (touched.c) */
  PetscBool   grows, fresh; /* fresh: from no contact */
  SamApproach approach;
  PetscInt    entering; /* number of cells that come into contact */
  PetscInt   *entered;  /* their indices, as those of the cells */
  double     *distance; /* their gaps before the step, m; -1: where the bodies touch first in a fresh step */
} SamRecord;

/* A part of a jump of a wear simulation: see SamLifePart; `after`: number of steps recorded before it */
enum { SAM_JUMP_SLIP, SAM_JUMP_MEAN, SAM_JUMP_PRESSURE, SAM_JUMP_FROM, SAM_JUMP_TO, SAM_JUMP_FIELDS };
typedef struct {
  SamLifePartKind kind;
  PetscReal       cycles;
  PetscInt        after;
  PetscBool       force[3];
  Vec             field[SAM_JUMP_FIELDS]; /* on the contact's grid */
} SamJump;

/* The results of a pass back */
typedef struct {
  PetscReal value, residual, moduli[SAM_GRADIENT_MODULI], wear[SAM_GRADIENT_WEARS], shape[SAM_GAP_PARAMETERS];
  PetscInt  borders;
  Vec       gap, friction;                                                               /* on the contact's grid */
  double (*load)[SAM_COMPONENTS], (*rigid)[SAM_COMPONENTS], (*bulk)[SAM_GRADIENT_BULKS]; /* of each step */
  PetscInt count;                                                                        /* of the steps */
  char     name[96], unit[16];                                                           /* of the number */
  char     of[SAM_GRADIENT_OF]; /* the wanted parameters, separated by commas; empty: those without further cost */
} SamDerivatives;

struct _n_SamGradient {
  SamContact contact; /* borrowed */
  SamGap     shape;   /* borrowed */
  PetscInt   count, room;
  SamRecord *record;
  PetscInt   rows, cycle; /* of a wear simulation: rows of the history, and those of its cycle; else 0 */
  PetscInt   jumps;
  SamJump   *jump;    /* parts of jumps */
  Vec        touched; /* 1 in cells that some step has recorded, 0 in others */
  /* steps beyond the limit of this rank's memory (store.c): bytes allowed, 0: any, and in use; their file and its
     end */
  double           limit, kept;
  FILE            *file;
  off_t            end;
  PetscReal        still; /* slip that counts as stick, as a part of the displacement of a cell by the largest bound */
  Vec              friction;          /* coefficient, on the contact's grid; of the first step */
  PetscObjectState gap;               /* of the problem's gap in the first step */
  PetscReal rate[SAM_GRADIENT_WEARS]; /* coefficients of wear of both bodies, by pressure (1/Pa) and energy (m3/J) */
  SamDerivatives found;
};

/* A step on the part of the grid that has all contacts: SAM_RECORD_VALUES fields. */
typedef struct {
  Vec           field;
  const double *value;
} SamFrameOfStep;

/*
  SamEntered - cotangents of what the motion of cells before they touch depends on: of the gap and the friction of each
  cell, of the loads and displacements before the step (0) and after it (1), of the growth of the strain xx, yy, xy, of
  kappa, and of the composite modulus in plane strain, times minus that.
*/
typedef struct {
  double *by_gap, *by_friction;
  double  load[2][SAM_COMPONENTS], rigid[2][SAM_COMPONENTS], strain[3], kappa[2], uniform, by_modulus;
} SamEntered;

/*
  SamLifeBack - cotangents between the jumps of a wear simulation: of the wear load after the last event, and within a
  jump of that at its start and of that after it as a whole; of the cycle whose wear is repeated its wear load, its
  mean pressure, its shift, its slip (of cells that touch never in it), and its mean normal loads.
*/
typedef struct {
  double  *by_worn, *by_start, *by_whole, *by_wear, *by_mean, *by_shift, *by_slip, *touches, *load;
  double   by_load[3], by_rigid[3]; /* of the normal loads and displacements */
  PetscInt left;                    /* parts of jumps that have not been passed yet */
} SamLifeBack;

/*
  SamShared - the normal problem that consecutive steps of one pressure share. Its right-hand sides are added up and
  solved once, at the first of them. What is wanted by step, the derivative by a normal load or displacement, is linear
  in a step's own right-hand side: the product with a solution for that component, one for all of these steps.
*/
typedef struct {
  PetscBool on;              /* the present steps share one */
  PetscInt  count, place[3]; /* of the components that are wanted by step: their places among the motions */
  double   *by_right[3];     /* their derivatives by the right-hand side, packed, */
  double    by_given[3][3];  /* and by what the rows of given loads are */
  double    found[3];        /* what the steps so far have of them */
} SamShared;

/*
  SamBack - the pass back: its part of the grid, the present step and the one before, what the objective and the steps
  after have left, and the sums so far. Arrays have a value of each cell of the part, or one for each component.
*/
typedef struct {
  SamGradient      g;
  SamWindow        window;            /* NULL: the whole grid */
  SamElasticity    elasticity, other; /* of the part; with other constants, for derivatives by the moduli, or NULL */
  SamGrid          grid;
  PetscBool        coupled;
  PetscBool        shares; /* steps of one pressure may share a normal problem */
  SamShared        shared;
  PetscReal        rtol;
  Vec              whole; /* scratch of SAM_RECORD_VALUES fields */
  SamFrameOfStep   now, before;
  double          *friction;
  SamObjectiveStep at;                 /* what the objective sees and adds to */
  double          *worn;               /* derivative by the depth that is worn off so far, 1/m */
  double          *later;              /* V: derivative by the slip, two components */
  double          *gamma, *tau, *beta; /* cotangents of the gap, the slip and the bound of a step */
  double          *by_gap, *by_friction;
  double           forces[SAM_COMPONENTS]; /* derivatives by the given loads of the step */
  SamLifeBack      life;
  /* by what cells have moved before they touched, in the present step and the one after it */
  SamEntered entered;
  double    *ahead; /* derivative by the gap of open cells after the step; not in gamma */
  double     by_load[SAM_COMPONENTS], by_load_before[SAM_COMPONENTS], by_rigid_before[SAM_COMPONENTS];
  double     strain[3], strain_before[3], kappa[2], by_modulus;
} SamBack;

/* SamBackRubbed - computes the pressure against which cells slip in the present step, times the slip, Pa m. */
PETSC_INTERN void SamBackRubbed(const SamObjectiveStep *at, double rubbed[]);
/* SamBackAddRubbed - adds the derivatives of the sum over cells of a factor times the same. Collective. */
PETSC_INTERN PetscErrorCode SamBackAddRubbed(SamObjectiveStep *at, const double factor[]);
/* SamBackAddLoad - adds a factor times the derivatives of a load by the tractions of unit cells. Not collective. */
PETSC_INTERN void SamBackAddLoad(SamGrid grid, PetscInt component, double factor, double by_pressure[],
                                 double by_shear[]);
/* SamBackSumMoments - sums values of the cells, and their products with x and with y (m). Collective. */
PETSC_INTERN PetscErrorCode SamBackSumMoments(const SamBack *back, const double values[], double sums[3]);
/* SamBackTake - takes a field of the contact's grid to an array of the part. Collective. SamBackPlace - returns the
   index on the part of a cell of the contact's grid; -1: none. Not collective. */
PETSC_INTERN PetscErrorCode SamBackTake(const SamBack *back, Vec whole, double array[]);
PETSC_INTERN PetscInt64     SamBackPlace(const SamBack *back, PetscInt64 cell);
/*
  SamBackEnter - computes the cotangents of what the motion of cells before they touch depends on in the present step,
  by those of the slip, two components. Collective. SamBackAddEntered - adds those of the step. Not collective.
  SamBackLeaveEntered - adds those of the step before, once the derivatives are read. Collective.
*/
PETSC_INTERN PetscErrorCode SamBackEnter(SamBack *back, PetscInt step, const double lambda[]);
PETSC_INTERN void           SamBackAddEntered(SamBack *back);
PETSC_INTERN PetscErrorCode SamBackLeaveEntered(SamBack *back, PetscInt step);
/*
  SamBackAddOpen - adds to the derivatives by the tractions and displacements of the step those by the gap, and by the
  lift by the shear, of each cell. Collective.
*/
PETSC_INTERN PetscErrorCode SamBackAddOpen(SamBack *back, const double by_gap[], const double by_lift[]);
/*
  SamBackSolveNormal - solves the adjoint of a normal problem with this pressure (Pa), whose surfaces also yield by
  `soft` (m/Pa), and some given loads: l, 0 outside of the contact, and the derivatives by the loads. Collective.
*/
PETSC_INTERN PetscErrorCode SamBackSolveNormal(SamBack *back, const double pressure[], const double soft[],
                                               const double right[], const PetscBool force[3], double l[],
                                               double forces[3]);
/*
  SamBackPassJumps - goes back over the parts of jumps after so many steps. SamBackAddCycle - adds what the wear of the
  cycle of the present step is repeated by. SamBackGetLoad - gets the wear load after the last jump. Collective.
*/
PETSC_INTERN PetscErrorCode SamBackPassJumps(SamBack *back, PetscInt steps);
PETSC_INTERN PetscErrorCode SamBackAddCycle(SamBack *back, PetscInt step);
PETSC_INTERN PetscErrorCode SamBackGetLoad(const SamBack *back, double load[]);
/* SamGradientOfRow - returns a recorded step of a row of the history. Not collective. */
PETSC_INTERN const SamRecord *SamGradientOfRow(SamGradient g, PetscInt row);
PETSC_INTERN PetscErrorCode   SamJumpDestroy(SamJump *jump);
/*
  SamStoreKeep - moves the arrays of a new record to the file if they are beyond the limit of memory. SamStoreTake -
  gets them back for a while, until SamStoreLeave(). Collective. Errors: SAM_ERR_FILE. SamStoreForget - closes the file.
  SamRecordAllocate - allocates the arrays of a record for its cells. Not collective.
*/
PETSC_INTERN PetscErrorCode SamStoreKeep(SamGradient g, SamRecord *record);
PETSC_INTERN PetscErrorCode SamStoreTake(SamGradient g, SamRecord *record);
PETSC_INTERN PetscErrorCode SamStoreLeave(SamRecord *record);
PETSC_INTERN void           SamStoreForget(SamGradient g);
PETSC_INTERN PetscErrorCode SamRecordAllocate(SamRecord *record);
/* SamBackSolve - solves the adjoint of the present step: gamma, tau, beta, forces, and `later` for the step before.
   Collective. */
PETSC_INTERN PetscErrorCode SamBackSolve(SamBack *back, PetscInt step);
/* SamBackRead - adds what gamma, tau and beta of the present step give to the derivatives. Collective. */
PETSC_INTERN PetscErrorCode SamBackRead(SamBack *back, PetscInt step);
/* SamRecordUnpack - sets the fields of a step on the part of the grid; NULL: all are 0. Collective. */
PETSC_INTERN PetscErrorCode SamRecordUnpack(const SamBack *back, SamRecord *record, SamFrameOfStep *frame);
PETSC_INTERN PetscErrorCode SamRecordDestroy(SamRecord *record);
/*
  SamChoiceCheck - checks the names of wanted parameters, separated by commas. SamChoiceHas - true if that of
  one is wanted, SamChoiceHasModuli, SamChoiceHasShape - if one of these is, SamChoiceAllowsSharing - if
  of the last wanted ones none needs the normal problem of each step. Not collective.
  SamChoiceFind - returns the derivative by a parameter with one number; NULL: it was not wanted or there is none.
  SamChoiceGetShare - gets it times the value, 0 if that is infinite. Neither is collective.
  SamChoiceAddShape - computes the derivatives by the parameters of the shape from that by the gap. Collective.
  Errors: SAM_ERR_USER for another gap than that of the shape.
*/
PETSC_INTERN PetscErrorCode   SamChoiceCheck(SamGradient g, const char of[]);
PETSC_INTERN PetscBool        SamChoiceHas(SamGradient g, const char of[], const char name[]);
PETSC_INTERN PetscBool        SamChoiceAllowsSharing(SamGradient g);
PETSC_INTERN PetscBool        SamChoiceHasModuli(SamGradient g, const char of[]);
PETSC_INTERN PetscBool        SamChoiceHasShape(SamGradient g, const char of[]);
PETSC_INTERN const PetscReal *SamChoiceFind(SamGradient g, const char name[]);
PETSC_INTERN PetscErrorCode   SamChoiceGetShare(SamGradient g, const char name[], PetscReal *share);
PETSC_INTERN PetscErrorCode   SamChoiceAddShape(SamGradient g);
/* SamObjectiveFind - finds the objective of a name. Errors: SAM_ERR_USER, with what is expected. Not collective. */
PETSC_INTERN PetscErrorCode SamObjectiveFind(MPI_Comm comm, const char name[], const SamObjective **objective);
/* SamObjectiveRegisterStresses - registers the smooth maxima of stresses (stressobjective.c). */
PETSC_INTERN PetscErrorCode SamObjectiveRegisterStresses(void);

#endif
