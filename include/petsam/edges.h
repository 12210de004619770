/* Edges of contact and of stick, to a fraction of a cell. */
#ifndef PETSAM_EDGES_H
#define PETSAM_EDGES_H

#include <petsam/elasticity.h>

/*
  Where a traction t vanishes at the edge of a zone like the root of the distance, w = t^2 vanishes like the distance.
  The cells next to the edge are wrong by a layer that is the same for all smooth edges; beyond it w is right, and a
  quadratic function through it finds the edge: ten times more accurate than counting cells (theory: examples/edges).

  SamEdge - the edge of a zone.
*/
typedef struct _n_SamEdge {
  PetscReal area;        /* m2: by the reconstructed edge; where that is refused, cells less a part of a cell a face */
  PetscInt  cells;       /* of the zone */
  PetscReal faces, good; /* of these cells to cells outside; those where the reconstruction is accepted */
  PetscReal smooth;      /* and those where the edge is smooth enough for a SamProfile */
  /* points of the reconstructed edge, one in each of this rank's cells that it crosses */
  PetscInt   count;
  PetscReal *x, *y; /* m */
  PetscInt  *cell;  /* index of the cell in this rank's part of the grid */
  /* what vanishes at the edge, about each point's cell: its terms 1, x, y, x^2, x y, y^2, in cells from the centre */
  PetscReal (*fit)[6];
} SamEdge;

/* The two edges of a solution. */
typedef enum { SAM_EDGE_CONTACT, SAM_EDGE_STICK } SamEdgeOf;

/*
  SamEdgeReconstruct - the edge of the zone where w > 0. `w` (one component): the square of what vanishes at the edge,
  in any unit; 0 outside of the zone. When not NULL, `point` (one component) becomes w at the cells' centres: the
  reconstruction where it is accepted, negative beyond the edge, else w. Collective.
  A cell's reconstruction is accepted when there are enough cells behind it, they lie on a quadratic function, and what
  it differs by from w is the layer of a smooth edge; and so for its eight neighbours. Rough surfaces and zones of a few
  cells fail that, and are counted.
*/
PETSC_EXTERN PetscErrorCode SamEdgeReconstruct(SamGrid grid, Vec w, Vec point, SamEdge *edge);
/* SamEdgeDestroy - frees the points. Not collective. */
PETSC_EXTERN PetscErrorCode SamEdgeDestroy(SamEdge *edge);

/*
  SamProfile - what a traction does within the cells of its zone, when it vanishes at the zone's edge like the root of
  the distance: in a band along the edge it is sqrt(max(w, 0)) with a quadratic function w in each cell, elsewhere it is
  linear. A cell belongs to the zone if its centre does; cells outside that the edge cuts, the rim, bear traction too.
*/
typedef struct _n_SamProfile *SamProfile;
/* SamProfileCreate - references the elasticity. SamProfileDestroy - sets the handle to NULL. Collective. */
PETSC_EXTERN PetscErrorCode SamProfileCreate(SamElasticity elasticity, SamProfile *profile);
PETSC_EXTERN PetscErrorCode SamProfileDestroy(SamProfile *profile);
/*
  SamProfileStart - the first guess: the zone is where `mean` (one component, Pa, >= 0) is positive, its edge is
  reconstructed, and there is no rim. `edge` returns the areas and shares of that, without points. Collective.
  SamProfileMatch - finds the functions whose means over the cells are those given. The zone is where they exceed `rim`,
  the means of the rim's cells. Collective.
  SamProfileMove - moves the zone to the edge that was found last; the rim gets its means. Collective.
  `found`: each cell of the band has a function; without, the profile is of no use.
*/
PETSC_EXTERN PetscErrorCode SamProfileStart(SamProfile profile, Vec mean, SamEdge *edge, PetscBool *found);
PETSC_EXTERN PetscErrorCode SamProfileMatch(SamProfile profile, Vec mean, Vec rim, PetscBool *found);
PETSC_EXTERN PetscErrorCode SamProfileMove(SamProfile profile, PetscBool *found);
/*
  What has been found, in fields of one component. Collective.
  SamProfileGetZone - 1 in cells of the zone, else 0; and the means of the rim's cells (Pa), else 0. Borrowed.
  SamProfileComputeDisplacement - the normal displacement (m) by what a pressure of this profile does within the cells:
  what the influence of the cells' means lacks. For an elasticity whose traits say `within`.
  SamProfileComputeSlopes - by how much the pressure grows from one side of a cell to the other, along x and along y
  (two components, Pa).
  SamProfileGetEdge - the edge, with its points; its share is 1. `point` (NULL: not wanted): the traction's square at
  the cells' centres (Pa2).
*/
PETSC_EXTERN PetscErrorCode SamProfileGetZone(SamProfile profile, Vec *zone, Vec *rim);
PETSC_EXTERN PetscErrorCode SamProfileComputeDisplacement(SamProfile profile, Vec u_z);
PETSC_EXTERN PetscErrorCode SamProfileComputeSlopes(SamProfile profile, Vec slopes);
PETSC_EXTERN PetscErrorCode SamProfileGetEdge(SamProfile profile, Vec point, SamEdge *edge);
#endif
