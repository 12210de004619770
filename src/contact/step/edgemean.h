/*
  SamEdgeMean - means of a motion over the open cells beside the contact, for the cells of one row after the other.

  A point is one of these cells: its column and row in the grid, a weight, and two components of any unit.
  SamEdgeMeanCreate - makes the points known to all ranks. `p`: the pressure in this rank's cells; `wraps`: true for
  periodic bodies; `points`: SAM_EDGE_POINT numbers of each of this rank's `count` points, by rows; `deviation`: that of
  the weights' Gaussian, in cells; 0: it is to be set. Nothing depends on the number of ranks. Collective.
  SamEdgeMeanSetRow - goes to row j of the grid, which is not before the last one. Not collective.
  SamEdgeMeanAt - computes the mean about column i of this row; 0 if there is no point. Not collective.
*/
#pragma once
#include "stepimpl.h"

enum { SAM_EDGE_COLUMN, SAM_EDGE_ROW, SAM_EDGE_WEIGHT, SAM_EDGE_MOVED, SAM_EDGE_POINT = SAM_EDGE_MOVED + 2 };

typedef struct SamEdgeMean_ *SamEdgeMean;
PETSC_INTERN PetscErrorCode  SamEdgeMeanCreate(SamGrid grid, PetscBool wraps, const double p[], PetscInt count,
                                               const double points[], double *deviation, SamEdgeMean *mean);
PETSC_INTERN PetscErrorCode  SamEdgeMeanDestroy(SamEdgeMean *mean);
PETSC_INTERN void            SamEdgeMeanSetRow(SamEdgeMean mean, PetscInt j);
PETSC_INTERN void            SamEdgeMeanAt(SamEdgeMean mean, PetscInt i, double value[2]);
