/* One load step of a contact: normal and tangential problem, their coupling, and the check of the solution. */
#ifndef PETSAM_CONTACT_H
#define PETSAM_CONTACT_H

#include <petsam/normal.h>
#include <petsam/tangential.h>

/* Fields on the grid; two-component ones hold x, then y on each rank. */
typedef struct {
  Vec pressure;       /* Pa */
  Vec shear;          /* Pa, two components */
  Vec slip;           /* m, two components: relative tangential displacement since the start */
  Vec gap;            /* m */
  Vec displacement_z; /* m, relative elastic displacement */
  Vec displacement_t; /* m, two components */
} SamFields;

/* State of a cell. */
typedef enum { SAM_STATE_OPEN, SAM_STATE_STICK, SAM_STATE_SLIP } SamState;
/* A cell in contact slips where |q| >= (1 - this) mu p. */
#define SAM_SLIP_MARGIN 1e-5
static inline SamState SamStateOf(PetscReal p, PetscReal qx, PetscReal qy, PetscReal friction)
{
  if (p <= 0) return SAM_STATE_OPEN;
  return PetscSqrtReal(qx * qx + qy * qy) >= (1 - SAM_SLIP_MARGIN) * friction * p ? SAM_STATE_SLIP : SAM_STATE_STICK;
}

/*
  What the check of a solution finds, from tractions and rigid displacements alone: elastic displacements are computed
  anew and no solver is trusted. All relative; zero for the exact solution of the discrete problem.
    normal       largest of |g| where p > 0, -g where p = 0, and -p u/p_max anywhere, over the largest displacement u
    tangential   |q - D(q - ds/c)| over the larger of |q| and |D(q - ds/c)|, in the 2-norm: D projects each cell's shear
                 on its disc |q| <= mu p, ds is the slip of the step, c a cell's self-influence. It holds stick, slip
                 direction and cone in one
    equilibrium  largest error of a force-controlled load over the sum of |traction| dA, moments also over the grid's
                 half width
    cone         largest |q| - mu p over the largest mu p
    edge         largest pressure in the outermost cells over the largest pressure
*/
typedef struct {
  PetscReal normal, tangential, equilibrium, cone, edge;
} SamCheck;

/* Outcome of a step, the worst that applies; as stored in the results. */
typedef enum {
  SAM_STATUS_CONVERGED      = 0,
  SAM_STATUS_NOT_CONVERGED  = 10, /* a solver, or the coupling, stopped without converging, or the check disagrees */
  SAM_STATUS_NO_EQUILIBRIUM = 11, /* gross slip under force control, or moments that no pressure balances */
  SAM_STATUS_EDGE_CONTACT   = 12  /* the contact reached the edge of the grid */
} SamStatus;

/* The numbers of one load step. */
typedef struct {
  PetscReal  time;
  SamBalance normal, tangential;       /* loads and rigid displacements, given or found */
  PetscReal  contact_area, stick_area; /* m2 */
  SamCheck   check;
  PetscInt   normal_iterations, normal_applies, normal_preconditions;
  PetscInt   tangential_iterations, tangential_applies, tangential_preconditions;
  PetscInt   coupling_iterations;
  SamStatus  status;
  PetscReal  dissipated_energy; /* J */
  char       message[512];      /* why the status is not 0 */
} SamStep;

/*
  SamContactCheck - checks a solution. In `fields` pressure and shear are read, the others are computed from them:
  elastic displacements by the compliance (with coupling unless that is false), gap and slip from their definitions with
  the rigid displacements of the step. `separation` (m) is of the undeformed bodies, `slip_before` (m, two components;
  NULL: zero) the slip at the end of the step before. Reads step->normal and step->tangential: which components are
  force-controlled and what their loads should be is given by `given_normal`, `given_tangential`. `same_pressure`:
  displacement_z is that of the pressure already, from the check of an earlier step with the same. Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactCheck(SamElasticity elasticity, PetscBool coupling, PetscBool same_pressure,
                                            PetscReal friction, Vec separation, Vec slip_before,
                                            const SamBalance *given_normal, const SamBalance *given_tangential,
                                            const SamStep *step, SamFields *fields, SamCheck *check);

/*
  SamContact - the contact of two bodies through a sequence of load steps: normal problem, tangential problem, for
  dissimilar materials repeated until both fit, then the check.
*/
typedef struct _n_SamContact *SamContact;

/*
  SamContactCreate - references the compliance and the separation (m), which must not change any more. friction >= 0.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactCreate(SamElasticity elasticity, Vec separation, PetscReal friction,
                                             SamContact *contact);
PETSC_EXTERN PetscErrorCode SamContactDestroy(SamContact *contact);
/*
  SamContactSetFromOptions - -coupling (full or none), -coupling_rtol, -coupling_max_it, -coupling_monitor,
  -allow_edge_contact, -contact_check (prints the check), and the options of both solvers. Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactSetFromOptions(SamContact contact);
PETSC_EXTERN PetscErrorCode SamContactGetNormal(SamContact contact, SamNormal *normal);             /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetTangential(SamContact contact, SamTangential *tangential); /* borrowed */
/*
  SamContactSolve - one load step: step->normal, step->tangential give what is controlled and by how much, all else of
  the step is filled in. The slip at its end is the reference of the next one. A status other than 0 comes with a
  message; a step without equilibrium leaves the contact as it was after the one before. Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactSolve(SamContact contact, SamStep *step);
/*
  SamContactSetLast - whether the next step is the last one: what would serve further ones only is then given back as
  soon as it can be. Another step is possible all the same, and its result the same. (Default: false.)
*/
PETSC_EXTERN PetscErrorCode SamContactSetLast(SamContact contact, PetscBool last);
/* SamContactGetFields - the fields of the last step that had a solution; borrowed. */
PETSC_EXTERN PetscErrorCode SamContactGetFields(SamContact contact, SamFields *fields);
PETSC_EXTERN PetscErrorCode SamContactGetGrid(SamContact contact, SamGrid *grid);       /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetCoupling(SamContact contact, PetscBool *full); /* of -coupling */

/*
  SamContactState - all that the steps before have to say to those that come: a contact that is given the state of
  another goes on as that one would, to the last bit and on any number of ranks.
*/
typedef struct {
  PetscInt   steps;                                 /* that count for the prediction of the next one */
  SamBalance given, found;                          /* normal control of the last step, and its outcome */
  double     values[2][6];                          /* what was controlled in the last step and in the one before */
  double     rigid[2][3];                           /* tangential rigid displacements then */
  PetscInt   window_first[2], window_n[2];          /* part of the compliance that the solvers use; n = 0: none */
  Vec        pressure, shear, slip, displacement_z; /* as in SamFields, after the last step */
  Vec        previous_pressure, previous_shear;     /* of the step before it; NULL before the second */
} SamContactState;

/* SamContactGetState - after a step; the vectors are borrowed until the next one. */
PETSC_EXTERN PetscErrorCode SamContactGetState(SamContact contact, SamContactState *state);
/*
  SamContactSetState - copies the vectors; the contact has no gap and no displacement_t until its next step.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactSetState(SamContact contact, const SamContactState *state);

#endif
