/* Checks that each node has the memory that a run needs. */
#include "program.h"
#include <petsam/private/baseimpl.h>
#include <stdlib.h>

double SamMemoryRead(const char name[], const char row[])
{
  const size_t length = strlen(row);
  FILE        *file   = fopen(name, "r");
  char         line[128];
  double       kilobytes = 0;

  while (file && fgets(line, sizeof(line), file))
    if (!strncmp(line, row, length)) kilobytes = strtod(line + length, NULL);
  if (file) fclose(file);
  return 1024 * kilobytes;
}

PetscErrorCode SamMemoryRefuse(MPI_Comm comm, double bytes, const char option[], const char value[],
                               const SamOptions *from)
{
  static const SamOptionRow row = {"memory_check", "stop if the estimate exceeds the available memory", SAM_OPTION_BOOL,
                                   .member = 0};
  double                    need = bytes, worst;
  char                      memory[32];
  MPI_Comm                  node;
  PetscBool                 check = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &check, NULL));
  PetscCallMPI(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &need, 1, MPI_DOUBLE, MPI_SUM, node));
  PetscCallMPI(MPI_Comm_free(&node));
  worst = SamMemoryRead("/proc/meminfo", "MemAvailable:");
  worst = worst > 0 ? need / worst : 0;
  PetscCall(SamMax(comm, 1, &worst));
  SamDescribeBytes(need, memory, sizeof(memory));
  PetscCheck(!check || worst <= 1, comm, SAM_ERR_USER,
             "%s %s: needs about %s on a node, %.1f times the available memory: use more nodes, or -memory_check false",
             option, value, memory, worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}
