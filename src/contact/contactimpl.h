/* The inside of SamContact. */
#ifndef PETSAM_CONTACTIMPL_H
#define PETSAM_CONTACTIMPL_H

#include "../base/baseimpl.h"
#include <petsam/contact.h>

struct _n_SamContact {
  /* what the user set */
  PetscReal friction, coupling_rtol;
  PetscInt  coupling, coupling_max_it;
  PetscBool warm;
  PetscBool coupling_monitor, allow_edge, print_check;
  /* what it owns */
  SamCompliance compliance;
  SamGrid       grid;
  SamNormal     normal;
  SamTangential tangential;
  Vec           separation;
  Vec           slip_before; /* at the end of the step before; NULL: zero */
  Vec           h;           /* separation and u_z from q; NULL when not coupled */
  Vec           last[2];     /* p and q of the pass before; NULL when not coupled */
  SamFields     fields;
  /* status */
  PetscBool  coupled;
  PetscInt   steps;                      /* solved so far */
  SamBalance normal_given, normal_found; /* of the last normal solve */
  double     values[2][6];               /* what was controlled in the last step and in the one before */
  double     rigid[2][3];                /* tangential rigid displacements then */
  double     start[3];                   /* and where they start now */
  Vec        previous[2];                /* p and q of the step before the last; NULL until there are two */
};

/* SamContactCreateDerived - room for the fields that follow from the tractions. SamContactDestroyDerived - frees it; with `same_pressure` displacement_z stays. Collective. */
PETSC_INTERN PetscErrorCode SamContactCreateDerived(SamContact contact);
PETSC_INTERN PetscErrorCode SamContactDestroyDerived(SamContact contact, PetscBool same_pressure);

/*
  SamContactStepBack - after a step without equilibrium: the fields are again those of the last step that had a solution, whose
  normal control and its outcome are given; the next one goes on from there. Without such a step there are no fields. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactStepBack(SamContact contact, const SamBalance *given, const SamBalance *found, PetscBool same_pressure);

/*
  SamExtrapolate - replaces pressure and shear of a step by a prediction of the next one, alpha times as far on as it is from
  the step before, whose tractions are given in the next two arguments and replaced by the step's own. `found` is false, and
  the step's tractions stay, where the prediction is that contact is lost. Collective.
*/
PETSC_INTERN PetscErrorCode SamExtrapolate(SamGrid grid, PetscReal friction, PetscReal alpha, Vec pressure, Vec shear, Vec pressure_before, Vec shear_before, PetscBool *found);

/* SamFollowBound - scales a shear that belonged to one pressure to another: what slips goes on slipping. */
PETSC_INTERN PetscErrorCode SamFollowBound(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear);

#endif
