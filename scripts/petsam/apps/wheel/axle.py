"""A wheelset on both rails: roll and height from the equilibrium of vertical forces and of moments about x.

Unknowns are the overlaps of both wheels, in their logarithms; height and roll follow from them, as the height at which
a wheel touches falls with the roll by the lateral arm of its contact. Broyden's iteration begins with Hertz's slope:
vertical force and roll moment of a wheel grow with its overlap^1.5. It solves drafts on coarser cells, corrected by how
a full solution differs from its draft, and ends with the slopes of the drafts: two or three full solutions are enough.
Without a pitch rate it is a third unknown: that of a wheelset without torque about its axle, or by the mean of its
rolling radii. Where a lateral force is given, the lateral displacement is found around it. Inertia is left out: give
the forces that remain at the wheelset.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from typing import Any, Optional

import numpy as np
from scipy.optimize import brentq

from ...core import broyden, tables
from ...core.brief import brief
from ...core.errors import Error, Unusable
from . import contacts, derailing
from .placement import Track, Wheelset
from .pose import Position
from .positions import DEEPEST, SIDES, Case, Friction, Pair
from .profile import ProfileWarning
from .result import COLUMNS, DerailWarning, Result

PASSES, TURNS = 60, 40  # of the equilibrium, and of the roll of rigid bodies
ROUNDS, DRAFTS = 8, 20  # full solutions with the slopes of drafts, and drafts before a full solution
FIRST, NEXT = 2e-3, 5e-3  # residual of the first drafts, and of others relative to that of the first full solution
ALMOST_DONE = 15.0  # residual of drafts over the wanted one, at least: a step from it leads to the wanted one
MORE, ALMOST = 100, 0.05  # full solutions beyond PASSES, while no more than this is left
ROUGH = 1e-6  # m: overlaps with which an iteration begins agree to it
ROLLINGS = ("free", "radii")  # without a pitch rate: without torque about the axle; by the mean of the rolling radii
STEADY = 1e-6  # of the load times the radius: torque of a wheelset that rolls freely
ALIKE = 1e-8  # relative error of the pitch rate by the mean of the radii
TURN = 2e-3  # rad by which the roll of rigid bodies changes at once
LEAST_ARM = 0.1  # m: of the distance of both contacts, which steep flanges shorten for the roll
STEEP, LINE = 0.8, 2e-5  # part of the contacts' distance below which the height is no line over the roll; rad
SHARE = 1e-9  # m: overlaps of rigid bodies agree to it
FASTEST = math.log(2.0)  # change of the logarithm of an overlap in one pass
STEP, WIDEST = 2e-3, 0.03  # m: of the search for a lateral force, and its end
STARTS = 2  # neighbours from which an equilibrium under a lateral force is tried, before rigid bodies
NEWTON, HALVINGS, DIFFERENCE = 15, 5, 1e-3  # steps, their halvings, and relative change of overlaps for a slope
MOST = 0.9  # of the load: difference of both wheels' loads with which an iteration begins
FACE = 0.5  # slope of a flange from which the equilibrium is tried by Newton's steps, too
LIFTED = 0.1  # of the load: a wheel with less lifts
LEAST_STEP = 4e-6  # m: of it towards displacements without an equilibrium
FLANGE = 0.01  # m below the nominal radius, where the thickness of the flange is measured
PLAY = (0.0, 0.02)  # m: usual distances of flange and rail
CLOSE = 1e-8  # m: of the lateral displacement under a lateral force

# columns of both wheels: name, attribute of Climb, unit, meaning
CLIMBS = (
    ("state", "state", "", "on rail, may climb, or derailed"),
    ("y_over_q", "ratio", "1", "lateral over vertical force of the wheel, positive outwards"),
    ("nadal", "limit", "1", "Nadal's limit of it at the flange's steepest place"),
)


@dataclass(frozen=True)
class Load:
    """Forces on a wheelset.

    Parameters
    ----------
    vertical : float
        Axle load with the wheelset's weight, N, downwards.
    offset : float
        y of its line from the wheelset's middle, m, positive to the right.
    lateral : float, optional
        Lateral force, N, positive to the right; None: the one that holds the wheelset in its position.
    height : float
        z of the lateral force's line below the axle, m, negative above it.
    right : float, optional
        Vertical force on the right rail, N, from a simulation of the vehicle: instead of the balance of moments.

    Raises
    ------
    Error
        If a number is none of this quantity.
    """

    vertical: float
    offset: float = 0.0
    lateral: Optional[float] = None
    height: float = 0.0
    right: Optional[float] = None

    def __post_init__(self) -> None:
        if not 0.0 < self.vertical < math.inf:
            raise Unusable(f"load {self.vertical:g}: expected an axle load above 0, N")
        if not math.isfinite(self.lateral or 0.0):
            raise Unusable(f"lateral {self.lateral:g}: expected a force, N")
        for name, most in (("offset", 2.0), ("height", 5.0)):
            value = getattr(self, name)
            if not abs(value) < most:
                raise Unusable(f"{name} {value:g}: expected a distance from the axle's middle, m, below {most:g}")
        if self.right is not None and not 0.0 < self.right < self.vertical:
            raise Unusable(f"right {self.right:g}: expected a vertical force above 0 and below the axle load, N")


@brief
@dataclass(frozen=True, eq=False)
class Equilibrium(tables.Tabled):
    """A wheelset in equilibrium on its rails.

    Attributes
    ----------
    position : Position
        With the roll, height, lateral displacement and pitch rate that were found.
    load : Load
        The forces.
    right, left : Result
        The solutions at both wheels, each in the track's axes.
    lateral : float
        Lateral force on the wheelset, N, positive to the right.
    force_error, moment_error : float
        What is left of the vertical forces over the axle load, and of the moments about x over the axle load times half
        the distance of the contacts.
    radii : tuple of float
        Rolling radii of the right and the left wheel, m: distances of their normal forces from the axle.
    passes : int
        Solutions of both wheels that it took, without drafts.
    climbs : tuple of derailing.Climb
        How near the right and the left wheel are to derailment.
    slopes : ndarray
        Derivative of what is left, the torque about the axle included, by the logarithms of the overlaps of both wheels
        and by the pitch rate, (3, 3), approximate: a neighbour's iteration begins with it.
    correction : ndarray
        By how much these three numbers differ from those of a draft, (3,): a neighbour's iteration begins with it, too.
    """

    position: Position
    load: Load
    right: Result
    left: Result
    lateral: float
    force_error: float
    moment_error: float
    radii: tuple[float, float]
    passes: int
    climbs: tuple[derailing.Climb, derailing.Climb]
    slopes: Optional[np.ndarray] = None
    correction: Optional[np.ndarray] = None

    @property
    def radius_difference(self) -> float:
        """Rolling radius of the right wheel less that of the left one, m."""
        return self.radii[0] - self.radii[1]

    @property
    def derailed(self) -> bool:
        """True where the contact of a wheel is beyond its flange's steepest place."""
        return any(one.state == derailing.STATES[2] for one in self.climbs)

    @property
    def wheels(self) -> tuple[Result, Result]:
        """The right and the left solution."""
        return self.right, self.left

    @property
    def torque(self) -> float:
        """Torque of the tangential forces on both wheels about the axle, N m: 0 of a wheelset that rolls freely."""
        return sum(found.torque for found in self.wheels)

    @property
    def t_gamma(self) -> float:
        """Frictional work of all patches per distance rolled, N."""
        return float(sum(patch.t_gamma for found in self.wheels for patch in found.patches))

    def table(self) -> list[tables.Column]:
        """The numbers of the patches, right wheel first, with forces on the rail in the track.

        Returns
        -------
        list of Column
            A row for each patch; see also to_csv() and to_dataframe().
        """
        rows = [(found, patch) for found in self.wheels for patch in found.patches]
        count = len(rows)
        common = (
            ("ws_y", "m", "lateral displacement", self.position.y), ("ws_z", "m", "height", self.position.z),
            ("ws_roll", "rad", "roll", self.position.roll), ("ws_yaw", "rad", "yaw", self.position.yaw),
            ("ws_load", "N", "axle load", self.load.vertical), ("ws_lateral", "N", "lateral force", self.lateral),
            ("radius_difference", "m", "rolling radius of the right wheel less the left", self.radius_difference),
            ("force_error", "1", "what is left of the vertical forces over the axle load", self.force_error),
            ("moment_error", "1", "what is left of the moments over the axle load times its arm", self.moment_error),
        )  # fmt: skip
        columns = [tables.Column(name, unit, text, [value] * count) for name, unit, text, value in common]
        columns.append(tables.Column("side", "", "right or left", [found.side for found, _ in rows]))
        near = {found.side: one for found, one in zip(self.wheels, self.climbs)}
        columns += [
            tables.Column(name, unit, text, [getattr(near[found.side], attribute) for found, _ in rows])
            for name, attribute, unit, text in CLIMBS
        ]
        columns += [
            tables.Column(name, unit, text, [getattr(patch, name) for _, patch in rows]) for name, unit, text in COLUMNS
        ]
        for k, axis in enumerate("xyz"):
            text = f"force on the rail in the track along {axis}"
            columns.append(tables.Column(f"track_f{axis}", "N", text, [float(patch.force[k]) for _, patch in rows]))
        return columns


