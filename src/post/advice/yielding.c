/*
  Advice on bodies that yield: plastic strain that the cells, the layers or the steps do not resolve.

  Plastic strain follows from the stress at the end of a step (backward Euler), so that its error falls like the length
  of the steps in which most of it arises. Let w be the largest part of all plastic work that one step did, and s the
  maximum plastic strain times E* over the peak pressure. Then the peak pressure is too high by SUDDEN s w within a
  factor of 2, the energy of the residual stress by up to STORED times that, the plastic work by less. On 55 random
  cylinders and balls, pressed to 1.1 to 2.2 times the first yield, unloaded and fretted in 1 to 4 steps a row, compared
  with finer cells and steps, the peak pressure was wrong by 0.1 to 1.8 times SUDDEN s w, the energy by up to 1.6 times.
*/
#include "adviceimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/law.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/state.h>
#include <math.h>

/* Relative excess over the yield stress at a place without a layer */
#define BEYOND 0.01
/* Plastic strain that is not small */
#define STRAINED 0.1
/*
  Plastic strain, its work and the dent are too small by up to COARSE/m^2, with m the cells across the contact. This was
  measured on spheres under three loads, with the default layers, against 80 cells: the largest errors were 15 % at 6
  cells, 11 % at 8, 5 % at 10, 2 % at 14 and 1.6 % at 16. Errors above SAM_DOUBT_LARGE cause a warning.
*/
#define COARSE 7.0
/* Error of plastic strain in one layer, and the largest that is named; see Begun() */
#define BEGUN      1.4
#define MOST_BEGUN 0.3
/* Part by which the plastic strain extrapolated to the surface may exceed that of all layers */
#define SHALLOW 0.05
/* The same from which on the slip and its energy are wrong, too, and by which part of it (random rows: 0.15 to 0.45) */
#define DEEP  0.2
#define SLIPS 0.33
/* How many times more cells, or steps, than an error in proportion to their size needs */
#define FALLS 1.25
/* Part of the maximum plastic strain at the surface, below slip zones up to UNSEEN cells wide, from which on another
   grid may have it elsewhere */
#define NEAR   0.8
#define UNSEEN 2
/* Edges are known to a fraction of a cell if at least this share of them is reconstructed. */
#define KNOWN 0.9
/* Relative error of the peak pressure at s w = 1, in plane strain and for other contacts */
#define SUDDEN_PLANE 0.06
#define SUDDEN       0.11
#define STORED       2 /* times that: the error of the energy of the residual stress */
/* Shear by plastic strain, relative to the pressure, that friction has to carry */
#define CARRIED 1e-3
/* How many times finer a grid is advised for it, and for a body that yields between cells */
#define FINER   10
#define BETWEEN 4

#define STRAIN "plastic_max plastic_work residual_z_max" /* numbers of plastic strain */

/* Advises on plastic strain below a contact of few cells. */
static void Coarse(SamAdvice *a)
{
  const double across = (double)a->extent.across;

  /* The number of cells includes those in which the contact ends, so it is up to one too large. */
  if (!a->extent.whole && a->extent.zones)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, COARSE / (across * across),
                 SAM_ADVICE_MARGIN * sqrt(COARSE / SAM_DOUBT_LARGE) / PetscMax(across - 1, 1), STRAIN,
                 SAM_ADVICE_ACROSS, "", across, across == 1 ? "" : "s");
}

/*
  Advises on plastic strain below a narrow slip zone, whose shear is not resolved: there it may be larger than the found
  maximum. `part`: plastic strain at the surface, relative to that maximum.
*/
static void Narrow(SamAdvice *a, double part)
{
  const double width = a->slip.energy > 0 ? (double)a->slip.narrow[0] : 0;

  if (!a->error && part > NEAR && width > 0 && width < UNSEEN)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1, 2 * UNSEEN / width, "plastic_max",
                 "plastic strain is largest below slip zones of %.2g cells", width);
}

/*
  True if plastic strain is larger than elastic strain, and the body hardens no more. Then nothing keeps the shear at
  the surface from becoming a line along which a part of the body slides: the finer the layers, the larger the strain.
*/
static PetscBool Concentrates(const SamAdvice *a, SamLaw law, double most)
{
  const double flow = (double)SamPlasticGetFlowStress(law, (PetscReal)most),
               more = (double)SamPlasticGetFlowStress(law, (PetscReal)(2 * most));

  return most * SamAdviceStiffness(a->setup->pair) > flow && more < (1 + SHALLOW) * flow ? PETSC_TRUE : PETSC_FALSE;
}

