/* Version of the library, its initialization and finalization, its errors, and the reading of options. */
#ifndef PETSAM_BASE_H
#define PETSAM_BASE_H

#include <petscsys.h>
#include <petscvec.h>

/* The version. SAM_VERSION_GE(1, 0, 0) is true from 1.0.0 on. Programs must be linked again if the first two change. */
#define SAM_VERSION_MAJOR    1
#define SAM_VERSION_MINOR    0
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
  Both are raised on all ranks of the communicator. All other codes are PETSc's.
  All functions return PETSC_ERR_ARG_NULL if a handle or a pointer is NULL that may not be NULL, and PETSC_ERR_ARG_WRONG
  if a handle belongs to an object of another class, or to one that has been destroyed; the message has the number of
  the argument. They return PETSC_ERR_ARG_NOTSAMECOMM, at once on each of its ranks, if two objects, or an object and a
  vector, have communicators of different ranks; the message has the numbers of both arguments. The comments of the
  functions say where NULL is allowed, and do not list these three errors.
*/
#define SAM_ERR_USER PETSC_ERR_USER_INPUT
#define SAM_ERR_FILE PETSC_ERR_FILE_OPEN

/*
  SamInitialize - registers petsam's classes, its laws and its log events, and starts FFTW for MPI.

  Collective on PETSC_COMM_WORLD.

  In: nothing.

  Errors: none of its own.

  It must be called after PetscInitialize() and before laws are added to a problem; calling it again does nothing.

  See also: SamFinalize(), SamOptionsPlugins().
*/
PETSC_EXTERN PetscErrorCode SamInitialize(void);

/*
  SamFinalize - frees the objects of SamInitialize() and the plans that FFTW has stored.

  Collective on PETSC_COMM_WORLD.

  In: nothing.

  Errors: none of its own.

  It must be called before PetscFinalize(). It does nothing without SamInitialize().

  See also: SamInitialize().
*/
PETSC_EXTERN PetscErrorCode SamFinalize(void);

/*
  SamOptions - the context in which options are read: the communicator on which errors are raised and the help is
  printed, and the prefix of the option names. Prefixes distinguish several objects of a kind in one program.
*/
typedef struct {
  MPI_Comm    comm;
  const char *prefix; /* without dash; NULL: none */
} SamOptions;

/* SamRange - the values that a number may have. */
typedef enum {
  SAM_RANGE_ANY,          /* any finite number */
  SAM_RANGE_NONNEGATIVE,  /* finite, >= 0 */
  SAM_RANGE_POSITIVE,     /* finite, > 0 */
  SAM_RANGE_POSITIVE_INF, /* > 0, `inf` allowed */
  SAM_RANGE_NOT_ZERO,     /* any but 0, `inf` allowed */
  SAM_RANGE_PART          /* > 0, < 1 */
} SamRange;

/*
  SamOptionsHeading - prints the title of a group of options, while the help is printed.

  Collective on the communicator of the options.

  In:     from  - communicator and prefix of the options
          title - the title

  Errors: none of its own.

  See also: SamOptionsRead().
*/
PETSC_EXTERN PetscErrorCode SamOptionsHeading(const SamOptions *from, const char title[]);

