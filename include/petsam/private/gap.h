/* Functions of gap, besides petsam/gap.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_GAP_H
#define PETSAM_PRIVATE_GAP_H

#include <petsam/gap.h>

#define SAM_GAP_PARAMETERS 5 /* maximum number of parameters of a shape */

/*
  SamGapGetFileGrid - gets the grid of the file of the gap or of the roughness, set by the setters or options: cells,
  full widths and centre (m) in x and y, all 0 without a file. It does not read files if -grid_n and -grid_size are
  given. A file that does not give its width (0) is an error unless -grid_size is given. Collective. Errors:
  SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamGapGetFileGrid(SamGap gap, PetscInt n[2], PetscReal width[2], PetscReal center[2]);

/*
  SamGapGetHeight - returns the separation (m) of the shape at a point (m), without roughness; 0 for a type whose
  heights are given cell by cell. Not collective.
  SamGapGetSlope - returns its derivative by the k-th parameter (m over the unit of the parameter), 0 for an infinite
  one, to about twelve digits. Not collective.
*/
PETSC_INTERN PetscReal SamGapGetHeight(SamGap gap, PetscReal x, PetscReal y);
PETSC_INTERN PetscReal SamGapGetSlope(SamGap gap, PetscInt k, PetscReal x, PetscReal y);

/*
  SamGapGetParameters - gets the type, and the count, names (those of the options, without dash and prefix) and values
  of the numbers that define the shape. All are borrowed; NULL for an unwanted output. Not collective.
*/
PETSC_INTERN PetscErrorCode SamGapGetParameters(SamGap gap, SamGapType *type, PetscInt *count,
                                                const char *const **names, const PetscReal **values);

/*
  SamGapEstimateContact - estimates the half widths (m) along x and y of the frictionless contact of the shape, by a
  closed-form solution (Hertz, Sneddon): `value` is a central force over the composite modulus E* (m2) or, without
  `force`, an approach (m). Half widths along the axis of a cylinder are infinite; `known`: false for types without such
  a solution, and with a roughness. Not collective.
*/
PETSC_INTERN PetscErrorCode SamGapEstimateContact(SamGap gap, PetscBool force, PetscReal value, PetscReal half[2],
                                                  PetscBool *known);

/*
  SamGapEstimateLine - estimates the half width (m) along x of the contact in plane strain under a force per length over
  E* (m), for shapes that are even in x; 0: there is none, infinite: surfaces flat along x. `known` as above. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamGapEstimateLine(SamGap gap, PetscReal value, PetscReal *half, PetscBool *known);

/*
  SamGapGetSteepness - computes the largest ratio of a contact's half widths (m, along x and y) to a radius of
  curvature, and gets this radius (m) and the name of the option (without dash and prefix) that gives it; 0 and NULL for
  types without radii. `concave`: true if one of the bodies is concave. Not collective.
*/
typedef struct {
  PetscReal   ratio, radius;
  const char *option;
  PetscBool   concave;
} SamGapSteepness;
PETSC_INTERN PetscErrorCode SamGapGetSteepness(SamGap gap, const PetscReal half[2], SamGapSteepness *steepness);

/*
  SamGapAdvise - writes a warning if the heights of the gap's file, or of its roughness, seem to have another unit, or,
  with `periodic`, to be those of a tilted surface; else an empty text. `h`: the separation (m). Collective.
  `certain`: no surface has such heights, and what else may be wrong follows from their unit.
  SamGapAdviseStep - writes a warning if the heights have a step in the contact that is high relative to the elastic
  deformation under this pressure (Pa); `modulus`: E* at the surface (Pa). Collective.
*/
PETSC_INTERN PetscErrorCode SamGapAdvise(SamGap gap, SamGrid grid, Vec h, PetscBool periodic, PetscBool *certain,
                                         char text[], size_t size);
PETSC_INTERN PetscErrorCode SamGapAdviseStep(SamGap gap, SamGrid grid, Vec h, Vec pressure, double modulus, char text[],
                                             size_t size);

/*
  SamGapCheckPlane - rejects a shape that varies along y, which plane strain would ignore. Collective. Errors:
  SAM_ERR_USER with the option that makes it vary.
  SamGapIsFromFile - returns true if the gap, or with `rough` its roughness, comes from a file. SamGapHasFile -
  returns true if any of its heights do. Neither is collective.
  SamGapIsQuadratic - returns true if the gap is a quadratic function of x and y, without heights from files. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamGapCheckPlane(SamGap gap);
PETSC_INTERN PetscBool      SamGapIsFromFile(SamGap gap, PetscBool rough);
PETSC_INTERN PetscBool      SamGapHasFile(SamGap gap);
PETSC_INTERN PetscBool      SamGapIsQuadratic(SamGap gap);

#endif
