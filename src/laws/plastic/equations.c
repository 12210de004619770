/*
  The equations (1 - Q Bc Q) y = Q r of plasticnewton.c, on a box of cells, by conjugate gradients, or if cells slip by
  GMRES.

  Q, the root of the tangent, is 0 where nothing yields. So the unknowns are those of the yielding cells alone, and the
  operators are needed on a box that contains these and the contact. The images of the box are left in its waves, which
  changes the stress by some parts in a thousand, and with it the rate at which Newton's method converges, but not its
  solution, whose residual is exact.
*/
#include "equations.h"
#include <petsam/private/elasticity.h>
#include <petsam/private/grid.h>
#include <petsam/private/pressed.h>

#define PRODUCTS 200   /* maximum number in one step */
#define ROUNDING 1e-12 /* of a product relative to the square of its vector */
#define BASIS    20    /* number of directions between restarts of GMRES */
#define LINES    4     /* a box ends at multiples of so many columns, rows and layers */

/* The cells that yield, in the order of rows, layers, columns; x is a list of PARTS values per cell. */
typedef struct {
  PetscInt   count, *row;        /* the cells of row j are row[j] to row[j + 1] */
  ptrdiff_t *place;              /* place of the first component in a field of the box */
  double    *weight;             /* 2 mu h */
  double    *modulus;            /* 2 mu */
  double    *along, *across, *n; /* Q x = across x + (along - across) (n:x) n */
} Cells;

struct _n_SamEquations {
  SamWindow     window;
  SamGrid       grid;       /* of the window; borrowed */
  SamElasticity elasticity; /* of the window's cells */
  PetscInt      layers;     /* of each body */
  SamResidual   residual[2];
  Vec           whole, part; /* scratch: a plane of the plastic's grid, and of the box */
  double       *field;       /* strain or stress in all layers of the box */
  double       *surface[2];  /* displacement or traction, DIRECTIONS planes of the plastic's grid, and of the box */
};

/* ---- the box ---- */

PetscErrorCode SamEquationsDestroy(SamEquations *equations)
{
  SamEquations q = *equations;

  PetscFunctionBegin;
  *equations = NULL;
  if (!q) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < 2; b++) PetscCall(SamResidualDestroy(&q->residual[b]));
  PetscCall(VecDestroy(&q->whole));
  PetscCall(VecDestroy(&q->part));
  PetscCall(PetscFree3(q->field, q->surface[0], q->surface[1]));
  PetscCall(SamElasticityDestroy(&q->elasticity));
  PetscCall(SamWindowDestroy(&q->window));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the smallest box that contains the cells with a tangent and those in contact. */
