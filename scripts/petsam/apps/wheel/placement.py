"""Rails, rollers and wheels in their places in the track, and the functions that are 0 on their surfaces.

A rail is turned by its cant, its top moved to z = 0, and its innermost point within the gauge height to y = gauge/2; or
a given point of it to there.
The wheel's radius is r(y) = radius + z(y), y along the axle from the wheelset's middle.
"""

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Optional, Union

import numpy as np

from ...core.brief import brief
from ...core.errors import Error, Unusable
from .pose import Position
from .profile import FARTHEST, Profile, ProfileWarning
from .section import FLANGE, STEEPEST, STEP, Section, fine, path, visible

Place = Union[None, float, tuple[float, float]]
GAUGES = (0.05, 4.0)  # m
DEEPEST = 0.05  # m: gauge heights
SHORT = 1e-4  # m of a gauge height that a gauge face may lack
STRONGEST = 0.2  # rad: cant, 1:5
OUTWARD, INWARD = 0.02, 0.1  # rad by which a rail's head may lean away from the middle, and towards it
TWICE = 0.6  # of the cant: a head that leans by so much without it was drawn or measured in its place
HALF = 5e-3  # m: of the chord by which the slope of a head is found, which noise does not change
TURNS = 3  # of the head to its own axes
SHALLOW = 3e-3  # m below the top: both sides of a head are seen down to there where its lean is judged
TIP = (0.0, 0.05)  # m from a flange's back to its tip
USUAL = (0.008, 0.025)  # m: the same of most flanges
FACE = (0.005, 0.06)  # m from a rail's top to its gauge face, along y
BESIDE = 2e-3  # m from the flange's back in a profile to the one that is stated
TAPE = 0.07  # m from the flange's back to the tape circle
FAR = 0.01  # m: no tread, new or worn, is farther from the nominal radius there


def _need(value, what, low, high, cure):
    """Raises Unusable unless a number lies within a range."""
    if not low <= value <= high:
        raise Unusable(f"{what} {value:g}: {cure}")


def _need_kind(profile, kind, name):
    if not isinstance(profile, Profile):
        raise TypeError(f"{name}: expected a Profile, and not {type(profile).__name__}")
    if profile.kind != kind:
        raise Error(f"{profile.name}: is the profile of a {profile.kind}: {name} takes that of a {kind}")


def _to_gauge(profile, gauge, gauge_height, position):
    """Shift along y to the gauge, and height of the top, of a profile; by a point (y, z) or y of it, where given."""
    section = visible(profile)
    if position is not None:
        given = np.atleast_1d(np.asarray(position, dtype=float))
        if given.shape not in ((1,), (2,)) or not (np.abs(given) < FARTHEST).all():
            raise Unusable("gauge_position: expected y, or y and z, of a point in the profile, m")
        return 0.5 * gauge - float(given[0]), float(given[1]) if len(given) > 1 else _top(section), section
    curve = path(profile)
    points = curve(fine(curve))
    top = _top(section)
    _need_gauge_face(profile, points, top + gauge_height)
    inner = points[points[:, 1] <= top + gauge_height, 0]
    return 0.5 * gauge - _refined(points, top + gauge_height, float(inner.min())), top, section


def _need_gauge_face(profile, points, level):
    """Raises Error for a rail that reaches the gauge height on its field side alone: one that is mirrored."""
    y, z = points.T
    middle = y[int(np.argmin(z))]
    if z[y > middle].max(initial=-np.inf) > level > z[y < middle].max(initial=-np.inf):
        raise Error(
            f"{profile.name}: the rail reaches the gauge height on the field side alone, at greater y: the profile is "
            f"mirrored; {profile.taken.other_y(profile.kind)}"
        )


def _lean(section, depth):
    """Inclination of a rail's head away from the middle, rad: its slope in the middle of its width at a depth below the
    top, or where the shorter side ends, in the head's own axes; None where a side is not seen."""
    lean = 0.0
    for _ in range(TURNS):
        c, s = np.cos(lean), np.sin(lean)
        y, z = c * section.y + s * section.z, c * section.z - s * section.y
        k = int(np.argmin(z))
        down = min(depth, *(float(np.max(part - z[k])) for part in (z[: k + 1], z[k:])))
        if down < SHALLOW:
            return None
        deep = z - z[k] >= down
        middle = 0.5 * (y[int(np.flatnonzero(deep[: k + 1])[-1])] + y[k + int(np.flatnonzero(deep[k:])[0])])
        near = abs(y - middle) < 2.0 * HALF
        lean += float(np.arctan2(np.diff(np.interp(middle + np.array([-HALF, HALF]), y[near], z[near]))[0], 2.0 * HALF))
    return lean


