/* Elastic constants of a pair of bodies. */
#include <petsam/private/baseimpl.h>
#include <petsam/material.h>
#include <math.h>

/* The fault of invalid constants: a message that names the constant with a prefix; empty without fault. */
static PetscErrorCode FindFault(const PetscReal young[2], const PetscReal poisson[2], const char prefix[],
                                char message[], size_t size)
{
  PetscFunctionBegin;
  message[0] = '\0';
  for (int b = 0; b < 2 && !message[0]; b++) {
    const PetscReal inverse_shear = isinf(young[b]) ? 0 : 2 * (1 + poisson[b]) / young[b];

    if (!(young[b] > 0))
      PetscCall(PetscSNPrintf(message, size, "%sbody%d_young %.6g: expected a number > 0 or inf", prefix, b + 1,
                              (double)young[b]));
    else if (!(poisson[b] > -1 && poisson[b] <= 0.5))
      PetscCall(PetscSNPrintf(message, size, "%sbody%d_poisson %.6g: expected a number above -1 and at most 0.5%s",
                              prefix, b + 1, (double)poisson[b], poisson[b] > 1 ? ": 0.3, not 30 percent" : ""));
    else if (!isfinite(inverse_shear) || (inverse_shear == 0 && !isinf(young[b])))
      PetscCall(PetscSNPrintf(message, size, "%sbody%d_young %.6g: its compliance is out of range in double precision",
                              prefix, b + 1, (double)young[b]));
  }
  if (!message[0] && isinf(young[0]) && isinf(young[1]))
    PetscCall(PetscSNPrintf(message, size,
                            "%sbody1_young and %sbody2_young: both bodies are rigid, at least one must be elastic",
                            prefix, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairSet(SamPair *pair, const PetscReal young[2], const PetscReal poisson[2])
{
  PetscReal inverse_shear[2]; /* 1/G, zero for a rigid body */
  char      message[256];

  PetscFunctionBegin;
  PetscCall(FindFault(young, poisson, "", message, sizeof(message)));
  PetscCheck(!message[0], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "%s", message);
  for (PetscInt b = 0; b < 2; b++) {
    inverse_shear[b] = isinf(young[b]) ? 0 : 2 * (1 + poisson[b]) / young[b];
    pair->young[b]   = young[b];
    pair->poisson[b] = poisson[b];
  }
  pair->normal   = ((1 - poisson[0]) * inverse_shear[0] + (1 - poisson[1]) * inverse_shear[1]) / (2 * PETSC_PI);
  pair->shear    = pair->normal;
  pair->shear_xx = (poisson[0] * inverse_shear[0] + poisson[1] * inverse_shear[1]) / (2 * PETSC_PI);
  pair->coupling = ((1 - 2 * poisson[0]) * inverse_shear[0] - (1 - 2 * poisson[1]) * inverse_shear[1]) / (4 * PETSC_PI);
  pair->modulus  = 1 / (PETSC_PI * pair->normal);
  pair->dundurs  = pair->coupling / pair->normal;
  pair->film[0] = pair->film[1] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SamPairFilm(const SamPair *pair)
{
  return pair->film[0] > 0 ? pair->film[0] / pair->film[1] : 0;
}

/* Options and parameters: of both bodies Young's moduli, then Poisson's ratios. */
static const char *const names[] = {"body1_young", "body2_young", "body1_poisson", "body2_poisson"};
static const char *const films[] = {"film_thickness", "film_shear"};

PetscErrorCode SamPairAddParameters(const SamPair *pair, SamParameters *p)
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    PetscCall(SamParametersAddReals(p, names[b], PETSC_TRUE, 1, &pair->young[b]));
    PetscCall(SamParametersAddReals(p, names[2 + b], PETSC_TRUE, 1, &pair->poisson[b]));
  }
  for (PetscInt k = 0; k < 2 && pair->film[0] > 0; k++)
    PetscCall(SamParametersAddReals(p, films[k], PETSC_TRUE, 1, &pair->film[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairSetFromParameters(SamPair *pair, MPI_Comm comm, const SamParameters *p, const char source[])
{
  PetscReal value[4];
  char      message[256];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 4; k++) {
    const SamParameter *found = SamParametersFind(p, names[k]);

    PetscCheck(found && found->count == 1, comm, SAM_ERR_FILE, "%s: cannot be read: it lacks the attribute %s", source,
               names[k]);
    value[k] = found->value[0];
  }
  PetscCall(FindFault(value, value + 2, "", message, sizeof(message)));
  PetscCheck(!message[0], comm, SAM_ERR_FILE, "%s: cannot be read: %s", source, message);
  PetscCall(SamPairSet(pair, value, value + 2));
  for (PetscInt k = 0; k < 2; k++) {
    const SamParameter *found = SamParametersFind(p, films[k]);

    if (found && found->count == 1) pair->film[k] = found->value[0];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairSetFromOptions(SamPair *pair, const SamOptions *from)
{
  PetscReal young[2] = {0, 0}, poisson[2] = {0, 0};
  PetscBool has_young, has_poisson, help;
  char      message[256], prefix[80];

  PetscFunctionBegin;
  PetscCall(SamPrintHelp(&help));
  PetscCall(SamOptionsHeading(from, "Bodies"));
  for (PetscInt k = 0; k < 4; k++)
    SamOptionsKnow(from, names[k], NULL); /* one body's are no misspelling of the other's */
  for (PetscInt b = 0; b < 2; b++) {
    const char *name = names[b];

    PetscCall(SamOptionsReal(from, name, "Young's modulus (Pa), inf: rigid: required", SAM_RANGE_POSITIVE_INF,
                             &young[b], &has_young));
    PetscCall(
      SamOptionsRequire(from, has_young || help, name, "Young's modulus, Pa (210e9 for steel), or inf: a rigid body"));
    name = names[2 + b];
    PetscCall(
      SamOptionsReal(from, name, "Poisson's ratio: required unless rigid", SAM_RANGE_ANY, &poisson[b], &has_poisson));
    PetscCall(SamOptionsRequire(from, has_poisson || isinf(young[b]) || help, name,
                                "Poisson's ratio (0.3 for steel; not needed for a rigid body)"));
  }
  if (help) young[0] = young[1] = 1;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "-%s", SamOptionsPrefix(from)));
  PetscCall(FindFault(young, poisson, prefix, message, sizeof(message)));
  PetscCheck(!message[0], from->comm, SAM_ERR_USER, "%s", message);
  PetscCall(SamPairSet(pair, young, poisson));
  PetscCall(SamOptionsReal(from, films[0], "thickness (m) of a film between the surfaces, which shear displaces",
                           SAM_RANGE_POSITIVE, &pair->film[0], &has_young));
  PetscCall(SamOptionsReal(from, films[1], "its shear modulus (Pa)", SAM_RANGE_POSITIVE, &pair->film[1], &has_poisson));
  PetscCheck(has_young == has_poisson, from->comm, SAM_ERR_USER,
             "%s%s is given without %s%s: a film has both: give both", prefix, films[has_young ? 0 : 1], prefix,
             films[has_young ? 1 : 0]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
