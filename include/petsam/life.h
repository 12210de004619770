/* The life of a joint: wear over many cycles of the same loads. */
#ifndef PETSAM_LIFE_H
#define PETSAM_LIFE_H

#include <petsam/wear.h>

/* A closed cycle: its steps, 0 ... steps - 1; the last one is where the next cycle begins. */
typedef struct {
  PetscInt steps;
  PetscErrorCode (*control)(void *context, PetscInt step, SamControl *control);
  void *context;
} SamLifeCycle;

/* SamLifeReport - a jump over cycles. Depths and volumes are those removed of body 1 and 2 so far. */
typedef struct {
  PetscReal cycles;            /* so far */
  PetscReal jump;              /* the last one, cycles */
  PetscReal error;             /* the largest difference between a jump and two halves of it, over the largest depth */
  PetscReal volume[2];         /* m3 */
  PetscReal depth[2];          /* m, the largest */
  PetscReal dissipated_energy; /* J, of a cycle */
  PetscReal contact_area;      /* m2 */
  PetscReal pressure;          /* Pa, the largest */
  PetscInt  computed;          /* cycles that have been computed so far */
  SamStep   step;              /* the last one that was solved; its status tells a failure */
} SamLifeReport;

/*
  SamLife - carries a contact over many cycles by computing some of them. A cycle is computed on a fixed gap; then its
  wear is repeated some times over, implicitly: the pressure that comes with the worn gap is solved for, as the normal
  problem of surfaces that yield (SamNormalSolveYielding()). So a jump has no limit of stability. A jump is made once as
  a whole and once in two halves, with a cycle computed between them; their difference is the error, and tells the size
  of the next jump; what is kept is their extrapolation, which is of second order.
*/
typedef struct _n_SamLife *SamLife;

/*
  SamLifeCreate - begins where the contact is: at the end of the cycle's last step. `rtol`: the error of a jump that is
  allowed, relative to the largest depth. `jump`: the first one, cycles. Borrows the wear, and the contact that this
  belongs to. Collective.
*/
PETSC_EXTERN PetscErrorCode SamLifeCreate(SamWear wear, const SamLifeCycle *cycle, PetscReal rtol, PetscReal jump,
                                          SamLife *life);
PETSC_EXTERN PetscErrorCode SamLifeDestroy(SamLife *life);
/*
  SamLifeAdvance - one jump, not beyond `cycles` in all. After a step that has no solution or did not converge the
  report says so in its step, and the wear is as it was before the jump. Collective.
*/
PETSC_EXTERN PetscErrorCode SamLifeAdvance(SamLife life, PetscReal cycles, SamLifeReport *report);

#endif
