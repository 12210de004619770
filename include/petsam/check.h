/* A load step, the independent check of its solution, and the verdict on it. */
#ifndef PETSAM_CHECK_H
#define PETSAM_CHECK_H

#include <petsam/solution.h>

/*
  SamCheck - the errors of a solution by an independent check, which takes from the solvers only the tractions and the
  rigid displacements, and recomputes the elastic displacements. All errors are relative, and zero for the
  exact solution of the discrete problem.
    normal       error of p >= 0, g >= 0, p g = 0: the largest of |g| where p > 0, of -g where p = 0, and of -p u/p_max,
                 over the largest displacement u. Of cells with a least pressure (a law's, at the edge) only -g counts
                 there; of cells at the limit of the pressure, which may overlap before they yield, only g; and what p
                 exceeds the limit by, relative to it
    tangential   error of the law of friction: |q - D(q - ds/c)| over the larger of |q| and |D(q - ds/c)|, in the
                 2-norm. D projects each cell's shear onto its disc |q| <= mu p, ds is the slip of the step, c the
                 self-influence of a cell. One number for stick, direction of slip, and the limit mu p
    equilibrium  largest error of a given load over the sum of |traction| dA; a moment's also over half the grid's
                 larger width plus the distance of its centre from the origin
    cone         largest |q| - mu p over the largest mu p
    edge         largest pressure in the outermost cells over the largest pressure; 0 where the grid has no edge
    rounding     the part of `normal` that rounding may be where the displacement is nearly zero, as under a nearly
                 uniform pressure on periodic bodies (SamGapRounding()); else 0
*/
typedef struct {
  PetscReal normal, tangential, equilibrium, cone, edge, rounding;
} SamCheck;

/*
  SamCheckSolution - checks a solution. Input: its control, rigid displacements, pressure and shear; `before`, the
  solution of the previous step (NULL: no slip so far); `state`, what the laws remember (NULL: nothing): of the
  committed state for the separation, of the tried one for corrections. Output: the errors, and the solution's elastic
  displacements, for which it must have the vectors. `coupling`: pressure and shear of dissimilar bodies are coupled.
  `u_z_known`: displacement_z is already right and used as it is. Collective.
*/
PETSC_EXTERN PetscErrorCode SamCheckSolution(SamProblem problem, SamState state, PetscBool coupling,
                                             PetscBool u_z_known, const SamSolution *before, SamSolution *solution,
                                             SamCheck *check);

/* SamStatus - the outcome of a load step, with the numbers that the results store and the program exits with. */
typedef enum {
  SAM_STATUS_CONVERGED      = 0,
  SAM_STATUS_NOT_CONVERGED  = 10, /* a solver, or the coupling, stopped without converging, or the check disagrees */
  SAM_STATUS_NO_EQUILIBRIUM = 11, /* gross slip under force control, or loads that no pressure balances */
  SAM_STATUS_EDGE_CONTACT   = 12  /* the contact reached the edge of the grid */
} SamStatus;

/*
  SamStep - a load step. Without a solution (NO_EQUILIBRIUM), what was not given is NaN. SamContactGetNumber()
  returns all other numbers of a step by name.
*/
typedef struct {
  SamControl control;               /* as given */
  PetscReal  load[SAM_COMPONENTS];  /* N, N m: given or found */
  PetscReal  rigid[SAM_COMPONENTS]; /* m, rad: given or found */
  SamCheck   check;
  SamStatus  status;
  char       message[512]; /* why the status is not CONVERGED, or a warning; else empty */
  char       setting[32];  /* option (without dash) of the setting behind the message, grid_size ...; empty: none */
} SamStep;

/* SamStepIsSolved - whether a step has a solution from which the next one can continue. Not collective. */
static inline PetscBool SamStepIsSolved(const SamStep *step)
{
  return (PetscBool)(step->status != SAM_STATUS_NOT_CONVERGED && step->status != SAM_STATUS_NO_EQUILIBRIUM);
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
PETSC_INTERN PetscErrorCode SamStepJudge(SamStep *step, const SamCheckLimits *limits);
/* SamCheckDescribeEdge - what the pressure at the edge is, for messages; returns the text. Not collective. */
PETSC_INTERN const char *SamCheckDescribeEdge(const SamCheck *check, char text[], size_t size);
/* SamStepFail - sets status and message unless the step has failed already: later failures follow from the first. */
PETSC_INTERN PetscErrorCode SamStepFail(SamStep *step, SamStatus status, const char message[]);

#endif
