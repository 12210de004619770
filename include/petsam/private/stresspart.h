/*
  The stresses in a body: the load steps of which they are wanted, the points, and the parts that are added to those by
  tractions, each brought by who knows its cause.
*/
#ifndef PETSAM_STRESSPART_H
#define PETSAM_STRESSPART_H

#include <petsam/control.h>
#include <petsam/elasticity.h>
#include <petsam/parameters.h>
#include <petsam/private/fourier.h>
#include <petsam/private/state.h>
#include <petsam/private/stress.h>

/*
  SamStepNumber - the numbers of a step that are read: the number of the load step, 0 if steps have none; time (s);
  contact area (m2); the cycle of a wear simulation; and, if the surfaces slide past each other, the distances (m) that
  body 1 has slid over body 2, and that the contact has rolled over body 1.
*/
typedef enum {
  SAM_STEP_NUMBER,
  SAM_STEP_TIME,
  SAM_STEP_AREA,
  SAM_STEP_CYCLE,
  SAM_STEP_SLIDE_X,
  SAM_STEP_SLIDE_Y,
  SAM_STEP_ROLLED_X,
  SAM_STEP_ROLLED_Y
} SamStepNumber;

/*
  SamStressSource - the bodies, which are referenced, and the load steps, of a contact or of a file. Collective
  functions read the steps when they are needed: this rank's rows of a field, by its name in results; a number; the
  values of conditions of the bodies. Step -1 is the step before the first, if there is one. `warn` receives warnings
  about the steps as a cycle. `tell` is called from time to time during long work with its name, the fraction of it
  that is done, and the fraction of all work that is done (0: unknown); NULL: not called.
*/
typedef struct {
  SamElasticity        bodies;
  const SamParameters *parameters; /* that define the contact, borrowed; NULL: no part finds what it needs */
  const SamFourierSettings
             *settings; /* of the transforms, borrowed, NULL: those of the bodies; set by the evaluation */
  const char *name;     /* name of the origin of the bodies, for messages; borrowed */
  PetscInt    steps;
  PetscBool   before;
  PetscBool   slides; /* true: the surfaces slide past each other, so that points of body 2 move */
  PetscBool   slips;  /* true: steps follow each other, and have slips, not slip velocities */
  /* true if all steps have a field */
  PetscBool (*has)(void *context, const char field[]);
  PetscErrorCode (*read)(void *context, PetscInt step, const char field[], double values[]);
  PetscErrorCode (*number)(void *context, PetscInt step, SamStepNumber number, double *value);
  PetscErrorCode (*conditions)(void *context, PetscInt step, SamConditions conditions, SamControl *control);
  /* returns the k-th group of layers, borrowed, whose z is NULL if their stresses are not available; NULL: no more */
  const SamStateLayers *(*layers)(void *context, PetscInt k);
  /* reads a component of the stresses of a group in a layer, counted along z: this rank's rows, Pa */
  PetscErrorCode (*layer)(void *context, PetscInt step, PetscInt group, PetscInt component, PetscInt layer,
                          double values[]);
  PetscErrorCode (*warn)(void *context, const char text[]);
  PetscErrorCode (*tell)(void *context, const char work[], double part, double whole);
  void *context;
} SamStressSource;

/*
  SamPoints - the points whose stresses a rank has: its rows of a map at one depth, or its depths of a section. The
  stress of step s begins at stress + s * SAM_STRESS_COMPONENTS * count, component after component.
*/
typedef struct {
  PetscInt count;         /* number of points */
  PetscInt depth, depths; /* first depth, number of depths */
  PetscInt plane;         /* number of points at a depth */
  double  *stress;        /* Pa */
} SamPoints;

/*
  SamStressPlaces - where stresses are wanted: in a body below all cells (maps), or below one line of cells (a section).
  The arrays are borrowed.
*/
typedef struct {
  SamGrid          grid;
  PetscInt         body; /* 1 or 2 */
  PetscBool        section;
  SamSectionAxis   axis;
  PetscInt         index;  /* of the section's line of cells */
  PetscInt         length; /* number of points on that line */
  PetscInt         depths;
  const PetscReal *depth;   /* m */
  const int       *side;    /* side of an interface at a depth: -1 above, 1 below, 0: none given, or no interface */
  PetscBool        passing; /* true: points travel along x: the states of one are those of its row */
  PetscBool        moves;   /* true: the points are the body's own, which slide under the contact */
} SamStressPlaces;
/*
  SamPlacesTakeLine - takes the section's line of n points out of this rank's rows of a field, for all ranks.
  Collective.
*/
PETSC_INTERN PetscErrorCode SamPlacesTakeLine(const SamStressPlaces *places, const double rows[], PetscInt n,
                                              double line[]);

