/* Functions of balance, besides petsam/balance.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_BALANCE_H
#define PETSAM_PRIVATE_BALANCE_H

#include <petsam/balance.h>

/* SamComponentsOf - the components (SamComponent) of each kind of balance, in its order. */
PETSC_INTERN const PetscInt SamComponentsOf[2][3];

/*
  SamControlGetBalance - returns the components of one kind of a control as a balance for the solvers. Not collective.
*/
PETSC_INTERN SamBalance SamControlGetBalance(const SamControl *control, SamBalanceKind kind);

/*
  SamBalanceGetLoads - computes the three loads that a field of traction (1 or 2 components, Pa) carries. Collective.
*/
PETSC_INTERN PetscErrorCode SamBalanceGetLoads(SamGrid grid, SamBalanceKind kind, Vec traction, PetscReal loads[3]);

/*
  SamBalanceLever - sets `possible` to true if a pressure on this grid can balance a normal load under force control:
  the lever arms (My/N, -Mx/N) must lie within the range of the cell centres. Otherwise it is false, also for moments
  without N, and `message` (of length `size`) names the load and the limit. True when N is displacement-controlled. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamBalanceLever(SamGrid grid, const SamBalance *balance, char message[], size_t size,
                                            PetscBool *possible);

/*
  SamBalanceCapacity - sets `possible` to true if pressures of at most `limit` (Pa) on this grid can carry the normal
  load under force control and, with it, each of the moments separately. Otherwise `message` (of length `size`) names
  the load and the limit. Not collective.
*/
PETSC_INTERN PetscErrorCode SamBalanceCapacity(SamGrid grid, const SamBalance *balance, PetscReal limit, char message[],
                                               size_t size, PetscBool *possible);

/*
  SamBalanceSlideLimit - computes the factor by which the force-controlled tangential loads can be multiplied until the
  whole contact slides, given the bound b = mu p (Pa) of the shear: the minimum of sum b |v| dA over rigid velocities v
  of power 1 (the kinematic limit theorem). Infinite without a load. If `shear` (Pa, two components) is not NULL, it
  becomes the shear of sliding, which carries `factor` times the loads. Collective.
*/
PETSC_INTERN PetscErrorCode SamBalanceSlideLimit(SamGrid grid, const SamBalance *balance, Vec bound, PetscReal *factor,
                                                 Vec shear);

#endif
