"""Elastic constants of two bodies in contact, for the closed-form solutions."""

from typing import NamedTuple

import numpy as np


def shear_modulus(young, poisson):
    """Shear modulus G of one body, Pa, from Young's modulus (Pa) and Poisson's ratio."""
    return young / (2.0 * (1.0 + poisson))


def effective_modulus(young1, poisson1, young2, poisson2):
    """E*, Pa: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 (Johnson eq. 4.3)."""
    return 1.0 / ((1.0 - poisson1**2) / young1 + (1.0 - poisson2**2) / young2)


def effective_radius(radius1, radius2):
    """R, m: 1/R = 1/R1 + 1/R2; an infinite radius is a flat."""
    return 1.0 / (1.0 / radius1 + 1.0 / radius2)


def tangential_compliance(g1, poisson1, g2, poisson2):
    """Sum over both bodies of (2 - nu)/(4 G), 1/Pa: the mean tangential compliance for shear of uniform direction."""
    return (2.0 - poisson1) / (4.0 * g1) + (2.0 - poisson2) / (4.0 * g2)


def dundurs_beta(g1, poisson1, g2, poisson2):
    """Dundurs' second constant; an infinite shear modulus is a rigid body. Its sign says which body is softer."""
    top = (1.0 - 2.0 * poisson1) / g1 - (1.0 - 2.0 * poisson2) / g2
    return 0.5 * top / ((1.0 - poisson1) / g1 + (1.0 - poisson2) / g2)


class Bodies(NamedTuple):
    """Young's moduli (Pa, infinite: rigid) and Poisson's ratios of both bodies."""

    young1: float
    poisson1: float
    young2: float
    poisson2: float

    @classmethod
    def of(cls, parameters):
        """Creates the bodies from a mapping named like petsam's options; a rigid body needs no Poisson's ratio."""
        young = [float(parameters[f"body{k}_young"]) for k in (1, 2)]
        poisson = [float(parameters[f"body{k}_poisson"]) if np.isfinite(e) else 0.0 for k, e in zip((1, 2), young)]
        return cls(young[0], poisson[0], young[1], poisson[1])

    @property
    def shear_moduli(self):
        """G of both bodies, Pa."""
        return shear_modulus(self.young1, self.poisson1), shear_modulus(self.young2, self.poisson2)

    @property
    def e_star(self):
        """E*, Pa."""
        return effective_modulus(*self)

    @property
    def tangential_compliance(self):
        """Sum of (2 - nu)/(4 G), 1/Pa."""
        g1, g2 = self.shear_moduli
        return tangential_compliance(g1, self.poisson1, g2, self.poisson2)

    @property
    def anisotropy(self):
        """Sum of nu/(4 G), 1/Pa: see cattaneo_slip()."""
        return sum(nu / (4.0 * g) for nu, g in zip((self.poisson1, self.poisson2), self.shear_moduli))

    @property
    def torsional_compliance(self):
        """Sum of 1/G, 1/Pa."""
        return sum(1.0 / g for g in self.shear_moduli)

    @property
    def dundurs_beta(self):
        """Dundurs' second constant."""
        g1, g2 = self.shear_moduli
        return dundurs_beta(g1, self.poisson1, g2, self.poisson2)
