/* A contact whose sets of cells are frozen: its linear response, and the systems that give it. */
#ifndef PETSAM_PRIVATE_FROZEN_H
#define PETSAM_PRIVATE_FROZEN_H

#include <petsam/private/balanceimpl.h>
#include <petsam/elasticity.h>

/* Tractions that are the unknowns of a linear system */
typedef enum { SAM_FROZEN_NORMAL, SAM_FROZEN_TANGENTIAL, SAM_FROZEN_BOTH } SamFrozenPart;

/*
  SamFrozenBorder - equations of a system besides those of its cells: row_k.x = a given number for each k, and a
  multiplier of each, times its column, in the equations of the cells. Rows and columns are of the system's size.
*/
typedef struct {
  PetscInt count;
  double  *row[SAM_COMPONENTS], *column[SAM_COMPONENTS];
  double  *spread[SAM_COMPONENTS];                   /* approximate inverse of the matrix times each column */
  double  *unit[SAM_COMPONENTS];                     /* orthonormal basis of the columns */
  double   triangle[SAM_COMPONENTS][SAM_COMPONENTS]; /* column k is the sum over l <= k of triangle[l][k] unit_l */
  double   inverse[SAM_COMPONENTS][SAM_COMPONENTS];  /* of the products row_k.spread_l */
} SamFrozenBorder;

/*
  SamFrozen - the cells in contact, packed row after row, and their linear response. Fields are packed arrays of up to
  three components, each of `count` values: dp and the unknown of the shear, from which SamFrozenShear() computes dq.
*/
typedef struct {
  SamElasticity elasticity; /* of a part of the grid that contains the contact, or of the whole grid */
  SamGrid       grid;
  SamFrame      normal, tangential; /* the frames of that grid */
  PetscBool     coupled;            /* pressure and shear are coupled */
  PetscInt      count;              /* number of this rank's cells in contact */
  PetscInt     *start;              /* rows + 1 entries: first packed cell of each row */
  PetscInt     *cell;               /* index of each cell in this rank's part of the grid */
  double       *e[2];               /* e in cells that slip, 0 in cells that stick */
  double       *follow;   /* derivative of the bound by the pressure in cells that slip, 0 in cells that stick */
  double       *rate;     /* the same by the length of the slip, times the influence self[1]; 0: none */
  double       *stiff;    /* |ds|/(mu p), m/Pa, the resistance to a turn of the slip; 0 in cells that stick */
  double       *free;     /* 1; 0 in cells without friction, and so without shear */
  double       *bears;    /* 1; 0 in cells that yield, whose pressure stays */
  double       *soft;     /* displacement of a cell by its own pressure besides the bodies', m/Pa; NULL: 0 */
  double       *sine;     /* of the angle from the normal of e to the direction of the unknown traction; NULL: 0 */
  double        slope[2]; /* mean of follow times e */
  double        self[2];  /* influence of a cell on itself, normal and tangential, m/Pa */
  Vec           p, q, u_z, u_t, w_z, w_t;
  float        *r, *z;  /* of two components */
  PetscInt      more;   /* number of unit motions besides the six phi */
  double      **motion; /* these motions, each of three packed components, normal first, m */
  /* adds to u_z and u_t the displacements by the tractions p and q that are not the elasticity's, on `grid`, in systems
     of both kinds; collective; NULL: there are none */
  PetscErrorCode (*respond)(void *context, Vec p, Vec q, Vec u_z, Vec u_t);
  void     *context; /* of that function */
  PetscBool holds;   /* the loads whose components the frames have stay as they are */
  /* the system that is solved */
  SamFrozenPart   part;
  PetscBool       transposed; /* its matrix is the transposed one; no bound follows the slip then */
  SamFrozenBorder border;     /* its further equations */
  PetscReal       rtol;       /* relative residual to which it is solved */
  PetscBool       single;     /* products in single precision, u_z and u_t in the cells alone; not with both kinds */
  PetscBool       loose;      /* the tolerance is far above that precision */
  double          reference;  /* what residuals are relative to; 0: the norm of the right-hand side */
  PetscInt        applies, preconditions;
} SamFrozen;

