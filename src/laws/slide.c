/*
  Surfaces that slide past each other. The grid goes with body 1; under its point x lies the point x + D of body 2.
  Fields that laws store at body 2's own points, such as its wear, stay there and are read at x + D in each step:

      h(x) = h1(x) + h2(x + D),   R: (R f)(x) = f(x + D) by cubic interpolation

  Changes of body 2 by the pressure at x are written by the transpose of R. So volumes are conserved, and reading and
  writing together cannot amplify waves.

  If the bodies roll, the grid moves over both, by a total of o: under its point x lie the points x + o of body 1 and x
  + o + D of body 2; D grows by the creep. The shape stays with the grid. So surfaces and wear of both bodies are read
  and written at their offsets, and are never interpolated twice.

  A point x of body 1 is over the point x + d - u_t(x) of body 2, d being the rigid displacement: where it sticks, this
  does not change. D is the slide of the point that slips last, so that D does not change while any point sticks. It is
  a slider that d pulls by a spring: it stays while the stretch d - D is at most L, and otherwise follows at that
  length. If all of the contact slips along e, u_t is the displacement by the bound of the shear along e, and L is the
  largest component of it along e in contact; elsewhere the surfaces move more than D, by the bending of the bodies. So
  while the surfaces slide, D depends on d alone, and returns with it. Until a step
  is solved, L is that of the step before, and d is the given one, or else that of the step before, too. The slip of
  the step does not depend on D.
*/
#include <petsam/private/elasticity.h>
#include <petsam/private/fieldfile.h>
#include <petsam/private/grid.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/base.h>
#include <petsam/private/control.h>
#include <petsam/private/pressed.h>
#include <petsam/private/parameters.h>
#include <math.h>

/* A smaller change of D, in cells, does not count. */
#define SLIDES 1e-3
#define LOSS   1e-2 /* part of a surface's heights that interpolation removes, at 8 cells per wave */

typedef struct {
  PetscBool given;
  Vec       surface[2]; /* of body 1 and 2, each a part of the separation (m); NULL: flat */
} Slide;

