/* The motions of bodies: their registry, and steps in time, in which the bodies rest on each other or roll. */
#include <math.h>
#include <petsam/private/motionimpl.h>
#include <string.h>

static PetscErrorCode Check(SamElasticity e, SamConditions conditions, const SamControl *control, PetscReal rolled,
                            const char where[])
{
  PetscFunctionBegin;
  (void)conditions;
  PetscCheck(rolled == 0 || !e->traits.patch, e->grid->comm, SAM_ERR_USER,
             "%sroll = %.6g: expected 0: bodies with a compliance of their own have a place", where, (double)rolled);
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    PetscCheck(!control->creep[k] || control->value[k] == 0 || rolled != 0, e->grid->comm, SAM_ERR_USER,
               "%s%s = %.6g: a creepage needs a rolled distance: give roll or roll_y, or -rolling steady", where,
               SamComponentNames[k].creep, (double)control->value[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const struct _n_SamMotion SamMotionInTime = {.word      = "none",
                                             .continues = PETSC_TRUE,
                                             .way       = SAM_BY_RIGID,
                                             .work      = "dissipated_energy",
                                             .work_unit = "J",
                                             .slip_unit = " m",
                                             .remedy    = "use smaller load steps",
                                             .check     = Check};

/* The first motion is the default. */
static SamMotion motions[SAM_MOTIONS] = {&SamMotionInTime, &SamMotionSteady};
static PetscInt  count                = 2;

PetscErrorCode SamMotionRegister(SamMotion motion)
{
  PetscInt k = 0;

  PetscFunctionBegin;
  while (k < count && strcmp(motions[k]->word, motion->word)) k++;
  PetscCheck(k < SAM_MOTIONS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "More than %d motions: %s", SAM_MOTIONS,
             motion->word);
  motions[k] = motion;
  count      = PetscMax(count, k + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamMotion SamMotionOf(SamElasticity elasticity)
{
  return elasticity->motion ? elasticity->motion : motions[0];
}

PetscErrorCode SamMotionSet(SamMotion motion, const SamOptions *from, SamElasticity *elasticity)
{
  SamElasticity bodies = *elasticity;

  PetscFunctionBegin;
  if (motion->wrap) {
    PetscCall(motion->wrap(bodies, from, elasticity));
    PetscCall(SamElasticityDestroy(&bodies));
  }
  (*elasticity)->motion = motion;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamMotionSetFromOptions(const SamOptions *from, SamElasticity *elasticity)
{
  char               list[128] = "";
  const SamOptionRow row = {"rolling", "steady: the contact rolls towards +x in steady state; or none", SAM_OPTION_ENUM,
                            .words = list};
  const char        *words[SAM_MOTIONS];
  int                k = 0;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < count; n++) words[n] = motions[n]->word;
  SamJoin((int)count, words, ",", ",", list, sizeof(list));
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &k, NULL));
  PetscCall(SamMotionSet(motions[k], from, elasticity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamMotionRefuse(SamMotion motion, SamMotionSubject subject, MPI_Comm comm, const char prefix[],
                               const char name[])
{
  PetscFunctionBegin;
  PetscCheck(!motion->meaningless[subject], comm, SAM_ERR_USER, "%s%s: has no meaning with -rolling %s, %s: omit it",
             prefix, name, motion->word, motion->meaningless[subject]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamMotionName *SamMotionFindName(SamMotion motion, const char usual[])
{
  for (const SamMotionName *n = motion->names; n && n->usual; n++)
    if (!strcmp(n->usual, usual)) return n;
  return NULL;
}

PetscErrorCode SamMotionDeclareNumber(SamMotion motion, SamState state, const SamStateNumber *number, PetscInt *id)
{
  const SamMotionName *name     = SamMotionFindName(motion, number->name);
  SamStateNumber       declared = *number;

  PetscFunctionBegin;
  if (name) {
    declared.name = name->name;
    declared.unit = name->unit;
    declared.text = name->text;
    declared.join = SAM_JOIN_LAST;
    if (number->join == SAM_JOIN_SUM && strcmp(name->name, motion->work)) declared.order = 0; /* another number is it */
  }
  PetscCall(SamStateDeclareNumber(state, &declared, id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamMotionName SamMotionRigidName(SamMotion motion, SamComponent component)
{
  const SamComponentName *c = &SamComponentNames[component];

  if (c->creep && motion->way == SAM_BY_CREEP) return (SamMotionName){c->rigid, c->creep, c->creep_unit, c->creep_text};
  return (SamMotionName){c->rigid, c->rigid, c->rigid_unit, c->rigid_text};
}

PetscErrorCode SamMotionCheck(SamElasticity e, SamConditions conditions, const SamControl *control, const char where[])
{
  PetscReal       roll[2];
  const PetscReal rolled = SamMotionRolled(conditions, control, roll);

  PetscFunctionBegin;
  PetscCheck(isfinite(rolled), e->grid->comm, SAM_ERR_USER, "roll is not a finite number");
  for (PetscInt k = 0; k < 2; k++)
    PetscCheck(fabs(roll[k]) <= e->grid->width[k], e->grid->comm, SAM_ERR_USER,
               "%s%s = %.6g: expected at most the width of the grid, %.6g m, in a step: use more steps", where,
               k ? "roll_y" : "roll", (double)roll[k], (double)e->grid->width[k]);
  PetscCall(SamMotionOf(e)->check(e, conditions, control, rolled, where));
  PetscFunctionReturn(PETSC_SUCCESS);
}
