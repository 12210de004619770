/* The help: the options list themselves while the program's set-up reads them; then the requested part is printed. */
#include "program.h"
#include <petsam/private/baseimpl.h>
#include <petsam/private/help.h>
#include <ctype.h>
#include <string.h>

#define WIDTH 120
#define MOST  64 /* maximum number of topics */

/* ---- the list ---- */

enum { TITLE, NAME, ARGUMENT, TEXT, VALUE, WORDS, UNIT, TEXTS };

/* The title of a group, or one of the options after it, as in SamOptionHelp; unused members are NULL */
typedef struct {
  char *text[TEXTS];
} Line;

typedef struct {
  PetscInt count, room;
  Line    *line;
} List;

static PetscErrorCode Keep(void *context, MPI_Comm comm, const char title[], const SamOptionHelp *o)
{
  const SamOptionHelp none = {.name = NULL}, *of = o ? o : &none;
  const char *const   texts[TEXTS] = {title, of->name, of->argument, of->text, of->value, of->words, of->unit};
  List               *list         = (List *)context;

  PetscFunctionBegin;
  (void)comm;
  if (list->count == list->room) {
    list->room = 2 * list->room + 64;
    PetscCall(PetscRealloc((size_t)list->room * sizeof(*list->line), &list->line));
  }
  for (int k = 0; k < TEXTS; k++) PetscCall(PetscStrallocpy(texts[k], &list->line[list->count].text[k]));
  list->count++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Free(List *list)
{
  PetscFunctionBegin;
  for (PetscInt l = 0; l < list->count; l++)
    for (int k = 0; k < TEXTS; k++) PetscCall(PetscFree(list->line[l].text[k]));
  PetscCall(PetscFree(list->line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the options of a program, and those of every program: options of this frame, and the most useful ones of
   PETSc. */
static PetscErrorCode Collect(const SamProgram *program, const SamArguments *arguments)
{
  static const SamOptionHelp all[] = {
    {"help", "[<topic>]", "all options, or one topic or option", "", "", NULL},
    {"version", "", "the version", "", "", NULL},
    {"options_file", "<file>", "file with an option and its value on each line; # begins a comment", "", "", NULL},
    {"log_view", "[<viewer>]", "PETSc's log of the time by event", "", "", NULL}};
  const SamOptions from = {PETSC_COMM_WORLD, NULL};

  PetscFunctionBegin;
  PetscCall(PetscOptionsSetValue(NULL, "-help", NULL));
  PetscCall(program->setup(program->context, arguments));
  PetscCall(SamOptionsHeading(&from, "Of every program and of PETSc"));
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++) PetscCall(SamOptionsDescribe(&from, &all[k]));
  PetscCall(PetscOptionsClearValue(NULL, "-help")); /* otherwise PetscFinalize() would print PETSc's help */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- printing ---- */

static PetscErrorCode PrintLine(const Line *l)
{
  const SamOptionHelp option = {l->text[NAME],  l->text[ARGUMENT], l->text[TEXT],
                                l->text[VALUE], l->text[WORDS],    l->text[UNIT]};

  PetscFunctionBegin;
  PetscCall(SamHelpPrint(NULL, PETSC_COMM_WORLD, l->text[TITLE], l->text[TITLE] ? NULL : &option));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the names of the topics, separated by commas, in lines of limited length; `first` columns are already used. */
static void ListTopics(const SamTopic *topics, size_t first, char text[], size_t size)
{
  size_t column = first, used = 0;

  text[0] = '\0';
  for (const SamTopic *t = topics; t->name; t++) {
    const size_t wide = strlen(t->name) + 2;
    const char  *gap  = t == topics ? "" : column + wide > WIDTH ? "\n" : " ";

    column = *gap == '\n' ? wide : column + wide;
    used += (size_t)snprintf(text + used, size - used, "%s%s%s", gap, t->name, t[1].name ? "," : "");
    if (used >= size) return;
  }
}

static PetscErrorCode PrintAll(const SamProgram *program, const List *list)
{
  static const char before[] = "More about one of these by -help and its name: ";
  char              topics[1024];

  PetscFunctionBegin;
  ListTopics(program->topics + 1, strlen(before), topics, sizeof(topics));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s%s.\n", program->topics->text, before, topics));
  for (PetscInt l = 0; l < list->count; l++) PetscCall(PrintLine(&list->line[l]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the group of this title belongs to the topic. */
static PetscBool HasGroup(const SamTopic *topic, const char title[])
{
  for (int k = 0; k < SAM_TOPIC_GROUPS && topic->group[k]; k++)
    if (!strcmp(topic->group[k], title)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Prints the table of materials for -help materials: constants in SI units, other names, source. */
static PetscErrorCode PrintMaterials(void)
{
  const SamNamedMaterial *m;

  PetscFunctionBegin;
  for (PetscInt k = 0; (m = SamMaterialAt(k)); k++) {
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\n%s (%s)\n  ", m->name, m->aliases));
    for (PetscInt n = 0, used = 0; n < SAM_MATERIAL_CONSTANTS; n++) {
      const SamMaterialConstant *c = SamMaterialConstantAt(n);
      char                       text[64];

      (void)snprintf(text, sizeof(text), "%s %.6g%s%s", c->name, m->value[n], strcmp(c->unit, "1") ? " " : "",
                     strcmp(c->unit, "1") ? c->unit : "");
      if (!isnan(m->value[n])) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s", used++ ? ", " : "", text));
    }
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\n  %s\n", m->source));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintTopic(const SamTopic *topic, const List *list)
{
  PetscBool within = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s", topic->text));
  for (PetscInt l = 0; l < list->count; l++) {
    if (list->line[l].text[TITLE]) within = HasGroup(topic, list->line[l].text[TITLE]);
    if (within) PetscCall(PrintLine(&list->line[l]));
  }
  if (!strcmp(topic->name, "materials")) PetscCall(PrintMaterials());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- as JSON ---- */

/*
  Prints a text in quotes, or null for NULL, between two others. The output has this form:

    {"program": ..., "version": ..., "usage": ...,
     "units": {"m": {"m": 0, "mm": -3, ...}, ...}, (powers of ten)
     "constants": [{"name": "young", "unit": "Pa", "text": ...}, ...],
     "materials": [{"name": "steel", "aliases": ..., "source": ..., "values": [210e9, 0.3, ..., null]}, ...],
     "topics": [{"name": ..., "text": ..., "groups": [...]}, ...],
     "groups": [{"name": ..., "topic": ..., "options": [
       {"name": "-grid_n", "argument": ..., "text": ..., "unit": ... or null, "default": ... or null,
        "words": [...]}, ...]}, ...]}
*/
static PetscErrorCode PrintText(const char before[], const char text[], const char after[])
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s", before, text ? "\"" : "null"));
  while (text && *text) {
    const int plain = (int)strcspn(text, "\"\\\n");

    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%.*s", plain, text));
    text += plain;
    if (*text) PetscCall(PetscPrintf(PETSC_COMM_WORLD, *text == '\n' ? "\\n" : *text == '"' ? "\\\"" : "\\\\"));
    if (*text) text++;
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s", text ? "\"" : "", after));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintJsonOption(const char before[], const Line *o)
{
  char **word;
  int    words;

  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n    {\"name\": \"-%s\"", before, o->text[NAME]));
  PetscCall(PrintText(", \"argument\": ", o->text[ARGUMENT], ""));
  PetscCall(PrintText(", \"text\": ", o->text[TEXT], ""));
  PetscCall(PrintText(", \"unit\": ", o->text[UNIT], ""));
  PetscCall(PrintText(", \"default\": ", o->text[VALUE][0] ? o->text[VALUE] : NULL, ", \"words\": ["));
  PetscCall(PetscStrToArray(o->text[WORDS], ',', &words, &word));
  for (int w = 0; w < words; w++) PetscCall(PrintText(w ? ", " : "", word[w], ""));
  PetscCall(PetscStrToArrayDestroy(words, word));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]}"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintJsonTopics(const SamTopic *topics)
{
  PetscFunctionBegin;
  for (const SamTopic *t = topics; t->name; t++) {
    PetscCall(PrintText(t == topics ? "\n  {\"name\": " : "]},\n  {\"name\": ", t->name, ""));
    PetscCall(PrintText(", \"text\": ", t->text, ", \"groups\": ["));
    for (int k = 0; k < SAM_TOPIC_GROUPS && t->group[k]; k++) PetscCall(PrintText(k ? ", " : "", t->group[k], ""));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintJsonUnits(void)
{
  const char *si, *unit;
  int         power;

  PetscFunctionBegin;
  for (int k = 0; (si = SamUnitOf(k, -1, &power)); k++) {
    PetscCall(PrintText(k ? "},\n  " : "\n  ", si, ": {"));
    for (int n = 0; (unit = SamUnitOf(k, n, &power)); n++) {
      PetscCall(PrintText(n ? ", " : "", unit, ""));
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, ": %d", power));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints the table of materials; a constant that is not known is null. */
static PetscErrorCode PrintJsonMaterials(void)
{
  const SamMaterialConstant *c;
  const SamNamedMaterial    *m;

  PetscFunctionBegin;
  for (PetscInt k = 0; (c = SamMaterialConstantAt(k)); k++) {
    PetscCall(PrintText(k ? "},\n  {\"name\": " : "\n  {\"name\": ", c->name, ""));
    PetscCall(PrintText(", \"unit\": ", c->unit, ""));
    PetscCall(PrintText(", \"text\": ", c->text, ""));
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "}],\n\"materials\": ["));
  for (PetscInt k = 0; (m = SamMaterialAt(k)); k++) {
    PetscCall(PrintText(k ? "]},\n  {\"name\": " : "\n  {\"name\": ", m->name, ""));
    PetscCall(PrintText(", \"aliases\": ", m->aliases, ""));
    PetscCall(PrintText(", \"source\": ", m->source, ", \"values\": ["));
    for (PetscInt n = 0; n < SAM_MATERIAL_CONSTANTS; n++) {
      char text[32];

      (void)snprintf(text, sizeof(text), "%.15g", m->value[n]);
      PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s", n ? ", " : "", isnan(m->value[n]) ? "null" : text));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintJson(const SamProgram *program, const List *list)
{
  PetscFunctionBegin;
  PetscCall(PrintText("{\"program\": ", program->name, ",\n\"version\": \"" PETSAM_VERSION "\""));
  PetscCall(PrintText(",\n\"usage\": ", program->topics->text, ",\n\"units\": {"));
  PetscCall(PrintJsonUnits());
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "}},\n\"constants\": ["));
  PetscCall(PrintJsonMaterials());
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]}],\n\"topics\": ["));
  PetscCall(PrintJsonTopics(program->topics + 1));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]}],\n\"groups\": ["));
  for (PetscInt l = 0; l < list->count; l++) {
    const char     *title = list->line[l].text[TITLE];
    const SamTopic *topic = program->topics;

    if (!title) {
      PetscCall(PrintJsonOption(list->line[l - 1].text[TITLE] ? "" : ",", &list->line[l]));
      continue;
    }
    while (topic->name && !HasGroup(topic, title)) topic++;
    PetscCall(PrintText(l ? "]},\n  {\"name\": " : "\n  {\"name\": ", title, ""));
    PetscCall(PrintText(", \"topic\": ", topic->name, ", \"options\": ["));
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]}]}\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- printing the request ---- */