/*
  SamFrozenField - the fields of a solution whose sets of cells are frozen. Those from SAM_FROZEN_SLOPE on belong to a
  motion that continues the step; without them the motion reverses it, so that all cells stick and bear pressure.
*/
typedef enum {
  SAM_FROZEN_PRESSURE, /* Pa */
  SAM_FROZEN_BOUND,    /* bound of the shear, Pa */
  SAM_FROZEN_SHEAR,    /* Pa, two components */
  SAM_FROZEN_SLOPE,    /* derivative of the bound by the pressure, 1 */
  SAM_FROZEN_RATE,     /* derivative of the bound by the length of the slip, Pa/m; NULL: it does not follow the slip */
  SAM_FROZEN_PATH,     /* length of the slip of the step, m */
  SAM_FROZEN_OVERLAP,  /* overlap of the step in cells that yield, m */
  SAM_FROZEN_FIELDS
} SamFrozenField;
/*
  SamFrozenCreate - takes the sets of cells from the fields of a solution on the grid of an elasticity, which is
  borrowed. `coupled`: true if pressure and shear of dissimilar bodies are coupled; `stiffest`: the largest resistance
  of a cell to a turn of the slip, in units of its own influence; `still`: slip in the step below this part of the
  displacement of a cell by the largest bound is the solver's error, and the cell counts as sticking; likewise an
  overlap below this part of the displacement of a cell by the largest pressure counts as none. Collective.
  SamFrozenDestroy - frees what the object refers to. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrozenCreate(SamElasticity elasticity, const Vec fields[SAM_FROZEN_FIELDS],
                                            PetscBool coupled, double stiffest, double still, SamFrozen *frozen);
#define SAM_FROZEN_STILL 1e-5 /* for the usual tolerances */
PETSC_INTERN PetscErrorCode SamFrozenDestroy(SamFrozen *frozen);
/* SamFrozenSize - returns the number of a field's values on this rank in the system that is solved. Not collective. */
PETSC_INTERN PetscInt SamFrozenSize(const SamFrozen *frozen);
/* SamFrozenAddMotion - adds a unit motion of body 1 relative to body 2 that is no rigid one: u_z and u_t on the grid,
   m. The first one has the index 6. Not collective. */
PETSC_INTERN PetscErrorCode SamFrozenAddMotion(SamFrozen *frozen, Vec u_z, Vec u_t);
/* SamFrozenMotion - gets the components of a part of a unit motion, packed: of one of the six phi, normal ones first,
   or of one that was added. */
PETSC_INTERN void SamFrozenMotion(const SamFrozen *frozen, PetscInt k, SamFrozenPart part, double values[]);
/* SamFrozenColumn - computes the right-hand side of a unit motion. */
PETSC_INTERN void SamFrozenColumn(const SamFrozen *frozen, PetscInt k, double column[]);
/* SamFrozenSetTractions - sets the fields p and q to those of x; `work`: scratch of the size of x. Not collective. */
PETSC_INTERN PetscErrorCode SamFrozenSetTractions(SamFrozen *frozen, const double x[], double work[]);
/* SamFrozenApply - computes Ax, the system's matrix times x; sets u_z and u_t to the displacements by x. Collective. */
PETSC_INTERN PetscErrorCode SamFrozenApply(SamFrozen *frozen, const double x[], double Ax[]);
/* SamFrozenPrecondition - computes z, the approximate inverse of the matrix times r. Collective. */
PETSC_INTERN PetscErrorCode SamFrozenPrecondition(SamFrozen *frozen, const double r[], double z[]);
/* SamFrozenShear - computes the change q of the shear from those of the pressure and of x, NULL: 0; packed. Not
   collective. */
PETSC_INTERN void SamFrozenShear(const SamFrozen *frozen, const double p[], const double x[], double q[]);
/* SamFrozenPack - packs a field of the grid, of one or two components. SamFrozenProject - makes a packed gap and slip a
   right-hand side. */
