/*
  The fields of steps in a results file: each dataset has a frame for each step.

  Frames of few bytes wait in memory, so that each dataset grows by many of them at once: a write takes about as long
  for one as for many. Larger frames are written field by field, without a copy.
*/
#include "ioimpl.h"
#include <petsam/private/contact.h>
#include <string.h>

#define WAITING_BYTES 8e6 /* most bytes of all frames that wait */

PetscErrorCode SamOutputCreateFrames(SamOutput o)
{
  const double     most = WAITING_BYTES / PetscMax((double)SamOutputFieldBytes(o), 1.0);
  SamOutputFrames *w    = &o->frames;

  PetscFunctionBegin;
  w->most = o->set.flush_fields > 0 ? (PetscInt)PetscClipInterval(most, 1.0, (double)SAM_OUTPUT_WAIT) : 1;
  PetscCall(PetscMalloc1(w->most, &w->times));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forgets the frames that wait. */
static PetscErrorCode Forget(SamOutput o)
{
  SamOutputFrames *w = &o->frames;

  PetscFunctionBegin;
  for (PetscInt f = 0; f < SAM_STATE_MOST; f++)
    for (PetscInt k = 0; w->points[f] && k < w->most; k++) PetscCall(PetscFree(w->points[f][k].xy));
  w->count = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputDestroyFrames(SamOutput o)
{
  SamOutputFrames *w = &o->frames;

  PetscFunctionBegin;
  PetscCall(Forget(o));
  for (PetscInt f = 0; f < SAM_STATE_MOST; f++) {
    PetscCall(PetscFree(w->values[f]));
    PetscCall(PetscFree(w->points[f]));
  }
  PetscCall(PetscFree(w->times));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the values of a step ---- */

/* A field's values of a step, as they are written: this rank's cells of all its planes, or the points of an edge. */
typedef struct {
  const void     *values;
  SamOutputPoints points;
  /* what holds them */
  Vec           field; /* field with the array; NULL: none */
  const double *array;
  Vec           below; /* values of layers; NULL: none */
  void         *other; /* values of another type */
} Frame;

/* Returns the type of a field's values in memory, and its size. */
static hid_t TypeOf(SamOutput o, PetscInt f, size_t *size)
{
  if (SamOutputResult(o, f)->kind == SAM_FIELD_STATE) {
    *size = sizeof(signed char);
    return H5T_NATIVE_SCHAR;
  }
  *size = o->set.single ? sizeof(float) : sizeof(double);
  return o->set.single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
}

/*
  Converts the values to the type in which they are written: in HDF5's conversion each rank would write by itself, which
  compression does not allow.
*/
static PetscErrorCode Convert(SamOutput o, PetscInt f, PetscInt count, const double from[], Frame *frame)
{
  size_t size;

  PetscFunctionBegin;
  (void)TypeOf(o, f, &size);
  frame->values = from;
  if (size == sizeof(double)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc(size * (size_t)count, &frame->other));
  frame->values = frame->other;
  for (PetscInt k = 0; k < count; k++)
    if (size == sizeof(float))
      ((float *)frame->other)[k] = (float)from[k];
    else
      ((signed char *)frame->other)[k] = (signed char)from[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetPoints(SamOutput o, PetscInt f, Frame *frame)
{
  const SamEdge *edge;

  PetscFunctionBegin;
  PetscCall(SamContactFindEdge(o->set.contact, (SamEdgeOf)SamOutputResult(o, f)->component, &edge));
  PetscCall(SamOutputGatherPoints(o, edge, &frame->points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetLayers(SamOutput o, PetscInt f, Frame *frame)
{
  const SamStateResult *field  = SamOutputResult(o, f);
  const PetscInt        planes = (PetscInt)SamOutputPlanes(o, f);

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(o->grid, planes, &frame->below));
  PetscCall((*field->compute)(field->owner, o->state[SAM_SERIES_HISTORY], field->component, frame->below));
  frame->field = frame->below;
  PetscCall(VecGetArrayRead(frame->field, &frame->array));
  PetscCall(Convert(o, f, planes * o->grid->cells, frame->array, frame));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Get(SamOutput o, PetscInt f, Frame *frame)
{
  const SamStateResult *field = SamOutputResult(o, f);
  const SamSolution    *solution;
  PetscInt              component;

  PetscFunctionBegin;
  *frame = (Frame){.values = NULL};
  if (field->kind == SAM_FIELD_POINTS || field->kind == SAM_FIELD_LAYERS) {
    PetscCall((field->kind == SAM_FIELD_POINTS ? GetPoints : GetLayers)(o, f, frame));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactGetSolution(o->set.contact, &solution)); /* computes the displacements */
  if (!o->work) PetscCall(SamGridCreateVec(o->grid, 1, &o->work));
  PetscCall(SamStateFindValues(o->state[SAM_SERIES_HISTORY], f, o->work, &frame->field, &component));
  PetscCall(VecGetArrayRead(frame->field, &frame->array));
  PetscCall(Convert(o, f, o->grid->cells, frame->array + component * o->grid->cells, frame));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Restore(Frame *frame)
{
  PetscFunctionBegin;
  if (frame->field) PetscCall(VecRestoreArrayRead(frame->field, &frame->array));
  PetscCall(VecDestroy(&frame->below));
  PetscCall(PetscFree(frame->other));
  PetscCall(PetscFree(frame->points.xy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- holding and writing ---- */

PetscErrorCode SamOutputHoldFrame(SamOutput o, PetscReal time)
{
  SamOutputFrames *w = &o->frames;

  PetscFunctionBegin;
  for (PetscInt f = 0; f < SamOutputCount(o); f++) {
    Frame  frame;
    size_t size;

    if (o->fields[f] < 0) continue;
    PetscCall(Get(o, f, &frame));
    if (SamOutputResult(o, f)->kind == SAM_FIELD_POINTS) {
      if (!w->points[f]) PetscCall(PetscCalloc1(w->most, &w->points[f]));
      PetscCall(PetscFree(w->points[f][w->count].xy)); /* of a frame that could not be written */
      w->points[f][w->count] = frame.points;
      frame.points.xy        = NULL;
    } else {
      (void)TypeOf(o, f, &size);
      size *= (size_t)SamOutputPlanes(o, f) * (size_t)o->grid->cells;
      if (!w->values[f]) PetscCall(PetscMalloc(size * (size_t)w->most, &w->values[f]));
      memcpy(w->values[f] + size * (size_t)w->count, frame.values, size);
    }
    PetscCall(Restore(&frame));
  }
  w->times[w->count++] = (double)time;
  o->saved_time        = time;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends so many frames to a dataset of cells. */
static void AppendCells(SamOutput o, PetscInt f, hsize_t count, const void *values)
{
  const SamGrid   g      = o->grid;
  const hsize_t   planes = SamOutputPlanes(o, f), rows = (hsize_t)g->rows, first = (hsize_t)g->row_start;
  const PetscBool layers = SamOutputResult(o, f)->kind == SAM_FIELD_LAYERS ? PETSC_TRUE : PETSC_FALSE;
  const hsize_t   all = o->saved + count, nx = (hsize_t)g->nx, ny = (hsize_t)g->ny;
  const SamBlock  flat     = {3, {o->saved, first, 0}, {count, rows, nx}},
                 deep      = {4, {o->saved, 0, first, 0}, {count, planes, rows, nx}};
  const hsize_t size[2][4] = {{all, ny, nx}, {all, planes, ny, nx}};
  size_t        bytes;
  const hid_t   type = TypeOf(o, f, &bytes);

  (void)SamFileNote(o->f, H5Dset_extent(o->fields[f], size[layers ? 1 : 0]));
  if (count == 1 && !layers)
    SamFileWriteNotZero(o->f, o->fields[f], type, bytes, &flat, values);
  else
    SamFileWriteBlock(o->f, o->fields[f], type, layers ? &deep : &flat, values);
}

/* Appends the frames that wait; `present`: instead those of the present step. */
static PetscErrorCode AppendFields(SamOutput o, PetscBool present, hsize_t count)
{
  PetscFunctionBegin;
  for (PetscInt f = 0; f < SamOutputCount(o); f++) {
    Frame frame = {.values = o->frames.values[f]};

    if (o->fields[f] < 0) continue;
    if (present) PetscCall(Get(o, f, &frame));
    if (SamOutputResult(o, f)->kind == SAM_FIELD_POINTS)
      PetscCall(SamOutputAppendPoints(o, o->fields[f], count, present ? &frame.points : o->frames.points[f]));
    else
      AppendCells(o, f, count, frame.values);
    PetscCall(Restore(&frame));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputAppendFrames(SamOutput o, PetscBool present, PetscReal time)
{
  const hsize_t count = present ? 1 : (hsize_t)o->frames.count;

  PetscFunctionBegin;
  if (!count) PetscFunctionReturn(PETSC_SUCCESS);
  if (present) o->frames.times[0] = (double)time;
  SamOutputAppendNumbers(o, o->time, H5T_NATIVE_DOUBLE, o->saved, count, 1, o->frames.times);
  PetscCall(AppendFields(o, present, count));
  SamFileCountVTK(o->f, o->vtk_steps, (int64_t)(o->saved + count));
  if (present) o->saved_time = time;
  o->saved += count;
  PetscCall(Forget(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}
