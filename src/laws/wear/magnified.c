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

/* Computes a step's wear load (Pa m, or J/m2), its slip (m), and the wear load per slip and pressure. */
static PetscErrorCode FindWear(SamLife l, const SamSolution *s, Vec load, Vec slip, Vec unit)
{
  const PetscBool  by_energy = ((const SamWear *)l->law->data)->by_energy;
  const SamBoundAt at        = {l->memory, &s->control, s->pressure, slip, 0};

  PetscFunctionBegin;
  PetscCall(SamContactComputeFriction(l->contact, slip, by_energy ? NULL : load, by_energy ? load : NULL));
  PetscCall(VecSet(unit, 1));
  if (by_energy) PetscCall(SamProblemComputeBound(l->problem, &at, &(SamBound){.by_pressure = unit}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacement of the surfaces in a step by other causes than the pressure: u_z - S p. */
static PetscErrorCode NoteLift(SamLife l, const SamSolution *s, float lift[])
{
  const double *all, *own;
  Vec           by_pressure; /* S p, m */

  PetscFunctionBegin;
  if (!lift) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamPoolTake(l->pool, &by_pressure));
  PetscCall(SamElasticityApplyNormal(SamProblemGetElasticity(l->problem), s->pressure, by_pressure));
  PetscCall(VecGetArrayRead(s->displacement_z, &all));
  PetscCall(VecGetArrayRead(by_pressure, &own));
  for (PetscInt i = 0; i < l->grid->cells; i++) lift[i] = (float)(all[i] - own[i]);
  PetscCall(VecRestoreArrayRead(by_pressure, &own));
  PetscCall(VecRestoreArrayRead(s->displacement_z, &all));
  PetscCall(SamPoolGive(l->pool, &by_pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores a field as floats relative to its maximum: so a slip that is the same everywhere keeps all digits. */
static PetscErrorCode NoteWears(SamGrid grid, Vec field, SamPass *pass)
{
  const double *values;
  PetscReal     most;

  PetscFunctionBegin;
  PetscCall(VecMax(field, NULL, &most));
  pass->most = (double)most;
  PetscCall(VecGetArrayRead(field, &values));
  for (PetscInt i = 0; i < grid->cells; i++) pass->wears[i] = (float)(most > 0 ? values[i] / pass->most : 0);
  PetscCall(VecRestoreArrayRead(field, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to a cycle's coefficient the wear load of a step per pressure, m, and keeps it. */
static PetscErrorCode AddWears(SamLife l, const SamSolution *s, Vec before, SamRate *rate, SamPass *pass)
{
  enum { LOAD, SLIP, UNIT, PER_PRESSURE, FIELDS };
  const double *p, *p0, *load, *path, *unit;
  double       *wears, *sum;
  Vec           own[FIELDS];

  PetscFunctionBegin;
  for (int k = 0; k < FIELDS; k++) PetscCall(SamPoolTake(l->pool, &own[k]));
  PetscCall(FindWear(l, s, own[LOAD], own[SLIP], own[UNIT]));
  if (rate == &l->start) PetscCall(SamLifeNoteStride(l, own[LOAD], before, s->pressure));
  PetscCall(VecGetArrayRead(s->pressure, &p));
  PetscCall(VecGetArrayRead(before, &p0));
  PetscCall(VecGetArrayRead(own[LOAD], &load));
  PetscCall(VecGetArrayRead(own[SLIP], &path));
  PetscCall(VecGetArrayRead(own[UNIT], &unit));
  PetscCall(VecGetArrayWrite(own[PER_PRESSURE], &wears));
  PetscCall(VecGetArray(rate->coefficient, &sum));
  for (PetscInt i = 0; i < l->grid->cells; i++) {
    const double mean = 0.5 * (p0[i] + p[i]);

    wears[i] = mean > 0 ? fabs(load[i]) / mean : unit[i] * path[i];
    sum[i] += mean > 0 ? wears[i] : 0;
  }
  PetscCall(VecRestoreArray(rate->coefficient, &sum));
  PetscCall(VecRestoreArrayWrite(own[PER_PRESSURE], &wears));
  PetscCall(VecRestoreArrayRead(own[UNIT], &unit));
  PetscCall(VecRestoreArrayRead(own[SLIP], &path));
  PetscCall(VecRestoreArrayRead(own[LOAD], &load));
  PetscCall(VecRestoreArrayRead(before, &p0));
  PetscCall(VecRestoreArrayRead(s->pressure, &p));
  PetscCall(NoteWears(l->grid, own[PER_PRESSURE], pass));
  for (int k = 0; k < FIELDS; k++) PetscCall(SamPoolGive(l->pool, &own[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeNotePass(SamLife l, PetscInt k, const SamStep *step, Vec before, SamRate *rate)
{
  SamPass *const     pass = &rate->passes[k];
  const SamSolution *s;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(l->contact, &s));
  pass->balance = SamControlGetBalance(&step->control, SAM_BALANCE_NORMAL);
  (void)SamFramesGetSlide(l->memory, SAM_TRIED, pass->slide);
  PetscCall(AddWears(l, s, before, rate, pass));
  PetscCall(NoteLift(l, s, pass->lift));
  PetscCall(VecCopy(s->pressure, before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the magnified cycle ---- */

/* Computes the gap of a step (m), and how it yields (m/Pa) to surfaces that wear `times` a wear load. */
static PetscErrorCode FindGap(SamLife l, const SamPass *pass, const SamPass *next, PetscReal times, Vec gap, Vec yield)
{
  double *h, *yields;

  PetscFunctionBegin;
  PetscCall(VecCopy(SamProblemGetGap(l->problem), gap));
  PetscCall(SamProblemAddSeparation(l->problem, l->memory, SAM_COMMITTED, gap, NULL));
  PetscCall(VecGetArray(gap, &h));
  PetscCall(VecGetArrayWrite(yield, &yields));
  for (PetscInt i = 0; i < l->grid->cells; i++) {
    const double wears = 0.5 * (pass->most * (double)pass->wears[i] + next->most * (double)next->wears[i]);

    h[i] += pass->lift ? (double)pass->lift[i] : 0;
    yields[i] = (double)times * wears;
  }
  PetscCall(VecRestoreArrayWrite(yield, &yields));
  PetscCall(VecRestoreArray(gap, &h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Increases the loads by the wear of a step, in which the surfaces have yielded to the pressure. */
static PetscErrorCode AddWorn(SamLife l, const SamPass *pass, Vec yield, Vec pressure, PetscReal unit,
                              const SamLoads loads)
{
  Vec depth, written; /* m, at the points of body 1 and of body 2 */

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &depth));
  PetscCall(VecPointwiseMult(depth, yield, pressure));
  PetscCall(VecAXPY(loads[0], 1 / unit, depth));
  if (l->loads > 1) {
    PetscCall(SamPoolTake(l->pool, &written));
    PetscCall(SamFramesWrite(SamProblemGetElasticity(l->problem), pass->slide, depth, written));
    PetscCall(VecAXPY(loads[1], 1 / unit, written));
    PetscCall(SamPoolGive(l->pool, &written));
  }
  PetscCall(SamPoolGive(l->pool, &depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes a step that wears `cycles` times, from the pressure before it on, and increases the loads. */
static PetscErrorCode Pass(SamLife l, const SamPass *pass, const SamPass *next, PetscReal cycles, Vec pressure,
                           const SamLoads loads, PetscBool *solved)
{
  const SamWear  *w    = (const SamWear *)l->law->data;
  const PetscReal unit = w->coefficient[0] + w->coefficient[1];
  Vec             gap, yield;

  PetscFunctionBegin;
  PetscCall(SamPoolTake(l->pool, &gap));
  PetscCall(SamPoolTake(l->pool, &yield));
  PetscCall(FindGap(l, pass, next, cycles * unit, gap, yield));
  PetscCall(SamLifeSolveNormal(l, gap, yield, pass->balance, cycles, PETSC_TRUE, pressure, solved));
  if (unit != 0) PetscCall(AddWorn(l, pass, yield, pressure, unit, loads));
  PetscCall(SamPoolGive(l->pool, &yield));
  PetscCall(SamPoolGive(l->pool, &gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores the pressure of a step of a jump as a whole. */
static PetscErrorCode KeepPressure(SamGrid grid, Vec pressure, float kept[])
{
  const double *p;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure, &p));
  for (PetscInt i = 0; i < grid->cells; i++) kept[i] = (float)p[i];
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the sums the 1-norms of the difference from the pressure of the second half, and of the latter. */
static PetscErrorCode Compare(SamGrid grid, SamPool pool, const float kept[], Vec pressure, PetscReal sums[2])
{
  const double *p;
  double       *difference;
  PetscReal     norms[2];
  Vec           change; /* Pa */

  PetscFunctionBegin;
  PetscCall(SamPoolTake(pool, &change));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayWrite(change, &difference));
  for (PetscInt i = 0; i < grid->cells; i++) difference[i] = p[i] - (double)kept[i];
  PetscCall(VecRestoreArrayWrite(change, &difference));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(SamGridNorm(grid, change, NORM_1, &norms[0]));
  PetscCall(SamGridNorm(grid, pressure, NORM_1, &norms[1]));
  PetscCall(SamPoolGive(pool, &change));
  for (int k = 0; k < 2; k++) sums[k] += norms[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeMagnify(SamLife l, const SamRate *rate, PetscReal cycles, const SamLoads from, SamLoads to,
                              PetscBool *solved)
{
  const SamSolution *s;
  SamLoads           loads;
  PetscReal          before[2], sums[2] = {0, 0};
  Vec                pressure; /* at the end of the last step, Pa */

  PetscFunctionBegin;
  *solved = PETSC_TRUE;
  PetscCall(SamLifeSetLoads(l, from));
  PetscCall(SamLifeGetLoads(l, loads));
  PetscCall(SamContactGetSolution(l->contact, &s));
  PetscCall(SamPoolTake(l->pool, &pressure));
  PetscCall(VecCopy(s->pressure, pressure));
  (void)SamFramesGetSlide(l->memory, SAM_COMMITTED, before);
  for (PetscInt k = 0; k < l->cycle.steps && *solved; k++) {
    const SamPass *pass = &rate->passes[k];

    SamFramesSetSlide(l->memory, pass->slide);
    PetscCall(Pass(l, pass, &rate->passes[(k + 1) % l->cycle.steps], cycles, pressure, loads, solved));
    if (to == l->whole) PetscCall(KeepPressure(l->grid, pressure, pass->pressure));
    if (to == l->halves) PetscCall(Compare(l->grid, l->pool, l->start.passes[k].pressure, pressure, sums));
  }
  PetscCall(SamPoolGive(l->pool, &pressure));
  SamFramesSetSlide(l->memory, before);
  l->apart = sums[1] > 0 ? sums[0] / sums[1] : 0;
  for (PetscInt k = 0; k < l->loads; k++) PetscCall(VecCopy(loads[k], to[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
