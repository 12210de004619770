/* Helpers for all parts of the library: differences between PETSc versions, log events, memory, sums over the ranks. */
#ifndef PETSAM_BASEIMPL_H
#define PETSAM_BASEIMPL_H

#include <petsam/base.h>
#include <petsam/private/classes.h>
#include <petscviewer.h>
#include <petscmat.h>
#include <petscpc.h>
#include <math.h>
#include <string.h>

/* ---- differences between PETSc versions, from 3.18 on ---- */
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
  SAM_VECTORIZED - attribute of functions that loop over contiguous doubles: they are compiled for several generations
  of x86, and the program selects one at its start. So an installed program needs no -march=native.
*/
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
  !defined(__SANITIZE_ADDRESS__)
  #define SAM_VECTORIZED __attribute__((target_clones("default", "avx2", "avx512f")))
#else
  #define SAM_VECTORIZED
#endif

/*
  SamBaseInitialize - does the part of SamInitialize() that all parts of the library need; calling it again does
  nothing. Collective on PETSC_COMM_WORLD.
*/
PETSC_INTERN PetscErrorCode SamBaseInitialize(void);

/* ---- log events, for -log_view and the closing table of the program ---- */
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
  SAM_EVENT_PLASTIC,
  SAM_EVENT_CHECK,
  SAM_EVENT_EDGES,
  SAM_EVENT_STIFFNESS,
  SAM_EVENT_OUTPUT,
  SAM_EVENT_CHECKPOINT,
  SAM_EVENT_GRIDS, /* solves on nested grids: the finest one, and so on; the last for all coarser ones */
  SAM_EVENT_LAST_GRID = SAM_EVENT_GRIDS + 7,
  SAM_EVENT_COUNT
} SamEvent;
PETSC_EXTERN PetscLogEvent SamEvents[SAM_EVENT_COUNT];

/* ---- errors ---- */
/* SamKeepMessage - an error handler for PETSc that stores the first message in `context`, as one line of SAM_MESSAGE
   characters. */
#define SAM_MESSAGE 1024
PETSC_INTERN PetscErrorCode SamKeepMessage(MPI_Comm comm, int line, const char *function, const char *file,
                                           PetscErrorCode code, PetscErrorType type, const char *message,
                                           void *context);

/* ---- start ---- */
/*
  SamPrepareMPI - returns true if an MPI launcher has started the process; it must be called before MPI_Init(). Without
  a launcher no network is needed, and it keeps Open MPI from searching for one and starting a daemon, which takes
  longer than a small problem and is not possible everywhere. Settings of the user are not changed. Not collective.
  SamFindCopies - returns the number of processes that a launcher has started, stated by the variable `name` of its
  environment, if MPI has one rank; 0: no other process. Each process is then a copy of the whole run. It must be called
  after MPI_Init(). Not collective.
  SamForgetPreparation - restores the settings after MPI_Init(), so that programs that the process starts can be
  launched with MPI. Not collective.
*/
PETSC_EXTERN PetscBool SamPrepareMPI(void);
PETSC_EXTERN int       SamFindCopies(const char **name);
PETSC_INTERN void      SamForgetPreparation(void);

/* ---- memory ---- */
/*
  SamAllocate, SamAllocateZeros - allocate an array of any size; a large one lies in large pages. `pointer` is the
  address of a pointer. Freed by SamFree(). Not collective. Errors: PETSC_ERR_MEM with the size.
*/
PETSC_INTERN PetscErrorCode SamAllocate(size_t bytes, void *pointer);
PETSC_INTERN PetscErrorCode SamAllocateZeros(size_t bytes, void *pointer);
PETSC_INTERN void           SamFree(void *pointer);

/*
  SamZero - sets n doubles to zero. It does not write where they are already zero, so that untouched pages take no
  memory. It must not be used for uninitialized memory, since it reads the numbers.
*/
PETSC_INTERN void SamZero(PetscInt n, double x[]);

/*
  SamMallocTrim - returns freed memory, which the C library would keep, to the system. The next allocations must map it
  again, which takes time, so it should be called only at the end of long stages.
*/
PETSC_INTERN void SamMallocTrim(void);
/* SamDescribeBytes - writes a size in readable form: "1.23 GB", where a GB is 1e9 bytes. Not collective. */
PETSC_EXTERN void SamDescribeBytes(double bytes, char text[], size_t size);

/* ---- options ---- */

