/*
  Advice before the first step: a contact that will be too large for its theory, values that act on nothing, and lengths
  in another unit than the grid's.
*/
#include "adviceimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/bodyimpl.h>
#include <petsam/private/gap.h>
#include <petsam/private/control.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/law.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/parameters.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>
#include <string.h>

/* ---- the size of a contact of bodies that yield ---- */

/*
  A body that yields bears this many times its flow stress as mean pressure, and its representative strain is this part
  of a over R (D. Tabor, The Hardness of Metals (1951)).
*/
#define BEARS  3
#define STRAIN 0.2
#define PASSES 30  /* halvings of the distance to the half width at which the body bears the load */
#define THIN   0.1 /* thickness of layers, relative to the half width, up to which they change it little */

/* Computes the half widths of the contact at the largest load; `known`: there is a closed form. Thin layers are
   neglected. */
static PetscErrorCode EstimateLargest(const SamSetup *s, const SamLoadRange *most, PetscReal half[2], PetscBool *known)
{
  PetscReal top = 0, least = INFINITY;

  PetscFunctionBegin;
  PetscCall(SamAdviceEstimate(s, most->force, most->normal, half, known));
  for (PetscInt b = 0; b < 2; b++) top = PetscMax(top, SamBodyAt(SamPairBody(s->pair, b), INFINITY).top);
  if (*known || top == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamAdviceEstimateContact(s, most->force, most->normal, half, known));
  for (int k = 0; k < s->grid->axes; k++) least = PetscMin(least, half[k]);
  if (!isfinite(half[0] + half[s->grid->axes - 1]) || !(top <= THIN * least)) *known = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the ratio of the half widths to the radius at the largest load, the larger of Hertz's and of the fully
  plastic one, and a text with it; 0: there is no closed form. `share`: the part of the half width that lies on the
  round surface, small at a punch with sharp edges, whose contact is not large.
*/
static PetscErrorCode Expect(const SamAdvice *a, PetscReal *ratio, PetscReal *share, char text[], size_t size)
{
  const SamSetup     *s    = a->setup;
  const SamLoadRange *most = &a->most;
  PetscReal           half[2], wide[2], mean, part;
  PetscBool           known = PETSC_FALSE;
  SamGapSteepness     steepness;

  PetscFunctionBegin;
  *ratio = *share = 0;
  if (!SamProblemYields(s->problem) || most->open || !most->steps || SamProblemMoves(s->problem))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(EstimateLargest(s, most, half, &known));
  if (!known) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamAdviceCompare(s, half, text, size, ratio));
  mean = SamGridIsRow(s->grid) ? most->normal / (2 * half[0]) : most->normal / (PETSC_PI * half[0] * half[1]);
  part = *ratio;
  PetscCall(PetscArraycpy(wide, half, 2));
  for (PetscInt k = 0; most->force && k<PASSES && * ratio> 0; k++) {
    PetscReal flow, times;

    PetscCall(SamProblemGetFlow(s->problem, STRAIN * part, &flow));
    times = PetscMax(1, mean / (BEARS * flow));
    for (int c = 0; c < 2; c++) wide[c] = half[c] * (SamGridIsRow(s->grid) ? times : sqrt(times));
    PetscCall(SamAdviceCompare(s, wide, text, size, ratio));
    part = 0.5 * (part + *ratio);
  }
  PetscCall(SamGapGetSteepness(s->gap, wide, &steepness));
  *share = steepness.ratio * fabs(steepness.radius) / (SamGridIsRow(s->grid) ? wide[0] : PetscMin(wide[0], wide[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamAdviceYieldingSize(SamAdvice *a)
{
  PetscReal ratio = 0, share;
  char      text[192];

  if (!a->error) a->error = Expect(a, &ratio, &share, text, sizeof(text));
  if (a->error || !(ratio > SAM_ADVICE_STEEPEST)) return;
  a->large = PETSC_TRUE;
  /* On the same grid, 20 Newton steps for 7, and twice as many products in each. */
  SamAdviceSay(
    a, "",
    "the contact will be too large for half-space theory: at the largest load its half width %s; a load step "
    "of such a contact takes several times as long as of a smaller one",
    text);
}

PetscErrorCode SamAdviceRefuse(const SamAdvice *a)
{
  PetscReal ratio = 0, share;
  char      text[192];

  PetscFunctionBegin;
  PetscCall(Expect(a, &ratio, &share, text, sizeof(text)));
  PetscCheck(!(PetscMin(ratio, share) > SAM_ADVICE_LARGEST), a->setup->grid->comm, SAM_ERR_USER,
             "the contact of bodies that yield will be far too large for half-space theory and small strains: at the "
             "largest load, %.6g %s, its half width %s: give less load, a larger radius, or a higher yield stress",
             (double)a->most.normal, a->most.force ? SamUnitOn(a->setup->grid, "N") : "m", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- values that act on nothing ---- */

/* Advises on bulk stress and a film where no shear can follow them. */
void SamAdviceIdle(SamAdvice *a)
{
  PetscBool rubs = PETSC_TRUE;

  if (!a->error) a->error = SamProblemHasFriction(a->setup->problem, &rubs);
  if (a->error || rubs) return;
  for (PetscInt b = 0; b < 2; b++)
    if (a->most.bulk[b] > 0 && !SamProblemBodyYields(a->setup->problem, b))
      SamAdviceSay(a, "",
                   "bulk%d_stress, up to %.3g Pa, has no effect on the contact: there is no friction, and body %d does "
                   "not yield: give -friction or -body%d_yield (only petsam-stress adds it)",
                   (int)b + 1, (double)a->most.bulk[b], (int)b + 1, (int)b + 1);
  if (SamPairFilm(a->setup->pair) > 0)
    SamAdviceSay(a, "", "-film_thickness has no effect without friction: give -friction, or remove it");
}

/* ---- lengths ---- */

/*
  Lengths, by the beginning of their options' names, and the largest ratio to the width of the grid that is not
  questioned. Of radii, the smallest counts, since others may make a body nearly flat along one axis.
*/
#define FLATTEST 2e4
static const struct {
  const char *name;
  double      most;
} lengths[] = {{"film_thickness", 1},           {"friction_path_length", 100}, {"friction_falling_memory", 100},
               {"gap_roller_half_length", 100}, {"gap_roller_crown", 0.1},     {"gap_roller_drop", 0.1},
               {"gap_half_flat_x", 100},        {"gap_half_flat_y", 100},      {"gap_flat_radius", 100}};

static void TellLength(SamAdvice *a, const char name[], double length, double most)
{
  const SamGrid g     = a->setup->grid;
  const double  width = (double)PetscMax(g->width[0], g->axes > 1 ? g->width[1] : 0), ratio = length / width;

  if (ratio > most)
    SamAdviceSay(a, "", "-%s %.6g is %.2g times the width of the grid, %.3g m, expected at most %g: check the unit, m",
                 name, length, ratio, width, most);
}

/* Collects the values of the bodies, the laws and the gap by the names of their options. */
static PetscErrorCode Collect(const SamSetup *s, SamParameters *p)
{
  const SamLaw      *laws;
  const char *const *names;
  const PetscReal   *values;
  PetscInt           count;

  PetscFunctionBegin;
  PetscCall(SamElasticityAddParameters(s->elasticity, p));
  PetscCall(SamProblemGetLaws(s->problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++) PetscCall(SamLawAddParameters(laws[k], p));
  PetscCall(SamGapGetParameters(s->gap, NULL, &count, &names, &values));
  for (PetscInt k = 0; k < count; k++) PetscCall(SamParametersAddReals(p, names[k], PETSC_TRUE, 1, &values[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Advises on lengths that are too large for the grid in the same unit. */
void SamAdviceLengths(SamAdvice *a)
{
  const char   *option = NULL;
  double        least  = INFINITY;
  SamParameters p      = {.count = 0};

  if (!a->error) a->error = Collect(a->setup, &p);
  for (PetscInt k = 0; !a->error && k < p.count; k++) {
    const SamParameter *one  = &p.list[k];
    const double        size = fabs((double)one->value[0]);

    if (!one->count) continue;
    for (size_t n = 0; n < sizeof(lengths) / sizeof(lengths[0]); n++)
      if (!strcmp(one->name, lengths[n].name)) TellLength(a, one->name, size, lengths[n].most);
    if (strncmp(one->name, "gap_", 4) || !strstr(one->name, "radius") || !(size < least) || size == 0) continue;
    if (!strcmp(one->name, "gap_flat_radius")) continue;
    least  = size;
    option = one->name;
  }
  if (!a->error && option) TellLength(a, option, least, FLATTEST);
}
