"""Two spheres in contact: Hertz under normal load, Cattaneo and Mindlin under tangential force, Lubkin under torque.

The tangential and torsional solutions suppose that the normal load comes first and stays constant, that
the pressure is Hertz's, and that normal and tangential displacements do not couple (similar materials).
Conventions are those of the package's description.

References
----------
- K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, chapters 3, 4 and 7.
- R. D. Mindlin, Compliance of elastic bodies in contact, J. Appl. Mech. 16 (1949) 259-268.
- J. L. Lubkin, The torsion of elastic spheres in contact, J. Appl. Mech. 18 (1951) 183-187.
- M. Hetenyi and P. H. McDonald, Contact stresses under combined pressure and twist, J. Appl. Mech. 25
  (1958) 396-401.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1

from .materials import Bodies, effective_radius
from .quadrature import GAUSS_NODES, GAUSS_WEIGHTS


class Hertz(NamedTuple):
    """Hertz's contact: contact radius (m), maximum pressure (Pa), approach of the bodies (m)."""

    radius: float
    pressure: float
    approach: float


def hertz(load_n, radius, e_star):
    """Hertz's contact under load_n (N), effective radius (m), E* (Pa); Johnson eqs 4.22 to 4.24."""
    a = np.cbrt(3.0 * load_n * radius / (4.0 * e_star))
    return Hertz(a, 3.0 * load_n / (2.0 * np.pi * a**2), a**2 / radius)


def hertz_pressure(r, a, p0):
    """Pressure p0 sqrt(1 - r^2/a^2), Pa, at r (m); 0 outside the contact radius a (m)."""
    return p0 * np.sqrt(np.clip(1.0 - (np.asarray(r, dtype=float) / a) ** 2, 0.0, None))


# ---------------------------------------------------------------- Cattaneo and Mindlin


def cattaneo_stick_radius(load_ratio, a):
    """Stick radius c = a (1 - T/(mu N))^(1/3), m; load_ratio = T/(mu N) in [0, 1] (Johnson eq. 7.40)."""
    return a * np.cbrt(1.0 - load_ratio)


def cattaneo_shear(r, a, c, mu_p0):
    """Shear q_x, Pa, at r (m): Hertz's shape of height mu_p0 (Pa) on a, less that of height mu_p0 c/a on c."""
    return hertz_pressure(r, a, mu_p0) - (hertz_pressure(r, c, mu_p0 * c / a) if c > 0.0 else 0.0)


def cattaneo_displacement(a, c, mu_p0, compliance):
    """Relative tangential displacement d_x of the bodies, m (Johnson eq. 7.42).

    compliance (1/Pa) is that of tangential_compliance(); c = 0 gives the displacement at gross slip.
    """
    return 0.5 * np.pi * compliance * mu_p0 * (a**2 - c**2) / a


def cattaneo_slip(r, a, c, mu_p0, compliance, anisotropy=0.0, angle=0.0):
    """Slip s_x <= 0, m, of the Cattaneo-Mindlin shear at (r, angle) in the contact; 0 for r <= c.

    r in m, angle in rad from the direction of the force, compliance of tangential_compliance() in 1/Pa.
    With the default anisotropy = 0 this is the mean over all angles, and it is exact for nu = 0. With
    anisotropy = sum of nu/(4 G) over both bodies (1/Pa) it is u_x minus the rigid displacement for the
    given nu (from Johnson eqs 3.91a and 3.91b). For nu > 0 neither is an exact solution of the contact
    problem, because there the shear q_y is not zero.
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


# ---------------------------------------------------------------- Lubkin
#
# A twist beta of a disc of radius s that sticks all over gives q = (4 G beta/pi) r/sqrt(s^2 - r^2)
# (Reissner and Sagoci). Discs of all radii from c to a, with twists f(s) ds, turn r < c as a whole; the
# shear is mu p on c < r < a when f(s) = (mu p0/(2 G)) E(k)/s, k^2 = 1 - s^2/a^2. Everything below follows.


def torsion_limit(load_n, friction, a):
    """Torque limit 3 pi/16 mu N a, N m, at which the whole contact slips."""
    return 3.0 * np.pi / 16.0 * friction * load_n * a


def lubkin_torque_ratio(stick_ratio):
    """M_z/M_lim for stick_ratio = c/a: 64/(3 pi^2) times the integral of t^2 E(k) over [c/a, 1], k^2 = 1 - t^2."""
    x = np.asarray(stick_ratio, dtype=float)[..., None]
    t = 0.5 * (1.0 + x + (1.0 - x) * GAUSS_NODES)
    integral = 0.5 * (1.0 - x[..., 0]) * np.sum(GAUSS_WEIGHTS * t**2 * ellipe(1.0 - t**2), axis=-1)
    return 64.0 / (3.0 * np.pi**2) * integral


def lubkin_stick_radius(torque_ratio, a):
    """Stick radius c, m, for torque_ratio = M_z/M_lim in [0, 1]."""
    if not 0.0 <= torque_ratio <= 1.0:
        raise ValueError(f"torque_ratio must be in [0, 1], got {torque_ratio!r}")
    if torque_ratio in (0.0, 1.0):
        return a * (1.0 - torque_ratio)
    return a * brentq(lambda x: float(lubkin_torque_ratio(x)) - torque_ratio, 0.0, 1.0, xtol=1e-14)


def lubkin_shear(r, a, c, mu_p0):
    """Shear q_theta, Pa, at r (m) for stick radius c: mu p outside c, and for r < c

    q = mu p {1 + (2/pi) [(K - E) F(phi, k') - K E(phi, k')]},
    k' = c/a, K and E of modulus sqrt(1 - k'^2), sin(phi) = sqrt((c^2 - r^2)/(a^2 - r^2))/k'.
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


