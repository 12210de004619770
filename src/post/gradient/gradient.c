/*
  Derivatives of a number of a load history by all parameters, by one pass back over its steps.

  Step k has the pressure p, the shear q, the rigid displacements d, the bound b = mu p, the slip v = C q + X p - t d +
  stretch and the gap g = S p + X'q + h + wear - n d. The sets of cells that are open, stick and slip are frozen; e =
  q/|q|, n_e is normal to it, ds = v_k - v_(k-1) and L = |ds|/b. With V, the derivative by v_k of what comes later, and
  c_p, c_q, c_d, those of the number by p, q, d of the step, the cotangents gamma of the gap, tau = V - lambda of the
  slip and beta of the bound solve
      r = c_q + C tau + X gamma - t nu_t dA,   stick r = 0,   slip n_e.r = L n_e.lambda, lambda along n_e,
      beta = e.r,   contact c_p + S gamma + X'tau + mu beta - n nu_n dA = 0,   given loads n.gamma = c_d, t.tau = c_d,
  whose matrix is the transposed one of the step's linear response (solvers/frozen), with a border of the given loads.
  Step k leaves lambda - dJ/d(ds) for V of the step before. Derivatives are read off the cotangents: by the gap gamma,
  by friction p beta, by given loads nu, by given displacements -n.gamma and -t.tau, by a stretch tau (x, y), by the
  moduli the products of the cotangents with those of the tractions for other constants. Wear adds its depth to the gap
  of later steps. Similar bodies have two systems, that of the shear first; steps of one pressure share the second one
  (gradientimpl.h, SamShared).

  The work of friction, and wear, weigh the pressures before and after a step as the contact does
  (contact/solution/gapandslip.c); these weights have derivatives, too.
*/
#include "gradientimpl.h"
#include <petsam/private/body.h>
#include <petsam/private/contact.h>
#include <petsam/private/control.h>
#include <petsam/private/frozen.h>
#include <petsam/private/law.h>
#include <petsam/private/lawimpl.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/problem.h>
#include <petsam/private/solverimpl.h>
#include <petsam/private/state.h>
#include <petsam/solution.h>
#include <math.h>

/* Tolerance of the tangential problem from which on the sets of cells are not those of the solution: the field of
   derivatives is 12 % wrong at 1e-4 */
#define LEAST_RTOL 1e-5
#define ERRORS     10 /* slip below so many tolerances is the solver's error */

/* ---- the object ---- */

