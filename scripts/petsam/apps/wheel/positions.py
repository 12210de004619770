"""The solution at a position of the wheelset: at a given height, or under a vertical force.

The force is found by a secant in the logarithms of overlap and force, of slope 1.5 at first, by steps of at most a
factor of 2, and by bisection where it leaves the bracket. Frames, boxes and creepages follow the overlap.
"""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Optional, Union

import numpy as np

from ...contact.errors import AdviceWarning
from ...contact.inprocess import Contact
from ...core.errors import Error, Unusable
from . import contacts, gap
from .creepages import creepages
from .locus import locus, near
from .patches import STEP, Place, Search, places, search
from .pose import Frame, Position
from .profile import ProfileWarning
from .rails import Roller, Track
from .result import ConformalWarning, Drafted, Patch, Result
from .wheelset import Wheelset

CONFORMAL = 0.24  # rad: 3 % in the distance
DEEPEST = 1e-3  # m: no elastic wheel overlaps a rail by more
REACH = 1.5e-4  # m: overlaps up to it are searched where the gap is little above its least value
PASSES = 60
SIDES = ("right", "left")
Friction = Union[float, Callable[[float], float]]


class Pair:
    """A wheel on its rail: solves positions one after the other and keeps what they share.

    Parameters
    ----------
    rail : Track or Roller
        The rail.
    wheel : Wheelset
        The wheel.
    friction : float or callable
        Coefficient of friction, or a function of a patch's angle (rad) that returns it; the angle of a left
        wheel is that of its mirror image, the right one.
    side : str
        right, or left: positions and results of a left wheel are those of the left side, profiles those of the right.
    settings : Settings, optional
        Materials, cells and limits.
    extrapolate : bool
        True: loads are extrapolated to fine grids, too, for the error by the cells in warnings.

    Raises
    ------
    Error
        If the side or the friction is none.
    TypeError
        If rail or wheel is not of its class.
    """

    def __init__(
        self,
        rail: Union[Track, Roller],
        wheel: Wheelset,
        friction: Friction = 0.3,
        side: str = "right",
        settings: Optional[contacts.Settings] = None,
        extrapolate: bool = True,
    ) -> None:
        if not isinstance(rail, (Track, Roller)) or not isinstance(wheel, Wheelset):
            raise TypeError("expected a Track or Roller, and a Wheelset")
        if side not in SIDES:
            raise Error(f"side {side!r}: expected {' or '.join(SIDES)}")
        self.side = side
        self.rail, self.wheel, self.friction = (rail if side == "right" else rail.mirrored()), wheel, friction
        self.settings = contacts.Settings() if settings is None else settings
        self._contacts = contacts.Contacts(self.settings, extrapolate)
        _coefficient(friction, 0.0)

    def __enter__(self) -> Pair:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def close(self) -> None:
        """Frees the contacts."""
        self._contacts.close()

    def solve(self, position: Position, force: Optional[float] = None) -> Result:
        """The solution at a position.

        Parameters
        ----------
        position : Position
            Position and speeds; its z is given, or the force.
        force : float, optional
            Vertical force on the rail, N, with the vertical parts of all tangential forces.

        Returns
        -------
        Result

        Raises
        ------
        Error
            If both or neither of z and force are given, the wheel is beside the rail, the bodies overlap too much, or
            no height gives the force.
        ContactError
            If a patch has no solution.

        Notes
        -----
        A ConformalWarning is issued where the inclination within a contact differs by more than 0.24 rad from that of
        its patch, a ProfileWarning where a contact reaches the end of a profile, an AdviceWarning where the cells do
        not resolve a contact.
        """
        if (position.z is None) == (force is None):
            raise Error("solve: give the height z of the Position, or the vertical force, and not both")
        if force is not None and not 0.0 < force < math.inf:
            raise Error(f"force {force:g}: expected a vertical force above 0, N")
        if self.side == "left":
            position = position.mirrored()
        case = Case(self, position)
        found = case.at(position.z or 0.0) if force is None else _under(case, force)
        case.warn(found)
        return found if self.side == "right" else found.mirrored()


