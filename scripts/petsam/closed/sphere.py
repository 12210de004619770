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

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1

from ..core.errors import WrongArgument
from .materials import Bodies, effective_radius
from .quadrature import GAUSS_NODES, GAUSS_WEIGHTS


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


# ---------------------------------------------------------------- Cattaneo and Mindlin


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
    """Relative tangential displacement d_x of the bodies (Johnson eq. 7.42).

    Parameters
    ----------
    a : float
        Contact radius, m.
    c : float
        Stick radius, m; 0 gives the displacement at gross slip.
    mu_p0 : float
        Coefficient of friction times the maximum pressure, Pa.
    compliance : float
        That of tangential_compliance(), 1/Pa.

    Returns
    -------
    float
        Displacement, m.
    """
    return 0.5 * np.pi * compliance * mu_p0 * (a**2 - c**2) / a


def cattaneo_slip(
    r: ArrayLike, a: float, c: float, mu_p0: float, compliance: float, anisotropy: float = 0.0, angle: ArrayLike = 0.0
) -> np.ndarray:
    """Slip s_x <= 0 of the Cattaneo-Mindlin shear; 0 for r <= c and outside the contact.

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
    compliance : float
        That of tangential_compliance(), 1/Pa.
    anisotropy : float
        Sum of nu/(4 G) over both bodies, 1/Pa, or 0: see the notes.
    angle : array_like
        Angle from the direction of the force, rad.

    Returns
    -------
    ndarray
        Slip, m, of the shape of r and angle.

    Notes
    -----
    With the default anisotropy = 0 this is the mean over all angles, which is the solution for nu = 0. With anisotropy
    = sum of nu/(4 G) over both bodies it is u_x minus the rigid-body displacement for the given nu (from Johnson eqs
    3.91a and 3.91b). For nu > 0 neither solves the contact problem without error, because there the shear q_y is not
    zero.
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


def torsion_limit(load_n: float, friction: float, a: float) -> float:
    """Torque limit 3 pi/16 mu N a, at which the whole contact slips.

    Parameters
    ----------
    load_n : float
        Normal load, N.
    friction : float
        Coefficient of friction mu.
    a : float
        Contact radius, m.

    Returns
    -------
    float
        Torque limit, N m.
    """
    return 3.0 * np.pi / 16.0 * friction * load_n * a


def lubkin_torque_ratio(stick_ratio: ArrayLike) -> np.ndarray:
    """The torque of a stick radius: 64/(3 pi^2) times the integral of t^2 E(k) over [c/a, 1], k^2 = 1 - t^2.

    Parameters
    ----------
    stick_ratio : array_like
        c/a, from 0 to 1.

    Returns
    -------
    ndarray
        M_z/M_lim, of the shape of stick_ratio.
    """
    x = np.asarray(stick_ratio, dtype=float)[..., None]
    t = 0.5 * (1.0 + x + (1.0 - x) * GAUSS_NODES)
    integral = 0.5 * (1.0 - x[..., 0]) * np.sum(GAUSS_WEIGHTS * t**2 * ellipe(1.0 - t**2), axis=-1)
    return 64.0 / (3.0 * np.pi**2) * integral


def lubkin_stick_radius(torque_ratio: float, a: float) -> float:
    """The stick radius under a torque: the inverse of lubkin_torque_ratio().

    Parameters
    ----------
    torque_ratio : float
        M_z/M_lim, from 0 to 1.
    a : float
        Contact radius, m.

    Returns
    -------
    float
        Stick radius, m.

    Raises
    ------
    Error
        If the ratio is outside 0 to 1.
    """
    if not 0.0 <= torque_ratio <= 1.0:
        raise WrongArgument(f"torque_ratio must be in [0, 1], got {torque_ratio!r}")
    if torque_ratio in (0.0, 1.0):
        return a * (1.0 - torque_ratio)
    return a * brentq(lambda x: float(lubkin_torque_ratio(x)) - torque_ratio, 0.0, 1.0, xtol=1e-14)


def lubkin_shear(r: ArrayLike, a: float, c: float, mu_p0: float) -> np.ndarray:
    """Shear q_theta: mu p outside the stick radius, less within it.

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

    Notes
    -----
    For r < c it is q = mu p {1 + (2/pi) [(K - E) F(phi, k') - K E(phi, k')]} with k' = c/a, K and E of modulus sqrt(1 -
    k'^2), and sin(phi) = sqrt((c^2 - r^2)/(a^2 - r^2))/k'.
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
    """Relative rotation r_z of the bodies: (mu p0/2) (1/G1 + 1/G2) [K(k) - E(k)], k^2 = 1 - c^2/a^2.

    Parameters
    ----------
    a : float
        Contact radius, m.
    c : float
        Stick radius, m.
    mu_p0 : float
        Coefficient of friction times the maximum pressure, Pa.
    compliance : float
        1/G1 + 1/G2, 1/Pa.

    Returns
    -------
    float
        Rotation, rad; infinite at c = 0, as the limit torque is approached and not reached.
    """
    m = (c / a) ** 2
    return 0.5 * mu_p0 * compliance * (ellipkm1(m) - ellipe(1.0 - m))


# ---------------------------------------------------------------- the contact with all its scales


