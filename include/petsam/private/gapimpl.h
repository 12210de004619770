/* What the shapes and the class of gaps share. */
#ifndef PETSAM_GAPIMPL_H
#define PETSAM_GAPIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/gap.h>
#include <petsam/private/fieldfile.h>

#define SAM_GAP_PARAMETERS 4 /* the most that a shape may have */

/* A number that defines a shape; all are required. */
typedef struct {
  const char *name; /* of the option, without dash */
  const char *help;
  SamRange    range;
} SamGapParameter;

struct _n_SamGap {
  /* what the user set */
  MPI_Comm     comm;
  char         type[64], prefix[64];
  PetscReal    values[SAM_GAP_PARAMETERS];
  SamFieldFile source; /* of type file */
  SamFieldFile rough;  /* added to any; no file: none */
  /*
    what the type sets: its parameters, and height(), the separation (m) at a point (m), a pure function; or, where
    that is not enough, methods that read options and fill a field
  */
  struct {
    PetscInt               count;
    const SamGapParameter *parameters;
    PetscReal (*height)(const PetscReal values[], PetscReal x, PetscReal y);
    PetscErrorCode (*setfromoptions)(SamGap gap);
    PetscErrorCode (*fill)(SamGap gap, SamGrid grid, Vec h);
  } ops;
  const char *names[SAM_GAP_PARAMETERS]; /* of the parameters */
};

PETSC_EXTERN PetscErrorCode SamGapCreate_Sphere(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_Ellipsoid(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_Punch(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_Flat(SamGap gap);
PETSC_EXTERN PetscErrorCode SamGapCreate_File(SamGap gap);

#endif
