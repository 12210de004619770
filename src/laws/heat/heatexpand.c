/*
  Thermal displacement: frictional heat expands the bodies, which displaces their surfaces, and so changes the pressure
  and the slip by which it arises.

  The pressure gives the heat, the heat the displacement of the surfaces (expansion.c), and that the gap and the slip of
  the next pass. The passes x <- g(x), x being the displacement, are accelerated by Anderson's method in cells in contact
  (ground/grid/mixing.c): 5 to 9 of them for a sphere whose contact shrinks to three quarters. Where heat moves the
  surfaces farther than the pressure flattens them, as it does in long flat contacts, there is no steady state, and none
  is found.

  Source: Barber 1984, J. Appl. Mech. 51, 636-640; Burton, Nerlikar and Kilaparti 1973, Wear 24, 177-188.
*/
#include "heatlaw.h"
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/control.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/state.h>
#include <math.h>

#define RTOL          1e-7 /* change of the displacement in a pass, over the largest displacement */
#define MOST          50   /* passes */
#define MOST_STRAIN   1e-2 /* 1/K */
#define DISPLACEMENT  "thermal_displacement"
#define DISPLACEMENTZ "thermal_displacement_z"

enum { MAXIMUM, PASSES, NUMBERS };
static const char *const maximum = "thermal_displacement_max";

/* ---- options ---- */

