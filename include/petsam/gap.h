/* The separation of the undeformed bodies. */
#ifndef PETSAM_GAP_H
#define PETSAM_GAP_H

#include <petsam/grid.h>

/*
  SamGap - the shape of the bodies: it gives the separation h (m) of the undeformed bodies at the cell centres when they
  touch at x = y = 0 without load. Its types are registered by name; a new type is one file.

  See also: SamGapCreate(), SamGapFill(), SamProblemSetGap().
*/
typedef struct _n_SamGap *SamGap;

typedef const char *SamGapType;
#define SAM_GAP_SPHERE    "sphere"    /* -gap_radius1, -gap_radius2 (m, inf: flat): (x^2 + y^2)/2R, 1/R = 1/R1 + 1/R2 */
#define SAM_GAP_ELLIPSOID "ellipsoid" /* -gap_radius_x, -gap_radius_y (m, inf: cylindrical): x^2/2Rx + y^2/2Ry */
#define SAM_GAP_PUNCH     "punch" /* -gap_flat_radius c, -gap_edge_radius R (m): 0 for r <= c, (r - c)^2/2R beyond */
#define SAM_GAP_CURVED \
  "curved" /* -gap_radius1_x, _y, -gap_radius2_x, _y (m), -gap_angle (degrees): two bodies' own radii */
#define SAM_GAP_PAD    "pad"    /* -gap_half_flat_x, _y, -gap_edge_radius_x, _y (m): flat, with rounded edges */
#define SAM_GAP_ROLLER "roller" /* -gap_roller_radius, _half_length, _crown, _drop (m): a logarithmic profile */
#define SAM_GAP_FLAT   "flat"   /* two planes: 0 */
#define SAM_GAP_FILE   "file"   /* -gap_file, -gap_dataset (/height): an HDF5 dataset of shape (ny, nx), m */

/*
  SamGapCreate - creates a gap without a type.

  Collective.

  In:     comm - communicator on which the errors of the gap are raised
  Out:    gap  - the gap

  Errors: none of its own.

  See also: SamGapDestroy(), SamGapSetType(), SamGapFill().
*/
PETSC_EXTERN PetscErrorCode SamGapCreate(MPI_Comm comm, SamGap *gap);

/*
  SamGapDestroy - frees the gap and sets the handle to NULL.

  Not collective.

  In,out: gap - the gap; NULL on return

  Errors: none of its own.
*/
PETSC_EXTERN PetscErrorCode SamGapDestroy(SamGap *gap);

/*
  SamGapRegister - adds a type of gap, or replaces the one of that name.

  Not collective, but to be called on all ranks.

  In:     name   - name of the type
          create - function that sets the type's methods; see <petsam/private/gapimpl.h>

  Errors: none of its own.

  See also: SamGapSetType(), SamOptionsPlugins().
*/
PETSC_EXTERN PetscErrorCode SamGapRegister(const char name[], PetscErrorCode (*create)(SamGap));

/*
  SamGapSetOptionsPrefix - sets the prefix of the options of a gap, before `gap_`.

  Not collective.

  In:     gap    - the gap
          prefix - the prefix, without dash; copied; NULL: none

  Errors: PETSC_ERR_ARG_SIZ for a prefix that is too long.

  See also: SamGapSetFromOptions().
*/
PETSC_EXTERN PetscErrorCode SamGapSetOptionsPrefix(SamGap gap, const char prefix[]);

/*
  SamGapSetType - chooses the shape, whose parameters are then unset.

  Collective.

  In:     gap  - the gap
          type - name of a registered type

  Errors: SAM_ERR_USER for an unknown type, with the list of registered types; PETSC_ERR_PLIB for a registered type that
  sets too many parameters or no heights.

  The option -gap_type sets the type, too.

  See also: SamGapSetParameter(), SamGapSetFile(), SamGapFill().
*/
PETSC_EXTERN PetscErrorCode SamGapSetType(SamGap gap, SamGapType type);

/*
  SamGapSetParameter - sets a number that defines the shape, by the name of its option.

  Not collective, the same on all ranks.

  In:     gap   - the gap, with a type
          name  - name of the option, without dash; `gap_` may be omitted: "radius1" for -gap_radius1
          value - the number (unit of the option: m, or degrees for an angle)

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a name that the type does not have, or a value out of its range.

  See also: SamGapSetType(), SamGapFill().
*/
PETSC_EXTERN PetscErrorCode SamGapSetParameter(SamGap gap, const char name[], PetscReal value);

/*
  SamGapSetFile - sets the HDF5 file of the type `file`, or that of a roughness, which is added to any type.

  Not collective, the same on all ranks.

  In:     gap     - the gap
          rough   - true: the file has a roughness; false: it has the heights of the type `file`
          file    - name of the file; NULL: none
          dataset - name of the dataset; NULL: /height

  Errors: none of its own; SamGapFill() reads the file.

  Datasets of shape (ny, nx) are separations in m unless their attributes units and quantity say otherwise
  (examples/manual/SURFACES.md). The options -gap_file, -gap_dataset, and -gap_rough_file, -gap_rough_dataset set the
  same.

  See also: SamGapSetType(), SamGapFill().
*/
PETSC_EXTERN PetscErrorCode SamGapSetFile(SamGap gap, PetscBool rough, const char file[], const char dataset[]);

/*
  SamGapSetFromOptions - reads the type of the gap, its parameters, and a roughness from the options.

  Collective.

  In:     gap - the gap

  Options: -gap_type, required unless a type has been set, or there is -gap_file, whose type is `file`; the options of
  that type, required unless they have been set or have a default; those of a roughness, -gap_rough_file and
  -gap_rough_dataset.
  Errors: SAM_ERR_USER for missing or wrong values.

  While the help is printed, the options of all types are listed, none is required, and the gap stays flat.

  See also: SamGapSetOptionsPrefix(), SamGapFill().
*/
PETSC_EXTERN PetscErrorCode SamGapSetFromOptions(SamGap gap);

/*
  SamGapFill - computes the separation of the undeformed bodies with the roughness.

  Collective.

  In:     gap  - the gap, with its type and parameters
          grid - the grid
  Out:    h    - separation (m), one component

  Errors: PETSC_ERR_ORDER without a type, or with a parameter or a file that is not set; SAM_ERR_FILE for a file that
  cannot be read, is not HDF5, or lacks the dataset, and for a dataset of another shape or size, with values that are
  not finite, or with an unknown unit or quantity; SAM_ERR_USER if the parameters of the shape contradict each other or
  overflow on this grid.

  See also: SamGridCreateVec(), SamGapSetType(), SamProblemSetGap().
*/
PETSC_EXTERN PetscErrorCode SamGapFill(SamGap gap, SamGrid grid, Vec h);

#endif
