/* What results and checkpoints share: an HDF5 file that all ranks use together, and the tables of what it holds. */
#ifndef PETSAM_IOIMPL_H
#define PETSAM_IOIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/chunks.h>
#include <petsam/output.h>
#include <sys/types.h>

/*
  SamFile - an HDF5 file that all ranks have open together, and its errors so far. Calls of HDF5 are made between
  SamFileBegin() and SamFileEnd(). A rank on which a call fails must still take part in the collective calls that
  follow. So failures are only noted (SamFileNote()), all ranks make all calls, and SamFileEnd() agrees on the outcome
  and raises SAM_ERR_FILE with the option's name.
*/
typedef struct _n_SamFile *SamFile;
struct _n_SamFile {
  /* what the user set */
  SamGrid     grid;
  SamEvent    event;
  const char *option; /* option (without dash) that named the file */
  char       *filename;
  PetscBool   writing;
  /* what it owns; identifiers are negative where nothing is open */
  PetscMPIInt rank;
  hid_t       id, transfer; /* the file; property list for collective transfer */
  /* status */
  off_t       reserved_begin, reserved_end; /* on rank 0: the part that was reserved last */
  PetscBool   failed;                       /* on this rank; on all after SamFileEnd() or SamFileAgree() */
  char        reason[256];                  /* of the first failure */
  H5E_auto2_t print;                        /* HDF5's own error output, to be restored by SamFileEnd() */
  void       *print_data;
};

#define SAM_FILE_METADATA (1 << 20) /* bytes, more than HDF5's metadata take at creation or in a step */

typedef enum {
  SAM_FILE_CREATE,
  SAM_FILE_CREATE_SEALED,
  SAM_FILE_READ,
  SAM_FILE_READ_ALONE,
  SAM_FILE_APPEND
} SamFileMode;
/*
  SamFileOpen - opens a file to READ or to APPEND, or CREATEs it, replacing one of that name; CREATE_SEALED: with room
  for a seal; READ_ALONE: without MPI-IO, by the one rank of the grid. `option` is not copied. Collective. Errors:
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileOpen(SamGrid grid, SamEvent event, const char option[], const char filename[],
                                        SamFileMode mode, SamFile *file);
/*
  SamFileExamine - reports, in plain words, a file that is not there or is none, may not be read (or written), or is not
  HDF5. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileExamine(MPI_Comm comm, const char option[], const char filename[],
                                           PetscBool writing);
/*
  SamFileClose - closes the file; to be called between Begin and End, notes its failures.
  SamFileDestroy - frees the object, and with `close` first closes the file; without it the file stays open, for where
  closing would hang. Errors: SAM_ERR_FILE.
  SamFileBegin, SamFileEnd - switch off HDF5's error output, and restore it and raise SAM_ERR_FILE for a noted failure.
  SamFileAgree - makes a failure of any rank known to all, without raising it.
  All are collective.
*/
PETSC_INTERN void           SamFileClose(SamFile file);
PETSC_INTERN PetscErrorCode SamFileDestroy(SamFile *file, PetscBool close);
PETSC_INTERN PetscErrorCode SamFileBegin(SamFile file);
PETSC_INTERN PetscErrorCode SamFileEnd(SamFile file);
PETSC_INTERN PetscErrorCode SamFileAgree(SamFile file);
/* SamFileNameBeside - a name with an ending added; the caller frees it with PetscFree(). Not collective. */
PETSC_INTERN PetscErrorCode SamFileNameBeside(const char filename[], const char ending[], char **name);
/* SamFileNote - returns `result`, that of an HDF5 call, and notes a failure with HDF5's reason. Not collective. */
PETSC_INTERN hid_t SamFileNote(SamFile file, hid_t result);

