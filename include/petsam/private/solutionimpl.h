/* What follows from the solution of a step: gap, slip, what friction does, areas, energies, edges. */
#ifndef PETSAM_SOLUTIONIMPL_H
#define PETSAM_SOLUTIONIMPL_H

#include <petsam/edges.h>
#include <petsam/private/balanceimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/problemimpl.h>
#include <petsam/solution.h>

/* SamValues - this rank's values of a solution's fields, between SamValuesGet() and SamValuesRestore(). */
typedef struct {
  PetscInt      cells;
  const double *p, *b, *q, *u_z, *u_t; /* pressure, bound, shear, displacements; NULL where there is no field */
} SamValues;
PETSC_INTERN PetscErrorCode SamValuesGet(const SamSolution *solution, SamValues *values);
PETSC_INTERN PetscErrorCode SamValuesRestore(const SamSolution *solution, SamValues *values);

/*
  SamRigid - what is subtracted from a solution's elastic displacements to give its gap and its slip: the rigid
  displacement minus that of the strain. Along a row of cells it is a + b xi (m), xi being the frame's dimensionless x.
  The rows of other ranks' cells have a j beyond this rank's.
*/
typedef struct {
  SamFrame  normal, tangential; /* frames with all rigid displacements given */
  SamStrain strain;
} SamRigid;
typedef struct {
  double a, b;
} SamRigidRow;
PETSC_INTERN PetscErrorCode SamRigidSet(SamRigid *motion, SamProblem problem, const SamSolution *solution);
PETSC_INTERN SamRigidRow    SamRigidOfGap(const SamRigid *motion, PetscInt j);
PETSC_INTERN SamRigidRow    SamRigidOfSlip(const SamRigid *motion, PetscInt component, PetscInt j);
static inline double        SamRigidRowAt(SamRigidRow row, double xi)
{
  return row.a + row.b * xi;
}
/* value = u + h - a - b xi along a row of the grid. */
PETSC_INTERN void SamRigidGap(const SamRigid *motion, SamRigidRow row, const double u[], const double h[],
                              double value[]);
/*
  SamSolutionCreateSeparation - the separation (m) of the bodies: the gap of the problem and what its laws put between
  them, for the next step or in the last solution of a state (lawimpl.h; NULL: nothing). Borrowed from the problem
  where no law adds to it, else made, which SamSolutionDestroySeparation() frees. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionCreateSeparation(SamProblem problem, SamState state, SamGeneration generation,
                                                        Vec *separation);
PETSC_INTERN PetscErrorCode SamSolutionDestroySeparation(SamProblem problem, Vec *separation);
/* SamSolutionComputeGap - the gap (m) of this rank's cells. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeGap(SamProblem problem, const SamSolution *solution, Vec separation,
                                                  Vec gap);
/* SamSolutionComputeSlip - a component of the slip (m) of this rank's cells. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeSlip(SamProblem problem, const SamSolution *solution, PetscInt component,
                                                   double slip[]);

/*
  SamIncrement - the slip of a step: the slip of a solution minus that of the previous one (NULL: no slip so far).
  ComputeRow writes the slip (m) of the step along x and y of this rank's row j to row[0] and row[1], and that since the
  start to slip[0] and slip[1]; where contact is made, the slip of the step begins there. Creation and destruction are
  collective.

  SamIncrementTurnRow - after ComputeRow, and only where there is a solution before: turns the slip of row j by the
  angle from the mean direction of the shear in the step to that at its end, into `to`. Not collective.
  SamIncrementOpposeRow - after ComputeRow: takes from the slip of row j what the shear at the end of the step does not
  oppose. Then the law of friction holds with that shear. Not collective.
*/
typedef struct {
  SamGrid            grid;
  SamRigid           now, before;
  Vec                v_now, v_before;
  const double      *u_now, *u_before; /* elastic displacements; u_before NULL: no slip so far */
  double            *slip[2], *row[2], *scratch;
  const SamSolution *solutions[2];      /* before and after the step; the former NULL: no slip so far */
  SamValues          at_before, at_now; /* their values */
  const double      *aside;             /* of the solution after the step; NULL: zero */
  PetscBool          follows_slip;      /* the bound does */
} SamIncrement;
PETSC_INTERN PetscErrorCode SamIncrementCreate(SamProblem problem, const SamSolution *before, const SamSolution *now,
                                               SamIncrement *increment);
