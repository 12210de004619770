/* The temperatures of a contact by its frictional heat, where friction may depend on them. */
#ifndef PETSAM_CONTACTHEAT_H
#define PETSAM_CONTACTHEAT_H

#include "heat.h"

/*
  SamHeatFriction - the change of the coefficient of friction: none up to the temperature `from`, `change` above `from`
  + `over`, linear in between. Temperatures may be relative to any one.
*/
typedef struct {
  PetscReal from, over, change; /* K, K, 1; change 0: friction does not depend on the temperature */
} SamHeatFriction;

/*
  SamHeatTemperatures - computes the temperatures of both surfaces by heat that flows into them.

  Collective.

  In:     pair     - the bodies
          contact  - field of one component, positive in cells in contact
          heat     - heat per area and time (W/m2), 0 outside of contact
          bulk     - temperature of the bulk of body 1 and 2 (K)
  In,out: heat_2   - the part into body 2 (W/m2)
  Out:    surface  - temperatures of both surfaces (K), NULL where it is not wanted
          failed   - why the heat could not be divided; empty: it could

  Errors: those of SamHeatSplit().
*/
PETSC_INTERN PetscErrorCode SamHeatTemperatures(const SamHeatPair *pair, Vec contact, Vec heat, const PetscReal bulk[2],
                                                Vec heat_2, Vec surface[2], char failed[], size_t size);

/* SamHeatRate - heat that depends on the coefficient of friction, by cell: (bound + pressure * change) * rate. */
typedef struct {
  SamGrid grid;
  Vec     pressure, bound, rate; /* Pa; Pa, without the change by temperature; velocity of slip, m/s */
} SamHeatRate;

/*
  SamHeatSolveFriction - finds the temperature of body 1 in contact whose friction makes just the heat that causes it:
  T = T1_bulk + K1 (Q(T) - q2), Newton's method, with GCR for the linear systems (contactheat.c).

  Collective.

  In:     pair, bulk  - as above
          friction    - how friction depends on temperature
          rate        - pressure, bound and velocity of slip
  In,out: temperature - the start, and the solution (K); 0 outside of contact
  Out:    products    - number of applications of T(Q)
          failed      - empty, or why there is no solution

  Errors: those of SamHeatSplit().
*/
PETSC_INTERN PetscErrorCode SamHeatSolveFriction(const SamHeatPair *pair, const PetscReal bulk[2],
                                                 const SamHeatFriction *friction, const SamHeatRate *rate,
                                                 Vec temperature, PetscInt *products, char failed[], size_t size);

/* SamHeatFrictionAt - returns the change of the coefficient at a temperature, and its derivative (1/K). */
PETSC_INTERN double SamHeatFrictionAt(const SamHeatFriction *friction, double temperature, double *by_temperature);

#endif
