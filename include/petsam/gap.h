/* The separation of the undeformed bodies. */
#ifndef PETSAM_GAP_H
#define PETSAM_GAP_H

#include <petsam/grid.h>

/*
  SamGap - a shape: fills the separation h (m) of the undeformed bodies at the cell centres, as it is when they touch in
  the origin without load; a registry of types, each one file of this room.
*/
typedef struct _n_SamGap *SamGap;

typedef const char *SamGapType;
#define SAM_GAP_SPHERE    "sphere"    /* -gap_radius1, -gap_radius2 (m, inf: flat): (x^2 + y^2)/2R, 1/R = 1/R1 + 1/R2 */
#define SAM_GAP_ELLIPSOID "ellipsoid" /* -gap_radius_x, -gap_radius_y (m): x^2/2Rx + y^2/2Ry */
#define SAM_GAP_PUNCH     "punch" /* -gap_flat_radius c, -gap_edge_radius R (m): 0 for r <= c, (r - c)^2/2R beyond */
#define SAM_GAP_FLAT      "flat"  /* 0 */
#define SAM_GAP_FILE      "file"  /* -gap_file, -gap_dataset (/height): an HDF5 dataset of (ny, nx), m */

PETSC_EXTERN PetscErrorCode SamGapCreate(MPI_Comm comm, SamGap *gap);
PETSC_EXTERN PetscErrorCode SamGapDestroy(SamGap *gap);
/* SamGapRegister - adds a type, or replaces one of that name; `create` sets the methods. Not collective. */
PETSC_EXTERN PetscErrorCode SamGapRegister(const char name[], PetscErrorCode (*create)(SamGap));
/* SamGapSetOptionsPrefix - what stands before `gap_` in the names of the options. */
PETSC_EXTERN PetscErrorCode SamGapSetOptionsPrefix(SamGap gap, const char prefix[]);
PETSC_EXTERN PetscErrorCode SamGapSetType(SamGap gap, SamGapType type);
/*
  SamGapSetFromOptions - -gap_type (required), the options of that type, and -gap_rough_file, -gap_rough_dataset for
  roughness added to any of them. A type set before stands when -gap_type is absent. While the help is printed, the
  options of all types are listed, none is required, and the gap is left flat. Collective. Errors: SAM_ERR_USER for
  missing or wrong values.
*/
PETSC_EXTERN PetscErrorCode SamGapSetFromOptions(SamGap gap);
/*
  SamGapFill - writes the separation (m) into h (one component), roughness included. Collective. Errors: SAM_ERR_FILE
  for a file that cannot be read, is not HDF5, lacks the dataset or has one of another shape or with values that are not
  finite; SAM_ERR_USER when values of the shape's options overflow on this grid.
*/
PETSC_EXTERN PetscErrorCode SamGapFill(SamGap gap, SamGrid grid, Vec h);
/* SamGapGetParameters - names (as options, without dash) and values of the numbers that define the shape; borrowed. */
PETSC_EXTERN PetscErrorCode SamGapGetParameters(SamGap gap, SamGapType *type, PetscInt *count,
                                                const char *const **names, const PetscReal **values);

#endif
