/*
  Doubts of bodies that relax: of the energy that they dissipate, where steps are long beside the times in which they
  relax, and of rolling in steps, where what they remember leaves the grid.

  The part that leaves the grid behind the contact no longer displaces. The moment of the pressure on cylinders and
  balls that roll until their state is steady, with creeps of 0.5 to 2 widths of the contact and grids that end 0.8 to 5
  of them behind it, was wrong by 0.14 to 0.31 (cylinders) and 0.03 to 0.16 (balls) of the part that the tractions which
  terms follow have at the border of the grid, of the largest.
*/
#include "viscous.h"
#include <petsam/private/examination.h>
#include <petsam/private/state.h>
#include <math.h>
#include <stdio.h>

#define LOST_IN_PLANE 0.3  /* error of the moment over that part */
#define LOST          0.12 /* likewise of contacts of all shapes */

enum { ENERGY, ERROR, BORDER }; /* sums over the steps, kept from step to step; the largest part at the border */

/* Finds the largest tractions of a field at the borders of the grid, and in all cells. */
static PetscErrorCode FindBorder(SamGrid grid, Vec field, double most[2])
{
  const double *c;

  PetscFunctionBegin;
  most[0] = most[1] = 0;
  PetscCall(VecGetArrayRead(field, &c));
  for (PetscInt j = 0; j < grid->rows; j++) {
    const PetscInt  row   = grid->row_start + j;
    const PetscBool whole = !SamGridIsRow(grid) && (row == 0 || row == grid->ny - 1) ? PETSC_TRUE : PETSC_FALSE;

    for (PetscInt i = 0; i < grid->nx; i++) {
      const double value = fabs(c[(ptrdiff_t)j * grid->nx + i]);

      most[1] = PetscMax(most[1], value);
      if (whole || i == 0 || i == grid->nx - 1) most[0] = PetscMax(most[0], value);
    }
  }
  PetscCall(VecRestoreArrayRead(field, &c));
  PetscCall(SamMax(grid->comm, 2, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the part of the largest creep by pressure, if it creeps to its end, that is at the border of the grid. */
static PetscErrorCode FindPart(SamElasticity e, SamState state, double *part)
{
  const SamViscous *v     = (const SamViscous *)e->data;
  double            at[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt j = 0; j < v->terms; j++) {
    const Vec field = SamStateReadField(state, SamStateFindField(state, SamViscousFieldName(0, j)));
    double    most[2];

    if (!field) continue;
    PetscCall(FindBorder(e->grid, field, most));
    for (int k = 0; k < 2; k++) at[k] = PetscMax(at[k], v->term[j].value[0] * most[k]);
  }
  *part = at[1] > 0 ? at[0] / at[1] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousExamine(SamElasticity e, SamExamination *x)
{
  double part = 0;

  PetscFunctionBegin;
  x->kept[ENERGY] += *SamStateReadNumbers(x->state, SamStateFindNumber(x->state, SAM_VISCOUS_ENERGY));
  x->kept[ERROR] += fabs(*SamStateReadNumbers(x->state, SamStateFindNumber(x->state, SAM_VISCOUS_ERROR)));
  if (e->traits.periodic) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindPart(e, x->state, &part));
  x->kept[BORDER] = PetscMax(x->kept[BORDER], part);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamViscousDoubt(SamElasticity e, SamExamination *x)
{
  const double error = x->kept[ENERGY] > 0 ? x->kept[ERROR] / x->kept[ENERGY] : 0,
               lost  = (e->traits.plane ? LOST_IN_PLANE : LOST) * x->kept[BORDER];
  char text[256];

  PetscFunctionBegin;
  SamDoubtsAdd(x->doubts, SAM_CAUSE_STEPS, error, sqrt(PetscMax(1, error / SAM_DOUBT_LARGE)), SAM_VISCOUS_ENERGY,
               "steps are long beside the times in which bodies relax");
  if (!(lost > SAM_DOUBT_LARGE)) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(text, sizeof(text),
                 "what the bodies remember leaves the grid, at whose border it still is %.2g of its maximum: load_my, "
                 "rot_y and " SAM_VISCOUS_ENERGY
                 " of rolling are about %.0f %% off: use a grid that reaches farther behind the contact",
                 x->kept[BORDER], 100 * lost);
  PetscCall((*x->tell)(x->context, text, "grid_size"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
