/* What the files of this room share. */
#ifndef PETSAM_GRIDIMPL_H
#define PETSAM_GRIDIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/grid.h>

/* The components that two fields have, one on each grid; an error with these words when they do not fit. */
PETSC_INTERN PetscErrorCode SamGridMatch(SamGrid grid, Vec field, SamGrid other, Vec other_field, const char words[],
                                         PetscInt *components);

/* Rows of a grid that belong to a rank of `ranks`: begin ... end - 1. */
PETSC_INTERN void SamGridRowsOf(SamGrid grid, PetscMPIInt ranks, PetscMPIInt rank, PetscInt *begin, PetscInt *end);

/*
  SamRows - rows first ... first + count - 1 of a grid, which this rank wants to see, its own or others'. Create and
  Fetch are collective. Fetch takes this rank's rows of `columns` doubles and gives the wanted ones until Restore; when
  they are all its own it copies nothing.
*/
typedef struct {
  SamGrid     grid;
  PetscMPIInt ranks;
  PetscInt    first, count;
  /* rows exchanged with each rank: [0] those that it wants of this rank, [1] those that this rank wants of it */
  PetscMPIInt *counts[2], *offsets[2];
} SamRows;
PETSC_INTERN PetscErrorCode SamRowsCreate(SamGrid grid, PetscInt first, PetscInt count, SamRows *rows);
PETSC_INTERN PetscErrorCode SamRowsDestroy(SamRows *rows);
PETSC_INTERN PetscErrorCode SamRowsFetch(const SamRows *rows, PetscInt columns, const double own[],
                                         const double **wanted);
PETSC_INTERN PetscErrorCode SamRowsRestore(const SamRows *rows, const double **wanted);

#endif
