"""Contact points and rolling radii of rigid wheels over the lateral displacement, and the equivalent conicity.

Reference: EN 15302 (UIC 519), Railway applications: wheel-rail contact geometry parameters. The equivalent conicity of
an amplitude is that of the coned wheelset whose kinematic motion y'' = -radius_difference(y)/(e r0) has the same
wavelength: tan(gamma) = (pi/wavelength)^2 2 e r0.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from ...core import tables
from ...core.brief import brief
from ...core.errors import Error
from .axle import Axle
from .pose import Position

DISTANCE = 1.5  # m: e, of the contact points by the standard
POINTS = 2000  # of the integral over half a wave


@brief
@dataclass(frozen=True, eq=False)
class Geometry(tables.Tabled):
    """Contact of rigid wheels over the lateral displacement y (n,), m, growing: roll (rad) and height z (m) of the
    wheelset, (n,); y in the track of the points that touch, and rolling radii, right and left, (2, n), m; nominal
    radius, m."""

    y: np.ndarray
    roll: np.ndarray
    z: np.ndarray
    points: np.ndarray
    radii: np.ndarray
    radius: float

    @property
    def radius_difference(self) -> np.ndarray:
        """Rolling radius of the right wheel less that of the left one, (n,), m."""
        return self.radii[0] - self.radii[1]

    def table(self) -> list[tables.Column]:
        """The numbers over the lateral displacement, a row for each."""
        rows = (
            ("y", "m", "lateral displacement", self.y), ("roll", "rad", "roll", self.roll),
            ("z", "m", "height", self.z),
            ("right_y", "m", "contact point of the right wheel", self.points[0]),
            ("left_y", "m", "contact point of the left wheel", self.points[1]),
            ("right_radius", "m", "rolling radius of the right wheel", self.radii[0]),
            ("left_radius", "m", "rolling radius of the left wheel", self.radii[1]),
            ("radius_difference", "m", "right less left", self.radius_difference),
        )  # fmt: skip
        return [tables.Column(*row) for row in rows]


def geometry(axle: Axle, y: Sequence[float]) -> Geometry:
    """Contact points and rolling radii of rigid wheels without yaw.

    Parameters
    ----------
    axle : Axle
        The wheelset on its rails.
    y : sequence of float
        Lateral displacements, m.

    Returns
    -------
    Geometry

    Raises
    ------
    Error
        If a wheel is beside its rail.
    """
    places, found, roll = np.unique(np.asarray(y, dtype=float)), [], 0.0
    for one in places:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            rigid = axle.rigid(replace(Position(y=float(one)), roll=roll))
        roll = rigid.position.roll
        found.append(rigid)
    poses = [one.position for one in found]
    return Geometry(
        places, np.array([one.roll for one in poses]), np.array([one.z for one in poses]),
        np.array([one.points for one in found]).T, np.array([one.radii for one in found]).T, axle.wheel.radius,
    )  # fmt: skip


def equivalent_conicity(
    y: np.ndarray, difference: np.ndarray, amplitudes: Sequence[float], radius: float, distance: float = DISTANCE
) -> np.ndarray:
    """The equivalent conicity tan(gamma) at amplitudes of the kinematic motion, by EN 15302.

    Parameters
    ----------
    y, difference : ndarray
        Lateral displacements in growing order and the rolling radius of the right wheel less that of the left one,
        (n,), m.
    amplitudes : sequence of float
        Half the distance of the turning points, m.
    radius : float
        Nominal rolling radius, m.
    distance : float
        Of the contact points, m; 1.5 by the standard.

    Returns
    -------
    ndarray
        (amplitudes,); NaN where the motion leaves the range of y, or the wheelset does not return.

    Raises
    ------
    Error
        If y does not grow, or the radius difference is nowhere 0.
    """
    y, difference = np.asarray(y, dtype=float), np.asarray(difference, dtype=float)
    if len(y) < 3 or not (np.diff(y) > 0.0).all():
        raise Error("y: expected at least three lateral displacements in growing order")
    steps = 0.5 * (difference[1:] + difference[:-1]) * np.diff(y)
    work = np.concatenate([[0.0], np.cumsum(steps)])  # integral of the radius difference
    k = int(np.argmin(work))
    if not 0 < k < len(y) - 1:
        raise Error("the radius difference does not change its sign from - to + within y: widen the range of y")
    return np.array([_conicity(y, difference, work, float(one), radius * distance) for one in amplitudes])


def _height(y, difference, work, at):
    """The integral of the radius difference, which is linear between its points."""
    k = np.clip(np.searchsorted(y, at, side="right") - 1, 0, len(y) - 2)
    way, step = at - y[k], y[k + 1] - y[k]
    return work[k] + way * (difference[k] + 0.5 * way * (difference[k + 1] - difference[k]) / step)


def _conicity(y, difference, work, amplitude, product):
    """The equivalent conicity at an amplitude: by the period of an oscillator with the potential `work`."""

    def unequal(low):
        return _height(y, difference, work, low + 2.0 * amplitude) - _height(y, difference, work, low)

    first, last = float(y[0]), float(y[-1]) - 2.0 * amplitude
    if not 0.0 < amplitude or not last > first or unequal(first) * unequal(last) > 0.0:
        return np.nan
    low = brentq(unequal, first, last, xtol=1e-13)
    top = _height(y, difference, work, low)
    # y = middle - amplitude cos(t): the integrand has no poles at the turning points
    t = (np.arange(POINTS) + 0.5) * np.pi / POINTS
    depth = 2.0 * (top - _height(y, difference, work, low + amplitude * (1.0 - np.cos(t)))) / product
    if not (depth > 0.0).all():
        return np.nan
    wavelength = 2.0 * float(np.mean(amplitude * np.sin(t) / np.sqrt(depth))) * np.pi
    return (np.pi / wavelength) ** 2 * 2.0 * product
