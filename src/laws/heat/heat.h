/* Steady temperatures of two half-spaces under the heat of their contact, and its partition between them. */
#ifndef PETSAM_HEAT_H
#define PETSAM_HEAT_H

#include <petsam/private/fourier.h>

/*
  SamHeatBody - what the temperature of a half-space depends on. The speed is that of its material along x, in the frame
  of the grid: positive towards +x. Bodies that roll to +x with V have the speed -V; a body that stands has 0. Material
  takes the heat along, so a body with a negative speed is warm behind the source, at negative lags (receiver minus
  source).
*/
typedef struct {
  PetscReal conductivity; /* W/(m K) */
  PetscReal capacity;     /* density times specific heat, J/(m3 K) */
  PetscReal speed;        /* m/s */
} SamHeatBody;

/*
  SamHeatRow - computes the steady temperature at the centres of cells under unit flux on one cell.

  Not collective.

  In:     body   - the half-space, insulated outside of the cell
          side   - sides of a cell in x, y (m), as grid->area; side[1] infinite: a strip, in plane strain
          depth  - of the points below the surface (m), at least 0
          j      - lag along y (receiver minus source, in cells), of any sign
          i0, n  - first lag along x and number of lags
  Out:    values - temperature at the lags (i0 + k, j) (K m2/W), n values

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a conductivity, capacity or side that is not positive, a speed that is not finite
  or a depth that is negative; PETSC_ERR_SUP for a strip on a body with the speed 0, which has no steady temperature.
  Source: Carslaw and Jaeger 1959, ch. X; see heatkernel.c.
*/
PETSC_INTERN PetscErrorCode SamHeatRow(const SamHeatBody *body, const PetscReal side[2], PetscReal depth, PetscInt j,
                                       PetscInt i0, PetscInt n, double values[]);

/*
  SamHeatTable - the same temperatures for rows of lags j = 0, 1, ..., with what does not depend on j computed once.

  SamHeatTableCreate - creates the table; n: numbers of lags i = 0 ... n[0] - 1 in both directions, and j = 0 ...
                       n[1] - 1. Errors: those of SamHeatRow().
  SamHeatTableRow    - computes `even` and `odd`, n[0] values each: the even and the odd part along x of the row j
                       (K m2/W), whose sum is the temperature at the lag i, and difference that at -i. Rows in their
                       order take half the time.
  Neither is collective.
*/
typedef struct _n_SamHeatTable *SamHeatTable;
PETSC_INTERN PetscErrorCode     SamHeatTableCreate(const SamHeatBody *body, const PetscReal side[2], PetscReal depth,
                                                   const PetscInt n[2], SamHeatTable *table);
PETSC_INTERN PetscErrorCode     SamHeatTableDestroy(SamHeatTable *table);
PETSC_INTERN void               SamHeatTableRow(SamHeatTable table, PetscInt j, double even[], double odd[]);

/*
  SamConductor - the operator from a flux on the surface of a half-space to the steady temperature at a depth.

  SamConductorCreate - creates the operator on a grid.

  Collective.

  In:     grid      - the grid; plane strain if it is one row
          settings  - settings of transforms (NULL: the default ones)
          body      - the half-space (copied)
          depth     - of the temperature below the surface (m), at least 0
  Out:    conductor - the operator; it has a reference to the grid

  Errors: those of SamHeatRow().
*/
typedef struct _n_SamConductor *SamConductor;
PETSC_INTERN PetscErrorCode     SamConductorCreate(SamGrid grid, const SamFourierSettings *settings,
                                                   const SamHeatBody *body, PetscReal depth, SamConductor *conductor);

/*
  SamConductorApply - computes the temperature by a flux, the same to the last bit on any number of ranks.

  Collective.

  In:     conductor   - the operator
          flux        - field of one component: heat into the body (W/m2)
  Out:    temperature - field of one component: relative to that of the bulk (K); it may be the same as `flux`

  Errors: PETSC_ERR_ARG_SIZ for a field of another grid.
*/
PETSC_INTERN PetscErrorCode SamConductorApply(SamConductor conductor, Vec flux, Vec temperature);

/* SamConductorDestroy - frees the operator; sets the handle to NULL. Collective. */
PETSC_INTERN PetscErrorCode SamConductorDestroy(SamConductor *conductor);

