"""Plane solutions for a punch with a flat base and rounded edges, infinitely long in y, on an elastic half-space:
upright or inclined, under normal load and in partial slip.

Conventions are those of the package's description; loads are per length: load P' (N/m), moment M' = integral of x p
(N), shear Q' (N/m). E* is the plane modulus, the same for p and for q where the bodies are similar. The separation is
h = 0 for |x| <= c, (|x| - c)^2/(2 R) beyond.

In the contact [m - a, m + a] the displacement u satisfies u + h = d + x r, d the approach and r the tilt, so
(2/(pi E*)) pv int p(s)/(x - s) ds = h'(x) - r. With s = m + a cos(phi), x = m + a cos(theta), the solution that is
bounded at both ends is, after integration by parts,

    p = (E* a/(2 pi)) int_0^pi h''(s) sin(phi) L(phi, theta) dphi,    L = ln |sin((phi + theta)/2)/sin((phi - theta)/2)|

and r = (1/pi) int h'(s) dphi makes it bounded. h'' = 1/R for phi < phi1 = arccos((c - m)/a) and for
phi > phi2 = arccos((-c - m)/a) and 0 between, and L = sum (2/n) sin(n phi) sin(n theta), so everything below is closed;
upright it is Ciavarella, Hills and Monno's solution, inclined Goryacheva, Murthy and Farris'. An end of the contact
may lie on the flat base: then phi2 = pi (or phi1 = 0).

Partial slip (Jaeger, Ciavarella): q = mu (p - p*), p* the pressure of the same punch at the same tilt under the load
P' - Q'/mu; it sticks where p* > 0. Normal load and moment come first and stay constant.

`PlaneCells` is the same problem with strips of constant traction, like a numerical section: its difference from the
mid-section of a long contact on the same cells is caused by the ends alone.

References
----------
- M. Ciavarella, D. A. Hills, G. Monno, The influence of rounded edges on indentation by a flat punch,
  Proc. Inst. Mech. Eng. C 212 (1998) 319-327.
- I. G. Goryacheva, H. Murthy, T. N. Farris, Contact problem with partial slip for the inclined punch with rounded
  edges, Int. J. Fatigue 24 (2002).
- M. Ciavarella, The generalized Cattaneo partial slip plane contact problem, Int. J. Solids Structures 35 (1998)
  2349-2378.
"""

from __future__ import annotations

from typing import NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from .punch import Punch


class Contact(NamedTuple):
    """A contact, or a zone of it.

    Attributes
    ----------
    middle : float
        Middle m, m.
    half_width : float
        Half width a, m.
    """

    middle: float
    half_width: float

    @property
    def ends(self) -> tuple[float, float]:
        """Left and right end, m."""
        return self.middle - self.half_width, self.middle + self.half_width


# ---------------------------------------------------------------- closed forms


def _edges(punch, contact):
    """phi1 and phi2, rad: places of the right and the left edge of the flat base."""
    m, a = contact
    return tuple(np.arccos(np.clip((edge - m) / a, -1.0, 1.0)) for edge in (punch.c, -punch.c))


def _load(punch, contact):
    """The load per length under which the contact is this one."""
    total = 0.0
    for phi in (_edges(punch, contact)[0], np.pi - _edges(punch, contact)[1]):
        total += phi - 0.5 * np.sin(2.0 * phi)
    return punch.e_star * contact.half_width**2 / (4.0 * punch.edge_radius) * total


def _moment(punch, contact):
    """The moment per length about x = 0, M' = integral of x p, under which the contact is this one."""
    phi1, phi2 = _edges(punch, contact)
    about_middle = (
        punch.e_star * contact.half_width**3 / (12.0 * punch.edge_radius) * (np.sin(phi1) ** 3 - np.sin(phi2) ** 3)
    )
    return about_middle + contact.middle * _load(punch, contact)


def plane_tilt(punch: Punch, contact: Contact) -> float:
    """The tilt of a punch with this contact.

    Parameters
    ----------
    punch : Punch
        Half width of the flat base, radius of the edges, E*.
    contact : Contact
        The contact.

    Returns
    -------
    float
        Tilt r, rad: positive where the side of positive x is pressed deeper.
    """
    (m, a), (phi1, phi2) = contact, _edges(punch, contact)
    right = (m - punch.c) * phi1 + a * np.sin(phi1)
    left = (m + punch.c) * (np.pi - phi2) - a * np.sin(phi2)
    return (right + left) / (np.pi * punch.edge_radius)


