/*
  Stresses on planes parallel to the surface: convolutions of the tractions with the kernels of a depth, which come from
  the type of elasticity.

  There are two passes from three fields to three: one for xx, yy and xy, and one for zz, xz and yz, whose matrix is
  symmetric. On the surface the second pass is not needed, as these stresses are the tractions. The second pass
  overwrites the tractions with its result. Of a half-space's 18 kernels 15 differ, and each is a quadrant of real
  numbers: they take 120 bytes per cell, in addition to 48 for the stresses and 48 for the spectra of a pass.
*/
#include <petsam/private/edges.h>
#include <petsam/private/fourier.h>
#include <petsam/private/grid.h>
#include <petsam/private/stressimpl.h>
#include <math.h>

enum { PLANE, NORMAL, PASSES };
static const SamStressComponent components[PASSES][SAM_STRESS_GROUP] = {
  [PLANE]  = {SAM_STRESS_XX, SAM_STRESS_YY, SAM_STRESS_XY},
  [NORMAL] = {SAM_STRESS_ZZ, SAM_STRESS_XZ, SAM_STRESS_YZ},
};

#define EVEN PETSC_FALSE
#define ODD  PETSC_TRUE
const SamStressKernel SamStressKernels[SAM_STRESS_COMPONENTS][SAM_STRESS_TRACTIONS] = {
  [SAM_STRESS_XX] = {{SAM_STRESS_PLANE_P, 0}, {SAM_STRESS_PLANE_X, 0}, {SAM_STRESS_PLANE_Y, 0}},
  [SAM_STRESS_YY] = {{SAM_STRESS_PLANE_P, 1}, {SAM_STRESS_PLANE_X, 1}, {SAM_STRESS_PLANE_Y, 1}},
  [SAM_STRESS_ZZ] = {{SAM_STRESS_NORMAL_P, 0}, {SAM_STRESS_NORMAL_P, 1}, {SAM_STRESS_NORMAL_P, 2}},
  [SAM_STRESS_XY] = {{SAM_STRESS_PLANE_P, 2}, {SAM_STRESS_PLANE_X, 2}, {SAM_STRESS_PLANE_Y, 2}},
  [SAM_STRESS_XZ] = {{SAM_STRESS_NORMAL_P, 1}, {SAM_STRESS_NORMAL_T, 0}, {SAM_STRESS_NORMAL_T, 1}},
  [SAM_STRESS_YZ] = {{SAM_STRESS_NORMAL_P, 2}, {SAM_STRESS_NORMAL_T, 1}, {SAM_STRESS_NORMAL_T, 2}},
};

const PetscBool SamStressOdd[SAM_STRESS_GROUPS][SAM_STRESS_GROUP][2] = {
  [SAM_STRESS_PLANE_P]  = {{EVEN, EVEN}, {EVEN, EVEN}, {ODD, ODD}},
  [SAM_STRESS_PLANE_X]  = {{ODD, EVEN}, {ODD, EVEN}, {EVEN, ODD}},
  [SAM_STRESS_PLANE_Y]  = {{EVEN, ODD}, {EVEN, ODD}, {ODD, EVEN}},
  [SAM_STRESS_NORMAL_P] = {{EVEN, EVEN}, {ODD, EVEN}, {EVEN, ODD}},
  [SAM_STRESS_NORMAL_T] = {{EVEN, EVEN}, {ODD, ODD}, {EVEN, EVEN}},
  [SAM_STRESS_NORMAL_Z] = {{ODD, EVEN}, {EVEN, ODD}, {EVEN, EVEN}},
};

SamStressKernel SamStressKernelOf(SamStress s, PetscInt component, PetscInt traction)
{
  if (component == SAM_STRESS_ZZ && traction != SAM_STRESS_P && s->groups > SAM_STRESS_NORMAL_Z)
    return (SamStressKernel){SAM_STRESS_NORMAL_Z, traction - SAM_STRESS_QX};
  return SamStressKernels[component][traction];
}

PetscErrorCode SamStressCreate(SamGrid grid, const SamFourierSettings *settings, PetscInt body, SamStress *stress)
{
  SamStress s;

  PetscFunctionBegin;
  PetscCheck(body == 1 || body == 2, grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "Body %" PetscInt_FMT ": expected 1 or 2",
             body);
  PetscCall(PetscNew(&s));
  PetscCall(SamGridReference(grid));
  s->grid   = grid;
  s->depth  = -1;
  s->groups = SAM_STRESS_NORMAL_Z;
  if (settings) s->settings = *settings;
  /* the shear on body 1 is the opposite of that on body 2 */
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) s->sign[t] = t != SAM_STRESS_P && body == 1 ? -1 : 1;
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
  if (s->ops.destroy) PetscCall((*s->ops.destroy)(s));
  PetscCall(DestroyKernels(s));
  PetscCall(SamFourierDestroy(&s->fourier));
  PetscCall(SamGridDestroy(&s->grid));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the depth ---- */

typedef struct {
  SamStress      stress;
  SamStressGroup group;
} Rows;

static void GetRows(PetscInt j, PetscInt n, double *const values[], const void *context)
{
  const Rows  *rows    = (const Rows *)context;
  SamStress    s       = rows->stress;
  const double side[2] = {(double)s->grid->area[0], (double)s->grid->area[1]};

  (*s->ops.row)(s, side, (double)s->depth, rows->group, j, n, values);
}

/* True at the surface, where the stresses zz, xz and yz are the tractions. */
static PetscBool IsSurface(SamStress s)
{
  return s->depth == 0;
}

