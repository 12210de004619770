/* Operators for the tests of elasticity. */
#ifndef PETSAM_ELASTICITIES_H
#define PETSAM_ELASTICITIES_H

#include "fields.h"

#include <petsam/elasticity.h>

/* Sizes that do not divide, odd, prime, and fewer rows than ranks; cells that are not square. */
static const PetscInt sizes[][2] = {{13, 9}, {7, 5}, {16, 11}, {5, 2}, {2, 17}};
enum { NUM_SIZES = sizeof(sizes) / sizeof(sizes[0]) };

/* Two bodies that have nothing in common. */
static const double young[2] = {210e9, 3e9}, poisson[2] = {0.3, 0.2};

static inline SamElasticity NewCompliance(SamGrid grid, SamPair pair)
{
  SamElasticity C;

  sam_call(SamElasticityCreate(grid, pair, &C));
  return C;
}

static inline SamElasticity NewDissimilar(SamGrid grid)
{
  return NewCompliance(grid, NewPair(young[0], poisson[0], young[1], poisson[1]));
}

typedef PetscErrorCode (*Product)(SamElasticity, Vec, Vec);

#endif
