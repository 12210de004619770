/* The influence of surface tractions on surface displacements, and its approximate inverse. */
#ifndef PETSAM_ELASTICITY_H
#define PETSAM_ELASTICITY_H

#include <petsam/grid.h>
#include <petsam/material.h>
#include <petscmat.h>
#include <petscpc.h>

/*
  SamElasticity - the 3 x 3 influence operator of a pair of half-spaces on a grid: relative elastic displacements u (m)
  from tractions constant on each cell (Pa). Pressure p acts on both bodies, shear q on body 2 (and -q on body 1).
  u_z is the sum of both bodies' inward displacements, (u_x, u_y) = displacement of body 2 minus that of body 1, so that
  the operator is symmetric and a force on body 1 drags u along.
  Kernels are tabulated when they are first needed. The object also holds the coarser operators of the nested grids.
*/
typedef struct _n_SamElasticity *SamElasticity;

/* SamElasticityCreate - copies the pair, references the grid. Collective. */
PETSC_EXTERN PetscErrorCode SamElasticityCreate(SamGrid grid, const SamPair *pair, SamElasticity *elasticity);
PETSC_EXTERN PetscErrorCode SamElasticityReference(SamElasticity elasticity);
PETSC_EXTERN PetscErrorCode SamElasticityDestroy(SamElasticity *elasticity);
PETSC_EXTERN PetscErrorCode SamElasticityGetGrid(SamElasticity elasticity, SamGrid *grid);        /* borrowed */
PETSC_EXTERN PetscErrorCode SamElasticityGetPair(SamElasticity elasticity, const SamPair **pair); /* borrowed */
/*
  SamElasticityGetCoarse - the operator on the next coarser grid, and the transfer to it; both borrowed, NULL when the
  grid is too small to be halved (fewer than 32 cells in a direction). Made at the first call. Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticityGetCoarse(SamElasticity elasticity, SamElasticity *coarse,
                                                   SamTransfer *transfer);
/*
  SamElasticityRelease - frees what is made again when it is needed: the transforms' memory, the kernels of the coarser
  operators and of the part, and, with `own`, the operator's own kernels. Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticityRelease(SamElasticity elasticity, PetscBool own);

/*
  The operator on a part of the grid, one at a time, which stays until another is chosen; all collective, the window and
  the operator borrowed, NULL when there is none. SamElasticityChoosePart - a part that holds the n[0] * n[1] cells from
  first[0], first[1] on and some more about them; none where it would be hardly smaller than the grid. `keep`: one that
  holds these cells and is not much too large stays. SamElasticitySetPart - just those cells; n = 0: none; one that is
  just these stays. GetPartPlace tells them.
*/
PETSC_EXTERN PetscErrorCode SamElasticityChoosePart(SamElasticity elasticity, const PetscInt first[2],
                                                    const PetscInt n[2], PetscBool keep, SamWindow *window,
                                                    SamElasticity *part);
PETSC_EXTERN PetscErrorCode SamElasticitySetPart(SamElasticity elasticity, const PetscInt first[2],
                                                 const PetscInt n[2]);
PETSC_EXTERN PetscErrorCode SamElasticityGetPartPlace(SamElasticity elasticity, PetscInt first[2], PetscInt n[2]);

/*
  Products, all collective. One-component fields p, u_z; two-component fields q, u_t. Input and output may be the same.
*/
PETSC_EXTERN PetscErrorCode SamElasticityApplyNormal(SamElasticity elasticity, Vec p, Vec u_z);     /* u_z from p */
PETSC_EXTERN PetscErrorCode SamElasticityApplyTangential(SamElasticity elasticity, Vec q, Vec u_t); /* u_t from q */
PETSC_EXTERN PetscErrorCode SamElasticityApplyNormalToTangential(SamElasticity elasticity, Vec p,
                                                                 Vec u_t); /* u_t from p */
PETSC_EXTERN PetscErrorCode SamElasticityApplyTangentialToNormal(SamElasticity elasticity, Vec q,
                                                                 Vec u_z); /* u_z from q */
/*
  The same in single precision: arrays of this rank's cells, two components one after the other; `factor` times the
  product. For directions and corrections, whose product is small against what it is added to. Scale so that input and
  result are of the order of one: floats end at 1e-38. Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticityApplyNormalSingle(SamElasticity elasticity, double factor, const float p[],
                                                           float u_z[]);
PETSC_EXTERN PetscErrorCode SamElasticityApplyTangentialSingle(SamElasticity elasticity, double factor, const float q[],
                                                               float u_t[]);
/* SamElasticityIsCoupled - whether pressure moves the surfaces tangentially (Dundurs' beta is not zero). */
PETSC_EXTERN PetscErrorCode SamElasticityIsCoupled(SamElasticity elasticity, PetscBool *coupled);

/*
  Approximate inverses, symmetric positive, by the symbol of the half-space: |k| for the normal part and
  |k| (I + nu/(1 - nu) kk'/|k|^2) for the tangential one, on the periodic grid; the mean gets half the gain of the
  longest wave. Computed in single precision; `factor` times the result in the functions of float arrays, which see
  above. Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticityPreconditionNormalSingle(SamElasticity elasticity, double factor,
                                                                  const float residual[], float p[]);
PETSC_EXTERN PetscErrorCode SamElasticityPreconditionTangentialSingle(SamElasticity elasticity, double factor,
                                                                      const float residual[], float q[]);
PETSC_EXTERN PetscErrorCode SamElasticityPreconditionNormal(SamElasticity elasticity, Vec residual, Vec p);
PETSC_EXTERN PetscErrorCode SamElasticityPreconditionTangential(SamElasticity elasticity, Vec residual, Vec q);

/*
  SamElasticityGetSelfInfluence - displacement of a cell's centre under unit traction on that cell alone, m/Pa: u_z from
  p, and the larger of u_x from q_x and u_y from q_y.
*/
PETSC_EXTERN PetscErrorCode SamElasticityGetSelfInfluence(SamElasticity elasticity, PetscReal *normal,
                                                          PetscReal *tangential);

/* The same products as PETSc objects, for use with KSP and the like. The compliance must outlive them. Collective. */
PETSC_EXTERN PetscErrorCode SamElasticityCreateMat(SamElasticity elasticity, PetscInt components, Mat *mat);
PETSC_EXTERN PetscErrorCode SamElasticityCreatePC(SamElasticity elasticity, PetscInt components, PC *pc);

#endif
