/* The parameters that define a run, named as its options. */
#include "runimpl.h"

/* What comes from a file is identified by its checksum, since a file may change and keep its name. */
static PetscErrorCode AddChecksum(SamParameters *p, const char name[], uint64_t checksum)
{
  char text[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(text, sizeof(text), "of checksum %08lx%08lx", (unsigned long)(checksum >> 32),
                          (unsigned long)(checksum & 0xffffffff)));
  PetscCall(SamParametersAddText(p, name, PETSC_TRUE, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddField(SamRun *run, const char name[], Vec field)
{
  uint64_t checksum;

  PetscFunctionBegin;
  PetscCall(SamCheckpointChecksum(run->grid, field, &checksum));
  PetscCall(AddChecksum(&run->parameters, name, checksum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddFiles(SamRun *run)
{
  static const char *const options[] = {"-gap_file", "-gap_rough_file"};

  Vec separation;

  PetscFunctionBegin;
  PetscCall(SamProblemGetGap(run->problem, &separation));
  for (PetscInt k = 0; k < 2; k++) {
    PetscBool set;

    PetscCall(PetscOptionsHasName(NULL, NULL, options[k], &set));
    if (set)
      PetscCall(AddField(run, options[k] + 1, separation));
    else
      PetscCall(SamParametersAddText(&run->parameters, options[k] + 1, PETSC_TRUE, "none"));
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

static PetscErrorCode AddGap(SamRun *run)
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
  PetscCall(AddFiles(run));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The coefficient of friction; a field is identified by its checksum. */
static PetscErrorCode AddFriction(SamRun *run)
{
  PetscReal friction;
  Vec       field;

  PetscFunctionBegin;
  PetscCall(SamProblemGetFriction(run->problem, &friction, &field));
  if (!field)
    PetscCall(SamParametersAddReals(&run->parameters, "friction", PETSC_TRUE, 1, &friction));
  else
    PetscCall(AddField(run, "friction_file", field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The loads and bulk stresses of the last step. The steps of a history are in /history of the results, and checkpoints
  compare them themselves (checkpoints.c).
*/
static PetscErrorCode AddLoads(SamParameters *p, SamHistory history)
{
  SamControl control;
  PetscInt   count, increments;
  PetscReal  steps;
  PetscBool  friction, bulk;

  PetscFunctionBegin;
  PetscCall(SamHistoryGetCount(history, &count));
  PetscCall(SamHistoryGetIncrements(history, &increments));
  steps = (PetscReal)increments;
  PetscCall(SamParametersAddReals(p, "steps", PETSC_TRUE, 1, &steps));
  PetscCall(SamHistoryGetStep(history, count - 1, &control));
  PetscCall(SamHistoryHas(history, &friction, &bulk));
  for (PetscInt k = 0; k < (bulk ? SAM_CONTROL_PARTS : SAM_COMPONENTS); k++) {
    const PetscReal value = SamControlPart(&control, k);

    PetscCall(SamParametersAddReals(p, SamControlPartName(&control, k), PETSC_FALSE, 1, &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The law of wear. A life can go on with more cycles, and in other jumps. */
static PetscErrorCode AddWear(SamParameters *p, const SamWearing *w)
{
  const char *const name     = w->law == SAM_WEAR_ENERGY ? "wear_energy" : "wear_coefficient";
  const char *const kinds[2] = {"steps", "cycles"};
  uint64_t          sum      = 0;

  PetscFunctionBegin;
  PetscCall(SamParametersAddText(p, "wear", PETSC_TRUE, w->on ? kinds[w->cycles > 0] : "none"));
  for (int body = 0; body < 2 && w->on; body++) {
    char option[32];

    PetscCall(PetscSNPrintf(option, sizeof(option), "%s%d", name, body + 1));
    PetscCall(SamParametersAddReals(p, option, PETSC_TRUE, 1, &w->coefficient[body]));
  }
  if (w->cycles > 0) {
    PetscCall(SamParametersAddReals(p, "wear_cycles", PETSC_FALSE, 1, &w->cycles));
    PetscCall(
      SamParametersAddText(p, "wear_type", PETSC_FALSE, w->life.type == SAM_LIFE_EXPLICIT ? "explicit" : "implicit"));
    PetscCall(SamParametersAddReals(p, w->life.fixed ? "wear_jump" : "wear_rtol", PETSC_FALSE, 1,
                                    w->life.fixed ? &w->life.jump : &w->life.rtol));
  }
  if (!w->points) {
    PetscCall(SamParametersAddText(p, "wear_friction", PETSC_TRUE, "none"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < w->points; k++)
    sum = SamHashMix(sum + SamHashBits(w->at[k]) + 3 * SamHashBits(w->friction[k]));
  PetscCall(AddChecksum(p, "wear_friction", sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRunCollectParameters(SamRun *run)
{
  SamParameters *const p = &run->parameters;
  SamElasticityType    type;
  PetscBool            full;

  PetscFunctionBegin;
  p->count = 0;
  PetscCall(AddGrid(p, run->grid));
  PetscCall(AddPair(p, &run->pair));
  PetscCall(SamElasticityGetType(run->elasticity, &type));
  PetscCall(SamParametersAddText(p, "elasticity", PETSC_TRUE, type));
  PetscCall(AddFriction(run));
  PetscCall(AddGap(run));
  PetscCall(SamContactGetCoupling(run->contact, &full));
  PetscCall(SamParametersAddText(p, "coupling", PETSC_TRUE, full ? "full" : "none"));
  PetscCall(AddLoads(p, run->history));
  PetscCall(AddWear(p, &run->wearing));
  PetscFunctionReturn(PETSC_SUCCESS);
}
