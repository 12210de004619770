/*
  The contact of two bodies through a sequence of load steps. Each step is tried, then committed or rejected. Also the
  independent check of a solution, and the verdict on it.
*/
#ifndef PETSAM_CONTACT_H
#define PETSAM_CONTACT_H

#include <petsam/control.h>
#include <petsam/edges.h>
#include <petsam/normal.h>
#include <petsam/problem.h>
#include <petsam/tangential.h>

/* State of a cell, as the results store it. */
typedef enum { SAM_STATE_OPEN, SAM_STATE_STICK, SAM_STATE_SLIP } SamState;
/* Relative margin: a cell in contact counts as slipping where |q| >= (1 - SAM_SLIP_MARGIN) mu p. */
#define SAM_SLIP_MARGIN 1e-5
/* SamStateOf - the state of a cell from its pressure, shear and bound mu p (all Pa). Not collective. */
static inline SamState SamStateOf(PetscReal p, PetscReal qx, PetscReal qy, PetscReal bound)
{
  if (p <= 0) return SAM_STATE_OPEN;
  return PetscSqrtReal(qx * qx + qy * qy) >= (1 - SAM_SLIP_MARGIN) * bound ? SAM_STATE_SLIP : SAM_STATE_STICK;
}

/*
  SamShearCorrection - what the shear does within cells (edges.h), where that is corrected for.
*/
typedef struct {
  PetscBool      has;          /* false: it is not, and the rest is unused */
  PetscInt       passes;       /* for the stick zone's edge; 0: it has none */
  Vec            displacement; /* m, two components: part of u_t by it */
  Vec            rim; /* Pa: slack mu p - |q| of cells that the stick zone's edge cuts and whose centre slips */
  SamShearWithin within;
  Vec            plain_reference; /* Pa, two components: the plain shear when the load last turned back */
  SamSlack       slack;           /* that the stick zone's edge was found by in this step; none: it is not corrected */
} SamShearCorrection;

/*
  SamSolution - the solution of a load step: tractions, rigid displacements and relative elastic displacements u.
  A field has one component, or two: on each rank all of x, then all of y. With the separation h of the undeformed
  bodies, and the plastic depth w, the gap is g = u_z + h + w - rigid and the slip is s = u_t + stretch - rigid;
  SamContactComputeGap() and SamContactComputeSlip() compute them.
*/
typedef struct {
  SamControl         control;               /* what was prescribed */
  PetscReal          load[SAM_COMPONENTS];  /* N, N m: given or found */
  PetscReal          rigid[SAM_COMPONENTS]; /* m, rad: given or found */
  Vec                pressure;              /* Pa */
  Vec                bound;                 /* Pa: mu p, the largest shear */
  Vec                shear;                 /* Pa, two components: acts on body 2 */
  Vec                displacement_z;        /* m: relative elastic displacement u_z */
  Vec                displacement_t;        /* m, two components: relative elastic displacement u_t */
  Vec                plastic;    /* m: depth by which the surfaces have yielded, this step included; NULL: nowhere */
  PetscInt           passes;     /* of the correction for the contact's edge; 0: none, and the next two are unused */
  Vec                correction; /* m: part of u_z by what the pressure does within cells */
  Vec                rim;        /* Pa: pressure of cells that the edge cuts and whose centre is not in contact */
  SamShearCorrection sheared;    /* of the shear */
} SamSolution;

/*
  SamCheck - the errors that the check of a solution finds. It uses only the tractions and the rigid displacements,
  recomputes the elastic displacements, and trusts no solver. All errors are relative, and zero for the exact
  solution of the discrete problem.
    normal       error of p >= 0, g >= 0, p g = 0: the largest of |g| where p > 0, of -g where p = 0, and of -p u/p_max,
                 over the largest displacement u. Of cells on the rim only -g counts; of cells at the limit of the
                 pressure, which may overlap before they yield, only g; and what p exceeds the limit by, relative to it
    tangential   error of the law of friction: |q - D(q - ds/c)| over the larger of |q| and |D(q - ds/c)|, in the
                 2-norm. D projects each cell's shear onto its disc |q| <= mu p, ds is the slip of the step, c the
                 self-influence of a cell. One number for stick, direction of slip, and the limit mu p
    equilibrium  largest error of a given load over the sum of |traction| dA; a moment's also over half the grid's
                 larger width plus the distance of its centre from the origin
    cone         largest |q| - mu p over the largest mu p
    edge         largest pressure in the outermost cells over the largest pressure; 0 where the grid has no edge
*/
typedef struct {
  PetscReal normal, tangential, equilibrium, cone, edge;
} SamCheck;

