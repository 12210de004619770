/*
  Plastic strain and contact together, by Newton's method.

  The unknown is the driver d in each cell of each layer. The material gives the plastic strain e(d) (mises.c), e gives
  the displacement of the surfaces, the contact on these gives the tractions p, and e and p give the stress. So the
  residual is
      r = e + dev(R e + K p)/(2 mu) - d.
  With P = de/dd, S the contact's stiffness on frozen sets of cells (reaction.c), and Bc = 1 + dev(R - K S K')/(2 mu), a
  step solves (1 - Bc P) delta = r in the symmetric form
      (1 - Q Bc Q) y = Q r,  delta = r + Bc Q y,  Q = root of P,
  by conjugate gradients in the product sum 2 mu h a:b (equations.c). The matrix is positive definite: 0 <= P < 1, R is
  negative semidefinite, and 1 + R/(2 mu) as well as S positive semidefinite; only slipping cells make S unsymmetric. A
  step is halved until the residual falls.

  Source: J. C. Simo and T. J. R. Hughes, Computational Inelasticity (1998), chapter 3, for the tangent; A. Frerot, M.
  Bonnet, J.-F. Molinari and G. Anciaux, Comput. Methods Appl. Mech. Engrg. 351 (2019) 951, for the integral equation.
*/
#include "equations.h"
#include <petsc/private/petscimpl.h> /* PetscObjectStateGet() */

#define STEPS    30   /* maximum number of steps of Newton's method */
#define HALVINGS 8    /* maximum number in one step */
#define ROUGH    0.1  /* a step's equations are solved at least to this part, */
#define FORCING  0.3  /* and to this part of the residual relative to its first value, */
#define ENOUGH   0.1  /* but not below this part of the largest residual's tolerance, */
#define SLIPPING 1e-3 /* nor below this part where cells slip: the reaction is solved to it */

/* An iteration under way; its fields are of all layers. */
typedef struct _n_SamPlasticWork {
  SamPlastic    *plastic;
  SamLawContact *contact;
  PetscInt       n;                         /* values of a field on this rank */
  double        *d, *r, *e, *s, *y, *start; /* driver, residual, strain, stress; step, driver from which it starts */
  SamTangent     tangent;
  SamReaction    reaction;
  PetscInt       steps, halvings;     /* number of steps so far, and of halvings of the last one */
  double         length;              /* part of the step that is tried */
  double         first, before, norm; /* norms of the residual: the first one, before the step, now */
  double         largest;             /* largest residual relative to the strain at yield */
} Solve;

static inline const SamPlasticBody *BodyOf(const SamPlastic *p, PetscInt l)
{
  return &p->body[l / p->layers];
}

static inline PetscReal ThicknessOf(const SamPlastic *p, PetscInt l)
{
  return p->thickness[l % p->layers];
}

void SamPlasticRead(const SamPlastic *p, const double state[], PetscInt l, PetscInt k, SamMisesAt *at)
{
  const double *from = state + (ptrdiff_t)l * p->size * p->grid->cells + k;

  for (PetscInt c = 0; c < PARTS; c++) at->e[c] = from[(ptrdiff_t)c * p->grid->cells];
  at->p = PetscMax(from[(ptrdiff_t)PARTS * p->grid->cells], 0); /* cubics of moved fields fall below it */
  for (PetscInt c = PARTS + 1; c < p->size; c++) (&at->back[0][0])[c - PARTS - 1] = from[(ptrdiff_t)c * p->grid->cells];
}

static void Write(const SamPlastic *p, const SamMisesAt *at, PetscInt l, PetscInt k, double state[])
{
  double *to = state + (ptrdiff_t)l * p->size * p->grid->cells + k;

  for (PetscInt c = 0; c < PARTS; c++) to[(ptrdiff_t)c * p->grid->cells] = at->e[c];
  to[(ptrdiff_t)PARTS * p->grid->cells] = at->p;
  for (PetscInt c = PARTS + 1; c < p->size; c++) to[(ptrdiff_t)c * p->grid->cells] = (&at->back[0][0])[c - PARTS - 1];
}

