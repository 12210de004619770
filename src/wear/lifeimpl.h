/* The inside of SamLife. */
#ifndef PETSAM_LIFEIMPL_H
#define PETSAM_LIFEIMPL_H

#include <petsam/life.h>
#include <petsam/normal.h>
#include "wearimpl.h"

/*
  What a computed cycle says of the next ones. `pressure` is the mean over the cycle's steps, and solves the normal
  problem of the mean loads on the gap h + shift.
*/
typedef struct {
  Vec        coefficient; /* wear load of a cycle per mean pressure, m */
  Vec        pressure;    /* mean over the cycle, Pa */
  Vec        shift;       /* m: what the shear of dissimilar bodies lifts, less what opens in a part of the cycle */
  SamBalance balance;     /* mean over the cycle */
  PetscReal  limit;       /* the longest explicit jump that is stable, cycles; infinite without wear */
} SamRate;

struct _n_SamLife {
  SamWear         wear;
  SamLifeCycle    cycle;
  SamLifeSettings set;
  SamLifeState    state;
  PetscBool       coupled;
  PetscBool       open;                /* the loop is not closed: a cycle is run before the one that is computed */
  PetscBool       known;               /* `start` has been computed */
  PetscBool      *turns;               /* of each step: whether a component turns there, or the cycle ends */
  SamStep         step;                /* the first one of the last cycle that is not converged, else its last one */
  PetscInt        at;                  /* the step of the cycle that this is */
  PetscReal       energy;              /* of the last cycle, J */
  SamRate         start, middle;       /* on the wear so far; after half of the jump */
  Vec             whole, half, halves; /* wear loads: after the jump as a whole, after its first half, after both */
  Vec             p, q, diagonal, gap; /* scratch */
  Vec             shear;               /* scratch, two components */
  Vec             before[SAM_CONTACT_SUMS]; /* the contact's sums before this cycle; NULL: not kept */
};

/*
  What a contact sums over its steps (SamContactKeepSum()) is, in a life, that of all cycles so far and of this one up
  to the step. A jump adds that of the cycle in its middle, times its cycles, which is of second order as the wear is.
  Cycles that close the loop or are tried do not count.

  SamLifeComputeRate - solves the cycle on the problem's gap; `cycles`: so far; `solved`: all of its steps have a
  solution; `tell`: the steps are told to the caller. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeComputeRate(SamLife life, SamRate *rate, PetscReal cycles, PetscBool tell,
                                               PetscBool *solved);

/* SamLifeFindTurns - fills l->turns, to be freed with PetscFree(). Collective. */
PETSC_INTERN PetscErrorCode SamLifeFindTurns(SamLife life);

#endif
