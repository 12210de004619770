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
#include <petsam/private/lawimpl.h>
#include <petsam/private/lifeback.h>
#include <petsam/private/objective.h>
#include <stdio.h>

enum { SAM_GRADIENT_BULKS = SAM_BULKS, SAM_GRADIENT_MODULI = 4, SAM_GRADIENT_OF = 512 };

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
  PetscReal    volume; /* m3, worn off both bodies so far */
  PetscReal    load[SAM_COMPONENTS], rigid[SAM_COMPONENTS], bulk[SAM_GRADIENT_BULKS];
  /* if contact grows, and slip begins where cells touch (entered.c) */
  PetscBool   grows, fresh; /* fresh: from no contact */
  SamApproach approach;
  PetscInt    entering; /* number of cells that come into contact */
  PetscInt   *entered;  /* their indices, as those of the cells */
  double     *distance; /* their gaps before the step, m; -1: where the bodies touch first in a fresh step */
} SamRecord;

/* The results of a pass back */
typedef struct {
  PetscReal value, residual, moduli[SAM_GRADIENT_MODULI], law[SAM_LAWS], shape[SAM_GAP_PARAMETERS];
  PetscInt  borders;
  Vec       gap, friction;                                                               /* on the contact's grid */
  double (*load)[SAM_COMPONENTS], (*rigid)[SAM_COMPONENTS], (*bulk)[SAM_GRADIENT_BULKS]; /* of each step */
  PetscInt    count;                                                                     /* of the steps */
  char        name[96];                                                                  /* of the number */
  const char *unit;                                                                      /* likewise; borrowed */
  char        of[SAM_GRADIENT_OF]; /* the wanted parameters, separated by commas; empty: those without further cost */
} SamDerivatives;

struct _n_SamGradient {
  SamContact contact; /* borrowed */
  SamGap     shape;   /* borrowed */
  PetscInt   count, room;
  SamRecord *record;
  /* those with a number by which there is a derivative, of all types: the contact's, or one that does nothing */
  PetscInt    laws;
  SamLaw      law[SAM_LAWS];
  PetscInt    rows, cycle; /* of a wear simulation: rows of the history, and those of its cycle; else 0 */
  SamLifeBack life;        /* its jumps; else NULL */
  Vec         touched;     /* 1 in cells that some step has recorded, 0 in others */
  /* steps beyond the limit of this rank's memory (store.c): bytes allowed, 0: any, and in use; their file and its
     end */
  double           limit, kept;
  FILE            *file;
  off_t            end;
  PetscReal        still; /* slip that counts as stick, as a part of the displacement of a cell by the largest bound */
  Vec              friction; /* coefficient, on the contact's grid; of the first step */
  PetscObjectState gap;      /* of the problem's gap in the first step */
  SamDerivatives   found;
};

/* A step on the part of the grid that has all contacts: SAM_RECORD_VALUES fields. */
typedef struct {
  Vec           field;
  const double *value;
} SamFrameOfStep;

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
  SamGradient    g;
  SamWindow      window;            /* NULL: the whole grid */
  SamElasticity  elasticity, other; /* of the part; with other constants, for derivatives by the moduli, or NULL */
  SamGrid        grid;
  PetscBool      coupled;
  PetscBool      shares; /* steps of one pressure may share a normal problem */
  SamShared      shared;
  PetscReal      rtol;
  Vec            whole; /* scratch of SAM_RECORD_VALUES fields */
  SamFrameOfStep now, before;
  double        *friction, *rubbed;
  SamBackStep    at;                     /* what numbers and laws see and add to */
  double        *later;                  /* V: derivative by the slip, two components */
  double        *gamma, *tau, *beta;     /* cotangents of the gap, the slip and the bound of a step */
  double         forces[SAM_COMPONENTS]; /* derivatives by the given loads of the step */
  /* by what cells have moved before they touched, in the present step and the one after it */
  SamEntered entered;
  double     by_load_before[SAM_COMPONENTS], by_rigid_before[SAM_COMPONENTS];
  double     strain[3], strain_before[3], kappa[2], by_modulus;
} SamBack;

/* SamBackAddLoad - adds a factor times the derivatives of a load by the tractions of unit cells. Not collective. */
PETSC_INTERN void SamBackAddLoad(SamGrid grid, PetscInt component, double factor, double by_pressure[],
                                 double by_shear[]);
/* SamBackTake - the step's `take`: takes a field of the contact's grid to an array of the part. Collective.
   SamBackPlace - returns the index on the part of a cell of the contact's grid; -1: none. Not collective. */
PETSC_INTERN PetscErrorCode SamBackTake(const void *back, Vec whole, double array[]);
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
  SamBackAddOpen - the step's `open`. SamBackSolveNormal - the step's `normal` (private/backstep.h). Collective.
*/
PETSC_INTERN PetscErrorCode SamBackAddOpen(void *back, const double by_gap[], const double by_lift[]);
PETSC_INTERN PetscErrorCode SamBackSolveNormal(void *back, const double pressure[], const double soft[],
                                               const double right[], const PetscBool force[3], double l[],
                                               double forces[3]);
/* SamGradientOfRow - returns a recorded step of a row of the history. Not collective. */
PETSC_INTERN const SamRecord *SamGradientOfRow(SamGradient g, PetscInt row);
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
/* SamObjectiveRegisterStresses - registers the smooth maxima of stresses (stressobjective.c). */
PETSC_INTERN PetscErrorCode SamObjectiveRegisterStresses(void);

#endif
