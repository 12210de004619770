/*
  Bodies of a linear viscoelastic material: an addition to half-spaces or periods of one elastic material each.

  The shear modulus relaxes as a sum of exponentials (a generalised Maxwell model), Poisson's ratio is constant. So the
  displacement of a body creeps like J(t)/J(0) = 1 + sum a_j (1 - exp(-t/theta_j)) under a constant traction (prony.c),
  and under any history

      u(t) = C (p + sum a_j c_j),   theta_j c_j' + c_j = p,

  with C of the elastic body under a sudden load, whose Young's modulus is given, and c_j a traction that follows p.
  With p linear in time in a step, x = dt/theta, e = exp(-x), m = (1 - e)/x:

      c_new = e c_old + (m - e) p_old + (1 - m) p_new.

  So the step is that of elastic bodies that give way by 1 + sum a_j (1 - m_j) times as much, and have moved before any
  traction of the step by sum a_j C (e c_old + (m - e) p_old) (viscousmemory.c). It is of second order in dt; a step
  without duration is a jump. Stresses are those by the tractions, as of elastic bodies, since Poisson's ratio is
  constant.

  Where all bodies that are not rigid have the same creep, the operator is that of the elastic pair times a factor. Else
  it is the sum of each body on a rigid one, and the inverse of the elastic pair remains the preconditioner.
  Source: E. H. Lee, J. R. M. Radok, J. Appl. Mech. 27 (1960) 438-444.
*/
#include "viscous.h"
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/parameters.h>
#include <math.h>
#include <string.h>

#define LEAST     1e-9 /* least modulus of a relaxed body, as a part of that under a sudden load */
#define LONGEST   1e18 /* longest time, s */
#define OPERATORS 300  /* memory per cell of the operators of both bodies, bytes */

static SamViscous *DataOf(SamElasticity e)
{
  return (SamViscous *)e->data;
}

double SamViscousFactor(const SamViscous *v, PetscInt body)
{
  double factor = 1;

  for (PetscInt j = 0; j < v->terms; j++) factor += v->term[j].part[body] * (double)v->term[j].now;
  return factor;
}

/* Returns the factor of a body in the present step, on any grid. */
static double FactorOf(SamElasticity e, PetscInt body)
{
  return SamViscousFactor(DataOf(e)->finest, body);
}

/* Returns a body that creeps as all do, if all bodies that are not rigid do. */
static PetscInt AnyOf(SamElasticity e)
{
  return SamBodyIsRigid(e->pair->body[0]) ? 1 : 0;
}

