/* Quantities derived from the solution of a step: gap, slip, effects of friction, areas, energies, edges. */
#ifndef PETSAM_SOLUTIONIMPL_H
#define PETSAM_SOLUTIONIMPL_H

#include <petsam/private/edges.h>
#include <petsam/private/balanceimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/problemimpl.h>
#include <petsam/solution.h>

/*
  SamRuleTurns - true if the shear may turn in the step. SamRuleEnters - true if slip begins where cells touch.
  SamRuleTouches - true if it counts from the time at which they touch. Not collective.
*/
static inline PetscBool SamRuleTurns(SamSlipRule rule)
{
  return rule >= SAM_RULE_MID ? PETSC_TRUE : PETSC_FALSE;
}
static inline PetscBool SamRuleEnters(SamSlipRule rule)
{
  return rule >= SAM_RULE_LINE ? PETSC_TRUE : PETSC_FALSE;
}
static inline PetscBool SamRuleTouches(SamSlipRule rule)
{
  return rule == SAM_RULE_TOUCHING || rule == SAM_RULE_MID_TOUCHING ? PETSC_TRUE : PETSC_FALSE;
}

/* SamValues - this rank's values of a solution's fields, between SamValuesGet() and SamValuesRestore(). */
typedef struct {
  PetscInt      cells;
  const double *p, *b, *q, *u_z, *u_t; /* pressure, bound, shear, displacements; NULL where there is no field */
} SamValues;
PETSC_INTERN PetscErrorCode SamValuesGet(const SamSolution *solution, SamValues *values);
PETSC_INTERN PetscErrorCode SamValuesRestore(const SamSolution *solution, SamValues *values);

/*
  SamRigid - the displacement that is subtracted from a solution's elastic displacements to give its gap and its slip:
  the rigid displacement minus that of the strain. Along a row of cells it is a + b xi (m), xi being the frame's
  dimensionless x. The index j may lie outside of this rank's rows.
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
/* SamRigidGap - computes value = u + h - a - b xi along a row of the grid. Not collective. */
PETSC_INTERN void SamRigidGap(const SamRigid *motion, SamRigidRow row, const double u[], const double h[],
                              double value[]);
