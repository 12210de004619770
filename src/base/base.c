/* Start and end of the library, log events and small reductions. */
#include "baseimpl.h"
#include <fftw3-mpi.h>

PetscLogEvent SamEvents[SAM_EVENT_COUNT];
PetscClassId  SAM_CLASSID;

static PetscBool initialized = PETSC_FALSE;

PetscErrorCode SamInitialize(void)
{
  static const char *const names[SAM_EVENT_COUNT] = {"SamInfluence", "SamFFTRows",   "SamFFTColumns",  "SamFFTTranspose", "SamApplyN",  "SamApplyT", "SamApplyNT",
                                                     "SamPrecondN",  "SamPrecondT", "SamNormalSolve", "SamTangSolve",    "SamCheck",   "SamOutput", "SamCheckpoint"};

  PetscFunctionBegin;
  if (initialized) PetscFunctionReturn(PETSC_SUCCESS);
  initialized = PETSC_TRUE;
  fftw_mpi_init();
  fftwf_mpi_init();
  PetscCall(PetscClassIdRegister("petsam", &SAM_CLASSID));
  for (PetscInt e = 0; e < SAM_EVENT_COUNT; e++) PetscCall(PetscLogEventRegister(names[e], SAM_CLASSID, &SamEvents[e]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFinalize(void)
{
  PetscFunctionBegin;
  if (!initialized) PetscFunctionReturn(PETSC_SUCCESS);
  initialized = PETSC_FALSE;
  fftw_mpi_cleanup();
  fftwf_mpi_cleanup();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSum(MPI_Comm comm, PetscInt n, double values[])
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)n, MPI_DOUBLE, MPI_SUM, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamMax(MPI_Comm comm, PetscInt n, double values[])
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)n, MPI_DOUBLE, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
