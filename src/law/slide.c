/*
  Surfaces that slide past each other. The grid goes with body 1; under its point x lies the point x + D of body 2. What
  laws keep at body 2's own points, as it has been worn there, stays there and is read at x + D in each step:

      h(x) = h1(x) + h2(x + D),   R: (R f)(x) = f(x + D) by cubic interpolation

  What the pressure at x does to body 2 is written by the transpose of R. So volumes are exact, and the two together
  cannot make waves that grow.

  A point x of body 1 is over the point x + d - u_t(x) of body 2, d being the rigid displacement: where it sticks, that
  stays. D is that of the point that is the last to slip, so that nothing moves while any point sticks. It is a slider
  that d pulls by a spring: it stays while the stretch d - D is at most L, and else follows at that length. Where all of
  the contact slips along e, u_t is what the bound of the shear does along e, and L the largest part of that along e in
  contact; elsewhere the surfaces move more than D, by what bends the bodies there. D so depends on d alone while the
  surfaces slide, and returns with it. Within a step d and L are known when it is solved; before, d is that which is
  given, or else that of the step before as L is. The slip of the step does not depend on D.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/fieldfile.h>
#include <petsam/private/grid.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/state.h>
#include <math.h>

/*
  The numbers in the state: D of the step, which is offered, the slider at its end, also across the plane of plane
  strain, and L. The change of D, parts of a cell, that counts.
*/
enum { SLIDE_X, SLIDE_Y, SLIDER_X, SLIDER_Y, LIMIT };
#define SLIDE_XY "slide_x"
#define SLIDES   1e-3

typedef struct {
  PetscBool given;
  Vec       surface; /* of body 2, a part of the separation (m); NULL: flat */
} Slide;

PetscBool SamSlideGet(SamState state, SamGeneration generation, PetscReal slide[2])
{
  const PetscInt id = SamStateFindNumber(state, SLIDE_XY);
  const double  *n  = id < 0                    ? NULL
                      : generation == SAM_TRIED ? SamStateReadNumbers(state, id)
                                                : SamStateNumbers(state, id, generation);

  for (int k = 0; k < 2; k++) slide[k] = n ? n[SLIDE_X + k] : 0;
  return n != NULL;
}

void SamSlideSet(SamState state, const PetscReal slide[2])
{
  const PetscInt id = SamStateFindNumber(state, SLIDE_XY);
  double        *n  = id < 0 ? NULL : SamStateNumbers(state, id, SAM_COMMITTED);

  for (int k = 0; k < 2 && n; k++) n[SLIDE_X + k] = slide[k];
}

void SamSlideRewind(SamState state, SamGeneration generation, const PetscReal by[2])
{
  const PetscInt id = SamStateFindNumber(state, SLIDE_XY);
  double        *n  = id < 0 ? NULL : SamStateNumbers(state, id, generation);

  for (int k = 0; k < 2 && n; k++) {
    n[SLIDE_X + k] -= by[k];
    n[SLIDER_X + k] -= by[k];
  }
}

