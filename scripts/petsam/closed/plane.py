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

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq


class Contact(NamedTuple):
    """Middle m and half width a of the contact, m."""

    middle: float
    half_width: float

    @property
    def ends(self):
        """Left and right end, m."""
        return self.middle - self.half_width, self.middle + self.half_width


# ---------------------------------------------------------------- closed forms


def _edges(punch, contact):
    """phi1 and phi2, rad: places of the right and the left edge of the flat base."""
    m, a = contact
    return tuple(np.arccos(np.clip((edge - m) / a, -1.0, 1.0)) for edge in (punch.c, -punch.c))


def plane_load(punch, contact):
    """Load per length P', N/m."""
    total = 0.0
    for phi in (_edges(punch, contact)[0], np.pi - _edges(punch, contact)[1]):
        total += phi - 0.5 * np.sin(2.0 * phi)
    return punch.e_star * contact.half_width**2 / (4.0 * punch.edge_radius) * total


def plane_moment(punch, contact):
    """Moment per length about x = 0, M' = integral of x p, N."""
    phi1, phi2 = _edges(punch, contact)
    about_middle = (
        punch.e_star * contact.half_width**3 / (12.0 * punch.edge_radius) * (np.sin(phi1) ** 3 - np.sin(phi2) ** 3)
    )
    return about_middle + contact.middle * plane_load(punch, contact)


def plane_tilt(punch, contact):
    """Tilt r, rad: positive where the side of positive x is pressed deeper."""
    (m, a), (phi1, phi2) = contact, _edges(punch, contact)
    right = (m - punch.c) * phi1 + a * np.sin(phi1)
    left = (m + punch.c) * (np.pi - phi2) - a * np.sin(phi2)
    return (right + left) / (np.pi * punch.edge_radius)


def plane_pressure(x, punch, contact):
    """Pressure, Pa, at x (m); 0 outside the contact."""
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
    while plane_load(punch, Contact(middle, high)) < load:
        high *= 2.0
    return brentq(
        lambda a: plane_load(punch, Contact(middle, a)) - load, low or 1e-9 * high, high, xtol=1e-16, rtol=1e-14
    )


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


def contact_under_moment(punch, load, moment=0.0):
    """The contact under P' (N/m) and M' (N)."""
    return _contact(punch, load, plane_moment, moment)


def contact_at_tilt(punch, load, tilt=0.0):
    """The contact under P' (N/m) at a tilt (rad)."""
    return _contact(punch, load, plane_tilt, tilt)


def stick_zone(punch, contact, shear_load, friction):
    """The zone, as a Contact, that sticks under Q' (N/m) with 0 <= Q' < mu P'."""
    load = plane_load(punch, contact) - shear_load / friction
    return contact_at_tilt(punch, load, plane_tilt(punch, contact))


def plane_shear(x, punch, contact, stick, friction):
    """Shear q, Pa, at x (m): mu (p - p*)."""
    return friction * (plane_pressure(x, punch, contact) - plane_pressure(x, punch, stick))


# ---------------------------------------------------------------- strips


class PlaneCells:
    """The plane problem on strips with centres x (m), of equal width; dense, for up to a few thousand strips."""

    def __init__(self, punch, x):
        self.punch, self.x, self.width = punch, x, x[1] - x[0]
        reach = (np.arange(x.size + 1) - 0.5) * self.width
        primitive = reach * np.log(np.abs(reach))
        column = -2.0 / (np.pi * punch.e_star) * np.diff(primitive)
        index = np.arange(x.size)
        self.influence = column[np.abs(index[:, None] - index)]
        self.gap = punch.gap(x)

    def solve(self, load, moment=None, tilt=None):
        """Pressure (Pa) and tilt (rad) under P' (N/m) and either M' (N) or a tilt (rad)."""
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

    def partial_slip(self, load, moment, shear_load, friction):
        """Pressure, shear (Pa), tilt (rad) and the strips that stick, under P' (N/m), M' (N) and Q' (N/m)."""
        pressure, tilt = self.solve(load, moment=moment)
        less = self.solve(load - shear_load / friction, tilt=tilt)[0]
        return pressure, friction * (pressure - less), tilt, less > 0.0
