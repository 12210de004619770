/*
  Stresses on a plane across the surface.

  Problem: for each depth, convolve the tractions of each line of cells parallel to the section, along the section, with
  the kernels at the distance of that line, and sum over all lines.

  Algorithm:
    1. The tractions of each line, padded with zeros, are transformed along it once.
    2. For each depth and each distance d: the kernels of that row of lags are tabulated and transformed. An even one
       has a real transform and an odd one an imaginary one, so two share a transform.
    3. Lines at the distances d and -d have the same kernels, except for the sign of kernels that are odd across the
       section: the sum of the lines is multiplied by the even kernels, their difference by the odd ones. Products are
       added in the frequency domain, for all steps of a batch.
    4. Each depth, component and step is transformed back.
  Depths are divided among the ranks, and the sums of a depth do not depend on the rank that computes them.

  A section along y is one along x with the axes exchanged.
*/
#include <petsam/private/fourier.h>
#include <petsam/private/grid.h>
#include <petsam/private/rows.h>
#include <petsam/private/stressimpl.h>
#include <fftw3.h>

typedef double Complex[2];

enum { EVEN, ODD, HALVES };    /* across: sum and difference of two lines */
enum { PLAIN, TURNED, TURNS }; /* along: unchanged, and times i for odd kernels */

/* The tractions of a step along the lines first ... first + count - 1, transformed. */
typedef struct {
  PetscInt first, count;
  Complex *lines;                         /* (count, SAM_STRESS_TRACTIONS, n) */
  double  *surface[SAM_STRESS_TRACTIONS]; /* on the section */
  double  *sums;                          /* of the smooth part */
} Step;

struct _n_SamSection {
  SamStress      stress;
  SamGrid        grid;
  SamSectionAxis axis;
  PetscInt       index;         /* index of the section's line of cells */
  PetscInt       length, lines; /* cells along, lines across */
  double         side[2];       /* widths of a cell along and across, m */
  PetscInt       first, count;  /* this rank's depths */
  double        *depths;        /* this rank's depths, m */
  PetscInt       steps, room;
  Step          *step;
  PetscInt       period, n; /* length of the transforms; number of their frequencies */
  fftw_plan      forward, backward;
  double        *line;     /* period */
  Complex       *spectrum; /* n */
};

/* The component or traction with the axes exchanged, for sections along y */
static const PetscInt exchanged_component[] = {SAM_STRESS_YY, SAM_STRESS_XX, SAM_STRESS_ZZ,
                                               SAM_STRESS_XY, SAM_STRESS_YZ, SAM_STRESS_XZ};
static const PetscInt exchanged_traction[]  = {SAM_STRESS_P, SAM_STRESS_QY, SAM_STRESS_QX};

/* ---- life ---- */

