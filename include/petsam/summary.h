/* What a run says about its steps. */
#ifndef PETSAM_SUMMARY_H
#define PETSAM_SUMMARY_H

#include <petsam/contact.h>

/* SamStepView - a step in a few lines: loads, displacements, areas, iterations, check. Collective on the viewer. */
PETSC_EXTERN PetscErrorCode SamStepView(const SamStep *step, PetscViewer viewer);
/* SamStepViewHeading, SamStepViewLine - one line a step in fixed columns, for a sequence of steps. */
PETSC_EXTERN PetscErrorCode SamStepViewHeading(PetscViewer viewer);
PETSC_EXTERN PetscErrorCode SamStepViewLine(const SamStep *step, PetscInt number, PetscViewer viewer);

#endif
