"""Gauss points and weights, for the closed-form solutions and for their checks."""

import numpy as np

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(80)


def segments(breaks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the Gauss points and weights, (..., (n - 1) times the number of Gauss points), of all intervals between
    breaks, (..., n), with square-root ends removed."""
    t = 0.25 * np.pi * (1.0 + GAUSS_NODES)
    low, width = breaks[..., :-1, None], np.diff(breaks)[..., None]
    points = low + width * np.sin(t) ** 2
    weights = width * 0.25 * np.pi * np.sin(2.0 * t) * GAUSS_WEIGHTS
    shape = breaks.shape[:-1] + (-1,)
    return points.reshape(shape), weights.reshape(shape)
