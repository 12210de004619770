"""Nonlinear least squares: the best of several starts, and the standard deviations and correlations of what is found.

Residuals r(p) are in units of their standard deviations, so that the covariance of p is (J'J)^-1 with their Jacobian J.
What is known of a parameter beforehand, a value p0 and its standard deviation s, is one more residual, (p - p0)/s.
"""

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike

from .errors import library

ROUNDING = 3e-8  # of singular values of a Jacobian of columns of length 1: about the root of the rounding
PART = 0.01  # of a parameter, squared, in directions without effect, from which on it is not held


def fit(
    residuals: Callable[..., np.ndarray],
    starts: Iterable[ArrayLike],
    jacobian: Union[str, Callable[..., np.ndarray]] = "2-point",
    bounds: tuple[ArrayLike, ArrayLike] = (-np.inf, np.inf),
    **settings: Any,
) -> Any:
    """The parameters of the least sum of squares among the fits from several starts.

    Parameters
    ----------
    residuals : callable
        Of parameters, (n,), the residuals, (m,).
    starts : iterable of array_like
        Parameters within the bounds, (n,) each.
    jacobian : callable or str
        Of parameters their derivatives, (m, n); "2-point": by differences.
    bounds : tuple of array_like
        Least and largest parameters.
    **settings
        Of scipy.optimize.least_squares.

    Returns
    -------
    scipy.optimize.OptimizeResult
        The first one of the least cost; with x, fun, jac and cost.

    Raises
    ------
    Missing
        If scipy is not installed.
    """
    one = library("scipy.optimize").least_squares
    return min((one(residuals, start, jacobian, bounds, **settings) for start in starts), key=lambda found: found.cost)


class Bands(NamedTuple):
    """How well parameters are held.

    Attributes
    ----------
    sd : ndarray
        Standard deviations, (n,); infinite of a parameter in a direction without effect.
    correlation : ndarray
        Of the errors, (n, n); NaN of such a parameter.
    """

    sd: np.ndarray
    correlation: np.ndarray


def bands(jacobian: np.ndarray, least: float = ROUNDING) -> Bands:
    """Standard deviations and correlations of the parameters of a fit, the same in any units of the parameters.

    Parameters
    ----------
    jacobian : ndarray
        Of residuals in units of their standard deviations, (m, n).
    least : float
        Singular value, of columns of length 1, below which a direction is without effect.

    Returns
    -------
    Bands
    """
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
    """A Jacobian with columns of length 1.

    Parameters
    ----------
    jacobian : ndarray
        (m, n).

    Returns
    -------
    scaled : ndarray
        (m, n).
    lengths : ndarray
        Of the columns, (n,); of a column of zeros 1.
    """
    lengths = np.linalg.norm(jacobian, axis=0)
    lengths[lengths == 0.0] = 1.0
    return jacobian / lengths, lengths
