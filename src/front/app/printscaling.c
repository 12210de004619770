/* The table of times and memory on other numbers of ranks. */
#include "report.h"
#include <math.h>
#include <petsam/private/baseimpl.h>

PetscErrorCode SamReportScaling(SamReport r, PetscInt lines, int ranks, const double bytes[2],
                                const SamSimulationStart *start)
{
  const double here = ceil((double)lines / ranks);

  PetscFunctionBegin;
  if (!start->cores) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
    PetscPrintf(r->comm,
                "  %-10s  of other ranks on nodes of %d cores as here, from that time and usual speeds of memory "
                "and network\n"
                "  %-10s  %8s %8s %10s %10s %16s\n",
                "model", start->cores, "", "ranks", "nodes", "s per step", "messages", "memory per rank"));
  for (int k = 0; k < SAM_SCALINGS; k++) {
    const SamScalingTime *t = &start->scaling[k];
    char                  memory[32];

    SamDescribeBytes(bytes[1] + (bytes[0] - bytes[1]) * ceil((double)lines / t->ranks) / here, memory, sizeof(memory));
    PetscCall(PetscPrintf(r->comm, "  %-10s  %8d %8d %10.2g %8.0f %% %16s\n", "", t->ranks, t->nodes, t->seconds,
                          100 * t->messages / t->seconds, memory));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
