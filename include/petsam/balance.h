/* Rigid-body components, their loads, and the loads that tractions on a grid can balance. */
#ifndef PETSAM_BALANCE_H
#define PETSAM_BALANCE_H

#include <petsam/control.h>
#include <petsam/grid.h>

/*
  SamBalance - three of the six components, each under force or displacement control:
    normal:     loads N (N), Mx, My (N m)   with d_z (m), r_x, r_y (rad)
                sum p dA = N, sum y p dA = -Mx, sum x p dA = My;   rigid-body displacement d_z - y r_x + x r_y
    tangential: loads Tx, Ty (N), Mz (N m)  with d_x, d_y (m), r_z (rad)
                sum q dA = T, sum (x q_y - y q_x) dA = Mz;   rigid-body displacement (d_x - y r_z, d_y + x r_z)
  Moments and rotations are about x = y = 0. Where `force` is true the load is given and the displacement a result;
  otherwise the displacement is given and the load a result. In steady rolling the rotation displaces a cell as if it
  lay `ahead` (m) farther along x, d_y + (x + ahead) r_z, because its slip is evaluated there
  (elasticity/steadyoperator.c).
*/
typedef enum { SAM_BALANCE_NORMAL, SAM_BALANCE_TANGENTIAL } SamBalanceKind;

typedef struct {
  SamBalanceKind kind;
  PetscBool      force[3];
  PetscReal      load[3];
  PetscReal      rigid[3];
  PetscReal      ahead;
} SamBalance;

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