/*
  SamSolutionCreateTotal - gets the pressure of contact less the tension (Pa), which loads the bodies. It is borrowed
  from the solution without tension, else created; SamSolutionDestroyTotal() returns or frees it.
  SamSolutionGiven - gets the loads (N, N m) of a solution without those that contact bears because of the tension, by
  SamComponent: prescribed ones as they were prescribed. SamSolutionTake - does the reverse with the loads of a
  solution.
  SamSolutionTensionError - gets the load of a change of the tension (Pa), relative to that which contact bears, or that
  of the changed tension. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionTensionError(SamProblem problem, const SamSolution *solution, Vec change,
                                                    PetscReal *error);
PETSC_INTERN PetscErrorCode SamSolutionCreateTotal(SamProblem problem, const SamSolution *solution, Vec *total);
PETSC_INTERN PetscErrorCode SamSolutionDestroyTotal(const SamSolution *solution, Vec *total);
PETSC_INTERN PetscErrorCode SamSolutionGiven(SamProblem problem, const SamSolution *solution, PetscReal load[]);
PETSC_INTERN PetscErrorCode SamSolutionTake(SamProblem problem, SamSolution *solution);
/*
  SamSolutionCreateSeparation - gets the separation (m) of the bodies: the gap of the problem plus the parts of its
  laws, for the next step or in the last solution of a state (lawimpl.h; NULL: none). It is borrowed from the problem if
  no law adds to it, else created; SamSolutionDestroySeparation() returns or frees it. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionCreateSeparation(SamProblem problem, SamState state, SamGeneration generation,
                                                        Vec *separation);
PETSC_INTERN PetscErrorCode SamSolutionDestroySeparation(SamProblem problem, Vec *separation);
/*
  SamSolutionComputeGap - computes the gap (m) in this rank's cells; `displacement`: that by the tractions along the
  normal (m), as a rule the solution's; NULL: the bodies are undeformed. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionComputeGap(SamProblem problem, const SamSolution *solution, Vec displacement,
                                                  Vec separation, Vec gap);
/* SamSolutionComputeSlip - computes a component of the slip (m) in this rank's cells. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeSlip(SamProblem problem, const SamSolution *solution, PetscInt component,
                                                   double slip[]);

/*
  SamIncrement - the slip of a step: the slip of a solution minus that of the previous one (NULL: no slip so far).
  ComputeRow writes the slip (m) of the step along x and y in this rank's row j to row[0] and row[1], and the slip since
  the start to slip[0] and slip[1]; in new contact, the slip of the step begins when the cells touch. Creation and
  destruction are collective.

  SamIncrementFindSpan - finds the part of row j that has all contact before and after the step: from column span[0] to
  before span[1], which are the same if there is none. Not collective.
  SamIncrementTurnRow - rotates the slip of row j by the angle from the mean direction of the shear in the step to that
  at its end, and writes it to `to`; to be called after ComputeRow, and only if there is a solution before. Not
  collective.
  SamIncrementMeasure - finds how far all cells slide together, for SamIncrementGetCellMotion(). Collective.
  SamIncrementOpposeRow - subtracts from the slip of row j the part that the shear at the end of the step does not
  oppose (`aside`), so that the friction law holds with that shear; to be called after ComputeRow. Not collective.
*/
typedef struct {
  SamGrid            grid;
  SamRigid           now, before;
  Vec                v_now, v_before;
  const double      *u_now, *u_before; /* elastic displacements; u_before NULL: no slip so far */
  double            *slip[2], *row[2], *scratch;
  const SamSolution *solutions[2];      /* solutions before and after the step; the first NULL: no slip so far */
  SamValues          at_before, at_now; /* values of these solutions */
  const double      *aside;             /* `aside` of the solution after the step; NULL: zero */
  PetscBool          follows_slip;      /* true: the bound depends on the slip */
  double             slides;  /* the shortest slip over the longest: 0: a cell sticks, or it is not measured */
  double             ends[2]; /* the shortest slip by which that is measured, and the longest one, m */
} SamIncrement;
PETSC_INTERN PetscErrorCode SamIncrementCreate(SamProblem problem, const SamSolution *before, const SamSolution *now,
                                               SamIncrement *increment);
PETSC_INTERN PetscErrorCode SamIncrementDestroy(SamIncrement *increment);
PETSC_INTERN PetscErrorCode SamIncrementMeasure(SamIncrement *increment);
PETSC_INTERN void           SamIncrementComputeRow(const SamIncrement *increment, PetscInt j);
PETSC_INTERN void           SamIncrementFindSpan(const SamIncrement *increment, PetscInt j, PetscInt span[2]);
PETSC_INTERN void           SamIncrementTurnRow(const SamIncrement *increment, PetscInt j, double *const to[2]);
PETSC_INTERN void           SamIncrementOpposeRow(const SamIncrement *increment, PetscInt j);

/*
  SamCellMotion - how a cell slides in a step: not at all; during the whole step; from some time on; since contact was
  made; until contact was lost; not before it was being lost; in the first step.
  SamIncrementGetCellMotion - returns the motion of this rank's cell k. If it slid, `share` gets the weights of the
  bounds (or pressures) before and after the step in the effective bound (or pressure), against which the slip did its
  work. Not collective.
*/
typedef enum {
  SAM_CELL_MOTION_NONE,
  SAM_CELL_MOTION_ALWAYS,
  SAM_CELL_MOTION_BEGINS,
  SAM_CELL_MOTION_ENTERS,
  SAM_CELL_MOTION_LEAVES,
  SAM_CELL_MOTION_RELEASED,
  SAM_CELL_MOTION_FIRST
} SamCellMotion;
PETSC_INTERN SamCellMotion SamIncrementGetCellMotion(const SamIncrement *increment, ptrdiff_t k, double share[2]);
/*
  SamIncrementGetShareSlopes - gets the derivatives of share[0] of this rank's cell k, which has that motion, by the
  part of its slip with which it turns round, q0.ds/(b0 |ds|), and by `slides`. Not collective.
  SamIncrementFindEnds - finds, after SamIncrementMeasure(), the cells with the shortest and the longest slip, which
  determine `slides`, as indices on the whole grid, and its derivatives (1/m) by the lengths of both slips; -1 and 0 if
  `slides` is 0 or 1. Changes the row that was computed last. Collective.
*/
PETSC_INTERN void           SamIncrementGetShareSlopes(const SamIncrement *increment, SamCellMotion motion, ptrdiff_t k,
                                                       double slopes[2]);
