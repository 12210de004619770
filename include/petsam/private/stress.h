/* Stresses in the bodies under the tractions of a contact. */
#ifndef PETSAM_PRIVATE_STRESS_H
#define PETSAM_PRIVATE_STRESS_H

#include <petsam/private/fourier.h>

/*
  SamStressComponent, SamStressTraction - the components of the stress, tension positive, and the tractions that cause
  it, in the order used everywhere.
*/
typedef enum {
  SAM_STRESS_XX,
  SAM_STRESS_YY,
  SAM_STRESS_ZZ,
  SAM_STRESS_XY,
  SAM_STRESS_XZ,
  SAM_STRESS_YZ,
  SAM_STRESS_COMPONENTS
} SamStressComponent;
typedef enum { SAM_STRESS_P, SAM_STRESS_QX, SAM_STRESS_QY, SAM_STRESS_TRACTIONS } SamStressTraction;

/*
  SamStress - the stresses on planes parallel to the surface. z points into the body; on the surface of body 2 zz is -p,
  xz is -q_x and yz is -q_y, of body 1 zz is -p, xz is q_x and yz is q_y.
*/
typedef struct _n_SamStress *SamStress;

/*
  SamStressDestroy - frees an object that SamElasticityCreateStress() has created, and sets the handle to NULL.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamStressDestroy(SamStress *stress);
/*
  SamStressSetDepth - selects the plane z = depth (m, >= 0). It takes about ten times as long as SamStressApply().
  Collective.
*/
PETSC_INTERN PetscErrorCode SamStressSetDepth(SamStress stress, PetscReal depth);
/*
  SamStressApply - computes the stresses (Pa, SAM_STRESS_COMPONENTS components) at the centres of the cells, in place of
  the tractions: on entry the components zz, xz and yz of `field` are the pressure and the two components of the shear
  (Pa). These are uniform in each cell; the result is corrected to that of smooth tractions (stresscell.c of the
  half-space). It does not contain bulk stress. Collective. Errors: PETSC_ERR_ORDER before the depth is set.
*/
PETSC_INTERN PetscErrorCode SamStressApply(SamStress stress, Vec field);

/*
  SamStressAtEdge - computes the stresses xx, yy and xy (Pa, three per point) on the surface at the points of the
  contact edge, which was reconstructed from the square of the pressure. The maximum tension lies there, and the values
  of the map approach it only with the square root of the cell size (src/bodies/kernels/stressedge.c).
  `field`: the map of SamStressApply() at depth 0. NaN within six cells of the grid's border, and if the type of
  elasticity has no such method. Collective.
*/
typedef struct _n_SamEdge   SamEdge;
PETSC_INTERN PetscErrorCode SamStressAtEdge(SamStress stress, Vec field, const SamEdge *edge, double values[]);

/*
  SamSection - the stresses on a plane perpendicular to the surface, through a row or a column of cells, at many depths.
  It is much cheaper than maps at these depths. Each rank has some of the depths.
*/
typedef struct _n_SamSection *SamSection;

/* SamSectionAxis - the axis of a section: a section along x lies at a row of cells, a section along y at a column. */
typedef enum { SAM_SECTION_X, SAM_SECTION_Y } SamSectionAxis;

/*
  SamSectionCreate - creates a section through the row or column `index` of the grid, at n depths (m, >= 0). `stress`
  must outlive it. Collective.
*/
PETSC_INTERN PetscErrorCode SamSectionCreate(SamStress stress, SamSectionAxis axis, PetscInt index, PetscInt n,
                                             const PetscReal depths[], SamSection *section);
PETSC_INTERN PetscErrorCode SamSectionDestroy(SamSection *section);
/*
  SamSectionGetDepths - gets the index of this rank's first depth, its number of depths, and the number of cells along
  the section. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSectionGetDepths(SamSection section, PetscInt *first, PetscInt *count, PetscInt *length);
/*
  SamSectionAddStep - adds a step, given by its tractions (Pa, three components: the pressure and the shear along x and
  y). The next SamSectionCompute() computes the stresses of all added steps together; each further step takes a fraction
  of the time of the first. Every rank keeps the spectra of all lines of cells that have traction, 48 bytes per cell.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSectionAddStep(SamSection section, Vec tractions);
/*
  SamSectionCompute - computes the stresses (Pa) of the added steps, and then forgets these steps: value ((s *
  SAM_STRESS_COMPONENTS + c) * count + k) * length + i is component c of step s at this rank's k-th depth in cell i. All
  else is as in SamStressApply(); the result is the same on any number of ranks. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSectionCompute(SamSection section, double stress[]);

/*
  The following functions compute quantities of a stress at n points, whose components are the arrays s[0] ...
  s[SAM_STRESS_COMPONENTS - 1]. Not collective.
    SamStressMises      the von Mises stress
    SamStressPrincipal  the principal stresses p[0] >= p[1] >= p[2], up to rounding of the largest component
    SamStressStrain     the strains by Hooke's law, with tensor shear strains, in the order of the stresses; zero in a
                        rigid body (infinite modulus)
*/
PETSC_INTERN void SamStressMises(PetscInt n, const double *const s[], double mises[]);
PETSC_INTERN void SamStressPrincipal(PetscInt n, const double *const s[], double *const p[3]);
PETSC_INTERN void SamStressStrain(PetscInt n, PetscReal young, PetscReal poisson, const double *const s[],
                                  double *const e[]);

#endif
