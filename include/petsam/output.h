/* Results in an HDF5 file, and the parameters of the run that they belong to. */
#ifndef PETSAM_OUTPUT_H
#define PETSAM_OUTPUT_H

#include <petsam/life.h>

/*
  SamParameters - what defines a run, by the names of its options (without dash). Stored with results and checkpoints.
  Where `fixed` is true, a stopped run can only go on with the same value.
*/
#define SAM_PARAMETERS 48 /* most parameters of a run */
typedef struct {
  char      name[32];
  PetscBool fixed;
  PetscInt  count; /* number of values, 1 or 2; 0: the parameter is a text */
  PetscReal value[2];
  char      text[64];
} SamParameter;
typedef struct {
  PetscInt     count;
  SamParameter list[SAM_PARAMETERS];
} SamParameters;

/*
  SamParametersAddReals, SamParametersAddText - append a parameter: one or two numbers, or a text of at most 63
  characters. Not collective. Errors: PETSC_ERR_ARG_OUTOFRANGE for another count, or a parameter too many.
*/
PETSC_EXTERN PetscErrorCode SamParametersAddReals(SamParameters *parameters, const char name[], PetscBool fixed,
                                                  PetscInt count, const PetscReal values[]);
PETSC_EXTERN PetscErrorCode SamParametersAddText(SamParameters *parameters, const char name[], PetscBool fixed,
                                                 const char text[]);

/*
  SamOutput - a results file, to which one load step at a time is appended (layout: examples/RESULTS.md). Every dataset
  has the attributes `units` and `long_name`, and the dimension scales time, y, x, so that h5py and xarray (netcdf4)
  open it. For ParaView the same datasets are linked in a group VTKHDF (read by VTK from 9.3 on) and described by an
  XDMF file beside the results (for older versions, and VisIt).
*/
typedef struct _n_SamOutput *SamOutput;

/* What a file has only when it is asked for: columns of /history, fields, groups. */
typedef enum {
  SAM_OUTPUT_FRICTION_SCALE, /* friction_scale */
  SAM_OUTPUT_BULK_STRESS,    /* bulk1_stress_xx ... bulk2_stress_xy */
  SAM_OUTPUT_WEAR,           /* wear_volume1, wear_volume2; the fields wear_depth1, wear_depth2 */
  SAM_OUTPUT_LIFE,           /* cycle; the group /wear */
  SAM_OUTPUT_STIFFNESS,      /* stiffness, stiffness_reversal */
  SAM_OUTPUT_SPOTS,          /* contact_spots, gap_mean */
  SAM_OUTPUT_PLASTIC,        /* plastic_cells ... plastic_energy; the field plastic_depth */
  SAM_OUTPUT_OPTIONS
} SamOutputOption;

