/* Zones: distances from the edge, found from the cells outside that touch the zone. */
#include "edgesimpl.h"

/* For each cell of a row: whether it or one of its neighbours in the row is 1. */
static void Widen(PetscInt n, const char in[], char out[])
{
  out[0]     = in[0] | in[1];
  out[n - 1] = in[n - 2] | in[n - 1];
  for (PetscInt i = 1; i + 1 < n; i++) out[i] = in[i - 1] | in[i] | in[i + 1];
}

/* Offsets within the reach, and their squared lengths. */
typedef struct {
  PetscInt    count, x[512], y[512];
  signed char square[512];
} Disc;

static void FillDisc(PetscReal reach, Disc *disc)
{
  const PetscInt most = (PetscInt)reach;

  disc->count = 0;
  for (PetscInt b = -most; b <= most; b++)
    for (PetscInt a = -most; a <= most; a++)
      if (a * a + b * b <= reach * reach) {
        disc->x[disc->count]        = a;
        disc->y[disc->count]        = b;
        disc->square[disc->count++] = (signed char)(a * a + b * b);
      }
}

/* The cells of the other kind within the disc about a cell at the edge get their distance from it, if that is less. */
static void Mark(SamZone *z, const Disc *disc, const char in[], PetscInt i, PetscInt j)
{
  const char inside = in[SamZoneAt(z, i, j)];

  for (PetscInt k = 0; k < disc->count; k++) {
    const PetscInt a = i + disc->x[k], b = j + disc->y[k];
    ptrdiff_t      at;

    if (!SamZoneHas(z, a, b)) continue;
    at = SamZoneAt(z, a, b);
    if (in[at] == inside) continue;
    z->distance[at] =
      (signed char)(inside ? PetscMax(z->distance[at], -disc->square[k]) : PetscMin(z->distance[at], disc->square[k]));
  }
}

/*
  The nearest cell of the other kind touches its own kind's border: from there one step nearer is a cell of this kind.
  So only cells with a neighbour of the other kind are looked from; they are found in whole rows.
*/
static PetscErrorCode FindDistances(SamZone *z, PetscReal reach)
{
  const PetscInt nx = z->grid->nx;
  char          *in, *wide[2], *any;
  Disc           disc;

  PetscFunctionBegin;
  FillDisc(reach, &disc);
  PetscCall(PetscMalloc4(z->count * nx, &in, z->count * nx, &wide[0], z->count * nx, &wide[1], nx, &any));
  for (PetscInt j = 0; j < z->count; j++) {
    for (PetscInt i = 0, k = j * nx; i < nx; i++, k++) {
      in[k]          = z->w[k] > 0 ? 1 : 0;
      any[i]         = 1 - in[k]; /* cells outside */
      z->distance[k] = in[k] ? SAM_FAR : -SAM_FAR;
    }
    Widen(nx, any, wide[0] + j * nx);
    Widen(nx, in + j * nx, wide[1] + j * nx);
  }
  for (PetscInt j = 0; j < z->count; j++) {
    const PetscInt before = PetscMax(j - 1, 0) * nx, here = j * nx, after = PetscMin(j + 1, z->count - 1) * nx;

    for (PetscInt i = 0; i < nx; i++)
      any[i] = in[here + i] ? wide[0][before + i] | wide[0][here + i] | wide[0][after + i]
                            : wide[1][before + i] | wide[1][here + i] | wide[1][after + i];
    for (PetscInt i = 0; i < nx; i++)
      if (any[i]) Mark(z, &disc, in, i, z->first + j);
  }
  PetscCall(PetscFree4(in, wide[0], wide[1], any));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamZoneCreate(SamGrid grid, Vec field, PetscInt halo, PetscReal reach, SamZone *z)
{
  PetscFunctionBegin;
  *z = (SamZone){.grid = grid, .field = field};
  PetscCall(SamRowsCreateAbout(grid, halo, &z->rows));
  z->first = z->rows.first;
  z->count = z->rows.count;
  PetscCall(VecGetArrayRead(field, &z->own));
  PetscCall(SamRowsFetch(&z->rows, grid->nx, z->own, &z->w));
  PetscCall(PetscMalloc1(z->count * grid->nx, &z->distance));
  PetscCall(FindDistances(z, reach));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamZoneDestroy(SamZone *z)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(z->distance));
  PetscCall(SamRowsRestore(&z->rows, &z->w));
  PetscCall(VecRestoreArrayRead(z->field, &z->own));
  PetscCall(SamRowsDestroy(&z->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}