PetscErrorCode SamSlideRead(SamElasticity elasticity, const PetscReal slide[2], Vec body2, Vec field)
{
  const PetscBool periodic = SamElasticityGetTraits(elasticity).periodic;

  PetscFunctionBegin;
  PetscCall(SamGridMove(SamElasticityGetGrid(elasticity), 1, slide, periodic ? SAM_BORDER_WRAPS : SAM_BORDER_ZERO,
                        body2, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSlideWrite(SamElasticity elasticity, const PetscReal slide[2], Vec field, Vec body2)
{
  PetscFunctionBegin;
  PetscCall(SamSlideRead(elasticity, (const PetscReal[]){-slide[0], -slide[1]}, field, body2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawSetSurface(SamLaw law, Vec surface)
{
  Slide *const s = (Slide *)law->data;

  PetscFunctionBegin;
  PetscCheck(!strcmp(law->type, SAM_LAW_SLIDE), law->grid->comm, PETSC_ERR_ARG_WRONG, "The law %s has no surface",
             law->type);
  PetscCall(SamGridCheckVec(law->grid, 1, surface, "The surface"));
  if (!s->surface) PetscCall(SamGridCreateVec(law->grid, 1, &s->surface));
  PetscCall(VecCopy(surface, s->surface));
  law->of_body2 = PETSC_TRUE;
  law->revision++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- options ---- */

static const SamOptionRow slide_row = {"slide", "the surfaces move past each other by the displacements of the history",
                                       SAM_OPTION_BOOL, .member = offsetof(Slide, given)};

/* What surfaces that slide do not go with, and why. */
static PetscErrorCode Refuse(const SamOptions *from)
{
  static const char *const refused[][2] = {
    {"body2_compliance", "body 2 moves away from the place that its compliance has: give it to body 1"},
    {"pressure_limit", "one depth of yielding cannot stay with two surfaces"},
    {"step_rtol", "what a part of a step wears depends on where body 2 is in it: use more steps"},
    {"stiffness", "the gap changes with the displacements, which the tangent leaves out"}};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(refused) / sizeof(refused[0]); k++) {
    PetscBool has;

    PetscCall(SamOptionsHas(from, refused[k][0], &has));
    PetscCheck(!has, from->comm, SAM_ERR_USER, "-%sslide does not work with -%s%s: %s", SamOptionsPrefix(from),
               SamOptionsPrefix(from), refused[k][0], refused[k][1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  SamFieldFile source = {
    .file_option = "body2_surface_file", .dataset_option = "body2_surface_dataset", SAM_FIELD_FILE_OF_LENGTHS};
  PetscErrorCode ierr;
  Vec            surface;

  PetscFunctionBegin;
  *asked = ((const Slide *)law->data)->given;
  PetscCall(SamFieldFileSetFromOptions(&source, from, "HDF5 file with heights added to the gap, which go with body 2"));
  if (SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(*asked || !source.file[0], from->comm, SAM_ERR_USER,
             "-%sbody2_surface_file is given without -%sslide: a surface that does not move is -%sgap_rough_file",
             SamOptionsPrefix(from), SamOptionsPrefix(from), SamOptionsPrefix(from));
  if (*asked) PetscCall(Refuse(from));
  if (!source.file[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(law->grid, 1, &surface));
  ierr = SamFieldFileRead(&source, law->grid, surface);
  if (!ierr) ierr = SamLawSetSurface(law, surface);
  PetscCall(VecDestroy(&surface));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  const Slide *s = (const Slide *)law->data;
  uint64_t     checksum;

  PetscFunctionBegin;
  PetscCall(SamParametersAddText(p, "slide", PETSC_TRUE, "true"));
  if (!s->surface) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridChecksum(law->grid, s->surface, &checksum));
  PetscCall(SamParametersAddChecksum(p, "body2_surface_file", checksum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

#define SLIDE(axis) \
  { \
    "slide_" axis, "m", "displacement of body 1 over body 2 along " axis ", by which body 2's surface is read", \
      SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0 \
  }

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateNumber numbers[3] = {
    SLIDE("x"), SLIDE("y"), {.name = "slider", .unit = "m", .text = "", .count = 3, .kept = PETSC_TRUE}};
  PetscInt id;

  PetscFunctionBegin;
  (void)law;
  for (int k = 0; k < 3; k++) PetscCall(SamStateDeclareOptional(state, &numbers[k], 0, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Check(SamLaw law, SamControl *control, const SamCondition **wrong, char why[], size_t size)
{
  static const char *const rolled[2] = {"roll", "roll_y"};

  PetscFunctionBegin;
  for (int k = 0; k < 2 && !why[0]; k++) {
    const SamCondition *one = SamConditionsFind(law->conditions, rolled[k]);

    if (SamControlGet(control, one) == one->usual) continue;
    *wrong = one;
    (void)snprintf(why, size, "expected 0 with -slide: in rolling both bodies move through the contact");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is given, else what the step before has found: 0 before the first one. */
static double Rigid(SamState state, const SamControl *control, SamComponent component)
{
  const double found =
    *SamStateNumbers(state, SamStateFindNumber(state, SamComponentNames[component].rigid), SAM_COMMITTED);

  if (SamControlWay(control, component) == SAM_BY_RIGID) return (double)control->value[component];
  return isfinite(found) ? found : 0;
}

/* The slider follows what pulls it by a spring that stretches no longer than the limit. */
static void Pull(const double by[2], double limit, double slider[2])
{
  const double stretch = hypot(by[0] - slider[0], by[1] - slider[1]);

  for (int k = 0; k < 2 && stretch > limit; k++) slider[k] = by[k] - (by[k] - slider[k]) * limit / stretch;
}

static PetscErrorCode Begin(SamLaw law, SamState state, const SamControl *control, PetscReal duration)
{
  static const SamComponent along[2] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY};

  const SamGrid   grid    = law->grid;
  const PetscInt  id      = SamStateFindNumber(state, SLIDE_XY);
  const double   *before  = SamStateNumbers(state, id, SAM_COMMITTED);
  double *const   now     = SamStateNumbers(state, id, SAM_TRIED);
  const PetscReal cell[2] = {grid->dx, grid->dy};
  const double    turn    = fabs(Rigid(state, control, SAM_COMPONENT_MZ)),
               most       = 2 * (double)(PetscMin(grid->dx, grid->dy) / PetscMax(grid->width[0], grid->width[1]));
  const PetscBool given   = SamControlWay(control, SAM_COMPONENT_MZ) == SAM_BY_RIGID;
  const double    by[2]   = {Rigid(state, control, along[0]), Rigid(state, control, along[1])};
  double          to[2]   = {before[SLIDER_X], before[SLIDER_Y]};
  PetscBool       moves   = PETSC_FALSE;

  PetscFunctionBegin;
  (void)duration;
  PetscCheck(
    grid->axes < 2 || turn <= most, grid->comm, SAM_ERR_USER,
    "%s of %.6g with -slide%s: expected at most %.6g, a cell at the border of the grid: surfaces slide without "
    "turning over each other: %s",
    SamComponentNames[SAM_COMPONENT_MZ].rigid, turn, given ? "" : ", found for load_mz in the step before", most,
    given ? "give 0" : "give rot_z = 0 instead of load_mz");
  Pull(by, before[LIMIT], to);
  for (int k = 0; k < grid->axes; k++) moves = moves || fabs(to[k] - before[k]) >= SLIDES * (double)cell[k];
  for (int k = 0; k < 2; k++) now[k] = moves && k < grid->axes ? to[k] : before[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Separation(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds)
{
  const Slide    *s        = (const Slide *)law->data;
  const PetscBool periodic = SamElasticityGetTraits(law->elasticity).periodic;
  PetscReal       slide[2];
  Vec             seen;

  PetscFunctionBegin;
  (void)generation; /* from its begin on a try has its own D */
  if (!s->surface) PetscFunctionReturn(PETSC_SUCCESS);
  *adds = PETSC_TRUE;
  if (!h) PetscFunctionReturn(PETSC_SUCCESS);
  (void)SamSlideGet(state, SAM_TRIED, slide);
  PetscCall(SamGridCreateVec(law->grid, 1, &seen));
  PetscCall(SamGridMove(law->grid, 1, slide, periodic ? SAM_BORDER_WRAPS : SAM_BORDER_CONTINUES, s->surface, seen));
  PetscCall(VecAXPY(h, 1, seen));
  PetscCall(VecDestroy(&seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The limit of the stretch along a unit vector, under the pressure and the bound of the step. */
static PetscErrorCode FindLimit(SamLawStep *step, const double along[2], double *limit)
{
  const PetscInt cells = step->grid->cells;
  const double  *p, *bound, *u;
  double        *q;
  Vec            shear, bent;

  PetscFunctionBegin;
  *limit = 0;
  PetscCall(SamGridCreateVec(step->grid, 2, &shear));
  PetscCall(SamGridCreateVec(step->grid, 2, &bent));
  PetscCall(VecGetArrayRead(step->bound, &bound));
  PetscCall(VecGetArrayWrite(shear, &q));
  for (PetscInt k = 0; k < cells; k++) {
    q[k]         = bound[k] * along[0];
    q[k + cells] = bound[k] * along[1];
  }
  PetscCall(VecRestoreArrayWrite(shear, &q));
  PetscCall(VecRestoreArrayRead(step->bound, &bound));
  PetscCall(SamElasticityApplyTangential(step->elasticity, shear, bent));
  PetscCall(VecGetArrayRead(step->pressure, &p));
  PetscCall(VecGetArrayRead(bent, &u));
  for (PetscInt k = 0; k < cells; k++)
    if (p[k] > 0) *limit = PetscMax(*limit, u[k] * along[0] + u[k + cells] * along[1]);
  PetscCall(VecRestoreArrayRead(bent, &u));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(VecDestroy(&bent));
  PetscCall(VecDestroy(&shear));
  PetscCall(SamMax(step->grid->comm, 1, limit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slider at the end of the step, by what the step has found. */
static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const PetscInt id     = SamStateFindNumber(step->state, SLIDE_XY);
  const double  *before = SamStateNumbers(step->state, id, SAM_COMMITTED);
  double *const  now    = SamStateNumbers(step->state, id, SAM_TRIED);
  const double   by[2]  = {(double)step->rigid[SAM_COMPONENT_TX], (double)step->rigid[SAM_COMPONENT_TY]};
  const double   x = by[0] - before[SLIDER_X], y = by[1] - before[SLIDER_Y], stretch = hypot(x, y);

  PetscFunctionBegin;
  (void)law;
  PetscCall(FindLimit(step, stretch > 0 ? (double[]){x / stretch, y / stretch} : (double[]){1, 0}, &now[LIMIT]));
  for (int k = SLIDER_X; k <= SLIDER_Y; k++) now[k] = before[k];
  Pull(by, now[LIMIT], &now[SLIDER_X]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&((Slide *)law->data)->surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Slide(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(PetscNew((Slide **)&law->data));
  law->option             = "slide";
  law->heading            = "Surfaces that slide past each other";
  law->rows               = &slide_row;
  law->row_count          = 1;
  law->bytes              = 56;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.addparameters  = AddParameters;
  law->ops.declare        = Declare;
  law->ops.check          = Check;
  law->ops.begin          = Begin;
  law->ops.separation     = Separation;
  law->ops.advance        = Advance;
  law->ops.destroy        = Destroy;
  PetscFunctionReturn(PETSC_SUCCESS);
}
