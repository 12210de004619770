"""Elastic constants of two bodies in contact, for the closed-form solutions."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np


def shear_modulus(young: float, poisson: float) -> float:
    """The shear modulus G of one body.

    Parameters
    ----------
    young : float
        Young's modulus, Pa.
    poisson : float
        Poisson's ratio.

    Returns
    -------
    float
        Shear modulus, Pa.
    """
    return young / (2.0 * (1.0 + poisson))


def effective_modulus(young1: float, poisson1: float, young2: float, poisson2: float) -> float:
    """E* of two bodies: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (Johnson eq. 4.3).

    Parameters
    ----------
    young1, young2 : float
        Young's moduli, Pa.
    poisson1, poisson2 : float
        Poisson's ratios.

    Returns
    -------
    float
        E*, Pa.
    """
    return 1.0 / ((1.0 - poisson1**2) / young1 + (1.0 - poisson2**2) / young2)


def effective_radius(radius1: float, radius2: float) -> float:
    """The relative radius of two spheres: 1/R = 1/R1 + 1/R2.

    Parameters
    ----------
    radius1, radius2 : float
        Radii, m; infinite: a flat; negative: a hollow.

    Returns
    -------
    float
        Relative radius R, m.
    """
    return 1.0 / (1.0 / radius1 + 1.0 / radius2)


def tangential_compliance(g1: float, poisson1: float, g2: float, poisson2: float) -> float:
    """The mean tangential compliance for shear of uniform direction: the sum over both bodies of (2 - nu)/(4 G).

    Parameters
    ----------
    g1, g2 : float
        Shear moduli, Pa; infinite: a rigid body.
    poisson1, poisson2 : float
        Poisson's ratios.

    Returns
    -------
    float
        Compliance, 1/Pa.
    """
    return (2.0 - poisson1) / (4.0 * g1) + (2.0 - poisson2) / (4.0 * g2)


def dundurs_beta(g1: float, poisson1: float, g2: float, poisson2: float) -> float:
    """Dundurs' second constant, whose sign says which body is softer.

    Parameters
    ----------
    g1, g2 : float
        Shear moduli, Pa; infinite: a rigid body.
    poisson1, poisson2 : float
        Poisson's ratios.

    Returns
    -------
    float
        The constant beta, positive where body 1 is softer by (1 - 2 nu)/G.
    """
    top = (1.0 - 2.0 * poisson1) / g1 - (1.0 - 2.0 * poisson2) / g2
    return 0.5 * top / ((1.0 - poisson1) / g1 + (1.0 - poisson2) / g2)


class Bodies(NamedTuple):
    """Elastic constants of two bodies.

    Attributes
    ----------
    young1, young2 : float
        Young's moduli, Pa; infinite: rigid.
    poisson1, poisson2 : float
        Poisson's ratios.
    """

    young1: float
    poisson1: float
    young2: float
    poisson2: float

    @classmethod
    def of(cls, parameters: Mapping) -> "Bodies":
        """Creates the bodies from options; a rigid body needs no Poisson's ratio.

        Parameters
        ----------
        parameters : mapping
            Values by the names of petsam's options, as Results.parameters has them.

        Returns
        -------
        Bodies

        Raises
        ------
        KeyError
            If a constant is missing; of Results.parameters an Error.
        """
        young = [float(parameters[f"body{k}_young"]) for k in (1, 2)]
        poisson = [float(parameters[f"body{k}_poisson"]) if np.isfinite(e) else 0.0 for k, e in zip((1, 2), young)]
        return cls(young[0], poisson[0], young[1], poisson[1])

    @property
    def shear_moduli(self) -> tuple[float, float]:
        """G of both bodies, Pa."""
        return shear_modulus(self.young1, self.poisson1), shear_modulus(self.young2, self.poisson2)

    @property
    def e_star(self) -> float:
        """E*, Pa."""
        return effective_modulus(*self)

    @property
    def tangential_compliance(self) -> float:
        """Sum of (2 - nu)/(4 G), 1/Pa."""
        g1, g2 = self.shear_moduli
        return tangential_compliance(g1, self.poisson1, g2, self.poisson2)

    @property
    def anisotropy(self) -> float:
        """Sum of nu/(4 G), 1/Pa: see cattaneo_slip()."""
        return sum(nu / (4.0 * g) for nu, g in zip((self.poisson1, self.poisson2), self.shear_moduli))

    @property
    def torsional_compliance(self) -> float:
        """Sum of 1/G, 1/Pa."""
        return sum(1.0 / g for g in self.shear_moduli)

    @property
    def dundurs_beta(self) -> float:
        """Dundurs' second constant."""
        g1, g2 = self.shear_moduli
        return dundurs_beta(g1, self.poisson1, g2, self.poisson2)


__all__ = ["Bodies", "dundurs_beta", "effective_modulus", "effective_radius", "shear_modulus", "tangential_compliance"]


def __dir__():
    return __all__
