/* Declarations shared by the files of the advice. */
#ifndef PETSAM_ADVICEIMPL_H
#define PETSAM_ADVICEIMPL_H

#include <petsam/private/advice.h>
#include <petsam/private/baseimpl.h>

#define SAM_ADVICE_CELLS 20 /* a contact with fewer cells across is not resolved, but for closed-form solutions */
/*
  Elastic contacts with a closed-form solution need fewer cells across than others (SAM_ADVICE_CELLS): with at least 14,
  all numbers of 9 random contacts were within 2 % of their limit unless a slip zone was narrow.
*/
#define SAM_ADVICE_FEW_CLOSED 14
#define SAM_ADVICE_BORDER     4 /* margin in cells of a sufficient grid; a narrower contact is none */
#define SAM_ADVICE_SAME       2 /* cells by which two widths, one counted and one computed, may differ */
/* characters of texts: of the advised grids, and of numbers in messages */
enum { SAM_ADVICE_GRIDS = 192, SAM_ADVICE_TEXT = 64 };
/* Share of the edges of contact that are reconstructed, from which on they are known to a fraction of a cell */
#define SAM_ADVICE_KNOWN  0.9
#define SAM_ADVICE_STRAY  0.1  /* part of the cells, in the narrowest zones, that is ignored in their width */
#define SAM_ADVICE_NARROW 0.25 /* cells: the width below which that of a zone or ring of slip is unknown */
/* Half-space theory is taken to hold up to this ratio of the contact's half width to a radius of curvature, */
#define SAM_ADVICE_STEEPEST 0.1
/* From this ratio on, no larger grid is advised, and bodies that yield are rejected; */
#define SAM_ADVICE_LARGEST 0.3
/* linear elasticity is taken to hold up to this pressure over E*. */
#define SAM_ADVICE_HARDEST 0.2
/*
  SamAdviceSay - passes on advice, with a format of printf(); `setting`: see SamAdviceFunction.
  SamAdviceGridsFor - writes grids that resolve a contact of these half widths along the axes to refine: one as large as
  now with `factor` times more cells, and a smaller one with as many cells; empty: none.
  SamAdviceWritePair - writes two numbers as an option takes them: one for both if they are the same.
  SamAdviceWriteGrid - writes a grid of these widths, with cells as now.
  SamAdviceIsStrip - true if a single spot ends along one axis only; `ends`: the axes along which the contact ends.
  None is collective (say.c).
*/
PETSC_INTERN void SamAdviceSay(SamAdvice *advice, const char setting[], const char format[], ...)
  PETSC_ATTRIBUTE_FORMAT(3, 4);
PETSC_INTERN void      SamAdviceGridsFor(const SamSetup *setup, const PetscReal half[2], double factor,
                                         const PetscBool refine[2], char cells[SAM_ADVICE_TEXT],
                                         char width[SAM_ADVICE_TEXT]);
