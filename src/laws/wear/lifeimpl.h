/* The inside of SamLife. */
#ifndef PETSAM_LIFEIMPL_H
#define PETSAM_LIFEIMPL_H

#include <petsam/private/life.h>
#include <petsam/private/pool.h>
#include <petsam/private/problemimpl.h>
#include "wearimpl.h"

/* A step of a computed cycle, as magnified cycles repeat it (magnified.c). */
typedef struct {
  SamBalance balance;
  PetscReal  slide[2]; /* m: body 2's point under a cell, minus that cell */
  double     most;     /* maximum wear load of the step per pressure, m */
  float     *wears;    /* wear load per pressure in each cell, relative to the maximum */
  float     *lift;     /* m, displacement of the surfaces by other causes than the pressure; NULL: none */
  float     *pressure; /* Pa, in the last magnified cycle; only for those at the start of a jump */
} SamPass;

/*
  The rate of wear by a computed cycle. `pressure` is the mean over the cycle's steps, and solves the normal
  problem of the mean loads on the gap h + shift. Magnified cycles use `coefficient`, `limit` and `passes` only.
*/
typedef struct {
  Vec        coefficient; /* wear load of a cycle per mean pressure, m; of a band per its integral along x, 1 */
  Vec        pressure;    /* mean over the cycle, Pa */
  Vec        shift;   /* m: lift by the shear of dissimilar bodies minus the gap that is open in a part of the cycle */
  SamBalance balance; /* mean over the cycle */
  PetscReal  limit;   /* cycles that wear as much as a single step may; infinite without wear */
  SamPass   *passes;  /* one for each step; NULL: jumps need only the means */
} SamRate;

/* What is summed up over the steps of a cycle; fields have one component, and are lent by the life's pool. */
typedef struct {
  SamControl control; /* means of its values; the rest is that of the last step */
  Vec        gap;     /* mean of the gaps, m; NULL in magnified cycles */
  Vec        lift;    /* mean of u_z, m; NULL unless surfaces are lifted, and in magnified cycles */
  Vec        passage; /* of a band: its wear load of the cycle, Pa m, the same along a line; else NULL */
  Vec        before;  /* in magnified cycles: the pressure before the next step, Pa; else NULL */
} SamMeans;

/* The wear loads of a contact: one for both bodies, or one for each. */
#define SAM_WEAR_LOADS 2
typedef Vec SamLoads[SAM_WEAR_LOADS];

/* Copies of fields of the state, by their handles; NULL: none */
typedef struct {
  Vec field[SAM_STATE_MOST];
} SamStrainKept;

struct _n_SamLife {
  SamContact      contact; /* borrowed */
  SamProblem      problem; /* of the contact, like the next three; borrowed */
  SamState        memory;
  SamGrid         grid;
  SamLaw          law;    /* the law of wear */
  SamState        series; /* numbers of computed cycles */
  SamLifeCycle    cycle;
  SamLifeSettings set;
  SamLifeState    state;
  PetscBool       lifts;  /* the surfaces are lifted by other causes than the pressure */
  PetscBool       band;   /* material streams through: lines along x wear alike, by passages */
  PetscBool       open;   /* the loop is not closed: a cycle is run before the computed one */
  PetscBool       known;  /* `start` has been computed */
  PetscBool      *turns;  /* of each step: true if a component reverses there, or the cycle ends */
  SamStep         step;   /* first step of the last cycle that is not converged, else its last step */
  PetscInt        at;     /* index of `step` in the cycle */
  PetscReal       apart;  /* difference of the pressures of a jump and of its halves, over all steps */
  PetscReal       stride; /* the longest slide of a step of the computed cycle, relative to the contact's length */
  PetscReal       tip;    /* excess of the maximum pressure after its last step over that along the step's slide */
  PetscReal       stripes_error;       /* error of body 2's depth so far by the length of the steps */
  Vec             stripes;             /* wear of body 2 in a cycle minus that by many steps; NULL: not created yet */
  PetscReal       energy, area;        /* of the last cycle, J; m2, in contact in `step` */
  SamRate         start, middle;       /* rates with the wear so far, and after half of the jump */
  PetscInt        loads;               /* number of wear loads of the contact */
  SamLoads        load;                /* wear loads so far; within a jump the law has others */
  SamLoads        whole, half, halves; /* after the jump as a whole, after its first half, after both */
  SamPool         pool;                /* fields that functions take for their own use */
  Vec             before[SAM_LAWS];    /* of each law that accumulates, its sum before this cycle; else NULL */
  SamStrainKept   strain;              /* the strain before the computed cycle, then before the jump */
  PetscReal       flow;                /* change of the strain in the computed cycle, relative to its maximum */
};

