/*
  Bulk stress: a uniform stress of a body, parallel to its surface, without stress normal to it. It stretches the
  surface about x = y = 0 by Hooke's law; tension is positive.
*/
#include <petsam/private/law.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/stresspart.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <math.h>

enum { XX, YY, XY, COMPONENTS };

const char *SamBulkName(PetscInt k)
{
  static const char *const names[SAM_BULKS] = {"bulk1_stress_xx", "bulk1_stress_yy", "bulk1_stress_xy",
                                               "bulk2_stress_xx", "bulk2_stress_yy", "bulk2_stress_xy"};

  return names[k];
}

typedef struct {
  const SamCondition *of[2][COMPONENTS]; /* conditions by body and component */
} Bulk;

static PetscErrorCode AddConditions(SamLaw law, SamConditions conditions)
{
  char text[64];

  PetscFunctionBegin;
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < COMPONENTS; k++) {
      const char *const  name = SamBulkName(body * COMPONENTS + k);
      const SamCondition one  = {.name     = name,
                                 .unit     = "Pa",
                                 .text     = text,
                                 .group    = "bulk stress",
                                 .range    = SAM_RANGE_ANY,
                                 .option   = PETSC_TRUE,
                                 .reverses = PETSC_TRUE};

      (void)snprintf(text, sizeof(text), "bulk stress %s of body %d, tension positive", strrchr(name, '_') + 1,
                     (int)body + 1);
      PetscCall(SamConditionsAdd(conditions, &one, &((Bulk *)law->data)->of[body][k]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the bulk stress of body 0 or 1 in a step, Pa. */
static void Get(SamLaw law, const SamControl *control, PetscInt body, PetscReal stress[COMPONENTS])
{
  for (PetscInt k = 0; k < COMPONENTS; k++) stress[k] = SamControlGet(control, ((const Bulk *)law->data)->of[body][k]);
}

/*
  Bulk stress must be 0 in a rigid body; in periodic bodies, which would not be periodic when stretched; and in steady
  rolling, where a uniform strain is a creepage. In plane strain the stress along y follows from that along x.
*/
static PetscErrorCode CheckComponent(SamLaw law, PetscInt body, PetscInt k, const PetscReal all[], SamControl *control,
                                     char why[], size_t size)
{
  const SamCondition *one    = ((const Bulk *)law->data)->of[body][k];
  const double        stress = (double)all[k];
  double              follows;
  SamElasticityTraits traits;
  SamBodyPlace        m;

  PetscFunctionBegin;
  m       = SamBodyAt(SamPairBody(SamElasticityGetPair(law->elasticity), body), INFINITY);
  traits  = SamElasticityGetTraits(law->elasticity);
  follows = k == YY ? 0 + m.poisson * all[XX] : 0; /* avoids -0 */
  if (traits.plane && k != XX && (stress == 0 || stress == follows))
    SamControlSetCondition(control, one, follows);
  else if (stress != 0 && isinf(m.young))
    (void)snprintf(why, size, "body%d_young is inf: a rigid body does not stretch", (int)body + 1);
  else if (!(fabs(stress) <= m.young))
    SamExplainStress(stress, (double)m.young, 0, 1, why, size);
  else if (stress != 0 && SamMotionOf(law->elasticity)->streams)
    (void)snprintf(why, size, "has no meaning with -rolling steady: a uniform strain is a creepage: add it to creep_x");
  else if (stress != 0 && !traits.stretch)
    (void)snprintf(why, size, "has no meaning with bodies of type %s, which bear none",
                   SamElasticityGetType(law->elasticity));
  else if (stress != 0 && traits.plane && k != XX)
    (void)snprintf(why, size, "has no meaning in plane strain, where yy follows from xx, and there is no xy: give %s",
                   SamBulkName(body * COMPONENTS + XX));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Check(SamLaw law, SamControl *control, PetscInt *wrong, char why[], size_t size)
{
  PetscReal stress[COMPONENTS];

  PetscFunctionBegin;
  for (PetscInt body = 0; body < 2 && !why[0]; body++) {
    Get(law, control, body, stress);
    for (PetscInt k = 0; k < COMPONENTS && !why[0]; k++) {
      *wrong = SAM_COMPONENTS + ((const Bulk *)law->data)->of[body][k]->place;
      PetscCall(CheckComponent(law, body, k, stress, control, why, size));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Displace(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, SamStrain *e,
                               PetscBool *adds)
{
  PetscReal s[COMPONENTS];

  PetscFunctionBegin;
  (void)state;
  (void)u_z;
  (void)u_t;
  (void)adds;
  if (!e) PetscFunctionReturn(PETSC_SUCCESS);
  for (int body = 0; body < 2; body++) {
    const SamBodyPlace m  = SamBodyAt(SamPairBody(SamElasticityGetPair(law->elasticity), body), INFINITY);
    const PetscReal    nu = m.poisson, sign = body ? 1 : -1;

    Get(law, control, body, s);
    e->xx += sign * (s[XX] - nu * s[YY]) / m.young;
    e->yy += sign * (s[YY] - nu * s[XX]) / m.young;
    e->xy += sign * (1 + nu) * s[XY] / m.young;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the bulk stress: the last material of the body has it, the materials above it have the same strain in the
   plane. */
static void AddUniform(SamStressPart part, PetscInt step, PetscReal depth, double stress[SAM_STRESS_COMPONENTS])
{
  const SamBodyPlace m = SamBodyAt(part->body, depth), last = SamBodyAt(part->body, INFINITY);
  PetscReal          s[COMPONENTS];

  for (PetscInt k = 0; k < COMPONENTS; k++) {
    const char *const name = SamBulkName((part->places->body - 1) * COMPONENTS + k);

    s[k] = SamControlGet(&part->control[step], SamConditionsFind(part->conditions, name));
  }
  if (!m.last && !isinf(last.young)) {
    const double nu = (double)last.poisson, own = (double)m.poisson, ratio = (double)(m.young / last.young);
    const double xx = s[XX] - nu * s[YY], yy = s[YY] - nu * s[XX];

    s[XX] = ratio * (xx + own * yy) / (1 - own * own);
    s[YY] = ratio * (yy + own * xx) / (1 - own * own);
    s[XY] = ratio * (1 + nu) / (1 + own) * s[XY];
  }
  stress[SAM_STRESS_XX] += s[XX];
  stress[SAM_STRESS_YY] += s[YY];
  stress[SAM_STRESS_XY] += s[XY];
}

static PetscErrorCode CreatePart(SamStressPart part)
{
  PetscFunctionBegin;
  part->ops.uniform = AddUniform;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamStressPartType SamStressPart_Bulk = {.name = "bulk stress", .create = CreatePart};

PetscErrorCode SamLawCreate_BulkStress(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(PetscNew((Bulk **)&law->data));
  law->always         = PETSC_TRUE;
  law->any_motion     = PETSC_TRUE;
  law->strains        = PETSC_TRUE;
  law->ops.conditions = AddConditions;
  law->ops.check      = Check;
  law->ops.displace   = Displace;
  law->ops.back       = SamLawNoBack;
  PetscFunctionReturn(PETSC_SUCCESS);
}
