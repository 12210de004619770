/*
  Errors of numbers by the finite elements of bodies' compliances: their displacements miss a known part of what the
  body is displaced beyond the half-space (compliance.c). Where the displacement is given, the load is that of a larger
  one: it grows with its power 1.5 in Hertz's contact, and with its square at most, in that of a thin layer on a rigid
  base. Area and peak pressure grow less than the load, and the energy of slip as the third power of the shear force at
  most. Half of the load's work by that part of the displacement is stored, of at least a third of the load times the
  displacement, as that of such a layer.
*/
#include "adviceimpl.h"
#include <petsam/private/compliance.h>
#include <petsam/private/control.h>
#include <petsam/private/contact.h>
#include <petsam/private/state.h>
#include <math.h>

void SamAdviceMeshes(SamAdvice *a)
{
  static const char     why[]       = "the finite elements of -body1_compliance, -body2_compliance";
  static const PetscInt component[] = {SAM_COMPONENT_TX, SAM_COMPONENT_TY, SAM_COMPONENT_N};

  for (int k = 0; k < 3 && !a->error; k++) {
    const PetscInt c     = component[k];
    const double   moved = fabs((double)a->step->rigid[c]);
    SamState       state;
    PetscInt       id;
    double         error, load;

    a->error = SamContactGetState(a->setup->contact, &state);
    id       = a->error ? -1 : SamStateFindNumber(state, SamComplianceMesh[k]);
    if (id < 0 || !(moved > 0)) continue;
    error = *SamStateReadNumbers(state, id) / moved;
    load  = k == 2 ? pow(1 + error, 2) - 1 : error;
    if (k == 2) SamDoubtsAdd(&a->doubts, SAM_CAUSE_MESH, (1. / 2) / (1. / 3) * error, 0, "stored_energy", why);
    if (a->step->control.force[c]) {
      SamDoubtsAdd(&a->doubts, SAM_CAUSE_MESH, error, 0, SamComponentNameOf(c, SAM_BY_RIGID), why);
    } else {
      SamDoubtsAdd(&a->doubts, SAM_CAUSE_MESH, load, 0, SamComponentNameOf(c, SAM_BY_LOAD), why);
      SamDoubtsAdd(&a->doubts, SAM_CAUSE_MESH, k == 2 ? load : pow(1 + error, 3) - 1, 0,
                   k == 2 ? "contact_area pressure_max" : "dissipated_energy slip_max", why);
    }
  }
}
