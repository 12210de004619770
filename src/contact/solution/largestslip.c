/*
  The largest slip, which is at the edge of contact and so between cells.

  Where the bodies part, the displacements of their surfaces bend like the power 3/2 of the distance; and the bend by
  the shear is to the gap as the shear is to the pressure, since both vanish alike at the edge. So in

      slip - M (q/p) gap

  the bend cancels, and this is smooth across the edge, where it is the slip. M is the ratio of the tangential to the
  normal compliance for a wave as short as a cell: 1 across the edge of half-spaces, 1/(1 - nu) along it.

  The expression is interpolated along the axis of the grid that is closer to the edge's normal, from the cell in
  contact at the edge, the one behind it and the one outside. The edge lies

      u = PLACE - r/(r + HALF),     r = E* gap/(h p sqrt(c))

  cells beyond the centre of the cell in contact: p is its pressure, the gap that of the cell outside, h their distance,
  and c the normal's part along the axis. Since p and the gap follow from the same two cells, the shape of the contact
  farther away does not matter: edges of pads and of rough surfaces are found as accurately as edges of spheres. For a
  straight edge along the other axis the formula holds within 1.1e-4 of a cell (fitted on Hertz's contact in plane
  strain, of 760 cells at 33 places); on spheres within 0.05.

  In steady rolling the same holds for the differences of the displacements and of the gap over a cell along x, which
  are those of the place between two cells. The strain that the pressure causes in dissimilar bodies also vanishes at
  the edge, and is subtracted. A film's shear does not bend the surfaces, so that with a film only the values of cells
  are used.

  Compared with closed forms on grids of 24 to 130 cells at random places, in slip zones of at least one cell: slip and
  slip velocity of cylinders are within 4 % (1 % from two cells on), slip of spheres within 6 % divided by the width in
  cells. Cells alone are wrong by up to 24, 99 and 20 % in zones of one cell, and by 10, 21 and 11 % in zones of two.
*/
#include <petsam/private/body.h>
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/pressed.h>
#include <petsam/private/problem.h>

#define PLACE 0.825
#define HALF  1.7274
#define LEAST 1e-3 /* part of the slip outside; less slip in contact counts as none, as with unbounded shear */
#define HALO  2

/* Values of a solution, of this rank's cells and with halos */
typedef struct {
  SamGrid   grid;
  SamRigid  rigid;
  PetscBool streams, wraps; /* material streams through; the bodies are periodic, without rotations but about z */
  double    modulus, strain, ratio[2]; /* E*, strain by pressure, and M across the edge and along it */
  SamValues own;
  SamHalo   p, u_z, u_t, separation;
} Seen;

