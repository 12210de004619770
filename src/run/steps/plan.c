/* The -wear_ options: laws of wear, cycles of a life, and friction that changes during it. */
#include "plan.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/history.h>
#include <petsam/private/table.h>
#include <petsam/private/problem.h>
#include <petsam/private/problemimpl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest difference of loads and displacements in the first and last row of a cycle, relative to their range */
#define ROUNDING 1e-9
/* Maximum number of cycles of a life, and of fixed jumps in it */
#define MOST_CYCLES 1e12
#define MOST_JUMPS  1e9

/* Default tolerance of jumps if surfaces slide */
#define SLIDING_RTOL 0.1

/* ---- cycles ---- */

static int Compare(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return (x > y) - (x < y);
}

/* Rejects numbers of cycles that are not integers, or so large that times could not distinguish cycles. */
static PetscErrorCode CheckWhole(const char option[], PetscReal cycles, PetscBool set, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCheck(!set || (cycles == floor(cycles) && cycles <= MOST_CYCLES), from->comm, SAM_ERR_USER,
             "-%s %.6g: expected an integer, at most %.6g", option, (double)cycles, MOST_CYCLES);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The settings of a user */
typedef struct {
  PetscReal       cycles;
  SamLifeSettings life;
  PetscBool       stop_layer;
  char            outputs[4096], friction[PETSC_MAX_PATH_LEN];
} Settings;

/* Largest relative error of a jump: at it, the pressure of a worn sphere is 10 % too small at its end; the largest
   tolerances let the first jump be as long as the life */
#define LOOSEST 0.3

/* The options; those from RTOL on need a life */
enum { CYCLES, RTOL, JUMP, STOP_LAYER, OUTPUT, FRICTION, ROWS };
#define MEMBER(name) offsetof(Settings, name)
#define LIFE         .needs = "wear_cycles"
static const SamOptionRow rows[ROWS] = {
  {"wear_cycles", "cycles of a closed history; with -rolling steady passages", SAM_OPTION_REAL, MEMBER(cycles),
   .range = SAM_RANGE_POSITIVE},
  {"wear_rtol", "relative error of depth and pressure per cycle jump; at most twice this", SAM_OPTION_REAL,
   MEMBER(life.rtol), .range = SAM_RANGE_PART, LIFE, .loosest = LOOSEST,
   .beyond = "pressures are wrong by tens of per cents"},
  {"wear_jump", "fixed jump length in cycles, not only integers", SAM_OPTION_REAL, MEMBER(life.jump),
   .range = SAM_RANGE_POSITIVE, LIFE},
  {"wear_stop_layer", "end where the first layer of a body is worn through", SAM_OPTION_BOOL, MEMBER(stop_layer), LIFE},
  {"wear_output", "cycles whose fields are written, c[,c,...]; the last always", SAM_OPTION_STRING, MEMBER(outputs),
   .size = sizeof(((Settings *)NULL)->outputs), LIFE},
  {"wear_friction", "text file, columns cycle,friction: friction over the cycles", SAM_OPTION_FILE, MEMBER(friction),
   .size = PETSC_MAX_PATH_LEN, .excludes = "friction,friction_file", LIFE}};

static PetscErrorCode TakeOutputs(SamLifeOptions *w, char text[], const SamOptions *from)
{
  char *part, *rest, *end;

  PetscFunctionBegin;
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

static PetscErrorCode TakeFriction(SamLifeOptions *w, const char file[], const SamOptions *from)
{
  static const char *const names[] = {"cycle", "friction", NULL};

  SamTable t;
  PetscInt cycle, friction;

  PetscFunctionBegin;
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

PetscReal SamLifeOptionsFriction(const SamLifeOptions *w, PetscReal cycles)
{
  PetscInt r = 0;

  if (!w->points) return 1;
  while (r + 1 < w->points && w->at[r + 1] <= cycles) r++;
  if (r + 1 == w->points) return w->friction[r] / w->friction[0];
  return (w->friction[r] + (w->friction[r + 1] - w->friction[r]) * (cycles - w->at[r]) / (w->at[r + 1] - w->at[r])) /
         w->friction[0];
}

/* ---- all options ---- */

PetscErrorCode SamLifeOptionsSetFromOptions(SamLifeOptions *w, PetscBool given, const SamOptions *from)
{
  Settings     set = {.life = {.rtol = 1e-2}};
  SamOptionRow asked[ROWS];
  PetscBool    has[ROWS];

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(asked, rows, ROWS));
  for (PetscInt k = RTOL; k < ROWS && given; k++) asked[k].needs = NULL;
  PetscCall(SamOptionsHeading(from, "Wear over cycles"));
  PetscCall(SamOptionsRead(from, NULL, ROWS - given, asked + given, &set, has + given));
  *w            = (SamLifeOptions){.cycles = set.cycles, .life = set.life, .stop_worn = set.stop_layer};
  w->life.fixed = has[JUMP];
  w->has_rtol   = has[RTOL];
  PetscCall(TakeOutputs(w, set.outputs, from));
  if (has[FRICTION]) PetscCall(TakeFriction(w, set.friction, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets magnified cycles for sliding surfaces; their errors of depth are far smaller than those of pressure. */
static void Magnify(SamLifeOptions *w)
{
  w->life.magnified = PETSC_TRUE;
  if (!w->has_rtol) w->life.rtol = SLIDING_RTOL;
}

PetscErrorCode SamLifeOptionsSetCycles(SamLifeOptions *w, PetscReal cycles, SamProblem problem, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(CheckWhole("wear_cycles", cycles, PETSC_TRUE, from));
  PetscCheck(SamProblemMoves(problem) || cycles == 0, from->comm, SAM_ERR_USER,
             "-wear_cycles is given, but no wear: give one of -wear_coefficient1, -wear_coefficient2, -wear_energy1, "
             "-wear_energy2 a number > 0");
  PetscCheck(!w->life.fixed || cycles == 0 || (w->life.jump <= MOST_CYCLES && w->life.jump * MOST_JUMPS >= cycles),
             from->comm, SAM_ERR_USER, "-wear_jump %.6g: expected a number from %.6g of -wear_cycles on, at most %.6g",
             (double)w->life.jump, 1 / MOST_JUMPS, MOST_CYCLES);
  w->bands = SamMotionOf(SamProblemGetElasticity(problem))->streams;
  PetscCheck(!w->outputs || cycles == 0 || w->output[w->outputs - 1] <= cycles, from->comm, SAM_ERR_USER,
             "-wear_output: %.6g is more than -wear_cycles %.6g", (double)w->output[w->outputs - 1], (double)cycles);
  w->cycles = cycles;
  if (cycles > 0 && SamProblemSlides(problem)) Magnify(w);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLifeOptionsDestroy(SamLifeOptions *w)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(w->at));
  PetscCall(PetscFree(w->friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamLifeOptionsGetStart(const SamLifeOptions *w, SamHistory history)
{
  return w->bands ? 0 : SamHistoryGetStart(history);
}

/* Returns the difference of a part from its value in the first row; for sliding periodic bodies, without whole
   periods. */
static PetscReal Apart(SamProblem problem, const SamControl *last, const SamControl *first, PetscInt c)
{
  const SamElasticity bodies = SamProblemGetElasticity(problem);
  const SamGrid       grid   = SamElasticityGetGrid(bodies);
  const PetscReal     apart  = SamControlPart(last, SamProblemGetConditions(problem), c) -
                          SamControlPart(first, SamProblemGetConditions(problem), c);

  if ((c != SAM_COMPONENT_TX && c != SAM_COMPONENT_TY) || !SamElasticityGetTraits(bodies).periodic ||
      !SamProblemSlides(problem) || SamControlWay(first, c) != SAM_BY_RIGID)
    return fabs(apart);
  return fabs(remainder(apart, grid->width[c == SAM_COMPONENT_TY]));
}

PetscErrorCode SamLifeOptionsCheckCycle(const SamLifeOptions *w, SamHistory history, SamProblem problem,
                                        const SamOptions *from)
{
  const SamConditions conditions                        = SamProblemGetConditions(problem);
  PetscReal      range[SAM_COMPONENTS + SAM_CONDITIONS] = {0}; /* range of each part about its value in the first row */
  SamControl     last;
  const PetscInt count   = SamHistoryGetCount(history);
  const PetscInt start   = SamHistoryGetStart(history);
  const SamControl first = SamHistoryGetStep(history, start - 1);

  PetscFunctionBegin;
  if (w->cycles == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!w->bands || SamHistoryGetIncrements(history) == 1, from->comm, SAM_ERR_USER,
             "-steps with -wear_cycles and -rolling steady: each row of -history is a passage: omit it");
  if (w->bands) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(count > start + SamHistoryGetIncrements(history), from->comm, SAM_ERR_USER,
             "-wear_cycles: a cycle needs a -history of three rows or more: the start and the path back to it");
  for (PetscInt k = start; k < count; k++) {
    last = SamHistoryGetStep(history, k);
    for (PetscInt c = 0; c < SamControlCount(conditions); c++)
      range[c] = PetscMax(range[c], fabs(SamControlPart(&last, conditions, c) - SamControlPart(&first, conditions, c)));
  }
  for (PetscInt c = 0; c < SamControlCount(conditions); c++)
    PetscCheck(Apart(problem, &last, &first, c) <= ROUNDING * range[c], from->comm, SAM_ERR_USER,
               "-wear_cycles: -history is not a closed cycle: %s is %.6g in the last row and %.6g in the first",
               SamControlPartName(&first, conditions, c), (double)SamControlPart(&last, conditions, c),
               (double)SamControlPart(&first, conditions, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamLifeOptionsNextStop(const SamLifeOptions *w, PetscReal cycles)
{
  PetscReal stop = w->cycles;

  for (PetscInt k = 0; k < w->outputs; k++)
    if (w->output[k] > cycles) stop = PetscMin(stop, w->output[k]);
  for (PetscInt k = 0; k < w->points; k++)
    if (w->at[k] > cycles) stop = PetscMin(stop, w->at[k]);
  return stop;
}

PetscBool SamLifeOptionsIsOutput(const SamLifeOptions *w, PetscReal cycles)
{
  for (PetscInt k = 0; k < w->outputs; k++)
    if (w->output[k] == cycles) return PETSC_TRUE;
  return cycles == w->cycles;
}

PetscInt SamLifeOptionsCountOutputs(const SamLifeOptions *w)
{
  PetscInt count = w->outputs && w->output[w->outputs - 1] == w->cycles ? 0 : 1;

  for (PetscInt k = 0; k < w->outputs; k++) count += k == 0 || w->output[k] != w->output[k - 1];
  return count;
}