/* SamSetPrefix - copies the prefix of an object's options (NULL: none). Errors: PETSC_ERR_ARG_SIZ for more than 63. */
#define SAM_PREFIX 64
PETSC_INTERN PetscErrorCode SamSetPrefix(char to[SAM_PREFIX], const char prefix[]);

/*
  SamRangeHas - returns true if a value lies in a range. SamRangeDescribe - returns the range in words. Not collective.
*/
PETSC_INTERN PetscBool   SamRangeHas(SamRange range, double value);
PETSC_INTERN const char *SamRangeDescribe(SamRange range);

/* ---- mistakes in options and names (spelling.c); none is collective, but for SamOptionsRequire() ---- */
/* SamNearestName - returns the most similar of several names to one that was tried; NULL if none is similar. */
PETSC_EXTERN const char *SamNearestName(const char tried[], size_t count, const char *const names[]);
/*
  SamOptionsKnow - notes that an option of this name (without dash and prefix) exists, for suggestions. `with`: the
  option that must also be given for it to have an effect; NULL: none, or not known.
*/
PETSC_INTERN void SamOptionsKnow(const SamOptions *from, const char name[], const char with[]);
/*
  SamOptionsIsKnown - returns true if an option of this name (with the prefix, without dash) exists; `with` may be NULL.
*/
PETSC_INTERN PetscBool SamOptionsIsKnown(const char name[], const char **with);
/* SamOptionFile - an option whose value names files; both names have the prefix and a dash. */
typedef struct {
  char          name[96], shown[96]; /* name in the options database, and in messages */
  SamOptionKind kind;                /* SAM_OPTION_FILE, SAM_OPTION_FILES, SAM_OPTION_OUTPUT or SAM_OPTION_VIEWER */
} SamOptionFile;
/*
  SamOptionsNoteFile - notes an option if its kind is one of these. SamOptionsRead() calls it for each row; code that
  reads options by other means must call it.
  SamOptionsFile - returns the k-th noted option; NULL if there are no more. Not collective.
*/
PETSC_INTERN PetscErrorCode       SamOptionsNoteFile(const SamOptions *from, SamOptionKind kind, const char name[],
                                                     const char shown[]);
PETSC_EXTERN const SamOptionFile *SamOptionsFile(PetscInt k);
/*
  SamOptionsNearest - returns the known option most similar to a name; NULL if none is similar.
  SamOptionsForm - returns the form of its value, after a blank, if the name is an old one with another value; or "".
*/
PETSC_INTERN const char *SamOptionsNearest(const char tried[]);
PETSC_INTERN const char *SamOptionsForm(const char tried[]);
/*
  SamOptionsRequire - raises an error if a required option is missing; the message suggests a similar option that was
  given. After a space the name may continue with alternatives.
  Collective. Errors: SAM_ERR_USER unless it is given.
*/
PETSC_INTERN PetscErrorCode SamOptionsRequire(const SamOptions *from, PetscBool given, const char name[],
                                              const char text[]);
/* SamIsDecimalComma - returns true if a text begins with digits, a comma, and a digit: 2,6e-3. */
PETSC_INTERN PetscBool SamIsDecimalComma(const char text[]);
/*
  SamExplainNumber - writes the fault of a text that is no number, to be added to a message; it may be empty. `unit`:
  the SI unit of the number.
*/
PETSC_INTERN void SamExplainNumber(const char text[], const char unit[], char why[], size_t size);

/* ---- units (units.c); not collective ---- */
/*
  SamReadReal - reads a number, which may be followed by a unit of the dimension of `si`, as mm for "m", or without `si`
  (NULL) by none; returns true if the text is such a number. `value`: the number in the unit of SI; `end`: the comma
  after it, or the end of the text; `unit`: true if a unit follows.
  SamListUnits - writes the units that may follow, "m, mm, um or nm"; empty: none.
  SamUnitOf - returns the n-th unit for numbers in the k-th SI unit, and the power of ten between the two; for n < 0 it
  returns the SI unit itself. NULL: there are no more but those with a factor, kgf and lbf.
  SamAddUnit - writes the text of an option's help with its unit, as SamOptionRow says; NULL: the text alone.
*/
PETSC_INTERN PetscBool   SamReadReal(const char si[], const char text[], const char **end, double *value,
                                     PetscBool *unit);
