/*
  The files of a run. Names that petsam derives count too: the XDMF file beside the results, a checkpoint's file.1 and
  file.tmp.
*/
#include "files.h"
#include "runimpl.h"
#include <petsam/private/baseimpl.h>
#include <petsam/checkpoint.h>
#include <petsam/output.h>

static PetscErrorCode AddRead(SamFiles *files)
{
  static const struct {
    const char *option, *name; /* as the options database has it; as users know it */
  } inputs[] = {{"-gap_file", "-gap_file"},           {"-gap_rough_file", "-gap_rough_file"},
                {"-friction_file", "-friction_file"}, {"-load_history", "-history"},
                {"-wear_friction", "-wear_friction"}, {"-restart", "-restart"}};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(inputs) / sizeof(inputs[0]); k++) {
    char      name[PETSC_MAX_PATH_LEN];
    PetscBool set;

    PetscCall(PetscOptionsGetString(NULL, NULL, inputs[k].option, name, sizeof(name), &set));
    if (set) PetscCall(SamFilesAdd(files, SAM_FILE_READ_ONLY, inputs[k].name, name, PETSC_FALSE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two files whose names are derived from an option's value; either may be left out. */
static PetscErrorCode AddDerived(SamFiles *files, const char option[], char *one, PetscBool has_one, char *other,
                                 PetscBool has_other)
{
  PetscFunctionBegin;
  if (has_one) PetscCall(SamFilesAdd(files, SAM_FILE_WRITTEN, option, one, PETSC_TRUE));
  if (has_other) PetscCall(SamFilesAdd(files, SAM_FILE_WRITTEN, option, other, PETSC_TRUE));
  PetscCall(PetscFree(one));
  PetscCall(PetscFree(other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddWritten(const SamRun *run, SamFiles *files)
{
  SamSimulationFiles f;
  char              *one, *other;

  PetscFunctionBegin;
  PetscCall(SamSimulationGetFiles(run->simulation, &f));
  if (f.output) {
    PetscCall(SamFilesAdd(files, SAM_FILE_WRITTEN, "-output", f.output, PETSC_FALSE));
    PetscCall(SamOutputNames(f.output, &one, &other));
    PetscCall(AddDerived(files, "-output", one, f.xdmf, other, f.restart != NULL));
  }
  if (f.checkpoint) {
    PetscCall(SamFilesAdd(files, SAM_FILE_WRITTEN, "-checkpoint", f.checkpoint, PETSC_FALSE));
    PetscCall(SamCheckpointNames(f.checkpoint, &one, &other));
    PetscCall(AddDerived(files, "-checkpoint", one, PETSC_TRUE, other, PETSC_TRUE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunCheckFiles(const SamRun *run, MPI_Comm comm, const SamArguments *arguments)
{
  SamFiles       files = {.count = 0};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(AddRead(&files));
  PetscCall(AddWritten(run, &files));
  ierr = SamFilesCheck(&files, comm, arguments);
  PetscCall(SamFilesFree(&files));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