class Axle:
    """A wheelset on both rails: solves positions one after the other and keeps what they share.

    Parameters
    ----------
    rail : Track
        The right rail, whose mirror image the left one is.
    wheel : Wheelset
        The right wheel, whose mirror image the left one is.
    friction : float or callable
        See Pair.
    settings : Settings, optional
        Materials, cells and limits.
    left : tuple of Track and Wheelset, optional
        Rail and wheel of the left side, as right ones, where they differ, in their nominal radius, too. The height z of
        a Position is 0 where the right wheel has its nominal one.
    rolling : str
        Pitch rate of positions without one: free, that without torque about the axle, at which the wheelset is neither
        driven nor braked; or radii, the speed over the mean of the rolling radii.

    Examples
    --------
    >>> from petsam import wheel
    >>> rail = wheel.Track(wheel.uic60(), cant=0.025)
    >>> with wheel.Axle(rail, wheel.Wheelset(wheel.s1002(), 0.46), settings=wheel.Settings(cell=1e-3)) as axle:
    ...     found = axle.solve(wheel.Position(y=0.0, speed=20.0), wheel.Load(100e3))
    >>> round(1e-3 * (found.right.force[2] + found.left.force[2]))  # kN
    100
    """

    def __init__(
        self,
        rail: Track,
        wheel: Wheelset,
        friction: Friction = 0.3,
        settings: Optional[contacts.Settings] = None,
        left: Optional[tuple[Track, Wheelset]] = None,
        rolling: str = ROLLINGS[0],
    ) -> None:
        if rolling not in ROLLINGS:
            raise Unusable(f"rolling {rolling!r}: expected {' or '.join(ROLLINGS)}")
        self.rolling = rolling
        both = (rail, wheel), left or (rail, wheel)
        if left is not None and left[0].curvature != rail.curvature:
            raise Unusable("left: the track's curvature is that of the right side: give equal ones")
        both = both[0], (both[1][0], both[1][1].of_radius(wheel.radius))
        self.pairs = [Pair(*one, friction, side, settings, extrapolate=False) for one, side in zip(both, SIDES)]
        self.wheel, self.settings = wheel, self.pairs[0].settings
        for track, one in both:
            _doubt_play(track, one)

    def __enter__(self) -> Axle:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def close(self) -> None:
        """Frees the contacts."""
        for pair in self.pairs:
            pair.close()

    def rigid(self, position: Position, overlaps: tuple[float, float] = (0.0, 0.0), share: float = SHARE) -> Rigid:
        """Roll and height at which both wheels overlap their rails by so much; 0: rigid bodies that touch.

        Parameters
        ----------
        position : Position
            Its roll is where the search begins.
        overlaps : tuple of float
            Of the right and the left wheel, m.
        share : float
            Error of their difference, m.

        Returns
        -------
        Rigid

        Raises
        ------
        Error
            If a wheel is beside its rail.
        """
        roll, low, high = position.roll, -math.inf, math.inf
        for _ in range(TURNS):
            now = replace(position, roll=roll)
            cases = self._cases(now)
            arms = self._arms(cases, now)
            apart = cases[0].search.touch + overlaps[0] - cases[1].search.touch - overlaps[1]
            if abs(apart) < share:
                break
            low, high = (roll, high) if apart > 0.0 else (low, roll)
            step = apart / max(arms[0] - arms[1], LEAST_ARM)
            step = min(max(step, -TURN), TURN)
            roll = roll + step if low < roll + step < high else 0.5 * (low + high)
        z = 0.5 * (cases[0].search.touch + overlaps[0] + cases[1].search.touch + overlaps[1])
        return Rigid(replace(now, z=z), (_point(cases[0], 1.0), _point(cases[1], -1.0)), self._radii(now, cases, z))

    def _radii(self, position, cases, z):
        """Distances of the points that touch from the axle, m."""
        found = []
        for case, sign in zip(cases, (1.0, -1.0)):
            k = int(np.argmin(case.search.gap))
            place = np.array([case.search.x[k], sign * case.search.y[k], case.search.z[k]])
            found.append(_distance(position.rotation, place - np.array([0.0, position.y, z - self.wheel.radius])))
        return tuple(found)

    def _arms(self, cases, position):
        """By how much the heights at which both wheels touch fall with the roll, right and left, m: the lateral arm of
        the contact, and its arm below the axle times the inclination, as a flange moves aside with the roll."""
        found = []
        for case, pair, sign in zip(cases, self.pairs, (1.0, -1.0)):
            y = _place(case)
            below = self.wheel.radius + float(pair.rail.section.height(np.array(y))) - case.search.touch
            found.append(sign * (y - sign * position.y + below * float(pair.rail.section.slope(np.array(y)))))
        return tuple(found)

    def _cases(self, position):
        """The cases of both wheels, as right ones."""
        return [Case(self.pairs[0], position), Case(self.pairs[1], position.mirrored())]

    def solve(self, position: Position, load: Load, start: Optional[Equilibrium] = None) -> Equilibrium:
        """The equilibrium at a lateral displacement, or under a lateral force.

        Parameters
        ----------
        position : Position
            Yaw, speeds and lateral displacement; roll and, under a lateral force, y are where the search begins.
            Without a pitch rate it is found: see rolling of the Axle.
        load : Load
            The forces.
        start : Equilibrium, optional
            A neighbour's, where the search begins.

        Returns
        -------
        Equilibrium

        Raises
        ------
        Error
            If z is given, a wheel is beside its rail, or there is no equilibrium with both wheels on their rails.
        ContactError
            If a patch has no solution.
        """
        if position.z is not None:
            raise Error("Position z: the axle load gives it: leave it out")
        if start is not None:
            position = replace(position, roll=start.position.roll)
        if load.lateral is None:
            return self._upright(position, load, start)
        return self._aside(position, load, start)

    def _aside(self, position, load, start):
        """The equilibrium under a lateral force."""
        solved = {}  # by the displacement aside, m

        def excess(y, most=STARTS):
            near = sorted(solved.values(), key=lambda one: abs(one.position.y - y))[:most] or [start]
            more = [None] if near[0] and most > 1 else []
            found = self._from_any(replace(position, y=y), load, [*near, *more])
            if found.derailed:
                raise _derails(load, solved)
            solved[y] = found
            return found.lateral - load.lateral

        low = high = position.y if start is None else start.position.y
        first = excess(low)
        sign, step = -np.sign(first), STEP
        while first and abs(high) < WIDEST:
            low, high = high, high + sign * step
            try:
                if excess(high, 1) * sign >= 0.0:
                    break
            except Error:  # beyond Nadal's limit, or beside the rail
                high, step = low, 0.5 * step
                if step < LEAST_STEP:
                    raise _derails(load, solved) from None
        else:
            if first:
                raise _derails(load, solved)
        y = brentq(excess, low, high, xtol=CLOSE, rtol=1e-12) if first else low
        return self._upright(replace(position, y=float(y), roll=solved[float(y)].position.roll), load, solved[float(y)])

    def _from_any(self, position, load, starts):
        """The equilibrium from the first start that leads to it, without its warnings."""
        for start in starts:
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    here = replace(position, roll=start.position.roll) if start else position
                    return self._upright(here, load, start)
            except Error as error:
                failure = error
        raise failure

    def _upright(self, position, load, start):
        """The equilibrium at a lateral displacement."""
        search = _Search(self, position, load, start)
        overlaps = _hertz(self, 0.5 * load.vertical)
        if start is not None:
            overlaps = tuple(max(overlap, 0.1 * overlaps[0]) for overlap in _scaled(start, load))
        search.begin(overlaps)
        rtol = self.settings.rtol
        begun = search.position
        state = search.by_drafts(rtol) or search.iterate(rtol, PASSES)
        if max(abs(state.values)) > rtol and self._steep(search.cases):
            search.position = begun
            state = search.newton(search.state(), rtol)
        if max(abs(state.values)) <= rtol:
            return search.equilibrium(state)
        raise _no_equilibrium(self, position, load, state, search.cases)

    def _steep(self, cases):
        """True if a wheel touches on its flange."""
        slopes = [abs(float(pair.rail.section.slope(_place(case)))) for case, pair in zip(cases, self.pairs)]
        return max(slopes) > FACE


