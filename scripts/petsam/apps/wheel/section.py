"""The visible part of a profile as a function z(y).

Cubic splines y(s), z(s) over the chord length through the given points, then a cubic spline z(y) through points every
25 um: a spline over y through the given points would miss corners that are sampled coarsely by more than 1 um.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from ...core.brief import brief
from ...core.errors import Error
from .profile import Profile

STEP = 25e-6  # m: of the points of z(y)
FINE = 10e-6  # m: of the search along the chord length
STEEPEST = 11.0  # slope beyond which a profile does not count as visible
HIDDEN = 1e-4  # m by which a point outside the visible part may lie before it
TWICE, ENDS = 1e-3, 1e-3  # m from the visible part to points of a second one, and from its ends
DEEP = 1e-3  # m by which a rail's head must be hollow, at least, to be taken for one upside down
FLANGE = 0.01  # m by which a flange stands out of the tread, at least
STEEP = 1.0  # slope of a flange, at least


@brief
@dataclass(frozen=True, eq=False)
class Section:
    """The visible part of a profile: y and z of points in growing y, (n,), m."""

    y: np.ndarray
    z: np.ndarray

    @cached_property
    def _spline(self):
        return CubicSpline(self.y, self.z)

    @cached_property
    def _derivative(self):
        return self._spline.derivative()

    @cached_property
    def _both(self):
        """Height and slope by one search for the interval."""
        rising = np.concatenate([np.zeros((1, self._derivative.c.shape[1])), self._derivative.c])
        return PPoly(np.stack([self._spline.c, rising], axis=2), self._spline.x)

    @property
    def first(self) -> float:
        """The least y, m."""
        return float(self.y[0])

    @property
    def last(self) -> float:
        """The greatest y, m."""
        return float(self.y[-1])

    def height(self, y: np.ndarray) -> np.ndarray:
        """z at y, m; beyond an end that at the end."""
        return self._spline(np.clip(y, self.first, self.last))

    def slope(self, y: np.ndarray) -> np.ndarray:
        """dz/dy at y (m); beyond an end that at the end."""
        return self._derivative(np.clip(y, self.first, self.last))

    def height_and_slope(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """z (m) and dz/dy at y, in less time than height() and slope()."""
        found = self._both(np.minimum(np.maximum(y, self.y[0]), self.y[-1]))
        return found[..., 0], found[..., 1]

    def moved(self, dy: float, dz: float) -> "Section":
        """The section moved along y and z, m."""
        return Section(self.y + dy, self.z + dz)


def path(profile: Profile) -> CubicSpline:
    """The curve (y, z), (..., 2), m, through a profile's points over the chord length, towards growing y."""
    points = np.column_stack([profile.y, profile.z])
    if profile.y[0] > profile.y[-1]:
        points = points[::-1]
    steps = np.hypot(*np.diff(points, axis=0).T)
    return CubicSpline(np.concatenate([[0.0], np.cumsum(steps)]), points)


def fine(curve: CubicSpline) -> np.ndarray:
    """Chord lengths along a curve of path() in small steps, m."""
    length = float(curve.x[-1])
    return np.linspace(0.0, length, int(np.ceil(length / FINE)) + 1)


def visible(profile: Profile) -> Section:
    """The part of a profile that the other body can see: the longest one without folds and slopes above 11. Raises
    Error if other parts of the profile lie before it: a profile that is folded, unsorted or upside down."""
    profile.need_forward()
    curve = path(profile)
    s = fine(curve)
    tangent = curve(s, 1)
    first, last = _longest(tangent[:, 0] * STEEPEST > np.abs(tangent[:, 1]))
    if last - first < 2:
        raise Error(f"{profile.name}: no part is seen from the other body: are its points sorted along the profile?")
    section = _section(curve, s[first : last + 1])
    _need_unfolded(profile, section)
    _need_single(profile, section, curve, (s[first], s[last]))
    (_need_head if profile.kind == "rail" else _need_flange_inside)(profile, section)
    return section


