/*
  Estimates the error of a grid in the dissipated energy from the widths of the slip zones at the ends of branches.

  A branch is the loading between two reversals: the slip zone grows inward from the contact's edge, and vanishes at the
  reversal, where all cells stick again. The energy of a branch grows like the third power of the zone's final width w.
  It depends on which cells are in the zone, so that the error does not depend on the length of the steps. Areas of
  contact and stick are known to a fraction of a cell, and with them the width,

      w = (contact area - stick area)/(length of the contact's edge),

  even where no cell is wide enough. Two estimates follow. Branches in which all cells stick have a zone, too, whose
  energy is missing (stuck.c).

  1. For all contacts the error is the part 0.3/(w^2 sqrt(m)) of the energy of a branch, with w and the length m of the
     edge in cells. The errors of cells along an edge cancel like random errors. Straight edges have one place on the
     cells: m = 1, where the edges of pads and rollers are not reconstructed, and 0.36 in plane strain: the part is
     0.5/w^2 then, more than the error of 30 of 33 random cylinders and pads (root mean square 0.36). Measured on 452
     cycles of spheres and ellipsoids, centred on the grid and off it, cylinders and rough surfaces (error times w^2
     sqrt(m), root mean squares): 0.52, 0.19, 0.28, 0.20. Round edges that are not reconstructed, of punches, layers and
     loads out of phase, count as a quarter of m: on 26 random ones the error was below 0.08/w^2 at m = 60 to 250.
  2. For alike bodies with quadratic gaps, constant N, and T along one line, the closed form gives the energy itself
     (solution/closedenergy.c).

  Dissimilar bodies slip while N grows. If N is applied in one step, that slip is treated as straight, and the energy of
  first loading is too large by the part

      e = (beta/mu)^2 (1.9/t^2 - 1.1),

  where beta is Dundurs' constant. This holds within a quarter for spheres, ellipsoids, punches, pads, rollers and
  cylinders, measured against 24 steps of N, followed by T, for beta/mu from 0.03 to 0.5 and t from 0.05 to 0.95; beyond
  0.5 the part is smaller. The energy of the first reversal is too large by as much, that of later ones is right. For
  bodies with layers, beta is the largest one of waves with numbers 1/a to 2.5/a, a being the half width of the contact.
  At e = 0.02 the maximum shear is wrong by 2 to 6 %.

  Source: J. Jaeger, Arch. Appl. Mech. 65 (1995) 478 (the shear of all alike bodies is a difference of two normal
  problems).
*/
#include "adviceimpl.h"
#include <petsam/private/bodyimpl.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/problemimpl.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/balance.h>
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/gap.h>
#include <petsam/private/law.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>
#include <math.h>

#define GOOD     0.02  /* the same on an advised grid */
#define ROUGH    0.25  /* the same above which the energy is unknown */
#define POINT    0.9   /* part of the last contact; one that was smaller after the first step has grown from a point */
#define ALIKE    1e-6  /* smaller couplings of bodies, or relative changes of a load, count as none */
#define REVERSED 1.02  /* increase of the part of cells that stick, relative to the step before, at a reversal */
#define ROUNDING 1e-16 /* energy, relative to the normal work, that is rounding of the shear */
#define NOTHING  1e-6  /* energy, relative to the tangential work, that counts as none */
#define LITTLE   1e-4  /* the same of dissimilar bodies while N grows: less is that of single cells */
#define SLIVER   1e-3  /* the same if N and T grow in proportion; cut cells cause such energies */
#define UNSURE   0.5  /* error of a step's energy by its length, relative to it, above which cells are not questioned */
#define ROUND    4    /* ratio of the length of a round edge without reconstruction to the part that counts */
#define PEAKED   1.25 /* cells: width of a zone in which the largest slip and shear have errors above 5 % */
#define SLIP     0.06 /* error of both, or of the slip velocity in rolling, relative to 1/w */
#define RETURNS  0.1  /* error of the largest slip after a reversal, relative to its change since, times w^2 + 1/4 */
#define FORM     0.015 /* accuracy of the energy in closed form, without slip across T: 1.1 % too much at nu = 0.49 */
#define MISSED   0.1   /* part of the energy in closed form below which the cells miss the zone */
#define SEEN     2     /* cells: width of a zone from which on half the cells have it, too */
#define LARGE    0.07  /* that error, relative to the slip, above which a warning is given */
#define LINE     0.36  /* m in plane strain */
#define SPECK    0.01  /* width of a stick zone, relative to the contact's, below which no grid is advised for it */
#define SPENT    1e-3  /* energy of a cycle relative to that of the first one, below which it is unknown */
#define STUCK    7     /* cells across a stick zone whose area has an error below 5 % */
#define HIGHER   0.9   /* shear of a narrow zone, relative to the largest found, above which it may be larger */
#define SHEAR    2.5   /* largest error of the shear, relative to that of the energy, if N is applied in one step, */
#define SEVERAL  8     /* and number of steps in which it is small */
#define MAKING   0.33  /* part of the work of slip that is too much before cells touch */
#define LESS     0.25  /* the same, relative to the energy, with enough steps; it falls like 1/steps^(1/FALLS) */
#define FALLS    0.75
#define WIDE     0.55  /* part of the ring of slip that is too much in very few steps */
#define MERGING  1.2   /* error of the shear times the number of steps in which N and T of rough surfaces grow */
#define TILTED   0.003 /* displacement by tilting over the approach, from which on it counts */
#define ONCE     0.75  /* part of the largest normal load that counts as all of it */
#define SLIGHT   0.2   /* part of mu N above which T counts in it */
#define WAVES    2.5   /* largest wave number of those used for beta, relative to that of the contact */
#define SPIN     0.59  /* M_z of sliding, relative to mu N a */

