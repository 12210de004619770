"""Two spheres in contact: Hertz under normal load, Cattaneo and Mindlin under tangential force, Lubkin under torque.

The tangential and torsional solutions suppose that the normal load comes first and stays constant, that
the pressure is Hertz's, and that normal and tangential displacements do not couple (similar materials).
Conventions are those of the package's description.

Spheres has all of them with their scales; the functions alone are those of normal, cattaneo and lubkin, which have the
references.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from .cattaneo import cattaneo_displacement, cattaneo_shear, cattaneo_slip, cattaneo_stick_radius
from .loop import first_loading
from .lubkin import lubkin_shear, lubkin_stick_radius, lubkin_twist, torsion_limit
from .materials import Bodies, effective_radius
from .normal import Hertz, hertz, hertz_pressure


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

    def first_loading(self, load_tx: ArrayLike) -> np.ndarray:
        """The displacement d_x of the first loading, which loop.first_loading() has in closed form.

        Parameters
        ----------
        load_tx : array_like
            Tangential load T_x, N, from 0 to limit.

        Returns
        -------
        ndarray
            Displacement, m, of the shape of load_tx.
        """
        return first_loading(load_tx, self.limit, self.gross)

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


__all__ = ["Hertz", "Spheres", "cattaneo_shear", "cattaneo_stick_radius", "hertz", "hertz_pressure"]


def __dir__():
    return __all__
