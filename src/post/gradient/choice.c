/*
  The parameters by which a number is differentiated: their names, which of them are wanted, and those of the shape.

  The derivative by a parameter s of the shape is the sum over the cells of that by the gap h times dh/ds
  (SamGapGetSlope()).
*/
#include "gradientimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/gap.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <math.h>

static const char *const fields[] = {"gap", "friction"};
static const char *const moduli[] = {"body1_young", "body1_poisson", "body2_young", "body2_poisson"};
enum { FIELDS = 2 };

/* ---- names ---- */

const char *SamGradientOfSteps(PetscInt k, const char **unit)
{
  const PetscInt  c = k % SAM_COMPONENTS, bulk = k - 2 * SAM_COMPONENTS;
  const PetscBool load = k < SAM_COMPONENTS ? PETSC_TRUE : PETSC_FALSE;

  if (unit) *unit = bulk >= 0 ? "Pa" : load ? SamComponentNames[c].load_unit : SamComponentNames[c].rigid_unit;
  if (bulk >= 0) return bulk < SAM_GRADIENT_BULKS ? SamBulkName(bulk) : NULL;
  return load ? SamComponentNames[c].load : SamComponentNames[c].rigid;
}

PetscBool SamGradientIsOfSteps(const char name[])
{
  const char *one;

  for (PetscInt k = 0; (one = SamGradientOfSteps(k, NULL)); k++)
    if (!strcmp(name, one)) return PETSC_TRUE;
  return PETSC_FALSE;
}

const char *SamGradientNumber(SamGradient g, PetscInt k)
{
  const char *const *names;
  PetscInt           count;

  if (k < g->laws) return g->law[k]->number;
  k -= g->laws;
  if (k < SAM_GRADIENT_MODULI) return moduli[k];
  (void)SamGapGetParameters(g->shape, NULL, &count, &names, NULL);
  return k - SAM_GRADIENT_MODULI < count ? names[k - SAM_GRADIENT_MODULI] : NULL;
}

PetscBool SamGradientHas(SamGradient g, const char name[])
{
  return SamChoiceHas(g, g->found.of, name);
}

/* Returns the name of the k-th of all parameters; NULL after the last one. */
static const char *Name(SamGradient g, PetscInt k)
{
  enum { STEPS = 2 * SAM_COMPONENTS + SAM_GRADIENT_BULKS };

  if (k < FIELDS) return fields[k];
  return k < FIELDS + STEPS ? SamGradientOfSteps(k - FIELDS, NULL) : SamGradientNumber(g, k - FIELDS - STEPS);
}

/* Returns the place of a name among others that are separated by commas; NULL: it is not one of them. */
static const char *Find(const char names[], const char name[], size_t length)
{
  for (const char *at = names; *at; at += strcspn(at, ",") + (at[strcspn(at, ",")] ? 1 : 0))
    if (strcspn(at, ",") == length && !strncmp(at, name, length)) return at;
  return NULL;
}

