"""Temperatures of two half-spaces by the frictional heat of a cycle that is repeated for ever, in one linear system.

Q(t, x) is the heat of the contact, q2 the part that flows into body 2, r the resistance of the contact on the way to
body 2. In cells in contact, at all times of the cycle together,

    (K1 + K2 + r) q2 = T1_bulk - T2_bulk + K1 Q,   q2 = 0 elsewhere,

with the operators of kernels.py. Generalised conjugate residuals; the preconditioner is the inverse of the symbol of
each harmonic and wave, cut off outside of contact. The mean over the cycle is that after any number of cycles: heat
that has not yet come so far in a short test is not left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...core import materials
from ...core.brief import brief
from ...core.errors import Error
from ...core.tables import Column, Tabled
from .kernels import Conductor, applied

RTOL, MOST = 1e-8, 100  # relative residual at which the system is solved; operator applications at most


@dataclass(frozen=True)
class Body:
    """The data of a body that determine its temperature.

    Attributes
    ----------
    conductivity : float
        W/(m K).
    capacity : float
        Density times specific heat, J/(m3 K).
    bulk : float
        Temperature far below the surface, K or degrees C.
    """

    conductivity: float
    capacity: float
    bulk: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("conductivity", "W/(m K)"), ("capacity", "J/(m3 K)")):
            value = getattr(self, name)
            if not (value > 0 and np.isfinite(value)):
                raise Error(f"heat: {name} {value:g} {unit}: expected a number above 0")
        if not np.isfinite(self.bulk):
            raise Error(f"heat: temperature {self.bulk:g} of a body: expected a finite number")

    @classmethod
    def named(cls, name: str, bulk: float = 0.0) -> Body:
        """A body of a material of petsam.materials.

        Parameters
        ----------
        name : str
            Its name, such as "steel" or "Ti-6Al-4V".
        bulk : float
            Temperature far below the surface.

        Returns
        -------
        Body

        Raises
        ------
        Error
            If there is no such material, or its table has no conductivity, density or specific heat.
        """
        found = materials.find(name)
        if found.conductivity is None or found.density is None or found.specific_heat is None:
            raise Error(f"heat: {name}: its source states no thermal constants: give Body(conductivity, capacity)")
        return cls(found.conductivity, found.density * found.specific_heat, bulk)


@brief
@dataclass(frozen=True)
class Temperatures(Tabled):
    """The temperatures of a contact over a cycle of heat.

    Attributes
    ----------
    times : ndarray
        Centres of the equal intervals, from the beginning of the cycle, (intervals,), s.
    touches : ndarray of bool
        Cells in contact, (intervals, ny, nx).
    heat, heat_2 : ndarray
        Frictional heat, and the part into body 2, (intervals, ny, nx), W/m2.
    surface : ndarray
        Temperatures of the surfaces of bodies 1 and 2, (2, intervals, ny, nx), in the unit of the bodies' bulk.
    cell : pair of floats
        Sides of a cell along x and y, m.
    """

    times: np.ndarray
    touches: np.ndarray
    heat: np.ndarray
    heat_2: np.ndarray
    surface: np.ndarray
    cell: tuple[float, float]

    @property
    def mean(self) -> np.ndarray:
        """Means over the cycle of the temperatures of both surfaces, (2, ny, nx)."""
        return self.surface.mean(axis=1)

    @property
    def flash(self) -> np.ndarray:
        """Temperatures above those means, (2, intervals, ny, nx), K."""
        return self.surface - self.mean[:, None]

    @property
    def maximum(self) -> float:
        """Maximum temperature in contact over the cycle."""
        return float(np.max(self.surface[:, self.touches]))

    @property
    def mean_maximum(self) -> float:
        """Maximum of the means over the cycle, in cells that are in contact at some time."""
        return float(np.max(self.mean[:, self.touches.any(axis=0)]))

    @property
    def flash_maximum(self) -> float:
        """Maximum temperature in contact above the mean of its place, K."""
        return float(np.max(self.flash[:, self.touches]))

    @property
    def power(self) -> float:
        """Mean frictional power, W."""
        return float(self._sum(self.heat).mean())

    @property
    def share_2(self) -> float:
        """Part of the frictional heat of the cycle that flows into body 2."""
        return float(self.heat_2.sum() / self.heat.sum())

    def _sum(self, field):
        return field.sum(axis=(1, 2)) * self.cell[0] * self.cell[1]

    def table(self) -> list[Column]:
        """The columns: time, power, heat into body 2, temperatures in contact.

        Returns
        -------
        list of Column
            With a value for each interval: s, W, K.
        """
        inside = [self.surface[:, k][:, touches] for k, touches in enumerate(self.touches)]
        return [
            Column("time", "s", "from the beginning of the cycle", self.times),
            Column("heat_power", "W", "frictional power", self._sum(self.heat)),
            Column("heat_power_2", "W", "power into body 2", self._sum(self.heat_2)),
            Column("temperature_max", "K", "maximum temperature in contact", [_of(np.max, one) for one in inside]),
            Column("temperature_mean", "K", "mean temperature in contact", [_of(np.mean, one) for one in inside]),
        ]


def _of(number, values):
    """A number of values; NaN if there are none."""
    return float(number(values)) if values.size else float("nan")


def divided(
    heat: ArrayLike,
    touches: ArrayLike,
    cell: tuple[float, float],
    period: float,
    bodies: tuple[Body, Body],
    resistance: float = 0.0,
    rtol: float = RTOL,
) -> Temperatures:
    """The temperatures by a cycle of frictional heat, which is repeated for ever.

    Parameters
    ----------
    heat : array_like
        Mean heat over each of the equal intervals of the cycle, (intervals, ny, nx), W/m2; 0 outside of contact.
    touches : array_like of bool
        Cells in contact in each interval, (intervals, ny, nx).
    cell : pair of floats
        Sides of a cell along x and y, m.
    period : float
        Period of the cycle, s.
    bodies : pair of Body
        The bodies: half-spaces.
    resistance : float
        Resistance of the contact to heat on its way to body 2, K m2/W; heat arises on body 1.
    rtol : float
        Relative residual at which the solution is accepted.

    Returns
    -------
    Temperatures

    Raises
    ------
    Error
        If shapes differ, there is no contact or heat outside of it, a number is out of its range, or there is no
        convergence.

    Notes
    -----
    Bodies stand: the slip is small against the contact. Of second order in the cells; intervals of 1/32 of the cycle
    leave about 0.4 % in the maximum of a heat like abs(sin), 1/64 leave 0.1 %; the mean has no such error.

    Examples
    --------
    Steel takes more of the heat than a body of a quarter of its conductivity and capacity.

    >>> import numpy as np, petsam
    >>> touches = np.zeros((8, 6, 6), dtype=bool)
    >>> touches[:, 2:4, 2:4] = True
    >>> steel, other = petsam.heat.Body(50.0, 3.6e6), petsam.heat.Body(12.5, 0.9e6)
    >>> found = petsam.heat.divided(1e6 * touches, touches, (1e-4, 1e-4), 0.01, (steel, other))
    >>> round(float(found.share_2), 6), round(float(found.power), 6)  # of the conductivities; W
    (0.2, 0.04)
    """
    heat, touches = np.asarray(heat, dtype=float), np.asarray(touches, dtype=bool)
    _check(heat, touches, period, resistance)
    one, other = (Conductor(heat.shape, cell, period, body.conductivity, body.capacity) for body in bodies)
    if bodies[0] == bodies[1] and resistance == 0:
        heat_2 = 0.5 * heat
    else:
        right = np.where(touches, bodies[0].bulk - bodies[1].bulk + one(heat), 0.0)
        heat_2 = _solved(one, other, touches, resistance, right, rtol)
    surface = np.array([bodies[0].bulk + one(heat - heat_2), bodies[1].bulk + other(heat_2)])
    times = (np.arange(heat.shape[0]) + 0.5) * period / heat.shape[0]
    return Temperatures(times, touches, heat, heat_2, surface, cell)


def _check(heat, touches, period, resistance):
    if heat.ndim != 3 or heat.shape != touches.shape:
        raise Error(f"heat: heat of the shape {heat.shape}, contact {touches.shape}: expected (intervals, ny, nx)")
    if heat.shape[1] == 1:
        raise Error("heat: in plane strain bodies that stand have no mean temperature: use a grid of several rows")
    if heat.shape[0] < 4:
        raise Error(f"heat: {heat.shape[0]} intervals of a cycle: expected at least 4")
    if not touches.any():
        raise Error("heat: there is no contact in the cycle")
    if not np.all(np.isfinite(heat)) or np.any(heat[~touches] != 0):
        raise Error("heat: heat must be finite, and 0 outside of contact")
    if not (period > 0 and np.isfinite(period)):
        raise Error(f"heat: period {period:g} s: expected a number above 0")
    if not (resistance >= 0 and np.isfinite(resistance)):
        raise Error(f"heat: resistance {resistance:g} K m2/W: expected a number >= 0")


def _solved(
    one: Conductor, other: Conductor, touches: np.ndarray, resistance: float, right: np.ndarray, rtol: float
) -> np.ndarray:
    """The heat into body 2 by generalised conjugate residuals."""
    padded = one.padded

    def product(q):
        both = applied(q, padded, lambda k: one.response(k) + other.response(k))
        return np.where(touches, both + resistance * q, 0.0)

    def precondition(r):
        inverse = applied(r, padded, lambda k: 1 / (one.symbol(k) + other.symbol(k) + resistance))
        return np.where(touches, inverse, 0.0)

    q, residual = np.zeros(right.shape), right.copy()
    enough = rtol * np.linalg.norm(right)
    directions: list[tuple[np.ndarray, np.ndarray]] = []
    while np.linalg.norm(residual) > enough:
        if len(directions) == MOST:
            raise Error(f"heat: no convergence within {MOST} operator applications")
        z = precondition(residual)
        image = product(z)
        for direction, its_image in directions:
            part = np.vdot(its_image, image)
            z -= part * direction
            image -= part * its_image
        size = np.linalg.norm(image)
        if not (size > 0 and np.isfinite(size)):
            raise Error("heat: the system has no solution in double precision: check the constants of the bodies")
        directions.append((z / size, image / size))
        step = np.vdot(directions[-1][1], residual)
        q += step * directions[-1][0]
        residual -= step * directions[-1][1]
    return q
