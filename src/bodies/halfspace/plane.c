/* Two half-spaces in plane strain: the type, and the distance of the reference point of displacements (halfspace.c). */
#include "../elasticity/waves.h"
#include <petsam/private/body.h>
#include <petsam/private/halfspace.h>
#include <math.h>

#define DATUM "plane_datum"

/* Limits and step of the integral over ln(k width) that gives the mean of ln k over a uniform load; Euler's constant */
#define LONG  (-25.0)
#define SHORT 12.0
#define STEP  0.05
#define EULER 0.57721566490153286

/*
  Displacements by loads on the grid are positive, and the problems have solutions, if the datum is farther than a
  quarter of the grid's width (half-planes: the logarithmic capacity of an interval). With layers, displacements c(k)/k
  have another mean: -ln(x/D) is (cos kx - [k < exp(-0.5772)/D])/k over all waves, so that the mean displacement by a
  uniform load vanishes at the distance D where int (c sinc^2(k width/2) - c(0) [k < exp(-0.5772)/D]) d ln k = 0. In
  half-planes this distance is 0.223 widths, and the datum must be at least half the width; with layers it must exceed
  the distance by the same factor.
*/
static double LeastDatum(SamElasticity e)
{
  const double width = (double)e->grid->width[0], half_plane = exp(-1.5);
  double farthest = half_plane, limit[SAM_WAVE_SYMBOLS], difference[SAM_WAVE_SYMBOLS], sums[SAM_WAVE_SYMBOLS] = {0};

  if (SamPairIsUniform(e->pair)) return width / 2;
  SamPairSymbols(e->pair, exp(2 * LONG) / width, limit, difference);
  for (double x = LONG; x < SHORT; x += STEP) {
    const double k = exp(x), sinc = sin(k / 2) / (k / 2);
    double       c[SAM_WAVE_SYMBOLS];

    SamPairSymbols(e->pair, k / width, c, difference);
    for (int s = 0; s < SAM_WAVE_SYMBOLS; s++) sums[s] += STEP * (c[s] * sinc * sinc - limit[s] / (1 + k * k));
  }
  /* Bodies on rigid bases have no logarithm. */
  for (int s = 0; s < SAM_WAVE_SYMBOLS; s++)
    if (s != SAM_WAVE_ZR && limit[s] > exp(LONG) * fabs(sums[s]))
      farthest = PetscMax(farthest, exp(-EULER - sums[s] / limit[s]));
  return width * farthest / (2 * half_plane);
}

/* True if displacements have no limit far away: but for bodies on rigid bases. */
static PetscBool HasDatum(SamElasticity e)
{
  double limit[SAM_WAVE_SYMBOLS], waves[SAM_WAVE_SYMBOLS], difference[SAM_WAVE_SYMBOLS];

  SamPairSymbols(e->pair, exp(2 * LONG) / (double)e->grid->width[0], limit, difference);
  SamPairSymbols(e->pair, 1 / (double)e->grid->width[0], waves, difference);
  return limit[SAM_WAVE_ZZ] > exp(LONG) * waves[SAM_WAVE_ZZ] ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode CheckDatum(SamElasticity e, PetscErrorCode error, const char source[], const char before[])
{
  const double datum = (double)*SamHalfSpaceDatum(e), least = LeastDatum(e);

  PetscFunctionBegin;
  PetscCheck(datum >= least && isfinite(datum), e->grid->comm, error, "%s%s" DATUM " %.6g: give at least %s%.6g m%s",
             source, before, datum, SamPairIsUniform(e->pair) ? "half the grid's width, " : "", least,
             SamPairIsUniform(e->pair) ? "" : ", nearer than which loads pull these layers towards them");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions_Plane(SamElasticity e, const SamOptions *from)
{
  char      before[SAM_PREFIX + 2];
  PetscReal datum = 0;

  PetscFunctionBegin;
  PetscCall(SamOptionsReal(from, DATUM, "plane: datum's distance (), 0: grid width, more with layers", "m",
                           SAM_RANGE_NONNEGATIVE, &datum, NULL));
  if (datum > 0) {
    *SamHalfSpaceDatum(e) = datum;
    e->traits.datum       = 0;
  }
  PetscCall(PetscSNPrintf(before, sizeof(before), "-%s", e->prefix));
  PetscCall(CheckDatum(e, SAM_ERR_USER, "", before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters_Plane(SamElasticity e, SamParameters *p)
{
  return SamParametersAddReals(p, DATUM, PETSC_TRUE, 1, SamHalfSpaceDatum(e));
}

static PetscErrorCode SetParameters_Plane(SamElasticity e, const SamParameters *p, const char source[])
{
  const SamParameter *found = SamParametersFind(p, DATUM);

  PetscFunctionBegin;
  if (found && found->count == 1) *SamHalfSpaceDatum(e) = found->value[0];
  PetscCall(CheckDatum(e, SAM_ERR_FILE, source, ": cannot be read: "));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreate_Plane(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(SamElasticityCreate_HalfSpace(e));
  *SamHalfSpaceDatum(e)  = 2 * LeastDatum(e);
  e->traits.plane        = PETSC_TRUE;
  e->traits.datum        = HasDatum(e) ? *SamHalfSpaceDatum(e) : 0;
  e->traits.rotations[0] = e->traits.rotations[2] = PETSC_FALSE;
  e->ops.setfromoptions                           = SetFromOptions_Plane;
  e->ops.addparameters                            = AddParameters_Plane;
  e->ops.setparameters                            = SetParameters_Plane;
  PetscFunctionReturn(PETSC_SUCCESS);
}