/*
  SamCheckSolution - checks a solution. Input: its control, rigid displacements, pressure and shear, and `before`, the
  solution of the previous step (NULL: no slip and no plastic depth so far). Output: the errors, and the solution's
  elastic displacements, for which it must have the vectors. `coupling`: pressure and shear of dissimilar bodies act on
  each other. `u_z_known`: displacement_z is already right and used as it is. Collective.
*/
PETSC_EXTERN PetscErrorCode SamCheckSolution(SamProblem problem, PetscBool coupling, PetscBool u_z_known,
                                             const SamSolution *before, SamSolution *solution, SamCheck *check);

/* SamStatus - the outcome of a load step, with the numbers that the results store and the program exits with. */
typedef enum {
  SAM_STATUS_CONVERGED      = 0,
  SAM_STATUS_NOT_CONVERGED  = 10, /* a solver, or the coupling, stopped without converging, or the check disagrees */
  SAM_STATUS_NO_EQUILIBRIUM = 11, /* gross slip under force control, or loads that no pressure balances */
  SAM_STATUS_EDGE_CONTACT   = 12  /* the contact reached the edge of the grid */
} SamStatus;

/* SamStep - the numbers of one load step. Without a solution (NO_EQUILIBRIUM), those that were not given are NaN. */
typedef struct {
  SamControl control;                  /* as given */
  PetscReal  load[SAM_COMPONENTS];     /* N, N m: given or found */
  PetscReal  rigid[SAM_COMPONENTS];    /* m, rad: given or found */
  PetscReal  contact_area, stick_area; /* m2: counted cells, or by the edges (SamContactSetEdges()) */
  PetscReal  contact_fraction;         /* contact area over that of the grid */
  PetscInt   contact_cells, stick_cells;
  PetscReal  pressure_max, shear_max; /* Pa: of the cells; the shear also at the edge of stick, where that is found */
  PetscReal  slip_max;                /* m, the largest slip since the start of a cell in contact */
  PetscReal  spots, gap_mean;         /* number of spots; m, mean of all cells; NaN unless SamContactSetSpots() */
  PetscReal  edge_accepted;           /* share of the edges of contact and stick that are reconstructed, 0 to 1 */
  PetscReal  dissipated_energy;       /* J, frictional work of the step: slip times the mean bound of the step */
  PetscReal  stored_energy;           /* J, elastic: half the work of the tractions on the elastic displacements */
  SamCheck   check;
  PetscInt   edge_passes, stick_passes; /* of the corrections for the edges of contact and stick; 0: none */
  PetscInt   normal_iterations, normal_applies, normal_preconditions;
  PetscInt   tangential_iterations, tangential_applies, tangential_preconditions;
  PetscInt   coupling_iterations;
  PetscInt   plastic_cells;     /* whose pressure is at its limit; this and the next three are 0 without a limit */
  PetscReal  plastic_area;      /* m2, of these cells */
  PetscReal  plastic_depth_max; /* m: the largest depth by which the surfaces have yielded so far */
  PetscReal  plastic_energy;    /* J, work of the pressure on what the surfaces yield in the step */
  PetscReal  cycle;             /* cycles of a life before this one; the caller's (life.h), as the next */
  PetscReal  wear_volume[2];    /* m3, removed of body 1 and 2 so far (wear.h) */
  PetscReal  stiffness[2][SAM_COMPONENTS][SAM_COMPONENTS]; /* by direction (stiffness.h); NaN unless computed */
  SamStatus  status;
  char       message[512]; /* why the status is not CONVERGED, or a warning; else empty */
  char       setting[32];  /* option (without dash) of the setting behind the message, grid_size ...; empty: none */
} SamStep;

