/* Bodies with bonded layers: symbols, influence functions in space, cell integrals, and their tables. */
#ifndef PETSAM_LAYERED_H
#define PETSAM_LAYERED_H

#include <petsam/private/body.h>
#include <petsam/private/bodyimpl.h>
#include <petsam/private/halfspace.h>

/*
  The flow of data for a pair of bodies of which at least one has layers, that is, several materials:
    body/symbols.c   the layers of each body become symbols, functions of the wave number, by a recursion from the
                     substrate up: the symbols themselves, and their differences from those of a half-space of the
                     surface's material (private/body.h)
    spline.c         functions of s = r^2 or s = k^2 become polynomials on short intervals, which are evaluated quickly
    radial.c         the differences become radial functions, the influence in space that is added to the half-space's
    cells.c          the radial functions become integrals over cells, which halfspace.c adds to its closed forms. All
                     products, coarse grids and parts are those of half-spaces
    layeredstress.c  symbols of the stresses at a depth become radial functions and integrals likewise
    layeredwaves.c   the symbols themselves act on waves: products on periodic grids, and the preconditioners of both
  Source of formulas: Burmister 1945, J. Appl. Phys. 16, 89; O'Sullivan and King 1988, J. Tribol. 110, 235.
*/

/*
  SamLayeredCreateStress - creates the object for the stresses in a body with layers, body 1 or 2 of a pair
  (layeredstress.c). Collective.
*/
PETSC_INTERN PetscErrorCode SamLayeredCreateStress(SamGrid grid, const SamFourierSettings *settings, PetscInt number,
                                                   SamBody body, SamStress *stress);

/*
  SamSpline - functions of s >= 0, at most SAM_RADIALS, as polynomials of degree 9 on intervals: one from 0 to `least`,
  then eight per factor 2 of s up to `most`, selected by the leading bits of s. Arguments beyond the range are replaced
  by the nearest one. Errors are 1e-15 if a function is analytic around its interval within the distance of the interval
  from 0.
  SamSplineCreate - creates the table from the values of all functions at s. SamSplineRow - computes the values of a
  function at s[0 ... n - 1], quickly if consecutive arguments share an interval. None is collective.
*/
#define SAM_SPLINE_DEGREE 9
#define SAM_RADIALS       10
typedef struct SamSpline {
  double least, most, *centre, *scale, *coefficients; /* of each interval; coefficients of each function and interval */
  int    first, intervals, functions;
} SamSpline;
PETSC_INTERN PetscErrorCode SamSplineCreate(SamSpline *table, int functions, double least, double most,
                                            void (*values)(const void *context, double s, double values[]),
                                            const void *context);
PETSC_INTERN PetscErrorCode SamSplineDestroy(SamSpline *table);
PETSC_INTERN void SamSplineRow(const SamSpline *table, int function, PetscInt n, const double s[], double values[]);

/*
  SamLayered - the tables of a pair, which elasticities on several grids share: the symbols as functions of k^2, and
  four functions of r^2 that compose the influence of a unit force in space, minus that of half-spaces of the surface
  materials, at (x, y) from it:
    u_z from p:   N
    u_x from q_x: A + B (x^2 - y^2),   u_y from q_y: A - B (x^2 - y^2),   u_y from q_x: 2 B x y
    u_x from p:   C x,                 u_z from q_x: -C x
  SamLayeredPrepare - extends the tables to distances up to r (m) and wave numbers from k[0] to k[1] (1/m); 0 extends no
  table. Not collective, the same on all ranks.
*/
typedef enum { SAM_RADIAL_N, SAM_RADIAL_A, SAM_RADIAL_B, SAM_RADIAL_C, SAM_RADIAL_FUNCTIONS } SamRadial;
typedef struct {
  PetscInt  references;
  SamPair   pair;
  double    depth; /* 2 h, h the thinner of both bodies' first layers: differences fall like exp(-depth k) */
  SamSpline symbols, radial, line;
} * SamLayered;
PETSC_INTERN PetscErrorCode SamLayeredCreate(SamPair pair, SamLayered *layered);
PETSC_INTERN PetscErrorCode SamLayeredReference(SamLayered from, SamLayered *to); /* replaces another one */
PETSC_INTERN PetscErrorCode SamLayeredDestroy(SamLayered *layered);
PETSC_INTERN PetscErrorCode SamLayeredPrepare(SamLayered layered, double r, const double k[2]);

