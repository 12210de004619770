/* The help: options list themselves while they are read; what they say is printed, or given to whoever asked for it. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/help.h>

#define COLUMN 40 /* of the descriptions */

static SamHelpFunction receive  = SamHelpPrint;
static void           *receiver = NULL;

void SamHelpSetFunction(SamHelpFunction function, void *context)
{
  receive  = function ? function : SamHelpPrint;
  receiver = context;
}

PetscErrorCode SamPrintHelp(PetscBool *print)
{
  PetscFunctionBegin;
  PetscCall(PetscOptionsHasHelp(NULL, print));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsHeading(const SamOptions *from, const char title[])
{
  PetscBool help;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  if (help) PetscCall((*receive)(receiver, from->comm, title, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOptionsDescribe(const SamOptions *from, const SamOptionHelp *option)
{
  SamOptionHelp prefixed = *option;
  PetscBool     help;
  char          name[128];

  PetscFunctionBegin;
  SamOptionsKnow(from, option->name, NULL);
  PetscCall(SamPrintHelp(&help));
  if (!help) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(name, sizeof(name), "%s%s", SamOptionsPrefix(from), option->name);
  prefixed.name = name;
  if (strstr(option->text, "required")) prefixed.value = "";
  PetscCall((*receive)(receiver, from->comm, NULL, &prefixed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A name that is too long for its column gets a line of its own. */
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
