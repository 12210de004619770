/* What a load step prescribes, and its names. */
#include <petsam/private/baseimpl.h>
#include <petsam/control.h>
#include <string.h>

const SamComponentName SamComponentNames[SAM_COMPONENTS] = {
  {"load_n", "N", "normal force", "disp_z", "m", "rigid-body displacement along z (approach)"},
  {"load_tx", "N", "tangential force along x", "disp_x", "m", "rigid-body displacement along x"},
  {"load_ty", "N", "tangential force along y", "disp_y", "m", "rigid-body displacement along y"},
  {"load_mx", "N m", "moment about x", "rot_x", "rad", "rotation about x"},
  {"load_my", "N m", "moment about y", "rot_y", "rad", "rotation about y"},
  {"load_mz", "N m", "moment about z", "rot_z", "rad", "rotation about z"}};

const SamBulkName SamBulkNames[2][SAM_BULK_COMPONENTS] = {{{"bulk1_stress_xx", "bulk stress xx of body 1"},
                                                           {"bulk1_stress_yy", "bulk stress yy of body 1"},
                                                           {"bulk1_stress_xy", "bulk stress xy of body 1"}},
                                                          {{"bulk2_stress_xx", "bulk stress xx of body 2"},
                                                           {"bulk2_stress_yy", "bulk stress yy of body 2"},
                                                           {"bulk2_stress_xy", "bulk stress xy of body 2"}}};

PetscErrorCode SamControlInitialize(SamControl *control)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(control, sizeof(*control)));
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) control->force[k] = PETSC_TRUE;
  control->friction_scale = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamControlPart(const SamControl *control, PetscInt k)
{
  const PetscInt b = k - SAM_COMPONENTS;

  return b < 0 ? control->value[k] : control->bulk_stress[b / SAM_BULK_COMPONENTS][b % SAM_BULK_COMPONENTS];
}

const char *SamControlPartName(const SamControl *control, PetscInt k)
{
  const PetscInt b = k - SAM_COMPONENTS;

  if (b >= 0) return SamBulkNames[b / SAM_BULK_COMPONENTS][b % SAM_BULK_COMPONENTS].name;
  return control->force[k] ? SamComponentNames[k].load : SamComponentNames[k].rigid;
}

void SamControlPack(const SamControl *control, double n[])
{
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    *n++ = control->force[k];
    *n++ = control->value[k];
  }
  *n++ = control->time;
  *n++ = control->friction_scale;
  for (PetscInt k = 0; k < 2 * SAM_BULK_COMPONENTS; k++)
    *n++ = control->bulk_stress[k / SAM_BULK_COMPONENTS][k % SAM_BULK_COMPONENTS];
}

void SamControlUnpack(const double n[], SamControl *control)
{
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    control->force[k] = *n++ != 0;
    control->value[k] = *n++;
  }
  control->time           = *n++;
  control->friction_scale = *n++;
  for (PetscInt k = 0; k < 2 * SAM_BULK_COMPONENTS; k++)
    control->bulk_stress[k / SAM_BULK_COMPONENTS][k % SAM_BULK_COMPONENTS] = *n++;
}

PetscErrorCode SamControlSet(SamControl *control, const char name[], PetscReal value)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    const PetscBool load = !strcmp(name, SamComponentNames[k].load);

    if (!load && strcmp(name, SamComponentNames[k].rigid)) continue;
    control->force[k] = load;
    control->value[k] = value;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_ARG_UNKNOWN_TYPE, "%s is not the name of a load or displacement", name);
}
