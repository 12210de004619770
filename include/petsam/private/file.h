/* HDF5 files that all ranks use together: opening, examining, datasets; names, locks and space on the disk. */
#ifndef PETSAM_FILE_H
#define PETSAM_FILE_H

#include <petsam/private/baseimpl.h>
#include <petsam/parameters.h>
#include <petsam/private/state.h>
#include <hdf5.h>
#include <sys/types.h>

/*
  SamFile - an HDF5 file that all ranks have open together, and its errors so far. Calls of HDF5 are made between
  SamFileBegin() and SamFileEnd(). A rank on which a call fails must still take part in the collective calls that
  follow. So failures are only noted (SamFileNote()), all ranks make all calls, and SamFileEnd() agrees on the outcome
  and raises SAM_ERR_FILE with the option's name. Closing the file closes all that is open in it.
*/
typedef struct _n_SamFile *SamFile;
struct _n_SamFile {
  /* what the user set */
  MPI_Comm    comm;
  SamGrid     grid; /* NULL for a file that is examined */
  SamEvent    event;
  const char *option; /* option (without dash) that named the file */
  char       *filename;
  PetscBool   writing;
  /* owned objects; identifiers are negative if nothing is open */
  PetscMPIInt rank;
  hid_t       id, transfer; /* the file; property list for collective transfer */
  /* status */
  off_t       reserved_begin; /* on rank 0: the file ended here before space was last reserved; its space begins here */
  off_t       reserved_end;   /* the end of that space */
  PetscBool   failed;         /* on this rank; on all ranks after SamFileEnd() or SamFileAgree() */
  char        reason[256];    /* reason of the first failure */
  H5E_auto2_t print;          /* HDF5's own error output, to be restored by SamFileEnd() */
  void       *print_data;
};

/* The datasets of a file that grow, those with three dimensions and with one, and the most chunks that one of them is
   expected to have */
typedef struct {
  PetscInt fields, series;
  double   chunks;
} SamFileGrowth;
typedef enum { SAM_FILE_CREATE, SAM_FILE_CREATE_SEALED, SAM_FILE_READ } SamFileMode;
/*
  SamFileOpen - opens a file to READ, or CREATEs it, replacing one of that name; CREATE_SEALED: with room for a seal.
  `option` is not copied. `grid` NULL: on this rank alone, without MPI-IO. `growth` of a file that is created (NULL: its
  datasets do not grow): HDF5's indices have room for so many chunks from the beginning, up to a limit, since a run on
  several ranks that is killed while HDF5 divides a full index may leave a file whose earlier steps cannot be read.
  Collective. Errors: SAM_ERR_FILE.
  SamFileIndexBytes - returns the bytes that the indices add to HDF5's usual ones. Not collective.
*/
PETSC_INTERN double         SamFileIndexBytes(const SamFileGrowth *growth);
PETSC_INTERN PetscErrorCode SamFileOpen(SamGrid grid, SamEvent event, const char option[], const char filename[],
                                        SamFileMode mode, const SamFileGrowth *growth, SamFile *file);
/*
  SamFileExamine - rank 0 examines an HDF5 file before all ranks open it. It rejects a file that is missing, may not be
  read or is not HDF5, and, by running petsam-examine, a file on which HDF5 crashes or does not end. Then it calls
  `look` with the file open on this rank alone. `objects`, ended by NULL: at most SAM_FILE_OBJECTS names of the objects
  that will be read, as a file of another program may contain many more; NULL: all. The `answer` (`size` bytes without
  pointers) is returned on all ranks, and an error that `look` has raised or noted is raised on all. Collective. Errors:
  SAM_ERR_FILE, and those of `look`.
*/
#define SAM_FILE_OBJECTS 3
typedef PetscErrorCode (*SamFileLook)(SamFile file, const void *question, void *answer);
PETSC_INTERN PetscErrorCode SamFileExamine(MPI_Comm comm, const char option[], const char filename[],
                                           const char *const objects[], SamFileLook look, const void *question,
                                           void *answer, size_t size);
