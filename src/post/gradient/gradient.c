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
#include <petsam/private/problemimpl.h>
#include <petsam/private/solverimpl.h>
#include <petsam/private/state.h>
#include <petsam/solution.h>
#include <math.h>

/* Tolerance of the tangential problem from which on the sets of cells are not those of the solution: the field of
   derivatives is 12 % wrong at 1e-4 */
#define LEAST_RTOL 1e-5
#define ERRORS     10 /* slip below so many tolerances is the solver's error */

/* ---- the object ---- */

/* Adds the laws of all types with a number by which there is a derivative: those of the contact, or new ones, which
   would act if their number were not 0. */
static PetscErrorCode AddLaws(SamGradient g)
{
  const SamProblem  problem = SamContactGetProblem(g->contact);
  const SamLawType *types;
  const SamLaw     *own;
  PetscInt          count, owned;

  PetscFunctionBegin;
  PetscCall(SamLawGetTypes(&count, &types));
  PetscCall(SamProblemGetLaws(problem, &owned, &own));
  for (PetscInt k = 0; k < count; k++) {
    SamLaw law = NULL;

    for (PetscInt m = 0; m < owned; m++)
      if (!strcmp(own[m]->type, types[k])) law = own[m];
    if (law)
      PetscCall(SamLawReference(law));
    else
      PetscCall(SamLawCreate(SamProblemGetElasticity(problem), types[k], &law));
    if (law->number && law->ops.back)
      g->law[g->laws++] = law;
    else
      PetscCall(SamLawDestroy(&law));
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
  for (PetscInt k = 0; k < count; k++) {
    PetscCheck(laws[k]->ops.back, comm, SAM_ERR_USER, "the gradient with -%s: its derivative is not computed: omit it",
               SamLawOption(laws[k]));
    PetscCheck(!SamProblemSlides(problem) || !(laws[k]->of_body[0] || laws[k]->of_body[1]), comm, SAM_ERR_USER,
               "the gradient with -slide and heights that go with a body, here by -%s: its derivative is not computed: "
               "omit one of them",
               SamLawOption(laws[k]));
  }
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
  if (!ierr) ierr = AddLaws(g);
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
  for (PetscInt k = 0; k < g->laws; k++) PetscCall(SamLawDestroy(&g->law[k]));
  PetscCall(PetscFree(g->record));
  PetscCall(ClearFound(&g->found));
  PetscCall(PetscFree(*gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamGradientForget(SamGradient g)
{
  while (g->count > 0) (void)SamRecordDestroy(&g->record[--g->count]);
  (void)SamLifeBackDestroy(&g->life);
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
  const MPI_Comm comm   = SamContactGetGrid(g->contact)->comm;
  PetscInt       acting = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < g->laws; k++) acting += g->law[k]->ops.number(g->law[k]) != 0;
  PetscCheck(acting <= 1, comm, SAM_ERR_USER, "the gradient of cycle jumps: expected one law of those with a number");
  PetscCheck(g->count == 0, comm, PETSC_ERR_ORDER,
             "the gradient of cycle jumps: steps have been recorded before them: begin after a reset");
  g->rows  = rows;
  g->cycle = cycle;
  PetscCall(SamLifeBackCreate(g->contact, cycle, set, &g->life));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientRecordJump(SamGradient g, const SamLifePart *part)
{
  PetscFunctionBegin;
  PetscCall(SamLifeBackRecord(g->life, part, g->count));
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
  Vec                 all;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(g->touched, &all));
  PetscCall(VecCopy(g->touched, all));
  if (g->life) PetscCall(SamLifeBackTouch(g->life, all));
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
  const SamGradient g     = ((SamBack *)context)->g;
  SamRecord *const  r     = &g->record[step];
  const PetscInt    cells = SamContactGetGrid(g->contact)->cells;
  double           *to;

  PetscFunctionBegin;
  PetscCall(SamStoreTake(g, r));
  PetscCall(VecZeroEntries(tractions));
  PetscCall(VecGetArray(tractions, &to));
  for (PetscInt c = 0; c < 3; c++) /* pressure and shear are the first values */
    for (PetscInt m = 0; m < r->count; m++) to[c * cells + r->cell[m]] = r->value[m + c * r->count];
  PetscCall(VecRestoreArray(tractions, &to));
  PetscCall(SamStoreLeave(r));
  *bulk = r->bulk;
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { ARRAYS = 22 }; /* fields of one component that a pass needs besides those of the steps */

static PetscErrorCode Begin(SamBack *b, double **arrays)
{
  const PetscInt         cells = (PetscInt)PetscMax(b->grid->cells, 1);
  SamBackStep           *at    = &b->at;
  double                *next;
  double **const         one[] = {&b->friction, &b->rubbed,       &b->gamma,          &b->beta,
                                  &at->by_gap,  &at->by_friction, &at->by_pressure,   &at->by_pressure_before,
                                  &at->by_worn, &at->by_open,     &b->entered.by_gap, &b->entered.by_friction},
                 **const two[] = {&b->later, &b->tau, &at->by_shear, &at->by_slip, &at->by_shear_before};

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(ARRAYS * cells, arrays));
  next = *arrays;
  for (size_t k = 0; k < sizeof(one) / sizeof(one[0]); k++, next += cells) *one[k] = next;
  for (size_t k = 0; k < sizeof(two) / sizeof(two[0]); k++, next += 2 * cells) *two[k] = next;
  at->friction   = b->friction;
  at->rubbed     = b->rubbed;
  at->grid       = b->grid;
  at->area       = (double)(b->grid->dx * b->grid->dy);
  at->elasticity = SamProblemGetElasticity(SamContactGetProblem(b->g->contact));
  at->window     = b->window;
  at->context    = b;
  at->read       = ReadStep;
  at->take       = SamBackTake;
  at->normal     = SamBackSolveNormal;
  at->open       = SamBackAddOpen;
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
  SamBackStep         *at    = &b->at;

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
  at->volume = r->volume;
  SamBackFindRubbed(at, b->rubbed);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Moves what has been added to the step before to the present step. */
static PetscErrorCode Pass(SamBack *b)
{
  SamBackStep   *at    = &b->at;
  const PetscInt cells = b->grid->cells;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(at->by_pressure, at->by_pressure_before, cells));
  PetscCall(PetscArraycpy(at->by_shear, at->by_shear_before, 2 * cells));
  PetscCall(PetscArrayzero(at->by_pressure_before, cells));
  PetscCall(PetscArrayzero(at->by_shear_before, 2 * cells));
  PetscCall(PetscArrayzero(at->by_slip, 2 * cells));
  PetscCall(PetscArraycpy(at->by_rigid, b->by_rigid_before, SAM_COMPONENTS));
  PetscCall(PetscArraycpy(at->by_load, b->by_load_before, SAM_COMPONENTS));
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

/* Lets laws add what their state in the present step depends on. In a wear simulation it is that of jumps. */
static PetscErrorCode AddLawsBack(SamBack *b)
{
  const SamGradient g = b->g;
  const SamLaw     *laws;
  PetscInt          count;

  PetscFunctionBegin;
  if (g->life) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamProblemGetLaws(SamContactGetProblem(g->contact), &count, &laws));
  for (PetscInt k = 0; k < count; k++) {
    if (laws[k]->number) continue;
    b->at.by_number = NULL;
    PetscCall(laws[k]->ops.back(laws[k], &b->at));
  }
  for (PetscInt k = 0; k < g->laws; k++) {
    b->at.by_number = &g->found.law[k];
    PetscCall(g->law[k]->ops.back(g->law[k], &b->at));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Begins with the jumps of a wear simulation, whose law of wear is the one that acts. */
static PetscErrorCode BeginLife(SamBack *b)
{
  const SamGradient g = b->g;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < g->laws; k++)
    if (g->law[k]->ops.number(g->law[k]) != 0) b->at.by_number = &g->found.law[k];
  PetscCall(SamLifeBackBegin(g->life, &b->at));
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
  SamDerivatives   *found = &b->g->found;
  const SamLifeBack life  = b->g->life;
  PetscInt64        end[2];

  PetscFunctionBegin;
  PetscCall(SamRecordUnpack(b, &b->g->record[b->g->count - 1], &b->before));
  for (PetscInt k = b->g->count - 1; k >= 0; k--) {
    if (life) PetscCall(SamLifeBackPass(life, k + 1));
    PetscCall(Pass(b));
    PetscCall(Select(b, k, end));
    if (life) PetscCall(SamLifeBackAddCycle(life, b->g->record[k].place));
    PetscCall((*objective->add)(&b->at));
    PetscCall(AddLawsBack(b));
    PetscCall(SamBackSolve(b, k));
    PetscCall(SamBackRead(b, k));
    if (b->g->record[k].grows) PetscCall(SamBackLeaveEntered(b, k));
  }
  found->value = b->at.number;
  if (isnan(b->at.number)) PetscCall(SamSumTotals(b->grid->comm, 1, &b->at.value, &found->value));
  PetscCall(PutArray(b, b->at.by_gap, &found->gap));
  PetscCall(PutArray(b, b->at.by_friction, &found->friction));
  PetscCall(ClearWithoutFriction(b->g));
  if (SamChoiceHasShape(b->g, found->of)) PetscCall(SamChoiceAddShape(b->g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Run(SamBack *b, const SamObjective *objective)
{
  double        *arrays;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(ChoosePart(b));
  b->at.moduli = SamChoiceHasModuli(b->g, b->g->found.of);
  if (b->at.moduli) PetscCall(CreateOther(b));
  PetscCall(Begin(b, &arrays));
  if (b->g->life) PetscCall(BeginLife(b));
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
  if (b->g->life) PetscCall(SamLifeBackEnd(b->g->life));
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that a number is not given itself in a step whose loads `force` are. */
static PetscErrorCode CheckGiven(MPI_Comm comm, const SamGradientGoal *goal, const PetscBool force[])
{
  const PetscInt c = goal->component;

  PetscFunctionBegin;
  PetscCheck(c < 0 || force[c] != goal->load, comm, SAM_ERR_USER, "the gradient of %s: it is given: take %s",
             goal->name, goal->load ? SamComponentNames[c].rigid : SamComponentNames[c].load);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that these bodies have a load or displacement. */
static PetscErrorCode CheckComponent(SamElasticity e, const SamGradientGoal *goal)
{
  const SamElasticityTraits traits = SamElasticityGetTraits(e);
  const PetscInt            c      = goal->component;

  PetscFunctionBegin;
  PetscCheck(!traits.periodic || c < 0 || c == SAM_COMPONENT_TX || c == SAM_COMPONENT_TY ||
               (c == SAM_COMPONENT_N && (goal->load || traits.mean)),
             SamElasticityGetGrid(e)->comm, SAM_ERR_USER,
             "the gradient of %s: periodic bodies have no such number: take disp_x or energy", goal->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientCheck(SamGradient g, const SamGradientGoal *goal, const PetscBool force[], const char of[])
{
  const SamElasticity e    = SamProblemGetElasticity(SamContactGetProblem(g->contact));
  const MPI_Comm      comm = SamContactGetGrid(g->contact)->comm;
  SamPairConstants    constants;
  const char         *none;

  PetscFunctionBegin;
  PetscCall(CheckGiven(comm, goal, force));
  PetscCall(CheckComponent(e, goal));
  if (goal->objective->check) PetscCall((*goal->objective->check)(SamContactGetProblem(g->contact), goal->name));
  PetscCall(SamChoiceCheck(g, of));
  if (!SamChoiceHasModuli(g, of)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(g->cycle == 0, comm, SAM_ERR_USER,
             "the gradient by the moduli over cycle jumps is not computed: leave the moduli out");
  none = SamPairGetConstants(SamElasticityGetPair(e), &constants);
  if (SamElasticityGetTraits(e).patch) none = "the bodies are finite";
  PetscCheck(!none, comm, SAM_ERR_USER, "the gradient by the moduli is not computed, as %s: leave the moduli out",
             none);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamGradientCompute(SamGradient g, const SamGradientGoal *goal, const PetscInt steps[2], const char of[],
                                  PetscReal rtol)
{
  const SamObjective *objective = goal->objective;
  SamBack             b         = {.g = g, .rtol = rtol};
  SamDerivatives     *d         = NULL;
  const MPI_Comm      comm      = SamContactGetGrid(g->contact)->comm;
  PetscInt            begin;

  PetscFunctionBegin;
  d = &g->found;
  PetscCheck(g->count > 0, comm, SAM_ERR_USER, "the gradient of %s: no step has been recorded", goal->name);
  begin      = g->cycle > 0 ? g->count - g->cycle : 0;
  b.at.last  = steps[1] < 0 ? g->count - 1 : begin + steps[1];
  b.at.first = steps[0] < 0 ? objective->all ? begin : b.at.last : begin + steps[0];
  PetscCheck(b.at.first <= b.at.last && b.at.last < g->count, comm, SAM_ERR_USER,
             "the gradient of %s: steps %" PetscInt_FMT " to %" PetscInt_FMT
             ": expected steps from 0 to %" PetscInt_FMT,
             goal->name, b.at.first - begin, b.at.last - begin, g->count - 1 - begin);
  PetscCall(SamGradientCheck(g, goal, g->record[b.at.first].force, of));
  for (PetscInt k = b.at.first + 1; k <= b.at.last; k++) PetscCall(CheckGiven(comm, goal, g->record[k].force));
  b.at.component = goal->component;
  b.at.number    = NAN;
  b.at.name      = goal->name;
  PetscCall(ClearFound(d));
  d->count = g->rows > 0 ? g->rows : g->count;
  PetscCall(PetscCalloc3(d->count, &d->load, d->count, &d->rigid, d->count, &d->bulk));
  (void)snprintf(d->name, sizeof(d->name), "%s", goal->name);
  d->unit = objective->unit_of_row && SamGridIsRow(SamContactGetGrid(g->contact))
              ? objective->unit_of_row
              : SamUnitOn(SamContactGetGrid(g->contact), objective->unit);
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
  found = OfStep(g, name, step);
  if (!found) found = SamChoiceFind(g, name);
  if (found) *value = *found;
  PetscCheck(found || !isnan(*value), comm, SAM_ERR_USER, "the gradient by %s: there is no derivative by it", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- shares ---- */

enum {
  SHARES = 1 + 2 * SAM_COMPONENTS + SAM_GRADIENT_BULKS + SAM_GRADIENT_MODULI + SAM_LAWS + SAM_GAP_PARAMETERS,
  TOLD   = 5
};
_Static_assert(SHARES <= SAM_GRADIENT_SHARES, "room for all shares");

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

/* Adds a share whose error is unknown. */
static void AddShare(SamGradientShare shares[], PetscInt *count, const char name[], double share)
{
  shares[(*count)++] = (SamGradientShare){name, share, NAN};
}

/* Adds the shares of a load, and of its displacement, over the steps in which each is given. */
static void AddComponent(SamGradient g, PetscInt c, SamGradientShare shares[], PetscInt *count)
{
  const SamDerivatives *d      = &g->found;
  double                sum[2] = {0, 0};

  for (PetscInt k = 0; k < d->count; k++) {
    const SamRecord *r = SamGradientOfRow(g, k);

    sum[r->force[c] ? 0 : 1] += r->force[c] ? r->load[c] * d->load[k][c] : r->rigid[c] * d->rigid[k][c];
  }
  if (SamChoiceHas(g, d->of, SamComponentNames[c].load)) AddShare(shares, count, SamComponentNames[c].load, sum[0]);
  if (SamChoiceHas(g, d->of, SamComponentNames[c].rigid)) AddShare(shares, count, SamComponentNames[c].rigid, sum[1]);
}

PetscErrorCode SamGradientGetShares(SamGradient g, SamGradientShare shares[SAM_GRADIENT_SHARES], PetscInt *count)
{
  const SamDerivatives *d = &g->found;
  const char           *name;
  double                one;

  PetscFunctionBegin;
  PetscCall(CheckFound(g));
  *count = 0;
  if (SamChoiceHas(g, d->of, "friction")) {
    PetscCall(ShareOfFriction(g, &one));
    AddShare(shares, count, "friction", one);
  }
  for (PetscInt c = 0; c < SAM_COMPONENTS; c++) AddComponent(g, c, shares, count);
  for (PetscInt b = 0; b < SAM_GRADIENT_BULKS; b++) {
    if (!SamChoiceHas(g, d->of, SamBulkName(b))) continue;
    one = 0;
    for (PetscInt k = 0; k < d->count; k++) one += SamGradientOfRow(g, k)->bulk[b] * d->bulk[k][b];
    AddShare(shares, count, SamBulkName(b), one);
  }
  for (PetscInt k = 0; (name = SamGradientNumber(g, k)); k++) {
    if (!SamChoiceHas(g, d->of, name)) continue;
    PetscCall(SamChoiceGetShare(g, name, &one));
    AddShare(shares, count, name, one);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a change in per cent, with its error if that is known. */
static size_t WriteShare(const SamGradientShare *s, double value, const char before[], char text[], size_t size)
{
  const double percent = s->share / value, error = fabs(s->error / value);

  if (isnan(error)) return (size_t)snprintf(text, size, "%s %s %+.3g %%", before, s->name, percent);
  return (size_t)snprintf(text, size, "%s %s %+.3g +- %.2g %%", before, s->name, percent, error);
}

PetscErrorCode SamGradientDescribe(SamGradient g, PetscInt count, const SamGradientShare shares[], char text[],
                                   size_t size)
{
  const SamDerivatives *d                         = &g->found;
  const double          value                     = (double)d->value;
  PetscBool             used[SAM_GRADIENT_SHARES] = {PETSC_FALSE};
  size_t                at;

  PetscFunctionBegin;
  at = (size_t)snprintf(text, size, "%s %.6g%s%s", d->name, value, strcmp(d->unit, "1") ? " " : "",
                        strcmp(d->unit, "1") ? d->unit : "");
  for (PetscInt told = 0; told < TOLD && at < size; told++) {
    PetscInt best = -1;

    for (PetscInt k = 0; k < count; k++) /* of equal ones the first, whatever their last digits are */
      if (!used[k] && (best < 0 || fabs(shares[k].share) > 1.001 * fabs(shares[best].share))) best = k;
    if (best < 0 || !(fabs(shares[best].share) > 1e-6 * fabs(value))) break;
    at += WriteShare(&shares[best], value, told ? "," : "; by 1 % more", text + at, size - at);
    used[best] = PETSC_TRUE;
  }
  if (!strstr(text, "; by") && at < size)
    (void)snprintf(text + at, size - at, "; by the wanted parameters: in the results");
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *SamGradientUnit(SamGradient g)
{
  return g->found.unit;
}
