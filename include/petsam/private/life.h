/* The life of a joint: wear over many cycles of the same loads. */
#ifndef PETSAM_LIFE_H
#define PETSAM_LIFE_H

#include <petsam/contact.h>

/*
  A closed cycle has the steps 0 ... steps - 1; the next cycle begins where the last of them ends.
    control  sets the prescribed values of a step after a number of cycles, on which only the friction may depend
    solved   is called after each step of a cycle that is computed on the wear so far (not on that within a jump), while
             the step is tried; NULL: not wanted
*/
typedef struct {
  PetscInt steps;
  PetscErrorCode (*control)(void *context, PetscInt step, PetscReal cycles, SamControl *control);
  PetscErrorCode (*solved)(void *context, PetscInt step, PetscReal cycles, const SamStep *result);
  void *context;
} SamLifeCycle;

/* How a life is computed. */
typedef struct {
  PetscBool magnified; /* jumps go through the steps of a cycle, each at its place, as surfaces that slide need */
  PetscReal rtol;      /* error of a jump that is allowed: of depth and pressure, relative, in the mean over the scar */
  PetscReal jump;      /* cycles of the first jump, 0: a part of those that wear as much as a single step may */
  PetscBool fixed;     /* all jumps are like the first one, whatever their error */
} SamLifeSettings;

/* SamLifeReport - a computed cycle, and the jump before it. */
typedef struct {
  PetscReal cycles;    /* so far */
  PetscReal jump;      /* the last one, cycles */
  PetscReal error;     /* of this: the difference between the jump and two halves of it, relative; or `stripes` */
  PetscReal stripes;   /* error of body 2's depth so far by steps that slide far, relative */
  PetscReal stride;    /* the longest slide of a step of the cycle, over the contact's length along it */
  PetscReal limit;     /* cycles that wear as much as a single step may, infinite without wear */
  PetscReal volume[2]; /* m3, removed of body 1 and 2 so far */
  PetscReal depth[2];  /* m, the largest, removed of body 1 and 2 so far */
  PetscReal dissipated_energy; /* J, of this cycle */
  PetscReal contact_area;      /* m2, at its end */
  PetscReal pressure;          /* Pa, the largest at its end */
  PetscInt  computed;          /* cycles that have been computed so far, within jumps too */
  PetscInt  at;                /* the step of the cycle that `step` is */
  SamStep   step;              /* the first one that is not converged; else the last one */
} SamLifeReport;

/*
  SamLife - carries a contact over many cycles by computing some of them. A cycle is computed on a fixed gap; then its
  wear is repeated some times over, by the pressure that comes with the worn gap: stable however long a jump is. This
  pressure is that of the normal problem of surfaces that yield (SamNormalSolveYielding()); where surfaces slide past
  each other, it is solved for in each step of a magnified cycle. A jump is made once as a whole and once in two halves,
  with a cycle computed between them; their difference is the error, and sets the size of the next jump; their
  extrapolation, which is of second order, is kept. Jumps that the error sets are whole numbers of cycles, fixed ones
  any number; one of a single cycle is taken whatever its error: faster wear is for steps that wear one by one, without
  a life.

  SamLifeCompute() and SamLifeJump() take turns.
*/
typedef struct _n_SamLife *SamLife;

/*
  SamLifeCreate - begins where the contact is: at the end of the cycle's last step, on loads and displacements of which
  a first cycle, which does not wear, makes a closed loop. Borrows the contact, whose steps do not wear until
  SamLifeEnd() or SamLifeDestroy(). Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a tolerance that is not positive,
  or a jump below 0; PETSC_ERR_ARG_INCOMP for a contact without a law of wear, with a law that cycle jumps do not
  support, or whose surfaces slide without magnified cycles.
*/
PETSC_INTERN PetscErrorCode SamLifeCreate(SamContact contact, const SamLifeCycle *cycle,
                                          const SamLifeSettings *settings, SamLife *life);
PETSC_INTERN PetscErrorCode SamLifeDestroy(SamLife *life);
/*
  SamLifeEnd - the contact's steps wear again, one by one; what the life has found can still be read. Not collective.
*/
PETSC_INTERN void SamLifeEnd(SamLife life);
/*
  SamLifeGetSeries - the numbers of computed cycles, as a state that results may offer as a series beside /history;
  borrowed. SamLifeRecord - sets its committed numbers. Not collective.
*/
PETSC_INTERN SamState       SamLifeGetSeries(SamLife life);
PETSC_INTERN PetscErrorCode SamLifeRecord(SamLife life, const SamLifeReport *report);
/*
  SamLifeCompute - a cycle on the wear so far. When a step of it has no solution or did not converge, the report's step
  has its status. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeCompute(SamLife life, SamLifeReport *report);
/*
  SamLifeJump - one jump, not beyond `cycles` in all. Where a cycle within it cannot be solved, it is tried again
  shorter; a jump of one cycle that cannot be made is a status of the report's step, and the wear stays.
  Collective. Errors: PETSC_ERR_ORDER without a computed cycle.
*/
PETSC_INTERN PetscErrorCode SamLifeJump(SamLife life, PetscReal cycles, SamLifeReport *report);

/*
  SamLifeState - all that the life after a jump depends on, besides the states of the contact and of the wear. A life
  that is given the state of another continues as that one would.
*/
typedef struct {
  PetscReal cycles, next; /* so far; the next jump */
  PetscReal jump, error;  /* of the last jump */
  PetscInt  computed;
  PetscBool by_turns; /* on a changed gap, the turning points of the loads close the loop; else all steps do */
} SamLifeState;
/* SamLifeGetState, SamLifeSetState - between SamLifeJump() and SamLifeCompute(). Not collective. */
PETSC_INTERN SamLifeState   SamLifeGetState(SamLife life);
PETSC_INTERN PetscErrorCode SamLifeSetState(SamLife life, const SamLifeState *state);

#endif
