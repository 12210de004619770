/*
  Stresses on planes parallel to the surface: convolutions of the tractions with the kernels of a depth (cell.c).

  Two passes of three fields to three: one for xx, yy and xy, and one for zz, xz and yz, whose matrix is symmetric. On
  the surface the second one is not needed, as these are the tractions. The second pass puts its result in the place of
  the tractions. Of the 18 kernels 15 differ, and each is a quadrant of real numbers: 120 bytes a cell, beside 48 for
  the stresses and 48 for the spectra of a pass.
*/
#include <petsam/private/stressimpl.h>

enum { PLANE, NORMAL, PASSES };
static const SamStressComponent components[PASSES][SAM_STRESS_GROUP] = {
  [PLANE]  = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY},
  [NORMAL] = {SAM_STRESS_ZZ, SAM_STRESS_XZ, SAM_STRESS_YZ},
};

struct _n_SamStress {
  SamGrid         grid;
  SamFourier      fourier;
  SamStressSource source;
  double          sign[SAM_STRESS_TRACTIONS]; /* of the tractions that act on the body, seen from its inside */
  SamKernel       kernels[SAM_STRESS_GROUPS][SAM_STRESS_GROUP];
};

PetscErrorCode SamStressCheckBody(MPI_Comm comm, PetscInt body, PetscReal poisson)
{
  PetscFunctionBegin;
  PetscCheck(body == 1 || body == 2, comm, PETSC_ERR_ARG_OUTOFRANGE, "Body %" PetscInt_FMT ": expected 1 or 2", body);
  PetscCheck(poisson > -1 && poisson <= 0.5, comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Poisson's ratio %g: expected a number above -1, up to 0.5", (double)poisson);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressCheckDepth(MPI_Comm comm, PetscReal depth)
{
  PetscFunctionBegin;
  PetscCheck(depth >= 0 && depth < PETSC_INFINITY, comm, PETSC_ERR_ARG_OUTOFRANGE, "Depth %g m: expected a number >= 0",
             (double)depth);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressCreate(SamGrid grid, const SamFourierSettings *settings, PetscInt body, PetscReal poisson,
                               SamStress *stress)
{
  SamStress s;

  PetscFunctionBegin;
  PetscCall(SamStressCheckBody(grid->comm, body, poisson));
  PetscCall(PetscNew(&s));
  PetscCall(SamGridReference(grid));
  s->grid   = grid;
  s->source = (SamStressSource){{(double)grid->dx, (double)grid->dy}, -1, (double)poisson};
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) s->sign[t] = SamStressSign(body, t);
  PetscCall(SamFourierCreate(grid, SAM_FOURIER_FAST, settings, &s->fourier));
  *stress = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyKernels(SamStress s)
{
  PetscFunctionBegin;
  for (PetscInt g = 0; g < SAM_STRESS_GROUPS; g++)
    for (PetscInt k = 0; k < SAM_STRESS_GROUP; k++) PetscCall(SamKernelDestroy(&s->kernels[g][k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressDestroy(SamStress *stress)
{
  SamStress s = *stress;

  PetscFunctionBegin;
  *stress = NULL;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroyKernels(s));
  PetscCall(SamFourierDestroy(&s->fourier));
  PetscCall(SamGridDestroy(&s->grid));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the depth ---- */

typedef struct {
  const SamStressSource *source;
  SamStressGroup         group;
} Rows;

static void GetRows(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  const Rows *rows = (const Rows *)context;

  SamStressRow(rows->source, rows->group, j, n, values);
}

/* Whether the zz, xz and yz of this depth are the tractions. */
static PetscBool IsSurface(SamStress s)
{
  return s->source.depth == 0;
}

PetscErrorCode SamStressSetDepth(SamStress s, PetscReal depth)
{
  PetscFunctionBegin;
  PetscCall(SamStressCheckDepth(s->grid->comm, depth));
  PetscCall(DestroyKernels(s));
  s->source.depth = (double)depth;
  for (PetscInt g = 0; g < SAM_STRESS_GROUPS; g++) {
    const Rows rows = {&s->source, (SamStressGroup)g};

    if (IsSurface(s) && (g == SAM_STRESS_NORMAL_P || g == SAM_STRESS_NORMAL_T)) continue;
    PetscCall(SamKernelsCreate(s->fourier, SAM_STRESS_GROUP, SamStressOdd[g], GetRows, &rows, s->kernels[g]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a product ---- */

static PetscErrorCode Pass(SamStress s, PetscInt pass, const double *const in[], double *const out[])
{
  SamKernelMatrix matrix = {.n_in = SAM_STRESS_TRACTIONS, .n_out = SAM_STRESS_GROUP};

  PetscFunctionBegin;
  for (PetscInt o = 0; o < SAM_STRESS_GROUP; o++)
    for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) {
      const SamStressKernel k = SamStressKernels[components[pass][o]][t];

      matrix.kernel[o][t] = s->kernels[k.group][k.member];
      matrix.scale[o][t]  = s->sign[t];
    }
  PetscCall(SamConvolve(s->fourier, &matrix, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stresses of the surface that are the tractions. */
static void TakeTractions(SamStress s, double *const tractions[])
{
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++)
    for (PetscInt k = 0; k < s->grid->cells; k++)
      tractions[t][k] = tractions[t][k] == 0 ? 0 : -s->sign[t] * tractions[t][k];
}

PetscErrorCode SamStressApply(SamStress s, Vec field)
{
  const double *in[SAM_STRESS_TRACTIONS];
  double       *array, *out[PASSES][SAM_STRESS_GROUP];

  PetscFunctionBegin;
  PetscCheck(s->source.depth >= 0, s->grid->comm, PETSC_ERR_ORDER, "The depth is not set");
  PetscCall(SamGridCheckVec(s->grid, SAM_STRESS_COMPONENTS, field, "The stress"));
  PetscCall(VecGetArray(field, &array));
  for (PetscInt pass = 0; pass < PASSES; pass++)
    for (PetscInt o = 0; o < SAM_STRESS_GROUP; o++) out[pass][o] = array + components[pass][o] * s->grid->cells;
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) in[t] = out[NORMAL][t];
  PetscCall(Pass(s, PLANE, in, out[PLANE]));
  if (IsSurface(s))
    TakeTractions(s, out[NORMAL]);
  else
    PetscCall(Pass(s, NORMAL, in, out[NORMAL]));
  PetscCall(VecRestoreArray(field, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}
