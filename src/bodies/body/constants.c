/* The constants of two uniform bodies to which their displacements are proportional, and their derivatives. */
#include <petsam/private/bodyimpl.h>
#include <petsam/private/body.h>
#include <math.h>

#define CHANGE 0.1 /* of Poisson's ratio: displacements and stresses are linear in it, for any size */

void SamPairGetValues(SamPair pair, double value[SAM_PAIR_CONSTANTS])
{
  value[0] = (double)pair->normal;
  value[1] = (double)pair->shear_xx;
  value[2] = (double)pair->coupling;
}

const char *SamPairGetConstants(SamPair pair, SamPairConstants *c)
{
  const char *why = SamPairFilm(pair) > 0 ? "there is a film between the bodies" : NULL;

  *c = (SamPairConstants){.value = {0}};
  SamPairGetValues(pair, c->value);
  for (int b = 0; b < 2; b++) {
    const SamMaterial *m = pair->body[b]->material;
    const double       e = PETSC_PI * (double)m->young, nu = (double)m->poisson, sign = b ? -1 : 1;
    const double       of[] = {1 - nu * nu, nu * (1 + nu), 0.5 * sign * (1 + nu) * (1 - 2 * nu)},
                 slope[]    = {-2 * nu, 1 + 2 * nu, -0.5 * sign * (1 + 4 * nu)};

    if (pair->body[b]->count > 1) why = "a body has layers";
    if (isinf(m->young)) why = "a body is rigid";
    c->modulus[2 * b]     = (double)m->young;
    c->modulus[2 * b + 1] = nu;
    for (int n = 0; n < SAM_PAIR_CONSTANTS; n++) {
      c->by[n][2 * b]     = -of[n] / e / (double)m->young;
      c->by[n][2 * b + 1] = slope[n] / e;
    }
  }
  return why;
}

/* Creates the pair of two half-spaces. */
static PetscErrorCode CreatePair(const SamMaterial material[2], SamPair *pair)
{
  SamBody body[2];

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++) PetscCall(SamBodyCreate(1, &material[b], &body[b]));
  PetscCall(SamPairCreate(body[0], body[1], pair));
  for (int b = 0; b < 2; b++) PetscCall(SamBodyDestroy(&body[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairCreateOther(SamPair pair, SamPair *other)
{
  const PetscBool   large       = pair->shear_xx > 0.2 * pair->normal ? PETSC_TRUE : PETSC_FALSE; /* Poisson's ratio */
  const SamMaterial material[2] = {{.young = 1 / (PETSC_PI * pair->normal), .poisson = large ? 0 : 0.4},
                                   {.young = PETSC_INFINITY}};

  PetscFunctionBegin;
  PetscCall(CreatePair(material, other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPairCreateChanged(SamPair pair, PetscInt which, SamPair *changed, double *change)
{
  SamMaterial material[2] = {*pair->body[0]->material, *pair->body[1]->material};

  PetscFunctionBegin;
  *change = material[which].poisson > 0.25 ? -CHANGE : CHANGE;
  material[which].poisson += *change;
  PetscCall(CreatePair(material, changed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