/* True if `asked` is this name, or its beginning if `part`; _ and - count as spaces. */
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

/* Returns the topic of this name, or with `part` the only one whose name begins with it; NULL: none. */
static const SamTopic *FindAsked(const SamProgram *program, const char asked[], PetscBool part)
{
  const SamTopic *found = NULL;

  for (const SamTopic *t = program->topics + 1; t->name; t++) {
    if (!IsNamed(asked, t->name, part)) continue;
    if (found) return NULL;
    found = t;
  }
  return found;
}

/*
  Prints the option with the name `asked`, and those whose names continue it with a further word. Unless `part`, prints
  them only if there is an option of this name.
*/
static PetscErrorCode PrintOptions(const List *list, const char asked[], PetscBool part, PetscBool *found)
{
  const Line *group = NULL, *printed = NULL;
  char        more[80];

  PetscFunctionBegin;
  (void)snprintf(more, sizeof(more), "%s_", asked);
  *found = part;
  for (PetscInt l = 0; l < list->count && !*found; l++)
    *found = list->line[l].text[NAME] && IsNamed(asked, list->line[l].text[NAME], PETSC_FALSE);
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt l = 0; l < list->count; l++) {
    const Line *line = &list->line[l];
    const char *name = line->text[NAME];

    if (!name) group = line;
    if (!name || (!IsNamed(asked, name, PETSC_FALSE) && !IsNamed(more, name, PETSC_TRUE))) continue;
    if (group != printed) PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s%s\n", printed ? "\n" : "", group->text[TITLE]));
    PetscCall(PrintLine(line));
    printed = group;
  }
  *found = printed != NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RefuseTopic(const SamProgram *program, const char asked[])
{
  const char *names[MOST], *nearest;
  char        topics[1024];
  size_t      count = 0;

  PetscFunctionBegin;
  for (const SamTopic *t = program->topics + 1; t->name && count < MOST; t++) names[count++] = t->name;
  nearest = SamNearestName(asked, count, names);
  ListTopics(program->topics + 1, 0, topics, sizeof(topics));
  for (char *c = topics; *c; c++) *c = *c == '\n' ? ' ' : *c;
  PetscCheck(!nearest, PETSC_COMM_WORLD, SAM_ERR_USER, "-help %s: no such topic: is %s meant? There are %s", asked,
             nearest, topics);
  SETERRQ(PETSC_COMM_WORLD, SAM_ERR_USER, "-help %s: no such topic: expected an option, or one of %s", asked, topics);
}

/* Prints the first of these that exists: a topic, an option, a topic or options whose names begin like this. */
static PetscErrorCode PrintAsked(const SamProgram *program, const List *list, const char asked[])
{
  PetscFunctionBegin;
  for (PetscBool part = PETSC_FALSE;; part = PETSC_TRUE) {
    const SamTopic *topic = FindAsked(program, asked, part);
    PetscBool       found = PETSC_FALSE;

    if (topic)
      PetscCall(PrintTopic(topic, list));
    else
      PetscCall(PrintOptions(list, asked, part, &found));
    if (topic || found) PetscFunctionReturn(PETSC_SUCCESS);
    if (part) PetscCall(RefuseTopic(program, asked));
  }
}

static PetscErrorCode PrintList(const SamProgram *program, const List *list, const char asked[])
{
  PetscFunctionBegin;
  if (!strcmp(asked, "json"))
    PetscCall(PrintJson(program, list));
  else if (asked[0])
    PetscCall(PrintAsked(program, list, asked));
  else
    PetscCall(PrintAll(program, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProgramHelp(const SamProgram *program, const SamArguments *arguments)
{
  List           list = {.count = 0};
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
