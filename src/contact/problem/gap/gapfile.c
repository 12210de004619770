/* A separation given cell by cell in an HDF5 file. */
#include <petsam/private/gapimpl.h>

static PetscErrorCode SamGapSetFromOptions_File(SamGap gap)
{
  const SamOptions from = {gap->comm, gap->prefix};

  PetscFunctionBegin;
  PetscCall(SamFieldFileSetFromOptions(&gap->source, &from, "HDF5 file with the separation: required by file"));
  PetscCheck(gap->source.file[0] || SamPrintHelp(), gap->comm, SAM_ERR_USER,
             "-%sgap_file is missing: the HDF5 file with the separation, required by -%sgap_type %s", gap->prefix,
             gap->prefix, gap->type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SamGapFill_File(SamGap gap, SamGrid grid, Vec h)
{
  PetscFunctionBegin;
  PetscCheck(gap->source.file[0], gap->comm, PETSC_ERR_ORDER,
             "A gap of type %s has no file: its options have not been read", gap->type);
  PetscCall(SamFieldFileRead(&gap->source, grid, h));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGapCreate_File(SamGap gap)
{
  PetscFunctionBegin;
  gap->ops.setfromoptions = SamGapSetFromOptions_File;
  gap->ops.fill           = SamGapFill_File;
  PetscFunctionReturn(PETSC_SUCCESS);
}