def solve(
    rail: Union[Track, Roller],
    wheel: Wheelset,
    position: Position,
    force: Optional[float] = None,
    friction: Friction = 0.3,
    side: str = "right",
    settings: Optional[contacts.Settings] = None,
) -> Result:
    """The solution at one position; several of the same pair of profiles are faster by Pair.

    Parameters
    ----------
    rail, wheel, friction, side, settings
        See Pair.
    position, force
        See Pair.solve().

    Returns
    -------
    Result

    Raises
    ------
    Error, ContactError
        See Pair.solve().
    """
    with Pair(rail, wheel, friction, side, settings) as pair:
        return pair.solve(position, force)


def _coefficient(friction, angle):
    """The coefficient of friction at an angle."""
    value = float(friction(angle) if callable(friction) else friction)
    if not 0.0 <= value < 10.0:
        raise Unusable(f"friction {value:g} at the angle {angle:g} rad: expected a coefficient from 0 on")
    return value


@dataclass(frozen=True, eq=False)
class _Laid:
    """The undeformed bodies on the grid of a patch."""

    contact: Contact
    middle: np.ndarray
    x: np.ndarray
    s: np.ndarray
    apart: np.ndarray
    y: np.ndarray
    approach: float


class Case:
    """A position but for its height: the locus, and the patches at a height, of a wheel on its rail in the position of
    a right wheel, whose z does not count. `search` has the gap and the height at which the bodies touch; `passes`
    counts the solutions. Raises Error if the wheel is beside the rail."""

    def __init__(self, pair: Pair, position: Position) -> None:
        self.pair, self.position, self.passes = pair, position, 0
        self.rotation = position.rotation
        self.pitch = position.pitch(pair.wheel.radius)
        found = self._near() or self._whole()
        if found is None:
            raise Error(
                f"y {position.y:g}: the wheel is beside the rail: check gauge, flange_back, flange_position and their "
                "unit (m)"
            )
        self.search: Search = found
        self.advice: dict[str, str] = {}  # the last text of each kind
        self._warned: list[tuple[type, str]] = []

    def _near(self):
        """The search where the gap is little above its least value; None where that does not suffice."""
        pair = self.pair
        part = near(pair.rail, pair.wheel, self.rotation, self.position.y, REACH)
        return part and search(pair.rail, pair.wheel.radius, *part)

    def _whole(self):
        """The search along the whole locus."""
        pair = self.pair
        return search(pair.rail, pair.wheel.radius, locus(pair.rail, pair.wheel, self.rotation, self.position.y))

    def at(self, z: float, draft: Optional[Result] = None) -> Result:
        """The solution of a right wheel at a height of the wheelset, m. Grids need not be larger than the contacts of a
        draft near it, on which the solution does not depend. Raises Error if the bodies overlap too much."""
        self.passes += 1
        self._warned = []
        return self._result(z, self._patch, draft)

    def draft(self, z: float) -> Result:
        """A draft of the solution of a right wheel at a height of the wheelset, m, on coarser cells: a fraction of the
        work of at(); its patches are Drafted. Raises Error if the bodies overlap too much."""

        def patch(frame, place, _):
            laid = self._laid(frame, place, True)
            if laid is None:
                return None
            found, creeps, _ = self._solved(frame, place, laid)
            pressure = laid.contact["pressure"]
            x, s = (pressure.sum(axis=0) @ laid.x, pressure.sum(axis=1) @ laid.s) / pressure.sum()
            fx, fs = map(float, -found.shear)
            box = _around(laid, pressure, self.pair._contacts.cell(True))
            centre = place.origin + x * place.axes[0] + s * place.axes[1]
            return Drafted(centre, place.angle, found.n, fx, fs, *box, _torque(found, creeps))

        return self._result(z, patch)

    def _result(self, z, patch, draft=None):
        """The patches at a height, by a function of the wheelset's frame, a place, and its patch in a draft or None."""
        if z - self.search.touch > DEEPEST:
            raise Error(
                f"z {z:g}: the bodies overlap by {z - self.search.touch:.3g} m: z is 0 at the nominal height and "
                f"positive down; they touch at {self.search.touch:.6g}"
            )
        if z - self.search.touch > REACH and any(self.search.cut):
            self.search = self._whole()
        frame = Frame(self.rotation, np.array([0.0, self.position.y, z - self.pair.wheel.radius]))
        settings = self.pair.settings
        found = places(self.search, self.search.regions(z), settings.separation, settings.combination)
        drafted = draft.patches if draft is not None and len(draft.patches) == len(found) else [None] * len(found)
        patches = [patch(frame, place, one) for place, one in zip(found, drafted)]
        return Result(tuple(one for one in patches if one is not None), float(z), self.search.touch, self.passes)

    def _laid(self, frame: Frame, place: Place, draft: bool) -> Optional[_Laid]:
        """The undeformed bodies on the grid of a patch; None where no cell touches."""
        pair = self.pair
        contact = pair._contacts.of(place.high - place.low, draft)
        cell = pair._contacts.cell(draft)  # the origin is a cell's centre: results change little from grid to grid
        middle = (np.round(0.5 * (place.low + place.high) / cell - 0.5) + 0.5) * cell
        x, s = middle[0] + contact.x, middle[1] + contact.y
        apart, y = gap.separation(pair.rail, pair.wheel, frame, place, x, s)
        approach = -float(apart.min())
        return _Laid(contact, middle, x, s, apart, y, approach) if approach > 0.0 else None

    def _patch(self, frame: Frame, place: Place, drafted: Optional[Drafted] = None) -> Optional[Patch]:
        """The solution on a patch, on a grid for the contact of a draft where it suffices; None where no cell
        touches."""
        pair, laid = self.pair, self._laid(frame, _within(place, drafted), False)
        if laid is None:
            return None
        contact, x, y, approach, cell = laid.contact, laid.x, laid.y, laid.approach, pair.settings.cell
        found, creeps, friction = self._solved(frame, place, laid)
        if drafted is not None and (_at_edge(contact["pressure"]) or self._beyond(place, laid)):
            return self._patch(frame, place)
        for text in found.advice:
            text, use, _ = text.partition(": use ")
            kind = re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "", text)
            self.advice[kind] = f"patch at y = {place.origin[1]:.6g} m: {text}" + ": try a smaller cell" * bool(use)
        pressure = contact["pressure"]
        self._doubt(place, np.arctan(pair.rail.section.slope(y[pressure > 0.0])))
        numbers, power = found.numbers, contact["power_density"]
        tx, ts = map(float, found.shear)
        px, py, pz = map(float, place.origin)
        return Patch(
            x=px, y=py, z=pz, angle=place.angle, creep_x=creeps.x, creep_s=creeps.s, creep_spin=creeps.spin,
            speed=creeps.speed, friction=friction, n=found.n, fx=-tx, fs=-ts, mn=-found.moment, approach=approach,
            p_max=numbers["pressure_max"], area=numbers["contact_area"], stick_area=numbers["stick_area"],
            cells=int(numbers["contact_cells"]), stick_cells=int(numbers["stick_cells"]), grid=contact.n,
            grid_x=x, grid_s=laid.s, pressure=pressure, t_gamma=float(power.sum()) * cell * cell, power=power,
            slip=np.hypot(contact["slip_velocity_x"], contact["slip_velocity_y"]),
            wheel_y=self._along_wheel(frame, np.asarray(x), y), torque=_torque(found, creeps),
        )  # fmt: skip

    def _solved(self, frame, place, laid):
        """The solution of a contact, its creepages and its friction."""
        creeps = creepages(self.pair.rail, frame, self.pitch, self.position, place, laid.approach)
        friction = _coefficient(self.pair.friction, place.angle)
        gap_of_cells = laid.apart + laid.approach
        found = contacts.solved(laid.contact, gap_of_cells, laid.approach, creeps[:3], friction, laid.middle)
        return found, creeps, friction

    def _beyond(self, place, laid):
        """True if bodies that the pressure deforms overlap beyond the grid, where another part of the contact is."""
        x, s, overlap = place.line[:, :: max(round(self.pair.settings.cell / STEP), 1)]
        out = (overlap > 0.0) & ((s < laid.s[0]) | (s > laid.s[-1]) | (x < laid.x[0]) | (x > laid.x[-1]))
        if not out.any():
            return False
        pressure = laid.contact["pressure"]
        rows, columns = np.nonzero(pressure)
        force = pressure[rows, columns] * self.pair.settings.cell**2
        apart = np.hypot(x[out, None] - laid.x[columns], s[out, None] - laid.s[rows])
        return bool((overlap[out] > (1.0 / apart) @ force / (np.pi * self.pair.settings.modulus)).any())

    def _along_wheel(self, frame, x, y):
        """y of the wheel's profile at the middle of each row of cells."""
        y = y[:, int(np.argmin(np.abs(x)))]
        points = np.stack([np.zeros_like(y), y, self.pair.rail.section.height(y)])
        return frame.inward(points)[1] - self.pair.wheel.offset

    @property
    def at_end(self) -> bool:
        """True where a contact of the last pass is cut by the end of a profile."""
        return any(kind is ProfileWarning for kind, _ in self._warned)

    def _doubt(self, place, angles):
        """Keeps warnings about the patch of this pass."""
        most = float(np.abs(angles - place.angle).max(initial=0.0))
        if most > CONFORMAL:
            text = f"the inclination within the contact differs by {most:.2f} rad from its mean: it is conformal"
            self._warned.append((ConformalWarning, f"patch at y = {place.origin[1]:.6g} m: {text}"))
        if place.at_end:
            text = "the overlap reaches the end of a visible profile: the contact is cut there"
            self._warned.append((ProfileWarning, f"patch at y = {place.origin[1]:.6g} m: {text}"))

    def warn(self, result: Result) -> None:
        """Issues the warnings of the last pass."""
        for kind, text in self._warned:
            warnings.warn(text, kind, stacklevel=3)
        for text in self.advice.values():
            warnings.warn(text, AdviceWarning, stacklevel=3)


