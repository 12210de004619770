/* The help: the options list themselves while the program's set-up reads them; then what was asked for is printed. */
#include "helpimpl.h"
#include <petsam/private/baseimpl.h>
#include <ctype.h>
#include <string.h>
#include <strings.h>

#define WIDTH 120
#define MOST  64 /* topics */

/* ---- the list ---- */

/* Makes room for one more. */
static PetscErrorCode Grow(void *array, size_t item, PetscInt count, PetscInt *room)
{
  PetscFunctionBegin;
  if (count < *room) PetscFunctionReturn(PETSC_SUCCESS);
  *room = 2 * *room + 16;
  PetscCall(PetscRealloc((size_t)*room * item, array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keeps the title of a group, or an option of the last group. */
static PetscErrorCode Keep(void *context, MPI_Comm comm, const char title[], const SamOptionHelp *o)
{
  SamHelpList *list = (SamHelpList *)context;

  PetscFunctionBegin;
  (void)comm;
  if (title) {
    PetscCall(Grow(&list->group, sizeof(*list->group), list->groups, &list->room_groups));
    PetscCall(PetscStrallocpy(title, &list->group[list->groups++]));
  }
  if (o) {
    const char *const texts[SAM_HELP_TEXTS] = {o->name, o->argument, o->text, o->value, o->words};
    SamListedOption  *kept;

    PetscCall(Grow(&list->option, sizeof(*list->option), list->options, &list->room_options));
    kept        = &list->option[list->options++];
    kept->group = list->groups - 1;
    for (int k = 0; k < SAM_HELP_TEXTS; k++) PetscCall(PetscStrallocpy(texts[k], &kept->text[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Free(SamHelpList *list)
{
  PetscFunctionBegin;
  for (PetscInt g = 0; g < list->groups; g++) PetscCall(PetscFree(list->group[g]));
  for (PetscInt o = 0; o < list->options; o++)
    for (int k = 0; k < SAM_HELP_TEXTS; k++) PetscCall(PetscFree(list->option[o].text[k]));
  PetscCall(PetscFree(list->group));
  PetscCall(PetscFree(list->option));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What every program has: of this frame, and the most useful of PETSc's. */
static PetscErrorCode DescribeFrame(void)
{
  static const SamOptionHelp all[] = {
    {"help", "[<topic>]", "this list, or more about a topic, or an option named without its dash", "", ""},
    {"version", "", "the version", "", ""},
    {"options_file", "<file>", "file with an option and its value on each line; # begins a comment", "", ""},
    {"log_view", "[<viewer>]", "PETSc's account of the time", "", ""}};
  const SamOptions from = {PETSC_COMM_WORLD, NULL};

  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(&from, "Of every program and of PETSc"));
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) PetscCall(SamOptionsDescribe(&from, &all[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- printing ---- */

static PetscErrorCode PrintOption(const SamListedOption *o)
{
  const SamOptionHelp option = {o->text[0], o->text[1], o->text[2], o->text[3], o->text[4]};

  PetscFunctionBegin;
  PetscCall(SamHelpPrint(NULL, PETSC_COMM_WORLD, NULL, &option));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintGroup(const SamHelpList *list, PetscInt g)
{
  PetscFunctionBegin;
  PetscCall(SamHelpPrint(NULL, PETSC_COMM_WORLD, list->group[g], NULL));
  for (PetscInt o = 0; o < list->options; o++)
    if (list->option[o].group == g) PetscCall(PrintOption(&list->option[o]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The names of the topics with commas between them, in lines that are not too long; `first` columns are taken. */
static void ListTopics(const SamProgram *program, size_t first, char text[], size_t size)
{
  size_t column = first, used = 0;

  text[0] = '\0';
  for (PetscInt t = 0; program->topics[t].name; t++) {
    const char  *name = program->topics[t].name, *end = program->topics[t + 1].name ? "," : "";
    const size_t wide = strlen(name) + 2;
    const char  *gap  = !t ? "" : column + wide > WIDTH ? "\n" : " ";

    column = *gap == '\n' ? wide : column + wide;
    used += (size_t)snprintf(text + used, size - used, "%s%s%s", gap, name, end);
    if (used >= size) return;
  }
}

static PetscErrorCode PrintAll(const SamProgram *program, const SamHelpList *list)
{
  static const char before[] = "More about one of these by -help and its name: ";
  char              topics[1024];

  PetscFunctionBegin;
  ListTopics(program, strlen(before), topics, sizeof(topics));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s%s.\n", program->usage, before, topics));
  for (PetscInt g = 0; g < list->groups; g++) PetscCall(PrintGroup(list, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintTopic(const SamTopic *topic, const SamHelpList *list)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s", topic->text));
  for (PetscInt g = 0; g < list->groups; g++)
    for (int k = 0; k < SAM_TOPIC_GROUPS && topic->group[k]; k++)
      if (!strcmp(topic->group[k], list->group[g])) PetscCall(PrintGroup(list, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what was asked for ---- */

const SamTopic *SamHelpFindTopic(const SamProgram *program, const char group[])
{
  for (const SamTopic *t = program->topics; t->name; t++)
    for (int k = 0; k < SAM_TOPIC_GROUPS && t->group[k]; k++)
      if (!strcmp(t->group[k], group)) return t;
  return NULL;
}

/* Whether a name is this one, or begins with it if `part`; _ and - count as spaces. */
static PetscBool IsNamed(const char asked[], const char name[], PetscBool part)
{
  size_t k = 0;

  for (; asked[k]; k++) {
    const char a = strchr("_-", asked[k]) ? ' ' : (char)tolower((unsigned char)asked[k]);
    const char b = name[k] == '_' ? ' ' : (char)tolower((unsigned char)name[k]);

    if (a != b) return PETSC_FALSE;
  }
  return part || !name[k];
}

/* The topic of this name, or with `part` the only one that begins with it; NULL: none. */
static const SamTopic *FindAsked(const SamProgram *program, const char asked[], PetscBool part)
{
  const SamTopic *found = NULL;

  for (const SamTopic *t = program->topics; t->name; t++) {
    if (!IsNamed(asked, t->name, part)) continue;
    if (found) return NULL;
    found = t;
  }
  return found;
}

/*
  Prints the options whose names go on after `asked` with a further word, with one of just this name. Unless `part`,
  only if there is one of just this name.
*/
static PetscErrorCode PrintOptions(const SamHelpList *list, const char asked[], PetscBool part, PetscBool *found)
{
  PetscInt group = -1;
  char     more[80];

  PetscFunctionBegin;
  *found = part;
  for (PetscInt o = 0; o < list->options && !*found; o++)
    *found = IsNamed(asked, list->option[o].text[SAM_HELP_NAME], PETSC_FALSE);
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(more, sizeof(more), "%s_", asked);
  for (PetscInt o = 0; o < list->options; o++) {
    const SamListedOption *option = &list->option[o];
    const char            *name   = option->text[SAM_HELP_NAME];

    if (!IsNamed(asked, name, PETSC_FALSE) && !IsNamed(more, name, PETSC_TRUE)) continue;
    if (option->group != group)
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s\n", group < 0 ? "" : "\n", list->group[option->group]));
    PetscCall(PrintOption(option));
    group = option->group;
  }
  *found = group < 0 ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RefuseTopic(const SamProgram *program, const char asked[])
{
  const char *names[MOST], *nearest;
  char        topics[1024];
  size_t      count = 0;

  PetscFunctionBegin;
  for (const SamTopic *t = program->topics; t->name && count < MOST; t++) names[count++] = t->name;
  nearest = SamNearestName(asked, count, names);
  ListTopics(program, 0, topics, sizeof(topics));
  for (char *c = topics; *c; c++) *c = *c == '\n' ? ' ' : *c;
  PetscCheck(!nearest, PETSC_COMM_WORLD, SAM_ERR_USER, "-help %s: no such topic: is %s meant? There are %s", asked,
             nearest, topics);
  SETERRQ(PETSC_COMM_WORLD, SAM_ERR_USER, "-help %s: no such topic: expected an option without its dash, or one of %s",
          asked, topics);
}

/* A topic, an option, the beginning of a topic, the beginning of options: the first of these that there is. */
static PetscErrorCode PrintAsked(const SamProgram *program, const SamHelpList *list, const char asked[])
{
  PetscFunctionBegin;
  for (int k = 0; k < 2; k++) {
    const PetscBool part  = k ? PETSC_TRUE : PETSC_FALSE;
    const SamTopic *topic = FindAsked(program, asked, part);
    PetscBool       found = PETSC_FALSE;

    if (topic)
      PetscCall(PrintTopic(topic, list));
    else
      PetscCall(PrintOptions(list, asked, part, &found));
    if (topic || found) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(RefuseTopic(program, asked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Collect(const SamProgram *program, const SamArguments *arguments)
{
  PetscFunctionBegin;
  PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
  PetscCall(program->setup(program->context, arguments));
  PetscCall(DescribeFrame());
  PetscCall(PetscOptionsClearValue(NULL, "-help")); /* else PetscFinalize() would print PETSc's help */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintList(const SamProgram *program, const SamHelpList *list, const char asked[])
{
  PetscFunctionBegin;
  if (!strcmp(asked, "json"))
    PetscCall(SamHelpPrintJson(program, list));
  else if (asked[0])
    PetscCall(PrintAsked(program, list, asked));
  else
    PetscCall(PrintAll(program, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProgramHelp(const SamProgram *program, const SamArguments *arguments)
{
  SamHelpList    list = {.groups = 0};
  PetscErrorCode code;

  PetscFunctionBegin;
  SamHelpSetFunction(Keep, &list);
  code = Collect(program, arguments);
  SamHelpSetFunction(NULL, NULL);
  if (!code) code = PrintList(program, &list, arguments->topic);
  PetscCall(Free(&list));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}
