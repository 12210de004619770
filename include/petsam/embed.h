/*
  petsam inside another program: a contact between two bodies, that takes loads or displacements and returns the rest.

  This header needs no other. Link with libpetsam (pkg-config petsam). examples/embed has programs in C and Fortran and
  a page on how a dynamics code uses it; scripts/petsam has the same for Python.

  The six components stand in this order wherever they are in a row or a matrix, loads and their conjugates:
      0 N (N)      1 Tx (N)     2 Ty (N)     3 Mx (N m)    4 My (N m)    5 Mz (N m)
      0 d_z (m)    1 d_x (m)    2 d_y (m)    3 r_x (rad)   4 r_y (rad)   5 r_z (rad)
  Body 1, the upper one, moves, body 2 is fixed; loads act on body 1, so that the contact's forces on it are their
  opposites. x, y and z are right-handed, with z into body 2. Moments and rotations about x = y = 0 turn about x and y
  by the left hand, about z by the right hand; with y reversed, which files of petsam-compliance exclude, all are
  right-handed about x, y and the normal n = -z. N presses along z, and d_z is the approach. With pressure p and shear
  q on body 2,
      N  = sum p dA      Mx = -sum y p dA      My = sum x p dA
      Tx = sum q_x dA    Ty =  sum q_y dA      Mz = sum (x q_y - y q_x) dA
  Displacements are relative to infinity: they contain the compliance of both half-spaces. All units are SI.

  Functions return 0, or an error code, which is the exit code of the program petsam:
      2   a wrong argument or option     3   a file that cannot be used
      10  a step did not converge        11  no equilibrium: gross slip, or a moment that no pressure balances
      12  contact reached the edge of the grid (the step has a solution nevertheless)
      others  of PETSc
  petsam_message() then describes the error. A contact that is NULL or has been destroyed is a wrong argument, which
  petsam_message(NULL) describes. No function prints, ends the process, or leaves a contact in an unusable state: after
  an error the contact is as before, or as after petsam_reject().

  The first petsam_create() starts MPI and PETSc unless they have been started, and they are then finalized when the
  process ends. A program that uses PETSc itself must start it before. Threads: only one thread at a time may be in a
  function of this header. Ranks: a contact belongs to a communicator. A function whose comment says "Collective" is
  collective over it, with the same arguments on all ranks (else it returns 2); results are the same on all of them.
  Contacts on different communicators do not wait for each other. Fields are spread by rows: each rank has those of
  petsam_grid(), as an array of (rows, nx).
*/
#ifndef PETSAM_EMBED_H
#define PETSAM_EMBED_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct petsam_contact petsam_contact;

/*
  petsam_create - creates a contact of bodies that have never touched.

  Collective on `comm`.

  In:     comm    - MPI_Comm_c2f() of a communicator, or -1 for this process alone
          options - those of the program petsam for the grid, the bodies, friction, the gap, wear and the solvers, as on
                    the command line
  Out:    c       - the contact; NULL after an error

  Errors: 2 for a wrong or missing option, a load or displacement among the options, or no communicator; 3 for a file
  that cannot be used.

  Loads are given to petsam_try(). -gap_type flat, for one, may stand for a gap that petsam_set_field() gives. Bulk
  stresses are constant.

  See also: petsam_set_field(), petsam_try(), petsam_destroy().
*/
int petsam_create(int comm, const char *options, petsam_contact **c);

/*
  petsam_grid - gets the grid and this rank's rows.

  Collective.

  In:     c         - the contact
  Out:    n         - numbers of cells in x and y; NULL: not wanted
          size      - full widths in x and y (m); NULL: not wanted
          center    - centre in x and y (m); NULL: not wanted
          first_row - index of this rank's first row; NULL: not wanted
          rows      - number of this rank's rows, which may be 0; NULL: not wanted

  Errors: none of its own.

  The centre of cell (i, j) is at x = center[0] - size[0]/2 + (i + 1/2) size[0]/n[0], and so for y.

  See also: petsam_set_field(), petsam_get_field().
*/
int petsam_grid(petsam_contact *c, int n[2], double size[2], double center[2], int *first_row, int *rows);