@dataclass(frozen=True, eq=False)
class Rigid:
    """Rigid wheels that touch their rails: the position with its roll and height, y in the track of the points that
    touch (m), and their distances from the axle (m), right and left."""

    position: Position
    points: tuple[float, float]
    radii: tuple[float, float]


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


class _Search:
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
        self.slip = 0.5 * math.sqrt(2.0 * _hertz(self.axle, 0.5 * self.load.vertical)[0] / radius)
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

    def state(self, draft=False):
        """The solutions at the present height and roll."""
        self.passes += not draft
        p = self.position
        if p != self.solved:
            self.solved, self.cases = p, self.axle._cases(p)
        touch = np.array([case.search.touch for case in self.cases])
        if (p.z - touch).max() > DEEPEST:
            raise _wedged(self.axle, p, self.load, self.cases)
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
        least = 0.2 * np.array(_hertz(self.axle, 0.5 * self.load.vertical))
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


def _doubt_play(rail, wheel):
    """Warns of a flange that lies on the rail's inner face, or far from it, in the middle of the track."""
    deep = np.flatnonzero(wheel.section.z >= FLANGE)
    if not len(deep) or not isinstance(rail, Track):
        return
    play = 0.5 * rail.gauge - float(wheel.section.y[deep[-1]])
    if not PLAY[0] <= play <= PLAY[1]:
        text = f"the flange is {play:.4g} m from the rail's inner face in the middle of the track, usually 0.005"
        cure = "check gauge, flange_back and flange_position"
        warnings.warn(f"{wheel.profile.name}: {text}: {cure}", ProfileWarning, stacklevel=4)


