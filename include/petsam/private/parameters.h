/* Functions of parameters, besides petsam/parameters.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_PARAMETERS_H
#define PETSAM_PRIVATE_PARAMETERS_H

#include <petsam/parameters.h>

/*
  SamParametersAddChecksum - appends a checksum, for instance of data from a file. Not collective. Errors: as above.
*/
PETSC_INTERN PetscErrorCode SamParametersAddChecksum(SamParameters *parameters, const char name[], uint64_t checksum);

/*
  SamParametersAddOptions - appends the values of the options of a table that are `recorded`, from the settings. Not
  collective. Errors: as above.
*/
PETSC_INTERN PetscErrorCode SamParametersAddOptions(SamParameters *parameters, PetscInt count,
                                                    const SamOptionRow rows[], const void *settings);

#endif
