/* The inside of SamContact. */
#ifndef PETSAM_CONTACTIMPL_H
#define PETSAM_CONTACTIMPL_H

#include <petsam/private/balanceimpl.h>
#include <petsam/contact.h>

/* A solution and what else belongs to the state it makes. */
typedef struct {
  SamSolution      solution;
  PetscObjectState gap_revision;                 /* of the gap that the pressure was found with */
  PetscInt         window_first[2], window_n[2]; /* part of the grid that the solvers worked on last; n = 0: none */
} SamContactMark;

struct _n_SamContact {
  /* what the user set */
  char      prefix[64];
  PetscBool coupling, warm, allow_edge;
  PetscReal coupling_rtol;
  PetscInt  coupling_max_it;
  PetscBool coupling_monitor, print_check;
  /* what it is made of */
  SamProblem          problem;
  SamElasticity       elasticity; /* the problem's; borrowed */
  SamGrid             grid;       /* likewise */
  SamElasticityTraits traits;
  SamNormal           normal;
  SamTangential       tangential;
  /* its states */
  PetscInt       steps;     /* committed so far */
  SamContactMark committed; /* after the last of them */
  SamSolution    before;    /* one step back: tractions only */
  SamContactMark tried;
  PetscBool      has_tried;
};

/* ---- states (state.c) ---- */

/* SamSolutionCreate, SamSolutionDestroy - the fields of a solution, zero, without displacements. Collective. */
PETSC_INTERN PetscErrorCode SamSolutionCreate(SamGrid grid, SamSolution *solution);
/*
  SamSolutionCreateDisplacements - its displacements, zero, unless it has them. They are made when they are first needed:
  in the first step that is after the solvers, whose memory they take. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionCreateDisplacements(SamGrid grid, SamSolution *solution);
PETSC_INTERN PetscErrorCode SamSolutionDestroy(SamSolution *solution);
/* SamVecCopyNonzero - copies a field; what is zero in both stays unwritten, and takes no memory. Collective. */
PETSC_INTERN PetscErrorCode SamVecCopyNonzero(Vec from, Vec to);

/* The three components of one kind, as the solvers take them. */
PETSC_INTERN SamBalance SamControlGetBalance(const SamControl *control, SamBalanceKind kind);
/* Puts a balance's loads and rigid displacements to their places among the six. */
PETSC_INTERN void SamBalanceStore(const SamBalance *balance, PetscReal load[], PetscReal rigid[]);
/* Whether the components of one kind are prescribed the same. */
PETSC_INTERN PetscBool SamControlIsSame(const SamControl *a, const SamControl *b, SamBalanceKind kind);

/*
  SamMotion - what is taken off a solution's elastic displacements to make its gap and its slip: rigid displacements,
  less the stretch. In a row of cells each is a + b xi.
*/
typedef struct {
  SamFrame  normal, tangential; /* with all displacements given */
  PetscReal stretch[3];
} SamMotion;
typedef struct {
  double a, b;
} SamMotionRow;
PETSC_INTERN PetscErrorCode SamMotionSet(SamMotion *motion, SamGrid grid, const SamSolution *solution);
PETSC_INTERN SamMotionRow   SamMotionOfGap(const SamMotion *motion, PetscInt j);
PETSC_INTERN SamMotionRow   SamMotionOfSlip(const SamMotion *motion, PetscInt component, PetscInt j);
/* value = u - a - b xi of a row of the grid. */
PETSC_INTERN void SamMotionSubtract(const SamMotion *motion, SamMotionRow row, const double u[], double value[]);
/* value = u + h - a - b xi. */
PETSC_INTERN void SamMotionGap(const SamMotion *motion, SamMotionRow row, const double u[], const double h[],
                               double value[]);
/* SamSolutionComputeSlip - a component of the slip (m) of this rank's cells. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeSlip(SamGrid grid, const SamSolution *solution, PetscInt component,
                                                   double slip[]);

/*
  SamIncrement - the slip of a step, row by row: that of a solution less that of the one before (NULL: none). Compute puts
  row j of both components, m, to row[0] and row[1]. Creation and destruction are collective.
*/
typedef struct {
  SamGrid       grid;
  SamMotion     now, before;
  Vec           v_now, v_before;
  const double *u_now, *u_before; /* elastic displacements; u_before NULL: nothing has slipped */
  double       *row[2], *scratch;
} SamIncrement;
PETSC_INTERN PetscErrorCode SamIncrementCreate(SamGrid grid, const SamSolution *before, const SamSolution *now,
                                               SamIncrement *increment);
PETSC_INTERN PetscErrorCode SamIncrementDestroy(SamIncrement *increment);
PETSC_INTERN void           SamIncrementComputeRow(const SamIncrement *increment, PetscInt j);

/* ---- a step ---- */

/* Whether pressure and shear depend on each other. */
static inline PetscBool SamContactIsCoupled(SamContact c)
{
  return (c->traits.coupled && c->coupling) ? PETSC_TRUE : PETSC_FALSE;
}

/* How the tried step starts. */
typedef struct {
  PetscBool pressure, shear; /* the tried solution holds a start of the pressure; of the shear */
  double    rigid[3];        /* start of the tangential rigid displacements */
} SamStepStart;

/* SamContactPredict - the start of a step, and whether there is one (predict.c). Collective. */
PETSC_INTERN PetscErrorCode SamContactPredict(SamContact contact, const SamControl *control, SamStepStart *start);
/* SamFollowPressure - scales a shear that belonged to one pressure to another: what slips goes on slipping. */
PETSC_INTERN PetscErrorCode SamFollowPressure(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear);

/*
  SamContactSolveStep - solves the tried step's problems, in turn when they are coupled, from its start; what fails is in
  the step's status (step.c). `same_pressure`: the pressure is that of the committed state. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactSolveStep(SamContact contact, const SamStepStart *start, PetscBool same_pressure,
                                                SamStep *step);
/* SamStepFail - the first failure stays: what comes after it follows from it. */
PETSC_INTERN PetscErrorCode SamStepFail(SamStep *step, SamStatus status, const char message[]);

#endif
