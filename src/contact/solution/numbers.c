/* The numbers of a step that follow from its solution: cells and areas, energies. */
#include <petsam/private/rows.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>
#include <petsam/private/balance.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/problem.h>

/*
  Cells in contact and in stick, largest tractions and slip there, the elastic energy of both bodies, half the work of
  the tractions on the displacements, and the frictional work of this step. A cell works under a mean of the bounds
  before and after the step that depends on how it slid (SamIncrementGetCellMotion()), which makes the sum over steps
  second order with the slip of step/direction.c.
*/
enum {
  CONTACT,
  STICK,
  DISSIPATED,
  RELEASED,
  ENTERED,
  STORED,
  LOCKED,
  PRESSED,
  BORE,
  BEARS,
  ERROR,
  TURNED,
  BEFORE_TOUCH,
  SUMS
};
enum { PRESSURE, SHEAR, SLIP, MOSTS }; /* the last two are stored as squares */

/* Returns the additional work of slip in this rank's cell k if the cell had touched before the step (TOUCHES,
   below). */
static double WorkBeforeTouch(const SamIncrement *increment, ptrdiff_t k, double dx, double dy)
{
  double              share[2];
  const SamCellMotion motion = SamIncrementGetCellMotion(increment, k, share);
  const double       *aside = increment->aside, *b = increment->at_now.b;

  if (!aside || (motion != SAM_CELL_MOTION_ENTERS && motion != SAM_CELL_MOTION_FIRST)) return 0;
  return b[k] * (0.5 * hypot(dx + aside[k], dy + aside[k + increment->grid->cells]) - share[1] * hypot(dx, dy));
}

static void SumRow(const SamIncrement *increment, PetscInt j, const PetscInt span[2], double sums[SUMS],
                   double most[MOSTS])
{
  const SamValues *v = &increment->at_now, *v0 = &increment->at_before;
  const PetscInt   cells = increment->grid->cells;
  const ptrdiff_t  first = (ptrdiff_t)j * increment->grid->nx;
  const double    *p = v->p, *b = v->b, *q = v->q, *sx = increment->slip[0], *sy = increment->slip[1],
               *dx = increment->row[0], *dy = increment->row[1];

  for (PetscInt i = span[0]; i < span[1]; i++) {
    const ptrdiff_t    k = first + i, l = k + cells;
    const SamCellState state = SamCellStateOf(p[k], q[k], q[l], b[k]);
    double             share[2];
    SamCellMotion      motion;
    const double       work = SamIncrementGetWork(increment, k, share, &motion);

    sums[DISSIPATED] += work;
    if (motion == SAM_CELL_MOTION_RELEASED) sums[RELEASED] += work;
    if (motion == SAM_CELL_MOTION_ENTERS) sums[ENTERED] += work;
    if (increment->solutions[0]) {
      sums[BEARS] += b[k];
      sums[BORE] += v0->b[k];
      sums[LOCKED] += 0.5 * (q[k] * v->u_t[k] + q[l] * v->u_t[l] - v0->q[k] * v0->u_t[k] - v0->q[l] * v0->u_t[l]);
      sums[PRESSED] += 0.5 * (p[k] * v->u_z[k] - v0->p[k] * v0->u_z[k]);
    }
    if (SamRuleTouches(increment->solutions[1]->rule))
      sums[BEFORE_TOUCH] += WorkBeforeTouch(increment, k, dx[i], dy[i]);
    if (state == SAM_CELL_OPEN) continue;
    most[PRESSURE] = PetscMax(most[PRESSURE], p[k]);
    most[SHEAR]    = PetscMax(most[SHEAR], q[k] * q[k] + q[l] * q[l]);
    most[SLIP]     = PetscMax(most[SLIP], sx[i] * sx[i] + sy[i] * sy[i]);
    sums[CONTACT] += 1;
    sums[STICK] += state == SAM_CELL_STICK ? 1 : 0;
    sums[STORED] += 0.5 * (p[k] * v->u_z[k] + q[k] * v->u_t[k] + q[l] * v->u_t[l]);
  }
}

