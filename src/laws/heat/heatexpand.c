/*
  Thermal displacement: frictional heat expands the bodies, which displaces their surfaces, and so changes the pressure
  and the slip by which it arises.

  The pressure gives the heat, the heat the displacement of the surfaces (expansion.c), and that the gap and the slip of
  the next pass. The passes x <- g(x), x being the displacement, are accelerated by Anderson's method in cells in
  contact (ground/grid/mixing.c): 5 to 9 of them for a sphere whose contact shrinks to three quarters. Flat contacts
  shrink to spots, of which there may be several; one of them is found.

  The heat is divided between the bodies in cells in contact, and at the edge of contact much heat flows from one body
  to the other. So g jumps where a cell comes into contact or leaves it, and may have no fixed point. If some passes are
  not enough, the cells in which heat is divided are held. What then is left belongs to single cells at the edge, and is
  measured: the displacement of the solved step against that by its heat.

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
#define FREE          8    /* passes after which cells are held */
#define NEAR          0.05 /* change below which they are */
#define ERROR         2e-2 /* largest difference from the displacement by the heat of the step, over the largest one */
#define MOST          80   /* passes */
#define LONG          40   /* passes after which */
#define SMALL         1e-3 /* this change is enough: the tolerance of the slip may leave it */
#define MOST_STRAIN   1e-2 /* 1/K */
#define DISPLACEMENT  "thermal_displacement"
#define DISPLACEMENTZ "thermal_displacement_z"

enum { MAXIMUM, PASSES, ERRORS, NUMBERS };
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

