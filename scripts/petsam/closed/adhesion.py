"""A ball that adheres to a flat: Maugis' curve between Johnson, Kendall and Roberts and Derjaguin, Muller and Toporov.

The tension is constant, work over reach, from the contact's edge to the circle at which the gap is the reach. A pull is
a negative load.

References
----------
- D. Maugis, Adhesion of spheres: the JKR-DMT transition using a Dugdale model, J. Colloid Interface Sci. 150 (1992)
  243.
- K. L. Johnson, K. Kendall, A. D. Roberts, Surface energy and the contact of elastic solids, Proc. R. Soc. A 324 (1971)
  301.
- B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, Effect of contact deformations on the adhesion of particles, J. Colloid
  Interface Sci. 53 (1975) 314.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Adhesion(NamedTuple):
    """States of an adhering ball, one for each contact radius.

    Attributes
    ----------
    load : ndarray
        Normal load, N: negative for a pull.
    approach : ndarray
        Approach of the bodies, m.
    border : ndarray
        Radius at which the tension ends, m.
    pull_off : float
        Maximum pull of all states, N: beyond it a given load has no equilibrium.
    """

    load: np.ndarray
    approach: np.ndarray
    border: np.ndarray
    pull_off: float


def adhesion(a: ArrayLike, work: float, reach: float, radius: float, e_star: float) -> Adhesion:
    """Maugis' load, approach and radius of the tension over the contact radius.

    Parameters
    ----------
    a : array_like
        Contact radius, m, at least 0.
    work : float
        Work of adhesion, J/m2.
    reach : float
        Gap at which the tension ends, m: -adhesion_work over -adhesion_stress. 0 is the limit of Johnson, Kendall and
        Roberts, inf that of Derjaguin, Muller and Toporov.
    radius : float
        Relative radius, m: see effective_radius().
    e_star : float
        E* of both bodies, Pa: see effective_modulus().

    Returns
    -------
    Adhesion
    """
    ball = work, reach, radius, e_star
    load, approach, border = _states(np.asarray(a, dtype=float), *ball)
    # the pull is largest at a contact radius between 0 (long reach) and that of Johnson, Kendall and Roberts
    low, high = 0.0, 1.01 * np.cbrt(9 * np.pi * work * radius**2 / (8 * e_star))
    for _ in range(6):
        tried = np.linspace(low, high, 65)
        pulls = -_states(tried, *ball)[0]
        most = int(np.argmax(pulls))
        low, high = tried[max(most - 1, 0)], tried[min(most + 1, 64)]
    return Adhesion(load, approach, border, float(pulls[most]))


def _states(a, work, reach, radius, e_star):
    """Load, approach and border of contact radii; the limits are those of the sums below."""
    load, approach = 4 * e_star * a**3 / (3 * radius), a**2 / radius
    if reach == 0:
        return load - np.sqrt(8 * np.pi * work * e_star * a**3), approach - np.sqrt(2 * np.pi * work * a / e_star), a
    if np.isinf(reach):
        return load - 2 * np.pi * work * radius, approach, np.full_like(a, np.inf)
    tension = work / reach
    past = _past_contact(a, tension, reach, radius, e_star)
    side = np.sqrt(past * (past + 2 * a))
    pull = 2 * tension * (a * side + (a + past) ** 2 * np.arctan2(side, a))
    return load - pull, approach - 2 * tension * side / e_star, a + past


def _past_contact(a, tension, reach, radius, e_star):
    """How far the tension extends past the contact's edge: where the gap, which grows from there on, is the reach."""

    def gap(past):
        side = np.sqrt(past * (past + 2 * a))
        angle = np.arctan2(side, a)
        ball = (a * (side - a * angle) + side**2 * angle) / (np.pi * radius)
        return ball + 4 * tension / (np.pi * e_star) * (side * angle - past)

    low, high = np.zeros_like(a), np.full_like(a, 2 * np.sqrt(radius * reach))  # wide enough without any tension
    for _ in range(120):
        middle = 0.5 * (low + high)
        short = gap(middle) < reach
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return 0.5 * (low + high)


__all__ = ["Adhesion", "adhesion"]


def __dir__():
    return __all__
