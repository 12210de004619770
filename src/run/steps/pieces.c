/*
  Divides a load step into pieces, by the error of its dissipated energy.

  Problem: the energy of a step has an error that depends on its length (numbers.c). All prescribed values are
  interpolated between the pieces of the step. With -step_rtol the pieces must be so short that the estimate of each is
  at most a part of the tolerance times an energy: its own, or a fifth of the average energy of pieces of this length so
  far, if that is more. Then the sums keep the tolerance, too. Else, unless -step_divide no, a step is divided where
  contact is lost, made or grows under shear: where the work of its loads is not what the shear stores and the slip
  dissipates, by more than a part of the energy of all steps so far.

  Algorithm, from a quarter of the step on, or from all of it:
    1. Try the piece. If its estimate is too large, reject it, and try half of it.
    2. Else commit it. The next piece is as long, or twice as long if the estimate of that is likely to be small enough.
    3. The last piece stays tried: it is the step, with the sums of all pieces.
  If a piece has no solution, as loads slide on the way, the run ends there; without a tolerance the rest of the step is
  taken at once.
  Pieces are repeated halves of the step; the shortest are accepted with any estimate. All decisions depend on global
  numbers of this step, so they are the same on any number of ranks, and after a restart.

  A step from no contact applies N, then the tangential loads, unless the next step continues it in proportion. So do
  its pieces: N and all but the tangential loads grow in the first half of them, the tangential loads in the second.
*/
#include "simulationimpl.h"
#include <petsam/private/balance.h>
#include <petsam/private/motionimpl.h>
#include <petsam/private/solutionimpl.h>
#include <petsam/private/state.h>

/* Largest estimate relative to the tolerance, as estimates are up to three times too small */
#define SAFETY 0.3
/* Part of the limit below which the length is doubled: twice the length has four times the relative error, with some
   reserve. */
#define DOUBLE 0.2
#define LEAST  (1.0 / 1024)
/* The longest piece: in longer ones, cells may slide and stick again, which the estimate at the end would miss. */
#define MOST (1.0 / 4)
/* Without a tolerance: the largest imbalance relative to the energy so far, and the shortest piece */
#define BALANCED 0.02
#define SHORTEST (1.0 / 16)
/* Least energy to which a piece's error is related, relative to the average energy so far */
#define LITTLE 0.2

