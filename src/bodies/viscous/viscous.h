/* Viscoelastic bodies: their creep, and what they remember. */
#ifndef PETSAM_VISCOUS_H
#define PETSAM_VISCOUS_H

#include <petsam/private/body.h>
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/halfspace.h>

/*
  SamCreep - the creep of a material relative to its displacement under a sudden load, J(t)/J(0) = 1 + sum a_j (1 -
  exp(-t/theta_j)).
*/
#define SAM_CREEP_TERMS 10
typedef struct {
  PetscInt count;
  double   part[SAM_CREEP_TERMS], time[SAM_CREEP_TERMS]; /* a_j; theta_j, s */
} SamCreep;
/*
  SamCreepFromRelaxation - computes the creep of a material whose modulus relaxes as G(t)/G(0) = 1 - sum g_k (1 -
  exp(-t/tau_k)): parts g_k > 0, whose sum is below 1, and times tau_k > 0 (s) in any order (prony.c). Not collective.
*/
PETSC_INTERN void SamCreepFromRelaxation(PetscInt count, const PetscReal parts[], const PetscReal times[],
                                         SamCreep *creep);

/*
  SamViscous - the data of the type. A term is a time theta of a creep function, of one body or of both; its field of
  tractions c follows those of the contact: theta c' + c = p. In a step p is linear in time: c_new = kept c + before
  p_old + now p_new. It displaces by c what bodies of its constants would.
*/
#define SAM_VISCOUS_TERMS (4 * SAM_CREEP_TERMS) /* two creep functions of each body */
typedef struct {
  PetscReal time;                   /* theta, s */
  PetscReal speed;                  /* of the body's material along x, if it streams, m/s */
  double value[SAM_PAIR_CONSTANTS]; /* what it adds to the constants of the pair (body.h) if it has crept to its end */
  SamStreamStep step;               /* weights of the present step */
} SamViscousTerm;
typedef struct SamViscous SamViscous;
struct SamViscous {
  PetscInt          relaxes[2]; /* numbers of parts of the bodies' moduli */
  PetscReal         moduli[2][SAM_CREEP_TERMS], times[2][SAM_CREEP_TERMS];
  int               bulk[2]; /* 1: the bulk modulus is constant, 0: Poisson's ratio */
  PetscInt          terms;
  SamViscousTerm    term[SAM_VISCOUS_TERMS];
  PetscReal         duration; /* of the present step, s */
  PetscReal         speed[2]; /* of the bodies' material along x, in steady states, m/s */
  PetscBool         streams;  /* the products are those of a steady state of rolling or sliding */
  PetscBool         mixes;    /* A and B of the terms are not all proportional to those of the pair */
  PetscBool         pushes;   /* the terms couple bodies that are not coupled under a sudden load */
  SamElasticity     other;    /* if so: bodies of other constants */
  const SamViscous *finest;   /* that of the finest grid, whose weights count on all others */
};

/*
  SamViscousSetTerms - finds the terms of bodies whose moduli are set, and what they need (viscousterms.c).
  SamViscousHasBulk - true if the bulk modulus of body 0 or 1 is constant, and not infinite.
  SamViscousGetConstants - gets the constants of the pair at the end of the present step, on any grid.
  SamViscousFindFactors - finds the factors of the products in what bodies of these constants displace; 0: none.
  SamViscousProduct - applies a product, without a factor. Collective.

  The products are those of the bodies under a sudden load, and `other` ones of the other bodies.
*/
typedef enum {
  SAM_VISCOUS_NORMAL,      /* pressure to u_z */
  SAM_VISCOUS_SHEAR,       /* shear to u_t */
  SAM_VISCOUS_OTHER_SHEAR, /* likewise, of the other bodies */
  SAM_VISCOUS_PUSH,        /* pressure to u_t */
  SAM_VISCOUS_LIFT,        /* shear to u_z: the transposed one */
  SAM_VISCOUS_PRODUCTS
} SamViscousProductKind;
PETSC_INTERN PetscErrorCode SamViscousSetTerms(SamElasticity e);
PETSC_INTERN PetscBool      SamViscousHasBulk(SamElasticity e, PetscInt body);
PETSC_INTERN void           SamViscousGetConstants(SamElasticity e, double value[SAM_PAIR_CONSTANTS]);
PETSC_INTERN void           SamViscousFindFactors(SamElasticity e, const double value[SAM_PAIR_CONSTANTS],
                                                  double factor[SAM_VISCOUS_PRODUCTS]);
PETSC_INTERN PetscErrorCode SamViscousProduct(SamElasticity e, SamViscousProductKind kind, Vec in, Vec out);

/*
  SamViscousMemoryDeclare, SamViscousMemoryBegin, SamViscousMemoryDisplace, SamViscousMemoryAdvance - the type's methods
  of these names (viscousmemory.c). SamViscousExamine, SamViscousDoubt - likewise (viscousdoubt.c), by the numbers
  SAM_VISCOUS_ENERGY and SAM_VISCOUS_ERROR of a step, the dissipated energy and its error, J.
*/
PETSC_INTERN PetscErrorCode SamViscousMemoryDeclare(SamElasticity e, SamState state);
PETSC_INTERN PetscErrorCode SamViscousMemoryBegin(SamElasticity e, SamState state, const SamControl *control,
                                                  PetscReal duration);
PETSC_INTERN PetscErrorCode SamViscousMemoryDisplace(SamElasticity e, SamConditions conditions, SamState state,
                                                     const SamControl *control, Vec u_z, Vec u_t, PetscBool *adds);
/* SamViscousFieldName - returns the name of the field of what term j has of the pressure (way 0) or the shear (1). */
PETSC_INTERN const char *SamViscousFieldName(PetscInt way, PetscInt j);
#define SAM_VISCOUS_ENERGY "viscous_energy"
#define SAM_VISCOUS_ERROR  "viscous_energy_error"
PETSC_INTERN PetscErrorCode SamViscousExamine(SamElasticity e, SamExamination *examination);
PETSC_INTERN PetscErrorCode SamViscousDoubt(SamElasticity e, SamExamination *examination);
PETSC_INTERN PetscErrorCode SamViscousMemoryAdvance(SamElasticity e, SamState state, Vec pressure, Vec shear);

/*
  SamViscousStream, SamViscousCreateSymmetric - likewise (viscousstream.c).
  SamViscousReadSpeeds - reads the speeds of bodies that slide; SamViscousSlide - makes the products those of a steady
  state at these speeds. `named`: the option that gives one; NULL: there is none.
*/
PETSC_INTERN PetscErrorCode SamViscousStream(SamElasticity e, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamViscousReadSpeeds(const SamOptions *from, PetscReal speed[2], const char **named);
PETSC_INTERN PetscErrorCode SamViscousSlide(SamElasticity e, const char named[]);
PETSC_INTERN PetscErrorCode SamViscousCreateSymmetric(SamElasticity e, SamElasticity *symmetric);

extern PETSC_VISIBILITY_INTERNAL const SamElasticityAddition SamElasticityViscous;

#endif
