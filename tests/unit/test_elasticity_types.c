/*
  Types of elasticity: choice by name and by options, types from outside the library, traits, parts that are kept.
*/
#include "fields.h"
#include "preconditioners.h"

#include <petsam/private/elasticityimpl.h>
#include <petsam/stress.h>

static SamElasticity NewElasticity(SamGrid grid)
{
  const SamPair pair = NewPair(210e9, 0.3, 70e9, 0.2);
  SamElasticity e;

  sam_call(SamElasticityCreate(grid, pair, &e));
  return e;
}

static void AssertType(SamElasticity e, const char expected[])
{
  SamElasticityType type;

  type = SamElasticityGetType(e);
  sam_assert(!strcmp(type, expected));
}

/* ---- a type of our own: a bed of springs, of a depth that coarse grids and parts have as well ---- */

typedef struct {
  double   depth;
  PetscInt setups;
} Springs;

static double Stiffness(SamElasticity e)
{
  return e->pair->modulus / ((const Springs *)e->data)->depth;
}

static PetscErrorCode SpringsApply(SamElasticity e, const double *const p[], double *const u[])
{
  for (PetscInt k = 0; k < e->grid->cells; k++) u[0][k] = p[0][k] / Stiffness(e);
  return 0;
}

static PetscErrorCode SpringsApplySingle(SamElasticity e, double factor, const float *const p[], float *const u[])
{
  for (PetscInt k = 0; k < e->grid->cells; k++) u[0][k] = (float)(factor * (double)p[0][k] / Stiffness(e));
  return 0;
}

static PetscErrorCode SpringsPrecondition(SamElasticity e, double factor, const float *const r[], float *const p[])
{
  for (PetscInt k = 0; k < e->grid->cells; k++) p[0][k] = (float)(factor * (double)r[0][k] * Stiffness(e));
  return 0;
}

static PetscErrorCode SpringsSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  *normal = *tangential = 1 / Stiffness(e);
  return 0;
}

