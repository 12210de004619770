"""Two spheres under a constant normal load and a torque: Lubkin.

The pressure is Hertz's, and normal and tangential displacements do not couple (similar materials). Conventions are
those of the package's description.

References
----------
- J. L. Lubkin, The torsion of elastic spheres in contact, J. Appl. Mech. 18 (1951) 183-187.
- M. Hetenyi and P. H. McDonald, Contact stresses under combined pressure and twist, J. Appl. Mech. 25
  (1958) 396-401.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1

from ..core.errors import WrongArgument
from .normal import hertz_pressure
from .quadrature import GAUSS_NODES, GAUSS_WEIGHTS

# A twist beta of a disc of radius s that sticks all over gives q = (4 G beta/pi) r/sqrt(s^2 - r^2)
# (Reissner and Sagoci). Discs of all radii from c to a, with twists f(s) ds, turn r < c as a whole; the
# shear is mu p on c < r < a when f(s) = (mu p0/(2 G)) E(k)/s, k^2 = 1 - s^2/a^2. Everything below follows.


def torsion_limit(load_n: float, friction: float, a: float) -> float:
    """Torque limit 3 pi/16 mu N a, N m, at which the whole contact slips."""
    return 3.0 * np.pi / 16.0 * friction * load_n * a


def lubkin_torque_ratio(stick_ratio: ArrayLike) -> np.ndarray:
    """The torque over its limit at a ratio c/a: 64/(3 pi^2) times the integral of t^2 E(k) over [c/a, 1], k^2 = 1 -
    t^2."""
    x = np.asarray(stick_ratio, dtype=float)[..., None]
    t = 0.5 * (1.0 + x + (1.0 - x) * GAUSS_NODES)
    integral = 0.5 * (1.0 - x[..., 0]) * np.sum(GAUSS_WEIGHTS * t**2 * ellipe(1.0 - t**2), axis=-1)
    return 64.0 / (3.0 * np.pi**2) * integral


def lubkin_stick_radius(torque_ratio: float, a: float) -> float:
    """The stick radius, m, under a torque over its limit, 0 to 1: the inverse of lubkin_torque_ratio()."""
    if not 0.0 <= torque_ratio <= 1.0:
        raise WrongArgument(f"torque_ratio must be in [0, 1], got {torque_ratio!r}")
    if torque_ratio in (0.0, 1.0):
        return a * (1.0 - torque_ratio)
    return a * brentq(lambda x: float(lubkin_torque_ratio(x)) - torque_ratio, 0.0, 1.0, xtol=1e-14)


def lubkin_shear(r: ArrayLike, a: float, c: float, mu_p0: float) -> np.ndarray:
    """Shear q_theta, Pa: mu p outside the stick radius, less within it.

    For r < c it is q = mu p {1 + (2/pi) [(K - E) F(phi, k') - K E(phi, k')]} with k' = c/a, K and E of modulus
    sqrt(1 - k'^2), and sin(phi) = sqrt((c^2 - r^2)/(a^2 - r^2))/k'.
    """
    full = hertz_pressure(r, a, mu_p0)
    if c <= 0.0:
        return full
    if c >= a:
        return np.zeros_like(full)
    inside = np.minimum(np.asarray(r, dtype=float), c)
    phi = np.arcsin(np.clip(np.sqrt((c**2 - inside**2) / (a**2 - inside**2)) * a / c, 0.0, 1.0))
    m = (c / a) ** 2
    big_k, big_e = ellipkm1(m), ellipe(1.0 - m)
    stick = (big_k - big_e) * ellipkinc(phi, m) - big_k * ellipeinc(phi, m)
    return full * (1.0 + 2.0 / np.pi * stick)


def lubkin_twist(a: float, c: float, mu_p0: float, compliance: float) -> float:
    """Relative rotation r_z of the bodies, rad: (mu p0/2) (1/G1 + 1/G2) [K(k) - E(k)], k^2 = 1 - c^2/a^2.

    Infinite at c = 0, as the limit torque is approached and not reached.
    """
    m = (c / a) ** 2
    return 0.5 * mu_p0 * compliance * (ellipkm1(m) - ellipe(1.0 - m))
