/* The help: options are listed while they are read; their descriptions are printed, or passed to a receiver. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/help.h>
#include <petsam/private/base.h>

#define COLUMN 40 /* first column of the descriptions */

static SamHelpFunction receive  = SamHelpPrint;
static void           *receiver = NULL;

void SamHelpSetFunction(SamHelpFunction function, void *context)
{
  receive  = function ? function : SamHelpPrint;
  receiver = context;
}

PetscBool SamPrintHelp(void)
{
  PetscBool print = PETSC_FALSE;

  return !PetscOptionsHasHelp(NULL, &print) && print ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamOptionsHeading(const SamOptions *from, const char title[])
{
  PetscFunctionBegin;
  SamValidPointer(from, 1);
  SamValidPointer(title, 2);
  if (SamPrintHelp()) PetscCall((*receive)(receiver, from->comm, title, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsDescribe(const SamOptions *from, const SamOptionHelp *option)
{
  SamOptionHelp prefixed = *option;
  char          name[128], text[512];

  PetscFunctionBegin;
  SamOptionsKnow(from, option->name, NULL);
  if (!SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(name, sizeof(name), "%s%s", SamOptionsPrefix(from), option->name);
  SamAddUnit(option->text, option->unit, text, sizeof(text));
  prefixed.name = name;
  prefixed.text = text;
  if (strstr(option->text, "required")) prefixed.value = "";
  PetscCall((*receive)(receiver, from->comm, NULL, &prefixed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prints an option or a title; a name that is too long for its column gets a line of its own. */
PetscErrorCode SamHelpPrint(void *context, MPI_Comm comm, const char title[], const SamOptionHelp *option)
{
  char left[160], shown[PETSC_MAX_PATH_LEN + 4] = "";

  PetscFunctionBegin;
  (void)context;
  if (title) PetscCall(PetscPrintf(comm, "\n%s\n", title));
  if (!option) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(left, sizeof(left), "-%s%s%s", option->name, option->argument[0] ? " " : "", option->argument);
  if (option->value[0]) (void)snprintf(shown, sizeof(shown), " (%s)", option->value);
  if (strlen(left) >= COLUMN)
    PetscCall(PetscPrintf(comm, "  %s\n  %*s%s%s\n", left, COLUMN, "", option->text, shown));
  else
    PetscCall(PetscPrintf(comm, "  %-*s%s%s\n", COLUMN, left, option->text, shown));
  PetscFunctionReturn(PETSC_SUCCESS);
}