def lubkin_twist(a, c, mu_p0, compliance):
    """Relative rotation r_z of the bodies, rad: (mu p0/2) (1/G1 + 1/G2) [K(k) - E(k)], k^2 = 1 - c^2/a^2.

    compliance is 1/G1 + 1/G2 in 1/Pa. Infinite at c = 0: the limit torque is approached, not reached.
    """
    m = (c / a) ** 2
    return 0.5 * mu_p0 * compliance * (ellipkm1(m) - ellipe(1.0 - m))


# ---------------------------------------------------------------- the contact with all its scales


class Spheres:
    """Two spheres with friction under a normal load: Hertz's contact, and the scales of the other solutions.

    bodies (materials.Bodies), friction, load_n (N), gap_radius (m): what is given
    hertz: contact radius (m), greatest pressure (Pa), approach (m)
    mu_p0 (Pa), limit = mu N (N), torque_limit (N m): where all of the contact slips
    gross (m): tangential displacement of incipient sliding
    """

    def __init__(self, bodies, gap_radius, friction, load_n):
        self.bodies, self.gap_radius, self.friction, self.load_n = bodies, gap_radius, friction, load_n
        self.hertz = hertz(load_n, gap_radius, bodies.e_star)
        self.mu_p0, self.limit = friction * self.hertz.pressure, friction * load_n
        self.torque_limit = torsion_limit(load_n, friction, self.hertz.radius)
        self.gross = self.displacement(0.0)

    @classmethod
    def of(cls, parameters, load_n):
        """Creates the spheres from a mapping named like petsam's options, as in results files, under load_n (N)."""
        radius = effective_radius(float(parameters["gap_radius1"]), float(parameters["gap_radius2"]))
        return cls(Bodies.of(parameters), radius, float(parameters["friction"]), load_n)

    def pressure(self, r):
        """Hertz's pressure, Pa, at r (m)."""
        return hertz_pressure(r, self.hertz.radius, self.hertz.pressure)

    def stick_radius(self, load_tx):
        """Cattaneo and Mindlin's stick radius c, m, under T_x (N)."""
        return cattaneo_stick_radius(load_tx / self.limit, self.hertz.radius)

    def shear(self, r, c):
        """Cattaneo and Mindlin's q_x, Pa, at r (m) for stick radius c (m)."""
        return cattaneo_shear(r, self.hertz.radius, c, self.mu_p0)

    def slip(self, r, angle, c):
        """Their s_x, m, at r (m) and angle (rad) for stick radius c (m)."""
        return cattaneo_slip(
            r, self.hertz.radius, c, self.mu_p0, self.bodies.tangential_compliance, self.bodies.anisotropy, angle
        )

    def displacement(self, c):
        """Their d_x, m, for stick radius c (m)."""
        return cattaneo_displacement(self.hertz.radius, c, self.mu_p0, self.bodies.tangential_compliance)

    def torsion_stick_radius(self, load_mz):
        """Lubkin's stick radius c, m, under M_z (N m)."""
        return lubkin_stick_radius(load_mz / self.torque_limit, self.hertz.radius)

    def torsion_shear(self, r, c):
        """Lubkin's |q|, Pa, at r (m) for stick radius c (m)."""
        return lubkin_shear(r, self.hertz.radius, c, self.mu_p0)

    def twist(self, c):
        """Lubkin's r_z, rad, for stick radius c (m)."""
        return lubkin_twist(self.hertz.radius, c, self.mu_p0, self.bodies.torsional_compliance)
