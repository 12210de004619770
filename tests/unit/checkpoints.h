/* Checkpoints for the tests of src/run/io: a contact of dissimilar bodies, its parameters, and its files. */
#ifndef PETSAM_CHECKPOINTS_H
#define PETSAM_CHECKPOINTS_H

#include "contacts.h"

#include <unistd.h>

#include <petsam/private/checkpoint.h>

static const char filename[] = "test_checkpoint.h5";

/* Writes one checkpoint, as a run would. */
static inline void Write(const Case *c, const SamParameters *parameters, PetscInt n, const SamNote notes[])
{
  SamCheckpoint files;

  sam_call(SamCheckpointCreate(c->s.grid, filename, &files));
  sam_call(SamCheckpointWrite(files, c->contact, &(SamCheckpointRest){parameters, n, notes, 0, NULL}));
  sam_call(SamCheckpointDestroy(&files));
}

static inline void Remove(void)
{
  static const char *const names[] = {"test_checkpoint.h5", "test_checkpoint.h5.1"};

  for (int k = 0; k < 2; k++) RemoveFile(names[k]);
}

static const PetscReal friction = 0.3;

/* Dissimilar bodies, on a grid that does not divide. */
static inline Case NewBody(void)
{
  return NewCase(Dissimilar(), 37, 2, friction, "");
}

static inline void SolveStep(const Case *c, int k, SamStep *step)
{
  const SamControl control = Loads(c, 0.25 * (k + 1), 0.1 * (k + 1), 0.02 * (k + 1), 0);

  *step = Solve(c, &control);
  sam_assert(step->check.normal < 2e-6 && step->check.tangential < 1e-5); /* -coupling_rtol 1e-6 */
}

static inline SamParameters NewParameters(PetscReal value)
{
  SamParameters p = {.count = 0};

  sam_call(SamParametersAddReals(&p, "friction", PETSC_TRUE, 1, &value));
  sam_call(SamParametersAddText(&p, "gap_type", PETSC_TRUE, "sphere"));
  sam_call(SamParametersAddReals(&p, "load_n", PETSC_FALSE, 1, &value));
  return p;
}

#endif
