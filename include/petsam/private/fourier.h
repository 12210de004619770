/* The distributed pruned Fourier transform and convolution with kernels that are even or odd in x and in y. */
#ifndef PETSAM_PRIVATE_FOURIER_H
#define PETSAM_PRIVATE_FOURIER_H

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

/*
  SamFourier - transforms of fields on a grid, for filters that act in the frequency domain. No array of the padded size
  exists: rows are transformed one by one, columns a few at a time in a buffer that stays in cache, and only the ny rows
  of half spectra are stored. Ranks on one node keep these rows in shared memory; others exchange rows for columns by
  FFTW's transposes. All transforms on a communicator share this memory, so only one may be under way at a time.
*/
typedef struct _n_SamFourier *SamFourier;

typedef enum {
  SAM_FOURIER_PERIODIC, /* period hx * hy */
  SAM_FOURIER_PADDED    /* period 2hx * 2hy, the field being zero outside the grid: convolution is not cyclic */
} SamFourierMode;

/* SamFourierPeriod - the choice of the periods hx, hy of a grid's transforms. */
typedef enum {
  SAM_FOURIER_FAST, /* even numbers >= nx, ny that FFTW transforms fast */
  SAM_FOURIER_EXACT /* nx, ny without change: the grid is one period */
} SamFourierPeriod;

#define SAM_FOURIER_FIELDS 3 /* maximum number of fields in one pass */

/*
  SamFourierBlock - a few columns of spectra, handed to a filter. Phase 0 holds the even frequencies along y, phase 1
  (only in padded mode) the odd ones: entry m of phase f of column b is frequency ky = phases * m + f of phases * hy,
  kx = first + b of phases * hx, at data[field][(f * width + b) * stride + m][re, im] in double precision, or at
  single[field][...] in single precision; the other array is NULL.
  A grid of one row has no frequencies along y, and hy = phases = stride = 1 in both modes.
*/
typedef struct {
  SamFourierMode mode;
  PetscInt       phases; /* 1 periodic, 2 padded */
  PetscInt       hx, hy;
  PetscInt       first;   /* frequency kx of the first column */
  PetscInt       local;   /* index of that column among this rank's columns */
  PetscInt       columns; /* columns in this block, at most width */
  PetscInt       width, stride;
  double (*data[SAM_FOURIER_FIELDS])[2];
  float (*single[SAM_FOURIER_FIELDS])[2];
} SamFourierBlock;

/*
  SamFourierFilter - an operation on spectra: `apply` replaces the spectra of the input fields in a block by those of
  the output fields, in place. It is called once per block, with the context.
*/
typedef struct {
  SamFourierMode mode;
  PetscInt       n_in, n_out; /* fields, at most SAM_FOURIER_FIELDS each */
  void (*apply)(const SamFourierBlock *block, const void *context);
  const void *context;
} SamFourierFilter;

/* SamFourierFastLength - returns an even length >= n for which FFTW is fast. Not collective. */
PETSC_INTERN PetscInt SamFourierFastLength(PetscInt n);
/*
  SamFourierCreate - creates transforms; settings NULL: the default ones. Plans are created at their first use.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamFourierCreate(SamGrid grid, SamFourierPeriod period, const SamFourierSettings *settings,
                                             SamFourier *fourier);
PETSC_INTERN PetscErrorCode SamFourierDestroy(SamFourier *fourier);
/*
  SamFourierTrim - frees the memory that all transforms on the communicator share, if it is large, until one of them
  needs it again. Collective.
*/
PETSC_INTERN PetscErrorCode SamFourierTrim(SamFourier fourier);
/* SamFourierGetPeriods - gets the periods hx, hy, without the doubling of padded mode. Not collective. */
PETSC_INTERN PetscErrorCode SamFourierGetPeriods(SamFourier fourier, PetscInt *hx, PetscInt *hy);

/*
  SamFourierApply - computes out = inverse transform of filter(transform of in). Fields are local arrays of (rows, nx);
  `out` may be the same arrays as `in`. Transforms are not normalised: the filter brings in 1/(period in x * period in
  y). Collective.
*/
PETSC_INTERN PetscErrorCode SamFourierApply(SamFourier fourier, const SamFourierFilter *filter,
                                            const double *const in[], double *const out[]);