#define SLIP_ZONES "slip zones are %.2g cells wide"

/* ---- the width of the zone ---- */

/* True if the gap has a shape with round edges. */
static PetscBool IsRound(SamGap gap)
{
  static const char *const names[] = {SAM_GAP_SPHERE, SAM_GAP_ELLIPSOID, SAM_GAP_CURVED, SAM_GAP_PUNCH};
  SamGapType               type;
  PetscBool                has = PETSC_FALSE;

  (void)SamGapGetParameters(gap, &type, NULL, NULL, NULL);
  for (int k = 0; k < 4 && type; k++) has = has || !strcmp(type, names[k]);
  return has;
}

/* Numbers of a step */
typedef struct {
  PetscReal contact, stick, width, contact_cells, stick_cells, energy, closed, unsure, accepted;
  PetscReal slip;                   /* the maximum slip */
  double    before_touch, touching; /* SAM_ENTERING, SAM_TOUCHING, */
  double    unbalanced;             /* SAM_UNBALANCED */
  double    known, faces;           /* known: 1 if the edge of contact is reconstructed; its faces between cells */
} Numbers;

static PetscErrorCode GetNumbers(const SamSetup *s, Numbers *n)
{
  const double *edge;
  SamState      state;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(s->contact, "contact_area", &n->contact));
  PetscCall(SamContactGetNumber(s->contact, "stick_area", &n->stick));
  PetscCall(SamContactGetNumber(s->contact, "slip_width", &n->width));
  PetscCall(SamContactGetNumber(s->contact, "stick_cells", &n->stick_cells));
  PetscCall(SamContactGetNumber(s->contact, "contact_cells", &n->contact_cells));
  PetscCall(SamContactGetNumber(s->contact, "edge_accepted", &n->accepted));
  PetscCall(SamContactGetNumber(s->contact, "dissipated_energy", &n->energy));
  PetscCall(SamContactGetNumber(s->contact, "dissipated_energy_closed", &n->closed));
  PetscCall(SamContactGetNumber(s->contact, "energy_error", &n->unsure));
  PetscCall(SamContactGetNumber(s->contact, "slip_max", &n->slip));
  PetscCall(SamContactGetState(s->contact, &state));
  edge            = SamStateReadNumbers(state, SamStateFindNumber(state, SAM_CONTACT_EDGE));
  n->before_touch = SamStateReadNumbers(state, SamStateFindNumber(state, SAM_ENTERING))[0];
  n->touching     = SamStateReadNumbers(state, SamStateFindNumber(state, SAM_TOUCHING))[0];
  n->unbalanced   = SamStateReadNumbers(state, SamStateFindNumber(state, SAM_UNBALANCED))[0];
  n->known        = edge[SAM_CONTACT_EDGE_KNOWN];
  n->faces        = edge[SAM_CONTACT_EDGE_FACES];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the length of the contact's edge in cells. */
static double EdgeOf(const SamSetup *s, const Numbers *n)
{
  const PetscBool row  = SamGridIsRow(s->grid);
  const double    cell = sqrt((double)(s->grid->dx * s->grid->dy));

  if (n->known > 0) return SamContactEdgeLength(s->grid, n->faces) / (row ? 1 : cell);
  return row ? 2 : 2 * sqrt(PETSC_PI * (double)n->contact) / cell;
}

