/* The life of a joint: wear over many cycles of the same loads. */
#ifndef PETSAM_LIFE_H
#define PETSAM_LIFE_H

#include <petsam/contact.h>

/* Where a step of a life is: in a cycle that closes the loop, or in a computed one, at the start of a jump or in its
   middle */
typedef enum { SAM_LIFE_CLOSING, SAM_LIFE_START, SAM_LIFE_MIDDLE } SamLifePlace;

/* A part of a jump: the whole of it, its first or its second half, as one of them has been made; fields are borrowed */
typedef enum { SAM_LIFE_WHOLE, SAM_LIFE_FIRST_HALF, SAM_LIFE_SECOND_HALF } SamLifePartKind;
typedef struct {
  SamLifePartKind   kind;
  PetscReal         cycles;
  const SamBalance *balance;  /* mean of the cycle whose wear is repeated */
  Vec               slip;     /* its wear load per mean pressure, m */
  Vec               mean;     /* its mean pressure, Pa */
  Vec               pressure; /* mean pressure at the end of the part, Pa */
  Vec               from, to; /* wear loads before and after the part */
} SamLifePart;

/*
  A closed cycle has the steps 0 ... steps - 1; the next cycle begins where the last of them ends.
    control  sets the prescribed values of a step after a number of cycles; only the friction may depend on that number
    solved   is called after each step of a cycle that is computed on the wear so far (not on that within a jump), while
             the step is tried; NULL: not wanted
    commits  is called before any step is committed; NULL: not wanted
    jumps    is called after each part of a jump, if it has a solution; NULL: not wanted
*/
typedef struct {
  PetscInt steps;
  PetscErrorCode (*control)(void *context, PetscInt step, PetscReal cycles, SamControl *control);
  PetscErrorCode (*solved)(void *context, PetscInt step, PetscReal cycles, const SamStep *result);
  PetscErrorCode (*commits)(void *context, PetscInt step, SamLifePlace place);
  PetscErrorCode (*jumps)(void *context, const SamLifePart *part);
  void *context;
} SamLifeCycle;

/* Settings of the computation of a life */
typedef struct {
  PetscBool magnified; /* jumps go through the steps of a cycle, each at its own place, as sliding surfaces require */
  PetscReal rtol;      /* allowed relative error of a jump, of depth and pressure, averaged over the scar */
  PetscReal jump;      /* cycles of the first jump; 0: a part of the cycles that wear as much as a single step may */
  PetscBool fixed;     /* all jumps are as long as the first one, for any error */
} SamLifeSettings;

/* SamLifeReport - a computed cycle, and the jump before it. */
typedef struct {
  PetscReal cycles;    /* number of cycles so far */
  PetscReal jump;      /* length of the last jump, cycles */
  PetscReal error;     /* relative error of that jump, by its difference from two half jumps; or `stripes` */
  PetscReal stripes;   /* relative error of body 2's depth so far by steps with long slides */
  PetscReal stride;    /* longest slide of a step of the cycle, relative to the contact's length along it */
  PetscReal tip;       /* excess of `pressure` over its mean along the slide of the last step; 0: not resolved */
  PetscReal flow;      /* change of plastic strain in the cycle, relative to its maximum */
  PetscReal limit;     /* cycles that wear as much as a single step may, infinite without wear */
  PetscReal volume[2]; /* m3, volumes removed from body 1 and 2 so far */
  PetscReal depth[2];  /* m, maximum depths removed from body 1 and 2 so far */
  PetscReal dissipated_energy; /* J, energy of this cycle */
  PetscReal contact_area;      /* m2, area at the end of the cycle */
  PetscReal pressure;          /* Pa, maximum pressure at the end of the cycle */
  PetscInt  computed;          /* number of cycles computed so far, including those within jumps */
  PetscInt  at;                /* index of `step` in the cycle */
  SamStep   step;              /* first step that is not converged, else the last step */
} SamLifeReport;

