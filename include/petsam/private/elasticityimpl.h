/* The inside of SamElasticity, for its types and for those who add some. */
#ifndef PETSAM_ELASTICITYIMPL_H
#define PETSAM_ELASTICITYIMPL_H

#include <petsam/private/bodyimpl.h>
#include <petsam/elasticity.h>
#include <petsam/private/fourier.h>
#include <petsam/private/grid.h>
#include <petsam/state.h>

/*
  A type that adds something to another - a half-space and a smooth compliance, for instance - calls
  SamElasticitySetInner() in its create function, which makes an object of that type on the same grid and takes over its
  traits. What the type has no method for is then done by the inner one; its own methods add to
  (*e->inner->ops.applynormal)(e->inner, p, u), and so on. Since u may be p, what depends on p must be taken from it
  before. The class sets up, trims, records and destroys the inner object, gives it the options, and makes another one
  on each coarse grid and each part, as it makes another object of the type itself: `inherit` passes on its settings on
  the finest grid, on which the object's place is first[] and factor[]. tests/unit/test_elasticity_inner.c is a complete
  example.

  SamElasticityOps - the methods of a type; NULL where it has none. in[c] and out[c] are component c of a field, arrays
  of this rank's cells, and out may be in. All but destroy are called after setup, and collectively. Results must not
  depend on the number of ranks.
*/
typedef struct {
  PetscErrorCode (*setfromoptions)(SamElasticity, const SamOptions *from); /* the type's own options */
  PetscErrorCode (*inherit)(SamElasticity parent, SamElasticity child);    /* settings, to a coarse grid or a part */
  PetscErrorCode (*setup)(SamElasticity);
  /* the type's own parameters, all of them always: recorded, also what identifies its files, and set from a record */
  PetscErrorCode (*addparameters)(SamElasticity, SamParameters *);
  PetscErrorCode (*setparameters)(SamElasticity, const SamParameters *, const char source[]);
  PetscErrorCode (*destroy)(SamElasticity); /* frees what `data` refers to; the class frees `data` */
  /* required: products, with `factor` in single precision, preconditioners, and a cell's influence on itself */
  PetscErrorCode (*applynormal)(SamElasticity, const double *const p[], double *const u_z[]);
  PetscErrorCode (*applytangential)(SamElasticity, const double *const q[], double *const u_t[]);
  PetscErrorCode (*applynormalsingle)(SamElasticity, double factor, const float *const p[], float *const u_z[]);
  PetscErrorCode (*applytangentialsingle)(SamElasticity, double factor, const float *const q[], float *const u_t[]);
  PetscErrorCode (*preconditionnormal)(SamElasticity, double factor, const float *const r[], float *const p[]);
  PetscErrorCode (*preconditiontangential)(SamElasticity, double factor, const float *const r[], float *const q[]);
  PetscErrorCode (*getselfinfluence)(SamElasticity, PetscReal *normal, PetscReal *tangential);
  /* for slip where the operator is upwind; NULL: preconditiontangential */
  PetscErrorCode (*preconditionslip)(SamElasticity, double factor, const float *const r[], float *const q[]);
  /* the stresses in a body that is not rigid */
  PetscErrorCode (*createstress)(SamElasticity, PetscInt body, const SamFourierSettings *, SamStress *);
  /* required with the trait coupled */
  PetscErrorCode (*applynormaltotangential)(SamElasticity, const double *const p[], double *const u_t[]);
  PetscErrorCode (*applytangentialtonormal)(SamElasticity, const double *const q[], double *const u_z[]);
  /*
    What bodies remember, and what displaces their surfaces besides the tractions of the step, by the law of bodies
    (law/bodies.c), which calls these methods of each object, the outer ones first; as a law's of the same names
    (lawimpl.h). Products, preconditioners and self-influences of a type that has begin() may be others in each step;
    coarse grids and parts must follow. Tractions are those of the solved step.
  */
  PetscErrorCode (*conditions)(SamElasticity, SamConditions);
  PetscErrorCode (*declare)(SamElasticity, SamState);
  PetscErrorCode (*begin)(SamElasticity, SamState, const SamControl *, PetscReal duration);
  PetscErrorCode (*offset)(SamElasticity, SamConditions, SamState, const SamControl *, Vec u_z, Vec u_t,
                           PetscBool *adds);
  PetscErrorCode (*advance)(SamElasticity, SamState, Vec pressure, Vec shear);
} SamElasticityOps;

