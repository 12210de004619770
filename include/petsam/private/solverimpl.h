/*
  The implementation of SamSolver, for its kinds and for methods, also those from outside of the library.

  A method is a function that solves the problem on one grid, a SamLevel. Its create function, registered by
  SamNormalRegister() or SamTangentialRegister(), sets solver->ops.solve and the defaults:

      PetscErrorCode SamNormalCreate_Mine(SamSolver solver)
      {
        solver->ops.solve      = SamNormalSolve_Mine;
        solver->default_levels = 1;
        solver->default_max_it = 1000;
        return PETSC_SUCCESS;
      }

  The solve function finds an admissible start in level->traction (see the kind's header), applies the operators by
  SamLevelApply() and similar functions, which count the products, calls SamLevelIterated() after each iteration, and
  sets level->traction, level->rigid, solver->reason and solver->error.
*/
#ifndef PETSAM_SOLVERIMPL_H
#define PETSAM_SOLVERIMPL_H

#include <petsam/private/balanceimpl.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <petsam/private/solver.h>
#include <petsam/solver.h>

#define SAM_MONITORS 5 /* most monitors of one solver */
#define SAM_GIVEN    2 /* most given fields of a kind of problem */

/*
  SamProduct - the operator's product with a traction, kept from one solve to the next: a solve that starts from this
  traction needs no first product. Methods that can use and keep it set solver->keeps_product.
*/
typedef struct {
  Vec      field;          /* S p or C q, m */
  PetscInt first[2], n[2]; /* rectangle of cells where it is valid; n = 0: nowhere */
  double   rounding;       /* accumulated rounding, in the method's measure */
} SamProduct;

/*
  SamLevel - the problem on one grid for a method: on one of the nested grids, the whole finest grid or a window of it.
*/
typedef struct {
  SamElasticity elasticity;
  SamGrid       grid;
  SamFrame      frame;            /* the rigid-body displacements in this grid's coordinates */
  SamBalance   *balance;          /* controlled components; the kind writes the results into it */
  Vec           given[SAM_GIVEN]; /* the given fields, as the kind's header numbers them; NULL: zero */
  Vec           traction;         /* the unknown: start and result */
  SamProduct   *product;          /* NULL: not to be kept */
  PetscReal     rtol;
  PetscInt      depth; /* of the nested grid: 0, the finest one, whose work alone is shown to monitors, 1 and so on */
  PetscInt      iterations; /* so far on this grid */
  double rigid[3]; /* start and result: rigid-body displacement as a combination of the phi, fixed part included */
} SamLevel;

/* SamStart - the origin of a level's traction at the start of its solve. */
typedef enum {
  SAM_START_NONE,   /* none: it is zero or not set */
  SAM_START_COARSE, /* the next coarser grid */
  SAM_START_GUESS   /* the caller's guess */
} SamStart;

/*
  SamEffort - the effort of the next solves, if the problem is part of another one. FULL: a complete solution;
  CHECK_SUPPORT: a solution without a check by a product outside of its window, since later solutions are checked;
  FEW_ITERATIONS: the progress of a few iterations; RESIDUAL_ONLY: the error of the start; WARM: a complete solution if
  the error of the start is at most SAM_NEAR. The last three may end with SAM_SOLVER_DIVERGED_ITS, which is then no
  error.
*/
typedef enum {
  SAM_EFFORT_FULL,
  SAM_EFFORT_CHECK_SUPPORT,
  SAM_EFFORT_FEW_ITERATIONS,
  SAM_EFFORT_RESIDUAL_ONLY,
  SAM_EFFORT_WARM
} SamEffort;
#define SAM_NEAR 5e-3 /* largest error of a start for SAM_EFFORT_WARM */

