/* How the Fourier transforms of a grid's convolutions are made. */
#ifndef PETSAM_FOURIER_H
#define PETSAM_FOURIER_H

#include <petsam/grid.h>

/* How long FFTW tries transforms out before it chooses one. */
typedef enum { SAM_FOURIER_ESTIMATE, SAM_FOURIER_MEASURE, SAM_FOURIER_PATIENT } SamFourierEffort;

/* How transforms are made; all zero is the default. */
typedef struct {
  SamFourierEffort effort;
  PetscBool        send; /* rows become columns by messages, also where the ranks could share memory */
} SamFourierSettings;

/* SamFourierSettingsFromOptions - from -fft_effort and -fft_exchange. Collective. Errors: SAM_ERR_USER. */
PETSC_EXTERN PetscErrorCode SamFourierSettingsFromOptions(SamFourierSettings *settings, const SamOptions *from);

#endif
