/* The solution of one load step, for the contact that takes the step. */
#ifndef PETSAM_STEP_H
#define PETSAM_STEP_H

#include <petsam/private/contact.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/stepcache.h>

/* The numbers of the solvers, side by side in the state in this order. */
enum {
  SAM_COUNT_NORMAL,         /* of the normal solver: iterations, applications, preconditions */
  SAM_COUNT_TANGENTIAL = 3, /* the same of the tangential solver */
  SAM_COUNT_COUPLING   = 6,
  SAM_COUNTS           = 7
};

/* SamStepStart - the guess from which a step is solved. */
typedef struct {
  PetscBool     pressure, shear; /* the tried solution holds a guess of the pressure; of the shear */
  double        rigid[3];        /* guess of the tangential rigid displacements (m, m, rad) */
  double        along;           /* part of the step's change along that of the last step, in units of it; >= 0 */
  SamCachedStep kept;            /* the same step one cycle before; NULL: none */
} SamStepStart;

/* SamStepTask - a step to be solved, and the objects that solve it; all are borrowed. */
typedef struct {
  SamProblem                problem;
  SamElasticity             elasticity; /* of the problem */
  SamGrid                   grid;       /* of the problem */
  SamMotion                 motion;
  SamElasticityTraits       traits;
  SamNormal                 normal;
  SamTangential             tangential;
  SamState                  state;
  const SamContactSettings *set;
  SamSolution              *s;                /* the tried solution, with its control and tractions */
  const SamSolution        *committed;        /* solution from which the step continues; NULL in the first step */
  const SamSolution        *before;           /* the same, or NULL if its slip is not continued */
  const SamSolution        *earlier;          /* solution one step before that, if its tractions are known */
  PetscInt                  displacements[2]; /* fields in the state: u_z, u_t */
  PetscInt                  aside;            /* field in the state */
  PetscInt                  counts, rolling;  /* numbers in the state: of the solvers, of rolling.c */
  SamStepOf                 of;               /* inputs for which its pressure is solved */
  PetscBool                 settles;          /* the field `aside` is found to the tolerance of the shear */
  PetscBool                 coupled;          /* pressure and shear depend on each other */
  PetscBool                 same_pressure;    /* the pressure is the committed one and is not solved again */
  SamStepStart              start;
} SamStepTask;

/*
  SamStepSolve - solves the normal and the tangential problem of a step, in turn when they are coupled. Failures are
  reported in the status of `step` (solve.c). `known_pressure`: true if the committed or a kept pressure was used
  instead of a solution. Collective.
*/
PETSC_INTERN PetscErrorCode SamStepSolve(const SamStepTask *task, SamStep *step, PetscBool *known_pressure);
/*
  SamStepSetDisplacements - stores the displacements of the tried solution in these two fields of the state. It is
  called as late as possible: in the first step they then use the memory that the solvers have freed. Collective.
*/
PETSC_INTERN PetscErrorCode SamStepSetDisplacements(SamState state, const PetscInt fields[2], SamSolution *tried);
/*
  SamStepFindTurn - computes the part of a step's slip that the shear at its end does not oppose (m, two components), in
  cells that slide then, if slip is opposite to the shear at mid step (direction.c). `before`: the solution before the
  step. Collective.
*/
PETSC_INTERN PetscErrorCode SamStepFindTurn(SamProblem problem, SamGrid grid, const SamSolution *before,
                                            const SamSolution *now, Vec turn);
/*
  SamStepDeclareRolling - declares the numbers of a motion in which material streams, and returns the first
  (steadystep.c). SamStepDeclareResistance - declares those of bodies with the trait skewed (resistance.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamStepDeclareRolling(SamState state, PetscInt *first);
PETSC_INTERN PetscErrorCode SamStepDeclareResistance(SamElasticity bodies, SamState state);

#endif