static PetscErrorCode SetUp(SamElasticity e)
{
  SamViscous *v = DataOf(e);

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2 && !v->finest->alike; b++) {
    const SamMaterial rigid = {INFINITY, 0, 0};
    SamBody           base;
    SamPair           pair;

    PetscCall(SamBodyCreate(1, &rigid, &base));
    PetscCall(SamPairCreate(b ? base : e->pair->body[0], b ? e->pair->body[1] : base, &pair));
    PetscCall(SamElasticityCreateOfPair(e->inner, pair, &v->body[b]));
    PetscCall(SamPairDestroy(&pair));
    PetscCall(SamBodyDestroy(&base));
    PetscCall(SamElasticitySetUp(v->body[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamElasticity e)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) PetscCall(SamElasticityDestroy(&DataOf(e)->body[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);
typedef PetscErrorCode (*MethodSingle)(SamElasticity, double, const float *const[], float *const[]);

/* Adds the products of both bodies: in[] is used before out[], which may be the same, is written. */
static PetscErrorCode AddBodies(SamElasticity e, Method method, PetscInt components, const double *const in[],
                                double *const out[])
{
  const PetscInt n      = e->grid->cells;
  const double   of[2]  = {FactorOf(e, 0), FactorOf(e, 1)};
  double        *one[2] = {NULL, NULL};

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n, &one[0], n, &one[1]));
  PetscCall((*method)(DataOf(e)->body[0], in, one));
  PetscCall((*method)(DataOf(e)->body[1], in, out));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt k = 0; k < n; k++) out[c][k] = of[0] * one[c][k] + of[1] * out[c][k];
  PetscCall(PetscFree2(one[0], one[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddBodiesSingle(SamElasticity e, MethodSingle method, PetscInt components, double factor,
                                      const float *const in[], float *const out[])
{
  const PetscInt n      = e->grid->cells;
  float         *one[2] = {NULL, NULL};

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n, &one[0], n, &one[1]));
  PetscCall((*method)(DataOf(e)->body[0], factor * FactorOf(e, 0), in, one));
  PetscCall((*method)(DataOf(e)->body[1], factor * FactorOf(e, 1), in, out));
  for (PetscInt c = 0; c < components; c++)
    for (PetscInt k = 0; k < n; k++) out[c][k] += one[c][k];
  PetscCall(PetscFree2(one[0], one[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define PRODUCT(Name, method, components) \
  static PetscErrorCode Name(SamElasticity e, const double *const in[], double *const out[]) \
  { \
    const double factor = FactorOf(e, AnyOf(e)); \
\
    PetscFunctionBegin; \
    if (!DataOf(e)->finest->alike) { \
      PetscCall(AddBodies(e, e->inner->ops.method, components, in, out)); \
      PetscFunctionReturn(PETSC_SUCCESS); \
    } \
    PetscCall((*e->inner->ops.method)(e->inner, in, out)); \
    for (PetscInt c = 0; c < components; c++) \
      for (PetscInt k = 0; k < e->grid->cells; k++) out[c][k] *= factor; \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
#define SINGLE(Name, method, components) \
  static PetscErrorCode Name(SamElasticity e, double factor, const float *const in[], float *const out[]) \
  { \
    PetscFunctionBegin; \
    if (!DataOf(e)->finest->alike) \
      PetscCall(AddBodiesSingle(e, e->inner->ops.method, components, factor, in, out)); \
    else \
      PetscCall((*e->inner->ops.method)(e->inner, factor * FactorOf(e, AnyOf(e)), in, out)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
PRODUCT(ApplyNormal, applynormal, 1)
PRODUCT(ApplyTangential, applytangential, 2)
PRODUCT(ApplyNormalToTangential, applynormaltotangential, 2)
PRODUCT(ApplyTangentialToNormal, applytangentialtonormal, 1)
SINGLE(ApplyNormalSingle, applynormalsingle, 1)
SINGLE(ApplyTangentialSingle, applytangentialsingle, 2)

PetscErrorCode SamViscousApply(SamElasticity e, PetscInt body, double weight, Vec p, Vec q, Vec u_z, Vec u_t)
{
  const SamElasticity of    = body < 0 ? e->inner : DataOf(e)->body[body];
  const Vec           in[4] = {p, q, q, p}, out[4] = {u_z, u_t, u_z, u_t};
  const Method        method[4] = {of->ops.applynormal, of->ops.applytangential, of->ops.applytangentialtonormal,
                                   of->ops.applynormaltotangential};
  const PetscInt      n         = e->grid->cells;

  PetscFunctionBegin;
  for (int k = 0; k < (e->traits.coupled ? 4 : 2); k++) {
    const double *x;
    double       *y;
    Vec           more;

    PetscCall(VecDuplicate(out[k], &more));
    PetscCall(VecGetArrayRead(in[k], &x));
    PetscCall(VecGetArray(more, &y));
    PetscCall((*method[k])(of, (const double *const[]){x, x + n}, (double *const[]){y, y + n}));
    PetscCall(VecRestoreArray(more, &y));
    PetscCall(VecRestoreArrayRead(in[k], &x));
    PetscCall(VecAXPY(out[k], weight, more));
    PetscCall(VecDestroy(&more));
  }
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
  const SamViscous *v = DataOf(e);
  PetscReal         one[2];

  PetscFunctionBegin;
  *normal = *tangential = 0;
  for (PetscInt b = 0; b < 2; b++) {
    const PetscBool all = v->finest->alike;

    if (all && b != AnyOf(e)) continue;
    PetscCall(GetSudden(all ? e->inner : v->body[b], one));
    *normal += FactorOf(e, b) * one[0];
    *tangential += FactorOf(e, b) * one[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the factor of the operator's inverse: that of the self-influences. */
static PetscErrorCode GetInverse(SamElasticity e, double *factor)
{
  PetscReal sudden[2], now[2];

  PetscFunctionBegin;
  PetscCall(GetSudden(e->inner, sudden));
  PetscCall(GetSelfInfluence(e, &now[0], &now[1]));
  *factor = (double)(sudden[0] / now[0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PreconditionNormal(SamElasticity e, double factor, const float *const in[], float *const out[])
{
  double inverse = 1;

  PetscFunctionBegin;
  PetscCall(GetInverse(e, &inverse));
  PetscCall((*e->inner->ops.preconditionnormal)(e->inner, factor * inverse, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PreconditionTangential(SamElasticity e, double factor, const float *const in[],
                                             float *const out[])
{
  double inverse = 1;

  PetscFunctionBegin;
  PetscCall(GetInverse(e, &inverse));
  PetscCall((*e->inner->ops.preconditiontangential)(e->inner, factor * inverse, in, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the type ---- */

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  PetscFunctionBegin;
  DataOf(child)->finest = DataOf(parent)->finest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *const options[2][2] = {{"body1_relax_moduli", "body1_relax_times"},
                                          {"body2_relax_moduli", "body2_relax_times"}};

#define ROWS(body) \
  { \
    {"body" body "_relax_moduli", \
     "parts of the modulus of body " body " that relax (constant Poisson's ratio)", \
     SAM_OPTION_REAL, \
     .size  = SAM_CREEP_TERMS, \
     .range = SAM_RANGE_POSITIVE, \
     .needs = "body" body "_relax_times"}, \
    { \
      "body" body "_relax_times", "relaxation times of these parts", SAM_OPTION_REAL, \
        .size = SAM_CREEP_TERMS, .range = SAM_RANGE_POSITIVE, .unit = "s", .needs = "body" body "_relax_moduli" \
    } \
  }
static const SamOptionRow rows[2][2] = {ROWS("1"), ROWS("2")};

static PetscErrorCode AddParameters(SamElasticity e, SamParameters *p)
{
  const SamViscous *v = DataOf(e);

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) {
    if (!v->relaxes[b]) continue;
    PetscCall(SamParametersAddReals(p, options[b][0], PETSC_TRUE, v->relaxes[b], v->moduli[b]));
    PetscCall(SamParametersAddReals(p, options[b][1], PETSC_TRUE, v->relaxes[b], v->times[b]));
  }
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
                                 .advance                 = SamViscousMemoryAdvance};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the terms of a body's creep; times that both bodies have are one term. */
static PetscErrorCode AddTerms(SamElasticity e, PetscInt body)
{
  SamViscous *v = DataOf(e);
  SamCreep    creep;

  PetscFunctionBegin;
  SamCreepFromRelaxation(v->relaxes[body], v->moduli[body], v->times[body], &creep);
  for (PetscInt k = 0; k < creep.count; k++) {
    PetscInt j = 0;

    while (j < v->terms && (double)v->term[j].time != creep.time[k]) j++;
    v->term[j].time       = creep.time[k];
    v->term[j].part[body] = creep.part[k];
    v->terms              = PetscMax(v->terms, j + 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if all bodies that are not rigid creep alike; bodies that do not are coupled. */
static void Compare(SamElasticity e)
{
  SamViscous *v = DataOf(e);

  v->alike = PETSC_TRUE;
  if (SamBodyIsRigid(e->pair->body[0]) || SamBodyIsRigid(e->pair->body[1])) return;
  for (PetscInt j = 0; j < v->terms; j++)
    if (v->term[j].part[0] != v->term[j].part[1]) v->alike = PETSC_FALSE;
  for (PetscInt b = 0; b < 2 && !v->alike; b++)
    if (v->relaxes[b] && (double)e->pair->body[b]->material[0].poisson < 0.5) e->traits.coupled = PETSC_TRUE;
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
    PetscCall(AddTerms(e, b));
  }
  Compare(e);
  e->bytes          = 48 * (v->terms + 2) + (v->alike ? 0 : OPERATORS);
  e->traits.stretch = PETSC_FALSE; /* the strain by a uniform stress creeps, too */
  e->option         = options[v->relaxes[0] ? 0 : 1][0];
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
    prefix, options[b][0], sum, LEAST);
  for (PetscInt k = 0; k < v->relaxes[b]; k++)
    PetscCheck(v->times[b][k] >= 1 / LONGEST && v->times[b][k] <= LONGEST, from->comm, SAM_ERR_USER,
               "-%s%s %.6g: expected times from %.6g to %.6g s", prefix, options[b][1], (double)v->times[b][k],
               1 / LONGEST, LONGEST);
  PetscCheck(!SamBodyIsRigid(e->pair->body[b]), from->comm, SAM_ERR_USER,
             "-%s%s: body %" PetscInt_FMT " is rigid and does not relax: omit it", prefix, options[b][0], b + 1);
  PetscCheck(SamPairIsUniform(e->pair), from->comm, SAM_ERR_USER,
             "-%s%s: not supported with layers: bodies that relax have one material: omit one of them", prefix,
             options[b][0]);
  PetscCheck(!e->traits.patch, from->comm, SAM_ERR_USER,
             "-%s%s: not supported with -%sbody1_compliance or -%sbody2_compliance: omit one of them", prefix,
             options[b][0], prefix, prefix);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddFromOptions(SamElasticity *elasticity, const SamOptions *from)
{
  SamViscous settings = {.terms = 0};
  PetscInt   counts[2];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    PetscCall(SamOptionsReals(from, &rows[b][0], settings.moduli[b], &counts[0]));
    PetscCall(SamOptionsReals(from, &rows[b][1], settings.times[b], &counts[1]));
    if (SamPrintHelp() || !(counts[0] || counts[1])) continue;
    PetscCheck(counts[0], from->comm, SAM_ERR_USER, "-%s%s is given without -%s%s: give both", SamOptionsPrefix(from),
               options[b][1], SamOptionsPrefix(from), options[b][0]);
    PetscCheck(counts[0] == counts[1], from->comm, SAM_ERR_USER,
               "-%s%s: %" PetscInt_FMT " times for %" PetscInt_FMT " parts of -%s%s: give one for each",
               SamOptionsPrefix(from), options[b][1], counts[1], counts[0], SamOptionsPrefix(from), options[b][0]);
    PetscCall(SamOptionsExclude(from, options[b][0], "slide",
                                "what the bodies remember does not slide with them: give a column roll"));
    settings.relaxes[b] = counts[0];
    PetscCall(CheckBody(*elasticity, from, &settings, b));
  }
  if (settings.relaxes[0] + settings.relaxes[1] > 0) PetscCall(Wrap(elasticity, &settings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddFromParameters(SamElasticity *elasticity, const SamParameters *p, const char source[])
{
  SamViscous settings = {.terms = 0};

  PetscFunctionBegin;
  (void)source;
  for (int b = 0; b < 2; b++) {
    const SamParameter *moduli = SamParametersFind(p, options[b][0]), *times = SamParametersFind(p, options[b][1]);

    if (!moduli || !times) continue;
    settings.relaxes[b] = PetscMin(moduli->count, SAM_CREEP_TERMS);
    PetscCall(PetscArraycpy(settings.moduli[b], moduli->value, settings.relaxes[b]));
    PetscCall(PetscArraycpy(settings.times[b], times->value, settings.relaxes[b]));
  }
  if (settings.relaxes[0] + settings.relaxes[1] > 0) PetscCall(Wrap(elasticity, &settings));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamElasticityAddition SamElasticityViscous = {AddFromOptions, AddFromParameters};
