/* The parameters that define a run and its bodies, by name. Results and checkpoints store them. */
#ifndef PETSAM_PARAMETERS_H
#define PETSAM_PARAMETERS_H

#include <petsam/base.h>

/*
  SamParameters - values by the names of the options (without dash) that give them. If `fixed` is true, a stopped run
  can only continue with the same value.
*/
#define SAM_PARAMETERS       64  /* maximum number of parameters of a run */
#define SAM_PARAMETER_VALUES 128 /* maximum number of numbers of a parameter */
typedef struct {
  char      name[32];
  PetscBool fixed;
  PetscInt  count; /* number of values; 0: the parameter is a text */
  PetscReal value[SAM_PARAMETER_VALUES];
  char      text[256];
} SamParameter;
typedef struct {
  PetscInt     count;
  SamParameter list[SAM_PARAMETERS];
  PetscBool    in_process; /* true: of a contact in process, whose files no program can continue */
} SamParameters;

/*
  SamParametersAddReals - appends a parameter of one or more numbers.

  Not collective.

  In,out: parameters - the parameters of a run
  In:     name       - name of the option that gives it, without dash
          fixed      - true: a stopped run can only continue with the same values
          count      - number of values, 1 to SAM_PARAMETER_VALUES
          values     - the values (unit of the option); copied

  Errors: PETSC_ERR_ARG_OUTOFRANGE for another count, or a parameter too many.

  See also: SamParametersAddText(), SamParametersFind().
*/
PETSC_EXTERN PetscErrorCode SamParametersAddReals(SamParameters *parameters, const char name[], PetscBool fixed,
                                                  PetscInt count, const PetscReal values[]);

/*
  SamParametersAddText - appends a parameter that is a text, which is truncated if it is too long.

  Not collective.

  In,out: parameters - the parameters of a run
  In:     name       - name of the option that gives it, without dash
          fixed      - true: a stopped run can only continue with the same text
          text       - the text; copied

  Errors: PETSC_ERR_ARG_OUTOFRANGE for a parameter too many.

  See also: SamParametersAddReals(), SamParametersFind().
*/
PETSC_EXTERN PetscErrorCode SamParametersAddText(SamParameters *parameters, const char name[], PetscBool fixed,
                                                 const char text[]);

/*
  SamParametersFind - returns the parameter of a name, NULL if there is none; borrowed.

  Not collective.

  In:     parameters - the parameters of a run
          name       - name of the parameter

  Errors: none; it returns no error code.

  See also: SamParametersAddReals(), SamParametersAddText().
*/
PETSC_EXTERN const SamParameter *SamParametersFind(const SamParameters *parameters, const char name[]);

#endif