PETSC_INTERN PetscErrorCode SamIncrementDestroy(SamIncrement *increment);
PETSC_INTERN void           SamIncrementComputeRow(const SamIncrement *increment, PetscInt j);
PETSC_INTERN void           SamIncrementTurnRow(const SamIncrement *increment, PetscInt j, double *const to[2]);
PETSC_INTERN void           SamIncrementOpposeRow(const SamIncrement *increment, PetscInt j);

/*
  SamSlide - how a cell slid in a step: not at all; all the time; from some time on; since contact was made; until it
  was left; in the first step.
  SamIncrementGetSlide - how this rank's cell k slid, and, if it did, the shares of the bounds (or pressures) before and
  after the step in the one that its slip worked against. Not collective.
*/
typedef enum {
  SAM_SLIDE_NONE,
  SAM_SLIDE_ALWAYS,
  SAM_SLIDE_BEGINS,
  SAM_SLIDE_ENTERS,
  SAM_SLIDE_LEAVES,
  SAM_SLIDE_FIRST
} SamSlide;
PETSC_INTERN SamSlide SamIncrementGetSlide(const SamIncrement *increment, ptrdiff_t k, double share[2]);
/* SamIncrementMix - the mean of a field's values before and after the step by these shares. Not collective. */
static inline double SamIncrementMix(const double share[2], const double before[], const double now[], ptrdiff_t k)
{
  return (share[0] > 0 ? share[0] * before[k] : 0) + (share[1] > 0 ? share[1] * now[k] : 0);
}

/* SamSolutionComputeStates - the state of each cell, a SamCellState as a real number. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeStates(const SamSolution *solution, Vec states);
/*
  SamSolutionComputeFriction - what friction does in a step (SamLawStepGetFriction()); `before` NULL: the first step.
  NULL for a field that is not wanted. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionComputeFriction(SamProblem problem, const SamSolution *before,
                                                       const SamSolution *now, Vec path, Vec pressed, Vec work);
/*
  SamSolutionComputeRolling - of steps of 1 m of rolled distance, with the centred slip of a cell: the frictional
  power per area over the rolling speed (Pa); `wears`: instead the integral along x of pressure times slip (Pa m), the
  same in all cells of a row. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionComputeRolling(SamProblem problem, const SamSolution *solution, PetscBool wears,
                                                      Vec field);

/*
  SamSolutionDeclareNumbers - the numbers of /history that SamSolutionComputeNumbers() fills in the tried generation:
  cells and areas, by their counted cells or (`edges`) reconstructed edges, largest tractions and slip, energies, by
  their names in the motion. With `same_pressure` that of the step
  before, whose edge of contact it keeps. Collective.
  SamSolutionDeclareClosed - what the closed form of the dissipated energy remembers. SamSolutionFollowClosed - the
  energy (J) of the tried step by it, after that of all steps before; NAN: there is none (closed.c). Collective.
  SAM_CONTACT_EDGE - the number in the state that has the contact's edge: whether it is known, 0 or 1, and the faces of
  cells there to cells outside.
*/
#define SAM_CONTACT_EDGE "contact_edge_sums"
enum { SAM_CONTACT_EDGE_KNOWN, SAM_CONTACT_EDGE_FACES = 2 };
/* SamContactEdgeLength - the length (m, in plane strain a number) of an edge that has these faces of cells. */
static inline double SamContactEdgeLength(SamGrid grid, double faces)
{
  return SamGridIsRow(grid) ? faces : PETSC_PI / 4 * faces * sqrt((double)(grid->dx * grid->dy));
}
/*
  SamSolutionGetNormal - the normal load of a solution (N): the prescribed one if there is, so that a constant load does
  not seem to grow by rounding. Not collective.
*/
static inline PetscReal SamSolutionGetNormal(const SamSolution *s)
{
  return s->control.force[SAM_COMPONENT_N] ? s->control.value[SAM_COMPONENT_N] : s->load[SAM_COMPONENT_N];
}
/*
  SAM_ENTERING - the number in the state that has what slip of dissimilar bodies would work more (J) if the cells in
  which contact is made had touched before the step: 0 of others.
*/
#define SAM_ENTERING "entering_work"
PETSC_INTERN PetscErrorCode SamSolutionDeclareNumbers(SamState state, SamMotion motion);
PETSC_INTERN PetscErrorCode SamSolutionDeclareClosed(SamState state);
PETSC_INTERN PetscErrorCode SamSolutionFollowClosed(SamProblem problem, SamState state, const SamSolution *before,
                                                    const SamSolution *now, PetscReal stick_cells, PetscReal *energy);
