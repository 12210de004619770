/*
  Doubts of bodies that yield: plastic strain that the cells, the layers or the steps do not resolve.

  Plastic strain follows from the stress at the end of a step (backward Euler), so that its error falls like the length
  of the steps in which most of it arises. Let w be the largest part of all plastic work that one step did, and s the
  maximum plastic strain times E* over the peak pressure. Then the peak pressure is too high by SUDDEN s w within a
  factor of 2, the energy of the residual stress by up to STORED times that, the plastic work by less. On 55 random
  cylinders and balls, pressed to 1.1 to 2.2 times the first yield, unloaded and fretted in 1 to 4 steps a row, compared
  with finer cells and steps, the peak pressure was wrong by 0.1 to 1.8 times SUDDEN s w, the energy by up to 1.6 times.
*/
#include "plasticimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/examination.h>
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

/*
  Numbers kept of the steps: the plastic work of all, and of that which did most of it (J); the maximum pressure of any,
  and maximum shear, also at the edge of stick between cells (Pa); residual_z_max after the last, and before the first:
  of a restart, or of a copied contact (m)
*/
enum { WORK, MOST_WORK, PRESSURE, SHEAR, DENT, BEFORE };

/* Returns E* of the stiffest materials of both bodies, Pa. */
static double StiffnessOf(const SamExamination *x)
{
  return SamPairStiffest(SamElasticityGetPair(x->elasticity));
}

/* Doubts plastic strain below a contact of few cells. */
static void Coarse(SamExamination *x)
{
  const double across = (double)x->extent->across;

  /* The number of cells includes those in which the contact ends, so it is up to one too large. */
  if (!x->extent->whole && x->extent->zones)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, COARSE / (across * across),
                 SAM_MARGIN * sqrt(COARSE / SAM_DOUBT_LARGE) / PetscMax(across - 1, 1), STRAIN, SAM_ACROSS, "", across,
                 across == 1 ? "" : "s");
}

/*
  Doubts plastic strain below a narrow slip zone, whose shear is not resolved: there it may be larger than the found
  maximum. `part`: plastic strain at the surface, relative to that maximum.
*/
static void Narrow(SamExamination *x, double part)
{
  const double width = x->slip->energy > 0 ? (double)x->slip->narrow[0] : 0;

  if (part > NEAR && width > 0 && width < UNSEEN)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, 1, 2 * UNSEEN / width, "plastic_max",
                 "plastic strain is largest below slip zones of %.2g cells", width);
}

/*
  True if plastic strain is larger than elastic strain, and the body hardens no more. Then nothing keeps the shear at
  the surface from becoming a line along which a part of the body slides: the finer the layers, the larger the strain.
*/
static PetscErrorCode Concentrates(const SamExamination *x, SamLaw law, double most, PetscBool *does)
{
  PetscReal flow, more;

  PetscFunctionBegin;
  PetscCall(SamPlasticGetFlow(law, (PetscReal)most, &flow));
  PetscCall(SamPlasticGetFlow(law, (PetscReal)(2 * most), &more));
  *does = most * StiffnessOf(x) > flow && more < (1 + SHALLOW) * flow ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Doubts plastic strain that is largest at the surface and decays within the first layers, as under friction. Much
  of it shears the surface, on which the slip depends.
*/
static PetscErrorCode Shallow(SamExamination *x, SamLaw law, double most)
{
  static const char why[] = "plastic strain is largest at the surface, and falls within the first layers";
  PetscReal         surface;
  double            error;
  PetscBool         line = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(x->contact, "plastic_surface", &surface));
  error = 1 - most / (double)surface;
  if (!(error > SHALLOW)) {
    Narrow(x, (double)surface / most);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (error > DEEP) PetscCall(Concentrates(x, law, most, &line));
  SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, error, line ? 0 : FALLS * error / SAM_DOUBT_LARGE, "plastic_max", "%s%s",
               why, line ? ", and no grid bounds plastic_max since the body hardly hardens: give its hardening" : "");
  if (x->slip->energy > 0 && error > DEEP)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, SLIPS * error, line ? 0 : FALLS * SLIPS * error / SAM_DOUBT_LARGE,
                 "plastic_work dissipated_energy stick_area slip_max", "%s", why);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Doubts plastic strain that has just begun, in few layers. The error of its maximum, its work and the dent was 1.4
  over the square of the number of layers, within a third: cylinders and spheres 4 to 100 % above the first yield, with
  2 to 16 layers, compared with twice as fine cells and layers.
