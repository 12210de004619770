/*
  The class SamResidual: the operators of plastic strain on a grid, by waves (strainwaves.c).

  The transforms process three planes at a time. All spectra are stored: those of the strain become those of the stress,
  to which that by the tractions is added, so that a product takes one transform of each plane of the strain and one of
  each plane of the stress. For bodies that are not periodic, the waves have a padded period, and the images of the
  window are subtracted again (images.c). For them the stress by tractions comes from the cells' kernels at the middle
  of each layer, and the displacement by plastic strain from the transpose of these.

  If the body has layers of other materials on its surface, the layers of plastic strain begin below them. The layers
  above are bonded to the waves' surface: with the compliances C of both sides of this interface (body/symbols.c),
  they answer the displacement u that the strain would cause without them by tractions -u/C. Their images are those of a
  half-space without them, since long waves bend thin layers freely.
*/
#include "images.h"
#include "strainwaves.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/fourier.h>
#include <petsam/private/body.h>

struct _n_SamResidual {
  SamGrid         grid;
  SamElasticity   elasticity;
  PetscInt        number; /* number of the body, 1 or 2 */
  SamFourier      fourier;
  SamFourierMode  mode;
  double          period; /* period of the waves along x, in cells; along y it is `waves` */
  SamWaveBody     body;
  PetscReal      *thickness;
  double          sign;           /* sign of the shear between the bodies as it acts on this body */
  PetscInt        first, columns; /* frequency of this rank's first column, and their number */
  PetscInt        phases, waves;  /* phases and waves of a column: see SamFourierBlock */
  SamFourierBlock block;          /* all columns of this rank, without data */
  double         *ky;             /* wave numbers of these waves along y, 1/m */
  double         *hold;           /* (4, columns, waves): stiffness of the layers above; NULL: there are none */
  PetscInt        nyquist;        /* index of the wave of two cells along y, which is also the wave of -ky; -1: none */
  double complex *spectra;        /* (planes, columns, waves) */
  double complex *surface;        /* (3, columns, waves): of the displacement or of the tractions */
  PetscBool       strained;       /* true: the product that has begun is one with a strain */
  /* only if not periodic */
  SamStress *stress; /* kernels of each layer */
  SamImages  images;
};

/* ---- transforms ---- */

/* Planes that one pass of the transforms moves between the spectra and the blocks */
typedef struct {
  SamResidual     r;
  PetscInt        first, count; /* planes */
  PetscBool       back;
  double          scale;   /* factor in the backward direction */
  double complex *spectra; /* NULL: only counts the columns */
} Move;

static void CountBlock(SamResidual r, const SamFourierBlock *block)
{
  r->first  = block->first - block->local;
  r->phases = block->phases;
  r->waves  = block->phases * block->hy;
  r->columns += block->columns;
  r->block = (SamFourierBlock){.phases = r->phases, .hy = block->hy, .stride = block->stride, .columns = r->columns};
}

static void MoveBlock(const SamFourierBlock *block, const void *context)
{
  const Move *move = (const Move *)context;
  SamResidual r    = move->r;

  if (!move->spectra) CountBlock(r, block);
  for (PetscInt c = 0; move->spectra && c < move->count; c++)
    for (PetscInt b = 0; b < block->columns; b++)
      for (PetscInt f = 0; f < block->phases; f++) {
        const ptrdiff_t column = (ptrdiff_t)(move->first + c) * r->columns + block->local + b;
        double complex *kept   = move->spectra + column * r->waves + f * block->hy;
        double complex *here   = (double complex *)block->data[c] + (f * block->width + b) * (ptrdiff_t)block->stride;

        if (!move->back) memcpy(kept, here, sizeof(*kept) * (size_t)block->hy);
        for (PetscInt m = 0; move->back && m < block->hy; m++) here[m] = move->scale * kept[m];
      }
}

