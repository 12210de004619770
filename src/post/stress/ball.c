/*
  The smallest ball that contains given points.

  Algorithm (Welzl 1991; Gaertner 1999): the farthest point outside of the present ball must lie on the boundary of a
  larger one. The smallest ball with that point on its boundary, about the points that determined the ball before, is
  found by recursion: each point outside is in turn put on the boundary, and moved to the front of the list. The ball
  through the boundary's points is updated by one point at a time. It grows in each round, so there are few rounds.

  References: Welzl 1991, Smallest enclosing disks (balls and ellipsoids), LNCS 555; Gaertner 1999, ESA, LNCS 1643.
*/
#include <petsam/private/fatigue.h>
#include <petsam/private/baseimpl.h>

enum { DIM = SAM_BALL_DIMENSION, MOST_ROUNDS = 1000 };

/* A point lies in the plane of the boundary if it adds less than this part to the square of the ball's size. */
#define FLAT 1e-24
/* A point counts as inside if the square of its distance exceeds that of the radius by less than this part. */
#define INSIDE 1e-14

typedef struct {
  const double *points;
  PetscInt      dimension;
  PetscInt     *order;   /* indices of the points; points on the boundary of the last balls come first */
  PetscInt      support; /* number of points on the boundary */
  double        scale;   /* square of the size of the points' cloud */
  /* the boundary's points so far: directions, twice their squares, and the balls through the first of them */
  PetscInt count;
  double   first[DIM], v[DIM + 1][DIM], z[DIM + 1];
  double   center[DIM + 1][DIM], square[DIM + 1];
  /* the ball */
  double best[DIM], best_square; /* negative: none */
} Ball;

static const double *Point(const Ball *b, PetscInt place)
{
  return b->points + (ptrdiff_t)b->order[place] * b->dimension;
}

static double Excess(const Ball *b, const double p[], const double center[], double square)
{
  double sum = -square;

  for (PetscInt d = 0; d < b->dimension; d++) sum += (p[d] - center[d]) * (p[d] - center[d]);
  return sum;
}

static PetscBool IsOutside(const Ball *b, const double p[])
{
  return b->best_square < 0 || Excess(b, p, b->best, b->best_square) > INSIDE * b->scale;
}

/* Makes the ball through the boundary's points and p the present one, unless p lies in their plane. */
static PetscBool Push(Ball *b, const double p[])
{
  const PetscInt m = b->count, n = b->dimension;
  double         excess = 0;

  b->z[m] = 0;
  for (PetscInt d = 0; d < n; d++) b->v[m][d] = m ? p[d] - b->first[d] : 0;
  for (PetscInt i = 1; i < m; i++) {
    double factor = 0;

    for (PetscInt d = 0; d < n; d++) factor += b->v[i][d] * b->v[m][d] * 2 / b->z[i];
    for (PetscInt d = 0; d < n; d++) b->v[m][d] -= factor * b->v[i][d];
  }
  for (PetscInt d = 0; d < n; d++) b->z[m] += 2 * b->v[m][d] * b->v[m][d];
  if (m && !(b->z[m] > FLAT * b->scale)) return PETSC_FALSE;
  if (m) excess = Excess(b, p, b->center[m - 1], b->square[m - 1]) / b->z[m];
  for (PetscInt d = 0; d < n; d++) {
    if (!m) b->first[d] = p[d];
    b->center[m][d] = m ? b->center[m - 1][d] + excess * b->v[m][d] : p[d];
    b->best[d]      = b->center[m][d];
  }
  b->square[m]   = m ? b->square[m - 1] + excess * excess * b->z[m] / 2 : 0;
  b->best_square = b->square[m];
  b->count       = m + 1;
  return PETSC_TRUE;
}

static void MoveToFront(Ball *b, PetscInt place)
{
  const PetscInt number = b->order[place];

  for (PetscInt k = place; k > 0; k--) b->order[k] = b->order[k - 1];
  b->order[0] = number;
}

/* Finds the smallest ball that contains the first n points of the list and has the boundary's points on its surface. */
static void Enclose(Ball *b, PetscInt n)
{
  b->support = 0;
  if (b->count == b->dimension + 1) return;
  for (PetscInt k = 0; k < n; k++)
    if (IsOutside(b, Point(b, k)) && Push(b, Point(b, k))) {
      Enclose(b, k);
      b->count--;
      MoveToFront(b, k);
      b->support++;
    }
}

/* Returns the place of the point farthest outside, or -1. */
static PetscInt Farthest(const Ball *b, PetscInt n)
{
  PetscInt place = -1;
  double   most  = 0;

  for (PetscInt k = 0; k < n; k++) {
    const double excess = Excess(b, Point(b, k), b->best, b->best_square);

    if (!IsOutside(b, Point(b, k)) || excess <= most) continue;
    most  = excess;
    place = k;
  }
  return place;
}

/* Number of points up to which a call needs no allocation */
#define FEW 512

double SamSmallestBall(PetscInt dimension, PetscInt n, const double points[], double center[])
{
  PetscInt few[FEW] = {0}, *order = n <= FEW ? few : NULL;
  Ball     b = {.points = points, .dimension = dimension, .best_square = -1};

  if (!order && PetscMalloc1(n, &order)) return NAN;
  for (PetscInt k = 0; k < n; k++) order[k] = k;
  b.order = order;
  for (PetscInt k = 1; k < n; k++) b.scale = fmax(b.scale, Excess(&b, Point(&b, k), Point(&b, 0), 0));
  (void)Push(&b, Point(&b, 0));
  b.count   = 0;
  b.support = 1;
  for (PetscInt round = 0, place; round < MOST_ROUNDS && (place = Farthest(&b, n)) >= 0; round++) {
    const PetscInt support = b.support;

    if (!Push(&b, Point(&b, place))) break;
    Enclose(&b, support);
    b.count = 0;
    MoveToFront(&b, place);
    b.support++;
  }
  for (PetscInt d = 0; d < dimension; d++) center[d] = b.best[d];
  if (order != few) (void)PetscFree(order);
  return sqrt(fmax(0, b.best_square));
}