static PetscErrorCode CreateTransforms(SamSection s)
{
  PetscFunctionBegin;
  s->period = 2 * SamFourierFastLength(s->length);
  s->n      = s->period / 2 + 1;
  PetscCall(SamAllocateZeros(sizeof(*s->line) * (size_t)s->period, &s->line));
  PetscCall(SamAllocateZeros(sizeof(*s->spectrum) * (size_t)s->n, &s->spectrum));
  /* With FFTW_ESTIMATE, as measured plans differ from rank to rank. */
  s->forward =
    fftw_plan_dft_r2c_1d((int)s->period, s->line, (fftw_complex *)s->spectrum, FFTW_ESTIMATE | FFTW_PRESERVE_INPUT);
  s->backward = fftw_plan_dft_c2r_1d((int)s->period, (fftw_complex *)s->spectrum, s->line, FFTW_ESTIMATE);
  PetscCheck(s->forward && s->backward, PETSC_COMM_SELF, PETSC_ERR_LIB, SAM_NO_PLAN);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives each rank a share of the depths; the first depths go to the first ranks. */
static PetscErrorCode DivideDepths(SamSection s, PetscInt n, const PetscReal depths[])
{
  PetscMPIInt rank, ranks;
  PetscInt    end;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(s->grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(s->grid->comm, &ranks));
  s->first = (PetscInt)((PetscInt64)n * rank / ranks);
  end      = (PetscInt)((PetscInt64)n * (rank + 1) / ranks);
  s->count = end - s->first;
  PetscCall(PetscMalloc1(s->count, &s->depths));
  for (PetscInt k = 0; k < s->count; k++) s->depths[k] = (double)depths[s->first + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSectionCreate(SamStress stress, SamSectionAxis axis, PetscInt index, PetscInt n,
                                const PetscReal depths[], SamSection *section)
{
  const SamGrid  grid    = stress->grid;
  const PetscInt cells[] = {grid->nx, grid->ny};
  const double   sides[] = {(double)grid->area[0], (double)grid->area[1]};
  const PetscInt along = axis == SAM_SECTION_X ? 0 : 1, across = 1 - along;
  SamSection     s;

  PetscFunctionBegin;
  PetscCheck(index >= 0 && index < cells[across], grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Section at line %" PetscInt_FMT " of %" PetscInt_FMT, index, cells[across]);
  for (PetscInt k = 0; k < n; k++) PetscCall(SamStressUseDepth(stress, depths[k]));
  PetscCall(PetscNew(&s));
  PetscCall(SamGridReference(grid));
  s->stress  = stress;
  s->grid    = grid;
  s->axis    = axis;
  s->index   = index;
  s->length  = cells[along];
  s->lines   = cells[across];
  s->side[0] = sides[along];
  s->side[1] = sides[across];
  PetscCall(DivideDepths(s, n, depths));
  PetscCall(CreateTransforms(s));
  *section = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ForgetSteps(SamSection s)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->steps; k++) {
    SamFree(s->step[k].lines);
    PetscCall(PetscFree(s->step[k].sums));
    for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) PetscCall(PetscFree(s->step[k].surface[t]));
  }
  s->steps = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSectionDestroy(SamSection *section)
{
  SamSection s = *section;

  PetscFunctionBegin;
  *section = NULL;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForgetSteps(s));
  PetscCall(PetscFree(s->step));
  PetscCall(PetscFree(s->depths));
  fftw_destroy_plan(s->forward);
  fftw_destroy_plan(s->backward);
  SamFree(s->line);
  SamFree(s->spectrum);
  PetscCall(SamGridDestroy(&s->grid));
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSectionGetDepths(SamSection s, PetscInt *first, PetscInt *count, PetscInt *length)
{
  PetscFunctionBegin;
  if (first) *first = s->first;
  if (count) *count = s->count;
  if (length) *length = s->length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- steps ---- */

/* Finds the lines that have traction on any rank; n is 0 if there are none. */
static PetscErrorCode FindLines(SamSection s, const double field[], PetscInt *first, PetscInt *n)
{
  const SamGrid g       = s->grid;
  PetscReal     ends[2] = {-PETSC_INFINITY, -PETSC_INFINITY}; /* minus the first line, and the last line */

  PetscFunctionBegin;
  for (PetscInt c = 0; c < SAM_STRESS_TRACTIONS; c++)
    for (PetscInt j = 0; j < g->rows; j++)
      for (PetscInt i = 0; i < g->nx; i++) {
        const PetscReal line = (PetscReal)(s->axis == SAM_SECTION_X ? g->row_start + j : i);

        if (field[c * g->cells + j * g->nx + i] == 0) continue;
        ends[0] = PetscMax(ends[0], -line);
        ends[1] = PetscMax(ends[1], line);
      }
  PetscCall(SamMax(g->comm, 2, ends));
  *first = ends[1] >= 0 ? (PetscInt)-ends[0] : 0;
  *n     = ends[1] >= 0 ? (PetscInt)ends[1] - *first + 1 : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Transforms the lines of one traction, with the section's axes. */
static void TransformLines(SamSection s, Step *step, PetscInt traction, const double all[])
{
  const PetscInt nx = s->grid->nx;

  for (PetscInt v = 0; v < step->count; v++) {
    const PetscInt line = step->first + v;

    for (PetscInt u = 0; u < s->length; u++)
      s->line[u] = s->stress->sign[traction] * (s->axis == SAM_SECTION_X ? all[line * nx + u] : all[u * nx + line]);
    for (PetscInt u = s->length; u < s->period; u++) s->line[u] = 0;
    fftw_execute(s->forward);
    memcpy(step->lines + (v * SAM_STRESS_TRACTIONS + traction) * (ptrdiff_t)s->n, s->spectrum,
           sizeof(*s->spectrum) * (size_t)s->n);
    if (line == s->index) memcpy(step->surface[traction], s->line, sizeof(double) * (size_t)s->length);
  }
}

PetscErrorCode SamSectionAddStep(SamSection s, Vec tractions)
{
  const SamGrid g = s->grid;
  const double *field, *all;
  Step          step = {.first = 0};
  SamRows       rows;

  PetscFunctionBegin;
  PetscCall(SamGridCheckVec(g, SAM_STRESS_TRACTIONS, tractions, "The tractions"));
  if (s->steps == s->room) {
    s->room = 2 * s->room + 8;
    PetscCall(PetscRealloc(sizeof(*s->step) * (size_t)s->room, &s->step));
  }
  PetscCall(VecGetArrayRead(tractions, &field));
  PetscCall(FindLines(s, field, &step.first, &step.count));
  PetscCall(SamAllocate(sizeof(*step.lines) * (size_t)(step.count * SAM_STRESS_TRACTIONS) * (size_t)s->n, &step.lines));
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) PetscCall(PetscCalloc1(s->length, &step.surface[t]));
  PetscCall(SamRowsCreate(g, 0, g->ny, &rows)); /* all rows */
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) {
    const PetscInt from = s->axis == SAM_SECTION_X ? t : exchanged_traction[t];

    PetscCall(SamRowsFetch(&rows, g->nx, field + from * g->cells, &all));
    TransformLines(s, &step, t, all);
    PetscCall(SamRowsRestore(&rows, &all));
  }
  PetscCall(SamRowsDestroy(&rows));
  PetscCall(PetscMalloc1(s->stress->sums, &step.sums));
  if (s->stress->sums)
    PetscCall((*s->stress->ops.reduce)(s->stress, (const double *[]){field, field + g->cells, field + 2 * g->cells},
                                       step.sums));
  PetscCall(VecRestoreArrayRead(tractions, &field));
  s->step[s->steps++] = step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- kernels of a distance ---- */

/* Kernels that share a transform: one that is even along the section and, except in the last pair, one that is odd */
static const SamStressKernel shared[][2] = {
  {{SAM_STRESS_PLANE_P, 0}, {SAM_STRESS_PLANE_P, 2}},  {{SAM_STRESS_PLANE_P, 1}, {SAM_STRESS_PLANE_X, 0}},
  {{SAM_STRESS_PLANE_X, 2}, {SAM_STRESS_PLANE_X, 1}},  {{SAM_STRESS_PLANE_Y, 0}, {SAM_STRESS_PLANE_Y, 2}},
  {{SAM_STRESS_PLANE_Y, 1}, {SAM_STRESS_NORMAL_P, 1}}, {{SAM_STRESS_NORMAL_P, 0}, {SAM_STRESS_NORMAL_T, 1}},
  {{SAM_STRESS_NORMAL_P, 2}, {SAM_STRESS_GROUPS, 0}},  {{SAM_STRESS_NORMAL_T, 0}, {SAM_STRESS_GROUPS, 0}},
  {{SAM_STRESS_NORMAL_T, 2}, {SAM_STRESS_GROUPS, 0}},  {{SAM_STRESS_NORMAL_Z, 1}, {SAM_STRESS_NORMAL_Z, 0}},
};
enum { SHARED = sizeof(shared) / sizeof(shared[0]) };

/* Scratch of a computation, as parts of one array */
typedef struct {
  double  *all;
  double  *lags[SAM_STRESS_GROUPS][SAM_STRESS_GROUP];    /* values, `length` of each */
  double  *kernels[SAM_STRESS_GROUPS][SAM_STRESS_GROUP]; /* transforms, n of each */
  Complex *pair[SAM_STRESS_TRACTIONS][HALVES][TURNS];    /* two lines of a step */
  Complex *sum;                                          /* (steps, components, n) */
} Work;

static PetscErrorCode CreateWork(SamSection s, Work *w)
{
  enum { KERNELS = SAM_STRESS_GROUPS * SAM_STRESS_GROUP, PAIRS = SAM_STRESS_TRACTIONS * HALVES * TURNS, ALIGN = 8 };

  const size_t n = (size_t)(s->n + ALIGN - 1) / ALIGN * ALIGN, length = (size_t)(s->length + ALIGN - 1) / ALIGN * ALIGN;
  double      *next;

  PetscFunctionBegin;
  PetscCall(SamAllocate(
    sizeof(double) * (KERNELS * (length + n) + 2 * n * (PAIRS + (size_t)(s->steps * SAM_STRESS_COMPONENTS))), &w->all));
  next = w->all;
  for (int k = 0; k < KERNELS; k++, next += length + n) {
    w->lags[k / SAM_STRESS_GROUP][k % SAM_STRESS_GROUP]    = next;
    w->kernels[k / SAM_STRESS_GROUP][k % SAM_STRESS_GROUP] = next + length;
  }
  for (int k = 0; k < PAIRS; k++, next += 2 * n)
    w->pair[k / TURNS / HALVES][k / TURNS % HALVES][k % TURNS] = (Complex *)next;
  w->sum = (Complex *)next;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the transforms of all kernels at the distance of d lines: real transforms, or the imaginary parts for odd
  kernels.
*/
static void TransformKernels(SamSection s, double depth, PetscInt d, Work *w)
{
  const double scale = 1 / (double)s->period;

  for (PetscInt g = 0; g < s->stress->groups; g++)
    (*s->stress->ops.row)(s->stress, s->side, depth, (SamStressGroup)g, d, s->length, w->lags[g]);
  for (PetscInt k = 0; k < SHARED; k++) {
    const SamStressKernel even = shared[k][0], odd = shared[k][1];
    const PetscBool       both = odd.group < SAM_STRESS_GROUPS;
    if ((PetscInt)even.group >= s->stress->groups) continue;
    const double *const a = w->lags[even.group][even.member], *const b = both ? w->lags[odd.group][odd.member] : NULL;

    memset(s->line, 0, sizeof(double) * (size_t)s->period);
    s->line[0] = scale * a[0];
    for (PetscInt i = 1; i < s->length; i++) {
      s->line[i]             = scale * (a[i] + (both ? b[i] : 0));
      s->line[s->period - i] = scale * (a[i] - (both ? b[i] : 0));
    }
    fftw_execute(s->forward);
    for (PetscInt m = 0; m < s->n; m++) w->kernels[even.group][even.member][m] = s->spectrum[m][0];
    for (PetscInt m = 0; both && m < s->n; m++) w->kernels[odd.group][odd.member][m] = s->spectrum[m][1];
  }
}

/* ---- products ---- */

/* Computes sum and difference of two lines, either of which may be NULL for zero, unchanged and times i. */
SAM_VECTORIZED static void Combine(PetscInt n, const Complex *restrict before, const Complex *restrict after,
                                   double   sign, Complex *restrict plain, Complex *restrict turned)
{
  for (PetscInt m = 0; m < n; m++) {
    const double re = (before ? before[m][0] : 0) + (after ? sign * after[m][0] : 0),
                 im = (before ? before[m][1] : 0) + (after ? sign * after[m][1] : 0);

    plain[m][0]  = re;
    plain[m][1]  = im;
    turned[m][0] = -im;
    turned[m][1] = re;
  }
}

/* Computes to += a x + b y + c z with real a, b and c. */
SAM_VECTORIZED static void AddThree(PetscInt n, const double *restrict a, const double *restrict b,
                                    const double *restrict c, const Complex *restrict x, const Complex *restrict y,
                                    const Complex *restrict z, Complex *restrict to)
{
  for (PetscInt m = 0; m < n; m++) {
    to[m][0] += a[m] * x[m][0] + b[m] * y[m][0] + c[m] * z[m][0];
    to[m][1] += a[m] * x[m][1] + b[m] * y[m][1] + c[m] * z[m][1];
  }
}

/* Returns a line of a step; NULL if it has no traction. */
static const Complex *Line(SamSection s, const Step *step, PetscInt line, PetscInt traction)
{
  if (line < step->first || line >= step->first + step->count) return NULL;
  return (const Complex *)step->lines + ((line - step->first) * SAM_STRESS_TRACTIONS + traction) * (ptrdiff_t)s->n;
}

/* Adds the contributions of the lines at the distances d and -d. */
static void AddLines(SamSection s, const Step *step, PetscInt d, Work *w, Complex *sum)
{
  /* The line with a positive distance d lies before the section. */
  if (!Line(s, step, s->index - d, 0) && !Line(s, step, s->index + d, 0)) return;
  for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++)
    for (PetscInt h = 0; h < HALVES; h++)
      Combine(s->n, Line(s, step, s->index - d, t), d ? Line(s, step, s->index + d, t) : NULL, h == EVEN ? 1 : -1,
              w->pair[t][h][PLAIN], w->pair[t][h][TURNED]);
  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) {
    const double  *k[SAM_STRESS_TRACTIONS];
    const Complex *x[SAM_STRESS_TRACTIONS];

    for (PetscInt t = 0; t < SAM_STRESS_TRACTIONS; t++) {
      const SamStressKernel kernel = SamStressKernelOf(s->stress, c, t);
      const PetscBool      *odd    = SamStressOdd[kernel.group][kernel.member];

      k[t] = w->kernels[kernel.group][kernel.member];
      x[t] = (const Complex *)w->pair[t][odd[1] ? ODD : EVEN][odd[0] ? TURNED : PLAIN];
    }
    AddThree(s->n, k[0], k[1], k[2], x[0], x[1], x[2], sum + c * (ptrdiff_t)s->n);
  }
}

/* Returns the largest distance of a line with traction from the section. */
static PetscInt Farthest(SamSection s)
{
  PetscInt most = -1;

  for (PetscInt k = 0; k < s->steps; k++)
    if (s->step[k].count)
      most = PetscMax(most, PetscMax(s->index - s->step[k].first, s->step[k].first + s->step[k].count - 1 - s->index));
  return most;
}

/* Adds the smooth part of a step at a depth. */
static void AddSmooth(SamSection s, PetscInt step, PetscInt depth, double stress[])
{
  const SamGrid   g       = s->grid;
  const PetscBool row     = s->axis == SAM_SECTION_X;
  const double    first[] = {(double)SamGridX(g, row ? 0 : s->index), (double)SamGridY(g, row ? s->index : 0),
                             s->depths[depth]};
  const double    way[]   = {row ? (double)g->dx : 0, row ? 0 : (double)g->dy};
  double         *to[SAM_STRESS_COMPONENTS];

  for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++)
    to[c] = stress + ((step * SAM_STRESS_COMPONENTS + c) * (ptrdiff_t)s->count + depth) * s->length;
  (*s->stress->ops.add)(s->stress, s->step[step].sums, first, way, s->length, to);
}

/* Finishes a depth: transforms back, and sets the tractions on the surface, which are given. */
static void Finish(SamSection s, const Work *w, PetscInt depth, double stress[])
{
  for (PetscInt k = 0; k < s->steps; k++)
    for (PetscInt c = 0; c < SAM_STRESS_COMPONENTS; c++) {
      const PetscInt component = s->axis == SAM_SECTION_X ? c : exchanged_component[c];
      double        *to = stress + ((k * SAM_STRESS_COMPONENTS + component) * (ptrdiff_t)s->count + depth) * s->length;
      const PetscInt traction = c == SAM_STRESS_ZZ ? SAM_STRESS_P : c == SAM_STRESS_XZ ? SAM_STRESS_QX : SAM_STRESS_QY;

      memcpy(s->spectrum, w->sum + (k * SAM_STRESS_COMPONENTS + c) * (ptrdiff_t)s->n, sizeof(Complex) * (size_t)s->n);
      fftw_execute(s->backward);
      memcpy(to, s->line, sizeof(double) * (size_t)s->length);
      if (s->depths[depth] > 0 || (c != SAM_STRESS_ZZ && c != SAM_STRESS_XZ && c != SAM_STRESS_YZ)) continue;
      for (PetscInt i = 0; i < s->length; i++)
        to[i] = s->step[k].surface[traction][i] == 0 ? 0 : -s->step[k].surface[traction][i];
    }
}

PetscErrorCode SamSectionCompute(SamSection s, double stress[])
{
  const PetscInt farthest = Farthest(s);
  Work           w;

  PetscFunctionBegin;
  PetscCall(CreateWork(s, &w));
  for (PetscInt k = 0; k < s->count; k++) {
    memset(w.sum, 0, sizeof(Complex) * (size_t)(s->steps * SAM_STRESS_COMPONENTS) * (size_t)s->n);
    PetscCall(SamStressUseDepth(s->stress, s->depths[k]));
    for (PetscInt d = 0; d <= farthest; d++) {
      TransformKernels(s, s->depths[k], d, &w);
      for (PetscInt step = 0; step < s->steps; step++)
        AddLines(s, &s->step[step], d, &w, w.sum + step * SAM_STRESS_COMPONENTS * (ptrdiff_t)s->n);
    }
    Finish(s, &w, k, stress);
    for (PetscInt step = 0; s->stress->sums && step < s->steps; step++) AddSmooth(s, step, k, stress);
  }
  SamFree(w.all);
  PetscCall(ForgetSteps(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