/*
  Computes width of the zone and the part of the edge's length that counts, in cells; flat periodic bodies have no edge,
  and an infinite width.
*/
static void Measure(const SamSetup *s, const Numbers *n, double edge, SamSlip *slip)
{
  const PetscBool row  = SamGridIsRow(s->grid);
  const double    cell = row ? (double)s->grid->dx : sqrt((double)(s->grid->dx * s->grid->dy));
  const double    area = (double)(n->contact - n->stick) / (row ? cell : cell * cell);
  if (n->known > 0)
    slip->width = n->faces > 0 ? n->width / cell : INFINITY;
  else
    slip->width = edge > 0 ? PetscMax(area / edge, 0) : INFINITY;
  slip->length = n->accepted >= SAM_ADVICE_KNOWN || SamGapHasFile(s->gap) ? edge : IsRound(s->gap) ? edge / ROUND : 1;
  slip->length = row ? LINE : PetscMax(slip->length, 1);
}

/* Adds the branch that ends with the present zone. */
static void EndBranch(SamSlip *slip)
{
  const double error = PetscMin(slip->width > 0 ? SamZoneError((double)slip->width, (double)slip->length) : 1, 1) *
                       PetscMax(slip->branch, 0);

  slip->error += error;
  if (error >= slip->worst) {
    slip->worst     = error;
    slip->narrow[0] = slip->width;
    slip->narrow[1] = slip->length;
  }
  if (slip->first == 0) slip->first = slip->branch;
  slip->branch = 0;
}

/* Adds the zone of a branch in which all cells stuck. */
static void EndStuck(SamSlip *slip)
{
  slip->missing += slip->zone;
  if (slip->zone > slip->worst) {
    slip->worst     = slip->zone;
    slip->narrow[0] = SAM_STUCK_WIDTH * slip->stuck;
    slip->narrow[1] = slip->length;
  }
  slip->stuck = slip->zone = 0;
}

/* True if shear and pressure of the bodies are not coupled. */
static PetscBool IsAlike(const SamSetup *s)
{
  const double waves[2] = {PETSC_PI / (double)s->grid->length, PETSC_PI / (double)s->grid->side[1]};

  return SamPairCoupling(s->pair, waves[0], waves[1]) < ALIKE ? PETSC_TRUE : PETSC_FALSE;
}

/* Follows a branch while all cells stick. Collective. */
static PetscErrorCode AddStuck(const SamSetup *s, const SamStep *step, PetscBool sticks, SamSlip *slip)
{
  double    change[2], share;
  SamStuck  stuck;
  PetscReal shear;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    change[k] = (double)step->load[k ? SAM_COMPONENT_TY : SAM_COMPONENT_TX] - slip->tangential[k];
    slip->tangential[k] += change[k];
  }
  if (change[0] * slip->toward[0] + change[1] * slip->toward[1] < 0) EndStuck(slip);
  for (int k = 0; k < 2; k++) slip->toward[k] = change[k];
  slip->high = 0;
  if (!sticks) slip->stuck = slip->zone = 0; /* the branch has slipped, and its energy is known */
  if (!(sticks || slip->width < PEAKED) || !IsAlike(s)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamAdviceMeasureStuck(s, &share, &stuck));
  PetscCall(SamContactGetNumber(s->contact, "shear_max", &shear));
  if (sticks) {
    /* After a reversal the shear changes by up to twice the bound. */
    slip->stuck = PetscMin(slip->stuck + share / (slip->energy + slip->missing > 0 ? 2 : 1), 1);
    slip->zone  = (slip->energy + slip->missing > 0 ? 2 : 1) * stuck.work * pow(slip->stuck, 3);
  }
  slip->high = stuck.shear * sqrt(sticks ? slip->stuck : 1);
  if (slip->high < HIGHER * (double)shear) slip->high = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- dissimilar bodies ---- */

/* Adds the data by which the error of a single step of N is estimated in which slip does not count from when cells
   touch. Collective. */
