/* The correction of the shear for the edges of contact and stick: closed solutions, histories, and what is refused. */
#include "contacts.h"

#include <petsam/influence.h>
#include <string.h>

#define DEFERRED "-edges deferred"
#define PLAIN    NewPair(210e9, 0, 210e9, 0) /* then Cattaneo's solution is exact */

/* ---- slopes and sub-cells ---- */

/* The displacement along `to` of a point by a shear along `from` that is linear in one cell, by its sub-cells. */
static double BySubCells(const Sphere *s, int axis, int from, int to, PetscInt i, PetscInt j)
{
  enum { SUB = 61 };
  const double h[2] = {s->grid->dx / SUB, s->grid->dy / SUB};
  double       sum  = 0;

  for (int b = 0; b < SUB; b++)
    for (int a = 0; a < SUB; a++) {
      const double      at = ((axis ? b : a) + 0.5) / SUB - 0.5;
      const PetscInt    x = i * SUB + SUB / 2 - a, y = j * SUB + SUB / 2 - b;
      const SamIntegral kind = from != to ? SAM_INTEGRAL_XY : from ? SAM_INTEGRAL_YY : SAM_INTEGRAL_XX;

      sum += at * s->pair.shear_xx * SamIntegralCell(kind, h[0], h[1], x, y);
      if (from == to) sum += at * s->pair.shear * SamIntegralCell(SAM_INTEGRAL_R, h[0], h[1], x, y);
    }
  return sum;
}

/* A shear that is linear in one cell, on cells that are not square, near and far, on both sides and in itself. */
static void test_linear_shear_displaces_as_its_sub_cells(void **state)
{
  Sphere s = {.pair = Steel()};

  (void)state;
  s.grid = NewGridOn(PETSC_COMM_WORLD, 23, 19, 2e-3, 3e-3, 0, 0);
  sam_call(SamElasticityCreate(s.grid, &s.pair, &s.elasticity));
  for (int k = 0; k < 4; k++) {
    const int axis = k % 2, from = k / 2;
    Vec       slopes = NewField(s.grid, 2), u = NewField(s.grid, 2);
    double   *whole;

    AddAt(s.grid, from, 12, 8, 1e6, slopes);
    sam_call(SamElasticityApplyTangentialSlopes(s.elasticity, axis, slopes, u));
    whole = Whole(s.grid, 2, u);
    for (PetscInt j = 0; j < 19; j += 2)
      for (PetscInt i = 0; i < 23; i += 3)
        for (int to = 0; to < 2; to++) {
          const double exact = 1e6 * BySubCells(&s, axis, from, to, i - 12, j - 8);

          sam_assert_close(whole[(to * 19 + j) * 23 + i], exact,
                           1e-3 * fabs(exact) + 1e-8 * 1e6 * s.pair.shear * s.grid->dx);
        }
    free(whole);
    sam_call(VecDestroy(&u));
    sam_call(VecDestroy(&slopes));
  }
  sam_call(SamElasticityDestroy(&s.elasticity));
  sam_call(SamGridDestroy(&s.grid));
}

/* Uniform shear on all sub-cells is that of the cell. */
static void test_sub_cells_of_a_shear_add_up_to_the_cell(void **state)
{
  enum { REACH = 2, LAGS = 2 * REACH + 1, SUB = 5 };
  static const SamElasticityKernel kernels[] = {SAM_ELASTICITY_XX, SAM_ELASTICITY_YY, SAM_ELASTICITY_XY};
  static const SamIntegral         kinds[]   = {SAM_INTEGRAL_XX, SAM_INTEGRAL_YY, SAM_INTEGRAL_XY};
  Sphere                           s         = NewSphereOf(Steel(), 20, 1.5);
  double                           table[LAGS * LAGS * SUB * SUB];

  (void)state;
  for (int n = 0; n < 3; n++) {
    sam_call(SamElasticityGetNear(s.elasticity, kernels[n], REACH, SUB, table));
    for (int k = 0; k < LAGS * LAGS; k++) {
      const PetscInt i = k % LAGS - REACH, j = k / LAGS - REACH;
      double         sum = 0, exact = s.pair.shear_xx * SamIntegralCell(kinds[n], s.grid->dx, s.grid->dy, i, j);

      if (n < 2) exact += s.pair.shear * SamIntegralCell(SAM_INTEGRAL_R, s.grid->dx, s.grid->dy, i, j);
      for (int l = 0; l < SUB * SUB; l++) sum += table[k * SUB * SUB + l];
      sam_assert_close(sum, exact, 1e-12 * s.pair.shear * s.grid->dx);
    }
  }
  DestroySphere(&s);
}