/*
  The error of the dissipated energy that the length of the step causes, estimated cell by cell as the difference from
  other rules of the same order; a is the angle by which the shear turns in the step, ds the slip, b the bound.

    slip in the direction at the end of the step   ENDS b abs(2 sin a/4) ds   first order: ds is turned by about a/2
    of cells that slid all the time                TURNS b a^2/24 ds          ds is the chord of an arc
    of the same where the bound stays              STAYS b a^2/24 ds/f        likewise
    of cells that begin to slide                   BEGINS (1/2 - share) abs(b - b_before) ds   anywhere in the step
    of cells that slide back                       RETURNS (1/2 - share) abs(b - b_before) ds   likewise
    where contact is made or left                  CROSSES b/10 ds            0.5 of the bounds instead of 0.4
    where most of the work is where it is made     MAKES w^2/dissipated        w is that: such cells may not have slid
    of dissimilar bodies, where contact is made    TOUCHES w^2/(w + dissipated)   w is what was slip before they touch
    of the first step of others                    all of it: loads in proportion need not slide at all
    of a first step in which bodies yield          all of it: the displacements do not grow in proportion

  f is the part of the contact that sticks. The smaller it is, the farther each error of the slip moves the bodies. If
  the bound changes, other errors cancel this effect; between both cases the estimate is a mean of the two terms.

  The energy depends on the whole history of the slip, which no single step contains. So these terms have the order of
  the error and are proportional to it, and their factors were fitted to the errors of random histories
  (examples/manual/LOADS.md gives the accuracy). They estimate the size of the error, not its sign.
*/
#define ENDS    0.4
#define TURNS   2.0
#define STAYS   2.7
#define LEAST   0.1  /* of f */
#define CHANGES 0.05 /* relative change of the bound in a step above which the bound counts as changing */
#define BEGINS  0.6
#define RETURNS 0.3
#define CROSSES 0.3
#define MAKES   0.6
#define TOUCHES 0.08

/* The error by the time at which a cell begins to slide within the step; more is known of cells that slide back. */
static double ErrorOfBegin(const SamIncrement *increment, SamCellMotion motion, const double share[2])
{
  if (motion == SAM_CELL_MOTION_BEGINS) return BEGINS * (increment->follows_slip ? 0.25 : 0.5 - share[0]);
  return motion == SAM_CELL_MOTION_ENTERS || motion == SAM_CELL_MOTION_RELEASED ? 0 : RETURNS * (0.5 - share[0]);
}

static void AddErrors(const SamIncrement *increment, PetscInt j, const PetscInt span[2], double *const turned[2],
                      double sums[SUMS])
{
  const double *b0 = increment->at_before.b, *b1 = increment->at_now.b, *sx = increment->row[0],
               *sy = increment->row[1];

  if (!increment->solutions[0] && !SamRuleTouches(increment->solutions[1]->rule)) sums[ERROR] = fabs(sums[DISSIPATED]);
  if (!increment->solutions[0]) return;
  SamIncrementTurnRow(increment, j, turned);
  for (PetscInt i = span[0]; i < span[1]; i++) {
    const ptrdiff_t k = (ptrdiff_t)j * increment->grid->nx + i;
    double          share[2];
    SamCellMotion   motion;
    const double    work = SamIncrementGetWork(increment, k, share, &motion);
    double          length;

    if (work == 0) continue;
    length = hypot(sx[i], sy[i]);
    if (motion == SAM_CELL_MOTION_ALWAYS) {
      const double half  = hypot(sx[i] - turned[0][i], sy[i] - turned[1][i]) / length;
      const double stays = PetscMax(0, 1 - fabs(b1[k] - b0[k]) / (CHANGES * b1[k]));

      if (increment->solutions[1]->rule == SAM_RULE_END) {
        sums[ERROR] += ENDS * half * work;
      } else {
        sums[ERROR] += (1 - stays) * TURNS / 6 * half * half * work;
        sums[TURNED] += stays * STAYS / 6 * half * half * work;
      }
    }
    sums[ERROR] += ErrorOfBegin(increment, motion, share) * fabs(b1[k] - b0[k]) * length;
    if (motion == SAM_CELL_MOTION_ENTERS || motion == SAM_CELL_MOTION_LEAVES || motion == SAM_CELL_MOTION_RELEASED)
      sums[ERROR] += CROSSES / 5 * work;
  }
}

