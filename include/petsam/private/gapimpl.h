/* The implementation of SamGap, for authors of new shapes: src/contact/problem/gap/sphere.c is the shortest example. */
#ifndef PETSAM_GAPIMPL_H
#define PETSAM_GAPIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/gap.h>
#include <petsam/private/fieldfile.h>

/*
  SamGapContact - the frictionless contact of a shape under a central force, by a closed-form solution: half widths
  along x and y (m; infinite along a cylinder, NaN if unknown), force over the composite modulus E* (m2), approach (m).
  All of them grow with the half width from which they are computed.
*/
typedef struct {
  PetscReal half[2], force, approach;
} SamGapContact;

/* SamGapParameter - a number that defines a shape, read from an option. */
typedef struct {
  const char *name; /* name of the option, without dash and prefix */
  const char *help; /* description, with () for its unit, as in SamOptionRow */
  const char *unit; /* unit of SI; NULL: none */
  SamRange    range;
} SamGapParameter;

struct _n_SamGap {
  SamClassId class_id;
  /* set by the user */
  MPI_Comm     comm;
  char         type[64], prefix[SAM_PREFIX];
  PetscReal    values[SAM_GAP_PARAMETERS];
  SamFieldFile source; /* the separation, for type `file` */
  SamFieldFile rough;  /* roughness, added to any type; empty file name: none */
  /*
    These members are set by the type: its parameters, and height(), a pure function that returns the separation (m) at
    a point (m). A type for which this is not enough has its own methods that read options and fill a field.
  */
  struct {
    PetscInt               count;
    const SamGapParameter *parameters;
    const PetscReal       *defaults; /* defaults of the parameters, NaN for a required one; NULL: all are required */
    PetscReal (*height)(const PetscReal values[], PetscReal x, PetscReal y);
    PetscErrorCode (*setfromoptions)(SamGap gap);
    PetscErrorCode (*fill)(SamGap gap, SamGrid grid, Vec h);
    /*
      Optional, for messages. contact(): the contact whose larger finite half width (m) is `half`. steepness(): the
      largest ratio of the half widths of a contact (m, along x and y) to a radius of curvature, and which parameter is
      that radius. concave(): returns true if one of the bodies is concave. check(): raises an error for incompatible
      values. cylinder: the values of the parameters for bodies that are cylinders along y, NaN for any value; NULL:
      always cylinders.
    */
    SamGapContact (*contact)(const PetscReal values[], PetscReal half);
    PetscReal (*steepness)(const PetscReal values[], const PetscReal half[2], PetscInt *parameter);
    PetscBool (*concave)(const PetscReal values[]);
    PetscErrorCode (*check)(SamGap gap);
    const PetscReal *cylinder;
    const char      *beyond; /* end of the error about a parameter outside of its range; NULL: none */
  } ops;
  const char *names[SAM_GAP_PARAMETERS]; /* names of the parameters */
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
