/* What a run says about its steps. */
#ifndef PETSAM_SUMMARY_H
#define PETSAM_SUMMARY_H

#include <petsam/contact.h>

/* SamStepView - a step in a few lines: loads, displacements, areas, iterations, check. Collective on the viewer. */
PETSC_EXTERN PetscErrorCode SamStepView(const SamStep *step, PetscViewer viewer);

#endif
