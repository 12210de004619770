/* The state of a contact in files of the host's: petsam_save() and petsam_load(). */
#include "embedimpl.h"
#include <petsam/private/baseimpl.h>

/* Takes the program's option off a message about a file. */
static int LeaveFile(petsam_contact *c, PetscErrorCode error)
{
  static const char *const options[] = {"-checkpoint ", "-restart "};

  const int code = SamEmbedLeave(c, error);

  for (int k = 0; k < 2; k++) {
    const size_t length = strlen(options[k]);

    if (!strncmp(c->message, options[k], length))
      memmove(c->message, c->message + length, strlen(c->message + length) + 1);
  }
  return code;
}

static PetscErrorCode CollectParameters(petsam_contact *c, SamParameters *parameters)
{
  PetscFunctionBegin;
  parameters->count = 0;
  PetscCall(SamSetupAddParameters(&c->setup, parameters));
  PetscCall(SamWearLawsAddParameters(&c->laws, "steps", parameters));
  if (c->has_gap)
    PetscCall(SamParametersAddChecksum(parameters, "given_gap", c->gap));
  else
    PetscCall(SamParametersAddText(parameters, "given_gap", PETSC_TRUE, "none"));
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++)
      PetscCall(
        SamParametersAddReals(parameters, SamBulkNames[body][k].name, PETSC_TRUE, 1, &c->control.bulk_stress[body][k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Save(petsam_contact *c, const char file[])
{
  SamCheckpoint  checkpoint;
  SamParameters  parameters;
  PetscErrorCode code;

  PetscFunctionBegin;
  PetscCheck(c->has_committed, c->comm, PETSC_ERR_ORDER, "%s: no step has been committed yet", file);
  PetscCall(CollectParameters(c, &parameters));
  PetscCall(SamCheckpointCreate(c->setup.grid, file, &checkpoint));
  code = SamCheckpointWrite(checkpoint, c->setup.contact, c->wear, &parameters, 0, NULL);
  PetscCall(SamCheckpointDestroy(&checkpoint));
  PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_save(petsam_contact *c, const char *file)
{
  if (!c) return SAM_EMBED_USAGE;
  if (!file) return SamEmbedRefuse(c, "petsam_save: a pointer is NULL");
  if (!SamEmbedEnter(c)) return SAM_EMBED_USAGE;
  return LeaveFile(c, Save(c, file));
}

/* The numbers of the committed step that its state holds. */
static PetscErrorCode KnowState(petsam_contact *c)
{
  SamContactState state;
  SamStep        *step = &c->committed;
  PetscReal       depth[2];

  PetscFunctionBegin;
  PetscCall(SamContactGetState(c->setup.contact, &state));
  *step              = (SamStep){.control = state.now.control};
  step->check        = (SamCheck){.normal = NAN, .tangential = NAN, .equilibrium = NAN, .cone = NAN, .edge = NAN};
  step->contact_area = step->stick_area = step->dissipated_energy = step->stored_energy = step->edge_accepted = NAN;
  step->pressure_max = step->shear_max = NAN;
  step->plastic_area = step->plastic_depth_max = step->plastic_energy = NAN;
  PetscCall(PetscArraycpy(step->load, state.now.load, SAM_COMPONENTS));
  PetscCall(PetscArraycpy(step->rigid, state.now.rigid, SAM_COMPONENTS));
  if (c->wear) PetscCall(SamWearGetVolumes(c->wear, step->wear_volume, depth));
  c->has_committed = state.steps > 0;
  PetscCall(SamEmbedForget(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Load(petsam_contact *c, const char file[])
{
  SamParameters parameters;

  PetscFunctionBegin;
  PetscCall(CollectParameters(c, &parameters));
  PetscCall(SamCheckpointRead(file, c->setup.contact, c->wear, &parameters, 0, NULL));
  PetscCall(KnowState(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int petsam_load(petsam_contact *c, const char *file)
{
  if (!c) return SAM_EMBED_USAGE;
  if (!file) return SamEmbedRefuse(c, "petsam_load: a pointer is NULL");
  if (!SamEmbedEnter(c)) return SAM_EMBED_USAGE;
  return LeaveFile(c, Load(c, file));
}