static double ErrorOfTouching(SamSlipRule rule, const double sums[SUMS])
{
  const double w = PetscMax(SamRuleTouches(rule) ? sums[BEFORE_TOUCH] : sums[ENTERED], 0);

  if (w == 0) return 0;
  return SamRuleTouches(rule) ? TOUCHES * w * w / (w + sums[DISSIPATED]) : MAKES * w * w / sums[DISSIPATED];
}

/* The numbers, side by side in the state in this order. */
enum {
  CONTACT_AREA,
  STICK_AREA,
  FRACTION,
  CONTACT_CELLS,
  STICK_CELLS,
  PRESSURE_MAX,
  SHEAR_MAX,
  SLIP_MAX,
  EDGE_ACCEPTED,
  SLIP_WIDTH,
  CONTACT_HALF, /* along x, and along y */
  STICK_HALF        = CONTACT_HALF + 2,
  DISSIPATED_ENERGY = STICK_HALF + 2,
  STORED_ENERGY,
  ENERGY_ERROR,
  CLOSED,
  ENTERING,
  TOUCHING,
  UNBALANCED,
  NUMBERS
};
#define REAL(name, unit, text, ...) \
  { \
    name, unit, text, SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, __VA_ARGS__ \
  }
#define INT(name, text) \
  { \
    name, "1", text, SAM_NUMBER_INT, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 0 \
  }
static const SamStateNumber declared[NUMBERS] = {
  REAL("contact_area", "m2", "area in contact", SAM_JOIN_LAST, 1),
  REAL("stick_area", "m2", "area in stick", SAM_JOIN_LAST, 1),
  REAL("contact_fraction", "1", "area in contact relative to that of the grid", SAM_JOIN_LAST, 0),
  INT("contact_cells", "cells in contact"),
  INT("stick_cells", "cells in stick"),
  REAL("pressure_max", "Pa", "maximum pressure", SAM_JOIN_LAST, 1),
  REAL("shear_max", "Pa", "maximum shear, also at the edge of stick between cells", SAM_JOIN_LAST, 1),
  REAL("slip_max", "m", "maximum slip since the start in contact, also at its edge between cells", SAM_JOIN_LAST, 1),
  REAL("edge_accepted", "1", "share of the contact edge and the stick-slip boundary that is reconstructed",
       SAM_JOIN_LAST, 0),
  REAL("slip_width", "m", "mean width of the slip zone: its area over the length of the contact's edge", SAM_JOIN_LAST,
       0),
  REAL("contact_half_x", "m", "half width of the contact along x: half of its extent", SAM_JOIN_LAST, 0),
  REAL("contact_half_y", "m", "half width of the contact along y: half of its extent", SAM_JOIN_LAST, 0),
  REAL("stick_half_x", "m", "half width of the stick zone along x: half of its extent", SAM_JOIN_LAST, 0),
  REAL("stick_half_y", "m", "half width of the stick zone along y: half of its extent", SAM_JOIN_LAST, 0),
  REAL("dissipated_energy", "J", "frictional work of the load step", SAM_JOIN_SUM, 2),
  REAL("stored_energy", "J", "elastic energy of both bodies", SAM_JOIN_LAST, 2),
  REAL("energy_error", "J", "estimated error of dissipated_energy by the length of the load step", SAM_JOIN_SUM, 0),
  REAL("dissipated_energy_closed", "J", "the same in closed form, of alike bodies under T along a line", SAM_JOIN_SUM,
       0),
  {SAM_ENTERING, "J", NULL, SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_FALSE, SAM_JOIN_SUM, 0},
  {SAM_TOUCHING, "1", NULL, SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_FALSE, SAM_JOIN_SUM, 0},
  {SAM_UNBALANCED, "J", NULL, SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_FALSE, SAM_JOIN_SUM, 0}};

