/* Contact edges and stick-slip boundaries, to a fraction of a cell. */
#ifndef PETSAM_PRIVATE_EDGES_H
#define PETSAM_PRIVATE_EDGES_H

#include <petsam/elasticity.h>

/*
  If a traction t vanishes at the edge of a zone like the square root of the distance, w = t^2 is linear in the
  distance. Only the cells in a margin along the edge, which is the same for all smooth edges, have errors; behind it w
  is accurate, and a quadratic function fitted to it locates the edge ten times more accurately than counting cells
  (theory: examples/edges).

  SamEdge - the edge of a zone.
*/
typedef struct _n_SamEdge {
  PetscReal area; /* m2: by the reconstructed edge; where it is rejected, by cells minus SAM_EDGE_FACE per face */
  PetscReal
    half[2];       /* m: half of the zone's extent along x and y, 0 without cells; over the border of a periodic grid */
  PetscInt  cells; /* number of cells in the zone */
  PetscReal faces, good; /* number of faces to cells outside, and of those with an accepted reconstruction */
  /* points of the reconstructed edge, one in each of this rank's cells that it crosses */
  PetscInt   count;
  PetscReal *x, *y; /* m */
  PetscInt  *cell;  /* index of the cell in this rank's part of the grid */
  /* coefficients of w around the cell of each point: terms 1, x, y, x^2, x y, y^2, in cells from its centre */
  PetscReal (*fit)[6];
  /* this rank's cells beside the edge whose reconstruction is accepted, and their w at the centre, negative beyond */
  PetscInt   corrected;
  PetscInt  *corrected_cell;
  PetscReal *corrected_w;
} SamEdge;

/*
  SAM_EDGE_FACE - part of a cell that is subtracted from the area for each face at an edge that is not reconstructed.
*/
#define SAM_EDGE_FACE 0.09
/* SamEdgeOf - the two edges of a solution: the contact edge and the stick-slip boundary. */
typedef enum { SAM_EDGE_CONTACT, SAM_EDGE_STICK } SamEdgeOf;

/*
  SamEdgeReconstruct - reconstructs the edge of the zone where w > 0. `w` (one component): the square of the traction
  that vanishes at the edge, in any unit; 0 outside of the zone. `periodic`: the edge continues over the border of the
  grid. Collective.
  The reconstruction in a cell is accepted if there are enough cells behind it, their w lie on a quadratic function, and
  the difference from w is that of the margin of a smooth edge, in the cell and in its eight neighbours. Rough surfaces
  and zones of a few cells fail these tests, and their cells are counted.
*/
PETSC_INTERN PetscErrorCode SamEdgeReconstruct(SamGrid grid, PetscBool periodic, Vec w, SamEdge *edge);
/* SamEdgeCorrect - replaces w of cells beside the edge by that at their centres. Not collective. */
PETSC_INTERN PetscErrorCode SamEdgeCorrect(const SamEdge *edge, Vec w);
/* SamEdgeDestroy - frees its arrays. Not collective. */
PETSC_INTERN PetscErrorCode SamEdgeDestroy(SamEdge *edge);

#endif
