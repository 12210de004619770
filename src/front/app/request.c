/* The options of petsam-stress that do not belong to an evaluation. */
#include "request.h"
#include <petsam/private/baseimpl.h>
#include <stdlib.h>
#include <string.h>

#define LISTED 12 /* number of steps or cycles listed in a message */

/* ---- options ---- */

/* Reads a text of one to three integers separated by colons; returns their number, 0 for any other text. */
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

static PetscErrorCode TakeSteps(const SamOptions *from, SamStressRequest *r)
{
  const char *text = r->steps;
  PetscInt    n[3] = {0, 0, 1};
  int         count;

  PetscFunctionBegin;
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

#define MEMBER(name) offsetof(SamStressRequest, name)
static const SamOptionRow files[] = {{"input", "results of petsam", SAM_OPTION_FILE, MEMBER(input),
                                      .size = PETSC_MAX_PATH_LEN, .missing = "the results of petsam"},
                                     {"output", "the new file", SAM_OPTION_OUTPUT, MEMBER(output),
                                      .size = PETSC_MAX_PATH_LEN, .missing = "the file to be written"}},
                          times[] = {
                            {"steps", "load steps: last, all, a number, or first:last[:stride]", SAM_OPTION_STRING,
                             MEMBER(steps), .size = sizeof(((SamStressRequest *)NULL)->steps)},
                            {"cycle", "a saved cycle of a wear simulation by its number, not -steps", SAM_OPTION_REAL,
                             MEMBER(cycle), .range = SAM_RANGE_NONNEGATIVE, .excludes = "steps"}};

PetscErrorCode SamStressRequestRead(const SamOptions *from, SamStressRequest *r)
{
  PetscBool given[2];

  PetscFunctionBegin;
  *r = (SamStressRequest){.steps = "last"};
  PetscCall(SamOptionsRead(from, "Files", SAM_OPTION_ROWS(files), r, NULL));
  PetscCall(SamOptionsRead(from, "Where and when", SAM_OPTION_ROWS(times), r, given));
  r->of_cycle = given[1];
  PetscCall(TakeSteps(from, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps of the results ---- */

/* Finds the number of the saved step for a load step, or -1. */
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

/*
  Lists the saved steps, or with `cycles` the cycles of saved steps, without repetitions, as text: 1, 2, 3 and so on.
*/
static PetscErrorCode ListSaved(SamResults results, PetscBool cycles, char text[], size_t size)
{
  double   last = -1;
  PetscInt count, shown = 0;

  PetscFunctionBegin;
  text[0] = '\0';
  PetscCall(SamResultsGetSteps(results, NULL, &count));
  for (PetscInt k = 0; k < count; k++) {
    const size_t used = strlen(text);
    PetscInt     step;
    double       number;

    PetscCall(SamResultsGetSaved(results, k, &step, NULL));
    number = (double)step;
    if (cycles) PetscCall(SamResultsReadNumber(results, step, SAM_RESULTS_CYCLE, &number));
    if (number == last) continue;
    if (shown < LISTED) (void)snprintf(text + used, size - used, "%s%.10g", shown ? ", " : "", number);
    if (shown == LISTED) (void)snprintf(text + used, size - used, " and more");
    shown++;
    last = number;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the saved steps of a cycle of a life. */
static PetscErrorCode FindCycle(const SamStressRequest *r, SamResults results, PetscInt *count, PetscInt **list)
{
  PetscInt      saved, step;
  char          text[256];
  const SamGrid grid = SamResultsGetGrid(results);

  PetscFunctionBegin;
  PetscCall(SamResultsGetSteps(results, NULL, &saved));
  PetscCall(PetscMalloc1(saved, list));
  *count = 0;
  for (PetscInt k = 0; k < saved; k++) {
    double cycle;

    PetscCall(SamResultsGetSaved(results, k, &step, NULL));
    PetscCall(SamResultsReadNumber(results, step, SAM_RESULTS_CYCLE, &cycle));
    if (cycle == (double)r->cycle) (*list)[(*count)++] = k;
  }
  if (!*count) PetscCall(ListSaved(results, PETSC_TRUE, text, sizeof(text)));
  PetscCheck(*count, grid->comm, SAM_ERR_USER, "-cycle %.10g: the steps of that cycle are not in %s, those of %s are",
             (double)r->cycle, r->input, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRequestSteps(const SamStressRequest *r, SamResults results, PetscInt *count, PetscInt **list)
{
  PetscInt      steps, saved;
  char          text[256];
  const SamGrid grid = SamResultsGetGrid(results);

  PetscFunctionBegin;
  if (r->of_cycle) {
    PetscCall(FindCycle(r, results, count, list));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
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
    if ((*list)[k] < 0) PetscCall(ListSaved(results, PETSC_FALSE, text, sizeof(text)));
    PetscCheck((*list)[k] >= 0, grid->comm, SAM_ERR_USER,
               "-steps: step %" PetscInt_FMT " of %s has not been saved (-output_every of its run), steps %s have",
               step, r->input, text);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
