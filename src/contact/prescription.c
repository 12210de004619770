/*
  What a step prescribes: its control, checked and rounded to earlier ones, the rolled path and the rule of slip. All of
  it is found here, once, before the step is tried; the tried solution holds it for all others.
*/
#include "contactimpl.h"
#include <petsam/private/balance.h>
#include <petsam/private/bodyimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>
#include <math.h>

#define ALIKE 1e-6 /* materials with a smaller Dundurs' constant count as alike */

/* ---- the control ---- */

PetscErrorCode SamContactCheckConditions(SamContact c, const SamControl *control, const char where[])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SamConditionsCount(c->conditions); k++) {
    const SamCondition *one   = SamConditionsGet(c->conditions, k);
    const PetscReal     value = SamControlGet(control, one);

    PetscCheck(SamRangeHas(one->range, value), c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "%s%s = %.6g: expected %s",
               where, one->name, (double)value, SamRangeDescribe(one->range));
    PetscCheck(value == one->usual || !one->couples || SamContactIsCoupled(c), c->grid->comm, SAM_ERR_USER,
               "%s%s = %.6g: expected %.6g, or -coupling full", where, one->name, (double)value, (double)one->usual);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rejects an inconsistent control. Rotations that the elasticity does not have are set to 0. */
static PetscErrorCode CheckControl(SamContact c, SamControl *control)
{
  PetscInt                wrong;
  char                    why[192];
  const SamElasticityType type = SamElasticityGetType(c->elasticity);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    const char *name = SamComponentNameOf(k, SamControlWay(control, k));

    PetscCheck(isfinite(control->value[k]), c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "%s is not a finite number", name);
    if (k < SAM_COMPONENT_MX || c->traits.rotations[k - SAM_COMPONENT_MX]) continue;
    PetscCheck(control->value[k] == 0, c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
               "%s = %.6g: expected 0: bodies of type %s have no such moment or rotation", name,
               (double)control->value[k], type);
    control->force[k] = PETSC_FALSE;
  }
  PetscCheck(!control->force[SAM_COMPONENT_N] || control->value[SAM_COMPONENT_N] >= 0 ||
               SamConditionsPull(c->conditions),
             c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "load_n = %.6g: expected a number >= 0",
             (double)control->value[SAM_COMPONENT_N]);
  PetscCall(SamContactCheckConditions(c, control, ""));
  PetscCall(SamProblemCheckControl(c->problem, control, &wrong, why, sizeof(why)));
  PetscCheck(!why[0], c->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "%s = %.6g: %s",
             SamControlPartName(control, c->conditions, wrong), (double)SamControlPart(control, c->conditions, wrong),
             why);
  PetscCall(SamMotionCheck(c->elasticity, c->conditions, control, ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the same step one cycle before; sets normal loads that differ from its loads, or the last ones, by rounding
   only, to these. */
static void FindKept(SamContact c, SamControl *control, SamCachedStep *kept)
{
  const PetscReal lever  = PetscMin(c->grid->width[0], c->grid->width[1]) / 2;
  SamControl      before = *control;

  SamStepCacheFind(c->cache, control, !SamContactIsCoupled(c), kept);
  if (*kept) SamCachedStepGetControl(*kept, &before);
  SamControlSnap(&before, lever, SAM_BALANCE_NORMAL, control);
  if (SamContactBefore(c)) SamControlSnap(&c->generation[SAM_COMMITTED].control, lever, SAM_BALANCE_NORMAL, control);
}

PetscErrorCode SamContactPrescribe(SamContact c, SamControl *control, SamControl *rounded, SamCachedStep *kept)
{
  PetscFunctionBegin;
  PetscCall(CheckControl(c, control));
  *rounded = *control;
  FindKept(c, rounded, kept);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the rule of slip ---- */

/* Loads or displacements lie on a line if their directions differ by less. */
#define SAME_DIRECTION 1e-10

/*
  Finds out whether all causes of shear so far, including this step, lie on one line: tangential loads or displacements
  without moment, while neither pressure, nor strain, nor a law shears the bodies. Then the shear keeps its direction.
*/
static PetscErrorCode LieOnLine(SamContact c, const SamSolution *s, PetscBool *on)
{
  const SamControl *const control = &s->control;
  double *const           n       = SamStateNumbers(c->state, c->slip, SAM_TRIED);
  const double            x = (double)control->value[SAM_COMPONENT_TX], y = (double)control->value[SAM_COMPONENT_TY];
  PetscBool               strained, other_way;
  SamStrain               e;

  PetscFunctionBegin;
  PetscCall(SamProblemDisplace(c->problem, NULL, control, NULL, NULL, &e, NULL));
  strained  = c->grid->axes > 1 && (e.xx != 0 || e.yy != 0 || e.xy != 0);
  other_way = x != 0 && y != 0 && SamControlWay(control, SAM_COMPONENT_TX) != SamControlWay(control, SAM_COMPONENT_TY);
  if (n[SAM_SLIP_LINE_X] == 0 && n[SAM_SLIP_LINE_Y] == 0) {
    n[SAM_SLIP_LINE_X] = x;
    n[SAM_SLIP_LINE_Y] = y;
  }
  if (SamContactIsCoupled(c) || s->rolled != 0 || SamProblemDisplaces(c->problem) || strained || other_way ||
      control->value[SAM_COMPONENT_MZ] != 0 ||
      fabs(n[SAM_SLIP_LINE_X] * y - n[SAM_SLIP_LINE_Y] * x) >
        SAME_DIRECTION * hypot(n[SAM_SLIP_LINE_X], n[SAM_SLIP_LINE_Y]) * hypot(x, y))
    n[SAM_SLIP_LEFT] = 1;
  *on = n[SAM_SLIP_LEFT] == 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool HasContact(const SamSolution *before)
{
  return before && before->load[SAM_COMPONENT_N] > 0;
}

/* True if pressure moves the surfaces along each other because the materials differ, not only because of the shapes. */
static PetscBool AreDissimilar(SamContact c)
{
  return SamContactIsCoupled(c) && fabs((double)SamElasticityGetPair(c->elasticity)->dundurs) > ALIKE;
}

/* True if there is contact, and it may grow: by the normal load, or by an approach whose load is not known yet. */
static PetscBool MayGrow(const SamSolution *before, const SamControl *control)
{
  return HasContact(before) &&
         !(control->force[SAM_COMPONENT_N] && control->value[SAM_COMPONENT_N] <= SamSolutionGetNormal(before));
}

/* True if, in a step from no contact, nothing moves the bodies along each other; otherwise N is applied before the
   rest. */
static PetscBool AppliesOnlyNormal(const SamSolution *before, const SamControl *control)
{
  PetscBool only = PETSC_TRUE;

  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt  n    = SamComponentsOf[SAM_BALANCE_TANGENTIAL][k];
    const PetscReal rest = before && !control->force[n] ? before->rigid[n] : 0;

    only = only && control->value[n] == rest;
  }
  return only;
}

PetscErrorCode SamContactFindRule(SamContact c, SamSolution *s)
{
  const SamSolution *before   = SamContactBefore(c);
  const SamControl  *to       = &s->control;
  PetscBool          straight = PETSC_FALSE, usual;

  PetscFunctionBegin;
  PetscCall(LieOnLine(c, s, &straight));
  usual = c->set.slip_direction == SAM_SLIP_MID && c->motion->continues && s->rolled == 0;
  if (!usual)
    s->rule = straight ? SAM_RULE_END_LINE : SAM_RULE_END;
  else if (AreDissimilar(c) &&
           (MayGrow(before, to) || (!HasContact(before) && (to->together || AppliesOnlyNormal(before, to)))))
    s->rule = before ? SAM_RULE_MID_TOUCHING : SAM_RULE_TOUCHING;
  else
    s->rule = straight || !before ? SAM_RULE_LINE : SAM_RULE_MID;
  PetscFunctionReturn(PETSC_SUCCESS);
}
