"""Short cracks from the surface: stress intensity along a line of stresses, threshold, arrest.

The crack is straight-fronted, long along the surface and normal to it, in a half-space; of the stresses on its plane
without the crack the stress intensity is

    K(a) = 2 (a/pi)^1/2 int_0^1 s(a c) (1 + F(c)) / (1 - c^2)^1/2 dc

by the method of H. F. Bueckner (Zeitschrift fuer angewandte Mathematik und Mechanik 50 (1970) 529-546) with the weight
function of R. J. Hartranft and G. C. Sih (in G. C. Sih, Mechanics of Fracture 1, 1973), which is accurate to 0.2 %;
Bueckner's own polynomial to 0.8 %. Negative K counts as 0 (the crack is closed, as ASTM E647 counts it).

The threshold of short cracks is M. H. El Haddad's (Journal of Engineering Materials and Technology 101 (1979) 42-46),
dk_th (a/(a + a0))^1/2, a0 = (dk_th/(1.1215 stress_limit))^2/pi: of a uniform stress at its fatigue limit K reaches the
threshold as a -> 0.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

EDGE = 1.1215  # K of an edge crack under uniform stress, relative to that of a crack within the body
_SERIES = (0.2945, -0.3912, 0.7685, -0.9942, 0.5094)  # Hartranft and Sih: F(c) = (1 - c^2) sum of these times c^2n
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(96)


def intensity(depths: ArrayLike, stress: ArrayLike, lengths: ArrayLike) -> np.ndarray:
    """The stress intensity K of cracks.

    Parameters
    ----------
    depths : array_like
        Depths, (z,), m, rising.
    stress : array_like
        Stress on the cracks' plane there, (z,), Pa, linear between.
    lengths : array_like
        Lengths of the cracks, m, of any shape.

    Returns
    -------
    ndarray
        K, of the shape of the lengths, Pa m^1/2.
    """
    angles = 0.25 * np.pi * (_NODES + 1.0)
    c = np.sin(angles)
    weights = 0.25 * np.pi * _WEIGHTS * (1.0 + (1.0 - c**2) * np.polynomial.polynomial.polyval(c**2, _SERIES))
    lengths = np.asarray(lengths, dtype=float)
    values = np.interp(np.multiply.outer(lengths, c), depths, stress)
    return 2.0 * np.sqrt(lengths / np.pi) * (values @ weights)


def extremes(depths: ArrayLike, stresses: ArrayLike, lengths: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Maximum and minimum of K, Pa m^1/2, over the steps, neither below 0, by stresses (time, z), Pa, at rising
    depths, m."""
    values = np.array([intensity(depths, stress, lengths) for stress in stresses])
    return np.maximum(values.max(axis=0), 0.0), np.maximum(values.min(axis=0), 0.0)


def short_length(dk_th: float, stress_limit: float) -> float:
    """El Haddad's length a0, m, by the threshold range of long cracks, Pa m^1/2, and the fatigue limit as a range,
    Pa."""
    return (dk_th / (EDGE * stress_limit)) ** 2 / np.pi


def threshold(lengths: ArrayLike, dk_th: float, stress_limit: float) -> np.ndarray:
    """The threshold range of K of cracks.

    Parameters
    ----------
    lengths : array_like
        Lengths of the cracks, m, of any shape.
    dk_th : float
        Threshold range of K of long cracks, Pa m^1/2.
    stress_limit : float
        Fatigue limit as a stress range, Pa.

    Returns
    -------
    ndarray
        Thresholds, of the shape of the lengths, Pa m^1/2.
    """
    lengths = np.asarray(lengths, dtype=float)
    return dk_th * np.sqrt(lengths / (lengths + short_length(dk_th, stress_limit)))


def stress_range(lengths: ArrayLike, ranges: ArrayLike) -> np.ndarray:
    """The uniform stress range, Pa, of the same range of K: the ordinate of Kitagawa and Takahashi's diagram."""
    return ranges / (EDGE * np.sqrt(np.pi * np.asarray(lengths, dtype=float)))


def arrest(lengths: ArrayLike, ranges: ArrayLike, thresholds: ArrayLike) -> float:
    """The length at which a crack from the surface stops.

    Parameters
    ----------
    lengths : array_like
        Lengths of the crack, (lengths,), m, rising.
    ranges, thresholds : array_like
        Ranges of K, and their thresholds, at these lengths, (lengths,), Pa m^1/2.

    Returns
    -------
    float
        The length, m; 0 where the crack does not start, inf where it goes through all lengths.
    """
    ratio = np.asarray(ranges) / thresholds
    if not ratio[0] > 1.0:
        return 0.0
    below = np.flatnonzero(ratio <= 1.0)
    if not below.size:
        return np.inf
    k = below[0]
    return float(np.interp(1.0, ratio[[k, k - 1]], np.asarray(lengths)[[k, k - 1]]))


def start(lengths: ArrayLike, ranges: ArrayLike, thresholds: ArrayLike) -> float:
    """The least length at which a crack grows.

    Parameters
    ----------
    lengths : array_like
        Lengths of the crack, (lengths,), m, rising.
    ranges, thresholds : array_like
        Ranges of K, and their thresholds, at these lengths, (lengths,), Pa m^1/2.

    Returns
    -------
    float
        The length, m; inf where it grows at none of them.
    """
    above = np.flatnonzero(np.asarray(ranges) > thresholds)
    return float(np.asarray(lengths)[above[0]]) if above.size else np.inf


__all__ = ["arrest", "intensity", "start", "threshold"]


def __dir__():
    return __all__