/*
  petsam_set_field - sets the gap or the coefficient of friction cell by cell.

  Collective.

  In:     c      - the contact
          name   - "gap": the separation of the undeformed, unworn bodies; "friction": the coefficient
          values - this rank's rows: the gap (m), or the coefficient (1), >= 0

  Errors: 2 for another name, a value that is not finite, or a negative coefficient.

  Slip belongs to a place and is kept; the pressure is solved again in the next step. The function forgets a tried step.

  See also: petsam_grid(), petsam_get_field().
*/
int petsam_set_field(petsam_contact *c, const char *name, const double *values);

/*
  petsam_try - solves a step from the committed state.

  Collective.

  In:     c      - the contact
          time   - the time of the step (s); it is stored, and bodies that relax do so over it
          names  - names of the prescribed values, separated by commas, like the columns of a history:
                   "load_n,disp_x,bulk2_stress_xx,friction_scale"
          values - one value for each name (N, N m, m, rad, or the unit of the condition): as many as there are commas,
                   and one more
  Out:    load   - all six loads, given or found (N, N m); NaN where there is none; NULL: not wanted
          rigid  - all six displacements, given or found (m, rad); NaN where there is none; NULL: not wanted

  Errors: 2 for a name that is unknown, empty, contains a blank or is given twice, without load_n and disp_z, and for a
  value out of its range; 10, 11 and 12 for a step without convergence, without equilibrium, or in contact at the edge
  of the grid.

  One of load_n and disp_z must be named; other components that are not named are loads of 0. Conditions hold for this
  step; those that are not named have the values of the contact's options. petsam_step_name() lists names and units.

  A try replaces an earlier one. After 0, 10 and 12 there is a tried step, whose fields and numbers can be requested;
  after 10 it cannot be committed.

  A step takes the new normal load first, and then the tangential ones. With roll and roll_y the contact rolls by these
  distances towards +x and +y (m): the grid moves over the bodies, and a creepage times the distance is the motion of
  body 1. With -rolling steady each try is a steady state of rolling.

  With the option -errors companion the step is solved on other cells and in two halves, too, and each of its numbers
  NAME has an estimated error, the number NAME_error in the same unit: NaN if unknown. Files of petsam_save() have the
  states of these runs, unless a step is tried at that moment; of a file without them, petsam_load() leaves NaN.

  See also: petsam_step_name(), petsam_commit(), petsam_reject(), petsam_history().
*/
int petsam_try(petsam_contact *c, double time, const char *names, const double values[], double load[6],
               double rigid[6]);

/*
  petsam_step_name - returns the k-th name that petsam_try() accepts; NULL: there are no more.

  Not collective.

  In:     c    - the contact
          k    - index, from 0: six loads, six displacements, six creepages, "" where there is none, and then the
                 conditions
  Out:    unit - unit of the value; NULL: not wanted

  Errors: none; it returns no error code.

  The name lives as long as the contact.

  See also: petsam_try().
*/
const char *petsam_step_name(petsam_contact *c, int k, const char **unit);

/*
  petsam_monitor - a function that petsam_history() and petsam_live() call after each step (`cycle` 0) and after each
  computed cycle (1), whose numbers are "wear/depth_max1" and so on. It may request fields and numbers, and ends the run
  if it returns anything but 0. Functions that would change the contact, or free it, return 2.
*/
typedef int (*petsam_monitor)(void *context, petsam_contact *c, int cycle);

