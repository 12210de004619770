/*
  A law that displaces the surfaces: body 2 swells in a sphere below the origin, at a rate, equally in all directions.
  The law remembers the strain at several depths. The surface moves as by a centre of dilatation at the centre of what
  has swollen: by (1 + nu)/pi M d/R^3, d being the way from there along or normal to the surface, and M the integral of
  the strain (R. D. Mindlin, D. H. Cheng, J. Appl. Phys. 21 (1950) 931). For a sphere that is exact.
*/
#include "plugin.h"
#include <petsam/private/lawimpl.h>

#define LAYERS 8
enum { RATE, RADIUS, DEPTH, POISSON, SETTINGS };
static const char *const names[SETTINGS] = {"swelling_rate", "swelling_radius", "swelling_depth", "swelling_poisson"};
static const char *const texts[SETTINGS] = {"strain per time", "of the sphere", "of its centre",
                                            "Poisson's ratio about it"};
static const char *const units[SETTINGS] = {"1/s", "m", "m", NULL};

static const SamStateField strain = {"swelling",
                                     "1",
                                     "strain of the swelling of body 2",
                                     .components  = 1,
                                     .layers      = LAYERS, /* of equal height, from the top of the sphere down */
                                     .generations = 2,
                                     .kept        = PETSC_TRUE,
                                     .result      = SAM_RESULT_OFFERED,
                                     .motion      = SAM_MOVES};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  PetscReal *const s = (PetscReal *)law->data;

  PetscCall(SamOptionsHeading(from, "Swelling"));
  for (int k = 0; k < SETTINGS; k++)
    PetscCall(SamOptionsReal(from, names[k], texts[k], units[k], k == RATE ? SAM_RANGE_ANY : SAM_RANGE_POSITIVE, &s[k],
                             k == RATE ? asked : NULL));
  return 0;
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  for (int k = 0; k < SETTINGS; k++)
    PetscCall(SamParametersAddReals(p, names[k], PETSC_TRUE, 1, (PetscReal *)law->data + k));
  return 0;
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  (void)law;
  return SamStateDeclareField(state, &strain, &(PetscInt){0});
}

/* The place of a value of the field: x, y, and the depth. */
static void GetPlace(SamLaw law, PetscInt k, double at[3])
{
  const PetscReal *const s    = (PetscReal *)law->data;
  const SamGrid          grid = law->grid;

  at[0] = SamGridX(grid, k % grid->nx);
  at[1] = SamGridY(grid, grid->row_start + k % grid->cells / grid->nx);
  at[2] = s[DEPTH] + s[RADIUS] * ((2 * (double)(k / grid->cells) + 1) / LAYERS - 1);
}

/* The strain grows before a step is solved, which then has it. */
static PetscErrorCode Begin(SamLaw law, SamState state, const SamControl *control, PetscReal duration)
{
  const PetscReal *const s      = (PetscReal *)law->data;
  const PetscInt         id     = SamStateFindField(state, strain.name);
  const Vec              before = SamStateGetField(state, id, SAM_COMMITTED);
  PetscScalar           *e;
  double                 at[3];
  Vec                    now;

  (void)control;
  if (duration == 0) return 0;
  PetscCall(SamStateSetField(state, id, &now));
  PetscCall(before ? VecCopy(before, now) : VecSet(now, 0));
  PetscCall(VecGetArray(now, &e));
  for (PetscInt k = 0; k < LAYERS * law->grid->cells; k++) {
    GetPlace(law, k, at);
    if (hypot(hypot(at[0], at[1]), at[2] - s[DEPTH]) < s[RADIUS]) e[k] += s[RATE] * duration;
  }
  law->revision++; /* the pressure has to be solved again */
  return VecRestoreArray(now, &e);
}

/* M in m3, and the centre. The sums, of all rows by one, are the same on any number of ranks. */
static PetscErrorCode GetMoments(SamLaw law, Vec field, double moment[4])
{
  const SamGrid      grid      = law->grid;
  const double       volume    = grid->dx * grid->dy * 2 * ((PetscReal *)law->data)[RADIUS] / LAYERS;
  SamTotal           totals[4] = {{0}};
  const PetscScalar *e;
  double             at[4];

  PetscCall(VecGetArrayRead(field, &e));
  for (PetscInt k = 0; k < LAYERS * grid->cells; k++) {
    GetPlace(law, k, at);
    at[3] = 1;
    for (int m = 0; m < 4; m++) SamAdd(&totals[m], volume * e[k] * at[m]);
  }
  PetscCall(VecRestoreArrayRead(field, &e));
  PetscCall(SamSumTotals(grid->comm, 4, totals, moment));
  for (int m = 0; m < 3; m++) moment[m] = moment[3] != 0 ? moment[m] / moment[3] : 0;
  return 0;
}

/* Of body 2 relative to body 1: where its surface rises, the surfaces come nearer. */
static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t,
                               SamStrain *linear, PetscBool *adds)
{
  const Vec      field = SamStateReadField(state, SamStateFindField(state, strain.name));
  const PetscInt cells = law->grid->cells;
  double         m[4]  = {0}, at[3];
  PetscScalar   *z = NULL, *t = NULL;

  (void)control, (void)linear;
  if (field) PetscCall(GetMoments(law, field, m));
  if (m[3] == 0) return 0;
  if (adds) *adds = PETSC_TRUE;
  if (u_z) PetscCall(VecGetArray(u_z, &z));
  if (u_t) PetscCall(VecGetArray(u_t, &t));
  for (PetscInt k = 0; k < cells; k++) {
    GetPlace(law, k, at);
    const double factor = (1 + ((PetscReal *)law->data)[POISSON]) / PETSC_PI * m[3] /
                          pow(hypot(hypot(at[0] - m[0], at[1] - m[1]), m[2]), 3);
    if (z) z[k] -= factor * m[2];
    for (int c = 0; c < 2 && t; c++) t[k + c * cells] += factor * (at[c] - m[c]);
  }
  if (u_z) PetscCall(VecRestoreArray(u_z, &z));
  return u_t ? VecRestoreArray(u_t, &t) : 0;
}

PetscErrorCode CreateSwelling(SamLaw law)
{
  PetscReal *s;

  PetscCall(PetscMalloc1(SETTINGS, &s));
  s[RATE] = 0, s[RADIUS] = 1e-4, s[DEPTH] = 2e-4, s[POISSON] = 0.3;
  law->data               = s;
  law->option             = names[RATE];
  law->forbids_jumps      = PETSC_TRUE; /* over cycles in which the body would swell */
  law->ops.setfromoptions = SetFromOptions;
  law->ops.addparameters  = AddParameters;
  law->ops.declare        = Declare;
  law->ops.begin          = Begin;
  law->displaces          = PETSC_TRUE;
  law->ops.displace       = Displace;
  return 0;
}
