/* Zones: distances from the edge, found from the cells outside that touch the zone. */
#include "edgesimpl.h"
#include <string.h>

/* Marks each cell of a row that is marked in `in`, or whose neighbour in the row is. */
static void Widen(PetscInt n, const char in[], char out[])
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

/*
  The nearest cell of the other kind has a neighbour of this kind: the cell one step nearer. So only cells with a
  neighbour of the other kind mark distances; they are found in whole rows.
*/
static PetscErrorCode FindDistances(SamZone *z, PetscReal reach)
{
  const PetscInt n = z->width;
  char          *in, *wide[2], *any;
  Disc           disc;

  PetscFunctionBegin;
  FillDisc(n, reach, &disc);
  PetscCall(PetscMalloc4(z->count * n, &in, z->count * n, &wide[0], z->count * n, &wide[1], n, &any));
  (void)memset(z->bare, 1, (size_t)z->count);
  for (PetscInt j = 0; j < z->count; j++) {
    PetscInt cells = 0;

    for (PetscInt i = 0, k = j * n; i < n; i++, k++) {
      in[k]          = z->w[k] > 0 ? 1 : 0;
      any[i]         = 1 - in[k]; /* cells outside */
      z->distance[k] = in[k] ? SAM_FAR : -SAM_FAR;
      cells += in[k];
    }
    Widen(n, any, wide[0] + j * n);
    Widen(n, in + j * n, wide[1] + j * n);
    for (PetscInt b = PetscMax(j - disc.reach, 0); cells && b <= PetscMin(j + disc.reach, z->count - 1); b++)
      z->bare[b] = 0;
  }
  for (PetscInt j = 0; j < z->count; j++) {
    if (z->bare[j]) continue;
    const PetscInt before = PetscMax(j - 1, 0) * n, here = j * n, after = PetscMin(j + 1, z->count - 1) * n;

    for (PetscInt i = 0; i < n; i++)
      any[i] = in[here + i] ? wide[0][before + i] | wide[0][here + i] | wide[0][after + i]
                            : wide[1][before + i] | wide[1][here + i] | wide[1][after + i];
    for (PetscInt i = 0; i < n; i++)
      if (any[i]) Mark(z, &disc, in, z->left + i, z->first + j);
  }
  PetscCall(PetscFree4(in, wide[0], wide[1], any));
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
static PetscErrorCode Fetch(SamZone *z, Vec field)
{
  const PetscInt nx = z->grid->nx, ny = z->grid->ny, end = z->first + z->count;
  const PetscInt begin = PetscMax(z->first, 0), stop = PetscMin(end, ny);
  const double  *own;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(field, &own));
  PetscCall(CopyRows(z, own, z->first + ny, begin - z->first, z->first));
  PetscCall(CopyRows(z, own, begin, stop - begin, begin));
  PetscCall(CopyRows(z, own, 0, end - stop, stop));
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
  const PetscInt  columns = periodic ? PetscMin(halo, grid->nx) : 0, rows = PetscMin(halo, grid->ny);
  const PetscInt  begin = grid->row_start - rows, end = grid->row_start + grid->rows + rows;
  const PetscBool wraps = periodic && grid->ny > 1;

  PetscFunctionBegin;
  *z       = (SamZone){.grid = grid, .left = -columns, .width = grid->nx + 2 * columns};
  z->first = wraps ? begin : PetscMax(begin, 0);
  z->count = grid->rows ? (wraps ? end : PetscMin(end, grid->ny)) - z->first : 0;
  PetscCall(PetscMalloc3(z->count * z->width, &z->w, z->count * z->width, &z->distance, z->count, &z->bare));
  PetscCall(Fetch(z, field));
  PetscCall(FindDistances(z, reach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamZoneDestroy(SamZone *z)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(z->w, z->distance, z->bare));
  PetscFunctionReturn(PETSC_SUCCESS);
}