/*
  SamThermalStress - the operator from a flux on the surface of a half-space to the steady thermal stress at a depth,
  the surface being free of tractions (thermalstress.c).

  SamThermalStressCreate - creates the operator on a grid in three dimensions, which it references; the rest is copied.
  SamThermalStressAdd    - adds the stress by a flux (one component, W/m2) at a depth (m, at least 0), times `factor`,
                           to `stress` (SAM_STRESS_COMPONENTS components), for expansion times Young's modulus = 1
                           Pa/K. z points into the body. Depths in turn cost the kernels of a body that stands each
                           time.
  SamThermalStressBytes  - returns the memory that it takes on this rank, bytes. Not collective.
  SamThermalStressLeast  - returns the speed (m/s) below which bodies that move are too slow: their heat reaches beyond
                           the grid. It is that whose product with the longer side is 40 times the diffusivity. Not
                           collective.
  All others are collective. Errors: those of SamHeatRow(); PETSC_ERR_ARG_SIZ for a field of another grid; PETSC_ERR_SUP
  for a body that is too slow.
  Source: Barber 1984, J. Appl. Mech. 51, 636; Liu and Wang 2001, J. Tribol. 123, 17.
*/
typedef struct _n_SamThermalStress *SamThermalStress;
PETSC_INTERN PetscErrorCode         SamThermalStressCreate(SamGrid grid, const SamFourierSettings *settings,
                                                           const SamHeatBody *body, PetscReal poisson,
                                                           SamThermalStress *thermal);
PETSC_INTERN PetscErrorCode SamThermalStressAdd(SamThermalStress thermal, PetscReal depth, Vec flux, PetscReal factor,
                                                Vec stress);
PETSC_INTERN PetscErrorCode SamThermalStressDestroy(SamThermalStress *thermal);
PETSC_INTERN double         SamThermalStressBytes(SamThermalStress thermal);
PETSC_INTERN PetscReal      SamThermalStressLeast(SamGrid grid, const SamHeatBody *body);
/*
  SamThermalStressWave - computes the stresses by a wave exp(i k.x) of the temperature 1 of the surface, over E
  alpha/(1 - nu): n along the wave, t across; `kappa`: its decay with depth (1/m, real and imaginary part), `k` its wave
  number (1/m). `stress`: nn, tt, zz, and nz over i, each real and imaginary part. Not collective.
*/
enum { SAM_THERMAL_NN, SAM_THERMAL_TT, SAM_THERMAL_ZZ, SAM_THERMAL_NZ, SAM_THERMAL_PARTS };
PETSC_INTERN void SamThermalStressWave(double k, const double kappa[2], double poisson, double depth,
                                       double stress[SAM_THERMAL_PARTS][2]);

/* SamHeatPair - two bodies in contact, and how accurately heat is divided between them. */
typedef struct {
  SamConductor body[2];    /* on one grid, at the surface (depth 0) */
  PetscReal    resistance; /* of the contact on the way to body 2, m2 K/W; heat arises on body 1. 0: none */
  PetscReal    rtol;       /* 2-norm of the residual, over that of the right side; 1e-8 is a good one */
  PetscInt     most;       /* maximum number of products with K1 + K2; 100 is a good one */
} SamHeatPair;

typedef enum {
  SAM_HEAT_CONVERGED, /* the residual is within the tolerance */
  SAM_HEAT_LIMIT,     /* `most` products were not enough */
  SAM_HEAT_STAGNATES  /* the residual falls no more: the tolerance is below rounding, or a number is not finite */
} SamHeatReason;

typedef struct {
  SamHeatReason reason;
  PetscInt      products; /* with K1 + K2; 0 where no solve was needed */
  PetscReal     residual; /* 2-norm over that of the right side */
} SamHeatReport;

/*
  SamHeatSplit - divides the heat of a contact between two bodies, so that in contact their surfaces have the same
  temperature, or differ by the resistance times the flux into body 2:

      (K1 + K2 + r) q2 = T1_bulk - T2_bulk + K1 Q   in cells in contact,   q2 = 0 elsewhere.

  Collective.

  In:     pair    - the bodies
          contact - field of one component, positive in cells in contact (the pressure will do)
          heat    - Q: field of one component, heat per area and time (W/m2), 0 outside of contact; of any sign
          bulk    - temperature of the bulk of body 1 and 2 (K)
  Out:    heat_2  - q2: field of one component, heat into body 2 (W/m2); Q - q2 flows into body 1. It may be negative
                    and may exceed Q
          report  - whether the solve converged, and its cost; heat_2 is the last iterate in any case

  The temperature of the surfaces is T1 = T1_bulk + K1 (Q - q2), T2 = T2_bulk + K2 q2, by SamConductorApply(). Results
  are the same to the last bit on any number of ranks. Equal bodies of one bulk temperature without resistance: q2 =
  Q/2 without a solve.

  Errors: PETSC_ERR_ARG_WRONG for operators on different grids or below the surface, or heat outside of contact;
  PETSC_ERR_ARG_OUTOFRANGE for a resistance below 0, or a tolerance or number of products that is not positive;
  PETSC_ERR_ARG_SIZ for a field of another grid.
  Source: Bos and Moes 1995, J. Tribol. 117, 171; Eisenstat, Elman and Schultz 1983, SIAM J. Numer. Anal. 20, 345.
*/
PETSC_INTERN PetscErrorCode SamHeatSplit(const SamHeatPair *pair, Vec contact, Vec heat, const PetscReal bulk[2],
                                         Vec heat_2, SamHeatReport *report);

#endif
