/* Settings of the Fourier transforms for the convolutions on a grid. */
#ifndef PETSAM_FOURIER_H
#define PETSAM_FOURIER_H

#include <petsam/grid.h>

/* SamFourierEffort - the effort with which FFTW searches for fast transforms. */
typedef enum { SAM_FOURIER_ESTIMATE, SAM_FOURIER_MEASURE, SAM_FOURIER_PATIENT } SamFourierEffort;

/* SamFourierSettings - the settings of transforms; zeros are the defaults. */
typedef struct {
  SamFourierEffort effort;
  PetscBool        send; /* true: ranks exchange rows and columns by messages, even if they could share memory */
} SamFourierSettings;

/*
  SamFourierSettingsFromOptions - reads the settings of transforms from the options.

  Collective on the communicator of the options.

  In,out: settings - the settings; on entry the defaults
  In:     from     - communicator and prefix of the options

  Options: -fft_effort, -fft_exchange.
  Errors: SAM_ERR_USER for a wrong value.
*/
PETSC_EXTERN PetscErrorCode SamFourierSettingsFromOptions(SamFourierSettings *settings, const SamOptions *from);

#endif
