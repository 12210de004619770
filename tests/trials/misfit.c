/*
  A law with a tangential displacement and a stress over the depth: body 2 would stretch by a misfit strain along its
  surface, and is prevented by a stress that fades like exp(-z/depth). Both are fields, though their closed form needs
  none.
*/
#include "trials.h"
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/state.h>

#define LAYERS 6
typedef struct {
  PetscReal strain, depth; /* 1, m */
} Misfit;

static const SamOptionRow rows[] = {
  {"misfit_strain", "strain that body 2 would have along its surface", SAM_OPTION_REAL, offsetof(Misfit, strain),
   .range = SAM_RANGE_ANY, .recorded = PETSC_TRUE},
  {"misfit_depth", "depth at which its stress has fallen to 1/e", SAM_OPTION_REAL, offsetof(Misfit, depth),
   .range = SAM_RANGE_POSITIVE, .unit = "m", .recorded = PETSC_TRUE}};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  (void)from;
  *asked = ((Misfit *)law->data)->strain != 0 ? PETSC_TRUE : PETSC_FALSE;
  return 0;
}

static PetscErrorCode Compute(void *owner, SamState state, PetscInt component, Vec field)
{
  const SamLaw        law  = (SamLaw)owner;
  const Misfit *const m    = (const Misfit *)law->data;
  const PetscInt      n    = law->grid->cells;
  const SamBodyPlace  body = SamBodyAt(SamPairBody(SamElasticityGetPair(law->elasticity), 1), 0);
  double             *s;

  (void)state;
  PetscCall(VecGetArray(field, &s));
  for (PetscInt k = 0; k < LAYERS * n; k++)
    s[k] = component > SAM_STRESS_YY
             ? 0
             : -body.young * m->strain / (1 - body.poisson) * exp(-((double)(k / n) + 0.5) * 2 / LAYERS);
  return VecRestoreArray(field, &s);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const char *const names[] = {"misfit/residual_stress_xx", "misfit/residual_stress_yy",
                                      "misfit/residual_stress_zz", "misfit/residual_stress_xy",
                                      "misfit/residual_stress_xz", "misfit/residual_stress_yz"};
  PetscReal                z[LAYERS];

  for (int l = 0; l < LAYERS; l++) z[l] = (l + 0.5) * 2 / LAYERS * ((Misfit *)law->data)->depth;
  PetscCall(SamStateSetLayers(
    state, &(SamStateLayers){.group = "misfit", .count = {0, LAYERS}, .z = z, .stresses = PETSC_TRUE}));
  for (int c = 0; c < SAM_STRESS_COMPONENTS; c++)
    PetscCall(SamStateOffer(state, &(SamStateResult){.name      = names[c],
                                                     .unit      = "Pa",
                                                     .text      = "stress by misfit",
                                                     .kind      = SAM_FIELD_LAYERS,
                                                     .use       = SAM_RESULT_OFFERED,
                                                     .compute   = Compute,
                                                     .owner     = law,
                                                     .component = c}));
  return 0;
}

static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *e,
                               PetscBool *adds)
{
  const PetscReal strain = ((Misfit *)law->data)->strain;
  const SamGrid   g      = law->grid;
  double         *u;

  (void)state, (void)control, (void)u_z, (void)e;
  if (adds) *adds = PETSC_TRUE;
  if (!u_t) return 0;
  PetscCall(VecGetArray(u_t, &u));
  for (PetscInt k = 0; k < g->cells; k++) {
    u[k] += strain * SamGridX(g, k % g->nx);
    u[k + g->cells] += strain * SamGridY(g, g->row_start + k / g->nx);
  }
  return VecRestoreArray(u_t, &u);
}

PetscErrorCode CreateMisfit(SamLaw law)
{
  PetscCall(PetscNew((Misfit **)&law->data));
  law->heading            = "Misfit";
  law->rows               = rows;
  law->row_count          = 2;
  law->option             = rows[0].name;
  law->displaces          = PETSC_TRUE;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.declare        = Declare;
  law->ops.displace       = Displace;
  law->ops.back           = SamLawNoBack;
  return 0;
}
