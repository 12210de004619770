/* Viscoelastic bodies: their creep, and what they remember. */
#ifndef PETSAM_VISCOUS_H
#define PETSAM_VISCOUS_H

#include <petsam/private/elasticityimpl.h>

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
  SamViscous - the data of the type. A term is a time theta of one body or of both; its field of tractions c follows
  those of the contact: theta c' + c = p. In a step p is linear in time: c_new = kept c + before p_old + now p_new.
*/
#define SAM_VISCOUS_TERMS (2 * SAM_CREEP_TERMS)
typedef struct {
  PetscReal time;              /* theta, s */
  double    part[2];           /* of the bodies, a_j; 0: the body has no such term */
  PetscReal kept, before, now; /* of the present step */
} SamViscousTerm;
typedef struct SamViscous SamViscous;
struct SamViscous {
  PetscInt          relaxes[2]; /* numbers of parts of the bodies' moduli */
  PetscReal         moduli[2][SAM_CREEP_TERMS], times[2][SAM_CREEP_TERMS];
  PetscInt          terms;
  SamViscousTerm    term[SAM_VISCOUS_TERMS];
  PetscReal         duration; /* of the present step, s */
  PetscBool         alike;    /* all bodies that are not rigid have the same creep */
  SamElasticity     body[2];  /* unless alike, each body on a rigid one */
  const SamViscous *finest;   /* that of the finest grid, whose weights count on all others */
};

/*
  SamViscousFactor - returns the displacement of body 0 or 1 by tractions at the end of the present step, relative to
  that by a sudden load.
  SamViscousMemoryDeclare, SamViscousMemoryBegin, SamViscousMemoryDisplace, SamViscousMemoryAdvance - the type's methods
  of these names (viscousmemory.c).
  SamViscousApply - adds to u_z and u_t (components one after the other) `weight` times the displacements of a body
  under a sudden traction p, q; body -1: of both.
*/
PETSC_INTERN double         SamViscousFactor(const SamViscous *viscous, PetscInt body);
PETSC_INTERN PetscErrorCode SamViscousMemoryDeclare(SamElasticity e, SamState state);
PETSC_INTERN PetscErrorCode SamViscousMemoryBegin(SamElasticity e, SamState state, const SamControl *control,
                                                  PetscReal duration);
PETSC_INTERN PetscErrorCode SamViscousMemoryDisplace(SamElasticity e, SamConditions conditions, SamState state,
                                                     const SamControl *control, Vec u_z, Vec u_t, PetscBool *adds);
PETSC_INTERN PetscErrorCode SamViscousMemoryAdvance(SamElasticity e, SamState state, Vec pressure, Vec shear);
PETSC_INTERN PetscErrorCode SamViscousApply(SamElasticity e, PetscInt body, double weight, Vec p, Vec q, Vec u_z,
                                            Vec u_t);

extern PETSC_VISIBILITY_INTERNAL const SamElasticityAddition SamElasticityViscous;

#endif
