"""Two spheres under a constant normal load and a tangential force: Cattaneo and Mindlin.

The pressure is Hertz's, and normal and tangential displacements do not couple (similar materials). Conventions are
those of the package's description.

References
----------
- K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, chapter 7.
- R. D. Mindlin, Compliance of elastic bodies in contact, J. Appl. Mech. 16 (1949) 259-268.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .normal import hertz_pressure


def cattaneo_stick_radius(load_ratio: float, a: float) -> float:
    """Stick radius c = a (1 - T/(mu N))^(1/3) (Johnson eq. 7.40).

    Parameters
    ----------
    load_ratio : float
        T/(mu N), from 0 to 1.
    a : float
        Contact radius, m.

    Returns
    -------
    float
        Stick radius, m.
    """
    return a * np.cbrt(1.0 - load_ratio)


def cattaneo_shear(r: ArrayLike, a: float, c: float, mu_p0: float) -> np.ndarray:
    """Shear q_x: Hertz's shape of height mu_p0 on a minus that of height mu_p0 c/a on c.

    Parameters
    ----------
    r : array_like
        Distance from the contact's centre, m.
    a : float
        Contact radius, m.
    c : float
        Stick radius, m.
    mu_p0 : float
        Coefficient of friction times the maximum pressure, Pa.

    Returns
    -------
    ndarray
        Shear, Pa, of the shape of r.
    """
    return hertz_pressure(r, a, mu_p0) - (hertz_pressure(r, c, mu_p0 * c / a) if c > 0.0 else 0.0)


def cattaneo_displacement(a: float, c: float, mu_p0: float, compliance: float) -> float:
    """Relative tangential displacement d_x of the bodies, m, at a stick radius c (Johnson eq. 7.42); c = 0: gross
    slip."""
    return 0.5 * np.pi * compliance * mu_p0 * (a**2 - c**2) / a


def cattaneo_slip(
    r: ArrayLike, a: float, c: float, mu_p0: float, compliance: float, anisotropy: float = 0.0, angle: ArrayLike = 0.0
) -> np.ndarray:
    """Slip s_x <= 0, m, of the Cattaneo-Mindlin shear; 0 for r <= c and outside the contact.

    With the default anisotropy = 0 this is the mean over all angles, which is the solution for nu = 0. With
    anisotropy = sum of nu/(4 G) over both bodies it is u_x minus the rigid-body displacement for the given nu
    (from Johnson eqs 3.91a and 3.91b), at the angle (rad) from the force. For nu > 0 neither solves the contact
    problem without error, because there the shear q_y is not zero.
    """
    r = np.asarray(r, dtype=float)
    outside = np.maximum(r, c)
    inverse = np.divide(c, outside, out=np.zeros_like(outside), where=outside > 0.0)
    arc, root = np.arcsin(inverse), inverse * np.sqrt(1.0 - inverse**2)
    mean = 0.25 * np.pi * (2.0 * a**2 - r**2) - 0.5 * ((2.0 * c**2 - r**2) * arc + r**2 * root)
    mean -= 0.5 * np.pi * (a**2 - c**2)
    lobes = 0.25 * (0.5 * np.pi * r**2 - r**2 * arc - (2.0 * c**2 - r**2) * root)
    slip = mu_p0 / a * (compliance * mean + anisotropy * np.cos(2.0 * np.asarray(angle)) * lobes)
    return np.where((r > c) & (r <= a), slip, 0.0)