PETSC_INTERN PetscErrorCode SamIncrementFindEnds(const SamIncrement *increment, PetscInt64 cell[2], double slope[2]);
/*
  SamIncrementMix - returns the mean of a field's values before and after the step with these weights. Not collective.
*/
static inline double SamIncrementMix(const double share[2], const double before[], const double now[], ptrdiff_t k)
{
  return (share[0] > 0 ? share[0] * before[k] : 0) + (share[1] > 0 ? share[1] * now[k] : 0);
}

/*
  SamIncrementGetWork - returns the frictional work (J/m2) of this rank's cell k in the row that was computed last, and
  gets shares and motion of SamIncrementGetCellMotion(). The bound stands for the shear, which it is where a cell slips;
  what is left of the slip of cells that stick does no work. Not collective.
*/
PETSC_INTERN double SamIncrementGetWork(const SamIncrement *increment, ptrdiff_t k, double share[2],
                                        SamCellMotion *motion);

/* SamSolutionComputeStates - computes the state of each cell, a SamCellState as a real number. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeStates(const SamSolution *solution, Vec states);
/*
  SamSolutionComputeFriction - computes the effects of friction in a step (SamLawUse). `before` NULL: the
  first step. A field that is not wanted is NULL. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionComputeFriction(SamProblem problem, const SamSolution *before,
                                                       const SamSolution *now, Vec path, Vec pressed, Vec work);
/*
  SamSolutionComputeRolling - computes, for steps of 1 m of rolled distance and with the centred slip of a cell, the
  frictional power per area over the rolling speed (Pa). `wears`: it computes instead the integral along x of pressure
  times slip (Pa m), the same in all cells of a row. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionComputeRolling(SamProblem problem, const SamSolution *solution,
                                                      PetscBool passage, Vec field);

/*
  SamSolutionDeclareNumbers - declares the numbers of /history, by their names in the motion, that
  SamSolutionComputeNumbers() computes in the tried generation: cells, areas and half widths, by counted cells or
  (`edges`) reconstructed edges, largest tractions and slip, energies. `same_pressure`: the pressure is that of the
  previous step, whose contact edge is kept. Collective.
  SamSolutionDeclareClosed - declares the numbers that the closed form of the dissipated energy stores.
  SamSolutionFollowClosed - computes the dissipated energy (J) of the tried step by this form, which must have followed
  all earlier steps; NAN if the form does not apply (closedenergy.c). Collective.
  SAM_CONTACT_EDGE - the name of the numbers of the contact edge in the state, which include 1 if the edge is known,
  else 0, and the number of faces to cells outside of the contact.
*/
#define SAM_CONTACT_EDGE "contact_edge_sums"
enum { SAM_CONTACT_EDGE_KNOWN, SAM_CONTACT_EDGE_FACES = 2 };
/*
  SamContactEdgeLength - returns the length (m; in plane strain a count) of an edge with this number of faces of cells.
*/
static inline double SamContactEdgeLength(SamGrid grid, double faces)
{
  return SamGridIsRow(grid) ? faces : PETSC_PI / 4 * faces * sqrt((double)(grid->dx * grid->dy));
}
/*
  SamSolutionGetNormal - returns the normal load of a solution (N): the prescribed one if it is prescribed, so that a
  constant load does not seem to grow by rounding. Not collective.
*/
static inline PetscReal SamSolutionGetNormal(const SamSolution *s)
{
  return s->control.force[SAM_COMPONENT_N] ? s->control.value[SAM_COMPONENT_N] : s->load[SAM_COMPONENT_N];
}
/*
  SAM_ENTERING - the name of a number in the state: the extra work of slip (J) of dissimilar bodies if the cells of new
  contact had touched before the step; 0 for other bodies. SAM_TOUCHING: 1 if their slip counts from when they touch.
  SAM_UNBALANCED: the least error (J) of the step's dissipated energy by the work of the loads and what the shear
  stores.
*/
#define SAM_ENTERING   "entering_work"
#define SAM_TOUCHING   "touching"
#define SAM_UNBALANCED "unbalanced_work"
PETSC_INTERN PetscErrorCode SamSolutionDeclareNumbers(SamState state, SamMotion motion);
PETSC_INTERN PetscErrorCode SamSolutionDeclareClosed(SamState state);
PETSC_INTERN PetscErrorCode SamSolutionFollowClosed(SamProblem problem, SamState state, const SamSolution *before,
                                                    const SamSolution *now, PetscReal stick_cells, PetscReal *energy);