/*
  petsam_history - solves the steps of a history and commits each.

  Collective.

  In:     c       - the contact
          columns - names of the columns, separated by commas, as in the first line of the program's file:
                    "time,load_n,load_tx"
          rows    - number of rows
          values  - the rows, as an array of (rows, columns) (s, N, N m, m, rad, or the unit of the condition)
          monitor - function that is called after each step; NULL: none
          context - passed to the monitor; may be NULL

  Errors: 2 for a wrong column or value, 3 for a file that cannot be used; 10, 11 and 12 if a step ends the history.

  The first row's change begins from the committed loads and displacements, or from none; -steps divides each row's
  change. Options -output, -checkpoint and the like write files as the program does; with -restart a contact without a
  committed step continues from that file, in the same history.

  The history ends early if a step has no solution, did not converge or is at the edge of the grid, with that code; the
  step is then tried and not committed.

  See also: petsam_monitor, petsam_live(), petsam_try().
*/
int petsam_history(petsam_contact *c, const char *columns, int rows, const double *values, petsam_monitor monitor,
                   void *context);

/*
  petsam_live - computes a number of cycles of wear; the rows are one closed cycle.

  Collective.

  In:     c       - the contact
          cycles  - number of cycles (1), > 0
          columns - names of the columns, as in petsam_history()
          rows    - number of rows
          values  - the rows, as an array of (rows, columns) (s, N, N m, m, rad, or the unit of the condition)
          monitor - function that is called after each step and each computed cycle; NULL: none
          context - passed to the monitor; may be NULL

  Errors: 2 for a wrong number of cycles, column or value, 3 for a file that cannot be used; 10, 11 and 12 if a step
  ends the run.

  Options -wear_rtol and the like have effect. Files are written, and the run ends early, as in petsam_history().

  See also: petsam_history(), petsam_monitor.
*/
int petsam_live(petsam_contact *c, double cycles, const char *columns, int rows, const double *values,
                petsam_monitor monitor, void *context);

/*
  petsam_advise - gets the number of warnings of the tried step, or of the last run.

  Collective.

  In:     c     - the contact
  Out:    count - number of warnings

  Errors: 2 if a monitor calls it.

  The warnings concern solutions that are right for the grid but may not be intended, for example a slip zone only a few
  cells wide. They are the warnings of the program after a history of the committed steps and this one, without those
  about wear, which petsam_commit() gives. Computing them takes some time, which is spent in this function only.

  See also: petsam_warning().
*/
int petsam_advise(petsam_contact *c, int *count);

/*
  petsam_warning - returns the k-th warning that petsam_advise() has found; NULL after the last one.

  Not collective.

  In:     c - the contact
          k - index, from 0

  Errors: none; it returns no error code.

  A warning is a line of text that names an option that helps. It exists until the next step is tried.

  See also: petsam_advise().
*/
const char *petsam_warning(const petsam_contact *c, int k);

/*
  petsam_commit - makes the tried step the state from which the next one continues.

  Collective.

  In:     c - the contact

  Errors: 2 without a tried step, or if a monitor calls it; 10 for a step that did not converge.

  The wear of the step, if any, is removed from the bodies. If the step wears more than the limit of a step,
  petsam_message() has a warning.

  See also: petsam_try(), petsam_reject().
*/
int petsam_commit(petsam_contact *c);

/*
  petsam_reject - forgets a tried step, if there is one.

  Collective.

  In:     c - the contact

  Errors: 2 if a monitor calls it.

  Later steps are, to the last bit, as if the step had not been tried.

  See also: petsam_try(), petsam_commit().
*/
int petsam_reject(petsam_contact *c);

/*
  petsam_stiffness - computes d(loads)/d(displacements) of the tried step.

  Collective.

  In:     c        - the contact
          reversal - 0: cells that slip continue to slip; 1: the motion reverses, and all cells in contact stick
  Out:    k        - the matrix (N/m, N/rad, N, N m/rad), k[6 i + j] of load i and displacement j; NaN for components
                     that do not exist

  Errors: 2 without a solved step, or for bodies that have no such stiffness; 10 if the step or the linear systems did
  not converge.

  With 0 it is the derivative of petsam_try() at fixed committed state, and not symmetric. It takes the slip directions
  at the end of the step, as -slip_direction end does; with mid, entries of a slip that turns differ by up to a quarter.
  With 1 it is the stiffness at the time at which the motion reverses, and symmetric; without a tried step it is that of
  the committed one.

  See also: petsam_stiffness_with(), petsam_try().
*/
int petsam_stiffness(petsam_contact *c, int reversal, double k[36]);

