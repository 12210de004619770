/*
  Plastic strain and contact together, by Newton's method.

  The unknown is the driver d in each cell of each layer. The material gives the plastic strain e(d) (mises.c), e gives
  the displacement of the surfaces, the contact on these gives the tractions p, and e and p give the stress. So the
  residual is
      r = e + dev(R e + K p)/(2 mu) - d.
  With P = de/dd, S the contact's stiffness on frozen sets of cells (reaction.c), and Bc = 1 + dev(R - K S K')/(2 mu), a
  step solves (1 - Bc P) delta = r in the symmetric form
      (1 - Q Bc Q) y = Q r,  delta = r + Bc Q y,  Q = root of P,
  by conjugate gradients in the product sum 2 mu h a:b. The matrix is positive definite: 0 <= P < 1, R is negative
  semidefinite, and 1 + R/(2 mu) as well as S positive semidefinite; only slipping cells make S unsymmetric, which
  conjugate gradients tolerate. They need only the layers down to the last one that yields. A step is halved until the
  residual falls.

  Source: J. C. Simo and T. J. R. Hughes, Computational Inelasticity (1998), chapter 3, for the tangent; A. Frerot, M.
  Bonnet, J.-F. Molinari and G. Anciaux, Comput. Methods Appl. Mech. Engrg. 351 (2019) 951, for the integral equation.
*/
#include "newton.h"
#include "reaction.h"

#define STEPS    30    /* maximum number of steps of Newton's method */
#define HALVINGS 8     /* maximum number in one step */
#define PRODUCTS 200   /* maximum number in one step */
#define ROUGH    0.1   /* a step's equations are solved at least to this part, */
#define ROUNDING 1e-12 /* of a product relative to the square of its vector */
#define FORCING  0.3   /* and to this part of the residual relative to its first value, */
#define SLIPPING 1e-3  /* but not below this part where cells slip: conjugate gradients reach no less there */

/* The fields of a solve, each of all layers, and the tangents of the cells */
typedef struct {
  SamPlastic    *plastic;
  SamLawContact *contact;
  PetscInt       n;                             /* values of a field on this rank */
  double        *d, *r, *e, *s, *y, *v, *w, *z; /* driver, residual, strain, stress; the others are scratch of a step */
  double   *direction, *along, *across; /* the tangents: direction as a field; the other two have one value per cell */
  PetscInt  active;                     /* number of layers down to the last one that yields on any rank */
  PetscBool solved;                     /* true: the normal problem has a solution */
  SamReaction reaction;
  double     *traction; /* (DIRECTIONS, cells) */
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

/* Computes the stress and the displacement (each NULL: not wanted) by a strain. */
static PetscErrorCode Respond(SamPlastic *p, const double e[], double s[], double *const u[3])
{
  const PetscInt cells = p->grid->cells;
  double        *own[3], *more;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(3 * cells, &more));
  for (PetscInt c = 0; c < 3; c++) own[c] = more + c * cells;
  for (PetscInt c = 0; u && c < 3; c++) PetscCall(PetscArrayzero(u[c], cells));
  for (PetscInt b = 0; b < p->bodies; b++) {
    const ptrdiff_t at = (ptrdiff_t)p->body[b].first * PARTS * cells;

    PetscCall(SamResidualApply(p->body[b].residual, e + at, s ? s + at : NULL, u ? own : NULL));
    for (PetscInt k = 0; u && k < 3 * cells; k++) u[k / cells][k % cells] += more[k];
  }
  PetscCall(PetscFree(more));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Load(SamPlastic *p, const double *const traction[3], double s[])
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < p->bodies; b++)
    PetscCall(SamResidualLoad(p->body[b].residual, traction, s + (ptrdiff_t)p->body[b].first * PARTS * p->grid->cells));
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

PetscErrorCode SamPlasticDisplace(SamPlastic *p, Vec state, double *const u[3])
{
  double *e;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(PARTS * p->bodies * p->layers * p->grid->cells, &e));
  PetscCall(TakeStrain(p, state, e));
  PetscCall(Respond(p, e, NULL, u));
  PetscCall(PetscFree(e));
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

