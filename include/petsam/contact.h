/* A contact through a sequence of load steps, each tried, then committed or rejected; and the check of a solution. */
#ifndef PETSAM_CONTACT_H
#define PETSAM_CONTACT_H

#include <petsam/control.h>
#include <petsam/normal.h>
#include <petsam/problem.h>
#include <petsam/tangential.h>

/* State of a cell. */
typedef enum { SAM_STATE_OPEN, SAM_STATE_STICK, SAM_STATE_SLIP } SamState;
/* A cell in contact slips where |q| >= (1 - this) of its bound mu p. */
#define SAM_SLIP_MARGIN 1e-5
static inline SamState SamStateOf(PetscReal p, PetscReal qx, PetscReal qy, PetscReal bound)
{
  if (p <= 0) return SAM_STATE_OPEN;
  return PetscSqrtReal(qx * qx + qy * qy) >= (1 - SAM_SLIP_MARGIN) * bound ? SAM_STATE_SLIP : SAM_STATE_STICK;
}

/*
  SamSolution - the solution of a load step. Fields have one component, or two: x, then y on each rank. The slip is
  s = u_t + stretch - rigid, the gap g = u_z + h - rigid (SamContactComputeSlip(), SamContactComputeGap()).
*/
typedef struct {
  SamControl control;               /* what was prescribed */
  PetscReal  load[SAM_COMPONENTS];  /* N, N m */
  PetscReal  rigid[SAM_COMPONENTS]; /* m, rad */
  Vec        pressure;              /* Pa */
  Vec        bound;                 /* Pa: mu p, the largest shear */
  Vec        shear;                 /* Pa, two components: acts on body 2 */
  Vec        displacement_z;        /* m: relative elastic displacement u_z */
  Vec        displacement_t;        /* m, two components: relative elastic displacement u_t */
} SamSolution;

/*
  What the check of a solution finds, from tractions and rigid displacements alone: elastic displacements are computed
  anew and no solver is trusted. All relative; zero for the exact solution of the discrete problem.
    normal       largest of |g| where p > 0, -g where p = 0, and -p u/p_max anywhere, over the largest displacement u
    tangential   |q - D(q - ds/c)| over the larger of |q| and |D(q - ds/c)|, in the 2-norm: D projects each cell's shear
                 on its disc |q| <= mu p, ds is the slip of the step, c a cell's self-influence. It holds stick, slip
                 direction and cone in one
    equilibrium  largest error of a given load over the sum of |traction| dA, moments also over the grid's half width
    cone         largest |q| - mu p over the largest mu p
    edge         largest pressure in the outermost cells over the largest pressure; 0 where the grid has no edge
*/
typedef struct {
  PetscReal normal, tangential, equilibrium, cone, edge;
} SamCheck;

/*
  SamCheckSolution - checks a solution. Reads its control, rigid displacements, pressure and shear; computes its elastic
  displacements (with normal-tangential coupling unless that is false; u_z is left as it is when `u_z_known`). `before`
  is the solution at the end of the step before, from which slip goes on; NULL: nothing has slipped. Collective.
*/
PETSC_EXTERN PetscErrorCode SamCheckSolution(SamProblem problem, PetscBool coupling, PetscBool u_z_known,
                                             const SamSolution *before, SamSolution *solution, SamCheck *check);

/* Outcome of a step, the worst that applies; as stored in the results. */
typedef enum {
  SAM_STATUS_CONVERGED      = 0,
  SAM_STATUS_NOT_CONVERGED  = 10, /* a solver, or the coupling, stopped without converging, or the check disagrees */
  SAM_STATUS_NO_EQUILIBRIUM = 11, /* gross slip under force control, or loads that no pressure balances */
  SAM_STATUS_EDGE_CONTACT   = 12  /* the contact reached the edge of the grid */
} SamStatus;

/* The numbers of one load step. */
typedef struct {
  SamControl control;                  /* as it was given */
  PetscReal  load[SAM_COMPONENTS];     /* N, N m: given or found */
  PetscReal  rigid[SAM_COMPONENTS];    /* m, rad: given or found */
  PetscReal  contact_area, stick_area; /* m2 */
  PetscReal  dissipated_energy;        /* J, frictional work of the step */
  SamCheck   check;
  PetscInt   normal_iterations, normal_applies, normal_preconditions;
  PetscInt   tangential_iterations, tangential_applies, tangential_preconditions;
  PetscInt   coupling_iterations;
  SamStatus  status;
  char       message[512]; /* why the status is not 0, or a warning */
} SamStep;

/* What the check may find at most for a step that counts as converged. */
typedef struct {
  PetscReal normal, tangential, equilibrium, cone;
  PetscBool edge; /* contact at the grid's edge is allowed */
} SamCheckLimits;

/*
  SamStepJudge - turns what the check of a step found into its status and message. A failure that the step has already
  stays. Not collective: all ranks have the same numbers.
*/
PETSC_EXTERN PetscErrorCode SamStepJudge(SamStep *step, const SamCheckLimits *limits);

