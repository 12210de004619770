"""The locus: the line of the wheel that can touch the rail, under any roll and yaw.

The wheel is q = (r sin t, y, r cos t), t from below, with the normal (sin t, -r', cos t). Seen along a rail its lowest
points have no x part of the normal in the track,
    R00 sin t - R01 r' + R02 cos t = 0,   t = asin(R01 r'/hypot(R00, R02)) - atan2(R02, R00)
Against a roller of radius rho at y, x of a point in the track fixes -n_x/n_z = c = x/sqrt(rho^2 - x^2): the row R0 +
c R2 takes the place of R0, found by a relaxed iteration.

References: G. Wang (1984); Z. Li, thesis, Delft, 2002.
"""

from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from ...core.brief import brief
from .rails import Roller, Track
from .wheelset import Wheelset

STEEPEST = 0.5  # of the argument of asin: steep parts under large yaw are cut
COARSE, BESIDE = 16, 3  # of the search for the part of the line: points from one to the next, and of these beside it
BETWEEN = 5e-5  # m: the gap between two of these points may be less by this
PASSES = 12  # of the relaxed iteration on rollers: 6 reach rounding


@brief
@dataclass(frozen=True, eq=False)
class Locus:
    """The line of the wheel that can touch, in the track, of a wheelset at z = 0: y of its points, growing, (n,), m,
    and their x and z, (2, n), m."""

    y: np.ndarray
    points: np.ndarray

    @property
    def first(self) -> float:
        """The least y, m."""
        return float(self.y[0])

    @property
    def last(self) -> float:
        """The greatest y, m."""
        return float(self.y[-1])

    def at(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and z of the line at y in the track, m, by the cubic through the four nearest points."""
        k = np.clip(np.searchsorted(self.y, y) - 2, 0, self.y.size - 4)
        divided = [self.points]  # differences of Newton's form
        for order in (1, 2, 3):
            divided.append(np.diff(divided[-1]) / (self.y[order:] - self.y[:-order]))
        found = divided[3][:, k]
        for order in (2, 1, 0):
            found = divided[order][:, k] + (y - self.y[k + order]) * found
        return found[0], found[1]


def _angles(row, slope):
    """The angle t from below at which the normal has no part along a row of R."""
    along, across, up = row
    part = across * slope / np.hypot(along, up)
    return np.arcsin(np.clip(part, -STEEPEST, STEEPEST)) - np.arctan2(up, along)


def locus(rail: Union[Track, Roller], wheel: Wheelset, rotation: np.ndarray, aside: float) -> Locus:
    """The line of the wheel that can touch the rail, for the wheelset's R (3, 3) and lateral displacement (m)."""
    return _growing(_points(rail, wheel, rotation, aside, wheel.line))


def near(
    rail: Union[Track, Roller], wheel: Wheelset, rotation: np.ndarray, aside: float, reach: float
) -> Optional[tuple[Locus, tuple[float, float]]]:
    """The part of the line on which the gap may be within a reach (m) of its least value, and the ends of the whole
    line, m; None where the whole line is needed. See also locus()."""
    whole = wheel.line
    picked = np.append(np.arange(0, whole[0].size - 1, COARSE), whole[0].size - 1)
    x, y, z = _points(rail, wheel, rotation, aside, tuple(values[picked] for values in whole))
    seen = (y > rail.section.first) & (y < rail.section.last)
    if not seen.any() or np.diff(y).min() <= 0.0:
        return None
    gap = np.where(seen, rail.surface(x, y) - z, np.inf)
    close = np.flatnonzero(gap < gap.min() + reach + BETWEEN)
    first, last = picked[max(close[0] - BESIDE, 0)], picked[min(close[-1] + BESIDE, picked.size - 1)]
    part = tuple(values[first : last + 1] for values in whole)
    return _growing(_points(rail, wheel, rotation, aside, part)), (float(y[0]), float(y[-1]))


def _points(rail, wheel, rotation, aside, line):
    """x, y, z in the track of points of a line of the wheel: y, height and slope."""
    y, height, slope = line
    radius = wheel.radius + height

    def points(angle):
        wheelset = np.stack([radius * np.sin(angle), y, radius * np.cos(angle)])
        return rotation @ wheelset + np.array([0.0, aside, -wheel.radius])[:, None]

    found = points(_angles(rotation[0], slope))
    if np.isfinite(rail.roller_radius):
        x = found[0]
        for _ in range(PASSES):
            rho = rail.roller_radius - rail.section.height(found[1])
            row = rotation[0][:, None] + x / np.sqrt(rho * rho - x * x) * rotation[2][:, None]
            found = points(_angles(row, slope))
            x = (found[0] + radius / rho * x) / (1.0 + radius / rho)
    return found


def _growing(line):
    """The line through the points whose y grows."""
    x, y, z = line
    if np.diff(y).min() <= 0.0:
        greatest = np.maximum.accumulate(y)
        keep = np.concatenate([[True], y[1:] > greatest[:-1]])
        x, y, z = x[keep], y[keep], z[keep]
    return Locus(y, np.stack([x, z]))
