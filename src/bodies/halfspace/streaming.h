/* Kernels of half-spaces of which one relaxes while its material streams through the contact (streaming.c). */
#ifndef PETSAM_STREAMING_H
#define PETSAM_STREAMING_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/halfspace.h>

/*
  SamStreamKernel - a kernel that is even or odd in x, of any constants of a pair: its values at the lags (i, j), i = 0
  ... n - 1, and at one lag, which may be far.
*/
typedef struct {
  PetscBool odd;
  void (*row)(const void *context, const double constants[], PetscInt j, PetscInt n, double values[]);
  double (*cell)(const void *context, const double constants[], ptrdiff_t i, PetscInt j);
  const void *context;
} SamStreamKernel;

/*
  SamStreamRowsCreate - prepares rows of up to `lags` lags of cells of the length dx, m; the stream is borrowed. Not
  collective.
  SamStreamRow - computes the kernel of material that streams at the lags (i, j), i = 0 ... n - 1: values[0] is its part
  of the parity of the kernel without creep, values[1] that of the other one. Not collective.
*/
typedef struct _n_SamStreamRows *SamStreamRows;
PETSC_INTERN PetscErrorCode SamStreamRowsCreate(const SamStream *stream, double dx, PetscInt lags, SamStreamRows *);
PETSC_INTERN PetscErrorCode SamStreamRowsDestroy(SamStreamRows *);
PETSC_INTERN void           SamStreamRow(SamStreamRows rows, const SamStreamKernel *kernel, PetscInt j, PetscInt n,
                                         double *const values[2]);

#endif