PETSC_INTERN PetscErrorCode SamSolutionComputeNumbers(SamProblem problem, SamState state, const SamSolution *before,
                                                      const SamSolution *now, PetscBool same_pressure, PetscBool edges);
/*
  SamSolutionFindSlip - the largest slip (m) in contact, in the tried generation of a state; at the edge between cells,
  too (slip.c). With a film it stays as it is. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionFindSlip(SamProblem problem, SamState state, const SamSolution *now,
                                                double *most);
/*
  SamSolutionFindShear - raises the largest shear (Pa) of cells to that at the edge of stick, between cells (peak.c);
  `stick`: what is reconstructed of that edge. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionFindShear(SamProblem problem, const SamSolution *solution, const SamEdge *stick,
                                                 double *most);
/* SamSolutionDeclareSpots, SamSolutionComputeSpots - likewise the number of contact spots, and the mean gap. */
PETSC_INTERN PetscErrorCode SamSolutionDeclareSpots(SamState state);
PETSC_INTERN PetscErrorCode SamSolutionComputeSpots(SamProblem problem, SamState state, const SamSolution *now);

/*
  SamSolutionFindEdge - the reconstructed edge, with its points. `point` (NULL: not wanted), of one component: the
  square of what vanishes at the edge (Pa2), at the cells' centres: of the pressure, or, for the stick zone, of what it
  exceeds |q|/mu by. Collective.
  SamSolutionComputePressureCenter, SamSolutionComputeShearCenter - the tractions (Pa) at the cells' centres, by these
  edges, whose means over cells the solution has. Where an edge is not smooth the means stay. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionFindEdge(SamProblem problem, const SamSolution *solution, SamEdgeOf which,
                                                Vec point, SamEdge *edge);
PETSC_INTERN PetscErrorCode SamSolutionComputePressureCenter(SamProblem problem, const SamSolution *solution,
                                                             Vec pressure);
PETSC_INTERN PetscErrorCode SamSolutionComputeShearCenter(SamProblem problem, const SamSolution *solution,
                                                          PetscInt component, Vec shear);

/* Copies a balance's loads and rigid displacements into arrays of all six components. */
PETSC_INTERN void SamBalanceStore(const SamBalance *balance, PetscReal load[], PetscReal rigid[]);

/*
  SamControlIsSame - whether two controls prescribe the same for the components of one kind, to the bit.
  SamControlSnap - takes the values of these components over from `to`, if they are the same but for rounding: loads
  that differ by 1e-13 of the largest load, moments over the lever (m), and likewise motions.
*/
PETSC_INTERN PetscBool SamControlIsSame(const SamControl *a, const SamControl *b, SamBalanceKind kind);
PETSC_INTERN void      SamControlSnap(const SamControl *to, PetscReal lever, SamBalanceKind kind, SamControl *control);

#endif
