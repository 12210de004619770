"""The locus: the line of the wheel that can touch the rail, under any roll and yaw.

The wheel is q = (r sin t, y, r cos t), t from below, with the normal (sin t, -r', cos t). Seen along a rail its lowest
points have no x part of the normal in the track,
    R00 sin t - R01 r' + R02 cos t = 0,   t = asin(R01 r'/hypot(R00, R02)) - atan2(R02, R00)
Against a roller of radius rho at y, x of a point in the track fixes -n_x/n_z = c = x/sqrt(rho^2 - x^2): the row R0 +
c R2 takes the place of R0, found by a relaxed iteration.

References: G. Wang (1984); Z. Li, thesis, Delft, 2002.
"""

from dataclasses import dataclass
from typing import Union

import numpy as np
from scipy.interpolate import CubicSpline

from .placement import Roller, Track, Wheelset

STEEPEST = 0.5  # of the argument of asin: steep parts under large yaw are cut
PASSES = 12  # of the relaxed iteration on rollers: 6 reach rounding


@dataclass(frozen=True, eq=False)
class Locus:
    """The line of the wheel that can touch, in the track, of a wheelset at z = 0.

    Parameters
    ----------
    spline : CubicSpline
        (x, z) over y, m.
    """

    spline: CubicSpline

    @property
    def first(self) -> float:
        """The least y, m."""
        return float(self.spline.x[0])

    @property
    def last(self) -> float:
        """The greatest y, m."""
        return float(self.spline.x[-1])

    def at(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and z of the line at y in the track.

        Parameters
        ----------
        y : ndarray
            m.

        Returns
        -------
        x, z : ndarray
            m.
        """
        found = self.spline(y)
        return found[..., 0], found[..., 1]


def _angles(row, slope):
    """The angle t from below at which the normal has no part along a row of R."""
    along, across, up = row
    part = across * slope / np.hypot(along, up)
    return np.arcsin(np.clip(part, -STEEPEST, STEEPEST)) - np.arctan2(up, along)


def locus(rail: Union[Track, Roller], wheel: Wheelset, rotation: np.ndarray, aside: float) -> Locus:
    """The line of the wheel that can touch the rail.

    Parameters
    ----------
    rail : Track or Roller
        The rail.
    wheel : Wheelset
        The wheel.
    rotation : ndarray
        R of the wheelset, (3, 3).
    aside : float
        Lateral displacement of the wheelset, m.

    Returns
    -------
    Locus
    """
    y, height, slope = wheel.line
    radius = wheel.radius + height
    row = rotation[0][:, None] * np.ones_like(y)

    def points(angle):
        wheelset = np.stack([radius * np.sin(angle), y, radius * np.cos(angle)])
        return rotation @ wheelset + np.array([0.0, aside, -wheel.radius])[:, None]

    line = points(_angles(row, slope))
    if np.isfinite(rail.roller_radius):
        x = line[0]
        for _ in range(PASSES):
            rho = rail.roller_radius - rail.section.height(line[1])
            line = points(_angles(row + x / np.sqrt(rho * rho - x * x) * rotation[2][:, None], slope))
            x = (line[0] + radius / rho * x) / (1.0 + radius / rho)
    return Locus(_growing(line))


def _growing(line):
    """The spline (x, z) over y of the points whose y grows."""
    greatest = np.maximum.accumulate(line[1])
    keep = np.concatenate([[True], line[1][1:] > greatest[:-1]])
    return CubicSpline(line[1][keep], line[[0, 2]][:, keep].T)
