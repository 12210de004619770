/*
  The creep that belongs to a relaxation, both as sums of exponentials.

  With s times its Laplace transform a modulus becomes G(s) = g_0 + sum g_k s tau_k/(1 + s tau_k), g_0 = 1 - sum g_k,
  and the creep is 1/G(s). Its poles s = -1/theta are where

      F(theta) = g_0 + sum g_k tau_k/(tau_k - theta) = 0,

  one root above each of the sorted tau_k, below the next one or, of the last, below tau_n + sum g_k tau_k/g_0. F rises
  between its poles. Its part is a = 1/(theta sum g_k tau_k/(theta - tau_k)^2), by the residue. The unknown is theta -
  tau_k, as parts that are small leave the root close to its pole.
  Source: B. Gross, Mathematical Structure of the Theories of Viscoelasticity (1953).
*/
#include "viscous.h"
#include <math.h>

#define HALVINGS 200 /* most of them; 1100 halvings reach any number, and roots are far closer */

/* Sorts the parts by their times, and joins equal times; returns their number. */
static PetscInt Sort(PetscInt count, const PetscReal parts[], const PetscReal times[], double g[], double tau[])
{
  PetscInt n = 0;

  for (PetscInt k = 0; k < count; k++) {
    PetscInt at = n;

    while (at > 0 && tau[at - 1] >= (double)times[k]) at--;
    if (at < n && tau[at] == (double)times[k]) {
      g[at] += (double)parts[k];
      continue;
    }
    for (PetscInt m = n; m > at; m--) {
      g[m]   = g[m - 1];
      tau[m] = tau[m - 1];
    }
    g[at]   = (double)parts[k];
    tau[at] = (double)times[k];
    n++;
  }
  return n;
}

/* Returns F at tau_k + d. */
static double Residual(PetscInt n, const double g[], const double tau[], double rest, PetscInt k, double d)
{
  double sum = rest;

  for (PetscInt m = 0; m < n; m++) sum += g[m] * tau[m] / (tau[m] - tau[k] - d);
  return sum;
}

/* Returns the distance of the root above tau_k, by halving in the logarithm where it is small. */
static double FindRoot(PetscInt n, const double g[], const double tau[], double rest, PetscInt k)
{
  double high = 0, low;

  for (PetscInt m = 0; m < n; m++) high += g[m] * tau[m] / rest;
  if (k + 1 < n) high = tau[k + 1] - tau[k];
  low = 0;
  for (int turn = 0; turn < HALVINGS; turn++) {
    const double middle = low > 0 ? (high > 4 * low ? sqrt(low * high) : 0.5 * (low + high)) : 1e-3 * high;

    if (middle <= low || middle >= high) break;
    if (Residual(n, g, tau, rest, k, middle) < 0)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

void SamCreepFromRelaxation(PetscInt count, const PetscReal parts[], const PetscReal times[], SamCreep *creep)
{
  double         g[SAM_CREEP_TERMS], tau[SAM_CREEP_TERMS], rest = 1;
  const PetscInt n = Sort(count, parts, times, g, tau);

  for (PetscInt k = 0; k < n; k++) rest -= g[k];
  creep->count = n;
  for (PetscInt k = 0; k < n; k++) {
    const double d = FindRoot(n, g, tau, rest, k), theta = tau[k] + d;
    double       sum = 0;

    for (PetscInt m = 0; m < n; m++) {
      const double apart = m == k ? d : tau[k] - tau[m] + d;

      sum += g[m] * tau[m] / (apart * apart);
    }
    creep->time[k] = theta;
    creep->part[k] = 1 / (theta * sum);
  }
}
