/* The inside of SamContact. */
#ifndef PETSAM_CONTACTIMPL_H
#define PETSAM_CONTACTIMPL_H

#include <petsam/contact.h>
#include <petsam/private/solutionimpl.h>
#include "recall.h"

/* The numbers of the solvers, side by side in the state in this order. */
enum {
  SAM_COUNT_NORMAL,         /* iterations, applications, preconditions of the normal solver, */
  SAM_COUNT_TANGENTIAL = 3, /* and of the tangential one */
  SAM_COUNT_COUPLING   = 6,
  SAM_COUNTS           = 7
};

struct _n_SamContact {
  /* what the user set */
  char               prefix[SAM_PREFIX];
  SamContactSettings set;
  /* its parts */
  SamProblem          problem;
  SamElasticity       elasticity; /* of the problem; borrowed */
  SamGrid             grid;       /* of the problem; borrowed */
  SamElasticityTraits traits;
  SamNormal           normal;
  SamTangential       tangential;
  /* its state */
  SamState         state;
  PetscBool        has_tried;                   /* a tried solution */
  PetscBool        rolls;                       /* the tried step does, and the committed solution has moved for it */
  SamSolution      generation[SAM_GENERATIONS]; /* views of the state */
  SamRecall        recall;                      /* steps of the cycle before */
  PetscObjectState revision[SAM_GENERATIONS];   /* of the problem that the pressure was solved with; -1: another */
  PetscInt         tractions[3], displacements[2]; /* fields: pressure, bound, shear; u_z, u_t */
  PetscInt time, solution, given, creeps, control, residuals, counts, status, window, steps; /* numbers, see memory.c */
  PetscInt rolling; /* numbers, of steady rolling only, see rolling.c */
};

/* Whether pressure and shear depend on each other. */
static inline PetscBool SamContactIsCoupled(SamContact c)
{
  return c->traits.coupled && c->set.coupling;
}

/* ---- what is remembered (memory.c) ---- */

/* SamContactDeclare - declares all that a contact remembers and offers. Collective. */
PETSC_INTERN PetscErrorCode SamContactDeclare(SamContact contact);
/* SamContactBegin - begins a try: an empty tried solution, whose tractions may be written to. Collective. */
PETSC_INTERN PetscErrorCode SamContactBegin(SamContact contact, const SamControl *control);
/*
  SamContactSetDisplacements - gives the tried solution its displacements. Called as late as possible: in the first step
  they then use the memory that the solvers have freed. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactSetDisplacements(SamContact contact);
/* SamContactStore - stores the numbers of the tried solution, and of a step, in the state. Not collective. */
PETSC_INTERN PetscErrorCode SamContactStore(SamContact contact, const SamStep *step);
/* SamContactView - makes the views of the committed generation, and of that one step back. Collective. */
PETSC_INTERN PetscErrorCode SamContactView(SamContact contact);
/* Refuses an option (prefix "-") or a law that steady rolling gives no meaning, if it rolls so. Not collective. */
PETSC_INTERN PetscErrorCode SamContactRefuseSteady(SamContact contact, const char prefix[], const char name[]);
/*
  SamContactBefore - the committed solution, from which the tried one continues; NULL in the first step. Not collective.
*/
PETSC_INTERN const SamSolution *SamContactBefore(SamContact contact);
/* SamContactSlipBefore - the same if its slip is that from which this step slips on; not so in steady rolling. */
static inline const SamSolution *SamContactSlipBefore(SamContact contact)
{
  return contact->traits.steady ? NULL : SamContactBefore(contact);
}
/* SamContactDeclareRolling - declares the numbers of steady rolling, if the contact does (rolling.c). Collective. */
PETSC_INTERN PetscErrorCode SamContactDeclareRolling(SamContact contact);

/* ---- a step ---- */

/* The guess from which a step is solved. */
typedef struct {
  PetscBool pressure, shear; /* whether the tried solution holds a guess of the pressure; of the shear */
  double    rigid[3];        /* guess of the tangential rigid displacements (m, m, rad) */
  SamKept   kept;            /* the same step one cycle before; NULL: none */
} SamStepStart;

/* SamContactPredict - makes the guess for a step, where the steps before allow one (predict.c). Collective. */
PETSC_INTERN PetscErrorCode SamContactPredict(SamContact contact, const SamControl *control, SamStepStart *start);
/*
  SamFollowPressure - scales a shear by the change of the pressure from `pressure_before`, cell by cell: cells that slip
  continue to slip.
*/
PETSC_INTERN PetscErrorCode SamFollowPressure(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear);
/*
  SamContactSolveStep - solves the normal and the tangential problem of the tried step, in turn when they are coupled.
  Failures are reported in the step's status (step.c). `same_pressure`: the pressure is that of the committed state and
  not solved again. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactSolveStep(SamContact contact, const SamStepStart *start, PetscBool same_pressure,
                                                SamStep *step);

#endif
