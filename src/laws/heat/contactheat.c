/*
  The temperatures of a contact by its frictional heat, and friction that depends on them.

  For given slip the heat Q = (b + p dmu(T)) v depends on the temperature T of the contact, b + p dmu being the bound of
  the shear and v the velocity of slip, and T depends linearly on Q: T = T1 + A Q, where A divides the heat between the
  bodies (heatpartition.c). Newton's method for F(T) = T - T1 - A Q(T) = 0:

    (I - A D) d = -F(T),   D = Q'(T) = p dmu'(T) v,   T <- T + d,

  the linear systems by generalised conjugate residuals (heatsteps.c) without a preconditioner, to a tenth of the
  residual, for which A D d is needed to a part of ROUGH only. Where friction falls with temperature, -A D is positive
  and there is one solution; where it rises, A D may reach 1: the temperature then runs away, and no solution is found.
  Plain passes T <- T1 + A Q(T) do not converge where friction falls steeply. Source: Ertz and Knothe 2002, Wear 253,
  498-508, for friction that falls with the temperature.
*/
#include "contactheat.h"
#include "heatimpl.h"
#include <petsam/private/base.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <math.h>

#define PASSES     30   /* most of Newton's method */
#define DIRECTIONS 40   /* most of GCR in a pass */
#define INNER      0.1  /* residual of a linear system relative to that of the pass */
#define ROUGH      1e-3 /* residual of the heat's partition in its operator applications */
#define RTOL       1e-8 /* largest residual relative to the largest rise of temperature */
#define SHORTEST   1e-3 /* shortest part of a step of Newton's method */

double SamHeatFrictionAt(const SamHeatFriction *f, double temperature, double *by_temperature)
{
  const double part = (temperature - (double)f->from) / (double)f->over;

  *by_temperature = part > 0 && part < 1 ? (double)(f->change / f->over) : 0;
  return (double)f->change * PetscMax(0, PetscMin(1, part));
}