/* ---- closed solutions ---- */

/* Cattaneo and Mindlin's shear at a radius (a = 1e-3) after loading to T0 and unloading to T, over mu N. */
static double ExactShear(const Case *c, double r, double T0, double T)
{
  const double radii[] = {1, cbrt(1 - T0), cbrt(1 - (T0 - T) / 2)}, signs[] = {T < T0 ? -1 : 1, -1, T < T0 ? 2 : 0};
  double       q = 0;

  for (int k = 0; k < 3; k++)
    if (signs[k] != 0) q += signs[k] * radii[k] * Hertz(&c->s, r / radii[k]);
  return MU * q;
}

typedef struct {
  double shear, area, peak; /* relative errors: of q_x at the centres in the 2-norm, of the stick area, of the peak */
} Errors;

static Errors Measure(const Case *c, const SamStep *step, double T0, double T)
{
  const SamGrid grid    = c->s.grid;
  const double  stick   = T < T0 ? cbrt(1 - (T0 - T) / 2) : cbrt(1 - T0);
  Vec           center  = NewField(grid, 1);
  double        sums[2] = {0, 0};
  const double *q;
  Errors        e;

  sam_call(SamContactComputeShearCenter(c->contact, 0, center));
  sam_call(VecGetArrayRead(center, &q));
  for (PetscInt k = 0; k < grid->cells; k++) {
    const double exact =
      ExactShear(c, hypot(SamGridX(grid, k % grid->nx), SamGridY(grid, grid->row_start + k / grid->nx)), T0, T);

    sums[0] += (q[k] - exact) * (q[k] - exact);
    sums[1] += exact * exact;
  }
  sam_call(VecRestoreArrayRead(center, &q));
  sam_call(VecDestroy(&center));
  (void)MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  e.shear = sqrt(sums[0] / sums[1]);
  e.area  = fabs((double)step->stick_area / (PETSC_PI * 1e-6 * stick * stick) - 1);
  e.peak  = fabs((double)step->shear_max / (MU * Hertz(&c->s, stick * 1e-3)) - 1);
  if (getenv("SAM_SHOW")) print_message("# shear %g area %g peak %g\n", e.shear, e.area, e.peak);
  return e;
}

/* Means differ from these by 1e-2, and the reconstruction by 1.5e-3, 2e-4 and 5e-4. */
static void test_correction_makes_cattaneos_shear_exact(void **state)
{
  Case       c       = NewCase(PLAIN, 90, 1.5, MU, DEFERRED);
  SamControl control = Loads(&c, 1, 0.6, 0, 0);
  SamStep    step    = Solve(&c, &control);
  Errors     e       = Measure(&c, &step, 0.6, 0.6);

  (void)state;
  AssertGood(&step);
  sam_assert(step.edge_passes == 2 && step.stick_passes == 2);
  sam_assert(e.shear < 6e-4);
  sam_assert(e.area < 8e-5);
  sam_assert(e.peak < 5e-4);
  DestroyCase(&c);
}

/* Back in steps: the old edge of stick stays in the shear, inside of the new one. Plain: 2e-2 and 5e-3. */
static void test_correction_follows_the_load_back(void **state)
{
  static const double back[] = {0.4, 0.2, 0.0, -0.2, -0.4};
  Case                c      = NewCase(PLAIN, 130, 1.5, MU, DEFERRED);
  SamStep             step   = Solve(&c, &(SamControl[]){Loads(&c, 1, 0.6, 0, 0)}[0]);

  (void)state;
  for (int k = 0; k < 5; k++) {
    Errors e;

    step = Solve(&c, &(SamControl[]){Loads(&c, 1, back[k], 0, 0)}[0]);
    e    = Measure(&c, &step, 0.6, back[k]);
    AssertGood(&step);
    sam_assert(step.stick_passes == 2);
    sam_assert(e.shear < (k ? 2e-3 : 1.5e-2)); /* of a slip zone of one cell at first */
    sam_assert(e.area < 3e-4);
  }
  DestroyCase(&c);
}

