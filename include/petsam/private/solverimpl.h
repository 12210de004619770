/*
  The inside of SamSolver, for its kinds and for methods, also those from outside of the library.

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
  SamLevelApply() and its relatives, which count, calls SamLevelIterated() after each iteration, and sets
  level->traction, level->rigid, solver->reason and solver->error.
*/
#ifndef PETSAM_SOLVERIMPL_H
#define PETSAM_SOLVERIMPL_H

#include <petsam/private/balanceimpl.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <petsam/solver.h>

#define SAM_MONITORS 5 /* most of one solver */
#define SAM_GIVEN    2 /* most given fields of a kind of problem */

/*
  SamProduct - the operator's product with a traction, kept from one solve to the next: a solve that starts from that
  traction needs none to begin with. Methods that can use and keep it set solver->keeps_product.
*/
typedef struct {
  Vec      field;          /* S p or C q, m */
  PetscInt first[2], n[2]; /* the rectangle of cells where it is right; n = 0: nowhere */
  double   rounding;       /* of it, as the method counts it */
} SamProduct;

/* The problem on one grid, as a method meets it: one of the nested grids, the whole finest grid or a window of it. */
typedef struct {
  SamElasticity elasticity;
  SamGrid       grid;
  SamFrame      frame;            /* the rigid-body displacements in this grid's coordinates */
  SamBalance   *balance;          /* what is controlled; the kind writes the results into it */
  Vec           given[SAM_GIVEN]; /* the given fields, as the kind's header numbers them; NULL: zero */
  Vec           traction;         /* the unknown: start and result */
  SamProduct   *product;          /* NULL: not to be kept */
  PetscReal     rtol;
  PetscBool     finest; /* only work on the finest grid is counted and shown to monitors */
  double rigid[3];      /* start and result: rigid-body displacement as a combination of the phi, fixed part included */
} SamLevel;

/* Where the traction of a level comes from when its solve begins. */
typedef enum {
  SAM_START_NONE,   /* nowhere: it is zero or not set */
  SAM_START_COARSE, /* from the next coarser grid */
  SAM_START_GUESS   /* from the caller */
} SamStart;

/*
  SamEffort - what the next solves are for, when the problem is part of another one: all of it; a solution that need not
  be checked outside of its window by a product, as later ones will be; what a few iterations bring; only the error of
  the start; or all of it if the start is NEAR. The last three may end with SAM_SOLVER_DIVERGED_ITS, which is no error
  then.
*/
typedef enum {
  SAM_EFFORT_FULL,
  SAM_EFFORT_CHECK_SUPPORT,
  SAM_EFFORT_FEW_ITERATIONS,
  SAM_EFFORT_RESIDUAL_ONLY,
  SAM_EFFORT_WARM
} SamEffort;
#define SAM_NEAR 5e-3 /* the largest error of a start that is near */

typedef struct _n_SamSolverKind SamSolverKind;
struct _n_SamSolverKind {
  const char    *name;       /* "normal": in the names of options and in messages */
  const char    *error_help; /* what the relative error is */
  SamBalanceKind balance;
  SamEvent       event;
  PetscReal      rtol, coarse_rtol;           /* default, and the least on coarse grids */
  PetscInt       components;                  /* of the traction */
  PetscInt       given_components[SAM_GIVEN]; /* of the given fields */
  PetscInt       diagonal; /* the given field that is added to the operator's diagonal, m/Pa, one component; -1: none */
  /* the influence operator of this kind and its approximate inverse */
  PetscErrorCode (*apply)(SamElasticity elasticity, Vec traction, Vec u);
  PetscErrorCode (*applysingle)(SamElasticity elasticity, double factor, const float traction[], float u[]);
  PetscErrorCode (*preconditionsingle)(SamElasticity elasticity, double factor, const float r[], float z[]);
  /* the whole solve, on the level of the finest grid: sets the reason, the traction and the balance */
  PetscErrorCode (*solve)(SamSolver solver, SamLevel *level, PetscBool guess);
  /* one of the nested grids, from that start: sets the reason, the traction and the rigid-body displacement */
  PetscErrorCode (*solvelevel)(SamSolver solver, SamLevel *level, SamStart start);
  /* the start of a level from the solution on the next coarser grid */
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
  /* fixed at creation */
  SamSolverKind *kind;
  MPI_Comm       comm;
  SamElasticity  elasticity;
  /* what the type sets; all but solve may be NULL */
  struct {
    PetscErrorCode (*solve)(SamSolver solver, SamLevel *level);
    PetscErrorCode (*setfromoptions)(SamSolver solver, const SamOptions *from); /* prefix up to `<kind>_` */
    PetscErrorCode (*view)(SamSolver solver, PetscViewer viewer);
    PetscErrorCode (*destroy)(SamSolver solver); /* frees `data` */
  } ops;
  void     *data; /* the type's own */
  PetscInt  default_levels, default_max_it;
  PetscBool keeps_product;
  PetscBool limits_pressure; /* normal: obeys frame.most */
  PetscBool upwind;          /* tangential: solves problems of upwind operators, and no others */
  /* what the user set; 0 stands for the type's default */
  char             type[64], prefix[SAM_PREFIX + 16]; /* the prefix with `<kind>_` */
  PetscReal        rtol;
  PetscReal        pressure_limit; /* normal: Pa; infinite: none */
  PetscInt         max_it, levels;
  PetscBool        monitor_error, error_if_not_converged;
  PetscInt         monitors;
  SamSolverMonitor monitor[SAM_MONITORS];
  void            *monitor_context[SAM_MONITORS];
  /* of the next solves */
  SamEffort effort;
  PetscReal enough; /* relative error that is enough; 0: the user's rtol */
  /* of the last solve, on the finest grid */
  SamSolverReason reason;
  PetscReal       error;
  PetscInt        iterations, applies, preconditions;
  PetscReal       limit; /* tangential: factor on the loads at which sliding begins; infinite: not looked for */
};

