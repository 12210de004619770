/* The inside of SamContact. */
#ifndef PETSAM_CONTACTIMPL_H
#define PETSAM_CONTACTIMPL_H

#include <petsam/private/balanceimpl.h>
#include <petsam/contact.h>

/* A solution, and what else later steps depend on. */
typedef struct {
  SamSolution      solution;
  SamSolution      plain;                        /* where its shear is corrected: that of the plain problem */
  PetscObjectState gap_revision;                 /* of the gap that the pressure was solved with; -1: another gap */
  PetscInt         window_first[2], window_n[2]; /* part of the grid that the solvers worked on: cells; n = 0: all */
} SamContactMark;

struct _n_SamContact {
  /* what the user set */
  char            prefix[SAM_PREFIX];
  PetscBool       coupling, warm, allow_edge;
  SamContactEdges edges;
  PetscInt        edge_passes;
  PetscReal       coupling_rtol;
  PetscInt        coupling_max_it;
  PetscBool       coupling_monitor, print_check;
  PetscBool       spots; /* counted in each step */
  /* its parts */
  SamProblem          problem;
  SamElasticity       elasticity; /* of the problem; borrowed */
  SamGrid             grid;       /* of the problem; borrowed */
  SamElasticityTraits traits;
  SamNormal           normal;
  SamTangential       tangential;
  SamProfile          profile;       /* of the pressure along its edge; NULL until needed */
  SamShearProfile     shear_profile; /* likewise */
  /* its states */
  PetscInt       steps;                  /* number of committed steps */
  SamContactMark committed;              /* after the last of them */
  SamSolution    before;                 /* one step back: tractions only */
  Vec            sums[SAM_CONTACT_SUMS]; /* over the committed steps; NULL: not kept */
  SamContactMark tried;
  PetscBool      has_tried;
};

/* ---- states (state.c) ---- */

/* SamSolutionCreate - the fields of a solution, all zero, without the displacements. Collective. */
PETSC_INTERN PetscErrorCode SamSolutionCreate(SamGrid grid, SamSolution *solution);
/*
  SamSolutionCreateDisplacements - adds the displacements, zero, unless the solution has them. Called as late as
  possible: in the first step they then use the memory that the solvers have freed. Collective.
*/
PETSC_INTERN PetscErrorCode SamSolutionCreateDisplacements(SamGrid grid, SamSolution *solution);
/* SamSolutionCreateCorrection - adds the fields of the correction for the edge, unless it has them. Collective. */
PETSC_INTERN PetscErrorCode SamSolutionCreateCorrection(SamGrid grid, SamSolution *solution);
/* SamSolutionCopyCorrection - copies the fields of a correction, where there is one, and the number of passes. */
PETSC_INTERN PetscErrorCode SamSolutionCopyCorrection(SamGrid grid, const SamSolution *from, SamSolution *to);
/*
  SamShearCorrectionCreate - the fields of a correction of the shear, all zero; it says that there is none. Copy -
  copies what there is. Collective.
*/
PETSC_INTERN PetscErrorCode SamShearCorrectionCreate(SamGrid grid, SamShearCorrection *correction);
PETSC_INTERN PetscErrorCode SamShearCorrectionDestroy(SamShearCorrection *correction);
PETSC_INTERN PetscErrorCode SamShearCorrectionCopy(SamGrid grid, const SamShearCorrection *from,
                                                   SamShearCorrection *to);
/* SamSolutionFindSlips - 1 in cells that slip, else 0 (one component). Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionFindSlips(const SamSolution *solution, Vec slips);
PETSC_INTERN PetscErrorCode SamSolutionDestroy(SamSolution *solution);
/* SamSolutionAddPlastic - adds the plastic depth of a solution (NULL: none) to a separation. Collective. */
PETSC_INTERN PetscErrorCode SamSolutionAddPlastic(const SamSolution *solution, Vec separation);
/* SamContactIsGapCurrent - whether the committed pressure was solved with the problem's gap of now. Collective. */
PETSC_INTERN PetscErrorCode SamContactIsGapCurrent(SamContact contact, PetscBool *current);

