/*
  petsam inside another program: a contact between two bodies, that takes loads or displacements and returns the rest.

  This header needs no other. Link with libpetsam (pkg-config petsam). examples/embed has programs in C and Fortran and
  a page on how a dynamics code uses it; scripts/petsam has the same for Python.

  The six components stand in this order wherever they are in a row or a matrix, loads and their conjugates:
      0 N (N)      1 Tx (N)     2 Ty (N)     3 Mx (N m)    4 My (N m)    5 Mz (N m)
      0 d_z (m)    1 d_x (m)    2 d_y (m)    3 r_x (rad)   4 r_y (rad)   5 r_z (rad)
  Body 1, the upper one, moves, body 2 is fixed; loads act on body 1, so that the contact's forces on it are their
  opposites. Moments and rotations are about x = y = 0, right-handed about x, y and the normal that points up, from body
  2 to body 1; N presses down, and d_z is the approach. With pressure p and shear q on body 2,
      N  = sum p dA      Mx = -sum y p dA      My = sum x p dA
      Tx = sum q_x dA    Ty =  sum q_y dA      Mz = sum (x q_y - y q_x) dA
  Displacements are relative to infinity: they contain the compliance of both half-spaces. All units are SI.

  Functions return 0, or what was wrong, as the program petsam ends with:
      2   a wrong argument or option     3   a file that cannot be used
      10  a step did not converge        11  no equilibrium: gross slip, or a moment that no pressure balances
      12  contact reached the edge of the grid (the step has a solution nevertheless)
      others  of PETSc
  petsam_message() then says it in words. No function prints, ends the process, or leaves a contact in a state that
  cannot be used: after an error it is as before, or as after petsam_reject().

  MPI and PETSc are started by the first petsam_create() if nobody has, and are then ended when the process ends. A
  program that uses PETSc itself starts it before.
  Threads: only one thread at a time may be in a function of this header.
  Ranks: a contact belongs to a communicator. All functions but petsam_message() are collective over it, with the same
  arguments on all ranks (else they return 2); results are the same on all of them. Contacts on different communicators
  do not wait for each other. Fields are spread by rows: each rank has those that petsam_grid() tells, as an array of
  (rows, nx).
*/
#ifndef PETSAM_EMBED_H
#define PETSAM_EMBED_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct petsam_contact petsam_contact;

/*
  petsam_create - a contact of bodies that have never touched. `comm`: MPI_Comm_c2f() of a communicator, or -1 for this
  process alone. `options`: those of the program petsam for the grid, the bodies, friction, the gap, wear and the
  solvers, as on the command line; loads are given to petsam_try(). -gap_type flat, for one, may stand for a gap that
  petsam_set_field() gives. Bulk stresses are constant. *c is NULL after an error.
*/
int petsam_create(int comm, const char *options, petsam_contact **c);
/*
  petsam_grid - the numbers of cells, the widths and the centre (m) in x and y, and this rank's rows, which may be 0.
  The centre of cell (i, j) is at x = center[0] - size[0]/2 + (i + 1/2) size[0]/n[0], and so for y. NULL for what is not
  wanted.
*/
int petsam_grid(petsam_contact *c, int n[2], double size[2], double center[2], int *first_row, int *rows);
/*
  petsam_set_field - "gap": the separation of the undeformed, unworn bodies, m; "friction": the coefficient, >= 0. This
  rank's rows. Slip belongs to a place and is kept; the pressure is solved again in the next step. Forgets a tried step.
*/
int petsam_set_field(petsam_contact *c, const char *name, const double *values);
/*
  petsam_try - solves a step from the committed state. It prescribes one value for each of the names, with commas
  between them, as the columns of a history: "load_n,disp_x,bulk2_stress_xx,friction_scale". As many values are read as
  there are commas, and one more; an empty name is refused, and one with a blank. load_n or disp_z is one of them; other
  components that are not named are loads of 0. Conditions hold for this step; those that are not named have the values
  of the contact's options. `time` (s) is only noted. `load` and `rigid` become all twelve, given or found; NaN where
  there is none (NULL: not wanted). A try replaces an earlier one. After 0, 10 and 12 there is a tried step, whose
  fields and numbers can be asked for; 10 cannot be committed. A step takes the new normal load first, and then the
  tangential ones. With roll and roll_y the contact rolls by these distances towards +x and +y (m): the grid moves over
  the bodies, and a creepage times the distance is the motion of body 1. With -rolling steady each try is a steady state
  of rolling.
*/
int petsam_try(petsam_contact *c, double time, const char *names, const double values[], double load[6],
               double rigid[6]);
/*
  petsam_step_name - the k-th name that petsam_try() knows, with its unit (NULL: not wanted): six loads, six
  displacements, six creepages, "" where there is none, and then the conditions; NULL: there are no more. It lives as
  long as the contact. Not collective.
*/
const char *petsam_step_name(petsam_contact *c, int k, const char **unit);
/*
  petsam_history - solves the steps of a history and commits each: `values` (rows, columns), and `columns` their names
  with commas between them, as in the first line of the program's file: "time,load_n,load_tx". The first row's change
  begins from the committed loads and displacements, or from none; -steps divides each row's change. Options -output,
  -checkpoint and the like write files as the program does; with -restart a contact without a committed step goes on
  from that file, in the same history. Ends early where a step has no solution, did not converge or is at the edge of
  the grid, with that code; the step is then tried and not committed.
  petsam_live - so many cycles of wear; the rows are one closed cycle. Options -wear_rtol and the like count.
  The monitor is called after each step (`cycle` 0) and after each computed cycle (1), whose numbers are
  "wear/depth_max1" and so on; it may ask for fields and numbers, and ends the run where it returns anything but 0; what
  would change the contact, or free it, is refused.
  NULL: none.
*/
typedef int (*petsam_monitor)(void *context, petsam_contact *c, int cycle);
int petsam_history(petsam_contact *c, const char *columns, int rows, const double *values, petsam_monitor monitor,
                   void *context);
