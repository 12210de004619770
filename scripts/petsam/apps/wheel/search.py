"""The iteration for the equilibrium of a wheelset at a lateral displacement.

Unknowns are the overlaps of both wheels, in their logarithms; height and roll follow from them, as the height at which
a wheel touches falls with the roll by the lateral arm of its contact. Broyden's iteration begins with Hertz's slope:
vertical force and roll moment of a wheel grow with its overlap^1.5. It solves drafts on coarser cells, corrected by how
a full solution differs from its draft, and ends with the slopes of the drafts: two or three full solutions are enough.
Without a pitch rate it is a third unknown: that of a wheelset without torque about its axle, or by the mean of its
rolling radii.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace

import numpy as np

from ...core import broyden
from . import derailing
from .equilibrium import Equilibrium
from .lifting import ALMOST, wedged
from .places import distance
from .positions import DEEPEST
from .result import DerailWarning

PASSES = 60  # full solutions of an equilibrium
ROUNDS, DRAFTS = 8, 20  # full solutions with the slopes of drafts, and drafts before a full solution
FIRST, NEXT = 2e-3, 5e-3  # residual of the first drafts, and of others relative to that of the first full solution
ALMOST_DONE = 15.0  # residual of drafts over the wanted one, at least: a step from it leads to the wanted one
MORE = 100  # full solutions beyond PASSES, while no more than ALMOST is left
ROUGH = 1e-6  # m: overlaps with which an iteration begins agree to it
ROLLINGS = ("free", "radii")  # without a pitch rate: without torque about the axle; by the mean of the rolling radii
NEAR = 5e-4  # residual of an equilibrium on wider cells, for errors
STEADY = 1e-6  # of the load times the radius: torque of a wheelset that rolls freely
ALIKE = 1e-8  # relative error of the pitch rate by the mean of the radii
STEEP, LINE = 0.8, 2e-5  # part of the contacts' distance below which the height is no line over the roll; rad
FASTEST = math.log(2.0)  # change of the logarithm of an overlap in one pass
NEWTON, HALVINGS, DIFFERENCE = 15, 5, 1e-3  # steps, their halvings, and relative change of overlaps for a slope


@dataclass(frozen=True, eq=False)
class _State:
    """Both wheels at a height, a roll and a pitch rate: overlaps, solutions, what each gives to the balance, what is
    left of forces, moments and torque (or of the pitch rate by the radii), the arms of the points that touch for the
    roll, and half their lateral distance."""

    overlaps: np.ndarray
    found: list
    parts: np.ndarray
    values: np.ndarray
    arms: tuple
    half: float

    @property
    def rest(self):
        """The residuals of forces and moments."""
        return self.values[:2]


class Search:
    """The iteration for an equilibrium at a lateral displacement."""

    def __init__(self, axle, position, load, start=None):
        self.axle, self.load, self.passes = axle, load, 0
        self.rolling = axle.rolling if position.pitch_rate is None else "given"
        self.position, self.start = position, start
        self.slopes = start.slopes if start else None
        self.correction = np.zeros(3) if start is None or start.correction is None else start.correction
        self.kept = self.correction  # for a neighbour
        self.before, self.limit = None, FASTEST
        self.solved = None  # the last position, that of the cases
        self.drafts = None, None  # the last ones, of right wheels

    def begin(self, overlaps):
        """Height and roll of these overlaps."""
        rigid, radius = self.axle.rigid(self.position, overlaps, ROUGH), self.axle.wheel.radius
        self.position, self.scale = rigid.position, 0.5 * (rigid.points[0] - rigid.points[1])
        self.slip = 0.5 * math.sqrt(2.0 * hertz(self.axle, 0.5 * self.load.vertical)[0] / radius)
        self.unit = self.slip * self.position.speed / radius
        if self.rolling != "given":
            rate = _by_radii(self.position.speed, rigid.radii)
            if self.start is not None and self.rolling == "free" and self.start.position.speed > 0.0:
                rate *= self.start.position.pitch_rate / _by_radii(self.start.position.speed, self.start.radii)
            self.position = replace(self.position, pitch_rate=rate)

    def _turn(self, more):
        """Changes the pitch rate so that the creepage of both wheels grows by so many slips; no given one."""
        if self.rolling != "given":
            rate = min(self.position.pitch_rate - float(more) * self.unit, 0.0)
            self.position = replace(self.position, pitch_rate=rate)

    def _radii(self, found):
        """Rolling radii of both wheels."""
        return [_radius(one, self.position, self.axle.wheel.radius) for one in found]

    def _turning(self, found):
        """The residual of the torque about the axle over the axle load times the nominal radius, or of the pitch rate
        by the radii over its unit."""
        if self.rolling == "free":
            return sum(one.torque for one in found) / (self.load.vertical * self.axle.wheel.radius)
        if self.rolling == "radii":
            return (_by_radii(self.position.speed, self._radii(found)) - self.position.pitch_rate) / self.unit
        return 0.0

    def done(self, values, rtol):
        """True if values are those of an equilibrium, with the pitch rate."""
        turning = STEADY if self.rolling == "free" else ALIKE / self.slip
        return max(abs(values[:2])) <= rtol and abs(values[2]) <= turning

    def iterate(self, rtol, passes):
        """The equilibrium by full solutions alone; else the last state."""
        self.correction = np.zeros(3)
        for k in range(passes + MORE):
            state = self.state()
            if self.done(state.values, rtol) or (k >= passes and max(abs(state.values)) > ALMOST):
                break
            self.improve(state)
        return state

    def newton(self, state, rtol):
        """The equilibrium by Newton's steps with differences of full solutions, halved while what is left grows: where
        the inclination of a flange changes the forces more than the overlaps do. Else the last state."""
        for _ in range(NEWTON):
            if self.done(state.values, rtol) or min(state.overlaps) <= 0.0:
                break
            here = self.position
            slopes = np.eye(3)
            for k in range(2 if self.rolling == "given" else 3):
                self.position = here
                self._move(state, DIFFERENCE * np.eye(3)[k])
                slopes[:, k] = (self.state().values - state.values) / DIFFERENCE
            if not np.linalg.cond(slopes) < 1e8:
                break
            step = np.linalg.solve(slopes, -state.values)
            step *= min(1.0, FASTEST / np.abs(step).max())
            state = self._shortened(state, here, step)
        return state

    def _shortened(self, state, here, step):
        """The state after a step of the unknowns, or part of it, so that less is left."""
        for part in 0.5 ** np.arange(HALVINGS):
            self.position = here
            self._move(state, part * step)
            after = self.state()
            if np.linalg.norm(after.values) < np.linalg.norm(state.values) or max(abs(after.values)) < STEADY:
                break
        return after

    def settle(self, least, draft=None):
        """The draft near an equilibrium, with the correction; begins beside a draft; None where there is none."""
        for _ in range(DRAFTS):
            if draft is not None:
                self.improve(draft)
            draft = self.state(True)
            if max(abs(draft.values + self.correction)) <= least:
                return draft
        return None

    def by_drafts(self, rtol):
        """The equilibrium from drafts and few full solutions; None where drafts do not lead to it."""
        begun = self.position
        draft = self.settle(FIRST)
        if draft is not None:
            state = self.state()
            if self.done(state.values, rtol):
                return state
            self.correction = self.kept = state.values - draft.values
            draft = self.settle(max(ALMOST_DONE * rtol, NEXT * max(abs(state.values))), draft)
        if draft is not None:
            self.improve(draft)
            state = self.finish(rtol)
            if state is not None:
                return state
        self.position, self.slopes, self.before, self.limit = begun, None, None, FASTEST
        return None

    def finish(self, rtol):
        """The equilibrium by full solutions with the slopes of the drafts; None where they do not lead to it."""
        self.before, self.correction = None, np.zeros(3)
        for _ in range(ROUNDS):
            state = self.state()
            if self.done(state.values, rtol):
                return state
            self.improve(state)
        return None

    def beside(self, position):
        """The state nearest to an equilibrium, after a step with the slopes of that at a position on other cells; None
        if it is not near one."""
        self.position, self.correction = position, np.zeros(3)
        self.improve(self.state())
        state = self.state()
        return state if max(abs(state.values)) <= NEAR else None

    def state(self, draft=False):
        """The solutions at the present height and roll."""
        self.passes += not draft
        p = self.position
        if p != self.solved:
            self.solved, self.cases = p, self.axle._cases(p)
        touch = np.array([case.search.touch for case in self.cases])
        if (p.z - touch).max() > DEEPEST:
            raise wedged(self.axle, p, self.load, self.cases)
        if draft:
            self.drafts = one, other = [case.draft(p.z) for case in self.cases]
        else:
            one, other = (case.at(p.z, near) for case, near in zip(self.cases, self.drafts))
        found = [one, other.mirrored()]
        parts = np.array([_part(result, p, self.axle.wheel.radius, self.load) for result in found])
        given = np.array([self.load.vertical, self.load.offset * self.load.vertical])
        if self.load.right is not None:
            parts[:, 1] = self.scale * parts[0, 0], 0.0
            given[1] = self.scale * self.load.right
        scale = self.load.vertical * np.array([1.0, self.scale])
        rest = (parts.sum(axis=0) - given) / scale
        values = np.append(rest, self._turning(found))
        return _State(p.z - touch, found, parts / scale, values, self.axle._arms(self.cases, p), self.scale)

    def improve(self, state):
        """Moves height, roll and pitch rate."""
        if min(state.overlaps) <= 0.0 or min(state.parts[:, 0]) <= 0.0:
            return self._press(state)
        turned = 0.0 if self.rolling == "given" else -self.position.pitch_rate / self.unit
        now, values = np.append(np.log(state.overlaps), turned), state.values
        own = np.eye(3)
        own[:2, :2] = 1.5 * state.parts.T
        slopes = own if self.slopes is None else self.slopes
        left = values + self.correction
        if self.before is not None:
            slopes = broyden.updated(slopes, now - self.before[0], values - self.before[1])
            if np.linalg.norm(left) > 2.0 * np.linalg.norm(self.before[1] + self.correction):
                self.limit, slopes = max(0.5 * self.limit, 0.05), own
        if np.linalg.cond(slopes) > 1e6:
            slopes = own
        step = np.linalg.solve(slopes, -left)
        step *= min(1.0, self.limit / max(np.abs(step).max(), 1e-300))
        self.slopes, self.before = slopes, (now, values)
        self._move(state, step)

    def _press(self, state):
        """Presses wheels that lift onto their rails again."""
        least = 0.2 * np.array(hertz(self.axle, 0.5 * self.load.vertical))
        wanted = np.where(state.parts[:, 0] <= 0.0, np.maximum(2.0 * state.overlaps, least), state.overlaps)
        self.slopes = self.before = None
        self._press_by(state, np.maximum(wanted, least) - state.overlaps)

    def _move(self, state, step):
        """Changes height, roll and pitch rate by a step of the unknowns."""
        self._press_by(state, state.overlaps * np.expm1(step[:2]))
        self._turn(step[2])

    def _press_by(self, state, more):
        """Changes height and roll so that the overlaps grow by so much."""
        right, left = state.arms
        roll = (more[0] - more[1]) / (right - left)
        p = self.position
        if right - left < STEEP * 2.0 * self.scale and abs(roll) > LINE:
            self.position = self.axle.rigid(p, tuple(state.overlaps + more), ROUGH).position
        else:
            self.position = replace(p, roll=float(p.roll + roll), z=float(p.z + more[0] - right * roll))

    def equilibrium(self, state):
        """The result, with the warnings of its last pass."""
        for case, found in zip(self.cases, state.found):
            case.warn(found)
        lateral = float(sum(one.force[1] for one in state.found))
        climbs = tuple(derailing.climb(one, pair.wheel) for one, pair in zip(state.found, self.axle.pairs))
        for text in filter(None, (one.text for one in climbs)):
            warnings.warn(text, DerailWarning, stacklevel=5)
        radii = tuple(self._radii(state.found))
        force, moment = map(float, state.rest)
        return Equilibrium(
            self.position,
            self.load,
            *state.found,
            lateral,
            force,
            moment,
            radii,
            self.passes,
            climbs,
            self.slopes,
            self.kept,
        )


def _by_radii(speed, radii):
    """The pitch rate by the mean of both rolling radii, rad/s."""
    return -2.0 * speed / sum(radii)


def hertz(axle, force):
    """Overlaps by Hertz under a vertical force, m."""
    modulus, radius = axle.settings.modulus, axle.wheel.radius
    return ((force / (4.0 / 3.0 * modulus * math.sqrt(0.5 * radius))) ** (2.0 / 3.0),) * 2


def _part(result, position, radius, load):
    """Vertical force of a wheel, and its moment about x, which the axle load's balances."""
    force, moment = 0.0, 0.0
    centre = position.z - radius + load.height
    for patch in result.patches:
        (_, y, z), (_, fy, fz) = patch.centre, patch.force
        force += fz
        moment += (y - position.y) * fz - (z - centre) * fy
    return force, moment


def _radius(result, position, radius):
    """Rolling radius of a wheel: the mean over its patches by their normal forces."""
    centre = np.array([0.0, position.y, position.z - radius])
    found = [distance(position.rotation, patch.centre - centre) for patch in result.patches]
    return float(np.average(found, weights=[patch.n for patch in result.patches])) if found else radius
