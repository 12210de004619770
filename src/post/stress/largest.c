/* The largest values of each step and of the cycle, with their places, on all ranks. */
#include "evaluationimpl.h"
#include <petsam/private/body.h>

/* ---- keeping ---- */

static SamLargest *LargestOf(SamEvaluation e, PetscInt kind, PetscInt step)
{
  return &e->largest[kind * e->source.steps + step];
}

/* Returns the entry of a quantity of the cycle; these follow the entries of all steps. */
static SamLargest *LargestOfQuantity(SamEvaluation e, PetscInt quantity)
{
  return LargestOf(e, e->kinds, 0) + quantity;
}

PetscErrorCode SamLargestClear(SamEvaluation e)
{
  const PetscInt materials = SamBodyAt(SamEvaluationBody(e), INFINITY).number + 1;
  SamLargest    *end;

  PetscFunctionBegin;
  e->kinds     = SAM_LARGEST_OWN + (materials > 1 ? SAM_OWN * (materials - 1) + SAM_OWN_TENSION : 0);
  e->edge_lost = 0;
  PetscCall(PetscFree(e->largest));
  PetscCall(PetscMalloc1(e->kinds * e->source.steps + SAM_QUANTITIES, &e->largest));
  end = LargestOfQuantity(e, SAM_QUANTITIES);
  for (SamLargest *of = e->largest; of < end; of++) *of = (SamLargest){-INFINITY, {0, 0, 0}};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Compares places in the order z, y, x. */
static PetscBool IsBefore(const double a[3], const double b[3])
{
  for (int d = 2; d >= 0; d--)
    if (a[d] != b[d]) return a[d] < b[d] ? PETSC_TRUE : PETSC_FALSE;
  return PETSC_FALSE;
}

static void Keep(SamLargest *largest, double value, const double place[3])
{
  if (value > largest->value || (value == largest->value && IsBefore(place, largest->place)))
    *largest = (SamLargest){value, {place[0], place[1], place[2]}};
}

void SamLargestKeep(SamEvaluation e, PetscInt kind, PetscInt step, double value, const double place[3])
{
  Keep(LargestOf(e, kind, step), value, place);
}

/* Updates a largest value by the value at the i-th point. */
static void KeepAt(SamEvaluation e, SamLargest *largest, double value, const SamPoints *p, PetscInt i)
{
  const PetscInt  c   = i % p->plane;
  const PetscBool row = e->section && e->axis == SAM_SECTION_X, column = e->section && e->axis == SAM_SECTION_Y;
  double          place[3];

  if (!(value >= largest->value)) return;
  place[0] = (double)SamGridX(e->grid, column ? e->index : c % e->grid->nx);
  place[1] = (double)SamGridY(e->grid, row ? e->index : column ? c : e->grid->row_start + c / e->grid->nx);
  place[2] = (double)e->depth[p->depth + i / p->plane];
  Keep(largest, value, place);
}

void SamLargestOfCycle(SamEvaluation e, PetscInt quantity, const SamPoints *p, PetscInt i, double value)
{
  SamLargest *const largest = LargestOfQuantity(e, quantity);

  if (isnan(value)) return;
  KeepAt(e, largest, value, p, i);
  if (e->average) largest->place[2] = 0; /* the mean belongs to the surface's points */
}

/* ---- of a step ---- */

/* Returns a bound of the largest principal stress at a point; uniaxial tension reaches it. */
static double RoughBound(const double *const s[SAM_STRESS_COMPONENTS], double mises, PetscInt i)
{
  const double mean = (s[SAM_STRESS_XX][i] + s[SAM_STRESS_YY][i] + s[SAM_STRESS_ZZ][i]) / 3;

  return mean + mises * (2. / 3) * (1 + 1e-12);
}

/* Returns a bound close to the largest principal stress: the solution of the cubic equation plus its rounding. */
static double FineBound(const double *const s[SAM_STRESS_COMPONENTS], double mises, PetscInt i)
{
  const double mean = (s[SAM_STRESS_XX][i] + s[SAM_STRESS_YY][i] + s[SAM_STRESS_ZZ][i]) / 3;
  const double xx = s[SAM_STRESS_XX][i] - mean, yy = s[SAM_STRESS_YY][i] - mean, zz = s[SAM_STRESS_ZZ][i] - mean,
               xy = s[SAM_STRESS_XY][i], xz = s[SAM_STRESS_XZ][i], yz = s[SAM_STRESS_YZ][i];
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  const double ratio       = mises > 0 ? 13.5 * determinant / (mises * mises * mises) : 1;

  return mean + mises * (2. / 3 * cos(acos(PetscMin(PetscMax(ratio, -1), 1)) / 3) + 1e-6);
}

static void KeepPrincipal(SamEvaluation e, SamLargest *largest, const SamPoints *p,
                          const double *const s[SAM_STRESS_COMPONENTS], PetscInt i)
{
  double principal[3];

  SamPrincipalOf((const double[]){s[0][i], s[1][i], s[2][i], s[3][i], s[4][i], s[5][i]}, principal);
  KeepAt(e, largest, principal[0], p, i);
}

/* Updates the largest principal stress by some points; it is computed accurately only where the bounds allow a
   maximum. */
static void KeepLargestPrincipal(SamEvaluation e, SamLargest *largest, const SamPoints *p,
                                 const double *const s[SAM_STRESS_COMPONENTS], const double mises[], PetscInt begin,
                                 PetscInt end)
{
  PetscInt most = begin;

  for (PetscInt i = begin; i < end; i++)
    if (RoughBound(s, mises[i], i) > RoughBound(s, mises[most], most)) most = i;
  if (begin < end) KeepPrincipal(e, largest, p, s, most);
  for (PetscInt i = begin; i < end; i++)
    if (RoughBound(s, mises[i], i) >= largest->value && FineBound(s, mises[i], i) >= largest->value)
      KeepPrincipal(e, largest, p, s, i);
}

/* Updates the largest values of the material of each depth, and at the interface below it. */
static void KeepOwn(SamEvaluation e, PetscInt step, const SamPoints *p, const double *const s[SAM_STRESS_COMPONENTS],
                    const double mises[])
{
  const SamBody body = SamEvaluationBody(e);

  for (PetscInt k = 0; k < p->depths && !SamBodyAt(body, 0).last; k++) {
    const PetscInt kind  = SAM_LARGEST_OWN + SAM_OWN * SamBodyAt(body, e->depth[p->depth + k]).number;
    const PetscInt begin = k * p->plane, end = begin + p->plane;

    KeepLargestPrincipal(e, LargestOf(e, kind + SAM_OWN_PRINCIPAL, step), p, s, mises, begin, end);
    for (PetscInt i = begin; i < end; i++) {
      KeepAt(e, LargestOf(e, kind + SAM_OWN_MISES, step), mises[i], p, i);
      if (e->side[p->depth + k] >= 0) continue;
      KeepAt(e, LargestOf(e, kind + SAM_OWN_TENSION, step), s[SAM_STRESS_ZZ][i], p, i);
      KeepAt(e, LargestOf(e, kind + SAM_OWN_SHEAR, step), hypot(s[SAM_STRESS_XZ][i], s[SAM_STRESS_YZ][i]), p, i);
    }
  }
}

void SamLargestOfStep(SamEvaluation e, PetscInt step, const SamPoints *p, const double *const s[SAM_STRESS_COMPONENTS],
                      const double mises[])
{
  for (PetscInt i = 0; i < p->count; i++) KeepAt(e, LargestOf(e, SAM_LARGEST_MISES, step), mises[i], p, i);
  KeepLargestPrincipal(e, LargestOf(e, SAM_LARGEST_PRINCIPAL, step), p, s, mises, 0, p->count);
  KeepOwn(e, step, p, s, mises);
}

/* ---- of all ranks ---- */

PetscErrorCode SamLargestAgree(SamEvaluation e)
{
  SamLargest *const end = LargestOfQuantity(e, SAM_QUANTITIES);

  PetscFunctionBegin;
  for (SamLargest *of = e->largest; of < end; of++) {
    const double mine = of->value;
    PetscBool    here;

    PetscCall(SamMax(e->comm, 1, &of->value));
    here = (PetscBool)(mine == of->value);
    for (int d = 2; d >= 0; d--) { /* of equal values the one whose place comes first */
      double least = here ? -of->place[d] : -INFINITY;

      PetscCall(SamMax(e->comm, 1, &least));
      here         = (PetscBool)(here && of->place[d] == -least);
      of->place[d] = -least;
    }
    if (of->value == -INFINITY) *of = (SamLargest){NAN, {NAN, NAN, NAN}};
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- by name ---- */

/* Largest values of a step: name of the dataset, a text, and the printed words */
static const struct {
  const char *name, *text, *shown;
} kinds[SAM_LARGEST_OWN] =
  {[SAM_LARGEST_MISES]          = {"mises", "maximum von Mises stress", "von Mises stress"},
   [SAM_LARGEST_PRINCIPAL]      = {"principal_1", "maximum principal stress", ""},
   [SAM_LARGEST_EDGE_XX]        = {"edge_stress_xx", "maximum stress xx at the contact edge, on the surface",
                                   "stress xx at the contact edge"},
   [SAM_LARGEST_EDGE_PRINCIPAL] = {"edge_principal_1", "maximum principal stress at the contact edge, on the surface",
                                   "principal stress at the contact edge"}},
  of_material[SAM_OWN] = {[SAM_OWN_MISES]     = {"mises", "von Mises stress", "von Mises stress"},
                          [SAM_OWN_PRINCIPAL] = {"principal_1", "principal stress", "principal stress"},
                          [SAM_OWN_TENSION]   = {"tension", "tension across the interface below, sigma_zz,",
                                                 "tension across the interface below"},
                          [SAM_OWN_SHEAR]     = {"shear", "shear stress along the interface below",
                                                 "shear along the interface below"}};

static PetscErrorCode DescribeOwn(SamEvaluation e, PetscInt n, PetscInt kind, SamLargestSeries *of)
{
  const PetscBool substrate = n == SamBodyAt(SamEvaluationBody(e), INFINITY).number;
  char            name[32] = "substrate", shown[32] = "substrate";

  PetscFunctionBegin;
  if (!substrate) PetscCall(PetscSNPrintf(name, sizeof(name), "layer%" PetscInt_FMT, n + 1));
  if (!substrate) PetscCall(PetscSNPrintf(shown, sizeof(shown), "layer %" PetscInt_FMT, n + 1));
  PetscCall(PetscSNPrintf(of->name, sizeof(of->name), "%s_%s", name, of_material[kind].name));
  PetscCall(PetscSNPrintf(of->text, sizeof(of->text), "maximum %s of the %s", of_material[kind].text,
                          substrate ? "substrate" : "layer"));
  PetscCall(PetscSNPrintf(of->shown, sizeof(of->shown), "%s: %s", shown, of_material[kind].shown));
  of->material = n + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Describe(SamEvaluation e, PetscInt kind, SamLargestSeries *of)
{
  PetscFunctionBegin;
  *of = (SamLargestSeries){.unit = "Pa", .places = 3, .count = e->source.steps, .step = LargestOf(e, kind, 0)};
  if (kind >= SAM_LARGEST_OWN) {
    kind -= SAM_LARGEST_OWN;
    PetscCall(DescribeOwn(e, kind / SAM_OWN, kind % SAM_OWN, of));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscStrncpy(of->name, kinds[kind].name, sizeof(of->name)));
  PetscCall(PetscStrncpy(of->text, kinds[kind].text, sizeof(of->text)));
  PetscCall(PetscStrncpy(of->shown, kinds[kind].shown, sizeof(of->shown)));
  if (kind != SAM_LARGEST_EDGE_XX && kind != SAM_LARGEST_EDGE_PRINCIPAL) PetscFunctionReturn(PETSC_SUCCESS);
  of->places  = 2;
  of->missing = e->edge_lost;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if a largest value exists: an edge needs a map of the surface, and a material needs a depth. */
static PetscBool Exists(SamEvaluation e, const SamLargestSeries *of)
{
  if (of->places == 2) return !e->section && e->layout.coordinate[SAM_Z][0] == 0 ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt s = 0; s < of->count; s++)
    if (!isnan(of->step[s].value)) return PETSC_TRUE;
  return !of->material;
}

PetscBool SamEvaluationGetLargest(SamEvaluation e, PetscInt k, SamLargestSeries *of)
{
  for (PetscInt kind = 0; kind < e->kinds; kind++) {
    PetscCallAbort(e->comm, Describe(e, kind, of));
    if (Exists(e, of) && !k--) return PETSC_TRUE;
  }
  for (PetscInt q = 0; SamQuantityTable[q].name; q++) {
    const SamQuantity *row = &SamQuantityTable[q];

    if (!row->of_cycle || !e->wants[q] || k--) continue;
    *of = (SamLargestSeries){
      .unit = row->part[0].unit, .of_cycle = PETSC_TRUE, .places = 3, .count = 1, .step = LargestOfQuantity(e, q)};
    (void)snprintf(of->name, sizeof(of->name), "%s", row->part[0].name);
    (void)snprintf(of->text, sizeof(of->text), "%s", row->part[0].text);
    (void)snprintf(of->shown, sizeof(of->shown), "%s", row->shown);
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}
