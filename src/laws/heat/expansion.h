/* Thermal expansion: the displacement of the surface of a half-space by heat that flows into it. */
#ifndef PETSAM_EXPANSION_H
#define PETSAM_EXPANSION_H

#include "heat.h"

/*
  SamExpansionTable - displacements of the surface by unit flux on one cell, in rows of lags (receiver minus source):
  number 0 out of the body, 1 along x, 2 along y, each over (1 + nu) alpha/conductivity (m2: m for 1 W/m2 where that is
  1 m/W).

  SamExpansionTableCreate - creates the table; side: sides of a cell (m); n: numbers of lags i = 0 ... n[0] - 1 in both
                            directions, and j = 0 ... n[1] - 1. Displacements out of a body that stands are relative to
                            that at the distance of half of the diagonal of n[0] x n[1] cells.
  SamExpansionTableRow    - computes `even` and `odd`, n[0] values each for each number: the even and the odd part along
                            x of the row j >= 0. Rows in their order take a third of the time.
  None is collective. Errors: none; the body must be one that SamHeatRow() takes, in three dimensions.
*/
typedef struct _n_SamExpansionTable *SamExpansionTable;
PETSC_INTERN PetscErrorCode          SamExpansionTableCreate(const SamHeatBody *body, const PetscReal side[2],
                                                             const PetscInt n[2], SamExpansionTable *table);
PETSC_INTERN PetscErrorCode          SamExpansionTableDestroy(SamExpansionTable *table);
PETSC_INTERN void                    SamExpansionTableRow(SamExpansionTable table, PetscInt j, double *const even[3],
                                                          double *const odd[3]);

/*
  SamExpander - the operator from a flux into a half-space to the displacement of its surface.

  SamExpanderCreate - creates it on a grid in three dimensions, which it references; the rest is copied.
  SamExpanderAdd    - adds the displacement by a flux (one component, W/m2), for (1 + nu) alpha/conductivity = 1 m/W:
                      that out of the body, times `out`, to u_out (one component, m), and that along the surface, times
                      `along`, to u_t (two components, m). The same to the last bit on any number of ranks.
  All are collective. Errors: PETSC_ERR_ARG_SIZ for a field of another grid.
*/
typedef struct _n_SamExpander *SamExpander;
PETSC_INTERN PetscErrorCode SamExpanderCreate(SamGrid grid, const SamFourierSettings *settings, const SamHeatBody *body,
                                              SamExpander *expander);
PETSC_INTERN PetscErrorCode SamExpanderAdd(SamExpander expander, Vec flux, PetscReal out, PetscReal along, Vec u_out,
                                           Vec u_t);
PETSC_INTERN PetscErrorCode SamExpanderDestroy(SamExpander *expander);

#endif
