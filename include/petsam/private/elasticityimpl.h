/* The implementation of SamElasticity, for its types and for authors of new types. */
#ifndef PETSAM_ELASTICITYIMPL_H
#define PETSAM_ELASTICITYIMPL_H

#include <petsam/private/body.h>
#include <petsam/private/bodyimpl.h>
#include <petsam/elasticity.h>
#include <petsam/private/fourier.h>
#include <petsam/private/grid.h>
#include <petsam/private/stress.h>
#include <petsam/state.h>

/* SamExamination - the examination of a run's steps (private/examination.h). */
typedef struct _n_SamExamination SamExamination;

/*
  SamStream - the creep of bodies whose material streams through the contact: terms, each with the length (m) by which
  the material moves towards -x in its time, and what it adds to the constants of the pair, `sudden`, if it has crept to
  its end. Negative lengths: towards +x.
*/
#define SAM_STREAM_TERMS 40
typedef struct {
  PetscInt terms;
  double   length[SAM_STREAM_TERMS], value[SAM_STREAM_TERMS][SAM_PAIR_CONSTANTS], sudden[SAM_PAIR_CONSTANTS];
} SamStream;

/*
  A type that adds something to another - a half-space and a smooth compliance, for instance - calls
  SamElasticitySetInner() in its create function, which makes an object of that type on the same grid and takes over its
  traits. The inner object then does everything for which the type has no method; the type's own methods add to
  (*e->inner->ops.applynormal)(e->inner, p, u), and so on. Since u may be p, a method must first compute all that
  depends on p. The class sets up, trims, records and destroys the inner object, gives it the options, and creates
  another inner object on each coarse grid and each part, just as it creates another object of the type: `inherit`
  passes on the settings on the finest grid, on which the object's place is first[] and factor[].
  tests/unit/test_elasticity_inner.c is a complete example.

  SamElasticityOps - the methods of a type; NULL if it has none. in[c] and out[c] are component c of a field, arrays of
  this rank's cells, and out may be in. All but destroy are called after setup, and collectively. Results must not
  depend on the number of ranks.
*/
typedef struct {
  PetscErrorCode (*setfromoptions)(SamElasticity, const SamOptions *from); /* the type's own options */
  PetscErrorCode (*inherit)(SamElasticity parent, SamElasticity child);    /* settings, to a coarse grid or a part */
  PetscErrorCode (*setup)(SamElasticity);
  /* appends all parameters of the type, also those that identify its files; sets them from recorded ones */
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
  /* preconditioner of pressure that takes shear with it; NULL: preconditionnormal */
  PetscErrorCode (*preconditionsliding)(SamElasticity, double factor, const double slope[2], const float *const r[],
                                        float *const p[]);
  /* preconditioner of the slip zone if the operator is upwind; NULL: preconditiontangential */
  PetscErrorCode (*preconditionslip)(SamElasticity, double factor, const float *const r[], float *const q[]);
  /* the stresses in a body that is not rigid */
  PetscErrorCode (*createstress)(SamElasticity, PetscInt body, const SamFourierSettings *, SamStress *);
  /* required with the trait coupled */
  PetscErrorCode (*applynormaltotangential)(SamElasticity, const double *const p[], double *const u_t[]);
  PetscErrorCode (*applytangentialtonormal)(SamElasticity, const double *const q[], double *const u_z[]);
  /*
    Methods for stored fields of bodies, and for displacements of their surfaces besides those by the tractions of the
    step. The law of bodies (laws/bodies.c) calls these methods of each object, outer objects first; they correspond to
    a law's methods of the same names (lawimpl.h). A type with begin() may have other products, preconditioners and
    self-influences in each step; its coarse grids and parts must follow. Tractions are those of the solved step.
  */
  PetscErrorCode (*conditions)(SamElasticity, SamConditions);
  PetscErrorCode (*declare)(SamElasticity, SamState);
  PetscErrorCode (*begin)(SamElasticity, SamState, const SamControl *, PetscReal duration);
  PetscErrorCode (*displace)(SamElasticity, SamConditions, SamState, const SamControl *, Vec u_z, Vec u_t,
                             PetscBool *adds);
  PetscErrorCode (*advance)(SamElasticity, SamState, Vec pressure, Vec shear);
  PetscErrorCode (*examine)(SamElasticity, SamExamination *);
  PetscErrorCode (*doubt)(SamElasticity, SamExamination *);
  /* of a type with begin(): makes the products those of a steady state in which material streams through the contact
     towards -x, at -rolling_speed, so that no step has a memory; NULL: there are none */
  PetscErrorCode (*stream)(SamElasticity, const SamOptions *from);
  /* of bodies without layers: makes their products, before any is computed, those of material that creeps while it
     streams; without terms: takes the creep away */
  PetscErrorCode (*setstream)(SamElasticity, const SamStream *);
  /* differentiates fields along x, m/m; NULL: differences of neighbouring cells are as accurate */
  PetscErrorCode (*slope)(SamElasticity, const double *const h[], double *const slope[]);
  /* required with the trait skewed: creates bodies on the same grid as solvers of normal problems need them */
  PetscErrorCode (*createsymmetric)(SamElasticity, SamElasticity *symmetric);
} SamElasticityOps;

/*
  SamElasticityPart - a part of the grid that contains all cells with traction, as a grid of its own, and the operator
  on it.
*/
typedef struct {
  SamWindow     window; /* NULL: no part */
  SamElasticity elasticity;
} SamElasticityPart;