def _doubt_lean(profile, section, cant, depth):
    """Warns of a rail whose head leans away from the middle, far towards it, or by its cant without it."""
    lean = _lean(section, depth)
    if lean is None or cant < 0.0:  # a negative cant has its own warning
        return
    own = lean + cant
    if own > OUTWARD:
        text = f"away from the middle by {_ratio(own)}: is it mirrored? {profile.taken.other_y(profile.kind)}"
    elif cant > 0.0 and -own > max(TWICE * cant, OUTWARD):
        text = (
            f"towards the middle by {_ratio(own)} in its points, and by {_ratio(lean)} with the cant: is it canted "
            "twice? Measured in its place, it is read without cant="
        )
    elif lean < -INWARD:
        text = (
            f"towards the middle by {_ratio(lean)}, more than 1:10: check whether it is turned, and take it "
            "without cant= if it was measured in its place"
        )
    else:
        return
    warnings.warn(f"{profile.name}: the rail's head leans {text}", ProfileWarning, stacklevel=4)


def _ratio(angle):
    return f"1:{abs(1.0 / np.tan(angle)):.2g}"


def _need_back(profile, section, position):
    """Raises Unusable for a wheel whose flange is not beside the back that is stated."""
    low = int(np.argmax(section.z))
    tip = float(section.y[low])
    if section.z[low] - np.median(section.z) < FLANGE or TIP[0] < tip - position < TIP[1]:
        return
    cure = "give flange_position, y of the flange's back in the profile"
    for back, name in ((0.0, "0mm: y counts from the back"), (-0.07, "-70mm, as of S1002")):
        if USUAL[0] < tip - back < USUAL[1]:
            cure = f"give flange_position {name}"
    raise Unusable(
        f"flange_position {position:g}: {profile.name}: the flange's tip is at y = {1e3 * tip:.4g} mm of the profile, "
        f"{1e3 * (tip - position):.4g} mm beside this back, usually 8 to 25 mm: {cure}"
    )


def _doubt_gauge_face(profile, cant, gauge_height, position):
    """Warns of a profile that ends on its gauge side before it reaches the gauge height: its end is taken; and of a
    given position where no rail has its gauge face."""
    turned = profile.turned(-cant)
    k = int(np.argmin(turned.z))
    if position is not None:
        aside = float(turned.y[k]) - float(np.ravel(position)[0])
        if not FACE[0] < aside < FACE[1]:
            warnings.warn(
                f"gauge_position {1e3 * np.ravel(position)[0]:.4g} mm: {profile.name}: the rail's top is at y = "
                f"{1e3 * turned.y[k]:.4g} mm, a gauge face usually 20 to 50 mm from it, towards smaller y: check it",
                ProfileWarning,
                stacklevel=4,
            )
        return
    depth = float((turned.z - turned.z[k])[turned.y <= turned.y[k]].max())
    if depth < gauge_height - SHORT:
        warnings.warn(
            f"{profile.name}: ends {1e3 * depth:.3g} mm below its top on the gauge side, above the gauge height of "
            f"{1e3 * gauge_height:.3g} mm: its innermost point is taken for the gauge face; give a gauge_height within "
            "it, or gauge_position, y of the gauge face in the profile",
            ProfileWarning,
            stacklevel=4,
        )


def _doubt_back(profile, position):
    """Warns of a wheel whose profile goes round its flange to a back at another y than is stated."""
    curve = path(profile)
    s = fine(curve)
    k = int(np.argmin(curve(s)[:, 0]))
    along, down = curve(s[k], 1)
    back = float(curve(s[k])[0])
    if abs(down) > STEEPEST * abs(along) and abs(back - position) > BESIDE:
        warnings.warn(
            f"{profile.name}: the flange's back is at y = {1e3 * back:.4g} mm of the profile, and flange_position is "
            f"{1e3 * position:.4g} mm: give flange_position {1e3 * back:.4g}mm, unless the flange's back is elsewhere",
            ProfileWarning,
            stacklevel=4,
        )


