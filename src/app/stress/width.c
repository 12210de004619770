/*
  The half width of a contact, in which depths are given: the smaller half axis of the ellipse that has the area of the
  contact, to a part of a cell, and the axes' ratio of the second moments of its cells; of a plane contact half its
  length. It is that of the chosen step with the largest area.
*/
#include "stressrun.h"
#include <petsam/private/baseimpl.h>
#include <math.h>

/* The second moments' ratio of axes, at most 1, of the cells in contact. */
static PetscErrorCode RatioOfAxes(SamStressRun *run, PetscInt saved, double *ratio)
{
  const SamGrid g = run->grid;
  double       *pressure, sum[6] = {0}, middle[2], xx, xy, yy, deviation;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->cells + 1, &pressure));
  PetscCall(SamResultsRead(run->results, saved, SAM_RESULTS_PRESSURE, pressure));
  for (PetscInt k = 0; k < g->cells; k++) { /* whole numbers, so sums are the same on any number of ranks */
    const double i = (double)(k % g->nx - g->nx / 2), j = (double)(g->row_start + k / g->nx - g->ny / 2);
    const double part[6] = {1, i, j, i * i, i * j, j * j};

    for (int m = 0; m < 6 && pressure[k] > 0; m++) sum[m] += part[m];
  }
  PetscCall(PetscFree(pressure));
  PetscCall(SamSum(g->comm, 6, sum));
  for (int m = 0; m < 2; m++) middle[m] = sum[1 + m] / sum[0];
  xx        = (sum[3] / sum[0] - middle[0] * middle[0] + 1. / 12) * (double)(g->dx * g->dx);
  xy        = (sum[4] / sum[0] - middle[0] * middle[1]) * (double)(g->dx * g->dy);
  yy        = (sum[5] / sum[0] - middle[1] * middle[1] + 1. / 12) * (double)(g->dy * g->dy);
  deviation = hypot(0.5 * (xx - yy), xy);
  *ratio    = sqrt((0.5 * (xx + yy) - deviation) / (0.5 * (xx + yy) + deviation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStressRunHalfWidth(SamStressRun *run)
{
  PetscInt  step, most = 0;
  PetscBool needs;
  double    area = 0, ratio = 1, half;

  PetscFunctionBegin;
  PetscCall(SamEvaluationNeedsHalfWidth(run->evaluation, &needs));
  if (!needs) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < run->steps; k++) {
    double now;

    PetscCall(SamResultsGetSaved(run->results, run->saved[k], &step, NULL));
    PetscCall(SamResultsReadNumber(run->results, step, SAM_RESULTS_CONTACT_AREA, &now));
    if (now > area) most = k, area = now;
  }
  PetscCheck(area > 0, run->grid->comm, SAM_ERR_USER,
             "-depths: a is the half width of the contact, and no chosen step of %s has a contact area: give depths "
             "in m, or other -steps",
             run->request.input);
  PetscCall(SamResultsGetSaved(run->results, run->saved[most], &step, NULL));
  if (run->grid->axes == 1) {
    half = 0.5 * area;
  } else {
    PetscCall(RatioOfAxes(run, run->saved[most], &ratio));
    half = sqrt(area / PETSC_PI * ratio);
  }
  PetscCall(SamEvaluationSetHalfWidth(run->evaluation, (PetscReal)half));
  if (!run->quiet)
    PetscCall(PetscPrintf(run->grid->comm,
                          "a = %.6g m, the half width (smaller half axis) of the contact of step %ld\n", half,
                          (long)step));
  PetscFunctionReturn(PETSC_SUCCESS);
}
