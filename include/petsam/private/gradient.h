/* Derivatives of a number of a load history by all of its parameters. */
#ifndef PETSAM_PRIVATE_GRADIENT_H
#define PETSAM_PRIVATE_GRADIENT_H

#include <petsam/contact.h>
#include <petsam/gap.h>
#include <petsam/private/life.h>
#include <petsam/private/objective.h>

/* Largest tolerance of its systems: at 0.1, derivatives of a fretting loop are wrong by 10 % */
#define SAM_GRADIENT_LOOSEST 0.01

/*
  SamGradient - the recorded steps of a contact, and the derivatives of a number of them by all parameters, in one pass
  back over the steps. The sets of cells in contact, stick and slip are frozen: their borders do not move to first
  order. Where a cell is about to change its set, the derivative holds to one side only; such cells are counted.
  The method stands in src/post/gradient/gradient.c.

  See also: SamGradientCreate(), SamGradientRecord(), SamGradientCompute().
*/
typedef struct _n_SamGradient *SamGradient;

/*
  SamGradientCreate - creates a gradient of a contact, without any step.

  Collective.

  In:     contact  - the contact; it must exist as long as the gradient
          shape    - the shape of its gap, whose parameters have derivatives; likewise
  Out:    gradient - the gradient

  Errors: SAM_ERR_USER for a law, a motion, bodies or settings of the contact whose derivative is not computed.

  See also: SamGradientRecord(), SamGradientDestroy().
*/
PETSC_INTERN PetscErrorCode SamGradientCreate(SamContact contact, SamGap shape, SamGradient *gradient);

/*
  SamGradientSetMemory - limits the memory of recorded steps, bytes on all ranks; 0: it has no limit. Steps beyond it
  wait in files, without change of the results. Not collective, but to be called on all ranks.
*/
PETSC_INTERN void SamGradientSetMemory(SamGradient gradient, PetscReal bytes);

/*
  SamGradientDestroy - frees the gradient and sets the handle to NULL.

  Collective.

  In,out: gradient - the gradient; NULL on return

  Errors: none of its own.
*/
PETSC_INTERN PetscErrorCode SamGradientDestroy(SamGradient *gradient);

/*
  SamGradientRecord - records the tried step of the contact, which is to be committed next; a step that was recorded in
  its place is replaced.

  Collective.

  In:     gradient - the gradient
          row      - the row of the history, from 0; -1: one after that of the last step
          place    - in a wear simulation; else SAM_LIFE_CLOSING

  Errors: PETSC_ERR_ORDER without a tried step, or if an earlier one was not recorded; SAM_ERR_USER if the friction has
  changed since the first step.

  See also: SamGradientCompute().
*/
PETSC_INTERN PetscErrorCode SamGradientRecord(SamGradient gradient, PetscInt row, SamLifePlace place);

/*
  SamGradientBeginLife - begins the record of a wear simulation: its history has so many rows, the last `cycle` of
  which are the cycle. Derivatives by what has a value of each step are by the rows then, and numbers those of the last
  cycle.
  SamGradientRecordJump - records a part of a jump. Collective. Errors: SAM_ERR_USER for jumps whose length is not
  fixed, and surfaces that slide.
*/
PETSC_INTERN PetscErrorCode SamGradientBeginLife(SamGradient gradient, PetscInt rows, PetscInt cycle,
                                                 const SamLifeSettings *settings);
PETSC_INTERN PetscErrorCode SamGradientRecordJump(SamGradient gradient, const SamLifePart *part);

/*
  SamGradientForget - forgets all recorded steps, for a contact that begins anew.

  Not collective, but to be called on all ranks.

  In:     gradient - the gradient

  Errors: none; it returns no error code.

  See also: SamGradientRecord(), SamContactReset().
*/
PETSC_INTERN void SamGradientForget(SamGradient gradient);

/*
  SamGradientGetSteps - returns the number of recorded steps.

  Not collective.

  In:     gradient - the gradient

  Errors: none; it returns no error code.
*/
PETSC_INTERN PetscInt SamGradientGetSteps(SamGradient gradient);

/*
  SamGradientGoal - a number that has a gradient, as SamGradientFind() has found it by its name.
*/
typedef struct {
  const char         *name; /* with what follows an @; borrowed */
  const SamObjective *objective;
  PetscInt            component; /* of a load or displacement; -1: it is none */
  PetscBool           load;      /* true: it is a load */
} SamGradientGoal;

/*
  SamGradientFind - finds a number by its name: energy (J), wear_volume (m3), pressure_norm (Pa), a load (N, N m) or a
  displacement (m, rad), a smooth maximum like stress_xx@50um@1, or another objective that SamObjectiveRegister() has
  added. Not collective. Errors: SAM_ERR_USER for another name, with what is expected.
*/
PETSC_INTERN PetscErrorCode SamGradientFind(MPI_Comm comm, const char name[], SamGradientGoal *goal);

