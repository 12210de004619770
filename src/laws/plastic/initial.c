/*
  The stress that a body has before any load, as by shot peening or case hardening: xx and yy of each layer, the mean of
  a profile that varies linearly between the rows of a file. It depends on the depth alone, so it is in equilibrium, and
  leaves the surface where it is.
*/
#include "newton.h"
#include <petsam/private/table.h>
#include <math.h>

enum { DEPTH, XX, YY, COLUMNS };
#define SAMPLES 32  /* of a layer, for its mean */
#define DEEP    100 /* widths of the grid down to which a stress may go */

static double ValueAt(const SamTable *t, const PetscInt column[COLUMNS], PetscInt row, int c)
{
  return t->value[row * t->columns + column[c]];
}

static PetscErrorCode CheckRows(MPI_Comm comm, const SamTable *t, const PetscInt column[COLUMNS], const char file[])
{
  PetscFunctionBegin;
  PetscCheck(t->rows > 1 && ValueAt(t, column, 0, DEPTH) == 0, comm, SAM_ERR_USER,
             "%s, line %d: expected rows from depth 0 on, the surface, down to where the stress ends", file,
             t->rows ? (int)t->line[0] : (int)t->header_line);
  for (PetscInt k = 1; k < t->rows; k++)
    PetscCheck(ValueAt(t, column, k, DEPTH) > ValueAt(t, column, k - 1, DEPTH), comm, SAM_ERR_USER,
               "%s, line %d: depth %.6g does not follow that of the row before: order the rows by depth", file,
               (int)t->line[k], ValueAt(t, column, k, DEPTH));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Below the last row there is none. */
static double Interpolate(const SamTable *t, const PetscInt column[COLUMNS], double depth, int c)
{
  for (PetscInt k = 1; k < t->rows; k++) {
    const double above = ValueAt(t, column, k - 1, DEPTH), below = ValueAt(t, column, k, DEPTH);
    const double part = (depth - above) / (below - above);

    if (depth <= below) return (1 - part) * ValueAt(t, column, k - 1, c) + part * ValueAt(t, column, k, c);
  }
  return 0;
}

/* Rejects an initial stress beyond yield, which a body cannot have. */
static PetscErrorCode CheckStress(MPI_Comm comm, const char file[], const char option[], PetscReal yield,
                                  PetscReal middle, const double stress[2])
{
  const double mises = sqrt(stress[0] * stress[0] - stress[0] * stress[1] + stress[1] * stress[1]);

  PetscFunctionBegin;
  PetscCheck(mises < (double)yield, comm, SAM_ERR_USER,
             "-%s %s: the von Mises stress at depth %.6g m, %.6g Pa, is not below the yield stress %.6g Pa", option,
             file, (double)middle, mises, (double)yield);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A stress that ends far deeper than the grid is wide has depths in another unit. */
static PetscErrorCode CheckDepth(MPI_Comm comm, const char file[], const char option[], SamGrid grid, double depth)
{
  const double width = 2 * (double)grid->length;

  PetscFunctionBegin;
  PetscCheck(
    depth <= DEEP * width, comm, SAM_ERR_USER,
    "-%s %s: the last depth, %.6g m, is %.3g times the width of the grid, expected at most %d times: check the "
    "unit, m",
    option, file, depth, depth / width, DEEP);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticReadInitial(const SamOptions *from, const char option[], const char needs[], SamGrid grid,
                                     PetscReal yield, PetscInt layers, const PetscReal thickness[], double **stress)
{
  static const char *const names[COLUMNS + 1]       = {"depth", "stress_xx", "stress_yy", NULL};
  char                     file[PETSC_MAX_PATH_LEN] = "";
  const SamOptionRow       row = {option, "text file of depth, stress_xx, stress_yy (m, Pa): stress before any load",
                                  SAM_OPTION_FILE, .size = sizeof(file), .needs = needs};
  SamTable                 t;
  PetscInt                 column[COLUMNS];
  PetscBool                set;
  PetscReal                top = 0;

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, file, &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamTableRead(from->comm, option, file, names, &t));
  for (int c = 0; c < COLUMNS; c++) {
    column[c] = SamTableFind(&t, names[c]);
    PetscCheck(column[c] >= 0, from->comm, SAM_ERR_USER, "%s, line %d: no column named %s", file, (int)t.header_line,
               names[c]);
  }
  PetscCall(CheckRows(from->comm, &t, column, file));
  PetscCall(CheckDepth(from->comm, file, option, grid, ValueAt(&t, column, t.rows - 1, DEPTH)));
  PetscCall(PetscFree(*stress));
  PetscCall(PetscCalloc1(2 * layers, stress));
  for (PetscInt l = 0; l < layers; l++) {
    double *const at = *stress + 2 * l;

    for (PetscInt k = 0; k < SAMPLES; k++)
      for (int c = 0; c < 2; c++)
        at[c] += Interpolate(&t, column, (double)(top + (k + 0.5) / SAMPLES * thickness[l]), XX + c) / SAMPLES;
    PetscCall(CheckStress(from->comm, file, option, yield, top + thickness[l] / 2, at));
    top += thickness[l];
  }
  PetscCall(SamTableDestroy(&t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamPlasticAddInitial(const SamPlastic *p, double s[])
{
  const PetscInt cells = p->grid->cells;

  for (PetscInt l = 0; l < p->bodies * p->layers; l++) {
    const double *const stress = p->body[l / p->layers].initial;

    for (PetscInt k = 0; k < 2 * cells && stress; k++) /* xx and yy are the first two components */
      s[(ptrdiff_t)l * PARTS * cells + k] += stress[2 * (l % p->layers) + k / cells];
  }
}
