/* A number with a gradient: the norm of the shear, (sum |q|^8 dA)^(1/8), a smooth maximum, of the last of the steps. */
#include "plugin.h"
#include <petsam/private/objective.h>

#define NORM 8

static PetscErrorCode Add(SamBackStep *at)
{
  const PetscInt cells = at->grid->cells;
  SamTotal       total = {0};
  double         most  = 0, sum;

  if (at->step != at->last) return 0;
  for (PetscInt k = 0; k < cells; k++) most = PetscMax(most, hypot(at->shear[k], at->shear[k + cells]));
  PetscCall(SamMax(at->grid->comm, 1, &most));
  for (PetscInt k = 0; k < cells && most > 0; k++)
    SamAdd(&total, at->area * pow(hypot(at->shear[k], at->shear[k + cells]) / most, NORM));
  PetscCall(SamSumTotals(at->grid->comm, 1, &total, &sum)); /* the same on any number of ranks */
  at->number = most * pow(sum, 1.0 / NORM);
  for (PetscInt k = 0; k < cells && most > 0; k++) {
    const double q = hypot(at->shear[k], at->shear[k + cells]), by = at->area * pow(q / at->number, NORM - 1);

    for (int c = 0; c < 2 && q > 0; c++) at->by_shear[k + c * cells] += by * at->shear[k + c * cells] / q;
  }
  return 0;
}

PetscErrorCode RegisterShearNorm(void)
{
  return SamObjectiveRegister(&(SamObjective){.name = "shear_norm", .unit = "Pa m^(1/4)", .add = Add});
}