/*
  SamStressPart - a part of the stresses, added to that by tractions. Its type's create function sets the methods if the
  source has such a part, else none; it may refuse a request (SAM_ERR_USER). All methods may be NULL; they are
  collective but for uniform.
    uniform  adds the stress (Pa) of a step at a depth (m), if it is uniform along the surface
    add      adds the stresses (Pa) of a step to those of points
    plane    the same, by whole planes: adds those of this rank's cells at the number of a depth to a field of
             SAM_STRESS_COMPONENTS components. On a section the planes are computed beforehand for all its depths, as
             ranks share these.
    value    computes the quantity of the type at the number of a depth in a field of one component, if it is `wanted`
    bytes    returns the memory that the part takes on this rank besides its planes and values
    destroy  frees what `data` refers to; `data` itself is freed by the class
*/
typedef struct _n_SamStressPart *SamStressPart;
struct _n_SamStressPart {
  const struct _n_SamStressPartType *type;
  const SamStressSource             *source;
  const SamStressPlaces             *places;
  SamBody                            body;
  SamConditions                      conditions; /* of the bodies and their laws */
  const SamControl                  *control;    /* values of these in each step */
  PetscBool                          wanted;     /* true: the quantity of the type is wanted */
  PetscBool                          initial;    /* true: it contains the stress of the body before any load */
  void                              *data;
  struct {
    void (*uniform)(SamStressPart part, PetscInt step, PetscReal depth, double stress[SAM_STRESS_COMPONENTS]);
    PetscErrorCode (*add)(SamStressPart part, PetscInt step, const SamPoints *points, double stress[]);
    PetscErrorCode (*plane)(SamStressPart part, PetscInt step, PetscInt depth, Vec stress);
    PetscErrorCode (*value)(SamStressPart part, PetscInt step, PetscInt depth, Vec values);
    double (*bytes)(SamStressPart part);
    PetscErrorCode (*destroy)(SamStressPart part);
  } ops;
  /* of the class: planes of stresses and values of the quantity */
  struct {
    Vec     field;
    double *line; /* of a section: (steps, depths, components, length) */
  } plane, value;
};

/* SamStressPartType - a type of part: what it reads of steps besides tractions, and the quantity that it adds. */
enum { SAM_STRESS_PART_FIELDS = 4, SAM_STRESS_PART_TYPES = 16 };
typedef struct _n_SamStressPartType {
  const char *name;                           /* as progress and messages call it */
  const char *fields[SAM_STRESS_PART_FIELDS]; /* names of fields of results that it reads; they may be missing */
  struct {
    const char *name, *dataset, *unit, *text; /* name in -quantities, of the dataset; NULL: the type has none */
  } quantity;
  PetscErrorCode (*create)(SamStressPart part);
} SamStressPartType;
/*
  SamStressPartRegister - adds a type, which is borrowed, or replaces that of the same name; parts act in this order.
  Not collective, but to be called on all ranks. Errors: PETSC_ERR_ARG_OUTOFRANGE for a type too many.
  SamStressPartGetType - returns the k-th type; NULL: there are no more. Not collective.
  SamStressField - returns the k-th name of the fields of steps that evaluations read: the tractions, which no step
  lacks, the slip, and those that types read, SAM_STRESS_FIELDS at most; NULL: there are no more. Not collective.
  SamStressFieldFind - returns the number of such a name; SAM_STRESS_FIELDS: it is none. Not collective.
*/
enum { SAM_STRESS_FIELDS = 16, SAM_STRESS_SLIP_FIELDS = 2 };
PETSC_EXTERN PetscErrorCode           SamStressPartRegister(const SamStressPartType *type);
PETSC_INTERN const SamStressPartType *SamStressPartGetType(PetscInt k);
PETSC_INTERN const char              *SamStressField(PetscInt k);
PETSC_INTERN PetscInt                 SamStressFieldFind(const char name[]);

/*
  SamStressParts - one part of each type, for an evaluation. The source, the places and the control are borrowed.
  SamStressPartsCreate - creates the parts; wanted[k]: the quantity of the k-th type is wanted. Errors: SAM_ERR_USER.
  SamStressPartsPrepare - computes the planes of a section, before its stresses.
  SamStressPartsUniform - computes the stress (Pa) of a step at a depth that is uniform along the surface: that of the
  body before any load, and those of parts. Not collective.
  SamStressPartsVary - returns true if the stress of a part differs along the surface. Not collective.
  SamStressPartsAdd - adds the stresses of all parts to those of points.
  SamStressPartsGetValues - computes the quantity of the k-th type at points.
  SamStressPartsBytes - returns the memory of this rank, bytes. Not collective.
  All others are collective.
*/
typedef struct _n_SamStressParts *SamStressParts;
PETSC_INTERN PetscErrorCode       SamStressPartsCreate(const SamStressSource *source, const SamStressPlaces *places,
                                                       SamConditions conditions, const SamControl control[],
                                                       const PetscBool wanted[], SamStressParts *parts);
PETSC_INTERN PetscErrorCode       SamStressPartsPrepare(SamStressParts parts);
PETSC_INTERN void                 SamStressPartsUniform(SamStressParts parts, PetscInt step, PetscReal depth,
                                                        double stress[SAM_STRESS_COMPONENTS]);
PETSC_INTERN PetscBool            SamStressPartsVary(SamStressParts parts);
PETSC_INTERN PetscErrorCode       SamStressPartsAdd(SamStressParts parts, PetscInt step, const SamPoints *points,
                                                    double stress[]);
PETSC_INTERN PetscErrorCode       SamStressPartsGetValues(SamStressParts parts, PetscInt k, PetscInt step,
                                                          const SamPoints *points, double values[]);
PETSC_INTERN double               SamStressPartsBytes(SamStressParts parts);
PETSC_INTERN PetscErrorCode       SamStressPartsDestroy(SamStressParts *parts);

#endif