def _hertz(axle, force):
    """Overlaps by Hertz under a vertical force, m."""
    modulus, radius = axle.settings.modulus, axle.wheel.radius
    return ((force / (4.0 / 3.0 * modulus * math.sqrt(0.5 * radius))) ** (2.0 / 3.0),) * 2


def _scaled(start, load):
    """Overlaps of a neighbour under other loads, by Hertz: the lateral forces' moment is in proportion to the load."""
    if not all(found.patches for found in start.wheels):
        return [found.overlap for found in start.wheels]
    before = np.array([found.force[2] for found in start.wheels])
    half = 0.5 * (start.right.patches[0].y - start.left.patches[0].y)
    share = (before[0] - before[1]) / start.load.vertical + (load.offset - start.load.offset) / half
    if load.right is not None:
        share = 2.0 * load.right / load.vertical - 1.0
    share = min(max(share, -MOST), MOST)
    wanted = 0.5 * load.vertical * np.array([1.0 + share, 1.0 - share])
    ratio = wanted / np.maximum(before, (1.0 - MOST) * start.load.vertical)
    return [found.overlap * part ** (2.0 / 3.0) for found, part in zip(start.wheels, ratio)]


def _no_equilibrium(axle, position, load, state, cases):
    """The error of an iteration without an end."""
    right, left = (float(found.force[2]) for found in state.found)
    where = f"y {position.y:g} m, load {load.vertical:g} N: no equilibrium: the rails carry {right:.4g} N (right) and "
    tips = _tips(axle, load, state)
    if tips:
        return Error(f"{where}{left:.4g} N (left) at last: {tips}")
    rest = max(abs(state.values))
    if rest <= ALMOST:
        return Error(f"{where}{left:.4g} N (left), and {rest:.2g} of the load or its moment is left: {_jump(cases)}")
    return Error(
        f"{where}{left:.4g} N (left) at last: a wheel lifts or climbs: check offset, lateral, height and y, and the "
        "flange"
    )