/*
  SamLife - carries a contact over many cycles by computing some of them. A cycle is computed on a fixed gap; then its
  wear is repeated several times, with the pressure on the worn gap, which is stable for jumps of any length. This
  pressure solves the normal problem of surfaces that yield (SamNormalSolveYielding()); if surfaces slide past each
  other, it is solved in each step of a magnified cycle. A jump is made once as a whole and once in two halves, with a
  cycle computed between them; their difference is the error, and sets the size of the next jump; their extrapolation,
  which is of second order, is kept. Jumps set by the error are whole numbers of cycles, fixed jumps may have any
  length. A jump of a single cycle is accepted with any error: for faster wear each step should wear, without a life.

  SamLifeCompute() and SamLifeJump() take turns.
*/
typedef struct _n_SamLife *SamLife;

/*
  SamLifeCreate - creates a life that begins at the present state of the contact, the end of the cycle's last step; a
  first cycle, which does not wear, closes the loop of loads and displacements. The contact is borrowed; its steps do
  not wear until SamLifeEnd() or SamLifeDestroy(). Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a tolerance that is
  not positive, or a jump below 0; PETSC_ERR_ARG_INCOMP for a contact without a law of wear, with a law that cycle jumps
  do not support, or whose surfaces slide without magnified cycles.
*/
PETSC_INTERN PetscErrorCode SamLifeCreate(SamContact contact, const SamLifeCycle *cycle,
                                          const SamLifeSettings *settings, SamLife *life);
PETSC_INTERN PetscErrorCode SamLifeDestroy(SamLife *life);
/* SamLifeDescribeWorn - writes that the first material of a body (0, 1) is worn through; empty: it is not. Not
   collective. */
PETSC_INTERN PetscErrorCode SamLifeDescribeWorn(SamLife life, const SamLifeReport *report, int body, char text[],
                                                size_t size);
/*
  SamLifeEnd - makes each step of the contact wear again; the results of the life can still be read. Not collective.
*/
PETSC_INTERN void SamLifeEnd(SamLife life);
/*
  SamLifeGetSeries - returns the numbers of computed cycles, as a state for a second series of results beside /history;
  borrowed. SamLifeRecord - sets its committed numbers. Not collective.
*/
PETSC_INTERN SamState       SamLifeGetSeries(SamLife life);
PETSC_INTERN PetscErrorCode SamLifeRecord(SamLife life, const SamLifeReport *report);
/*
  SamLifeCompute - computes a cycle with the wear so far. If a step of it has no solution or did not converge, the
  report's step has its status. Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeCompute(SamLife life, SamLifeReport *report);
/*
  SamLifeJump - makes one jump, up to at most `cycles` cycles in total. If a cycle within it cannot be solved, a shorter
  jump is tried; if even a jump of one cycle fails, the report's step gets a status, and the wear stays.
  Collective. Errors: PETSC_ERR_ORDER without a computed cycle.
*/
PETSC_INTERN PetscErrorCode SamLifeJump(SamLife life, PetscReal cycles, SamLifeReport *report);

/*
  SamLifeExtrapolate - replaces wear loads after the halves of a jump by their extrapolation with those after the jump
  as a whole, which are nowhere less than at its start (cyclejump.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamLifeExtrapolate(SamGrid grid, Vec start, Vec whole, Vec halves);

/*
  SamLifeState - the data on which the life after a jump depends, besides the states of the contact and of the wear. A
  life with the state of another life continues as that life would.
*/
typedef struct {
  PetscReal cycles, next; /* number so far; length of the next jump */
  PetscReal jump, error;  /* of the last jump */
  PetscInt  computed;
  PetscBool by_turns; /* on a changed gap, the load reversals close the loop; else all steps do */
} SamLifeState;
/* SamLifeGetState, SamLifeSetState - get and set the state, between SamLifeJump() and SamLifeCompute(). Not
   collective. */
PETSC_INTERN SamLifeState   SamLifeGetState(SamLife life);
PETSC_INTERN PetscErrorCode SamLifeSetState(SamLife life, const SamLifeState *state);

#endif