/* Copies a balance's loads and rigid displacements into arrays of all six components. */
PETSC_INTERN void SamBalanceStore(const SamBalance *balance, PetscReal load[], PetscReal rigid[]);
/* Whether two controls prescribe the same for the components of one kind. */
PETSC_INTERN PetscBool SamControlIsSame(const SamControl *a, const SamControl *b, SamBalanceKind kind);

/*
  SamStretch - the strains of body 2's surface by its bulk stress minus those of body 1's. They move a point at (x, y)
  by (xx x + xy y, xy x + yy y).
*/
typedef struct {
  PetscReal xx, yy, xy;
} SamStretch;
PETSC_INTERN SamStretch SamStretchOf(const SamPair *pair, const SamControl *control);

/*
  SamMotion - what is subtracted from a solution's elastic displacements to give its gap and its slip: the rigid
  displacement minus the stretch. Along a row of cells it is a + b xi (m), xi being the frame's dimensionless x.
*/
typedef struct {
  SamFrame   normal, tangential; /* frames with all rigid displacements given */
  SamStretch stretch;
} SamMotion;
typedef struct {
  double a, b;
} SamMotionRow;
PETSC_INTERN PetscErrorCode SamMotionSet(SamMotion *motion, SamProblem problem, const SamSolution *solution);
PETSC_INTERN SamMotionRow   SamMotionOfGap(const SamMotion *motion, PetscInt j);
PETSC_INTERN SamMotionRow   SamMotionOfSlip(const SamMotion *motion, PetscInt component, PetscInt j);
/* value = u - a - b xi along a row of the grid. */
PETSC_INTERN void SamMotionSubtract(const SamMotion *motion, SamMotionRow row, const double u[], double value[]);
/* value = u + h - a - b xi. */
PETSC_INTERN void SamMotionGap(const SamMotion *motion, SamMotionRow row, const double u[], const double h[],
                               double value[]);
/* The separation h + w of row j, w being the plastic depth (NULL: none); in `row` where it has to be computed. */
static inline const double *SamSeparationOfRow(SamGrid grid, const double h[], const double w[], PetscInt j,
                                               double row[])
{
  const ptrdiff_t k = (ptrdiff_t)j * grid->nx;

  if (!w) return h + k;
  for (PetscInt i = 0; i < grid->nx; i++) row[i] = h[k + i] + w[k + i];
  return row;
}
/* SamSolutionComputeGap - the gap (m) of this rank's cells. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeGap(SamProblem problem, const SamSolution *solution, Vec gap);
/* SamSolutionComputeSlip - a component of the slip (m) of this rank's cells. Not collective. */
PETSC_INTERN PetscErrorCode SamSolutionComputeSlip(SamProblem problem, const SamSolution *solution, PetscInt component,
                                                   double slip[]);

/*
  SamIncrement - the slip of a step: the slip of a solution minus that of the previous one (NULL: no slip so far).
  ComputeRow writes the slip (m) of the step along x and y of this rank's row j to row[0] and row[1], and that since the
  start to slip[0] and slip[1]. Creation and destruction are collective.
*/
typedef struct {
  SamGrid       grid;
  SamMotion     now, before;
  Vec           v_now, v_before;
  const double *u_now, *u_before; /* elastic displacements; u_before NULL: no slip so far */
  double       *slip[2], *row[2], *scratch;
} SamIncrement;
PETSC_INTERN PetscErrorCode SamIncrementCreate(SamProblem problem, const SamSolution *before, const SamSolution *now,
                                               SamIncrement *increment);
PETSC_INTERN PetscErrorCode SamIncrementDestroy(SamIncrement *increment);
PETSC_INTERN void           SamIncrementComputeRow(const SamIncrement *increment, PetscInt j);

