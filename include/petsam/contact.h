/* The contact of two bodies through a sequence of load steps. Each step is tried, then committed or rejected. */
#ifndef PETSAM_CONTACT_H
#define PETSAM_CONTACT_H

#include <petsam/check.h>
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
  The fields and numbers that a contact stores, and those that results offer, are in its state (state.h), by name.

  See also: SamContactCreate(), SamContactTry(), SamProblem.
*/
typedef struct _n_SamContact *SamContact;

/*
  SamContactCreate - creates a contact without any step: the bodies have never touched.

  Collective.

  In:     problem - the problem; the contact references it
  Out:    contact - the contact

  Errors: none of its own.

  See also: SamContactDestroy(), SamProblemCreate(), SamContactSetFromOptions(), SamContactTry().
*/
PETSC_EXTERN PetscErrorCode SamContactCreate(SamProblem problem, SamContact *contact);

/*
  SamContactDestroy - frees the contact and sets the handle to NULL.

  Collective.

  In,out: contact - the contact; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamContactDestroy(SamContact *contact);

/*
  SamContactSetOptionsPrefix - sets the prefix of the options of the contact and of its solvers.

  Not collective.

  In:     contact - the contact
          prefix  - the prefix, without dash; copied; NULL: none

  Errors: PETSC_ERR_ARG_SIZ for a prefix that is too long.

  See also: SamContactSetFromOptions().
*/
PETSC_EXTERN PetscErrorCode SamContactSetOptionsPrefix(SamContact contact, const char prefix[]);

/*
  SamContactSetFromOptions - reads the settings of the contact and of both solvers from the options.

  Collective.

  In:     contact - the contact

  Options: those named at SamContactSettings, and those of SamSolverSetFromOptions() for both solvers.
  Errors: SAM_ERR_USER for a wrong value, or an option that the motion of the bodies does not allow.

  See also: SamContactSetOptionsPrefix(), SamContactSetUp().
*/
PETSC_EXTERN PetscErrorCode SamContactSetFromOptions(SamContact contact);

/*
  SamContactSetUp - checks that settings, laws and solvers are compatible.

  Collective.

  In:     contact - the contact

  Errors: SAM_ERR_USER if they are not.

  SamContactTry() calls it.

  See also: SamContactSetFromOptions(), SamContactTry().
*/
PETSC_EXTERN PetscErrorCode SamContactSetUp(SamContact contact);

/*
  SamContactGetState - gets the state of a contact, borrowed.

  Collective, as the laws declare their fields and numbers.

  In:     contact - the contact
  Out:    state   - the state; borrowed

  Errors: none of its own.

  A program may read that state, and offer results of its own in it.

  See also: SamStateFindField(), SamStateReadField(), SamContactGetField().
*/
PETSC_EXTERN PetscErrorCode SamContactGetState(SamContact contact, SamState *state);

/*
  SamContactGetGrid - returns the grid of a contact, borrowed.

  Not collective.

  In:     contact - the contact

  Errors: none; it returns no error code.
*/
PETSC_EXTERN SamGrid SamContactGetGrid(SamContact contact);

/*
  SamContactTry - solves one load step from the committed state, and checks the solution.

  Collective.

  In:     contact - the contact
          control - the prescribed loads, displacements and conditions; copied
  Out:    step    - the numbers of the step, its errors, its status and a message

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a control that is not finite, a negative normal force or friction scale, a
  condition out of its range, or a moment or rotation that is not zero where the elasticity has none; SAM_ERR_USER for a
  condition that needs coupling when there is none; those of SamContactSetUp().

  A step that has no solution or does not converge gets a status and a message; this is not an error. After
  NO_EQUILIBRIUM there is no tried state. A try replaces an earlier one.

  See also: SamControlInitialize(), SamContactCommit(), SamContactReject(), SamStepIsSolved().
*/
PETSC_EXTERN PetscErrorCode SamContactTry(SamContact contact, const SamControl *control, SamStep *step);

/*
  SamContactCommit - makes the tried state the committed one, from which the next step starts.

  Collective.

  In:     contact - the contact

  Errors: PETSC_ERR_ORDER without a tried state.

  See also: SamContactTry(), SamContactReject().
*/
PETSC_EXTERN PetscErrorCode SamContactCommit(SamContact contact);

/*
  SamContactReject - discards the tried state, if there is one.

  Collective.

  In:     contact - the contact

  Errors: none of its own.

  Later steps are the same, to the last bit, as if the step had not been tried.

  See also: SamContactTry(), SamContactCommit(), SamContactReset().
*/
PETSC_EXTERN PetscErrorCode SamContactReject(SamContact contact);

/*
  SamContactGetSolution - gets the solution of the tried state if there is one, else of the committed one.

  Collective.

  In:     contact  - the contact
  Out:    solution - the solution; borrowed until the next try, commit or rejection

  Errors: none of its own.

  See also: SamContactGetField(), SamContactGetNumber().
*/
PETSC_EXTERN PetscErrorCode SamContactGetSolution(SamContact contact, const SamSolution **solution);

/*
  SamContactGetField - copies a field of the results from the tried state if there is one, else from the committed one.

  Collective.

  In:     contact - the contact
          name    - its name in the results: `pressure`, `slip_x`, `gap` ...
  Out:    field   - the field (unit of the field in the results), one component

  Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for an unknown name; PETSC_ERR_ARG_SIZ for a vector of another size.

  See also: SamGridCreateVec(), SamContactGetNumber(), SamContactGetSolution().
*/
PETSC_EXTERN PetscErrorCode SamContactGetField(SamContact contact, const char name[], Vec field);

/*
  SamContactGetNumber - gets a number of /history of the tried state if there is one, else of the committed one.

  Not collective.

  In:     contact - the contact
          name    - its name in /history: `load_n`, `contact_area` ...; or the usual name of a number that the motion
                    names otherwise, as `slip_max` in steady rolling
  Out:    value   - the number (unit of the column of /history); NaN if the step has none

  Errors: PETSC_ERR_ARG_UNKNOWN_TYPE for an unknown name.

  See also: SamContactGetField(), SamContactGetSolution().
*/
PETSC_EXTERN PetscErrorCode SamContactGetNumber(SamContact contact, const char name[], PetscReal *value);

/*
  SamContactReset - resets the contact to that of bodies that have never touched.

  Collective.

  In:     contact - the contact

  Errors: none of its own.

  See also: SamContactReject().
*/
PETSC_EXTERN PetscErrorCode SamContactReset(SamContact contact);

#endif
