/* Functions of contact, besides petsam/contact.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_CONTACT_H
#define PETSAM_PRIVATE_CONTACT_H

#include <petsam/contact.h>
#include <petsam/private/edges.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/solver.h>

/*
  SamContactGetMotion - returns the motion of the bodies.

  Not collective.

  In:     contact - the contact

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamMotion SamContactGetMotion(SamContact contact);

/*
  SamContactSettings - the settings of a contact; the defaults are those of SamContactGetSettings() on a new contact.
  With coupling the normal and the tangential problem of dissimilar materials are solved in turn in each pass, until p
  and q solve both problems, each to its own tolerance, and neither has changed by more than coupling_rtol of its norm
  in the last pass. Contact spots are cells in contact connected by their sides, not by corners alone; on a grid that is
  one period they also connect over its edges.
  The slip of a step is opposite to the mean direction of the shear in the step (mid), or to its direction at the end of
  the step (end). The latter has an error of first order in the step length where the shear turns. It is always used in
  the first step, in steps that roll, and while all tangential loads lie on a line, so that the shear does not turn.
*/
typedef enum { SAM_SLIP_MID, SAM_SLIP_END } SamSlipDirection;
typedef struct {
  PetscBool        coupling;      /* normal-tangential coupling is taken into account (true; -coupling full or none) */
  PetscReal        coupling_rtol; /* tolerance of the coupling (1e-6; -coupling_rtol) */
  PetscInt         coupling_max_it;  /* maximum number of passes (100; -coupling_max_it) */
  PetscBool        coupling_monitor; /* print the change after each pass (false; -coupling_monitor) */
  PetscBool        warm_start;       /* start a step from earlier steps, on the finest grid only (true; -warm_start) */
  SamSlipDirection slip_direction;   /* reference direction of the slip (mid; -slip_direction) */
  PetscReal cycle_memory; /* bytes on all ranks for steps of a repeated load cycle: a step starts from the same step of
                                  the previous cycle, which changes the solution only within the tolerances (NaN, the
                                  default: SamContactCycleMemory(); 0: none; -cycle_memory) */
  PetscBool allow_edge;   /* contact at the edge of the grid only causes a warning (false; -allow_edge_contact) */
  PetscBool edges;        /* areas, and tractions at points, by reconstructed contact and stick edges (edges.h);
                                 else by counted cells, wrong by a part of a cell along the edge (true; -edges
                                 reconstruct or none) */
  PetscBool spots;        /* count the contact spots and compute the mean gap (false; -contact_spots) */
  PetscBool extrapolate;  /* steps of steady rolling are solved on half the cells, too, and their loads and creepages
                                 extrapolated; else these numbers are NaN (true; -extrapolate) */
  PetscBool print_check;  /* print the errors of each step (false; -contact_check) */
} SamContactSettings;

/*
  SamContactSetSettings - sets the settings of a contact.

  Not collective, the same on all ranks.

  In:     contact  - the contact
          settings - the settings; copied

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a tolerance or a number of passes that is not positive, or a negative memory.
*/
PETSC_EXTERN PetscErrorCode SamContactSetSettings(SamContact contact, const SamContactSettings *settings);

/*
  SamContactGetSettings - returns the settings of a contact.

  Not collective.

  In:     contact - the contact

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamContactSettings SamContactGetSettings(SamContact contact);

/*
  SamContactCycleMemory - returns the default memory for kept steps on a grid (bytes): 20 fields, 48 MB to 1 GB.

  Not collective.

  In:     grid - the grid

  Errors: none; it returns no error code.
*/
PETSC_EXTERN PetscReal SamContactCycleMemory(SamGrid grid);

/*
  SamContactCheckConditions - rejects conditions of a step that are out of their range, or that need a coupling of
  pressure and shear that the contact does not have. `where`: "file, line 3: " or "", for the message. Not collective.
  Errors: PETSC_ERR_ARG_OUTOFRANGE, SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamContactCheckConditions(SamContact contact, const SamControl *control,
                                                      const char where[]);

/*
  SamContactOfferCondition - adds a condition (control.h) and the others of its group to the numbers of each step; a
  rolled distance adds the creepages, too. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactOfferCondition(SamContact contact, const SamCondition *condition);

/*
  SamContactGetNormal - returns the solver of the normal problem, borrowed.

  Not collective.

  In:     contact - the contact

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamNormal SamContactGetNormal(SamContact contact);

/*
  SamContactGetTangential - returns the solver of the tangential problem, borrowed.

  Not collective.

  In:     contact - the contact

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamTangential SamContactGetTangential(SamContact contact);

/*
  SamContactSetSettles - lets each step find the direction and the beginning of its slip to the tolerance of the shear,
  whatever that is; else they are only as accurate as a step is, unless the tolerance is tight (contact/step/
  direction.c). Not collective.
*/
PETSC_INTERN void SamContactSetSettles(SamContact contact, PetscBool settles);