*/
static PetscErrorCode Begun(SamExamination *x)
{
  PetscReal layers;
  double    error;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(x->contact, "yielded_layers", &layers));
  if (!(layers > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  error = PetscMin(BEGUN / (double)(layers * layers), MOST_BEGUN);
  SamDoubtsAdd(x->doubts, SAM_CAUSE_LAYERS, error, sqrt(error / SAM_DOUBT_LARGE), STRAIN,
               "plastic strain has just begun, in %.0f layers", (double)layers);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Doubts plastic strain of which much arises in one step. */
static void Sudden(SamExamination *x, double strain)
{
  const double full  = SamGridIsRow(x->grid) ? SUDDEN_PLANE : SUDDEN;
  const double scale = strain * StiffnessOf(x) / x->kept[PRESSURE];
  /* The work before these steps is unknown; these steps did that part of all by which the dent has grown. */
  const double these = x->kept[BEFORE] > 0 ? 1 - x->kept[BEFORE] / x->kept[DENT] : 1;
  const double part  = x->kept[WORK] > 0 ? these * x->kept[MOST_WORK] / x->kept[WORK] : 0;
  const double error = full * scale * part;

  const struct {
    double      error;
    const char *names;
  } of[] = {{error, "pressure_max plastic_work"},
            {STORED * error, "residual_energy"},
            {error / 2, "contact_area plastic_max residual_z_max"}};

  for (size_t k = 0; k < sizeof(of) / sizeof(of[0]); k++) /* NaN: none of these steps has a contact */
    SamDoubtsAdd(x->doubts, SAM_CAUSE_STEPS, of[k].error, FALLS * of[k].error / SAM_DOUBT_LARGE, of[k].names,
                 "%.0f %% of the plastic work is done in one step", 100 * part);
}

/* Doubts the shear by plastic strain alone, without a tangential load, if its slip zone is narrower than a cell. */
static PetscErrorCode Carried(SamExamination *x)
{
  PetscReal pressure, shear;
  PetscBool rubs;

  PetscFunctionBegin;
  PetscCall(SamProblemHasFriction(SamContactGetProblem(x->contact), &rubs));
  PetscCall(SamContactGetNumber(x->contact, "pressure_max", &pressure));
  PetscCall(SamContactGetNumber(x->contact, "shear_max", &shear));
  if (!rubs || x->slip->work > 0 || x->slip->widest > 0 || !(shear > CARRIED * pressure))
    PetscFunctionReturn(PETSC_SUCCESS);
  SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, 1, FINER, "slip_max shear_max dissipated_energy stick_area",
               "plastic strain moves the surfaces along each other, and slips only within a cell of the edge");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Doubts bodies that would yield at the surface, at a peak of the shear between cells, but not on these cells. */
static void Peak(SamExamination *x, SamLaw law)
{
  const double least = (double)SamPlasticGetYieldStress(law) / sqrt(3);

  if (x->kept[SHEAR] > least)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, 1, BETWEEN, STRAIN " residual_energy",
                 "shear at the edge of stick, %.3g Pa, is above the yield stress over sqrt(3), but no cell yields",
                 x->kept[SHEAR]);
}

/* Doubts plastic strain that is large, spans few layers, or reaches the end of the layers. */
PetscErrorCode SamPlasticDoubt(SamLaw law, SamExamination *x)
{
  PetscReal most, left, thick, outside;

  PetscFunctionBegin;
  PetscCall(SamContactGetNumber(x->contact, "plastic_max", &most));
  PetscCall(SamContactGetNumber(x->contact, "yield_margin", &left));
  PetscCall(SamContactGetNumber(x->contact, "layer_thickness", &thick));
  PetscCall(SamContactGetNumber(x->contact, "yield_outside", &outside));
  if (thick > SAM_PLASTIC_THICK && (most > 0 || outside > BEYOND))
    SamDoubtsAdd(x->doubts, SAM_CAUSE_LAYERS, SAM_DOUBT_LARGE * (double)thick / SAM_PLASTIC_THICK,
                 (double)thick / SAM_PLASTIC_THICK, STRAIN " residual_energy",
                 "where the contact yields first, layers are %.2g of its half width thick", (double)thick);
  else if (outside > BEYOND)
    PetscCall(SamExaminationSay(
      x, "yield_depth",
      "the stress exceeds the yield stress by %.0f %% below the last layer, so the results are too elastic: "
      "omit -yield_depth, which then follows from the grid",
      100 * (double)outside));
  if (!(most > 0)) {
    Peak(x, law);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (most > STRAINED)
    PetscCall(SamExaminationSay(x, "", "plastic strain up to %.2g: strains are taken as small, up to about %g",
                                (double)most, STRAINED));
  Coarse(x);
  if (thick <= SAM_PLASTIC_THICK) PetscCall(Begun(x));
  PetscCall(Shallow(x, law, (double)most));
  Sudden(x, (double)most);
  PetscCall(Carried(x));
  if (left < 1 && !(outside > BEYOND))
    PetscCall(SamExaminationSay(
      x, "yield_depth",
      "plastic strain comes to the last layer or to the border of the grid: use a larger -yield_depth, "
      "or -grid_size"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamPlasticExamine(SamLaw law, SamExamination *x)
{
  PetscReal work, pressure, now, shear;
  SamState  state;
  double    dent;

  PetscFunctionBegin;
  (void)law;
  PetscCall(SamContactGetState(x->contact, &state));
  dent = *SamStateNumbers(state, SamStateFindNumber(state, "residual_z_max"), SAM_COMMITTED);
  if (!(x->kept[WORK] > 0) && dent > 0) x->kept[BEFORE] = dent; /* NaN: no step is committed */
  PetscCall(SamContactGetNumber(x->contact, "residual_z_max", &now));
  PetscCall(SamContactGetNumber(x->contact, "plastic_work", &work));
  PetscCall(SamContactGetNumber(x->contact, "pressure_max", &pressure));
  PetscCall(SamContactGetNumber(x->contact, "shear_max", &shear));
  x->kept[SHEAR] = PetscMax(x->kept[SHEAR], (double)shear);
  x->kept[WORK] += (double)work;
  x->kept[DENT]      = (double)now;
  x->kept[PRESSURE]  = PetscMax(x->kept[PRESSURE], (double)pressure);
  x->kept[MOST_WORK] = PetscMax(x->kept[MOST_WORK], (double)work);
  PetscFunctionReturn(PETSC_SUCCESS);
}