typedef struct _n_SamSolverKind SamSolverKind;
struct _n_SamSolverKind {
  SamClassId     class_id;   /* of solvers of this kind */
  const char    *name;       /* "normal": in the names of options and in messages */
  const char    *error_help; /* definition of the relative error */
  SamBalanceKind balance;
  SamEvent       event;
  PetscReal      rtol, coarse_rtol;           /* default, and smallest value on coarse grids */
  PetscInt       components;                  /* number of components of the traction */
  PetscInt       given_components[SAM_GIVEN]; /* numbers of components of the given fields */
  PetscInt diagonal; /* index of the given field (m/Pa, one component) added to the operator's diagonal; -1: none */
  /* the influence operator of this kind and its approximate inverse */
  PetscErrorCode (*apply)(SamElasticity elasticity, Vec traction, Vec u);
  PetscErrorCode (*applysingle)(SamElasticity elasticity, double factor, const float traction[], float u[]);
  PetscErrorCode (*preconditionsingle)(SamElasticity elasticity, double factor, const float r[], float z[]);
  /* does the whole solve, on the level of the finest grid: sets the reason, the traction and the balance */
  PetscErrorCode (*solve)(SamSolver solver, SamLevel *level, PetscBool guess);
  /*
    solves on one of the nested grids, from that start: sets the reason, the traction and the rigid-body displacement
  */
  PetscErrorCode (*solvelevel)(SamSolver solver, SamLevel *level, SamStart start);
  /* sets the start of a level from the solution on the next coarser grid */
  PetscErrorCode (*prolong)(SamTransfer transfer, const SamLevel *coarse, SamLevel *fine);
  /* the default type, and that for upwind operators (NULL: the same) */
  SamSolverType type, upwind;
  PetscErrorCode (*create)(SamSolver);
  PetscErrorCode (*createupwind)(SamSolver);
  /* the registry */
  PetscFunctionList types;
  SamSolverKind    *next;
};

struct _n_SamSolver {
  SamClassId class_id;
  /* fixed at creation */
  SamSolverKind *kind;
  MPI_Comm       comm;
  SamElasticity  elasticity;
  /* set by the type; all but solve may be NULL */
  struct {
    PetscErrorCode (*solve)(SamSolver solver, SamLevel *level);
    PetscErrorCode (*setfromoptions)(SamSolver solver, const SamOptions *from); /* prefix up to `<kind>_` */
    PetscErrorCode (*view)(SamSolver solver, PetscViewer viewer);
    PetscErrorCode (*destroy)(SamSolver solver); /* frees `data` */
  } ops;
  void     *data; /* data of the type */
  PetscInt  default_levels, default_max_it;
  PetscBool keeps_product;
  PetscBool limits_pressure; /* normal: respects frame.most */
  PetscBool upwind;          /* tangential: solves problems of upwind operators, and no others */
  /* set by the user; 0 stands for the type's default */
  char             type[64], prefix[SAM_PREFIX + 16]; /* the prefix with `<kind>_` */
  PetscReal        rtol;
  PetscReal        pressure_limit; /* normal: Pa; infinite: none */
  PetscInt         max_it, levels;
  PetscBool        monitor_error, error_if_not_converged;
  PetscInt         monitors;
  SamSolverMonitor monitor[SAM_MONITORS];
  void            *monitor_context[SAM_MONITORS];
  /* settings of the next solves */
  SamEffort effort;
  PetscReal enough; /* relative error that is enough; 0: the user's rtol */
  /* results of the last solve, on the finest grid */
  SamSolverReason reason;
  PetscReal       error;
  PetscInt        iterations, applies, preconditions;
  SamLevelWork    work[SAM_NESTED]; /* by the depth of the grid, of all solves */
  PetscReal       limit; /* tangential: factor on the loads at which sliding begins; infinite: not computed */
};

/* ---- for kinds ---- */

PETSC_INTERN PetscErrorCode SamSolverCreate(SamSolverKind *kind, SamElasticity elasticity, SamSolver *solver);
PETSC_INTERN PetscErrorCode SamSolverDestroy(SamSolver solver);
PETSC_INTERN PetscErrorCode SamSolverRegister(SamSolverKind *kind, const char name[],
                                              PetscErrorCode (*create)(SamSolver));
