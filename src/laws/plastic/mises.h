/* The material: von Mises' yield surface with isotropic and kinematic hardening. */
#ifndef PETSAM_PLASTIC_MISES_H
#define PETSAM_PLASTIC_MISES_H

#include "plasticimpl.h"

#define SAM_BACKSTRESSES        4 /* maximum number */
#define SAM_HARDENING_CONSTANTS 2
#define SAM_HARDENING_TEXT      64 /* characters of an option */
#define SAM_HARDENING_FORMS     "none, linear:H, voce:Q,B or swift:E0,N"

/* SamHardening - how the yield stress grows: the kind, and its constants H (Pa); Q (Pa) and b; or e0 and n */
typedef enum { SAM_HARDENING_NONE, SAM_HARDENING_LINEAR, SAM_HARDENING_VOCE, SAM_HARDENING_SWIFT } SamHardeningType;
typedef struct {
  SamHardeningType type;
  double           constant[SAM_HARDENING_CONSTANTS];
} SamHardening;

/*
  SamMises - a material that yields: the yield stress is Y, Y + H p, Y + Q (1 - exp(-b p)), or Y (1 + p/e0)^n of the
  accumulated plastic strain p. Each backstress follows Armstrong and Frederick, dX = 2/3 C de - g X dp.
*/
typedef struct {
  double       shear, yield; /* shear modulus and Y, Pa; infinite: never yields */
  SamHardening hardening;
  PetscInt     backstresses;
  double       back[SAM_BACKSTRESSES][2]; /* C (Pa), g */
} SamMises;

/* SamMisesAt - internal variables of a point: plastic strain, accumulated plastic strain, backstresses (Pa) */
typedef struct {
  double e[PARTS], p, back[SAM_BACKSTRESSES][PARTS];
} SamMisesAt;

/*
  SamMisesTangent - the change of the plastic strain with the driver in a yielding step: the part A of the driver's
  change along n, a unit tensor, plus the part B of the rest; both in [0, 1).
*/
typedef struct {
  double n[PARTS], along, across;
} SamMisesTangent;

/*
  SamHardeningRead - reads the value of the option of this name, without dash and prefix, in one of SAM_HARDENING_FORMS.
  Collective. Errors: SAM_ERR_USER with the option, its value and the form.
  SamHardeningWrite - writes it in this form with SI units, so that the same text is the same hardening. Not collective.
*/
PETSC_INTERN PetscErrorCode SamHardeningRead(const SamOptions *from, const char option[], const char text[],
                                             SamHardening *hardening);
PETSC_INTERN void           SamHardeningWrite(const SamHardening *hardening, char text[], size_t size);
/* SamMisesYield - returns the yield stress (Pa), and its derivative by p (NULL: not wanted). Not collective. */
PETSC_INTERN double SamMisesYield(const SamMises *material, double p, double *slope);
/*
  SamMisesWork - returns the work of plastic strain from one state to another (Pa = J/m3). It is the work of the stress
  on the yield surface in the direction of the strain's growth, and so does not depend on when in the step yielding
  began. `change`: the growth of the backstresses times the growth of the strain (Pa). Not collective.
*/
PETSC_INTERN double SamMisesWork(const SamMises *material, const SamMisesAt *from, const SamMisesAt *to,
                                 double *change);
/* SamMisesExcess - returns the yield function (Pa), positive beyond yield, of a stress in a state. Not collective. */
PETSC_INTERN double SamMisesExcess(const SamMises *material, const SamMisesAt *at, const double stress[PARTS]);
/*
  SamMisesReturn - computes, in place, the state at the end of a step from the state at its beginning; d is the driver
  at the end, the deviator of stress/(2 mu) plus the plastic strain. Returns true if the point yields. Not collective.
*/
PETSC_INTERN PetscBool SamMisesReturn(const SamMises *material, const double d[PARTS], SamMisesAt *at,
                                      SamMisesTangent *tangent);

/* Return a:b, and the deviator of a tensor. */
static inline double SamTensorDot(const double a[PARTS], const double b[PARTS])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}
static inline void SamTensorDeviator(double a[PARTS])
{
  const double mean = (a[0] + a[1] + a[2]) / 3;

  for (PetscInt c = 0; c < 3; c++) a[c] -= mean;
}

#endif