/* ---- for kinds ---- */

PETSC_INTERN PetscErrorCode SamSolverCreate(SamSolverKind *kind, SamElasticity elasticity, SamSolver *solver);
PETSC_INTERN PetscErrorCode SamSolverDestroy(SamSolver solver);
PETSC_INTERN PetscErrorCode SamSolverRegister(SamSolverKind *kind, const char name[],
                                              PetscErrorCode (*create)(SamSolver));
/*
  SamSolverSolve - checks the kind of the balance, clears the counts, solves, views. Of `problem` the balance,
  the given fields and the traction are used. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolverSolve(SamSolver solver, const SamLevel *problem, PetscBool guess);
/* SamSolverViewFromOptions - obeys -<kind>_view and -<kind>_converged_reason after a solve. Collective. */
PETSC_INTERN PetscErrorCode SamSolverViewFromOptions(SamSolver solver);

/*
  SamLevelSolveNested - solves on the level's grid, first on up to depth - 1 coarser ones, each of which gives the next
  finer one its start. A guess makes coarser grids needless. Coarse grids are solved only as well as they approximate
  the finest one. Collective.
*/
PETSC_INTERN PetscErrorCode SamLevelSolveNested(SamSolver solver, SamLevel *level, PetscInt depth, PetscBool guess);

/*
  SamLevelSolveInWindow - takes the given fields, and with `guess` the traction, out of a level into a window of it, has
  `solve` solve there, and puts the traction back, zero outside. The rigid-body displacement then is that of the
  window's frame, which becomes the level's. Collective.
*/
typedef PetscErrorCode (*SamLevelSolver)(SamSolver solver, SamLevel *level, PetscBool guess);
PETSC_INTERN PetscErrorCode SamLevelSolveInWindow(SamSolver solver, SamLevel *whole, SamWindow window,
                                                  SamElasticity part, PetscBool guess, SamLevelSolver solve);

/*
  SamSolverSetEffort - the effort of the next solves, and the relative error that is enough (0: the user's rtol). Not
  collective.
*/
PETSC_INTERN void SamSolverSetEffort(SamSolver solver, PetscReal rtol, SamEffort effort);
/* SamLevelHasProduct - whether the level's product is valid everywhere. Not collective. */
PETSC_INTERN PetscBool SamLevelHasProduct(const SamLevel *level);
/* SamLevelKeepProduct - marks it as valid everywhere, with this rounding. Not collective. */
PETSC_INTERN void SamLevelKeepProduct(SamLevel *level, double rounding);
/* SamLevelForgetProduct - marks it as invalid. Not collective. */
PETSC_INTERN void SamLevelForgetProduct(SamLevel *level);

/* SamLevelGetRigid - writes a level's rigid-body displacement into the force-controlled components of a balance. */
PETSC_INTERN void SamLevelGetRigid(const SamLevel *level, SamBalance *balance);

/* ---- for methods ---- */

/* Settings in force: the user's, or the type's defaults. */
PETSC_EXTERN PetscInt SamSolverMaxIterations(SamSolver solver);
PETSC_INTERN PetscInt SamSolverLevels(SamSolver solver);

/*
  SamLevelApply - u = S p or C q, whichever the kind has, with what is added to its diagonal.
  SamLevelApplySingle - `factor` times that, in single precision, for arrays of this rank's cells.
  SamLevelPreconditionSingle - `factor` times the approximate inverse.
  Input and output may be the same. All count on the finest grid. Collective.
*/
PETSC_EXTERN PetscErrorCode SamLevelApply(SamSolver solver, SamLevel *level, Vec traction, Vec u);
PETSC_INTERN PetscErrorCode SamLevelApplySingle(SamSolver solver, SamLevel *level, double factor,
                                                const float traction[], float u[]);
PETSC_INTERN PetscErrorCode SamLevelPreconditionSingle(SamSolver solver, SamLevel *level, double factor,
                                                       const float r[], float z[]);

/* SamLevelIterated - counts an iteration and calls the monitors, on the finest grid. Collective. */
PETSC_EXTERN PetscErrorCode SamLevelIterated(SamSolver solver, SamLevel *level, PetscReal error);

/* SamLevelAtMaxIterations - whether this is the finest grid, and max_it iterations have been made. Not collective. */
PETSC_INTERN PetscBool SamLevelAtMaxIterations(SamSolver solver, const SamLevel *level);

/*
  A method computes its gradient (the gap, the slip) in double precision once, and then adds to it the products of its
  steps, which are in single precision at half the cost. Each of them has an error of about this much, relative to its
  size. The method keeps a bound of what these errors have added up to; where that matters, it computes the gradient
  anew in double precision.
*/
#define SAM_SINGLE_ROUNDING 3e-7

#endif
