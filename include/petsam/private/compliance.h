/*
  The compliance of a finite body relative to the half-space, by its shape and its supports, from a file of
  petsam-compliance.
*/
#ifndef PETSAM_COMPLIANCE_H
#define PETSAM_COMPLIANCE_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/stressimpl.h>

#define SAM_COMPLIANCE_DEGREE 24  /* highest degree of the polynomials in x or y */
#define SAM_COMPLIANCE_MODES  325 /* maximum number of polynomials: all of total degree 24, or 24 by 12 */
#define SAM_COMPLIANCE_CASES  64  /* maximum number of load cases of a body */
#define SAM_CASE_NAME         20  /* maximum number of letters in the name of a load case */

/*
  SamCompliance - the additional compliance of one body. The displacement of its surface by a traction t, minus that of
  the half-space, is sum phi_i matrix[.][i][.][j] c_j with c_j the integral of phi_j t over the patch. The phi are
  products of Legendre polynomials in x and y, orthonormal on the patch. Directions and places refer to the body's own
  frame, x, y, and z into the body. The frame of body 2 is that of the contact; the frame of body 1 is rotated about x
  by half a turn. That of a pair of bodies which are joined outside of the contact is the displacement of body 2 minus
  that of body 1 by t on body 2 and -t on body 1, in the frame of body 2.
*/
typedef struct _n_SamCompliance *SamCompliance;
struct _n_SamCompliance {
  PetscInt references;
  PetscInt body; /* 0 or 1 */
  char     file[PETSC_MAX_PATH_LEN];
  uint64_t checksum;           /* checksum of all members below */
  double   young, poisson;     /* constants of the half-space, Pa, 1 */
  double   young1, poisson1;   /* those of body 1 if the compliance is that of a pair; else NaN */
  double   center[2], half[2]; /* centre and half widths of the patch, m */
  double   error;              /* of the matrix by the mesh of the body, relative to it; 0: it is not known */
  double   datum;              /* of a section in plane strain: its half-plane's, m; 0: in three dimensions */
  PetscInt modes, degree, power[SAM_COMPLIANCE_MODES][2];
  PetscInt cases;
  char     name[SAM_COMPLIANCE_CASES][32];
  PetscInt below[3]; /* number of points along x, y, z with known stresses; 0: none */
  double  *matrix;   /* (3, modes, 3, modes), m3/N, symmetric */
  double  *field;    /* (cases, 3, modes), coefficients for the unit load case, m2 */
};

/*
  A section in plane strain has the centre 0 and the half width 0.5 m in y, and polynomials in x alone, so that all
  numbers are those of a body of 1 m along y.

  SamComplianceMoveDatum - makes the matrix that of a half-plane with another datum. Not collective.
*/
PETSC_INTERN void SamComplianceMoveDatum(SamCompliance compliance, double datum);
/*
  SamComplianceMesh - the numbers of a step that have the errors of the displacements in x, y and z by the meshes of the
  bodies, m; only a contact with such bodies has them.
*/
PETSC_INTERN const char *const SamComplianceMesh[3];
/* SamComplianceOptions - the options of both bodies, without dash. */
PETSC_INTERN const char *const SamComplianceOptions[2];
/*
  SamComplianceRead - reads the compliance of body 0 or 1 from the file that `option` (without dash) names, of several
  patches of a structure one, NAME:PATCH, or NAME:PATCH:local[:LOWER] (compliancefile.c); `pair`: the bodies without it.
  Collective. Errors: SAM_ERR_FILE for a file that cannot be read or does not fit, and for a body that would gain
  energy, or be too compliant, under some traction.
*/
PETSC_INTERN PetscErrorCode SamComplianceRead(MPI_Comm comm, PetscInt body, SamPair pair, const char option[],
                                              const char file[], SamCompliance *compliance);
/*
  SamComplianceFit - computes the coefficients of the polynomials nearest to values (n, 3) at n >= compliance->modes
  points; `rest`: the largest deviation relative to their range, NaN if the points do not determine the polynomials. Not
  collective.
*/
PETSC_INTERN PetscErrorCode SamComplianceFit(SamCompliance compliance, PetscInt n, const double *const at[2],
                                             const double values[], double field[][3], double *rest);
