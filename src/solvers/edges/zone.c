/* Zones: distances from the edge, found from the cells outside that touch the zone. */
#include "edgesimpl.h"
#include <string.h>

/* Marks each cell of a row that is marked in `in`, or whose neighbour in the row is. */
SAM_VECTORIZED static void Widen(PetscInt n, const char *restrict in, char *restrict out)
{
  out[0]     = in[0] | in[1];
  out[n - 1] = in[n - 2] | in[n - 1];
  for (PetscInt i = 1; i + 1 < n; i++) out[i] = in[i - 1] | in[i] | in[i + 1];
}

/* Offsets within the reach, and their squared lengths */
typedef struct {
  PetscInt    reach, count, x[512], y[512];
  ptrdiff_t   at[512]; /* from the cell in the middle, in the zone's arrays */
  signed char square[512];
} Disc;

static void FillDisc(PetscInt width, PetscReal reach, Disc *disc)
{
  const PetscInt most = (PetscInt)reach;

  disc->reach = most;
  disc->count = 0;
  for (PetscInt b = -most; b <= most; b++)
    for (PetscInt a = -most; a <= most; a++)
      if (a * a + b * b <= reach * reach) {
        disc->x[disc->count]        = a;
        disc->y[disc->count]        = b;
        disc->at[disc->count]       = (ptrdiff_t)b * width + a;
        disc->square[disc->count++] = (signed char)(a * a + b * b);
      }
}

/* For cells of the other kind in the disc about an edge cell, lowers the distances to the distance from this cell. */
static void Mark(SamZone *z, const Disc *disc, const char in[], PetscInt i, PetscInt j)
{
  const PetscInt  reach  = disc->reach;
  const PetscBool whole  = (PetscBool)(SamZoneHas(z, i - reach, j - reach) && SamZoneHas(z, i + reach, j + reach));
  const char      inside = in[SamZoneAt(z, i, j)];

  for (PetscInt k = 0; k < disc->count; k++) {
    const ptrdiff_t at = SamZoneAt(z, i, j) + disc->at[k];

    if ((!whole && !SamZoneHas(z, i + disc->x[k], j + disc->y[k])) || in[at] == inside) continue;
    z->distance[at] =
      (signed char)(inside ? PetscMax(z->distance[at], -disc->square[k]) : PetscMin(z->distance[at], disc->square[k]));
  }
}

/* Marks the cells of a row in the zone and outside, and sets their distances to the largest; returns 1 if any is in. */
SAM_VECTORIZED static char FillRow(PetscInt n, const double *restrict w, char *restrict in, char *restrict out,
                                   signed char *restrict distance)
{
  char any = 0;

  for (PetscInt i = 0; i < n; i++) {
    in[i]       = w[i] > 0;
    out[i]      = !in[i];
    distance[i] = (signed char)(in[i] ? SAM_FAR : -SAM_FAR);
    any |= in[i];
  }
  return any;
}

/* Marks the cells of a row that have a neighbour of the other kind, from the rows before and after it, both widened. */
SAM_VECTORIZED static void FindEdgeCells(PetscInt n, const char *restrict in, const char *const out_near[3],
                                         const char *const in_near[3], char *restrict edge)
{
  const char *restrict o[3] = {out_near[0], out_near[1], out_near[2]};
  const char *restrict z[3] = {in_near[0], in_near[1], in_near[2]};

  for (PetscInt i = 0; i < n; i++) {
    const char outside = o[0][i] | o[1][i] | o[2][i], inside = z[0][i] | z[1][i] | z[2][i];

    edge[i] = in[i] ? outside : inside;
  }
}

