/* Doubts: estimated errors of numbers by their causes. */
#ifndef PETSAM_DOUBTS_H
#define PETSAM_DOUBTS_H

#include <petsam/private/baseimpl.h>

/* SamCause - what causes an error: the width of the cells, the length of the load steps, the thickness of the layers of
   a body that yields, or the finite elements of a body's compliance. */
typedef enum { SAM_CAUSE_CELLS, SAM_CAUSE_STEPS, SAM_CAUSE_LAYERS, SAM_CAUSE_MESH, SAM_CAUSES } SamCause;
PETSC_EXTERN const char *const SamCauseNames[SAM_CAUSES];

/* SamDoubt - an error of a number by a cause. */
#define SAM_DOUBT_LARGE 0.05 /* errors above this are told */
#define SAM_ENERGY_NONE 1e-6 /* energy, relative to N times the approach, that is next to nothing: it has no error */
#define SAM_DOUBT_NAME  128  /* characters of a name */
#define SAM_DOUBT_WHY   160  /* characters of a reason */
#define SAM_DOUBT_WORSE (-1) /* a factor */
/* where the contact grows from a point, the limit of M_z falls faster with N than M_z does */
#define SAM_DOUBT_TWIST \
  "M_z and N begin together, and its effects grow with each finer step: give a first row of N alone"
typedef struct {
  char      name[SAM_DOUBT_NAME];
  SamCause  cause;
  double    error;              /* relative to the number; 1: nothing is known of it */
  PetscBool known;              /* that of a value in closed form: no other estimate counts */
  double    factor;             /* how many times narrower cells, more steps or more layers make it small; 0: none do;
                                   SAM_DOUBT_WORSE: they make it worse, and none are proposed whatever else they mend */
  char      why[SAM_DOUBT_WHY]; /* what is not resolved; may be empty */
} SamDoubt;

/*
  SamDoubts - the errors of numbers by their causes. The largest is kept for each number and cause.
  SamDoubtsAdd - adds an error of all numbers named in `names`, separated by blanks; at most 1 counts. The reason has a
  format of printf(). An error of 0 or NaN is ignored.
  SamDoubtsSet - the same for numbers whose value is known in closed form, so that no other estimate of it counts.
  SamDoubtsJoin - adds all errors by a cause of another table.
  SamDoubtsOf - returns the error of a number by a cause; 0: there is none. `known`: it has been set.
  SamDoubtsWrite - writes the numbers whose error by a cause is large, the largest first, and the reasons, as
  "dissipated_energy 12 %, slip_max unknown (slip zones are 0.8 cells wide)"; empty: none is. `factor`: what makes all
  of them small, as in SamDoubt.
  SamErrorWrite - writes a relative error in per cent, or "unknown" from 1 on; returns the text. None is collective
  (doubts.c).
*/
#define SAM_ERROR_TEXT 16
PETSC_EXTERN const char *SamErrorWrite(double error, char text[], size_t size);
#define SAM_DOUBTS 64
typedef struct {
  PetscInt count;
  SamDoubt of[SAM_DOUBTS];
} SamDoubts;
PETSC_EXTERN void   SamDoubtsAdd(SamDoubts *doubts, SamCause cause, double error, double factor, const char names[],
                                 const char why[], ...) PETSC_ATTRIBUTE_FORMAT(6, 7);
PETSC_INTERN void   SamDoubtsSet(SamDoubts *doubts, SamCause cause, double error, double factor, const char names[],
                                 const char why[], ...) PETSC_ATTRIBUTE_FORMAT(6, 7);
PETSC_INTERN void   SamDoubtsJoin(SamDoubts *doubts, const SamDoubts *more, SamCause cause);
PETSC_INTERN double SamDoubtsOf(const SamDoubts *doubts, const char name[], SamCause cause, PetscBool *known);
PETSC_INTERN void   SamDoubtsWrite(const SamDoubts *doubts, SamCause cause, double *factor, char text[], size_t size);

#endif
