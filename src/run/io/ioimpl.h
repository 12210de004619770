/* Declarations shared by results and checkpoints: the tables of their contents, and the layout of a results file. */
#ifndef PETSAM_IOIMPL_H
#define PETSAM_IOIMPL_H

#include <petsam/private/file.h>
#include <petsam/private/parts.h>
#include <petsam/private/output.h>
#include <petsam/private/state.h>
#include <petsam/private/stepcache.h>
#include <inttypes.h>

/*
  The kept steps of a load cycle in a checkpoint (kept.c).
  SamKeptBytes - estimates their size in it. Not collective. SamKeptWrite, SamKeptRead - write them, and read them into
  an empty cache if the file has some and the cache's memory suffices. Both note their failures. Collective.
*/
PETSC_INTERN off_t          SamKeptBytes(SamStepCache cache);
PETSC_INTERN PetscErrorCode SamKeptWrite(SamFile file, SamStepCache cache);
PETSC_INTERN PetscErrorCode SamKeptRead(SamFile file, SamStepCache cache);

/* The series of a file: one row per load step, and one row per computed cycle of the settings' life */
typedef enum { SAM_SERIES_HISTORY, SAM_SERIES_CYCLES, SAM_SERIES } SamSeries;

/*
  The points of an edge: x and y (m) one after the other, on rank 0; the count on all ranks (edgepoints.c). The
  functions note their failures. Collective.
  SamOutputCreatePoints - creates their dataset, without a step.
  SamOutputCreatePointScales - creates the scales of all such datasets, which must exist, and attaches them.
  SamOutputGatherPoints - gathers the points of all ranks, in the order of their rows; the caller frees xy.
  SamOutputAppendPoints - writes the points of the next `count` steps.
*/
typedef struct {
  hsize_t count;
  double *xy;
} SamOutputPoints;
PETSC_INTERN hid_t          SamOutputCreatePoints(SamOutput output, const SamLabel *label);
PETSC_INTERN void           SamOutputCreatePointScales(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputGatherPoints(SamOutput output, const SamEdge *edge, SamOutputPoints *points);
PETSC_INTERN PetscErrorCode SamOutputAppendPoints(SamOutput output, hid_t dataset, hsize_t count,
                                                  const SamOutputPoints points[]);

/* The fields of steps that are not in the file yet (outputframes.c); NULL where nothing has waited. */
typedef struct {
  PetscInt         most, count; /* number of steps that may wait, 1: each is written at once; number that wait */
  double          *times;       /* of these steps, s */
  char            *values[SAM_STATE_MOST]; /* of a field of cells: this rank's values, step by step */
  SamOutputPoints *points[SAM_STATE_MOST];
} SamOutputFrames;
/*
  SamOutputCreateFrames, SamOutputDestroyFrames - prepare the frames, and free them. Neither is collective.
  SamOutputHoldFrame - adds the fields of the present step to those that wait. Collective.
  SamOutputAppendFrames - appends the fields that wait to the file; `present`: instead those of the present step at that
  time, as none waits. Notes its failures. Collective.
  SamOutputAppendNumbers - appends `count` numbers to a series, or square matrices of n rows; rank 0 writes them. Notes
  its failures. Collective.
*/
PETSC_INTERN PetscErrorCode SamOutputCreateFrames(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputDestroyFrames(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputHoldFrame(SamOutput output, PetscReal time);
PETSC_INTERN PetscErrorCode SamOutputAppendFrames(SamOutput output, PetscBool present, PetscReal time);
PETSC_INTERN void SamOutputAppendNumbers(SamOutput output, hid_t dataset, hid_t type, hsize_t index, hsize_t count,
                                         hsize_t n, const void *numbers);

/*
  Tables that are written at the end of a run, whose names are created with the file, see errortable.c. All note their
  failures. Collective.
  SamOutputCreateTables - creates the dataset /warnings and, if the settings want errors, the group /errors, without
  rows.
  SamOutputAppendErrors, SamOutputAppendWarnings - write their rows.
  SamOutputCreateGradients - creates the groups /gradient/NAME of the settings, without contents (gradienttable.c).
  SamOutputAppendGradient - writes what a gradient has found into its group.
*/
PETSC_INTERN void           SamOutputCreateTables(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputAppendErrors(SamOutput output, const SamErrorTable *table);
PETSC_INTERN PetscErrorCode SamOutputAppendWarnings(SamOutput output, PetscInt count,
                                                    const char rows[][SAM_WARNING_TEXT]);
PETSC_INTERN PetscErrorCode SamOutputCreateGradients(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputAppendGradient(SamOutput output, SamGradient gradient, const char name[],
                                                    PetscInt count, const SamGradientShare shares[]);

#define SAM_IDENTITY "results-%016" PRIx64 /* identity of a file, as text */

#define SAM_OUTPUT_POINTS 256 /* points of an edge per chunk */
#define SAM_OUTPUT_WAIT   256 /* maximum number of steps that wait to be written, a chunk of the series */

struct _n_SamOutput {
  SamGrid           grid;
  SamFile           f;
  SamOutputSettings set;
  /* owned objects; identifiers are negative if nothing is open */
  hid_t           vtk_steps; /* attribute: number of steps that VTK sees */
  hid_t           closed;    /* attribute: true if the file was closed properly */
  char           *name;      /* name that the file gets when it is published; NULL: it has it */
  uint64_t        identity;
  SamFileLock     hold;                  /* lock of a file that is written */
  PetscBool       replaced;              /* older results existed */
  SamState        state[SAM_SERIES];     /* states whose numbers are the columns of a series; borrowed; NULL: none */
  const char     *series[SAM_SERIES];    /* names of their groups */
  PetscInt        values[SAM_SERIES];    /* number of values in a row */
  PetscBool       wants[SAM_STATE_MOST]; /* true for the results of the state that are saved */
  hid_t           time, point, fields[SAM_STATE_MOST], columns[SAM_SERIES][SAM_STATE_DECLARED];
  Vec             work;   /* for computed fields; NULL until the first one */
  SamOutputFrames frames; /* fields that are not in the file yet */
  /* status */
  double   *waiting; /* numbers of steps that are not in the file yet, memory for SAM_OUTPUT_WAIT steps; NULL: none */
  PetscInt  waits;   /* number of these steps */
  double    flushed, called;  /* MPI_Wtime() when the file was last complete, and when a step was last added */
  hsize_t   rows[SAM_SERIES]; /* rows in the file: load steps in the history, computed cycles */
  hsize_t   saved;            /* number of steps with fields in the file */
  PetscReal saved_time;       /* time of the last step with fields, in the file or waiting */
  PetscBool broken;           /* a step could not be written: no collective call on the file may follow */
};

/*
  SamOutputCreateLayout - creates all datasets, without a step, and their attributes; the first coordinate becomes the
  mark of the file. Notes its failures. Collective.
*/
PETSC_INTERN PetscErrorCode SamOutputCreateLayout(SamOutput output);
/* SamOutputGrowth - returns how the file's datasets are expected to grow. Not collective. */
PETSC_INTERN SamFileGrowth SamOutputGrowth(SamOutput output);
/* SamOutputPlanes - returns the number of planes of cells that a field has per step. Not collective. */
PETSC_INTERN hsize_t SamOutputPlanes(SamOutput output, PetscInt field);
/* SamOutputFieldBytes - returns the size of the fields of one step, uncompressed. Not collective. */
PETSC_INTERN off_t SamOutputFieldBytes(SamOutput output);
/* SamOutputResult - returns field f of the state. Not collective. */
static inline const SamStateResult *SamOutputResult(SamOutput o, PetscInt f)
{
  return SamStateResultOf(o->state[SAM_SERIES_HISTORY], f);
}
/* SamOutputCount - returns the number of fields. Not collective. */
static inline PetscInt SamOutputCount(SamOutput o)
{
  return SamStateCountResults(o->state[SAM_SERIES_HISTORY]);
}
/* SamOutputLabel - returns the label of a field. Not collective. */
static inline SamLabel SamOutputLabel(SamOutput o, PetscInt f)
{
  const SamStateResult *r = SamOutputResult(o, f);

  return (SamLabel){r->name, r->unit, r->text};
}
/*
  SamOutputAllocate - creates the object for an open file, or NULL for a file that is yet to be opened; no dataset is
  open yet.
  SamOutputFree - frees the object, and leaves the file as it is. Neither is collective.
*/
PETSC_INTERN PetscErrorCode SamOutputAllocate(SamGrid grid, SamFile file, const SamOutputSettings *set,
                                              SamOutput *output);
PETSC_INTERN PetscErrorCode SamOutputFree(SamOutput *output);
/* SamOutputPublish - gives the file its final name, unless it has it. Collective. Errors: SAM_ERR_FILE. */
PETSC_INTERN PetscErrorCode SamOutputPublish(SamOutput output);
#endif
