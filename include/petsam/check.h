/* A load step, the independent check of its solution, and the verdict on it. */
#ifndef PETSAM_CHECK_H
#define PETSAM_CHECK_H

#include <petsam/solution.h>

/*
  SamCheck - the errors of a solution by an independent check, which takes only the tractions and the rigid
  displacements from the solvers and recomputes the elastic displacements. All errors are relative, and zero for the
  exact solution of the discrete problem.
    normal       error of p >= 0, g >= 0, p g = 0: the largest of |g| where p > 0, of -g where p = 0, and of -p u/p_max,
                 over the largest displacement u. In cells at their minimum pressure (set by a law, at the edge) only -g
                 counts; in cells at the pressure limit, which may overlap before they yield, only g. The excess of p
                 over the limit, relative to the limit, counts as well
    tangential   error of the friction law: |q - D(q - ds/c)| over the larger of |q| and |D(q - ds/c)|, in the 2-norm. D
                 projects the shear of each cell onto its disc |q| <= mu p, ds is the slip of the step, c the
                 self-influence of a cell. This one number covers stick, the direction of slip, and the limit mu p
    equilibrium  largest error of a given load over the sum of |traction| dA; the error of a moment is also divided by a
                 length, half the larger width of the grid plus the distance of its centre from the origin
    cone         largest excess of |q| over mu p, divided by the largest mu p
    edge         largest pressure in the outermost cells over the largest pressure; 0 if the grid has no edge
    rounding     estimated part of `normal` that is rounding error, if the displacement is nearly zero, as under a
                 nearly uniform pressure on periodic bodies (SamGapRounding()); else 0
*/
typedef struct {
  PetscReal normal, tangential, equilibrium, cone, edge, rounding;
} SamCheck;

/*
  SamCheckSolution - checks a solution: it recomputes the elastic displacements and computes the errors.

  Collective.

  In:     problem   - the problem that is solved
          state     - fields and numbers of the laws (NULL: none): the committed ones give the separation, the tried
                      ones the corrections
          coupling  - true if pressure and shear of dissimilar bodies are coupled
          u_z_known - true if displacement_z is already correct; it is then not recomputed
          before    - the solution of the previous step; NULL: no slip so far
  In,out: solution  - on entry its control, rigid-body displacements, pressure and shear; on return also the elastic
                      displacements, whose vectors must exist
  Out:    check     - the errors, relative

  Errors: none of its own.

  See also: SamContactTry(), SamContactGetSolution().
*/
PETSC_EXTERN PetscErrorCode SamCheckSolution(SamProblem problem, SamState state, PetscBool coupling,
                                             PetscBool u_z_known, const SamSolution *before, SamSolution *solution,
                                             SamCheck *check);

/*
  SamStatus - the outcome of a load step. The values are stored in the results and are the exit codes of the program.
*/
typedef enum {
  SAM_STATUS_CONVERGED      = 0,
  SAM_STATUS_NOT_CONVERGED  = 10, /* a solver or the coupling did not converge, or the check failed */
  SAM_STATUS_NO_EQUILIBRIUM = 11, /* gross slip under force control, or loads that no pressure can balance */
  SAM_STATUS_EDGE_CONTACT   = 12  /* the contact reached the edge of the grid */
} SamStatus;

/*
  SamStep - a load step. Without a solution (NO_EQUILIBRIUM), numbers that were not given are NaN. SamContactGetNumber()
  returns all other numbers of a step by name.
*/
typedef struct {
  SamControl control;               /* as given */
  PetscReal  load[SAM_COMPONENTS];  /* N, N m: given or found */
  PetscReal  rigid[SAM_COMPONENTS]; /* m, rad: given or found */
  SamCheck   check;
  SamStatus  status;
  char       message[512]; /* reason for a status other than CONVERGED, or a warning; else empty */
  char       setting[32];  /* option (without dash) that the message is about, as grid_size; empty: none */
} SamStep;

/*
  SamStepIsSolved - returns true if a step has a solution from which the next one can continue.

  Not collective.

  In:     step - the step

  Errors: none; it returns no error code.
*/
static inline PetscBool SamStepIsSolved(const SamStep *step)
{
  return (PetscBool)(step->status != SAM_STATUS_NOT_CONVERGED && step->status != SAM_STATUS_NO_EQUILIBRIUM);
}

#endif