def _doubt_height(profile, section, position):
    """Warns of a wheel whose tread is far from z = 0 of the profile, where its radius counts."""
    tape = position + TAPE
    z = float(section.height(np.array(tape)))
    if section.first <= tape <= section.last and abs(z) > FAR:
        warnings.warn(
            f"{profile.name}: its z is {1e3 * z:.4g} mm at the tape circle, y = {1e3 * tape:.4g} mm, and the radius "
            "counts at z = 0: give tape_line, y where the radius is the nominal one, or shift the profile's z to 0 "
            "there",
            ProfileWarning,
            stacklevel=4,
        )


def _top(section):
    """Height of the highest point, between the points by a parabola, m."""
    k = int(np.argmin(section.z))
    if not 0 < k < len(section.z) - 1:
        return float(section.z[k])
    a, b, c = section.z[k - 1 : k + 2]
    return float(b - 0.125 * (c - a) ** 2 / (a - 2.0 * b + c)) if a - 2.0 * b + c > 0.0 else float(b)


def _refined(points, level, inner):
    """y of the innermost point above a level: where the curve crosses it, between the points."""
    y, z = points.T
    cross = np.flatnonzero((z[:-1] - level) * (z[1:] - level) < 0.0)
    if not len(cross):
        return inner
    part = (level - z[cross]) / (z[cross + 1] - z[cross])
    return min(inner, float((y[cross] + part * (y[cross + 1] - y[cross])).min()))


