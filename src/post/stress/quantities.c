/*
  The quantities of an evaluation. This is the only place that defines their names for options, datasets, files and
  other programs, but for those of parts of the stresses (private/stresspart.h). A new quantity is a row and a function.
*/
#include "evaluationimpl.h"
#include <petsam/private/body.h>

/* ---- of a step ---- */

static void Mises(SamEvaluation e, const SamPoints *p, const double *const s[], double *const values[])
{
  (void)e;
  SamStressMises(p->count, s, values[0]);
}

static void Principal(SamEvaluation e, const SamPoints *p, const double *const s[], double *const values[])
{
  (void)e;
  SamStressPrincipal(p->count, s, values);
}

/* Computes half the difference of the first and the third principal stress. */
static void HalfDifference(PetscInt n, double *const values[])
{
  for (PetscInt i = 0; i < n; i++) values[0][i] = 0.5 * (values[0][i] - values[2][i]);
}

/* Computes the strains at all points, by the constants of their depths. */
static void Strain(SamEvaluation e, const SamPoints *p, const double *const s[], double *const values[])
{
  for (PetscInt k = 0; k < p->depths; k++) {
    const double      *from[SAM_STRESS_COMPONENTS];
    double            *to[SAM_STRESS_COMPONENTS];
    const SamBodyPlace m = SamBodyAt(SamEvaluationBody(e), e->depth[p->depth + k]);

    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) {
      from[c] = s[c] + k * (ptrdiff_t)p->plane;
      to[c]   = values[c] + k * (ptrdiff_t)p->plane;
    }
    SamStressStrain(p->plane, m.young, m.poisson, from, to);
  }
}

/* ---- the table ---- */

/* A parameter of the cycle, and the normal of the plane where it is largest */
#define OF_PLANE(name, unit, text) \
  { \
    {name, unit, text}, {name "_normal_x", "1", "normal of the critical plane, x"}, \
      {name "_normal_y", "1", "normal of the critical plane, y"}, \
    { \
      name "_normal_z", "1", "normal of the critical plane, z" \
    } \
  }
#define CONSTANT(member, help, unit, range) \
  { \
    "fatigue_" #member, help, unit, range, offsetof(SamFatigueConstants, member) \
  }

SamQuantity SamQuantityTable[SAM_QUANTITIES + 1] = {
  {.name = "stress",
   .part = {{"stress_xx", "Pa", "stress xx, tension positive"},
            {"stress_yy", "Pa", "stress yy"},
            {"stress_zz", "Pa", "stress zz, z points into the body"},
            {"stress_xy", "Pa", "stress xy"},
            {"stress_xz", "Pa", "stress xz"},
            {"stress_yz", "Pa", "stress yz"}}},
  {.name = "mises", .part = {{"mises", "Pa", "von Mises stress"}}, .arrays = 1, .of_step = Mises},
  {.name    = "principal",
   .part    = {{"principal_1", "Pa", "maximum principal stress"},
               {"principal_2", "Pa", "intermediate principal stress"},
               {"principal_3", "Pa", "minimum principal stress"}},
   .arrays  = 3,
   .of_step = Principal},
  {.name    = "shear_max",
   .part    = {{"shear_max", "Pa", "maximum shear stress"}},
   .arrays  = 3,
   .of_step = Principal,
   .last    = HalfDifference},
  {.name    = "strain",
   .part    = {{"strain_xx", "1", "strain xx"},
               {"strain_yy", "1", "strain yy"},
               {"strain_zz", "1", "strain zz"},
               {"strain_xy", "1", "strain xy, tensor shear strain"},
               {"strain_xz", "1", "strain xz, tensor shear strain"},
               {"strain_yz", "1", "strain yz, tensor shear strain"}},
   .arrays  = SAM_STRESS_COMPONENTS,
   .elastic = PETSC_TRUE,
   .of_step = Strain},
  {.name     = "crossland",
   .part     = {{"crossland", "Pa", "Crossland's parameter of the cycle"}},
   .of_cycle = SamFatigueCrossland,
   .shown    = "Crossland",
   .with     = "-fatigue crossland",
   .constant = {CONSTANT(crossland_alpha, "factor on the maximum hydrostatic stress, required by crossland", NULL,
                         SAM_RANGE_NONNEGATIVE)}},
  {.name     = "dang_van",
   .part     = {{"dang_van", "Pa", "Dang Van's parameter of the cycle"}},
   .of_cycle = SamFatigueDangVan,
   .shown    = "Dang Van",
   .with     = "-fatigue dang_van",
   .constant = {CONSTANT(dang_van_alpha, "factor on the hydrostatic stress, required by dang_van", NULL,
                         SAM_RANGE_NONNEGATIVE)}},
  {.name     = "findley",
   .part     = OF_PLANE("findley", "Pa", "Findley's parameter of the cycle"),
   .of_cycle = SamFatigueFindley,
   .shown    = "Findley",
   .with     = "-fatigue findley",
   .constant = {CONSTANT(findley_k, "factor on the maximum normal stress, required by findley", NULL,
                         SAM_RANGE_NONNEGATIVE)}},
  {.name     = "swt",
   .elastic  = PETSC_TRUE,
   .part     = OF_PLANE("swt", "Pa", "parameter of Smith, Watson and Topper of the cycle"),
   .of_cycle = SamFatigueSWT,
   .shown    = "SWT"},
  {.name     = "fatemi_socie",
   .elastic  = PETSC_TRUE,
   .part     = OF_PLANE("fatemi_socie", "1", "parameter of Fatemi and Socie of the cycle"),
   .of_cycle = SamFatigueFatemiSocie,
   .shown    = "Fatemi-Socie",
   .with     = "-fatigue fatemi_socie",
   .constant = {CONSTANT(fatemi_socie_k, "factor on the maximum normal stress, required by fatemi_socie", NULL,
                         SAM_RANGE_NONNEGATIVE),
                CONSTANT(yield, "yield stress (), required by fatemi_socie", "Pa", SAM_RANGE_POSITIVE)}},
  {.name     = "ruiz",
   .part     = {{"ruiz_1", "J/m2", "Ruiz's first parameter of the cycle: frictional work"},
                {"ruiz_2", "Pa J/m2", "Ruiz's second parameter of the cycle: tension times frictional work"}},
   .of_cycle = SamFatigueRuiz,
   .shown    = "Ruiz 1"},
  {.name = NULL}};

