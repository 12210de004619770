/*
  Bodies of a linear viscoelastic material: an addition to half-spaces or periods of one elastic material each.

  The shear modulus G relaxes as a sum of exponentials (a generalised Maxwell model). The surface of a body is displaced
  by two creep functions, a of 1/G and b of 3/(3 K + G), K being the bulk modulus, in place of the constants

      (1 - nu)/G = (a + b)/2,   nu/G = (a - b)/2,   (1 - 2 nu)/G = b.

  If Poisson's ratio is constant, b is (1 - 2 nu) a; if K is, b comes from moduli that relax by less (prony.c). Each is
  a(0) + sum a_j (1 - exp(-t/theta_j)), so that under any history

      u(t) = C p + sum C_j c_j,   theta_j c_j' + c_j = p,

  with C of the elastic bodies under a sudden load, whose Young's moduli are given, C_j of the constants of a term, and
  c_j a traction that follows p. With p linear in time in a step, x = dt/theta, e = exp(-x), m = (1 - e)/x:

      c_new = e c_old + (m - e) p_old + (1 - m) p_new.

  So the step is that of elastic bodies with the constants of C and the sum of (1 - m_j) C_j, which have moved before
  any traction of the step by sum C_j (e c_old + (m - e) p_old) (viscousmemory.c). It is of second order in dt; a step
  without duration is a jump. Stresses are those by the tractions, as of elastic bodies, if Poisson's ratio is constant.
  In steady states nothing is remembered (viscousstream.c).

  A pair has three constants (SamPairConstants), to which its displacements are proportional. So those of all terms are
  products of the elastic pair with factors; and where the tangential ones, of two constants, do not keep their ratio,
  or the terms couple what a sudden load does not, also of another pair. The inverse of the elastic pair remains the
  preconditioner.
  Source: E. H. Lee, J. R. M. Radok, J. Appl. Mech. 27 (1960) 438-444.
*/
#include "viscous.h"
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/parameters.h>
#include <math.h>
#include <string.h>

#define LEAST     1e-9 /* least modulus of a relaxed body, as a part of that under a sudden load */
#define LONGEST   1e18 /* longest time, s */
#define OPERATORS 150  /* memory per cell of the operators of the other bodies, bytes */

static SamViscous *DataOf(SamElasticity e)
{
  return (SamViscous *)e->data;
}

