/* Load histories in another program: petsam_history(), petsam_live(); copies of contacts, and their reset. */
#include "embedimpl.h"
#include <petsam/private/grid.h>
#include <petsam/private/contact.h>

/* A run, and its monitor */
typedef struct {
  petsam_contact *c;
  petsam_monitor  monitor; /* NULL: none */
  void           *context;
} Run;

/* Calls the host's monitor after a step or cycle; the run stops if the monitor of rank 0 requests it. */
static PetscErrorCode AskHost(const Run *run, int cycle)
{
  int stop;

  PetscFunctionBegin;
  if (!run->monitor) PetscFunctionReturn(PETSC_SUCCESS);
  stop = run->monitor(run->context, run->c, cycle);
  PetscCallMPI(MPI_Bcast(&stop, 1, MPI_INT, 0, run->c->comm));
  if (stop) PetscCall(SamSimulationStop(run->c->simulation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stores the step as petsam_try() does, and all warnings. */
static PetscErrorCode Tell(void *context, SamContact contact, const SamSimulationEvent *news)
{
  const Run *const      run = (const Run *)context;
  petsam_contact *const c   = run->c;

  PetscFunctionBegin;
  (void)contact;
  switch (news->kind) {
  case SAM_NOTIFY_STEP:
  case SAM_NOTIFY_CYCLE_STEP:
    c->last = *news->result;
    if (news->result->status == SAM_STATUS_CONVERGED) PetscCall(SamEmbedRecord(c, news->result));
    if (news->kind == SAM_NOTIFY_STEP) PetscCall(AskHost(run, 0));
    break;
  case SAM_NOTIFY_CYCLE_BEGINS: /* the last computed cycle is what fatigue is asked of */
    SamEmbedForgetSteps(c);
    break;
  case SAM_NOTIFY_CYCLE:
    PetscCall(AskHost(run, 1));
    break;
  case SAM_NOTIFY_MESSAGE:
    if (news->result->status)
      c->last = *news->result;
    else if (news->result->message[0])
      PetscCall(SamEmbedWarn(c, news->result->message, ""));
    break;
  case SAM_NOTIFY_ADVICE:
    PetscCall(SamEmbedWarn(c, news->text, news->setting));
    break;
  default:
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the control of the committed step, from which a history continues; in a life, with the time of the whole
   life. */
static PetscErrorCode GetCommitted(petsam_contact *c, SamControl *control, PetscBool *committed)
{
  const SamSolution *s;

  PetscFunctionBegin;
  *committed = SamContactHasStep(c->setup->contact, SAM_COMMITTED);
  if (!*committed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetSolution(c->setup->contact, &s));
  *control = s->control;
  PetscCall(SamContactGetNumber(c->setup->contact, "time", &control->time));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs a history, or if `cycles` is not NULL a life of so many cycles. */
static PetscErrorCode RunProgram(Run *run, const double *cycles, const char columns[], int rows, const double values[])
{
  petsam_contact *const c = run->c;
  SamHistory            history;
  SamControl            last;
  PetscBool             committed;
  PetscErrorCode        code;

  PetscFunctionBegin;
  PetscCheck(!cycles || *cycles > 0, c->comm, SAM_ERR_USER, "petsam_live: cycles is %.6g: use a number > 0", *cycles);
  PetscCall(SamEmbedForget(c));
  PetscCall(GetCommitted(c, &last, &committed));
  PetscCall(SamHistoryCreate(c->comm, c->conditions, &c->control, committed ? &last : NULL, columns, rows, values,
                             c->increments, &history));
  PetscCall(SamSimulationSetProgram(c->simulation, &history, cycles ? *cycles : 0));
  PetscCall(SamSimulationSetMonitor(c->simulation, Tell, run));
  code = SamSimulationRun(c->simulation);
  PetscCall(SamSimulationSetMonitor(c->simulation, NULL, NULL));
  SamSimulationForgetAdvice(c->simulation);
  if (code) PetscCall(SamEmbedForget(c));
  PetscCall(code);
  c->advised = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int RunAll(petsam_contact *c, const char function[], const double *cycles, const char columns[], int rows,
                  const double values[], petsam_monitor monitor, void *context)
{
  Run       run = {c, monitor, context};
  size_t    row = 1; /* numbers per row */
  uint64_t  sum;
  SamStatus worst;
  PetscBool stopped;
  int       code;

  for (const char *at = columns; at && *at && *at != '#'; at++) row += *at == ','; /* a comment has no columns */
  sum = SamEmbedAdd((uint64_t)rows + (monitor != NULL), cycles, sizeof(*cycles));
  sum =
    SamEmbedAdd(SamEmbedAddText(sum, columns), values, columns && rows > 0 ? row * (size_t)rows * sizeof(*values) : 0);
  if (!SamEmbedEnterTogether(c, function, columns && values, sum)) return SAM_EMBED_USAGE;
  code = SamEmbedLeave(c, RunProgram(&run, cycles, columns, rows, values));
  if (code) return code;
  (void)SamSimulationGetStatus(c->simulation, &worst, &stopped);
  (void)snprintf(c->message, sizeof(c->message), "%s", worst ? c->last.message : c->warnings ? c->warning[0] : "");
  return (int)worst;
}

int petsam_history(petsam_contact *c, const char *columns, int rows, const double *values, petsam_monitor monitor,
                   void *context)
{
  return RunAll(c, __func__, NULL, columns, rows, values, monitor, context);
}

int petsam_live(petsam_contact *c, double cycles, const char *columns, int rows, const double *values,
                petsam_monitor monitor, void *context)
{
  return RunAll(c, __func__, &cycles, columns, rows, values, monitor, context);
}

/* Rejects a contact of other ranks, or another grid or gap; all ranks get the same outcome. */
static PetscErrorCode CheckCopy(petsam_contact *c, petsam_contact *from)
{
  const petsam_contact *const both[] = {c, from};
  const SamGrid               to = c->setup->grid, of = from->setup->grid;
  uint64_t                    gap[2];
  int                         ranks;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_compare(c->comm, from->comm, &ranks));
  PetscCheck(ranks == MPI_IDENT || ranks == MPI_CONGRUENT, c->comm, SAM_ERR_USER,
             "petsam_copy: the contacts belong to different ranks, or to the same in another order: use petsam_save() "
             "and petsam_load()");
  PetscCheck(to->nx == of->nx && to->ny == of->ny && !memcmp(to->width, of->width, sizeof(to->width)) &&
               !memcmp(to->center, of->center, sizeof(to->center)),
             c->comm, SAM_ERR_USER, "petsam_copy: the contacts have different grids");
  for (int k = 0; k < 2; k++) {
    Vec values = SamProblemGetGap(both[k]->setup->problem);

    PetscCall(SamGridChecksum(both[k]->setup->grid, values, &gap[k]));
  }
  PetscCheck(gap[0] == gap[1], c->comm, SAM_ERR_USER, "petsam_copy: the contacts have different gaps");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Copy(petsam_contact *c, petsam_contact *from)
{
  PetscFunctionBegin;
  PetscCheck(SamEmbedExists(from), c->comm, SAM_ERR_USER,
             "petsam_copy: the contact to copy has been destroyed, or is none");
  PetscCall(SamEmbedForget(c));
  PetscCall(CheckCopy(c, from));
  PetscCall(SamSimulationTakeOver(c->simulation, from->simulation));
  PetscCall(SamEmbedRecordAnew(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_copy(petsam_contact *c, petsam_contact *from)
{
  return SamEmbedEnterTogether(c, __func__, from != NULL, 0) ? SamEmbedLeave(c, Copy(c, from)) : SAM_EMBED_USAGE;
}

static PetscErrorCode Reset(petsam_contact *c)
{
  PetscFunctionBegin;
  PetscCall(SamEmbedForget(c));
  PetscCall(SamSimulationReset(c->simulation));
  PetscCall(SamEmbedRecordAnew(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_reset(petsam_contact *c)
{
  return SamEmbedEnterTogether(c, __func__, PETSC_TRUE, 0) ? SamEmbedLeave(c, Reset(c)) : SAM_EMBED_USAGE;
}