PETSC_INTERN void        SamListUnits(const char unit[], char list[], size_t size);
PETSC_EXTERN const char *SamUnitOf(int k, int n, int *power);
PETSC_INTERN void        SamAddUnit(const char text[], const char unit[], char whole[], size_t size);
/*
  SamExplainStress - writes a text, to be added to a value, if the unit of a stress or of a modulus is likely to be
  wrong: if its ratio to Young's modulus (both Pa) is not 0 but less than `least`, or more than `most`. Otherwise, or if
  the body is rigid, the text is empty.
*/
#define SAM_LEAST_CONSTANT 1e-6 /* smallest plausible ratio for the constants of a material; solids have larger ones */
#define SAM_MOST_STRENGTH  1    /* largest plausible ratio for a stress that a material bears: all are far below */
PETSC_INTERN void SamExplainStress(double stress, double young, double least, double most, char why[], size_t size);

/* ---- materials by name (materials.c); none is collective ---- */
#define SAM_MATERIAL_CONSTANTS 11 /* the first two are Young's modulus and Poisson's ratio */
/* SamMaterialConstant - a constant of the table: its name, its unit ("1": none), what it is */
typedef struct {
  const char *name, *unit, *text;
} SamMaterialConstant;
/* SamNamedMaterial - a row of the table; other names are separated by commas and blanks */
typedef struct {
  const char *name, *aliases;
  double      value[SAM_MATERIAL_CONSTANTS]; /* NAN: the source states none */
  const char *source;
} SamNamedMaterial;
/*
  SamMaterialAt, SamMaterialConstantAt - return the k-th row or constant of the table; NULL if there are no more.
  SamMaterialFind - returns the material of a name, where case, blanks, hyphens and underscores do not count; NULL if
  there is none.
  SamMaterialElastic - makes the material of Young's modulus and Poisson's ratio, as 210GPa,0.3, whose other constants
  are not known and whose name is the text; NULL if the text is another. Their range is checked with that of the body.
  SamMaterialList - writes the names of all, separated by `between`.
  SamMaterialExplain - writes the fault of an unknown name, with the nearest one and with all.
*/
PETSC_EXTERN const SamNamedMaterial    *SamMaterialAt(PetscInt k);
PETSC_EXTERN const SamMaterialConstant *SamMaterialConstantAt(PetscInt k);
PETSC_EXTERN const SamNamedMaterial    *SamMaterialFind(const char name[]);
PETSC_INTERN const SamNamedMaterial    *SamMaterialElastic(const char text[], SamNamedMaterial *m);
PETSC_EXTERN void                       SamMaterialList(const char between[], char text[], size_t size);
PETSC_EXTERN void                       SamMaterialExplain(const char name[], char text[], size_t size);

/* ---- checksums ---- */

