/*
  How far a grid resolves the dissipated energy, by the width of the slip zones at the ends of branches.

  A branch is what lies between two load reversals: the slip zone grows inward from the contact's edge, and vanishes at
  the reversal, where all cells stick again. The energy of a branch grows like the third power of the zone's final width
  w; which cells are in the zone decides it, so that the error does not depend on the length of the steps. Areas of
  contact and stick are known to a fraction of a cell, and with them the width,

      w = (contact area - stick area)/(length of the contact's edge),

  even where no cell is wide enough. Two estimates follow.

  1. For all contacts: of the energy of a branch the part 0.3/(w^2 sqrt(m)), with w and the length m of the edge in
     cells. The errors of cells along an edge cancel like those of chance. Straight edges have one place on the cells:
     m = 1, where the edges of smooth surfaces are not reconstructed, as of pads, and 0.36 in plane strain: the part is
     0.5/w^2 then, more than the error of 30 of 33 random cylinders and pads (root mean square 0.36). Measured on
     452 cycles of spheres and ellipsoids, centred on the grid and off it, cylinders and rough surfaces (error times
     w^2 sqrt(m), root mean squares): 0.52, 0.19, 0.28, 0.20.
  2. For alike bodies with quadratic gaps, constant N, and T along one line, the closed form of Cattaneo, Mindlin and
     Deresiewicz: with t = T/(mu N), its change over 2 mu N after a reversal, and c = disp/T without slip,

         E = 1.8 c (mu N)^2 (1 - (1 - t)^(5/3) - 5/6 t (1 + (1 - t)^(2/3))),      disp = 1.5 c mu N (1 - (1 - t)^(2/3)),

     and twice both after a reversal. The second equation has c from the solution, which has the displacement to 1e-3
     where the energy is wrong by half. In plane strain, where the displacement has no limit, with x = 1 - t and per
     length, E = (mu N)^2/(pi E*) (x ln(x) + (1 - x^2)/2), by the approach of two cylinders.

  Sources: R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327; J. Jaeger, Arch. Appl. Mech. 65 (1995) 478 (the
  shear of all alike bodies is a difference of two normal problems).
*/
#include "adviceimpl.h"
#include <petsam/private/bodyimpl.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/solutionimpl.h>
#include <math.h>

#define WRONG    0.3  /* the error of a branch over 1/(w^2 sqrt(m)) */
#define ALLOWED  0.05 /* error of the energy, relative to it */
#define GOOD     0.02 /* the same on a grid that is advised */
#define ROUGH    0.25 /* the same from which it is not known */
#define NARROW   0.25 /* cells: the width of a zone that is not known */
#define ACCEPTED 0.9  /* share of the edges whose reconstruction tells that they are known */
#define ALIKE    1e-6 /* coupling of bodies, or change of a load over the largest, that counts as none */
#define REVERSED 1.02 /* part of cells that stick, over that of the step before, of a reversal */
#define NOTHING  1e-6 /* energy over the tangential work that counts as none */
#define UNSURE   0.5  /* error of a step's energy by its length, relative to it, from which cells do not count */
#define PEAKED   1.25 /* cells: a zone in which the largest slip and shear are not right to 5 % */
#define SLIP     0.06 /* error of both over 1/w */
#define LINE     0.36 /* m in plane strain */
#define STUCK    7    /* cells across a stick zone whose area is wrong by less than 5 % */
#define LEAST    1.25 /* cells of a grid that is advised over those of this one */

/* ---- the width of the zone ---- */

