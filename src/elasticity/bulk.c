/* The conditions of bulk stress. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/bulk.h>

static const char *const names[2][SAM_BULK_COMPONENTS] = {{"bulk1_stress_xx", "bulk1_stress_yy", "bulk1_stress_xy"},
                                                          {"bulk2_stress_xx", "bulk2_stress_yy", "bulk2_stress_xy"}};

PetscErrorCode SamBulkAddConditions(SamConditions conditions)
{
  char text[64];

  PetscFunctionBegin;
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) {
      const char *const  name = names[body][k];
      const SamCondition one  = {.name     = name,
                                 .unit     = "Pa",
                                 .text     = text,
                                 .group    = "bulk_stress",
                                 .range    = SAM_RANGE_ANY,
                                 .option   = PETSC_TRUE,
                                 .reverses = PETSC_TRUE};

      (void)snprintf(text, sizeof(text), "bulk stress %s of body %d, tension positive", strrchr(name, '_') + 1,
                     (int)body + 1);
      PetscCall(SamConditionsAdd(conditions, &one, NULL));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamCondition *SamBulkCondition(SamConditions conditions, PetscInt body, PetscInt component)
{
  return SamConditionsFind(conditions, names[body][component]);
}

void SamBulkGet(SamConditions conditions, const SamControl *control, PetscInt body,
                PetscReal stress[SAM_BULK_COMPONENTS])
{
  for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++)
    stress[k] = SamControlGet(control, SamBulkCondition(conditions, body, k));
}
