"""Rails and rollers in their places in the track, and the functions that are 0 on their surfaces.

A rail is turned by its cant, its top moved to z = 0, and its innermost point within the gauge height to y = gauge/2; or
a given point of it to there.
"""

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Union

import numpy as np

from ...core.brief import brief
from ...core.errors import Error, Unusable
from .checks import GAUGES, need, need_kind
from .leaning import doubt_lean
from .pose import Position
from .profile import FARTHEST, Profile, ProfileWarning
from .section import Section, fine, path, visible

Place = Union[None, float, tuple[float, float]]
DEEPEST = 0.05  # m: gauge heights
SHORT = 1e-4  # m of a gauge height that a gauge face may lack
STRONGEST = 0.2  # rad: cant, 1:5
FACE = (0.005, 0.06)  # m from a rail's top to its gauge face, along y


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
        need_kind(self.profile, "rail", "Track")
        need(self.gauge, "gauge", *GAUGES, "expected the distance of the rails' inner faces, m, such as 1.435")
        need(self.gauge_height, "gauge_height", 0.0, DEEPEST, "expected a depth below the rail's top, m, as 0.014")
        need(self.cant, "cant", -STRONGEST, STRONGEST, "expected rad: 1:40 is 0.025")
        if self.cant < 0.0:
            warnings.warn(
                f"cant {self.cant:g} rad leans away from the middle: is {-self.cant:g} meant?",
                ProfileWarning,
                stacklevel=3,
            )
        self.section  # noqa: B018  fails early
        _doubt_gauge_face(self.profile, self.cant, self.gauge_height, self.gauge_position)
        doubt_lean(self.profile, self.section, self.cant, self.gauge_height)

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
        need_kind(self.profile, "rail", "Roller")
        need(self.radius, "radius", 0.01, 50.0, "expected the roller's nominal radius, m, such as 0.7")
        need(self.gauge, "gauge", *GAUGES, "expected the distance of the rollers' inner faces, m, such as 1.435")
        need(self.gauge_height, "gauge_height", 0.0, DEEPEST, "expected a depth below the top, m, as 0.014")
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
