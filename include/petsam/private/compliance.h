/* A body's own compliance: what its shape and its supports add to the half-space, from a file of petsam-compliance. */
#ifndef PETSAM_COMPLIANCE_H
#define PETSAM_COMPLIANCE_H

#include <petsam/private/elasticityimpl.h>
#include <petsam/private/stressimpl.h>

#define SAM_COMPLIANCE_DEGREE 10 /* highest of the polynomials */
#define SAM_COMPLIANCE_MODES  66 /* most polynomials: those up to this degree */
#define SAM_COMPLIANCE_CASES  8  /* most load cases of a body */
#define SAM_CASE_NAME         20 /* most letters of the name of one */

/*
  SamCompliance - of one body. The displacement of its surface by a traction t, less that of the half-space, is
  sum phi_i matrix[.][i][.][j] c_j with c_j the integral of phi_j t over the patch. phi: products of Legendre
  polynomials in x and y, orthonormal on the patch. Directions and places are those of the body's own frame, x, y and
  z into the body. That of body 2 is the contact's, that of body 1 is turned about x by half a turn.
*/
typedef struct _n_SamCompliance *SamCompliance;
struct _n_SamCompliance {
  PetscInt references;
  PetscInt body; /* 0 or 1 */
  char     file[PETSC_MAX_PATH_LEN];
  uint64_t checksum;           /* of all below */
  double   young, poisson;     /* of the half-space, Pa */
  double   center[2], half[2]; /* of the patch, m */
  PetscInt modes, degree, power[SAM_COMPLIANCE_MODES][2];
  double   matrix[3][SAM_COMPLIANCE_MODES][3][SAM_COMPLIANCE_MODES]; /* m3/N, symmetric */
  PetscInt cases;
  char     name[SAM_COMPLIANCE_CASES][32];
  PetscInt below[3]; /* points along x, y, z at which the stresses are known; 0: nowhere */
  double   field[SAM_COMPLIANCE_CASES][3][SAM_COMPLIANCE_MODES]; /* m2, displacements by the unit load case */
};

/*
  SamComplianceRead - of body 0 or 1, which `of` is without it, from the file that `option` (without dash) names.
  Collective. Errors: SAM_ERR_FILE for a file that cannot be read or does not fit, and where the body would gain energy
  under some traction.
*/
PETSC_INTERN PetscErrorCode SamComplianceRead(MPI_Comm comm, PetscInt body, SamBody of, const char option[],
                                              const char file[], SamCompliance *compliance);
/* SamComplianceFactor - the factor on load case l in a step, body1_case_<name> or body2_case_<name>. Not collective. */
PETSC_INTERN double SamComplianceFactor(SamCompliance compliance, SamConditions conditions, const SamControl *control,
                                        PetscInt l);
PETSC_INTERN PetscErrorCode SamComplianceDestroy(SamCompliance *compliance);
/* SamComplianceMeans - means of the orthonormal polynomials along axis 0 or 1 over an interval (m), m^-1/2. */
PETSC_INTERN void SamComplianceMeans(SamCompliance compliance, PetscInt axis, double from, double to, double means[]);
/*
  SamComplianceEnds - the smallest and the largest eigenvalue of the body's compliance relative to that of the
  body without it, of tractions that are uniform on 20 x 20 cells of the patch. Of a rigid body: 0 if it is
  semidefinite, else negative, and 1.
*/
PETSC_INTERN PetscErrorCode SamComplianceEnds(SamCompliance compliance, SamBody of, double *least, double *most);
/*
  SamComplianceCollect - c by tractions p, q_x, q_y on body 2. Collective.
  SamComplianceReadStress - the axes x, y, z (m), then the stresses at the points by each c and each load case; as many
  numbers as SamComplianceStresses(). Collective. Errors: SAM_ERR_FILE.
  SamComplianceAddStress - adds to the stresses of a half-space what c and the load cases add. Collective. Errors:
  SAM_ERR_FILE for a file without stresses.
*/
PETSC_INTERN PetscErrorCode SamComplianceCollect(SamElasticity elasticity, SamCompliance compliance,
                                                 const double *const tractions[], double sums[3][SAM_COMPLIANCE_MODES]);
PETSC_INTERN PetscErrorCode SamComplianceReadStress(MPI_Comm comm, SamCompliance compliance, double values[]);
PETSC_INTERN PetscErrorCode SamComplianceAddStress(SamElasticity elasticity, SamCompliance compliance,
                                                   SamStress stress);
/* The numbers of the stresses at all points of one field; of the axes, all fields by c and by load cases. */
static inline PetscInt SamComplianceField(SamCompliance c)
{
  return c->below[0] * c->below[1] * c->below[2] * SAM_STRESS_COMPONENTS;
}
static inline PetscInt SamComplianceStresses(SamCompliance c)
{
  return c->below[0] + c->below[1] + c->below[2] + (3 * c->modes + c->cases) * SamComplianceField(c);
}

#endif