/* Gets the tensor of a cell of a field. */
static inline void Take(const SamPlastic *p, const double field[], PetscInt l, PetscInt k, double to[PARTS])
{
  for (PetscInt c = 0; c < PARTS; c++) to[c] = field[((ptrdiff_t)l * PARTS + c) * p->grid->cells + k];
}
static inline void Put(const SamPlastic *p, const double from[PARTS], PetscInt l, PetscInt k, double field[])
{
  for (PetscInt c = 0; c < PARTS; c++) field[((ptrdiff_t)l * PARTS + c) * p->grid->cells + k] = from[c];
}

/* ---- the operators of all bodies ---- */

/* Begins products with a strain, whose layers are `step` fields apart, and computes the displacement by it (NULL: not
   wanted). */
static PetscErrorCode Displace(SamPlastic *p, const double e[], PetscInt step, double *const u[3])
{
  PetscFunctionBegin;
  p->begun.spectra = PETSC_FALSE;
  PetscCall(SamResidualBegin(p->bodies, p->residual, e, step, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stress by the strain of the products that have begun, and by tractions (NULL: none). */
static PetscErrorCode Respond(SamPlastic *p, const double *const traction[3], double s[])
{
  PetscFunctionBegin;
  p->begun.spectra = PETSC_FALSE;
  PetscCall(SamResidualEnd(p->bodies, p->residual, traction, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the strains of a field of the state to a field of their own. */
static PetscErrorCode TakeStrain(SamPlastic *p, Vec state, double e[])
{
  const PetscInt cells = p->grid->cells, layers = p->bodies * p->layers;
  const double  *from;

  PetscFunctionBegin;
  if (!state) PetscCall(PetscArrayzero(e, PARTS * layers * cells));
  if (!state) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(state, &from));
  for (PetscInt l = 0; l < layers; l++)
    PetscCall(PetscArraycpy(e + (ptrdiff_t)l * PARTS * cells, from + (ptrdiff_t)l * p->size * cells, PARTS * cells));
  PetscCall(VecRestoreArrayRead(state, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the displacement by this field, in its present condition, is known. */
static PetscErrorCode IsBegun(const SamPlastic *p, Vec state, PetscBool *is)
{
  PetscObjectState now;

  PetscFunctionBegin;
  *is = PETSC_FALSE;
  if (!state || state != p->begun.of) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscObjectStateGet((PetscObject)state, &now));
  *is = now == p->begun.revision ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last displacement is kept: both problems of a contact and the check ask for it, and GetDriver() ends its
   products. */
PetscErrorCode SamPlasticDisplace(SamPlastic *p, Vec state, double *const u[3])
{
  const PetscInt cells = p->grid->cells;
  const double  *e;
  double        *own[3];
  PetscBool      is;

  PetscFunctionBegin;
  PetscCall(IsBegun(p, state, &is));
  if (!p->begun.u) PetscCall(PetscMalloc1(3 * cells, &p->begun.u));
  for (PetscInt c = 0; c < 3; c++) own[c] = p->begun.u + c * cells;
  if (!is) {
    PetscCall(VecDestroy(&p->begun.of));
    PetscCall(VecGetArrayRead(state, &e));
    PetscCall(Displace(p, e, p->size, own));
    PetscCall(VecRestoreArrayRead(state, &e));
    PetscCall(PetscObjectReference((PetscObject)state));
    p->begun.of = state;
    PetscCall(PetscObjectStateGet((PetscObject)state, &p->begun.revision));
    p->begun.spectra = PETSC_TRUE;
  }
  for (PetscInt c = 0; c < 3; c++) PetscCall(PetscArraycpy(u[c], own[c], cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticForget(SamPlastic *p)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&p->begun.of));
  PetscCall(PetscFree(p->begun.u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the stress before any load to that of all layers. */
static void AddInitial(const SamPlastic *p, double s[])
{
  const PetscInt cells = p->grid->cells;

  for (PetscInt l = 0; l < p->bodies * p->layers; l++) {
    const double *const stress = p->body[l / p->layers].initial;

    for (PetscInt k = 0; k < 2 * cells && stress; k++) /* xx and yy are the first two components */
      s[(ptrdiff_t)l * PARTS * cells + k] += stress[2 * (l % p->layers) + k / cells];
  }
}

/* Adds the bulk stress of the step to that of all layers. */
static void AddBulk(const SamPlastic *p, double s[])
{
  const PetscInt cells = p->grid->cells;

  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt c = 0; c < PARTS; c++) {
      const double bulk = BodyOf(p, l)->bulk[c];

      for (PetscInt k = 0; k < cells && bulk != 0; k++) s[((ptrdiff_t)l * PARTS + c) * cells + k] += bulk;
    }
}

/* Respond() by the tractions of a contact (NULL: none), with the bulk stress of the step if there are any. */
static PetscErrorCode RespondToAll(SamPlastic *p, Vec pressure, Vec shear, double s[])
{
  const double *by_p, *by_q;

  PetscFunctionBegin;
  if (!pressure) PetscCall(Respond(p, NULL, s));
  if (!pressure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(pressure, &by_p));
  PetscCall(VecGetArrayRead(shear, &by_q));
  PetscCall(Respond(p, (const double *const[3]){by_p, by_q, by_q + p->grid->cells}, s));
  PetscCall(VecRestoreArrayRead(shear, &by_q));
  PetscCall(VecRestoreArrayRead(pressure, &by_p));
  AddBulk(p, s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticStress(SamPlastic *p, Vec state, Vec pressure, Vec shear, double stress[], double *energy)
{
  const PetscInt n   = PARTS * p->bodies * p->layers * p->grid->cells;
  double        *own = NULL;

  PetscFunctionBegin;
  PetscCall(TakeStrain(p, state, stress));
  PetscCall(Displace(p, stress, PARTS, NULL));
  if (energy) {
    PetscCall(PetscMalloc1(n, &own));
    PetscCall(Respond(p, NULL, own));
    PetscCall(SamPlasticWork(p, stress, own, energy));
    *energy *= -0.5;
    SamResidualBeginWithout(p->bodies, p->residual);
  }
  PetscCall(RespondToAll(p, pressure, shear, stress));
  for (PetscInt k = 0; k < n && own; k++) stress[k] += own[k];
  AddInitial(p, stress);
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- sums ---- */

/* Sums h a:b over all cells, or if weighted 2 mu h a:b; the result is the same on any number of ranks. */
static PetscErrorCode Sum(const SamPlastic *p, PetscBool weighted, const double a[], const double b[], double *dot)
{
  const SamGrid grid  = p->grid;
  SamTotal      total = {0};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < grid->rows; j++)
    for (PetscInt l = 0; l < p->bodies * p->layers; l++) {
      const double weight = weighted ? 2 * BodyOf(p, l)->material.shear : 1;
      double       sum    = 0;

      for (PetscInt c = 0; c < PARTS; c++) {
        const ptrdiff_t at  = ((ptrdiff_t)l * PARTS + c) * grid->cells + j * (ptrdiff_t)grid->nx;
        double          row = 0;

        for (PetscInt i = 0; i < grid->nx; i++) row += a[at + i] * b[at + i];
        sum += (c > SAM_STRESS_ZZ ? 2 : 1) * row;
      }
      SamAdd(&total, weight * ThicknessOf(p, l) * sum);
    }
  PetscCall(SamSumTotals(grid->comm, 1, &total, dot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Dot(const Solve *w, const double a[], const double b[], double *dot)
{
  PetscFunctionBegin;
  PetscCall(Sum(w->plastic, PETSC_TRUE, a, b, dot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticWork(const SamPlastic *p, const double e[], const double s[], double *work)
{
  PetscFunctionBegin;
  PetscCall(Sum(p, PETSC_FALSE, e, s, work));
  *work *= (double)(p->grid->dx * p->grid->dy);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the residual ---- */

/* Computes to = from + dev(s)/(2 mu). */
static void AddDeviator(const SamPlastic *p, const double from[], const double s[], double to[])
{
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < p->grid->cells; k++) {
      double x[PARTS], e[PARTS];

      Take(p, s, l, k, x);
      Take(p, from, l, k, e);
      SamTensorDeviator(x);
      for (PetscInt c = 0; c < PARTS; c++) x[c] = e[c] + x[c] / (2 * BodyOf(p, l)->material.shear);
      Put(p, x, l, k, to);
    }
}

/* Computes the plastic strains for a driver, as tried state, and the tangents. */
static PetscErrorCode Return(Solve *w, Vec last, Vec tried)
{
  const SamPlastic *p     = w->plastic;
  const PetscInt    cells = p->grid->cells;
  const double     *from  = NULL;
  double           *to, deepest = 0;

  PetscFunctionBegin;
  if (last) PetscCall(VecGetArrayRead(last, &from));
  PetscCall(VecGetArray(tried, &to));
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < cells; k++) {
      SamMisesAt      at = {{0}, 0, {{0}}};
      SamMisesTangent t  = {{0}, 0, 0};
      double          d[PARTS];

      if (from) SamPlasticRead(p, from, l, k, &at);
      Take(p, w->d, l, k, d);
      if (SamMisesReturn(&BodyOf(p, l)->material, d, &at, &t)) deepest = PetscMax(deepest, l % p->layers + 1);
      Write(p, &at, l, k, to);
      Put(p, at.e, l, k, w->e);
      Put(p, t.n, l, k, w->tangent.n);
      w->tangent.along[l * cells + k]  = t.along;
      w->tangent.across[l * cells + k] = t.across;
    }
  PetscCall(VecRestoreArray(tried, &to));
  if (last) PetscCall(VecRestoreArrayRead(last, &from));
  PetscCall(SamMax(p->grid->comm, 1, &deepest));
  w->tangent.active = (PetscInt)deepest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the driver from the strains w->e, which are those of the state (NULL: 0), and the tractions. */
static PetscErrorCode GetDriver(Solve *w, Vec state, double d[])
{
  PetscBool is;

  PetscFunctionBegin;
  PetscCall(IsBegun(w->plastic, state, &is));
  if (!is || !w->plastic->begun.spectra) PetscCall(Displace(w->plastic, w->e, PARTS, NULL));
  PetscCall(RespondToAll(w->plastic, w->contact->pressure, w->contact->shear, w->s));
  AddInitial(w->plastic, w->s);
  AddDeviator(w->plastic, w->e, w->s, d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Sets the driver of a cell that does not yield to the new one where it does not yield there either: its strain is the
  same for both, and its residual becomes 0.
*/
static PetscErrorCode FollowElastic(Solve *w, Vec last)
{
  const SamPlastic *p     = w->plastic;
  const PetscInt    cells = p->grid->cells;
  const double     *from  = NULL;

  PetscFunctionBegin;
  if (last) PetscCall(VecGetArrayRead(last, &from));
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < cells; k++) {
      SamMisesAt      at = {{0}, 0, {{0}}};
      SamMisesTangent t;
      double          d[PARTS], r[PARTS];

      if (w->tangent.along[l * cells + k] > 0 || w->tangent.across[l * cells + k] > 0) continue;
      if (from) SamPlasticRead(p, from, l, k, &at);
      Take(p, w->d, l, k, d);
      Take(p, w->r, l, k, r);
      for (PetscInt c = 0; c < PARTS; c++) d[c] += r[c];
      if (SamMisesReturn(&BodyOf(p, l)->material, d, &at, &t)) continue;
      Put(p, d, l, k, w->d);
      Put(p, (const double[PARTS]){0}, l, k, w->r);
    }
  if (last) PetscCall(VecRestoreArrayRead(last, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the tried strain, or else the committed one; NULL: none. */
static Vec StateOf(const SamLawContact *contact)
{
  return SamStateReadField(contact->state, SamStateFindField(contact->state, SAM_PLASTIC_FIELD));
}

/* Finds out if any cell yields with the driver. */
static PetscErrorCode Yields(const Solve *w, PetscBool *any)
{
  const SamPlastic *p     = w->plastic;
  const PetscInt    cells = p->grid->cells;
  const double     *from;
  double            yields = 0;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(p->last, &from));
  for (PetscInt l = 0; l < p->bodies * p->layers && !(yields > 0); l++)
    for (PetscInt k = 0; k < cells; k++) {
      SamMisesAt      at;
      SamMisesTangent t;
      double          d[PARTS];

      SamPlasticRead(p, from, l, k, &at);
      Take(p, w->d, l, k, d);
      if (SamMisesReturn(&BodyOf(p, l)->material, d, &at, &t)) yields = 1;
    }
  PetscCall(VecRestoreArrayRead(p->last, &from));
  PetscCall(SamMax(p->grid->comm, 1, &yields));
  *any = yields > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the strain of the driver as the tried one, with which the contact is solved next. */
static PetscErrorCode Propose(Solve *w)
{
  SamPlastic *p = w->plastic;
  Vec         tried;

  PetscFunctionBegin;
  PetscCall(SamStateSetField(w->contact->state, SamStateFindField(w->contact->state, SAM_PLASTIC_FIELD), &tried));
  PetscCall(Return(w, p->last, tried));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the residual of the driver from the tractions with its strain. */
static PetscErrorCode Measure(Solve *w)
{
  const SamPlastic *p = w->plastic;

  PetscFunctionBegin;
  PetscCall(GetDriver(w, StateOf(w->contact), w->r));
  for (PetscInt k = 0; k < w->n; k++) w->r[k] -= w->d[k];
  PetscCall(FollowElastic(w, p->last));
  PetscCall(Dot(w, w->r, w->r, &w->norm));
  w->norm    = sqrt(w->norm);
  w->largest = 0;
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < p->grid->cells; k++) {
      const SamMises *m = &BodyOf(p, l)->material;
      double          r[PARTS];

      Take(p, w->r, l, k, r);
      w->largest = SamLarger(w->largest, sqrt(SamTensorDot(r, r)) * 3 * m->shear / m->yield);
    }
  PetscCall(SamMax(p->grid->comm, 1, &w->largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the method ---- */

static PetscErrorCode CreateWork(SamPlastic *p, SamLawContact *contact, Solve **work)
{
  Solve *w;

  PetscFunctionBegin;
  PetscCall(PetscNew(work));
  w  = *work;
  *w = (Solve){.plastic = p, .contact = contact, .n = PARTS * p->bodies * p->layers * p->grid->cells};
  PetscCall(PetscMalloc7(w->n, &w->d, w->n, &w->r, w->n, &w->e, w->n, &w->s, w->n, &w->y, w->n, &w->start, w->n,
                         &w->tangent.n));
  PetscCall(PetscMalloc2(w->n / PARTS, &w->tangent.along, w->n / PARTS, &w->tangent.across));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticAbandon(SamPlastic *p)
{
  Solve *w = p->work;

  PetscFunctionBegin;
  p->work = NULL;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree7(w->d, w->r, w->e, w->s, w->y, w->start, w->tangent.n));
  PetscCall(PetscFree2(w->tangent.along, w->tangent.across));
  PetscCall(SamReactionDestroy(&w->reaction));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the yield stress grows with the first plastic strain, or a backstress moves the yield surface. */
static PetscBool Hardens(const SamMises *material)
{
  double slope;

  (void)SamMisesYield(material, 0, &slope);
  return slope > 0 || material->backstresses > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* True if a layer of periodic bodies yields in all cells without hardening: its stress then does not determine its
   strain. */
static PetscErrorCode Flows(const Solve *w, PetscBool *flows)
{
  const SamPlastic *p      = w->plastic;
  const PetscInt    layers = p->bodies * p->layers, cells = p->grid->cells;
  double           *holds;

  PetscFunctionBegin;
  *flows = PETSC_FALSE;
  if (!SamElasticityGetTraits(p->elasticity).periodic) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(layers, &holds));
  for (PetscInt l = 0; l < layers; l++) {
    if (Hardens(&BodyOf(p, l)->material)) holds[l] = 1;
    for (PetscInt k = 0; k < cells; k++)
      if (!(w->tangent.along[l * cells + k] > 0)) holds[l] = 1;
  }
  PetscCall(SamMax(p->grid->comm, layers, holds));
  for (PetscInt l = 0; l < layers; l++)
    if (holds[l] == 0) *flows = PETSC_TRUE;
  PetscCall(PetscFree(holds));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Returns the largest shear of the surfaces relative to the shear that a body without hardening can bear there,
  yield/sqrt(3) in pure shear: no stress below balances a larger one. 0: all bodies harden.
*/
static PetscErrorCode GetOverload(const Solve *w, double *overload)
{
  const SamPlastic *p     = w->plastic;
  const PetscInt    cells = p->grid->cells;
  const double     *q;
  double            least = INFINITY;

  PetscFunctionBegin;
  *overload = 0;
  for (PetscInt b = 0; b < p->bodies; b++) {
    const SamMises *m = &p->body[b].material;

    if (!Hardens(m)) least = PetscMin(least, SamMisesYield(m, 0, NULL));
  }
  PetscCall(VecGetArrayRead(w->contact->shear, &q));
  for (PetscInt k = 0; k < cells; k++) *overload = PetscMax(*overload, sqrt(3.0) * hypot(q[k], q[k + cells]) / least);
  PetscCall(VecRestoreArrayRead(w->contact->shear, &q));
  PetscCall(SamMax(p->grid->comm, 1, overload));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DescribeFailure(Solve *w, double largest)
{
  const size_t size = sizeof(w->contact->failed);
  PetscBool    flows;
  double       overload;

  PetscFunctionBegin;
  PetscCall(Flows(w, &flows));
  PetscCall(GetOverload(w, &overload));
  if (flows)
    (void)snprintf(w->contact->failed, size,
                   "a layer yields in all its cells, where no strain is unique without hardening: give it a hardening, "
                   "or less load");
  else if (overload > 1)
    (void)snprintf(w->contact->failed, size,
                   "the shear is %.2g times what the body bears without hardening, yield/sqrt(3): give "
                   "it a hardening, or less friction",
                   overload);
  else
    (void)snprintf(w->contact->failed, size,
                   "the plastic strain did not converge within %" PetscInt_FMT
                   " iterations, residual %.2g, tolerance %.2g: use -step_rtol, more rows, or a larger -steps",
                   w->plastic->newton, largest, (double)w->plastic->rtol);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the driver at the present length of the step. */
static void GoAlong(Solve *w)
{
  for (PetscInt i = 0; i < w->n; i++) w->d[i] = w->start[i] + w->length * w->y[i];
}

/* Computes a step of Newton's method from the residual, and goes along it. */
static PetscErrorCode BeginStep(Solve *w)
{
  SamPlastic *p = w->plastic;
  double      part;

  PetscFunctionBegin;
  if (!w->reaction) PetscCall(SamReactionCreate(p->elasticity, w->contact, &w->reaction));
  PetscCall(SamReactionFreeze(w->reaction));
  part = PetscMax(PetscMin(ROUGH, FORCING * w->norm / w->first), ENOUGH * (double)p->rtol / w->largest);
  if (SamReactionSlips(w->reaction)) part = PetscMax(part, SLIPPING);
  PetscCall(SamEquationsSolve(p, w->contact, w->reaction, &w->tangent, w->r, part, w->y));
  p->newton++;
  w->steps++;
  w->before   = w->norm;
  w->length   = 1;
  w->halvings = 1;
  PetscCall(PetscArraycpy(w->start, w->d, w->n));
  GoAlong(w);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the next driver, if the residual asks for one: at half the step while this has not lowered it, or after a new
   step. */
static PetscErrorCode Continue(Solve *w, PetscBool *again)
{
  const PetscReal rtol = w->plastic->rtol;

  PetscFunctionBegin;
  if (!w->steps) w->first = w->norm;
  *again = w->largest > rtol ? PETSC_TRUE : PETSC_FALSE;
  if (!*again) PetscFunctionReturn(PETSC_SUCCESS);
  if (w->steps && !(w->norm < w->before) && w->halvings < HALVINGS) {
    w->length /= 2;
    w->halvings++;
    GoAlong(w);
  } else if (w->steps < STEPS) {
    PetscCall(BeginStep(w));
  } else {
    PetscCall(DescribeFailure(w, w->largest));
    *again = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A second solve of a step begins with the strain of the first. Before the first one it is found out if any cell yields
   by the tractions with the strain before the step. */
PetscErrorCode SamPlasticSolve(SamPlastic *p, SamLawContact *contact, PetscBool *again)
{
  const PetscBool grown = p->last && StateOf(contact) == p->last ? PETSC_FALSE : PETSC_TRUE;
  Solve          *w     = p->work;

  PetscFunctionBegin;
  *again = contact->solved;
  if (!w && contact->solved) {
    PetscCall(CreateWork(p, contact, &p->work));
    w = p->work;
    PetscCall(TakeStrain(p, StateOf(contact), w->e));
    PetscCall(GetDriver(w, StateOf(contact), w->d));
    if (!grown) PetscCall(Yields(w, again));
  } else if (contact->solved) {
    PetscCall(Measure(w));
    PetscCall(Continue(w, again));
  }
  if (*again)
    PetscCall(Propose(w));
  else
    PetscCall(SamPlasticAbandon(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
