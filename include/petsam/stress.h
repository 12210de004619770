/* Stresses in the bodies under the tractions of a contact. */
#ifndef PETSAM_STRESS_H
#define PETSAM_STRESS_H

#include <petsam/fourier.h>

/* The components of the stress, tension positive, and the tractions that cause it, in the order used everywhere. */
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

/* SamStressDestroy - of what SamElasticityCreateStress() has made; sets the handle to NULL. Collective. */
PETSC_INTERN PetscErrorCode SamStressDestroy(SamStress *stress);
/* SamStressSetDepth - the plane z = depth (m, >= 0). Takes the time of some ten SamStressApply(). Collective. */
PETSC_INTERN PetscErrorCode SamStressSetDepth(SamStress stress, PetscReal depth);
/*
  SamStressApply - the stresses (Pa, SAM_STRESS_COMPONENTS components) at the cells' centres, in place of the tractions:
  on entry the components zz, xz and yz of `field` are the pressure and the two components of the shear (Pa). These are
  uniform in each cell; the result is corrected to that of tractions that are smooth (stresscell.c of the half-space).
  Bulk stress is not in it. Collective. Errors: PETSC_ERR_ORDER before the depth is set.
*/
PETSC_INTERN PetscErrorCode SamStressApply(SamStress stress, Vec field);

/*
  SamStressAtEdge - the stresses xx, yy and xy (Pa, three a point) on the surface at the points of the contact's edge,
  of a reconstruction of the pressure's square: the maximum tension lies there, and the values of the map approach it
  only with the square root of the cell size (src/bodies/elasticity/halfspace/stressedge.c). `field`: the map of
  SamStressApply() at depth 0. NaN within six cells of the grid's border, and where the type of elasticity has no such
  method. Collective.
*/
typedef struct _n_SamEdge   SamEdge;
PETSC_INTERN PetscErrorCode SamStressAtEdge(SamStress stress, Vec field, const SamEdge *edge, double values[]);

/*
  SamSection - the stresses on a plane across the surface, through a row or a column of cells, at many depths: much
  cheaper than the maps that hold it. Each rank has some of the depths.
*/
typedef struct _n_SamSection *SamSection;

/* A section along x lies at a row of cells, one along y at a column. */
typedef enum { SAM_SECTION_X, SAM_SECTION_Y } SamSectionAxis;

/*
  SamSectionCreate - through the row or column `index` of the grid, at n depths (m, >= 0). The stress must outlive it.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamSectionCreate(SamStress stress, SamSectionAxis axis, PetscInt index, PetscInt n,
                                             const PetscReal depths[], SamSection *section);
PETSC_INTERN PetscErrorCode SamSectionDestroy(SamSection *section);
/* SamSectionGetDepths - the first of the depths of this rank, their number, and the cells along. Not collective. */
PETSC_INTERN PetscErrorCode SamSectionGetDepths(SamSection section, PetscInt *first, PetscInt *count, PetscInt *length);
/*
  SamSectionAddStep - keeps tractions (Pa, three components: the pressure and the shear along x and y), whose stresses
  the next SamSectionCompute() finds together with those of other steps, at a fraction of the time of the first. Every
  rank keeps the spectra of all lines of cells that have traction, 48 bytes a cell. Collective.
*/
PETSC_INTERN PetscErrorCode SamSectionAddStep(SamSection section, Vec tractions);
/*
  SamSectionCompute - the stresses (Pa) of the steps that have been added, and forgets these: value
  ((s * SAM_STRESS_COMPONENTS + c) * count + k) * length + i is component c of step s at this rank's k-th depth in cell
  i. As SamStressApply() in all else, and the same on any number of ranks. Not collective.
*/
PETSC_INTERN PetscErrorCode SamSectionCompute(SamSection section, double stress[]);

/*
  Quantities of a stress at n points, whose components are arrays s[0] ... s[SAM_STRESS_COMPONENTS - 1]. Not collective.
    SamStressMises      the von Mises stress
    SamStressPrincipal  the principal stresses p[0] >= p[1] >= p[2], to rounding of the largest component
    SamStressStrain     the strains by Hooke's law, tensor shear strains, in the order of the stresses; none in a rigid
                        body, of infinite modulus
*/
PETSC_INTERN void SamStressMises(PetscInt n, const double *const s[], double mises[]);
PETSC_INTERN void SamStressPrincipal(PetscInt n, const double *const s[], double *const p[3]);
PETSC_INTERN void SamStressStrain(PetscInt n, PetscReal young, PetscReal poisson, const double *const s[],
                                  double *const e[]);

#endif
