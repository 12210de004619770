/*
  Magnified cycles: the wear of m cycles, computed by going once through the steps of one cycle.

  Where surfaces move past each other, each pair of points touches in one step only, and no mean over the cycle is a
  contact problem. A magnified cycle takes the steps of the computed cycle again, and each of them wears m times, by the
  pressure at its end: with w1, w2 the depths, and body 2's read under the cells where the step has moved it,

      p solves the normal problem on h + w1 + w2 + m (k1 + k2) e p,  then  w1 += m k1 e p,  w2 += m k2 e p,

  e being the wear load of the step per pressure, from the computed cycle. Each step is a proximal map of a concave
  energy of the depths, so that their product has no limit of stability (Bauschke and Combettes 2011, Convex Analysis
  and Monotone Operator Theory in Hilbert Spaces). It is of first order; cyclejump.c extrapolates.

  A step wears under the mean of the pressures before and after it. So over a closed cycle each pressure wears by half
  of the wear per pressure of the step before it, plus half of that of the step after it: their mean is e. Cells that
  are open before and after a step have the e that they would have in contact; cells that stick have 0.
*/
#include "lifeimpl.h"
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/contact.h>

PetscErrorCode SamRateCreatePasses(SamLife l, SamRate *rate)
{
  const size_t    bytes = sizeof(float) * (size_t)l->grid->cells;
  const PetscBool lifts = l->lifts;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(l->cycle.steps, &rate->passes));
  for (PetscInt k = 0; k < l->cycle.steps; k++) {
    PetscCall(SamAllocate(bytes, &rate->passes[k].wears));
    if (lifts) PetscCall(SamAllocate(bytes, &rate->passes[k].lift));
    if (rate == &l->start) PetscCall(SamAllocate(bytes, &rate->passes[k].pressure));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRateDestroyPasses(SamLife l, SamRate *rate)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < l->cycle.steps && rate->passes; k++) {
    SamFree(rate->passes[k].wears);
    SamFree(rate->passes[k].lift);
    SamFree(rate->passes[k].pressure);
  }
  PetscCall(PetscFree(rate->passes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the computed cycle ---- */

/* Computes a step's wear load (rate->shift), its slip (l->gap), and wear load per slip and pressure (l->diagonal). */
static PetscErrorCode FindWear(SamLife l, const SamSolution *s, SamRate *rate)
{
  const PetscBool  by_energy = ((const SamWear *)l->law->data)->by_energy;
  const SamBoundAt at        = {l->memory, &s->control, s->pressure, l->gap, 0};

  PetscFunctionBegin;
  PetscCall(
    SamContactComputeFriction(l->contact, l->gap, by_energy ? NULL : rate->shift, by_energy ? rate->shift : NULL));
  PetscCall(VecSet(l->diagonal, 1));
  if (by_energy) PetscCall(SamProblemComputeBound(l->problem, &at, &(SamBound){.by_pressure = l->diagonal}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacement of the surfaces in a step by other causes than the pressure: u_z - S p. */
static PetscErrorCode NoteLift(SamLife l, const SamSolution *s, float lift[])
{
  const double *all, *own;

  PetscFunctionBegin;
  if (!lift) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamElasticityApplyNormal(SamProblemGetElasticity(l->problem), s->pressure, l->gap));
  PetscCall(VecGetArrayRead(s->displacement_z, &all));
  PetscCall(VecGetArrayRead(l->gap, &own));
  for (PetscInt i = 0; i < l->grid->cells; i++) lift[i] = (float)(all[i] - own[i]);
  PetscCall(VecRestoreArrayRead(l->gap, &own));
  PetscCall(VecRestoreArrayRead(s->displacement_z, &all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores a field as floats relative to its maximum: so a slip that is the same everywhere keeps all digits. */
static PetscErrorCode NoteWears(SamLife l, Vec field, SamPass *pass)
{
  const double *values;
  PetscReal     most;

  PetscFunctionBegin;
  PetscCall(VecMax(field, NULL, &most));
  pass->most = (double)most;
  PetscCall(VecGetArrayRead(field, &values));
  for (PetscInt i = 0; i < l->grid->cells; i++) pass->wears[i] = (float)(most > 0 ? values[i] / pass->most : 0);
  PetscCall(VecRestoreArrayRead(field, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeNotePass(SamLife l, PetscInt k, const SamStep *step, SamRate *rate)
{
  SamPass *const     pass = &rate->passes[k];
  const SamSolution *s;
  const double      *p, *before, *path, *unit;
  double            *wears, *sum;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(l->contact, &s));
  pass->balance = SamControlGetBalance(&step->control, SAM_BALANCE_NORMAL);
  (void)SamFramesGetSlide(l->memory, SAM_TRIED, pass->slide);
  PetscCall(FindWear(l, s, rate));
  if (rate == &l->start) PetscCall(SamLifeNoteStride(l, rate->shift, rate->pressure, s->pressure));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(rate->pressure, &before));
  PetscCall(VecGetArrayRead(l->gap, &path));
  PetscCall(VecGetArrayRead(l->diagonal, &unit));
  PetscCall(VecGetArray(rate->shift, &wears));
  PetscCall(VecGetArray(rate->coefficient, &sum));
  for (PetscInt i = 0; i < l->grid->cells; i++) {
    const double mean = 0.5 * (before[i] + p[i]);

    wears[i] = mean > 0 ? fabs(wears[i]) / mean : unit[i] * path[i];
    sum[i] += mean > 0 ? wears[i] : 0;
  }
  PetscCall(VecRestoreArray(rate->coefficient, &sum));
  PetscCall(VecRestoreArray(rate->shift, &wears));
  PetscCall(VecRestoreArrayRead(l->diagonal, &unit));
  PetscCall(VecRestoreArrayRead(l->gap, &path));
  PetscCall(VecRestoreArrayRead(rate->pressure, &before));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(NoteWears(l, rate->shift, pass));
  PetscCall(NoteLift(l, s, pass->lift));
  PetscCall(VecCopy(s->pressure, rate->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the magnified cycle ---- */

/* Computes the wear of a step per pressure into l->diagonal, and its gap into l->gap. */
static PetscErrorCode FindGap(SamLife l, const SamPass *pass, const SamPass *next)
{
  double *gap, *wears;

  PetscFunctionBegin;
  PetscCall(VecCopy(SamProblemGetGap(l->problem), l->gap));
  PetscCall(SamProblemAddSeparation(l->problem, l->memory, SAM_COMMITTED, l->gap, NULL));
  PetscCall(VecGetArray(l->gap, &gap));
  PetscCall(VecGetArrayWrite(l->diagonal, &wears));
  for (PetscInt i = 0; i < l->grid->cells; i++) {
    gap[i] += pass->lift ? (double)pass->lift[i] : 0;
    wears[i] = 0.5 * (pass->most * (double)pass->wears[i] + next->most * (double)next->wears[i]);
  }
  PetscCall(VecRestoreArrayWrite(l->diagonal, &wears));
  PetscCall(VecRestoreArray(l->gap, &gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes a step that wears `cycles` times, from the pressure before it on, and increases the loads. `scratch`: a
   field. */
static PetscErrorCode Pass(SamLife l, const SamPass *pass, PetscReal cycles, Vec pressure, const SamLoads loads,
                           Vec scratch, PetscBool *solved)
{
  const SamWear  *w    = (const SamWear *)l->law->data;
  const PetscReal unit = w->coefficient[0] + w->coefficient[1];

  PetscFunctionBegin;
  PetscCall(VecScale(l->diagonal, cycles * unit));
  PetscCall(SamLifeSolveNormal(l, pass->balance, cycles, PETSC_TRUE, pressure, solved));
  if (unit == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecPointwiseMult(l->diagonal, l->diagonal, pressure));
  PetscCall(VecAXPY(loads[0], 1 / unit, l->diagonal));
  if (l->loads == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFramesWrite(SamProblemGetElasticity(l->problem), pass->slide, l->diagonal, scratch));
  PetscCall(VecAXPY(loads[1], 1 / unit, scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores the pressure of a step of a jump as a whole. */
static PetscErrorCode KeepPressure(SamLife l, Vec pressure, float kept[])
{
  const double *p;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure, &p));
  for (PetscInt i = 0; i < l->grid->cells; i++) kept[i] = (float)p[i];
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the sums the 1-norms of the difference from the pressure of the second half, and of the latter. */
static PetscErrorCode Compare(SamLife l, const float kept[], Vec pressure, PetscReal sums[2])
{
  const double *p;
  double       *difference;
  PetscReal     norms[2];

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayWrite(l->diagonal, &difference));
  for (PetscInt i = 0; i < l->grid->cells; i++) difference[i] = p[i] - (double)kept[i];
  PetscCall(VecRestoreArrayWrite(l->diagonal, &difference));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(SamGridNorm(l->grid, l->diagonal, NORM_1, &norms[0]));
  PetscCall(SamGridNorm(l->grid, pressure, NORM_1, &norms[1]));
  for (int k = 0; k < 2; k++) sums[k] += norms[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeMagnify(SamLife l, const SamRate *rate, PetscReal cycles, const SamLoads from, SamLoads to,
                              PetscBool *solved)
{
  const SamSolution *s;
  SamLoads           loads;
  PetscReal          before[2], sums[2] = {0, 0};

  PetscFunctionBegin;
  *solved = PETSC_TRUE;
  PetscCall(SamLifeSetLoads(l, from));
  PetscCall(SamLifeGetLoads(l, loads));
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(VecCopy(s->pressure, rate->pressure));
  (void)SamFramesGetSlide(l->memory, SAM_COMMITTED, before);
  for (PetscInt k = 0; k < l->cycle.steps && *solved; k++) {
    const SamPass *pass = &rate->passes[k];

    SamFramesSetSlide(l->memory, pass->slide);
    PetscCall(FindGap(l, pass, &rate->passes[(k + 1) % l->cycle.steps]));
    PetscCall(Pass(l, pass, cycles, rate->pressure, loads, rate->shift, solved));
    if (to == l->whole) PetscCall(KeepPressure(l, rate->pressure, pass->pressure));
    if (to == l->halves) PetscCall(Compare(l, l->start.passes[k].pressure, rate->pressure, sums));
  }
  SamFramesSetSlide(l->memory, before);
  l->apart = sums[1] > 0 ? sums[0] / sums[1] : 0;
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(VecCopy(loads[k], to[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
