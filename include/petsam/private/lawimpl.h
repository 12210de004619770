/*
  The inside of SamLaw, for those who add a law: src/laws/sums.c is the shortest example, examples/embed/plugin/law.c
  one of friction that changes with slip.

  A law is a file. Its create function, registered by SamLawRegister(), sets the methods that it needs:

      static PetscErrorCode Create(SamLaw law)
      {
        law->ops.declare = Declare;
        law->ops.advance = Advance;
        return PETSC_SUCCESS;
      }

  What it remembers it declares in the state of a contact, once; it finds its fields there by name. In a step the
  methods are called in this order: check(), begin(), offset(), separation() and limit() of all laws, the normal
  problem, bound(), the tangential problem, offset() for the check, advance().
*/
#ifndef PETSAM_LAWIMPL_H
#define PETSAM_LAWIMPL_H

#include <petsam/private/baseimpl.h>
#include <petsam/balance.h>
#include <petsam/law.h>
#include <petsam/private/grid.h>

/*
  SamStrain - a tangential displacement that is linear in place: a point at (x, y) moves by (xx x + xy y, xy x + yy y)
  m.
*/
typedef struct {
  PetscReal xx, yy, xy;
} SamStrain;

/* What a bound of the shear depends on. */
typedef struct {
  SamState          state;    /* of the contact; NULL: nothing is remembered */
  const SamControl *control;  /* of the step, from which laws read their conditions; NULL: all as usual */
  Vec               pressure; /* Pa */
  Vec               slip;     /* m: length of the slip of this step, in each cell; NULL: none. Of a motion that does not
                               continue a step, in 1 m of rolled distance */
  PetscReal         rolled;   /* m: rolled distance of the step (SamProblemGetRolled()) */
} SamBoundAt;

/*
  A bound (Pa), and its derivatives by the pressure (1) and by the length of the slip (Pa/m), each a field of one
  component; what is NULL is not wanted, and by_slip is wanted with the value only. The first law fills them, each law
  after it changes them.
*/
typedef struct {
  Vec value, by_pressure, by_slip;
} SamBound;

/*
  The contact of a step, for a law whose state follows from the tractions, and whose offset in turn changes these.
  `solve` solves it with the offset of the tried state, from the last tractions on; `solved`: it has a solution.
  Collective.
*/
typedef struct _n_SamLawContact SamLawContact;
struct _n_SamLawContact {
  SamState          state;
  const SamBalance *normal, *tangential;
  Vec               pressure, shear, bound; /* Pa: the last solution */
  char              failed[128];            /* to be set where the law finds none: why */
  PetscErrorCode (*solve)(SamLawContact *contact, PetscBool *solved);
  void *context;
};

