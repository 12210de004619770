/*
  Creep forces of elliptic rolling contacts from a table, for vehicle and simulation programs: about 1 us per call.

  This header needs neither a library (but -lm) nor another header of petsam: C99, C++, or Fortran by iso_c_binding.
  Its functions are static inline; where PETSAM_CREEP_EXTERNAL is defined before it, in one source file, they have
  external linkage, as programs in other languages need; those of libpetsam have it. They may be called from several
  threads at once. Only petsam_creep_load() allocates memory. `make creep-table` makes the table from petsam's solutions
  of steady rolling.

  x is the rolling direction, y lies across it, z is the normal, right-handed. Creepages are the rigid slip of one body
  relative to the other, over the rolled distance, at the centre of the ellipse; a positive creepage gives a positive
  force. In petsam.wheel they are those of the rail relative to the wheel, with z into the rail: the force on the
  wheel is then (Fx, Fy), with the moment Mz, and that on the rail its opposite.

  Axes of the table: log(a/b), and the scaled creepages
      X = C11 xi'/3, Y = C22 eta'/3, Z = hypot(C23/1.5, sqrt(b/a) C11/3) phi'
  in spherical coordinates,
      v = R/(1 + R), R = |(X, Y, Z)|, alpha = atan2(Y, X), beta = atan2(Z, hypot(X, Y)),
  with xi' = G c^2 xi/(mu N), phi' = G c^3 phi/(mu N), c^2 = a b, and Kalker's coefficients. Nodes are equally spaced in
  log(a/b) and in a level of v that is finer around v = 0.4, and in two angles,
      (alpha + atan2(Y (kx/ky)^(sin(beta)^2), X))/2, (beta + atan2(Z, hypot(X/sqrt(kx), Y/sqrt(ky))))/2,
  with kx = 1/hypot(1, 0.7 a/b), ky = a/b/hypot(1.37, 0.7 a/b): nearly X/Z and Y/Z where the pole of the rigid slip is
  at the edge of the contact. The table holds Fx/(mu N), Fy/(mu N), Mz/(mu N c) over v: linear theory times (1 - v)^2,
  and a rest, in 16 bits. Between its nodes are cubic splines: their value uses four coefficients along each axis, and
  is twice continuously differentiable. Mirrored creepages, X < 0 or Z < 0, give the same bits but for signs. |F| is
  cut to mu N by a rounded corner, 1e-3 mu N wide, 1.25e-4 mu N deep. Poisson's ratio changes C11, C22 and C23 above
  only, which is right for small creepages without spin, and approximate else: make a table for yours.

  Friction that falls with the slip velocity: `friction` is its value at the rolling speed times petsam_creep_slip().
*/
#ifndef PETSAM_CREEP_H
#define PETSAM_CREEP_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef PETSAM_CREEP_EXTERNAL
  #define PETSAM_CREEP_API
#else
  #define PETSAM_CREEP_API static inline
#endif
#define PETSAM_CREEP_VERSION 2   /* of the file */
#define PETSAM_CREEP_MESSAGE 256 /* bytes of a message */
#define PETSAM_CREEP_OUTSIDE 1   /* a/b is beyond the table; its end is used */
#define PETSAM_CREEP_INVALID 2   /* an argument that no contact has; the forces are 0 */