/* ---- histories ---- */

static Vec ShearOf(const Case *c)
{
  return Copy(SolutionOf(c)->shear);
}

static SamStep Push(const Case *c, double x, double y)
{
  return Solve(c, &(SamControl[]){Loads(c, 1, x, y, 0)}[0]);
}

/* A state goes on in another contact, and a rejected try leaves no trace, all to the last bit. */
static void test_correction_belongs_to_the_state(void **state)
{
  Case            c = NewCase(Steel(), 61, 1.5, MU, DEFERRED), other = NewCase(Steel(), 61, 1.5, MU, DEFERRED);
  SamStep         step[2];
  SamContactState now;

  (void)state;
  (void)Push(&c, 0.5, 0);
  step[0] = Push(&c, 0.1, 0.1);
  sam_assert(step[0].edge_passes == 2);
  sam_call(SamContactGetState(c.contact, &now));
  sam_call(SamContactSetState(other.contact, &now));
  (void)Try(&other, &(SamControl[]){Loads(&c, 1.2, 0.3, 0, 0)}[0]);
  sam_call(SamContactReject(other.contact));
  step[0] = Push(&c, -0.1, 0.1);
  step[1] = Push(&other, -0.1, 0.1);
  sam_assert(SameNumbers(SAM_COMPONENTS, step[0].rigid, step[1].rigid));
  sam_assert(step[0].dissipated_energy == step[1].dissipated_energy && step[0].stick_area == step[1].stick_area);
  sam_assert(SameBitsOf(&c, &other, ShearOf) && SameBitsOf(&c, &other, NewSlip));
  DestroyCase(&c);
  DestroyCase(&other);
}

static void test_correction_does_not_depend_on_the_ranks(void **state)
{
  Case    c[2];
  double *whole[2];
  SamStep step[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    c[k] = NewCaseOn(NewSphereOn(k ? PETSC_COMM_SELF : PETSC_COMM_WORLD, Steel(), 53, 1.5, 0, 0), MU, NULL, DEFERRED);
    (void)Push(&c[k], 0.5, 0.1);
    step[k]  = Push(&c[k], -0.2, 0.2);
    whole[k] = Whole(c[k].s.grid, 2, SolutionOf(&c[k])->shear);
  }
  sam_assert(SameNumbers(1, &step[0].stick_area, &step[1].stick_area));
  sam_assert(SameNumbers(SAM_COMPONENTS, step[0].rigid, step[1].rigid));
  sam_assert(!memcmp(whole[0], whole[1], sizeof(double) * 2 * 53 * 53));
  for (int k = 0; k < 2; k++) {
    free(whole[k]);
    DestroyCase(&c[k]);
  }
}

/*
  A small reversal: all sticks at once, the shear stays but for the change of the load, and what follows is as exact as
  after another one.
*/
static void test_small_reversal_leaves_the_shear(void **state)
{
  static const double less[] = {3e-5, 1e-4, 1e-3};

  (void)state;
  for (int k = 0; k < 3; k++) {
    Case    c      = NewCase(PLAIN, 74, 1.5, MU, DEFERRED);
    SamStep first  = Push(&c, 0.6, 0), step;
    Vec     before = ShearOf(&c);

    step = Push(&c, 0.6 * (1 - less[k]), 0);
    sam_assert(step.status == SAM_STATUS_CONVERGED);
    sam_assert(Difference(SolutionOf(&c)->shear, before, NORM_2) < 3e-2);
    sam_assert_close(step.rigid[SAM_COMPONENT_TX] / first.rigid[SAM_COMPONENT_TX], 1, 2e-3);
    sam_assert((double)step.stick_area > 0.9 * (double)step.contact_area);
    step = Push(&c, 0.1, 0);
    sam_assert(Measure(&c, &step, 0.6, 0.1).shear < 1e-2);
    sam_call(VecDestroy(&before));
    DestroyCase(&c);
  }
}