static PetscErrorCode Begin(SamProblem problem, const SamSolution *s, Vec separation, Seen *seen)
{
  const SamElasticity e    = SamProblemGetElasticity(problem);
  const SamGrid       grid = SamProblemGetGrid(problem);
  const double        k    = 1 / (double)grid->side[0];
  double              c[SAM_WAVE_SYMBOLS], difference[SAM_WAVE_SYMBOLS];

  PetscFunctionBegin;
  *seen = (Seen){.grid = grid, .streams = SamMotionOf(e)->streams, .wraps = SamElasticityGetTraits(e).periodic};
  SamPairSymbols(SamElasticityGetPair(e), k, c, difference);
  seen->modulus  = 2 / c[SAM_WAVE_ZZ];
  seen->strain   = c[SAM_WAVE_ZR];
  seen->ratio[0] = c[SAM_WAVE_RR] / c[SAM_WAVE_ZZ];
  seen->ratio[1] = c[SAM_WAVE_TT] / c[SAM_WAVE_ZZ];
  PetscCall(SamRigidSet(&seen->rigid, problem, s));
  PetscCall(SamValuesGet(s, &seen->own));
  PetscCall(SamHaloBegin(grid, s->pressure, 1, HALO, seen->wraps, &seen->p));
  PetscCall(SamHaloBegin(grid, s->displacement_z, 1, HALO, seen->wraps, &seen->u_z));
  PetscCall(SamHaloBegin(grid, s->displacement_t, 2, HALO, seen->wraps, &seen->u_t));
  PetscCall(SamHaloBegin(grid, separation, 1, HALO, seen->wraps, &seen->separation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode End(const SamSolution *s, Seen *seen)
{
  PetscFunctionBegin;
  PetscCall(SamHaloEnd(&seen->separation));
  PetscCall(SamHaloEnd(&seen->u_t));
  PetscCall(SamHaloEnd(&seen->u_z));
  PetscCall(SamHaloEnd(&seen->p));
  PetscCall(SamValuesRestore(s, &seen->own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Has(const Seen *s, PetscInt i, PetscInt j)
{
  return s->wraps || (i >= 0 && i < s->grid->nx && j >= 0 && j < s->grid->ny);
}

static PetscBool Touches(const Seen *s, PetscInt i, PetscInt j)
{
  return SamIsPressed(SamHaloAt(&s->p, 0, i, j));
}

/* Returns the gap of a cell, which is 0 in contact; beyond the grid, the gap of the nearest cell. */
static double GapOf(const Seen *s, PetscInt i, PetscInt j)
{
  const PetscInt    a   = s->wraps ? i : PetscClipInterval(i, 0, s->grid->nx - 1);
  const PetscInt    b   = s->wraps ? j : PetscClipInterval(j, 0, s->grid->ny - 1);
  const SamRigidRow row = SamRigidOfGap(&s->rigid, b - s->grid->row_start);
  double            gap;

  if (Touches(s, a, b)) return 0;
  gap = SamHaloAt(&s->u_z, 0, a, b) + SamHaloAt(&s->separation, 0, a, b) -
        SamRigidRowAt(row, s->rigid.normal.xi0 + (double)a * s->rigid.normal.dxi);
  return PetscMax(gap, 0);
}

/* A face between a cell in contact, (i, j), and the cell outside it, in the direction `step`; M q/p near the face */
typedef struct {
  PetscInt i, j, step[2];
  double   bend[2], strain; /* and by pressure: its strain along x over it */
} Face;

/* Computes the part of a cell's slip that is smooth across the edge. */
static void SmoothOf(const Seen *s, const Face *face, PetscInt i, PetscInt j, double slip[2])
{
  const double gap = GapOf(s, i, j), size = s->streams ? (gap - GapOf(s, i + 1, j)) / (double)s->grid->dx : gap;

  for (PetscInt c = 0; c < 2; c++) {
    const SamRigidRow row = SamRigidOfSlip(&s->rigid, c, j - s->grid->row_start);

    slip[c] = SamHaloAt(&s->u_t, c, i, j) - SamRigidRowAt(row, s->rigid.normal.xi0 + (double)i * s->rigid.normal.dxi) -
              face->bend[c] * size;
  }
  if (s->streams) slip[0] += face->strain * 0.5 * (SamHaloAt(&s->p, 0, i, j) + SamHaloAt(&s->p, 0, i + 1, j));
}

/*
  Finds the place of the edge beyond the centre of the cell in contact, in cells along the face's axis. Returns false if
  the other axis is closer to the edge's normal, which follows from the slope of the gap in the cell outside.
*/
static PetscBool FindPlace(const Seen *s, Face *face, double p, double *u)
{
  const PetscInt x = face->step[0], y = face->step[1], a = face->i + x, b = face->j + y;
  const double   side = (double)(x ? s->grid->dx : s->grid->dy), other = (double)(x ? s->grid->dy : s->grid->dx);
  const double   along  = GapOf(s, a + x, b + y) / side;
  const double   across = (GapOf(s, a + y, b + x) - GapOf(s, a - y, b - x)) / other;
  double         ratio;

  if (!(along >= fabs(across)) || along == 0) return PETSC_FALSE;
  ratio        = GapOf(s, a, b) * s->modulus / (side * p * sqrt(along / hypot(along, across)));
  face->strain = s->strain * (x ? along * along : across * across) / (along * along + across * across);
  *u           = PLACE - ratio / (ratio + HALF);
  return PETSC_TRUE;
}

/*
  Returns a value at the edge, bounded by those of the cells on both sides of it: where the surface falls off beside the
  contact, as at a roller's end, the gap outside is not the bend of the surfaces, and what is outside is not smooth.
*/
static double BoundAt(double u, double behind, double in, double out, double value)
{
  const double other = u < 0 ? behind : in + PetscMax(u, 1) * (out - in);

  return PetscClipInterval(value, PetscMin(in, other), PetscMax(in, other));
}

/* Computes the slip at the edge at a face of a cell in contact; false: another face has to be used. */
static PetscBool SlipAtFace(const Seen *s, Face *face, ptrdiff_t k, double *size)
{
  /* the difference over a cell ahead belongs to the face between both */
  const PetscInt shift = s->streams && face->step[0] ? 1 : 0, i = face->i - (face->step[0] > 0 ? shift : 0);
  double         u, in[2], out[2], behind[2], value[2];

  if (!Has(s, i, face->j) || !FindPlace(s, face, s->own.p[k], &u)) return PETSC_FALSE;
  for (PetscInt c = 0; c < 2; c++)
    face->bend[c] = s->ratio[face->step[c] ? 0 : 1] * s->own.q[k + c * s->own.cells] / s->own.p[k];
  u += 0.5 * (double)shift;
  SmoothOf(s, face, i, face->j, in);
  SmoothOf(s, face, i + face->step[0], face->j + face->step[1], out);
  for (PetscInt c = 0; c < 2; c++) {
    value[c]  = in[c] + u * (out[c] - in[c]);
    behind[c] = in[c];
  }
  if (Touches(s, i - face->step[0], face->j - face->step[1])) {
    SmoothOf(s, face, i - face->step[0], face->j - face->step[1], behind);
    for (PetscInt c = 0; c < 2; c++) value[c] += 0.5 * u * (u - 1) * (out[c] - 2 * in[c] + behind[c]);
  }
  for (PetscInt c = 0; c < 2; c++) value[c] = BoundAt(u, behind[c], in[c], out[c], value[c]);
  *size = hypot(in[0], in[1]);
  if (*size > LEAST * hypot(out[0], out[1])) *size = hypot(value[0], value[1]);
  return PETSC_TRUE;
}

/* Returns the largest slip at the faces of a cell in contact to cells outside; negative if it has no such face. */
static double SlipAtEdge(const Seen *s, PetscInt i, PetscInt j, ptrdiff_t k)
{
  double most = -1;

  for (PetscInt n = 0; n < 4; n++) {
    const PetscInt sign = n % 2 ? 1 : -1;
    Face           face = {.i = i, .j = j, .step = {n < 2 ? sign : 0, n < 2 ? 0 : sign}};
    const PetscInt a = i + face.step[0], b = j + face.step[1];
    double         size;

    if (Touches(s, a, b) || !Has(s, a, b) || !SlipAtFace(s, &face, k, &size)) continue;
    most = PetscMax(most, size);
  }
  return most;
}

/*
  Returns the largest slip of the cells in contact of this rank's row j: at the edge, if it is there, else at their
  centres.
*/
static double SlipOfRow(const Seen *s, PetscInt j)
{
  const SamRigidRow row[]  = {SamRigidOfSlip(&s->rigid, 0, j), SamRigidOfSlip(&s->rigid, 1, j)};
  double            square = 0, most = 0;

  for (PetscInt i = 0; i < s->grid->nx; i++) {
    const ptrdiff_t k = (ptrdiff_t)j * s->grid->nx + i;
    double          x, y, edge;

    if (!SamIsPressed(s->own.p[k])) continue;
    edge = SlipAtEdge(s, i, s->grid->row_start + j, k);
    most = PetscMax(most, edge);
    if (edge >= 0) continue;
    x = s->own.u_t[k] - SamRigidRowAt(row[0], s->rigid.normal.xi0 + (double)i * s->rigid.normal.dxi);
    y = s->own.u_t[k + s->own.cells] - SamRigidRowAt(row[1], s->rigid.normal.xi0 + (double)i * s->rigid.normal.dxi);
    square = PetscMax(square, x * x + y * y);
  }
  return PetscMax(most, sqrt(square));
}

PetscErrorCode SamSolutionFindSlip(SamProblem problem, SamState state, const SamSolution *s, double *most)
{
  const SamGrid grid = SamProblemGetGrid(problem);
  Seen          seen;
  Vec           separation;

  PetscFunctionBegin;
  /* nothing slid at the centres of cells */
  if (*most == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (SamPairFilm(SamElasticityGetPair(SamProblemGetElasticity(problem))) > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamSolutionCreateSeparation(problem, state, SAM_TRIED, &separation));
  PetscCall(Begin(problem, s, separation, &seen));
  *most = 0;
  for (PetscInt j = 0; j < grid->rows; j++) {
    const double slip = SlipOfRow(&seen, j);

    *most = PetscMax(*most, slip);
  }
  PetscCall(End(s, &seen));
  PetscCall(SamSolutionDestroySeparation(problem, &separation));
  PetscCall(SamMax(grid->comm, 1, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}
