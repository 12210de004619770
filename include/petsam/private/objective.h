/* Numbers of a load history that have a gradient, for authors of new ones. */
#ifndef PETSAM_OBJECTIVE_H
#define PETSAM_OBJECTIVE_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <petsam/elasticity.h>

/*
  SamObjectiveStep - a step of the history on a part of the grid that has all contacts, as an objective sees it on the
  way back, from the last step to the first: arrays of this rank's cells, two components one after the other. Of the
  arrays and numbers below `value` an objective adds to those on which it depends: derivatives by what the step has, and
  by what the step before has. A cell's derivative is that by the value of the cell.
*/
typedef struct {
  const char       *name; /* of the number, with what follows an @ */
  SamGrid           grid;
  SamElasticity     elasticity;        /* on the whole grid */
  SamWindow         window;            /* the part of it; NULL: it is the whole */
  PetscInt          step, first, last; /* steps of the history; the objective is of those from `first` to `last` */
  PetscInt          component;         /* of a load or displacement */
  double            area;              /* of a cell, m2; in plane strain of 1 m of its length */
  const double     *pressure, *shear, *slip, *friction; /* Pa, Pa, m (of the step), 1 */
  const double     *pressure_before, *shear_before;     /* of the step before; in the first step 0 */
  const double     *share, *by_back, *by_alike;         /* how the pressure before the step counts in what slips */
  const PetscInt64 *end;    /* cells whose slips determine how far all slide alike, on this part of the grid */
  const double     *by_end; /* derivatives of that measure by their lengths, 1/m */
  const PetscReal  *rigid;  /* displacements of the six components, m and rad */
  const PetscReal  *bulk;   /* bulk stresses xx, yy, xy of body 1, then of body 2, Pa */
  const PetscReal  *rate;   /* coefficients of wear, 1/Pa and m3/J */
  const double     *load;   /* wear load after the last jump of a wear simulation; NULL: the steps wear */
  SamTotal          value;  /* this rank's part of the number */
  double            number; /* the number, if only the objective can tell: a norm; NaN: the sum of `value` */
  double           *by_pressure, *by_shear, *by_slip, *by_pressure_before, *by_shear_before, *by_friction, *by_worn;
  double            by_rigid[SAM_COMPONENTS], by_bulk[6];
  PetscBool         moduli;       /* derivatives by the moduli are wanted */
  double            by_moduli[4]; /* besides those through the tractions: by E and nu of body 1, then of body 2 */
  /* gets the tractions of any step on the whole grid, pressure and shear (Pa, three components), and its bulk stresses;
     collective */
  PetscErrorCode (*read)(void *context, PetscInt step, Vec tractions, const PetscReal **bulk);
  void *context; /* of that function */
  void *data;    /* of the objective, during a pass; NULL at first */
} SamObjectiveStep;

/*
  SamObjective - a number with a gradient. `add` adds a step's part of the number and of its derivatives; it is called
  for all steps from the last to the first. `check` checks a name with what follows an @, if `suffix` allows that, for
  these bodies and coefficients of wear; NULL: all are right. `end`: frees the data; NULL: there are none. `bytes`: the
  memory that it takes per cell of the whole grid: during the pass; in one step only; and besides that for each step of
  the history. Collective.
*/
typedef struct {
  const char *name, *unit, *unit_of_row; /* on one row of cells; NULL: as SamUnitOn() has it */
  PetscBool   all;                       /* true: of all steps unless others are given; false: of the last one */
  PetscErrorCode (*add)(SamObjectiveStep *at);
  PetscErrorCode (*check)(SamElasticity elasticity, const PetscReal rate[], const char name[]);
  PetscBool suffix;
  PetscErrorCode (*end)(void *data);
  PetscInt bytes[3];
} SamObjective;

/*
  SamObjectiveRegister - adds an objective, or replaces an earlier one of its name.

  Not collective, but to be called on all ranks.

  In:     objective - the objective; its members are copied, its texts must stay

  Errors: PETSC_ERR_ARG_OUTOFRANGE for more than SAM_OBJECTIVES.

  See also: SamGradientCompute().
*/
#define SAM_OBJECTIVES 32
PETSC_EXTERN PetscErrorCode SamObjectiveRegister(const SamObjective *objective);

#endif