/*
  SamRadialSource - functions g(k), whose transforms f(r) of the given orders (radial.c) give a table of f/r^order for
  distances up to r. The functions decay like exp(-depth k), and vary over lengths up to `longest`; for k = 0 they tend
  to the sum of the images. `line`: the transforms use cosines (order 0) and sines (order 1). SamRadialCreate() is not
  collective.
*/
#define SAM_LONG_WAVE 1e-18 /* k times the longest length, below which functions have their values of k = 0 */
typedef struct {
  int        functions;
  const int *orders;
  double     depth, longest; /* m */
  double     image[2][SAM_RADIALS], thickness[2];
  PetscBool  line;
  void (*values)(const void *context, double k, double g[]);
  const void *context;
} SamRadialSource;
PETSC_INTERN PetscErrorCode SamRadialCreate(const SamRadialSource *of, double r, SamSpline *table);

/*
  SamRadialKernels - at most three kernels, sums of terms: a factor, a function of a table and a polynomial of (x, y).
  Terms of one function follow each other.
    SamRadialAddRow   adds the integrals over the cells at the lags (i, j), i = 0 ... n - 1, at a point (i, j) cells
                      away from each; errors are 1e-12 of the functions
    SamRadialAddLine  does the same in plane strain, for a table by cosines and sines
    SamRadialSetUp    must be called before both
  None is collective.
*/
#define SAM_RADIAL_KERNELS 3
typedef enum {
  SAM_ANGULAR_1,
  SAM_ANGULAR_X,   /* r cos t */
  SAM_ANGULAR_Y,   /* r sin t */
  SAM_ANGULAR_XX,  /* r^2 cos 2t */
  SAM_ANGULAR_XY,  /* r^2 sin 2t */
  SAM_ANGULAR_XXX, /* r^3 cos 3t */
  SAM_ANGULAR_YYY  /* r^3 sin 3t */
} SamAngular;
typedef struct {
  int        function, kernel;
  SamAngular angular;
  double     factor;
} SamRadialTerm;
typedef struct {
  const SamSpline     *table;
  double               depth;
  int                  kernels, count; /* kernels, terms */
  const SamRadialTerm *terms;
} SamRadialKernels;
PETSC_INTERN PetscErrorCode SamRadialSetUp(void);
PETSC_INTERN void           SamRadialAddRow(const SamRadialKernels *of, const double side[2], PetscInt j, PetscInt n,
                                            double *const values[]);
PETSC_INTERN void SamRadialAddLine(const SamRadialKernels *of, double side, PetscInt n, double *const values[]);

/*
  SamLayeredAddRow - adds the integrals over the cells at the lags (i, j), i = 0 ... n - 1: the displacement at a point
  (i dx, j dy) from the centre of a cell under unit traction, minus that of half-spaces of the surface materials.
  `kind`: the displacement, named by its integral for half-spaces: R for u_z from p, XX for u_x from q_x, X for u_x from
  p. Errors are 1e-12 of the functions. Not collective.
*/
PETSC_INTERN void SamLayeredAddRow(SamLayered layered, SamIntegral kind, double dx, double dy, PetscInt j, PetscInt n,
                                   double values[]);
/*
  SamLayeredPrepareLine, SamLayeredAddLine - do the same in plane strain: extend the table to the distance r (m); add
  the integrals of the influence of line loads, minus that of half-spaces of the surface materials, over the cells at
  the lags i = 0 ... n - 1. Far away displacements are those of the substrates, relative to those at the distance
  `datum` (m). Not collective.
*/
PETSC_INTERN PetscErrorCode SamLayeredPrepareLine(SamLayered layered, double r);
PETSC_INTERN void SamLayeredAddLine(SamLayered layered, SamWaveSymbol symbol, double dx, double datum, PetscInt n,
                                    double values[]);

#endif