/* Loads that stay: the solution is the one before, to the last bit, and nothing is dissipated. */
static void test_held_load_changes_nothing(void **state)
{
  Case    c      = NewCase(Steel(), 61, 1.5, MU, DEFERRED);
  SamStep first  = Push(&c, 0.5, 0.1), held;
  Vec     before = ShearOf(&c);

  (void)state;
  for (int k = 0; k < 2; k++) {
    held = Push(&c, 0.5, 0.1);
    sam_assert(held.stick_area == first.stick_area && held.stick_passes == first.stick_passes);
    sam_assert(held.dissipated_energy == 0 && held.tangential_iterations == 0);
    sam_assert(SameBits(SolutionOf(&c)->shear, before));
    AssertGood(&held);
  }
  sam_call(SamProblemSetFriction(c.problem, 0.9 * MU)); /* another bound: not the same problem */
  held = Push(&c, 0.5, 0.1);
  sam_assert(held.tangential_iterations > 0 && held.stick_area < first.stick_area);
  sam_call(VecDestroy(&before));
  DestroyCase(&c);
}

/* After a corrected step one of another way goes on from the plain solution, which the check knows. */
static void test_other_ways_go_on_from_the_plain_solution(void **state)
{
  Case    c = NewCase(Steel(), 53, 1.5, MU, DEFERRED), plain = NewCase(Steel(), 53, 1.5, MU, "-edges none");
  SamStep step[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    const Case *one = k ? &plain : &c;

    (void)Push(one, 0.5, 0);
    sam_call(SamContactSetEdges(one->contact, SAM_CONTACT_EDGES_NONE, PETSC_DEFAULT));
    step[k] = Push(one, -0.2, 0.1);
    AssertGood(&step[k]);
  }
  sam_assert(Difference(SolutionOf(&c)->shear, SolutionOf(&plain)->shear, NORM_2) < 1e-4);
  DestroyCase(&c);
  DestroyCase(&plain);
}

/* A state without a corrected shear takes away that of the state before. */
static void test_state_without_a_correction_takes_it_away(void **state)
{
  Case            c = NewCase(Steel(), 53, 1.5, MU, DEFERRED), used = NewCase(Steel(), 53, 1.5, MU, DEFERRED);
  SamContactState now;

  (void)state;
  sam_call(SamContactSetEdges(c.contact, SAM_CONTACT_EDGES_NONE, PETSC_DEFAULT));
  (void)Push(&c, 0.4, 0);
  sam_call(SamContactSetEdges(c.contact, SAM_CONTACT_EDGES_DEFERRED, PETSC_DEFAULT));
  (void)Push(&used, 0.6, 0);
  (void)Push(&used, -0.3, 0);
  sam_call(SamContactGetState(c.contact, &now));
  sam_call(SamContactSetState(used.contact, &now));
  (void)Push(&c, 0.5, 0.1);
  (void)Push(&used, 0.5, 0.1);
  sam_assert(SameBitsOf(&c, &used, ShearOf));
  DestroyCase(&c);
  DestroyCase(&used);
}

/* The energies are those of the plain solution, whose errors cancel. */
static void test_energies_are_those_of_the_plain_solution(void **state)
{
  static const double way[] = {0.3, 0.6, 0.2, -0.3, -0.1};
  Case                c     = NewCase(Steel(), 47, 1.5, MU, DEFERRED " -tangential_rtol 1e-9 -normal_rtol 1e-11"),
       plain                = NewCase(Steel(), 47, 1.5, MU, "-edges none -tangential_rtol 1e-9 -normal_rtol 1e-11");

  (void)state;
  for (int k = 0; k < 5; k++) {
    const SamStep a = Push(&c, way[k], 0), b = Push(&plain, way[k], 0);

    sam_assert(a.edge_passes == 2);
    sam_assert_close(a.dissipated_energy, b.dissipated_energy, 1e-4 * fabs((double)b.dissipated_energy));
    sam_assert_close(a.stored_energy, b.stored_energy, 1e-7 * (double)b.stored_energy);
  }
  DestroyCase(&c);
  DestroyCase(&plain);
}

/* ---- what is left, and what the check sees ---- */

/* Pressed by steps: no shear, and nothing to correct in it; then it slips. */
static void test_shear_that_begins_later_is_corrected(void **state)
{
  Case       c       = NewCase(PLAIN, 90, 1.5, MU, DEFERRED);
  SamControl control = Loads(&c, 0.5, 0, 0, 0);
  SamStep    step    = Solve(&c, &control);

  (void)state;
  sam_assert(step.edge_passes == 2 && step.stick_passes == 0);
  step = Push(&c, 0, 0);
  sam_assert(step.edge_passes == 2 && step.stick_passes == 0);
  step = Push(&c, 0.6, 0);
  sam_assert(step.stick_passes == 2);
  sam_assert(Measure(&c, &step, 0.6, 0.6).area < 8e-5);
  DestroyCase(&c);
}