/* What a file is written for. Old results must be there; a temporary file becomes one of the others by its name. */
typedef enum {
  SAM_FILE_RESULTS,
  SAM_FILE_OLD_RESULTS,
  SAM_FILE_CHECKPOINT,
  SAM_FILE_XDMF,
  SAM_FILE_TEMPORARY
} SamFileUse;
/*
  SamFileCheckName - fails early if a file of that name cannot be written, is being written by another run, or is there
  and not what petsam writes for that use. Changes nothing on the disk. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileCheckName(SamGrid grid, const char option[], const char filename[], SamFileUse use);
/*
  SamFileReserve - allocates disk space for so many bytes and HDF5's metadata: the file becomes longer, and HDF5 cuts
  off the unused part when it flushes, unless all of it is unused. Collective. Errors: SAM_ERR_FILE.
  SamFileFindUnused - where what was reserved last begins, if HDF5 has not cut it off, else -1. On rank 0.
*/
PETSC_INTERN PetscErrorCode SamFileReserve(SamFile file, off_t bytes);
PETSC_INTERN off_t          SamFileFindUnused(SamFile file);
/*
  SamFileReplace - flushes the finished file `temporary` to the disk and renames it to `filename`. A file of that name
  is replaced, or first named `kept` if that is not NULL. At every moment there is a complete file of one of these
  names, if there was one. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileReplace(SamGrid grid, const char option[], const char temporary[],
                                           const char filename[], const char kept[]);
/* SamFileRemoveLeftOvers - what MPI-IO has put beside an open file, and would leave after a kill. */
PETSC_INTERN void SamFileRemoveLeftOvers(SamFile file);
/*
  SamFileRaise - raises SAM_ERR_FILE for rank 0's result of a function of disk.c; does nothing if that is 0.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamFileRaise(SamGrid grid, const char option[], const char filename[], int error);

/*
  SamHold - keeps a file that a run writes from other runs, and notices what other programs do to it. Held by rank 0;
  ends with the process. Other programs can read the file.
*/
typedef struct {
  int        file; /* descriptor, negative: not held */
  SamFileUse use;
  PetscBool  created; /* was not there before */
  off_t      before;  /* size when it was taken */
  off_t      size;    /* when it was noted */
  off_t      mark_at; /* where a number is that never changes, 0: none */
  double     mark;
} SamHold;
/*
  SamHoldTake - takes hold of a file, which is created if it is not there. Errors as SamFileCheckName().
  SamHoldTakeNext - of the next file of a name whose file has been renamed.
  SamHoldCheck - raises an error if the file has been removed, replaced, has not the size that was noted, or lacks the
  mark: cut while a step was written, it has its size again.
  SamHoldHadContent - whether there was something in the file before it was taken.
  These are collective. Errors: SAM_ERR_FILE.
  SamHoldNoteSize - notes the size.
  SamHoldRelease - gives up the file; removes it if it is temporary, or was created here and is still empty.
*/
PETSC_INTERN PetscErrorCode SamHoldTake(SamGrid grid, const char option[], const char filename[], SamFileUse use,
                                        SamHold *hold);
PETSC_INTERN PetscErrorCode SamHoldTakeNext(SamGrid grid, const char option[], const char filename[], SamHold *hold);
PETSC_INTERN PetscErrorCode SamHoldCheck(SamGrid grid, const char option[], const char filename[], const SamHold *hold);
PETSC_INTERN PetscErrorCode SamHoldHadContent(SamGrid grid, const SamHold *hold, PetscBool *had);
PETSC_INTERN void           SamHoldNoteSize(SamHold *hold);
PETSC_INTERN void           SamHoldRelease(const char filename[], SamHold *hold);

#define SAM_CHECKPOINT_FORMAT 6   /* version of a checkpoint's contents */
#define SAM_SEAL              512 /* bytes at the start of a checkpoint: HDF5's user block, which holds the seal */
/*
  SamSealWrite - seals a finished checkpoint: a checksum over all its bytes.
  SamSealCheck - compares it. Nothing of the file is interpreted before.
  Both are collective. Errors: SAM_ERR_FILE.
  SamSealIsOne - whether the first bytes of a file are a seal. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSealWrite(SamGrid grid, const char option[], const char filename[]);
PETSC_INTERN PetscErrorCode SamSealCheck(SamGrid grid, const char option[], const char filename[]);
PETSC_INTERN PetscBool      SamSealIsOne(const char head[], size_t size);

/*
  Attributes, and layers of datasets; all note their failures and are collective. `stored` is the type in the file,
  `type` that in memory. The caller frees a text that is read, with PetscFree().
*/
PETSC_INTERN void SamFileWriteAttribute(SamFile file, hid_t object, const char name[], hid_t stored, hid_t type,
                                        PetscInt count, const void *values);
PETSC_INTERN void SamFileWriteTextAttribute(SamFile file, hid_t object, const char name[], const char text[]);
PETSC_INTERN void SamFileReadAttribute(SamFile file, hid_t object, const char name[], hid_t type, PetscInt count,
                                       void *values);
PETSC_INTERN void SamFileReadTextAttribute(SamFile file, hid_t object, const char name[], char **text);
/* A dataset's name, and two of its attributes. */
typedef struct {
  const char *name, *units, *long_name;
} SamOutputLabel;