/*
  Advises on plastic strain that is largest at the surface and decays within the first layers, as under friction. Much
  of it shears the surface, on which the slip depends.
*/
static void Shallow(SamAdvice *a, SamLaw law, double most)
{
  static const char why[]   = "plastic strain is largest at the surface, and falls within the first layers";
  PetscReal         surface = 0;
  double            error;
  PetscBool         line;

  a->error = SamContactGetNumber(a->setup->contact, "plastic_surface", &surface);
  error    = 1 - most / (double)surface;
  if (a->error || !(error > SHALLOW)) {
    Narrow(a, (double)surface / most);
    return;
  }
  line = error > DEEP ? Concentrates(a, law, most) : PETSC_FALSE;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, error, line ? 0 : FALLS * error / SAM_DOUBT_LARGE, "plastic_max", "%s%s",
               why, line ? ", and no grid bounds plastic_max since the body hardly hardens: give its hardening" : "");
  if (a->slip.energy > 0 && error > DEEP)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, SLIPS * error, line ? 0 : FALLS * SLIPS * error / SAM_DOUBT_LARGE,
                 "plastic_work dissipated_energy stick_area slip_max", "%s", why);
}

/*
  Advises on plastic strain that has just begun, in few layers. The error of its maximum, its work and the dent was 1.4
  over the square of the number of layers, within a third: cylinders and spheres 4 to 100 % above the first yield, with
  2 to 16 layers, compared with twice as fine cells and layers.
*/
static void Begun(SamAdvice *a)
{
  PetscReal layers = 0;
  double    error;

  if (!a->error) a->error = SamContactGetNumber(a->setup->contact, "yielded_layers", &layers);
  if (a->error || !(layers > 0)) return;
  error = PetscMin(BEGUN / (double)(layers * layers), MOST_BEGUN);
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_LAYERS, error, sqrt(error / SAM_DOUBT_LARGE), STRAIN,
               "plastic strain has just begun, in %.0f layers", (double)layers);
}

PetscBool SamAdviceCountsCells(SamAdvice *a)
{
  PetscReal accepted = 1;

  if (a->error || !SamGridIsRow(a->setup->grid) || !SamProblemGetLaw(a->setup->problem, SAM_LAW_PLASTIC))
    return PETSC_FALSE;
  a->error = SamContactGetNumber(a->setup->contact, "edge_accepted", &accepted);
  return !a->error && accepted < KNOWN ? PETSC_TRUE : PETSC_FALSE;
}

/* Advises on the area of a row of few cells after the largest load. */
static void Unloaded(SamAdvice *a)
{
  PetscReal cells = 0;

  if (!SamAdviceCountsCells(a) || a->extent.across < SAM_ADVICE_CELLS) return;
  a->error = SamContactGetNumber(a->setup->contact, "contact_cells", &cells);
  if (a->error || !(cells > 0 && cells < SAM_ADVICE_CELLS)) return;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1 / (double)cells, SAM_ADVICE_CELLS / (double)cells, "contact_area",
               "the contact of the last step is %.0f whole cells across", (double)cells);
}

/* Advises on plastic strain of which much arises in one step. */
static void Sudden(SamAdvice *a, double strain)
{
  const double full  = SamGridIsRow(a->setup->grid) ? SUDDEN_PLANE : SUDDEN;
  const double scale = strain * SamAdviceStiffness(a->setup->pair) / a->yielding.pressure;
  /* The work before these steps is unknown; these steps did that part of all by which the dent has grown. */
  const double these = a->yielding.before > 0 ? 1 - a->yielding.before / a->yielding.dent : 1;
  const double part  = a->yielding.work > 0 ? these * a->yielding.step / a->yielding.work : 0;
  const double error = full * scale * part;

  const struct {
    double      error;
    const char *names;
  } of[] = {{error, "pressure_max plastic_work"},
            {STORED * error, "residual_energy"},
            {error / 2, "contact_area plastic_max residual_z_max"}};

  for (size_t k = 0; k < sizeof(of) / sizeof(of[0]); k++) /* NaN: none of these steps has a contact */
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_STEPS, of[k].error, FALLS * of[k].error / SAM_DOUBT_LARGE, of[k].names,
                 "%.0f %% of the plastic work is done in one step", 100 * part);
}