static PetscErrorCode Join(SamAdvice *a, const SamStep *step, const Numbers *n)
{
  const SamSetup     *s       = a->setup;
  const SamLoadRange *most    = &a->most;
  SamSlip            *slip    = &a->slip;
  const double        load    = (double)step->load[SAM_COMPONENT_N];
  const double        now     = most->force ? load : (double)step->rigid[SAM_COMPONENT_N];
  const double        contact = (double)n->contact;
  const double        radius  = SamGridIsRow(s->grid) ? contact / 2 : sqrt(contact / PETSC_PI);
  PetscReal           friction;
  PetscBool           rubs;

  PetscFunctionBegin;
  if (!(load > 0) || !(radius > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamLawGetFriction(SamProblemGetLaw(s->problem, SAM_LAW_COULOMB), &friction));
  PetscCall(SamProblemHasFriction(s->problem, &rubs));
  if (!(friction > 0)) friction = 1; /* friction is a field */
  if (!slip->joined && rubs && SamContactGetSettings(s->contact).coupling && n->touching == 0 &&
      now > ONCE * (double)most->normal)
    slip->coupling = SamPairCoupling(s->pair, 1 / radius, WAVES / radius) / (double)friction;
  slip->joined = PETSC_TRUE;
  if (slip->first == 0)
    slip->share = PetscMax(slip->share, hypot(hypot(step->load[SAM_COMPONENT_TX], step->load[SAM_COMPONENT_TY]),
                                              step->load[SAM_COMPONENT_MZ] / (SPIN * radius)) /
                                          ((double)friction * load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the part by which the energy of first loading up to t is too large if N is applied in one step. */
static double ExcessOf(double coupling, double t)
{
  return coupling * coupling * (1.9 / (t * t) - 1.1);
}

#define SLIPS_AS_N_GROWS \
  "dissimilar bodies slip while N grows, in one step; -steps needs a -history of two rows, N alone, then all"

/* Advises on dissimilar bodies whose N is applied in one step; called before the last branch ends. */
static void Long(SamAdvice *a)
{
  SamSlip      *slip   = &a->slip;
  const double  excess = ExcessOf(slip->coupling, PetscMin(PetscMax(slip->share, SLIGHT), 1));
  const double  wrong  = (slip->first > 0 ? 2 * slip->first : slip->energy) * excess / (1 + excess);
  const double  error  = wrong < slip->energy ? wrong / (slip->energy - wrong) : INFINITY;
  const SamLaw *laws;
  PetscInt      count;

  if (!(slip->coupling > 0 && slip->work > 0 && slip->energy > NOTHING * slip->work)) return;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, error < ROUGH && slip->share > SLIGHT ? error : 1, SEVERAL,
               "dissipated_energy", "%s", SLIPS_AS_N_GROWS);
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, SHEAR * error, SEVERAL, "shear_max", "%s", SLIPS_AS_N_GROWS);
  a->error = SamProblemGetLaws(a->setup->problem, &count, &laws);
  for (PetscInt k = 0; !a->error && k < count; k++)
    if (laws[k]->with_shear)
      SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, SHEAR * error, SEVERAL, laws[k]->with_shear, "%s", SLIPS_AS_N_GROWS);
}

/*
  Advises more steps if much of the slip of dissimilar bodies occurs before cells touch. The ring of slip is too wide
  then: its part of the contact's area is 1 - s instead of (1 - f)(1 - s), s being the part that sticks. The shear is
  mu p at the inner end of the ring, where the pressure of a sphere is in proportion to the square root of the ring's
  part. So the maximum shear is too large by 1 - sqrt(1 - f). Let x be the work of slip before cells touch, relative to
  the energy. On spheres with beta/mu of 0.8, 1, 1.15 and 1.3, on 128 cells, in 1, 4 and 12 steps against 64, f was
  0.02, 0.06, 0.17, 0.24, 0.4 at x = 0.5, 1.4, 3.6, 6.9, 30, and did not grow any more. It is estimated as
  WIDE x/(x + 4). The missing energy was 0.006 to 0.1 x.
*/
static void Few(SamAdvice *a)
{
  static const char why[]  = "%.0f %% of the slip while N grows is before cells touch";
  const SamSlip    *slip   = &a->slip;
  const double      all    = slip->before_touch + slip->energy;
  const double      ring   = WIDE * LESS * slip->before_touch / (LESS * slip->before_touch + slip->energy);
  const double      factor = pow(slip->before_touch / (LESS * slip->energy), FALLS), part = slip->before_touch / all;

  if (slip->coupling > 0 || !(slip->energy > NOTHING * slip->work && slip->before_touch > MAKING * all)) return;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, part, factor, "dissipated_energy", why, 100 * part);
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, 1 - sqrt(1 - ring), factor, "shear_max", why, 100 * part);
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, ring * (1 - slip->grown) / slip->sticks, factor, "stick_area", why,
               100 * part);
}

