/*
  Waves of a period include the images of a window. The stress of these is smooth, since they are at least as far away
  as the window is wide. So the eigenstrain is projected onto a few nodes by the transpose of Lagrange's polynomials, a
  matrix gives the stress of its images at the nodes, and the same polynomials interpolate this stress to the cells, so
  that the operator remains symmetric.

  The matrix is the sum over the images of the stress of a point (nucleus.c), which falls as their distance cubed. Sums
  over squares |m|, |n| <= 1, 2, 4 are extrapolated in the powers 1 and 3 of 1/(N + 1/2). Apart from signs it depends
  only on the distance of two nodes along x and y.

  A row of cells in plane strain has images along x only, which are lines: the point's stress is integrated along y by
  Gauss's rule in the angle at which the points of the line are seen. It falls as the distance squared, so that four
  times as many images are summed.
*/
#include "images.h"
#include <petsam/private/baseimpl.h>
#include <petscdt.h>

enum { ALONG = 6, DOWN = 5, LAGS = 1 + ALONG * (ALONG - 1) / 2, NODES = ALONG * ALONG * DOWN, ANGLES = 24 };

enum { ENTRIES = PARTS * PARTS };
typedef double Matrix[ENTRIES];

struct _n_SamImages {
  SamGrid     grid;
  SamWaveBody body;
  PetscInt    along[2];                      /* number of nodes along x and y, 1 across a row */
  PetscReal   angle[ANGLES], weight[ANGLES]; /* of Gauss's rule between -1 and 1 */
  PetscReal   point[DOWN], part[DOWN];       /* the same of a layer */
  double      node[2][ALONG], depth[DOWN];
  double     *basis[3];                   /* at columns, this rank's rows, and layers */
  PetscInt    lag[ALONG][ALONG];          /* the place of the distance of two nodes along an axis */
  Matrix (*table)[LAGS][DOWN][DOWN];      /* by the lags along x and y, and the depths of point and source */
  double sums[PARTS][DOWN][ALONG][ALONG]; /* component, z, y, x */
};

/* True if a component is odd in x; in y */
static const PetscBool odd[2][PARTS] = {{[SAM_STRESS_XY] = PETSC_TRUE, [SAM_STRESS_XZ] = PETSC_TRUE},
                                        {[SAM_STRESS_XY] = PETSC_TRUE, [SAM_STRESS_YZ] = PETSC_TRUE}};

/* ---- creation ---- */

/* Computes the zeros of Chebyshev's polynomial of order n, between two ends. */
static void SetNodes(PetscInt n, double low, double high, double node[])
{
  for (PetscInt i = 0; i < n; i++) node[i] = (low + high) / 2 - (high - low) / 2 * cos(PETSC_PI * (i + 0.5) / n);
}

static void SetBasis(PetscInt n, const double node[], double at, double basis[])
{
  for (PetscInt i = 0; i < n; i++) {
    basis[i] = 1;
    for (PetscInt j = 0; j < n; j++)
      if (j != i) basis[i] *= (at - node[j]) / (node[i] - node[j]);
  }
}

/* Sets the means over a layer of the polynomials along z, by Gauss's rule of order DOWN. */
static void SetMeanBasis(SamImages m, double top, double thickness, double mean[])
{
  double one[DOWN];

  for (PetscInt i = 0; i < DOWN; i++) mean[i] = 0;
  for (PetscInt k = 0; k < DOWN; k++) {
    SetBasis(DOWN, m->depth, top + thickness / 2 * (1 + m->point[k]), one);
    for (PetscInt i = 0; i < DOWN; i++) mean[i] += m->part[k] / 2 * one[i];
  }
}

