/*
  What a shear does within cells along the edges of contact and stick.

  Where a surface slips the shear is mu p e, e being against the slip. Near the edge of the stick zone e is continued
  from where it slips: t = mu p - q.e, the slack, vanishes at that edge like the root of the distance (Cattaneo 1938,
  Mindlin 1949: for similar bodies without Poisson's effect t is the pressure of a contact of the size of the stick
  zone). So two profiles, of p and of t, say what q does within a cell:
    q = e (mu p - t), e linear, and what is perpendicular to e linear.
  Elsewhere in the stick zone the shear has a history: edges that a reversal of the load left behind. What it does there
  changes smoothly only, so the former stays and the slopes of the difference are added.
  After a reversal the slack of the limit has those edges too. What has none within the new edge of stick is the change
  of the shear since, whose limit is that between slip in both directions, 2 mu p: t = 2 mu p - (q - q_r).e (Mindlin
  and Deresiewicz 1953). When the new edge has passed the old ones, the slack of the limit is smooth again.

  Distances are in cells.
*/
#include "shearimpl.h"
#include <math.h>

/*
  Cells into the stick zone that the direction of slip is continued to: the window of a reconstruction, and its band.
*/
#define LAYERS 12

PetscErrorCode SamShearProfileCreate(SamElasticity elasticity, SamShearProfile *profile)
{
  SamShearProfile s;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  PetscCall(SamElasticityReference(elasticity));
  PetscCall(SamElasticityGetGrid(elasticity, &s->grid));
  s->elasticity = elasticity;
  PetscCall(SamGridCreateVec(s->grid, 2, &s->direction));
  PetscCall(SamGridCreateVec(s->grid, 1, &s->slack));
  PetscCall(SamProfileCreate(elasticity, &s->profile));
  SamNearInitialize(elasticity, &s->near);
  *profile = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamShearProfileDestroy(SamShearProfile *profile)
{
  SamShearProfile s = *profile;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamNearDestroy(&s->near));
  PetscCall(SamProfileDestroy(&s->profile));
  PetscCall(VecDestroy(&s->slack));
  PetscCall(VecDestroy(&s->direction));
  PetscCall(SamElasticityDestroy(&s->elasticity));
  PetscCall(PetscFree(*profile));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- direction and slack ---- */

/* A cell without a direction gets that of its neighbours that have one, if they agree to some degree. */
static void ContinueInto(const SamSeen *p, const double *from[2], double *to[2], PetscInt i, PetscInt j)
{
  const PetscInt  nx = p->rows.grid->nx;
  const ptrdiff_t k  = (ptrdiff_t)j * nx + i;
  double          x = 0, y = 0, size;
  PetscInt        count = 0;

  if (!(p->at[0][k] > 0) || from[0][k] != 0 || from[1][k] != 0) return;
  for (PetscInt b = PetscMax(j - 1, 0); b <= PetscMin(j + 1, p->rows.count - 1); b++)
    for (PetscInt a = PetscMax(i - 1, 0); a <= PetscMin(i + 1, nx - 1); a++) {
      const ptrdiff_t l = (ptrdiff_t)b * nx + a;

      if (from[0][l] == 0 && from[1][l] == 0) continue;
      x += from[0][l];
      y += from[1][l];
      count++;
    }
  size = hypot(x, y);
  if (!(size > 0.5 * (double)count) || !count) return;
  to[0][k] = x / size;
  to[1][k] = y / size;
}

/* The direction of the shear where cells slip, continued into the stick zone. */
static PetscErrorCode FindDirection(SamShearProfile s)
{
  const SamGrid   grid = s->grid;
  const PetscInt  nx   = grid->nx;
  const ptrdiff_t own  = (ptrdiff_t)PetscMin(LAYERS, grid->row_start) * nx;
  SamSeen         p, q, slips;
  double         *e[2], *next[2], *direction;
  ptrdiff_t       cells;

  PetscFunctionBegin;
  PetscCall(SamSee(grid, s->fields.pressure, 1, LAYERS, &p));
  PetscCall(SamSee(grid, s->fields.slips, 1, LAYERS, &slips));
  PetscCall(SamSee(grid, s->fields.shear, 2, LAYERS, &q));
  cells = (ptrdiff_t)p.rows.count * nx;
  PetscCall(PetscCalloc4(cells, &e[0], cells, &e[1], cells, &next[0], cells, &next[1]));
  for (ptrdiff_t k = 0; k < cells; k++) {
    const double size = hypot(q.at[0][k], q.at[1][k]);

    if (size > 0 && slips.at[0][k] > 0)
      for (int c = 0; c < 2; c++) e[c][k] = q.at[c][k] / size;
  }
  for (int layer = 0; layer < LAYERS; layer++) {
    for (int c = 0; c < 2; c++) PetscCall(PetscArraycpy(next[c], e[c], cells));
    for (PetscInt j = 0; j < p.rows.count; j++)
      for (PetscInt i = 0; i < nx; i++) ContinueInto(&p, (const double *[]){e[0], e[1]}, next, i, j);
    for (int c = 0; c < 2; c++) PetscCall(PetscArraycpy(e[c], next[c], cells));
  }
  PetscCall(VecGetArrayWrite(s->direction, &direction));
  for (int c = 0; c < 2; c++) PetscCall(PetscArraycpy(direction + c * grid->cells, e[c] + own, grid->cells));
  PetscCall(VecRestoreArrayWrite(s->direction, &direction));
  PetscCall(PetscFree4(e[0], e[1], next[0], next[1]));
  PetscCall(SamForget(&q));
  PetscCall(SamForget(&slips));
  PetscCall(SamForget(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamShearProfileSet(SamShearProfile s, const SamShearFields *fields)
{
  PetscFunctionBegin;
  s->fields = *fields;
  PetscCall(FindDirection(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamShearProfileGetProfile(SamShearProfile s, SamProfile *profile)
{
  PetscFunctionBegin;
  *profile = s->profile;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the direction is not known, far from where it slips, mu p - |q|; where it slips exactly that of the rim. */
PetscErrorCode SamShearProfileFindSlack(SamShearProfile s, SamSlack kind, Vec reference, Vec *slack,
                                        SamProfile *profile)
{
  const PetscInt n = s->grid->cells;
  const double  *p, *b, *q, *e, *r, *slips, *q_r = NULL;
  double        *t;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(s->fields.pressure, &p));
  PetscCall(VecGetArrayRead(s->fields.bound, &b));
  PetscCall(VecGetArrayRead(s->fields.rim, &r));
  PetscCall(VecGetArrayRead(s->fields.shear, &q));
  PetscCall(VecGetArrayRead(s->fields.slips, &slips));
  PetscCall(VecGetArrayRead(s->direction, &e));
  PetscCall(VecGetArrayWrite(s->slack, &t));
  if (kind == SAM_SLACK_OF_CHANGE) PetscCall(VecGetArrayRead(reference, &q_r));
  for (PetscInt k = 0; k < n; k++) {
    const PetscBool known = e[k] != 0 || e[k + n] != 0;
    double          limit = b[k], along = known ? q[k] * e[k] + q[k + n] * e[k + n] : hypot(q[k], q[k + n]);

    if (q_r && known) {
      limit += b[k];
      along -= q_r[k] * e[k] + q_r[k + n] * e[k + n];
    }
    t[k] = slips[k] > 0 ? r[k] : p[k] > 0 ? PetscMax(limit - along, r[k]) : 0;
  }
  if (q_r) PetscCall(VecRestoreArrayRead(reference, &q_r));
  PetscCall(VecRestoreArrayWrite(s->slack, &t));
  PetscCall(VecRestoreArrayRead(s->direction, &e));
  PetscCall(VecRestoreArrayRead(s->fields.slips, &slips));
  PetscCall(VecRestoreArrayRead(s->fields.shear, &q));
  PetscCall(VecRestoreArrayRead(s->fields.rim, &r));
  PetscCall(VecRestoreArrayRead(s->fields.bound, &b));
  PetscCall(VecRestoreArrayRead(s->fields.pressure, &p));
  *slack = s->slack;
  PetscCall(SamShearProfileGetProfile(s, profile));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- within cells ---- */

/* What it is found from. */
typedef struct {
  SamShearProfile s;
  SamProfile      pressure, slack; /* NULL: none */
  SamSlack        kind;
  PetscBool       turned;
  SamSeen         p, b, q, q0, e; /* q0: of the step before */
  const double   *slips;
  const double   *slopes0, *terms0; /* of the step before; NULL: none */
  double         *slopes, *terms, *reference;
} Search;

/* The slope of a field's component along an axis in cell i of row j of those that are seen. */
static double SlopeAt(const SamSeen *f, int component, int axis, PetscInt i, PetscInt j)
{
  const PetscInt nx = f->rows.grid->nx, at = axis ? j : i, last = (axis ? f->rows.count : nx) - 1;
  const double  *x = f->at[component] + (ptrdiff_t)j * nx + i, step = axis ? nx : 1;

  return at > 0 && at < last ? 0.5 * (x[(ptrdiff_t)step] - x[-(ptrdiff_t)step]) : 0;
}

/* The slopes of the root of a function across its cell. */
static void SlopesOf(const SamNear *near, const double fit[SAM_FIT_TERMS], double slopes[2])
{
  const SamRoots *roots = &near->roots[SamShearSubOf(fit)];
  double          part[SAM_ROOTS_CELLS];

  SamRootsTakeLinearPart(roots, SamRootsMean(roots, fit, part, NULL), part, slopes);
}

/* The slope of a component of the direction, by the neighbours that have one. */
static double TurnAt(const SamSeen *e, int component, int axis, PetscInt i, PetscInt j)
{
  const PetscInt  nx = e->rows.grid->nx, at = axis ? j : i, last = (axis ? e->rows.count : nx) - 1;
  const ptrdiff_t k = (ptrdiff_t)j * nx + i, step = axis ? nx : 1;
  const ptrdiff_t low  = at > 0 && (e->at[0][k - step] != 0 || e->at[1][k - step] != 0) ? k - step : k,
                  high = at < last && (e->at[0][k + step] != 0 || e->at[1][k + step] != 0) ? k + step : k;

  return high == low ? 0 : (e->at[component][high] - e->at[component][low]) / (double)((high - low) / step);
}

/*
  The slopes of a cell near an edge: those of e (mu p - t), and of what is perpendicular to e; or of the reference and
  e (2 mu p - t).
*/
static void SlopesAtEdge(const Search *w, const double *fit[2], PetscInt i, PetscInt row, double slopes[4])
{
  const SamGrid   grid = w->s->grid;
  const PetscInt  j = grid->row_start + row - w->p.rows.first, n = grid->cells, at = row * grid->nx + i;
  const ptrdiff_t k    = (ptrdiff_t)j * grid->nx + i;
  const double    e[2] = {w->e.at[0][k], w->e.at[1][k]}, q[2] = {w->q.at[0][k], w->q.at[1][k]};
  const PetscBool refers = fit[1] && w->kind == SAM_SLACK_OF_CHANGE;
  const double    mu = w->b.at[0][k] / w->p.at[0][k], along = q[0] * e[0] + q[1] * e[1];
  double          by_p[2] = {SlopeAt(&w->p, 0, 0, i, j), SlopeAt(&w->p, 0, 1, i, j)}, by_t[2] = {0, 0};

  if (fit[0]) SlopesOf(&w->s->near, fit[0], by_p);
  if (fit[1]) SlopesOf(&w->s->near, fit[1], by_t);
  for (int axis = 0; axis < 2; axis++) {
    const double slope[2] = {SlopeAt(&w->q, 0, axis, i, j), SlopeAt(&w->q, 1, axis, i, j)};
    const double across   = fit[1] && !refers ? slope[1] * e[0] - slope[0] * e[1] : 0;

    for (int c = 0; c < 2; c++)
      slopes[2 * axis + c] =
        e[c] * ((refers ? 2 : 1) * mu * by_p[axis] - by_t[axis]) + (refers   ? w->reference[at + (2 + 2 * axis + c) * n]
                                                                    : fit[1] ? across * (c ? e[0] : -e[1])
                                                                             : TurnAt(&w->e, c, axis, i, j) * along);
  }
}

/* A cell that slips or is near the edge of stick gets its terms from the profiles. */
static void SetTerms(const Search *w, const double *fit[2], ptrdiff_t k, PetscInt at)
{
  const PetscInt n = w->s->grid->cells;

  for (int t = 0; t < 2; t++) {
    const double factor = t == SAM_TERM_SLACK ? -1 : w->b.at[0][k] / w->p.at[0][k];

    for (int c = 0; c < 2 && fit[t]; c++)
      w->terms[at + (t * SAM_TERM + SAM_TERM_VECTOR + c) * n] = factor * w->e.at[c][k];
    for (int c = 0; c < SAM_FIT_TERMS && fit[t]; c++)
      w->terms[at + (t * SAM_TERM + SAM_TERM_FUNCTION + c) * n] = fit[t][c];
  }
}

/* Does not write what is there already, so that untouched pages take no memory: 200 of 500 bytes a cell of the grid. */
static void Put(double *to, double value)
{
  if (*to != value) *to = value;
}

/* Others keep theirs. When the load turns back, the edge of stick is left behind. */
static void KeepTerms(const Search *w, PetscBool only_left, PetscInt at)
{
  const PetscInt  n     = w->s->grid->cells;
  const double   *slack = w->terms0 + at + SAM_TERM_SLACK * SAM_TERM * n;
  const PetscBool moves = w->turned && (slack[0] != 0 || slack[n] != 0);

  for (int c = 0; c < SAM_TERM; c++) {
    const PetscInt pressure = at + (SAM_TERM_PRESSURE * SAM_TERM + c) * n,
                   left = at + (SAM_TERM_LEFT * SAM_TERM + c) * n, of_slack = at + (SAM_TERM_SLACK * SAM_TERM + c) * n;

    Put(w->terms + left, w->terms0[moves ? of_slack : left]);
    if (only_left) continue;
    Put(w->terms + pressure, w->terms0[pressure]);
    Put(w->terms + of_slack, moves ? 0 : w->terms0[of_slack]);
  }
}

static void FindInCell(const Search *w, PetscInt i, PetscInt row)
{
  const SamGrid   grid = w->s->grid;
  const PetscInt  j = grid->row_start + row - w->p.rows.first, n = grid->cells, at = row * grid->nx + i;
  const ptrdiff_t k      = (ptrdiff_t)j * grid->nx + i;
  const double   *fit[2] = {w->pressure ? SamProfileFunction(w->pressure, i, grid->row_start + row) : NULL,
                          w->slack ? SamProfileFunction(w->slack, i, grid->row_start + row) : NULL};
  const PetscBool known = w->e.at[0][k] != 0 || w->e.at[1][k] != 0;
  double          slopes[SAM_SHEAR_SLOPES];

  for (int c = 0; c < SAM_SHEAR_TERMS; c++) Put(w->terms + at + c * n, 0);
  for (int c = 0; c < SAM_SHEAR_SLOPES; c++) Put(w->slopes + at + c * n, 0);
  if (!(w->p.at[0][k] > 0) || (!known && w->q.at[0][k] == 0 && w->q.at[1][k] == 0)) return;
  for (int c = 0; c < SAM_SHEAR_SLOPES; c++) slopes[c] = SlopeAt(&w->q, c % 2, c / 2, i, j);
  if (known && (fit[1] || w->slips[at] > 0)) {
    if (fit[0] || fit[1]) SlopesAtEdge(w, fit, i, row, slopes);
    SetTerms(w, fit, k, at);
    if (fit[1] && w->kind == SAM_SLACK_OF_CHANGE) KeepTerms(w, PETSC_TRUE, at);
  } else if (w->slopes0) {
    for (int c = 0; c < SAM_SHEAR_SLOPES; c++)
      slopes[c] += w->slopes0[at + c * n] - SlopeAt(&w->q0, c % 2, c / 2, i, j);
    KeepTerms(w, PETSC_FALSE, at);
  }
  for (int c = 0; c < SAM_SHEAR_SLOPES; c++) w->slopes[at + c * n] = slopes[c];
}

PetscErrorCode SamShearProfileFind(SamShearProfile s, SamProfile pressure, SamSlack slack, const SamShearBefore *before,
                                   SamShearWithin *within)
{
  Search w = {.s = s, .pressure = pressure, .slack = slack == SAM_SLACK_NONE ? NULL : s->profile, .kind = slack};

  PetscFunctionBegin;
  PetscCall(SamSee(s->grid, s->fields.pressure, 1, 1, &w.p));
  PetscCall(SamSee(s->grid, s->fields.bound, 1, 1, &w.b));
  PetscCall(SamSee(s->grid, s->fields.shear, 2, 1, &w.q));
  PetscCall(SamSee(s->grid, s->direction, 2, 1, &w.e));
  PetscCall(VecGetArrayRead(s->fields.slips, &w.slips));
  if (before) {
    w.turned = before->turned;
    PetscCall(SamSee(s->grid, before->shear, 2, 1, &w.q0));
    PetscCall(VecGetArrayRead(before->within->slopes, &w.slopes0));
    PetscCall(VecGetArrayRead(before->within->terms, &w.terms0));
  }
  PetscCall(VecGetArray(within->reference, &w.reference));
  PetscCall(VecGetArray(within->slopes, &w.slopes));
  PetscCall(VecGetArray(within->terms, &w.terms));
  for (PetscInt row = 0; row < s->grid->rows; row++)
    for (PetscInt i = 0; i < s->grid->nx; i++) FindInCell(&w, i, row);
  PetscCall(VecRestoreArray(within->terms, &w.terms));
  PetscCall(VecRestoreArray(within->slopes, &w.slopes));
  PetscCall(VecRestoreArray(within->reference, &w.reference));
  if (before) {
    PetscCall(VecRestoreArrayRead(before->within->terms, &w.terms0));
    PetscCall(VecRestoreArrayRead(before->within->slopes, &w.slopes0));
    PetscCall(SamForget(&w.q0));
  }
  PetscCall(VecRestoreArrayRead(s->fields.slips, &w.slips));
  PetscCall(SamForget(&w.e));
  PetscCall(SamForget(&w.q));
  PetscCall(SamForget(&w.b));
  PetscCall(SamForget(&w.p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
