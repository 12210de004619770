/*
  The implementation of SamLaw, for authors of new laws: src/laws/sums.c is the shortest example,
  examples/embed/plugin/law.c an example of friction that changes with slip.

  A law is a file. Its create function, registered by SamLawRegister(), sets the methods that it needs:

      static PetscErrorCode Create(SamLaw law)
      {
        law->ops.declare = Declare;
        law->ops.advance = Advance;
        return PETSC_SUCCESS;
      }

  A law declares its stored fields and numbers once, in the state of a contact, and finds them there by name. In a step
  the methods are called in this order: check(), begin(), displace(), separation() and limit() of all laws, the normal
  problem with attract(), bound(), the tangential problem, displace() and attract() for the check, advance().
*/
#ifndef PETSAM_LAWIMPL_H
#define PETSAM_LAWIMPL_H

#include <petsam/private/backstep.h>
#include <petsam/private/baseimpl.h>
#include <petsam/balance.h>
#include <petsam/law.h>
#include <petsam/private/grid.h>
#include <petsam/private/stresspart.h>

/* SamExamination - the examination of a run's steps (private/examination.h). */
typedef struct _n_SamExamination SamExamination;

/*
  SamStrain - a tangential displacement that is linear in x and y: a point at (x, y) moves by (xx x + xy y, xy x + yy y)
  m.
*/
typedef struct {
  PetscReal xx, yy, xy;
} SamStrain;

/* SamBoundAt - the quantities on which a bound of the shear depends. */
typedef struct {
  SamState          state;    /* state of the contact; NULL: no stored fields */
  const SamControl *control;  /* control of the step, from which laws read conditions; NULL: usual values */
  Vec               pressure; /* Pa */
  Vec               slip;     /* m: slip length of this step (steady rolling: per m of rolled distance); NULL: none */
  PetscReal         rolled;   /* m: rolled distance of the step (SamProblemGetRolled()) */
} SamBoundAt;

/*
  SamBound - a bound (Pa), and its derivatives by the pressure (1) and by the length of the slip (Pa/m), each a field of
  one component, NULL if it is not wanted; by_slip is only wanted together with the value. The first law fills the
  fields; each later law changes them.
*/
typedef struct {
  Vec value, by_pressure, by_slip;
} SamBound;

/*
  SamLawContact - the contact of a step, for a law whose state depends on the tractions, and whose offset in turn
  changes the tractions.
*/
typedef struct {
  SamState          state;
  const SamBalance *normal, *tangential;
  Vec               pressure, shear, bound; /* Pa: the last solution */
  Vec               slip;                   /* SAM_USE_PATH or SAM_USE_POWER, if the law uses one of them; else NULL */
  PetscBool         solved;                 /* false: there is no solution with the offset of the tried state */
  char              failed[192];            /* set by a law that finds no solution: the reason */
} SamLawContact;

/*
  SamLawUse - a field of a solved step that the advance() of a law uses. The contact computes the fields that any law
  uses, once, of one component each:
    SAM_USE_PATH     |ds|, the length of the slip of the step, m; outside of the contact the distance by which the
                     surfaces have moved over each other
    SAM_USE_PRESSED  p |ds| in cells that slip, Pa m
    SAM_USE_WORK     -q.ds in cells that slip, J/m2 (both as in SamContactComputeFriction())
    SAM_USE_POWER    in steady rolling, the frictional power per area over the speed, with the centred slip, Pa
    SAM_USE_GAP      the gap of the surfaces as they were before the step, m
    SAM_USE_SLOPE    the derivative of the bound of the shear by the pressure, 1
*/
typedef enum {
  SAM_USE_PATH,
  SAM_USE_PRESSED,
  SAM_USE_WORK,
  SAM_USE_POWER,
  SAM_USE_GAP,
  SAM_USE_SLOPE,
  SAM_USES
} SamLawUse;

