/*
  The kept steps of a load cycle (step/stepcache.c) in a checkpoint, so that a restart has the same bits: a table of
  numbers, which is the same on all ranks, and the fields for some rows of the table, which cover parts of the grid's
  rows:

    kept_table      (rows, numbers)
    kept_ranges     (steps, ny, 2)       the columns from the first to the last, without it
    kept_changes    (numbers)
    kept_pressures  (cells)

  The steps are stored in batches; a rank moves its part of a batch at once. A batch is ordered by rows of the grid, so
  that a rank's part is contiguous; within a row by steps, and within a step by the changes.
*/
#include "ioimpl.h"

/* Maximum number of changes of a batch's steps, unless it has only one step: 4 MB */
#define BATCH 1048576

typedef struct {
  hid_t   ranges, changes, pressures;
  hsize_t changed, pressed; /* start of the next batch in the changes, and in the pressures */
} Places;

/* ---- the table ---- */

/* Numbers of the steps with fields, of the changes of all these, and of the cells with a pressure */
typedef struct {
  hsize_t steps, changed, pressed;
} Sizes;

/* The steps of a table from row `first` on that form the next batch */
typedef struct {
  PetscInt  first, end;
  Sizes     sizes;
  PetscInt *at; /* scratch, one number per step */
} Batch;

static void AddStep(SamStepCache cache, PetscInt row, Sizes *s)
{
  PetscBool     pressure;
  PetscInt      changes;
  const hsize_t cells = (hsize_t)SamStepCacheCells(cache, row, &changes, &pressure);

  s->steps += cells > 0;
  s->changed += cells * (hsize_t)changes;
  s->pressed += pressure ? cells : 0;
}

static Sizes CountCells(SamStepCache cache)
{
  Sizes    s = {0, 0, 0};
  PetscInt rows, width;
  double  *table;

  SamStepCacheGetTable(cache, &rows, &width, &table);
  for (PetscInt k = 1; k < rows; k++) AddStep(cache, k, &s);
  return s;
}

static void NextBatch(SamStepCache cache, PetscInt rows, Batch *b)
{
  b->first = b->end;
  b->sizes = (Sizes){0, 0, 0};
  while (b->end < rows && (b->end == b->first || b->sizes.changed < BATCH)) AddStep(cache, b->end++, &b->sizes);
}

off_t SamKeptBytes(SamStepCache cache)
{
  const Sizes s = CountCells(cache);
  PetscInt    rows, width;
  double     *table;

  SamStepCacheGetTable(cache, &rows, &width, &table);
  return (off_t)(s.changed * sizeof(int32_t) + (s.pressed + (hsize_t)(rows * width)) * sizeof(double));
}

static hid_t Create(SamFile f, const char name[], hid_t type, int rank, hsize_t n0, hsize_t n1, hsize_t n2)
{
  const SamLabel label = {.name = name};
  const SamShape shape = {.rank = rank, .size = {n0, n1, n2}, .largest = {n0, n1, n2}};

  return SamFileCreateDataset(f, f->id, &label, type, &shape, 0);
}

static hid_t Open(SamFile f, const char name[])
{
  return SamFileNote(f, H5Dopen2(f->id, name, H5P_DEFAULT));
}

static void Close(SamFile f, hid_t dataset)
{
  if (dataset >= 0) (void)SamFileNote(f, H5Dclose(dataset));
}

static void ClosePlaces(SamFile f, Places *p)
{
  Close(f, p->ranges);
  Close(f, p->changes);
  Close(f, p->pressures);
}

/* ---- the fields of a batch of steps: each function writes to a file that is being written, and else reads ---- */

static void Move(SamFile f, hid_t dataset, hid_t type, const SamBlock *block, void *values)
{
  if (f->writing)
    SamFileWriteBlock(f, dataset, type, block, values);
  else
    SamFileReadBlock(f, dataset, type, block, values);
}

/* Copies between values and a position in a buffer, which advances; the direction depends on the file. */
static void Pass(SamFile f, char **buffer, void *values, size_t bytes)
{
  memcpy(f->writing ? (void *)*buffer : values, f->writing ? values : (void *)*buffer, bytes);
  *buffer += bytes;
}

