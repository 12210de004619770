/*
  A law: friction fades as the surfaces slide over each other. It multiplies the bound of the shear by
  f + (1 - f) exp(-s/length), s being the slip of all steps, which the law remembers, and of this one.
*/
#include "plugin.h"
#include <petsam/private/lawimpl.h>

typedef struct {
  PetscReal length, final;
} Fading;

static const SamStateField path = {"fading_path",
                                   "m",
                                   "slip under pressure, over all steps",
                                   .components  = 1,
                                   .generations = 2,
                                   .kept        = PETSC_TRUE,
                                   .result      = SAM_RESULT_OFFERED,
                                   .motion      = SAM_MOVES}; /* with the material, where the contact rolls */

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  Fading *f = (Fading *)law->data;

  PetscCall(SamOptionsHeading(from, "Fading friction"));
  PetscCall(SamOptionsReal(from, "fading_length", "slip () by which friction has faded to 1/e", "m",
                           SAM_RANGE_POSITIVE_INF, &f->length, asked));
  return SamOptionsReal(from, "fading_final", "part of it that stays", NULL, SAM_RANGE_NONNEGATIVE, &f->final, NULL);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  PetscCall(SamParametersAddReals(p, "fading_length", PETSC_TRUE, 1, &((Fading *)law->data)->length));
  return SamParametersAddReals(p, "fading_final", PETSC_TRUE, 1, &((Fading *)law->data)->final);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  PetscInt id;

  (void)law;
  return SamStateDeclareField(state, &path, &id);
}

/* The sum of the slip before the step and the slip of the step, where there is pressure. */
static PetscErrorCode Sum(SamLaw law, SamState state, Vec slip, Vec pressure, Vec sum)
{
  const Vec     before = SamStateGetField(state, SamStateFindField(state, path.name), SAM_COMMITTED);
  const double *p;
  double       *s;

  PetscCall(VecSet(sum, 0));
  if (slip) PetscCall(VecCopy(slip, sum));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArray(sum, &s));
  for (PetscInt k = 0; k < law->grid->cells; k++) s[k] = p[k] > 0 ? s[k] : 0;
  PetscCall(VecRestoreArray(sum, &s));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  return before ? VecAXPY(sum, 1, before) : 0;
}

/* The value is that of the laws before this one, by which the derivative of the factor is multiplied. */
static PetscErrorCode Bound(SamLaw law, const SamBoundAt *at, const SamBound *bound)
{
  const Fading *f = (Fading *)law->data;
  Vec           factor;

  PetscCall(SamGridCreateVec(law->grid, 1, &factor));
  PetscCall(Sum(law, at->state, at->slip, at->pressure, factor));
  PetscCall(VecScale(factor, -1 / f->length));
  PetscCall(VecExp(factor));
  PetscCall(VecScale(factor, 1 - f->final));
  PetscCall(VecShift(factor, f->final));
  if (bound->by_slip) PetscCall(VecPointwiseMult(bound->by_slip, bound->by_slip, factor));
  if (bound->by_slip) PetscCall(VecAXPY(bound->by_slip, f->final / f->length, bound->value));
  if (bound->value) PetscCall(VecPointwiseMult(bound->value, bound->value, factor));
  if (bound->by_slip) PetscCall(VecAXPY(bound->by_slip, -1 / f->length, bound->value));
  if (bound->by_pressure) PetscCall(VecPointwiseMult(bound->by_pressure, bound->by_pressure, factor));
  return VecDestroy(&factor);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  Vec sum;

  PetscCall(SamStateSetField(step->state, SamStateFindField(step->state, path.name), &sum));
  return Sum(law, step->state, step->field[SAM_USE_PATH], step->pressure, sum);
}

PetscErrorCode CreateFading(SamLaw law)
{
  PetscCall(PetscNew((Fading **)&law->data));
  ((Fading *)law->data)->length = INFINITY;
  law->option                   = "fading_length";
  law->follows_slip             = PETSC_TRUE; /* the shear and its bound are solved together */
  law->forbids_jumps            = PETSC_TRUE; /* over cycles in which friction would fade */
  law->uses[SAM_USE_PATH]       = PETSC_TRUE;
  law->ops.setfromoptions       = SetFromOptions;
  law->ops.addparameters        = AddParameters;
  law->ops.declare              = Declare;
  law->ops.bound                = Bound;
  law->ops.advance              = Advance;
  return 0;
}