int petsam_live(petsam_contact *c, double cycles, const char *columns, int rows, const double *values,
                petsam_monitor monitor, void *context);
/*
  petsam_advise - the number of warnings of the tried step, or of the last run: of what is right for the grid, but may
  not be what was meant, as a slip zone that is narrow beside the cells. They are those of the program after a history
  of the committed steps and this one, without those of wear, which petsam_commit() has. Takes some time, which nobody
  spends who does not call it.
  petsam_warning - the k-th of them, a line of text that names the option that mends it; NULL after the last one. It
  lives until the next step is tried. Not collective.
*/
int         petsam_advise(petsam_contact *c, int *count);
const char *petsam_warning(const petsam_contact *c, int k);
/*
  petsam_commit - makes the tried step the state from which the next one continues; its wear, if any, is removed. If the
  step wears more than the limit of a step, petsam_message() has a warning.
  petsam_reject - forgets a tried step, if there is one: later steps are, to the last bit, as if it had not been tried.
*/
int petsam_commit(petsam_contact *c);
int petsam_reject(petsam_contact *c);
/*
  petsam_stiffness - d(loads)/d(displacements) of the tried step, k[6 i + j] of load i and displacement j. `reversal` 0:
  cells that slip go on slipping; the derivative of petsam_try() at fixed committed state, not symmetric. 1: at the
  instant at which the motion reverses: all cells in contact stick; symmetric; without a tried step that of the
  committed one. NaN for components that do not exist.
  10: the step or the linear systems did not converge.
*/
int petsam_stiffness(petsam_contact *c, int reversal, double k[36]);
/*
  petsam_get_field - a field of the tried step, else of the committed one, by its name in a results file
  (examples/manual/RESULTS.md): "pressure", "shear_x", "slip_x", "state", "gap" (of the deformed bodies), "wear_depth1"
  ... Each rank receives its own rows.
  petsam_get_number - a number of the last step that was tried, or after petsam_reject() of the committed one, by its
  name in /history: "contact_area", "dissipated_energy", "stored_energy", "status", "load_n" ...; with "wear/" before
  it one of the cycle that petsam_live() computed last, by its name in /wear.
*/
int petsam_get_field(petsam_contact *c, const char *name, double *values);
int petsam_get_number(petsam_contact *c, const char *name, double *value);
/*
  petsam_field_name, petsam_number_name - the name of the k-th field and number that can be asked for, k = 0, 1, ...;
  NULL after the last one. It lives as long as the contact.
*/
const char *petsam_field_name(petsam_contact *c, int k);
const char *petsam_number_name(petsam_contact *c, int k);
/*
  petsam_stress - evaluates the stresses in a body under the tried step, else the committed one. `options`: those of the
  program petsam-stress (examples/stresses), "-body 2 -depths 0:1e-4:20 -section y=0 -quantities stress,mises".
  shape[4]: numbers of times, z, y and x of the results; of maps each rank has its rows, of a section all have all.
  petsam_record - 1: each step that is committed from now on is recorded, 40 bytes a cell; also those of
  petsam_history(), and of petsam_live() those of the last computed cycle. 0: no more. Both forget earlier ones.
  petsam_fatigue - evaluates fatigue parameters over the recorded steps, taken as one closed cycle, "-fatigue findley
  -fatigue_findley_k 0.3", and the same options; without -quantities none of these. A warning of petsam_message() then
  says that the cycle is not closed: the last step has not the tractions of the state in which recording began.
  petsam_get_stress - a result of the last of these calls by its name in the program's file: "time", "z", "y", "x" are
  the coordinates (s, m); "stress_xx" ..., "mises" ... (Pa) have the whole shape, in this order; fatigue parameters,
  "findley", "findley_normal_x" ..., have no times. To the last bit those of petsam-stress on the same steps.
  petsam_stress_name - the k-th name that petsam_get_stress() knows, NULL: there are no more; and the number of its
  dimensions, 1, 3 or 4 (NULL: not wanted). Not collective.
*/
int         petsam_stress(petsam_contact *c, const char *options, int shape[4]);
int         petsam_record(petsam_contact *c, int on);
int         petsam_fatigue(petsam_contact *c, const char *options, int shape[4]);
int         petsam_get_stress(petsam_contact *c, const char *name, double *values);
const char *petsam_stress_name(const petsam_contact *c, int k, int *dimensions);
/*
  petsam_save - writes the committed state to a file, safely: an older file of the name becomes name.1.
  petsam_load - gives a contact of the same options, and with the same gap and friction if these have been given, the
  state in a file, to the last bit, on any number of ranks. Sums that only the file has are left out.
  Forgets a tried step. Of the step's numbers only loads, displacements and time are known then.
*/
int petsam_save(petsam_contact *c, const char *file);
int petsam_load(petsam_contact *c, const char *file);
/*
  petsam_copy - gives a contact the committed state of another one of the same options, gap and friction.
  petsam_reset - bodies that have never touched, of the same options, gap and friction.
  Both forget a tried step.
*/
int petsam_copy(petsam_contact *c, petsam_contact *from);
int petsam_reset(petsam_contact *c);
/*
  petsam_message - describes the error of the last call, or a warning; it is empty if there is neither. NULL requests
  the message of petsam_create().
*/
const char *petsam_message(const petsam_contact *c);
/* petsam_destroy - frees a contact and sets the handle to NULL. */
void petsam_destroy(petsam_contact **c);

#ifdef __cplusplus
}
#endif

#endif