/* SamContactGetProfile - the profile of the pressure, made at the first call; borrowed. Collective. */
PETSC_INTERN PetscErrorCode SamContactGetProfile(SamContact contact, SamProfile *profile);
/* SamContactGetShearProfile - likewise of the shear. Collective. */
PETSC_INTERN PetscErrorCode SamContactGetShearProfile(SamContact contact, SamShearProfile *profile);
/*
  The committed step's solution that the tried one goes on from, NULL before the first one. Not collective.
  SamContactPlainBefore - the plain solution, from which another plain one goes on.
  SamContactBefore - that which the tried solution, as it is, has gone on from.
*/
PETSC_INTERN const SamSolution *SamContactPlainBefore(SamContact contact);
PETSC_INTERN const SamSolution *SamContactBefore(SamContact contact);

/* ---- a step ---- */

/* Whether pressure and shear depend on each other. */
static inline PetscBool SamContactIsCoupled(SamContact c)
{
  return c->traits.coupled && c->coupling;
}

/* The guess from which a step is solved. */
typedef struct {
  PetscBool pressure, shear; /* whether the tried solution holds a guess of the pressure; of the shear */
  double    rigid[3];        /* guess of the tangential rigid displacements (m, m, rad) */
} SamStepStart;

/* SamContactPredict - makes the guess for a step, where the steps before allow one (predict.c). Collective. */
PETSC_INTERN PetscErrorCode SamContactPredict(SamContact contact, const SamControl *control, SamStepStart *start);
/*
  SamFollowPressure - scales a shear by the change of the pressure from `pressure_before`, cell by cell: cells that slip
  go on slipping.
*/
PETSC_INTERN PetscErrorCode SamFollowPressure(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear);

/*
  SamContactSolveStep - solves the normal and the tangential problem of the tried step, in turn when they are coupled.
  Failures are reported in the step's status (step.c). `same_pressure`: the pressure is that of the committed state and
  not solved again. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactSolveStep(SamContact contact, const SamStepStart *start, PetscBool same_pressure,
                                                SamStep *step);
/* SamContactAddSums - adds the tried step to the sums that are kept (sums.c). Collective. */
PETSC_INTERN PetscErrorCode SamContactAddSums(SamContact contact);
/* SamContactSetSums - takes over sums (NULL: none); those that are kept and not given begin at 0. Collective. */
PETSC_INTERN PetscErrorCode SamContactSetSums(SamContact contact, const Vec sums[SAM_CONTACT_SUMS]);
/* SamContactComputeFriction(), which adds to the fields with `add`. Collective. */
PETSC_INTERN PetscErrorCode SamContactAddFriction(SamContact contact, PetscBool add, Vec path, Vec pressed, Vec work);

/*
  Of the tried step (spots.c): the number of spots, which are zones of cells in contact that are connected by their
  sides; the mean gap over all cells of the grid, m. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactCountSpots(SamContact contact, PetscReal *spots);
PETSC_INTERN PetscErrorCode SamContactMeanGap(SamContact contact, PetscReal *mean);
/* SamContactComputeScalars - the numbers of the tried step that follow from its solution (scalars.c). Collective. */
PETSC_INTERN PetscErrorCode SamContactComputeScalars(SamContact contact, SamStep *step);
/*
  SamContactAddEnergyWithin - adds to a corrected step's elastic energy what cells vary within (within.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamContactAddEnergyWithin(SamContact contact, SamStep *step);
/*
  SamContactYield - the plastic depth of the tried solution, whose displacements are known, and the step's numbers of it
  (plastic.c). `same_pressure`: the pressure is the committed one, so nothing yields. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactYield(SamContact contact, PetscBool same_pressure, SamStep *step);
/* SamStepFail - sets status and message unless the step has failed already: later failures follow from the first. */
PETSC_INTERN PetscErrorCode SamStepFail(SamStep *step, SamStatus status, const char message[]);

#endif
