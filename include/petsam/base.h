/* Start and end of the library, its version, how it reports errors, and the reading of options. */
#ifndef PETSAM_BASE_H
#define PETSAM_BASE_H

#include <petscsys.h>
#include <petscvec.h>

#define PETSAM_VERSION "0.1.0"

/*
  Errors. Every function returns a PetscErrorCode. Two kinds are the user's to mend and carry a message of one or
  two lines that names the option or the file:
    SAM_ERR_USER  a wrong, missing or contradictory value (the program ends with exit code 2)
    SAM_ERR_FILE  a file that cannot be read or written, or lacks what was asked of it (exit code 3)
  All others are PETSc's. Errors of both kinds are raised on all ranks of the communicator alike.
*/
#define SAM_ERR_USER PETSC_ERR_USER_INPUT
#define SAM_ERR_FILE PETSC_ERR_FILE_OPEN

/*
  SamInitialize - registers petsam's classes and log events, and starts FFTW's MPI layer. Collective on
  PETSC_COMM_WORLD, after PetscInitialize(); calling it again does nothing. The public Create functions call it.
*/
PETSC_EXTERN PetscErrorCode SamInitialize(void);

/* SamFinalize - frees what SamInitialize() made and FFTW's plans' memory. Collective, before PetscFinalize(). */
PETSC_EXTERN PetscErrorCode SamFinalize(void);

/*
  SamOptions - who reads options: the communicator on which errors are raised and the help is printed, and the prefix
  that stands before the names. Several objects of a kind in one program are told apart by their prefixes.
*/
typedef struct {
  MPI_Comm    comm;
  const char *prefix; /* without dash; NULL: none */
} SamOptions;
/* SamOptionsPrefix - the prefix, empty where there is none. Not collective. */
PETSC_EXTERN const char *SamOptionsPrefix(const SamOptions *from);

/*
  The getters of options. Each looks up `-<prefix><name>` in PETSc's options database, checks that the whole text is a
  value of the type and lies in the range, and raises SAM_ERR_USER with the option's name otherwise. While the help is
  being printed, it prints its line. `value` holds the default on entry and is left alone when the option is absent;
  `set` may be NULL. Collective on the communicator; the database must be the same on all its ranks.
*/
typedef enum {
  SAM_RANGE_ANY,         /* any finite number */
  SAM_RANGE_NONNEGATIVE, /* finite, >= 0 */
  SAM_RANGE_POSITIVE,    /* finite, > 0 */
  SAM_RANGE_POSITIVE_INF /* > 0, `inf` allowed */
} SamRange;

PETSC_EXTERN PetscErrorCode SamOptionsHeading(const SamOptions *from, const char title[]);
PETSC_EXTERN PetscErrorCode SamOptionsReal(const SamOptions *from, const char name[], const char help[], SamRange range,
                                           PetscReal *value, PetscBool *set);
PETSC_EXTERN PetscErrorCode SamOptionsRealPair(const SamOptions *from, const char name[], const char help[],
                                               SamRange range, PetscReal value[2], PetscBool *set);
PETSC_EXTERN PetscErrorCode SamOptionsInt(const SamOptions *from, const char name[], const char help[], PetscInt least,
                                          PetscInt *value, PetscBool *set);
PETSC_EXTERN PetscErrorCode SamOptionsIntPair(const SamOptions *from, const char name[], const char help[],
                                              PetscInt least, PetscInt value[2], PetscBool *set);
PETSC_EXTERN PetscErrorCode SamOptionsBool(const SamOptions *from, const char name[], const char help[],
                                           PetscBool *value, PetscBool *set);
PETSC_EXTERN PetscErrorCode SamOptionsString(const SamOptions *from, const char name[], const char help[], char value[],
                                             size_t size, PetscBool *set);
/* SamOptionsEnum - one of the words of the NULL-terminated list; value is its index. */
PETSC_EXTERN PetscErrorCode SamOptionsEnum(const SamOptions *from, const char name[], const char help[],
                                           const char *const words[], PetscInt *value, PetscBool *set);
/*
  SamOptionsHasViewer - whether a viewer option is given (its viewer is made where it is used); tells the help of it and
  counts it as known. `draw` viewers are refused.
*/
PETSC_EXTERN PetscErrorCode SamOptionsHasViewer(const SamOptions *from, const char name[], const char help[],
                                                PetscBool *set);

#endif
