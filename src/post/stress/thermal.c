/*
  The thermal stress by the steady heat of a step into a body that expands (laws/heat/thermalstress.c), at one depth
  after another. Of a section the lines of all steps are computed before the stresses, as ranks share its depths.
*/
#include "evaluationimpl.h"
#include <petsam/private/body.h>

struct _n_SamThermal {
  SamThermalStress operator;
  PetscReal        factor; /* expansion times Young's modulus, Pa/K */
  Vec              flux, field;
  PetscInt         length; /* points of the section at a depth */
  double          *line;   /* (steps, depths, components, length) of a section, Pa */
};

PetscErrorCode SamThermalSetUp(SamEvaluation e)
{
  const SamExpansion expansion = SamBodyExpansion(SamEvaluationBody(e), e->source.expansion);
  const SamHeatBody *body      = e->source.heat;

  PetscFunctionBegin;
  if (e->source.expansion == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(body, e->comm, SAM_ERR_USER,
             "%s: body %" PetscInt_FMT " expands by heat, and the heat of the steps is not there: its thermal stress "
             "would be missing: run petsam with an output that has heat_1 and heat_2, and petsam-stress on that",
             e->source.name, e->body);
  PetscCheck(!e->slide, e->comm, SAM_ERR_USER,
             "-body %" PetscInt_FMT ": its points slide under the contact, where the thermal stress is not known: give "
             "the other body",
             e->body);
  PetscCheck(body->speed == 0 || PetscAbsReal(body->speed) >= SamThermalStressLeast(e->grid, body), e->comm,
             SAM_ERR_USER,
             "%s: body %" PetscInt_FMT " moves at %.3g m/s, so slowly that its heat reaches beyond the grid: its "
             "thermal stress is computed at 0, and from %.3g m/s on",
             e->source.name, e->body, (double)PetscAbsReal(body->speed), (double)SamThermalStressLeast(e->grid, body));
  PetscCall(PetscNew(&e->thermal));
  e->thermal->factor = expansion.stress;
  e->thermal->length = e->axis == SAM_SECTION_X ? e->grid->nx : e->grid->ny;
  PetscCall(SamThermalStressCreate(e->grid, e->source.settings, body, expansion.poisson, &e->thermal->operator));
  PetscCall(SamGridCreateVec(e->grid, 1, &e->thermal->flux));
  PetscCall(SamGridCreateVec(e->grid, SAM_STRESS_COMPONENTS, &e->thermal->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamThermalDestroy(SamThermal *thermal)
{
  SamThermal t = *thermal;

  PetscFunctionBegin;
  *thermal = NULL;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamThermalStressDestroy(&t->operator));
  PetscCall(VecDestroy(&t->field));
  PetscCall(VecDestroy(&t->flux));
  SamFree(t->line);
  PetscCall(PetscFree(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the values of a section's lines in a step, at all depths. */
static ptrdiff_t LinesOf(SamEvaluation e)
{
  return SAM_STRESS_COMPONENTS * (ptrdiff_t)e->depths * e->thermal->length;
}

double SamThermalBytes(SamEvaluation e)
{
  if (!e->thermal) return 0;
  return SamThermalStressBytes(e->thermal->operator) + 56 * (double)e->grid->cells +
         (e->section ? 8 * (double)e->source.steps * (double)LinesOf(e) : 0);
}

/* Computes the thermal stress of this rank's cells at a depth in a step, in the field. */
static PetscErrorCode ComputePlane(SamEvaluation e, PetscInt step, PetscInt depth)
{
  const SamThermal t = e->thermal;
  double          *a;

  PetscFunctionBegin;
  PetscCall(VecGetArray(t->flux, &a));
  PetscCall((*e->source.read)(e->source.context, step, SAM_STEP_HEAT, a));
  PetscCall(VecRestoreArray(t->flux, &a));
  PetscCall(VecSet(t->field, 0));
  PetscCall(SamThermalStressAdd(t->operator, e->depth[depth], t->flux, t->factor, t->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamThermalFind(SamEvaluation e)
{
  const SamThermal t = e->thermal;
  const double    *a;

  PetscFunctionBegin;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamAllocate(sizeof(double) * (size_t)(e->source.steps * LinesOf(e) + 1), &t->line));
  for (PetscInt depth = 0; depth < e->depths; depth++)
    for (PetscInt step = 0; step < e->source.steps; step++) {
      double *const to = t->line + step * LinesOf(e) + depth * SAM_STRESS_COMPONENTS * (ptrdiff_t)t->length;

      PetscCall(ComputePlane(e, step, depth));
      PetscCall(VecGetArrayRead(t->field, &a));
      for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++)
        PetscCall(SamPointsTakeLine(e, a + c * (ptrdiff_t)e->grid->cells, t->length, to + c * (ptrdiff_t)t->length));
      PetscCall(VecRestoreArrayRead(t->field, &a));
      PetscCall(SamEvaluationTell(e, "thermal stress", (double)(depth + 1) / e->depths, 0));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressAddThermal(SamEvaluation e, PetscInt step, const SamPoints *p, double stress[])
{
  const SamThermal t = e->thermal;
  const double    *from;

  PetscFunctionBegin;
  if (!t) PetscFunctionReturn(PETSC_SUCCESS);
  if (!e->section) {
    PetscCall(ComputePlane(e, step, p->depth));
    PetscCall(VecGetArrayRead(t->field, &from));
    for (ptrdiff_t k = 0; k < SAM_STRESS_COMPONENTS * (ptrdiff_t)p->count; k++) stress[k] += from[k];
    PetscCall(VecRestoreArrayRead(t->field, &from));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  from = t->line + step * LinesOf(e) + p->depth * SAM_STRESS_COMPONENTS * (ptrdiff_t)t->length;
  for (PetscInt depth = 0; depth < p->depths; depth++)
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++, from += t->length)
      for (PetscInt k = 0; k < t->length; k++)
        stress[c * (ptrdiff_t)p->count + depth * (ptrdiff_t)p->plane + k] += from[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