/*
  SamContactSetMonitor - adds a function that is called after every iteration of the normal and the tangential problem,
  as SamSolverMonitorSet() does; `solver` is that of the problem. Not collective. SamContactIsNormal - returns true if
  this solver is that of the normal problem. SamContactGetWork - returns the work of the normal, or the tangential,
  problem on the grid whose cells are `depth` times halved, borrowed. Not collective.
*/
PETSC_EXTERN PetscErrorCode      SamContactSetMonitor(SamContact contact, SamSolverMonitor monitor, void *context);
PETSC_EXTERN PetscBool           SamContactIsNormal(SamContact contact, SamSolver solver);
PETSC_EXTERN const SamLevelWork *SamContactGetWork(SamContact contact, SamBalanceKind kind, PetscInt depth);

/*
  SamContactNameOf - returns the name that results have for a number in the motion of the bodies, as `creep_x` of a
  rolling contact for `disp_x`. SamContactRigidName - returns that of the displacement, rotation or creepage of a
  component. Not collective.
*/
PETSC_EXTERN const char   *SamContactNameOf(SamContact contact, const char usual[]);
PETSC_EXTERN SamMotionName SamContactRigidName(SamContact contact, SamComponent component);

/* SamContactGetProblem - returns the problem of a contact, borrowed. Not collective. */
PETSC_INTERN SamProblem SamContactGetProblem(SamContact contact);

/*
  SamContactRewind - subtracts `by` (m) from the committed tangential displacements and the slide. Periodic bodies then
  have the same contact if `by` is a multiple of the grid's widths. There must be no tried state. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactRewind(SamContact contact, const PetscReal by[2]);

/*
  SamContactHasStep - returns true if there is a tried, or a committed, solution, as `generation` says. Not collective.
*/
PETSC_INTERN PetscBool SamContactHasStep(SamContact contact, SamGeneration generation);

/* SamContactHasField - sets `has` to true if there is a field of that name. Collective. */
PETSC_INTERN PetscErrorCode SamContactHasField(SamContact contact, const char name[], PetscBool *has);

/*
  SamContactComputeFriction - computes the effects of friction in the tried step, cell by cell. Each field has one
  component; NULL for a field that is not wanted:
    path     |ds|, the length of the slip of the step, m, in all cells; outside of the contact it is the distance by
             which the surfaces have moved over each other
    pressed  p |ds|, Pa m, in cells that slip, else 0; p is the mean of the pressures before and after the step
    work     -q.ds, J/m2, in cells that slip, else 0; if the pressure changes, with the mean of the bounds before and
             after the step, as in the dissipated energy
  Collective. Errors: PETSC_ERR_ORDER without a tried solution.
*/
PETSC_INTERN PetscErrorCode SamContactComputeFriction(SamContact contact, Vec path, Vec pressed, Vec work);

/*
  SamContactPrintLaws - prints the laws' reports of the last step.

  Collective.

  In:     contact - the contact
          viewer  - an ASCII viewer

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamContactPrintLaws(SamContact contact, PetscViewer viewer);

/*
  SamContactAdvise - writes a warning about the last step by the next law, counted from number *k (0 at first), that has
  one; *k becomes the number of that law. An empty text: no further law has a warning. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactAdvise(SamContact contact, PetscInt *k, char text[], size_t size);

/*
  SamContactFindEdge - reconstructs the contact edge or the stick-slip boundary of the solution (edges.h), which is
  borrowed until the next step. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactFindEdge(SamContact contact, SamEdgeOf which, const SamEdge **edge);

/*
  SamContactSetState - copies the committed state of another contact of the same problem, or one that was read from a
  file. The contact then continues as the other one would, to the last bit, on any number of ranks. `gap_is_current`:
  the state was solved with the present gap of the problem. A tried state is discarded. Collective. Errors: those of
  SamStateCopy().
  SamContactTakeOver - copies that of another contact of the same problem, with its kept steps. Collective. Errors: the
  same.
  SamContactGetSteps - returns the number of committed steps. Not collective.
*/
PETSC_INTERN PetscErrorCode SamContactSetState(SamContact contact, SamState state, PetscBool gap_is_current);
PETSC_INTERN PetscErrorCode SamContactTakeOver(SamContact contact, SamContact from);
PETSC_INTERN PetscInt       SamContactGetSteps(SamContact contact);
/* SamContactBefore - returns the committed solution, from which the tried one continues; NULL in the first step. Not
   collective. */
PETSC_INTERN const SamSolution *SamContactBefore(SamContact contact);

/*
  SamContactIsGapCurrent - sets `current` to true if the committed pressure was solved with the present gap of the
  problem. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactIsGapCurrent(SamContact contact, PetscBool *current);

/*
  SamContactSummarize - gets what the k-th law writes about the last step, whose number in the run is given, and its
  weight (SamLaw, `summarize`); returns the law's type; NULL: there are no more laws. Not collective.
*/
PETSC_EXTERN SamLawType SamContactSummarize(SamContact contact, PetscInt k, PetscInt step, PetscReal *weight,
                                            char text[], size_t size);

#endif
