/* Functions of body, besides petsam/body.h, for other parts of the library. */
#ifndef PETSAM_PRIVATE_BODY_H
#define PETSAM_PRIVATE_BODY_H

#include <petsam/body.h>

/* SamBodyReference - adds a reference. Not collective. */
PETSC_INTERN PetscErrorCode SamBodyReference(SamBody body);

/*
  SamBodyPlace - a body at a depth: the material there, the depths between which it lies, and its number from the
  surface on. An interface belongs to the material above it.
*/
typedef struct {
  PetscReal young, poisson; /* Pa, infinite: rigid; 1 */
  PetscReal top, bottom;    /* m; below the last material infinite */
  PetscInt  number;         /* 0 at the surface */
  PetscBool last;           /* true: there is no other below it */
} SamBodyPlace;
/*
  SamBodyAt - returns the place at a depth (m); infinite: in the last material.
  SamBodyBelow - returns a place in the next material below one that is not the last.
  SamBodyIsRigid - returns true if the whole body is rigid.
  SamBodyNamed - returns what the options took from the table of materials, for a reader; empty: nothing. Borrowed.
  SamBodyConstant - returns a constant of the table for the last material, by its name there ("conductivity"), in its
  unit; NAN if the body has no named material, or its source states none.
  SamBodyExpansion - returns what a coefficient of thermal expansion alpha (1/K) means in a body of one material.
  None is collective.
*/
typedef struct {
  double displacement; /* (1 + nu) alpha, 1/K: of a surface that heat displaces */
  double stress;       /* E alpha, Pa/K: of thermal stress */
  double poisson;
} SamExpansion;
PETSC_INTERN SamExpansion SamBodyExpansion(SamBody body, double alpha);
PETSC_EXTERN SamBodyPlace SamBodyAt(SamBody body, PetscReal depth);
PETSC_INTERN SamBodyPlace SamBodyBelow(SamBody body, SamBodyPlace place);
PETSC_INTERN PetscBool    SamBodyIsRigid(SamBody body);
PETSC_EXTERN const char  *SamBodyNamed(SamBody body);
PETSC_INTERN double       SamBodyConstant(SamBody body, const char name[]);

/*
  SamBodyInitialStress - gets the stress xx and yy (Pa) that a body has before any load at a depth (m); at a jump, the
  value above it. It is zero unless -body1_initial_stress, -body2_initial_stress gives it.
  SamBodyMeanInitialStress - gets its mean from a depth `top` over a thickness (m).
  SamBodyHasInitialStress - returns true if the body has such a stress.
  None is collective.
*/
PETSC_INTERN void      SamBodyInitialStress(SamBody body, double depth, double stress[2]);
PETSC_INTERN void      SamBodyMeanInitialStress(SamBody body, double top, double thickness, double stress[2]);
PETSC_INTERN PetscBool SamBodyHasInitialStress(SamBody body);

/*
  SamBodyAdvise - writes a warning if the layers of body `number` (1 or 2) have no effect or are thinner than a cell (k
  = 0; `cell`: its size, m), or are thicker than 100 times the width of the contact (k = 1; `width`, m); else an empty
  text. `option`: the option that helps, without dash; empty: none. Not collective.
  SamBodyAdviseWorn - writes a warning if a body, worn to this depth (m), has lost its first layer; else an empty text.
*/
PETSC_INTERN PetscErrorCode SamBodyAdvise(SamBody body, PetscInt number, PetscInt k, PetscReal cell, PetscReal width,
                                          const char **option, char text[], size_t size);
PETSC_INTERN PetscErrorCode SamBodyAdviseWorn(SamBody body, PetscInt number, PetscReal depth, char text[], size_t size);

/* SamPairReference - adds a reference. Not collective. */
PETSC_INTERN PetscErrorCode SamPairReference(SamPair pair);

/*
  SamPairBody - returns body 1 (index 0) or 2 (index 1); borrowed.
  SamPairModulus - returns E* (Pa) of the materials at the surfaces.
  SamPairStiffest - returns E* (Pa) of the stiffest materials of both bodies.
  SamPairIsUniform - returns true if each of the bodies has a single material.
  SamPairCoupling - returns the largest ratio of the normal displacement by shear to that by pressure, over waves with
  wave numbers from `first` to `last` (1/m). For uniform bodies it is Dundurs' beta.
  None is collective.
*/
PETSC_EXTERN SamBody   SamPairBody(SamPair pair, PetscInt body);
PETSC_INTERN PetscReal SamPairModulus(SamPair pair);
PETSC_INTERN double    SamPairStiffest(SamPair pair);
PETSC_INTERN PetscBool SamPairIsUniform(SamPair pair);
PETSC_INTERN double    SamPairCoupling(SamPair pair, double first, double last);