/* Transforms fields to spectra, three at a time, or back (`in` NULL). */
static PetscErrorCode Transform(SamResidual r, PetscInt planes, const double *const in[], double *const out[],
                                double complex *spectra)
{
  Move             move   = {.r = r, .back = !in, .scale = 1 / (r->period * (double)r->waves), .spectra = spectra};
  SamFourierFilter filter = {.mode = r->mode, .apply = MoveBlock, .context = &move};

  PetscFunctionBegin;
  for (; move.first < planes; move.first += move.count) {
    move.count = PetscMin(SAM_FOURIER_FIELDS, planes - move.first);
    if (in)
      filter.n_in = move.count;
    else
      filter.n_out = move.count;
    PetscCall(SamFourierApply(r->fourier, &filter, in ? in + move.first : NULL, in ? NULL : out + move.first));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts this rank's columns by a pass without fields, and allocates their spectra. */
static PetscErrorCode CreateSpectra(SamResidual r)
{
  const PetscInt planes = PARTS * r->body.layers;
  Move           move   = {.r = r};
  double        *zero, *field[1];

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(r->grid->cells, &zero));
  field[0] = zero;
  PetscCall(SamFourierApply(r->fourier,
                            &(SamFourierFilter){.mode = r->mode, .n_in = 1, .apply = MoveBlock, .context = &move},
                            (const double *const *)field, NULL));
  PetscCall(PetscFree(zero));
  PetscCall(SamAllocate(sizeof(*r->spectra) * (size_t)((planes + 3) * r->columns * r->waves), &r->spectra));
  r->surface = r->spectra + (ptrdiff_t)planes * r->columns * r->waves;
  if (SamGridIsRow(r->grid)) { /* one column along x */
    r->block.hy      = r->columns;
    r->block.columns = 1;
  }
  PetscCall(PetscMalloc1(r->waves, &r->ky));
  r->nyquist = -1;
  for (PetscInt k = 0; k < r->waves; k++) {
    const PetscInt hy = r->waves / r->phases, ky = r->phases * (k % hy) + k / hy;

    if (2 * ky == r->waves) r->nyquist = k;
    r->ky[k] =
      2 * PETSC_PI / ((double)r->waves * (double)r->grid->dy) * (double)(2 * ky <= r->waves ? ky : ky - r->waves);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- creation ---- */

PetscErrorCode SamResidualCheckBodies(SamElasticity e, PetscInt body)
{
  const SamElasticityType type = SamElasticityGetType(e);
  const SamBodyPlace      last = SamBodyAt(SamPairBody(e->pair, body - 1), INFINITY);

  PetscFunctionBegin;
  PetscCheck(!strcmp(type, SAM_ELASTICITY_HALFSPACE) || !strcmp(type, SAM_ELASTICITY_PERIODIC) ||
               !strcmp(type, SAM_ELASTICITY_PLANE) || !strcmp(type, SAM_ELASTICITY_PLANE_PERIODIC),
             e->grid->comm, SAM_ERR_USER, "-body%" PetscInt_FMT "_yield: not supported with bodies of type %s", body,
             type);
  PetscCheck(!isinf(last.young), e->grid->comm, SAM_ERR_USER, "-body%" PetscInt_FMT "_yield: the body%s is rigid", body,
             last.number > 0 ? " below its layers" : "");
  PetscCheck(last.number == 0 || !strcmp(type, SAM_ELASTICITY_HALFSPACE), e->grid->comm, SAM_ERR_USER,
             "-body%" PetscInt_FMT
             "_yield: not supported below layers of bodies of type %s, only of type " SAM_ELASTICITY_HALFSPACE,
             body, type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the stiffness of the layers above; the mean stays free. */
static PetscErrorCode CreateHold(SamResidual r, SamBody body)
{
  const ptrdiff_t n = (ptrdiff_t)r->columns * r->waves;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(4 * n, &r->hold));
  for (ptrdiff_t m = 0; m < n; m++) {
    const double k =
      hypot(2 * PETSC_PI / (r->period * (double)r->grid->dx) * (double)(r->first + m / r->waves), r->ky[m % r->waves]);
    double s[4] = {0};

    if (k > 0) SamBodyInterfaceStiffness(body, k, s);
    for (PetscInt c = 0; c < 4; c++) r->hold[c * n + m] = s[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the kernels at the middle of each layer, and the operator of the window's images. */
static PetscErrorCode CreateWindow(SamResidual r, SamElasticity e, PetscInt body, PetscBool images)
{
  const PetscReal period[2] = {r->period * r->grid->dx, (PetscReal)r->waves * r->grid->dy};
  const SamBody   of        = SamPairBody(e->pair, body - 1);
  PetscReal       top       = SamBodyAt(of, INFINITY).top;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(r->body.layers, &r->stress));
  for (PetscInt l = 0; l < r->body.layers; l++) {
    PetscCall(SamElasticityCreateStress(e, body, NULL, &r->stress[l]));
    PetscCall(SamStressSetDepth(r->stress[l], top + r->thickness[l] / 2));
    top += r->thickness[l];
  }
  if (!SamBodyAt(of, 0).last) PetscCall(CreateHold(r, of));
  if (images) PetscCall(SamImagesCreate(r->grid, period, &r->body, &r->images));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResidualCreate(SamElasticity e, PetscInt body, PetscInt layers, const PetscReal thickness[],
                                 PetscBool images, SamResidual *residual)
{
  const PetscBool periodic = SamElasticityGetTraits(e).periodic;
  SamBodyPlace    material;
  SamResidual     r;
  PetscInt        h[2];

  PetscFunctionBegin;
  PetscCall(SamResidualCheckBodies(e, body));
  PetscCall(PetscNew(&r));
  r->grid = SamElasticityGetGrid(e);
  PetscCall(SamGridReference(r->grid));
  r->elasticity = e; /* borrowed: the law that owns this object has a reference */
  r->number     = body;
  material      = SamBodyAt(SamPairBody(e->pair, body - 1), INFINITY);
  PetscCall(PetscMalloc1(layers, &r->thickness));
  PetscCall(PetscArraycpy(r->thickness, thickness, layers));
  r->body = (SamWaveBody){layers, r->thickness, material.young / (2 * (1 + material.poisson)), material.poisson};
  r->sign = body == 1 ? -1 : 1;
  r->mode = periodic ? SAM_FOURIER_PERIODIC : SAM_FOURIER_PADDED;
  PetscCall(SamFourierCreate(r->grid, periodic ? SAM_FOURIER_EXACT : SAM_FOURIER_FAST, &e->fft, &r->fourier));
  PetscCall(SamFourierGetPeriods(r->fourier, &h[0], &h[1]));
  r->period = periodic ? h[0] : 2 * h[0];
  PetscCall(CreateSpectra(r));
  if (!periodic) PetscCall(CreateWindow(r, e, body, images));
  *residual = r;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResidualDestroy(SamResidual *residual)
{
  SamResidual r = *residual;

  PetscFunctionBegin;
  *residual = NULL;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt l = 0; r->stress && l < r->body.layers; l++) PetscCall(SamStressDestroy(&r->stress[l]));
  PetscCall(PetscFree(r->stress));
  PetscCall(SamImagesDestroy(&r->images));
  PetscCall(PetscFree(r->thickness));
  PetscCall(PetscFree(r->ky));
  PetscCall(PetscFree(r->hold));
  SamFree(r->spectra);
  PetscCall(SamFourierDestroy(&r->fourier));
  PetscCall(SamGridDestroy(&r->grid));
  PetscCall(PetscFree(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

/* Gets the planes of a field whose layers are `step` fields apart, or those of all spectra in one column. */
static PetscErrorCode GetPlanes(SamResidual r, const double field[], PetscInt step, const double ***at)
{
  const PetscInt planes = PARTS * r->body.layers;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(planes, at));
  for (PetscInt k = 0; k < planes; k++) (*at)[k] = field + (ptrdiff_t)(k / PARTS * step + k % PARTS) * r->grid->cells;
  PetscFunctionReturn(PETSC_SUCCESS);
}
static void GetColumn(SamResidual r, PetscInt planes, PetscInt b, double complex *spectra, double complex *at[])
{
  for (PetscInt k = 0; k < planes; k++) at[k] = spectra + ((ptrdiff_t)k * r->columns + b) * r->waves;
}
static double WaveOf(SamResidual r, PetscInt b)
{
  return 2 * PETSC_PI / (r->period * (double)r->grid->dx) * (double)(r->first + b);
}

/* Response that is computed in a column of waves: to eigenstrains, or to tractions */
typedef enum { RESPOND, DISPLACE, LOAD } Task;

/* `first`: the first wave among all of this rank. */
static PetscErrorCode WorkOnWaves(SamResidual r, Task task, PetscInt n, ptrdiff_t first, double kx, const double ky[],
                                  double complex *const column[], double complex *const surface[3])
{
  const ptrdiff_t all  = (ptrdiff_t)r->columns * r->waves;
  SamWaveHold     hold = {0};

  PetscFunctionBegin;
  if (r->hold)
    hold = (SamWaveHold){r->hold + first, r->hold + all + first, r->hold + 2 * all + first, r->hold + 3 * all + first};
  if (task == LOAD)
    PetscCall(SamWavesLoad(&r->body, n, kx, ky, (const double complex *const *)surface, column));
  else
    PetscCall(SamWavesApply(&r->body, n, kx, ky, column, task == RESPOND, task == DISPLACE ? surface : NULL,
                            r->hold ? &hold : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the response in a column; the Nyquist wave, which is also the wave of -ky, gets the mean of both. */
static PetscErrorCode WorkOnColumn(SamResidual r, Task task, PetscInt b, double complex *const column[])
{
  const PetscInt  planes = PARTS * r->body.layers, m = r->nyquist;
  double complex *surface[3], *kept, **at;
  const double    back = m < 0 ? 0 : -r->ky[m];

  PetscFunctionBegin;
  GetColumn(r, 3, b, r->surface, surface);
  PetscCall(PetscMalloc2(planes + 3, &kept, planes + 3, &at));
  for (PetscInt k = 0; k < planes + 3; k++) {
    at[k] = &kept[k];
    if (m >= 0) kept[k] = k < planes ? column[k][m] : surface[k - planes][m];
  }
  PetscCall(WorkOnWaves(r, task, r->waves, b * (ptrdiff_t)r->waves, WaveOf(r, b), r->ky, column, surface));
  if (m >= 0) PetscCall(WorkOnWaves(r, task, 1, b * (ptrdiff_t)r->waves + m, WaveOf(r, b), &back, at, at + planes));
  for (PetscInt k = 0; m >= 0 && k < planes + 3; k++) {
    double complex *to = k < planes ? &column[k][m] : &surface[k - planes][m];

    *to = 0.5 * (*to + kept[k]);
  }
  PetscCall(PetscFree2(kept, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the stress by the tractions in a column of waves; `own`: scratch, (planes, waves). */
static PetscErrorCode LoadColumn(SamResidual r, PetscInt b, double complex *const column[], double complex own[])
{
  const PetscInt   planes = PARTS * r->body.layers;
  double complex **load;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(planes, &load));
  for (PetscInt k = 0; k < planes; k++) load[k] = own + (ptrdiff_t)k * r->waves;
  PetscCall(WorkOnColumn(r, LOAD, b, load));
  for (PetscInt k = 0; k < planes; k++)
    for (PetscInt m = 0; m < r->waves; m++) column[k][m] += load[k][m];
  PetscCall(PetscFree(load));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Adds the stress by the tractions to the spectra, by the cells' kernels, or (`transposed`) the displacement by the
  strain, whose weights in products are the layers' thicknesses. The kernels contain the factor of the transforms.
*/
static PetscErrorCode AddCells(SamResidual r, PetscBool transposed)
{
  const ptrdiff_t plane  = (ptrdiff_t)r->columns * r->waves;
  const double    factor = r->period * (double)r->waves;
  double(*scratch)[2];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * r->block.hy, &scratch));
  for (PetscInt b = 0; b < r->block.columns; b++)
    for (PetscInt f = 0; f < r->phases; f++)
      for (PetscInt l = 0; l < r->body.layers; l++) {
        double complex *const first = r->spectra + l * PARTS * plane + (b * r->phases + f) * (ptrdiff_t)r->block.hy;
        double complex *const above = r->surface + (b * r->phases + f) * (ptrdiff_t)r->block.hy;
        double(*component[PARTS])[2], (*traction[SAM_STRESS_TRACTIONS])[2], scale[PARTS];

        for (PetscInt c = 0; c < PARTS; c++) {
          component[c] = (double(*)[2])(first + c * plane);
          scale[c]     = transposed ? factor * (c < SAM_STRESS_XY ? 1 : 2) * r->thickness[l] : factor;
        }
        for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) traction[t] = (double(*)[2])(above + t * plane);
        PetscCall(SamStressAddColumns(r->stress[l], &r->block, f, b, transposed, scale, traction, component, scratch));
      }
  PetscCall(PetscFree(scratch));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the displacement from the spectra of the strain. */
static PetscErrorCode Displace(SamResidual r, double *const u[3])
{
  double *const    order[] = {u[2], u[0], u[1]}; /* as the tractions p, q_x, q_y */
  double complex **column;

  PetscFunctionBegin;
  if (r->stress) {
    PetscCall(PetscArrayzero(r->surface, 3 * r->columns * r->waves));
    PetscCall(AddCells(r, PETSC_TRUE));
    PetscCall(Transform(r, 3, NULL, order, r->surface));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(PARTS * r->body.layers, &column));
  for (PetscInt b = 0; b < r->columns; b++) {
    GetColumn(r, PARTS * r->body.layers, b, r->spectra, column);
    PetscCall(WorkOnColumn(r, DISPLACE, b, column));
  }
  PetscCall(PetscFree(column));
  PetscCall(Transform(r, 3, NULL, u, r->surface));
  for (PetscInt k = 0; k < 2 * r->grid->cells; k++) u[k / r->grid->cells][k % r->grid->cells] *= r->sign;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Begins the product of one body. */
static PetscErrorCode Begin(SamResidual r, const double e[], PetscInt step, double *const u[3])
{
  const double **at;

  PetscFunctionBegin;
  r->strained = PETSC_TRUE;
  PetscCall(GetPlanes(r, e, step, &at));
  PetscCall(Transform(r, PARTS * r->body.layers, at, NULL, r->spectra));
  PetscCall(PetscFree(at));
  if (r->images) PetscCall(SamImagesReduce(r->images, e, step));
  if (u) PetscCall(Displace(r, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResidualBegin(PetscInt bodies, const SamResidual r[], const double e[], PetscInt step,
                                double *const u[3])
{
  const PetscInt cells = r[0]->grid->cells;
  double        *own[3], *more;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(3 * cells, &more));
  for (PetscInt c = 0; c < 3; c++) own[c] = more + c * cells;
  for (PetscInt c = 0; u && c < 3; c++) PetscCall(PetscArrayzero(u[c], cells));
  for (PetscInt b = 0; b < bodies; b++) {
    PetscCall(Begin(r[b], e, step, u ? own : NULL));
    for (PetscInt k = 0; u && k < 3 * cells; k++) u[k / cells][k % cells] += more[k];
    e += (ptrdiff_t)r[b]->body.layers * step * cells;
  }
  PetscCall(PetscFree(more));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamResidualBeginWithout(PetscInt bodies, const SamResidual r[])
{
  for (PetscInt b = 0; b < bodies; b++) r[b]->strained = PETSC_FALSE;
}

/* Computes the spectra of the stress from those of the strain, and of the tractions if `loaded`. */
static PetscErrorCode WorkOnColumns(SamResidual r, PetscBool loaded)
{
  const PetscInt   planes = PARTS * r->body.layers;
  double complex **column, *own;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(planes, &column, planes * r->waves, &own));
  for (PetscInt b = 0; b < r->columns; b++) {
    GetColumn(r, planes, b, r->spectra, column);
    if (r->strained) PetscCall(WorkOnColumn(r, RESPOND, b, column));
    for (PetscInt k = 0; k < planes && !r->strained; k++) PetscCall(PetscArrayzero(column[k], r->waves));
    if (loaded && !r->stress) PetscCall(LoadColumn(r, b, column, own));
  }
  PetscCall(PetscFree2(column, own));
  if (loaded && r->stress) PetscCall(AddCells(r, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ends the product of one body. */
static PetscErrorCode End(SamResidual r, const double *const traction[3], double s[])
{
  const PetscInt plane = r->columns * r->waves;
  const double **at;

  PetscFunctionBegin;
  if (traction) PetscCall(Transform(r, 3, traction, NULL, r->surface));
  for (PetscInt k = plane; traction && !r->stress && k < 3 * plane; k++) r->surface[k] *= r->sign;
  PetscCall(WorkOnColumns(r, traction ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(GetPlanes(r, s, PARTS, &at));
  PetscCall(Transform(r, PARTS * r->body.layers, NULL, (double *const *)at, r->spectra));
  PetscCall(PetscFree(at));
  if (r->strained && r->images) PetscCall(SamImagesAdd(r->images, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResidualEnd(PetscInt bodies, const SamResidual r[], const double *const traction[3], double s[])
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < bodies; b++) {
    PetscCall(End(r[b], traction, s));
    s += (ptrdiff_t)r[b]->body.layers * PARTS * r[b]->grid->cells;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stress by tractions at the depth of such kernels. */
static PetscErrorCode LoadPlane(SamResidual r, SamStress stress, const double *const traction[3], double s[])
{
  const PetscInt cells = r->grid->cells;
  double        *part;
  Vec            plane;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(r->grid, PARTS, &plane));
  PetscCall(VecGetArray(plane, &part));
  PetscCall(PetscArraycpy(part + SAM_STRESS_ZZ * cells, traction[0], cells));
  PetscCall(PetscArraycpy(part + SAM_STRESS_XZ * cells, traction[1], cells));
  PetscCall(PetscArraycpy(part + SAM_STRESS_YZ * cells, traction[2], cells));
  PetscCall(VecRestoreArray(plane, &part));
  PetscCall(SamStressApply(stress, plane));
  PetscCall(VecGetArray(plane, &part));
  PetscCall(PetscArraycpy(s, part, PARTS * cells));
  PetscCall(VecRestoreArray(plane, &part));
  PetscCall(VecDestroy(&plane));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stress by tractions at a depth, as the mean over a layer of thickness zero below a layer that ends
   there. */
static PetscErrorCode LoadWavesAt(SamResidual r, PetscReal depth, const double *const traction[3], double s[])
{
  const SamWaveBody own          = r->body;
  const PetscReal   thickness[2] = {depth, 0};
  const PetscInt    n            = PARTS * r->grid->cells;
  double           *both;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * n, &both));
  r->body.layers    = 2;
  r->body.thickness = thickness;
  r->strained       = PETSC_FALSE;
  PetscCall(End(r, traction, both));
  r->body = own;
  PetscCall(PetscArraycpy(s, both + n, n));
  PetscCall(PetscFree(both));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamResidualLoadAt(SamResidual r, PetscReal depth, const double *const traction[3], double s[])
{
  SamStress stress;

  PetscFunctionBegin;
  if (!r->stress) {
    PetscCall(LoadWavesAt(r, depth, traction, s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamElasticityCreateStress(r->elasticity, r->number, NULL, &stress));
  PetscCall(SamStressSetDepth(stress, depth));
  PetscCall(LoadPlane(r, stress, traction, s));
  PetscCall(SamStressDestroy(&stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}
