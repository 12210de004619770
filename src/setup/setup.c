/* A contact and all that it is made of, from options: what the programs and embedded contacts share. */
#include <petsam/private/baseimpl.h>
#include <petsam/checkpoint.h>
#include <petsam/setup.h>
#include <math.h>

/* Options of files that the gap may come from. */
static const char *const files[] = {"-gap_file", "-gap_rough_file"};

PetscErrorCode SamSetupReadOptions(SamSetup *s, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamGridCreateFromOptions(from, &s->grid));
  PetscCall(SamPairSetFromOptions(&s->pair, from));
  PetscCall(SamElasticityCreate(s->grid, &s->pair, &s->elasticity));
  PetscCall(SamElasticitySetOptionsPrefix(s->elasticity, from->prefix));
  PetscCall(SamElasticitySetFromOptions(s->elasticity));
  PetscCall(SamProblemCreate(s->elasticity, &s->problem));
  PetscCall(SamProblemSetFrictionFromOptions(s->problem, from));
  PetscCall(SamProblemSetPressureLimitFromOptions(s->problem, from));
  PetscCall(SamGapCreate(from->comm, &s->gap));
  PetscCall(SamGapSetOptionsPrefix(s->gap, from->prefix));
  PetscCall(SamGapSetFromOptions(s->gap));
  for (PetscInt k = 0; k < 2; k++) PetscCall(PetscOptionsHasName(NULL, from->prefix, files[k], &s->from_file[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupCreateContact(SamSetup *s, const SamOptions *from)
{
  SamElasticityTraits traits;
  SamContactEdges     edges;
  PetscBool           help, friction, coupling, limits;
  PetscReal           limit;
  SamNormal           normal;
  Vec                 gap;

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamProblemGetGap(s->problem, &gap));
  if (!help) PetscCall(SamGapFill(s->gap, s->grid, gap));
  PetscCall(SamContactCreate(s->problem, &s->contact));
  PetscCall(SamContactSetOptionsPrefix(s->contact, from->prefix));
  PetscCall(SamContactSetFromOptions(s->contact));
  PetscCall(SamContactGetEdges(s->contact, &edges));
  PetscCall(SamProblemHasFriction(s->problem, &friction));
  PetscCall(SamElasticityGetTraits(s->elasticity, &traits));
  PetscCall(SamContactGetCoupling(s->contact, &coupling));
  PetscCheck(!friction || !traits.coupled || !coupling || edges != SAM_CONTACT_EDGES_DEFERRED || help, from->comm,
             SAM_ERR_USER,
             "-edges deferred with friction and dissimilar bodies, whose pressure and shear act on each other: "
             "expected reconstruct or none, or -friction 0, or -coupling none");
  PetscCall(SamProblemGetPressureLimit(s->problem, &limit));
  PetscCheck(isinf(limit) || edges != SAM_CONTACT_EDGES_DEFERRED || help, from->comm, SAM_ERR_USER,
             "-edges deferred with -pressure_limit: where surfaces yield, the pressure does not end as the correction "
             "takes it to: expected reconstruct or none");
  PetscCall(SamContactGetNormal(s->contact, &normal));
  PetscCall(SamNormalLimitsPressure(normal, &limits));
  PetscCheck(isinf(limit) || limits || help, from->comm, SAM_ERR_USER,
             "-pressure_limit: the method of -normal_type has no upper bound of the pressure: expected %s",
             SAM_NORMAL_ACTIVESET);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupDestroy(SamSetup *s)
{
  PetscFunctionBegin;
  PetscCall(SamContactDestroy(&s->contact));
  PetscCall(SamProblemDestroy(&s->problem));
  PetscCall(SamElasticityDestroy(&s->elasticity));
  PetscCall(SamGapDestroy(&s->gap));
  PetscCall(SamGridDestroy(&s->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- parameters ---- */

PetscErrorCode SamParametersAddChecksum(SamParameters *p, const char name[], uint64_t checksum)
{
  char text[64];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(text, sizeof(text), "of checksum %08lx%08lx", (unsigned long)(checksum >> 32),
                          (unsigned long)(checksum & 0xffffffff)));
  PetscCall(SamParametersAddText(p, name, PETSC_TRUE, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What comes from a file is identified by its checksum, since a file may change and keep its name. */
static PetscErrorCode AddField(const SamSetup *s, SamParameters *p, const char name[], Vec field)
{
  uint64_t checksum;

  PetscFunctionBegin;
  PetscCall(SamCheckpointChecksum(s->grid, field, &checksum));
  PetscCall(SamParametersAddChecksum(p, name, checksum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddGrid(SamParameters *p, SamGrid grid)
{
  const PetscReal n[2] = {(PetscReal)grid->nx, (PetscReal)grid->ny};

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "grid_n", PETSC_TRUE, 2, n));
  PetscCall(SamParametersAddReals(p, "grid_size", PETSC_TRUE, 2, grid->width));
  PetscCall(SamParametersAddReals(p, "grid_center", PETSC_TRUE, 2, grid->center));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddPair(SamParameters *p, const SamPair *pair)
{
  PetscFunctionBegin;
  for (PetscInt body = 0; body < 2; body++) {
    char name[32];

    PetscCall(PetscSNPrintf(name, sizeof(name), "body%d_young", (int)body + 1));
    PetscCall(SamParametersAddReals(p, name, PETSC_TRUE, 1, &pair->young[body]));
    PetscCall(PetscSNPrintf(name, sizeof(name), "body%d_poisson", (int)body + 1));
    PetscCall(SamParametersAddReals(p, name, PETSC_TRUE, 1, &pair->poisson[body]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The coefficient of friction; a field is identified by its checksum. */
static PetscErrorCode AddFriction(const SamSetup *s, SamParameters *p)
{
  PetscReal friction;
  Vec       field;

  PetscFunctionBegin;
  PetscCall(SamProblemGetFriction(s->problem, &friction, &field));
  if (!field)
    PetscCall(SamParametersAddReals(p, "friction", PETSC_TRUE, 1, &friction));
  else
    PetscCall(AddField(s, p, "friction_file", field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddGap(const SamSetup *s, SamParameters *p)
{
  SamGapType         type;
  PetscInt           count;
  const char *const *names;
  const PetscReal   *values;
  Vec                separation;

  PetscFunctionBegin;
  PetscCall(SamGapGetParameters(s->gap, &type, &count, &names, &values));
  PetscCall(SamParametersAddText(p, "gap_type", PETSC_TRUE, type));
  for (PetscInt k = 0; k < count; k++) PetscCall(SamParametersAddReals(p, names[k], PETSC_TRUE, 1, &values[k]));
  PetscCall(SamProblemGetGap(s->problem, &separation));
  for (PetscInt k = 0; k < 2; k++)
    if (s->from_file[k])
      PetscCall(AddField(s, p, files[k] + 1, separation));
    else
      PetscCall(SamParametersAddText(p, files[k] + 1, PETSC_TRUE, "none"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSetupAddParameters(const SamSetup *s, SamParameters *p)
{
  SamElasticityType type;
  PetscBool         full;
  PetscReal         limit;

  PetscFunctionBegin;
  PetscCall(AddGrid(p, s->grid));
  PetscCall(AddPair(p, &s->pair));
  PetscCall(SamElasticityGetType(s->elasticity, &type));
  PetscCall(SamParametersAddText(p, "elasticity", PETSC_TRUE, type));
  PetscCall(AddFriction(s, p));
  PetscCall(SamProblemGetPressureLimit(s->problem, &limit));
  PetscCall(SamParametersAddReals(p, "pressure_limit", PETSC_TRUE, 1, &limit));
  PetscCall(AddGap(s, p));
  PetscCall(SamContactGetCoupling(s->contact, &full));
  PetscCall(SamParametersAddText(p, "coupling", PETSC_TRUE, full ? "full" : "none"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
