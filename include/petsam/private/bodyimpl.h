/* The implementation of bodies and pairs, for types of elasticity. */
#ifndef PETSAM_BODYIMPL_H
#define PETSAM_BODYIMPL_H

#include <petsam/body.h>
#include <petsam/private/table.h>

#define SAM_STRESS_ROWS (SAM_PARAMETER_VALUES / 3) /* most rows of a stress over the depth, which is a parameter */

struct _n_SamBody {
  SamClassId  class_id;
  PetscInt    references, count;
  SamMaterial material[SAM_MATERIALS];     /* the last thickness is infinite */
  PetscInt    rows;                        /* of the stress before any load; 0: there is none */
  PetscReal   initial[SAM_STRESS_ROWS][3]; /* depth (m), stress xx and yy (Pa), see initialstress.c */
  char        named[512];                  /* SamBodyNamed() */

  const SamNamedMaterial *own; /* of the last material, from the table; NULL: it is given by numbers */
};

/*
  The displacements depend on these sums of elastic constants of the materials at both surfaces (relative displacements:
  elasticity.h). At a distance r on two half-spaces a unit force gives
    u_z from p:   normal / r
    u_x from q_x: shear / r + shear_xx x^2 / r^3,   u_y from q_x: shear_xx x y / r^3
    u_x from p:   coupling x / r^2,                 u_z from q_x: -coupling x / r^2
  (Johnson 1985, Contact Mechanics, sections 3.2 and 3.6). On bodies of several materials this is the limit for small r.
*/
struct _n_SamPair {
  SamClassId class_id;
  PetscInt   references;
  SamBody    body[2];
  PetscReal  normal;   /* sum (1 - nu)/(2 pi G), 1/Pa */
  PetscReal  shear;    /* sum (1 - nu)/(2 pi G), 1/Pa */
  PetscReal  shear_xx; /* sum nu/(2 pi G), 1/Pa */
  PetscReal  coupling; /* [(1 - 2 nu1)/G1 - (1 - 2 nu2)/G2]/(4 pi), 1/Pa */
  PetscReal  modulus;  /* E* = 1/(pi normal), Pa */
  PetscReal  dundurs;  /* Dundurs' beta = coupling/normal */
  PetscReal  film[2];  /* thickness (m) and shear modulus (Pa) of a film between the surfaces; 0: none */
};

/*
  SamBodyCount - returns the number of materials. SamBodyNumberAt - returns the number of the material at a depth (m).
  SamBodyMaterialAt - returns the material there; borrowed. SamBodyTop - returns the depth (m) at which the n-th
  material begins; infinite for n = SamBodyCount(). SamBodySubstrate - returns the last material; borrowed. None is
  collective.
*/
PETSC_INTERN PetscInt           SamBodyCount(SamBody body);
PETSC_INTERN PetscInt           SamBodyNumberAt(SamBody body, PetscReal depth);
PETSC_INTERN const SamMaterial *SamBodyMaterialAt(SamBody body, PetscReal depth);
PETSC_INTERN PetscReal          SamBodyTop(SamBody body, PetscInt n);
PETSC_INTERN const SamMaterial *SamBodySubstrate(SamBody body);
/* SamPairFilm - returns the displacement of the surfaces by unit shear in the film, m/Pa. Not collective. */
PETSC_INTERN PetscReal SamPairFilm(SamPair pair);
/* SamPairIsCoupled - returns true if pressure moves the surfaces tangentially by more than rounding. Not collective. */
PETSC_INTERN PetscBool SamPairIsCoupled(SamPair pair);

/*
  The following functions read a body from its options or parameters, or record its parameters. The names begin with
  `prefix`, for instance "body1_"; the prefix of `from` ends with it. Errors: those of the pair.
*/
PETSC_INTERN PetscErrorCode SamBodyCreateFromOptions(const SamOptions *from, SamBody *body);
PETSC_INTERN PetscErrorCode SamBodyAddParameters(SamBody body, const char prefix[], SamParameters *parameters);
PETSC_INTERN PetscErrorCode SamBodyCreateFromParameters(MPI_Comm comm, const SamParameters *parameters,
                                                        const char prefix[], const char source[], SamBody *body);
/*
  SamDepthTable - constants of a body over the depth, which an option's text file gives. The caller sets `names` and
  `what`, the words in messages for what ends at the last depth.
  SamDepthTableRead - reads the file if the option (its name without prefix) is given, which `set` returns; there are
  then two rows or more, from depth 0 on, and SamTableDestroy() frees the table. Collective. Errors: SAM_ERR_FILE;
  SAM_ERR_USER with file and line for a missing column and for rows that do not go down from the surface.
  SamDepthTableGet - returns the value of a row in the column of names[c]. Not collective.
*/
#define SAM_DEPTH_COLUMNS 3 /* depth (m), and two others */
typedef struct {
  const char *names[SAM_DEPTH_COLUMNS + 1], *what; /* NULL behind the names */
  char        file[PETSC_MAX_PATH_LEN];
  SamTable    table;
  PetscInt    column[SAM_DEPTH_COLUMNS];
} SamDepthTable;
PETSC_INTERN PetscErrorCode SamDepthTableRead(const SamOptions *from, const char option[], const char help[],
                                              SamDepthTable *d, PetscBool *set);
static inline double        SamDepthTableGet(const SamDepthTable *d, PetscInt row, int c)
{
  return d->table.value[row * d->table.columns + d->column[c]];
}

/*
  SamBodyReadProfile - reads the layers of a body whose constants vary with the depth, from the text file that an option
  (its name without prefix) names: columns depth (m, from 0 on), young (Pa), poisson. Constants are linear between rows,
  and jump at a depth that two rows have. It makes at most SAM_MATERIALS - 1 layers, each with the constants at its
  middle. `set`: true if the option is given. Collective. Errors: SAM_ERR_USER, SAM_ERR_FILE.
*/
PETSC_INTERN PetscErrorCode SamBodyReadProfile(const SamOptions *from, const char option[], SamMaterial layers[],
                                               PetscInt *count, PetscBool *set);

/* The same of the stress before any load alone. */
PETSC_INTERN PetscErrorCode SamBodyReadInitialStress(const SamOptions *from, SamBody body);
PETSC_INTERN PetscErrorCode SamBodyAddInitialStress(SamBody body, const char prefix[], SamParameters *parameters);
PETSC_INTERN PetscErrorCode SamBodyTakeInitialStress(MPI_Comm comm, const SamParameters *parameters,
                                                     const char prefix[], const char source[], SamBody body);

#endif