/*
  Advises more steps if N and T of alike bodies grow in proportion on a rough surface. If they do not tilt, nothing
  slips: the shear is a part of the pressure everywhere. If they do, spots slip before they merge, and the end of a long
  step shows nothing of it. On eight random rows of one to six spots the maximum shear of 2, 4, 8 and 16 steps was wrong
  by up to 33, 35, 25 and 16 %, against 64.
*/
static void Merging(SamAdvice *a)
{
  static const char why[] = "N and T grow while the bodies tilt, and spots slip before they merge";
  const SamSlip    *slip  = &a->slip;
  const double      error = MERGING / (double)slip->steps;

  if (!(slip->together && slip->unsure && slip->tilt > TILTED && SamGapHasFile(a->setup->gap) &&
        error > SAM_DOUBT_LARGE))
    return;
  SamDoubtsAdd(&a->guesses, SAM_CAUSE_STEPS, 1, error / GOOD, "dissipated_energy", "%s", why);
  SamDoubtsAdd(&a->guesses, SAM_CAUSE_STEPS, PetscMin(error, ROUGH), error / GOOD, "shear_max slip_max stick_area",
               "%s", why);
}

/* Advises more steps if the sum of the errors of the steps' energies is large; it falls with the square of their
   length. Of steps given one by one the sum has not ended. What the work of the loads tells stands beside companion
   runs, too: where N falls all of them lack the energy that cells take along. */
static void LongSteps(SamAdvice *a)
{
  const SamSlip  *slip   = &a->slip;
  const PetscBool twists = slip->twists && slip->areas[0] < POINT * slip->areas[1] ? PETSC_TRUE : PETSC_FALSE;
  const double    lost   = slip->energy > 0 ? slip->unbalanced / slip->energy : slip->unbalanced > 0 ? 1 : 0;

  if (a->increments && PetscMax(slip->energy, slip->unbalanced) > LITTLE * slip->work)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, lost, sqrt(PetscMin(lost, 1) / GOOD), "dissipated_energy",
                 "the loads do work that is neither stored nor dissipated");

  if (a->increments && a->steps > 1 && twists)
    SamDoubtsAdd(&a->guesses, SAM_CAUSE_STEPS, 1, SAM_DOUBT_WORSE, "rot_z", SAM_DOUBT_TWIST);
  if (a->increments && a->steps > 1 && PetscMax(slip->energy, slip->lag) > LITTLE * slip->work)
    SamDoubtsAdd(&a->guesses, SAM_CAUSE_STEPS, slip->energy > 0 ? slip->lag / slip->energy : 1,
                 sqrt(PetscMin(slip->lag / slip->energy, 1) / GOOD), "dissipated_energy", "the load steps are long");
}

/* ---- the steps ---- */

/* True if N and T have grown in proportion from zero: then no slip is necessary (step/direction.c). */
static PetscBool GrowTogether(SamSlip *slip, const SamStep *step)
{
  const double load = (double)step->load[SAM_COMPONENT_N];

  if (slip->steps == 1) slip->together = load > 0 && step->control.together ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2 && slip->together; k++) {
    const double now = (double)step->load[SAM_COMPONENT_TX + k];

    if (slip->steps == 1) slip->part[k] = now / load;
    slip->together = fabs(now - slip->part[k] * load) <= ALIKE * load ? PETSC_TRUE : PETSC_FALSE;
  }
  return slip->together;
}

/* True if M_z and N grow in proportion from zero, in the first row of a history. */
static PetscBool TwistsWith(const SamStep *step)
{
  return step->control.together && step->control.sudden && step->load[SAM_COMPONENT_N] > 0 &&
         step->control.force[SAM_COMPONENT_MZ] && step->control.value[SAM_COMPONENT_MZ] != 0;
}

/* Returns the displacement of the contact's edge by tilting, relative to the approach. */
static double TiltOf(const SamSetup *s, const SamStep *step, const Numbers *n)
{
  const double contact  = (double)n->contact;
  const double radius   = SamGridIsRow(s->grid) ? contact / 2 : sqrt(contact / PETSC_PI);
  const double approach = (double)step->rigid[SAM_COMPONENT_N];

  return approach > 0 ? radius * hypot(step->rigid[SAM_COMPONENT_MX], step->rigid[SAM_COMPONENT_MY]) / approach : 0;
}

/* Returns the work of a step's tangential loads, J. */
static double WorkOf(const SamStep *step)
{
  double work = 0;

  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt c = SamComponentsOf[SAM_BALANCE_TANGENTIAL][k];

    if (step->control.value[c] != 0) work += fabs((double)(step->load[c] * step->rigid[c])); /* others are rounding */
  }
  return work;
}