def plane_pressure(x: ArrayLike, punch: Punch, contact: Contact) -> np.ndarray:
    """The pressure of a contact; 0 outside of it.

    Parameters
    ----------
    x : array_like
        Places, m.
    punch : Punch
        Half width of the flat base, radius of the edges, E*.
    contact : Contact
        The contact.

    Returns
    -------
    ndarray
        Pressure, Pa, of the shape of x.
    """
    (m, a), (phi1, phi2) = contact, _edges(punch, contact)
    xi = np.clip((np.asarray(x, dtype=float) - m) / a, -1.0, 1.0)
    theta = np.arccos(xi)

    def log_term(phi):
        """(cos(phi) - cos(theta)) L(phi, theta), 0 at phi = theta."""
        near, far = np.abs(np.sin(0.5 * (phi - theta))), np.abs(np.sin(0.5 * (phi + theta)))
        tiny = np.finfo(float).tiny
        return (np.cos(phi) - xi) * np.log(np.maximum(far, tiny) / np.maximum(near, tiny))

    shape = (np.pi - phi2 + phi1) * np.sin(theta) - log_term(phi1) + log_term(phi2)
    inside = np.abs(np.asarray(x, dtype=float) - m) < a
    return np.where(inside, punch.e_star * a / (2.0 * np.pi * punch.edge_radius) * shape, 0.0)


# ---------------------------------------------------------------- contact for given loads


def _half_width(punch, load, middle):
    """Half width a, m, of the contact with this middle (m) under load (N/m)."""
    low = max(punch.c - abs(middle), 0.0)
    high = low + np.sqrt(load * punch.edge_radius / punch.e_star)
    while _load(punch, Contact(middle, high)) < load:
        high *= 2.0
    return brentq(lambda a: _load(punch, Contact(middle, a)) - load, low or 1e-9 * high, high, xtol=1e-16, rtol=1e-14)


def _contact(punch, load, quantity, value):
    """The contact under load (N/m) for which quantity(punch, contact), odd and increasing in the middle, is value."""
    sign, value = np.sign(value), abs(value)
    if value == 0.0:
        return Contact(0.0, _half_width(punch, load, 0.0))

    def error(middle):
        return quantity(punch, Contact(middle, _half_width(punch, load, middle))) - value

    high = 0.1 * punch.c + 1e-3 * punch.edge_radius
    while error(high) < 0.0:
        high *= 1.5
    middle = brentq(error, 0.0, high, xtol=1e-16, rtol=1e-14)
    return Contact(float(sign * middle), _half_width(punch, load, middle))


def contact_under_moment(punch: Punch, load: float, moment: float = 0.0) -> Contact:
    """The contact under a load and a moment.

    Parameters
    ----------
    punch : Punch
        Half width of the flat base, radius of the edges, E*.
    load : float
        Load P', N/m, above 0.
    moment : float
        Moment M', N, about x = 0.

    Returns
    -------
    Contact
    """
    return _contact(punch, load, _moment, moment)


def _contact_at_tilt(punch, load, tilt):
    """The contact under a load at a tilt."""
    return _contact(punch, load, plane_tilt, tilt)


def stick_zone(punch: Punch, contact: Contact, shear_load: float, friction: float) -> Contact:
    """The zone that sticks.

    Parameters
    ----------
    punch : Punch
        Half width of the flat base, radius of the edges, E*.
    contact : Contact
        The contact.
    shear_load : float
        Shear Q', N/m, with 0 <= Q' < mu P'.
    friction : float
        Coefficient of friction mu.

    Returns
    -------
    Contact
    """
    load = _load(punch, contact) - shear_load / friction
    return _contact_at_tilt(punch, load, plane_tilt(punch, contact))


def plane_shear(x: ArrayLike, punch: Punch, contact: Contact, stick: Contact, friction: float) -> np.ndarray:
    """The shear q = mu (p - p*).

    Parameters
    ----------
    x : array_like
        Places, m.
    punch : Punch
        Half width of the flat base, radius of the edges, E*.
    contact : Contact
        The contact.
    stick : Contact
        The zone that sticks: see stick_zone().
    friction : float
        Coefficient of friction mu.

    Returns
    -------
    ndarray
        Shear, Pa, of the shape of x.
    """
    return friction * (plane_pressure(x, punch, contact) - plane_pressure(x, punch, stick))


