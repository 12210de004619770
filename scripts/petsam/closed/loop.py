"""Tangential loops of a sphere under constant normal load: force against displacement, and the energy of a cycle.

SI units, relative displacements, similar materials. The first loading is Cattaneo and Mindlin's. Unloading and
reloading follow Masing's rule, which Mindlin and Deresiewicz derived for this contact: the same curve, doubled in both
directions. limit = mu N (N) and gross (m), the displacement of incipient sliding, are those of sphere.Spheres.

References
----------
- R. D. Mindlin, H. Deresiewicz, Elastic spheres in contact under varying oblique forces, J. Appl. Mech. 20 (1953) 327.
- K. L. Johnson, Contact Mechanics, 1985, section 7.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def first_loading(load: ArrayLike, limit: float, gross: float) -> np.ndarray:
    """The displacement d_x of the first loading.

    Parameters
    ----------
    load : array_like
        Tangential load, N, from 0 to limit.
    limit : float
        Load mu N of gross slip, N.
    gross : float
        Displacement of incipient sliding, m.

    Returns
    -------
    ndarray
        Displacement, m, of the shape of load.
    """
    return gross * (1.0 - np.cbrt(1.0 - np.asarray(load, dtype=float) / limit) ** 2)


def masing_displacement(
    load: ArrayLike, turn_load: float, turn_displacement: float, limit: float, gross: float
) -> np.ndarray:
    """The displacement d_x after a turning point: the first loading's curve doubled, down or up.

    Parameters
    ----------
    load : array_like
        Tangential load, N.
    turn_load : float
        Load of the turning point, N.
    turn_displacement : float
        Displacement of the turning point, m.
    limit : float
        Load mu N of gross slip, N.
    gross : float
        Displacement of incipient sliding, m.

    Returns
    -------
    ndarray
        Displacement, m, of the shape of load.
    """
    swing = np.asarray(load, dtype=float) - turn_load
    return turn_displacement + 2.0 * np.sign(swing) * first_loading(0.5 * np.abs(swing), limit, gross)


def partial_loop_energy(amplitude: float, limit: float, gross: float) -> float:
    """The energy that friction dissipates in one cycle between two opposite loads.

    Parameters
    ----------
    amplitude : float
        The largest load, N, at most limit.
    limit : float
        Load mu N of gross slip, N.
    gross : float
        Displacement of incipient sliding, m.

    Returns
    -------
    float
        Energy of a cycle, J.

    Notes
    -----
    Mindlin and Deresiewicz; with gross = 3 mu N (sum of (2 - nu)/G)/(16 a) it is Johnson's eq. 7.59.
    """
    t = amplitude / limit
    return 4.0 * limit * gross * (1.2 * (1.0 - np.cbrt(1.0 - t) ** 5) - t * (1.0 + np.cbrt(1.0 - t) ** 2))


def sliding_displacement_load(displacement: ArrayLike, limit: float, gross: float) -> np.ndarray:
    """The load of the first loading up to a displacement; mu N beyond that of incipient sliding.

    Parameters
    ----------
    displacement : array_like
        Displacement, m, at least 0.
    limit : float
        Load mu N of gross slip, N.
    gross : float
        Displacement of incipient sliding, m.

    Returns
    -------
    ndarray
        Tangential load, N, of the shape of displacement.
    """
    return limit * (1.0 - np.clip(1.0 - np.asarray(displacement, dtype=float) / gross, 0.0, None) ** 1.5)


def sliding_masing_load(
    displacement: ArrayLike, turn_load: float, turn_displacement: float, limit: float, gross: float
) -> np.ndarray:
    """The load after a turning point; the loop's branches end in sliding at mu N.

    Parameters
    ----------
    displacement : array_like
        Displacement, m.
    turn_load : float
        Load of the turning point, N.
    turn_displacement : float
        Displacement of the turning point, m.
    limit : float
        Load mu N of gross slip, N.
    gross : float
        Displacement of incipient sliding, m.

    Returns
    -------
    ndarray
        Tangential load, N, of the shape of displacement.
    """
    swing = np.asarray(displacement, dtype=float) - turn_displacement
    return turn_load + 2.0 * np.sign(swing) * sliding_displacement_load(0.5 * np.abs(swing), limit, gross)


def sliding_loop_energy(amplitude: float, limit: float, gross: float) -> float:
    """The energy of one cycle between two opposite displacements, from sliding to sliding.

    Parameters
    ----------
    amplitude : float
        The largest displacement, m, at least gross.
    limit : float
        Load mu N of gross slip, N.
    gross : float
        Displacement of incipient sliding, m.

    Returns
    -------
    float
        Energy of a cycle, J.
    """
    return partial_loop_energy(limit, limit, gross) + 4.0 * limit * (amplitude - gross)


__all__ = [
    "first_loading",
    "masing_displacement",
    "partial_loop_energy",
    "sliding_displacement_load",
    "sliding_loop_energy",
    "sliding_masing_load",
]


def __dir__():
    return __all__