/* Returns the order of the work of the shear of alike bodies that bulk stress stretches under the contact, J. */
static PetscErrorCode GetStrained(const SamSetup *s, const SamStep *step, double contact, double *work)
{
  SamStrain e;
  PetscReal shear;

  PetscFunctionBegin;
  *work = 0;
  PetscCall(SamProblemDisplace(s->problem, NULL, &step->control, NULL, NULL, &e, NULL));
  if (!IsAlike(s) || (e.xx == 0 && e.yy == 0 && e.xy == 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetNumber(s->contact, "shear_max", &shear));
  *work = (double)(shear * shear / SamPairModulus(s->pair)) * contact;
  *work *= SamGridIsRow(s->grid) ? contact : sqrt(contact);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Counts the energy of a step as 0 if it is next to nothing for the work of N. Where only N grows, this includes what
  more steps would make of it.
*/
static void ForgetNothing(SamSlip *slip, double normal, PetscBool pushed, Numbers *n)
{
  const double grows = n->touching > 0 ? normal - slip->normal : normal,
               most  = (double)n->energy + LESS * PetscMax(n->before_touch, 0);

  if ((double)n->energy < ROUNDING * normal) n->energy = 0;
  if (!pushed && most < SAM_ENERGY_NONE * grows) n->energy = n->before_touch = 0;
  slip->normal = normal > 0 ? normal : 0; /* apart, the approach is unknown */
}

PetscErrorCode SamAdviceAddSlip(SamAdvice *a, const SamStep *step)
{
  const SamSetup *s      = a->setup;
  const double    normal = fabs((double)(step->load[SAM_COMPONENT_N] * step->rigid[SAM_COMPONENT_N]));
  SamSlip        *slip   = &a->slip;
  const double    pushes = WorkOf(step);
  const PetscBool pushed = pushes > NOTHING * NOTHING * normal ? PETSC_TRUE : PETSC_FALSE;
  double          work   = pushes, sticks, edge;
  Numbers         n;

  PetscFunctionBegin;
  if (SamProblemGetRolled(s->problem, &step->control, NULL) != 0) slip->rolls = PETSC_TRUE;
  if (slip->rolls) PetscFunctionReturn(PETSC_SUCCESS);
  if (!slip->steps++) slip->closed = 0;
  PetscCall(GetNumbers(s, &n));
  slip->areas[1] = (double)n.contact;
  if (slip->steps == 1) {
    slip->areas[0] = slip->areas[1];
    slip->twists   = TwistsWith(step);
  }
  slip->closed += (double)n.closed;
  sticks = n.contact_cells > 0 ? (double)(n.stick_cells / n.contact_cells) : 1;
  if (sticks > REVERSED * slip->sticks || (sticks == 1 && slip->sticks < 1)) {
    EndBranch(slip);
    slip->turned = slip->slipped;
  }
  edge = EdgeOf(s, &n);
  Measure(s, &n, edge, slip);
  PetscCall(Join(a, step, &n));
  slip->tilt = PetscMax(slip->tilt, TiltOf(s, step, &n));
  PetscCall(AddStuck(s, step, n.stick_cells == n.contact_cells ? PETSC_TRUE : PETSC_FALSE, slip));
  ForgetNothing(slip, normal, pushed, &n);
  PetscCall(SamAdviceAddRing(a, &(SamRingStep){.touches = n.touching > 0 ? PETSC_TRUE : PETSC_FALSE,
                                               .energy  = (double)n.energy,
                                               .edge    = edge,
                                               .width   = (double)slip->width,
                                               .sticks  = sticks}));
  if (GrowTogether(slip, step) && pushed && n.energy < SLIVER * pushes) {
    n.energy     = 0;
    slip->unsure = PETSC_TRUE;
  }
  slip->slipped = (double)n.slip;
  slip->energy += (double)n.energy;
  slip->before_touch += PetscMax(n.before_touch, 0);
  /* A first step of similar bodies that applies N, then the rest, causes no error. */
  if (slip->steps > 1 || a->cycles || n.touching > 0 || step->control.together)
    slip->lag += PetscMax((double)n.unsure, 0);
  slip->unbalanced += n.unbalanced;
  slip->growing += n.before_touch > 0 ? 1 : 0;
  if (n.before_touch > 0) slip->grown = sticks;
  slip->sticks = sticks;
  if (n.energy > 0 && slip->width < INFINITY) slip->widest = PetscMax(slip->widest, slip->width);
  /* N and T that grow together may cause no slip: then the length of the steps, and not the cells, causes the
     energy. */
  if (a->steps > 1 && n.unsure > UNSURE * n.energy && n.energy > 0) {
    n.energy     = 0;
    slip->unsure = PETSC_TRUE;
  }
  slip->branch += n.touching > 0 ? 0 : (double)n.energy; /* the rest is in the ring */
  if (!pushed) PetscCall(GetStrained(s, step, (double)n.contact, &work));
  if (slip->width < INFINITY && step->load[SAM_COMPONENT_N] != 0 && work > NOTHING * NOTHING * normal)
    slip->work = PetscMax(slip->work, work);
  slip->pushed = step->control.force[SAM_COMPONENT_TX] && step->control.force[SAM_COMPONENT_TY] &&
                 step->control.force[SAM_COMPONENT_MZ];
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamAdvicePeaks(SamAdvice *a, double width, double wanted, const char names[])
{
  if (width > 0 && width < PEAKED)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, SLIP / width, wanted, names, SLIP_ZONES, width);
}

PetscErrorCode SamAdviceMeasureStick(SamAdvice *a)
{
  const SamSetup *s      = a->setup;
  const PetscBool steady = !SamMotionOf(s->elasticity)->continues;
  double         *state;
  PetscReal       contact, stick;
  PetscInt        cells;
  Vec             zone;

  PetscFunctionBegin;
  a->slip.across = INFINITY;
  if (a->slip.rolls || (!steady && !(a->slip.work > 0))) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetNumber(s->contact, "contact_cells", &contact));
  PetscCall(SamContactGetNumber(s->contact, "stick_cells", &stick));
  if (stick == contact || (stick == 0 && !a->slip.pushed)) PetscFunctionReturn(PETSC_SUCCESS); /* or all cells slide */
  PetscCall(SamGridCreateVec(s->grid, 1, &zone));
  PetscCall(SamContactGetField(s->contact, "state", zone));
  PetscCall(VecGetLocalSize(zone, &cells));
  PetscCall(VecGetArray(zone, &state));
  for (PetscInt k = 0; k < cells; k++) state[k] = state[k] == SAM_CELL_STICK ? 1 : 0;
  PetscCall(VecRestoreArray(zone, &state));
  PetscCall(SamGridMeasureZones(s->grid, zone, SAM_ADVICE_STRAY, SamElasticityGetTraits(s->elasticity).periodic,
                                &a->slip.across)); /* 0 without a zone */
  PetscCall(VecDestroy(&zone));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamAdviceStick(SamAdvice *a, PetscReal least)
{
  const double across = (double)a->slip.across, part = PetscMax(across, 1) / (double)a->extent.across;

  if (!(across < least) || !(a->extent.across > 2 * STUCK)) return;
  if (part < SPECK)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1, 0, "stick_area",
                 "the stick zone is %.1g of the contact's width, for which no usual grid does", part);
  else
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, SAM_DOUBT_LARGE * least / PetscMax(across, SAM_DOUBT_LARGE),
                 least / PetscMax(across, 1), "stick_area",
                 across < 0.95 ? "the stick zone is less than a cell across" : "the stick zone is %.2g cells across",
                 across);
}

