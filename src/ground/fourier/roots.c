/* The check of a plan, and roots of unity, for the transforms of both precisions. */
#include "fourierimpl.h"
#include <petsam/private/grid.h>

PetscErrorCode SamFourierCheckPlan(const void *plan)
{
  PetscFunctionBegin;
  PetscCheck(plan, PETSC_COMM_SELF, PETSC_ERR_LIB, SAM_NO_PLAN);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamRootOfUnity(ptrdiff_t k, ptrdiff_t n, double root[2])
{
  const ptrdiff_t acute = PetscMin(k, n - k);
  const PetscBool steep = 4 * acute > n;
  const double    angle = PETSC_PI * (double)(steep ? n - 2 * acute : 2 * acute) / (double)(2 * n);

  root[0] = steep ? sin(angle) : cos(angle);
  root[1] = steep ? cos(angle) : sin(angle);
  if (acute < k) root[0] = -root[0];
}