/* Without slip the stick zone ends with the contact. */
static void test_stick_zone_without_slip_is_the_contact(void **state)
{
  Case    c    = NewCase(Steel(), 61, 1.5, MU, DEFERRED);
  SamStep step = Push(&c, 0, 0);

  (void)state;
  sam_assert(step.edge_passes == 2 && step.stick_area == step.contact_area && step.edge_accepted == 1);
  DestroyCase(&c);
}

/* Of cells that have slipped and stick now the shear at the centre is near the mean. */
static void test_centres_of_cells_that_stick_again(void **state)
{
  Case          c      = NewCase(Steel(), 70, 1.5, MU, DEFERRED);
  Vec           center = NewField(c.s.grid, 1);
  SamControl    control;
  const double *q, *mean;
  double        most = 0;

  (void)state;
  (void)Push(&c, 0.6, 0);
  control = Loads(&c, 1, 0.6, 0, 0.03);
  (void)Solve(&c, &control);
  (void)Push(&c, 0.5, 0);
  sam_call(SamContactComputeShearCenter(c.contact, 0, center));
  sam_call(VecGetArrayRead(center, &q));
  sam_call(VecGetArrayRead(SolutionOf(&c)->shear, &mean));
  for (PetscInt k = 0; k < c.s.grid->cells; k++) most = fmax(most, fabs(q[k] - mean[k]));
  sam_call(VecRestoreArrayRead(SolutionOf(&c)->shear, &mean));
  sam_call(VecRestoreArrayRead(center, &q));
  (void)MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  if (getenv("SAM_SHOW")) print_message("# centre less mean %g of mu p0\n", most / (MU * Hertz(&c.s, 0)));
  sam_assert(most < 0.15 * MU * Hertz(&c.s, 0));
  sam_call(VecDestroy(&center));
  DestroyCase(&c);
}

/* Where the pressure is not corrected the shear is not either: the plain solution stays, to the last bit. */
static void test_shear_is_not_corrected_alone(void **state)
{
  Case c[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SamStep step;
    Vec     h, rough;

    c[k]  = NewCase(Steel(), 40, 1.5, MU, k ? DEFERRED : "");
    rough = NewRandom(c[k].s.grid, 1, 3);
    sam_call(SamProblemGetGap(c[k].problem, &h));
    sam_call(VecAXPY(h, 0.1 * c[k].s.a * c[k].s.a / c[k].s.R, rough));
    sam_call(VecDestroy(&rough));
    (void)Push(&c[k], 0.3, 0);
    step = Push(&c[k], 0.1, 0.1);
    sam_assert(step.status == SAM_STATUS_CONVERGED && step.edge_passes == 0 && step.stick_passes == 0);
  }
  sam_assert(SameBitsOf(&c[0], &c[1], ShearOf) && SameBitsOf(&c[0], &c[1], NewSlip));
  for (int k = 0; k < 2; k++) DestroyCase(&c[k]);
}

/* N and T that grow together: the edge of the shear before is within the stick zone, and the plain solution stays. */
static void test_contact_that_grows_over_a_shear_is_left(void **state)
{
  Case c[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SamStep step;

    c[k] = NewCase(Steel(), 61, 2, MU, k ? DEFERRED : "");
    step = Solve(&c[k], &(SamControl[]){Loads(&c[k], 0.5, 0.2, 0, 0)}[0]);
    sam_assert(step.stick_passes == (k ? 2 : 0));
    step = Solve(&c[k], &(SamControl[]){Loads(&c[k], 1, 0.4, 0, 0)}[0]);
    sam_assert(step.status == SAM_STATUS_CONVERGED && step.edge_passes == 0 && step.stick_passes == 0);
    sam_assert(!k || strstr(step.message, "grows over the edge of a shear that sticks"));
  }
  sam_assert(SameBitsOf(&c[0], &c[1], ShearOf) && SameBitsOf(&c[0], &c[1], NewSlip));
  (void)Solve(&c[1], &(SamControl[]){Loads(&c[1], 0.7, 0.1, 0, 0)}[0]); /* less N: it goes on with corrections */
  sam_assert(Solve(&c[1], &(SamControl[]){Loads(&c[1], 0.7, -0.6, 0, 0)}[0]).edge_passes == 2);
  for (int k = 0; k < 2; k++) DestroyCase(&c[k]);
}