/* Nodes and polynomials. */
static PetscErrorCode CreateBasis(SamImages m)
{
  const SamGrid g   = m->grid;
  double        top = 0, all = 0;

  PetscFunctionBegin;
  for (PetscInt l = 0; l < m->body.layers; l++) all += m->body.thickness[l];
  for (PetscInt c = 0; c < 2; c++)
    SetNodes(m->along[c], g->center[c] - g->width[c] / 2, g->center[c] + g->width[c] / 2, m->node[c]);
  SetNodes(DOWN, 0, all, m->depth);
  PetscCall(
    PetscMalloc3(ALONG * g->nx, &m->basis[0], ALONG * g->rows, &m->basis[1], DOWN * m->body.layers, &m->basis[2]));
  for (PetscInt i = 0; i < g->nx; i++) SetBasis(ALONG, m->node[0], SamGridX(g, i), m->basis[0] + ALONG * i);
  for (PetscInt j = 0; j < g->rows; j++)
    SetBasis(m->along[1], m->node[1], SamGridY(g, g->row_start + j), m->basis[1] + ALONG * j);
  for (PetscInt l = 0; l < m->body.layers; l++) {
    SetMeanBasis(m, top, m->body.thickness[l], m->basis[2] + DOWN * l);
    top += m->body.thickness[l];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the stress of an image at a distance along x and y; in a row, of a line. */
static void SetImage(SamImages m, const double between[2], double depth, double source, Matrix image)
{
  const double far = hypot(between[0], depth - source);

  if (m->along[1] > 1) {
    SamNucleus(between, depth, source, m->body.shear, m->body.poisson, image);
    return;
  }
  memset(image, 0, sizeof(Matrix));
  for (PetscInt k = 0; k < ANGLES; k++) {
    const double angle = PETSC_PI / 2 * m->angle[k], to[2] = {between[0], far * tan(angle)};
    const double weight = m->weight[k] * PETSC_PI / 2 * far / (cos(angle) * cos(angle));
    Matrix       one;

    SamNucleus(to, depth, source, m->body.shear, m->body.poisson, one);
    for (PetscInt a = 0; a < ENTRIES; a++) image[a] += weight * one[a];
  }
}

/* Computes the stress of all images for one lag. */
static void SumImages(SamImages m, const double lag[2], const double period[2], double depth, double source, Matrix sum)
{
  const PetscBool row   = m->along[1] == 1 ? PETSC_TRUE : PETSC_FALSE;
  const PetscInt  least = row ? 4 : 1, sizes[] = {least, 2 * least, 4 * least};
  double          power[3][3];
  Matrix          upto[3] = {{0}}, one;

  for (PetscInt s = 0; s < 3; s++)
    for (PetscInt i = -sizes[s]; i <= sizes[s]; i++)
      for (PetscInt j = row ? 0 : -sizes[s]; j <= (row ? 0 : sizes[s]); j++) {
        const double between[2] = {lag[0] + (double)i * period[0], lag[1] + (double)j * period[1]};

        if (PetscMax(labs((long)i), labs((long)j)) <= (s ? sizes[s - 1] : 0)) continue;
        SetImage(m, between, depth, source, one);
        for (PetscInt k = s; k < 3; k++)
          for (PetscInt a = 0; a < ENTRIES; a++) upto[k][a] += one[a];
      }
  /* The weights of the three sums that eliminate the powers 1 and 3. */
  for (PetscInt s = 0; s < 3; s++) {
    power[s][0] = pow(sizes[s] + 0.5, -1);
    power[s][1] = pow(sizes[s] + 0.5, -3);
  }
  for (PetscInt s = 0; s < 3; s++) {
    const double *p = power[(s + 1) % 3], *q = power[(s + 2) % 3];

    power[s][2] = p[0] * q[1] - p[1] * q[0];
  }
  for (PetscInt a = 0; a < ENTRIES; a++) {
    sum[a] = 0;
    for (PetscInt s = 0; s < 3; s++) sum[a] += power[s][2] * upto[s][a];
    sum[a] /= power[0][2] + power[1][2] + power[2][2];
  }
}

/* Sets the indices of the distances between nodes; mirror images of two nodes have the same distance. */
static PetscInt SetLags(SamImages m)
{
  PetscInt lags = 1;

  for (PetscInt i = 0; i < ALONG; i++)
    for (PetscInt j = 0; j < i; j++)
      m->lag[i][j] = m->lag[j][i] = i + j < ALONG - 1   ? lags++
                                    : i + j > ALONG - 1 ? m->lag[ALONG - 1 - j][ALONG - 1 - i]
                                                        : lags++;
  return lags;
}

/* Fills the table; each rank computes some of the lags. */
static PetscErrorCode FillTable(SamImages m, const double period[2])
{
  const PetscInt all = LAGS * LAGS * DOWN * DOWN * ENTRIES, lags = SetLags(m);
  double         size[2][LAGS] = {{0}};
  PetscMPIInt    rank, ranks;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(m->grid->comm, &rank));
  PetscCallMPI(MPI_Comm_size(m->grid->comm, &ranks));
  for (PetscInt c = 0; c < 2; c++)
    for (PetscInt i = 0; i < ALONG; i++)
      for (PetscInt j = 0; j < i; j++) size[c][m->lag[i][j]] = m->node[c][i] - m->node[c][j];
  PetscCall(PetscCalloc1(LAGS, &m->table));
  for (PetscInt k = rank; k < lags * (m->along[1] > 1 ? lags : 1); k += ranks) {
    const PetscInt x = k % lags, y = k / lags;
    const double   lag[2] = {size[0][x], size[1][y]};

    for (PetscInt z = 0; z < DOWN; z++)
      for (PetscInt c = 0; c < DOWN; c++) SumImages(m, lag, period, m->depth[z], m->depth[c], m->table[x][y][z][c]);
  }
  PetscCall(SamSum(m->grid->comm, all, (double *)m->table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamImagesCreate(SamGrid grid, const PetscReal period[2], const SamWaveBody *body, SamImages *images)
{
  const double of[2] = {(double)period[0], (double)period[1]};
  SamImages    m;

  PetscFunctionBegin;
  PetscCall(PetscNew(&m));
  m->grid = grid;
  PetscCall(SamGridReference(grid));
  m->body     = *body;
  m->along[0] = ALONG;
  m->along[1] = SamGridIsRow(grid) ? 1 : ALONG;
  PetscCall(PetscDTGaussQuadrature(ANGLES, -1, 1, m->angle, m->weight));
  PetscCall(PetscDTGaussQuadrature(DOWN, -1, 1, m->point, m->part));
  PetscCall(CreateBasis(m));
  PetscCall(FillTable(m, of));
  *images = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamImagesDestroy(SamImages *images)
{
  SamImages m = *images;

  PetscFunctionBegin;
  *images = NULL;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3(m->basis[0], m->basis[1], m->basis[2]));
  PetscCall(PetscFree(m->table));
  PetscCall(SamGridDestroy(&m->grid));
  PetscCall(PetscFree(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- products ---- */

/* Projects the eigenstrain of a row of cells onto the nodes along x and z. */
static void ReduceRow(SamImages m, PetscInt j, const double e[], PetscInt step, double row[])
{
  const SamGrid g = m->grid;

  memset(row, 0, sizeof(double) * PARTS * DOWN * ALONG);
  for (PetscInt k = 0; k < PARTS * m->body.layers; k++) {
    const PetscInt l          = k / PARTS;
    const double  *from       = e + (ptrdiff_t)(l * step + k % PARTS) * g->cells + j * (ptrdiff_t)g->nx;
    double         sum[ALONG] = {0};

    for (PetscInt i = 0; i < g->nx; i++)
      for (PetscInt n = 0; n < ALONG && from[i] != 0; n++) sum[n] += m->basis[0][ALONG * i + n] * from[i];
    for (PetscInt d = 0; d < DOWN; d++)
      for (PetscInt n = 0; n < ALONG; n++)
        row[((k % PARTS) * DOWN + d) * ALONG + n] +=
          m->basis[2][DOWN * l + d] * m->body.thickness[l] * g->dx * g->dy * sum[n];
  }
}

PetscErrorCode SamImagesReduce(SamImages m, const double e[], PetscInt step)
{
  SamTotal *totals;
  double    row[PARTS * DOWN * ALONG];

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(PARTS * NODES, &totals));
  for (PetscInt j = 0; j < m->grid->rows; j++) {
    ReduceRow(m, j, e, step, row);
    for (PetscInt k = 0; k < PARTS * DOWN; k++)
      for (PetscInt y = 0; y < m->along[1]; y++)
        for (PetscInt x = 0; x < ALONG; x++)
          SamAdd(&totals[(k * ALONG + y) * ALONG + x], m->basis[1][ALONG * j + y] * row[k * ALONG + x]);
  }
  PetscCall(SamSumTotals(m->grid->comm, PARTS * NODES, totals, &m->sums[0][0][0][0]));
  PetscCall(PetscFree(totals));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the stress at a node by the images of the eigenstrain at another node. */
static void AddNode(SamImages m, const PetscInt at[3], const PetscInt from[3], double s[PARTS])
{
  const Matrix *matrix = &m->table[m->lag[at[0]][from[0]]][m->lag[at[1]][from[1]]][at[2]][from[2]];

  for (PetscInt b = 0; b < PARTS; b++)
    for (PetscInt a = 0; a < PARTS; a++) {
      PetscBool turns = PETSC_FALSE;

      for (PetscInt c = 0; c < 2; c++)
        if (at[c] < from[c] && odd[c][a] != odd[c][b]) turns = !turns;
      s[a] += (turns ? -1 : 1) * (*matrix)[a * PARTS + b] * m->sums[b][from[2]][from[1]][from[0]];
    }
}

/* Computes the stress of the images at all nodes. */
static void GetNodes(SamImages m, double s[NODES][PARTS])
{
  memset(s, 0, sizeof(*s) * NODES);
  for (PetscInt i = 0; i < NODES; i++)
    for (PetscInt j = 0; j < NODES; j++) {
      const PetscInt at[3]   = {i % ALONG, i / ALONG % ALONG, i / (ALONG * ALONG)},
                     from[3] = {j % ALONG, j / ALONG % ALONG, j / (ALONG * ALONG)};

      if (PetscMax(at[1], from[1]) < m->along[1]) AddNode(m, at, from, s[i]);
    }
}

PetscErrorCode SamImagesAdd(SamImages m, double s[])
{
  const SamGrid g = m->grid;
  double(*node)[PARTS];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(NODES, &node));
  GetNodes(m, node);
  for (PetscInt k = 0; k < PARTS * m->body.layers; k++) {
    double layer[ALONG][ALONG] = {{0}}; /* y, x */

    for (PetscInt n = 0; n < NODES; n++)
      layer[n / ALONG % ALONG][n % ALONG] += m->basis[2][DOWN * (k / PARTS) + n / (ALONG * ALONG)] * node[n][k % PARTS];
    for (PetscInt j = 0; j < g->rows; j++) {
      double *to = s + (ptrdiff_t)k * g->cells + j * (ptrdiff_t)g->nx, line[ALONG] = {0};

      for (PetscInt y = 0; y < m->along[1]; y++)
        for (PetscInt x = 0; x < ALONG; x++) line[x] += m->basis[1][ALONG * j + y] * layer[y][x];
      for (PetscInt i = 0; i < g->nx; i++)
        for (PetscInt n = 0; n < ALONG; n++) to[i] -= m->basis[0][ALONG * i + n] * line[n];
    }
  }
  PetscCall(PetscFree(node));
  PetscFunctionReturn(PETSC_SUCCESS);
}