# ---------------------------------------------------------------- strips


class PlaneCells:
    """The plane problem on strips of equal width and constant traction; dense, for up to a few thousand strips.

    Parameters
    ----------
    punch : Punch
        Half width of the flat base, radius of the edges, E*.
    x : ndarray
        Centres of the strips, (n,), m, of equal distances.

    Attributes
    ----------
    width : float
        Width of a strip, m.
    gap : ndarray
        Separation of the undeformed bodies, (n,), m.
    influence : ndarray
        Displacement by the pressure of a strip, (n, n), m/Pa.
    """

    def __init__(self, punch: Punch, x: np.ndarray) -> None:
        self.punch, self.x, self.width = punch, x, x[1] - x[0]
        reach = (np.arange(x.size + 1) - 0.5) * self.width
        primitive = reach * np.log(np.abs(reach))
        column = -2.0 / (np.pi * punch.e_star) * np.diff(primitive)
        index = np.arange(x.size)
        self.influence = column[np.abs(index[:, None] - index)]
        self.gap = punch.gap(x)

    def solve(
        self, load: float, moment: Optional[float] = None, tilt: Optional[float] = None
    ) -> tuple[np.ndarray, float]:
        """The contact under a load and either a moment or a tilt.

        Parameters
        ----------
        load : float
            Load P', N/m.
        moment : float, optional
            Moment M', N, where there is no tilt.
        tilt : float, optional
            Tilt r, rad.

        Returns
        -------
        pressure : ndarray
            Pressure of the strips, (n,), Pa.
        tilt : float
            Tilt r, rad.

        Raises
        ------
        RuntimeError
            If the contact does not settle in 100 iterations.
        """
        rigid = np.stack([np.ones_like(self.x), self.x], axis=1)
        active = self.gap <= self.gap.max() * 0.5
        for _ in range(100):
            n, free = np.count_nonzero(active), 2 if tilt is None else 1
            matrix = np.zeros((n + free, n + free))
            matrix[:n, :n] = self.influence[np.ix_(active, active)]
            matrix[:n, n:] = -rigid[active, :free]
            matrix[n:, :n] = self.width * rigid[active, :free].T
            given = (tilt or 0.0) * self.x - self.gap
            right = np.concatenate([given[active], [load, moment][:free]])
            # as moduli may be 1e11 Pa: solve for p/E*
            matrix[:n, :n] *= self.punch.e_star
            matrix[n:, :n] *= self.punch.e_star
            solution = np.linalg.solve(matrix, right)
            pressure = np.zeros_like(self.x)
            pressure[active] = solution[:n] * self.punch.e_star
            rise = self.influence @ pressure - given - rigid[:, :free] @ solution[n:]
            update = (active & (pressure > 0.0)) | (~active & (rise < 0.0))
            if np.array_equal(update, active):
                return pressure, solution[n + 1] if tilt is None else tilt
            active = update
        raise RuntimeError("PlaneCells: the contact does not settle")

    def partial_slip(
        self, load: float, moment: float, shear_load: float, friction: float
    ) -> tuple[np.ndarray, np.ndarray, float, np.ndarray]:
        """Partial slip by a shear load after the normal load and the moment.

        Parameters
        ----------
        load : float
            Load P', N/m.
        moment : float
            Moment M', N.
        shear_load : float
            Shear Q', N/m, with 0 <= Q' < mu P'.
        friction : float
            Coefficient of friction mu.

        Returns
        -------
        pressure, shear : ndarray
            Tractions of the strips, (n,), Pa.
        tilt : float
            Tilt r, rad.
        sticks : ndarray of bool
            The strips that stick, (n,).

        Raises
        ------
        RuntimeError
            If the contact does not settle in 100 iterations.
        """
        pressure, tilt = self.solve(load, moment=moment)
        less = self.solve(load - shear_load / friction, tilt=tilt)[0]
        return pressure, friction * (pressure - less), tilt, less > 0.0


__all__ = ["Contact", "PlaneCells", "contact_under_moment", "plane_pressure", "plane_shear", "plane_tilt", "stick_zone"]


def __dir__():
    return __all__