/*
  petsam_stiffness_with - computes the same matrix, with rows and columns for load cases of bodies.

  Collective.

  In:     c        - the contact
          reversal - as for petsam_stiffness()
          cases    - names of factors on load cases, separated by commas: "body2_case_pull,body2_case_mode1"
  Out:    k        - the matrix of order n = 6 + the number of cases, k[n i + j] of load i and displacement j: the six
                     components, then the cases (N/m, N/rad, N, N m/rad, J/m, J)

  Errors: those of petsam_stiffness(), and 2 for a name that is no load case.

  The displacement of a case is its factor; its load is the number NAME_load, the work of the contact's tractions by a
  unit of the factor. So the rows of cases have the opposite sign of their columns: with 1 for `reversal` the parts
  between components, and between cases, are symmetric, and k[n i + j] = -k[n j + i] between a component and a case.

  See also: petsam_stiffness(), petsam_step_name().
*/
int petsam_stiffness_with(petsam_contact *c, int reversal, const char *cases, double *k);

/*
  petsam_get_field - copies a field of the tried step, else of the committed one.

  Collective.

  In:     c      - the contact
          name   - its name in a results file (examples/manual/RESULTS.md): "pressure", "shear_x", "slip_x", "state",
                   "gap" (of the deformed bodies), "wear_depth1" ...
  Out:    values - this rank's rows (unit of the field in the results file); each rank receives its own

  Errors: 2 for an unknown name, or without a solved step.

  See also: petsam_field_name(), petsam_grid().
*/
int petsam_get_field(petsam_contact *c, const char *name, double *values);

/*
  petsam_get_number - gets a number of the last step that was tried, or after petsam_reject() of the committed one.

  Collective.

  In:     c     - the contact
          name  - its name in /history: "contact_area", "dissipated_energy", "stored_energy", "status", "load_n" ...;
                  with "wear/" before it a number of the cycle that petsam_live() computed last, by its name in /wear
  Out:    value - the number (unit of the column in the results file)

  Errors: 2 for an unknown name, without a tried step, and for a cycle before petsam_live().

  See also: petsam_number_name().
*/
int petsam_get_number(petsam_contact *c, const char *name, double *value);

/*
  petsam_field_name - returns the name of the k-th field of petsam_get_field(); NULL after the last one.

  Collective.

  In:     c - the contact
          k - index, from 0

  Errors: none; it returns no error code.

  The name lives as long as the contact.

  See also: petsam_get_field().
*/
const char *petsam_field_name(petsam_contact *c, int k);

/*
  petsam_number_name - returns the name of the k-th number of petsam_get_number(); NULL after the last one.

  Collective.

  In:     c - the contact
          k - index, from 0

  Errors: none; it returns no error code.

  The name lives as long as the contact.

  See also: petsam_get_number().
*/
const char *petsam_number_name(petsam_contact *c, int k);

/*
  petsam_stress - evaluates the stresses in a body under the tried step, else the committed one.

  Collective.

  In:     c       - the contact
          options - those of the program petsam-stress (examples/stress): "-body 2 -depths 0:1e-4:20 -section y=0
                    -quantities stress,mises"
  Out:    shape   - numbers of times, z, y and x of the results; of maps each rank has its rows, of a section all ranks
                    have all

  Errors: 2 for a wrong option, or without a solved step; 3 for a file that cannot be used.

  See also: petsam_get_stress(), petsam_stress_name(), petsam_fatigue().
*/
int petsam_stress(petsam_contact *c, const char *options, int shape[4]);

/*
  petsam_record - begins or ends the recording of committed steps; both forget earlier ones.

  Collective.

  In:     c  - the contact
          on - 1: records each step that is committed from now on; 0: ends the recording

  Errors: none of its own.

  The steps of petsam_history(), and of the last computed cycle of petsam_live(), are recorded, too. A step takes 40
  bytes per cell.

  See also: petsam_fatigue(), petsam_commit().
*/
int petsam_record(petsam_contact *c, int on);

