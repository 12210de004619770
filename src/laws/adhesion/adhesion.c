/*
  Adhesion: surfaces attract each other by a tension s(g) that falls with their gap g, whose integral is the work of
  adhesion w. Then contact has an edge at which they pull, stays under a pull up to the pull-off force, and jumps: into
  contact while the bodies approach, out of it later while they separate. The energy of both jumps is lost.

  The contact finds tension and pressure together (contact/step/attract.c); here is the law s(g) itself. Its range h
  relative to the bodies' stiffness, lambda = 2 s_0 (R/(pi w K^2))^(1/3) with s_0 = w/h and K = 4/3 E*, decides
  between the limits of balls: Derjaguin, Muller and Toporov (1975) for small lambda, Johnson, Kendall and Roberts
  (1971) for large.

  Friction bears mu times the pressure of contact, to which the tension adds: surfaces that are only held together by
  their adhesion have friction, as Derjaguin supposed. The work of adhesion does not depend on slip.

  Numbers of a step. The energy lost in it is the work of N, M_x and M_y, by the trapezoidal rule, less the growth of
  the elastic energy and of that of the tension: of second order in the step where nothing jumps.

  Sources: Maugis 1992, J. Colloid Interface Sci. 150, 243-269; Derjaguin 1934, Kolloid-Z. 69, 155-164.
*/
#include "adhesion.h"
#include <petsam/private/balance.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/state.h>
#include <math.h>

#define MOST 1e12 /* Pa: tension that no solid has; of diamond it is 1e11 */
#define ROW(name_, member_, text_, ...) \
  { \
    .name = name_, .text = text_, .kind = SAM_OPTION_REAL, .member = offsetof(SamAdhesion, member_), \
    .recorded = PETSC_TRUE, __VA_ARGS__ \
  }
static const SamOptionRow rows[] = {
  ROW("adhesion_work", work, "work of adhesion ()", .unit = "J/m2", .range = SAM_RANGE_NONNEGATIVE),
  ROW("adhesion_stress", stress, "tension () of surfaces in contact; the work over it is its range", .unit = "Pa",
      .range = SAM_RANGE_POSITIVE, .needs = "adhesion_work", .missing = "the tension between surfaces in contact"),
  {.name   = "adhesion_law",
   .text   = "tension up to its range: constant, or falling exponentially",
   .kind   = SAM_OPTION_ENUM,
   .member = offsetof(SamAdhesion, kind),
   .words  = "maugis,exponential",
   .needs  = "adhesion_work"}};

