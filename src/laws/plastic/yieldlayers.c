/*
  The layers of a body that yields: each is thicker than the one above it by the same ratio. The stress of a contact
  varies over a length in proportion to the depth. So layers whose thickness is a fixed part of their depth resolve it
  for any size of the contact, which need not be known.
*/
#include "plasticnewton.h"

#define HALVINGS 60 /* of the interval that contains the ratio */

/* Returns the depth of n layers, the first of which has thickness 1. */
static double DepthOf(PetscInt n, double ratio)
{
  return ratio > 1 ? expm1((double)n * log(ratio)) / (ratio - 1) : (double)n;
}

void SamPlasticGrade(PetscInt n, PetscReal first, PetscReal depth, PetscReal thickness[])
{
  const double wanted = (double)(depth / first);
  double       low = 1, high = PetscMax(wanted, 1), left = 1;

  for (PetscInt k = 0; k < HALVINGS && wanted > (double)n; k++) {
    const double middle = (low + high) / 2;

    if (DepthOf(n, middle) < wanted)
      low = middle;
    else
      high = middle;
  }
  for (PetscInt l = 0; l < n; l++) {
    thickness[l] = wanted > (double)n ? depth * (PetscReal)(left / DepthOf(n, low)) : depth / (PetscReal)n;
    left *= low;
  }
}

PetscInt SamPlasticFind(const SamPlastic *p, PetscReal depth)
{
  PetscReal top = 0;

  for (PetscInt l = 0; l < p->layers; l++) {
    top += p->thickness[l];
    if (depth < top) return l;
  }
  return p->layers - 1;
}
