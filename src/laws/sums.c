/* Laws without effect on the solution: sums over all steps of the accumulated slip and the frictional work, cell by
   cell. */
#include <petsam/private/lawimpl.h>

/* Field that a law sums over the steps */
typedef struct {
  SamStateField field;
  const char   *option, *text;
  PetscBool     work; /* true: the frictional work; false: the slip */
} Sum;

#define FIELD(type, unit, text) \
  { \
    type, unit, text, 1, 2, PETSC_TRUE, PETSC_FALSE, SAM_RESULT_OFFERED, SAM_MOVES, 0, PETSC_FALSE \
  }
static const Sum sums[] = {{FIELD(SAM_LAW_ACCUMULATED_SLIP, "m", "accumulated slip: sum of |ds| over all steps"),
                            "sum_slip_path", "accumulate the slip over all steps (field slip_path)", PETSC_FALSE},
                           {FIELD(SAM_LAW_FRICTION_ENERGY, "J/m2", "frictional work: sum of -q.ds over all steps"),
                            "sum_friction_energy",
                            "accumulate the frictional work over all steps (field friction_energy)", PETSC_TRUE}};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  const Sum         *sum = (const Sum *)law->data;
  const SamOptionRow row = {sum->option, sum->text, SAM_OPTION_BOOL, .member = 0};

  PetscFunctionBegin;
  if (!sum->work) PetscCall(SamOptionsHeading(from, "Sums over all steps"));
  PetscCall(SamOptionsRead(from, NULL, 1, &row, asked, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareField(state, &((const Sum *)law->data)->field, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const PetscBool work = ((const Sum *)law->data)->work;

  PetscFunctionBegin;
  PetscCall(SamLawAddToSum(step->state, law->type, step->field[work ? SAM_USE_WORK : SAM_USE_PATH]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamLaw law, const Sum *sum)
{
  PetscFunctionBegin;
  PetscCall(PetscNew((Sum **)&law->data));
  *(Sum *)law->data                                  = *sum;
  law->accumulates                                   = PETSC_TRUE;
  law->bytes                                         = 16;
  law->uses[sum->work ? SAM_USE_WORK : SAM_USE_PATH] = PETSC_TRUE;
  law->ops.setfromoptions                            = SetFromOptions;
  law->ops.declare                                   = Declare;
  law->ops.advance                                   = Advance;
  law->ops.back                                      = SamLawNoBack;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_AccumulatedSlip(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(Create(law, &sums[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_FrictionEnergy(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(Create(law, &sums[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