#ifdef __cplusplus
extern "C" {
#endif

/*
  A contact. `half_x` is the half axis a along the rolling direction, `half_y` is b across it.
*/
typedef struct {
  double shear;            /* shear modulus G of both bodies (Pa) */
  double poisson;          /* their Poisson's ratio */
  double load;             /* N (N); 0 or less: no contact */
  double friction;         /* mu */
  double half_x, half_y;   /* a, b (m) */
  double creep_x, creep_y; /* xi, eta */
  double spin;             /* phi (1/m) */
} petsam_creep_contact;

/*
  A table. Read its members, do not change them.
*/
typedef struct {
  int     n[4];         /* nodes along log(a/b), v, and the two angles */
  int     cells;        /* cells along an axis of the grids that the table was made with */
  double  first, last;  /* log(a/b) */
  double  poisson;      /* Poisson's ratio */
  double  error[4];     /* error at the nodes by the cells, over mu N: median, 90 %, worst; number of cases */
  double *scales;       /* splines of log C11, C22, C23 at Poisson's ratios 0, that of the table, 0.5: n[0] x 3 x 3 */
  double *linear;       /* of the linear theory, forces by X, Y, Z: n[0] x 3 x 3 */
  double *coefficients; /* of the rests: n[0] x n[1] x (n[2] + 2) x (n[3] + 2) x 3 */
} petsam_creep_table;

/* ---- parts of the functions below, not for use by others ---- */

static const double samcreep_pi = 3.14159265358979323846;

static inline uint64_t samcreep_checksum(const unsigned char *data, size_t bytes)
{
  uint64_t found = UINT64_C(0xcbf29ce484222325);
  size_t   k;
  for (k = 0; k + 4 <= bytes; k += 4) {
    uint32_t word;
    memcpy(&word, data + k, 4);
    found = (found ^ word) * UINT64_C(0x100000001b3);
  }
  return found;
}

static inline size_t samcreep_row(const int n[4], int i, int j, int k)
{
  return (((size_t)i * (size_t)n[1] + (size_t)j) * (size_t)(n[2] + 2) + (size_t)k) * (size_t)(n[3] + 2) * 3;
}

/* The inverse of the matrix from n coefficients of a spline to its values at nodes. sign: of the coefficients continued
   beyond the first and last node; 0: the third derivative is continued */
static inline void samcreep_inverse(int n, const double sign[2], double *matrix, double *inverse)
{
  const double ends[4] = {4.0, -6.0, 4.0, -1.0};
  int          i, j, k;
  memset(matrix, 0, (size_t)n * (size_t)n * sizeof(double));
  memset(inverse, 0, (size_t)n * (size_t)n * sizeof(double));
  for (i = 0; i < n; i++) {
    inverse[i * n + i] = 6.0;
    matrix[i * n + i]  = 4.0;
    if (i > 0) matrix[i * n + i - 1] = 1.0;
    if (i < n - 1) matrix[i * n + i + 1] = 1.0;
  }
  if (sign[0] != 0.0) {
    matrix[1] += sign[0];
    matrix[n * n - 2] += sign[1];
  } else {
    for (k = 0; k < 4; k++) {
      matrix[k] += ends[k];
      matrix[n * n - 1 - k] += ends[k];
    }
  }
  for (k = 0; k < n; k++) {
    const double pivot = 1.0 / matrix[k * n + k];
    for (j = 0; j < n; j++) {
      matrix[k * n + j] *= pivot;
      inverse[k * n + j] *= pivot;
    }
    for (i = 0; i < n; i++) {
      const double factor = matrix[i * n + k];
      if (i == k || factor == 0.0) continue;
      for (j = 0; j < n; j++) {
        matrix[i * n + j] -= factor * matrix[k * n + j];
        inverse[i * n + j] -= factor * inverse[k * n + j];
      }
    }
  }
}

/* Multiplies n values, `stride` apart, by a matrix */
static inline void samcreep_multiply(int n, const double *matrix, size_t stride, double *values, double *line)
{
  int i, j;
  for (j = 0; j < n; j++) line[j] = values[(size_t)j * stride];
  for (i = 0; i < n; i++) {
    double sum = 0.0;
    for (j = 0; j < n; j++) sum += matrix[i * n + j] * line[j];
    values[(size_t)i * stride] = sum;
  }
}

/* Turns values at nodes into the coefficients of their splines, along a/b, v and the first angle */
static inline void samcreep_three(const int n[4], double *values, double *work)
{
  const double signs[3][2] = {{0.0, 0.0}, {-1.0, -1.0}, {1.0, 1.0}};
  size_t       stride = 3 * (size_t)n[0] * (size_t)n[1] * (size_t)n[2] * (size_t)n[3], all = stride, at;
  int          axis, s;
  for (axis = 0; axis < 3; axis++) {
    double *matrix = work + n[axis], *inverse = matrix + n[axis] * n[axis];
    stride /= (size_t)n[axis];
    for (s = axis < 2 ? 0 : 1; s < (axis < 2 ? 1 : 3); s++) {
      samcreep_inverse(n[axis], signs[s], matrix, inverse);
      for (at = 0; at < all; at++) { /* the first node of each line, of the forces with these signs */
        if ((at / stride) % (size_t)n[axis] || (axis == 2 && (at % 3 == 0) != (s == 1))) continue;
        samcreep_multiply(n[axis], inverse, stride, values + at, work);
      }
    }
  }
}

/* The same along the second angle: the parts that are even and odd in the first one have different symmetries */
static inline void samcreep_fourth(const int n[4], double *values, double *work)
{
  const double signs[2][2] = {{1.0, -1.0}, {-1.0, 1.0}};
  const size_t row = 3 * (size_t)n[3], block = row * (size_t)n[2];
  double      *matrix = work + n[3], *inverse[2];
  size_t       i, k, c;
  inverse[0] = matrix + n[3] * n[3];
  inverse[1] = inverse[0] + n[3] * n[3];
  for (i = 0; i < 2; i++) samcreep_inverse(n[3], signs[i], matrix, inverse[i]);
  for (i = 0; i < (size_t)n[0] * (size_t)n[1]; i++) {
    for (k = 0; 2 * k < (size_t)n[2]; k++) {
      double *one = values + i * block + k * row, *other = values + i * block + ((size_t)n[2] - 1 - k) * row;
      for (c = 0; c < row; c++) {
        const double even = 0.5 * (one[c] + other[c]), odd = 0.5 * (one[c] - other[c]);
        one[c]   = even;
        other[c] = one == other ? even : odd;
      }
      for (c = 0; c < 3; c++) {
        samcreep_multiply(n[3], inverse[c > 0], 3, one + c, work);
        if (one != other) samcreep_multiply(n[3], inverse[c == 0], 3, other + c, work);
      }
      for (c = 0; c < row && one != other; c++) {
        const double even = one[c], odd = other[c];
        one[c]   = even + odd;
        other[c] = even - odd;
      }
    }
  }
}

/* Continues coefficients by one beyond each end of the two angles, by the symmetries */
static inline void samcreep_continue(petsam_creep_table *table, const double *given)
{
  const int *n = table->n;
  int        i, j, k, m, c;
  for (i = 0; i < n[0]; i++) {
    for (j = 0; j < n[1]; j++) {
      for (k = -1; k <= n[2]; k++) {
        for (m = -1; m <= n[3]; m++) {
          double *out = table->coefficients + samcreep_row(n, i, j, k + 1) + 3 * (m + 1);
          int     to  = m < 0 ? 1 : m == n[3] ? n[3] - 2 : m;
          int     at  = to == m ? k : n[2] - 1 - k;
          int     in  = at < 0 ? 1 : at == n[2] ? n[2] - 2 : at;
          for (c = 0; c < 3; c++) {
            double sign = 1.0;
            if (in != at && c == 0) sign = -sign;
            if ((m < 0 && c > 0) || (m == n[3] && c == 0)) sign = -sign;
            out[c] =
              sign *
              given[(((size_t)(i * n[1] + j) * (size_t)n[2] + (size_t)in) * (size_t)n[3] + (size_t)to) * 3 + (size_t)c];
          }
        }
      }
    }
  }
}

/* Splines through the forces, which are whole numbers of steps; returns 0, or 1 without memory */
static inline int samcreep_fill(petsam_creep_table *table, const unsigned char *steps, const unsigned char *whole)
{
  const int   *n     = table->n;
  const size_t block = 3 * (size_t)n[2] * (size_t)n[3], all = (size_t)n[0] * (size_t)n[1] * block;
  double      *values = (double *)malloc(all * sizeof(double)), *work;
  size_t       most   = 0, at;
  int          i;
  for (i = 0; i < 4; i++) most = (size_t)n[i] > most ? (size_t)n[i] : most;
  work = (double *)malloc(most * (1 + 3 * most) * sizeof(double));
  if (values && work) {
    for (at = 0; at < all; at++) {
      float   step;
      int16_t number;
      memcpy(&step, steps + 4 * (3 * (at / block) + at % 3), 4);
      memcpy(&number, whole + 2 * at, 2);
      values[at] = (double)step * number;
    }
    samcreep_three(n, values, work);
    samcreep_fourth(n, values, work);
    samcreep_continue(table, values);
  }
  i = !values || !work;
  free(values);
  free(work);
  return i;
}

static inline int samcreep_failed(char *message, const char *file, const char *text)
{
  if (message) (void)snprintf(message, PETSAM_CREEP_MESSAGE, "%.150s: %s", file, text);
  return 1;
}

/* Reads a file into memory; NULL if it cannot be read */
static inline unsigned char *samcreep_read(const char *file, size_t *bytes)
{
  FILE          *stream = fopen(file, "rb");
  unsigned char *data   = NULL;
  long           size   = -1;
  if (!stream) return NULL;
  if (!fseek(stream, 0, SEEK_END)) size = ftell(stream);
  if (size >= 0 && !fseek(stream, 0, SEEK_SET)) data = (unsigned char *)malloc((size_t)size + 1);
  if (data && fread(data, 1, (size_t)size, stream) != (size_t)size) {
    free(data);
    data = NULL;
  }
  (void)fclose(stream);
  *bytes = size < 0 ? 0 : (size_t)size;
  return data;
}

/* Bytes of the forces in a file, with the zeros after them */
static inline double samcreep_stored(const uint32_t head[8])
{
  return 4.0 * floor(0.5 * (3.0 * head[2] * head[3] * head[4] * head[5] + 1.0));
}

/* Checks head, size and checksum of a file; returns 0, or 1 with a message */
static inline int samcreep_check(const unsigned char *data, size_t bytes, const char *file, uint32_t head[8],
                                 char *message)
{
  double   wanted;
  uint64_t stored;
  int      k;
  if (bytes < 8 || memcmp(data, "PETSAMCF", 8))
    return samcreep_failed(message, file, "no table of creep forces: make one with make creep-table");
  if (bytes < 40) return samcreep_failed(message, file, "the file is cut off: make it again");
  memcpy(head, data + 8, 32);
  if (head[0] != PETSAM_CREEP_VERSION || head[1] != 0x01020304u)
    return samcreep_failed(message, file, "a table of another version or byte order: make it again");
  wanted = 48.0 + 56.0 + 144.0 * head[2] + 12.0 * head[2] * head[3] + samcreep_stored(head);
  for (k = 2; k < 6; k++) {
    if (head[k] < 4 || head[k] > 10000) wanted = -1.0;
  }
  if ((double)bytes != wanted) return samcreep_failed(message, file, "the file is cut off: make it again");
  memcpy(&stored, data + bytes - 8, 8);
  if (stored != samcreep_checksum(data, bytes - 8))
    return samcreep_failed(message, file, "the checksum differs, the file is damaged: make it again");
  return 0;
}

/* The first of the four coefficients that a spline uses at place t, their weights, and those of the derivative. ghosts:
   the axis has one more coefficient at each end; else its third derivative is continued, by weights moved to others */
static inline int samcreep_basis(double t, int n, int ghosts, double w[4], double d[4])
{
  int    k = (int)t, s;
  double u, *each[2];
  if (k > n - 2) k = n - 2;
  u    = t - k;
  w[0] = (1.0 - u) * (1.0 - u) * (1.0 - u) / 6.0;
  w[1] = (4.0 - 3.0 * u * u * (2.0 - u)) / 6.0;
  w[2] = (1.0 + 3.0 * u * (1.0 + u * (1.0 - u))) / 6.0;
  w[3] = u * u * u / 6.0;
  d[0] = -0.5 * (1.0 - u) * (1.0 - u);
  d[1] = 0.5 * u * (3.0 * u - 4.0);
  d[2] = 0.5 * (1.0 + u * (2.0 - 3.0 * u));
  d[3] = 0.5 * u * u;
  if (ghosts || (k > 0 && k < n - 2)) return ghosts ? k : k - 1;
  each[0] = w;
  each[1] = d;
  for (s = 0; s < 2; s++) {
    double *e = each[s], e0 = e[0], e1 = e[1], e2 = e[2], e3 = e[3];
    if (k == 0) {
      e[0] = e1 + 4.0 * e0;
      e[1] = e2 - 6.0 * e0;
      e[2] = e3 + 4.0 * e0;
      e[3] = -e0;
    } else {
      e[0] = -e3;
      e[1] = e0 + 4.0 * e3;
      e[2] = e1 - 6.0 * e3;
      e[3] = e2 + 4.0 * e3;
    }
  }
  return k == 0 ? 0 : n - 4;
}

static inline double samcreep_within(double value, double most)
{
  return value < 0.0 ? 0.0 : value > most ? most : value;
}

/* Forces over v, and their derivatives by level and angles: found[0] to found[3], at place[0] to place[3] in steps */
static inline void samcreep_splines(const petsam_creep_table *table, const double place[4], double found[4][3])
{
  const int   *n = table->n;
  double       w[4][4], d[4][4], line[4][4][3];
  int          first[4], i, j, k, c;
  const double steps[3] = {n[1] - 1.0, (n[2] - 1.0) / samcreep_pi, (n[3] - 1.0) / (0.5 * samcreep_pi)};
  for (i = 0; i < 4; i++) first[i] = samcreep_basis(place[i], n[i], i > 1, w[i], d[i]);
  memset(line, 0, sizeof(line));
  for (j = 0; j < 4; j++) {
    for (k = 0; k < 4; k++) {
      double sum[12] = {0.0};
      for (i = 0; i < 4; i++) {
        const double *row =
          table->coefficients + samcreep_row(n, first[0] + i, first[1] + j, first[2] + k) + 3 * first[3];
        for (c = 0; c < 12; c++) sum[c] += w[0][i] * row[c];
      }
      for (c = 0; c < 3; c++) {
        double value = w[3][0] * sum[c] + w[3][1] * sum[c + 3] + w[3][2] * sum[c + 6] + w[3][3] * sum[c + 9];
        double slope = d[3][0] * sum[c] + d[3][1] * sum[c + 3] + d[3][2] * sum[c + 6] + d[3][3] * sum[c + 9];
        line[j][0][c] += w[2][k] * value;
        line[j][1][c] += d[2][k] * value;
        line[j][2][c] += w[2][k] * slope;
      }
    }
  }
  for (c = 0; c < 3; c++) {
    found[0][c] = found[1][c] = found[2][c] = found[3][c] = 0.0;
    for (j = 0; j < 4; j++) {
      found[0][c] += w[1][j] * line[j][0][c];
      found[1][c] += steps[0] * d[1][j] * line[j][0][c];
      found[2][c] += steps[1] * w[1][j] * line[j][1][c];
      found[3][c] += steps[2] * w[1][j] * line[j][2][c];
    }
  }
}

/* The level of v, from 0 to 1, and its derivative: finer where contacts begin to slide fully */
static inline double samcreep_level(double v, double *slope)
{
  const double t = 10.0 * v - 4.0, first = 1.3258176636680326, part = 0.25 / (first + 1.4056476493802699);
  *slope = 0.75 + 10.0 * part / (1.0 + t * t);
  return 0.75 * v + part * (atan(t) + first);
}

/* The two angles in which nodes are equally spaced, and slopes[i][j], derivative of angle i by X, Y, Z */
static inline void samcreep_angles(double ratio, const double vector[3], double angle[2], double slopes[2][3])
{
  const double x = vector[0], y = vector[1], z = vector[2], ax = 1.0 + 0.49 * ratio * ratio;
  const double ay = (1.8769 + 0.49 * ratio * ratio) / (ratio * ratio), by[2] = {sqrt(ax), sqrt(ay)};
  const double h2 = x * x + y * y, r2 = h2 + z * z, g2 = x * x * by[0] + y * y * by[1], h = sqrt(h2), g = sqrt(g2);
  const double change = 0.5 * log(ay / ax), m = exp(change * z * z / r2), second = 0.5 * m / (x * x + m * m * y * y);
  const double first = 0.5 / h2 + second, third = 2.0 * second * x * y * change * z / (r2 * r2);
  const double low = 0.5 / (h * r2), high = 0.5 / (g * (z * z + g2));
  angle[0]     = 0.5 * (atan2(y, x) + atan2(m * y, x));
  angle[1]     = 0.5 * (atan2(z, h) + atan2(z, g));
  slopes[0][0] = -y * first - third * z * x;
  slopes[0][1] = x * first - third * z * y;
  slopes[0][2] = third * h2;
  slopes[1][0] = -z * x * (low + high * by[0]);
  slopes[1][1] = -z * y * (low + high * by[1]);
  slopes[1][2] = low * h2 + high * g2;
}

/* The derivative of the forces of the linear theory by X, Y, Z */
static inline void samcreep_linear(const petsam_creep_table *table, double place, double slopes[3][3])
{
  double w[4], d[4];
  int    first = samcreep_basis(place, table->n[0], 0, w, d), i, j, k;
  for (j = 0; j < 3; j++) {
    for (k = 0; k < 3; k++) {
      slopes[j][k] = 0.0;
      for (i = 0; i < 4; i++) slopes[j][k] += w[i] * table->linear[9 * (first + i) + 3 * j + k];
    }
  }
}

/* Forces and slopes[i][j], derivative of force i by X, Y, Z, for X and Z of 0 or more */
static inline void samcreep_curved(const petsam_creep_table *table, double ratio, const double vector[3],
                                   double force[3], double slopes[3][3])
{
  const double x = vector[0], y = vector[1], z = vector[2], step = (table->last - table->first) / (table->n[0] - 1.0);
  double       at[3] = {x, y, z}, radius = sqrt(x * x + y * y + z * z), v, finer, place[4], found[4][3];
  double       angle[2], turns[2][3], linear[3][3], left;
  int          i, j;
  if (x * x + y * y < 1e-6 * radius * radius) { /* near spin alone: linear in X and Y */
    const double alpha = atan2(y, x);
    at[0]              = 1e-3 * radius * cos(alpha);
    at[1]              = 1e-3 * radius * sin(alpha);
    radius             = sqrt(at[0] * at[0] + at[1] * at[1] + z * z);
  }
  v        = radius / (1.0 + radius);
  place[0] = ratio;
  place[1] = samcreep_within(samcreep_level(v, &finer) * (table->n[1] - 1.0), table->n[1] - 1.0);
  samcreep_angles(exp(table->first + ratio * step), at, angle, turns);
  place[2] = samcreep_within((angle[0] + 0.5 * samcreep_pi) * ((table->n[2] - 1.0) / samcreep_pi), table->n[2] - 1.0);
  place[3] = samcreep_within(angle[1] * ((table->n[3] - 1.0) / (0.5 * samcreep_pi)), table->n[3] - 1.0);
  samcreep_splines(table, place, found);
  samcreep_linear(table, ratio, linear);
  left = 1.0 / (1.0 + radius);
  for (i = 0; i < 3; i++) {
    double ahead = linear[i][0] * at[0] + linear[i][1] * at[1] + linear[i][2] * at[2];
    double along = ((found[0][i] + v * finer * found[1][i]) - 3.0 * left * left * ahead) * left * left / radius;
    for (j = 0; j < 3; j++)
      slopes[i][j] =
        along * at[j] + v * (found[2][i] * turns[0][j] + found[3][i] * turns[1][j]) + left * left * left * linear[i][j];
    force[i] = v * found[0][i] + left * left * left * ahead + slopes[i][0] * (x - at[0]) + slopes[i][1] * (y - at[1]);
  }
}

/* Cuts |F| to mu N, with a rounded corner */
static inline void samcreep_cut(double force[3], double slopes[3][3])
{
  const double half = 5e-4, size = hypot(force[0], force[1]), over = size - (1.0 - half);
  double       factor, change;
  int          j;
  if (!(over > 0.0)) return;
  factor = (over < 2.0 * half ? size - over * over / (4.0 * half) : 1.0) / size;
  change = ((over < 2.0 * half ? 1.0 - over / (2.0 * half) : 0.0) - factor) / (size * size);
  for (j = 0; j < 3; j++) {
    double inner = change * (force[0] * slopes[0][j] + force[1] * slopes[1][j]);
    slopes[0][j] = factor * slopes[0][j] + force[0] * inner;
    slopes[1][j] = factor * slopes[1][j] + force[1] * inner;
  }
  force[0] *= factor;
  force[1] *= factor;
}

/* The place of a/b among the nodes, which may be beyond them */
static inline double samcreep_wanted(const petsam_creep_table *table, double ratio)
{
  return (log(ratio) - table->first) * ((table->n[0] - 1.0) / (table->last - table->first));
}

/* X/xi', Y/eta', Z/phi' at a place of a/b */
static inline void samcreep_factors(const petsam_creep_table *table, double place, double poisson, double factors[3])
{
  const double p = table->poisson, step = (table->last - table->first) / (table->n[0] - 1.0);
  const double by[3] = {(poisson - p) * (poisson - 0.5) / (0.5 * p), poisson * (poisson - 0.5) / (p * (p - 0.5)),
                        poisson * (poisson - p) / (0.5 * (0.5 - p))};
  double       w[4], d[4], logs[3] = {0.0, 0.0, 0.0}, c11;
  int          first = samcreep_basis(place, table->n[0], 0, w, d), i, j, c;
  for (i = 0; i < 4; i++) {
    for (j = 0; j < 3; j++) {
      for (c = 0; c < 3; c++) logs[c] += w[i] * by[j] * table->scales[9 * (first + i) + 3 * j + c];
    }
  }
  c11        = exp(logs[0]);
  factors[0] = c11 / 3.0;
  factors[1] = exp(logs[1]) / 3.0;
  factors[2] = hypot(exp(logs[2]) / 1.5, c11 / 3.0 * exp(-0.5 * (table->first + place * step)));
}

/* ---- the functions ---- */

/*
  petsam_creep_free - frees a table.

  Not collective.

  In:     table - the table, or NULL

  Errors: none.
*/
PETSAM_CREEP_API void petsam_creep_free(petsam_creep_table *table)
{
  if (!table) return;
  free(table->scales);
  free(table->linear);
  free(table->coefficients);
  free(table);
}

/*
  petsam_creep_load - reads a table.

  Not collective.

  In:     file    - name of the file that `make creep-table` has made
  Out:    message - text of an error, PETSAM_CREEP_MESSAGE bytes; NULL: none

  Errors: returns NULL if the file cannot be read, is damaged, or of another version.
*/
PETSAM_CREEP_API petsam_creep_table *petsam_creep_load(const char *file, char *message)
{
  size_t              bytes = 0, count;
  unsigned char      *data  = samcreep_read(file, &bytes);
  petsam_creep_table *table;
  uint32_t            head[8];
  double              numbers[7];
  int                 k;
  if (message) message[0] = '\0';
  if (!data) {
    (void)samcreep_failed(message, file, "cannot be read: check the name, or make it with make creep-table");
    return NULL;
  }
  if (samcreep_check(data, bytes, file, head, message)) {
    free(data);
    return NULL;
  }
  table = (petsam_creep_table *)calloc(1, sizeof(*table));
  if (table) {
    for (k = 0; k < 4; k++) table->n[k] = (int)head[2 + k];
    count               = samcreep_row(table->n, table->n[0], 0, 0);
    table->scales       = (double *)malloc(72 * (size_t)head[2]);
    table->linear       = (double *)malloc(72 * (size_t)head[2]);
    table->coefficients = (double *)malloc(count * sizeof(double));
  }
  if (!table || !table->scales || !table->linear || !table->coefficients ||
      samcreep_fill(table, data + 96 + 144 * (size_t)head[2],
                    data + 96 + 144 * (size_t)head[2] + 12 * (size_t)head[2] * (size_t)head[3])) {
    (void)samcreep_failed(message, file, "not enough memory");
    petsam_creep_free(table);
    free(data);
    return NULL;
  }
  memcpy(numbers, data + 40, 56);
  table->cells   = (int)head[6];
  table->first   = numbers[0];
  table->last    = numbers[1];
  table->poisson = numbers[2];
  memcpy(table->error, numbers + 3, 32);
  memcpy(table->scales, data + 96, 72 * (size_t)head[2]);
  memcpy(table->linear, data + 96 + 72 * (size_t)head[2], 72 * (size_t)head[2]);
  free(data);
  return table;
}

/*
  petsam_creep_slip - returns the rigid slip over the rolled distance, the root of its mean square weighted by the
  pressure (1).

  Not collective.

  In:     contact - half axes, creepages and spin count

  Errors: none.
*/
PETSAM_CREEP_API double petsam_creep_slip(const petsam_creep_contact *contact)
{
  const double arm = contact->half_x * contact->half_x + contact->half_y * contact->half_y;
  return sqrt(contact->creep_x * contact->creep_x + contact->creep_y * contact->creep_y +
              contact->spin * contact->spin * arm / 5.0);
}

/*
  petsam_creep_factors - the factors of the scaled creepages.

  Not collective.

  In:     table   - the table
          ratio   - a/b, above 0; beyond the table its end is used (1)
          poisson - Poisson's ratio (1)
  Out:    factors - X/xi', Y/eta', Z/phi' (1)

  Errors: none.
*/
PETSAM_CREEP_API void petsam_creep_factors(const petsam_creep_table *table, double ratio, double poisson,
                                           double *factors)
{
  samcreep_factors(table, samcreep_within(samcreep_wanted(table, ratio), table->n[0] - 1.0), poisson, factors);
}

/*
  petsam_creep_forces - creep forces of a contact.

  Not collective.

  In:     table      - the table
          contact    - the contact
  Out:    force      - Fx, Fy and Mz (N, the moment N m)
          derivative - row-major, 3 x 4: of Fx, Fy, Mz by xi, eta, phi and N, at fixed half axes and friction
                       (SI units); NULL: none

  Errors: returns PETSAM_CREEP_OUTSIDE if a/b is beyond the table, whose end is then used; PETSAM_CREEP_INVALID and
  forces of 0 if a number is not finite, an axis or modulus is not above 0, Poisson's ratio is not within 0 to 0.5, or
  friction is below 0; else 0.

  Without load or friction forces and derivative are 0. Half axes that grow with the load add their part to the
  derivative by N. That by friction is N/mu times the derivative by N.
*/
PETSAM_CREEP_API int petsam_creep_forces(const petsam_creep_table *table, const petsam_creep_contact *contact,
                                         double *force, double *derivative)
{
  const double a = contact->half_x, b = contact->half_y, traction = contact->friction * contact->load;
  const double sx = contact->creep_x < 0.0 ? -1.0 : 1.0, sz = contact->spin < 0.0 ? -1.0 : 1.0;
  const double creepage[3] = {contact->creep_x, contact->creep_y, contact->spin}, signs[3] = {sx, sz, sz};
  double       c, place, wanted, unit[3], size[3], vector[3], slopes[3][3];
  int          i, j;
  force[0] = force[1] = force[2] = 0.0;
  if (derivative) memset(derivative, 0, 12 * sizeof(*derivative));
  c = a + b + contact->shear + contact->load + contact->friction + creepage[0] + creepage[1] + creepage[2];
  if (!(c - c == 0.0) || !(a > 0.0 && b > 0.0 && contact->shear > 0.0 && contact->friction >= 0.0) ||
      !(contact->poisson >= 0.0 && contact->poisson <= 0.5))
    return PETSAM_CREEP_INVALID;
  if (!(contact->load > 0.0 && traction > 0.0)) return 0;
  wanted = samcreep_wanted(table, a / b);
  place  = samcreep_within(wanted, table->n[0] - 1.0);
  c      = sqrt(a * b);
  samcreep_factors(table, place, contact->poisson, unit);
  for (i = 0; i < 3; i++) {
    unit[i] *= contact->shear * c * c / traction * (i == 2 ? c : 1.0);
    size[i]   = traction * (i == 2 ? c : 1.0);
    vector[i] = signs[i] * unit[i] * creepage[i];
  }
  if (vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2] > 1e-18) {
    samcreep_curved(table, place, vector, force, slopes);
  } else {
    samcreep_linear(table, place, slopes);
    for (i = 0; i < 3; i++) force[i] = slopes[i][0] * vector[0] + slopes[i][1] * vector[1] + slopes[i][2] * vector[2];
  }
  samcreep_cut(force, slopes);
  for (i = 0; i < 3; i++) {
    force[i] *= signs[i] * size[i];
    if (!derivative) continue;
    derivative[4 * i + 3] = force[i] / contact->load;
    for (j = 0; j < 3; j++) {
      derivative[4 * i + j] = size[i] * signs[i] * slopes[i][j] * signs[j] * unit[j];
      derivative[4 * i + 3] -= derivative[4 * i + j] * creepage[j] / contact->load;
    }
  }
  return wanted < -1e-9 || wanted > table->n[0] - 1.0 + 1e-9 ? PETSAM_CREEP_OUTSIDE : 0;
}

#ifdef __cplusplus
}
#endif

#endif