def _torque(found, creeps):
    """Torque of a patch's tangential forces on the wheel about its axle, N m."""
    return float(np.append(found.shear, found.moment) @ creeps.pitch)


def _around(laid, pressure, cell):
    """Corners of the box of the cells in contact and one around them, in the patch, m."""
    ends = [at[np.flatnonzero(pressure.any(axis=k))[[0, -1]]] for k, at in enumerate((laid.x, laid.s))]
    return np.array([[low - 1.5 * cell, high + 1.5 * cell] for low, high in ends]).T


def _within(place, drafted):
    """A patch with its box cut to that of a draft."""
    if drafted is None:
        return place
    low, high = np.maximum(place.low, drafted.low), np.minimum(place.high, drafted.high)
    return replace(place, low=low, high=high) if (low < high).all() else place


def _at_edge(pressure):
    """True if cells at the edge of a grid are in contact."""
    return bool(pressure[[0, -1]].any() or pressure[:, [0, -1]].any())


def _under(case: Case, force: float) -> Result:
    """The solution under a vertical force."""
    touch, rtol = case.search.touch, case.pair.settings.rtol
    radius, modulus = case.pair.wheel.radius, case.pair.settings.modulus
    overlap = (force / (4.0 / 3.0 * modulus * math.sqrt(0.5 * radius))) ** (2.0 / 3.0)
    low, high, before = 0.0, math.inf, None  # overlaps with too little and too much force; log overlap, log force
    for _ in range(PASSES):
        if overlap > DEEPEST:
            raise _unreachable(case, force)
        found = case.at(touch + overlap)
        vertical = float(found.force[2])
        if abs(vertical - force) <= rtol * force:
            return found
        low, high = (overlap, high) if vertical < force else (low, overlap)
        overlap, before = _next(overlap, vertical, force, before, (low, high))
    raise _unreachable(case, force)