typedef PetscErrorCode (*SamElasticityCreateFunction)(SamElasticity elasticity);
struct _n_SamElasticity {
  SamClassId class_id;
  PetscInt   references;
  SamGrid    grid;
  SamPair    pair;
  /* settings */
  char               type[64], prefix[SAM_PREFIX];
  SamFourierSettings fft;
  /* members of the type, set by its create function; the data may be allocated there or in setup */
  SamElasticityOps            ops;
  SamElasticityTraits         traits;
  SamElasticityCreateFunction create;
  PetscInt                    bytes;  /* memory of what it remembers, per cell */
  const char                 *option; /* that messages name where what it remembers is rejected; NULL: -elasticity */
  PetscBool                   wraps;  /* made by SamElasticityWrap() */
  void                       *data;
  SamMotion                   motion; /* motion of the bodies, for users of the operator; NULL: the usual one */
  PetscReal film; /* compliance of the film, m/Pa, that the class adds to tangential products; 0 if the type adds it */
  SamElasticity inner;   /* object that the type adds to, by SamElasticitySetInner(); NULL: none */
  SamFourier    fourier; /* made in setup by types that use one; the class trims and destroys it */
  PetscBool     is_set_up;
  PetscBool has_self; /* true: `self` is known, the influence of a cell on itself, which solvers need in each step */
  PetscReal self[2];
  /* the place on the finest grid: cell (i, j) reaches from first[0] + i factor[0] to first[0] + (i + 1) factor[0] */
  PetscReal first[2], factor[2];
  /* derived operators */
  SamElasticity     coarse, symmetric;
  SamTransfer       transfer;
  SamElasticityPart parts[2]; /* the part in use, and the one before */
  PetscInt          newest;   /* index of the part in use, or used last */
  PetscBool         in_part;  /* true: that part is in use; false: none is */
};

/*
  SamElasticitySetInner - creates the object that a type adds to, and replaces an earlier one; type NULL: half-spaces.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamElasticitySetInner(SamElasticity elasticity, SamElasticityType type);
/*
  SamElasticityCreateLike - creates an elasticity of the same type, bodies and settings on another grid. `first`: the
  cell of the parent's grid where a part of it begins; NULL: the grid is a coarser one. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityCreateLike(SamElasticity parent, SamGrid grid, const PetscInt first[2],
                                                    SamElasticity *child);
/*
  SamElasticityWrap - creates, by its create function, an object of a type that adds to these bodies, which become its
  inner object. Users cannot select such a type. Collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityWrap(SamElasticity bodies, SamElasticityType type,
                                              SamElasticityCreateFunction create, SamElasticity *outer);
/*
  SamElasticityKeepStream - replaces the stream that a type keeps by a copy with the constants of the pair, or by NULL
  if it has no terms; the type frees it by PetscFree(). Not collective.
*/
PETSC_INTERN PetscErrorCode SamElasticityKeepStream(SamElasticity elasticity, const SamStream *stream,
                                                    SamStream **kept);
/* SamElasticityWith - replaces e by the object that has a method: itself, or an inner one. */
#define SamElasticityWith(e, method) \
  while (!(e)->ops.method && (e)->inner) (e) = (e)->inner
/* SamElasticityDestroyParts - frees both parts. Collective. */
PETSC_INTERN PetscErrorCode SamElasticityDestroyParts(SamElasticity elasticity);

PETSC_INTERN PetscErrorCode SamElasticityCreate_HalfSpace(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreate_Periodic(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreate_Plane(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreate_PlanePeriodic(SamElasticity elasticity);
/* SamElasticityIsRegistered - returns true if there is a type of this name. Not collective. */
PETSC_INTERN PetscBool SamElasticityIsRegistered(const char name[]);
/*
  SamElasticityRegisterAll - registers the types of the library that are not replaced, and what may be added to them
  (bodies/bodytypes.c). SamInitialize() calls it. Not collective, on all ranks.
*/
PETSC_INTERN PetscErrorCode SamElasticityRegisterAll(void);

/*
  SamElasticityAddition - something that options may add to bodies of any type, by SamElasticityWrap(): `fromoptions`
  replaces the bodies if its options are given; `fromparameters` does the same from recorded parameters, whose file
  `source` names in messages. Both are collective.
  SamElasticityRegisterAddition - adds one to the list, in whose order they wrap; it is not copied. Not collective, on
  all ranks.
*/
typedef struct {
  PetscErrorCode (*fromoptions)(SamElasticity *, const SamOptions *from);
  PetscErrorCode (*fromparameters)(SamElasticity *, const SamParameters *, const char source[]);
} SamElasticityAddition;
PETSC_INTERN PetscErrorCode              SamElasticityRegisterAddition(const SamElasticityAddition *addition);
PETSC_INTERN const SamElasticityAddition SamElasticityCompliances; /* compliances of finite bodies */
/*
  SamElasticityCreateRolling - creates the operator of the same bodies under a contact that rolls towards +x in a steady
  state: u_t is the slip by the tractions in 1 m of rolled distance, and creepages take the place of tangential rigid
  displacements. It references the bodies. Collective. Errors: PETSC_ERR_SUP for periodic bodies.
  SamElasticitySpinAhead - returns the distance ahead of a cell's centre at which its spin is evaluated, m; 0 for other
  bodies. Not collective.
*/
PETSC_INTERN PetscReal      SamElasticitySpinAhead(SamElasticity elasticity);
PETSC_INTERN PetscErrorCode SamElasticityCreateRolling(SamElasticity bodies, SamElasticity *rolling);

#endif
