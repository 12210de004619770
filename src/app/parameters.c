/* What defines a run, by the names of its options. */
#include "runimpl.h"

/* Separations that come from files are known by their checksum: a file may change under its name. */
static PetscErrorCode AddFiles(SamRun *run, Vec separation)
{
  static const char *const options[] = {"-gap_file", "-gap_rough_file"};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; k++) {
    char      text[64] = "none";
    uint64_t  checksum;
    PetscBool set;

    PetscCall(PetscOptionsHasName(NULL, NULL, options[k], &set));
    if (set) {
      PetscCall(SamCheckpointChecksum(run->grid, separation, &checksum));
      PetscCall(PetscSNPrintf(text, sizeof(text), "of checksum %08lx%08lx", (unsigned long)(checksum >> 32),
                              (unsigned long)(checksum & 0xffffffff)));
    }
    PetscCall(SamParametersAddText(&run->parameters, options[k] + 1, PETSC_TRUE, text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddPair(SamParameters *p, const SamPair *pair)
{
  PetscFunctionBegin;
  for (PetscInt body = 0; body < 2; body++) {
    char name[32];

    PetscCall(PetscSNPrintf(name, sizeof(name), "body%d_young", (int)body + 1));
    PetscCall(SamParametersAddReals(p, name, PETSC_TRUE, 1, &pair->young[body]));
    PetscCall(PetscSNPrintf(name, sizeof(name), "body%d_poisson", (int)body + 1));
    PetscCall(SamParametersAddReals(p, name, PETSC_TRUE, 1, &pair->poisson[body]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddGrid(SamParameters *p, SamGrid grid)
{
  const PetscReal n[2] = {(PetscReal)grid->nx, (PetscReal)grid->ny};

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "grid_n", PETSC_TRUE, 2, n));
  PetscCall(SamParametersAddReals(p, "grid_size", PETSC_TRUE, 2, grid->width));
  PetscCall(SamParametersAddReals(p, "grid_center", PETSC_TRUE, 2, grid->center));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddGap(SamRun *run, Vec separation)
{
  SamGapType         type;
  PetscInt           count;
  const char *const *names;
  const PetscReal   *values;

  PetscFunctionBegin;
  PetscCall(SamGapGetParameters(run->gap, &type, &count, &names, &values));
  PetscCall(SamParametersAddText(&run->parameters, "gap_type", PETSC_TRUE, type));
  for (PetscInt k = 0; k < count; k++)
    PetscCall(SamParametersAddReals(&run->parameters, names[k], PETSC_TRUE, 1, &values[k]));
  PetscCall(AddFiles(run, separation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a history, the last step's: how it went there stands in /history, and checkpoints look at the steps themselves. */
static PetscErrorCode AddLoads(SamParameters *p, SamHistory history)
{
  const SamBalance *balances[2];
  SamStep           step;
  PetscInt          count, increments;
  PetscReal         steps;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(history, &count));
  PetscCall(SamHistoryGetIncrements(history, &increments));
  steps = (PetscReal)increments;
  PetscCall(SamParametersAddReals(p, "steps", PETSC_TRUE, 1, &steps));
  PetscCall(SamHistoryGetStep(history, count - 1, &step));
  balances[0] = &step.normal;
  balances[1] = &step.tangential;
  for (PetscInt b = 0; b < 2; b++)
    for (PetscInt k = 0; k < 3; k++) {
      if (balances[b]->force[k])
        PetscCall(SamParametersAddReals(p, SamLoadNames[b][k], PETSC_FALSE, 1, &balances[b]->load[k]));
      else
        PetscCall(SamParametersAddReals(p, SamRigidNames[b][k], PETSC_FALSE, 1, &balances[b]->rigid[k]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunCollectParameters(SamRun *run, Vec separation)
{
  SamParameters *const p = &run->parameters;
  PetscBool            full;

  PetscFunctionBegin;
  p->count = 0;
  PetscCall(AddGrid(p, run->grid));
  PetscCall(AddPair(p, &run->pair));
  PetscCall(SamParametersAddReals(p, "friction", PETSC_TRUE, 1, &run->friction));
  PetscCall(AddGap(run, separation));
  PetscCall(SamContactGetCoupling(run->contact, &full));
  PetscCall(SamParametersAddText(p, "coupling", PETSC_TRUE, full ? "full" : "none"));
  PetscCall(AddLoads(p, run->history));
  PetscFunctionReturn(PETSC_SUCCESS);
}
