/* The inside of SamContact. */
#ifndef PETSAM_CONTACTIMPL_H
#define PETSAM_CONTACTIMPL_H

#include <petsam/private/contact.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/stepcache.h>
#include "step/step.h"

/* SamStepStart - the guess from which a step is solved. */
typedef struct {
  PetscBool     pressure, shear; /* the tried solution holds a guess of the pressure; of the shear */
  double        rigid[3];        /* guess of the tangential rigid displacements (m, m, rad) */
  double        along;           /* part of the step's change along that of the last step, in units of it; >= 0 */
  SamCachedStep kept;            /* the same step one cycle before; NULL: none */
} SamStepStart;

/* SamTried - the tried step besides its solution, which holds what is prescribed: all that is found before it is
   solved. */
typedef struct {
  const SamSolution *last;          /* the committed solution; NULL in the first step */
  const SamSolution *before;        /* the same, or NULL if its slip is not continued */
  PetscBool          same_gap;      /* it has the gap of the committed pressure */
  PetscBool          same_pressure; /* its pressure is the committed one and is not solved for again */
  SamStepOf          of;            /* inputs for which its pressure is solved */
  SamStepStart       start;
  PetscBool          known_pressure; /* found by the solution: the pressure is the committed or the kept one */
} SamTried;

struct _n_SamContact {
  SamClassId class_id;
  /* what the user set */
  char               prefix[SAM_PREFIX];
  SamContactSettings set;
  /* its parts */
  SamProblem          problem;
  SamElasticity       elasticity; /* of the problem; borrowed */
  SamGrid             grid;       /* of the problem; borrowed */
  SamConditions       conditions; /* of the problem; borrowed */
  SamElasticityTraits traits;
  SamMotion           motion; /* of the elasticity */
  SamNormal           normal;
  SamTangential       tangential;
  /* its state */
  SamState         state;
  PetscBool        has_tried;                   /* there is a tried solution */
  PetscBool        settles;                     /* slip is found to the tolerance of the shear */
  SamSolution      generation[SAM_GENERATIONS]; /* views of the state */
  SamTried         tried;
  SamStepCache     cache;                          /* steps of the previous cycle */
  PetscObjectState revision[SAM_GENERATIONS];      /* of the problem at the pressure; -1: another problem */
  PetscBool        attracts;                       /* the surfaces attract each other */
  PetscInt         tractions[3], displacements[2]; /* fields: pressure, bound, shear; u_z, u_t */
  PetscInt         tension, pull;                  /* field and number of surfaces that attract each other */
  PetscInt         aside;                          /* field `aside` of the last step that needed it */
  PetscInt         time, solution, apart, creeps, control, residuals, counts, status, window, slip,
    steps;                                    /* numbers, see generations.c */
  PetscInt         rolling;                   /* numbers that only motions with streaming material have */
  PetscInt         condition[SAM_CONDITIONS]; /* numbers, by the places of conditions */
  PetscObjectState declared;                  /* revision of the laws when they were declared; 0: not yet */
};

/* True if pressure and shear depend on each other. */
static inline PetscBool SamContactIsCoupled(SamContact c)
{
  return c->traits.coupled && c->set.coupling;
}

/* True if the tried step rolls: the committed solution has moved along. */
static inline PetscBool SamContactRolls(SamContact c)
{
  return c->generation[SAM_TRIED].rolled != 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* True if steps may start from the same steps one cycle before. The tension between surfaces may have another branch
   there. A kept step has the change of its displacement as the
   product of its change of shear, so that only tractions may cause displacements, besides a uniform strain. Laws that
   displace by fields (load cases, sliding surfaces, plastic strain) have a part in that change which does not follow
   from the shear. Of coupled bodies the product is not used. */
static inline PetscBool SamContactRecalls(SamContact c)
{
  return c->set.warm_start && c->motion->continues && !c->attracts && !SamContactRolls(c) &&
         !SamProblemFollowsSlip(c->problem) && (SamContactIsCoupled(c) || !SamProblemDisplaces(c->problem));
}

/* ---- what is prescribed (prescription.c) ---- */

/*
  SamContactPrescribe - rejects an inconsistent control; sets rotations that the elasticity does not have to 0, and
  conditions that depend on others. `kept`: the same step one cycle before. `rounded`: the control with the normal loads
  of that step, or the last ones, where they differ by rounding only. Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE,
  SAM_ERR_USER.
  SamContactFindRule - finds the rule of slip of a begun step, whose solution has its control and rolled path.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamContactPrescribe(SamContact contact, SamControl *control, SamControl *rounded,
                                                SamCachedStep *kept);
PETSC_INTERN PetscErrorCode SamContactFindRule(SamContact contact, SamSolution *solution);

/* ---- what is remembered (generations.c) ---- */

/*
  Numbers of the slip: the line on which the first loads lay (0: there were none); 1 if later loads have left it; 1 if
  the slip of the step was turned.
*/
enum { SAM_SLIP_LINE_X, SAM_SLIP_LINE_Y, SAM_SLIP_LEFT, SAM_SLIP_ASIDE, SAM_SLIP_NUMBERS };

/* SamContactDeclare - declares all numbers and fields that a contact stores and offers, once. Collective. */
PETSC_INTERN PetscErrorCode SamContactDeclare(SamContact contact);
/* SamContactBegin - begins a try: an empty tried solution, whose tractions may be written to. Collective. */
PETSC_INTERN PetscErrorCode SamContactBegin(SamContact contact, const SamControl *control);
/*
  SamContactStore - stores the numbers of the tried solution, and of a step, in the state. If the solution was computed
  with an approach that the step does not report, the approach is stored separately. Not collective.
*/
PETSC_INTERN PetscErrorCode SamContactStore(SamContact contact, const SamStep *step);
/* SamContactRefresh - makes the views of the committed generation, and of that one step back. Collective. */
PETSC_INTERN PetscErrorCode SamContactRefresh(SamContact contact);
/* SamContactPredict - makes the guess for the tried step, where the steps before allow one (predict.c). Collective. */
PETSC_INTERN PetscErrorCode SamContactPredict(SamContact contact);

#endif
