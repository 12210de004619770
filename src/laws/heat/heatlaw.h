/* The inside of the law of heat. */
#ifndef PETSAM_HEATLAW_H
#define PETSAM_HEATLAW_H

#include "contactheat.h"
#include "expansion.h"
#include <petsam/private/lawimpl.h>
#include <petsam/private/mixing.h>

/* A change of friction or wear by temperature, as the user gives it: T0, dT, and the change, or the factor. */
enum { SAM_HEAT_FROM, SAM_HEAT_OVER, SAM_HEAT_CHANGE, SAM_HEAT_CHANGES };

typedef struct {
  int         kind;
  PetscReal   conductivity[2], capacity[2], bulk[2], speed[2], resistance;
  PetscReal   change[SAM_HEAT_CHANGES], wear[SAM_HEAT_CHANGES];
  PetscInt    changes, wears; /* 0, or SAM_HEAT_CHANGES: friction, or wear, depends on the temperature */
  PetscReal   expansion[2];   /* coefficients of thermal expansion, 1/K; 0: none */
  PetscReal   rolling;        /* speed of rolling, m/s */
  SamHeatPair pair;           /* body[0] NULL: not created yet */
  PetscReal   duration;       /* of the step, s */
  char        failed[192];    /* why the last bound has no temperature; empty: it has one */
  Vec         start;          /* temperature of the last bound in a step; NULL: there is none */
  PetscBool   solving;        /* between the beginning of a step and its end */
  PetscBool   clipped;        /* the last bound would have had friction below 0 in a cell of this rank */
  PetscBool   timeless;       /* there is frictional work in a step without duration */
  double      power[2];       /* of the last step: by its slip, and by the difference of the speeds; W */
  SamExpander expander[2];    /* NULL: not created yet, or no expansion; [1] may be [0], for equal conduction */
  SamMixing   mixing;         /* of the thermal displacements; NULL: not created yet */
  PetscInt    passes;         /* in which they have been found in this step */
  Vec         contact;        /* cells in which heat is divided while it is held: positive; NULL: it is not */
} SamHeatLaw;

#define SAM_TEMPERATURE_1 "temperature_1"
/*
  SamHeatLawFill - computes the frictional power per area, W/m2, which is 0 without contact: by the work of the step,
  where material streams by its power over the speed, and with thermal expansion by the slip of the step, `of_step`, and
  the shear at its end, `bound`. Not collective.
*/
PETSC_INTERN PetscErrorCode SamHeatLawFill(SamLaw law, Vec pressure, Vec of_step, Vec bound, Vec heat);
/* SamHeatLawUses - returns which of these fields the law uses. Not collective. */
PETSC_INTERN SamLawUse SamHeatLawUses(SamLaw law);
/*
  The thermal displacement (heatexpand.c). Collective, but for SamHeatLawExpands().
  SamHeatLawExpands - true if there is any. SamHeatLawExpand - gives the law the methods for it, and refuses bodies
  that have none. SamHeatLawDeclareExpansion - declares its fields and numbers. SamHeatLawBeginExpansion - prepares a
  step. SamHeatLawKeepExpansion - sets its numbers in a solved step; into: heat into both bodies, W/m2.
  SamHeatLawViewExpansion - prints them. SamHeatLawDestroyExpansion - frees the operators.
*/
static inline PetscBool SamHeatLawExpands(const SamHeatLaw *h)
{
  return h->expansion[0] != 0 || h->expansion[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
}
PETSC_INTERN PetscErrorCode SamHeatLawExpand(SamLaw law, const SamOptions *from);
PETSC_INTERN PetscErrorCode SamHeatLawDeclareExpansion(SamLaw law, SamState state);
PETSC_INTERN PetscErrorCode SamHeatLawBeginExpansion(SamLaw law);
PETSC_INTERN PetscErrorCode SamHeatLawKeepExpansion(SamLaw law, SamLawStep *step, const Vec into[2]);
PETSC_INTERN PetscErrorCode SamHeatLawViewExpansion(SamLaw law, SamState state, PetscViewer viewer);
PETSC_INTERN PetscErrorCode SamHeatLawDestroyExpansion(SamLaw law);
/*
  SamHeatLawKeepPowers - keeps the power of a solved step, W, and that by the bodies' speeds. Collective.
  SamHeatLawAdviseSpeeds - writes a warning if they differ; `unit`: theirs. Not collective (heatpower.c).
*/
PETSC_INTERN PetscErrorCode SamHeatLawKeepPowers(SamLaw law, const SamLawStep *step, PetscReal power);
PETSC_INTERN void           SamHeatLawAdviseSpeeds(const SamHeatLaw *h, const char unit[], char text[], size_t size);
/* SamHeatLawPrepare - creates the operators at their first use. Collective. */
PETSC_INTERN PetscErrorCode SamHeatLawPrepare(SamLaw law);
/* SamHeatLawBound - the law's method `bound`: the change of friction by temperature (heatbound.c). Collective. */
PETSC_INTERN PetscErrorCode SamHeatLawBound(SamLaw law, const SamBoundAt *at, const SamBound *bound);

#endif