void SamQuantitiesAddParts(void)
{
  const SamStressPartType *type;
  SamQuantity             *row = SamQuantityTable;

  while (row->name && !row->of_part) row++;
  for (PetscInt k = 0; (type = SamStressPartGetType(k)) && row < SamQuantityTable + SAM_QUANTITIES; k++)
    if (type->quantity.name)
      *row++ = (SamQuantity){.name    = type->quantity.name,
                             .part    = {{type->quantity.dataset, type->quantity.unit, type->quantity.text}},
                             .arrays  = 1,
                             .of_part = 1 + k};
}

void SamQuantityNames(PetscBool of_cycle, char text[], size_t size)
{
  text[0] = '\0';
  for (const SamQuantity *q = SamQuantityTable; q->name; q++)
    if ((q->of_cycle != NULL) == of_cycle)
      (void)snprintf(text + strlen(text), size - strlen(text), "%s%s", text[0] ? "," : "", q->name);
}

PetscBool SamQuantityWanted(SamEvaluation e, SamFatigueParameter *of_cycle)
{
  for (PetscInt q = 0; SamQuantityTable[q].name; q++)
    if (SamQuantityTable[q].of_cycle == of_cycle && e->wants[q]) return PETSC_TRUE;
  return PETSC_FALSE;
}

void SamQuantitiesList(SamEvaluation e)
{
  SamStressLayout *const l = &e->layout;

  l->datasets = 0;
  for (PetscInt q = 0; SamQuantityTable[q].name; q++) {
    const SamQuantity *row = &SamQuantityTable[q];

    for (PetscInt k = 0; e->wants[q] && k < SAM_QUANTITY_PARTS && row->part[k].name; k++)
      l->dataset[l->datasets++] =
        (SamStressDataset){row->part[k].name, row->part[k].unit, row->part[k].text, row->of_cycle != NULL};
  }
}

PetscErrorCode SamEvaluationHandOver(SamEvaluation e, PetscInt quantity, PetscInt k, PetscInt step, const SamPoints *p,
                                     const double values[])
{
  const SamStressLayout *l       = &e->layout;
  const PetscInt         start[] = {step, p->depth, e->section ? 0 : l->row, 0};
  const PetscInt         count[] = {1, p->depths, l->rows, l->n[SAM_X]};
  PetscInt               d       = 0;

  PetscFunctionBegin;
  while (l->dataset[d].name != SamQuantityTable[quantity].part[k].name) d++;
  PetscCall((*e->write)(e->write_context, d, start, count, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamQuantitiesWrite(SamEvaluation e, PetscInt step, const SamPoints *p, const double stress[])
{
  const double *s[SAM_STRESS_COMPONENTS];
  double       *more[SAM_STRESS_COMPONENTS];
  int           arrays                                                                   = 1;
  void (*done)(SamEvaluation, const SamPoints *, const double *const[], double *const[]) = Mises;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) s[c] = stress + c * (ptrdiff_t)p->count;
  for (PetscInt q = 0; SamQuantityTable[q].name; q++)
    if (e->wants[q]) arrays = PetscMax(arrays, SamQuantityTable[q].arrays);
  for (int k = 0; k < arrays; k++) PetscCall(SamAllocate(sizeof(double) * (size_t)p->count, &more[k]));
  Mises(e, p, s, more);
  SamLargestOfStep(e, step, p, s, more[0]);
  for (PetscInt q = 0; SamQuantityTable[q].name; q++) {
    const SamQuantity *row = &SamQuantityTable[q];

    if (!e->wants[q] || row->of_cycle) continue;
    if (row->of_part) {
      done = NULL;
      PetscCall(SamStressPartsGetValues(e->parts, row->of_part - 1, step, p, more[0]));
      PetscCall(SamEvaluationHandOver(e, q, 0, step, p, more[0]));
      continue;
    }
    if (row->of_step && row->of_step != done) (*row->of_step)(e, p, s, more);
    if (row->of_step) done = row->last ? NULL : row->of_step;
    if (row->last) (*row->last)(p->count, more);
    for (PetscInt k = 0; k < SAM_QUANTITY_PARTS && row->part[k].name; k++)
      PetscCall(SamEvaluationHandOver(e, q, k, step, p, row->of_step ? more[k] : s[k]));
  }
  for (int k = 0; k < arrays; k++) SamFree(more[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