/*
  SamOptionRow - an option: its name, its text in the help, the kind of its value, and the place of the value in the
  settings of its owner (`member`, by offsetof()). The settings hold the default, which the help shows and which stays
  if the option is absent. A real number without a default is NaN, an integer 0, a text empty.

  SAM_OPTION_REAL     PetscReal in `range`; `size` 2: two numbers separated by a comma, or a single one for both;
                      `words`: the end of the error message about a number outside of the range. `unit`: its unit,
                      NULL: none; if that is one of SI, the user may give others of its dimension (mm). The help prints
                      the unit in the parentheses that `text` leaves open for it, "width () along x" or "radius (, inf:
                      flat)", else in parentheses after the text
  SAM_OPTION_INT      PetscInt from `least` to `most` (0: any); `size` likewise
  SAM_OPTION_BOOL     PetscBool: 1, true, yes, on, or 0, false, no, off, or no value for true; with `words`: one of
                      these, where the first means false and any other true
  SAM_OPTION_ENUM     an enumeration of C, given by one of `words`, whose position is the value
  SAM_OPTION_STRING   char[size]
  SAM_OPTION_FILE     char[size], the name of a file that is read: no other file of the run may replace it
  SAM_OPTION_FILES    char[size], the names of several such files, separated by commas
  SAM_OPTION_OUTPUT   char[size], the name of a file that is written
  SAM_OPTION_WORD     char[size], one of `words`
  SAM_OPTION_WORDS    char[size], some of `words`, separated by commas; the caller checks them
  SAM_OPTION_VIEWER   no member: an ASCII viewer, created where it is used

  `words` are separated by commas. `needs`: another option, or option and value, without which this option has no
  meaning; " or -" separates alternatives. `excludes`: options, separated by commas, that cannot be given with this one.
  For a boolean, `needs` and `excludes` apply only if it is true. `missing`: the purpose of an option that is required
  (if the options that it needs are given) unless it has a default. `recorded`: a stopped run can only continue with the
  same value. `loosest`: the largest value of a tolerance (0: any), and `beyond`: what is wrong with larger ones.

  See also: SamOptionsRead(), SamOptionsReal().
*/
typedef enum {
  SAM_OPTION_REAL,
  SAM_OPTION_INT,
  SAM_OPTION_BOOL,
  SAM_OPTION_ENUM,
  SAM_OPTION_STRING,
  SAM_OPTION_FILE,
  SAM_OPTION_FILES,
  SAM_OPTION_OUTPUT,
  SAM_OPTION_WORD,
  SAM_OPTION_WORDS,
  SAM_OPTION_VIEWER
} SamOptionKind;
typedef struct {
  const char   *name, *text;
  SamOptionKind kind;
  size_t        member;
  SamRange      range;
  PetscInt      least, most, size;
  const char   *words, *unit, *needs, *excludes, *missing;
  PetscBool     recorded;
  PetscReal     loosest;
  const char   *beyond;
} SamOptionRow;

#define SAM_OPTION_ROWS(rows) (PetscInt)(sizeof(rows) / sizeof((rows)[0])), rows /* the row count and the table */

/*
  SamOptionsRead - reads the options of a table from PETSc's options database into the settings.

  Collective on the communicator of the options; the database must be the same on all its ranks.

  In:     from     - communicator and prefix of the options; an option is read as -<prefix><name>
          heading  - title above the options in the help; NULL: none
          count    - number of rows
          rows     - the table; SAM_OPTION_ROWS() gives count and table; may be NULL without rows
  In,out: settings - struct of the owner; on entry the defaults, on return the values; may be NULL without rows
  Out:    given    - true for each option that was given, one value per row; may be NULL

  Errors: SAM_ERR_USER with the name of the option, the given text, and the expected values.

  While the help is printed, the function prints the heading and a line for each row, and requires nothing.

  See also: SamOptionsReal(), SamOptionsHeading().
*/
PETSC_EXTERN PetscErrorCode SamOptionsRead(const SamOptions *from, const char heading[], PetscInt count,
                                           const SamOptionRow rows[], void *settings, PetscBool given[]);

/*
  SamOptionsReal - reads one real number from an option.

  Collective on the communicator of the options; the database must be the same on all its ranks.

  In:     from  - communicator and prefix of the options
          name  - name of the option, without dash and prefix
          help  - text of the option in the help
          unit  - SI unit of the value, as in SamOptionRow; NULL: it has none
          range - allowed values
  In,out: value - the number (SI unit: `unit`); on entry the default
  Out:    set   - true if the option was given; may be NULL

  Errors: SAM_ERR_USER with the name of the option, the given text, and the expected values.

  See also: SamOptionsRead().
*/
PETSC_EXTERN PetscErrorCode SamOptionsReal(const SamOptions *from, const char name[], const char help[],
                                           const char unit[], SamRange range, PetscReal *value, PetscBool *set);

/*
  SamOptionsPlugins - loads shared libraries and calls their functions that register types.

  Collective on the communicator of the options.

  In:     from - communicator and prefix of the options

  Options: -plugin: names of the libraries, separated by commas.
  Errors: SAM_ERR_FILE for a library that cannot be loaded, lacks the function, or would register its types in another
  copy of petsam's library than that of the caller.

  The function of each library is

      PetscErrorCode SamPluginRegister(void)

  It registers types (SamGapRegister(), SamLawRegister(), ...). SamOptionsPlugins() must be called before types are
  chosen, as SamSetupReadOptions() does. The libraries stay loaded.

  See also: SamInitialize(), SamGapRegister(), SamLawRegister(), SamElasticityRegister().
*/
PETSC_EXTERN PetscErrorCode SamOptionsPlugins(const SamOptions *from);

#endif