/* Rejects an approach that is given where a body stands, whose displacement has no datum. */
static PetscErrorCode Check(SamLaw law, SamControl *control, PetscInt *wrong, char why[], size_t size)
{
  const SamHeatLaw *h = (const SamHeatLaw *)law->data;

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++)
    if (h->expansion[b] != 0 && h->speed[b] == 0 && SamControlWay(control, SAM_COMPONENT_N) == SAM_BY_RIGID) {
      *wrong = SAM_COMPONENT_N;
      (void)snprintf(why, size,
                     "has no meaning with -body%d_expansion of a body that stands, whose heat displaces all of it "
                     "without limit: give load_n",
                     b + 1);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes how the surfaces of both bodies move relative to each other; adds nothing before the first step. */
static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *e,
                               PetscBool *adds)
{
  Vec z, t;

  PetscFunctionBegin;
  (void)law;
  (void)control;
  (void)e;
  if (!state || !(u_z || u_t || adds)) PetscFunctionReturn(PETSC_SUCCESS);
  z = SamStateReadField(state, SamStateFindField(state, DISPLACEMENTZ));
  t = SamStateReadField(state, SamStateFindField(state, DISPLACEMENT));
  if (!z || !t) PetscFunctionReturn(PETSC_SUCCESS);
  if (adds) {
    PetscReal most[2];

    PetscCall(VecNorm(z, NORM_INFINITY, &most[0]));
    PetscCall(VecNorm(t, NORM_INFINITY, &most[1]));
    if (most[0] > 0 || most[1] > 0) *adds = PETSC_TRUE;
  }
  if (u_z) PetscCall(VecAXPY(u_z, 1, z));
  if (u_t) PetscCall(VecAXPY(u_t, 1, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- passes ---- */

/* Creates the operators at their first use; bodies in which heat moves alike share one. */
static PetscErrorCode Prepare(SamLaw law)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;
  const PetscBool   alike =
    h->speed[0] == h->speed[1] && h->conductivity[0] * h->capacity[1] == h->conductivity[1] * h->capacity[0];

  PetscFunctionBegin;
  PetscCall(SamHeatLawPrepare(law));
  if (!h->mixing) PetscCall(SamMixingCreate(law->grid, 3, &h->mixing));
  for (int b = 0; b < 2; b++) {
    const SamHeatBody body = {h->conductivity[b], h->capacity[b], h->speed[b]};

    if (h->expansion[b] == 0 || h->expander[b]) continue;
    if (b && alike && h->expander[0])
      h->expander[1] = h->expander[0];
    else
      PetscCall(SamExpanderCreate(law->grid, NULL, &body, &h->expander[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacement of body 2 relative to body 1 by the heat of a solution; z points into body 2. */
static PetscErrorCode ComputeDisplacement(SamLaw law, SamLawContact *contact, Vec z, Vec t)
{
  SamHeatLaw *const h       = (SamHeatLaw *)law->data;
  Vec               into[2] = {NULL}, none[2] = {NULL, NULL};

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) PetscCall(SamGridCreateVec(law->grid, 1, &into[b]));
  PetscCall(SamHeatLawFill(law, contact->pressure, contact->work, into[0]));
  PetscCall(SamHeatTemperatures(&h->pair, contact->pressure, into[0], h->bulk, into[1], none, contact->failed,
                                sizeof(contact->failed)));
  PetscCall(VecAXPY(into[0], -1, into[1]));
  PetscCall(VecSet(z, 0));
  PetscCall(VecSet(t, 0));
  for (int b = 0; b < 2; b++) {
    const SamMaterial *m = SamBodySubstrate(SamPairBody(SamElasticityGetPair(law->elasticity), b));
    const PetscReal    c = (1 + m->poisson) * h->expansion[b] / h->conductivity[b];

    if (h->expander[b]) PetscCall(SamExpanderAdd(h->expander[b], into[b], -c, b ? c : -c, z, t));
    PetscCall(VecDestroy(&into[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the three components of a displacement to a vector for the mixing, or back. */
static PetscErrorCode Pack(SamGrid grid, Vec z, Vec t, Vec all, PetscBool back)
{
  const PetscInt n = grid->cells;
  double        *u[3];

  PetscFunctionBegin;
  PetscCall(VecGetArray(z, &u[0]));
  PetscCall(VecGetArray(t, &u[1]));
  PetscCall(VecGetArray(all, &u[2]));
  PetscCall(PetscArraycpy(back ? u[0] : u[2], back ? u[2] : u[0], n));
  PetscCall(PetscArraycpy(back ? u[1] : u[2] + n, back ? u[2] + n : u[1], 2 * n));
  PetscCall(VecRestoreArray(all, &u[2]));
  PetscCall(VecRestoreArray(t, &u[1]));
  PetscCall(VecRestoreArray(z, &u[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the largest difference of two fields of three components in contact, and the largest value of the second. */
static PetscErrorCode Compare(SamGrid grid, Vec pressure, Vec was, Vec is, double *change, double *largest)
{
  const double *p, *a, *b;
  double        most[2] = {0};

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(was, &a));
  PetscCall(VecGetArrayRead(is, &b));
  for (PetscInt k = 0; k < 3 * grid->cells; k++) {
    if (!(p[k % grid->cells] > 0)) continue;
    most[0] = PetscMax(most[0], fabs(b[k] - a[k]));
    most[1] = PetscMax(most[1], fabs(b[k]));
  }
  PetscCall(VecRestoreArrayRead(is, &b));
  PetscCall(VecRestoreArrayRead(was, &a));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(SamMax(grid->comm, 2, most));
  *change  = most[0];
  *largest = most[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the tried displacement for writing; before the first pass of a step it is that of the step before. */
static PetscErrorCode TakeTried(SamLaw law, SamState state, Vec *z, Vec *t)
{
  const PetscInt id[2] = {SamStateFindField(state, DISPLACEMENTZ), SamStateFindField(state, DISPLACEMENT)};
  Vec *const     to[2] = {z, t};

  PetscFunctionBegin;
  (void)law;
  for (int k = 0; k < 2; k++) {
    const Vec tried = SamStateGetField(state, id[k], SAM_TRIED), last = SamStateGetField(state, id[k], SAM_COMMITTED);

    PetscCall(SamStateSetField(state, id[k], to[k]));
    if (!tried) PetscCall(last ? VecCopy(last, *to[k]) : VecSet(*to[k], 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Follow(SamLaw law, SamLawContact *contact, PetscBool *again)
{
  SamHeatLaw *const h      = (SamHeatLaw *)law->data;
  const SamGrid     g      = law->grid;
  double            change = 0, largest = 0;
  Vec               tried[2], next[2], argument, result;

  PetscFunctionBegin;
  if (!contact->solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Prepare(law));
  PetscCall(TakeTried(law, contact->state, &tried[0], &tried[1]));
  for (PetscInt k = 0; k < 2; k++) PetscCall(SamGridCreateVec(g, k + 1, &next[k]));
  PetscCall(SamGridCreateVec(g, 3, &argument));
  PetscCall(SamGridCreateVec(g, 3, &result));
  PetscCall(ComputeDisplacement(law, contact, next[0], next[1]));
  PetscCall(Pack(g, tried[0], tried[1], argument, PETSC_FALSE));
  PetscCall(Pack(g, next[0], next[1], result, PETSC_FALSE));
  PetscCall(Compare(g, contact->pressure, argument, result, &change, &largest));
  *again = change > RTOL * largest && !contact->failed[0] ? PETSC_TRUE : PETSC_FALSE;
  if (*again && ++h->passes > MOST) {
    *again = PETSC_FALSE;
    (void)snprintf(contact->failed, sizeof(contact->failed),
                   "the thermal displacement did not converge with the pressure in %d passes, the last change is %.2g: "
                   "where heat moves the surfaces more than pressure does, there is no steady state",
                   MOST, largest > 0 ? change / largest : 0);
  }
  if (*again) {
    PetscCall(SamMixingNext(h->mixing, contact->pressure, result, argument));
    PetscCall(Pack(g, tried[0], tried[1], argument, PETSC_TRUE));
  } else {
    SamMixingRestart(h->mixing); /* the next passes may be those of other conditions */
  }
  PetscCall(VecDestroy(&result));
  PetscCall(VecDestroy(&argument));
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&next[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- parts of the law's methods ---- */

PetscErrorCode SamHeatLawExpand(SamLaw law, const SamOptions *from)
{
  const SamHeatLaw *h      = (const SamHeatLaw *)law->data;
  const char *const prefix = SamOptionsPrefix(from);

  PetscFunctionBegin;
  if (!SamHeatLawExpands(h)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int b = 0; b < 2; b++) {
    const SamMaterial *m = SamBodySubstrate(SamPairBody(SamElasticityGetPair(law->elasticity), b));

    PetscCheck(fabs((double)h->expansion[b]) <= MOST_STRAIN, from->comm, SAM_ERR_USER,
               "-%sbody%d_expansion %.6g: expected at most %g 1/K; steel has 12e-6", prefix, b + 1,
               (double)h->expansion[b], MOST_STRAIN);
    PetscCheck(h->expansion[b] == 0 || isfinite(m->young), from->comm, SAM_ERR_USER,
               "-%sbody%d_expansion: body %d is rigid and does not expand: omit it", prefix, b + 1, b + 1);
  }
  PetscCheck(!SamElasticityGetTraits(law->elasticity).plane, from->comm, SAM_ERR_USER,
             "-%sbody%d_expansion in plane strain: the displacement along the surface has no datum there: use "
             "-elasticity halfspace",
             prefix, h->expansion[0] != 0 ? 1 : 2);
  law->displaces    = PETSC_TRUE;
  law->ops.displace = Displace;
  law->ops.follow   = Follow;
  law->ops.check    = Check;
  law->bytes += 320;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawDeclareExpansion(SamLaw law, SamState state)
{
  static const SamStateField  fields[]         = {{.name        = DISPLACEMENTZ,
                                                   .unit        = "m",
                                                   .text        = "thermal displacement, body 2's surface from body 1's",
                                                   .components  = 1,
                                                   .generations = 2,
                                                   .kept        = PETSC_TRUE,
                                                   .result      = SAM_RESULT_USUAL,
                                                   .motion      = SAM_STAYS,
                                                   .separates   = PETSC_TRUE},
                                                  {.name        = DISPLACEMENT,
                                                   .unit        = "m",
                                                   .text        = "thermal displacement, body 2's surface over body 1's",
                                                   .components  = 2,
                                                   .generations = 2,
                                                   .kept        = PETSC_TRUE,
                                                   .result      = SAM_RESULT_OFFERED,
                                                   .motion      = SAM_STAYS,
                                                   .separates   = PETSC_TRUE}};
  static const SamStateNumber numbers[NUMBERS] = {
    {"thermal_displacement_max", "m", "maximum thermal displacement of the surfaces towards each other",
     SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 1},
    {"thermal_passes", "1", "passes in which the thermal displacement was found", SAM_NUMBER_REAL, 1, PETSC_FALSE,
     PETSC_TRUE, SAM_JOIN_LAST, 0}};
  PetscInt id;

  PetscFunctionBegin;
  if (!SamHeatLawExpands((const SamHeatLaw *)law->data)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 2; k++) PetscCall(SamStateDeclareField(state, &fields[k], &id));
  for (int k = 0; k < NUMBERS; k++) PetscCall(SamStateDeclareNumber(state, &numbers[k], &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawBeginExpansion(SamLaw law)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;

  PetscFunctionBegin;
  if (!SamHeatLawExpands(h)) PetscFunctionReturn(PETSC_SUCCESS);
  h->passes = 0;
  if (h->mixing) SamMixingRestart(h->mixing); /* after a step that failed */
  law->revision++;                            /* the pressure has to be solved again */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawKeepExpansion(SamLaw law, const SamLawStep *step)
{
  const SamHeatLaw *h = (const SamHeatLaw *)law->data;
  PetscReal         least;
  double           *numbers;
  Vec               z;

  PetscFunctionBegin;
  if (!SamHeatLawExpands(h)) PetscFunctionReturn(PETSC_SUCCESS);
  numbers          = SamStateNumbers(step->state, SamStateFindNumber(step->state, maximum), SAM_TRIED);
  z                = SamStateReadField(step->state, SamStateFindField(step->state, DISPLACEMENTZ));
  numbers[MAXIMUM] = 0;
  numbers[PASSES]  = (double)h->passes;
  if (z) PetscCall(VecMin(z, NULL, &least));
  if (z) numbers[MAXIMUM] = 0 - (double)least;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawViewExpansion(SamLaw law, SamState state, PetscViewer viewer)
{
  const double *numbers;

  PetscFunctionBegin;
  if (!SamHeatLawExpands((const SamHeatLaw *)law->data)) PetscFunctionReturn(PETSC_SUCCESS);
  numbers = SamStateReadNumbers(state, SamStateFindNumber(state, maximum));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  %-10s  displaces the surfaces by %.6g m towards each other, %.0f passes\n",
                                   "expansion", numbers[MAXIMUM], numbers[PASSES]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawDestroyExpansion(SamLaw law)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;

  PetscFunctionBegin;
  if (h->expander[1] == h->expander[0]) h->expander[1] = NULL;
  for (int b = 0; b < 2; b++) PetscCall(SamExpanderDestroy(&h->expander[b]));
  PetscCall(SamMixingDestroy(&h->mixing));
  PetscFunctionReturn(PETSC_SUCCESS);
}
