/* Steps in which contact grows, on the way back: what the motion of cells before they touch depends on
   (contact/step/enteringback.c), and what that adds. */
#include "gradientimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/problem.h>
#include <math.h>

/* Spreads the gaps of the step's entering cells over the part of the grid, 0 elsewhere. */
static PetscErrorCode TakeGaps(const SamBack *b, const SamRecord *r, double gaps[])
{
  double *to;
  Vec     whole;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(SamContactGetGrid(b->g->contact), 1, &whole));
  PetscCall(VecGetArray(whole, &to));
  for (PetscInt m = 0; m < r->entering; m++) to[r->entered[m]] = r->distance[m];
  PetscCall(VecRestoreArray(whole, &to));
  PetscCall(SamBackTake(b, whole, gaps));
  PetscCall(VecDestroy(&whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBackEnter(SamBack *b, PetscInt step, const double lambda[])
{
  const SamRecord *r  = &b->g->record[step];
  const PetscInt   n  = b->grid->cells;
  SamEntering      in = {.approach = &r->approach,
                         .fresh    = r->fresh,
                         .plane    = SamElasticityGetTraits(b->elasticity).plane,
                         .constant = 4 / (PETSC_PI * (double)SamElasticityGetModulus(b->elasticity)),
                         .normal   = {r->fresh ? 0 : r[-1].load[SAM_COMPONENT_N], r->load[SAM_COMPONENT_N]},
                         .grid     = b->grid,
                         .friction = b->friction};
  double          *gaps, *motion;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(n, &gaps, 2 * n, &motion));
  PetscCall(TakeGaps(b, r, gaps));
  for (PetscInt k = 0; k < 2 * n; k++) motion[k] = lambda[k] - b->at.by_slip[k];
  in.gaps   = gaps;
  in.motion = motion;
  PetscCall(SamEnteringGoBack(&in, &b->entered));
  PetscCall(PetscFree2(gaps, motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- what they add ---- */

/* Adds the displacements by a field to an array: normal ones, or tangential ones by the coupling. */
static PetscErrorCode AddDisplacements(SamBack *b, const double values[], PetscBool tangential, double sums[])
{
  const SamGrid  g = b->grid;
  const double  *u;
  double        *to;
  const PetscInt components = tangential ? 2 : 1;
  Vec            field, moved;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(g, 1, &field));
  PetscCall(SamGridCreateVec(g, components, &moved));
  PetscCall(VecGetArrayWrite(field, &to));
  PetscCall(PetscArraycpy(to, values, g->cells));
  PetscCall(VecRestoreArrayWrite(field, &to));
  PetscCall(
    (tangential ? SamElasticityApplyNormalToTangential : SamElasticityApplyNormal)(b->elasticity, field, moved));
  PetscCall(VecGetArrayRead(moved, &u));
  for (PetscInt k = 0; k < components * g->cells; k++) sums[k] += u[k];
  PetscCall(VecRestoreArrayRead(moved, &u));
  PetscCall(VecDestroy(&field));
  PetscCall(VecDestroy(&moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamBackAddOpen(void *back, const double by_gap[], const double by_lift[])
{
  SamBack *const b  = (SamBack *)back;
  SamBackStep   *at = &b->at;
  double         sums[3];

  PetscFunctionBegin;
  PetscCall(SamBackSumMoments(b->grid, by_gap, sums));
  at->by_rigid[SAM_COMPONENT_N] -= sums[0];
  at->by_rigid[SAM_COMPONENT_MY] -= sums[1];
  at->by_rigid[SAM_COMPONENT_MX] += sums[2];
  PetscCall(AddDisplacements(b, by_gap, PETSC_FALSE, at->by_pressure));
  if (b->coupled) PetscCall(AddDisplacements(b, by_lift, PETSC_TRUE, at->by_shear));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamBackAddEntered(SamBack *b)
{
  const SamEntered *e = &b->entered;

  for (PetscInt k = 0; k < b->grid->cells; k++) {
    b->at.by_gap[k] += e->by_gap[k];
    b->at.by_worn[k] += e->by_gap[k];
    b->at.by_friction[k] += e->by_friction[k];
  }
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) b->at.by_load[c] += e->load[SAM_ENTERED_NOW][c];
  for (int k = 0; k < 3; k++) b->strain[k] += e->strain[k];
  for (int k = 0; k < 2; k++) b->kappa[k] = e->kappa[k];
  b->by_modulus = e->by_modulus;
}

PetscErrorCode SamBackLeaveEntered(SamBack *b, PetscInt step)
{
  const SamRecord  *r  = &b->g->record[step];
  const SamEntered *e  = &b->entered;
  SamBackStep      *at = &b->at;

  PetscFunctionBegin;
  if (r->fresh) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    b->by_load_before[c] += e->load[SAM_ENTERED_BEFORE][c];
    b->by_rigid_before[c] += e->rigid[SAM_ENTERED_BEFORE][c];
    if (!r[-1].force[c])
      SamBackAddLoad(b->grid, c, at->area * e->load[SAM_ENTERED_BEFORE][c], at->by_pressure_before,
                     at->by_shear_before);
  }
  for (int k = 0; k < 3; k++) b->strain_before[k] -= e->strain[k];
  PetscCall(PetscArraycpy(b->at.by_open, e->by_gap, b->grid->cells));
  PetscCall(AddDisplacements(b, e->by_gap, PETSC_FALSE, at->by_pressure_before));
  PetscFunctionReturn(PETSC_SUCCESS);
}