/*
  SamFileDestroy - frees the object, and with `close` first closes the file; without `close` the file stays open, for
  cases in which closing would hang. Errors: SAM_ERR_FILE.
  SamFileClose - closes the file; to be called between Begin and End, notes its failures.
  SamFileBegin, SamFileEnd - switch off HDF5's error output, and restore it and raise SAM_ERR_FILE for a noted failure.
  SamFileAgree - makes a failure of any rank known to all, without raising it.
  All are collective.
*/
PETSC_INTERN void           SamFileClose(SamFile file);
PETSC_INTERN PetscErrorCode SamFileDestroy(SamFile *file, PetscBool close);
PETSC_INTERN PetscErrorCode SamFileBegin(SamFile file);
PETSC_INTERN PetscErrorCode SamFileEnd(SamFile file);
PETSC_INTERN PetscErrorCode SamFileAgree(SamFile file);
/* SamFileNote - returns `result`, that of an HDF5 call, and notes a failure with HDF5's reason. Not collective. */
PETSC_INTERN hid_t SamFileNote(SamFile file, hid_t result);

/* ---- attributes and datasets (dataset.c); all note their failures and are collective ---- */

/*
  `stored` is the type in the file, `type` that in memory. The caller frees a text that is read, with PetscFree().
  SamFileHasAttribute - returns true if the root group has an attribute.
*/
PETSC_INTERN void      SamFileWriteAttribute(SamFile file, hid_t object, const char name[], hid_t stored, hid_t type,
                                             PetscInt count, const void *values);
PETSC_INTERN void      SamFileWriteTextAttribute(SamFile file, hid_t object, const char name[], const char text[]);
PETSC_INTERN void      SamFileReadAttribute(SamFile file, hid_t object, const char name[], hid_t type, PetscInt count,
                                            void *values);
PETSC_INTERN void      SamFileReadTextAttribute(SamFile file, hid_t object, const char name[], char **text);
PETSC_INTERN PetscBool SamFileHasAttribute(SamFile file, const char name[]);
/* SamFileWriteOrigin - writes the attributes that describe the kind of the file and the program that wrote it. */
PETSC_INTERN void SamFileWriteOrigin(SamFile file, const char title[], const char program[]);

/* A dataset's name, and two of its attributes (NULL: none) */
typedef struct {
  const char *name, *units, *long_name;
} SamLabel;

/* The shape of a dataset: size when created, largest size, and size of a chunk (0: not chunked) */
#define SAM_SHAPE_RANK 6 /* most dimensions */
typedef struct {
  int           rank;
  hsize_t       size[SAM_SHAPE_RANK], largest[SAM_SHAPE_RANK], chunk[SAM_SHAPE_RANK];
  const double *fill; /* value of places that are not written; NULL: all places must be written */
} SamShape;
/*
  SamFileCreateDataset - creates a dataset with its attributes. `compress`: deflate level, 0 for none.
  SamFileCreateScale - creates a coordinate: a dataset of real numbers that others are attached to. `axis` and
  `standard_name` are CF attributes, NULL for none; `values` (on rank 0) are written unless NULL.
  SamFileAttachScales - attaches scales to the dimensions of a dataset, in their order.
*/
PETSC_INTERN hid_t SamFileCreateDataset(SamFile file, hid_t where, const SamLabel *label, hid_t type,
                                        const SamShape *shape, PetscInt compress);
PETSC_INTERN hid_t SamFileCreateScale(SamFile file, hid_t where, const SamLabel *label, const char axis[],
                                      const char standard_name[], const SamShape *shape, const double values[]);
PETSC_INTERN void  SamFileAttachScales(SamFile file, hid_t dataset, int count, const hid_t scales[]);
/* SamFileGetSize - gets the size of a dataset with that number of dimensions; all are zero after a failure. */
PETSC_INTERN void SamFileGetSize(SamFile file, hid_t dataset, int rank, hsize_t size[]);

