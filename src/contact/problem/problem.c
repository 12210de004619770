/* The problem of a contact: elasticity, gap and laws, and what follows from all laws together. */
#include <petsam/private/elasticity.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/balance.h>
#include <petsam/private/control.h>
#include <petsam/private/problemimpl.h>
#include <petsam/private/law.h>
#include <petsam/private/problem.h>
#include <petsc/private/petscimpl.h> /* PetscObjectStateGet() */

struct _n_SamProblem {
  SamClassId    class_id;
  PetscInt      references;
  SamElasticity elasticity;
  SamGrid       grid; /* of the elasticity; borrowed */
  Vec           gap;  /* its revision is PETSc's object state, which grows with every change */
  PetscBool     quadratic;

  PetscObjectState quadratic_at; /* object state of the gap at that time */
  SamConditions    conditions;
  PetscInt         laws;
  SamLaw           law[SAM_LAWS]; /* in the order in which their types were registered */
};

/* ---- creation ---- */

/* Adds the laws that every problem with these bodies has. */
static PetscErrorCode AddUsualLaws(SamProblem p)
{
  const SamLawType *types;
  PetscInt          count;
  SamLaw            law;

  PetscFunctionBegin;
  PetscCall(SamLawGetTypes(&count, &types));
  for (PetscInt k = 0; k < count; k++) {
    PetscCall(SamLawCreate(p->elasticity, types[k], &law));
    if (law->always) PetscCall(SamProblemAddLaw(p, law));
    PetscCall(SamLawDestroy(&law));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemCreate(SamElasticity elasticity, SamProblem *problem)
{
  SamProblem p;

  PetscFunctionBegin;
  SamValidHandle(elasticity, SamElasticity, 1);
  SamValidPointer(problem, 2);
  PetscCall(PetscNew(&p));
  p->class_id   = SamProblem_CLASSID;
  p->references = 1;
  PetscCall(SamElasticityReference(elasticity));
  p->elasticity = elasticity;
  p->grid       = SamElasticityGetGrid(elasticity);
  PetscCall(SamGridCreateVec(p->grid, 1, &p->gap));
  PetscCall(SamConditionsCreate(&p->conditions));
  PetscCall(SamProblemAddLawOfType(p, SAM_LAW_COULOMB, NULL));
  PetscCall(AddUsualLaws(p));
  PetscCall(SamMotionAddConditions(p->conditions));
  *problem = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemReference(SamProblem p)
{
  PetscFunctionBegin;
  p->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemDestroy(SamProblem *problem)
{
  SamProblem p;

  PetscFunctionBegin;
  SamValidPointer(problem, 1);
  if (!*problem) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*problem, SamProblem, 1);
  p        = *problem;
  *problem = NULL;
  if (--p->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < p->laws; k++) PetscCall(SamLawDestroy(&p->law[k]));
  PetscCall(SamConditionsDestroy(&p->conditions));
  PetscCall(VecDestroy(&p->gap));
  PetscCall(SamElasticityDestroy(&p->elasticity));
  p->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamElasticity SamProblemGetElasticity(SamProblem p)
{
  return p->elasticity;
}

SamGrid SamProblemGetGrid(SamProblem p)
{
  return p->grid;
}

SamConditions SamProblemGetConditions(SamProblem p)
{
  return p->conditions;
}

PetscReal SamProblemGetRolled(SamProblem p, const SamControl *control, PetscReal distance[2])
{
  return SamMotionRolled(p->conditions, control, distance);
}

/* ---- the gap ---- */

PetscErrorCode SamProblemSetGap(SamProblem p, Vec h)
{
  PetscFunctionBegin;
  SamValidHandle(p, SamProblem, 1);
  SamValidVec(h, 2);
  SamValidVecOn(p->grid->comm, 1, h, 2);
  PetscCall(SamGridCheckVec(p->grid, 1, h, "The gap"));
  PetscCall(VecCopy(h, p->gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

Vec SamProblemGetGap(SamProblem p)
{
  return p->gap;
}

PetscErrorCode SamProblemSetQuadratic(SamProblem p, PetscBool quadratic)
{
  PetscFunctionBegin;
  p->quadratic = quadratic;
  PetscCall(PetscObjectStateGet((PetscObject)p->gap, &p->quadratic_at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemIsQuadratic(SamProblem p, PetscBool *quadratic)
{
  PetscObjectState now;
  double           changed;

  PetscFunctionBegin;
  PetscCall(PetscObjectStateGet((PetscObject)p->gap, &now));
  changed = now != p->quadratic_at; /* may be true on some ranks only */
  if (p->quadratic) PetscCall(SamMax(p->grid->comm, 1, &changed));
  *quadratic = p->quadratic && changed == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemGetRevision(SamProblem p, PetscObjectState *revision)
{
  PetscFunctionBegin;
  PetscCall(PetscObjectStateGet((PetscObject)p->gap, revision));
  for (PetscInt k = 0; k < p->laws; k++) *revision += p->law[k]->revision;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- laws ---- */

PetscErrorCode SamProblemAddLaw(SamProblem p, SamLaw law)
{
  PetscInt k;

  PetscFunctionBegin;
  SamValidHandle(p, SamProblem, 1);
  SamValidHandle(law, SamLaw, 2);
  SamValidSameComm(p->grid->comm, 1, law->grid->comm, 2);
  PetscCheck(!SamProblemGetLaw(p, law->type), p->grid->comm, PETSC_ERR_ARG_WRONG, "The problem has a law %s already",
             law->type);
  PetscCall(SamLawReference(law));
  PetscCall(SamLawAddConditions(law, p->conditions));
  if (law->ops.attract) SamConditionsAllowPull(p->conditions);
  for (k = p->laws++; k > 0 && SamLawOrder(p->law[k - 1]->type) > SamLawOrder(law->type); k--)
    p->law[k] = p->law[k - 1];
  p->law[k] = law;
  PetscCall(PetscObjectStateIncrease((PetscObject)p->gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemAddLawOfType(SamProblem p, SamLawType type, SamLaw *law)
{
  SamLaw found, made;

  PetscFunctionBegin;
  SamValidHandle(p, SamProblem, 1);
  SamValidPointer(type, 2);
  found = SamProblemGetLaw(p, type);
  if (!found) {
    PetscCall(SamLawCreate(p->elasticity, type, &made));
    PetscCall(SamProblemAddLaw(p, made));
    found = made;
    PetscCall(SamLawDestroy(&made));
  }
  if (law) *law = found;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemAddSum(SamProblem p, SamLawType type)
{
  SamLaw    law;
  PetscBool accumulates;

  PetscFunctionBegin;
  PetscCall(SamLawCreate(p->elasticity, type, &law));
  accumulates = law->accumulates;
  PetscCall(SamLawDestroy(&law));
  if (accumulates) PetscCall(SamProblemAddLawOfType(p, type, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamLaw SamProblemGetLaw(SamProblem p, SamLawType type)
{
  for (PetscInt k = 0; k < p->laws; k++)
    if (!strcmp(p->law[k]->type, type)) return p->law[k];
  return NULL;
}

PetscErrorCode SamProblemGetLaws(SamProblem p, PetscInt *count, const SamLaw **laws)
{
  PetscFunctionBegin;
  *count = p->laws;
  *laws  = p->law;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemSetLawsFromOptions(SamProblem p, const SamOptions *from)
{
  const SamLawType *types;
  PetscInt          count;

  PetscFunctionBegin;
  PetscCall(SamLawGetTypes(&count, &types));
  for (PetscInt k = 0; k < count; k++) {
    PetscErrorCode ierr;
    PetscBool      asked = PETSC_FALSE;
    SamLaw         known, law;

    known = SamProblemGetLaw(p, types[k]);
    if (known) {
      PetscCall(SamLawSetFromOptions(known, from, &asked));
      continue;
    }
    PetscCall(SamLawCreate(p->elasticity, types[k], &law));
    ierr = SamLawSetFromOptions(law, from, &asked);
    if (!ierr && asked) PetscCall(SamProblemAddLaw(p, law));
    PetscCall(SamLawDestroy(&law));
    PetscCall(ierr);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt SamProblemGetBytes(SamProblem p)
{
  PetscInt bytes = 0;

  for (PetscInt k = 0; k < p->laws; k++) bytes += p->law[k]->bytes;
  return bytes;
}

/* True if a law has this flag, at its place in the struct. */
static PetscBool AnyLaw(SamProblem p, size_t flag)
{
  for (PetscInt k = 0; k < p->laws; k++)
    if (*(const PetscBool *)(const void *)((const char *)p->law[k] + flag)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool SamProblemSlides(SamProblem p)
{
  return AnyLaw(p, offsetof(struct _n_SamLaw, slides));
}

PetscBool SamProblemRemembers(SamProblem p)
{
  return AnyLaw(p, offsetof(struct _n_SamLaw, remembers));
}

PetscBool SamProblemWears(SamProblem p)
{
  return AnyLaw(p, offsetof(struct _n_SamLaw, wears));
}

PetscReal SamProblemWornVolume(SamState state)
{
  static const char *const names[] = {"wear_volume1", "wear_volume2"};
  PetscReal                volume  = 0;

  for (int b = 0; b < 2; b++) {
    const PetscInt id = SamStateFindNumber(state, names[b]);

    if (id >= 0) volume += *SamStateReadNumbers(state, id);
  }
  return volume;
}

PetscBool SamProblemBodyYields(SamProblem p, PetscInt body)
{
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.yields && p->law[k]->ops.yields(p->law[k], body)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool SamProblemYields(SamProblem p)
{
  return SamProblemBodyYields(p, 0) || SamProblemBodyYields(p, 1) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamProblemGetFlow(SamProblem p, PetscReal strain, PetscReal *stress)
{
  PetscReal one;

  PetscFunctionBegin;
  *stress = PETSC_INFINITY;
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.flow) {
      PetscCall(p->law[k]->ops.flow(p->law[k], strain, &one));
      *stress = PetscMin(*stress, one);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamProblemHasYielded(SamProblem p, SamState state)
{
  for (PetscInt k = 0; k < p->laws; k++) {
    const PetscInt id = p->law[k]->strained ? SamStateFindNumber(state, p->law[k]->strained) : -1;

    if (id >= 0 && *SamStateReadNumbers(state, id) > 0) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool SamProblemMoves(SamProblem p)
{
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.separation) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* ---- what displaces the surfaces besides the tractions ---- */

PetscErrorCode SamProblemCheckControl(SamProblem p, SamControl *control, PetscInt *wrong, char why[], size_t size)
{
  PetscFunctionBegin;
  why[0] = '\0';
  for (PetscInt k = 0; k < p->laws && !why[0]; k++)
    if (p->law[k]->ops.check) PetscCall(p->law[k]->ops.check(p->law[k], control, wrong, why, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemBegin(SamProblem p, SamState state, const SamControl *control, PetscReal duration)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.begin) PetscCall(p->law[k]->ops.begin(p->law[k], state, control, duration));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamProblemAttracts(SamProblem p)
{
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.attract) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SamProblemAttract(SamProblem p, Vec gap, Vec tension)
{
  PetscFunctionBegin;
  PetscCall(VecZeroEntries(tension));
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.attract) PetscCall(p->law[k]->ops.attract(p->law[k], gap, tension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamProblemDisplaces(SamProblem p)
{
  return AnyLaw(p, offsetof(struct _n_SamLaw, displaces));
}

PetscErrorCode SamProblemDisplace(SamProblem p, SamState state, const SamControl *control, Vec u_z, Vec u_t,
                                  SamStrain *strain, PetscBool *adds)
{
  PetscFunctionBegin;
  if (adds) *adds = PETSC_FALSE;
  if (strain) *strain = (SamStrain){0, 0, 0};
  for (PetscInt k = 0; k < p->laws; k++)
    if ((strain && p->law[k]->strains) || ((u_z || u_t || adds) && p->law[k]->displaces))
      PetscCall(p->law[k]->ops.displace(p->law[k], state, control, u_z, u_t, strain, adds));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- friction ---- */

PetscErrorCode SamProblemHasFriction(SamProblem p, PetscBool *has)
{
  PetscReal uniform;

  PetscFunctionBegin;
  *has = PETSC_FALSE;
  for (PetscInt k = 0; k < p->laws && !*has; k++)
    if (p->law[k]->ops.friction) PetscCall(p->law[k]->ops.friction(p->law[k], &uniform, has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemComputeBound(SamProblem p, const SamBoundAt *given, const SamBound *bound)
{
  SamBoundAt at    = *given;
  PetscInt   count = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->laws; k++) count += p->law[k]->ops.bound != NULL;
  if (count > 1 && at.pressure == bound->value) { /* the first law overwrites this pressure */
    PetscCall(SamGridCreateVec(p->grid, 1, &at.pressure));
    PetscCall(VecCopy(given->pressure, at.pressure));
  }
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.bound) PetscCall(p->law[k]->ops.bound(p->law[k], &at, bound));
  if (at.pressure != given->pressure) PetscCall(VecDestroy(&at.pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamProblemFollowsSlip(SamProblem p)
{
  return AnyLaw(p, offsetof(struct _n_SamLaw, follows_slip));
}

/* ---- all else ---- */

PetscErrorCode SamProblemGetPressureLimit(SamProblem p, PetscReal *limit)
{
  PetscFunctionBegin;
  *limit = INFINITY; /* PETSC_INFINITY is a finite number */
  for (PetscInt k = 0; k < p->laws; k++) {
    PetscReal most = INFINITY;

    if (p->law[k]->ops.limit) PetscCall(p->law[k]->ops.limit(p->law[k], &most));
    *limit = PetscMin(*limit, most);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemDeclare(SamProblem p, SamState state)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.declare) PetscCall(p->law[k]->ops.declare(p->law[k], state));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamProblemAddSeparation(SamProblem p, SamState state, SamGeneration generation, Vec h, PetscBool *adds)
{
  PetscBool any = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->laws && state; k++)
    if (p->law[k]->ops.separation) PetscCall(p->law[k]->ops.separation(p->law[k], state, generation, h, &any));
  if (adds) *adds = any;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamProblemGetOffset(SamProblem p, SamState state, SamGeneration generation, PetscInt body,
                              PetscReal offset[2])
{
  PetscBool depends = PETSC_FALSE;

  for (PetscInt k = 0; k < p->laws; k++) depends = depends || p->law[k]->of_body[body];
  if (depends && SamFramesGetOffset(state, generation, body, offset)) return PETSC_TRUE;
  offset[0] = offset[1] = 0;
  return PETSC_FALSE;
}

PetscErrorCode SamProblemAdvance(SamProblem p, SamLawStep *step)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->laws; k++)
    if (p->law[k]->ops.advance) PetscCall(p->law[k]->ops.advance(p->law[k], step));
  PetscFunctionReturn(PETSC_SUCCESS);
}