/*
  petsam_fatigue - evaluates fatigue parameters over the recorded steps, taken as one closed cycle.

  Collective.

  In:     c       - the contact
          options - those of the program petsam-stress, "-fatigue findley -fatigue_findley_k 0.3"; without -quantities
                    none of these are computed
  Out:    shape   - as for petsam_stress()

  Errors: 2 for a wrong option, or without recorded steps; 3 for a file that cannot be used.

  A warning of petsam_message() reports a cycle that is not closed: the tractions of its last step differ from those of
  the state in which recording began.

  See also: petsam_record(), petsam_get_stress().
*/
int petsam_fatigue(petsam_contact *c, const char *options, int shape[4]);

/*
  petsam_get_stress - copies a result of the last petsam_stress() or petsam_fatigue().

  Collective.

  In:     c      - the contact
          name   - its name in the program's file: "time", "z", "y", "x" are the coordinates; "stress_xx" ..., "mises"
                   ... have the whole shape, in this order; fatigue parameters, "findley", "findley_normal_x" ..., have
                   no times
  Out:    values - the result (s, m, Pa, or the unit in the program's file)

  Errors: 2 for a name of which the last of these calls has no result.

  The results are, to the last bit, those of petsam-stress on the same steps.

  See also: petsam_stress(), petsam_fatigue(), petsam_stress_name().
*/
int petsam_get_stress(petsam_contact *c, const char *name, double *values);

/*
  petsam_stress_name - returns the k-th name of petsam_get_stress(); NULL: there are no more.

  Not collective.

  In:     c          - the contact
          k          - index, from 0
  Out:    dimensions - number of its dimensions: 1, 3 or 4; NULL: not wanted

  Errors: none; it returns no error code.

  See also: petsam_get_stress().
*/
const char *petsam_stress_name(const petsam_contact *c, int k, int *dimensions);

/*
  petsam_gradient_record - begins or ends the recording of committed steps for gradients; both forget earlier ones.

  Collective.

  In:     c  - the contact, without a committed step
          on - 1: records each step that is committed from now on; 0: ends the recording

  Errors: 2 for a contact with steps, or with options whose derivative is not computed.

  Steps of petsam_history() are recorded, too, and those of petsam_live() with jumps of fixed length (-wear_jump), whose
  derivatives are by the rows of its history; petsam_commit() and petsam_history() return 2 for a step that has no
  derivative: where the contact of dissimilar bodies grows that needs -slip_direction end. Slip at mid step is found to
  the tolerance of the shear while steps are recorded, by more solutions of each step. A step takes 60 bytes per cell in
  contact.

  See also: petsam_gradient().
*/
int petsam_gradient_record(petsam_contact *c, int on);

/*
  petsam_gradient - computes the derivatives of a number of the recorded steps by all parameters, in one pass back.

  Collective.

  In:     c      - the contact
          name   - the number: energy (J, the frictional work of the steps), wear_volume (m3, that of both bodies after
                   the last of the steps), pressure_norm (Pa, (sum p^8 dA)^(1/8) in the last of the steps), a load or a
                   displacement that is found, summed over the steps, or a smooth maximum (sum s^40)^(1/40) over
                   the cells at a depth: stress_xx@50um ..., mises@50um (Pa, in the last of the steps), swt@50um,
                   findley@50um@k=0.3 (Pa, of the cycle of the steps), fatemi_socie@50um@k=1@yield=900MPa (1, likewise;
                   constants as in petsam_fatigue()); in body 2, or swt@50um@1 in body 1
          first  - first of the steps that it is of, from 0, in a wear simulation in its last cycle; -1: all steps of an
                   energy or a parameter of fatigue, else the last one
          last   - the last of them; -1: the last step
          of     - parameters, separated by commas: names of petsam_get_gradient(), gap,load_tx,body1_young say, or
                   parameters of the shape, gap_radius1 say; NULL: all but the moduli and the shape, and
                   those by wear if the bodies wear
          rtol   - relative residual of the systems that are solved, such as 1e-4, at most 0.01 (1)
  Out:    steps  - number of recorded steps
          unit   - that of the number, until the next call; NULL: not wanted

  Errors: 2 for unknown names, a load that is given, a contact that slides as a whole under given loads, parameters of
  the shape where the gap was given cell by cell, and without recorded steps; 10 if a system does not converge.

  See also: petsam_gradient_record(), petsam_get_gradient().
*/
int petsam_gradient(petsam_contact *c, const char *name, int first, int last, const char *of, double rtol, int *steps,
                    const char **unit);

