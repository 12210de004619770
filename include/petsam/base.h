/* Version, start and end of the library, its errors, and the reading of options. */
#ifndef PETSAM_BASE_H
#define PETSAM_BASE_H

#include <petscsys.h>
#include <petscvec.h>

/* The version. SAM_VERSION_GE(0, 1, 0) is true from 0.1.0 on; programs are linked again when the first two change. */
#define SAM_VERSION_MAJOR    0
#define SAM_VERSION_MINOR    1
#define SAM_VERSION_SUBMINOR 0
#define PETSAM_VERSION       PetscStringize(SAM_VERSION_MAJOR.SAM_VERSION_MINOR.SAM_VERSION_SUBMINOR)

#define SAM_VERSION_COUNT(major, minor, subminor) (1000000 * (major) + 1000 * (minor) + (subminor))

#define SAM_VERSION_HERE SAM_VERSION_COUNT(SAM_VERSION_MAJOR, SAM_VERSION_MINOR, SAM_VERSION_SUBMINOR)

#define SAM_VERSION_EQ(major, minor, subminor) (SAM_VERSION_HERE == SAM_VERSION_COUNT(major, minor, subminor))
#define SAM_VERSION_LT(major, minor, subminor) (SAM_VERSION_HERE < SAM_VERSION_COUNT(major, minor, subminor))
#define SAM_VERSION_LE(major, minor, subminor) (SAM_VERSION_HERE <= SAM_VERSION_COUNT(major, minor, subminor))
#define SAM_VERSION_GT(major, minor, subminor) (SAM_VERSION_HERE > SAM_VERSION_COUNT(major, minor, subminor))
#define SAM_VERSION_GE(major, minor, subminor) (SAM_VERSION_HERE >= SAM_VERSION_COUNT(major, minor, subminor))

/*
  Errors. Every function returns a PetscErrorCode. Two codes are for mistakes of the user, with a message of one or two
  lines that names the option or the file:
    SAM_ERR_USER  a wrong, missing or contradictory value (the program ends with exit code 2)
    SAM_ERR_FILE  a file that cannot be read or written, or lacks what is needed (exit code 3)
  These are raised on all ranks of the communicator. All other codes are PETSc's.
*/
#define SAM_ERR_USER PETSC_ERR_USER_INPUT
#define SAM_ERR_FILE PETSC_ERR_FILE_OPEN

/*
  SamInitialize - registers petsam's classes and log events, and starts FFTW's MPI layer. Collective on
  PETSC_COMM_WORLD, after PetscInitialize(); calling it again does nothing. The public Create functions call it.
*/
PETSC_EXTERN PetscErrorCode SamInitialize(void);

/*
  SamFinalize - frees what SamInitialize() made, and what FFTW remembers of plans. Collective, before PetscFinalize().
*/
PETSC_EXTERN PetscErrorCode SamFinalize(void);

/*
  SamOptions - for whom options are read: the communicator on which errors are raised and the help is printed, and the
  prefix of the option names. Prefixes distinguish several objects of a kind in one program.
*/
typedef struct {
  MPI_Comm    comm;
  const char *prefix; /* without dash; NULL: none */
} SamOptions;
/* SamOptionsPrefix - the prefix, an empty text for none. Not collective. */
PETSC_INTERN const char *SamOptionsPrefix(const SamOptions *from);

/*
  The functions that read options. Each looks up `-<prefix><name>` in PETSc's options database, and checks that the
  whole text is a value of the type and lies in the range. While the help is printed, it also prints the option's line
  of it. On entry `value` holds the default, which is kept when the option is absent; `set`, whether it was given, may
  be NULL. Collective on the communicator; the database must be the same on all its ranks. Errors: SAM_ERR_USER with
  the option's name, the text, and what was expected.
*/
typedef enum {
  SAM_RANGE_ANY,          /* any finite number */
  SAM_RANGE_NONNEGATIVE,  /* finite, >= 0 */
  SAM_RANGE_POSITIVE,     /* finite, > 0 */
  SAM_RANGE_POSITIVE_INF, /* > 0, `inf` allowed */
  SAM_RANGE_NOT_ZERO,     /* any but 0, `inf` allowed */
  SAM_RANGE_PART          /* > 0, < 1 */
} SamRange;

