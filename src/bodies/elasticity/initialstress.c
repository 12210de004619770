/*
  The stress that a body has before any load, as by shot peening, case hardening or the deposition of a coating: xx and
  yy over the depth, linear between the rows of a file, with a jump where two rows have one depth, and none below the
  last row. It depends on the depth alone, so it is in equilibrium, and leaves the surface where it is.
*/
#include <petsam/private/bodyimpl.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <math.h>

enum { DEPTH, XX, YY };
#define NAME "initial_stress"
#define DEEP 100 /* widths of the grid down to which a stress may go */

/* A depth in a file that is this close to an interface, relative to it, is the interface's. */
static const double same_depth = 1e-9;

/* ---- at a depth ---- */

PetscBool SamBodyHasInitialStress(SamBody body)
{
  return body->rows ? PETSC_TRUE : PETSC_FALSE;
}

/* Returns a component at a part, 0 to 1, of the way from row k to the next. */
static double Between(SamBody body, PetscInt k, double part, int c)
{
  return (1 - part) * (double)body->initial[k][c] + part * (double)body->initial[k + 1][c];
}

void SamBodyInitialStress(SamBody body, double depth, double stress[2])
{
  PetscInt k = 0;

  stress[0] = stress[1] = 0;
  while (k + 1 < body->rows && depth > (double)body->initial[k + 1][DEPTH]) k++;
  if (k + 1 >= body->rows) return;
  for (int c = 0; c < 2; c++) {
    const double above = (double)body->initial[k][DEPTH], below = (double)body->initial[k + 1][DEPTH];

    stress[c] = Between(body, k, below > above ? (depth - above) / (below - above) : 0, XX + c);
  }
}

void SamBodyMeanInitialStress(SamBody body, double top, double thickness, double stress[2])
{
  stress[0] = stress[1] = 0;
  for (PetscInt k = 0; k + 1 < body->rows; k++) {
    const double above = (double)body->initial[k][DEPTH], below = (double)body->initial[k + 1][DEPTH];
    const double from = PetscMax(above, top), to = PetscMin(below, top + thickness);

    if (!(to > from)) continue;
    for (int c = 0; c < 2; c++)
      stress[c] += Between(body, k, ((from + to) / 2 - above) / (below - above), XX + c) * (to - from) / thickness;
  }
}

/* ---- options and parameters ---- */

/* Puts depths that are those of interfaces but for rounding exactly there. */
static void MeetInterfaces(SamBody body)
{
  for (PetscInt k = 0; k < body->rows; k++)
    for (PetscInt n = 1; n < body->count; n++) {
      const PetscReal top = SamBodyTop(body, n);

      if (PetscAbsReal(body->initial[k][DEPTH] - top) < same_depth * top) body->initial[k][DEPTH] = top;
    }
}

/* Refuses stresses that are likely to be in another unit, and those of a rigid body. */
static PetscErrorCode CheckStress(const SamOptions *from, SamBody body)
{
  const char *const prefix = SamOptionsPrefix(from);
  double            most   = 0;
  char              why[160];

  PetscFunctionBegin;
  PetscCheck(!SamBodyIsRigid(body), from->comm, SAM_ERR_USER,
             "-%s" NAME " has no effect: -%syoung inf is a rigid body: omit it", prefix, prefix);
  for (PetscInt k = 0; k < body->rows; k++)
    for (int c = XX; c <= YY; c++) most = PetscMax(most, fabs((double)body->initial[k][c]));
  SamExplainStress(most, (double)body->material[0].young, SAM_LEAST_CONSTANT, INFINITY, why, sizeof(why));
  PetscCheck(!why[0], from->comm, SAM_ERR_USER, "-%s" NAME ": the maximum stress %.6g: %s", prefix, most, why);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyReadInitialStress(const SamOptions *from, SamBody body)
{
  SamDepthTable d = {.names = {"depth", "stress_xx", "stress_yy"}, .what = "stresses"};
  PetscBool     set;

  PetscFunctionBegin;
  PetscCall(SamDepthTableRead(from, NAME, "text file of depth, stress_xx, stress_yy (m, Pa): stress before any load",
                              &d, &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  body->rows = d.table.rows;
  PetscCheck(body->rows <= SAM_STRESS_ROWS, from->comm, SAM_ERR_USER,
             "%s: gives the stress in %d rows, limit %d: leave some out", d.file, (int)body->rows, SAM_STRESS_ROWS);
  for (PetscInt k = 0; k < body->rows; k++)
    for (int c = 0; c < SAM_DEPTH_COLUMNS; c++) body->initial[k][c] = SamDepthTableGet(&d, k, c);
  PetscCall(SamTableDestroy(&d.table));
  MeetInterfaces(body);
  PetscCall(CheckStress(from, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairCheckInitialStress(SamPair pair, const SamOptions *from, PetscReal width)
{
  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) {
    const SamBody body = pair->body[b];
    const double  last = body->rows ? (double)body->initial[body->rows - 1][DEPTH] : 0;

    PetscCheck(last <= DEEP * (double)width, from->comm, SAM_ERR_USER,
               "-%sbody%d_" NAME ": the last depth, %.6g m, is %.3g times the width of the grid, expected at most %d "
               "times: check the unit, m",
               SamOptionsPrefix(from), b + 1, last, last / (double)width, DEEP);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyAddInitialStress(SamBody body, const char prefix[], SamParameters *p)
{
  char name[64];

  PetscFunctionBegin;
  if (!body->rows) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s" NAME, prefix));
  PetscCall(SamParametersAddReals(p, name, PETSC_TRUE, SAM_DEPTH_COLUMNS * body->rows, body->initial[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBodyTakeInitialStress(MPI_Comm comm, const SamParameters *p, const char prefix[], const char source[],
                                        SamBody body)
{
  const SamParameter *found;
  PetscBool           good = PETSC_TRUE;
  char                name[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s" NAME, prefix));
  found = SamParametersFind(p, name);
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  body->rows = PetscMax(found->count, 0) / SAM_DEPTH_COLUMNS;
  good       = body->rows > 1 && body->rows <= SAM_STRESS_ROWS && found->count == SAM_DEPTH_COLUMNS * body->rows;
  for (PetscInt k = 0; good && k < found->count; k++) {
    body->initial[k / SAM_DEPTH_COLUMNS][k % SAM_DEPTH_COLUMNS] = found->value[k];
    good                                                        = isfinite((double)found->value[k]);
    if (k % SAM_DEPTH_COLUMNS == DEPTH) good = good && found->value[k] >= (k ? found->value[k - SAM_DEPTH_COLUMNS] : 0);
  }
  PetscCheck(good, comm, SAM_ERR_FILE,
             "%s: cannot be read: the attribute %s is not rows of depth, stress_xx, stress_yy from the surface down",
             source, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}
