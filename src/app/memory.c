/* The memory that a run needs, and whether each node has it. */
#include "memory.h"
#include "runimpl.h"
#include <petsam/private/baseimpl.h>

/*
  Bytes per cell at the peak, shared memory counted once, without the program and its libraries. Measured at 1024 cells
  a side, for contact on half of the grid and on all of it; up to 15 less from 2048 cells on:
    one step        without friction 72 and 82, with friction 165 and 214, coupled 362 and 424
    several steps   without friction 255 and 270, with friction 335 and 358, coupled 490 and 538
  Several steps need a second state to go back to.
*/
static const double bytes_per_cell[2][2][2] = {{{85, 150}, {190, 400}},
                                               {{265, 365}, {350, 520}}}; /* [several steps][friction][coupled] */

/* Of a life, bytes per cell. */
#define LIFE_BYTES (16 * 8)

/*
  Of the tangent stiffness, bytes per cell: most of it solutions and search directions, which are of cells in contact.
  Measured at 512 cells a side, for contact on 50 and 79 % of the grid: without friction 228 and 330, with friction 294
  and 408, coupled 528 and 729; continued to all of the grid.
*/
static const double stiffness_bytes[2][2] = {{400, 400}, {490, 880}}; /* [friction][coupled] */

PetscErrorCode SamRunMemory(SamSimulation simulation, double *bytes)
{
  const SamSetup    *setup;
  SamSimulationNeeds needs;
  double             cell;

  PetscFunctionBegin;
  PetscCall(SamSimulationGetSetup(simulation, &setup));
  PetscCall(SamSimulationGetNeeds(simulation, &needs));
  cell = bytes_per_cell[needs.steps > 1][needs.friction][needs.coupled] + (double)needs.laws +
         (needs.life ? LIFE_BYTES : 0) + (needs.stiffness ? stiffness_bytes[needs.friction][needs.coupled] : 0);
  *bytes = SAM_MEMORY_PROGRAM + cell * (double)setup->grid->cells;
  PetscFunctionReturn(PETSC_SUCCESS);
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

PetscErrorCode SamMemoryRefuse(MPI_Comm comm, double bytes, const char option[], const char value[],
                               const SamOptions *from)
{
  double    need = bytes, worst;
  MPI_Comm  node;
  PetscBool check = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamOptionsBool(from, "memory_check", "refuse what the memory at hand cannot hold", &check, NULL));
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &need, 1, MPI_DOUBLE, MPI_SUM, node));
  PetscCallMPI(MPI_Comm_free(&node));
  worst = AvailableMemory();
  worst = worst > 0 ? need / worst : 0;
  PetscCall(SamMax(comm, 1, &worst));
  PetscCheck(
    !check || worst <= 1, comm, SAM_ERR_USER,
    "%s %s: needs about %.3g GB on a node, %.1f times what is available; use more nodes, or -memory_check false",
    option, value, 1e-9 * need, worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunRefuseTooLarge(SamSimulation simulation, const SamOptions *from)
{
  const SamSetup *setup;
  double          bytes;
  char            cells[64];

  PetscFunctionBegin;
  PetscCall(SamSimulationGetSetup(simulation, &setup));
  PetscCall(SamRunMemory(simulation, &bytes));
  PetscCall(PetscSNPrintf(cells, sizeof(cells), "%" PetscInt_FMT ",%" PetscInt_FMT, setup->grid->nx, setup->grid->ny));
  PetscCall(SamOptionsHeading(from, "Memory"));
  PetscCall(SamMemoryRefuse(setup->grid->comm, bytes, "-grid_n", cells, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}
