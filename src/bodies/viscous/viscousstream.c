/*
  Bodies that relax while the contact rolls over them in a steady state: their material streams towards -x, and has
  moved by V theta in the time theta of a term. Products are those of half-spaces that contain the creep
  (halfspace/streaming.c); nothing is remembered from step to step.

  The normal operator is not symmetric. For waves along x it is J(k) = 1 + sum a_j/(1 - i k V theta_j) times that under
  a sudden load, and the one that solvers need in its place, a number m times that, should have a small |1 - J/m| for
  all waves: with m = (1 + J(0))/2 it is (J(0) - 1)/(J(0) + 1) at most, and it is below 1 for any m above J(0)/2.
*/
#include "viscous.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/base.h>
#include <petsam/private/parameters.h>

#define OPERATORS 150 /* memory per cell of the symmetric operator and of the parts of the other parity, bytes */

_Static_assert(SAM_VISCOUS_TERMS <= SAM_STREAM_TERMS, "a stream holds all terms");

PetscErrorCode SamViscousStream(SamElasticity e, const SamOptions *from)
{
  static const SamOptionRow row = {"rolling_speed", "speed of rolling",
                                   SAM_OPTION_REAL, .range = SAM_RANGE_POSITIVE,
                                   .unit = "m/s",   .missing = "required by -rolling steady with bodies that relax"};
  SamViscous *const         v   = (SamViscous *)e->data;
  SamStream                 stream;

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &v->speed, NULL));
  stream.terms = v->terms;
  for (PetscInt j = 0; j < v->terms; j++) {
    stream.length[j] = (double)(v->speed * v->term[j].time);
    PetscCall(PetscArraycpy(stream.value[j], v->term[j].value, SAM_PAIR_CONSTANTS));
  }
  PetscCall(SamHalfSpaceStream(e->inner, &stream));
  e->bytes         = OPERATORS;
  e->traits.skewed = PETSC_TRUE;
  e->ops.declare   = NULL;
  e->ops.begin     = NULL;
  e->ops.displace  = NULL;
  e->ops.advance   = NULL;
  e->ops.examine   = NULL;
  e->ops.doubt     = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousCreateSymmetric(SamElasticity e, SamElasticity *symmetric)
{
  const SamViscous *from     = ((const SamViscous *)e->data)->finest;
  const PetscInt    first[2] = {0, 0};
  const SamStream   none     = {.terms = 0};
  SamViscous       *v;

  PetscFunctionBegin;
  PetscCall(SamElasticityCreateLike(e, e->grid, first, symmetric));
  PetscCall(SamHalfSpaceStream((*symmetric)->inner, &none));
  (*symmetric)->traits.skewed = PETSC_FALSE;
  v                           = (SamViscous *)(*symmetric)->data;
  v->terms                    = from->terms;
  v->finest                   = v;
  for (PetscInt j = 0; j < v->terms; j++) {
    v->term[j]          = from->term[j];
    v->term[j].step.now = 0.5;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
