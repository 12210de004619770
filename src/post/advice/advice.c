/*
  Advice on a solution that may not be the intended one.

  Sizes of grids follow from closed-form solutions if there are any, since these hold even if the grid does not resolve
  the contact or ends within it; otherwise they follow from the contact that was found.
*/
#include "adviceimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/gap.h>
#include <petsam/private/law.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>

/* Part of the period above which the contact of a round body is affected by its periodic images */
#define CROWDED 0.25
/* A contact narrower than this part of its radius suggests that the radius is in another unit. */
#define FLATTEST 1e-3
#define ABSURD   4096 /* number of cells per row that wrong units may ask for */
#define BLIND    0.98 /* edge pressure relative to the largest, above which it does not indicate the size */

/* ---- the extent ---- */

static PetscErrorCode Measure(const SamSetup *s, SamExtent *extent)
{
  PetscFunctionBegin;
  PetscCall(SamAdviceMeasureZones(s, extent));
  PetscCall(SamAdviceMeasurePeak(s, extent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the size of the contact ---- */

PetscErrorCode SamAdviceCompare(const SamSetup *s, const PetscReal half[2], char text[], size_t size, PetscReal *ratio)
{
  SamGapSteepness steepness;

  PetscFunctionBegin;
  text[0] = '\0';
  PetscCall(SamGapGetSteepness(s->gap, half, &steepness));
  *ratio = steepness.ratio;
  if (!(steepness.ratio > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(text, size, "is %.2g times -%s %g (in m)", (double)steepness.ratio, steepness.option,
                 (double)steepness.radius);
  if (steepness.ratio > SAM_ADVICE_STEEPEST)
    (void)snprintf(text + strlen(text), size - strlen(text), ", the limit is about %g: check the units, N, m, Pa%s",
                   SAM_ADVICE_STEEPEST, steepness.concave ? "; conforming bodies need finite elements" : "");
  else if (steepness.ratio < FLATTEST)
    (void)snprintf(text + strlen(text), size - strlen(text), ", and less than %g of it is rare: check the unit, m",
                   FLATTEST);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

static void Touch(SamAdvice *a)
{
  const SamControl *control = &a->step->control;
  const PetscBool   force   = control->force[SAM_COMPONENT_N];

  if (a->extent.zones || SamProblemAttracts(a->setup->problem)) return; /* apart they attract each other */
  SamAdviceSay(a, force ? "load_n" : "disp_z",
               "the bodies do not touch in any step: the %s is %g %s at most, and must exceed %s",
               force ? "normal force" : "approach", (double)control->value[SAM_COMPONENT_N],
               force ? SamUnitOn(a->setup->grid, "N") : "m", force ? "0" : "0, or the smallest separation");
}

/* Notes the numbers that are unknown of a contact of next to no cells; units: what is said where these may be wrong. */
static void Unresolved(SamAdvice *a, double more, const char zones[], const char units[])
{
  const SamExtent *extent = &a->extent;
  const PetscBool  force  = a->step->control.force[SAM_COMPONENT_N];
  PetscReal        shear  = 0;
  char             names[160], closed[SAM_ADVICE_TEXT] = "";

  if (!a->error) a->error = SamContactGetNumber(a->setup->contact, "shear_max", &shear);
  (void)snprintf(names, sizeof(names), "contact_area pressure_max%s%s",
                 !force ? " load_n"
                 : SamAdviceWidth(a) < SAM_ADVICE_SAME && extent->zones < SAM_ADVICE_SAME
                   ? " disp_z" /* of several spots it is that of heights */
                   : "",
                 shear > 0 ? " shear_max stick_area slip_max dissipated_energy" : "");
  if (a->closed) (void)snprintf(closed, sizeof(closed), ", %.2g in closed form", (double)a->across);
  /* a more special reason, with an error of 1, precedes this one */
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1 - PETSC_SQRT_MACHINE_EPSILON, more, names, SAM_ACROSS "%s%s", zones,
               (double)extent->across, extent->across == 1 ? "" : "s", closed, units);
}

/*
  Advises on a contact that is few cells across, or a peak of pressure that is not resolved; proposes better grids.
*/
static void Cells(SamAdvice *a)
{
  const SamSetup  *s      = a->setup;
  const SamExtent *extent = &a->extent;
  PetscBool        ends[2];
  /* In periodic bodies all cells may be in contact; the contact then has no width. */
  const PetscBool whole  = !SamAdviceIsStrip(a, ends) && extent->whole;
  const int       fewest = SamAdviceFewest(a);
  const PetscBool few    = !whole && extent->across < fewest;
  const PetscBool sharp  = fabs(extent->change) > (a->worn ? SAM_WORN_PEAK : SAM_DOUBT_LARGE) && !extent->finer;
  const double    change = fabs((double)extent->change), more = (fewest + SAM_ADVICE_SAME) / (double)a->across;
  /* what is said of it is told whole */
  const double    error  = a->worn && change <= SAM_WORN_PEAK ? change * SAM_DOUBT_LARGE / SAM_WORN_PEAK : change;
  const PetscBool none   = few && SamAdviceWidth(a) < SAM_ADVICE_BORDER;
  const PetscBool absurd = more * (double)PetscMax(s->grid->nx, s->grid->ny) > ABSURD;
  const char     *units  = absurd ? ": check the units, N, m, Pa" : "";
  char            zones[SAM_ADVICE_TEXT] = "";

  if (extent->zones > 1)
    (void)snprintf(zones, sizeof(zones), "in %lld spots, the narrow ones ", (long long)extent->zones);
  if (few)
    SamDoubtsAdd(&a->guesses, SAM_CAUSE_CELLS, SAM_DOUBT_LARGE * fewest / (double)extent->across, more, "contact_area",
                 SAM_ACROSS "%s", zones, (double)extent->across, extent->across == 1 ? "" : "s", units);
  if (sharp)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1, 0, "pressure_max",
                 "pressure_max grows without limit on finer cells, as at a sharp edge");
  else
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, none && error > SAM_DOUBT_LARGE ? 1 : error, (double)extent->finer,
                 "pressure_max", "pressure_max is about %.0f %% %s on cells half as wide", 100 * change,
                 extent->change > 0 ? "higher" : "lower");
  if (none) Unresolved(a, more, zones, units); /* after the reason above, which then stands */
}

/* Advises on heights in another unit, or tilted. If no surface has such heights, the grid is not questioned. */
static void Surfaces(SamAdvice *a)
{
  const SamSetup *s                              = a->setup;
  char            text[PETSC_MAX_PATH_LEN + 500] = "";

  a->error = SamGapAdvise(s->gap, s->grid, SamProblemGetGap(s->problem), SamElasticityGetTraits(s->elasticity).periodic,
                          &a->doubtful, text, sizeof(text));
  if (!a->error && text[0]) SamAdviceSay(a, "", "%s", text);
}

/*
  Advises on steps of heights from a file. The peak of the pressure then grows without limit, and no grid is advised for
  it.
*/
static void Steps(SamAdvice *a)
{
  const SamSetup    *s = a->setup;
  const SamSolution *solution;
  PetscReal          limit                          = INFINITY;
  char               text[PETSC_MAX_PATH_LEN + 400] = "";

  a->error = SamProblemGetPressureLimit(s->problem, &limit);
  if (a->error || limit < INFINITY) return;
  a->error = SamContactGetSolution(s->contact, &solution);
  if (!a->error)
    a->error = SamGapAdviseStep(s->gap, s->grid, SamProblemGetGap(s->problem), solution->pressure,
                                (double)SamPairModulus(s->pair), text, sizeof(text));
  if (a->error || !text[0]) return;
  SamAdviceSay(a, "", "%s", text);
  a->extent.change = 0;
  a->extent.finer  = 0;
  a->stepped       = PETSC_TRUE;
}

/* Passes on the advice of the bodies on these cells and on a contact of these half widths. */
static void Bodies(SamAdvice *a)
{
  const PetscReal width = 2 * PetscMax(a->half[0], a->half[1]);
  const char     *option;
  char            text[256] = "";

  for (PetscInt k = 0; k < 4 && !a->error; k++) {
    a->error = SamBodyAdvise(SamPairBody(a->setup->pair, k / 2), k / 2 + 1, k % 2, a->setup->grid->side[1], width,
                             &option, text, sizeof(text));
    if (!a->error && text[0]) SamAdviceSay(a, option, "%s", text);
  }
}

/* Advises on a contact so wide relative to the period that its images interact. */
static void Images(SamAdvice *a)
{
  const SamSetup   *s       = a->setup;
  const SamGrid     g       = s->grid;
  const SamControl *control = &a->step->control;
  const PetscReal   cell[2] = {g->dx, g->dy};
  PetscReal         closed[2];
  double            share = 0, times = 1, width[2];
  PetscBool         known;
  char              grid[3 * SAM_ADVICE_TEXT];

  if (a->error || !SamElasticityGetTraits(s->elasticity).periodic) return;
  a->error = SamAdviceEstimate(s, control->force[SAM_COMPONENT_N], control->value[SAM_COMPONENT_N], closed, &known);
  if (a->error || !known) return;
  for (PetscInt k = 0; k < g->axes; k++) {
    share = PetscMax(share, 2 * (double)(a->extent.half[k] / g->width[k]));
    times = PetscMax(times, 2 * (double)(closed[k] + cell[k]) / (CROWDED * (double)g->width[k]));
  }
  if (!(share > CROWDED)) return;
  times = PetscMax(times, share / CROWDED);
  for (int k = 0; k < 2; k++) width[k] = SamAdviceRoundUp(times * (double)g->width[k]);
  SamAdviceWriteGrid(s, width, grid, sizeof(grid));
  SamAdviceSay(a, "",
               "the contact is %.2g of the period wide, and periodic images of it interact from about %g on: for a "
               "single contact use -elasticity %s, or %s",
               share, CROWDED, g->axes > 1 ? "halfspace" : "plane", grid);
}

/* Advises on a contact that is wide relative to its radius, or a pressure beyond linear elasticity. */
static void Size(SamAdvice *a)
{
  const double modulus = SamPairStiffest(a->setup->pair);
  PetscReal    most = 0, part = 0;
  char         ratio[192];

  if (!a->error) a->error = SamAdviceCompare(a->setup, a->half, ratio, sizeof(ratio), &part);
  if (!a->error) a->error = SamContactGetNumber(a->setup->contact, "pressure_max", &most);
  if (!a->error && part > SAM_ADVICE_STEEPEST && !a->large)
    SamAdviceSay(a, "", "contact too large for half-space theory: its half width %s", ratio);
  if (!a->error && most > SAM_ADVICE_HARDEST * modulus && !a->stepped)
    SamAdviceSay(a, "",
                 "the maximum pressure, %.3g Pa, is %.2g of E*, linear elasticity holds up to about %g: check the %s",
                 (double)most, (double)most / modulus, SAM_ADVICE_HARDEST,
                 SamGapHasFile(a->setup->gap) ? "unit of the dataset, and N, m, Pa" : "units, N, m, Pa");
}

/* All advice, in this order: before the first step, on the largest load, on a contact, and on a worn contact */
static const struct {
  enum { BEFORE, LARGEST, CONTACT, WORN } when;
  void (*look)(SamAdvice *advice);
} advices[] = {{BEFORE, Surfaces},
               {BEFORE, SamAdviceFriction},
               {BEFORE, SamAdviceYieldingSize},
               {BEFORE, SamAdviceLengths},
               {LARGEST, SamAdviceIdle},
               {LARGEST, SamAdviceUnits},
               {LARGEST, SamAdviceMotion},
               {LARGEST, SamAdviceDatum},
               {LARGEST, Touch},
               {CONTACT, Steps},
               {CONTACT, Cells},
               {CONTACT, Bodies},
               {CONTACT, Images},
               {CONTACT, Size},
               {CONTACT, SamAdviceMeshes},
               {WORN, Cells},
               {WORN, SamAdviceMeshes},
               {WORN, SamAdviceStroke}};

static PetscErrorCode LookAt(SamAdvice *a, int when)
{
  PetscFunctionBegin;
  a->error = PETSC_SUCCESS;
  for (size_t k = 0; k < sizeof(advices) / sizeof(advices[0]); k++)
    if ((int)advices[k].when == when) (*advices[k].look)(a);
  PetscCall(a->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdviceBegin(SamAdvice *a)
{
  PetscFunctionBegin;
  PetscCall(LookAt(a, BEFORE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Passes on the advice of the laws on a step, each piece once. */
static PetscErrorCode LookAtLaws(SamAdvice *a, PetscInt k)
{
  char advice[400];

  PetscFunctionBegin;
  for (PetscInt law = 0;; law++) {
    PetscCall(SamContactAdvise(a->setup->contact, &law, advice, sizeof(advice)));
    if (!advice[0]) break;
    if (a->advised[law]) continue;
    a->advised[law] = PETSC_TRUE;
    SamAdviceSay(a, "steps", "step %" PetscInt_FMT ": %s", k + 1, advice);
  }
  PetscCall(a->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Asks the laws to examine the step, or to add their doubts. */
enum { EXAMINE, DOUBT };
static PetscErrorCode AskLaws(SamAdvice *a, int what)
{
  const SamSetup *s = a->setup;
  SamExamination  x = {.contact    = s->contact,
                       .grid       = s->grid,
                       .elasticity = s->elasticity,
                       .extent     = &a->extent,
                       .slip       = &a->slip,
                       .passed     = a->passed,
                       .cycles     = a->cycles,
                       .spent      = SamAdviceIsSpent(a),
                       .doubts     = &a->doubts,
                       .tell       = a->receive,
                       .context    = a->context};
  const SamLaw   *laws;
  PetscInt        count;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->contact, &x.state));
  PetscCall(SamProblemGetLaws(s->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++) {
    x.kept = a->kept[k];
    if (what == EXAMINE && laws[k]->ops.examine) PetscCall((*laws[k]->ops.examine)(laws[k], &x));
    if (what == DOUBT && laws[k]->ops.doubt) PetscCall((*laws[k]->ops.doubt)(laws[k], &x));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamAdviceBeginCycle(SamAdvice *a)
{
  a->begun  = a->begun > 0 ? a->begun : (PetscReal)a->slip.energy;
  a->slip   = (SamSlip){.joined = PETSC_TRUE};
  a->cycles = PETSC_TRUE;
}

void SamAdviceRenew(SamAdvice *a)
{
  if (!a->examined || !SamProblemMoves(a->setup->problem)) return;
  a->examined = PETSC_FALSE;
  a->worn     = PETSC_TRUE;
}

PetscErrorCode SamAdviceStep(SamAdvice *a, PetscInt k, PetscBool of_laws, const SamStep *step, const SamExtent **found)
{
  PetscFunctionBegin;
  *found = NULL;
  if (!SamStepIsSolved(step)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!a->examined && k >= a->largest) {
    a->examined = PETSC_TRUE;
    a->step     = step;
    PetscCall(Measure(a->setup, &a->extent));
    if (!a->worn) *found = &a->extent;
    if (!a->worn) PetscCall(LookAt(a, LARGEST));
    /* At the grid's edge the grid determines the size of the contact. */
    if (a->extent.zones && step->check.edge <= 0 && !a->doubtful) {
      PetscCall(SamAdviceGetWidths(a));
      a->doubts.count = a->guesses.count = 0; /* those of the surfaces before wear */
      PetscCall(LookAt(a, a->worn ? WORN : CONTACT));
    }
  }
  if (of_laws) PetscCall(LookAtLaws(a, k));
  PetscCall(AskLaws(a, EXAMINE));
  if (SamMotionOf(a->setup->elasticity)->continues)
    PetscCall(SamAdviceAddSlip(a, step));
  else
    PetscCall(SamAdviceAddRolling(a, k, step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdviceEnd(SamAdvice *a, const SamSlip **found)
{
  PetscFunctionBegin;
  a->error = PETSC_SUCCESS;
  PetscCall(SamAdviceMeasureStick(a));
  SamAdviceSlip(a);
  SamAdviceRolling(a);
  SamAdviceUnloaded(a);
  if (!a->error) PetscCall(AskLaws(a, DOUBT));
  if (found) *found = PetscMax(a->slip.energy, a->slip.ring.energy) > 0 ? &a->slip : NULL;
  PetscCall(a->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the edge ---- */

/*
  Estimates the half widths if there is no closed-form solution. The distance from the grid's edge to the contact's edge
  follows from the pressure at the grid's edge, as for Hertz's p0 sqrt(1 - r^2/a^2); widths grow at most like the root
  of the load.
*/
static void Extrapolate(const SamSetup *s, const SamStep *step, const SamLoadRange *most, PetscReal half[2])
{
  const double edge   = PetscMin(BLIND, (double)step->check.edge);
  const double now    = (double)(most->force ? step->load[SAM_COMPONENT_N] : step->rigid[SAM_COMPONENT_N]);
  const double growth = now > 0 && most->normal > now ? sqrt((double)most->normal / now) : 1;

  for (int k = 0; k < 2; k++) half[k] = 0.5 * s->grid->width[k] / sqrt(1 - edge * edge) * growth;
}

/*
  Returns half the width that a grid needs along an axis for a contact of this half width about the origin, or beside
  it.
*/
static double ReachOf(const SamSetup *s, const PetscReal half[2], const PetscReal lever[2], int k)
{
  return (double)(half[k] + lever[k]) * SAM_MARGIN + fabs((double)s->grid->center[k]);
}

/* True if the grid would hold a contact of these half widths. */
static PetscBool Fits(const SamSetup *s, const PetscReal half[2], const PetscReal lever[2])
{
  for (int k = 0; k < s->grid->axes; k++)
    if (2 * ReachOf(s, half, lever, k) > (double)s->grid->width[k]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Writes the grid with the same cells for a contact of these half widths about the origin, or a larger grid. */
static void AdviseGrid(const SamSetup *s, const PetscReal half[2], const PetscReal lever[2], char text[], size_t size)
{
  const PetscReal cell[2] = {s->grid->dx, s->grid->dy};
  double          width[2];

  for (int k = 0; k < 2; k++) {
    const double needs = 2 * ReachOf(s, half, lever, k) + SAM_ADVICE_BORDER * (double)cell[k];

    width[k] = PetscMax((double)s->grid->width[k], SamAdviceRoundUp(needs));
  }
  if (s->grid->nx == s->grid->ny && s->grid->width[0] == s->grid->width[1])
    width[0] = width[1] = PetscMax(width[0], width[1]);
  SamAdviceWriteGrid(s, width, text, size);
}

/*
  Writes the number of cells with which the grid, at its present size, resolves a contact of these half widths within
  it; an empty text unless the cells are so wide that this contact reaches the border.
*/
static void AdviseCells(const SamSetup *s, const PetscReal half[2], char text[], size_t size)
{
  const PetscReal cell[2]   = {s->grid->dx, s->grid->dy};
  PetscReal       across    = INFINITY;
  PetscBool       coarse    = PETSC_FALSE;
  PetscBool       refine[2] = {PETSC_FALSE, PETSC_FALSE};
  char            cells[SAM_ADVICE_TEXT], width[SAM_ADVICE_TEXT];

  text[0] = '\0';
  for (int k = 0; k < s->grid->axes; k++) {
    if (2 * (half[k] + cell[k]) > s->grid->width[k]) coarse = PETSC_TRUE;
    refine[k] = 2 * half[k] / cell[k] < SAM_ADVICE_FEW_CLOSED ? PETSC_TRUE : PETSC_FALSE;
    across    = PetscMin(across, 2 * half[k] / cell[k]);
  }
  if (!coarse || !(across < SAM_ADVICE_FEW_CLOSED)) return;
  SamAdviceGridsFor(s, half, (SAM_ADVICE_FEW_CLOSED + SAM_ADVICE_SAME) / (double)across, refine, cells, width);
  if (cells[0]) (void)snprintf(text, size, "; its cells are too wide, the contact fits into it: use %s", cells);
}

/* Writes the grid that contains the contact in all displacements of the run, on which body 2's surface is stored. */
static PetscErrorCode AdviseStroke(const SamAdvice *a, const SamStep *step, char text[], size_t size)
{
  const PetscReal *moved    = &step->rigid[SAM_COMPONENT_TX];
  const PetscReal  times    = PetscMax(1, a->most.slide / (PetscReal)hypot(moved[0], moved[1]));
  const PetscReal  reach[2] = {times * PetscAbsReal(moved[0]) + a->most.lever[0],
                               times * PetscAbsReal(moved[1]) + a->most.lever[1]};
  SamExtent        extent;

  PetscFunctionBegin;
  PetscCall(Measure(a->setup, &extent));
  AdviseGrid(a->setup, extent.half, reach, text, size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the message of a contact at the edge that a layer is too thick for any grid; `known`: a grid is known. */
static PetscErrorCode AdviseThickness(const SamAdvice *a, char text[], size_t size, PetscBool *known)
{
  const SamGrid g = a->setup->grid;
  const char   *option;
  char          layer[256] = "";

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2 && !layer[0]; b++)
    PetscCall(SamBodyAdvise(SamPairBody(a->setup->pair, b), b + 1, 1, g->side[1], PetscMax(g->width[0], g->width[1]),
                            &option, layer, sizeof(layer)));
  if (layer[0]) (void)snprintf(text, size, "; %s", layer);
  *known = layer[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the kind of bodies that have no edge. */
static const char *PeriodicOf(const SamSetup *s)
{
  return SamGridIsRow(s->grid) ? "plane_periodic" : "periodic";
}

/* Writes what a contact needs that reaches the edge of any grid, as surfaces that are flat along an axis do. */
static void AdvisePeriods(const SamSetup *s, const PetscReal half[2], char text[], size_t size)
{
  const char *const periods = SamGridIsRow(s->grid) ? "" : ", and makes both x and y periodic";

  if (isinf(half[0]) && (isinf(half[1]) || SamGridIsRow(s->grid)))
    (void)snprintf(text, size,
                   "; the surfaces are flat, and touch up to the edge of any grid: use -elasticity %s, which has no "
                   "edge%s, or give a shape that ends",
                   PeriodicOf(s), periods);
  else
    (void)snprintf(text, size,
                   "; the bodies are cylindrical, axis along %s, and touch up to the edge of any grid: use -elasticity "
                   "%speriodic, which has no edge%s",
                   isinf(half[0]) ? "x" : "y", isinf(half[0]) ? "" : "plane, a section with loads per metre, or ",
                   periods);
}

PetscErrorCode SamAdviceEdge(const SamAdvice *a, SamStep *step)
{
  const SamSetup     *s    = a->setup;
  const SamLoadRange *most = &a->most;
  const size_t        used = strlen(step->message), size = sizeof(step->message) - used;
  char *const         text = step->message + used;
  PetscReal           half[2];
  PetscReal           part = 0;
  PetscBool           known, thick                          = PETSC_FALSE;
  char                grid[3 * SAM_ADVICE_TEXT], ratio[192] = "";

  PetscFunctionBegin;
  if (SamStepIsSolved(step) && !strcmp(step->setting, "slide")) {
    PetscCall(AdviseStroke(a, step, grid, sizeof(grid)));
    (void)snprintf(text, size, "; it needs about %s", grid);
    step->setting[0] = '\0';
  }
  if (!SamStepIsSolved(step) || strcmp(step->setting, "grid_size") || !most->steps) PetscFunctionReturn(PETSC_SUCCESS);
  step->setting[0] = '\0'; /* the text names the options */
  PetscCall(AdviseThickness(a, text, size, &thick));
  if (thick) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamAdviceEstimate(s, most->force, most->normal, half, &known));
  if (isinf(half[0]) || isinf(half[1])) {
    AdvisePeriods(s, half, text, size);
  } else if (SamGapHasFile(s->gap)) {
    (void)snprintf(
      text, size,
      "; a surface from a file cannot be enlarged: give a file of a larger area, less load, or -elasticity "
      "%s if the surface continues beyond its border",
      PeriodicOf(s));
  } else {
    /* No closed-form solution describes a contact that wears, tilts or yields, or ends within the grid. */
    known = known && !SamProblemMoves(s->problem) && !most->open && !SamProblemYields(s->problem);
    if (known && Fits(s, half, most->lever)) {
      AdviseCells(s, half, text, size);
      if (text[0]) PetscFunctionReturn(PETSC_SUCCESS);
      known = PETSC_FALSE;
    }
    if (!known) Extrapolate(s, step, most, half);
    AdviseGrid(s, half, most->lever, grid, sizeof(grid));
    if (known) PetscCall(SamAdviceCompare(s, half, ratio, sizeof(ratio), &part));
    if (part > SAM_ADVICE_LARGEST) {
      (void)snprintf(text, size, "; no grid does: its half width, %.3g m, %s",
                     PetscMax((double)half[0], (double)half[1]), ratio);
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    (void)snprintf(text, size, "; it needs %s%s%s%s", known ? "" : "about ", grid,
                   ratio[0] ? "; the contact's half width " : "", ratio);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
