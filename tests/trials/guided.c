/* A motion: the bodies are guided along the normal of their surfaces, so that they bear no tangential load. */
#include "trials.h"

static PetscErrorCode Check(SamElasticity e, SamConditions conditions, const SamControl *control, PetscReal rolled,
                            const char where[])
{
  (void)conditions;
  PetscCheck(rolled == 0, e->grid->comm, SAM_ERR_USER, "%sroll = %.6g: guided bodies do not roll", where,
             (double)rolled);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    PetscCheck(SamComponentNames[k].creep == NULL || control->value[k] == 0, e->grid->comm, SAM_ERR_USER,
               "%s%s = %.6g: expected 0: the bodies are guided", where, SamComponentNames[k].load,
               (double)control->value[k]);
  return 0;
}

static const SamMotionName names[] = {{"slip_max", "creep_max", "m", "maximum slip of guided bodies"}, {NULL}};

const struct _n_SamMotion Guided = {.word      = "guided",
                                    .continues = PETSC_TRUE,
                                    .way       = SAM_BY_RIGID,
                                    .names     = names,
                                    .work      = "dissipated_energy",
                                    .work_unit = "J",
                                    .slip_unit = " m",
                                    .remedy    = "use smaller load steps",
                                    .check     = Check};