/*
  The nearest cell of the other kind has a neighbour of this kind: the cell one step nearer. So only cells with a
  neighbour of the other kind mark distances; they are found in whole rows.
*/
static PetscErrorCode FindDistances(SamZone *z, PetscReal reach)
{
  const PetscInt n = z->width;
  char          *in, *out_near, *in_near, *row;
  Disc           disc;

  PetscFunctionBegin;
  FillDisc(n, reach, &disc);
  PetscCall(PetscMalloc4(z->count * n, &in, z->count * n, &out_near, z->count * n, &in_near, n, &row));
  for (PetscInt j = 0; j < z->count; j++) z->bare[j] = 1;
  for (PetscInt j = 0; j < z->count; j++) {
    const ptrdiff_t k   = (ptrdiff_t)j * n;
    const char      any = FillRow(n, z->w + k, in + k, row, z->distance + k);

    Widen(n, row, out_near + k);
    Widen(n, in + k, in_near + k);
    for (PetscInt b = PetscMax(j - disc.reach, 0); any && b <= PetscMin(j + disc.reach, z->count - 1); b++)
      z->bare[b] = 0;
  }
  for (PetscInt j = 0; j < z->count; j++) {
    const ptrdiff_t before = (ptrdiff_t)PetscMax(j - 1, 0) * n, here = (ptrdiff_t)j * n,
                    after = (ptrdiff_t)PetscMin(j + 1, z->count - 1) * n;

    if (z->bare[j]) continue;
    FindEdgeCells(n, in + here, (const char *[]){out_near + before, out_near + here, out_near + after},
                  (const char *[]){in_near + before, in_near + here, in_near + after}, row);
    for (PetscInt i = 0; i < n; i++)
      if (row[i]) Mark(z, &disc, in, z->left + i, z->first + j);
  }
  PetscCall(PetscFree4(in, out_near, in_near, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies rows of the grid to the first column of the grid and the rows from `at` on. Collective. */
static PetscErrorCode CopyRows(SamZone *z, const double own[], PetscInt first, PetscInt count, PetscInt at)
{
  const PetscInt nx = z->grid->nx;
  const double  *seen;
  SamRows        rows;

  PetscFunctionBegin;
  PetscCall(SamRowsCreate(z->grid, count > 0 ? first : 0, PetscMax(count, 0), &rows));
  PetscCall(SamRowsFetch(&rows, nx, own, &seen));
  for (PetscInt j = 0; j < count; j++)
    PetscCall(PetscArraycpy(z->w + SamZoneAt(z, 0, at + j), seen + (ptrdiff_t)j * nx, nx));
  PetscCall(SamRowsRestore(&rows, &seen));
  PetscCall(SamRowsDestroy(&rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fetches the field's rows in the window; on a periodic grid, rows and columns from the other side, too. Collective. */
static PetscErrorCode Fetch(SamZone *z, PetscInt periods, Vec field)
{
  const PetscInt nx = z->grid->nx, ny = z->grid->ny, end = z->first + z->count;
  const double  *own;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(field, &own));
  for (PetscInt k = -periods; k <= periods; k++) { /* rows of the grid, and of its periods before and after it */
    const PetscInt begin = PetscMax(z->first, k * ny), stop = PetscMin(end, (k + 1) * ny);

    PetscCall(CopyRows(z, own, begin - k * ny, stop - begin, begin));
  }
  PetscCall(VecRestoreArrayRead(field, &own));
  for (PetscInt j = z->first; j < end; j++)
    for (PetscInt i = z->left; i < 0; i++) {
      z->w[SamZoneAt(z, i, j)]          = z->w[SamZoneAt(z, i + nx, j)];
      z->w[SamZoneAt(z, nx - 1 - i, j)] = z->w[SamZoneAt(z, -1 - i, j)];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamZoneCreate(SamGrid grid, PetscBool periodic, Vec field, PetscInt halo, PetscReal reach, SamZone *z)
{
  const PetscBool wraps   = periodic && grid->ny > 1;
  const PetscInt  columns = periodic ? PetscMin(halo, grid->nx) : 0, rows = wraps ? halo : PetscMin(halo, grid->ny);
  const PetscInt  begin = grid->row_start - rows, end = grid->row_start + grid->rows + rows;

  PetscFunctionBegin;
  *z       = (SamZone){.grid = grid, .left = -columns, .width = grid->nx + 2 * columns};
  z->first = wraps ? begin : PetscMax(begin, 0);
  z->count = grid->rows ? (wraps ? end : PetscMin(end, grid->ny)) - z->first : 0;
  PetscCall(PetscMalloc3(z->count * z->width, &z->w, z->count * z->width, &z->distance, z->count, &z->bare));
  PetscCall(Fetch(z, wraps ? (halo + grid->ny - 1) / grid->ny : 0, field));
  PetscCall(FindDistances(z, reach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamZoneDestroy(SamZone *z)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(z->w, z->distance, z->bare));
  PetscFunctionReturn(PETSC_SUCCESS);
}
