/* The parts of a run's results. */
#ifndef PETSAM_PARTS_H
#define PETSAM_PARTS_H

#include <petsam/private/output.h>

/*
  The results of a run that was stopped and restarted are in parts: the file that the user names, then one beside it for
  each restart (r.h5, r.part2.h5, ...). A part counts up to where the next one begins. Each has an identity, a root
  attribute, and all but the first name that of the part before, so that no file of another run is taken for a part.

  SamOutputNamePart - the name of a part, from 1; the caller frees it with PetscFree(). Not collective.
  SamOutputGetIdentity - the identity of the file. Not collective.
  SamOutputFollow - makes the file, which has no step yet, the part that follows another one (identity 0: none) after so
  many load steps, and computed cycles of the second series. Collective. Errors: SAM_ERR_FILE.
  SamOutputCheckPart - fails if a file is missing, is being written by another run, or has not that identity.
  Collective. Errors: SAM_ERR_FILE, SAM_ERR_USER.
*/
#define SAM_OUTPUT_BRANCH   "branch_step"   /* attribute, a number: the load steps before the first of the file */
#define SAM_OUTPUT_CYCLES   "branch_rows"   /* likewise: the computed cycles before */
#define SAM_OUTPUT_IDENTITY "part_identity" /* attribute, a text */
#define SAM_OUTPUT_FOLLOWS  "part_follows"  /* likewise: identity of the part before */
PETSC_INTERN PetscErrorCode SamOutputNamePart(const char filename[], PetscInt part, char **name);
PETSC_INTERN uint64_t       SamOutputGetIdentity(SamOutput output);
PETSC_INTERN PetscErrorCode SamOutputFollow(SamOutput output, uint64_t identity, PetscInt steps, PetscInt cycles);
PETSC_INTERN PetscErrorCode SamOutputCheckPart(SamGrid grid, const char filename[], uint64_t identity);

#endif
