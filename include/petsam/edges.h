/* Edges of contact and of stick, to a fraction of a cell. */
#ifndef PETSAM_EDGES_H
#define PETSAM_EDGES_H

#include <petsam/elasticity.h>

/*
  Where a traction t vanishes at the edge of a zone like the root of the distance, w = t^2 vanishes like the distance.
  The cells next to the edge are wrong in a margin that is the same for all smooth edges; beyond it w is right, and a
  quadratic function through it finds the edge: ten times more accurate than counting cells (theory: examples/edges).

  SamEdge - the edge of a zone.
*/
typedef struct _n_SamEdge {
  PetscReal area;        /* m2: by the reconstructed edge; where that is refused, cells less a part of a cell a face */
  PetscInt  cells;       /* of the zone */
  PetscReal faces, good; /* of these cells to cells outside; those where the reconstruction is accepted */
  /* points of the reconstructed edge, one in each of this rank's cells that it crosses */
  PetscInt   count;
  PetscReal *x, *y; /* m */
  PetscInt  *cell;  /* index of the cell in this rank's part of the grid */
  /* what vanishes at the edge, about each point's cell: its terms 1, x, y, x^2, x y, y^2, in cells from the centre */
  PetscReal (*fit)[6];
} SamEdge;

/* SAM_EDGE_FACE - part of a cell that is not counted for each of its sides at an edge that is not reconstructed. */
#define SAM_EDGE_FACE 0.09
/* The two edges of a solution. */
typedef enum { SAM_EDGE_CONTACT, SAM_EDGE_STICK } SamEdgeOf;

/*
  SamEdgeReconstruct - the edge of the zone where w > 0. `w` (one component): the square of what vanishes at the edge,
  in any unit; 0 outside of the zone. `periodic`: the edge goes on over the border of the grid. When not NULL,
  `point` (one component) becomes w at the cells' centres: the reconstruction where it is accepted, negative beyond the
  edge, else w. Collective.
  A cell's reconstruction is accepted when there are enough cells behind it, they lie on a quadratic function, and what
  it differs by from w is that margin of a smooth edge; and so for its eight neighbours. Rough surfaces and zones of a
  few cells fail that, and are counted.
*/
PETSC_INTERN PetscErrorCode SamEdgeReconstruct(SamGrid grid, PetscBool periodic, Vec w, Vec point, SamEdge *edge);
/* SamEdgeDestroy - frees the points. Not collective. */
PETSC_INTERN PetscErrorCode SamEdgeDestroy(SamEdge *edge);

#endif
