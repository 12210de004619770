/* Declarations shared by the files of this folder. */
#ifndef PETSAM_GRIDIMPL_H
#define PETSAM_GRIDIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/grid.h>

/* Finds the number of components of two fields, one on each grid; raises an error with this text if the numbers
   differ. */
PETSC_INTERN PetscErrorCode SamGridMatch(SamGrid grid, Vec field, SamGrid other, Vec other_field, const char words[],
                                         PetscInt *components);

/* Gets the rows of a grid that belong to a rank of `ranks`: begin ... end - 1. */
PETSC_INTERN void SamGridRowsOf(SamGrid grid, PetscMPIInt ranks, PetscMPIInt rank, PetscInt *begin, PetscInt *end);

#endif