/*
  SamSolverSolve - checks the kind of the balance, clears the counts, solves, and views the solver. It uses only the
  balance, the given fields and the traction of `problem`. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolverSolve(SamSolver solver, const SamLevel *problem, PetscBool guess);
/*
  SamSolverViewFromOptions - prints what -<kind>_view and -<kind>_converged_reason request after a solve. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolverViewFromOptions(SamSolver solver);

/*
  SamLevelSolveNested - solves on the level's grid, and before that on up to depth - 1 coarser grids, each of which
  provides the start of the next finer one. With a guess no coarser grids are used. The solution on a coarse grid is
  only as accurate as that grid approximates the finest one. Collective.
*/
PETSC_INTERN PetscErrorCode SamLevelSolveNested(SamSolver solver, SamLevel *level, PetscInt depth, PetscBool guess);

/*
  SamLevelSolveInWindow - copies the given fields, and with `guess` the traction, from a level into a window of it,
  calls `solve` there, and copies the traction back, with zero outside. The rigid-body displacement is then that of the
  window's frame, which becomes the level's frame. Collective.
*/
typedef PetscErrorCode (*SamLevelSolver)(SamSolver solver, SamLevel *level, PetscBool guess);
PETSC_INTERN PetscErrorCode SamLevelSolveInWindow(SamSolver solver, SamLevel *whole, SamWindow window,
                                                  SamElasticity part, PetscBool guess, SamLevelSolver solve);

/*
  SamSolverSetEffort - sets the effort of the next solves, and their tolerance of the relative error (0: the user's
  rtol). Not collective.
*/
PETSC_INTERN void SamSolverSetEffort(SamSolver solver, PetscReal rtol, SamEffort effort);
/* SamLevelHasProduct - returns true if the level's product is valid everywhere. Not collective. */
PETSC_INTERN PetscBool SamLevelHasProduct(const SamLevel *level);
/* SamLevelKeepProduct - marks the product as valid everywhere, with this rounding. Not collective. */
PETSC_INTERN void SamLevelKeepProduct(SamLevel *level, double rounding);
/* SamLevelForgetProduct - marks the product as invalid. Not collective. */
PETSC_INTERN void SamLevelForgetProduct(SamLevel *level);

/* SamLevelGetRigid - writes a level's rigid-body displacement into the force-controlled components of a balance. */
PETSC_INTERN void SamLevelGetRigid(const SamLevel *level, SamBalance *balance);

/* ---- for methods ---- */

/* SamSolverMaxIterations, SamSolverLevels - return the settings in force: the user's, or the type's defaults. */
PETSC_EXTERN PetscInt SamSolverMaxIterations(SamSolver solver);
PETSC_INTERN PetscInt SamSolverLevels(SamSolver solver);

/*
  SamLevelApply - computes u = S p (normal) or C q (tangential), including the given field that is added to the
  diagonal.
  SamLevelApplySingle - computes `factor` times this product, in single precision, for arrays of this rank's cells.
  SamLevelPreconditionSingle - computes `factor` times the product with the approximate inverse.
  Input and output may be the same. All three count their calls on the finest grid. Collective.
*/
PETSC_EXTERN PetscErrorCode SamLevelApply(SamSolver solver, SamLevel *level, Vec traction, Vec u);
PETSC_INTERN PetscErrorCode SamLevelApplySingle(SamSolver solver, SamLevel *level, double factor,
                                                const float traction[], float u[]);
PETSC_INTERN PetscErrorCode SamLevelPreconditionSingle(SamSolver solver, SamLevel *level, double factor,
                                                       const float r[], float z[]);

/* SamLevelIterated - counts an iteration and calls the monitors, on the finest grid. Collective. */
PETSC_EXTERN PetscErrorCode SamLevelIterated(SamSolver solver, SamLevel *level, PetscReal error);

/*
  SamLevelAtMaxIterations - returns true if max_it iterations have been made on the finest grid, or as many on a coarse
  one that its solution, which is only a start, pays no longer. Not collective.
*/
PETSC_INTERN PetscBool SamLevelAtMaxIterations(SamSolver solver, const SamLevel *level);

/*
  SAM_SINGLE_ROUNDING - the approximate relative error of a product in single precision. A method computes its gradient
  (the gap, the slip) once in double precision, and then adds to it the products of its steps in single precision, at
  half the cost. It keeps a bound on the sum of their errors; if that becomes relevant, it computes the gradient again
  in double precision.
*/
#define SAM_SINGLE_ROUNDING 3e-7

#endif