/* The part of a dataset that a rank writes or reads; it is empty if a count is 0 */
typedef struct {
  int     rank;
  hsize_t start[SAM_SHAPE_RANK], count[SAM_SHAPE_RANK];
} SamBlock;
/*
  SamFileWriteBlock, SamFileReadBlock - write or read this rank's block of a dataset.
  SamFileWriteNotZero - writes this rank's block of a new frame, (1, rows, columns), without its first and last rows if
  these are zero in all bytes: the frame was never written, and its space has zeros. Whether that is so is not looked up
  in the file, as HDF5's metadata must be used by all ranks alike. `bytes`: the size of a value in memory.
*/
PETSC_INTERN void SamFileWriteNotZero(SamFile file, hid_t dataset, hid_t type, size_t bytes, const SamBlock *block,
                                      const void *values);
PETSC_INTERN void SamFileWriteBlock(SamFile file, hid_t dataset, hid_t type, const SamBlock *block, const void *values);
PETSC_INTERN void SamFileReadBlock(SamFile file, hid_t dataset, hid_t type, const SamBlock *block, void *values);
/* One frame of a dataset of shape (frames, ny, nx): each rank writes or reads its rows of the file's grid */
PETSC_INTERN void SamFileWriteFrame(SamFile file, hid_t dataset, hid_t type, hsize_t frame, const void *values);
PETSC_INTERN void SamFileReadFrame(SamFile file, hid_t dataset, hid_t type, hsize_t frame, void *values);
/*
  SamFileIsWhole - returns true if the data of a dataset lie within the file; in a damaged file they may not. `extent`:
  the places in each dimension that matter, NULL: all. `every`: all of them must have been written. It is called on one
  rank, for a file that is examined.
*/
PETSC_INTERN PetscBool SamFileIsWhole(SamFile file, hid_t dataset, const hsize_t extent[], PetscBool every);
/*
  SamTextRead - reads an attribute that is a single text, of fixed or variable length, without the blanks that pad it; a
  longer text is truncated. For any other attribute the result is "not a text". Returns true if the attribute exists.
  Not collective.
*/
PETSC_INTERN PetscBool SamTextRead(hid_t object, const char name[], char text[], size_t size);

/*
  SamAttributeClass - returns the class of an attribute's values, H5T_NO_CLASS if there is none, and gets their number.
  Not collective.
*/
PETSC_INTERN H5T_class_t SamAttributeClass(hid_t object, const char name[], hssize_t *count);

/* ---- expectations (expect.c); on one rank, for a file that is examined ---- */

/*
  SamFileCheck - raises SAM_ERR_FILE unless a condition holds; the text, a format with its values, describes the fault.
  Collective on the communicator of the file.
*/
#define SamFileCheck(file, holds, ...) \
  do { \
    if (PetscUnlikely(!(holds))) PetscCall(SamFileRefuse(file, __VA_ARGS__)); \
  } while (0)
