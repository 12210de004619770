/* The memory that a run needs, and whether each node has it. */
#include "runimpl.h"

/*
  Bytes per cell at the peak, shared memory counted once. Measured on grids of 512 to 4096 cells a side:
    one step        without friction 55 to 85; with friction 115 to 130 for contact on half of the grid, 215 for
                    contact on all of it; coupled: 115 to 155, with friction 225 to 310
    several steps   without friction 125 to 155, with friction 250 to 290; coupled: 215, with friction 315
*/
static const double bytes_per_cell[2][2][2] = {{{85, 150}, {170, 270}},
                                               {{140, 220}, {275, 320}}}; /* [several steps][friction][coupled] */
#define BYTES_PROGRAM 50e6 /* the program and its libraries, on each rank */

double SamRunMemory(SamGrid grid, const SamRunNeeds *needs)
{
  return BYTES_PROGRAM + bytes_per_cell[needs->steps > 1][needs->friction][needs->coupled] * (double)grid->cells;
}

/* Available memory of this node, bytes; 0 if that is not known. */
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

PetscErrorCode SamRunRefuseTooLarge(SamGrid grid, const SamRunNeeds *needs, const SamOptions *from)
{
  double    need, worst;
  MPI_Comm  node;
  PetscBool check = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamOptionsBool(from, "memory_check", "refuse a grid that the memory at hand cannot hold", &check, NULL));
  PetscCallMPI(MPI_Comm_split_type(grid->comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  need = SamRunMemory(grid, needs);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &need, 1, MPI_DOUBLE, MPI_SUM, node));
  PetscCallMPI(MPI_Comm_free(&node));
  worst = AvailableMemory();
  worst = worst > 0 ? need / worst : 0;
  PetscCall(SamMax(grid->comm, 1, &worst));
  PetscCheck(!check || worst <= 1, grid->comm, SAM_ERR_USER,
             "-grid_n %" PetscInt_FMT ",%" PetscInt_FMT
             ": needs about %.3g GB on a node, %.1f times what is available; use more nodes, or -memory_check false",
             grid->nx, grid->ny, 1e-9 * need, worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}