/* A step that is solved, for laws to advance their tried state. */
typedef struct _n_SamLawStep SamLawStep;
struct _n_SamLawStep {
  SamGrid           grid;
  SamState          state;
  SamElasticity     elasticity;
  const SamControl *control;
  PetscReal         rolled;          /* m: rolled distance of the step (SamProblemGetRolled()) */
  Vec               pressure, shear; /* Pa */
  Vec               last[2];         /* those of the step before, NULL: none */
  Vec               bound;           /* Pa, of the shear */
  const PetscReal  *rigid;           /* m, rad: the displacements of the step, by SamComponent */
  PetscBool         known_pressure;  /* the pressure is that of an earlier step on the same gap, which it yielded to */
  char              failed[128];     /* to be set by a law whose check of the step fails: why */
  PetscBool         moves;           /* to be set by a law that changes the separation, so that the pressure changes */
  /* made when first needed, by SamLawStepGetFriction(); the step's own */
  Vec path, pressed, work;
  /* from the contact; collective */
  PetscErrorCode (*friction)(SamLawStep *step, Vec path, Vec pressed, Vec work);
  PetscErrorCode (*gap)(SamLawStep *step, Vec gap);           /* m, of the surfaces as they were before the step */
  PetscErrorCode (*slope)(SamLawStep *step, Vec by_pressure); /* the derivative of the bound by the pressure */
  void *context;
};
/*
  SamLawStepGetFriction - what friction does in the step: the fields of SamContactComputeFriction(), NULL for one that
  is not wanted; borrowed. Collective.
  SamLawAddToSum - the tried generation of a field becomes the committed one plus `more`. Collective.
*/
PETSC_EXTERN PetscErrorCode SamLawStepGetFriction(SamLawStep *step, Vec *path, Vec *pressed, Vec *work);
PETSC_INTERN PetscErrorCode SamLawAddToSum(SamState state, const char name[], Vec more);
/*
  The frames of both bodies (frames.c). Under a point x of the grid, which goes with body 1, lies the point x + D of
  body 2, D being the slide (m). A field of body 2 is kept at the points that lie under the cells at D = 0. The numbers
  are those of the state, in this order, which the law slide declares: D and what has been rolled, the slider (m) and
  its longest stretch (m).
  SamFramesGetSlide - D of a generation, of SAM_TRIED without a try the committed one; FALSE: the surfaces do not slide,
  and D = 0. SamFramesSetSlide - of the committed one, if they do. SamFramesRewind - takes a distance (m) off D, and off
  what it follows, of a generation. Not collective.
  SamFramesGetOffset - how far from the cells the points of a body, 0 or 1, lie in it that are under the grid as it is
  now: by what the contact has rolled over both, in the second body by the slide of the generation, too; FALSE: the
  surfaces do not slide. Not collective.
  SamFramesRead - what the cells see of a field that is kept at a body's own points, by its offset; outside of the grid
  it is zero, or its period. SamFramesReadBeyond - with another value outside. SamFramesWrite - the transpose: from
  cells to the body's points, with the same sum. Other vectors, of one component. Collective.
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
  SamLawListWords - appends the words of an option that selects laws, each behind `between`. Collective.
  SamLawOrder - the place of a type among those registered. Not collective.
*/
PETSC_INTERN PetscErrorCode SamLawListWords(SamElasticity elasticity, const char option[], const char between[],
                                            char words[], size_t size);
PETSC_INTERN PetscInt       SamLawOrder(SamLawType type);