/* Computes the displacement of body 2 relative to body 1 by heat into both; z points into body 2. */
static PetscErrorCode DisplaceBy(SamLaw law, const Vec into[2], Vec z, Vec t)
{
  const SamHeatLaw *h = (const SamHeatLaw *)law->data;

  PetscFunctionBegin;
  PetscCall(VecSet(z, 0));
  PetscCall(VecSet(t, 0));
  for (int b = 0; b < 2; b++) {
    const SamBody   body = SamPairBody(SamElasticityGetPair(law->elasticity), b);
    const PetscReal c    = SamBodyExpansion(body, h->expansion[b]).displacement / h->conductivity[b];

    if (h->expander[b]) PetscCall(SamExpanderAdd(h->expander[b], into[b], -c, b ? c : -c, z, t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacement by the heat of a solution. */
static PetscErrorCode ComputeDisplacement(SamLaw law, SamLawContact *contact, Vec z, Vec t)
{
  SamHeatLaw *const h       = (SamHeatLaw *)law->data;
  const Vec         cells   = h->contact ? h->contact : contact->pressure;
  Vec               into[2] = {NULL}, none[2] = {NULL, NULL};

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) PetscCall(SamGridCreateVec(law->grid, 1, &into[b]));
  PetscCall(SamHeatLawFill(law, cells, contact->slip, contact->bound, into[0]));
  PetscCall(
    SamHeatTemperatures(&h->pair, cells, into[0], h->bulk, into[1], none, contact->failed, sizeof(contact->failed)));
  PetscCall(VecAXPY(into[0], -1, into[1]));
  PetscCall(DisplaceBy(law, into, z, t));
  for (int b = 0; b < 2; b++) PetscCall(VecDestroy(&into[b]));
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

/*
  Gets the largest difference of two fields of three components relative to the largest value of the second, in contact,
  or without any contact everywhere. It is 1 if the second is 0 and the first is not.
*/
static PetscErrorCode Compare(SamGrid grid, Vec pressure, Vec was, Vec is, double *change, PetscBool *touches)
{
  const double *p, *a, *b;
  double        most[5] = {0}; /* change and largest value in contact, those outside, and whether there is contact */

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(was, &a));
  PetscCall(VecGetArrayRead(is, &b));
  for (PetscInt k = 0; k < 3 * grid->cells; k++) {
    double *const of = p[k % grid->cells] > 0 ? most : most + 2;

    of[0] = PetscMax(of[0], fabs(b[k] - a[k]));
    of[1] = PetscMax(of[1], fabs(b[k]));
    if (of == most) most[4] = 1;
  }
  PetscCall(VecRestoreArrayRead(is, &b));
  PetscCall(VecRestoreArrayRead(was, &a));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(SamMax(grid->comm, 5, most));
  if (!(most[4] > 0)) PetscCall(PetscArraycpy(most, most + 2, 2));
  *change = most[0] > 0 ? (most[1] > 0 ? most[0] / most[1] : 1) : 0;
  if (touches) *touches = most[4] > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the tried displacement for writing; before the first pass of a step it is that of the step before. */
static PetscErrorCode TakeTried(SamState state, Vec *z, Vec *t)
{
  const PetscInt id[2] = {SamStateFindField(state, DISPLACEMENTZ), SamStateFindField(state, DISPLACEMENT)};
  Vec *const     to[2] = {z, t};

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    const Vec tried = SamStateGetField(state, id[k], SAM_TRIED), last = SamStateGetField(state, id[k], SAM_COMMITTED);

    PetscCall(SamStateSetField(state, id[k], to[k]));
    if (!tried) PetscCall(last ? VecCopy(last, *to[k]) : VecSet(*to[k], 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Holds the cells in contact in which the heat is divided. */
static PetscErrorCode Hold(SamHeatLaw *h, Vec pressure)
{
  PetscFunctionBegin;
  PetscCall(VecDuplicate(pressure, &h->contact));
  PetscCall(VecCopy(pressure, h->contact));
  SamMixingRestart(h->mixing); /* its results are those of other cells */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Decides whether passes go on after a relative change. Cells are held once some passes have not been enough and the
  changes are small. Where the displacement alone makes the slip, changes do not fall below the tolerance of the slip.
*/
static PetscErrorCode Decide(SamHeatLaw *h, Vec pressure, double change, PetscBool *again)
{
  PetscFunctionBegin;
  *again = change > (h->passes < LONG ? RTOL : SMALL) ? PETSC_TRUE : PETSC_FALSE;
  if (*again) h->passes++;
  if (*again && !h->contact && h->passes > FREE && change < NEAR) PetscCall(Hold(h, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the next displacement, or ends the passes. */
static PetscErrorCode Proceed(SamLaw law, SamLawContact *contact, Vec tried[2], Vec next[2], PetscBool *again)
{
  SamHeatLaw *const h      = (SamHeatLaw *)law->data;
  const SamGrid     g      = law->grid;
  double            change = 0;
  PetscBool         touches;
  Vec               argument, result;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, 3, &argument));
  PetscCall(SamGridCreateVec(g, 3, &result));
  PetscCall(Pack(g, tried[0], tried[1], argument, PETSC_FALSE));
  PetscCall(Pack(g, next[0], next[1], result, PETSC_FALSE));
  PetscCall(Compare(g, contact->pressure, argument, result, &change, &touches));
  PetscCall(Decide(h, contact->pressure, change, again));
  if (*again && h->passes > MOST) {
    *again = PETSC_FALSE;
    (void)snprintf(contact->failed, sizeof(contact->failed),
                   "the thermal displacement did not converge with the pressure in %d passes, last change %.2g: it is "
                   "larger than that by the pressure, or has spots smaller than the cells",
                   MOST, change);
  }
  if (*again && touches) PetscCall(SamMixingNext(h->mixing, contact->pressure, result, argument));
  if (*again && !touches) { /* no heat, and no displacement that an earlier pass or step had */
    PetscCall(VecCopy(result, argument));
    SamMixingRestart(h->mixing);
  }
  if (*again) PetscCall(Pack(g, tried[0], tried[1], argument, PETSC_TRUE));
  PetscCall(VecDestroy(&result));
  PetscCall(VecDestroy(&argument));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forgets the passes: the next ones are those of another step, or of other conditions. */
static PetscErrorCode Forget(SamHeatLaw *h)
{
  PetscFunctionBegin;
  if (h->mixing) SamMixingRestart(h->mixing);
  PetscCall(VecDestroy(&h->contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Follow(SamLaw law, SamLawContact *contact, PetscBool *again)
{
  Vec tried[2], next[2];

  PetscFunctionBegin;
  if (!contact->solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Prepare(law));
  PetscCall(TakeTried(contact->state, &tried[0], &tried[1]));
  for (PetscInt k = 0; k < 2; k++) PetscCall(SamGridCreateVec(law->grid, k + 1, &next[k]));
  PetscCall(ComputeDisplacement(law, contact, next[0], next[1]));
  if (!contact->failed[0]) PetscCall(Proceed(law, contact, tried, next, again));
  if (!*again) PetscCall(Forget((SamHeatLaw *)law->data));
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
    const SamBody body = SamPairBody(SamElasticityGetPair(law->elasticity), b);

    PetscCheck(fabs((double)h->expansion[b]) <= MOST_STRAIN, from->comm, SAM_ERR_USER,
               "-%sbody%d_expansion %.6g: expected at most %.6g 1/K; steel has 12e-6", prefix, b + 1,
               (double)h->expansion[b], MOST_STRAIN);
    PetscCheck(h->expansion[b] == 0 || !SamBodyIsRigid(body), from->comm, SAM_ERR_USER,
               "-%sbody%d_expansion: body %d is rigid and does not expand: omit it", prefix, b + 1, b + 1);
  }
  PetscCheck(!SamElasticityGetTraits(law->elasticity).plane, from->comm, SAM_ERR_USER,
             "-%sbody%d_expansion in plane strain: the displacement along the surface has no datum there: use "
             "-elasticity halfspace",
             prefix, h->expansion[0] != 0 ? 1 : 2);
  law->uses[SAM_USE_WORK]        = PETSC_FALSE;
  law->uses[SamHeatLawUses(law)] = PETSC_TRUE;
  law->displaces                 = PETSC_TRUE;
  law->ops.displace              = Displace;
  law->ops.follow                = Follow;
  law->named                     = h->expansion[0] != 0 ? "body1_expansion" : "body2_expansion";
  law->ops.check                 = Check;
  law->bytes += 320;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawDeclareExpansion(SamLaw law, SamState state)
{
#define FIELD(name_, text_, components_, result_) \
  { \
    .name = name_, .unit = "m", .text = text_, .components = components_, .generations = 2, .kept = PETSC_TRUE, \
    .result = result_, .motion = SAM_STAYS, .separates = PETSC_TRUE \
  }
  static const SamStateField fields[] = {
    FIELD(DISPLACEMENTZ, "thermal displacement, body 2's surface from body 1's", 1, SAM_RESULT_USUAL),
    FIELD(DISPLACEMENT, "thermal displacement, body 2's surface over body 1's", 2, SAM_RESULT_OFFERED)};
  static const SamStateNumber numbers[NUMBERS] = {
    {"thermal_displacement_max", "m", "maximum thermal displacement of the surfaces, positive towards each other",
     SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 1},
    {"thermal_passes", "1", "passes in which the thermal displacement was found", SAM_NUMBER_REAL, 1, PETSC_FALSE,
     PETSC_TRUE, SAM_JOIN_LAST, 0},
    {"thermal_error", "1", "difference of the thermal displacement from that by the heat of the step, over its maximum",
     SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0}};
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
  PetscCall(Forget(h));
  law->revision++; /* the pressure has to be solved again */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawKeepExpansion(SamLaw law, SamLawStep *step, const Vec into[2])
{
  const SamHeatLaw *h = (const SamHeatLaw *)law->data;
  double           *numbers, change = 0;
  PetscReal         least, most;
  Vec               used[2], own[2], all[2];

  PetscFunctionBegin;
  if (!SamHeatLawExpands(h)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Prepare(law));
  numbers = SamStateNumbers(step->state, SamStateFindNumber(step->state, maximum), SAM_TRIED);
  PetscCall(TakeTried(step->state, &used[0], &used[1]));
  for (PetscInt k = 0; k < 2; k++) {
    PetscCall(SamGridCreateVec(law->grid, k + 1, &own[k]));
    PetscCall(SamGridCreateVec(law->grid, 3, &all[k]));
  }
  PetscCall(DisplaceBy(law, into, own[0], own[1]));
  PetscCall(Pack(law->grid, used[0], used[1], all[0], PETSC_FALSE));
  PetscCall(Pack(law->grid, own[0], own[1], all[1], PETSC_FALSE));
  PetscCall(Compare(law->grid, step->pressure, all[0], all[1], &change, NULL));
  PetscCall(VecMin(used[0], NULL, &least));
  PetscCall(VecMax(used[0], NULL, &most));
  numbers[MAXIMUM] = 0 - (double)(least + most > 0 ? most : least); /* bodies that cool move away from each other */
  numbers[PASSES]  = (double)h->passes;
  numbers[ERRORS]  = change;
  if (!(numbers[ERRORS] <= ERROR) && !step->failed[0])
    (void)snprintf(step->failed, sizeof(step->failed),
                   "the check of the thermal displacement: it differs by %.2g of its maximum from that by the heat of "
                   "the step: use a finer grid, or give -heat_resistance",
                   numbers[ERRORS]);
  for (int k = 0; k < 2; k++) {
    PetscCall(VecDestroy(&own[k]));
    PetscCall(VecDestroy(&all[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawViewExpansion(SamLaw law, SamState state, PetscViewer viewer)
{
  const double *numbers;

  PetscFunctionBegin;
  if (!SamHeatLawExpands((const SamHeatLaw *)law->data)) PetscFunctionReturn(PETSC_SUCCESS);
  numbers = SamStateReadNumbers(state, SamStateFindNumber(state, maximum));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "  %-10s  displaces the surfaces by %.6g m %s each other, %.0f passes, error %.1g\n", "expansion",
    fabs(numbers[MAXIMUM]), numbers[MAXIMUM] < 0 ? "away from" : "towards", numbers[PASSES], numbers[ERRORS]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatLawDestroyExpansion(SamLaw law)
{
  SamHeatLaw *const h = (SamHeatLaw *)law->data;

  PetscFunctionBegin;
  PetscCall(VecDestroy(&h->contact));
  if (h->expander[1] == h->expander[0]) h->expander[1] = NULL;
  for (int b = 0; b < 2; b++) PetscCall(SamExpanderDestroy(&h->expander[b]));
  PetscCall(SamMixingDestroy(&h->mixing));
  PetscFunctionReturn(PETSC_SUCCESS);
}