static PetscErrorCode SpringsSetFromOptions(SamElasticity e, const SamOptions *from)
{
  PetscFunctionBegin;
  PetscCall(SamOptionsReal(from, "springs_depth", "depth of the bed", "m", SAM_RANGE_POSITIVE,
                           &((Springs *)e->data)->depth, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpringsInherit(SamElasticity parent, SamElasticity child)
{
  ((Springs *)child->data)->depth = ((const Springs *)parent->data)->depth;
  return 0;
}

static PetscErrorCode SpringsAddParameters(SamElasticity e, SamParameters *p)
{
  const PetscReal depth = ((const Springs *)e->data)->depth;

  PetscFunctionBegin;
  PetscCall(SamParametersAddReals(p, "springs_depth", PETSC_TRUE, 1, &depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpringsSetParameters(SamElasticity e, const SamParameters *p, const char source[])
{
  const SamParameter *depth = SamParametersFind(p, "springs_depth");

  PetscFunctionBegin;
  PetscCheck(depth, e->grid->comm, SAM_ERR_FILE, "%s: it lacks springs_depth", source);
  ((Springs *)e->data)->depth = depth->value[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpringsSetUp(SamElasticity e)
{
  ((Springs *)e->data)->setups++;
  return 0;
}

static PetscErrorCode SpringsDestroy(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(e->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateSprings(SamElasticity e)
{
  Springs *data;

  PetscFunctionBegin;
  PetscCall(PetscNew(&data));
  data->depth = 1e-3;
  e->data     = data;
  e->traits =
    (SamElasticityTraits){.rotations = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE}, .mean = PETSC_TRUE, .parts = PETSC_TRUE};
  e->ops = (SamElasticityOps){.setfromoptions     = SpringsSetFromOptions,
                              .inherit            = SpringsInherit,
                              .addparameters      = SpringsAddParameters,
                              .setparameters      = SpringsSetParameters,
                              .setup              = SpringsSetUp,
                              .destroy            = SpringsDestroy,
                              .applynormal        = SpringsApply,
                              .applynormalsingle  = SpringsApplySingle,
                              .preconditionnormal = SpringsPrecondition,
                              .getselfinfluence   = SpringsSelfInfluence};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double SelfInfluence(SamElasticity e)
{
  PetscReal self;

  sam_call(SamElasticityGetSelfInfluence(e, &self, NULL));
  return self;
}

static void test_a_type_from_outside_works(void **state)
{
  const PetscInt first[2] = {10, 12}, n[2] = {9, 8};
  SamGrid        grid = NewGrid(40, 36, 1, 1);
  SamElasticity  e    = NewElasticity(grid), coarse, part;
  SamTransfer    transfer;
  SamWindow      window;
  Vec            p = NewRandom(grid, 1, 1), u = Copy(p);
  char           types[128];

  (void)state;
  sam_call(SamElasticityRegister("springs", CreateSprings));
  sam_call(SamElasticityGetTypes(types, sizeof(types)));
  sam_assert(!strcmp(types, "halfspace, periodic, plane, plane_periodic or springs"));
  sam_call(SamElasticitySetOptionsPrefix(e, "lower_"));
  sam_call(PetscOptionsInsertString(NULL, "-lower_elasticity springs -lower_springs_depth 0.01"));
  sam_call(SamElasticitySetFromOptions(e));
  AssertType(e, "springs");
  sam_call(SamElasticityApplyNormal(e, p, u));
  sam_call(VecScale(u, e->pair->modulus / 0.01));
  sam_assert_close(Difference(u, p, NORM_INFINITY), 0, 1e-14);
  sam_call(PreconditionNormal(e, p, u));
  sam_call(VecScale(u, 0.01 / e->pair->modulus));
  sam_assert_close(Difference(u, p, NORM_INFINITY), 0, 1e-6);
  sam_call(SamElasticitySetUp(e));
  sam_assert(((const Springs *)e->data)->setups == 1);
  sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
  AssertType(coarse, "springs");
  sam_assert(SelfInfluence(coarse) == SelfInfluence(e));
  sam_call(SamElasticityChoosePart(e, first, n, PETSC_FALSE, &window, &part));
  AssertType(part, "springs");
  sam_assert(SelfInfluence(part) == SelfInfluence(e));
  sam_fails(SamElasticityApplyNormalToTangential(e, p, u), PETSC_ERR_SUP); /* it is not coupled */
  sam_call(PetscOptionsClearValue(NULL, "-lower_elasticity"));
  sam_call(PetscOptionsClearValue(NULL, "-lower_springs_depth"));
  sam_call(VecDestroy(&p));
  sam_call(VecDestroy(&u));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

/* ---- parameters ---- */

static void AssertUnknown(SamGrid grid, SamParameters p, int k, const char name[])
{
  SamElasticity none;

  (void)snprintf(p.list[k].name, sizeof(p.list[k].name), "%s", name);
  sam_fails(SamElasticityCreateFromParameters(grid, &p, "-input x.h5", &none), SAM_ERR_FILE);
}

/* The bodies that an elasticity has recorded are the same again on another grid; what makes none is refused. */
static void test_bodies_come_back_from_their_parameters(void **state)
{
  SamGrid       grid = NewGrid(16, 12, 1, 1), other = NewGrid(20, 18, 2, 1);
  SamElasticity e = NewElasticity(grid), same;
  SamParameters p = {.count = 0};
  SamPair       pair;

  (void)state;
  sam_call(SamElasticityRegister("springs", CreateSprings));
  sam_call(SamElasticitySetType(e, "springs"));
  ((Springs *)e->data)->depth = 0.25;
  sam_call(SamElasticityAddParameters(e, &p));
  sam_assert(p.count == 6);
  sam_call(SamElasticityCreateFromParameters(other, &p, "-input x.h5", &same));
  AssertType(same, "springs");
  pair = SamElasticityGetPair(same);
  for (int b = 0; b < 2; b++)
    sam_assert(!memcmp(pair->body[b]->material, e->pair->body[b]->material, sizeof(pair->body[b]->material)));
  sam_assert(SelfInfluence(same) == SelfInfluence(e));
  for (int k = 0; k < 5; k++) AssertUnknown(other, p, k, "other"); /* the constants, and the type */
  p.list[1].value[0] = 0.7;
  AssertUnknown(other, p, 1, "body1_poisson");
  p.list[1].value[0] = 0.3;
  (void)snprintf(p.list[4].text, sizeof(p.list[4].text), "plate");
  AssertUnknown(other, p, 4, "elasticity");
  sam_call(SamElasticityDestroy(&same));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
  sam_call(SamGridDestroy(&other));
}

/* Stresses are refused where the type does not know them, and of rigid bodies, which have none. */
static void test_stresses_that_are_not_known_are_refused(void **state)
{
  const SamPair       pair = NewPair(210e9, 0.3, INFINITY, 0);
  SamGrid             grid = NewGrid(8, 8, 1, 1);
  SamElasticityTraits traits;
  SamElasticity       e;
  SamStress           stress;

  (void)state;
  sam_call(SamElasticityCreate(grid, pair, &e));
  traits = SamElasticityGetTraits(e);
  sam_assert(traits.stress);
  for (PetscInt body = 0; body <= 3; body += body ? 1 : 2)
    sam_fails(SamElasticityCreateStress(e, body, NULL, &stress), PETSC_ERR_ARG_OUTOFRANGE);
  sam_call(SamElasticityCreateStress(e, 1, NULL, &stress));
  sam_call(SamStressDestroy(&stress));
  sam_call(SamElasticitySetType(e, SAM_ELASTICITY_PERIODIC));
  traits = SamElasticityGetTraits(e);
  sam_assert(!traits.stress);
  sam_fails(SamElasticityCreateStress(e, 1, NULL, &stress), PETSC_ERR_SUP);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

/* ---- names and options ---- */

static void test_unknown_types_are_refused(void **state)
{
  SamGrid       grid = NewGrid(8, 8, 1, 1);
  SamElasticity e    = NewElasticity(grid);

  (void)state;
  AssertType(e, SAM_ELASTICITY_HALFSPACE);
  sam_fails(SamElasticitySetType(e, "plate"), PETSC_ERR_ARG_OUTOFRANGE);
  sam_call(PetscOptionsSetValue(NULL, "-elasticity", "plate"));
  sam_fails(SamElasticitySetFromOptions(e), SAM_ERR_USER);
  AssertType(e, SAM_ELASTICITY_HALFSPACE);
  sam_call(PetscOptionsSetValue(NULL, "-elasticity", "periodic"));
  sam_call(SamElasticitySetFromOptions(e));
  AssertType(e, SAM_ELASTICITY_PERIODIC);
  sam_call(PetscOptionsClearValue(NULL, "-elasticity"));
  sam_call(SamElasticitySetFromOptions(e)); /* what is not given stays */
  AssertType(e, SAM_ELASTICITY_PERIODIC);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

static void test_transforms_have_the_settings_of_their_object(void **state)
{
  const PetscInt first[2] = {10, 12}, n[2] = {9, 8};
  SamGrid        grid = NewGrid(40, 36, 1, 1);
  SamElasticity  e = NewElasticity(grid), other = NewElasticity(grid), coarse, part;
  SamTransfer    transfer;
  SamWindow      window;
  Vec            p = NewRandom(grid, 1, 1), u = NewField(grid, 1), v = NewField(grid, 1);

  (void)state;
  sam_call(SamElasticitySetOptionsPrefix(e, "a_"));
  sam_call(PetscOptionsSetValue(NULL, "-a_fft_exchange", "transpose"));
  sam_call(SamElasticityApplyNormal(e, p, u)); /* before: made anew */
  sam_call(SamElasticitySetFromOptions(e));
  sam_call(SamElasticitySetFromOptions(other));
  sam_assert(e->fft.send && !other->fft.send);
  sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
  sam_call(SamElasticityChoosePart(e, first, n, PETSC_FALSE, &window, &part));
  sam_assert(coarse->fft.send && part->fft.send);
  sam_call(SamElasticityApplyNormal(e, p, u));
  sam_call(SamElasticityApplyNormal(other, p, v));
  sam_call(VecAXPY(v, -1, u));
  sam_assert(Norm(v, NORM_INFINITY) == 0);
  sam_call(PetscOptionsClearValue(NULL, "-a_fft_exchange"));
  sam_call(VecDestroy(&p));
  sam_call(VecDestroy(&u));
  sam_call(VecDestroy(&v));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamElasticityDestroy(&other));
  sam_call(SamGridDestroy(&grid));
}

static void test_a_change_of_type_forgets_what_the_old_one_made(void **state)
{
  SamGrid       grid = NewGrid(40, 36, 1, 1);
  SamElasticity e    = NewElasticity(grid), other, coarse;
  SamTransfer   transfer;
  Vec           p = NewRandom(grid, 1, 1), u = NewField(grid, 1), v = NewField(grid, 1);

  (void)state;
  other = NewElasticity(grid);
  sam_call(SamElasticitySetType(other, SAM_ELASTICITY_PERIODIC));
  sam_call(SamElasticityApplyNormal(e, p, u));
  sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
  sam_call(SamElasticitySetType(e, SAM_ELASTICITY_PERIODIC));
  sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
  AssertType(coarse, SAM_ELASTICITY_PERIODIC);
  sam_call(SamElasticityApplyNormal(e, p, u));
  sam_call(SamElasticityApplyNormal(other, p, v));
  sam_call(VecAXPY(v, -1, u));
  sam_assert(Norm(u, NORM_INFINITY) > 0 && Norm(v, NORM_INFINITY) == 0);
  sam_call(VecDestroy(&p));
  sam_call(VecDestroy(&u));
  sam_call(VecDestroy(&v));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamElasticityDestroy(&other));
  sam_call(SamGridDestroy(&grid));
}

/* ---- parts ---- */

static void AssertPlace(SamElasticity e, PetscInt x, PetscInt y, PetscInt nx, PetscInt ny)
{
  PetscInt first[2], n[2];

  sam_call(SamElasticityGetPartPlace(e, first, n));
  sam_assert(first[0] == x && first[1] == y && n[0] == nx && n[1] == ny);
}

static SamElasticity Part(SamElasticity e, PetscInt x, PetscInt y, PetscInt nx, PetscInt ny, PetscBool keep)
{
  const PetscInt first[2] = {x, y}, n[2] = {nx, ny};
  SamWindow      window;
  SamElasticity  part;

  sam_call(SamElasticityChoosePart(e, first, n, keep, &window, &part));
  sam_assert(!window == !part);
  return part;
}

/* What refers to it has asked for the type's traits. */
static void test_type_is_fixed_once_others_refer_to_it(void **state)
{
  SamGrid       grid = NewGrid(12, 10, 1, 1);
  SamElasticity e = NewElasticity(grid), same = e;

  (void)state;
  sam_call(SamElasticityReference(e));
  sam_fails(SamElasticitySetType(e, SAM_ELASTICITY_PERIODIC), PETSC_ERR_ORDER);
  sam_call(SamElasticityDestroy(&same));
  sam_call(SamElasticitySetType(e, SAM_ELASTICITY_PERIODIC));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

static void test_two_parts_are_kept(void **state)
{
  const PetscInt none[2] = {0, 0}, first[2] = {2, 3}, n[2] = {16, 16};
  SamGrid        grid = NewGrid(64, 60, 1, 1);
  SamElasticity  e    = NewElasticity(grid), a, b, c;

  (void)state;
  a = Part(e, 5, 6, 10, 10, PETSC_TRUE); /* and three cells more on each side */
  AssertPlace(e, 2, 3, 16, 16);
  sam_assert(Part(e, 3, 4, 14, 14, PETSC_TRUE) == a); /* it will do */
  b = Part(e, 20, 20, 20, 20, PETSC_TRUE);
  sam_assert(b != a);
  AssertPlace(e, 17, 17, 26, 26);
  sam_assert(Part(e, 5, 6, 10, 10, PETSC_TRUE) == a); /* back */
  AssertPlace(e, 2, 3, 16, 16);
  sam_assert(Part(e, 20, 20, 20, 20, PETSC_FALSE) == b);
  sam_call(SamElasticitySetPart(e, first, n));
  AssertPlace(e, 2, 3, 16, 16);
  sam_assert(Part(e, 3, 4, 14, 14, PETSC_TRUE) == a);
  sam_call(SamElasticitySetPart(e, none, none));
  AssertPlace(e, 0, 0, 0, 0);
  sam_assert(!Part(e, 0, 0, 64, 55, PETSC_TRUE)); /* hardly smaller than the grid */
  sam_assert(Part(e, 5, 6, 10, 10, PETSC_TRUE) == a);
  c = Part(e, 40, 40, 10, 10, PETSC_TRUE); /* takes the place of b, which is older */
  AssertPlace(e, 37, 37, 16, 16);
  sam_assert(Part(e, 5, 6, 10, 10, PETSC_TRUE) == a && Part(e, 40, 40, 10, 10, PETSC_TRUE) == c);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

static void test_periodic_bodies_have_no_parts(void **state)
{
  const PetscInt first[2] = {2, 3}, n[2] = {16, 16}, none[2] = {0, 0};
  SamGrid        grid = NewGrid(64, 60, 1, 1);
  SamElasticity  e    = NewElasticity(grid);

  (void)state;
  sam_call(SamElasticitySetType(e, SAM_ELASTICITY_PERIODIC));
  sam_assert(!Part(e, 5, 6, 10, 10, PETSC_TRUE));
  sam_call(SamElasticitySetPart(e, first, none));
  sam_fails(SamElasticitySetPart(e, first, n), PETSC_ERR_ARG_OUTOFRANGE);
  AssertPlace(e, 0, 0, 0, 0);
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

/* Products are the same after tables and memory were given back. */
static void test_release_changes_nothing(void **state)
{
  const SamElasticityType types[2] = {SAM_ELASTICITY_HALFSPACE, SAM_ELASTICITY_PERIODIC};
  SamGrid                 grid     = NewGrid(40, 36, 1, 1);
  SamElasticity           e        = NewElasticity(grid), coarse;
  SamTransfer             transfer;
  Vec                     p = NewRandom(grid, 1, 1), u = NewField(grid, 1), v = NewField(grid, 1);

  (void)state;
  for (int t = 0; t < 2; t++) {
    sam_call(SamElasticitySetType(e, types[t]));
    sam_call(SamElasticityTrim(e)); /* of nothing */
    sam_call(SamElasticityGetCoarse(e, &coarse, &transfer));
    sam_call(SamElasticityApplyNormal(e, p, u));
    sam_call(SamElasticityTrim(e));
    sam_call(SamElasticityApplyNormal(e, p, v));
    sam_call(VecAXPY(v, -1, u));
    sam_assert(Norm(v, NORM_INFINITY) == 0);
  }
  sam_call(VecDestroy(&p));
  sam_call(VecDestroy(&u));
  sam_call(VecDestroy(&v));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_unknown_types_are_refused),
    cmocka_unit_test(test_transforms_have_the_settings_of_their_object),
    cmocka_unit_test(test_a_change_of_type_forgets_what_the_old_one_made),
    cmocka_unit_test(test_type_is_fixed_once_others_refer_to_it),
    cmocka_unit_test(test_two_parts_are_kept),
    cmocka_unit_test(test_periodic_bodies_have_no_parts),
    cmocka_unit_test(test_release_changes_nothing),
    cmocka_unit_test(test_a_type_from_outside_works),
    cmocka_unit_test(test_bodies_come_back_from_their_parameters),
    cmocka_unit_test(test_stresses_that_are_not_known_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}