def _next(overlap, vertical, force, before, bracket):
    """The next overlap, and the logarithms of the last overlap and force."""
    low, high = bracket
    if vertical <= 0.0:
        return 2.0 * overlap if high == math.inf else 0.5 * (low + high), None
    now = math.log(overlap), math.log(vertical)
    slope = 1.5
    if before and now[0] != before[0]:
        slope = (now[1] - before[1]) / (now[0] - before[0])
        slope = slope if slope > 0.1 else 1.5
    step = min(max((math.log(force) - now[1]) / slope, -math.log(2.0)), math.log(2.0))
    guess = overlap * math.exp(step)
    if not low < guess < high:
        guess = 0.5 * (low + high) if low > 0.0 else 0.5 * high
    return guess, now


def _unreachable(case, force):
    """The error where no height gives the force."""
    regions = case.search.regions(case.search.touch + 1e-5)
    angle = max((case.search.place(region).angle for region in regions), key=abs, default=0.0)
    friction = _coefficient(case.pair.friction, angle)
    return Error(
        f"force {force:g} N: no height gives it: at the angle {angle:.3f} rad and friction {friction:g} the tangential "
        "force carries the wheel (beyond tan d = 1/mu no force does, Nadal's limit), or the force is too large: give z "
        "of the Position instead"
    )