static PetscErrorCode SetUp(SamElasticity e)
{
  SamViscous *v = DataOf(e);
  SamPair     pair;

  PetscFunctionBegin;
  if (v->finest->streams || (!v->finest->mixes && !v->finest->pushes)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamPairCreateOther(e->pair, &pair));
  PetscCall(SamElasticityCreateOfPair(e->inner, pair, &v->other));
  PetscCall(SamPairDestroy(&pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamElasticity e)
{
  PetscFunctionBegin;
  PetscCall(SamElasticityDestroy(&DataOf(e)->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

/* Finds the factors of the products in the present step. */
static void FindNow(SamElasticity e, double factor[SAM_VISCOUS_PRODUCTS])
{
  double value[SAM_PAIR_CONSTANTS];

  SamViscousGetConstants(e, value);
  SamViscousFindFactors(e, value, factor);
}

typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);

/* Returns the bodies of a product. */
static SamElasticity BodiesOf(SamElasticity e, SamViscousProductKind kind)
{
  const PetscBool coupling = kind == SAM_VISCOUS_PUSH || kind == SAM_VISCOUS_LIFT;

  if (kind == SAM_VISCOUS_OTHER_SHEAR || (coupling && DataOf(e)->finest->pushes && !DataOf(e)->finest->streams))
    return DataOf(e)->other;
  return e->inner;
}

/* Applies a product to arrays of this rank's cells, without a factor. */
static PetscErrorCode ApplyKind(SamElasticity e, SamViscousProductKind kind, const double *const in[],
                                double *const out[])
{
  const SamElasticity of     = BodiesOf(e, kind);
  const Method        method = kind == SAM_VISCOUS_NORMAL ? of->ops.applynormal
                               : kind == SAM_VISCOUS_PUSH ? of->ops.applynormaltotangential
                               : kind == SAM_VISCOUS_LIFT ? of->ops.applytangentialtonormal
                                                          : of->ops.applytangential;

  PetscFunctionBegin;
  PetscCall(SamElasticitySetUp(of));
  PetscCall((*method)(of, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Applies a product with its factor in the present step, and adds that of the other bodies to the tangential one. */
static PetscErrorCode ApplyNow(SamElasticity e, SamViscousProductKind kind, PetscInt components,
                               const double *const in[], double *const out[])
{
  const PetscInt n = e->grid->cells;
  double         factor[SAM_VISCOUS_PRODUCTS], *more[2] = {NULL, NULL}, part;

  PetscFunctionBegin;
  FindNow(e, factor);
  part = kind == SAM_VISCOUS_SHEAR ? factor[SAM_VISCOUS_OTHER_SHEAR] : 0;
  if (part != 0) {
    PetscCall(PetscMalloc2(n, &more[0], n, &more[1]));
    PetscCall(ApplyKind(e, SAM_VISCOUS_OTHER_SHEAR, in, more)); /* before `out`, which may be `in`, is written */
  }
  PetscCall(ApplyKind(e, kind, in, out));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt k = 0; k < n; k++) out[c][k] = factor[kind] * out[c][k] + (more[c] ? part * more[c][k] : 0);
  PetscCall(PetscFree2(more[0], more[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define PRODUCT(Name, kind, components) \
  static PetscErrorCode Name(SamElasticity e, const double *const in[], double *const out[]) \
  { \
    PetscFunctionBegin; \
    PetscCall(ApplyNow(e, kind, components, in, out)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
PRODUCT(ApplyNormal, SAM_VISCOUS_NORMAL, 1)
PRODUCT(ApplyTangential, SAM_VISCOUS_SHEAR, 2)
PRODUCT(ApplyNormalToTangential, SAM_VISCOUS_PUSH, 2)
PRODUCT(ApplyTangentialToNormal, SAM_VISCOUS_LIFT, 1)

static PetscErrorCode ApplyNormalSingle(SamElasticity e, double factor, const float *const in[], float *const out[])
{
  double now[SAM_VISCOUS_PRODUCTS];

  PetscFunctionBegin;
  FindNow(e, now);
  PetscCall((*e->inner->ops.applynormalsingle)(e->inner, factor * now[SAM_VISCOUS_NORMAL], in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyTangentialSingle(SamElasticity e, double factor, const float *const in[], float *const out[])
{
  const SamElasticity other   = DataOf(e)->other;
  const PetscInt      n       = e->grid->cells;
  float              *more[2] = {NULL, NULL};
  double              now[SAM_VISCOUS_PRODUCTS];

  PetscFunctionBegin;
  FindNow(e, now);
  if (now[SAM_VISCOUS_OTHER_SHEAR] != 0) {
    PetscCall(SamElasticitySetUp(other));
    PetscCall(PetscMalloc2(n, &more[0], n, &more[1]));
    PetscCall((*other->ops.applytangentialsingle)(other, factor * now[SAM_VISCOUS_OTHER_SHEAR], in, more));
  }
  PetscCall((*e->inner->ops.applytangentialsingle)(e->inner, factor * now[SAM_VISCOUS_SHEAR], in, out));
  for (PetscInt c = 0; c < 2 && more[c]; c++)
    for (PetscInt k = 0; k < n; k++) out[c][k] += more[c][k];
  PetscCall(PetscFree2(more[0], more[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousProduct(SamElasticity e, SamViscousProductKind kind, Vec in, Vec out)
{
  const PetscInt n = e->grid->cells;
  const double  *x;
  double        *y;
  PetscReal      most;

  PetscFunctionBegin;
  PetscCall(VecNorm(in, NORM_INFINITY, &most));
  if (most == 0) { /* as without friction */
    PetscCall(VecZeroEntries(out));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecGetArrayRead(in, &x));
  PetscCall(VecGetArray(out, &y));
  PetscCall(ApplyKind(e, kind, (const double *const[]){x, x + n}, (double *const[]){y, y + n}));
  PetscCall(VecRestoreArray(out, &y));
  PetscCall(VecRestoreArrayRead(in, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- approximate inverses ---- */

/* Gets the influence of a cell on itself under a sudden load, which the class keeps, without that of the film. */
static PetscErrorCode GetSudden(SamElasticity of, PetscReal self[2])
{
  PetscFunctionBegin;
  PetscCall(SamElasticityGetSelfInfluence(of, &self[0], &self[1]));
  self[1] -= of->film;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetSelfInfluence(SamElasticity e, PetscReal *normal, PetscReal *tangential)
{
  double    factor[SAM_VISCOUS_PRODUCTS];
  PetscReal one[2], other[2] = {0, 0};

  PetscFunctionBegin;
  FindNow(e, factor);
  PetscCall(GetSudden(e->inner, one));
  if (factor[SAM_VISCOUS_OTHER_SHEAR] != 0) PetscCall(GetSudden(DataOf(e)->other, other));
  *normal     = factor[SAM_VISCOUS_NORMAL] * one[0];
  *tangential = factor[SAM_VISCOUS_SHEAR] * one[1] + factor[SAM_VISCOUS_OTHER_SHEAR] * other[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the factor of the operator's inverse: that of the normal one. */
static double InverseOf(SamElasticity e)
{
  double factor[SAM_VISCOUS_PRODUCTS];

  FindNow(e, factor);
  return 1 / factor[SAM_VISCOUS_NORMAL];
}

static PetscErrorCode PreconditionNormal(SamElasticity e, double factor, const float *const in[], float *const out[])
{
  PetscFunctionBegin;
  PetscCall((*e->inner->ops.preconditionnormal)(e->inner, factor * InverseOf(e), in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PreconditionTangential(SamElasticity e, double factor, const float *const in[],
                                             float *const out[])
{
  PetscFunctionBegin;
  PetscCall((*e->inner->ops.preconditiontangential)(e->inner, factor * InverseOf(e), in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the type ---- */

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  PetscFunctionBegin;
  DataOf(child)->finest = DataOf(parent)->finest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { MODULI, TIMES, KIND, OPTIONS };
#define NAMES(body) \
  { \
    "body" body "_relax_moduli", "body" body "_relax_times", "body" body "_relax" \
  }
static const char *const options[2][OPTIONS] = {NAMES("1"), NAMES("2")};

#define POISSON "constant_poisson"
#define BULK    "constant_bulk"
#define ROWS(body) \
  { \
    {"body" body "_relax_moduli", \
     "parts of the shear modulus of body " body " that relax", \
     SAM_OPTION_REAL, \
     .size  = SAM_CREEP_TERMS, \
     .range = SAM_RANGE_POSITIVE, \
     .needs = "body" body "_relax_times"}, \
      {"body" body "_relax_times", \
       "relaxation times of these parts", \
       SAM_OPTION_REAL, \
       .size  = SAM_CREEP_TERMS, \
       .range = SAM_RANGE_POSITIVE, \
       .unit  = "s", \
       .needs = "body" body "_relax_moduli"}, \
    { \
      "body" body "_relax", "what stays constant: Poisson's ratio or the bulk modulus", SAM_OPTION_ENUM, \
        .words = POISSON "," BULK, .needs = "body" body "_relax_moduli" \
    } \
  }
static const SamOptionRow rows[2][OPTIONS] = {ROWS("1"), ROWS("2")};
static const char *const  kinds[2]         = {POISSON, BULK};

static PetscErrorCode AddParameters(SamElasticity e, SamParameters *p)
{
  const SamViscous *v = DataOf(e);

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) {
    if (!v->relaxes[b]) continue;
    PetscCall(SamParametersAddReals(p, options[b][MODULI], PETSC_TRUE, v->relaxes[b], v->moduli[b]));
    PetscCall(SamParametersAddReals(p, options[b][TIMES], PETSC_TRUE, v->relaxes[b], v->times[b]));
    PetscCall(SamParametersAddText(p, options[b][KIND], PETSC_TRUE, kinds[v->bulk[b]]));
  }
  if (e->traits.slides)
    for (int b = 0; b < 2; b++)
      PetscCall(SamParametersAddReals(p, b ? "body2_speed" : "body1_speed", PETSC_TRUE, 1, &v->speed[b]));
  else if (v->streams) {
    const PetscReal speed = -v->speed[0];

    PetscCall(SamParametersAddReals(p, "rolling_speed", PETSC_TRUE, 1, &speed));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateStress(SamElasticity e, PetscInt body, const SamFourierSettings *settings,
                                   SamStress *stress)
{
  const PetscInt  b = body - 1;
  const PetscBool without =
    SamViscousHasBulk(e, 1 - b) || SamBodyIsRigid(e->pair->body[1 - b]) ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  PetscCheck(!SamViscousHasBulk(e, b), e->grid->comm, SAM_ERR_USER,
             "-%s " BULK ": the stresses in body %" PetscInt_FMT
             " are not available, as they depend on earlier tractions: run with " POISSON "%s",
             options[b][KIND], body,
             without ? ""
             : b     ? ", or give -body 1"
                     : ", or give -body 2");
  PetscCall((*e->inner->ops.createstress)(e->inner, body, settings, stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamElasticity e)
{
  SamViscous *v;

  PetscFunctionBegin;
  PetscCall(PetscNew(&v));
  v->finest = v;
  e->data   = v;
  e->ops    = (SamElasticityOps){.inherit                 = Inherit,
                                 .setup                   = SetUp,
                                 .addparameters           = AddParameters,
                                 .destroy                 = Destroy,
                                 .applynormal             = ApplyNormal,
                                 .applytangential         = ApplyTangential,
                                 .applynormalsingle       = ApplyNormalSingle,
                                 .applytangentialsingle   = ApplyTangentialSingle,
                                 .preconditionnormal      = PreconditionNormal,
                                 .preconditiontangential  = PreconditionTangential,
                                 .getselfinfluence        = GetSelfInfluence,
                                 .applynormaltotangential = ApplyNormalToTangential,
                                 .applytangentialtonormal = ApplyTangentialToNormal,
                                 .declare                 = SamViscousMemoryDeclare,
                                 .begin                   = SamViscousMemoryBegin,
                                 .displace                = SamViscousMemoryDisplace,
                                 .advance                 = SamViscousMemoryAdvance,
                                 .examine                 = SamViscousExamine,
                                 .doubt                   = SamViscousDoubt,
                                 .stream                  = SamViscousStream,
                                 .createsymmetric         = SamViscousCreateSymmetric};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Wraps the bodies of which one relaxes; `v`: the settings. */
static PetscErrorCode Wrap(SamElasticity *elasticity, const SamViscous *settings)
{
  SamElasticity e;
  SamViscous   *v;

  PetscFunctionBegin;
  PetscCall(SamElasticityWrap(*elasticity, "viscous", Create, &e));
  v = DataOf(e);
  for (int b = 0; b < 2; b++) {
    v->relaxes[b] = settings->relaxes[b];
    PetscCall(PetscArraycpy(v->moduli[b], settings->moduli[b], SAM_CREEP_TERMS));
    PetscCall(PetscArraycpy(v->times[b], settings->times[b], SAM_CREEP_TERMS));
    v->bulk[b]  = settings->bulk[b];
    v->speed[b] = settings->speed[b];
  }
  PetscCall(SamViscousSetTerms(e));
  if (e->inner->ops.createstress && (SamViscousHasBulk(e, 0) || SamViscousHasBulk(e, 1)))
    e->ops.createstress = CreateStress;
  e->bytes          = 48 * (v->terms + 2) + (v->mixes || v->pushes ? OPERATORS : 0);
  e->traits.stretch = PETSC_FALSE; /* the strain by a uniform stress creeps, too */
  e->option         = options[v->relaxes[0] ? 0 : 1][MODULI];
  PetscCall(SamElasticityDestroy(elasticity));
  *elasticity = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- options ---- */

/* Checks the parts of a body's modulus and their times. */
static PetscErrorCode CheckBody(SamElasticity e, const SamOptions *from, const SamViscous *v, PetscInt b)
{
  const char *const prefix = SamOptionsPrefix(from);
  double            sum    = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < v->relaxes[b]; k++) sum += (double)v->moduli[b][k];
  PetscCheck(
    sum <= 1 - LEAST, from->comm, SAM_ERR_USER,
    "-%s%s: the parts of the modulus add up to %.6g: expected less than 1, by %.6g at least, as the rest is the "
    "modulus of a relaxed body",
    prefix, options[b][MODULI], sum, LEAST);
  for (PetscInt k = 0; k < v->relaxes[b]; k++)
    PetscCheck(v->times[b][k] >= 1 / LONGEST && v->times[b][k] <= LONGEST, from->comm, SAM_ERR_USER,
               "-%s%s %.6g: expected times from %.6g to %.6g s", prefix, options[b][TIMES], (double)v->times[b][k],
               1 / LONGEST, LONGEST);
  PetscCheck(!SamBodyIsRigid(e->pair->body[b]), from->comm, SAM_ERR_USER,
             "-%s%s: body %" PetscInt_FMT " is rigid and does not relax: omit it", prefix, options[b][MODULI], b + 1);
  PetscCheck(SamPairIsUniform(e->pair), from->comm, SAM_ERR_USER,
             "-%s%s: not supported with layers: bodies that relax have one material: omit one of them", prefix,
             options[b][MODULI]);
  PetscCheck(!e->traits.patch, from->comm, SAM_ERR_USER,
             "-%s%s: not supported with -%sbody1_compliance or -%sbody2_compliance: omit one of them", prefix,
             options[b][MODULI], prefix, prefix);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddFromOptions(SamElasticity *elasticity, const SamOptions *from)
{
  SamViscous  settings = {.terms = 0};
  PetscInt    counts[2];
  PetscBool   speed;
  const char *slides;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    PetscCall(SamOptionsReals(from, &rows[b][MODULI], settings.moduli[b], &counts[0]));
    PetscCall(SamOptionsReals(from, &rows[b][TIMES], settings.times[b], &counts[1]));
    PetscCall(SamOptionsRead(from, NULL, 1, &rows[b][KIND], &settings.bulk[b], NULL));
    if (SamPrintHelp() || !(counts[0] || counts[1])) continue;
    PetscCheck(counts[0], from->comm, SAM_ERR_USER, "-%s%s is given without -%s%s: give both", SamOptionsPrefix(from),
               options[b][TIMES], SamOptionsPrefix(from), options[b][MODULI]);
    PetscCheck(counts[0] == counts[1], from->comm, SAM_ERR_USER,
               "-%s%s: %" PetscInt_FMT " times for %" PetscInt_FMT " parts of -%s%s: give one for each",
               SamOptionsPrefix(from), options[b][TIMES], counts[1], counts[0], SamOptionsPrefix(from),
               options[b][MODULI]);
    PetscCall(SamOptionsExclude(from, options[b][MODULI], "slide",
                                "what the bodies remember does not slide with them: give a column roll"));
    settings.relaxes[b] = counts[0];
    PetscCall(CheckBody(*elasticity, from, &settings, b));
  }
  if (settings.relaxes[0] + settings.relaxes[1] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamOptionsHas(from, "rolling_speed", &speed));
  PetscCall(SamOptionsNeed(from, speed, "rolling_speed", SAM_NEEDS_ROLLING));
  PetscCall(SamViscousReadSpeeds(from, settings.speed, &slides));
  PetscCall(Wrap(elasticity, &settings));
  if (slides) PetscCall(SamViscousSlide(*elasticity, slides));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddFromParameters(SamElasticity *elasticity, const SamParameters *p, const char source[])
{
  SamViscous settings = {.terms = 0};

  PetscFunctionBegin;
  (void)source;
  for (int b = 0; b < 2; b++) {
    const SamParameter *moduli = SamParametersFind(p, options[b][MODULI]),
                       *times = SamParametersFind(p, options[b][TIMES]), *kind = SamParametersFind(p, options[b][KIND]);

    if (!moduli || !times) continue;
    settings.relaxes[b] = PetscMin(moduli->count, SAM_CREEP_TERMS);
    PetscCall(PetscArraycpy(settings.moduli[b], moduli->value, settings.relaxes[b]));
    PetscCall(PetscArraycpy(settings.times[b], times->value, settings.relaxes[b]));
    settings.bulk[b] = kind && !strcmp(kind->text, BULK) ? 1 : 0;
  }
  if (settings.relaxes[0] + settings.relaxes[1] > 0) PetscCall(Wrap(elasticity, &settings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamElasticityAddition SamElasticityViscous = {AddFromOptions, AddFromParameters};
