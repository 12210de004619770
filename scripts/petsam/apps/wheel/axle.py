"""A wheelset on both rails: roll and height from the equilibrium of vertical forces and of moments about x.

Where a lateral force is given, the lateral displacement is found around it. Inertia is left out: give the forces that
remain at the wheelset.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from typing import Any, Optional

import numpy as np
from scipy.optimize import brentq

from ...core.errors import Error, Unusable
from . import contacts
from .cells import WIDER
from .equilibrium import Equilibrium, Load
from .lifting import FACE, WIDEST, derails, no_equilibrium
from .places import distance, place
from .pose import Position
from .positions import SIDES, Case, Friction, Pair
from .profile import ProfileWarning
from .rails import Track
from .search import PASSES, ROLLINGS, Search, hertz
from .wheelset import Wheelset

TURNS = 40  # of the search for the roll of rigid bodies
TURN = 2e-3  # rad by which the roll of rigid bodies changes at once
LEAST_ARM = 0.1  # m: of the distance of both contacts, which steep flanges shorten for the roll
SHARE = 1e-9  # m: overlaps of rigid bodies agree to it
STEP = 2e-3  # m: of the search for a lateral force
STARTS = 2  # neighbours from which an equilibrium under a lateral force is tried, before rigid bodies
MOST = 0.9  # of the load: difference of both wheels' loads with which an iteration begins
LEAST_STEP = 4e-6  # m: of it towards displacements without an equilibrium
FLANGE = 0.01  # m below the nominal radius, where the thickness of the flange is measured
PLAY = (0.0, 0.02)  # m: usual distances of flange and rail
CLOSE = 1e-8  # m: of the lateral displacement under a lateral force


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
        self._given = both, friction
        self._wider: Optional[Axle] = None
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
        if self._wider is not None:
            self._wider.close()

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
        return Rigid(replace(now, z=z), (place(cases[0]), -place(cases[1])), self._radii(now, cases, z))

    def _radii(self, position, cases, z):
        """Distances of the points that touch from the axle, m."""
        found = []
        for case, sign in zip(cases, (1.0, -1.0)):
            k = int(np.argmin(case.search.gap))
            at = np.array([case.search.x[k], sign * case.search.y[k], case.search.z[k]])
            found.append(distance(position.rotation, at - np.array([0.0, position.y, z - self.wheel.radius])))
        return tuple(found)

    def _arms(self, cases, position):
        """By how much the heights at which both wheels touch fall with the roll, right and left, m: the lateral arm of
        the contact, and its arm below the axle times the inclination, as a flange moves aside with the roll."""
        found = []
        for case, pair, sign in zip(cases, self.pairs, (1.0, -1.0)):
            y = place(case)
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

    def wider(self, position: Position, found: Equilibrium) -> Optional[Equilibrium]:
        """The equilibrium on cells twice as wide, whose iteration begins with the one found for this position: a
        fraction of its work.

        Parameters
        ----------
        position : Position
            As given to solve().
        found : Equilibrium
            Its result, not under a given lateral force.

        Returns
        -------
        Equilibrium or None
            None where wider cells have none nearby, or would be wider than cells may be.
        """
        cell = WIDER * self.settings.cell
        if cell > contacts.WIDEST:
            return None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # solve() has issued them
            if self._wider is None:
                (right, left), friction = self._given
                settings = replace(self.settings, cell=cell)
                self._wider = Axle(*right, friction, settings, left, self.rolling)
            start = replace(found.position, z=None, pitch_rate=position.pitch_rate)
            search = Search(self._wider, start, found.load, found)
            try:
                search.begin(tuple(one.overlap for one in found.wheels))
                state = search.beside(found.position)
                return None if state is None else search.equilibrium(state)
            except Error:
                return None

    def _aside(self, position, load, start):
        """The equilibrium under a lateral force."""
        solved = {}  # by the displacement aside, m

        def excess(y, most=STARTS):
            near = sorted(solved.values(), key=lambda one: abs(one.position.y - y))[:most] or [start]
            more = [None] if near[0] and most > 1 else []
            found = self._from_any(replace(position, y=y), load, [*near, *more])
            if found.derailed:
                raise derails(load, solved)
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
                    raise derails(load, solved) from None
        else:
            if first:
                raise derails(load, solved)
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
        search = Search(self, position, load, start)
        overlaps = hertz(self, 0.5 * load.vertical)
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
        raise no_equilibrium(self, position, load, state, search.cases)

    def _steep(self, cases):
        """True if a wheel touches on its flange."""
        slopes = [abs(float(pair.rail.section.slope(place(case)))) for case, pair in zip(cases, self.pairs)]
        return max(slopes) > FACE


@dataclass(frozen=True, eq=False)
class Rigid:
    """Rigid wheels that touch their rails: the position with its roll and height, y in the track of the points that
    touch (m), and their distances from the axle (m), right and left."""

    position: Position
    points: tuple[float, float]
    radii: tuple[float, float]


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