/*
  SamComplianceFileName - returns the length of the file's name in such a text; patch, local and lower are 0 where it
  has none of them. Not collective.
*/
PETSC_INTERN size_t SamComplianceFileName(const char text[], PetscInt *patch, PetscBool *local, PetscInt *lower);
/*
  SamComplianceFactor - returns the factor on load case l in a step, body1_case_<name> or body2_case_<name>. Not
  collective.
*/
PETSC_INTERN double SamComplianceFactor(SamCompliance compliance, SamConditions conditions, const SamControl *control,
                                        PetscInt l);
PETSC_INTERN PetscErrorCode SamComplianceDestroy(SamCompliance *compliance);
/*
  SamComplianceMeans - computes the means of the orthonormal polynomials along axis 0 or 1 over an interval (m), m^-1/2.
  Not collective.
*/
PETSC_INTERN void SamComplianceMeans(SamCompliance compliance, PetscInt axis, double from, double to, double means[]);
/*
  SamComplianceEnds - computes the smallest and the largest eigenvalue of the body's compliance relative to that of the
  body without it (of a pair: of both bodies), for tractions that are uniform on 20 x 20 cells of the patch, 20 of a
  section. For a rigid body they are 0 if the compliance is semidefinite, else negative, and 1.
*/
PETSC_INTERN PetscErrorCode SamComplianceEnds(SamCompliance compliance, SamPair pair, double *least, double *most);
/*
  SamComplianceCollect - computes the c_j of tractions p, q_x, q_y on body 2. Collective.
  SamComplianceNeedStress - checks that the file has the stresses of body 0 or 1. Collective. Errors: SAM_ERR_FILE if it
  has none, or those of the other body of a pair.
  SamComplianceReadStress - reads the axes x, y, z (m), then the stresses at the points by each c and each load case:
  SamComplianceStresses() numbers. Collective. Errors: SAM_ERR_FILE.
  SamComplianceAddStress - adds the stresses by c and the load cases to those of a half-space. Collective. Errors:
  SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamComplianceCollect(SamElasticity elasticity, SamCompliance compliance,
                                                 const double *const tractions[], double sums[3][SAM_COMPLIANCE_MODES]);
PETSC_INTERN PetscErrorCode SamComplianceNeedStress(MPI_Comm comm, SamCompliance compliance, PetscInt body);
PETSC_INTERN PetscErrorCode SamComplianceReadStress(MPI_Comm comm, SamCompliance compliance, double values[]);
PETSC_INTERN PetscErrorCode SamComplianceAddStress(SamElasticity elasticity, SamCompliance compliance,
                                                   SamStress stress);
/* SamComplianceIsPair - returns true if the compliance is that of a pair of bodies. Not collective. */
static inline PetscBool SamComplianceIsPair(SamCompliance c)
{
  return PetscIsNanReal(c->young1) ? PETSC_FALSE : PETSC_TRUE;
}
/*
  SamComplianceRow - returns the row of the matrix for direction k and polynomial m: a number for each direction and
  polynomial. SamComplianceCase - returns the coefficients of load case l in direction k. Not collective.
*/
static inline const double *SamComplianceRow(SamCompliance c, PetscInt k, PetscInt m)
{
  return c->matrix + (ptrdiff_t)(k * c->modes + m) * 3 * c->modes;
}
static inline const double *SamComplianceCase(SamCompliance c, PetscInt l, PetscInt k)
{
  return c->field + (ptrdiff_t)(3 * l + k) * c->modes;
}
/*
  SamComplianceField - returns the number of stress values of one field at all points. SamComplianceStresses - returns
  the number of values of the axes and of all fields, which are one for each c and each load case.
*/
static inline PetscInt SamComplianceField(SamCompliance c)
{
  return c->below[0] * c->below[1] * c->below[2] * SAM_STRESS_COMPONENTS;
}
static inline PetscInt SamComplianceStresses(SamCompliance c)
{
  return c->below[0] + c->below[1] + c->below[2] + (3 * c->modes + c->cases) * SamComplianceField(c);
}

#endif