/* How a results file is written. */
#define SAM_OUTPUT_MOST 64 /* most fields, and most columns */
typedef struct {
  PetscBool  fields[SAM_OUTPUT_MOST]; /* which ones of the table of fields; SamOutputSettingsSetFields() */
  PetscBool  named;                   /* each of them by its name */
  PetscInt   compress;                /* deflate level of the fields, 0 (none) to 9 */
  PetscInt   chunk[2];                /* most cells of an HDF5 chunk in x, y */
  PetscBool  xdmf;                    /* write an XDMF file beside the results */
  PetscBool  single;                  /* fields of cells in single precision */
  PetscReal  flush;                   /* s that steps without fields may wait to be written together; 0: they do not */
  PetscBool  with[SAM_OUTPUT_OPTIONS];
  SamWear    wear;    /* whose depths are written; borrowed; NULL without wear */
  SamContact contact; /* that keeps the sums over the steps among the fields; borrowed; NULL: not known */
} SamOutputSettings;
/*
  SamOutputSettingsSetFromOptions - sets the defaults (pressure, shear, slip, state, depths of wear and plastic depth,
  no compression, chunks of 1024 x 256 cells, double precision, with XDMF file, each step written at once, no optional
  columns), then reads -output_fields, -output_compress, -output_chunk, -output_single and -output_xdmf. Collective.
  Errors: SAM_ERR_USER.
  SamOutputSettingsSetFields - chooses `count` fields by their names in the results; "all" stands for all of them, a
  single "none" for none; count < 0: the default. `unknown`: a name that there is not, or NULL. Not collective.
  SamOutputSettingsCheck - refuses fields that are named and that these results do not have. Collective. Errors:
  SAM_ERR_USER.
  SamOutputSettingsHas - whether a field of that name is among them. Not collective.
  SamOutputSettingsPrepare - makes a contact keep the sums over the steps that are among the fields; SamOutputContinue()
  then refuses a file with sums that the contact does not keep. Collective.
  SamOutputGetFieldNames - the names that there are, as a sentence has them. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamOutputSettingsSetFields(SamOutputSettings *settings, PetscInt count,
                                                       const char *const names[], const char **unknown);
PETSC_EXTERN PetscErrorCode SamOutputSettingsCheck(const SamOutputSettings *settings, const SamOptions *from);
PETSC_EXTERN PetscBool      SamOutputSettingsHas(const SamOutputSettings *settings, const char name[]);
PETSC_EXTERN PetscErrorCode SamOutputSettingsPrepare(SamOutputSettings *settings, SamContact contact);
PETSC_EXTERN PetscErrorCode SamOutputGetFieldNames(char names[], size_t size);
PETSC_EXTERN PetscErrorCode SamOutputSettingsSetFromOptions(SamOutputSettings *settings, const SamOptions *from);

/*
  SamOutputCreate - creates the file with the coordinates of the grid and no step yet; replaces older results of that
  name. All ranks write together through MPI-IO. Until it is destroyed, no other run gets the file, but others may read
  it. Collective. Errors: SAM_ERR_FILE when the file cannot be created, is being written by another run, or is there and
  is not a results file of petsam; it is left unchanged then.
*/
PETSC_EXTERN PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], const SamOutputSettings *settings,
                                            SamOutput *output);
/*
  SamOutputNames - the names of the XDMF file beside results and of the file in which SamOutputContinue() writes them
  again; the caller frees them with PetscFree(). Not collective.
*/
PETSC_EXTERN PetscErrorCode SamOutputNames(const char filename[], char **xdmf, char **temporary);
/*
  How far the results of a stopped run go that are kept. Results that begin in the middle of a history have the root
  attribute SAM_OUTPUT_BRANCH, a number: the load steps before the first of the file.
*/
#define SAM_OUTPUT_BRANCH "branch_step"
typedef struct {
  PetscInt first;  /* load steps before those of the file */
  PetscInt steps;  /* of /history */
  PetscInt cycles; /* of /wear */
  uint64_t times;  /* checksum of the times of these steps */
} SamOutputPoint;
/* SamOutputAddTime - the checksum of some times (0 of none) and one more (s). Not collective. */
PETSC_EXTERN uint64_t SamOutputAddTime(uint64_t times, PetscReal time);
/*
  SamOutputContinue - opens the results of a stopped run, to append to what it held at a point. A file that holds
  exactly this and was closed properly is used as it is. Otherwise, as it may end in the middle of a step or hold more
  steps, it is copied to a new file up to there, which takes its name. The XDMF file is written again. Collective.
  Errors: SAM_ERR_FILE for a file that cannot be read or written or lacks some of the steps, SAM_ERR_USER for one with
  other fixed parameters or other times; after an error the file is unchanged.
*/
PETSC_EXTERN PetscErrorCode SamOutputContinue(SamGrid grid, const char filename[], const SamOutputSettings *settings,
                                              const SamParameters *parameters, const SamOutputPoint *point,
                                              SamOutput *output);
