/*
  Fields that follow from a solution: the gap u_z + h - rigid, the slip u_t + strain - rigid, the state of each cell.

  They are not stored, but computed row by row where they are needed. Since only these functions compute them, they are
  the same to the last bit in the check, in the next step and in the results.
*/
#include <petsam/private/solutionimpl.h>
#include <petsam/private/balance.h>
#include <petsam/private/pressed.h>
#include <petsam/private/problem.h>

PetscErrorCode SamValuesGet(const SamSolution *s, SamValues *v)
{
  const Vec      fields[] = {s->pressure, s->bound, s->shear, s->displacement_z, s->displacement_t};
  const double **arrays[] = {&v->p, &v->b, &v->q, &v->u_z, &v->u_t};

  PetscFunctionBegin;
  PetscCall(PetscMemzero(v, sizeof(*v)));
  PetscCall(VecGetLocalSize(s->pressure, &v->cells));
  for (int k = 0; k < 5; k++)
    if (fields[k]) PetscCall(VecGetArrayRead(fields[k], arrays[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamValuesRestore(const SamSolution *s, SamValues *v)
{
  const Vec      fields[] = {s->pressure, s->bound, s->shear, s->displacement_z, s->displacement_t};
  const double **arrays[] = {&v->p, &v->b, &v->q, &v->u_z, &v->u_t};

  PetscFunctionBegin;
  for (int k = 0; k < 5; k++)
    if (fields[k]) PetscCall(VecRestoreArrayRead(fields[k], arrays[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamRigidSet(SamRigid *m, SamProblem problem, const SamSolution *s)
{
  SamBalance    rigid[2] = {{.kind = SAM_BALANCE_NORMAL}, {.kind = SAM_BALANCE_TANGENTIAL}};
  const SamGrid grid     = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  for (PetscInt kind = 0; kind < 2; kind++)
    for (PetscInt k = 0; k < 3; k++) rigid[kind].rigid[k] = s->rigid[SamComponentsOf[kind][k]];
  rigid[1].ahead = SamElasticitySpinAhead(SamProblemGetElasticity(problem));
  PetscCall(SamFrameSetGiven(&m->normal, grid, &rigid[0]));
  PetscCall(SamFrameSetGiven(&m->tangential, grid, &rigid[1]));
  PetscCall(SamProblemDisplace(problem, NULL, &s->control, NULL, NULL, &m->strain, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SamRigidRow SamRigidOfGap(const SamRigid *m, PetscInt j)
{
  const double *a = m->normal.fixed;

  return (SamRigidRow){a[0] - a[1] * SamFrameEta(&m->normal, j), a[2]};
}

SamRigidRow SamRigidOfSlip(const SamRigid *m, PetscInt component, PetscInt j)
{
  const SamGrid   grid = m->tangential.grid;
  const double   *a = m->tangential.fixed, eta = SamFrameEta(&m->tangential, j);
  const SamStrain e    = m->strain;
  const double    y    = grid->center[1] + eta * grid->length;
  const double    at_x = component ? e.xy : e.xx, at_y = component ? e.yy : e.xy;
  SamRigidRow     row = component ? (SamRigidRow){a[1], a[2]} : (SamRigidRow){SamFrameX(a, eta), 0};

  row.a -= at_x * grid->center[0] + at_y * y;
  row.b -= at_x * grid->length;
  return row;
}

SAM_VECTORIZED static void SubtractRow(PetscInt n, const double *restrict u, SamRigidRow r, double xi0, double dxi,
                                       double *restrict value)
{
  const double a = r.a, b = r.b;

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) value[i] = u[i] - (a + b * (xi0 + (double)i * dxi));
}

SAM_VECTORIZED static void GapRow(PetscInt n, const double *restrict u, const double *restrict h, SamRigidRow r,
                                  double xi0, double dxi, double *restrict value)
{
  const double a = r.a, b = r.b;

#pragma omp simd
  for (PetscInt i = 0; i < n; i++) value[i] = u[i] + h[i] - (a + b * (xi0 + (double)i * dxi));
}

/* Computes a component of the slip along row j. */
static void SlipRow(const SamRigid *m, PetscInt component, PetscInt j, const double u[], double slip[])
{
  SubtractRow(m->normal.grid->nx, u, SamRigidOfSlip(m, component, j), m->normal.xi0, m->normal.dxi, slip);
}

void SamRigidGap(const SamRigid *m, SamRigidRow row, const double u[], const double h[], double value[])
{
  GapRow(m->normal.grid->nx, u, h, row, m->normal.xi0, m->normal.dxi, value);
}

PetscErrorCode SamSolutionComputeSlip(SamProblem problem, const SamSolution *s, PetscInt component, double slip[])
{
  SamRigid      motion;
  const double *u;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamRigidSet(&motion, problem, s));
  PetscCall(VecGetArrayRead(s->displacement_t, &u));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * grid->nx;

    SlipRow(&motion, component, j, u + component * grid->cells + k, slip + k);
  }
  PetscCall(VecRestoreArrayRead(s->displacement_t, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamIncrementCreate(SamProblem problem, const SamSolution *before, const SamSolution *now,
                                  SamIncrement *s)
{
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  s->grid     = grid;
  s->v_now    = now->displacement_t;
  s->v_before = before ? before->displacement_t : NULL;
  PetscCall(PetscMalloc3(grid->nx, &s->row[0], grid->nx, &s->row[1], grid->nx, &s->scratch));
  PetscCall(PetscMalloc2(grid->nx, &s->slip[0], grid->nx, &s->slip[1]));
  PetscCall(SamRigidSet(&s->now, problem, now));
  PetscCall(VecGetArrayRead(s->v_now, &s->u_now));
  s->solutions[1] = now;
  s->follows_slip = SamProblemFollowsSlip(problem);
  PetscCall(SamValuesGet(now, &s->at_now));
  if (now->aside) PetscCall(VecGetArrayRead(now->aside, &s->aside));
  if (!before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamRigidSet(&s->before, problem, before));
  PetscCall(VecGetArrayRead(s->v_before, &s->u_before));
  s->solutions[0] = before;
  PetscCall(SamValuesGet(before, &s->at_before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamIncrementDestroy(SamIncrement *s)
{
  PetscFunctionBegin;
  if (s->aside) PetscCall(VecRestoreArrayRead(s->solutions[1]->aside, &s->aside));
  PetscCall(SamValuesRestore(s->solutions[1], &s->at_now));
  if (s->solutions[0]) PetscCall(SamValuesRestore(s->solutions[0], &s->at_before));
  if (s->v_before) PetscCall(VecRestoreArrayRead(s->v_before, &s->u_before));
  PetscCall(VecRestoreArrayRead(s->v_now, &s->u_now));
  PetscCall(PetscFree3(s->row[0], s->row[1], s->scratch));
  PetscCall(PetscFree2(s->slip[0], s->slip[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if cell k comes into contact in the step. */
static PetscBool Enters(const SamIncrement *s, ptrdiff_t k)
{
  return (!s->solutions[0] || !SamIsPressed(s->at_before.p[k])) && SamIsPressed(s->at_now.p[k]);
}

void SamIncrementComputeRow(const SamIncrement *s, PetscInt j)
{
  const ptrdiff_t cells = s->grid->cells;

  for (PetscInt c = 0; c < 2; c++) {
    const ptrdiff_t k = (ptrdiff_t)c * s->grid->cells + (ptrdiff_t)j * s->grid->nx;

    SlipRow(&s->now, c, j, s->u_now + k, s->slip[c]);
    if (s->u_before)
      SlipRow(&s->before, c, j, s->u_before + k, s->scratch);
    else
      (void)memset(s->scratch, 0, sizeof(*s->scratch) * (size_t)s->grid->nx);
    for (PetscInt i = 0; i < s->grid->nx; i++) s->row[c][i] = s->slip[c][i] - s->scratch[i];
    for (PetscInt i = 0; s->aside && i < s->grid->nx; i++)
      s->row[c][i] -= Enters(s, k + i - c * cells) ? s->aside[k + i] : 0;
  }
}

void SamIncrementFindSpan(const SamIncrement *s, PetscInt j, PetscInt span[2])
{
  const ptrdiff_t first = (ptrdiff_t)j * s->grid->nx;
  const double   *after = s->at_now.p + first, *before = s->solutions[0] ? s->at_before.p + first : after;
  PetscInt        from = 0, to = s->grid->nx;

  while (from < to && !SamIsPressed(after[from]) && !SamIsPressed(before[from])) from++;
  while (to > from && !SamIsPressed(after[to - 1]) && !SamIsPressed(before[to - 1])) to--;
  span[0] = from;
  span[1] = to;
}

void SamIncrementOpposeRow(const SamIncrement *s, PetscInt j)
{
  const ptrdiff_t cells = s->grid->cells, first = (ptrdiff_t)j * s->grid->nx;

  for (PetscInt c = 0; c < 2 && s->aside; c++)
    for (PetscInt i = 0; i < s->grid->nx; i++)
      s->row[c][i] -= Enters(s, first + i) ? 0 : s->aside[c * cells + first + i];
}

void SamIncrementTurnRow(const SamIncrement *s, PetscInt j, double *const to[2])
{
  const double   *b0 = s->at_before.b, *q0 = s->at_before.q, *b1 = s->at_now.b, *q1 = s->at_now.q;
  const ptrdiff_t first = (ptrdiff_t)j * s->grid->nx, cells = s->grid->cells;

  for (PetscInt i = 0; i < s->grid->nx; i++) {
    const ptrdiff_t k = first + i, l = k + cells;
    const double    x = to[0][i] = s->row[0][i], y = to[1][i] = s->row[1][i];

    if (b0[k] == 0 && b1[k] == 0) continue; /* there is no shear whose angle could turn */
    const double x0 = b0[k] > 0 ? q0[k] / b0[k] : 0, y0 = b0[k] > 0 ? q0[l] / b0[k] : 0;
    const double x1 = b1[k] > 0 ? q1[k] / b1[k] : 0, y1 = b1[k] > 0 ? q1[l] / b1[k] : 0;
    const double along = x0 * x1 + y0 * y1, weight = PetscMax(0.5 * (x0 * x0 + y0 * y0 + along), 0);
    const double c = x1 * x1 + y1 * y1 + weight * along, d = weight * (x0 * y1 - y0 * x1), size = sqrt(c * c + d * d);
    const double cosine = size > 0 ? c / size : 1, sine = size > 0 ? d / size : 0;

    to[0][i] = cosine * x - sine * y;
    to[1][i] = sine * x + cosine * y;
  }
}

/* Returns the length of the slip of this rank's cell k, in the row that was computed last, if all cells in contact are
   measured by it; else -1. */
static double Measured(const SamIncrement *s, ptrdiff_t k)
{
  const SamValues   *v     = &s->at_now;
  const ptrdiff_t    i     = k % s->grid->nx;
  const SamCellState state = SamCellStateOf(v->p[k], v->q[k], v->q[k + s->grid->cells], v->b[k]);

  if (state == SAM_CELL_OPEN || !SamIsPressed(s->at_before.p[k])) return -1;
  return state == SAM_CELL_STICK ? 0 : hypot(s->row[0][i], s->row[1][i]);
}

PetscErrorCode SamIncrementMeasure(SamIncrement *s)
{
  const PetscInt nx      = s->grid->nx;
  double         most[2] = {-INFINITY, 0}; /* minus the shortest slip, and the longest one */

  PetscFunctionBegin;
  s->slides = 0;
  if (!s->solutions[0]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < s->grid->rows && most[0] < 0; j++) { /* once a cell sticks, the shortest is known */
    SamIncrementComputeRow(s, j);
    for (PetscInt i = 0; i < nx; i++) {
      const double slip = Measured(s, (ptrdiff_t)j * nx + i);

      if (slip < 0) continue;
      most[0] = PetscMax(most[0], -slip);
      most[1] = PetscMax(most[1], slip);
    }
  }
  PetscCall(SamMax(s->grid->comm, 2, most));
  s->ends[0] = -most[0];
  s->ends[1] = most[1];
  if (most[1] > 0) s->slides = -most[0] / most[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shear against which a cell slips after it has touched in a step, relative to the final bound: in a step from no
   contact, and in others. The bound grows like the root of the time, the slip fades (examples/manual/LOADS.md). */
#define TOUCHED_FIRST 0.55
#define TOUCHED       0.6

/*
  A cell slides under the mean of the bounds before and after the step, b0 and b1, also where contact is made or lost.
  So the bounds of all cells add up to friction times N, and a contact that slides as a whole dissipates the work of its
  loads. A cell that stuck before, or slid the other way, begins to slide at some time within the step, on average under
  b1 - (b1 - b0)/4; where it leaves the contact, it slides late and works under b0/8. That holds for slip at the edge of
  a contact that sticks. If all cells slide, they begin the earlier the more alike their slip is: if half the ratio of
  the shortest slip to the longest one is more than 1/4, that is the weight of b0. If slip changes the bound, the mean
  is used.

  A cell that stuck and loses its contact is released: its shear falls from q0 to 0, and with it what the shear has
  stored, along the slip ds, as the friction goes to 0 before the contact is lost. Where ds follows in proportion, the
  work is -q0.ds/2, which is exact for all cells together where their displacement is held. Springback along the shear
  does no work. If the contact is lost as a whole, that holds for cells that slid, too, and only displacements that are
  given count: others are unknown then. Of spheres whose N falls to 0 or nearly so in 28 random histories with 8 steps a
  row, the energy then lacks 2 % instead of 28 in the median, and 4 instead of 50 in 9 of 10.
*/
#define BEGUN  0.25  /* share of b0 in the bound of a cell that begins to slide */
#define LEAVES 0.125 /* the same of one that leaves the contact later in the step */

/* True if the tried solution has lost the contact as a whole. */
static PetscBool IsApart(const SamIncrement *s)
{
  return s->solutions[1]->load[SAM_COMPONENT_N] > 0 ? PETSC_FALSE : PETSC_TRUE;
}

/* The part of the slip of this rank's cell k, in the row that was computed last, by which it goes back on its slip
   before: 1 if it turned round, -1 if it went on. */
static double Reversal(const SamIncrement *s, ptrdiff_t k)
{
  static const SamComponent along[2] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY};

  const ptrdiff_t i    = k % s->grid->nx;
  const double    size = s->at_before.b[k] * hypot(s->row[0][i], s->row[1][i]);
  double          work = 0;

  for (int c = 0; c < 2; c++)
    if (!IsApart(s) || !s->solutions[1]->control.force[along[c]])
      work += s->at_before.q[k + c * (ptrdiff_t)s->grid->cells] * s->row[c][i];
  return size > 0 ? PetscClipInterval(work / size, -1, 1) : 0;
}

/* The weight of the bound before the step, and its derivatives by the reversal and by `slides`. */
static double ShareBefore(const SamIncrement *s, SamCellMotion motion, ptrdiff_t k, double slopes[2])
{
  double begun, late, least;

  slopes[0] = slopes[1] = 0;
  if (motion == SAM_CELL_MOTION_NONE || motion == SAM_CELL_MOTION_FIRST) return 0;
  if (motion == SAM_CELL_MOTION_RELEASED) {
    late = PetscMax(-Reversal(s, k), 0);
    if (late > 0) slopes[0] = -0.5;
    return 0.5 * late;
  }
  if (s->follows_slip || motion == SAM_CELL_MOTION_ENTERS) return 0.5;
  begun = motion == SAM_CELL_MOTION_BEGINS ? 1 : PetscMax(Reversal(s, k), 0);
  if (begun == 0) return 0.5;
  least = motion == SAM_CELL_MOTION_LEAVES ? LEAVES : BEGUN;
  late  = PetscMax(least, 0.5 * s->slides);
  if (begun < 1) slopes[0] = late - 0.5;
  if (late > least && s->slides < 1) slopes[1] = 0.5 * begun;
  return 0.5 + begun * (late - 0.5);
}

SamCellMotion SamIncrementGetCellMotion(const SamIncrement *s, ptrdiff_t k, double share[2])
{
  const SamValues   *a = &s->at_before, *b = &s->at_now;
  const ptrdiff_t    l      = k + s->grid->cells;
  const SamCellState now    = SamCellStateOf(b->p[k], b->q[k], b->q[l], b->b[k]);
  SamCellState       before = SAM_CELL_OPEN;
  SamCellMotion      motion = SAM_CELL_MOTION_NONE;
  double             slopes[2];

  if (s->solutions[0]) before = SamCellStateOf(a->p[k], a->q[k], a->q[l], a->b[k]);
  if (now == SAM_CELL_OPEN && before != SAM_CELL_OPEN)
    motion = before == SAM_CELL_STICK || IsApart(s) ? SAM_CELL_MOTION_RELEASED : SAM_CELL_MOTION_LEAVES;
  if (now == SAM_CELL_SLIP && before == SAM_CELL_SLIP) motion = SAM_CELL_MOTION_ALWAYS;
  if (now == SAM_CELL_SLIP && before == SAM_CELL_STICK) motion = SAM_CELL_MOTION_BEGINS;
  if (now == SAM_CELL_SLIP && before == SAM_CELL_OPEN)
    motion = s->solutions[0] ? SAM_CELL_MOTION_ENTERS : SAM_CELL_MOTION_FIRST;
  share[0] = ShareBefore(s, motion, k, slopes);
  share[1] = motion == SAM_CELL_MOTION_NONE ? 0 : 1 - share[0];
  if (SamRuleTouches(s->solutions[1]->rule) && (motion == SAM_CELL_MOTION_ENTERS || motion == SAM_CELL_MOTION_FIRST)) {
    share[0] = 0;
    share[1] = s->solutions[0] && SamSolutionGetNormal(s->solutions[0]) > 0 ? TOUCHED : TOUCHED_FIRST;
  }
  return motion;
}

double SamIncrementGetWork(const SamIncrement *s, ptrdiff_t k, double share[2], SamCellMotion *motion)
{
  const ptrdiff_t i = k % s->grid->nx;

  *motion = SamIncrementGetCellMotion(s, k, share);
  if (*motion == SAM_CELL_MOTION_NONE) return 0;
  return SamIncrementMix(share, s->at_before.b, s->at_now.b, k) * hypot(s->row[0][i], s->row[1][i]);
}

void SamIncrementGetShareSlopes(const SamIncrement *s, SamCellMotion motion, ptrdiff_t k, double slopes[2])
{
  (void)ShareBefore(s, motion, k, slopes);
}

PetscErrorCode SamIncrementFindEnds(const SamIncrement *s, PetscInt64 cell[2], double slope[2])
{
  const PetscInt nx    = s->grid->nx;
  PetscInt64     at[2] = {-1, -1};

  PetscFunctionBegin;
  for (PetscInt end = 0; end < 2; end++) slope[end] = 0;
  cell[0] = cell[1] = -1;
  if (!(s->slides > 0 && s->slides < 1)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt j = 0; j < s->grid->rows; j++) {
    SamIncrementComputeRow(s, j);
    for (PetscInt i = 0; i < nx; i++) {
      const double     slip = Measured(s, (ptrdiff_t)j * nx + i);
      const PetscInt64 here = (PetscInt64)(s->grid->row_start + j) * nx + i;

      for (PetscInt end = 0; end < 2; end++)
        if (slip == s->ends[end]) at[end] = PetscMax(at[end], here);
    }
  }
  PetscCallMPI(MPI_Allreduce(at, cell, 2, MPIU_INT64, MPI_MAX, s->grid->comm));
  slope[0] = s->slides / s->ends[0];
  slope[1] = -s->slides / s->ends[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionCreateSeparation(SamProblem problem, SamState state, SamGeneration generation, Vec *h)
{
  PetscBool adds;
  const Vec gap = SamProblemGetGap(problem);

  PetscFunctionBegin;
  PetscCall(SamProblemAddSeparation(problem, state, generation, NULL, &adds));
  *h = gap;
  if (!adds) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(SamProblemGetGrid(problem), 1, h));
  PetscCall(VecCopy(gap, *h));
  PetscCall(SamProblemAddSeparation(problem, state, generation, *h, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionDestroySeparation(SamProblem problem, Vec *h)
{
  PetscFunctionBegin;
  if (*h != SamProblemGetGap(problem)) PetscCall(VecDestroy(h));
  *h = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionComputeGap(SamProblem problem, const SamSolution *s, Vec displacement, Vec separation,
                                     Vec gap)
{
  SamRigid      motion;
  const double *u = NULL, *h;
  double       *g, *zero;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamRigidSet(&motion, problem, s));
  PetscCall(PetscCalloc1(grid->nx, &zero));
  PetscCall(VecGetArrayRead(separation, &h));
  if (displacement) PetscCall(VecGetArrayRead(displacement, &u));
  PetscCall(VecGetArrayWrite(gap, &g));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const ptrdiff_t k = (ptrdiff_t)j * grid->nx;

    SamRigidGap(&motion, SamRigidOfGap(&motion, j), u ? u + k : zero, h + k, g + k);
  }
  PetscCall(VecRestoreArrayWrite(gap, &g));
  if (displacement) PetscCall(VecRestoreArrayRead(displacement, &u));
  PetscCall(VecRestoreArrayRead(separation, &h));
  PetscCall(PetscFree(zero));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSolutionComputeStates(const SamSolution *s, Vec state)
{
  SamValues v;
  double   *states;

  PetscFunctionBegin;
  PetscCall(SamValuesGet(s, &v));
  PetscCall(VecGetArrayWrite(state, &states));
  for (PetscInt k = 0; k < v.cells; k++) states[k] = SamCellStateOf(v.p[k], v.q[k], v.q[k + v.cells], v.b[k]);
  PetscCall(VecRestoreArrayWrite(state, &states));
  PetscCall(SamValuesRestore(s, &v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamBalanceStore(const SamBalance *balance, PetscReal load[], PetscReal rigid[])
{
  for (PetscInt k = 0; k < 3; k++) {
    load[SamComponentsOf[balance->kind][k]]  = balance->load[k];
    rigid[SamComponentsOf[balance->kind][k]] = balance->rigid[k];
  }
}

/* Loads whose difference, relative to the largest of their kind, is smaller are equal but for rounding; likewise
   motions. */
#define ROUNDING 1e-13

void SamControlSnap(const SamControl *to, PetscReal lever, SamBalanceKind kind, SamControl *control)
{
  SamControl snapped = *control;

  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt c    = SamComponentsOf[kind][k];
    PetscReal      size = 0;

    for (PetscInt n = 0; n < 3; n++) { /* in the units of component c */
      const PetscInt  other = SamComponentsOf[kind][n];
      const int       power = (c >= SAM_COMPONENT_MX) - (other >= SAM_COMPONENT_MX);
      const PetscReal unit  = power == 0 ? 1 : (power > 0) == (control->force[c] != 0) ? lever : 1 / lever;

      if (control->force[other] == control->force[c]) size = PetscMax(size, unit * PetscAbsReal(control->value[other]));
    }
    if (SamControlWay(to, c) != SamControlWay(control, c) ||
        PetscAbsReal(to->value[c] - control->value[c]) > ROUNDING * size)
      return;
    snapped.value[c] = to->value[c];
  }
  *control = snapped;
}

PetscBool SamControlIsSame(const SamControl *a, const SamControl *b, SamBalanceKind kind)
{
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt c = SamComponentsOf[kind][k];

    if (SamControlWay(a, c) != SamControlWay(b, c) || a->value[c] != b->value[c]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
