/* The inside of SamFourier, shared by the files of this room. */
#ifndef PETSAM_FOURIERIMPL_H
#define PETSAM_FOURIERIMPL_H

#include "../base/baseimpl.h"
#include <petsam/convolution.h>
#include <fftw3-mpi.h>

/* Columns that are transformed together: two cache lines of each row are read and written at once. */
#define COLUMN_BLOCK 8

/* Columns of one mode: 0 ... n-1 along x, of which this rank works on start ... start + count - 1. */
typedef struct {
  ptrdiff_t n, start, count;
  fftw_plan forward[SAM_FOURIER_FIELDS], backward[SAM_FOURIER_FIELDS]; /* rows to columns and back, several ranks only */
  fftw_plan r2c, c2r;                                                  /* one row */
} SamColumns;

struct _n_SamFourier {
  SamGrid    grid;
  PetscMPIInt ranks;
  unsigned   effort;            /* FFTW's planning flag */
  ptrdiff_t  hx, hy;
  SamColumns columns[2];        /* by mode */
  fftw_plan  up, down;          /* one column of hy, forward and backward, out of place */
  double    *row;               /* one row, padded */
  double (*twiddle)[2];         /* exp(-i pi j/hy), j < ny */
  double (*staging)[2];         /* COLUMN_BLOCK columns as gathered */
  double (*twisted)[2];         /* one column times the twiddles */
  double (*buffer)[2];          /* COLUMN_BLOCK columns, both phases, all fields */
  PetscInt   stride;            /* between columns in the buffer */
  PetscInt   buffer_fields;     /* fields for which buffer, slabs and transposes were made */
  double (*slab[SAM_FOURIER_FIELDS + 1])[2];
};

/* Makes room for that many fields. Collective. */
PETSC_INTERN PetscErrorCode SamFourierReserve(SamFourier fourier, PetscInt fields);

/* Memory for FFTW's arrays; PETSC_ERR_MEM with the size when there is none. */
PETSC_INTERN PetscErrorCode SamFourierAllocate(size_t bytes, void *pointer);

#endif
