/* Bodies that have a memory, or whose surfaces are displaced not only by the tractions: calls the methods of their
   elasticity. */
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/lawimpl.h>

/* Calls a method of each object that has it, with the law's elasticity as `o`. */
#define CALL(law, method, ...) \
  for (SamElasticity o = (law)->elasticity; o; o = o->inner) \
    if (o->ops.method) PetscCall((*o->ops.method)(o, __VA_ARGS__))

static PetscErrorCode AddConditions(SamLaw law, SamConditions conditions)
{
  PetscFunctionBegin;
  CALL(law, conditions, conditions);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  PetscFunctionBegin;
  CALL(law, declare, state);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(SamLaw law, SamState state, const SamControl *control, PetscReal duration)
{
  PetscFunctionBegin;
  PetscCheck(duration >= 0, law->grid->comm, SAM_ERR_USER,
             "time %.6g: goes back by %.6g s, and the bodies remember earlier steps: give later times",
             (double)control->time, -(double)duration);
  CALL(law, begin, state, control, control->sudden ? 0 : duration);
  law->revision++; /* the pressure has to be solved again */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *e,
                               PetscBool *adds)
{
  PetscFunctionBegin;
  (void)e;
  CALL(law, displace, law->conditions, state, control, u_z, u_t, adds);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  PetscFunctionBegin;
  CALL(law, advance, step->state, step->total, step->shear);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Examine(SamLaw law, SamExamination *examination)
{
  PetscFunctionBegin;
  CALL(law, examine, examination);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Doubt(SamLaw law, SamExamination *examination)
{
  PetscFunctionBegin;
  CALL(law, doubt, examination);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Bodies(SamLaw law)
{
  PetscFunctionBegin;
  law->any_motion = PETSC_TRUE;
  law->ops.back   = SamLawNoBack;
  for (SamElasticity o = law->elasticity; o; o = o->inner) {
    if (o->ops.declare || o->ops.conditions || o->ops.begin || o->ops.advance) law->always = PETSC_TRUE;
    if (o->ops.displace) law->always = law->displaces = PETSC_TRUE;
    if (o->ops.begin) law->forbids_jumps = law->remembers = PETSC_TRUE;
    if (o->ops.begin) law->any_motion = PETSC_FALSE;
    if (o->ops.begin) law->ops.back = NULL; /* what it remembers of a step acts in later ones */
    if (o->ops.begin) law->named = o->option ? o->option : "elasticity";
    if (o->traits.skewed) { /* the jumps' own normal problems need a symmetric operator */
      law->always = law->forbids_jumps = law->nonlocal = PETSC_TRUE;
      law->ops.back                                    = NULL;
      law->named                                       = o->option ? o->option : "elasticity";
    }
    law->bytes += o->bytes;
    if (o->ops.conditions) law->ops.conditions = AddConditions;
    if (o->ops.declare) law->ops.declare = Declare;
    if (o->ops.begin) law->ops.begin = Begin;
    if (o->ops.displace) law->ops.displace = Displace;
    if (o->ops.advance) law->ops.advance = Advance;
    if (o->ops.examine) law->ops.examine = Examine;
    if (o->ops.doubt) law->ops.doubt = Doubt;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
