/*
  What all advice says alike: a message, the grid that would be better, numbers as options take them.
*/
#include "adviceimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/gap.h>
#include <petsam/private/grid.h>
#include <math.h>
#include <stdarg.h>

#define ROOM  1.5  /* ratio of the width of a good grid to that of the contact */
#define LEAST 1.25 /* least ratio of the cells, or steps, that are advised to those of this run */

double SamAdviceRoundUp(double x)
{
  const double unit = pow(10, floor(log10(x)) - 1);

  return ceil(x / unit * (1 - 1e-9)) * unit;
}

void SamAdviceWritePair(const char option[], const double x[2], char text[SAM_ADVICE_TEXT])
{
  if (x[0] == x[1])
    (void)snprintf(text, SAM_ADVICE_TEXT, "-%s %.8g", option, x[0]);
  else
    (void)snprintf(text, SAM_ADVICE_TEXT, "-%s %.8g,%.8g", option, x[0], x[1]);
}

void SamAdviceWriteGrid(const SamSetup *s, const double width[2], char text[], size_t size)
{
  const PetscReal cell[2] = {s->grid->dx, s->grid->dy};
  const double    n[2]    = {(double)s->grid->nx, (double)s->grid->ny};
  double          cells[2], sides[2];
  char            one[SAM_ADVICE_TEXT], other[SAM_ADVICE_TEXT];

  for (int k = 0; k < 2; k++) {
    const int axis = k < s->grid->axes ? k : 0;

    sides[k] = width[axis];
    cells[k] =
      width[axis] > (double)s->grid->width[axis] ? 2 * ceil(0.5 * width[axis] / (double)cell[axis] - 1e-9) : n[axis];
  }
  SamAdviceWritePair("grid_size", sides, one);
  SamAdviceWritePair("grid_n", cells, other);
  if (PetscMax(cells[0], cells[1]) <= SAM_LARGEST_ROW)
    (void)snprintf(text, size, "%s, with %s for cells as now", one, other);
  else
    (void)snprintf(text, size, "%s", one);
}

void SamAdviceGridsFor(const SamSetup *s, const PetscReal half[2], double factor, const PetscBool refine[2],
                       char cells[SAM_ADVICE_TEXT], char width[SAM_ADVICE_TEXT])
{
  const double n[2] = {(double)s->grid->nx, (double)s->grid->ny};
  double       more[2], size[2];
  PetscBool    smaller = PETSC_FALSE, enough = PETSC_TRUE;

  cells[0] = width[0] = '\0';
  for (int k = 0; k < 2; k++) {
    more[k] = refine[k] ? SamGridRoundUp(ceil(n[k] * factor)) : n[k];
    size[k] = PetscMin((double)s->grid->width[k], SamAdviceRoundUp(2 * ROOM * (double)half[k]));
    if (size[k] < 0.9 * (double)s->grid->width[k]) smaller = PETSC_TRUE;
  }
  for (PetscInt k = s->grid->axes; k < 2; k++) {
    more[k] = more[0];
    size[k] = size[0];
  }
  if (s->grid->nx == s->grid->ny && s->grid->width[0] == s->grid->width[1])
    size[0] = size[1] = PetscMax(size[0], size[1]);
  /* The contact gets wider in cells as the grid gets smaller, more so along one axis. */
  for (int k = 0; k < s->grid->axes; k++)
    if ((double)s->grid->width[k] / size[k] < factor) enough = PETSC_FALSE;
  if (PetscMax(more[0], more[1]) <= SAM_LARGEST_ROW) SamAdviceWritePair("grid_n", more, cells);
  if (smaller && enough) SamAdviceWritePair("grid_size", size, width);
}

void SamAdviceSay(SamAdvice *a, const char setting[], const char format[], ...)
{
  char    text[1024];
  va_list values;

  va_start(values, format);
  (void)vsnprintf(text, sizeof(text), format, values);
  va_end(values);
  if (!a->error) a->error = a->receive(a->context, text, setting);
}

