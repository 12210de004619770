/*
  The depths of an evaluation: in m, in half widths of the contact, and at interfaces of materials.

  The half width of a contact is the smaller half axis of an ellipse with the area of the contact, accurate to a part of
  a cell, and the ratio of axes from the second moments of its cells. In plane strain it is half the contact's length.
  It is taken from the step with the largest area.
*/
#include "evaluationimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/pressed.h>
#include <petsam/private/elasticity.h>
#include <stdlib.h>

#define TEXT        4096 /* characters of a list */
#define MOST_DEPTHS 100000
/* The least depth, in cells; at smaller depths the kernels equal those of the surface but for rounding */
#define LEAST_DEPTH 1e-6
#define MOST_DEPTH  1e6  /* in widths of the grid */
#define ROUNDING    1e-9 /* relative difference below which a depth is that of an interface */

/* ---- reading ---- */

int SamDivide(char text[], char at, char *parts[], int most)
{
  int count = 0;

  for (char *next = text; next; count++) {
    if (count < most) parts[count] = next;
    next = strchr(next, at);
    if (next) *next++ = '\0';
  }
  return count;
}

PetscBool SamReadLength(const char text[], double *value)
{
  const char *end;
  PetscBool   unit;

  return SamReadReal("m", text, &end, value, &unit) && !*end && isfinite(*value);
}

static PetscBool ReadWhole(const char text[], PetscInt *value)
{
  char      *end;
  const long number = strtol(text, &end, 10);

  *value = (PetscInt)number;
  return end != text && *end == '\0' && number == (long)*value;
}

/* Removes the sign after a depth and returns the side of the interface: 2e-6- is above (-1), 2e-6+ below (1); 0:
   none. */
static int ReadSide(char text[])
{
  const size_t length = strlen(text);
  const char   last   = length ? text[length - 1] : '\0';

  if (last != '-' && last != '+') return 0;
  text[length - 1] = '\0';
  return last == '-' ? -1 : 1;
}

#define EXPECTED \
  "expected depths separated by commas, or first:last:number, first < last, in m, mm, um, nm or as 0.5a in half " \
  "widths"

