/* Files of stresses in a body. */
#ifndef PETSAM_STRESSFILE_H
#define PETSAM_STRESSFILE_H

#include <petsam/evaluation.h>
#include <petsam/output.h>

/*
  SamStressFile - an HDF5 file with the datasets of the quantities, of shape (time, z, y, x), or (z, y, x) for those of
  all steps together, their coordinates, and the largest values of each step in /history. Every dataset has the
  attributes `units` and `long_name` and its dimension scales, so that h5py and xarray open it.
*/
typedef struct _n_SamStressFile *SamStressFile;

/*
  SamStressFileCreate - creates the file with all datasets; replaces an older file of petsam. It takes the name only
  when SamStressFileFinish() has completed it. Collective. Errors: SAM_ERR_FILE, also when there is no space for it.
*/
PETSC_EXTERN PetscErrorCode SamStressFileCreate(SamGrid grid, const char filename[], const SamStressLayout *layout,
                                                const SamParameters *parameters, SamStressFile *file);
/*
  SamStressFileWrite - this rank's values of a quantity's component: of a map those of its rows at one depth (`depth`,
  `depths` being 1), of a section those of `depths` depths from `depth` on, (depths, length). `step` does not matter for
  a quantity of all steps together. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamStressFileWrite(SamStressFile file, SamQuantity quantity, PetscInt component,
                                               PetscInt step, PetscInt depth, PetscInt depths, const double values[]);
/*
  SamStressFileSetLargest - the largest value of a quantity of all steps together, and its x, y and z (m): attributes of
  its first dataset. Collective. Errors: SAM_ERR_FILE.
*/
PETSC_EXTERN PetscErrorCode SamStressFileSetLargest(SamStressFile file, SamQuantity quantity, double value,
                                                    const double place[3]);
/* SamStressFileSetText - an attribute of the root group. Collective. Errors: SAM_ERR_FILE. */
PETSC_EXTERN PetscErrorCode SamStressFileSetText(SamStressFile file, const char name[], const char text[]);
/* SamStressFileSetHistory - a number for each step in /history, with its unit. Collective. Errors: SAM_ERR_FILE. */
PETSC_EXTERN PetscErrorCode SamStressFileSetHistory(SamStressFile file, const char name[], const char units[],
                                                    const char long_name[], const double values[]);
/* SamStressFileFinish - completes the file and gives it its name. Collective. Errors: SAM_ERR_FILE. */
PETSC_EXTERN PetscErrorCode SamStressFileFinish(SamStressFile file);
/* SamStressFileAbandon - removes a file that has not been finished, before the program is aborted. Not collective. */
PETSC_EXTERN void SamStressFileAbandon(SamStressFile file);
/* SamStressFileDestroy - removes a file that has not been finished. Collective. */
PETSC_EXTERN PetscErrorCode SamStressFileDestroy(SamStressFile *file);

#endif