/*
  SamContact - the contact of two bodies through a sequence of load steps. It has a problem, the state committed last,
  and a tried one:
    SamContactTry()     solves a step from the committed state; again and again if wanted, each try replaces the last
    SamContactCommit()  makes the tried step the state from which the next one goes on
    SamContactReject()  forgets the tried step; nothing of it is left, to the last bit
  The gap and the friction of the problem may change between steps: slip is remembered by place, and what depends on the
  gap is found anew.
*/
typedef struct _n_SamContact *SamContact;

/* SamContactCreate - references the problem. The committed state is that of bodies that have never touched. Collective. */
PETSC_EXTERN PetscErrorCode SamContactCreate(SamProblem problem, SamContact *contact);
PETSC_EXTERN PetscErrorCode SamContactDestroy(SamContact *contact);
/* SamContactSetOptionsPrefix - what stands before the names of its options, and of its solvers'. Not collective. */
PETSC_EXTERN PetscErrorCode SamContactSetOptionsPrefix(SamContact contact, const char prefix[]);
/*
  SamContactSetFromOptions - -coupling (full or none), -coupling_rtol, -coupling_max_it, -coupling_monitor, -warm_start,
  -allow_edge_contact, -contact_check (prints the check), and the options of both solvers. Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactSetFromOptions(SamContact contact);
/*
  SamContactSetCoupling - whether normal-tangential coupling of dissimilar materials counts (default: true), the relative
  change of p and q between passes at which these end (1e-6) and the most passes (100). PETSC_DEFAULT keeps a number.
*/
PETSC_EXTERN PetscErrorCode SamContactSetCoupling(SamContact contact, PetscBool full, PetscReal rtol, PetscInt max_it);
PETSC_EXTERN PetscErrorCode SamContactGetCoupling(SamContact contact, PetscBool *full);
/* SamContactSetWarmStart - whether a step starts from the ones before (default: true). */
PETSC_EXTERN PetscErrorCode SamContactSetWarmStart(SamContact contact, PetscBool warm);
/* SamContactAllowEdge - whether contact at the grid's edge is a warning only (default: false). */
PETSC_EXTERN PetscErrorCode SamContactAllowEdge(SamContact contact, PetscBool allow);
PETSC_EXTERN PetscErrorCode SamContactGetProblem(SamContact contact, SamProblem *problem);          /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetGrid(SamContact contact, SamGrid *grid);                   /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetNormal(SamContact contact, SamNormal *normal);             /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetTangential(SamContact contact, SamTangential *tangential); /* borrowed */

/*
  SamContactTry - solves one load step from the committed state, and fills in its numbers. A status other than 0 comes
  with a message. After NO_EQUILIBRIUM there is no tried state. Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a
  control that is not finite, a negative normal force or friction, or a moment or rotation where the elasticity has none.
*/
PETSC_EXTERN PetscErrorCode SamContactTry(SamContact contact, const SamControl *control, SamStep *step);
/* SamContactCommit - errors: PETSC_ERR_ORDER without a tried state. Collective. */
PETSC_EXTERN PetscErrorCode SamContactCommit(SamContact contact);
/* SamContactReject - does nothing without a tried state. Collective. */
PETSC_EXTERN PetscErrorCode SamContactReject(SamContact contact);
/* SamContactGetSolution - of the tried state if there is one, else of the committed one; borrowed until the next call. */
PETSC_EXTERN PetscErrorCode SamContactGetSolution(SamContact contact, const SamSolution **solution);
/*
  Fields that follow from a solution, written to the caller's vectors: the gap between the deformed surfaces (m, one
  component), the slip since the start (m, two components), the state of each cell (a SamState, one component).
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactComputeGap(SamContact contact, Vec gap);
PETSC_EXTERN PetscErrorCode SamContactComputeSlip(SamContact contact, Vec slip);
PETSC_EXTERN PetscErrorCode SamContactComputeState(SamContact contact, Vec state);

/*
  SamContactState - all that the committed steps have to say to those that come: a contact of the same problem that is
  given the state of another goes on as that one would, to the last bit and on any number of ranks.
*/
typedef struct {
  PetscInt    steps;                        /* committed so far */
  SamSolution now;                          /* after the last of them */
  SamSolution before;                       /* one step back, tractions only; vectors NULL before the second step */
  PetscInt    window_first[2], window_n[2]; /* part of the grid that the solvers worked on; n = 0: none */
  PetscBool   gap_is_current;               /* `now` was found with the gap that the problem has at present */
} SamContactState;

/* SamContactGetState - the committed state; the vectors are borrowed until the next commit. Collective. */
PETSC_EXTERN PetscErrorCode SamContactGetState(SamContact contact, SamContactState *state);
/* SamContactSetState - copies the vectors into the committed state; a tried one is forgotten. Collective. */
PETSC_EXTERN PetscErrorCode SamContactSetState(SamContact contact, const SamContactState *state);

#endif
