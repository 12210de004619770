/*
  Estimates of the error of a number from its values on other grids and with other steps.

  Cells: numbers wander on neighbouring grids, as edges pass centres of cells, so that the difference to half the cells
  is often too small by luck. The estimate is the larger one of two differences, of which the second is that of the two
  coarser grids, divided by 2: an error of first order. Of 445 numbers of 80 random problems (kinds usual and slide of
  tests/program/random_problems.py, seeds from 97001 and 97201) this covers 87 % of the errors; the first difference
  alone covers 74 %, and with a third of it for numbers of second order 83 %. Richardson's extrapolation is worse than
  the difference alone, since these numbers have no order on such grids.

  Steps: the difference between two runs on the same coarse cells, one of which has half as many steps, or twice as
  many.
*/
#include <petsam/private/errors.h>
#include <math.h>

double SamErrorByCells(double own, const double run[SAM_RUNS])
{
  const double near = fabs(own - run[SAM_RUN_HALF]), far = fabs(run[SAM_RUN_HALF] - run[SAM_RUN_QUARTER]);

  return far > 2 * near ? far / 2 : near;
}

double SamErrorBySteps(const double run[SAM_RUNS], SamRunKind same)
{
  return fabs(run[same] - run[SAM_RUN_OTHER]);
}
