/*
  What a user should know of a solution that is right for its grid, but may not be what was meant: a grid that is too
  coarse or too small, a contact too large for half-spaces. Each message says what would be better, by options.
*/
#ifndef PETSAM_ADVICE_H
#define PETSAM_ADVICE_H

#include <petsam/setup.h>

/* SamExtent - the size of a contact. */
typedef struct {
  PetscInt  zones;   /* connected by the sides of cells, as contact_spots; 0: the bodies do not touch */
  PetscReal across;  /* cells, of the narrow zones: SamGridMeasureZones(), a tenth of the cells left out */
  PetscReal half[2]; /* m: half widths of the rectangle that holds all of it */
  PetscReal change;  /* of the peak pressure on cells half as wide, relative: SamSetupMeasurePeak() */
  PetscInt  finer;   /* cells so many times narrower resolve the peak; 0: none of up to 16384 in a row */
} SamExtent;
/* SamSetupMeasure - the extent of the contact in the last solution that was found. Collective. */
PETSC_EXTERN PetscErrorCode SamSetupMeasure(const SamSetup *setup, SamExtent *extent);
/*
  SamSetupMeasurePeak - `change` and `finer` of the extent: solves the contact about the peak again on finer cells,
  where all other pressure stays. The shape is that of the gap's type, other heights are interpolated. Where the cells
  next to the peak have nearly its pressure, or the pressure is at its limit, nothing is solved, change = 0 and
  finer = 1. Collective.
*/
PETSC_EXTERN PetscErrorCode SamSetupMeasurePeak(const SamSetup *setup, SamExtent *extent);
#define SAM_LARGEST_ROW 16384 /* cells in a row of a grid that is advised */

/* SamLoadsMost - the largest loads of several steps. To be zero at first. */
typedef struct {
  PetscInt  steps;    /* that have been added */
  PetscBool force;    /* the normal force is given; false: the approach */
  PetscReal normal;   /* the largest of it, N or m */
  PetscReal lever[2]; /* m: the farthest that moments bring the centre of pressure from the origin along x and y */
  PetscReal slide;    /* m: the farthest that displacements move the surfaces along them */
  PetscReal rotation; /* rad: the largest that is prescribed */
  PetscReal bulk;     /* Pa: the largest component of the bulk stresses */
  PetscBool open;     /* the contact may be larger than a closed solution for these loads has it: rotations, wear */
} SamLoadsMost;
/* SamLoadsMostAdd - adds a step. Not collective. */
PETSC_EXTERN void SamLoadsMostAdd(SamLoadsMost *most, const SamControl *control);

/*
  SamAdviceFunction - receives advice: a text of one line, and the option (without dash) that mends it, where the text
  does not name it itself; else empty.
*/
typedef PetscErrorCode (*SamAdviceFunction)(void *context, const char text[], const char setting[]);
/*
  None of these is collective.
  SamAdviseStep - gives a function what there is to say of a step that is solved: motions that are not small, bodies
  that do not touch, a contact of fewer than 20 cells across, a peak pressure that cells half as wide change by more
  than 5 %, and a contact that is wider than a tenth of a radius of curvature.
  SamAdviseEdge - appends to the message of a step that came to the grid's edge a grid on which these loads do not.
*/
PETSC_EXTERN PetscErrorCode SamAdviseStep(const SamSetup *setup, const SamStep *step, const SamExtent *extent,
                                          const SamLoadsMost *most, SamAdviceFunction receive, void *context);
PETSC_EXTERN PetscErrorCode SamAdviseEdge(const SamSetup *setup, const SamLoadsMost *most, SamStep *step);

#endif
