/*
  Adhesion by a constant tension between the surfaces, which is a lower bound of the pressure: p >= -tension, and in
  contact p > -tension. The tractions of a solution are p + tension >= 0, under the load N + tension times the area; the
  displacement by the tension is that of the law.
*/
#include "trials.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/lawimpl.h>

typedef struct {
  PetscReal tension; /* Pa */
  Vec       u_z;     /* displacement by it, m */
} Adhesion;

static const SamOptionRow row = {"adhesion",
                                 "constant tension between the surfaces",
                                 SAM_OPTION_REAL,
                                 offsetof(Adhesion, tension),
                                 .range    = SAM_RANGE_NONNEGATIVE,
                                 .unit     = "Pa",
                                 .recorded = PETSC_TRUE};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  (void)from;
  *asked = ((Adhesion *)law->data)->tension > 0 ? PETSC_TRUE : PETSC_FALSE;
  return 0;
}

static PetscErrorCode Load(SamLaw law, SamState state, const SamControl *control, PetscReal load[])
{
  const SamGrid   grid = law->grid;
  const PetscReal all  = ((Adhesion *)law->data)->tension * grid->width[0] * grid->width[1];

  (void)state, (void)control;
  load[SAM_COMPONENT_N] += all;
  load[SAM_COMPONENT_MX] -= all * grid->center[1];
  load[SAM_COMPONENT_MY] += all * grid->center[0];
  return 0;
}

static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *e,
                               PetscBool *adds)
{
  Adhesion *const a = (Adhesion *)law->data;
  Vec             tension;

  (void)state, (void)control, (void)u_t, (void)e;
  if (adds) *adds = PETSC_TRUE;
  if (!u_z) return 0;
  if (!a->u_z) {
    PetscCall(SamGridCreateVec(law->grid, 1, &a->u_z));
    PetscCall(SamGridCreateVec(law->grid, 1, &tension));
    PetscCall(VecSet(tension, -a->tension));
    PetscCall(SamElasticityApplyNormal(law->elasticity, tension, a->u_z));
    PetscCall(VecDestroy(&tension));
  }
  return VecAXPY(u_z, 1, a->u_z);
}

static PetscErrorCode Destroy(SamLaw law)
{
  return VecDestroy(&((Adhesion *)law->data)->u_z);
}

PetscErrorCode CreateAdhesion(SamLaw law)
{
  PetscCall(PetscNew((Adhesion **)&law->data));
  law->option             = row.name;
  law->heading            = "Adhesion";
  law->rows               = &row;
  law->row_count          = 1;
  law->displaces          = PETSC_TRUE;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.load           = Load;
  law->ops.displace       = Displace;
  law->ops.destroy        = Destroy;
  return 0;
}
