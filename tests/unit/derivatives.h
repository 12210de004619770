/* The tangent stiffness of a contact, compared with differences of trials. All functions are collective. */
#ifndef PETSAM_DERIVATIVES_H
#define PETSAM_DERIVATIVES_H

#include "contacts.h"

#include <petsam/stiffness.h>

/* The components by short names; N stands alone in Sphere. */
enum { Z, TX, TY, MX, MY, MZ };

static inline SamStiffness Stiffness(const Case *c, SamStiffnessDirection direction)
{
  SamStiffness k;

  sam_call(SamStiffnessCompute(c->contact, direction, 0, NULL, &k));
  return k;
}

/* Entries count in units of a, so that forces and moments can be compared. */
static inline double Unit(const Case *c, PetscInt i)
{
  return i < SAM_COMPONENT_MX ? 1 : c->s.a;
}

/* The largest error of the columns against differences of trials, as a part of the largest entry. */
static inline double ErrorOf(const Case *c, const SamStiffness *k, const PetscReal rigid[], double by)
{
  const double size  = by * c->s.a * c->s.a / c->s.R;
  double       error = 0, most = 0;
  SamControl   control;
  SamStep      base;

  sam_call(SamControlInitialize(&control));
  for (PetscInt i = 0; i < SAM_COMPONENTS; i++) Displace(&control, (SamComponent)i, rigid[i]);
  base = Try(c, &control);
  for (PetscInt j = 0; j < SAM_COMPONENTS; j++) {
    SamControl    moved = control;
    const double  step  = size / Unit(c, j);
    const SamStep other = (moved.value[j] += step, Try(c, &moved));

    for (PetscInt i = 0; i < SAM_COMPONENTS; i++) {
      const double unit = Unit(c, i) * Unit(c, j), difference = (other.load[i] - base.load[i]) / step / unit,
                   entry = k->k[i][j] / unit;

      error = fmax(error, fabs(difference - entry));
      most  = fmax(most, fabs(entry));
    }
  }
  return error / most;
}

#endif
