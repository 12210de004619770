/* The inside of SamFourier, shared by the files of this folder. */
#ifndef PETSAM_FOURIERIMPL_H
#define PETSAM_FOURIERIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/private/fourier.h>
#include <fftw3-mpi.h>

/* Columns 0 ... n-1 along x of one mode; this rank works on start ... start + count - 1 */
typedef struct {
  ptrdiff_t n, start, count;
} SamColumns;

/* Transforms of lines of one length and precision, see line.h. */
#define SAM_LINE(Name, Real, Plan) \
  typedef struct { \
    ptrdiff_t n, part, shift; /* length of a line and of a part; 2^shift parts */ \
    Plan      up, down; \
    Real (*root)[2]; /* exp(-2 pi i q k/n), k < part, for q = 1, 2, 3, of four parts */ \
  } Name

SAM_LINE(SamLineDouble, double, fftw_plan);
SAM_LINE(SamLineSingle, float, fftwf_plan);

/* Plans and buffers of one precision, created at their first use */
#define SAM_TRANSFORM(Name, Real, Plan, Line) \
  typedef struct { \
    PetscInt fields;                          /* for which there are buffers and transposes */ \
    PetscInt version;                         /* of the slabs that the transposes were made for */ \
    Plan     forward[2][SAM_FOURIER_FIELDS];  /* rows to columns, by mode; without shared memory only */ \
    Plan     backward[2][SAM_FOURIER_FIELDS]; /* the way back */ \
    Line     rows[2];   /* one row, by mode: half as many complex numbers; if its length is odd, as many */ \
    Line     column;    /* one column of hy */ \
    Real (*turn[2])[2]; /* i exp(i pi k/n), k <= n, half a row's length, by mode; NULL if it is odd */ \
    Real (*row)[2];     /* one row, padded: two reals a number */ \
    Real (*line)[2];    /* its transform, and an entry more */ \
    Real (*mirror)[2];  /* the same from its end to its beginning */ \
    Real (*twiddle)[2]; /* exp(-i pi j/hy), j < ny, at the places of a column's entries */ \
    Real (*staging)[2]; /* a block of columns as gathered */ \
    Real (*twisted)[2]; /* one column times the twiddles */ \
    Real (*buffer)[2];  /* a block of columns, both phases, all fields */ \
  } Name

SAM_TRANSFORM(SamTransformDouble, double, fftw_plan, SamLineDouble);
SAM_TRANSFORM(SamTransformSingle, float, fftwf_plan, SamLineSingle);

/* Memory for a field's half spectrum. */
typedef struct {
  size_t bytes;  /* on each rank; 0: none yet */
  void  *own;    /* memory of this rank */
  void **of;     /* memory of every rank; only in shared memory */
  size_t mapped; /* size for all ranks; only in shared memory */
} SamSlab;

/* SamWorkspace - the slabs of all transforms on a communicator; see workspace.c. */
typedef struct {
  MPI_Comm    user; /* communicator of the grids, whose attribute this workspace is */
  MPI_Comm    comm; /* a duplicate for its own messages */
  PetscMPIInt ranks, rank;
  PetscInt    references;
  PetscBool   send;    /* must not share memory */
  PetscBool   shared;  /* shares memory */
  PetscInt    version; /* version of the slabs' addresses */
  SamSlab     slab[SAM_FOURIER_FIELDS + 1];
} * SamWorkspace;

/*
  SamWorkspaceGet - returns a reference to the workspace of a communicator, created at the first call; transforms that
  must `send` have a separate one. SamWorkspaceRelease releases the reference. Collective.
*/
PETSC_INTERN PetscErrorCode SamWorkspaceGet(MPI_Comm comm, PetscBool send, SamWorkspace *workspace);
PETSC_INTERN PetscErrorCode SamWorkspaceRelease(SamWorkspace *workspace);
/* SamWorkspaceTrim - frees the slabs until they are reserved again. Collective. */
PETSC_INTERN PetscErrorCode SamWorkspaceTrim(SamWorkspace workspace);
/* SamWorkspaceReserve - makes slabs for this number of fields, of at least this number of bytes on every rank.
   Collective. */
