"""Two spheres under normal load: Hertz's contact.

References
----------
- K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, chapters 3 and 4.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Hertz(NamedTuple):
    """Hertz's contact.

    Attributes
    ----------
    radius : float
        Contact radius, m.
    pressure : float
        Maximum pressure, Pa.
    approach : float
        Approach of the bodies, m.
    """

    radius: float
    pressure: float
    approach: float


def hertz(load_n: float, radius: float, e_star: float) -> Hertz:
    """Hertz's contact under a load (Johnson eqs 4.22 to 4.24).

    Parameters
    ----------
    load_n : float
        Normal load, N.
    radius : float
        Relative radius, m: see effective_radius().
    e_star : float
        E* of both bodies, Pa: see effective_modulus().

    Returns
    -------
    Hertz
    """
    a = np.cbrt(3.0 * load_n * radius / (4.0 * e_star))
    return Hertz(a, 3.0 * load_n / (2.0 * np.pi * a**2), a**2 / radius)


def hertz_pressure(r: ArrayLike, a: float, p0: float) -> np.ndarray:
    """Hertz's pressure p0 sqrt(1 - r^2/a^2); 0 outside the contact.

    Parameters
    ----------
    r : array_like
        Distance from the contact's centre, m.
    a : float
        Contact radius, m.
    p0 : float
        Maximum pressure, Pa.

    Returns
    -------
    ndarray
        Pressure, Pa, of the shape of r.
    """
    return p0 * np.sqrt(np.clip(1.0 - (np.asarray(r, dtype=float) / a) ** 2, 0.0, None))