/* SamLawStep - a solved step, for laws to advance their tried state. */
typedef struct _n_SamLawStep SamLawStep;
struct _n_SamLawStep {
  SamGrid           grid;
  SamState          state;
  SamElasticity     elasticity;
  const SamControl *control;
  PetscReal         rolled;          /* m: rolled distance of the step (SamProblemGetRolled()) */
  Vec               pressure, shear; /* Pa */
  Vec               tension;         /* Pa, by which the surfaces attract each other; NULL: they do not */
  Vec               total;   /* Pa: pressure less tension, which loads the bodies; the pressure without tension */
  Vec               last[2]; /* pressure and shear of the previous step, NULL: none */
  Vec               bound;   /* bound of the shear, Pa */
  const PetscReal  *rigid;   /* m, rad: the displacements of the step, by SamComponent */
  PetscBool         known_pressure;  /* true: pressure of an earlier step, whose yielding the gap already contains */
  char              failed[192];     /* set by a law whose check of the step fails: the reason */
  PetscBool         moves;           /* set by a law that changes the separation, so that the pressure changes */
  Vec               field[SAM_USES]; /* fields that laws use, by SamLawUse; NULL: no law uses it */
};
/*
  SamLawAddToSum - sets the tried generation of a field to the committed one plus `more`. Collective.
*/
PETSC_EXTERN PetscErrorCode SamLawAddToSum(SamState state, const char name[], Vec more);
/*
  The frames of both bodies (frames.c). The grid goes with body 1; the point x + D of body 2 lies under its point x,
  where D is the slide (m). A field of body 2 is stored at the points that lie under the cells at D = 0. The law slide
  declares these numbers of the state, in the order of the enumeration: D and the rolled distance, the slider (m), and
  its longest stretch (m).
  SamFramesGetSlide - gets D of a generation (of the committed one for SAM_TRIED without a try); returns false if the
  surfaces do not slide, and then D = 0. SamFramesSetSlide - sets D of the committed generation, if they slide.
  SamFramesRewind - subtracts a distance (m) from D, and from the slider that it follows, of a generation. Not
  collective.
  SamFramesGetOffset - gets the offset (m) from a cell to the point of body 0 or 1 that lies under it now, in the
  coordinates of the body: the distance rolled over both bodies, in the second body plus the slide of the generation. It
  returns false if the surfaces do not slide. Not collective.
  SamFramesRead - computes the values at the cells of a field that is stored at a body's own points, for an offset of
  that body; outside of the grid the field is zero, or periodic. SamFramesReadBeyond - does the same with other values
  outside (`beyond`). SamFramesWrite - applies the transpose, from cells to the body's points, with the same sum. Input
  and output must be different vectors of one component. Collective.
*/
enum {
  SAM_FRAME_X,
  SAM_FRAME_Y,
  SAM_FRAME_ROLLED_X,
  SAM_FRAME_ROLLED_Y,
  SAM_FRAME_SLIDER_X,
  SAM_FRAME_SLIDER_Y,
  SAM_FRAME_LIMIT
};
#define SAM_FRAME "slide_x" /* name of the first number */
PETSC_INTERN PetscBool SamFramesGetSlide(SamState state, SamGeneration generation, PetscReal slide[2]);
PETSC_INTERN PetscBool SamFramesGetOffset(SamState state, SamGeneration generation, PetscInt body, PetscReal offset[2]);
PETSC_INTERN void      SamFramesSetSlide(SamState state, const PetscReal slide[2]);
PETSC_INTERN void      SamFramesRewind(SamState state, SamGeneration generation, const PetscReal by[2]);
PETSC_INTERN PetscErrorCode SamFramesRead(SamElasticity elasticity, const PetscReal slide[2], Vec own, Vec seen);
PETSC_INTERN PetscErrorCode SamFramesReadBeyond(SamElasticity elasticity, const PetscReal slide[2], SamBorder beyond,
                                                Vec own, Vec seen);
PETSC_INTERN PetscErrorCode SamFramesWrite(SamElasticity elasticity, const PetscReal slide[2], Vec seen, Vec own);
/*
  SamLawListWords - appends the words of an option that selects laws, each after `between`. Collective.
  SamLawOrder - returns the place of a type among the registered types. Not collective.
  SamLawOption - returns the option that messages name where the law is refused. Not collective.
*/
PETSC_INTERN PetscErrorCode SamLawListWords(SamElasticity elasticity, const char option[], const char between[],
                                            char words[], size_t size);
PETSC_INTERN PetscInt       SamLawOrder(SamLawType type);
PETSC_INTERN const char    *SamLawOption(SamLaw law);
/*
  SamLawNoBack - the method `back` of a law that adds nothing: no step depends on its state, or what it changes is an
  offset by conditions alone, or friction by a coefficient. Not collective.
*/
PETSC_EXTERN PetscErrorCode SamLawNoBack(SamLaw law, SamBackStep *step);