PETSC_INTERN PetscErrorCode SamFileRefuse(SamFile file, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

/* The kind of a file in messages, and the program that writes it */
typedef struct {
  const char *name, *writer;
} SamFileKind;

/*
  SamExpected - an attribute of the root group, or a dataset, that a reader expects: its name; its number of dimensions,
  or that it is an attribute with numbers, or with a text; its size in each dimension, for an attribute the number of
  its numbers, for a text of its bytes in memory; where its numbers (double) or its text go, NULL for a dataset that is
  examined only. SamFileExpect() replaces the sizes of a dataset by those found.
*/
typedef struct {
  const char *name;
  int         rank;
  hsize_t     size[SAM_SHAPE_RANK]; /* SAM_ANY: from 1 to `longest` */
  void       *values;
  SamRange    range; /* of the numbers; whole ones are positive, or from 0 */
  double      most;  /* not 0: they are whole numbers, the largest of this value */
  hsize_t     longest;
  int         free;     /* any numbers, also NaN */
  int         grows;    /* the first dimension may be longer; then only its first places must have been written */
  int         optional; /* it may be missing; a text always may */
  PetscBool   found;    /* result */
} SamExpected;
#define SAM_ATTRIBUTE   (-1)
#define SAM_TEXT        (-2) /* becomes empty if it is missing or too long */
#define SAM_ANY         ((hsize_t)-1)
#define SAM_EXPECT_NAME 128 /* characters of a dataset's name */
/*
  SamFileExpect - examines the rows, and reads them; `group` precedes the names of datasets. Errors: SAM_ERR_FILE for
  one that is missing, is of another kind or shape, is not in the file as a whole, or has numbers out of range.
*/
PETSC_INTERN PetscErrorCode SamFileExpect(SamFile file, const SamFileKind *kind, const char group[], PetscInt count,
                                          SamExpected rows[]);

/* ---- parameters and images (attributes.c, vtkhdf.c) ---- */

/*
  SamParametersWrite - writes all parameters as attributes of the root group.
  SamParametersDiffer - returns true if a fixed parameter has another value in the file, or is missing there; the
  message names it and both values.
  Both note their failures. Collective.
*/
PETSC_INTERN void      SamParametersWrite(SamFile file, const SamParameters *parameters);
PETSC_INTERN PetscBool SamParametersDiffer(SamFile file, const SamParameters *parameters, char message[], size_t size);
/* The datasets `names` of the root group as an image for VTK, with values at cells or at points */
typedef struct {
  PetscBool cells;
  hsize_t   n[3];                  /* cells or points along x, y, z */
  double    origin[3], spacing[3]; /* corner of the first cell, or first point; distances between points; m */
  int64_t   steps; /* number of steps in the datasets, whose first dimension is the time; -1: without this dimension */
  double    time;  /* s, time of a single step */
  PetscInt  count;
  const char *names[SAM_STATE_MOST];
} SamImage;
/*
  SamFileCreateVTK - creates the group VTKHDF of the file; returns its attribute with the number of steps, -1 without
  one.
  SamFileCountVTK - sets that number for a sheet of cells that was created without a step.
  Both note their failures, and are collective.
*/
PETSC_INTERN hid_t SamFileCreateVTK(SamFile file, const SamImage *image);
PETSC_INTERN void  SamFileCountVTK(SamFile file, hid_t number, int64_t steps);

/* ---- the disk (disk.c) ---- */

/* SamFileCheckFolder - returns 0 if a folder allows this access (W_OK ...), else errno. Not collective. */
PETSC_INTERN int SamFileCheckFolder(const char folder[], int mode);
/* The purposes of a file. Old results must exist; a temporary file is renamed to one of the other kinds */
typedef enum { SAM_FILE_RESULTS, SAM_FILE_OLD_RESULTS, SAM_FILE_CHECKPOINT, SAM_FILE_TEMPORARY } SamFileUse;
/*
  SamFileCheckName - fails early if a file of that name cannot be written, is being written by another run, or exists
  and is not a file that petsam writes for this purpose. It changes nothing on the disk. Collective. Errors:
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileCheckName(SamGrid grid, const char option[], const char filename[], SamFileUse use);
/*
  SamFileGetBytes - gets the size of the file of that name, from rank 0; negative: there is none. SamFileContains -
  finds out if a text is among the attributes at the start of a results file, without interpreting the file. Collective.
*/
PETSC_INTERN PetscErrorCode SamFileGetBytes(MPI_Comm comm, const char filename[], double *bytes);
PETSC_INTERN PetscErrorCode SamFileContains(SamGrid grid, const char filename[], const char text[],
                                            PetscBool *contains);
/*
  SamFileNameBeside - creates a name with an ending added; for a symbolic link, from the name of the file behind it. The
  caller frees it with PetscFree(). Not collective.
*/
PETSC_INTERN PetscErrorCode SamFileNameBeside(const char filename[], const char ending[], char **name);
/*
  SamFileReserve - allocates disk space for so many bytes and HDF5's metadata: the file becomes longer, and HDF5 cuts
  off the unused part when it flushes, unless all of it is unused. Collective. Errors: SAM_ERR_FILE.
  SamFileFindUnused - finds, on rank 0, the beginning of the last reserved space, if HDF5 has not removed it; else -1.
  SamFileGetSpace - gets the free space (bytes) for a file that exists or will be created; infinite if unknown.
  Collective. Errors: SAM_ERR_FILE if the file cannot be written.
*/
PETSC_INTERN PetscErrorCode SamFileReserve(SamFile file, off_t bytes);
PETSC_INTERN off_t          SamFileFindUnused(SamFile file);
PETSC_INTERN PetscErrorCode SamFileGetSpace(SamGrid grid, const char option[], const char filename[], double *bytes);
/*
  SamFilePlaceOfEnd - returns the place of the end of data, 8 bytes, little endian, in the superblock whose first bytes
  these are. Versions 0 and 1 have it at byte 40 or 44, and no checksum (HDF5 file format specification, II.A); 0: other
  versions, which are left to HDF5. Not collective.
*/
#define SAM_FILE_SUPERBLOCK 52 /* bytes up to the end of data */
PETSC_INTERN off_t SamFilePlaceOfEnd(const unsigned char start[SAM_FILE_SUPERBLOCK]);
/*
  SamFileReplace - flushes the complete file `temporary` to the disk and renames it to `filename`. A file of that name
  is replaced, or first named `kept` if that is not NULL. If there was a complete file of one of these names before,
  there is one at every moment. A symbolic link stays, and the file behind it is replaced. Collective. Errors:
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamFileReplace(SamGrid grid, const char option[], const char temporary[],
                                           const char filename[], const char kept[]);
/*
  SamFileLock - a lock that prevents other runs from writing a file, and notices changes by other programs. Rank 0 holds
  it; it ends with the process. Other programs can read the file.
*/
typedef struct {
  int        file; /* descriptor; negative: no file is locked */
  SamFileUse use;
  PetscBool  created; /* the file did not exist before */
  off_t      size;    /* size when it was last noted */
  off_t      mark_at; /* place of a number that never changes; 0: none */
  double     mark;
} SamFileLock;
/*
  SamFileLockTake - locks a file, which is created if it does not exist. Errors: as SamFileCheckName().
  SamFileLockTakeNext - locks the next file of a name whose file has been renamed.
  SamFileLockCheck - raises an error if the file has been removed or replaced, or if its size differs from the noted one
  or its marked number has another value, which happens if the file was truncated while a step was written, and grew
  again. These are collective. Errors: SAM_ERR_FILE.
  SamFileLockNoteSize - notes the size.
  SamFileLockRelease - unlocks the file; removes it if it is temporary, or was created here and is still empty.
*/
PETSC_INTERN PetscErrorCode SamFileLockTake(SamGrid grid, const char option[], const char filename[], SamFileUse use,
                                            SamFileLock *hold);
PETSC_INTERN PetscErrorCode SamFileLockTakeNext(SamGrid grid, const char option[], const char filename[],
                                                SamFileLock *hold);
PETSC_INTERN PetscErrorCode SamFileLockCheck(SamGrid grid, const char option[], const char filename[],
                                             const SamFileLock *hold);
PETSC_INTERN void           SamFileLockNoteSize(SamFileLock *hold);
PETSC_INTERN void           SamFileLockRelease(const char filename[], SamFileLock *hold);

/* SamFileNameTemporary - creates the name of a file until it is complete; the caller frees it. Not collective. */
PETSC_EXTERN PetscErrorCode SamFileNameTemporary(const char filename[], char **temporary);

#define SAM_SEAL 512 /* bytes at the start of a checkpoint: HDF5's user block, which contains the seal */
/*
  SamSealWrite - seals a finished checkpoint with a checksum over all its bytes. SamSealCheck - compares the checksum
  before any part of the file is interpreted. Both are collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamSealWrite(SamGrid grid, const char option[], const char filename[]);
PETSC_INTERN PetscErrorCode SamSealCheck(SamGrid grid, const char option[], const char filename[]);

#endif
