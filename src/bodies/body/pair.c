/* Pairs of bodies: the sums of their constants, and the film between them. */
#include <petsam/private/bodyimpl.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/parameters.h>
#include <math.h>

#define BOTH_RIGID "%sbody1_young and %sbody2_young: both bodies are rigid, at least one must be elastic"

static const char *const prefixes[2] = {"body1_", "body2_"};
#define LEAST_FILM 1e-7 /* relative to Young's modulus; a softer film is softer than any solid between metals */
#define FILM(k)    offsetof(struct _n_SamPair, film[k])
static const SamOptionRow films[2] = {
  {"film_thickness", "thickness () of a film between the surfaces, which shear displaces", SAM_OPTION_REAL, FILM(0),
   .range = SAM_RANGE_POSITIVE, .unit = "m", .needs = "film_shear", .recorded = PETSC_TRUE},
  {"film_shear", "its shear modulus", SAM_OPTION_REAL, FILM(1), .range = SAM_RANGE_POSITIVE, .unit = "Pa",
   .needs = "film_thickness", .recorded = PETSC_TRUE}};

static PetscBool AreRigid(const SamBody body[2])
{
  return SamBodyIsRigid(body[0]) && SamBodyIsRigid(body[1]) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SamPairCreate(SamBody body1, SamBody body2, SamPair *pair)
{
  const SamBody body[2] = {body1, body2};
  PetscReal     inverse_shear[2], nu[2]; /* 1/G and Poisson's ratio at the surface; 1/G is zero for a rigid body */
  SamPair       p;

  PetscFunctionBegin;
  SamValidHandle(body1, SamBody, 1);
  SamValidHandle(body2, SamBody, 2);
  SamValidPointer(pair, 3);
  PetscCheck(!AreRigid(body), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, BOTH_RIGID, "", "");
  PetscCall(PetscNew(&p));
  p->class_id   = SamPair_CLASSID;
  p->references = 1;
  for (int b = 0; b < 2; b++) {
    const PetscReal E = body[b]->material[0].young;

    PetscCall(SamBodyReference(body[b]));
    p->body[b]       = body[b];
    nu[b]            = body[b]->material[0].poisson;
    inverse_shear[b] = isinf(E) ? 0 : 2 * (1 + nu[b]) / E;
  }
  p->normal   = ((1 - nu[0]) * inverse_shear[0] + (1 - nu[1]) * inverse_shear[1]) / (2 * PETSC_PI);
  p->shear    = p->normal;
  p->shear_xx = (nu[0] * inverse_shear[0] + nu[1] * inverse_shear[1]) / (2 * PETSC_PI);
  p->coupling = ((1 - 2 * nu[0]) * inverse_shear[0] - (1 - 2 * nu[1]) * inverse_shear[1]) / (4 * PETSC_PI);
  p->modulus  = 1 / (PETSC_PI * p->normal);
  p->dundurs  = p->coupling / p->normal;
  *pair       = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairReference(SamPair pair)
{
  PetscFunctionBegin;
  pair->references++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairDestroy(SamPair *pair)
{
  SamPair p;

  PetscFunctionBegin;
  SamValidPointer(pair, 1);
  if (!*pair) PetscFunctionReturn(PETSC_SUCCESS);
  SamValidHandle(*pair, SamPair, 1);
  p     = *pair;
  *pair = NULL;
  if (--p->references > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (int b = 0; b < 2; b++) PetscCall(SamBodyDestroy(&p->body[b]));
  p->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates a pair of bodies that no other object refers to. */
static PetscErrorCode CreateOf(SamBody body[2], SamPair *pair)
{
  PetscFunctionBegin;
  PetscCall(SamPairCreate(body[0], body[1], pair));
  for (int b = 0; b < 2; b++) PetscCall(SamBodyDestroy(&body[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamBody SamPairBody(SamPair pair, PetscInt body)
{
  return pair->body[body];
}

double SamPairStiffest(SamPair pair)
{
  double compliance = 0;

  for (PetscInt b = 0; b < 2; b++) {
    const SamBody body  = SamPairBody(pair, b);
    double        least = INFINITY;

    for (PetscInt n = 1; n <= SamBodyCount(body); n++) {
      const SamMaterial *m = SamBodyMaterialAt(body, SamBodyTop(body, n)); /* interfaces: that above */

      least = PetscMin(least, (1 - (double)(m->poisson * m->poisson)) / (double)m->young);
    }
    compliance += least;
  }
  return 1 / compliance;
}

PetscReal SamPairModulus(SamPair pair)
{
  return pair->modulus;
}

PetscReal SamPairFilm(SamPair pair)
{
  return pair->film[0] > 0 ? pair->film[0] / pair->film[1] : 0;
}

PetscBool SamPairIsUniform(SamPair pair)
{
  return pair->body[0]->count == 1 && pair->body[1]->count == 1 ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool SamPairIsCoupled(SamPair pair)
{
  const SamBody a = pair->body[0], b = pair->body[1];

  /* Bodies of equal materials cancel without rounding; others may leave rounding. */
  if (SamPairIsUniform(pair)) return PetscAbsReal(pair->dundurs) > 1e-14 ? PETSC_TRUE : PETSC_FALSE;
  if (a->count != b->count) return PETSC_TRUE;
  for (PetscInt n = 0; n < a->count; n++)
    if (a->material[n].young != b->material[n].young || a->material[n].poisson != b->material[n].poisson ||
        a->material[n].thickness != b->material[n].thickness)
      return PETSC_TRUE;
  return PETSC_FALSE;
}

double SamPairCoupling(SamPair pair, double first, double last)
{
  enum { SAMPLES = 32 };
  double most = 0;

  if (SamPairIsUniform(pair)) return fabs((double)pair->dundurs);
  for (int m = 0; m < SAMPLES; m++) {
    double total[SAM_WAVE_SYMBOLS], difference[SAM_WAVE_SYMBOLS];

    SamPairSymbols(pair, first * pow(last / first, (double)m / (SAMPLES - 1)), total, difference);
    most = PetscMax(most, fabs(total[SAM_WAVE_ZR]) / total[SAM_WAVE_ZZ]);
  }
  return most;
}

/* ---- options and parameters ---- */

/* Rejects a shear modulus of the film that is likely to be in another unit. */
static PetscErrorCode CheckFilm(const SamOptions *from, SamPair p)
{
  const double young =
    (double)PetscMin(SamBodyMaterialAt(p->body[0], 0)->young, SamBodyMaterialAt(p->body[1], 0)->young);
  char why[160];

  PetscFunctionBegin;
  SamExplainStress((double)p->film[1], young, LEAST_FILM, INFINITY, why, sizeof(why));
  PetscCheck(!why[0], from->comm, SAM_ERR_USER, "-%s%s %.6g: %s", SamOptionsPrefix(from), films[1].name,
             (double)p->film[1], why);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairCreateFromOptions(const SamOptions *from, SamPair *pair)
{
  const char *const prefix = SamOptionsPrefix(from);
  SamBody           body[2];
  char              own[2][SAM_PREFIX + 8], dash[SAM_PREFIX + 2];

  PetscFunctionBegin;
  PetscCall(SamOptionsHeading(from, "Bodies"));
  for (int b = 0; b < 2; b++) {
    const SamOptions of = {from->comm, own[b]};

    PetscCall(PetscSNPrintf(own[b], sizeof(own[b]), "%s%s", prefix, prefixes[b]));
    SamOptionsKnow(from, b ? "body2" : "body1", NULL);
    SamOptionsKnow(&of, "young", NULL); /* options of one body are not misspellings of the other's */
    SamOptionsKnow(&of, "poisson", NULL);
  }
  for (int b = 0; b < 2; b++) PetscCall(SamBodyCreateFromOptions(&(SamOptions){from->comm, own[b]}, &body[b]));
  PetscCall(PetscSNPrintf(dash, sizeof(dash), "-%s", prefix));
  PetscCheck(!AreRigid(body), from->comm, SAM_ERR_USER, BOTH_RIGID, dash, dash);
  PetscCall(CreateOf(body, pair));
  PetscCall(SamOptionsRead(from, NULL, SAM_OPTION_ROWS(films), *pair, NULL));
  PetscCall(CheckFilm(from, *pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairAddParameters(SamPair pair, SamParameters *p)
{
  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) PetscCall(SamBodyAddParameters(pair->body[b], prefixes[b], p));
  if (pair->film[0] > 0) PetscCall(SamParametersAddOptions(p, SAM_OPTION_ROWS(films), pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairCreateFromParameters(MPI_Comm comm, const SamParameters *p, const char source[], SamPair *pair)
{
  SamBody body[2];

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) PetscCall(SamBodyCreateFromParameters(comm, p, prefixes[b], source, &body[b]));
  PetscCheck(!AreRigid(body), comm, SAM_ERR_FILE, "%s: cannot be read: " BOTH_RIGID, source, "", "");
  PetscCall(CreateOf(body, pair));
  for (int k = 0; k < 2; k++) {
    const SamParameter *found = SamParametersFind(p, films[k].name);

    if (found && found->count == 1) (*pair)->film[k] = found->value[0];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