def _wedged(axle, position, load, cases):
    """The error where forces are sought in overlaps that no elastic wheel has."""
    overlaps = [position.z - case.search.touch for case in cases]
    k = int(np.argmax(overlaps))
    slope = float(axle.pairs[k].rail.section.slope(np.array(_place(cases[k]))))
    return Error(
        f"y {position.y:g} m, load {load.vertical:g} N: no equilibrium up to an overlap of {overlaps[k]:.3g} m of the "
        f"{SIDES[k]} wheel, which touches at an angle of {abs(math.atan(slope)):.3g} rad: a flange climbs, or lies "
        "against its rail along its face: take another y"
    )


def _jump(cases):
    """Why the forces of wheels that do not lift jump."""
    if any(case.at_end for case in cases):
        return (
            "a contact is cut by the end of a visible profile, where the forces jump from cell to cell: give more of "
            "the profile"
        )
    return (
        "no wheel lifts, but a contact moves between two regions of its profiles, where the forces change much with "
        "the height: take y a little beside it"
    )


def _tips(axle, load, state):
    """Why the wheelset tips over where a flange carries most of the load; empty where it does not tip.

    On a face of the inclination d a wheel that carries the whole load needs a lateral force of load tan d; below the
    line in which it is applied this turns the wheelset about x by more than the load on one wheel can hold.
    """
    loads = [float(found.force[2]) for found in state.found]
    heavy = int(np.argmax(loads))
    if not loads[1 - heavy] < LIFTED * load.vertical or not state.found[heavy].patches:
        return ""
    angle = max(abs(patch.angle) for patch in state.found[heavy].patches)
    arm = axle.wheel.radius - load.height
    lever = state.half + (load.offset if heavy else -load.offset)
    if load.right is not None or math.tan(angle) < FACE or not 0.0 < lever < arm * math.tan(angle):
        return ""
    return (
        f"the {SIDES[heavy]} flange touches at an angle of {angle:.3g} rad, where the lateral force that holds the "
        f"wheelset, {arm:.3g} m above the rails, tips it, and the {SIDES[1 - heavy]} wheel lifts: above "
        f"about {math.atan(lever / arm):.3g} rad there is no equilibrium: give height, where it acts, or another y"
    )


