/* What is made of the stresses in a step: quantities that are written, and the largest values. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>

void SamStressAddBulk(const SamStressRun *run, PetscInt step, PetscInt n, double stress[])
{
  static const SamStressComponent component[SAM_BULK_COMPONENTS] = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY};

  for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) {
    double *const s = stress + component[k] * (ptrdiff_t)n;

    for (PetscInt i = 0; i < n && run->bulk[step][k] != 0; i++) s[i] += run->bulk[step][k];
  }
}

void SamLargestKeep(SamLargest *largest, double value, double point)
{
  if (value > largest->value || (value == largest->value && point < largest->point))
    *largest = (SamLargest){value, point};
}

/*
  Largest von Mises and principal stress. The latter is at most the mean stress and two thirds of the former: few points
  need more than that.
*/
static void FindLargest(SamStressRun *run, PetscInt step, const SamPoints *p,
                        const double *const s[SAM_STRESS_COMPONENTS], const double mises[])
{
  for (PetscInt i = 0; i < p->count; i++) {
    const double mean = (s[SAM_STRESS_XX][i] + s[SAM_STRESS_YY][i] + s[SAM_STRESS_ZZ][i]) / 3;
    double       value[3];
    double      *to[3] = {&value[0], &value[1], &value[2]};

    SamLargestKeep(&run->mises[step], mises[i], p->first + (double)i);
    if (mean + mises[i] * (2. / 3) * (1 + 1e-12) < run->principal[step].value) continue;
    SamStressPrincipal(1, (const double *[]){&s[0][i], &s[1][i], &s[2][i], &s[3][i], &s[4][i], &s[5][i]}, to);
    SamLargestKeep(&run->principal[step], value[0], p->first + (double)i);
  }
}

static PetscErrorCode Write(SamStressRun *run, PetscInt step, const SamPoints *p, SamQuantity quantity, PetscInt k,
                            const double values[])
{
  PetscFunctionBegin;
  if (run->request.wants[quantity])
    PetscCall(SamStressFileWrite(run->file, quantity, k, step, p->depth, p->depths, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamQuantitiesWrite(SamStressRun *run, PetscInt step, const SamPoints *p, const double stress[])
{
  const PetscBool *wants    = run->request.wants;
  const PetscBool principal = wants[SAM_QUANTITY_PRINCIPAL] || wants[SAM_QUANTITY_SHEAR_MAX] ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt  arrays    = wants[SAM_QUANTITY_STRAIN] ? SAM_STRESS_COMPONENTS : principal ? 3 : 1;
  const double   *s[SAM_STRESS_COMPONENTS];
  double         *more[SAM_STRESS_COMPONENTS];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) s[c] = stress + c * (ptrdiff_t)p->count;
  for (PetscInt k = 0; k < arrays; k++) PetscCall(SamAllocate(sizeof(double) * (size_t)p->count, &more[k]));
  SamStressMises(p->count, s, more[0]);
  FindLargest(run, step, p, s, more[0]);
  PetscCall(Write(run, step, p, SAM_QUANTITY_MISES, 0, more[0]));
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) PetscCall(Write(run, step, p, SAM_QUANTITY_STRESS, c, s[c]));
  if (principal) {
    SamStressPrincipal(p->count, s, more);
    for (PetscInt c = 0; c < 3; c++) PetscCall(Write(run, step, p, SAM_QUANTITY_PRINCIPAL, c, more[c]));
    for (PetscInt i = 0; i < p->count; i++) more[0][i] = 0.5 * (more[0][i] - more[2][i]);
    PetscCall(Write(run, step, p, SAM_QUANTITY_SHEAR_MAX, 0, more[0]));
  }
  if (wants[SAM_QUANTITY_STRAIN]) {
    SamStressStrain(p->count, run->young, run->poisson, s, more);
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++)
      PetscCall(Write(run, step, p, SAM_QUANTITY_STRAIN, c, more[c]));
  }
  for (PetscInt k = 0; k < arrays; k++) SamFree(more[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