struct _n_SamLaw {
  SamClassId          class_id;
  PetscInt            references;
  char                type[64];
  SamElasticity       elasticity;
  SamGrid             grid;           /* grid of the elasticity; borrowed */
  SamConditions       conditions;     /* conditions of the problem that has the law; NULL: none */
  PetscObjectState    revision;       /* raised by setters; declarations and pressure depend on it */
  PetscBool           always;         /* true: each problem has it without an option */
  PetscBool           follows_slip;   /* true: bound() depends on the slip of the step */
  PetscBool           displaces;      /* true: displace() may add to fields */
  PetscBool           strains;        /* true: displace() may add to the strain */
  PetscBool           accumulates;    /* true: sums over all steps, in the state's field named like the type */
  const char         *option;         /* option that selects the law, without dash; NULL: none */
  const char         *word;           /* value of that option for this law, as of -friction_law; NULL: any */
  const char         *heading;        /* heading of the options in the help; NULL: none */
  const SamOptionRow *rows;           /* options, whose settings are `data` */
  PetscInt            row_count;      /* number of options */
  PetscInt            bytes;          /* memory per cell, bytes */
  PetscBool           uses[SAM_USES]; /* fields of a solved step that advance() uses */
  PetscBool           needs_friction; /* true: meaningless without friction */
  PetscBool           slides;         /* true: the surfaces move past each other */
  PetscBool           remembers; /* true: bodies move by what they remember of earlier steps: no elastic closed form */
  PetscBool           wears;     /* true: it removes material: its numbers wear_volume1 and wear_volume2 tell */
  const char         *number;    /* name of the number by which back() finds the derivative; NULL: none */
  const char         *named;     /* option that messages name where the law is refused; NULL: the one that selects it */
  const char         *strained;  /* number that is above 0 once bodies have yielded by it; NULL: they do not */
  const char         *with_shear; /* numbers that follow the shear at the surface, separated by blanks; NULL: none */
  PetscBool nonlocal; /* true: the bound of a cell, or a symmetric operator, is not all that a step's tangent needs */
  PetscBool forbids_jumps; /* true: not possible in a wear simulation with cycle jumps */
  PetscBool of_body[2];    /* true: adds to the separation a field at a body's own points, if they slide */
  PetscBool any_motion;    /* true: valid in every motion, since it uses no slip of steps */
  PetscBool by_passages;   /* true: in steady rolling it acts in cycles of a wear simulation only */
  void     *data;          /* data of the type, from PetscNew(); NULL: none */
  /* all may be NULL; collective */
  struct {
    /* reads and records options that the rows do not describe; `asked` on entry: selected by the word, on return: by
       the options. Without it the law is selected where `option` is given */
    PetscErrorCode (*setfromoptions)(SamLaw law, const SamOptions *from, PetscBool *asked);
    PetscErrorCode (*addparameters)(SamLaw law, SamParameters *parameters);
    PetscErrorCode (*destroy)(SamLaw law); /* frees what `data` refers to; SamLawDestroy() frees `data` itself */
    /* adds the law's conditions, and keeps SamConditionsAdd()'s `own`; called once, when a problem gets the law */
    PetscErrorCode (*conditions)(SamLaw law, SamConditions conditions);
    /*
      Rejects invalid prescribed values, and sets conditions that depend on others: `wrong` is the part of the control
      (private/control.h) that is rejected first, and `why` the fault of its value; empty: none.
    */
    PetscErrorCode (*check)(SamLaw law, SamControl *control, PetscInt *wrong, char why[], size_t size);
    /* declares fields and numbers; again when the law's revision has been raised */
    PetscErrorCode (*declare)(SamLaw law, SamState state);
    /*
      Sets, before a step is solved, the law's tried state, on which its offset in the step depends. `duration`: the
      time of the step minus that of the step before, s; 0 in the first one. A law whose offset changes raises its
      revision.
    */
    PetscErrorCode (*begin)(SamLaw law, SamState state, const SamControl *control, PetscReal duration);
    /*
      Adds the displacements of the surfaces in a step by other causes than tractions, body 2 relative to body 1 (m), to
      u_z (one component) and to u_t (two components). A part of the tangential displacement that is linear in x and y
      is added to `strain` instead: it is evaluated row by row, needs no field, and follows the bodies when they roll.
      What is NULL is not wanted. The fields must depend on the control and the state alone, since the independent check
      evaluates them, too; the strain on the control alone: where only it is wanted, the state is NULL. The
      displacements of a solution contain the fields, also those of the previous step, so that gap, slip and derived
      quantities need no further terms. `adds` is set to true if a field is not zero, and else unchanged.
    */
    PetscErrorCode (*displace)(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t,
                               SamStrain *strain, PetscBool *adds);
    /*
      Adds the tension (Pa, not negative, mean over each cell) by which the surfaces attract each other at this gap (m),
      which is 0 in contact. It may depend on the gap alone, and must not grow with it: the contact finds both together
      (contact/step/attract.c). The tension acts on the bodies as a negative pressure, in contact and outside, so that
      contact bears its resultants besides the given loads.
    */
    PetscErrorCode (*attract)(SamLaw law, Vec gap, Vec tension);
    /*
      Adds the law's part of the separation (m, one component) to h. SAM_COMMITTED: the part from which the next step
      starts; SAM_TRIED: the part in the gap of the last solution, the tried one, or else the committed one. h NULL:
      only sets `adds`, true if there is any.
    */
    PetscErrorCode (*separation)(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds);
    /*
      Judges the law's tried state by the tractions of the solved contact. With `again` it has set another one: the
      contact is solved with its offset, starting from the last tractions, and the method is called again. In its first
      call of a solve, the tractions are those without such a state, or those that another solve has found. Only one law
      of a problem may have this method: two would judge each other's contact, which only an iteration over both states
      solves.
    */
    PetscErrorCode (*follow)(SamLaw law, SamLawContact *contact, PetscBool *again);
    /*
      Adds to u_z (one component) and u_t (two components) the change of the law's displacements (m) by small changes of
      the pressure and the shear (Pa) of the tried step; it is linear in these. A law with `follow` but without this
      method has no tangent stiffness.
    */
    PetscErrorCode (*tangent)(SamLaw law, SamState state, Vec pressure, Vec shear, Vec u_z, Vec u_t);
    /* gets the largest pressure that the surfaces bear, Pa */
    PetscErrorCode (*limit)(SamLaw law, PetscReal *most);
    /* computes the largest shear of each cell */
    PetscErrorCode (*bound)(SamLaw law, const SamBoundAt *at, const SamBound *bound);
    /*
      gets the coefficient of friction, 0 if it is a field; `has` (or NULL): true if any is above 0, which is collective
    */
    PetscErrorCode (*friction)(SamLaw law, PetscReal *uniform, PetscBool *has);
    /* computes the law's tried state, and numbers of the step */
    PetscErrorCode (*advance)(SamLaw law, SamLawStep *step);
    /* returns the value of the law's `number`: 0 if the law was not selected */
    PetscReal (*number)(SamLaw law);
    /*
      Adds to the derivatives of a number of a history by what the law's state in the step depends on, and by the law's
      `number`. What its state changes in later steps is in by_worn, for a law that removes material. A law without this
      method has no gradient. In a history with cycle jumps it is not called.
    */
    PetscErrorCode (*back)(SamLaw law, SamBackStep *step);
    /* prints the law's numbers of a step, on a line of its own */
    PetscErrorCode (*view)(SamLaw law, SamState state, PetscViewer viewer);
    /*
      Writes a line about a step, whose number in the run is given from 1, and its weight: the line of the greatest
      weight is printed at the end of a run of several steps. An empty line is none. Not collective.
    */
    void (*summarize)(SamLaw law, SamState state, PetscInt step, PetscReal *weight, char text[], size_t size);
    /* true if body 0 or 1 may yield by this law, so that no elastic solution in closed form describes it */
    PetscBool (*yields)(SamLaw law, PetscInt body);
    /* gets the smallest stress at which a body flows after this strain, Pa; infinite: none does */
    PetscErrorCode (*flow)(SamLaw law, PetscReal strain, PetscReal *stress);
    /* examines a solved step for doubt(), which adds, after the last step, doubts of numbers that the law protects */
    PetscErrorCode (*examine)(SamLaw law, SamExamination *examination);
    PetscErrorCode (*doubt)(SamLaw law, SamExamination *examination);
    /* writes a warning about a solved step; empty: none */
    PetscErrorCode (*advise)(SamLaw law, SamState state, char text[], size_t size);
  } ops;
};

/* The laws of the library, in the order in which they act, and their parts of the stresses in a body (laws/register.c);
   SamInitialize() registers them. */
PETSC_INTERN PetscErrorCode          SamLawRegisterAll(void);
PETSC_INTERN PetscErrorCode          SamLawCreate_Coulomb(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_BulkStress(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Bodies(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Friction(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Heat(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Slide(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Archard(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Energy(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Hardness(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_Plastic(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_AccumulatedSlip(SamLaw law);
PETSC_INTERN PetscErrorCode          SamLawCreate_FrictionEnergy(SamLaw law);
PETSC_INTERN const SamStressPartType SamStressPart_Bulk, SamStressPart_Layers, SamStressPart_Heat;

#endif