@brief
@dataclass(frozen=True, eq=False)
class Track:
    """A rail of a track; that of the right side, whose mirror image the left one is.

    Parameters
    ----------
    profile : Profile
        Of a rail.
    gauge : float
        Distance of the rails' inner faces, m.
    gauge_height : float
        Depth below the rails' tops down to which the inner face counts, m.
    cant : float
        Inclination of the rail towards the middle, rad: 0.025 of 1:40; 0 of a profile that was drawn or measured in its
        place.
    curvature : float
        Of the track, 1/m, positive to the right.
    gauge_position : float or tuple of float, optional
        y of the profile, turned by its cant, that lies at half the gauge, or y and z of a point that lies there at
        z = 0, m: of a profile without a gauge face, instead of gauge_height.

    Raises
    ------
    Error
        If a number is not of this quantity in this unit, or the profile cannot be seen from a wheel.

    Notes
    -----
    A ProfileWarning is issued of a cant that leans away from the middle, of a head that leans so, leans far towards the
    middle, or leans by the cant without it, and of a gauge side that ends above the gauge height.
    """

    profile: Profile
    gauge: float = 1.435
    gauge_height: float = 0.014
    cant: float = 0.0
    curvature: float = 0.0
    gauge_position: Place = None
    roller_radius = np.inf

    def __post_init__(self) -> None:
        _need_kind(self.profile, "rail", "Track")
        _need(self.gauge, "gauge", *GAUGES, "expected the distance of the rails' inner faces, m, such as 1.435")
        _need(self.gauge_height, "gauge_height", 0.0, DEEPEST, "expected a depth below the rail's top, m, as 0.014")
        _need(self.cant, "cant", -STRONGEST, STRONGEST, "expected rad: 1:40 is 0.025")
        if self.cant < 0.0:
            warnings.warn(
                f"cant {self.cant:g} rad leans away from the middle: is {-self.cant:g} meant?",
                ProfileWarning,
                stacklevel=3,
            )
        self.section  # noqa: B018  fails early
        _doubt_gauge_face(self.profile, self.cant, self.gauge_height, self.gauge_position)
        _doubt_lean(self.profile, self.section, self.cant, self.gauge_height)

    @cached_property
    def section(self) -> Section:
        """The rail's visible part in the track."""
        turned = self.profile.turned(-self.cant)
        shift, top, section = _to_gauge(turned, self.gauge, self.gauge_height, self.gauge_position)
        return section.moved(shift, -top)

    def surface(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Height z of the rail's surface, m.

        Parameters
        ----------
        x, y : ndarray
            Places in the track, m.

        Returns
        -------
        ndarray
        """
        return self.section.height(y) + 0.0 * x

    def level(self, points: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A function that is 0 on the surface and grows into the body, and its derivative along a direction.

        Parameters
        ----------
        points : ndarray
            (3, ...), m.
        direction : ndarray
            Unit vector, (3,).

        Returns
        -------
        level, derivative : ndarray
            m, and 1.
        """
        _, y, z = points
        height, slope = self.section.height_and_slope(y)
        return z - height, direction[2] - slope * direction[1]

    def velocity(self, point: np.ndarray, motion: Position) -> tuple[np.ndarray, np.ndarray]:
        """Velocity of the rail at a point in the frame that runs with the wheelset, and its rate of rotation.

        Parameters
        ----------
        point : ndarray
            (3,), m.
        motion : Position
            Has the speed.

        Returns
        -------
        velocity, rate : ndarray
            (3,), m/s and rad/s.
        """
        rate = np.array([0.0, 0.0, -motion.speed * self.curvature])
        return np.cross(rate, point), rate

    def mirrored(self) -> "Track":
        """The track as seen in a mirror: its curvature changes its sign.

        Returns
        -------
        Track
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ProfileWarning)  # they were issued of this track
            return replace(self, curvature=-self.curvature)


@brief
@dataclass(frozen=True, eq=False)
class Roller:
    """A roller of a test rig in place of a rail: a body of revolution about an axis along y.

    Parameters
    ----------
    profile : Profile
        Of a rail, whose z = 0 is the roller's nominal radius; it is not moved along z.
    radius : float
        Nominal radius, m.
    gauge, gauge_height : float
        See Track; the height counts from the profile's highest point.
    gauge_position : float or tuple of float, optional
        See Track; of y and z, the roller has its nominal radius at z.

    Raises
    ------
    Error
        If a number is not of this quantity in this unit, or the profile cannot be seen from a wheel.

    Notes
    -----
    A ProfileWarning is issued of a gauge side that ends above the gauge height.
    """

    profile: Profile
    radius: float
    gauge: float = 1.435
    gauge_height: float = 0.014
    gauge_position: Place = None

    def __post_init__(self) -> None:
        _need_kind(self.profile, "rail", "Roller")
        _need(self.radius, "radius", 0.01, 50.0, "expected the roller's nominal radius, m, such as 0.7")
        _need(self.gauge, "gauge", *GAUGES, "expected the distance of the rollers' inner faces, m, such as 1.435")
        _need(self.gauge_height, "gauge_height", 0.0, DEEPEST, "expected a depth below the top, m, as 0.014")
        self.section  # noqa: B018  fails early
        _doubt_gauge_face(self.profile, 0.0, self.gauge_height, self.gauge_position)

    @property
    def roller_radius(self) -> float:
        """Nominal radius, m."""
        return self.radius

    @cached_property
    def section(self) -> Section:
        """The roller's visible part in the track."""
        shift, top, section = _to_gauge(self.profile, self.gauge, self.gauge_height, self.gauge_position)
        return section.moved(shift, -top if np.size(self.gauge_position) > 1 else 0.0)

    def surface(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Height z of the roller's surface, m.

        Parameters
        ----------
        x, y : ndarray
            Places in the track, m.

        Returns
        -------
        ndarray
        """
        rho = self.radius - self.section.height(y)
        return self.radius - np.sqrt(np.maximum(rho * rho - x * x, 0.0))

    def level(self, points: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A function that is 0 on the surface and grows into the body, and its derivative along a direction.

        Parameters
        ----------
        points : ndarray
            (3, ...), m.
        direction : ndarray
            Unit vector, (3,).

        Returns
        -------
        level, derivative : ndarray
            m, and 1.
        """
        x, y, z = points[0], points[1], points[2] - self.radius
        distance = np.hypot(x, z)
        toward = (x * direction[0] + z * direction[2]) / distance
        height, slope = self.section.height_and_slope(y)
        return self.radius - height - distance, -slope * direction[1] - toward

    def velocity(self, point: np.ndarray, motion: Position) -> tuple[np.ndarray, np.ndarray]:
        """Velocity of the roller at a point, and its rate of rotation.

        Parameters
        ----------
        point : ndarray
            (3,), m.
        motion : Position
            Has the roller's rate.

        Returns
        -------
        velocity, rate : ndarray
            (3,), m/s and rad/s.
        """
        rate = np.array([0.0, motion.roller_rate, 0.0])
        return np.cross(rate, point - np.array([0.0, 0.0, self.radius])), rate

    def mirrored(self) -> "Roller":
        """The roller as seen in a mirror: the same.

        Returns
        -------
        Roller
        """
        return self


@brief
@dataclass(frozen=True, eq=False)
class Wheelset:
    """A wheel of a wheelset; that of the right side, whose mirror image the left one is.

    Parameters
    ----------
    profile : Profile
        Of a wheel.
    radius : float
        Nominal radius, m, at z = 0 of the profile, or at the tape line.
    flange_back : float
        Distance of the backs of both flanges, m.
    flange_position : float
        y of the flange's back in the profile, m: -0.07 of S1002.
    tape_line : float, optional
        y of the tape line in the profile, m, where the radius is the nominal one.
    excess : float
        m by which the wheel is larger than this radius there, as the left one of a wheelset with two radii.

    Raises
    ------
    Error
        If a number is not of this quantity in this unit, the flange's tip is far from its back, or the profile cannot
        be seen from a rail: one with its flange on the field side, or pointing up.

    Notes
    -----
    A ProfileWarning is issued of a profile that goes round its flange to a back at another y, and, without a tape line,
    of one whose z is beyond 10 mm at the tape circle, 70 mm from the flange's back.
    """

    profile: Profile
    radius: float
    flange_back: float = 1.36
    flange_position: float = -0.07
    tape_line: Optional[float] = None
    excess: float = 0.0

    def __post_init__(self) -> None:
        _need_kind(self.profile, "wheel", "Wheelset")
        _need(self.radius, "radius", 0.01, 5.0, "expected the wheel's nominal radius, m, such as 0.46")
        _need(
            self.flange_back, "flange_back", 0.0, GAUGES[1], "expected the distance of the flanges' backs, m, as 1.36"
        )
        _need(self.flange_position, "flange_position", -1.0, 1.0, "expected y of the flange's back in the profile, m")
        section = visible(self.profile)
        _need_back(self.profile, section, self.flange_position)
        _doubt_back(self.profile, self.flange_position)
        if self.tape_line is None:
            _doubt_height(self.profile, section, self.flange_position)
        elif not section.first <= self.tape_line <= section.last:
            raise Error(f"tape_line {self.tape_line:g}: the profile is from {section.first:g} to {section.last:g} m")
        if not 0.5 * self.radius < self.section.z.min() + self.radius:
            raise Error(f"radius {self.radius:g}: the profile is too deep for it: check the units of both")

    @cached_property
    def section(self) -> Section:
        """The visible part: z, 0 at the nominal radius, over y along the axle from the wheelset's middle."""
        section = visible(self.profile)
        down = 0.0 if self.tape_line is None else float(section.height(np.array(self.tape_line)))
        return section.moved(self.offset, self.excess - down)

    @cached_property
    def line(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """y, z and slope of points of the visible part in small steps, m and 1, (n,) each."""
        section = self.section
        y = np.linspace(section.first, section.last, int(np.ceil((section.last - section.first) / STEP)) + 1)
        return y, section.height(y), section.slope(y)

    def of_radius(self, radius: float) -> "Wheelset":
        """The same wheel with another nominal radius to count from: that of the other wheel of its wheelset.

        Parameters
        ----------
        radius : float
            m.

        Returns
        -------
        Wheelset
        """
        return (
            self if radius == self.radius else replace(self, radius=radius, excess=self.radius - radius + self.excess)
        )

    @property
    def offset(self) -> float:
        """y of the profile's origin along the axle, m."""
        return 0.5 * self.flange_back - self.flange_position

    def level(self, points: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A function that is 0 on the surface and grows out of the body, and its derivative along a direction.

        Parameters
        ----------
        points : ndarray
            In the wheelset's axes, (3, ...), m.
        direction : ndarray
            Unit vector in the same axes, (3,).

        Returns
        -------
        level, derivative : ndarray
            m, and 1.
        """
        x, y, z = points
        distance = np.sqrt(x * x + z * z)
        toward = (x * direction[0] + z * direction[2]) / distance
        height, slope = self.section.height_and_slope(y)
        return distance - self.radius - height, toward - slope * direction[1]
