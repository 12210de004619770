/* The time of a step on other numbers of ranks and nodes. */
#ifndef PETSAM_SCALING_H
#define PETSAM_SCALING_H

#include <petsam/private/fourier.h>
#include <petsam/private/simulation.h>

/* SamScaling - a step on the ranks of this run: its time, and what it is made of. */
typedef struct {
  PetscInt  n[2];         /* cells along x and y */
  PetscBool periodic;     /* the operator has the grid as its period */
  PetscBool friction;     /* a step finds shear, too */
  PetscBool send;         /* ranks of a node send messages, too */
  int       ranks, cores; /* all, and at most on a node */
  double    seconds;
} SamScaling;

/* SamScalingPredict - predicts the time of a step on so many ranks, on nodes of so many cores. Not collective. */
PETSC_INTERN SamScalingTime SamScalingPredict(const SamScaling *scaling, int ranks, int cores);

#endif
