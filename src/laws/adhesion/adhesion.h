/* Adhesion: the tension between surfaces, by its range and its work. */
#ifndef PETSAM_ADHESION_H
#define PETSAM_ADHESION_H

#include <petsam/private/lawimpl.h>

#define SAM_LAW_ADHESION "adhesion"

/* SamAdhesion - the data of the law. */
typedef enum { SAM_ADHESION_MAUGIS, SAM_ADHESION_EXPONENTIAL } SamAdhesionKind;
typedef struct {
  SamAdhesionKind kind;
  PetscReal       work;   /* of adhesion, J/m2 */
  PetscReal       stress; /* tension of surfaces in contact, Pa */
  PetscReal       radius; /* of a ball on a flat, or relative one of two balls, m; 0: of other shapes */
} SamAdhesion;

/*
  SamAdhesionRange - returns the gap (m) at which the tension ends (Maugis), or by which it falls to 1/e.
  SamAdhesionCells - computes the tension (Pa) or, as `energy`, its energy (J/m2, not positive) in each cell, as means
  over the cells, from the gap (m); adds to `values` of one component (adhesioncells.c). Collective.
  SamAdhesionWarn - warns before a run of an edge of the tension that is narrower than cells. Collective.
  SamAdhesionDoubt - the law's method (adhesiondoubt.c). SamLawCreate_Adhesion - creates the law, for the registry.
*/
static inline double SamAdhesionRange(const SamAdhesion *a)
{
  return (double)(a->work / a->stress);
}
PETSC_INTERN PetscErrorCode SamAdhesionCells(SamLaw law, Vec gap, PetscBool energy, Vec values);
PETSC_INTERN PetscErrorCode SamLawCreate_Adhesion(SamLaw law);
PETSC_INTERN PetscErrorCode SamAdhesionWarn(SamLaw law);
PETSC_INTERN PetscErrorCode SamAdhesionDoubt(SamLaw law, SamExamination *examination);

#endif