/* SamOutputSetParameters - stores parameters as attributes of the root group. Collective. Errors: SAM_ERR_FILE. */
PETSC_EXTERN PetscErrorCode SamOutputSetParameters(SamOutput output, const SamParameters *parameters);
/*
  SamOutputSetReals, SamOutputSetText - store an attribute of the root group; a single number is stored as a scalar.
  Collective. Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamOutputSetReals(SamOutput output, const char name[], PetscInt count,
                                              const PetscReal values[]);
PETSC_EXTERN PetscErrorCode SamOutputSetText(SamOutput output, const char name[], const char text[]);
/*
  SamOutputWriteStep - appends the numbers of a step to /history and, when `contact` is not NULL, its time and the
  fields of the contact's solution (SamContactGetSolution()). Then the file is complete up to here, whatever happens
  later; but where the settings allow it, steps without fields wait in memory, since many are written in the time of
  one: for so long, if steps go on to be written, or until there is a chunk of them. Collective. Errors: SAM_ERR_FILE,
  also when another program has replaced the file, or changed its size, since it was written last. When there is no
  space, nothing is written and the file can be closed.
  When writing fails in the middle of a step it cannot: SamOutputDestroy() then leaves the file open, and the program
  should end with MPI_Abort(), since HDF5 would try to close the file in MPI_Finalize().
  SamOutputFlush - writes the steps that wait. Collective. Errors: as SamOutputWriteStep().
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteStep(SamOutput output, const SamStep *step, SamContact contact);
PETSC_EXTERN PetscErrorCode SamOutputFlush(SamOutput output);
/*
  SamOutputWriteFields - appends only the fields, of a step whose numbers are in the file already; `time` (s) is that of
  the step. Otherwise as SamOutputWriteStep(). Collective. Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteFields(SamOutput output, PetscReal time, SamContact contact);
/*
  SamOutputWriteCycle - appends a computed cycle of a life to /wear, then flushes, as SamOutputWriteStep(). Collective.
  Errors: SAM_ERR_FILE; PETSC_ERR_ORDER for a file without that group.
*/
PETSC_EXTERN PetscErrorCode SamOutputWriteCycle(SamOutput output, const SamLifeReport *cycle);
/*
  What results hold, by the names that it has there:
  SamFieldGet - a field of a contact's solution (SamContactGetSolution()), and of its wear (NULL: none), into a vector
  of one component; states as real numbers. Collective.
  SamStepGetNumber - a number of a step. Not collective.
  Both tell whether there is one of that name.
*/
PETSC_EXTERN PetscErrorCode SamFieldGet(SamContact contact, SamWear wear, const char name[], Vec field,
                                        PetscBool *found);
PETSC_EXTERN PetscBool      SamStepGetNumber(const SamStep *step, const char name[], PetscReal *value);
/*
  SamOutputGetSaved - the number of load steps in the file, the number of those with fields, and the time (s) of the
  last step with fields, -infinity without one; NULL for one that is not wanted. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamOutputGetSaved(SamOutput output, PetscInt *steps, PetscInt *saved, PetscReal *time);
/*
  SamOutputForecast - the size (bytes) of a file like this one of so many load steps and so many steps with fields,
  without compression. Not collective.
  SamOutputGetSpace - the free space (bytes) of the file system that the file is on; infinite if that is not known.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamOutputForecast(SamOutput output, double steps, double saved, double *bytes);
PETSC_EXTERN PetscErrorCode SamOutputGetSpace(SamOutput output, double *bytes);
/* SamOutputHasReplaced - whether the file has replaced older results. Not collective. */
PETSC_EXTERN PetscErrorCode SamOutputHasReplaced(SamOutput output, PetscBool *replaced);
/* SamOutputGetXdmf - the name of the XDMF file beside the results, NULL without one; borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode SamOutputGetXdmf(SamOutput output, const char **filename);
/*
  SamOutputDestroy - closes the file, frees the object and sets the handle to NULL, also when closing fails. Collective.
  Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamOutputDestroy(SamOutput *output);

#endif
