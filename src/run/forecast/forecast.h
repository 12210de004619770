/* A run before its first step: what it rejects, and what it will take. */
#ifndef PETSAM_FORECAST_H
#define PETSAM_FORECAST_H

#include "../steps/simulationimpl.h"

/*
  SamSimulationCheckProgram - rejects laws that are incompatible with the other options, moments and rotations that the
  bodies do not have, and values that laws reject, by the name that the user gave. Collective. Errors: SAM_ERR_USER.
  SamSimulationCheckSteps - rejects a load history with a step that the contact cannot take; checks the ends of rows
  first, since their values are those of the file. Collective. Errors: PETSC_ERR_ARG_OUTOFRANGE, SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamSimulationCheckProgram(SamSimulation simulation, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamSimulationCheckSteps(SamSimulation simulation);
/*
  SamSimulationEstimateShares - estimates from the largest normal load, by a closed-form solution, the share of this
  rank's cells that will be in contact, and that of the grid's cells that the operator's part will have, 0: no part.
  Not collective.
*/
PETSC_INTERN PetscErrorCode SamSimulationEstimateShares(SamSimulation simulation, SamSimulationNeeds *needs);
/* SamSimulationGuessTime - estimates the time of a step on this machine, and on other numbers of ranks. Collective. */
PETSC_INTERN PetscErrorCode SamSimulationGuessTime(SamSimulation simulation, SamSimulationStart *start);

#endif