/* Reads a depth in m, or, if followed by `a`, in half widths of the contact (m). */
static PetscBool ReadDepth(char text[], PetscReal half, double *value)
{
  const size_t    length   = strlen(text);
  const PetscBool relative = length && text[length - 1] == 'a' ? PETSC_TRUE : PETSC_FALSE;
  PetscBool       good;

  if (relative) text[length - 1] = '\0';
  good = SamReadLength(text, value);
  if (relative) *value *= (double)half;
  return good && isfinite(*value) ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool SamDepthsAreRelative(const char depths[])
{
  char   text[TEXT], *parts[TEXT / 2];
  int    count;
  double value;

  (void)snprintf(text, sizeof(text), "%s", depths);
  for (char *c = text; *c; c++)
    if (*c == ':') *c = ',';
  count = SamDivide(text, ',', parts, TEXT / 2);
  for (int k = 0; k < count && k < TEXT / 2; k++) {
    size_t length = strlen(parts[k]);

    if (length > 1 && ReadSide(parts[k])) length--;
    if (length && parts[k][length - 1] == 'a' && ReadDepth(parts[k], 1, &value)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Reads first:last:number. */
static PetscErrorCode ReadRange(MPI_Comm comm, const char whole[], char text[], PetscReal half, PetscInt *n,
                                PetscReal **depths, int **sides)
{
  char  *parts[3];
  double ends[2] = {0, 0};

  PetscFunctionBegin;
  PetscCheck(SamDivide(text, ':', parts, 3) == 3 && ReadDepth(parts[0], half, &ends[0]) &&
               ReadDepth(parts[1], half, &ends[1]) && ReadWhole(parts[2], n) && *n >= 2 && ends[1] > ends[0],
             comm, SAM_ERR_USER, "%s: " EXPECTED, whole);
  PetscCheck(*n <= MOST_DEPTHS, comm, SAM_ERR_USER, "%s: expected at most %d depths", whole, MOST_DEPTHS);
  PetscCall(PetscCalloc2(*n, depths, *n, sides));
  for (PetscInt k = 0; k < *n; k++)
    (*depths)[k] = (PetscReal)(k + 1 == *n ? ends[1] : ends[0] + (ends[1] - ends[0]) * k / (*n - 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadList(MPI_Comm comm, const char whole[], char text[], PetscReal half, PetscInt *n,
                               PetscReal **depths, int **sides)
{
  char *parts[TEXT / 2];

  PetscFunctionBegin;
  *n = SamDivide(text, ',', parts, TEXT / 2);
  PetscCall(PetscCalloc2(*n, depths, *n, sides));
  for (PetscInt k = 0; k < *n; k++) {
    double value = 0;

    (*sides)[k] = ReadSide(parts[k]);
    PetscCheck(ReadDepth(parts[k], half, &value), comm, SAM_ERR_USER, "%s: " EXPECTED, whole);
    (*depths)[k] = (PetscReal)value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDepthsTake(SamEvaluation e, const char said[], PetscInt n, const PetscReal depths[],
                             const int sides[])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k++) {
    PetscCheck(depths[k] >= 0 && depths[k] < PETSC_INFINITY, e->comm, SAM_ERR_USER,
               "%s: %.6g is above the surface: expected numbers >= 0", said, (double)depths[k]);
    PetscCheck(!k || depths[k] > depths[k - 1] || (depths[k] == depths[k - 1] && sides && sides[k] > sides[k - 1]),
               e->comm, SAM_ERR_USER, "%s: %.6g follows %.6g: expected depths that increase", said, (double)depths[k],
               (double)depths[k - 1]);
  }
  PetscCall(PetscFree2(e->depth, e->side));
  PetscCall(PetscCalloc2(n, &e->depth, n, &e->side));
  PetscCall(PetscArraycpy(e->depth, depths, n));
  if (sides) PetscCall(PetscArraycpy(e->side, sides, n));
  e->depths = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDepthsRead(SamEvaluation e, PetscReal half)
{
  char       text[TEXT], whole[TEXT + 16];
  PetscInt   n;
  PetscReal *depths;
  int       *sides;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(text, e->depths_text, sizeof(text)));
  PetscCall(PetscSNPrintf(whole, sizeof(whole), "-depths %.60s%s", text, strlen(text) > 60 ? "..." : ""));
  PetscCall((strchr(text, ':') ? ReadRange : ReadList)(e->comm, whole, text, half, &n, &depths, &sides));
  PetscCall(SamDepthsTake(e, whole, n, depths, sides));
  PetscCall(PetscFree2(depths, sides));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the half width ---- */

/* Computes the second moments' ratio of axes, at most 1, of the cells in contact. */
static PetscErrorCode RatioOfAxes(SamEvaluation e, PetscInt step, double *ratio)
{
  const SamGrid g = e->grid;
  double       *pressure, sum[6] = {0}, middle[2], xx, xy, yy, deviation;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->cells + 1, &pressure));
  PetscCall((*e->source.read)(e->source.context, step, "pressure", pressure));
  for (PetscInt k = 0; k < g->cells; k++) { /* integers, so that sums are the same on any number of ranks */
    const double i = (double)(k % g->nx - g->nx / 2), j = (double)(g->row_start + k / g->nx - g->ny / 2);
    const double part[6] = {1, i, j, i * i, i * j, j * j};

    for (int m = 0; m < 6 && SamIsPressed(pressure[k]); m++) sum[m] += part[m];
  }
  PetscCall(PetscFree(pressure));
  PetscCall(SamSum(g->comm, 6, sum));
  for (int m = 0; m < 2; m++) middle[m] = sum[1 + m] / sum[0];
  xx        = (sum[3] / sum[0] - middle[0] * middle[0] + 1. / 12) * (double)(g->dx * g->dx);
  xy        = (sum[4] / sum[0] - middle[0] * middle[1]) * (double)(g->dx * g->dy);
  yy        = (sum[5] / sum[0] - middle[1] * middle[1] + 1. / 12) * (double)(g->dy * g->dy);
  deviation = hypot(0.5 * (xx - yy), xy);
  *ratio    = sqrt((0.5 * (xx + yy) - deviation) / (0.5 * (xx + yy) + deviation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FindHalfWidth(SamEvaluation e)
{
  PetscInt most = 0;
  double   area = 0, ratio = 1, now, number;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < e->source.steps; k++) {
    PetscCall((*e->source.number)(e->source.context, k, SAM_STEP_AREA, &now));
    if (now > area) most = k, area = now;
  }
  PetscCheck(area > 0, e->comm, SAM_ERR_USER,
             "-depths: a is the half width of the contact, and no chosen step of %s has a contact area: give depths in "
             "m, or other -steps",
             e->source.name);
  PetscCall((*e->source.number)(e->source.context, most, SAM_STEP_NUMBER, &number));
  e->layout.half      = 0.5 * area;
  e->layout.half_step = (PetscInt)number;
  if (!SamGridIsRow(e->grid)) {
    PetscCall(RatioOfAxes(e, most, &ratio));
    e->layout.half = sqrt(area / PETSC_PI * ratio);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- interfaces ---- */

SamBody SamEvaluationBody(SamEvaluation e)
{
  return SamPairBody(SamElasticityGetPair(e->source.bodies), e->body - 1);
}

/* Returns the material whose bottom is at a depth, but for rounding; the last material if there is none. */
static SamBodyPlace InterfaceAt(SamBody body, PetscReal depth)
{
  SamBodyPlace place = SamBodyAt(body, 0);

  while (!place.last && PetscAbsReal(depth - place.bottom) > ROUNDING * depth) place = SamBodyBelow(body, place);
  return place;
}

/* Splits depths at interfaces without a side: the depth itself becomes the side above, the next one the side below. */
static PetscErrorCode SplitInterfaces(SamEvaluation e)
{
  const SamBody      body = SamEvaluationBody(e);
  const SamBodyPlace last = SamBodyAt(body, INFINITY);
  const PetscReal    base = isinf(last.young) ? last.top : INFINITY; /* it is rigid */
  PetscReal         *depth;
  int               *side;
  PetscInt           n = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(2 * e->depths, &depth, 2 * e->depths, &side));
  for (PetscInt k = 0; k < e->depths; k++) {
    const SamBodyPlace above  = InterfaceAt(body, e->depth[k]);
    const PetscBool    is     = (PetscBool)!above.last;
    const PetscReal    bottom = is ? above.bottom : e->depth[k];
    const PetscBool    rigid  = (PetscBool)(is && bottom == base);

    PetscCheck(!e->side[k] || is, e->comm, SAM_ERR_USER,
               "-depths: %.6g%c names a side of an interface, and there is none: omit the sign", (double)e->depth[k],
               e->side[k] < 0 ? '-' : '+');
    PetscCheck(rigid ? e->side[k] <= 0 : is || e->depth[k] < base, e->comm, SAM_ERR_USER,
               "-depths: %.6g m is in the rigid base, which begins at %.6g m", (double)e->depth[k], (double)base);
    for (int s = -1; s <= 1; s += 2) {
      if (is ? e->side[k] == -s || (rigid && s > 0) : s > 0) continue;
      depth[n]  = is && s > 0 ? nextafter(bottom, PETSC_INFINITY) : bottom;
      side[n++] = is ? s : 0;
    }
  }
  PetscCall(PetscFree2(e->depth, e->side));
  e->depth  = depth;
  e->side   = side;
  e->depths = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamDepthsSetUp(SamEvaluation e)
{
  const PetscReal side = e->grid->side[0];

  PetscFunctionBegin;
  if (!e->average && SamDepthsAreRelative(e->depths_text)) PetscCall(FindHalfWidth(e));
  if (!e->average) PetscCall(SamDepthsRead(e, (PetscReal)e->layout.half));
  PetscCall(SplitInterfaces(e));
  PetscCheck(e->depth[e->depths - 1] <= MOST_DEPTH * 2 * e->grid->length, e->comm, SAM_ERR_USER,
             "-depths: %.6g m is more than %.6g times the width of the grid: check the unit, m",
             (double)e->depth[e->depths - 1], MOST_DEPTH);
  for (PetscInt k = 0; k < e->depths; k++)
    PetscCheck(e->depth[k] == 0 || e->depth[k] >= LEAST_DEPTH * side, e->comm, SAM_ERR_USER,
               "-depths: %.6g m is less than a millionth of a cell (%.6g m): the surface is 0", (double)e->depth[k],
               (double)side);
  PetscFunctionReturn(PETSC_SUCCESS);
}
