"""Stresses under a spherical contact: Hertz on the axis and on the surface, Hamilton under sliding shear.

Tension positive, z into the body; a is the contact radius, p0 the maximum pressure, poisson that of the body.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

# von Mises' largest stress relative to p0 under Hertz's pressure, and its depth relative to a, for poisson = 0.3
HERTZ_MISES, HERTZ_MISES_DEPTH = 0.6200410039, 0.48086449


def hertz_axis(z: ArrayLike, a: float, p0: float, poisson: float) -> tuple[np.ndarray, np.ndarray]:
    """Stresses on the axis under Hertz's pressure (Johnson eqs 3.45).

    Parameters
    ----------
    z : array_like
        Depth, m.
    a : float
        Contact radius, m.
    p0 : float
        Maximum pressure, Pa.
    poisson : float
        Poisson's ratio of the body.

    Returns
    -------
    s_rr, s_zz : ndarray
        Radial and axial stress, Pa, of the shape of z.
    """
    t = np.asarray(z, dtype=float) / a
    with np.errstate(divide="ignore"):
        angle = np.arctan(1.0 / t)
    bulge = 0.5 / (1.0 + t**2)
    return p0 * (-(1.0 + poisson) * (1.0 - t * angle) + bulge), -2.0 * p0 * bulge


def hertz_surface(r: ArrayLike, a: float, p0: float, poisson: float) -> tuple[np.ndarray, np.ndarray]:
    """Stresses on the surface under Hertz's pressure, inside and outside the contact (Johnson eqs 3.42, 3.43).

    Parameters
    ----------
    r : array_like
        Distance from the contact's centre, m.
    a : float
        Contact radius, m.
    p0 : float
        Maximum pressure, Pa.
    poisson : float
        Poisson's ratio of the body.

    Returns
    -------
    s_rr, s_tt : ndarray
        Radial and circumferential stress, Pa, of the shape of r.
    """
    t = np.maximum(np.asarray(r, dtype=float) / a, 1e-9)
    root = np.sqrt(np.clip(1.0 - t**2, 0.0, None))
    # (1 - root^3)/t^2 without cancellation at the centre
    part = (1.0 - 2.0 * poisson) / 3.0 * np.where(t < 1.0, (1.0 + root + root**2) / (1.0 + root), 1.0 / t**2)
    return p0 * (part - root), p0 * (-part - 2.0 * poisson * root)


def sliding_surface(
    x: np.ndarray, y: np.ndarray, a: float, q0: float, poisson: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stresses on the surface within the contact by the shear q_x = q0 sqrt(1 - r^2/a^2) alone.

    Parameters
    ----------
    x, y : ndarray
        Places with r < a, m.
    a : float
        Contact radius, m.
    q0 : float
        Maximum shear, Pa.
    poisson : float
        Poisson's ratio of the body.

    Returns
    -------
    s_xx, s_yy, s_xy : ndarray
        Stresses, Pa, of the shape of x and y. Those of the pressure are not in them.

    Notes
    -----
    G. M. Hamilton, Proc. IMechE C 197 (1983) 53.
    """
    scale = -np.pi * q0 / (8.0 * a)
    return scale * (4.0 + poisson) * x, 3.0 * scale * poisson * x, scale * (2.0 - poisson) * y


__all__ = ["hertz_axis", "hertz_surface", "sliding_surface"]


def __dir__():
    return __all__