/*
  petsam_get_gradient - copies a result of the last petsam_gradient().

  Collective.

  In:     c      - the contact
          name   - its name: value, the number itself; gap and friction, derivatives by the separation (1/m) and the
                   coefficient of friction in each cell, NaN where that is 0; load_n, disp_x, bulk1_stress_xx ..., by
                   the value of each step; body1_young (1/Pa), body1_poisson ..., gap_radius1 (1/m) ..., by what of them
                   was named; wear_coefficient (Pa), wear_energy, by the coefficients of both bodies alike; borders, the
                   number of cells that are about to change their set, where derivatives hold to one side; residual, the
                   largest of the systems
  Out:    values - this rank's rows of a field; of the steps that petsam_gradient() told, NaN where it is not given;
                   else one number (unit of the number over that of the parameter)

  Errors: 2 for another name, or before petsam_gradient().

  See also: petsam_gradient(), petsam_grid().
*/
int petsam_get_gradient(petsam_contact *c, const char *name, double *values);

/*
  petsam_save - writes the committed state to a file, safely: an older file of the name becomes name.1.

  Collective.

  In:     c    - the contact
          file - name of the file

  Errors: 2 without a committed step; 3 for a file that cannot be written.

  See also: petsam_load(), petsam_copy().
*/
int petsam_save(petsam_contact *c, const char *file);

/*
  petsam_load - gives the contact the state in a file, to the last bit, on any number of ranks.

  Collective.

  In:     c    - a contact of the same options, and with the same gap and friction if these have been given
          file - name of the file

  Errors: 2 for the state of another contact, or if a monitor calls it; 3 for a file that cannot be read.

  Sums that only the file has are ignored. The function discards a tried step. Afterwards only the loads, displacements
  and time are known of the step's numbers.

  See also: petsam_save(), petsam_copy().
*/
int petsam_load(petsam_contact *c, const char *file);

/*
  petsam_copy - gives a contact the committed state of another one.

  Collective.

  In:     c    - the contact
          from - another contact with the same options, gap and friction

  Errors: 2 for a contact of other ranks, grid or gap, or if a monitor calls it.

  The function forgets a tried step of `c`.

  See also: petsam_save(), petsam_load().
*/
int petsam_copy(petsam_contact *c, petsam_contact *from);

/*
  petsam_reset - resets the contact to one of bodies that have never touched, with the same options, gap and friction.

  Collective.

  In:     c - the contact

  Errors: 2 if a monitor calls it.

  The function forgets a tried step.

  See also: petsam_reject(), petsam_create().
*/
int petsam_reset(petsam_contact *c);

/*
  petsam_message - returns a description of the error of the last call, or a warning; it is empty if there is neither.

  Not collective.

  In:     c - the contact; NULL: the message of petsam_create(), or of a call without a contact that exists

  Errors: none; it returns no error code.
*/
const char *petsam_message(const petsam_contact *c);

/*
  petsam_destroy - frees a contact and sets the handle to NULL.

  Collective.

  In,out: c - the contact; NULL on return

  Errors: none; it returns no error code. A call by a monitor does nothing.
*/
void petsam_destroy(petsam_contact **c);

#ifdef __cplusplus
}
#endif

#endif
