/*
  Bodies that relax in a steady state, of rolling or of sliding without friction: their material streams along x
  through the contact, at the speed V, and has moved by V theta in the time theta of a term. In rolling both bodies
  stream towards -x; of surfaces that slide, one may stand still, and has crept to its end. Products are those of the
  inner bodies that contain the creep (halfspace/streaming.c, periodic/periodic.c); nothing is remembered from step to
  step.

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

/* Makes the products those of bodies whose material streams at the speeds of the terms. */
static PetscErrorCode Stream(SamElasticity e)
{
  SamViscous *const v = (SamViscous *)e->data;
  SamStream         stream;

  PetscFunctionBegin;
  stream.terms = v->terms;
  for (PetscInt j = 0; j < v->terms; j++) {
    stream.length[j] = -(double)(v->term[j].speed * v->term[j].time);
    PetscCall(PetscArraycpy(stream.value[j], v->term[j].value, SAM_PAIR_CONSTANTS));
  }
  PetscCall((*e->inner->ops.setstream)(e->inner, &stream));
  v->streams       = PETSC_TRUE;
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

PetscErrorCode SamViscousStream(SamElasticity e, const SamOptions *from)
{
  static const SamOptionRow row = {"rolling_speed", "speed of rolling",
                                   SAM_OPTION_REAL, .range = SAM_RANGE_POSITIVE,
                                   .unit = "m/s",   .missing = "required by -rolling steady with bodies that relax"};
  SamViscous *const         v   = (SamViscous *)e->data;
  PetscReal                 speed;

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &speed, NULL));
  v->speed[0] = v->speed[1] = -speed;
  for (PetscInt j = 0; j < v->terms; j++) v->term[j].speed = -speed;
  PetscCall(Stream(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousReadSpeeds(const SamOptions *from, PetscReal speed[2], const char **named)
{
#define ROW(body) \
  { \
    "body" body "_speed", "speed () of body " body "'s material along x", SAM_OPTION_REAL, \
      .unit = "m/s", .range = SAM_RANGE_ANY, .excludes = "rolling" \
  }
  static const SamOptionRow rows[2] = {ROW("1"), ROW("2")};
  PetscBool                 given;

  PetscFunctionBegin;
  *named = NULL;
  for (int b = 0; b < 2; b++) {
    PetscCall(SamOptionsRead(from, NULL, 1, &rows[b], &speed[b], &given));
    if (given) *named = rows[b].name;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousSlide(SamElasticity e, const char named[])
{
  PetscFunctionBegin;
  PetscCall(Stream(e));
  e->option        = named;
  e->traits.slides = PETSC_TRUE;
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
  PetscCall((*(*symmetric)->inner->ops.setstream)((*symmetric)->inner, &none));
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
