/* The parts of a run's results. */
#ifndef PETSAM_PARTS_H
#define PETSAM_PARTS_H

#include <petsam/private/output.h>

/*
  The results of a run that was stopped and restarted are in parts: the file that the user names, then one more file for
  each restart (r.h5, r.part2.h5, ...). A part is valid up to the step at which the next one begins. Each part has an
  identity, a root attribute, and all but the first also name the identity of the previous part, so that no file of
  another run is mistaken for a part.

  SamOutputNamePart - creates the name of a part, counted from 1; the caller frees it with PetscFree(). Not collective.
  SamOutputGetIdentity - returns the identity of the file. Not collective.
  SamOutputFollow - makes the file, which must have no step yet, the part that follows another one (identity 0: none)
  after `steps` load steps, and `cycles` computed cycles of the second series. Collective. Errors: SAM_ERR_FILE.
  SamOutputCheckPart - fails if a file is missing, is being written by another run, or has another identity. Collective.
  Errors: SAM_ERR_FILE, SAM_ERR_USER.
*/
#define SAM_OUTPUT_TRACTIONS "traction_error" /* attribute, a number: error of the largest tractions, relative */
#define SAM_OUTPUT_BRANCH    "branch_step"    /* attribute, a number: load steps before the file */
#define SAM_OUTPUT_CYCLES    "branch_rows"    /* attribute, a number: computed cycles before the file */
#define SAM_OUTPUT_IDENTITY  "part_identity"  /* attribute, a text */
#define SAM_OUTPUT_FOLLOWS   "part_follows"   /* attribute, a text: identity of the previous part */
#define SAM_OUTPUT_STRESSES  "stresses_of"    /* attribute, a text: groups with stresses in layers, with commas */
#define SAM_OUTPUT_LAYERS    "_layers" /* of such a group, behind its name: counts in both bodies, 1 if initial */
PETSC_INTERN PetscErrorCode SamOutputNamePart(const char filename[], PetscInt part, char **name);
PETSC_INTERN uint64_t       SamOutputGetIdentity(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputFollow(SamOutput output, uint64_t identity, PetscInt steps, PetscInt cycles);
PETSC_INTERN PetscErrorCode SamOutputCheckPart(SamGrid grid, const char filename[], uint64_t identity);

#endif