/* Where the slip zone takes in the edge of the shear before, that is forgotten. */
static void test_contact_that_grows_with_its_slip_zone_is_corrected(void **state)
{
  Case    c    = NewCase(Steel(), 61, 2, MU, DEFERRED);
  SamStep step = Solve(&c, &(SamControl[]){Loads(&c, 0.8, 0.2, 0, 0)}[0]);

  (void)state;
  step = Solve(&c, &(SamControl[]){Loads(&c, 1, 0.7, 0, 0)}[0]);
  sam_assert(step.edge_passes == 2 && step.stick_passes == 2);
  DestroyCase(&c);
}

/* A first step whose slip zone is thinner than a cell: nothing of it is corrected. */
static void test_first_step_without_a_smooth_edge_of_stick_is_left(void **state)
{
  Case c[2];

  (void)state;
  for (int k = 0; k < 2; k++) {
    SamStep step;

    c[k] = NewCase(PLAIN, 60, 1.5, MU, k ? DEFERRED : "");
    for (int j = 1; j <= 2; j++) {
      step = Push(&c[k], 0.002 * j, 0.001 * j);
      sam_assert(step.status == SAM_STATUS_CONVERGED && step.edge_passes == 0 && step.stick_passes == 0);
      sam_assert(!k || strstr(step.message, "so the step stays as it is without"));
    }
  }
  sam_assert(SameBitsOf(&c[0], &c[1], ShearOf) && SameBitsOf(&c[0], &c[1], NewSlip));
  for (int k = 0; k < 2; k++) DestroyCase(&c[k]);
}

/*
  A slip zone of two cells: the largest shear, at its inner edge, and the largest slip of a cell in contact, near its
  outer one: mu times the gap outside of a contact as large as the stick zone.
*/
static void test_peaks_in_a_thin_slip_zone(void **state)
{
  Case          c    = NewCase(PLAIN, 96, 1.5, MU, DEFERRED);
  const SamStep step = Push(&c, 0.2, 0);
  const double  k = cbrt(1 - 0.2), a = 1e-3;
  const double  slip = MU * a * a / (PETSC_PI * (double)c.s.R) * ((1 - 2 * k * k) * acos(k) + k * sqrt(1 - k * k));

  (void)state;
  sam_assert(step.stick_passes == 2);
  sam_assert(Measure(&c, &step, 0.2, 0.2).peak < 2e-3);
  if (getenv("SAM_SHOW")) print_message("# slip %g\n", (double)step.slip_max / slip - 1);
  sam_assert_close(step.slip_max, slip, 0.2 * slip);
  sam_assert((double)step.slip_max < 1.02 * slip); /* none of a cell whose centre is outside */
  DestroyCase(&c);
}

/* A correction that does not converge: the plain solution stays, with all that belongs to it, also at the same N. */
static void test_correction_that_fails_leaves_the_plain_solution(void **state)
{
  Case c               = NewCase(Steel(), 61, 1.5, MU, DEFERRED),
       few             = NewCase(Steel(), 61, 1.5, MU, DEFERRED " -tangential_max_it 8");
  SamStep         step = Push(&c, 0.5, 0);
  SamContactState now;

  (void)state;
  sam_assert(step.edge_passes == 2);
  sam_call(SamContactGetState(c.contact, &now));
  sam_call(SamContactSetState(few.contact, &now));
  step = Push(&few, 0.4, 0);
  sam_assert(step.status == SAM_STATUS_CONVERGED);
  sam_assert(step.edge_passes == 0 && strstr(step.message, "did not converge"));
  DestroyCase(&few);
  DestroyCase(&c);
}

