"""Two bodies with different radii of curvature along x and y: Hertz's elliptic contact, forward and inverse.

The relative radii along x and y are those of -gap_radius_x and -gap_radius_y: 1/R = 1/R1 + 1/R2 along each direction,
infinite where both are flat along it. The longer half axis lies along the larger radius.

Reference: K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, section 4.2.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

from ..core.errors import WrongArgument

NARROW = 1e-8  # ratio of the half axes down to which a contact is searched


class Ellipse(NamedTuple):
    """Hertz's elliptic contact.

    Attributes
    ----------
    half_x, half_y : float
        Half axes along x and y, m.
    pressure : float
        Maximum pressure, Pa.
    approach : float
        Approach of the bodies, m.
    """

    half_x: float
    half_y: float
    pressure: float
    approach: float


def _shapes(k):
    """Integrals of an ellipse whose shorter half axis is k times the longer one: E* a/p0 times curvature along the
    longer and along the shorter axis, 1/R, over 2, and of the approach over the longer axis."""
    first, third = elliprf(0.0, k * k, 1.0), elliprd(0.0, k * k, 1.0) / 3.0
    return k * third, (first - third) / k, k * first


def hertz_ellipse(load_n: float, radius_x: float, radius_y: float, e_star: float) -> Ellipse:
    """The contact under a load.

    Parameters
    ----------
    load_n : float
        Normal load, N.
    radius_x, radius_y : float
        Relative radii of curvature along x and y, m, finite and above 0.
    e_star : float
        E* of both bodies, Pa: see effective_modulus().

    Returns
    -------
    Ellipse

    Raises
    ------
    Error
        If a number is not above 0, or the radii are so different that the contact is a line.
    """
    if not all(0.0 < value < np.inf for value in (load_n, radius_x, radius_y, e_star)):
        raise WrongArgument("load, radii and modulus are numbers above 0")
    small, large = sorted((radius_x, radius_y))

    def off(log_k):
        along, across, _ = _shapes(np.exp(log_k))
        return np.log(across / along) - np.log(large / small)

    if off(np.log(NARROW)) < 0.0:
        raise WrongArgument(f"radii {radius_x:g} and {radius_y:g} m: the contact is a line: see petsam.closed.plane")
    k = float(np.exp(brentq(off, np.log(NARROW), 0.0, xtol=1e-15, rtol=1e-15))) if large > small else 1.0
    along, _, deep = _shapes(k)
    # 1/(2 large) = p0 along/(E* a) with p0 = 3 N/(2 pi k a^2)
    a = np.cbrt(3.0 * load_n * large * along / (np.pi * k * e_star))
    pressure = 1.5 * load_n / (np.pi * k * a * a)
    half_x, half_y = (a, k * a) if radius_x >= radius_y else (k * a, a)
    return Ellipse(float(half_x), float(half_y), float(pressure), float(pressure / e_star * deep * a))


def hertz_radii(half_x: float, half_y: float, load_n: float, e_star: float) -> tuple[float, float]:
    """The relative radii of curvature of a contact with these half axes: the inverse of hertz_ellipse().

    Parameters
    ----------
    half_x, half_y : float
        Half axes of the contact along x and y, m.
    load_n : float
        Normal load, N.
    e_star : float
        E* of both bodies, Pa.

    Returns
    -------
    radius_x, radius_y : float
        Relative radii of curvature along x and y, m.

    Raises
    ------
    Error
        If a number is not above 0.
    """
    if not all(0.0 < value < np.inf for value in (half_x, half_y, load_n, e_star)):
        raise WrongArgument("half axes, load and modulus are numbers above 0")
    short, long = sorted((half_x, half_y))
    along, across, _ = _shapes(short / long)
    scale = 0.5 * e_star * long / (1.5 * load_n / (np.pi * short * long))
    radii = float(scale / along), float(scale / across)
    return radii if half_x >= half_y else radii[::-1]


__all__ = ["Ellipse", "hertz_ellipse", "hertz_radii"]


def __dir__():
    return __all__
