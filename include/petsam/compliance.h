/* The influence of surface tractions on surface displacements, and its approximate inverse. */
#ifndef PETSAM_COMPLIANCE_H
#define PETSAM_COMPLIANCE_H

#include <petsam/grid.h>
#include <petsam/material.h>
#include <petscmat.h>
#include <petscpc.h>

/*
  SamCompliance - the 3 x 3 influence operator of a pair of half-spaces on a grid: relative elastic displacements u (m)
  from tractions constant on each cell (Pa). Pressure p acts on both bodies, shear q on body 2 (and -q on body 1).
  u_z is the sum of both bodies' inward displacements, (u_x, u_y) = displacement of body 2 minus that of body 1, so that
  the operator is symmetric and a force on body 1 drags u along.
  Kernels are tabulated when they are first needed. The object also holds the coarser operators of the nested grids.
*/
typedef struct _n_SamCompliance *SamCompliance;

/* SamComplianceCreate - copies the pair, references the grid. Collective. */
PETSC_EXTERN PetscErrorCode SamComplianceCreate(SamGrid grid, const SamPair *pair, SamCompliance *compliance);
PETSC_EXTERN PetscErrorCode SamComplianceReference(SamCompliance compliance);
PETSC_EXTERN PetscErrorCode SamComplianceDestroy(SamCompliance *compliance);
PETSC_EXTERN PetscErrorCode SamComplianceGetGrid(SamCompliance compliance, SamGrid *grid); /* borrowed */
PETSC_EXTERN PetscErrorCode SamComplianceGetPair(SamCompliance compliance, const SamPair **pair); /* borrowed */
/*
  SamComplianceGetCoarse - the operator on the next coarser grid, and the transfer to it; both borrowed, NULL when the
  grid is too small to be halved (fewer than 32 cells in a direction). Made at the first call. Collective.
*/
PETSC_EXTERN PetscErrorCode SamComplianceGetCoarse(SamCompliance compliance, SamCompliance *coarse, SamTransfer *transfer);
/*
  SamComplianceRelease - frees what is made again when it is needed: the transforms' memory, the kernels of the coarser operators
  and of the part, and, with `own`, the operator's own kernels. Collective.
*/
PETSC_EXTERN PetscErrorCode SamComplianceRelease(SamCompliance compliance, PetscBool own);

/*
  The operator on a part of the grid, one at a time, which stays until another is chosen; all collective, the window and the
  operator borrowed, NULL when there is none.
  SamComplianceChoosePart - a part that holds the n[0] * n[1] cells from first[0], first[1] on and some more about them; none
  where it would be hardly smaller than the grid. `keep`: one that holds these cells and is not much too large stays.
  SamComplianceSetPart - just those cells; n = 0: none; one that is just these stays. GetPartPlace tells them.
*/
PETSC_EXTERN PetscErrorCode SamComplianceChoosePart(SamCompliance compliance, const PetscInt first[2], const PetscInt n[2], PetscBool keep, SamWindow *window, SamCompliance *part);
PETSC_EXTERN PetscErrorCode SamComplianceSetPart(SamCompliance compliance, const PetscInt first[2], const PetscInt n[2]);
PETSC_EXTERN PetscErrorCode SamComplianceGetPartPlace(SamCompliance compliance, PetscInt first[2], PetscInt n[2]);

/* Products, all collective. One-component fields p, u_z; two-component fields q, u_t. Input and output may be the same. */
PETSC_EXTERN PetscErrorCode SamComplianceApplyNormal(SamCompliance compliance, Vec p, Vec u_z);      /* u_z from p */
PETSC_EXTERN PetscErrorCode SamComplianceApplyTangential(SamCompliance compliance, Vec q, Vec u_t);  /* u_t from q */
PETSC_EXTERN PetscErrorCode SamComplianceApplyNormalToTangential(SamCompliance compliance, Vec p, Vec u_t); /* u_t from p */
PETSC_EXTERN PetscErrorCode SamComplianceApplyTangentialToNormal(SamCompliance compliance, Vec q, Vec u_z); /* u_z from q */
/*
  The same in single precision: arrays of this rank's cells, two components one after the other; `factor` times the product.
  For directions and corrections, whose product is small against what it is added to. Scale so that input and result are of
  the order of one: floats end at 1e-38. Collective.
*/
PETSC_EXTERN PetscErrorCode SamComplianceApplyNormalSingle(SamCompliance compliance, double factor, const float p[], float u_z[]);
PETSC_EXTERN PetscErrorCode SamComplianceApplyTangentialSingle(SamCompliance compliance, double factor, const float q[], float u_t[]);
/* SamComplianceIsCoupled - whether pressure moves the surfaces tangentially (Dundurs' beta is not zero). */
PETSC_EXTERN PetscErrorCode SamComplianceIsCoupled(SamCompliance compliance, PetscBool *coupled);

/*
  Approximate inverses, symmetric positive, by the symbol of the half-space: |k| for the normal part and
  |k| (I + nu/(1 - nu) kk'/|k|^2) for the tangential one, on the periodic grid; the mean gets half the gain of the longest
  wave. Computed in single precision; `factor` times the result in the functions of float arrays, which see above. Collective.
*/
PETSC_EXTERN PetscErrorCode SamCompliancePreconditionNormalSingle(SamCompliance compliance, double factor, const float residual[], float p[]);
PETSC_EXTERN PetscErrorCode SamCompliancePreconditionTangentialSingle(SamCompliance compliance, double factor, const float residual[], float q[]);
PETSC_EXTERN PetscErrorCode SamCompliancePreconditionNormal(SamCompliance compliance, Vec residual, Vec p);
PETSC_EXTERN PetscErrorCode SamCompliancePreconditionTangential(SamCompliance compliance, Vec residual, Vec q);

/*
  SamComplianceGetSelfInfluence - displacement of a cell's centre under unit traction on that cell alone, m/Pa: u_z from
  p, and the larger of u_x from q_x and u_y from q_y.
*/
PETSC_EXTERN PetscErrorCode SamComplianceGetSelfInfluence(SamCompliance compliance, PetscReal *normal, PetscReal *tangential);

/* The same products as PETSc objects, for use with KSP and the like. The compliance must outlive them. Collective. */
PETSC_EXTERN PetscErrorCode SamComplianceCreateMat(SamCompliance compliance, PetscInt components, Mat *mat);
PETSC_EXTERN PetscErrorCode SamComplianceCreatePC(SamCompliance compliance, PetscInt components, PC *pc);

#endif