static PetscErrorCode FindBox(const SamPlastic *p, const SamLawContact *contact, const SamTangent *t, PetscInt first[2],
                              PetscInt n[2])
{
  const PetscInt cells = p->grid->cells;
  const double  *pressure;
  double        *in;
  Vec            field;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(p->grid, 1, &field));
  PetscCall(VecGetArrayRead(contact->pressure, &pressure));
  PetscCall(VecGetArrayWrite(field, &in));
  for (PetscInt k = 0; k < cells; k++) in[k] = SamIsPressed(pressure[k]) ? 1 : 0;
  for (PetscInt l = 0; l < p->bodies * p->layers; l++)
    for (PetscInt k = 0; k < cells; k++)
      if (t->along[l * cells + k] > 0 || t->across[l * cells + k] > 0) in[k] = 1;
  PetscCall(VecRestoreArrayWrite(field, &in));
  PetscCall(VecRestoreArrayRead(contact->pressure, &pressure));
  PetscCall(SamGridGetSupport(p->grid, field, PETSC_FALSE, first, n));
  PetscCall(VecDestroy(&field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Widens a range of n lines to multiples of LINES, of all at least two. */
static void Widen(PetscInt all, PetscInt *first, PetscInt *n)
{
  const PetscInt end = (*first + *n + LINES - 1) / LINES * LINES;

  *first = *first / LINES * LINES;
  *n     = PetscMax(PetscMin(end, all) - *first, PetscMin(2, all));
  *first = PetscMin(*first, all - *n);
}

static PetscErrorCode Create(const SamPlastic *p, const PetscInt first[2], const PetscInt n[2], PetscInt layers,
                             SamEquations *equations)
{
  const PetscBool parts = SamElasticityGetTraits(p->elasticity).parts;
  SamEquations    q;

  PetscFunctionBegin;
  PetscCall(PetscNew(&q));
  PetscCall(SamWindowCreate(p->grid, first, n, &q->window));
  q->grid   = SamWindowGetGrid(q->window);
  q->layers = layers;
  PetscCall(SamElasticityCreateLike(p->elasticity, q->grid, parts ? first : NULL, &q->elasticity));
  for (PetscInt b = 0; b < p->bodies; b++)
    PetscCall(
      SamResidualCreate(q->elasticity, p->body[b].body + 1, layers, p->thickness, PETSC_FALSE, &q->residual[b]));
  PetscCall(SamGridCreateVec(p->grid, 1, &q->whole));
  PetscCall(SamGridCreateVec(q->grid, 1, &q->part));
  PetscCall(PetscMalloc3(PARTS * p->bodies * layers * q->grid->cells, &q->field, DIRECTIONS * p->grid->cells,
                         &q->surface[0], DIRECTIONS * q->grid->cells, &q->surface[1]));
  *equations = q;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the box for these tangents, which depends on nothing else, so that a restart has the same. Periodic bodies need
   the whole grid. */
static PetscErrorCode SetBox(SamPlastic *p, const SamLawContact *contact, const SamTangent *t)
{
  const PetscInt     all[2] = {p->grid->nx, p->grid->ny};
  const SamEquations q      = p->equations;
  PetscInt           first[2], n[2], layers, at[2] = {0}, size[2] = {0};

  PetscFunctionBegin;
  PetscCall(FindBox(p, contact, t, first, n));
  for (PetscInt k = 0; k < 2; k++)
    if (SamElasticityGetTraits(p->elasticity).parts)
      Widen(all[k], &first[k], &n[k]);
    else {
      first[k] = 0;
      n[k]     = all[k];
    }
  layers = PetscMin((PetscMax(t->active, 1) + LINES - 1) / LINES * LINES, p->layers);
  if (q) PetscCall(SamWindowGetPlace(q->window, at, size));
  if (q && first[0] == at[0] && first[1] == at[1] && n[0] == size[0] && n[1] == size[1] && q->layers == layers)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamEquationsDestroy(&p->equations));
  PetscCall(Create(p, first, n, layers, &p->equations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- moving fields ---- */

/* Copies planes between two grids, of which `in` and `out` are planes, by SamWindowTake() or SamWindowPut(). */
static PetscErrorCode MovePlanes(SamEquations q, PetscErrorCode (*move)(SamWindow, Vec, Vec), Vec in, Vec out,
                                 PetscInt planes, const double from[], double to[])
{
  PetscInt here, there;
  double  *plane;

  PetscFunctionBegin;
  PetscCall(VecGetLocalSize(in, &here));
  PetscCall(VecGetLocalSize(out, &there));
  for (PetscInt c = 0; c < planes; c++) {
    PetscCall(VecGetArrayWrite(in, &plane));
    PetscCall(PetscArraycpy(plane, from + (ptrdiff_t)c * here, here));
    PetscCall(VecRestoreArrayWrite(in, &plane));
    PetscCall((*move)(q->window, in, out));
    PetscCall(VecGetArray(out, &plane));
    PetscCall(PetscArraycpy(to + (ptrdiff_t)c * there, plane, there));
    PetscCall(VecRestoreArray(out, &plane));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copy planes of the plastic's grid to the box, and back; outside of the box they become 0. */
static PetscErrorCode TakePlanes(SamEquations q, PetscInt planes, const double from[], double to[])
{
  PetscFunctionBegin;
  PetscCall(MovePlanes(q, SamWindowTake, q->whole, q->part, planes, from, to));
  PetscFunctionReturn(PETSC_SUCCESS);
}
static PetscErrorCode PutPlanes(SamEquations q, PetscInt planes, const double from[], double to[])
{
  PetscFunctionBegin;
  PetscCall(MovePlanes(q, SamWindowPut, q->part, q->whole, planes, from, to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the first plane of layer l of body b, among the planes of all bodies with so many layers. */
static PetscInt PlaneOf(PetscInt b, PetscInt l, PetscInt layers)
{
  return PARTS * (b * layers + l);
}

/* ---- the cells that yield ---- */

static PetscErrorCode DestroyCells(Cells *y)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(y->row, y->place));
  PetscCall(PetscFree5(y->weight, y->modulus, y->along, y->across, y->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies the tangents to the box: along and across, then n of each layer; the result is to be freed. */
static PetscErrorCode TakeTangents(const SamPlastic *p, const SamTangent *t, double **tangents)
{
  const PetscInt cells = p->grid->cells, here = p->equations->grid->cells, layers = p->equations->layers;
  double        *to;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((PARTS + 2) * p->bodies * layers * here, tangents));
  to = *tangents;
  for (PetscInt b = 0; b < p->bodies; b++)
    for (PetscInt l = 0; l < layers; l++, to += (PARTS + 2) * here) {
      const ptrdiff_t from = p->body[b].first + l;

      PetscCall(TakePlanes(p->equations, 1, t->along + from * cells, to));
      PetscCall(TakePlanes(p->equations, 1, t->across + from * cells, to + here));
      PetscCall(TakePlanes(p->equations, PARTS, t->n + PARTS * from * cells, to + 2 * here));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the cells of the box that have a tangent. */
static PetscErrorCode CreateCells(const SamPlastic *p, const SamTangent *t, Cells *y)
{
  const SamGrid  grid  = p->equations->grid;
  const PetscInt cells = grid->cells, layers = p->equations->layers;
  double        *tangents;
  PetscInt       c = 0;

  PetscFunctionBegin;
  PetscCall(TakeTangents(p, t, &tangents));
  *y = (Cells){.count = 0};
  for (PetscInt l = 0; l < p->bodies * layers; l++)
    for (PetscInt k = 0; k < cells; k++) {
      const double *at = tangents + (PARTS + 2) * l * cells + k;

      y->count += at[0] > 0 || at[cells] > 0;
    }
  PetscCall(PetscMalloc2(grid->rows + 1, &y->row, y->count, &y->place));
  PetscCall(PetscMalloc5(y->count, &y->weight, y->count, &y->modulus, y->count, &y->along, y->count, &y->across,
                         PARTS * y->count, &y->n));
  for (PetscInt j = 0; j < grid->rows; j++) {
    y->row[j] = c;
    for (PetscInt l = 0; l < p->bodies * layers; l++)
      for (PetscInt k = j * grid->nx; k < (j + 1) * grid->nx; k++) {
        const double *at = tangents + (PARTS + 2) * l * cells + k;

        if (!(at[0] > 0 || at[cells] > 0)) continue;
        y->place[c]   = PARTS * l * (ptrdiff_t)cells + k;
        y->modulus[c] = 2 * p->body[l / layers].material.shear;
        y->weight[c]  = y->modulus[c] * p->thickness[l % layers];
        y->along[c]   = sqrt(at[0]);
        y->across[c]  = sqrt(at[cells]);
        for (PetscInt m = 0; m < PARTS; m++) y->n[PARTS * c + m] = at[(2 + m) * cells];
        c++;
      }
  }
  y->row[grid->rows] = c;
  PetscCall(PetscFree(tangents));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums 2 mu h a:b; the result is the same on any number of ranks. */
static PetscErrorCode Dot(const SamPlastic *p, const Cells *y, const double a[], const double b[], double *dot)
{
  const SamGrid grid  = p->equations->grid;
  SamTotal      total = {0};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row = 0;

    for (PetscInt c = y->row[j]; c < y->row[j + 1]; c++)
      row += y->weight[c] * SamTensorDot(a + PARTS * c, b + PARTS * c);
    SamAdd(&total, row);
  }
  PetscCall(SamSumTotals(grid->comm, 1, &total, dot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multiplies a list by Q; `from` and `to` may be the same. */
static void ApplyRoot(const Cells *y, const double from[], double to[])
{
  for (PetscInt c = 0; c < y->count; c++) {
    const double *n = y->n + PARTS * c, *x = from + PARTS * c, dot = (y->along[c] - y->across[c]) * SamTensorDot(x, n);

    for (PetscInt m = 0; m < PARTS; m++) to[PARTS * c + m] = y->across[c] * x[m] + dot * n[m];
  }
}

/* Writes a list to the field of the box, which is 0 in other cells. */
static PetscErrorCode Spread(SamPlastic *p, const Cells *y, const double from[])
{
  const SamEquations q = p->equations;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(q->field, PARTS * p->bodies * q->layers * q->grid->cells));
  for (PetscInt c = 0; c < y->count; c++)
    for (PetscInt m = 0; m < PARTS; m++) q->field[y->place[c] + (ptrdiff_t)m * q->grid->cells] = from[PARTS * c + m];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stress of the box by the list x of strains, and by the tractions that these cause, in its field. */
static PetscErrorCode Respond(SamPlastic *p, const Cells *y, SamReaction reaction, const double x[])
{
  const SamEquations q     = p->equations;
  const PetscInt     cells = q->grid->cells;
  double *const u = q->surface[1], *const in_x = u + ALONG_X * cells, *const in_y = u + ALONG_Y * cells,
                *const in_z = u + ALONG_Z * cells;

  PetscFunctionBegin;
  PetscCall(Spread(p, y, x));
  PetscCall(SamResidualBegin(p->bodies, q->residual, q->field, PARTS, (double *const[3]){in_x, in_y, in_z}));
  PetscCall(PutPlanes(q, DIRECTIONS, u, q->surface[0]));
  PetscCall(SamReactionApply(reaction, q->surface[0]));
  PetscCall(TakePlanes(q, DIRECTIONS, q->surface[0], u));
  PetscCall(SamResidualEnd(p->bodies, q->residual, (const double *const[3]){in_z, in_x, in_y}, q->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the list Bc x of a list x; `to` may be x. */
static PetscErrorCode Multiply(SamPlastic *p, const Cells *y, SamReaction reaction, const double x[], double to[])
{
  const SamEquations q = p->equations;

  PetscFunctionBegin;
  PetscCall(Respond(p, y, reaction, x));
  for (PetscInt c = 0; c < y->count; c++) {
    double s[PARTS];

    for (PetscInt m = 0; m < PARTS; m++) s[m] = q->field[y->place[c] + (ptrdiff_t)m * q->grid->cells];
    SamTensorDeviator(s);
    for (PetscInt m = 0; m < PARTS; m++) to[PARTS * c + m] = x[PARTS * c + m] + s[m] / y->modulus[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes Bc x of a list x as a field of the whole grid, 0 outside of the box. */
static PetscErrorCode MultiplyAll(SamPlastic *p, const Cells *y, SamReaction reaction, const double x[], double to[])
{
  const SamEquations q     = p->equations;
  const PetscInt     cells = q->grid->cells, whole = p->grid->cells;

  PetscFunctionBegin;
  PetscCall(Respond(p, y, reaction, x));
  for (PetscInt b = 0; b < p->bodies; b++)
    for (PetscInt l = 0; l < q->layers; l++) {
      double *const at = q->field + (ptrdiff_t)PlaneOf(b, l, q->layers) * cells;

      for (PetscInt k = 0; k < cells; k++) {
        double s[PARTS];

        for (PetscInt c = 0; c < PARTS; c++) s[c] = at[c * cells + k];
        SamTensorDeviator(s);
        for (PetscInt c = 0; c < PARTS; c++) at[c * cells + k] = s[c] / (2 * p->body[b].material.shear);
      }
    }
  for (PetscInt c = 0; c < PARTS * y->count; c++)
    q->field[y->place[c / PARTS] + (ptrdiff_t)(c % PARTS) * cells] += x[c];
  PetscCall(PetscArrayzero(to, PARTS * p->bodies * p->layers * whole));
  for (PetscInt b = 0; b < p->bodies; b++)
    PetscCall(PutPlanes(q, PARTS * q->layers, q->field + (ptrdiff_t)PlaneOf(b, 0, q->layers) * cells,
                        to + (ptrdiff_t)PlaneOf(b, 0, p->layers) * whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the solution ---- */

/* Computes the list v = (1 - Q Bc Q) z. */
static PetscErrorCode Apply(SamPlastic *p, const Cells *cells, SamReaction reaction, const double z[], double v[])
{
  PetscFunctionBegin;
  ApplyRoot(cells, z, v);
  PetscCall(Multiply(p, cells, reaction, v, v));
  p->products++;
  ApplyRoot(cells, v, v);
  for (PetscInt i = 0; i < PARTS * cells->count; i++) v[i] = z[i] - v[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solves for the list y with the right side `rest`, which is overwritten, by conjugate gradients. */
static PetscErrorCode SolveSymmetric(SamPlastic *p, const Cells *cells, SamReaction reaction, double part,
                                     double rest[], double y[])
{
  const PetscInt n = PARTS * cells->count;
  double        *z, *v, first, size, before, step, square;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n, &z, n, &v));
  PetscCall(PetscArrayzero(y, n));
  PetscCall(PetscArraycpy(z, rest, n));
  PetscCall(Dot(p, cells, rest, rest, &first));
  size = first;
  for (PetscInt k = 0; k < PRODUCTS && size > part * part * first; k++) {
    PetscCall(Apply(p, cells, reaction, z, v));
    PetscCall(Dot(p, cells, z, v, &step));
    PetscCall(Dot(p, cells, z, z, &square));
    PetscCheck(step > -ROUNDING * square, p->grid->comm, PETSC_ERR_PLIB,
               "The operators of plastic strain are not symmetric");
    if (!(step > ROUNDING * square)) break; /* plastic flow has no stiffness: the step so far is used */
    step = size / step;
    for (PetscInt i = 0; i < n; i++) {
      y[i] += step * z[i];
      rest[i] -= step * v[i];
    }
    before = size;
    PetscCall(Dot(p, cells, rest, rest, &size));
    for (PetscInt i = 0; i < n; i++) z[i] = rest[i] + size / before * z[i];
  }
  PetscCall(PetscFree2(z, v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The triangular system of GMRES: H by columns, its rotations, and the rotated right side. */
typedef struct {
  double h[BASIS][BASIS + 1], turned[BASIS][BASIS + 1], cosine[BASIS], sine[BASIS], g[BASIS + 1];
} Hessenberg;

/* Rotates column k of H; g[k + 1] becomes the norm of the residual. */
static void Rotate(Hessenberg *s, PetscInt k)
{
  double *const column = s->turned[k], size;

  for (PetscInt i = 0; i <= k + 1; i++) column[i] = s->h[k][i];
  for (PetscInt i = 0; i < k; i++) {
    const double upper = column[i];

    column[i]     = s->cosine[i] * upper + s->sine[i] * column[i + 1];
    column[i + 1] = s->cosine[i] * column[i + 1] - s->sine[i] * upper;
  }
  size         = hypot(column[k], column[k + 1]);
  s->cosine[k] = size > 0 ? column[k] / size : 1;
  s->sine[k]   = size > 0 ? column[k + 1] / size : 0;
  column[k]    = size;
  s->g[k + 1]  = -s->sine[k] * s->g[k];
  s->g[k] *= s->cosine[k];
}

/* Adds the solution in the space of k directions to y, and subtracts its product from the residual `rest`. */
static void AddSolution(Hessenberg *s, PetscInt k, PetscInt n, const double basis[], double rest[], double y[])
{
  double c[BASIS], product[BASIS + 1] = {0};

  for (PetscInt i = k - 1; i >= 0; i--) {
    c[i] = s->g[i];
    for (PetscInt j = i + 1; j < k; j++) c[i] -= s->turned[j][i] * c[j];
    c[i] = s->turned[i][i] > 0 ? c[i] / s->turned[i][i] : 0;
  }
  for (PetscInt j = 0; j < k; j++)
    for (PetscInt i = 0; i <= j + 1; i++) product[i] += s->h[j][i] * c[j];
  for (PetscInt j = 0; j <= k; j++)
    for (PetscInt i = 0; i < n; i++) {
      if (j < k) y[i] += c[j] * basis[j * (ptrdiff_t)n + i];
      rest[i] -= product[j] * basis[j * (ptrdiff_t)n + i];
    }
}

/*
  The same for a matrix that is not symmetric, because cells slip, by the generalised minimal residual method with
  restarts (Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856).
*/
static PetscErrorCode SolveUnsymmetric(SamPlastic *p, const Cells *cells, SamReaction reaction, double part,
                                       double rest[], double y[])
{
  const PetscInt n = PARTS * cells->count;
  double        *basis, first, size;
  Hessenberg     s;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((BASIS + 1) * n, &basis));
  PetscCall(PetscArrayzero(y, n));
  PetscCall(Dot(p, cells, rest, rest, &first));
  first = size = sqrt(first);
  for (PetscInt products = 0; products < PRODUCTS && size > part * first;) {
    PetscInt k = 0;

    s.g[0] = size;
    for (PetscInt i = 0; i < n; i++) basis[i] = rest[i] / size;
    do {
      double *const z = basis + k * (ptrdiff_t)n, *const v = z + n;

      PetscCall(Apply(p, cells, reaction, z, v));
      products++;
      for (PetscInt j = 0; j <= k; j++) {
        PetscCall(Dot(p, cells, basis + j * (ptrdiff_t)n, v, &s.h[k][j]));
        for (PetscInt i = 0; i < n; i++) v[i] -= s.h[k][j] * basis[j * (ptrdiff_t)n + i];
      }
      PetscCall(Dot(p, cells, v, v, &s.h[k][k + 1]));
      s.h[k][k + 1] = sqrt(s.h[k][k + 1]);
      for (PetscInt i = 0; i < n; i++) v[i] = s.h[k][k + 1] > 0 ? v[i] / s.h[k][k + 1] : 0;
      Rotate(&s, k++);
    } while (k < BASIS && products < PRODUCTS && fabs(s.g[k]) > part * first);
    AddSolution(&s, k, n, basis, rest, y);
    PetscCall(Dot(p, cells, rest, rest, &size));
    size = sqrt(size);
  }
  PetscCall(PetscFree(basis));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copies a field to the list of cells. */
static PetscErrorCode TakeList(SamPlastic *p, const Cells *y, const double from[], double to[])
{
  const SamEquations q = p->equations;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < p->bodies; b++)
    PetscCall(TakePlanes(q, PARTS * q->layers, from + (ptrdiff_t)PlaneOf(b, 0, p->layers) * p->grid->cells,
                         q->field + (ptrdiff_t)PlaneOf(b, 0, q->layers) * q->grid->cells));
  for (PetscInt c = 0; c < y->count; c++)
    for (PetscInt m = 0; m < PARTS; m++) to[PARTS * c + m] = q->field[y->place[c] + (ptrdiff_t)m * q->grid->cells];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamEquationsSolve(SamPlastic *p, const SamLawContact *contact, SamReaction reaction,
                                 const SamTangent *tangent, const double r[], double part, double step[])
{
  double *rest, *y;
  Cells   cells;

  PetscFunctionBegin;
  PetscCall(SetBox(p, contact, tangent));
  PetscCall(CreateCells(p, tangent, &cells));
  PetscCall(PetscMalloc2(PARTS * cells.count, &rest, PARTS * cells.count, &y));
  PetscCall(TakeList(p, &cells, r, rest));
  ApplyRoot(&cells, rest, rest);
  PetscCall((SamReactionSlips(reaction) ? SolveUnsymmetric : SolveSymmetric)(p, &cells, reaction, part, rest, y));
  ApplyRoot(&cells, y, y);
  PetscCall(MultiplyAll(p, &cells, reaction, y, step));
  for (PetscInt i = 0; i < PARTS * p->bodies * p->layers * p->grid->cells; i++) step[i] += r[i];
  PetscCall(PetscFree2(rest, y));
  PetscCall(DestroyCells(&cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}
