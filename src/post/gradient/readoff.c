/*
  Derivatives by the parameters, read off the cotangents of a step: see gradient.c.

  The displacements of uniform bodies are proportional to three constants (SamPairConstants),
      S = A Ir,   C = A Ir + B (Ixx, Ixy; Ixy, Iyy),   X = D (Ix, Iy),
  so that the derivatives by A, B and D follow from the products of the tractions with the bodies themselves, and with
  others, of which only the constants differ: two equations give those by A and B, and the coupling gives that by D,
  even where the bodies are similar and D is 0.
*/
#include "gradientimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/problemimpl.h>
#include <math.h>

/* ---- sums over the cells ---- */

/* Sums of the cotangents with the rigid motions and the stretches */
enum { GAMMA, GAMMA_X, GAMMA_Y, TAU_X, TAU_Y, X_TAU_X, Y_TAU_Y, Y_TAU_X, X_TAU_Y, SUMS };

static PetscErrorCode SumMotions(const SamBack *b, double sums[SUMS])
{
  const SamGrid g            = b->grid;
  SamTotal      totals[SUMS] = {{0}};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < g->rows; j++) {
    const double y         = (double)SamGridY(g, g->row_start + j);
    double       row[SUMS] = {0};

    for (PetscInt i = 0; i < g->nx; i++) {
      const PetscInt k = j * g->nx + i;
      const double   x = (double)SamGridX(g, i), tx = b->tau[k], ty = b->tau[k + g->cells],
                   one[SUMS] = {b->gamma[k], x * b->gamma[k], y * b->gamma[k], tx, ty, x * tx, y * ty, y * tx, x * ty};

      for (int n = 0; n < SUMS; n++) row[n] += one[n];
    }
    SamAddAll(SUMS, totals, row);
  }
  PetscCall(SamSumTotals(g->comm, SUMS, totals, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- stretches ---- */

/* Adds the derivatives by the bulk stresses, and gets those through the stretch, which is linear in them. In plane
   strain yy is nu xx. */
static PetscErrorCode ReadBulk(SamBack *b, PetscInt step, const double sums[SUMS], double stretch[SAM_GRADIENT_BULKS])
{
  const SamProblem    problem = SamContactGetProblem(b->g->contact);
  const SamConditions all     = SamProblemGetConditions(problem);
  SamDerivatives     *d       = &b->g->found;
  double             *by      = b->at.by_bulk;
  SamPairConstants    own;

  PetscFunctionBegin;
  (void)SamPairGetConstants(SamElasticityGetPair(b->elasticity), &own);
  for (PetscInt k = 0; k < SAM_GRADIENT_BULKS && SamElasticityGetTraits(b->elasticity).plane; k += 3) {
    by[k] += own.modulus[2 * (k / 3) + 1] * by[k + 1];
    by[k + 1] = 0;
  }
  for (PetscInt k = 0; k < SAM_GRADIENT_BULKS; k++) {
    SamControl control = {.force = {PETSC_FALSE}};
    SamStrain  strain  = {0};
    PetscInt   wrong;
    char       why[SAM_MESSAGE] = "";

    SamControlSetCondition(&control, SamConditionsFind(all, SamBulkName(k)), 1);
    PetscCall(SamProblemCheckControl(problem, &control, &wrong, why, sizeof(why)));
    /* some bodies bear no such stress */
    if (!why[0]) PetscCall(SamProblemDisplace(problem, NULL, &control, NULL, NULL, &strain, NULL));
    stretch[k] = sums[X_TAU_X] * strain.xx + sums[Y_TAU_Y] * strain.yy + (sums[Y_TAU_X] + sums[X_TAU_Y]) * strain.xy;
    d->bulk[b->g->record[step].row][k] += by[k] + stretch[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- moduli ---- */

/* Adds the derivatives by the moduli of what bulk stresses stretch. */
static void ReadStretch(SamBack *b, PetscInt step, const SamPairConstants *own, const double sums[SUMS],
                        const double stretch[SAM_GRADIENT_BULKS])
{
  const PetscBool plane = SamElasticityGetTraits(b->elasticity).plane;

  for (PetscInt k = 0; k < SAM_GRADIENT_BULKS; k++) {
    const PetscInt body  = k / 3;
    const double   young = own->modulus[2 * body], nu = own->modulus[2 * body + 1], sign = body ? 1 : -1;
    const double   stress = (double)b->g->record[step].bulk[k], shear = sums[Y_TAU_X] + sums[X_TAU_Y];
    const double   by_nu[] = {plane ? -2 * nu * sums[X_TAU_X] : -sums[Y_TAU_Y], plane ? 0 : -sums[X_TAU_X], shear};

    b->g->found.moduli[2 * body] -= stretch[k] * stress / young;
    b->g->found.moduli[2 * body + 1] += sign * by_nu[k % 3] * stress / young;
  }
}

/* Products of the cotangents with the displacements by the tractions */
typedef struct {
  double normal, tangential, coupling;
} Products;

static PetscErrorCode FindProducts(const SamBack *b, SamElasticity e, PetscBool coupled, Products *found)
{
  const SamGrid g = b->grid;
  const double *values;
  double        more, of_open = 0;
  Vec           p, q, u, v;
  double       *to;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, 1, &p));
  PetscCall(SamGridCreateVec(g, 2, &q));
  PetscCall(SamGridCreateVec(g, 1, &u));
  PetscCall(SamGridCreateVec(g, 2, &v));
  for (int c = 0; c < 2; c++) {
    const Vec field = c ? q : p;

    PetscCall(VecGetArrayWrite(field, &to));
    PetscCall(PetscArraycpy(to, c ? b->at.shear : b->at.pressure, (c + 1) * g->cells));
    PetscCall(VecRestoreArrayWrite(field, &to));
  }
  for (int n = 0; n < 4; n++) {
    const PetscBool tangential = n == 1 || n == 2; /* the displacement */
    double         *sum        = n == 0 ? &found->normal : n == 1 ? &found->tangential : &found->coupling;
    PetscErrorCode (*const apply[])(SamElasticity, Vec, Vec) = {SamElasticityApplyNormal, SamElasticityApplyTangential,
                                                                SamElasticityApplyNormalToTangential,
                                                                SamElasticityApplyTangentialToNormal};

    if (n == 2 && !coupled) break;
    PetscCall((*apply[n])(e, n == 0 || n == 2 ? p : q, tangential ? v : u));
    PetscCall(VecGetArrayRead(tangential ? v : u, &values));
    PetscCall(SamGridDot(g, tangential ? 2 : 1, tangential ? b->tau : b->gamma, values, n == 3 ? &more : sum));
    if (!tangential) PetscCall(SamGridDot(g, 1, b->at.by_open, values, &of_open));
    PetscCall(VecRestoreArrayRead(tangential ? v : u, &values));
    if (n == 0) found->normal += of_open;
    if (n == 3) found->coupling += more + of_open;
  }
  PetscCall(VecDestroy(&p));
  PetscCall(VecDestroy(&q));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadModuli(SamBack *b, PetscInt step, const double sums[SUMS],
                                 const double stretch[SAM_GRADIENT_BULKS])
{
  enum { A, B, D };
  SamPairConstants own, other;
  Products         of_own, of_other;
  double           by[SAM_PAIR_CONSTANTS], determinant;

  PetscFunctionBegin;
  (void)SamPairGetConstants(SamElasticityGetPair(b->elasticity), &own);
  SamPairGetValues(SamElasticityGetPair(b->other), other.value);
  PetscCall(FindProducts(b, b->elasticity, PETSC_FALSE, &of_own));
  PetscCall(FindProducts(b, b->other, PETSC_TRUE, &of_other));
  determinant = own.value[A] * other.value[B] - own.value[B] * other.value[A];
  by[A]       = (of_own.tangential * other.value[B] - of_other.tangential * own.value[B]) / determinant +
          of_own.normal / own.value[A];
  by[B] = (own.value[A] * of_other.tangential - other.value[A] * of_own.tangential) / determinant;
  by[D] = of_other.coupling / other.value[D];
  by[A] += b->by_modulus / own.value[A];
  for (int c = 0; c < 2; c++) { /* kappa = 1 + part B/A (contact/step/entering.c) */
    const double part = SamElasticityGetTraits(b->elasticity).plane ? c : 0.5;

    by[A] -= b->kappa[c] * part * own.value[B] / (own.value[A] * own.value[A]);
    by[B] += b->kappa[c] * part / own.value[A];
  }
  for (PetscInt k = 0; k < SAM_GRADIENT_MODULI; k++)
    for (int n = 0; n < SAM_PAIR_CONSTANTS; n++) b->g->found.moduli[k] += by[n] * own.by[n][k];
  for (PetscInt k = 0; k < SAM_GRADIENT_MODULI; k++) b->g->found.moduli[k] += b->at.by_moduli[k];
  ReadStretch(b, step, &own, sums, stretch);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all ---- */

PetscErrorCode SamBackRead(SamBack *b, PetscInt step)
{
  const SamGrid  g   = b->grid;
  const PetscInt row = b->g->record[step].row;
  double         sums[SUMS], stretch[SAM_GRADIENT_BULKS], *rigid = b->g->found.rigid[row];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < g->cells; k++) {
    b->at.by_gap[k] += b->gamma[k];
    b->at.by_worn[k] += b->gamma[k];
    b->at.by_friction[k] += b->at.pressure[k] * b->beta[k];
  }
  PetscCall(SumMotions(b, sums));
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) b->g->found.load[row][c] += b->forces[c] + b->at.by_load[c];
  rigid[SAM_COMPONENT_N] += -sums[GAMMA];
  rigid[SAM_COMPONENT_MX] += sums[GAMMA_Y];
  rigid[SAM_COMPONENT_MY] += -sums[GAMMA_X];
  rigid[SAM_COMPONENT_TX] += -sums[TAU_X];
  rigid[SAM_COMPONENT_TY] += -sums[TAU_Y];
  rigid[SAM_COMPONENT_MZ] += sums[Y_TAU_X] - sums[X_TAU_Y];
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) rigid[c] += b->at.by_rigid[c];
  sums[X_TAU_X] += b->strain[0];
  sums[Y_TAU_Y] += b->strain[1];
  sums[Y_TAU_X] += b->strain[2];
  PetscCall(ReadBulk(b, step, sums, stretch));
  if (b->other) PetscCall(ReadModuli(b, step, sums, stretch));
  PetscCall(PetscArrayzero(b->at.by_open, g->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}
