/* A step: its tractions; what is made of its stresses: quantities that are handed over, and the largest values. */
#include "evaluationimpl.h"

PetscErrorCode SamEvaluationReadTractions(SamEvaluation e, PetscInt step, double *const to[SAM_STRESS_TRACTIONS])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(e->stress->cases, e->source.bulk[step] + SAM_BULK_COMPONENTS, SAM_CASES));
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++)
    PetscCall((*e->source.read)(e->source.context, step, (SamStepField)(SAM_STEP_PRESSURE + t), to[t]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamBulkStressAt(SamEvaluation e, PetscInt step, PetscInt depth, double bulk[SAM_BULK_COMPONENTS])
{
  const double    *of = e->source.bulk[step];
  const SamPair   *pair;
  PetscInt         n;
  const SamLayers *layers = SamLayerAt(e, depth, &n);

  PetscCallAbort(e->comm, SamElasticityGetPair(e->elasticity, &pair));
  for (int k = 0; k < SAM_BULK_COMPONENTS; k++) bulk[k] = of[k];
  if (n == layers->count) return;
  if (!isinf(pair->young[e->body - 1])) {
    const double nu = (double)pair->poisson[e->body - 1], own = (double)layers->poisson[n],
                 ratio = (double)(layers->young[n] / pair->young[e->body - 1]);
    const double xx = of[SAM_BULK_XX] - nu * of[SAM_BULK_YY], yy = of[SAM_BULK_YY] - nu * of[SAM_BULK_XX];

    bulk[SAM_BULK_XX] = ratio * (xx + own * yy) / (1 - own * own);
    bulk[SAM_BULK_YY] = ratio * (yy + own * xx) / (1 - own * own);
    bulk[SAM_BULK_XY] = ratio * (1 + nu) / (1 + own) * of[SAM_BULK_XY];
  }
  bulk[SAM_BULK_XX] += (double)layers->stress[n][0];
  bulk[SAM_BULK_YY] += (double)layers->stress[n][1];
}

void SamStressAddBulk(SamEvaluation e, PetscInt step, const SamPoints *p, double stress[])
{
  static const SamStressComponent component[SAM_BULK_COMPONENTS] = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY};
  const PetscInt                  plane                          = p->depths ? p->count / p->depths : 0;

  for (PetscInt depth = 0; depth < p->depths; depth++) {
    double bulk[SAM_BULK_COMPONENTS];

    SamBulkStressAt(e, step, p->depth + depth, bulk);
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) {
      double *const s = stress + component[k] * (ptrdiff_t)p->count + depth * (ptrdiff_t)plane;

      for (PetscInt i = 0; i < plane && bulk[k] != 0; i++) s[i] += bulk[k];
    }
  }
}

void SamLargestKeep(SamLargestPoint *largest, double value, double point)
{
  if (value > largest->value || (value == largest->value && point < largest->point))
    *largest = (SamLargestPoint){value, point};
}

/* The largest principal stress at a point is at most this, and reaches it under tension in one direction. */
static double RoughBound(const double *const s[SAM_STRESS_COMPONENTS], double mises, PetscInt i)
{
  const double mean = (s[SAM_STRESS_XX][i] + s[SAM_STRESS_YY][i] + s[SAM_STRESS_ZZ][i]) / 3;

  return mean + mises * (2. / 3) * (1 + 1e-12);
}

/* A bound that is nearly the largest principal stress: by the cubic equation, and its rounding. */
static double FineBound(const double *const s[SAM_STRESS_COMPONENTS], double mises, PetscInt i)
{
  const double mean = (s[SAM_STRESS_XX][i] + s[SAM_STRESS_YY][i] + s[SAM_STRESS_ZZ][i]) / 3;
  const double xx = s[SAM_STRESS_XX][i] - mean, yy = s[SAM_STRESS_YY][i] - mean, zz = s[SAM_STRESS_ZZ][i] - mean,
               xy = s[SAM_STRESS_XY][i], xz = s[SAM_STRESS_XZ][i], yz = s[SAM_STRESS_YZ][i];
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  const double ratio       = mises > 0 ? 13.5 * determinant / (mises * mises * mises) : 1;

  return mean + mises * (2. / 3 * cos(acos(PetscMin(PetscMax(ratio, -1), 1)) / 3) + 1e-6);
}

static void KeepPrincipal(SamLargestPoint *largest, const double *const s[SAM_STRESS_COMPONENTS], PetscInt i,
                          double first)
{
  double principal[3];

  SamPrincipalOf((const double[]){s[0][i], s[1][i], s[2][i], s[3][i], s[4][i], s[5][i]}, principal);
  SamLargestKeep(largest, principal[0], first + (double)i);
}