/* Numbers of a step. */
typedef struct {
  PetscReal contact, stick, width, contact_cells, stick_cells, energy, unsure, accepted;
  double    known, faces; /* whether the edge of contact is reconstructed; its faces between cells */
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
  PetscCall(SamContactGetNumber(s->contact, "energy_error", &n->unsure));
  PetscCall(SamContactGetState(s->contact, &state));
  edge     = SamStateReadNumbers(state, SamStateFindNumber(state, SAM_CONTACT_EDGE));
  n->known = edge[SAM_CONTACT_EDGE_KNOWN];
  n->faces = edge[SAM_CONTACT_EDGE_FACES];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Width of the zone and length of the edge, in cells; flat periodic bodies have no edge, and an infinite width. */
static void Measure(const SamSetup *s, const Numbers *n, SamSlip *slip)
{
  const PetscBool row  = SamGridIsRow(s->grid);
  const double    cell = row ? (double)s->grid->dx : sqrt((double)(s->grid->dx * s->grid->dy));
  const double    edge = n->known > 0 ? SamContactEdgeLength(s->grid, n->faces) / (row ? 1 : cell)
                         : row        ? 2
                                      : 2 * sqrt(PETSC_PI * (double)n->contact) / cell;
  const double    area = (double)(n->contact - n->stick) / (row ? cell : cell * cell);

  if (n->known > 0)
    slip->width = n->faces > 0 ? n->width / cell : INFINITY;
  else
    slip->width = edge > 0 ? PetscMax(area / edge, 0) : INFINITY;
  slip->length = n->accepted < ACCEPTED && !SamAdviceIsFromFile(s) ? 1 : PetscMax(edge, 1);
  if (row) slip->length = LINE;
}

/* The error of a branch's energy, relative to it, unless it is larger than that. */
static double ErrorOf(PetscReal width, PetscReal length)
{
  return WRONG / ((double)(width * width) * sqrt((double)length));
}

/* Adds the branch, whose last zone this is. */
static void EndBranch(SamSlip *slip)
{
  const double error =
    PetscMin(slip->width > 0 ? ErrorOf(slip->width, slip->length) : 1, 1) * PetscMax(slip->branch, 0);

  slip->error += error;
  if (error >= slip->worst) {
    slip->worst     = error;
    slip->narrow[0] = slip->width;
    slip->narrow[1] = slip->length;
  }
  slip->branch = 0;
}

/* ---- the closed form ---- */

/* Whether the bodies have one. */
static PetscErrorCode HasClosedForm(const SamAdvice *a, PetscReal *friction, PetscBool *has)
{
  const SamSetup     *s        = a->setup;
  const double        waves[2] = {PETSC_PI / (double)s->grid->length, PETSC_PI / (double)s->grid->side[1]};
  SamElasticityTraits traits;
  SamGapType          type;
  SamLaw              law;
  const SamLaw       *laws;
  PetscInt            count;
  PetscBool           quadratic = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamGapGetParameters(s->gap, &type, NULL, NULL, NULL));
  for (int k = 0; k < 3 && type; k++)
    quadratic = quadratic || !strcmp(type, (const char *const[]){SAM_GAP_SPHERE, SAM_GAP_ELLIPSOID, SAM_GAP_CURVED}[k]);
  traits = SamElasticityGetTraits(s->elasticity);
  law    = SamProblemGetLaw(s->problem, SAM_LAW_COULOMB);
  PetscCall(SamLawGetFriction(law, friction));
  PetscCall(SamProblemGetLaws(s->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++)
    quadratic = quadratic && (laws[k] == law || laws[k]->always || laws[k]->accumulates);
  *has = quadratic && *friction > 0 && !a->most.open && !SamAdviceIsFromFile(s) && !traits.periodic && !traits.patch &&
         SamPairIsUniform(s->pair) && SamPairFilm(s->pair) == 0 && SamPairCoupling(s->pair, waves[0], waves[1]) < ALIKE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The energy of a branch from the change t of T and that of disp, `moved`; `reversed`: not of first loading. */
static double ClosedOf(const SamSetup *s, double bound, double t, double moved, PetscBool reversed)
{
  const double x = 1 - t;

  if (SamGridIsRow(s->grid))
    return (reversed ? 2 : 1) * bound * bound / (PETSC_PI * (double)SamPairModulus(s->pair)) *
           (x * log(x) + 0.5 * (1 - x * x));
  return 1.2 * bound * moved / (1 - pow(x, 2. / 3)) * (1 - pow(x, 5. / 3) - 5 * t / 6 * (1 + pow(x, 2. / 3)));
}

/* T starts from the line's last point to another way: Masing's rule holds up to where the last reversal was. */
static void Reverse(SamSlipPath *path)
{
  path->before += path->energy;
  path->limit    = path->reversed ? path->start : -path->last;
  path->start    = path->last;
  path->reversed = PETSC_TRUE;
  for (int k = 0; k < 2; k++) path->start_moved[k] = path->last_moved[k];
}

/* The closed form of the energy after a step with constant N and T on a line; `known`: it has one. */
static void Follow(const SamSetup *s, SamSlipPath *path, const SamStep *step)
{
  const PetscInt  c[2]  = {SAM_COMPONENT_TX, SAM_COMPONENT_TY};
  const double    bound = (double)(path->friction * step->load[SAM_COMPONENT_N]), slight = ALIKE * bound;
  const double    load[2] = {(double)step->load[c[0]], (double)step->load[c[1]]}, size = hypot(load[0], load[1]);
  const PetscBool first = path->line[0] == 0 && path->line[1] == 0;
  double          along, across, way = 0, t;

  if (first) path->bound = bound;
  for (int k = 0; k < 2 && first; k++) {
    if (size > slight) path->line[k] = load[k] / size;
    if (size <= slight) path->start_moved[k] = (double)step->rigid[c[k]];
  }
  along  = load[0] * path->line[0] + load[1] * path->line[1];
  across = load[0] * path->line[1] - load[1] * path->line[0];
  if ((along - path->last) * (path->last - path->start) < 0) Reverse(path);
  for (int k = 0; k < 2; k++) {
    path->last_moved[k] = (double)step->rigid[c[k]];
    way += (path->last_moved[k] - path->start_moved[k]) * path->line[k];
  }
  path->last = along;
  t          = fabs(along - path->start) / ((path->reversed ? 2 : 1) * bound);
  if (fabs(bound - path->bound) > slight || fabs(across) > slight || !(t < 1) ||
      fabs((double)step->load[SAM_COMPONENT_MZ]) > slight * (double)s->grid->length ||
      (path->reversed && fabs(along - path->start) > fabs(path->limit - path->start) + slight))
    path->known = PETSC_FALSE;
  else
    path->energy = t > 0 ? ClosedOf(s, bound, t, fabs(way), path->reversed) : 0;
}

/* ---- the steps ---- */

static PetscErrorCode IsUsual(const SamSetup *s, const SamControl *control, PetscBool *usual)
{
  const SamConditions conditions = SamProblemGetConditions(s->problem);

  PetscFunctionBegin;
  *usual = PETSC_TRUE;
  for (PetscInt k = 0; k < SamConditionsCount(conditions); k++) {
    const SamCondition *one = SamConditionsGet(conditions, k);

    *usual = *usual && SamControlGet(control, one) == one->usual;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdviceAddSlip(SamAdvice *a, PetscInt k, const SamStep *step)
{
  const SamSetup *s    = a->setup;
  SamSlip        *slip = &a->slip;
  double          work = 0, sticks;
  Numbers         n;
  PetscBool       usual;

  PetscFunctionBegin;
  if (SamProblemGetRolled(s->problem, &step->control, NULL) != 0) slip->rolls = PETSC_TRUE;
  if (slip->rolls) PetscFunctionReturn(PETSC_SUCCESS);
  if (!slip->steps++ && k == 0) PetscCall(HasClosedForm(a, &slip->path.friction, &slip->path.known));
  PetscCall(GetNumbers(s, &n));
  sticks = n.contact_cells > 0 ? (double)(n.stick_cells / n.contact_cells) : 1;
  if (sticks > REVERSED * slip->sticks) EndBranch(slip);
  Measure(s, &n, slip);
  slip->energy += (double)n.energy;
  slip->sticks = sticks;
  if (n.energy > 0 && slip->width < INFINITY) slip->widest = PetscMax(slip->widest, slip->width);
  /* N and T that grow together need not slip: what the length of a step may be all of is none of the cells' */
  if (a->steps > 1 && n.unsure > UNSURE * n.energy && n.energy > 0) {
    n.energy     = 0;
    slip->unsure = PETSC_TRUE;
  }
  slip->branch += (double)n.energy;
  for (PetscInt c = SAM_COMPONENT_TX; c <= SAM_COMPONENT_MZ; c++)
    if (slip->width < INFINITY) work += fabs((double)(step->load[c] * step->rigid[c]));
  if (work > NOTHING * NOTHING * fabs((double)(step->load[SAM_COMPONENT_N] * step->rigid[SAM_COMPONENT_N])))
    slip->work = PetscMax(slip->work, work);
  slip->pushed = step->control.force[SAM_COMPONENT_TX] && step->control.force[SAM_COMPONENT_TY] &&
                 step->control.force[SAM_COMPONENT_MZ];
  PetscCall(IsUsual(s, &step->control, &usual));
  if (!usual || n.stick_cells == 0) slip->path.known = PETSC_FALSE; /* or all slides */
  if (slip->path.known) Follow(s, &slip->path, step);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says that the zones are too narrow for the largest slip and shear, which are those of cells. */
static void Peaks(SamAdvice *a)
{
  const double width = (double)a->slip.widest;
  char         better[SAM_ADVICE_GRIDS];

  if (!(width > 0 && width < PEAKED)) return;
  SamAdviceGrids(a, PetscMax(2 * PEAKED / PetscMax(width, NARROW), LEAST), better);
  SamAdviceSay(
    a, better[0] ? "" : "grid_n",
    "the widest slip zone is %.2g times as wide as a cell: the maximum slip and shear may be wrong by %.0f %%%s", width,
    100 * PetscMin(SLIP / width, 1), better);
}

PetscErrorCode SamAdviceMeasureStick(SamAdvice *a)
{
  const SamSetup *s = a->setup;
  double         *state;
  PetscReal       contact, stick;
  PetscInt        cells;
  Vec             zone;

  PetscFunctionBegin;
  a->slip.across = INFINITY;
  if (a->slip.rolls || !(a->slip.work > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetNumber(s->contact, "contact_cells", &contact));
  PetscCall(SamContactGetNumber(s->contact, "stick_cells", &stick));
  if (stick == contact || (stick == 0 && !a->slip.pushed)) PetscFunctionReturn(PETSC_SUCCESS); /* or all slides */
  PetscCall(SamGridCreateVec(s->grid, 1, &zone));
  PetscCall(SamContactGetField(s->contact, "state", zone));
  PetscCall(VecGetLocalSize(zone, &cells));
  PetscCall(VecGetArray(zone, &state));
  for (PetscInt k = 0; k < cells; k++) state[k] = state[k] == SAM_CELL_STICK ? 1 : 0;
  PetscCall(VecRestoreArray(zone, &state));
  if (stick > 0) PetscCall(SamGridMeasureZones(s->grid, zone, 0, &a->slip.across));
  if (stick == 0) a->slip.across = 0;
  PetscCall(VecDestroy(&zone));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says that the area of stick in the last step is that of too few cells. */
static void Stick(SamAdvice *a)
{
  const double across = (double)a->slip.across;
  char         better[SAM_ADVICE_GRIDS];

  if (!(across < STUCK) || !(a->extent.across > 2 * STUCK)) return;
  SamAdviceGrids(a, STUCK / PetscMax(across, 1), better);
  SamAdviceSay(a, better[0] ? "" : "grid_n",
               "the stick zone is %.2g cells across in the last step: its area may be wrong by more than 5 %%%s",
               across, better);
}

static void Energy(SamAdvice *a)
{
  SamSlip          *slip  = &a->slip;
  const PetscBool   known = slip->path.known;
  const char *const unit  = SamUnitOn(a->setup->grid, "J");
  double            most, error, times;
  char              better[SAM_ADVICE_GRIDS], wrong[96] = "is not resolved";

  EndBranch(slip);
  slip->closed = known ? slip->path.before + slip->path.energy : NAN;
  if (known) slip->error = fabs(slip->closed - slip->energy);
  most  = known ? slip->closed : slip->energy;
  error = most > NOTHING * slip->work ? slip->error / most : slip->work > 0 && a->extent.finer && !slip->unsure ? 1 : 0;
  if (error <= ALLOWED) return;
  times = ErrorOf(PetscMax(slip->narrow[0], NARROW), slip->narrow[1]) / GOOD;
  SamAdviceGrids(a, PetscMax(pow(times, slip->narrow[1] > 1 ? 0.4 : 0.5), LEAST), better);
  if (known)
    (void)snprintf(wrong, sizeof(wrong), "is %.3g %s in closed form", slip->closed, unit);
  else if (error < ROUGH)
    (void)snprintf(wrong, sizeof(wrong), "may be wrong by %.0f %%", 100 * error);
  SamAdviceSay(a, better[0] ? "" : "grid_n",
               "slip zones are %.2g times as wide as a cell: the dissipated energy, %.3g %s, %s%s",
               (double)slip->narrow[0], slip->energy, unit, wrong, better);
}

void SamAdviceSlip(SamAdvice *a)
{
  if (!a->slip.steps || a->slip.rolls) return;
  Energy(a);
  Peaks(a);
  Stick(a);
}