/* Copies the changes of a batch, or its pressures, by rows of the grid, and within a row by steps. */
static void PassRows(SamFile f, SamStepCache cache, const Batch *b, PetscBool pressures, char *buffer)
{
  PetscInt *at = b->at; /* for each step, the place of its part of the row */

  for (PetscInt k = b->first; k < b->end; k++) at[k - b->first] = 0;
  for (PetscInt j = 0; j < f->grid->rows; j++)
    for (PetscInt k = b->first; k < b->end; k++) {
      const SamStepFields s = SamStepCacheGetFields(cache, k);
      const PetscInt      n = s ? s->range[2 * j + 1] - s->range[2 * j] : 0;

      if (!n) continue;
      if (pressures && s->pressure) Pass(f, &buffer, s->pressure + at[k - b->first], sizeof(double) * (size_t)n);
      for (PetscInt c = 0; c < s->changes && !pressures; c++)
        Pass(f, &buffer, s->change + c * s->cells + at[k - b->first], sizeof(int32_t) * (size_t)n);
      at[k - b->first] += n;
    }
}

/* Moves n changes, or pressures, of a batch, the part of this rank; they begin at `first` in the dataset. */
static PetscErrorCode MoveNumbers(SamFile f, SamStepCache cache, const Batch *b, hid_t dataset, PetscBool pressures,
                                  PetscInt n, hsize_t first)
{
  const size_t size   = pressures ? sizeof(double) : sizeof(int32_t);
  const hid_t  type   = pressures ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT32;
  PetscInt     before = 0;
  char        *buffer;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Exscan(&n, &before, 1, MPIU_INT, MPI_SUM, f->grid->comm));
  PetscCall(SamAllocateZeros(size * (size_t)(n + 1), &buffer));
  if (f->writing) PassRows(f, cache, b, pressures, buffer);
  Move(f, dataset, type, &(SamBlock){1, {first + (hsize_t)before}, {(hsize_t)n}}, buffer);
  if (!f->writing) PassRows(f, cache, b, pressures, buffer);
  SamFree(buffer);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveBatch(SamFile f, SamStepCache cache, const Batch *b, Places *p)
{
  PetscInt n[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt k = b->first; k < b->end; k++) {
    const SamStepFields s = SamStepCacheGetFields(cache, k);

    if (s) n[0] += s->changes * s->cells;
    if (s && s->pressure) n[1] += s->cells;
  }
  PetscCall(MoveNumbers(f, cache, b, p->changes, PETSC_FALSE, n[0], p->changed));
  if (b->sizes.pressed) PetscCall(MoveNumbers(f, cache, b, p->pressures, PETSC_TRUE, n[1], p->pressed));
  p->changed += b->sizes.changed;
  p->pressed += b->sizes.pressed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveBatches(SamFile f, SamStepCache cache, Places *p)
{
  PetscInt rows, width;
  double  *table;
  Batch    b = {.end = 1};

  PetscFunctionBegin;
  SamStepCacheGetTable(cache, &rows, &width, &table);
  PetscCall(PetscMalloc1(rows, &b.at));
  while (b.end < rows) {
    NextBatch(cache, rows, &b);
    if (b.sizes.steps) PetscCall(MoveBatch(f, cache, &b, p));
  }
  PetscCall(PetscFree(b.at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes or reads the ranges of all steps; when read, they create the fields of the cache. */
static PetscErrorCode MoveRanges(SamFile f, SamStepCache cache, hid_t dataset, hsize_t steps)
{
  const PetscInt n     = 2 * f->grid->rows;
  const SamBlock block = {3, {0, (hsize_t)f->grid->row_start, 0}, {steps, (hsize_t)f->grid->rows, 2}};
  PetscInt       rows, width;
  double        *table;
  int32_t       *ranges, *range;
  PetscInt       changes;
  PetscBool      pressure;
  SamStepFields  fields;

  PetscFunctionBegin;
  SamStepCacheGetTable(cache, &rows, &width, &table);
  PetscCall(PetscCalloc1((size_t)steps * (size_t)n, &ranges));
  range = ranges;
  for (PetscInt k = 1; k < rows && f->writing; k++) {
    fields = SamStepCacheGetFields(cache, k);
    if (!fields) continue;
    PetscCall(PetscArraycpy(range, fields->range, n));
    range += n;
  }
  Move(f, dataset, H5T_NATIVE_INT32, &block, ranges);
  for (PetscInt k = 1; k < rows && !f->writing; k++) {
    if (!SamStepCacheCells(cache, k, &changes, &pressure)) continue;
    PetscCall(SamStepCacheAddFields(cache, k, range, &fields));
    range += n;
  }
  PetscCall(PetscFree(ranges));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- writing ---- */

PetscErrorCode SamKeptWrite(SamFile f, SamStepCache cache)
{
  const hsize_t ny    = (hsize_t)f->grid->ny;
  const Sizes   sizes = CountCells(cache);
  Places        p     = {-1, -1, -1, 0, 0};
  PetscInt      rows, width;
  double       *table;
  hid_t         dataset;

  PetscFunctionBegin;
  SamStepCacheGetTable(cache, &rows, &width, &table);
  if (!rows) PetscFunctionReturn(PETSC_SUCCESS);
  dataset = Create(f, "kept_table", H5T_IEEE_F64LE, 2, (hsize_t)rows, (hsize_t)width, 0);
  SamFileWriteBlock(f, dataset, H5T_NATIVE_DOUBLE,
                    &(SamBlock){2, {0, 0}, {f->rank ? 0 : (hsize_t)rows, (hsize_t)width}}, table);
  Close(f, dataset);
  if (!sizes.steps) PetscFunctionReturn(PETSC_SUCCESS);
  p.ranges  = Create(f, "kept_ranges", H5T_STD_I32LE, 3, sizes.steps, ny, 2);
  p.changes = Create(f, "kept_changes", H5T_STD_I32LE, 1, sizes.changed, 0, 0);
  if (sizes.pressed) p.pressures = Create(f, "kept_pressures", H5T_IEEE_F64LE, 1, sizes.pressed, 0, 0);
  PetscCall(MoveRanges(f, cache, p.ranges, sizes.steps));
  PetscCall(MoveBatches(f, cache, &p));
  ClosePlaces(f, &p);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading ---- */

/* Reads the table; the cache stays empty if its memory does not suffice. */
static PetscErrorCode ReadTable(SamFile f, SamStepCache cache)
{
  const hid_t dataset = Open(f, "kept_table");
  hsize_t     size[2];
  double     *table;

  PetscFunctionBegin;
  SamFileGetSize(f, dataset, 2, size);
  PetscCall(PetscCalloc1(size[0] * size[1] + 1, &table));
  SamFileReadBlock(f, dataset, H5T_NATIVE_DOUBLE, &(SamBlock){2, {0, 0}, {size[0], size[1]}}, table);
  Close(f, dataset);
  PetscCall(SamFileAgree(f));
  if (!f->failed) PetscCall(SamStepCacheSetTable(cache, (PetscInt)size[0], (PetscInt)size[1], table));
  PetscCall(PetscFree(table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamKeptRead(SamFile f, SamStepCache cache)
{
  Places p = {-1, -1, -1, 0, 0};
  Sizes  sizes;

  PetscFunctionBegin;
  if (SamFileNote(f, H5Lexists(f->id, "kept_table", H5P_DEFAULT)) <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReadTable(f, cache));
  sizes = CountCells(cache);
  if (!sizes.steps) PetscFunctionReturn(PETSC_SUCCESS);
  p.ranges  = Open(f, "kept_ranges");
  p.changes = Open(f, "kept_changes");
  if (sizes.pressed) p.pressures = Open(f, "kept_pressures");
  PetscCall(MoveRanges(f, cache, p.ranges, sizes.steps));
  PetscCall(SamFileAgree(f));
  if (!f->failed) PetscCall(MoveBatches(f, cache, &p));
  ClosePlaces(f, &p);
  PetscFunctionReturn(PETSC_SUCCESS);
}
