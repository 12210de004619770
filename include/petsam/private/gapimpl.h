/* The inside of SamGap, for those who add a shape: src/contact/problem/gap/sphere.c is the shortest example. */
#ifndef PETSAM_GAPIMPL_H
#define PETSAM_GAPIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/gap.h>
#include <petsam/private/fieldfile.h>

#define SAM_GAP_PARAMETERS 5 /* most parameters of a shape */

/*
  The contact of a shape without friction, under a central force, by a closed-form solution: half widths along x and y
  (m, infinite where it has no end, NaN where they are not known), force over the composite modulus E* (m2), approach
  (m). All of them grow with the half width that it is computed from.
*/
typedef struct {
  PetscReal half[2], force, approach;
} SamGapContact;

/* A number that defines a shape, read from an option. */
typedef struct {
  const char *name; /* of the option, without dash and prefix */
  const char *help; /* what it is, with its unit */
  SamRange    range;
} SamGapParameter;

struct _n_SamGap {
  /* what the user set */
  MPI_Comm     comm;
  char         type[64], prefix[SAM_PREFIX];
  PetscReal    values[SAM_GAP_PARAMETERS];
  SamFieldFile source; /* the separation, for type `file` */
  SamFieldFile rough;  /* roughness, added to any type; empty file name: none */
  /*
    What the type sets: its parameters, and height(), a pure function that returns the separation (m) at a point (m).
    Where this is not enough, methods of its own that read options and fill a field.
  */
  struct {
    PetscInt               count;
    const SamGapParameter *parameters;
    const PetscReal       *defaults; /* of the parameters, NaN for one that is required; NULL: all of them are */
    PetscReal (*height)(const PetscReal values[], PetscReal x, PetscReal y);
    PetscErrorCode (*setfromoptions)(SamGap gap);
    PetscErrorCode (*fill)(SamGap gap, SamGrid grid, Vec h);
    /*
      Optional, for messages. contact(): the contact whose larger finite half width (m) is `half`. steepness(): the
      largest ratio of the half widths of a contact (m, along x and y) to a radius of curvature, and which parameter is
      that radius. concave(): whether one of the bodies is. check(): an error for values that do not fit each other.
      cylinder: the values of the parameters for bodies that are cylinders along y, NaN where any will do; NULL: all.
    */
    SamGapContact (*contact)(const PetscReal values[], PetscReal half);
    PetscReal (*steepness)(const PetscReal values[], const PetscReal half[2], PetscInt *parameter);
    PetscBool (*concave)(const PetscReal values[]);
    PetscErrorCode (*check)(SamGap gap);
    const PetscReal *cylinder;
    const char      *beyond; /* ends the error about a parameter outside of its range; NULL: nothing */
  } ops;
  const char *names[SAM_GAP_PARAMETERS]; /* of the parameters */
};

PETSC_INTERN PetscErrorCode SamGapCreate_Sphere(SamGap gap);
PETSC_INTERN PetscErrorCode SamGapCreate_Ellipsoid(SamGap gap);
PETSC_INTERN PetscErrorCode SamGapCreate_Curved(SamGap gap);
PETSC_INTERN PetscErrorCode SamGapCreate_Pad(SamGap gap);
PETSC_INTERN PetscErrorCode SamGapCreate_Roller(SamGap gap);
PETSC_INTERN PetscErrorCode SamGapCreate_Punch(SamGap gap);
PETSC_INTERN PetscErrorCode SamGapCreate_Flat(SamGap gap);
PETSC_INTERN PetscErrorCode SamGapCreate_File(SamGap gap);

#endif