/* SamStepIsSolved - whether a step has a solution to go on from. Not collective. */
static inline PetscBool SamStepIsSolved(const SamStep *step)
{
  return step->status != SAM_STATUS_NOT_CONVERGED && step->status != SAM_STATUS_NO_EQUILIBRIUM;
}

/* SamCheckLimits - the largest errors of a step that counts as converged. */
typedef struct {
  PetscReal normal, tangential, equilibrium, cone;
  PetscBool edge; /* contact at the grid's edge is only a warning */
} SamCheckLimits;

/*
  SamStepJudge - sets a step's status and message from the errors in step->check. An error that is NaN fails. A status
  other than CONVERGED that the step already has is kept. Not collective: all ranks have the same numbers.
*/
PETSC_EXTERN PetscErrorCode SamStepJudge(SamStep *step, const SamCheckLimits *limits);

/*
  SamContact - the contact of two bodies through a sequence of load steps. It holds a problem, the committed state, and
  at most one tried state:
    SamContactTry()     solves a step from the committed state; may be repeated, each try replaces the one before
    SamContactCommit()  makes the tried state the committed one, from which the next step starts
    SamContactReject()  discards the tried state: later steps are the same, to the last bit, as if it had not been tried
  With a limit of the pressure (problem.h), the surfaces yield where it is reached: a committed step leaves its overlap
  as plastic depth, which later steps find added to the separation.
  The gap and the friction of the problem may change between steps. Slip belongs to a place on the grid and is kept;
  the pressure is solved again when the gap has changed.
*/
typedef struct _n_SamContact *SamContact;

/*
  SamContactCreate - a contact without any step so far; the bodies have never touched. References the problem.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactCreate(SamProblem problem, SamContact *contact);
/* SamContactDestroy - frees the contact and sets the handle to NULL. Collective. */
PETSC_EXTERN PetscErrorCode SamContactDestroy(SamContact *contact);
/* SamContactSetOptionsPrefix - the prefix of its options and of its solvers'; NULL: none. Not collective. */
PETSC_EXTERN PetscErrorCode SamContactSetOptionsPrefix(SamContact contact, const char prefix[]);
/*
  SamContactSetFromOptions - reads -coupling (full or none), -coupling_rtol, -coupling_max_it, -warm_start,
  -allow_edge_contact, -edges, -edges_passes, -contact_spots, -sum_slip_path and -sum_friction_energy, which mirror the
  functions below; -coupling_monitor (prints the change after each pass); -contact_check (prints the errors of each
  step); and the options of both solvers. Collective. Errors: SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamContactSetFromOptions(SamContact contact);
/*
  SamContactSetCoupling - `full`: normal-tangential coupling of dissimilar materials is taken into account (default:
  true; option -coupling). The normal and the tangential problem are then solved in turn, a pass each, until one p and
  one q solve both, each to its own tolerance, and neither has changed by more than `rtol` of its norm in the last pass
  (1e-6; -coupling_rtol); in at most `max_it` passes (100; -coupling_max_it). PETSC_DEFAULT keeps a number. Not
  collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a number that is not positive.
*/
PETSC_EXTERN PetscErrorCode SamContactSetCoupling(SamContact contact, PetscBool full, PetscReal rtol, PetscInt max_it);
/* SamContactGetCoupling - whether coupling is taken into account. Not collective. */
PETSC_EXTERN PetscErrorCode SamContactGetCoupling(SamContact contact, PetscBool *full);
/*
  SamContactSetWarmStart - whether a step starts from a guess made of the steps before (default: true), on the finest
  grid only. Option -warm_start. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamContactSetWarmStart(SamContact contact, PetscBool warm);
/*
  SamContactAllowEdge - whether contact at the grid's edge is only a warning and not a status (default: false). Option
  -allow_edge_contact. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamContactAllowEdge(SamContact contact, PetscBool allow);
/*
  SamContactSetEdges - what is done for the edges of contact and stick: nothing, areas being counted cells, wrong by a
  part of a cell along the edge; they are reconstructed, which gives areas and point values (edges.h; default); or
  pressure and shear are solved again, `passes` times each, for the displacement by what they do within the cells along
  the edges (deferred correction, src/contact/deferred.c and deferredshear.c). Options -edges and -edges_passes. Not
  collective.
  Errors: PETSC_ERR_ARG_OUTOFRANGE for less than one pass.
*/
typedef enum { SAM_CONTACT_EDGES_NONE, SAM_CONTACT_EDGES_RECONSTRUCT, SAM_CONTACT_EDGES_DEFERRED } SamContactEdges;
PETSC_EXTERN PetscErrorCode SamContactSetEdges(SamContact contact, SamContactEdges edges, PetscInt passes);
/*
  SamContactSetSpots - whether the spots of contact are counted in each step, and the mean gap is computed (default:
  false). Spots are zones of cells in contact that are connected by their sides, not by corners alone; over the edges of
  a grid that is one period, too. Option -contact_spots. Not collective.
  SamContactGetSpots - whether they are. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamContactSetSpots(SamContact contact, PetscBool count);
PETSC_EXTERN PetscErrorCode SamContactGetSpots(SamContact contact, PetscBool *count);
/* SamContactGetEdges - what is done for the edges. Not collective. */
PETSC_EXTERN PetscErrorCode SamContactGetEdges(SamContact contact, SamContactEdges *edges);
/* The objects of a contact. Not collective. */
PETSC_EXTERN PetscErrorCode SamContactGetProblem(SamContact contact, SamProblem *problem);          /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetGrid(SamContact contact, SamGrid *grid);                   /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetNormal(SamContact contact, SamNormal *normal);             /* borrowed */
PETSC_EXTERN PetscErrorCode SamContactGetTangential(SamContact contact, SamTangential *tangential); /* borrowed */