PETSC_INTERN PetscErrorCode SamSolutionComputeNumbers(SamProblem problem, SamState state, const SamSolution *before,
                                                      const SamSolution *now, PetscBool same_pressure, PetscBool edges);
/*
  SamSolutionFindSlip - replaces the largest slip (m) at the centres of cells by that in the contact, also at its edge
  between cells (largestslip.c), for the tried generation of a state. With a film, or if it is 0, it is unchanged.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionFindSlip(SamProblem problem, SamState state, const SamSolution *now,
                                                double *most);
/*
  SamSolutionDeclareShear - declares the numbers that the following function stores.
  SamSolutionFindShear - raises the largest shear (Pa) of cells to that at the stick-slip boundary between cells
  (peak.c), also of an earlier step, for the tried generation of a state; `stick`: the reconstruction of this boundary,
  NULL: nothing slips. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionDeclareShear(SamState state);
PETSC_INTERN PetscErrorCode SamSolutionFindShear(SamProblem problem, SamState state, const SamSolution *solution,
                                                 const SamEdge *stick, double *most);
/*
  SamSolutionDeclareSpots, SamSolutionComputeSpots - declare and compute the number of contact spots, and the mean gap.
*/
PETSC_INTERN PetscErrorCode SamSolutionDeclareSpots(SamState state);
PETSC_INTERN PetscErrorCode SamSolutionComputeSpots(SamProblem problem, SamState state, const SamSolution *now);

/*
  SamSolutionFindEdge - reconstructs the contact edge or the stick-slip boundary, by the square (Pa2) of the traction
  that vanishes there: p^2 for the contact, (p - |q|/mu)^2 for the stick zone. The edge is kept with the solution's
  shear until one of its tractions changes; it is borrowed. Collective.
  SamSolutionCountHalf - counts half of the extent of contact or stick along x and y (m) in whole cells. Collective.
  SamSolutionComputePressureCenter, SamSolutionComputeShearCenter - compute the tractions (Pa) at the centres of the
  cells, with these edges, from the means over cells in the solution. If an edge is not smooth the means stay.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionFindEdge(SamProblem problem, const SamSolution *solution, SamEdgeOf which,
                                                const SamEdge **edge);
PETSC_INTERN PetscErrorCode SamSolutionCountHalf(SamProblem problem, const SamSolution *solution, SamEdgeOf which,
                                                 double half[2]);
PETSC_INTERN PetscErrorCode SamSolutionComputePressureCenter(SamProblem problem, const SamSolution *solution,
                                                             Vec pressure);
PETSC_INTERN PetscErrorCode SamSolutionComputeShearCenter(SamProblem problem, const SamSolution *solution,
                                                          PetscInt component, Vec shear);

/*
  SamBalanceStore - copies a balance's loads and rigid displacements into arrays of all six components. Not collective.
*/
PETSC_INTERN void SamBalanceStore(const SamBalance *balance, PetscReal load[], PetscReal rigid[]);

/*
  SamControlIsSame - returns true if two controls prescribe the same, to the last bit, for the components of one kind.
  SamControlSnap - replaces the values of these components in `control` by those in `to` if they differ by rounding
  only: by at most 1e-13 of the largest load, with moments divided by the lever (m), and correspondingly for
  displacements.
*/
PETSC_INTERN PetscBool SamControlIsSame(const SamControl *a, const SamControl *b, SamBalanceKind kind);
PETSC_INTERN void      SamControlSnap(const SamControl *to, PetscReal lever, SamBalanceKind kind, SamControl *control);

#endif