PetscBool SamAdviceIsStrip(const SamAdvice *a, PetscBool ends[2])
{
  const SamGrid g = a->setup->grid;

  ends[0] = 2 * a->extent.half[0] < g->width[0] - 0.5 * g->dx ? PETSC_TRUE : PETSC_FALSE;
  ends[1] = g->axes == 2 && 2 * a->extent.half[1] < g->width[1] - 0.5 * g->dy ? PETSC_TRUE : PETSC_FALSE;
  return a->extent.zones == 1 && ends[0] != ends[1] ? PETSC_TRUE : PETSC_FALSE;
}

/* Writes the end of a message, such as ": use -grid_n 64", that proposes a grid with this many times more cells across
   the contact. */
static void WriteGrids(const SamAdvice *a, double factor, char text[SAM_ADVICE_GRIDS])
{
  const SamSetup *s = a->setup;
  PetscBool       ends[2];
  const PetscBool strip = SamAdviceIsStrip(a, ends), refine[2] = {!strip || ends[0], !strip || ends[1]};
  const PetscReal whole[2] = {s->grid->width[0] / 2, s->grid->width[1] / 2};
  char            cells[SAM_ADVICE_TEXT], width[SAM_ADVICE_TEXT];

  SamAdviceGridsFor(s, a->half[0] > 0 ? a->half : whole, factor, refine, cells, width);
  if (!cells[0] && !width[0])
    (void)snprintf(text, SAM_ADVICE_GRIDS, ": no grid of up to %d cells in a row resolves them", SAM_LARGEST_ROW);
  else if (SamGapHasFile(s->gap))
    (void)snprintf(
      text, SAM_ADVICE_GRIDS,
      ": use a file with heights at smaller distances%s%s, unless petsam-surface reports outliers or offsets of rows",
      cells[0] ? ", and " : "", cells);
  else
    (void)snprintf(text, SAM_ADVICE_GRIDS, ": use %s%s%s%s", width, width[0] ? " (in m)" : "",
                   width[0] && cells[0] ? " or " : "", cells);
}

static void WriteSteps(const SamAdvice *a, double factor, char text[SAM_ADVICE_GRIDS])
{
  if (a->step_rtol > 0)
    (void)snprintf(text, SAM_ADVICE_GRIDS, ": use -step_rtol %.2g", (double)a->step_rtol / factor);
  else if (a->increments)
    (void)snprintf(text, SAM_ADVICE_GRIDS, ": use -steps %.0f", ceil(factor * (double)a->increments));
  else
    (void)snprintf(text, SAM_ADVICE_GRIDS, ": use %.2g times as many steps", SamAdviceRoundUp(factor));
}

PetscErrorCode SamAdviceTell(SamAdvice *a)
{
  char   numbers[640], cure[SAM_ADVICE_GRIDS];
  double factor;

  PetscFunctionBegin;
  for (SamCause cause = 0; cause < SAM_CAUSES; cause++) {
    if (!a->knows[cause]) SamDoubtsJoin(&a->doubts, &a->guesses, cause);
    SamDoubtsWrite(&a->doubts, cause, &factor, numbers, sizeof(numbers));
    if (!numbers[0]) continue;
    cure[0] = '\0';
    factor  = factor > 0 ? PetscMax(factor, LEAST) : 0;
    if (factor > 0 && cause == SAM_CAUSE_CELLS) WriteGrids(a, factor, cure);
    if (factor > 0 && cause == SAM_CAUSE_STEPS) WriteSteps(a, factor, cure);
    if (factor > 0 && cause == SAM_CAUSE_LAYERS)
      (void)snprintf(cure, sizeof(cure), ": use %.2g times as many -yield_layers", SamAdviceRoundUp(factor));
    if (cause == SAM_CAUSE_MESH) (void)snprintf(cure, sizeof(cure), ": give petsam-compliance a finer mesh");
    SamAdviceSay(a, "", "error by the %s: %s%s", SamCauseNames[cause], numbers, cure);
  }
  PetscCall(a->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}