PetscErrorCode SamHeatTemperatures(const SamHeatPair *pair, Vec contact, Vec heat, const PetscReal bulk[2], Vec heat_2,
                                   Vec surface[2], char failed[], size_t size)
{
  SamHeatReport report;

  PetscFunctionBegin;
  failed[0] = '\0';
  PetscCall(SamHeatSplit(pair, contact, heat, bulk, heat_2, &report));
  if (report.reason != SAM_HEAT_CONVERGED)
    (void)snprintf(failed, size,
                   "the heat could not be divided between the bodies: residual %.2g after %ld operator "
                   "applications",
                   (double)report.residual, (long)report.products);
  for (int b = 0; b < 2; b++) {
    if (!surface[b]) continue;
    PetscCall(b ? VecCopy(heat_2, surface[b]) : VecWAXPY(surface[b], -1, heat_2, heat));
    PetscCall(SamConductorApply(pair->body[b], surface[b], surface[b]));
    PetscCall(VecShift(surface[b], bulk[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- Newton's method ---- */

/* A solve: the fields on the grid, and the bodies. */
typedef struct {
  const SamHeatPair     *pair;
  SamHeatPair            rough; /* the same with the tolerance ROUGH */
  const SamHeatFriction *friction;
  const SamHeatRate     *rate;
  SamGrid                grid; /* of the fields; borrowed */
  PetscReal              bulk[2];
  PetscInt               products;
  Vec                    heat, heat_2;       /* work */
  SamHeatSystem          system;             /* of a pass */
  Vec                    temperature;        /* of the pass; borrowed */
  Vec                    direction, product; /* of the arrays that steps of the system use */
  char                  *failed;
  size_t                 size;
} Solve;

/* Computes T1_bulk + K1 (heat - q2) in contact, and 0 elsewhere; `bulk`: of both bodies. */
static PetscErrorCode Respond(Solve *s, const SamHeatPair *pair, const PetscReal bulk[2], Vec temperature)
{
  const double *p;
  double       *t;
  Vec           surface[2] = {temperature, NULL};

  PetscFunctionBegin;
  s->products++;
  PetscCall(SamHeatTemperatures(pair, s->rate->pressure, s->heat, bulk, s->heat_2, surface, s->failed, s->size));
  PetscCall(VecGetArrayRead(s->rate->pressure, &p));
  PetscCall(VecGetArray(temperature, &t));
  for (PetscInt k = 0; k < s->grid->cells; k++)
    if (!(p[k] > 0)) t[k] = 0;
  PetscCall(VecRestoreArray(temperature, &t));
  PetscCall(VecRestoreArrayRead(s->rate->pressure, &p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the heat at a temperature; with a `direction`, its change along that. */
static PetscErrorCode FillHeat(Solve *s, Vec temperature, Vec direction)
{
  const Vec     fields[] = {s->rate->pressure, s->rate->bound, s->rate->rate, temperature, direction};
  const double *f[5]     = {NULL};
  double       *heat;

  PetscFunctionBegin;
  for (int n = 0; n < 5; n++)
    if (fields[n]) PetscCall(VecGetArrayRead(fields[n], &f[n]));
  PetscCall(VecGetArrayWrite(s->heat, &heat));
  for (PetscInt k = 0; k < s->grid->cells; k++) {
    double       slope;
    const double change = SamHeatFrictionAt(s->friction, f[3][k], &slope), shear = f[1][k] + f[0][k] * change;

    heat[k] = 0;
    if (!(f[0][k] > 0) || !(shear > 0)) continue;
    heat[k] = f[2][k] * (direction ? f[0][k] * slope * f[4][k] : shear);
  }
  PetscCall(VecRestoreArrayWrite(s->heat, &heat));
  for (int n = 0; n < 5; n++)
    if (fields[n]) PetscCall(VecRestoreArrayRead(fields[n], &f[n]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes -F(T), and its largest absolute value relative to that of the rise of the temperature. */
static PetscErrorCode Residual(Solve *s, Vec temperature, Vec residual, PetscReal *error)
{
  PetscReal most, rise;

  PetscFunctionBegin;
  PetscCall(FillHeat(s, temperature, NULL));
  PetscCall(Respond(s, s->pair, s->bulk, residual));
  PetscCall(VecNorm(residual, NORM_INFINITY, &rise));
  PetscCall(VecAXPY(residual, -1, temperature));
  PetscCall(VecNorm(residual, NORM_INFINITY, &most));
  *error = rise > 0 ? most / rise : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes (I - A D) d at the temperature; nothing more once the heat could not be divided. */
static PetscErrorCode Multiply(void *context, const double d[], double product[])
{
  static const PetscReal none[2] = {0, 0};
  Solve *const           s       = (Solve *)context;

  PetscFunctionBegin;
  PetscCall(VecPlaceArray(s->direction, d));
  PetscCall(VecPlaceArray(s->product, product));
  PetscCall(FillHeat(s, s->temperature, s->direction));
  PetscCall(Respond(s, &s->rough, none, s->product));
  PetscCall(VecAYPX(s->product, -1, s->direction));
  PetscCall(VecResetArray(s->product));
  PetscCall(VecResetArray(s->direction));
  if (s->failed[0]) s->system.most = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the solution of (I - A D) d = residual to `step`. */
static PetscErrorCode SolveLinear(Solve *s, Vec temperature, Vec residual, Vec step)
{
  double *x, *r, left;

  PetscFunctionBegin;
  s->temperature = temperature;
  s->system      = (SamHeatSystem){.grid = s->grid, .context = s, .multiply = Multiply, .most = DIRECTIONS};
  PetscCall(VecGetArray(step, &x));
  PetscCall(VecGetArray(residual, &r));
  PetscCall(SamHeatNorm(s->grid, r, &left));
  PetscCall(SamHeatReduce(&s->system, INNER * left, x, r, &left));
  PetscCall(VecRestoreArray(residual, &r));
  PetscCall(VecRestoreArray(step, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the longest part of a step, halved again and again, that makes the residual smaller. */
static PetscErrorCode Advance(Solve *s, Vec temperature, Vec step, Vec residual, PetscReal *error)
{
  const PetscReal before = *error;
  PetscReal       part   = 1;

  PetscFunctionBegin;
  PetscCall(VecAXPY(temperature, 1, step));
  PetscCall(Residual(s, temperature, residual, error));
  while (!(*error < before) && part > SHORTEST && !s->failed[0]) {
    part /= 2;
    PetscCall(VecAXPY(temperature, -part, step));
    PetscCall(Residual(s, temperature, residual, error));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamHeatSolveFriction(const SamHeatPair *pair, const PetscReal bulk[2], const SamHeatFriction *friction,
                                    const SamHeatRate *rate, Vec temperature, PetscInt *products, char failed[],
                                    size_t size)
{
  Solve     s = {.pair     = pair,
                 .rough    = *pair,
                 .friction = friction,
                 .rate     = rate,
                 .grid     = rate->grid,
                 .bulk     = {bulk[0], bulk[1]},
                 .failed   = failed,
                 .size     = size};
  PetscReal error;
  PetscInt  passes = 0;
  Vec       residual, step;

  PetscFunctionBegin;
  failed[0]    = '\0';
  s.rough.rtol = PetscMax(pair->rtol, ROUGH);
  PetscCall(VecDuplicate(temperature, &s.heat));
  PetscCall(VecDuplicate(temperature, &s.heat_2));
  PetscCall(VecDuplicate(temperature, &s.direction));
  PetscCall(VecDuplicate(temperature, &s.product));
  PetscCall(VecDuplicate(temperature, &residual));
  PetscCall(VecDuplicate(temperature, &step));
  PetscCall(Residual(&s, temperature, residual, &error));
  for (; error > RTOL && passes < PASSES && !failed[0]; passes++) {
    PetscCall(VecSet(step, 0));
    PetscCall(SolveLinear(&s, temperature, residual, step));
    if (!failed[0]) PetscCall(Advance(&s, temperature, step, residual, &error));
  }
  if (!failed[0] && !(error <= RTOL))
    (void)snprintf(failed, size,
                   "the temperature did not converge with the friction in %ld passes, the last residual "
                   "is %.2g: where friction rises with the temperature, this may run away",
                   (long)passes, (double)error);
  *products = s.products;
  PetscCall(VecDestroy(&step));
  PetscCall(VecDestroy(&residual));
  PetscCall(VecDestroy(&s.product));
  PetscCall(VecDestroy(&s.direction));
  PetscCall(VecDestroy(&s.heat_2));
  PetscCall(VecDestroy(&s.heat));
  PetscFunctionReturn(PETSC_SUCCESS);
}