/* Numbers of the contact edge: 1 if known, area, faces and good faces, half widths; valid until the pressure changes */
enum { KNOWN = SAM_CONTACT_EDGE_KNOWN, AREA, FACES = SAM_CONTACT_EDGE_FACES, GOOD, HALF, EDGE = HALF + 2 };
static const SamStateNumber contact_edge = {
  SAM_CONTACT_EDGE, "1", "edge of contact", SAM_NUMBER_REAL, EDGE, PETSC_FALSE, PETSC_FALSE, SAM_JOIN_LAST, 0};

PetscErrorCode SamSolutionDeclareNumbers(SamState state, SamMotion motion)
{
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareNumber(state, &contact_edge, &id));
  PetscCall(SamSolutionDeclareClosed(state));
  PetscCall(SamSolutionDeclareShear(state));
  for (PetscInt k = 0; k < NUMBERS; k++) PetscCall(SamMotionDeclareNumber(motion, state, &declared[k], &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Terms beside the work of the loads: the change of the elastic energy by the shear and by the pressure, the work in
   cells that are released (J), and the sum of the bounds before and after the step (N); `balances`: true if work,
   energy and loads add up. */
typedef struct {
  PetscBool balances;
  double    locked, pressed, released, bore, bears;
} Balance;

static PetscErrorCode SumCells(SamProblem problem, const SamSolution *last, const SamSolution *s,
                               double numbers[NUMBERS], Balance *balance)
{
  SamTotal      totals[SUMS] = {{0}};
  double        sums[SUMS], most[MOSTS] = {0}, area, *turned[2];
  SamIncrement  increment;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamIncrementCreate(problem, last, s, &increment));
  PetscCall(SamIncrementMeasure(&increment));
  PetscCall(PetscMalloc2(grid->nx, &turned[0], grid->nx, &turned[1]));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double   row[SUMS] = {0};
    PetscInt span[2];

    SamIncrementFindSpan(&increment, j, span);
    if (span[0] == span[1]) continue;
    SamIncrementComputeRow(&increment, j);
    SumRow(&increment, j, span, row, most);
    AddErrors(&increment, j, span, turned, row);
    SamAddAll(SUMS, totals, row);
  }
  PetscCall(PetscFree2(turned[0], turned[1]));
  PetscCall(SamIncrementDestroy(&increment));
  PetscCall(SamSumTotals(grid->comm, SUMS, totals, sums));
  PetscCall(SamMax(grid->comm, MOSTS, most));
  area                       = grid->dx * grid->dy;
  numbers[PRESSURE_MAX]      = most[PRESSURE];
  numbers[SHEAR_MAX]         = sqrt(most[SHEAR]);
  numbers[SLIP_MAX]          = sqrt(most[SLIP]);
  numbers[CONTACT_CELLS]     = sums[CONTACT];
  numbers[STICK_CELLS]       = sums[STICK];
  numbers[CONTACT_AREA]      = sums[CONTACT] * area;
  numbers[STICK_AREA]        = sums[STICK] * area;
  numbers[DISSIPATED_ENERGY] = sums[DISSIPATED] * area;
  numbers[STORED_ENERGY]     = sums[STORED] * area;
  balance->locked            = sums[LOCKED] * area;
  balance->pressed           = sums[PRESSED] * area;
  balance->released          = sums[RELEASED] * area;
  balance->bore              = sums[BORE] * area;
  balance->bears             = sums[BEARS] * area;
  sums[ERROR] +=
    sums[TURNED] / PetscMax(sums[STICK] / PetscMax(sums[CONTACT], 1), LEAST) + ErrorOfTouching(s->rule, sums);
  numbers[ENERGY_ERROR] = sums[ERROR] * area;
  numbers[ENTERING]     = sums[BEFORE_TOUCH] * area;
  numbers[TOUCHING]     = SamRuleTouches(s->rule) ? 1 : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- edges ---- */

/* Computes areas and half widths within the edges of contact and stick, and the largest shear, between both. */
static PetscErrorCode FindEdges(SamProblem problem, SamState state, const SamSolution *s, double contact[EDGE],
                                double numbers[NUMBERS])
{
  const PetscBool both = numbers[STICK_CELLS] > 0 && numbers[STICK_CELLS] < numbers[CONTACT_CELLS];
  const SamEdge  *edge;
  const SamGrid   grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  if (contact[KNOWN] == 0) {
    PetscCall(SamSolutionFindEdge(problem, s, SAM_EDGE_CONTACT, &edge));
    contact[KNOWN] = 1;
    contact[AREA]  = edge->area;
    contact[FACES] = edge->faces;
    contact[GOOD]  = edge->good;
    for (int k = 0; k < 2; k++) contact[HALF + k] = edge->half[k];
  }
  PetscCall(SamSolutionFindEdge(problem, s, SAM_EDGE_STICK, &edge));
  PetscCall(SamSolutionFindShear(problem, state, s, both ? edge : NULL, &numbers[SHEAR_MAX]));
  numbers[CONTACT_AREA] = contact[AREA];
  numbers[STICK_AREA]   = PetscMin(edge->area, contact[AREA]); /* both are reconstructed, each with its own error */
  for (int k = 0; k < 2; k++) {
    numbers[CONTACT_HALF + k] = contact[HALF + k];
    numbers[STICK_HALF + k]   = PetscMin(edge->half[k], contact[HALF + k]);
  }
  numbers[SLIP_WIDTH] = NAN; /* flat periodic bodies have no edge */
  if (contact[FACES] > 0)
    numbers[SLIP_WIDTH] = PetscMax(contact[AREA] - (double)edge->area, 0) / SamContactEdgeLength(grid, contact[FACES]);
  numbers[EDGE_ACCEPTED] =
    contact[FACES] + edge->faces > 0 ? (contact[GOOD] + edge->good) / (contact[FACES] + edge->faces) : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds what the tension does: the pressure that the field `pressure` has, and its elastic energy. */
static PetscErrorCode AddTension(SamProblem problem, const SamSolution *s, double numbers[NUMBERS])
{
  const SamGrid grid = SamProblemGetGrid(problem);
  const double *t, *u;
  PetscReal     most, work;
  Vec           total;

  PetscFunctionBegin;
  PetscCall(SamSolutionCreateTotal(problem, s, &total));
  PetscCall(VecMax(total, NULL, &most));
  PetscCall(SamSolutionDestroyTotal(s, &total));
  PetscCall(VecGetArrayRead(s->tension, &t));
  PetscCall(VecGetArrayRead(s->displacement_z, &u));
  PetscCall(SamGridDot(grid, 1, t, u, &work));
  PetscCall(VecRestoreArrayRead(s->displacement_z, &u));
  PetscCall(VecRestoreArrayRead(s->tension, &t));
  numbers[PRESSURE_MAX] = (double)most;
  numbers[STORED_ENERGY] -= 0.5 * (double)(grid->dx * grid->dy * work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if a uniform strain moves the surfaces along each other in this solution. */
static PetscErrorCode IsStrained(SamProblem problem, const SamSolution *s, PetscBool *strained)
{
  SamStrain e;

  PetscFunctionBegin;
  PetscCall(SamProblemDisplace(problem, NULL, &s->control, NULL, NULL, &e, NULL));
  *strained = e.xx != 0 || e.yy != 0 || e.xy != 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds out if the work of the tangential loads in a step is stored by the shear or dissipated: nothing else moves the
   surfaces along each other, if laws do not by fields. */
static PetscErrorCode HasBalance(SamProblem problem, const SamSolution *before, const SamSolution *s, PetscBool *has)
{
  const SamElasticity bodies      = SamProblemGetElasticity(problem);
  PetscBool           strained[2] = {PETSC_FALSE, PETSC_FALSE};

  PetscFunctionBegin;
  *has = PETSC_FALSE;
  if (!before || s->rolled != 0 || s->tension || SamProblemSlides(problem)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(IsStrained(problem, before, &strained[0]));
  PetscCall(IsStrained(problem, s, &strained[1]));
  if (strained[0] || strained[1]) PetscFunctionReturn(PETSC_SUCCESS);
  *has = !SamElasticityGetTraits(bodies).coupled && !SamElasticityRemembers(bodies) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  The energy that friction dissipates in a step is also the work of the tangential loads less what the shear stores. Of
  cells that lose or make contact under shear the slip of a long step tells little. The work is certain where the
  displacement is held, or the load; else it is that of a load which changes in proportion to the displacement, give or
  take CURVED times the product of both changes: that of a load which changes at once, as where all slides back. Where N
  stays, the sum over cells is far better, and within that. Where N falls or grows, as large a part of the difference
  counts as the bounds of the shear have lost or won.

  Where N falls: in cells that are released that part of RELEASES times their work counts, as they slide in another
  order in a long step, and all of it where no balance tells if their shear could go back with N; where contact is lost
  as a whole, that part of the uncertain work, too, and of half the work of the bounds along the displacement: that may
  go back with N, or begin with it, so that nothing seems to be lost.

  Where N grows and all sticks, as with T in proportion to N, the contact stiffens along the surfaces as it does across
  them (Ciavarella 1998, Jaeger 1998): the work is below that of a mean load by the same part of the uncertain work as
  that of the normal loads, which the pressure stores. So is the difference, to 7 % of spheres, 0.01 % in plane strain;
  or it is none, where the shear has begun to slip. What else it contains belongs to the shear that the step locks in,
  and later steps dissipate it; below LOCKS times what is locked in it counts as none.

  Bodies without this balance have the difference of similar ones whose stiffness k follows the contact's radius, the
  cube root of N: the work of a load with dT/dd from k0 to k1 is (k1 - k0)/12 dd^2 below that of its mean, a third of
  (k1 - k0)/(k1 + k0) times the uncertain work. Where N grows on bodies of alike materials, T that is given as a load,
  like N, grows as the shear that is locked in takes it to, or both as displacements: only others count. A difference
  that is rounding beside the stored energy is none.
*/
#define CURVED   0.5
#define RELEASES 0.3
#define LOCKS    0.002
#define ROUNDING 1e-9

/* The work of the loads of one kind in a step if they change in proportion to the displacements, what of it is not
   certain, and what of that is of loads that are not given as N is, by a load or a displacement (J) */
typedef struct {
  double all, unsure, unlike;
} Work;

static Work FindWork(const SamSolution *before, const SamSolution *s, SamBalanceKind kind)
{
  const PetscBool *given = s->control.force;
  Work             work  = {0};

  for (PetscInt n = 0; n < 3; n++) {
    const PetscInt c   = SamComponentsOf[kind][n];
    const double   way = (double)(s->rigid[c] - before->rigid[c]);
    const double   may = CURVED * fabs((double)(s->load[c] - before->load[c]) * way);

    work.all += 0.5 * (double)(before->load[c] + s->load[c]) * way;
    work.unsure += may;
    work.unlike += given[c] != given[SAM_COMPONENT_N] ? may : 0;
  }
  return work;
}

static double ErrorByBalance(const SamSolution *before, const SamSolution *s, const double numbers[NUMBERS],
                             const Balance *balance)
{
  const double    more = PetscMax(balance->bore, balance->bears), less = PetscMin(balance->bore, balance->bears);
  const PetscReal way    = hypot(s->rigid[SAM_COMPONENT_TX] - before->rigid[SAM_COMPONENT_TX],
                                 s->rigid[SAM_COMPONENT_TY] - before->rigid[SAM_COMPONENT_TY]);
  const PetscBool grows  = more == balance->bears ? PETSC_TRUE : PETSC_FALSE;
  const Work      normal = FindWork(before, s, SAM_BALANCE_NORMAL), work = FindWork(before, s, SAM_BALANCE_TANGENTIAL);
  const double    stiffer = more > 0 ? 1 - cbrt(less / more) : 0, unsure = work.unsure;
  double          lost, lacks, loses;

  lost  = RELEASES * PetscMax(balance->released, PetscMax(unsure, CURVED * balance->bore * (double)way));
  lacks = balance->balances ? work.all - balance->locked - numbers[DISSIPATED_ENERGY]
                            : (grows && !SamRuleTouches(s->rule) ? work.unlike : unsure) * stiffer / (2 - stiffer) / 3;
  if (balance->balances && grows && normal.unsure > 0)
    lacks = PetscMin(fabs(lacks), fabs(lacks - (normal.all - balance->pressed) / normal.unsure * unsure));
  lacks = fabs(lacks);
  if (lacks <= ROUNDING * numbers[STORED_ENERGY]) lacks = 0;
  if (grows && lacks <= LOCKS * (fabs(balance->locked) + unsure)) lacks = 0;
  loses = PetscMax(lacks, balance->bears > 0 ? (balance->balances ? RELEASES : 1) * balance->released : lost);
  return PetscMax(PetscMax(lacks - unsure, 0), balance->bore > 0 ? (1 - less / more) * loses : 0);
}

PetscErrorCode SamSolutionComputeNumbers(SamProblem problem, SamState state, const SamSolution *before,
                                         const SamSolution *s, PetscBool same_pressure, PetscBool edges)
{
  double *const numbers = SamStateNumbers(state, SamStateFindNumber(state, declared[0].name), SAM_TRIED);
  double *const contact = SamStateNumbers(state, SamStateFindNumber(state, contact_edge.name), SAM_TRIED);
  PetscBool     streams, offset, friction;
  Balance       balance;
  const SamGrid grid = SamProblemGetGrid(problem);

  PetscFunctionBegin;
  PetscCall(SamProblemHasFriction(problem, &friction));
  streams = SamMotionOf(SamProblemGetElasticity(problem))->streams;
  PetscCall(SumCells(problem, before, s, numbers, &balance));
  if (s->tension) PetscCall(AddTension(problem, s, numbers));
  PetscCall(SamSolutionFollowClosed(problem, state, before, s, numbers[STICK_CELLS], &numbers[CLOSED]));
  if (streams || SamElasticityGetTraits(SamProblemGetElasticity(problem)).skewed)
    numbers[STORED_ENERGY] = NAN; /* u_t is per rolled distance, and material that creeps has dissipated a part */
  if (streams || s->rolled != 0) numbers[ENERGY_ERROR] = NAN; /* it is estimated elsewhere */
  PetscCall(SamProblemDisplace(problem, state, &s->control, NULL, NULL, NULL, &offset));
  if (offset) numbers[STORED_ENERGY] = NAN; /* the tractions alone do not cause the displacements */
  if (offset && !before) numbers[ENERGY_ERROR] = fabs(numbers[DISSIPATED_ENERGY]); /* nor in proportion to the load */
  PetscCall(HasBalance(problem, before, s, &balance.balances));
  if (offset || streams) balance.balances = PETSC_FALSE;
  numbers[UNBALANCED] = 0;
  if (before && friction && s->rolled == 0 && !streams && !SamProblemSlides(problem))
    numbers[UNBALANCED] = ErrorByBalance(before, s, numbers, &balance);
  numbers[ENERGY_ERROR] = PetscMax(numbers[ENERGY_ERROR], numbers[UNBALANCED]);
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  numbers[EDGE_ACCEPTED] = 0;
  numbers[SLIP_WIDTH]    = NAN;
  if (!same_pressure) contact[KNOWN] = 0;
  if (edges) {
    PetscCall(FindEdges(problem, state, s, contact, numbers));
  } else {
    PetscCall(SamSolutionCountHalf(problem, s, SAM_EDGE_CONTACT, &numbers[CONTACT_HALF]));
    PetscCall(SamSolutionCountHalf(problem, s, SAM_EDGE_STICK, &numbers[STICK_HALF]));
  }
  if (SamGridIsRow(grid)) numbers[CONTACT_HALF + 1] = numbers[STICK_HALF + 1] = NAN; /* plane strain has no y */
  if (edges && friction && s->rolled == 0) PetscCall(SamSolutionFindSlip(problem, state, s, &numbers[SLIP_MAX]));
  if (!friction) numbers[SLIP_MAX] = NAN; /* nothing opposes it, and at the edge it is not resolved */
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  numbers[FRACTION] = numbers[CONTACT_AREA] / (grid->width[0] * grid->width[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