/* A slip zone that is thinner than a cell on one side: the step says that its edge is left. */
static void test_edge_of_stick_that_is_not_smooth_is_left(void **state)
{
  Case    c = NewCase(Steel(), 53, 1.5, MU, DEFERRED);
  SamStep step;

  (void)state;
  (void)Push(&c, 0.5, 0.1);
  step = Push(&c, -0.2, 0.2);
  sam_assert(step.status == SAM_STATUS_CONVERGED && step.edge_passes == 2 && step.stick_passes == 0);
  sam_assert(strstr(step.message, "the edge of stick is not corrected") && !strcmp(step.setting, "edges"));
  DestroyCase(&c);
}

static void test_coupled_problems_are_not_corrected(void **state)
{
  Case             c       = NewCase(Dissimilar(), 24, 1.5, MU, DEFERRED);
  const SamControl control = Loads(&c, 1, 0.1, 0, 0);
  SamStep          step;
  PetscErrorCode   ierr;

  (void)state;
  BeginCatching();
  ierr = SamContactTry(c.contact, &control, &step);
  EndCatching();
  sam_assert(ierr == PETSC_ERR_SUP && strstr(CaughtMessage(), "act on each other"));
  DestroyCase(&c);
}

/* The check of a corrected shear is as strict as that of a plain one. */
static void test_check_sees_what_is_wrong_with_a_correction(void **state)
{
  Case               c     = NewCase(Steel(), 61, 1.5, MU, DEFERRED);
  const SamStep      step  = Try(&c, &(SamControl[]){Loads(&c, 1, 0.6, 0, 0)}[0]);
  const SamSolution *s     = SolutionOf(&c);
  SamSolution        wrong = *s;
  SamCheck           check;

  (void)state;
  AssertGood(&step);
  sam_call(SamCheckSolution(c.problem, PETSC_TRUE, PETSC_FALSE, NULL, &wrong, &check));
  sam_assert(SameNumbers(1, &check.tangential, &step.check.tangential));
  wrong.sheared.has = PETSC_FALSE; /* the correction forgotten */
  sam_call(SamCheckSolution(c.problem, PETSC_TRUE, PETSC_FALSE, NULL, &wrong, &check));
  sam_assert(check.tangential > 1e-3);
  wrong.sheared.has = PETSC_TRUE;
  sam_call(VecDuplicate(s->sheared.rim, &wrong.sheared.rim)); /* the rim forgotten: its cells slip below their bound */
  sam_call(VecSet(wrong.sheared.rim, 0));
  sam_call(SamCheckSolution(c.problem, PETSC_TRUE, PETSC_FALSE, NULL, &wrong, &check));
  sam_assert(check.tangential > 1e-5);
  sam_call(VecDestroy(&wrong.sheared.rim));
  DestroyCase(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_linear_shear_displaces_as_its_sub_cells),
    cmocka_unit_test(test_sub_cells_of_a_shear_add_up_to_the_cell),
    cmocka_unit_test(test_correction_makes_cattaneos_shear_exact),
    cmocka_unit_test(test_correction_follows_the_load_back),
    cmocka_unit_test(test_correction_belongs_to_the_state),
    cmocka_unit_test(test_correction_does_not_depend_on_the_ranks),
    cmocka_unit_test(test_small_reversal_leaves_the_shear),
    cmocka_unit_test(test_held_load_changes_nothing),
    cmocka_unit_test(test_other_ways_go_on_from_the_plain_solution),
    cmocka_unit_test(test_state_without_a_correction_takes_it_away),
    cmocka_unit_test(test_energies_are_those_of_the_plain_solution),
    cmocka_unit_test(test_stick_zone_without_slip_is_the_contact),
    cmocka_unit_test(test_centres_of_cells_that_stick_again),
    cmocka_unit_test(test_shear_that_begins_later_is_corrected),
    cmocka_unit_test(test_shear_is_not_corrected_alone),
    cmocka_unit_test(test_contact_that_grows_over_a_shear_is_left),
    cmocka_unit_test(test_contact_that_grows_with_its_slip_zone_is_corrected),
    cmocka_unit_test(test_first_step_without_a_smooth_edge_of_stick_is_left),
    cmocka_unit_test(test_peaks_in_a_thin_slip_zone),
    cmocka_unit_test(test_correction_that_fails_leaves_the_plain_solution),
    cmocka_unit_test(test_edge_of_stick_that_is_not_smooth_is_left),
    cmocka_unit_test(test_coupled_problems_are_not_corrected),
    cmocka_unit_test(test_check_sees_what_is_wrong_with_a_correction),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}