PETSC_INTERN void      SamAdviceWriteGrid(const SamSetup *setup, const double width[2], char text[], size_t size);
PETSC_INTERN void      SamAdviceWritePair(const char option[], const double x[2], char text[SAM_ADVICE_TEXT]);
PETSC_INTERN PetscBool SamAdviceIsStrip(const SamAdvice *advice, PetscBool ends[2]);
/*
  SamAdviceEstimate - computes the half widths (m) of the contact under a load (N) or, without `force`, at an approach
  (m), by a closed-form solution; infinite along an axis along which surfaces are flat. `known`: there is a solution, of
  finite size. Collective.
  SamAdviceMeasureZones - measures the zones of contact, but not the peak. Collective.
  SamAdviceGetWidths - finds the half widths and cells across: by the closed-form solution if it describes the contact
  of this step, which is not so after wear, for example; otherwise from the extent. Collective.
  SamAdviceFewest - returns the fewest cells across that resolve the contact.
  SamAdviceWidth - returns the width in cells of the spots with half of the contact, or of a narrower contact in closed
  form (width.c).
  SamAdviceCompare - compares half widths with the radius, and gets their ratio; the text names the unit, and the limit
  beyond it. Empty, and 0: there is no radius. Not collective (advice.c).
*/
PETSC_INTERN PetscErrorCode SamAdviceMeasureZones(const SamSetup *setup, SamExtent *extent);
PETSC_INTERN PetscErrorCode SamAdviceGetWidths(SamAdvice *advice);
PETSC_INTERN int            SamAdviceFewest(const SamAdvice *advice);
PETSC_INTERN double         SamAdviceWidth(const SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceEstimate(const SamSetup *setup, PetscBool force, PetscReal value,
                                              PetscReal half[2], PetscBool *known);
PETSC_INTERN PetscErrorCode SamAdviceCompare(const SamSetup *setup, const PetscReal half[2], char text[], size_t size,
                                             PetscReal *ratio);
/*
  AddSlip, AddRolling - add a step to the estimates of the dissipated energy (slipzones.c), and of loads and creepages
  in steady rolling (steadyerrors.c). MeasureStick - finds the present cells across the stick zone. Collective. Slip,
  Rolling - estimate, after the last step, errors of numbers that the cells do not resolve. Stick - those of a stick
  zone fewer cells across than `least`. Peaks - those of maximum values in a slip zone of this width in cells;
  `wanted`: how many times finer cells resolve it. Not collective.
*/
/*
  SamAdviceMeasureStuck - estimates the slip zone of a contact in which all cells stick (stuck.c): `share` is the ratio
  of the shear's change in this step at the contact's edge to mu p, `stuck` contains the zone's values at share 1.
  Collective.
*/
#define SAM_STUCK_WIDTH (2. / 3) /* cells: width of the zone at share 1 */
typedef struct {
  double work, shear; /* J: energy at share 1 (grows as share^3); Pa: shear at its end (as the root) */
} SamStuck;
PETSC_INTERN PetscErrorCode SamAdviceMeasureStuck(const SamSetup *setup, double *share, SamStuck *stuck);
/*
  SamAdviceAddRing - adds a step to the ring of slip of dissimilar bodies. Collective. SamAdviceRing - advises, after
  the last step, on an energy above `least` (J) that cells or steps do not resolve, and on the area of stick. Not
  collective (slipring.c).
*/
typedef struct {
  PetscBool touches;     /* slip counts from when cells touch */
  double    energy;      /* J */
  double    edge, width; /* cells: length of the contact's edge, and mean width of the slip zone */
  double    sticks;      /* part of the contact that sticks */
} SamRingStep;
PETSC_INTERN PetscErrorCode SamAdviceAddRing(SamAdvice *advice, const SamRingStep *now);
PETSC_INTERN void           SamAdviceRing(SamAdvice *advice, double least);
PETSC_INTERN PetscErrorCode SamAdviceAddSlip(SamAdvice *advice, const SamStep *step);
PETSC_INTERN PetscErrorCode SamAdviceMeasureStick(SamAdvice *advice);
/* True if a cycle of a life dissipates next to nothing of what the first one did (slipzones.c). */
PETSC_INTERN PetscBool      SamAdviceIsSpent(const SamAdvice *advice);
PETSC_INTERN void           SamAdvicePeaks(SamAdvice *advice, double width, double wanted, const char names[]);
PETSC_INTERN void           SamAdviceStick(SamAdvice *advice, PetscReal least);
PETSC_INTERN void           SamAdviceSlip(SamAdvice *advice);
PETSC_INTERN PetscErrorCode SamAdviceAddRolling(SamAdvice *advice, PetscInt k, const SamStep *step);
PETSC_INTERN void           SamAdviceRolling(SamAdvice *advice);
/*
  SamAdviceUnloaded - advises on the area of a row of few cells after the largest load (wholecells.c).
  SamAdviceCountsCells - true if areas are those of whole cells in a row: the edges of bodies that may yield differ from
  those of elastic bodies, and are not reconstructed. Both are collective.
*/
PETSC_INTERN void      SamAdviceUnloaded(SamAdvice *advice);
PETSC_INTERN PetscBool SamAdviceCountsCells(SamAdvice *advice);
/* SamAdviceMeshes - advises on numbers by the error of a body's compliance by its mesh (meshes.c). Collective. */
PETSC_INTERN void SamAdviceMeshes(SamAdvice *advice);
/*
  Advice before the first step (expected.c): YieldingSize of a contact of bodies that yield; Idle: values that act on
  nothing; Lengths in another unit than the grid's. Collective.
*/
PETSC_INTERN void SamAdviceYieldingSize(SamAdvice *advice);
PETSC_INTERN void SamAdviceIdle(SamAdvice *advice);
PETSC_INTERN void SamAdviceLengths(SamAdvice *advice);
/*
  Advice on what is prescribed (prescribed.c): Friction in percent; Units of stresses and of the grid; Motion that is
  not small; Datum: displacements that need one; Stroke: moves of a worn body 2 without -slide. Not collective.
*/
PETSC_INTERN void SamAdviceFriction(SamAdvice *advice);
PETSC_INTERN void SamAdviceUnits(SamAdvice *advice);
PETSC_INTERN void SamAdviceMotion(SamAdvice *advice);
PETSC_INTERN void SamAdviceDatum(SamAdvice *advice);
PETSC_INTERN void SamAdviceStroke(SamAdvice *advice);

#endif