struct _n_SamLaw {
  PetscInt            references;
  char                type[64];
  SamElasticity       elasticity;
  SamGrid             grid;           /* of the elasticity; borrowed */
  SamConditions       conditions;     /* of the problem that has the law; NULL: none has */
  PetscObjectState    revision;       /* to be raised by setters: declarations and the pressure follow from it */
  PetscBool           always;         /* each problem has it, without being asked for */
  PetscBool           follows_slip;   /* bound() depends on the slip of the step */
  PetscBool           accumulates;    /* a sum over all steps: the field of the state that has the name of the type */
  const char         *option;         /* that selects the law, without dash; NULL: none */
  const char         *word;           /* its value that does so, as of -friction_law; NULL: the option itself does */
  const char         *heading;        /* of the options in the help; NULL: none */
  const SamOptionRow *rows;           /* its options, whose settings are `data`; */
  PetscInt            row_count;      /* how many */
  PetscInt            bytes;          /* of memory that it takes for each cell */
  PetscBool           needs_friction; /* makes no sense without friction */
  PetscBool           forbids_jumps;  /* cannot be in a life with cycle jumps */
  PetscBool           of_body[2];     /* adds to the separation what it keeps at a body's own points, if they slide */
  PetscBool           any_motion;     /* has a meaning in every motion: remembers and asks for no slip of steps */
  PetscBool           by_passages;    /* in steady rolling it acts in cycles of a life only */
  void               *data;           /* the type's own, from PetscNew(); NULL: none */
  /* all may be NULL; collective */
  struct {
    /* what the rows do not say of options and parameters; `asked` on entry: by the word */
    PetscErrorCode (*setfromoptions)(SamLaw law, const SamOptions *from, PetscBool *asked);
    PetscErrorCode (*addparameters)(SamLaw law, SamParameters *parameters);
    PetscErrorCode (*destroy)(SamLaw law); /* frees what `data` refers to; SamLawDestroy() frees `data` itself */
    /* adds what a step may prescribe for the law, which keeps SamConditionsAdd()'s own; once, when a problem gets it */
    PetscErrorCode (*conditions)(SamLaw law, SamConditions conditions);
    /*
      Refuses values of its conditions that make no sense, and sets those that follow from others: `wrong` is the first
      refused condition, and `why` says what is wrong with its value; empty: nothing.
    */
    PetscErrorCode (*check)(SamLaw law, SamControl *control, const SamCondition **wrong, char why[], size_t size);
    /* declares fields and numbers; again when the law's revision has been raised */
    PetscErrorCode (*declare)(SamLaw law, SamState state);
    /*
      Before a step is solved: the law's tried state, from which its offset in the step follows. `duration`: the time of
      the step minus that of the step before, s; 0 in the first one. A law whose offset changes raises its revision.
    */
    PetscErrorCode (*begin)(SamLaw law, SamState state, const SamControl *control, PetscReal duration);
    /*
      Adds what displaces the surfaces in a step besides the tractions, body 2 relative to body 1 (m): to u_z (one
      component) and to u_t (two components), where they are not NULL. It must follow from the control and the state
      alone, as the independent check evaluates it, too. The displacements of a solution contain it, those of the step
      before as well, so that gap, slip and what is derived from them need no more. `adds` (unless NULL) is set where it
      is not zero; else left as it is.
    */
    PetscErrorCode (*offset)(SamLaw law, SamState state, const SamControl *control, Vec u_z, Vec u_t, PetscBool *adds);
    /*
      Adds the linear part of such a tangential displacement, which is no part of u_t: it is evaluated row by row, takes
      no field, and follows the bodies when they roll.
    */
    PetscErrorCode (*strain)(SamLaw law, const SamControl *control, SamStrain *strain);
    /*
      Adds its stress in body 0 or 1 at a depth (m) in a step, where it is uniform along the surface: Pa, by
      SamStressComponent.
    */
    PetscErrorCode (*stress)(SamLaw law, const SamControl *control, PetscInt body, PetscReal depth, double stress[]);
    /*
      Adds to a separation (m, one component) what the law has put between the bodies: SAM_COMMITTED: from which the
      next step starts; SAM_TRIED: with which the last solution has its gap, the tried one, or else the committed one.
      h NULL: only sets `adds`, whether there is any.
    */
    PetscErrorCode (*separation)(SamLaw law, SamState state, SamGeneration generation, Vec h, PetscBool *adds);
    /*
      After the contact is solved: the law's tried state, and the tractions with its offset. Of one law of a problem.
    */
    PetscErrorCode (*follow)(SamLaw law, SamLawContact *contact);
    /* the largest pressure that the surfaces bear, Pa */
    PetscErrorCode (*limit)(SamLaw law, PetscReal *most);
    /* the largest shear of each cell; `has`: whether any cell bears shear */
    PetscErrorCode (*bound)(SamLaw law, const SamBoundAt *at, const SamBound *bound);
    /* the coefficient of friction, 0 where a field counts; `has` (or NULL): any is above 0, which is collective */
    PetscErrorCode (*friction)(SamLaw law, PetscReal *uniform, PetscBool *has);
    /* adds by how much the bodies overlap in the tried step where they bear no more, m; or NULL */
    PetscErrorCode (*overlap)(SamLaw law, SamState state, Vec overlap);
    /* the law's tried state, and numbers of the step */
    PetscErrorCode (*advance)(SamLaw law, SamLawStep *step);
    /* prints the law's numbers of a step, on a line of its own */
    PetscErrorCode (*view)(SamLaw law, SamState state, PetscViewer viewer);
    /* a warning about a solved step; empty: none */
    PetscErrorCode (*advise)(SamLaw law, SamState state, char text[], size_t size);
  } ops;
};

/*
  The laws that come with the library, in the order in which they act (laws/register.c); SamInitialize() registers them.
*/
PETSC_INTERN PetscErrorCode SamLawRegisterAll(void);
PETSC_INTERN PetscErrorCode SamLawCreate_Coulomb(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_BulkStress(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_Bodies(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_Friction(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_Slide(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_Archard(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_Energy(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_Hardness(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_Plastic(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_AccumulatedSlip(SamLaw law);
PETSC_INTERN PetscErrorCode SamLawCreate_FrictionEnergy(SamLaw law);

/*
  The thickness, over the half width of the contact, of the layer in which a body yields first, from which on the
  maximum plastic strain is more than 4 % too small.
*/
#define SAM_PLASTIC_THICK 0.2

#endif