/* Where only some cells have traction: those cells as a grid of their own, and the operator on it. */
typedef struct {
  SamWindow     window; /* NULL: no part */
  SamElasticity elasticity;
} SamElasticityPart;

typedef PetscErrorCode (*SamElasticityCreateFunction)(SamElasticity elasticity);
struct _n_SamElasticity {
  PetscInt references;
  SamGrid  grid;
  SamPair  pair;
  /* settings */
  char               type[64], prefix[SAM_PREFIX];
  SamFourierSettings fft;
  /* of the type, set by its create function; the data may be allocated there or in setup */
  SamElasticityOps            ops;
  SamElasticityTraits         traits;
  SamElasticityCreateFunction create;
  PetscBool                   wraps; /* made by SamElasticityWrap() */
  void                       *data;
  SamMotion                   motion; /* of the bodies, for those who use the operator; NULL: the usual one */
  PetscReal     film;    /* m/Pa; of the pair, that the class adds to tangential products; 0 where the type does */
  SamElasticity inner;   /* what the type adds to, by SamElasticitySetInner(); NULL: nothing */
  SamFourier    fourier; /* made in setup by types that use one; the class trims and destroys it */
  PetscBool     is_set_up;
  PetscBool     has_self; /* of a cell on itself, which solvers ask for at each step */
  PetscReal     self[2];
  /* the place on the finest grid: cell (i, j) reaches from first[0] + i factor[0] to first[0] + (i + 1) factor[0] */
  PetscReal first[2], factor[2];
  /* derived operators */
  SamElasticity     coarse;
  SamTransfer       transfer;
  SamElasticityPart parts[2]; /* the part in use, and the one before */
  PetscInt          newest;   /* of the two */
  PetscBool         in_part;  /* it is in use; else none is */
};

/* SamElasticitySetInner - makes the object that a type adds to, in the place of one before; NULL: half-spaces. */
PETSC_EXTERN PetscErrorCode SamElasticitySetInner(SamElasticity elasticity, SamElasticityType type);
/*
  SamElasticityCreateLike - on another grid: the same type, bodies and settings. `first`: the cell of the parent's grid
  where a part of it begins; NULL: the grid is a coarser one. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityCreateLike(SamElasticity parent, SamGrid grid, const PetscInt first[2],
                                                    SamElasticity *child);
/*
  SamElasticityWrap - an object of a type that adds to these bodies, in the place of its own inner one, by its create
  function: no user chooses such a type. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityWrap(SamElasticity bodies, SamElasticityType type,
                                              SamElasticityCreateFunction create, SamElasticity *outer);
/* The object that has a method: this one, or one within. */
#define SamElasticityWith(e, method) \
  while (!(e)->ops.method && (e)->inner) (e) = (e)->inner
/* SamElasticityDestroyParts - forgets both parts. Collective. */
PETSC_INTERN PetscErrorCode SamElasticityDestroyParts(SamElasticity elasticity);

PETSC_INTERN PetscErrorCode SamElasticityCreate_HalfSpace(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreate_Periodic(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreate_Plane(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreate_PlanePeriodic(SamElasticity elasticity);
/* SamElasticityAddRecordedCompliances - as SamElasticityAddCompliances(), from a record; `source` names it. */
PETSC_INTERN PetscErrorCode SamElasticityAddRecordedCompliances(SamElasticity *elasticity, const SamParameters *p,
                                                                const char source[]);
/*
  SamElasticityCreateRolling - the same bodies under a contact that rolls towards +x without change: u_t is the slip by
  the tractions in 1 m of rolled distance, and creepages stand for tangential rigid displacements. References the
  bodies. Collective. Errors: PETSC_ERR_SUP for periodic bodies.
  SamElasticitySpinAhead - how far ahead of a cell's centre spin is taken in it, m; 0 for other bodies. Not collective.
*/
PETSC_INTERN PetscReal      SamElasticitySpinAhead(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreateRolling(SamElasticity bodies, SamElasticity *rolling);

#endif