/*
  SamContactTry - solves one load step from the committed state, checks the solution, and fills `step` with the numbers
  of the step. That a step has no solution or does not converge is a status with a message, not an error; after
  NO_EQUILIBRIUM there is no tried state. Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a control that is not finite,
  a negative normal force or friction scale, or a moment or rotation that is not zero where the elasticity has none.
*/
PETSC_EXTERN PetscErrorCode SamContactTry(SamContact contact, const SamControl *control, SamStep *step);
/*
  SamContactCommit - makes the tried state the committed one. Collective. Errors: PETSC_ERR_ORDER without a tried state.
*/
PETSC_EXTERN PetscErrorCode SamContactCommit(SamContact contact);
/* SamContactReject - discards the tried state, if there is one. Collective. */
PETSC_EXTERN PetscErrorCode SamContactReject(SamContact contact);
/*
  SamContactGetSolution - the solution of the tried state if there is one, else of the committed one. Borrowed until the
  next try, commit or rejection. Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactGetSolution(SamContact contact, const SamSolution **solution);
/*
  Fields that follow from the solution (that of SamContactGetSolution()), written to the caller's vectors of one
  component. Collective.
  SamContactComputeGap - the gap between the deformed surfaces (m), with the separation that the problem has now.
  SamContactComputeSlip - the slip since the start (m), along x for component 0 and along y for component 1.
  SamContactComputeState - the state of each cell, a SamState as a real number.
  SamContactComputePlasticDepth - the depth by which both surfaces together have yielded (m).
  SamContactComputeOverlap - the part of it that the tried step has added. Errors: PETSC_ERR_ORDER without a tried step.
*/
PETSC_EXTERN PetscErrorCode SamContactComputePlasticDepth(SamContact contact, Vec depth);
PETSC_EXTERN PetscErrorCode SamContactComputeOverlap(SamContact contact, Vec overlap);
PETSC_EXTERN PetscErrorCode SamContactComputeGap(SamContact contact, Vec gap);
PETSC_EXTERN PetscErrorCode SamContactComputeSlip(SamContact contact, PetscInt component, Vec slip);
PETSC_EXTERN PetscErrorCode SamContactComputeState(SamContact contact, Vec state);

