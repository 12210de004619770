/* Start and end of the library, log events, sums and maxima over the ranks. */
#include <petsam/private/baseimpl.h>
#include <fftw3-mpi.h>

PetscLogEvent SamEvents[SAM_EVENT_COUNT];

static PetscBool    initialized = PETSC_FALSE;
static MPI_Datatype total_type  = MPI_DATATYPE_NULL;
static MPI_Op       add_totals  = MPI_OP_NULL;

static void MPIAPI AddTotals(void *in, void *inout, int *n, MPI_Datatype *type)
{
  const SamTotal *a = (const SamTotal *)in;
  SamTotal       *b = (SamTotal *)inout;

  (void)type;
  for (int k = 0; k < *n; k++) {
    SamAdd(&b[k], a[k].sum);
    b[k].last += SamAddExactly(&b[k].rest, a[k].rest) + a[k].last;
  }
}

PetscErrorCode SamBaseInitialize(void)
{
  static const char *const names[SAM_EVENT_COUNT] = {
    "SamInfluence", "SamFFTRows",  "SamFFTColumns",  "SamFFTTranspose", "SamApplyN",  "SamApplyT", "SamApplyNT",
    "SamPrecondN",  "SamPrecondT", "SamNormalSolve", "SamTangSolve",    "SamPlastic", "SamCheck",  "SamEdges",
    "SamStiffness", "SamOutput",   "SamCheckpoint",  "SamGrid0",        "SamGrid1",   "SamGrid2",  "SamGrid3",
    "SamGrid4",     "SamGrid5",    "SamGrid6",       "SamGrid7"};

  PetscClassId id;

  PetscFunctionBegin;
  if (initialized) PetscFunctionReturn(PETSC_SUCCESS);
  initialized = PETSC_TRUE;
  PetscCallMPI(MPI_Type_contiguous(3, MPI_DOUBLE, &total_type));
  PetscCallMPI(MPI_Type_commit(&total_type));
  PetscCallMPI(MPI_Op_create(AddTotals, 1, &add_totals));
  fftw_mpi_init();
  fftwf_mpi_init();
  PetscCall(PetscClassIdRegister("petsam", &id));
  for (PetscInt e = 0; e < SAM_EVENT_COUNT; e++) PetscCall(PetscLogEventRegister(names[e], id, &SamEvents[e]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamFinalize(void)
{
  PetscFunctionBegin;
  if (!initialized) PetscFunctionReturn(PETSC_SUCCESS);
  initialized = PETSC_FALSE;
  PetscCallMPI(MPI_Op_free(&add_totals));
  PetscCallMPI(MPI_Type_free(&total_type));
  fftw_mpi_cleanup();
  fftwf_mpi_cleanup();
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamGetFolder(const char filename[], char folder[PETSC_MAX_PATH_LEN])
{
  const char *slash = strrchr(filename, '/');

  (void)snprintf(folder, PETSC_MAX_PATH_LEN, "%.*s", slash ? PetscMax((int)(slash - filename), 1) : 1,
                 slash ? filename : ".");
}

PetscErrorCode SamSum(MPI_Comm comm, PetscInt n, double values[])
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)n, MPI_DOUBLE, MPI_SUM, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSumTotals(MPI_Comm comm, PetscInt n, const SamTotal totals[], double sums[])
{
  enum { TOGETHER = 16 };
  SamTotal all[TOGETHER];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n; k++) {
    SamTotal *const one = &all[k % TOGETHER];
    double          lacks;

    if (one == all)
      PetscCallMPI(
        MPI_Allreduce(totals + k, all, (PetscMPIInt)PetscMin(TOGETHER, n - k), total_type, add_totals, comm));
    lacks   = SamAddExactly(&one->sum, one->rest); /* sum and rest may cancel, so they are added first, without loss */
    sums[k] = one->sum + (lacks + one->last);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamMax(MPI_Comm comm, PetscInt n, double values[])
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)n, MPI_DOUBLE, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamCountNodes(MPI_Comm comm, double *nodes, double *most)
{
  MPI_Comm    node;
  PetscMPIInt rank, size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  PetscCallMPI(MPI_Comm_rank(node, &rank));
  PetscCallMPI(MPI_Comm_size(node, &size));
  PetscCallMPI(MPI_Comm_free(&node));
  *nodes = rank ? 0 : 1;
  *most  = size;
  PetscCall(SamSum(comm, 1, nodes));
  PetscCall(SamMax(comm, 1, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamKeepMessage(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                              PetscErrorType type, const char *message, void *context)
{
  (void)comm;
  (void)line;
  (void)function;
  (void)file;
  if (type == PETSC_ERROR_INITIAL && message) SamOneLine(message, (char *)context, SAM_MESSAGE);
  return code;
}
