/*
  The help as JSON, for programs that make the reference, the man page and the completion of options from it:

    {"program": ..., "version": ..., "usage": ...,
     "topics": [{"name": ..., "text": ..., "groups": [...]}, ...],
     "groups": [{"name": ..., "topic": ..., "options": [
       {"name": "-grid_n", "argument": ..., "text": ..., "default": ... or null, "words": [...]}, ...]}, ...]}
*/
#include "helpimpl.h"
#include <petsam/private/baseimpl.h>
#include <string.h>

/* A text in quotes. */
static PetscErrorCode PrintText(const char text[])
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\""));
  while (*text) {
    const int plain = (int)strcspn(text, "\"\\\n");

    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%.*s", plain, text));
    text += plain;
    if (*text) PetscCall(PetscPrintf(PETSC_COMM_WORLD, *text == '\n' ? "\\n" : *text == '"' ? "\\\"" : "\\\\"));
    if (*text) text++;
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* `"name": "text"`, or null for NULL; before it what separates it from what stands there. */
static PetscErrorCode PrintMember(const char before[], const char name[], const char text[])
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\"%s\": ", before, name));
  if (text)
    PetscCall(PrintText(text));
  else
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "null"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Words with commas between them. */
static PetscErrorCode PrintWords(const char words[])
{
  char **list;
  int    count;

  PetscFunctionBegin;
  PetscCall(PetscStrToArray(words, ',', &count, &list));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, ", \"words\": ["));
  for (int w = 0; w < count; w++) {
    if (w) PetscCall(PetscPrintf(PETSC_COMM_WORLD, ", "));
    PetscCall(PrintText(list[w]));
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]"));
  PetscCall(PetscStrToArrayDestroy(count, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintOption(const char before[], const SamListedOption *o)
{
  char dashed[160];

  PetscFunctionBegin;
  (void)snprintf(dashed, sizeof(dashed), "-%s", o->text[SAM_HELP_NAME]);
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n    {", before));
  PetscCall(PrintMember("", "name", dashed));
  PetscCall(PrintMember(", ", "argument", o->text[SAM_HELP_ARGUMENT]));
  PetscCall(PrintMember(", ", "text", o->text[SAM_HELP_TEXT]));
  PetscCall(PrintMember(", ", "default", o->text[SAM_HELP_VALUE][0] ? o->text[SAM_HELP_VALUE] : NULL));
  PetscCall(PrintWords(o->text[SAM_HELP_WORDS]));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "}"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintGroup(const SamProgram *program, const SamHelpList *list, PetscInt g)
{
  const SamTopic *topic = SamHelpFindTopic(program, list->group[g]);
  PetscBool       first = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n  {", g ? "," : ""));
  PetscCall(PrintMember("", "name", list->group[g]));
  PetscCall(PrintMember(", ", "topic", topic ? topic->name : NULL));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, ", \"options\": ["));
  for (PetscInt o = 0; o < list->options; o++) {
    if (list->option[o].group != g) continue;
    PetscCall(PrintOption(first ? "" : ",", &list->option[o]));
    first = PETSC_FALSE;
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]}"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PrintTopic(const SamTopic *topic, PetscBool first)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "%s\n  {", first ? "" : ","));
  PetscCall(PrintMember("", "name", topic->name));
  PetscCall(PrintMember(", ", "text", topic->text));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, ", \"groups\": ["));
  for (int k = 0; k < SAM_TOPIC_GROUPS && topic->group[k]; k++) {
    if (k) PetscCall(PetscPrintf(PETSC_COMM_WORLD, ", "));
    PetscCall(PrintText(topic->group[k]));
  }
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]}"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHelpPrintJson(const SamProgram *program, const SamHelpList *list)
{
  PetscFunctionBegin;
  PetscCall(PrintMember("{", "program", program->name));
  PetscCall(PrintMember(",\n", "version", PETSAM_VERSION));
  PetscCall(PrintMember(",\n", "usage", program->usage));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, ",\n\"topics\": ["));
  for (const SamTopic *t = program->topics; t->name; t++) PetscCall(PrintTopic(t, t == program->topics));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "],\n\"groups\": ["));
  for (PetscInt g = 0; g < list->groups; g++) PetscCall(PrintGroup(program, list, g));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "]}\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