PetscBool SamAdviceIsSpent(const SamAdvice *a)
{
  return a->cycles && (double)a->slip.energy < SPENT * (double)a->begun ? PETSC_TRUE : PETSC_FALSE;
}

/* Advises on a life whose scar has grown until hardly any slip is left: what is left changes from cell to cell. */
static void Spent(SamAdvice *a)
{
  SamDoubtsAdd(
    &a->doubts, SAM_CAUSE_CELLS, 1, 0, "dissipated_energy shear_max",
    "hardly any slip is left at the edge of the scar, less than %g of the first cycle's energy, for which no "
    "grid does",
    SPENT);
}

static void Energy(SamAdvice *a)
{
  SamSlip        *slip  = &a->slip;
  const PetscBool known = !isnan(slip->closed);
  double          most, error, width, factor;
  char            zones[SAM_DOUBT_WHY] = "no cell slips";

  EndBranch(slip);
  EndStuck(slip);
  if (!a->extent.finer) slip->missing = 0; /* a sharp edge has no such zone */
  slip->error += slip->missing;
  if (known) { /* the closed form says no more than its own accuracy */
    const double apart = fabs(slip->closed - slip->energy), least = FORM * slip->closed;

    slip->error = apart > least ? apart : PetscMin(slip->error, least);
  }
  most  = known ? slip->closed : slip->energy + slip->missing;
  error = most > NOTHING * slip->work ? slip->error / most : slip->work > 0 && a->extent.finer && !slip->unsure ? 1 : 0;
  width = slip->narrow[0];
  if (!(slip->missing > 0 && slip->missing >= slip->worst)) width = PetscMax(width, SAM_ADVICE_NARROW);
  factor = pow(SamZoneError((double)width, (double)slip->narrow[1]) / GOOD, slip->narrow[1] > 1 ? 0.4 : 0.5);
  if (isinf(slip->narrow[0])) /* no edge of contact lies on the grid */
    (void)snprintf(zones, sizeof(zones), "the contact has no edge");
  else if (slip->narrow[0] > 0)
    (void)snprintf(zones, sizeof(zones), SLIP_ZONES, (double)slip->narrow[0]);
  if (known)
    (void)snprintf(zones + strlen(zones), sizeof(zones) - strlen(zones),
                   "; dissipated_energy is %.3g %s in closed form", slip->closed, SamUnitOn(a->setup->grid, "J"));
  if (known && !slip->unsure && error > FORM && most > NOTHING * slip->work)
    SamDoubtsSet(&a->doubts, SAM_CAUSE_CELLS, error, factor, "dissipated_energy", "%s", zones);
  else
    SamDoubtsAdd(width < SEEN ? &a->doubts : &a->guesses, SAM_CAUSE_CELLS, known || error < ROUGH ? error : 1, factor,
                 "dissipated_energy", "%s", zones);
  if (error >= 1) SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1, factor, "slip_max", "%s", zones);
}

