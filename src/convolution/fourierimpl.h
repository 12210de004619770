/* The inside of SamFourier, shared by the files of this room. */
#ifndef PETSAM_FOURIERIMPL_H
#define PETSAM_FOURIERIMPL_H

#include "../base/baseimpl.h"
#include <petsam/convolution.h>
#include <fftw3-mpi.h>

/* Columns of one mode: 0 ... n-1 along x, of which this rank works on start ... start + count - 1. */
typedef struct {
  ptrdiff_t n, start, count;
} SamColumns;

/* Plans and buffers of one precision; made when it is first used. */
#define SAM_TRANSFORM(Name, Real, Plan) \
  typedef struct { \
    PetscInt fields; /* for which buffers and transposes were made */ \
    Plan     forward[2][SAM_FOURIER_FIELDS], backward[2][SAM_FOURIER_FIELDS]; /* rows to columns and back by mode, several ranks only */ \
    Plan     r2c[2], c2r[2]; /* one row, by mode */ \
    Plan     up, down;       /* one column of hy, forward and backward, out of place */ \
    Real    *row;            /* one row, padded */ \
    Real (*line)[2];         /* its transform */ \
    Real (*twiddle)[2];      /* exp(-i pi j/hy), j < ny */ \
    Real (*staging)[2];      /* a block of columns as gathered */ \
    Real (*twisted)[2];      /* one column times the twiddles */ \
    Real (*buffer)[2];       /* a block of columns, both phases, all fields */ \
  } Name

SAM_TRANSFORM(SamTransformDouble, double, fftw_plan);
SAM_TRANSFORM(SamTransformSingle, float, fftwf_plan);

struct _n_SamFourier {
  SamGrid            grid;
  PetscMPIInt        ranks;
  unsigned           effort;     /* FFTW's planning flag */
  ptrdiff_t          hx, hy;
  PetscInt           stride;     /* between columns in the buffers */
  SamColumns         columns[2]; /* by mode */
  SamTransformDouble in_double;
  SamTransformSingle in_single;
  void              *slab[SAM_FOURIER_FIELDS + 1]; /* half spectra of the fields' rows and columns, or a kernel's on its way; room for doubles */
};

/* Memory for FFTW's arrays; PETSC_ERR_MEM with the size when there is none. */
PETSC_INTERN PetscErrorCode SamFourierAllocate(size_t bytes, void *pointer);

/* On several ranks field k has its rows in slab k + 1 and its columns in slab k, on one both in slab k. */
static inline PetscInt SamFourierRowSlab(SamFourier F, PetscInt field)
{
  return F->ranks > 1 ? field + 1 : field;
}
/* This rank's rows and columns of a kernel's quadrant (hy + 1, hx + 1); returns how many reals FFTW wants for them. */
PETSC_INTERN ptrdiff_t SamFourierDivideQuadrant(SamFourier fourier, ptrdiff_t *rows, ptrdiff_t *row_start, ptrdiff_t *columns);
/* Makes the slabs for that many fields, or for a kernel's quadrant. Collective. */
PETSC_INTERN PetscErrorCode SamFourierReserveSlabs(SamFourier fourier, PetscInt fields);
PETSC_INTERN PetscErrorCode SamFourierCheckPlan(const void *plan);

PETSC_INTERN void SamTransformDestroyDouble(SamFourier fourier);
PETSC_INTERN void SamTransformDestroySingle(SamFourier fourier);

#endif
