/*
  A contact in another program: an interface of plain C types to the library's objects.

  Each function enters, so that the options are those of the contact and errors become messages, then works by PETSc's
  rules, and leaves with an exit code of the programs. Errors are raised on all ranks of a contact.
*/
#include "embedimpl.h"
#include <petsam/private/arguments.h>
#include <petsam/private/grid.h>
#include <petsam/private/state.h>
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/stiffness.h>
#include <stdarg.h>

/* The message of petsam_create() if there is no contact to contain it */
static char created[SAM_MESSAGE];

/* ---- entering and leaving ---- */

/* True if MPI and PETSc have not been finalized. */
static PetscBool IsAlive(void)
{
  PetscBool has;
  int       ended;

  return !MPI_Finalized(&ended) && !ended && !PetscInitialized(&has) && has;
}

/* The contacts that have not been destroyed: whether a pointer is one of them can be said without reading from it. */
static petsam_contact *contacts;

PetscBool SamEmbedExists(const petsam_contact *c)
{
  const petsam_contact *one = contacts;

  while (one && one != c) one = one->next;
  return one ? PETSC_TRUE : PETSC_FALSE;
}

static void Unlink(const petsam_contact *c)
{
  petsam_contact **to = &contacts;

  while (*to && *to != c) to = &(*to)->next;
  if (*to) *to = c->next;
}

PetscBool SamEmbedEnter(petsam_contact *c, const char function[], PetscBool given)
{
  if (!SamEmbedExists(c)) {
    (void)snprintf(created, sizeof(created), "%s: the contact %s", function,
                   c ? "has been destroyed, or is none" : "is NULL");
    return PETSC_FALSE;
  }
  c->message[0] = '\0';
  if (!given) (void)SamEmbedRefuse(c, "%s: a pointer is NULL", function);
  if (given && !IsAlive()) (void)SamEmbedRefuse(c, "MPI or PETSc has been finalized");
  if (c->message[0]) return PETSC_FALSE;
  (void)PetscPushErrorHandler(SamKeepMessage, c->message);
  if (!c->depth++) (void)PetscOptionsPush(c->options); /* a database must not be pushed twice */
  return PETSC_TRUE;
}

PetscBool SamEmbedEnterTogether(petsam_contact *c, const char function[], PetscBool given, uint64_t arguments)
{
  const uint64_t sum    = SamEmbedAddText(arguments + given, function);
  uint64_t       both[] = {sum, ~sum};

  if (SamEmbedExists(c) && IsAlive()) (void)MPI_Allreduce(MPI_IN_PLACE, both, 2, MPI_UINT64_T, MPI_MAX, c->comm);
  if (both[0] == ~both[1]) return SamEmbedEnter(c, function, given);
  (void)SamEmbedRefuse(c,
                       "%s: the ranks of the contact call different functions, or with different arguments: call the "
                       "same with the same on all of them",
                       function);
  return PETSC_FALSE;
}

/* Returns the program's exit code for an error; wrong arguments are mistakes of usage here. */
static int CodeOf(PetscErrorCode code)
{
  switch ((int)code) {
  case SAM_ERR_USER:
  case PETSC_ERR_ARG_OUTOFRANGE:
  case PETSC_ERR_ARG_UNKNOWN_TYPE:
  case PETSC_ERR_ARG_WRONG:
  case PETSC_ERR_ORDER:
    return SAM_EMBED_USAGE;
  case SAM_ERR_FILE:
    return SAM_EMBED_FILE;
  case PETSC_ERR_NOT_CONVERGED:
    return SAM_STATUS_NOT_CONVERGED;
  default:
    return (int)code;
  }
}

int SamEmbedLeave(petsam_contact *c, PetscErrorCode code)
{
  if (!--c->depth) (void)PetscOptionsPop();
  (void)PetscPopErrorHandler();
  if (code == PETSC_ERR_MEM) (void)snprintf(c->message, sizeof(c->message), "not enough memory");
  if (code && !c->message[0]) (void)snprintf(c->message, sizeof(c->message), "error %d of PETSc", (int)code);
  return CodeOf(code);
}

int SamEmbedRefuse(petsam_contact *c, const char format[], ...)
{
  va_list values;

  va_start(values, format);
  (void)vsnprintf(c->message, sizeof(c->message), format, values);
  va_end(values);
  return SAM_EMBED_USAGE;
}

const char *petsam_message(const petsam_contact *c)
{
  return SamEmbedExists(c) ? c->message : created;
}

