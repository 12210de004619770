/* The options of petsam-stress that are not those of an evaluation. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>
#include <stdlib.h>
#include <string.h>

/* ---- options ---- */

/* One to three whole numbers with colons between them, which make up the whole text; returns how many, 0 for others. */
static int ReadNumbers(const char text[], PetscInt n[3])
{
  for (int count = 0; count < 3; count++) {
    char      *end;
    const long number = strtol(text, &end, 10);

    n[count] = (PetscInt)number;
    if (end == text || number != (long)n[count]) break;
    if (!*end) return count + 1;
    if (*end != ':') break;
    text = end + 1;
  }
  return 0;
}

static PetscErrorCode ReadSteps(const SamOptions *from, SamStressRequest *r)
{
  char     text[128] = "last";
  PetscInt n[3]      = {0, 0, 1};
  int      count;

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "steps", "load steps: last, all, a number, or first:last[:stride]", text,
                             sizeof(text), NULL));
  r->all_steps = !strcmp(text, "all");
  r->last_step = !strcmp(text, "last");
  if (r->all_steps || r->last_step) PetscFunctionReturn(PETSC_SUCCESS);
  count = ReadNumbers(text, n);
  PetscCheck(count, from->comm, SAM_ERR_USER, "-steps %s: expected last, all, a number, or first:last[:stride]", text);
  r->first  = n[0];
  r->last   = count < 2 ? n[0] : n[1];
  r->stride = n[2];
  PetscCheck(r->first >= 1 && r->last >= r->first && r->stride >= 1, from->comm, SAM_ERR_USER,
             "-steps %s: expected 1 <= first <= last and a stride of at least 1", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRequestRead(const SamOptions *from, SamStressRequest *r)
{
  PetscBool set, print;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(r, sizeof(*r)));
  PetscCall(SamPrintHelp(&print));
  PetscCall(SamOptionsHeading(from, "Files"));
  PetscCall(SamOptionsFile(from, "input", "results of petsam", r->input, sizeof(r->input), &set));
  PetscCall(SamOptionsRequire(from, set || print, "input", "the results of petsam"));
  PetscCall(SamOptionsFile(from, "output", "the new file", r->output, sizeof(r->output), &set));
  PetscCall(SamOptionsRequire(from, set || print, "output", "the file to be written"));
  PetscCall(SamOptionsHeading(from, "Where and when"));
  PetscCall(ReadSteps(from, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps of the results ---- */

/* The number of the saved step that is a load step, or -1. */
static PetscErrorCode FindSaved(SamResults results, PetscInt step, PetscInt *saved)
{
  PetscInt count, there;

  PetscFunctionBegin;
  *saved = -1;
  PetscCall(SamResultsGetSteps(results, NULL, &count));
  for (PetscInt k = 0; k < count && *saved < 0; k++) {
    PetscCall(SamResultsGetSaved(results, k, &there, NULL));
    if (there == step) *saved = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRequestSteps(const SamStressRequest *r, SamResults results, PetscInt *count, PetscInt **list)
{
  PetscInt steps, saved;
  SamGrid  grid;

  PetscFunctionBegin;
  PetscCall(SamResultsGetGrid(results, &grid));
  PetscCall(SamResultsGetSteps(results, &steps, &saved));
  *count = r->all_steps ? saved : r->last_step ? 1 : (r->last - r->first) / r->stride + 1;
  PetscCheck(r->all_steps || r->last_step || r->last <= steps, grid->comm, SAM_ERR_USER,
             "-steps: there is no step %" PetscInt_FMT " in %s, the last is %" PetscInt_FMT, r->last, r->input, steps);
  PetscCall(PetscMalloc1(*count, list));
  for (PetscInt k = 0; k < *count; k++) {
    const PetscInt step = r->first + k * r->stride;

    (*list)[k] = r->all_steps ? k : saved - 1;
    if (r->all_steps || r->last_step) continue;
    PetscCall(FindSaved(results, step, &(*list)[k]));
    PetscCheck((*list)[k] >= 0, grid->comm, SAM_ERR_USER,
               "-steps: step %" PetscInt_FMT " of %s has not been saved (-output_every of its run)", step, r->input);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
