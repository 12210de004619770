/*
  Steady rolling towards +x: each load step is a steady state by itself, solved by the operator of the shear's
  differences along x (elasticity/steadyoperator.c). The numbers of a step are per 1 m of rolled distance.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/base.h>

/* The volume removed of a body, by its number in /history or in /wear */
#define VOLUME(name, body) \
  { \
    name #body, name #body, "m2", "volume removed of body " #body " per length of its running band" \
  }

static const SamMotionName names[] = {
  {"slip_x", "slip_velocity_x", "1", "slip velocity along x, relative to the rolling speed"},
  {"slip_y", "slip_velocity_y", "1", "slip velocity along y, relative to the rolling speed"},
  {"slip_max", "slip_velocity_max", "1",
   "maximum slip velocity in contact, also at its edge between cells, relative to that of rolling"},
  {"dissipated_energy", "rolling_energy_cells", "J/m", "frictional work per rolled distance, summed over cells"},
  VOLUME("wear_volume", 1),
  VOLUME("wear_volume", 2),
  VOLUME("volume", 1),
  VOLUME("volume", 2),
  {"displacement", NULL, NULL, NULL}, /* the displacement of bodies at rest is not computed */
  {NULL, NULL, NULL, NULL}};

static PetscErrorCode Wrap(SamElasticity bodies, const SamOptions *from, SamElasticity *moving)
{
  SamElasticity inner = bodies;

  PetscFunctionBegin;
  while (inner->wraps) inner = inner->inner;
  PetscCheck(!bodies->traits.periodic, from->comm, SAM_ERR_USER,
             "-%srolling steady: has no meaning with -%selasticity %s, whose contact has no leading edge",
             SamOptionsPrefix(from), SamOptionsPrefix(from), inner->type);
  PetscCheck(
    !bodies->traits.patch, from->comm, SAM_ERR_USER,
    "-%srolling steady: has no meaning with -body1_compliance or -body2_compliance, whose bodies have a place: "
    "omit one of them",
    SamOptionsPrefix(from));
  for (SamElasticity e = bodies; e; e = e->inner)
    if (e->ops.stream) PetscCall((*e->ops.stream)(e, from));
  PetscCall(SamElasticityCreateRolling(bodies, moving));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Check(SamElasticity e, SamConditions conditions, const SamControl *control, PetscReal rolled,
                            const char where[])
{
  PetscFunctionBegin;
  (void)conditions;
  PetscCheck(rolled == 0, e->grid->comm, SAM_ERR_USER,
             "%sroll = %.6g: has no meaning with -rolling steady: omit one of them", where, (double)rolled);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    PetscCheck(!SamComponentNames[k].creep || SamControlWay(control, k) != SAM_BY_RIGID ||
                 (k >= SAM_COMPONENT_MX && !e->traits.rotations[k - SAM_COMPONENT_MX]),
               e->grid->comm, SAM_ERR_USER, "%s has no meaning with -rolling steady: give %s or %s",
               SamComponentNames[k].rigid, SamComponentNames[k].creep, SamComponentNames[k].load);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const struct _n_SamMotion SamMotionSteady = {.word         = "steady",
                                             .streams      = PETSC_TRUE,
                                             .way          = SAM_BY_CREEP,
                                             .names        = names,
                                             .work         = "rolling_energy",
                                             .work_unit    = "J/m",
                                             .slip_unit    = " of the rolling speed",
                                             .slip_heading = "slip/V",
                                             .remedy       = "use a longer memory of the friction",
                                             .meaningless  = {[SAM_MOTION_HISTORY] = "where no step continues another",
                                                              [SAM_MOTION_STIFFNESS] =
                                                                "where loads follow from creepages"},
                                             .wrap         = Wrap,
                                             .check        = Check};