def _point(case, sign):
    """y of the point that touches, in the track."""
    return sign * _place(case)


def _place(case):
    """y of the point that touches, of a right wheel."""
    return float(case.search.y[int(np.argmin(case.search.gap))])


def _part(result, position, radius, load):
    """Vertical force of a wheel, and its moment about x, which the axle load's balances."""
    force, moment = 0.0, 0.0
    centre = position.z - radius + load.height
    for patch in result.patches:
        (_, y, z), (_, fy, fz) = patch.centre, patch.force
        force += fz
        moment += (y - position.y) * fz - (z - centre) * fy
    return force, moment


def _distance(rotation, arm):
    """Distance of a point from the axle, m."""
    x, _, z = rotation.T @ arm
    return float(np.hypot(x, z))


def _radius(result, position, radius):
    """Rolling radius of a wheel: the mean over its patches by their normal forces."""
    centre = np.array([0.0, position.y, position.z - radius])
    found = [_distance(position.rotation, patch.centre - centre) for patch in result.patches]
    return float(np.average(found, weights=[patch.n for patch in result.patches])) if found else radius


def _derails(load, solved):
    reached = max((abs(one.lateral) for one in solved.values()), default=0.0)
    return Error(
        f"lateral {load.lateral:g} N: no lateral displacement up to {WIDEST:g} m gives it (up to {reached:.4g} N were "
        "found): the wheelset climbs: reduce it, or raise the axle load"
    )