/* SamOptionsHeading - prints the title of a group of options, while the help is printed. */
PETSC_EXTERN PetscErrorCode SamOptionsHeading(const SamOptions *from, const char title[]);
/* SamOptionsReal, SamOptionsRealPair - one number, or two in the range separated by a comma; one stands for both. */
PETSC_EXTERN PetscErrorCode SamOptionsReal(const SamOptions *from, const char name[], const char help[], SamRange range,
                                           PetscReal *value, PetscBool *set);
PETSC_INTERN PetscErrorCode SamOptionsRealPair(const SamOptions *from, const char name[], const char help[],
                                               SamRange range, PetscReal value[2], PetscBool *set);
/* SamOptionsReals - a list of up to `most` numbers in the range, and how many; 0: the option is absent. */
PETSC_INTERN PetscErrorCode SamOptionsReals(const SamOptions *from, const char name[], const char help[],
                                            SamRange range, PetscInt most, PetscReal values[], PetscInt *count);
/* SamOptionsInt, SamOptionsIntPair - the same for whole numbers from `least` on. */
PETSC_EXTERN PetscErrorCode SamOptionsInt(const SamOptions *from, const char name[], const char help[], PetscInt least,
                                          PetscInt *value, PetscBool *set);
PETSC_INTERN PetscErrorCode SamOptionsIntPair(const SamOptions *from, const char name[], const char help[],
                                              PetscInt least, PetscInt value[2], PetscBool *set);
/* SamOptionsBool - 1, true, yes, on, or 0, false, no, off; the option without a value means true. */
PETSC_EXTERN PetscErrorCode SamOptionsBool(const SamOptions *from, const char name[], const char help[],
                                           PetscBool *value, PetscBool *set);
/* SamOptionsString - a text of fewer than `size` characters. */
PETSC_EXTERN PetscErrorCode SamOptionsString(const SamOptions *from, const char name[], const char help[], char value[],
                                             size_t size, PetscBool *set);
/*
  SamOptionsFile - the name of a file; SamOptionsWord, SamOptionsWords - one word or several with commas between them,
  out of `words` (with commas likewise), which the help and the completion list and the caller checks. All are texts of
  fewer than `size` characters.
*/
PETSC_EXTERN PetscErrorCode SamOptionsFile(const SamOptions *from, const char name[], const char help[], char value[],
                                           size_t size, PetscBool *set);
PETSC_EXTERN PetscErrorCode SamOptionsWord(const SamOptions *from, const char name[], const char help[],
                                           const char words[], char value[], size_t size, PetscBool *set);
PETSC_INTERN PetscErrorCode SamOptionsWords(const SamOptions *from, const char name[], const char help[],
                                            const char words[], char value[], size_t size, PetscBool *set);
/* SamOptionsEnum - one of the words of a NULL-terminated list; `value` is its index. */
PETSC_EXTERN PetscErrorCode SamOptionsEnum(const SamOptions *from, const char name[], const char help[],
                                           const char *const words[], PetscInt *value, PetscBool *set);
/*
  SamOptionsHasViewer - whether a viewer option is given; the viewer itself is created where it is used. Only ASCII
  viewers are accepted. The option then counts as known, and the help lists it.
*/
PETSC_INTERN PetscErrorCode SamOptionsHasViewer(const SamOptions *from, const char name[], const char help[],
                                                PetscBool *set);
/*
  SamOptionsPlugins - loads the shared libraries that -plugin names, and calls the function

      PetscErrorCode SamPluginRegister(void)

  of each, which registers types (SamGapRegister(), SamLawRegister(), ...); to be called before types are chosen, as
  SamSetupReadOptions() does. They stay loaded. Collective. Errors: SAM_ERR_FILE for one that cannot be loaded, lacks
  the function, or would register its types in another copy of petsam's library than that of the caller.
*/
PETSC_EXTERN PetscErrorCode SamOptionsPlugins(const SamOptions *from);

#endif
