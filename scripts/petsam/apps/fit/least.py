"""Nonlinear least squares: the best of several starts, and the standard deviations and correlations of what is found.

Residuals r(p) are in units of their standard deviations, so that the covariance of p is (J'J)^-1 with their Jacobian J.
What is known of a parameter beforehand, a value p0 and its standard deviation s, is one more residual, (p - p0)/s.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import library

ROUNDING = 3e-8  # of singular values of a Jacobian of columns of length 1: about the root of the rounding
PART = 0.01  # of a parameter, squared, in directions without effect, from which on it is not held
CORRELATED = 0.3  # correlation of neighbouring residuals above which the model does not hold,
MISFIT = 1.2  # if their root mean square, in units of the noise, is larger than this


def fit(
    residuals: Callable[..., np.ndarray],
    starts: Iterable[ArrayLike],
    jacobian: Union[str, Callable[..., np.ndarray]] = "2-point",
    bounds: tuple[ArrayLike, ArrayLike] = (-np.inf, np.inf),
    **settings: Any,
) -> Any:
    """Returns scipy's result (x, fun, jac, cost) of least cost among the fits from several starts, each (n,) and within
    the bounds; the first one of equals. `residuals` is a function of the parameters (n,) with values (m,), and
    `jacobian` their derivatives, (m, n), or "2-point": by differences. Raises Missing if scipy is not installed."""
    one = library("scipy.optimize").least_squares
    return min((one(residuals, start, jacobian, bounds, **settings) for start in starts), key=lambda found: found.cost)


class Bands(NamedTuple):
    """Standard deviations and correlations of fitted parameters."""

    sd: np.ndarray  # (n,); infinite of a parameter in a direction without effect
    correlation: np.ndarray  # of the errors, (n, n); NaN of such a parameter


def bands(jacobian: np.ndarray, least: float = ROUNDING) -> Bands:
    """Returns the standard deviations and correlations of the parameters of a fit, the same in any units of the
    parameters, from the Jacobian (m, n) of residuals in units of their standard deviations. `least`: singular value, of
    columns of length 1, below which a direction is without effect."""
    scaled, lengths = unit(jacobian)
    _, sizes, ways = np.linalg.svd(np.linalg.qr(scaled, "r"))  # not of all rows: there may be many
    sizes = np.append(sizes, np.zeros(len(lengths) - len(sizes)))
    felt = sizes > least
    covariance = (ways[felt].T / sizes[felt] ** 2) @ ways[felt]
    lost = ~scaled.any(axis=0) | (np.sum(ways[~felt] ** 2, axis=0) > PART)
    sd = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(*2 * [np.where(sd > 0.0, sd, np.inf)])
    correlation[lost] = correlation[:, lost] = np.nan
    return Bands(np.where(lost, np.inf, sd / lengths), correlation)


def unit(jacobian: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns a Jacobian (m, n) with columns of length 1, and the lengths of the columns, (n,): 1 for a column of
    zeros."""
    lengths = np.linalg.norm(jacobian, axis=0)
    lengths[lengths == 0.0] = 1.0
    return jacobian / lengths, lengths


def neighbours(parts: Sequence[np.ndarray]) -> float:
    """Correlation of neighbouring residuals within one or several series, each (n,), in order."""
    centred = [part - part.mean() for part in parts]
    return float(sum(np.sum(p[1:] * p[:-1]) for p in centred) / max(sum(np.sum(p * p) for p in centred), 1e-300))


def correlated(neighbours: float, misfit: float = np.inf) -> str:
    """Returns words on residuals whose neighbours correlate too much for the model to hold; empty if they do not, or if
    their root mean square, in units of the noise, is that of the noise."""
    if not (neighbours > CORRELATED and misfit > MISFIT):
        return ""
    return f"neighbouring residuals correlate by {neighbours:.2g}"