/*
  SamContactFindEdge - an edge of that solution (edges.h), with its points: by the reconstruction, or the correction
  where there is one. `point` (NULL: not wanted), of one component: the square of what vanishes at the edge (Pa2), at
  the cells' centres: of the pressure, or, for the stick zone, of what it exceeds |q|/mu by. Collective.
  SamContactComputePressureCenter, SamContactComputeShearCenter - the tractions (Pa) at the cells' centres, by these
  edges, whose means over cells the solution has. Where an edge is not smooth the means stay. Collective.
*/
typedef enum { SAM_CONTACT_EDGE_CONTACT, SAM_CONTACT_EDGE_STICK } SamContactEdge;
PETSC_EXTERN PetscErrorCode SamContactFindEdge(SamContact contact, SamContactEdge which, Vec point, SamEdge *edge);
PETSC_EXTERN PetscErrorCode SamContactComputePressureCenter(SamContact contact, Vec pressure);
PETSC_EXTERN PetscErrorCode SamContactComputeShearCenter(SamContact contact, PetscInt component, Vec shear);

/*
  SamContactComputeFriction - what friction does in the tried step; each field of one component, NULL for one that is
  not wanted:
    path     |ds|, the length of the slip of the step, m, in all cells; outside of the contact it is how far the
             surfaces have moved over each other
    pressed  p |ds|, Pa m, in cells that slip, else 0; p is the mean of the pressures before and after the step
    work     -q.ds, J/m2, in cells that slip, else 0; where the pressure changes, by the mean of the bounds before and
             after, as SamStep's dissipated energy
  Collective. Errors: PETSC_ERR_ORDER without a tried step.
*/
PETSC_EXTERN PetscErrorCode SamContactComputeFriction(SamContact contact, Vec path, Vec pressed, Vec work);

/*
  Sums over all steps, of what SamContactComputeFriction() gives for each of them:
    SLIP_PATH        path, m
    FRICTION_ENERGY  work, J/m2
  SamContactKeepSum - keeps one from now on, from 0; it takes the memory of a field. Collective.
  SamContactGetSum - that over the committed steps, NULL if it is not kept; borrowed. Who sets its values has them
  counted on from there. Not collective.
  SamContactComputeSum - into a vector of one component, with the tried step if there is one. Collective. Errors:
  PETSC_ERR_ORDER if it is not kept.
*/
typedef enum { SAM_CONTACT_SLIP_PATH, SAM_CONTACT_FRICTION_ENERGY, SAM_CONTACT_SUMS } SamContactSum;
PETSC_EXTERN PetscErrorCode SamContactKeepSum(SamContact contact, SamContactSum which);
PETSC_EXTERN PetscErrorCode SamContactGetSum(SamContact contact, SamContactSum which, Vec *sum);
PETSC_EXTERN PetscErrorCode SamContactComputeSum(SamContact contact, SamContactSum which, Vec sum);

/*
  SamContactState - the committed state: all that later steps depend on. A contact of the same problem that is given the
  state of another goes on as that one would, to the last bit, on any number of ranks.
*/
typedef struct {
  PetscInt    steps;                        /* number of committed steps */
  SamSolution now;                          /* of the last committed step */
  SamSolution plain;                        /* of that step, where its shear is corrected: the plain solution */
  SamSolution before;                       /* one step back, tractions only; vectors NULL before the second step */
  Vec         sums[SAM_CONTACT_SUMS];       /* over the committed steps; NULL: not kept */
  PetscInt    window_first[2], window_n[2]; /* part of the grid that the solvers worked on: cells; n = 0: all of it */
  PetscBool   gap_is_current;               /* `now` was solved with the gap that the problem has now */
} SamContactState;

/* SamContactGetState - the committed state; its vectors are borrowed until the next commit. Collective. */
PETSC_EXTERN PetscErrorCode SamContactGetState(SamContact contact, SamContactState *state);
/*
  SamContactSetState - copies a state, vectors included, into the committed state; discards a tried one. Collective.
  Errors: PETSC_ERR_ARG_INCOMP when the state lacks vectors.
*/
PETSC_EXTERN PetscErrorCode SamContactSetState(SamContact contact, const SamContactState *state);

#endif
