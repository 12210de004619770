/* The inside of SamLife. */
#ifndef PETSAM_LIFEIMPL_H
#define PETSAM_LIFEIMPL_H

#include <petsam/life.h>
#include <petsam/private/problemimpl.h>
#include "wearimpl.h"

/*
  The rate of wear by a computed cycle. `pressure` is the mean over the cycle's steps, and solves the normal
  problem of the mean loads on the gap h + shift.
*/
typedef struct {
  Vec        coefficient; /* wear load of a cycle per mean pressure, m; of a band per its integral along x, 1 */
  Vec        pressure;    /* mean over the cycle, Pa */
  Vec        shift;       /* m: what the shear of dissimilar bodies lifts, less what opens in a part of the cycle */
  SamBalance balance;     /* mean over the cycle */
  PetscReal  limit;       /* the longest explicit jump that is stable, cycles; infinite without wear */
} SamRate;

struct _n_SamLife {
  SamContact      contact; /* borrowed */
  SamProblem      problem; /* of the contact, as the next three; borrowed */
  SamState        memory;
  SamGrid         grid;
  SamLaw          law;    /* of wear */
  SamState        series; /* numbers of computed cycles */
  SamLifeCycle    cycle;
  SamLifeSettings set;
  SamLifeState    state;
  PetscBool       coupled;
  PetscBool       band;                /* material streams through: lines along x wear alike, by passages */
  PetscBool       open;                /* the loop is not closed: a cycle is run before the one that is computed */
  PetscBool       known;               /* `start` has been computed */
  PetscBool      *turns;               /* of each step: whether a component turns there, or the cycle ends */
  SamStep         step;                /* the first one of the last cycle that is not converged, else its last one */
  PetscInt        at;                  /* the step of the cycle that this is */
  PetscReal       energy, area;        /* of the last cycle, J; m2, in contact in that step */
  SamRate         start, middle;       /* on the wear so far; after half of the jump */
  Vec             load;                /* wear load so far; the law has another one within a jump */
  Vec             whole, half, halves; /* wear loads: after the jump as a whole, after its first half, after both */
  Vec             p, q, diagonal, gap; /* scratch */
  Vec             passage;             /* the wear load of a band in the cycle, Pa m */
  Vec             shear;               /* scratch, two components */
  Vec             before[SAM_LAWS];    /* of each law that accumulates, its sum before this cycle; else NULL */
};

/*
  What a law accumulates over the steps is, in a life, that of all cycles so far and of this one up to the step. A jump
  adds that of the cycle in its middle, times its cycles, which is of second order as the wear is. Cycles that close the
  loop or are tried do not count.

  SamLifeComputeRate - solves the cycle on the problem's gap; `cycles`: so far; `solved`: all of its steps have a
  solution; `tell`: the steps are reported to the caller. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeComputeRate(SamLife life, SamRate *rate, PetscReal cycles, PetscBool tell,
                                               PetscBool *solved);

/* SamLifeSetLoad - the law's wear load, by which the separation grows, becomes a copy of this one. Collective. */
PETSC_INTERN PetscErrorCode SamLifeSetLoad(SamLife life, Vec load);
/* SamLifeGetSum - the committed values that law k accumulates, NULL: it does not. Collective. */
PETSC_INTERN PetscErrorCode SamLifeGetSum(SamLife life, PetscInt k, Vec *sum);

/* SamLifeIntegrate - a field becomes its integral along x, the same in all cells of a line. Not collective. */
PETSC_INTERN PetscErrorCode SamLifeIntegrate(SamGrid grid, Vec field);

/* SamLifeDeclare - the numbers of computed cycles, and that of each step's cycle (series.c). Collective. */
PETSC_INTERN PetscErrorCode SamLifeDeclare(SamLife life);

/* SamLifeFindTurns - fills l->turns, to be freed with PetscFree(). Collective. */
PETSC_INTERN PetscErrorCode SamLifeFindTurns(SamLife life);

#endif
