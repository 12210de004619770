/*
  The stress that a body has before any load, for example by shot peening, case hardening or the deposition of a
  coating. The components xx and yy are linear in depth between the rows of a file, jump where two rows have the same
  depth, and are zero below the last row. The stress depends only on the depth, so it is in equilibrium and does not
  displace the surface.
*/
#include <petsam/private/bodyimpl.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <math.h>

enum { DEPTH, XX, YY };
#define NAME "initial_stress"
#define DEEP 100 /* largest depth of a stress, in widths of the grid */

/* Relative distance from an interface below which a depth in a file is that of the interface */
static const double same_depth = 1e-9;

/* ---- at a depth ---- */

PetscBool SamBodyHasInitialStress(SamBody body)
{
  return body->rows ? PETSC_TRUE : PETSC_FALSE;
}

/* Returns a component at a fraction, 0 to 1, of the way from row k to the next. */
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

/* Sets depths that equal interfaces, except for rounding, to the depths of these. */
static void MeetInterfaces(SamBody body)
{
  for (PetscInt k = 0; k < body->rows; k++)
    for (PetscInt n = 1; n < body->count; n++) {
      const PetscReal top = SamBodyTop(body, n);

      if (PetscAbsReal(body->initial[k][DEPTH] - top) < same_depth * top) body->initial[k][DEPTH] = top;
    }
}

/* Rejects stresses that are likely to be in another unit, and stresses of a rigid body. */
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
  SamExplainStress(most, (double)body->material[0].young, SAM_LEAST_CONSTANT, SAM_MOST_STRENGTH, why, sizeof(why));
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
