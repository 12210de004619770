/* The choice of a grid and of steps for an accuracy. */
#ifndef PETSAM_ACCURACY_H
#define PETSAM_ACCURACY_H

#include <petsam/base.h>
#include <petsam/private/arguments.h>
#include <petsam/private/errors.h>

/*
  SamAccuracy - what -accuracy asks for, and what was chosen.

  SamAccuracyChoose - reads the options -accuracy, -accuracy_of and -grid into `accuracy`, all of whose members but
  `tell` and `later` must be zero; chooses, by trials on coarse grids, the grid and the steps where they are not given,
  and sets them as options, with -errors companion, for the simulation that follows. Options that neither a trial nor
  the program reads are refused before the first trial is solved. Without -accuracy it only reads. `arguments`: see
  SamHistoryCreateFromOptions(). Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
  SamAccuracyWorst - returns the row with the maximum error of the numbers that it concerns, borrowed; NULL: there is
  none. SamAccuracyWriteMissed - writes the other numbers than the row `but` whose errors are too large, with their
  causes, and how many have reached the accuracy; each part begins with "; ". Neither is collective (accuracy.c).
*/
#define SAM_ACCURACY_NAMES 512
#define SAM_ACCURACY_LIMIT 128
typedef struct {
  PetscReal error;                       /* largest relative error of the numbers; 0: any */
  char      numbers[SAM_ACCURACY_NAMES]; /* their names, separated by commas; empty: all that have an error */
  char      grid[8];                     /* "auto" if -grid is given */
  char      chosen[256];                 /* the chosen options; empty: none */
  char      limit[SAM_ACCURACY_LIMIT];   /* why errors do not become as small as asked; empty: they can */
  PetscInt  trials;
  double    seconds; /* time that the trials took, s */
  /* if not NULL, receives a line about each trial */
  PetscErrorCode (*tell)(const char text[]);
  const char *const *later; /* names, with -, of the options that the program reads after the choice, ended by NULL */
} SamAccuracy;
PETSC_EXTERN PetscErrorCode     SamAccuracyChoose(const SamOptions *from, const SamArguments *arguments,
                                                  SamAccuracy *accuracy);
PETSC_EXTERN const SamErrorRow *SamAccuracyWorst(const SamAccuracy *accuracy, const SamErrorTable *table);
PETSC_EXTERN void               SamAccuracyWriteMissed(const SamAccuracy *accuracy, const SamErrorTable *table,
                                                       const SamErrorRow *but, char text[], size_t size);

#endif