PetscErrorCode SamPlasticStress(SamPlastic *p, Vec state, Vec pressure, Vec shear, double stress[], double *energy)
{
  const PetscInt n = PARTS * p->bodies * p->layers * p->grid->cells;
  const double  *by_p, *by_q;
  double        *e;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &e));
  PetscCall(TakeStrain(p, state, e));
  PetscCall(PetscArraycpy(stress, e, n));
  PetscCall(Respond(p, e, e, NULL));
  if (energy) PetscCall(SamPlasticWork(p, stress, e, energy));
  if (energy) *energy *= -0.5;
  PetscCall(PetscArrayzero(stress, n));
  if (pressure) {
    PetscCall(VecGetArrayRead(pressure, &by_p));
    PetscCall(VecGetArrayRead(shear, &by_q));
    PetscCall(Load(p, (const double *const[3]){by_p, by_q, by_q + p->grid->cells}, stress));
    PetscCall(VecRestoreArrayRead(shear, &by_q));
    PetscCall(VecRestoreArrayRead(pressure, &by_p));
    AddBulk(p, stress);
  }
  for (PetscInt k = 0; k < n; k++) stress[k] += e[k];
  AddInitial(p, stress);
  PetscCall(PetscFree(e));
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

      if (l % p->layers >= p->used) continue;
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

/* ---- a product ---- */

/* Multiplies a field by the root of P; `from` and `to` may be the same. */
static void ApplyRoot(const Solve *w, const double from[], double to[])
{
  const SamPlastic *p     = w->plastic;
  const PetscInt    cells = p->grid->cells;

  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < cells && l % p->layers < p->used; k++) {
      const double along = sqrt(w->along[l * cells + k]), across = sqrt(w->across[l * cells + k]);
      double       x[PARTS], n[PARTS], dot;

      Take(p, from, l, k, x);
      Take(p, w->direction, l, k, n);
      dot = SamTensorDot(x, n);
      for (PetscInt c = 0; c < PARTS; c++) x[c] = across * x[c] + (along - across) * dot * n[c];
      Put(p, x, l, k, to);
    }
}

/* Computes to = from + dev(s)/(2 mu). */
static void AddDeviator(const SamPlastic *p, const double from[], const double s[], double to[])
{
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < p->grid->cells && l % p->layers < p->used; k++) {
      double x[PARTS], e[PARTS];

      Take(p, s, l, k, x);
      Take(p, from, l, k, e);
      SamTensorDeviator(x);
      for (PetscInt c = 0; c < PARTS; c++) x[c] = e[c] + x[c] / (2 * BodyOf(p, l)->material.shear);
      Put(p, x, l, k, to);
    }
}

