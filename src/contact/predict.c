/*
  The tractions of the next step, extrapolated from the last two.

  At the edge of the contact the pressure, and at the edge of the stick zone what the shear lacks of the bound, go to zero
  like the square root of the distance. Edges move: extrapolating p or q cell by cell would be wrong by a part of the order
  of one wherever an edge passes. Their squares are linear in the position of the edge, and where the extrapolated square is
  negative the edge has passed. So p^2 is extrapolated, and for q/(mu p), which moves in the unit disc, the square of the
  distance to the disc's edge in the direction in which it moved in the last step.
*/
#include "contactimpl.h"
#include <math.h>

/* A cell is on its circle from this part of the bound on. */
#define ON_CIRCLE (1 - 1e-7)

/* Goes on from `now` in the unit disc by alpha times the way from `before`. */
static void ExtrapolateRatio(double alpha, const double before[2], double now[2])
{
  const double x = now[0] - before[0], y = now[1] - before[1], way = sqrt(x * x + y * y), n2 = now[0] * now[0] + now[1] * now[1];
  double       along, left, last, square, go;

  if (way == 0 || n2 >= ON_CIRCLE * ON_CIRCLE) return;
  along  = (now[0] * x + now[1] * y) / way;
  left   = sqrt(PetscMax(0, along * along + 1 - n2)) - along;
  last   = left + way;
  square = (1 + alpha) * left * left - alpha * last * last;
  go     = square > 0 ? left - sqrt(square) : left;
  now[0] += go * x / way;
  now[1] += go * y / way;
}

static double ExtrapolatePressure(double alpha, double before, double now)
{
  const double square = (1 + alpha) * now * now - alpha * before * before;

  if (now == before) return now;
  return square > 0 ? sqrt(square) : 0;
}

PetscErrorCode SamExtrapolate(SamGrid grid, PetscReal friction, PetscReal alpha, Vec pressure, Vec shear, Vec pressure_before, Vec shear_before, PetscBool *found)
{
  const PetscInt cells = grid->cells;
  double        *p, *q, *p0, *q0, most = 0;

  PetscFunctionBegin;
  PetscCall(VecGetArray(pressure, &p));
  PetscCall(VecGetArray(shear, &q));
  PetscCall(VecGetArray(pressure_before, &p0));
  PetscCall(VecGetArray(shear_before, &q0));
  for (PetscInt k = 0; k < cells; k++) {
    const PetscInt l      = k + cells;
    const double   now[3] = {p[k], q[k], q[l]}, bound = friction * p[k], bound0 = friction * p0[k];

    p[k] = ExtrapolatePressure(alpha, p0[k], p[k]);
    if (bound > 0 && bound0 > 0) {
      const double before[2] = {q0[k] / bound0, q0[l] / bound0};
      double       ratio[2]  = {q[k] / bound, q[l] / bound};

      ExtrapolateRatio(alpha, before, ratio);
      q[k] = friction * p[k] * ratio[0];
      q[l] = friction * p[k] * ratio[1];
    }
    most  = PetscMax(most, p[k]);
    p0[k] = now[0];
    q0[k] = now[1];
    q0[l] = now[2];
  }
  PetscCall(VecRestoreArray(pressure, &p));
  PetscCall(VecRestoreArray(shear, &q));
  PetscCall(VecRestoreArray(pressure_before, &p0));
  PetscCall(VecRestoreArray(shear_before, &q0));
  PetscCall(SamMax(grid->comm, 1, &most));
  *found = most > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (*found) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCopy(pressure_before, pressure));
  PetscCall(VecCopy(shear_before, shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFollowBound(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear)
{
  const PetscInt cells = grid->cells;
  const double  *p0, *p;
  double        *q;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure_before, &p0));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArray(shear, &q));
  for (PetscInt k = 0; k < cells; k++) {
    const double scale = p0[k] > 0 ? p[k] / p0[k] : 0;

    q[k] *= scale;
    q[k + cells] *= scale;
  }
  PetscCall(VecRestoreArray(shear, &q));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(VecRestoreArrayRead(pressure_before, &p0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
