/* The inside of gradients: recorded steps, and one step on the way back. */
#ifndef PETSAM_GRADIENTIMPL_H
#define PETSAM_GRADIENTIMPL_H

#include <petsam/private/gradient.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/gap.h>
#include <petsam/private/grid.h>
#include <petsam/private/law.h>
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
  PetscInt   count;
  PetscInt  *cell;      /* indices in this rank's part of the contact's grid */
  double    *value;     /* of SAM_RECORD_BY_BACK fields, one after the other */
  float     *slope;     /* of the last two */
  PetscInt64 end[2];    /* cells whose slips determine how far all slide alike, on the whole grid; -1: none */
  double     by_end[2]; /* its derivatives by the lengths of these slips, 1/m */
  PetscBool  turns;     /* true: slip follows the shear at mid step in cells that were in contact before */
  PetscBool  force[SAM_COMPONENTS];
  PetscReal  load[SAM_COMPONENTS], rigid[SAM_COMPONENTS], bulk[SAM_GRADIENT_BULKS];
} SamRecord;

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
  SamContact       contact; /* borrowed */
  SamGap           shape;   /* borrowed */
  PetscInt         count, room;
  SamRecord       *record;
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
  SamBack - the pass back: its part of the grid, the present step and the one before, what the objective and the steps
  after have left, and the sums so far. Arrays have a value of each cell of the part, or one for each component.
*/
typedef struct {
  SamGradient      g;
  SamWindow        window;            /* NULL: the whole grid */
  SamElasticity    elasticity, other; /* of the part; with other constants, for derivatives by the moduli, or NULL */
  SamGrid          grid;
  PetscBool        coupled;
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
} SamBack;

/* SamBackRubbed - computes the pressure against which cells slip in the present step, times the slip, Pa m. */
PETSC_INTERN void SamBackRubbed(const SamObjectiveStep *at, double rubbed[]);
/* SamBackAddRubbed - adds the derivatives of the sum over cells of a factor times the same. Collective. */
PETSC_INTERN PetscErrorCode SamBackAddRubbed(SamObjectiveStep *at, const double factor[]);
/* SamBackSolve - solves the adjoint of the present step: gamma, tau, beta, forces, and `later` for the step before.
   Collective. */
PETSC_INTERN PetscErrorCode SamBackSolve(SamBack *back, PetscInt step);
/* SamBackRead - adds what gamma, tau and beta of the present step give to the derivatives. Collective. */
PETSC_INTERN PetscErrorCode SamBackRead(SamBack *back, PetscInt step);
/* SamRecordUnpack - sets the fields of a step on the part of the grid; NULL: all are 0. Collective. */
PETSC_INTERN PetscErrorCode SamRecordUnpack(const SamBack *back, const SamRecord *record, SamFrameOfStep *frame);
PETSC_INTERN PetscErrorCode SamRecordDestroy(SamRecord *record);
/*
  SamChoiceCheck - checks the names of wanted parameters, separated by commas. SamChoiceHas - true if that of
  one is wanted, SamChoiceHasModuli, SamChoiceHasShape - if one of these is. Not collective.
  SamChoiceFind - returns the derivative by a parameter with one number; NULL: it was not wanted or there is none.
  SamChoiceGetShare - gets it times the value, 0 if that is infinite. Neither is collective.
  SamChoiceAddShape - computes the derivatives by the parameters of the shape from that by the gap. Collective.
  Errors: SAM_ERR_USER for another gap than that of the shape.
*/
PETSC_INTERN PetscErrorCode   SamChoiceCheck(SamGradient g, const char of[]);
PETSC_INTERN PetscBool        SamChoiceHas(const char of[], const char name[]);
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