/* Advises on the maximum shear of the last step, at the end of a zone that is much narrower than the widest. */
static void LastPeak(SamAdvice *a, double width, double high)
{
  PetscReal shear = 0;

  if (!(high > 0) || !a->extent.finer) return;
  if (!a->error) a->error = SamContactGetNumber(a->setup->contact, "shear_max", &shear);
  if (shear > 0)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, fabs(high / (double)shear - 1), 2 * PEAKED / width, "shear_max",
                 "the slip zone of the last step is %.1g cells wide; shear_max is about %.2g Pa", width, high);
}

/*
  Advises on the maximum slip of the last step if much of it has gone back since a reversal: it then lies at the end of
  the zone of the reversal, between cells. The error was measured on 80 cylinders and spheres under N and reversed T; a
  straight edge has only one place on the cells, and twice the error.
*/
static void LastSlip(SamAdvice *a)
{
  const SamSlip *slip   = &a->slip;
  const double   square = (double)(slip->width * slip->width), change = fabs(slip->turned - slip->slipped);
  const double   part = RETURNS * change / slip->slipped, error = part / (square + 0.25),
               edge = SamGridIsRow(a->setup->grid) ? 2 : 1;

  /* on that grid the error is half of the largest that is allowed */
  if (slip->turned > 0 && slip->slipped > 0 && slip->width > 0 && slip->widest >= PEAKED && error > LARGE)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, edge * error, sqrt(PetscMax(2 * part / LARGE - 0.25, 0) / square),
                 "slip_max", "the slip zone since the last load reversal is %.2g cells wide", (double)slip->width);
}

/*
  Advises on the maximum shear of a slip zone that the cells miss: it is that of cells that stick. Compared with closed
  forms on 60 cylinders and balls, the shear was too small by 1 - sqrt(w) within 0.03, w being the width in cells.
  Returns true if so.
*/
static PetscBool Missed(SamAdvice *a)
{
  const SamSlip *slip  = &a->slip;
  const double   width = (double)slip->narrow[0];

  if (isnan(slip->closed) || !(slip->closed > NOTHING * slip->work) || slip->energy > MISSED * slip->closed)
    return PETSC_FALSE;
  if (slip->turned > 0 || !(width > 0 && width < PEAKED)) return PETSC_FALSE;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1 - sqrt(width), 2 * PEAKED / width, "shear_max", SLIP_ZONES, width);
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1, 2 * PEAKED / width, "slip_max", SLIP_ZONES, width);
  return PETSC_TRUE;
}

void SamAdviceSlip(SamAdvice *a)
{
  const double zone  = SAM_STUCK_WIDTH * a->slip.stuck; /* used before the last branch ends */
  const double width = zone > 0 ? zone : PetscMax((double)a->slip.width, SAM_ADVICE_NARROW);

  if (!a->slip.steps || a->slip.rolls) return;
  Long(a);
  Few(a);
  Merging(a);
  LongSteps(a);
  SamAdviceRing(a, LITTLE * a->slip.work);
  (SamAdviceIsSpent(a) ? Spent : Energy)(a);
  if (!Missed(a))
    SamAdvicePeaks(a, (double)a->slip.widest, 2 * PEAKED / PetscMax((double)a->slip.widest, SAM_ADVICE_NARROW),
                   "slip_max shear_max");
  if (!SamAdviceIsSpent(a) && (zone > 0 || !((double)a->slip.widest < PEAKED))) LastPeak(a, width, a->slip.high);
  LastSlip(a);
  SamAdviceStick(a, SamAdviceCountsCells(a) ? SAM_ADVICE_CELLS : STUCK);
}