/* ---- creation ---- */

/* Rejects by name the options that only the program has; loads are given to petsam_try(). */
static PetscErrorCode RefuseOthers(const petsam_contact *c)
{
  static const char *const others[] = {"load_history", "wear_cycles"};

  PetscFunctionBegin;
  for (PetscInt k = -2; k < 0 || SamControlName(NULL, k); k++) {
    const char *name = k < 0 ? others[k + 2] : SamControlName(NULL, k);
    char        option[32];
    PetscBool   set;

    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", name));
    PetscCall(PetscOptionsHasName(NULL, NULL, option, &set));
    PetscCheck(!set, c->comm, SAM_ERR_USER, "-%s: give loads, displacements and cycles with each call, not as options",
               name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadConditions(petsam_contact *c, const SamOptions *from)
{
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(SamControlInitialize(&c->control));
  c->conditions = SamProblemGetConditions(c->setup->problem);
  for (PetscInt k = 0; k < SamConditionsCount(c->conditions); k++)
    PetscCall(SamControlReadCondition(from, SamConditionsGet(c->conditions, k), &c->control, &set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEmbedInsertOptions(petsam_contact *c, PetscOptions database, const char options[])
{
  SamArguments arguments;
  int          length = (int)strlen(options) + 1, rank;
  char        *copy;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(c->comm, &rank));
  PetscCallMPI(MPI_Bcast(&length, 1, MPI_INT, 0, c->comm));
  PetscCall(PetscMalloc1(length, &copy));
  if (rank == 0) PetscCall(PetscArraycpy(copy, options, length));
  PetscCallMPI(MPI_Bcast(copy, length, MPI_CHAR, 0, c->comm));
  SamArgumentsSeparate(copy);
  SamArgumentsExamineText(c->comm, copy, &arguments);
  SamArgumentsFree(&arguments);
  if (!arguments.code) PetscCall(PetscOptionsInsertString(database, copy));
  PetscCall(PetscFree(copy));
  PetscCheck(!arguments.code, c->comm, arguments.code, "%s", arguments.message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(petsam_contact *c, const char options[])
{
  const SamOptions from = {c->comm, NULL};

  PetscFunctionBegin;
  PetscCall(SamInitialize());
  PetscCall(SamEmbedInsertOptions(c, c->options, options));
  PetscCall(RefuseOthers(c));
  PetscCall(SamSimulationCreate(c->comm, &c->simulation));
  c->setup = SamSimulationGetSetup(c->simulation);
  PetscCall(SamSimulationSetContactFromOptions(c->simulation, &from));
  PetscCall(SamHistoryReadIncrements(&from, &c->increments));
  PetscCall(ReadConditions(c, &from));
  PetscCall(SamSimulationSetUp(c->simulation, &from));
  PetscCall(SamArgumentsRefuseUnknown(c->comm, NULL));
  PetscCall(SamSimulationCheckFiles(c->simulation, NULL));
  PetscCall(SamGridCreateVec(c->setup->grid, 1, &c->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- warnings ---- */

PetscErrorCode SamEmbedWarn(petsam_contact *c, const char text[], const char setting[])
{
  char line[2 * SAM_MESSAGE];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(line, sizeof(line), setting[0] ? "%s (-%s)" : "%s", text, setting));
  PetscCall(PetscRealloc(sizeof(*c->warning) * ((size_t)c->warnings + 1), &c->warning));
  PetscCall(PetscStrallocpy(line, &c->warning[c->warnings]));
  c->warnings++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Warn(void *contact, const char text[], const char setting[])
{
  return SamEmbedWarn((petsam_contact *)contact, text, setting);
}

static PetscErrorCode ForgetWarnings(petsam_contact *c)
{
  PetscFunctionBegin;
  for (int k = 0; k < c->warnings; k++) PetscCall(PetscFree(c->warning[k]));
  c->warnings = 0;
  PetscCall(PetscFree(c->warning));
  c->advised = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the warnings of a step only when they are requested, as this takes time. */
static PetscErrorCode Advise(petsam_contact *c, int *count)
{
  const PetscBool tried = SamContactHasStep(c->setup->contact, SAM_TRIED);

  PetscFunctionBegin;
  PetscCheck(c->depth < 2, c->comm, PETSC_ERR_ORDER, "petsam_advise: call it after the monitor returns");
  if (!c->advised && tried && SamStepIsSolved(&c->last))
    PetscCall(SamSimulationAdviseSingle(c->simulation, &c->last, Warn, c));
  c->advised = PETSC_TRUE;
  *count     = c->warnings;
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_advise(petsam_contact *c, int *count)
{
  return SamEmbedEnterTogether(c, __func__, count != NULL, 0) ? SamEmbedLeave(c, Advise(c, count)) : SAM_EMBED_USAGE;
}

const char *petsam_warning(const petsam_contact *c, int k)
{
  return SamEmbedExists(c) && k >= 0 && k < c->warnings ? c->warning[k] : NULL;
}

/* ---- the end ---- */

static PetscErrorCode Destroy(petsam_contact *c)
{
  PetscFunctionBegin;
  PetscCall(SamEmbedDestroyStress(c));
  PetscCall(ForgetWarnings(c));
  PetscCall(VecDestroy(&c->work));
  PetscCall(SamSimulationDestroy(&c->simulation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void petsam_destroy(petsam_contact **c)
{
  if (!c || !*c) return;
  if (!SamEmbedExists(*c)) {
    (void)SamEmbedEnter(*c, __func__, PETSC_TRUE); /* leaves a message */
    *c = NULL;
    return;
  }
  if ((*c)->depth) {
    (void)SamEmbedRefuse(*c, "petsam_destroy: call it after the monitor returns");
    return;
  }
  if (SamEmbedEnter(*c, __func__, PETSC_TRUE)) {
    (void)SamEmbedLeave(*c, Destroy(*c));
    (void)PetscOptionsDestroy(&(*c)->options);
  }
  Unlink(*c);
  free(*c);
  *c = NULL;
}

/* True if a handle belongs to no communicator: Open MPI returns a null pointer for an unknown number. */
static PetscBool IsNothing(MPI_Comm comm)
{
#if defined(OPEN_MPI)
  return comm ? PETSC_FALSE : PETSC_TRUE;
#else
  (void)comm;
  return PETSC_FALSE;
#endif
}

int petsam_create(int comm, const char *options, petsam_contact **contact)
{
  petsam_contact *c;
  int             code;

  created[0] = '\0';
  if (contact) *contact = NULL;
  code = SamEmbedStart(created, sizeof(created));
  if (code) return code;
  c = (petsam_contact *)calloc(1, sizeof(*c));
  if (!c || PetscOptionsCreate(&c->options)) {
    (void)snprintf(created, sizeof(created), "not enough memory");
    free(c);
    return PETSC_ERR_MEM;
  }
  c->next  = contacts;
  contacts = c;
  c->comm  = comm == -1 ? MPI_COMM_SELF : MPI_Comm_f2c((MPI_Fint)comm);
  if (c->comm == MPI_COMM_NULL || IsNothing(c->comm))
    code = SamEmbedRefuse(c, "petsam_create: comm is no communicator, or this rank does not belong to it");
  else
    code = SamEmbedEnterTogether(c, __func__, contact && options, 0) ? SamEmbedLeave(c, Create(c, options))
                                                                     : SAM_EMBED_USAGE;
  (void)snprintf(created, sizeof(created), "%s", c->message);
  if (code)
    petsam_destroy(&c);
  else
    *contact = c;
  return code;
}

/* ---- inputs ---- */

int petsam_grid(petsam_contact *c, int n[2], double size[2], double center[2], int *first_row, int *rows)
{
  SamGrid grid;

  if (!SamEmbedEnter(c, __func__, PETSC_TRUE)) return SAM_EMBED_USAGE;
  grid = c->setup->grid;
  for (int k = 0; k < 2; k++) {
    if (n) n[k] = (int)(k ? grid->ny : grid->nx);
    if (size) size[k] = (double)grid->width[k];
    if (center) center[k] = (double)grid->center[k];
  }
  if (first_row) *first_row = (int)grid->row_start;
  if (rows) *rows = (int)grid->rows;
  return SamEmbedLeave(c, PETSC_SUCCESS);
}

PetscErrorCode SamEmbedForget(petsam_contact *c)
{
  PetscFunctionBegin;
  PetscCheck(c->depth < 2, c->comm, PETSC_ERR_ORDER, "a monitor may query fields and numbers only");
  PetscCall(SamContactReject(c->setup->contact));
  PetscCall(PetscMemzero(&c->last, sizeof(c->last)));
  PetscCall(ForgetWarnings(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the gap of the bodies as they were before any step. */
static PetscErrorCode SetGap(petsam_contact *c, Vec gap)
{
  PetscFunctionBegin;
  c->has_gap = PETSC_TRUE;
  PetscCall(SamGridChecksum(c->setup->grid, gap, &c->gap));
  PetscCall(SamSimulationSetGap(c->simulation, gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetField(petsam_contact *c, const char name[], const double values[])
{
  const PetscBool gap = !strcmp(name, "gap");
  PetscBool       finite;
  double         *cells;

  PetscFunctionBegin;
  PetscCheck(gap || !strcmp(name, "friction"), c->comm, SAM_ERR_USER, "%s: expected gap or friction", name);
  PetscCall(VecGetArrayWrite(c->work, &cells));
  PetscCall(PetscArraycpy(cells, values, c->setup->grid->cells));
  PetscCall(VecRestoreArrayWrite(c->work, &cells));
  PetscCall(SamGridIsFinite(c->setup->grid, c->work, &finite));
  PetscCheck(finite, c->comm, SAM_ERR_USER, "%s: not all values are finite numbers", name);
  PetscCall(SamEmbedForget(c));
  PetscCall(gap ? SetGap(c, c->work) : SamSimulationSetFriction(c->simulation, c->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_set_field(petsam_contact *c, const char *name, const double *values)
{
  return SamEmbedEnterTogether(c, __func__, SamEmbedExists(c) && name && (values || !c->setup->grid->cells),
                               SamEmbedAddText(0, name))
           ? SamEmbedLeave(c, SetField(c, name, values))
           : SAM_EMBED_USAGE;
}

/* ---- steps ---- */

/* Tries a step. Conditions without a name have the values of the contact's options. */
static PetscErrorCode Try(petsam_contact *c, double time, int count, const char *const names[], const double values[])
{
  const char *given[SAM_COMPONENTS + SAM_CONDITIONS] = {NULL}; /* name for each given part of the control */
  SamControl  control                                = c->control;

  PetscFunctionBegin;
  PetscCheck(isfinite(time), c->comm, SAM_ERR_USER, "time is not a finite number");
  control.time = time;
  for (int k = 0; k < count; k++) {
    SamWay   way;
    PetscInt part;

    PetscCheck(names[k][0] && !names[k][strcspn(names[k], SAM_EMBED_BETWEEN)], c->comm, SAM_ERR_USER,
               "name %d, \"%s\", is empty or contains a blank: give one name for each value, with commas between them",
               k + 1, names[k]);
    PetscCall(SamControlSet(&control, c->conditions, names[k], values[k]));
    part = SamControlFind(c->conditions, names[k], &way);
    PetscCheck(!given[part], c->comm, SAM_ERR_USER, "%s and %s exclude each other: give one of them", given[part],
               names[k]);
    given[part] = names[k];
  }
  PetscCheck(given[SAM_COMPONENT_N], c->comm, SAM_ERR_USER, "load_n or disp_z is missing");
  PetscCall(SamEmbedForget(c));
  PetscCall(SamSimulationTrySingle(c->simulation, &control, &c->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tries a step together; `given`: no pointer was NULL. */
static int TryTogether(petsam_contact *c, PetscBool given, double time, int count, const char *const names[],
                       const double values[], double load[], double rigid[])
{
  uint64_t sum = SamHashBits(time) + (uint64_t)count;
  int      code;

  for (int k = 0; k < count && given; k++)
    sum = SamEmbedAdd(SamEmbedAddText(sum, names[k]), &values[k], sizeof(*values));
  if (!SamEmbedEnterTogether(c, "petsam_try", given, sum)) return SAM_EMBED_USAGE;
  code = SamEmbedLeave(c, Try(c, time, count, names, values));
  if (code) return code;
  for (int k = 0; k < SAM_COMPONENTS; k++) {
    if (load) load[k] = (double)c->last.load[k];
    if (rigid) rigid[k] = (double)c->last.rigid[k];
  }
  (void)snprintf(c->message, sizeof(c->message), "%s", c->last.message);
  return (int)c->last.status;
}

/*
  Divides a copy of `names` at its commas; each comma ends a name, even an empty one, so that there are as many as a
  caller counts. The caller frees the list and the copy; NULL: there is no memory, or no text.
*/
static const char **SplitNames(const char names[], char **copy, int *count)
{
  const char **list;
  char        *next;

  *count = 0;
  *copy  = names ? strdup(names) : NULL;
  list   = *copy ? (const char **)calloc(strlen(*copy) + 1, sizeof(*list)) : NULL;
  next   = list ? *copy : NULL;
  while (next) {
    list[(*count)++] = next;
    next             = strchr(next, ',');
    if (next) *next++ = '\0';
  }
  return list;
}

int petsam_try(petsam_contact *c, double time, const char *names, const double values[], double load[6],
               double rigid[6])
{
  char        *copy;
  int          count, code;
  const char **list = SplitNames(values ? names : NULL, &copy, &count);

  code = TryTogether(c, list != NULL, time, count, list, values, load, rigid);
  free(list);
  free(copy);
  return code;
}

const char *petsam_step_name(petsam_contact *c, int k, const char **unit)
{
  const int               past    = k - SAM_WAYS * SAM_COMPONENTS; /* index after those of the components */
  const SamComponentName *one     = &SamComponentNames[k < 0 ? 0 : k % SAM_COMPONENTS];
  const char *const       units[] = {one->load_unit, one->rigid_unit, one->creep_unit};
  const SamCondition     *condition;

  if (!SamEmbedExists(c) || k < 0 || past >= SamConditionsCount(c->conditions)) return NULL;
  if (past < 0) {
    const char *name = SamComponentNameOf(k % SAM_COMPONENTS, (SamWay)(k / SAM_COMPONENTS));

    if (unit && name) *unit = SamUnitOn(c->setup->grid, units[k / SAM_COMPONENTS]);
    return name ? name : "";
  }
  condition = SamConditionsGet(c->conditions, past);
  if (unit) *unit = condition->unit;
  return condition->name;
}

static PetscErrorCode Commit(petsam_contact *c)
{
  PetscFunctionBegin;
  PetscCheck(c->depth < 2, c->comm, PETSC_ERR_ORDER, "the step is committed after the monitor returns");
  PetscCall(SamSimulationCommitSingle(c->simulation, &c->last, c->message, sizeof(c->message)));
  PetscCall(SamEmbedRecord(c, &c->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_commit(petsam_contact *c)
{
  return SamEmbedEnterTogether(c, __func__, PETSC_TRUE, 0) ? SamEmbedLeave(c, Commit(c)) : SAM_EMBED_USAGE;
}

int petsam_reject(petsam_contact *c)
{
  return SamEmbedEnterTogether(c, __func__, PETSC_TRUE, 0) ? SamEmbedLeave(c, SamEmbedForget(c)) : SAM_EMBED_USAGE;
}

static PetscErrorCode Stiffness(petsam_contact *c, PetscBool reversal, int count, const char *const cases[], double k[])
{
  SamStiffness        s;
  char                text[SAM_MESSAGE];
  const SamCondition *conditions[SAM_CONDITIONS];
  const PetscInt      size  = SAM_COMPONENTS + count;
  const PetscBool     tried = SamContactHasStep(c->setup->contact, SAM_TRIED);

  PetscFunctionBegin;
  PetscCheck(count <= SAM_CONDITIONS, c->comm, SAM_ERR_USER, "%d load cases: a contact has at most %d", count,
             SAM_CONDITIONS);
  for (int l = 0; l < count; l++) {
    conditions[l] = SamConditionsFind(c->conditions, cases[l]);
    PetscCheck(conditions[l], c->comm, SAM_ERR_USER, "%s: is no load case of this contact, like body2_case_NAME",
               cases[l]);
  }
  PetscCheck(!tried || SamStepIsSolved(&c->last), c->comm, PETSC_ERR_NOT_CONVERGED,
             "the tried step did not converge, and has no stiffness: %s", c->last.message);
  PetscCall(SamStiffnessCompute(c->setup->contact, reversal ? SAM_STIFFNESS_REVERSAL : SAM_STIFFNESS_FORWARD, count,
                                conditions, &s));
  for (PetscInt i = 0; i < size; i++)
    for (PetscInt j = 0; j < size; j++) k[size * i + j] = (double)s.k[i][j];
  SamStiffnessDescribe(&s, text, sizeof(text));
  PetscCheck(s.converged, c->comm, PETSC_ERR_NOT_CONVERGED, "%s", text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_stiffness(petsam_contact *c, int reversal, double k[36])
{
  return SamEmbedEnterTogether(c, __func__, k != NULL, reversal != 0)
           ? SamEmbedLeave(c, Stiffness(c, reversal != 0, 0, NULL, k))
           : SAM_EMBED_USAGE;
}

int petsam_stiffness_with(petsam_contact *c, int reversal, const char *cases, double *k)
{
  char          *copy;
  int            count, code = SAM_EMBED_USAGE;
  const char   **list = SplitNames(k ? cases : NULL, &copy, &count);
  const uint64_t sum  = SamEmbedAddText(reversal != 0, cases);

  if (SamEmbedEnterTogether(c, __func__, list != NULL, sum))
    code = SamEmbedLeave(c, Stiffness(c, reversal != 0, count, list, k));
  free(list);
  free(copy);
  return code;
}

/* ---- results ---- */

PetscErrorCode SamEmbedCopyField(petsam_contact *c, const char name[], double values[])
{
  const double *cells;

  PetscFunctionBegin;
  PetscCall(SamContactGetField(c->setup->contact, name, c->work));
  PetscCall(VecGetArrayRead(c->work, &cells));
  PetscCall(PetscArraycpy(values, cells, c->setup->grid->cells));
  PetscCall(VecRestoreArrayRead(c->work, &cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetField(petsam_contact *c, const char name[], double values[])
{
  PetscBool       found;
  const PetscBool tried     = SamContactHasStep(c->setup->contact, SAM_TRIED);
  const PetscBool committed = SamContactHasStep(c->setup->contact, SAM_COMMITTED);

  PetscFunctionBegin;
  PetscCheck(tried || committed, c->comm, PETSC_ERR_ORDER, "%s: no step has been solved yet", name);
  PetscCall(SamContactHasField(c->setup->contact, name, &found));
  PetscCheck(found, c->comm, SAM_ERR_USER, "%s: there is no field of this name", name);
  PetscCall(SamEmbedCopyField(c, name, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_get_field(petsam_contact *c, const char *name, double *values)
{
  return SamEmbedEnterTogether(c, __func__, SamEmbedExists(c) && name && (values || !c->setup->grid->cells),
                               SamEmbedAddText(0, name))
           ? SamEmbedLeave(c, GetField(c, name, values))
           : SAM_EMBED_USAGE;
}

const char *petsam_field_name(petsam_contact *c, int k)
{
  SamState state;

  if (!SamEmbedExists(c) || SamContactGetState(c->setup->contact, &state)) return NULL;
  for (PetscInt n = 0; n < SamStateCountResults(state); n++)
    if (SamStateResultOf(state, n)->kind <= SAM_FIELD_STATE && k-- == 0) return SamStateResultOf(state, n)->name;
  return NULL;
}

/* Returns the place of the k-th number that can be requested by name, or of the first of this name (not NULL); -1:
   none. */
static PetscInt FindNumber(SamState state, PetscInt k, const char wanted[], const char **name)
{
  for (PetscInt n = 0; n < SamStateCountNumbers(state); n++) {
    PetscInt              id;
    const SamStateNumber *number = SamStateNumberOf(state, n, &id);

    *name = number->name;
    if (number->result && number->count == 1 && (wanted ? !strcmp(wanted, number->name) : k-- == 0)) return id;
  }
  return -1;
}

const char *petsam_number_name(petsam_contact *c, int k)
{
  const char *name;
  SamState    state;

  if (!SamEmbedExists(c) || SamContactGetState(c->setup->contact, &state)) return NULL;
  return FindNumber(state, k, NULL, &name) < 0 ? NULL : name;
}

static PetscErrorCode GetNumber(petsam_contact *c, const char name[], double *value)
{
  static const char cycle[] = "wear/";

  const size_t    skip = strncmp(name, cycle, strlen(cycle)) ? 0 : strlen(cycle);
  const char     *found;
  SamState        state;
  PetscInt        id;
  const PetscBool committed = SamContactHasStep(c->setup->contact, SAM_COMMITTED);

  PetscFunctionBegin;
  PetscCall(SamContactGetState(c->setup->contact, &state)); /* a step without a solution has numbers, too */
  PetscCheck(committed || SamStateHasTried(state), c->comm, PETSC_ERR_ORDER, "%s: no step has been tried yet", name);
  if (skip) state = SamSimulationGetSeries(c->simulation);
  PetscCheck(state, c->comm, PETSC_ERR_ORDER, "%s: no cycles have been computed", name);
  id = FindNumber(state, 0, name + skip, &found);
  PetscCheck(id >= 0, c->comm, SAM_ERR_USER, "%s: there is no number of this name", name);
  *value = *SamStateReadNumbers(state, id);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_get_number(petsam_contact *c, const char *name, double *value)
{
  return SamEmbedEnter(c, __func__, name && value) ? SamEmbedLeave(c, GetNumber(c, name, value)) : SAM_EMBED_USAGE;
}
