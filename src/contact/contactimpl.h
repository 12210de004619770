/* The inside of SamContact. */
#ifndef PETSAM_CONTACTIMPL_H
#define PETSAM_CONTACTIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/contact.h>

struct _n_SamContact {
  /* what the user set */
  PetscReal friction, coupling_rtol;
  PetscInt  coupling, coupling_max_it;
  PetscBool warm, last_step;
  PetscBool coupling_monitor, allow_edge, print_check;
  /* what it owns */
  SamElasticity elasticity;
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

/*
  SamContactDestroyDerived - frees the fields that follow from the tractions; with `same_pressure` displacement_z
  stays. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactDestroyDerived(SamContact contact, PetscBool same_pressure);
/* SamContactCheckStep - makes them for the step, whose check fills step->check; see SamContactCheck. Collective. */
PETSC_INTERN PetscErrorCode SamContactCheckStep(SamContact contact, PetscBool same_pressure, Vec slip_before,
                                                const SamBalance *given_normal, const SamBalance *given_tangential,
                                                SamStep *step);
/*
  The two halves of SamContactCheck: elastic displacements from the tractions (`release`: each kernel is freed after its
  last product); gap, slip and what they show. Collective.
*/
PETSC_INTERN PetscErrorCode SamCheckDisplacements(SamElasticity elasticity, PetscBool coupling, PetscBool same_pressure,
                                                  PetscBool release, SamFields *fields);
PETSC_INTERN PetscErrorCode SamCheckFields(SamElasticity elasticity, PetscReal friction, Vec separation,
                                           Vec slip_before, const SamBalance *given_normal,
                                           const SamBalance *given_tangential, const SamStep *step, SamFields *fields,
                                           SamCheck *check);

/*
  SamContactStepBack - after a step without equilibrium: the fields are again those of the last step that had a
  solution, whose normal control and its outcome are given; the next one goes on from there. Without such a step there
  are no fields. Collective.
*/
PETSC_INTERN PetscErrorCode SamContactStepBack(SamContact contact, const SamBalance *given, const SamBalance *found,
                                               PetscBool same_pressure);

/*
  SamExtrapolate - replaces pressure and shear of a step by a prediction of the next one, alpha times as far on as it is
  from the step before, whose tractions are given in the next two arguments and replaced by the step's own. `found` is
  false, and the step's tractions stay, where the prediction is that contact is lost. Collective.
*/
PETSC_INTERN PetscErrorCode SamExtrapolate(SamGrid grid, PetscReal friction, PetscReal alpha, Vec pressure, Vec shear,
                                           Vec pressure_before, Vec shear_before, PetscBool *found);

/* SamFollowBound - scales a shear that belonged to one pressure to another: what slips goes on slipping. */
PETSC_INTERN PetscErrorCode SamFollowBound(SamGrid grid, Vec pressure_before, Vec pressure, Vec shear);

#endif
