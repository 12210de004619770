/* The inside of the laws of wear, for cycle jumps. */
#ifndef PETSAM_WEARIMPL_H
#define PETSAM_WEARIMPL_H

#include <petsam/private/lawimpl.h>
#include <petsam/problem.h>
#include <petsam/wear.h>

/*
  The laws store the wear load that has been removed; if surfaces slide, it is that of body 1, and that of body 2 is
  stored separately at body 2's own points. In a life they also store the wear load of the cycle so far, and its slip.
*/
#define SAM_WEAR_LOAD  "wear_load"
#define SAM_WEAR_LOAD2 "wear_load2"
#define SAM_WEAR_CYCLE "wear_cycle_load"
#define SAM_WEAR_PATH  "wear_cycle_path"
/* The depth that a life has worn body 2, minus the depth that many steps would have worn (longslides.c). */
#define SAM_WEAR_STRIPES "wear_stripes"

/* The data of a law of wear. */
typedef struct {
  PetscReal coefficient[2]; /* of the bodies: 1/Pa, or m3/J */
  PetscReal least;          /* smallest eigenvalue of the normal influence, m/Pa; 0: not computed yet */
  PetscBool by_energy;      /* wear load |q . ds|; else p |ds| */
  PetscBool jumps;          /* steps add to the wear load of the cycle; it is removed by cycle jumps */
} SamWear;

/* SamWearDoubt - the laws' method `doubt` (weardoubt.c). Collective. */
PETSC_INTERN PetscErrorCode SamWearDoubt(SamLaw law, SamExamination *examination);
/*
  SamWearNumber - returns the depth of both bodies per wear load, 1/Pa or m3/J. Not collective. SamWearBack - the laws'
  method `back` (wearback.c). Collective.
*/
PETSC_INTERN PetscReal      SamWearNumber(SamLaw law);
PETSC_INTERN PetscErrorCode SamWearBack(SamLaw law, SamBackStep *step);
/*
  SamLawIsWear - returns true if a law is of these types, and its data a SamWear. SamWearFind - finds such a law of a
  problem; NULL: it has none. Neither is collective.
*/
PETSC_INTERN PetscBool      SamLawIsWear(SamLaw law);
PETSC_INTERN PetscErrorCode SamWearFind(SamProblem problem, SamLaw *law);
/*
  SamWearGetLimit - gets the limit on how many times a single step may remove a wear load of `most` per pressure (m)
  (wearlimit.c); infinite without wear. Collective.
*/
PETSC_INTERN PetscErrorCode SamWearGetLimit(SamLaw law, PetscReal most, PetscReal *times);
/*
  SamWearGetExcess - computes the ratio of a step's wear to the limit of a step: above 1 the pressure of later steps is
  uneven from cell to cell, and wrong. For half-spaces the limit is a depth of 1.16 (p/E*) h, h being the width of
  square cells. Collective.
*/
PETSC_INTERN PetscErrorCode SamWearGetExcess(SamLaw law, SamLawStep *step, PetscReal *excess);
/*
  SamWearGetStride - gets the distance between two slides (m) relative to the contact's length along it (longslides.c).
  Collective.
*/
PETSC_INTERN PetscErrorCode SamWearGetStride(SamElasticity elasticity, Vec pressure, const PetscReal from[2],
                                             const PetscReal to[2], PetscReal *stride);
/*
  SamWearGetVolumes - gets the volumes (m3; of a running band m3 per m of its length) that wear loads of both bodies,
  which may be the same vector, remove, and the maximum depths (m). Collective.
*/
PETSC_INTERN PetscErrorCode SamWearGetVolumes(SamLaw law, Vec load, Vec load2, PetscReal volume[2], PetscReal depth[2]);

#endif
