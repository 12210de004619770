/* The state of a contact in the host's files: petsam_save() and petsam_load(). */
#include "embedimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/parameters.h>

/* Removes the program's option, -checkpoint or -restart, from the beginning of a message about a file. */
static int LeaveFile(petsam_contact *c, PetscErrorCode error)
{
  const int         code = SamEmbedLeave(c, error);
  const char *const rest = c->message[0] == '-' ? strchr(c->message, ' ') : NULL;

  if (rest) memmove(c->message, rest + 1, strlen(rest));
  return code;
}

static PetscErrorCode CollectParameters(petsam_contact *c, SamParameters *parameters)
{
  PetscFunctionBegin;
  *parameters = (SamParameters){.in_process = PETSC_TRUE};
  PetscCall(SamSetupAddParameters(c->setup, parameters));
  if (c->has_gap)
    PetscCall(SamParametersAddChecksum(parameters, "given_gap", c->gap));
  else
    PetscCall(SamParametersAddText(parameters, "given_gap", PETSC_TRUE, "none"));
  for (PetscInt k = 0; k < SamConditionsCount(c->conditions); k++) {
    const SamCondition *one   = SamConditionsGet(c->conditions, k);
    const PetscReal     value = SamControlGet(&c->control, one);

    if (one->option) PetscCall(SamParametersAddReals(parameters, one->name, PETSC_TRUE, 1, &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Save(petsam_contact *c, const char file[])
{
  SamCheckpoint   checkpoint;
  SamParameters   parameters;
  PetscErrorCode  code;
  const PetscBool committed = SamContactHasStep(c->setup->contact, SAM_COMMITTED);

  PetscFunctionBegin;
  PetscCheck(committed, c->comm, PETSC_ERR_ORDER, "%s: no step has been committed yet", file);
  PetscCall(CollectParameters(c, &parameters));
  PetscCall(SamCheckpointCreate(c->setup->grid, file, &checkpoint));
  code = SamSimulationSave(c->simulation, checkpoint, &parameters, 0, NULL);
  PetscCall(SamCheckpointDestroy(&checkpoint));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_save(petsam_contact *c, const char *file)
{
  return SamEmbedEnterTogether(c, __func__, file != NULL, SamEmbedAddText(0, file)) ? LeaveFile(c, Save(c, file))
                                                                                    : SAM_EMBED_USAGE;
}

static PetscErrorCode Load(petsam_contact *c, const char file[])
{
  SamParameters parameters;

  PetscFunctionBegin;
  PetscCall(SamEmbedForget(c));
  PetscCall(CollectParameters(c, &parameters));
  PetscCall(SamSimulationLoad(c->simulation, file, &parameters));
  PetscCall(SamEmbedRecordAnew(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_load(petsam_contact *c, const char *file)
{
  return SamEmbedEnterTogether(c, __func__, file != NULL, SamEmbedAddText(0, file)) ? LeaveFile(c, Load(c, file))
                                                                                    : SAM_EMBED_USAGE;
}
