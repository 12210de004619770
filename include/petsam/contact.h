/* The contact of two bodies through a sequence of load steps. Each step is tried, then committed or rejected. */
#ifndef PETSAM_CONTACT_H
#define PETSAM_CONTACT_H

#include <petsam/check.h>
#include <petsam/edges.h>
#include <petsam/normal.h>
#include <petsam/tangential.h>

/*
  SamContact - the contact of two bodies through a sequence of load steps. It holds a problem, the committed state, and
  at most one tried state:
    SamContactTry()     solves a step from the committed state; may be repeated, each try replaces the one before
    SamContactCommit()  makes the tried state the committed one, from which the next step starts
    SamContactReject()  discards the tried state: later steps are the same, to the last bit, as if it had not been tried
  The gap and the laws of the problem may change between steps, and laws may be added. Slip belongs to a place on the
  grid and is kept; the pressure is solved again when the separation has changed.
  What a contact remembers, and what results offer of it, is in its state (state.h), by name.
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
/* SamContactGetMotion - the motion of its bodies. Not collective. */
PETSC_EXTERN SamMotion SamContactGetMotion(SamContact contact);
/*
  SamContactSettings - of a contact; its defaults are those of SamContactGetSettings() on a new one.
  With coupling the normal and the tangential problem of dissimilar materials are solved in turn, a pass each, until one
  p and one q solve both, each to its own tolerance, and neither has changed by more than coupling_rtol of its norm in
  the last pass. Contact spots are cells in contact connected by their sides, not by corners alone; over the edges of a
  grid that is one period, too.
  The slip of a step is opposite to the mean direction of the shear in it (mid), or to that at its end (end), whose
  error is of first order in the steps where the shear turns. The end is used in the first step, in steps that roll, and
  while all tangential loads lie on a line, where the shear does not turn.
*/
typedef enum { SAM_SLIP_MID, SAM_SLIP_END } SamSlipDirection;
typedef struct {
  PetscBool        coupling;      /* normal-tangential coupling is taken into account (true; -coupling full or none) */
  PetscReal        coupling_rtol; /* (1e-6; -coupling_rtol) */
  PetscInt         coupling_max_it;  /* most passes (100; -coupling_max_it) */
  PetscBool        coupling_monitor; /* print the change after each pass (false; -coupling_monitor) */
  PetscBool        warm_start;     /* start a step from the steps before, on the finest grid only (true; -warm_start) */
  SamSlipDirection slip_direction; /* (mid; -slip_direction) */
  PetscReal cycle_memory; /* bytes on all ranks for steps of a repeated load cycle: a step that the cycle before had
                                 starts from that, with the same solution within the tolerances (NaN, the default:
                                 those of SamContactCycleMemory(); 0: none; -cycle_memory) */
  PetscBool allow_edge;   /* contact at the grid's edge is a warning, no status (false; -allow_edge_contact) */
  PetscBool edges;        /* areas, and tractions at points, by reconstructed contact and stick edges (edges.h);
                                 else by counted cells, wrong by a part of a cell along the edge (true; -edges
                                 reconstruct or none) */
  PetscBool spots;        /* count the contact spots and compute the mean gap (false; -contact_spots) */
  PetscBool print_check;  /* print the errors of each step (false; -contact_check) */
} SamContactSettings;
/*
  SamContactSetSettings, SamContactGetSettings - not collective, the same on all ranks. Errors:
  PETSC_ERR_ARG_OUTOFRANGE for a number that is not positive.
  SamContactSetFromOptions - reads the options above, and those of both solvers. Collective. Errors: SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode     SamContactSetSettings(SamContact contact, const SamContactSettings *settings);
PETSC_EXTERN SamContactSettings SamContactGetSettings(SamContact contact);
/* SamContactCycleMemory - the usual bytes for kept steps on a grid: 20 fields, 16 MB to 1 GB. Not collective. */
PETSC_EXTERN PetscReal      SamContactCycleMemory(SamGrid grid);
PETSC_EXTERN PetscErrorCode SamContactSetFromOptions(SamContact contact);
/*
  SamContactSetUp - checks that settings, laws and solvers go together; SamContactTry() calls it. Collective. Errors:
  SAM_ERR_USER.
*/
PETSC_EXTERN PetscErrorCode SamContactSetUp(SamContact contact);
/*
  SamContactCheckConditions - refuses conditions of a step that are out of their range, or that need a coupling of
  pressure and shear that the contact does not have. `where`: "file, line 3: " or "", for the message. Not collective.
  Errors: PETSC_ERR_ARG_OUTOFRANGE, SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamContactCheckConditions(SamContact contact, const SamControl *control,
                                                      const char where[]);
/*
  SamContactOfferCondition - makes a condition (control.h) and others of its group numbers of each step, and with a
  rolled distance the creepages. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactOfferCondition(SamContact contact, const SamCondition *condition);
/*
  The objects of a contact, borrowed. Not collective, but for SamContactGetState(), which lets the laws declare what
  they remember. That state is for reading, and for what a program offers of its own.
*/
PETSC_EXTERN PetscErrorCode SamContactGetState(SamContact contact, SamState *state);
PETSC_INTERN SamProblem     SamContactGetProblem(SamContact contact);
PETSC_EXTERN SamGrid        SamContactGetGrid(SamContact contact);
PETSC_EXTERN SamNormal      SamContactGetNormal(SamContact contact);
PETSC_EXTERN SamTangential  SamContactGetTangential(SamContact contact);

