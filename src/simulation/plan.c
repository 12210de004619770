/* The -wear_ options: laws of wear, cycles of a life, friction that changes over it. */
#include "plan.h"
#include <petsam/private/baseimpl.h>
#include <petsam/history.h>
#include <petsam/private/table.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Loads and displacements of the first and last row of a cycle may differ by so much of their range. */
#define ROUNDING 1e-9
/* The most cycles of a life. */
#define MOST_CYCLES 1e12

/* ---- cycles ---- */

static int Compare(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return (x > y) - (x < y);
}

/* Refuses numbers of cycles that are not whole, or so large that times could not tell one cycle from the next. */
static PetscErrorCode CheckWhole(const char option[], PetscReal cycles, PetscBool set, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCheck(!set || (cycles == floor(cycles) && cycles <= MOST_CYCLES), from->comm, SAM_ERR_USER,
             "-%s %.6g: expected an integer, at most %.6g", option, (double)cycles, MOST_CYCLES);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadOutputs(SamPlan *w, const SamOptions *from)
{
  char  text[4096] = "", *part, *rest;
  char *end;

  PetscFunctionBegin;
  PetscCall(SamOptionsString(from, "wear_output", "cycles whose fields are written, c[,c,...]; the last always", text,
                             sizeof(text), NULL));
  for (part = strtok_r(text, ",", &rest); part; part = strtok_r(NULL, ",", &rest)) {
    const double cycle = strtod(part, &end);

    PetscCheck(end != part && !*end && isfinite(cycle) && cycle >= 0 && cycle == floor(cycle), from->comm, SAM_ERR_USER,
               "-wear_output: \"%s\" is not a number of cycles: expected integers >= 0, separated by commas", part);
    PetscCheck(w->outputs < SAM_PLAN_OUTPUTS, from->comm, SAM_ERR_USER, "-wear_output: more than %d cycles",
               SAM_PLAN_OUTPUTS);
    w->output[w->outputs++] = cycle;
  }
  qsort(w->output, (size_t)w->outputs, sizeof(w->output[0]), Compare);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadLife(SamPlan *w, const SamOptions *from)
{
  static const char *const types[] = {"implicit", "explicit", NULL};

  PetscInt type = SAM_LIFE_IMPLICIT;

  PetscFunctionBegin;
  PetscCall(SamOptionsEnum(from, "wear_type", "how cycles are jumped: implicit, or explicit", types, &type, NULL));
  w->life = (SamLifeSettings){.type = (SamLifeType)type, .rtol = 1e-2};
  PetscCall(SamOptionsReal(from, "wear_rtol", "relative error of depth and pressure per cycle jump; at most twice this",
                           SAM_RANGE_POSITIVE, &w->life.rtol, NULL));
  PetscCall(SamOptionsReal(from, "wear_jump", "fixed jump length in cycles", SAM_RANGE_POSITIVE, &w->life.jump,
                           &w->life.fixed));
  PetscCall(CheckWhole("wear_jump", w->life.jump, w->life.fixed, from));
  PetscCall(SamOptionsBool(from, "wear_stop_layer", "end where the first layer of a body is worn through",
                           &w->stop_worn, NULL));
  PetscCall(ReadOutputs(w, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options that have no meaning without others. */
static PetscErrorCode CheckPresent(const SamPlan *w, const SamOptions *from)
{
  static const char *const life[] = {"wear_type",   "wear_rtol",     "wear_jump",
                                     "wear_output", "wear_friction", "wear_stop_layer"};

  PetscBool set;

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(life) / sizeof(life[0]) && w->cycles == 0; k++) {
    char option[32];

    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", life[k]));
    PetscCall(PetscOptionsHasName(NULL, from->prefix, option, &set));
    PetscCheck(!set, from->comm, SAM_ERR_USER, "%s is given without -wear_cycles", option);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- friction ---- */

static PetscErrorCode CheckTable(const SamTable *t, const char file[], PetscInt cycle, PetscInt friction,
                                 const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCheck(t->columns == 2 && cycle >= 0 && friction >= 0, from->comm, SAM_ERR_USER,
             "-wear_friction %s, line %" PetscInt_FMT ": expected the columns cycle,friction", file, t->header_line);
  for (PetscInt r = 0; r < t->rows; r++) {
    const double *row = t->value + 2 * r;

    PetscCheck(row[friction] > 0, from->comm, SAM_ERR_USER,
               "-wear_friction %s, line %" PetscInt_FMT ": friction %.6g: expected a number > 0", file, t->line[r],
               row[friction]);
    PetscCheck(r ? row[cycle] > row[cycle - 2] : row[cycle] == 0, from->comm, SAM_ERR_USER,
               "-wear_friction %s, line %" PetscInt_FMT ": cycle %.6g: expected %s", file, t->line[r], row[cycle],
               r ? "more than in the row before" : "0 in the first row");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFriction(SamPlan *w, const SamOptions *from)
{
  static const char *const names[] = {"cycle", "friction", NULL};

  char      file[PETSC_MAX_PATH_LEN] = "";
  PetscBool set, other;
  SamTable  t;
  PetscInt  cycle, friction;

  PetscFunctionBegin;
  PetscCall(SamOptionsFile(from, "wear_friction", "text file, columns cycle,friction: friction over the cycles", file,
                           sizeof(file), &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscOptionsHasName(NULL, from->prefix, k ? "-friction_file" : "-friction", &other));
    PetscCheck(!other, from->comm, SAM_ERR_USER, "-wear_friction and -friction%s are given: give one of them",
               k ? "_file" : "");
  }
  PetscCall(SamTableRead(from->comm, "wear_friction", file, names, &t));
  cycle    = SamTableFind(&t, "cycle");
  friction = SamTableFind(&t, "friction");
  PetscCall(CheckTable(&t, file, cycle, friction, from));
  w->points = t.rows;
  PetscCall(PetscMalloc1(t.rows, &w->at));
  PetscCall(PetscMalloc1(t.rows, &w->friction));
  for (PetscInt r = 0; r < t.rows; r++) {
    w->at[r]       = t.value[2 * r + cycle];
    w->friction[r] = t.value[2 * r + friction];
  }
  PetscCall(SamTableDestroy(&t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamPlanFriction(const SamPlan *w, PetscReal cycles)
{
  PetscInt r = 0;

  if (!w->points) return 1;
  while (r + 1 < w->points && w->at[r + 1] <= cycles) r++;
  if (r + 1 == w->points) return w->friction[r] / w->friction[0];
  return (w->friction[r] + (w->friction[r + 1] - w->friction[r]) * (cycles - w->at[r]) / (w->at[r + 1] - w->at[r])) /
         w->friction[0];
}

/* ---- all of it ---- */

PetscErrorCode SamPlanSetFromOptions(SamPlan *w, PetscBool given, const SamOptions *from)
{
  PetscFunctionBegin;
  *w = (SamPlan){.cycles = 0};
  PetscCall(SamOptionsHeading(from, "Wear over cycles"));
  if (!given)
    PetscCall(SamOptionsReal(from, "wear_cycles", "cycles to simulate; the history is one closed cycle",
                             SAM_RANGE_POSITIVE, &w->cycles, NULL));
  if (!given) PetscCall(CheckPresent(w, from));
  PetscCall(ReadLife(w, from));
  PetscCall(ReadFriction(w, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlanSetCycles(SamPlan *w, PetscReal cycles, SamProblem problem, const SamOptions *from)
{
  PetscBool moves;

  PetscFunctionBegin;
  PetscCall(CheckWhole("wear_cycles", cycles, PETSC_TRUE, from));
  PetscCall(SamProblemMoves(problem, &moves));
  PetscCheck(moves || cycles == 0, from->comm, SAM_ERR_USER,
             "-wear_cycles is given, but no wear: give one of -wear_coefficient1, -wear_coefficient2, -wear_energy1, "
             "-wear_energy2 a number > 0");
  PetscCheck(!w->outputs || cycles == 0 || w->output[w->outputs - 1] <= cycles, from->comm, SAM_ERR_USER,
             "-wear_output: %.6g is more than -wear_cycles %.6g", (double)w->output[w->outputs - 1], (double)cycles);
  w->cycles = cycles;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlanDestroy(SamPlan *w)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(w->at));
  PetscCall(PetscFree(w->friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlanCheckCycle(const SamPlan *w, SamHistory history, const SamOptions *from)
{
  PetscReal  range[SAM_CONTROL_PARTS] = {0}; /* of each part, about its value in the first row */
  SamControl first, last;
  PetscInt   count, increments, start;

  PetscFunctionBegin;
  if (w->cycles == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamHistoryGetCount(history, &count));
  PetscCall(SamHistoryGetIncrements(history, &increments));
  PetscCall(SamHistoryGetStart(history, &start));
  PetscCheck(count > start + increments, from->comm, SAM_ERR_USER,
             "-wear_cycles: a cycle needs a -history of three rows or more: the start and the path back to it");
  PetscCall(SamHistoryGetStep(history, start - 1, &first));
  for (PetscInt k = start; k < count; k++) {
    PetscCall(SamHistoryGetStep(history, k, &last));
    for (PetscInt c = 0; c < SAM_CONTROL_PARTS; c++)
      range[c] = PetscMax(range[c], fabs(SamControlPart(&last, c) - SamControlPart(&first, c)));
  }
  for (PetscInt c = 0; c < SAM_CONTROL_PARTS; c++)
    PetscCheck(fabs(SamControlPart(&last, c) - SamControlPart(&first, c)) <= ROUNDING * range[c], from->comm,
               SAM_ERR_USER,
               "-wear_cycles: -history is not a closed cycle: %s is %.6g in the last row and %.6g in the first",
               SamControlPartName(&first, c), (double)SamControlPart(&last, c), (double)SamControlPart(&first, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamPlanNextStop(const SamPlan *w, PetscReal cycles)
{
  PetscReal stop = w->cycles;

  for (PetscInt k = 0; k < w->outputs; k++)
    if (w->output[k] > cycles) stop = PetscMin(stop, w->output[k]);
  for (PetscInt k = 0; k < w->points; k++)
    if (w->at[k] > cycles) stop = PetscMin(stop, w->at[k]);
  return stop;
}

PetscBool SamPlanIsOutput(const SamPlan *w, PetscReal cycles)
{
  for (PetscInt k = 0; k < w->outputs; k++)
    if (w->output[k] == cycles) return PETSC_TRUE;
  return cycles == w->cycles;
}

PetscInt SamPlanCountOutputs(const SamPlan *w)
{
  PetscInt count = w->outputs && w->output[w->outputs - 1] == w->cycles ? 0 : 1;

  for (PetscInt k = 0; k < w->outputs; k++) count += k == 0 || w->output[k] != w->output[k - 1];
  return count;
}
