/* The inside of SamElasticity, for its types and for those who add some. */
#ifndef PETSAM_ELASTICITYIMPL_H
#define PETSAM_ELASTICITYIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/elasticity.h>
#include <petsam/fourier.h>

/*
  SamElasticityOps - the methods of a type; NULL where it has none. in[c] and out[c] are component c of a field, arrays
  of this rank's cells, and out may be in. All but destroy are called after setup, and collectively. Results must not
  depend on the number of ranks.
*/
typedef struct {
  PetscErrorCode (*setfromoptions)(SamElasticity, const SamOptions *from); /* the type's own options */
  PetscErrorCode (*inherit)(SamElasticity parent, SamElasticity child);    /* settings, to a coarse grid or a part */
  PetscErrorCode (*setup)(SamElasticity);
  PetscErrorCode (*destroy)(SamElasticity); /* frees `data` */
  /* required: products, with `factor` in single precision, preconditioners, and a cell's influence on itself */
  PetscErrorCode (*applynormal)(SamElasticity, const double *const p[], double *const u_z[]);
  PetscErrorCode (*applytangential)(SamElasticity, const double *const q[], double *const u_t[]);
  PetscErrorCode (*applynormalsingle)(SamElasticity, double factor, const float *const p[], float *const u_z[]);
  PetscErrorCode (*applytangentialsingle)(SamElasticity, double factor, const float *const q[], float *const u_t[]);
  PetscErrorCode (*preconditionnormal)(SamElasticity, double factor, const float *const r[], float *const p[]);
  PetscErrorCode (*preconditiontangential)(SamElasticity, double factor, const float *const r[], float *const q[]);
  PetscErrorCode (*getselfinfluence)(SamElasticity, PetscReal *normal, PetscReal *tangential);
  /* required if the traits say coupled */
  PetscErrorCode (*applynormaltotangential)(SamElasticity, const double *const p[], double *const u_t[]);
  PetscErrorCode (*applytangentialtonormal)(SamElasticity, const double *const q[], double *const u_z[]);
  /* required if the traits say within */
  PetscErrorCode (*applynormalslopes)(SamElasticity, const double *const slopes[], double *const u_z[]);
  PetscErrorCode (*applytangentialslopes)(SamElasticity, int axis, const double *const slopes[], double *const u_t[]);
  PetscErrorCode (*getnear)(SamElasticity, SamElasticityKernel, PetscInt reach, PetscInt sub, double table[]);
} SamElasticityOps;

/* Where only some cells have traction: those cells as a grid of their own, and the operator on it. */
typedef struct {
  SamWindow     window; /* NULL: no part */
  SamElasticity elasticity;
} SamElasticityPart;

struct _n_SamElasticity {
  PetscInt references;
  SamGrid  grid;
  SamPair  pair;
  /* settings */
  char               type[64], prefix[SAM_PREFIX];
  SamFourierSettings fft;
  /* of the type, set by its create function; the data may be allocated there or in setup */
  SamElasticityOps    ops;
  SamElasticityTraits traits;
  void               *data;
  SamFourier          fourier; /* made in setup by types that use one; the class trims and destroys it */
  PetscBool           is_set_up;
  /* derived operators */
  SamElasticity     coarse;
  SamTransfer       transfer;
  SamElasticityPart parts[2]; /* the part in use, and the one before */
  PetscInt          newest;   /* of the two */
  PetscBool         in_part;  /* it is in use; else none is */
};

/* SamElasticityCreateLike - on another grid: the same type, bodies and settings. Collective. */
PETSC_EXTERN PetscErrorCode SamElasticityCreateLike(SamElasticity parent, SamGrid grid, SamElasticity *child);
/* SamElasticityDestroyParts - forgets both parts. Collective. */
PETSC_EXTERN PetscErrorCode SamElasticityDestroyParts(SamElasticity elasticity);
/* Whether the coupling coefficient of a pair is more than rounding. */
PETSC_EXTERN PetscBool SamElasticityPairIsCoupled(const SamPair *pair);

PETSC_EXTERN PetscErrorCode SamElasticityCreate_HalfSpace(SamElasticity elasticity);
PETSC_EXTERN PetscErrorCode SamElasticityCreate_Periodic(SamElasticity elasticity);

#endif
