/* The inside of SamNormal. */
#ifndef PETSAM_NORMALIMPL_H
#define PETSAM_NORMALIMPL_H

#include <petsam/private/balanceimpl.h>
#include <petsam/private/solverimpl.h>
#include <petsam/normal.h>

/* One grid's problem, as a method meets it. */
typedef struct {
  SamElasticity elasticity;
  SamGrid       grid;
  SamFrame      frame;
  Vec           h, p;
  PetscReal     rtol;
  PetscBool     finest;
  double        rigid[3]; /* result: combination of the phi, fixed part included */
} SamNormalLevel;

struct _n_SamNormal {
  SamSolver solver;
  PetscErrorCode (*solve)(SamNormal,
                          SamNormalLevel *); /* the method: solves one level, sets the reason and the error */
  SamElasticity   elasticity;
  SamNormalReason reason;
};

/* Counted products: only those on the finest grid count. */
PETSC_EXTERN PetscErrorCode SamNormalApply(SamNormal normal, SamNormalLevel *level, Vec p, Vec u);
PETSC_EXTERN PetscErrorCode SamNormalApplySingle(SamNormal normal, SamNormalLevel *level, double factor,
                                                 const float p[], float u[]);
PETSC_EXTERN PetscErrorCode SamNormalPreconditionSingle(SamNormal normal, SamNormalLevel *level, double factor,
                                                        const float r[], float z[]);
/* Counts an iteration, calls the monitors. */
PETSC_EXTERN PetscErrorCode SamNormalIterated(SamNormal normal, SamNormalLevel *level, PetscReal error);

PETSC_EXTERN PetscErrorCode SamNormalCreate_ActiveSet(SamNormal normal);
PETSC_EXTERN PetscErrorCode SamNormalCreate_PolonskyKeer(SamNormal normal);

#endif
