/*
  Divides a load step into pieces, so that the estimated error of its dissipated energy keeps a tolerance.

  Problem: the energy of a step has an error that depends on its length (numbers.c). All prescribed values are
  interpolated between the pieces of the step. The pieces must be so short that the estimate of each is at most a part
  of the tolerance times an energy: its own, or a fifth of the average energy of pieces of this length so far, if that
  is more. Then the sums keep the tolerance, too.

  Algorithm, from a quarter of the step on:
    1. Try the piece. If its estimate is too large, reject it, and try half of it.
    2. Else commit it. The next piece is as long, or twice as long if the estimate of that is likely to be small enough.
    3. The last piece stays tried: it is the step, with the sums of all pieces.
  Pieces are repeated halves of the step; pieces of 1/1024 are accepted with any estimate. All decisions depend on
  global numbers of this step, so they are the same on any number of ranks, and after a restart.

  A step from no contact applies N, then the tangential loads, unless the next step continues it in proportion. So do
  its pieces: N and all but the tangential loads grow in the first half of them, the tangential loads in the second.
*/
#include "simulationimpl.h"
#include <petsam/private/balance.h>
#include <petsam/private/state.h>

/* Largest estimate relative to the tolerance, as estimates are up to three times too small */
#define SAFETY 0.3
/* Part of the limit below which the length is doubled: twice the length has four times the relative error, with some
   reserve. */
#define DOUBLE 0.2
#define LEAST  (1.0 / 1024)
/* The longest piece: in longer ones, cells may slide and stick again, which the estimate at the end would miss. */
#define MOST (1.0 / 4)
/* Least energy to which a piece's error is related, relative to the average energy so far */
#define LITTLE 0.2

PetscErrorCode SamSimulationReadPieces(SamSimulation s, const SamOptions *from)
{
  static const SamOptionRow row = {"step_rtol", "divide load steps until the energy has this estimated error; 0: never",
                                   SAM_OPTION_REAL, .range = SAM_RANGE_NONNEGATIVE};

  PetscFunctionBegin;
  PetscCall(SamOptionsRead(from, NULL, 1, &row, &s->step_rtol, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums over all pieces in the state: their energy (J), and their length in steps; named like the option */
static const SamStateNumber so_far = {"step_rtol", "J",           NULL, SAM_NUMBER_REAL, 2, PETSC_TRUE,
                                      PETSC_FALSE, SAM_JOIN_LAST, 0};

PetscErrorCode SamSimulationDeclarePieces(SamSimulation s)
{
  SamState state;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  if (s->step_rtol > 0) PetscCall(SamStateDeclareNumber(state, &so_far, &id));
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
  PetscReal energy, error, limit;
  SamState  state;
  double   *sum;

  PetscFunctionBegin;
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(SamContactGetNumber(s->setup.contact, "dissipated_energy", &energy));
  PetscCall(SamContactGetNumber(s->setup.contact, "energy_error", &error));
  sum     = SamStateNumbers(state, SamStateFindNumber(state, so_far.name), SAM_TRIED);
  limit   = SAFETY * s->step_rtol * PetscMax(energy, sum[1] > 0 ? LITTLE * sum[0] / sum[1] * length : 0);
  *enough = error <= limit || length <= LEAST ? PETSC_TRUE : PETSC_FALSE;
  *longer = error <= DOUBLE * limit ? PETSC_TRUE : PETSC_FALSE;
  sum[0] += energy;
  sum[1] += length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamSimulationTry(SamSimulation s, PetscInt k, SamStep *step)
{
  double     before[SAM_STATE_NUMBERS] = {0}, done = 0, piece = MOST;
  PetscBool  enough = PETSC_TRUE, longer = PETSC_FALSE, apart = PETSC_FALSE;
  SamControl control;
  SamState   state;

  PetscFunctionBegin;
  if (s->step_rtol == 0) {
    control = SamHistoryGetStep(s->history, k);
    PetscCall(SamSimulationTryStep(s, &control, step));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SamContactGetState(s->setup.contact, &state));
  PetscCall(IsApart(s, k, &apart));
  while (PETSC_TRUE) {
    control = ControlAt(s, k, apart, done + piece);
    PetscCall(SamSimulationTryStep(s, &control, step));
    if (!SamStepIsSolved(step)) break;
    PetscCall(Judge(s, piece, &enough, &longer));
    if (!enough) {
      piece /= 2;
      continue;
    }
    if (done + piece == 1 || step->status != SAM_STATUS_CONVERGED) break;
    SamStateJoinNumbers(state, before, PETSC_FALSE);
    PetscCall(SamSimulationCommitStep(s, step));
    s->last_time = control.time; /* its fields are the last ones if the next piece has no solution */
    done += piece;
    if (longer && piece < MOST && fmod(done, 2 * piece) == 0) piece *= 2;
  }
  SamStateJoinNumbers(state, before, PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}
