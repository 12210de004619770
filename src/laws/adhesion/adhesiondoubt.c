/*
  Doubts of adhesion: the edge of the tension that the cells do not resolve, and tension that leaves the grid.

  Between the edge of contact and that of the tension lies a zone whose least width is about the cohesive length
  E* w/s_0^2. If it has m cells, numbers are wrong by up to RESOLVED/m. The largest error of the force on Maugis' curve,
  over the pull-off force, was 6.4 % at m = 4.4, 4.0 % at 6.5, 1.1 % at 8.7, 0.3 % at 17 (lambda 1), 0.8 % at 17 and
  0.4 % at 26 (lambda 0.5), 1.8 % at 2.3 (lambda 5).
*/
#include "adhesion.h"
#include <petsam/private/body.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/examination.h>
#include <petsam/private/state.h>
#include <math.h>

#define RESOLVED 0.25
#define LEAST    2    /* cells below which the edge stays where it is, so that nothing is known */
#define BORDER   1e-3 /* tension at the border of the grid over the largest one */
/* Numbers of the normal problem, besides N or the approach, whichever is found */
#define TOLD "contact_area adhesive_area pressure_max pull_max attraction_energy"

/* Returns the cohesive length (m), and the number of cells in it. */
static double CohesiveLength(SamLaw law, double *cells)
{
  const SamAdhesion *a      = (const SamAdhesion *)law->data;
  const SamGrid      grid   = law->grid;
  const double       young  = (double)SamElasticityGetModulus(law->elasticity);
  const double       length = young * SamAdhesionRange(a) / (double)a->stress;

  *cells = length / (double)(grid->axes > 1 ? PetscMax(grid->dx, grid->dy) : grid->dx);
  return length;
}

PetscErrorCode SamAdhesionWarn(SamLaw law)
{
  const SamGrid grid = law->grid;
  PetscMPIInt   rank;
  double        cells;
  const double  length = CohesiveLength(law, &cells);

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (cells < LEAST && rank == 0 && !grid->fine)
    SamPrintMessage(
      "petsam",
      "warning: the edge of the tension, E* w/s^2 = %.3g m, is %.2g cells wide: below %d it stays where it "
      "is, or the tension does not converge: use a smaller -adhesion_stress, or -grid_n %.0f",
      length, cells, (int)LEAST, ceil(LEAST / cells * (double)PetscMax(grid->nx, grid->ny)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAdhesionDoubt(SamLaw law, SamExamination *x)
{
  double             cells, border;
  const double       length = CohesiveLength(law, &cells);
  const SamSolution *s;
  const char        *told;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(x->contact, &s));
  told = s->control.force[SAM_COMPONENT_N] ? "disp_z " TOLD : "load_n " TOLD;
  SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, cells < LEAST ? 1 : RESOLVED / cells,
               PetscMax(LEAST, RESOLVED / SAM_DOUBT_LARGE) / cells, told,
               "the edge of the tension, E* w/s^2 = %.3g m, is %.2g cells wide", length, cells);
  PetscCall(SamContactGetNumber(x->contact, "adhesion_border", &border));
  if (border > BORDER)
    SamDoubtsAdd(x->doubts, SAM_CAUSE_CELLS, border, 0, told,
                 "the tension at the border of the grid is %.2g of its maximum: take a larger grid", border);
  PetscFunctionReturn(PETSC_SUCCESS);
}