/* Adds the coefficients of wear of a law; refuses laws whose derivative is not computed. */
static PetscErrorCode CheckLaw(SamGradient g, SamLaw law)
{
  static const char *const known[]  = {SAM_LAW_COULOMB,        SAM_LAW_BULK_STRESS, SAM_LAW_BODIES,
                                       SAM_LAW_ARCHARD,        SAM_LAW_ENERGY,      SAM_LAW_ACCUMULATED_SLIP,
                                       SAM_LAW_FRICTION_ENERGY};
  PetscBool                is_known = PETSC_FALSE;
  SamParameters            parameters;

  PetscFunctionBegin;
  for (size_t k = 0; k < sizeof(known) / sizeof(known[0]); k++)
    if (!strcmp(law->type, known[k])) is_known = PETSC_TRUE;
  PetscCheck(is_known, law->grid->comm, SAM_ERR_USER, "the gradient with -%s: its derivative is not computed: omit it",
             law->option ? law->option : law->type);
  if (strcmp(law->type, SAM_LAW_ARCHARD) && strcmp(law->type, SAM_LAW_ENERGY)) PetscFunctionReturn(PETSC_SUCCESS);
  parameters.count = 0;
  PetscCall(SamLawAddParameters(law, &parameters));
  for (PetscInt k = 0; k < parameters.count; k++)
    for (PetscInt n = 0; n < SAM_GRADIENT_WEARS; n++) {
      const char *wear = SamGradientNumber(g, n);

      if (!strncmp(parameters.list[k].name, wear, strlen(wear))) g->rate[n] += parameters.list[k].value[0];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Check(SamGradient g)
{
  const SamProblem problem = SamContactGetProblem(g->contact);
  const MPI_Comm   comm    = SamContactGetGrid(g->contact)->comm;
  const SamLaw    *laws;
  PetscInt         count;

  PetscFunctionBegin;
  PetscCheck(!SamContactGetMotion(g->contact)->streams && SamContactGetMotion(g->contact)->continues, comm,
             SAM_ERR_USER, "the gradient with -rolling: its derivative is not computed: omit it");
  PetscCheck(SamContactGetSettings(g->contact).coupling, comm, SAM_ERR_USER,
             "the gradient with -coupling none: expected full coupling of pressure and shear");
  PetscCheck(((SamSolver)SamContactGetTangential(g->contact))->rtol <= LEAST_RTOL, comm, SAM_ERR_USER,
             "the gradient with -tangential_rtol %.6g: cells that stick are not certain: expected at most %.6g",
             (double)((SamSolver)SamContactGetTangential(g->contact))->rtol, LEAST_RTOL);
  PetscCall(SamProblemGetLaws(problem, &count, &laws));
  for (PetscInt k = 0; k < count; k++) PetscCall(CheckLaw(g, laws[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamGradientSetMemory(SamGradient g, PetscReal bytes)
{
  int ranks;

  (void)MPI_Comm_size(SamContactGetGrid(g->contact)->comm, &ranks);
  g->limit = (double)bytes / ranks;
}

PetscErrorCode SamGradientCreate(SamContact contact, SamGap shape, SamGradient *gradient)
{
  SamGradient    g;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *gradient = NULL;
  PetscCall(PetscNew(&g));
  g->contact = contact;
  g->shape   = shape;
  g->still   = PetscMin(ERRORS * ((SamSolver)SamContactGetTangential(contact))->rtol, SAM_FROZEN_STILL);
  ierr       = Check(g);
  if (ierr) PetscCall(SamGradientDestroy(&g));
  PetscCall(ierr);
  *gradient = g;
  SamContactSetSettles(contact, PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ClearFound(SamDerivatives *d)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&d->gap));
  PetscCall(VecDestroy(&d->friction));
  PetscCall(PetscFree3(d->load, d->rigid, d->bulk));
  *d = (SamDerivatives){.borders = 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientDestroy(SamGradient *gradient)
{
  SamGradient g;

  PetscFunctionBegin;
  if (!*gradient) PetscFunctionReturn(PETSC_SUCCESS);
  g = *gradient;
  SamGradientForget(g);
  SamContactSetSettles(g->contact, PETSC_FALSE);
  PetscCall(PetscFree(g->record));
  PetscCall(PetscFree(g->jump));
  PetscCall(ClearFound(&g->found));
  PetscCall(PetscFree(*gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamGradientForget(SamGradient g)
{
  while (g->count > 0) (void)SamRecordDestroy(&g->record[--g->count]);
  while (g->jumps > 0) (void)SamJumpDestroy(&g->jump[--g->jumps]);
  g->rows = g->cycle = 0;
  (void)VecDestroy(&g->friction);
  (void)VecDestroy(&g->touched);
  SamStoreForget(g);
}

PetscInt SamGradientGetSteps(SamGradient g)
{
  return g->found.count;
}

PetscErrorCode SamGradientBeginLife(SamGradient g, PetscInt rows, PetscInt cycle, const SamLifeSettings *set)
{
  const MPI_Comm comm = SamContactGetGrid(g->contact)->comm;

  PetscFunctionBegin;
  PetscCheck(set->fixed, comm, SAM_ERR_USER,
             "the gradient of a wear simulation: the lengths of its jumps depend on the parameters: give -wear_jump");
  PetscCheck(!set->magnified, comm, SAM_ERR_USER,
             "the gradient of a wear simulation whose surfaces slide is not computed");
  PetscCheck(g->rate[0] == 0 || g->rate[1] == 0, comm, SAM_ERR_USER,
             "the gradient of a wear simulation: expected one law of wear");
  PetscCheck(g->count == 0, comm, PETSC_ERR_ORDER,
             "the gradient of a wear simulation: steps have been recorded before it: begin after a reset");
  g->rows  = rows;
  g->cycle = cycle;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamRecord *SamGradientOfRow(SamGradient g, PetscInt row)
{
  PetscInt k = 0;

  while (g->rows > 0 && k < g->count - 1 && g->record[k].row != row) k++;
  return &g->record[g->rows > 0 ? k : row];
}

/* ---- the pass back ---- */

/* Selects the part of the grid that has the contacts of all steps. */
static PetscErrorCode ChoosePart(SamBack *b)
{
  const SamGradient   g     = b->g;
  const SamGrid       whole = SamContactGetGrid(g->contact);
  const SamElasticity e     = SamProblemGetElasticity(SamContactGetProblem(g->contact));
  PetscInt            first[2], n[2];
  double             *touched;
  Vec                 all;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(g->touched, &all));
  PetscCall(VecCopy(g->touched, all));
  PetscCall(VecGetArray(all, &touched));
  for (PetscInt k = 0; k < g->jumps; k++) {
    const double *p;

    PetscCall(VecGetArrayRead(g->jump[k].field[SAM_JUMP_PRESSURE], &p));
    for (PetscInt m = 0; m < whole->cells; m++) touched[m] = p[m] > 0 ? 1 : touched[m];
    PetscCall(VecRestoreArrayRead(g->jump[k].field[SAM_JUMP_PRESSURE], &p));
  }
  PetscCall(VecRestoreArray(all, &touched));
  PetscCall(SamGridGetSupport(whole, all, PETSC_FALSE, first, n));
  PetscCall(VecDestroy(&all));
  PetscCheck(n[0] > 0, whole->comm, SAM_ERR_USER, "the gradient: there is no contact in any step of the history");
  PetscCall(SamElasticityChoosePart(e, first, n, PETSC_FALSE, &b->window, &b->elasticity));
  if (!b->window) b->elasticity = e;
  b->grid    = SamElasticityGetGrid(b->elasticity);
  b->coupled = SamElasticityGetTraits(e).coupled;
  b->shares  = !b->coupled && SamChoiceAllowsSharing(b->g) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PutArray(SamBack *b, const double array[], Vec *whole)
{
  double *values;
  Vec     part;

  PetscFunctionBegin;
  PetscCall(SamGridCreateVec(b->grid, 1, &part));
  PetscCall(VecGetArrayWrite(part, &values));
  PetscCall(PetscArraycpy(values, array, b->grid->cells));
  PetscCall(VecRestoreArrayWrite(part, &values));
  PetscCall(SamGridCreateVec(SamContactGetGrid(b->g->contact), 1, whole));
  PetscCall(b->window ? SamWindowPut(b->window, part, *whole) : VecCopy(part, *whole));
  PetscCall(VecDestroy(&part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the tractions of a step, for objectives that need other steps than the present one. */
static PetscErrorCode ReadStep(void *context, PetscInt step, Vec tractions, const PetscReal **bulk)
{
  SamRecord *const r     = &((SamGradient)context)->record[step];
  const PetscInt   cells = SamContactGetGrid(((SamGradient)context)->contact)->cells;
  double          *to;

  PetscFunctionBegin;
  PetscCall(SamStoreTake((SamGradient)context, r));
  PetscCall(VecZeroEntries(tractions));
  PetscCall(VecGetArray(tractions, &to));
  for (PetscInt c = 0; c < 3; c++) /* pressure and shear are the first values */
    for (PetscInt m = 0; m < r->count; m++) to[c * cells + r->cell[m]] = r->value[m + c * r->count];
  PetscCall(VecRestoreArray(tractions, &to));
  PetscCall(SamStoreLeave(r));
  *bulk = r->bulk;
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { ARRAYS = 23 }; /* fields of one component that a pass needs besides those of the steps */

/* Gives a wear simulation its arrays, to be freed with PetscFree(). */
static PetscErrorCode BeginLife(SamBack *b, double **arrays)
{
  const PetscInt cells = (PetscInt)PetscMax(b->grid->cells, 1);
  SamLifeBack   *life  = &b->life;
  double **const one[] = {&life->by_worn,  &life->by_start, &life->by_whole, &life->by_wear, &life->by_mean,
                          &life->by_shift, &life->by_slip,  &life->touches,  &life->load};
  enum { COUNT = sizeof(one) / sizeof(one[0]) };

  PetscFunctionBegin;
  *arrays    = NULL;
  life->left = b->g->jumps;
  if (!b->g->jumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(COUNT * cells, arrays));
  for (int k = 0; k < COUNT; k++) *one[k] = *arrays + k * cells;
  PetscCall(SamBackGetLoad(b, life->load));
  b->at.load = life->load;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(SamBack *b, double **arrays)
{
  const PetscInt         cells = (PetscInt)PetscMax(b->grid->cells, 1);
  SamObjectiveStep      *at    = &b->at;
  double                *next;
  double **const         one[] = {&b->friction, &b->worn,        &b->gamma,          &b->beta,
                                  &b->by_gap,   &b->by_friction, &at->by_pressure,   &at->by_pressure_before,
                                  &at->by_worn, &b->ahead,       &b->entered.by_gap, &b->entered.by_friction},
                 **const two[] = {&b->later, &b->tau, &at->by_shear, &at->by_slip, &at->by_shear_before};

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(ARRAYS * cells, arrays));
  next = *arrays;
  for (size_t k = 0; k < sizeof(one) / sizeof(one[0]); k++, next += cells) *one[k] = next;
  for (size_t k = 0; k < sizeof(two) / sizeof(two[0]); k++, next += 2 * cells) *two[k] = next;
  at->by_friction = b->by_friction;
  at->friction    = b->friction;
  at->grid        = b->grid;
  at->area        = (double)(b->grid->dx * b->grid->dy);
  at->rate        = b->g->rate;
  at->elasticity  = SamProblemGetElasticity(SamContactGetProblem(b->g->contact));
  at->window      = b->window;
  at->read        = ReadStep;
  at->context     = b->g;
  PetscCall(SamBackTake(b, b->g->friction, b->friction));
  PetscCall(SamGridCreateVec(SamContactGetGrid(b->g->contact), SAM_RECORD_VALUES, &b->whole));
  for (int k = 0; k < 2; k++)
    PetscCall(SamGridCreateVec(b->grid, SAM_RECORD_VALUES, &(k ? &b->now : &b->before)->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes another step the present one. */
static PetscErrorCode Select(SamBack *b, PetscInt k, PetscInt64 end[2])
{
  SamRecord *const     r     = &b->g->record[k];
  const ptrdiff_t      cells = b->grid->cells;
  const SamFrameOfStep now   = b->before;
  SamObjectiveStep    *at    = &b->at;

  PetscFunctionBegin;
  b->before = b->now;
  b->now    = now;
  PetscCall(SamRecordUnpack(b, k > 0 ? r - 1 : NULL, &b->before));
  at->step            = k;
  at->pressure        = now.value + SAM_RECORD_PRESSURE * cells;
  at->shear           = now.value + SAM_RECORD_SHEAR * cells;
  at->slip            = now.value + SAM_RECORD_SLIP * cells;
  at->share           = now.value + SAM_RECORD_SHARE * cells;
  at->by_back         = now.value + SAM_RECORD_BY_BACK * cells;
  at->by_alike        = now.value + SAM_RECORD_BY_ALIKE * cells;
  at->pressure_before = b->before.value + SAM_RECORD_PRESSURE * cells;
  at->shear_before    = b->before.value + SAM_RECORD_SHEAR * cells;
  for (PetscInt i = 0; i < 2; i++) end[i] = SamBackPlace(b, r->end[i]);
  at->end    = end;
  at->by_end = r->by_end;
  at->rigid  = r->rigid;
  at->bulk   = r->bulk;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves what has been added to the step before to the present step. */
static PetscErrorCode Pass(SamBack *b)
{
  SamObjectiveStep *at    = &b->at;
  const PetscInt    cells = b->grid->cells;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(at->by_pressure, at->by_pressure_before, cells));
  PetscCall(PetscArraycpy(at->by_shear, at->by_shear_before, 2 * cells));
  PetscCall(PetscArrayzero(at->by_pressure_before, cells));
  PetscCall(PetscArrayzero(at->by_shear_before, 2 * cells));
  PetscCall(PetscArrayzero(at->by_slip, 2 * cells));
  PetscCall(PetscArrayzero(at->by_worn, cells));
  PetscCall(PetscArraycpy(at->by_rigid, b->by_rigid_before, SAM_COMPONENTS));
  PetscCall(PetscArraycpy(b->by_load, b->by_load_before, SAM_COMPONENTS));
  PetscCall(PetscArraycpy(b->strain, b->strain_before, 3));
  PetscCall(PetscArrayzero(b->by_rigid_before, SAM_COMPONENTS));
  PetscCall(PetscArrayzero(b->by_load_before, SAM_COMPONENTS));
  PetscCall(PetscArrayzero(b->strain_before, 3));
  PetscCall(PetscArrayzero(b->kappa, 2));
  PetscCall(PetscArrayzero(b->entered.by_gap, cells));
  PetscCall(PetscArrayzero(b->entered.by_friction, cells));
  b->entered    = (SamEntered){.by_gap = b->entered.by_gap, .by_friction = b->entered.by_friction};
  b->by_modulus = 0;
  PetscCall(PetscArrayzero(at->by_bulk, SAM_GRADIENT_BULKS));
  PetscCall(PetscArrayzero(at->by_moduli, SAM_GRADIENT_MODULI));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the derivatives what the present step wears, whose depth is in the gap of all later steps. */
static PetscErrorCode Wear(SamBack *b)
{
  SamObjectiveStep *at    = &b->at;
  const PetscReal  *rate  = b->g->rate;
  const PetscInt    nx    = b->grid->nx;
  SamTotal          by[2] = {{0}};
  double           *rubbed, *factor, sums[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < b->grid->cells; k++) b->worn[k] += at->by_worn[k];
  if (b->g->cycle > 0) PetscFunctionReturn(PETSC_SUCCESS); /* jumps wear, not steps */
  PetscCall(PetscMalloc2(b->grid->cells, &rubbed, b->grid->cells, &factor));
  SamBackRubbed(at, rubbed);
  for (PetscInt j = 0; j < b->grid->rows; j++) {
    double row[2] = {0, 0};

    for (PetscInt k = j * nx; k < (j + 1) * nx; k++) {
      const double mu = b->friction[k];

      factor[k] = b->worn[k] * (rate[0] + rate[1] * mu);
      row[0] += b->worn[k] * rubbed[k];
      row[1] += b->worn[k] * mu * rubbed[k];
      b->by_friction[k] += b->worn[k] * rate[1] * rubbed[k];
    }
    SamAddAll(2, by, row);
  }
  if (rate[0] != 0 || rate[1] != 0) PetscCall(SamBackAddRubbed(at, factor));
  PetscCall(SamSumTotals(b->grid->comm, 2, by, sums));
  for (PetscInt n = 0; n < 2; n++) b->g->found.wear[n] += sums[n];
  PetscCall(PetscFree2(rubbed, factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates bodies with other constants, for the parts of the products that are proportional to one of them
   (readoff.c). */
static PetscErrorCode CreateOther(SamBack *b)
{
  SamPair other;

  PetscFunctionBegin;
  PetscCall(SamPairCreateOther(SamElasticityGetPair(b->elasticity), &other));
  PetscCall(SamElasticityCreateOfPair(b->elasticity, other, &b->other));
  PetscCall(SamPairDestroy(&other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the derivative by friction to NaN in cells without friction: how they would slip has not been recorded. */
static PetscErrorCode ClearWithoutFriction(SamGradient g)
{
  const double *mu;
  double       *by;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(g->friction, &mu));
  PetscCall(VecGetArray(g->found.friction, &by));
  for (PetscInt k = 0; k < SamContactGetGrid(g->contact)->cells; k++)
    if (!(mu[k] > 0)) by[k] = NAN;
  PetscCall(VecRestoreArray(g->found.friction, &by));
  PetscCall(VecRestoreArrayRead(g->friction, &mu));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Passes back over the steps, and gets the results. */
static PetscErrorCode GoBack(SamBack *b, const SamObjective *objective)
{
  SamDerivatives *found = &b->g->found;
  PetscInt64      end[2];

  PetscFunctionBegin;
  PetscCall(SamRecordUnpack(b, &b->g->record[b->g->count - 1], &b->before));
  for (PetscInt k = b->g->count - 1; k >= 0; k--) {
    PetscCall(SamBackPassJumps(b, k + 1));
    PetscCall(Pass(b));
    PetscCall(Select(b, k, end));
    PetscCall(SamBackAddCycle(b, k));
    PetscCall((*objective->add)(&b->at));
    PetscCall(Wear(b));
    PetscCall(SamBackSolve(b, k));
    PetscCall(SamBackRead(b, k));
    if (b->g->record[k].grows) PetscCall(SamBackLeaveEntered(b, k));
  }
  found->value = b->at.number;
  if (isnan(b->at.number)) PetscCall(SamSumTotals(b->grid->comm, 1, &b->at.value, &found->value));
  PetscCall(PutArray(b, b->by_gap, &found->gap));
  PetscCall(PutArray(b, b->by_friction, &found->friction));
  PetscCall(ClearWithoutFriction(b->g));
  if (SamChoiceHasShape(b->g, found->of)) PetscCall(SamChoiceAddShape(b->g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(SamBack *b, const SamObjective *objective)
{
  double        *arrays, *of_life;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(ChoosePart(b));
  b->at.moduli = SamChoiceHasModuli(b->g, b->g->found.of);
  if (b->at.moduli) PetscCall(CreateOther(b));
  PetscCall(Begin(b, &arrays));
  PetscCall(BeginLife(b, &of_life));
  ierr = GoBack(b, objective);
  if (objective->end && b->at.data) PetscCall((*objective->end)(b->at.data));
  for (int k = 0; k < 2; k++) {
    SamFrameOfStep *frame = k ? &b->now : &b->before;

    if (frame->value) PetscCall(VecRestoreArrayRead(frame->field, &frame->value));
    PetscCall(VecDestroy(&frame->field));
  }
  for (PetscInt k = 0; k < b->shared.count; k++) PetscCall(PetscFree(b->shared.by_right[k])); /* after an error */
  PetscCall(VecDestroy(&b->whole));
  PetscCall(SamElasticityDestroy(&b->other));
  PetscCall(PetscFree(arrays));
  PetscCall(PetscFree(of_life));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that a number is not given itself in a step whose loads `force` are, and that these bodies have it. */
static PetscErrorCode CheckComponent(SamElasticity e, const char name[], const PetscBool force[], PetscInt *component)
{
  const SamElasticityTraits traits = SamElasticityGetTraits(e);
  const MPI_Comm            comm   = SamElasticityGetGrid(e)->comm;

  PetscFunctionBegin;
  *component = -1;
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    const PetscBool load = strcmp(name, SamComponentNames[c].load) ? PETSC_FALSE : PETSC_TRUE;

    if (!load && strcmp(name, SamComponentNames[c].rigid)) continue;
    *component = c;
    PetscCheck(force[c] != load, comm, SAM_ERR_USER, "the gradient of %s: it is given: take %s", name,
               load ? SamComponentNames[c].rigid : SamComponentNames[c].load);
    PetscCheck(!traits.periodic || c == SAM_COMPONENT_TX || c == SAM_COMPONENT_TY ||
                 (c == SAM_COMPONENT_N && (load || traits.mean)),
               comm, SAM_ERR_USER, "the gradient of %s: periodic bodies have no such number: take disp_x or energy",
               name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientCheck(SamGradient g, const char name[], const PetscBool force[], const char of[],
                                PetscInt *component)
{
  const SamElasticity e    = SamProblemGetElasticity(SamContactGetProblem(g->contact));
  const MPI_Comm      comm = SamContactGetGrid(g->contact)->comm;
  SamPairConstants    constants;
  const char         *none;
  const SamObjective *objective;

  PetscFunctionBegin;
  PetscCall(SamObjectiveFind(comm, name, &objective));
  PetscCall(CheckComponent(e, name, force, component));
  if (objective->check) PetscCall((*objective->check)(e, g->rate, name));
  PetscCall(SamChoiceCheck(g, of));
  if (!SamChoiceHasModuli(g, of)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(g->cycle == 0, comm, SAM_ERR_USER,
             "the gradient by the moduli in a wear simulation is not computed: leave the moduli out");
  none = SamPairGetConstants(SamElasticityGetPair(e), &constants);
  if (SamElasticityGetTraits(e).patch) none = "the bodies are finite";
  PetscCheck(!none, comm, SAM_ERR_USER, "the gradient by the moduli is not computed, as %s: leave the moduli out",
             none);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientGetBytes(MPI_Comm comm, const char name[], PetscInt bytes[3])
{
  const SamObjective *objective;

  PetscFunctionBegin;
  PetscCall(SamObjectiveFind(comm, name, &objective));
  PetscCall(PetscArraycpy(bytes, objective->bytes, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientCompute(SamGradient g, const char name[], const PetscInt steps[2], const char of[],
                                  PetscReal rtol)
{
  SamBack             b    = {.g = g, .rtol = rtol};
  SamDerivatives     *d    = NULL;
  const MPI_Comm      comm = SamContactGetGrid(g->contact)->comm;
  const SamObjective *objective;
  PetscInt            begin;

  PetscFunctionBegin;
  d = &g->found;
  PetscCall(SamObjectiveFind(comm, name, &objective));
  PetscCheck(g->count > 0, comm, SAM_ERR_USER, "the gradient of %s: no step has been recorded", name);
  begin      = g->cycle > 0 ? g->count - g->cycle : 0;
  b.at.last  = steps[1] < 0 ? g->count - 1 : begin + steps[1];
  b.at.first = steps[0] < 0 ? objective->all ? begin : b.at.last : begin + steps[0];
  PetscCheck(b.at.first <= b.at.last && b.at.last < g->count, comm, SAM_ERR_USER,
             "the gradient of %s: steps %" PetscInt_FMT " to %" PetscInt_FMT
             ": expected steps from 0 to %" PetscInt_FMT,
             name, b.at.first - begin, b.at.last - begin, g->count - 1 - begin);
  for (PetscInt k = b.at.first; k <= b.at.last; k++)
    PetscCall(SamGradientCheck(g, name, g->record[k].force, of, &b.at.component));
  b.at.number = NAN;
  b.at.name   = name;
  PetscCall(ClearFound(d));
  d->count = g->rows > 0 ? g->rows : g->count;
  PetscCall(PetscCalloc3(d->count, &d->load, d->count, &d->rigid, d->count, &d->bulk));
  (void)snprintf(d->name, sizeof(d->name), "%s", name);
  (void)snprintf(d->unit, sizeof(d->unit), "%s",
                 objective->unit_of_row && SamGridIsRow(SamContactGetGrid(g->contact))
                   ? objective->unit_of_row
                   : SamUnitOn(SamContactGetGrid(g->contact), objective->unit));
  (void)snprintf(d->of, sizeof(d->of), "%s", of);
  PetscCall(Run(&b, objective));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the results ---- */

static PetscErrorCode CheckFound(SamGradient g)
{
  PetscFunctionBegin;
  PetscCheck(g->found.gap, SamContactGetGrid(g->contact)->comm, PETSC_ERR_ORDER, "no gradient has been computed");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientGetField(SamGradient g, const char name[], Vec field)
{
  const PetscBool gap = strcmp(name, "gap") ? PETSC_FALSE : PETSC_TRUE;
  SamGrid         grid;

  PetscFunctionBegin;
  grid = SamContactGetGrid(g->contact);
  PetscCheck(gap || !strcmp(name, "friction"), grid->comm, SAM_ERR_USER,
             "the gradient by the field %s: expected gap or friction", name);
  PetscCall(CheckFound(g));
  PetscCall(SamGridCheckVec(grid, 1, field, "The field of derivatives"));
  PetscCall(VecCopy(gap ? g->found.gap : g->found.friction, field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds a derivative by a number of a row; returns NULL if the name is none. Some bodies have no rotations. */
static const double *OfStep(const SamGradient g, const char name[], PetscInt step)
{
  static const double       none   = NAN;
  const SamDerivatives     *d      = &g->found;
  const SamElasticityTraits traits = SamElasticityGetTraits(SamProblemGetElasticity(SamContactGetProblem(g->contact)));

  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    const PetscBool load = strcmp(name, SamComponentNames[c].load) ? PETSC_FALSE : PETSC_TRUE;

    if (!load && strcmp(name, SamComponentNames[c].rigid)) continue;
    if (c >= SAM_COMPONENT_MX && !traits.rotations[c - SAM_COMPONENT_MX]) return &none;
    if (load != SamGradientOfRow(g, step)->force[c]) return &none;
    return load ? &d->load[step][c] : &d->rigid[step][c];
  }
  for (PetscInt k = 0; k < SAM_GRADIENT_BULKS; k++)
    if (!strcmp(name, SamBulkName(k))) return &d->bulk[step][k];
  return NULL;
}

PetscErrorCode SamGradientGetNumber(SamGradient g, const char name[], PetscInt step, PetscReal *value)
{
  const SamDerivatives *d;
  const double         *found;
  MPI_Comm              comm;

  PetscFunctionBegin;
  comm = SamContactGetGrid(g->contact)->comm;
  d    = &g->found;
  PetscCall(CheckFound(g));
  PetscCheck(step >= 0 && step < d->count && d->count <= g->count, comm, PETSC_ERR_ARG_OUTOFRANGE,
             "step %" PetscInt_FMT " of a gradient: expected 0 to %" PetscInt_FMT ", and no new record since", step,
             d->count - 1);
  *value = NAN;
  if (!strcmp(name, "value")) *value = d->value;
  if (!strcmp(name, "residual")) *value = d->residual;
  if (!strcmp(name, "borders")) *value = (PetscReal)d->borders;
  found = OfStep(g, name, step) ? OfStep(g, name, step) : SamChoiceFind(g, name);
  if (found) *value = *found;
  PetscCheck(found || !isnan(*value), comm, SAM_ERR_USER, "the gradient by %s: there is no derivative by it", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a line of text ---- */

enum {
  SHARES = 1 + 2 * SAM_COMPONENTS + SAM_GRADIENT_BULKS + SAM_GRADIENT_MODULI + SAM_GRADIENT_WEARS + SAM_GAP_PARAMETERS,
  TOLD   = 5
};

/* A parameter, and the relative change of the number by a relative change of the parameter */
typedef struct {
  const char *name;
  double      share;
} Share;

static PetscErrorCode ShareOfFriction(SamGradient g, double *share)
{
  const SamGrid grid  = SamContactGetGrid(g->contact);
  SamTotal      total = {0};
  const double *mu, *by;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(g->friction, &mu));
  PetscCall(VecGetArrayRead(g->found.friction, &by));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row = 0;

    for (PetscInt k = j * grid->nx; k < (j + 1) * grid->nx; k++) row += mu[k] > 0 ? mu[k] * by[k] : 0;
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArrayRead(g->found.friction, &by));
  PetscCall(VecRestoreArrayRead(g->friction, &mu));
  PetscCall(SamSumTotals(grid->comm, 1, &total, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the shares of all parameters, those of a history's column together; returns their number. */
static PetscErrorCode FindShares(SamGradient g, Share shares[SHARES], PetscInt *count)
{
  const SamDerivatives *d = &g->found;
  const char           *name;
  PetscInt              n = 1;

  PetscFunctionBegin;
  shares[0] = (Share){"friction", 0};
  if (SamChoiceHas(g, d->of, "friction")) PetscCall(ShareOfFriction(g, &shares[0].share));
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) {
    shares[n]     = (Share){SamComponentNames[c].load, 0};
    shares[n + 1] = (Share){SamComponentNames[c].rigid, 0};
    for (PetscInt k = 0; k < d->count; k++) {
      const SamRecord *r = SamGradientOfRow(g, k);

      if (!SamChoiceHas(g, d->of, shares[r->force[c] ? n : n + 1].name)) continue;
      shares[r->force[c] ? n : n + 1].share += r->force[c] ? r->load[c] * d->load[k][c] : r->rigid[c] * d->rigid[k][c];
    }
    n += 2;
  }
  for (PetscInt b = 0; b < SAM_GRADIENT_BULKS; b++, n++) {
    shares[n] = (Share){SamBulkName(b), 0};
    for (PetscInt k = 0; k < d->count && SamChoiceHas(g, d->of, shares[n].name); k++)
      shares[n].share += SamGradientOfRow(g, k)->bulk[b] * d->bulk[k][b];
  }
  for (PetscInt k = 0; (name = SamGradientNumber(g, k)); k++) {
    if (!SamChoiceHas(g, d->of, name)) continue;
    shares[n].name = name;
    PetscCall(SamChoiceGetShare(g, name, &shares[n++].share));
  }
  *count = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientDescribe(SamGradient g, char text[], size_t size)
{
  const SamDerivatives *d = &g->found;
  Share                 shares[SHARES];
  PetscInt              count = 0;
  size_t                used;

  PetscFunctionBegin;
  PetscCall(CheckFound(g));
  PetscCall(FindShares(g, shares, &count));
  used = (size_t)snprintf(text, size, "%s %.6g%s%s", d->name, (double)d->value, strcmp(d->unit, "1") ? " " : "",
                          strcmp(d->unit, "1") ? d->unit : "");
  for (PetscInt told = 0; told < TOLD && count > 0; told++) {
    PetscInt best = 0;

    for (PetscInt k = 1; k < count; k++) /* of equal ones the first, whatever their last digits are */
      if (fabs(shares[k].share) > 1.001 * fabs(shares[best].share)) best = k;
    if (!(fabs(shares[best].share) > 1e-6 * fabs((double)d->value)) || used >= size) break;
    used += (size_t)snprintf(text + used, size - used, "%s %s %+.3g %%", told ? "," : "; by 1 % more",
                             shares[best].name, shares[best].share / (double)d->value);
    shares[best].share = 0;
  }
  if (!strstr(text, "; by") && used < size)
    (void)snprintf(text + used, size - used, "; by the wanted parameters: in the results");
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *SamGradientUnit(SamGradient g)
{
  return g->found.unit;
}
