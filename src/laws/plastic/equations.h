/* The linear equations of a step of Newton's method for plastic strain. */
#ifndef PETSAM_PLASTIC_EQUATIONS_H
#define PETSAM_PLASTIC_EQUATIONS_H

#include "plasticnewton.h"
#include "reaction.h"

/*
  SamTangent - the tangent P of the material in all cells of all layers: P x = across x + (along - across) (n:x) n, n
  being a field of unit tensors; `active`: number of layers from the surface down to the last one in which P is not 0 on
  any rank.
*/
typedef struct {
  double  *n, *along, *across;
  PetscInt active;
} SamTangent;

/*
  SamEquations - the equations and their operators, on a box of cells that contains all cells with a tangent and the
  contact; they are kept while the box stays the same.

  SamEquationsSolve - computes a step of Newton's method, whose equations are solved to a `part` of their right side.
  The residual r and the step are fields of all layers; outside of the box the step is r. Collective. Errors:
  PETSC_ERR_PLIB if the operators are not symmetric.
*/
typedef struct _n_SamEquations *SamEquations;
PETSC_INTERN PetscErrorCode SamEquationsSolve(SamPlastic *plastic, const SamLawContact *contact, SamReaction reaction,
                                              const SamTangent *tangent, const double r[], double part, double step[]);
PETSC_INTERN PetscErrorCode SamEquationsDestroy(SamEquations *equations);

#endif
