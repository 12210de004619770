/* What a run needs, and whether a node has it. */
#include "runimpl.h"

/*
  Bytes a cell at the peak, shared memory counted once, and the program with its libraries. Measured at 512 to 4096 cells, from
  more to less: without friction 80 to 65, with friction 200 to 175; 135 and 237 when pressure and shear are coupled.
*/
static const double bytes_per_cell[2][2] = {{90, 150}, {215, 255}}; /* by friction and coupling */
#define BYTES_PROGRAM 50e6

double SamRunMemory(SamGrid grid, const SamPair *pair, PetscReal friction)
{
  return BYTES_PROGRAM + bytes_per_cell[friction > 0][pair->dundurs != 0] * (double)grid->cells;
}

/* Memory of this node that can be had, bytes; 0 when it cannot be told. */
static double AvailableMemory(void)
{
  FILE  *file = fopen("/proc/meminfo", "r");
  char   line[128];
  double kilobytes = 0;

  if (!file) return 0;
  while (fgets(line, sizeof(line), file))
    if (sscanf(line, "MemAvailable: %lf", &kilobytes) == 1) break;
  fclose(file);
  return 1024 * kilobytes;
}

PetscErrorCode SamRunRefuseTooLarge(SamGrid grid, const SamPair *pair, PetscReal friction)
{
  double       need, worst;
  MPI_Comm     node;
  PetscBool    check = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamOptionsBool(NULL, "memory_check", "refuse a grid that the memory at hand cannot hold", &check, NULL));
  PetscCallMPI(MPI_Comm_split_type(grid->comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  need = SamRunMemory(grid, pair, friction);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &need, 1, MPI_DOUBLE, MPI_SUM, node));
  PetscCallMPI(MPI_Comm_free(&node));
  worst = AvailableMemory();
  worst = worst > 0 ? need / worst : 0;
  PetscCall(SamMax(grid->comm, 1, &worst));
  PetscCheck(!check || worst <= 1, grid->comm, SAM_ERR_USER, "-grid_n %" PetscInt_FMT ",%" PetscInt_FMT ": needs about %.3g GB on a node, %.1f times what is available; use more nodes, or -memory_check false", grid->nx, grid->ny, 1e-9 * need, worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}