/* The shape of a dataset: size when created, largest size, and size of a chunk (0: not chunked). */
#define SAM_SHAPE_RANK 4 /* most dimensions */
typedef struct {
  int     rank;
  hsize_t size[SAM_SHAPE_RANK], largest[SAM_SHAPE_RANK], chunk[SAM_SHAPE_RANK];
} SamShape;
/*
  SamFileCreateDataset - creates a dataset with its attributes; every value must be written, for none is filled in.
  `compress`: deflate level, 0 for none. To be closed with H5Dclose().
  SamFileWriteSeries - writes all values of a dataset of one dimension, from rank 0.
*/
PETSC_INTERN hid_t SamFileCreateDataset(SamFile file, hid_t where, const SamOutputLabel *label, hid_t type,
                                        const SamShape *shape, PetscInt compress);
PETSC_INTERN void  SamFileWriteSeries(SamFile file, hid_t dataset, const double values[]);
/* One layer of a dataset of shape (layers, ny, nx): each rank writes or reads its rows. */
PETSC_INTERN void SamFileWriteLayer(SamFile file, hid_t dataset, hid_t type, hsize_t layer, const void *values);
PETSC_INTERN void SamFileReadLayer(SamFile file, hid_t dataset, hid_t type, hsize_t layer, void *values);

/*
  SamParametersWrite - writes all parameters as attributes of the root group.
  SamParametersDiffer - whether a fixed parameter has another value in the file, or is missing there; the message names
  it and both values.
  Both note their failures. Collective.
*/
PETSC_INTERN void      SamParametersWrite(SamFile file, const SamParameters *parameters);
PETSC_INTERN PetscBool SamParametersDiffer(SamFile file, const SamParameters *parameters, char message[], size_t size);

/*
  A field of the results: a component of a vector of the solution, or what `compute` writes into a vector of one
  component. The values are real numbers, or SamStates, stored as bytes; or an edge's points, of which `component` is
  the SamContactEdge.
*/
typedef enum { SAM_FIELD_REAL, SAM_FIELD_STATE, SAM_FIELD_POINTS } SamOutputFieldKind;
typedef struct {
  SamOutputLabel     label;
  SamOutputFieldKind kind;
  PetscErrorCode (*compute)(SamContact contact, SamWear wear, PetscInt component, Vec field); /* NULL: stored */
  size_t          offset; /* of the Vec in SamSolution */
  PetscInt        component;
  SamOutputOption option; /* without which there is no such field; SAM_OUTPUT_OPTIONS: none */
  PetscBool       usual;  /* saved unless other fields are asked for */
} SamOutputField;

/*
  SamOutputFindField - the vector that holds a field of a contact's solution and its wear, and the component there: one
  of the solution's (borrowed), or `work` (one component), into which it is computed. Collective.
*/
PETSC_INTERN PetscErrorCode SamOutputFindField(const SamOutputField *field, SamContact contact, SamWear wear, Vec work,
                                               Vec *holder, PetscInt *component);

/* A column of a series: a member of SamStep or SamLifeReport. A matrix has a row and a column for each component. */
typedef enum { SAM_COLUMN_REAL, SAM_COLUMN_INT, SAM_COLUMN_STATUS, SAM_COLUMN_MATRIX } SamOutputColumnKind;
typedef struct {
  SamOutputLabel      label;
  SamOutputColumnKind kind;
  size_t              offset; /* in SamStep or SamLifeReport */
  SamOutputOption     option; /* SAM_OUTPUT_OPTIONS: none, the column is always there */
} SamOutputColumn;

/* A group of columns with a row for each step, or computed cycle. The first column is the coordinate of the others. */
typedef struct {
  const char            *name;
  const SamOutputColumn *columns;
  PetscInt               count;
} SamOutputSeries;
typedef enum { SAM_SERIES_HISTORY, SAM_SERIES_WEAR, SAM_SERIES } SamOutputSeriesKind;

PETSC_INTERN const SamOutputField  SamOutputFields[];
PETSC_INTERN const PetscInt        SamOutputFieldCount;
PETSC_INTERN const SamOutputSeries SamOutputAllSeries[SAM_SERIES];
/* SamOutputWants - whether a file has what belongs to an option. Not collective. */
static inline PetscBool SamOutputWants(const SamOutputSettings *set, SamOutputOption option)
{
  return option == SAM_OUTPUT_OPTIONS || set->with[option];
}