/* Rejects what a law that knows no tension would compute wrongly. */
static PetscErrorCode Refuse(const SamOptions *from)
{
  static const char *const yields[] = {"body1_yield", "body2_yield"};

  PetscFunctionBegin;
  for (int b = 0; b < 2; b++)
    PetscCall(SamOptionsExclude(from, rows[0].name, yields[b],
                                "stresses below the surface that make it yield leave out the tension"));
  PetscCall(SamOptionsExclude(from, rows[0].name, "pressure_limit",
                              "surfaces that yield no longer have their work of adhesion"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the radius of balls, from the options of the gap. */
static PetscErrorCode FindRadius(SamAdhesion *a, const SamOptions *from)
{
  static const char *const names[] = {"gap_radius1", "gap_radius2"};
  PetscReal                sum     = 0;
  PetscBool                ball;

  PetscFunctionBegin;
  PetscCall(SamOptionsHas(from, "gap_type sphere", &ball));
  for (int k = 0; k < 2 && ball; k++) {
    PetscReal radius = INFINITY;

    PetscCall(SamOptionsReal(from, names[k], "", "m", SAM_RANGE_NOT_ZERO, &radius, NULL));
    sum += 1 / radius;
  }
  a->radius = sum > 0 ? 1 / sum : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  SamAdhesion *const a = (SamAdhesion *)law->data;

  PetscFunctionBegin;
  *asked = a->work > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (!*asked) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Refuse(from));
  PetscCheck(a->stress <= MOST, from->comm, SAM_ERR_USER, "-%s%s %.6g: expected at most %.6g Pa",
             SamOptionsPrefix(from), rows[1].name, (double)a->stress, MOST);
  if (SamPrintHelp()) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindRadius(a, from));
  PetscCall(SamAdhesionWarn(law));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddParameters(SamLaw law, SamParameters *p)
{
  static const char *const words[] = {"maugis", "exponential"};

  PetscFunctionBegin;
  PetscCall(SamParametersAddText(p, "adhesion_law", PETSC_TRUE, words[((const SamAdhesion *)law->data)->kind]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Attract(SamLaw law, Vec gap, Vec tension)
{
  PetscFunctionBegin;
  PetscCall(SamAdhesionCells(law, gap, PETSC_FALSE, tension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- numbers of a step ---- */

enum { AREA, MOST_TENSION, ATTRACTION, LOST, STORED, BORDER, NUMBERS };
static const SamStateNumber numbers[NUMBERS] = {
  {"adhesive_area", "m2", "area under tension: its sum over that of surfaces in contact", SAM_NUMBER_REAL, 1,
   PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 1},
  {"tension_max", "Pa", "maximum tension", SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_TRUE, SAM_JOIN_LAST, 1},
  {"attraction_energy", "J", "energy of the tension between the surfaces, 0 far apart", SAM_NUMBER_REAL, 1, PETSC_TRUE,
   PETSC_TRUE, SAM_JOIN_LAST, 2},
  {"adhesion_energy", "J", "energy lost in jumps of the surfaces in the load step", SAM_NUMBER_REAL, 1, PETSC_FALSE,
   PETSC_TRUE, SAM_JOIN_SUM, 2},
  {"adhesion_stored", "J", NULL, SAM_NUMBER_REAL, 1, PETSC_TRUE, PETSC_FALSE, SAM_JOIN_LAST, 2},
  {"adhesion_border", "1", NULL, SAM_NUMBER_REAL, 1, PETSC_FALSE, PETSC_FALSE, SAM_JOIN_LAST, 0}};

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  PetscInt id;

  PetscFunctionBegin;
  (void)law;
  for (int k = 0; k < NUMBERS; k++) PetscCall(SamStateDeclareNumber(state, &numbers[k], &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the work of the normal loads in the step, by the trapezoidal rule. */
static PetscErrorCode ComputeWork(const SamLawStep *step, double *work)
{
  PetscReal loads[3];

  PetscFunctionBegin;
  *work = 0;
  PetscCall(SamBalanceGetLoads(step->grid, SAM_BALANCE_NORMAL, step->total, loads));
  for (PetscInt k = 0; k < 3; k++) {
    const PetscInt          c    = SamComponentsOf[SAM_BALANCE_NORMAL][k];
    const SamComponentName *name = &SamComponentNames[c];
    const double load  = *SamStateNumbers(step->state, SamStateFindNumber(step->state, name->load), SAM_COMMITTED),
                 rigid = *SamStateNumbers(step->state, SamStateFindNumber(step->state, name->rigid), SAM_COMMITTED);
    const double moved = (double)step->rigid[c] - (isfinite(rigid) ? rigid : 0);

    *work += 0.5 * ((double)loads[k] + (isfinite(load) ? load : 0)) * moved;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the energies of the tension and of the bodies, and the sum of the tension over all cells. */
static PetscErrorCode ComputeEnergies(SamLaw law, const SamLawStep *step, double *attraction, double *elastic,
                                      double *tension)
{
  const SamGrid grid  = step->grid;
  const Vec     moved = SamStateReadField(step->state, SamStateFindField(step->state, "displacement_z"));
  const double *p, *u;
  Vec           energy;
  PetscReal     sums[3];

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(grid, 1, &energy));
  PetscCall(SamAdhesionCells(law, step->field[SAM_USE_GAP], PETSC_TRUE, energy));
  PetscCall(SamBalanceGetLoads(grid, SAM_BALANCE_NORMAL, energy, sums));
  *attraction = (double)sums[0];
  PetscCall(SamBalanceGetLoads(grid, SAM_BALANCE_NORMAL, step->tension, sums));
  *tension = (double)sums[0];
  PetscCall(VecGetArrayRead(step->total, &p));
  PetscCall(VecGetArrayRead(moved, &u));
  PetscCall(SamGridDot(grid, 1, p, u, elastic));
  PetscCall(VecRestoreArrayRead(moved, &u));
  PetscCall(VecRestoreArrayRead(step->total, &p));
  *elastic *= 0.5 * (double)(grid->dx * grid->dy);
  PetscCall(VecDestroy(&energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the largest tension in the outer cells of the grid, 0 for periodic bodies. */
static PetscErrorCode GetBorder(SamLaw law, Vec tension, double *most)
{
  const SamGrid grid = law->grid;
  const double *t;

  PetscFunctionBegin;
  *most = 0;
  if (SamElasticityGetTraits(law->elasticity).periodic) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(tension, &t));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscInt  row   = grid->row_start + j;
    const PetscBool outer = grid->axes > 1 && (row == 0 || row == grid->ny - 1);

    for (PetscInt i = 0; i < grid->nx; i += outer ? 1 : PetscMax(grid->nx - 1, 1))
      *most = PetscMax(*most, t[(ptrdiff_t)j * grid->nx + i]);
  }
  PetscCall(VecRestoreArrayRead(tension, &t));
  PetscCall(SamMax(grid->comm, 1, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(SamLaw law, SamLawStep *step)
{
  const double   stress  = (double)((const SamAdhesion *)law->data)->stress;
  const PetscInt id      = SamStateFindNumber(step->state, numbers[AREA].name);
  double *const  n       = SamStateNumbers(step->state, id, SAM_TRIED);
  const double   before  = SamStateNumbers(step->state, id, SAM_COMMITTED)[STORED];
  double         tension = 0, elastic = 0, work = 0;
  PetscReal      shear, most;

  PetscFunctionBegin;
  PetscCall(ComputeEnergies(law, step, &n[ATTRACTION], &elastic, &tension));
  PetscCall(ComputeWork(step, &work));
  PetscCall(GetBorder(law, step->tension, &n[BORDER]));
  PetscCall(VecMax(step->tension, NULL, &most));
  n[BORDER] /= stress;
  n[AREA]         = tension / stress;
  n[MOST_TENSION] = (double)most;
  n[STORED]       = elastic + n[ATTRACTION];
  n[LOST]         = work - (n[STORED] - before);
  PetscCall(VecNorm(step->shear, NORM_INFINITY, &shear)); /* coupled shear and memory have energies of their own */
  if ((SamElasticityGetTraits(law->elasticity).coupled && shear > 0) || SamElasticityRemembers(law->elasticity))
    n[LOST] = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View(SamLaw law, SamState state, PetscViewer viewer)
{
  const SamAdhesion *a      = (const SamAdhesion *)law->data;
  const double      *n      = SamStateReadNumbers(state, SamStateFindNumber(state, numbers[AREA].name));
  const double       most   = *SamStateReadNumbers(state, SamStateFindNumber(state, "pull_max"));
  const double       k      = 4. / 3 * (double)SamElasticityGetModulus(law->elasticity);
  char               of[32] = "";

  PetscFunctionBegin;
  if (a->radius > 0)
    (void)snprintf(of, sizeof(of), "lambda %.4g, ",
                   2 * (double)a->stress * cbrt((double)(a->radius / (PETSC_PI * a->work)) / (k * k)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %-10s  %stension on %.6g %s, largest pull so far %.6g %s\n", "adhesion",
                                   of, n[AREA], SamStateUnitOf(state, numbers[AREA].name), most,
                                   SamStateUnitOf(state, "pull_max")));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Adhesion(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(PetscNew((SamAdhesion **)&law->data));
  ((SamAdhesion *)law->data)->stress = NAN;
  law->option                        = rows[0].name;
  law->heading                       = "Adhesion";
  law->rows                          = rows;
  law->row_count                     = sizeof(rows) / sizeof(rows[0]);
  law->bytes                         = 80;
  law->uses[SAM_USE_GAP]             = PETSC_TRUE;
  law->forbids_jumps                 = PETSC_TRUE;
  law->ops.setfromoptions            = SetFromOptions;
  law->ops.addparameters             = AddParameters;
  law->ops.attract                   = Attract;
  law->ops.declare                   = Declare;
  law->ops.advance                   = Advance;
  law->ops.view                      = View;
  law->ops.doubt                     = SamAdhesionDoubt;
  PetscFunctionReturn(PETSC_SUCCESS);
}