def _longest(good):
    """First and last index of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(int)))
    if not len(edges):
        return 0, 0
    starts, ends = edges[::2], edges[1::2] - 1
    k = int(np.argmax(ends - starts))
    return int(starts[k]), int(ends[k])


def _section(curve, s):
    """z(y) through points every 25 um of the part of a curve at these chord lengths."""
    along = curve(s)[:, 0]
    y = np.linspace(along[0], along[-1], max(int(np.round((along[-1] - along[0]) / STEP)), 4) + 1)
    t = np.interp(y, along, s)
    for _ in range(4):  # Newton's iteration for y(t) = y
        t = np.clip(t - (curve(t)[:, 0] - y) / curve(t, 1)[:, 0], s[0], s[-1])
    return Section(y, curve(t)[:, 1])


def _need_unfolded(profile, section):
    """Raises Error where points lie before the visible part: above that of a rail, below that of a wheel."""
    inside = (profile.y > section.first) & (profile.y < section.last)
    before = section.height(profile.y) - profile.z
    worst = np.max((before if profile.kind == "rail" else -before)[inside], initial=0.0)
    if worst > HIDDEN:
        where = "above" if profile.kind == "rail" else "below"
        raise Error(
            f"{profile.name}: points lie {worst:.3g} m {where} its visible part: sort the points along the profile, "
            "remove folds, and check the direction of z (down)"
        )


def _need_single(profile, section, curve, limits):
    """Raises Error where the points pass twice along the visible part, or begin and end within it."""
    points = curve(curve.x)
    y, z = points.T
    apart = (curve.x < limits[0]) | (curve.x > limits[1])
    twice = apart & (y > section.first + ENDS) & (y < section.last - ENDS) & (abs(z - section.height(y)) < TWICE)
    if twice.any():
        raise Error(
            f"{profile.name}: the points pass y = {y[np.argmax(twice)]:.6g} m twice: give each place once, sorted "
            "along the profile"
        )
    step = max(np.median(np.diff(curve.x)), ENDS)
    if np.hypot(*(points[0] - points[-1])) < 2.0 * step and (limits[0] < step or limits[1] > curve.x[-1] - step):
        raise Error(
            f"{profile.name}: the points begin and end at y = {y[0]:.6g} m, in the visible part: sort them from one "
            "side to the other"
        )


def _need_head(profile, section):
    """Raises Error for a rail whose head is hollow."""
    hollow = float(section.z.max() - max(section.z[0], section.z[-1]))
    if hollow > DEEP:
        raise Error(f"{profile.name}: the rail's head is hollow by {hollow:.3g} m: {profile.taken.other_z}")


def _need_flange_inside(profile, section):
    """Raises Error for a wheel upside down, and for one with its flange on the field side."""
    tread = float(np.median(section.z))
    low, high = (int(pick(section.z)) for pick in (np.argmax, np.argmin))
    down, up = section.z[low] - tread, tread - section.z[high]
    field = section.y[low] > 0.5 * (section.first + section.last)
    if down > FLANGE and _steep(section, low) and not field:
        return  # what is deeper than the flange on the other side is the rim's outer face
    if up > max(FLANGE, down) and _steep(section, high):
        raise Error(f"{profile.name}: the wheel's flange points up: {profile.taken.other_z}")
    if down > FLANGE and _steep(section, low):
        raise Error(
            f"{profile.name}: the wheel's flange is on the field side, at greater y: the profile is mirrored; "
            f"{profile.taken.other_y(profile.kind)}"
        )


def _steep(section, index):
    """True if a profile is as steep as a flange between its middle and a point."""
    first, last = sorted((index, len(section.y) // 2))
    slopes = section.slope(section.y[first : last + 1])
    return bool(np.abs(slopes).max() > STEEP)
