/* The rigid-body components, their loads, and the loads that can be balanced. */
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
  otherwise the other way round. In steady rolling the rotation displaces a cell as if it were by `ahead` (m) farther
  along x, d_y + (x + ahead) r_z, where its slip is (elasticity/steadyoperator.c).
*/
typedef enum { SAM_BALANCE_NORMAL, SAM_BALANCE_TANGENTIAL } SamBalanceKind;

typedef struct {
  SamBalanceKind kind;
  PetscBool      force[3];
  PetscReal      load[3];
  PetscReal      rigid[3];
  PetscReal      ahead;
} SamBalance;

/* The components (SamComponent) of a kind of balance, in its order. */
PETSC_INTERN const PetscInt SamComponentsOf[2][3];
/* SamControlGetBalance - the components of one kind of a control, as the solvers take them. Not collective. */
PETSC_INTERN SamBalance SamControlGetBalance(const SamControl *control, SamBalanceKind kind);

/* SamBalanceGetLoads - the three loads that a field of traction (1 or 2 components, Pa) carries. Collective. */
PETSC_INTERN PetscErrorCode SamBalanceGetLoads(SamGrid grid, SamBalanceKind kind, Vec traction, PetscReal loads[3]);

/*
  SamBalanceLever - whether a pressure on this grid can balance a normal load under force control: the lever arms
  (My/N, -Mx/N) must lie among the cell centres. Otherwise `message` (of that size) names the load and the limit. Also
  false for moments without N. True when N is displacement-controlled.
*/
PETSC_INTERN PetscErrorCode SamBalanceLever(SamGrid grid, const SamBalance *balance, char message[], size_t size,
                                            PetscBool *possible);

/*
  SamBalanceCapacity - whether pressures of at most `limit` (Pa) on this grid can carry the normal load under force
  control, and with it each of the moments for itself. Otherwise `message` (of that size) names the load and the limit.
*/
PETSC_INTERN PetscErrorCode SamBalanceCapacity(SamGrid grid, const SamBalance *balance, PetscReal limit, char message[],
                                               size_t size, PetscBool *possible);

/*
  SamBalanceSlideLimit - the factor by which the force-controlled tangential loads can be multiplied until the whole
  contact slides, given the bound mu p (Pa) of the shear: the least of sum b |v| dA over rigid velocities v of power 1
  (the kinematic limit theorem). Infinite without a load. If not NULL, `shear` (Pa, two components) becomes that of
  sliding, which carries that many times the loads. Collective.
*/
PETSC_INTERN PetscErrorCode SamBalanceSlideLimit(SamGrid grid, const SamBalance *balance, Vec bound, PetscReal *factor,
                                                 Vec shear);

#endif
