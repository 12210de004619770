"""Flat circular punch with a rounded edge under normal load.

The separation is h = 0 for r <= c, (r - c)^2/(2 R) beyond. The pressure is a sum of rigid flat punches of all
radii s from c to the contact radius a. Each presses a disc down by d(delta) and has the pressure
E* d(delta)/(pi sqrt(s^2 - r^2)). They give the surface the shape h when delta is Abel's transform of it,
delta(s) = s int_0^s h'(r)/sqrt(s^2 - r^2) dr:

    delta(s)  = (s/R) [sqrt(s^2 - c^2) - c arccos(c/s)]
    delta'(s) = (1/R) [2 sqrt(s^2 - c^2) - c arccos(c/s)] = (1/R) F(v),  F(v) = 2 v - c arctan(v/c), v^2 = s^2 - c^2

c = 0 gives Hertz.

References
----------
- I. N. Sneddon, The relation between load and penetration in the axisymmetric Boussinesq problem for a
  punch of arbitrary profile, Int. J. Eng. Sci. 3 (1965) 47-57.
- M. Ciavarella, D. A. Hills, G. Monno, The influence of rounded edges on indentation by a flat punch,
  Proc. Inst. Mech. Eng. C 212 (1998) 319-327.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from .quadrature import GAUSS_NODES, GAUSS_WEIGHTS


class Punch(NamedTuple):
    """A flat punch with a rounded edge.

    Attributes
    ----------
    c : float
        Radius, or half width, of the flat base, m.
    edge_radius : float
        Radius of the edge, m.
    e_star : float
        E* of both bodies, Pa.
    """

    c: float
    edge_radius: float
    e_star: float

    def gap(self, r: ArrayLike) -> np.ndarray:
        """The separation h of the undeformed surfaces: flat up to c, of radius edge_radius beyond.

        Parameters
        ----------
        r : array_like
            Distance from the punch's middle, m.

        Returns
        -------
        ndarray
            Separation, m, of the shape of r.
        """
        return np.clip(np.abs(np.asarray(r, dtype=float)) - self.c, 0.0, None) ** 2 / (2.0 * self.edge_radius)


def _slope(v, c):
    """R delta'(s) = 2 v - c arctan(v/c), m, at v = sqrt(s^2 - c^2) (m)."""
    return 2.0 * v - c * np.arctan2(v, c)


def punch_approach(punch: Punch, a: float) -> float:
    """The approach of the bodies at a contact radius.

    Parameters
    ----------
    punch : Punch
        Radius of the flat base, radius of the edge, E*.
    a : float
        Contact radius, m, at least that of the flat base.

    Returns
    -------
    float
        Approach, m.
    """
    return a / punch.edge_radius * (np.sqrt(a**2 - punch.c**2) - punch.c * np.arccos(punch.c / a))


def punch_load(punch: Punch, a: float) -> float:
    """The normal load at a contact radius: 2 E* times the integral of s delta'(s) over [c, a].

    Parameters
    ----------
    punch : Punch
        Radius of the flat base, radius of the edge, E*.
    a : float
        Contact radius, m, at least that of the flat base.

    Returns
    -------
    float
        Normal load, N.
    """
    c, edge_radius, e_star = punch
    b = np.sqrt(a**2 - c**2)
    return 2.0 * e_star / edge_radius * (2.0 / 3.0 * b**3 - 0.5 * c * a**2 * np.arccos(c / a) + 0.5 * c**2 * b)


def punch_radius(punch: Punch, load_n: float) -> float:
    """The contact radius under a load: the inverse of punch_load().

    Parameters
    ----------
    punch : Punch
        Radius of the flat base, radius of the edge, E*.
    load_n : float
        Normal load, N.

    Returns
    -------
    float
        Contact radius a, m.
    """
    low, high = punch.c, punch.c + np.cbrt(3.0 * load_n * punch.edge_radius / (4.0 * punch.e_star))
    while punch_load(punch, high) < load_n:
        low, high = high, 2.0 * high
    return brentq(lambda a: punch_load(punch, a) - load_n, low, high, xtol=1e-15, rtol=1e-14)


def punch_pressure(r: ArrayLike, punch: Punch, a: float) -> np.ndarray:
    """The pressure: E*/pi times the integral of delta'(s)/sqrt(s^2 - r^2) over [max(r, c), a]; 0 outside the contact.

    Parameters
    ----------
    r : array_like
        Distance from the contact's centre, m.
    punch : Punch
        Radius of the flat base, radius of the edge, E*.
    a : float
        Contact radius, m, at least that of the flat base.

    Returns
    -------
    ndarray
        Pressure, Pa, of the shape of r.

    Notes
    -----
    With v = e sinh(t) for r < c and v = e cosh(t) for r > c, e^2 = |c^2 - r^2|, the integral is that of the smooth
    function F(v) v/s over t, for which Gauss's rule is accurate to rounding.
    """
    c, edge_radius, e_star = punch
    r = np.asarray(r, dtype=float)[..., None]
    b, flat = np.sqrt(a**2 - c**2), r < c
    e = np.sqrt(np.maximum(np.abs(c**2 - r**2), (1e-9 * a) ** 2))
    ratio = np.where(r < a, b / e, 1.0)
    end = np.where(flat, np.arcsinh(ratio), np.arccosh(np.maximum(ratio, 1.0)))
    t = 0.5 * end * (1.0 + GAUSS_NODES)
    v = e * np.where(flat, np.sinh(t), np.cosh(t))
    integral = np.sum(0.5 * end * GAUSS_WEIGHTS * _slope(v, c) * v / np.sqrt(v**2 + c**2), axis=-1)
    return e_star / (np.pi * edge_radius) * np.where(r[..., 0] < a, integral, 0.0)


def punch_torsion_limit(punch: Punch, a: float, friction: float) -> float:
    """The torque at which the whole contact slips: mu E* pi/2 times the integral of s^2 delta'(s) over [c, a].

    Parameters
    ----------
    punch : Punch
        Radius of the flat base, radius of the edge, E*.
    a : float
        Contact radius, m, at least that of the flat base.
    friction : float
        Coefficient of friction mu.

    Returns
    -------
    float
        Torque limit, N m.

    Notes
    -----
    The flat punch of radius s under N carries mu N pi s/4.
    """
    c, edge_radius, e_star = punch
    b = np.sqrt(a**2 - c**2)
    v = 0.5 * b * (1.0 + GAUSS_NODES)
    integral = 0.5 * b * np.sum(GAUSS_WEIGHTS * np.sqrt(v**2 + c**2) * v * _slope(v, c))
    return 0.5 * np.pi * friction * e_star / edge_radius * integral


__all__ = ["Punch", "punch_approach", "punch_load", "punch_pressure", "punch_radius", "punch_torsion_limit"]


def __dir__():
    return __all__