/*
  SamFourierApplySingle - does the same in single precision, at half the cost, for results that are refined afterwards.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamFourierApplySingle(SamFourier fourier, const SamFourierFilter *filter,
                                                  const float *const in[], float *const out[]);

/*
  SamFourierCountTraffic - returns what a rank sends to others for one field of a pass, there and back, where rows are
  exchanged for columns by messages. `n`: cells along x and y; `real`: size of a number, bytes. Not collective.
*/
typedef struct {
  double bytes, messages;
} SamFourierTraffic;

PETSC_INTERN SamFourierTraffic SamFourierCountTraffic(const PetscInt n[2], SamFourierPeriod period, SamFourierMode mode,
                                                      size_t real, PetscInt ranks, PetscInt rank);

/*
  SamKernel - the transform of a kernel in padded mode, for convolution without wrap-around. A kernel is even or odd in
  x and in y, so its transform is real (or imaginary) and one quadrant suffices: (hx + 1)(hy + 1) doubles over
  all ranks. The values contain the normalisation of the pair of transforms.
*/
typedef struct _n_SamKernel *SamKernel;

/*
  SamKernelRows - a function that computes the values of n kernels at the lags (i, j), i = 0 ... count - 1, j >= 0:
  values[k][i] for the k-th kernel. For odd parity the values at lag 0 are not used.
*/
typedef void (*SamKernelRows)(PetscInt j, PetscInt count, double *const values[], const void *context);

/*
  SamKernelsCreate - tabulates and transforms n kernels, at most SAM_FOURIER_FIELDS, whose values are computed together;
  odd[k]: true if the k-th kernel is odd in x, and in y. Collective.
*/
PETSC_INTERN PetscErrorCode SamKernelsCreate(SamFourier fourier, PetscInt n, const PetscBool odd[][2],
                                             SamKernelRows rows, const void *context, SamKernel kernels[]);
PETSC_INTERN PetscErrorCode SamKernelDestroy(SamKernel *kernel);
/*
  SamConvolve - computes out[o] = sum_i scale[o][i] * (kernel[o][i] convolved with in[i]), exact up to rounding. A NULL
  kernel is zero. Fields are local arrays of (rows, nx); out may be the same arrays as in. Collective.
  Source: Liu, Wang and Liu 2000, Wear 243, 101-111.
*/
typedef struct {
  PetscInt  n_in, n_out;
  SamKernel kernel[SAM_FOURIER_FIELDS][SAM_FOURIER_FIELDS];
  double    scale[SAM_FOURIER_FIELDS][SAM_FOURIER_FIELDS];
} SamKernelMatrix;

PETSC_INTERN PetscErrorCode SamConvolve(SamFourier fourier, const SamKernelMatrix *matrix, const double *const in[],
                                        double *const out[]);
/*
  SamConvolveSum - computes the sum of the convolutions of one field with n kernels: a kernel without parity is its even
  part plus its odd part. One transform and its inverse serve all. out may be the same array as in. Collective.
*/
PETSC_INTERN PetscErrorCode SamConvolveSum(SamFourier fourier, PetscInt n, const SamKernel kernels[], const double in[],
                                           double out[]);
/*
  SamKernelMatrixAdd - adds the products with a matrix of 3 x 3 kernels for columns of spectra that are kept between
  passes of transforms: those of a phase of column b of a block, whose data are not used. A grid of one row has a single
  column, of all frequencies along x; the block then has hy of them. `scratch`: 3 columns of hy entries. Not collective.
*/
PETSC_INTERN PetscErrorCode SamKernelMatrixAdd(const SamKernelMatrix *matrix, const SamFourierBlock *block,
                                               PetscInt phase, PetscInt b, double (*const in[])[2],
                                               double (*const out[])[2], double (*scratch)[2]);
/*
  SamConvolveSingle - computes `factor` times the same in single precision, for one field and an even kernel, or for two
  fields and a symmetric matrix whose off-diagonal kernel is odd in x and in y. `factor` scales the result to the range
  of floats. Collective.
*/
PETSC_INTERN PetscErrorCode SamConvolveSingle(SamFourier fourier, const SamKernelMatrix *matrix, double factor,
                                              const float *const in[], float *const out[]);

#endif