PetscErrorCode SamLawSetSurface(SamLaw law, PetscInt body, Vec surface)
{
  Vec *to;

  PetscFunctionBegin;
  SamValidHandle(law, SamLaw, 1);
  SamValidVec(surface, 3);
  SamValidVecOn(law->grid->comm, 1, surface, 3);
  PetscCheck(body == 0 || body == 1, law->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Body %" PetscInt_FMT ": expected 0 or 1", body);
  PetscCheck(!strcmp(law->type, SAM_LAW_SLIDE), law->grid->comm, PETSC_ERR_ARG_WRONG, "The law %s has no surface",
             law->type);
  PetscCall(SamGridCheckVec(law->grid, 1, surface, "The surface"));
  to = &((Slide *)law->data)->surface[body];
  if (!*to) {
    PetscCall(SamGridCreateVec(law->grid, 1, to));
    law->bytes += 24; /* this field, and as it is seen while it is read */
  }
  PetscCall(VecCopy(surface, *to));
  law->of_body[body] = PETSC_TRUE;
  law->revision++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- options ---- */

static const SamOptionRow slide_row = {"slide", "the surfaces move past each other by the displacements of the history",
                                       SAM_OPTION_BOOL, .member = offsetof(Slide, given)};

/* Rejects options that do not work with sliding surfaces, and gives the reason. */
static PetscErrorCode Refuse(const SamOptions *from)
{
  static const char *const refused[][2] = {
    {"body2_compliance", "body 2 moves away from the place that its compliance has: give it to body 1"},
    {"pressure_limit", "one depth of yielding cannot stay with two surfaces"},
    {"step_rtol", "what a part of a step wears depends on where body 2 is in it: use more steps"},
    {"stiffness", "the gap changes with the displacements, which the tangent leaves out"}};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(refused) / sizeof(refused[0]); k++)
    PetscCall(SamOptionsExclude(from, slide_row.name, refused[k][0], refused[k][1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *const files[2][3] = {
  {"body1_surface_file", "body1_surface_dataset", "HDF5 file with heights added to the gap, which go with body 1"},
  {"body2_surface_file", "body2_surface_dataset", "HDF5 file with heights added to the gap, which go with body 2"}};

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  PetscFunctionBegin;
  *asked = ((const Slide *)law->data)->given;
  if (*asked) PetscCall(Refuse(from));
  for (PetscInt body = 0; body < 2; body++) {
    SamFieldFile source = {.file_option = files[body][0], .dataset_option = files[body][1], SAM_FIELD_FILE_OF_LENGTHS};
    Vec          surface;

    PetscCall(SamFieldFileSetFromOptions(&source, from, files[body][2]));
    PetscCheck(*asked || !source.file[0] || SamPrintHelp(), from->comm, SAM_ERR_USER,
               "-%s%s is given without -%sslide: a surface that does not move is -%sgap_rough_file",
               SamOptionsPrefix(from), source.file_option, SamOptionsPrefix(from), SamOptionsPrefix(from));
    PetscCall(SamFieldFileCreate(&source, law->grid, &surface));
    if (surface) PetscCall(SamLawSetSurface(law, body, surface));
    PetscCall(VecDestroy(&surface));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  const Slide *s = (const Slide *)law->data;

  PetscFunctionBegin;
  PetscCall(SamParametersAddText(p, "slide", PETSC_TRUE, "true"));
  for (int body = 0; body < 2; body++) {
    uint64_t checksum;

    if (!s->surface[body]) continue;
    PetscCall(SamGridChecksum(law->grid, s->surface[body], &checksum));
    PetscCall(SamParametersAddChecksum(p, files[body][0], checksum));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a step ---- */

#define WAY(name, axis, what) \
  { \
    name "_" axis, "m", what, SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_TRUE, SAM_JOIN_LAST, 0 \
  }
#define SLIDE(axis)  WAY("slide", axis, "displacement of body 1 over body 2 along " axis)
#define ROLLED(axis) WAY("rolled", axis, "distance that the contact has rolled over body 1 along " axis)

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateNumber numbers[] = {SLIDE("x"),
                                           SLIDE("y"),
                                           ROLLED("x"),
                                           ROLLED("y"),
                                           {.name = "slider", .unit = "m", .text = "", .count = 3, .kept = PETSC_TRUE}};
  PetscInt                    id;

  PetscFunctionBegin;
  (void)law;
  for (size_t k = 0; k < sizeof(numbers) / sizeof(numbers[0]); k++)
    PetscCall(SamStateDeclareOptional(state, &numbers[k], 0, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the given displacement, or that of the step before (0 before the first one). A creepage is added to it. */
static double Rigid(SamState state, const SamControl *control, SamComponent component, PetscReal rolled)
{
  const double found =
    *SamStateNumbers(state, SamStateFindNumber(state, SamComponentNames[component].rigid), SAM_COMMITTED);

  if (SamControlWay(control, component) == SAM_BY_RIGID) return (double)control->value[component];
  return (isfinite(found) ? found : 0) + (control->creep[component] ? (double)(rolled * control->value[component]) : 0);
}

/* Moves the slider by a pull through a spring, whose stretch is limited. */
static void Pull(const double by[2], double limit, double slider[2])
{
  const double stretch = hypot(by[0] - slider[0], by[1] - slider[1]);

  for (int k = 0; k < 2 && stretch > limit; k++) slider[k] = by[k] - (by[k] - slider[k]) * limit / stretch;
}

/* Computes the largest rotation of surfaces that slide without turning over each other: a cell at the grid's border. */
static PetscReal MostTurn(SamGrid grid)
{
  return 2 * PetscMin(grid->dx, grid->dy) / PetscMax(grid->width[0], grid->width[1]);
}

static PetscErrorCode Check(SamLaw law, SamControl *control, PetscInt *wrong, char why[], size_t size)
{
  const SamGrid grid = law->grid;

  PetscFunctionBegin;
  if (SamControlWay(control, SAM_COMPONENT_MZ) != SAM_BY_RIGID ||
      fabs(control->value[SAM_COMPONENT_MZ]) <= MostTurn(grid))
    PetscFunctionReturn(PETSC_SUCCESS);
  *wrong = SAM_COMPONENT_MZ;
  (void)snprintf(why, size,
                 "expected at most %.6g with -slide, a cell at the border of the grid: surfaces slide without turning "
                 "over each other: give 0",
                 (double)MostTurn(grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(SamLaw law, SamState state, const SamControl *control, PetscReal duration)
{
  static const SamComponent along[2] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY};

  const SamGrid   grid    = law->grid;
  const PetscInt  id      = SamStateFindNumber(state, SAM_FRAME);
  const double   *before  = SamStateNumbers(state, id, SAM_COMMITTED);
  double *const   now     = SamStateNumbers(state, id, SAM_TRIED);
  const PetscReal cell[2] = {grid->dx, grid->dy};
  PetscReal       roll[2];
  const PetscReal rolled = SamMotionRolled(law->conditions, control, roll);
  const double    turn = fabs(Rigid(state, control, SAM_COMPONENT_MZ, rolled)), most = (double)MostTurn(grid);
  const double    by[2] = {Rigid(state, control, along[0], rolled), Rigid(state, control, along[1], rolled)};
  double          to[2] = {before[SAM_FRAME_SLIDER_X], before[SAM_FRAME_SLIDER_Y]};
  PetscBool       moves = PETSC_FALSE;

  PetscFunctionBegin;
  (void)duration;
  PetscCheck(
    turn <= most, grid->comm, SAM_ERR_USER,
    "%s of %.6g with -slide, found for %s in the step before: expected at most %.6g, a cell at the border of the grid: "
    "surfaces slide without turning over each other: give rot_z = 0 instead",
    SamComponentNames[SAM_COMPONENT_MZ].rigid, turn,
    SamComponentNameOf(SAM_COMPONENT_MZ, SamControlWay(control, SAM_COMPONENT_MZ)), most);
  Pull(by, before[SAM_FRAME_LIMIT], to);
  for (int k = 0; k < 2; k++) moves = moves || fabs(to[k] - before[k]) >= SLIDES * (double)cell[k];
  for (int k = 0; k < 2; k++) now[k] = moves ? to[k] : before[k];
  for (int k = 0; k < 2; k++) now[SAM_FRAME_ROLLED_X + k] = before[SAM_FRAME_ROLLED_X + k] + (double)roll[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Separation(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds)
{
  const Slide *s = (const Slide *)law->data;
  PetscReal    offset[2];
  Vec          seen;

  PetscFunctionBegin;
  (void)generation; /* a try has its own offsets from its beginning */
  for (PetscInt body = 0; body < 2; body++) {
    if (!s->surface[body]) continue;
    *adds = PETSC_TRUE;
    if (!h) continue;
    (void)SamFramesGetOffset(state, SAM_TRIED, body, offset);
    PetscCall(SamGridCreateVec(law->grid, 1, &seen));
    PetscCall(SamFramesReadBeyond(law->elasticity, offset, SAM_BORDER_CONTINUES, s->surface[body], seen));
    PetscCall(VecAXPY(h, 1, seen));
    PetscCall(VecDestroy(&seen));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the limit of the stretch along a unit vector, under the pressure and the bound of the step. */
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
    if (SamIsPressed(p[k])) *limit = PetscMax(*limit, u[k] * along[0] + u[k + cells] * along[1]);
  PetscCall(VecRestoreArrayRead(bent, &u));
  PetscCall(VecRestoreArrayRead(step->pressure, &p));
  PetscCall(VecDestroy(&bent));
  PetscCall(VecDestroy(&shear));
  PetscCall(SamMax(step->grid->comm, 1, limit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves the slider at the end of the step, by the results of the step. */
static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const PetscInt id     = SamStateFindNumber(step->state, SAM_FRAME);
  const double  *before = SamStateNumbers(step->state, id, SAM_COMMITTED);
  double *const  now    = SamStateNumbers(step->state, id, SAM_TRIED);
  const double   by[2]  = {(double)step->rigid[SAM_COMPONENT_TX], (double)step->rigid[SAM_COMPONENT_TY]};
  const double   x = by[0] - before[SAM_FRAME_SLIDER_X], y = by[1] - before[SAM_FRAME_SLIDER_Y], stretch = hypot(x, y);

  PetscFunctionBegin;
  (void)law;
  PetscCall(
    FindLimit(step, stretch > 0 ? (double[]){x / stretch, y / stretch} : (double[]){1, 0}, &now[SAM_FRAME_LIMIT]));
  for (int k = SAM_FRAME_SLIDER_X; k <= SAM_FRAME_SLIDER_Y; k++) now[k] = before[k];
  Pull(by, now[SAM_FRAME_LIMIT], &now[SAM_FRAME_SLIDER_X]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the part of a surface's height that interpolation removes half way between its points, when the surface moves
  by parts of a cell: 1 - (9 cos(t/2) - cos(3t/2))/8, t = 2 pi/n, for waves of n cells.
*/
static PetscErrorCode GetLoss(SamLaw law, const PetscReal offset[2], Vec surface, PetscReal *loss)
{
  const PetscReal cell[2] = {law->grid->dx, law->grid->dy};
  PetscReal       half[2] = {0, 0};
  PetscScalar     sum, before, after;
  PetscInt        cells;
  Vec             heights, seen;

  PetscFunctionBegin;
  for (int k = 0; k < 2; k++)
    if (fabs(remainder(offset[k], cell[k])) > SLIDES * cell[k]) half[k] = cell[k] / 2;
  PetscCall(VecDuplicate(surface, &heights));
  PetscCall(VecDuplicate(surface, &seen));
  PetscCall(VecCopy(surface, heights));
  PetscCall(VecSum(heights, &sum));
  PetscCall(VecGetSize(heights, &cells));
  PetscCall(VecShift(heights, -sum / cells));
  PetscCall(SamFramesReadBeyond(law->elasticity, half, SAM_BORDER_CONTINUES, heights, seen));
  PetscCall(VecDot(seen, seen, &after));
  PetscCall(VecPointwiseMult(heights, heights, heights)); /* squares of the heights, at the same places */
  PetscCall(SamFramesReadBeyond(law->elasticity, half, SAM_BORDER_CONTINUES, heights, seen));
  PetscCall(VecSum(seen, &before));
  *loss = before > 0 ? 1 - sqrt(after / before) : 0;
  PetscCall(VecDestroy(&seen));
  PetscCall(VecDestroy(&heights));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advise(SamLaw law, SamState state, char text[], size_t size)
{
  PetscFunctionBegin;
  text[0] = '\0';
  for (PetscInt body = 0; body < 2 && !text[0]; body++) {
    const Vec surface = ((const Slide *)law->data)->surface[body];
    PetscReal offset[2], loss = 0;

    (void)SamFramesGetOffset(state, SAM_TRIED, body, offset);
    if (surface) PetscCall(GetLoss(law, offset, surface, &loss));
    if (!(loss > LOSS)) continue;
    (void)snprintf(
      text, size,
      "the heights of body %d have waves of so few cells that interpolation lowers them by up to %.2g %% "
      "where they lie between cells (0.85 %% at 8 cells a wave): use a finer grid, or move the surfaces by "
      "whole cells in each step",
      (int)body + 1, 100 * (double)loss);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamLaw law)
{
  PetscFunctionBegin;
  for (int body = 0; body < 2; body++) PetscCall(VecDestroy(&((Slide *)law->data)->surface[body]));
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
  law->ops.setfromoptions = SetFromOptions;
  law->ops.addparameters  = AddParameters;
  law->ops.check          = Check;
  law->ops.declare        = Declare;
  law->ops.begin          = Begin;
  law->ops.separation     = Separation;
  law->ops.advance        = Advance;
  law->ops.advise         = Advise;
  law->ops.back           = SamLawNoBack;
  law->slides             = PETSC_TRUE;
  law->ops.destroy        = Destroy;
  PetscFunctionReturn(PETSC_SUCCESS);
}