/* Largest von Mises and principal stress. The latter is found exactly only where the bounds allow the largest. */
static void FindLargest(SamEvaluation e, PetscInt step, const SamPoints *p,
                        const double *const s[SAM_STRESS_COMPONENTS], const double mises[])
{
  SamLargestPoint *const largest = &e->largest[step].principal;
  PetscInt               most    = 0;

  for (PetscInt i = 0; i < p->count; i++) {
    SamLargestKeep(&e->largest[step].mises, mises[i], p->first + (double)i);
    if (RoughBound(s, mises[i], i) > RoughBound(s, mises[most], most)) most = i;
  }
  if (p->count) KeepPrincipal(largest, s, most, p->first);
  for (PetscInt i = 0; i < p->count; i++)
    if (RoughBound(s, mises[i], i) >= largest->value && FineBound(s, mises[i], i) >= largest->value)
      KeepPrincipal(largest, s, i, p->first);
}

/* Largest values of each layer, and at its bottom. */
static void FindLargestOfLayers(SamEvaluation e, PetscInt step, const SamPoints *p,
                                const double *const s[SAM_STRESS_COMPONENTS], const double mises[])
{
  const PetscInt plane = p->depths ? p->count / p->depths : 0;

  for (PetscInt k = 0; k < p->depths; k++) {
    PetscInt         n;
    const SamLayers *layers = SamLayerAt(e, p->depth + k, &n);

    for (PetscInt i = k * plane; i < (k + 1) * plane && layers->count; i++) {
      SamLargestPoint *const at = e->largest[step].interface[n];

      SamLargestKeep(&e->largest[step].layer[n], mises[i], p->first + (double)i);
      if (e->side[p->depth + k] >= 0) continue;
      SamLargestKeep(&at[0], s[SAM_STRESS_ZZ][i], p->first + (double)i);
      SamLargestKeep(&at[1], hypot(s[SAM_STRESS_XZ][i], s[SAM_STRESS_YZ][i]), p->first + (double)i);
    }
  }
}

static PetscErrorCode Write(SamEvaluation e, PetscInt step, const SamPoints *p, SamQuantity quantity, PetscInt k,
                            const double values[])
{
  PetscFunctionBegin;
  if (e->wants[quantity]) PetscCall((*e->write)(e->write_context, quantity, k, step, p->depth, p->depths, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The strains at all points, by the constants of their depths. */
static void ComputeStrain(SamEvaluation e, const SamPoints *p, const double *const s[], double *const strain[])
{
  const PetscInt plane = p->depths ? p->count / p->depths : 0;

  for (PetscInt k = 0; k < p->depths; k++) {
    const double *from[SAM_STRESS_COMPONENTS];
    double       *to[SAM_STRESS_COMPONENTS];
    PetscReal     young, poisson;

    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) {
      from[c] = s[c] + k * (ptrdiff_t)plane;
      to[c]   = strain[c] + k * (ptrdiff_t)plane;
    }
    SamStressGetConstants(e->stress, e->depth[p->depth + k], &young, &poisson);
    SamStressStrain(plane, young, poisson, from, to);
  }
}

PetscErrorCode SamQuantitiesWrite(SamEvaluation e, PetscInt step, const SamPoints *p, const double stress[])
{
  const PetscBool *wants     = e->wants;
  const PetscBool  principal = wants[SAM_QUANTITY_PRINCIPAL] || wants[SAM_QUANTITY_SHEAR_MAX];
  const PetscInt   arrays    = wants[SAM_QUANTITY_STRAIN] ? SAM_STRESS_COMPONENTS : principal ? 3 : 1;
  const double    *s[SAM_STRESS_COMPONENTS];
  double          *more[SAM_STRESS_COMPONENTS];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) s[c] = stress + c * (ptrdiff_t)p->count;
  for (PetscInt k = 0; k < arrays; k++) PetscCall(SamAllocate(sizeof(double) * (size_t)p->count, &more[k]));
  SamStressMises(p->count, s, more[0]);
  FindLargest(e, step, p, s, more[0]);
  FindLargestOfLayers(e, step, p, s, more[0]);
  PetscCall(Write(e, step, p, SAM_QUANTITY_MISES, 0, more[0]));
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) PetscCall(Write(e, step, p, SAM_QUANTITY_STRESS, c, s[c]));
  if (principal) {
    SamStressPrincipal(p->count, s, more);
    for (PetscInt c = 0; c < 3; c++) PetscCall(Write(e, step, p, SAM_QUANTITY_PRINCIPAL, c, more[c]));
    for (PetscInt i = 0; i < p->count; i++) more[0][i] = 0.5 * (more[0][i] - more[2][i]);
    PetscCall(Write(e, step, p, SAM_QUANTITY_SHEAR_MAX, 0, more[0]));
  }
  if (wants[SAM_QUANTITY_STRAIN]) {
    ComputeStrain(e, p, s, more);
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) PetscCall(Write(e, step, p, SAM_QUANTITY_STRAIN, c, more[c]));
  }
  for (PetscInt k = 0; k < arrays; k++) SamFree(more[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