/* True if one of the laws acts. */
static PetscBool LawsAct(SamGradient g)
{
  for (PetscInt k = 0; k < g->laws; k++)
    if (g->law[k]->ops.number(g->law[k]) != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool SamChoiceHas(SamGradient g, const char of[], const char name[])
{
  PetscBool costs = !strncmp(name, "body", 4) || !strncmp(name, "gap_", 4);

  for (PetscInt k = 0; k < g->laws; k++)
    if (!strcmp(name, g->law[k]->number) && !LawsAct(g)) costs = PETSC_TRUE;
  if (!of[0]) return !costs || SamGradientIsOfSteps(name) ? PETSC_TRUE : PETSC_FALSE;
  return Find(of, name, strlen(name)) ? PETSC_TRUE : PETSC_FALSE;
}

/* True if one of some numbers, from the first to before the last, is wanted. */
static PetscBool HaveOne(SamGradient g, const char of[], PetscInt first, PetscInt last)
{
  const char *name;

  for (PetscInt k = first; k < last && (name = SamGradientNumber(g, k)); k++)
    if (SamChoiceHas(g, of, name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool SamChoiceHasModuli(SamGradient g, const char of[])
{
  return HaveOne(g, of, g->laws, g->laws + SAM_GRADIENT_MODULI);
}

PetscBool SamChoiceAllowsSharing(SamGradient g)
{
  const char *const of = g->found.of;

  /* the moduli meet the shear of each step; a law that does not act would act in each of them */
  return !SamChoiceHasModuli(g, of) && (LawsAct(g) || !HaveOne(g, of, 0, g->laws)) ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool SamChoiceHasShape(SamGradient g, const char of[])
{
  const PetscInt first = g->laws + SAM_GRADIENT_MODULI;

  return HaveOne(g, of, first, first + SAM_GAP_PARAMETERS);
}

PetscErrorCode SamChoiceCheck(SamGradient g, const char of[])
{
  const MPI_Comm comm       = SamContactGetGrid(g->contact)->comm;
  char           list[1024] = "";
  const char    *name;
  size_t         used = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; (name = Name(g, k)); k++) {
    used += (size_t)snprintf(list + used, sizeof(list) - used, "%s%s", k ? "," : "", name);
    used = PetscMin(used, sizeof(list) - 1);
  }
  PetscCheck(strlen(of) < sizeof(g->found.of), comm, SAM_ERR_USER,
             "the gradient by %.40s...: expected at most %d characters", of, (int)sizeof(g->found.of) - 1);
  for (const char *at = of; *at; at += strcspn(at, ",") + (at[strcspn(at, ",")] ? 1 : 0)) {
    const size_t length = strcspn(at, ",");

    PetscCheck(Find(list, at, length), comm, SAM_ERR_USER, "the gradient by %.*s: expected %s", (int)length, at, list);
    PetscCheck(Find(of, at, length) == at, comm, SAM_ERR_USER, "the gradient by %.*s: it is listed twice", (int)length,
               at);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- values ---- */

/* A parameter with one number: its kind, and its place among those of the kind */
typedef enum { LAW, MODULUS, SHAPE } Kind;

/* Finds it, and returns the derivative by it; NULL: it was not wanted, or there is none of that name. */
static const PetscReal *FindNumber(SamGradient g, const char name[], Kind *kind, PetscInt *place)
{
  const SamDerivatives  *d    = &g->found;
  const PetscReal *const by[] = {[LAW] = d->law, [MODULUS] = d->moduli, [SHAPE] = d->shape};
  const char            *one;

  if (!SamGradientHas(g, name)) return NULL;
  for (PetscInt k = 0; (one = SamGradientNumber(g, k)); k++) {
    if (strcmp(name, one)) continue;
    *kind  = k < g->laws ? LAW : k < g->laws + SAM_GRADIENT_MODULI ? MODULUS : SHAPE;
    *place = k - (*kind == LAW ? 0 : *kind == MODULUS ? g->laws : g->laws + SAM_GRADIENT_MODULI);
    return &by[*kind][*place];
  }
  return NULL;
}

const PetscReal *SamChoiceFind(SamGradient g, const char name[])
{
  Kind     kind;
  PetscInt place;

  return FindNumber(g, name, &kind, &place);
}

PetscErrorCode SamChoiceGetShare(SamGradient g, const char name[], PetscReal *share)
{
  SamPairConstants constants;
  PetscReal        of_law[SAM_LAWS] = {0};
  const PetscReal *values[]         = {[LAW] = of_law, [MODULUS] = constants.modulus, [SHAPE] = NULL}, *by;
  Kind             kind;
  PetscInt         place;

  PetscFunctionBegin;
  (void)SamPairGetConstants(SamElasticityGetPair(SamProblemGetElasticity(SamContactGetProblem(g->contact))),
                            &constants);
  PetscCall(SamGapGetParameters(g->shape, NULL, NULL, NULL, &values[SHAPE]));
  for (PetscInt k = 0; k < g->laws; k++) of_law[k] = g->law[k]->ops.number(g->law[k]);
  *share = 0;
  by     = FindNumber(g, name, &kind, &place);
  if (by && isfinite(values[kind][place])) *share = values[kind][place] * *by;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the shape ---- */

/* Checks that the gap is that of the shape. */
static PetscErrorCode CheckShape(SamGradient g)
{
  const SamGrid grid = SamContactGetGrid(g->contact);
  PetscReal     change;
  Vec           h;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &h));
  PetscCall(SamGapFill(g->shape, grid, h));
  PetscCall(VecAXPY(h, -1, SamProblemGetGap(SamContactGetProblem(g->contact))));
  PetscCall(VecNorm(h, NORM_INFINITY, &change));
  PetscCall(VecDestroy(&h));
  PetscCheck(change == 0, grid->comm, SAM_ERR_USER,
             "the gradient by parameters of the shape: the gap has been given cell by cell: take the gradient by gap");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamChoiceAddShape(SamGradient g)
{
  const SamGrid grid                      = SamContactGetGrid(g->contact);
  SamTotal      total[SAM_GAP_PARAMETERS] = {{0}};
  double        sums[SAM_GAP_PARAMETERS];
  const double *by;
  PetscInt      count;

  PetscFunctionBegin;
  PetscCall(CheckShape(g));
  PetscCall(SamGapGetParameters(g->shape, NULL, &count, NULL, NULL));
  PetscCall(VecGetArrayRead(g->found.gap, &by));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row[SAM_GAP_PARAMETERS] = {0};

    for (PetscInt i = 0; i < grid->nx; i++) {
      const double one = by[j * grid->nx + i];

      for (PetscInt k = 0; k < count && one != 0; k++)
        row[k] += one * (double)SamGapGetSlope(g->shape, k, SamGridX(grid, i), SamGridY(grid, grid->row_start + j));
    }
    SamAddAll(count, total, row);
  }
  PetscCall(VecRestoreArrayRead(g->found.gap, &by));
  PetscCall(SamSumTotals(grid->comm, count, total, sums));
  for (PetscInt k = 0; k < count; k++) g->found.shape[k] = sums[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}