class Spheres:
    """Two spheres with friction under a normal load: Hertz's contact, and the scales of the other solutions.

    Parameters
    ----------
    bodies : Bodies
        Elastic constants.
    gap_radius : float
        Relative radius, m.
    friction : float
        Coefficient of friction.
    load_n : float
        Normal load, N.

    Attributes
    ----------
    hertz : Hertz
        Contact radius (m), maximum pressure (Pa), approach (m).
    mu_p0 : float
        Friction times the maximum pressure, Pa.
    limit : float
        Load mu N at which all of the contact slips, N.
    torque_limit : float
        Torque at which all of the contact slips, N m.
    gross : float
        Tangential displacement of incipient sliding, m.
    """

    def __init__(self, bodies: Bodies, gap_radius: float, friction: float, load_n: float) -> None:
        self.bodies, self.gap_radius, self.friction, self.load_n = bodies, gap_radius, friction, load_n
        self.hertz = hertz(load_n, gap_radius, bodies.e_star)
        self.mu_p0, self.limit = friction * self.hertz.pressure, friction * load_n
        self.torque_limit = torsion_limit(load_n, friction, self.hertz.radius)
        self.gross = self.displacement(0.0)

    @classmethod
    def of(cls, parameters: Mapping, load_n: float) -> Spheres:
        """Creates the spheres from options under a normal load.

        Parameters
        ----------
        parameters : mapping
            Values by the names of petsam's options, as Results.parameters has them.
        load_n : float
            Normal load, N.

        Returns
        -------
        Spheres

        Raises
        ------
        KeyError
            If an option is missing; of Results.parameters an Error.
        """
        radius = effective_radius(float(parameters["gap_radius1"]), float(parameters["gap_radius2"]))
        return cls(Bodies.of(parameters), radius, float(parameters["friction"]), load_n)

    def pressure(self, r: ArrayLike) -> np.ndarray:
        """Hertz's pressure.

        Parameters
        ----------
        r : array_like
            Distance from the contact's centre, m.

        Returns
        -------
        ndarray
            Pressure, Pa, of the shape of r.
        """
        return hertz_pressure(r, self.hertz.radius, self.hertz.pressure)

    def stick_radius(self, load_tx: float) -> float:
        """Cattaneo and Mindlin's stick radius c.

        Parameters
        ----------
        load_tx : float
            Tangential load T_x, N.

        Returns
        -------
        float
            Stick radius, m.
        """
        return cattaneo_stick_radius(load_tx / self.limit, self.hertz.radius)

    def shear(self, r: ArrayLike, c: float) -> np.ndarray:
        """Cattaneo and Mindlin's shear q_x.

        Parameters
        ----------
        r : array_like
            Distance from the contact's centre, m.
        c : float
            Stick radius, m.

        Returns
        -------
        ndarray
            Shear, Pa, of the shape of r.
        """
        return cattaneo_shear(r, self.hertz.radius, c, self.mu_p0)

    def slip(self, r: ArrayLike, angle: ArrayLike, c: float) -> np.ndarray:
        """Cattaneo and Mindlin's slip s_x.

        Parameters
        ----------
        r : array_like
            Distance from the contact's centre, m.
        angle : array_like
            Angle from the direction of the force, rad.
        c : float
            Stick radius, m.

        Returns
        -------
        ndarray
            Slip, m, of the shape of r and angle.
        """
        return cattaneo_slip(
            r, self.hertz.radius, c, self.mu_p0, self.bodies.tangential_compliance, self.bodies.anisotropy, angle
        )

    def displacement(self, c: float) -> float:
        """Cattaneo and Mindlin's displacement d_x.

        Parameters
        ----------
        c : float
            Stick radius, m.

        Returns
        -------
        float
            Displacement, m.
        """
        return cattaneo_displacement(self.hertz.radius, c, self.mu_p0, self.bodies.tangential_compliance)

    def torsion_stick_radius(self, load_mz: float) -> float:
        """Lubkin's stick radius c.

        Parameters
        ----------
        load_mz : float
            Torque M_z, N m.

        Returns
        -------
        float
            Stick radius, m.

        Raises
        ------
        Error
            If the torque is outside 0 to torque_limit.
        """
        return lubkin_stick_radius(load_mz / self.torque_limit, self.hertz.radius)

    def torsion_shear(self, r: ArrayLike, c: float) -> np.ndarray:
        """Lubkin's shear |q|.

        Parameters
        ----------
        r : array_like
            Distance from the contact's centre, m.
        c : float
            Stick radius, m.

        Returns
        -------
        ndarray
            Shear, Pa, of the shape of r.
        """
        return lubkin_shear(r, self.hertz.radius, c, self.mu_p0)

    def twist(self, c: float) -> float:
        """Lubkin's rotation r_z.

        Parameters
        ----------
        c : float
            Stick radius, m.

        Returns
        -------
        float
            Rotation, rad.
        """
        return lubkin_twist(self.hertz.radius, c, self.mu_p0, self.bodies.torsional_compliance)


__all__ = [
    "Hertz",
    "Spheres",
    "cattaneo_displacement",
    "cattaneo_shear",
    "cattaneo_slip",
    "cattaneo_stick_radius",
    "hertz",
    "hertz_pressure",
    "lubkin_shear",
    "lubkin_stick_radius",
    "lubkin_torque_ratio",
    "lubkin_twist",
    "torsion_limit",
]


def __dir__():
    return __all__
