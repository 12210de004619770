"""Stresses under a spherical contact: Hertz on the axis and on the surface, Hamilton under sliding shear.

Tension positive, z into the body; a is the contact radius, p0 the maximum pressure, poisson that of the body.
"""

import numpy as np

# von Mises' largest stress relative to p0 under Hertz's pressure, and its depth relative to a, for poisson = 0.3
HERTZ_MISES, HERTZ_MISES_DEPTH = 0.6200410039, 0.48086449


def hertz_axis(z, a, p0, poisson):
    """(s_rr, s_zz) on the axis at depth z (Johnson eqs 3.45)."""
    t = np.asarray(z, dtype=float) / a
    with np.errstate(divide="ignore"):
        angle = np.arctan(1.0 / t)
    bulge = 0.5 / (1.0 + t**2)
    return p0 * (-(1.0 + poisson) * (1.0 - t * angle) + bulge), -2.0 * p0 * bulge


def hertz_surface(r, a, p0, poisson):
    """(s_rr, s_tt) on the surface, inside and outside the contact (Johnson eqs 3.42, 3.43)."""
    t = np.maximum(np.asarray(r, dtype=float) / a, 1e-9)
    root = np.sqrt(np.clip(1.0 - t**2, 0.0, None))
    # (1 - root^3)/t^2 without cancellation at the centre
    part = (1.0 - 2.0 * poisson) / 3.0 * np.where(t < 1.0, (1.0 + root + root**2) / (1.0 + root), 1.0 / t**2)
    return p0 * (part - root), p0 * (-part - 2.0 * poisson * root)


def sliding_surface(x, y, a, q0, poisson):
    """(s_xx, s_yy, s_xy) on the surface inside r < a by the shear q_x = q0 sqrt(1 - r^2/a^2) on it.

    Hamilton 1983, Proc. IMechE C 197, 53. The contact's pressure is not in it.
    """
    scale = -np.pi * q0 / (8.0 * a)
    return scale * (4.0 + poisson) * x, 3.0 * scale * poisson * x, scale * (2.0 - poisson) * y
