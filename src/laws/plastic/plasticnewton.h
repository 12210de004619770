/* Plastic strain and contact together. */
#ifndef PETSAM_PLASTICNEWTON_H
#define PETSAM_PLASTICNEWTON_H

#include "mises.h"
#include <petsam/private/lawimpl.h>

/* A body that yields, and the place of its layers among the layers of both bodies */
typedef struct {
  PetscInt  body; /* 0 or 1 */
  PetscReal top;  /* depth at which its layers begin, m */
  SamMises  material;
  PetscInt  first;
  double   *initial; /* stress before any load, xx and yy of each layer (Pa); NULL: none; borrowed */
  double    bulk[SAM_STRESS_COMPONENTS]; /* bulk stress of the step (Pa) */
} SamPlasticBody;

/*
  SamPlasticBegun - the displacement u (m, three fields) by a field of the state at a revision; `of` NULL: none.
  `spectra`: the residuals hold the spectra of its strain.
*/
typedef struct {
  Vec              of;
  PetscObjectState revision;
  double          *u;
  PetscBool        spectra;
} SamPlasticBegun;

/*
  SamPlastic - the bodies that yield, with their layers one after the other. The memory of a cell of a layer is in the
  state's field `field`: `size` values, which are the plastic strain, the accumulated plastic strain and the
  backstresses.
*/
typedef struct {
  SamGrid                   grid;
  SamElasticity             elasticity;
  PetscInt                  bodies, layers; /* number of layers of each body */
  PetscInt                  size;
  SamPlasticBody            body[2];
  SamResidual               residual[2]; /* of these bodies */
  PetscReal                *thickness;   /* thicknesses of a body's layers, m; borrowed */
  PetscReal                 rtol;
  Vec                       last; /* strain before the step, of the points that now lie under the cells; NULL: none */
  PetscInt                  newton, products; /* counts of the last step */
  struct _n_SamEquations   *equations;        /* of the last step (equations.h); NULL: none */
  struct _n_SamPlasticWork *work;             /* of an iteration under way (plasticnewton.c); NULL: none */
  SamPlasticBegun           begun;
} SamPlastic;

#define SAM_PLASTIC_FIELD "plastic"

/*
  SamPlasticSolve - iterates for the plastic strain of a step, which becomes the tried one, together with its tractions:
  a method `follow` of SamLaw. SamPlasticAbandon - ends an iteration that was not ended. Both are collective.
  SamPlasticDisplace - computes the displacements of the surfaces by the strain of a generation of the state (m), and
  keeps them until it is called with another strain. SamPlasticForget - frees what is kept. Both are collective.
  SamPlasticStress - computes the stress by the strain of the state and before any load, and, if the tractions are given
  (Pa; NULL: not), by these and the bulk stress of the step, as (layers of all bodies, PARTS), and the elastic energy of
  the stress by the strain alone (J; NULL: not wanted). Collective.
  SamPlasticWork - computes the work of such a stress on a strain (J). Collective.
*/
PETSC_INTERN PetscErrorCode SamPlasticSolve(SamPlastic *plastic, SamLawContact *contact, PetscBool *again);
PETSC_INTERN PetscErrorCode SamPlasticAbandon(SamPlastic *plastic);
PETSC_INTERN PetscErrorCode SamPlasticDisplace(SamPlastic *plastic, Vec state, double *const u[3]);
PETSC_INTERN PetscErrorCode SamPlasticForget(SamPlastic *plastic);
PETSC_INTERN PetscErrorCode SamPlasticStress(SamPlastic *plastic, Vec state, Vec pressure, Vec shear, double stress[],
                                             double *energy);
PETSC_INTERN PetscErrorCode SamPlasticWork(const SamPlastic *plastic, const double e[], const double s[], double *work);
/*
  SamPlasticLookOutside - searches for yielding below the last layer and inside layers that are thick compared with the
  contact. `excess`: the largest von Mises stress beyond yield, relative to the yield stress; 0: none. `thick`: the
  thickness of the layer in which a contact yields first, relative to the contact's half width; thick above
  SAM_PLASTIC_THICK. Collective.
*/
PETSC_INTERN PetscErrorCode SamPlasticLookOutside(SamPlastic *plastic, Vec state, Vec pressure, Vec shear,
                                                  double *thick, double *excess);
/*
  SamPlasticGrade - sets the thicknesses (m) of n layers down to a depth. The first layer has the given thickness, and
  each is thicker than the one above it by the same ratio; if the first one is thicker than depth/n, all are equal.
  SamPlasticFind - returns the layer of a body at a depth (m); below all layers the last one. Neither is collective.
*/
PETSC_INTERN void     SamPlasticGrade(PetscInt n, PetscReal first, PetscReal depth, PetscReal thickness[]);
PETSC_INTERN PetscInt SamPlasticFind(const SamPlastic *plastic, PetscReal depth);
/*
  SamPlasticSlide - moves the strain of body 2, which yields, in a stored field by a slide under the grid, m.
  Collective.
  SamPlasticRaise - moves the strain of one of the bodies, in the array of a stored field, up by a depth in each cell:
  the thickness of material removed from its surface, m. Depths below 0 count as 0. Not collective.
*/
PETSC_INTERN PetscErrorCode SamPlasticSlide(const SamPlastic *plastic, const PetscReal slide[2], Vec strain);
PETSC_INTERN PetscErrorCode SamPlasticRaise(const SamPlastic *plastic, PetscInt body, const double removed[],
                                            double strain[]);
/* SamPlasticRead, SamPlasticWrite - read and write the values of cell k of layer l in the array of a stored field. */
PETSC_INTERN void SamPlasticRead(const SamPlastic *plastic, const double state[], PetscInt l, PetscInt k,
                                 SamMisesAt *at);

#endif