/*
  In a life, the sum that a law accumulates over the steps includes all cycles so far, and this cycle up to the step. A
  jump adds the sum of the cycle in its middle, times its number of cycles, which is of second order, like the wear.
  Cycles that close the loop or are only tried do not count.

  SamLifeComputeRate - solves the cycle on the problem's gap; `cycles`: number of cycles before it; `solved`: true if
  all of its steps have a solution; `tell`: true if the steps are reported to the caller. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeComputeRate(SamLife life, SamRate *rate, PetscReal cycles, PetscBool tell,
                                               PetscBool *solved);

/*
  SamLifeGetLoads - gets the law's wear loads, by which the separation grows; borrowed. SamLifeSetLoads - copies these
  to the law's wear loads. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeGetLoads(SamLife life, SamLoads loads);
PETSC_INTERN PetscErrorCode SamLifeSetLoads(SamLife life, const SamLoads loads);
/*
  SamLifeSolveNormal - solves for the pressure p (Pa) on a gap (m) of surfaces that `yield` under it (m/Pa); if `guess`
  is true, the values in p are the start. A failure is reported as that of a jump of `cycles`. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeSolveNormal(SamLife life, Vec gap, Vec yield, SamBalance balance, PetscReal cycles,
                                               PetscBool guess, Vec p, PetscBool *solved);

/*
  Magnified cycles (magnified.c).
  SamRateCreatePasses, SamRateDestroyPasses - create and destroy the memory for the steps of a cycle.
  SamLifeNotePass - keeps a tried step; `before`: the pressure before it, then that at its end, Pa.
  SamLifeMagnify - computes the wear loads `to` after `cycles` more, from `from` on. If `to` is l->whole, the pressures
  are stored; if it is l->halves, l->apart is the difference from these. All collective.
*/
PETSC_INTERN PetscErrorCode SamRateCreatePasses(SamLife life, SamRate *rate);
PETSC_INTERN PetscErrorCode SamRateDestroyPasses(SamLife life, SamRate *rate);
PETSC_INTERN PetscErrorCode SamLifeNotePass(SamLife life, PetscInt k, const SamStep *step, Vec before, SamRate *rate);
PETSC_INTERN PetscErrorCode SamLifeMagnify(SamLife life, const SamRate *rate, PetscReal cycles, const SamLoads from,
                                           SamLoads to, PetscBool *solved);
/*
  Steps that slide far (longslides.c).
  SamLifeBeginStrides - begins a cycle. SamLifeNoteStride - notes a tried step with this wear load (Pa m, or J/m2) and
  these pressures before and after it (Pa). SamLifeEndStrides - sets l->stripes_error. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeBeginStrides(SamLife life);
PETSC_INTERN PetscErrorCode SamLifeNoteStride(SamLife life, Vec load, Vec before, Vec after);
PETSC_INTERN PetscErrorCode SamLifeEndStrides(SamLife life);
/*
  Bodies that yield (strain.c).
  SamLifeHasStrain - returns true if the state has fields, besides the wear loads, on which the separation or the offset
  of later steps depends. SamLifeKeepStrain - copies these. SamLifeRestoreStrain - puts them back. SamLifeFindFlow -
  sets l->flow, their largest change since they were kept. SamLifeMostCycles - returns the longest jump with this
  change, cycles; infinite without one. SamLifeDropStrain - destroys copies. All but SamLifeHasStrain and
  SamLifeMostCycles are collective.
*/
PETSC_INTERN PetscBool      SamLifeHasStrain(SamLife life);
PETSC_INTERN PetscErrorCode SamLifeKeepStrain(SamLife life, SamStrainKept *kept);
PETSC_INTERN PetscErrorCode SamLifeRestoreStrain(SamLife life, SamStrainKept *kept);
PETSC_INTERN PetscErrorCode SamLifeFindFlow(SamLife life, const SamStrainKept *before);
PETSC_INTERN PetscReal      SamLifeMostCycles(SamLife life);
PETSC_INTERN PetscErrorCode SamLifeDropStrain(SamStrainKept *kept);
/*
  SamLifeGetSum - gets the committed values that law k accumulates; NULL: none. SamLifeBeginSums - continues these sums
  from those before the cycle; in the middle of a jump they start from 0. SamLifeRemembered - gets the committed values
  of a field that the law of wear stores. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeGetSum(SamLife life, PetscInt k, Vec *sum);
PETSC_INTERN PetscErrorCode SamLifeBeginSums(SamLife life, PetscBool middle);
PETSC_INTERN PetscErrorCode SamLifeRemembered(SamLife life, const char name[], Vec *field);

/* SamLifeIntegrate - replaces a field by its integral along x, the same in all cells of a line. Not collective. */
PETSC_INTERN PetscErrorCode SamLifeIntegrate(SamGrid grid, Vec field);

/* SamLifeDeclare - declares the numbers of computed cycles, and the number of each step's cycle (series.c).
   Collective. */
PETSC_INTERN PetscErrorCode SamLifeDeclare(SamLife life);

/* SamLifeFindTurns - fills l->turns, to be freed with PetscFree(). Collective. */
PETSC_INTERN PetscErrorCode SamLifeFindTurns(SamLife life);

#endif