/* Advises on the shear by plastic strain alone, without a tangential load, if its slip zone is narrower than a cell. */
static void Carried(SamAdvice *a)
{
  PetscReal pressure = 0, shear = 0;
  PetscBool rubs = PETSC_FALSE;

  if (!a->error) a->error = SamProblemHasFriction(a->setup->problem, &rubs);
  if (!a->error) a->error = SamContactGetNumber(a->setup->contact, "pressure_max", &pressure);
  if (!a->error) a->error = SamContactGetNumber(a->setup->contact, "shear_max", &shear);
  if (a->error || !rubs || a->slip.work > 0 || a->slip.widest > 0 || !(shear > CARRIED * pressure)) return;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1, FINER, "slip_max shear_max dissipated_energy stick_area",
               "plastic strain moves the surfaces along each other, and slips only within a cell of the edge");
}

/* Advises on bodies that would yield at the surface, at a peak of the shear between cells, but not on these cells. */
static void Peak(SamAdvice *a, SamLaw law)
{
  const double least = (double)SamPlasticGetYieldStress(law) / sqrt(3);

  if (a->yielding.shear > least)
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1, BETWEEN, STRAIN " residual_energy",
                 "shear at the edge of stick, %.3g Pa, is above the yield stress over sqrt(3), but no cell yields",
                 a->yielding.shear);
}

/* Advises on plastic strain that is large, spans few layers, or reaches the end of the layers. */
void SamAdviceYielding(SamAdvice *a)
{
  const SamContact contact = a->setup->contact;
  const SamLaw     law     = SamProblemGetLaw(a->setup->problem, SAM_LAW_PLASTIC);
  PetscReal        most = 0, left = 0, thick = 0, outside = 0;

  if (a->error || !law) return;
  a->error = SamContactGetNumber(contact, "plastic_max", &most);
  if (!a->error) a->error = SamContactGetNumber(contact, "yield_margin", &left);
  if (!a->error) a->error = SamContactGetNumber(contact, "layer_thickness", &thick);
  if (!a->error) a->error = SamContactGetNumber(contact, "yield_outside", &outside);
  if (a->error) return;
  if (thick > SAM_PLASTIC_THICK && (most > 0 || outside > BEYOND))
    SamDoubtsAdd(&a->doubts, SAM_CAUSE_LAYERS, SAM_DOUBT_LARGE * (double)thick / SAM_PLASTIC_THICK,
                 (double)thick / SAM_PLASTIC_THICK, STRAIN " residual_energy",
                 "where the contact yields first, layers are %.2g of its half width thick", (double)thick);
  else if (outside > BEYOND)
    SamAdviceSay(a, "yield_depth",
                 "the stress exceeds the yield stress by %.0f %% below the last layer, so the results are too elastic: "
                 "omit -yield_depth, which then follows from the grid",
                 100 * (double)outside);
  Unloaded(a);
  if (!(most > 0)) {
    Peak(a, law);
    return;
  }
  if (most > STRAINED)
    SamAdviceSay(a, "", "plastic strain up to %.2g: strains are taken as small, up to about %g", (double)most,
                 STRAINED);
  Coarse(a);
  if (thick <= SAM_PLASTIC_THICK) Begun(a);
  Shallow(a, law, (double)most);
  Sudden(a, (double)most);
  Carried(a);
  if (left < 1 && !(outside > BEYOND))
    SamAdviceSay(a, "yield_depth",
                 "plastic strain comes to the last layer or to the border of the grid: use a larger -yield_depth, "
                 "or -grid_size");
}

PetscErrorCode SamAdviceAddYielding(SamAdvice *a)
{
  PetscReal work, pressure, now, shear;
  SamState  state;
  double    dent;

  PetscFunctionBegin;
  if (!SamProblemGetLaw(a->setup->problem, SAM_LAW_PLASTIC)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamContactGetState(a->setup->contact, &state));
  dent = *SamStateNumbers(state, SamStateFindNumber(state, "residual_z_max"), SAM_COMMITTED);
  if (!(a->yielding.work > 0) && dent > 0) a->yielding.before = dent; /* NaN: no step is committed */
  PetscCall(SamContactGetNumber(a->setup->contact, "residual_z_max", &now));
  PetscCall(SamContactGetNumber(a->setup->contact, "plastic_work", &work));
  PetscCall(SamContactGetNumber(a->setup->contact, "pressure_max", &pressure));
  PetscCall(SamContactGetNumber(a->setup->contact, "shear_max", &shear));
  a->yielding.shear = PetscMax(a->yielding.shear, (double)shear);
  a->yielding.work += (double)work;
  a->yielding.dent     = (double)now;
  a->yielding.pressure = PetscMax(a->yielding.pressure, (double)pressure);
  a->yielding.step     = PetscMax(a->yielding.step, (double)work);
  PetscFunctionReturn(PETSC_SUCCESS);
}
