/*
  This finds yielding that no layer shows: below the last layer, or inside layers that are thick beside the
  contact. An elastic contact yields first at a depth of 0.48 half widths below a sphere, and of 0.70 below a cylinder;
  no contact yields first deeper than two half widths. So the stress by the tractions and the residual stress of the
  nearest layer are evaluated there, at points between which they vary little.
*/
#include "plasticnewton.h"

#define FIRST  0.48 /* depth, relative to the half width of the contact, at which layers must be thin */
#define DEEP   0.7  /* the deepest such depth at which a contact yields first */
#define NARROW 0.1  /* part of the cells in contact, in the narrowest zones, that is ignored */
/* Depths, relative to the half width, that are checked if they lie below the last layer or in a thick one */
static const double places[] = {0, 0.25, FIRST, DEEP, 1, 1.5, 2};
#define PLACES ((PetscInt)(sizeof(places) / sizeof(places[0])))

/*
  Adds a layer's residual stress and the bulk stress to the tractions' stress at a depth; raises `excess` to the
  largest relative excess over the yield stress.
*/
static PetscErrorCode Look(SamPlastic *p, PetscInt b, PetscReal depth, const double state[], const double residual[],
                           const double *const traction[3], double *excess)
{
  const SamPlasticBody *body  = &p->body[b];
  const PetscInt        cells = p->grid->cells, l = body->first + SamPlasticFind(p, depth - body->top);
  double               *s;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(PARTS * cells, &s));
  PetscCall(SamResidualLoadAt(p->residual[b], depth, traction, s));
  for (PetscInt k = 0; k < cells; k++) {
    SamMisesAt at;
    double     stress[PARTS];

    SamPlasticRead(p, state, l, k, &at);
    for (PetscInt c = 0; c < PARTS; c++)
      stress[c] = s[c * cells + k] + residual[((ptrdiff_t)l * PARTS + c) * cells + k] + body->bulk[c];
    *excess = PetscMax(*excess, SamMisesExcess(&body->material, &at, stress) / body->material.yield);
  }
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticLookOutside(SamPlastic *p, Vec state, Vec pressure, Vec shear, double *thick, double *excess)
{
  const PetscInt cells = p->grid->cells;
  PetscReal      across, half, bottom = 0;
  double        *residual = NULL;
  PetscBool      known    = PETSC_FALSE; /* the residual stress; a rank without cells has no array of it */
  const double  *now, *by_p, *by_q;

  PetscFunctionBegin;
  *thick = *excess = 0;
  PetscCall(SamGridMeasureZones(p->grid, pressure, NARROW, SamElasticityGetTraits(p->elasticity).periodic, &across));
  half = across * p->grid->side[0] / 2;
  if (!(half > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt l = 0; l < p->layers; l++) bottom += p->thickness[l];
  for (PetscInt b = 0; b < p->bodies; b++)
    *thick = PetscMax(*thick, (double)(p->thickness[SamPlasticFind(p, FIRST * half - p->body[b].top)] / half));
  PetscCall(VecGetArrayRead(state, &now));
  PetscCall(VecGetArrayRead(pressure, &by_p));
  PetscCall(VecGetArrayRead(shear, &by_q));
  for (PetscInt k = 0; k < PLACES; k++)
    for (PetscInt b = 0; b < p->bodies; b++) {
      const PetscReal depth = places[k] * half, below = depth - p->body[b].top;

      if (below < 0 || (below < bottom && (*thick <= SAM_PLASTIC_THICK || places[k] > DEEP))) continue;
      if (!known) {
        known = PETSC_TRUE;
        PetscCall(PetscMalloc1(PARTS * p->bodies * p->layers * cells, &residual));
        PetscCall(SamPlasticStress(p, state, NULL, NULL, residual, NULL));
      }
      PetscCall(Look(p, b, depth, now, residual, (const double *const[3]){by_p, by_q, by_q + cells}, excess));
    }
  PetscCall(VecRestoreArrayRead(shear, &by_q));
  PetscCall(VecRestoreArrayRead(pressure, &by_p));
  PetscCall(VecRestoreArrayRead(state, &now));
  PetscCall(PetscFree(residual));
  PetscCall(SamMax(p->grid->comm, 1, excess));
  PetscFunctionReturn(PETSC_SUCCESS);
}
