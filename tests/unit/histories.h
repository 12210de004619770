/* Load histories: writing files, reading them, and what is refused. */
#ifndef PETSAM_HISTORIES_H
#define PETSAM_HISTORIES_H

#include "fields.h"

#include <petsam/private/history.h>
#include <petsam/private/control.h>
#include <unistd.h>

static const char file[] = "test_history.csv";

/* Rank 0 writes the file, as only rank 0 reads it. */
static inline void WriteBytes(const char *text, size_t size)
{
  int good = 1;

  (void)MPI_Barrier(PETSC_COMM_WORLD);
  if (Rank() == 0) {
    FILE *stream = fopen(file, "wb");

    good = stream && fwrite(text, 1, size, stream) == size;
    good = stream && !fclose(stream) && good;
  }
  sam_assert(good);
}

static inline void Write(const char *text)
{
  WriteBytes(text, strlen(text));
}

static inline PetscReal ConditionOf(const SamControl *control, const char name[])
{
  return SamControlGet(control, SamConditionsFind(Conditions(), name));
}

static inline void SetHistoryOptions(const char *options)
{
  SetOptions(""); /* forgets the alias, too */
  sam_call(SamHistoryClaimOption());
  sam_call(PetscOptionsInsertString(NULL, options));
}

/* The history that these options give; without options about it, that of the file. */
static inline SamHistory Read(const char *options)
{
  SamHistory h;

  SetHistoryOptions(options);
  sam_call(SamHistoryCreateFromOptions(&(SamOptions){PETSC_COMM_WORLD, NULL}, NULL, Conditions(), &h));
  SetHistoryOptions("");
  return h;
}

static inline PetscInt CountOf(SamHistory h)
{
  PetscInt steps;

  steps = SamHistoryGetCount(h);
  return steps;
}

static inline SamControl StepOf(SamHistory h, PetscInt k)
{
  SamControl step;

  memset(&step, 0x55, sizeof(step)); /* every member must be set */
  step = SamHistoryGetStep(h, k);
  return step;
}

/* The twelve names, without their dash. */
static inline const char *NameOf(PetscInt component, PetscBool rigid)
{
  return rigid ? SamComponentNames[component].rigid : SamComponentNames[component].load;
}

/* Asserts that the options are refused with this code on all ranks, in a one-line message that has both texts. */
static inline void AssertRefused(const char *options, PetscErrorCode code, const char *one, const char *other)
{
  SamHistory     h = NULL;
  PetscErrorCode ierr;
  int            good;

  SetHistoryOptions(options);
  BeginCatching();
  ierr = SamHistoryCreateFromOptions(&(SamOptions){PETSC_COMM_WORLD, NULL}, NULL, Conditions(), &h);
  EndCatching();
  SetHistoryOptions("");
  if (h) sam_call(SamHistoryDestroy(&h));
  good =
    ierr == code && strstr(CaughtMessage(), one) && strstr(CaughtMessage(), other) && !strchr(CaughtMessage(), '\n');
  if (!good)
    print_error("%s: error %d, expected %d with '%s' and '%s': '%s'\n", options, (int)ierr, (int)code, one, other,
                CaughtMessage());
  sam_assert(good);
}

/* Asserts that a file is refused because of that line, in a message that has `says`. */
static inline void AssertMalformed(const char *text, int line, const char *says)
{
  char where[64];

  (void)snprintf(where, sizeof(where), "%s, line %d:", file, line);
  Write(text);
  AssertRefused("-history test_history.csv -load_n 1", SAM_ERR_USER, where, says);
}

/* The same three steps, however they are written. */
static inline void AssertPlain(const char *text)
{
  static const double expected[3][3] = {{1, 100, 0}, {2.5, 100, 25}, {4, 120, -30.5}}; /* time, N, Tx */
  SamHistory          h;
  int                 good = 1;

  Write(text);
  h = Read("-history test_history.csv");
  sam_assert(CountOf(h) == 3);
  for (PetscInt k = 0; k < 3; k++) {
    const SamControl step = StepOf(h, k);

    good = good && step.time == expected[k][0] && step.value[SAM_COMPONENT_N] == expected[k][1] &&
           step.value[SAM_COMPONENT_TX] == expected[k][2];
  }
  if (!good) print_error("read wrongly: %s\n", text);
  sam_assert(good);
  sam_call(SamHistoryDestroy(&h));
}

#endif