/*
  SamContactTry - solves one load step from the committed state, checks the solution, and fills `step` with the numbers
  of the step. That a step has no solution or does not converge is a status with a message, not an error; after
  NO_EQUILIBRIUM there is no tried state. Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for a control that is not finite,
  a negative normal force or friction scale, or a moment or rotation that is not zero where the elasticity has none;
  those of SamContactSetUp().
*/
PETSC_EXTERN PetscErrorCode SamContactTry(SamContact contact, const SamControl *control, SamStep *step);
/*
  SamContactCommit - makes the tried state the committed one. Collective. Errors: PETSC_ERR_ORDER without a tried state.
*/
PETSC_EXTERN PetscErrorCode SamContactCommit(SamContact contact);
/* SamContactReject - discards the tried state, if there is one. Collective. */
PETSC_EXTERN PetscErrorCode SamContactReject(SamContact contact);
/*
  SamContactRewind - the tangential displacements (m) of all steps so far become less by these, and with them the slide:
  of bodies that repeat themselves, by whole lengths of the grid, the contact is the same. There is no tried state.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamContactRewind(SamContact contact, const PetscReal by[2]);
/* SamContactHasStep - whether there is a tried solution, or a committed one. Not collective. */
PETSC_INTERN PetscBool SamContactHasStep(SamContact contact, SamGeneration generation);
/*
  SamContactGetSolution - the solution of the tried state if there is one, else of the committed one. Borrowed until the
  next try, commit or rejection. Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactGetSolution(SamContact contact, const SamSolution **solution);
/*
  SamContactGetField - a field of the results, of the tried state if there is one, else of the committed one, by its
  name there (`pressure`, `slip_x`, `gap` ...), into a vector of one component. SamContactHasField - whether there is
  one of that name. Collective. Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for an unknown name.
  SamContactGetNumber - a number of /history, likewise; NaN where there is none. Not collective. Errors:
  PETSC_ERR_ARG_UNKNOWN_TYPE for an unknown name.
*/
PETSC_EXTERN PetscErrorCode SamContactGetField(SamContact contact, const char name[], Vec field);
PETSC_INTERN PetscErrorCode SamContactHasField(SamContact contact, const char name[], PetscBool *has);
PETSC_EXTERN PetscErrorCode SamContactGetNumber(SamContact contact, const char name[], PetscReal *value);

/*
  SamContactComputeFriction - what friction does in the tried step, cell by cell; each field of one component, NULL for
  one that is not wanted:
    path     |ds|, the length of the slip of the step, m, in all cells; outside of the contact it is how far the
             surfaces have moved over each other
    pressed  p |ds|, Pa m, in cells that slip, else 0; p is the mean of the pressures before and after the step
    work     -q.ds, J/m2, in cells that slip, else 0; where the pressure changes, by the mean of the bounds before and
             after, as the dissipated energy
  Collective. Errors: PETSC_ERR_ORDER without a tried solution.
*/
PETSC_INTERN PetscErrorCode SamContactComputeFriction(SamContact contact, Vec path, Vec pressed, Vec work);

/*
  SamContactPrintLaws - prints the laws' reports of the last step. Collective.
  SamContactAdvise - a warning about the last step, from the first law from number *k on (0 at first) that has one; *k
  becomes the number of this law. Empty: no law has one. Collective.
*/
PETSC_EXTERN PetscErrorCode SamContactPrintLaws(SamContact contact, PetscViewer viewer);
PETSC_INTERN PetscErrorCode SamContactAdvise(SamContact contact, PetscInt *k, char text[], size_t size);

/*
  SamContactFindEdge - an edge of that solution (edges.h), with its points: by the reconstruction, or by a law that
  corrects for it. `point` (NULL: not wanted), of one component: the square of what vanishes at the edge (Pa2), at the
  cells' centres: of the pressure, or, for the stick zone, of what it exceeds |q|/mu by. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactFindEdge(SamContact contact, SamEdgeOf which, Vec point, SamEdge *edge);

/*
  SamContactSetState - the committed state becomes that of another contact of the same problem, or one that was read
  from a file: the contact continues as that one would, to the last bit, on any number of ranks. `gap_is_current`: the
  state was solved with the gap that the problem has now. Forgets a tried state. Collective. Errors: those of
  SamStateCopy().
  SamContactReset - the bodies have never touched. Collective.
  SamContactGetSteps - the number of committed steps. Not collective.
*/
PETSC_INTERN PetscErrorCode SamContactSetState(SamContact contact, SamState state, PetscBool gap_is_current);
PETSC_EXTERN PetscErrorCode SamContactReset(SamContact contact);
PETSC_INTERN PetscInt       SamContactGetSteps(SamContact contact);
/* SamContactIsGapCurrent - whether the committed pressure was solved with the problem's gap of now. Collective. */
PETSC_INTERN PetscErrorCode SamContactIsGapCurrent(SamContact contact, PetscBool *current);

#endif