PETSC_INTERN PetscErrorCode SamWorkspaceReserve(SamWorkspace workspace, size_t bytes, PetscInt fields);
/* SamWorkspaceSynchronize - makes all writes to shared slabs visible to all ranks. Collective. */
PETSC_INTERN PetscErrorCode SamWorkspaceSynchronize(SamWorkspace workspace);
/* True if a transposition sends data between ranks. */
static inline PetscBool SamWorkspaceTransposes(SamWorkspace w)
{
  return w->ranks > 1 && !w->shared;
}

/* The transform of a kernel (kernel.c). */
struct _n_SamKernel {
  PetscBool odd_x, odd_y;
  ptrdiff_t columns; /* number of this rank's columns */
  double   *values;  /* shape (columns, hy + 1); for a single row (columns) */
};

struct _n_SamFourier {
  SamGrid            grid;
  PetscBool          row;    /* fields have one row, and are transformed along x only */
  unsigned           effort; /* FFTW's planning flag */
  ptrdiff_t          hx, hy;
  PetscInt           stride;     /* between columns in the buffers */
  SamColumns         columns[2]; /* by mode */
  SamTransformDouble in_double;
  SamTransformSingle in_single;
  SamWorkspace       work;  /* half spectra of the fields' rows and columns, or of a kernel that is being computed */
  size_t             bytes; /* size of a slab on any rank, in doubles */
};

/* Returns the rows of a field. With transposes field k has its rows in slab k + 1 and its columns in slab k, else both
   in slab k. */
static inline void *SamFourierRows(SamFourier F, PetscInt field)
{
  return F->work->slab[SamWorkspaceTransposes(F->work) ? field + 1 : field].own;
}

/*
  SamPieces - a matrix in slabs, for access by columns: pieces of some rows each, one above the other. After a
  transpose, or on one rank, there is one piece with this rank's columns. In shared memory there is one piece per rank
  with all columns; this rank's columns begin at `first`.
*/
typedef struct {
  PetscMPIInt count;
  ptrdiff_t   rows, block;       /* rows of the matrix and of a piece; the last pieces have fewer */
  ptrdiff_t   row_length, first; /* number of elements */
  void      **data, *single;     /* of each piece; of the only piece */
} SamPieces;

/*
  Returns this rank's columns, start ... start + count - 1, of a rows x n matrix that is stored in a field's slabs.
*/
static inline SamPieces SamFourierGetPieces(SamFourier F, PetscInt field, ptrdiff_t rows, ptrdiff_t n, ptrdiff_t start,
                                            ptrdiff_t count)
{
  const SamWorkspace w    = F->work;
  const SamSlab     *slab = &w->slab[field];

  if (!w->shared) return (SamPieces){.count = 1, .rows = rows, .block = rows, .row_length = count, .single = slab->own};
  return (SamPieces){.count      = w->ranks,
                     .rows       = rows,
                     .block      = (rows + w->ranks - 1) / w->ranks,
                     .row_length = n,
                     .first      = start,
                     .data       = slab->of};
}
/* Return the number of rows of piece r, and its first element in this rank's columns. */
static inline ptrdiff_t SamPieceRows(const SamPieces *p, PetscMPIInt r)
{
  return PetscMax(PetscMin(p->block, p->rows - (ptrdiff_t)r * p->block), 0);
}
static inline void *SamPieceData(const SamPieces *p, PetscMPIInt r, size_t element)
{
  return (char *)(p->data ? p->data[r] : p->single) + (size_t)p->first * element;
}

/* Finds this rank's rows and columns of a kernel's quadrant (hy + 1, hx + 1); returns the number of reals that FFTW
   needs. */
PETSC_INTERN ptrdiff_t      SamFourierDivideQuadrant(SamFourier fourier, ptrdiff_t *rows, ptrdiff_t *row_start,
                                                     ptrdiff_t *columns, ptrdiff_t *column_start);
PETSC_INTERN PetscErrorCode SamFourierCheckPlan(const void *plan);
/*
  SamRootOfUnity - returns exp(i pi k/n), 0 <= k <= n, to the last digits, from an angle of at most pi/4, whose rounding
  is smallest.
*/
PETSC_INTERN void SamRootOfUnity(ptrdiff_t k, ptrdiff_t n, double root[2]);

PETSC_INTERN void SamTransformDestroyDouble(SamFourier fourier);
PETSC_INTERN void SamTransformDestroySingle(SamFourier fourier);

#endif