/* SamOutputWantsField - whether a file has field f of the table. Not collective. */
static inline PetscBool SamOutputWantsField(const SamOutputSettings *set, PetscInt f)
{
  return set->fields[f] ? SamOutputWants(set, SamOutputFields[f].option) : PETSC_FALSE;
}

/*
  The points of an edge: x and y (m) one after the other, on rank 0; the count on all ranks (points.c). The functions
  note their failures. Collective.
  SamOutputCreatePoints - creates a dataset for them, without a step; to be closed with H5Dclose().
  SamOutputCreatePointScales - creates the scales of all such datasets, which are there already, and attaches them.
  SamOutputGatherPoints - takes those of all ranks into the output, in the order of their rows.
  SamOutputAppendPoints, SamOutputReadPoints - write those of a step, which is the next one; read them.
*/
typedef struct {
  hsize_t count;
  double *xy;
} SamOutputPoints;
PETSC_INTERN hid_t          SamOutputCreatePoints(SamOutput output, const SamOutputLabel *label);
PETSC_INTERN void           SamOutputCreatePointScales(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputGatherPoints(SamOutput output, const SamEdge *edge);
PETSC_INTERN void SamOutputAppendPoints(SamOutput output, hid_t dataset, hsize_t step, const SamOutputPoints *points);
/* SamOutputGetPointsExtent - the number of points that field f has room for, and of their coordinates. */
PETSC_INTERN void           SamOutputGetPointsExtent(SamOutput output, PetscInt f, hsize_t extent[2]);
PETSC_INTERN PetscErrorCode SamOutputReadPoints(SamOutput output, hid_t dataset, hsize_t step, SamOutputPoints *points);

#define SAM_OUTPUT_WAIT 256 /* most steps that wait to be written: those of a chunk of the series */

/* The XDMF file beside the results. */
typedef struct _n_SamXdmf *SamXdmf;

struct _n_SamOutput {
  SamFile           f;
  SamOutputSettings set;
  /* what it owns; identifiers are negative where nothing is open */
  hid_t           vtk_steps; /* attribute: number of steps that VTK sees */
  hid_t           closed;    /* attribute: whether the file was closed properly */
  SamHold         hold;      /* of a file that is written */
  PetscBool       replaced;  /* there were older results */
  SamXdmf         xdmf;      /* NULL: none */
  hid_t           time, point, fields[SAM_OUTPUT_MOST], columns[SAM_SERIES][SAM_OUTPUT_MOST];
  signed char    *states;  /* of this rank's cells */
  float          *singles; /* the same; NULL until fields in single precision are written */
  Vec             work;    /* for fields that are computed; NULL until the first one */
  SamOutputPoints points;  /* of the edge that is being written */
  /* status */
  SamStep  *waiting;          /* load steps that are not in the file yet, room for SAM_OUTPUT_WAIT; NULL until needed */
  PetscInt  waits;            /* number of these */
  double    flushed;          /* MPI_Wtime() when the file was complete last */
  hsize_t   rows[SAM_SERIES]; /* in the file: load steps in the history, computed cycles */
  hsize_t   saved;            /* steps with fields */
  PetscReal saved_time;       /* of the last step with fields */
  PetscBool unchanged;        /* the file has only been examined, so `closed` stays as it is */
  PetscBool copying;          /* many steps at once: disk space is reserved, and the file flushed, by the caller */
  PetscBool broken;           /* a step could not be written: no collective call on the file may follow */
};

/* The functions of the layout note their failures. Collective. */
/*
  SamOutputCreateLayout - creates all datasets, without a step, and their attributes.
  SamOutputOpenLayout - opens them in a file that has them.
  SamOutputCloseLayout - closes them.
*/
PETSC_INTERN PetscErrorCode SamOutputCreateLayout(SamOutput output);
PETSC_INTERN void           SamOutputOpenLayout(SamOutput output);
/* SamOutputMark - notes the first coordinate as the mark of the file. Collective; notes its failures. */
PETSC_INTERN void SamOutputMark(SamOutput output);
PETSC_INTERN void SamOutputCloseLayout(SamOutput output);
/* SamOutputFieldBytes - the size of the fields of one step, uncompressed. Not collective. */
PETSC_INTERN off_t SamOutputFieldBytes(SamGrid grid, const SamOutputSettings *set);
/*
  SamOutputCreateVTK, SamOutputOpenVTK - create or open the group VTKHDF of the file.
  SamOutputCountVTK - sets the number of steps that VTK sees.
*/
PETSC_INTERN void SamOutputCreateVTK(SamOutput output);
PETSC_INTERN void SamOutputOpenVTK(SamOutput output);
PETSC_INTERN void SamOutputCountVTK(SamOutput output, hsize_t saved);

/*
  SamOutputFindMissing - the name of a field of the file that the contact of the settings cannot give, NULL for none: a
  sum over the steps that it does not keep. Not collective.
*/
PETSC_INTERN PetscErrorCode SamOutputFindMissing(SamOutput output, const char **name);

/*
  SamStructureSeal - seals a results file that has been closed: notes a checksum of its structure at its end.
  SamStructureIsSealed - whether it has a seal that is right. Both use the serial driver, on one rank. Not collective.
*/
PETSC_INTERN void      SamStructureSeal(const char filename[]);
PETSC_INTERN PetscBool SamStructureIsSealed(const char filename[]);

/*
  SamOutputLength - the number of steps in a dataset.
  SamOutputReadSeries - reads `count` numbers, or matrices, of a series from index `first` on, on all ranks.
*/
PETSC_INTERN hsize_t SamOutputLength(SamOutput output, hid_t dataset);
PETSC_INTERN void    SamOutputReadSeries(SamOutput output, hid_t dataset, hid_t type, hsize_t first, hsize_t count,
                                         void *values);
/*
  SamOutputCopyOrigin - copies the command line of the first run, and what the file says of the results that it follows.
  Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamOutputCopyOrigin(SamOutput from, SamOutput to);
/* SamOutputAllocate - an object that takes over an open file; no dataset is open yet. Collective. */
PETSC_INTERN PetscErrorCode SamOutputAllocate(SamFile file, const SamOutputSettings *set, SamOutput *output);
/*
  SamOutputCreateAs - SamOutputCreate() for that use of the file: results, or a temporary file. Collective.
  Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamOutputCreateAs(SamGrid grid, const char filename[], SamFileUse use,
                                              const SamOutputSettings *set, SamOutput *output);
/*
  SamOutputAppend - appends the numbers of a step (NULL: none) and its fields (`values` NULL: none). Without fields the
  numbers may wait (SamOutputFlush()); otherwise the file is flushed unless `copying`. `values` returns this rank's
  values of field f, doubles or bytes; it is called with `context`. Collective. Errors: SAM_ERR_FILE.
*/
typedef PetscErrorCode (*SamOutputValues)(SamOutput output, PetscInt f, void *context, const void **values);
PETSC_INTERN PetscErrorCode SamOutputAppend(SamOutput output, const SamStep *step, PetscReal time,
                                            SamOutputValues values, void *context);
/* SamOutputAppendCycle - appends a computed cycle to /wear, and flushes the file unless `copying`. Collective. */
PETSC_INTERN PetscErrorCode SamOutputAppendCycle(SamOutput output, const SamLifeReport *cycle);

/*
  SamXdmfCreate - creates an XDMF file without a step for results of that name; replaces one that petsam has written.
  SamXdmfAddStep - appends the step of that index in the results. After an error the file still has the earlier steps.
  Both are collective. Errors: SAM_ERR_FILE.
*/
extern const char           SamXdmfHead[]; /* the first bytes of the file */
PETSC_INTERN PetscErrorCode SamXdmfCreate(SamGrid grid, const char results[], const SamOutputSettings *set,
                                          SamXdmf *xdmf);
PETSC_INTERN PetscErrorCode SamXdmfAddStep(SamXdmf xdmf, PetscInt step, PetscReal time);
/* SamXdmfEscape - a copy of a text in which XML's own characters are escaped; the caller frees it. Not collective. */
PETSC_INTERN PetscErrorCode SamXdmfEscape(const char text[], char **copy);
/* SamXdmfMakeName - results.h5 -> results.xdmf; the caller frees it. Not collective. */
PETSC_INTERN PetscErrorCode SamXdmfMakeName(const char results[], char **name);
PETSC_INTERN const char    *SamXdmfGetName(SamXdmf xdmf);
PETSC_INTERN PetscErrorCode SamXdmfDestroy(SamXdmf *xdmf);

/*
  SamFileWriteState, SamFileReadState - the numbers of a state as attributes of the root group (statenumbers.c). Errors
  are noted in the file. Not collective.
*/
PETSC_INTERN void SamFileWriteState(SamFile file, const SamContactState *state);
PETSC_INTERN void SamFileReadState(SamFile file, SamContactState *state);

#endif
