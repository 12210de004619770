/* The inside of the law of heat. */
#ifndef PETSAM_HEATLAW_H
#define PETSAM_HEATLAW_H

#include "contactheat.h"
#include <petsam/private/lawimpl.h>

/* A change of friction or wear by temperature, as the user gives it: T0, dT, and the change, or the factor. */
enum { SAM_HEAT_FROM, SAM_HEAT_OVER, SAM_HEAT_CHANGE, SAM_HEAT_CHANGES };

typedef struct {
  int         kind;
  PetscReal   conductivity[2], capacity[2], bulk[2], speed[2], resistance;
  PetscReal   change[SAM_HEAT_CHANGES], wear[SAM_HEAT_CHANGES];
  PetscInt    changes, wears; /* 0, or SAM_HEAT_CHANGES: friction, or wear, depends on the temperature */
  PetscReal   rolling;        /* speed of rolling, m/s */
  SamHeatPair pair;           /* body[0] NULL: not created yet */
  PetscReal   duration;       /* of the step, s */
  char        failed[192];    /* why the last bound has no temperature; empty: it has one */
  PetscBool   clipped;        /* the last bound would have had friction below 0 in a cell of this rank */
  PetscBool   timeless;       /* there is frictional work in a step without duration */
} SamHeatLaw;

#define SAM_TEMPERATURE_1 "temperature_1"
/* SamHeatLawPrepare - creates the operators at their first use. Collective. */
PETSC_INTERN PetscErrorCode SamHeatLawPrepare(SamLaw law);
/* SamHeatLawBound - the law's method `bound`: the change of friction by temperature (heatbound.c). Collective. */
PETSC_INTERN PetscErrorCode SamHeatLawBound(SamLaw law, const SamBoundAt *at, const SamBound *bound);

#endif