#define MEMBER(name) offsetof(struct _n_SamSimulation, name)
PetscErrorCode SamSimulationReadPieces(SamSimulation s, const SamOptions *from)
{
  static const SamOptionRow rows[] = {
    {"step_rtol", "divide load steps until the energy has this estimated error; 0: never", SAM_OPTION_REAL,
     MEMBER(step_rtol), .range = SAM_RANGE_NONNEGATIVE},
    {"step_divide", "divide steps in which N changes under shear", SAM_OPTION_BOOL, .member = MEMBER(step_divide)}};

  PetscFunctionBegin;
  s->step_divide = PETSC_TRUE;
  PetscCall(SamOptionsRead(from, NULL, SAM_OPTION_ROWS(rows), s, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over all pieces in the state: their energy (J), and their length in steps; named like the option */
static const SamStateNumber so_far = {"step_rtol", "J",           NULL, SAM_NUMBER_REAL, 2, PETSC_TRUE,
                                      PETSC_FALSE, SAM_JOIN_LAST, 0};

/* True if steps are divided without a tolerance. Gradients are those of the steps of the history. */
static PetscBool Divides(const struct _n_SamSimulation *s)
{
  return s->step_divide && s->step_rtol == 0 && s->needs.friction && !s->needs.life && !s->gradients.names[0] &&
             !s->gradient && SamMotionOf(s->setup.elasticity)->continues
           ? PETSC_TRUE
           : PETSC_FALSE;
}

PetscErrorCode SamSimulationDeclarePieces(SamSimulation s)
{
  SamState state;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  if (s->step_rtol > 0)
    PetscCall(SamStateDeclareNumber(state, &so_far, &id));
  else /* of runs that go on from others */
    PetscCall(SamStateDeclareOptional(state, &so_far, 0, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if there is no contact yet, and step k applies N before the tangential loads. */
static PetscErrorCode IsApart(SamSimulation s, PetscInt k, PetscBool *apart)
{
  const SamSolution *before;

  PetscFunctionBegin;
  PetscCall(SamContactGetSolution(s->setup.contact, &before));
  *apart = before->load[SAM_COMPONENT_N] > 0 || SamHistoryGetStep(s->history, k).together ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gets the prescribed values after a part of step k. */
static SamControl ControlAt(SamSimulation s, PetscInt k, PetscBool apart, PetscReal part)
{
  SamControl control = SamHistoryGetPart(s->history, k, apart ? PetscMin(1, 2 * part) : part), later;

  if (!apart) return control;
  later        = SamHistoryGetPart(s->history, k, PetscMax(0, 2 * part - 1));
  control.time = SamHistoryGetPart(s->history, k, part).time;
  for (PetscInt c = 0; c < 3; c++) {
    const PetscInt t = SamComponentsOf[SAM_BALANCE_TANGENTIAL][c];

    control.value[t] = later.value[t];
  }
  return control;
}

/* Finds out if the tried piece, of this length, is accurate enough, and if a piece of twice its length may be. */
static PetscErrorCode Judge(SamSimulation s, double length, PetscBool *enough, PetscBool *longer)
{
  PetscReal energy, error, limit, shortest = LEAST;
  SamState  state;
  double   *sum;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(SamContactGetNumber(s->setup.contact, "dissipated_energy", &energy));
  sum = SamStateNumbers(state, SamStateFindNumber(state, so_far.name), SAM_TRIED);
  if (s->step_rtol > 0) {
    PetscCall(SamContactGetNumber(s->setup.contact, "energy_error", &error));
    limit = SAFETY * s->step_rtol * PetscMax(energy, sum[1] > 0 ? LITTLE * sum[0] / sum[1] * length : 0);
  } else {
    error    = *SamStateNumbers(state, SamStateFindNumber(state, SAM_UNBALANCED), SAM_TRIED);
    limit    = BALANCED * (sum[0] + energy);
    shortest = SHORTEST;
  }
  *enough = !(error > limit) || length <= shortest ? PETSC_TRUE : PETSC_FALSE;
  *longer = error <= DOUBLE * limit ? PETSC_TRUE : PETSC_FALSE;
  sum[0] += energy;
  sum[1] += length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationTry(SamSimulation s, PetscInt k, SamStep *step)
{
  const double most                      = s->step_rtol > 0 ? MOST : 1;
  double       before[SAM_STATE_NUMBERS] = {0}, done = 0, piece = most;
  PetscBool    rest = PETSC_FALSE, enough = PETSC_TRUE, longer = PETSC_FALSE, apart = PETSC_FALSE;
  SamControl   control;
  SamState     state;

  PetscFunctionBegin;
  if (s->step_rtol == 0 && !Divides(s)) {
    control = SamHistoryGetStep(s->history, k);
    PetscCall(SamSimulationTryStep(s, &control, step));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactGetState(s->setup.contact, &state));
  if (s->step_rtol > 0) PetscCall(IsApart(s, k, &apart));
  while (PETSC_TRUE) {
    control = ControlAt(s, k, apart, done + piece);
    PetscCall(SamSimulationTryStep(s, &control, step));
    if (!SamStepIsSolved(step) && (s->step_rtol > 0 || done + piece == 1)) break;
    if (!SamStepIsSolved(step)) {
      piece = 1 - done;
      rest  = PETSC_TRUE;
      continue;
    }
    PetscCall(Judge(s, piece, &enough, &longer));
    if (rest) break;
    if (!enough) {
      piece /= 2;
      if (piece == most / 2 && s->step_rtol == 0)
        PetscCall(SamSimulationNotify(s, &(SamSimulationEvent){.kind = SAM_NOTIFY_DIVIDED, .step = k}));
      continue;
    }
    if (done + piece == 1 || step->status != SAM_STATUS_CONVERGED) break;
    SamStateJoinNumbers(state, before, PETSC_FALSE);
    PetscCall(SamSimulationCommitStep(s, step));
    s->last_time = control.time; /* its fields are the last ones if the next piece has no solution */
    done += piece;
    if (longer && piece < most && fmod(done, 2 * piece) == 0) piece *= 2;
  }
  SamStateJoinNumbers(state, before, PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}