PETSC_INTERN PetscErrorCode SamFrozenPack(const SamFrozen *frozen, Vec field, double values[]);
PETSC_INTERN void           SamFrozenProject(const SamFrozen *frozen, double values[]);
/*
  SamFrozenTurn - lets the unknown traction of the k-th packed cell, which slips, have the direction n_m in place of the
  normal of e, `sine` being that of the angle from this to n_m, in a transposed system: its slip is normal to n_m. The
  resistance to a turn of the slip is multiplied by a factor. Not collective.
  SamFrozenProjectRow - makes a packed motion of two components a row of the unknowns. Not collective.
*/
PETSC_INTERN PetscErrorCode SamFrozenTurn(SamFrozen *frozen, PetscInt k, double sine, double factor);
PETSC_INTERN void           SamFrozenProjectRow(const SamFrozen *frozen, double values[]);
/* SamFrozenFollow - adds to the normal part of packed values of three components what the transposed matrix adds: the
   derivative of the bound by the pressure, times the part along e of the tangential one. Not collective. */
PETSC_INTERN void SamFrozenFollow(const SamFrozen *frozen, double values[]);
/* SamFrozenTakeSlip - computes d(ds) = C dq - t after a product with dq, t being the motion along phi k; packed.
   Collective. */
PETSC_INTERN PetscErrorCode SamFrozenTakeSlip(const SamFrozen *frozen, PetscInt k, double slip[]);
/* SamFrozenDots - computes the products of n fields with one more, the same on any number of ranks. Collective. */
PETSC_INTERN PetscErrorCode SamFrozenDots(const SamFrozen *frozen, PetscInt n, double *const fields[],
                                          const double field[], double dots[]);

/*
  SamFrozenHold - holds those loads of both problems that are given as forces; all tractions are unknowns then, and no
  bound follows the slip. Not collective.
  SamFrozenTakeMotion - takes off a residual the part of the rigid displacements of these loads. SamFrozenTakeLoad -
  takes these loads off a direction. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrozenHold(SamFrozen *frozen, const SamBalance *normal, const SamBalance *tangential);
PETSC_INTERN PetscErrorCode SamFrozenTakeMotion(const SamFrozen *frozen, double residual[]);
PETSC_INTERN PetscErrorCode SamFrozenTakeLoad(const SamFrozen *frozen, double direction[]);

/*
  SamFrozenSetBorder - takes over the arrays of `count` rows and columns, whose frees are PetscFree(), as the border of
  the system whose part is set; `regular`: false if the rows do not determine the multipliers. Collective.
  SamFrozenClearBorder - frees it. Not collective.
  SamFrozenSolveBordered - solves the system with its border: x and the multipliers. u_z and u_t become the
  displacements by x. `error` is the residual relative to the right-hand side b. Collective.
*/
PETSC_INTERN PetscErrorCode SamFrozenSetBorder(SamFrozen *frozen, PetscInt count, double *const rows[],
                                               double *const columns[], PetscBool *regular);
PETSC_INTERN PetscErrorCode SamFrozenClearBorder(SamFrozen *frozen);
PETSC_INTERN PetscErrorCode SamFrozenSolveBordered(SamFrozen *frozen, const double b[], const double given[],
                                                   double x[], double multipliers[], PetscReal *error);
/*
  SamFrozenTakeColumns, SamFrozenTakeRows - take the part along the columns off a residual, and the products with the
  rows off a direction. Collective. SamFrozenAddSpread - adds to z the combination of the spread columns whose products
  with the rows are `times` those numbers (bordercolumns.c). Not collective.
*/
PETSC_INTERN void SamFrozenAddSpread(const SamFrozen *frozen, double times, const double products[], double z[]);
PETSC_INTERN PetscErrorCode SamFrozenTakeColumns(const SamFrozen *frozen, double residual[]);
PETSC_INTERN PetscErrorCode SamFrozenTakeRows(const SamFrozen *frozen, double direction[]);

/* Relative residual of a linear system, for which symmetric parts of the stiffness are accurate to 1e-8, others to
   1e-5 */
#define SAM_FROZEN_RTOL 1e-4
/*
  SamKrylovSolve - solves A x = b by generalised conjugate residuals; returns the residual b - A x, too. `error` is the
  residual's norm relative to that of b. Where loads are held the fields p and q become those of x, u_z and u_t their
  displacements without those by the coupling, to single precision, and the residual is that of the recurrence.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamKrylovSolve(SamFrozen *frozen, const double b[], double x[], double residual[],
                                           PetscReal *error);

#endif
