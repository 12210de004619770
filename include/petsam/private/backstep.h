/* A step of a history on the way back, from a number that has a gradient to what it depends on. */
#ifndef PETSAM_BACKSTEP_H
#define PETSAM_BACKSTEP_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <petsam/balance.h>
#include <petsam/elasticity.h>

/*
  SamBackStep - a step of the history on a part of the grid that has all contacts, on the way back from the last step to
  the first: arrays of this rank's cells, two components one after the other. Of the arrays and numbers below `value`
  numbers with a gradient and laws add to those on which they depend: derivatives of the number by what the step has,
  and by what the step before has. A cell's derivative is that by the value of the cell.
*/
typedef struct {
  SamGrid           grid;
  SamElasticity     elasticity;                         /* on the whole grid */
  SamWindow         window;                             /* the part of it; NULL: it is the whole */
  PetscInt          step;                               /* of the history */
  double            area;                               /* of a cell, m2; in plane strain of 1 m of its length */
  const double     *pressure, *shear, *slip, *friction; /* Pa, Pa, m (of the step), 1 */
  const double     *pressure_before, *shear_before;     /* of the step before; in the first step 0 */
  const double     *share, *by_back, *by_alike;         /* how the pressure before the step counts in what slips */
  const PetscInt64 *end;    /* cells whose slips determine how far all slide alike, on this part of the grid */
  const double     *by_end; /* derivatives of that measure by their lengths, 1/m */
  const double     *rubbed; /* the pressure against which cells slip, times the slip, Pa m */
  const PetscReal  *rigid;  /* displacements of the six components, m and rad */
  const PetscReal  *bulk;   /* bulk stresses xx, yy, xy of body 1, then of body 2, Pa */
  PetscReal         volume; /* m3, worn off both bodies until after the step */
  /* the number, and what its objective is asked for */
  const char *name;        /* with what follows an @ */
  PetscInt    first, last; /* steps that it is of */
  PetscInt    component;   /* of a load or displacement */
  PetscBool   moduli;      /* derivatives by the moduli are wanted */
  void       *data;        /* of the objective, during a pass; NULL at first */
  SamTotal    value;       /* this rank's part of the number */
  double      number;      /* the number, if only the objective can tell: a norm; NaN: the sum of `value` */
  double     *by_pressure, *by_shear, *by_slip, *by_pressure_before, *by_shear_before, *by_friction;
  double     *by_gap; /* by the gap of the undeformed bodies */
  double *by_worn;    /* by the depth that has been worn off until after the step, which is in the gap of later steps */
  double *by_open;    /* by the gap of open cells after the step, besides what is in `by_gap` */
  double  by_rigid[SAM_COMPONENTS], by_load[SAM_COMPONENTS], by_bulk[6];
  double  by_moduli[4]; /* besides those through the tractions: by E and nu of body 1, then of body 2 */
  double *by_number;    /* by the number of the law that is asked (SamLaw, `number`), on all ranks */
  /* of the pass, with its context; collective */
  void *context;
  /* gets the tractions of a step on the whole grid, pressure and shear (Pa, three components), and its bulk stresses */
  PetscErrorCode (*read)(void *context, PetscInt step, Vec tractions, const PetscReal **bulk);
  /* takes a field of the whole grid to an array of this part */
  PetscErrorCode (*take)(const void *context, Vec whole, double array[]);
  /* solves the adjoint of a normal problem with this pressure (Pa), whose surfaces also yield by `soft` (m/Pa), and
     some given loads: l, 0 outside of the contact, and the derivatives by the loads */
  PetscErrorCode (*normal)(void *context, const double pressure[], const double soft[], const double right[],
                           const PetscBool force[3], double l[], double forces[3]);
  /* adds to the derivatives by the tractions and displacements of the step those by the gap, and by the lift by the
     shear, of each cell */
  PetscErrorCode (*open)(void *context, const double by_gap[], const double by_lift[]);
} SamBackStep;

/*
  SamBackFindRubbed - computes what is rubbed in the step. Not collective.
  SamBackAddRubbed - adds the derivatives of the sum over cells of a factor times what is rubbed. Collective.
  SamBackSumMoments - sums an array over all cells of the part, and its products with x and with y (m), the same on any
  number of ranks. Collective.
*/
PETSC_INTERN void           SamBackFindRubbed(const SamBackStep *step, double rubbed[]);
PETSC_EXTERN PetscErrorCode SamBackAddRubbed(SamBackStep *step, const double factor[]);
PETSC_INTERN PetscErrorCode SamBackSumMoments(SamGrid part, const double values[], double sums[3]);

#endif