/*
  SamGradientCompute - computes a number of the recorded steps and its derivatives.

  Collective.

  In:     gradient - the gradient
          goal     - the number; a load or a displacement must not be given in these steps
          steps    - the first and the last step, from 0; -1, -1: all of an energy, else the last one
          of       - names of the wanted parameters, separated by commas: gap, friction, those of steps like load_tx,
                     wear_coefficient, wear_energy, body1_young and other moduli, at some more products a step, and
                     those of the shape like gap_radius1; empty: all but moduli and shape, and those by
                     wear if the bodies wear
          rtol     - relative residual of the systems (1)

  Errors: SAM_ERR_USER for unknown names, steps that are not there, a load that is given, loads that the contact cannot
  change, as it slides as a whole, or a shape that the gap has not; PETSC_ERR_NOT_CONVERGED.

  See also: SamGradientGetField(), SamGradientGetNumber().
*/
PETSC_INTERN PetscErrorCode SamGradientCompute(SamGradient gradient, const SamGradientGoal *goal,
                                               const PetscInt steps[2], const char of[], PetscReal rtol);

/*
  SamGradientGetField - copies a field of derivatives.

  Collective.

  In:     gradient - the gradient
          name     - gap (1/m) or friction, times the unit of the number: by the value in each cell
  Out:    field    - the field, one component (unit of the number over that of the parameter)

  Errors: SAM_ERR_USER for another name; PETSC_ERR_ORDER before SamGradientCompute().

  See also: SamGradientCompute(), SamGradientGetNumber().
*/
PETSC_INTERN PetscErrorCode SamGradientGetField(SamGradient gradient, const char name[], Vec field);

/*
  SamGradientOfSteps - returns the name of the k-th parameter that has a value of each step; NULL after the last one.
  `unit`: that of its values; NULL: not wanted.
  SamGradientIsOfSteps - returns true if that name is one of these.
  SamGradientNumber - returns the name of the k-th parameter with one number, likewise.
  SamGradientHas - returns true if the derivative by a parameter was wanted when a gradient was computed last. None is
  collective.
*/
PETSC_INTERN const char *SamGradientOfSteps(PetscInt k, const char **unit);
PETSC_INTERN PetscBool   SamGradientIsOfSteps(const char name[]);
PETSC_INTERN const char *SamGradientNumber(SamGradient gradient, PetscInt k);
PETSC_INTERN PetscBool   SamGradientHas(SamGradient gradient, const char name[]);

/*
  SamGradientGetNumber - gets the number, a derivative by a number, or what is known of both.

  Not collective.

  In:     gradient - the gradient
          name     - value; by a prescribed load, displacement or bulk stress of a step: its name; by another parameter
                     likewise, wear_coefficient and wear_energy being those of both bodies together; borders: the
                     number of cells on the border of their set; residual: the largest of the systems
          step     - the step, of loads, displacements and bulk stresses
  Out:    value    - the value (unit of the number over that of the parameter); NaN for a load that is not given

  Errors: SAM_ERR_USER for another name; PETSC_ERR_ORDER before SamGradientCompute(); PETSC_ERR_ARG_OUTOFRANGE for
  another step.

  See also: SamGradientCompute(), SamGradientGetField().
*/
PETSC_INTERN PetscErrorCode SamGradientGetNumber(SamGradient gradient, const char name[], PetscInt step,
                                                 PetscReal *value);

/*
  SamGradientCheck - checks that a number has a gradient for this contact by wanted parameters (above), and is not given
  itself in a step whose loads `force` are. Not collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamGradientCheck(SamGradient gradient, const SamGradientGoal *goal, const PetscBool force[],
                                             const char of[]);
/*
  SamGradientShare - a parameter by which the derivative was wanted, with that times the value of the parameter, in the
  unit of the number: values of all cells, or of all steps, change together. `error`: that of the share, in the same
  unit; NaN: unknown.
  SamGradientGetShares - gets the shares of all wanted parameters with one number or a value of each step, and of
  friction, and their number. Collective. Errors: PETSC_ERR_ORDER before SamGradientCompute().
  SamGradientDescribe - writes the number, and the relative changes of it by relative changes of the parameters, the
  largest first: "energy 2.04e-05 J; by 1 % more friction -1.2 +- 0.1 %, load_tx +3.1 %". Not collective.
  SamGradientUnit - returns the unit of the number that was computed last. Not collective.
*/
#define SAM_GRADIENT_SHARES 64
typedef struct {
  const char *name; /* borrowed */
  double      share, error;
} SamGradientShare;
PETSC_INTERN PetscErrorCode SamGradientGetShares(SamGradient gradient, SamGradientShare shares[SAM_GRADIENT_SHARES],
                                                 PetscInt *count);
PETSC_INTERN PetscErrorCode SamGradientDescribe(SamGradient gradient, PetscInt count, const SamGradientShare shares[],
                                                char text[], size_t size);
PETSC_INTERN const char    *SamGradientUnit(SamGradient gradient);

#endif