PetscErrorCode SamStressUseDepth(SamStress s, PetscReal depth)
{
  PetscFunctionBegin;
  PetscCheck(depth >= 0 && depth < PETSC_INFINITY, s->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Depth %.6g m: expected a number >= 0", (double)depth);
  if (s->ops.usedepth) PetscCall((*s->ops.usedepth)(s, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressSetDepth(SamStress s, PetscReal depth)
{
  PetscFunctionBegin;
  PetscCall(SamStressUseDepth(s, depth));
  if (!s->fourier) PetscCall(SamFourierCreate(s->grid, SAM_FOURIER_FAST, &s->settings, &s->fourier));
  PetscCall(DestroyKernels(s));
  s->depth = depth;
  for (PetscInt g = 0; g < s->groups; g++) {
    const Rows rows = {s, (SamStressGroup)g};

    if (IsSurface(s) && g >= SAM_STRESS_NORMAL_P) continue;
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
      const SamStressKernel k = SamStressKernelOf(s, components[pass][o], t);

      matrix.kernel[o][t] = s->kernels[k.group][k.member];
      matrix.scale[o][t]  = s->sign[t];
    }
  PetscCall(SamConvolve(s->fourier, &matrix, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the stresses zz, xz and yz on the surface, which equal the tractions. */
static void TakeTractions(SamStress s, double *const tractions[])
{
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++)
    for (PetscInt k = 0; k < s->grid->cells; k++)
      tractions[t][k] = tractions[t][k] == 0 ? 0 : -s->sign[t] * tractions[t][k];
}

/* Adds the smooth part at this rank's cells. */
static void AddSmooth(SamStress s, const double sums[], double *const field[])
{
  const SamGrid g       = s->grid;
  const double  step[2] = {(double)g->dx, 0};

  for (PetscInt j = 0; j < g->rows; j++) {
    const double first[3] = {(double)SamGridX(g, 0), (double)SamGridY(g, g->row_start + j), (double)s->depth};
    double      *to[SAM_STRESS_COMPONENTS];

    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) to[c] = field[c] + j * (ptrdiff_t)g->nx;
    (*s->ops.add)(s, sums, first, step, g->nx, to);
  }
}

PetscErrorCode SamStressApply(SamStress s, Vec field)
{
  const double *in[SAM_STRESS_TRACTIONS];
  double       *array, *sums, *out[PASSES][SAM_STRESS_GROUP], *to[SAM_STRESS_COMPONENTS];

  PetscFunctionBegin;
  PetscCheck(s->depth >= 0, s->grid->comm, PETSC_ERR_ORDER, "The depth is not set");
  PetscCall(SamGridCheckVec(s->grid, SAM_STRESS_COMPONENTS, field, "The stress"));
  PetscCall(VecGetArray(field, &array));
  for (PetscInt pass = 0; pass < PASSES; pass++)
    for (PetscInt o = 0; o < SAM_STRESS_GROUP; o++) out[pass][o] = array + components[pass][o] * s->grid->cells;
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) in[t] = out[NORMAL][t];
  PetscCall(PetscMalloc1(s->sums, &sums));
  if (s->sums) PetscCall((*s->ops.reduce)(s, in, sums));
  PetscCall(Pass(s, PLANE, in, out[PLANE]));
  if (IsSurface(s))
    TakeTractions(s, out[NORMAL]);
  else
    PetscCall(Pass(s, NORMAL, in, out[NORMAL]));
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) to[c] = array + c * s->grid->cells;
  if (s->sums) AddSmooth(s, sums, to);
  PetscCall(PetscFree(sums));
  PetscCall(VecRestoreArray(field, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressAddColumns(SamStress s, const SamFourierBlock *block, PetscInt phase, PetscInt b,
                                   PetscBool transposed, const double scale[SAM_STRESS_COMPONENTS],
                                   double (*const traction[SAM_STRESS_TRACTIONS])[2],
                                   double (*const component[SAM_STRESS_COMPONENTS])[2], double (*scratch)[2])
{
  PetscFunctionBegin;
  for (PetscInt pass = 0; pass < PASSES; pass++) {
    SamKernelMatrix matrix = {.n_in = SAM_STRESS_GROUP, .n_out = SAM_STRESS_GROUP};
    double(*of[SAM_STRESS_GROUP])[2];

    for (PetscInt o = 0; o < SAM_STRESS_GROUP; o++) {
      const PetscInt c = components[pass][o];

      of[o] = component[c];
      for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) {
        const SamStressKernel k   = SamStressKernelOf(s, c, t);
        const PetscBool      *odd = SamStressOdd[k.group][k.member];
        const PetscInt        to = transposed ? t : o, from = transposed ? o : t;
        const double          factor = s->sign[t] * scale[c];

        matrix.kernel[to][from] = s->kernels[k.group][k.member];
        matrix.scale[to][from]  = transposed && odd[0] != odd[1] ? -factor : factor;
      }
    }
    if (transposed)
      PetscCall(SamKernelMatrixAdd(&matrix, block, phase, b, of, traction, scratch));
    else
      PetscCall(SamKernelMatrixAdd(&matrix, block, phase, b, traction, of, scratch));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressAtEdge(SamStress s, Vec field, const SamEdge *edge, double values[])
{
  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(s->grid, SAM_STRESS_COMPONENTS, field, "The stress"));
  for (PetscInt k = 0; k < 3 * edge->count; k++) values[k] = NAN;
  if (s->ops.atedge) PetscCall((*s->ops.atedge)(s, field, edge, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