/*
  SamHashMix - applies the finalizer of MurmurHash3 (A. Appleby, public domain): every bit of x affects all of the
  result.
*/
static inline uint64_t SamHashMix(uint64_t x)
{
  x = (x ^ x >> 33) * UINT64_C(0xff51afd7ed558ccd);
  x = (x ^ x >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
  return x ^ x >> 33;
}

/* SamHashBytes - adds n bytes to a hash, eight at a time. */
static inline uint64_t SamHashBytes(uint64_t hash, const unsigned char bytes[], size_t n)
{
  for (size_t k = 0; k < n; k += sizeof(hash)) {
    uint64_t word = 0;

    memcpy(&word, bytes + k, n - k < sizeof(word) ? n - k : sizeof(word));
    hash = SamHashMix(hash + word);
  }
  return hash;
}

/* SamHashBits - returns the bits of a number. */
static inline uint64_t SamHashBits(double value)
{
  uint64_t bits;

  memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/* ---- rounding ---- */

/*
  SamGapRounding - returns the rounding error of a gap (m) if it is more than 1e-12 of the `displacement` (m), which is
  then a small difference of large numbers; else 0. One part is the rounding of tractions up to `traction` (Pa) on
  `cells` cells, each of which displaces itself by `self` (m/Pa): on periodic bodies uniform tractions cause no
  displacement, but their rounding does. The other part is the rounding of heights as large as `approach` (m).
*/
static inline double SamGapRounding(double traction, double self, double cells, double approach, double displacement)
{
  const double rounding = PETSC_MACHINE_EPSILON * (16 * self * sqrt(cells) * traction + fabs(approach));

  return rounding > 1e-12 * displacement ? rounding : 0;
}

/* ---- sums and maxima over the ranks ---- */
/*
  SamSum, SamMax - compute the sum, or the maximum, over the ranks of each of n doubles, in place on all ranks.
  Collective.
*/
PETSC_EXTERN PetscErrorCode SamSum(MPI_Comm comm, PetscInt n, double values[]);
PETSC_EXTERN PetscErrorCode SamMax(MPI_Comm comm, PetscInt n, double values[]);
/* SamCountNodes - counts the nodes that the ranks are on, and the most ranks of one of them. Collective. */
PETSC_EXTERN PetscErrorCode SamCountNodes(MPI_Comm comm, double *nodes, double *most);

/*
  SamTotal - a sum with three times the digits of a double. A row of the grid always lies on one rank, so the sum over a
  row does not depend on the number of ranks. If the sums of the rows are added in this way, the total does not depend
  on it either, even if it nearly vanishes: results are the same on any number of ranks. Source: Knuth's exact addition;
  Hida, Li and Bailey 2001.
*/
typedef struct {
  double sum, rest, last;
} SamTotal;

/* SamAddExactly - adds a value to a sum and returns the rounding error of the addition. */
static inline double SamAddExactly(double *sum, double value)
{
  const double before = *sum, after = before + value, part = after - before;

  *sum = after;
  return (before - (after - part)) + (value - part);
}

static inline void SamAdd(SamTotal *total, double value)
{
  total->last += SamAddExactly(&total->rest, SamAddExactly(&total->sum, value));
}
static inline void SamAddAll(PetscInt n, SamTotal totals[], const double values[])
{
  for (PetscInt k = 0; k < n; k++) SamAdd(&totals[k], values[k]);
}
/* SamSumTotals - adds n totals over the ranks and returns them as doubles. Collective. */
PETSC_EXTERN PetscErrorCode SamSumTotals(MPI_Comm comm, PetscInt n, const SamTotal totals[], double sums[]);

/* SamLarger - returns the larger of two numbers; infinity if `value` is NaN, which a plain comparison would ignore. */
static inline double SamLarger(double most, double value)
{
  if (value <= most) return most;
  return isnan(value) ? INFINITY : value;
}

/*
  SamSolveSymmetric - computes x = pseudo-inverse of the symmetric, positive semi-definite A of order n <=
  SAM_SYMMETRIC_MAX, stored row after row, times b. Eigenvalues up to `least` times the largest count as zero. A is
  overwritten. Not collective.
*/
#define SAM_SYMMETRIC_MAX 16
PETSC_INTERN void SamSolveSymmetric(PetscInt n, double A[], const double b[], double least, double x[]);

/* SamGetFolder - writes the folder in the name of a file; "." if the name has none. Not collective. */
PETSC_EXTERN void SamGetFolder(const char filename[], char folder[PETSC_MAX_PATH_LEN]);

/*
  SamOneLine - copies a text of a message, cut to `size`, with escapes such as \n in place of control characters, which
  values of options and names of files may contain and which would break the line. Not collective.
  SamPrintMessage - prints a program's message to stderr as one line, by SamOneLine(). Not collective.
  SamNameSetting - copies a text, cut to `size`, with the option (without dash; or empty) that helps in parentheses,
  unless the text names it. Not collective.
*/
PETSC_EXTERN void SamNameSetting(const char text[], const char setting[], char line[], size_t size);
PETSC_INTERN void SamOneLine(const char text[], char line[], size_t size);
PETSC_EXTERN void SamPrintMessage(const char program[], const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

/* SamJoin - writes names as one text, separated by `between`, but by `last` before the last name. Not collective. */
PETSC_INTERN void SamJoin(PetscInt count, const char *const names[], const char between[], const char last[],
                          char text[], size_t size);
/* SamTypesGet - gets the names in a registry, in alphabetical order; the caller frees the array. Not collective. */
PETSC_INTERN PetscErrorCode SamTypesGet(PetscFunctionList list, const char ***types, int *count);
/* SamTypesList - writes the names in a registry as a text, "a, b or c". Not collective. */
PETSC_INTERN PetscErrorCode SamTypesList(PetscFunctionList list, char text[], size_t size);
/* SamTypesOption - reads an option whose value is a type of the registry. */
PETSC_INTERN PetscErrorCode SamTypesOption(PetscFunctionList list, const SamOptions *from, const char name[],
                                           const char help[], char type[], size_t size, PetscBool *set);

/* SamPrintHelp - returns true while the help is being printed, for which options are only listed. Not collective. */
PETSC_EXTERN PetscBool SamPrintHelp(void);

/* Messages that several places use: an option without dash, its file, and a reason; a failed plan of FFTW. */
#define SAM_CANNOT_READ "-%s %s: cannot be read: %s"
#define SAM_NO_PLAN     "FFTW could not make a plan"

#endif
