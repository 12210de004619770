/* What all rooms share and the user does not see: differences between PETSc's versions, log events, reductions. */
#ifndef PETSAM_BASEIMPL_H
#define PETSAM_BASEIMPL_H

#include <petsam/base.h>
#include <petscviewer.h>
#include <petscmat.h>
#include <petscpc.h>
#include <math.h>
#include <string.h>

/* ---- differences between PETSc's versions, 3.18 on ---- */
#if PETSC_VERSION_LT(3, 19, 0)
  #define PETSC_SUCCESS 0
#endif
#if PETSC_VERSION_LT(3, 22, 0)
  #define SamGetViewer(comm, prefix, name, viewer, format, set) \
    PetscOptionsGetViewer(comm, NULL, prefix, name, viewer, format, set)
#else
  #define SamGetViewer(comm, prefix, name, viewer, format, set) \
    PetscOptionsCreateViewer(comm, NULL, prefix, name, viewer, format, set)
#endif

/*
  Loops over contiguous doubles, compiled for several generations of x86 and chosen at start, so that an installed
  program needs no -march=native. Only the order of no sum is changed.
*/
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
  !defined(__SANITIZE_ADDRESS__)
  #define SAM_VECTORIZED __attribute__((target_clones("default", "avx2", "avx512f")))
#else
  #define SAM_VECTORIZED
#endif

/* ---- log events, shown by -log_view ---- */
typedef enum {
  SAM_EVENT_SETUP_INFLUENCE,
  SAM_EVENT_FFT_ROWS,
  SAM_EVENT_FFT_COLUMNS,
  SAM_EVENT_FFT_TRANSPOSE,
  SAM_EVENT_APPLY_NORMAL,
  SAM_EVENT_APPLY_TANGENTIAL,
  SAM_EVENT_APPLY_COUPLING,
  SAM_EVENT_PRECONDITION_NORMAL,
  SAM_EVENT_PRECONDITION_TANGENTIAL,
  SAM_EVENT_NORMAL_SOLVE,
  SAM_EVENT_TANGENTIAL_SOLVE,
  SAM_EVENT_CHECK,
  SAM_EVENT_OUTPUT,
  SAM_EVENT_CHECKPOINT,
  SAM_EVENT_COUNT
} SamEvent;
PETSC_EXTERN PetscLogEvent SamEvents[SAM_EVENT_COUNT];
PETSC_EXTERN PetscClassId  SAM_CLASSID;

/* ---- memory ---- */
/*
  SamAllocate, SamAllocateZeros - arrays of any size, in large pages where they are large, to be freed by SamFree().
  PETSC_ERR_MEM with the size when there is no memory.
*/
PETSC_EXTERN PetscErrorCode SamAllocate(size_t bytes, void *pointer);
PETSC_EXTERN PetscErrorCode SamAllocateZeros(size_t bytes, void *pointer);
PETSC_EXTERN void           SamFree(void *pointer);

/* SamZero - sets an array to zero without writing to where it is: what the system has not given memory yet stays so. */
PETSC_EXTERN void SamZero(PetscInt n, double x[]);

/*
  SamReturnMemory - gives the system back what was freed and the C library keeps. What is allocated next has to be
  mapped anew, which costs time: for the end of long stages.
*/
PETSC_EXTERN void SamReturnMemory(void);

/* ---- checksums ---- */

/* SamHashMix - the finalizer of MurmurHash3 (A. Appleby, public domain): all bits of x act on all bits of the result. */
static inline uint64_t SamHashMix(uint64_t x)
{
  x = (x ^ x >> 33) * UINT64_C(0xff51afd7ed558ccd);
  x = (x ^ x >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
  return x ^ x >> 33;
}

/* SamHashBits - the bits of a number. */
static inline uint64_t SamHashBits(double value)
{
  uint64_t bits;

  memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/* ---- reductions over the ranks of small arrays of doubles, in place. Collective. ---- */
PETSC_EXTERN PetscErrorCode SamSum(MPI_Comm comm, PetscInt n, double values[]);
PETSC_EXTERN PetscErrorCode SamMax(MPI_Comm comm, PetscInt n, double values[]);

/*
  SamTotal - a sum kept in twice the digits of a double. Solvers add up a grid row by row, and a row is on one rank
  whole: summed like this the result does not depend on which rows are where, and what follows from it is the same on
  any number of ranks. Source: Knuth's exact addition; Hida, Li and Bailey 2001.
*/
typedef struct {
  double sum, rest;
} SamTotal;

static inline void SamAdd(SamTotal *total, double value)
{
  const double sum = total->sum + value, part = sum - total->sum;

  total->rest += (total->sum - (sum - part)) + (value - part);
  total->sum = sum;
}
static inline void SamAddAll(PetscInt n, SamTotal totals[], const double values[])
{
  for (PetscInt k = 0; k < n; k++) SamAdd(&totals[k], values[k]);
}
#define SAM_TOTALS 16 /* most at a time */
/* SamSumTotals - the totals over the ranks, as doubles. Collective. */
PETSC_EXTERN PetscErrorCode SamSumTotals(MPI_Comm comm, PetscInt n, const SamTotal totals[], double sums[]);

/* The larger of the two; infinite when the second is not a number, which a plain comparison would pass over. */
static inline double SamLarger(double most, double value)
{
  if (value <= most) return most;
  return isnan(value) ? INFINITY : value;
}

/* SamTypesGet - the names in a registry, in alphabetical order; the caller frees the array. Not collective. */
PETSC_EXTERN PetscErrorCode SamTypesGet(PetscFunctionList list, const char ***types, int *count);
/* SamTypesList - the same as a sentence has them: a, b or c. Not collective. */
PETSC_EXTERN PetscErrorCode SamTypesList(PetscFunctionList list, char text[], size_t size);

/* SamPrintHelp - PETSC_TRUE while options are only listed for the user. */
PETSC_EXTERN PetscErrorCode SamPrintHelp(PetscBool *print);

#endif