/* Computes to = Bc from. */
static PetscErrorCode Multiply(Solve *w, const double from[], double to[])
{
  const PetscInt cells = w->plastic->grid->cells;
  double *const z = w->traction, *const x = z + ALONG_X * cells, *const y = z + ALONG_Y * cells;

  PetscFunctionBegin;
  PetscCall(Respond(w->plastic, from, w->s, (double *const[3]){x, y, z}));
  PetscCall(SamReactionApply(w->reaction, w->traction));
  PetscCall(Load(w->plastic, (const double *const[3]){z, x, y}, to));
  for (PetscInt k = 0; k < w->n; k++) w->s[k] += to[k];
  AddDeviator(w->plastic, from, w->s, to);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Restricts the operators, and sums and products of fields, to the first layers. */
static void UseLayers(SamPlastic *p, PetscInt layers)
{
  p->used = layers;
  for (PetscInt b = 0; b < p->bodies; b++) SamResidualSetLayers(p->body[b].residual, layers);
}

/* Computes the step of Newton's method in y from the residual, by conjugate gradients. These need the layers that yield
   only; a last product with all layers gives the step. */
static PetscErrorCode FindStep(Solve *w, double part)
{
  double  *rest = w->e, first, size, before, step, square;
  PetscInt k    = 0;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(w->y, w->n));
  ApplyRoot(w, w->r, rest);
  PetscCall(PetscArraycpy(w->z, rest, w->n));
  PetscCall(Dot(w, rest, rest, &first));
  size = first;
  PetscCall(PetscArrayzero(w->v, w->n)); /* nothing is computed below the layers that yield */
  UseLayers(w->plastic, w->active);
  for (; k < PRODUCTS && size > part * part * first; k++) {
    ApplyRoot(w, w->z, w->v);
    PetscCall(Multiply(w, w->v, w->w)); /* w = Bc Q z */
    w->plastic->products++;
    ApplyRoot(w, w->w, w->v);
    for (PetscInt i = 0; i < w->n; i++) w->v[i] = w->z[i] - w->v[i];
    PetscCall(Dot(w, w->z, w->v, &step));
    PetscCall(Dot(w, w->z, w->z, &square));
    PetscCheck(step > -ROUNDING * square || SamReactionSlips(w->reaction), w->plastic->grid->comm, PETSC_ERR_PLIB,
               "The operators of plastic strain are not symmetric");
    if (!(step > ROUNDING * square))
      break; /* slip is not symmetric, or plastic flow has no stiffness: the step so far is used */
    step = size / step;
    for (PetscInt i = 0; i < w->n; i++) {
      w->y[i] += step * w->z[i];
      rest[i] -= step * w->v[i];
    }
    before = size;
    PetscCall(Dot(w, rest, rest, &size));
    for (PetscInt i = 0; i < w->n; i++) w->z[i] = rest[i] + size / before * w->z[i];
  }
  UseLayers(w->plastic, w->plastic->layers);
  ApplyRoot(w, w->y, w->v);
  PetscCall(PetscArrayzero(w->w, w->n));
  if (k) PetscCall(Multiply(w, w->v, w->w));
  for (PetscInt i = 0; i < w->n; i++) w->y[i] = w->r[i] + w->w[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the residual ---- */

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
      Put(p, t.n, l, k, w->direction);
      w->along[l * cells + k]  = t.along;
      w->across[l * cells + k] = t.across;
    }
  PetscCall(VecRestoreArray(tried, &to));
  if (last) PetscCall(VecRestoreArrayRead(last, &from));
  PetscCall(SamMax(p->grid->comm, 1, &deepest));
  w->active = (PetscInt)deepest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the driver from the strains w->e and the tractions. */
static PetscErrorCode GetDriver(Solve *w, double d[])
{
  const PetscInt cells = w->plastic->grid->cells;
  const double  *p, *q;

  PetscFunctionBegin;
  PetscCall(Respond(w->plastic, w->e, w->s, NULL));
  PetscCall(VecGetArrayRead(w->contact->pressure, &p));
  PetscCall(VecGetArrayRead(w->contact->shear, &q));
  PetscCall(Load(w->plastic, (const double *const[3]){p, q, q + cells}, w->v));
  PetscCall(VecRestoreArrayRead(w->contact->shear, &q));
  PetscCall(VecRestoreArrayRead(w->contact->pressure, &p));
  for (PetscInt k = 0; k < w->n; k++) w->s[k] += w->v[k];
  AddInitial(w->plastic, w->s);
  AddBulk(w->plastic, w->s);
  AddDeviator(w->plastic, w->e, w->s, d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the residual of the driver, its norm, and its largest value relative to the strain at yield. */
static PetscErrorCode Measure(Solve *w, PetscInt field, double *norm, double *largest)
{
  const SamPlastic *p = w->plastic;
  Vec               tried;

  PetscFunctionBegin;
  PetscCall(SamStateSetField(w->contact->state, field, &tried));
  PetscCall(Return(w, p->last, tried));
  *norm = *largest = 0;
  w->solved        = PETSC_TRUE;
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0)); /* both problems have their own events */
  PetscCall(w->contact->solve(w->contact, &w->solved));
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_PLASTIC], 0, 0, 0, 0));
  if (!w->solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GetDriver(w, w->r));
  for (PetscInt k = 0; k < w->n; k++) w->r[k] -= w->d[k];
  PetscCall(Dot(w, w->r, w->r, norm));
  *norm = sqrt(*norm);
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < p->grid->cells; k++) {
      const SamMises *m = &BodyOf(p, l)->material;
      double          r[PARTS];

      Take(p, w->r, l, k, r);
      *largest = SamLarger(*largest, sqrt(SamTensorDot(r, r)) * 3 * m->shear / m->yield);
    }
  PetscCall(SamMax(p->grid->comm, 1, largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the method ---- */

static PetscErrorCode CreateWork(Solve *w)
{
  const SamPlastic *p       = w->plastic;
  const PetscInt    cells   = p->grid->cells;
  double          **field[] = {&w->d, &w->r, &w->e, &w->s, &w->y, &w->v, &w->w, &w->z, &w->direction};

  PetscFunctionBegin;
  w->n = PARTS * p->bodies * p->layers * cells;
  for (size_t k = 0; k < sizeof(field) / sizeof(field[0]); k++) PetscCall(PetscCalloc1(w->n, field[k]));
  PetscCall(PetscCalloc2(w->n / PARTS, &w->along, w->n / PARTS, &w->across));
  PetscCall(PetscCalloc1(DIRECTIONS * cells, &w->traction));
  PetscCall(SamReactionCreate(p->elasticity, w->contact, &w->reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyWork(Solve *w)
{
  double **field[] = {&w->d, &w->r, &w->e, &w->s, &w->y, &w->v, &w->w, &w->z, &w->direction};

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(field) / sizeof(field[0]); k++) PetscCall(PetscFree(*field[k]));
  PetscCall(PetscFree2(w->along, w->across));
  PetscCall(PetscFree(w->traction));
  PetscCall(SamReactionDestroy(&w->reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Follows a step; halves it repeatedly until it lowers the residual. */
static PetscErrorCode GoAlong(Solve *w, PetscInt field, double *norm, double *largest)
{
  const double before = *norm;
  double       length = 1, *start, *step;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(w->n, &start, w->n, &step));
  PetscCall(PetscArraycpy(start, w->d, w->n));
  PetscCall(PetscArraycpy(step, w->y, w->n));
  for (PetscInt k = 0; k < HALVINGS; k++, length /= 2) {
    for (PetscInt i = 0; i < w->n; i++) w->d[i] = start[i] + length * step[i];
    PetscCall(Measure(w, field, norm, largest));
    if (!w->solved || *norm < before || *largest <= w->plastic->rtol) break;
  }
  PetscCall(PetscFree2(start, step));
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
      if (!(w->along[l * cells + k] > 0)) holds[l] = 1;
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
                   " iterations, residual %.2g, tolerance %.2g",
                   w->plastic->newton, largest, (double)w->plastic->rtol);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Iterates from the present driver. */
static PetscErrorCode Iterate(Solve *w, PetscInt field)
{
  SamPlastic *p = w->plastic;
  double      norm, first, largest;

  PetscFunctionBegin;
  PetscCall(Measure(w, field, &norm, &largest));
  first = norm;
  for (PetscInt k = 0; w->solved && largest > p->rtol && k < STEPS; k++) {
    PetscCall(SamReactionFreeze(w->reaction));
    PetscCall(
      FindStep(w, PetscMax(PetscMin(ROUGH, FORCING * norm / first), SamReactionSlips(w->reaction) ? SLIPPING : 0)));
    p->newton++;
    PetscCall(GoAlong(w, field, &norm, &largest));
  }
  if (w->solved && largest > p->rtol) PetscCall(DescribeFailure(w, largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticSolve(SamPlastic *p, SamLawContact *contact)
{
  const PetscInt field = SamStateFindField(contact->state, SAM_PLASTIC_FIELD);
  Solve          w     = {.plastic = p, .contact = contact};

  PetscFunctionBegin;
  UseLayers(p, p->layers); /* also after an error in the conjugate gradients */
  PetscCall(CreateWork(&w));
  PetscCall(TakeStrain(p, SamStateReadField(contact->state, field), w.e)); /* a second solve begins with the first */
  PetscCall(GetDriver(&w, w.d));
  PetscCall(Iterate(&w, field));
  PetscCall(DestroyWork(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}