/*
  SamPairConstants - the constants A, B and D (1/Pa) to which the displacements of two uniform bodies are proportional:
  with the integrals I of 1/r, x^2/r^3, x/r^2 and so on over a cell, u_z by pressure is A I_r, u_t by shear A I_r + B
  (I_xx, I_xy; I_xy, I_yy), u_t by pressure D (I_x, I_y). `by`: their derivatives by the moduli, E (Pa) and nu of body 1
  and of body 2, which are in `modulus`.
  SamPairGetConstants - gets them; returns NULL, or the reason why they do not describe the pair; the moduli are those
  at the surfaces even then.
  SamPairGetValues - gets A, B and D of the materials at the surfaces, also where a body is rigid.
  SamPairCreateOther - creates a pair whose A and B are not proportional to those of a pair, and whose D is not 0.
  SamPairCreateChanged - creates a pair in which Poisson's ratio of a body (0 or 1) is larger by `change`, which may be
  negative; the stresses that tractions cause are linear in it.
  None is collective.
*/
enum { SAM_PAIR_CONSTANTS = 3, SAM_PAIR_MODULI = 4 };
typedef struct {
  double value[SAM_PAIR_CONSTANTS], modulus[SAM_PAIR_MODULI], by[SAM_PAIR_CONSTANTS][SAM_PAIR_MODULI];
} SamPairConstants;
PETSC_INTERN const char    *SamPairGetConstants(SamPair pair, SamPairConstants *constants);
PETSC_INTERN void           SamPairGetValues(SamPair pair, double value[SAM_PAIR_CONSTANTS]);
PETSC_INTERN PetscErrorCode SamPairCreateOther(SamPair pair, SamPair *other);
PETSC_INTERN PetscErrorCode SamPairCreateChanged(SamPair pair, PetscInt body, SamPair *changed, double *change);

/*
  Symbols times |k|, m/Pa times 1/m: u_z from p, the coupling, u_t from q along the wave, and across it. A wave along x
  of p and (q_x, q_y) moves a surface by u_z = (zz p + zr q_x)/k, u_x = (rr q_x + zr p)/k, u_y = tt q_y/k, where p and
  u_z go like cos kx and q_x and u_x like sin kx.
*/
typedef enum { SAM_WAVE_ZZ, SAM_WAVE_ZR, SAM_WAVE_RR, SAM_WAVE_TT, SAM_WAVE_SYMBOLS } SamWaveSymbol;

/*
  SamBodySymbols - adds the symbols of a body at the wave number k > 0 (1/m) to `total`, and to `difference` their
  difference from those of a half-space of the material at the surface, which is accurate even if it is as small as
  exp(-2 k h). `sign`: the sign of zr.
  SamPairSymbols - computes the symbols of a pair: zz, rr, tt are sums over both bodies, zr is that of body 2 minus that
  of body 1.
  SamBodyInterfaceStiffness - computes the stiffness (Pa/m) against an opening of a body's last interface by (u_x, u_y,
  u_z) of its lower side, for a wave along x: p = -(s[0] u_z - i s[1] u_x), q_x = -(s[2] u_x + i s[1] u_z), q_y = -s[3]
  u_y between the layers, which are free at the surface of the body, and the substrate. 0 where rounding hides it.
  None is collective.
*/
PETSC_INTERN void SamBodySymbols(SamBody body, double sign, double k, double total[SAM_WAVE_SYMBOLS],
                                 double difference[SAM_WAVE_SYMBOLS]);
PETSC_INTERN void SamBodyInterfaceStiffness(SamBody body, double k, double s[4]);
PETSC_INTERN void SamPairSymbols(SamPair pair, double k, double total[SAM_WAVE_SYMBOLS],
                                 double difference[SAM_WAVE_SYMBOLS]);

/*
  SamBodyStresses - computes, at a wave number k (1/m) and the depth z (m) below the top of a material, which must be
  elastic, the ten functions that compose the stresses by unit waves of traction, in the order of the transforms at the
  head of layeredstress.c. In the first of several materials they are the differences from those of a half-space of this
  material. Not collective.
*/
#define SAM_WAVE_STRESSES 10
PETSC_INTERN void SamBodyStresses(SamBody body, PetscInt material, double z, double k, double s[SAM_WAVE_STRESSES]);

/*
  SamPairCreateFromOptions - creates a pair from -body1, -body1_young, -body1_poisson, -body1_layers,
  -body1_layer_young, -body1_layer_poisson, -body1_layer_thickness, -body1_layer_file, -body1_initial_stress, the same
  options of body 2, and -film_thickness and -film_shear of the film. Collective. Errors: SAM_ERR_USER, where
  SamBodyCreate() and SamPairCreate() fail, and for an option that is missing, a name that is no material, or lists of
  different lengths.
  SamPairCheckInitialStress - fails if a stress before any load goes far deeper than the grid is wide (`width`, m): its
  depths have another unit. Collective. Errors: SAM_ERR_USER.
  SamPairAddParameters - appends the constants to the parameters of a run, under the names of these options. Not
  collective.
  SamPairCreateFromParameters - creates a pair from the parameters of a run; `source` names their file in messages.
  Collective. Errors: SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamPairCreateFromOptions(const SamOptions *from, SamPair *pair);
PETSC_INTERN PetscErrorCode SamPairCheckInitialStress(SamPair pair, const SamOptions *from, PetscReal width);
PETSC_INTERN PetscErrorCode SamPairAddParameters(SamPair pair, SamParameters *parameters);
PETSC_INTERN PetscErrorCode SamPairCreateFromParameters(MPI_Comm comm, const SamParameters *parameters,
                                                        const char source[], SamPair *pair);

#endif
