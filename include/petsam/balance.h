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

#endif
